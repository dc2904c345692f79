/*
 * rotation_table.h -- rotations without a drive at many values of a parameter.
 *
 * Owns: telling them from a few by interpolation; where along the parameter rotations end; whether
 * a pendulum in some state comes to rotate.
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

typedef struct pendres_rotation_table pendres_rotation_table;

/* Of a pendulum but for a parameter, at values[n] in any order. */
pendres_status pendres_rotation_table_create(pendres_context *ctx, const pendres_pendulum *p,
                                             pendres_parameter parameter, size_t n,
                                             const double *value, pendres_rotation_table **out);
void pendres_rotation_table_free(pendres_rotation_table *t);

/* The rotation at one of the values: mean velocity and v, and their errors; nothing else of it is
   told. NULL where there is none. */
const pendres_rotation *pendres_rotation_table_at(const pendres_rotation_table *t, double value);

/* Where rotations end. */
typedef struct pendres_rotation_limit {
  double value, error;      /* of the parameter */
  pendres_rotation_end end; /* how */
} pendres_rotation_limit;

/* The end between a value at which there is a rotation and one at which there is none, or one the
   other way. PENDRES_NOT_FOUND where the parameter does not move it. */
pendres_status pendres_rotation_limit_between(const pendres_pendulum *p,
                                              pendres_parameter parameter, double with,
                                              double without, pendres_rotation_limit *out);

/* Whether a pendulum has no drive and a torque, so that rotation.h tells its rotations. */
int pendres_rotation_may_be(const pendres_pendulum *p);

/*
 * Whether a pendulum comes to rotate from a state, and then its rotation. With torques up to 1: it
 * passes an upper equilibrium with the torque. There the unstable manifold has no velocity yet,
 * motions do not cross, and that manifold gets over the next one wherever there is a rotation. One
 * that is not seen to pass may still do so later, very close to the edge of a basin.
 */
pendres_status pendres_rotation_reached(pendres_context *ctx, const pendres_pendulum *p, double x,
                                        double v, pendres_rotation *out, int *reached);

#endif
