/*
 * door.h -- lines of a phase diagram behind the door (engine/door.h).
 */
#ifndef PENDRES_PHASE_DOOR_H
#define PENDRES_PHASE_DOOR_H

#include <pendres/phase_diagram.h>

#include "engine/door.h"

/* Open the door to a line of n pendulums between these two; NULL: there are none. */
pendres_door pendres_phase_open(pendres_context *ctx, const pendres_phase_options *o, size_t n,
                                const pendres_pendulum *first, const pendres_pendulum *last);

/* Its options behind the door, in *inside; NULL for NULL. */
const pendres_phase_options *pendres_phase_options_inside(const pendres_door *d,
                                                          const pendres_phase_options *options,
                                                          pendres_phase_options *inside);

#endif
