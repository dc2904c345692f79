/*
 * numbers.h -- numbers that were chosen for basins and their boundaries, each with its reason.
 */
#ifndef PENDRES_BASINS_NUMBERS_H
#define PENDRES_BASINS_NUMBERS_H

#include "continuation/numbers.h"

/* ---- grids ---- */

enum {
  BASIN_GUESS_SIDE = 24,      /* initial guesses over the grid: at most this many by this many */
  BASIN_MORE_GUESSES = 256,   /* states that are used as guesses when some are unresolved */
  BASIN_WORTH_WAITING = 384   /* states that fill blocks well enough to be finished together */
};

/* ---- shares of uncertain states, and their exponent ---- */

enum {
  PENDRES_SCATTER_LEAST_SCALES = 3, /* an exponent needs this many shares */
  PENDRES_SCATTER_MOST_SCALES = 5,  /* and takes no more */
  SCATTER_LEAST_COUNT = 25, /* a share is fitted if it comes from this many uncertain states */
  SCATTER_LEAST_GROUPS = 4,
  SAMPLE_LEAST = 16,
  SAMPLE_FIRST = 256, /* states that tell what more of them cost, and whether they are of use */
  SAMPLE_AT_A_TIME = 4096,
  SAMPLE_TOGETHER = 256, /* on one thread, with their neighbours: these fill several blocks */
  SAMPLE_STATES = 16384     /* at random, unless callers choose */
};

/* Where the share of uncertain states is above this, the distance is no longer small against that
   between neighbouring boundaries, and the share grows less than a power of it. */
static const double scatter_most_uncertain = 0.5;

/*
 * Evaluations of the pendulum's equation that all states together may take: some ten seconds of
 * one processor, but the same number on every machine. Where chaos lasts long before it ends, a
 * state takes thousands of periods, and is integrated again and again with ever smaller errors;
 * elsewhere a third of this is enough.
 */
static const double sample_most_slopes = 4e9;

/* Distances of random states, the smallest and the ratio of one to the next. Labels are made
   certain down to rounding, whatever the tolerance is. This is far above it, and a thousandth of
   the distances of a fine grid. Where half of the states are uncertain even there, states are drawn
   that are nearer to each other by the last number, as long as rounding is far below. */
static const double sample_nearest = 1e-5, sample_ratio = 6.0, sample_nearer = 0.01;

/* ---- boundaries ---- */

/* The least error of a point in (x, v), or of a seed: rounding near the saddle, which is not
   amplified on the way back in time. Closer than a thousand of it the order of seeds along the
   curve is not known. */
static const double boundary_rounding = 1e-12, boundary_closest = 1e-9;

/* The distance from the saddle at which the manifold begins. Its expansion to second order is exact
   to the cube of this, an error that maps shrink further; a seed parameter is exact to rounding
   over this. */
static const double boundary_start = 2e-4;

enum { BOUNDARY_FIRST_NODES = 5, BOUNDARY_GENERATIONS = 400 };

/* Nodes whose errors a thread finds at a time: some blocks, so that few are narrow. */
enum { BOUNDARY_TOGETHER = 2048 };

#endif
