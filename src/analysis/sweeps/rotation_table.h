/*
 * rotation_table.h -- rotations without a drive at many values of a parameter.
 *
 * Owns: computing them from a few by interpolation; where along the parameter rotations end;
 * whether a pendulum in some state comes to rotate.
 *
 * Where a rotation exists there is one, and its velocity is an analytic function of torque and
 * damping up to where it ends. The least torque grows with the damping (Tricomi, Annali della
 * Scuola Normale Superiore di Pisa 2 (1933) 1), so that rotations along either parameter, the
 * torque's sign kept, reach as far as one value and no further.
 */
#ifndef PENDRES_ROTATION_TABLE_H
#define PENDRES_ROTATION_TABLE_H

#include <pendres/continuation.h>
#include <pendres/rotation.h>

#include "base/bytes.h"

typedef struct pendres_rotation_table pendres_rotation_table;

/* The table for a pendulum with one free parameter, at value[n] in any order. */
pendres_status pendres_rotation_table_create(pendres_context *ctx, const pendres_pendulum *p,
                                             pendres_parameter parameter, size_t n,
                                             const double *value, pendres_rotation_table **out);
void pendres_rotation_table_free(pendres_rotation_table *t);

/* Pass a table, or none, as plain bytes; one that was read only has its rotations. */
void pendres_rotation_table_pass(pendres_bytes *b, pendres_rotation_table **table);

/* The rotation at one of the values: only mean velocity and v with their errors are set. NULL if
   there is none. */
const pendres_rotation *pendres_rotation_table_at(const pendres_rotation_table *t, double value);

/* Where rotations end. */
typedef struct pendres_rotation_limit {
  double value, error;      /* of the parameter */
  pendres_rotation_end end; /* how */
} pendres_rotation_limit;

/* The end between a value at which there is a rotation and one at which there is none, or one in
   the other direction. PENDRES_NOT_FOUND if the end does not depend on the parameter. */
pendres_status pendres_rotation_limit_between(const pendres_pendulum *p,
                                              pendres_parameter parameter, double with,
                                              double without, pendres_rotation_limit *out);

/* Whether a pendulum has no drive and a torque, so that rotation.h tells its rotations. */
int pendres_rotation_may_be(const pendres_pendulum *p);

/*
 * Whether a pendulum comes to rotate from a state, and if so its rotation. With torques up to 1 it
 * does if it passes an upper equilibrium in the direction of the torque: it is then faster than the
 * unstable manifold of that equilibrium, which passes the next one wherever there is a rotation,
 * and trajectories do not cross. One that has not passed in the time that it is followed may still
 * do so later, very close to the edge of a basin.
 */
pendres_status pendres_rotation_reached(pendres_context *ctx, const pendres_pendulum *p, double x,
                                        double v, pendres_rotation *out, int *reached);

#endif
