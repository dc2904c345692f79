/*
 * hysteresis_circle.h -- a pendulum that is followed along the invariant circles of rotations.
 *
 * Owns: points and jumps of a path on which the pendulum is on a circle, locked or not.
 */
#ifndef PENDRES_HYSTERESIS_CIRCLE_H
#define PENDRES_HYSTERESIS_CIRCLE_H

#include "questions/hysteresis_path.h"

/* A pendulum on a circle, or on a rotation of which none is known yet: from value number *i on as
   far as there are circles. */
pendres_status pendres_path_circle(pendres_path *w, size_t *i);

/*
 * Whether the orbit of a fold at which the pendulum's state ends lies on a circle: then that is
 * where it goes, and jump and state are set; *done is 0 if not, or in doubt.
 */
pendres_status pendres_path_onto_circle(pendres_path *w, const pendres_bifurcation *end,
                                        int direction, pendres_jump *jump, int *done);

#endif
