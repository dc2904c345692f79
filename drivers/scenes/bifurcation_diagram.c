/*
 * bifurcation_diagram.c -- strobe points of a pendulum against one parameter, which grows
 * slowly: its exponent, its bifurcations, and the doubling cascade of its first orbit.
 *
 * The path is one task; strobe points at each value, and the cascade, are tasks of a second stage.
 */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/along.h"
#include "scenes/failed.h"

enum { TABLE_ROWS = 40 };

/* A strobe point. */
typedef struct strobe {
  double x, x_error, v, v_error;
} strobe;

enum { NO_TIME = -1 };

/* What the last task of the second stage finds. */
typedef struct cascade_record {
  pendres_cascade cascade;
  scene_verdict verdict;
} cascade_record;

typedef struct work {
  const deck *d;
  deck_axis_id axis;
  size_t values, strobes;
  scene_along_path path;
  strobe *strobe; /* [values][strobes] */
  int *attractors; /* [values]; 0: not asked for; NO_TIME: the budget has ended what was to be
                      found there */
  cascade_record cascade;
} work;

/* What a task of the second stage finds at a value; `strobes` positions, then velocities follow. */
typedef struct record {
  int64_t attractors;
} record;

static pendres_pendulum pendulum_at(const work *w, size_t i)
{
  pendres_pendulum p = scene_along_pendulum(w->d);
  scene_along_set(&p, w->axis, w->path.point[i].value);
  return p;
}

/* ---- computing ----------------------------------------------------------------------------- */

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  (void)task;
  const scene_along_way way = {w->axis, w->values, w->d->axis[w->axis].value};
  return scene_along_follow(w->d, &way, ctx, out);
}

static int check_path(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  (void)task;
  return scene_along_check(in, w->values);
}

static pendres_status collect_path(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  (void)task;
  return scene_along_take(in, &w->path);
}

static pendres_status find_cascade(const work *w, pendres_context *ctx, farm_record *out)
{
  cascade_record *r = farm_record_resize(out, sizeof *r);
  const pendres_orbit *first = &w->path.point[0].attractor.orbit;
  pendres_status status = PENDRES_NOT_FOUND;
  if (r == NULL) return PENDRES_OUT_OF_MEMORY;
  farm_point(out, 1, "the cascade of doublings");
  if (scene_along_closed(&w->path.point[0]))
    status = pendres_cascade_find(ctx, first, scene_parameter_of(w->axis)->parameter,
                                  w->path.point[w->values - 1].value, &r->cascade);
  const int late = farm_gave_up(out, status);
  if (late) status = scene_verdict_point(&r->verdict, status, NULL, out);
  else if (status == PENDRES_OK || scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  r->cascade =
    (pendres_cascade){.limit = NAN, .limit_error = NAN, .ratio = NAN, .ratio_error = NAN};
  return PENDRES_OK;
}

/* Find the attractors at a value, if they are asked for, and strobe points of the one that the path
   is on. */
static pendres_status find_at(const work *w, size_t i, pendres_context *ctx, record *r, double *x)
{
  const pendres_hysteresis_point *point = &w->path.point[i];
  const pendres_pendulum p = pendulum_at(w, i);
  pendres_attractors *set = NULL;
  pendres_status status = PENDRES_OK;
  if (w->d->diagram.attractors) status = pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set);
  r->attractors = (int64_t)pendres_attractors_count(set);
  pendres_attractors_free(set);
  if (status != PENDRES_OK || point->attractor.label == PENDRES_LABEL_UNRESOLVED ||
      point->attractor.label == PENDRES_LABEL_ESCAPE)
    return status;
  return pendres_strobe_record(ctx, &p, &(pendres_state){point->x, point->v}, (long)w->strobes - 1,
                               1, &(pendres_record){.x = x, .v = x + w->strobes});
}

static pendres_status find_strobes(const void *arg, size_t task, pendres_context *ctx,
                                   farm_record *out)
{
  const work *w = arg;
  if (task == w->values) return find_cascade(w, ctx, out);
  record *r = farm_record_resize(out, sizeof *r + 2 * w->strobes * sizeof(double));
  if (r == NULL) return PENDRES_OUT_OF_MEMORY;
  double *x = (double *)(r + 1);
  for (size_t k = 0; k < 2 * w->strobes; k++) x[k] = NAN;
  scene_point_begin(out, w->d, task, 1, 1, &w->axis);
  const pendres_status status = find_at(w, task, ctx, r, x);
  if (!farm_gave_up(out, status)) return status;
  farm_lost(out, NULL, 0);
  for (size_t k = 0; k < 2 * w->strobes; k++) x[k] = NAN;
  r->attractors = NO_TIME;
  return PENDRES_OK;
}

/* The well number 0. */
static double within_a_turn(const deck *d, double x)
{
  const double turn = 2.0 * PENDRES_PI;
  if (!(pendres_model_of(deck_pendulum(d).force)->period > 0.0)) return x;
  return x - turn * ceil((x - 0.75 * turn) / turn);
}

static int check_strobes(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  const record *r = in->data;
  const cascade_record *c = in->data;
  if (task < w->values)
    return in->size == sizeof *r + 2 * w->strobes * sizeof(double) && r->attractors >= NO_TIME &&
           r->attractors <= INT_MAX;
  return in->size == sizeof *c && scene_check_verdict(&c->verdict) &&
         scene_check_code(c->cascade.doublings, PENDRES_CASCADE_DOUBLINGS + 1);
}

static pendres_status collect_strobes(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  if (task == w->values) {
    memcpy(&w->cascade, in->data, sizeof w->cascade);
    return PENDRES_OK;
  }
  const record *r = in->data;
  const double *x = (const double *)(r + 1), *v = x + w->strobes;
  const pendres_hysteresis_point *point = &w->path.point[task];
  /* Points of chaos are its own, but how far they are off the pendulum's is not known. */
  const int closed = scene_along_closed(point);
  w->attractors[task] = (int)r->attractors;
  const double x_error = closed ? point->attractor.orbit.x_error + w->d->precision.tolerance : NAN;
  const double fast = w->d->precision.tolerance / deck_pendulum_units(w->d).time;
  const double v_error = closed ? point->attractor.orbit.v_error + fast : NAN;
  for (size_t k = 0; k < w->strobes; k++)
    w->strobe[task * w->strobes + k] = (strobe){within_a_turn(w->d, x[k]), x_error, v[k], v_error};
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

#define STROBE(field, words)                                                                     \
  {.name = #field, .long_name = words, .units = "1", .value = offsetof(strobe, field),            \
   .error = offsetof(strobe, field##_error),                                                      \
   .comment = "errors are NaN in chaos: its points are on the attractor, but no two runs have "    \
              "the same ones"}
static const scene_column of_strobes[] = {
  STROBE(x, "position at drive phase 0, within one turn"),
  STROBE(v, "velocity at drive phase 0"),
};

static const scene_column of_exponents[] = {
  SCENE_ALONG_COLUMN(lyapunov, attractor.lyapunov, "largest Lyapunov exponent a unit time", "1"),
};

static const scene_column of_points[] = {
  SCENE_COLUMN(scene_along_row, period, "drive periods until the orbit closes", "1"),
};

static const scene_column of_attractors = {
  .name = "attractors", .long_name = "attractors that are found there", .type = SCENE_NUMBER,
  .comment = "-1: not known"};

static const scene_column of_bifurcations[] = {
  SCENE_CODE(scene_along_jump, kind, "what ends the motion there", scene_jump_names),
  SCENE_COLUMN(scene_along_jump, parameter, "value at which it is", "1"),
  SCENE_COLUMN(scene_along_jump, period,
               "drive periods of the orbit that the pendulum is on then", "1"),
};

/* The doublings are two arrays of the cascade, not one of structs: a step is that of its
   doubles. */
static const scene_column of_doublings = {
  .name = "parameter", .long_name = "value at which the period doubles",
  .value = offsetof(pendres_cascade, value), .error = offsetof(pendres_cascade, value_error)};

static const scene_column of_cascade[] = {
  SCENE_COLUMN(pendres_cascade, limit, "value at which doublings accumulate", "1"),
  SCENE_COLUMN(pendres_cascade, ratio, "ratio of the last two distances of doublings", "1"),
};

/* Mark the points that the budget has ended, beside those that the path marks. */
static void mark_late(scene_run *run, const work *w, scene_along_row *rows)
{
  for (size_t i = 0; i < w->values; i++) {
    if (w->attractors[i] != NO_TIME) continue;
    /* What the path has not come to is counted there. */
    run->failed_points += rows[i].failed == SCENE_FAILURE_NONE;
    rows[i].failed = SCENE_FAILURE_OUT_OF_TIME;
    scene_failure_tell(run, SCENE_FAILURE_OUT_OF_TIME, NULL, "attractors at %s %.10g",
                       deck_axis_name(w->axis), w->path.point[i].value);
  }
  if (w->cascade.verdict.reason == SCENE_FAILURE_NONE) return;
  run->failed_points++;
  scene_failure_tell(run, (scene_failure)w->cascade.verdict.reason, w->cascade.verdict.words,
                     "the cascade of doublings");
}

static pendres_status write_values(scene_run *run, const work *w)
{
  const char *axis = deck_axis_name(w->axis);
  scene_along_row *rows = scene_along_rows(run, &w->path);
  const scene_table strobes = {.dimensions = {axis, "strobe"}, .prefix = "strobe",
                               .n = w->values * w->strobes, .stride = sizeof *w->strobe,
                               .rows = w->strobe};
  const scene_table points = {.dimensions = {axis}, .n = w->path.points, .stride = sizeof *rows,
                              .rows = rows};
  const scene_table counts = {.dimensions = {axis}, .n = w->values,
                              .stride = sizeof *w->attractors, .rows = w->attractors};
  if (rows == NULL) return PENDRES_OUT_OF_MEMORY;
  mark_late(run, w, rows);
  pendres_status status = SCENE_WRITE(run, &strobes, of_strobes);
  if (status == PENDRES_OK && w->d->diagram.exponents)
    status = SCENE_WRITE(run, &points, of_exponents);
  if (status == PENDRES_OK) status = SCENE_WRITE(run, &points, of_points);
  if (status == PENDRES_OK && w->d->diagram.attractors)
    status = scene_columns_write(run, &counts, 1, &of_attractors);
  if (status == PENDRES_OK)
    status = scene_along_write_verdicts(run, &w->path, &points);
  scene_along_tell(run, w->axis, &w->path, 1);
  return status;
}

static pendres_status write_cascade(scene_run *run, const work *w)
{
  const pendres_cascade *c = &w->cascade.cascade;
  const scene_table doublings = {.dimensions = {"cascade"}, .prefix = "cascade",
                                 .n = (size_t)c->doublings, .stride = sizeof c->value[0],
                                 .rows = c};
  const scene_table whole = {.prefix = "cascade", .n = 1, .stride = sizeof *c, .rows = c};
  pendres_status status = scene_numbering(run, "cascade", doublings.n, "number of the doubling");
  if (status == PENDRES_OK) status = scene_columns_write(run, &doublings, 1, &of_doublings);
  return status == PENDRES_OK ? SCENE_WRITE(run, &whole, of_cascade) : status;
}

static pendres_status write_all(scene_run *run, const work *w)
{
  pendres_status status = scene_dimension(run, NULL, w->axis);
  if (status == PENDRES_OK)
    status = scene_numbering(run, "strobe", w->strobes, "number of the strobe point");
  if (status == PENDRES_OK) status = write_values(run, w);
  if (status != PENDRES_OK || !w->d->diagram.bifurcations) return status;
  status = SCENE_ALONG_WRITE_JUMPS(run, &w->path, "bifurcation", of_bifurcations);
  return status == PENDRES_OK ? write_cascade(run, w) : status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void tabulate(FILE *out, const work *w)
{
  if (out == NULL || !w->d->diagram.bifurcations) return;
  fprintf(out, "%-10s %-28s %s\n", "ends by", deck_axis_name(w->axis), "period after");
  for (size_t i = 0; i < w->path.jumps && i < TABLE_ROWS; i++) {
    const pendres_jump *j = &w->path.jump[i];
    fprintf(out, "%-10s %.14g +- %.0e  %d\n", pendres_name_get(PENDRES_NAMES_JUMP, j->kind),
            j->value,
            j->value_error, j->to_period);
  }
  if (scene_along_uncertain(&w->path))
    fprintf(out, "uncertain: errors as small as rounding choose the state that it begins on\n");
  const pendres_cascade *c = &w->cascade.cascade;
  if (c->doublings > 3)
    fprintf(out, "%d doublings accumulate at %.12g +- %.0e, ratio %.6f +- %.0e\n", c->doublings,
            c->limit, c->limit_error, c->ratio, c->ratio_error);
}

static pendres_status compute(scene_run *run, work *w)
{
  const size_t tasks = w->values + (w->d->diagram.bifurcations != 0);
  const farm_stage path = {.what = "sweeps", .tasks = 1, .record_size = 1, .task = follow,
                           .check = check_path, .collect = collect_path, .arg = w};
  const farm_stage strobes = {.what = "values", .last = 1, .tasks = tasks,
                              .record_size = 1, .task = find_strobes,
                              .check = check_strobes, .collect = collect_strobes, .arg = w};
  const pendres_status status = scene_compute(run, &path);
  return status == PENDRES_OK ? scene_compute(run, &strobes) : status;
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck, .strobes = (size_t)run->deck->diagram.strobes};
  w.values = scene_along_axis(run->deck, &w.axis)->count;
  const size_t n = w.values * w.strobes;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  w.strobe = malloc(n * sizeof *w.strobe);
  w.attractors = malloc(w.values * sizeof *w.attractors);
  if (w.strobe == NULL || w.attractors == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu points", n);
    goto done;
  }
  status = compute(run, &w);
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
done:
  free(w.strobe);
  free(w.attractors);
  scene_along_path_free(&w.path);
  return status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis;
  const deck_axis *a = scene_along_axis(d, &axis);
  fprintf(out, "%lld strobe points at each of %zu values of %s from %g to %g, which grows "
               "slowly\n",
          (long long)d->diagram.strobes, a->count, deck_axis_name(axis), a->value[0],
          a->value[a->count - 1]);
  if (d->diagram.attractors) fprintf(out, "attractors at each value\n");
  if (d->diagram.bifurcations)
    fprintf(out, "bifurcations on the way, and the cascade of doublings of the first orbit\n");
}

const scene_kind scene_bifurcation_diagram = {
  .kind = DECK_BIFURCATION_DIAGRAM,
  .references = "G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996); M. J. Feigenbaum, Journal "
                "of Statistical Physics 19 (1978) 25",
  .budget = 1,
  .size = {60e3, 200.0, 100e3, 2.0, 1.0, 0.3},
  .describe = describe,
  .run = run_scene,
};
