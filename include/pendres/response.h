/**
 * @file response.h
 * @brief The mean response of an ensemble of pendulums to its drive, without noise and with it.
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
 *   chaotic with a drift, and rotations that do not close: as running; unresolved: in none
 *
 * A chaotic member contributes time averages over its attractor, per drive cycle: the work of the
 * drive (loop area, power) and half the peak to peak of the angle (amplitude); their errors, which
 * are statistical, are described in attractor.h. One on a rotation that does not close contributes
 * the mean work. A mean that no member enters is NaN, such as the
 * loop and its phase lag in an ensemble of which all members are chaotic. Errors allow for the
 * share of unresolved members, for members whose state is uncertain, and for the sampling of an
 * area of starts.
 *
 * With thermal noise every member starts on the attractor that it settles on without noise, and is
 * then followed wherever noise takes it. Trajectories therefore start on the attractors in the
 * proportions of the members, and means over them are weighted with the members' shares.
 *
 * Thread safety: that of the context (context.h).
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

/** An ensemble's response at one parameter set. Every error belongs to the number before it. */
typedef struct pendres_response {
  pendres_pendulum pendulum;        /**< the parameters, without noise */
  double mean_loop_area;            /**< mean of the members' A = closed integral of F dx a drive
                                         cycle, in m g l */
  double mean_loop_area_error;      /**< its error */
  double mean_loop_amplitude;       /**< half peak to peak of the loop averaged over the members,
                                         in rad */
  double mean_loop_amplitude_error; /**< its error */
  double mean_amplitude;            /**< mean of the members' half peak to peak, in rad */
  double mean_amplitude_error;      /**< its error */
  double phase_lag;                 /**< phi of the averaged loop's first harmonic,
                                         y ~ cos(theta - phi), in rad */
  double phase_lag_error;           /**< its error */
  double mean_power;                /**< P = A omega / (2 pi), in m g l omega_0 */
  double mean_power_error;          /**< its error */
  double sa_fraction;               /**< share of the members on SA; NaN where no attractor is SA
                                         or LA */
  double sa_fraction_error;         /**< share of members that are unresolved or uncertain */
  double la_fraction;               /**< share of the members on LA, likewise */
  double la_fraction_error;         /**< as sa_fraction_error */
  size_t unresolved;                /**< members that did not settle within their budget; left out
                                         of means, and part of their errors */
  size_t states;                    /**< attractors listed: those that most members are on */
  pendres_attractor state[PENDRES_RESPONSE_STATES]; /**< [states] the attractors listed */
  size_t state_members[PENDRES_RESPONSE_STATES];    /**< [states] how many members are on each */
  size_t uncertain;                 /**< members among them that may belong to another state
                                         (pendres_settled.certain); means count them where they
                                         were found, errors allow for any other state */
  size_t unlisted;                  /**< members on attractors beyond those that are listed; in
                                         the means of pendres_response_find like all others */
  double sampling;                  /**< of a rectangle or random starts: the share of members that
                                         another such ensemble may have on other states, two
                                         standard errors: of counts for random starts, from the
                                         scatter between rows for a rectangle. In all errors of
                                         shares and means; 0 for a line */
  size_t escaped;                   /**< members that are on their way to infinity: an answer,
                                         which means leave out, as shares of all members do not */
  size_t unstable;                  /**< members at rest in an unstable state, which they never
                                         leave; left out of means and shares, and not unresolved */
} pendres_response;

/**
 * The response of the same ensemble at each of n parameter sets; pendulums[n] is read, out[n] is
 * written. Parameter sets are worked on side by side, and do not influence each other's results.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, those of the integration.
 */
pendres_status pendres_response_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums,
                                     const pendres_ensemble *ensemble, pendres_response *out);

/**
 * The means of a response whose state[], state_members[], unresolved, escaped, uncertain and
 * unlisted are set; what is unlisted can only count as unresolved here. NULL is allowed.
 */
void pendres_response_average(pendres_response *r);

/**
 * Largest modulus of a Floquet multiplier of the closed orbits that a response lists: that of the
 * state on which members settle most slowly. NaN if there is none, or for NULL.
 */
double pendres_response_weakest_multiplier(const pendres_response *r);

/**
 * Names for what is alone: of n responses of one damping, and of one drive amplitude at
 * frequencies in any order or of one frequency at drive amplitudes in any order, those with a
 * single orbit of one drive period and no name for it yet (see pendres_label) are named SA or LA by
 * the fold at which SA ends, if SA and LA coexist at any of the n; labels, shares and their errors
 * are brought up to date. Otherwise nothing changes.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, those of the integration.
 */
pendres_status pendres_response_label(pendres_context *ctx, size_t n, pendres_response *responses);

/* ---- With thermal noise -------------------------------------------------------------------- */

/** A mean over noisy trajectories. */
typedef struct pendres_response_mean {
  double value;      /**< the mean */
  double error;      /**< its standard error */
  double bias;       /**< what finite steps add to it: too large is positive. Not subtracted */
  double bias_error; /**< standard error of the bias */
} pendres_response_mean;

/** An ensemble's response under thermal noise. Plain data; means of nothing are NaN. */
typedef struct pendres_response_noise {
  double temperature;             /**< T, in m g l */
  pendres_response_mean loop_area;  /**< mean loop area, in m g l */
  pendres_response_mean amplitude;  /**< length of the mean loop's first harmonic, in rad */
  pendres_response_mean phase_lag;  /**< its phase lag, 0 .. 2 pi */
  pendres_response_mean mean_power; /**< mean power taken up from the drive, in m g l omega_0 */
  int steps_per_period;           /**< the most steps a drive period of any state; 0 at T = 0 */
} pendres_response_noise;

/**
 * The response under thermal noise of an ensemble whose response without noise is known.
 *
 * About `trajectories` noisy trajectories, at least two from each attractor, are followed over
 * `periods` drive periods each, after a time in which their start is forgotten; the steps are so
 * many that the bias stays below 1e-4 of loop area and first harmonic where the temperature is low.
 * At temperature 0 the response without noise is handed on as it is. Members that are chaotic, on
 * rotations that do not close, unresolved or unlisted are left out. The seed is the context's; the
 * ids of trajectories follow from the parameters.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, those of the integration.
 */
pendres_status pendres_response_noise_find(pendres_context *ctx, const pendres_response *still,
                                           double temperature, size_t trajectories, long periods,
                                           pendres_response_noise *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
