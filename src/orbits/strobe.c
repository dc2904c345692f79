/* strobe.c -- the stroboscopic map of any list of pendulums; see strobe.h. */
#include <pendres/strobe.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "orbits/strobe_noise.h"
#include "engine/strobe_run.h"
#include "model/model.h"
#include "orbits/numbers.h"

static pendres_status check(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                            const double *x, const double *v, long periods)
{
  const char *why = NULL;
  if (periods < 0)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "the number of periods is %ld, and must not be negative", periods);
  for (size_t i = 0; i < n; i++) {
    if (pendres_pendulum_check(&p[i], &why) == PENDRES_OK)
      why = pendres_coordinates_refuses(&p[i], x[i], v[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  return PENDRES_OK;
}

/* Fail if a state is not a number. */
static pendres_status check_ends(pendres_context *ctx, size_t n, const pendres_strobe_lane *lanes)
{
  for (size_t i = 0; i < n; i++)
    if (!(isfinite(lanes[i].y) && isfinite(lanes[i].w)))
      return pendres_strobe_lost(ctx, lanes[i].pendulum, lanes[i].period);
  return PENDRES_OK;
}

/* How many periods leave their errors at the end: errors fade in proportion. */
static double periods_that_count(const pendres_pendulum *p, long periods)
{
  const double decay = -expm1(-pendres_equation_fading(p));
  return 1.0 / fmax(decay, 1.0 / fmax(1.0, (double)periods));
}

/* Choose the steps of lanes that start from x and v, where steps are fixed. */
static pendres_status choose_steps(pendres_context *ctx, size_t n, const double *x,
                                   const double *v, long periods, pendres_strobe_lane *lanes)
{
  if (!pendres_method_of(ctx)->fixed_steps) return PENDRES_OK;
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum *p = lanes[i].pendulum;
    const pendres_status status =
      pendres_steps_choose(ctx, p, pendres_steps_speed(p, x[i], v[i]),
                           pendres_accuracy_of_run(ctx, periods_that_count(p, periods)),
                           &lanes[i].steps);
    if (status != PENDRES_OK) return status;
  }
  return PENDRES_OK;
}

/*
 * A clock that runs on from period to period is rounded at each step, by up to half a unit of its
 * last place. Errors that have not faded add up at random, from some hundred steps a period. The
 * state's own rounding is far below. A block's clock starts again each period.
 */
static double clock_noise(const pendres_context *ctx, const pendres_pendulum *p, long periods)
{
  if (!pendres_method_of(ctx)->running_clock) return 0.0;
  const double step = 0.5 * last_place_of_one * two_pi * (double)periods;
  return step * sqrt(100.0 * periods_that_count(p, periods));
}

/* |a - b| of two states, in x and v. */
static double distance(const pendres_strobe_lane *a, const pendres_coordinates *b)
{
  const double dy = (a->y - b->y) + two_pi * (double)(a->turns - b->turns);
  const double dv = (a->w - b->w) * a->pendulum->drive_frequency;
  return fmax(fabs(dy), fabs(dv));
}

/*
 * The coefficients of the equation, of the method, and the step are rounded once for the whole run:
 * free oscillations are as wrong as if time went by faster by some units in its last place. That
 * grows with time, the steps' own rounding with its root; it is more where a weakly damped pendulum
 * oscillates hundreds of times in a slow drive. Two units: halves of one each come from the square
 * of the frequency, the division by it, the step and the sum of the method's weights.
 */
static double drift_of(const pendres_strobe_lane *l)
{
  const pendres_pendulum *p = l->pendulum;
  const double period = two_pi / p->drive_frequency;
  const double late = 2.0 * DBL_EPSILON * period * periods_that_count(p, l->period);
  double force, slope;
  pendres_model_force(p, l->y, &force, &slope);
  const double v = l->w * p->drive_frequency;
  const double pull = p->torque + p->drive_amplitude - (1.0 + p->parametric_amplitude) * force;
  return late * fmax(fabs(v), fabs(pull - pendres_equation_friction(p, l->y, v) * v));
}

/*
 * The error, from the distance of two runs, the standard error of rounding, and what is lost where
 * whole turns and the velocity are put together.
 */
static double error_of(double apart, double noise, const pendres_strobe_lane *l)
{
  const double v = fabs(l->w) * l->pendulum->drive_frequency;
  return pendres_strobe_error(apart) + fmax(2.0 * noise, noise + drift_of(l)) +
         last_place_of_one * fmax(8.0 + two_pi * fabs((double)l->turns), v);
}

/* ---- runs beside each other ------------------------------------------------------------------ */

/*
 * The strobes at which a better run is compared with the first. Runs that separate on the
 * way may meet again at the end, both on an attractor that the pendulum itself never comes to, so
 * they are compared at each strobe, and advanced by turns, a stretch of periods at a time. Methods
 * that choose their own steps would choose others if they were stopped: their whole run is one
 * stretch, and compared at MOST_COMPARED strobes at most.
 */
typedef struct stretch {
  long periods;      /* of the whole run */
  long last;         /* the stretch ends at this strobe */
  long length;       /* in periods */
  long every;        /* counted from its end, every `every`-th strobe is compared */
  size_t slots;      /* strobes of a lane that are compared in a stretch */
  pendres_coordinates *at; /* n * slots: where the first run was */
  double *apart;     /* n: distances at the end; infinite once two runs have separated */
} stretch;

/* Where the first run was at a strobe of the stretch; NULL if that strobe is not compared. */
static pendres_coordinates *place_of(const stretch *s, size_t index, long period)
{
  const long left = s->last - period;
  return left % s->every == 0 ? &s->at[index * s->slots + (size_t)(left / s->every)] : NULL;
}

static int keep(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const stretch *s = arg;
  pendres_coordinates *at = place_of(s, index, lane->period);
  if (at != NULL) *at = (pendres_coordinates){.y = lane->y, .w = lane->w, .turns = lane->turns};
  return lane->period >= s->last;
}

static int compare(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const stretch *s = arg;
  const pendres_coordinates *at = place_of(s, index, lane->period);
  const double apart = at != NULL ? distance(lane, at) : 0.0;
  if (!(pendres_strobe_error(apart) < INFINITY)) s->apart[index] = INFINITY;
  if (lane->period == s->periods) s->apart[index] = fmax(s->apart[index], apart);
  return lane->period >= s->last;
}

/* Prepare a comparison of n lanes. */
static stretch stretch_open(pendres_room *room, size_t n, long periods)
{
  const long fit = (long)(((size_t)1 << 20) / n); /* 24 MB */
  const long most = fit < 1 ? 1 : fit < STROBE_MOST_COMPARED ? fit : STROBE_MOST_COMPARED;
  stretch s = {.periods = periods, .length = periods, .every = 1};
  if (pendres_method_of(room->ctx)->fixed_steps) s.length = periods < most ? periods : most;
  else s.every = (periods + STROBE_MOST_COMPARED - 1) / STROBE_MOST_COMPARED;
  s.slots = (size_t)((s.length + s.every - 1) / s.every);
  s.at = pendres_room_take(room, n * s.slots, sizeof *s.at);
  s.apart = pendres_room_take(room, n, sizeof *s.apart);
  return s;
}

/*
 * The better run has twice the steps, and is compared with the first, stretch by stretch. Fewer
 * steps would not suffice: where steps are few, errors do not yet fall with the order of the
 * method, and a run with half as many more may have an equally large error of the same sign.
 * noise[n] receives the rounding errors.
 */
static pendres_status run_with_twice_the_steps(pendres_context *ctx, size_t n, stretch *s,
                                               pendres_strobe_lane *lanes,
                                               pendres_strobe_lane *finer, double *noise)
{
  const double rounding = pendres_strobe_noise_of_step(ctx->options.table);
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) {
    finer[i] = lanes[i];
    finer[i].steps = pendres_steps_rung(2 * lanes[i].steps);
    finer[i].added = rounding * rounding;
  }
  while (s->last < s->periods && status == PENDRES_OK) {
    s->last += s->length < s->periods - s->last ? s->length : s->periods - s->last;
    status = pendres_strobe_run(ctx, n, lanes, keep, s);
    if (status == PENDRES_OK) status = check_ends(ctx, n, lanes);
    if (status == PENDRES_OK) status = pendres_strobe_run(ctx, n, finer, compare, s);
  }
  for (size_t i = 0; i < n; i++)
    noise[i] = pendres_strobe_noise_of(finer[i].pendulum->drive_frequency, &finer[i].off);
  return status;
}

/*
 * There are two better runs, each with a smaller tolerance, since adaptive steps follow their
 * tolerance only loosely. Where stability limits the steps, a tenth of the tolerance changes almost
 * nothing, and three runs may have equally large errors of the same sign: one-step methods are
 * therefore forced to take more steps in the better runs.
 */
static pendres_status run_with_less_tolerance(pendres_context *ctx, size_t n, stretch *s,
                                              pendres_strobe_lane *lanes,
                                              pendres_strobe_lane *finer, double *noise)
{
  const double tolerance[] = {pendres_accuracy_second(ctx), pendres_accuracy_third(ctx)};
  static const double more[] = {finer_steps, 2.0};
  pendres_strobe_lane *start = malloc(n * sizeof *start);
  if (start == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  memcpy(start, lanes, n * sizeof *start);
  s->last = s->periods;
  pendres_status status = pendres_strobe_run(ctx, n, lanes, keep, s);
  if (status == PENDRES_OK) status = check_ends(ctx, n, lanes);
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    memcpy(finer, start, n * sizeof *start);
    for (size_t i = 0; i < n; i++)
      finer[i].longest = two_pi * (double)s->periods / (more[k] * lanes[i].taken);
    status = pendres_strobe_run_within(ctx, tolerance[k], n, finer, compare, s);
  }
  for (size_t i = 0; i < n; i++) noise[i] = clock_noise(ctx, lanes[i].pendulum, s->periods);
  free(start);
  return status;
}

/* Run the lanes to the end; error[n] receives the errors there. */
static pendres_status run_with_errors(pendres_context *ctx, size_t n, long periods,
                                      pendres_strobe_lane *lanes, double *error)
{
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_strobe_lane *finer = pendres_room_take(&room, n, sizeof *finer);
  stretch s = stretch_open(&room, n, periods);
  pendres_status status = room.status;
  if (status == PENDRES_OK)
    status = pendres_method_of(ctx)->fixed_steps
               ? run_with_twice_the_steps(ctx, n, &s, lanes, finer, error)
               : run_with_less_tolerance(ctx, n, &s, lanes, finer, error);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    error[i] = error_of(s.apart[i], error[i], &lanes[i]);
  return pendres_room_close(&room, status);
}

static pendres_status strobe_advance(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, double *x, double *v,
                                     long periods, double *error)
{
  if (n > 0 && (pendulums == NULL || x == NULL || v == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x and v");
  pendres_status status = check(ctx, n, pendulums, x, v, periods);
  if (status != PENDRES_OK || n == 0) return status;
  if (periods == 0) {
    for (size_t i = 0; error != NULL && i < n; i++) error[i] = 0.0;
    return PENDRES_OK;
  }

  pendres_strobe_lane *lanes = malloc(n * sizeof *lanes);
  if (lanes == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  for (size_t i = 0; i < n; i++) lanes[i] = pendres_strobe_lane_at(&pendulums[i], x[i], v[i]);
  status = choose_steps(ctx, n, x, v, periods, lanes);
  if (status == PENDRES_OK && error != NULL) {
    status = run_with_errors(ctx, n, periods, lanes, error);
  } else if (status == PENDRES_OK) {
    status = pendres_strobe_run_until(ctx, n, lanes, periods);
    if (status == PENDRES_OK) status = check_ends(ctx, n, lanes);
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&lanes[i], &x[i], &v[i]);
  free(lanes);
  return status;
}

pendres_status pendres_strobe_advance(pendres_context *ctx, size_t n,
                                      const pendres_pendulum *pendulums, double *x, double *v,
                                      long periods, double *error)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    double *x_out = pendres_door_out_run(&d, &pendres_dim_length, x);
    double *v_out = pendres_door_out_run(&d, &pendres_dim_speed, v);
    double *e_out = pendres_door_out_run(&d, &pendres_dim_length, error);
    PENDRES_DOOR_CALL(&d, strobe_advance(ctx, d.count, p, x_out, v_out, periods, e_out));
  }
  return pendres_door_close(&d);
}
