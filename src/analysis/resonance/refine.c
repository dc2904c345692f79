/* refine.c -- from a bracket to a resonance with its error; see refine.h. */
#include "analysis/resonance/refine.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "analysis/resonance/numbers.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "orbits/orbit_error.h"
#include "orbits/orbit_pair.h"
#include "orbits/orbit_same.h"
#include "analysis/resonance/response_parts.h"
#include "orbits/numbers.h"

/* ---- evaluating frequencies ---- */

/*
 * Find the slopes of all states of n responses, side by side. coarser, which may be NULL, receives
 * the coarser computations of all states that are orbits, in their order.
 */
static pendres_status add_slopes(pendres_context *ctx, size_t n, pendres_scan_point *points,
                                 pendres_orbit_coarser *coarser)
{
  size_t count = 0, k = 0;
  for (size_t i = 0; i < n; i++) count += points[i].response.states;
  pendres_room room = pendres_room_open(ctx, "slopes");
  pendres_orbit_guess *guess = pendres_room_take(&room, count, sizeof *guess);
  pendres_orbit *orbit = pendres_room_take(&room, count, sizeof *orbit);
  pendres_status *outcome = pendres_room_take(&room, count, sizeof *outcome);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < points[i].response.states; j++) {
      const pendres_orbit *o = &points[i].response.state[j].orbit;
      if (o->period > 0)
        guess[k++] = (pendres_orbit_guess){.pendulum = o->pendulum,
                                           .x = o->x,
                                           .v = o->v,
                                           .period = o->period,
                                           .winding = o->winding};
    }
  pendres_status status = pendres_orbit_refine_pair(ctx, k, guess, orbit, coarser, outcome);
  k = 0;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    for (size_t j = 0; j < points[i].response.states; j++) {
      pendres_orbit *o = &points[i].response.state[j].orbit;
      if (o->period == 0) continue;
      if (outcome[k] != PENDRES_NOT_CONVERGED) *o = orbit[k];
      k++;
    }
  return pendres_room_close(&room, status);
}

static void average_slope(pendres_scan_point *p)
{
  size_t members = 0;
  p->slope = 0.0;
  for (size_t j = 0; j < p->response.states; j++) members += p->response.state_members[j];
  for (size_t j = 0; j < p->response.states; j++) {
    const double slope = p->response.state[j].orbit.loop_area_slope;
    if (!isfinite(slope)) continue;
    p->slope += slope * (double)p->response.state_members[j] / (double)members;
  }
}

pendres_status pendres_scan_evaluate(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums,
                                     const pendres_ensemble *ensemble, signed char *where,
                                     pendres_scan_point *out)
{
  pendres_response *responses = malloc(n * sizeof *responses);
  if (responses == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a scan");
  pendres_status status = pendres_response_members(ctx, n, pendulums, ensemble, where, responses);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    out[i] = (pendres_scan_point){.response = responses[i]};
  if (status == PENDRES_OK) status = add_slopes(ctx, n, out, NULL);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) average_slope(&out[i]);
  free(responses);
  return status;
}

/* ---- following states to another frequency ---- */

pendres_status pendres_scan_follow(pendres_context *ctx, const pendres_scan_point *from,
                                   double omega, pendres_orbit_coarser *coarser,
                                   pendres_scan_point *to)
{
  *to = *from;
  to->where = NULL;
  to->response.pendulum.drive_frequency = omega;
  for (size_t j = 0; j < to->response.states; j++) {
    pendres_orbit *o = &to->response.state[j].orbit;
    const double step = omega - o->pendulum.drive_frequency;
    if (o->period == 0) continue;
    if (isfinite(o->frequency_derivative[0])) {
      o->x += step * o->frequency_derivative[0];
      o->v += step * o->frequency_derivative[1];
    }
    o->pendulum.drive_frequency = omega;
  }
  const pendres_status status = add_slopes(ctx, 1, to, coarser);
  if (status != PENDRES_OK) return status;
  average_slope(to);
  return pendres_response_renew(ctx, &to->response);
}

/* ---- smooth peaks ---- */

typedef struct peak_search {
  pendres_context *ctx;
  const pendres_scan_point *a, *b; /* the bracket */
  pendres_scan_point latest, before;
  pendres_status status;
} peak_search;

/*
 * The slope at a frequency, following the states from the nearest frequency known. Always finite,
 * and at the ends of the bracket what it is known to be: anything else would have GSL call its
 * error handler, which ends the program.
 */
static double slope_at(double omega, void *arg)
{
  peak_search *s = arg;
  if (omega == pendres_scan_frequency(s->a)) return s->a->slope;
  if (omega == pendres_scan_frequency(s->b)) return s->b->slope;
  const pendres_scan_point *from = s->a;
  const pendres_scan_point *const known[] = {s->b, &s->latest, &s->before};
  pendres_scan_point now;
  for (int i = 0; i < 3; i++)
    if (fabs(pendres_scan_frequency(known[i]) - omega) < fabs(pendres_scan_frequency(from) - omega))
      from = known[i];
  if (s->status == PENDRES_OK) s->status = pendres_scan_follow(s->ctx, from, omega, NULL, &now);
  if (s->status == PENDRES_OK && !isfinite(now.slope)) s->status = PENDRES_NOT_CONVERGED;
  if (s->status != PENDRES_OK) return 0.0;
  s->before = s->latest;
  s->latest = now;
  return now.slope;
}

/* The error of the slope: those of the states' slopes, weighted by members. */
static double slope_error(const pendres_scan_point *p)
{
  double error = 0.0, members = 0.0;
  for (size_t j = 0; j < p->response.states; j++) {
    members += (double)p->response.state_members[j];
    error +=
      (double)p->response.state_members[j] * p->response.state[j].orbit.loop_area_slope_error;
  }
  return members > 0.0 ? error / members : NAN;
}

void pendres_resonance_add_error(pendres_resonance *r, const pendres_scan_point *near)
{
  pendres_response *a = &r->response;
  const pendres_response *b = &near->response;
  const double step = b->pendulum.drive_frequency - a->pendulum.drive_frequency;
  if (step == 0.0) return;
  const double share = r->frequency_error / fabs(step);
  a->mean_loop_amplitude_error += share * fabs(b->mean_loop_amplitude - a->mean_loop_amplitude);
  a->mean_amplitude_error += share * fabs(b->mean_amplitude - a->mean_amplitude);
  a->phase_lag_error += share * fabs(b->phase_lag - a->phase_lag);
  a->mean_power_error += share * fabs(b->mean_power - a->mean_power);
  a->mean_loop_area_error += share * fabs(b->mean_loop_area - a->mean_loop_area);
}

void pendres_resonance_take(pendres_resonance *r, const pendres_scan_point *at)
{
  r->response = at->response;
  r->frequency = pendres_scan_frequency(at);
  r->loop_area = at->response.mean_loop_area;
  r->loop_area_error = at->response.mean_loop_area_error;
}

/*
 * Whether the ensemble at the peak is on the states that were followed there, with the same
 * members; *at takes over the labels.
 */
static pendres_status confirm(pendres_context *ctx, const pendres_ensemble *ensemble,
                              pendres_scan_point *at, int *same)
{
  pendres_response there;
  pendres_response *r = &at->response;
  const pendres_status status = pendres_response_find(ctx, 1, &r->pendulum, ensemble, &there);
  if (status != PENDRES_OK) return status;
  *same = there.states == r->states && there.unresolved == r->unresolved &&
          there.escaped == r->escaped && there.unlisted == r->unlisted;
  for (size_t i = 0; *same && i < r->states; i++) {
    const pendres_orbit *o = &there.state[i].orbit;
    *same = there.state_members[i] == r->state_members[i] &&
            pendres_orbit_same(o, &r->state[i].orbit);
    r->state[i].label = there.state[i].label;
  }
  return pendres_response_renew(ctx, r);
}

/*
 * The error of the phase lag at a peak where all members are on one orbit; near: a point beside it;
 * full: the lag's own error and what the error of the peak's place makes of it. Finite steps that
 * shift a peak shift the whole resonance, and the lag at the peak hardly changes: two computations,
 * each at its own peak, show by how much. The error is made of shares of their difference, as for
 * an orbit's measures (orbit_error.c); of a tenth of the full error, since the two may agree by
 * chance; of all of the rounding errors; and of one and a half times what the slope's own distance
 * from zero causes, since the curvature is a difference quotient. NaN if it cannot be told.
 */
static double lag_error(const pendres_scan_point *at, const pendres_scan_point *near,
                        const pendres_orbit_coarser *coarser, double full)
{
  const pendres_response *r = &at->response;
  const pendres_orbit *o = &r->state[0].orbit, *b = &near->response.state[0].orbit;
  if (r->states != 1 || r->unresolved + r->unlisted > 0 || !pendres_response_has_loop(r->state))
    return NAN;
  const double width = pendres_scan_frequency(near) - r->pendulum.drive_frequency;
  const double curvature = (b->loop_area_slope - o->loop_area_slope) / width;
  const double shift = -(coarser->loop_area_slope - o->loop_area_slope) / curvature;
  const double turn[2] = {(b->cosine[0] - o->cosine[0]) / width, (b->sine[0] - o->sine[0]) / width};
  const double apart[2] = {coarser->cosine - o->cosine[0] + shift * turn[0],
                           coarser->sine - o->sine[0] + shift * turn[1]};
  const double radius = hypot(o->cosine[0], o->sine[0]);
  const double direction[2] = {o->cosine[0] / radius, o->sine[0] / radius};
  const double across = direction[0] * apart[1] - direction[1] * apart[0];
  const double turning = direction[0] * turn[1] - direction[1] * turn[0];
  const pendres_orbit_uncertainty uncertainty = {hypot(apart[0], apart[1]), coarser->rounding};
  const double off =
    (orbit_left_over * fabs(o->loop_area_slope) + coarser->slope_rounding) / curvature;
  return (pendres_orbit_error(across, 0.0, 1.0, &uncertainty) + fabs(turning * off)) / radius +
         peak_chance * full;
}

pendres_status pendres_resonance_refine_peak(pendres_context *ctx, const pendres_ensemble *ensemble,
                                             const pendres_scan_point *a,
                                             const pendres_scan_point *b, pendres_resonance *out)
{
  peak_search s = {.ctx = ctx, .a = a, .b = b, .latest = *a, .before = *b};
  if (!(a->slope >= 0.0 && b->slope <= 0.0))
    return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED,
                                "the loop area has no peak between drive frequencies %g and %g",
                                pendres_scan_frequency(a), pendres_scan_frequency(b));
  gsl_function f = {.function = slope_at, .params = &s};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  const double lower = pendres_scan_frequency(a);
  const double upper = pendres_scan_frequency(b);
  if (solver == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a root");

  int gsl = gsl_root_fsolver_set(solver, &f, lower, upper);
  for (int i = 0; i < PEAK_STEPS && gsl == GSL_SUCCESS && s.status == PENDRES_OK; i++) {
    gsl = gsl_root_fsolver_iterate(solver);
    if (gsl == GSL_SUCCESS && fabs(s.latest.slope) <= slope_error(&s.latest)) break;
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver), gsl_root_fsolver_x_upper(solver),
                               0.0, pendres_step_rounding) == GSL_SUCCESS)
      break;
  }
  const double root = gsl_root_fsolver_root(solver);
  gsl_root_fsolver_free(solver);
  if (s.status != PENDRES_OK) return s.status;
  if (gsl != GSL_SUCCESS)
    return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED, "the root of the loop area's slope "
                                "between drive frequencies %g and %g: %s", lower, upper,
                                gsl_strerror(gsl));

  /* The curvature from two points astride, wide enough for the slopes' own errors. */
  pendres_scan_point at, beside;
  const double rate = pendres_model_units_of(&a->response.pendulum).rate;
  const double width = fmin(1e-4 * rate, 0.25 * (upper - lower));
  pendres_orbit_coarser coarser[PENDRES_RESPONSE_STATES];
  pendres_status status = pendres_scan_follow(ctx, &s.latest, root, coarser, &at);
  if (status == PENDRES_OK) status = pendres_scan_follow(ctx, &at, root + width, NULL, &beside);
  if (status != PENDRES_OK) return status;
  const double curvature = (beside.slope - at.slope) / width;
  /* Not a zero of the slope, but a jump through zero. */
  if (!(curvature < 0.0) ||
      fabs(at.slope) > 1e-3 * fmin(a->slope, -b->slope) + slope_error(&at))
    return PENDRES_NOT_FOUND;
  int same = 0;
  status = confirm(ctx, ensemble, &at, &same);
  if (status != PENDRES_OK) return status;
  if (!same) return PENDRES_NOT_FOUND;
  *out = (pendres_resonance){.peak = PENDRES_PEAK_SMOOTH,
                             .fold_frequency = NAN,
                             .fold_frequency_error = NAN};
  pendres_resonance_take(out, &at);
  out->frequency_error =
    (fabs(at.slope) + slope_error(&at)) / fabs(curvature) + pendres_step_rounding * out->frequency;
  pendres_resonance_add_error(out, &beside);
  const double full = out->response.phase_lag_error;
  out->response.phase_lag_error = fmin(full, lag_error(&at, &beside, coarser, full));
  out->loop_area_error = out->response.mean_loop_area_error;
  return PENDRES_OK;
}
