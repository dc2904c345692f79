/*
 * check.h -- records that come from elsewhere: whether they can be what a task has written.
 *
 * Owns: the ranges of what scenes' records hold of the library's structs: codes, counts, flags,
 * numbers of things and texts. Doubles may be anything. Each returns 0 where something is out of
 * its range; a stage's farm_check puts them together.
 */
#ifndef SCENE_CHECK_H
#define SCENE_CHECK_H

#include "scenes/failed.h"

/* Is a code one of 0 .. count - 1? Of an enum too, whatever its sign. */
int scene_check_code(int code, int count);

/* Does a text end within its room? */
int scene_check_text(const char *text, size_t room);

int scene_check_attractor(const pendres_attractor *a); /* closed or not */
int scene_check_response(const pendres_response *r);

/* attractors: how many the set has to which the state's number refers. */
int scene_check_basin_state(const pendres_basin_state *state, size_t attractors);

#endif
