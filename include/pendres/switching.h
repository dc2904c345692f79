/*
 * switching.h -- how often noise carries a pendulum from one attractor, or well, to another.
 *
 * Owns: counting transitions along noisy trajectories, their rates with confidence intervals,
 * and the activation energy from rates at several temperatures.
 *
 * Attractors come with trapping ellipses (attractor.h). A trajectory belongs to the attractor
 * and well whose ellipse it was in last; it has switched at the first strobe that sees it inside
 * the ellipse of another attractor, and has left its well at the first that sees it inside an
 * ellipse (of any attractor) in another well. What happens outside of all ellipses does not count:
 * an excursion that returns is no transition. A rate is the number of transitions divided by
 * the time that trajectories belonged to where they came from (core sets: Buchete and Hummer,
 * J. Phys. Chem. B 112 (2008) 6057; Schuette et al., J. Chem. Phys. 134 (2011) 204105).
 *
 * Ellipses are shrunken by the factor `core`. On the edge of a whole one, close to the basin's
 * boundary, noise would turn back many that have just come in; and rates would count them.
 *
 * For small temperatures rates follow exp(-E/T), E the activation energy (Kramers, Physica 7
 * (1940) 284; for driven systems Dykman and Krivoglaz, Sov. Phys. JETP 50 (1979) 30).
 */
#ifndef PENDRES_SWITCHING_H
#define PENDRES_SWITCHING_H

#include <pendres/attractor.h>
#include <pendres/langevin.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum {
  PENDRES_SWITCHING_STATES = 8,                       /**< attractors that are told apart */
  PENDRES_SWITCHING_WELL = PENDRES_SWITCHING_STATES   /**< as a destination: any other well */
};

/**
 * The attractor whose ellipse, shrunken to `core` of its size (0: the default, a half), holds the
 * state x, v at drive phase 0, and the well it is in (0 for running ones). Both -1 and 0: none.
 */
void pendres_switching_locate(const pendres_attractors *set, double core, double x, double v,
                              int *attractor, long *well);

/** What to follow. */
typedef struct pendres_switching_request {
  pendres_pendulum pendulum;     /**< that of the set, with a temperature */
  const pendres_attractors *set; /**< of one parameter set; not owned */
  size_t from;                   /**< all start on this attractor, in well 0 */
  double core;                   /**< from 0 to 1; 0: a half */
  size_t trajectories;
  long periods;                  /**< of each */
  int steps_per_period;          /**< steps a drive period, as in pendres_langevin_run */
  uint64_t first_id;             /**< trajectory i has id first_id + i */
} pendres_switching_request;

/**
 * Transitions counted. Plain data: all zero is an empty one. [s] is the attractor that a
 * trajectory belonged to; [t] the one it went to (t = s: the same in another well), or
 * PENDRES_SWITCHING_WELL for all that ended in another well.
 */
typedef struct pendres_switching_tally {
  size_t states;         /**< attractors in the set */
  double period;         /**< drive period */
  double trajectories;
  double exposure[PENDRES_SWITCHING_STATES]; /**< pendulum-periods */
  double events[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1];
  /* Sums over trajectories, for the scatter between them: of the events' square, of events times
   * exposure, of the exposure's square. */
  double events2[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1];
  double mixed[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1];
  double exposure2[PENDRES_SWITCHING_STATES];
} pendres_switching_tally;

/**
 * Follow the request's trajectories through all their periods, and count.
 * *tally is overwritten. Errors: as pendres_langevin_advance; PENDRES_INVALID_ARGUMENT if the set
 * is not the pendulum's, or has more than PENDRES_SWITCHING_STATES attractors.
 */
pendres_status pendres_switching_count(pendres_context *ctx,
                                       const pendres_switching_request *request,
                                       pendres_switching_tally *tally);

/** Add a tally of other trajectories of the same pendulum. All numbers are whole: the order of
 *  adding does not matter to the last bit. */
void pendres_switching_add(pendres_switching_tally *into, const pendres_switching_tally *other);

/** A rate, a unit time. */
typedef struct pendres_switching_rate {
  double events;
  double exposure;     /**< unit times */
  double value;        /**< events / exposure; NaN without exposure */
  double error;        /**< standard error; without events the upper bound at one sigma */
  double lower, upper; /**< confidence interval */
  double dispersion;   /**< variance of the trajectories' counts by that of independent events:
                            1 for those. Larger: transitions come in bursts, and error and
                            interval allow for it. NaN where there are too few to tell */
} pendres_switching_rate;

/**
 * The rate from s to t, and its confidence interval of the given level (0 < level < 1): that of
 * pendres_langevin_rate, with events and exposure divided by the dispersion where it exceeds 1.
 */
pendres_status pendres_switching_rate_of(const pendres_switching_tally *tally, size_t s, size_t t,
                                         double level, pendres_switching_rate *rate);

/**
 * ln rate = ln prefactor - energy / T, where the prefactor may depend on the temperature. Errors
 * are standard errors, as the rates' are.
 */
typedef struct pendres_switching_activation {
  size_t points;           /**< temperatures with enough events */
  double energy, energy_error;
  double log_prefactor, log_prefactor_error; /**< ln of the prefactor at `temperature` */
  double chi2;             /**< of points - 2 degrees of freedom; errors are enlarged by
                                sqrt(chi2 / (points - 2)) where that exceeds 1 */
  double temperature;      /**< geometric mean of the temperatures with enough events */
  double exponent, exponent_error; /**< power of the temperature in the prefactor; with few points,
                                or close ones, it stays the 0 +- 1/2 that is assumed beforehand */
  double least_barrier;    /**< energy / T at the hottest of these temperatures: below two or so
                                there is no barrier to speak of, and no activation energy */
} pendres_switching_activation;

/**
 * Activation energy from rates at n temperatures: a least-squares fit of
 *
 *     ln rate = ln prefactor - energy / T + b ln(T / T0) + c1 (T/E) + c2 (T/E)^2
 *
 * weighted by the rates' relative errors, T0 the temperatures' geometric mean, E the energy of the
 * straight line. What a prefactor does with T is unknown beforehand, but not how much: theories
 * have powers b from -1 to 1 (Kramers for weak friction -1, for strong 0; driven systems +-1/2),
 * and corrections of order T/E. So b counts as known to be 0 +- 1/2, and c1, c2 as 0 +- 1;
 * rates that span a wide range of temperatures know better and correct it, others leave that
 * in the energy's error, of about T/2. A straight line's scatter alone says nothing on it.
 *
 * Temperatures with fewer than `fewest` events (0: the default, 10) are left out.
 *
 * PENDRES_INVALID_ARGUMENT: a temperature that counts is not positive and finite, or its rate or
 * error is not. PENDRES_NOT_FOUND if fewer than two different temperatures are left: too few
 * events. All but points is NaN then.
 */
pendres_status pendres_switching_fit(size_t n, const double *temperature,
                                     const pendres_switching_rate *rates, double fewest,
                                     pendres_switching_activation *out);

/** Who is at home where, for pendres_langevin_request. */
typedef struct pendres_switching_home {
  const pendres_attractors *set; /**< not owned */
  size_t attractor;
  double core; /**< as above */
} pendres_switching_home;

/** For `leave` of pendres_langevin_request, whose `arg` is a pendres_switching_home: marks
 *  trajectories that have switched from the attractor in well 0, or left that well. */
void pendres_switching_leave(void *home, const pendres_langevin_strobe *strobe,
                             unsigned char *left);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
