/*
 * numbers.h -- numbers that were chosen for orbits, each with its reason. Lengths are in canonical
 * units, in which those of a motion are of order one.
 */
#ifndef PENDRES_ORBITS_NUMBERS_H
#define PENDRES_ORBITS_NUMBERS_H

#include "base/numbers.h"

/* ---- when two are the same ---- */

/* Poincaré points of one orbit agree to this and pendres_several_errors, and so do the harmonics of
   mirror images (orbit_same.h). So may the points of an orbit that has just doubled its period, but
   there the shorter one is not stable; stable orbits that differ are that close at most next to a
   bifurcation. */
static const double orbit_same_point = 1e-6;

/* Newton's method has come to one orbit from two guesses where it stops as close as this: within
   what its last steps leave, and far within what tells orbits apart. */
static const double orbit_repeated = 1e-8;

/* Harmonics below this are none. */
static const double orbit_no_harmonic = 1e-7;

/* The amplitudes of a state at adjacent parameters differ by less than this, and an orbit further
   from where it was looked for is another one. */
static const double orbit_another = 0.02;

/* ---- Newton's method ---- */

/* Far beyond what is found. */
enum { ORBIT_LONGEST_PERIOD = 1000000, ORBIT_MOST_TURNS = 1000000000 };

/* A step longer than this is cut to this length, so that it does not leave the guess's well. A
   linear force has one orbit alone, which the first step leads to however far it is. */
static const double newton_longest_step = 0.6;

/* Close to a fold rounding keeps steps from shrinking any further: after so many steps, one below
   this that is not half of the one before is the last. */
static const double newton_stalled = 1e-5;
enum { NEWTON_STALLED = 8 };

/* The neighbours of a candidate, from which second derivatives are found, start at this distance in
   y and in w. */
static const double newton_aside = 1e-6;

/* Candidates are divided among threads where they take more steps than this, some milliseconds: to
   start a thread takes a tenth of one. */
static const double newton_worth_threads = 1e5;

/* det (I - M) at an orbit is the same after one more step, and with more steps, up to this factor;
   at the ghost of an orbit it falls to less than half, or past zero. */
static const double newton_there = 1.4;

/* ---- errors of orbits ---- */

/* Rounding of a step that carries errors, of that of arbitrary trajectories (strobe_noise.h), and
   that of derivatives of the map in the former, as measured. It is larger since sums have more
   terms and twice as many roundings. */
static const double newton_rounding = 0.27, newton_matrix = 9.0;

/* The sum of the moduli of a table's weights at which rounding of a step was measured. */
static const double step_usual_weights = 7.2;

/* Where a linear step leaves terms of second order: these, and half as much again, since terms of
   third order follow. */
static const double orbit_left_over = 1.5;

/* What an eighth of the difference of the whole orbits could make is claimed with a value's own
   difference; and of the matrix a fifth of the length over which it changes. */
static const double orbit_whole_share = 0.12, orbit_beside_share = 0.2;

/* Derivatives of a map are of second order where |v| bends: errors of traces, as they are
   claimed of smooth maps, were too small by up to 2.4 at sixty random orbits. */
static const double orbit_bent_trace = 4.0;

/* Along an unstable orbit the derivative by the frequency from a fixed start and that by the start
   grow, and cancel. Their rounding counts where less than this share of them is left. */
static const double orbit_cancels = 0.1;

/* At rest each step rounds the same pattern: it may be the worst one, four times the mean. */
static const double orbit_worst_rounding = 4.0;

/* A mean so near to the top is at the top, and belongs to the well on one side of it. */
static const double orbit_tie = 0.01;

/* Strobes at which runs of long trajectories are compared, at most, at a time. */
enum { STROBE_MOST_COMPARED = 64 };

/* ---- names ---- */

/* Up to this drive an orbit that is alone has a name by its phase lag: the drives of the paper, 0.1
   and 0.2, and somewhat beyond. */
static const double label_strongest_by_lag = 0.25;

/* ---- wells, and free oscillations in them ---- */

enum {
  /* The range in which wells are searched for, in units of length of a force. */
  WELL_FAR = 8,
  WELL_ROLLS = 1000, /* steps downhill after which no well is expected any more */
  /* Parts of the way to free_near in which a well's rim is looked for, and beyond a part's share of
     the distance: a rim that is stepped over is a hill over so short a way that it stops next to no
     amplitude, whatever the largest one is that is asked for. */
  FREE_FINENESS = 256,
  /* Points for an oscillation's period: as few as a harmonic one needs, and as many as one needs
     that comes within rounding of the separatrix, where they grow as one over the root of the
     distance; and the points of a mean force, which is of a smooth function. */
  FREE_FEWEST = 16,
  FREE_MOST = 8192,
  FREE_ORDER = 128,
  /* Operations of a period beside those of the force, each with a rounding. */
  FREE_ROUNDINGS = 8
};

/* Steps downhill are this long at most, and the last one is rounding. */
static const double well_longest = 0.1, well_last_step = 1e-12;

/* So close to a place the force is linear to a few millionths. */
static const double well_near = 1e-3;

/* So far from a well its rims are looked for in equal parts, beyond in parts that grow. */
static const double free_near = 1.0;

#endif
