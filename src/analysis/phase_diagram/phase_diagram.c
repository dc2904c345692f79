/* phase_diagram.c -- whole phase diagrams: lines and curves; see phase_diagram.h. */
#include "analysis/phase_diagram/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/context_internal.h"
#include "model/parameter.h"
#include "analysis/phase_diagram/line.h"
#include "base/sized.h"

/* ---- diagrams and marks ---- */

static int ascends(size_t n, const double *value)
{
  for (size_t i = 1; i < n; i++)
    if (!(value[i] > value[i - 1])) return 0;
  return 1;
}

/* NULL, or what is wrong with a grid. What is wrong with a single point is found when it is
   computed. */
static const char *refused(const pendres_phase_grid *g)
{
  if (PENDRES_SIZED_REFUSES(&g->options) != NULL) return PENDRES_SIZED_REFUSES(&g->options);
  const pendres_parameter along = g->options.parameter;
  if (pendres_parameter_refuses(along, g->pendulum.force) != NULL)
    return "lines go along a parameter";
  if (pendres_parameter_refuses(g->across, g->pendulum.force) != NULL || g->across == along)
    return "lines differ in another parameter than changes along them";
  if (g->values == 0 || g->lines == 0 || g->value == NULL || g->line_value == NULL)
    return "a diagram needs values of both its parameters";
  if (g->lines > (size_t)-1 / 1024 / g->values) return "a diagram has too many points";
  return ascends(g->values, g->value) && ascends(g->lines, g->line_value)
           ? NULL
           : "the values of a diagram's parameters must ascend";
}

void pendres_phase_diagram_free(pendres_phase_diagram *d)
{
  if (d == NULL) return;
  for (size_t i = 0; d->line != NULL &&
       i < d->grid.lines; i++) pendres_phase_done_free(&d->line[i]);
  free(d->line);
  free(d->first);
  pendres_phase_curves_free(d);
  free(d);
}

pendres_status pendres_phase_diagram_create(const pendres_phase_grid *grid,
                                            pendres_phase_diagram **out)
{
  if (out != NULL) *out = NULL;
  if (grid == NULL || out == NULL || refused(grid) != NULL) return PENDRES_INVALID_ARGUMENT;
  pendres_phase_diagram *d = calloc(1, sizeof *d);
  if (d == NULL) return PENDRES_OUT_OF_MEMORY;
  d->grid = *grid;
  d->nothing = (pendres_phase_point){
    .regime = PENDRES_REGIME_OTHER, .exact = PENDRES_REGIME_OTHER,
    .other = PENDRES_OTHER_UNRESOLVED, .unresolved = grid->options.ensemble.members,
    .sa_fraction = NAN, .sa_fraction_error = NAN, .la_fraction = NAN, .la_fraction_error = NAN,
    .mean_loop_area = NAN, .mean_loop_area_error = NAN, .mean_loop_amplitude = NAN,
    .mean_loop_amplitude_error = NAN, .sa_amplitude = NAN, .sa_amplitude_error = NAN,
    .la_amplitude = NAN, .la_amplitude_error = NAN, .weakest_multiplier = NAN};
  d->line = calloc(grid->lines, sizeof *d->line);
  d->first = calloc(grid->lines + 1, sizeof *d->first);
  pendres_status status =
    d->line == NULL || d->first == NULL ? PENDRES_OUT_OF_MEMORY : PENDRES_OK;
  for (size_t i = 0; i < grid->lines && status == PENDRES_OK; i++)
    status = pendres_phase_done_create(grid->values, &d->line[i]);
  if (status != PENDRES_OK) pendres_phase_diagram_free(d);
  else *out = d;
  return status;
}

pendres_status pendres_phase_diagram_leave_out(pendres_phase_diagram *d, size_t point)
{
  if (d == NULL || point >= d->grid.lines * d->grid.values) return PENDRES_INVALID_ARGUMENT;
  d->line[point / d->grid.values].mark[point % d->grid.values].outcome = PENDRES_UNSUPPORTED;
  return PENDRES_OK;
}

int pendres_phase_is_own(pendres_status status)
{
  switch (status) {
  case PENDRES_INVALID_ARGUMENT:
  case PENDRES_INTEGRATION_FAILED:
  case PENDRES_TOLERANCE_UNREACHABLE:
  case PENDRES_NOT_CONVERGED:
  case PENDRES_NOT_FOUND:
  case PENDRES_UNRESOLVED: return 1;
  default: return 0;
  }
}

/* Keep a failure that concerns one point or line, with the context's message on it; return any
   other. */
static pendres_status keep(const pendres_context *ctx, pendres_status status,
                           pendres_phase_mark *m)
{
  if (!pendres_phase_is_own(status)) return status;
  return pendres_phase_mark_set(m, status, pendres_context_message(ctx));
}

/* ---- a line ---- */

static pendres_pendulum pendulum_of(const pendres_phase_grid *g, size_t line, size_t k)
{
  pendres_pendulum p = g->pendulum;
  pendres_parameter_set(g->across, g->line_value[line], &p);
  pendres_parameter_set(g->options.parameter, g->value[k], &p);
  return p;
}

static pendres_status try_line(pendres_context *ctx, const pendres_phase_grid *g, size_t line,
                               pendres_phase_done *l)
{
  pendres_pendulum *p = malloc((g->values + 1) * sizeof *p);
  pendres_branches_free(l->branches);
  l->branches = NULL;
  if (p == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for pendulums");
  for (size_t k = 0; k < g->values; k++)
    if (l->place[k] != PENDRES_PHASE_NOWHERE) p[l->place[k]] = pendulum_of(g, line, k);
  const pendres_status status =
    pendres_phase_line(ctx, l->count, p, &g->options, l->points, &l->branches);
  free(p);
  return status;
}

/* Find out which of a line's points can be computed at all, and mark the others. That is costly,
   and done only where a line has failed. */
static pendres_status sort_out(pendres_context *ctx, const pendres_phase_grid *g, size_t line,
                               pendres_phase_done *l)
{
  l->count = 0;
  for (size_t k = 0; k < g->values; k++) {
    if (l->place[k] == PENDRES_PHASE_NOWHERE) continue;
    const pendres_pendulum p = pendulum_of(g, line, k);
    pendres_response r;
    const pendres_status status = pendres_response_find(ctx, 1, &p, &g->options.ensemble, &r);
    l->place[k] = status == PENDRES_OK ? l->count++ : PENDRES_PHASE_NOWHERE;
    const pendres_status rest = keep(ctx, status, &l->mark[k]);
    if (rest != PENDRES_OK) return rest;
  }
  return PENDRES_OK;
}

/* Mark all points of a line that have results, which they keep. */
static pendres_status mark_line(pendres_context *ctx, pendres_status status, pendres_phase_done *l)
{
  pendres_status rest = status;
  for (size_t k = 0; k < l->values; k++)
    if (l->place[k] != PENDRES_PHASE_NOWHERE) rest = keep(ctx, status, &l->mark[k]);
  return rest;
}

static pendres_status fill_line(pendres_context *ctx, const pendres_phase_grid *g, size_t line,
                                pendres_phase_done *l)
{
  l->count = 0;
  for (size_t k = 0; k < l->values; k++)
    l->place[k] = l->mark[k].outcome == PENDRES_OK ? l->count++ : PENDRES_PHASE_NOWHERE;
  pendres_status status = try_line(ctx, g, line, l);
  if (!pendres_phase_is_own(status)) return status;
  status = sort_out(ctx, g, line, l);
  if (status != PENDRES_OK) return status;
  status = try_line(ctx, g, line, l);
  if (!pendres_phase_is_own(status)) return status;
  status = mark_line(ctx, status, l);
  for (size_t k = 0; k < l->values; k++) l->place[k] = PENDRES_PHASE_NOWHERE;
  l->count = 0;
  return status;
}

/* Complete a line by the curves; where that fails its points stay as they were. */
static pendres_status complete(pendres_context *ctx, const pendres_phase_diagram *d,
                               const pendres_phase_done *before, pendres_phase_done *l)
{
  if (l->count == 0) return PENDRES_OK;
  const pendres_status status = pendres_phase_line_complete(
    ctx, l->count, d->curves, &d->grid.options, l->points, l->branches);
  if (!pendres_phase_is_own(status)) return status;
  memcpy(l->points, before->points, l->count * sizeof *l->points);
  return mark_line(ctx, status, l);
}

/* What is made of a line: computed from nothing, or completed by the curves. */
static pendres_status make_line(pendres_context *ctx, const pendres_phase_diagram *d, size_t line,
                                pendres_bytes *out)
{
  pendres_phase_done l = {.values = 0};
  pendres_bytes before = {.bytes = NULL};
  pendres_phase_done_pass(&before, &d->line[line]);
  pendres_bytes copy = pendres_bytes_read(before.size, before.bytes);
  pendres_status status = before.status;
  if (status == PENDRES_OK) status = pendres_phase_done_read(d->grid.values, &copy, &l);
  free(before.bytes);
  if (status == PENDRES_OK)
    status = d->round.work == PENDRES_PHASE_COMPLETION ? complete(ctx, d, &d->line[line], &l)
                                                       : fill_line(ctx, &d->grid, line, &l);
  if (status == PENDRES_OK) pendres_phase_done_pass(out, &l);
  pendres_phase_done_free(&l);
  return status;
}

static pendres_status take_line(pendres_phase_diagram *d, size_t line, size_t size,
                                const void *bytes)
{
  pendres_phase_done l;
  pendres_bytes b = pendres_bytes_read(size, bytes);
  const pendres_status status = pendres_phase_done_read(d->grid.values, &b, &l);
  if (status != PENDRES_OK) return status;
  pendres_phase_done_free(&d->line[line]);
  d->line[line] = l;
  return PENDRES_OK;
}

/* ---- rounds ---- */

/* Lines, then alternately curves and the completion of lines by them. */
pendres_status pendres_phase_diagram_next(pendres_phase_diagram *d, pendres_phase_round *round)
{
  const pendres_phase_round none = {PENDRES_PHASE_DONE, 0};
  if (round != NULL) *round = none;
  if (d == NULL || round == NULL || d->families > 0) return PENDRES_INVALID_ARGUMENT;
  pendres_phase_round next = none;
  pendres_status status = PENDRES_OK;
  if (!d->begun) {
    next = (pendres_phase_round){PENDRES_PHASE_LINES, d->grid.lines};
  } else if (d->round.work == PENDRES_PHASE_CURVES) {
    next = (pendres_phase_round){PENDRES_PHASE_COMPLETION, d->grid.lines};
  } else if (d->round.work != PENDRES_PHASE_DONE) {
    status = pendres_phase_find_families(d, &next.tasks);
    if (next.tasks > 0) next.work = PENDRES_PHASE_CURVES;
  }
  if (status != PENDRES_OK) return status;
  d->begun = 1;
  *round = d->round = next;
  return PENDRES_OK;
}

static pendres_status work(pendres_context *ctx, const pendres_phase_diagram *d, size_t task,
                           size_t *size, void **bytes)
{
  pendres_bytes out = {.bytes = NULL};
  if (size != NULL) *size = 0;
  if (bytes != NULL) *bytes = NULL;
  if (d == NULL || size == NULL || bytes == NULL || task >= d->round.tasks)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "phase diagram: no diagram, no such task, or no place for it");
  const pendres_status status = d->round.work == PENDRES_PHASE_CURVES
                                  ? pendres_phase_follow_family(ctx, d, task, &out)
                                  : make_line(ctx, d, task, &out);
  if (status == PENDRES_OK && out.status != PENDRES_OK) {
    free(out.bytes);
    return pendres_context_fail(ctx, out.status, "out of memory for results");
  }
  *size = out.size;
  *bytes = out.bytes;
  return status;
}

pendres_status pendres_phase_diagram_work(pendres_context *ctx, const pendres_phase_diagram *d,
                                          size_t task, size_t *size, void **bytes)
{
  return PENDRES_CONTEXT_CALL(ctx, work(ctx, d, task, size, bytes));
}

pendres_status pendres_phase_diagram_take(pendres_phase_diagram *d, size_t task, size_t size,
                                          const void *bytes)
{
  if (d == NULL || bytes == NULL || task >= d->round.tasks) return PENDRES_INVALID_ARGUMENT;
  if (d->round.work != PENDRES_PHASE_CURVES) return take_line(d, task, size, bytes);
  return task < d->families ? pendres_phase_take_family(d, task, size, bytes)
                            : PENDRES_INVALID_ARGUMENT;
}

/* ---- all of it ---- */

static pendres_status do_round(pendres_context *ctx, pendres_phase_diagram *d, size_t tasks)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < tasks && status == PENDRES_OK; i++) {
    size_t size;
    void *bytes;
    status = work(ctx, d, i, &size, &bytes);
    if (status == PENDRES_OK) status = pendres_phase_diagram_take(d, i, size, bytes);
    free(bytes);
  }
  return status;
}

static pendres_status compute(pendres_context *ctx, const pendres_phase_grid *grid,
                              pendres_phase_diagram **out)
{
  if (out != NULL) *out = NULL;
  if (grid == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "grid and out");
  const char *why = refused(grid);
  if (why != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "phase diagram: %s", why);
  pendres_phase_diagram *d = NULL;
  pendres_status status = pendres_phase_diagram_create(grid, &d);
  if (status != PENDRES_OK)
    return pendres_context_fail(ctx, status, "out of memory for a phase diagram");
  for (pendres_phase_round round = {.tasks = 1}; round.tasks > 0 && status == PENDRES_OK;) {
    status = pendres_phase_diagram_next(d, &round);
    if (status == PENDRES_OK) status = do_round(ctx, d, round.tasks);
  }
  if (status != PENDRES_OK) pendres_phase_diagram_free(d);
  else *out = d;
  return status;
}

pendres_status pendres_phase_diagram_find(pendres_context *ctx, const pendres_phase_grid *grid,
                                          pendres_phase_diagram **out)
{
  return PENDRES_CONTEXT_CALL(ctx, compute(ctx, grid, out));
}

/* ---- results ---- */

const pendres_phase_point *pendres_phase_diagram_point_get(const pendres_phase_diagram *d,
                                                           size_t point)
{
  if (d == NULL || point >= d->grid.lines * d->grid.values) return NULL;
  const pendres_phase_done *l = &d->line[point / d->grid.values];
  const size_t place = l->place[point % d->grid.values];
  return place != PENDRES_PHASE_NOWHERE ? &l->points[place] : &d->nothing;
}

static pendres_status outcome_of(const pendres_phase_mark *m, const char **message)
{
  if (message != NULL) *message = m->message;
  return m->outcome;
}

pendres_status pendres_phase_diagram_outcome_get(const pendres_phase_diagram *d, size_t point,
                                                 const char **message)
{
  if (message != NULL) *message = NULL;
  if (d == NULL || point >= d->grid.lines * d->grid.values) return PENDRES_INVALID_ARGUMENT;
  return outcome_of(&d->line[point / d->grid.values].mark[point % d->grid.values], message);
}

const pendres_branches *pendres_phase_diagram_branches_get(const pendres_phase_diagram *d,
                                                           size_t line)
{
  return d != NULL && line < d->grid.lines ? d->line[line].branches : NULL;
}

pendres_phase_curves pendres_phase_diagram_get(const pendres_phase_diagram *d)
{
  if (d == NULL) return (pendres_phase_curves){.curves = NULL};
  return (pendres_phase_curves){
    .curves = d->curves, .outcome = d->curves_mark.outcome, .message = d->curves_mark.message,
    .bifurcations = d->bifurcations, .bifurcation = d->bifurcation,
    .cusp = d->has_cusp ? &d->cusp : NULL};
}

pendres_label pendres_phase_diagram_ending_get(const pendres_phase_diagram *d,
                                               const pendres_orbit *o,
                                               double curvature)
{
  if (d == NULL || o == NULL || !pendres_phase_on_sheets(o)) return PENDRES_LABEL_PERIODIC;
  const double beside = d->has_cusp ? o->phase_lag - d->cusp.orbit.phase_lag : curvature;
  const int small = (d->falling ? -beside : beside) < 0.0;
  return small ? PENDRES_LABEL_SA : PENDRES_LABEL_LA;
}

const pendres_bifurcation *pendres_phase_diagram_fold_get(const pendres_phase_diagram *d,
                                                          size_t line,
                                                          pendres_label state)
{
  const pendres_bifurcation *best = NULL;
  if (d == NULL || line >= d->grid.lines) return NULL;
  for (size_t i = d->first[line]; i < d->first[line + 1]; i++) {
    const pendres_bifurcation *b = &d->bifurcation[i];
    if (b->kind != PENDRES_FOLD || !pendres_phase_on_sheets(&b->orbit)) continue;
    const double way = d->falling ? -1.0 : 1.0;
    if ((way * b->curvature > 0.0) != (state == PENDRES_LABEL_LA)) continue;
    /* If there are several on a line, the one next to the cusp is taken. */
    if (best == NULL || way * b->value > way * best->value) best = b;
  }
  return best;
}
