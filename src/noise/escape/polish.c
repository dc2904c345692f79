/*
 * polish.c -- multiple shooting for the path of least action; see path.h.
 *
 * Unknown are the states at the ends of pieces. A path starts in the plane of the state, ends in
 * that of the saddle, and its pieces meet. Where the equations do not depend on time, paths shifted
 * in time are solutions, too, except for what the planes leave out; and where a drive is in
 * resonance nearly so. Somewhere in the middle of a pinned path position and velocity are therefore
 * kept along its direction, and momenta jump along it as much as that takes: the derivative of the
 * least action by what is kept.
 */
#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"

enum {
  BAND = 2 * PATH_SIZE + 1,              /* diagonals on either side, at most */
  ROW = 3 * BAND + 1,                    /* of the matrix, with what pivoting needs */
  SQUARE = PATH_SIZE * PATH_SIZE
};
typedef struct system {
  const pendres_way *path;
  size_t pieces, unknowns, middle;
  double *band, *right, *step; /* the matrix, the residuals, Newton's step */
  double *trial;               /* states that may replace those of the path */
  double along[2], steep;      /* the path's direction in the middle, its slope's size, */
  double target[2];            /* and where it is to be */
  double action;               /* of the pieces, at the latest look, */
  int fresh;                   /* which was at the path, with its matrix */
  double slack;                /* the jump of momenta there, along it */
} system_t;

static size_t unknown_of(const system_t *s, size_t node)
{
  return PATH_SIZE * node + (s->path->pinned && node > s->middle);
}

static void put(system_t *s, size_t row, size_t column, double value)
{
  s->band[column * ROW + 2 * BAND + row - column] = value;
}

/* The rows of the plane of the state, at the first node. */
static void leave(system_t *s, const double *z, int fill)
{
  const pendres_way_end *e = &s->path->from;
  const double dx = z[PATH_X] - e->x, dv = z[PATH_V] - e->v, *k = e->plane;
  s->right[0] = z[PATH_P] - k[0] * dx - k[1] * dv;
  s->right[1] = z[PATH_Q] - k[1] * dx - k[2] * dv;
  for (size_t i = 0; i < 2 && fill; i++) {
    put(s, i, PATH_X, -k[i]);
    put(s, i, PATH_V, -k[i + 1]);
    put(s, i, PATH_P + i, 1.0);
  }
}

/* Those of the plane of the saddle, at the last. */
static void arrive(system_t *s, const double *z, int fill)
{
  const pendres_way_end *e = &s->path->to;
  const double *l = e->plane, k = l[2];
  const size_t row = s->unknowns - 2, column = unknown_of(s, s->pieces);
  s->right[row] = l[0] * (z[PATH_X] - e->x + k * z[PATH_P]) +
                  l[1] * (z[PATH_V] - e->v + k * z[PATH_Q]);
  s->right[row + 1] = l[0] * z[PATH_Q] - l[1] * z[PATH_P];
  for (size_t i = 0; i < 2 && fill; i++) {
    put(s, row, column + PATH_X + i, l[i]);
    put(s, row, column + PATH_P + i, k * l[i]);
    put(s, row + 1, column + PATH_P + i, i == 0 ? -l[1] : l[0]);
  }
}

/* The row by which the middle is where it is to be, and the jump behind it. */
static void pin(system_t *s, const double *z, int fill)
{
  const size_t row = 2 + PATH_SIZE * s->middle, column = unknown_of(s, s->middle);
  s->right[row] = 0.0;
  for (size_t i = 0; i < 2; i++) {
    s->right[row] += s->along[i] * (z[PATH_SIZE * s->middle + i] - s->target[i]);
    if (!fill) continue;
    put(s, row, column + i, s->along[i]);
    put(s, row + 1 + PATH_P + i, column + PATH_SIZE, s->along[i]);
  }
}

/* Residuals at nodes z and, if asked for, the matrix; the action of the pieces. */
static double look(system_t *s, const double *z, int fill)
{
  const pendres_way *path = s->path;
  double derivative[SQUARE], action = 0.0;
  if (fill) memset(s->band, 0, s->unknowns * ROW * sizeof *s->band);
  leave(s, z, fill);
  for (size_t k = 0; k < s->pieces; k++) {
    double end[PATH_SIZE];
    const int late = path->pinned && k >= s->middle;
    const size_t row = 2 + PATH_SIZE * k + (size_t)late, column = unknown_of(s, k);
    memcpy(end, z + PATH_SIZE * k, sizeof end);
    pendres_way_piece(path->flow, (int)(k % (size_t)path->flow->grid.pieces), end,
                       fill ? derivative : NULL, &action);
    if (path->pinned && k == s->middle) pin(s, z, fill);
    for (size_t i = 0; i < PATH_SIZE; i++) {
      s->right[row + i] = end[i] - z[PATH_SIZE * (k + 1) + i];
      if (path->pinned && k == s->middle && i >= PATH_P)
        s->right[row + i] += s->slack * s->along[i - PATH_P];
      if (!fill) continue;
      for (size_t j = 0; j < PATH_SIZE; j++)
        put(s, row + i, column + j, derivative[i * PATH_SIZE + j]);
      put(s, row + i, unknown_of(s, k + 1) + i, -1.0);
    }
  }
  arrive(s, z + PATH_SIZE * s->pieces, fill);
  return action;
}

static double length(const double *x, size_t n)
{
  double most = 0.0;
  for (size_t i = 0; i < n; i++) most = isnan(x[i]) ? INFINITY : fmax(most, fabs(x[i]));
  return most;
}

/* Newton's step of the latest look; 0 where there is none. */
static int solve(system_t *s, gsl_vector_uint *order)
{
  const size_t n = s->unknowns;
  gsl_matrix_view band = gsl_matrix_view_array(s->band, n, ROW);
  gsl_vector_view step = gsl_vector_view_array(s->step, n);
  for (size_t i = 0; i < n; i++) s->step[i] = -s->right[i];
  return gsl_linalg_LU_band_decomp(n, BAND, BAND, &band.matrix, order) == 0 &&
         gsl_linalg_LU_band_svx(BAND, BAND, &band.matrix, order, &step.vector) == 0 &&
         isfinite(length(s->step, n));
}

/* Go along the step as far as residuals become less. The whole step, which mostly does, is looked
   at with its matrix, for the next. */
static int go(system_t *s, double *z)
{
  const size_t n = PATH_SIZE * (s->pieces + 1);
  const double before = length(s->right, s->unknowns), slack = s->slack;
  for (double part = 1.0; part >= polish_least; part *= 0.5) {
    for (size_t k = 0; k <= s->pieces; k++)
      for (size_t i = 0; i < PATH_SIZE; i++)
        s->trial[PATH_SIZE * k + i] =
          z[PATH_SIZE * k + i] + part * s->step[unknown_of(s, k) + i];
    if (s->path->pinned)
      s->slack = slack + part * s->step[unknown_of(s, s->middle) + PATH_SIZE];
    s->action = look(s, s->trial, part == 1.0);
    s->fresh = part == 1.0;
    const double after = length(s->right, s->unknowns);
    if (after < before * (1.0 - 0.1 * part) || (part == 1.0 && after < polish_small)) {
      memcpy(z, s->trial, n * sizeof *z);
      return 1;
    }
  }
  s->slack = slack;
  return 0;
}

/* What both planes leave out of the action. */
static double outside(const pendres_way *path, size_t pieces)
{
  const double *a = path->z, *b = path->z + PATH_SIZE * pieces;
  const double *l = path->to.plane, c = l[0] * b[PATH_P] + l[1] * b[PATH_Q];
  return 0.5 * (a[PATH_P] * (a[PATH_X] - path->from.x) + a[PATH_Q] * (a[PATH_V] - path->from.v)) +
         0.5 * c * c * l[2];
}

/* Where the middle is to be: so much later than it is, along the path. */
static void aim(system_t *s)
{
  const pendres_way *path = s->path;
  const double *z = path->z + PATH_SIZE * s->middle;
  const int pieces = path->flow->grid.pieces, phase = (int)(s->middle % (size_t)pieces);
  double d[PATH_SIZE];
  pendres_way_slope(&path->flow->p, cos(two_pi * phase / pieces), z, d);
  s->steep = hypot(d[PATH_X], d[PATH_V]);
  for (int i = 0; i < 2; i++) {
    s->along[i] = d[i] / s->steep;
    s->target[i] = z[i] + path->shift * d[i];
  }
}

static pendres_status iterate(pendres_context *ctx, system_t *s, pendres_way *path,
                              gsl_vector_uint *order)
{
  const size_t values = s->unknowns;
  int close = 0;
  aim(s);
  for (int k = 0; k < POLISH_NEWTON; k++) {
    const pendres_status stop = pendres_context_poll(ctx);
    if (stop != PENDRES_OK) return stop;
    if (!s->fresh) s->action = look(s, path->z, 1);
    const double action = s->action;
    if (!isfinite(action)) return PENDRES_NOT_CONVERGED;
    path->residual = length(s->right, values);
    path->ends = outside(path, s->pieces);
    path->slack = path->pinned ? s->slack * s->steep : 0.0;
    path->action = action + path->ends;
    if (close || path->residual < polish_rounding) return PENDRES_OK;
    if (!solve(s, order)) return PENDRES_NOT_CONVERGED;
    const double size = length(s->step, values);
    if (!go(s, path->z)) return size < polish_small ? PENDRES_OK : PENDRES_NOT_CONVERGED;
    close = size < polish_last;
  }
  return PENDRES_NOT_CONVERGED;
}

pendres_status pendres_way_polish(pendres_context *ctx, pendres_way *path)
{
  system_t s = {.path = path};
  s.pieces = (size_t)path->periods * (size_t)path->flow->grid.pieces;
  s.unknowns = PATH_SIZE * (s.pieces + 1) + (size_t)(path->pinned != 0);
  s.middle = path->middle;
  pendres_room room = pendres_room_open(ctx, "the path of an escape");
  s.band = pendres_room_take(&room, s.unknowns * ROW, sizeof *s.band);
  s.right = pendres_room_take(&room, s.unknowns, sizeof *s.right);
  s.step = pendres_room_take(&room, s.unknowns, sizeof *s.step);
  unsigned *pivots = pendres_room_take(&room, s.unknowns, sizeof *pivots);
  s.trial = pendres_room_take(&room, PATH_SIZE * (s.pieces + 1), sizeof *s.trial);
  path->residual = path->action = path->ends = NAN;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  gsl_vector_uint_view order = gsl_vector_uint_view_array(pivots, s.unknowns);
  return pendres_room_close(&room, iterate(ctx, &s, path, &order.vector));
}
