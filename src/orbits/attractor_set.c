/* attractor_set.c -- the attractors of parameter sets, with their trapping ellipses; see
   attractor_set.h. */
#include "orbits/attractor_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "model/model.h"
#include "orbits/label.h"
#include "orbits/orbit_table.h"

void pendres_attractor_set_clear(pendres_attractor_set *c)
{
  free(c->attractors);
  free(c->ellipse);
  free(c->owner);
  for (size_t i = 0; i < c->covers; i++) free(c->cover[i]);
  *c = (pendres_attractor_set){.pendulum = c->pendulum, .effort = c->effort,
                               .any_well = c->any_well};
}

const pendres_trapping_ellipse *pendres_attractor_set_ellipse(const pendres_attractor_set *c,
                                                              const pendres_strobe_lane *lane)
{
  for (size_t i = 0; i < c->ellipses; i++) {
    const pendres_trapping_ellipse *t = &c->ellipse[i];
    if (pendres_trapping_norm2(t, lane->y, lane->w) <= t->radius * t->radius) return t;
  }
  return NULL;
}

int pendres_attractor_set_locate(const pendres_attractor_set *c, const pendres_strobe_lane *lane,
                                 long *well)
{
  const pendres_trapping_ellipse *t = pendres_attractor_set_ellipse(c, lane);
  if (t == NULL) return -1;
  *well = t->winding != 0 ? 0 : lane->turns + (long)rint((lane->y - t->y) / t->turn);
  return c->owner[t - c->ellipse];
}

/* ---- numbering and labels ---- */

static void label_all(pendres_attractor_set *c)
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

pendres_status pendres_attractor_set_order(pendres_context *ctx, pendres_attractor_set *c,
                                           int *rank)
{
  pendres_attractor *old = malloc((c->count + 1) * sizeof *old);
  int *order = malloc((c->count + 1) * sizeof *order);
  int *moved = malloc((c->count + 1) * sizeof *moved);
  pendres_status status = PENDRES_OK;
  if (old == NULL || order == NULL || moved == NULL || pendres_attractor_set_sort(c, order) != 0) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  if (c->count > 0) memcpy(old, c->attractors, c->count * sizeof *old);
  for (size_t i = 0; i < c->count; i++) {
    c->attractors[i] = old[order[i]];
    moved[order[i]] = (int)i;
  }
  for (size_t t = 0; t < c->ellipses; t++) c->owner[t] = moved[c->owner[t]];
  for (size_t i = 0; i < c->covers; i++) c->cover[i]->attractor = moved[c->cover[i]->attractor];
  if (rank != NULL) memcpy(rank, moved, c->count * sizeof *rank);
  label_all(c);
  pendres_attractor_set_compare_images(c);
done:
  free(old);
  free(order);
  free(moved);
  return status;
}

/* ---- what is added ---- */

int pendres_attractor_set_reserve(pendres_attractor_set *c, size_t more_ellipses)
{
  if (c->count == c->capacity) {
    const size_t capacity = c->capacity + 4;
    if (!pendres_regrow(&c->attractors, capacity, sizeof *c->attractors)) return -1;
    c->capacity = capacity;
  }
  if (c->ellipses + more_ellipses > c->ellipse_capacity) {
    const size_t capacity = c->ellipses + more_ellipses + 4;
    if (!pendres_regrow(&c->ellipse, capacity, sizeof *c->ellipse) ||
        !pendres_regrow(&c->owner, capacity, sizeof *c->owner))
      return -1;
    c->ellipse_capacity = capacity;
  }
  return 0;
}

pendres_orbit pendres_orbit_none(const pendres_pendulum *p)
{
  pendres_orbit o = {.pendulum = *p};
  double *const numbers[] = {
    &o.x, &o.v, &o.x_error, &o.v_error, &o.multiplier_error, &o.mean_angle, &o.loop_area_slope,
    &o.loop_area_slope_error, &o.multiplier_re[0], &o.multiplier_re[1], &o.multiplier_im[0],
    &o.multiplier_im[1], &o.frequency_derivative[0], &o.frequency_derivative[1],
    &o.monodromy[0][0], &o.monodromy[0][1], &o.monodromy[1][0], &o.monodromy[1][1]};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) *numbers[i] = NAN;
  const pendres_orbit_row *row;
  for (size_t k = 0; (row = pendres_orbit_row_get(k)) != NULL; k++) {
    double *error = pendres_orbit_row_error(row, &o);
    *pendres_orbit_row_value(row, &o) = NAN;
    if (error != NULL) *error = NAN;
  }
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) o.cosine[m] = o.sine[m] = NAN;
  return o;
}

/* The means over time of a chaotic motion, for one drive cycle. All that a motion which does not
   close cannot have is NaN. */
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

pendres_status pendres_attractor_set_add_chaos(pendres_context *ctx, pendres_attractor_set *c,
                                           const pendres_chaos_measures *m, pendres_cover *cover)
{
  const double tau = two_pi / c->pendulum.drive_frequency;
  if (pendres_attractor_set_reserve(c, 0) != 0) {
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
