/*
 * test_fit_jumps.c -- fits to places of jumps and of resonances, where another integration
 * (fit_fixture.h) found the ends of its states, and the values at which they lag by a quarter turn.
 *
 * Tolerances: a value is within four and a half standard errors (one normal number in 150,000 is
 * not), a chi-square has a probability above 1e-5. Seeds are fixed. Places without noise have
 * tolerances of their own, below.
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

/* ---- resonances ---- */

enum { RESONANCES = 5 };

/* Where the lag of the state at frequency w, and what the instrument adds, become a quarter turn,
   in steps that become shorter before that. */
static double quarter_of(lab l, double added, double w, double step)
{
  lab_motion m = {0};
  double map[2][2], before = 0.0;
  l.frequency = w;
  assert_true(lab_settle(&l, &m));
  while (fabs(step) > 1e-9) {
    lab_motion at = m;
    l.frequency = w + step;
    const int found = lab_newton(&l, 0.1 * hypot(m.y, m.v), &at);
    const lab_motion start = at;
    lab_period(&l, &at, map);
    const double here = at.cosine * cos(added) - at.sine * sin(added);
    if (found && here * before >= 0.0) {
      m = start;
      w += step;
      before = here;
    } else {
      step *= 0.5;
    }
  }
  return w;
}

/* The resonance at each drive, exactly, in units of the instrument. The lag that it adds moves it
   away from the tip, beyond which the state ends. */
static void measure_resonances(int soft, double damping, double added,
                               pendres_fit_datum data[RESONANCES])
{
  const double sign = soft ? -1.0 : 1.0;
  for (int d = 0; d < RESONANCES; d++) {
    const double square = (0.5 + 1.5 * d) * damping / 0.375; /* of the amplitude at the top */
    const double top = sqrt(1.0 + 0.75 * sign * square);
    const lab l = {.a1 = 1.0, .a3 = sign, .damping = damping,
                   .drive = sqrt(square) * damping * top};
    const double place = quarter_of(l, added, 1.0 - 4.0 * damping * sign, 0.3 * damping * sign);
    data[d] = (pendres_fit_datum){.observable = PENDRES_FIT_RESONANCE, .direction = 1,
                                  .other = l.drive / scale, .error = 1e-4 * hertz * damping,
                                  .observed = hertz * place};
  }
}

/* Exact places, and a guess with which the curves lead far beyond the data: both sides know places
   to 1e-8, which is 1e-6 of the bend that tells the drive. */
static void tables_of_resonances(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int soft = 0; soft < 2; soft++) {
    pendres_fit_datum data[RESONANCES];
    pendres_fit *fit = NULL;
    const double damping = soft ? 0.005 : 0.02;
    const double added = soft ? -0.2 : 0.2;
    measure_resonances(soft, damping, added, data);
    const pendres_fit_unknown open[] = {
      {.quantity = PENDRES_FIT_DRIVE_SCALE, .guess = 1.25 * scale},
      {.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = (1.0 + 0.1 * damping) * hertz},
      {.quantity = PENDRES_FIT_PHASE_OFFSET, .guess = added, .fixed = 1}};
    const pendres_fit_model model = {
      .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .damping = damping,
                   .force_coefficients = {1.0, 0.0, soft ? -1.0 : 1.0}},
      .unknowns = 3, .unknown = open};
    const pendres_fit_data all = {.n = RESONANCES, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                  .other = PENDRES_DRIVE_AMPLITUDE};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    assert_true(pendres_fit_summary_get(fit).chi_square < 1e-4);
    check_relative(pendres_fit_value(fit, 0), scale, 1e-6);
    check_relative(pendres_fit_value(fit, 1), hertz, 1e-8 * 3.0);
    pendres_fit_free(fit);
    /* Without errors the same values: all places are weighed alike. */
    for (int d = 0; d < RESONANCES; d++) data[d].error = 0.0;
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    check_relative(pendres_fit_value(fit, 0), scale, 1e-6);
    assert_true(sqrt(pendres_fit_covariance(fit, 0, 0)) < 1e-5 * scale);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* ---- derivatives ---- */

/* The variance of a single unknown is that by differences of the places with it, to 1e-3: steps of
   1e-3 are off by their square. The unknown scale that places do not read lets the other
   one be fixed. */
static void check_slopes(size_t n, const pendres_fit_datum *data, int quantity, double guess,
                         const double *with)
{
  const double step = 1e-3 * guess;
  pendres_context *ctx = NULL;
  double place[3][JUMPS], sum = 0.0, variance = 0.0, at = guess;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int k = 0; k < 3; k++) {
    pendres_fit *fit = NULL;
    const double beside = at + (k == 1 ? step : k == 2 ? -step : 0.0);
    const pendres_fit_unknown open[] = {
      {.quantity = quantity, .guess = beside, .fixed = k > 0},
      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = 1.0, .prior = 1.0, .prior_error = 0.1},
      {.quantity = PENDRES_FIT_DRIVE_SCALE, .guess = scale, .fixed = 1},
      {.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = hertz, .fixed = 1},
      {.quantity = PENDRES_FIT_PHASE_OFFSET, .guess = with[1], .fixed = 1}};
    const pendres_fit_model model = {
      .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .damping = with[0],
                   .force_coefficients = {1.0, 0.0, 1.0}},
      .unknowns = quantity == PENDRES_FIT_PHASE_OFFSET ? 4 : 5, .unknown = open};
    const pendres_fit_data all = {.n = n, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                  .other = PENDRES_DRIVE_AMPLITUDE};
    /* Beside the best values chi-square is none that chance gives, and the fit says so. */
    const pendres_status status = pendres_fit_find(ctx, &all, &model, NULL, &fit);
    assert_true(status == PENDRES_OK || (k > 0 && status == PENDRES_NOT_CONVERGED));
    for (size_t i = 0; i < n; i++) place[k][i] = pendres_fit_point_get(fit, i)->modelled;
    if (k == 0) variance = pendres_fit_covariance(fit, 0, 0);
    if (k == 0) at = pendres_fit_value(fit, 0);
    pendres_fit_free(fit);
  }
  for (size_t i = 0; i < n; i++)
    sum += pow((place[1][i] - place[2][i]) / (2.0 * step * data[i].error), 2.0);
  check_relative(variance, 1.0 / sum, 1e-3);
  pendres_context_free(ctx);
}

static void derivatives(void **state)
{
  (void)state;
  const double with[] = {0.02, 0.2}; /* damping and lag */
  pendres_fit_datum jumps[JUMPS], resonances[RESONANCES];
  measure(0, with[0], 0.01, jumps);
  measure_resonances(0, with[0], with[1], resonances);
  check_slopes(JUMPS, jumps, PENDRES_DAMPING, with[0], with);
  check_slopes(RESONANCES, resonances, PENDRES_DAMPING, with[0], with);
  check_slopes(RESONANCES, resonances, PENDRES_FIT_PHASE_OFFSET, with[1], with);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(tables_of_jumps),
                                     cmocka_unit_test(tables_of_resonances),
                                     cmocka_unit_test(derivatives)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
