/* follow.c -- along a curve of solutions by pseudo-arclength; see follow.h. */
#include "continuation/curve/follow.h"

#include <math.h>
#include <string.h>

#include "continuation/curve/crossing.h"
#include "continuation/curve/locate.h"
#include "continuation/curve/numbers.h"
#include "engine/accuracy.h"
#include "engine/room.h"

pendres_followed pendres_followed_of(const pendres_orbit *orbit, pendres_condition condition,
                                     const pendres_parameter *parameter, double spacing,
                                     pendres_u u)
{
  pendres_followed kind = {.tolerance = pendres_accuracy_of_arcs(), .spacing = spacing};
  pendres_system *s = &kind.system;
  *s = (pendres_system){.condition = condition,
                        .unknowns = condition == PENDRES_CONDITION_NONE ? 3 : 4,
                        .unknown = {PENDRES_U_Y, PENDRES_U_W}};
  for (int k = 2; k < s->unknowns; k++) s->unknown[k] = PENDRES_U_OMEGA + (int)parameter[k - 2];
  s->map = pendres_map_of(orbit, s->unknowns, s->unknown, u);
  return kind;
}

/* The scale of unknown number k at a place. */
static double scale_at(const pendres_system *s, int k, const pendres_u u)
{
  return s->length > 0.0 && k < 2 ? s->length : pendres_arc_scale(&s->map, s->unknown[k], u);
}

/* From a to b along unknown number k, in the scale between them. */
static double way_between(const pendres_system *s, int k, const pendres_u a, const pendres_u b)
{
  const int i = s->unknown[k];
  const double scale =
    s->length > 0.0 && k < 2 ? s->length : pendres_arc_scale_between(&s->map, i, a, b);
  return (b[i] - a[i]) / scale;
}

/* The equations at u, and the plane across a direction, linearised in the scaled unknowns. */
static void linearise(const pendres_system *s, const pendres_equations *e, const pendres_u u,
                      const double *direction, double a[][PENDRES_U_COUNT])
{
  const int n = s->unknowns;
  for (int k = 0; k < n; k++) {
    for (int r = 0; r < n - 1; r++) a[r][k] = e->j[r][s->unknown[k]] * scale_at(s, k, u);
    a[n - 1][k] = direction[k];
  }
}

/* The curve's tangent at its point u: the null vector of the equations, along `along`. */
static int tangent_of(const pendres_system *s, const pendres_equations *e,
                      const pendres_u u, const double *along, double *tangent)
{
  const int n = s->unknowns;
  double a[PENDRES_U_COUNT][PENDRES_U_COUNT], t[PENDRES_U_COUNT] = {0.0}, length = 0.0;
  linearise(s, e, u, along, a);
  t[n - 1] = 1.0;
  if (!pendres_equations_linear(n, a, t)) return 0;
  for (int k = 0; k < n; k++) length = hypot(length, t[k]);
  for (int k = 0; k < n; k++) tangent[k] = t[k] / length;
  return 1;
}

/* Set all of a node but its place; the null vector takes the sign of `like`, unless that is
   NULL. */
static void describe(const pendres_system *s, const pendres_equations *e, const double *like,
                     pendres_curve_node *node)
{
  double slope = 0.0;
  node->image = e->image;
  for (int r = 2; r < e->equations; r++)
    for (int k = 0; k < s->unknowns; k++)
      slope = hypot(slope, e->j[r][s->unknown[k]] * scale_at(s, k, node->u));
  /* The determinant has two factors that grow as errors do, and its derivative three or more. */
  node->growth = fmax(pendres_map_growth(&e->image), sqrt(slope));
  if (s->condition != PENDRES_CONDITION_FOLD) return;
  double *v = node->null;
  pendres_map_null(&e->image, v);
  if (like != NULL && v[0] * like[0] + v[1] * like[1] < 0.0) {
    v[0] = -v[0];
    v[1] = -v[1];
  }
  node->bending = e->j[2][PENDRES_U_Y] * v[0] + e->j[2][PENDRES_U_W] * v[1];
}

/* ---- correcting ---- */

/* Whether a point is one of a pendulum that can be integrated. */
static int is_possible(const pendres_correction *c)
{
  const pendres_pendulum p = pendres_map_pendulum(c->kind->system.map.force, c->u);
  return pendres_pendulum_check(&p, NULL) == PENDRES_OK;
}

/* One Newton step within the plane. */
static void correct(pendres_correction *c)
{
  const pendres_system *s = &c->kind->system;
  const int n = s->unknowns;
  double a[PENDRES_U_COUNT][PENDRES_U_COUNT], d[PENDRES_U_COUNT] = {0.0}, length = 0.0;
  linearise(s, &c->at, c->u, c->tangent, a);
  for (int r = 0; r < n - 1; r++) d[r] = -c->at.r[r];
  c->state = PENDRES_CORRECTION_FAILED;
  if (!pendres_equations_linear(n, a, d)) return;
  for (int k = 0; k < n; k++) length = hypot(length, d[k]);
  if (!(length < 1.0)) return;
  for (int k = 0; k < n; k++) c->u[s->unknown[k]] += scale_at(s, k, c->u) * d[k];
  if (!is_possible(c)) return;
  c->state = PENDRES_CORRECTION_CONVERGED;
  if (length < follow_last_step) return;
  /* Of a large orbit in a narrow resonance rounding may be longer. */
  if (!(pendres_arc_large(&s->map, c->u) > 1.0 && length < pendres_correction_rounding(c)))
    c->state = PENDRES_CORRECTION_ACTIVE;
}

/* The inverse of the linearised equations, by columns, tells how rounding moves the point. */
double pendres_correction_rounding(const pendres_correction *c)
{
  const pendres_system *s = &c->kind->system;
  const int n = s->unknowns;
  const double grown = fmax(1.0, hypot(c->at.image.n[0][0], c->at.image.n[1][1]));
  const double unit = pendres_step_rounding * grown * sqrt(c->steps * s->map.period);
  double sum = 0.0;
  if (c->state != PENDRES_CORRECTION_CONVERGED) return NAN;
  for (int column = 0; column + 1 < n; column++) {
    double a[PENDRES_U_COUNT][PENDRES_U_COUNT], b[PENDRES_U_COUNT] = {0.0};
    linearise(s, &c->at, c->u, c->tangent, a);
    b[column] = column < 2 ? unit : 4.0 * unit;
    if (!pendres_equations_linear(n, a, b)) return NAN;
    for (int k = 0; k < n; k++)
      sum = hypot(sum, k < 2 ? scale_at(s, k, c->u) * b[k] : b[k]);
  }
  return sum;
}

static int same_block(const pendres_correction *a, const pendres_correction *b)
{
  const pendres_system *s = &a->kind->system, *t = &b->kind->system;
  return a->steps == b->steps && s->condition == t->condition && s->map.force == t->map.force &&
         s->map.mirror == t->map.mirror && s->map.period == t->map.period &&
         s->map.winding == t->map.winding && s->map.centre == t->map.centre &&
         s->unknowns == t->unknowns &&
         memcmp(s->unknown, t->unknown, (size_t)s->unknowns * sizeof *s->unknown) == 0;
}

/* Gather the points that wait and have the map and the steps of the first; returns their number. */
static size_t gather(size_t n, pendres_correction *c, size_t first, size_t *index, pendres_u *u)
{
  size_t count = 0;
  for (size_t i = first; i < n; i++) {
    if (!c[i].waiting || !same_block(&c[i], &c[first])) continue;
    c[i].waiting = 0;
    memcpy(u[count], c[i].u, sizeof u[0]);
    index[count++] = i;
  }
  return count;
}

/* Evaluate all active points, those of equal maps and steps together. */
static pendres_status evaluate(pendres_context *ctx, size_t n, pendres_correction *c, size_t *index,
                               pendres_u *u, pendres_equations *at)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) c[i].waiting = c[i].state == PENDRES_CORRECTION_ACTIVE;
  for (size_t first = 0; first < n && status == PENDRES_OK; first++) {
    if (!c[first].waiting) continue;
    const size_t count = gather(n, c, first, index, u);
    pendres_system system = c[first].kind->system;
    system.steps = c[first].steps;
    status = pendres_equations_at(ctx, &system, count, (const pendres_u *)u, at);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++) c[index[i]].at = at[i];
  }
  return status;
}

/*
 * Where branches cross, Newton's method may lead to the other one. That of orbits that close by
 * half map number `which` is told by their closing: on curves that began off such orbits the points
 * that do fail.
 */
static pendres_status keep_off(pendres_context *ctx, int which, size_t n, pendres_correction *c,
                               size_t *index, pendres_u *u)
{
  pendres_room room = pendres_room_open(ctx, "points");
  pendres_map_miss *miss = pendres_room_take(&room, n, sizeof *miss);
  pendres_status status = room.status;
  for (size_t i = 0; i < n; i++)
    c[i].waiting =
      c[i].state == PENDRES_CORRECTION_CONVERGED && (c[i].kind->apart >> which & 1) != 0;
  for (size_t first = 0; first < n && status == PENDRES_OK; first++) {
    pendres_map half;
    if (!c[first].waiting) continue;
    const size_t count = gather(n, c, first, index, u);
    if (!pendres_map_half(&c[first].kind->system.map, which, &half)) continue;
    status = pendres_map_closes(ctx, &half, c[first].steps, count, (const pendres_u *)u, miss);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++)
      if (!(hypot(miss[i].off[0], miss[i].off[1]) > curve_untold))
        c[index[i]].state = PENDRES_CORRECTION_FAILED;
  }
  return pendres_room_close(&room, status);
}

/* Evaluate and correct until nothing is active any more. */
static pendres_status converge(pendres_context *ctx, size_t n, pendres_correction *c)
{
  pendres_room room = pendres_room_open(ctx, "points");
  size_t *index = pendres_room_take(&room, n, sizeof *index), active = n;
  pendres_u *u = pendres_room_take(&room, n, sizeof *u);
  pendres_equations *at = pendres_room_take(&room, n, sizeof *at);
  pendres_status status = room.status;
  for (int i = 0; i < FOLLOW_ITERATIONS && active > 0 && status == PENDRES_OK; i++) {
    status = evaluate(ctx, n, c, index, u, at);
    active = 0;
    for (size_t k = 0; k < n && status == PENDRES_OK; k++)
      if (c[k].state == PENDRES_CORRECTION_ACTIVE) {
        correct(&c[k]);
        active += c[k].state == PENDRES_CORRECTION_ACTIVE;
      }
  }
  for (int which = 0; which < PENDRES_MAP_HALVES && status == PENDRES_OK; which++)
    status = keep_off(ctx, which, n, c, index, u);
  return pendres_room_close(&room, status);
}

pendres_status pendres_follow_correct(pendres_context *ctx, size_t n, pendres_correction *points)
{
  for (size_t i = 0; i < n; i++) points[i].state = PENDRES_CORRECTION_ACTIVE;
  return converge(ctx, n, points);
}

pendres_status pendres_follow_place(pendres_context *ctx, double tolerance, pendres_correction *c,
                                    int *found)
{
  *found = 0;
  pendres_status status =
    pendres_map_steps(ctx, c->kind->system.map.force, c->u, tolerance, &c->steps);
  if (status == PENDRES_OK) status = pendres_follow_correct(ctx, 1, c);
  if (status == PENDRES_OK) *found = !isnan(pendres_correction_rounding(c));
  return status;
}

/* ---- beginning ---- */

/* The tangent at a point, towards growing last unknown if `direction` is positive. Each unknown is
   tried as the one that goes on: near a fold the last one hardly changes. */
static int first_tangent(const pendres_system *s, const pendres_equations *e,
                         const pendres_u u, double direction, double *tangent)
{
  const int n = s->unknowns, last = n - 1;
  int best = -1;
  for (int k = 0; k < n; k++) {
    double along[PENDRES_UNKNOWNS] = {0.0}, t[PENDRES_UNKNOWNS];
    along[k] = 1.0;
    if (!tangent_of(s, e, u, along, t)) continue;
    if (best >= 0 && fabs(t[k]) <= fabs(tangent[best])) continue;
    memcpy(tangent, t, (size_t)n * sizeof *t);
    best = k;
  }
  if (best < 0) return 0;
  const double ahead = fabs(tangent[last]) > curve_untold ? tangent[last] : tangent[best];
  if (ahead * direction < 0.0)
    for (int k = 0; k < n; k++) tangent[k] = -tangent[k];
  return 1;
}

static pendres_status equations_at(pendres_context *ctx, const pendres_followed *kind, int steps,
                                   const pendres_u u, pendres_equations *e)
{
  pendres_system s = kind->system;
  s.steps = steps;
  return pendres_equations_at(ctx, &s, 1, (const pendres_u *)u, e);
}

/* Find which half maps an orbit at u does not close by. */
static pendres_status find_apart(pendres_context *ctx, int steps, const pendres_u u,
                                 pendres_followed *kind)
{
  pendres_status status = PENDRES_OK;
  for (int which = 0; which < PENDRES_MAP_HALVES && status == PENDRES_OK; which++) {
    pendres_map half;
    pendres_map_miss miss;
    if (!pendres_map_half(&kind->system.map, which, &half)) break;
    status = pendres_map_closes(ctx, &half, steps, 1, (const pendres_u *)u, &miss);
    if (status == PENDRES_OK && hypot(miss.off[0], miss.off[1]) > curve_untold)
      kind->apart |= 1 << which;
  }
  return status;
}

pendres_status pendres_follow_begin(pendres_context *ctx, const pendres_followed *kind,
                                    const pendres_u u, double direction, pendres_follower *w)
{
  const pendres_system *s = &kind->system;
  pendres_equations e;
  *w = (pendres_follower){.kind = *kind, .step = follow_first_share * kind->spacing};
  w->kind.apart = 0;
  pendres_correction place = {.kind = &w->kind};
  memcpy(place.u, u, sizeof place.u);
  pendres_status status = pendres_map_steps(ctx, s->map.force, u, kind->tolerance, &place.steps);
  if (status == PENDRES_OK) status = equations_at(ctx, kind, place.steps, u, &e);
  if (status != PENDRES_OK) return status;
  if (!first_tangent(s, &e, u, direction, w->here.tangent)) return PENDRES_NOT_CONVERGED;
  memcpy(place.tangent, w->here.tangent, sizeof place.tangent);
  status = pendres_follow_correct(ctx, 1, &place);
  if (status == PENDRES_OK && isnan(pendres_correction_rounding(&place)))
    status = PENDRES_NOT_CONVERGED;
  if (status == PENDRES_OK) status = equations_at(ctx, kind, place.steps, place.u, &e);
  if (status == PENDRES_OK) status = find_apart(ctx, place.steps, place.u, &w->kind);
  if (status != PENDRES_OK) return status;
  memcpy(w->here.u, place.u, sizeof w->here.u);
  describe(s, &e, NULL, &w->here);
  return first_tangent(s, &e, place.u, direction, w->here.tangent) ? PENDRES_OK
                                                                   : PENDRES_NOT_CONVERGED;
}

pendres_status pendres_follow_describe(pendres_context *ctx, const pendres_followed *kind,
                                       int steps, pendres_curve_node *node)
{
  pendres_equations e;
  double tangent[PENDRES_UNKNOWNS], null[2] = {node->null[0], node->null[1]};
  const pendres_status status = equations_at(ctx, kind, steps, node->u, &e);
  if (status != PENDRES_OK) return status;
  describe(&kind->system, &e, null, node);
  if (tangent_of(&kind->system, &e, node->u, node->tangent, tangent))
    memcpy(node->tangent, tangent, sizeof tangent);
  return status;
}

/* ---- advancing ---- */

/* Where point number `rank` ahead is expected. */
static void predict(const pendres_follower *w, int rank, pendres_u u)
{
  const pendres_system *system = &w->kind.system;
  const double s = w->step * (rank + 1);
  memcpy(u, w->here.u, sizeof w->here.u);
  for (int k = 0; k < system->unknowns; k++)
    u[system->unknown[k]] +=
      scale_at(system, k, w->here.u) * s * (w->here.tangent[k] + 0.5 * s * w->bend[k]);
}

/* How far the chord from `last` is from the mean of both tangents, in its length. */
static double off_chord(const pendres_system *s, const pendres_curve_node *last,
                        const pendres_correction *c, const pendres_curve_node *node, double way)
{
  double off = 0.0;
  for (int k = 0; k < s->unknowns; k++) {
    const double chord = way_between(s, k, last->u, c->u) / way;
    off = hypot(off, chord - 0.5 * (last->tangent[k] + node->tangent[k]));
  }
  return off;
}

/* Whether point number `rank` ahead follows upon `last`, `gap` steps before it; the node is set. */
static int follows(const pendres_follower *w, const pendres_curve_node *last, int gap, int rank,
                   const pendres_correction *c, pendres_curve_node *node)
{
  const pendres_system *s = &w->kind.system;
  double way = 0.0, miss = 0.0, turn = 0.0, predicted[PENDRES_U_COUNT];
  if (c->state != PENDRES_CORRECTION_CONVERGED) return 0;
  if (s->condition == PENDRES_CONDITION_CROSSING &&
      !pendres_crossing_closes(&c->at.image, s->unknown[2], c->steps * s->map.period, 0.0))
    return 0;
  if (!tangent_of(s, &c->at, c->u, last->tangent, node->tangent)) return 0;
  predict(w, rank, predicted);
  for (int k = 0; k < s->unknowns; k++) {
    const int i = s->unknown[k];
    way = hypot(way, way_between(s, k, last->u, c->u));
    miss = hypot(miss, (c->u[i] - predicted[i]) / scale_at(s, k, c->u));
    turn += last->tangent[k] * node->tangent[k];
  }
  if (turn < follow_sharpest_turn || way > 2.0 * gap * w->step ||
      miss > follow_farthest_miss * w->step * (rank + 1) ||
      off_chord(s, last, c, node, way) > follow_farthest_off / gap)
    return 0;
  memcpy(node->u, c->u, sizeof node->u);
  node->held = 0;
  describe(s, &c->at, last->null, node);
  node->arclength = last->arclength + way;
  return 1;
}

/* Whether a place on the way is next to where the branch was born from orbits that close by
   half. */
static pendres_status is_birth(pendres_context *ctx, const pendres_follower *w, const pendres_u u,
                               int *birth)
{
  pendres_status status = PENDRES_OK;
  int steps = 0;
  *birth = 0;
  for (int which = 0; which < PENDRES_MAP_HALVES && !*birth && status == PENDRES_OK; which++) {
    pendres_map half;
    pendres_map_miss miss = {.off = {NAN, NAN}};
    if ((w->kind.apart >> which & 1) == 0 || !pendres_map_half(&w->kind.system.map, which, &half))
      continue;
    status = pendres_map_steps(ctx, half.force, u, w->kind.tolerance, &steps);
    if (status == PENDRES_OK)
      status = pendres_map_closes(ctx, &half, steps, 1, (const pendres_u *)u, &miss);
    *birth = hypot(miss.off[0], miss.off[1]) < curve_near_birth;
  }
  return status;
}

/* Whether a node is on the branch of the last one. Where branches come close without crossing, the
   step across leads straight from one to another: there, as where they cross, the bordered
   determinant changes its sign. Of what is too close for the steps it may. */
static pendres_status stays(pendres_context *ctx, const pendres_follower *w,
                            const pendres_curve_node *last, const pendres_curve_node *node,
                            int *same)
{
  const pendres_system *s = &w->kind.system;
  const double a = pendres_crossing_bordered(&last->image, s->unknown[2], last->tangent);
  const double b = pendres_crossing_bordered(&node->image, s->unknown[2], node->tangent);
  pendres_u u;
  pendres_located at;
  *same = 1;
  if (!(w->step >= follow_to_crossing * follow_shortest && a * b < 0.0)) return PENDRES_OK;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    u[i] = last->u[i] + a / (a - b) * (node->u[i] - last->u[i]);
  int birth = 0; /* where the determinant changes its sign, too */
  pendres_status status = is_birth(ctx, w, u, &birth);
  if (status != PENDRES_OK || birth) return status;
  const pendres_system crossings =
    pendres_system_of(&s->map, PENDRES_CONDITION_CROSSING, s->unknown);
  status = pendres_locate(
    ctx, &crossings, u, 2.0 * pendres_arc_distance(&s->map, last->u, node->u), &at);
  *same = !(status == PENDRES_NOT_CONVERGED && at.parted);
  return pendres_located_found(status) || status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
}

/* Keep the points that converged and follow upon each other, and choose the next step. A few that
   failed may be stepped over: where branches cross there is a small gap in which none converges. */
static pendres_status accept(pendres_context *ctx, pendres_follower *w, const pendres_correction *c)
{
  const pendres_curve_node start = w->here;
  const pendres_curve_node *last = &start;
  pendres_status status = PENDRES_OK;
  w->found = 0;
  for (int rank = 0, gap = 1; rank < PENDRES_AHEAD && gap <= FOLLOW_WIDEST_GAP; rank++) {
    pendres_curve_node *next = &w->ahead[w->found];
    int keep = follows(w, last, gap, rank, &c[rank], next);
    if (keep && w->kind.system.condition == PENDRES_CONDITION_NONE)
      status = stays(ctx, w, last, next, &keep);
    if (status != PENDRES_OK) return status;
    if (keep) {
      last = &w->ahead[w->found++];
      gap = 1;
    } else {
      gap++;
    }
  }
  if (w->found == 0) {
    w->step /= PENDRES_AHEAD;
    /* With a shorter step the bend may be the wrong one of a longer past. */
    memset(w->bend, 0, sizeof w->bend);
    w->stuck = w->step < follow_shortest;
    return status;
  }
  const pendres_curve_node *before = w->found > 1 ? &w->ahead[w->found - 2] : &start;
  for (int k = 0; k < w->kind.system.unknowns; k++)
    w->bend[k] = (last->tangent[k] - before->tangent[k]) / (last->arclength - before->arclength);
  w->here = *last;
  if (w->found == PENDRES_AHEAD)
    w->step = fmin(follow_faster * w->step, w->kind.spacing);
  else if (w->found < PENDRES_AHEAD / 2)
    w->step *= 0.5;
  return status;
}

pendres_status pendres_follow_advance(pendres_context *ctx, size_t n,
                                      pendres_follower *const *followers)
{
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "points");
  pendres_correction *c = pendres_room_take(&room, n * PENDRES_AHEAD, sizeof *c);
  pendres_status status = room.status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    pendres_follower *w = followers[i];
    int steps = 0;
    w->found = 0;
    if (w->stuck) continue;
    status = pendres_map_steps(ctx, w->kind.system.map.force, w->here.u, w->kind.tolerance, &steps);
    for (int rank = 0; rank < PENDRES_AHEAD && status == PENDRES_OK; rank++, count++) {
      c[count] = (pendres_correction){.kind = &w->kind, .steps = steps};
      memcpy(c[count].tangent, w->here.tangent, sizeof c[count].tangent);
      predict(w, rank, c[count].u);
      if (!is_possible(&c[count])) c[count].state = PENDRES_CORRECTION_FAILED;
    }
  }
  if (status == PENDRES_OK) status = converge(ctx, count, c);
  for (size_t i = 0, k = 0; i < n && status == PENDRES_OK; i++)
    if (!followers[i]->stuck) {
      status = accept(ctx, followers[i], &c[k]);
      k += PENDRES_AHEAD;
    }
  return pendres_room_close(&room, status);
}
