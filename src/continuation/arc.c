/* arc.c -- following a curve of solutions by pseudo-arclength. */
#include "continuation/arc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "continuation/crossing.h"
#include "continuation/locate.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"

pendres_arc pendres_arc_of(const pendres_orbit *orbit, pendres_continuation_condition condition,
                           const pendres_parameter *parameter, double spacing,
                           double u[PENDRES_U_COUNT])
{
  pendres_arc w = {.condition = condition,
                   .unknowns = condition == PENDRES_CONDITION_NONE ? 3 : 4,
                   .unknown = {PENDRES_U_Y, PENDRES_U_W},
                   .tolerance = pendres_accuracy_of_arcs(),
                   .longest = spacing};
  for (int k = 2; k < w.unknowns; k++) w.unknown[k] = PENDRES_U_OMEGA + (int)parameter[k - 2];
  w.map = pendres_continuation_map_of(orbit, w.unknowns, w.unknown, u);
  return w;
}

enum { MOST_ITERATIONS = 6 };
/* A Newton step below this leaves an error of its square. */
static const double last_step = 1e-8;
/* Points ahead may not turn by more than this cosine from one to the next, nor lie further from
   their prediction than this share of the way. */
static const double sharpest_turn = 0.92;
static const double farthest_miss = 0.25;
/* The chord from one point to the next goes along the mean of their tangents, to this share of its
   length: exactly so where the curve bends steadily. Of forty thousand chords one in a hundred is
   off by more than 0.01, none by more than 0.06; those that lead from one branch to another where
   they come close, as next to a sharp fold, are off by 0.1 and more; less of it is trusted where
   points were stepped over. */
static const double farthest_off = 0.08;
static const double shortest_step = 1e-6;
/* With steps shorter than this no crossing is looked into: branches that come closer are told by
   the doubts of their points. */
static const double shortest_crossing = 32.0 * 1e-6;
static const int widest_gap = 3; /* how many steps lie between one point and the next */
/* An orbit closes by half if it misses that by less than this. Next to where a branch was born, one
   of its orbits that does not close by half comes as near only within half of this distance. */
static const double too_close = 1e-6;

/* The scale of unknown number k at a place. */
static double scale_at(const pendres_arc *w, int k, const double u[PENDRES_U_COUNT])
{
  return pendres_arc_scale(w->unknown[k], u[w->unknown[k]]);
}

/* The curve's tangent at its point u: the null vector of the equations, along `along`. */
static int tangent_of(const pendres_arc *w, const pendres_continuation_equations *e,
                      const double u[PENDRES_U_COUNT], const double *along, double *tangent)
{
  const int n = w->unknowns;
  double a[PENDRES_U_COUNT][PENDRES_U_COUNT], t[PENDRES_U_COUNT] = {0.0}, length = 0.0;
  for (int k = 0; k < n; k++) {
    for (int r = 0; r < n - 1; r++) a[r][k] = e->j[r][w->unknown[k]] * scale_at(w, k, u);
    a[n - 1][k] = along[k];
  }
  t[n - 1] = 1.0;
  if (!pendres_continuation_equations_linear(n, a, t)) return 0;
  for (int k = 0; k < n; k++) length = hypot(length, t[k]);
  for (int k = 0; k < n; k++) tangent[k] = t[k] / length;
  return 1;
}

/* Set all of a point but its place; the null vector takes the sign of `like`, unless that is
   NULL. */
static void describe(const pendres_arc *w, const pendres_continuation_equations *e,
                    const double *like, pendres_arc_point *point)
{
  double slope = 0.0;
  point->image = e->image;
  for (int r = 2; r < e->equations; r++)
    for (int k = 0; k < w->unknowns; k++)
      slope = hypot(slope, e->j[r][w->unknown[k]] * scale_at(w, k, point->u));
  /* The determinant has two factors that grow as errors do, and its derivative three or more. */
  point->growth = fmax(pendres_continuation_map_growth(&e->image), sqrt(slope));
  if (w->condition != PENDRES_CONDITION_FOLD) return;
  double *v = point->null;
  pendres_continuation_map_null(&e->image, v);
  if (like != NULL && v[0] * like[0] + v[1] * like[1] < 0.0) {
    v[0] = -v[0];
    v[1] = -v[1];
  }
  point->bending = e->j[2][PENDRES_U_Y] * v[0] + e->j[2][PENDRES_U_W] * v[1];
}

/* ---- advancing ---- */

/* A point on its way to the curve, within the plane across a tangent. */
typedef struct candidate {
  const pendres_arc *arc;
  const double *tangent;
  int steps, rank, waiting;
  enum { ACTIVE, CONVERGED, FAILED } state;
  double u[PENDRES_U_COUNT], predicted[PENDRES_U_COUNT];
  pendres_continuation_equations at;
} candidate;

static void predict(candidate *c)
{
  const pendres_arc *w = c->arc;
  const double s = w->step * (c->rank + 1);
  memcpy(c->u, w->here.u, sizeof c->u);
  for (int k = 0; k < w->unknowns; k++)
    c->u[w->unknown[k]] +=
      scale_at(w, k, w->here.u) * s * (w->here.tangent[k] + 0.5 * s * w->bend[k]);
  memcpy(c->predicted, c->u, sizeof c->u);
  const pendres_pendulum p = pendres_continuation_map_pendulum(w->map.force, c->u);
  c->state = pendres_pendulum_check(&p, NULL) == PENDRES_OK ? ACTIVE : FAILED;
}

/* The equations and the plane, linearised. */
static void linearise(const candidate *c, double a[][PENDRES_U_COUNT])
{
  const pendres_arc *w = c->arc;
  const int n = w->unknowns;
  for (int k = 0; k < n; k++) {
    for (int r = 0; r < n - 1; r++) a[r][k] = c->at.j[r][w->unknown[k]] * scale_at(w, k, c->u);
    a[n - 1][k] = c->tangent[k];
  }
}

/* One Newton step within the plane. */
static void correct(candidate *c)
{
  const pendres_arc *w = c->arc;
  const int n = w->unknowns;
  double a[PENDRES_U_COUNT][PENDRES_U_COUNT], d[PENDRES_U_COUNT] = {0.0}, length = 0.0;
  linearise(c, a);
  for (int r = 0; r < n - 1; r++) d[r] = -c->at.r[r];
  c->state = FAILED;
  if (!pendres_continuation_equations_linear(n, a, d)) return;
  for (int k = 0; k < n; k++) length = hypot(length, d[k]);
  if (!(length < 1.0)) return;
  for (int k = 0; k < n; k++) c->u[w->unknown[k]] += scale_at(w, k, c->u) * d[k];
  const pendres_pendulum p = pendres_continuation_map_pendulum(w->map.force, c->u);
  if (pendres_pendulum_check(&p, NULL) != PENDRES_OK) return;
  c->state = length < last_step ? CONVERGED : ACTIVE;
}

/* How rounding moves a corrected point: the inverse of the linearised equations, by columns. */
static double rounding_of(const candidate *c)
{
  const int n = c->arc->unknowns;
  const double unit = 4e-16 * fmax(1.0, hypot(c->at.image.n[0][0], c->at.image.n[1][1])) *
                      sqrt(c->steps * c->arc->map.period);
  double sum = 0.0;
  for (int column = 0; column + 1 < n; column++) {
    double a[PENDRES_U_COUNT][PENDRES_U_COUNT], b[PENDRES_U_COUNT] = {0.0};
    linearise(c, a);
    b[column] = column < 2 ? unit : 4.0 * unit;
    if (!pendres_continuation_equations_linear(n, a, b)) return NAN;
    for (int k = 0; k < n; k++) sum = hypot(sum, b[k]);
  }
  return sum;
}

static int same_block(const candidate *a, const candidate *b)
{
  return a->steps == b->steps && a->arc->condition == b->arc->condition &&
         a->arc->map.force == b->arc->map.force &&
         a->arc->map.mirror == b->arc->map.mirror &&
         a->arc->map.period == b->arc->map.period &&
         a->arc->map.winding == b->arc->map.winding &&
         a->arc->map.centre == b->arc->map.centre && a->arc->unknowns == b->arc->unknowns &&
         memcmp(a->arc->unknown, b->arc->unknown,
                (size_t)a->arc->unknowns * sizeof *a->arc->unknown) == 0;
}

/* Gather the candidates that wait and have the map and the steps of the first; returns their
   number. */
static size_t gather(size_t n, candidate *c, size_t first, size_t *index,
                     double (*u)[PENDRES_U_COUNT])
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

/* Evaluate all active candidates, those of equal maps and steps together. */
static pendres_status evaluate(pendres_context *ctx, size_t n, candidate *c, size_t *index,
                               double (*u)[PENDRES_U_COUNT], pendres_continuation_equations *at)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) c[i].waiting = c[i].state == ACTIVE;
  for (size_t first = 0; first < n && status == PENDRES_OK; first++) {
    if (!c[first].waiting) continue;
    const size_t count = gather(n, c, first, index, u);
    const pendres_continuation_system system = pendres_arc_system(c[first].arc, c[first].steps);
    status = pendres_continuation_equations_at(ctx, &system, count,
                                               (const double (*)[PENDRES_U_COUNT])u, at);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++) c[index[i]].at = at[i];
  }
  return status;
}

/* Fail the candidates that close by half map number `which`, of arcs that began off such orbits. */
static pendres_status keep_off(pendres_context *ctx, int which, size_t n, candidate *c,
                               size_t *index, double (*u)[PENDRES_U_COUNT])
{
  pendres_status status = PENDRES_OK;
  pendres_continuation_miss *miss = malloc((n + 1) * sizeof *miss);
  if (miss == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (size_t i = 0; i < n; i++)
    c[i].waiting = c[i].state == CONVERGED && (c[i].arc->apart >> which & 1) != 0;
  for (size_t first = 0; first < n && status == PENDRES_OK; first++) {
    pendres_continuation_map half;
    if (!c[first].waiting) continue;
    const size_t count = gather(n, c, first, index, u);
    if (!pendres_continuation_map_half(&c[first].arc->map, which, &half)) continue;
    status = pendres_continuation_map_closes(ctx, &half, c[first].steps, count,
                                             (const double (*)[PENDRES_U_COUNT])u, miss);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++)
      if (!(hypot(miss[i].off[0], miss[i].off[1]) > too_close)) c[index[i]].state = FAILED;
  }
  free(miss);
  return status;
}

/* Where branches cross, Newton's method may lead to the other one. That of orbits that close by
   half is told by their closing; such points are dropped. */
static pendres_status keep_apart(pendres_context *ctx, size_t n, candidate *c, size_t *index,
                                 double (*u)[PENDRES_U_COUNT])
{
  pendres_status status = PENDRES_OK;
  for (int which = 0; which < PENDRES_MAP_HALVES && status == PENDRES_OK; which++)
    status = keep_off(ctx, which, n, c, index, u);
  return status;
}

/* How far the chord from `last` is from the mean of both tangents, in its length. */
static double off_chord(const pendres_arc *w, const pendres_arc_point *last, const candidate *c,
                        const pendres_arc_point *point, double way)
{
  double off = 0.0;
  for (int k = 0; k < w->unknowns; k++) {
    const int i = w->unknown[k];
    const double scale = pendres_arc_scale(i, 0.5 * (c->u[i] + last->u[i]));
    const double chord = (c->u[i] - last->u[i]) / (scale * way);
    off = hypot(off, chord - 0.5 * (last->tangent[k] + point->tangent[k]));
  }
  return off;
}

/* Whether a point follows upon `last`, `gap` steps before it; its tangent and arclength are set. */
static int follows(const pendres_arc *w, const pendres_arc_point *last, int gap,
                   const candidate *c, pendres_arc_point *point)
{
  double way = 0.0, miss = 0.0, turn = 0.0;
  if (c->state != CONVERGED) return 0;
  if (w->condition == PENDRES_CONDITION_CROSSING &&
      !pendres_crossing_closes(&c->at.image, w->unknown[2], c->steps * w->map.period, 0.0))
    return 0;
  if (!tangent_of(w, &c->at, c->u, last->tangent, point->tangent)) return 0;
  for (int k = 0; k < w->unknowns; k++) {
    const int i = w->unknown[k];
    way = hypot(way, (c->u[i] - last->u[i]) /
                       pendres_arc_scale(i, 0.5 * (c->u[i] + last->u[i])));
    miss = hypot(miss, (c->u[i] - c->predicted[i]) / pendres_arc_scale(i, c->u[i]));
    turn += last->tangent[k] * point->tangent[k];
  }
  if (turn < sharpest_turn || way > 2.0 * gap * w->step ||
      miss > farthest_miss * w->step * (c->rank + 1) ||
      off_chord(w, last, c, point, way) > farthest_off / gap)
    return 0;
  memcpy(point->u, c->u, sizeof point->u);
  point->held = 0;
  describe(w, &c->at, last->null, point);
  point->arclength = last->arclength + way;
  return 1;
}

/* Evaluate and correct until nothing is active any more. */
static pendres_status converge(pendres_context *ctx, size_t n, candidate *c)
{
  pendres_status status = PENDRES_OK;
  size_t *index = malloc((n + 1) * sizeof *index), active = n;
  double(*u)[PENDRES_U_COUNT] = malloc((n + 1) * sizeof *u);
  pendres_continuation_equations *at = malloc((n + 1) * sizeof *at);
  if (index == NULL || u == NULL || at == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
    goto done;
  }
  for (int i = 0; i < MOST_ITERATIONS && active > 0 && status == PENDRES_OK; i++) {
    status = evaluate(ctx, n, c, index, u, at);
    active = 0;
    for (size_t k = 0; k < n && status == PENDRES_OK; k++)
      if (c[k].state == ACTIVE) {
        correct(&c[k]);
        active += c[k].state == ACTIVE;
      }
  }
  if (status == PENDRES_OK) status = keep_apart(ctx, n, c, index, u);
done:
  free(index);
  free(u);
  free(at);
  return status;
}

pendres_status pendres_arc_correct(pendres_context *ctx, const pendres_arc *kind, size_t n,
                                   pendres_arc_correction *points)
{
  candidate *c = malloc((n + 1) * sizeof *c);
  if (c == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (size_t i = 0; i < n; i++) {
    c[i] = (candidate){.arc = kind, .tangent = points[i].tangent, .steps = points[i].steps};
    memcpy(c[i].u, points[i].u, sizeof c[i].u);
  }
  const pendres_status status = converge(ctx, n, c);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    memcpy(points[i].u, c[i].u, sizeof c[i].u);
    points[i].rounding = c[i].state == CONVERGED ? rounding_of(&c[i]) : NAN;
  }
  free(c);
  return status;
}

/* The tangent at a point, towards growing last unknown if `direction` is positive. Each unknown is
   tried as the one that goes on: near a fold the last one hardly changes. */
static int first_tangent(const pendres_arc *w, const pendres_continuation_equations *e,
                         const double u[PENDRES_U_COUNT], double direction, double *tangent)
{
  const int n = w->unknowns, last = n - 1;
  int best = -1;
  for (int k = 0; k < n; k++) {
    double along[PENDRES_ARC_UNKNOWNS] = {0.0}, t[PENDRES_ARC_UNKNOWNS];
    along[k] = 1.0;
    if (!tangent_of(w, e, u, along, t)) continue;
    if (best >= 0 && fabs(t[k]) <= fabs(tangent[best])) continue;
    memcpy(tangent, t, (size_t)n * sizeof *t);
    best = k;
  }
  if (best < 0) return 0;
  const double ahead = fabs(tangent[last]) > 1e-6 ? tangent[last] : tangent[best];
  if (ahead * direction < 0.0)
    for (int k = 0; k < n; k++) tangent[k] = -tangent[k];
  return 1;
}

pendres_continuation_system pendres_arc_system(const pendres_arc *w, int steps)
{
  return (pendres_continuation_system){.map = &w->map, .steps = steps, .condition = w->condition,
                                       .unknowns = w->unknowns, .unknown = w->unknown};
}

static pendres_status equations_at(pendres_context *ctx, const pendres_arc *w, int steps,
                                   const double u[PENDRES_U_COUNT],
                                   pendres_continuation_equations *e)
{
  const pendres_continuation_system system = pendres_arc_system(w, steps);
  return pendres_continuation_equations_at(ctx, &system, 1, (const double (*)[PENDRES_U_COUNT])u,
                                           e);
}

pendres_status pendres_arc_begin(pendres_context *ctx, pendres_arc *w,
                                 const double u[PENDRES_U_COUNT], double direction)
{
  pendres_continuation_equations e;
  pendres_arc_correction place;
  w->here = (pendres_arc_point){.arclength = 0.0};
  w->stuck = w->found = w->apart = 0;
  w->step = 0.1 * w->longest;
  memset(w->bend, 0, sizeof w->bend);
  memcpy(place.u, u, sizeof place.u);
  pendres_status status =
    pendres_continuation_map_steps(ctx, w->map.force, u, w->tolerance, &place.steps);
  if (status == PENDRES_OK) status = equations_at(ctx, w, place.steps, u, &e);
  if (status != PENDRES_OK) return status;
  if (!first_tangent(w, &e, u, direction, w->here.tangent)) return PENDRES_NOT_CONVERGED;
  memcpy(place.tangent, w->here.tangent, sizeof place.tangent);
  status = pendres_arc_correct(ctx, w, 1, &place);
  if (status == PENDRES_OK && isnan(place.rounding)) status = PENDRES_NOT_CONVERGED;
  if (status == PENDRES_OK) status = equations_at(ctx, w, place.steps, place.u, &e);
  for (int which = 0; which < PENDRES_MAP_HALVES && status == PENDRES_OK; which++) {
    pendres_continuation_map half;
    pendres_continuation_miss miss;
    if (!pendres_continuation_map_half(&w->map, which, &half)) break;
    status = pendres_continuation_map_closes(ctx, &half, place.steps, 1,
                                             (const double (*)[PENDRES_U_COUNT])&place.u, &miss);
    if (status == PENDRES_OK && hypot(miss.off[0], miss.off[1]) > too_close) w->apart |= 1 << which;
  }
  if (status != PENDRES_OK) return status;
  memcpy(w->here.u, place.u, sizeof w->here.u);
  describe(w, &e, NULL, &w->here);
  return first_tangent(w, &e, place.u, direction, w->here.tangent) ? PENDRES_OK
                                                                   : PENDRES_NOT_CONVERGED;
}

pendres_status pendres_arc_describe(pendres_context *ctx, const pendres_arc *w, int steps,
                                    pendres_arc_point *point)
{
  pendres_continuation_equations e;
  double tangent[PENDRES_ARC_UNKNOWNS], null[2] = {point->null[0], point->null[1]};
  const pendres_status status = equations_at(ctx, w, steps, point->u, &e);
  if (status != PENDRES_OK) return status;
  describe(w, &e, null, point);
  if (tangent_of(w, &e, point->u, point->tangent, tangent))
    memcpy(point->tangent, tangent, sizeof tangent);
  return status;
}

/* Whether a point is on the branch of the last one. Where branches come close without crossing, the
   step across leads straight from one to another. Of what is too close for the steps it may. */
static pendres_status stays(pendres_context *ctx, const pendres_arc *w,
                            const pendres_arc_point *last, const pendres_arc_point *point,
                            int *same)
{
  const pendres_located_end ends[2] = {{last->u, last->tangent, &last->image},
                                       {point->u, point->tangent, &point->image}};
  int parts = 0;
  pendres_status status = PENDRES_OK;
  if (w->step >= shortest_crossing)
    status = pendres_continuation_parts(ctx, &w->map, w->unknown, ends, &parts);
  *same = !parts;
  return status;
}

/* Keep the points that converged and follow upon each other, and choose the next step. A few that
   failed may be stepped over: where branches cross there is a small gap in which none converges. */
static pendres_status accept(pendres_context *ctx, pendres_arc *w, const candidate *c)
{
  const pendres_arc_point start = w->here;
  const pendres_arc_point *last = &start;
  pendres_status status = PENDRES_OK;
  w->found = 0;
  for (int rank = 0, gap = 1; rank < PENDRES_ARC_AHEAD && gap <= widest_gap; rank++) {
    pendres_arc_point *next = &w->ahead[w->found];
    int keep = follows(w, last, gap, &c[rank], next);
    if (keep && w->condition == PENDRES_CONDITION_NONE) status = stays(ctx, w, last, next, &keep);
    if (status != PENDRES_OK) return status;
    if (keep) {
      last = &w->ahead[w->found++];
      gap = 1;
    } else {
      gap++;
    }
  }
  if (w->found == 0) {
    w->step /= PENDRES_ARC_AHEAD;
    /* With a shorter step the bend may be the wrong one of a longer past. */
    memset(w->bend, 0, sizeof w->bend);
    w->stuck = w->step < shortest_step;
    return status;
  }
  const pendres_arc_point *before = w->found > 1 ? &w->ahead[w->found - 2] : &start;
  for (int k = 0; k < w->unknowns; k++)
    w->bend[k] = (last->tangent[k] - before->tangent[k]) / (last->arclength - before->arclength);
  w->here = *last;
  if (w->found == PENDRES_ARC_AHEAD)
    w->step = fmin(1.6 * w->step, w->longest);
  else if (w->found < PENDRES_ARC_AHEAD / 2)
    w->step *= 0.5;
  return status;
}

pendres_status pendres_arc_advance(pendres_context *ctx, size_t n, pendres_arc *arcs)
{
  const size_t most = n * PENDRES_ARC_AHEAD;
  pendres_status status = PENDRES_OK;
  size_t count = 0;
  candidate *c = malloc((most + 1) * sizeof *c);
  if (c == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (size_t i = 0; i < n; i++) {
    pendres_arc *w = &arcs[i];
    int steps = 0;
    w->found = 0;
    if (w->stuck) continue;
    status = pendres_continuation_map_steps(ctx, w->map.force, w->here.u, w->tolerance, &steps);
    if (status != PENDRES_OK) goto done;
    for (int k = 0; k < PENDRES_ARC_AHEAD; k++) {
      c[count] = (candidate){.arc = w, .tangent = w->here.tangent, .steps = steps, .rank = k};
      predict(&c[count++]);
    }
  }
  status = converge(ctx, count, c);
  for (size_t i = 0, k = 0; i < n && status == PENDRES_OK; i++)
    if (!arcs[i].stuck) {
      status = accept(ctx, &arcs[i], &c[k]);
      k += PENDRES_ARC_AHEAD;
    }
done:
  free(c);
  return status;
}
