/* find.c -- guesses of paths, made exact one by one; see path.h. */
#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/room.h"
#include "model/model.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"

pendres_status pendres_way_plan(const pendres_way_end *from, const pendres_way_end *to,
                                const pendres_pendulum *p, double reach, pendres_way_plan_of *out)
{
  const double period = two_pi / p->drive_frequency;
  const double stiff = pendres_model_stiffest(p, reach) * (1.0 + fabs(p->parametric_amplitude));
  const double quick = 1.0 / fmax(p->damping, fmax(sqrt(stiff), pendres_model_driven(p)
                                                                   ? p->drive_frequency : 0.0));
  const double folds = -log(way_cut);
  const double periods = ceil(folds / from->grows) + ceil(folds / to->grows) + 2.0;
  out->grid.pieces = (int)ceil(period * p->damping / way_folds + period / quick / 3.0);
  out->grid.steps = (int)ceil(period / out->grid.pieces / (way_fine * quick));
  out->each = (int)ceil(period / out->grid.pieces / (way_coarse * quick)) * out->grid.pieces;
  out->periods = (long)periods;
  out->cut = way_cut;
  return periods * out->each < WAY_MOST_POINTS ? PENDRES_OK : PENDRES_TOLERANCE_UNREACHABLE;
}

/* Positions of a motion without noise from a state on, `points` of the grid of candidates. */
static void follow(const pendres_way_flow *f, const double start[2], size_t points, double *x)
{
  double z[PATH_SIZE] = {start[0], start[1], 0.0, 0.0};
  for (size_t k = 0; k < points; k++) {
    x[k] = z[PATH_X];
    pendres_way_piece(f, (int)(k % (size_t)f->grid.pieces), z, NULL, NULL);
  }
}

/* A guess in the making, on the grid of candidates. */
typedef struct sketch {
  const pendres_way *path;
  const pendres_way_guess *guess;
  pendres_way_flow flow;
  int each;            /* points a drive period */
  size_t points;
  double *state, *saddle; /* positions of both orbits, over their cycles, */
  size_t cycle[2];     /* which are so many points */
  double *down;        /* [points] those of a motion without noise */
  double *x;           /* [points] the guess */
} sketch;

static double on(const double *orbit, size_t cycle, long k)
{
  const long n = (long)cycle, left = k % n;
  return orbit[left < 0 ? left + n : left];
}

/* Positions of the state's orbit and of the saddle's at a point of the grid. */
static double home(const sketch *s, long k)
{
  return on(s->state, s->cycle[0], k);
}

static double away(const sketch *s, long k)
{
  return on(s->saddle, s->cycle[1], k);
}

/* A path between both orbits, going over at the rates with which noise leaves and comes. */
static void blend(const sketch *s)
{
  const double from = s->path->from.grows, to = s->path->to.grows;
  const double rate = fmin(from, to) / s->each;
  const double middle = (double)s->points * to / (from + to) + s->guess->share * s->each;
  for (size_t k = 0; k < s->points; k++) {
    const double part = 1.0 / (1.0 + exp(-rate * ((double)k - middle)));
    s->x[k] = (1.0 - part) * home(s, (long)k) + part * away(s, (long)k);
  }
}

/* A state from which motions without noise come down from the saddle. */
static void beside(const pendres_way *path, const pendres_way_guess *guess, double start[2])
{
  const double apart = hypot(path->to.x - path->from.x, path->to.v - path->from.v);
  const double off = guess->side * path->cut * apart * exp(guess->share * path->to.grows);
  double e[2];
  pendres_way_direction(path->to.m, pendres_way_outside(path->to.m), e);
  start[0] = path->to.x + off * e[0];
  start[1] = path->to.v + off * e[1];
}

/* Such a motion reversed: without a drive it is the path, with q = x' and p = -v' + gamma v. */
static void turn_round(const pendres_way *path, const pendres_way_guess *guess)
{
  const pendres_way_flow *f = path->flow;
  const size_t last = (size_t)path->periods * (size_t)f->grid.pieces;
  double z[PATH_SIZE] = {0.0}, slope[PATH_SIZE];
  beside(path, guess, z);
  for (size_t k = 0; k <= last; k++) {
    double *node = path->z + PATH_SIZE * (last - k);
    pendres_way_slope(&f->p, 1.0, z, slope);
    node[PATH_X] = z[PATH_X];
    node[PATH_V] = node[PATH_Q] = -z[PATH_V];
    node[PATH_P] = -slope[PATH_V] - f->p.damping * z[PATH_V];
    pendres_way_piece(f, 0, z, NULL, NULL);
  }
}

/*
 * Back from the saddle in time, as motions come down from it to the state without noise, with both
 * orbits in the place of their own reversals. Without a drive this is the path, since detailed
 * balance holds. Returns how far from the state it ends, relative to the saddle's distance.
 */
static double reverse(const sketch *s)
{
  const pendres_way *path = s->path;
  const double apart = hypot(path->to.x - path->from.x, path->to.v - path->from.v);
  const long last = (long)s->points - 1;
  double start[2], off = 0.0;
  beside(path, s->guess, start);
  follow(&s->flow, start, s->points, s->down);
  for (long k = 0; k <= last; k++) {
    const double now = s->down[last - k], a = home(s, last - k), b = away(s, last - k);
    const double part = fabs(now - a) / (fabs(now - a) + fabs(now - b) + 0x1p-1000);
    s->x[k] = now + (1.0 - part) * (home(s, k) - a) + part * (away(s, k) - b);
    if (k < s->each) off = fmax(off, fabs(now - a) / apart);
  }
  return off;
}

/* The momentum q at a point of the grid of candidates. */
static double momentum(const pendres_pendulum *p, int each, const double *x, size_t points,
                       size_t k)
{
  double first[PATH_STENCIL], second[PATH_STENCIL], v = 0.0, a = 0.0, slope[PATH_SIZE];
  if (k < 2 || k + 2 >= points) return 0.0;
  pendres_way_differences(two_pi / p->drive_frequency / each, first, second);
  for (size_t i = 0; i < PATH_STENCIL; i++) {
    v += first[i] * x[k + i - 2];
    a += second[i] * x[k + i - 2];
  }
  pendres_way_slope(p, cos(two_pi * (double)(k % (size_t)each) / each),
                     (double[PATH_SIZE]){x[k], v, 0.0, 0.0}, slope);
  return (a - slope[PATH_V]) / (2.0 * p->damping);
}

/* Nodes from positions on the grid of candidates. */
static void take(const pendres_way *path, int each, const double *x, size_t points)
{
  const pendres_pendulum *p = &path->flow->p;
  const size_t last = (size_t)path->periods * (size_t)path->flow->grid.pieces;
  const size_t skip = (points - 1) / last;
  double first[PATH_STENCIL], second[PATH_STENCIL];
  pendres_way_differences(two_pi / p->drive_frequency / each, first, second);
  for (size_t k = 0; k <= last; k++) {
    const pendres_way_end *e = k == 0 ? &path->from : &path->to;
    double z[PATH_SIZE] = {e->x, e->v, 0.0, 0.0};
    if (k > 0 && k < last) {
      const size_t at = k * skip;
      z[PATH_X] = x[at];
      z[PATH_V] = 0.0;
      z[PATH_Q] = momentum(p, each, x, points, at);
      z[PATH_P] = p->damping * z[PATH_Q];
      for (size_t i = 0; i < PATH_STENCIL; i++) {
        z[PATH_V] += first[i] * x[at + i - 2];
        z[PATH_P] -= first[i] * momentum(p, each, x, points, at + i - 2);
      }
    }
    memcpy(path->z + PATH_SIZE * k, z, sizeof z);
  }
}

/* The node with the largest momentum q, but for the last. */
static size_t strongest(const pendres_way *path)
{
  const size_t last = (size_t)path->periods * (size_t)path->flow->grid.pieces;
  size_t best = 0;
  for (size_t k = 0; k < last; k++)
    if (fabs(path->z[PATH_SIZE * k + PATH_Q]) > fabs(path->z[PATH_SIZE * best + PATH_Q])) best = k;
  return best;
}

/* What a guess needs, and both orbits. */
static void prepare(sketch *s, pendres_room *room)
{
  const pendres_way *path = s->path;
  s->points = (size_t)path->periods * (size_t)s->each + 1;
  s->cycle[0] = (size_t)path->from.cycle * (size_t)s->each;
  s->cycle[1] = (size_t)path->to.cycle * (size_t)s->each;
  s->x = pendres_room_take(room, s->points, sizeof(double));
  s->down = pendres_room_take(room, s->points, sizeof(double));
  s->state = pendres_room_take(room, s->cycle[0], sizeof(double));
  s->saddle = pendres_room_take(room, s->cycle[1], sizeof(double));
  double *cosine = pendres_room_take(room, (size_t)s->each * PATH_STAGES, sizeof(double));
  if (room->status != PENDRES_OK) return;
  pendres_way_flow_make(&path->flow->p, (pendres_way_grid){s->each, 1}, cosine, &s->flow);
  follow(&s->flow, (double[2]){path->from.x, path->from.v}, s->cycle[0], s->state);
  follow(&s->flow, (double[2]){path->to.x, path->to.v}, s->cycle[1], s->saddle);
}

/* Minimise a guess, and take its nodes. */
static pendres_status settle_down(pendres_context *ctx, const sketch *s, double *coarse)
{
  for (long i = 0; i < PATH_STENCIL / 2 + 1; i++) { /* what is kept at either end */
    s->x[i] = home(s, i);
    s->x[s->points - 1 - (size_t)i] = away(s, -i);
  }
  const pendres_status status =
    pendres_way_relax(ctx, &s->flow.p, s->points, s->each, s->x, coarse);
  if (status == PENDRES_OK) take(s->path, s->each, s->x, s->points);
  return status;
}

pendres_status pendres_way_try(pendres_context *ctx, const pendres_way_guess *guess, int each,
                               pendres_way *path, double *coarse)
{
  pendres_room room = pendres_room_open(ctx, "paths of an escape");
  sketch s = {.path = path, .guess = guess, .each = each};
  double off = 0.0;
  prepare(&s, &room);
  *coarse = NAN;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  if (guess->side == 0.0) blend(&s);
  else off = reverse(&s);
  if (!(off < way_off)) return pendres_room_close(&room, PENDRES_NOT_FOUND);
  /* Reversed motions are paths already where detailed balance holds. */
  pendres_status status = PENDRES_OK;
  if (!pendres_model_driven(&path->flow->p) && guess->side != 0.0) turn_round(path, guess);
  else status = settle_down(ctx, &s, coarse);
  path->middle = strongest(path);
  if (status == PENDRES_OK) status = pendres_way_polish(ctx, path);
  return pendres_room_close(&room, status);
}
