/* ramp.c -- ramps beside quasi-static sweeps; see ramp.h. */
#include "scenes/ramp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/check.h"
#include "scenes/columns.h"
#include "scenes/failed.h"

/* The trajectories of a task: some blocks. */
enum { DIRECTIONS = 2, PART = 192 };

typedef struct work {
  const deck *d;
  const char *name;            /* of the parameter */
  pendres_ramp ramp;
  long *period;                /* its corners, */
  double *value;               /* and the values there */
  pendres_hysteresis_point *point; /* of the path, in its order */
  long every;                  /* drive periods between two points recorded */
  size_t points;               /* recorded each way */
  double *x, *v, *x_error, *v_error; /* [DIRECTIONS * points], both ways in the order of time */
  pendres_ramp_jump *jump;
  scene_verdict verdict;       /* of the ramp without noise */
  size_t trajectories;         /* 0: no noise */
  double *noisy;               /* [jumps][trajectories] values */
  pendres_ramp_summary *summary; /* [jumps] */
} work;

/* ---- the ramp ------------------------------------------------------------------------------ */

/* Drive periods of one way, a multiple of those between two points. */
static long periods_of(const deck *d, const deck_axis *a, long *every)
{
  const deck_numbers *p = &d->ramp.protocol;
  const double length = a->value[a->count - 1] - a->value[0];
  const double asked = p->count > 0 ? p->number[p->count - 2]
                                    : fmax(1.0, ceil(length / d->ramp.rate - 1e-6));
  *every = (long)ceil(asked / (double)d->ramp.points);
  return (long)ceil(asked / (double)*every) * *every;
}

/* The corners: up, and the same way back. */
static int lay_out(work *w, const deck_axis *a)
{
  const deck_numbers *p = &w->d->ramp.protocol;
  const long turn = periods_of(w->d, a, &w->every);
  const size_t listed = p->count / 2, way = listed > 0 ? listed + 1 : 2;
  size_t n = 0;
  w->points = (size_t)(turn / w->every) + 1;
  w->period = malloc(2 * way * sizeof *w->period);
  w->value = malloc(2 * way * sizeof *w->value);
  if (w->period == NULL || w->value == NULL) return 0;
  for (size_t i = 0; i < listed; i++, n++) {
    w->period[n] = (long)p->number[2 * i];
    w->value[n] = p->number[2 * i + 1];
  }
  if (listed == 0) {
    w->period[n] = 0;
    w->value[n++] = a->value[0];
  }
  if (w->period[n - 1] < turn) { /* on to a whole number of points */
    w->period[n] = turn;
    w->value[n++] = listed > 0 ? a->value[a->count - 1]
                               : a->value[0] + w->d->ramp.rate * (double)turn;
  }
  const size_t up = n;
  for (size_t i = up - 1; i-- > 0; n++) {
    w->period[n] = 2 * turn - w->period[i];
    w->value[n] = w->value[i];
  }
  w->ramp.corners = n;
  w->ramp.period = w->period;
  w->ramp.value = w->value;
  return 1;
}

static pendres_status prepare(work *w, deck_axis_id axis, const scene_along_path *path)
{
  const deck *d = w->d;
  const deck_axis *a = &d->axis[axis];
  const size_t n = path->points, half = n / DIRECTIONS;
  w->name = deck_axis_name(axis);
  w->ramp = (pendres_ramp){.pendulum = scene_along_pendulum(d),
                           .parameter = scene_parameter_of(axis)->parameter, .points = n,
                           .jumps = path->jumps, .jump = path->jump};
  w->trajectories = deck_has_noise(d) ? (size_t)d->noise.trajectories : 0;
  if (w->trajectories > 0) w->ramp.pendulum.temperature = d->axis[DECK_AXIS_TEMPERATURE].value[0];
  if (!lay_out(w, a)) return PENDRES_OUT_OF_MEMORY;
  w->point = malloc(n * sizeof *w->point);
  w->x = malloc(4 * DIRECTIONS * w->points * sizeof *w->x);
  w->jump = calloc(path->jumps + 1, sizeof *w->jump);
  w->noisy = malloc((path->jumps * w->trajectories + 1) * sizeof *w->noisy);
  w->summary = calloc(path->jumps + 1, sizeof *w->summary);
  if (w->point == NULL || w->x == NULL || w->jump == NULL || w->noisy == NULL ||
      w->summary == NULL)
    return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < half; i++) {
    w->point[i] = path->point[i];
    w->point[n - 1 - i] = path->point[half + i];
  }
  w->ramp.point = w->point;
  w->v = w->x + DIRECTIONS * w->points;
  w->x_error = w->v + DIRECTIONS * w->points;
  w->v_error = w->x_error + DIRECTIONS * w->points;
  return PENDRES_OK;
}

static void clear(work *w)
{
  free(w->period);
  free(w->value);
  free(w->point);
  free(w->x);
  free(w->jump);
  free(w->noisy);
  free(w->summary);
}

/* ---- tasks --------------------------------------------------------------------------------- */

/* A record: the jumps, then x, v and their errors, and what became of it. The turning point is one
   strobe of both ways. */
static size_t samples(const work *w)
{
  return DIRECTIONS * (w->points - 1) + 1;
}

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  const size_t n = samples(w);
  (void)task;
  pendres_ramp_jump *jump = out->data;
  double *x = (double *)(jump + w->ramp.jumps);
  const pendres_ramp_record record = {.every = w->every, .x = x, .v = x + n, .x_error = x + 2 * n,
                                      .v_error = x + 3 * n};
  pendres_status status = pendres_ramp_follow(ctx, &w->ramp, &record, jump);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  for (size_t k = 0; k < w->ramp.jumps; k++)
    jump[k] = (pendres_ramp_jump){.time = NAN, .value = NAN, .value_error = NAN, .delay = NAN,
                                  .delay_error = NAN};
  for (size_t k = 0; k < 4 * n; k++) x[k] = NAN;
  return scene_verdict_note((scene_verdict *)(x + 4 * n), status, pendres_context_message(ctx));
}

static size_t bytes_of(const work *w)
{
  return w->ramp.jumps * sizeof *w->jump + 4 * samples(w) * sizeof(double) + sizeof w->verdict;
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  scene_verdict v;
  (void)task;
  if (in->size != bytes_of(w)) return 0;
  memcpy(&v, (const char *)in->data + in->size - sizeof v, sizeof v);
  return scene_check_verdict(&v);
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const size_t n = samples(w), points = w->points;
  const pendres_ramp_jump *jump = in->data;
  const double *x = (const double *)(jump + w->ramp.jumps);
  double *const to[4] = {w->x, w->v, w->x_error, w->v_error};
  (void)task;
  memcpy(&w->verdict, x + 4 * n, sizeof w->verdict);
  memcpy(w->jump, jump, w->ramp.jumps * sizeof *jump);
  for (int k = 0; k < 4; k++) {
    memcpy(to[k], x + (size_t)k * n, points * sizeof *x);
    memcpy(to[k] + points, x + (size_t)k * n + points - 1, points * sizeof *x);
  }
  return PENDRES_OK;
}

/* Trajectories of a task: number of the first, and how many. */
static size_t part_of(const work *w, size_t task, size_t *first)
{
  *first = task * PART;
  return w->trajectories - *first < PART ? w->trajectories - *first : PART;
}

static pendres_status scatter(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  size_t first;
  const size_t n = part_of(w, task, &first), jumps = w->ramp.jumps;
  double *value = farm_record_resize(out, (2 * jumps * n + 1) * sizeof *value);
  if (value == NULL) return PENDRES_OUT_OF_MEMORY;
  return pendres_ramp_scatter(ctx, &w->ramp, n, first, value + jumps * n, value);
}

static int check_part(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  size_t first;
  return in->size == (2 * w->ramp.jumps * part_of(w, task, &first) + 1) * sizeof(double);
}

static pendres_status collect_part(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  size_t first;
  const size_t n = part_of(w, task, &first);
  for (size_t k = 0; k < w->ramp.jumps; k++)
    memcpy(w->noisy + k * w->trajectories + first, (const double *)in->data + k * n,
           n * sizeof *w->noisy);
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

static pendres_status put_way(scene_run *run, const work *w)
{
  const size_t n = DIRECTIONS * w->points;
  const char *dimensions[2] = {"direction", "point"};
  double *time = malloc(2 * n * sizeof *time), *value = time + n;
  if (time == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory: %zu points", n);
  for (size_t i = 0; i < n; i++) {
    const size_t strobe = i < w->points ? i : i - 1;
    time[i] = (double)((long)strobe * w->every);
    value[i] = pendres_ramp_value(&w->ramp, time[i]);
  }
  pendres_store_spec spec = {.name = "ramp_time", .units = "1",
                             .long_name = "drive periods since the ramp's start"};
  memcpy(spec.dimensions, dimensions, sizeof dimensions);
  pendres_status status =
    scene_numbering(run, "point", w->points, "number of the point of a way");
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &spec, time, NULL, n);
  spec.name = "ramp_parameter";
  spec.long_name = "value of the parameter that moves";
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &spec, value, NULL, n);
  spec.name = "ramp_x";
  spec.long_name = "position at the strobe, without noise";
  spec.units = "rad";
  if (status == PENDRES_OK)
    status = pendres_store_put(run->store, &spec, w->x, w->x_error, n);
  spec.name = "ramp_v";
  spec.long_name = "velocity at the strobe, without noise";
  spec.units = "1";
  if (status == PENDRES_OK)
    status = pendres_store_put(run->store, &spec, w->v, w->v_error, n);
  free(time);
  return scene_stored(run, status);
}

/* What the pendulum does at a point of the ramp. */
static const char *state_names(int value)
{
  static const char *const names[] = {"followed", "escape", "failed"};
  return value >= 0 && value < 3 ? names[value] : NULL;
}

static pendres_status put_states(scene_run *run, const work *w)
{
  static const scene_column column = {
    .name = "ramp_state", .type = SCENE_FLAG, .names = state_names,
    .long_name = "whether the ramp's pendulum is still there, without noise"};
  const size_t n = DIRECTIONS * w->points;
  const int failed = w->verdict.reason != SCENE_FAILURE_NONE;
  int *state = malloc(n * sizeof *state);
  if (state == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory: %zu points", n);
  for (size_t i = 0; i < n; i++) state[i] = failed ? 2 : isnan(w->x[i]);
  const scene_table table = {.dimensions = {"direction", "point"}, .n = n, .stride = sizeof *state,
                             .rows = state};
  const pendres_status status = scene_columns_write(run, &table, 1, &column);
  free(state);
  if (!failed) return status;
  run->failed_points++;
  scene_failure_tell(run, (scene_failure)w->verdict.reason, w->verdict.words,
                     "the ramp of %s in real time", w->name);
  return status;
}

static pendres_status put_delays(scene_run *run, const work *w)
{
  static const scene_column columns[] = {
    {.name = "jump_delay", .units = "1", .value = offsetof(pendres_ramp_jump, delay),
     .error = offsetof(pendres_ramp_jump, delay_error),
     .long_name = "how far beyond the state's end the ramp's pendulum leaves it, without noise"},
    {.name = "jump_ramp_parameter", .units = "1", .value = offsetof(pendres_ramp_jump, value),
     .error = offsetof(pendres_ramp_jump, value_error),
     .long_name = "value at which the ramp's pendulum leaves the state, without noise"},
    {.name = "jump_ramp_time", .units = "1", .type = SCENE_PLAIN,
     .value = offsetof(pendres_ramp_jump, time),
     .long_name = "drive periods since the ramp's start until then"},
  };
  const scene_table table = {.dimensions = {"jump"}, .n = w->ramp.jumps,
                             .stride = sizeof *w->jump, .rows = w->jump};
  return SCENE_WRITE(run, &table, columns);
}

static pendres_status put_scatter(scene_run *run, const work *w)
{
  static const scene_column columns[] = {
    {.name = "jump_mean", .units = "1", .value = offsetof(pendres_ramp_summary, mean),
     .error = offsetof(pendres_ramp_summary, mean_error),
     .long_name = "mean over noisy trajectories of the value at which they leave the state"},
    {.name = "jump_deviation", .units = "1", .value = offsetof(pendres_ramp_summary, deviation),
     .error = offsetof(pendres_ramp_summary, deviation_error),
     .long_name = "standard deviation of that value"},
    {.name = "jump_count", .type = SCENE_COUNT, .value = offsetof(pendres_ramp_summary, count),
     .long_name = "trajectories that leave the state"},
  };
  const scene_table table = {.dimensions = {"jump"}, .n = w->ramp.jumps,
                             .stride = sizeof *w->summary, .rows = w->summary};
  const pendres_store_spec spec = {
    .name = "jump_noisy_parameter", .dimensions = {"jump", "trajectory"}, .units = "1",
    .long_name = "value at which each noisy trajectory leaves the state; NaN: it does not"};
  pendres_status status =
    scene_numbering(run, "trajectory", w->trajectories, "number of the noisy trajectory");
  if (status == PENDRES_OK)
    status = scene_stored(run, pendres_store_put(run->store, &spec, w->noisy, NULL,
                                                 w->ramp.jumps * w->trajectories));
  return status == PENDRES_OK ? SCENE_WRITE(run, &table, columns) : status;
}

static void tabulate(FILE *out, const work *w)
{
  enum { LINES = 40 };
  if (out == NULL || w->ramp.jumps == 0) return;
  fprintf(out, "\nin real time:\n%-5s %-30s %s\n", "way", "delay",
          w->trajectories > 0 ? "with noise: mean, standard deviation, trajectories" : "");
  for (size_t k = 0; k < w->ramp.jumps && k < LINES; k++) {
    const pendres_ramp_jump *j = &w->jump[k];
    const pendres_ramp_summary *s = &w->summary[k];
    char delay[60] = "not seen";
    if (!isnan(j->delay)) snprintf(delay, sizeof delay, "%.8g +- %.0e", j->delay, j->delay_error);
    fprintf(out, "%-5s %-30s", w->ramp.jump[k].direction > 0 ? "up" : "down", delay);
    if (s->count > 1)
      fprintf(out, " %.7g +- %.0e, %.3g +- %.0e, %zu", s->mean, s->mean_error, s->deviation,
              s->deviation_error, s->count);
    fputc('\n', out);
  }
}

/* ---- all of it ----------------------------------------------------------------------------- */

static pendres_status compute(scene_run *run, work *w)
{
  const size_t tasks = (w->trajectories + PART - 1) / PART;
  const farm_stage ramp = {
    .what = "ramps", .tasks = 1, .task = follow, .check = check, .collect = collect, .arg = w,
    .record_size = bytes_of(w)};
  const farm_stage noise = {.what = "parts of the noisy trajectories", .tasks = tasks,
                            .record_size = 1, .last = 1, .task = scatter,
                            .check = check_part, .collect = collect_part, .arg = w};
  pendres_status status = scene_compute(run, &ramp);
  const int failed = w->verdict.reason != SCENE_FAILURE_NONE;
  for (size_t k = 0; k < w->ramp.jumps * w->trajectories; k++) w->noisy[k] = NAN;
  if (status != PENDRES_OK || tasks == 0 || w->ramp.jumps == 0 || failed) return status;
  status = scene_compute(run, &noise);
  for (size_t k = 0; k < w->ramp.jumps && status == PENDRES_OK; k++)
    status = pendres_ramp_summarize(w->trajectories, w->noisy + k * w->trajectories,
                                    &w->summary[k]);
  return status;
}

pendres_status scene_ramp_run(scene_run *run, deck_axis_id axis, const scene_along_path *path)
{
  work w = {.d = run->deck};
  if (!deck_has_ramp(run->deck)) return PENDRES_OK;
  pendres_status status = prepare(&w, axis, path);
  if (status != PENDRES_OK) (void)scene_fail(run, status, "out of memory for a ramp");
  if (status == PENDRES_OK) status = compute(run, &w);
  if (status == PENDRES_OK) status = put_way(run, &w);
  if (status == PENDRES_OK) status = put_states(run, &w);
  if (status == PENDRES_OK) status = put_delays(run, &w);
  if (status == PENDRES_OK && w.trajectories > 0) status = put_scatter(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
  clear(&w);
  return status;
}

void scene_ramp_describe(const deck *d, deck_axis_id axis, FILE *out)
{
  long every = 0;
  if (!deck_has_ramp(d)) return;
  const long periods = DIRECTIONS * periods_of(d, &d->axis[axis], &every);
  fprintf(out, "then the same in real time, over %ld drive periods", periods);
  if (deck_has_noise(d))
    fprintf(out, ", and %lld trajectories at temperature %g, %.3g pendulum-periods",
            (long long)d->noise.trajectories, d->axis[DECK_AXIS_TEMPERATURE].value[0],
            (double)d->noise.trajectories * (double)periods);
  fprintf(out, "\n");
}
