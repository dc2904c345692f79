/*
 * steps_memo.h -- the steps that were chosen for cells of a lattice in parameter space.
 */
#ifndef PENDRES_STEPS_MEMO_H
#define PENDRES_STEPS_MEMO_H

#include <pendres/pendulum.h>
#include <pendres/status.h>

/* A cell of the lattice: indices of damping, frequency, drive, speed, tolerance, torque (-1: none),
   and parametric drive (likewise); and the force itself. */
typedef struct pendres_steps_cell {
  int damping, frequency, drive, speed, tolerance, torque, parametric;
  pendres_force force;
  double coefficients[PENDRES_FORCE_COEFFICIENTS];
} pendres_steps_cell;

typedef struct pendres_steps_memo pendres_steps_memo;

pendres_status pendres_steps_memo_create(pendres_steps_memo **out);
void pendres_steps_memo_free(pendres_steps_memo *memo);

/* The steps of a cell, 0 if they are not known. */
int pendres_steps_memo_find(const pendres_steps_memo *memo, const pendres_steps_cell *cell);

/* PENDRES_OK or PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_steps_memo_add(pendres_steps_memo *memo, const pendres_steps_cell *cell,
                                      int steps);

#endif
