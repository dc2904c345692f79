/* switching_fit.c -- the activation energy from rates at several temperatures; see switching.h. */
#include <pendres/switching.h>

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_fit.h>
#include <gsl/gsl_multifit.h>

#include "noise/noise_common.h"

/* Unknowns of the fit: ln rate at T0, energy / T0, the prefactor's power, two corrections. */
enum { RATE, ENERGY, POWER, FIRST, SECOND, UNKNOWNS, PRIORS = UNKNOWNS - POWER };

/* The standard deviations that the last three are assumed to have beforehand: see switching.h. */
static const double prior[PRIORS] = {0.5, 1.0, 1.0};

/* The temperatures that count. */
typedef struct sample {
  size_t count;
  double *temperature, *log_rate, *weight; /* [count] */
  double middle;                           /* T0 */
  double line_energy;                      /* of the straight line */
} sample;

/* Take over the temperatures that count; memory has room for 3 n numbers. */
static pendres_status select_points(size_t n, const double *temperature,
                                    const pendres_switching_rate *rates, double fewest,
                                    double *memory, sample *s)
{
  double sum = 0.0, coldest = INFINITY, hottest = 0.0;
  *s = (sample){.temperature = memory, .log_rate = memory + n, .weight = memory + 2 * n};
  for (size_t i = 0; i < n; i++) {
    const pendres_switching_rate *r = &rates[i];
    const double t = temperature[i], share = r->error / r->value;
    if (!(r->events >= fewest)) continue;
    if (!(t > 0.0 && isfinite(t) && r->value > 0.0 && share > 0.0 && isfinite(share)))
      return PENDRES_INVALID_ARGUMENT;
    s->temperature[s->count] = t;
    s->log_rate[s->count] = log(r->value);
    s->weight[s->count++] = 1.0 / (share * share);
    sum += log(t);
    coldest = fmin(coldest, t);
    hottest = fmax(hottest, t);
  }
  if (!(hottest > coldest)) return PENDRES_NOT_FOUND;
  s->middle = exp(sum / (double)s->count);
  return PENDRES_OK;
}

/* The slope of the straight line, which is the scale of the corrections in T/E. */
static pendres_status fit_line(sample *s, double *inverse)
{
  double c0, c1, v00, v01, v11, chi2;
  for (size_t i = 0; i < s->count; i++) inverse[i] = 1.0 / s->temperature[i];
  if (gsl_fit_wlinear(inverse, 1, s->weight, 1, s->log_rate, 1, s->count, &c0, &c1, &v00, &v01,
                      &v11, &chi2) != 0)
    return PENDRES_INTERNAL;
  s->line_energy = fabs(c1);
  return PENDRES_OK;
}

/* The rows of the fit: one for each temperature, then what is assumed of the prefactor. */
static void fill_rows(const sample *s, gsl_matrix *rows, gsl_vector *wanted, gsl_vector *weight)
{
  const double t0 = s->middle, e = s->line_energy;
  gsl_matrix_set_zero(rows);
  gsl_vector_set_zero(wanted);
  for (size_t i = 0; i < s->count; i++) {
    const double t = s->temperature[i];
    gsl_matrix_set(rows, i, RATE, 1.0);
    gsl_matrix_set(rows, i, ENERGY, 1.0 - t0 / t);
    gsl_matrix_set(rows, i, POWER, log(t / t0));
    gsl_matrix_set(rows, i, FIRST, (t - t0) / e);
    gsl_matrix_set(rows, i, SECOND, (t - t0) / e * ((t + t0) / e));
    gsl_vector_set(wanted, i, s->log_rate[i]);
    gsl_vector_set(weight, i, s->weight[i]);
  }
  for (size_t k = 0; k < PRIORS; k++) {
    gsl_matrix_set(rows, s->count + k, POWER + k, 1.0);
    gsl_vector_set(weight, s->count + k, 1.0 / (prior[k] * prior[k]));
  }
}

static pendres_switching_verdict verdict_on(const pendres_switching_activation *f)
{
  const double freedom = (double)f->points - 2.0;
  if (isnan(f->energy)) return PENDRES_SWITCHING_TOO_FEW;
  if (!(f->least_barrier >= switching_least_barrier)) return PENDRES_SWITCHING_NO_BARRIER;
  if (f->points < 3) return PENDRES_SWITCHING_UNCHECKED;
  /* The mean and the standard deviation of chi squared. */
  return f->chi2 > freedom + surely * sqrt(2.0 * freedom) ? PENDRES_SWITCHING_BENT
                                                       : PENDRES_SWITCHING_STRAIGHT;
}

static void report(const sample *s, const gsl_vector *c, const gsl_matrix *v,
                   pendres_switching_activation *out)
{
  const double freedom = (double)s->count - 2.0;
  const double enlarge = freedom > 0.0 ? sqrt(fmax(1.0, out->chi2 / freedom)) : 1.0;
  double hottest = 0.0;
  for (size_t i = 0; i < s->count; i++) hottest = fmax(hottest, s->temperature[i]);
  out->temperature = s->middle;
  out->energy = s->middle * gsl_vector_get(c, ENERGY);
  out->energy_error = enlarge * s->middle * sqrt(gsl_matrix_get(v, ENERGY, ENERGY));
  /* ln rate at T0 is ln prefactor - energy / T0. */
  out->log_prefactor = gsl_vector_get(c, RATE) + gsl_vector_get(c, ENERGY);
  out->log_prefactor_error =
    enlarge * sqrt(gsl_matrix_get(v, RATE, RATE) + gsl_matrix_get(v, ENERGY, ENERGY) +
                   2.0 * gsl_matrix_get(v, RATE, ENERGY));
  out->exponent = gsl_vector_get(c, POWER);
  out->exponent_error = enlarge * sqrt(gsl_matrix_get(v, POWER, POWER));
  out->least_barrier = out->energy / hottest;
}

static pendres_status fit(const sample *s, pendres_switching_activation *out)
{
  const size_t n = s->count + PRIORS;
  gsl_matrix *rows = gsl_matrix_alloc(n, UNKNOWNS), *v = gsl_matrix_alloc(UNKNOWNS, UNKNOWNS);
  gsl_vector *wanted = gsl_vector_alloc(n), *weight = gsl_vector_alloc(n);
  gsl_vector *c = gsl_vector_alloc(UNKNOWNS);
  gsl_multifit_linear_workspace *w = gsl_multifit_linear_alloc(n, UNKNOWNS);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (rows == NULL || v == NULL || wanted == NULL || weight == NULL || c == NULL || w == NULL)
    goto done;
  fill_rows(s, rows, wanted, weight);
  status = PENDRES_INTERNAL;
  if (gsl_multifit_wlinear(rows, weight, wanted, c, v, &out->chi2, w) != 0) goto done;
  report(s, c, v, out);
  status = PENDRES_OK;
done:
  gsl_matrix_free(rows);
  gsl_matrix_free(v);
  gsl_vector_free(wanted);
  gsl_vector_free(weight);
  gsl_vector_free(c);
  gsl_multifit_linear_free(w);
  return status;
}

pendres_status pendres_switching_fit(size_t n, const double *temperature,
                                     const pendres_switching_rate *rates, double fewest,
                                     pendres_switching_activation *out)
{
  sample s;
  if (out == NULL || (n > 0 && (temperature == NULL || rates == NULL)))
    return PENDRES_INVALID_ARGUMENT;
  *out = (pendres_switching_activation){
    .energy = NAN, .energy_error = NAN, .log_prefactor = NAN, .log_prefactor_error = NAN,
    .chi2 = NAN, .temperature = NAN, .exponent = NAN, .exponent_error = NAN, .least_barrier = NAN};
  double *memory = malloc((4 * n + 1) * sizeof *memory);
  if (memory == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_status status =
    select_points(n, temperature, rates, fewest > 0.0 ? fewest : pendres_noise_fewest, memory, &s);
  out->points = s.count;
  if (status == PENDRES_OK) status = fit_line(&s, memory + 3 * n);
  if (status == PENDRES_OK) status = fit(&s, out);
  out->verdict = verdict_on(out);
  free(memory);
  return status;
}
