/* rotations.c -- rotations without a drive, point by point; see rotations.h. */
#include "scenes/rotations.h"

#include <math.h>

#include <pendres/rotation.h>

typedef struct row {
  double period, period_error, mean_velocity, mean_velocity_error, multiplier, multiplier_error;
  double least_torque, least_torque_error;
} row;

static const scene_column columns[] = {
  SCENE_COLUMN(row, period, "period of the rotation, in which x grows or falls by 2 pi", "1"),
  SCENE_COLUMN(row, mean_velocity, "mean velocity of the rotation", "1"),
  SCENE_COLUMN(row, multiplier, "Floquet multiplier of the rotation; the other one is 1", "1"),
  SCENE_COLUMN(row, least_torque, "least torque, of either sign, that keeps a rotation up", "1")};

int scene_rotations_are(const scene_lines *l)
{
  const pendres_pendulum *p = &l->grid.pendulum;
  return p->force == PENDRES_FORCE_PENDULUM && p->drive_amplitude == 0.0 &&
         p->parametric_amplitude == 0.0 && !scene_lines_changes(l, PENDRES_DRIVE_AMPLITUDE) &&
         !scene_lines_changes(l, PENDRES_PARAMETRIC_AMPLITUDE) &&
         (p->torque != 0.0 || scene_lines_changes(l, PENDRES_TORQUE));
}

/* Dampings below 1e-9 and above 100 have no rotation that is told. */
static row row_of(const pendres_pendulum *p)
{
  pendres_rotation r;
  pendres_rotation_onset onset;
  row out = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  if (pendres_rotation_onset_find(p->damping, &onset) == PENDRES_OK) {
    out.least_torque = onset.torque;
    out.least_torque_error = onset.torque_error;
  }
  if (pendres_rotation_find(p, &r, NULL) != PENDRES_OK) return out;
  out.period = r.period;
  out.period_error = r.period_error;
  out.mean_velocity = r.mean_velocity;
  out.mean_velocity_error = r.mean_velocity_error;
  out.multiplier = r.multiplier;
  out.multiplier_error = r.multiplier_error;
  return out;
}

void scene_rotations_write(const scene_lines *l)
{
  row *rows = scene_array(l->run, l->n, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < l->n; i++) {
    const pendres_pendulum p = scene_lines_pendulum(l, i);
    rows[i] = row_of(&p);
  }
  const scene_table table = {
    .dimensions = {deck_axis_name(l->axis[0]), deck_axis_name(l->axis[1])}, .prefix = "rotation",
    .n = l->n, .stride = sizeof *rows, .rows = rows};
  SCENE_WRITE(l->run, &table, columns);
}
