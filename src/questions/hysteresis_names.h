/*
 * hysteresis_names.h -- what was met on a path, and what its states are called.
 */
#ifndef PENDRES_HYSTERESIS_NAMES_H
#define PENDRES_HYSTERESIS_NAMES_H

#include <pendres/hysteresis.h>

struct pendres_hysteresis {
  size_t count, jumps, jump_room;
  pendres_hysteresis_point *point;
  pendres_jump *jump;
  /* For names: which of the stretches followed a point belongs to, and a jump comes from and leads
     to. */
  size_t stretches;
  size_t *stretch, *jump_from, *jump_to;
};

/* Name the states of all points and jumps, by which of them meet at the same value. */
pendres_status pendres_hysteresis_name(pendres_context *ctx, pendres_hysteresis *h);

#endif
