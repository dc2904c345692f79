/* context.c -- options, workspace and last message; see context.h. */
#include "base/numbers.h"
#include "engine/context_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/sized.h"
#include "engine/accuracy.h"
#include "engine/block.h"
#include "engine/charts.h"
#include "engine/sundials/compat.h"
#include "engine/numbers.h"
#include "engine/steps.h"
#include "engine/kernels/tables.h"

/* NULL if the options are valid, otherwise what is wrong. */
static const char *resolve(pendres_options *o)
{
  if (PENDRES_SIZED_REFUSES(o) != NULL) return PENDRES_SIZED_REFUSES(o);
  if (o->tolerance == 0.0) o->tolerance = PENDRES_ACCURACY_DEFAULT;
  if (!(o->tolerance > 0.0 && isfinite(o->tolerance)))
    return "the tolerance must be above 0 and finite";
  if ((unsigned)o->method >= PENDRES_METHOD_COUNT) return "unknown method";
  if ((unsigned)o->table >= PENDRES_TABLE_COUNT) return "unknown table";
  if (o->table == PENDRES_TABLE_DEFAULT) o->table = PENDRES_TABLE_TP8;
  if (o->steps_per_period < 0 || o->steps_per_period > PENDRES_MOST_STEPS)
    return "the steps a period must be 1 to 1000000";
  if (o->block_lanes == 0) o->block_lanes = LANES_USUAL;
  if (o->block_lanes < 8 || o->block_lanes > LANES_MOST || o->block_lanes % 8 != 0)
    return "a block must have a multiple of 8 lanes, 8 to 4096";
  if (o->period_budget < 0) return "the budget of periods must be positive";
  if (!(o->exponent_error >= 0.0 && o->exponent_error <= 1.0))
    return "the wanted error of exponents must be between 0 and 1";
  if (o->threads < 0 || o->threads > PARTS_MOST_THREADS)
    return "the number of threads must be from 0 to 4096";
  if (o->threads == 0) o->threads = 1;
  return NULL;
}

pendres_status pendres_context_create(const pendres_options *options, pendres_context **out)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  pendres_context *ctx = calloc(1, sizeof *ctx);
  if (ctx == NULL) return status;
  pendres_guard_init(&ctx->guard);
  ctx->most_slopes = INFINITY;
  if (options != NULL) ctx->options = *options;
  ctx->tolerance_given = ctx->options.tolerance != 0.0;
  if (resolve(&ctx->options) != NULL) {
    status = PENDRES_INVALID_ARGUMENT;
    goto fail;
  }
  SUNContext sun = NULL;
  if (pendres_compat_context_create(&sun) != 0) goto fail;
  ctx->sun = sun;
  status = pendres_steps_memo_create(&ctx->steps);
  if (status != PENDRES_OK) goto fail;
  *out = ctx;
  return PENDRES_OK;
fail:
  pendres_context_free(ctx);
  return status;
}

const char *pendres_options_check(const pendres_options *options)
{
  pendres_options copy = {0};
  if (options != NULL) copy = *options;
  return resolve(&copy);
}

void pendres_context_free(pendres_context *ctx)
{
  if (ctx == NULL || pendres_guard_busy(&ctx->guard)) return;
  for (int i = 0; i < ctx->workers; i++) pendres_context_free(ctx->worker[i]);
  free(ctx->worker);
  for (int i = 0; i < PENDRES_FLOW_KINDS; i++) pendres_block_free(ctx->blocks[i]);
  pendres_steps_memo_free(ctx->steps);
  pendres_charts_memo_free(ctx->charts);
  SUNContext sun = ctx->sun;
  if (sun != NULL) SUNContext_Free(&sun);
  free(ctx);
}

const char *pendres_context_message(const pendres_context *ctx)
{
  return ctx != NULL ? pendres_guard_message(&ctx->guard)
                     : "no context could be created: see pendres_options_check";
}

const pendres_options *pendres_context_options(const pendres_context *ctx)
{
  return ctx != NULL ? &ctx->options : NULL;
}

void pendres_context_cost(const pendres_context *ctx, pendres_cost *cost)
{
  if (cost == NULL) return;
  *cost = (pendres_cost){ NAN, NAN, NAN, NAN, NAN };
  if (ctx == NULL || pendres_guard_used_elsewhere(&ctx->guard)) return;
  *cost = ctx->cost;
  for (int i = 0; i < PENDRES_FLOW_KINDS; i++)
    if (ctx->blocks[i] != NULL) {
      cost->rhs_evaluations += pendres_block_evaluations(ctx->blocks[i]);
      cost->steps += pendres_block_steps(ctx->blocks[i]);
    }
}

double pendres_context_slopes(const pendres_context *ctx)
{
  double slopes = ctx->cost.rhs_evaluations;
  for (int i = 0; i < PENDRES_FLOW_KINDS; i++)
    if (ctx->blocks[i] != NULL) slopes += pendres_block_evaluations(ctx->blocks[i]);
  return slopes;
}

pendres_uncounted pendres_uncounted_begin(pendres_context *ctx)
{
  pendres_uncounted work = {.most_slopes = ctx->most_slopes};
  pendres_context_cost(ctx, &work.before);
  ctx->most_slopes = INFINITY;
  return work;
}

void pendres_uncounted_end(pendres_context *ctx, const pendres_uncounted *work)
{
  pendres_cost now;
  pendres_context_cost(ctx, &now);
  ctx->most_slopes = work->most_slopes;
  pendres_cost_add(&now, -1.0, &work->before);
  pendres_cost_add(&ctx->cost, -1.0, &now);
}

void pendres_context_cost_reset(pendres_context *ctx)
{
  pendres_cost now;
  if (ctx == NULL || pendres_guard_busy(&ctx->guard)) return;
  ctx->cost.rhs_evaluations = 0.0;
  ctx->cost.steps = 0.0;
  pendres_context_cost(ctx, &now);
  ctx->cost = (pendres_cost){.rhs_evaluations = -now.rhs_evaluations, .steps = -now.steps};
}

void pendres_context_set_interrupt(pendres_context *ctx, int (*stop)(void *arg), void *arg)
{
  if (ctx == NULL || pendres_guard_busy(&ctx->guard)) return;
  ctx->stop = stop;
  ctx->stop_arg = arg;
}

void pendres_context_set_keep(pendres_context *ctx, const pendres_keep *keep)
{
  if (ctx == NULL || pendres_guard_busy(&ctx->guard)) return;
  ctx->keep = keep != NULL ? *keep : (pendres_keep){.due = NULL};
}

pendres_status pendres_context_poll(pendres_context *ctx)
{
  if (ctx->most_slopes < INFINITY && pendres_context_slopes(ctx) > ctx->most_slopes)
    return pendres_context_fail(ctx, PENDRES_INTERRUPTED, "more work than is worth it");
  if (!pendres_context_stops(ctx)) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INTERRUPTED, "interrupted on request");
}

int pendres_context_stops(void *arg)
{
  pendres_context *ctx = arg;
  if (ctx->stop == NULL) return 0;
  pendres_guard_ask(&ctx->guard, 1);
  const int stopped = ctx->stop(ctx->stop_arg) != 0;
  pendres_guard_ask(&ctx->guard, 0);
  return stopped;
}

pendres_status pendres_context_fail(pendres_context *ctx, pendres_status status,
                                    const char *format, ...)
{
  va_list args;
  va_start(args, format);
  (void)pendres_guard_fail(&ctx->guard, status, format, args);
  va_end(args);
  return status;
}
