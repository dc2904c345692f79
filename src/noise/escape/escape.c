/* escape.c -- ways out of a state, by their least actions; see escape.h. */
#include <pendres/escape.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/room.h"
#include "model/equation.h"
#include "model/model.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"
#include "noise/escape/saddles.h"
#include "settling/attractor_internal.h"

enum { COLUMNS = 6 }; /* of a path's table */

struct pendres_escapes {
  size_t count;
  struct found {
    pendres_escape way;
    double *table; /* [column][points] */
  } found[PENDRES_SADDLES_MOST];
};

/* Whether nothing more is to be computed. */
static int is_final(pendres_status status)
{
  return status == PENDRES_INTERRUPTED || status == PENDRES_OUT_OF_MEMORY;
}

/* The table of a path: nodes with points between, of very long ones some nodes. */
static pendres_status tabulate(void *found, const pendres_way *path)
{
  struct found *out = found;
  pendres_escape *way = &out->way;
  const pendres_pendulum *p = &path->flow->p;
  const pendres_way_grid grid = path->flow->grid;
  const size_t pieces = (size_t)path->periods * (size_t)grid.pieces;
  const size_t each = (pieces + TABLE_ROWS - 1) / TABLE_ROWS, rooms = TABLE_ROWS / pieces;
  const size_t parts = rooms > TABLE_BETWEEN ? TABLE_BETWEEN : rooms > 1 ? rooms : 1;
  const size_t n = pieces / each * parts + 1;
  const pendres_way_grid fine = {grid.pieces * (int)parts,
                                 (grid.steps + (int)parts - 1) / (int)parts};
  double *t = malloc(COLUMNS * n * sizeof *t);
  double *cosine = malloc((size_t)(fine.pieces * fine.steps) * PATH_STAGES * sizeof *cosine);
  pendres_way_flow flow;
  out->table = t;
  if (t == NULL || cosine == NULL) {
    free(cosine);
    return PENDRES_OUT_OF_MEMORY;
  }
  pendres_way_flow_make(p, fine, cosine, &flow);
  double z[PATH_SIZE];
  for (size_t k = 0; k < n; k++) {
    const size_t node = k / parts * each, part = k % parts;
    if (part == 0) memcpy(z, path->z + PATH_SIZE * node, sizeof z);
    const size_t at = node * parts + part;
    t[k] = two_pi * (double)at / (double)fine.pieces;
    for (size_t i = 0; i < PATH_SIZE; i++) t[(i + 1) * n + k] = z[i];
    t[(COLUMNS - 1) * n + k] = 2.0 * p->damping * z[PATH_Q];
    pendres_way_piece(&flow, (int)(at % (size_t)fine.pieces), z, NULL, NULL);
  }
  free(cosine);
  way->points = n;
  way->phase = t;
  way->x = t + n;
  way->v = t + 2 * n;
  way->momentum_x = t + 3 * n;
  way->momentum_v = t + 4 * n;
  way->noise = t + 5 * n;
  return PENDRES_OK;
}

/* The way over one saddle; PENDRES_NOT_FOUND where there is none. */
static pendres_status go_over(pendres_context *ctx, const pendres_orbit *state,
                              const pendres_saddle *saddle, struct found *out)
{
  pendres_way_search search = {.ctx = ctx, .state = state, .saddle = saddle->orbit,
                               .take = tabulate, .arg = out};
  pendres_way_found least = {0};
  search.saddle.x = saddle->x;
  out->way = (pendres_escape){.saddle = saddle->orbit, .saddle_x = saddle->x,
                              .label = saddle->leads.label, .attractor = saddle->leads.attractor,
                              .well = saddle->leads.well};
  const pendres_status status = pendres_way_least(&search, &least);
  out->way.action = least.action;
  out->way.action_error = least.error;
  out->way.paths = least.paths;
  return status;
}

static int by_action(const void *a, const void *b)
{
  const double x = ((const struct found *)a)->way.action;
  const double y = ((const struct found *)b)->way.action;
  return (x > y) - (x < y);
}

/* NULL, or why there is no way out to look for. */
static const char *refuse(const pendres_attractor *a)
{
  if (a == NULL) return "there is no such attractor to leave";
  if (a->orbit.period == 0)
    return "chaos, and a rotation without a lock, are no closed orbits: only these have a least "
           "action here";
  if (a->orbit.winding != 0)
    return "a rotation is left on paths that wind, which are not looked for";
  if (isnan(pendres_equation_contraction(&a->orbit.pendulum)))
    return "the friction is not linear in the velocity: its noise is not stated";
  return NULL;
}

static pendres_status find_all(pendres_context *ctx, const pendres_attractors *set, size_t from,
                               pendres_escapes *ways)
{
  const pendres_orbit *state = &pendres_attractors_get(set, from)->orbit;
  pendres_saddle saddle[PENDRES_SADDLES_MOST];
  size_t count = 0;
  pendres_status last = PENDRES_OK,
                 status = pendres_saddles_find(ctx, set, from, saddle, &count);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < count; i++) {
    const size_t k = ways->count;
    if (saddle[i].orbit.winding != 0) continue; /* a path would end on what winds */
    last = go_over(ctx, state, &saddle[i], &ways->found[k]);
    if (is_final(last)) return last;
    if (last == PENDRES_OK) ways->count++;
  }
  if (ways->count == 0 && last != PENDRES_OK && last != PENDRES_NOT_FOUND &&
      last != PENDRES_NOT_CONVERGED)
    return last;
  if (ways->count == 0)
    return pendres_context_fail(ctx, PENDRES_NOT_FOUND, count == 0
                                  ? "no saddle is found on the boundary of this state's basin"
                                  : "no path to a saddle of this state's boundary is found");
  qsort(ways->found, ways->count, sizeof ways->found[0], by_action);
  return PENDRES_OK;
}

static pendres_status escapes_find(pendres_context *ctx, const pendres_attractors *set, size_t from,
                                   pendres_escapes **out)
{
  if (set == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "attractors and out");
  *out = NULL;
  if (set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "these are attractors of several parameter sets");
  const char *wrong = refuse(pendres_attractors_get(set, from));
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  pendres_escapes *ways = calloc(1, sizeof *ways);
  if (ways == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "no memory for ways out");
  const pendres_status status = find_all(ctx, set, from, ways);
  if (status == PENDRES_OK) *out = ways;
  else pendres_escapes_free(ways);
  return status;
}

pendres_status pendres_escapes_find(pendres_context *ctx, const pendres_attractors *set,
                                    size_t from, pendres_escapes **out)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_attractors *inside = pendres_attractors_inside(&d, set);
  PENDRES_DOOR_CALL(&d, escapes_find(ctx, inside, from, out));
  for (size_t i = 0; d.status == PENDRES_OK && i < (*out)->count; i++) {
    pendres_escape *way = &(*out)->found[i].way;
    double *t = (*out)->found[i].table;
    const size_t n = way->points;
    static const signed char power[COLUMNS][2] = {{0, 0}, {1, 0}, {1, -1}, {1, -2}, {1, -1},
                                                  {1, -2}};
    for (size_t c = 0; c < COLUMNS; c++)
      for (size_t k = 0; k < n; k++)
        t[c * n + k] *= pendres_units_factor(&d.scales, power[c][0], power[c][1]);
    pendres_units_out(&d.scales, &pendres_dim_escape, 1, way);
  }
  return pendres_door_close(&d);
}

void pendres_escapes_free(pendres_escapes *ways)
{
  for (size_t k = 0; ways != NULL && k < PENDRES_SADDLES_MOST; k++) free(ways->found[k].table);
  free(ways);
}

size_t pendres_escapes_count(const pendres_escapes *ways)
{
  return ways != NULL ? ways->count : 0;
}

const pendres_escape *pendres_escapes_get(const pendres_escapes *ways, size_t i)
{
  return ways != NULL && i < ways->count ? &ways->found[i].way : NULL;
}
