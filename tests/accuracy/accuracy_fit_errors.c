/*
 * accuracy_fit_errors.c -- fits whose errors are no matter of derivatives at the best values: free
 * decays whose scale the bend of the force alone tells, well or not at all, by the integration of
 * tests/fit_fixture.h; and linear responses with outliers under Huber's loss, in closed form.
 *
 * Claims are eight standard errors, as of other fits. Widths are within 0.15 of 1, where data leave
 * a direction open at most 1.15: an error that was widened may be wider than a normal one.
 */
#include "../fit_fixture.h"
#include "accuracy.h"

#include <stdio.h>

enum { MOST = 1500, SWEEP = 60, OPEN = 5, HOW = 300 };

static const double sigmas = 8.0, widest = 1.15, narrowest = 0.85;

typedef struct item {
  pendres_status status;
  double huber, noise;
  lab of;
  size_t n;
  double got[OPEN], error[OPEN], truth[OPEN];
} item;

typedef struct tally {
  int soft;
  long values;
  double sum, squares;
} tally;

static void take(item *t, const pendres_fit_data *data, pendres_fit_model *model,
                 const int quantity[])
{
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  pendres_fit_unknown open[OPEN];
  const pendres_fit_options options = {.huber = t->huber};
  for (size_t i = 0; i < t->n; i++)
    open[i] = (pendres_fit_unknown){.quantity = quantity[i], .guess = t->huber > 0.0 ? t->truth[i]
                                                                                     : NAN};
  model->unknowns = t->n;
  model->unknown = open;
  t->status = pendres_context_create(NULL, &ctx);
  if (t->status == PENDRES_OK) t->status = pendres_fit_find(ctx, data, model, &options, &fit);
  for (size_t i = 0; i < t->n && fit != NULL; i++) {
    t->got[i] = pendres_fit_value(fit, i);
    t->error[i] = sqrt(pendres_fit_covariance(fit, i, i));
  }
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

/* Q from 10 to 300, a spring that is bent by up to a half either way or not at all, a start of 0.1
   to 0.9, noise of 0.3 to 10 % of it. */
static void decay(accuracy_random *r, void *of, long number)
{
  static const int quantity[OPEN] = {PENDRES_DAMPING, PENDRES_FIT_FREQUENCY_SCALE,
                                     PENDRES_FIT_AMPLITUDE_SCALE, PENDRES_FIT_START_DISPLACEMENT,
                                     PENDRES_FIT_START_VELOCITY};
  item *t = of;
  pendres_fit_datum data[MOST];
  double time[MOST], y[MOST];
  const double q = accuracy_logarithmic(r, 10.0, 300.0), bent = accuracy_logarithmic(r, 0.01, 0.5);
  const double size = accuracy_logarithmic(r, 0.1, 0.9), phase = accuracy_uniform(r, 0.0, 6.28);
  const double each = accuracy_logarithmic(r, 12.0, 30.0);
  const double cycles = fmax(8.0, fmin(q * accuracy_uniform(r, 0.3, 1.0), MOST / each));
  const double truth[OPEN] = {1.0 / q, 1000.0, 2.5, size * cos(phase), size * sin(phase)};
  uint64_t seed = r->state;
  const size_t n = (size_t)fmin(MOST, each * cycles);
  t->n = OPEN;
  t->noise = accuracy_logarithmic(r, 3e-3, 0.1);
  t->of = (lab){.a1 = 1.0, .a3 = number % 3 == 0 ? 0.0 : number % 3 == 1 ? bent : -0.5 * bent,
                .damping = 1.0 / q};
  memcpy(t->truth, truth, sizeof truth);
  for (size_t i = 0; i < n; i++)
    time[i] = i == 0 ? 0.0 : ((double)i + 0.8 * lab_uniform(&seed)) * 2.0 * lab_pi / each;
  lab_decay(t->of, truth[3], truth[4], n, time, y);
  for (size_t i = 0; i < n; i++)
    data[i] = (pendres_fit_datum){
      .observable = PENDRES_FIT_DISPLACEMENT, .direction = 1,
      .axis = time[i] / (2.0 * lab_pi * truth[1]), .error = truth[2] * size * t->noise,
      .observed = truth[2] * (y[i] + size * t->noise * lab_normal(&seed))};
  pendres_fit_model model = {.pendulum = {.force = PENDRES_FORCE_POLYNOMIAL,
                                          .force_coefficients = {1.0, 0.0, t->of.a3}}};
  const pendres_fit_data all = {.n = n, .datum = data, .axis = PENDRES_PARAMETER_COUNT,
                                .other = PENDRES_PARAMETER_COUNT};
  take(t, &all, &model, quantity);
}

/* Up to a fifth of the data are ten times as far off. */
static void response(accuracy_random *r, void *of, long number)
{
  static const int quantity[] = {PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE};
  item *t = of;
  pendres_fit_datum data[SWEEP];
  const double dirty = number % 2 == 0 ? 0.0 : accuracy_uniform(r, 0.05, 0.2);
  uint64_t seed = r->state;
  t->n = 2;
  t->huber = accuracy_uniform(r, 1.0, 2.5);
  t->noise = accuracy_logarithmic(r, 1e-3, 0.03);
  t->of = (lab){.a1 = 1.0, .damping = accuracy_logarithmic(r, 0.1, 0.4), .drive = 0.3};
  t->truth[0] = t->of.damping;
  t->truth[1] = t->of.drive;
  for (int i = 0; i < SWEEP; i++) {
    const double w = 0.5 + 1.0 * i / (SWEEP - 1), top = t->of.drive / t->of.damping;
    const double far = lab_uniform(&seed) < dirty ? 10.0 : 1.0;
    data[i] = (pendres_fit_datum){
      .observable = PENDRES_FIT_AMPLITUDE, .direction = 1, .axis = w, .error = t->noise * top,
      .observed = fabs(t->of.drive / hypot(1.0 - w * w, t->of.damping * w) +
                       far * t->noise * top * lab_normal(&seed))}; /* as instruments have it */
  }
  pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}}};
  const pendres_fit_data all = {.n = SWEEP, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  take(t, &all, &model, quantity);
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  tally *sum = counts;
  char how[HOW], kind[80];
  snprintf(how, sizeof how, "item %ld: Q %.5g, a3 %.5g, noise %.2g, huber %.3g", number,
           1.0 / t->of.damping, t->of.a3, t->noise, t->huber);
  if (t->status != PENDRES_OK && t->status != PENDRES_NOT_CONVERGED)
    accuracy_complain(a, "a fit failed", how);
  if (t->status != PENDRES_OK) return; /* it says so */
  for (size_t i = 0; i < t->n; i++) {
    const double pull = (t->got[i] - t->truth[i]) / t->error[i];
    snprintf(kind, sizeof kind, "%s %zu", sum->soft ? "with outliers" : "open", i);
    accuracy_note(a, kind, t->got[i], sigmas * t->error[i], t->truth[i], how);
    if (isinf(t->error[i])) continue;
    sum->values++;
    sum->sum += pull;
    sum->squares += pull * pull;
  }
}

void accuracy_fit_errors(accuracy *a)
{
  for (int soft = 0; soft < 2; soft++) {
    tally sum = {.soft = soft};
    const accuracy_work work = {.items = (accuracy_get_options(a)->points + 4) / 5, .at_once = 16,
                                .size = sizeof(item), .compute = soft ? response : decay,
                                .note = note, .tally = &sum};
    (void)accuracy_each(a, &work);
    char how[HOW];
    const double n = (double)sum.values, mean = sum.sum / n;
    const double width = sqrt(sum.squares / n - mean * mean);
    snprintf(how, sizeof how, "%ld values, distances from the true ones in standard errors: mean "
             "%.3f, width %.3f", sum.values, mean, width);
    printf("fits %s: %s\n", soft ? "with outliers" : "with an open direction", how);
    if (n >= 400.0 && !(fabs(mean) < 0.2 && width < widest && (!soft || width > narrowest)))
      accuracy_complain(a, "standard errors are not what they say", how);
  }
}
