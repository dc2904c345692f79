/* orbit.c -- measures of orbits found by continuation; see orbit.h. */
#include "continuation/curve/orbit.h"

#include <float.h>
#include <math.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/equation.h"
#include "orbits/numbers.h"
#include "orbits/orbit_error.h"
#include "orbits/orbit_reading.h"

double pendres_solution_error(double coarse, double fine, double rounding)
{
  /* An order-8 method's error falls to a fifteenth with 1.4 times the steps; a quarter of the
     difference is claimed, for where the order has not set in yet. */
  return claimed_share * fabs(fine - coarse) + rounding;
}

void pendres_orbit_set_critical(pendres_special kind, int parameters,
                                const pendres_parameter *parameter, const double *error,
                                pendres_orbit *o)
{
  const double rate = pendres_orbit_contraction(o);
  const double omega = o->pendulum.drive_frequency, time = two_pi * o->period / omega;
  const double product = exp(-rate * time);
  const double critical = kind == PENDRES_PERIOD_DOUBLING ? -1.0 : 1.0;
  double off = DBL_EPSILON * (1.0 + rate * time); /* of the product, relative */
  for (int k = 0; k < parameters; k++) {
    if (parameter[k] == PENDRES_DAMPING) off += time * error[k];
    if (parameter[k] == PENDRES_DRIVE_FREQUENCY) off += rate * time * error[k] / omega;
  }
  o->multiplier_re[0] = critical;
  o->multiplier_re[1] = critical * product;
  o->multiplier_im[0] = o->multiplier_im[1] = 0.0;
  /* Along an orbit, the product is known no better than the multipliers were. */
  if (!pendres_equation_drags(&o->pendulum)) o->multiplier_error = product * off;
  o->stable = 0;
}

static int winding_of(const pendres_map *map)
{
  return map->mirror ? 0 : map->winding;
}

/*
 * The samples of one candidate. Its point solves the equations already, to the last place: what
 * that is off by may have grown a hundred thousandfold on the way and is taken out, where the orbit
 * at given parameters tells by how much.
 */
static int take(void *arg, const pendres_newton_candidate *c,
                const pendres_newton_samples *taken, double *y, double *w,
                pendres_orbit_computed *out)
{
  const pendres_solution *p = (const pendres_solution *)arg + c->index;
  double shift[2];
  (void)out;
  if (!taken->bends && !p->critical && pendres_newton_closed(c, taken, y, w, shift) &&
      hypot(shift[0], shift[1]) <= p->rounding)
    return 1;
  for (size_t k = 0; k < taken->count; k++) {
    const double *row = pendres_newton_sample(taken, k, c->lane);
    y[k] = row[0];
    w[k] = row[1];
  }
  return 1;
}

/* Integrate all pairs at their coarse or their fine steps. */
static pendres_status read_all(pendres_context *ctx, size_t n, const pendres_solution *pairs,
                               int fine, pendres_orbit_computed *out)
{
  const pendres_orbit_reader reader = {
    .want = PENDRES_ORBIT_PLAIN, .bends = !fine, .take = take, .arg = (void *)pairs, .out = out};
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_newton_candidate *c = pendres_room_take(&room, n, sizeof *c);
  pendres_orbit_guess *guess = pendres_room_take(&room, n, sizeof *guess);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    const pendres_solution *p = &pairs[i];
    const double *u = fine ? p->fine : p->coarse;
    guess[i] = (pendres_orbit_guess){.pendulum = pendres_map_pendulum(p->map.force, u),
                                     .period = p->map.period,
                                     .winding = winding_of(&p->map)};
    c[i] = (pendres_newton_candidate){.guess = &guess[i],
                                      .index = i,
                                      .y = u[PENDRES_U_Y],
                                      .w = u[PENDRES_U_W],
                                      .steps = fine ? p->fine_steps : p->coarse_steps,
                                      .state = PENDRES_NEWTON_CONVERGED};
  }
  return pendres_room_close(&room, pendres_orbit_read(ctx, &reader, n, c));
}

/*
 * What rounding makes of y and w along the orbit, where it may grow and fade again within a period;
 * step: of an angle of order one in a step. The equations of a bifurcation have an inverse of their
 * own, that of I - M is singular there: what it makes of the start is larger along the orbit.
 */
static double rounding_along(const pendres_solution *pair, const pendres_orbit_computed *fine,
                             double step)
{
  if (pair->critical) return pair->rounding * fine->noise.swell;
  const double y = pair->fine[PENDRES_U_Y], w = pair->fine[PENDRES_U_W];
  const double size = fmax(fine->measures.amplitude, fmax(fabs(y), fabs(w)));
  return fmax(pair->rounding, step * size * fine->noise.along);
}

static void fill(const pendres_solution *pair, pendres_orbit_computed *a,
                 const pendres_orbit_computed *b, double step, pendres_orbit *o)
{
  const double from[2] = {b->y - a->y, b->w - a->w};
  const double along = pendres_orbit_measures_apart(&a->measures, &b->measures, pair->map.period);
  /* The equations of a bifurcation do not multiply errors by the inverse of I - M, which is
     singular there, but by their own. */
  const double beside = pair->critical ? pair->apart : pendres_orbit_apart_beside(a, b, from);
  const double apart = fmax(fmax(hypot(from[0], from[1]), along), beside);

  /* Velocities are compared, since the two computations may differ in the drive frequency. */
  a->w *= pair->coarse[PENDRES_U_OMEGA] / pair->fine[PENDRES_U_OMEGA];
  const pendres_orbit_twice two = {
    .pendulum = pendres_map_pendulum(pair->map.force, pair->fine),
    .period = pair->map.period,
    .winding = winding_of(&pair->map),
    .steps = pair->fine_steps,
    .coarse = a,
    .fine = b,
    .at_start = {apart, pair->rounding},
    .along = {apart, rounding_along(pair, b, step)},
    .rounding = step * sqrt((double)pair->fine_steps * pair->map.period)};
  pendres_orbit_set(&two, o);
}

pendres_status pendres_solution_measure(pendres_context *ctx, size_t n,
                                        const pendres_solution *pairs, pendres_orbit *out)
{
  const double step = pendres_newton_rounding(ctx->options.table);
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_orbit_computed *coarse = pendres_room_take(&room, n, sizeof *coarse);
  pendres_orbit_computed *fine = pendres_room_take(&room, n, sizeof *fine);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = read_all(ctx, n, pairs, 0, coarse);
  if (status == PENDRES_OK) status = read_all(ctx, n, pairs, 1, fine);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    fill(&pairs[i], &coarse[i], &fine[i], step, &out[i]);
  return pendres_room_close(&room, status);
}
