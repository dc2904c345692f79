/* collect.c -- the branches that many orbits lie on; see continuation.h. */
#include <pendres/continuation.h>

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "engine/context_internal.h"
#include "continuation/units.h"
#include "continuation/alike.h"
#include "continuation/branch.h"

void pendres_branches_free(pendres_branches *b)
{
  if (b == NULL) return;
  for (size_t i = 0; i < b->count; i++) pendres_branch_free(b->branch[i]);
  free(b->branch);
  free(b);
}

size_t pendres_branches_count(const pendres_branches *b)
{
  return b != NULL ? b->count : 0;
}

const pendres_branch *pendres_branches_get(const pendres_branches *b, size_t i)
{
  return b != NULL && i < b->count ? b->branch[i] : NULL;
}

size_t pendres_branches_skipped(const pendres_branches *b)
{
  return b != NULL ? b->skipped : 0;
}

/* ---- branches ---- */

/* Whether an orbit has the measures of a chord's point with its parameter. */
static int fits_chord(const pendres_orbit *a, const pendres_orbit *b, double part,
                      const pendres_orbit *o)
{
  if (a->symmetric != o->symmetric && b->symmetric != o->symmetric) return 0;
  if (fabs(mixed(a->amplitude, b->amplitude, part) - o->amplitude) > alike) return 0;
  if (fabs(mixed(a->loop_area, b->loop_area, part) - o->loop_area) > alike) return 0;
  return !(fabs(mixed(a->phase_lag, b->phase_lag, part) - o->phase_lag) > alike);
}

static int lies_on(const pendres_branch *b, const pendres_orbit *o)
{
  const double value = pendres_parameter_get(b->parameter, &o->pendulum);
  const pendres_orbit *first = &b->point[0].orbit;
  if (first->period != o->period || !same_winding(first, o)) return 0;
  for (size_t i = 0; i + 1 < b->count; i++) {
    const double from = pendres_branch_value(b, i) - value;
    const double to = pendres_branch_value(b, i + 1) - value;
    if (from * to > 0.0) continue;
    const double part = from != to ? from / (from - to) : 0.0;
    if (fits_chord(&b->point[i].orbit, &b->point[i + 1].orbit, part, o)) return 1;
  }
  return 0;
}

/* Close to a fold the chords miss their branch: the orbits there are compared themselves. */
static pendres_status really_lies_on(pendres_context *ctx, const pendres_branch *b,
                                     const pendres_orbit *o, int *on)
{
  enum { MOST = 16 };
  pendres_orbit *there = malloc(MOST * sizeof *there);
  size_t found = 0;
  *on = 0;
  if (there == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for orbits");
  const double value = pendres_parameter_get(b->parameter, &o->pendulum);
  const pendres_status status = pendres_branch_cross(ctx, b, value, MOST, there, &found);
  for (size_t i = 0; i < found && i < MOST && status == PENDRES_OK; i++) {
    const double e = 1e-5 + 10.0 * (o->x_error + there[i].x_error);
    if (there[i].period == o->period && same_winding(&there[i], o) &&
        fabs(there[i].amplitude - o->amplitude) < e &&
        fabs(there[i].loop_area - o->loop_area) < e)
      *on = 1;
  }
  free(there);
  return status;
}

static pendres_status known(pendres_context *ctx, const pendres_branches *set,
                            const pendres_orbit *o, int *yes)
{
  pendres_status status = PENDRES_OK;
  *yes = 0;
  for (size_t i = 0; i < set->count && !*yes; i++) *yes = lies_on(set->branch[i], o);
  for (size_t i = 0; i < set->count && !*yes && status == PENDRES_OK; i++)
    status = really_lies_on(ctx, set->branch[i], o, yes);
  return status;
}

static pendres_status add_branch(pendres_context *ctx, pendres_branches *set,
                                 const pendres_orbit *o, const pendres_branch_options *options)
{
  pendres_branch *b = NULL;
  pendres_status status = pendres_branch_follow(ctx, 1, o, options, &b);
  if (status == PENDRES_NOT_CONVERGED) {
    set->skipped++;
    return PENDRES_OK;
  }
  if (status != PENDRES_OK) return status;
  pendres_branch **grown = pendres_grow(set->branch, set->count, &set->capacity, sizeof *grown);
  if (grown == NULL) {
    pendres_branch_free(b);
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for branches");
  }
  set->branch = grown;
  set->branch[set->count++] = b;
  return PENDRES_OK;
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
  pendres_branches *set = calloc(1, sizeof *set);
  if (set == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for branches");
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    int yes = 0;
    const double value = pendres_parameter_get(options->parameter, &orbits[i].pendulum);
    if (value < options->low || value > options->high) continue;
    status = known(ctx, set, &orbits[i], &yes);
    if (status == PENDRES_OK && !yes) status = add_branch(ctx, set, &orbits[i], options);
  }
  if (status == PENDRES_OK) {
    *out = set;
    set = NULL;
  }
  pendres_branches_free(set);
  return status;
}

/* The door for branches of a pendulum. */
static void open_door(pendres_door *d, pendres_context *ctx, const pendres_pendulum *p,
                      const pendres_branch_options *options)
{
  if (options == NULL || p == NULL) {
    pendres_door_open(d, ctx, p);
    return;
  }
  const double ends[2] = {options->low, options->high};
  pendres_door_open_along(d, ctx, p, options->parameter, 2, ends);
}

pendres_status pendres_branches_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     const pendres_branch_options *options, pendres_branches **out)
{
  pendres_door d;
  open_door(&d, ctx, n > 0 && orbits != NULL ? &orbits[0].pendulum : NULL, options);
  const pendres_orbit *from = pendres_door_in(&d, &pendres_dim_orbit, n, orbits);
  const pendres_branch_options *o = pendres_door_in(&d, &pendres_dim_branch_options, 1, options);
  PENDRES_DOOR_CALL(&d, branches_find(ctx, n, from, o, out));
  if (d.status == PENDRES_OK) pendres_branches_leave(&d, *out);
  return pendres_door_close(&d);
}

/* Two locations of one bifurcation, mirror images included. Two that lie as close and differ are of
   opposite curvature: where two branches part or where they meet in a cusp. */
static int same_bifurcation(const pendres_bifurcation *a, const pendres_bifurcation *b)
{
  const double e = 1e-6 + 10.0 * (a->value_error + b->value_error);
  const double apart = 1e-5 + 10.0 * (a->orbit.amplitude_error + b->orbit.amplitude_error);
  return a->kind == b->kind && a->orbit.period == b->orbit.period &&
         same_winding(&a->orbit, &b->orbit) && !(a->curvature * b->curvature < 0.0) &&
         fabs(a->value - b->value) < e && fabs(a->orbit.amplitude - b->orbit.amplitude) < apart;
}

static int met_already(const pendres_branches *set, const pendres_bifurcation *b)
{
  for (size_t i = 0; i < set->count; i++)
    for (size_t k = 0; k < set->branch[i]->bifurcations; k++)
      if (same_bifurcation(&set->branch[i]->bifurcation[k], b)) return 1;
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
    if (b->value < options->low || b->value > options->high || met_already(branches, b)) continue;
    status = add_branch(ctx, branches, &b->orbit, options);
  }
  return status;
}

pendres_status pendres_branches_extend(pendres_context *ctx, size_t n,
                                       const pendres_bifurcation *bifurcations,
                                       const pendres_branch_options *options,
                                       pendres_branches *branches)
{
  pendres_door d;
  open_door(&d, ctx, n > 0 && bifurcations != NULL ? &bifurcations[0].orbit.pendulum : NULL,
            options);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, n, bifurcations);
  const pendres_branch_options *o = pendres_door_in(&d, &pendres_dim_branch_options, 1, options);
  pendres_branches_enter(&d, branches);
  PENDRES_DOOR_CALL(&d, branches_extend(ctx, n, from, o, branches));
  pendres_branches_leave(&d, branches);
  return pendres_door_close(&d);
}
