/* attractor_set.c -- the attractors of parameter sets, with their trapping ellipses; see
   attractor_set.h. */
#include "settling/attractor_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "model/model.h"
#include "orbits/label.h"
#include "orbits/orbit_same.h"
#include "orbits/orbit_table.h"

void pendres_attractor_set_clear(pendres_attractor_set *c)
{
  free(c->attractors);
  free(c->ellipse);
  free(c->owner);
  for (size_t i = 0; i < c->covers; i++) free(c->cover[i]);
  for (size_t i = 0; i < c->annuli; i++) free(c->annulus[i]);
  *c = (pendres_attractor_set){.pendulum = c->pendulum, .effort = c->effort,
                               .any_well = c->any_well};
}

const pendres_trapping_ellipse *pendres_attractor_set_ellipse(const pendres_attractor_set *c,
                                                              double y, double w)
{
  for (size_t i = 0; i < c->ellipses; i++) {
    const pendres_trapping_ellipse *t = &c->ellipse[i];
    if (pendres_trapping_holds(t, y, w)) return t;
  }
  return NULL;
}

const pendres_annulus *pendres_attractor_set_annulus(const pendres_attractor_set *c, double y,
                                                     double w)
{
  double slope;
  for (size_t k = 0; k < c->annuli; k++)
    if (pendres_annulus_room(c->annulus[k], y, w, &slope) > 0.0) return c->annulus[k];
  return NULL;
}

int pendres_attractor_set_locate(const pendres_attractor_set *c, const pendres_trapping_ellipse *t,
                                 const pendres_strobe_lane *lane, long *well)
{
  *well = t->winding != 0 ? 0 : lane->turns + (long)rint((lane->y - t->y) / t->turn);
  return c->owner[t - c->ellipse];
}

/* ---- the cells that a chaotic attractor visits ---- */

static int cell_of(const pendres_cover *cover, double y, double w, int *row, int *column)
{
  const double span = cover->span > 0.0 ? cover->span : two_pi;
  const double a = y / span + 0.5, b = 0.5 * (w / cover->w_most + 1.0);
  /* Neither NaN nor what no int holds. */
  if (!(isfinite(a) && b >= 0.0 && b < 1.0)) return 0;
  if (cover->span > 0.0 && !(a >= 0.0 && a < 1.0)) return 0;
  *row = (int)floor((a - floor(a)) * PENDRES_COVER_CELLS);
  *column = (int)floor(b * PENDRES_COVER_CELLS);
  if (*row == PENDRES_COVER_CELLS) *row = 0;
  return 1;
}

int pendres_cover_holds(const pendres_cover *cover, double y, double w)
{
  int row, column;
  return cell_of(cover, y, w, &row, &column) && cover->cell[row][column];
}

void pendres_cover_add(pendres_cover *cover, double y, double w)
{
  int row, column;
  if (!cell_of(cover, y, w, &row, &column)) return;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++) {
      const int r = (row + i + PENDRES_COVER_CELLS) % PENDRES_COVER_CELLS, s = column + j;
      if (s >= 0 && s < PENDRES_COVER_CELLS) cover->cell[r][s] = 1;
    }
}

/* ---- numbering and labels ---- */

static void label_all(pendres_attractor_set *c)
{
  pendres_label_states states = {.count = 0};
  for (size_t i = 0; i < c->count; i++)
    if (pendres_attractor_closes(&c->attractors[i]))
      pendres_label_note(&states, &c->attractors[i].orbit);
  for (size_t i = 0; i < c->count; i++) {
    pendres_attractor *a = &c->attractors[i];
    if (pendres_attractor_closes(a)) a->label = pendres_label_of(&states, NULL, &a->orbit);
  }
}

pendres_status pendres_attractor_set_order(pendres_context *ctx, pendres_attractor_set *c,
                                           int *rank)
{
  pendres_room room = pendres_room_open(ctx, "attractors");
  pendres_attractor *old = pendres_room_take(&room, c->count, sizeof *old);
  int *order = pendres_room_take(&room, c->count, sizeof *order);
  int *moved = pendres_room_take(&room, c->count, sizeof *moved);
  if (room.status == PENDRES_OK && pendres_attractor_set_sort(c, order) != 0)
    room.status =
      pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  if (c->count > 0) memcpy(old, c->attractors, c->count * sizeof *old);
  for (size_t i = 0; i < c->count; i++) {
    c->attractors[i] = old[order[i]];
    moved[order[i]] = (int)i;
  }
  for (size_t t = 0; t < c->ellipses; t++) c->owner[t] = moved[c->owner[t]];
  for (size_t i = 0; i < c->covers; i++) c->cover[i]->attractor = moved[c->cover[i]->attractor];
  for (size_t i = 0; i < c->annuli; i++)
    c->annulus[i]->attractor = moved[c->annulus[i]->attractor];
  if (c->turns) c->turning = moved[c->turning];
  if (rank != NULL) memcpy(rank, moved, c->count * sizeof *rank);
  label_all(c);
  pendres_attractor_set_compare_images(c);
  return pendres_room_close(&room, PENDRES_OK);
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

/* The means over time of a motion that does not close, for one drive cycle. Quantities that exist
   only for closed orbits are NaN. */
static pendres_orbit mean_cycle(const pendres_pendulum *p, const pendres_open_measures *m)
{
  const double cycles = p->drive_frequency / two_pi;
  pendres_orbit o = pendres_orbit_none(p);
  o.x = m->x;
  o.v = m->v;
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

pendres_attractor pendres_attractor_open(const pendres_pendulum *p, const pendres_open_measures *m)
{
  const double tau = two_pi / p->drive_frequency;
  return (pendres_attractor){.label = m->label,
                             .orbit = mean_cycle(p, m),
                             .lyapunov = m->growth.value / tau,
                             .lyapunov_error = m->growth.error / tau,
                             .trap_metric = {NAN, NAN, NAN},
                             .trap_radius = NAN,
                             .drift = m->turns.value,
                             .drift_error = m->turns.error,
                             .watched_periods = m->watched_periods,
                             .escape_rate_bound = m->escape_rate_bound};
}

pendres_open_measures pendres_open_turning(const pendres_pendulum *p, const pendres_rotation *r)
{
  const double tau = two_pi / p->drive_frequency;
  return (pendres_open_measures){
    .label = PENDRES_LABEL_RUNNING, .x = half_pi, .v = r->v, .amplitude = {NAN, NAN},
    .loss = {tau * p->torque * r->mean_velocity, tau * fabs(p->torque) * r->mean_velocity_error},
    .turns = {r->mean_velocity / p->drive_frequency, r->mean_velocity_error / p->drive_frequency},
    .watched_periods = NAN, .escape_rate_bound = NAN};
}

pendres_status pendres_attractor_set_add_open(pendres_context *ctx, pendres_attractor_set *c,
                                              const pendres_open_measures *m,
                                              pendres_cover *cover, pendres_annulus *annulus)
{
  if (pendres_attractor_set_reserve(c, 0) != 0) {
    free(cover);
    free(annulus);
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  }
  c->attractors[c->count] = pendres_attractor_open(&c->pendulum, m);
  if (cover != NULL) cover->attractor = (int)c->count;
  if (cover != NULL) c->cover[c->covers++] = cover;
  if (annulus != NULL) annulus->attractor = (int)c->count;
  if (annulus != NULL) c->annulus[c->annuli++] = annulus;
  if (cover == NULL && annulus == NULL) {
    c->turns = 1;
    c->turning = (int)c->count;
  }
  c->count++;
  return PENDRES_OK;
}

/* ---- Physical order ------------------------------------------------------------------------- */

enum { KEYS = 3 };

/* An attractor on its way to its place. Attractors of one group agree in all earlier keys. */
typedef struct placed {
  int group;
  double key, error;
  int number; /* the old one */
} placed;

static int by_group_and_key(const void *a, const void *b)
{
  const placed *p = a, *q = b;
  if (p->group != q->group) return p->group < q->group ? -1 : 1;
  return (p->key > q->key) - (p->key < q->key);
}

static const pendres_cover *cover_of(const pendres_attractor_set *c, int attractor)
{
  for (size_t i = 0; i < c->covers; i++)
    if (c->cover[i]->attractor == attractor) return c->cover[i];
  return NULL;
}

/* An attractor's key number k, and its error, which must not decide the order: the amplitudes of
   mirror images, for one, differ by errors alone. */
static double key_of(const pendres_attractor_set *c, int attractor, int k, double *error)
{
  const pendres_attractor *a = &c->attractors[attractor];
  const double place = a->orbit.x_error + a->orbit.v_error;
  const double errors[KEYS] = {a->orbit.amplitude_error, place, place};
  const pendres_cover *cover = cover_of(c, attractor);
  const int closes = pendres_attractor_closes(a);
  const double orbit[KEYS] = {closes ? a->orbit.amplitude : a->drift, a->orbit.x, a->orbit.v};
  const double chaos[KEYS] = {cover != NULL ? cover->mean_w : 0.0,
                              cover != NULL ? cover->mean_y : 0.0, a->lyapunov};
  const double key = cover != NULL ? chaos[k] : orbit[k];
  *error = cover != NULL ? 0.0 : errors[k];
  return isnan(key) ? INFINITY : key; /* NaN sorts last */
}

/* Give a group of their own to attractors that are further from their neighbour than by errors. */
static void part(size_t n, placed *p)
{
  int group = 0, before = 0; /* the new group, and the old one of the attractor before */
  for (size_t i = 0; i < n; i++) {
    const int old = p[i].group;
    if (i > 0 && (old != before || p[i].key - p[i - 1].key >
                                     pendres_orbit_slack(p[i].error + p[i - 1].error)))
      group++;
    before = old;
    p[i].group = group;
  }
}

int pendres_attractor_set_sort(const pendres_attractor_set *c, int *order)
{
  placed *p = malloc((c->count + 1) * sizeof *p);
  if (p == NULL) return -1;
  for (size_t i = 0; i < c->count; i++)
    p[i] = (placed){.group = cover_of(c, (int)i) != NULL               ? 1
                             : pendres_attractor_closes(&c->attractors[i]) ? 0 : 2,
                    .number = (int)i};
  for (int k = 0; k < KEYS; k++) {
    for (size_t i = 0; i < c->count; i++) p[i].key = key_of(c, p[i].number, k, &p[i].error);
    qsort(p, c->count, sizeof *p, by_group_and_key);
    part(c->count, p);
  }
  for (size_t i = 0; i < c->count; i++) order[i] = p[i].number;
  free(p);
  return 0;
}

/* ---- Mirror images -------------------------------------------------------------------------- */

static void raise_to(double difference, double *a, double *b)
{
  if (*a < difference) *a = difference;
  if (*b < difference) *b = difference;
}

/* Two values that are the same by symmetry. */
static void compare_values(double value, double other, double *error, double *other_error)
{
  const double difference = fabs(value - other);
  if (difference > *error + *other_error) raise_to(difference, error, other_error);
}

static void compare(pendres_attractor *a, pendres_attractor *b)
{
  pendres_orbit *o = &a->orbit, *p = &b->orbit;
  const pendres_orbit_row *row;
  double apart = 0.0;
  for (int k = 0; k < 2; k++)
    apart = fmax(apart, hypot(o->multiplier_re[k] - p->multiplier_re[k],
                              fabs(o->multiplier_im[k]) - fabs(p->multiplier_im[k])));
  compare_values(apart, 0.0, &o->multiplier_error, &p->multiplier_error);
  for (size_t k = 0; (row = pendres_orbit_row_get(k)) != NULL; k++)
    if (row->image && row->shown.error != PENDRES_ORBIT_EXACT)
      compare_values(*pendres_orbit_row_value(row, o), *pendres_orbit_row_value(row, p),
                     pendres_orbit_row_error(row, o), pendres_orbit_row_error(row, p));
  compare_values(a->lyapunov, b->lyapunov, &a->lyapunov_error, &b->lyapunov_error);
}

void pendres_attractor_set_compare_images(pendres_attractor_set *c)
{
  if (!pendres_pendulum_symmetric(&c->pendulum)) return;
  for (size_t i = 0; i < c->count; i++)
    for (size_t j = i + 1; j < c->count; j++) {
      pendres_attractor *a = &c->attractors[i], *b = &c->attractors[j];
      if (!pendres_attractor_closes(a) || !pendres_attractor_closes(b)) continue;
      if (pendres_orbit_are_images(&a->orbit, &b->orbit)) compare(a, b);
    }
}
