/*
 * test_resonance_turn.c -- the damping of the largest resonance frequency, beside another way to
 * find it, and where there is none.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

static const pendres_pendulum near = {.damping = 0.375, .drive_amplitude = 0.2};

static pendres_resonance at(pendres_context *ctx, double damping)
{
  pendres_resonance r;
  pendres_pendulum p = near;
  p.damping = damping;
  check_ok(pendres_resonance_find(ctx, &p, 0.5, 1.2, &r));
  return r;
}

/*
 * The slope of the frequency over damping from four resonances around the turn, and its bend from
 * these and a fifth, are of fourth order in their distance h: at tolerance 1e-10 the zero of the
 * slope was seen to be off by 6.7e-7, 4.2e-8 and 2e-9 with h = 0.01, 0.005 and 0.0025. The errors
 * of the resonances make some 18/12 of the largest over h and the bend. The frequency is flat
 * there: the fifth resonance is the largest one but for what the bend makes of the error of its
 * damping.
 */
static void beside_finite_differences(void **state)
{
  const double h = 0.005;
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_resonance_turn turn;
  double f[5], error = 0.0;
  check_ok(pendres_resonance_turn_find(*state, &near, 0.5, 1.2, &e, &turn));
  for (int k = 0; k < 5; k++) {
    const pendres_resonance r = at(*state, turn.damping + (k - 2) * h);
    f[k] = r.frequency;
    error = fmax(error, r.frequency_error);
  }
  const double slope = (f[0] - 8.0 * f[1] + 8.0 * f[3] - f[4]) / (12.0 * h);
  const double bend = (-f[0] + 16.0 * f[1] - 30.0 * f[2] + 16.0 * f[3] - f[4]) / (12.0 * h * h);
  const double other = 18.0 / 12.0 * error / h / fabs(bend) + 1e-7;
  const double off = fabs(slope / bend);
  assert_true(bend < 0.0);
  check_near(off, 0.0, turn.damping_error + other);
  check_near(turn.frequency, f[2], turn.frequency_error + error + fabs(bend) * off * off);
  /* Useful: a curve that is sampled every 0.01 is read off no better than to that. */
  assert_true(turn.damping_error < 1e-5 && turn.frequency_error < 1e-8);
}

/* Far from the turn the parabolas lead to it; at weak damping, where the peak is an edge, and in a
   linear pendulum, whose resonance falls as damping grows, there is none. */
static void from_elsewhere(void **state)
{
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_resonance_turn turn, other;
  pendres_pendulum p = near;
  check_ok(pendres_resonance_turn_find(*state, &near, 0.5, 1.2, &e, &turn));
  p.damping = 0.33;
  check_ok(pendres_resonance_turn_find(*state, &p, 0.5, 1.2, &e, &other));
  check_near(other.damping, turn.damping, other.damping_error + turn.damping_error);
  p.damping = 0.12;
  assert_int_equal(pendres_resonance_turn_find(*state, &p, 0.5, 1.2, &e, &other),
                   PENDRES_NOT_FOUND);
  assert_true(isnan(other.damping) && isnan(other.damping_error) && isnan(other.frequency) &&
              isnan(other.frequency_error));
  p = (pendres_pendulum){.damping = 0.3, .drive_amplitude = 1e-4};
  assert_int_equal(pendres_resonance_turn_find(*state, &p, 0.5, 1.2, &e, &other),
                   PENDRES_NOT_FOUND);
}

static int open_context(void **state)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){0}, &ctx));
  *state = ctx;
  return 0;
}

static int close_context(void **state)
{
  pendres_context_free(*state);
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(beside_finite_differences, open_context, close_context),
    cmocka_unit_test_setup_teardown(from_elsewhere, open_context, close_context),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
