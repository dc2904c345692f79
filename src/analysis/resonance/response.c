/* response.c -- the mean response of an ensemble; see response.h. */
#include <pendres/response.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "model/equation.h"
#include "model/model.h"
#include "settling/attractor_internal.h"
#include "orbits/orbit_measure.h"
#include "analysis/resonance/response_parts.h"
#include "settling/settle.h"
#include "engine/kernels/coordinates.h"

/* An ensemble's members by attractor; attractors without members count for nothing. */
typedef struct parted {
  size_t attractors;
  const pendres_attractor *attractor;
  const size_t *members; /* of each attractor */
  size_t lost;           /* members whose state is not known */
} parted;

/* Sums over attractors, weighted by their share of the members that are on one. */
typedef struct sums {
  double area, area_error, power, power_error;
  double amplitude_share, amplitude, amplitude_error;
  double loop_share, loop_error, loop_amplitude_error;
  double lone; /* the amplitude of the only loop; NaN if there are more */
  double rest; /* a bound on the harmonics that are not kept */
  double cosine[PENDRES_ORBIT_HARMONICS], sine[PENDRES_ORBIT_HARMONICS];
  double cosine_error, sine_error; /* of the first harmonic */
  double largest, least, most, widest; /* areas: of largest modulus, least, most; amplitude */
} sums;

double pendres_response_weakest_multiplier(const pendres_response *r)
{
  double weakest = NAN;
  const size_t states = r == NULL ? 0 : r->states;
  for (size_t i = 0; i < states && i < PENDRES_RESPONSE_STATES; i++)
    weakest = fmax(weakest, pendres_attractor_multiplier(&r->state[i]));
  return weakest;
}

int pendres_response_running(const pendres_attractor *a)
{
  /* Where chaos has no mean drift, the drift found is within twice its error for certain. */
  return pendres_attractor_closes(a) ? a->orbit.winding != 0
                                     : fabs(a->drift) > 2.0 * a->drift_error;
}

/* Add an attractor to the extremes: an uncertain member may be on any of them. */
static void add_extremes(sums *s, const pendres_attractor *a)
{
  const pendres_orbit *o = &a->orbit;
  s->least = fmin(s->least, o->loop_area);
  s->most = fmax(s->most, o->loop_area);
  if (!pendres_response_running(a)) s->widest = fmax(s->widest, o->amplitude);
}

/* Turn the errors along and across a first harmonic into errors of its cosine and sine. */
static void add_harmonic_error(sums *s, const pendres_orbit *o, double share)
{
  const double r = o->first_harmonic_amplitude;
  if (!(r > 0.0)) return;
  const double along = share * o->first_harmonic_amplitude_error;
  const double across = share * r * o->phase_lag_error;
  const double c = fabs(o->cosine[0]) / r, d = fabs(o->sine[0]) / r;
  s->cosine_error += c * along + d * across;
  s->sine_error += d * along + c * across;
}

static void add_attractor(sums *s, const pendres_attractor *a, double share)
{
  const pendres_orbit *o = &a->orbit;
  s->area += share * o->loop_area;
  s->area_error += share * o->loop_area_error;
  s->power += share * o->mean_power;
  s->power_error += share * o->mean_power_error;
  s->largest = fmax(s->largest, fabs(o->loop_area));
  if (pendres_response_running(a)) return;
  s->amplitude_share += share;
  s->amplitude += share * o->amplitude;
  s->amplitude_error += share * o->amplitude_error;
  if (!pendres_response_has_loop(a)) return;
  /* One loop alone that closes in one cycle has its own amplitude: nothing is averaged. */
  s->lone = s->loop_share == 0.0 && o->period == 1 ? o->amplitude : NAN;
  s->loop_share += share;
  s->rest += share * o->harmonics_rest;
  s->loop_error += share * o->x_error;
  s->loop_amplitude_error += share * o->amplitude_error;
  add_harmonic_error(s, o, share);
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) {
    s->cosine[m] += share * o->cosine[m];
    s->sine[m] += share * o->sine[m];
  }
}

static void clear_means(pendres_response *r)
{
  r->mean_loop_area = r->mean_loop_area_error = NAN;
  r->mean_loop_amplitude = r->mean_loop_amplitude_error = NAN;
  r->mean_amplitude = r->mean_amplitude_error = NAN;
  r->phase_lag = r->phase_lag_error = NAN;
  r->mean_power = r->mean_power_error = NAN;
  r->sa_fraction = r->la_fraction = r->sa_fraction_error = r->la_fraction_error = NAN;
}

/* The loop averaged over the members that have one; lost, uncertain: shares of all members. */
static void average_loops(pendres_response *r, sums *s, double lost, double uncertain)
{
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) {
    s->cosine[m] /= s->loop_share;
    s->sine[m] /= s->loop_share;
  }
  /* A member that moves from one loop to another changes the mean twice. */
  const double moved = lost * r->mean_amplitude + 2.0 * uncertain * s->widest;
  r->mean_loop_amplitude = s->lone;
  r->mean_loop_amplitude_error =
    fmax(s->loop_error, s->loop_amplitude_error) / s->loop_share + moved;
  if (isnan(s->lone)) {
    r->mean_loop_amplitude = pendres_orbit_series_half_range(s->cosine, s->sine);
    r->mean_loop_amplitude_error += s->rest / s->loop_share;
  }
  r->phase_lag =
    pendres_orbit_phase_lag(s->cosine[0], s->sine[0], r->pendulum.drive_amplitude);
  if (isnan(r->phase_lag)) return;
  /* The error across the mean harmonic is that of its direction, the lag. */
  const double length = hypot(s->cosine[0], s->sine[0]);
  const double across =
    (fabs(s->sine[0]) * s->cosine_error + fabs(s->cosine[0]) * s->sine_error) / length;
  r->phase_lag_error = (across / s->loop_share + moved) / length;
}

static void average(pendres_response *r, const parted *p)
{
  sums s = {.least = INFINITY, .most = -INFINITY};
  size_t resolved = 0;
  double sa = 0.0, la = 0.0;
  int named = 0;
  for (size_t i = 0; i < p->attractors; i++) {
    resolved += p->members[i];
    named += p->attractor[i].label == PENDRES_LABEL_SA || p->attractor[i].label == PENDRES_LABEL_LA;
  }
  clear_means(r);
  if (resolved == 0) return;

  for (size_t i = 0; i < p->attractors; i++) {
    add_extremes(&s, &p->attractor[i]);
    if (p->members[i] == 0) continue;
    add_attractor(&s, &p->attractor[i], (double)p->members[i] / (double)resolved);
    if (p->attractor[i].label == PENDRES_LABEL_SA) sa += (double)p->members[i];
    if (p->attractor[i].label == PENDRES_LABEL_LA) la += (double)p->members[i];
  }
  const double members = (double)(resolved + p->lost + r->escaped);
  const double lost = (double)p->lost / members;
  /* An uncertain member may belong to any of the states that are there, or to none. */
  const int several = p->attractors + (r->escaped > 0) > 1;
  const double uncertain = several ? (double)r->uncertain / members + r->sampling : 0.0;
  const double area_error = lost * s.largest + uncertain * (s.most - s.least);
  r->mean_loop_area = s.area;
  /* A lost member may belong to any state, known or not. */
  r->mean_loop_area_error = s.area_error + area_error;
  r->mean_power = s.power;
  r->mean_power_error = s.power_error + area_error * r->pendulum.drive_frequency / two_pi;
  if (named > 0) {
    r->sa_fraction = sa / members;
    r->la_fraction = la / members;
    r->sa_fraction_error = r->la_fraction_error =
      lost + (several ? uncertain : r->sampling);
  }
  if (s.amplitude_share > 0.0) {
    r->mean_amplitude = s.amplitude / s.amplitude_share;
    r->mean_amplitude_error =
      s.amplitude_error / s.amplitude_share + lost * r->mean_amplitude + uncertain * s.widest;
  }
  if (s.loop_share > 0.0) average_loops(r, &s, lost, uncertain);
}

void pendres_response_average(pendres_response *r)
{
  if (r == NULL) return;
  if (r->states > PENDRES_RESPONSE_STATES)
    clear_means(r);
  else
    average(r, &(parted){.attractors = r->states, .attractor = r->state,
                       .members = r->state_members, .lost = r->unresolved + r->unlisted});
}

/* The attractor with the most members among those not listed yet; the first of equals. */
static size_t most_members(size_t n, const size_t *members, const char *listed)
{
  size_t best = n;
  for (size_t a = 0; a < n; a++)
    if (!listed[a] && members[a] > 0 && (best == n || members[a] > members[best])) best = a;
  return best;
}

/*
 * Count the members of each attractor from their outcomes, and take the means over all of them. If
 * there are more attractors than can be listed, those with the most members are listed. members and
 * listed have one number for each attractor.
 */
static void count_states(const pendres_attractor_set *c, size_t n, const pendres_settled *outcome,
                         size_t *members, char *listed, pendres_response *r)
{
  memset(r, 0, sizeof *r);
  r->pendulum = c->pendulum;
  for (size_t a = 0; a < c->count; a++) members[a] = 0, listed[a] = 0;
  for (size_t i = 0; i < n; i++) {
    const int a = outcome[i].attractor, escaped = a == PENDRES_ATTRACTOR_ESCAPED;
    const int unstable = a == PENDRES_ATTRACTOR_UNSTABLE;
    if (a >= 0) members[a]++;
    r->escaped += escaped;
    r->unstable += unstable;
    r->unresolved += a < 0 && !escaped && !unstable;
    r->uncertain += (a >= 0 || escaped) && !outcome[i].certain;
  }
  for (int k = 0; k < PENDRES_RESPONSE_STATES; k++) {
    const size_t a = most_members(c->count, members, listed);
    if (a < c->count) listed[a] = 1;
  }
  for (size_t a = 0; a < c->count; a++) {
    if (!listed[a]) {
      r->unlisted += members[a];
      continue;
    }
    r->state[r->states] = c->attractors[a];
    r->state_members[r->states++] = members[a];
  }
  average(r, &(parted){.attractors = c->count, .attractor = c->attractors, .members = members,
                       .lost = r->unresolved});
}

/* The listed attractor that each member is on, or that it has none. */
static void locate_members(size_t n, const pendres_settled *outcome, const char *listed,
                           signed char *where)
{
  for (size_t i = 0; i < n; i++) {
    const int on = outcome[i].attractor;
    const int gone = on == PENDRES_ATTRACTOR_ESCAPED || on == PENDRES_ATTRACTOR_UNSTABLE;
    where[i] = on >= 0 && listed[on] ? 0 : gone ? PENDRES_RESPONSE_GONE : -1;
    for (int a = 0; a < on && where[i] >= 0; a++) where[i] = (signed char)(where[i] + listed[a]);
  }
}

pendres_status pendres_response_summarize(pendres_context *ctx, const pendres_attractor_set *c,
                                          size_t n, const pendres_settled *outcome,
                                          signed char *where, pendres_response *r)
{
  pendres_room room = pendres_room_open(ctx, "attractors");
  size_t *members = pendres_room_take(&room, c->count, sizeof *members);
  char *listed = pendres_room_take(&room, c->count, sizeof *listed);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  count_states(c, n, outcome, members, listed, r);
  const pendres_status status =
    pendres_response_refine_loop(ctx, c->count, c->attractors, members, r);
  if (status == PENDRES_OK && where != NULL) locate_members(n, outcome, listed, where);
  return pendres_room_close(&room, status);
}

static pendres_status compute_batch(pendres_context *ctx, size_t sets,
                                    const pendres_pendulum *pendulums, const pendres_ensemble *e,
                                    signed char *where, pendres_response *out)
{
  const size_t n = sets * e->members;
  pendres_attractor_set attractor_sets[PENDRES_RESPONSE_BATCH] = {0};
  pendres_room room = pendres_room_open(ctx, "members");
  double *x = pendres_room_take(&room, n, sizeof *x);
  double *v = pendres_room_take(&room, n, sizeof *v);
  size_t *set = pendres_room_take(&room, n, sizeof *set);
  pendres_settled *outcome = pendres_room_take(&room, n, sizeof *outcome);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t s = 0; s < sets; s++) {
    attractor_sets[s].pendulum = pendulums[s];
    attractor_sets[s].any_well = 1;
    for (size_t k = 1; k <= e->members; k++) {
      const size_t i = s * e->members + k - 1;
      set[i] = s;
      pendres_ensemble_start(e, k, &x[i], &v[i]);
    }
  }
  const pendres_settle_starts starts = {
    .n = n, .set = set, .x = x, .v = v, .wanted = PENDRES_SETTLE_LABELS};
  pendres_status status = pendres_settle_batch(ctx, sets, attractor_sets, &starts, outcome);
  for (size_t s = 0; s < sets && status == PENDRES_OK; s++)
    status = pendres_response_summarize(ctx, &attractor_sets[s], e->members,
                                        outcome + s * e->members,
                                        where != NULL ? where + s * e->members : NULL, &out[s]);
  for (size_t s = 0; s < sets; s++) pendres_attractor_set_clear(&attractor_sets[s]);
  return pendres_room_close(&room, status);
}

const char *pendres_response_refuses(const pendres_pendulum *p, const pendres_ensemble *e)
{
  const double v = e->shape == PENDRES_ENSEMBLE_LINE ? e->v : fmax(fabs(e->v), fabs(e->v_last));
  return pendres_coordinates_refuses(p, fmax(fabs(e->x_first), fabs(e->x_last)), v);
}

pendres_status pendres_response_members(pendres_context *ctx, size_t n,
                                        const pendres_pendulum *pendulums,
                                        const pendres_ensemble *ensemble, signed char *where,
                                        pendres_response *out)
{
  if (ensemble == NULL || (n > 0 && (pendulums == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, ensemble and out");
  const char *why = NULL;
  if (pendres_ensemble_check(ensemble, &why) != PENDRES_OK)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  for (size_t i = 0; i < n; i++) {
    if (pendres_pendulum_check(&pendulums[i], &why) == PENDRES_OK) {
      why = pendres_response_refuses(&pendulums[i], ensemble);
      if (why == NULL) why = pendres_equation_undamped(&pendulums[i]);
    }
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < n && status == PENDRES_OK; first += PENDRES_RESPONSE_BATCH) {
    const size_t sets = n - first < PENDRES_RESPONSE_BATCH ? n - first : PENDRES_RESPONSE_BATCH;
    status = compute_batch(ctx, sets, pendulums + first, ensemble,
                           where != NULL ? where + first * ensemble->members : NULL, out + first);
  }
  return status;
}

/* The members of a line are taken as they are; other starts are a sample, whose error follows from
   each member's state. */
static pendres_status compute(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                              const pendres_ensemble *ensemble, pendres_response *out)
{
  if (ensemble == NULL || ensemble->shape == PENDRES_ENSEMBLE_LINE)
    return pendres_response_members(ctx, n, pendulums, ensemble, NULL, out);
  if (ensemble->members > SIZE_MAX / (n + 1))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "too many members");
  signed char *where = malloc(n * ensemble->members + 1);
  if (where == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for members");
  const pendres_status status = pendres_response_members(ctx, n, pendulums, ensemble, where, out);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_response_sample(ensemble, where + i * ensemble->members, &out[i]);
  free(where);
  return status;
}

pendres_status pendres_response_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums,
                                     const pendres_ensemble *ensemble, pendres_response *out)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    const pendres_ensemble *e = pendres_door_in(&d, &pendres_dim_ensemble, 1, ensemble);
    pendres_response *r = pendres_door_out_run(&d, &pendres_dim_response, out);
    PENDRES_DOOR_CALL(&d, compute(ctx, d.count, p, e, r));
  }
  return pendres_door_close(&d);
}
