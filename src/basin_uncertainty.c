/* basin_uncertainty.c -- the uncertainty exponent from random states; see basin.h. */
#include <pendres/basin.h>

#include <math.h>
#include <stdlib.h>

#include "attractor_internal.h"
#include "basin_scatter.h"
#include "context_internal.h"
#include "settle.h"

enum { LEAST_SCALES = 3, LEAST_STATES = 16, SAMPLES_AT_A_TIME = 4096 };

/* The bits of splitmix64 (Steele, Lea, Flood, OOPSLA 2014), as a number in [0, 1). */
static double uniform(uint64_t seed, uint64_t counter)
{
  uint64_t z = seed * UINT64_C(0xd1342543de82ef95) + (counter + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* State number i of a sample and its neighbours: 1 + 2 * scales of x and v. */
static void place(const pendres_basin_window *window, uint64_t seed, uint64_t i, int scales,
                  const double *distance, double *x, double *v)
{
  const double at_x =
    window->x_low + (window->x_high - window->x_low) * uniform(seed, 2 * i);
  const double at_v =
    window->v_low + (window->v_high - window->v_low) * uniform(seed, 2 * i + 1);
  for (int k = 0; k <= 2 * scales; k++) x[k] = at_x;
  v[0] = at_v;
  for (int k = 0; k < scales; k++) {
    v[1 + 2 * k] = at_v - distance[k];
    v[2 + 2 * k] = at_v + distance[k];
  }
}

/* Count one state and its neighbours: outcome[0] its own, then two a distance. Each state is a
   group of its own, since states know nothing of one another. */
static void count_sample(pendres_scatter *s, int scales, const pendres_outcome *outcome)
{
  double unlike[PENDRES_SCATTER_QUANTITIES] = {0.0};
  for (int k = 0; k < scales; k++)
    unlike[k] = outcome[1 + 2 * k].attractor != outcome[0].attractor ||
                outcome[2 + 2 * k].attractor != outcome[0].attractor;
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
    out->uncertain_error[k] = sqrt(share * (1.0 - share) / n);
  }
  pendres_scatter_exponent(s, out->scales, out->distance, tried, &out->uncertainty_exponent,
                           &out->uncertainty_exponent_error);
}

/* Settle the states of a sample, so many at a time. */
static pendres_status settle_sample(pendres_context *ctx, const pendres_attractors *set,
                                    const pendres_basin_window *window, uint64_t seed,
                                    pendres_scatter *counts, pendres_basin_statistics *out)
{
  const size_t n = out->states, each = 1 + 2 * (size_t)out->scales;
  const size_t room = SAMPLES_AT_A_TIME * each;
  pendres_status status = PENDRES_OK;
  double *x = calloc(room, sizeof *x), *v = calloc(room, sizeof *v);
  pendres_outcome *outcome = malloc(room * sizeof *outcome);
  if (x == NULL || v == NULL || outcome == NULL)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for random states");
  for (size_t first = 0; first < n && status == PENDRES_OK; first += SAMPLES_AT_A_TIME) {
    const size_t count = n - first < SAMPLES_AT_A_TIME ? n - first : SAMPLES_AT_A_TIME;
    for (size_t i = 0; i < count; i++)
      place(window, seed, (uint64_t)(first + i), out->scales, out->distance, &x[i * each],
            &v[i * each]);
    status = pendres_settle_known(ctx, set->catalogues, count * each, x, v,
                                  10.0 * ctx->options.tolerance, PENDRES_SETTLE_FULL, outcome);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++) {
      out->unresolved += outcome[i * each].attractor < 0;
      count_sample(counts, out->scales, &outcome[i * each]);
    }
  }
  free(x);
  free(v);
  free(outcome);
  return status;
}

static pendres_status basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                        const pendres_basin_window *window, size_t n, int scales,
                                        const double *distance, uint64_t seed,
                                        pendres_basin_statistics *out)
{
  if (set == NULL || window == NULL || distance == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, window, distance and out");
  if (n < LEAST_STATES || scales < LEAST_SCALES || scales > PENDRES_BASIN_SCALES ||
      set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an uncertainty exponent needs states and at least %d distances",
                                LEAST_SCALES);
  int bad = !(window->x_low < window->x_high && window->v_low < window->v_high &&
              fmax(fmax(fabs(window->x_low), fabs(window->x_high)),
                   fmax(fabs(window->v_low), fabs(window->v_high))) <= 1e15);
  for (int k = 0; k < scales; k++) bad |= !(distance[k] > 0.0 && distance[k] <= 1e15);
  if (bad)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an uncertainty exponent needs a window and positive distances");
  pendres_scatter counts = {0};
  *out = (pendres_basin_statistics){.states = n, .scales = scales,
                                    .entropy = NAN, .entropy_error = NAN, .boundary_entropy = NAN,
                                    .boundary_entropy_error = NAN, .boundary_boxes = NAN};
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++)
    out->distance[k] = k < scales ? distance[k] : NAN;
  const pendres_status status = settle_sample(ctx, set, window, seed, &counts, out);
  if (status != PENDRES_OK) return status;
  conclude(&counts, out);
  if (isnan(out->uncertainty_exponent))
    return pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                                "at too few of the distances the boundary is met often enough, "
                                "and by fewer than half of the states");
  return PENDRES_OK;
}

pendres_status pendres_basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                         const pendres_basin_window *window, size_t n, int scales,
                                         const double *distance, uint64_t seed,
                                         pendres_basin_statistics *out)
{
  return PENDRES_CONTEXT_CALL(ctx, basin_uncertainty(ctx, set, window, n, scales, distance, seed,
                                                     out));
}
