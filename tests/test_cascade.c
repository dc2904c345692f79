/*
 * test_cascade.c -- doublings of y'' + y'/2 + sin y = F cos(2t/3): against the multipliers of the
 * reference in extended precision, which has no code in common, and against Feigenbaum's ratio.
 */
#include <stdlib.h>

#include <pendres/attractor.h>
#include <pendres/cascade.h>
#include "oracle/reference.h"
#include <pendres/strobe.h>

#include "analysis/sweeps/stable_part.h"
#include "check.h"

static const double feigenbaum = 4.66920160910299067;

static pendres_orbit orbit_at(pendres_context *ctx, const pendres_pendulum *p)
{
  const double x = 1.6, v = 0.0;
  pendres_settled outcome;
  pendres_attractors *found = NULL;
  check_ok(pendres_settle(ctx, 1, p, &x, &v, &outcome, &found));
  assert_true(outcome.attractor >= 0);
  const pendres_orbit o = pendres_attractors_get(found, (size_t)outcome.attractor)->orbit;
  pendres_attractors_free(found);
  return o;
}

/* The multiplier furthest from 0 of the orbit near a point, by the reference. */
static double multiplier(pendres_pendulum p, double drive, double x, double v, int period)
{
  reference_cycle c;
  p.drive_amplitude = drive;
  check_ok(reference_orbit(&p, x - 0.5 * 3.14159265358979323846L, v, period, 0, &c));
  return (double)c.multiplier_re[0];
}

static void doublings(void **state)
{
  pendres_context *ctx = NULL;
  pendres_cascade c;
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.05, .drive_frequency = 2.0 / 3.0};
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &ctx));
  const pendres_orbit start = orbit_at(ctx, &p);
  check_ok(pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, 1.09, &c));
  assert_int_equal(c.doublings, PENDRES_CASCADE_DOUBLINGS);
  for (int i = 0; i < c.doublings; i++) {
    assert_int_equal(c.period[i], 1 << i);
    assert_true(c.value_error[i] < 1e-10 && (i == 0 || c.value[i] > c.value[i - 1]));
    if (i > 2) continue;
    /* At a doubling it is -1: so much may be missing as its slope makes of the error. */
    const double off = 1e-7, m = multiplier(p, c.value[i], c.x[i], c.v[i], c.period[i]);
    const double slope =
      (multiplier(p, c.value[i] - off, c.x[i], c.v[i], c.period[i]) - m) / off;
    check_near(m, -1.0, 1e-13 + fabs(slope) * c.value_error[i]);
  }
  check_near(c.ratio, feigenbaum, c.ratio_error);
  assert_true(c.ratio_error < 1e-3 && c.limit_error < 1e-8);
  assert_true(c.limit > c.value[c.doublings - 1]);
  /* A cascade that is cut short tells the same, less well. */
  pendres_cascade cut;
  check_ok(pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, 1.0827, &cut));
  assert_int_equal(cut.doublings, 4);
  check_near(cut.limit, c.limit, cut.limit_error + c.limit_error);
  check_near(cut.ratio, feigenbaum, cut.ratio_error);
  /* Where nothing doubles there is none. */
  assert_int_equal(pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, 0.9, &cut),
                   PENDRES_NOT_FOUND);
  assert_true(cut.doublings == 0 && isnan(cut.limit) && isnan(cut.ratio));
  pendres_context_free(ctx);
}

/* In a window of six periods, which double once: the next doubling leads to orbits of 24 periods
   that are born there, whichever of the twelve points it is told by. At some of them these stay
   within some 1e-6; at one the plane of a switch meets another branch, 2.8e-4 away. */
static void from_any_point(void **state)
{
  enum { PERIOD = 12 };
  const double limit = 1.0847;
  pendres_context *ctx = NULL;
  pendres_cascade c;
  pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 1.08459, .drive_frequency = 2.0 / 3.0};
  pendres_orbit start;
  pendres_status outcome;
  const pendres_orbit_guess guess = {.pendulum = p, .x = 1.50008, .v = 1.86151, .period = 6};
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &ctx));
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
  check_ok(pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, limit, &c));
  assert_true(c.doublings >= 3 && c.period[1] == PERIOD);
  p.drive_amplitude = c.value[1];
  double x = c.x[1], v = c.v[1];
  int switched = 0;
  for (int k = 0; k < PERIOD; k++) {
    const pendres_orbit_guess there = {.pendulum = p, .x = x, .v = v, .period = PERIOD};
    pendres_bifurcation at = {.kind = PENDRES_PERIOD_DOUBLING, .value = c.value[1],
                              .parameter = PENDRES_DRIVE_AMPLITUDE};
    pendres_orbit born;
    pendres_part part;
    check_ok(pendres_orbit_find(ctx, 1, &there, PENDRES_ORBIT_PLAIN, &at.orbit, &outcome));
    const pendres_status status = pendres_branch_switch(ctx, &at, &born);
    if (status == PENDRES_OK) {
      const double ahead = born.pendulum.drive_amplitude - c.value[1];
      assert_int_equal(born.period, 2 * PERIOD);
      assert_true(ahead > 0.0 && ahead < 2.0 * (c.value[2] - c.value[1]));
      switched++;
    } else {
      assert_int_equal(status, PENDRES_NOT_FOUND);
    }
    check_ok(pendres_part_born(ctx, &at, limit, &part));
    assert_int_equal(part.end, PENDRES_PART_BIFURCATION);
    check_near(part.end_value, c.value[2], part.end_error + c.value_error[2]);
    pendres_part_free(&part);
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL));
  }
  assert_true(switched > 0);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(doublings),
                                     cmocka_unit_test(from_any_point)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
