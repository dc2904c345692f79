/* families.c -- the curves that many bifurcations lie on; see continuation.h. */
#include "continuation/families.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "engine/context_internal.h"
#include "continuation/units.h"
#include "continuation/alike.h"
#include "continuation/layout.h"

pendres_curves *pendres_curves_create(void)
{
  return calloc(1, sizeof(pendres_curves));
}

void pendres_curves_free(pendres_curves *c)
{
  if (c == NULL) return;
  for (size_t i = 0; i < c->count; i++) pendres_curve_free(c->curve[i]);
  free(c->curve);
  free(c);
}

size_t pendres_curves_count(const pendres_curves *c)
{
  return c != NULL ? c->count : 0;
}

const pendres_curve *pendres_curves_get(const pendres_curves *c, size_t i)
{
  return c != NULL && i < c->count ? c->curve[i] : NULL;
}

/* ---- whether a curve is known ---- */

static int on_curve(const pendres_curve *c, const pendres_bifurcation *b, pendres_parameter second)
{
  const double value = pendres_parameter_get(second, &b->orbit.pendulum);
  const pendres_curve_point *p = pendres_curve_get(c, 0);
  if (pendres_curve_kind(c) != b->kind || p->orbit.period != b->orbit.period ||
      !same_winding(&p->orbit, &b->orbit))
    return 0;
  for (size_t i = 0; i + 1 < pendres_curve_count(c); i++) {
    const pendres_curve_point *q = pendres_curve_get(c, i + 1);
    p = pendres_curve_get(c, i);
    const double from = p->value[1] - value, to = q->value[1] - value;
    const double part = from * to <= 0.0 && from != to ? from / (from - to) : 0.0;
    /* At a cusp or a turning point the value may lie just beyond the points. */
    if (from * to > 0.0 && fmin(fabs(from), fabs(to)) > 1e-4) continue;
    if (fabs(mixed(p->value[0], q->value[0], part) - b->value) < alike &&
        fabs(mixed(p->orbit.amplitude, q->orbit.amplitude, part) - b->orbit.amplitude) <
          alike + fabs(p->orbit.amplitude - q->orbit.amplitude))
      return 1;
  }
  return 0;
}

/* Add a curve, which is freed where there is no memory; not 0: it is there. */
static int append(pendres_curves *set, pendres_curve *c)
{
  pendres_curve **grown = pendres_grow(set->curve, set->count, &set->capacity, sizeof *grown);
  if (grown == NULL) {
    pendres_curve_free(c);
    return 0;
  }
  set->curve = grown;
  set->curve[set->count++] = c;
  return 1;
}

/* The curve of bifurcation `number` of those. */
static pendres_status add_curve(pendres_context *ctx, const pendres_bifurcation *all, size_t number,
                                const pendres_curve_options *options, pendres_curves *set)
{
  pendres_curve *c = NULL;
  const pendres_status status = pendres_curve_follow(ctx, 1, &all[number], options, &c);
  if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  /* Nothing can be followed from a bifurcation among wild orbits: it stays a single point. */
  if (pendres_curve_count(c) < 3) {
    pendres_curve_free(c);
    return PENDRES_OK;
  }
  c->start = number;
  if (append(set, c)) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for curves");
}

static int on_any(const pendres_curves *set, const pendres_bifurcation *b, pendres_parameter second)
{
  for (size_t k = 0; k < pendres_curves_count(set); k++)
    if (on_curve(set->curve[k], b, second)) return 1;
  return 0;
}

pendres_status pendres_curves_add(pendres_context *ctx, const pendres_curve_starts *starts,
                                  const pendres_curve_options *options,
                                  const pendres_curves *known, pendres_curves *curves, size_t *at)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < starts->n && status == PENDRES_OK; i++) {
    const size_t number = starts->which != NULL ? starts->which[i] : i;
    const pendres_bifurcation *b = &starts->all[number];
    if (on_any(known, b, options->second) || on_any(curves, b, options->second)) continue;
    *at = number;
    status = add_curve(ctx, starts->all, number, options, curves);
  }
  return status;
}

static pendres_status curves_extend(pendres_context *ctx, size_t n,
                                    const pendres_bifurcation *bifurcations,
                                    const pendres_curve_options *options, pendres_curves *curves)
{
  if (options == NULL || curves == NULL || (n > 0 && bifurcations == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "bifurcations, options and curves");
  const pendres_curve_starts starts = {.all = bifurcations, .n = n};
  size_t at;
  return pendres_curves_add(ctx, &starts, options, NULL, curves, &at);
}

pendres_status pendres_curves_extend(pendres_context *ctx, size_t n,
                                     const pendres_bifurcation *bifurcations,
                                     const pendres_curve_options *options, pendres_curves *curves)
{
  pendres_door d;
  pendres_door_open(&d, ctx,
                    n > 0 && bifurcations != NULL ? &bifurcations[0].orbit.pendulum : NULL);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, n, bifurcations);
  const pendres_curve_options *o = pendres_curve_options_inside(&d, n, bifurcations, options);
  pendres_curves_enter(&d, curves);
  PENDRES_DOOR_CALL(&d, curves_extend(ctx, n, from, o, curves));
  pendres_curves_leave(&d, curves);
  return pendres_door_close(&d);
}

static pendres_status curves_find(pendres_context *ctx, size_t n,
                                  const pendres_bifurcation *bifurcations,
                                  const pendres_curve_options *options, pendres_curves **out)
{
  if (options == NULL || out == NULL || (n > 0 && bifurcations == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "bifurcations, options and out");
  *out = NULL;
  pendres_curves *set = pendres_curves_create();
  if (set == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for curves");
  const pendres_status status = pendres_curves_extend(ctx, n, bifurcations, options, set);
  if (status == PENDRES_OK)
    *out = set;
  else
    pendres_curves_free(set);
  return status;
}

pendres_status pendres_curves_find(pendres_context *ctx, size_t n,
                                   const pendres_bifurcation *bifurcations,
                                   const pendres_curve_options *options, pendres_curves **out)
{
  return PENDRES_CONTEXT_CALL(ctx, curves_find(ctx, n, bifurcations, options, out));
}

/* ---- in parts ---- */

static int sign(double difference)
{
  return (difference > 0.0) - (difference < 0.0);
}

/* What on_curve() asks for first, without what would tell mirror images or kinds of flips apart. */
int pendres_family_order(const pendres_bifurcation *a, const pendres_bifurcation *b)
{
  const int period = sign((double)b->orbit.period - (double)a->orbit.period);
  const int winding = sign(fabs((double)b->orbit.winding) - fabs((double)a->orbit.winding));
  if (period != 0) return period;
  return winding != 0 ? winding : (a->kind == PENDRES_FOLD) - (b->kind == PENDRES_FOLD);
}

/* The curve of the earliest start, taken out of its set; NULL: there is none before `end`. */
static pendres_curve *take_earliest(size_t n, pendres_curves *const *parts, size_t end)
{
  pendres_curve **first = NULL, *found = NULL;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < parts[i]->count; k++) {
      pendres_curve **c = &parts[i]->curve[k];
      if (*c == NULL || (*c)->start >= end) continue;
      end = (*c)->start;
      first = c;
    }
  if (first == NULL) return NULL;
  found = *first;
  *first = NULL;
  return found;
}

pendres_status pendres_curves_join(size_t n, pendres_curves *const *parts, size_t end,
                                   pendres_curves *to)
{
  for (pendres_curve *c = take_earliest(n, parts, end); c != NULL;
       c = take_earliest(n, parts, end))
    if (!append(to, c)) return PENDRES_OUT_OF_MEMORY;
  return PENDRES_OK;
}
