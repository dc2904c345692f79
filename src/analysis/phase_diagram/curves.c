/* curves.c -- curves through the bifurcations of a diagram's lines; see phase_diagram.h. */
#include "analysis/phase_diagram/internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "engine/context_internal.h"
#include "continuation/sets.h"
#include "continuation/units.h"
#include "analysis/phase_diagram/line.h"
#include "base/numbers.h"

/* What was followed of a family. */
static void free_family(pendres_phase_family *f)
{
  pendres_curves_free(f->curves);
  f->curves = NULL;
  pendres_phase_mark_free(&f->mark);
}

static void free_families(pendres_phase_diagram *d)
{
  for (size_t i = 0; i < d->families; i++) free_family(&d->family[i]);
  free(d->family);
  d->family = NULL;
  d->families = d->families_taken = 0;
}

void pendres_phase_curves_free(pendres_phase_diagram *d)
{
  free_families(d);
  free(d->bifurcation);
  pendres_phase_mark_free(&d->curves_mark);
  pendres_curves_free(d->curves);
}

/* ---- bifurcations and their families ---- */

/* The bifurcations of all lines. */
static pendres_status gather(pendres_phase_diagram *d)
{
  size_t n = 0;
  for (size_t i = 0; i < d->grid.lines; i++)
    for (size_t k = 0; k < pendres_branches_count(d->line[i].branches); k++)
      n += pendres_branch_bifurcation_count(pendres_branches_get(d->line[i].branches, k));
  pendres_bifurcation *all = malloc((n + 1) * sizeof *all);
  if (all == NULL) return PENDRES_OUT_OF_MEMORY;
  free(d->bifurcation);
  d->bifurcation = all;
  n = 0;
  d->falling = 0;
  for (size_t i = 0; i < d->grid.lines; i++) {
    d->first[i] = n;
    d->falling |= pendres_phase_small_end(d->line[i].branches).falling;
    for (size_t k = 0; k < pendres_branches_count(d->line[i].branches); k++) {
      const pendres_branch *b = pendres_branches_get(d->line[i].branches, k);
      for (size_t m = 0; m < pendres_branch_bifurcation_count(b); m++)
        all[n++] = *pendres_branch_bifurcation_get(b, m);
    }
  }
  d->first[d->grid.lines] = d->bifurcations = n;
  return PENDRES_OK;
}

/* Put the family of bifurcation i into its place among those that are known, if it is new. Families
   that cost more come first, so that threads end at about the same time. */
static pendres_status note_family(pendres_phase_diagram *d, size_t i, size_t *capacity)
{
  size_t place = 0;
  int order = 1;
  while (place < d->families) {
    order = pendres_family_order(&d->bifurcation[i], &d->bifurcation[d->family[place].first]);
    if (order == 0) return PENDRES_OK;
    if (order < 0) break;
    place++;
  }
  pendres_phase_family *grown =
    pendres_grow(d->family, d->families, capacity, sizeof *grown);
  if (grown == NULL) return PENDRES_OUT_OF_MEMORY;
  d->family = grown;
  memmove(grown + place + 1, grown + place, (d->families - place) * sizeof *grown);
  grown[place] = (pendres_phase_family){.first = i};
  d->families++;
  return PENDRES_OK;
}

pendres_status pendres_phase_find_families(pendres_phase_diagram *d, size_t *families)
{
  *families = 0;
  const size_t before = d->bifurcations;
  size_t capacity = 0;
  free_families(d);
  pendres_status status = gather(d);
  if (status != PENDRES_OK || d->bifurcations <= before || d->rounds == TRIES) return status;
  if (d->curves == NULL) d->curves = pendres_curves_create();
  if (d->curves == NULL) return PENDRES_OUT_OF_MEMORY;
  d->rounds++;
  for (size_t i = 0; i < d->bifurcations && status == PENDRES_OK; i++)
    status = note_family(d, i, &capacity);
  if (status == PENDRES_OK) *families = d->families;
  else free_families(d);
  return status;
}

/* ---- a family ---- */

static void pass(pendres_bytes *b, pendres_phase_family *f)
{
  pendres_bytes_pass(b, 1, sizeof f->end, &f->end);
  pendres_phase_mark_pass(b, &f->mark);
  pendres_curves_pass(b, 0, &f->curves);
}

/* How far curves are followed, behind the door. */
static pendres_curve_options options_of(const pendres_phase_grid *g, const pendres_scales *s)
{
  pendres_curve_options options = {.second = g->across};
  const int plain = pendres_phase_plain(&g->pendulum, g->options.parameter) &&
                    pendres_phase_plain(&g->pendulum, g->across);
  pendres_phase_reach(g->options.parameter, plain, g->value[0] / s->first,
                      g->value[g->values - 1] / s->first, &options.low[0], &options.high[0]);
  pendres_phase_reach(g->across, plain, g->line_value[0] / s->second,
                      g->line_value[g->lines - 1] / s->second, &options.low[1], &options.high[1]);
  return options;
}

/* Follow the curves of a family. A failure that is its own is marked, and what was found before it
   stays. */
static pendres_status follow(pendres_door *door, const pendres_phase_diagram *d, size_t family,
                             pendres_phase_family *f)
{
  pendres_context *ctx = door->ctx;
  const pendres_bifurcation *first = &d->bifurcation[d->family[family].first];
  const pendres_bifurcation *all = pendres_bifurcations_inside(door, d->bifurcations,
                                                               d->bifurcation);
  const pendres_curves *known = pendres_curves_inside(door, d->curves);
  pendres_door_move(door, d->grid.options.parameter, d->grid.across);
  const pendres_curve_options options = options_of(&d->grid, &door->scales);
  if (door->status != PENDRES_OK) return door->status;
  size_t *which = malloc(d->bifurcations * sizeof *which), n = 0;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  f->curves = pendres_curves_create();
  if (which == NULL || f->curves == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for curves");
  } else {
    for (size_t i = 0; i < d->bifurcations; i++)
      if (pendres_family_order(&d->bifurcation[i], first) == 0) which[n++] = i;
    const pendres_curve_starts starts = {.all = all, .n = n, .which = which};
    status = pendres_curves_add(ctx, &starts, &options, known, f->curves, &f->end);
    if (pendres_phase_is_own(status))
      status = pendres_phase_mark_set(&f->mark, status, pendres_context_message(ctx));
  }
  free(which);
  pendres_curves_leave(door, f->curves);
  return status;
}

pendres_status pendres_phase_follow_family(pendres_context *ctx, const pendres_phase_diagram *d,
                                           size_t family, pendres_bytes *out)
{
  pendres_phase_family f = {.curves = NULL};
  const pendres_bifurcation *first = &d->bifurcation[d->family[family].first];
  pendres_door door = pendres_door_open(ctx, &first->orbit.pendulum);
  PENDRES_DOOR_CALL(&door, follow(&door, d, family, &f));
  pendres_status status = pendres_door_close(&door);
  if (status == PENDRES_OK) pass(out, &f);
  free_family(&f);
  return status;
}

/* ---- all of them ---- */

/* Find the last one of the cusps of SA and LA, on the way out of the region where both exist. */
static void find_cusp(pendres_phase_diagram *d)
{
  for (size_t i = 0; i < pendres_curves_count(d->curves); i++) {
    const pendres_curve *curve = pendres_curves_get(d->curves, i);
    for (size_t k = 0; k < pendres_curve_cusp_count(curve); k++) {
      const pendres_cusp *cusp = pendres_curve_cusp_get(curve, k);
      if (!pendres_phase_on_sheets(&cusp->orbit)) continue;
      if (d->has_cusp && pendres_phase_beyond(d->grid.across, d->cusp.value[1], cusp->value[1]))
        continue;
      d->cusp = *cusp;
      d->has_cusp = 1;
    }
  }
}

/* Join the curves of all families in the order of their bifurcations, up to the first one that
   failed: what comes after it is left out, as if bifurcations were followed one after another. That
   there may be more is marked once. */
static pendres_status join(pendres_phase_diagram *d)
{
  const pendres_phase_mark *mark = NULL;
  size_t end = d->bifurcations;
  pendres_curves **part = malloc(d->families * sizeof *part);
  if (part == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < d->families; i++) {
    const pendres_phase_family *f = &d->family[i];
    part[i] = f->curves;
    if (f->mark.outcome == PENDRES_OK || f->end >= end) continue;
    end = f->end;
    mark = &f->mark;
  }
  pendres_status status = pendres_curves_join(d->families, part, end, d->curves);
  free(part);
  if (status == PENDRES_OK && mark != NULL && d->curves_mark.outcome == PENDRES_OK)
    status = pendres_phase_mark_set(&d->curves_mark, mark->outcome, mark->message);
  find_cusp(d);
  free_families(d);
  return status;
}

pendres_status pendres_phase_take_family(pendres_phase_diagram *d, size_t family, size_t size,
                                         const void *bytes)
{
  pendres_phase_family *f = &d->family[family];
  pendres_bytes b = pendres_bytes_read(size, bytes);
  if (f->curves != NULL) return PENDRES_INVALID_ARGUMENT;
  pass(&b, f);
  if (!pendres_bytes_end(&b)) {
    free_family(f);
    return b.status;
  }
  return ++d->families_taken == d->families ? join(d) : PENDRES_OK;
}
