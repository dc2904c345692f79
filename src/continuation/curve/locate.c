/* locate.c -- folds, flips and cusps with their errors; see locate.h. */
#include "continuation/curve/locate.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "continuation/curve/crossing.h"
#include "continuation/curve/numbers.h"
#include "engine/steps.h"

/* By how much the unknowns move when the equations are off by so much, all at once. 0 if
   singular. */
static int moved_at_once(const pendres_equations *e, const int *unknown,
                         const double off[PENDRES_EQUATIONS_MOST],
                         double moved[PENDRES_EQUATIONS_MOST])
{
  const int n = e->equations;
  double a[PENDRES_U_COUNT][PENDRES_U_COUNT], b[PENDRES_U_COUNT] = {0.0};
  for (int r = 0; r < n; r++) {
    for (int k = 0; k < n; k++) a[r][k] = e->j[r][unknown[k]];
    b[r] = off[r];
  }
  if (!pendres_equations_linear(n, a, b)) return 0;
  for (int i = 0; i < n; i++) moved[i] = fabs(b[i]);
  return 1;
}

/* The same where each equation is off by so much with either sign. */
static int moved_by_each(const pendres_equations *e, const int *unknown,
                         const double off[PENDRES_EQUATIONS_MOST],
                         double moved[PENDRES_EQUATIONS_MOST])
{
  const int n = e->equations;
  for (int i = 0; i < n; i++) moved[i] = 0.0;
  for (int column = 0; column < n; column++) {
    double one[PENDRES_EQUATIONS_MOST] = {0.0}, by[PENDRES_EQUATIONS_MOST];
    one[column] = off[column];
    if (!moved_at_once(e, unknown, one, by)) return 0;
    for (int i = 0; i < n; i++) moved[i] = hypot(moved[i], by[i]);
  }
  return 1;
}

/* What rounding of the map adds to each equation. The derivatives of the map are a few times less
   exact than the map itself, and change with what rounding makes of the orbit; the third equation
   of a cusp comes from differences over a hundredth. Of a state far out rounding is larger. */
static void rounding_of(const pendres_system *s, const pendres_equations *e, const pendres_u u,
                        double off[PENDRES_EQUATIONS_MOST])
{
  const double large = pendres_arc_large(&s->map, u);
  const double along = pendres_step_rounding * sqrt(s->steps * s->map.period);
  const double unit = along * fmax(1.0, pendres_map_growth(&e->image));
  off[0] = off[1] = large * unit;
  off[2] = hypot(4.0 * unit, large * along * hypot(e->j[2][PENDRES_U_Y], e->j[2][PENDRES_U_W]));
  off[3] = 400.0 * unit;
  if (s->condition == PENDRES_CONDITION_CROSSING)
    off[1] = hypot(4.0 * unit, large * along * hypot(e->j[1][PENDRES_U_Y], e->j[1][PENDRES_U_W]));
}

/* What the equations of the place differ by from those that it solves; the last one of a cusp
   follows the others, that of a branch point is what they leave. */
static void residuals_of(const pendres_system *system, const pendres_crossing_pivot *pivot,
                         const pendres_image *at, const pendres_image *solved,
                         double off[PENDRES_EQUATIONS_MOST])
{
  const pendres_condition condition = system->condition;
  if (condition == PENDRES_CONDITION_CROSSING) {
    double is[4], was[4];
    pendres_crossing_rows(pivot, at, is);
    pendres_crossing_rows(pivot, solved, was);
    for (int k = 0; k < PENDRES_EQUATIONS_MOST; k++) off[k] = is[k] - was[k];
    return;
  }
  off[0] = at->f[0] - solved->f[0];
  off[1] = at->f[1] - solved->f[1];
  const pendres_condition_rules *rules = pendres_condition_rules_of(condition);
  off[2] = rules->determinant != NULL ? rules->determinant(at) - rules->determinant(solved) : 0.0;
  off[3] = 0.0;
}

/* How far the solutions by few and by more steps are apart. */
typedef struct distance {
  double late[PENDRES_EQUATIONS_MOST];  /* as a third number of steps has it */
  double parts[PENDRES_EQUATIONS_MOST]; /* if nothing cancelled */
} distance;

/*
 * What the map with more steps leaves of the equations where that with fewer has solved them: by
 * that with the finer steps, and by one halfway to them. An order-8 method's errors fall at once
 * from the first to the second, and hardly from there to the third; where its order has not set in
 * yet the last two may differ as much as the first two, or the first and the last agree by chance.
 * So what the last two differ by counts as well, times what it would be less in order 8.
 *
 * Errors of the steps act like a change of coordinates for the most part. That moves the orbit, but
 * not the parameter at which it bifurcates, and a trace does not feel it: what the equations differ
 * by cancels by right.
 */
static pendres_status distance_of(pendres_context *ctx, const pendres_system *system,
                                  const pendres_solution *pair, const pendres_equations *at,
                                  distance *out)
{
  const int between = (pair->coarse_steps + pair->fine_steps) / 4 * 2;
  const int steps[] = {pair->coarse_steps, between, pair->fine_steps};
  double early[PENDRES_EQUATIONS_MOST], late[PENDRES_EQUATIONS_MOST];
  const int crosses = system->condition == PENDRES_CONDITION_CROSSING;
  const pendres_crossing_pivot pivot = pendres_crossing_pivot_of(&at->image, system->unknown[2]);
  pendres_system of = *system;
  pendres_image image[3];
  if (!crosses) of.unknowns = 0; /* which need the derivatives by the state alone */
  for (int i = 0; i < 3; i++) {
    of.steps = steps[i];
    const pendres_status status = pendres_map_images(
      ctx, &of, 1, (const pendres_u *)pair->coarse, &image[i]);
    if (status != PENDRES_OK) return status;
  }
  const double middle = pow((double)steps[0] / steps[1], 8);
  const double fine = pow((double)steps[0] / steps[2], 8);
  const double times = (1.0 - fine) / (middle - fine);
  residuals_of(system, &pivot, &image[2], &image[0], early);
  residuals_of(system, &pivot, &image[2], &image[1], late);
  for (int k = 0; k < PENDRES_EQUATIONS_MOST; k++) {
    late[k] *= times;
    early[k] = fmax(fabs(early[k]), fabs(late[k]));
  }
  if (!moved_at_once(at, system->unknown, late, out->late)) return PENDRES_NOT_CONVERGED;
  const double entries = fabs(image[2].n[0][0] - image[0].n[0][0]) +
                         fabs(image[2].n[1][1] - image[0].n[1][1]);
  for (int k = crosses ? 1 : 2; k < 3; k++) early[k] = fmax(early[k], locate_own_share * entries);
  return moved_by_each(at, system->unknown, early, out->parts) ? PENDRES_OK
                                                                : PENDRES_NOT_CONVERGED;
}

/*
 * Second derivative of the parameter by arclength in the (x, v) plane at a fold: with N v = v,
 * l N = l and F(z, p) = G - z, p'' = -l . D2F(v, v) / l . dF/dp. D2F by central differences
 * of the derivative N over h.
 */
static pendres_status curvature_of(pendres_context *ctx, const pendres_system *system,
                                   const pendres_u u, double h, double *out)
{
  const int parameter = system->unknown[0];
  pendres_image image[3];
  pendres_u points[3];
  pendres_status status = pendres_map_images(ctx, system, 1, (const pendres_u *)u, image);
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
  status = pendres_map_images(ctx, system, 3, (const pendres_u *)points, image);
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

/* Whether two branches cross at a place that solves their equations, or only come close: what these
   leave of the closing is rounding, or an error of the steps, which their two numbers tell. */
static int crosses(const pendres_system *system, const pendres_image *coarse,
                   const pendres_image *fine)
{
  const pendres_crossing_pivot pivot = pendres_crossing_pivot_of(fine, system->unknown[2]);
  double few[4], many[4];
  pendres_crossing_rows(&pivot, coarse, few);
  pendres_crossing_rows(&pivot, fine, many);
  return pendres_crossing_closes(fine, system->unknown[2], system->steps * system->map.period,
                                 fabs(many[3] - few[3]));
}

/* Whether what the equations at a solution leave moves no parameter by more than its error, which
   otherwise becomes that large, as does that of the place. Newton's method ends where a short step
   is followed by one that is hardly shorter: at weak damping that need not be rounding yet. */
static pendres_status is_solved(pendres_context *ctx, const pendres_system *system,
                                pendres_located *l, int *solved)
{
  pendres_equations there;
  double moved[PENDRES_EQUATIONS_MOST];
  const pendres_status status = pendres_equations_at(
    ctx, system, 1, (const pendres_u *)l->pair.fine, &there);
  *solved = 1;
  if (status != PENDRES_OK) return status;
  if (!moved_at_once(&there, system->unknown, there.r, moved)) return status;
  for (int i = 0; i < system->unknowns; i++) {
    if (moved[i] <= l->error[i]) continue;
    l->error[i] = moved[i];
    if (i < 2) l->pair.rounding = fmax(l->pair.rounding, moved[i]);
    else *solved = 0;
  }
  return status;
}

/* Solve a system that has been solved with fewer steps, whose image there was `few`, with its own
   steps; and the errors. */
static pendres_status solve_finely(pendres_context *ctx, const pendres_system *system,
                                   const pendres_image *few, pendres_located *out)
{
  pendres_equations at;
  pendres_solution *pair = &out->pair;
  const int *const unknown = system->unknown;
  double off[PENDRES_EQUATIONS_MOST], rounding[PENDRES_EQUATIONS_MOST];
  distance away;
  pendres_status status =
    pendres_equations_solve(ctx, system, locate_longest_again, pair->fine, &at);
  if (status != PENDRES_OK) return status;
  out->parted =
    system->condition == PENDRES_CONDITION_CROSSING && !crosses(system, few, &at.image);
  if (out->parted) return PENDRES_NOT_CONVERGED;
  rounding_of(system, &at, pair->fine, off);
  if (!moved_by_each(&at, unknown, off, rounding)) return PENDRES_NOT_CONVERGED;
  status = distance_of(ctx, system, pair, &at, &away);
  if (status != PENDRES_OK) return status;
  pair->rounding = hypot(rounding[0], rounding[1]);
  pair->apart = 0.0;
  for (int i = 0; i < system->unknowns; i++) {
    const double fine = pair->fine[unknown[i]], coarse = pair->coarse[unknown[i]];
    const double apart = fmax(fabs(fine - coarse), away.late[i]) + locate_by_chance * away.parts[i];
    out->error[i] = pendres_solution_error(
      0.0, apart, rounding[i] + 0.5 * DBL_EPSILON * fabs(fine));
    if (i < 2) pair->apart = hypot(pair->apart, apart);
  }
  return PENDRES_OK;
}

/* Solve a system with its own steps, and again with more. */
static pendres_status solve_twice(pendres_context *ctx, pendres_system system, const pendres_u u,
                                  double reach, pendres_located *out)
{
  pendres_equations at;
  pendres_solution *pair = &out->pair;
  const int steps = system.steps;
  const pendres_pendulum of = pendres_map_pendulum(system.map.force, u);

  pair->map = system.map;
  pair->critical = 1;
  pair->coarse_steps = steps;
  pair->fine_steps = pendres_steps_finer(&of, steps);
  pair->fine_steps += pair->fine_steps % 2;
  memcpy(pair->coarse, u, sizeof pair->coarse);
  pendres_status status =
    pendres_equations_solve(ctx, &system, fmin(reach, locate_longest), pair->coarse, &at);
  if (status == PENDRES_OK && !(pendres_arc_distance(&pair->map, u, pair->coarse) <= reach))
    status = PENDRES_NOT_CONVERGED;
  if (status != PENDRES_OK) return status;
  memcpy(pair->fine, pair->coarse, sizeof pair->fine);
  const pendres_image few = at.image;
  system.steps = pair->fine_steps;
  status = solve_finely(ctx, &system, &few, out);
  for (int times = 0; status == PENDRES_OK && times < TRIES; times++) {
    int solved = 0;
    status = is_solved(ctx, &system, out, &solved);
    if (status != PENDRES_OK || solved) break;
    pendres_located again = *out;
    status = solve_finely(ctx, &system, &few, &again);
    if (status == PENDRES_OK) *out = again;
    if (status == PENDRES_NOT_CONVERGED) return PENDRES_OK; /* the one before is the best */
  }
  return status;
}

pendres_status pendres_locate(pendres_context *ctx, const pendres_system *of,
                              const pendres_u u, double reach, pendres_located *out)
{
  const double tolerance = ctx->options.tolerance;
  pendres_system system = *of;
  pendres_status status = pendres_map_steps(
    ctx, system.map.force, u, pendres_accuracy_first(ctx), &system.steps);
  pendres_u from;
  memcpy(from, u, sizeof from);
  out->parted = 0;
  for (int attempt = 0; attempt < TRIES && status == PENDRES_OK; attempt++) {
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

pendres_special pendres_special_of(pendres_condition condition, const pendres_map *map)
{
  if (condition == PENDRES_CONDITION_FOLD) return PENDRES_FOLD;
  if (condition == PENDRES_CONDITION_CROSSING) return PENDRES_BRANCH_POINT;
  return map->mirror ? PENDRES_SYMMETRY_BREAKING : PENDRES_PERIOD_DOUBLING;
}

pendres_status pendres_locate_bifurcation(pendres_context *ctx, pendres_condition condition,
                                          pendres_parameter parameter, const pendres_located *l,
                                          pendres_bifurcation *out)
{
  const int place = PENDRES_U_OMEGA + (int)parameter;
  const pendres_solution *p = &l->pair;
  *out = (pendres_bifurcation){.parameter = parameter,
                               .value = p->fine[place],
                               .value_error = l->error[2],
                               .curvature = NAN,
                               .curvature_error = NAN,
                               .crossing = {NAN, NAN, NAN}};
  out->kind = pendres_special_of(condition, &p->map);
  pendres_status status = pendres_solution_measure(ctx, 1, p, &out->orbit);
  pendres_orbit_set_critical(out->kind, 1, &parameter, &out->value_error, &out->orbit);
  if (status != PENDRES_OK || condition != PENDRES_CONDITION_FOLD) return status;
  /* Twice the width tells how large truncation and rounding are. */
  const double h = pendres_central_step;
  double wide = 0.0, coarse = 0.0;
  pendres_system at = {
    .map = p->map, .steps = p->fine_steps, .unknowns = 1, .unknown = {place}};
  status = curvature_of(ctx, &at, p->fine, h, &out->curvature);
  if (status == PENDRES_OK) status = curvature_of(ctx, &at, p->fine, 2.0 * h, &wide);
  at.steps = p->coarse_steps;
  if (status == PENDRES_OK) status = curvature_of(ctx, &at, p->coarse, h, &coarse);
  out->curvature_error = fabs(wide - out->curvature) +
                         pendres_solution_error(coarse, out->curvature,
                                                1e-10 * fabs(out->curvature));
  return status;
}

pendres_status pendres_locate_cusp(pendres_context *ctx, const int *unknown,
                                   const pendres_located *l, pendres_cusp *out)
{
  for (int i = 0; i < 2; i++) {
    out->parameter[i] = (pendres_parameter)(unknown[2 + i] - PENDRES_U_OMEGA);
    out->value[i] = l->pair.fine[unknown[2 + i]];
    out->value_error[i] = l->error[2 + i];
  }
  const pendres_status status = pendres_solution_measure(ctx, 1, &l->pair, &out->orbit);
  pendres_orbit_set_critical(PENDRES_FOLD, 2, out->parameter, out->value_error, &out->orbit);
  return status;
}
