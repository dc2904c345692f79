/*
 * numbers.h -- numbers that were chosen for noisy trajectories, each with its reason.
 */
#ifndef PENDRES_NOISE_NUMBERS_H
#define PENDRES_NOISE_NUMBERS_H

#include "base/numbers.h"

/* ---- trajectories and their steps ---- */

enum {
  PENDRES_NOISE_LANES = 192, /* trajectories together; more do not fit into the fastest memory */
  PENDRES_NOISE_RECORD = 60, /* strobes of each from which steps are chosen */
  NOISE_GROWTH = 64,         /* times as many trajectories, at most, to measure a bias */
  NOISE_TRIALS = 12          /* numbers of steps that are tried, of which each is nearer */
};

/* Bound on the bias by finite steps, relative to a cloud's widths and their products. */
static const double pendres_noise_bias = 0.01;

/* Relative to a cloud's width the bias is the same at all small temperatures, as up to this one. At
   high ones a coarse and a fine trajectory soon separate, and their difference says little about
   the steps. */
static const double pendres_noise_coldest = 1e-4;

/* The bias aimed at is so much below what is tolerated, and steps grow by such factors at a time:
   it is measured with an error, and goes down with the fourth power only in the end. */
static const double noise_aim = 0.7, noise_least_growth = 1.1, noise_most_growth = 4.0;

/* An angle beyond this, in the frame that is shaken, loses more than 1e-9 to rounding. */
static const double noise_farthest = 1e7;

/* The correction of a step, 1 - bend cos y, must stay positive; longer ones resolve no motion. */
static const double noise_longest_step = 3.0;

/* Where trajectories would take more periods than this to settle, linear theory chooses the steps:
   pairs of trajectories take minutes there. */
static const double noise_by_theory = 1000.0;

/* Derivatives are taken between points so far from each other, relative to the orbit's amplitude:
   curvature changes them by 1e-10 of what it is, and rounding by as much. */
static const double noise_apart = 1e-5;

/* A trajectory has settled when this is left of its start's influence; at least four periods. */
static const double noise_settled = 1e-5;

/* The periods that it gets at most, and those of a chaotic attractor or one that is about to
   vanish, of which the time is not known. */
static const double noise_longest_settling = 1e5, noise_unknown_settling = 1e4;

/* So far out a force is looked at, in its units of length, and is a spring if it is so to this
   share: a sine is less, and a higher power more. */
static const double noise_far_out = 1e9, noise_spring = 1e-6;

/* ---- statistics ---- */

/* Of confidence intervals, unless told. */
static const double pendres_noise_level = 0.95;

/* The logarithm of a rate from fewer events is far from Gaussian, and with fewer events or fewer
   trajectories nothing is known of their scatter. */
static const double pendres_noise_fewest = 10.0;

/* From so many events on an approximation replaces the exact interval: langevin.h tells its
   error. */
static const double noise_many_events = 500.0;

/* ---- linear theory ---- */

/* Steps a unit of time, of which a second computation has twice as many: an error near 1e-11 by
   order four, rounding well below. */
static const double linear_steps = 64.0;

/* They are doubled where the determinant misses what it must be by more than this, no more often
   than this leaves of them. */
static const double linear_resolved = 1e-6, linear_most_doubling = 4096.0;

/* ---- cores of attractors, and what leaves them ---- */

enum {
  CORES_RING = 48,  /* states on an ellipse's edge that are to settle inside */
  /* Ellipses that are tried, each half as large in area as the one before: a basin narrower than
     the last one, a thousandth of the first, is negligible. */
  CORES_TRIALS = 21
};

/* A core has this share of the width of the ellipse that is tested, which is at most this many
   standard deviations wide: a trajectory at its edge will hardly leave immediately. */
static const double cores_share = 0.5, cores_widest = 2.0;

/* How deep a basin is, is found in such steps of width: to a factor of 1.5 in energy. */
static const double cores_deeper = 1.22;

/* The first ellipse is at most as wide as a well or, where the force has no wells, as this multiple
   of its length. */
static const double cores_lengths = 100.0;

/* A trajectory counts as escaped where the force leads away and the potential is lower than its
   attractor's by this multiple of the temperature: one of exp(30) would return. */
static const double switching_no_return = 30.0;

/* The fraction of the missed share of transitions that is added to the error, for what is wrong
   with its first order: in double wells with barriers of 3 to 5 temperatures and dampings of 0.1 to
   2 it was a tenth. Of second order are half of the share's square at most, at 2 temperatures.
   Where half of the transitions are missed, this is not known, and all of the share is added. */
static const double switching_first_order = 0.125, switching_most_missed = 0.5;

/* A barrier below this multiple of the temperature is not an activation energy. */
static const double switching_least_barrier = 2.0;

#endif
