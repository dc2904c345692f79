/*
 * test_units_scales.c -- the same oscillator in units that are no powers of two:
 * x'' + 0.1 x' + x + x^3/s^2 = 0.3 s cos(omega t) for lengths s and times a hundred, and a
 * micromechanical resonator in SI. Results agree with those at s = 1 within the errors that both
 * state, twice their sum being allowed; the fold's value is that of the reference in extended
 * precision, which has no code in common.
 */
#include "units_fixture.h"

/* An oscillator whose numbers are these times the plain one's, at the default tolerance. */
static problem in_any_units(units u, const pendres_pendulum *p)
{
  problem q = {.p = in_units(*p, u), .u = u};
  check_ok(pendres_context_create(NULL, &q.ctx));
  return q;
}

/* |got / unit - want| within the errors. */
static void agree(double got, double error, double unit, double want, double want_error)
{
  check_near(got / unit, want, 2.0 * (fabs(error / unit) + want_error) + 1e-15 * fabs(want));
}

static const units scales[] = {{1.0, 1.0},  {1e-3, 1.0}, {1e3, 1.0}, {1e-6, 1.0},
                               {1e6, 1.0}, {1.0, 100.0}, {1e-6, 1e-6}};
enum { SCALES = sizeof scales / sizeof *scales };

static pendres_orbit orbit_of(const problem *q)
{
  const double x = 0.2 * q->u.length, v = 0.0;
  pendres_settled outcome;
  pendres_attractors *found = NULL;
  check_ok(pendres_settle(q->ctx, 1, &q->p, &x, &v, &outcome, &found));
  assert_true(outcome.attractor >= 0);
  const pendres_orbit o = pendres_attractors_get(found, (size_t)outcome.attractor)->orbit;
  pendres_attractors_free(found);
  return o;
}

/* The upper fold: 1.7797195243 at F0 = 0.3 (Duffing's row of docs/models.md). */
static void folds(void **state)
{
  pendres_fold first;
  (void)state;
  for (int k = 0; k < SCALES; k++) {
    const problem q = in_any_units(scales[k], &duffing);
    const pendres_orbit o = orbit_of(&q);
    pendres_fold fold;
    check_ok(pendres_fold_find(q.ctx, &o, PENDRES_DRIVE_FREQUENCY, &fold));
    if (k == 0) first = fold;
    agree(fold.value, fold.value_error, factor(q.u, 0, -1), first.value, first.value_error);
    agree(fold.orbit.amplitude, fold.orbit.amplitude_error, q.u.length, first.orbit.amplitude,
          first.orbit.amplitude_error);
    /* The upper fold or the lower one, by what the start settles on: both are known. */
    const double known = first.value > 1.5 ? 1.779719524269 : 1.324236200771;
    check_near(first.value, known, 2e-9);
    pendres_context_free(q.ctx);
  }
}

static void jumps(void **state)
{
  static const double path[] = {1.2, 1.4, 1.6, 1.8, 2.0, 1.8, 1.6, 1.4, 1.2};
  enum { N = sizeof path / sizeof *path };
  static const double known[2] = {1.779719524269, 1.324236200771};
  (void)state;
  for (int k = 0; k < SCALES; k++) {
    const problem q = in_any_units(scales[k], &duffing);
    const double rate = factor(q.u, 0, -1);
    const pendres_state start = {0.2 * q.u.length, 0.0};
    double value[N];
    pendres_hysteresis *h = NULL;
    for (int i = 0; i < N; i++) value[i] = path[i] * rate;
    const pendres_hysteresis_path along = {PENDRES_DRIVE_FREQUENCY, N, value};
    check_ok(pendres_hysteresis_find(q.ctx, &q.p, &start, &along, &h));
    assert_int_equal(pendres_hysteresis_jump_count(h), 2);
    for (size_t i = 0; i < 2; i++) {
      const pendres_jump *j = pendres_hysteresis_jump_get(h, i);
      assert_int_equal(j->kind, PENDRES_JUMP_FOLD);
      assert_true(j->certain);
      /* Known to the digits printed here. */
      agree(j->value, j->value_error, rate, known[i], 1e-9);
    }
    pendres_hysteresis_free(h);
    pendres_context_free(q.ctx);
  }
}

static void boundaries(void **state)
{
  size_t first = 0;
  (void)state;
  for (int k = 0; k < SCALES; k++) {
    const problem q = in_any_units(scales[k], &duffing);
    const pendres_orbit o = orbit_of(&q);
    pendres_orbit saddle;
    pendres_boundary *b = NULL;
    check_ok(pendres_saddle_find(q.ctx, &o, &saddle));
    check_ok(pendres_boundary_find(q.ctx, &saddle, NULL, &b));
    /* The window is in canonical units, which differ by up to two: more or less of the curve. */
    if (k == 0) first = b->count;
    assert_in_range(b->count, first / 8, 8 * first);
    assert_true(b->bound < 1e-3 * q.u.length);
    pendres_boundary_free(b);
    pendres_context_free(q.ctx);
  }
}

/* Chaos in two wells: two exponents of one motion agree within three standard errors of each. */
static void chaos(void **state)
{
  const pendres_pendulum wells = {.damping = 0.25, .drive_amplitude = 0.4, .drive_frequency = 1.0,
                                  .force = PENDRES_FORCE_POLYNOMIAL,
                                  .force_coefficients = {-1.0, 0.0, 1.0}};
  pendres_settled first = {.exponent = 0.0};
  (void)state;
  for (int k = 0; k < SCALES; k++) {
    const problem q = in_any_units(scales[k], &wells);
    const double x = 0.1 * q.u.length, v = 0.0, rate = factor(q.u, 0, -1);
    pendres_settled out;
    check_ok(pendres_lyapunov_find(q.ctx, 1, &q.p, &x, &v, NULL, &out));
    if (k == 0) first = out;
    assert_int_equal(out.label, PENDRES_LABEL_CHAOTIC);
    check_near(out.exponent / rate, first.exponent,
               3.0 * (out.exponent_error / rate + first.exponent_error));
    pendres_context_free(q.ctx);
  }
}

/* 1e-12 kg, 50 N/m, 1e14 N/m^3 and Q = 5000 under 0.69 nN, against the same without dimensions. */
static void micromechanical(void **state)
{
  const double mass = 1e-12, k1 = 50.0, k3 = 1e14, quality = 5000.0, drive = 6.948e-10;
  const double omega0 = sqrt(k1 / mass), length = sqrt(k1 / k3);
  const units si = {length, 1.0 / omega0};
  const pendres_pendulum plain_one = {
    .damping = 1.0 / quality, .drive_amplitude = drive / (k1 * length), .drive_frequency = 1.0,
    .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}};
  const units one = {1.0, 1.0};
  static const double path[] = {0.999, 1.001, 1.003, 1.005, 1.003, 1.001, 0.999};
  enum { N = sizeof path / sizeof *path };
  double value[2][2], error[2][2];
  (void)state;
  for (int s = 0; s < 2; s++) {
    problem q = in_any_units(s == 0 ? one : si, &plain_one);
    const double rate = factor(q.u, 0, -1);
    const pendres_state start = {0.0, 0.0};
    double along_value[N];
    pendres_hysteresis *h = NULL;
    if (s == 1) {
      q.p.force_coefficients[0] = k1 / mass;
      q.p.force_coefficients[2] = k3 / mass;
      q.p.drive_amplitude = drive / mass;
    }
    for (int i = 0; i < N; i++) along_value[i] = path[i] * rate;
    const pendres_hysteresis_path along = {PENDRES_DRIVE_FREQUENCY, N, along_value};
    check_ok(pendres_hysteresis_find(q.ctx, &q.p, &start, &along, &h));
    assert_int_equal(pendres_hysteresis_jump_count(h), 2);
    for (size_t i = 0; i < 2; i++) {
      assert_int_equal(pendres_hysteresis_jump_get(h, i)->kind, PENDRES_JUMP_FOLD);
      value[s][i] = pendres_hysteresis_jump_get(h, i)->value / rate;
      error[s][i] = pendres_hysteresis_jump_get(h, i)->value_error / rate;
    }
    pendres_hysteresis_free(h);
    pendres_context_free(q.ctx);
  }
  for (int i = 0; i < 2; i++) {
    /* The parameters in SI are rounded otherwise: some units in the last place of omega. */
    check_near(value[1][i], value[0][i], 2.0 * (error[0][i] + error[1][i]) + 1e-14);
    assert_true(error[1][i] < 1e-9);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(folds), cmocka_unit_test(jumps),
                                     cmocka_unit_test(boundaries), cmocka_unit_test(chaos),
                                     cmocka_unit_test(micromechanical)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
