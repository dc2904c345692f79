/*
 * test_strobe_far.c -- starts far away and fast, mirror images, refusals and stiff pendulums.
 */
#include "strobe_fixture.h"

/* ---- geometry ------------------------------------------------------------------------------ */

/*
 * A start a million turns away is taken as it stands: the velocity keeps its digits, the position
 * the digits that its size leaves (half a unit in the last place is 4.66e-10).
 */
static void test_far_starts(void **state)
{
  pendres_context *ctx = context(&(pendres_options){ .tolerance = 1e-12 });
  const pendres_pendulum p = { .damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.94 };
  (void)state;
  for (int sign = -1; sign <= 1; sign += 2) {
    const double x0 = sign * 6283185.8;
    double x = x0, v = 0.3;
    long double y = x0 - half_pi, w = v;
    long turns = 0;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, NULL));
    check_ok(reference_advance(&p, &y, &w, &turns, 3));
    check_near(v, (double)w, 1e-12);
    check_near(x, (double)(y + half_pi + two_pi * (long double)turns), 4.7e-10);
  }
  pendres_context_free(ctx);
}

/*
 * Far from the origin the angle is that of the position as it stands, in both ways to advance. The
 * angles are x - pi/2 less whole turns of 2 pi, by decimals of 60 digits. What is left: rounding
 * of a step's angle and velocity, some 1e-15 each; the last place of x is claimed.
 */
static void test_far_angles(void **state)
{
  static const struct { double x; long turns; long double y; } far[] = {
    { 1e9, 159154943, -0.993400903293511449821674560845L },
    { -1e12, -159154943092, -0.913171567658110151752065969963L },
    { 3e14, 47746482927568, 2.203705761915930398602336168031L },
  };
  const pendres_pendulum p = { .damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.94 };
  pendres_context *ctx = context(&(pendres_options){ .tolerance = 1e-13 });
  (void)state;
  for (size_t i = 0; i < COUNT(far); i++) {
    double x = far[i].x, v = 0.3, error, xs[7], vs[7], x_error[7], v_error[7];
    long double y = far[i].y, w = v;
    long turns = far[i].turns;
    check_ok(reference_advance(&p, &y, &w, &turns, 3));
    const long double turned = two_pi * (long double)(turns - far[i].turns);
    const double moved = (double)(y - far[i].y + turned);
    const double place = 0.5 * (nextafter(fabs(far[i].x), INFINITY) - fabs(far[i].x));
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, &error));
    check_near(v, (double)w, 2e-14);
    check_near(x - far[i].x, moved, place + 2e-14);
    assert_true(error >= place && error < 4.0 * place);
    check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){far[i].x, 0.3}, 3, 2,
                                   &(pendres_record){xs, vs, x_error, v_error}));
    check_near(vs[6], (double)w, 2e-14);
    check_near(xs[6] - far[i].x, moved, place + 2e-14);
    assert_true(x_error[6] >= place && x_error[6] < 4.0 * place);
    assert_true(v_error[6] < 1e-12);
  }
  pendres_context_free(ctx);
}

/* What double precision cannot say is refused by every way to advance, settle or refine. */
static void test_too_far(void **state)
{
  static const struct { double damping, drive, frequency, x, v; const char *word; } cases[] = {
    { 0.1, 0.2, 0.7, 5.8e19, 0.0, "1e15" },  { 0.1, 0.2, 0.7, 1e25, 0.0, "1e15" },
    { 0.1, 0.2, 0.7, -1e300, 0.0, "1e15" },  { 0.1, 0.2, 0.7, 1.0, 1e50, "fast" },
    { DBL_MAX, 0.2, 1.0, 1.0, 0.0, "damping" }, { 0.1, DBL_MAX, 1.0, 1.0, 0.0, "drive" },
    { 0.1, 0.2, DBL_MIN, 1.0, 0.0, "drive" }, { DBL_MAX, DBL_MAX, 2.0, 1.0, 1.0, "damping" },
  };
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++)
    for (int m = 0; m < PENDRES_METHOD_COUNT; m++) {
      const pendres_options o = { .method = (pendres_method)m, .steps_per_period = m ? 0 : 20 };
      const pendres_pendulum p = { cases[i].damping, cases[i].drive, cases[i].frequency, 0.0 };
      const pendres_orbit_guess guess = {
        .pendulum = p, .x = cases[i].x, .v = cases[i].v, .period = 1 };
      pendres_context *ctx = context(&o);
      double x = cases[i].x, v = cases[i].v, xs[3], vs[3];
      pendres_settled outcome;
      pendres_orbit orbit;
      pendres_status how;
      for (int call = 0; call < 4; call++) {
        const pendres_status status =
          call == 0   ? pendres_strobe_advance(ctx, 1, &p, &x, &v, 2, NULL)
          : call == 1 ? pendres_strobe_record(ctx, &p, &(pendres_state){x, v}, 2, 1,
                                              &(pendres_record){.x = xs, .v = vs})
          : call == 2 ? pendres_settle(ctx, 1, &p, &x, &v, &outcome, NULL)
                      : pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &how);
        assert_int_equal(status, PENDRES_INVALID_ARGUMENT);
        assert_non_null(strstr(pendres_context_message(ctx), cases[i].word));
        assert_true(x == cases[i].x && v == cases[i].v);
      }
      pendres_context_free(ctx);
    }
}

/* Steps so long that the state grows without bound end in a failure, not in numbers. */
static void test_no_numbers_are_a_failure(void **state)
{
  const pendres_pendulum p = { .damping = 1e6, .drive_amplitude = 0.2, .drive_frequency = 1.0 };
  pendres_context *ctx = context(&(pendres_options){ .steps_per_period = 8 });
  double x = 1.0, v = 1.0, xs[21], vs[21];
  (void)state;
  assert_int_equal(pendres_strobe_advance(ctx, 1, &p, &x, &v, 20, NULL),
                   PENDRES_INTEGRATION_FAILED);
  assert_non_null(strstr(pendres_context_message(ctx), "double precision"));
  assert_true(x == 1.0 && v == 1.0);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){x, v}, 20, 1,
                                         &(pendres_record){.x = xs, .v = vs}),
                   PENDRES_INTEGRATION_FAILED);
  pendres_context_free(ctx);
}

/* y -> -y with F0 -> -F0: every operation is odd, so only x = y + pi/2 is rounded differently. */
static void test_mirror(void **state)
{
  pendres_context *ctx = context(NULL);
  uint64_t seed = 521288629u;
  (void)state;
  for (int i = 0; i < 50; i++) {
    double x, v, mx, mv;
    pendres_pendulum p = any_pendulum(&seed, &x, &v), m = p;
    x = 0.5 * pi + 0x1p-20 * floor(0x1p20 * 0.12 * x); /* so that y is exact, either way */
    m.drive_amplitude = -p.drive_amplitude;
    mx = x, mv = v;
    mx = PENDRES_PI - mx, mv = -mv;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 2, NULL));
    check_ok(pendres_strobe_advance(ctx, 1, &m, &mx, &mv, 2, NULL));
    check_near(mv, -v, 0.0);
    mx = PENDRES_PI - mx, mv = -mv;
    check_near(mx, x, 4.5e-16 * fmax(4.0, fabs(x)));
  }
  pendres_context_free(ctx);
}

/* ---- refusals ------------------------------------------------------------------------------ */

static int always(void *arg)
{
  (void)arg;
  return 1;
}

static void test_refusals(void **state)
{
  pendres_context *ctx = context(NULL);
  const pendres_pendulum good = { .damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 1.0 };
  pendres_pendulum p[2] = { good, good };
  double x[2] = { 1.0, 2.0 }, v[2] = { 0.0, 0.5 };
  (void)state;
  assert_int_equal(pendres_strobe_advance(NULL, 2, p, x, v, 1, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_advance(ctx, 2, p, NULL, v, 1, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_advance(ctx, 2, p, x, v, -1, NULL), PENDRES_INVALID_ARGUMENT);
  check_ok(pendres_strobe_advance(ctx, 0, NULL, NULL, NULL, 5, NULL));
  p[1].damping = -1.0;
  assert_int_equal(pendres_strobe_advance(ctx, 2, p, x, v, 1, NULL), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "pendulum 1"));
  p[1] = good;
  v[1] = NAN;
  assert_int_equal(pendres_strobe_advance(ctx, 2, p, x, v, 1, NULL), PENDRES_INVALID_ARGUMENT);
  v[1] = 0.5;
  pendres_context_set_interrupt(ctx, always, NULL);
  assert_int_equal(pendres_strobe_advance(ctx, 2, p, x, v, 1, NULL), PENDRES_INTERRUPTED);
  check_near(x[0] + x[1] + v[0] + v[1], 3.5, 0.0);
  pendres_context_free(ctx);
}

/* What is said of too many steps names what asks for them. */
static void test_reasons_for_steps(void **state)
{
  static const struct { double damping, drive, frequency, v; const char *said; } cases[] = {
    { 0.1, 1e8, 1.0, 0.0, "the drive amplitude needs" },
    { 5e6, 0.2, 1.0, 0.0, "the damping needs" },
    { 0.1, 0.2, 1.0, 1e8, "the speed needs" },
    { 0.1, 0.2, 1e-8, 0.0, "the drive frequency at this tolerance needs" },
  };
  pendres_context *ctx = context(NULL);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_pendulum p = { cases[i].damping, cases[i].drive, cases[i].frequency, 0.0 };
    double x = 1.0, v = cases[i].v;
    assert_int_equal(pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL),
                     PENDRES_TOLERANCE_UNREACHABLE);
    assert_non_null(strstr(pendres_context_message(ctx), cases[i].said));
  }
  pendres_context_free(ctx);
}

/* A pendulum too stiff for explicit steps is refused with the remedy, and the remedy works. */
static void test_stiff(void **state)
{
  const pendres_pendulum p = { .damping = 1e6, .drive_amplitude = 0.2, .drive_frequency = 0.01 };
  pendres_context *ctx = context(NULL);
  double x = 2.0, v = 0.0, error = NAN;
  (void)state;
  assert_int_equal(pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL),
                   PENDRES_TOLERANCE_UNREACHABLE);
  assert_non_null(strstr(pendres_context_message(ctx), "cvode_bdf"));
  check_near(x, 2.0, 0.0);
  pendres_context_free(ctx);
  ctx = context(&(pendres_options){ .method = PENDRES_CVODE_BDF });
  check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, &error));
  /*
   * To first order in 1/damping, damping x' = cos x + F0 cos(omega t): in a period T the drive's
   * part averages out and x moves by about T cos(2) / damping; the next order is damping times
   * smaller.
   */
  const double move = 2.0 * pi / p.drive_frequency * cos(2.0) / p.damping;
  check_near(x - 2.0, move, 1e-2 * fabs(move));
  assert_true(error < 1e-6);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_far_starts),
    cmocka_unit_test(test_far_angles),
    cmocka_unit_test(test_too_far),
    cmocka_unit_test(test_no_numbers_are_a_failure),
    cmocka_unit_test(test_reasons_for_steps),
    cmocka_unit_test(test_mirror),
    cmocka_unit_test(test_refusals),
    cmocka_unit_test(test_stiff),
  };
  return cmocka_run_group_tests_name("strobe_far", tests, NULL, NULL);
}
