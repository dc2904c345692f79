/*
 * scene_basins_noise_write.c -- what is written of clouds under noise: their statistics beside
 * those of linear theory, whether the two agree, strobe points and escapes; and their table.
 */
#include "scenes/scene_basins_clouds.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647693;

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
    const double off = isfinite(b.result) ? hypot(b.result, b.error)
                                          : CLOUD_BIAS_WANTED * fabs(l.result);
    const double error = sqrt(s.error * s.error + l.error * l.error + off * off);
    if (!(fabs(s.result - l.result) <= 3.0 * error)) return TOO_HOT;
    if (error > 0.5 * scale[k - PENDRES_LANGEVIN_COV_XX]) verdict = UNCERTAIN;
  }
  return verdict;
}

static pendres_langevin_interval escape_rate(const cloud_work *w, size_t number)
{
  const cloud *c = &w->clouds[number];
  const double period = two_pi / attractor_of(w, number)->orbit.pendulum.drive_frequency;
  if (!has_cloud(attractor_of(w, number)) || is_broken(w, number))
    return (pendres_langevin_interval){ NAN, NAN, NAN, NAN };
  if (!is_followed(w, number)) return (pendres_langevin_interval){ 0.0, 0.0, 0.0, 0.0 };
  pendres_langevin_interval rate;
  (void)pendres_langevin_rate((double)c->measured.left, c->measured.exposure * period, 0.95, &rate);
  return rate;
}

#define CLOUD_DIMENSIONS .dimensions = { "temperature", "attractor" }

static pendres_status put(scene_run *run, const char *name, const char *long_name,
                          const double *values, const double *errors, size_t n)
{
  const pendres_store_spec spec = { .name = name, CLOUD_DIMENSIONS, .long_name = long_name };
  return errors != NULL ? pendres_store_put_result(run->store, &spec, values, errors, n)
                        : pendres_store_put(run->store, &spec, values, n);
}

static pendres_status write_strobes(scene_run *run, const cloud_work *w)
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

static pendres_status write_statistics(scene_run *run, const cloud_work *w, double *a, double *b)
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

static pendres_status write_escapes(scene_run *run, const cloud_work *w, double *a, double *b)
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

static pendres_status write_verdicts(scene_run *run, const cloud_work *w)
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

static pendres_status write_failed(scene_run *run, const cloud_work *w)
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

pendres_status scene_basins_clouds_write(scene_run *run, const cloud_work *w)
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

void scene_basins_clouds_print(FILE *out, const cloud_work *w)
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
