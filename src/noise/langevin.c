/* langevin.c -- advancing noisy trajectories; see langevin.h. */
#include "noise/langevin_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/kernels/coordinates.h"
#include "model/equation.h"
#include "model/model.h"
#include "noise/noise_common.h"

int pendres_langevin_resolve_steps(const pendres_context *ctx, int steps)
{
  if (steps == 0) steps = ctx->options.steps_per_period;
  return steps != 0 ? steps : PENDRES_LANGEVIN_STEPS;
}

pendres_status pendres_langevin_open(pendres_context *ctx, size_t trajectories, int steps,
                                     pendres_langevin_block *b)
{
  size_t lanes = (size_t)ctx->options.block_lanes;
  if (lanes > PENDRES_NOISE_LANES) lanes = PENDRES_NOISE_LANES;
  if (lanes > trajectories) lanes = (trajectories + 7) / 8 * 8;
  pendres_status status = pendres_langevin_block_make(b, lanes, ctx->options.seed);
  if (status == PENDRES_OK) status = pendres_langevin_block_set_steps(b, steps);
  b->stop = pendres_context_stops;
  b->stop_arg = ctx;
  if (status == PENDRES_OK) return status;
  return pendres_context_fail(ctx, status, "out of memory for %zu noisy trajectories of %d steps",
                              lanes, steps);
}

void pendres_langevin_count(pendres_context *ctx, const pendres_langevin_block *b)
{
  const double n = (double)b->count;
  ctx->cost.pendulum_periods += n;
  ctx->cost.steps += n * b->steps;
  ctx->cost.rhs_evaluations += 2.0 * n * b->steps; /* a step has two kicks, each by one force */
}

pendres_status pendres_langevin_accept(pendres_context *ctx, const pendres_pendulum *p, double x,
                                       double v, int steps, size_t index)
{
  const char *why = NULL;
  if (steps < 2 || steps > PENDRES_MOST_STEPS)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "the steps a period must be 2 to %d", PENDRES_MOST_STEPS);
  if (pendres_pendulum_check(p, &why) == PENDRES_OK) {
    why = pendres_coordinates_refuses(p, x, v);
    if (why == NULL) why = pendres_equation_refuses_drag(p);
    if (why == NULL) why = pendres_langevin_block_refuses(p, steps);
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "trajectory %zu: %s", index, why);
}

pendres_status pendres_langevin_accept_periods(pendres_context *ctx, long first, long periods)
{
  /* Periods count in 32 bits of the generator's counter. */
  if (first >= 0 && periods >= 0 && periods <= (long)UINT32_MAX && first <= (long)UINT32_MAX &&
      first + periods <= (long)UINT32_MAX)
    return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                              "periods must be from 0 to 4294967295");
}

pendres_langevin_answer pendres_langevin_show(pendres_context *ctx,
                                              const pendres_langevin_block *b, size_t first,
                                              long period,
                                              const pendres_langevin_observer *observer)
{
  const pendres_langevin_strobe strobe = {
    .first = first, .count = b->count, .period = period, .x = b->x, .v = b->v,
    .cosine = b->harmonics ? b->cosine : NULL, .sine = b->harmonics ? b->sine : NULL,
    .work = b->harmonics ? b->work : NULL};
  pendres_guard_ask(&ctx->guard, 1);
  const pendres_langevin_answer answer = observer->see(observer->arg, &strobe);
  pendres_guard_ask(&ctx->guard, 0);
  return answer;
}

/* All periods of the block's trajectories; the number of the first trajectory is `first`. */
static pendres_status follow(pendres_context *ctx, pendres_langevin_block *b, size_t first,
                             const pendres_langevin_run *run)
{
  for (long k = run->first_period; k < run->first_period + run->periods; k++) {
    pendres_status status = pendres_context_poll(ctx);
    if (status == PENDRES_OK) status = pendres_langevin_block_period(b, (uint32_t)k);
    if (status != PENDRES_OK) return status;
    pendres_langevin_count(ctx, b);
    if (run->observer == NULL) continue;
    switch (pendres_langevin_show(ctx, b, first, k + 1, run->observer)) {
    case PENDRES_LANGEVIN_GO_ON: break;
    case PENDRES_LANGEVIN_ENOUGH: return PENDRES_OK;
    default: return pendres_context_fail(ctx, PENDRES_INTERRUPTED, "interrupted by the observer");
    }
  }
  return PENDRES_OK;
}

/* Trajectories from number `first` on, as many as have the same terms in their force and as the
 * block has room for. */
static void load(pendres_langevin_block *b, size_t first, const pendres_langevin_run *run,
                 const double *x, const double *v)
{
  const pendres_model_terms terms = pendres_model_kind(&run->pendulums[first]);
  size_t count = 1;
  while (count < b->capacity && first + count < run->n &&
         pendres_model_kind(&run->pendulums[first + count]) == terms)
    count++;
  pendres_langevin_block_resize(b, count);
  for (size_t i = 0; i < b->count; i++)
    pendres_langevin_block_load(b, i, &run->pendulums[first + i],
                                run->ids != NULL ? run->ids[first + i] : first + i, x[first + i],
                                v[first + i]);
  pendres_langevin_block_finish(b);
}

pendres_status pendres_langevin_check_ends(pendres_context *ctx, const pendres_langevin_block *b,
                                           size_t first)
{
  for (size_t i = 0; i < b->count; i++)
    if (!(fabs(b->x[i]) <= pendres_farthest && isfinite(b->v[i])))
      return pendres_context_fail(ctx, PENDRES_INTEGRATION_FAILED,
                                  "trajectory %zu went beyond 1e15, where its angle is not "
                                  "known in double precision", first + i);
  return PENDRES_OK;
}

/* All trajectories; their last states go to end[2 n]. */
static pendres_status advance_all(pendres_context *ctx, const pendres_langevin_run *run, int steps,
                                  const double *x, const double *v, double *end)
{
  pendres_langevin_block b = {0};
  pendres_status status = pendres_langevin_open(ctx, run->n, steps, &b);
  b.harmonics = run->observer != NULL && run->observer->harmonics;
  for (size_t first = 0; first < run->n && status == PENDRES_OK; first += b.count) {
    load(&b, first, run, x, v);
    status = follow(ctx, &b, first, run);
    if (status == PENDRES_OK && !run->unbounded)
      status = pendres_langevin_check_ends(ctx, &b, first);
    memcpy(end + first, b.x, b.count * sizeof *end);
    memcpy(end + run->n + first, b.v, b.count * sizeof *end);
  }
  pendres_langevin_block_clear(&b);
  return status;
}

static pendres_status advance(pendres_context *ctx, const pendres_langevin_run *run, double *x,
                              double *v)
{
  if (run == NULL) return PENDRES_CONTEXT_NULL(ctx, "run");
  if (run->n > 0 && (run->pendulums == NULL || x == NULL || v == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x and v");
  if (run->observer != NULL && run->observer->see == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "the observer's see()");
  const int steps = pendres_langevin_resolve_steps(ctx, run->steps_per_period);
  const size_t n = run->n;
  pendres_status status = pendres_langevin_accept_periods(ctx, run->first_period, run->periods);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = pendres_langevin_accept(ctx, &run->pendulums[i], x[i], v[i], steps, i);
  if (status != PENDRES_OK || n == 0) return status;

  /* The caller's arrays stay as they are until nothing can fail any more. */
  double *end = malloc(2 * n * sizeof *end);
  if (end == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory: %zu trajectories", n);
  status = advance_all(ctx, run, steps, x, v, end);
  if (status == PENDRES_OK) {
    memcpy(x, end, n * sizeof *x);
    memcpy(v, end + n, n * sizeof *v);
  }
  free(end);
  return status;
}

/* The ids of trajectories from the number `first` on that have none. */
static const uint64_t *count_up(pendres_door *d, size_t first, size_t n)
{
  uint64_t *ids = pendres_door_memory(d, n * sizeof *ids);
  for (size_t i = 0; i < n && ids != NULL; i++) ids[i] = first + i;
  return ids;
}

pendres_status pendres_langevin_advance(pendres_context *ctx, const pendres_langevin_run *run,
                                        double *x, double *v)
{
  pendres_door d =
    pendres_door_open_many(ctx, run != NULL ? run->n : 0, run != NULL ? run->pendulums : NULL,
                           sizeof *run->pendulums);
  while (pendres_door_next(&d)) {
    const size_t i = d.first, m = d.count;
    pendres_langevin_run part = {.n = 0};
    pendres_noise_window window;
    double *x_out = pendres_door_out_run(&d, &pendres_dim_length, x);
    double *v_out = pendres_door_out_run(&d, &pendres_dim_speed, v);
    if (run != NULL) {
      part = *run;
      part.n = m;
      part.pendulums = pendres_door_in_run(&d, &pendres_dim_pendulum, run->pendulums);
      part.ids = i > 0 && run->ids == NULL ? count_up(&d, i, m) : PENDRES_DOOR_AT(run->ids, i);
      part.observer = pendres_noise_observer(&d, run->observer, &window);
    }
    PENDRES_DOOR_CALL(&d, advance(ctx, run != NULL ? &part : NULL, x_out, v_out));
  }
  return pendres_door_close(&d);
}

/* ---- The caller's functions ----------------------------------------------------------------- */

enum { ROWS = 5 /* x, v, cosine, sine and work */ };

/* A row of a strobe in the caller's units. */
static const double *shown(const pendres_noise_window *w, int row, const pendres_dimensions *kind,
                           size_t n, const double *values)
{
  double *to = w->memory + (size_t)row * w->room;
  if (values == NULL) return NULL;
  memcpy(to, values, n * sizeof *to);
  pendres_units_out(&w->door->scales, kind, n, to);
  return to;
}

/* A strobe as the caller sees it; 0: out of memory. */
static int look(pendres_noise_window *w, const pendres_langevin_strobe *strobe,
                pendres_langevin_strobe *out)
{
  const size_t n = strobe->count;
  *out = *strobe;
  out->first += w->door->first;
  if (!pendres_door_changes(w->door)) return 1;
  if (n > w->room) {
    w->memory = pendres_door_memory(w->door, ROWS * n * sizeof *w->memory);
    w->room = w->memory != NULL ? n : 0;
  }
  if (w->memory == NULL) return 0;
  out->x = shown(w, 0, &pendres_dim_length, n, strobe->x);
  out->v = shown(w, 1, &pendres_dim_speed, n, strobe->v);
  out->cosine = shown(w, 2, &pendres_dim_length, n, strobe->cosine);
  out->sine = shown(w, 3, &pendres_dim_length, n, strobe->sine);
  out->work = shown(w, 4, &pendres_dim_energy, n, strobe->work);
  return 1;
}

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *strobe)
{
  pendres_noise_window *w = arg;
  pendres_langevin_strobe s;
  if (!look(w, strobe, &s)) return PENDRES_LANGEVIN_STOP;
  return w->observer->see(w->observer->arg, &s);
}

static void leave(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  pendres_noise_window *w = arg;
  pendres_langevin_strobe s;
  if (look(w, strobe, &s)) w->request->leave(w->request->arg, &s, left);
}

const pendres_langevin_observer *pendres_noise_observer(pendres_door *d,
                                                        const pendres_langevin_observer *observer,
                                                        pendres_noise_window *window)
{
  if (observer == NULL || observer->see == NULL || (!pendres_door_changes(d) && d->first == 0))
    return observer;
  *window = (pendres_noise_window){.door = d, .observer = observer, .through = *observer};
  window->through.see = see;
  window->through.arg = window;
  return &window->through;
}

const pendres_langevin_request *pendres_noise_request(pendres_door *d,
                                                      const pendres_langevin_request *request,
                                                      pendres_noise_window *window,
                                                      pendres_langevin_request *inside)
{
  if (request == NULL || !pendres_door_changes(d)) return request;
  *window = (pendres_noise_window){.door = d, .request = request};
  *inside = *request;
  pendres_units_in(&d->scales, &pendres_dim_langevin_request, 1, inside);
  if (request->leave != NULL) {
    inside->leave = leave;
    inside->arg = window;
  }
  return inside;
}
