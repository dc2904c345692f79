/* lines.c -- lines of points and their branches; see lines.h. */
#include "scenes/along.h"
#include "scenes/numbers.h"
#include "scenes/lines/lines.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/rotation.h>

/* ---- axes ---------------------------------------------------------------------------------- */

static pendres_phase_grid grid_of(const deck *d, const deck_axis_id axis[2], double spacing)
{
  const deck_axis *across = &d->axis[axis[0]], *along = &d->axis[axis[1]];
  return (pendres_phase_grid){.pendulum = deck_pendulum(d),
                              .options = {.ensemble = scene_ensemble(d),
                                          .parameter = deck_axis_parameter(axis[1]),
                                          .spacing = spacing},
                              .values = along->count,
                              .value = along->value,
                              .across = deck_axis_parameter(axis[0]),
                              .lines = across->count,
                              .line_value = across->value};
}

void scene_lines_describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  char text[DECK_NAME];
  (void)deck_axes(d, axis);
  fprintf(out, "%lld members at ", (long long)d->ensemble.members);
  for (int i = 0; i < 2; i++) {
    const deck_axis *a = &d->axis[axis[i]];
    fprintf(out, "%s%zu values of %s, %g to %g,%s", i == 0 ? "" : " and ", a->count,
            scene_spaced(deck_axis_parameter(axis[i]), text), a->value[0], a->value[a->count - 1],
            i == 0 ? "" : "\n");
  }
  for (int i = 0, held = 0; i < DECK_AXIS_TEMPERATURE; i++) {
    const double value = scene_fixed(d, (deck_axis_id)i);
    if (isnan(value)) continue;
    fprintf(out, "%s%s %g", held++ > 0 ? ", " : "",
            scene_spaced(deck_axis_parameter((deck_axis_id)i), text), value);
  }
}

int scene_lines_changes(const scene_lines *l, pendres_parameter parameter)
{
  return l->grid.across == parameter || l->grid.options.parameter == parameter;
}

/* ---- tasks --------------------------------------------------------------------------------- */

pendres_pendulum scene_lines_pendulum(const scene_lines *l, size_t point)
{
  pendres_pendulum p = l->grid.pendulum;
  pendres_parameter_set(l->grid.across, l->grid.line_value[point / l->grid.values], &p);
  pendres_parameter_set(l->grid.options.parameter, l->grid.value[point % l->grid.values], &p);
  return p;
}

/* Do a task of a diagram; what it has made is the record. */
static pendres_status work(const pendres_phase_diagram *diagram, size_t task, pendres_context *ctx,
                           farm_record *out)
{
  size_t size;
  void *bytes;
  pendres_status status = pendres_phase_diagram_work(ctx, diagram, task, &size, &bytes);
  if (status == PENDRES_OK && farm_record_resize(out, size) == NULL) status = PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK) memcpy(out->data, bytes, size);
  free(bytes);
  return status;
}

/* The same for a line, whose points are begun together. */
static pendres_status work_line(const scene_lines *l, size_t task, pendres_context *ctx,
                                farm_record *out)
{
  scene_points_begin(l->run, &l->points, task * l->grid.values, l->grid.values, out);
  return work(l->diagram, task, ctx, out);
}

/* Compute a line in a diagram of its own; where its budget ends it, it has no points. */
static pendres_status compute_alone(const scene_lines *l, size_t task, pendres_context *ctx,
                                    pendres_phase_diagram *alone, farm_record *out)
{
  scene_points_begin(l->run, &l->points, task * l->grid.values, l->grid.values, out);
  const pendres_status status = work(alone, 0, ctx, out);
  if (!farm_gave_up(out, status)) return status;
  farm_lost(out, NULL, 0);
  for (size_t k = 0; k < l->grid.values; k++) (void)pendres_phase_diagram_leave_out(alone, k);
  return work(alone, 0, ctx, out);
}

/* Compute a line that its budget has ended, without the points that use up a budget of their
   own. */
static pendres_status compute_by_points(const scene_lines *l, size_t task, pendres_context *ctx,
                                        farm_record *out)
{
  const size_t values = l->grid.values;
  pendres_phase_diagram *alone = NULL;
  pendres_phase_grid grid = l->grid;
  grid.lines = 1;
  grid.line_value = &l->grid.line_value[task];
  pendres_phase_round round;
  pendres_status status = pendres_phase_diagram_create(&grid, &alone);
  if (status == PENDRES_OK) status = pendres_phase_diagram_next(alone, &round);
  for (size_t k = 0; k < values && status == PENDRES_OK; k++) {
    const size_t point = task * values + k;
    const pendres_pendulum p = scene_lines_pendulum(l, point);
    pendres_response response;
    int left_out = l->points.failed[point].reason != SCENE_FAILURE_NONE;
    scene_points_begin(l->run, &l->points, point, 1, out);
    if (!left_out)
      status = pendres_response_find(ctx, 1, &p, &grid.options.ensemble, &response);
    if (farm_gave_up(out, status)) {
      farm_lost(out, NULL, 0);
      left_out = 1;
    }
    /* What fails otherwise is sorted out with the line. */
    if (left_out || scene_failure_of(status) != SCENE_FAILURE_NONE) status = PENDRES_OK;
    if (left_out) (void)pendres_phase_diagram_leave_out(alone, k);
  }
  if (status == PENDRES_OK) status = compute_alone(l, task, ctx, alone, out);
  pendres_phase_diagram_free(alone);
  return status;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const scene_lines *l = arg;
  const pendres_status status = work_line(l, task, ctx, out);
  return farm_gave_up(out, status) ? compute_by_points(l, task, ctx, out) : status;
}

/* A line that its budget has ended stays as it was: its record is empty. */
static pendres_status complete(const void *arg, size_t task, pendres_context *ctx,
                               farm_record *out)
{
  const scene_lines *l = arg;
  const pendres_status status = work_line(l, task, ctx, out);
  if (!farm_gave_up(out, status)) return status;
  farm_lost(out, NULL, 0);
  return PENDRES_OK;
}

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  return work(((const scene_lines *)arg)->diagram, task, ctx, out);
}

/* The library looks at its own bytes when it takes them. */
static int check(const void *arg, size_t task, const farm_record *in)
{
  (void)arg;
  (void)task;
  return in->size > 0;
}

/* Points of the deck that a line's record leaves out were ended by their budget. */
static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  scene_lines *l = arg;
  const size_t first = task * l->grid.values;
  pendres_status status = PENDRES_OK;
  if (in->size > 0)
    status = pendres_phase_diagram_take(l->diagram, task, in->size, in->data);
  for (size_t i = first; i < first + l->grid.values && status == PENDRES_OK; i++) {
    const int lost = in->size == 0 ||
                     pendres_phase_diagram_outcome_get(l->diagram, i, NULL) == PENDRES_UNSUPPORTED;
    if (lost && l->points.failed[i].reason == SCENE_FAILURE_NONE)
      scene_failure_mark(l->run, &l->points.failed[i], SCENE_FAILURE_OUT_OF_TIME, NULL);
  }
  return status;
}

static pendres_status take_curves(void *arg, size_t task, const farm_record *in)
{
  const scene_lines *l = arg;
  return pendres_phase_diagram_take(l->diagram, task, in->size, in->data);
}

/* Compute lines, follow curves through the bifurcations of all lines, and complete the lines by
   them, until nothing new is found. */
static void do_rounds(scene_lines *l)
{
  const farm_stage stages[PENDRES_PHASE_WORK_COUNT] = {
    [PENDRES_PHASE_LINES] = {.what = "lines", .task = compute, .collect = collect},
    [PENDRES_PHASE_CURVES] = {.what = "families of curves", .cheap = 1, .record_size = 1,
                              .task = follow, .collect = take_curves},
    [PENDRES_PHASE_COMPLETION] = {.what = "lines", .task = complete, .collect = collect}};
  while (scene_going(l->run)) {
    pendres_phase_round round;
    const pendres_status status = pendres_phase_diagram_next(l->diagram, &round);
    if (status != PENDRES_OK) scene_fail(l->run, status, "out of memory for bifurcations");
    if (round.tasks == 0) return;
    farm_stage stage = stages[round.work];
    stage.tasks = round.tasks;
    stage.check = check;
    stage.arg = l;
    scene_compute(l->run, &stage);
  }
}

/* ---- failures ------------------------------------------------------------------------------ */

/* Points that ask for too many steps are not computed. */
static void leave_out(scene_lines *l)
{
  for (size_t i = 0; i < l->points.n; i++) {
    char words[SCENE_TOLD];
    const pendres_pendulum p = scene_lines_pendulum(l, i);
    if (!scene_settling_too_long(l->run->deck, &p, LINES_RUNS_A_POINT, words, sizeof words))
      continue;
    (void)pendres_phase_diagram_leave_out(l->diagram, i);
    scene_failure_mark(l->run, &l->points.failed[i], SCENE_FAILURE_TOO_LONG, words);
  }
}

static void judge(scene_lines *l)
{
  pendres_phase_point *points = l->points.rows;
  for (size_t i = 0; i < l->points.n; i++) {
    char words[SCENE_TOLD];
    const char *message = NULL;
    points[i] = *pendres_phase_diagram_point_get(l->diagram, i);
    const size_t unresolved = points[i].unresolved;
    const pendres_status outcome = pendres_phase_diagram_outcome_get(l->diagram, i, &message);
    const scene_failure reason = scene_failure_of(outcome);
    if (reason != SCENE_FAILURE_NONE) {
      scene_failure_mark(l->run, &l->points.failed[i], reason, message);
    } else if (outcome == PENDRES_OK && unresolved > 0) {
      const size_t members = l->grid.options.ensemble.members;
      scene_failure_unsettled(l->run->deck, unresolved, members, "members",
                              points[i].weakest_multiplier, words);
      scene_failure_mark(l->run, &l->points.failed[i], SCENE_FAILURE_UNRESOLVED, words);
    }
  }
}

/* Tell once that there may be more curves. */
static void judge_curves(scene_lines *l)
{
  const pendres_phase_curves c = pendres_phase_diagram_get(l->diagram);
  const scene_failure reason = scene_failure_of(c.outcome);
  if (reason == SCENE_FAILURE_NONE) return;
  scene_failure_count(l->run, reason, 1);
  scene_failure_tell(l->run, reason, c.message, "curves of bifurcations");
}

/* ---- all of it ----------------------------------------------------------------------------- */

void scene_lines_compute(scene_run *run, double spacing, scene_lines *l)
{
  deck_axis_id axis[DECK_AXES];
  *l = (scene_lines){.run = run, .points = {.size = sizeof(pendres_phase_point), .what = "point"}};
  scene_points_over(&l->points, run->deck, deck_axes(run->deck, axis), axis);
  l->grid = grid_of(run->deck, axis, spacing);
  l->points.rows = scene_array(run, l->points.n, l->points.size);
  l->points.failed = scene_array(run, l->points.n, sizeof *l->points.failed);
  const pendres_status status = pendres_phase_diagram_create(&l->grid, &l->diagram);
  if (status != PENDRES_OK)
    scene_fail(run, status, "a diagram of %zu points: %s", l->points.n,
               pendres_status_message(status));
  if (!scene_going(run)) return;
  leave_out(l);
  do_rounds(l);
  if (!scene_going(run)) return;
  judge_curves(l);
  judge(l);
}

void scene_lines_free(scene_lines *l)
{
  pendres_phase_diagram_free(l->diagram);
}

/* ---- results ------------------------------------------------------------------------------- */

void scene_lines_write(const scene_lines *l, size_t count, const scene_column *columns)
{
  static const scene_column doubts[] = {SCENE_UNCERTAIN(pendres_phase_point, uncertain),
                                        SCENE_ESCAPED(pendres_phase_point, escaped)};
  const scene_table table = scene_points_table(&l->points, l->run->deck);
  for (int i = 0; i < 2; i++) scene_dimension(l->run, "", l->points.axis[i]);
  scene_columns_write(l->run, &table, count, columns);
  SCENE_WRITE(l->run, &table, doubts);
  scene_points_write_failed(l->run, &l->points, "failed",
                            "why there is no whole result for the point");
}

/* The error of a parameter: of the line's own [0], of that across the lines [1], or none. */
static double error_of(const scene_lines *l, pendres_parameter parameter, const double error[2])
{
  if (parameter == l->grid.options.parameter) return error[0];
  return parameter == l->grid.across ? error[1] : 0.0;
}

scene_place scene_lines_place(const scene_lines *l, const pendres_pendulum *p,
                              const double error[2])
{
  scene_place place;
  for (int i = 0; i < PENDRES_PARAMETER_FOLLOWED; i++) {
    const pendres_parameter parameter = (pendres_parameter)i;
    place.value[i] = pendres_parameter_get(parameter, p);
    place.error[i] = error_of(l, parameter, error);
  }
  return place;
}

static void write_place(const scene_lines *l, const scene_table *table,
                        pendres_parameter parameter)
{
  const size_t at = (size_t)parameter * sizeof(double);
  const scene_column column = {.name = scene_column_name(parameter),
                               .long_name = pendres_parameter_of(parameter)->brief,
                               .quantity = pendres_parameter_of(parameter)->name,
                               .value = offsetof(scene_place, value) + at,
                               .error = offsetof(scene_place, error) + at};
  scene_columns_write(l->run, table, 1, &column);
}

void scene_lines_write_places(const scene_lines *l, const scene_table *table, const char *words,
                              size_t count, const scene_column *columns)
{
  static const pendres_parameter always[] = {PENDRES_DAMPING, PENDRES_DRIVE_FREQUENCY};
  scene_table places = *table;
  places.words = words;
  for (size_t i = 0; i < 2; i++) write_place(l, &places, always[i]);
  scene_columns_write(l->run, table, count, columns);
  for (int i = 0; i < PENDRES_PARAMETER_FOLLOWED; i++) {
    const pendres_parameter parameter = (pendres_parameter)i;
    if (parameter != always[0] && parameter != always[1] && scene_lines_changes(l, parameter))
      write_place(l, &places, parameter);
  }
}

/* Points that the branches' bifurcations do not explain, and ends of branches that could not be
   followed on; *first is one of them. */
static int32_t count_doubts(const scene_lines *l, const pendres_branch_point **first,
                            int32_t *stuck)
{
  int32_t doubts = 0;
  *stuck = 0;
  for (size_t i = 0; i < l->grid.lines; i++) {
    const pendres_branches *all = pendres_phase_diagram_branches_get(l->diagram, i);
    for (size_t k = 0; k < pendres_branches_count(all); k++) {
      const pendres_branch *b = pendres_branches_get(all, k);
      for (int end = 0; end < 2; end++)
        *stuck += pendres_branch_end_get(b, end) == PENDRES_END_STUCK;
      for (size_t m = 0; m < pendres_branch_count(b); m++) {
        const pendres_branch_point *p = pendres_branch_get(b, m);
        if (p->doubt == 0) continue;
        if (doubts++ == 0) *first = p;
      }
    }
  }
  return doubts;
}

void scene_lines_write_doubts(const scene_lines *l)
{
  const pendres_branch_point *first = NULL;
  int32_t stuck;
  const int32_t doubts = count_doubts(l, &first, &stuck);
  if (l->run->deck->kind != DECK_BRANCHES) stuck = 0; /* what it asks for does not end there */
  const pendres_store_spec spec = {
    .name = "branch_doubts",
    .type = PENDRES_STORE_INT32,
    .long_name = "points of branches at which stability or turns and the bifurcations disagree"};
  scene_put(l->run, &spec, &doubts, NULL, 1);
  scene_failure_count(l->run, SCENE_FAILURE_NOT_CONVERGED, (size_t)(doubts + stuck));
  if (doubts > 0)
    scene_failure_tell(l->run, SCENE_FAILURE_NOT_CONVERGED, "a bifurcation is missed or misnamed "
                       "on a branch", "branch_doubts %ld", (long)doubts);
  if (stuck > 0)
    scene_failure_tell(l->run, SCENE_FAILURE_NOT_CONVERGED, "branches could not be followed on "
                       "there", "%ld ends 'stuck'", (long)stuck);
}

void scene_lines_print(const scene_lines *l, FILE *out)
{
  const pendres_cusp *c = pendres_phase_diagram_get(l->diagram).cusp;
  const pendres_branch_point *p = NULL;
  int32_t stuck;
  const int32_t doubts = count_doubts(l, &p, &stuck);
  char across[DECK_NAME], along[DECK_NAME];
  scene_spaced(l->grid.across, across);
  scene_spaced(l->grid.options.parameter, along);
  if (c != NULL)
    fprintf(out, "cusp: %s %#.13g +- %.0e, %s %#.13g +- %.0e\n", across, c->value[1],
            c->value_error[1], along, c->value[0], c->value_error[0]);
  if (doubts > 0)
    fprintf(out, "branches disagree with their bifurcations at %ld points, one of them at %s %.9g, "
            "%s %.9g (period %d): a bifurcation is missed or misnamed there\n", (long)doubts,
            across, pendres_parameter_get(l->grid.across, &p->orbit.pendulum), along,
            pendres_parameter_get(l->grid.options.parameter, &p->orbit.pendulum), p->orbit.period);
}
