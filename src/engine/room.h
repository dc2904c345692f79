/*
 * room.h -- the arrays that a computation needs while it lasts: taken one by one, freed together.
 *
 * They are all zero at first. Where memory ends the context says what it was for, and nothing more
 * is given, so that it is enough to look at the status when all have been taken.
 */
#ifndef PENDRES_ROOM_H
#define PENDRES_ROOM_H

#include <pendres/context.h>

typedef struct pendres_room {
  pendres_context *ctx;
  const char *what;      /* the arrays hold, as in "orbits" */
  pendres_status status; /* PENDRES_OUT_OF_MEMORY once an array has been refused */
  struct pendres_room_array *last;
} pendres_room;

/* Without arrays yet. */
static inline pendres_room pendres_room_open(pendres_context *ctx, const char *what)
{
  return (pendres_room){.ctx = ctx, .what = what, .status = PENDRES_OK};
}

/* An array of n elements, of which either number may be 0; NULL: this one or an earlier one was
   refused. */
void *pendres_room_take(pendres_room *r, size_t n, size_t size);

/* Free them all; gives back the status that it is handed, so that it can be a function's end. */
pendres_status pendres_room_close(pendres_room *r, pendres_status status);

#endif
