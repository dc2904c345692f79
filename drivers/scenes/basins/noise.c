/*
 * noise.c -- stroboscopic clouds around attractors under thermal noise, as in the
 * paper's Fig. 7, with their covariances beside those of linear noise theory, and escapes.
 *
 * There is one task for each temperature and attractor, which finds the theory's values and the
 * steps; then one for each temperature, attractor and part of the trajectories (cloud.h). A cloud
 * of which a part fails is marked and has no results.
 */
#include <math.h>

#include "scenes/basins/basins.h"
#include "scenes/points.h"

typedef struct cloud_work {
  const deck *d;
  const pendres_attractors *set;
  size_t temperatures, attractors;
  size_t strobes;               /* written of each cloud */
  size_t parts;                 /* that each cloud is followed in */
  scene_points prepared;        /* [temperature][attractor] of cloud_record, taken apart into: */
  pendres_cloud *clouds;        /* the same */
  double *x, *v;                /* [temperature][attractor][strobe] */
  scene_points followed;        /* [temperature][attractor][part] of part_record, into x, v and: */
  pendres_langevin_cloud *part; /* the same */
} cloud_work;

/* What a cloud is made of; each trajectory is recorded for as many strobes as the written ones
   need. */
static pendres_cloud_request cloud_request(const cloud_work *w, size_t number)
{
  const size_t trajectories = (size_t)w->d->basins.trajectories;
  return (pendres_cloud_request){
    .set = w->set, .attractor = number % w->attractors, .trajectories = trajectories,
    .temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[number / w->attractors],
    .record = (long)((w->strobes + trajectories - 1) / trajectories) };
}

static int is_broken(const cloud_work *w, size_t number)
{
  return w->prepared.failed[number].reason != SCENE_FAILURE_NONE;
}

/* Is there a cloud whose trajectories are followed? */
static int is_followed(const cloud_work *w, size_t number)
{
  return w->clouds[number].way == PENDRES_CLOUD_FOLLOWED && !is_broken(w, number);
}

/* ---- tasks ----------------------------------------------------------------------------------- */

/* Of a cloud, with the positions and velocities of all its strobes. */
typedef struct cloud_record {
  pendres_cloud cloud;
  double x[];
} cloud_record;

/* Of a part of one. */
typedef struct part_record {
  pendres_langevin_cloud part;
  double x[];
} part_record;

/* Strobe points of trajectories of a cloud. */
static size_t points_of(const pendres_cloud_request *q, size_t trajectories)
{
  return trajectories * (size_t)q->record;
}

static pendres_status prepare(const scene_some *some)
{
  const pendres_cloud_request q = cloud_request(some->of->arg, some->first);
  cloud_record *r = some->rows;
  return pendres_cloud_prepare(some->ctx, &q, &r->cloud, r->x,
                               r->x + points_of(&q, q.trajectories));
}

/* n strobe points of a cloud from number `begin` on, as many as are written. */
static void keep_strobes(cloud_work *w, size_t number, size_t begin, size_t n, const double *x)
{
  for (size_t k = 0; k < n && begin + k < w->strobes; k++) {
    w->x[number * w->strobes + begin + k] = x[k];
    w->v[number * w->strobes + begin + k] = x[n + k];
  }
}

static int check_prepared(const scene_points *p, const void *row)
{
  const pendres_cloud *c = &((const cloud_record *)row)->cloud;
  (void)p;
  return scene_check_code((int)c->way, PENDRES_CLOUD_WAY_COUNT) &&
         scene_check_code((int)c->verdict, PENDRES_CLOUD_VERDICTS) &&
         scene_check_code(c->bias.steps_per_period, DECK_MAX_COUNT + 1);
}

/* Strobe points of those that are followed come with the parts. */
static pendres_status collect_prepared(const scene_points *p, size_t first, size_t n,
                                       const void *rows)
{
  cloud_work *w = p->arg;
  const cloud_record *r = rows;
  const pendres_cloud_request q = cloud_request(w, first);
  (void)n;
  w->clouds[first] = r->cloud;
  if (r->cloud.way != PENDRES_CLOUD_FOLLOWED)
    keep_strobes(w, first, 0, points_of(&q, q.trajectories), r->x);
  return PENDRES_OK;
}

static pendres_status follow(const scene_some *some)
{
  const cloud_work *w = some->of->arg;
  const size_t number = some->first / w->parts, part = some->first % w->parts;
  part_record *r = some->rows;
  pendres_cloud_request q = cloud_request(w, number);
  if (!is_followed(w, number)) return PENDRES_OK;
  q.steps_per_period = w->clouds[number].bias.steps_per_period;
  return pendres_cloud_follow(some->ctx, &q, part, &r->part, r->x,
                              r->x + points_of(&q, pendres_cloud_part(&q, part, NULL)));
}

static pendres_status collect_part(const scene_points *p, size_t task, size_t n, const void *rows)
{
  cloud_work *w = p->arg;
  const size_t number = task / w->parts;
  const part_record *r = rows;
  const pendres_cloud_request q = cloud_request(w, number);
  size_t first;
  (void)n;
  if (!is_followed(w, number)) return PENDRES_OK;
  const size_t trajectories = pendres_cloud_part(&q, task % w->parts, &first);
  w->part[task] = r->part;
  keep_strobes(w, number, points_of(&q, first), points_of(&q, trajectories), r->x);
  return PENDRES_OK;
}

/* Put the parts of a cloud together. If parts have failed, the cloud is marked with the first
   failure, and nothing else is kept of it. */
static pendres_status conclude(cloud_work *w, size_t number)
{
  const pendres_cloud_request q = cloud_request(w, number);
  for (size_t k = (number + 1) * w->parts; k-- > number * w->parts;)
    if (w->followed.failed[k].reason != SCENE_FAILURE_NONE)
      w->prepared.failed[number] = w->followed.failed[k];
  if (!is_broken(w, number))
    return pendres_cloud_conclude(&q, w->parts, w->part + number * w->parts, &w->clouds[number]);
  for (size_t k = 0; k < w->strobes; k++)
    w->x[number * w->strobes + k] = w->v[number * w->strobes + k] = NAN;
  return PENDRES_OK;
}

static void compute(scene_run *run, cloud_work *w)
{
  const pendres_cloud_request q = cloud_request(w, 0);
  const size_t n = w->temperatures * w->attractors;
  size_t most = 0;
  w->parts = pendres_cloud_parts(&q);
  for (size_t k = 0; k < w->parts; k++) {
    const size_t trajectories = pendres_cloud_part(&q, k, NULL);
    most = trajectories > most ? trajectories : most;
  }
  w->prepared.n = n;
  w->prepared.size += 2 * points_of(&q, q.trajectories) * sizeof(double);
  w->followed.n = n * w->parts;
  w->followed.size += 2 * points_of(&q, most) * sizeof(double);
  w->clouds = scene_array(run, n, sizeof *w->clouds);
  w->part = scene_array(run, n * w->parts, sizeof *w->part);
  w->x = scene_array(run, n * w->strobes, sizeof *w->x);
  w->v = scene_array(run, n * w->strobes, sizeof *w->v);
  for (size_t i = 0; scene_going(run) && i < n * w->strobes; i++) w->x[i] = w->v[i] = NAN;
  SCENE_COMPUTE(run, &w->prepared, "choices of steps", .cheap = 1);
  SCENE_COMPUTE(run, &w->followed, "chunks of clouds", .last = 0);
  for (size_t i = 0; i < n && scene_going(run); i++)
    if (conclude(w, i) != PENDRES_OK)
      scene_fail(run, PENDRES_INTERNAL, "clouds cannot be put together");
}

/* ---- results --------------------------------------------------------------------------------- */

/* A cloud as a row of results. */
typedef struct row {
  pendres_cloud of;
  double escapes;
  double xx_error, xv_error, vv_error; /* of linear theory's covariance */
} row;

#define STATISTIC(what, s, words, of_quantity) \
  {SCENE_ESTIMATE("strobe_" #what, row, of.measured.statistics[s], words, of_quantity)}
#define LINEAR(field, words)                                                       \
  {.name = "linear_cov_" #field, .quantity = "cov_" #field,                        \
   .long_name = words " by linear noise theory",                                   \
   .value = offsetof(row, of.linear.field), .error = offsetof(row, field##_error)}
#define BIAS(what, s, of_quantity)                           \
  {SCENE_ESTIMATE("bias_" #what, row, of.bias.statistics[s], \
                  "bias of strobe_" #what " by finite steps", of_quantity)}
enum { X = PENDRES_LANGEVIN_MEAN_X, V = PENDRES_LANGEVIN_MEAN_V, XX = PENDRES_LANGEVIN_COV_XX,
       XV = PENDRES_LANGEVIN_COV_XV, VV = PENDRES_LANGEVIN_COV_VV };

static const scene_column columns[] = {
  STATISTIC(mean_x, X, "mean position of the cloud", "x"),
  STATISTIC(mean_v, V, "mean velocity of the cloud", "v"),
  STATISTIC(cov_xx, XX, "variance of position in the cloud", "cov_xx"),
  STATISTIC(cov_xv, XV, "covariance of position and velocity in the cloud", "cov_xv"),
  STATISTIC(cov_vv, VV, "variance of velocity in the cloud", "cov_vv"),
  LINEAR(xx, "variance of position"),
  LINEAR(xv, "covariance of position and velocity"),
  LINEAR(vv, "variance of velocity"),
  BIAS(mean_x, X, "x"), BIAS(mean_v, V, "v"), BIAS(cov_xx, XX, "cov_xx"),
  BIAS(cov_xv, XV, "cov_xv"), BIAS(cov_vv, VV, "cov_vv"),
  {SCENE_TYPED(SCENE_FLAG, "linear_theory", row, of.verdict,
               "whether the cloud's covariance agrees with linear noise theory"),
   .names = scene_cloud_names,
   .comment = "too_hot: one of the three differs by more than 3 of its standard errors, "
              "which include the bias by finite steps; uncertain: an error above half the "
              "width; below_rounding: so narrow that what linear theory leaves out is below "
              "rounding, so that nothing is followed and the covariance is that of theory"},
  {SCENE_TYPED(SCENE_NUMBER, "noise_steps_per_period", row, of.bias.steps_per_period,
               "steps a drive period of the noisy integrator")},
  SCENE_COLUMN_OF(SCENE_PLAIN, row, escapes,
                  "trajectories that left for another attractor or well"),
  {SCENE_TYPED(SCENE_PLAIN, "escape_exposure", row, of.escape_exposure,
               NULL), .quantity = "exposure"},
  {SCENE_ESTIMATE("escape_rate", row, of.escape_rate, "escapes per unit time", "rate")},
  {SCENE_TYPED(SCENE_PLAIN, "escape_rate_lower", row, of.escape_rate.lower,
               "lower end of its 95 % confidence interval"), .quantity = "rate"},
  {SCENE_TYPED(SCENE_PLAIN, "escape_rate_upper", row, of.escape_rate.upper,
               "upper end of its 95 % confidence interval"), .quantity = "rate"},
};

/* What the table says of the verdicts. */
static const char *const agree[PENDRES_CLOUD_VERDICTS] = {
  [PENDRES_CLOUD_AGREES] = "yes",
  [PENDRES_CLOUD_TOO_HOT] = "no, too hot",
  [PENDRES_CLOUD_NOT_COMPARED] = "not compared",
  [PENDRES_CLOUD_UNCERTAIN] = "uncertain",
  [PENDRES_CLOUD_BELOW_ROUNDING] = "not followed",
};

static void write_strobes(scene_run *run, const cloud_work *w)
{
  static const char *const names[2] = { "strobe_x", "strobe_v" };
  static const char *const words[2] = { "position at drive phase 0, around well 0",
                                        "velocity at drive phase 0" };
  static const char *const quantities[2] = { "x", "v" };
  scene_numbering(run, "strobe", w->strobes, "number of the strobe point");
  for (int k = 0; k < 2; k++) {
    const pendres_store_spec spec = {
      .name = names[k], .dimensions = { "temperature", "attractor", "strobe" },
      .long_name = words[k],
      .comment = "trajectory after trajectory; NaN after an escape" };
    scene_put_as(run, quantities[k], &spec, k == 0 ? w->x : w->v, NULL,
                 w->temperatures * w->attractors * w->strobes);
  }
}

static pendres_cloud_verdict verdict_of(const cloud_work *w, size_t number)
{
  return is_broken(w, number) ? PENDRES_CLOUD_NOT_COMPARED : w->clouds[number].verdict;
}

static void write_clouds(scene_run *run, const cloud_work *w)
{
  const size_t n = w->temperatures * w->attractors;
  row *rows = scene_array(run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"temperature", "attractor"}, SCENE_ROWS(rows, n)};
  const double time = deck_pendulum_units(run->deck).time;
  for (size_t i = 0; rows != NULL && i < n; i++) {
    const double error = w->clouds[i].linear_error;
    if (is_broken(w, i)) SCENE_BLANK(columns, &rows[i]);
    else
      rows[i] = (row){w->clouds[i], (double)w->clouds[i].measured.left, error, error / time,
                      error / (time * time)};
    rows[i].of.verdict = verdict_of(w, i);
  }
  SCENE_WRITE(run, &table, columns);
}

static void write_failed(scene_run *run, const cloud_work *w)
{
  const scene_failed *failed = w->prepared.failed;
  const scene_table table = {.dimensions = {"temperature", "attractor"},
                             SCENE_ROWS(failed, w->prepared.n)};
  scene_columns_write_failed(run, &table, "noise_failed",
                             "why there is no whole result for the noisy cloud");
  for (size_t i = 0; scene_going(run) && i < w->prepared.n; i++) {
    if (!is_broken(w, i)) continue;
    scene_failure_count(run, failed[i].reason, 1);
    scene_failure_tell(run, failed[i].reason, failed[i].words,
                       "noisy cloud at temperature %.10g, attractor %zu",
                       cloud_request(w, i).temperature, i % w->attractors);
  }
}

static void print_table(FILE *out, const cloud_work *w)
{
  fprintf(out, "temperature  attractor   var x        linear       var v        linear       "
               "agree         escapes  rate\n");
  for (size_t i = 0; i < w->temperatures * w->attractors; i++) {
    const pendres_cloud *c = &w->clouds[i];
    const size_t attractor = i % w->attractors;
    const int broken = is_broken(w, i);
    if (c->way == PENDRES_CLOUD_NONE && !broken) continue;
    fprintf(out, "%-12g %zu %-9s %-12.5g %-12.5g %-12.5g %-12.5g %-13s %-8zu %.3g\n",
            cloud_request(w, i).temperature, attractor,
            pendres_name_get(PENDRES_NAMES_LABEL, pendres_attractors_get(w->set, attractor)->label),
            broken ? NAN : c->measured.statistics[XX].value, broken ? NAN : c->linear.xx,
            broken ? NAN : c->measured.statistics[VV].value, broken ? NAN : c->linear.vv,
            agree[verdict_of(w, i)], c->measured.left,
            broken ? NAN : c->escape_rate.value);
  }
}

void basins_write_clouds(scene_run *run, const pendres_attractors *set)
{
  const deck *d = run->deck;
  cloud_work w = {.d = d, .set = set, .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count,
                  .attractors = pendres_attractors_count(set),
                  .strobes = (size_t)d->basins.strobes,
                  .prepared = {.chunk = 1, .size = sizeof(cloud_record), .compute = prepare,
                               .check = check_prepared, .collect = collect_prepared, .arg = &w},
                  .followed = {.chunk = 1, .size = sizeof(part_record), .compute = follow,
                               .collect = collect_part, .arg = &w}};
  if (!scene_going(run) || w.temperatures == 0 || w.attractors == 0) return;
  compute(run, &w);
  scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  write_strobes(run, &w);
  write_clouds(run, &w);
  write_failed(run, &w);
  if (scene_prints(run)) print_table(run->table, &w);
}
