/* course.c -- trails with their special points; see course.h. */
#include "continuation/course.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "orbits/attractor_set.h"
#include "orbits/orbit_measure.h"

pendres_status pendres_course_begin(pendres_context *ctx, const pendres_trail *t, size_t room,
                                    pendres_course *c)
{
  const size_t n = t->count + 1;
  *c = (pendres_course){.trail = t,
                        .room = room,
                        .special = malloc((room + 1) * sizeof *c->special),
                        .pair = malloc(n * sizeof *c->pair),
                        .orbit = malloc(n * sizeof *c->orbit),
                        .error = malloc(n * sizeof *c->error),
                        .point = malloc((n + room) * sizeof *c->point)};
  if (c->special == NULL || c->pair == NULL || c->orbit == NULL || c->error == NULL ||
      c->point == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu points", n);
  return PENDRES_OK;
}

void pendres_course_free(pendres_course *c)
{
  free(c->special);
  free(c->pair);
  free(c->orbit);
  free(c->error);
  free(c->point);
}

/* ---- special points ---- */

/* A trail is back at a place only after more than so many of its longest steps. */
static const double another_pass = 4.0;

/* Whether two special points of a trail are one. A trail that passes a place twice, as the two ways
   of a start on a closed curve may, has a special point there each time. */
static int same_place(const pendres_trail *t, const pendres_course_special *a,
                      const pendres_course_special *b)
{
  const pendres_arc *w = &t->kind;
  const double round = t->point[t->count - 1].arclength;
  double sum = 0.0, between = fabs(t->point[a->at.i].arclength - t->point[b->at.i].arclength);
  if (t->closed) between = fmin(between, round - between);
  if (a->condition != b->condition || between > another_pass * w->longest) return 0;
  for (int k = 0; k < w->unknowns; k++)
    sum = hypot(sum, a->located.pair.fine[w->unknown[k]] - b->located.pair.fine[w->unknown[k]]);
  return sum < 1e-8;
}

pendres_status pendres_course_locate(pendres_context *ctx, pendres_course_locator *locate,
                                     size_t n, const pendres_trail_zero *zeros, pendres_course *c)
{
  for (size_t i = 0; i < n && c->specials < c->room; i++) {
    double u[PENDRES_U_COUNT];
    pendres_course_special *s = &c->special[c->specials];
    const double chord = pendres_trail_between(c->trail, &zeros[i], u);
    *s = (pendres_course_special){.at = zeros[i]};
    const pendres_status status = locate(ctx, c->trail, u, 2.0 * chord, s);
    if (status == PENDRES_NOT_CONVERGED) continue;
    if (!pendres_located_found(status)) return status;
    int known = 0;
    for (size_t k = 0; k < c->specials && !known; k++)
      known = same_place(c->trail, &c->special[k], s);
    if (!known) c->specials++;
  }
  return PENDRES_OK;
}

static int in_order(const void *a, const void *b)
{
  const pendres_course_special *p = a, *q = b;
  if (p->at.i != q->at.i) return p->at.i < q->at.i ? -1 : 1;
  return p->at.part < q->at.part ? -1 : p->at.part > q->at.part;
}

/* ---- all points ---- */

static void list_points(pendres_course *c)
{
  const pendres_trail *t = c->trail;
  size_t k = 0;
  for (size_t i = 0; i < t->count; i++) {
    const double at = t->point[i].arclength;
    c->point[c->count++] = (pendres_course_point){.i = i, .special = -1, .arclength = at};
    for (; k < c->specials && c->special[k].at.i == i; k++) {
      double u[PENDRES_U_COUNT];
      const double chord = pendres_trail_between(t, &c->special[k].at, u);
      c->point[c->count++] = (pendres_course_point){
        .i = i, .special = (int)k, .arclength = at + c->special[k].at.part * chord};
    }
  }
}

pendres_status pendres_course_measure(pendres_context *ctx, pendres_course *c)
{
  qsort(c->special, c->specials, sizeof *c->special, in_order);
  pendres_status status = pendres_trail_polish(ctx, c->trail, c->pair, c->error);
  if (status == PENDRES_OK)
    status = pendres_continuation_orbit_measure(ctx, c->trail->count, c->pair, c->orbit);
  if (status == PENDRES_OK) list_points(c);
  return status;
}

/* ---- outlines ---- */

/* The special points stand behind points i of the trail: polish these and the next ones, so that
   points and special points are in the order of the parameter, too. */
static pendres_status polish_neighbours(pendres_context *ctx, pendres_course *c)
{
  const pendres_trail *t = c->trail;
  pendres_trail part = *t;
  size_t *index = malloc((2 * c->specials + 1) * sizeof *index), n = 0;
  pendres_continuation_pair *pair = malloc((2 * c->specials + 1) * sizeof *pair);
  double(*error)[2] = malloc((2 * c->specials + 1) * sizeof *error);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  part.point = malloc((2 * c->specials + 1) * sizeof *part.point);
  if (index == NULL || pair == NULL || error == NULL || part.point == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for a branch");
    goto done;
  }
  for (size_t k = 0; k < c->specials; k++)
    for (size_t i = c->special[k].at.i; i <= c->special[k].at.i + 1 && i < t->count; i++)
      if (n == 0 || i > index[n - 1]) index[n++] = i;
  for (size_t k = 0; k < n; k++) part.point[k] = t->point[index[k]];
  part.count = n;
  status = pendres_trail_polish(ctx, &part, pair, error);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    c->pair[index[k]] = pair[k];
    memcpy(c->error[index[k]], error[k], sizeof error[k]);
  }
done:
  free(index);
  free(pair);
  free(error);
  free(part.point);
  return status;
}

/* The trace of the derivative over all of the orbit's period, from that of its map. */
static double trace_of(const pendres_continuation_map *map, const pendres_continuation_image *image)
{
  const double trace = image->trace;
  if (map->mirror == PENDRES_MIRROR_NONE) return trace;
  /* Of rest the map is the strobe map itself, followed by a reflection. */
  if (map->mirror == PENDRES_MIRROR_WHOLE && map->period == 1) return -trace;
  return trace * trace - 2.0 * image->determinant;
}

static pendres_orbit outline_of(const pendres_continuation_pair *pair,
                                const pendres_continuation_image *image)
{
  const double *u = pair->fine;
  const pendres_pendulum p = pendres_continuation_map_pendulum(pair->map.force, u);
  const pendres_coordinates place = {.y = u[PENDRES_U_Y], .w = u[PENDRES_U_W]};
  const double time = two_pi * pair->map.period / p.drive_frequency;
  pendres_orbit o = pendres_orbit_none(&p);
  pendres_coordinates_out(&p, &place, &o.x, &o.v);
  o.period = pair->map.period;
  o.winding = pair->map.mirror ? 0 : pair->map.winding;
  pendres_orbit_set_multipliers(trace_of(&pair->map, image), exp(-0.5 * p.damping * time), &o);
  return o;
}

pendres_status pendres_course_outline(pendres_context *ctx, pendres_course *c)
{
  const pendres_trail *t = c->trail;
  qsort(c->special, c->specials, sizeof *c->special, in_order);
  for (size_t i = 0; i < t->count; i++) {
    c->pair[i] = (pendres_continuation_pair){.map = t->kind.map};
    memcpy(c->pair[i].fine, t->point[i].u, sizeof c->pair[i].fine);
    c->error[i][0] = c->error[i][1] = t->kind.tolerance;
  }
  const pendres_status status = polish_neighbours(ctx, c);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < t->count; i++)
    c->orbit[i] = outline_of(&c->pair[i], &t->point[i].image);
  list_points(c);
  return PENDRES_OK;
}

/* ---- following ---- */

pendres_status pendres_course_follow(pendres_context *ctx, const pendres_course_kind *kind,
                                     size_t n, const pendres_trail_bounds *bounds, void *call)
{
  size_t which = 0;
  pendres_status status = PENDRES_OK;
  pendres_trail_start *start = calloc(n + 1, sizeof *start);
  pendres_trail *trail = calloc(n + 1, sizeof *trail);
  if (start == NULL || trail == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu %s", n,
                                  kind->name);
    goto done;
  }
  for (size_t i = 0; i < n; i++) kind->begin(call, i, &start[i]);
  status = pendres_trail_follow(ctx, n, start, bounds, trail, &which);
  if (status == PENDRES_NOT_CONVERGED)
    (void)pendres_context_fail(ctx, status, "start %zu of the %s is no %s", which, kind->name,
                               kind->start);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = kind->build(ctx, call, i, &trail[i]);
done:
  for (size_t i = 0; i < n && trail != NULL; i++) pendres_trail_free(&trail[i]);
  free(start);
  free(trail);
  return status;
}
