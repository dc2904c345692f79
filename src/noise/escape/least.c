/*
 * least.c -- the least action over one saddle; see path.h.
 *
 * Guesses are made exact on one grid. The best is then continued to a longer path on finer steps,
 * which counts; its error is the difference.
 */
#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"

enum { SIDES = 3 }; /* guesses: between both orbits, and from either side of the saddle */

/* A path with what it needs. */
typedef struct drawn {
  pendres_way_flow flow;
  pendres_way path;
  size_t values; /* of its nodes */
  double *spare; /* for as many */
} drawn;

static pendres_status draw(const pendres_way_search *c, const pendres_way_plan_of *plan,
                           pendres_room *room, drawn *d)
{
  const size_t steps = (size_t)plan->grid.pieces * (size_t)plan->grid.steps;
  double *cosine = pendres_room_take(room, steps * PATH_STAGES, sizeof *cosine);
  d->values = ((size_t)plan->periods * (size_t)plan->grid.pieces + 1) * PATH_SIZE;
  d->path = (pendres_way){.flow = &d->flow, .from = c->from, .to = c->to, .pinned = 1,
                          .periods = plan->periods, .cut = plan->cut,
                          .z = pendres_room_take(room, d->values, sizeof(double))};
  d->spare = pendres_room_take(room, d->values, sizeof(double));
  if (room->status == PENDRES_OK)
    pendres_way_flow_make(&c->state->pendulum, plan->grid, cosine, &d->flow);
  return room->status;
}

/* Move the middle of a pinned path. The action is to change as its derivative says: else it has
   become another path. */
static pendres_status move(pendres_context *ctx, pendres_way *path, double shift)
{
  const double before = path->action, slope = fabs(path->slack);
  path->shift = shift;
  const pendres_status status = pendres_way_polish(ctx, path);
  path->shift = 0.0;
  if (status != PENDRES_OK) return status;
  const double most = 2.0 * fmax(slope, fabs(path->slack)) * fabs(shift);
  const int same = fabs(path->action - before) <= most + least_negligible * before &&
                   fabs(path->slack) * fabs(shift) < 0.1 * before;
  return same ? PENDRES_OK : PENDRES_NOT_CONVERGED;
}

/* The drive's phase of least action: down along the shift in time as far as its derivative changes
   its sign, and to where it is 0. */
static pendres_status find_phase(pendres_context *ctx, double period, pendres_way *path)
{
  const double first = path->action;
  double at = period / LEAST_TRIAL, a = 0.0, fa = path->slack, most = fabs(fa);
  pendres_status status = move(ctx, path, at);
  double b = at, fb = path->slack;
  const double stride = path->action < first ? period / LEAST_STRIDES : -period / LEAST_STRIDES;
  for (int k = 0; k < LEAST_STRIDES && status == PENDRES_OK && (fa < 0.0) == (fb < 0.0); k++) {
    if (k > 0 || stride > 0.0) fa = fb, a = b;
    status = move(ctx, path, a + stride - at);
    at = b = a + stride;
    fb = path->slack;
    most = fmax(most, fabs(fb));
  }
  if (status == PENDRES_OK && (fa < 0.0) == (fb < 0.0)) return PENDRES_NOT_CONVERGED;
  /* Where it is now is only roughly known, since it moves along tangents: steps alone count. */
  const double rises = (fb - fa) / (b - a);
  double step = b - a, before = fa, least = first;
  for (int k = 0; k < LEAST_STRIDES && status == PENDRES_OK; k++) {
    least = fmin(least, path->action);
    if (fabs(path->slack) <= least_level * most) /* or else it is the largest */
      return path->action <= least * (1.0 + least_negligible) ? PENDRES_OK : PENDRES_NOT_CONVERGED;
    const double slope = (path->slack - before) / step;
    before = path->slack;
    step = -before / (slope * rises > 0.0 ? slope : rises);
    step = copysign(fmin(fabs(step), fabs(stride)), step);
    status = move(ctx, path, step);
  }
  return status != PENDRES_OK ? status : PENDRES_NOT_CONVERGED;
}

/*
 * A path from a guess: with its middle kept, which converges also where the drive's phase hardly
 * matters. What that lacks tells whether it does, and where its phase is to be. *phase is what
 * another phase may make of the action, 0 where it is the least of all.
 */
static pendres_status attempt(const pendres_way_search *c, const pendres_way_guess *guess, int each,
                              drawn *d, double *phase)
{
  const double period = two_pi / c->state->pendulum.drive_frequency;
  pendres_way *path = &d->path;
  double coarse;
  *phase = 0.0;
  pendres_status status = pendres_way_try(c->ctx, guess, each, path, &coarse);
  if (status != PENDRES_OK || !pendres_model_driven(&c->state->pendulum)) return status;
  *phase = fabs(path->slack) * period;
  if (*phase <= least_negligible * path->action) return status;
  const pendres_way kept = *path;
  memcpy(d->spare, path->z, d->values * sizeof *path->z);
  status = find_phase(c->ctx, period, path);
  if (status == PENDRES_NOT_CONVERGED && *phase <= least_little * kept.action) {
    *path = kept;
    memcpy(path->z, d->spare, d->values * sizeof *path->z);
    return PENDRES_OK;
  }
  *phase = 0.0;
  return status;
}

/* Whether nothing more is to be computed. */
static int is_final(pendres_status status)
{
  return status == PENDRES_INTERRUPTED || status == PENDRES_OUT_OF_MEMORY;
}

/* All guesses; the nodes of the least are kept. */
static pendres_status survey(const pendres_way_search *c, int each, drawn *d, double *nodes,
                             pendres_way_found *out)
{
  double actions[SIDES * LEAST_SHARES], phase;
  out->paths = 0;
  out->phase = 0.0;
  for (int k = 0; k < SIDES * LEAST_SHARES; k++) {
    const pendres_way_guess guess = {k % SIDES - 1, (double)(k / SIDES) / LEAST_SHARES};
    const int shifts = pendres_model_driven(&c->state->pendulum) && !(out->phase > 0.0);
    if (k % SIDES == 0 && out->paths > 0 && !shifts) break;
    const pendres_status tried = attempt(c, &guess, each, d, &phase);
    if (is_final(tried)) return tried;
    const double action = d->path.action;
    if (tried != PENDRES_OK || !(action > 0.0)) continue;
    size_t known = 0;
    while (known < out->paths && fabs(actions[known] - action) > least_alike * action) known++;
    if (known == out->paths) actions[out->paths++] = action;
    if (out->paths > 1 && !(action < out->action * (1.0 - least_alike))) continue;
    out->action = action;
    out->phase = phase;
    out->middle = d->path.middle;
    memcpy(nodes, d->path.z, d->values * sizeof *nodes);
  }
  return out->paths > 0 ? PENDRES_OK : PENDRES_NOT_FOUND;
}

/* Whole periods of an orbit, in which a path is still or already on it. */
static void rest(const pendres_way *path, const pendres_way_end *end, long periods, double *z)
{
  const size_t pieces = (size_t)path->flow->grid.pieces;
  double at[PATH_SIZE] = {end->x, end->v, 0.0, 0.0};
  for (size_t k = 0; k < (size_t)periods * pieces; k++) {
    if (k % ((size_t)end->cycle * pieces) == 0) { /* errors do not add up */
      at[PATH_X] = end->x;
      at[PATH_V] = end->v;
    }
    memcpy(z + PATH_SIZE * k, at, sizeof at);
    pendres_way_piece(path->flow, (int)(k % pieces), at, NULL, NULL);
  }
  const double last[PATH_SIZE] = {end->x, end->v, 0.0, 0.0};
  if (periods % end->cycle == 0)
    memcpy(z + PATH_SIZE * (size_t)periods * pieces, last, sizeof last);
}

/* The same path, longer and on finer steps. */
static pendres_status lengthen(const pendres_way_search *c, const pendres_way_plan_of *plan,
                               const double *nodes, pendres_way_found *out)
{
  pendres_room room = pendres_room_open(c->ctx, "the path of an escape");
  pendres_way_plan_of wide = *plan;
  const long before = (long)ceil(least_longer / c->from.grows / c->from.cycle) * c->from.cycle;
  const long after = (long)ceil(least_longer / c->to.grows / c->to.cycle) * c->to.cycle;
  drawn d;
  wide.grid.steps = (int)ceil(least_finer * plan->grid.steps);
  wide.periods = plan->periods + before + after;
  wide.cut = plan->cut / exp(least_longer);
  pendres_status status = draw(c, &wide, &room, &d);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  const size_t pieces = (size_t)plan->grid.pieces, skip = (size_t)before * pieces;
  const size_t inner = (size_t)plan->periods * pieces;
  rest(&d.path, &c->from, before, d.path.z);
  rest(&d.path, &c->to, after, d.path.z + PATH_SIZE * (skip + inner));
  memcpy(d.path.z + PATH_SIZE * skip, nodes, PATH_SIZE * (inner + 1) * sizeof *nodes);
  d.path.middle = out->middle + skip;
  status = pendres_way_polish(c->ctx, &d.path);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  out->error = fabs(d.path.action - out->action) + out->phase +
               fabs(d.path.ends) * d.path.cut + least_rounding * fabs(d.path.action);
  out->action = d.path.action;
  status = c->take(c->arg, &d.path);
  return pendres_room_close(&room, status);
}

pendres_status pendres_way_least(pendres_way_search *c, pendres_way_found *out)
{
  const pendres_pendulum *p = &c->state->pendulum;
  pendres_way_plan_of plan;
  pendres_status status = pendres_way_state(c->state, &c->from);
  if (status == PENDRES_OK) status = pendres_way_saddle(&c->saddle, &c->to);
  if (status != PENDRES_OK) return status;
  const double origin = pendres_model_origin(p);
  const double reach = fmax(fabs(c->state->x - origin) + c->state->amplitude,
                            fabs(c->saddle.x - origin) + c->saddle.amplitude);
  status = pendres_way_plan(&c->from, &c->to, p, reach, &plan);
  if (status != PENDRES_OK)
    return pendres_context_fail(c->ctx, status, "a path out of this state takes too many drive "
                                                "periods: damping or instability is too weak");
  pendres_room room = pendres_room_open(c->ctx, "the path of an escape");
  drawn d;
  status = draw(c, &plan, &room, &d);
  double *nodes = pendres_room_take(&room, d.values, sizeof *nodes);
  status = room.status != PENDRES_OK ? room.status : survey(c, plan.each, &d, nodes, out);
  if (status == PENDRES_OK) status = lengthen(c, &plan, nodes, out);
  return pendres_room_close(&room, status);
}
