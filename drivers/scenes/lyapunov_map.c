/*
 * lyapunov_map.c -- largest Lyapunov exponent, period and winding over two parameters, of the
 * motion that one start leads to.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/along.h"
#include "scenes/check.h"
#include "scenes/failed.h"

enum {
  AXES = 2,
  /* Points of a task: enough for full blocks. The few that are followed for long fill them in large
     maps only, which have tasks enough for any number of threads. */
  FEWEST = 4096, MOST = 8192, TASKS = 128
};

/* What is written of a point: NaN where it does not exist. */
typedef struct row {
  double lyapunov, lyapunov_error, rotation, rotation_error;
  double period, period_error, winding, winding_error;
  int label, uncertain, failed;
} row;

typedef struct work {
  const deck *d;
  pendres_sweep sweep;
  deck_axis_id axis[AXES]; /* the second one runs fastest */
  size_t count, chunk; /* points, and those of a task */
  row *rows;
} work;

static size_t chunk_of(size_t count)
{
  const size_t some = count / TASKS;
  return some < FEWEST ? FEWEST : some < MOST ? some : MOST;
}

static size_t count_of(const work *w, size_t task)
{
  const size_t left = w->count - task * w->chunk;
  return left < w->chunk ? left : w->chunk;
}

static double coordinate(const work *w, size_t point, int axis)
{
  const deck_axis *last = &w->d->axis[w->axis[AXES - 1]];
  return axis == 0 ? w->d->axis[w->axis[0]].value[point / last->count]
                   : last->value[point % last->count];
}

/* ---- computing ----------------------------------------------------------------------------- */

static const row no_row = {.lyapunov = NAN, .lyapunov_error = NAN, .rotation = NAN,
                           .rotation_error = NAN, .period = NAN, .period_error = NAN,
                           .winding = NAN, .winding_error = NAN,
                           .label = PENDRES_LABEL_UNRESOLVED, .failed = SCENE_FAILURE_OUT_OF_TIME};

static row row_of(const pendres_lyapunov *l)
{
  const double closed = l->period > 0 ? 0.0 : NAN;
  const int uncertain = l->label != PENDRES_LABEL_UNRESOLVED && !l->certain;
  const double whole = uncertain ? NAN : closed; /* what other orbits there are is not known */
  return (row){.lyapunov = l->exponent, .lyapunov_error = l->exponent_error,
               .rotation = l->rotation, .rotation_error = l->rotation_error,
               .period = l->period + closed, .period_error = whole,
               .winding = l->winding + closed, .winding_error = whole, .label = (int)l->label,
               .uncertain = uncertain,
               .failed = l->label == PENDRES_LABEL_UNRESOLVED ? SCENE_FAILURE_UNRESOLVED
                                                              : SCENE_FAILURE_NONE};
}

/* Points from the first on; where their budget ends them, or one of them fails by itself,
   their halves, down to single ones. */
typedef struct some {
  size_t first, n;
  const pendres_pendulum *p;
  const double *x, *v;
  pendres_lyapunov *found; /* room */
  row *rows;
} some;

/* Whether one of them would not settle in a time that one waits, unless the deck says how long. */
static int too_long(const work *w, const some *s)
{
  char words[SCENE_TOLD];
  int any = 0;
  for (size_t i = 0; i < s->n && w->d->lyapunov.transient == 0 && !any; i++)
    any = scene_failure_too_long(&s->p[i], 1.0, words, sizeof words);
  return any;
}

static pendres_status find(const work *w, const some *s, pendres_context *ctx, farm_record *out)
{
  const pendres_lyapunov_options options = {.transient = (long)w->d->lyapunov.transient,
                                            .periods = (long)w->d->lyapunov.periods};
  const size_t half = s->n / 2;
  scene_point_begin(out, w->d, s->first, s->n, AXES, w->axis);
  pendres_status status = PENDRES_OK;
  scene_failure own = too_long(w, s) ? SCENE_FAILURE_TOO_LONG : SCENE_FAILURE_NONE;
  if (own == SCENE_FAILURE_NONE)
    status = pendres_lyapunov_find(ctx, s->n, s->p, s->x, s->v, &options, s->found);
  for (size_t i = 0; i < s->n && status == PENDRES_OK && own == SCENE_FAILURE_NONE; i++)
    s->rows[i] = row_of(&s->found[i]);
  const int late = farm_gave_up(out, status);
  if (own == SCENE_FAILURE_NONE) own = scene_failure_of(status);
  if (!late && own == SCENE_FAILURE_NONE) return status;
  if (half == 0) {
    if (late) farm_lost(out, NULL, 0);
    s->rows[0] = no_row;
    if (!late) s->rows[0].failed = (int)own;
    return PENDRES_OK;
  }
  const some one = {s->first, half, s->p, s->x, s->v, s->found, s->rows};
  const some two = {s->first + half, s->n - half, s->p + half, s->x + half, s->v + half, s->found,
                    s->rows + half};
  status = find(w, &one, ctx, out);
  return status == PENDRES_OK ? find(w, &two, ctx, out) : status;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  const size_t n = count_of(w, task), first = task * w->chunk;
  pendres_pendulum *p = malloc(n * sizeof *p);
  pendres_lyapunov *found = malloc(n * sizeof *found);
  double *x = malloc(2 * n * sizeof *x);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n && p != NULL && x != NULL; i++) {
    p[i] = pendres_sweep_pendulum(&w->sweep, first + i, NULL, NULL);
    x[i] = w->d->orbit.x;
    x[n + i] = w->d->orbit.v;
  }
  if (p != NULL && found != NULL && x != NULL)
    status = find(w, &(some){first, n, p, x, x + n, found, out->data}, ctx, out);
  free(p);
  free(found);
  free(x);
  return status;
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const work *w = arg;
  const row *rows = in->data;
  int good = in->size == w->chunk * sizeof *rows;
  for (size_t i = 0; good && i < count_of(w, task); i++)
    good = scene_check_code(rows[i].label, PENDRES_LABEL_COUNT) &&
           scene_check_code(rows[i].failed, SCENE_FAILURE_COUNT);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  memcpy(w->rows + task * w->chunk, in->data, count_of(w, task) * sizeof *w->rows);
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

/* NULL: what is said of all. */
static const char *words_for(scene_failure reason)
{
  switch (reason) {
  case SCENE_FAILURE_UNRESOLVED: return "neither an orbit nor chaos within its time";
  case SCENE_FAILURE_TOLERANCE:
    return "more steps a period are needed there than are taken; a looser precision.tolerance may "
           "do";
  case SCENE_FAILURE_TOO_LONG:
    return "settling would take too many steps of the integrator; lyapunov_map.transient says "
           "after how many drive periods to look in spite of that";
  default: return NULL;
  }
}

static void tell_failed(scene_run *run, const work *w)
{
  for (size_t i = 0; i < w->count; i++) {
    if (w->rows[i].failed == SCENE_FAILURE_NONE) continue;
    const scene_failure reason = (scene_failure)w->rows[i].failed;
    char where[200];
    run->failed_points++;
    scene_point_name(w->d, i, AXES, w->axis, where, sizeof where);
    scene_failure_tell(run, reason, words_for(reason), "%s", where);
  }
}

static const scene_column columns[] = {
  SCENE_COLUMN(row, lyapunov, "largest Lyapunov exponent a unit time", "1"),
  SCENE_COLUMN(row, rotation, "mean whole turns a drive period", "1"),
  SCENE_COLUMN(row, period, "drive periods until the orbit closes", "1"),
  SCENE_COLUMN(row, winding, "whole turns until the orbit closes", "1"),
  SCENE_CODE(row, label, "kind of motion", scene_motion_names),
  {.name = "uncertain", .type = SCENE_FLAG, .value = offsetof(row, uncertain),
   .names = scene_doubt_names,
   .long_name = "whether errors that the start amplifies may have chosen the motion",
   .comment = "no: they have not, or there is no verdict"},
  SCENE_CODE(row, failed, "why there is no verdict", scene_failure_names),
};

static pendres_status write_all(scene_run *run, const work *w)
{
  const scene_table table = {
    .dimensions = {deck_axis_name(w->axis[0]), deck_axis_name(w->axis[1])},
    .n = w->count, .stride = sizeof *w->rows, .rows = w->rows,
    .first = w->d->axis[w->axis[0]].count};
  pendres_status status = scene_dimension(run, NULL, w->axis[0]);
  if (status == PENDRES_OK) status = scene_dimension(run, NULL, w->axis[1]);
  return status == PENDRES_OK ? SCENE_WRITE(run, &table, columns) : status;
}

static void tabulate(FILE *out, const work *w)
{
  size_t counts[PENDRES_LABEL_COUNT] = {0}, most = 0, uncertain = 0;
  if (out == NULL) return;
  for (size_t i = 0; i < w->count; i++) {
    counts[w->rows[i].label]++;
    uncertain += w->rows[i].uncertain != 0;
    if (w->rows[i].label == PENDRES_LABEL_CHAOTIC &&
        (w->rows[most].label != PENDRES_LABEL_CHAOTIC ||
         w->rows[i].lyapunov > w->rows[most].lyapunov))
      most = i;
  }
  fprintf(out, "%-12s %10s %8s\n", "motion", "points", "share");
  for (int i = 0; i < PENDRES_LABEL_COUNT; i++)
    if (counts[i] > 0)
      fprintf(out, "%-12s %10zu %8.4f\n", pendres_label_name((pendres_label)i), counts[i],
              (double)counts[i] / (double)w->count);
  if (uncertain > 0)
    fprintf(out, "%zu uncertain: errors as small as rounding choose what they do\n", uncertain);
  if (counts[PENDRES_LABEL_CHAOTIC] > 0)
    fprintf(out, "largest exponent %.4f +- %.0e at %s %g, %s %g\n", w->rows[most].lyapunov,
            w->rows[most].lyapunov_error, deck_axis_name(w->axis[0]), coordinate(w, most, 0),
            deck_axis_name(w->axis[1]), coordinate(w, most, 1));
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck, .sweep = scene_sweep(run->deck)};
  (void)deck_moving(run->deck, AXES, w.axis);
  w.count = run->deck->axis[w.axis[0]].count * run->deck->axis[w.axis[1]].count;
  w.chunk = chunk_of(w.count);
  const farm_stage stage = {.what = "parts of the map", .last = 1,
                            .tasks = (w.count + w.chunk - 1) / w.chunk,
                            .record_size = w.chunk * sizeof(row), .task = compute,
                            .check = check, .collect = collect, .arg = &w};
  w.rows = scene_rows(run, w.count, sizeof *w.rows);
  pendres_status status = w.rows != NULL ? scene_compute(run, &stage) : PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tell_failed(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
  free(w.rows);
  return status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[AXES] = {DECK_AXIS_DAMPING, DECK_AXIS_DAMPING};
  (void)deck_moving(d, AXES, axis);
  const deck_axis *a = &d->axis[axis[0]], *b = &d->axis[axis[1]];
  fprintf(out, "largest Lyapunov exponent, period and winding at %zu x %zu points,\n"
               "%s from %g to %g and %s from %g to %g; each from x = %g, v = %g\n",
          a->count, b->count, deck_axis_name(axis[0]), a->value[0], a->value[a->count - 1],
          deck_axis_name(axis[1]), b->value[0], b->value[b->count - 1], d->orbit.x, d->orbit.v);
}

const scene_kind scene_lyapunov_map = {
  .kind = DECK_LYAPUNOV_MAP,
  .references = "G. Benettin, L. Galgani and J.-M. Strelcyn, Physical Review A 14 (1976) 2338; "
                "G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996)",
  .budget = 1,
  .size = {40e3, 19.0, 100.0, 1.0, 1.0, 5e-4},
  .describe = describe,
  .run = run_scene,
};
