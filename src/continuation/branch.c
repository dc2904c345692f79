/* branch.c -- branches of periodic orbits in one parameter; see continuation.h. */
#include "continuation/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "continuation/units.h"
#include "continuation/course.h"
#include "continuation/crossing.h"
#include "continuation/parameter.h"

enum { MOST_BIFURCATIONS = 256 };

void pendres_branch_free(pendres_branch *b)
{
  if (b == NULL) return;
  free(b->point);
  free(b->bifurcation);
  free(b);
}

size_t pendres_branch_count(const pendres_branch *b)
{
  return b != NULL ? b->count : 0;
}

const pendres_branch_point *pendres_branch_get(const pendres_branch *b, size_t i)
{
  return b != NULL && i < b->count ? &b->point[i] : NULL;
}

size_t pendres_branch_bifurcations(const pendres_branch *b)
{
  return b != NULL ? b->bifurcations : 0;
}

const pendres_bifurcation *pendres_branch_bifurcation(const pendres_branch *b, size_t i)
{
  return b != NULL && i < b->bifurcations ? &b->bifurcation[i] : NULL;
}

pendres_branch_end pendres_branch_end_of(const pendres_branch *b, int which)
{
  return b != NULL ? b->end[which != 0] : PENDRES_END_STUCK;
}

/* ---- bifurcations on the way ---- */

static double test_fold(const pendres_arc_point *p)
{
  return pendres_continuation_map_fold(&p->image);
}

static double test_flip(const pendres_arc_point *p)
{
  return pendres_continuation_map_flip(&p->image);
}

/* Half map number `which` of a trail's, about the place that an orbit at u is about, and by how far
   that misses closing by it. PENDRES_NOT_CONVERGED: there is none. */
static pendres_status half_at(pendres_context *ctx, const pendres_trail *t, int which,
                              const double u[PENDRES_U_COUNT], pendres_continuation_map *half,
                              double *off)
{
  int steps = 0;
  pendres_continuation_miss miss = {.off = {NAN, NAN}};
  if (!pendres_continuation_map_half(&t->kind.map, which, half)) return PENDRES_NOT_CONVERGED;
  pendres_status status =
    pendres_continuation_map_steps(ctx, t->kind.map.force, u, pendres_accuracy_first(ctx),
                                   &steps);
  if (status == PENDRES_OK)
    status = pendres_continuation_map_closes(ctx, half, steps, 1,
                                             (const double (*)[PENDRES_U_COUNT])u, &miss);
  half->winding = miss.winding;
  *off = hypot(miss.off[0], miss.off[1]);
  return status;
}

/* Find the number of the half map by which an orbit at a place nearly closes; -1: by none. */
static pendres_status closing_half(pendres_context *ctx, const pendres_trail *t,
                                   const double u[PENDRES_U_COUNT], int *which)
{
  for (*which = 0; *which < PENDRES_MAP_HALVES; ++*which) {
    pendres_continuation_map half;
    double off = NAN;
    const pendres_status status = half_at(ctx, t, *which, u, &half, &off);
    if (status == PENDRES_NOT_CONVERGED) break;
    if (status != PENDRES_OK || off < 1e-3) return status;
  }
  *which = -1;
  return PENDRES_OK;
}

/* Locate where the branch was born from orbits of the half map that the zero tells: a flip of
   that. */
static pendres_status locate_birth(pendres_context *ctx, const pendres_trail *t,
                                   const double u[PENDRES_U_COUNT], double reach,
                                   pendres_course_special *m)
{
  pendres_continuation_map half;
  pendres_located flip;
  double off = NAN;
  pendres_status status = half_at(ctx, t, m->at.half, u, &half, &off);
  const pendres_continuation_system flips =
    pendres_continuation_system_of(&half, PENDRES_CONDITION_FLIP, t->kind.unknown);
  if (status == PENDRES_OK) status = pendres_continuation_locate(ctx, &flips, u, reach, &flip);
  if (!pendres_located_found(status)) return status;
  m->condition = PENDRES_CONDITION_FLIP;
  m->located = flip;
  return status;
}

/*
 * Locate a zero of the fold's test function. Where a branch was born it turns round: that looks
 * like a fold of its own map, but is the flip of a half map, of the one by which orbits close
 * there. What closes by half and is no flip of that is a fold all the same.
 */
static pendres_status locate_fold(pendres_context *ctx, const pendres_trail *t,
                                  const double u[PENDRES_U_COUNT], double reach,
                                  pendres_course_special *m)
{
  int which = -1;
  m->condition = PENDRES_CONDITION_FOLD;
  /* Rest has no folds: there the other map has a flip. */
  if (t->kind.map.mirror == PENDRES_MIRROR_WHOLE && t->kind.map.period <= 2 && !t->kind.apart)
    return locate_birth(ctx, t, u, reach, m);
  const pendres_continuation_system folds =
    pendres_continuation_system_of(&t->kind.map, m->condition, t->kind.unknown);
  const pendres_status fold = pendres_continuation_locate(ctx, &folds, u, reach, &m->located);
  const int found = pendres_located_found(fold);
  if (!found && fold != PENDRES_NOT_CONVERGED) return fold;
  const pendres_status asked = closing_half(ctx, t, found ? m->located.pair.coarse : u, &which);
  if (asked != PENDRES_OK) return asked;
  if (found && which < 0) return fold;
  /* So close to a birth that the fold is known less well than the zero, the birth is the same. */
  const double *error = m->located.error;
  const double near = found ? fmax(reach, hypot(error[0], error[1])) : reach;
  m->at.half = which > 0 ? which : 0;
  const pendres_status born = locate_birth(ctx, t, u, near, m);
  return born == PENDRES_NOT_CONVERGED ? fold : born;
}

/* Locate where another branch crosses. Where this one was born from orbits that close by half it
   meets itself, and of rest the other map has a flip. */
static pendres_status locate_crossing(pendres_context *ctx, const pendres_trail *t,
                                      const double u[PENDRES_U_COUNT], double reach,
                                      pendres_course_special *m)
{
  int which = -1;
  m->condition = PENDRES_CONDITION_CROSSING;
  if (t->kind.map.mirror == PENDRES_MIRROR_WHOLE && t->kind.map.period <= 2)
    return PENDRES_NOT_CONVERGED;
  const pendres_continuation_system crossings =
    pendres_continuation_system_of(&t->kind.map, m->condition, t->kind.unknown);
  const pendres_status status =
    pendres_continuation_locate(ctx, &crossings, u, reach, &m->located);
  if (!pendres_located_found(status) || t->kind.apart == 0) return status;
  const pendres_status asked = closing_half(ctx, t, m->located.pair.coarse, &which);
  return asked != PENDRES_OK ? asked : which >= 0 ? PENDRES_NOT_CONVERGED : status;
}

static pendres_status locate_flip(pendres_context *ctx, const pendres_trail *t,
                                  const double u[PENDRES_U_COUNT], double reach,
                                  pendres_course_special *m)
{
  m->condition = PENDRES_CONDITION_FLIP;
  const pendres_continuation_system flips =
    pendres_continuation_system_of(&t->kind.map, m->condition, t->kind.unknown);
  return pendres_continuation_locate(ctx, &flips, u, reach, &m->located);
}

/* Leave out the zeros of folds' test function at branch points, of which it has one as well. */
static size_t without_crossings(const pendres_course *c, size_t n, pendres_trail_zero *zeros)
{
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    int crossed = 0;
    for (size_t k = 0; k < c->specials; k++)
      crossed |= c->special[k].condition == PENDRES_CONDITION_CROSSING &&
                 c->special[k].at.i == zeros[i].i;
    if (!crossed) zeros[kept++] = zeros[i];
  }
  return kept;
}

/* Locate all bifurcations of a trail. Births and branch points come first, since the test function
   of folds may have a zero or two there. */
static pendres_status locate_all(pendres_context *ctx, pendres_course *c)
{
  pendres_trail_zero zeros[MOST_BIFURCATIONS];
  size_t n = 0;
  pendres_status status = pendres_trail_births(ctx, c->trail, MOST_BIFURCATIONS, zeros, &n);
  if (status == PENDRES_OK) status = pendres_course_locate(ctx, locate_birth, n, zeros, c);
  if (status == PENDRES_OK) {
    n = pendres_trail_crossings(c->trail, MOST_BIFURCATIONS, zeros);
    status = pendres_course_locate(ctx, locate_crossing, n, zeros, c);
  }
  if (status == PENDRES_OK) {
    n = pendres_trail_zeros(c->trail, test_fold, MOST_BIFURCATIONS, zeros);
    n = without_crossings(c, n, zeros);
    status = pendres_course_locate(ctx, locate_fold, n, zeros, c);
  }
  if (status == PENDRES_OK) {
    n = pendres_trail_zeros(c->trail, test_flip, MOST_BIFURCATIONS, zeros);
    status = pendres_course_locate(ctx, locate_flip, n, zeros, c);
  }
  return status;
}

/* ---- points ---- */

/* Tell a branch point which way the other branch goes. */
static pendres_status set_crossing(pendres_context *ctx, const pendres_trail *t,
                                   const pendres_course_special *s, pendres_bifurcation *b)
{
  const pendres_continuation_pair *p = &s->located.pair;
  pendres_continuation_system system =
    pendres_continuation_system_of(&p->map, s->condition, t->kind.unknown);
  double way[3];
  system.steps = p->fine_steps;
  const pendres_status status =
    pendres_crossing_direction(ctx, &system, p->fine, t->point[s->at.i].tangent, way);
  if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  const int place = t->kind.unknown[2];
  for (int k = 0; k < 3; k++) {
    const int i = t->kind.unknown[k];
    way[k] *= pendres_arc_scale(i, p->fine[i]);
  }
  way[1] *= p->fine[PENDRES_U_OMEGA]; /* of w = v / omega */
  if (place == PENDRES_U_OMEGA) way[1] += p->fine[PENDRES_U_W] * way[2];
  memcpy(b->crossing, way, sizeof way);
  return PENDRES_OK;
}

static pendres_status fill(pendres_context *ctx, const pendres_course *c, pendres_branch *b)
{
  b->bifurcation = malloc((c->specials + 1) * sizeof *b->bifurcation);
  b->point = malloc((c->count + 1) * sizeof *b->point);
  if (b->bifurcation == NULL || b->point == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (; b->bifurcations < c->specials; b->bifurcations++) {
    const pendres_course_special *s = &c->special[b->bifurcations];
    pendres_bifurcation *at = &b->bifurcation[b->bifurcations];
    pendres_status status =
      pendres_continuation_locate_finish(ctx, s->condition, b->parameter, &s->located, at);
    if (status == PENDRES_OK && s->condition == PENDRES_CONDITION_CROSSING)
      status = set_crossing(ctx, c->trail, s, at);
    if (status != PENDRES_OK) return status;
  }
  for (; b->count < c->count; b->count++) {
    const pendres_course_point *p = &c->point[b->count];
    const pendres_bifurcation *f = p->special >= 0 ? &b->bifurcation[p->special] : NULL;
    b->point[b->count] =
      (pendres_branch_point){.kind = f != NULL ? f->kind : PENDRES_REGULAR,
                             .bifurcation = p->special,
                             .arclength = p->arclength,
                             .parameter_error = f != NULL ? f->value_error : c->error[p->i][0],
                             .orbit = f != NULL ? f->orbit : c->orbit[p->i]};
  }
  return PENDRES_OK;
}

/* What a call of pendres_branch_follow() was given. */
typedef struct branch_call {
  const pendres_orbit *starts;
  const pendres_branch_options *options;
  int outline; /* without measures */
  pendres_branch **out;
} branch_call;

static void begin(const void *call, size_t i, pendres_trail_start *start)
{
  const branch_call *b = call;
  start->kind =
    pendres_arc_of(&b->starts[i], PENDRES_CONDITION_NONE, &b->options->parameter,
                   b->options->spacing > 0.0 ? b->options->spacing : 0.05, start->u);
}

static pendres_status build(pendres_context *ctx, void *call, size_t i, pendres_trail *t)
{
  const branch_call *to = call;
  pendres_course c = {0};
  pendres_branch *b = to->out[i] = calloc(1, sizeof *b);
  if (b == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  *b = (pendres_branch){
    .parameter = to->options->parameter, .map = t->kind.map, .end = {t->end[0], t->end[1]}};
  pendres_status status = pendres_trail_refine(ctx, t, test_fold);
  if (status == PENDRES_OK) status = pendres_trail_refine(ctx, t, test_flip);
  if (status == PENDRES_OK) status = pendres_course_begin(ctx, t, MOST_BIFURCATIONS, &c);
  if (status == PENDRES_OK) status = locate_all(ctx, &c);
  if (status == PENDRES_OK)
    status = to->outline ? pendres_course_outline(ctx, &c) : pendres_course_measure(ctx, &c);
  if (status == PENDRES_OK) status = fill(ctx, &c, b);
  if (status == PENDRES_OK && !to->outline) pendres_branch_check(b);
  pendres_course_free(&c);
  return status;
}

/* ---- following ---- */

const char *pendres_branch_refuses(const pendres_branch_options *o, size_t n,
                                   const pendres_orbit *starts)
{
  if ((unsigned)o->parameter >= PENDRES_PARAMETER_FOLLOWED) return "unknown parameter";
  if (!(o->low < o->high && isfinite(o->low) && isfinite(o->high)))
    return "the range of the parameter is empty";
  if (o->parameter == PENDRES_DRIVE_FREQUENCY && !(o->low > 0.0))
    return "drive frequencies must be positive";
  if (o->parameter == PENDRES_DAMPING && !(o->low >= 0.0)) return "damping must not be negative";
  if (!(o->spacing >= 0.0 && o->wildest >= 0.0)) return "spacing and wildest must not be negative";
  for (size_t i = 0; i < n; i++) {
    const char *why = pendres_continuation_refuses(&starts[i], o->parameter);
    if (why != NULL) return why;
  }
  return NULL;
}

static pendres_status follow(pendres_context *ctx, size_t n, branch_call *call)
{
  const pendres_orbit *starts = call->starts;
  const pendres_branch_options *o = call->options;
  for (size_t i = 0; i < n; i++) call->out[i] = NULL;
  if (n == 0) return PENDRES_OK;
  const char *why = pendres_branch_refuses(o, n, starts);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);

  static const pendres_course_kind kind = {
    .name = "branches", .start = "orbit", .begin = begin, .build = build};
  const pendres_trail_bounds bounds = {.low = {o->low},
                                       .high = {o->high},
                                       .wildest = o->wildest > 0.0 ? o->wildest : 1e3,
                                       .most_points = o->most_points > 0 ? o->most_points : 2000};
  const pendres_status status = pendres_course_follow(ctx, &kind, n, &bounds, call);
  for (size_t i = 0; i < n && status != PENDRES_OK; i++) {
    pendres_branch_free(call->out[i]);
    call->out[i] = NULL;
  }
  return status;
}

static pendres_status branch_follow(pendres_context *ctx, size_t n, const pendres_orbit *starts,
                                    const pendres_branch_options *options, pendres_branch **out)
{
  if (options == NULL || (n > 0 && (starts == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "starts, options and out");
  branch_call call = {.starts = starts, .options = options, .out = out};
  return follow(ctx, n, &call);
}

pendres_status pendres_branch_outline(pendres_context *ctx, const pendres_orbit *start,
                                      const pendres_branch_options *options, pendres_branch **out)
{
  branch_call call = {.starts = start, .options = options, .outline = 1, .out = out};
  return follow(ctx, 1, &call);
}

pendres_status pendres_branch_follow(pendres_context *ctx, size_t n, const pendres_orbit *starts,
                                     const pendres_branch_options *options, pendres_branch **out)
{
  pendres_door d;
  pendres_door_open_many(&d, ctx, n, starts, sizeof *starts);
  if (options != NULL)
    pendres_door_range(&d, options->parameter, options->low, options->high);
  for (size_t i = 0; d.status == PENDRES_OK && out != NULL && i < n; i++) out[i] = NULL;
  while (pendres_door_next(&d)) {
    const size_t i = d.first, m = d.count;
    pendres_branch **mine = PENDRES_DOOR_AT(out, i);
    const pendres_orbit *from =
      pendres_door_in(&d, &pendres_dim_orbit, m, PENDRES_DOOR_AT(starts, i));
    if (options != NULL) pendres_door_move(&d, options->parameter, options->parameter);
    const pendres_branch_options *o = pendres_door_in(&d, &pendres_dim_branch_options, 1, options);
    PENDRES_DOOR_CALL(&d, branch_follow(ctx, m, from, o, mine));
    for (size_t k = 0; d.status == PENDRES_OK && k < m; k++) pendres_branch_leave(&d, mine[k]);
  }
  for (size_t i = 0; d.begun && d.status != PENDRES_OK && out != NULL && i < n; i++) {
    pendres_branch_free(out[i]);
    out[i] = NULL;
  }
  return pendres_door_close(&d);
}
