/**
 * @file lyapunov.h
 * @brief Largest Lyapunov exponents of many pendulums, each with its own parameters.
 *
 * Owns: what the exponent of each pendulum's own motion is, and how well it is known. For maps of
 * a million points: of all attractors of a parameter set only the one that the start leads to is
 * looked for, and nothing is shown to be trapped; see attractor.h for that.
 *
 * Method. A pendulum runs until its strobe points come back (Brent's cycle detection); the orbit
 * nearby is found by Newton's method. If it is stable and the pendulum is next to it, exponent,
 * period and winding are the orbit's, exact but for its error. What does not come back carries
 * two tangent vectors along (Benettin, Galgani and Strelcyn, Physical Review A 14 (1976) 2338),
 * by the integrator's steps and by steps twice as long, one cosine a step (Takahashi and Imada,
 * Journal of the Physical Society of Japan 53 (1984) 3765): fourth order in the mean over time.
 * Richardson's extrapolation takes off what follows from both, which enters the error. Growth is
 * averaged over batches of periods, whose scatter gives the error. It is chaotic if the exponent
 * is above zero by five standard errors and does not change on the way, as far as the batches
 * tell. What is neither, as next to a bifurcation, is followed for longer, now beside a neighbour
 * that is put back to a distance of 1e-8 once a period, which costs twice as much and has no
 * steps of its own; and it is at last unresolved. Where rotations may be, such a neighbour is
 * there from the first.
 *
 * A rotation that is not locked to the drive has the exponents 0 and -gamma, and closes an
 * invariant curve around the cylinder of states. The pendulum is called quasi-periodic on three
 * pieces of evidence: its strobe points do not come back to an orbit of up to 128 periods;
 * weighted Birkhoff averages of its turns, and of the growth of a neighbour's distance, over all
 * of its periods and over the first, the middle and the last half of them agree to 1e-5 a
 * period; and that growth is 0 to 1e-5 a period. With weights exp(-1/(t(1 - t))) such averages
 * converge faster than any power of the number of periods (Das, Saiki, Sander and Yorke,
 * Nonlinearity 30 (2017) 4111), those of chaos no faster than its root. What this does not tell
 * apart is a lock to more than 128 periods that draws neighbours together by less than 1e-5 a
 * period. The mean velocity's error is what these averages differ by, and the errors of single
 * periods, times what the invariant curve makes of them: the mean length of the tangent vector
 * along it, times that of the vector's reciprocal. Close to where a lock has ended a rotation is
 * p/q for long, and slips once in many periods: unless it has slipped three times it is
 * unresolved. Meanwhile a neighbour's distance grows: where rotations may be, chaos is called so
 * once it has grown by e^30. There is one such curve at most, since the area between two would
 * be invariant and has to shrink; with a mirror symmetry it is its own image and does not
 * rotate. So rotations are looked for under a torque and a drive, or under both drives.
 *
 * Unless the caller says how long to look, no transient and no average takes more than 5e7 steps:
 * what would is unresolved.
 *
 * Chaos that lasts for longer than it is watched, and then ends, is not told from chaos that lasts.
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
  long periods;   /**< drive periods of an average, rounded up to a multiple of 16; default 512 */
} pendres_lyapunov_options;

/** What a pendulum does in the long run. Plain data. */
typedef struct pendres_lyapunov {
  pendres_label label;   /**< PERIODIC, RUNNING, QUASI_PERIODIC, CHAOTIC, ESCAPE (as in
                              attractor.h; all its numbers are NaN) or UNRESOLVED; SA and LA are
                              not told apart */
  double exponent;       /**< largest Lyapunov exponent a unit time */
  double exponent_error; /**< of orbits their multiplier's, else one standard error; if unresolved,
                              the exponent is the mean so far; of quasi-periodic rotations, whose
                              exponent is 0, what was found instead */
  double rotation;       /**< mean whole turns a drive period */
  double rotation_error; /**< its error, likewise; of quasi-periodic rotations a bound */
  int period;            /**< q, drive periods until an orbit closes; 0 of others */
  int winding;           /**< p, whole turns in them; 0 of others */
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
