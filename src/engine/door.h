/*
 * door.h -- how public functions go into canonical units, and out of them.
 *
 * Owns: the conversion of arguments and results, and the tolerance in canonical units. A public
 * function opens a door with the pendulum that it computes; its arguments are converted by
 * pendres_door_in(), its results are announced by pendres_door_out(), and closing the door converts
 * them back, whether the call succeeded or failed. Units are chosen at the outermost door: behind
 * it, one public function may call another, whose door then changes nothing. Where both units are
 * 1, nothing is copied or changed either. The body of a public function has a row for each argument
 * that has a dimension: which record it is, how many there are, and its name:
 *
 *   pendres_door d = pendres_door_open(ctx, pendulum);
 *   PENDRES_DOOR_IN(&d, pendulum, 1, pendulum);
 *   PENDRES_DOOR_IN(&d, state, n, starts);
 *   PENDRES_DOOR_OUT(&d, orbit, n, out);
 *   return PENDRES_DOOR_END(&d, find_orbits(ctx, pendulum, n, starts, out));
 */
#ifndef PENDRES_DOOR_H
#define PENDRES_DOOR_H

#include <pendres/parameter.h>
#include <pendres/strobe.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/units.h"

enum { PENDRES_DOOR_RESULTS = 16 /* most results of a call */ };

typedef struct pendres_door {
  pendres_context *ctx;
  pendres_status status; /* of the call so far */
  pendres_scales scales; /* of the present run of pendulums */
  size_t first, count;   /* pendulums of the present run */
  /* the rest is private to the door */
  int entered, outermost, begun;
  double tolerance; /* the caller's */
  int ranges;       /* whether a parameter of the pendulums is moved: this one, ... */
  pendres_parameter moved;
  double largest;   /* ... and its value of the largest size */
  const char *pendulums;
  size_t n, stride;
  pendres_room room; /* of pendres_door_memory() */
  int outs;
  struct {
    const pendres_dimensions *kind;
    size_t n;
    void *records;
  } out[PENDRES_DOOR_RESULTS];
} pendres_door;

/* For one pendulum; NULL: for what has no units. */
pendres_door pendres_door_open(pendres_context *ctx, const pendres_pendulum *p);

/* For what has these units, such as a handle that was made behind another door. */
pendres_door pendres_door_open_in(pendres_context *ctx, pendres_units u);

/* For a pendulum one of whose parameters takes n values: the one of the largest size decides, the
   pendulum's own does not count. The door's scales have its unit. */
pendres_door pendres_door_open_along(pendres_context *ctx, const pendres_pendulum *p,
                                     pendres_parameter moved, size_t n, const double *value);

/*
 * For n pendulums, each the first field of a record, with records `stride` bytes apart; or NULL.
 * Then pendres_door_next() is to be called until it returns 0: it opens the door for one run of
 * consecutive pendulums with the same units after another, d->count from d->first on.
 */
pendres_door pendres_door_open_many(pendres_context *ctx, size_t n, const void *pendulums,
                                    size_t stride);
int pendres_door_next(pendres_door *d);

/* One of the parameters of all of them is varied in a range: as pendres_door_open_along(). To be
   called before pendres_door_next(). */
void pendres_door_range(pendres_door *d, pendres_parameter moved, double low, double high);

/* The parameters that are varied, for records that hold values in their units. */
void pendres_door_move(pendres_door *d, pendres_parameter first, pendres_parameter second);

/* n records in canonical units: a copy that lasts until the run of pendulums ends, or the records
   themselves. NULL for NULL. */
const void *pendres_door_in(pendres_door *d, const pendres_dimensions *kind, size_t n,
                            const void *records);

/* n records of the caller that the call reads or writes; returns them. */
void *pendres_door_out(pendres_door *d, const pendres_dimensions *kind, size_t n, void *records);

/* The same of those records of an array, of all pendulums, that belong to the present run. */
const void *pendres_door_in_run(pendres_door *d, const pendres_dimensions *kind,
                                const void *records);
void *pendres_door_out_run(pendres_door *d, const pendres_dimensions *kind, void *records);

/* The first n points of a record: positions, velocities and their errors. */
void pendres_door_out_record(pendres_door *d, size_t n, const pendres_record *record);

/* An argument goes through the door: its name then stands for the records behind it. */
#define PENDRES_DOOR_IN(d, kind, n, argument) \
  ((argument) = pendres_door_in(d, &pendres_dim_##kind, n, argument))
#define PENDRES_DOOR_OUT(d, kind, n, argument) \
  ((argument) = pendres_door_out(d, &pendres_dim_##kind, n, argument))

/* Whether the call computes in units other than the caller's. */
int pendres_door_changes(const pendres_door *d);

/* Memory until the run of pendulums ends; NULL, and a failure, if there is none. */
void *pendres_door_memory(pendres_door *d, size_t size);

/* A copy of bytes in such memory; NULL if there is nothing to copy, and after a failure. */
void *pendres_door_copy(pendres_door *d, const void *bytes, size_t size);

/* End of the call: its status. */
pendres_status pendres_door_close(pendres_door *d);

/* The body of a public function behind its open door. */
#define PENDRES_DOOR_CALL(d, call) \
  ((d)->status = (d)->status == PENDRES_OK ? (call) : (d)->status)

/* The same, and the end of the call: its status. */
#define PENDRES_DOOR_END(d, call) (PENDRES_DOOR_CALL(d, call), pendres_door_close(d))

/* Entry i of an array that may be NULL. */
#define PENDRES_DOOR_AT(array, i) ((array) != NULL ? (array) + (i) : NULL)

#endif
