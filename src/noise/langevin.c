/* langevin.c -- handle of noisy ensembles, and advancing them; see langevin.h. */
#include "noise/langevin_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "engine/passage.h"

/* A position beyond is not known to a tenth of a radian; see strobe_run.h. */
static const double farthest = 1e15;

enum { DEFAULT_STEPS = 24, MOST_STEPS = 1000000, DEFAULT_LANES = 192, MOST_LANES = 4096 };

static const char *check_steps(int steps)
{
  if (steps < 2 || steps > MOST_STEPS) return "the steps a period must be 2 to 1000000";
  return NULL;
}

/* NULL when all is well, else what is wrong. */
static const char *resolve(pendres_langevin_options *o)
{
  if (o->steps_per_period == 0) o->steps_per_period = DEFAULT_STEPS;
  if (o->block_lanes == 0) o->block_lanes = DEFAULT_LANES;
  if (o->block_lanes < 8 || o->block_lanes > MOST_LANES || o->block_lanes % 8 != 0)
    return "a block must have a multiple of 8 lanes, 8 to 4096";
  return check_steps(o->steps_per_period);
}

const char *pendres_langevin_options_check(const pendres_langevin_options *options)
{
  pendres_langevin_options copy = {0};
  if (options != NULL) copy = *options;
  return resolve(&copy);
}

/* For the block, which asks within long periods. */
static int stops(void *lv)
{
  return pendres_langevin_poll(lv) != PENDRES_OK;
}

pendres_status pendres_langevin_create(const pendres_langevin_options *options,
                                       pendres_langevin **out)
{
  pendres_status status = PENDRES_INVALID_ARGUMENT;
  pendres_langevin *lv = NULL;

  if (out == NULL) return status;
  *out = NULL;
  lv = calloc(1, sizeof *lv);
  if (lv == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_guard_init(&lv->guard);
  if (options != NULL) lv->options = *options;
  if (resolve(&lv->options) != NULL) goto fail;
  status = pendres_langevin_block_make(&lv->block, (size_t)lv->options.block_lanes,
                                       lv->options.seed);
  if (status != PENDRES_OK) goto fail;
  lv->block.stop = stops;
  lv->block.stop_arg = lv;
  status = pendres_langevin_set_steps(lv, lv->options.steps_per_period);
  if (status != PENDRES_OK) goto fail;
  *out = lv;
  return PENDRES_OK;
fail:
  pendres_langevin_free(lv);
  return status;
}

void pendres_langevin_free(pendres_langevin *lv)
{
  if (lv == NULL || pendres_guard_busy(&lv->guard)) return;
  pendres_langevin_block_clear(&lv->block);
  pendres_langevin_block_clear(&lv->partner);
  free(lv);
}

const char *pendres_langevin_message(const pendres_langevin *lv)
{
  return lv != NULL ? pendres_guard_message(&lv->guard)
                    : "no handle could be created: see pendres_langevin_options_check";
}

int pendres_langevin_steps(const pendres_langevin *lv)
{
  return lv != NULL ? lv->options.steps_per_period : 0;
}

static pendres_status set_steps(pendres_langevin *lv, int steps_per_period)
{
  const char *wrong = check_steps(steps_per_period);
  if (wrong != NULL) return pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  const pendres_status status = pendres_langevin_block_set_steps(&lv->block, steps_per_period);
  if (status != PENDRES_OK)
    return pendres_langevin_fail(lv, status, "no memory for %d steps", steps_per_period);
  lv->options.steps_per_period = steps_per_period;
  return PENDRES_OK;
}

pendres_status pendres_langevin_set_steps(pendres_langevin *lv, int steps_per_period)
{
  return PENDRES_LANGEVIN_CALL(lv, set_steps(lv, steps_per_period));
}

double pendres_langevin_spent(const pendres_langevin *lv)
{
  return lv != NULL && !pendres_guard_used_elsewhere(&lv->guard) ? lv->spent : NAN;
}

void pendres_langevin_count(pendres_langevin *lv, const pendres_langevin_block *b)
{
  const double n = (double)b->count;
  lv->cost.pendulum_periods += n;
  lv->cost.steps += n * b->steps;
  lv->cost.rhs_evaluations += 2.0 * n * b->steps; /* a step has two kicks, each by one force */
}

void pendres_langevin_cost(const pendres_langevin *lv, pendres_cost *cost)
{
  if (cost == NULL) return;
  *cost = (pendres_cost){ NAN, NAN, NAN, NAN, NAN };
  if (lv != NULL && !pendres_guard_used_elsewhere(&lv->guard)) *cost = lv->cost;
}

void pendres_langevin_set_interrupt(pendres_langevin *lv, int (*stop)(void *arg), void *arg)
{
  if (lv == NULL || pendres_guard_busy(&lv->guard)) return;
  lv->stop = stop;
  lv->stop_arg = arg;
}

pendres_status pendres_langevin_fail(pendres_langevin *lv, pendres_status status,
                                     const char *format, ...)
{
  va_list args;
  va_start(args, format);
  (void)pendres_guard_fail(&lv->guard, status, format, args);
  va_end(args);
  return status;
}

pendres_status pendres_langevin_poll(pendres_langevin *lv)
{
  if (lv->stop == NULL) return PENDRES_OK;
  pendres_guard_ask(&lv->guard, 1);
  const int stopped = lv->stop(lv->stop_arg) != 0;
  pendres_guard_ask(&lv->guard, 0);
  if (!stopped) return PENDRES_OK;
  return pendres_langevin_fail(lv, PENDRES_INTERRUPTED, "interrupted on request");
}

pendres_status pendres_langevin_accept(pendres_langevin *lv, const pendres_pendulum *p, double x,
                                       double v, size_t index)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) == PENDRES_OK) {
    why = pendres_passage_refuses(p, x, v);
    if (why == NULL) why = pendres_langevin_block_refuses(p, lv->options.steps_per_period);
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT, "trajectory %zu: %s", index, why);
}

pendres_status pendres_langevin_accept_periods(pendres_langevin *lv, long first, long periods)
{
  /* Periods count in 32 bits of the generator's counter. */
  if (first >= 0 && periods >= 0 && periods <= (long)UINT32_MAX && first <= (long)UINT32_MAX &&
      first + periods <= (long)UINT32_MAX)
    return PENDRES_OK;
  return pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT,
                               "periods must be from 0 to 4294967295");
}

/* Show a strobe to the observer. */
static pendres_langevin_answer show(pendres_langevin *lv, size_t first, long period,
                                    const pendres_langevin_observer *observer)
{
  const pendres_langevin_block *b = &lv->block;
  const pendres_langevin_strobe strobe = {
    .first = first, .count = b->count, .period = period, .x = b->x, .v = b->v,
    .cosine = b->harmonics ? b->cosine : NULL, .sine = b->harmonics ? b->sine : NULL,
    .work = b->harmonics ? b->work : NULL};
  pendres_guard_ask(&lv->guard, 1);
  const pendres_langevin_answer answer = observer->see(observer->arg, &strobe);
  pendres_guard_ask(&lv->guard, 0);
  return answer;
}

/* All periods of the block's trajectories, the first of which is number `first`. */
static pendres_status run(pendres_langevin *lv, size_t first, long first_period, long periods,
                          const pendres_langevin_observer *observer)
{
  pendres_langevin_block *b = &lv->block;
  for (long k = 0; k < periods; k++) {
    pendres_status status = pendres_langevin_poll(lv);
    if (status == PENDRES_OK)
      status = pendres_langevin_block_period(b, (uint32_t)(first_period + k));
    if (status != PENDRES_OK) return status;
    lv->spent += (double)b->count;
    pendres_langevin_count(lv, b);
    if (observer == NULL) continue;
    switch (show(lv, first, first_period + k + 1, observer)) {
    case PENDRES_LANGEVIN_GO_ON: break;
    case PENDRES_LANGEVIN_ENOUGH: return PENDRES_OK;
    default: return pendres_langevin_fail(lv, PENDRES_INTERRUPTED, "interrupted by the observer");
    }
  }
  return PENDRES_OK;
}

static pendres_status advance(pendres_langevin *lv, size_t n, const pendres_pendulum *pendulums,
                              const uint64_t *ids, long first_period, long periods, double *x,
                              double *v, const pendres_langevin_observer *observer)
{
  if (n > 0 && (pendulums == NULL || x == NULL || v == NULL))
    return PENDRES_LANGEVIN_NULL(lv, "pendulums, x and v");
  if (observer != NULL && observer->see == NULL)
    return PENDRES_LANGEVIN_NULL(lv, "the observer's see()");
  pendres_langevin_block *b = &lv->block;
  double *end = NULL;
  pendres_status status = pendres_langevin_accept_periods(lv, first_period, periods);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = pendres_langevin_accept(lv, &pendulums[i], x[i], v[i], i);
  if (status != PENDRES_OK || n == 0) return status;

  /* The caller's arrays stay as they are until nothing can fail any more. */
  end = malloc(2 * n * sizeof *end);
  if (end == NULL)
    return pendres_langevin_fail(lv, PENDRES_OUT_OF_MEMORY, "out of memory: %zu trajectories", n);
  b->harmonics = observer != NULL && observer->harmonics;
  for (size_t first = 0; first < n; first += b->count) {
    pendres_langevin_block_resize(b, n - first < b->capacity ? n - first : b->capacity);
    for (size_t i = 0; i < b->count; i++)
      pendres_langevin_block_load(b, i, &pendulums[first + i],
                                  ids != NULL ? ids[first + i] : first + i, x[first + i],
                                  v[first + i]);
    pendres_langevin_block_finish(b);
    status = run(lv, first, first_period, periods, observer);
    if (status != PENDRES_OK) goto done;
    for (size_t i = 0; i < b->count; i++)
      if (!(fabs(b->x[i]) <= farthest && isfinite(b->v[i]))) {
        status = pendres_langevin_fail(lv, PENDRES_INTEGRATION_FAILED,
                                       "trajectory %zu went beyond 1e15, where its angle is not "
                                       "known in double precision", first + i);
        goto done;
      }
    memcpy(end + first, b->x, b->count * sizeof *end);
    memcpy(end + n + first, b->v, b->count * sizeof *end);
  }
  memcpy(x, end, n * sizeof *x);
  memcpy(v, end + n, n * sizeof *v);
done:
  free(end);
  return status;
}

pendres_status pendres_langevin_advance(pendres_langevin *lv, size_t n,
                                        const pendres_pendulum *pendulums, const uint64_t *ids,
                                        long first_period, long periods, double *x, double *v,
                                        const pendres_langevin_observer *observer)
{
  return PENDRES_LANGEVIN_CALL(
    lv, advance(lv, n, pendulums, ids, first_period, periods, x, v, observer));
}
