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

/* A path and what was met on it. */
typedef struct scene_along_path {
  size_t points, jumps;
  pendres_hysteresis_point *point; /* [points] in the order of the path */
  pendres_jump *jump;              /* [jumps] */
} scene_along_path;

void scene_along_path_free(scene_along_path *path);

/* Follow the deck's pendulum from its start along n values of an axis, and fill a record. */
pendres_status scene_along_follow(const deck *d, deck_axis_id axis, size_t n, const double *value,
                                  pendres_context *ctx, farm_record *out);

/* Take over such a record. */
pendres_status scene_along_take(const farm_record *in, scene_along_path *path);

/* Whether a point is on a closed orbit. */
int scene_along_closed(const pendres_hysteresis_point *point);

/* The flags of a variable of labels. */
void scene_along_label_flags(pendres_store_spec *spec);

/* `label` and `failed` over the axis, or over direction and axis where there are two ways; what
   failed is counted and told. Points of the way back are in the order of the axis, too. */
pendres_status scene_along_write_labels(scene_run *run, deck_axis_id axis,
                                        const scene_along_path *path, int ways);

#endif
