/* continuation_branch.c -- branches of periodic orbits in one parameter; see continuation.h. */
#include "continuation/continuation_branch.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "continuation/continuation_locate.h"
#include "continuation/continuation_parameter.h"

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

const char *pendres_branch_end_name(pendres_branch_end end)
{
  static const char *const names[PENDRES_END_COUNT] = {
    "range", "closed", "too_wild", "too_long", "stuck"};
  return (unsigned)end < PENDRES_END_COUNT ? names[end] : NULL;
}

pendres_branch_end pendres_branch_end_of(const pendres_branch *b, int which)
{
  return b != NULL ? b->end[which != 0] : PENDRES_END_STUCK;
}

/* ---- bifurcations on the way ---- */

static double test_fold(const pendres_walk_point *p)
{
  return pendres_continuation_map_fold(&p->image);
}

static double test_flip(const pendres_walk_point *p)
{
  return pendres_continuation_map_flip(&p->image);
}

/* A bifurcation and where on the trail it lies. */
typedef struct met {
  pendres_trail_zero at;
  pendres_continuation_condition condition;
  pendres_located located;
} met;

static int in_order(const void *a, const void *b)
{
  const met *p = a, *q = b;
  if (p->at.i != q->at.i) return p->at.i < q->at.i ? -1 : 1;
  return p->at.part < q->at.part ? -1 : p->at.part > q->at.part;
}

static int same_place(const pendres_walk *w, const met *a, const met *b)
{
  double sum = 0.0;
  if (a->condition != b->condition) return 0;
  for (int k = 0; k < w->unknowns; k++)
    sum = hypot(sum, a->located.pair.fine[w->unknown[k]] - b->located.pair.fine[w->unknown[k]]);
  return sum < 1e-8;
}

static int is_found(pendres_status status)
{
  return status == PENDRES_OK || status == PENDRES_TOLERANCE_UNREACHABLE;
}

/* The half map about a place by which an orbit there closes, nearly; the first if there is none. */
static pendres_status half_at(pendres_context *ctx, const pendres_trail *t,
                              const double u[PENDRES_U_COUNT], pendres_continuation_map *half,
                              int *twice)
{
  int steps = 0;
  pendres_continuation_map one;
  *twice = 0;
  if (!pendres_continuation_map_half(&t->kind.map, 0, half)) return PENDRES_NOT_CONVERGED;
  pendres_status status =
    pendres_continuation_map_steps(ctx, t->kind.map.force, u, 10.0 * ctx->options.tolerance,
                                   &steps);
  for (int k = 0; !*twice && status == PENDRES_OK; k++) {
    double miss[1][2] = {{NAN, NAN}};
    if (!pendres_continuation_map_half(&t->kind.map, k, &one)) break;
    status = pendres_continuation_map_closes(ctx, &one, steps, 1,
                                             (const double (*)[PENDRES_U_COUNT])u, miss,
                                             &one.winding);
    *twice = hypot(miss[0][0], miss[0][1]) < 1e-3;
    if (k == 0 || *twice) *half = one;
  }
  return status;
}

/* Locate where the branch was born from orbits of the half map: a flip of that. */
static pendres_status locate_birth(pendres_context *ctx, const pendres_trail *t,
                                   const double u[PENDRES_U_COUNT], double reach, met *m)
{
  pendres_continuation_map half;
  pendres_located flip;
  int twice = 0;
  pendres_status status = half_at(ctx, t, u, &half, &twice);
  if (status == PENDRES_OK)
    status = pendres_continuation_locate(ctx, &half, PENDRES_CONDITION_FLIP, t->kind.unknown, u,
                                         reach, &flip);
  if (!is_found(status)) return status;
  m->condition = PENDRES_CONDITION_FLIP;
  m->located = flip;
  return status;
}

/*
 * Locate a zero of the fold's test function. Where a branch was born it turns round: that looks
 * like a fold of its own map, but is the flip of the half map. What closes by half and is no flip
 * of that is a fold all the same.
 */
static pendres_status locate_fold(pendres_context *ctx, const pendres_trail *t,
                                  const double u[PENDRES_U_COUNT], double reach, met *m)
{
  pendres_continuation_map half;
  int twice = 0;
  /* Rest has no folds: there the other map has a flip. */
  if (t->kind.map.mirror == PENDRES_MIRROR_WHOLE && !t->kind.apart)
    return locate_birth(ctx, t, u, reach, m);
  const pendres_status fold = pendres_continuation_locate(
    ctx, &t->kind.map, PENDRES_CONDITION_FOLD, t->kind.unknown, u, reach, &m->located);
  if (!is_found(fold))
    return fold == PENDRES_NOT_CONVERGED ? locate_birth(ctx, t, u, reach, m) : fold;
  const pendres_status asked = half_at(ctx, t, m->located.pair.coarse, &half, &twice);
  if (asked != PENDRES_OK || !twice) return asked == PENDRES_NOT_CONVERGED ? fold : asked;
  const pendres_status born = locate_birth(ctx, t, u, reach, m);
  return born == PENDRES_NOT_CONVERGED ? fold : born;
}

static pendres_status locate_flip(pendres_context *ctx, const pendres_trail *t,
                                  const double u[PENDRES_U_COUNT], double reach, met *m)
{
  m->condition = PENDRES_CONDITION_FLIP;
  return pendres_continuation_locate(ctx, &t->kind.map, m->condition, t->kind.unknown, u, reach,
                                     &m->located);
}

/* A way to locate what a zero of a test function stands for. */
typedef pendres_status locator(pendres_context *ctx, const pendres_trail *t,
                               const double u[PENDRES_U_COUNT], double reach, met *m);

/* What does not converge was no zero. */
static pendres_status locate_zeros(pendres_context *ctx, const pendres_trail *t, locator *locate,
                                   size_t n, const pendres_trail_zero *zeros, met *list,
                                   size_t *count)
{
  for (size_t i = 0; i < n && *count < MOST_BIFURCATIONS; i++) {
    double u[PENDRES_U_COUNT];
    met *m = &list[*count];
    const double chord = pendres_trail_between(t, &zeros[i], u);
    *m = (met){.at = zeros[i], .condition = PENDRES_CONDITION_FOLD};
    const pendres_status status = locate(ctx, t, u, 2.0 * chord, m);
    if (status == PENDRES_NOT_CONVERGED) continue;
    if (!is_found(status)) return status;
    int known = 0;
    for (size_t k = 0; k < *count && !known; k++) known = same_place(&t->kind, &list[k], m);
    if (!known) ++*count;
  }
  return PENDRES_OK;
}

/* All bifurcations of a trail; births first, at which folds' function may have a zero or two. */
static pendres_status locate_all(pendres_context *ctx, const pendres_trail *t, met *list,
                                 size_t *count)
{
  pendres_trail_zero zeros[MOST_BIFURCATIONS];
  size_t n = 0;
  *count = 0;
  pendres_status status = pendres_trail_births(ctx, t, MOST_BIFURCATIONS, zeros, &n);
  if (status == PENDRES_OK) status = locate_zeros(ctx, t, locate_birth, n, zeros, list, count);
  if (status == PENDRES_OK) {
    n = pendres_trail_zeros(t, test_fold, MOST_BIFURCATIONS, zeros);
    status = locate_zeros(ctx, t, locate_fold, n, zeros, list, count);
  }
  if (status == PENDRES_OK) {
    n = pendres_trail_zeros(t, test_flip, MOST_BIFURCATIONS, zeros);
    status = locate_zeros(ctx, t, locate_flip, n, zeros, list, count);
  }
  return status;
}

static pendres_status finish_bifurcations(pendres_context *ctx, pendres_parameter parameter,
                                          size_t n, const met *list, pendres_branch *b)
{
  b->bifurcation = malloc((n + 1) * sizeof *b->bifurcation);
  if (b->bifurcation == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (size_t i = 0; i < n; i++) {
    const pendres_status status = pendres_continuation_locate_finish(
      ctx, list[i].condition, parameter, &list[i].located, &b->bifurcation[i]);
    if (status != PENDRES_OK) return status;
    b->bifurcations++;
  }
  return PENDRES_OK;
}

/* ---- points ---- */

/* Regular points and bifurcations, merged in the order of the trail. */
static void merge(const pendres_trail *t, const pendres_orbit *orbits, const double (*error)[2],
                  const met *list, pendres_branch *b)
{
  size_t k = 0;
  for (size_t i = 0; i < t->count; i++) {
    b->point[b->count++] = (pendres_branch_point){.kind = PENDRES_REGULAR,
                                                  .bifurcation = -1,
                                                  .arclength = t->point[i].arclength,
                                                  .parameter_error = error[i][0],
                                                  .orbit = orbits[i]};
    for (; k < b->bifurcations && list[k].at.i == i; k++) {
      const pendres_bifurcation *f = &b->bifurcation[k];
      double u[PENDRES_U_COUNT];
      const double chord = pendres_trail_between(t, &list[k].at, u);
      b->point[b->count++] =
        (pendres_branch_point){.kind = f->kind,
                               .bifurcation = (int)k,
                               .arclength = t->point[i].arclength + list[k].at.part * chord,
                               .parameter_error = f->value_error,
                               .orbit = f->orbit};
    }
  }
}

static pendres_status build(pendres_context *ctx, pendres_trail *t, pendres_parameter parameter,
                            pendres_branch **out)
{
  size_t met_count = 0;
  pendres_status status = pendres_trail_refine(ctx, t, test_fold);
  if (status == PENDRES_OK) status = pendres_trail_refine(ctx, t, test_flip);
  if (status != PENDRES_OK) return status;
  status = PENDRES_OUT_OF_MEMORY;
  pendres_branch *b = calloc(1, sizeof *b);
  met *list = malloc(MOST_BIFURCATIONS * sizeof *list);
  pendres_continuation_pair *pairs = malloc((t->count + 1) * sizeof *pairs);
  pendres_orbit *orbits = malloc((t->count + 1) * sizeof *orbits);
  double(*error)[2] = malloc((t->count + 1) * sizeof *error);
  if (b == NULL || list == NULL || pairs == NULL || orbits == NULL || error == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for a branch");
    goto done;
  }
  b->parameter = parameter;
  b->map = t->kind.map;
  b->end[0] = t->end[0];
  b->end[1] = t->end[1];
  status = locate_all(ctx, t, list, &met_count);
  if (status != PENDRES_OK) goto done;
  qsort(list, met_count, sizeof *list, in_order);
  status = finish_bifurcations(ctx, parameter, met_count, list, b);
  if (status == PENDRES_OK) status = pendres_trail_polish(ctx, t, pairs, error);
  if (status == PENDRES_OK)
    status = pendres_continuation_orbit_measure(ctx, t->count, pairs, orbits);
  if (status != PENDRES_OK) goto done;
  b->point = malloc((t->count + met_count + 1) * sizeof *b->point);
  if (b->point == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
    goto done;
  }
  merge(t, orbits, (const double (*)[2])error, list, b);
  pendres_branch_check(b);
  *out = b;
  b = NULL;
done:
  pendres_branch_free(b);
  free(list);
  free(pairs);
  free(orbits);
  free(error);
  return status;
}

/* ---- following ---- */

const char *pendres_branch_refuses(const pendres_branch_options *o, size_t n,
                                   const pendres_orbit *starts)
{
  if ((unsigned)o->parameter >= PENDRES_PARAMETER_COUNT) return "unknown parameter";
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

static pendres_status branch_follow(pendres_context *ctx, size_t n, const pendres_orbit *starts,
                                    const pendres_branch_options *options, pendres_branch **out)
{
  if (options == NULL || (n > 0 && (starts == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "starts, options and out");
  for (size_t i = 0; i < n; i++) out[i] = NULL;
  if (n == 0) return PENDRES_OK;
  const pendres_branch_options *o = options;
  const char *why = pendres_branch_refuses(o, n, starts);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);

  size_t which = 0;
  const pendres_trail_bounds bounds = {.low = {o->low},
                                       .high = {o->high},
                                       .wildest = o->wildest > 0.0 ? o->wildest : 1e3,
                                       .most_points = o->most_points > 0 ? o->most_points : 2000};
  pendres_status status = PENDRES_OK;
  pendres_trail_start *begin = calloc(n, sizeof *begin);
  pendres_trail *trails = calloc(n, sizeof *trails);
  if (begin == NULL || trails == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu branches", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++)
    begin[i].kind = pendres_walk_of(&starts[i], PENDRES_CONDITION_NONE, &o->parameter,
                                    o->spacing > 0.0 ? o->spacing : 0.05, begin[i].u);
  status = pendres_trail_follow(ctx, n, begin, &bounds, trails, &which);
  if (status == PENDRES_NOT_CONVERGED)
    (void)pendres_context_fail(ctx, status, "start %zu of the branches is no orbit", which);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = build(ctx, &trails[i], o->parameter, &out[i]);
done:
  for (size_t i = 0; i < n && trails != NULL; i++) pendres_trail_free(&trails[i]);
  free(begin);
  free(trails);
  for (size_t i = 0; i < n && status != PENDRES_OK; i++) {
    pendres_branch_free(out[i]);
    out[i] = NULL;
  }
  return status;
}

pendres_status pendres_branch_follow(pendres_context *ctx, size_t n, const pendres_orbit *starts,
                                     const pendres_branch_options *options, pendres_branch **out)
{
  return PENDRES_CONTEXT_CALL(ctx, branch_follow(ctx, n, starts, options, out));
}
