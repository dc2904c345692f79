/* crossed.c -- where branches and curves take a value of a parameter; see continuation.h. */
#include "continuation/branch.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "continuation/curve/curve.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/sets.h"
#include "continuation/units.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"

/* Chords of a curve's points. */
static size_t chords_of(const pendres_curve *c)
{
  return c->count < 2 ? 0 : pendres_curve_closed(c) ? c->count : c->count - 1;
}

/* ---- branches ---- */

double pendres_branch_value(const pendres_curve *b, size_t i)
{
  return pendres_parameter_get(pendres_curve_parameter(b, 0), &b->branch_point[i].orbit.pendulum);
}

pendres_orbit_guess pendres_branch_between(const pendres_orbit *p, const pendres_orbit *q,
                                           double part, pendres_parameter parameter, double value)
{
  const double dx = pendres_less_turns(q->x - p->x, pendres_model_turn(&p->pendulum));
  return (pendres_orbit_guess){
    .pendulum = pendres_parameter_with(&p->pendulum, parameter, value),
    .x = p->x + part * dx,
    .v = p->v + part * (q->v - p->v),
    .period = p->period,
    .winding = p->winding};
}

/* Guess the orbits of a branch at a value of its parameter; returns their number. guess: NULL, to
   count them. */
static size_t guesses_at(const pendres_curve *b, double value, pendres_orbit_guess *guess)
{
  const int closed = pendres_curve_closed(b);
  const size_t chords = chords_of(b);
  size_t n = 0;
  for (size_t i = 0; i < chords; i++) {
    const size_t k = (i + 1) % b->count;
    const double from = pendres_branch_value(b, i) - value, to = pendres_branch_value(b, k) - value;
    const int last = to == 0.0 && k == b->count - 1 && !closed;
    /* A value that a point has exactly belongs to the chord that begins there. */
    if (from != 0.0 && !(from * to < 0.0) && !last) continue;
    const double part = from == 0.0 ? 0.0 : last ? 1.0 : from / (from - to);
    if (guess != NULL)
      guess[n] = pendres_branch_between(&b->branch_point[i].orbit, &b->branch_point[k].orbit, part,
                                        pendres_curve_parameter(b, 0), value);
    n++;
  }
  return n;
}

pendres_status pendres_branch_cross_each(pendres_context *ctx, const pendres_branch *branch,
                                         size_t n, const double *value,
                                         pendres_branch_crossed *take, void *arg)
{
  const pendres_curve *b = &branch->curve;
  pendres_room room = pendres_room_open(ctx, "orbits");
  size_t *first = pendres_room_take(&room, n + 1, sizeof *first);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t k = 0; k < n; k++) first[k + 1] = first[k] + guesses_at(b, value[k], NULL);
  pendres_orbit_guess *guess = pendres_room_take(&room, first[n], sizeof *guess);
  pendres_orbit *orbit = pendres_room_take(&room, first[n], sizeof *orbit);
  pendres_status *outcome = pendres_room_take(&room, first[n], sizeof *outcome);
  pendres_status status = room.status;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++)
    (void)guesses_at(b, value[k], guess + first[k]);
  if (status == PENDRES_OK)
    status = pendres_orbit_find(ctx, first[n], guess, PENDRES_ORBIT_PLAIN, orbit, outcome);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++)
    for (size_t i = first[k]; i < first[k + 1]; i++)
      if (outcome[i] != PENDRES_NOT_CONVERGED) take(arg, k, &orbit[i]);
  return pendres_room_close(&room, status);
}

/* The caller's room for orbits, and how many there are. */
typedef struct crossed {
  size_t room, found;
  pendres_orbit *out;
} crossed;

static void take_one(void *arg, size_t k, const pendres_orbit *orbit)
{
  crossed *c = arg;
  (void)k;
  if (c->found < c->room) c->out[c->found] = *orbit;
  c->found++;
}

static pendres_status branch_cross(pendres_context *ctx, const pendres_branch *b, double value,
                                   size_t room, pendres_orbit *out, size_t *found)
{
  if (b == NULL || found == NULL || (room > 0 && out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "branch, out and found");
  *found = 0;
  if (!isfinite(value))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the value must be finite");
  crossed c = {.room = room, .out = out};
  const pendres_status status = pendres_branch_cross_each(ctx, b, 1, &value, take_one, &c);
  *found = c.found;
  return status;
}

pendres_status pendres_branch_cross(pendres_context *ctx, const pendres_branch *b, double value,
                                    size_t room, pendres_orbit *out, size_t *found)
{
  pendres_door d;
  const pendres_curve *inside = pendres_curve_open(&d, ctx, b != NULL ? &b->curve : NULL);
  PENDRES_DOOR_OUT(&d, orbit, room, out);
  return PENDRES_DOOR_END(&d, branch_cross(ctx, (const pendres_branch *)inside,
                                           value / d.scales.first, room, out, found));
}

/*
 * ---- curves of bifurcations ----
 *
 * Between two of its points a curve is taken for the cubic through four: the parameter may turn
 * back between them, and take the value twice or three times.
 */

enum { NODES = 4, ROOTS = 3, PARTS = 16, SAMPLES = 2 * PARTS, BISECTIONS = 40 };

/* Points around a chord, which goes from t = 0 to its length. */
typedef struct stencil {
  int nodes;
  double t[NODES]; /* distance along the points, scaled as arclength */
  pendres_u u[NODES];
  double length;
} stencil;

/* Point number k of a curve, moved by whole turns next to the point at hand. */
static void next_to(const pendres_curve *c, size_t k, const pendres_u here, pendres_u u)
{
  const pendres_map *map = &c->kind.system.map;
  const double turn = map->mirror ? 0.0 : pendres_model_of(map->force)->period;
  memcpy(u, c->u[k], PENDRES_U_COUNT * sizeof *u);
  if (turn > 0.0) u[PENDRES_U_Y] -= turn * rint((u[PENDRES_U_Y] - here[PENDRES_U_Y]) / turn);
}

/* A third and a fourth node: the first points beyond the chord that are not too close to it. */
static void add_beyond(stencil *s, const pendres_curve *c, size_t from, size_t other, int side)
{
  double away = 0.0, here[PENDRES_U_COUNT], beyond[PENDRES_U_COUNT];
  size_t at = from;
  memcpy(here, s->u[side < 0 ? 0 : 1], sizeof here);
  while (away < crossed_not_too_close * s->length) {
    if ((side < 0 ? at == 0 : at + 1 == c->count) && !pendres_curve_closed(c)) return;
    at = (at + (side < 0 ? c->count - 1 : 1)) % c->count;
    if (at == other) return;
    next_to(c, at, here, beyond);
    away += pendres_arc_distance(&c->kind.system.map, here, beyond);
    memcpy(here, beyond, sizeof here);
  }
  memcpy(s->u[s->nodes], here, sizeof here);
  s->t[s->nodes++] = side < 0 ? -away : s->length + away;
}

/* The chord from point i to the next (after the last one the first, if closed). */
static stencil stencil_of(const pendres_curve *c, size_t i)
{
  const size_t k = (i + 1) % c->count;
  stencil s = {.nodes = 2};
  memcpy(s.u[0], c->u[i], sizeof s.u[0]);
  next_to(c, k, s.u[0], s.u[1]);
  s.length = s.t[1] = pendres_arc_distance(&c->kind.system.map, s.u[0], s.u[1]);
  add_beyond(&s, c, i, k, -1);
  add_beyond(&s, c, k, i, 1);
  return s;
}

static void point_at(const stencil *s, double t, pendres_u u)
{
  memset(u, 0, PENDRES_U_COUNT * sizeof *u);
  for (int i = 0; i < s->nodes; i++) {
    double weight = 1.0;
    for (int k = 0; k < s->nodes; k++)
      if (k != i) weight *= (t - s->t[k]) / (s->t[i] - s->t[k]);
    for (int m = 0; m < PENDRES_U_COUNT; m++) u[m] += weight * s->u[i][m];
  }
}

static double off(const stencil *s, int place, double value, double t)
{
  pendres_u u;
  point_at(s, t, u);
  return u[place] - value;
}

/* Samples along the chord, and vertices of parabolas through three: no pair of roots is lost. */
static int sample(const stencil *s, int place, double value, double t[SAMPLES], double g[SAMPLES])
{
  const double h = s->length / PARTS;
  double even[PARTS + 1];
  int n = 0;
  for (int j = 1; j < PARTS; j++) even[j] = off(s, place, value, j * h);
  /* The ends are the curve's own points to the last digit, so that neighbouring chords agree. */
  even[0] = s->u[0][place] - value;
  even[PARTS] = s->u[1][place] - value;
  for (int j = 0; j <= PARTS; j++) {
    const double bend = j % PARTS == 0 ? 0.0 : even[j + 1] - 2.0 * even[j] + even[j - 1];
    const double vertex = bend != 0.0 ? 0.5 * (even[j - 1] - even[j + 1]) / bend : 0.0;
    if (vertex < 0.0 && vertex > -0.5) {
      t[n] = (j + vertex) * h;
      g[n] = off(s, place, value, t[n]);
      n++;
    }
    t[n] = j * h;
    g[n++] = even[j];
    if (vertex > 0.0 && vertex <= 0.5) {
      t[n] = (j + vertex) * h;
      g[n] = off(s, place, value, t[n]);
      n++;
    }
  }
  return n;
}

/* Find where 0 <= t < length (<= if `last`) and coordinate `place` has a value; returns their
   number. */
static int roots_of(const stencil *s, int place, double value, int last, double t[ROOTS])
{
  double at[SAMPLES], g[SAMPLES];
  const int n = sample(s, place, value, at, g);
  int found = 0;
  for (int j = 0; j + 1 < n && found < ROOTS; j++) {
    double low = at[j], high = at[j + 1];
    if (g[j] != 0.0 && !(g[j] * g[j + 1] < 0.0)) continue;
    for (int b = 0; b < BISECTIONS && g[j] != 0.0; b++) {
      const double middle = 0.5 * (low + high);
      if (off(s, place, value, middle) * g[j] > 0.0) low = middle;
      else high = middle;
    }
    t[found++] = g[j] == 0.0 ? low : 0.5 * (low + high);
  }
  if (last && g[n - 1] == 0.0 && found < ROOTS) t[found++] = s->length;
  return found;
}

static pendres_status curve_cross(pendres_context *ctx, const pendres_curve *c, double value,
                                  size_t room, pendres_bifurcation *out, size_t *found)
{
  if (c == NULL || found == NULL || (room > 0 && out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "curve, out and found");
  if (!isfinite(value))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the value must be finite");
  *found = 0;
  const pendres_condition condition = c->kind.system.condition;
  const pendres_map *map = &c->kind.system.map;
  const int second = c->kind.system.unknown[3];
  pendres_u guess, last_guess, last;
  for (size_t i = 0; i < chords_of(c); i++) {
    double t[ROOTS];
    const stencil s = stencil_of(c, i);
    const int is_last = !pendres_curve_closed(c) && i + 2 == c->count;
    const int roots = roots_of(&s, second, value, is_last, t);
    for (int r = 0; r < roots; r++) {
      pendres_located located;
      point_at(&s, t[r], guess);
      /* What stays as it is along the curve does so to the last bit. */
      for (int k = PENDRES_U_OMEGA; k < PENDRES_U_COUNT; k++)
        if (k != c->kind.system.unknown[2]) guess[k] = k == second ? value : c->u[i][k];
      pendres_status status =
        pendres_curve_locate(ctx, &c->kind, condition, guess, 2.0 * s.length + crossed_besides,
                             &located);
      if (status == PENDRES_NOT_CONVERGED) continue;
      if (!pendres_located_found(status)) return status;
      /* Next to a turn of the curve two guesses may lead to one: it is counted once. */
      const int again = *found > 0 &&
                        pendres_arc_distance(map, located.pair.fine, last) <
                          crossed_together * pendres_arc_distance(map, guess, last_guess);
      memcpy(last_guess, guess, sizeof last_guess);
      memcpy(last, located.pair.fine, sizeof last);
      if (again) continue;
      if (*found < room) {
        status = pendres_locate_bifurcation(ctx, condition, pendres_curve_parameter(c, 0), &located,
                                            &out[*found]);
        if (status != PENDRES_OK) return status;
      }
      ++*found;
    }
  }
  return PENDRES_OK;
}

pendres_status pendres_curve_cross(pendres_context *ctx, const pendres_curve *c, double value,
                                   size_t room, pendres_bifurcation *out, size_t *found)
{
  pendres_door d;
  const pendres_curve *inside = pendres_curve_open(&d, ctx, c);
  PENDRES_DOOR_OUT(&d, bifurcation, room, out);
  return PENDRES_DOOR_END(&d, curve_cross(ctx, inside, value / d.scales.second, room, out, found));
}
