/* boundary.c -- basin boundaries as curves; see boundary.h. */
#include <pendres/boundary.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/strobe.h>

#include "base/angles.h"
#include "base/grow.h"
#include "analysis/basins/boundary_grow.h"
#include "analysis/basins/numbers.h"
#include "base/sized.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "engine/door.h"
#include "engine/room.h"
#include "model/equation.h"
#include "model/model.h"
#include "orbits/orbit_newton.h"
#include "engine/steps.h"
#include "engine/threads.h"

/* A boundary that grows; the public part comes first. */
typedef struct growing {
  pendres_boundary seen;
  size_t capacity;
  double *x, *v, *error;
  int *piece;
  int pieces;
} growing;

void pendres_boundary_free(pendres_boundary *b)
{
  growing *g = (growing *)b;
  if (g == NULL) return;
  free(g->x);
  free(g->v);
  free(g->error);
  free(g->piece);
  free(g);
}

/* ---- what is wanted ---- */

static const char *resolve(const pendres_pendulum *p, pendres_boundary_options *o)
{
  if (PENDRES_SIZED_REFUSES(o) != NULL) return PENDRES_SIZED_REFUSES(o);
  if (o->x_low == 0.0 && o->x_high == 0.0) {
    o->x_low = pendres_model_origin(p) - pi;
    o->x_high = pendres_model_origin(p) + pi;
  }
  if (o->v_low == 0.0 && o->v_high == 0.0) {
    o->v_low = -2.5;
    o->v_high = 2.5;
  }
  if (o->spacing == 0.0) o->spacing = 0.05;
  if (o->deviation == 0.0) o->deviation = 1e-5;
  if (o->most_points == 0) o->most_points = 400000;
  if (!(o->x_high > o->x_low && o->x_high - o->x_low < 1e4))
    return "the window in x is empty or absurd";
  if (!(o->v_high > o->v_low && fmax(-o->v_low, o->v_high) < 1e4))
    return "the window in v is empty or absurd";
  if (!(o->spacing > 0.0 && o->deviation > 0.0)) return "spacing and deviation must be positive";
  return NULL;
}

/* ---- how far nodes are from the curve ---- */

/* The order of nodes by their number of maps, and then along the curve. */
static int by_generation(const void *a, const void *b)
{
  const pendres_boundary_node *const *p = a, *const *q = b;
  if ((*p)->generation != (*q)->generation)
    return (*p)->generation < (*q)->generation ? -1 : 1;
  return *p < *q ? -1 : *p > *q;
}

/* What is computed for all nodes. */
typedef struct measuring {
  const pendres_boundary_seed *seed;
  pendres_pendulum forward;
  const pendres_boundary_curve *curve;
  pendres_boundary_node **order; /* its nodes by their generations */
} measuring;

/*
 * The unit vector of y and v across the curve at a node, as one of y and w: perpendicular to the
 * chord between its neighbours. Where it has none any other vector will do: distances along a
 * vector that is not quite perpendicular are too large, never too small.
 */
static void across(const measuring *m, size_t i, double out[2])
{
  const pendres_boundary_node *own = &m->curve->node[i], *before = own, *after = own;
  const double omega = m->forward.drive_frequency;
  if (i > 0 && own[-1].piece == own->piece) before = own - 1;
  if (i + 1 < m->curve->count && own[1].piece == own->piece) after = own + 1;
  const double dy = after->y - before->y, dv = (after->w - before->w) * omega;
  const double length = hypot(dy, dv);
  out[0] = length > 0.0 ? -dv / length : 1.0;
  out[1] = length > 0.0 ? dy / length / omega : 0.0;
}

/* The distance along a vector across the curve, by the forward image of a node and of that. */
static double distance_of(const pendres_boundary_seed *seed, double y, double w,
                          const double vector[2])
{
  const double dy = pendres_less_turns(y - seed->y, pendres_model_turn(&seed->backward));
  const double dw = w + seed->w; /* forward w has its own sign */
  const double a = dy * seed->e[0] - dw * seed->e[1], c = dy * seed->f[0] - dw * seed->f[1];
  const double off = c - seed->bend * a * a;
  const double by_y = seed->f[0] - 2.0 * seed->bend * a * seed->e[0];
  const double by_w = -(seed->f[1] - 2.0 * seed->bend * a * seed->e[1]);
  return fabs(off) / fabs(by_y * vector[0] + by_w * vector[1]);
}

/* Of nodes of one generation, as many as a block holds at most. */
static pendres_status measure(pendres_block *b, const measuring *m, size_t count,
                              pendres_boundary_node *const *order)
{
  pendres_status status = PENDRES_OK;
  pendres_block_resize(b, count);
  for (size_t i = 0; i < count; i++) {
    double vector[2];
    across(m, (size_t)(order[i] - m->curve->node), vector);
    pendres_block_load(b, i, &m->forward, order[i]->y, order[i]->w);
    for (int k = 0; k < 2; k++) pendres_block_put_tangent(b, i, k, vector);
  }
  const long periods = (long)order[0]->generation * m->seed->iterates;
  for (long k = 0; k < periods && status == PENDRES_OK; k++) status = pendres_block_period(b);
  if (status != PENDRES_OK) return status;
  const pendres_rows rows = pendres_block_rows(b);
  for (size_t i = 0; i < count; i++) {
    double vector[2];
    pendres_block_get_tangent(b, i, 0, vector);
    order[i]->error = distance_of(m->seed, pendres_rows_get(&rows, PENDRES_ROW_Y, i),
                                  pendres_rows_get(&rows, PENDRES_ROW_W, i), vector);
  }
  return status;
}

/* n nodes of those in order. */
static pendres_status measure_some(pendres_context *ctx, size_t begin, size_t n, void *arg)
{
  const measuring *m = arg;
  pendres_boundary_node *const *order = m->order + begin;
  pendres_block *b;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, m->seed->steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t capacity = pendres_block_capacity(b);
  status = pendres_block_carry(b, PENDRES_FLOW_TANGENTS);
  for (size_t first = 0, count; first < n && status == PENDRES_OK; first += count) {
    count = 1;
    while (count < capacity && first + count < n &&
           order[first + count]->generation == order[first]->generation)
      count++;
    status = measure(b, m, count, order + first);
  }
  (void)pendres_block_carry(b, PENDRES_FLOW_NOTHING);
  return status;
}

/*
 * The distance of nodes in the (x, v) plane from the stable manifold that belongs to the seed's own
 * number of steps, into their errors. Mapped forward, a node comes close to the local manifold; its
 * distance from that, divided by what the map makes of a unit vector across the curve, is its
 * distance here. The curve contracts, so that errors along it do not matter.
 */
static pendres_status find_distances(pendres_context *ctx, const pendres_boundary_seed *seed,
                                     const pendres_boundary_curve *curve)
{
  const size_t n = curve->count;
  pendres_room room = pendres_room_open(ctx, "points of a boundary");
  pendres_boundary_node **order = pendres_room_take(&room, n, sizeof *order);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) order[i] = &curve->node[i];
  qsort(order, n, sizeof *order, by_generation);
  measuring m = {.seed = seed, .forward = pendres_equation_reversed(&seed->backward),
                 .curve = curve, .order = order};
  return pendres_room_close(&room,
                            pendres_threads_run(ctx, n, BOUNDARY_TOGETHER, measure_some, &m));
}

/* ---- into the window ---- */

static pendres_status append(pendres_context *ctx, growing *g, double x, double v, double error)
{
  pendres_boundary *b = &g->seen;
  if (b->count == g->capacity) {
    const size_t size = 2 * g->capacity + 256;
    const int bad = !pendres_regrow(&g->x, size, sizeof *g->x) ||
                    !pendres_regrow(&g->v, size, sizeof *g->v) ||
                    !pendres_regrow(&g->error, size, sizeof *g->error) ||
                    !pendres_regrow(&g->piece, size, sizeof *g->piece);
    if (bad)
      return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
    g->capacity = size;
    b->x = g->x, b->v = g->v, b->error = g->error, b->piece = g->piece;
  }
  g->x[b->count] = x;
  g->v[b->count] = v;
  g->error[b->count] = error;
  g->piece[b->count++] = g->pieces;
  b->bound = fmax(b->bound, error);
  return PENDRES_OK;
}

/* Add the part of the curve, moved by `shift`, that is in the window: runs of nodes inside. */
static pendres_status show(pendres_context *ctx, const pendres_boundary_curve *curve,
                           const pendres_pendulum *p, const pendres_boundary_options *o,
                           double shift, growing *b)
{
  int open = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < curve->count && status == PENDRES_OK; i++) {
    const pendres_boundary_node *n = &curve->node[i];
    const double x = n->y + pendres_model_origin(p) + shift, v = n->w * p->drive_frequency;
    const int inside = x >= o->x_low && x <= o->x_high && v >= o->v_low && v <= o->v_high;
    const int goes_on = i > 0 && n->piece == n[-1].piece;
    if (open && !(inside && goes_on)) {
      b->pieces++;
      open = 0;
    }
    /* Nodes may coincide where the curve is stretched to the limit of rounding. */
    const int again = open && x == b->x[b->seen.count - 1] && v == b->v[b->seen.count - 1];
    if (!inside || again) continue;
    status = append(ctx, b, x, v, n->error);
    open = 1;
  }
  if (open) b->pieces++;
  return status;
}

/*
 * Trace the curve, and estimate the errors of its nodes. Nodes are mapped forward with another
 * number of steps, and their distance from the local manifold, mapped back, is their distance from
 * the curve. The departure of the curve from the chord between two nodes is added.
 */
static pendres_status trace(pendres_context *ctx, const pendres_orbit *saddle,
                            const pendres_boundary_options *o, int steps,
                            pendres_boundary_curve *curve, growing *b)
{
  const pendres_pendulum *p = &saddle->pendulum;
  pendres_boundary_seed coarse;
  pendres_status status = pendres_boundary_grow_seed(ctx, saddle, steps, &coarse);
  if (status == PENDRES_OK) status = find_distances(ctx, &coarse, curve);
  if (status != PENDRES_OK) return status;
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < curve->count; i++) {
    pendres_boundary_node *n = &curve->node[i];
    const double x = n->y + pendres_model_origin(p);
    /* The coarser manifold is some fifteen times as far from the true one as the finer. */
    n->error = 0.25 * n->error + 1.5 * n->sagitta + boundary_rounding;
    low = fmin(low, x);
    high = fmax(high, x);
  }
  /* For an angle, the curve moved by whole turns is a boundary, too. */
  const double turn = pendres_model_of(p->force)->period;
  const double from = turn > 0.0 ? floor((o->x_low - high) / turn) : 0.0;
  const double to = turn > 0.0 ? ceil((o->x_high - low) / turn) : 0.0;
  for (double k = from; k <= to && status == PENDRES_OK; k++)
    status = show(ctx, curve, p, o, k * turn, b);
  return status;
}

/* Add the curve of one point of the saddle to the boundary. */
static pendres_status add_point(pendres_context *ctx, const pendres_orbit *saddle,
                                const pendres_boundary_options *o, growing *b)
{
  pendres_boundary_seed seed;
  pendres_boundary_curve curve = {.complete = 1};
  int steps = 0;
  const double v = fmax(fabs(o->v_low), fabs(o->v_high)), x = fmax(fabs(o->x_low), fabs(o->x_high));
  const double speed = pendres_steps_speed(&saddle->pendulum, x, v);
  pendres_status status = pendres_steps_choose(ctx, &saddle->pendulum, speed,
                                               pendres_accuracy_first(ctx), &steps);
  if (status == PENDRES_OK)
    status = pendres_boundary_grow_seed(
      ctx, saddle, pendres_steps_finer(&saddle->pendulum, steps), &seed);
  if (status == PENDRES_OK) status = pendres_boundary_grow(ctx, &seed, o, &curve);
  if (status == PENDRES_OK) status = trace(ctx, saddle, o, steps, &curve, b);
  b->seen.complete = b->seen.complete && curve.complete;
  pendres_boundary_grow_free(&curve);
  return status;
}

static pendres_status boundary_find(pendres_context *ctx, const pendres_orbit *saddle,
                                    const pendres_boundary_options *options, pendres_boundary **out)
{
  if (saddle == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "saddle and out");
  const char *no_orbit = pendres_orbit_refuses(saddle);
  if (no_orbit != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "boundary: %s", no_orbit);
  *out = NULL;
  pendres_boundary_options o = {0};
  const char *why = NULL;
  if (options != NULL) o = *options;
  why = resolve(&saddle->pendulum, &o);
  if (why == NULL) why = pendres_equation_undamped(&saddle->pendulum);
  if (why == NULL && saddle->stable) why = "no curve of an attractor bounds its basin";
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "boundary: %s", why);

  growing *b = calloc(1, sizeof *b);
  if (b == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  b->seen.complete = 1;
  pendres_orbit point = *saddle;
  pendres_status status = PENDRES_OK;
  for (int j = 0; j < saddle->period && status == PENDRES_OK; j++) {
    if (j > 0) {
      pendres_status outcome = PENDRES_OK;
      pendres_orbit_guess next = {.pendulum = saddle->pendulum,
                                  .x = point.x,
                                  .v = point.v,
                                  .period = saddle->period,
                                  .winding = saddle->winding};
      status = pendres_strobe_advance(ctx, 1, &next.pendulum, &next.x, &next.v, 1, NULL);
      if (status == PENDRES_OK)
        status = pendres_orbit_find(ctx, 1, &next, PENDRES_ORBIT_PLAIN, &point, &outcome);
      if (status == PENDRES_OK && outcome == PENDRES_NOT_CONVERGED)
        status = pendres_context_fail(ctx, outcome, "a point of the saddle could not be refined");
      if (status != PENDRES_OK) break;
    }
    status = add_point(ctx, &point, &o, b);
  }
  if (status == PENDRES_OK) {
    *out = &b->seen;
    b = NULL;
  }
  pendres_boundary_free((pendres_boundary *)b);
  return status;
}

pendres_status pendres_boundary_find(pendres_context *ctx, const pendres_orbit *saddle,
                                     const pendres_boundary_options *options,
                                     pendres_boundary **out)
{
  pendres_door d = pendres_door_open(ctx, saddle != NULL ? &saddle->pendulum : NULL);
  PENDRES_DOOR_IN(&d, orbit, 1, saddle);
  PENDRES_DOOR_IN(&d, boundary_options, 1, options);
  PENDRES_DOOR_CALL(&d, boundary_find(ctx, saddle, options, out));
  if (d.status == PENDRES_OK) {
    pendres_boundary *b = *out;
    growing *g = (growing *)b;
    pendres_units_out(&d.scales, &pendres_dim_length, b->count, g->x);
    pendres_units_out(&d.scales, &pendres_dim_speed, b->count, g->v);
    pendres_units_out(&d.scales, &pendres_dim_length, b->count, g->error);
    pendres_units_out(&d.scales, &pendres_dim_length, 1, &b->bound);
  }
  return pendres_door_close(&d);
}
