/*
 * flow_internal.h -- what a block is made of.
 *
 * Owns: the struct that flow.c, which advances a block, and flow_lanes.c, which fills its lanes,
 * share. No other file includes it.
 */
#ifndef PENDRES_FLOW_INTERNAL_H
#define PENDRES_FLOW_INTERNAL_H

#include "engine/flow_drive.h"
#include "engine/lanes.h"
#include "engine/lanes_replay.h"
#include "engine/lanes_shape.h"

/* Arrays of coefficients, an entry a lane. */
enum {
  STIFFNESS,
  DRIVE,
  FRICTION,
  INVERSE,
  TORQUE,
  MODULATION,
  POWERS,
  COEFFICIENTS = POWERS + PENDRES_FORCE_COEFFICIENTS
};

/* Arrays of what is carried, an entry a lane: of errors, in the order of pendres_carried, or of
   tangents. */
enum {
  ERROR_YY,
  ERROR_YW,
  ERROR_WW,
  ERROR_ADDED,
  ERROR_KEEP,
  ERROR_KICK,
  CARRIED,
  TANGENT_Y = 0, /* two, */
  TANGENT_W = 2, /* two, */
  TANGENT_KEEP = 4
};

struct pendres_flow {
  pendres_lanes_shape shape;
  double tolerance;
  double end, half;       /* ARKODE's clock after a period and half of one */
  N_Vector state;
  double *rows;           /* the state as seen by the rest of the engine, row after row */
  double *coefficient[COEFFICIENTS];
  pendres_flow_load load; /* what is carried, */
  double *off[CARRIED];   /* in these; NULL until anything is */
  pendres_flow_drive drive;
  pendres_lanes_replays *replays; /* of periods with fixed steps */
  void *arkode;
  double evaluations, steps_taken;
  int (*stop)(void *arg); /* called now and then within a period; may be NULL */
  void *stop_arg;
  double next_asked;      /* the number of steps at which it is called next */
  int stopped;
  size_t lanes; /* in use */
  int failure;
};

/* Make the arrays for the coefficients of all lanes and for the rows. 0, or -1 without memory:
   pendres_flow_free then frees what there is. */
int pendres_flow_lanes_open(struct pendres_flow *flow);
void pendres_flow_lanes_close(struct pendres_flow *flow);

#endif
