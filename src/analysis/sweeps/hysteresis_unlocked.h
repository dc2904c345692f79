/*
 * hysteresis_unlocked.h -- a pendulum that is followed along rotations which are not locked to the
 * drive.
 *
 * Owns: those points of a path. There is at most one such rotation at each value (lyapunov.h), so
 * that many values are averaged side by side, and those met on the way up serve on the way down.
 */
#ifndef PENDRES_HYSTERESIS_UNLOCKED_H
#define PENDRES_HYSTERESIS_UNLOCKED_H

#include "analysis/sweeps/hysteresis_path.h"

/*
 * Follow a pendulum on such a rotation from value number *i on as long as there is one. *next
 * receives what the pendulum settles on at value number *i then, unresolved where that is not known
 * yet.
 */
pendres_status pendres_path_unlocked(pendres_path *w, size_t *i, pendres_arrival *next);

/* Find the mean of the rotation on which a pendulum has settled at value number i, together with
   those at the values that follow: *found says whether w->state is on it. */
pendres_status pendres_path_unlocked_at(pendres_path *w, size_t i, int *found);

/* Pass the rotations that are known as plain bytes. */
void pendres_path_unlocked_pass(pendres_bytes *b, pendres_path *w);

void pendres_path_unlocked_free(pendres_path *w);

#endif
