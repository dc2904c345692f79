/*
 * test_fit_decay.c -- fits to free decays that another integration made: values within their errors
 * over random sets, and exact data of a linear oscillator, whose motion is known in closed form.
 *
 * Tolerances: a value is within four and a half standard errors (one normal number in 150,000 is
 * not); over all values the mean distance is within 0.2 standard errors of 0, and the width within
 * 0.15 of 1, as 200 normal numbers are but for one time in 300. Seeds are fixed.
 */
#include "fit_fixture.h"
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

#ifndef SETS
#define SETS 40
#endif
enum { MOST_DATA = 2000, OPEN = 5 };

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  return ctx;
}

static double between(uint64_t *seed, double low, double high)
{
  return low * pow(high / low, lab_uniform(seed));
}

typedef struct set {
  lab of;
  size_t n;
  double hertz, volts, y, v;
  pendres_fit_datum data[MOST_DATA];
} set;

/* A decay at random: pendulums with a laboratory's scales, or hard and soft springs; Q from 5 to
   5000, noise of 0.1 to 10 % of the start, 12 to 30 data a cycle, over 8 cycles at least and for
   the time of the decay, if there are data enough. */
static void make(uint64_t seed, set *s)
{
  static double time[MOST_DATA], y[MOST_DATA];
  const double q = between(&seed, 5.0, 5000.0), noise = between(&seed, 1e-3, 0.1);
  const int sine = lab_uniform(&seed) < 0.4;
  *s = (set){.of = {.sine = sine, .a1 = 1.0, .damping = 1.0 / q}, .hertz = 1.0 / (2.0 * lab_pi),
             .volts = 1.0};
  const double size = sine ? between(&seed, 0.6, 2.2) : between(&seed, 0.5, 1.2);
  if (sine) {
    s->hertz = between(&seed, 0.5, 1e6);
    s->volts = between(&seed, 1e-3, 10.0);
  } else {
    s->of.a3 = lab_uniform(&seed) < 0.5 ? between(&seed, 0.1, 1.0) : -between(&seed, 0.05, 0.4);
  }
  const double phase = 2.0 * lab_pi * lab_uniform(&seed), each = between(&seed, 12.0, 30.0);
  const double cycles = fmax(8.0, fmin(q, MOST_DATA / each));
  s->y = size * cos(phase);
  s->v = size * sin(phase) * (sine ? 0.8 : 1.0);
  s->n = (size_t)fmin(MOST_DATA, each * cycles);
  for (size_t i = 0; i < s->n; i++)
    time[i] = i == 0 ? 0.0 : ((double)i + 0.8 * lab_uniform(&seed)) * 2.0 * lab_pi / each;
  lab_decay(s->of, s->y, s->v, s->n, time, y);
  for (size_t i = 0; i < s->n; i++)
    s->data[i] = (pendres_fit_datum){
      .observable = PENDRES_FIT_DISPLACEMENT, .direction = 1,
      .axis = time[i] / (2.0 * lab_pi * s->hertz), .error = s->volts * size * noise,
      .observed = s->volts * (y[i] + size * noise * lab_normal(&seed))};
}

static void random_sets(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  static set s;
  double sum = 0.0, squares = 0.0;
  size_t count = 0, said = 0;
  /* The first cycles of these two tell no damping, the later ones do. */
  static const uint64_t slow[] = {1174, 1190};
  for (uint64_t k = 0; k < SETS + 2; k++) {
    make(k < SETS ? 1000 + k : slow[k - SETS], &s);
    pendres_fit *fit = NULL;
    pendres_fit_unknown open[OPEN] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                      {.quantity = PENDRES_A1, .guess = NAN},
                                      {.quantity = PENDRES_A3, .guess = NAN},
                                      {.quantity = PENDRES_FIT_START_DISPLACEMENT, .guess = NAN},
                                      {.quantity = PENDRES_FIT_START_VELOCITY, .guess = NAN}};
    const double truth[OPEN] = {s.of.damping, s.of.sine ? s.hertz : 1.0,
                                s.of.sine ? s.volts : s.of.a3, s.y, s.v};
    pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = OPEN,
                               .unknown = open};
    if (s.of.sine) {
      model.pendulum.force = PENDRES_FORCE_PENDULUM;
      open[1].quantity = PENDRES_FIT_FREQUENCY_SCALE;
      open[2].quantity = PENDRES_FIT_AMPLITUDE_SCALE;
    }
    const pendres_fit_data all = {.n = s.n, .datum = s.data, .axis = PENDRES_PARAMETER_COUNT,
                                  .other = PENDRES_PARAMETER_COUNT};
    const pendres_status status = pendres_fit_find(ctx, &all, &model, NULL, &fit);
    const pendres_fit_summary got = pendres_fit_summary_get(fit);
    const int good = status == PENDRES_OK && got.converged && got.probability > 1e-5;
    assert_true(good || k < SETS);
    if (!good) {
      said++;
      print_message("set %d: status %d, chi-square %g of %g, Q %g, a3 %g, sine %d, n %zu\n", (int)k,
                    status, got.chi_square, got.degrees_of_freedom, 1.0 / s.of.damping, s.of.a3,
                    s.of.sine, s.n);
    }
    for (size_t i = 0; i < OPEN && good; i++) {
      const double pull =
        (pendres_fit_value(fit, i) - truth[i]) / sqrt(pendres_fit_covariance(fit, i, i));
      if (!(fabs(pull) < 4.5))
        fail_msg("set %d: unknown %zu is %.10g, not %.10g: %g errors", (int)k, i,
                 pendres_fit_value(fit, i), truth[i], pull);
      sum += pull;
      squares += pull * pull;
      count++;
    }
    pendres_fit_free(fit);
  }
  const double mean = sum / (double)count, width = sqrt(squares / (double)count - mean * mean);
  print_message("%zu values: mean %.3f, width %.3f; %zu of %d not converged\n", count, mean, width,
                said, SETS);
  check_near(mean, 0.0, 0.2);
  check_near(width, 1.0, 0.15);
  assert_true(said <= SETS / 30);
  pendres_context_free(ctx);
}

/* ---- a linear oscillator, whose motion is known ---- */

enum { LINEAR = 200, KNOWN = 4 };

/* Damping, a1 and the state at first. */
static double linear(const double p[KNOWN], double t)
{
  const double w = sqrt(p[1] - 0.25 * p[0] * p[0]);
  return exp(-0.5 * p[0] * t) *
         (p[2] * cos(w * t) + (p[3] + 0.5 * p[0] * p[2]) / w * sin(w * t));
}

/* The inverse of a matrix by Gauss and Jordan. */
static void invert(double a[KNOWN][KNOWN], double out[KNOWN][KNOWN])
{
  memset(out, 0, KNOWN * sizeof *out);
  for (int i = 0; i < KNOWN; i++) out[i][i] = 1.0;
  for (int i = 0; i < KNOWN; i++) {
    const double pivot = a[i][i];
    for (int c = 0; c < KNOWN; c++) {
      a[i][c] /= pivot;
      out[i][c] /= pivot;
    }
    for (int r = 0; r < KNOWN; r++) {
      const double f = r != i ? a[r][i] : 0.0;
      for (int c = 0; c < KNOWN; c++) {
        a[r][c] -= f * a[i][c];
        out[r][c] -= f * out[i][c];
      }
    }
  }
}

/* The covariance that the formula's derivatives make, here by differences of 1e-4, good to 1e-6 or
   so; the library's come from the equations of sensitivity. */
static void formula_covariance(const double truth[KNOWN], const pendres_fit_datum *data,
                               double out[KNOWN][KNOWN])
{
  double normal[KNOWN][KNOWN] = {{0.0}};
  for (int i = 0; i < LINEAR; i++) {
    double slope[KNOWN];
    for (int k = 0; k < KNOWN; k++) {
      double up[KNOWN], down[KNOWN];
      const double step = 1e-4 * fabs(truth[k]);
      memcpy(up, truth, sizeof up);
      memcpy(down, truth, sizeof down);
      up[k] += step;
      down[k] -= step;
      slope[k] = (linear(up, data[i].axis) - linear(down, data[i].axis)) / (2.0 * step);
    }
    for (int a = 0; a < KNOWN; a++)
      for (int b = 0; b < KNOWN; b++)
        normal[a][b] += slope[a] * slope[b] / (data[i].error * data[i].error);
  }
  invert(normal, out);
}

static void linear_decay(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  /* In seconds: units of any size. */
  const double truth[KNOWN] = {3.0, 4.1e4, 2e-3, 0.1};
  double covariance[KNOWN][KNOWN];
  pendres_fit_datum data[LINEAR];
  pendres_fit *fit = NULL;
  for (int i = 0; i < LINEAR; i++) {
    const double t = 5e-3 * i + 1e-3 * (i * i % 7);
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_DISPLACEMENT, .direction = 1, .axis = t,
                                  .observed = linear(truth, t), .error = 2e-5};
  }
  pendres_fit_unknown open[KNOWN] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                     {.quantity = PENDRES_A1, .guess = NAN},
                                     {.quantity = PENDRES_FIT_START_DISPLACEMENT, .guess = NAN},
                                     {.quantity = PENDRES_FIT_START_VELOCITY, .guess = NAN}};
  const pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = KNOWN,
                                   .unknown = open};
  const pendres_fit_data all = {.n = LINEAR, .datum = data, .axis = PENDRES_PARAMETER_COUNT,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  formula_covariance(truth, data, covariance);
  /* Exact data: the model's own error, which is 1e-7 of the start at most, is 1e-5 of an error.
     Derivatives between steps of 0.45 or less are off by their fourth power over 384, or 1e-4, and
     a covariance has two of them. */
  for (size_t a = 0; a < KNOWN; a++) {
    const double error = sqrt(covariance[a][a]);
    check_near(pendres_fit_value(fit, a), truth[a], 1e-3 * error);
    for (size_t b = 0; b < KNOWN; b++)
      check_near(pendres_fit_covariance(fit, a, b), covariance[a][b],
                 3e-4 * error * sqrt(covariance[b][b]));
  }
  check_near(pendres_fit_point_get(fit, 7)->modelled, data[7].observed, 1e-9);
  pendres_fit_free(fit);

  /* Without errors of the data those of the values follow from the scatter, of size 3e-5. */
  for (int i = 0; i < LINEAR; i++) {
    data[i].error = 0.0;
    data[i].observed += 3e-5 * (i * i % 5 < 2 ? 1.0 : -1.0);
  }
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  assert_true(isnan(pendres_fit_summary_get(fit).probability));
  check_near(pendres_fit_point_get(fit, 0)->error, 3e-5, 3e-6);
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

/* Soft springs that begin next to the barrier, at 1, where they hover before they swing faster and
   faster: without guesses, and beside the true values of all but the start. */
static void near_the_barrier(void **state)
{
  (void)state;
  enum { N = 300 };
  static const double dampings[] = {0.02, 0.1}, starts[] = {0.9, 0.97, 0.99, -0.99, 0.999};
  static double time[N], y[N];
  static pendres_fit_datum data[N];
  pendres_context *ctx = context();
  uint64_t seed = 31;
  for (size_t k = 0; k < 2 * 2 * 5; k++) {
    const int guessed = k % 2 == 1;
    const lab l = {.a1 = 1.0, .a3 = -1.0, .damping = dampings[k / 2 % 2]};
    const double truth[OPEN] = {l.damping, l.a1, l.a3, starts[k / 4], 0.0};
    pendres_fit *fit = NULL;
    pendres_fit_unknown open[OPEN] = {{.quantity = PENDRES_DAMPING},
                                      {.quantity = PENDRES_A1},
                                      {.quantity = PENDRES_A3},
                                      {.quantity = PENDRES_FIT_START_DISPLACEMENT},
                                      {.quantity = PENDRES_FIT_START_VELOCITY}};
    for (int i = 0; i < OPEN; i++) open[i].guess = guessed && i < 3 ? truth[i] : NAN;
    for (int i = 0; i < N; i++) time[i] = 3.0 / l.damping * i / (N - 1);
    lab_decay(l, starts[k / 4], 0.0, N, time, y);
    for (int i = 0; i < N; i++)
      data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_DISPLACEMENT, .direction = 1,
                                    .axis = time[i], .error = 0.01,
                                    .observed = y[i] + 0.01 * lab_normal(&seed)};
    const pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = OPEN,
                                     .unknown = open};
    const pendres_fit_data all = {.n = N, .datum = data, .axis = PENDRES_PARAMETER_COUNT,
                                  .other = PENDRES_PARAMETER_COUNT};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    assert_true(pendres_fit_summary_get(fit).probability > 1e-5);
    for (size_t i = 0; i < OPEN; i++)
      check_near(pendres_fit_value(fit, i), truth[i],
                 4.5 * sqrt(pendres_fit_covariance(fit, i, i)));
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_sets),
                                     cmocka_unit_test(linear_decay),
                                     cmocka_unit_test(near_the_barrier)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
