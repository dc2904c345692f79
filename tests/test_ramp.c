/*
 * test_ramp.c -- parameters that move in real time: trajectories, delays past a fold, and jumps
 * that scatter with noise.
 *
 * Trajectories are compared with the classical Runge-Kutta method; delays with the normal form of a
 * fold, whose one constant comes from multipliers of the orbits before it; scattered jumps with
 * another integrator, other random numbers, and another way to find out when a pendulum has left.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/attractor.h>
#include <pendres/ramp.h>

#include "context_fixture.h"

#include "analysis/sweeps/ramp_watch.h"

static const double two_pi = 6.28318530717958647693;

enum { MOST_POINTS = 100 };

/* Where SA ends at damping 0.12, F0 = 0.2: `pendres_fold_find` and the sweep's jump agree on it. */
static const pendres_pendulum plain = {.damping = 0.12, .drive_amplitude = 0.2,
                                       .drive_frequency = 0.8};
static const double fold = 0.84159987215;

static int setup_seeded(void **state)
{
  *state = context_with(&(pendres_options){.tolerance = 1e-6, .seed = 5});
  return 0;
}

/* A ramp from one value to another, and back where `back` is set, with its path. */
typedef struct course {
  pendres_ramp ramp;
  pendres_hysteresis *path;
  long period[3];
  double value[3];
} course;

static void free_course(course *c)
{
  pendres_hysteresis_free(c->path);
}

/* A pendulum's SA, or what it is on where there is none. */
static pendres_attractor start_of(pendres_context *ctx, const pendres_pendulum *p)
{
  pendres_attractors *set = NULL;
  check_ok(pendres_attractors_find(ctx, p, 0, NULL, NULL, &set));
  assert_true(pendres_attractors_count(set) > 0);
  pendres_attractor a = *pendres_attractors_get(set, 0);
  for (size_t i = 0; i < pendres_attractors_count(set); i++)
    if (pendres_attractors_get(set, i)->label == PENDRES_LABEL_SA)
      a = *pendres_attractors_get(set, i);
  pendres_attractors_free(set);
  return a;
}

static void lay(pendres_context *ctx, course *c, pendres_pendulum p, pendres_parameter parameter,
                double from, double to, long periods, int back)
{
  enum { POINTS = MOST_POINTS / 2 };
  double value[MOST_POINTS];
  const size_t n = back ? 2 * POINTS : POINTS;
  for (size_t i = 0; i < POINTS; i++)
    value[i] = value[MOST_POINTS - 1 - i] = from + (to - from) * (double)i / (POINTS - 1);
  pendres_parameter_set(parameter, from, &p);
  const pendres_attractor a = start_of(ctx, &p);
  *c = (course){.period = {0, periods, 2 * periods},
                .value = {value[0], value[POINTS - 1], value[0]}};
  check_ok(pendres_hysteresis_find(ctx, &p, &(pendres_state){a.orbit.x, a.orbit.v},
                                   &(pendres_hysteresis_path){parameter, n, value}, &c->path));
  c->ramp = (pendres_ramp){.pendulum = p, .parameter = parameter, .corners = back ? 3 : 2,
                           .period = c->period, .value = c->value, .points = n,
                           .point = pendres_hysteresis_get(c->path, 0),
                           .jumps = pendres_hysteresis_jump_count(c->path),
                           .jump = pendres_hysteresis_jump_get(c->path, 0)};
}

/* ---- trajectories ---- */

static void slope(const pendres_ramp *r, double theta, const double s[2], double out[2])
{
  pendres_pendulum p = r->pendulum;
  const double end = (double)pendres_ramp_periods(r), time = fmin(end, theta / two_pi);
  pendres_parameter_set(r->parameter, pendres_ramp_value(r, time), &p);
  double force = -cos(s[0]);
  if (p.force == PENDRES_FORCE_POLYNOMIAL)
    force = p.force_coefficients[0] * s[0] + p.force_coefficients[2] * s[0] * s[0] * s[0];
  force *= 1.0 + p.parametric_amplitude * cos(theta);
  out[0] = s[1] / p.drive_frequency;
  out[1] = (p.torque - force + p.drive_amplitude * cos(theta) - p.damping * s[1]) /
           p.drive_frequency;
}

/* A step of the classical method of order four, with the phase for time. */
static void runge_kutta(const pendres_ramp *r, double theta, double h, double s[2])
{
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double k[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0};
  for (int stage = 0; stage < 4; stage++) {
    const double at[2] = {s[0] + part[stage] * h * k[0], s[1] + part[stage] * h * k[1]};
    slope(r, theta + part[stage] * h, at, k);
    for (int j = 0; j < 2; j++) sum[j] += weight[stage] * k[j];
  }
  for (int j = 0; j < 2; j++) s[j] += h / 6.0 * sum[j];
}

/* Fast ramps of each parameter: of the errors claimed, the true ones are a share. */
static void trajectories(void **state)
{
  enum { PERIODS = 30, STEPS = 500 };
  static const struct {
    pendres_parameter parameter;
    double from, to;
  } cases[] = {{PENDRES_DRIVE_FREQUENCY, 0.6, 1.0}, {PENDRES_DRIVE_AMPLITUDE, 0.1, 0.4},
               {PENDRES_DAMPING, 0.4, 0.1}, {PENDRES_TORQUE, 0.0, 0.4},
               {PENDRES_PARAMETRIC_AMPLITUDE, 0.0, 0.5}, {PENDRES_A3, 0.1, 0.6}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    double x[PERIODS + 1], v[PERIODS + 1], dx[PERIODS + 1], dv[PERIODS + 1], largest = 0.0;
    const pendres_ramp_record record = {.every = 1, .x = x, .v = v, .x_error = dx, .v_error = dv};
    const long period[2] = {0, PERIODS};
    const double value[2] = {cases[k].from, cases[k].to};
    /* Not on any attractor: a way to one counts as well. */
    const pendres_hysteresis_point start = {.value = value[0], .x = 1.2, .v = 0.1};
    pendres_ramp r = {.pendulum = plain, .parameter = cases[k].parameter, .corners = 2,
                      .period = period, .value = value, .points = 1, .point = &start};
    if (r.parameter == PENDRES_A3) {
      r.pendulum.force = PENDRES_FORCE_POLYNOMIAL;
      r.pendulum.force_coefficients[0] = 1.0;
    }
    check_ok(pendres_ramp_find(*state, &r, &record, NULL));
    double s[2] = {x[0], v[0]};
    for (int i = 0; i < PERIODS; i++) {
      for (int step = 0; step < STEPS; step++)
        runge_kutta(&r, two_pi * (i + (double)step / STEPS), two_pi / STEPS, s);
      /* 500 steps are off by some 1e-10. */
      check_near(x[i + 1], s[0], dx[i + 1] + 1e-8);
      check_near(v[i + 1], s[1], dv[i + 1] + 1e-8);
      largest = fmax(largest, dx[i + 1]);
    }
    assert_true(largest < 1e-3); /* so fast a ramp is off by some 1e-5 for the parameter's motion */
  }
}

/* ---- delays ---- */

/*
 * Near a fold the strobe map is u -> u + u^2 + k P, P the distance beyond the fold: the multiplier
 * before it is 1 - 2 sqrt(-k P). A ramp of a given rate passes it at
 * P = 2.33810741 k^(-1/3) rate^(2/3), minus the first zero of the Airy function.
 */
static double passage(pendres_context *ctx)
{
  double m[2], off[2] = {1e-6, 2.5e-7};
  const pendres_attractor a = start_of(ctx, &plain);
  double value[3] = {plain.drive_frequency, fold - off[0], fold - off[1]};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(ctx, &plain, &(pendres_state){a.orbit.x, a.orbit.v},
                                   &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, 3, value},
                                   &h));
  for (size_t i = 0; i < 2; i++) {
    const double all = pendres_hysteresis_get(h, i + 1)->attractor.orbit.multiplier_re[0];
    m[i] = (1.0 - all) * (1.0 - all) / (4.0 * off[i]);
  }
  pendres_hysteresis_free(h);
  /* The next term goes as the root of the distance. */
  return 2.33810741 / cbrt(2.0 * m[1] - m[0]);
}

/* Six rates, five decades: the exponent, and the factor that the normal form has. */
static void delays(void **state)
{
  enum { RATES = 6 };
  static const double rate[RATES] = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  /* The slowest delay is 1e-6: the fold must be known far better than that. */
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-11});
  (void)state;
  double delay[RATES], scaled[RATES], log_rate[RATES];
  for (size_t k = 0; k < RATES; k++) {
    course c;
    pendres_ramp_jump j;
    const double reach = 6.0 * pow(rate[k], 2.0 / 3.0);
    const long periods = (long)(1.4 * reach / rate[k]);
    lay(ctx, &c, plain, PENDRES_DRIVE_FREQUENCY, fold - reach,
        fold - reach + rate[k] * (double)periods, periods, 0);
    assert_int_equal(c.ramp.jumps, 1);
    check_ok(pendres_ramp_find(ctx, &c.ramp, NULL, &j));
    check_near(j.value, c.value[0] + rate[k] * j.time, 1e-12);
    check_near(j.delay, j.value - fold, 1e-10);
    assert_true(j.delay_error > 0.0 && j.delay_error < 1e-5 * j.delay);
    delay[k] = j.delay;
    scaled[k] = delay[k] / pow(rate[k], 2.0 / 3.0);
    log_rate[k] = log(rate[k]);
    free_course(&c);
  }
  /* Over three decades, next terms left out: they go as rate^(1/3) log rate and make 0.009. */
  check_near(log(delay[0] / delay[3]) / (log_rate[0] - log_rate[3]), 2.0 / 3.0, 0.012);
  /* With these terms: scaled = a + rate^(1/3) (b log rate + c), from the slowest three. What is
     left out goes as rate^(2/3). */
  double z[3], q[3];
  for (size_t i = 0; i < 3; i++) {
    z[i] = cbrt(rate[i + 3]);
    q[i] = z[i] * log_rate[i + 3];
  }
  const double d1 = z[1] - z[0], d2 = z[2] - z[0], e1 = q[1] - q[0], e2 = q[2] - q[0];
  const double s1 = scaled[4] - scaled[3], s2 = scaled[5] - scaled[3];
  const double b = (s1 * d2 - s2 * d1) / (e1 * d2 - e2 * d1), c = (s1 - b * e1) / d1;
  check_near(scaled[3] - b * q[0] - c * z[0], passage(ctx), 0.001);
  pendres_context_free(ctx);
}

/* Up and down, holds on the way: each state is left late, in the direction of the ramp. */
static void there_and_back(void **state)
{
  course c;
  pendres_ramp_jump j[2];
  pendres_pendulum p = plain;
  p.damping = 0.15;
  lay(*state, &c, p, PENDRES_DRIVE_FREQUENCY, 0.65, 0.9, 1000, 1);
  assert_int_equal(c.ramp.jumps, 2);
  check_ok(pendres_ramp_find(*state, &c.ramp, NULL, j));
  for (size_t k = 0; k < 2; k++) {
    assert_true(j[k].delay > 0.0 && j[k].delay < 0.03);
    assert_int_equal(c.ramp.jump[k].direction, k == 0 ? 1 : -1);
    assert_true(k == 0 ? j[k].time < 1000.0 : j[k].time > 1000.0);
  }
  /* The same ramp, but so short that the first state is never left: there is no jump, and nothing
     else to come back from. */
  c.value[1] = c.ramp.jump[0].value - 0.01;
  check_ok(pendres_ramp_find(*state, &c.ramp, NULL, j));
  assert_true(isnan(j[0].time) && isnan(j[0].delay) && isnan(j[1].delay_error));
  assert_true(isnan(j[1].time));
  free_course(&c);
}

static void tables_of_times(void **state)
{
  static const long period[] = {0, 10, 30, 70};
  static const double value[] = {0.5, 0.6, 0.6, 0.2};
  const pendres_ramp r = {.corners = 4, .period = period, .value = value};
  (void)state;
  assert_int_equal(pendres_ramp_periods(&r), 70);
  check_near(pendres_ramp_value(&r, 0.0), 0.5, 0.0);
  check_near(pendres_ramp_value(&r, 2.5), 0.525, 1e-15);
  check_near(pendres_ramp_value(&r, 17.0), 0.6, 0.0);
  check_near(pendres_ramp_value(&r, 50.0), 0.4, 1e-15);
  check_near(pendres_ramp_value(&r, 70.0), 0.2, 0.0);
  assert_true(isnan(pendres_ramp_value(&r, -1e-9)) && isnan(pendres_ramp_value(&r, 70.1)));
}

/* ---- noise ---- */

/* An own generator: xorshift64*, and the polar method of Marsaglia. */
static double uniform(uint64_t *s)
{
  *s ^= *s >> 12;
  *s ^= *s << 25;
  *s ^= *s >> 27;
  return (double)((*s * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53;
}

static double gauss(uint64_t *s)
{
  for (;;) {
    const double a = 2.0 * uniform(s) - 1.0, b = 2.0 * uniform(s) - 1.0, r = a * a + b * b;
    if (r > 0.0 && r < 1.0) return a * sqrt(-2.0 * log(r) / r);
  }
}

/*
 * Time of the jump of one trajectory: when the first harmonic is past half way between the two
 * states, which stand still here as they are at the fold. Half of a step's noise, the deterministic
 * motion by Runge and Kutta, and the other half: of order two in what noise does.
 */
static double jump_time(const pendres_ramp *r, const pendres_orbit *old, const pendres_orbit *new,
                        uint64_t *seed)
{
  enum { STEPS = 50 };
  const double half = 0.5 * hypot(new->cosine[0] - old->cosine[0], new->sine[0] - old->sine[0]);
  const double heat = r->pendulum.damping * r->pendulum.temperature;
  double s[2] = {r->point[0].x, r->point[0].v}, before = 0.0;
  for (long k = 0; k < pendres_ramp_periods(r); k++) {
    double a = 0.0, b = 0.0;
    for (int i = 0; i < STEPS; i++) {
      const double theta = two_pi * ((double)k + (double)i / STEPS);
      const double h = two_pi / STEPS, time = h / pendres_ramp_value(r, theta / two_pi);
      a += 2.0 / STEPS * s[0] * cos(theta);
      b += 2.0 / STEPS * s[0] * sin(theta);
      s[1] += sqrt(heat * time) * gauss(seed);
      runge_kutta(r, theta, h, s);
      s[1] += sqrt(heat * time) * gauss(seed);
    }
    const double distance = hypot(a - old->cosine[0], b - old->sine[0]) / half;
    if (distance > 1.0) return (double)k - 0.5 + (1.0 - before) / (distance - before);
    before = distance;
  }
  return NAN;
}

/* Mean and width of the jumps, beside those of an independent simulation. */
static void noisy_jumps(void **state)
{
  enum { N = 96 };
  const double rate = 2e-4;
  course c;
  double time[N], value[N], other[N];
  pendres_pendulum p = plain;
  uint64_t seed = 88172645463325252u;
  p.temperature = 1e-3;
  lay(*state, &c, p, PENDRES_DRIVE_FREQUENCY, 0.82, 0.82 + 200 * rate, 200, 0);
  assert_int_equal(c.ramp.jumps, 1);
  check_ok(pendres_ramp_scatter(*state, &c.ramp, N, 0, time, value));
  const size_t step = c.ramp.jump[0].step;
  const pendres_orbit *old = &c.ramp.point[step - 1].attractor.orbit;
  const pendres_orbit *new = &c.ramp.point[step].attractor.orbit;
  for (size_t i = 0; i < N; i++) {
    check_near(value[i], 0.82 + rate * time[i], 1e-12);
    other[i] = 0.82 + rate * jump_time(&c.ramp, old, new, &seed);
  }
  pendres_ramp_summary a, b;
  check_ok(pendres_ramp_summarize(N, value, &a));
  check_ok(pendres_ramp_summarize(N, other, &b));
  assert_true(a.count == N && b.count == N);
  /* Four standard errors: one run of 8000 fails by chance. */
  check_near(a.mean, b.mean, 4.0 * hypot(a.mean_error, b.mean_error));
  check_near(a.deviation, b.deviation, 4.0 * hypot(a.deviation_error, b.deviation_error));
  /* It is noise that counts: most jumps are before the one without. */
  pendres_ramp_jump j;
  check_ok(pendres_ramp_find(*state, &c.ramp, NULL, &j));
  assert_true(a.mean < j.value - 4.0 * a.mean_error && a.deviation > 3.0 * rate);
  free_course(&c);
}

/* A trajectory is what its seed and number say, whoever is beside it. */
static void streams(void **state)
{
  enum { N = 13 };
  course c;
  double all[N], some[3], again[N];
  pendres_pendulum p = plain;
  p.temperature = 1e-3;
  lay(*state, &c, p, PENDRES_DRIVE_FREQUENCY, 0.82, 0.86, 100, 0);
  check_ok(pendres_ramp_scatter(*state, &c.ramp, N, 7, all, NULL));
  check_ok(pendres_ramp_scatter(*state, &c.ramp, 3, 11, some, NULL));
  assert_memory_equal(some, all + 4, sizeof some);
  assert_true(all[0] != all[1]);
  pendres_context *other = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-6, .seed = 6}, &other));
  check_ok(pendres_ramp_scatter(other, &c.ramp, N, 7, again, NULL));
  assert_memory_not_equal(again, all, sizeof all);
  pendres_context_free(other);
  free_course(&c);
}

/* 1, 2, 3, 4, 10: mean 4, variance 50/4; the fourth moment about 4 is (81 + 16 + 1 + 1296)/5. */
static void summaries(void **state)
{
  const double value[] = {3.0, NAN, 1.0, 10.0, 2.0, NAN, 4.0};
  pendres_ramp_summary s;
  (void)state;
  check_ok(pendres_ramp_summarize(7, value, &s));
  assert_int_equal(s.count, 5);
  check_near(s.mean, 4.0, 1e-15);
  check_near(s.deviation, sqrt(12.5), 1e-14);
  check_near(s.mean_error, sqrt(2.5), 1e-14);
  check_near(s.deviation_error, 0.5 * sqrt((278.8 - 12.5 * 12.5 * 0.5) / 5.0 / 12.5), 1e-13);
  check_ok(pendres_ramp_summarize(2, value, &s));
  assert_true(s.count == 1 && s.mean == 3.0 && isnan(s.mean_error) && isnan(s.deviation));
  check_ok(pendres_ramp_summarize(0, NULL, &s));
  assert_true(s.count == 0 && isnan(s.mean));
}

/* A ship in x'' + 0.3 x' + x - x^2 = F cos(0.8 t) capsizes on a ramp to F = 0.5, where it escapes
   from every state, and does not come back: before that it is known, from there on nothing is. */
static void capsizes(void **state)
{
  enum { PERIODS = 40, POINTS = PERIODS + 1, VALUES = 4 };
  static const long period[] = {0, PERIODS};
  static const double value[VALUES] = {0.05, 0.06, 0.3, 0.5}, ends[] = {0.05, 0.5};
  const pendres_pendulum p = {.damping = 0.3, .drive_frequency = 0.8, .drive_amplitude = 0.05,
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, -1.0}};
  double x[POINTS], v[POINTS], x_error[POINTS], v_error[POINTS];
  const pendres_ramp_record record = {1, x, v, x_error, v_error};
  pendres_ramp_jump jump[8];
  pendres_hysteresis *path = NULL;
  check_ok(pendres_hysteresis_find(
    *state, &p, &(pendres_state){0.1, 0.0},
    &(pendres_hysteresis_path){PENDRES_DRIVE_AMPLITUDE, VALUES, value}, &path));
  assert_int_equal(pendres_hysteresis_get(path, VALUES - 1)->attractor.label,
                   PENDRES_LABEL_ESCAPE);
  const pendres_ramp ramp = {.pendulum = p, .parameter = PENDRES_DRIVE_AMPLITUDE, .corners = 2,
                             .period = period, .value = ends, .points = VALUES,
                             .point = pendres_hysteresis_get(path, 0),
                             .jumps = pendres_hysteresis_jump_count(path),
                             .jump = pendres_hysteresis_jump_get(path, 0)};
  assert_true(ramp.jumps <= 8);
  check_ok(pendres_ramp_find(*state, &ramp, &record, jump));
  int known = 0;
  while (known < POINTS && !isnan(x[known])) {
    assert_true(fabs(x[known]) < 1e8 && x_error[known] >= 0.0);
    known++;
  }
  assert_true(known > 4 && known < POINTS);
  /* Small swings at first: their error is told. */
  assert_true(fabs(x[2]) < 0.5 && x_error[2] < 1e-4);
  for (int k = known; k < POINTS; k++)
    assert_true(isnan(x[k]) && isnan(v[k]) && isnan(x_error[k]) && isnan(v_error[k]));
  pendres_hysteresis_free(path);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(trajectories),    cmocka_unit_test(delays),
    cmocka_unit_test(there_and_back),  cmocka_unit_test(tables_of_times),
    cmocka_unit_test(noisy_jumps),     cmocka_unit_test(streams),
    cmocka_unit_test(summaries),
    cmocka_unit_test_setup_teardown(capsizes, setup_seeded, teardown),
  };
  return cmocka_run_group_tests(tests, setup_seeded, teardown);
}
