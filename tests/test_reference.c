/*
 * test_reference.c -- the long double reference against closed forms, conservation laws,
 * differences of itself, and the numbers of golden.h.
 *
 * All tolerances are multiples of the rounding error of long double as it is when the test
 * runs: valgrind computes with 53 bits where the machine has 64.
 */
#include "reference_fixture.h"

static long double growth(const reference_image *image)
{
  return fmaxl(fmaxl(fabsl(image->monodromy[0][0]), fabsl(image->monodromy[0][1])),
               fmaxl(fabsl(image->monodromy[1][0]), fabsl(image->monodromy[1][1])));
}

/* ---- Closed forms -------------------------------------------------------------------------- */

/* Jacobi's amplitude am(u, k) by descending Landen steps; k1 is the complementary modulus and
   *quarter receives K(k). Abramowitz and Stegun 16.4. */
static long double amplitude(long double u, long double k, long double k1, long double *quarter)
{
  enum { MOST = 20 };
  long double a[MOST] = { 1.0L }, c[MOST] = { k }, b = k1;
  int n = 0;
  while (n < MOST - 1 && fabsl(c[n]) > LDBL_EPSILON) {
    a[n + 1] = 0.5L * (a[n] + b);
    c[n + 1] = 0.5L * (a[n] - b);
    b = sqrtl(a[n] * b);
    n++;
  }
  *quarter = pi / (2.0L * a[n]);
  const long double turns = rintl(u / (4.0L * *quarter));
  long double phi = ldexpl(a[n] * (u - turns * 4.0L * *quarter), n);
  for (; n > 0; n--) phi = 0.5L * (phi + asinl(c[n] / a[n] * sinl(phi)));
  return phi + 2.0L * pi * turns;
}

static void test_free_oscillation(void **state)
{
  static const double amplitudes[] = { 1e-3, 0.5, 1.5, 2.5, 3.1 };
  (void)state;
  for (size_t i = 0; i < COUNT(amplitudes); i++) {
    for (long periods = 1; periods <= 20; periods += 19) {
      const pendres_pendulum p = make(0.0, 0.0, 0.83);
      const long double time = 2.0L * pi * (long double)periods / p.drive_frequency;
      const long double k = sinl(0.5L * amplitudes[i]), k1 = cosl(0.5L * amplitudes[i]);
      long double quarter = 0.0L;
      amplitude(0.0L, k, k1, &quarter);
      const long double phi = amplitude(time + quarter, k, k1, &quarter);
      reference_image image;
      check_ok(reference_map(&p, amplitudes[i], 0.0L, periods, &image));
      /* The closed form knows its time to a rounding error, and so the state. */
      const long double tolerance =
          4.0L * epsilon() * (1.0L + time) * fmaxl(1.0L, growth(&image)) * amplitudes[i];
      assert_int_equal(image.turns, 0);
      check_long(image.y, 2.0L * asinl(k * sinl(phi)), tolerance);
      check_long(image.v, 2.0L * k * cosl(phi), tolerance);
      /* Energy knows no time: only the roundings of some 30 steps a period add up. */
      const long double energy = 0.5L * image.v * image.v + 2.0L * sinl(0.5L * image.y) *
                                                              sinl(0.5L * image.y);
      check_long(energy, 2.0L * k * k, 2.0L * k * k * epsilon() * (2.0L + (long double)periods));
    }
  }
}

/* The energy of a long free oscillation does not wander: no error of a step has a sign. */
static void test_long_energy(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.0, 0.0, 0.78539816339744828);
  long double y = 1.0L, v = 0.0L;
  check_ok(reference_advance(&p, &y, &v, NULL, 1000));
  const long double s = sinl(0.5L * y), s0 = sinl(0.5L);
  /* 30000 steps, each with a rounding of its increment, a sixth of the state or less, to
     either side: 170/6. One of the same sign each period would be seen. */
  check_long(0.5L * v * v + 2.0L * s * s, 2.0L * s0 * s0, 30.0L * epsilon());
}

static void test_free_rotation(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.0, 0.0, 0.7);
  for (int sign = -1; sign <= 1; sign += 2) {
    const long double start = 2.5L * sign, k = 0.8L, k1 = 0.6L;
    const long double time = 2.0L * pi * 30.0L / p.drive_frequency;
    long double quarter = 0.0L, y = 0.0L, v = start;
    long turns = 7;
    const long double phi = amplitude(0.5L * start * time, k, k1, &quarter);
    check_ok(reference_advance(&p, &y, &v, &turns, 30));
    /* Both sides know the time to a rounding error; a growing shift of phase in the
       wrong 2 pi, or a lost turn, would be far larger. */
    const long double tolerance = 16.0L * epsilon() * fabsl(start) * time;
    assert_true(y > -pi && y <= pi);
    assert_true(sign * (turns - 7) > 80);
    check_long(y + 2.0L * pi * (long double)(turns - 7), 2.0L * phi, tolerance);
    check_long(v, start * sqrtl(1.0L - k * k * sinl(phi) * sinl(phi)), tolerance);
  }
}

static void test_linear_response(void **state)
{
  static const double sets[][2] = { { 0.06, 0.9 }, { 0.5, 1.0 }, { 1.0, 0.4 }, { 2.5, 3.0 } };
  (void)state;
  for (size_t i = 0; i < COUNT(sets); i++) {
    for (double force = 1e-6; force > 1e-12; force *= 1e-3) {
      const pendres_pendulum p = make(sets[i][0], force, sets[i][1]);
      const long double w = p.drive_frequency, stiffness = 1.0L - w * w;
      const long double friction = p.damping * w, response = hypotl(stiffness, friction);
      const long double lag = atan2l(friction, stiffness), size = force / response;
      reference_cycle c;
      check_ok(reference_orbit(&p, 0.0L, 0.0L, 1, 0, &c));
      /* sin y = y - y^3/6 softens the spring by size^2/8, which shifts the response by at
         most that over |response| relative; and rounding, which a weak response lets add up. */
      const long double slack =
          size * size / response + 40.0L * epsilon() * fmaxl(1.0L, 1.0L / response);
      check_long(c.y, size * cosl(lag), slack * size);
      check_long(c.v, size * w * sinl(lag), slack * size);
      check_long(c.amplitude, size, slack * size);
      check_long(c.first_harmonic_amplitude, size, slack * size);
      check_long(c.phase_lag, lag, slack);
      const long double area = pi * force * size * sinl(lag);
      check_long(c.loop_area, area, slack * force * size * 2.0L * pi);
      check_long(c.dissipation, area, slack * force * size * 2.0L * pi);
      check_long(c.mean_power, area * w / (2.0L * pi), slack * force * size * w);
      /* d/dw of pi F0^2 friction/response^2. */
      const long double square = response * response;
      const long double slope = pi * (long double)force * force *
                                (p.damping / square - friction * (-4.0L * w * stiffness +
                                 2.0L * p.damping * friction) / (square * square));
      check_long(c.loop_area_slope, slope, 40.0L * slack * pi * force * force / square);
    }
  }
}

/* ---- Conservation laws and derivatives ------------------------------------------------------ */

static void test_liouville(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_states); i++) {
    const golden_state *g = &golden_states[i];
    if (g->periods != 10) continue;
    reference_image m;
    check_ok(reference_map(&g->pendulum, g->y, g->v, 3, &m));
    const long double want =
        expl(-g->pendulum.damping * 6.0L * pi / g->pendulum.drive_frequency);
    const long double a = m.monodromy[0][0] * m.monodromy[1][1];
    const long double b = m.monodromy[0][1] * m.monodromy[1][0];
    /* Each entry is good to some roundings of the largest on the way, which is at least 1 and,
       where the pendulum passes the barrier top, some ten times that of the end. */
    check_long(a - b, want, 200.0L * epsilon() * fmaxl(1.0L, fabsl(a) + fabsl(b)));
  }
}

/* End state of three periods with one of (y, v, frequency, damping, amplitude) moved. */
static void moved_end(int which, long double by, long double end[2])
{
  long double y = 0.7L, v = -0.4L;
  long turns = 0;
  pendres_pendulum p = make(0.125, 0.25, 0.8125);
  if (which == REFERENCE_BY_Y) y += by;
  else if (which == REFERENCE_BY_V) v += by;
  else if (which == REFERENCE_BY_FREQUENCY) p.drive_frequency += (double)by;
  else if (which == REFERENCE_BY_DAMPING) p.damping += (double)by;
  else p.drive_amplitude += (double)by;
  check_ok(reference_advance(&p, &y, &v, &turns, 3));
  end[0] = y + 2.0L * pi * (long double)turns;
  end[1] = v;
}

static void test_derivatives(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.125, 0.25, 0.8125);
  reference_image m;
  check_ok(reference_map(&p, 0.7L, -0.4L, 3, &m));
  for (int which = 0; which < REFERENCE_COLUMNS; which++) {
    /* A power of two: parameters that are doubles move by exactly this. */
    const long double h = 0x1p-11L, weight[3] = { 45.0L, -9.0L, 1.0L };
    long double difference[2] = { 0.0L, 0.0L }, want[2];
    for (int i = 1; i <= 3; i++) {
      long double more[2], less[2];
      moved_end(which, h * i, more);
      moved_end(which, -h * i, less);
      for (int j = 0; j < 2; j++)
        difference[j] += weight[i - 1] * (more[j] - less[j]) / (60.0L * h);
    }
    for (int j = 0; j < 2; j++)
      want[j] = which < 2 ? m.monodromy[j][which]
                : which == REFERENCE_BY_FREQUENCY ? m.by_frequency[j]
                : which == REFERENCE_BY_DAMPING ? m.by_damping[j] : m.by_amplitude[j];
    /* h^6/140 = 1e-22 times a seventh derivative, at most about the seventh power of the phase
       23 that a change of frequency acts on, 3e9; rounding eps/h. */
    const long double tolerance = 1e-12L + 100.0L * epsilon() / h;
    check_long(difference[0], want[0], tolerance);
    check_long(difference[1], want[1], tolerance);
  }
}

/* End of one period with given order and number of steps. */
static long double fixed_end(int order, int steps)
{
  const reference_model model = { .damping = 0.125L, .drive_amplitude = 0.25L,
                                          .drive_frequency = 0.8125L, .sine = 1, .turns = 1 };
  reference_run run;
  reference_taylor_init(&run, &model, 0.7L, -0.4L);
  if (order > 0) run.order = order;
  run.steps = steps;
  check_ok(reference_taylor_advance(&run, 1));
  return run.y.hi;
}

static void test_order(void **state)
{
  (void)state;
  const long double exact = fixed_end(0, 0);
  for (int order = 4; order <= 12; order += 4) {
    const long double coarse = fixed_end(order, 64) - exact, fine = fixed_end(order, 128) - exact;
    /* Errors are h^order (1 + O(h)), h = 2 pi/(128 0.8) = 0.06; under valgrind the
       highest order is below rounding already. */
    if (fabsl(fine) < 1e4L * epsilon()) continue;
    check_long(log2l(fabsl(coarse / fine)), (long double)order, 0.3L);
  }
  /* Far more steps than needed, and no choice of steps: the same to rounding. */
  check_long(fixed_end(REFERENCE_ORDER, 100), exact, 20.0L * epsilon());
  check_long(fixed_end(REFERENCE_ORDER * 2 / 3, 150), exact, 20.0L * epsilon());
  /* Sums in two words do not mind many steps; in one, 200000 roundings of up to half a unit
     make a run of some tens (22 when it was tried). */
  check_long(fixed_end(REFERENCE_ORDER / 2, 200000), exact, 4.0L * epsilon());
}

static void test_mirror(void **state)
{
  (void)state;
  /* Turned drive, turned state: the same operations with other signs. */
  const pendres_pendulum p = make(0.12, 0.2, 0.8), turned = make(0.12, -0.2, 0.8);
  long double y = 1.1L, v = 0.9L, turned_y = -1.1L, turned_v = -0.9L;
  long turns = 0, turned_turns = 0;
  check_ok(reference_advance(&p, &y, &v, &turns, 20));
  check_ok(reference_advance(&turned, &turned_y, &turned_v, &turned_turns, 20));
  check_long(turned_y, -y, 0.0L);
  check_long(turned_v, -v, 0.0L);
  assert_int_equal(turned_turns, -turns);
  /* An orbit of mirror symmetry is at minus its start half a period later, where the mirror
     image of the equation takes over. */
  const reference_cycle *c = &golden_orbits[7];
  const reference_model model = { .damping = c->damping,
                                          .drive_amplitude = c->drive_amplitude,
                                          .drive_frequency = c->drive_frequency,
                                          .sine = 1, .turns = 1 };
  reference_run run;
  reference_taylor_init(&run, &model, c->y, c->v);
  check_ok(reference_taylor_advance_half(&run));
  check_long(run.y.hi, -c->y, 20.0L * golden_epsilon());
  check_long(run.v.hi, -c->v, 20.0L * golden_epsilon());
}

static void test_wrap(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.12, 0.2, 0.8);
  long double y = 1.0L, v = 0.5L, far_y = 1.0L + 2.0L * pi * 1000.0L, far_v = 0.5L;
  long turns = 0, far_turns = 0;
  check_ok(reference_advance(&p, &y, &v, &turns, 0));
  check_long(y, 1.0L, 0.0L);
  check_ok(reference_advance(&p, &y, &v, &turns, 3));
  check_ok(reference_advance(&p, &far_y, &far_v, &far_turns, 3));
  assert_int_equal(far_turns - turns, 1000);
  /* The far start is known to half a unit of its last place, times a growth of about 1. */
  check_long(far_y, y, 4.0L * 8192.0L * epsilon());
  check_long(far_v, v, 4.0L * 8192.0L * epsilon());
}

/* ---- Golden numbers, bad arguments ---------------------------------------------------------- */

static void test_golden_states(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_states); i++) {
    const golden_state *g = &golden_states[i];
    long double y = g->y, v = g->v;
    long turns = 0;
    check_ok(reference_advance(&g->pendulum, &y, &v, &turns, g->periods));
    /* Roundings of some 50 steps a period, amplified at most as the start is. */
    const long double unit = golden_epsilon() * fmaxl(1.0L, g->growth) *
                             (1.0L + 0.1L * (long double)g->periods);
    assert_int_equal(turns, g->turns);
    check_long(y, g->end_y, 20.0L * unit);
    check_long(v, g->end_v, 20.0L * unit);
  }
}

static void test_arguments(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.12, 0.2, 0.8), bad = make(-0.1, 0.2, 0.8);
  long double y = 1.0L, v = 2.0L;
  long turns = 5;
  reference_image image = { .y = 42.0L };
  reference_cycle c = { .y = 42.0L };
  const pendres_status invalid = PENDRES_INVALID_ARGUMENT;
  assert_int_equal(reference_advance(&bad, &y, &v, &turns, 1), invalid);
  assert_int_equal(reference_advance(NULL, &y, &v, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, NULL, &v, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, &y, NULL, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, &y, &v, &turns, -1), invalid);
  long double nan = (long double)NAN, far = 1e10L, fast = 1e300L;
  assert_int_equal(reference_advance(&p, &nan, &v, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, &far, &v, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, &y, &nan, &turns, 1), invalid);
  assert_int_equal(reference_advance(&p, &y, &fast, &turns, 1),
                   PENDRES_INTEGRATION_FAILED);
  check_long(y, 1.0L, 0.0L);
  check_long(v, 2.0L, 0.0L);
  check_long(far, 1e10L, 0.0L);
  assert_int_equal(turns, 5);
  assert_int_equal(reference_map(&p, 1.0L, 0.0L, 1, NULL), invalid);
  assert_int_equal(reference_map(&bad, 1.0L, 0.0L, 1, &image), invalid);
  assert_int_equal(reference_orbit(&p, 1.0L, 0.0L, 0, 0, &c), invalid);
  assert_int_equal(reference_orbit(&bad, 1.0L, 0.0L, 1, 0, &c), invalid);
  assert_int_equal(reference_orbit(&p, 1.0L, nan, 1, 0, &c), invalid);
  assert_int_equal(reference_find(REFERENCE_RESONANCE, &p,
                                          &(reference_guess){-1.0L, 1.0L, 0.0L, 0.0L},
                                          &c), invalid);
  assert_int_equal(reference_find(REFERENCE_RESONANCE, NULL,
                                          &(reference_guess){1.0L, 1.0L, 0.0L, 0.0L},
                                          &c), invalid);
  assert_int_equal(reference_find(REFERENCE_FOLD, &p,
                                          &(reference_guess){nan, 1.0L, 0.0L, 0.0L},
                                          &c), invalid);
  assert_int_equal(reference_find(REFERENCE_SYMMETRY_BREAKING, &p,
                                          &(reference_guess){0.0L, 1.0L, 0.0L, 0.0L},
                                          &c), invalid);
  assert_int_equal(reference_find(REFERENCE_CUSP, &p,
                                          &(reference_guess){1.0L, 1.0L, 0.0L, -0.1L},
                                          &c), invalid);
  /* Nothing closes with a turn a period at so weak a drive; no branch, no fold. */
  assert_int_equal(reference_orbit(&p, 0.5L, 0.1L, 1, 1, &c), PENDRES_NOT_CONVERGED);
  /* Every state of a free undamped pendulum at rest in time: M - I is singular. */
  const pendres_pendulum still = make(0.0, 0.0, 1.0);
  assert_int_equal(reference_find(REFERENCE_FOLD, &still,
                                          &(reference_guess){1.0L, 0.5L, 0.0L, 0.0L},
                                          &c), PENDRES_NOT_CONVERGED);
  check_long(image.y, 42.0L, 0.0L);
  check_long(c.y, 42.0L, 0.0L);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_free_oscillation),
    cmocka_unit_test(test_long_energy),
    cmocka_unit_test(test_free_rotation),
    cmocka_unit_test(test_linear_response),
    cmocka_unit_test(test_liouville),
    cmocka_unit_test(test_derivatives),
    cmocka_unit_test(test_order),
    cmocka_unit_test(test_mirror),
    cmocka_unit_test(test_wrap),
    cmocka_unit_test(test_golden_states),
    cmocka_unit_test(test_arguments),
  };
  return cmocka_run_group_tests_name("reference", tests, NULL, NULL);
}
