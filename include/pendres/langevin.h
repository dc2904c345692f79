/**
 * @file langevin.h
 * @brief Pendulums with thermal noise: trajectories, their clouds, linear noise theory.
 *
 * Owns: ensembles of noisy trajectories seen once a drive period, statistics of the clouds of their
 * strobe points with errors and biases, rates of rare events, and linear noise theory. Equation and
 * units as in pendulum.h; cloud.h compares clouds around attractors with that theory.
 *
 * Integrator: a fourth-order splitting with positive coefficients (Suzuki, Phys. Lett. A 201
 * (1995) 425; scheme 4B of Chin, Phys. Lett. A 226 (1997) 344; for noise: Forbert and Chin,
 * Phys. Rev. E 63 (2000) 016703). Free motion, with friction and drive solved exactly,
 * alternates with kicks by force and noise, two a step, at Gauss's points; the fourth-order
 * correction multiplies both by 1 - h^2 (2 - sqrt 3)/12 f'(y), where h is the step and f the force,
 * sin y for the plain pendulum. The weak order is four at any temperature; at temperature zero it
 * is an ordinary method of order four.
 *
 * Random numbers: Philox4x32-10 (Random123) and Box-Muller. The key is the context's seed, the
 * counter the trajectory's id, the number of the period and of the draw within it. Results are
 * the same bytes whatever the size of a block, the order of trajectories, the number of
 * threads, or how often a run was interrupted at a period's end; a longer run extends a
 * shorter one.
 *
 * Thread safety: that of the context (context.h); functions without one are pure.
 */
#ifndef PENDRES_LANGEVIN_H
#define PENDRES_LANGEVIN_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/context.h>
#include <pendres/pendulum.h>
#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

enum { PENDRES_LANGEVIN_STEPS = 24 /**< default number of steps per drive period */ };

/* ---- Advancing --------------------------------------------------------------------------- */

/** Some neighbouring trajectories at a strobe: entry i is trajectory first + i. */
typedef struct pendres_langevin_strobe {
  size_t first;         /**< number of the first trajectory shown */
  size_t count;         /**< how many are shown */
  long period;          /**< the strobe's number: drive periods that have passed since period 0 */
  const double *x;      /**< [count] position x at drive phase 0, in rad, whole turns included */
  const double *v;      /**< [count] velocity v = dx/dt, in units of omega_0 */
  const double *cosine; /**< [count] (1/pi) integral of y cos(theta) dtheta over the drive period
                             that has just ended, in rad: first harmonic of the angle
                             y = x - pi/2. NULL unless the observer asks for harmonics. Like the
                             next two it is the trapezoidal sum over the steps: its mean over a
                             settled ensemble converges with order four, its value for a single
                             period that does not close with order two */
  const double *sine;   /**< [count] (1/pi) integral of y sin(theta) dtheta, likewise */
  const double *work;   /**< [count] F0 integral of cos(theta) dx, in units of m g l: the loop
                             area of that period, likewise */
} pendres_langevin_strobe;

/** What an observer returns. */
typedef enum pendres_langevin_answer {
  PENDRES_LANGEVIN_GO_ON = 0, /**< advance these trajectories further */
  PENDRES_LANGEVIN_ENOUGH,    /**< these trajectories need not be advanced further */
  PENDRES_LANGEVIN_STOP,      /**< end everything with PENDRES_INTERRUPTED */
  PENDRES_LANGEVIN_ANSWER_COUNT /**< how many there are; not an answer */
} pendres_langevin_answer;

/**
 * A function to which trajectories are shown once per period. Blocks of trajectories follow one
 * another, each through all of its periods; the observer must not depend on which trajectories
 * share a block.
 */
typedef struct pendres_langevin_observer {
  /** Called with a block's trajectories at the end of each of their periods. The context is in
     use. */
  pendres_langevin_answer (*see)(void *arg, const pendres_langevin_strobe *strobe);
  void *arg;     /**< passed to see(); not owned */
  int harmonics; /**< nonzero: cosine, sine and work are wanted, for 20 to 30 % more time */
} pendres_langevin_observer;

/** Trajectories to advance. Everything that it points to is read, and not kept. */
typedef struct pendres_langevin_run {
  size_t n;                          /**< number of trajectories */
  const pendres_pendulum *pendulums; /**< [n] parameters, the temperature among them */
  const uint64_t *ids;               /**< [n] identity of each trajectory; NULL: 0 .. n-1. Those of
                                          equal seed, id and period number have the same noise */
  long first_period;                 /**< number of the first period: how many each trajectory has
                                          behind it, from 0 on */
  long periods;                      /**< drive periods to advance by; all of them must be numbered
                                          below 2^32 */
  int steps_per_period;              /**< steps a drive period, from 2 to 1000000; 0: those of the
                                          context's options or, if these have none,
                                          PENDRES_LANGEVIN_STEPS */
  const pendres_langevin_observer *observer; /**< to which trajectories are shown; NULL: none */
  int unbounded; /**< nonzero: trajectories may go to infinity, where x and v are infinite or NaN;
                      otherwise that is a failure */
} pendres_langevin_run;

/**
 * Advance noisy trajectories, drive period by drive period.
 *
 * x[n] and v[n], the states at drive phase 0, are replaced in place; x keeps its whole turns.
 * Advancing k periods and then m, with first_period raised by k, is the same to the last bit as
 * advancing k + m.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (for instance a temperature that is negative or NaN; the
 * message names the trajectory), PENDRES_INTEGRATION_FAILED (a trajectory went beyond 1e15),
 * PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED; on any of these x and v are unchanged.
 */
pendres_status pendres_langevin_advance(pendres_context *ctx, const pendres_langevin_run *run,
                                        double *x, double *v);

/* ---- Clouds ------------------------------------------------------------------------------ */

/** A number and its standard error. */
typedef struct pendres_langevin_estimate {
  double value; /**< the number itself, in the units of the statistic */
  double error; /**< its standard error, in the same units */
} pendres_langevin_estimate;

/** Statistics of a cloud of strobe points; their names index arrays. */
typedef enum pendres_langevin_statistic {
  PENDRES_LANGEVIN_MEAN_X = 0, /**< mean of x at drive phase 0, in rad, whole turns included */
  PENDRES_LANGEVIN_MEAN_V,     /**< mean of v at drive phase 0, in omega_0 */
  PENDRES_LANGEVIN_COV_XX,     /**< variance of x, in rad^2 */
  PENDRES_LANGEVIN_COV_XV,     /**< covariance of x and v, in rad omega_0 */
  PENDRES_LANGEVIN_COV_VV,     /**< variance of v, in omega_0^2 */
  PENDRES_LANGEVIN_COSINE,     /**< a, in rad, of the mean first harmonic of the angle:
                                    y ~ a cos(theta) + b sin(theta) */
  PENDRES_LANGEVIN_SINE,       /**< b, in rad, of the same */
  PENDRES_LANGEVIN_LOOP_AREA,  /**< mean work of the drive a drive period, in m g l */
  PENDRES_LANGEVIN_STATISTICS  /**< how many there are */
} pendres_langevin_statistic;

/** Sets of statistics, for pendres_langevin_choose_steps. */
enum {
  /** Means and covariances of the strobe points. */
  PENDRES_LANGEVIN_CLOUD = 1 << PENDRES_LANGEVIN_MEAN_X | 1 << PENDRES_LANGEVIN_MEAN_V |
                           1 << PENDRES_LANGEVIN_COV_XX | 1 << PENDRES_LANGEVIN_COV_XV |
                           1 << PENDRES_LANGEVIN_COV_VV,
  /** First harmonic and loop area. */
  PENDRES_LANGEVIN_RESPONSE = 1 << PENDRES_LANGEVIN_COSINE | 1 << PENDRES_LANGEVIN_SINE |
                              1 << PENDRES_LANGEVIN_LOOP_AREA
};

/** What to make a cloud of: independent trajectories that start at one point. */
typedef struct pendres_langevin_request {
  pendres_pendulum pendulum; /**< parameters, the temperature among them */
  double x;                  /**< position where all start, at drive phase 0: that of the
                                  attractor's strobe point */
  double v;                  /**< velocity there */
  size_t trajectories;       /**< at least 2; a few hundred give reliable errors */
  long settle;               /**< drive periods before the first strobe that counts */
  long record;               /**< strobes of each trajectory that count, at least 1 */
  int steps_per_period;      /**< steps a drive period, as in pendres_langevin_run */
  uint64_t first_id;         /**< trajectory i has id first_id + i */
  /** NULL, or a function that sets left[i] to nonzero where trajectory i of the strobe has left
   *  the attractor. It is called at every strobe; marks stay set from strobe to strobe. From the
   *  strobe at which a trajectory is marked it does not count. */
  void (*leave)(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left);
  void *arg;                 /**< passed to leave(); not owned */
} pendres_langevin_request;

/** A cloud. Errors are standard errors from the scatter among trajectories, which are
    independent. */
typedef struct pendres_langevin_cloud {
  pendres_langevin_estimate statistics[PENDRES_LANGEVIN_STATISTICS]; /**< by their names */
  pendres_langevin_estimate phase_lag; /**< atan2(b, a) of the mean first harmonic, 0 to 2 pi */
  size_t left;      /**< trajectories that left */
  double exposure;  /**< drive periods, summed over trajectories, until they left or the end:
                         left / exposure is the rate of leaving, a drive period */
  double strobes;   /**< strobe points that counted */
} pendres_langevin_cloud;

/**
 * Follow the request's trajectories and sum up. strobe_x and strobe_v, if not NULL, receive
 * trajectories x record strobe points, those of one trajectory together; NaN where it had left.
 *
 * Errors: as pendres_langevin_advance; PENDRES_NOT_FOUND if fewer than two trajectories had a
 * strobe that counts: statistics are then NaN, but left, exposure and strobes are valid.
 */
pendres_status pendres_langevin_cloud_find(pendres_context *ctx,
                                           const pendres_langevin_request *request,
                                           pendres_langevin_cloud *cloud, double *strobe_x,
                                           double *strobe_v);

/** The systematic error (bias) that steps of finite length give a cloud. */
typedef struct pendres_langevin_bias {
  int steps_per_period; /**< the steps a drive period whose bias it is */
  /** Bias (positive: the statistic is too large) and its own standard error, by the statistics'
   *  names. */
  pendres_langevin_estimate statistics[PENDRES_LANGEVIN_STATISTICS];
  /** What each bias is compared with: for means the cloud's standard deviations, for covariances
   *  products of these; for cosine and sine the first harmonic's amplitude, or the standard
   *  deviation of x where that is larger; for the loop area the loop area. */
  double scale[PENDRES_LANGEVIN_STATISTICS];
} pendres_langevin_bias;

/**
 * Choose the steps a period by step doubling: the fewest found for which the bias of each of
 * the statistics (a set of bits) plus twice its error stays below tolerance times its scale.
 * bias->steps_per_period receives them; request->steps_per_period is not read. Where the error of
 * the bias is too large, more trajectories are followed, up to 64 times the request's.
 *
 * Errors: PENDRES_INVALID_ARGUMENT also at temperature zero, where a cloud has no width;
 * PENDRES_NOT_CONVERGED (bias then holds the last); as pendres_langevin_cloud_find.
 */
pendres_status pendres_langevin_choose_steps(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             unsigned statistics, double tolerance,
                                             pendres_langevin_bias *bias);

/** A rate of rare independent events. */
typedef struct pendres_langevin_interval {
  double value; /**< events / exposure */
  double error; /**< standard error, sqrt(events) / exposure; without events the upper end of the
                     interval of one standard deviation */
  double lower; /**< lower end of the confidence interval */
  double upper; /**< upper end of the confidence interval */
} pendres_langevin_interval;

/* ---- Linear noise theory ----------------------------------------------------------------- */

/** A symmetric 2 x 2 matrix over (x, v). */
typedef struct pendres_langevin_covariance {
  double xx; /**< variance of x, in rad^2 */
  double xv; /**< covariance of x and v */
  double vv; /**< variance of v */
} pendres_langevin_covariance;

/** Linear noise theory along a closed orbit. */
typedef struct pendres_langevin_linear {
  pendres_langevin_covariance covariance; /**< sigma of the cloud at drive phase 0, exact to first
                                               order in the temperature */
  pendres_langevin_covariance injected;   /**< Q: what the noise of `cycle` drive periods adds */
  double monodromy[4]; /**< M of `cycle` drive periods, row by row (xx, xv, vx, vv) */
  double closure;      /**< distance by which the orbit fails to close, v counted in units of time
                            (pendres_units_of): rounding errors, if (x, v) is on the orbit */
  double error;        /**< largest error of the covariance's three numbers, by step doubling;
                            likewise */
} pendres_langevin_linear;

/**
 * Covariance of the small cloud around the orbit through (x, v) at drive phase 0 that closes
 * after `cycle` drive periods, up to whole turns. The orbit, its variation and the covariance that
 * noise adds, dC/dt = J C + C J^T + diag(0, 2 gamma T) from C = 0, are integrated along one
 * cycle; then the Lyapunov equation is solved (van Kampen, Stochastic Processes in Physics and
 * Chemistry, chapter VIII.6).
 *
 * Errors: PENDRES_INVALID_ARGUMENT; PENDRES_NOT_FOUND if the orbit does not attract;
 * PENDRES_TOLERANCE_UNREACHABLE if that would take more than 1e8 steps.
 */
pendres_status pendres_langevin_linear_find(const pendres_pendulum *pendulum, double x,
                                            double v, int cycle, pendres_langevin_linear *out);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
