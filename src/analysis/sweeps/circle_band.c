/* circle_band.c -- the invariant circles over a range of a parameter; see circle_band.h. */
#include "analysis/sweeps/circle_band.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "engine/steps.h"

enum {
  NODES = PENDRES_CIRCLE_NODES,
  GUESSED_FROM = 4 /* circles that the next one is extrapolated from */
};

/* Up to this part of its width beyond its end a band gives guesses for the next one. */
static const double near_by = 0.2;
/* The factor of the steps by which the error of the integration is found. */
static const double more_steps = 1.4;

/* Circles need fewer steps than the probes that choose them, and their error is measured anyway. */
static const double probed = 10.0;
/* Residuals relative to the tolerance: so small that they do not count in the error, at the price
   of few more rounds; and those of two circles that are compared. */
static const double residual = 0.1, least_residual = 1e-13;
/* Coefficients that fall more slowly from one degree to the next give no estimate. */
static const double slow = 0.5;

pendres_status pendres_circle_way_at(pendres_context *ctx, const pendres_circle_family *family,
                                     double value, pendres_circle_way *out)
{
  const pendres_pendulum p = pendres_parameter_with(&family->pendulum, family->parameter, value);
  *out = (pendres_circle_way){.pendulum = p, .tolerance = family->tolerance,
                              .residual = residual * family->tolerance};
  return pendres_steps_choose(ctx, &p, pendres_steps_turning_speed(&p),
                              probed * family->tolerance, &out->steps);
}

static void widen(pendres_trigonometric *t, size_t n)
{
  memset(t->c + t->n, 0, (n - t->n) * sizeof *t->c);
  t->n = n;
}

/* The weight of point k in Lagrange's polynomial through n points, at a value. */
static double share(size_t n, const double *at, size_t k, double value)
{
  double product = 1.0;
  for (size_t i = 0; i < n; i++)
    if (i != k) product *= (value - at[i]) / (at[k] - at[i]);
  return product;
}

static void add(pendres_trigonometric *sum, double factor, const pendres_trigonometric *t)
{
  if (sum->n < t->n) widen(sum, t->n);
  for (size_t i = 0; i < t->n; i++) sum->c[i] += factor * t->c[i];
}

void pendres_circle_band_at(const pendres_circle_band *b, double value, pendres_circle *out)
{
  out->error = b->error;
  out->w.n = out->move.n = PENDRES_CIRCLE_LEAST;
  memset(out->w.c, 0, sizeof out->w.c);
  memset(out->move.c, 0, sizeof out->move.c);
  for (size_t k = 0; k < NODES; k++) {
    const double factor = share(NODES, b->value, k, value);
    add(&out->w, factor, &b->at[k].w);
    add(&out->move, factor, &b->at[k].move);
  }
}

/* A guess for circle number k from those before it. */
static pendres_trigonometric extrapolate(const pendres_circle_band *b, size_t k)
{
  const size_t n = k < GUESSED_FROM ? k : GUESSED_FROM, first = k - n;
  pendres_trigonometric guess = {.n = PENDRES_CIRCLE_LEAST};
  for (size_t i = 0; i < n; i++)
    add(&guess, share(n, b->value + first, i, b->value[k]), &b->at[first + i].w);
  return guess;
}

/* The same from a band that ends where this one begins, close to its end. */
static pendres_trigonometric guess_of(const pendres_circle_start *start,
                                      const pendres_circle_band *b, size_t k, double tolerance)
{
  pendres_circle at;
  const pendres_circle_band *before = start->before;
  const double beyond = fabs(b->value[k] - b->value[0]);
  if (before != NULL && beyond < near_by * (before->high - before->low)) {
    pendres_circle_band_at(before, b->value[k], &at);
  } else if (k == 0) {
    return start->guess;
  } else {
    at.w = extrapolate(b, k);
  }
  pendres_trigonometric_trim(&at.w, tolerance);
  return at.w;
}

/* The largest Chebyshev coefficient of a degree, of all coefficients of the map. */
static double largest_of(const pendres_circle_band *b, int degree)
{
  const double once = degree == 0 || degree == NODES - 1 ? 1.0 : 2.0;
  double largest = 0.0;
  for (size_t i = 0; i < b->n; i++) {
    double sum = 0.0;
    for (int k = 0; k < NODES; k++) {
      const double half = k == 0 || k == NODES - 1 ? 0.5 : 1.0;
      sum += half * cos(pi * k * degree / (NODES - 1)) * b->at[k].move.c[i];
    }
    largest = fmax(largest, once * fabs(sum) / (NODES - 1));
  }
  return largest;
}

/*
 * The truncation error of the polynomials in the parameter: the sum of the coefficients of higher
 * degrees, if they fall as the last ones do, and as much again for their aliases at the nodes.
 * Coefficients of even degrees may be smaller than those of odd ones, so pairs are compared.
 */
static double missing(const pendres_circle_band *b)
{
  const double last = fmax(largest_of(b, NODES - 1), largest_of(b, NODES - 2));
  const double before = fmax(largest_of(b, NODES - 3), largest_of(b, NODES - 4));
  const double falls = sqrt(last / fmax(before, 1e-300));
  if (!(falls < slow)) return last;
  return 2.0 * falls * falls / (1.0 - falls) * last;
}

/* The error of the circles from the integration, measured at the last value. */
static pendres_status compare(pendres_context *ctx, pendres_circle_way *way,
                              pendres_circle_band *b, int *found)
{
  const pendres_trigonometric *guess = &b->at[NODES - 1].w;
  pendres_circle less, more;
  way->residual = fmax(least_residual, residual * residual * way->residual);
  pendres_status status = pendres_circle_refine(ctx, way, guess, &less, found);
  way->steps = (int)ceil(more_steps * way->steps);
  if (status == PENDRES_OK && *found)
    status = pendres_circle_refine(ctx, way, &less.w, &more, found);
  if (status != PENDRES_OK || !*found) return status;
  b->wrong = more.move;
  add(&b->wrong, -1.0, &less.move);
  pendres_trigonometric_trim(&b->wrong, INFINITY);
  return status;
}

pendres_status pendres_circle_band_find(pendres_context *ctx, const pendres_circle_family *family,
                                        const pendres_circle_start *start, double to,
                                        pendres_circle_band *out, int *found)
{
  const double from = start->value;
  pendres_circle_way way, other;
  *found = 0;
  *out = (pendres_circle_band){.low = fmin(from, to), .high = fmax(from, to), .reached = from};
  pendres_status status = pendres_circle_way_at(ctx, family, from, &other);
  if (status == PENDRES_OK) status = pendres_circle_way_at(ctx, family, to, &way);
  if (status != PENDRES_OK) return status;
  if (other.steps > way.steps) way.steps = other.steps;
  for (size_t k = 0; k < NODES; k++) {
    const double part = k == NODES - 1 ? 1.0 : 0.5 - 0.5 * cos(pi * (double)k / (NODES - 1));
    out->value[k] = from + part * (to - from);
    pendres_parameter_set(family->parameter, out->value[k], &way.pendulum);
    const pendres_trigonometric next = guess_of(start, out, k, family->tolerance);
    status = pendres_circle_refine(ctx, &way, &next, &out->at[k], found);
    if (status != PENDRES_OK || !*found) return status;
    out->reached = out->value[k];
    out->error = fmax(out->error, out->at[k].error);
    if (out->at[k].move.n > out->n) out->n = out->at[k].move.n;
  }
  out->missing = missing(out);
  out->error += out->missing;
  *found = out->missing < family->tolerance;
  return *found ? compare(ctx, &way, out, found) : status;
}
