/*
 * flow.h -- advancing a block of pendulums over drive phase with ARKODE.
 *
 * Owns: the ARKODE memory of a block, its steps, and the clock. flow*.c are the
 * only files that include SUNDIALS' integrators.
 *
 * One call advances every lane from drive phase 0 to 2 pi. With fixed steps
 * the integrator is reset at each period's start: the stroboscopic map is then
 * exactly autonomous, so that results do not depend on block size, lane order
 * or how many periods went before (design notes, docs/architecture.md).
 *
 * Internal units: y = x - pi/2, w = dy/dtheta = v/omega (see kernels.h).
 */
#ifndef PENDRES_FLOW_H
#define PENDRES_FLOW_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include <sundials/sundials_context.h>

#include "engine/kernels.h"

typedef struct pendres_flow pendres_flow;

typedef struct pendres_flow_options {
  size_t rows;      /* one of PENDRES_ROWS_... */
  size_t lanes;     /* capacity */
  pendres_table table;
  double tolerance; /* 0: fixed steps; else adaptive steps with this relative and absolute tolerance
                       */
  int (*stop)(void *arg); /* called now and then within long periods: nonzero ends the period; may
                             be NULL */
  void *stop_arg;
} pendres_flow_options;

/* sun is kept, not owned, and must outlive the flow. */
pendres_status pendres_flow_create(const pendres_flow_options *options, SUNContext sun,
                                   pendres_flow **out);
void pendres_flow_free(pendres_flow *flow);

/* Set the number of steps a period, from the next period on (fixed steps only). */
pendres_status pendres_flow_set_steps(pendres_flow *flow, int steps);

/* The longest step from now on, of drive phase; 0: any (adaptive steps only). */
pendres_status pendres_flow_set_longest_step(pendres_flow *flow, double longest);

/*
 * Use `lanes` lanes (at most the capacity) from now on; the states of lanes below are kept.
 */
void pendres_flow_resize(pendres_flow *flow, size_t lanes);
size_t pendres_flow_capacity(const pendres_flow *flow);

/* Remove all lanes. The next ones to be set decide again which model's kernels compute the block.
   */
void pendres_flow_clear(pendres_flow *flow);

/* Put a pendulum into a lane. Pendulums with a polynomial force and others do not share a block.
   Variational rows start as the identity, sensitivities as 0. */
void pendres_flow_set_lane(pendres_flow *flow, size_t lane, const pendres_pendulum *p, double y,
                           double w);

/*
 * From now on propagate the errors of the lanes, or tangent vectors, or nothing; for blocks of
 * states with fixed steps only. Both obey the equation linearised along the trajectory. Each step
 * adds the lane's `added` to the variance of y, and to that of v = omega w. Errors and tangents are
 * set after the lane's pendulum and the steps of the period.
 *
 * Each lane has two tangents, one with the block's steps and one with steps twice as long, so that
 * the number of steps per period must be even. Their mean growth over long times is correct to
 * fourth order in the step, but not that over a single period: they are half a step ahead of their
 * lanes.
 */
pendres_status pendres_flow_carry(pendres_flow *flow, pendres_flow_load load);
void pendres_flow_set_error(pendres_flow *flow, size_t lane, const pendres_flow_error *error,
                            double added);
pendres_flow_error pendres_flow_get_error(const pendres_flow *flow, size_t lane);
/* which: 0 for the tangent with the block's steps, 1 for that with steps twice as long. */
void pendres_flow_set_tangent(pendres_flow *flow, size_t lane, int which, const double tangent[2]);
void pendres_flow_get_tangent(const pendres_flow *flow, size_t lane, int which, double tangent[2]);

/* Copy a lane with all its coefficients. */
void pendres_flow_move_lane(pendres_flow *flow, size_t from, size_t to);

/* The rows of the block, valid until the next call that advances or resizes it. */
pendres_rows pendres_flow_rows(const pendres_flow *flow);
/* Set the state of a lane and leave everything else as it is. */
void pendres_flow_put_state(pendres_flow *flow, size_t lane, double y, double w);

/* Advance all lanes by one drive period. PENDRES_INTERRUPTED if stop() returned nonzero. */
pendres_status pendres_flow_period(pendres_flow *flow);

/* Advance all lanes by one drive period in single precision: plain pendulums that carry errors,
   which must allow for this rounding. */
pendres_status pendres_flow_period_float(pendres_flow *flow);

/*
 * Advance all lanes from drive phase 0 to pi: for an even number of fixed steps per period. Orbits
 * that are their own mirror image close after half a period and a reflection.
 */
pendres_status pendres_flow_half_period(pendres_flow *flow);

/*
 * Like pendres_flow_period, and call sample(arg, step, rows) after each step
 * 1..n; fixed steps only, so the samples are equally spaced and the last one is the period's end.
 */
typedef void pendres_flow_sample(void *arg, int step, const pendres_rows *rows);
pendres_status pendres_flow_period_sampled(pendres_flow *flow, pendres_flow_sample *sample,
                                           void *arg);

/* Right-hand sides evaluated so far, counting each lane in use. */
double pendres_flow_evaluations(const pendres_flow *flow);
/* Steps taken so far, likewise; those that an adaptive block rejected do not count. */
double pendres_flow_steps(const pendres_flow *flow);

/* ARKODE's return code at the last failure. */
int pendres_flow_failure(const pendres_flow *flow);

#endif
