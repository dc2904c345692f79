/*
 * bifurcation_diagram.c -- strobe points of a pendulum against one parameter, which grows
 * slowly: its exponent, its bifurcations, and the doubling cascade of its first orbit.
 *
 * The path is one task; attractors at some values, and the cascade, do not depend on it and are
 * tasks beside it. Strobe points at each value are tasks of a second stage.
 */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "scenes/along.h"
#include "scenes/numbers.h"
#include "scenes/points.h"

/* A strobe point. */
typedef struct strobe {
  double x, x_error, v, v_error;
} strobe;

typedef struct work {
  const deck *d;
  scene_along_way way;
  size_t strobes;
  scene_along_path path;
  scene_points counts;   /* of int: attractors at each value, if they are asked for */
  scene_points cascade;  /* one pendres_cascade, if it is asked for */
  scene_points values;   /* of [2][strobes] numbers, positions and velocities, taken apart into: */
  strobe *strobe;        /* [values][strobes] */
} work;

static pendres_pendulum pendulum_at(const work *w, size_t i)
{
  pendres_pendulum p = deck_pendulum(w->d);
  pendres_parameter_set(deck_axis_parameter(w->way.axis), w->way.value[i], &p);
  return p;
}

/* ---- the cascade --------------------------------------------------------------------------- */

static const pendres_cascade no_cascade = {
  .limit = NAN, .limit_error = NAN, .ratio = NAN, .ratio_error = NAN};

/* The cascade of the orbit that the path begins on. One that has none is no failure. */
static pendres_status find_cascade(const scene_some *some)
{
  const work *w = some->of->arg;
  const pendres_pendulum p = deck_pendulum(w->d);
  const pendres_hysteresis_path first = {deck_axis_parameter(w->way.axis), 1, w->way.value};
  pendres_state from;
  pendres_hysteresis *h = NULL;
  pendres_status status = scene_along_start(w->d, &w->way, some->ctx, some->message, &from);
  if (status == PENDRES_OK) status = pendres_hysteresis_find(some->ctx, &p, &from, &first, &h);
  if (status == PENDRES_OK && !scene_along_closed(pendres_hysteresis_get(h, 0)))
    status = PENDRES_NOT_FOUND;
  if (status == PENDRES_OK)
    status = pendres_cascade_find(some->ctx, &pendres_hysteresis_get(h, 0)->attractor.orbit,
                                  first.parameter, w->way.value[w->way.n - 1], some->rows);
  pendres_hysteresis_free(h);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  memcpy(some->rows, &no_cascade, sizeof no_cascade);
  return PENDRES_OK;
}

static int check_cascade(const scene_points *p, const void *row)
{
  (void)p;
  return scene_check_code(((const pendres_cascade *)row)->doublings,
                          PENDRES_CASCADE_DOUBLINGS + 1);
}

/* ---- attractors ---------------------------------------------------------------------------- */

static pendres_status count_attractors(const scene_some *some)
{
  const work *w = some->of->arg;
  pendres_pendulum p[TASK_ATTRACTORS];
  int *count = some->rows;
  pendres_attractors *found = NULL;
  for (size_t i = 0; i < some->n; i++) p[i] = pendulum_at(w, some->first + i);
  const pendres_status status =
    pendres_settle(some->ctx, some->n, p, NULL, NULL, NULL, &found);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++)
    count[i] = (int)pendres_attractors_count_of(found, i);
  pendres_attractors_free(found);
  return status;
}

static const int not_known = -1;

static int check_count(const scene_points *p, const void *row)
{
  (void)p;
  return *(const int *)row >= not_known;
}

/* ---- strobe points ------------------------------------------------------------------------- */

/* Strobe points of the attractor that the path is on: of an orbit those of one round, again and
   again. */
static pendres_status find_strobes(const scene_some *some)
{
  const work *w = some->of->arg;
  const pendres_hysteresis_point *point = &w->path.point[some->first];
  const pendres_pendulum p = pendulum_at(w, some->first);
  const pendres_label label = point->attractor.label;
  double *x = some->rows, *v = x + w->strobes;
  for (size_t k = 0; k < w->strobes; k++) x[k] = v[k] = NAN;
  if (label == PENDRES_LABEL_UNRESOLVED || label == PENDRES_LABEL_ESCAPE) return PENDRES_OK;
  const size_t period = (size_t)point->attractor.orbit.period;
  const size_t n = scene_along_closed(point) && period < w->strobes ? period : w->strobes;
  const pendres_status status =
    pendres_strobe_record(some->ctx, &p, &(pendres_state){point->x, point->v}, (long)n - 1, 1,
                          &(pendres_record){.x = x, .v = v});
  for (size_t k = n; k < w->strobes && status == PENDRES_OK; k++) {
    x[k] = x[k - n];
    v[k] = v[k - n];
  }
  return status;
}

static void no_strobes(const scene_points *p, size_t point, void *row)
{
  const work *w = p->arg;
  double *x = row;
  (void)point;
  for (size_t k = 0; k < 2 * w->strobes; k++) x[k] = NAN;
}

/* The well number 0. */
static double within_a_turn(const deck *d, double x)
{
  const double turn = 2.0 * PENDRES_PI;
  if (!(pendres_model_of(deck_pendulum(d).force)->period > 0.0)) return x;
  return x - turn * ceil((x - 0.75 * turn) / turn);
}

static pendres_status collect_strobes(const scene_points *p, size_t first, size_t n,
                                      const void *rows)
{
  work *w = p->arg;
  const double *x = rows, *v = x + w->strobes;
  const pendres_hysteresis_point *point = &w->path.point[first];
  (void)n;
  /* Points of chaos are its own, but how far they are off the pendulum's is not known. */
  const int closed = scene_along_closed(point);
  const double x_error = closed ? point->attractor.orbit.x_error + w->d->precision.tolerance : NAN;
  const double fast = w->d->precision.tolerance / deck_pendulum_units(w->d).time;
  const double v_error = closed ? point->attractor.orbit.v_error + fast : NAN;
  for (size_t k = 0; k < w->strobes; k++)
    w->strobe[first * w->strobes + k] = (strobe){within_a_turn(w->d, x[k]), x_error, v[k], v_error};
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

static const char of_chaos[] =
  "errors are NaN in chaos: its points are on the attractor, but no two runs have the same ones";
static const scene_column of_strobes[] = {
  {SCENE_AS("x", strobe, x, "position at drive phase 0, within one turn", NULL),
   .comment = of_chaos},
  {SCENE_AS("v", strobe, v, "velocity at drive phase 0", NULL), .comment = of_chaos},
};

static int has_exponents(const deck *d)
{
  return d->diagram.exponents;
}

static const scene_column of_points[] = {
  {SCENE_AS("lyapunov", scene_along_row, of.attractor.lyapunov, NULL, NULL), .when = has_exponents},
  SCENE_COLUMN(scene_along_row, period, NULL),
};

static const scene_column of_attractors = {
  .name = "attractors", .long_name = "attractors that are found there", .type = SCENE_NUMBER,
  .comment = "a lower bound: those that the built-in starts lead to; -1: not known"};

static const scene_column of_bifurcations[] = {
  SCENE_CODE(scene_along_jump, kind, "what ends the motion there", scene_jump_names),
  SCENE_COLUMN(scene_along_jump, parameter, "value at which it is"),
  SCENE_COLUMN(scene_along_jump, period,
               "drive periods of the orbit that the pendulum is on then"),
};

/* The doublings are two arrays of the cascade, not one of structs: a step is that of its
   doubles. */
static const scene_column of_doublings = {SCENE_AS("parameter", pendres_cascade, value,
    "value at which the period doubles", NULL)};

static const scene_column of_cascade[] = {
  {SCENE_AS("limit", pendres_cascade, limit, "value at which doublings accumulate", "parameter")},
  SCENE_COLUMN(pendres_cascade, ratio, "ratio of the last two distances of doublings"),
};

/* Mark the values at which something is not known, beside those that the path marks. */
static void mark_more(scene_run *run, const work *w, const scene_points *p, const char *what,
                      scene_along_row *rows)
{
  for (size_t i = 0; rows != NULL && i < p->n; i++) {
    const scene_failure reason = p->failed[i].reason;
    if (reason == SCENE_FAILURE_NONE) continue;
    /* What the path has not come to is counted there. */
    scene_failure_count(run, reason, rows[i].failed == SCENE_FAILURE_NONE);
    rows[i].failed = (int)reason;
    scene_failure_tell(run, reason, p->failed[i].words, "%s at %s %.10g", what,
                       deck_axis_name(w->way.axis), w->way.value[i]);
  }
}

static void write_values(scene_run *run, const work *w)
{
  const char *axis = deck_axis_name(w->way.axis);
  const size_t n = w->values.n;
  scene_along_row *rows = scene_along_rows(run, &w->path);
  const scene_table strobes = {.dimensions = {axis, "strobe"}, .prefix = "strobe",
                               SCENE_ROWS(w->strobe, n * w->strobes)};
  const scene_table points = {.dimensions = {axis}, SCENE_ROWS(rows, n)};
  const scene_table counts = {.dimensions = {axis}, .n = w->counts.n, .stride = w->counts.size,
                              .rows = w->counts.rows};
  mark_more(run, w, &w->counts, "attractors", rows);
  mark_more(run, w, &w->values, "strobe points", rows);
  scene_points_tell(run, &w->cascade);
  SCENE_WRITE(run, &strobes, of_strobes);
  SCENE_WRITE(run, &points, of_points);
  if (w->d->diagram.attractors) scene_columns_write(run, &counts, 1, &of_attractors);
  scene_along_write_verdicts(run, &w->path, &points);
  scene_along_tell(run, w->way.axis, &w->path, 1);
}

static void write_cascade(scene_run *run, const pendres_cascade *c)
{
  if (!scene_going(run)) return;
  const scene_table doublings = {.dimensions = {"cascade"}, .prefix = "cascade",
                                 .n = (size_t)c->doublings, .stride = sizeof c->value[0],
                                 .rows = c};
  const scene_table whole = {.prefix = "cascade", SCENE_ROWS(c, 1)};
  scene_numbering(run, "cascade", doublings.n, "number of the doubling");
  scene_columns_write(run, &doublings, 1, &of_doublings);
  SCENE_WRITE(run, &whole, of_cascade);
}

static void write_all(scene_run *run, const work *w)
{
  scene_dimension(run, NULL, w->way.axis);
  scene_numbering(run, "strobe", w->strobes, "number of the strobe point");
  write_values(run, w);
  if (!w->d->diagram.bifurcations) return;
  SCENE_ALONG_WRITE_JUMPS(run, &w->path, "bifurcation", of_bifurcations);
  write_cascade(run, w->cascade.rows);
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void tabulate(FILE *out, const work *w)
{
  if (!w->d->diagram.bifurcations) return;
  fprintf(out, "%-10s %-28s %s\n", "ends by", deck_axis_name(w->way.axis),
          "period after");
  for (size_t i = 0; i < w->path.jumps && i < SCENE_TABLE_LINES; i++) {
    const pendres_jump *j = &w->path.jump[i];
    char where[60];
    snprintf(where, sizeof where, "%.14g +- %.0e", j->value, j->value_error);
    fprintf(out, "%-10s %-28s %d\n", pendres_name_get(PENDRES_NAMES_JUMP, j->kind), where,
            j->to_period);
  }
  if (scene_along_uncertain(&w->path))
    fprintf(out, "uncertain: errors as small as rounding choose the state that it begins on\n");
  const pendres_cascade *c = w->cascade.rows;
  if (c->doublings > 3)
    fprintf(out, "%d doublings accumulate at %.12g +- %.0e, ratio %.6f +- %.0e\n", c->doublings,
            c->limit, c->limit_error, c->ratio, c->ratio_error);
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  const size_t strobes = (size_t)d->diagram.strobes;
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  const deck_axis *a = &d->axis[axis[0]];
  work w = {.d = d, .way = {axis[0], a->count, a->value, !d->diagram.bifurcations},
            .strobes = strobes,
            .counts = {.size = sizeof(int), .chunk = TASK_ATTRACTORS, .what = "attractors",
                       .compute = count_attractors, .none = &not_known,
                       .check = check_count, .arg = &w},
            .cascade = {.n = 1, .size = sizeof(pendres_cascade), .chunk = 1,
                        .compute = find_cascade, .none = &no_cascade, .check = check_cascade,
                        .what = "the cascade of doublings", .arg = &w},
            .values = {.size = 2 * strobes * sizeof(double), .chunk = 1, .compute = find_strobes,
                       .leave_out = no_strobes,
                       .collect = collect_strobes, .arg = &w}};
  scene_points_over(&w.counts, d, 1, axis);
  scene_points_over(&w.values, d, 1, axis);
  if (!d->diagram.attractors) w.counts.n = 0;
  if (!d->diagram.bifurcations) w.cascade.n = 0;
  w.strobe = scene_array(run, a->count * strobes, sizeof *w.strobe);
  scene_along_compute(run, &w.way, &w.path, 2, (scene_points *[]){&w.cascade, &w.counts});
  SCENE_COMPUTE(run, &w.values, "values", .last = 1);
  write_all(run, &w);
  if (scene_prints(run)) tabulate(run->table, &w);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  const deck_axis *a = &d->axis[axis[0]];
  fprintf(out, "%lld strobe points at each of %zu values of %s from %g to %g, which grows "
               "slowly\n",
          (long long)d->diagram.strobes, a->count, deck_axis_name(axis[0]), a->value[0],
          a->value[a->count - 1]);
  if (d->diagram.attractors) fprintf(out, "attractors at each value\n");
  if (d->diagram.bifurcations)
    fprintf(out, "bifurcations on the way, and the cascade of doublings of the first orbit\n");
}

/* Strobe points, of two numbers, which may repeat. */
static double strobes_of(const deck *d)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  return 2.0 * (double)d->diagram.strobes * (double)d->axis[axis[0]].count;
}

/* Other scenes ask how long chaos lasts, too: their averages are as long as the library's. */
static void options(const deck *d, pendres_options *out)
{
  out->exponent_error = d->diagram.exponents ? d->precision.exponent_error : 1.0;
}

const scene_kind scene_bifurcation_diagram = {
  .kind = DECK_BIFURCATION_DIAGRAM,
  .references = "; G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996); M. J. Feigenbaum, "
                "Journal of Statistical Physics 19 (1978) 25",
  .budget = 1,
  .path = 1,
  .size = {.head = 60e3, .point = 200.0, .memory = 100e3, .stages = 2.0, .after = 1.0,
           .seconds = 0.3, .slowest = SCENE_SLOWEST_BRANCH, .journal = SCENE_PATH_JOURNAL,
           .values = strobes_of, .value = 3.5},
  .options = options,
  .describe = describe,
  .run = run_scene,
};
