/*
 * scene_basins_noise_write.c -- what is written of clouds under noise: their statistics beside
 * those of linear theory, whether the two agree, strobe points and escapes; and their table.
 */
#include "scenes/scene_basins_clouds.h"
#include "scenes/scene_columns.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* A cloud as a row of results. */
typedef struct row {
  pendres_cloud of;
  double escapes;
} row;

#define OF(field) offsetof(row, of.field)
#define STATISTIC(label, s, words)                                                   \
  {.name = #label, .long_name = words, .value = OF(measured.statistics[s].value),    \
   .error = OF(measured.statistics[s].error)}
#define LINEAR(label, field, words)                                                  \
  {.name = #label, .long_name = words " by linear noise theory",                     \
   .value = OF(linear.field), .error = OF(linear_error)}
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
    status = pendres_store_put(run->store, &spec, k == 0 ? w->x : w->v,
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
  row *rows = scene_rows(run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"temperature", "attractor"}, .n = n,
                             .stride = sizeof *rows, .rows = rows, .missing = w->failed.reason};
  if (rows == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) {
    rows[i] = (row){w->clouds[i], (double)w->clouds[i].measured.left};
    rows[i].of.verdict = verdict_of(w, i);
  }
  const pendres_status status = SCENE_WRITE(run, &table, columns);
  free(rows);
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
  return pendres_store_put(run->store, &spec, w->failed.reason, w->failed.n);
}

pendres_status scene_basins_clouds_write(scene_run *run, const cloud_work *w)
{
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = write_strobes(run, w);
  if (status == PENDRES_OK) status = write_clouds(run, w);
  if (status == PENDRES_OK) status = write_failed(run, w);
  return scene_stored(run, status);
}

void scene_basins_clouds_print(FILE *out, const cloud_work *w)
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
            pendres_label_name(pendres_attractors_get(w->set, attractor)->label),
            broken ? NAN : c->measured.statistics[XX].value, broken ? NAN : c->linear.xx,
            broken ? NAN : c->measured.statistics[VV].value, broken ? NAN : c->linear.vv,
            agree[verdict_of(w, i)], c->measured.left,
            broken ? NAN : c->escape_rate.value);
  }
}
