/*
 * hysteresis.c -- one parameter swept slowly, up and then down, from a stated state: what an
 * experimenter sees. One task: each value is approached from the one before.
 */
#include <stdlib.h>

#include "scenes/along.h"
#include "scenes/failed.h"
#include "scenes/ramp.h"

enum { DIRECTIONS = 2, TABLE_JUMPS = 40 };

typedef struct work {
  const deck *d;
  deck_axis_id axis;
  size_t values; /* of the axis */
  scene_along_path path; /* points [direction][values], values as in the axis */
} work;

/* ---- computing ----------------------------------------------------------------------------- */

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  const deck_axis *a = &w->d->axis[w->axis];
  const size_t n = DIRECTIONS * w->values;
  double *path = malloc(n * sizeof *path);
  (void)task;
  if (path == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < w->values; i++) path[i] = path[n - 1 - i] = a->value[i];
  const scene_along_way way = {w->axis, n, path};
  const pendres_status status = scene_along_follow(w->d, &way, ctx, out);
  free(path);
  return status;
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  (void)task;
  return scene_along_check(in, DIRECTIONS * w->values);
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  (void)task;
  const pendres_status status = scene_along_take(in, &w->path);
  if (status != PENDRES_OK) return status;
  /* The way back is stored in the order of the axis. */
  pendres_hysteresis_point *back = w->path.point + w->values;
  for (size_t i = 0; i < w->values / 2; i++) {
    const pendres_hysteresis_point kept = back[i];
    back[i] = back[w->values - 1 - i];
    back[w->values - 1 - i] = kept;
  }
  return PENDRES_OK;
}

/* ---- results ------------------------------------------------------------------------------- */

static const scene_column of_points[] = {
  SCENE_ALONG_COLUMN(mean_velocity, mean_velocity, "mean velocity of x", "1"),
  SCENE_COLUMN(scene_along_row, period, "drive periods until the orbit closes", "1"),
  SCENE_COLUMN(scene_along_row, winding, "whole turns until the orbit closes", "1"),
  SCENE_ALONG_COLUMN(lyapunov, attractor.lyapunov, "largest Lyapunov exponent a unit time", "1"),
};

static const char *const directions[DIRECTIONS] = {"up", "down"};

static const char *direction_names(int value)
{
  return value < DIRECTIONS ? directions[value] : NULL;
}

static const char *gradual_names(int value)
{
  return value == 0 ? "jump" : value == 1 ? "gradual" : NULL;
}

static const char *certain_names(int value)
{
  return value == 0 ? "uncertain" : value == 1 ? "certain" : NULL;
}

static const scene_column of_jumps[] = {
  SCENE_COLUMN(scene_along_jump, parameter, "value at which the state ends", "1"),
  SCENE_COLUMN(scene_along_jump, period, "drive periods of the orbit jumped to", "1"),
  SCENE_COLUMN(scene_along_jump, share, "share of the trials that went to that state", "1"),
  SCENE_CODE(scene_along_jump, direction, "way in which the parameter goes", direction_names),
  SCENE_CODE(scene_along_jump, kind, "bifurcation that ends the state", scene_jump_names),
  SCENE_CODE(scene_along_jump, from, "state that ends", scene_motion_names),
  SCENE_CODE(scene_along_jump, to, "state that the pendulum goes to", scene_motion_names),
  SCENE_CODE(scene_along_jump, gradual, "whether the new state grows out of the old one",
             gradual_names),
  SCENE_CODE(scene_along_jump, certain, "whether all trials went to the same state",
             certain_names),
};

static pendres_status write_points(scene_run *run, const work *w)
{
  scene_along_row *rows = scene_along_rows(run, &w->path);
  const scene_table table = {.dimensions = {"direction", deck_axis_name(w->axis)},
                             .n = w->path.points, .stride = sizeof *rows, .rows = rows};
  if (rows == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_status status =
    scene_columns_write_orbits(run, &table, offsetof(scene_along_row, of.attractor.orbit));
  if (status == PENDRES_OK) status = SCENE_WRITE(run, &table, of_points);
  if (status == PENDRES_OK)
    status = scene_along_write_verdicts(run, &w->path, &table);
  scene_along_tell(run, w->axis, &w->path, DIRECTIONS);
  return status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void tabulate(FILE *out, const work *w)
{
  if (out == NULL) return;
  fprintf(out, "%-5s %-9s %-28s %-11s %-11s %s\n", "way", "ends by", deck_axis_name(w->axis),
          "from", "to", "period");
  for (size_t i = 0; i < w->path.jumps && i < TABLE_JUMPS; i++) {
    const pendres_jump *j = &w->path.jump[i];
    fprintf(out, "%-5s %-9s %.14g +- %.0e  %-11s %-11s %d%s%s\n", j->direction > 0 ? "up" : "down",
            pendres_name_get(PENDRES_NAMES_JUMP, j->kind), j->value, j->value_error,
            pendres_name_get(PENDRES_NAMES_LABEL, j->from),
            pendres_name_get(PENDRES_NAMES_LABEL, j->to), j->to_period,
            j->gradual ? ", gradual" : "", j->certain ? "" : ", uncertain");
  }
  if (scene_along_uncertain(&w->path))
    fprintf(out, "uncertain: errors as small as rounding choose the state that it begins on\n");
  if (w->path.jumps == 0) fprintf(out, "the state does not end within the range\n");
  if (w->path.jumps > TABLE_JUMPS) fprintf(out, "and %zu more\n", w->path.jumps - TABLE_JUMPS);
}

static pendres_status write_all(scene_run *run, const work *w)
{
  pendres_status status = pendres_store_dimension(
    run->store,
    &(pendres_store_spec){.name = "direction", .type = PENDRES_STORE_STRING,
                          .long_name = "way in which the parameter goes"}, DIRECTIONS, directions);
  (void)scene_stored(run, status);
  if (status == PENDRES_OK) status = scene_dimension(run, NULL, w->axis);
  if (status == PENDRES_OK) status = write_points(run, w);
  return status == PENDRES_OK ? SCENE_ALONG_WRITE_JUMPS(run, &w->path, "jump", of_jumps) : status;
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck};
  w.values = scene_along_axis(run->deck, &w.axis)->count;
  const farm_stage stage = {.what = "sweeps", .tasks = 1, .record_size = 1,
                            .task = follow, .check = check, .collect = collect, .arg = &w};
  pendres_status status = scene_compute(run, &stage);
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
  if (status == PENDRES_OK) status = scene_ramp_run(run, w.axis, &w.path);
  scene_along_path_free(&w.path);
  return status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis;
  const deck_axis *a = scene_along_axis(d, &axis);
  fprintf(out, "the state of a pendulum while %s goes slowly from %g to %g and back,\n"
               "at %zu values each way, and the jumps on the way; ",
          deck_axis_name(axis), a->value[0], a->value[a->count - 1], a->count);
  if (d->orbit.start[0] != '\0') fprintf(out, "it starts on attractor '%s'\n", d->orbit.start);
  else fprintf(out, "it starts at x = %g, v = %g\n", d->orbit.x, d->orbit.v);
  scene_ramp_describe(d, axis, out);
}

const scene_kind scene_hysteresis = {
  .kind = DECK_HYSTERESIS,
  .references = "Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, chapter 4; J. M. T. "
                "Thompson and M. S. Soliman, Proceedings of the Royal Society A 432 (1991) 101",
  .budget = 1,
  .size = {40e3, 240.0, 60e3, 1.0, 1.0, 0.03},
  .describe = describe,
  .run = run_scene,
};
