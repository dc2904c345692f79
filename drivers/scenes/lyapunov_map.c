/*
 * lyapunov_map.c -- largest Lyapunov exponent, period and winding over two parameters, of the
 * motion that one start leads to.
 */
#include <math.h>

#include "scenes/numbers.h"
#include "scenes/points.h"

enum {
  AXES = 2
};

/* What is written of a point: NaN where it does not exist. */
typedef struct row {
  double lyapunov, lyapunov_error, rotation, rotation_error;
  double period, period_error, winding, winding_error;
  int label, uncertain;
} row;

typedef struct work {
  const deck *d;
  pendres_sweep sweep;
  scene_points points; /* of rows */
} work;

/* ---- computing ----------------------------------------------------------------------------- */

static void leave_out(const scene_points *p, size_t point, void *out)
{
  (void)p;
  (void)point;
  ((row *)out)->label = PENDRES_LABEL_UNRESOLVED;
}

static row row_of(const pendres_settled *l)
{
  const double closed = l->period > 0 ? 0.0 : NAN;
  const int uncertain = l->label != PENDRES_LABEL_UNRESOLVED && !l->certain;
  const double whole = uncertain ? NAN : closed; /* what other orbits there are is not known */
  return (row){.lyapunov = l->exponent, .lyapunov_error = l->exponent_error,
               .rotation = l->rotation, .rotation_error = l->rotation_error,
               .period = l->period + closed, .period_error = whole,
               .winding = l->winding + closed, .winding_error = whole, .label = (int)l->label,
               .uncertain = uncertain};
}

/* Whether a point would not settle in a time that one waits, unless the deck says how long. */
static int too_long(const scene_points *p, size_t point, char *words, size_t size)
{
  const work *w = p->arg;
  const pendres_pendulum at = pendres_sweep_pendulum(&w->sweep, point, NULL, NULL);
  return w->d->lyapunov.transient == 0 && scene_failure_too_long(&at, 1.0, words, size);
}

static pendres_status compute(const scene_some *some)
{
  const work *w = some->of->arg;
  const pendres_lyapunov_options options = {.transient = (long)w->d->lyapunov.transient,
                                            .periods = (long)w->d->lyapunov.periods};
  const size_t n = some->n;
  row *rows = some->rows;
  pendres_pendulum *p = scene_room_take(some->room, n, sizeof *p);
  pendres_settled *found = scene_room_take(some->room, n, sizeof *found);
  double *x = scene_room_take(some->room, 2 * n, sizeof *x);
  if (p == NULL || found == NULL || x == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) {
    p[i] = pendres_sweep_pendulum(&w->sweep, some->first + i, NULL, NULL);
    x[i] = w->d->orbit.x;
    x[n + i] = w->d->orbit.v;
  }
  const pendres_status status =
    pendres_lyapunov_find(some->ctx, n, p, x, x + n, &options, found);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    rows[i] = row_of(&found[i]);
    if (found[i].label == PENDRES_LABEL_UNRESOLVED)
      scene_mark(some, i, SCENE_FAILURE_UNRESOLVED, NULL);
  }
  return status;
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

static const scene_column columns[] = {
  SCENE_COLUMN(row, lyapunov, NULL),
  SCENE_COLUMN(row, rotation, NULL),
  SCENE_COLUMN(row, period, NULL),
  SCENE_COLUMN(row, winding, NULL),
  SCENE_CODE(row, label, "kind of motion", scene_motion_names),
  {SCENE_TYPED(SCENE_FLAG, "uncertain", row, uncertain,
               "whether errors that the start amplifies may have chosen the motion"),
   .names = scene_doubt_names, .comment = "no: they have not, or there is no verdict"},
};

static void tabulate(FILE *out, const work *w)
{
  const size_t count = w->points.n;
  const row *rows = w->points.rows;
  size_t counts[PENDRES_LABEL_COUNT] = {0}, most = 0, uncertain = 0;
  for (size_t i = 0; i < count; i++) {
    counts[rows[i].label]++;
    uncertain += rows[i].uncertain != 0;
    if (rows[i].label == PENDRES_LABEL_CHAOTIC &&
        (rows[most].label != PENDRES_LABEL_CHAOTIC || rows[i].lyapunov > rows[most].lyapunov))
      most = i;
  }
  fprintf(out, "%-12s %10s %8s\n", "motion", "points", "share");
  for (int i = 0; i < PENDRES_LABEL_COUNT; i++)
    if (counts[i] > 0)
      fprintf(out, "%-12s %10zu %8.4f\n", pendres_name_get(PENDRES_NAMES_LABEL, i), counts[i],
              (double)counts[i] / (double)count);
  if (uncertain > 0)
    fprintf(out, "%zu uncertain: errors as small as rounding choose what they do\n", uncertain);
  if (counts[PENDRES_LABEL_CHAOTIC] == 0) return;
  const deck_axis_id *axis = w->points.axis;
  const deck_axis *slow = &w->d->axis[axis[0]], *fast = &w->d->axis[axis[1]];
  fprintf(out, "largest exponent %.4f +- %.0e at %s %g, %s %g\n", rows[most].lyapunov,
          rows[most].lyapunov_error, deck_axis_name(axis[0]), slow->value[most / fast->count],
          deck_axis_name(axis[1]), fast->value[most % fast->count]);
}

/* Points of a task. In large tasks the few points that take long share their blocks, but where
   damping is weak all take long. Small maps are two tasks. */
static size_t chunk_of(const deck *d, size_t n)
{
  const deck_axis *a = &d->axis[DECK_AXIS_DAMPING];
  pendres_pendulum p = d->pendulum;
  if (a->count > 0) p.damping = a->value[0];
  const double damping = pendres_pendulum_decay_rate(&p) * deck_pendulum_units(d).time;
  size_t chunk = n / TASKS_OF_EXPONENTS, least = TASK_EXPONENTS;
  if (damping < usual_damping) least = (size_t)((double)least * damping / usual_damping);
  if (least < FEWEST_EXPONENTS) least = FEWEST_EXPONENTS;
  if (chunk > 4 * least) chunk = 4 * least;
  if (chunk < least) chunk = least;
  return n < 2 * chunk ? (n + 1) / 2 : chunk;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status run_scene(scene_run *run)
{
  deck_axis_id axis[DECK_AXES];
  work w = {.d = run->deck, .sweep = scene_sweep(run->deck),
            .points = {.size = sizeof(row), .compute = compute, .too_long = too_long,
                       .leave_out = leave_out, SCENE_COLUMNS(columns), .words = words_for,
                       .arg = &w}};
  scene_points *p = &w.points;
  (void)deck_axes(run->deck, axis);
  scene_points_over(p, run->deck, AXES, axis);
  p->chunk = chunk_of(run->deck, p->n);
  SCENE_COMPUTE(run, p, "parts of the map", .last = 1);
  for (int i = 0; i < AXES; i++) scene_dimension(run, NULL, axis[i]);
  scene_points_write(run, p);
  scene_points_write_failed(run, p, "failed", "why there is no verdict");
  if (scene_prints(run)) tabulate(run->table, &w);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  const deck_axis *a = &d->axis[axis[0]], *b = &d->axis[axis[1]];
  fprintf(out, "largest Lyapunov exponent, period and winding at %zu x %zu points,\n"
               "%s from %g to %g and %s from %g to %g; each from x = %g, v = %g\n",
          a->count, b->count, deck_axis_name(axis[0]), a->value[0], a->value[a->count - 1],
          deck_axis_name(axis[1]), b->value[0], b->value[b->count - 1], d->orbit.x, d->orbit.v);
}

const scene_kind scene_lyapunov_map = {
  .kind = DECK_LYAPUNOV_MAP,
  .references = "; G. Benettin, L. Galgani and J.-M. Strelcyn, Physical Review A 14 (1976) "
                "2338; G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996)",
  .budget = 1,
  .size = {.head = 40e3, .point = 19.0, .memory = 100.0, .stages = 1.0, .after = 1.0,
           .seconds = 5e-4},
  .describe = describe,
  .run = run_scene,
};
