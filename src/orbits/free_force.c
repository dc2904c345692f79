/*
 * free_force.c -- oscillations without damping and drive, under any force; see pendres/free.h.
 *
 * Between the turning points l and h, where the potential V is the same, let x run from one to the
 * other as x = c - a cos(theta). Then E - V(x) = (x - l) (h - x) q(x), and the frequency is one
 * over the mean of 1 / sqrt(2 q) over theta: of a smooth function without an end, of which equally
 * spaced points give the mean with an error that falls exponentially. q is a mean of the force
 * between x and a turning point, over the distance to the other one, so that no difference of
 * potentials is needed, which would lose the digits of small oscillations.
 *
 * Motions that contain the well are nested: the more energy, the wider. Their turning points lie
 * where the potential is higher than anywhere between. On either side these places are intervals,
 * with gaps from the top of a barrier to where, behind it, the potential is as high again. Within
 * one interval on either side the amplitude grows smoothly, and it leaps where the lower one of two
 * barriers is passed.
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

double pendres_free_stiffness(const pendres_pendulum *p, double well, double amplitude)
{
  enum { PHASES = 16 };
  const double a = fmax(amplitude, well_near);
  double sum = 0.0, force, slope;
  for (int i = 0; i < PHASES; i++) {
    const double sine = sin(two_pi * i / PHASES);
    pendres_model_force(p, well + a * sine, &force, &slope);
    sum += force * sine;
  }
  return 2.0 * sum / (PHASES * a);
}

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

/* A pendulum, where it rests, the turning points that it may have (from in.low to inner.low, and
   from inner.high to in.high), and the points of Gauss and Legendre for means of the force. */
typedef struct spring {
  const pendres_pendulum *p;
  double well;
  span in, inner;
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

/* What drives it back at a place. */
static double drives_back(const spring *s, double from, double at)
{
  (void)from;
  return push(s->p, at);
}

/* What makes the potential there lower than where it came from. */
static double runs_lower(const spring *s, double from, double at)
{
  return -mean_force(s, from, at, NULL);
}

/* How far from a place, to one side and up to `most`, one of these holds. */
static double reach(const spring *s, double from, double side, double most,
                    double (*holds)(const spring *s, double from, double at))
{
  const double first = fmin(most, free_near) / FREE_FINENESS;
  double inside = 0.0, outside = first;
  while (outside < most && side * holds(s, from, from + side * outside) > 0.0) {
    inside = outside;
    outside += fmax(first, outside / FREE_FINENESS);
  }
  outside = fmin(outside, most);
  if (side * holds(s, from, from + side * outside) > 0.0) return most;
  for (double middle = 0.5 * (inside + outside); middle > inside && middle < outside;
       middle = 0.5 * (inside + outside))
    *(side * holds(s, from, from + side * middle) > 0.0 ? &inside : &outside) = middle;
  return inside;
}

/* The turning points of an amplitude: about a centre of symmetry if they are on both sides of one,
   and else as far apart, where the mean force between them is 0; the rounding of that moves them
   the more, the slower it changes. 0: there are none. */
static int turning_points(const spring *s, double amplitude, span *out)
{
  const span in = s->in, inner = s->inner;
  const double across = 2.0 * amplitude, centre = pendres_model_centre(s->p, s->well);
  const double left = centre - amplitude, right = centre + amplitude;
  const int odd = in.low <= left && left <= inner.low + well_near &&
                  inner.high - well_near <= right && right <= in.high;
  double below = fmax(in.low, inner.high - across), above = fmin(inner.low, in.high - across);
  double strain = 0.0;
  if (odd)
    below = above = left;
  else if (!(below <= above) || mean_force(s, below, below + across, NULL) > 0.0 ||
           mean_force(s, above, above + across, NULL) < 0.0)
    return 0;
  for (double middle = 0.5 * (below + above); middle > below && middle < above;
       middle = 0.5 * (below + above))
    *(mean_force(s, middle, middle + across, NULL) < 0.0 ? &below : &above) = middle;
  *out = (span){below, odd ? right : below + across, 0.0};
  if (!odd) (void)mean_force(s, out->low, out->high, &strain);
  out->off = last_place_of_one *
             (fabs(out->low) + fabs(out->high) + across +
              strain * across / (push(s->p, out->high) - push(s->p, out->low)));
  return 1;
}

/* Pass over the lower one of the barriers, to the turning points behind it that are at most so far
   from the well. 0: there are none, as where the coordinate has a period. */
static int pass_over(spring *s, double most)
{
  const double side = mean_force(s, s->in.low, s->in.high, NULL) <= 0.0 ? 1.0 : -1.0;
  double *rim = side > 0.0 ? &s->in.high : &s->in.low;
  double *behind = side > 0.0 ? &s->inner.high : &s->inner.low;
  const double left = most - fabs(*rim - s->well);
  if (pendres_model_of(s->p->force)->period > 0.0 || !(left > 0.0)) return 0;
  const double valley = reach(s, *rim, side, left, runs_lower);
  if (!(valley < left)) return 0;
  *behind = *rim + side * valley;
  *rim = *behind + side * reach(s, *behind, side, left - valley, drives_back);
  return 1;
}

/* Find between which places it turns round at an amplitude; 0: at this one it does not. */
static int find_barriers(spring *s, double amplitude)
{
  const double most = 2.0 * amplitude;
  span unused;
  s->inner = (span){s->well, s->well, 0.0};
  s->in.low = s->well - reach(s, s->well, -1.0, most, drives_back);
  s->in.high = s->well + reach(s, s->well, 1.0, most, drives_back);
  while (!turning_points(s, amplitude, &unused))
    if (!pass_over(s, most)) return 0;
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

static pendres_status out_of_memory(pendres_context *ctx)
{
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a quadrature");
}

/* Swing by twice as many points of both kinds, until that changes nothing beyond rounding. What
   displaced turning points do is seen by an amplitude that is smaller by four times as much: about
   a well the frequency falls ever faster towards the separatrix, so that beyond it is no measure;
   and across barriers it does so the other way, so that what has none there is too close to tell.
   So is what the last doubling still changes as much as the one before. */
static pendres_status find_one(pendres_context *ctx, const pendres_pendulum *p, double amplitude,
                               pendres_free_oscillation *out)
{
  double before = NAN, changed = INFINITY;
  spring s = {.p = p};
  if (!pendres_free_well(p, &s.well)) return PENDRES_NOT_FOUND;
  s.table = gsl_integration_glfixed_table_alloc(FREE_ORDER);
  if (s.table == NULL) return out_of_memory(ctx);
  const int turns = find_barriers(&s, amplitude);
  gsl_integration_glfixed_table_free(s.table);
  if (!turns) return PENDRES_NOT_FOUND;
  const double origin = pendres_model_origin(p);
  for (int points = FREE_FEWEST, last = 0; !last; points *= 2) {
    span at = {NAN, NAN, NAN}, nearer;
    double rounding = NAN, unused, there = NAN;
    const int order = points < FREE_ORDER ? points : FREE_ORDER;
    s.table = gsl_integration_glfixed_table_alloc((size_t)order);
    if (s.table == NULL) return out_of_memory(ctx);
    const double frequency = swing(&s, amplitude, points, &at, &rounding);
    const double change = fabs(frequency - before);
    last = change <= rounding || points >= FREE_MOST || (isnan(frequency) && order == FREE_ORDER);
    if (last && !isnan(frequency))
      there = swing(&s, amplitude - 4.0 * at.off, points, &nearer, &unused);
    gsl_integration_glfixed_table_free(s.table);
    if (last && (isnan(there) || (change > rounding && change > 0.5 * changed)))
      return PENDRES_NOT_FOUND;
    before = frequency;
    changed = change;
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
