/*
 * numbers.h -- numbers that were chosen for phase diagrams, each with its reason.
 */
#ifndef PENDRES_PHASE_NUMBERS_H
#define PENDRES_PHASE_NUMBERS_H

enum {
  /* Points of a line at which detached orbits are looked for: a branch that is found at one of them
     is followed along all, and a line of a hundred points takes a few percent longer for it. */
  DETACHED_POINTS = 8,
  /* Amplitudes there at which free oscillations have the drive's frequency: a force has more of
     them only if its stiffness goes up and down again and again. */
  DETACHED_RESONANCES = 3,
  /* Guesses about each, equally far apart in phase. With half as many Newton's method still came to
     all that 48 members had missed, at 35 of 600 random points. */
  DETACHED_PHASES = 16
};

/* Amplitudes at which the stiffness is compared, each by this factor larger: between two of them it
   is nearly a straight line. */
static const double detached_pace = 1.15;

#endif
