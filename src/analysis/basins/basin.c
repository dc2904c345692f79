/* basin.c -- basins of attraction over a grid of initial states; see basin.h. */
#include <pendres/basin.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/basins/numbers.h"
#include "settling/attractor_internal.h"
#include "analysis/basins/uncertainty.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "settling/settle.h"

static pendres_status check_grid(pendres_context *ctx, const pendres_attractors *set,
                                 const pendres_basin_grid *grid)
{
  if (set->sets != 1 || grid->nx < 1 || grid->nv < 1 || grid->x == NULL || grid->v == NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "a grid needs x and v, and attractors of one parameter set");
  /* The parameters of attractors have been checked before: only the states are left to check. */
  for (size_t i = 0; i < grid->nx + grid->nv; i++) {
    const double value = i < grid->nx ? grid->x[i] : grid->v[i - grid->nx];
    if (!(fabs(value) <= pendres_farthest))
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                  "%c of a grid must be finite, and 1e15 at most",
                                  i < grid->nx ? 'x' : 'v');
  }
  return PENDRES_OK;
}

/* A state whose well is beyond those that 32 bits can number is as good as unresolved. */
static void compact(const pendres_settled *from, pendres_basin_state *to)
{
  static const pendres_settled beyond = {.label = PENDRES_LABEL_UNRESOLVED,
                                         .attractor = PENDRES_ATTRACTOR_UNKNOWN,
                                         .settling_periods = -1};
  if (from->well != (int32_t)from->well || from->settling_periods > INT32_MAX) from = &beyond;
  *to = (pendres_basin_state){.well = (int32_t)from->well,
                              .settling_periods = (int32_t)from->settling_periods,
                              .attractor = (int16_t)from->attractor,
                              .label = (int8_t)from->label,
                              .how = from->attractor != PENDRES_ATTRACTOR_UNKNOWN && !from->certain
                                       ? PENDRES_BASIN_UNCERTAIN
                                       : PENDRES_BASIN_INTEGRATED};
}

static pendres_status basin_attractors(pendres_context *ctx, const pendres_pendulum *p,
                                       const pendres_basin_grid *grid, pendres_attractors **out)
{
  double x[BASIN_GUESS_SIDE * BASIN_GUESS_SIDE], v[BASIN_GUESS_SIDE * BASIN_GUESS_SIDE];
  if (p == NULL || grid == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, grid and out");
  *out = NULL;
  if (grid->nx < 1 || grid->nv < 1 || grid->x == NULL || grid->v == NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "a grid needs x and v");
  const size_t nx = grid->nx < BASIN_GUESS_SIDE ? grid->nx : BASIN_GUESS_SIDE;
  const size_t nv = grid->nv < BASIN_GUESS_SIDE ? grid->nv : BASIN_GUESS_SIDE;
  size_t n = 0;
  for (size_t i = 0; i < nx; i++)
    for (size_t j = 0; j < nv; j++) {
      x[n] = grid->x[(2 * i + 1) * grid->nx / (2 * nx)];
      v[n++] = grid->v[(2 * j + 1) * grid->nv / (2 * nv)];
    }
  return pendres_attractors_find(ctx, p, n, x, v, out);
}

pendres_status pendres_basin_attractors(pendres_context *ctx, const pendres_pendulum *p,
                                        const pendres_basin_grid *grid, pendres_attractors **out)
{
  return PENDRES_CONTEXT_CALL(ctx, basin_attractors(ctx, p, grid, out));
}

static double smallest_spacing(size_t n, const double *values)
{
  double least = INFINITY;
  for (size_t i = 1; i < n; i++) least = fmin(least, fabs(values[i] - values[i - 1]));
  return least;
}

double pendres_basin_accuracy(const pendres_context *ctx, const pendres_basin_grid *grid)
{
  if (ctx == NULL || grid == NULL || grid->x == NULL || grid->v == NULL) return NAN;
  const double spacing =
    fmin(smallest_spacing(grid->nx, grid->x), smallest_spacing(grid->nv, grid->v));
  return pendres_accuracy_to_picture(ctx, spacing);
}

/* States of a grid that are to settle on known attractors. */
typedef struct picture {
  pendres_context *ctx;
  const pendres_attractors *set;
  const pendres_basin_grid *grid;
} picture;

/* Settle the states with these numbers; outcomes are in the order of the numbers. */
static pendres_status settle_states(const picture *of, size_t n, const size_t *index,
                                    pendres_settle_budget budget, pendres_basin_state *state)
{
  const pendres_basin_grid *grid = of->grid;
  pendres_room room = pendres_room_open(of->ctx, "states");
  double *x = pendres_room_take(&room, n, sizeof *x);
  double *v = pendres_room_take(&room, n, sizeof *v);
  pendres_settled *outcome = pendres_room_take(&room, n, sizeof *outcome);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t k = 0; k < n; k++) {
    x[k] = grid->x[index[k] / grid->nv];
    v[k] = grid->v[index[k] % grid->nv];
  }
  const pendres_settle_starts starts = {.n = n, .x = x, .v = v};
  const pendres_status status =
    pendres_settle_known(of->ctx, of->set->attractor_sets, &starts,
                         pendres_basin_accuracy(of->ctx, grid), budget, outcome);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) compact(&outcome[k], &state[k]);
  return pendres_room_close(&room, status);
}

static pendres_status basin_states(pendres_context *ctx, const pendres_attractors *set,
                                   const pendres_basin_grid *grid, size_t n, const size_t *index,
                                   pendres_basin_state *state)
{
  if (set == NULL || grid == NULL || (n > 0 && (index == NULL || state == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "attractors, grid, index and state");
  const pendres_status status = check_grid(ctx, set, grid);
  if (status != PENDRES_OK) return status;
  for (size_t k = 0; k < n; k++)
    if (index[k] >= grid->nx * grid->nv)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "state %zu is not in the grid",
                                  index[k]);
  return settle_states(&(picture){ctx, set, grid}, n, index, PENDRES_SETTLE_FULL, state);
}

pendres_status pendres_basin_states(pendres_context *ctx, const pendres_attractors *set,
                                    const pendres_basin_grid *grid, size_t n, const size_t *index,
                                    pendres_basin_state *state)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_basin_grid *inside = pendres_basin_grid_inside(&d, grid);
  return PENDRES_DOOR_END(&d, basin_states(ctx, set, inside, n, index, state));
}

/* Finish the states that have not settled soon if there are many of them; otherwise mark them. */
static pendres_status defer(const picture *of, size_t offset, size_t n,
                            pendres_basin_state *state)
{
  size_t left = 0;
  for (size_t k = 0; k < n; k++) left += state[k].attractor == PENDRES_ATTRACTOR_UNKNOWN;
  if (left < BASIN_WORTH_WAITING) {
    for (size_t k = 0; k < n; k++)
      if (state[k].attractor == PENDRES_ATTRACTOR_UNKNOWN) state[k].how = PENDRES_BASIN_DEFERRED;
    return PENDRES_OK;
  }
  pendres_room room = pendres_room_open(of->ctx, "states");
  size_t *index = pendres_room_take(&room, left, sizeof *index);
  pendres_basin_state *rest = pendres_room_take(&room, left, sizeof *rest);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  left = 0;
  for (size_t k = 0; k < n; k++)
    if (state[k].attractor == PENDRES_ATTRACTOR_UNKNOWN) index[left++] = offset + k;
  pendres_status status = settle_states(of, left, index, PENDRES_SETTLE_FULL, rest);
  for (size_t k = 0; k < left && status == PENDRES_OK; k++) state[index[k] - offset] = rest[k];
  return pendres_room_close(&room, status);
}

static pendres_status basin_rows(pendres_context *ctx, const pendres_attractors *set,
                                 const pendres_basin_grid *grid, size_t first, size_t rows,
                                 pendres_basin_state *state)
{
  if (set == NULL || grid == NULL || state == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, grid and state");
  pendres_status status = check_grid(ctx, set, grid);
  if (status != PENDRES_OK) return status;
  if (first > grid->nx || rows > grid->nx - first)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "rows %zu to %zu are not in the grid", first, first + rows);
  const size_t n = rows * grid->nv, offset = first * grid->nv;
  size_t *index = calloc(n + 1, sizeof *index);
  if (index == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu states", n);
  for (size_t k = 0; k < n; k++) index[k] = offset + k;
  const picture of = {ctx, set, grid};
  status = settle_states(&of, n, index, PENDRES_SETTLE_SHORT, state);
  free(index);
  return status == PENDRES_OK ? defer(&of, offset, n, state) : status;
}

pendres_status pendres_basin_rows(pendres_context *ctx, const pendres_attractors *set,
                                  const pendres_basin_grid *grid, size_t first, size_t rows,
                                  pendres_basin_state *state)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_basin_grid *inside = pendres_basin_grid_inside(&d, grid);
  return PENDRES_DOOR_END(&d, basin_rows(ctx, set, inside, first, rows, state));
}

static pendres_status basin_extend(pendres_context *ctx, pendres_attractors *set,
                                   const pendres_basin_grid *grid, size_t n, const size_t *index,
                                   size_t *grown)
{
  if (set == NULL || grid == NULL || grown == NULL || (n > 0 && index == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "attractors, grid, index and grown");
  *grown = 0;
  pendres_status status = check_grid(ctx, set, grid);
  if (status != PENDRES_OK || n == 0) return status;
  double x[BASIN_MORE_GUESSES], v[BASIN_MORE_GUESSES];
  const size_t guesses = n < BASIN_MORE_GUESSES ? n : BASIN_MORE_GUESSES, before = set->count;
  for (size_t k = 0; k < guesses; k++) {
    const size_t one = index[k * n / guesses];
    if (one / grid->nv >= grid->nx)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "state %zu is not in the grid",
                                  one);
    x[k] = grid->x[one / grid->nv];
    v[k] = grid->v[one % grid->nv];
  }
  status = pendres_attractors_extend(ctx, set, guesses, x, v);
  *grown = set->count - before;
  return status;
}

pendres_status pendres_basin_extend(pendres_context *ctx, pendres_attractors *set,
                                    const pendres_basin_grid *grid, size_t n, const size_t *index,
                                    size_t *grown)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_basin_grid *inside = pendres_basin_grid_inside(&d, grid);
  return PENDRES_DOOR_END(&d, basin_extend(ctx, set, inside, n, index, grown));
}

/* List the numbers of the states that are marked as deferred, or of those that are not resolved. */
static size_t list_states(size_t n, const pendres_basin_state *state, int deferred, size_t *index)
{
  size_t count = 0;
  for (size_t k = 0; k < n; k++)
    if (deferred ? state[k].how == PENDRES_BASIN_DEFERRED
        : state[k].attractor == PENDRES_ATTRACTOR_UNKNOWN)
      index[count++] = k;
  return count;
}

/* Settle all rows with the attractors that are known. */
static pendres_status compute_once(pendres_context *ctx, const pendres_attractors *set,
                                   const pendres_basin_grid *grid, size_t *index,
                                   pendres_basin_state *state)
{
  pendres_status status = PENDRES_OK;
  const size_t rows_a_time = 1 + 200000 / grid->nv;
  for (size_t i = 0; i < grid->nx && status == PENDRES_OK; i += rows_a_time) {
    const size_t rows = grid->nx - i < rows_a_time ? grid->nx - i : rows_a_time;
    status = pendres_basin_rows(ctx, set, grid, i, rows, state + i * grid->nv);
  }
  if (status != PENDRES_OK) return status;
  const size_t n = list_states(grid->nx * grid->nv, state, 1, index);
  pendres_basin_state *rest = malloc((n + 1) * sizeof *rest);
  if (rest == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu states", n);
  status = pendres_basin_states(ctx, set, grid, n, index, rest);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) state[index[k]] = rest[k];
  free(rest);
  return status;
}

static pendres_status basin_compute(pendres_context *ctx, pendres_attractors *set,
                                    const pendres_basin_grid *grid, pendres_basin_state *state)
{
  if (set == NULL || grid == NULL || state == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, grid and state");
  pendres_status status = check_grid(ctx, set, grid);
  if (status != PENDRES_OK) return status;
  size_t *index = malloc(grid->nx * grid->nv * sizeof *index);
  if (index == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for the grid");
  size_t grown = 1;
  for (int round = 0; round <= TRIES && grown > 0 && status == PENDRES_OK; round++) {
    grown = 0;
    status = compute_once(ctx, set, grid, index, state);
    if (status != PENDRES_OK || round == TRIES) break;
    const size_t lost = list_states(grid->nx * grid->nv, state, 0, index);
    status = pendres_basin_extend(ctx, set, grid, lost, index, &grown);
  }
  free(index);
  return status;
}

pendres_status pendres_basin_find(pendres_context *ctx, pendres_attractors *set,
                                  const pendres_basin_grid *grid, pendres_basin_state *state)
{
  return PENDRES_CONTEXT_CALL(ctx, basin_compute(ctx, set, grid, state));
}
