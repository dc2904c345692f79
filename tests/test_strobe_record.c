/*
 * test_strobe_record.c -- trajectories sample by sample against the long double reference, the
 * stroboscopic map and a closed form.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const double pi = 3.14159265358979323846;

static pendres_context *context(double tolerance)
{
  const pendres_options options = { .tolerance = tolerance };
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&options, &ctx));
  return ctx;
}

/* At the strobes the reference says where the pendulum is, within the errors that are claimed. */
static void test_reference(void **state)
{
  static const struct { double damping, drive, frequency, x, v; } cases[] = {
    { 0.12, 0.2, 0.785, 0.3, 0.0 },  { 0.12, 0.2, 0.785, 4.0, 1.5 },
    { 0.5, 1.35, 2.0 / 3, 1.0, 0.0 } /* running */, { 1e-3, 0.0, 1.0, 0.0, 0.1 },
  };
  enum { PERIODS = 12, SAMPLES = 25, N = PERIODS * SAMPLES + 1 };
  double x[N], v[N], x_error[N], v_error[N];
  (void)state;
  for (size_t c = 0; c < COUNT(cases); c++)
    for (double tolerance = 1e-6; tolerance > 1e-13; tolerance *= 1e-2) {
      const pendres_pendulum p = { cases[c].damping, cases[c].drive, cases[c].frequency, 0.0 };
      pendres_context *ctx = context(tolerance);
      check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){cases[c].x, cases[c].v}, PERIODS,
                                     SAMPLES, &(pendres_record){x, v, x_error, v_error}));
      for (long k = 0; k <= PERIODS; k++) {
        long double y = (long double)cases[c].x - 1.57079632679489661923L, w = cases[c].v;
        long turns = 0;
        check_ok(reference_advance(&p, &y, &w, &turns, k));
        const double want = (double)(y + 1.57079632679489661923L + 6.28318530717958647693L * turns);
        const size_t i = (size_t)k * SAMPLES;
        /* Within the claim; and the claim, where nothing amplifies, near the goal. */
        check_near(x[i], want, x_error[i] + 1e-15);
        check_near(v[i], (double)w, v_error[i] + 1e-15);
        assert_true(x_error[i] < 100.0 * tolerance + 1e-12);
      }
      pendres_context_free(ctx);
    }
}

/*
 * Two runs that have separated and meet again, v to 9 digits, on a running state that the
 * truth does not follow: from where they separated on, neither x nor v is known.
 */
static void test_lost_for_good(void **state)
{
  enum { PERIODS = 18, SAMPLES = 64, N = PERIODS * SAMPLES + 1 };
  static double x[N], v[N], x_error[N], v_error[N];
  const pendres_pendulum p = { .damping = 0.26695352360442653, .drive_amplitude = 1.145747321172213,
                               .drive_frequency = 0.26962474087403093 };
  const double x0 = 0.13573901157166546, v0 = 2.2905638541228086;
  pendres_context *ctx = context(1e-2);
  size_t lost = N;
  (void)state;
  check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){x0, v0}, PERIODS, SAMPLES,
                                 &(pendres_record){x, v, x_error, v_error}));
  for (size_t k = 0; k < N; k++) {
    assert_true(isfinite(x_error[k]) == isfinite(v_error[k]));
    if (k < lost && !isfinite(v_error[k])) lost = k;
    assert_true(isfinite(v_error[k]) == (k < lost));
  }
  assert_true(lost < N);
  long double y = (long double)x0 - 1.57079632679489661923L, w = v0;
  for (size_t k = 0; k < N; k += SAMPLES) {
    if (k > 0) check_ok(reference_advance(&p, &y, &w, NULL, 1));
    check_near(v[k], (double)w, v_error[k]);
  }
  pendres_context_free(ctx);
}

/* Linear limit between the strobes: the closed form at every phase; the sine's cubic term is
   y^3/6 ~ 2e-22 beside y ~ 1e-7, and rounding of x, which is near pi/2, 1e-15 or so a step. */
static void test_phases(void **state)
{
  const pendres_pendulum p = { 0.3, 1e-7, 0.8, 0.0 };
  enum { SAMPLES = 37, PERIODS = 3, N = PERIODS * SAMPLES + 1 };
  pendres_harmonic h;
  double x[N], v[N];
  pendres_context *ctx = context(1e-13);
  (void)state;
  check_ok(pendres_harmonic_find(&p, &h));
  const pendres_state start = {0.5 * pi + h.amplitude * cos(h.phase_lag),
                               0.8 * h.amplitude * sin(h.phase_lag)};
  check_ok(pendres_strobe_record(ctx, &p, &start, PERIODS, SAMPLES,
                                 &(pendres_record){.x = x, .v = v}));
  for (int k = 0; k < N; k++) {
    const double theta = 2.0 * pi * k / SAMPLES;
    check_near(x[k] - 0.5 * pi, h.amplitude * cos(theta - h.phase_lag), 1e-14);
    check_near(v[k], -0.8 * h.amplitude * sin(theta - h.phase_lag), 1e-14);
  }
  pendres_context_free(ctx);
}

/* One sample a period or thousands: the same trajectory within the errors. */
static void test_densities(void **state)
{
  static const int samples[] = { 1, 2, 7, 64, 5000 };
  const pendres_pendulum p = { 0.12, 0.2, 0.785, 0.0 };
  enum { PERIODS = 5, MOST = PERIODS * 5000 + 1 };
  double *memory = malloc(4 * MOST * sizeof *memory);
  pendres_context *ctx = context(1e-9);
  double x_end = -1.0, v_end = 0.4, error = 0.0;
  (void)state;
  assert_non_null(memory);
  check_ok(pendres_strobe_advance(ctx, 1, &p, &x_end, &v_end, PERIODS, &error));
  for (size_t i = 0; i < COUNT(samples); i++) {
    const size_t n = (size_t)(PERIODS * samples[i]);
    double *x = memory, *v = x + MOST, *x_error = v + MOST, *v_error = x_error + MOST;
    check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){-1.0, 0.4}, PERIODS, samples[i],
                                   &(pendres_record){x, v, x_error, v_error}));
    check_near(x[0], -1.0, 0.0);
    check_near(v[0], 0.4, 0.0);
    /* Within ten times what each of the two claims. */
    check_near(x[n], x_end, 10.0 * (x_error[n] + error));
    check_near(v[n], v_end, 10.0 * (v_error[n] + error));
  }
  free(memory);
  pendres_context_free(ctx);
}

static int always(void *arg)
{
  (void)arg;
  return 1;
}

static void test_refusals(void **state)
{
  const pendres_pendulum p = { 0.12, 0.2, 0.785, 0.0 }, bad = { -1.0, 0.2, 0.785, 0.0 };
  double x[11], v[11];
  pendres_context *ctx = context(1e-8);
  (void)state;
  assert_int_equal(pendres_strobe_record(ctx, &bad, &(pendres_state){0, 0}, 1, 10,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){NAN, 0}, 1, 10,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){0, 0}, -1, 10,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){0, 0}, 1, 0,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){0, 0}, 1, 10,
                                         &(pendres_record){x, v, x, NULL}),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){0, 0}, 1L << 60, 1000,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INVALID_ARGUMENT);
  /* No periods: the start alone. */
  check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){0.7, 0.1}, 0, 10,
                                 &(pendres_record){.x = x, .v = v}));
  check_near(x[0], 0.7, 0.0);
  pendres_context_set_interrupt(ctx, always, NULL);
  assert_int_equal(pendres_strobe_record(ctx, &p, &(pendres_state){0, 0}, 1, 10,
                                         &(pendres_record){.x = x, .v = v}),
                   PENDRES_INTERRUPTED);
  pendres_context_free(ctx);
}

/* In chaos the second run's covariance leaves all numbers after some 2000 periods: where nothing is
   known errors are infinite, not NaN. */
static void test_lost_is_infinite(void **state)
{
  enum { N = 4001 };
  static double x[N], v[N], x_error[N], v_error[N];
  const pendres_pendulum p = { .damping = 0.25, .drive_amplitude = 1.5,
                               .drive_frequency = 2.0 / 3.0 };
  pendres_context *ctx = context(1e-6);
  (void)state;
  check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){1.8, 0.0}, N - 1, 1,
                                 &(pendres_record){x, v, x_error, v_error}));
  assert_true(isfinite(x_error[5]) && isfinite(v_error[5]));
  for (size_t k = 1000; k < N; k++) assert_true(isinf(x_error[k]) && isinf(v_error[k]));
  pendres_context_free(ctx);
}

/* In pieces of any length, gone on with from copies and in other contexts: the same bytes, also
   where a chaotic trajectory is lost on the way. */
static void test_pieces(void **state)
{
  enum { PERIODS = 60, SAMPLES = 5, N = PERIODS * SAMPLES + 1 };
  static double want[4][N], got[4][N];
  const pendres_pendulum p = { .damping = 0.5, .drive_amplitude = 1.15,
                               .drive_frequency = 2.0 / 3.0 };
  pendres_context *ctx = context(1e-8);
  pendres_recording r;
  (void)state;
  check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){1.8, 0.1}, PERIODS, SAMPLES,
                                 &(pendres_record){want[0], want[1], want[2], want[3]}));
  assert_true(isfinite(want[2][20]) && isinf(want[2][N - 1]));
  check_ok(pendres_recording_begin(ctx, &p, &(pendres_state){1.8, 0.1}, PERIODS, SAMPLES, &r));
  for (long done = 0, some = 1; done < PERIODS; done += some, some = (2 * some) % 13 + 1) {
    const pendres_recording before = r;
    const size_t at = (size_t)done * SAMPLES;
    pendres_context_free(ctx);
    ctx = context(1e-8);
    if (some > PERIODS - done) some = PERIODS - done;
    r = before;
    check_ok(pendres_recording_advance(
      ctx, &r, some, &(pendres_record){got[0] + at, got[1] + at, got[2] + at, got[3] + at}));
    assert_true(r.periods == done + some && r.x == got[0][at + (size_t)some * SAMPLES]);
  }
  assert_true(r.lost == 1);
  assert_memory_equal(got, want, sizeof want);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_reference),
    cmocka_unit_test(test_lost_for_good),
    cmocka_unit_test(test_lost_is_infinite),
    cmocka_unit_test(test_pieces),
    cmocka_unit_test(test_phases),
    cmocka_unit_test(test_densities),
    cmocka_unit_test(test_refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
