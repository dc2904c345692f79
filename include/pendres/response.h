/*
 * response.h -- the mean response of an ensemble of pendulums to its drive.
 *
 * Owns: averages over the members of an ensemble, each on the attractor that it settles on and
 * shifted to its own well.
 *
 * mean_loop_area is the mean of the members' loop areas (paper, section II);
 * mean_loop_amplitude is the amplitude of the loop averaged over the members, mean_amplitude the
 * mean of the members' own amplitudes; the phase lag is that of the averaged loop. An orbit of
 * several drive periods counts with its mean cycle. What enters which mean:
 *
 *                area, power   amplitude   loop, phase lag
 *   closed       yes           yes         yes
 *   running      yes           no          no   (closes but for whole turns)
 *   chaotic      yes           yes         no   (has no well to be shifted to)
 *   chaotic with a drift: as running; unresolved: in none
 *
 * Of a chaotic member the means over time on its attractor count, a drive cycle: the work of the
 * drive (loop area, power), half peak to peak of the angle (amplitude); attractor.h has their
 * errors, which are statistical. Where no member enters a mean it is NaN, as in an ensemble that is
 * all chaotic the loop and its phase lag. Errors allow for the share of unresolved members, and of
 * those whose state is uncertain.
 */
#ifndef PENDRES_RESPONSE_H
#define PENDRES_RESPONSE_H

#include <pendres/attractor.h>
#include <pendres/sweep.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_RESPONSE_STATES = 8 /**< attractors of one parameter set that are listed */ };

/** An ensemble's response at one parameter set. */
typedef struct pendres_response {
  pendres_pendulum pendulum;
  double mean_loop_area, mean_loop_area_error;
  double mean_loop_amplitude, mean_loop_amplitude_error;
  double mean_amplitude, mean_amplitude_error;
  double phase_lag, phase_lag_error;
  double mean_power, mean_power_error;
  double sa_fraction, sa_fraction_error; /**< error: the share of members that are unresolved or
                                              uncertain; NaN where no attractor is SA or LA */
  double la_fraction, la_fraction_error;
  size_t unresolved;                     /**< members without an attractor; left out of means */
  size_t states;                         /**< attractors listed: those that most members are on */
  pendres_attractor state[PENDRES_RESPONSE_STATES];
  size_t state_members[PENDRES_RESPONSE_STATES];
  size_t uncertain;                      /**< members among them that may belong to another state
                                              (pendres_outcome.certain); means count them where they
                                              were found, errors allow for any other state */
  size_t unlisted;                       /**< members on attractors beyond those that are listed; in
                                              the means of pendres_response_compute like all
                                              others */
} pendres_response;

/**
 * The response of the same ensemble at each of n parameter sets; out[n] is written. Parameter
 * sets are worked on side by side, and do not influence each other's results.
 */
pendres_status pendres_response_compute(pendres_context *ctx, size_t n,
                                        const pendres_pendulum *pendulums,
                                        const pendres_ensemble *ensemble, pendres_response *out);

/**
 * The means of a response whose state[], state_members[], unresolved, uncertain and unlisted are
 * set; what is unlisted can only count as unresolved here.
 */
void pendres_response_average(pendres_response *r);

/**
 * Names for what is alone: of n responses of one damping and drive amplitude, at frequencies in any
 * order, those with a single orbit of one drive period and no name for it yet (see pendres_label)
 * are named SA or LA by the fold at which SA ends, if SA and LA coexist at any of the n; labels,
 * shares and their errors are brought up to date. Otherwise nothing changes.
 * Errors: PENDRES_INVALID_ARGUMENT, those of the integration.
 */
pendres_status pendres_response_name(pendres_context *ctx, size_t n, pendres_response *responses);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
