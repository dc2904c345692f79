/*
 * door.h -- the way of public functions into canonical units, and out of them.
 *
 * Owns: the conversion of arguments and results, and the tolerance in canonical units. A public
 * function opens a door with the pendulum that it is about; what it was given comes in by
 * pendres_door_in(), what it writes is announced by pendres_door_out(), and closing the door
 * converts that back, whatever became of the call. Units are chosen at the outermost door: within,
 * one public function may call another, whose door then changes nothing. Where they are 1 and 1
 * nothing is copied or changed either.
 */
#ifndef PENDRES_DOOR_H
#define PENDRES_DOOR_H

#include <pendres/parameter.h>

#include "engine/context_internal.h"
#include "model/units.h"

enum { PENDRES_DOOR_RESULTS = 16 /* most results of a call */ };

struct pendres_door_memory;

typedef struct pendres_door {
  pendres_context *ctx;
  pendres_status status; /* of the call so far */
  pendres_scales scales; /* of the present stretch */
  size_t first, count;   /* pendulums of the present stretch */
  /* the rest is the door's own */
  int entered, outermost, begun;
  double tolerance; /* the caller's */
  int ranges;       /* whether a parameter of the pendulums is moved: this one, ... */
  pendres_parameter moved;
  double largest;   /* ... and its value of the largest size */
  const char *pendulums;
  size_t n, stride;
  struct pendres_door_memory *memory;
  int outs;
  struct {
    const pendres_dimensions *kind;
    size_t n;
    void *records;
  } out[PENDRES_DOOR_RESULTS];
} pendres_door;

/* For one pendulum; NULL: what has no units. */
void pendres_door_open(pendres_door *d, pendres_context *ctx, const pendres_pendulum *p);

/* For what has these units, as a handle that was made behind another door. */
void pendres_door_open_in(pendres_door *d, pendres_context *ctx, pendres_units u);

/* For a pendulum one of whose parameters takes n values: the one of the largest size decides, the
   pendulum's own does not count. d->scales has its unit. */
void pendres_door_open_along(pendres_door *d, pendres_context *ctx, const pendres_pendulum *p,
                             pendres_parameter moved, size_t n, const double *value);

/*
 * For n pendulums that are the first fields of records so many bytes apart, or NULL. Then
 * pendres_door_next() is to be called until it returns 0: it opens the door to one stretch after
 * another of pendulums with the same units, d->count from d->first on.
 */
void pendres_door_open_many(pendres_door *d, pendres_context *ctx, size_t n,
                            const void *pendulums, size_t stride);
int pendres_door_next(pendres_door *d);

/* One of the parameters of all of them is moved in a range: as pendres_door_open_along(). To be
   called before pendres_door_next(). */
void pendres_door_range(pendres_door *d, pendres_parameter moved, double low, double high);

/* The unit of a parameter that is moved, for records that hold values of it. */
void pendres_door_move(pendres_door *d, pendres_parameter first, pendres_parameter second);

/* n records in canonical units: a copy that lasts until the stretch ends, or the records
   themselves. NULL for NULL. */
const void *pendres_door_in(pendres_door *d, const pendres_dimensions *kind, size_t n,
                            const void *records);

/* n records of the caller that the call reads or writes; returns them. */
void *pendres_door_out(pendres_door *d, const pendres_dimensions *kind, size_t n, void *records);

/* Whether the call takes place in other units than the caller's. */
int pendres_door_changes(const pendres_door *d);

/* Memory until the stretch ends; NULL, and a failure, if there is none. */
void *pendres_door_memory(pendres_door *d, size_t size);

/* A copy of bytes in such memory; NULL of nothing, and after a failure. */
void *pendres_door_copy(pendres_door *d, const void *bytes, size_t size);

/* End of the call: its status. */
pendres_status pendres_door_close(pendres_door *d);

/* The body of a public function behind its open door. */
#define PENDRES_DOOR_CALL(d, call) \
  ((d)->status = (d)->status == PENDRES_OK ? (call) : (d)->status)

/* Entry i of an array that may be NULL. */
#define PENDRES_DOOR_AT(array, i) ((array) != NULL ? (array) + (i) : NULL)

#endif
