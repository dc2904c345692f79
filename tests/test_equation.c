/*
 * test_equation.c -- what is concluded from friction against what the acceleration says of it; see
 * model/equation.h. Another friction that is not entered everywhere fails here.
 *
 * `ulp` is the distance of doubles around one; tolerances count roundings in it.
 */
#include <float.h>

#include <pendres/context.h>
#include <pendres/orbit.h>
#include <pendres/pendulum.h>

#include "check.h"

#include "model/equation.h"
#include "model/model.h"
#include "orbits/orbit_measure.h"

static const double ulp = DBL_EPSILON, two_pi = 6.283185307179586;

static const pendres_pendulum some[] = {
  {.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78},
  {.damping = 1.5, .drive_amplitude = 0.4, .drive_frequency = 3.0, .torque = 0.3},
  {.damping = 0.02, .drive_amplitude = 0.1, .drive_frequency = 1.9, .parametric_amplitude = 0.3},
  {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.2,
   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.1, 0.5}},
  {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 1.1, .nonlinear_damping = 0.2,
   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 0.5}},
  {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 0.9, .quadratic_damping = 0.15,
   .cubic_damping = 0.03},
};
enum { SOME = sizeof some / sizeof *some };
static const double speeds[] = {-3.0, -0.4, 0.0, 0.1, 7.0};
enum { SPEEDS = sizeof speeds / sizeof *speeds };

/* A push and a friction of sizes up to ten are rounded a few times each. */
static void test_friction(void **state)
{
  (void)state;
  for (int i = 0; i < SOME; i++)
    for (int j = 0; j < SPEEDS; j++) {
      const pendres_pendulum *p = &some[i];
      const double v = speeds[j], omega = p->drive_frequency, x = 0.7, t = 0.3;
      const double acceleration = pendres_pendulum_acceleration(p, x, v, t);
      const double friction = pendres_pendulum_acceleration(p, x, 0.0, t) - acceleration;
      const double y = x - pendres_model_origin(p);
      check_near(pendres_equation_friction(p, y, v) * v, friction, 100.0 * ulp);
      check_near(pendres_model_slope(p, x - pendres_model_origin(p), v / omega, cos(omega * t)) *
                   omega * omega, acceleration, 100.0 * ulp);
      double by_v;
      pendres_model_jacobian(p, x, v, NULL, &by_v);
      check_near(pendres_equation_drag(p, y, v), -by_v, 0.0);
      assert_true(pendres_equation_drag(p, y, v) >= pendres_equation_least_drag(p));
      assert_true(pendres_equation_most_drag(p, 2.0, 8.0) >= pendres_equation_drag(p, y, v));
      /* Central differences of step 1e-5, right to 1e-10 of the third derivatives. */
      const double h = 1e-5;
      check_near((pendres_equation_friction(p, y, v + h) * (v + h) -
                  pendres_equation_friction(p, y, v - h) * (v - h)) / (2.0 * h), -by_v,
                 1e-8 + h * p->quadratic_damping); /* at v = 0 the second derivative jumps */
      check_near((pendres_equation_friction(p, y + h, v) - pendres_equation_friction(p, y - h, v)) *
                   v / (2.0 * h), pendres_equation_drag_by_place(p, y, v), 1e-9);
      const double rate = pendres_equation_contraction(p);
      assert_true(isnan(rate) || rate == -by_v);
    }
}

/* The speed is that at which friction is the push, and backwards in time friction pushes. */
static void test_balance(void **state)
{
  (void)state;
  for (int i = 0; i < SOME; i++) {
    const pendres_pendulum *p = &some[i], back = pendres_equation_reversed(p);
    const double v = pendres_equation_speed(p, -0.3);
    if (pendres_equation_drags(p))
      assert_true(pendres_equation_friction(p, 0.0, v) * v >= 0.3);
    else
      check_near(pendres_equation_friction(p, 0.0, v) * v, 0.3, 4.0 * ulp);
    check_near(pendres_equation_speed(&back, 0.3), v, 0.0);
    check_near(pendres_pendulum_acceleration(&back, 0.4, -1.3, -0.6),
               pendres_pendulum_acceleration(p, 0.4, 1.3, 0.6), 0.0);
  }
}

/* Two motions come together by exp(-fading) in a period, an area by its square, which is what is
   left of it; where the rate is not known, what was computed. */
static void test_contraction(void **state)
{
  (void)state;
  for (int i = 0; i < SOME; i++) {
    const pendres_pendulum *p = &some[i];
    const double period = two_pi / p->drive_frequency, fading = pendres_equation_fading(p);
    check_near(2.0 * fading, pendres_pendulum_decay_rate(p) * period, 4.0 * ulp * fading);
    check_near(pendres_model_settling(p) * fading, 1.0, 2.0 * ulp);
    assert_null(pendres_equation_undamped(p));
  }
  check_near(pendres_equation_left(0.5, 7.0), 0.60653065971263342, ulp); /* exp(-1/2) */
  check_near(pendres_equation_left(NAN, 7.0), 7.0, 0.0);
  const pendres_pendulum free = {.drive_frequency = 1.0};
  assert_non_null(pendres_equation_undamped(&free));
}

/* The determinant of an orbit's derivatives, computed, is what Liouville's formula says: within the
   errors of entries of size one that are known to some 1e-11. */
static void test_determinant(void **state)
{
  pendres_context *ctx = NULL;
  (void)state;
  assert_int_equal(pendres_context_create(&(pendres_options){.tolerance = 1e-11}, &ctx),
                   PENDRES_OK);
  for (int i = 0; i < SOME; i++) {
    const pendres_pendulum *p = &some[i];
    const pendres_orbit_guess guess = {.pendulum = *p, .x = pendres_model_origin(p), .period = 1};
    pendres_orbit o;
    pendres_status outcome;
    assert_int_equal(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &o, &outcome),
                     PENDRES_OK);
    assert_int_equal(outcome, PENDRES_OK);
    const double (*m)[2] = (const double (*)[2])o.monodromy;
    const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    const double period = two_pi / p->drive_frequency;
    check_near(exp(-pendres_orbit_contraction(&o) * period), determinant, 1e-9);
    /* Both multipliers' product. */
    check_near(o.multiplier_re[0] * o.multiplier_re[1] - o.multiplier_im[0] * o.multiplier_im[1],
               determinant, 1e-9);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_friction),
    cmocka_unit_test(test_balance),
    cmocka_unit_test(test_contraction),
    cmocka_unit_test(test_determinant),
  };
  return cmocka_run_group_tests_name("equation", tests, NULL, NULL);
}
