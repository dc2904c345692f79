/* boundary_grow.c -- growing a stable manifold backwards in time; see boundary_grow.h. */
#include "analysis/basins/boundary_grow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/basins/numbers.h"
#include "base/angles.h"
#include "base/grow.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "engine/strobe_run.h"
#include "engine/threads.h"
#include "model/equation.h"
#include "model/model.h"

static const double far_before = -1e4; /* a seed parameter on the saddle */
/* The coordinate that stands for a place at infinity, beyond all windows. */
static const double at_infinity = 1e9;

void pendres_boundary_grow_free(pendres_boundary_curve *curve)
{
  free(curve->node);
  *curve = (pendres_boundary_curve){0};
}

/* ---- the local manifold ---- */

/* Unit eigenvector of the map's derivative for an eigenvalue, and of its transpose. */
static void eigenvectors(const pendres_image *image, double eigenvalue, double right[2],
                         double left[2])
{
  const double a = image->n[0][0] - eigenvalue, b = image->n[0][1];
  const double c = image->n[1][0], d = image->n[1][1] - eigenvalue;
  const int upper = hypot(a, b) > hypot(c, d), first = hypot(a, c) > hypot(b, d);
  const double r = upper ? hypot(a, b) : hypot(c, d), l = first ? hypot(a, c) : hypot(b, d);
  right[0] = (upper ? -b : -d) / r;
  right[1] = (upper ? a : c) / r;
  left[0] = (first ? -c : -d) / l;
  left[1] = (first ? a : b) / l;
}

/* l . D2P(e, e) by central differences of the monodromy over h. */
static pendres_status second_derivative(pendres_context *ctx, const pendres_system *closing,
                                        const pendres_u u, const double e[2],
                                        const double l[2], double *out)
{
  const double h = pendres_central_step;
  double points[2][PENDRES_U_COUNT], sum = 0.0;
  pendres_image image[2];
  for (int i = 0; i < 2; i++) {
    memcpy(points[i], u, sizeof points[i]);
    points[i][PENDRES_U_Y] += (2 * i - 1) * h * e[0];
    points[i][PENDRES_U_W] += (2 * i - 1) * h * e[1];
  }
  const pendres_status status = pendres_map_states(
    ctx, &closing->map, closing->steps, 2, (const pendres_u *)points, image);
  for (int i = 0; i < 2 && status == PENDRES_OK; i++)
    for (int k = 0; k < 2; k++)
      sum += l[i] * (image[1].n[i][k] - image[0].n[i][k]) / (2.0 * h) * e[k];
  *out = sum;
  return status;
}

pendres_status pendres_boundary_grow_seed(pendres_context *ctx, const pendres_orbit *saddle,
                                          int steps, pendres_boundary_seed *seed)
{
  static const int unknown[] = {PENDRES_U_Y, PENDRES_U_W};
  pendres_u u;
  double stable[2], unstable[2], left[2], unused[2], second = 0.0;
  pendres_equations at;
  (void)pendres_map_of(saddle, 2, unknown, u);
  /* The map over the whole period, even where that over half of it would do. */
  const pendres_map map = {
    .force = saddle->pendulum.force, .period = saddle->period, .winding = saddle->winding};
  pendres_system closing = pendres_system_of(&map, PENDRES_CONDITION_NONE, unknown);
  closing.steps = steps;
  pendres_status status = pendres_equations_solve(ctx, &closing, 0.01, u, &at);
  if (status == PENDRES_NOT_CONVERGED)
    return pendres_context_fail(ctx, status, "the saddle is not an orbit at %d steps a period",
                                steps);
  if (status != PENDRES_OK) return status;
  const double half = 0.5 * at.image.trace, product = at.image.determinant;
  const double discriminant = half * half - product;
  const double large = half + copysign(sqrt(fmax(discriminant, 0.0)), half);
  const double small = product / large;
  if (!(discriminant > 0.0 && fabs(large) > 1.0 && fabs(small) < 1.0))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "the orbit with multipliers of modulus %g and %g is no saddle",
                                fabs(large), fabs(small));
  eigenvectors(&at.image, small, stable, unused);
  eigenvectors(&at.image, large, unstable, left);
  status = second_derivative(ctx, &closing, u, stable, left, &second);
  if (status != PENDRES_OK) return status;

  const double across[2] = {-stable[1], stable[0]};
  const double l_across = left[0] * across[0] + left[1] * across[1];
  *seed = (pendres_boundary_seed){
    .backward = pendres_equation_reversed(&saddle->pendulum),
    .iterates = saddle->period * (small < 0.0 ? 2 : 1),
    .steps = steps,
    .y = u[PENDRES_U_Y],
    .w = -u[PENDRES_U_W],
    .e = {stable[0], -stable[1]},
    .f = {across[0], -across[1]},
    /* Invariance under the map, second order in a, seen by the unstable left eigenvector. */
    .bend = 0.5 * second / ((small * small - large) * l_across),
    .start = boundary_start,
    .ratio = pow(1.0 / fabs(small), small < 0.0 ? 2.0 : 1.0)};
  return PENDRES_OK;
}

/* ---- mapping ---- */

static void place(const pendres_boundary_seed *seed, double s, int side, double *y, double *w)
{
  const double a = side * seed->start * pow(seed->ratio, s);
  *y = seed->y + a * (seed->e[0] + seed->bend * a * seed->f[0]);
  *w = seed->w + a * (seed->e[1] + seed->bend * a * seed->f[1]);
}

static int mapped(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  /* A polynomial force may lead to infinity within some periods, back in time as forwards. */
  return lane->period >= ((const long *)arg)[index] || !isfinite(lane->y) || !isfinite(lane->w);
}

/* Where a lane has come to, back in time. */
static void take_back(const pendres_strobe_lane *lane, double *y, double *w)
{
  *y = lane->y + two_pi * (double)lane->turns;
  *w = -lane->w;
  if (isfinite(*y) && isfinite(*w)) return;
  *y = at_infinity;
  *w = at_infinity;
}

/* Where n nodes are, from their seeds. */
static pendres_status map_seeds(pendres_context *ctx, const pendres_boundary_seed *seed, size_t n,
                                const pendres_boundary_node *nodes, double *y, double *w)
{
  size_t moving = 0;
  pendres_room room = pendres_room_open(ctx, "points of a boundary");
  pendres_strobe_lane *lane = pendres_room_take(&room, n, sizeof *lane);
  long *periods = pendres_room_take(&room, n, sizeof *periods);
  size_t *index = pendres_room_take(&room, n, sizeof *index);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    place(seed, nodes[i].s, nodes[i].side, &y[i], &w[i]);
    w[i] = -w[i];
    if (nodes[i].generation == 0) continue;
    lane[moving] = (pendres_strobe_lane){
      .pendulum = &seed->backward, .y = y[i], .w = -w[i], .steps = seed->steps};
    periods[moving] = (long)nodes[i].generation * seed->iterates;
    index[moving++] = i;
  }
  const pendres_status status = pendres_strobe_run(ctx, moving, lane, mapped, periods);
  for (size_t i = 0; i < moving && status == PENDRES_OK; i++)
    take_back(&lane[i], &y[index[i]], &w[index[i]]);
  return pendres_room_close(&room, status);
}

/* ---- refining ---- */

typedef struct front {
  const pendres_boundary_seed *seed;
  const pendres_boundary_options *options;
  /* Beyond this speed a state never comes back, going back in time; with another force states are
     given up beyond these bounds, and may come back. */
  double out_v, out_low, out_high;
  size_t count, capacity;
  pendres_boundary_node *node; /* of one side and generation, s ascending */
  size_t most; /* nodes that the curve and the front have had together */
} front;

static int is_out(const front *f, const pendres_boundary_node *n)
{
  return fabs(n->w) * f->seed->backward.drive_frequency > f->out_v || n->y < f->out_low ||
         n->y > f->out_high;
}

/* Room for n nodes. */
static int reserve(pendres_boundary_node **node, size_t *capacity, size_t n)
{
  if (n <= *capacity) return 0;
  const size_t size = n + n / 2 + 64;
  if (!pendres_regrow(node, size, sizeof **node)) return -1;
  *capacity = size;
  return 0;
}

static double chord(const front *f, size_t i, double *dx, double *dv)
{
  *dx = f->node[i + 1].y - f->node[i].y;
  *dv = (f->node[i + 1].w - f->node[i].w) * f->seed->backward.drive_frequency;
  return hypot(*dx, *dv);
}

/* The largest distance of the arc from chord i, judged by the angles with the chords beside it. */
static double sagitta(const front *f, size_t i)
{
  double dx, dv, ex, ev, turn = 0.0;
  const double length = chord(f, i, &dx, &dv);
  for (int side = -1; side <= 1; side += 2) {
    if ((side < 0 && i == 0) || (side > 0 && i + 2 >= f->count)) continue;
    const double other = chord(f, side < 0 ? i - 1 : i + 1, &ex, &ev);
    if (!(length > 0.0 && other > 0.0)) continue;
    const double angle = fabs(atan2(dx * ev - dv * ex, dx * ex + dv * ev));
    /* The angle is spread over half of each of the two chords. */
    turn = fmax(turn, angle * 2.0 * length / (length + other));
  }
  return turn * length / 8.0;
}

/* Whether a chord is longer or more bent than wanted; not tested for one that has left for good. */
static int too_coarse(const front *f, size_t i)
{
  double dx, dv;
  if (is_out(f, &f->node[i]) && is_out(f, &f->node[i + 1])) return 0;
  (void)chord(f, i, &dx, &dv);
  return fabs(dx) > f->options->spacing || fabs(dv) > f->options->spacing ||
         sagitta(f, i) > f->options->deviation;
}

static int divisible(const front *f, size_t i)
{
  return f->node[i + 1].s - f->node[i].s > boundary_closest;
}

/* Neighbours i and i + 1 are not joined where both have left for good, nor where the curve is
   stretched so much that what lies between them cannot be told. */
static int joined(const front *f, size_t i)
{
  return i + 1 < f->count && !(is_out(f, &f->node[i]) && is_out(f, &f->node[i + 1])) &&
         !too_coarse(f, i);
}

/* Put a node into the middle of every chord that is too long or too bent; *added counts them. */
static pendres_status refine_once(pendres_context *ctx, front *f, size_t most, size_t *added)
{
  size_t coarse = 0;
  for (size_t i = 0; i + 1 < f->count; i++) coarse += (size_t)(too_coarse(f, i) && divisible(f, i));
  if (coarse > most) coarse = most;
  *added = coarse;
  if (coarse == 0) return PENDRES_OK;
  if (reserve(&f->node, &f->capacity, f->count + coarse) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  pendres_room room = pendres_room_open(ctx, "points of a boundary");
  pendres_boundary_node *more = pendres_room_take(&room, coarse, sizeof *more);
  double *y = pendres_room_take(&room, coarse, sizeof *y);
  double *w = pendres_room_take(&room, coarse, sizeof *w);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  size_t k = 0;
  for (size_t i = 0; i + 1 < f->count && k < coarse; i++)
    if (too_coarse(f, i) && divisible(f, i)) {
      more[k] = f->node[i];
      more[k++].s = 0.5 * (f->node[i].s + f->node[i + 1].s);
    }
  const pendres_status status = map_seeds(ctx, f->seed, coarse, more, y, w);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0; i < coarse; i++) {
    more[i].y = y[i];
    more[i].w = w[i];
  }
  /* Merge from the end, both lists ascending in s. */
  size_t from = f->count, to = f->count + coarse;
  for (k = coarse; to-- > 0;)
    f->node[to] = k > 0 && (from == 0 || more[k - 1].s > f->node[from - 1].s) ? more[--k]
                                                                              : f->node[--from];
  f->count += coarse;
  return pendres_room_close(&room, status);
}

/* ---- generations ---- */

/* Map all nodes of the front back once more. */
static pendres_status next_generation(pendres_context *ctx, front *f)
{
  pendres_room room = pendres_room_open(ctx, "points of a boundary");
  pendres_strobe_lane *lane = pendres_room_take(&room, f->count, sizeof *lane);
  long *periods = pendres_room_take(&room, f->count, sizeof *periods);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < f->count; i++) {
    lane[i] = (pendres_strobe_lane){.pendulum = &f->seed->backward,
                                    .y = f->node[i].y,
                                    .w = -f->node[i].w,
                                    .steps = f->seed->steps};
    pendres_coordinates_wrap(lane[i].pendulum, &lane[i].y, &lane[i].turns);
    periods[i] = f->seed->iterates;
  }
  pendres_status status = pendres_strobe_run(ctx, f->count, lane, mapped, periods);
  for (size_t i = 0; i < f->count && status == PENDRES_OK; i++) {
    f->node[i].generation++;
    take_back(&lane[i], &f->node[i].y, &f->node[i].w);
  }
  return pendres_room_close(&room, status);
}

/* Append the front to the curve. A new piece begins where neighbours are not joined; the first
   node of a generation is the last of the one before it. */
static pendres_status deliver(pendres_context *ctx, const front *f, pendres_boundary_curve *curve)
{
  if (reserve(&curve->node, &curve->capacity, curve->count + f->count) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  for (size_t i = 0; i < f->count; i++) {
    const int before = i > 0 && joined(f, i - 1), behind = joined(f, i);
    if (i + 1 < f->count && too_coarse(f, i)) curve->complete = 0;
    const int first = f->node[i].s == 0.0 && f->node[i].generation > 0;
    if (!before && !behind) continue;
    if (first) continue;
    if (!before && f->node[i].generation > 0 && !(i == 1 && f->node[0].s == 0.0)) curve->pieces++;
    pendres_boundary_node *n = &curve->node[curve->count++];
    *n = f->node[i];
    n->piece = curve->pieces;
    n->sagitta = fmax(before ? sagitta(f, i - 1) : 0.0, behind ? sagitta(f, i) : 0.0);
  }
  return PENDRES_OK;
}

/* Drop the nodes that are joined to neither neighbour: nothing more comes from them. */
static void prune(front *f)
{
  size_t kept = 0;
  int before = 0;
  for (size_t i = 0; i < f->count; i++) {
    const int behind = joined(f, i);
    const int keep = before || behind;
    before = behind;
    /* Nodes ahead are still in place: kept <= i. */
    if (keep) f->node[kept++] = f->node[i];
  }
  f->count = kept;
}

static pendres_status grow_side(pendres_context *ctx, front *f, int side,
                                pendres_boundary_curve *curve)
{
  pendres_status status = PENDRES_OK;
  f->count = 0;
  if (reserve(&f->node, &f->capacity, BOUNDARY_FIRST_NODES) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  for (int i = 0; i < BOUNDARY_FIRST_NODES; i++) {
    pendres_boundary_node *n = &f->node[f->count++];
    *n = (pendres_boundary_node){.s = (double)i / (BOUNDARY_FIRST_NODES - 1), .side = side};
    place(f->seed, n->s, side, &n->y, &n->w);
    n->w = -n->w;
  }
  /* The curve begins at the saddle itself; from the next generation on at the segment's start. */
  f->node[0].s = far_before;
  place(f->seed, far_before, side, &f->node[0].y, &f->node[0].w);
  f->node[0].w = -f->node[0].w;
  status = deliver(ctx, f, curve);
  f->node[0].s = 0.0;
  place(f->seed, 0.0, side, &f->node[0].y, &f->node[0].w);
  f->node[0].w = -f->node[0].w;
  for (int generation = 1; f->count > 0 && status == PENDRES_OK; generation++) {
    size_t added = 1;
    status = next_generation(ctx, f);
    for (int round = 0; round < ITERATIONS && added > 0 && status == PENDRES_OK; round++) {
      const size_t taken = curve->count + f->count;
      const size_t most = taken < f->options->most_points ? f->options->most_points - taken : 0;
      if (most == 0) break;
      status = refine_once(ctx, f, most, &added);
    }
    if (status == PENDRES_OK) status = deliver(ctx, f, curve);
    if (curve->count + f->count > f->most) f->most = curve->count + f->count;
    prune(f);
    if (curve->count + f->count >= f->options->most_points || generation >= BOUNDARY_GENERATIONS) {
      curve->complete = 0;
      break;
    }
  }
  curve->pieces++;
  return status;
}

/*
 * Going back in time, friction gives more energy than the push can take while |v| is
 * above the speed at which the two balance, and the
 * potential of a pendulum varies by 2: faster than out_v, |v| never falls below `speed` again. The
 * push is what drive, torque and parametric drive can do at most. Other potentials vary by more, or
 * without bound, and their states are followed to twice the window's size around it.
 */
static front front_of(const pendres_boundary_seed *seed, const pendres_boundary_options *o)
{
  const pendres_pendulum *p = &seed->backward;
  const double most = fmax(fabs(o->v_low), fabs(o->v_high));
  if (p->force != PENDRES_FORCE_PENDULUM) {
    const double width = o->x_high - o->x_low;
    return (front){.seed = seed, .options = o, .out_v = 2.0 * most,
                   .out_low = o->x_low - 0.5 * width, .out_high = o->x_high + 0.5 * width};
  }
  const double push = fabs(p->drive_amplitude) + fabs(p->torque) + fabs(p->parametric_amplitude);
  const double speed = fmax(most, pendres_equation_speed(p, push));
  return (front){.seed = seed, .options = o, .out_v = sqrt(speed * speed + 4.0),
                 .out_low = -INFINITY, .out_high = INFINITY};
}

/* Both sides of a curve, each by itself. */
typedef struct sides {
  const pendres_boundary_seed *seed;
  const pendres_boundary_options *options;
  pendres_boundary_curve own[2];
  size_t most[2];
} sides;

static pendres_status grow_some(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  sides *s = arg;
  pendres_status status = PENDRES_OK;
  for (size_t i = first; i < first + count && status == PENDRES_OK; i++) {
    front f = front_of(s->seed, s->options);
    status = grow_side(ctx, &f, i == 0 ? 1 : -1, &s->own[i]);
    s->most[i] = f.most;
    free(f.node);
  }
  return status;
}

/* Append one curve to another. */
static pendres_status join(pendres_context *ctx, const pendres_boundary_curve *from,
                           pendres_boundary_curve *to)
{
  if (reserve(&to->node, &to->capacity, to->count + from->count) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  for (size_t i = 0; i < from->count; i++) {
    to->node[to->count] = from->node[i];
    to->node[to->count++].piece += to->pieces;
  }
  to->pieces += from->pieces;
  to->complete = to->complete && from->complete;
  return PENDRES_OK;
}

/* The second side may take as many nodes as the first leaves: only where it is not short of them
   can the two grow at the same time. */
pendres_status pendres_boundary_grow(pendres_context *ctx, const pendres_boundary_seed *seed,
                                     const pendres_boundary_options *o,
                                     pendres_boundary_curve *curve)
{
  sides s = {.seed = seed, .options = o, .own = {{.complete = 1}, {.complete = 1}}};
  if (seed->backward.force != PENDRES_FORCE_PENDULUM) curve->complete = 0;
  pendres_status status = pendres_threads_run(ctx, 2, 1, grow_some, &s);
  if (status == PENDRES_OK) status = join(ctx, &s.own[0], curve);
  if (status == PENDRES_OK && curve->count + s.most[1] < o->most_points) {
    status = join(ctx, &s.own[1], curve);
  } else if (status == PENDRES_OK) {
    front f = front_of(seed, o);
    status = grow_side(ctx, &f, -1, curve);
    free(f.node);
  }
  for (int i = 0; i < 2; i++) pendres_boundary_grow_free(&s.own[i]);
  return status;
}
