/*
 * langevin_block.h -- a block of noisy pendulums, side by side.
 *
 * Owns: memory and constants of a block, and advancing it over one drive period. For the
 * integrator see langevin.h and langevin_block.c.
 */
#ifndef PENDRES_LANGEVIN_BLOCK_H
#define PENDRES_LANGEVIN_BLOCK_H

#include <pendres/langevin.h>

#include "noise/kernels_langevin.h"

/* The three durations of free motion: to a step's first kick, between its kicks, and from its
 * last kick to the next step's first. */
typedef enum pendres_langevin_duration {
  PENDRES_LANGEVIN_EDGE,
  PENDRES_LANGEVIN_INNER,
  PENDRES_LANGEVIN_BETWEEN,
  PENDRES_LANGEVIN_DURATIONS
} pendres_langevin_duration;

typedef struct pendres_langevin_block {
  const pendres_kernels_langevin *kernels;
  size_t capacity; /* how many lanes there is memory for */
  size_t count;    /* lanes in use; those that fill up the last eight hold copies of lane 0 */
  size_t stride;   /* count rounded up to a multiple of 8 */
  int steps;       /* in a drive period */
  pendres_model_terms terms; /* the terms of the force, the same in all lanes */
  double origin, turn;       /* where y is counted from, and the period of the coordinate */
  int noisy;       /* whether any lane has a temperature */
  int harmonics;   /* whether first harmonics and work are to be summed up */
  uint32_t key[2];
  double *memory;  /* all rows of doubles, `capacity` apart */
  double *x, *v;   /* the states at the last strobe */
  double *base;    /* position of the bottom of each lane's well at the last strobe: x = y + base */
  double *drive, *pivot_speed, *cosine, *sine, *work;
  double *reach[PENDRES_LANGEVIN_DURATIONS], *decay[PENDRES_LANGEVIN_DURATIONS];
  double *gauss;   /* PENDRES_LANGEVIN_WORDS rows, `stride` apart */
  pendres_langevin_rows rows;
  uint64_t *id, *words;
  double *phases;  /* cosines and sines of the drive phases at each step's start and two kicks */
  int (*stop)(void *arg); /* called now and then within long periods, which end at once if it
                             returns nonzero; may be NULL */
  void *stop_arg;
} pendres_langevin_block;

/* Allocate a block that is all zero so far. Clear it in any case, also after a failure. */
pendres_status pendres_langevin_block_make(pendres_langevin_block *b, size_t capacity,
                                           uint64_t seed);
void pendres_langevin_block_clear(pendres_langevin_block *b);

/* Choose the steps; this comes before lanes are loaded. */
pendres_status pendres_langevin_block_set_steps(pendres_langevin_block *b, int steps);

/* Begin to load: resize to the number of lanes, load each from 0 to count - 1, then finish. All
 * pendulums of a block have the same terms in their force (pendres_model_kind). */
void pendres_langevin_block_resize(pendres_langevin_block *b, size_t count);
void pendres_langevin_block_load(pendres_langevin_block *b, size_t lane, const pendres_pendulum *p,
                                 uint64_t id, double x, double v);
void pendres_langevin_block_finish(pendres_langevin_block *b);

/* Advance by one drive period, whose number is part of the counter of the random numbers. Returns
 * PENDRES_INTERRUPTED if stop() returned nonzero; the lanes are not valid then. */
pendres_status pendres_langevin_block_period(pendres_langevin_block *b, uint32_t period);

/* The parameters of a pendulum at a time, in drive periods since the start. */
typedef pendres_pendulum pendres_langevin_motion(void *arg, double time);

/* The same for one pendulum in all lanes whose parameters change with time; its force keeps its
 * kind (pendres_force). The period goes from time `period` to period + 1. */
pendres_status pendres_langevin_block_moving(pendres_langevin_block *b, uint32_t period,
                                             pendres_langevin_motion *motion, void *arg);

/*
 * pendres_langevin_block_period for a pair with the same lanes and the same noise: `fine` has twice
 * the steps of `coarse`, and the noise of a coarse kick is the sum of that of two fine ones. Only
 * fine's stop() is called.
 */
pendres_status pendres_langevin_block_pair(pendres_langevin_block *fine,
                                           pendres_langevin_block *coarse, uint32_t period);

/* Why no block can hold this pendulum with these steps; NULL if one can. */
const char *pendres_langevin_block_refuses(const pendres_pendulum *p, int steps);

#endif
