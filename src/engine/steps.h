/*
 * steps.h -- how many fixed steps a drive period needs.
 *
 * Owns: the choice of steps from a tolerance by step doubling. The choice
 * depends on a pendulum's own parameters and speed and on the tolerance, never
 * on which other pendulums are computed with it: it is made for cells of a
 * fixed lattice in parameter space and remembered in the context.
 */
#ifndef PENDRES_STEPS_H
#define PENDRES_STEPS_H

#include <pendres/context.h>
#include <pendres/pendulum.h>
#include <pendres/status.h>

/* Steps a period are chosen from a ladder whose rungs are a factor of about 1.12 apart: the rung at
   or above n. */
int pendres_steps_rung(int n);

/* The rung at or above n of a ladder of half octaves: of a few pendulums that are computed together
   more share a block, which costs less than the steps that some take in vain. */
int pendres_steps_rung_of_few(int n);

/* The steps of the finer of two computations: 1.4 times as many, with which the errors of a method
   of order eight fall to a fifteenth, so that the difference of the two tells them. Where |v|
   leaves third order they fall so with three times as many, and by less or more by chance. */
int pendres_steps_finer(const pendres_pendulum *p, int n);

/*
 * How fast a pendulum in a state is or may soon become, by which steps are chosen: |v|; with a
 * polynomial force the speed whose kinetic energy would be the energy of the state if all terms of
 * the potential had the same sign.
 */
double pendres_steps_speed(const pendres_pendulum *p, double x, double v);

/* A speed from which to choose steps for a pendulum that may rotate: enough for what the drive can
   do, for the passage over a barrier, and for a torque that friction balances. */
double pendres_steps_turning_speed(const pendres_pendulum *p);

/*
 * Steps a period so that one period's error of a pendulum with such a speed up to `speed` stays
 * below `tolerance` (absolute, of y and w); probed by step doubling. The message of a failure says
 * what helps.
 */
pendres_status pendres_steps_choose(pendres_context *ctx, const pendres_pendulum *p, double speed,
                                    double tolerance, int *steps);

/* The steps that were chosen for cells of the lattice. */
typedef struct pendres_steps_memo pendres_steps_memo;

pendres_status pendres_steps_memo_create(pendres_steps_memo **out);
void pendres_steps_memo_free(pendres_steps_memo *memo);

#endif
