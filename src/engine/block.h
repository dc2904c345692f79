/*
 * block.h -- pendulums side by side, advanced over drive phase with ARKODE.
 *
 * Owns: the ARKODE memory of a block, its lanes, its steps, and the clock. block*.c and method_*.c
 * are the only files that include SUNDIALS' integrators.
 *
 * With fixed steps the integrator is reset at each period's start: the stroboscopic map is then
 * exactly autonomous, so that results do not depend on block size, lane order or how many periods
 * went before (docs/architecture.md). Lanes hold states as coordinates.h and kernels.h say.
 *
 * The context has the message of each failure.
 */
#ifndef PENDRES_BLOCK_H
#define PENDRES_BLOCK_H

#include "engine/context_internal.h"
#include "engine/kernels/kernels.h"

/* Rows of a kind of block. */
size_t pendres_flow_kind_rows(pendres_flow_kind kind);

/*
 * The context's block of a kind, for the use of one function at a time, without lanes, and with
 * `steps` steps per period from now on.
 */
pendres_status pendres_block_open(pendres_context *ctx, pendres_flow_kind kind, int steps,
                                  pendres_block **out);

/* The same block as it is, made at its first use. */
pendres_status pendres_block_of(pendres_context *ctx, pendres_flow_kind kind, pendres_block **out);

/* A block of that many rows (PENDRES_ROWS_...), with as many lanes as the context's options say.
   tolerance: 0 for fixed steps; else steps are adaptive, with this relative and absolute tolerance.
   The context must outlive it. */
pendres_status pendres_block_create(pendres_context *ctx, size_t rows, double tolerance,
                                    pendres_block **out);
void pendres_block_free(pendres_block *b);

/* Set the number of steps a period, from the next period on (fixed steps only). */
pendres_status pendres_block_set_steps(pendres_block *b, int steps);

/* The longest step from now on, of drive phase; 0: any (adaptive steps only). */
pendres_status pendres_block_set_longest_step(pendres_block *b, double longest);

/* The number of lanes that it can hold. */
size_t pendres_block_capacity(const pendres_block *b);

/* Use `lanes` lanes from now on; those that were in use before and still are keep their states. */
void pendres_block_resize(pendres_block *b, size_t lanes);

/* Remove all lanes. The next ones to be loaded decide again which model's kernels compute the
   block. */
void pendres_block_clear(pendres_block *b);

/* Put a pendulum into a lane, at a state. Pendulums with a polynomial force and others do not share
   a block. Variational rows start as the identity, sensitivities as 0. */
void pendres_block_load(pendres_block *b, size_t lane, const pendres_pendulum *p, double y,
                        double w);

/* Copy a lane with all its coefficients. */
void pendres_block_move_lane(pendres_block *b, size_t from, size_t to);

/* Set the state of a lane and leave everything else as it is. */
void pendres_block_put_state(pendres_block *b, size_t lane, double y, double w);

/* The rows as they are, valid until the block is run or resized. */
pendres_rows pendres_block_rows(const pendres_block *b);

/*
 * From now on propagate the errors of the lanes, or tangent vectors, or nothing; for blocks of
 * states with fixed steps only. Both obey the equation linearised along the trajectory. Each step
 * adds the lane's `added` to the variance of y, and to that of v = omega w. Errors and tangents are
 * set after the lane has been loaded, and after the steps of the period.
 *
 * Each lane has two tangents, one with the block's steps and one with steps twice as long, so that
 * the number of steps per period must be even. Their mean growth over long times is correct to
 * fourth order in the step, but not that over a single period: they are half a step ahead of their
 * lanes.
 */
pendres_status pendres_block_carry(pendres_block *b, pendres_flow_load load);
void pendres_block_set_error(pendres_block *b, size_t lane, const pendres_flow_error *error,
                             double added);
pendres_flow_error pendres_block_get_error(const pendres_block *b, size_t lane);
/* which: 0 for the tangent with the block's steps, 1 for that with steps twice as long. */
void pendres_block_put_tangent(pendres_block *b, size_t lane, int which, const double tangent[2]);
void pendres_block_get_tangent(const pendres_block *b, size_t lane, int which, double tangent[2]);

/*
 * Advance all lanes by one drive period; asks before and now and then within long periods whether
 * to go on, and counts the cost. By a Nystrom method tangents are exact, and both become those with
 * the block's steps; in single precision errors must allow for its rounding, and forces have no
 * header of their own. Half a period, from drive phase 0 to pi: for an even number of fixed steps.
 * Orbits that are their own mirror image close after half a period and a reflection.
 */
pendres_status pendres_block_period(pendres_block *b);
pendres_status pendres_block_period_by(pendres_block *b, pendres_flow_way way);
pendres_status pendres_block_half_period(pendres_block *b);

/* The same, and call sample(arg, step, rows) after each step 1..n; fixed steps only, so that the
   samples are equally spaced and the last one is the period's end. */
typedef void pendres_block_sample(void *arg, int step, const pendres_rows *rows);
pendres_status pendres_block_period_sampled(pendres_block *b, pendres_block_sample *sample,
                                            void *arg);

/* Right-hand sides evaluated so far, counting each lane in use, and steps taken, likewise; those
   that an adaptive block rejected do not count. */
double pendres_block_evaluations(const pendres_block *b);
double pendres_block_steps(const pendres_block *b);

#endif
