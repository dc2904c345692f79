/*
 * coordinates.h -- the one way for a pendulum into lanes, and out of them again.
 *
 * Owns: the representation of a state inside the engine; the removal of whole turns and their
 * restoration, always in the same order; and the use of a block: setting its steps, loading its
 * lanes, running it by periods, reading it by rows. Code outside the engine does not use a flow.
 *
 * Outside, a state is (x, v) as in pendulum.h. Inside it is (y, w): y = x - pi/2 is the angle, kept
 * within half a turn of zero while whole turns are counted apart (y = x where the coordinate has no
 * period), and w = dy/dtheta = v/omega.
 */
#ifndef PENDRES_COORDINATES_H
#define PENDRES_COORDINATES_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include "engine/context_internal.h"
#include "engine/kernels.h"

/* ---- states ---- */

typedef struct pendres_coordinates {
  double y, w;
  long turns;
} pendres_coordinates;

/* Why double precision cannot follow a pendulum from a state, a static sentence; NULL if it can. */
const char *pendres_coordinates_refuses(const pendres_pendulum *p, double x, double v);

/* In, with whole turns taken out: -pi <= y <= pi. y is NaN beyond 1e15, where an angle is not
   known to a tenth of a radian. */
pendres_coordinates pendres_coordinates_in(const pendres_pendulum *p, double x, double v);

/* In, with all turns left in y: for orbits, which stay together as one curve. */
pendres_coordinates pendres_coordinates_in_whole(const pendres_pendulum *p, double x, double v);

/* Out; v may be NULL. */
void pendres_coordinates_out(const pendres_pendulum *p, const pendres_coordinates *s, double *x,
                             double *v);

/* Take whole turns out of an angle: -pi <= y <= pi afterwards, or NaN where it is beyond 1e15. A
   coordinate without a period has none. */
void pendres_coordinates_wrap(const pendres_pendulum *p, double *y, long *turns);

/*
 * A state at the end of a period: whole turns are taken out. The motion of a damped pendulum
 * without a drive decays to denormal numbers and stays there, with steps that take forty times as
 * long: below 1e-290 it is set to zero.
 */
void pendres_coordinates_arrive(const pendres_pendulum *p, double *y, double *w, long *turns);

/* ---- blocks ---- */

/* A context's block, with fixed steps, for the use of one function at a time. */
typedef struct pendres_block {
  pendres_context *ctx;
  pendres_flow *flow;
  size_t lanes; /* in use */
} pendres_block;

/*
 * The context's block of a kind, with `steps` steps per period from now on. Here and below, the
 * context has the message of a failure.
 */
pendres_status pendres_block_open(pendres_context *ctx, pendres_flow_kind kind, int steps,
                                  pendres_block *out);

/* The number of lanes that it can hold. */
size_t pendres_block_capacity(const pendres_block *b);

/* Use `lanes` lanes from now on; those that were in use before and still are keep their states. */
void pendres_block_resize(pendres_block *b, size_t lanes);

/* Put a pendulum into a lane, at a state; rows of derivatives are reset. */
void pendres_block_load(pendres_block *b, size_t lane, const pendres_pendulum *p, double y,
                        double w);

/*
 * Start or stop propagating the errors of the block's lanes: see flow.h. The block must hold states
 * only; a lane's error is set after the lane has been loaded.
 */
pendres_status pendres_block_carry(pendres_block *b, int on);
void pendres_block_set_error(pendres_block *b, size_t lane, const pendres_flow_error *error,
                             double added);
pendres_flow_error pendres_block_get_error(const pendres_block *b, size_t lane);

/* Set the state of a lane and leave everything else as it is. */
void pendres_block_put_state(pendres_block *b, size_t lane, double y, double w);

/*
 * Start or stop propagating two tangent vectors of (y, w) in each lane; for blocks of states only,
 * with an even number of steps per period. They are set after the lane has been loaded. Their
 * growth over long times is correct to fourth order in the step: vector 0 uses the block's steps,
 * vector 1 steps twice as long (flow.h).
 */
pendres_status pendres_block_carry_tangents(pendres_block *b, int on);
void pendres_block_put_tangent(pendres_block *b, size_t lane, int which, const double tangent[2]);
void pendres_block_get_tangent(const pendres_block *b, size_t lane, int which, double tangent[2]);

/* Advance all lanes by one drive period, or by the first half of one; checks whether to go on, and
   counts the cost. */
pendres_status pendres_block_period(pendres_block *b);
pendres_status pendres_block_half_period(pendres_block *b);

/* Advance by a period, and pass the rows to sample() after each of its steps 1..n. */
typedef void pendres_block_sample(void *arg, int step, const pendres_rows *rows);
pendres_status pendres_block_period_sampled(pendres_block *b, pendres_block_sample *sample,
                                            void *arg);

/* The rows as they are, valid until the block is run or resized. */
pendres_rows pendres_block_rows(const pendres_block *b);

#endif
