/*
 * langevin.h -- pendulums with thermal noise.
 *
 * Owns: ensembles of noisy trajectories seen once a drive period, the clouds they form
 * around an attractor with their errors and biases, and linear noise theory. Equation and
 * units as in pendulum.h.
 *
 * Integrator: a fourth-order splitting with positive coefficients (Suzuki, Phys. Lett. A 201
 * (1995) 425; scheme 4B of Chin, Phys. Lett. A 226 (1997) 344; for noise: Forbert and Chin,
 * Phys. Rev. E 63 (2000) 016703). Free motion, with friction and drive solved exactly,
 * alternates with kicks by force and noise, two a step, at Gauss's points; the fourth-order
 * correction multiplies both by 1 - h^2 (2 - sqrt 3)/12 cos y. Weak order four at any
 * temperature; at temperature zero an ordinary method of order four, without noise.
 *
 * Random numbers: Philox4x32-10 (Random123) and Box-Muller. The key is the seed, the counter
 * the trajectory's id, the number of the period and of the draw within it. Results are
 * the same bytes whatever the size of a block, the order of trajectories, the number of
 * threads, or how often a run was interrupted at a period's end; a longer run extends a
 * shorter one.
 *
 * Thread safety: a pendres_langevin belongs to one thread at a time; two never share anything. One
 * that is in use, by another thread or by the call which asks the present function, is refused with
 * PENDRES_BUSY.
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

typedef struct pendres_langevin pendres_langevin;

/** What a caller may choose. Zero in any field means the default. */
typedef struct pendres_langevin_options {
  uint64_t seed;        /**< any value; zero is a seed like any other */
  int steps_per_period; /**< from 2 to 1000000; default 24 */
  int block_lanes;      /**< trajectories side by side, a multiple of 8; default 192 */
} pendres_langevin_options;

/** NULL when the options are valid, else a static sentence on what is wrong. */
const char *pendres_langevin_options_check(const pendres_langevin_options *options);

/** Create a handle. options may be NULL and is copied. On failure *out is NULL. */
pendres_status pendres_langevin_create(const pendres_langevin_options *options,
                                       pendres_langevin **out);

/** Free a handle; NULL is allowed. One in use is left alone. */
void pendres_langevin_free(pendres_langevin *lv);

/** The sentence on how the last use failed; "" if it did not. Valid until the handle's next use. */
const char *pendres_langevin_message(const pendres_langevin *lv);

/** Steps a drive period in force (0 without a handle), and another choice of them. */
int pendres_langevin_steps(const pendres_langevin *lv);
pendres_status pendres_langevin_set_steps(pendres_langevin *lv, int steps_per_period);

/** Pendulum-periods advanced since creation; a pair of pendres_langevin_bias counts three.
 *  NaN without a handle, and while another thread uses it. */
double pendres_langevin_spent(const pendres_langevin *lv);

/** What a handle has spent since its creation, both of a pair counted as what they are; a step
 *  evaluates two forces. NaN without a handle, and while another thread uses it. */
void pendres_langevin_cost(const pendres_langevin *lv, pendres_cost *cost);

/** As pendres_context_set_interrupt: asked once a period of a block, and within long periods. */
void pendres_langevin_set_interrupt(pendres_langevin *lv, int (*stop)(void *arg), void *arg);

/* ---- Advancing --------------------------------------------------------------------------- */

/** Some neighbouring trajectories at a strobe: entry i is trajectory first + i. */
typedef struct pendres_langevin_strobe {
  size_t first, count;
  long period;          /**< how many periods have passed since period 0: the strobe's number */
  const double *x, *v;  /**< state at the strobe */
  /* Over the period that has just ended; NULL unless asked for. Sums over the ends of steps:
   * their mean over a settled ensemble is of order four, that of a single cycle that does not
   * close of order two. */
  const double *cosine; /**< first harmonic of the angle, (1/pi) integral of y cos theta */
  const double *sine;   /**< and (1/pi) integral of y sin theta over drive phase theta */
  const double *work;   /**< F0 integral of cos theta dx: the loop area of this cycle */
} pendres_langevin_strobe;

/** What an observer answers. */
typedef enum pendres_langevin_answer {
  PENDRES_LANGEVIN_GO_ON = 0,
  PENDRES_LANGEVIN_ENOUGH, /**< these trajectories need not be advanced further */
  PENDRES_LANGEVIN_STOP    /**< end everything with PENDRES_INTERRUPTED */
} pendres_langevin_answer;

/**
 * Who sees trajectories once a period. Blocks come one after another, each through all its
 * periods; which trajectories share a block is not the observer's business.
 */
typedef struct pendres_langevin_observer {
  pendres_langevin_answer (*see)(void *arg, const pendres_langevin_strobe *strobe);
  void *arg;     /**< kept by nobody */
  int harmonics; /**< nonzero: cosine, sine and work are wanted, for 20 to 30 % more time */
} pendres_langevin_observer;

/**
 * Advance n trajectories by `periods` drive periods, which are periods first_period,
 * first_period + 1, ... of their lives.
 *
 * pendulums[n] and ids[n] are read; ids NULL means 0 .. n-1. x[n], v[n] (state at drive phase
 * 0) are replaced in place; x keeps its whole turns. observer may be NULL. Trajectories with
 * equal ids, seed and period have the same noise.
 *
 * Advancing k periods and then m is the same, to the last bit, as advancing k + m.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (a temperature that is negative or not a number, say; the
 * message names the trajectory), PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED; on any of these
 * x and v are unchanged.
 */
pendres_status pendres_langevin_advance(pendres_langevin *lv, size_t n,
                                        const pendres_pendulum *pendulums, const uint64_t *ids,
                                        long first_period, long periods, double *x, double *v,
                                        const pendres_langevin_observer *observer);

/* ---- Clouds ------------------------------------------------------------------------------ */

/** A number and its standard error. */
typedef struct pendres_langevin_estimate {
  double value, error;
} pendres_langevin_estimate;

/** Statistics of a cloud; their names index arrays. */
typedef enum pendres_langevin_statistic {
  PENDRES_LANGEVIN_MEAN_X, /**< of the strobe points, turns included */
  PENDRES_LANGEVIN_MEAN_V,
  PENDRES_LANGEVIN_COV_XX, /**< their covariance */
  PENDRES_LANGEVIN_COV_XV,
  PENDRES_LANGEVIN_COV_VV,
  PENDRES_LANGEVIN_COSINE, /**< mean first harmonic of the angle: y ~ cosine cos + sine sin */
  PENDRES_LANGEVIN_SINE,
  PENDRES_LANGEVIN_LOOP_AREA, /**< mean work of the drive a cycle */
  PENDRES_LANGEVIN_STATISTICS
} pendres_langevin_statistic;

/** Sets of statistics, for pendres_langevin_choose_steps. */
enum {
  PENDRES_LANGEVIN_CLOUD = 1 << PENDRES_LANGEVIN_MEAN_X | 1 << PENDRES_LANGEVIN_MEAN_V |
                           1 << PENDRES_LANGEVIN_COV_XX | 1 << PENDRES_LANGEVIN_COV_XV |
                           1 << PENDRES_LANGEVIN_COV_VV,
  PENDRES_LANGEVIN_RESPONSE = 1 << PENDRES_LANGEVIN_COSINE | 1 << PENDRES_LANGEVIN_SINE |
                              1 << PENDRES_LANGEVIN_LOOP_AREA
};

/** What to make a cloud of: independent trajectories that start at one point. */
typedef struct pendres_langevin_request {
  pendres_pendulum pendulum;
  double x, v;         /**< where all start, at drive phase 0: the attractor's strobe point */
  size_t trajectories; /**< at least 2; a few hundred make good errors */
  long settle;         /**< periods before the first that counts */
  long record;         /**< strobes of each trajectory that count, at least 1 */
  uint64_t first_id;   /**< trajectory i has id first_id + i */
  /** NULL, or: sets left[i] nonzero for trajectories that have left the attractor; asked at
   * every strobe. What comes after does not count. Marks are kept, from strobe to strobe. */
  void (*leave)(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left);
  void *arg;
} pendres_langevin_request;

/** A cloud. Errors are standard errors by comparison of trajectories, which are independent. */
typedef struct pendres_langevin_cloud {
  pendres_langevin_estimate statistics[PENDRES_LANGEVIN_STATISTICS];
  pendres_langevin_estimate phase_lag; /**< of the mean first harmonic, 0 .. 2 pi */
  size_t left;      /**< trajectories that left */
  double exposure;  /**< pendulum-periods until they left or the end: rate = left / exposure */
  double strobes;   /**< strobe points that counted */
} pendres_langevin_cloud;

/**
 * Follow the request's trajectories and sum up. strobe_x and strobe_v, if not NULL, receive
 * trajectories x record strobe points, those of one trajectory together; NaN where it had left.
 *
 * Errors: as advance; PENDRES_NOT_FOUND if fewer than two trajectories had a strobe that counts:
 * statistics are NaN then, left, exposure and strobes are right.
 */
pendres_status pendres_langevin_measure(pendres_langevin *lv,
                                        const pendres_langevin_request *request,
                                        pendres_langevin_cloud *cloud, double *strobe_x,
                                        double *strobe_v);

/** How wrong finite steps make a cloud. */
typedef struct pendres_langevin_bias {
  int steps_per_period;
  /** Bias (with sign: too large is positive) and its own standard error. */
  pendres_langevin_estimate statistics[PENDRES_LANGEVIN_STATISTICS];
  /** What each is measured by: the cloud's standard deviations for means, their products for
   * covariances, the first harmonic's amplitude, the loop area. */
  double scale[PENDRES_LANGEVIN_STATISTICS];
} pendres_langevin_bias;

/**
 * Bias of the handle's steps a period n, for the cloud of a request: pairs of trajectories
 * with n and 2 n steps and the same noise. The noise differs from that of
 * pendres_langevin_measure. Their difference is the bias but for a fifteenth (order four).
 */
pendres_status pendres_langevin_measure_bias(pendres_langevin *lv,
                                             const pendres_langevin_request *request,
                                             pendres_langevin_bias *bias);

/**
 * Choose the steps a period by step doubling: the fewest found such that the bias of each of
 * the statistics (a set of bits) and twice its error stay below tolerance times its scale. The
 * handle takes them over. The number of trajectories is raised where the bias' own error asks
 * for it, up to 64 times the request's.
 *
 * Errors: PENDRES_INVALID_ARGUMENT also at temperature zero, where a cloud has no width;
 * PENDRES_NOT_CONVERGED (bias then holds the last).
 */
pendres_status pendres_langevin_choose_steps(pendres_langevin *lv,
                                             const pendres_langevin_request *request,
                                             unsigned statistics, double tolerance,
                                             pendres_langevin_bias *bias);

/**
 * Rate of rare independent events: events / exposure, and the exact (Poisson) confidence
 * interval of the given level, 0 < level < 1. Garwood, Biometrika 28 (1936) 437; from 500 events
 * on by Wilson and Hilferty's approximation, whose error is below 1e-4 of the interval's width at
 * levels from 0.1 to 0.999, below 1e-3 beyond. events may be a fraction: a count over its
 * dispersion.
 */
pendres_status pendres_langevin_rate(double events, double exposure, double level, double *rate,
                                     double *lower, double *upper);

/* ---- Linear noise theory ----------------------------------------------------------------- */

/** Symmetric 2 x 2 matrix of (x, v). */
typedef struct pendres_langevin_covariance {
  double xx, xv, vv;
} pendres_langevin_covariance;

/**
 * Solve sigma = M sigma M^T + Q, the covariance that a linear map with noise settles to.
 * m is row by row (xx, xv, vx, vv). PENDRES_NOT_FOUND if M does not contract.
 */
pendres_status pendres_langevin_lyapunov(const double m[4], const pendres_langevin_covariance *q,
                                         pendres_langevin_covariance *sigma);

/** Linear noise theory along a closed orbit. */
typedef struct pendres_langevin_linear {
  pendres_langevin_covariance covariance; /**< of the cloud at drive phase 0: exact to first
                                               order in temperature */
  pendres_langevin_covariance injected;   /**< by the noise of `cycle` periods */
  double monodromy[4];                    /**< of `cycle` periods, row by row */
  double closure; /**< distance by which the orbit fails to close: should be rounding */
  double error;   /**< of the covariance, by step doubling: the largest of the three */
} pendres_langevin_linear;

/**
 * Covariance of the small cloud around the orbit through (x, v) at drive phase 0 that closes
 * after `cycle` periods, up to whole turns. The orbit, its variation and the covariance that
 * noise adds, dC/dt = J C + C J^T + diag(0, 2 gamma T) from C = 0, are integrated along one
 * cycle; then the Lyapunov equation.
 *
 * Errors: PENDRES_INVALID_ARGUMENT; PENDRES_NOT_FOUND if the orbit does not attract.
 */
pendres_status pendres_langevin_linear_theory(const pendres_pendulum *pendulum, double x,
                                              double v, int cycle, pendres_langevin_linear *out);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
