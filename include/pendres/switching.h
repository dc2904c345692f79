/**
 * @file switching.h
 * @brief How often noise carries a pendulum from one attractor, or well, to another.
 *
 * Owns: counting transitions along noisy trajectories, their rates with confidence intervals,
 * and the activation energy from rates at several temperatures. pendres_switching_find() does
 * all of it for two states; the functions after it do parts of that work, which a program may
 * divide among its threads, with the same results to the last bit.
 *
 * A trajectory belongs to the attractor, and well, whose core it was in last. It has switched at
 * the first strobe that sees it in the core of another attractor, and has left its well at the
 * first that sees it in a core (of any attractor) in another well. What happens outside of all
 * cores does not count: an excursion that returns is not a transition. A rate is the number of
 * transitions divided by the time that trajectories belonged to where they came from (core sets:
 * Buchete and Hummer, J. Phys. Chem. B 112 (2008) 6057; Schuette et al., J. Chem. Phys. 134 (2011)
 * 204105), and by the share that is seen (pendres_switching_rate_of).
 *
 * The core of an attractor is an ellipse around its strobe point, one standard deviation wide of
 * the cloud that linear noise theory has there (langevin.h). Where twice that is not within the
 * basin of attraction, which is checked by states on the edge that settle without noise, the core
 * is half as wide as the basin allows: a barrier is then less than two temperatures.
 *
 * Under a force that drives to infinity (pendres_pendulum_leaves) infinity counts as another well,
 * from which nothing returns. A trajectory has escaped at the first strobe that sees it moving
 * outwards where the force points outwards whatever the drive does, with a potential lower than its
 * attractor's by thirty temperatures. It is not followed further.
 *
 * For small temperatures rates follow exp(-E/T), E the activation energy (Kramers, Physica 7
 * (1940) 284; for driven systems Dykman and Krivoglaz, Sov. Phys. JETP 50 (1979) 30).
 *
 * Thread safety: that of the context (context.h); a set of attractors is only read.
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
  PENDRES_SWITCHING_STATES = 8,                       /**< most attractors that a tally can count */
  PENDRES_SWITCHING_WELL = PENDRES_SWITCHING_STATES   /**< as a destination: any other well,
                                                           or infinity */
};

/* ---- Counting transitions ------------------------------------------------------------------ */

/** Trajectories to follow. */
typedef struct pendres_switching_request {
  pendres_pendulum pendulum;     /**< that of the set, with a temperature */
  const pendres_attractors *set; /**< of one parameter set; not owned */
  size_t from;                   /**< number of the attractor that all start on, in well 0 */
  double core;                   /**< size of the cores, up to 2, relative to the one that follows
                                      from the noise; 0 stands for 1. If a result depends on it,
                                      it is not a rate */
  size_t trajectories;           /**< how many */
  long periods;                  /**< drive periods that each is followed over */
  int steps_per_period;          /**< steps a drive period, as in pendres_langevin_run */
  uint64_t first_id;             /**< trajectory i has id first_id + i */
} pendres_switching_request;

/**
 * Transitions counted. Plain data: all zero is an empty tally. [s] is the attractor that a
 * trajectory belonged to, [t] the one that it went to (t = s: the same one in another well);
 * [PENDRES_SWITCHING_WELL] counts all transitions that ended in another well. All numbers but the
 * period are whole.
 */
typedef struct pendres_switching_tally {
  size_t states;       /**< attractors in the set */
  double period;       /**< drive period 2 pi / omega, in units of 1/omega_0 */
  double trajectories; /**< how many were followed */
  double exposure[PENDRES_SWITCHING_STATES];  /**< drive periods that they belonged to [s] */
  double events[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1]; /**< transitions [s][t] */
  double events2[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1]; /**< sum over trajectories
                            of the square of each one's events [s][t] */
  double mixed[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1];   /**< sum over trajectories
                            of each one's events [s][t] times its exposure [s] */
  double exposure2[PENDRES_SWITCHING_STATES]; /**< sum over trajectories of the square of each one's
                                                   exposure [s] */
  double passage[PENDRES_SWITCHING_STATES][PENDRES_SWITCHING_STATES + 1]; /**< sum over transitions
                            [s][t] of the drive periods since the trajectory was in the core of s */
  double absence2[PENDRES_SWITCHING_STATES]; /**< sum over visits to the core of [s] of the square
                                                  of the drive periods since the one before it */
  double forward[PENDRES_SWITCHING_STATES];  /**< of the transitions [s][PENDRES_SWITCHING_WELL],
                                                  those to a well at larger x */
  double passed[PENDRES_SWITCHING_STATES];   /**< wells that these transitions went over without
                                                  being seen in a core there */
  double ends[PENDRES_SWITCHING_STATES]; /**< trajectories whose last strobe is in the basin of
                                              attraction of [s] */
} pendres_switching_tally;

/**
 * Follow the request's trajectories through all their periods, and count. *tally is overwritten.
 *
 * Errors: as pendres_langevin_advance; PENDRES_INVALID_ARGUMENT if the set is not the pendulum's,
 * or has more than PENDRES_SWITCHING_STATES attractors.
 */
pendres_status pendres_switching_count(pendres_context *ctx,
                                       const pendres_switching_request *request,
                                       pendres_switching_tally *tally);

/** Add to *into the tally of other trajectories of the same pendulum. Since the numbers are whole,
 *  the order in which tallies are added makes no difference. */
void pendres_switching_add(pendres_switching_tally *into, const pendres_switching_tally *other);

/** A rate of transitions, per unit time. */
typedef struct pendres_switching_rate {
  double events;     /**< transitions counted */
  double exposure;   /**< time spent where they start, in units of 1/omega_0 */
  double value;      /**< events / exposure, corrected for missed passages; NaN without exposure */
  double error;      /**< standard error, with missed_error; without events an upper bound at one
                          sigma */
  double lower;      /**< lower end of the confidence interval */
  double upper;      /**< upper end of the confidence interval */
  double dispersion; /**< variance of the trajectories' counts, divided by the variance that
                          independent events would have. Above 1 transitions come in bursts, which
                          error and interval allow for. NaN where there are too few */
  double mean_time;  /**< mean time until a transition, 1 / value; NaN without events */
  double mean_time_error; /**< its standard error, to first order in that of the rate */
  double missed;       /**< share of the transitions that were not seen, by which the value is
                            corrected: value = events / exposure / (1 - missed) */
  double missed_error; /**< what the rate's relative error has from this correction: statistics do
                            not make it smaller */
} pendres_switching_rate;

/**
 * The rate of transitions from s to t, with its confidence interval of the given level
 * (0 < level < 1). A trajectory that has come to t is counted when it is in the core there at a
 * strobe, some time after its transition, and may have left by then. Between two states events /
 * exposure is too low by this time times the rates of s to t and back, to first order, which is
 * corrected; in a row of wells how many were missed shows in how many wells were passed over, and
 * in how many go either way. The correction's own error, an eighth of it or half of its square,
 * stands in `missed_error`, with the scatter of wells passed over. Cores of
 * half and of twice their size then give the same rates, but for weak damping: twice the size
 * gives 4 to 11 % more there at 3 temperatures. The interval is the exact (Poisson) one,
 * for events and exposure that are divided by the dispersion where it exceeds 1, widened as the
 * error is.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_switching_rate_of(const pendres_switching_tally *tally, size_t s, size_t t,
                                         double level, pendres_switching_rate *rate);

/* ---- Activation energies ------------------------------------------------------------------- */

/** The outcome of a fit of an activation energy. */
typedef enum pendres_switching_verdict {
  PENDRES_SWITCHING_STRAIGHT = 0, /**< rates follow the law within their errors */
  PENDRES_SWITCHING_BENT,         /**< they scatter by more: chi squared is more than three of its
                                       standard deviations above its mean */
  PENDRES_SWITCHING_UNCHECKED,    /**< two temperatures: nothing checks the law */
  PENDRES_SWITCHING_TOO_FEW,      /**< too few events: there is no fit */
  PENDRES_SWITCHING_NO_STATE,     /**< there is no such state: there is no fit */
  PENDRES_SWITCHING_NO_BARRIER,   /**< the energy of this way, or between two states of the way
                                       back, is less than twice the highest temperature: the
                                       barrier is negligible, and there is no activation energy */
  PENDRES_SWITCHING_UNBALANCED,   /**< at some temperature the rates do not imply where trajectories
                                       end: see pendres_switching_rates */
  PENDRES_SWITCHING_VERDICTS      /**< how many there are */
} pendres_switching_verdict;

/**
 * The law ln rate = ln prefactor - energy / T, where the prefactor may depend on the temperature.
 * Errors are standard errors, as the rates' are.
 */
typedef struct pendres_switching_activation {
  size_t points;              /**< temperatures with enough events */
  double energy;              /**< E, in units of m g l */
  double energy_error;        /**< its error */
  double log_prefactor;       /**< ln of the prefactor (a rate in units of omega_0) at T0 */
  double log_prefactor_error; /**< its error */
  double chi2;                /**< chi squared of points - 2 degrees of freedom; errors are enlarged
                                   by sqrt(chi2 / (points - 2)) where that exceeds 1 */
  double temperature;         /**< T0: geometric mean of the temperatures with enough events */
  double exponent;            /**< b: power of the temperature in the prefactor */
  double exponent_error;      /**< its error; with few or close temperatures the exponent stays
                                   0 +- 1/2, as assumed beforehand */
  double least_barrier;       /**< energy / T at the highest of these temperatures */
  pendres_switching_verdict verdict; /**< the outcome of the fit */
} pendres_switching_activation;

/**
 * Activation energy from rates at n temperatures: a least-squares fit of
 *
 *     ln rate = ln prefactor - energy / T + b ln(T / T0) + c1 (T/E) + c2 (T/E)^2
 *
 * weighted by the rates' relative errors, where T0 is the temperatures' geometric mean and E the
 * energy of the straight-line fit. How the prefactor depends on T is not known beforehand, but
 * theories bound it: their powers b go from -1 to 1 (Kramers has -1 for weak friction and 0 for
 * strong, driven systems have +-1/2), and corrections are of order T/E. The fit therefore starts
 * from b = 0 +- 1/2 and c1 = c2 = 0 +- 1. Rates over a wide range of temperatures improve on that;
 * over a narrow one it remains as an error of the energy of about T/2, which the scatter about a
 * straight line would not show.
 *
 * Temperatures with fewer than `fewest` events (0: the default, 10) are left out.
 *
 * Errors: PENDRES_INVALID_ARGUMENT if a temperature that counts is not positive and finite, or its
 * rate or error is not; PENDRES_NOT_FOUND if too few events leave fewer than two different
 * temperatures (then all but points and verdict is NaN); PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_switching_fit(size_t n, const double *temperature,
                                     const pendres_switching_rate *rates, double fewest,
                                     pendres_switching_activation *out);

/* ---- Both ways at several temperatures ----------------------------------------------------- */

/** Ways of switching that a survey of two states counts. */
typedef enum pendres_switching_way {
  PENDRES_SWITCHING_FORTH = 0,   /**< from the first state to the second */
  PENDRES_SWITCHING_BACK,        /**< from the second state to the first */
  PENDRES_SWITCHING_FIRST_WELL,  /**< from the first state to any state in another well, or to
                                      infinity under a force that drives there */
  PENDRES_SWITCHING_SECOND_WELL, /**< from the second state, likewise */
  PENDRES_SWITCHING_WAYS         /**< how many there are */
} pendres_switching_way;

/** Two states to survey. */
typedef struct pendres_switching_survey {
  const pendres_attractors *set; /**< attractors of one parameter set; not owned */
  int state[2];         /**< numbers of the two states in the set; -1: there is no such state */
  size_t trajectories;  /**< at each temperature; half of them start on either state */
  long periods;         /**< drive periods that each is followed over */
  int steps_per_period; /**< steps a drive period, from 2 to 1000000; 0: as many as
                             pendres_switching_choose_steps finds for both states */
  double level;         /**< of confidence intervals, between 0 and 1; 0: 0.95 */
} pendres_switching_survey;

/** The numbers of the first small- and large-amplitude states in a set; -1: there is none. */
void pendres_switching_states(const pendres_attractors *set, int state[2]);

/** What a survey finds at one temperature. Plain data; what is not known is NaN. */
typedef struct pendres_switching_rates {
  double temperature;    /**< T, in units of m g l */
  pendres_status status; /**< PENDRES_OK, or why nothing is known; PENDRES_NOT_FOUND also where only
                              one of the two states exists, whose rates are known */
  double exposure[2];    /**< time spent on each state, in units of 1/omega_0 */
  pendres_switching_rate way[PENDRES_SWITCHING_WAYS]; /**< rates, by their ways */
  pendres_langevin_estimate occupation[2]; /**< share of the trajectories whose last strobe is in
                              the basin of each state, by settling without noise; NaN without it */
  pendres_langevin_estimate implied[2];    /**< the same as the rates forth and back imply it, from
                              where trajectories started; NaN unless there are these two states
                              alone. If both differ by more than three standard errors the rates
                              miss transitions */
} pendres_switching_rates;

/**
 * Rates of switching at n temperatures, and the activation energies of all ways. rates[n] and
 * activation[PENDRES_SWITCHING_WAYS] are written. A temperature at which something fails is marked
 * by its status and has no rates; the others are unaffected.
 *
 * The seed is the context's. The ids of trajectories follow from the parameters, the temperature
 * and the attractor's number.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED; those of
 * pendres_switching_choose_steps.
 */
pendres_status pendres_switching_find(pendres_context *ctx,
                                      const pendres_switching_survey *survey, size_t n,
                                      const double *temperature, pendres_switching_rates *rates,
                                      pendres_switching_activation *activation);

/**
 * Choose the steps a drive period for a state (0: the first, 1: the second): twice those that keep
 * the bias of its small cloud's widths below 1 %. That bias acts as a wrong temperature, whose
 * effect on rates is E/T times larger; doubling the steps divides it by 16. *steps is 0 where there
 * is no such state. A survey takes the larger number of both states, since trajectories visit both.
 *
 * Errors: as pendres_langevin_choose_steps.
 */
pendres_status pendres_switching_choose_steps(pendres_context *ctx,
                                              const pendres_switching_survey *survey, int state,
                                              int *steps);

/**
 * How deep the basin of attractor i is, in linear theory: half the square of the width, in standard
 * deviations of the small cloud, of the widest ellipse of the cloud's shape that is within the
 * basin, times the temperature. The activation energy of leaving it is of this order: next to a
 * fold a third of it, as the potential is a cubic there. *energy does not depend on the
 * temperature; it is NaN where linear theory or the trapping ellipse is missing. Widths are tried
 * in steps of a fifth.
 *
 * Errors: PENDRES_INVALID_ARGUMENT; those of pendres_attractors_settle.
 */
pendres_status pendres_switching_depth(pendres_context *ctx, const pendres_attractors *set,
                                       size_t i, double *energy);

/** How many parts the trajectories at one temperature are followed in; 0 without a survey. */
size_t pendres_switching_parts(const pendres_switching_survey *survey);

/**
 * Follow the trajectories of one part at one temperature, by the survey's steps, which must not be
 * 0, and count. *tally is overwritten.
 *
 * Errors: as pendres_switching_count.
 */
pendres_status pendres_switching_follow(pendres_context *ctx,
                                        const pendres_switching_survey *survey, double temperature,
                                        size_t part, pendres_switching_tally *tally);

/**
 * The rates at one temperature from `all`, the sum of the tallies of all its parts
 * (pendres_switching_add), or NULL where a part has failed; the caller then puts that part's status
 * into rates->status.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_switching_conclude(const pendres_switching_survey *survey,
                                          double temperature, const pendres_switching_tally *all,
                                          pendres_switching_rates *rates);

/**
 * The activation energies of all ways, activation[PENDRES_SWITCHING_WAYS], from rates at n
 * temperatures. Too few events are not an error: the verdict says so.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_switching_activate(const pendres_switching_survey *survey, size_t n,
                                          const pendres_switching_rates *rates,
                                          pendres_switching_activation *activation);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
