/*
 * test_force.c -- forces that have a header of their own, by the example of the list: a ring with a
 * Josephson junction.
 *
 * References: oracle.h (extrapolated midpoint rule in long double; its force is written out there
 * again), and linear response. Kernels are in test_kernels.c.
 */
#include <pendres/pendres.h>

#include "check.h"
#include "model/model.h"
#include "oracle.h"

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

static const pendres_pendulum ring = {.damping = 0.2, .drive_amplitude = 0.7,
                                      .drive_frequency = 0.9, .torque = 0.3,
                                      .parametric_amplitude = 0.2, .force = PENDRES_FORCE_SQUID,
                                      .force_coefficients = {0.15}};

/* All forces, those of the list too: V' = f - I and V'' by differences of step h, off by h^2 times
   a third derivative and rounding over h. */
static void forces_are_consistent(void **state)
{
  const double h = 1e-5;
  (void)state;
  for (int force = 0; force < PENDRES_FORCE_COUNT; force++) {
    const pendres_model *model = pendres_model_of((pendres_force)force);
    pendres_pendulum p = {.drive_frequency = 1.0, .torque = 0.2, .force = (pendres_force)force};
    assert_non_null(model->name);
    for (int k = 0; k < model->coefficients; k++) p.force_coefficients[k] = 0.3 - 0.1 * k;
    check_ok(pendres_pendulum_check(&p, NULL));
    for (double x = -2.0; x <= 2.0; x += 0.25) {
      const double above = pendres_pendulum_energy(&p, x + h, 0.0);
      const double below = pendres_pendulum_energy(&p, x - h, 0.0);
      double by_x, by_v;
      check_near(-(above - below) / (2.0 * h), pendres_pendulum_acceleration(&p, x, 0.0, 0.0),
                 1e-8);
      pendres_model_jacobian(&p, x, 0.0, &by_x, &by_v);
      check_near((pendres_pendulum_acceleration(&p, x + h, 0.0, 0.0) -
                  pendres_pendulum_acceleration(&p, x - h, 0.0, 0.0)) / (2.0 * h), by_x, 1e-8);
    }
    p.force_coefficients[PENDRES_FORCE_POWERS - 1] = NAN;
    assert_int_equal(pendres_pendulum_check(&p, NULL), PENDRES_INVALID_ARGUMENT);
  }
  pendres_pendulum p = ring;
  assert_false(pendres_pendulum_symmetric(&p));
  p.torque = p.parametric_amplitude = 0.0;
  assert_true(pendres_pendulum_symmetric(&p));
  p.force_coefficients[1] = 1.0; /* it has one coefficient */
  assert_int_equal(pendres_pendulum_check(&p, NULL), PENDRES_INVALID_ARGUMENT);
}

/* Starts far and near with all terms on, beside the oracle, which is good to 1e-15 times what they
   make of errors: within the errors that come back. */
static void trajectories(void **state)
{
  enum { N = 12, PERIODS = 10 };
  pendres_context *ctx = context(1e-10);
  pendres_pendulum p[N];
  double x[N], v[N], error[N];
  const oracle o = oracle_of(&ring);
  (void)state;
  for (int i = 0; i < N; i++) {
    p[i] = ring;
    x[i] = i - 6;
    v[i] = 0.25 * (i - 6);
  }
  check_ok(pendres_strobe_advance(ctx, N, p, x, v, PERIODS, error));
  for (int i = 0; i < N; i++) {
    long double s[ORACLE_SIZE] = {i - 6, 0.25L * (i - 6), 1.0L, 0.0L, 0.0L, 1.0L};
    oracle_advance(&o, PERIODS, s);
    assert_true(error[i] < 1e-8);
    check_near(x[i], (double)s[0], error[i]);
    check_near(v[i], (double)s[1], error[i]);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(forces_are_consistent),
    cmocka_unit_test(trajectories),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
