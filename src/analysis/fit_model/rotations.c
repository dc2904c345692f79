/*
 * rotations.c -- currents and voltages of a junction: mean velocities over the torque, without a
 * drive; see internal.h.
 *
 * A pendulum that is at rest stays so up to a torque of 1, of either sign, and then rotates; a
 * rotation goes on down to a smaller torque, or at strong friction to the same. So there are three
 * pieces over the torque, one behind the other, which overlap. The velocity of a lane says which
 * of them it is on.
 */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "model/rotation_slope.h"

static pendres_status lose(fit_model *m, const char *why)
{
  m->lost = why;
  return PENDRES_NOT_CONVERGED;
}

/* ---- pieces ---- */

/* An end of a piece at a torque, of a state that turns this way. */
static int add_end(fit_model *m, fit_curve *c, const fit_values v, double torque, double way)
{
  fit_fold *f = &c->fold[c->folds];
  *f = (fit_fold){.after = 0};
  pendres_fit_point_at(m, c, v, torque, f->u);
  f->u[PENDRES_U_W] = way;
  return (int)c->folds++;
}

pendres_status pendres_fit_rotation_curves(fit_model *m, const fit_values v)
{
  m->lost = NULL;
  for (size_t k = 0; k < m->curves; k++) {
    fit_curve *c = &m->curve[k];
    pendres_u u;
    pendres_rotation_onset onset;
    pendres_fit_point_at(m, c, v, 0.0, u);
    if (pendres_rotation_onset_find(u[PENDRES_U_GAMMA], &onset) != PENDRES_OK)
      return lose(m, "rotations are found at dampings from 1e-9 to 100");
    c->folds = c->pieces = 0;
    for (int way = -1; way <= 1; way++) {
      if ((way < 0 && !(c->from < 0.0)) || (way > 0 && !(c->to > 0.0))) continue;
      fit_piece *p = &c->piece[c->pieces++];
      *p = (fit_piece){.way = 1, .stable = 1, .low = -INFINITY, .high = INFINITY, .state = way,
                       .fold = {-1, -1}};
      if (way >= 0) p->fold[0] = add_end(m, c, v, p->low = way > 0 ? onset.torque : -1.0, way);
      if (way <= 0) p->fold[1] = add_end(m, c, v, p->high = way < 0 ? -onset.torque : 1.0, way);
    }
  }
  return PENDRES_OK;
}

/* ---- lanes ---- */

/* At the end of a piece the mean velocity is 0, whether the motion is at rest or infinitely slow. A
   rotation and rest that end at the same torque go over into each other without a jump. */
static int measure_end(fit_lane *l)
{
  double torque = 1.0, by_damping = 0.0;
  if (!pendres_rotation_onset_slope(l->u[PENDRES_U_GAMMA], &torque, &by_damping)) return 0;
  l->gradual = torque == 1.0;
  if (l->u[PENDRES_U_W] != 0.0)
    l->axis_slope[PENDRES_DAMPING] = l->u[PENDRES_U_W] * by_damping;
  return 1;
}

static int measure_state(fit_lane *l)
{
  pendres_rotation_slope r;
  const double way = l->u[PENDRES_U_W], torque = l->u[PENDRES_U_TORQUE];
  if (way == 0.0) {
    l->u[PENDRES_U_Y] = asin(fmax(-1.0, fmin(1.0, torque)));
    return 1;
  }
  if (!pendres_rotation_slope_at(l->u[PENDRES_U_GAMMA], way * torque, &r)) return 0;
  l->base[PENDRES_FIT_MEAN_VELOCITY] = way * r.mean_velocity;
  l->slope[PENDRES_FIT_MEAN_VELOCITY][PENDRES_TORQUE] = r.by_torque;
  l->slope[PENDRES_FIT_MEAN_VELOCITY][PENDRES_DAMPING] = way * r.by_damping;
  return 1;
}

void pendres_fit_rotations(fit_model *m)
{
  for (size_t i = 0; i < m->lanes; i++) {
    fit_lane *l = &m->lane[i];
    l->found = l->border[2] == 1.0 ? measure_state(l) : measure_end(l);
    l->stable = 1;
  }
}

/* ---- guesses ---- */

/* The datum of the largest torque, and the torques at which the voltage comes and goes. */
typedef struct seen {
  double torque, velocity, onset, end;
} seen;

static seen look(const fit_model *m, double offset)
{
  const pendres_fit_datum *top = &m->datum[0], *bottom = top;
  for (size_t i = 1; i < m->data; i++) {
    if (fabs(m->datum[i].axis) > fabs(top->axis)) top = &m->datum[i];
    if (fabs(m->datum[i].axis) < fabs(bottom->axis)) bottom = &m->datum[i];
  }
  if (isnan(offset)) offset = bottom->observed;
  seen s = {top->axis, top->observed - offset, NAN, NAN};
  const double least = fit_guess_voltage * fabs(s.velocity);
  for (size_t k = 0; k < m->tracks; k++) {
    const fit_track *t = &m->track[k];
    for (size_t i = 1; i < t->count; i++) {
      const fit_station *a = &m->station[t->first + i - 1], *b = a + 1;
      const int before = fabs(m->datum[m->order[a->first]].observed - offset) > least;
      const int after = fabs(m->datum[m->order[b->first]].observed - offset) > least;
      const double middle = fabs(0.5 * (a->axis + b->axis));
      if (!before && after) s.onset = fmax(middle, isnan(s.onset) ? 0.0 : s.onset);
      if (before && !after) s.end = fmin(middle, isnan(s.end) ? INFINITY : s.end);
    }
  }
  if (isnan(s.onset)) s.onset = s.end;
  return s;
}

/* At large torques friction balances them: the velocity is torque / damping. */
int pendres_fit_rotation_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES])
{
  const int open_scale = isnan(v[PENDRES_FIT_TORQUE_SCALE]);
  const int open_gain = isnan(v[PENDRES_FIT_AMPLITUDE_SCALE]);
  const int open_damping = isnan(v[PENDRES_DAMPING]);
  const seen s = look(m, v[PENDRES_FIT_OFFSET]);
  int count = 0;
  if (s.velocity == 0.0 || (open_scale && isnan(s.onset))) return 0;
  const double scale = open_scale ? 1.0 / s.onset : v[PENDRES_FIT_TORQUE_SCALE];
  const double torque = fabs(scale * s.torque);
  for (int k = -1; k < (open_damping ? FIT_GUESS_DAMPINGS : 0); k++) {
    fit_values *to = &out[count];
    pendres_rotation_slope r;
    memcpy(*to, v, sizeof *to);
    (*to)[PENDRES_FIT_TORQUE_SCALE] = scale;
    if (open_damping && k >= 0)
      (*to)[PENDRES_DAMPING] = fit_guess_damping * pow(fit_guess_dampings, k);
    else if (open_damping && open_gain) /* Melnikov's, of a small one */
      (*to)[PENDRES_DAMPING] = 0.25 * pi * scale * s.end;
    else if (open_damping)
      (*to)[PENDRES_DAMPING] = torque * v[PENDRES_FIT_AMPLITUDE_SCALE] / fabs(s.velocity);
    if (!((*to)[PENDRES_DAMPING] > 0.0)) continue;
    const int runs = pendres_rotation_slope_at((*to)[PENDRES_DAMPING], torque, &r);
    if (open_gain) (*to)[PENDRES_FIT_AMPLITUDE_SCALE] = fabs(s.velocity) / r.mean_velocity;
    count += runs;
  }
  return count;
}
