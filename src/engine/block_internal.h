/*
 * block_internal.h -- what a block is made of.
 *
 * Owns: the struct that block.c, which advances a block, block_lanes.c, which fills its lanes, and
 * block_alone.c share. No other file includes it.
 */
#ifndef PENDRES_BLOCK_INTERNAL_H
#define PENDRES_BLOCK_INTERNAL_H

#include <stddef.h>

#include "engine/kernels/kernels_nystrom.h"
#include "engine/sundials/lanes.h"
#include "engine/sundials/lanes_replay.h"
#include "engine/sundials/lanes_shape.h"
#include "engine/kernels/tables.h"

/* Arrays of coefficients, an entry a lane. */
enum {
#define PLACE(name, value) PLACE_##name,
  PENDRES_COEFFICIENTS_PLAIN(PLACE) PENDRES_COEFFICIENTS_OTHER(PLACE)
#undef PLACE
  POWERS,
  COEFFICIENTS = POWERS + PENDRES_FORCE_POWERS
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

/* The drive at the right-hand sides of a block: the exact phase of each stage, and the drive's
   cosine there, remembered from period to period. */
typedef struct pendres_block_drive {
  int steps;                               /* a period; 0: adaptive */
  int stages;
  double node[PENDRES_TABLES_MOST_STAGES]; /* of the stages of a step */
  double *theta, *cosine; /* at the right-hand sides of a period, in their order, which is the same
                             every period */
  size_t size, next;
} pendres_block_drive;

/* The exact phase of the stage at which ARKODE's clock shows theta. */
double pendres_block_drive_phase(const pendres_block_drive *drive, double theta);

/* cos(theta) at the next right-hand side of a period. */
double pendres_block_drive_cosine(pendres_block_drive *drive, double theta);

/* Begin a period. */
void pendres_block_drive_rewind(pendres_block_drive *drive);

/* Make room for `steps` steps per period. */
int pendres_block_drive_resize(pendres_block_drive *drive, int steps);

void pendres_block_drive_free(pendres_block_drive *drive);

struct pendres_block {
  pendres_context *ctx;
  pendres_lanes_shape shape;
  double tolerance;
  double end, half;       /* ARKODE's clock after a period and half of one */
  N_Vector state;
  double *rows;           /* the state as seen by the rest of the engine, row after row */
  double *coefficient[COEFFICIENTS];
  pendres_flow_load load; /* what is carried, */
  double *off[CARRIED];   /* in these; NULL until anything is */
  pendres_block_drive drive;
  pendres_nystrom_steps nystrom;  /* steps without ARKODE, once there are any */
  pendres_lanes_replays *replays; /* of periods with fixed steps */
  void *arkode;
  double evaluations, steps_taken;
  double next_asked;      /* the number of steps at which the context is next asked to go on */
  int stopped;
  size_t lanes; /* in use */
  int failure;
};

/* Make the steps of a period, unless they are there; 0, or -1 if out of memory. */
int pendres_block_nystrom_prepare(pendres_nystrom_steps *s, int steps);

/* block_alone.c: the lanes of a block over a period without ARKODE. Returns how many right-hand
   sides that took for each lane; if negative, nothing was done: there is no memory, or such a block
   cannot. */
enum { PENDRES_BLOCK_STARVED = -2, PENDRES_BLOCK_CANNOT = -1 };
int pendres_block_run_nystrom(struct pendres_block *b, int single);
void pendres_block_alone_free(struct pendres_block *b);

/* Make the arrays for the coefficients of all lanes and for the rows. 0, or -1 without memory:
   pendres_block_free then frees what there is. */
int pendres_block_lanes_open(struct pendres_block *b);
void pendres_block_lanes_close(struct pendres_block *b);

#endif
