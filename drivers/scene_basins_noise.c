/*
 * scene_basins_noise.c -- stroboscopic clouds around attractors under thermal noise, as in the
 * paper's Fig. 7, with their covariances beside those of linear noise theory, and escapes.
 *
 * One task a temperature and attractor for the steps, then one a temperature, attractor and chunk
 * of trajectories. A trajectory that has escaped (switching.h) is counted, and left out from then
 * on. A cloud of which a part fails is marked and has no results.
 */
#include "scene_basins_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene_failed.h"
#include "scene_noise.h"

static const double two_pi = 6.28318530717958647693;

/* Of a cloud's widths and their products. */
static const double bias_wanted = 0.01;

/* Why a cloud is, or is not, compared with linear theory. */
enum { AGREES, TOO_HOT, NOT_COMPARED, UNCERTAIN, BELOW_ROUNDING, VERDICTS };

static const struct {
  const char *name, *words;
} verdicts[VERDICTS] = {
  [AGREES] = { "agrees", "yes" },
  [TOO_HOT] = { "too_hot", "no, too hot" },
  [NOT_COMPARED] = { "not_compared", "not compared" },
  [UNCERTAIN] = { "uncertain", "uncertain" },
  [BELOW_ROUNDING] = { "below_rounding", "not followed" },
};

/* What linear theory leaves out is smaller than a covariance by about its variance: below this
   one it is lost in rounding, and trajectories would only be a poorer way to the same. */
static const double least_variance = 2e-16;

/* A temperature and attractor. */
typedef struct cloud {
  pendres_langevin_cloud measured;
  pendres_langevin_bias bias;
  pendres_langevin_linear linear;
  int compared; /* there is linear theory to compare with */
  int narrow;   /* so narrow that linear theory is exact: nothing is followed */
} cloud;

typedef struct work {
  const deck *d;
  farm *farm;
  const pendres_attractors *set;
  size_t temperatures, attractors;
  size_t strobes;      /* written of each cloud */
  size_t trajectories, chunks;
  long record;         /* strobes of each trajectory */
  cloud *clouds;                  /* [temperature][attractor] */
  pendres_langevin_cloud *parts;  /* [temperature][attractor][chunk] */
  double *x, *v;                  /* [temperature][attractor][strobe] */
  scene_failures failed;          /* [temperature][attractor] */
  scene_failures tasks;           /* [temperature][attractor][chunk] */
} work;

static double temperature_of(const work *w, size_t cloud_number)
{
  return w->d->axis[DECK_AXIS_TEMPERATURE].value[cloud_number / w->attractors];
}

static const pendres_attractor *attractor_of(const work *w, size_t cloud_number)
{
  return pendres_attractors_get(w->set, cloud_number % w->attractors);
}

/* Clouds are made around closed orbits that stay in their well; others run away, or have no point
   to begin with. */
static int has_cloud(const pendres_attractor *a)
{
  return isfinite(a->orbit.x) && isfinite(a->orbit.v) && a->orbit.winding == 0;
}

/* The request of all trajectories of a cloud. */
static pendres_langevin_request request_of(const work *w, size_t number,
                                           pendres_switching_home *home)
{
  const pendres_attractor *a = attractor_of(w, number);
  pendres_langevin_request q = { .pendulum = a->orbit.pendulum, .x = a->orbit.x, .v = a->orbit.v,
                                 .trajectories = w->trajectories,
                                 .settle = scene_noise_settle(&a->orbit), .record = w->record,
                                 .leave = pendres_switching_leave, .arg = home };
  q.pendulum.temperature = temperature_of(w, number);
  q.first_id = scene_noise_first_id(&q.pendulum, number % w->attractors);
  *home = (pendres_switching_home){ .set = w->set, .attractor = number % w->attractors };
  return q;
}

/* ---- computing ----------------------------------------------------------------------------- */

/* Mean and covariance of the q points of an orbit that closes after q periods. */
static void still_statistics(const pendres_orbit *o, size_t q, const double *x, const double *v,
                             pendres_langevin_estimate *out)
{
  double mean_x = 0.0, mean_v = 0.0, xx = 0.0, xv = 0.0, vv = 0.0;
  for (size_t k = 0; k < q; k++) {
    mean_x += x[k] / (double)q;
    mean_v += v[k] / (double)q;
  }
  for (size_t k = 0; k < q; k++) {
    xx += (x[k] - mean_x) * (x[k] - mean_x) / (double)q;
    xv += (x[k] - mean_x) * (v[k] - mean_v) / (double)q;
    vv += (v[k] - mean_v) * (v[k] - mean_v) / (double)q;
  }
  out[PENDRES_LANGEVIN_MEAN_X] = (pendres_langevin_estimate){ mean_x, o->x_error };
  out[PENDRES_LANGEVIN_MEAN_V] = (pendres_langevin_estimate){ mean_v, o->v_error };
  out[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){ xx, 2.0 * sqrt(xx) * o->x_error };
  out[PENDRES_LANGEVIN_COV_XV] =
    (pendres_langevin_estimate){ xv, sqrt(xx) * o->v_error + sqrt(vv) * o->x_error };
  out[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){ vv, 2.0 * sqrt(vv) * o->v_error };
}

/* Without noise, or with less than rounding: the orbit's own points. */
static pendres_status still_cloud(work *w, size_t number, pendres_context *ctx)
{
  const pendres_orbit *o = &attractor_of(w, number)->orbit;
  cloud *c = &w->clouds[number];
  const size_t q = (size_t)o->period;
  double *points = malloc(2 * q * sizeof *points);
  if (points == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_status status = pendres_orbit_sample(ctx, o, 1, points, points + q);
  /* The Poincare point itself: to the last digit. */
  points[0] = o->x;
  points[q] = o->v;
  for (size_t k = 0; k < w->strobes && status == PENDRES_OK; k++) {
    w->x[number * w->strobes + k] = points[k % q];
    w->v[number * w->strobes + k] = points[q + k % q];
  }
  if (status == PENDRES_OK) still_statistics(o, q, points, points + q, c->measured.statistics);
  free(points);
  return status;
}

/* What linear theory says of an orbit of one period. */
static void linear_cloud(cloud *c)
{
  pendres_langevin_estimate *s = c->measured.statistics;
  const pendres_langevin_covariance *l = &c->linear.covariance;
  s[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){ l->xx, c->linear.error };
  s[PENDRES_LANGEVIN_COV_XV] = (pendres_langevin_estimate){ l->xv, c->linear.error };
  s[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){ l->vv, c->linear.error };
}

/* Linear theory, and whether the cloud is too narrow for anything else. */
static void ask_theory(const pendres_langevin_request *request, const pendres_orbit *o, cloud *c)
{
  const pendres_status status = pendres_langevin_linear_theory(
    &request->pendulum, request->x, request->v, o->period, &c->linear);
  /* The cloud of an orbit of several periods lies around several points: theory knows one. */
  c->compared = o->period == 1 && status == PENDRES_OK;
  c->narrow = status == PENDRES_OK && !(c->linear.covariance.xx > least_variance);
}

static int is_broken(const work *w, size_t number)
{
  return w->failed.reason[number] != SCENE_FAILURE_NONE;
}

static pendres_status choose(void *arg, size_t number, pendres_context *ctx)
{
  enum { TRAJECTORIES = 384, RECORD = 60 };
  work *w = arg;
  cloud *c = &w->clouds[number];
  const pendres_attractor *a = attractor_of(w, number);
  pendres_switching_home home;
  pendres_langevin *lv = NULL;
  if (!has_cloud(a)) return PENDRES_OK;
  if (!(temperature_of(w, number) > 0.0)) {
    c->compared = 1;
    return scene_failures_note(&w->failed, number, still_cloud(w, number, ctx),
                               pendres_context_message(ctx));
  }
  pendres_langevin_request request = request_of(w, number, &home);
  ask_theory(&request, &a->orbit, c);
  if (c->narrow) {
    const pendres_status status = still_cloud(w, number, ctx);
    if (status == PENDRES_OK && c->compared) linear_cloud(c);
    return scene_failures_note(&w->failed, number, status, pendres_context_message(ctx));
  }
  request.trajectories = TRAJECTORIES;
  request.record = RECORD;
  pendres_status status = scene_noise_open(w->farm, w->d->basins.seed, &lv);
  if (status == PENDRES_OK)
    status =
      scene_noise_choose_steps(lv, &request, PENDRES_LANGEVIN_CLOUD, bias_wanted, &c->bias);
  status = scene_failures_note(&w->failed, number, status, pendres_langevin_message(lv));
  scene_noise_close(w->farm, lv);
  return status;
}

/* Is there a cloud whose trajectories are followed? */
static int is_followed(const work *w, size_t number)
{
  return has_cloud(attractor_of(w, number)) && temperature_of(w, number) > 0.0 &&
         !w->clouds[number].narrow && !is_broken(w, number);
}

/* Strobes of a chunk into their place among those of the cloud, as many as are written. */
static void keep_strobes(work *w, size_t number, size_t first, size_t count, const double *x,
                         const double *v)
{
  const size_t begin = first * (size_t)w->record;
  for (size_t k = 0; k < count * (size_t)w->record && begin + k < w->strobes; k++) {
    w->x[number * w->strobes + begin + k] = x[k];
    w->v[number * w->strobes + begin + k] = v[k];
  }
}

static pendres_status measure(void *arg, size_t task, pendres_context *ctx)
{
  work *w = arg;
  const size_t number = task / w->chunks;
  size_t first, count;
  pendres_switching_home home;
  pendres_langevin *lv = NULL;
  double *points = NULL;
  (void)ctx;
  if (!is_followed(w, number)) return PENDRES_OK;
  pendres_langevin_request request = request_of(w, number, &home);
  scene_noise_chunk(w->trajectories, task % w->chunks, &first, &count);
  request.first_id += first;
  request.trajectories = count;
  const size_t n = count * (size_t)w->record;
  pendres_status status = scene_noise_open(w->farm, w->d->basins.seed, &lv);
  if (status != PENDRES_OK) return status;
  points = malloc(2 * n * sizeof *points);
  status = points != NULL ? pendres_langevin_set_steps(lv, w->clouds[number].bias.steps_per_period)
                          : PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK)
    status = pendres_langevin_measure(lv, &request, &w->parts[task], points, points + n);
  if (status == PENDRES_NOT_FOUND) status = PENDRES_OK; /* all have left: an empty part */
  if (status == PENDRES_OK) keep_strobes(w, number, first, count, points, points + n);
  status = scene_failures_note(&w->tasks, task, status, pendres_langevin_message(lv));
  free(points);
  scene_noise_close(w->farm, lv);
  return status;
}

/* Nothing is left of a cloud that is broken, but the reason why. */
static void empty_broken(work *w, size_t number)
{
  cloud *c = &w->clouds[number];
  const pendres_langevin_estimate none = { NAN, NAN };
  for (size_t k = number * w->chunks; k < (number + 1) * w->chunks && !is_broken(w, number); k++)
    if (w->tasks.reason[k] != SCENE_FAILURE_NONE)
      scene_failures_mark(&w->failed, number, (scene_failure)w->tasks.reason[k],
                          w->tasks.words[k]);
  if (!is_broken(w, number)) return;
  c->compared = c->narrow = 0;
  c->bias.steps_per_period = 0;
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++)
    c->measured.statistics[s] = c->bias.statistics[s] = none;
  for (size_t k = 0; k < w->strobes; k++)
    w->x[number * w->strobes + k] = w->v[number * w->strobes + k] = NAN;
}

/* ---- results ------------------------------------------------------------------------------- */

typedef struct value {
  double result, error;
} value;

static value statistic(const cloud *c, int which)
{
  return (value){ c->measured.statistics[which].value, c->measured.statistics[which].error };
}

static value bias(const cloud *c, int which)
{
  return (value){ c->bias.statistics[which].value, c->bias.statistics[which].error };
}

static value linear(const cloud *c, int which)
{
  const pendres_langevin_covariance *s = &c->linear.covariance;
  const double of[3] = { s->xx, s->xv, s->vv };
  if (!c->compared) return (value){ NAN, NAN };
  return (value){ of[which - PENDRES_LANGEVIN_COV_XX], c->linear.error };
}

static const struct {
  const char *name, *long_name;
  value (*of)(const cloud *c, int which);
  int which;
} results[] = {
  { "strobe_mean_x", "mean position of the cloud", statistic, PENDRES_LANGEVIN_MEAN_X },
  { "strobe_mean_v", "mean velocity of the cloud", statistic, PENDRES_LANGEVIN_MEAN_V },
  { "strobe_cov_xx", "variance of position in the cloud", statistic, PENDRES_LANGEVIN_COV_XX },
  { "strobe_cov_xv", "covariance of position and velocity in the cloud", statistic,
    PENDRES_LANGEVIN_COV_XV },
  { "strobe_cov_vv", "variance of velocity in the cloud", statistic, PENDRES_LANGEVIN_COV_VV },
  { "linear_cov_xx", "variance of position by linear noise theory", linear,
    PENDRES_LANGEVIN_COV_XX },
  { "linear_cov_xv", "covariance of position and velocity by linear noise theory", linear,
    PENDRES_LANGEVIN_COV_XV },
  { "linear_cov_vv", "variance of velocity by linear noise theory", linear,
    PENDRES_LANGEVIN_COV_VV },
  { "bias_mean_x", "bias of strobe_mean_x by finite steps", bias, PENDRES_LANGEVIN_MEAN_X },
  { "bias_mean_v", "bias of strobe_mean_v by finite steps", bias, PENDRES_LANGEVIN_MEAN_V },
  { "bias_cov_xx", "bias of strobe_cov_xx by finite steps", bias, PENDRES_LANGEVIN_COV_XX },
  { "bias_cov_xv", "bias of strobe_cov_xv by finite steps", bias, PENDRES_LANGEVIN_COV_XV },
  { "bias_cov_vv", "bias of strobe_cov_vv by finite steps", bias, PENDRES_LANGEVIN_COV_VV },
};

enum { RESULTS = sizeof results / sizeof results[0] };

/*
 * Does the cloud agree with linear theory within three of all errors, bias among them? An error
 * as large as half the width in question agrees with anything: that is no verdict.
 */
static int8_t verdict(const cloud *c)
{
  const pendres_langevin_covariance *width = &c->linear.covariance;
  const double scale[3] = { width->xx, sqrt(width->xx * width->vv), width->vv };
  int8_t verdict = AGREES;
  if (c->narrow) return BELOW_ROUNDING;
  if (!c->compared || !isfinite(c->measured.statistics[PENDRES_LANGEVIN_COV_XX].value))
    return NOT_COMPARED;
  for (int k = PENDRES_LANGEVIN_COV_XX; k <= PENDRES_LANGEVIN_COV_VV; k++) {
    const value s = statistic(c, k), l = linear(c, k), b = bias(c, k);
    /* A bias that could not be measured leaves its bound. */
    const double off = isfinite(b.result) ? hypot(b.result, b.error) : bias_wanted * fabs(l.result);
    const double error = sqrt(s.error * s.error + l.error * l.error + off * off);
    if (!(fabs(s.result - l.result) <= 3.0 * error)) return TOO_HOT;
    if (error > 0.5 * scale[k - PENDRES_LANGEVIN_COV_XX]) verdict = UNCERTAIN;
  }
  return verdict;
}

static scene_noise_rate escape_rate(const work *w, size_t number)
{
  const cloud *c = &w->clouds[number];
  const double period = two_pi / attractor_of(w, number)->orbit.pendulum.drive_frequency;
  if (!has_cloud(attractor_of(w, number)) || is_broken(w, number))
    return (scene_noise_rate){ NAN, NAN, NAN, NAN };
  if (!is_followed(w, number)) return (scene_noise_rate){ 0.0, 0.0, 0.0, 0.0 };
  return scene_noise_rate_of((double)c->measured.left, c->measured.exposure, period);
}

#define CLOUD_DIMENSIONS .dimensions = { "temperature", "attractor" }

static pendres_status put(scene_run *run, const char *name, const char *long_name,
                          const double *values, const double *errors, size_t n)
{
  const pendres_store_spec spec = { .name = name, CLOUD_DIMENSIONS, .long_name = long_name };
  return errors != NULL ? pendres_store_put_result(run->store, &spec, values, errors, n)
                        : pendres_store_put(run->store, &spec, values, n);
}

static pendres_status write_strobes(scene_run *run, const work *w)
{
  static const char *const names[2] = { "strobe_x", "strobe_v" };
  static const char *const words[2] = { "position at drive phase 0, around well 0",
                                        "velocity at drive phase 0" };
  static const char *const units[2] = { "rad", "1" };
  pendres_status status = pendres_store_dimension(run->store, "", "strobe", w->strobes, NULL,
                                                  "number of the strobe point", "1");
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {
      .name = names[k], .dimensions = { "temperature", "attractor", "strobe" },
      .long_name = words[k], .units = units[k],
      .comment = "trajectory after trajectory; NaN after an escape" };
    status = pendres_store_put(run->store, &spec, k == 0 ? w->x : w->v,
                               w->temperatures * w->attractors * w->strobes);
  }
  return status;
}

static pendres_status write_statistics(scene_run *run, const work *w, double *a, double *b)
{
  const size_t n = w->temperatures * w->attractors;
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < RESULTS && status == PENDRES_OK; k++) {
    for (size_t i = 0; i < n; i++) {
      const value v = has_cloud(attractor_of(w, i))
                        ? results[k].of(&w->clouds[i], results[k].which)
                        : (value){ NAN, NAN };
      a[i] = v.result;
      b[i] = v.error;
    }
    status = put(run, results[k].name, results[k].long_name, a, b, n);
  }
  return status;
}

static pendres_status write_escapes(scene_run *run, const work *w, double *a, double *b)
{
  const size_t n = w->temperatures * w->attractors;
  for (size_t i = 0; i < n; i++)
    a[i] = is_broken(w, i) ? NAN : (double)w->clouds[i].measured.left;
  pendres_status status =
    put(run, "escapes", "trajectories that left for another attractor or well", a, NULL, n);
  for (size_t i = 0; i < n; i++)
    a[i] = is_broken(w, i) ? NAN
                           : w->clouds[i].measured.exposure *
                               (two_pi / attractor_of(w, i)->orbit.pendulum.drive_frequency);
  if (status == PENDRES_OK)
    status = put(run, "escape_exposure", "time that trajectories were watched", a, NULL, n);
  for (size_t i = 0; i < n; i++) {
    a[i] = escape_rate(w, i).value;
    b[i] = escape_rate(w, i).error;
  }
  if (status == PENDRES_OK)
    status = put(run, "escape_rate", "escapes a unit time", a, b, n);
  for (size_t i = 0; i < n; i++) {
    a[i] = escape_rate(w, i).lower;
    b[i] = escape_rate(w, i).upper;
  }
  if (status == PENDRES_OK)
    status = put(run, "escape_rate_lower", "lower end of its 95 % confidence interval", a, NULL, n);
  if (status == PENDRES_OK)
    status = put(run, "escape_rate_upper", "upper end of its 95 % confidence interval", b, NULL, n);
  return status;
}

static pendres_status write_verdicts(scene_run *run, const work *w)
{
  const char *meanings[VERDICTS];
  const size_t n = w->temperatures * w->attractors;
  for (int k = 0; k < VERDICTS; k++) meanings[k] = verdicts[k].name;
  const pendres_store_spec theory = {
    .name = "linear_theory", .type = PENDRES_STORE_INT8, CLOUD_DIMENSIONS,
    .long_name = "whether the cloud's covariance agrees with linear noise theory",
    .comment = "too_hot: one of the three differs by more than 3 of its standard errors, "
               "which include the bias by finite steps; uncertain: an error above half the "
               "width; below_rounding: so narrow that what linear theory leaves out is below "
               "rounding, so that nothing is followed and the covariance is that of theory",
    .flag_count = VERDICTS, .flag_meanings = meanings };
  const pendres_store_spec steps = { .name = "noise_steps_per_period", .type = PENDRES_STORE_INT32,
                                     CLOUD_DIMENSIONS,
                                     .long_name = "steps a drive period of the noisy integrator" };
  int8_t *verdict_of = malloc(n * sizeof *verdict_of);
  int32_t *steps_of = malloc(n * sizeof *steps_of);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (verdict_of == NULL || steps_of == NULL) goto done;
  for (size_t i = 0; i < n; i++) {
    verdict_of[i] = has_cloud(attractor_of(w, i)) ? verdict(&w->clouds[i]) : NOT_COMPARED;
    steps_of[i] = w->clouds[i].bias.steps_per_period;
  }
  status = pendres_store_put(run->store, &theory, verdict_of, n);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, steps_of, n);
done:
  free(verdict_of);
  free(steps_of);
  return status;
}

static pendres_status write_failed(scene_run *run, const work *w)
{
  pendres_store_spec spec = { .name = "noise_failed", CLOUD_DIMENSIONS,
                              .long_name = "why there is no whole result for the noisy cloud" };
  scene_failure_flags(&spec);
  for (size_t i = 0; i < w->failed.n; i++) {
    if (!is_broken(w, i)) continue;
    run->failed_points++;
    scene_failure_tell(run, (scene_failure)w->failed.reason[i], w->failed.words[i],
                       "noisy cloud at temperature %.10g, attractor %zu", temperature_of(w, i),
                       i % w->attractors);
  }
  return pendres_store_put(run->store, &spec, w->failed.reason, w->failed.n);
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const size_t n = w->temperatures * w->attractors;
  double *a = malloc(2 * n * sizeof *a);
  if (a == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu clouds", n);
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = write_strobes(run, w);
  if (status == PENDRES_OK) status = write_statistics(run, w, a, a + n);
  if (status == PENDRES_OK) status = write_verdicts(run, w);
  if (status == PENDRES_OK) status = write_escapes(run, w, a, a + n);
  if (status == PENDRES_OK) status = write_failed(run, w);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
  free(a);
  return status;
}

static void print_table(FILE *out, const work *w)
{
  fprintf(out, "temperature  attractor   var x        linear       var v        linear       "
               "agree         escapes  rate\n");
  for (size_t i = 0; i < w->temperatures * w->attractors; i++) {
    const cloud *c = &w->clouds[i];
    if (!has_cloud(attractor_of(w, i))) continue;
    fprintf(out, "%-12g %zu %-9s %-12.5g %-12.5g %-12.5g %-12.5g %-13s %-8zu %.3g\n",
            temperature_of(w, i), i % w->attractors, pendres_label_name(attractor_of(w, i)->label),
            statistic(c, PENDRES_LANGEVIN_COV_XX).result, linear(c, PENDRES_LANGEVIN_COV_XX).result,
            statistic(c, PENDRES_LANGEVIN_COV_VV).result, linear(c, PENDRES_LANGEVIN_COV_VV).result,
            verdicts[verdict(c)].words, c->measured.left, escape_rate(w, i).value);
  }
}

static pendres_status compute(scene_run *run, work *w)
{
  const size_t n = w->temperatures * w->attractors;
  w->clouds = calloc(n, sizeof *w->clouds);
  w->parts = calloc(n * w->chunks, sizeof *w->parts);
  w->x = malloc(n * w->strobes * sizeof *w->x);
  w->v = malloc(n * w->strobes * sizeof *w->v);
  if (w->clouds == NULL || w->parts == NULL || w->x == NULL || w->v == NULL ||
      scene_failures_create(n, &w->failed) != PENDRES_OK ||
      scene_failures_create(n * w->chunks, &w->tasks) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu clouds", n);
  for (size_t i = 0; i < n * w->strobes; i++) w->x[i] = w->v[i] = NAN;
  pendres_status status = farm_run(run->farm, "choices of steps", n, choose, NULL, w);
  if (status == PENDRES_OK)
    status = farm_run(run->farm, "chunks of clouds", n * w->chunks, measure, NULL, w);
  if (status != PENDRES_OK) return scene_farm_failed(run, status);
  for (size_t i = 0; i < n; i++) empty_broken(w, i);
  for (size_t i = 0; i < n; i++)
    if (is_followed(w, i))
      scene_noise_merge(w->chunks, w->parts + i * w->chunks, &w->clouds[i].measured);
  return PENDRES_OK;
}

pendres_status scene_basins_write_clouds(scene_run *run, const pendres_attractors *set)
{
  const deck *d = run->deck;
  work w = { .d = d, .farm = run->farm, .set = set,
             .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count,
             .attractors = pendres_attractors_count(set), .strobes = (size_t)d->basins.strobes,
             .trajectories = (size_t)d->basins.trajectories };
  pendres_status status = PENDRES_OK;
  if (w.temperatures == 0 || w.attractors == 0) return PENDRES_OK;
  if (deck_has_noise(d) && w.trajectories < 2)
    return scene_fail(run, PENDRES_INVALID_ARGUMENT,
                      "clouds need at least two trajectories (basins.trajectories)");
  w.chunks = scene_noise_chunks(w.trajectories);
  w.record = (long)((w.strobes + w.trajectories - 1) / w.trajectories);
  status = compute(run, &w);
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  scene_failures_free(&w.failed);
  scene_failures_free(&w.tasks);
  free(w.clouds);
  free(w.parts);
  free(w.x);
  free(w.v);
  return status;
}
