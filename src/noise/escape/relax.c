/*
 * relax.c -- candidates: the action of a path on a grid, minimised; see path.h.
 *
 * With positions at equally spaced times the action is a sum of squares of x'' + gamma x' + g by
 * differences of fourth order, and the matrix of Levenberg's and Marquardt's method is banded.
 */
#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"

enum {
  STENCIL = PATH_STENCIL, HALF = STENCIL / 2, /* points of a difference */
  KEPT = HALF + 1 /* at either end */
};
typedef struct chain {
  const pendres_pendulum *p;
  size_t points;
  int each;
  double h;
  double weight[STENCIL]; /* of x'' + gamma x' */
  double *rest;   /* [points] the square's root at each */
  double *slope;  /* [points] its derivative by the point's own position */
  double *band, *right, *trial;
} chain;

void pendres_way_differences(double h, double first[PATH_STENCIL], double second[PATH_STENCIL])
{
  static const double d1[STENCIL] = {1.0, -8.0, 0.0, 8.0, -1.0};
  static const double d2[STENCIL] = {-1.0, 16.0, -30.0, 16.0, -1.0};
  for (int i = 0; i < STENCIL; i++) {
    first[i] = d1[i] / (12.0 * h);
    second[i] = d2[i] / (12.0 * h * h);
  }
}

static double look(const chain *c, const double *x, int slopes)
{
  const pendres_pendulum *p = c->p;
  const double origin = pendres_model_origin(p);
  double sum = 0.0;
  for (size_t k = HALF; k + HALF < c->points; k++) {
    const double cosine = cos(two_pi * (double)(k % (size_t)c->each) / c->each);
    const double by = 1.0 + p->parametric_amplitude * cosine;
    double f, df, rest = 0.0;
    pendres_model_force(p, x[k] - origin, &f, &df);
    for (size_t i = 0; i < STENCIL; i++) rest += c->weight[i] * x[k + i - HALF];
    c->rest[k] = rest + by * f - p->torque - p->drive_amplitude * cosine;
    if (slopes) c->slope[k] = by * df;
    sum += c->rest[k] * c->rest[k];
  }
  return sum * c->h / (4.0 * p->damping);
}

/* The positions that move are those between what is kept. */
static void build(const chain *c, double spring)
{
  const size_t n = c->points - 2 * KEPT;
  memset(c->band, 0, n * STENCIL * sizeof *c->band);
  memset(c->right, 0, n * sizeof *c->right);
  for (size_t k = HALF; k + HALF < c->points; k++) {
    double d[STENCIL]; /* by the positions around k */
    memcpy(d, c->weight, sizeof d);
    d[HALF] += c->slope[k];
    for (size_t i = 0; i < STENCIL; i++) {
      const size_t row = k + i - HALF - KEPT;
      if (k + i < HALF + KEPT || row >= n) continue;
      c->right[row] -= d[i] * c->rest[k];
      for (size_t j = 0; j <= i; j++)
        if (row >= i - j) c->band[(row - (i - j)) * STENCIL + (i - j)] += d[i] * d[j];
    }
  }
  for (size_t i = 0; i < n; i++) c->band[i * STENCIL] *= 1.0 + spring;
}

static pendres_status descend(pendres_context *ctx, const chain *c, double *x, double *action)
{
  const size_t n = c->points - 2 * KEPT;
  double spring = 1e-3;
  *action = look(c, x, 1);
  for (int k = 0; k < RELAX_ROUNDS && spring < relax_stiffest; k++) {
    const pendres_status stop = pendres_context_poll(ctx);
    if (stop != PENDRES_OK) return stop;
    build(c, spring);
    gsl_matrix_view band = gsl_matrix_view_array(c->band, n, STENCIL);
    gsl_vector_view right = gsl_vector_view_array(c->right, n);
    if (gsl_linalg_cholesky_band_decomp(&band.matrix) != 0 ||
        gsl_linalg_cholesky_band_svx(&band.matrix, &right.vector) != 0) {
      spring *= 10.0;
      (void)look(c, x, 1);
      continue;
    }
    memcpy(c->trial, x, c->points * sizeof *x);
    for (size_t i = 0; i < n; i++) c->trial[i + KEPT] += c->right[i];
    const double there = look(c, c->trial, 1);
    if (there < *action) {
      const int last = *action - there < relax_done * there && spring < 1e-2;
      memcpy(x, c->trial, c->points * sizeof *x);
      *action = there;
      spring = fmax(0.1 * spring, 1e-12);
      if (last) break;
    } else {
      spring *= 10.0;
      (void)look(c, x, 1);
    }
  }
  return isfinite(*action) ? PENDRES_OK : PENDRES_NOT_CONVERGED;
}

pendres_status pendres_way_relax(pendres_context *ctx, const pendres_pendulum *p, size_t points,
                                  int each, double *x, double *action)
{
  chain c = {.p = p, .points = points, .each = each, .h = two_pi / p->drive_frequency / each};
  double first[STENCIL], second[STENCIL];
  pendres_way_differences(c.h, first, second);
  for (int i = 0; i < STENCIL; i++) c.weight[i] = second[i] + p->damping * first[i];
  pendres_room room = pendres_room_open(ctx, "paths of an escape");
  c.rest = pendres_room_take(&room, points, sizeof *c.rest);
  c.slope = pendres_room_take(&room, points, sizeof *c.slope);
  c.trial = pendres_room_take(&room, points, sizeof *c.trial);
  c.band = pendres_room_take(&room, points * STENCIL, sizeof *c.band);
  c.right = pendres_room_take(&room, points, sizeof *c.right);
  *action = NAN;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  return pendres_room_close(&room, descend(ctx, &c, x, action));
}
