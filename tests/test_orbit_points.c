/*
 * test_orbit_points.c -- orbits of which points and multipliers alone are asked for are those that
 * are measured, too, and amplitudes by states alone are theirs.
 */
#include "context_fixture.h"

#include <math.h>

#include "base/angles.h"
#include "orbits/orbit_pair.h"
#include "orbits/orbit_span.h"

#include <pendres/orbit.h>
#include <pendres/strobe.h>

enum { ORBITS = 4 };

/* Orbits of one and two drive periods, and the same over four and twelve, so many as are chained.
   */
static const struct {
  double drive_amplitude, x, v;
  int period;
} cases[ORBITS] = {
  {1.05, 1.6, 0.0, 1}, {1.07, 1.6, 0.0, 2}, {1.07, 1.6, 0.0, 4}, {1.05, 1.6, 0.0, 12}};

static void as_measured(void **state)
{
  pendres_context *ctx = *state;
  pendres_orbit_guess guess[ORBITS];
  pendres_orbit whole[ORBITS], point[ORBITS];
  pendres_status outcome[2][ORBITS];
  for (int i = 0; i < ORBITS; i++) {
    const pendres_pendulum p = {
      .damping = 0.5, .drive_amplitude = cases[i].drive_amplitude, .drive_frequency = 2.0 / 3.0};
    double x = cases[i].x, v = cases[i].v;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 400, NULL));
    guess[i] = (pendres_orbit_guess){.pendulum = p, .x = x, .v = v, .period = cases[i].period};
  }
  check_ok(pendres_orbit_find(ctx, ORBITS, guess, PENDRES_ORBIT_PLAIN, whole, outcome[0]));
  check_ok(pendres_orbit_find_points(ctx, ORBITS, guess, point, outcome[1]));
  for (int i = 0; i < ORBITS; i++) {
    const pendres_orbit *a = &whole[i], *b = &point[i];
    assert_int_equal(outcome[0][i], PENDRES_OK);
    assert_int_equal(outcome[1][i], PENDRES_OK);
    assert_int_equal(a->stable, b->stable);
    check_near(pendres_less_turns(a->x - b->x, two_pi), 0.0, a->x_error + b->x_error);
    check_near(a->v, b->v, a->v_error + b->v_error);
    assert_true(a->multiplier_error > 0.0 && b->multiplier_error > 0.0);
    const double error = a->multiplier_error + b->multiplier_error;
    for (int k = 0; k < 2; k++) {
      check_near(a->multiplier_re[k], b->multiplier_re[k], error);
      check_near(a->multiplier_im[k], b->multiplier_im[k], error);
    }
  }
}

/* Amplitudes by states alone, also of an orbit that turns over: seven times in six drive periods.
   They serve to tell orbits apart that differ by 0.02; turning points of a cubic between two of 40
   states a period or more are off by the fourth power of their distance, a few times 1e-4. */
static void rough_amplitudes(void **state)
{
  pendres_context *ctx = *state;
  pendres_orbit_guess guess[ORBITS];
  pendres_orbit whole[ORBITS], rough[ORBITS];
  pendres_status outcome[ORBITS];
  for (int i = 0; i < ORBITS; i++) {
    pendres_pendulum p = {.damping = 0.5, .drive_amplitude = cases[i].drive_amplitude,
                          .drive_frequency = 2.0 / 3.0};
    double x = cases[i].x, v = cases[i].v;
    int period = cases[i].period, winding = 0;
    if (i == ORBITS - 1) { /* a Shapiro step, 3/2 */
      p = (pendres_pendulum){.damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0,
                             .torque = 1.36};
      period = 2;
      winding = 3;
    }
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 400, NULL));
    guess[i] = (pendres_orbit_guess){
      .pendulum = p, .x = x, .v = v, .period = period, .winding = winding};
  }
  check_ok(pendres_orbit_find(ctx, ORBITS, guess, PENDRES_ORBIT_PLAIN, whole, outcome));
  for (int i = 0; i < ORBITS; i++) {
    assert_int_equal(outcome[i], PENDRES_OK);
    rough[i] = whole[i];
    rough[i].amplitude = NAN;
  }
  check_ok(pendres_orbits_span(ctx, ORBITS, rough));
  for (int i = 0; i < ORBITS; i++) check_near(rough[i].amplitude, whole[i].amplitude, 1e-3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(as_measured, setup, teardown),
    cmocka_unit_test_setup_teardown(rough_amplitudes, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
