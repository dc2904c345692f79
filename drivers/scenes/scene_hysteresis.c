/*
 * scene_hysteresis.c -- one parameter swept slowly, up and then down, from a stated state: what an
 * experimenter sees. One task: each value is approached from the one before.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_along.h"
#include "scenes/scene_failed.h"

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
  const pendres_status status = scene_along_follow(w->d, w->axis, n, path, ctx, out);
  free(path);
  return status;
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

/* ---- writing the points -------------------------------------------------------------------- */

/* The quantities of a point with their errors. */
enum { AMPLITUDE, PHASE_LAG, LOOP_AREA, MEAN_VELOCITY, PERIOD, WINDING, LYAPUNOV, QUANTITIES };

static const struct {
  const char *name, *long_name, *units;
} quantities[QUANTITIES] = {
  {"amplitude", "half peak to peak of the angle", "rad"},
  {"phase_lag", "lag of the first harmonic behind the drive", "rad"},
  {"loop_area", "area of the hysteresis loop, a drive cycle", "1"},
  {"mean_velocity", "mean velocity of x", "1"},
  {"period", "drive periods until the orbit closes", "1"},
  {"winding", "whole turns until the orbit closes", "1"},
  {"lyapunov", "largest Lyapunov exponent a unit time", "1"},
};

static void values_of(const pendres_hysteresis_point *p, double value[QUANTITIES],
                      double error[QUANTITIES])
{
  const pendres_orbit *o = &p->attractor.orbit;
  const double closed = scene_along_closed(p) ? 0.0 : NAN;
  const double v[QUANTITIES] = {o->amplitude, o->phase_lag, o->loop_area, p->mean_velocity,
                                o->period + closed, o->winding + closed, p->attractor.lyapunov};
  const double e[QUANTITIES] = {o->amplitude_error, o->phase_lag_error, o->loop_area_error,
                                p->mean_velocity_error, closed, closed,
                                p->attractor.lyapunov_error};
  memcpy(value, v, sizeof v);
  memcpy(error, e, sizeof e);
}

static pendres_status put_quantities(scene_run *run, const work *w)
{
  const size_t n = DIRECTIONS * w->values;
  double *value = malloc(2 * n * sizeof *value);
  pendres_status status = PENDRES_OK;
  if (value == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", n);
  for (int q = 0; q < QUANTITIES && status == PENDRES_OK; q++) {
    const pendres_store_spec spec = {.name = quantities[q].name,
                                     .dimensions = {"direction", deck_axis_name(w->axis)},
                                     .long_name = quantities[q].long_name,
                                     .units = quantities[q].units};
    for (size_t i = 0; i < n; i++) {
      double values[QUANTITIES], errors[QUANTITIES];
      values_of(&w->path.point[i], values, errors);
      value[i] = values[q];
      value[n + i] = errors[q];
    }
    status = pendres_store_put_result(run->store, &spec, value, value + n, n);
  }
  free(value);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

/* ---- writing the jumps --------------------------------------------------------------------- */

/* A code of each jump. */
static pendres_status put_codes(scene_run *run, const work *w, const pendres_store_spec *spec,
                                int8_t (*code_of)(const pendres_jump *j))
{
  int8_t *code = malloc(w->path.jumps + 1);
  if (code == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu jumps", w->path.jumps);
  for (size_t i = 0; i < w->path.jumps; i++) code[i] = code_of(&w->path.jump[i]);
  const pendres_status status = pendres_store_put(run->store, spec, code, w->path.jumps);
  free(code);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static int8_t direction_of(const pendres_jump *j)
{
  return (int8_t)(j->direction < 0);
}

static int8_t kind_of(const pendres_jump *j)
{
  return (int8_t)j->kind;
}

static int8_t from_of(const pendres_jump *j)
{
  return (int8_t)j->from;
}

static int8_t to_of(const pendres_jump *j)
{
  return (int8_t)j->to;
}

static int8_t gradual_of(const pendres_jump *j)
{
  return (int8_t)j->gradual;
}

static int8_t certain_of(const pendres_jump *j)
{
  return (int8_t)j->certain;
}

static pendres_status put_jump_codes(scene_run *run, const work *w)
{
  static const char *const directions[] = {"up", "down"};
  static const char *const ways[] = {"jump", "gradual"};
  static const char *const certainties[] = {"uncertain", "certain"};
  const char *kinds[PENDRES_JUMP_COUNT];
  for (int i = 0; i < PENDRES_JUMP_COUNT; i++)
    kinds[i] = pendres_jump_kind_name((pendres_jump_kind)i);
  struct {
    pendres_store_spec spec;
    int8_t (*code_of)(const pendres_jump *j);
  } codes[] = {
    {{.name = "jump_direction", .long_name = "way in which the parameter goes", .flag_count = 2,
      .flag_meanings = directions}, direction_of},
    {{.name = "jump_kind", .long_name = "bifurcation that ends the state",
      .flag_count = PENDRES_JUMP_COUNT, .flag_meanings = kinds}, kind_of},
    {{.name = "jump_from", .long_name = "state that ends"}, from_of},
    {{.name = "jump_to", .long_name = "state that the pendulum goes to"}, to_of},
    {{.name = "jump_gradual", .long_name = "whether the new state grows out of the old one",
      .flag_count = 2, .flag_meanings = ways}, gradual_of},
    {{.name = "jump_certain", .long_name = "whether all trials went to the same state",
      .flag_count = 2, .flag_meanings = certainties}, certain_of},
  };
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof codes / sizeof *codes && status == PENDRES_OK; k++) {
    codes[k].spec.type = PENDRES_STORE_INT8;
    codes[k].spec.dimensions[0] = "jump";
    if (codes[k].spec.flag_count == 0) scene_along_label_flags(&codes[k].spec);
    status = put_codes(run, w, &codes[k].spec, codes[k].code_of);
  }
  return status;
}

static pendres_status put_jumps(scene_run *run, const work *w)
{
  const size_t n = w->path.jumps;
  double *value = malloc((6 * n + 1) * sizeof *value);
  if (value == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu jumps", n);
  double *error = value + n, *share = error + n, *period = share + n, *no_error = period + n;
  for (size_t i = 0; i < n; i++) {
    const pendres_jump *j = &w->path.jump[i];
    value[i] = j->value;
    error[i] = j->value_error;
    share[i] = j->share;
    period[i] = j->to_period > 0 ? j->to_period : NAN;
    no_error[i] = j->to_period > 0 ? 0.0 : NAN;
    /* Of a share of trials: the binomial standard error. */
    no_error[n + i] = sqrt(j->share * (1.0 - j->share) / PENDRES_HYSTERESIS_TRIALS);
  }
  const pendres_store_spec parameter = {.name = "jump_parameter", .dimensions = {"jump"},
                                        .long_name = "value at which the state ends"};
  const pendres_store_spec where = {.name = "jump_period", .dimensions = {"jump"},
                                    .long_name = "drive periods of the orbit jumped to"};
  const pendres_store_spec shares = {.name = "jump_share", .dimensions = {"jump"},
                                     .long_name = "share of the trials that went to that state"};
  pendres_status status =
    pendres_store_dimension(run->store, NULL, "jump", n, NULL, "number of the jump", "1");
  if (status == PENDRES_OK)
    status = pendres_store_put_result(run->store, &parameter, value, error, n);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(run->store, &where, period, no_error, n);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(run->store, &shares, share, no_error + n, n);
  free(value);
  return status == PENDRES_OK ? put_jump_codes(run, w) : scene_store_failed(run, status);
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
            pendres_jump_kind_name(j->kind), j->value, j->value_error,
            pendres_label_name(j->from), pendres_label_name(j->to), j->to_period,
            j->gradual ? ", gradual" : "", j->certain ? "" : ", uncertain");
  }
  if (w->path.jumps == 0) fprintf(out, "the state does not end within the range\n");
  if (w->path.jumps > TABLE_JUMPS) fprintf(out, "and %zu more\n", w->path.jumps - TABLE_JUMPS);
}

static pendres_status write_all(scene_run *run, const work *w)
{
  static const char *const directions[DIRECTIONS] = {"up", "down"};
  pendres_status status = pendres_store_dimension_text(
    run->store, NULL, "direction", DIRECTIONS, directions, "way in which the parameter goes");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  status = scene_dimension(run, NULL, w->axis);
  if (status == PENDRES_OK) status = put_quantities(run, w);
  if (status == PENDRES_OK) status = scene_along_write_labels(run, w->axis, &w->path, DIRECTIONS);
  if (status == PENDRES_OK) status = put_jumps(run, w);
  return status;
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck};
  (void)deck_moving(run->deck, 1, &w.axis);
  w.values = run->deck->axis[w.axis].count;
  const farm_stage stage = {.what = "sweeps", .tasks = 1, .record_size = 1,
                            .task = follow, .collect = collect, .arg = &w};
  pendres_status status = scene_compute(run, &stage);
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
  scene_along_path_free(&w.path);
  return status;
}

static void plan(const deck *d, FILE *out)
{
  deck_axis_id axis = DECK_AXIS_DAMPING;
  (void)deck_moving(d, 1, &axis);
  const deck_axis *a = &d->axis[axis];
  fprintf(out, "the state of a pendulum while %s goes slowly from %g to %g and back,\n"
               "at %zu values each way, and the jumps on the way; ",
          deck_axis_name(axis), a->value[0], a->value[a->count - 1], a->count);
  if (d->orbit.start[0] != '\0') fprintf(out, "it starts on attractor '%s'\n", d->orbit.start);
  else fprintf(out, "it starts at x = %g, v = %g\n", d->orbit.x, d->orbit.v);
}

const scene_kind scene_hysteresis = {
  .kind = DECK_HYSTERESIS,
  .references = "Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, chapter 4; J. M. T. "
                "Thompson and M. S. Soliman, Proceedings of the Royal Society A 432 (1991) 101",
  .plan = plan,
  .run = run_scene,
};
