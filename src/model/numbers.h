/*
 * numbers.h -- numbers that were chosen for models, units, and rotations without a drive, each with
 * its reason.
 */
#ifndef PENDRES_MODEL_NUMBERS_H
#define PENDRES_MODEL_NUMBERS_H

#include "base/numbers.h"

enum {
  /* Points of Simpson's rule on each side, for a force that is not a sum of powers. */
  MODEL_SAMPLES = 64,
  /* Halvings of an octave in which the reach of a drive is found: the unit that is made of it is
     rounded to a power of two. */
  MODEL_HALVINGS = 4,
  /* Exponents of units are limited to this: products of a few of them stay far from overflow. */
  UNITS_FARTHEST = 120,
  /* A power that is smaller than another by this number of bits does not matter at the tolerances
     that are requested: it may be what rounding leaves of a coefficient that passes through 0. A
     drive's reach is looked for from as far below the force's own length. */
  UNITS_NEGLIGIBLE = 40
};

/* Roundings that the centre of a polynomial is allowed: of each term c brings up to four a power,
   of which there are five or fewer, and they mostly cancel; its coefficient was rounded from
   decimals, and each product and sum is. */
static const double model_roundings = 16.0;

/* Steps are chosen for motions within this share of the way to a pole: what comes closer escapes,
   or is found to need more steps. */
static const double model_inside = 0.75;

/* From here on a formula is asked whether it leads to infinity: far beyond what counts in units in
   which lengths are of order one. */
static const double formula_far = 1024.0;

/* ---- rotations without a drive, by series and by collocation ---- */

/* Dampings of which rotations are found. Beyond them the force is all, or the friction. */
static const double rotation_least_damping = 1e-9, rotation_most_damping = 100.0;

/* Series of a velocity below this converge in too short an interval to start with. */
static const double rotation_slow = 0.1;

/* From about the damping `strong` on, rotations at a torque close to 1 may be arbitrarily slow, and
   series take ever shorter steps. They need more of them than collocation does when
   1/sqrt(torque^2 - 1), which is the time of the slow passage up to a factor of the damping, is
   longer than `much`/damping. */
static const double rotation_strong = 1.0, rotation_much = 100.0;

/* A motion that comes to rest before the end makes ever shorter steps, or panels. */
static const double rotation_shortest = 1e-14;

/* What rounding adds to the velocity in a turn, and to its time, in units of the last place: a
   third more than the most that was seen in 1300 turns beside long doubles, the change of the time
   with the velocity apart. */
static const double rotation_rounded_velocity = 4.0, rotation_rounded_period = 10.0;

/* A rotation this share above the least torque, at which the change of the torque with the damping
   is that of the least one to seven digits or so, and rounding takes no more of them. */
static const double rotation_near_onset = 1e-8;

/* The error of a polynomial, relative to the velocity; its slope is less exact. */
static const double rotation_finest = 1e-15;

#endif
