/* curve.c -- folds and flips in two parameters, and cusps; see continuation.h. */
#include <pendres/continuation.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/context_internal.h"
#include "continuation/units.h"
#include "continuation/course.h"
#include "continuation/layout.h"
#include "continuation/parameter.h"
#include "continuation/stencil.h"

static const double wildest = 300.0; /* default */

enum { MOST_CUSPS = 64, MOST_ADVANCES = 200 };

void pendres_curve_free(pendres_curve *c)
{
  if (c == NULL) return;
  free(c->point);
  free(c->u);
  free(c->cusp);
  free(c);
}

pendres_special pendres_curve_kind(const pendres_curve *c)
{
  return c != NULL ? c->kind : PENDRES_REGULAR;
}

size_t pendres_curve_count(const pendres_curve *c)
{
  return c != NULL ? c->count : 0;
}

const pendres_curve_point *pendres_curve_get(const pendres_curve *c, size_t i)
{
  return c != NULL && i < c->count ? &c->point[i] : NULL;
}

size_t pendres_curve_cusps(const pendres_curve *c)
{
  return c != NULL ? c->cusps : 0;
}

const pendres_cusp *pendres_curve_cusp(const pendres_curve *c, size_t i)
{
  return c != NULL && i < c->cusps ? &c->cusp[i] : NULL;
}

pendres_parameter pendres_curve_parameter(const pendres_curve *c, int which)
{
  return c != NULL ? c->parameter[which != 0] : PENDRES_PARAMETER_COUNT;
}

static int place_of(pendres_parameter parameter)
{
  return PENDRES_U_OMEGA + (int)parameter;
}

/* The curve through a bifurcation, and the place of that on it. */
static pendres_arc kind_of(const pendres_bifurcation *b, pendres_parameter second, double spacing,
                           double u[PENDRES_U_COUNT])
{
  const pendres_parameter parameter[2] = {b->parameter, second};
  const pendres_continuation_condition condition =
    b->kind == PENDRES_FOLD           ? PENDRES_CONDITION_FOLD
    : b->kind == PENDRES_BRANCH_POINT ? PENDRES_CONDITION_CROSSING
                                      : PENDRES_CONDITION_FLIP;
  pendres_arc w = pendres_arc_of(&b->orbit, condition, parameter, spacing, u);
  if (b->kind == PENDRES_PERIOD_DOUBLING) pendres_continuation_map_unfold(&w.map);
  return w;
}

/* ---- cusps ---- */

static double test_cusp(const pendres_arc_point *p)
{
  return p->bending;
}

static pendres_status finish_cusp(pendres_context *ctx, const int *unknown,
                                  const pendres_located *l, pendres_cusp *out)
{
  for (int i = 0; i < 2; i++) {
    out->parameter[i] = (pendres_parameter)(unknown[2 + i] - PENDRES_U_OMEGA);
    out->value[i] = l->pair.fine[unknown[2 + i]];
    out->value_error[i] = l->error[2 + i];
  }
  const pendres_status status = pendres_continuation_orbit_measure(ctx, 1, &l->pair, &out->orbit);
  pendres_continuation_orbit_set_critical(PENDRES_FOLD, 2, out->parameter, out->value_error,
                                          &out->orbit);
  return status;
}

static pendres_status locate_cusp(pendres_context *ctx, const pendres_trail *t,
                                  const double u[PENDRES_U_COUNT], double reach,
                                  pendres_course_special *out)
{
  out->condition = PENDRES_CONDITION_CUSP;
  const pendres_continuation_system cusps =
    pendres_continuation_system_of(&t->kind.map, out->condition, t->kind.unknown);
  return pendres_continuation_locate(ctx, &cusps, u, reach, &out->located);
}

static pendres_status locate_cusps(pendres_context *ctx, pendres_course *c)
{
  pendres_trail_zero zeros[MOST_CUSPS];
  if (c->trail->kind.condition != PENDRES_CONDITION_FOLD) return PENDRES_OK;
  const size_t n = pendres_trail_zeros(c->trail, test_cusp, MOST_CUSPS, zeros);
  return pendres_course_locate(ctx, locate_cusp, n, zeros, c);
}

/* ---- points ---- */

/*
 * Second derivative of the first parameter by arclength in (x, v), see pendres_bifurcation, from
 * what the arc knows: with A = N - I and its null vectors l and v,
 * d det A (v) = trace A / (l . v) * l . D2F(v, v).
 */
static double curvature_of(const pendres_arc *kind, const pendres_arc_point *p)
{
  if (kind->condition != PENDRES_CONDITION_FOLD) return NAN;
  const double (*j)[PENDRES_U_COUNT] = (const double (*)[PENDRES_U_COUNT])p->image.j;
  const double *v = p->null, omega = p->u[PENDRES_U_OMEGA];
  const int left = hypot(j[0][0], j[1][0]) > hypot(j[0][1], j[1][1]);
  const double l[2] = {left ? -j[1][0] : -j[1][1], left ? j[0][0] : j[0][1]};
  const double second = p->bending * (l[0] * v[0] + l[1] * v[1]) / (j[0][0] + j[1][1]);
  const int place = kind->unknown[2];
  return -second / (l[0] * j[0][place] + l[1] * j[1][place]) /
         (v[0] * v[0] + omega * omega * v[1] * v[1]);
}

/* Point number k. */
static void fill_point(const pendres_course *course, size_t k, pendres_curve *c)
{
  const pendres_course_point *p = &course->point[k];
  const pendres_arc *kind = &course->trail->kind;
  const pendres_cusp *s = p->special >= 0 ? &c->cusp[p->special] : NULL;
  const pendres_continuation_pair *pair =
    s != NULL ? &course->special[p->special].located.pair : &course->pair[p->i];
  memcpy(c->u[k], pair->fine, sizeof c->u[k]);
  c->point[k] = (pendres_curve_point){
    .cusp = p->special,
    .arclength = p->arclength,
    .curvature = s != NULL ? 0.0 : curvature_of(kind, &course->trail->point[p->i]),
    .orbit = s != NULL ? s->orbit : course->orbit[p->i]};
  for (int i = 0; i < 2; i++) {
    c->point[k].value[i] = pair->fine[kind->unknown[2 + i]];
    c->point[k].value_error[i] = s != NULL ? s->value_error[i] : course->error[p->i][i];
  }
  pendres_continuation_orbit_set_critical(c->kind, 2, c->parameter, c->point[k].value_error,
                                          &c->point[k].orbit);
}

static pendres_status fill(pendres_context *ctx, const pendres_course *course, pendres_curve *c)
{
  c->cusp = malloc((course->specials + 1) * sizeof *c->cusp);
  c->point = malloc((course->count + 1) * sizeof *c->point);
  c->u = malloc((course->count + 1) * sizeof *c->u);
  if (c->cusp == NULL || c->point == NULL || c->u == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a curve");
  for (; c->cusps < course->specials; c->cusps++) {
    const pendres_status status = finish_cusp(ctx, course->trail->kind.unknown,
                                              &course->special[c->cusps].located,
                                              &c->cusp[c->cusps]);
    if (status != PENDRES_OK) return status;
  }
  for (; c->count < course->count; c->count++) fill_point(course, c->count, c);
  return PENDRES_OK;
}

/* What a call of pendres_curve_follow() was given. */
typedef struct curve_call {
  const pendres_bifurcation *starts;
  const pendres_curve_options *options;
  pendres_curve **out;
} curve_call;

static void begin(const void *call, size_t i, pendres_trail_start *start)
{
  const curve_call *c = call;
  const double spacing = c->options->spacing;
  start->kind =
    kind_of(&c->starts[i], c->options->second, spacing > 0.0 ? spacing : 0.05, start->u);
}

static pendres_status build(pendres_context *ctx, void *call, size_t i, pendres_trail *t)
{
  const curve_call *to = call;
  pendres_course course = {0};
  pendres_curve *c = to->out[i] = calloc(1, sizeof *c);
  if (c == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a curve");
  c->map = t->kind.map;
  c->condition = t->kind.condition;
  c->kind = pendres_continuation_kind(c->condition, &c->map);
  for (int k = 0; k < 2; k++) {
    c->parameter[k] = (pendres_parameter)(t->kind.unknown[2 + k] - PENDRES_U_OMEGA);
    c->end[k] = t->end[k];
  }
  pendres_status status = pendres_course_begin(ctx, t, MOST_CUSPS, &course);
  if (status == PENDRES_OK) status = locate_cusps(ctx, &course);
  if (status == PENDRES_OK) status = pendres_course_measure(ctx, &course);
  if (status == PENDRES_OK) status = fill(ctx, &course, c);
  pendres_course_free(&course);
  return status;
}

/* ---- following ---- */

static const char *check(size_t n, const pendres_bifurcation *starts,
                         const pendres_curve_options *o)
{
  for (int i = 0; i < 2; i++)
    if (!(o->low[i] < o->high[i] && isfinite(o->low[i]) && isfinite(o->high[i])))
      return "a parameter's range is empty";
  if (!(o->spacing >= 0.0 && o->wildest >= 0.0)) return "spacing and wildest must not be negative";
  for (size_t i = 0; i < n; i++) {
    if (starts[i].kind == PENDRES_REGULAR ||
        (unsigned)starts[i].kind >= PENDRES_SPECIAL_COUNT)
      return "a start is no bifurcation";
    const char *why = pendres_continuation_refuses(&starts[i].orbit, starts[i].parameter);
    if (why == NULL) why = pendres_continuation_refuses(&starts[i].orbit, o->second);
    if (why != NULL) return why;
    if (starts[i].parameter == o->second) return "the second parameter is the first once more";
  }
  return NULL;
}

static pendres_status curve_follow(pendres_context *ctx, size_t n,
                                   const pendres_bifurcation *starts,
                                   const pendres_curve_options *options, pendres_curve **out)
{
  if (options == NULL || (n > 0 && (starts == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "starts, options and out");
  for (size_t i = 0; i < n; i++) out[i] = NULL;
  if (n == 0) return PENDRES_OK;
  const pendres_curve_options *o = options;
  const char *why = check(n, starts, o);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "curve: %s", why);

  static const pendres_course_kind kind = {
    .name = "curves", .start = "bifurcation", .begin = begin, .build = build};
  const pendres_trail_bounds bounds = {.low = {o->low[0], o->low[1]},
                                       .high = {o->high[0], o->high[1]},
                                       .wildest = o->wildest > 0.0 ? o->wildest : wildest,
                                       .most_points = o->most_points > 0 ? o->most_points : 2000};
  curve_call call = {.starts = starts, .options = o, .out = out};
  const pendres_status status = pendres_course_follow(ctx, &kind, n, &bounds, &call);
  for (size_t i = 0; i < n && status != PENDRES_OK; i++) {
    pendres_curve_free(out[i]);
    out[i] = NULL;
  }
  return status;
}

pendres_status pendres_curve_follow(pendres_context *ctx, size_t n,
                                    const pendres_bifurcation *starts,
                                    const pendres_curve_options *options, pendres_curve **out)
{
  pendres_door d;
  pendres_door_open(&d, ctx, n > 0 && starts != NULL ? &starts[0].orbit.pendulum : NULL);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, n, starts);
  const pendres_curve_options *o = pendres_curve_options_inside(&d, n, starts, options);
  PENDRES_DOOR_CALL(&d, curve_follow(ctx, n, from, o, out));
  for (size_t i = 0; d.status == PENDRES_OK && i < n; i++) pendres_curve_leave(&d, out[i]);
  return pendres_door_close(&d);
}

/* ---- one value of the second parameter ---- */

static pendres_status curve_cross(pendres_context *ctx, const pendres_curve *c, double value,
                                  size_t room, pendres_bifurcation *out, size_t *found)
{
  if (c == NULL || found == NULL || (room > 0 && out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "curve, out and found");
  if (!isfinite(value))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the value must be finite");
  *found = 0;
  const int closed = c->end[0] == PENDRES_END_CLOSED;
  const size_t chords = c->count > 1 ? (closed ? c->count : c->count - 1) : 0;
  const int unknown[] = {PENDRES_U_Y, PENDRES_U_W, place_of(c->parameter[0])};
  const int second = place_of(c->parameter[1]);
  const pendres_continuation_system system =
    pendres_continuation_system_of(&c->map, c->condition, unknown);
  const pendres_continuation_points points = {
    .count = c->count, .u = (const double (*)[PENDRES_U_COUNT])c->u, .closed = closed,
    .turn = c->map.mirror ? 0.0 : pendres_model_of(c->map.force)->period};
  double guess[PENDRES_U_COUNT], last_guess[PENDRES_U_COUNT], last[PENDRES_U_COUNT];
  for (size_t i = 0; i < chords; i++) {
    pendres_continuation_stencil s;
    double t[PENDRES_STENCIL_ROOTS];
    pendres_continuation_stencil_init(&s, &points, i);
    const size_t roots =
      pendres_continuation_stencil_roots(&s, second, value, !closed && i + 1 == chords, t);
    for (size_t r = 0; r < roots; r++) {
      pendres_located located;
      pendres_continuation_stencil_at(&s, t[r], guess);
      /* What stays as it is along the curve does so to the last bit. */
      for (int k = PENDRES_U_OMEGA; k < PENDRES_U_COUNT; k++)
        if (k != unknown[2]) guess[k] = k == second ? value : c->u[i][k];
      pendres_status status =
        pendres_continuation_locate(ctx, &system, guess, 2.0 * s.length + 1e-3, &located);
      if (status == PENDRES_NOT_CONVERGED) continue;
      if (!pendres_located_found(status)) return status;
      /* Next to a turn of the curve two guesses may lead to one: it is counted once. */
      const int again = *found > 0 &&
                        pendres_arc_distance(located.pair.fine, last) <
                          0.1 * pendres_arc_distance(guess, last_guess);
      memcpy(last_guess, guess, sizeof last_guess);
      memcpy(last, located.pair.fine, sizeof last);
      if (again) continue;
      if (*found < room) {
        status = pendres_continuation_locate_finish(ctx, c->condition, c->parameter[0], &located,
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
  pendres_door_open(&d, ctx, c != NULL && c->count > 0 ? &c->point[0].orbit.pendulum : NULL);
  if (c != NULL) pendres_door_move(&d, c->parameter[0], c->parameter[1]);
  const pendres_curve *inside = pendres_curve_inside(&d, c);
  pendres_bifurcation *b = pendres_door_out(&d, &pendres_dim_bifurcation, room, out);
  PENDRES_DOOR_CALL(&d, curve_cross(ctx, inside, value / d.scales.second, room, b, found));
  return pendres_door_close(&d);
}

/* ---- the cusp next to a fold ---- */

/* Go along it until the quadratic term changes its sign. */
static pendres_status follow_to_cusp(pendres_context *ctx, pendres_arc *w, pendres_located *out)
{
  const pendres_continuation_system cusps =
    pendres_continuation_system_of(&w->map, PENDRES_CONDITION_CUSP, w->unknown);
  pendres_arc_point last = w->here;
  for (int i = 0; i < MOST_ADVANCES; i++) {
    pendres_status status = pendres_arc_advance(ctx, 1, w);
    if (status != PENDRES_OK) return status;
    if (w->stuck || w->here.growth > wildest) return PENDRES_NOT_FOUND;
    for (int k = 0; k < w->found; k++) {
      const pendres_arc_point *p = &w->ahead[k];
      if (last.bending * p->bending <= 0.0) {
        const double part = last.bending / (last.bending - p->bending);
        double u[PENDRES_U_COUNT];
        for (int m = 0; m < PENDRES_U_COUNT; m++)
          u[m] = last.u[m] + part * (p->u[m] - last.u[m]);
        status = pendres_continuation_locate(ctx, &cusps, u,
                                             2.0 * (p->arclength - last.arclength), out);
        if (status != PENDRES_NOT_CONVERGED) return status;
      }
      last = *p;
    }
  }
  return PENDRES_NOT_FOUND;
}

static pendres_status cusp_find(pendres_context *ctx, const pendres_fold *near,
                                pendres_parameter second, pendres_cusp *out)
{
  if (near == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "fold and out");
  if (near->kind != PENDRES_FOLD)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "cusp: this is no fold");
  const char *why = pendres_continuation_refuses(&near->orbit, near->parameter);
  if (why == NULL) why = pendres_continuation_refuses(&near->orbit, second);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "cusp: %s", why);
  if (second == near->parameter)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "cusp: the second parameter must be another one than the fold's");
  double u[PENDRES_U_COUNT], approach[2];
  pendres_arc arc[2], ahead[2];
  pendres_located located;
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < 2; i++) {
    arc[i] = kind_of(near, second, 0.05, u);
    status = pendres_arc_begin(ctx, &arc[i], u, i == 0 ? 1.0 : -1.0);
    if (status == PENDRES_NOT_CONVERGED)
      return pendres_context_fail(ctx, status, "no fold to start from at drive frequency %g",
                                  near->orbit.pendulum.drive_frequency);
    if (status != PENDRES_OK) return status;
    ahead[i] = arc[i];
  }
  status = pendres_arc_advance(ctx, 2, ahead);
  if (status != PENDRES_OK) return status;
  for (int i = 0; i < 2; i++)
    approach[i] = ahead[i].found > 0
                    ? fabs(arc[i].here.bending) - fabs(ahead[i].ahead[0].bending)
                    : -INFINITY;
  const int first = approach[0] >= approach[1] ? 0 : 1;
  status = follow_to_cusp(ctx, &arc[first], &located);
  if (status == PENDRES_NOT_FOUND) status = follow_to_cusp(ctx, &arc[1 - first], &located);
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status, "the curve of folds through %g leads to no cusp",
                                near->value);
  if (!pendres_located_found(status)) return status;
  const pendres_status measured = finish_cusp(ctx, arc[0].unknown, &located, out);
  if (measured != PENDRES_OK) return measured;
  if (status == PENDRES_TOLERANCE_UNREACHABLE)
    return pendres_context_fail(ctx, status, "the cusp is known to %.1e and %.1e only",
                                out->value_error[0], out->value_error[1]);
  return status;
}

pendres_status pendres_cusp_find(pendres_context *ctx, const pendres_fold *near,
                                 pendres_parameter second, pendres_cusp *out)
{
  pendres_door d;
  pendres_door_open(&d, ctx, near != NULL ? &near->orbit.pendulum : NULL);
  const pendres_fold *inside = pendres_bifurcations_inside(&d, 1, near);
  if (near != NULL) pendres_door_move(&d, near->parameter, second);
  pendres_cusp *cusp = pendres_door_out(&d, &pendres_dim_cusp, 1, out);
  PENDRES_DOOR_CALL(&d, cusp_find(ctx, inside, second, cusp));
  return pendres_door_close(&d);
}
