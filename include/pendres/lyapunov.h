/**
 * @file lyapunov.h
 * @brief Largest Lyapunov exponents of many pendulums, each with its own parameters.
 *
 * Owns: the exponent of each pendulum's own motion, with its error. It is made for maps of a
 * million points: only the attractor that the start leads to is found, and that it traps the
 * pendulum is not checked; see attractor.h for that.
 *
 * Method. A pendulum runs until its strobe points repeat (Brent's cycle detection), and Newton's
 * method finds the orbit nearby. If the orbit is stable and the pendulum close to it, exponent,
 * period and winding are those of the orbit. Otherwise the pendulum carries two tangent vectors
 * (Benettin, Galgani and Strelcyn, Physical Review A 14 (1976) 2338), one with the integrator's
 * steps and one with steps twice as long, and one cosine a step (Takahashi and Imada, Journal of
 * the Physical Society of Japan 53 (1984) 3765): the mean over time is of fourth order.
 * Richardson's extrapolation removes the leading error, and its correction enters the error
 * estimate. Growth is averaged over batches of periods, whose scatter gives the statistical error.
 * The motion is chaotic if the exponent is above zero by five standard errors, and the batches show
 * no change in the course of time. If it is neither periodic nor chaotic, as close to a
 * bifurcation, it is followed for longer, now with a neighbour that is put back to a distance of
 * 1e-8 once a period. A neighbour costs twice as much, and needs no steps of its own. If this does
 * not decide either, the point is unresolved. Where rotations are possible the neighbour is used
 * from the start.
 *
 * A rotation that is not locked to the drive has the exponents 0 and -gamma, and its strobe points
 * lie on an invariant curve around the cylinder of states. The pendulum is called quasi-periodic on
 * three pieces of evidence: its strobe points do not repeat with any period up to 128; weighted
 * Birkhoff averages of its turns, and of the growth of a neighbour's distance, over all of its
 * periods and over the first, the middle and the last half of them agree to 1e-5 a period; and that
 * growth is 0 to 1e-5 a period. With weights exp(-1/(t(1 - t))) such averages converge faster than
 * any power of the number of periods (Das, Saiki, Sander and Yorke, Nonlinearity 30 (2017) 4111),
 * those of chaos no faster than its root. A lock to more than 128 periods in which neighbours
 * approach by less than 1e-5 a period is not distinguished from this. The error of the mean
 * velocity consists of the scatter of these averages, and of the errors of single periods times the
 * factor by which the motion amplifies them: the mean length of the tangent vector along the curve,
 * times the mean of its reciprocal. Close to the end of a lock a rotation stays near p/q for long,
 * and slips once in many periods; unless it has slipped three times it is unresolved. A neighbour's
 * distance grows during such a slip, so that where rotations are possible the motion is called
 * chaotic only after the distance has grown by e^30. There is at most one such curve, since the
 * area between two would be invariant, while the map shrinks every area; with a mirror symmetry it
 * is its own image and does not rotate. Rotations are therefore searched for under a torque and a
 * drive, or under both drives.
 *
 * Unless the caller says how long to follow a pendulum, no transient and no average takes more than
 * 5e7 steps; a point that needs more is unresolved, and so is chaos after a transient that was too
 * short to forget the start.
 *
 * Under a linear force all motions have the same multipliers, by Floquet's theory: those of the
 * pendulum's orbit, whether it is stable or not. Nothing is followed or averaged. Where one exceeds
 * 1 by more than its error the motion grows without bound, and is an ESCAPE with that exponent;
 * where it is some 1e14 or more the point is unresolved.
 *
 * Chaos that ends, or goes over into another, later than it is followed is not distinguished from
 * chaos that lasts. By default that is after 2264 drive periods. Growth is averaged over 512 of
 * them. For the last 1536 the state alone is followed: where it comes to an orbit, or its turns
 * or mean square velocities at the strobes differ
 * from those before by more than chance, the average is taken again. Of
 * some 200 random chaotic pendulums that were followed for 32,768 periods one in a hundred changed
 * later than that. A verdict that is certain says nothing of this.
 *
 * The error of the integration is carried along from the start (attractor.h). Where it has grown so
 * large that it may have decided where the pendulum went, it starts again, with errors of
 * rounding's size. Where that leaves a doubt, sixteen copies start next to it, as far off as errors
 * are at the tolerance. Do they all do the same, the verdict is certain; a fate that one copy in
 * five has is missed once in thirty times. Otherwise copies start as near as rounding, and as
 * exactly as can be. Where these still differ the verdict is not certain: its errors hold
 * the exponents and the rotations of all copies, but periods and windings are those of one among
 * several motions. In chaos errors grow in any case. There they decide nothing if the motion comes
 * back, to a tenth of a radian, to the last state in which they were small. With adaptive steps, or
 * steps that the caller has set, errors are not known, and no verdict is certain.
 */
#ifndef PENDRES_LYAPUNOV_H
#define PENDRES_LYAPUNOV_H

#include <pendres/attractor.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** How long to look. Zero in a field: its default. */
typedef struct pendres_lyapunov_options {
  long transient; /**< drive periods, at most, until an orbit is reached, and before averages are
                       taken; default 200, and more where damping is weak */
  long periods;   /**< drive periods of an average, rounded up to a multiple of 16; default 512,
                       after which chaos is followed for longer */
} pendres_lyapunov_options;

/** What a pendulum does in the long run. Plain data. */
typedef struct pendres_lyapunov {
  pendres_label label;   /**< PERIODIC, RUNNING, QUASI_PERIODIC, CHAOTIC, ESCAPE (as in
                              attractor.h; its numbers are NaN, but
                              for the exponent under a linear force) or UNRESOLVED; SA and LA are
                              not told apart */
  double exponent;       /**< largest Lyapunov exponent per unit time */
  double exponent_error; /**< of orbits their multiplier's, else one standard error; if unresolved,
                              the exponent is the mean so far; of quasi-periodic rotations, whose
                              exponent is 0, what was found instead */
  double rotation;       /**< mean whole turns a drive period */
  double rotation_error; /**< its error, likewise; of quasi-periodic rotations a bound */
  int period;            /**< q, drive periods until an orbit closes; 0 of others */
  int winding;           /**< p, whole turns in them; 0 of others */
  int certain;           /**< 1: no error of the integration could have led it elsewhere; 0 also if
                              unresolved */
} pendres_lyapunov;

/**
 * The exponents of n pendulums that start from x[n], v[n] at drive phase 0. All arrays are the
 * caller's; out[n] is written. Each result depends on its own pendulum and the tolerance alone. The
 * drive's amplitude may be 0, the damping must be above 0. An odd number of steps a period is made
 * even.
 *
 * options may be NULL. Errors: PENDRES_INVALID_ARGUMENT (the message names the pendulum),
 * PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED, those of the integration. PENDRES_OK also where some
 * are unresolved. Thread safety: as for the context.
 */
pendres_status pendres_lyapunov_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, const double *x,
                                     const double *v, const pendres_lyapunov_options *options,
                                     pendres_lyapunov *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
