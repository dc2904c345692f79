/* scene_lines.c -- lines of points and their branches; see scene_lines.h. */
#include "scenes/scene_lines.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_ROUNDS = 4,  /* of following curves, see below */
  RUNS_A_POINT = 5  /* as long as settling its members: following branches and curves through it */
};

/* ---- a line -------------------------------------------------------------------------------- */

/* Which of a line's drives can be computed at all: the others are marked. Costly, and done only
   where a line has failed. */
static pendres_status find_good(scene_lines *l, size_t task, pendres_context *ctx,
                                const pendres_pendulum *p)
{
  scene_line *line = &l->line[task];
  line->count = 0;
  for (size_t k = 0; k < l->drives; k++) {
    pendres_response r;
    char words[120];
    if (scene_failure_too_long(&p[k], RUNS_A_POINT, words, sizeof words)) {
      scene_failures_mark(&l->failed, task * l->drives + k, SCENE_FAILURE_TOO_LONG, words);
      line->place[k] = SIZE_MAX;
      continue;
    }
    const pendres_status status = pendres_response_compute(ctx, 1, &p[k], &l->ensemble, &r);
    line->place[k] = status == PENDRES_OK ? line->count++ : SIZE_MAX;
    const pendres_status rest = scene_failures_note(&l->failed, task * l->drives + k, status,
                                                    pendres_context_message(ctx));
    if (rest != PENDRES_OK) return rest;
  }
  return PENDRES_OK;
}

/* Mark all points of a line; those computed before keep their values. */
static pendres_status note_line(scene_lines *l, size_t task, pendres_status status,
                                const char *words)
{
  pendres_status rest = status;
  for (size_t k = 0; k < l->drives; k++)
    if (l->line[task].place[k] != SIZE_MAX)
      rest = scene_failures_note(&l->failed, task * l->drives + k, status, words);
  return rest;
}

static pendres_status compute_good(scene_lines *l, size_t task, pendres_context *ctx,
                                   pendres_pendulum *p)
{
  scene_line *line = &l->line[task];
  for (size_t k = 0; k < l->drives; k++)
    if (line->place[k] != SIZE_MAX) p[line->place[k]] = p[k];
  pendres_status status = pendres_phase_line(ctx, line->count, p, &l->ensemble, l->spacing,
                                             line->points, &line->branches);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  status = note_line(l, task, status, pendres_context_message(ctx));
  for (size_t k = 0; k < l->drives; k++) line->place[k] = SIZE_MAX;
  line->count = 0;
  return status;
}

static void judge_line(scene_lines *l, size_t task)
{
  const scene_line *line = &l->line[task];
  for (size_t k = 0; k < l->drives; k++) {
    char words[80];
    if (line->place[k] == SIZE_MAX || line->points[line->place[k]].unresolved == 0) continue;
    snprintf(words, sizeof words, "%zu of %zu members did not settle: a larger period_budget may "
             "do", line->points[line->place[k]].unresolved, l->ensemble.members);
    scene_failures_mark(&l->failed, task * l->drives + k, SCENE_FAILURE_UNRESOLVED, words);
  }
}

static pendres_status compute(void *arg, size_t task, pendres_context *ctx)
{
  scene_lines *l = arg;
  scene_line *line = &l->line[task];
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_pendulum *p = calloc(l->drives, sizeof *p);
  line->points = calloc(l->drives, sizeof *line->points);
  line->place = calloc(l->drives, sizeof *line->place);
  if (p == NULL || line->points == NULL || line->place == NULL) goto done;
  int too_long = 0;
  for (size_t k = 0; k < l->drives; k++) {
    char words[120];
    p[k] = pendres_sweep_pendulum(&l->sweep, task * l->drives + k, NULL, NULL);
    line->place[k] = k;
    too_long |= scene_failure_too_long(&p[k], RUNS_A_POINT, words, sizeof words);
  }
  line->count = l->drives;
  status = too_long ? PENDRES_NOT_CONVERGED
                    : pendres_phase_line(ctx, l->drives, p, &l->ensemble, l->spacing,
                                         line->points, &line->branches);
  if (scene_failure_of(status) != SCENE_FAILURE_NONE) {
    status = find_good(l, task, ctx, p);
    if (status == PENDRES_OK) status = compute_good(l, task, ctx, p);
  }
  if (status == PENDRES_OK) judge_line(l, task);
done:
  free(p);
  return status;
}

/* What the curves tell, if it can be had; the line stays as it was if not. */
static pendres_status complete(void *arg, size_t task, pendres_context *ctx)
{
  scene_lines *l = arg;
  scene_line *line = &l->line[task];
  if (line->count == 0) return PENDRES_OK;
  const size_t size = line->count * sizeof *line->points;
  pendres_phase_point *before = malloc(size);
  if (before == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(before, line->points, size);
  pendres_status status =
    pendres_phase_line_complete(ctx, line->count, l->curves.curves, &l->ensemble, l->spacing,
                                line->points, line->branches);
  if (scene_failure_of(status) != SCENE_FAILURE_NONE) {
    memcpy(line->points, before, size);
    status = note_line(l, task, status, pendres_context_message(ctx));
  }
  free(before);
  return status;
}

const pendres_phase_point *scene_lines_point(const scene_lines *l, size_t i)
{
  const scene_line *line = &l->line[i / l->drives];
  const size_t place = line->place[i % l->drives];
  return place != SIZE_MAX ? &line->points[place] : &l->nothing;
}

static const deck_axis_id axes[] = { DECK_AXIS_DAMPING, DECK_AXIS_DRIVE_FREQUENCY };

static pendres_status write_uncertain(scene_run *run, const scene_lines *l)
{
  const size_t n = l->dampings * l->drives;
  int64_t *count = malloc(n * sizeof *count);
  if (count == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) count[i] = (int64_t)scene_lines_point(l, i)->uncertain;
  const pendres_status status = scene_write_uncertain(run, 2, axes, count);
  free(count);
  return status;
}

pendres_status scene_lines_write_doubtful(scene_run *run, const scene_lines *l)
{
  const pendres_status status = write_uncertain(run, l);
  if (status != PENDRES_OK) return status;
  return scene_failures_write(run, &l->failed, "failed", "point", 2, axes);
}

/* ---- all lines ----------------------------------------------------------------------------- */

/* The bifurcations of all lines. */
static pendres_status gather(scene_lines *l)
{
  l->curves.count = 0;
  for (size_t i = 0; i < l->dampings; i++)
    if (scene_curves_add(&l->curves, l->line[i].branches) != PENDRES_OK)
      return scene_fail(l->run, PENDRES_OUT_OF_MEMORY, "out of memory for bifurcations");
  return PENDRES_OK;
}

/*
 * Curves through the lines' bifurcations show branches that some lines have missed, whose own
 * bifurcations may lie on further curves; mostly the first round has shown all.
 */
static pendres_status follow_curves(scene_lines *l)
{
  pendres_status status = gather(l);
  size_t before = 0;
  for (int i = 0; i < MOST_ROUNDS && status == PENDRES_OK && l->curves.count > before; i++) {
    before = l->curves.count;
    status = scene_curves_follow(l->run, &l->curves);
    if (status != PENDRES_OK) return status;
    status = farm_run(l->run->farm, "lines", l->dampings, complete, NULL, l);
    if (status != PENDRES_OK) return scene_farm_failed(l->run, status);
    status = gather(l);
  }
  return status;
}

pendres_status scene_lines_compute(scene_run *run, scene_lines *l)
{
  const deck *d = run->deck;
  l->run = run;
  l->sweep = scene_sweep(d);
  l->ensemble = scene_ensemble(d);
  l->dampings = d->axis[DECK_AXIS_DAMPING].count;
  l->drives = d->axis[DECK_AXIS_DRIVE_FREQUENCY].count;
  l->nothing = (pendres_phase_point){
    .regime = PENDRES_REGIME_OTHER, .exact = PENDRES_REGIME_OTHER,
    .other = PENDRES_OTHER_UNRESOLVED, .unresolved = l->ensemble.members,
    .sa_fraction = NAN, .sa_fraction_error = NAN, .la_fraction = NAN, .la_fraction_error = NAN,
    .mean_loop_area = NAN, .mean_loop_area_error = NAN, .mean_loop_amplitude = NAN,
    .mean_loop_amplitude_error = NAN, .sa_amplitude = NAN, .sa_amplitude_error = NAN,
    .la_amplitude = NAN, .la_amplitude_error = NAN };
  l->line = calloc(l->dampings, sizeof *l->line);
  if (l->line == NULL || scene_failures_create(l->dampings * l->drives, &l->failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lines", l->dampings);
  pendres_status status = farm_run(run->farm, "dampings", l->dampings, compute, NULL, l);
  if (status != PENDRES_OK) return scene_farm_failed(run, status);
  return follow_curves(l);
}

void scene_lines_free(scene_lines *l)
{
  for (size_t i = 0; i < l->dampings && l->line != NULL; i++) {
    free(l->line[i].points);
    free(l->line[i].place);
    pendres_branches_free(l->line[i].branches);
  }
  free(l->line);
  scene_curves_free(&l->curves);
  scene_failures_free(&l->failed);
}

/* Points that the branches' bifurcations do not explain; *first is one of them. */
static int32_t count_doubts(const scene_lines *l, const pendres_branch_point **first)
{
  int32_t doubts = 0;
  for (size_t i = 0; i < l->dampings; i++)
    for (size_t k = 0; k < pendres_branches_count(l->line[i].branches); k++) {
      const pendres_branch *b = pendres_branches_get(l->line[i].branches, k);
      for (size_t m = 0; m < pendres_branch_count(b); m++) {
        const pendres_branch_point *p = pendres_branch_get(b, m);
        if (p->doubt == 0) continue;
        if (doubts++ == 0) *first = p;
      }
    }
  return doubts;
}

pendres_status scene_lines_write_doubts(const scene_lines *l)
{
  const pendres_branch_point *first = NULL;
  const int32_t doubts = count_doubts(l, &first);
  const pendres_store_spec spec = {
    .name = "branch_doubts",
    .type = PENDRES_STORE_INT32,
    .long_name = "points of branches at which stability or turns and the bifurcations disagree"};
  const pendres_status status = pendres_store_put(l->run->store, &spec, &doubts, 1);
  return status == PENDRES_OK ? status : scene_store_failed(l->run, status);
}

void scene_lines_print(const scene_lines *l, FILE *out)
{
  const pendres_cusp *c = &l->curves.cusp;
  const pendres_branch_point *p = NULL;
  const int32_t doubts = count_doubts(l, &p);
  if (l->curves.has_cusp)
    fprintf(out, "cusp: damping %.12f +- %.0e, drive frequency %.12f +- %.0e\n", c->value[1],
            c->value_error[1], c->value[0], c->value_error[0]);
  if (doubts > 0)
    fprintf(out, "branches disagree with their bifurcations at %ld points, one of them at damping "
            "%.9g, drive frequency %.9g (period %d): a bifurcation is missed or misnamed there\n",
            (long)doubts, p->orbit.pendulum.damping, p->orbit.pendulum.drive_frequency,
            p->orbit.period);
}
