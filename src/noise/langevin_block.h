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
  size_t capacity; /* lanes that memory was taken for */
  size_t count;    /* lanes in use; the others of the last eight hold copies of lane 0 */
  size_t stride;   /* count rounded up to a multiple of 8 */
  int steps;       /* a drive period */
  int noisy;       /* any lane has a temperature */
  int harmonics;   /* sums are wanted */
  uint32_t key[2];
  double *memory;  /* all rows of doubles, `capacity` apart */
  double *x, *v;   /* at the strobe */
  double *base;    /* whole turns taken off x, and the well's bottom */
  double *drive, *pivot_speed, *cosine, *sine, *work;
  double *reach[PENDRES_LANGEVIN_DURATIONS], *decay[PENDRES_LANGEVIN_DURATIONS];
  double *gauss;   /* PENDRES_LANGEVIN_WORDS rows, `stride` apart */
  pendres_langevin_rows rows;
  uint64_t *id, *words;
  double *phases;  /* cosine and sine of the drive phases at each step's start and two kicks */
  int (*stop)(void *arg); /* asked within long periods, nonzero ends them; NULL: nobody is asked */
  void *stop_arg;
} pendres_langevin_block;

/* Zeroed block to a block; on failure it can be freed all the same. */
pendres_status pendres_langevin_block_make(pendres_langevin_block *b, size_t capacity,
                                           uint64_t seed);
void pendres_langevin_block_clear(pendres_langevin_block *b);

/* Before lanes are loaded: the drive phases of the kicks. */
pendres_status pendres_langevin_block_set_steps(pendres_langevin_block *b, int steps);

/* How many lanes; loads follow for 0 .. count - 1, then finish. */
void pendres_langevin_block_resize(pendres_langevin_block *b, size_t count);
void pendres_langevin_block_load(pendres_langevin_block *b, size_t lane, const pendres_pendulum *p,
                                 uint64_t id, double x, double v);
void pendres_langevin_block_finish(pendres_langevin_block *b);

/* One drive period. PENDRES_INTERRUPTED if stop() said so: then nothing of the lanes is valid. */
pendres_status pendres_langevin_block_period(pendres_langevin_block *b, uint32_t period);

/*
 * The same for a pair: `fine` has twice the steps of `coarse`, whose kicks take the sums of
 * two of fine's. Both have the same lanes; fine's stop() is asked.
 */
pendres_status pendres_langevin_block_pair(pendres_langevin_block *fine,
                                           pendres_langevin_block *coarse, uint32_t period);

/* NULL, or why no block can hold this pendulum with these steps. */
const char *pendres_langevin_block_refuses(const pendres_pendulum *p, int steps);

#endif
