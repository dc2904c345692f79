/*
 * hysteresis_circle.h -- a pendulum that is followed along the invariant circles of rotations.
 *
 * Owns: those points and jumps of a path at which the pendulum is on a circle, locked or not.
 */
#ifndef PENDRES_HYSTERESIS_CIRCLE_H
#define PENDRES_HYSTERESIS_CIRCLE_H

#include "analysis/sweeps/hysteresis_path.h"

/* Follow a pendulum on a circle, or on a rotation whose circle is not known yet, from value number
   *i on as far as there are circles. */
pendres_status pendres_path_circle(pendres_path *w, size_t *i);

/*
 * Whether the orbit of a fold at which the pendulum's state ends lies on a circle. If it does, the
 * pendulum goes to that circle, and jump and state are set; if not, or if in doubt, *done is 0.
 */
pendres_status pendres_path_onto_circle(pendres_path *w, const pendres_bifurcation *end,
                                        int direction, pendres_jump *jump, int *done);

#endif
