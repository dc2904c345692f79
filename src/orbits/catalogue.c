/* catalogue.c -- the attractors of parameter sets, with their traps; see catalogue.h. */
#include "orbits/catalogue.h"

#include <pendres/strobe.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/context_internal.h"
#include "orbits/label.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

/* Two orbits are one when their Poincaré points agree to this; distinct ones are further apart
   unless they are about to annihilate in a fold, where neither is an attractor much longer. */
static const double same_point = 1e-6;
/* Guesses closer than this lead to the same orbit, so one of them is enough. */
static const double same_guess = 0.05;

const char *pendres_label_name(pendres_label label)
{
  static const char *const names[PENDRES_LABEL_COUNT] = {"sa",      "la",      "periodic",
                                                         "running", "chaotic", "unresolved"};
  return (unsigned)label < PENDRES_LABEL_COUNT ? names[label] : NULL;
}

void pendres_catalogue_clear(pendres_catalogue *c)
{
  free(c->attractors);
  free(c->trap);
  free(c->owner);
  for (size_t i = 0; i < c->covers; i++) free(c->cover[i]);
  *c = (pendres_catalogue){.pendulum = c->pendulum, .effort = c->effort, .any_well = c->any_well};
}

const pendres_trap *pendres_catalogue_trap(const pendres_catalogue *c,
                                           const pendres_strobe_lane *lane)
{
  for (size_t i = 0; i < c->traps; i++) {
    const pendres_trap *t = &c->trap[i];
    if (pendres_trap_norm2(t, lane->y, lane->w) <= t->radius * t->radius) return t;
  }
  return NULL;
}

int pendres_catalogue_locate(const pendres_catalogue *c, const pendres_strobe_lane *lane,
                             long *well)
{
  const pendres_trap *t = pendres_catalogue_trap(c, lane);
  if (t == NULL) return -1;
  *well = t->winding != 0 ? 0 : lane->turns + (long)rint((lane->y - t->y) / two_pi);
  return c->owner[t - c->trap];
}

/* ---- numbering and labels ---- */

static void label_all(pendres_catalogue *c)
{
  pendres_label_states states = {.count = 0};
  for (size_t i = 0; i < c->count; i++)
    if (c->attractors[i].label != PENDRES_LABEL_CHAOTIC)
      pendres_label_note(&states, &c->attractors[i].orbit);
  for (size_t i = 0; i < c->count; i++) {
    pendres_attractor *a = &c->attractors[i];
    if (a->label != PENDRES_LABEL_CHAOTIC) a->label = pendres_label_of(&states, NULL, &a->orbit);
  }
}

pendres_status pendres_catalogue_order(pendres_context *ctx, pendres_catalogue *c, int *rank)
{
  pendres_attractor *old = malloc((c->count + 1) * sizeof *old);
  int *order = malloc((c->count + 1) * sizeof *order);
  int *moved = malloc((c->count + 1) * sizeof *moved);
  pendres_status status = PENDRES_OK;
  if (old == NULL || order == NULL || moved == NULL || pendres_catalogue_sort(c, order) != 0) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  if (c->count > 0) memcpy(old, c->attractors, c->count * sizeof *old);
  for (size_t i = 0; i < c->count; i++) {
    c->attractors[i] = old[order[i]];
    moved[order[i]] = (int)i;
  }
  for (size_t t = 0; t < c->traps; t++) c->owner[t] = moved[c->owner[t]];
  for (size_t i = 0; i < c->covers; i++) c->cover[i]->attractor = moved[c->cover[i]->attractor];
  if (rank != NULL) memcpy(rank, moved, c->count * sizeof *rank);
  label_all(c);
  pendres_catalogue_compare_images(c);
done:
  free(old);
  free(order);
  free(moved);
  return status;
}

/* ---- adding orbits ---- */

static double point_distance(const pendres_orbit *o, double x, double v)
{
  double dx = x - o->x;
  dx -= two_pi * rint(dx / two_pi);
  return hypot(dx, v - o->v);
}

/* Whether an orbit, or another point of the same orbit, is in the catalogue. */
static int known(const pendres_catalogue *c, const pendres_orbit *o)
{
  for (size_t t = 0; t < c->traps; t++) {
    const pendres_orbit *a = &c->attractors[c->owner[t]].orbit;
    const double omega = o->pendulum.drive_frequency;
    pendres_orbit here = *a;
    here.x = c->trap[t].y + half_pi;
    here.v = c->trap[t].w * omega;
    if (a->period == o->period && a->winding == o->winding &&
        point_distance(&here, o->x, o->v) < same_point)
      return 1;
  }
  return 0;
}

static int reserve(pendres_catalogue *c, size_t more_traps)
{
  if (c->count == c->capacity) {
    const size_t capacity = c->capacity + 4;
    pendres_attractor *a = realloc(c->attractors, capacity * sizeof *a);
    if (a == NULL) return -1;
    c->attractors = a;
    c->capacity = capacity;
  }
  if (c->traps + more_traps > c->trap_capacity) {
    const size_t capacity = c->traps + more_traps + 4;
    pendres_trap *t = realloc(c->trap, capacity * sizeof *t);
    if (t != NULL) c->trap = t;
    int *owner = realloc(c->owner, capacity * sizeof *owner);
    if (owner != NULL) c->owner = owner;
    if (t == NULL || owner == NULL) return -1;
    c->trap_capacity = capacity;
  }
  return 0;
}

/* Whether an orbit of period q closes earlier already: it is then found under that period. */
static int closes_earlier(const pendres_orbit *points, int q)
{
  for (int d = 1; d < q; d++)
    if (q % d == 0 && point_distance(&points[0], points[d].x, points[d].v) < same_point) return 1;
  return 0;
}

/* All Poincaré points of an orbit, each refined at its own place; points[0] is the given one. */
static pendres_status all_points(pendres_context *ctx, const pendres_orbit *o,
                                 pendres_orbit *points, int *complete)
{
  const size_t q = (size_t)o->period;
  double x = o->x, v = o->v;
  pendres_orbit_guess *guess = malloc(q * sizeof *guess);
  pendres_status *outcome = malloc(q * sizeof *outcome), status = PENDRES_OK;
  if (guess == NULL || outcome == NULL)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for an orbit");
  points[0] = *o;
  for (size_t j = 0; j + 1 < q && status == PENDRES_OK; j++) {
    status = pendres_strobe_advance(ctx, 1, &o->pendulum, &x, &v, 1, NULL);
    guess[j] = (pendres_orbit_guess){.pendulum = o->pendulum, .x = x, .v = v,
                                     .period = o->period, .winding = o->winding};
  }
  if (status == PENDRES_OK)
    status = pendres_orbit_refine(ctx, q - 1, guess, PENDRES_ORBIT_PLAIN, points + 1, outcome);
  *complete = status == PENDRES_OK;
  for (size_t j = 0; j + 1 < q && status == PENDRES_OK; j++)
    if (outcome[j] == PENDRES_NOT_CONVERGED || !points[j + 1].stable) *complete = 0;
  if (*complete && closes_earlier(points, o->period)) *complete = 0;
  free(guess);
  free(outcome);
  return status;
}

/*
 * The larger multiplier's logarithm in time, with an error from the interval of its modulus. That
 * is exp(-damping time / 2) at least, since the product of both is its square, and exactly so if
 * the pair is complex for certain. Below DBL_MIN, as strong damping makes it, it has no digits.
 */
static void set_lyapunov(pendres_attractor *a, const pendres_orbit *o)
{
  const double time = two_pi * o->period / o->pendulum.drive_frequency;
  const double least = -0.5 * o->pendulum.damping, off = fmax(DBL_MIN, o->multiplier_error);
  const double size = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  a->lyapunov = fmax(least, log(size) / time);
  a->lyapunov_error = DBL_EPSILON * (4.0 * fabs(a->lyapunov) + 1.0 / time);
  if (isnan(size + o->multiplier_error)) { /* fmax would take the other one */
    a->lyapunov = isnan(size) ? NAN : a->lyapunov;
    a->lyapunov_error = NAN;
    return;
  }
  if (fabs(o->multiplier_im[0]) > off) return;
  const double high = log(size + off) / time;
  const double low = fmax(least, log(fmax(0.0, size - off)) / time);
  a->lyapunov_error += fmax(0.0, fmax(high - a->lyapunov, a->lyapunov - low));
}

/* The point with the largest x represents the orbit. */
static pendres_status append(pendres_context *ctx, pendres_catalogue *c,
                             const pendres_orbit *points, const pendres_trap *traps)
{
  const int q = points[0].period;
  int representative = 0;
  for (int j = 1; j < q; j++)
    if (points[j].x > points[representative].x) representative = j;
  if (reserve(c, (size_t)q) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  pendres_attractor *a = &c->attractors[c->count];
  *a = (pendres_attractor){.orbit = points[representative],
                           .trap_radius = traps[representative].radius,
                           .drift = NAN,
                           .drift_error = NAN,
                           .watched_periods = NAN,
                           .escape_rate_bound = NAN};
  /* All points of an orbit have the same multipliers: by what they differ they are not known. */
  for (int j = 0; j < q; j++)
    a->orbit.multiplier_error =
      fmax(a->orbit.multiplier_error,
           hypot(points[j].multiplier_re[0] - a->orbit.multiplier_re[0],
                 fabs(points[j].multiplier_im[0]) - fabs(a->orbit.multiplier_im[0])));
  set_lyapunov(a, &a->orbit);
  memcpy(a->trap_metric, traps[representative].metric, sizeof a->trap_metric);
  for (int j = 0; j < q; j++) {
    c->trap[c->traps] = traps[j];
    c->owner[c->traps++] = (int)c->count;
  }
  c->count++;
  return PENDRES_OK;
}

/* One stable orbit that may be new. */
static pendres_status add_orbit(pendres_context *ctx, pendres_catalogue *c, const pendres_orbit *o,
                                const pendres_trap *trap)
{
  if (known(c, o)) return PENDRES_OK;
  if (o->period == 1) return append(ctx, c, o, trap);

  int complete = 0;
  pendres_orbit *points = malloc((size_t)o->period * sizeof *points);
  pendres_trap *traps = malloc((size_t)o->period * sizeof *traps);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (points == NULL || traps == NULL)
    (void)pendres_context_fail(ctx, status, "out of memory for an orbit");
  else
    status = all_points(ctx, o, points, &complete);
  if (status == PENDRES_OK && complete) {
    status = pendres_trap_find(ctx, (size_t)o->period, points, c->effort, traps);
    if (status == PENDRES_OK) status = append(ctx, c, points, traps);
  }
  free(points);
  free(traps);
  return status;
}

/* Guesses of one set near an earlier guess are left out. */
static size_t distinct_guesses(size_t n, const pendres_scout *s, const pendres_catalogue *c,
                               pendres_orbit_guess *g, size_t *set)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum *p = &c[s[i].set].pendulum;
    int new = 1;
    for (size_t j = count; j-- > 0 && set[j] == s[i].set && new;) {
      double dx = g[j].x - half_pi - s[i].y;
      dx -= two_pi * rint(dx / two_pi);
      new = g[j].period != s[i].period || g[j].winding != s[i].winding ||
            hypot(dx, g[j].v - s[i].w * p->drive_frequency) > same_guess;
    }
    if (!new) continue;
    set[count] = s[i].set;
    g[count++] = (pendres_orbit_guess){.pendulum = *p,
                                       .x = s[i].y + half_pi,
                                       .v = s[i].w * p->drive_frequency,
                                       .period = s[i].period,
                                       .winding = s[i].winding};
  }
  return count;
}

/* Keep the stable orbits that are not in the catalogues, drop repetitions within a set. */
static size_t distinct_orbits(size_t n, pendres_orbit *o, size_t *set,
                              const pendres_status *outcome, const pendres_catalogue *catalogues)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (outcome[i] == PENDRES_NOT_CONVERGED || !o[i].stable) continue;
    int new = !known(&catalogues[set[i]], &o[i]);
    for (size_t j = count; j-- > 0 && set[j] == set[i] && new;)
      new = o[j].period != o[i].period || o[j].winding != o[i].winding ||
            point_distance(&o[j], o[i].x, o[i].v) > same_point;
    if (!new) continue;
    set[count] = set[i];
    o[count++] = o[i];
  }
  return count;
}

/* Where the mirror image of an orbit crosses drive phase 0: half a period later, reflected. */
static pendres_status mirror_guess(pendres_context *ctx, size_t set, const pendres_orbit *o,
                                   pendres_scout *out)
{
  double *x = malloc(4 * (size_t)o->period * sizeof *x);
  if (x == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for an orbit");
  double *v = x + 2 * o->period;
  const pendres_status status = pendres_orbit_sample(ctx, o, 2, x, v);
  if (status == PENDRES_OK)
    *out = (pendres_scout){.set = set,
                           .y = half_pi - x[1],
                           .w = -v[1] / o->pendulum.drive_frequency,
                           .period = o->period,
                           .winding = -o->winding};
  free(x);
  return status;
}

/* Add what guesses lead to; mirrors[0 .. *more) are guesses for the mirror images of new orbits. */
static pendres_status add_guesses(pendres_context *ctx, pendres_catalogue *catalogues, size_t n,
                                  const pendres_scout *guesses, pendres_scout *mirrors,
                                  size_t *more)
{
  pendres_status status = PENDRES_OK;
  pendres_orbit_guess *g = calloc(n, sizeof *g);
  pendres_orbit *orbits = malloc(n * sizeof *orbits);
  pendres_status *outcome = malloc(n * sizeof *outcome);
  pendres_trap *traps = malloc(n * sizeof *traps);
  size_t *set = malloc(n * sizeof *set);
  *more = 0;
  if (g == NULL || orbits == NULL || outcome == NULL || traps == NULL || set == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu guesses", n);
    goto done;
  }
  size_t count = distinct_guesses(n, guesses, catalogues, g, set);
  status = pendres_orbit_refine(ctx, count, g, PENDRES_ORBIT_PLAIN, orbits, outcome);
  if (status != PENDRES_OK) goto done;
  count = distinct_orbits(count, orbits, set, outcome, catalogues);
  status = pendres_trap_find(ctx, count, orbits, catalogues[0].effort, traps);
  for (size_t i = 0; i < count && status == PENDRES_OK; i++) {
    pendres_catalogue *c = &catalogues[set[i]];
    const size_t before = c->count;
    status = add_orbit(ctx, c, &orbits[i], &traps[i]);
    if (status == PENDRES_OK && c->count > before && !orbits[i].symmetric)
      status = mirror_guess(ctx, set[i], &orbits[i], &mirrors[(*more)++]);
  }
done:
  free(g);
  free(orbits);
  free(outcome);
  free(traps);
  free(set);
  return status;
}

pendres_status pendres_catalogue_add(pendres_context *ctx, pendres_catalogue *catalogues, size_t n,
                                     const pendres_scout *guesses)
{
  size_t more = 0, last = 0;
  if (n == 0) return PENDRES_OK;
  pendres_scout *mirrors = malloc(2 * n * sizeof *mirrors);
  if (mirrors == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu guesses", n);
  pendres_status status = add_guesses(ctx, catalogues, n, guesses, mirrors, &more);
  if (status == PENDRES_OK && more > 0)
    status = add_guesses(ctx, catalogues, more, mirrors, mirrors + n, &last);
  free(mirrors);
  return status;
}

pendres_orbit pendres_orbit_none(const pendres_pendulum *p)
{
  pendres_orbit o = {.pendulum = *p};
  double *const numbers[] = {
    &o.x, &o.v, &o.x_error, &o.v_error, &o.multiplier_error, &o.loop_area, &o.loop_area_error,
    &o.dissipation, &o.dissipation_error, &o.mean_power, &o.mean_power_error, &o.amplitude,
    &o.amplitude_error, &o.first_harmonic_amplitude, &o.first_harmonic_amplitude_error,
    &o.phase_lag, &o.phase_lag_error, &o.mean_angle, &o.loop_area_slope, &o.loop_area_slope_error,
    &o.multiplier_re[0], &o.multiplier_re[1], &o.multiplier_im[0], &o.multiplier_im[1],
    &o.frequency_derivative[0], &o.frequency_derivative[1], &o.monodromy[0][0],
    &o.monodromy[0][1], &o.monodromy[1][0], &o.monodromy[1][1]};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) *numbers[i] = NAN;
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) o.cosine[m] = o.sine[m] = NAN;
  return o;
}

/* Means over time, a drive cycle; everything else is that of an orbit which does not close. */
static pendres_orbit mean_cycle(const pendres_pendulum *p, const pendres_chaos_measures *m)
{
  const double cycles = p->drive_frequency / two_pi;
  pendres_orbit o = pendres_orbit_none(p);
  o.loop_area = m->work.value;
  o.loop_area_error = m->work.error;
  o.mean_power = cycles * m->work.value;
  o.mean_power_error = cycles * m->work.error;
  o.dissipation = m->loss.value;
  o.dissipation_error = m->loss.error;
  o.amplitude = m->amplitude.value;
  o.amplitude_error = m->amplitude.error;
  return o;
}

pendres_status pendres_catalogue_add_chaos(pendres_context *ctx, pendres_catalogue *c,
                                           const pendres_chaos_measures *m, pendres_cover *cover)
{
  const double tau = two_pi / c->pendulum.drive_frequency;
  if (reserve(c, 0) != 0) {
    free(cover);
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  }
  c->attractors[c->count] = (pendres_attractor){.label = PENDRES_LABEL_CHAOTIC,
                                                .orbit = mean_cycle(&c->pendulum, m),
                                                .lyapunov = m->growth.value / tau,
                                                .lyapunov_error = m->growth.error / tau,
                                                .trap_metric = {NAN, NAN, NAN},
                                                .trap_radius = NAN,
                                                .drift = m->turns.value,
                                                .drift_error = m->turns.error,
                                                .watched_periods = m->watched_periods,
                                                .escape_rate_bound = m->escape_rate_bound};
  cover->attractor = (int)c->count++;
  c->cover[c->covers++] = cover;
  return PENDRES_OK;
}
