/**
 * @file context.h
 * @brief The one handle of the library: options, workspace, last message.
 *
 * Owns: the tolerance and method of all computations made with it, the ARKODE
 * memory of its blocks, and the message that explains the last failure.
 *
 * Thread safety: a context belongs to one thread at a time; two contexts never
 * share anything. Results do not depend on which context computed them. A context that is in use,
 * by another thread or by the call that has called the present function (see
 * pendres_context_set_interrupt), is refused with PENDRES_BUSY by every function that computes.
 */
#ifndef PENDRES_CONTEXT_H
#define PENDRES_CONTEXT_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** Opaque: options, workspace and the last message. */
typedef struct pendres_context pendres_context;

/**
 * How pendulums are advanced. The first is the default and by far the fastest, and the only one
 * whose steps are chosen such that results meet the tolerance; with the others it is the tolerance
 * of each step. Advancing, settling and free oscillations use the method; orbits, their measures,
 * branches, recorded trajectories and boundaries always have fixed steps.
 */
typedef enum pendres_method {
  PENDRES_BLOCK_FIXED = 0, /**< blocks on ARKODE, fixed steps, reset every period */
  PENDRES_BLOCK_ADAPTIVE,  /**< blocks on ARKODE, adaptive steps */
  PENDRES_SINGLE,          /**< one adaptive ARKODE problem a pendulum */
  PENDRES_CVODE_ADAMS,     /**< one CVODE Adams problem a pendulum */
  PENDRES_CVODE_BDF,       /**< one CVODE BDF problem a pendulum, Newton with the exact Jacobian */
  PENDRES_NAIVE,           /**< one ARKODE problem a pendulum, with ARKODE's defaults except for the
                                tolerance: the baseline of benchmarks */
  PENDRES_METHOD_COUNT     /**< how many there are; not a method */
} pendres_method;

/** Butcher tables offered; measured orders in tests/test_flow.c. */
typedef enum pendres_table {
  PENDRES_TABLE_DEFAULT = 0, /**< PENDRES_TABLE_TP8 */
  PENDRES_TABLE_TP8,    /**< Tsitouras and Papakostas 8(7), SIAM J. Sci. Comput. 20 (1999) 2067 */
  PENDRES_TABLE_TSIT5,  /**< Tsitouras 5(4), Comput. Math. Appl. 62 (2011) 770 */
  PENDRES_TABLE_VERN9,  /**< Verner 9(8) */
  PENDRES_TABLE_DP5,    /**< ARKODE's built-in Dormand-Prince 5(4) */
  PENDRES_TABLE_COUNT   /**< how many there are; not a table */
} pendres_table;

/** What a caller may choose. Zero in any field means the default. */
typedef struct pendres_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  double tolerance;     /**< absolute tolerance of the results: a length, like x; that of areas,
                             velocities and others follows with the pendulum's units
                             (pendres_units_of). At least 1e-13 of the unit of length, otherwise
                             computations refuse it; more than 1e-2 of it counts as 1e-2. Default:
                             1e-8 of that unit */
  pendres_method method; /**< how pendulums are advanced */
  pendres_table table;  /**< Butcher table of the methods on ARKODE */
  int steps_per_period; /**< overrides the choice made from the tolerance */
  int block_lanes;      /**< pendulums side by side, a multiple of 8; default 512 */
  long period_budget;   /**< drive periods after which a pendulum is unresolved; default
                             from damping and tolerance */
  double exponent_error; /**< relative standard error of a chaotic attractor's exponent at which its
                             averages may end, at most 1. The other results for the attractor then
                             come from fewer periods as well (watched_periods). Default: averages
                             are as long as needed to distinguish lasting from transient chaos */
  uint64_t seed;        /**< of all random numbers of noisy trajectories (langevin.h): any value;
                             zero is a seed like any other */
  int threads;          /**< that a call may use where its work can be divided: pendulums that
                             settle, replicas of chaos, many or long orbits, averages of sweeps,
                             random states of basins (basin.h), pairs of points (dimension.h).
                             Results are the same bytes. Default 1, at most 4096 */
} pendres_options;

/**
 * What a context has spent since its creation or the last reset. How many steps a period needs is
 * found out once for pendulums that are alike, and not counted: what a computation costs does not
 * depend on those before it.
 */
typedef struct pendres_cost {
  double pendulum_periods;  /**< drive periods, summed over lanes in use */
  double rhs_evaluations;   /**< right-hand sides, one a lane, stage and step */
  double steps;             /**< steps of the integrators, over all lanes, without rejected ones */
  double newton_steps;      /**< Newton iterations on the stroboscopic map */
  double settled_pendulums; /**< pendulums for which it was computed what they settle on */
} pendres_cost;

/** NULL if the options are valid, otherwise a static sentence that says what is wrong. options may
    be NULL: defaults. */
const char *pendres_options_check(const pendres_options *options);

/**
 * Create a context. options may be NULL (all defaults) and is copied.
 * On failure *out is NULL.
 */
pendres_status pendres_context_create(const pendres_options *options, pendres_context **out);

/**
 * Free a context; NULL is allowed. Objects made with it stay valid unless they say otherwise.
 * A context in use is left alone.
 */
void pendres_context_free(pendres_context *ctx);

/**
 * The message of the last computation if it failed, otherwise "". Owned by the context, valid until
 * its next use. While the context is in use, the message says so.
 */
const char *pendres_context_message(const pendres_context *ctx);

/** The options in force, defaults resolved; NULL without a context. */
const pendres_options *pendres_context_options(const pendres_context *ctx);

/** Cost so far; NaN without a context and while another thread uses it. */
void pendres_context_cost(const pendres_context *ctx, pendres_cost *cost);
/** Set all costs to zero. A context in use is not reset. */
void pendres_context_cost_reset(pendres_context *ctx);

/**
 * Set a function that is called now and then, within long drive periods, too: it returns nonzero to
 * stop, and the computation then ends with PENDRES_INTERRUPTED. NULL removes it. arg is kept, not
 * owned. Within that function the context is in use, and only its cost and options may be asked
 * for. A context in use keeps the function that it has. With the option `threads` it is called by
 * any of them, one at a time.
 */
void pendres_context_set_interrupt(pendres_context *ctx, int (*stop)(void *arg), void *arg);

/**
 * How a long computation keeps what it has done, so that another process takes it up there if this
 * one is killed: hysteresis.h, cascade.h and fit.h say which functions do so. States are plain
 * bytes of this build of the library; they hold the question, too, so that one of another call is
 * passed over. Results are the same bytes as without an end in between, and costs count once.
 */
typedef struct pendres_keep {
  int (*due)(void *arg, double done); /**< whether a state is wanted now, `done` being the share of
                                           the work's parts that are done; asked between parts */
  void (*put)(void *arg, const void *state, size_t size); /**< takes a copy of a state */
  const void *state; /**< the latest state of an earlier process; NULL: none. Not owned, and read
                          only by the next call that keeps states */
  size_t size;       /**< its bytes */
  void *arg;         /**< of both functions */
} pendres_keep;

/**
 * Set how computations on a context keep states; NULL: not at all. *keep is copied. Within its
 * functions the context is in use, as with pendres_context_set_interrupt. A context in use keeps
 * what it has.
 */
void pendres_context_set_keep(pendres_context *ctx, const pendres_keep *keep);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
