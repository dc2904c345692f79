/*
 * numbers.h -- numbers that were chosen and that several folders share, each with its reason. Those
 * of one folder are in its own numbers.h.
 */
#ifndef PENDRES_NUMBERS_H
#define PENDRES_NUMBERS_H

#include <limits.h>

/* ---- bounds of what is computed ---- */

enum {
  /* Steps per drive period, chosen or asked for: what needs more is refused, with a remedy. */
  PENDRES_MOST_STEPS = 1000000,
  /* Steps, of all lanes together, between two checks whether to go on: they take some hundredths of
     a second. */
  PENDRES_STEPS_BETWEEN_CHECKS = 300000,
  /* Steps that ARKODE or CVODE may take in one call: a bound that is never the reason to stop. */
  PENDRES_MOST_SOLVER_STEPS = 100000000,
  /* Lanes of doubles begin on the boundaries of cache lines, which the widest vectors need. */
  PENDRES_ALIGN = 64
};

/* A double beyond this does not hold a position to a tenth of a radian, and whole turns have to fit
   into a long, which has 32 bits on some machines. */
static const double pendres_farthest = LONG_MAX > 2147483647L ? 1e15 : 2147483647.0;

/* ---- when to give up ---- */

enum {
  /* How often something is tried with more steps, from another start, or nearer by: what has failed
     so often fails for a reason that one more trial does not remove. */
  TRIES = 4,
  /* Newton's method squares the error with each step. What is found at all takes some ten, of which
     the first few go across. */
  NEWTON_STEPS = 20,
  /* Halvings and the like, which end by themselves long before: a bound that is never the reason to
     stop. */
  ITERATIONS = 200
};

/* After a step of Newton's method below this the error is of the order of rounding. */
static const double newton_last_step = 1e-7;

/* ---- errors ---- */

/* The last place of a double of order one, rounded to two digits: bounds of rounding are whole
   multiples of it. */
static const double last_place_of_one = 2.2e-16;

/* A result is computed a second time with so many times the steps, from which its error is told: a
   method of order 8 is then better by a factor of 15, and twice the steps would cost half as much
   again. */
static const double finer_steps = 1.4, finer_steps_bent = 3.0; /* where |v| bends slopes */

/* Of the difference between these two a quarter is claimed as the error of the better one, since
   errors may not fall that fast yet. */
static const double claimed_share = 0.25;

/* What is off by more than three standard deviations is off by chance once in 400 times. Where it
   is compared with an error that was claimed, three stand for the same. */
static const double surely = 3.0;

/* An error that is claimed may be too small, though hardly ever by this factor: what lies further
   apart than so many errors is not the same. */
static const double pendres_several_errors = 10.0;

#endif
