/*
 * scene_bifurcation_diagram.c -- strobe points of a pendulum against one parameter, which grows
 * slowly: its exponent, its bifurcations, and the doubling cascade of its first orbit.
 *
 * The path is one task; strobe points at each value, and the cascade, are tasks of a second stage.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_along.h"
#include "scenes/scene_failed.h"

enum { TABLE_ROWS = 40 };

typedef struct work {
  const deck *d;
  deck_axis_id axis;
  size_t values, strobes;
  scene_along_path path;
  double *x, *v, *x_error, *v_error; /* [values][strobes] */
  int32_t *attractors;               /* [values] */
  pendres_cascade cascade;
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
  return scene_along_follow(w->d, w->axis, w->values, w->d->axis[w->axis].value, ctx, out);
}

static pendres_status collect_path(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  (void)task;
  return scene_along_take(in, &w->path);
}

static pendres_status find_cascade(const work *w, pendres_context *ctx, farm_record *out)
{
  pendres_cascade *c = farm_record_resize(out, sizeof *c);
  const pendres_orbit *first = &w->path.point[0].attractor.orbit;
  pendres_status status = PENDRES_NOT_FOUND;
  if (c == NULL) return PENDRES_OUT_OF_MEMORY;
  if (scene_along_closed(&w->path.point[0]))
    status = pendres_cascade_find(ctx, first, scene_along_parameter(w->axis),
                                  w->path.point[w->values - 1].value, c);
  if (status == PENDRES_OK || scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  *c = (pendres_cascade){.limit = NAN, .limit_error = NAN, .ratio = NAN, .ratio_error = NAN};
  return PENDRES_OK;
}

static pendres_status find_strobes(const void *arg, size_t task, pendres_context *ctx,
                                   farm_record *out)
{
  const work *w = arg;
  pendres_attractors *set = NULL;
  if (task == w->values) return find_cascade(w, ctx, out);
  const pendres_hysteresis_point *point = &w->path.point[task];
  const pendres_pendulum p = pendulum_at(w, task);
  record *r = farm_record_resize(out, sizeof *r + 2 * w->strobes * sizeof(double));
  if (r == NULL) return PENDRES_OUT_OF_MEMORY;
  double *x = (double *)(r + 1), *v = x + w->strobes;
  for (size_t k = 0; k < w->strobes; k++) x[k] = v[k] = NAN;
  pendres_status status = pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set);
  r->attractors = (int64_t)pendres_attractors_count(set);
  pendres_attractors_free(set);
  if (status == PENDRES_OK && point->attractor.label != PENDRES_LABEL_UNRESOLVED)
    status = pendres_strobe_record(ctx, &p, point->x, point->v, (long)w->strobes - 1, 1, x, v, NULL,
                                   NULL);
  return status;
}

/* The well number 0. */
static double within_a_turn(double x)
{
  const double turn = 2.0 * PENDRES_PI;
  return x - turn * ceil((x - 0.75 * turn) / turn);
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
  w->attractors[task] = (int32_t)r->attractors;
  for (size_t k = 0; k < w->strobes; k++) {
    const size_t at = task * w->strobes + k;
    w->x[at] = within_a_turn(x[k]);
    w->v[at] = v[k];
    w->x_error[at] = closed ? point->attractor.orbit.x_error + w->d->precision.tolerance : NAN;
    w->v_error[at] = closed ? point->attractor.orbit.v_error + w->d->precision.tolerance : NAN;
  }
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

static pendres_status put(scene_run *run, const char *name, const char *dimension,
                          const char *second, const char *words, const double *value,
                          const double *error, size_t n)
{
  const pendres_store_spec spec = {
    .name = name, .dimensions = {dimension, second}, .long_name = words};
  const pendres_status status = pendres_store_put_result(run->store, &spec, value, error, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status put_values(scene_run *run, const work *w)
{
  const size_t n = w->values;
  const char *axis = deck_axis_name(w->axis);
  double *a = malloc(4 * n * sizeof *a);
  if (a == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
  for (size_t i = 0; i < n; i++) {
    const pendres_attractor *at = &w->path.point[i].attractor;
    const int closed = scene_along_closed(&w->path.point[i]);
    a[i] = at->lyapunov;
    a[n + i] = at->lyapunov_error;
    a[2 * n + i] = closed ? at->orbit.period : NAN;
    a[3 * n + i] = closed ? 0.0 : NAN;
  }
  const pendres_store_spec count = {.name = "attractors", .type = PENDRES_STORE_INT32,
                                    .dimensions = {axis},
                                    .long_name = "attractors that are found there"};
  pendres_status status = put(run, "lyapunov", axis, NULL, "largest Lyapunov exponent a unit time",
                              a, a + n, n);
  if (status == PENDRES_OK)
    status = put(run, "period", axis, NULL, "drive periods until the orbit closes", a + 2 * n,
                 a + 3 * n, n);
  free(a);
  if (status != PENDRES_OK) return status;
  status = pendres_store_put(run->store, &count, w->attractors, n);
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  return scene_along_write_labels(run, w->axis, &w->path, 1);
}

static pendres_status put_bifurcations(scene_run *run, const work *w)
{
  const size_t n = w->path.jumps;
  const char *kinds[PENDRES_JUMP_COUNT];
  double *a = malloc((4 * n + 1) * sizeof *a);
  int8_t *kind = malloc(n + 1);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (a == NULL || kind == NULL) {
    (void)scene_fail(run, status, "out of memory for bifurcations");
    goto done;
  }
  for (int i = 0; i < PENDRES_JUMP_COUNT; i++)
    kinds[i] = pendres_jump_kind_name((pendres_jump_kind)i);
  for (size_t i = 0; i < n; i++) {
    const pendres_jump *j = &w->path.jump[i];
    a[i] = j->value;
    a[n + i] = j->value_error;
    a[2 * n + i] = j->to_period > 0 ? j->to_period : NAN;
    a[3 * n + i] = j->to_period > 0 ? 0.0 : NAN;
    kind[i] = (int8_t)j->kind;
  }
  const pendres_store_spec spec = {.name = "bifurcation_kind", .type = PENDRES_STORE_INT8,
                                   .dimensions = {"bifurcation"},
                                   .long_name = "what ends the motion there",
                                   .flag_count = PENDRES_JUMP_COUNT, .flag_meanings = kinds};
  status = pendres_store_dimension(run->store, NULL, "bifurcation", n, NULL,
                                   "number of the bifurcation", "1");
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &spec, kind, n);
  if (status != PENDRES_OK) {
    (void)scene_store_failed(run, status);
    goto done;
  }
  status = put(run, "bifurcation_parameter", "bifurcation", NULL, "value at which it is", a, a + n,
               n);
  if (status == PENDRES_OK)
    status = put(run, "bifurcation_period", "bifurcation", NULL,
                 "drive periods of the orbit that the pendulum is on then", a + 2 * n, a + 3 * n,
                 n);
done:
  free(a);
  free(kind);
  return status;
}

static pendres_status put_cascade(scene_run *run, const work *w)
{
  const pendres_cascade *c = &w->cascade;
  const size_t n = (size_t)c->doublings;
  pendres_status status = pendres_store_dimension(run->store, NULL, "cascade", n, NULL,
                                                  "number of the doubling", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  status = put(run, "cascade_parameter", "cascade", NULL, "value at which the period doubles",
               c->value, c->value_error, n);
  if (status == PENDRES_OK)
    status = put(run, "cascade_limit", NULL, NULL, "value at which doublings accumulate", &c->limit,
                 &c->limit_error, 1);
  if (status == PENDRES_OK)
    status = put(run, "cascade_ratio", NULL, NULL, "ratio of the last two distances of doublings",
                 &c->ratio, &c->ratio_error, 1);
  return status;
}

static pendres_status write_all(scene_run *run, const work *w)
{
  const size_t n = w->values * w->strobes;
  const char *axis = deck_axis_name(w->axis);
  pendres_status status = scene_dimension(run, NULL, w->axis);
  if (status != PENDRES_OK) return status;
  status = pendres_store_dimension(run->store, NULL, "strobe", w->strobes, NULL,
                                   "number of the strobe point", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  status = put(run, "strobe_x", axis, "strobe", "position at drive phase 0, within one turn", w->x,
               w->x_error, n);
  if (status == PENDRES_OK)
    status = put(run, "strobe_v", axis, "strobe", "velocity at drive phase 0", w->v, w->v_error, n);
  if (status == PENDRES_OK) status = put_values(run, w);
  if (status == PENDRES_OK) status = put_bifurcations(run, w);
  if (status == PENDRES_OK) status = put_cascade(run, w);
  return status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void tabulate(FILE *out, const work *w)
{
  if (out == NULL) return;
  fprintf(out, "%-10s %-28s %s\n", "ends by", deck_axis_name(w->axis), "period after");
  for (size_t i = 0; i < w->path.jumps && i < TABLE_ROWS; i++) {
    const pendres_jump *j = &w->path.jump[i];
    fprintf(out, "%-10s %.14g +- %.0e  %d\n", pendres_jump_kind_name(j->kind), j->value,
            j->value_error, j->to_period);
  }
  if (w->cascade.doublings > 3)
    fprintf(out, "%d doublings accumulate at %.12g +- %.0e, ratio %.6f +- %.0e\n",
            w->cascade.doublings, w->cascade.limit, w->cascade.limit_error, w->cascade.ratio,
            w->cascade.ratio_error);
}

static pendres_status compute(scene_run *run, work *w)
{
  const farm_stage path = {.what = "sweeps", .tasks = 1, .record_size = 1, .task = follow,
                           .collect = collect_path, .arg = w};
  const farm_stage strobes = {.what = "values", .last = 1, .tasks = w->values + 1,
                              .record_size = 1, .task = find_strobes,
                              .collect = collect_strobes, .arg = w};
  const pendres_status status = scene_compute(run, &path);
  return status == PENDRES_OK ? scene_compute(run, &strobes) : status;
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck, .strobes = (size_t)run->deck->diagram.strobes};
  (void)deck_moving(run->deck, 1, &w.axis);
  w.values = run->deck->axis[w.axis].count;
  const size_t n = w.values * w.strobes;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  w.x = malloc(4 * n * sizeof *w.x);
  w.attractors = malloc(w.values * sizeof *w.attractors);
  if (w.x == NULL || w.attractors == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu points", n);
    goto done;
  }
  w.v = w.x + n;
  w.x_error = w.v + n;
  w.v_error = w.x_error + n;
  status = compute(run, &w);
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
done:
  free(w.x);
  free(w.attractors);
  scene_along_path_free(&w.path);
  return status;
}

static void plan(const deck *d, FILE *out)
{
  deck_axis_id axis = DECK_AXIS_DAMPING;
  (void)deck_moving(d, 1, &axis);
  const deck_axis *a = &d->axis[axis];
  fprintf(out, "%lld strobe points at each of %zu values of %s from %g to %g, which grows slowly;\n"
               "bifurcations on the way, and the cascade of doublings of the first orbit\n",
          (long long)d->diagram.strobes, a->count, deck_axis_name(axis), a->value[0],
          a->value[a->count - 1]);
}

const scene_kind scene_bifurcation_diagram = {
  .kind = DECK_BIFURCATION_DIAGRAM,
  .references = "G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996); M. J. Feigenbaum, Journal "
                "of Statistical Physics 19 (1978) 25",
  .plan = plan,
  .run = run_scene,
};
