/*
 * hysteresis_state.h -- a path on its way as plain bytes, from which it goes on (engine/keep.h).
 */
#ifndef PENDRES_HYSTERESIS_STATE_H
#define PENDRES_HYSTERESIS_STATE_H

#include "analysis/sweeps/hysteresis_left.h"
#include "base/bytes.h"

/* What is asked for, from position x and velocity v on; to be freed. */
pendres_bytes pendres_path_question(const pendres_path *w, double x, double v);

/* Whether a path can go on from its state: its part can be found again. */
int pendres_path_keeps(const pendres_path *w);

/*
 * Pass all that a path has come to before value number *at. One that was read has no part yet but
 * its way (pendres_part_again()); *follows: whether there is one. PENDRES_INVALID_ARGUMENT: the
 * bytes are none of this path's, which is then to begin anew.
 */
void pendres_path_pass(pendres_bytes *b, pendres_path *w, pendres_path_left *left, size_t *at,
                       int *follows);

#endif
