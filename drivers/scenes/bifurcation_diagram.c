/*
 * bifurcation_diagram.c -- strobe points of a pendulum against one parameter, which grows
 * slowly: its exponent, its bifurcations, and the doubling cascade of its first orbit.
 *
 * The path is one task; strobe points at each value, and the cascade, are tasks of a second stage.
 */
#include <limits.h>
#include <math.h>

#include "scenes/along.h"
#include "scenes/points.h"

enum { TABLE_ROWS = 40 };

/* A strobe point. */
typedef struct strobe {
  double x, x_error, v, v_error;
} strobe;

enum { NOT_KNOWN = -1 };

typedef struct work {
  const deck *d;
  deck_axis_id axis;
  size_t strobes;
  scene_along_path path;
  scene_points values;   /* of record, taken apart into: */
  strobe *strobe;        /* [values][strobes] */
  int *attractors;       /* [values]; 0: not asked for; or NOT_KNOWN */
  scene_points cascade;  /* one pendres_cascade, if it is asked for */
} work;

/* What is found at a value; `strobes` positions, then velocities follow. */
typedef struct record {
  int64_t attractors;
  double x[];
} record;

static pendres_pendulum pendulum_at(const work *w, size_t i)
{
  pendres_pendulum p = deck_pendulum(w->d);
  pendres_parameter_set(deck_axis_parameter(w->axis), w->path.point[i].value, &p);
  return p;
}

/* ---- the cascade --------------------------------------------------------------------------- */

static void name_cascade(const scene_points *p, size_t point, char *text, size_t size)
{
  (void)p;
  (void)point;
  snprintf(text, size, "the cascade of doublings");
}

static void no_cascade(const scene_points *p, size_t point, void *row)
{
  (void)p;
  (void)point;
  *(pendres_cascade *)row =
    (pendres_cascade){.limit = NAN, .limit_error = NAN, .ratio = NAN, .ratio_error = NAN};
}

/* An orbit that has none is no failure. */
static pendres_status find_cascade(const scene_some *some)
{
  const work *w = some->of->arg;
  const pendres_hysteresis_point *first = w->path.point;
  const size_t values = w->values.n;
  pendres_status status = PENDRES_NOT_FOUND;
  if (scene_along_closed(first))
    status = pendres_cascade_find(some->ctx, &first->attractor.orbit,
                                  deck_axis_parameter(w->axis),
                                  w->path.point[values - 1].value, some->rows);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  no_cascade(some->of, 0, some->rows);
  return PENDRES_OK;
}

static int check_cascade(const scene_points *p, const void *row)
{
  (void)p;
  return scene_check_code(((const pendres_cascade *)row)->doublings,
                          PENDRES_CASCADE_DOUBLINGS + 1);
}

/* ---- values -------------------------------------------------------------------------------- */

/* Find the attractors at a value, if they are asked for, and strobe points of the one that the path
   is on. */
static pendres_status find_strobes(const scene_some *some)
{
  const work *w = some->of->arg;
  const pendres_hysteresis_point *point = &w->path.point[some->first];
  const pendres_pendulum p = pendulum_at(w, some->first);
  record *r = some->rows;
  pendres_attractors *set = NULL;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < 2 * w->strobes; k++) r->x[k] = NAN;
  if (w->d->diagram.attractors)
    status = pendres_attractors_find(some->ctx, &p, 0, NULL, NULL, &set);
  r->attractors = (int64_t)pendres_attractors_count(set);
  pendres_attractors_free(set);
  if (status != PENDRES_OK || point->attractor.label == PENDRES_LABEL_UNRESOLVED ||
      point->attractor.label == PENDRES_LABEL_ESCAPE)
    return status;
  return pendres_strobe_record(some->ctx, &p, &(pendres_state){point->x, point->v},
                               (long)w->strobes - 1, 1,
                               &(pendres_record){.x = r->x, .v = r->x + w->strobes});
}

static void no_strobes(const scene_points *p, size_t point, void *row)
{
  const work *w = p->arg;
  record *r = row;
  (void)point;
  for (size_t k = 0; k < 2 * w->strobes; k++) r->x[k] = NAN;
  r->attractors = NOT_KNOWN;
}

static int check_strobes(const scene_points *p, const void *row)
{
  const int64_t attractors = ((const record *)row)->attractors;
  (void)p;
  return attractors >= NOT_KNOWN && attractors <= INT_MAX;
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
  const record *r = rows;
  const double *x = r->x, *v = x + w->strobes;
  const pendres_hysteresis_point *point = &w->path.point[first];
  (void)n;
  /* Points of chaos are its own, but how far they are off the pendulum's is not known. */
  const int closed = scene_along_closed(point);
  w->attractors[first] = (int)r->attractors;
  const double x_error = closed ? point->attractor.orbit.x_error + w->d->precision.tolerance : NAN;
  const double fast = w->d->precision.tolerance / deck_pendulum_units(w->d).time;
  const double v_error = closed ? point->attractor.orbit.v_error + fast : NAN;
  for (size_t k = 0; k < w->strobes; k++)
    w->strobe[first * w->strobes + k] = (strobe){within_a_turn(w->d, x[k]), x_error, v[k], v_error};
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

static int has_exponents(const deck *d)
{
  return d->diagram.exponents;
}

static const scene_column of_points[] = {
  {.name = "lyapunov", .long_name = "largest Lyapunov exponent per unit time", .units = "1",
   .when = has_exponents, .value = offsetof(scene_along_row, of.attractor.lyapunov),
   .error = offsetof(scene_along_row, of.attractor.lyapunov_error)},
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

/* Mark the points of which something is not known, beside those that the path marks. */
static void mark_rest(scene_run *run, const work *w, scene_along_row *rows)
{
  for (size_t i = 0; rows != NULL && i < w->values.n; i++) {
    const scene_failure reason = (scene_failure)w->values.failed.reason[i];
    if (reason == SCENE_FAILURE_NONE) continue;
    /* What the path has not come to is counted there. */
    run->failed_points += rows[i].failed == SCENE_FAILURE_NONE;
    rows[i].failed = (int)reason;
    scene_failure_tell(run, reason, w->values.failed.words[i], "attractors at %s %.10g",
                       deck_axis_name(w->axis), w->path.point[i].value);
  }
  scene_points_tell(run, &w->cascade);
}

static void write_values(scene_run *run, const work *w)
{
  const char *axis = deck_axis_name(w->axis);
  const size_t n = w->values.n;
  scene_along_row *rows = scene_along_rows(run, &w->path);
  const scene_table strobes = {.dimensions = {axis, "strobe"}, .prefix = "strobe",
                               .n = n * w->strobes, .stride = sizeof *w->strobe,
                               .rows = w->strobe};
  const scene_table points = {.dimensions = {axis}, .n = n, .stride = sizeof *rows, .rows = rows};
  const scene_table counts = {.dimensions = {axis}, .n = n, .stride = sizeof *w->attractors,
                              .rows = w->attractors};
  mark_rest(run, w, rows);
  SCENE_WRITE(run, &strobes, of_strobes);
  SCENE_WRITE(run, &points, of_points);
  if (w->d->diagram.attractors) scene_columns_write(run, &counts, 1, &of_attractors);
  scene_along_write_verdicts(run, &w->path, &points);
  scene_along_tell(run, w->axis, &w->path, 1);
}

static void write_cascade(scene_run *run, const pendres_cascade *c)
{
  if (!scene_going(run)) return;
  const scene_table doublings = {.dimensions = {"cascade"}, .prefix = "cascade",
                                 .n = (size_t)c->doublings, .stride = sizeof c->value[0],
                                 .rows = c};
  const scene_table whole = {.prefix = "cascade", .n = 1, .stride = sizeof *c, .rows = c};
  scene_numbering(run, "cascade", doublings.n, "number of the doubling");
  scene_columns_write(run, &doublings, 1, &of_doublings);
  SCENE_WRITE(run, &whole, of_cascade);
}

static void write_all(scene_run *run, const work *w)
{
  scene_dimension(run, NULL, w->axis);
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
  fprintf(out, "%-10s %-28s %s\n", "ends by", deck_axis_name(w->axis), "period after");
  for (size_t i = 0; i < w->path.jumps && i < TABLE_ROWS; i++) {
    const pendres_jump *j = &w->path.jump[i];
    fprintf(out, "%-10s %.14g +- %.0e  %d\n", pendres_name_get(PENDRES_NAMES_JUMP, j->kind),
            j->value,
            j->value_error, j->to_period);
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
  work w = {.d = d, .axis = axis[0], .strobes = strobes,
            .values = {.size = sizeof(record) + 2 * strobes * sizeof(double), .chunk = 1,
                       .compute = find_strobes, .leave_out = no_strobes, .check = check_strobes,
                       .collect = collect_strobes, .arg = &w},
            .cascade = {.n = 1, .size = sizeof(pendres_cascade), .chunk = 1,
                        .compute = find_cascade, .leave_out = no_cascade, .check = check_cascade,
                        .name = name_cascade, .arg = &w}};
  scene_points_over(&w.values, d, 1, &w.axis);
  if (!d->diagram.bifurcations) w.cascade.n = 0;
  w.strobe = scene_array(run, a->count * strobes, sizeof *w.strobe);
  w.attractors = scene_array(run, a->count, sizeof *w.attractors);
  scene_along_compute(run, &(scene_along_way){w.axis, a->count, a->value}, &w.path);
  scene_points_compute(run, &(farm_stage){.what = "values", .last = 1}, 2,
                       (scene_points *[]){&w.values, &w.cascade});
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
  .references = "G. L. Baker and J. P. Gollub, Chaotic Dynamics (1996); M. J. Feigenbaum, Journal "
                "of Statistical Physics 19 (1978) 25",
  .budget = 1,
  .size = {.head = 60e3, .point = 200.0, .memory = 100e3, .stages = 2.0, .after = 1.0,
           .seconds = 0.3, .slowest = SCENE_SLOWEST_BRANCH, .journal = SCENE_PATH_JOURNAL,
           .values = strobes_of, .value = 3.5},
  .options = options,
  .describe = describe,
  .run = run_scene,
};
