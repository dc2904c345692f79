/*
 * test_fit_jumps.c -- fits to places of jumps, where another integration (fit_fixture.h) found the
 * ends of its states.
 *
 * Tolerances: a value is within four and a half standard errors (one normal number in 150,000 is
 * not), a chi-square has a probability above 1e-5. Seeds are fixed.
 */
#include "fit_fixture.h"
#include "check.h"

#include <pendres/pendres.h>

enum { DRIVES = 3, JUMPS = 2 * DRIVES, OPEN = 3 };

static const double hertz = 1.2e6, scale = 0.02;

/* Where the state at frequency w ends, in steps that become shorter before its end. */
static double end_of(lab l, double w, double step)
{
  lab_motion m = {0};
  l.frequency = w;
  assert_true(lab_settle(&l, &m));
  while (fabs(step) > 1e-8) {
    lab_motion at = m;
    l.frequency = w + step;
    if (lab_newton(&l, 0.1 * hypot(m.y, m.v), &at)) {
      m = at;
      w += step;
    } else {
      step *= 0.5;
    }
  }
  return w;
}

/* Both jumps at each drive, with errors of these parts of a width. */
static void measure(int soft, double damping, double noise, pendres_fit_datum data[JUMPS])
{
  const double sign = soft ? -1.0 : 1.0;
  uint64_t seed = 5;
  for (int d = 0; d < DRIVES; d++) {
    const double square = (4.0 + 2.0 * d) * damping / 0.375; /* of the amplitude at the top */
    const double top = sqrt(1.0 + 0.75 * sign * square), bent = fabs(top - 1.0);
    const lab l = {.a1 = 1.0, .a3 = sign, .damping = damping,
                   .drive = sqrt(square) * damping * top};
    const double step = 0.05 * bent * sign, wide = 4.0 * damping * sign;
    const double place[2] = {end_of(l, 1.0 - wide, step),
                             end_of(l, 1.0 + 2.0 * sign * bent + wide, -step)};
    for (int k = 0; k < 2; k++)
      data[2 * d + k] = (pendres_fit_datum){
        .observable = PENDRES_FIT_JUMP, .direction = (k == 0) == (soft == 0) ? 1 : -1,
        .other = l.drive / scale, .error = hertz * noise * damping,
        .observed = hertz * (place[k] + noise * damping * lab_normal(&seed))};
  }
}

/* With guesses that are off by 5 to 10 %. */
static void tables_of_jumps(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int soft = 0; soft < 2; soft++) {
    pendres_fit_datum data[JUMPS];
    pendres_fit *fit = NULL;
    const double damping = soft ? 0.005 : 0.02;
    measure(soft, damping, 0.01, data);
    const double truth[OPEN] = {damping, scale, hertz};
    const pendres_fit_unknown open[OPEN] = {
      {.quantity = PENDRES_DAMPING, .guess = 1.1 * damping},
      {.quantity = PENDRES_FIT_DRIVE_SCALE, .guess = 0.95 * scale},
      {.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = (1.0 + 0.1 * damping) * hertz}};
    const pendres_fit_model model = {
      .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL,
                   .force_coefficients = {1.0, 0.0, soft ? -1.0 : 1.0}},
      .unknowns = OPEN, .unknown = open};
    const pendres_fit_data all = {.n = JUMPS, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                  .other = PENDRES_DRIVE_AMPLITUDE};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    const pendres_fit_summary s = pendres_fit_summary_get(fit);
    assert_true(s.converged && s.determined && s.probability > 1e-5);
    assert_true(s.degrees_of_freedom == JUMPS - OPEN);
    for (size_t i = 0; i < OPEN; i++) {
      const double error = sqrt(pendres_fit_covariance(fit, i, i));
      const double pull = (pendres_fit_value(fit, i) - truth[i]) / error;
      if (!(fabs(pull) < 4.5) || !(error < 0.05 * truth[i]))
        fail_msg("unknown %zu: %g +- %g, not %g", i, pendres_fit_value(fit, i), error, truth[i]);
    }
    double sum = 0.0;
    for (size_t i = 0; i < JUMPS; i++) {
      const pendres_fit_point *p = pendres_fit_point_get(fit, i);
      sum += p->residual * p->residual / (data[i].error * data[i].error);
      check_near(p->modelled + p->residual, data[i].observed, 1e-12 * hertz);
    }
    check_near(s.chi_square, sum, 1e-9 * sum);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* The variance of a single unknown is that by differences of the places with it, to 1e-3: steps of
   1e-3 are off by their square. The unknown scale that jumps do not read lets the damping be
   fixed. */
static void derivatives(void **state)
{
  (void)state;
  const double damping = 0.02, step = 1e-3;
  pendres_context *ctx = NULL;
  pendres_fit_datum data[JUMPS];
  double place[3][JUMPS], sum = 0.0, variance = 0.0, at = 0.0;
  check_ok(pendres_context_create(NULL, &ctx));
  measure(0, damping, 0.01, data);
  for (int k = 0; k < 3; k++) {
    pendres_fit *fit = NULL;
    const double beside = at * (1.0 + (k == 1 ? step : -step));
    const pendres_fit_unknown open[] = {
      {.quantity = PENDRES_DAMPING, .guess = k == 0 ? damping : beside, .fixed = k > 0},
      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = 1.0, .prior = 1.0, .prior_error = 0.1},
      {.quantity = PENDRES_FIT_DRIVE_SCALE, .guess = scale, .fixed = 1},
      {.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = hertz, .fixed = 1}};
    const pendres_fit_model model = {
      .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}},
      .unknowns = 4, .unknown = open};
    const pendres_fit_data all = {.n = JUMPS, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                  .other = PENDRES_DRIVE_AMPLITUDE};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    for (size_t i = 0; i < JUMPS; i++) place[k][i] = pendres_fit_point_get(fit, i)->modelled;
    if (k == 0) variance = pendres_fit_covariance(fit, 0, 0);
    if (k == 0) at = pendres_fit_value(fit, 0);
    pendres_fit_free(fit);
  }
  for (size_t i = 0; i < JUMPS; i++)
    sum += pow((place[1][i] - place[2][i]) / (2.0 * step * at * data[i].error), 2.0);
  check_relative(variance, 1.0 / sum, 1e-3);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(tables_of_jumps),
                                     cmocka_unit_test(derivatives)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
