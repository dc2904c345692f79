/*
 * accuracy_fits.c -- fits to measured responses at random parameters, without guesses, beside the
 * values that the data were made with: of bent resonances by the integration of
 * tests/fit_fixture.h, of weak ones, which nothing bends, by the formula of linear response.
 *
 * Errors are standard errors, of which eight are the claim: a datum next to a fold that is off by
 * four, as one of the 24,000 may be, moves the fold by eight. Over all values the distances in
 * standard errors must have a mean within 0.2 of 0 and a width within 0.15 of 1. Where a value is
 * off by more than four and a half of them, a fit that begins at the true values must not come to a
 * smaller chi-square, unless a note says that something may be wrong.
 */
#include "../fit_fixture.h"
#include "accuracy.h"

#include <stdio.h>

enum { SWEEP = 60, DATA = 2 * SWEEP, OPEN = 4, HOW = 400 };

static const double sigmas = 8.0, suspicious = 4.5, farthest_mean = 0.2, farthest_width = 0.15;

typedef enum kind { PENDULUM, HARD, SOFT, KINDS, LINEAR } kind;

/* Weak drives: the amplitude that bends a pendulum's resonance by this share of its width. */
static const double weak_bent = 1e-5;

typedef struct item {
  lab of;
  kind kind;
  double noise, hertz, volts;
  int weak;
  pendres_fit_observable observable;
  int measured; /* the sweeps were computed */
  pendres_status status;
  int noted, jumps;
  double chi_square, from_truth; /* that of a fit which begins at the true values */
  size_t values;
  int quantity[OPEN];
  double got[OPEN], error[OPEN], truth[OPEN];
} item;

/* How far all values are off, in standard errors. */
typedef struct tally {
  long fits, failed, values;
  double sum, squares;
} tally;

/* ---- data ---- */

/* A quality factor from 5 to 5000, noise of 0.1 to 10 % of the largest value, and a backbone that
   is bent by up to 12 widths, where the spring is not more than half as stiff or soft again. */
static void draw(accuracy_random *r, item *t)
{
  static const pendres_fit_observable sizes[] = {PENDRES_FIT_AMPLITUDE, PENDRES_FIT_RMS,
                                                 PENDRES_FIT_FIRST_HARMONIC};
  const double quality = accuracy_logarithmic(r, 5.0, 5000.0);
  const double bent = accuracy_uniform(r, 0.0, 12.0);
  t->kind = (kind)accuracy_choice(r, KINDS);
  t->noise = accuracy_logarithmic(r, 1e-3, 0.1);
  t->observable = sizes[accuracy_choice(r, 3)];
  t->hertz = t->kind == PENDULUM ? accuracy_logarithmic(r, 0.1, 1e7) : 1.0;
  t->volts = t->kind == PENDULUM ? accuracy_logarithmic(r, 1e-6, 10.0) : 1.0;
  const double a3 = fmin(t->kind == SOFT ? 0.25 : 0.5, 4.0 * bent / 3.0 / quality);
  t->of = (lab){.sine = t->kind == PENDULUM, .a1 = 1.0, .damping = 1.0 / quality,
                .a3 = t->kind == SOFT ? -a3 : a3};
  const double size = t->kind == PENDULUM ? fmin(1.8, sqrt(8.0 * bent / quality) + 0.05) : 1.0;
  const double top =
    t->kind == PENDULUM ? 1.0 - size * size / 16.0 : sqrt(1.0 + 0.75 * t->of.a3);
  t->of.drive = size / quality * top;
  t->of.frequency = top;
}

static double observed(const lab_motion *m, pendres_fit_observable o)
{
  return o == PENDRES_FIT_AMPLITUDE ? m->amplitude
         : o == PENDRES_FIT_RMS     ? m->rms
                                    : hypot(m->cosine, m->sine);
}

/* A quality factor from 5 to 100,000, and a drive that bends nothing: of a pendulum down to a
   thousandth of that, of a spring without a cubic term over nine decades. */
static void draw_weak(accuracy_random *r, item *t)
{
  static const pendres_fit_observable sizes[] = {PENDRES_FIT_AMPLITUDE, PENDRES_FIT_RMS,
                                                 PENDRES_FIT_FIRST_HARMONIC, PENDRES_FIT_IN_PHASE};
  const double quality = accuracy_logarithmic(r, 5.0, 1e5);
  t->kind = accuracy_choice(r, 2) ? PENDULUM : LINEAR;
  t->noise = accuracy_logarithmic(r, 1e-3, 0.1);
  t->observable = sizes[accuracy_choice(r, 4)];
  t->hertz = t->kind == PENDULUM ? accuracy_logarithmic(r, 0.1, 1e7) : 1.0;
  t->volts = 1.0;
  t->weak = 1;
  const double size = t->kind == PENDULUM
                        ? sqrt(16.0 * weak_bent / quality) * accuracy_logarithmic(r, 1e-3, 1.0)
                        : accuracy_logarithmic(r, 1e-6, 1e3);
  t->of = (lab){.a1 = 1.0, .damping = 1.0 / quality, .drive = size / quality, .frequency = 1.0};
}

/* The formula's response at one frequency, ... */
static double linear_response(const item *t, double w, pendres_fit_observable o)
{
  const double d = 1.0 - w * w, e = t->of.damping * w, size = t->of.drive / hypot(d, e);
  return o == PENDRES_FIT_IN_PHASE     ? size * d / hypot(d, e)
         : o == PENDRES_FIT_QUADRATURE ? size * e / hypot(d, e)
         : o == PENDRES_FIT_RMS        ? size / sqrt(2.0)
                                       : size;
}

/* ... over 8 to 12 widths, up and down, or both quadratures at each up. */
static void measure_weak(accuracy_random *r, const item *t, pendres_fit_datum data[DATA])
{
  const double low = fmax(1.0 - 5.0 * t->of.damping * accuracy_uniform(r, 0.8, 1.2), 0.2);
  const double high = 1.0 + 5.0 * t->of.damping * accuracy_uniform(r, 0.8, 1.2);
  const int both = t->observable == PENDRES_FIT_IN_PHASE;
  uint64_t seed = r->state;
  const double error = t->noise * linear_response(t, 1.0, both ? PENDRES_FIT_QUADRATURE
                                                               : t->observable);
  for (int i = 0; i < DATA; i++) {
    const double w = low + (high - low) * (i % SWEEP) / (SWEEP - 1);
    const pendres_fit_observable o =
      both && i >= SWEEP ? PENDRES_FIT_QUADRATURE : t->observable;
    data[i] = (pendres_fit_datum){.observable = o, .direction = both || i < SWEEP ? 1 : -1,
                                  .axis = t->hertz * w, .error = error,
                                  .observed = linear_response(t, w, o) + error * lab_normal(&seed)};
  }
}

/* Sixty values up and as many down, from somewhere below the resonance to somewhere above; 0 where
   the sweeps cannot be computed. */
static int measure(accuracy_random *r, item *t, pendres_fit_datum data[DATA])
{
  const double wide = 6.0 * t->of.damping + 0.3 * fabs(t->of.frequency - 1.0);
  const double low =
    fmax(fmin(1.0, t->of.frequency) - wide * accuracy_uniform(r, 0.8, 1.2), 0.35);
  const double high = fmax(1.0, t->of.frequency) + wide * accuracy_uniform(r, 0.8, 1.2);
  uint64_t seed = r->state;
  double frequency[SWEEP], largest = 0.0;
  lab_motion m[SWEEP];
  for (int way = 0; way < 2; way++) {
    for (int i = 0; i < SWEEP; i++)
      frequency[i] = low + (high - low) * (way ? SWEEP - 1 - i : i) / (SWEEP - 1);
    if (lab_sweep(t->of, SWEEP, frequency, m) < SWEEP) return 0;
    for (int i = 0; i < SWEEP; i++) {
      data[way * SWEEP + i] = (pendres_fit_datum){
        .observable = t->observable, .direction = way ? -1 : 1, .axis = t->hertz * frequency[i],
        .observed = t->volts * observed(&m[i], t->observable)};
      largest = fmax(largest, data[way * SWEEP + i].observed);
    }
  }
  for (int i = 0; i < DATA; i++) {
    data[i].error = t->noise * largest;
    data[i].observed += data[i].error * lab_normal(&seed);
  }
  return 1;
}

/* ---- fits ---- */

/* Whether a note says that values may be wrong. */
static int is_doubted(const pendres_fit *fit)
{
  static const char *const words[] = {"wrong", "not converged", "do not determine",
                                      "other values fit"};
  const char *note;
  for (size_t i = 0; (note = pendres_fit_note_get(fit, i)) != NULL; i++)
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
      if (strstr(note, words[k]) != NULL) return 1;
  return 0;
}

static void take(const pendres_fit *fit, item *t)
{
  t->noted = is_doubted(fit);
  while (pendres_fit_jump_get(fit, (size_t)t->jumps) != NULL) t->jumps++;
  t->values = t->weak ? OPEN - 1 : OPEN;
  t->chi_square = pendres_fit_summary_get(fit).chi_square;
  for (size_t i = 0; i < t->values; i++) {
    t->got[i] = pendres_fit_value(fit, i);
    t->error[i] = sqrt(pendres_fit_covariance(fit, i, i));
  }
}

/* The largest distance of a value from the true one, in standard errors. */
static double farthest(const item *t)
{
  double most = 0.0;
  for (size_t i = 0; i < t->values; i++) {
    const double off = fabs((t->got[i] - t->truth[i]) / t->error[i]);
    if (!(off <= most)) most = off; /* NaN, too */
  }
  return most;
}

static void fit_item(const pendres_fit_datum data[DATA], item *t)
{
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  pendres_fit_unknown open[OPEN];
  const int rigid = t->kind == PENDULUM;
  const int quantity[OPEN] = {PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE,
                              rigid ? (int)PENDRES_FIT_FREQUENCY_SCALE : (int)PENDRES_A1,
                              rigid ? (int)PENDRES_FIT_AMPLITUDE_SCALE : (int)PENDRES_A3};
  const double truth[OPEN] = {t->of.damping, t->of.drive, rigid ? t->hertz : t->of.a1,
                              rigid ? t->volts : t->of.a3};
  for (size_t i = 0; i < OPEN; i++) {
    open[i] = (pendres_fit_unknown){.quantity = quantity[i], .guess = NAN};
    t->quantity[i] = quantity[i];
    t->truth[i] = truth[i];
  }
  const pendres_fit_model model = {
    .pendulum.force = rigid ? PENDRES_FORCE_PENDULUM : PENDRES_FORCE_POLYNOMIAL,
    .unknowns = t->weak ? OPEN - 1 : OPEN, .unknown = open};
  const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  t->status = pendres_context_create(NULL, &ctx);
  if (t->status == PENDRES_OK) t->status = pendres_fit_find(ctx, &all, &model, NULL, &fit);
  if (fit != NULL) take(fit, t);
  pendres_fit_free(fit);
  fit = NULL;
  t->from_truth = t->chi_square;
  if (t->status == PENDRES_OK && !(farthest(t) <= suspicious)) {
    for (size_t i = 0; i < OPEN; i++) open[i].guess = truth[i];
    (void)pendres_fit_find(ctx, &all, &model, NULL, &fit);
    t->from_truth = pendres_fit_summary_get(fit).chi_square;
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

static void compute_bent(accuracy_random *r, void *of, long number)
{
  pendres_fit_datum data[DATA];
  item *t = of;
  (void)number;
  draw(r, t);
  t->measured = measure(r, t, data);
  if (t->measured) fit_item(data, t);
}

static void compute_weak(accuracy_random *r, void *of, long number)
{
  pendres_fit_datum data[DATA];
  item *t = of;
  (void)number;
  draw_weak(r, t);
  measure_weak(r, t, data);
  t->measured = 1;
  fit_item(data, t);
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  tally *sum = counts;
  char how[HOW];
  int used = snprintf(how, sizeof how, "item %ld: %s, Q %.5g, a3 %.5g, drive %.5g, noise %.2g, %s, "
                      "%d jumps:", number, t->kind == PENDULUM ? "pendulum" : "spring",
                      1.0 / t->of.damping, t->of.a3, t->of.drive, t->noise,
                      pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)t->observable), t->jumps);
  if (!t->measured) return;
  sum->fits++;
  sum->failed += t->status != PENDRES_OK;
  if (t->status != PENDRES_OK && t->status != PENDRES_NOT_CONVERGED)
    accuracy_complain(a, "a fit failed", how);
  if (t->status != PENDRES_OK) return; /* it says so */
  for (size_t i = 0; i < t->values; i++)
    used += snprintf(how + used, sizeof how - (size_t)used, " %.2f",
                     (t->got[i] - t->truth[i]) / t->error[i]);
  const int is_wrong = t->from_truth > 0.0 && t->from_truth < t->chi_square - 1.0;
  if (is_wrong && !t->noted) accuracy_complain(a, "a wrong minimum without a note", how);
  for (size_t i = 0; i < t->values && !is_wrong; i++) {
    if (isinf(t->error[i])) continue;
    const double pull = (t->got[i] - t->truth[i]) / t->error[i];
    sum->values++;
    sum->sum += pull;
    sum->squares += pull * pull;
    accuracy_note(a, pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, t->quantity[i]), t->got[i],
                  sigmas * t->error[i], t->truth[i], how);
  }
}

/* All fits of a family, and their distances together. */
static void judge(accuracy *a, const char *family,
                  void (*compute_one)(accuracy_random *r, void *of, long number))
{
  tally sum = {.fits = 0};
  const accuracy_work work = {.items = (accuracy_get_options(a)->points + 4) / 5, .at_once = 16,
                              .size = sizeof(item), .compute = compute_one, .note = note,
                              .tally = &sum};
  (void)accuracy_each(a, &work);
  const double n = (double)sum.values, mean = sum.sum / n;
  const double width = sqrt(sum.squares / n - mean * mean);
  char how[HOW];
  snprintf(how, sizeof how, "%ld of %s, %ld not converged, distances from the true values in "
           "standard errors: mean %.3f, width %.3f", sum.fits, family, sum.failed, mean, width);
  printf("\nfits: %s\n", how);
  if (sum.values >= 400 && !(fabs(mean) < farthest_mean && fabs(width - 1.0) < farthest_width))
    accuracy_complain(a, "standard errors are not what they say", how);
}

void accuracy_fits(accuracy *a)
{
  judge(a, "bent sweeps", compute_bent);
  judge(a, "weak sweeps", compute_weak);
  accuracy_fit_errors(a);
}
