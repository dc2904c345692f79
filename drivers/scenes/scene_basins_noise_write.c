/*
 * scene_basins_noise_write.c -- what is written of clouds under noise: their statistics beside
 * those of linear theory, whether the two agree, strobe points and escapes; and their table.
 */
#include "scenes/scene_basins_clouds.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define CLOUD_DIMENSIONS .dimensions = { "temperature", "attractor" }

#define OF(field) offsetof(pendres_cloud, field)
#define MEASURED(s) OF(measured.statistics[s].value), OF(measured.statistics[s].error)
#define BIAS(s) OF(bias.statistics[s].value), OF(bias.statistics[s].error)
enum { X = PENDRES_LANGEVIN_MEAN_X, V = PENDRES_LANGEVIN_MEAN_V, XX = PENDRES_LANGEVIN_COV_XX,
       XV = PENDRES_LANGEVIN_COV_XV, VV = PENDRES_LANGEVIN_COV_VV };

/* Numbers of a cloud and their errors; those without one say 0. */
typedef struct result {
  const char *name, *long_name;
  size_t value, error;
} result;

static const result statistics[] = {
  { "strobe_mean_x", "mean position of the cloud", MEASURED(X) },
  { "strobe_mean_v", "mean velocity of the cloud", MEASURED(V) },
  { "strobe_cov_xx", "variance of position in the cloud", MEASURED(XX) },
  { "strobe_cov_xv", "covariance of position and velocity in the cloud", MEASURED(XV) },
  { "strobe_cov_vv", "variance of velocity in the cloud", MEASURED(VV) },
  { "linear_cov_xx", "variance of position by linear noise theory", OF(linear.xx),
    OF(linear_error) },
  { "linear_cov_xv", "covariance of position and velocity by linear noise theory", OF(linear.xv),
    OF(linear_error) },
  { "linear_cov_vv", "variance of velocity by linear noise theory", OF(linear.vv),
    OF(linear_error) },
  { "bias_mean_x", "bias of strobe_mean_x by finite steps", BIAS(X) },
  { "bias_mean_v", "bias of strobe_mean_v by finite steps", BIAS(V) },
  { "bias_cov_xx", "bias of strobe_cov_xx by finite steps", BIAS(XX) },
  { "bias_cov_xv", "bias of strobe_cov_xv by finite steps", BIAS(XV) },
  { "bias_cov_vv", "bias of strobe_cov_vv by finite steps", BIAS(VV) },
};

static const result escapes[] = {
  { "escape_exposure", "time that trajectories were watched", OF(escape_exposure), 0 },
  { "escape_rate", "escapes a unit time", OF(escape_rate.value), OF(escape_rate.error) },
  { "escape_rate_lower", "lower end of its 95 % confidence interval", OF(escape_rate.lower), 0 },
  { "escape_rate_upper", "upper end of its 95 % confidence interval", OF(escape_rate.upper), 0 },
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

/* A number of a cloud; NaN of one that is broken. */
static double number_of(const cloud_work *w, size_t number, size_t offset)
{
  double value;
  if (is_broken(w, number)) return NAN;
  memcpy(&value, (const char *)&w->clouds[number] + offset, sizeof value);
  return value;
}

static pendres_status write_numbers(scene_run *run, const cloud_work *w, size_t count,
                                    const result *results, double *value, double *error)
{
  const size_t n = w->temperatures * w->attractors;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < count && status == PENDRES_OK; k++) {
    const result *r = &results[k];
    const pendres_store_spec spec = { .name = r->name, CLOUD_DIMENSIONS,
                                      .long_name = r->long_name };
    for (size_t i = 0; i < n; i++) {
      value[i] = number_of(w, i, r->value);
      error[i] = number_of(w, i, r->error);
    }
    status = r->error > 0 ? pendres_store_put_result(run->store, &spec, value, error, n)
                          : pendres_store_put(run->store, &spec, value, n);
  }
  return status;
}

static pendres_status write_escapes(scene_run *run, const cloud_work *w, double *a, double *b)
{
  const size_t n = w->temperatures * w->attractors;
  const pendres_store_spec spec = {
    .name = "escapes", CLOUD_DIMENSIONS,
    .long_name = "trajectories that left for another attractor or well" };
  for (size_t i = 0; i < n; i++)
    a[i] = is_broken(w, i) ? NAN : (double)w->clouds[i].measured.left;
  const pendres_status status = pendres_store_put(run->store, &spec, a, n);
  if (status != PENDRES_OK) return status;
  return write_numbers(run, w, sizeof escapes / sizeof *escapes, escapes, a, b);
}

static pendres_cloud_verdict verdict_of(const cloud_work *w, size_t number)
{
  return is_broken(w, number) ? PENDRES_CLOUD_NOT_COMPARED : w->clouds[number].verdict;
}

static pendres_status write_verdicts(scene_run *run, const cloud_work *w)
{
  const char *meanings[PENDRES_CLOUD_VERDICTS];
  const size_t n = w->temperatures * w->attractors;
  for (int k = 0; k < PENDRES_CLOUD_VERDICTS; k++)
    meanings[k] = pendres_cloud_verdict_name((pendres_cloud_verdict)k);
  const pendres_store_spec theory = {
    .name = "linear_theory", .type = PENDRES_STORE_INT8, CLOUD_DIMENSIONS,
    .long_name = "whether the cloud's covariance agrees with linear noise theory",
    .comment = "too_hot: one of the three differs by more than 3 of its standard errors, "
               "which include the bias by finite steps; uncertain: an error above half the "
               "width; below_rounding: so narrow that what linear theory leaves out is below "
               "rounding, so that nothing is followed and the covariance is that of theory",
    .flag_count = PENDRES_CLOUD_VERDICTS, .flag_meanings = meanings };
  const pendres_store_spec steps = { .name = "noise_steps_per_period", .type = PENDRES_STORE_INT32,
                                     CLOUD_DIMENSIONS,
                                     .long_name = "steps a drive period of the noisy integrator" };
  int8_t *verdict = malloc(n * sizeof *verdict);
  int32_t *steps_of = malloc(n * sizeof *steps_of);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (verdict == NULL || steps_of == NULL) goto done;
  for (size_t i = 0; i < n; i++) {
    verdict[i] = (int8_t)verdict_of(w, i);
    steps_of[i] = is_broken(w, i) ? 0 : w->clouds[i].bias.steps_per_period;
  }
  status = pendres_store_put(run->store, &theory, verdict, n);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, steps_of, n);
done:
  free(verdict);
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
                       "noisy cloud at temperature %.10g, attractor %zu",
                       cloud_request(w, i).temperature, i % w->attractors);
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
  if (status == PENDRES_OK)
    status = write_numbers(run, w, sizeof statistics / sizeof *statistics, statistics, a, a + n);
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
    const pendres_cloud *c = &w->clouds[i];
    const size_t attractor = i % w->attractors;
    if (c->way == PENDRES_CLOUD_NONE && !is_broken(w, i)) continue;
    fprintf(out, "%-12g %zu %-9s %-12.5g %-12.5g %-12.5g %-12.5g %-13s %-8zu %.3g\n",
            cloud_request(w, i).temperature, attractor,
            pendres_label_name(pendres_attractors_get(w->set, attractor)->label),
            number_of(w, i, OF(measured.statistics[XX].value)), number_of(w, i, OF(linear.xx)),
            number_of(w, i, OF(measured.statistics[VV].value)), number_of(w, i, OF(linear.vv)),
            agree[verdict_of(w, i)], c->measured.left,
            number_of(w, i, OF(escape_rate.value)));
  }
}
