/*
 * scene_along.h -- what scenes share in which parameters of the pendulum move.
 *
 * Owns: the pendulum whose parameters stand still, those that move, and the attractor that a start
 * names.
 */
#ifndef SCENE_ALONG_H
#define SCENE_ALONG_H

#include "scenes/scene.h"

/* The deck's pendulum; what moves has its first value. */
pendres_pendulum scene_along_pendulum(const deck *d);

/* Set the quantity of an axis. */
void scene_along_set(pendres_pendulum *p, deck_axis_id axis, double value);

/* The library's number of an axis. */
pendres_parameter scene_along_parameter(deck_axis_id axis);

/*
 * The attractor that a deck's `start` names at some parameters: "sa", "la", or its number from 1
 * on. PENDRES_NOT_FOUND if there is none; why[size] then says what there is.
 */
pendres_status scene_along_named(pendres_context *ctx, const pendres_pendulum *p, const char *start,
                                 pendres_attractor *out, char *why, size_t size);

#endif
