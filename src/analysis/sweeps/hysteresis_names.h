/*
 * hysteresis_names.h -- the results of a path, and the names of its states.
 */
#ifndef PENDRES_HYSTERESIS_NAMES_H
#define PENDRES_HYSTERESIS_NAMES_H

#include <pendres/hysteresis.h>

struct pendres_hysteresis {
  size_t count, jumps, jump_room, steps, step_room;
  pendres_hysteresis_point *point;
  pendres_jump *jump;
  pendres_step *step;
  /* For names: the number of the part (stable_part.h) that a point belongs to, and of those that a
     jump comes from and leads to. */
  size_t parts;
  size_t *part, *jump_from, *jump_to;
};

/* Name the states of all points and jumps, by comparing those at the same value. */
pendres_status pendres_hysteresis_name(pendres_context *ctx, pendres_hysteresis *h);

#endif
