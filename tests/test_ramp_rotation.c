/*
 * test_ramp_rotation.c -- ramps of pendulums without a drive: what their drive's frequency would be
 * concerns neither when a rotation ends nor when a well does.
 *
 * Beside them stand own simulations, in time: the classical Runge-Kutta method, with kicks of noise
 * where there is any. There a rotation has ended with the last turn before a pause, a well when the
 * pendulum stands on its other side.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/ramp.h>

#include "context_fixture.h"

static const double two_pi = 6.28318530717958647693;

/* Frequencies of a drive that does not drive; periods of twelve and of half a turn of the end. */
static const double frequency[] = {0.25, 0.5, 1.0, 2.0, 4.0, 16.0};
enum { FREQUENCIES = sizeof frequency / sizeof *frequency, POINTS = 81, N = 96 };

static int setup_seeded(void **state)
{
  *state = context_with(&(pendres_options){.tolerance = 1e-6, .seed = 5});
  return 0;
}

/* A torque that moves at a rate per unit time, from one value to another, and a start. */
typedef struct plan {
  pendres_pendulum p;
  double from, to, rate, x, v;
} plan;

/* A junction that rotates, until friction stops it. */
static const plan junction = {.p = {.damping = 0.5}, .from = 1.2, .to = 0.4, .rate = 2e-4,
                              .x = 0.0, .v = 2.4};
/* A double well, -x + x^3, whose left well ends at the torque 2/sqrt(27) = 0.3849. */
static const plan duffing = {.p = {.damping = 0.5, .force = PENDRES_FORCE_POLYNOMIAL,
                                   .force_coefficients = {-1.0, 0.0, 1.0}},
                             .from = 0.0, .to = 0.5, .rate = 2e-4, .x = -1.0, .v = 0.0};

/* ---- the library --------------------------------------------------------------------------- */

/* The jump without noise, and the values at which N noisy trajectories leave; how many of them did.
   *end receives where the path has the jump. */
static size_t leave(pendres_context *ctx, const plan *q, double omega, pendres_ramp_jump *jump,
                    double *noisy, double *end)
{
  const double length = fabs(q->to - q->from);
  const long period[] = {0, lrint(length / q->rate * omega / two_pi)};
  double value[POINTS], time[N];
  pendres_hysteresis *path = NULL;
  pendres_pendulum p = q->p;
  pendres_ramp_summary all;
  for (int i = 0; i < POINTS; i++)
    value[i] = q->from + (q->to - q->from) * (double)i / (POINTS - 1);
  p.drive_frequency = omega;
  p.torque = q->from;
  check_ok(pendres_hysteresis_find(ctx, &p, &(pendres_state){q->x, q->v},
                                   &(pendres_hysteresis_path){PENDRES_TORQUE, POINTS, value},
                                   &path));
  assert_int_equal(pendres_hysteresis_jump_count(path), 1);
  const double ends[] = {q->from, q->to};
  const pendres_ramp ramp = {.pendulum = p, .parameter = PENDRES_TORQUE, .corners = 2,
                             .period = period, .value = ends, .points = POINTS,
                             .point = pendres_hysteresis_get(path, 0), .jumps = 1,
                             .jump = pendres_hysteresis_jump_get(path, 0)};
  *end = ramp.jump[0].value;
  check_ok(pendres_ramp_find(ctx, &ramp, NULL, jump));
  check_ok(pendres_ramp_scatter(ctx, &ramp, N, 0, time, noisy));
  check_ok(pendres_ramp_summarize(N, noisy, &all));
  pendres_hysteresis_free(path);
  return all.count;
}

/* ---- own simulations ----------------------------------------------------------------------- */

/* xorshift64*, and the polar method of Marsaglia. */
static double gauss(uint64_t *s)
{
  for (;;) {
    double z[2];
    for (int i = 0; i < 2; i++) {
      *s ^= *s >> 12, *s ^= *s << 25, *s ^= *s >> 27;
      z[i] = 2.0 * (double)((*s * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53 - 1.0;
    }
    const double r = z[0] * z[0] + z[1] * z[1];
    if (r > 0.0 && r < 1.0) return z[0] * sqrt(-2.0 * log(r) / r);
  }
}

static void slope(const plan *q, double time, const double s[2], double out[2])
{
  const double torque = q->from + (q->to > q->from ? q->rate : -q->rate) * time;
  const double force = q->p.force == PENDRES_FORCE_POLYNOMIAL ? s[0] * s[0] * s[0] - s[0]
                                                              : -cos(s[0]);
  out[0] = s[1];
  out[1] = torque - force - q->p.damping * s[1];
}

static void runge_kutta(const plan *q, double time, double h, double s[2])
{
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double k[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0};
  for (int stage = 0; stage < 4; stage++) {
    const double at[2] = {s[0] + part[stage] * h * k[0], s[1] + part[stage] * h * k[1]};
    slope(q, time + part[stage] * h, at, k);
    for (int j = 0; j < 2; j++) sum[j] += weight[stage] * k[j];
  }
  for (int j = 0; j < 2; j++) s[j] += h / 6.0 * sum[j];
}

/* The torque when the last turn is completed, or the well's other side reached, before nothing of
   that kind happens for a time `pause`. */
static double own_end(const plan *q, double temperature, double pause, uint64_t *seed)
{
  const double h = 0.05, kick = sqrt(q->p.damping * temperature * h);
  const double all = fabs(q->to - q->from) / q->rate;
  double s[2] = {q->x, q->v}, top = s[0], last = 0.0;
  for (long k = 0; (double)k * h < all; k++) {
    const double time = (double)k * h;
    if (temperature > 0.0) s[1] += kick * gauss(seed);
    runge_kutta(q, time, h, s);
    if (temperature > 0.0) s[1] += kick * gauss(seed);
    if (q->p.force == PENDRES_FORCE_POLYNOMIAL ? s[0] < 0.0 : s[0] > top + two_pi) {
      top += two_pi;
      last = time;
    }
    if (time - last > pause) break;
  }
  return q->from + (q->to > q->from ? last : -last) * q->rate;
}

/* ---- comparisons --------------------------------------------------------------------------- */

/* Leavings without noise and with it, at all frequencies, beside the own ones; `own` is the time of
   a turn or of relaxation, by which two definitions of the same may differ. */
static void compare(pendres_context *ctx, const plan *q, double temperature, double own)
{
  const double pause = 2.0 / q->p.damping + 2.0 * own, sign = q->to > q->from ? 1.0 : -1.0;
  double value[N], mine[N], end;
  uint64_t seed = 88172645463325252u;
  pendres_ramp_summary there, here;
  plan noisy = *q;
  noisy.p.temperature = temperature;
  const double quiet = own_end(q, 0.0, pause, &seed);
  for (int i = 0; i < N; i++) mine[i] = own_end(q, temperature, pause, &seed);
  check_ok(pendres_ramp_summarize(N, mine, &here));
  for (int k = 0; k < FREQUENCIES; k++) {
    pendres_ramp_jump jump;
    assert_int_equal(leave(ctx, &noisy, frequency[k], &jump, value, &end), N);
    check_ok(pendres_ramp_summarize(N, value, &there));
    check_near(jump.value, quiet, own * q->rate);
    check_near(jump.delay, sign * (jump.value - end), 1e-12);
    /* Four standard errors: one run of a thousand fails by chance. */
    check_near(there.mean, here.mean,
               own * q->rate + 4.0 * hypot(there.mean_error, here.mean_error));
    check_near(there.deviation, here.deviation,
               own * q->rate + 4.0 * hypot(there.deviation_error, here.deviation_error));
  }
}

/* A turn takes 12 at the last value before friction stops it. */
static void rotations_end_whatever_the_frequency(void **state)
{
  compare(*state, &junction, 0.05, 12.0);
}

/* From the place where the fold was to the other well, and calm there: some four times
   2/damping. */
static void wells_end_whatever_the_frequency(void **state)
{
  compare(*state, &duffing, 0.005, 16.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rotations_end_whatever_the_frequency),
    cmocka_unit_test(wells_end_whatever_the_frequency),
  };
  return cmocka_run_group_tests(tests, setup_seeded, teardown);
}
