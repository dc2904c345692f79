/*
 * accuracy_lines.c -- quality factors from scattering parameters, begun from data alone, beside
 * those that made the data (tests/line_fixture.h): transmission, notch and reflection behind cables
 * of up to 100 ns, linear, or bent by up to six widths with the jumps of both directions.
 *
 * Claims are eight standard errors, as of other fits. Quality factors are compared by their losses,
 * 1/Q, in which the data are linear. Resonances that noise hides are not drawn: they add less than
 * six errors of S where they are largest.
 */
#include "../fit_fixture.h"
#include "../line_fixture.h"
#include "accuracy.h"

#include <stdio.h>

enum { POINTS = 201, OPEN = 8, HOW = 300 };

static const double sigmas = 8.0, widest = 1.15, narrowest = 0.85, faintest = 6.0;

typedef struct item {
  pendres_status status;
  lab_line line;
  double noise, bend;
  size_t n;
  int quantity[OPEN];
  double got[OPEN], error[OPEN], truth[OPEN];
} item;

typedef struct tally {
  long sets, failed, values, open;
  double sum, squares;
} tally;

static void open_one(item *t, int quantity, double truth)
{
  t->quantity[t->n] = quantity;
  t->truth[t->n++] = truth;
}

static void draw(accuracy_random *r, item *t, long number)
{
  lab_line *l = &t->line;
  double height;
  do {
    *l = (lab_line){.kind = (int)(number % 3), .f0 = accuracy_logarithmic(r, 1e9, 1e10),
                    .qi = accuracy_logarithmic(r, 1e3, 1e6),
                    .qc = accuracy_logarithmic(r, 1e3, 1e6),
                    .phase = accuracy_uniform(r, -0.8, 0.8),
                    .delay = accuracy_uniform(r, 0.0, 1e-7),
                    .amplitude = accuracy_logarithmic(r, 0.3, 3.0),
                    .angle = accuracy_uniform(r, -3.0, 3.0), .drive = 1e-4,
                    .leak = {accuracy_uniform(r, -0.4, 0.4), accuracy_uniform(r, -0.4, 0.4)}};
    if (l->kind == 0) l->qc = INFINITY;
    t->noise = accuracy_logarithmic(r, 1e-3, 3e-2);
    height = l->kind == 0 ? 1.0 : l->kind / (l->qc * line_damping(l) * cos(l->phase));
  } while (height < faintest * t->noise);
  const double g = line_damping(l);
  if (number % 2 == 1) t->bend = accuracy_logarithmic(r, 0.2, 6.0) * (number % 4 == 1 ? 1 : -1);
  l->cubic = t->bend * 8.0 / 3.0 * g * g * g / (l->drive * l->drive);
  open_one(t, PENDRES_FIT_INTERNAL_Q, l->qi);
  open_one(t, PENDRES_FIT_FREQUENCY_SCALE, l->f0);
  open_one(t, PENDRES_FIT_DELAY, l->delay);
  open_one(t, PENDRES_FIT_BACKGROUND_AMPLITUDE, l->amplitude);
  open_one(t, PENDRES_FIT_BACKGROUND_PHASE, l->angle);
  open_one(t, l->kind == 0 ? PENDRES_FIT_BACKGROUND_IN_PHASE : PENDRES_FIT_COUPLING_Q,
           l->kind == 0 ? l->leak[0] : l->qc);
  open_one(t, l->kind == 0 ? PENDRES_FIT_BACKGROUND_QUADRATURE : PENDRES_FIT_COUPLING_PHASE,
           l->kind == 0 ? l->leak[1] : l->phase);
  if (t->bend != 0.0) open_one(t, (int)PENDRES_A3, l->cubic);
}

static size_t measure(accuracy_random *r, item *t, pendres_fit_datum *data)
{
  double f[POINTS], re[POINTS], im[POINTS];
  const double width = t->line.f0 * line_damping(&t->line);
  const double middle = t->line.f0 + width * (accuracy_uniform(r, -1.0, 1.0) + 0.4 * t->bend);
  const double span = width * (accuracy_uniform(r, 8.0, 20.0) + 1.5 * fabs(t->bend));
  const double error = t->noise * t->line.amplitude;
  uint64_t seed = r->state;
  size_t n = 0;
  t->line.middle = middle;
  for (int way = 1; way >= (t->bend != 0.0 ? -1 : 1); way -= 2) {
    for (int i = 0; i < POINTS; i++) f[i] = middle + way * span * (i / (POINTS - 1.0) - 0.5);
    line_sweep(&t->line, POINTS, f, re, im);
    for (int i = 0; i < 2 * POINTS; i++)
      data[n++] = (pendres_fit_datum){
        .observable = (pendres_fit_observable)(PENDRES_FIT_TRANSMISSION_REAL +
                                               2 * t->line.kind + i % 2),
        .direction = way, .axis = f[i / 2], .error = error,
        .observed = (i % 2 ? im : re)[i / 2] + error * lab_normal(&seed)};
  }
  return n;
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_fit_datum data[4 * POINTS];
  pendres_fit_unknown unknown[OPEN];
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  draw(r, t, number);
  const pendres_fit_data all = {.n = measure(r, t, data), .datum = data,
                                .axis = PENDRES_DRIVE_FREQUENCY, .other = PENDRES_PARAMETER_COUNT};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0},
                 .drive_amplitude = t->line.drive}, .unknowns = t->n, .unknown = unknown};
  for (size_t i = 0; i < t->n; i++)
    unknown[i] = (pendres_fit_unknown){.quantity = t->quantity[i], .guess = NAN};
  t->status = pendres_context_create(NULL, &ctx);
  if (t->status == PENDRES_OK) t->status = pendres_fit_find(ctx, &all, &model, NULL, &fit);
  for (size_t i = 0; i < t->n && fit != NULL; i++) {
    t->got[i] = pendres_fit_value(fit, i);
    t->error[i] = sqrt(pendres_fit_covariance(fit, i, i));
    if (t->quantity[i] == PENDRES_FIT_BACKGROUND_PHASE)
      t->got[i] = t->truth[i] + remainder(t->got[i] - t->truth[i], 2.0 * lab_pi);
    if (t->quantity[i] != PENDRES_FIT_INTERNAL_Q && t->quantity[i] != PENDRES_FIT_COUPLING_Q)
      continue;
    t->error[i] /= t->got[i] * t->got[i];
    t->got[i] = 1.0 / t->got[i];
    t->truth[i] = 1.0 / t->truth[i];
  }
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  tally *sum = counts;
  char how[HOW], kind[80];
  snprintf(how, sizeof how, "item %ld: kind %d, Qi %.3g, Qc %.3g, noise %.2g, bend %.3g", number,
           t->line.kind, t->line.qi, t->line.qc, t->noise, t->bend);
  if (t->status != PENDRES_OK && t->status != PENDRES_NOT_CONVERGED)
    accuracy_complain(a, "a fit failed", how);
  sum->sets++;
  sum->failed += t->status != PENDRES_OK;
  if (t->status != PENDRES_OK) return; /* it says so */
  for (size_t i = 0; i < t->n; i++) {
    const double pull = (t->got[i] - t->truth[i]) / t->error[i];
    snprintf(kind, sizeof kind, "line: %s%s",
             pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, t->quantity[i]),
             t->bend != 0.0 ? ", bent" : "");
    accuracy_note(a, kind, t->got[i], sigmas * t->error[i], t->truth[i], how);
    sum->open += isfinite(t->error[i]) == 0;
    if (!isfinite(t->error[i])) continue;
    sum->values++;
    sum->sum += pull;
    sum->squares += pull * pull;
  }
}

void accuracy_lines(accuracy *a)
{
  tally sum = {.sets = 0};
  const accuracy_work work = {.items = accuracy_get_options(a)->points, .at_once = 16,
                              .size = sizeof(item), .compute = compute, .note = note,
                              .tally = &sum};
  (void)accuracy_each(a, &work);
  char how[HOW];
  const double n = (double)sum.values, mean = sum.sum / n;
  const double width = sqrt(sum.squares / n - mean * mean);
  snprintf(how, sizeof how, "%ld sets, of which %ld say that they have not converged, %ld values, "
           "%ld without an error, distances from the true ones in standard errors: mean %.3f, "
           "width %.3f", sum.sets, sum.failed, sum.values, sum.open, mean, width);
  printf("fits of lines: %s\n", how);
  if (n >= 400.0 && !(fabs(mean) < 0.2 && width < widest && width > narrowest))
    accuracy_complain(a, "standard errors are not what they say", how);
}
