/* ramp.c -- ramps beside quasi-static sweeps; see along.h. */
#include "scenes/along.h"

#include <math.h>
#include <string.h>

#include "scenes/points.h"

/* A strobe of the ramp without noise. */
typedef struct row {
  double time, value, x, x_error, v, v_error;
  int state;
} row;

typedef struct work {
  const deck *d;
  const char *name;            /* of the parameter */
  pendres_ramp ramp;
  long *period;                /* its corners, */
  double *value;               /* and the values there */
  long every;                  /* drive periods between two points recorded */
  size_t points;               /* recorded each way */
  scene_points way;            /* one: all of the ramp, taken apart into: */
  row *rows;                   /* [SCENE_DIRECTIONS][points], both ways in the order of time */
  pendres_ramp_jump *jump;
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
static void lay_out(scene_run *run, work *w, const deck_axis *a)
{
  const deck_numbers *p = &w->d->ramp.protocol;
  const long turn = periods_of(w->d, a, &w->every);
  const size_t listed = p->count / 2, way = listed > 0 ? listed + 1 : 2;
  size_t n = 0;
  w->points = (size_t)(turn / w->every) + 1;
  w->period = scene_array(run, 2 * way, sizeof *w->period);
  w->value = scene_array(run, 2 * way, sizeof *w->value);
  if (!scene_going(run)) return;
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
}

static void prepare(scene_run *run, work *w, deck_axis_id axis, const scene_along_path *path)
{
  const deck *d = w->d;
  const size_t n = path->points, half = n / SCENE_DIRECTIONS;
  w->name = deck_axis_name(axis);
  w->ramp = (pendres_ramp){.pendulum = deck_pendulum(d),
                           .parameter = deck_axis_parameter(axis), .points = n,
                           .jumps = path->jumps, .jump = path->jump};
  w->trajectories = deck_has_noise(d) ? (size_t)d->noise.trajectories : 0;
  if (w->trajectories > 0) w->ramp.pendulum.temperature = d->axis[DECK_AXIS_TEMPERATURE].value[0];
  lay_out(run, w, &d->axis[axis]);
  pendres_hysteresis_point *point = scene_array(run, n, sizeof *point);
  w->rows = scene_array(run, SCENE_DIRECTIONS * w->points, sizeof *w->rows);
  w->jump = scene_array(run, path->jumps, sizeof *w->jump);
  w->noisy = scene_array(run, path->jumps * w->trajectories, sizeof *w->noisy);
  w->summary = scene_array(run, path->jumps, sizeof *w->summary);
  if (!scene_going(run)) return;
  for (size_t i = 0; i < half; i++) { /* in the order of the path */
    point[i] = path->point[i];
    point[n - 1 - i] = path->point[half + i];
  }
  w->ramp.point = point;
}

/* ---- tasks --------------------------------------------------------------------------------- */

/* A record: the jumps, then x, v and their errors. The turning point is one strobe of both ways. */
static size_t samples(const work *w)
{
  return SCENE_DIRECTIONS * (w->points - 1) + 1;
}

static pendres_status follow(const scene_some *some)
{
  const work *w = some->of->arg;
  const size_t n = samples(w);
  pendres_ramp_jump *jump = some->rows;
  double *x = (double *)(jump + w->ramp.jumps);
  const pendres_ramp_record record = {.every = w->every, .x = x, .v = x + n, .x_error = x + 2 * n,
                                      .v_error = x + 3 * n};
  return pendres_ramp_find(some->ctx, &w->ramp, &record, jump);
}

static void leave_out(const scene_points *p, size_t point, void *out)
{
  const work *w = p->arg;
  pendres_ramp_jump *jump = out;
  double *x = (double *)(jump + w->ramp.jumps);
  (void)point;
  for (size_t k = 0; k < w->ramp.jumps; k++)
    jump[k] = (pendres_ramp_jump){.time = NAN, .value = NAN, .value_error = NAN, .delay = NAN,
                                  .delay_error = NAN};
  for (size_t k = 0; k < 4 * samples(w); k++) x[k] = NAN;
}

/* What the pendulum does at a point of the ramp. */
enum { FOLLOWED, ESCAPED, FAILED };

SCENE_NAMES(state_names, "followed", "escape", "failed")

static pendres_status collect(const scene_points *p, size_t first, size_t n, const void *in)
{
  work *w = p->arg;
  const pendres_ramp_jump *jump = in;
  const double *x = (const double *)(jump + w->ramp.jumps);
  const size_t all = samples(w);
  const int failed = p->failed[0].reason != SCENE_FAILURE_NONE;
  (void)first;
  (void)n;
  memcpy(w->jump, jump, w->ramp.jumps * sizeof *jump);
  for (size_t i = 0; i < SCENE_DIRECTIONS * w->points; i++) {
    const size_t k = i < w->points ? i : i - 1;
    const double time = (double)((long)k * w->every);
    w->rows[i] = (row){time, pendres_ramp_value(&w->ramp, time), x[k], x[2 * all + k], x[all + k],
                       x[3 * all + k], failed ? FAILED : isnan(x[k]) ? ESCAPED : FOLLOWED};
  }
  return PENDRES_OK;
}

/* Noisy trajectories: of each, the values at which it leaves the states. */
static pendres_status scatter(const scene_some *some)
{
  const work *w = some->of->arg;
  const size_t n = some->n, jumps = w->ramp.jumps;
  double *row = some->rows, *value = scene_room_take(some->room, 2 * jumps * n, sizeof *value);
  if (value == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status =
    pendres_ramp_scatter(some->ctx, &w->ramp, n, some->first, value + jumps * n, value);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < jumps; k++) row[i * jumps + k] = value[k * n + i];
  return status;
}

static pendres_status collect_scatter(const scene_points *p, size_t first, size_t n,
                                      const void *rows)
{
  const work *w = p->arg;
  const double *row = rows;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < w->ramp.jumps; k++)
      w->noisy[k * w->trajectories + first + i] = row[i * w->ramp.jumps + k];
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

static void put_way(scene_run *run, const work *w)
{
  static const scene_column columns[] = {
    SCENE_COLUMN_OF(SCENE_PLAIN, row, time, "drive periods since the ramp's start"),
    {SCENE_TYPED(SCENE_PLAIN, "parameter", row, value, NULL)},
    SCENE_COLUMN(row, x, "position at the strobe, without noise"),
    SCENE_COLUMN(row, v, "velocity at the strobe, without noise"),
    SCENE_CODE(row, state, "whether the ramp's pendulum is still there, without noise",
               state_names),
  };
  const scene_table table = {.dimensions = {"direction", "point"}, .prefix = "ramp",
                             SCENE_ROWS(w->rows, SCENE_DIRECTIONS * w->points)};
  scene_numbering(run, "point", w->points, "number of the point of a way");
  SCENE_WRITE(run, &table, columns);
  if (!scene_going(run) || w->way.failed[0].reason == SCENE_FAILURE_NONE) return;
  scene_failure_count(run, w->way.failed[0].reason, 1);
  scene_failure_tell(run, w->way.failed[0].reason, w->way.failed[0].words,
                     "the ramp of %s in real time", w->name);
}

static void put_delays(scene_run *run, const work *w)
{
  static const scene_column columns[] = {
    {SCENE_AS("jump_delay", pendres_ramp_jump, delay,
              "how far beyond the state's end the ramp's pendulum leaves it, without noise",
              "parameter")},
    {SCENE_AS("jump_ramp_parameter", pendres_ramp_jump, value,
              "value at which the ramp's pendulum leaves the state, without noise", "parameter")},
    {.name = "jump_ramp_time", .type = SCENE_PLAIN,
     .value = offsetof(pendres_ramp_jump, time),
     .long_name = "drive periods since the ramp's start until then"},
  };
  const scene_table table = {.dimensions = {"jump"}, SCENE_ROWS(w->jump, w->ramp.jumps)};
  SCENE_WRITE(run, &table, columns);
}

static void put_scatter(scene_run *run, const work *w)
{
  static const scene_column columns[] = {
    {SCENE_AS("jump_mean", pendres_ramp_summary, mean,
              "mean over noisy trajectories of the value at which they leave the state",
              "parameter")},
    {SCENE_AS("jump_deviation", pendres_ramp_summary, deviation,
              "standard deviation of that value", "parameter")},
    {SCENE_TYPED(SCENE_COUNT, "jump_count", pendres_ramp_summary, count,
                 "trajectories that leave the state")},
  };
  const scene_table table = {.dimensions = {"jump"}, SCENE_ROWS(w->summary, w->ramp.jumps)};
  const pendres_store_spec spec = {
    .name = "jump_noisy_parameter", .dimensions = {"jump", "trajectory"},
    .long_name = "value at which each noisy trajectory leaves the state; NaN: it does not"};
  scene_numbering(run, "trajectory", w->trajectories, "number of the noisy trajectory");
  scene_put_as(run, "parameter", &spec, w->noisy, NULL, w->ramp.jumps * w->trajectories);
  SCENE_WRITE(run, &table, columns);
}

static void tabulate(FILE *out, const work *w)
{
  if (w->ramp.jumps == 0) return;
  fprintf(out, "\nin real time:\n%-5s %-30s %s\n", "way", "delay",
          w->trajectories > 0 ? "with noise: mean, standard deviation, trajectories" : "");
  for (size_t k = 0; k < w->ramp.jumps && k < SCENE_TABLE_LINES; k++) {
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

static void compute(scene_run *run, work *w)
{
  scene_points noise = {.n = w->trajectories, .chunk = SCENE_PENDULUMS,
                        .size = w->ramp.jumps * sizeof(double), .compute = scatter,
                        .collect = collect_scatter, .unmarked = 1, .arg = w};
  SCENE_COMPUTE(run, &w->way, "ramps", .last = 0);
  if (!scene_going(run)) return;
  for (size_t k = 0; k < w->ramp.jumps * w->trajectories; k++) w->noisy[k] = NAN;
  if (noise.n == 0 || noise.size == 0 || w->way.failed[0].reason != SCENE_FAILURE_NONE) return;
  SCENE_COMPUTE(run, &noise, "parts of the noisy trajectories", .last = 1);
  for (size_t k = 0; k < w->ramp.jumps && scene_going(run); k++) {
    const pendres_status status = pendres_ramp_summarize(
      w->trajectories, w->noisy + k * w->trajectories, &w->summary[k]);
    if (status != PENDRES_OK)
      scene_fail(run, status, "values of a jump: %s", pendres_status_message(status));
  }
}

void scene_ramp_run(scene_run *run, deck_axis_id axis, const scene_along_path *path)
{
  work w = {.d = run->deck,
            .way = {.n = 1, .chunk = 1, .compute = follow, .leave_out = leave_out,
                    .collect = collect, .arg = &w}};
  if (!scene_going(run) || !deck_has_ramp(run->deck)) return;
  prepare(run, &w, axis, path);
  w.way.size = w.ramp.jumps * sizeof *w.jump + 4 * samples(&w) * sizeof(double);
  compute(run, &w);
  put_way(run, &w);
  put_delays(run, &w);
  if (w.trajectories > 0) put_scatter(run, &w);
  if (scene_prints(run)) tabulate(run->table, &w);
}

void scene_ramp_describe(const deck *d, deck_axis_id axis, FILE *out)
{
  long every = 0;
  if (!deck_has_ramp(d)) return;
  const long periods = SCENE_DIRECTIONS * periods_of(d, &d->axis[axis], &every);
  fprintf(out, "then the same in real time, over %ld drive periods", periods);
  if (deck_has_noise(d))
    fprintf(out, ", and %lld trajectories at temperature %g, %.3g pendulum-periods",
            (long long)d->noise.trajectories, d->axis[DECK_AXIS_TEMPERATURE].value[0],
            (double)d->noise.trajectories * (double)periods);
  fprintf(out, "\n");
}
