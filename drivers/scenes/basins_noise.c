/*
 * basins_noise.c -- stroboscopic clouds around attractors under thermal noise, as in the
 * paper's Fig. 7, with their covariances beside those of linear noise theory, and escapes.
 *
 * There is one task for each temperature and attractor, which finds the theory's values and the
 * steps; then one for each temperature, attractor and part of the trajectories (cloud.h). A cloud
 * of which a part fails is marked and has no results.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/basins.h"

typedef struct cloud_work {
  const deck *d;
  const pendres_attractors *set;
  size_t temperatures, attractors;
  size_t strobes;               /* written of each cloud */
  size_t parts;                 /* that each cloud is followed in */
  pendres_cloud *clouds;        /* [temperature][attractor] */
  pendres_langevin_cloud *part; /* [temperature][attractor][part] */
  double *x, *v;                /* [temperature][attractor][strobe] */
  scene_failures failed;        /* [temperature][attractor] */
  scene_failures parts_failed;  /* the same: the first failure of its parts */
} cloud_work;

/* What to make a cloud of: as many strobes of each trajectory as make those that are written. */
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
  return w->failed.reason[number] != SCENE_FAILURE_NONE;
}

/* Is there a cloud whose trajectories are followed? */
static int is_followed(const cloud_work *w, size_t number)
{
  return w->clouds[number].way == PENDRES_CLOUD_FOLLOWED && !is_broken(w, number);
}

/* ---- tasks ----------------------------------------------------------------------------------- */

/* What a task has made of a cloud, before the `strobes` positions and velocities that it has. */
typedef struct made {
  pendres_cloud cloud;         /* of the tasks that prepare */
  pendres_langevin_cloud part; /* of those that follow */
  size_t strobes;
  scene_verdict verdict;
} made;

/* A record with room for so many strobe points, all NULL if there is no memory. */
static made *make_room(farm_record *out, size_t strobes, double **x, double **v)
{
  made *m = farm_record_resize(out, sizeof *m + 2 * strobes * sizeof(double));
  if (m == NULL) return NULL;
  m->strobes = strobes;
  *x = (double *)(m + 1);
  *v = *x + strobes;
  return m;
}

static pendres_status prepare(const void *arg, size_t number, pendres_context *ctx,
                              farm_record *out)
{
  const cloud_work *w = arg;
  const pendres_cloud_request q = cloud_request(w, number);
  double *x, *v;
  made *m = make_room(out, q.trajectories * (size_t)q.record, &x, &v);
  if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status = pendres_cloud_prepare(ctx, &q, &m->cloud, x, v);
  if (status == PENDRES_OK && m->cloud.way == PENDRES_CLOUD_FOLLOWED) {
    m->strobes = 0; /* they come with the parts */
    m = farm_record_resize(out, sizeof *m);
    if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  }
  return scene_verdict_note(&m->verdict, status, pendres_context_message(ctx));
}

/* Strobe points of a cloud from number `begin` on, as many as are written. */
static void keep_strobes(cloud_work *w, size_t number, size_t begin, const made *m)
{
  const double *x = (const double *)(m + 1), *v = x + m->strobes;
  for (size_t k = 0; k < m->strobes && begin + k < w->strobes; k++) {
    w->x[number * w->strobes + begin + k] = x[k];
    w->v[number * w->strobes + begin + k] = v[k];
  }
}

/* With as many strobes as it says, or none: the parts of what is not followed are empty. */
static int fits(const farm_record *in)
{
  const made *m = in->data;
  return in->size >= sizeof *m && m->strobes == (in->size - sizeof *m) / (2 * sizeof(double)) &&
         in->size == sizeof *m + 2 * m->strobes * sizeof(double) &&
         scene_check_verdict(&m->verdict);
}

static int check_prepared(const void *arg, size_t number, const farm_record *in)
{
  const made *m = in->data;
  (void)arg;
  (void)number;
  return fits(in) && scene_check_code((int)m->cloud.way, PENDRES_CLOUD_WAY_COUNT) &&
         scene_check_code((int)m->cloud.verdict, PENDRES_CLOUD_VERDICTS) &&
         scene_check_code(m->cloud.bias.steps_per_period, 1000001);
}

static int check_part(const void *arg, size_t task, const farm_record *in)
{
  (void)arg;
  (void)task;
  return in->size == 0 || fits(in);
}

static pendres_status collect_prepared(void *arg, size_t number, const farm_record *in)
{
  cloud_work *w = arg;
  const made *m = in->data;
  w->clouds[number] = m->cloud;
  scene_failures_take(&w->failed, number, &m->verdict);
  keep_strobes(w, number, 0, m);
  return PENDRES_OK;
}

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const cloud_work *w = arg;
  const size_t number = task / w->parts, part = task % w->parts;
  pendres_cloud_request q = cloud_request(w, number);
  double *x, *v;
  if (!is_followed(w, number)) return PENDRES_OK;
  q.steps_per_period = w->clouds[number].bias.steps_per_period;
  made *m = make_room(out, pendres_cloud_part(&q, part, NULL) * (size_t)q.record, &x, &v);
  if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status = pendres_cloud_follow(ctx, &q, part, &m->part, x, v);
  return scene_verdict_note(&m->verdict, status, pendres_context_message(ctx));
}

/* A cloud of which parts fail is marked with the first failure. */
static pendres_status collect_part(void *arg, size_t task, const farm_record *in)
{
  cloud_work *w = arg;
  const size_t number = task / w->parts;
  const pendres_cloud_request q = cloud_request(w, number);
  const made *m = in->data;
  size_t first;
  if (in->size == 0) return PENDRES_OK;
  (void)pendres_cloud_part(&q, task % w->parts, &first);
  w->part[task] = m->part;
  keep_strobes(w, number, first * (size_t)q.record, m);
  if (w->parts_failed.reason[number] == SCENE_FAILURE_NONE)
    scene_failures_take(&w->parts_failed, number, &m->verdict);
  return PENDRES_OK;
}

/* Put all parts of a cloud together; of a cloud that failed nothing is kept but the reason. */
static pendres_status conclude(cloud_work *w, size_t number)
{
  const pendres_cloud_request q = cloud_request(w, number);
  if (w->parts_failed.reason[number] != SCENE_FAILURE_NONE)
    scene_failures_mark(&w->failed, number, (scene_failure)w->parts_failed.reason[number],
                        w->parts_failed.words[number]);
  if (!is_broken(w, number))
    return pendres_cloud_conclude(&q, w->parts, w->part + number * w->parts, &w->clouds[number]);
  for (size_t k = 0; k < w->strobes; k++)
    w->x[number * w->strobes + k] = w->v[number * w->strobes + k] = NAN;
  return PENDRES_OK;
}

static pendres_status compute(scene_run *run, cloud_work *w)
{
  const size_t n = w->temperatures * w->attractors;
  w->clouds = calloc(n, sizeof *w->clouds);
  w->part = calloc(n * w->parts, sizeof *w->part);
  w->x = malloc(n * w->strobes * sizeof *w->x);
  w->v = malloc(n * w->strobes * sizeof *w->v);
  if (w->clouds == NULL || w->part == NULL || w->x == NULL || w->v == NULL ||
      scene_failures_create(run, n, &w->failed) != PENDRES_OK ||
      scene_failures_create(run, n, &w->parts_failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu clouds", n);
  for (size_t i = 0; i < n * w->strobes; i++) w->x[i] = w->v[i] = NAN;
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "choices of steps", .tasks = n, .task = prepare,
                                      .cheap = 1,
                                      .record_size = sizeof(made), .check = check_prepared,
                                      .collect = collect_prepared,
                                      .arg = w });
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "chunks of clouds", .tasks = n * w->parts,
                                               .task = follow, .check = check_part,
                                               .collect = collect_part,
                                               .arg = w });
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) status = conclude(w, i);
  return status == PENDRES_OK ? status : scene_fail(run, status, "clouds cannot be put together");
}

/* ---- results --------------------------------------------------------------------------------- */

/* A cloud as a row of results. */
typedef struct row {
  pendres_cloud of;
  double escapes;
  double xx_error, xv_error, vv_error; /* of linear theory's covariance */
} row;

#define OF(field) offsetof(row, of.field)
#define STATISTIC(label, s, words)                                                   \
  {.name = #label, .long_name = words, .value = OF(measured.statistics[s].value),    \
   .error = OF(measured.statistics[s].error)}
#define LINEAR(label, field, words)                                                  \
  {.name = #label, .long_name = words " by linear noise theory",                     \
   .value = OF(linear.field), .error = offsetof(row, field##_error)}
#define BIAS(what, s)                                                                \
  {.name = "bias_" #what, .long_name = "bias of strobe_" #what " by finite steps",   \
   .value = OF(bias.statistics[s].value), .error = OF(bias.statistics[s].error)}
#define PLAIN(label, place, words) \
  {.name = #label, .long_name = words, .type = SCENE_PLAIN, .value = place}
enum { X = PENDRES_LANGEVIN_MEAN_X, V = PENDRES_LANGEVIN_MEAN_V, XX = PENDRES_LANGEVIN_COV_XX,
       XV = PENDRES_LANGEVIN_COV_XV, VV = PENDRES_LANGEVIN_COV_VV };

static const scene_column columns[] = {
  STATISTIC(strobe_mean_x, X, "mean position of the cloud"),
  STATISTIC(strobe_mean_v, V, "mean velocity of the cloud"),
  STATISTIC(strobe_cov_xx, XX, "variance of position in the cloud"),
  STATISTIC(strobe_cov_xv, XV, "covariance of position and velocity in the cloud"),
  STATISTIC(strobe_cov_vv, VV, "variance of velocity in the cloud"),
  LINEAR(linear_cov_xx, xx, "variance of position"),
  LINEAR(linear_cov_xv, xv, "covariance of position and velocity"),
  LINEAR(linear_cov_vv, vv, "variance of velocity"),
  BIAS(mean_x, X), BIAS(mean_v, V), BIAS(cov_xx, XX), BIAS(cov_xv, XV), BIAS(cov_vv, VV),
  {.name = "linear_theory", .type = SCENE_FLAG, .value = OF(verdict), .names = scene_cloud_names,
   .long_name = "whether the cloud's covariance agrees with linear noise theory",
   .comment = "too_hot: one of the three differs by more than 3 of its standard errors, "
              "which include the bias by finite steps; uncertain: an error above half the "
              "width; below_rounding: so narrow that what linear theory leaves out is below "
              "rounding, so that nothing is followed and the covariance is that of theory"},
  {.name = "noise_steps_per_period", .type = SCENE_NUMBER, .value = OF(bias.steps_per_period),
   .long_name = "steps a drive period of the noisy integrator"},
  PLAIN(escapes, offsetof(row, escapes), "trajectories that left for another attractor or well"),
  PLAIN(escape_exposure, OF(escape_exposure), "time that trajectories were watched"),
  {.name = "escape_rate", .long_name = "escapes a unit time", .value = OF(escape_rate.value),
   .error = OF(escape_rate.error)},
  PLAIN(escape_rate_lower, OF(escape_rate.lower), "lower end of its 95 % confidence interval"),
  PLAIN(escape_rate_upper, OF(escape_rate.upper), "upper end of its 95 % confidence interval"),
};

/* What the table says of the verdicts. */
static const char *const agree[PENDRES_CLOUD_VERDICTS] = {
  [PENDRES_CLOUD_AGREES] = "yes",
  [PENDRES_CLOUD_TOO_HOT] = "no, too hot",
  [PENDRES_CLOUD_NOT_COMPARED] = "not compared",
  [PENDRES_CLOUD_UNCERTAIN] = "uncertain",
  [PENDRES_CLOUD_BELOW_ROUNDING] = "not followed",
};

static pendres_status write_strobes(scene_run *run, const cloud_work *w)
{
  static const char *const names[2] = { "strobe_x", "strobe_v" };
  static const char *const words[2] = { "position at drive phase 0, around well 0",
                                        "velocity at drive phase 0" };
  static const char *const units[2] = { "rad", "1" };
  pendres_status status =
    scene_numbering(run, "strobe", w->strobes, "number of the strobe point");
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {
      .name = names[k], .dimensions = { "temperature", "attractor", "strobe" },
      .long_name = words[k], .units = units[k],
      .comment = "trajectory after trajectory; NaN after an escape" };
    status = pendres_store_put(run->store, &spec, k == 0 ? w->x : w->v, NULL,
                               w->temperatures * w->attractors * w->strobes);
  }
  return status;
}

static pendres_cloud_verdict verdict_of(const cloud_work *w, size_t number)
{
  return is_broken(w, number) ? PENDRES_CLOUD_NOT_COMPARED : w->clouds[number].verdict;
}

static pendres_status write_clouds(scene_run *run, const cloud_work *w)
{
  const size_t n = w->temperatures * w->attractors;
  row *rows = scene_array(run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"temperature", "attractor"}, .n = n,
                             .stride = sizeof *rows, .rows = rows, .missing = w->failed.reason};
  if (rows == NULL) return PENDRES_OUT_OF_MEMORY;
  const double time = deck_pendulum_units(run->deck).time;
  for (size_t i = 0; i < n; i++) {
    const double error = w->clouds[i].linear_error;
    rows[i] = (row){w->clouds[i], (double)w->clouds[i].measured.left, error, error / time,
                    error / (time * time)};
    rows[i].of.verdict = verdict_of(w, i);
  }
  const pendres_status status = SCENE_WRITE(run, &table, columns);
  return status;
}

static pendres_status write_failed(scene_run *run, const cloud_work *w)
{
  pendres_store_spec spec = { .name = "noise_failed", .dimensions = { "temperature", "attractor" },
                              .long_name = "why there is no whole result for the noisy cloud" };
  scene_failure_flags(&spec);
  for (size_t i = 0; i < w->failed.n; i++) {
    if (!is_broken(w, i)) continue;
    run->failed_points++;
    scene_failure_tell(run, (scene_failure)w->failed.reason[i], w->failed.words[i],
                       "noisy cloud at temperature %.10g, attractor %zu",
                       cloud_request(w, i).temperature, i % w->attractors);
  }
  return pendres_store_put(run->store, &spec, w->failed.reason, NULL, w->failed.n);
}

static pendres_status write_results(scene_run *run, const cloud_work *w)
{
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = write_strobes(run, w);
  if (status == PENDRES_OK) status = write_clouds(run, w);
  if (status == PENDRES_OK) status = write_failed(run, w);
  return scene_stored(run, status);
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

/* ---- all of it ------------------------------------------------------------------------------- */

pendres_status basins_write_clouds(scene_run *run, const pendres_attractors *set)
{
  const deck *d = run->deck;
  cloud_work w = { .d = d, .set = set, .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count,
                   .attractors = pendres_attractors_count(set),
                   .strobes = (size_t)d->basins.strobes };
  pendres_status status = PENDRES_OK;
  if (w.temperatures == 0 || w.attractors == 0) return PENDRES_OK;
  const pendres_cloud_request q = cloud_request(&w, 0);
  w.parts = pendres_cloud_parts(&q);
  status = compute(run, &w);
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  free(w.clouds);
  free(w.part);
  free(w.x);
  free(w.v);
  return status;
}
