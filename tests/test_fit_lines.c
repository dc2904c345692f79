/*
 * test_fit_lines.c -- quality factors of resonators on lines from scattering parameters, by data of
 * line_fixture.h: transmission, notch and reflection, behind cables, linear, and bent with the
 * jumps of both directions; begun from data alone.
 *
 * Without noise values are those that made the data, to 1e-4 of the errors that noise of 1e-3 would
 * make: what the fixture leaves out is less. With noise they are within four errors of these, which
 * one normal number in 16,000 is not. Seeds are fixed.
 */
#include "check.h"
#include "fit_fixture.h"
#include "line_fixture.h"

#include <pendres/pendres.h>

enum { POINTS = 61, MOST_OPEN = 8 };

typedef struct measured {
  lab_line line;
  size_t n, open;
  double truth[MOST_OPEN];
  int quantity[MOST_OPEN];
  pendres_fit_datum data[4 * POINTS];
} measured;

static void open_one(measured *m, int quantity, double truth)
{
  m->quantity[m->open] = quantity;
  m->truth[m->open++] = truth;
}

static void open_all(measured *m)
{
  const lab_line *l = &m->line;
  open_one(m, PENDRES_FIT_INTERNAL_Q, l->qi);
  open_one(m, PENDRES_FIT_FREQUENCY_SCALE, l->f0);
  open_one(m, PENDRES_FIT_DELAY, l->delay);
  open_one(m, PENDRES_FIT_BACKGROUND_AMPLITUDE, l->amplitude);
  open_one(m, PENDRES_FIT_BACKGROUND_PHASE, l->angle);
  open_one(m, l->kind == 0 ? PENDRES_FIT_BACKGROUND_IN_PHASE : PENDRES_FIT_COUPLING_Q,
           l->kind == 0 ? l->leak[0] : l->qc);
  open_one(m, l->kind == 0 ? PENDRES_FIT_BACKGROUND_QUADRATURE : PENDRES_FIT_COUPLING_PHASE,
           l->kind == 0 ? l->leak[1] : l->phase);
  if (l->cubic != 0.0) open_one(m, (int)PENDRES_A3, l->cubic);
}

/* Over twelve widths and what it is bent by, of which there are `bend`; both ways if it is. */
static void measure(measured *m, double bend, double noise, uint64_t seed)
{
  double f[POINTS], re[POINTS], im[POINTS];
  const double g = line_damping(&m->line), width = g * m->line.f0;
  const double middle = m->line.f0 + 0.4 * width + 0.5 * bend * width;
  const double span = (12.0 + fabs(bend)) * width, error = noise * m->line.amplitude;
  m->n = m->open = 0;
  m->line.cubic = bend * 8.0 / 3.0 * g * g * g / (m->line.drive * m->line.drive);
  m->line.middle = middle;
  for (int way = 1; way >= (bend != 0.0 ? -1 : 1); way -= 2) {
    for (int i = 0; i < POINTS; i++) f[i] = middle + way * span * (i / (POINTS - 1.0) - 0.5);
    line_sweep(&m->line, POINTS, f, re, im);
    for (int i = 0; i < 2 * POINTS; i++)
      m->data[m->n++] = (pendres_fit_datum){
        .observable = (pendres_fit_observable)(PENDRES_FIT_TRANSMISSION_REAL +
                                               2 * m->line.kind + i % 2),
        .direction = way, .axis = f[i / 2], .error = fmax(error, 1e-3 * m->line.amplitude),
        .observed = (i % 2 ? im : re)[i / 2] + (error > 0.0 ? error * lab_normal(&seed) : 0.0)};
  }
  open_all(m);
}

/* Fit from data alone; each value within so many errors. */
static void check_fit(const measured *m, double farthest)
{
  pendres_fit_unknown unknown[MOST_OPEN];
  pendres_fit *fit = NULL;
  pendres_context *ctx = NULL;
  const pendres_fit_data data = {.n = m->n, .datum = m->data, .axis = PENDRES_DRIVE_FREQUENCY,
                                 .other = PENDRES_PARAMETER_COUNT};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0},
                 .drive_amplitude = m->line.drive},
    .unknowns = m->open, .unknown = unknown};
  for (size_t i = 0; i < m->open; i++)
    unknown[i] = (pendres_fit_unknown){.quantity = m->quantity[i], .guess = NAN};
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_fit_find(ctx, &data, &model, NULL, &fit));
  for (size_t i = 0; i < m->open; i++) {
    const double error = sqrt(pendres_fit_covariance(fit, i, i));
    double off = pendres_fit_value(fit, i) - m->truth[i];
    if (m->quantity[i] == PENDRES_FIT_BACKGROUND_PHASE) off = remainder(off, 2.0 * lab_pi);
    if (!(fabs(off) <= farthest * error))
      fail_msg("kind %d, quantity %d: %.10g off, error %.3g", m->line.kind, m->quantity[i], off,
               error);
  }
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

static const lab_line lines[] = {
  {.kind = 0, .f0 = 4e6, .qi = 3e4, .qc = INFINITY, .delay = 1e-6, .amplitude = 0.02, .angle = 2.0,
   .leak = {0.2, -0.3}, .drive = 1.0},
  {.kind = 1, .f0 = 5e9, .qi = 1e5, .qc = 2e4, .phase = 0.4, .delay = 4e-8, .amplitude = 0.7,
   .angle = -1.0, .drive = 1e-4},
  {.kind = 2, .f0 = 7e9, .qi = 3e4, .qc = 8e3, .phase = -0.2, .delay = 8e-8, .amplitude = 2.0,
   .angle = 3.0, .drive = 1e-4}};

static void linear(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    measured m = {.line = lines[k]};
    measure(&m, 0.0, 0.0, 0);
    check_fit(&m, 1e-4);
    measure(&m, 0.0, 0.01, 17 + (uint64_t)k);
    check_fit(&m, 4.0);
  }
}

static void bent(void **state)
{
  (void)state;
  static const double bends[] = {1.4, -2.0};
  for (int k = 0; k < 2; k++) {
    measured m = {.line = lines[k + 1]};
    measure(&m, bends[k], 3e-3, 40 + (uint64_t)k);
    check_fit(&m, 4.0);
  }
}

/* Noise alone is no resonance, and a line has no other quantities. */
static void refused(void **state)
{
  (void)state;
  static const struct { int quantity; const char *words; } wrong[] = {
    {PENDRES_DAMPING, "follows from internal_q"},
    {PENDRES_FIT_AMPLITUDE_SCALE, "background_amplitude"},
    {PENDRES_FIT_BACKGROUND_IN_PHASE, "of transmission alone"}};
  measured m = {.line = lines[1]};
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  uint64_t seed = 5;
  measure(&m, 0.0, 0.01, 1);
  for (size_t i = 0; i < m.n; i++) m.data[i].observed = (i % 2 == 0) + 0.01 * lab_normal(&seed);
  pendres_fit_data data = {.n = m.n, .datum = m.data, .axis = PENDRES_DRIVE_FREQUENCY,
                           .other = PENDRES_PARAMETER_COUNT};
  pendres_fit_unknown unknown[2] = {{.quantity = PENDRES_FIT_INTERNAL_Q, .guess = NAN},
                                    {.quantity = PENDRES_FIT_COUPLING_Q, .guess = NAN}};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0},
                 .drive_amplitude = 1.0}, .unknowns = 2, .unknown = unknown};
  check_ok(pendres_context_create(NULL, &ctx));
  assert_int_equal(pendres_fit_find(ctx, &data, &model, NULL, &fit), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "no guess"));
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    unknown[0].quantity = wrong[k].quantity;
    assert_int_equal(pendres_fit_find(ctx, &data, &model, NULL, &fit), PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(pendres_context_message(ctx), wrong[k].words));
  }
  m.data[1].observable = PENDRES_FIT_AMPLITUDE;
  assert_int_equal(pendres_fit_find(ctx, &data, &model, NULL, &fit), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "fitted alone"));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(linear), cmocka_unit_test(bent),
                                     cmocka_unit_test(refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
