/* sets.c -- the branches and curves that many orbits and bifurcations lie on, each once; see
   continuation.h and sets.h. */
#include "continuation/sets.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "continuation/branch.h"
#include "continuation/numbers.h"
#include "continuation/units.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "orbits/orbit_same.h"

/* ---- sets ---- */

pendres_curves *pendres_curves_create(void)
{
  return calloc(1, sizeof(pendres_branches));
}

void pendres_curves_free(pendres_curves *set)
{
  if (set == NULL) return;
  for (size_t i = 0; i < set->count; i++) pendres_curve_free(set->curve[i]);
  free(set->curve);
  free(set);
}

size_t pendres_curves_count(const pendres_curves *set)
{
  return set != NULL ? set->count : 0;
}

const pendres_curve *pendres_curves_get(const pendres_curves *set, size_t i)
{
  return set != NULL && i < set->count ? set->curve[i] : NULL;
}

void pendres_branches_free(pendres_branches *b)
{
  if (b != NULL) pendres_curves_free(&b->set);
}

size_t pendres_branches_count(const pendres_branches *b)
{
  return b != NULL ? b->set.count : 0;
}

const pendres_branch *pendres_branches_get(const pendres_branches *b, size_t i)
{
  return b != NULL && i < b->set.count ? pendres_branch_of(b->set.curve[i]) : NULL;
}

size_t pendres_branches_skipped(const pendres_branches *b)
{
  return b != NULL ? b->set.skipped : 0;
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

static pendres_status no_memory(pendres_context *ctx)
{
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for branches or curves");
}

static double mixed(double a, double b, double part)
{
  return a + part * (b - a);
}

/* Whether orbits have one winding, or windings of each other's mirror images. */
static int same_winding(const pendres_orbit *a, const pendres_orbit *b)
{
  return a->winding == b->winding || (a->winding == -b->winding &&
                                      pendres_pendulum_symmetric(&a->pendulum) &&
                                      pendres_pendulum_symmetric(&b->pendulum));
}

/* ---- branches ---- */

/* Whether an orbit has the measures of a chord's point with its parameter. */
static int fits_chord(const pendres_orbit *a, const pendres_orbit *b, double part,
                      const pendres_orbit *o)
{
  if (a->symmetric != o->symmetric && b->symmetric != o->symmetric) return 0;
  if (fabs(mixed(a->amplitude, b->amplitude, part) - o->amplitude) > curve_alike) return 0;
  if (fabs(mixed(a->loop_area, b->loop_area, part) - o->loop_area) > curve_alike) return 0;
  return !(fabs(mixed(a->phase_lag, b->phase_lag, part) - o->phase_lag) > curve_alike);
}

static int lies_on(const pendres_curve *b, const pendres_orbit *o)
{
  const double value = pendres_parameter_get(pendres_curve_parameter(b, 0), &o->pendulum);
  const pendres_orbit *first = &b->branch_point[0].orbit;
  if (first->period != o->period || !same_winding(first, o)) return 0;
  for (size_t i = 0; i + 1 < b->count; i++) {
    const double from = pendres_branch_value(b, i) - value;
    const double to = pendres_branch_value(b, i + 1) - value;
    if (from * to > 0.0) continue;
    const double part = from != to ? from / (from - to) : 0.0;
    if (fits_chord(&b->branch_point[i].orbit, &b->branch_point[i + 1].orbit, part, o)) return 1;
  }
  return 0;
}

/* Close to a fold the chords miss their branch: the orbits there are compared themselves. */
static pendres_status really_lies_on(pendres_context *ctx, pendres_curve *b,
                                     const pendres_orbit *o, int *on)
{
  enum { MOST = 16 };
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_orbit *there = pendres_room_take(&room, MOST, sizeof *there);
  size_t found = 0;
  *on = 0;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  const double value = pendres_parameter_get(pendres_curve_parameter(b, 0), &o->pendulum);
  const pendres_status status =
    pendres_branch_cross(ctx, pendres_branch_of(b), value, MOST, there, &found);
  for (size_t i = 0; i < found && i < MOST && status == PENDRES_OK; i++) {
    if (there[i].period == o->period && same_winding(&there[i], o) &&
        pendres_orbit_as_wide(&there[i], o) &&
        fabs(there[i].loop_area - o->loop_area) <
          orbit_same_point +
            pendres_several_errors * (o->loop_area_error + there[i].loop_area_error))
      *on = 1;
  }
  return pendres_room_close(&room, status);
}

static pendres_status known(pendres_context *ctx, const pendres_curves *set,
                            const pendres_orbit *o, int *yes)
{
  pendres_status status = PENDRES_OK;
  *yes = 0;
  for (size_t i = 0; i < set->count && !*yes; i++) *yes = lies_on(set->curve[i], o);
  for (size_t i = 0; i < set->count && !*yes && status == PENDRES_OK; i++)
    status = really_lies_on(ctx, set->curve[i], o, yes);
  return status;
}

static pendres_status add_branch(pendres_context *ctx, pendres_curves *set,
                                 const pendres_orbit *o, const pendres_branch_options *options)
{
  pendres_branch *b = NULL;
  const pendres_status status = pendres_branch_follow(ctx, o, options, &b);
  set->skipped += status == PENDRES_NOT_CONVERGED;
  if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  return append(set, &b->curve) ? PENDRES_OK : no_memory(ctx);
}

static pendres_status branches_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                    const pendres_branch_options *options, pendres_branches **out)
{
  if (options == NULL || out == NULL || (n > 0 && orbits == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "orbits, options and out");
  *out = NULL;
  const char *why = pendres_branch_refuses(options, n, orbits);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branches: %s", why);
  pendres_status status = PENDRES_OK;
  pendres_curves *set = pendres_curves_create();
  if (set == NULL) return no_memory(ctx);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    int yes = 0;
    const double value = pendres_parameter_get(options->parameter, &orbits[i].pendulum);
    if (value < options->low || value > options->high) continue;
    status = known(ctx, set, &orbits[i], &yes);
    if (status == PENDRES_OK && !yes) status = add_branch(ctx, set, &orbits[i], options);
  }
  if (status == PENDRES_OK) *out = pendres_branches_of(set);
  else pendres_curves_free(set);
  return status;
}

pendres_status pendres_branches_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     const pendres_branch_options *options, pendres_branches **out)
{
  pendres_door d = pendres_branch_open(ctx, n > 0 && orbits != NULL ? &orbits[0].pendulum : NULL,
                                       options);
  PENDRES_DOOR_IN(&d, orbit, n, orbits);
  PENDRES_DOOR_IN(&d, branch_options, 1, options);
  PENDRES_DOOR_CALL(&d, branches_find(ctx, n, orbits, options, out));
  if (d.status == PENDRES_OK) pendres_curves_leave(&d, pendres_branches_set(*out));
  return pendres_door_close(&d);
}

/* Two locations of one bifurcation, mirror images included. Two that lie as close and differ are of
   opposite curvature: where two branches part or where they meet in a cusp. */
static int same_bifurcation(const pendres_bifurcation *a, const pendres_bifurcation *b)
{
  const double e = curve_untold + pendres_several_errors * (a->value_error + b->value_error);
  return a->kind == b->kind && a->orbit.period == b->orbit.period &&
         same_winding(&a->orbit, &b->orbit) && !(a->curvature * b->curvature < 0.0) &&
         fabs(a->value - b->value) < e && pendres_orbit_as_wide(&a->orbit, &b->orbit);
}

static int met_already(const pendres_curves *set, const pendres_bifurcation *b)
{
  for (size_t i = 0; i < set->count; i++)
    for (size_t k = 0; k < set->curve[i]->specials; k++)
      if (same_bifurcation(&set->curve[i]->bifurcation[k], b)) return 1;
  return 0;
}

static pendres_status branches_extend(pendres_context *ctx, size_t n,
                                      const pendres_bifurcation *bifurcations,
                                      const pendres_branch_options *options,
                                      pendres_branches *branches)
{
  if (options == NULL || branches == NULL || (n > 0 && bifurcations == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "bifurcations, options and branches");
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_bifurcation *b = &bifurcations[i];
    if (b->value < options->low || b->value > options->high || met_already(&branches->set, b))
      continue;
    status = add_branch(ctx, &branches->set, &b->orbit, options);
  }
  return status;
}

pendres_status pendres_branches_extend(pendres_context *ctx, size_t n,
                                       const pendres_bifurcation *bifurcations,
                                       const pendres_branch_options *options,
                                       pendres_branches *branches)
{
  pendres_door d = pendres_branch_open(
    ctx, n > 0 && bifurcations != NULL ? &bifurcations[0].orbit.pendulum : NULL, options);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, n, bifurcations);
  PENDRES_DOOR_IN(&d, branch_options, 1, options);
  pendres_curves_enter(&d, pendres_branches_set(branches));
  PENDRES_DOOR_CALL(&d, branches_extend(ctx, n, from, options, branches));
  pendres_curves_leave(&d, pendres_branches_set(branches));
  return pendres_door_close(&d);
}

/* ---- curves ---- */

static int on_curve(const pendres_curve *c, const pendres_bifurcation *b, pendres_parameter second)
{
  const double value = pendres_parameter_get(second, &b->orbit.pendulum);
  const pendres_curve_point *p = pendres_curve_get(c, 0);
  if (pendres_curve_kind_get(c) != b->kind || p->orbit.period != b->orbit.period ||
      !same_winding(&p->orbit, &b->orbit))
    return 0;
  for (size_t i = 0; i + 1 < pendres_curve_count(c); i++) {
    const pendres_curve_point *q = pendres_curve_get(c, i + 1);
    p = pendres_curve_get(c, i);
    const double from = p->value[1] - value, to = q->value[1] - value;
    const double part = from * to <= 0.0 && from != to ? from / (from - to) : 0.0;
    /* At a cusp or a turning point the value may lie just beyond the points. */
    if (from * to > 0.0 && fmin(fabs(from), fabs(to)) > just_beyond) continue;
    if (fabs(mixed(p->value[0], q->value[0], part) - b->value) < curve_alike &&
        fabs(mixed(p->orbit.amplitude, q->orbit.amplitude, part) - b->orbit.amplitude) <
          curve_alike + fabs(p->orbit.amplitude - q->orbit.amplitude))
      return 1;
  }
  return 0;
}

/* The curve of bifurcation `number` of those. */
static pendres_status add_curve(pendres_context *ctx, const pendres_bifurcation *all, size_t number,
                                const pendres_curve_options *options, pendres_curves *set)
{
  pendres_curve *c = NULL;
  const pendres_status status = pendres_curve_follow(ctx, &all[number], options, &c);
  if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  /* Nothing can be followed from a bifurcation among wild orbits: it stays a single point. */
  if (pendres_curve_count(c) < 3) {
    pendres_curve_free(c);
    return PENDRES_OK;
  }
  c->start = number;
  return append(set, c) ? PENDRES_OK : no_memory(ctx);
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

static pendres_status curves_find(pendres_context *ctx, size_t n,
                                  const pendres_bifurcation *bifurcations,
                                  const pendres_curve_options *options, pendres_curves **out)
{
  size_t at;
  if (options == NULL || out == NULL || (n > 0 && bifurcations == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "bifurcations, options and out");
  const pendres_curve_starts starts = {.all = bifurcations, .n = n};
  *out = pendres_curves_create();
  if (*out == NULL) return no_memory(ctx);
  const pendres_status status = pendres_curves_add(ctx, &starts, options, NULL, *out, &at);
  if (status == PENDRES_OK) return status;
  pendres_curves_free(*out);
  *out = NULL;
  return status;
}

pendres_status pendres_curves_find(pendres_context *ctx, size_t n,
                                   const pendres_bifurcation *bifurcations,
                                   const pendres_curve_options *options, pendres_curves **out)
{
  pendres_door d = pendres_door_open(
    ctx, n > 0 && bifurcations != NULL ? &bifurcations[0].orbit.pendulum : NULL);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, n, bifurcations);
  const pendres_curve_options *o = pendres_curve_options_inside(&d, n, bifurcations, options);
  PENDRES_DOOR_CALL(&d, curves_find(ctx, n, from, o, out));
  if (d.status == PENDRES_OK) pendres_curves_leave(&d, *out);
  return pendres_door_close(&d);
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
