/*
 * hysteresis_crisis.h -- chaos that suddenly becomes larger or smaller, and goes on.
 *
 * Owns: where an interior crisis lies between two values of a parameter, at both of which a
 * pendulum is chaotic.
 */
#ifndef PENDRES_HYSTERESIS_CRISIS_H
#define PENDRES_HYSTERESIS_CRISIS_H

#include "analysis/sweeps/hysteresis_path.h"

/*
 * A pendulum was in chaos, `old`, at the path's last value, and is at that of its state. Where the
 * set of its strobe points is suddenly larger on one side of a place between the two, kind (which
 * the caller has set to another), value, value_error, from, to, to_period, share and certain of the
 * jump are set. One place is found where there are several. What changes gradually, or cannot be
 * told from it, is not.
 */
pendres_status pendres_crisis_find(pendres_path *w, const pendres_arrival *old, pendres_jump *jump);

/* Pass what was seen of chaos last as plain bytes. */
void pendres_crisis_seen_pass(pendres_bytes *b, pendres_path *path);

#endif
