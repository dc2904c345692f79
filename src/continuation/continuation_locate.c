/* continuation_locate.c -- folds, flips and cusps with their errors; see continuation_locate.h. */
#include "continuation/continuation_locate.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "continuation/continuation_arc.h"
#include "engine/steps.h"

/* The rounding of a step, taken three times as large as it usually is, since errors claim to be
   bounds. */
static const double epsilon = 4e-16;

/* By how much the unknowns move when each equation is off by so much, with either sign. 0 if
   singular. */
static int moved_by(const pendres_continuation_equations *e, const int *unknown,
                    const double off[PENDRES_EQUATIONS_MOST],
                    double moved[PENDRES_EQUATIONS_MOST])
{
  const int n = e->equations;
  for (int i = 0; i < n; i++) moved[i] = 0.0;
  for (int column = 0; column < n; column++) {
    double a[PENDRES_U_COUNT][PENDRES_U_COUNT], b[PENDRES_U_COUNT] = {0.0};
    for (int r = 0; r < n; r++)
      for (int k = 0; k < n; k++) a[r][k] = e->j[r][unknown[k]];
    b[column] = off[column];
    if (!pendres_continuation_equations_linear(n, a, b)) return 0;
    for (int i = 0; i < n; i++) moved[i] = hypot(moved[i], b[i]);
  }
  return 1;
}

/* What rounding of the map adds to each equation. The derivatives of the map are a few times less
   exact than the map itself; the third equation of a cusp comes from differences over a
   hundredth. */
static void rounding_of(const pendres_continuation_equations *e, int steps, int period,
                        double off[PENDRES_EQUATIONS_MOST])
{
  const double unit = epsilon * fmax(1.0, hypot(e->j[0][0], e->j[1][1])) * sqrt(steps * period);
  off[0] = off[1] = unit;
  off[2] = 4.0 * unit;
  off[3] = 400.0 * unit;
}

/* What the equations of the place differ by from those that it solves; the trace as one. */
static void residuals_of(const pendres_continuation_image *at,
                         const pendres_continuation_image *solved,
                         double off[PENDRES_EQUATIONS_MOST])
{
  off[0] = at->f[0] - solved->f[0];
  off[1] = at->f[1] - solved->f[1];
  off[2] = at->n[0][0] - solved->n[0][0] + (at->n[1][1] - solved->n[1][1]);
  off[3] = 0.0;
}

/*
 * What the map with more steps leaves of the equations where that with fewer has solved them: by
 * that with the finer steps, and by one halfway to them. An order-8 method's errors fall at once
 * from the first to the second, and hardly from there to the third; where its order has not set in
 * yet the last two may differ as much as the first two, or the first and the last agree by chance.
 * So what the last two differ by counts as well, times what it would be less in order 8.
 *
 * Errors of the steps act like a change of coordinates for the most part, which a trace does not
 * feel: its parts cancel by right. As of an orbit, an eighth of what they differ by is left.
 */
static pendres_status apart_of(pendres_context *ctx, const pendres_continuation_pair *pair,
                               double off[PENDRES_EQUATIONS_MOST])
{
  const int between = (pair->coarse_steps + pair->fine_steps) / 4 * 2;
  const int steps[] = {pair->coarse_steps, between, pair->fine_steps};
  pendres_continuation_image image[3];
  for (int i = 0; i < 3; i++) {
    const pendres_status status = pendres_continuation_map_states(
      ctx, &pair->map, steps[i], 1, (const double (*)[PENDRES_U_COUNT])pair->coarse, &image[i]);
    if (status != PENDRES_OK) return status;
  }
  const double middle = pow((double)steps[0] / steps[1], 8);
  const double fine = pow((double)steps[0] / steps[2], 8);
  const double times = (1.0 - fine) / (middle - fine);
  double late[PENDRES_EQUATIONS_MOST];
  residuals_of(&image[2], &image[0], off);
  residuals_of(&image[2], &image[1], late);
  for (int k = 0; k < PENDRES_EQUATIONS_MOST; k++)
    off[k] = fmax(fabs(off[k]), times * fabs(late[k]));
  const double parts = fabs(image[2].n[0][0] - image[0].n[0][0]) +
                       fabs(image[2].n[1][1] - image[0].n[1][1]);
  off[2] = fmax(off[2], 0.125 * parts);
  return PENDRES_OK;
}

/*
 * Second derivative of the parameter by arclength in the (x, v) plane at a fold: with N v = v,
 * l N = l and F(z, p) = G - z, p'' = -l . D2F(v, v) / l . dF/dp. D2F by central differences
 * of the derivative N over h.
 */
static pendres_status curvature_of(pendres_context *ctx,
                                   const pendres_continuation_system *system,
                                   const double u[PENDRES_U_COUNT], double h, double *out)
{
  const int parameter = system->unknown[0];
  pendres_continuation_image image[3];
  double points[3][PENDRES_U_COUNT];
  pendres_status status = pendres_continuation_map_images(
    ctx, system, 1, (const double (*)[PENDRES_U_COUNT])u, image);
  if (status != PENDRES_OK) return status;
  const double a = image[0].j[0][0], b = image[0].j[0][1], c = image[0].j[1][0],
               d = image[0].j[1][1];
  const int upper = hypot(a, b) > hypot(c, d), left = hypot(a, c) > hypot(b, d);
  const double v[2] = {upper ? -b : -d, upper ? a : c};
  const double l[2] = {left ? -c : -d, left ? a : b};
  const double omega = u[PENDRES_U_OMEGA], length = hypot(v[0], omega * v[1]);
  for (int i = 0; i < 3; i++) {
    memcpy(points[i], u, sizeof points[i]);
    points[i][PENDRES_U_Y] += (i - 1) * h * v[0] / length;
    points[i][PENDRES_U_W] += (i - 1) * h * v[1] / length;
  }
  status = pendres_continuation_map_images(
    ctx, system, 3, (const double (*)[PENDRES_U_COUNT])points, image);
  if (status != PENDRES_OK) return status;
  double top = 0.0, bottom = 0.0;
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 2; k++)
      top += l[i] * (image[2].n[i][k] - image[0].n[i][k]) / (2.0 * h) * v[k] / length;
    bottom += l[i] * image[1].j[i][parameter];
  }
  *out = -top / bottom;
  return PENDRES_OK;
}

/* Solve a system with its own steps, and again with more. */
static pendres_status solve_twice(pendres_context *ctx, pendres_continuation_system system,
                                  const double u[PENDRES_U_COUNT], double reach,
                                  pendres_located *out)
{
  pendres_continuation_equations at;
  pendres_continuation_pair *pair = &out->pair;
  const int n = system.unknowns, steps = system.steps, *unknown = system.unknown;
  double off[PENDRES_EQUATIONS_MOST];
  double apart[PENDRES_EQUATIONS_MOST], rounding[PENDRES_EQUATIONS_MOST];

  pair->map = *system.map;
  pair->critical = 1;
  pair->coarse_steps = steps;
  pair->fine_steps = pendres_steps_rung((int)ceil(1.4 * steps));
  pair->fine_steps += pair->fine_steps % 2;
  memcpy(pair->coarse, u, sizeof pair->coarse);
  pendres_status status =
    pendres_continuation_equations_solve(ctx, &system, fmin(reach, 0.1), pair->coarse, &at);
  if (status == PENDRES_OK && !(pendres_arc_distance(u, pair->coarse) <= reach))
    status = PENDRES_NOT_CONVERGED;
  if (status != PENDRES_OK) return status;
  memcpy(pair->fine, pair->coarse, sizeof pair->fine);
  system.steps = pair->fine_steps;
  status = pendres_continuation_equations_solve(ctx, &system, 0.01, pair->fine, &at);
  if (status != PENDRES_OK) return status;
  rounding_of(&at, pair->fine_steps, pair->map.period, off);
  if (!moved_by(&at, unknown, off, rounding)) return PENDRES_NOT_CONVERGED;
  status = apart_of(ctx, pair, off);
  if (status != PENDRES_OK) return status;
  if (!moved_by(&at, unknown, off, apart)) return PENDRES_NOT_CONVERGED;
  for (int i = 0; i < n; i++) {
    const double a = pair->coarse[unknown[i]], b = pair->fine[unknown[i]];
    out->error[i] = pendres_continuation_orbit_error(
      a, b, rounding[i] + 0.12 * apart[i] + 0.5 * DBL_EPSILON * fabs(b));
  }
  pair->rounding = hypot(rounding[0], rounding[1]);
  pair->apart = hypot(apart[0], apart[1]);
  return PENDRES_OK;
}

pendres_status pendres_continuation_locate(pendres_context *ctx,
                                           const pendres_continuation_system *of,
                                           const double u[PENDRES_U_COUNT], double reach,
                                           pendres_located *out)
{
  enum { MOST_TRIES = 5 };
  const double tolerance = ctx->options.tolerance;
  pendres_continuation_system system = *of;
  pendres_status status = pendres_continuation_map_steps(
    ctx, system.map->force, u, pendres_accuracy_first(ctx), &system.steps);
  double from[PENDRES_U_COUNT];
  memcpy(from, u, sizeof from);
  for (int attempt = 0; attempt < MOST_TRIES && status == PENDRES_OK; attempt++) {
    double worst = 0.0;
    status = solve_twice(ctx, system, from, reach, out);
    if (status != PENDRES_OK) return status;
    for (int i = 2; i < system.unknowns; i++) worst = fmax(worst, out->error[i]);
    if (worst <= tolerance) return PENDRES_OK;
    if (ctx->options.steps_per_period > 0) break;
    memcpy(from, out->pair.fine, sizeof from);
    system.steps = out->pair.fine_steps;
  }
  return status == PENDRES_OK ? PENDRES_TOLERANCE_UNREACHABLE : status;
}

int pendres_located_found(pendres_status status)
{
  return status == PENDRES_OK || status == PENDRES_TOLERANCE_UNREACHABLE;
}

pendres_status pendres_continuation_locate_finish(pendres_context *ctx,
                                                  pendres_continuation_condition condition,
                                                  pendres_parameter parameter,
                                                  const pendres_located *l,
                                                  pendres_bifurcation *out)
{
  const int place = PENDRES_U_OMEGA + (int)parameter;
  const pendres_continuation_pair *p = &l->pair;
  *out = (pendres_bifurcation){.parameter = parameter,
                               .value = p->fine[place],
                               .value_error = l->error[2],
                               .curvature = NAN,
                               .curvature_error = NAN};
  out->kind = condition == PENDRES_CONDITION_FOLD ? PENDRES_FOLD
              : p->map.mirror                     ? PENDRES_SYMMETRY_BREAKING
                                                  : PENDRES_PERIOD_DOUBLING;
  pendres_status status = pendres_continuation_orbit_measure(ctx, 1, p, &out->orbit);
  pendres_continuation_orbit_set_critical(out->kind, 1, &parameter, &out->value_error, &out->orbit);
  if (status != PENDRES_OK || condition != PENDRES_CONDITION_FOLD) return status;
  /* Truncation h^2 and rounding 1e-15/h meet here; twice the width tells how large they are. */
  const double h = 1e-4;
  double wide = 0.0, coarse = 0.0;
  pendres_continuation_system at = {
    .map = &p->map, .steps = p->fine_steps, .unknowns = 1, .unknown = &place};
  status = curvature_of(ctx, &at, p->fine, h, &out->curvature);
  if (status == PENDRES_OK) status = curvature_of(ctx, &at, p->fine, 2.0 * h, &wide);
  at.steps = p->coarse_steps;
  if (status == PENDRES_OK) status = curvature_of(ctx, &at, p->coarse, h, &coarse);
  out->curvature_error = fabs(wide - out->curvature) +
                         pendres_continuation_orbit_error(coarse, out->curvature,
                                                          1e-10 * fabs(out->curvature));
  return status;
}
