/* circle_band.c -- the invariant circles over a range of a parameter; see circle_band.h. */
#include "questions/circle_band.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/steps.h"

enum {
  NODES = PENDRES_CIRCLE_NODES,
  GUESSED_FROM = 4 /* circles that the next one is extrapolated from */
};

/* More steps, by which the error of the integration is told. */
static const double more_steps = 1.4;

/* Coefficients that fall more slowly from one degree to the next tell little. */
static const double slow = 0.5;

/* What a step of the choice of steps is to be good for: the speed of a rotation. */
static double speed_of(const pendres_pendulum *p)
{
  const double driven = fabs(p->drive_amplitude) / hypot(p->drive_frequency, p->damping);
  return 2.0 + driven + fabs(p->torque) / p->damping;
}

pendres_status pendres_circle_steps(pendres_context *ctx, const pendres_pendulum *p,
                                    double tolerance, int *steps)
{
  return pendres_steps_choose(ctx, p, speed_of(p), 0.1 * tolerance, steps);
}

/* Coefficients that do not count are left out, so that the next circle takes as few points. */
static void trim(pendres_trigonometric *t, double tolerance)
{
  while (t->n > PENDRES_CIRCLE_LEAST) {
    for (size_t i = 7 * t->n / 16; i < t->n; i++)
      if (!(fabs(t->c[i]) < tolerance)) return;
    t->n /= 2;
    t->c[t->n - 1] = 0.0;
  }
}

static void widen(pendres_trigonometric *t, size_t n)
{
  memset(t->c + t->n, 0, (n - t->n) * sizeof *t->c);
  t->n = n;
}

/* Lagrange's polynomial through n points counts the one numbered k so much at a value. */
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
static pendres_trigonometric extrapolate(const pendres_circle_band *b, size_t k, double tolerance)
{
  const size_t n = k < GUESSED_FROM ? k : GUESSED_FROM, first = k - n;
  pendres_trigonometric guess = {.n = PENDRES_CIRCLE_LEAST};
  for (size_t i = 0; i < n; i++)
    add(&guess, share(n, b->value + first, i, b->value[k]), &b->at[first + i].w);
  trim(&guess, tolerance);
  return guess;
}

/* The largest of Chebyshev's coefficients of some degree, of all of the map's. */
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
 * What is missing of the polynomials in the parameter: the coefficients of higher degrees, if they
 * go on to fall as the last ones do, and as much again for what these do at the nodes. Coefficients
 * of even degrees may be smaller than those of odd ones: pairs are compared.
 */
static double missing(const pendres_circle_band *b)
{
  const double last = fmax(largest_of(b, NODES - 1), largest_of(b, NODES - 2));
  const double before = fmax(largest_of(b, NODES - 3), largest_of(b, NODES - 4));
  const double falls = sqrt(last / fmax(before, 1e-300));
  if (!(falls < slow)) return last;
  return 2.0 * falls * falls / (1.0 - falls) * last;
}

/* What the circles are off by for their steps: at the last value. */
static pendres_status compare(pendres_context *ctx, const pendres_circle_family *family, int steps,
                              pendres_circle_band *b, int *found)
{
  pendres_circle better;
  pendres_pendulum p = family->pendulum;
  pendres_parameter_set(family->parameter, b->value[NODES - 1], &p);
  const pendres_status status =
    pendres_circle_refine(ctx, &p, (int)ceil(more_steps * steps), family->tolerance,
                          &b->at[NODES - 1].w, &better, found);
  if (status != PENDRES_OK || !*found) return status;
  b->wrong = better.move;
  add(&b->wrong, -1.0, &b->at[NODES - 1].move);
  trim(&b->wrong, INFINITY);
  return status;
}

pendres_status pendres_circle_band_find(pendres_context *ctx, const pendres_circle_family *family,
                                        double from, double to, const pendres_trigonometric *guess,
                                        pendres_circle_band *out, int *found)
{
  pendres_pendulum p = family->pendulum;
  int steps = 0, other = 0;
  *found = 0;
  *out = (pendres_circle_band){.low = fmin(from, to), .high = fmax(from, to)};
  pendres_parameter_set(family->parameter, from, &p);
  pendres_status status = pendres_circle_steps(ctx, &p, family->tolerance, &steps);
  if (status != PENDRES_OK) return status;
  pendres_parameter_set(family->parameter, to, &p);
  status = pendres_circle_steps(ctx, &p, family->tolerance, &other);
  if (other > steps) steps = other;
  *found = 1;
  for (size_t k = 0; k < NODES && status == PENDRES_OK && *found; k++) {
    const double part = k == NODES - 1 ? 1.0 : 0.5 - 0.5 * cos(pi * (double)k / (NODES - 1));
    out->value[k] = from + part * (to - from);
    pendres_parameter_set(family->parameter, out->value[k], &p);
    const pendres_trigonometric next =
      k == 0 ? *guess : extrapolate(out, k, family->tolerance);
    status = pendres_circle_refine(ctx, &p, steps, family->tolerance, &next, &out->at[k], found);
    if (status != PENDRES_OK || !*found) break;
    out->error = fmax(out->error, out->at[k].error);
    if (out->at[k].move.n > out->n) out->n = out->at[k].move.n;
  }
  if (status != PENDRES_OK || !*found) return status;
  out->missing = missing(out);
  out->error += out->missing;
  *found = out->missing < family->tolerance;
  return *found ? compare(ctx, family, steps, out, found) : status;
}
