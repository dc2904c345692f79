/* uncertainty.c -- the uncertainty exponent from random states; see basin.h. */
#include <pendres/basin.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/basins/numbers.h"
#include "base/mix.h"
#include "settling/attractor_internal.h"
#include "analysis/basins/scatter.h"
#include "analysis/basins/uncertainty.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "engine/threads.h"
#include "settling/settle.h"

/* State number i of a sample and its neighbours: 1 + 2 * scales of x and v. */
static void place(const pendres_basin_window *w, const pendres_basin_sample *s, uint64_t i,
                  double *x, double *v)
{
  const double at_x = w->x_low + (w->x_high - w->x_low) * pendres_mix_uniform(s->seed, 2 * i);
  const double at_v = w->v_low + (w->v_high - w->v_low) * pendres_mix_uniform(s->seed, 2 * i + 1);
  for (int k = 0; k <= 2 * s->scales; k++) x[k] = at_x;
  v[0] = at_v;
  for (int k = 0; k < s->scales; k++) {
    v[1 + 2 * k] = at_v - s->distance[k];
    v[2 + 2 * k] = at_v + s->distance[k];
  }
}

static int are_unlike(const pendres_settled *a, const pendres_settled *b, pendres_basin_end by)
{
  return a->attractor != b->attractor ||
         (by == PENDRES_BASIN_BY_WELL && a->attractor >= 0 && a->well != b->well);
}

static int is_unknown(const pendres_settled *o)
{
  return o->attractor == PENDRES_ATTRACTOR_UNKNOWN;
}

/* Count one state and its neighbours: outcome[0] its own, then two a distance. Each state is a
   group of its own, since states know nothing of one another. */
static void count_sample(pendres_scatter *s, int scales, pendres_basin_end by,
                         const pendres_settled *outcome)
{
  double unlike[PENDRES_SCATTER_QUANTITIES] = {0.0};
  for (int k = 0; k < scales; k++) {
    const pendres_settled *one = &outcome[1 + 2 * k], *two = one + 1;
    unlike[k] = are_unlike(&outcome[0], one, by) || are_unlike(&outcome[0], two, by);
    if (is_unknown(&outcome[0]) || is_unknown(one) || is_unknown(two))
      s->unknown[k] += 1.0;
    else if (!(outcome[0].certain && one->certain && two->certain))
      s->uncertain[k] += 1.0;
  }
  pendres_scatter_add(s, unlike);
}

/* Shares and exponent of what has been counted. */
static void conclude(const pendres_scatter *s, pendres_basin_statistics *out)
{
  double tried[PENDRES_BASIN_SCALES];
  const double n = (double)out->states;
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++) {
    const double share = k < out->scales ? s->total[k] / n : NAN;
    tried[k] = n;
    out->uncertain[k] = share;
    /* Not below one state in all of them: none or all that are alike is no certainty. */
    out->uncertain_error[k] =
      fmax(sqrt(share * (1.0 - share) / n + s->uncertain[k] / (n * n)), 1.0 / n) +
      s->unknown[k] / n;
  }
  pendres_scatter_exponent(s, out->scales, out->distance, tried, &out->uncertainty_exponent,
                           &out->uncertainty_exponent_error);
}

/*
 * Whether more states may yet give an exponent: whether at enough distances the share of uncertain
 * states may be below one half, with five standard deviations to spare.
 */
static int hopeful(const pendres_scatter *s, double states, int scales)
{
  int below = 0;
  for (int k = 0; k < scales; k++) below += s->total[k] <= 0.5 * states + 2.5 * sqrt(states);
  return below >= PENDRES_SCATTER_LEAST_SCALES;
}

typedef struct sample {
  const pendres_attractors *set;
  const pendres_basin_window *window;
  const pendres_basin_sample *of;
  size_t begin, each; /* number of the first state of those below; of a state and its neighbours */
  double *x, *v; /* a state and its neighbours, one after the other */
  pendres_settled *outcome;
} sample;

/* States of those that are settled next, by their numbers among these. */
static pendres_status settle_part(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  const sample *a = arg;
  const size_t at = first * a->each;
  for (size_t i = 0; i < count; i++)
    place(a->window, a->of, (uint64_t)(a->begin + first + i), &a->x[at + i * a->each],
          &a->v[at + i * a->each]);
  const pendres_settle_starts starts = {.n = count * a->each, .x = a->x + at, .v = a->v + at};
  return pendres_settle_known(ctx, a->set->attractor_sets, &starts, pendres_accuracy_to_sample(),
                              PENDRES_SETTLE_FULL, a->outcome + at);
}

/* Settle the next `count` states of a sample, with their neighbours. */
static pendres_status settle_some(pendres_context *ctx, sample *a, size_t count,
                                  pendres_scatter *counts, pendres_basin_statistics *out)
{
  a->begin = out->states;
  a->each = 1 + 2 * (size_t)out->scales;
  const pendres_status status = pendres_threads_run(ctx, count, SAMPLE_TOGETHER, settle_part, a);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < count; i++) {
    const pendres_settled *own = &a->outcome[i * a->each];
    out->unresolved += is_unknown(own);
    out->uncertain_states += !is_unknown(own) && !own->certain;
    count_sample(counts, out->scales, a->window->by, own);
  }
  out->states += count;
  return status;
}

/* How many states are settled next: as many as the work that is left allows, judged by what the
   others took. */
static size_t next_count(size_t left, size_t done, double spent, double most)
{
  size_t count = done == 0 ? SAMPLE_FIRST : SAMPLE_AT_A_TIME;
  if (count > left) count = left;
  const double affordable = done == 0 ? (double)count : (most - spent) / spent * (double)done;
  return affordable >= (double)count ? count : affordable >= 1.0 ? (size_t)affordable : 0;
}

/* Settle the n states of a sample, or as many of them as the work allows: out->states. */
static pendres_status settle_sample(pendres_context *ctx, sample *a, size_t n, double most,
                                    pendres_scatter *counts, pendres_basin_statistics *out)
{
  const double before = pendres_context_slopes(ctx);
  double spent = 0.0;
  pendres_status status = PENDRES_OK;
  while (out->states < n && status == PENDRES_OK) {
    const size_t count = next_count(n - out->states, out->states, spent, most);
    if (count == 0) break;
    status = settle_some(ctx, a, count, counts, out);
    spent = pendres_context_slopes(ctx) - before;
    if (!hopeful(counts, (double)out->states, out->scales)) break;
  }
  return status;
}

static pendres_status compute_sample(pendres_context *ctx, sample *a, size_t n, double most,
                                     pendres_basin_statistics *out)
{
  const size_t at_a_time = n < SAMPLE_AT_A_TIME ? n : SAMPLE_AT_A_TIME;
  const size_t most_states = at_a_time * (1 + 2 * (size_t)out->scales);
  pendres_scatter counts = {0};
  pendres_room room = pendres_room_open(ctx, "random states");
  a->x = pendres_room_take(&room, most_states, sizeof *a->x);
  a->v = pendres_room_take(&room, most_states, sizeof *a->v);
  a->outcome = pendres_room_take(&room, most_states, sizeof *a->outcome);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = settle_sample(ctx, a, n, most, &counts, out);
  if (status == PENDRES_OK) conclude(&counts, out);
  return pendres_room_close(&room, status);
}

pendres_status pendres_basin_uncertainty_within(pendres_context *ctx, double most,
                                                const pendres_attractors *set,
                                                const pendres_basin_window *window,
                                                const pendres_basin_sample *asked,
                                                pendres_basin_statistics *out)
{
  if (set == NULL || window == NULL || asked == NULL || asked->distance == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, window, sample, its distances and out");
  const size_t n = asked->n;
  const int scales = asked->scales;
  const double *distance = asked->distance;
  if (n < SAMPLE_LEAST || scales < PENDRES_SCATTER_LEAST_SCALES || scales > PENDRES_BASIN_SCALES ||
      set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an uncertainty exponent needs states and at least %d distances",
                                PENDRES_SCATTER_LEAST_SCALES);
  int bad = (window->by != PENDRES_BASIN_BY_ATTRACTOR && window->by != PENDRES_BASIN_BY_WELL) ||
            !(window->x_low < window->x_high && window->v_low < window->v_high &&
              fmax(fmax(fabs(window->x_low), fabs(window->x_high)),
                   fmax(fabs(window->v_low), fabs(window->v_high))) <= 1e15);
  for (int k = 0; k < scales; k++) bad |= !(distance[k] > 0.0 && distance[k] <= 1e15);
  if (bad)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an uncertainty exponent needs a window and positive distances");
  *out = (pendres_basin_statistics){.scales = scales,
                                    .entropy = NAN, .entropy_error = NAN, .boundary_entropy = NAN,
                                    .boundary_entropy_error = NAN, .boundary_boxes = NAN};
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++)
    out->distance[k] = k < scales ? distance[k] : NAN;
  sample a = {.set = set, .window = window, .of = asked};
  const pendres_status status = compute_sample(ctx, &a, n, most, out);
  if (status != PENDRES_OK) return status;
  if (isnan(out->uncertainty_exponent))
    return pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                                "at too few of the distances the boundary is met often enough, "
                                "and by fewer than half of %zu states%s", out->states,
                                out->states < n ? ": more were not worth their time" : "");
  return PENDRES_OK;
}

pendres_status pendres_basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                         const pendres_basin_window *window,
                                         const pendres_basin_sample *asked,
                                         pendres_basin_statistics *out)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  PENDRES_DOOR_IN(&d, window, 1, window);
  pendres_basin_sample inside = {0}, *sample = asked != NULL ? &inside : NULL;
  if (asked != NULL) {
    inside = *asked;
    const int some = asked->scales > 0 && asked->scales <= PENDRES_BASIN_SCALES;
    const size_t scales = some ? (size_t)asked->scales : 0;
    inside.distance = pendres_door_in(&d, &pendres_dim_speed, scales, asked->distance);
  }
  PENDRES_DOOR_OUT(&d, statistics, 1, out);
  return PENDRES_DOOR_END(&d, pendres_basin_uncertainty_within(ctx, sample_most_slopes, set, window,
                                                               sample, out));
}

/* ---- in place of a grid's exponent ---- */

enum { RANDOM_SEED = 1 };

static int random_states_tell_more(const pendres_basin_statistics *s)
{
  if (!(s->boundary_boxes > 0.0)) return 0;
  /* Where that many states are uncertain, boundaries are everywhere as near as rounding, and shares
     do not follow a power of the distance. */
  if (3 * s->uncertain_states > s->states) return 0;
  if (!isfinite(s->uncertainty_exponent_error)) return 1;
  const double closer = sample_nearest / s->distance[0];
  return closer < 1.0 &&
         SAMPLE_STATES * s->uncertain[0] * pow(closer, s->uncertainty_exponent) >
           2 * SCATTER_LEAST_COUNT; /* twice what makes a share worth fitting */
}

/* The exponent of random states of a window, at the largest distances at which most are alike. */
static pendres_status exponent_of_random(pendres_context *ctx, const pendres_attractors *set,
                                         const pendres_basin_window *window,
                                         pendres_basin_statistics *out)
{
  double distance[PENDRES_SCATTER_MOST_SCALES];
  const pendres_basin_sample asked = {
    .n = SAMPLE_STATES, .seed = RANDOM_SEED, .scales = PENDRES_SCATTER_MOST_SCALES,
    .distance = distance};
  pendres_status status = PENDRES_NOT_FOUND;
  int many = 1;
  for (double first = sample_nearest; first > boundary_rounding && many; first *= sample_nearer) {
    for (int k = 0; k < PENDRES_SCATTER_MOST_SCALES; k++)
      distance[k] = first * pow(sample_ratio, k);
    status = pendres_basin_uncertainty(ctx, set, window, &asked, out);
    many = status == PENDRES_NOT_FOUND && out->uncertain[PENDRES_SCATTER_LEAST_SCALES - 1] > 0.5;
  }
  return status;
}

static pendres_status statistics_refine(pendres_context *ctx, const pendres_attractors *set,
                                        const pendres_basin_grid *g, pendres_basin_statistics *s,
                                        size_t *states)
{
  if (set == NULL || g == NULL || g->x == NULL || g->v == NULL || s == NULL || states == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, grid, its x and v, statistics and states");
  if (g->nx == 0 || g->nv == 0)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the grid has no states");
  const pendres_basin_window window = {.x_low = g->x[0], .x_high = g->x[g->nx - 1],
                                       .v_low = g->v[0], .v_high = g->v[g->nv - 1],
                                       .by = g->by};
  pendres_basin_statistics random;
  *states = 0;
  if (!random_states_tell_more(s)) return PENDRES_OK;
  const pendres_status status = exponent_of_random(ctx, set, &window, &random);
  if (status == PENDRES_NOT_FOUND) return PENDRES_OK; /* none this way: the grid's, if any */
  if (status != PENDRES_OK) return status;
  *states = random.states;
  s->uncertainty_exponent = random.uncertainty_exponent;
  s->uncertainty_exponent_error = random.uncertainty_exponent_error;
  s->scales = random.scales;
  memcpy(s->distance, random.distance, sizeof s->distance);
  memcpy(s->uncertain, random.uncertain, sizeof s->uncertain);
  memcpy(s->uncertain_error, random.uncertain_error, sizeof s->uncertain_error);
  return PENDRES_OK;
}

const pendres_basin_grid *pendres_basin_grid_inside(pendres_door *d,
                                                    const pendres_basin_grid *grid)
{
  if (grid == NULL || !pendres_door_changes(d)) return grid;
  pendres_basin_grid *inside = pendres_door_copy(d, grid, sizeof *grid);
  if (inside == NULL) return NULL;
  inside->x = pendres_door_in(d, &pendres_dim_length, grid->nx, grid->x);
  inside->v = pendres_door_in(d, &pendres_dim_speed, grid->nv, grid->v);
  return inside;
}

pendres_status pendres_basin_statistics_refine(pendres_context *ctx, const pendres_attractors *set,
                                               const pendres_basin_grid *grid,
                                               pendres_basin_statistics *statistics,
                                               size_t *states)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  grid = pendres_basin_grid_inside(&d, grid);
  PENDRES_DOOR_OUT(&d, statistics, 1, statistics);
  return PENDRES_DOOR_END(&d, statistics_refine(ctx, set, grid, statistics, states));
}
