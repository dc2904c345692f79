/*
 * context_internal.h -- what the modules of the library share through a context.
 *
 * Owns: nothing; pendres_context is laid out here so that each module can keep
 * its workspace in it.
 */
#ifndef PENDRES_CONTEXT_INTERNAL_H
#define PENDRES_CONTEXT_INTERNAL_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include "base/guard.h"

/* The blocks of a context, all with fixed steps. */
typedef enum pendres_flow_kind {
  PENDRES_FLOW_STATE,
  PENDRES_FLOW_VARIATIONAL,
  PENDRES_FLOW_SENSITIVITY,
  PENDRES_FLOW_DRIVES, /* sensitivities to torque and parametric drive as well */
  PENDRES_FLOW_FORCE,  /* and to the coefficients of a polynomial force */
  PENDRES_FLOW_ALL,    /* and to other friction */
  PENDRES_FLOW_KINDS
} pendres_flow_kind;

struct pendres_steps_memo;  /* steps.h */
struct pendres_charts_memo; /* charts.h */
typedef struct pendres_block pendres_block; /* block.h */

struct pendres_context {
  pendres_guard guard;
  pendres_options options; /* defaults resolved; the tolerance is canonical while a door is open */
  int tolerance_given; /* the tolerance is the caller's, not the default of canonical units */
  int canonical;       /* a door (door.h) is open: all is in canonical units */
  void *sun;           /* a SUNContext, for the blocks */
  pendres_block *blocks[PENDRES_FLOW_KINDS];
  pendres_context **worker; /* of a call's threads (threads.h), kept from one call to the next */
  int workers;
  struct pendres_steps_memo *steps;
  struct pendres_charts_memo *charts; /* NULL: none so far */
  pendres_cost cost;
  double most_slopes;    /* pendres_context_slopes at which a computation ends; INFINITY: never */
  int (*stop)(void *arg);
  void *stop_arg;
  pendres_keep keep;      /* keep.h */
};

/* Add a cost so many times, -1 to take it back: whole numbers, whose sums are exact. */
static inline void pendres_cost_add(pendres_cost *sum, double times, const pendres_cost *one)
{
  sum->pendulum_periods += times * one->pendulum_periods;
  sum->rhs_evaluations += times * one->rhs_evaluations;
  sum->steps += times * one->steps;
  sum->newton_steps += times * one->newton_steps;
  sum->settled_pendulums += times * one->settled_pendulums;
}

/* The body of a public function that computes with a context; see guard.h. */
#define PENDRES_CONTEXT_CALL(ctx, call) \
  PENDRES_GUARD_CALL((ctx) != NULL ? &(ctx)->guard : NULL, call)

/* Refuse arguments that are NULL; `names` is the sentence's beginning. */
#define PENDRES_CONTEXT_NULL(ctx, names) \
  pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s must not be NULL", names)

/*
 * Evaluations of the slope so far, counted for each lane, without those that went into choosing
 * steps or making charts. This measure of work does not depend on what the context did before, nor
 * on the size of its blocks. One evaluation with its overhead takes about 2.5e-9 seconds.
 */
double pendres_context_slopes(const pendres_context *ctx);

/*
 * Work between begin and end does not count, nor is it bounded by most_slopes: that of finding out
 * what a context keeps, as steps and charts, so that the cost of a computation does not depend on
 * those before it.
 */
typedef struct pendres_uncounted {
  pendres_cost before;
  double most_slopes;
} pendres_uncounted;

pendres_uncounted pendres_uncounted_begin(pendres_context *ctx);
void pendres_uncounted_end(pendres_context *ctx, const pendres_uncounted *work);

/* Record why something failed, and return the status. */
pendres_status pendres_context_fail(pendres_context *ctx, pendres_status status,
                                    const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/*
 * To be called between drive periods: PENDRES_INTERRUPTED when the caller asked to stop, and beyond
 * ctx->most_slopes. A function that sets most_slopes compares the slopes at the end as well: when
 * this function is called depends on the size of blocks, but the total number of slopes does not.
 */
pendres_status pendres_context_poll(pendres_context *ctx);
/* Whether the caller asked to stop, as a function that can be handed to others; ctx is a context.
 */
int pendres_context_stops(void *ctx);

#endif
