/*
 * accuracy.h -- how exact the parts of a computation are to be, so that the whole of it is as exact
 * as its caller asks: every tolerance that follows from the context's is made here, by name.
 *
 * Owns: the factors between them, and the reasons.
 */
#ifndef PENDRES_ACCURACY_H
#define PENDRES_ACCURACY_H

#include <pendres/context.h>

/* The tolerance that 0 stands for in options, and the smallest and the largest that can be asked
   for: lengths in canonical units (engine/door.h). */
#define PENDRES_ACCURACY_DEFAULT 1e-8
#define PENDRES_ACCURACY_TIGHTEST 1e-13
#define PENDRES_ACCURACY_LOOSEST 1e-2

/* ---- errors of a drive period, which choose its steps (steps.h) ---- */

/* Of what is computed again with more steps until its own estimate of the error meets the
   tolerance: orbits, branches, bifurcations, boundaries. The probes that choose steps are harder
   than orbits are, so the first run may be looser. */
double pendres_accuracy_first(const pendres_context *ctx);

/* Of a run over many periods, `that_count` of whose errors add up. */
double pendres_accuracy_of_run(const pendres_context *ctx, double that_count);

/* Of pendulums on their way to an attractor. An error as large as the tolerance moves a basin's
   boundary by about as much, and with a loose tolerance most labels would be in doubt. Ten times
   this saves a tenth of a phase diagram's time, a hundred times a sixth; but then a pendulum a
   millionth from a fold passes the orbit that it should settle on, and one that passes the upright
   state is taken for chaotic, which more exact runs do not always mend. */
double pendres_accuracy_to_settle(const pendres_context *ctx);

/* The same for a picture of basins whose nearest states are so far apart. A picture does not show
   that a boundary is off by a thousandth of this distance; but a tolerance below the default is
   kept, since it was asked for. */
double pendres_accuracy_to_picture(const pendres_context *ctx, double spacing);

/* The same for states drawn at random. Each label is made certain by itself, by runs as exact as it
   needs: that of the first one decides about the work alone. */
double pendres_accuracy_to_sample(void);

/* Of trajectories that are averaged over long times, as for exponents: they forget their errors
   (chaos_replicas.c). */
double pendres_accuracy_to_average(const pendres_context *ctx);

/* Of the map on an invariant circle, which is interpolated: averages of it are as exact. */
double pendres_accuracy_of_circles(const pendres_context *ctx);

/* Of noisy trajectories, whose scatter hides errors far larger than rounding. */
double pendres_accuracy_with_noise(const pendres_context *ctx);

/* Of arcs along branches: an arc's points are corrected anew when it is over. */
double pendres_accuracy_of_arcs(void);

/* ---- tolerances of methods that choose their own steps (strobe_run.h) ---- */

/* Of the second run and the third, by which the first is judged: methods follow their tolerance
   loosely, and runs with tolerances up to 1e-4 may all end in the same wrong basin. */
double pendres_accuracy_second(const pendres_context *ctx);
double pendres_accuracy_third(const pendres_context *ctx);

/* Of a result that is itself the better one of two runs. */
double pendres_accuracy_far_better(const pendres_context *ctx);

/* ---- how far to go on ---- */

/* The width of an interval in which a jump is left: its middle and the rest of the error have room
   below the tolerance. */
double pendres_accuracy_of_jump(const pendres_context *ctx);

/* What a part may add to a result's error without being looked at: harmonics left out of a mean,
   the last step of a search. */
double pendres_accuracy_negligible(const pendres_context *ctx);

#endif
