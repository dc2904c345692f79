/*
 * free_force.c -- oscillations without damping and drive, under any force; see pendres/free.h.
 *
 * Between the turning points l and h, where the potential V is the same, let x run from one to the
 * other as x = c - a cos(theta). Then E - V(x) = (x - l) (h - x) q(x), and the frequency is one
 * over the mean of 1 / sqrt(2 q) over theta: of a smooth function without an end, of which equally
 * spaced points give the mean with an error that falls exponentially. q is a mean of the force
 * between x and a turning point, over the distance to the other one, so that no difference of
 * potentials is needed, which would lose the digits of small oscillations.
 */
#include "orbits/free_force.h"

#include <pendres/free.h>

#include <gsl/gsl_integration.h>
#include <math.h>

#include "base/angles.h"
#include "base/numbers.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "model/model.h"
#include "orbits/numbers.h"

int pendres_free_well(const pendres_pendulum *p, double *y)
{
  double force, slope, low, high;
  *y = 0.0;
  for (int i = 0; i < WELL_ROLLS; i++) {
    pendres_model_force(p, *y, &force, &slope);
    const double push = p->torque - force;
    const double longest = fmin(well_longest, fabs(push / slope));
    const double step = push != 0.0 ? copysign(longest, push) : 0.0;
    *y += step;
    if (!(fabs(step) > well_last_step)) {
      pendres_model_force(p, *y - well_near, &low, &slope);
      pendres_model_force(p, *y + well_near, &high, &slope);
      if (low < p->torque && p->torque < high) return 1;
      *y += well_near;
    }
  }
  return 0;
}

/* ---- means of the force ---- */

/* Where it swings, and by how much these places may be off. */
typedef struct span {
  double low, high, off;
} span;

/* A pendulum, where it rests, from where the force drives it there, and the points of Gauss and
   Legendre for means of the force. */
typedef struct spring {
  const pendres_pendulum *p;
  double well;
  span in;
  gsl_integration_glfixed_table *table;
} spring;

static double push(const pendres_pendulum *p, double y)
{
  double force, slope;
  pendres_model_force(p, y, &force, &slope);
  return force - p->torque;
}

/* The mean of the force between two places; *strain, which may be NULL: of the sizes of what it is
   the sum of, so that a unit in the last place of that is its rounding. */
static double mean_force(const spring *s, double from, double to, double *strain)
{
  double sum = 0.0, size = 0.0, at, weight, force, slope;
  for (size_t i = 0; i < s->table->n; i++) {
    gsl_integration_glfixed_point(0.0, 1.0, i, &at, &weight, s->table);
    const double y = from + at * (to - from);
    pendres_model_force(s->p, y, &force, &slope);
    sum += weight * (force - s->p->torque);
    size += weight * (fabs(force) + fabs(s->p->torque) + fabs(slope * y));
  }
  if (strain != NULL) *strain = size;
  return sum;
}

/* How far from a well, to one side and up to `most`, the force drives back to it. */
static double reach(const pendres_pendulum *p, double well, double side, double most)
{
  const double first = fmin(most, free_near) / FREE_FINENESS;
  double inside = 0.0, outside = first;
  while (outside < most && side * push(p, well + side * outside) > 0.0) {
    inside = outside;
    outside += fmax(first, outside / FREE_FINENESS);
  }
  outside = fmin(outside, most);
  if (side * push(p, well + side * outside) > 0.0) return most;
  for (double middle = 0.5 * (inside + outside); middle > inside && middle < outside;
       middle = 0.5 * (inside + outside))
    *(side * push(p, well + side * middle) > 0.0 ? &inside : &outside) = middle;
  return inside;
}

/* The turning points of an amplitude: about a centre of symmetry if the well is one, and else as
   far apart, where the mean force between them is 0; the rounding of that moves them the more, the
   slower it changes. 0: the amplitude is that of the separatrix, or beyond. */
static int turning_points(const spring *s, double amplitude, span *out)
{
  const double well = s->well;
  const span in = s->in;
  const double across = 2.0 * amplitude, centre = pendres_model_centre(s->p, well);
  const int odd = fabs(centre - well) < well_near;
  double below = fmax(in.low, well - across), above = fmin(well, in.high - across), strain = 0.0;
  if (odd && in.low <= centre - amplitude && centre + amplitude <= in.high)
    below = above = centre - amplitude;
  else if (!(below <= above) || mean_force(s, below, below + across, NULL) > 0.0 ||
           mean_force(s, above, above + across, NULL) < 0.0)
    return 0;
  for (double middle = 0.5 * (below + above); middle > below && middle < above;
       middle = 0.5 * (below + above))
    *(mean_force(s, middle, middle + across, NULL) < 0.0 ? &below : &above) = middle;
  *out = (span){below, odd ? centre + amplitude : below + across, 0.0};
  if (!odd) (void)mean_force(s, out->low, out->high, &strain);
  out->off = last_place_of_one *
             (fabs(out->low) + fabs(out->high) + across +
              strain * across / (push(s->p, out->high) - push(s->p, out->low)));
  return 1;
}

/* The frequency by so many points, and its rounding; NaN on the separatrix. */
static double frequency_by(const spring *s, span at, int points, double *rounding)
{
  const double centre = 0.5 * (at.low + at.high), a = 0.5 * (at.high - at.low);
  double sum = 0.0, strains = 0.0;
  for (int i = 0; i < points; i++) {
    const double theta = pi * (i + 0.5) / points, y = centre - a * cos(theta);
    const double to_low = sin(0.5 * theta), to_high = cos(0.5 * theta);
    const int lower = theta < half_pi;
    const double far = 2.0 * a * (lower ? to_high * to_high : to_low * to_low);
    double strain;
    const double mean = lower ? -mean_force(s, at.low, y, &strain)
                              : mean_force(s, y, at.high, &strain);
    if (!(mean > 0.0)) return NAN;
    const double slowness = sqrt(0.5 * far / mean);
    sum += slowness;
    strains += slowness * strain / mean;
  }
  *rounding = last_place_of_one * (FREE_ROUNDINGS + strains / sum) * points / sum;
  return points / sum;
}

/* The frequency of an amplitude by so many points; NaN: it does not swing so far. */
static double swing(const spring *s, double amplitude, int points, span *at, double *rounding)
{
  return turning_points(s, amplitude, at) ? frequency_by(s, *at, points, rounding) : NAN;
}

/* Swing by twice as many points of both kinds, until that changes nothing beyond rounding. What
   displaced turning points do is seen by an amplitude that is smaller by four times as much: the
   frequency falls ever faster towards the separatrix, so that beyond it is no measure. */
static pendres_status find_one(pendres_context *ctx, const pendres_pendulum *p, double amplitude,
                               pendres_free_oscillation *out)
{
  double before = NAN;
  spring s = {.p = p};
  if (!pendres_free_well(p, &s.well)) return PENDRES_NOT_FOUND;
  s.in.low = s.well - reach(p, s.well, -1.0, 2.0 * amplitude);
  s.in.high = s.well + reach(p, s.well, 1.0, 2.0 * amplitude);
  const double origin = pendres_model_origin(p);
  for (int points = FREE_FEWEST, last = 0; !last; points *= 2) {
    span at, nearer;
    double rounding = NAN, unused, there = NAN;
    const int order = points < FREE_ORDER ? points : FREE_ORDER;
    s.table = gsl_integration_glfixed_table_alloc((size_t)order);
    if (s.table == NULL)
      return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a quadrature");
    const double frequency = swing(&s, amplitude, points, &at, &rounding);
    const double change = fabs(frequency - before);
    last = change <= rounding || points >= FREE_MOST || isnan(frequency);
    if (last && !isnan(frequency))
      there = swing(&s, amplitude - 4.0 * at.off, points, &nearer, &unused);
    gsl_integration_glfixed_table_free(s.table);
    if (isnan(frequency)) return PENDRES_NOT_FOUND;
    before = frequency;
    *out = (pendres_free_oscillation){s.well + origin, at.low + origin, at.high + origin, frequency,
                                      change + rounding + fabs(there - frequency), at.off};
  }
  return out->frequency_error <= ctx->options.tolerance ? PENDRES_OK
                                                        : PENDRES_TOLERANCE_UNREACHABLE;
}

static pendres_status find_all(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                               const double *amplitude, pendres_free_oscillation *out,
                               pendres_status *outcome)
{
  static const pendres_free_oscillation none = {NAN, NAN, NAN, NAN, NAN, NAN};
  if (n > 0 && (p == NULL || amplitude == NULL || out == NULL || outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, amplitude, out and outcome");
  for (size_t i = 0; i < n; i++) {
    pendres_pendulum free = p[i];
    const char *why = NULL;
    free.drive_frequency = 1.0;
    if (pendres_pendulum_check(&free, &why) == PENDRES_OK)
      why = amplitude[i] > 0.0 && isfinite(amplitude[i]) ? NULL : "its amplitude must be above 0";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  for (size_t i = 0; i < n; i++) {
    out[i] = none;
    outcome[i] = find_one(ctx, &p[i], amplitude[i], &out[i]);
    if (outcome[i] == PENDRES_OUT_OF_MEMORY) return outcome[i];
    if (outcome[i] == PENDRES_NOT_FOUND) out[i] = none;
  }
  return PENDRES_OK;
}

pendres_status pendres_free_oscillation_find(pendres_context *ctx, size_t n,
                                             const pendres_pendulum *pendulums,
                                             const double *amplitude,
                                             pendres_free_oscillation *out,
                                             pendres_status *outcome)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    const double *a = pendres_door_in_run(&d, &pendres_dim_length, amplitude);
    pendres_free_oscillation *of = pendres_door_out_run(&d, &pendres_dim_free_oscillation, out);
    PENDRES_DOOR_CALL(&d, find_all(ctx, d.count, p, a, of, PENDRES_DOOR_AT(outcome, d.first)));
  }
  return pendres_door_close(&d);
}
