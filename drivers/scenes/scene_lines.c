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

/* A line in the making. */
typedef struct draft {
  scene_line line;
  pendres_pendulum *pendulum; /* [drive] */
  scene_verdict *verdict;     /* [drive] */
} draft;

static pendres_status draft_create(const scene_lines *l, draft *d)
{
  *d = (draft){ .pendulum = calloc(l->drives, sizeof *d->pendulum),
                .verdict = calloc(l->drives, sizeof *d->verdict) };
  d->line.points = calloc(l->drives, sizeof *d->line.points);
  d->line.place = calloc(l->drives, sizeof *d->line.place);
  const int good = d->pendulum != NULL && d->verdict != NULL && d->line.points != NULL &&
                   d->line.place != NULL;
  return good ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

static void line_free(scene_line *line)
{
  free(line->points);
  free(line->place);
  pendres_branches_free(line->branches);
  *line = (scene_line){ 0 };
}

static void draft_free(draft *d)
{
  line_free(&d->line);
  free(d->pendulum);
  free(d->verdict);
}

/* Which of a line's drives can be computed at all: the others are marked. Costly, and done only
   where a line has failed. */
static pendres_status find_good(const scene_lines *l, pendres_context *ctx, draft *d)
{
  scene_line *line = &d->line;
  line->count = 0;
  for (size_t k = 0; k < l->drives; k++) {
    pendres_response r;
    char words[120];
    if (scene_failure_too_long(&d->pendulum[k], RUNS_A_POINT, words, sizeof words)) {
      scene_verdict_mark(&d->verdict[k], SCENE_FAILURE_TOO_LONG, words);
      line->place[k] = SIZE_MAX;
      continue;
    }
    const pendres_status status =
      pendres_response_compute(ctx, 1, &d->pendulum[k], &l->ensemble, &r);
    line->place[k] = status == PENDRES_OK ? line->count++ : SIZE_MAX;
    const pendres_status rest =
      scene_verdict_note(&d->verdict[k], status, pendres_context_message(ctx));
    if (rest != PENDRES_OK) return rest;
  }
  return PENDRES_OK;
}

/* Mark all points of a line; those computed before keep their values. */
static pendres_status note_line(const scene_lines *l, draft *d, pendres_status status,
                                const char *words)
{
  pendres_status rest = status;
  for (size_t k = 0; k < l->drives; k++)
    if (d->line.place[k] != SIZE_MAX) rest = scene_verdict_note(&d->verdict[k], status, words);
  return rest;
}

static pendres_status compute_good(const scene_lines *l, pendres_context *ctx, draft *d)
{
  scene_line *line = &d->line;
  for (size_t k = 0; k < l->drives; k++)
    if (line->place[k] != SIZE_MAX) d->pendulum[line->place[k]] = d->pendulum[k];
  pendres_status status = pendres_phase_line(ctx, line->count, d->pendulum, &l->ensemble,
                                             l->spacing, line->points, &line->branches);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  status = note_line(l, d, status, pendres_context_message(ctx));
  for (size_t k = 0; k < l->drives; k++) line->place[k] = SIZE_MAX;
  line->count = 0;
  return status;
}

static void judge_line(const scene_lines *l, draft *d)
{
  const scene_line *line = &d->line;
  for (size_t k = 0; k < l->drives; k++) {
    char words[80];
    if (line->place[k] == SIZE_MAX || line->points[line->place[k]].unresolved == 0) continue;
    snprintf(words, sizeof words, "%zu of %zu members did not settle: a larger period_budget may "
             "do", line->points[line->place[k]].unresolved, l->ensemble.members);
    scene_verdict_mark(&d->verdict[k], SCENE_FAILURE_UNRESOLVED, words);
  }
}

/* The record of a line: these counts, the place of each drive, the points, the branches, and what
   became of each drive. */
typedef struct line_head {
  size_t count, branches; /* points; bytes */
} line_head;

static pendres_status pack_line(const scene_lines *l, const draft *d, farm_record *out)
{
  const scene_line *line = &d->line;
  const line_head head = { line->count, pendres_branches_packed_size(line->branches) };
  const size_t sizes[] = { l->drives * sizeof *line->place, head.count * sizeof *line->points,
                           head.branches, l->drives * sizeof *d->verdict };
  char *to = farm_record_resize(out, sizeof head + sizes[0] + sizes[1] + sizes[2] + sizes[3]);
  if (to == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(to, &head, sizeof head), to += sizeof head;
  memcpy(to, line->place, sizes[0]), to += sizes[0];
  memcpy(to, line->points, sizes[1]), to += sizes[1];
  pendres_branches_pack(line->branches, to), to += sizes[2];
  memcpy(to, d->verdict, sizes[3]);
  return PENDRES_OK;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  scene_lines *l = arg;
  line_head head;
  draft d;
  pendres_status status = draft_create(l, &d);
  const char *from = in->data;
  if (status != PENDRES_OK) goto done;
  memcpy(&head, from, sizeof head), from += sizeof head;
  d.line.count = head.count;
  memcpy(d.line.place, from, l->drives * sizeof *d.line.place);
  from += l->drives * sizeof *d.line.place;
  memcpy(d.line.points, from, head.count * sizeof *d.line.points);
  from += head.count * sizeof *d.line.points;
  status = pendres_branches_unpack(head.branches, from, &d.line.branches);
  if (status != PENDRES_OK) goto done;
  memcpy(d.verdict, from + head.branches, l->drives * sizeof *d.verdict);
  for (size_t k = 0; k < l->drives; k++)
    scene_failures_take(&l->failed, task * l->drives + k, &d.verdict[k]);
  line_free(&l->line[task]);
  l->line[task] = d.line;
  d.line = (scene_line){ 0 };
done:
  draft_free(&d);
  return status;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const scene_lines *l = arg;
  int too_long = 0;
  draft d;
  pendres_status status = draft_create(l, &d);
  if (status != PENDRES_OK) goto done;
  for (size_t k = 0; k < l->drives; k++) {
    char words[120];
    d.pendulum[k] = pendres_sweep_pendulum(&l->sweep, task * l->drives + k, NULL, NULL);
    d.line.place[k] = k;
    too_long |= scene_failure_too_long(&d.pendulum[k], RUNS_A_POINT, words, sizeof words);
  }
  d.line.count = l->drives;
  status = too_long ? PENDRES_NOT_CONVERGED
                    : pendres_phase_line(ctx, l->drives, d.pendulum, &l->ensemble, l->spacing,
                                         d.line.points, &d.line.branches);
  if (scene_failure_of(status) != SCENE_FAILURE_NONE) {
    status = find_good(l, ctx, &d);
    if (status == PENDRES_OK) status = compute_good(l, ctx, &d);
  }
  if (status == PENDRES_OK) judge_line(l, &d);
  if (status == PENDRES_OK) status = pack_line(l, &d, out);
done:
  draft_free(&d);
  return status;
}

/* The branches once more: those of all lines are not to be changed by a task. */
static pendres_status copy_branches(const pendres_branches *from, pendres_branches **to)
{
  const size_t size = pendres_branches_packed_size(from);
  void *bytes = malloc(size);
  if (bytes == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_branches_pack(from, bytes);
  const pendres_status status = pendres_branches_unpack(size, bytes, to);
  free(bytes);
  return status;
}

/* What the curves tell, if it can be had; the line stays as it was if not. */
static pendres_status complete(const void *arg, size_t task, pendres_context *ctx,
                               farm_record *out)
{
  const scene_lines *l = arg;
  const scene_line *line = &l->line[task];
  const size_t size = line->count * sizeof *line->points;
  draft d;
  pendres_status status = draft_create(l, &d);
  if (status == PENDRES_OK) status = copy_branches(line->branches, &d.line.branches);
  if (status != PENDRES_OK) goto done;
  d.line.count = line->count;
  memcpy(d.line.place, line->place, l->drives * sizeof *line->place);
  memcpy(d.line.points, line->points, size);
  if (line->count > 0)
    status = pendres_phase_line_complete(ctx, line->count, l->curves.curves, &l->ensemble,
                                         l->spacing, d.line.points, d.line.branches);
  if (scene_failure_of(status) != SCENE_FAILURE_NONE) {
    memcpy(d.line.points, line->points, size);
    status = note_line(l, &d, status, pendres_context_message(ctx));
  }
  if (status == PENDRES_OK) status = pack_line(l, &d, out);
done:
  draft_free(&d);
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
    status = scene_compute(l->run, &(farm_stage){ .what = "lines", .tasks = l->dampings,
                                                  .task = complete, .collect = collect,
                                                  .arg = l });
    if (status == PENDRES_OK) status = gather(l);
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
  const pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "dampings", .tasks = l->dampings, .task = compute,
                                      .collect = collect, .arg = l });
  return status == PENDRES_OK ? follow_curves(l) : status;
}

void scene_lines_free(scene_lines *l)
{
  for (size_t i = 0; i < l->dampings && l->line != NULL; i++) line_free(&l->line[i]);
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
