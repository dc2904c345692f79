/*
 * accuracy.h -- the tolerances of the parts of a computation, such that the result meets the
 * caller's tolerance: every tolerance that follows from the context's is derived here, by name.
 *
 * Owns: the factors between them, and the reasons for these.
 */
#ifndef PENDRES_ACCURACY_H
#define PENDRES_ACCURACY_H

#include <pendres/context.h>

/* The tolerance that 0 stands for in options, and the smallest and the largest that can be
   requested: lengths in canonical units (engine/door.h). */
#define PENDRES_ACCURACY_DEFAULT 1e-8
#define PENDRES_ACCURACY_TIGHTEST 1e-13
#define PENDRES_ACCURACY_LOOSEST 1e-2

/* ---- errors per drive period, from which its steps are chosen (steps.h) ---- */

/* For what is repeated with more steps until its own error estimate meets the tolerance: orbits,
   branches, bifurcations, boundaries. The probes by which steps are chosen are harder than orbits
   are, so the first run may be less exact. */
double pendres_accuracy_first(const pendres_context *ctx);

/* For a run over many periods, in which the errors of `that_count` periods add up. */
double pendres_accuracy_of_run(const pendres_context *ctx, double that_count);

/* For pendulums on their way to an attractor. An error as large as the tolerance moves a basin's
   boundary by about as much, and with a loose tolerance most labels would be uncertain. Ten times
   this value saves a tenth of a phase diagram's time, a hundred times a sixth. But then a pendulum
   whose parameter is a millionth away from a fold misses the orbit that it should settle on, and
   one that comes close to the upright state is taken for chaotic, which more exact runs do not
   always correct. */
double pendres_accuracy_to_settle(const pendres_context *ctx);

/* The same for their first few periods, in which none of this happens (settle.c). */
double pendres_accuracy_to_settle_soon(void);

/* The same for a picture of basins whose neighbouring states are `spacing` apart. An error of a
   boundary of a thousandth of this distance cannot be seen in a picture; but a tolerance below the
   default is kept, since it was requested. */
double pendres_accuracy_to_picture(const pendres_context *ctx, double spacing);

/* The same for states drawn at random. Each label is made certain on its own, by runs as exact as
   it needs; the accuracy of the first run affects only the work. */
double pendres_accuracy_to_sample(void);

/* For trajectories that are averaged over long times, as for exponents: averages do not depend on
   the errors of single trajectories (chaos_replicas.c). */
double pendres_accuracy_to_average(const pendres_context *ctx);

/* For pendulums whose errors are large already, as in chaos, to see whether they stay there. Of
   4,539 that were not settled after 200 periods, in a map with damping 1/2, 425 came to orbits
   within 1536 more with an error of 1e-6 a period, 423 with this one, 414 with 1e-3. */
double pendres_accuracy_to_follow(const pendres_context *ctx);

/* For replicas in chaos, with tangents of fourth order in the same steps. Where any error of the
   exponent will do, steps may be so long that tangents still show its sign: at 1e-5 a period the
   error of these outgrows weak chaos, which then takes several times as long. */
double pendres_accuracy_in_chaos(const pendres_context *ctx);

/* For means over rotations that are not locked to the drive, which are averaged twice. */
double pendres_accuracy_of_means(const pendres_context *ctx);

/* For the first of both, which tells over how many periods. It needs 10 steps where the second one
   takes 24: of 4905 rotations of a junction it was off by 4e-8 turns a period, in the middle, and
   by 1.5e-7 in one of a hundred, of which a thirtieth is claimed. */
double pendres_accuracy_of_rough_means(const pendres_context *ctx);

/* For noisy trajectories, whose scatter hides errors far larger than rounding. */
double pendres_accuracy_with_noise(const pendres_context *ctx);

/* For arcs along branches: an arc's points are corrected again when it is complete. */
double pendres_accuracy_of_arcs(void);

/* ---- tolerances of methods that choose their own steps (strobe_run.h) ---- */

/* For the second and the third run, with which the first is compared: methods meet their tolerance
   only roughly, and runs with tolerances up to 1e-4 may all end in the same wrong basin. */
double pendres_accuracy_second(const pendres_context *ctx);
double pendres_accuracy_third(const pendres_context *ctx);

/* For a result that is itself the better one of two runs. */
double pendres_accuracy_far_better(const pendres_context *ctx);

/* ---- when to stop ---- */

/* The width of the interval at which the search for a jump ends: the distance from its middle and
   the rest of the error together stay below the tolerance. */
double pendres_accuracy_of_jump(const pendres_context *ctx);

/* What a contribution may add to a result's error without being considered: harmonics left out of a
   mean, the last step of a search. */
double pendres_accuracy_negligible(const pendres_context *ctx);

#endif
