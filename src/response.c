/* response.c -- the mean response of an ensemble; see response.h. */
#include <pendres/response.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "context_internal.h"
#include "orbit_measure.h"
#include "settle.h"

static const double two_pi = 6.28318530717958647693;

enum { BATCH_SETS = 32 };

/* Sums over states, weighted by their share of the resolved members. */
typedef struct sums {
  double area, area_error, amplitude, amplitude_error, power, power_error;
  double loop_share, loop_error;
  double cosine[PENDRES_ORBIT_HARMONICS], sine[PENDRES_ORBIT_HARMONICS];
} sums;

static void add_state(sums *s, const pendres_orbit *o, double share)
{
  if (!isfinite(o->loop_area)) return;
  s->area += share * o->loop_area;
  s->area_error += share * o->loop_area_error;
  s->power += share * o->mean_power;
  s->power_error += share * o->mean_power_error;
  if (o->winding != 0) return;
  s->loop_share += share;
  s->amplitude += share * o->amplitude;
  s->amplitude_error += share * o->amplitude_error;
  s->loop_error += share * o->x_error;
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

void pendres_response_average(pendres_response *r)
{
  sums s = {0};
  size_t resolved = 0;
  double sa = 0.0, la = 0.0, largest = 0.0, least = INFINITY, most = -INFINITY, widest = 0.0;
  size_t all = r->unresolved;
  for (size_t i = 0; i < r->states; i++) {
    all += r->state_members[i];
    /* A chaotic member has no closed loop: it is left out of the means like an unresolved one. */
    if (isfinite(r->state[i].orbit.loop_area)) resolved += r->state_members[i];
  }
  clear_means(r);
  if (resolved == 0) return;

  for (size_t i = 0; i < r->states; i++) {
    const double share = (double)r->state_members[i] / (double)resolved;
    add_state(&s, &r->state[i].orbit, share);
    if (r->state[i].label == PENDRES_LABEL_SA) sa += (double)r->state_members[i];
    if (r->state[i].label == PENDRES_LABEL_LA) la += (double)r->state_members[i];
    const pendres_orbit *o = &r->state[i].orbit;
    if (!isfinite(o->loop_area)) continue;
    largest = fmax(largest, fabs(o->loop_area));
    least = fmin(least, o->loop_area);
    most = fmax(most, o->loop_area);
    if (o->winding == 0) widest = fmax(widest, o->amplitude);
  }
  const double members = (double)all, lost = (double)(all - resolved) / members;
  /* An uncertain member may belong to any state, but to one of those that are there. */
  const double doubt = r->states > 1 ? (double)r->uncertain / members : 0.0;
  const double area_doubt = lost * largest + doubt * (most - least);
  r->mean_loop_area = s.area;
  /* A lost member may belong to any state. */
  r->mean_loop_area_error = s.area_error + area_doubt;
  r->mean_power = s.power;
  r->mean_power_error = s.power_error + area_doubt * r->pendulum.drive_frequency / two_pi;
  r->sa_fraction = sa / members;
  r->la_fraction = la / members;
  r->sa_fraction_error = r->la_fraction_error = (double)r->unresolved / members + doubt;
  if (s.loop_share == 0.0) return;

  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) {
    s.cosine[m] /= s.loop_share;
    s.sine[m] /= s.loop_share;
  }
  r->mean_amplitude = s.amplitude / s.loop_share;
  r->mean_amplitude_error =
    s.amplitude_error / s.loop_share + lost * r->mean_amplitude + doubt * widest;
  r->mean_loop_amplitude = pendres_orbit_series_half_range(s.cosine, s.sine);
  r->mean_loop_amplitude_error =
    fmax(s.loop_error, s.amplitude_error) / s.loop_share + lost * r->mean_amplitude +
    2.0 * doubt * widest; /* what goes from one loop to another takes from the one as well */
  r->phase_lag =
    pendres_orbit_phase_lag(s.cosine[0], s.sine[0], r->pendulum.drive_amplitude);
  if (!isnan(r->phase_lag))
    r->phase_lag_error = r->mean_loop_amplitude_error / hypot(s.cosine[0], s.sine[0]);
}

/* Members of each state, from their outcomes. */
static void count_states(const pendres_catalogue *c, size_t n, const pendres_outcome *outcome,
                         pendres_response *r)
{
  memset(r, 0, sizeof *r);
  r->pendulum = c->pendulum;
  int slot[PENDRES_RESPONSE_STATES];
  for (size_t a = 0; a < c->count; a++) {
    size_t members = 0;
    for (size_t i = 0; i < n; i++) members += outcome[i].attractor == (int)a;
    if (members == 0) continue;
    if (r->states == PENDRES_RESPONSE_STATES) {
      r->unresolved += members; /* more states than are listed: said, not dropped in silence */
      continue;
    }
    slot[r->states] = (int)a;
    r->state[r->states] = c->attractors[slot[r->states]];
    r->state_members[r->states++] = members;
  }
  for (size_t i = 0; i < n; i++) {
    r->unresolved += outcome[i].attractor < 0;
    r->uncertain += outcome[i].attractor >= 0 && !outcome[i].certain;
  }
}

static pendres_status compute_batch(pendres_context *ctx, size_t sets,
                                    const pendres_pendulum *pendulums, const pendres_ensemble *e,
                                    pendres_response *out)
{
  const size_t n = sets * e->members;
  pendres_status status = PENDRES_OK;
  pendres_catalogue catalogues[BATCH_SETS] = {0};
  double *x = malloc(n * sizeof *x), *v = malloc(n * sizeof *v);
  size_t *set = malloc(n * sizeof *set);
  pendres_outcome *outcome = malloc(n * sizeof *outcome);
  if (x == NULL || v == NULL || set == NULL || outcome == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu members", n);
    goto done;
  }
  for (size_t s = 0; s < sets; s++) {
    catalogues[s].pendulum = pendulums[s];
    for (size_t k = 1; k <= e->members; k++) {
      const size_t i = s * e->members + k - 1;
      set[i] = s;
      x[i] = pendres_ensemble_x(e, k);
      v[i] = e->v;
    }
  }
  status = pendres_settle_batch(ctx, sets, catalogues, 1, n, set, x, v, outcome);
  for (size_t s = 0; s < sets && status == PENDRES_OK; s++) {
    count_states(&catalogues[s], e->members, outcome + s * e->members, &out[s]);
    pendres_response_average(&out[s]);
  }
done:
  for (size_t s = 0; s < sets; s++) pendres_catalogue_clear(&catalogues[s]);
  free(x);
  free(v);
  free(set);
  free(outcome);
  return status;
}

static pendres_status response_compute(pendres_context *ctx, size_t n,
                                       const pendres_pendulum *pendulums,
                                       const pendres_ensemble *ensemble, pendres_response *out)
{
  if (ensemble == NULL || (n > 0 && (pendulums == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, ensemble and out");
  if (ensemble->members < 1 || !isfinite(ensemble->x_first) || !isfinite(ensemble->x_last) ||
      !isfinite(ensemble->v))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an ensemble needs members and finite starts");
  for (size_t i = 0; i < n; i++) {
    const char *why = NULL;
    if (pendres_pendulum_check(&pendulums[i], &why) == PENDRES_OK && pendulums[i].damping == 0.0)
      why = "without damping nothing settles";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < n && status == PENDRES_OK; first += BATCH_SETS) {
    const size_t sets = n - first < BATCH_SETS ? n - first : BATCH_SETS;
    status = compute_batch(ctx, sets, pendulums + first, ensemble, out + first);
  }
  return status;
}

pendres_status pendres_response_compute(pendres_context *ctx, size_t n,
                                        const pendres_pendulum *pendulums,
                                        const pendres_ensemble *ensemble, pendres_response *out)
{
  return PENDRES_CONTEXT_CALL(ctx, response_compute(ctx, n, pendulums, ensemble, out));
}
