/*
 * test_reference.c -- the long double reference against closed forms, conservation laws,
 * differences of itself, and the numbers of golden.h.
 *
 * All tolerances are multiples of the rounding error of long double as it is when the test
 * runs: valgrind computes with 53 bits where the machine has 64.
 */
#include "check.h"

#include <float.h>
#include <string.h>

#include <pendres/reference.h>

#include "golden.h"
#include "reference/reference_taylor.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const long double pi = 3.14159265358979323846264338327950288L;

/* |got - want| <= tolerance in long double, both finite. */
#define check_long(got, want, tolerance) \
  check_long_at((got), (want), (tolerance), #got, __FILE__, __LINE__)

static void check_long_at(long double got, long double want, long double tolerance,
                          const char *what, const char *file, int line)
{
  if (fabsl(got - want) <= tolerance) return;
  print_error("%s:%d: %s = %.21Lg, wanted %.21Lg +- %.3Lg (off by %.3Lg)\n", file, line, what,
              got, want, tolerance, got - want);
  fail();
}

/* Distance from 1 to the next number, as arithmetic really does it. */
static long double epsilon(void)
{
  volatile long double step = 1.0L, sum;
  do {
    step = step * 0.5L;
    sum = 1.0L + step;
  } while (sum > 1.0L);
  return 2.0L * step;
}

/* The same, but not below that of golden.h, which was made with 64 bits. */
static long double golden_epsilon(void)
{
  return fmaxl(epsilon(), 0x1p-63L);
}

static pendres_pendulum make(double damping, double drive_amplitude, double drive_frequency)
{
  return (pendres_pendulum){ damping, drive_amplitude, drive_frequency, 0.0 };
}

static long double growth(const pendres_reference_image *image)
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
      pendres_reference_image image;
      check_ok(pendres_reference_map(&p, amplitudes[i], 0.0L, periods, &image));
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
  check_ok(pendres_reference_advance(&p, &y, &v, NULL, 1000));
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
    check_ok(pendres_reference_advance(&p, &y, &v, &turns, 30));
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
      pendres_reference_cycle c;
      check_ok(pendres_reference_orbit(&p, 0.0L, 0.0L, 1, 0, &c));
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
    pendres_reference_image m;
    check_ok(pendres_reference_map(&g->pendulum, g->y, g->v, 3, &m));
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
  if (which == PENDRES_REFERENCE_BY_Y) y += by;
  else if (which == PENDRES_REFERENCE_BY_V) v += by;
  else if (which == PENDRES_REFERENCE_BY_FREQUENCY) p.drive_frequency += (double)by;
  else if (which == PENDRES_REFERENCE_BY_DAMPING) p.damping += (double)by;
  else p.drive_amplitude += (double)by;
  check_ok(pendres_reference_advance(&p, &y, &v, &turns, 3));
  end[0] = y + 2.0L * pi * (long double)turns;
  end[1] = v;
}

static void test_derivatives(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.125, 0.25, 0.8125);
  pendres_reference_image m;
  check_ok(pendres_reference_map(&p, 0.7L, -0.4L, 3, &m));
  for (int which = 0; which < PENDRES_REFERENCE_COLUMNS; which++) {
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
                : which == PENDRES_REFERENCE_BY_FREQUENCY ? m.by_frequency[j]
                : which == PENDRES_REFERENCE_BY_DAMPING ? m.by_damping[j] : m.by_amplitude[j];
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
  const pendres_reference_model model = { 0.125L, 0.25L, 0.8125L };
  pendres_reference_walk walk;
  pendres_reference_taylor_init(&walk, &model, 0.7L, -0.4L);
  if (order > 0) walk.order = order;
  walk.steps = steps;
  check_ok(pendres_reference_taylor_advance(&walk, 1));
  return walk.y.hi;
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
  check_long(fixed_end(PENDRES_REFERENCE_ORDER, 100), exact, 20.0L * epsilon());
  check_long(fixed_end(PENDRES_REFERENCE_ORDER * 2 / 3, 150), exact, 20.0L * epsilon());
  /* Sums in two words do not mind many steps; in one, 200000 roundings of up to half a unit
     make a walk of some tens (22 when it was tried). */
  check_long(fixed_end(PENDRES_REFERENCE_ORDER / 2, 200000), exact, 4.0L * epsilon());
}

static void test_mirror(void **state)
{
  (void)state;
  /* Turned drive, turned state: the same operations with other signs. */
  const pendres_pendulum p = make(0.12, 0.2, 0.8), turned = make(0.12, -0.2, 0.8);
  long double y = 1.1L, v = 0.9L, turned_y = -1.1L, turned_v = -0.9L;
  long turns = 0, turned_turns = 0;
  check_ok(pendres_reference_advance(&p, &y, &v, &turns, 20));
  check_ok(pendres_reference_advance(&turned, &turned_y, &turned_v, &turned_turns, 20));
  check_long(turned_y, -y, 0.0L);
  check_long(turned_v, -v, 0.0L);
  assert_int_equal(turned_turns, -turns);
  /* An orbit of mirror symmetry is at minus its start half a period later, where the mirror
     image of the equation takes over. */
  const pendres_reference_cycle *c = &golden_orbits[7];
  const pendres_reference_model model = { c->damping, c->drive_amplitude, c->drive_frequency };
  pendres_reference_walk walk;
  pendres_reference_taylor_init(&walk, &model, c->y, c->v);
  check_ok(pendres_reference_taylor_advance_half(&walk));
  check_long(walk.y.hi, -c->y, 20.0L * golden_epsilon());
  check_long(walk.v.hi, -c->v, 20.0L * golden_epsilon());
}

static void test_wrap(void **state)
{
  (void)state;
  const pendres_pendulum p = make(0.12, 0.2, 0.8);
  long double y = 1.0L, v = 0.5L, far_y = 1.0L + 2.0L * pi * 1000.0L, far_v = 0.5L;
  long turns = 0, far_turns = 0;
  check_ok(pendres_reference_advance(&p, &y, &v, &turns, 0));
  check_long(y, 1.0L, 0.0L);
  check_ok(pendres_reference_advance(&p, &y, &v, &turns, 3));
  check_ok(pendres_reference_advance(&p, &far_y, &far_v, &far_turns, 3));
  assert_int_equal(far_turns - turns, 1000);
  /* The far start is known to half a unit of its last place, times a growth of about 1. */
  check_long(far_y, y, 4.0L * 8192.0L * epsilon());
  check_long(far_v, v, 4.0L * 8192.0L * epsilon());
}

/* ---- Orbits --------------------------------------------------------------------------------- */

/* How much an orbit's point moves when the map is off by one unit. */
static long double sensitivity(const pendres_reference_cycle *c)
{
  const long double away = hypotl(c->multiplier_re[0] - 1.0L, c->multiplier_im[0]) *
                           hypotl(c->multiplier_re[1] - 1.0L, c->multiplier_im[1]);
  long double largest = 1.0L;
  for (int i = 0; i < 4; i++) largest = fmaxl(largest, fabsl(c->monodromy[i / 2][i % 2]));
  return largest / away;
}

static void check_cycle(const pendres_reference_cycle *got, const pendres_reference_cycle *want,
                        long double tolerance)
{
  check_long(got->drive_frequency, want->drive_frequency, tolerance);
  check_long(got->damping, want->damping, tolerance);
  check_long(got->y, want->y, tolerance);
  check_long(got->v, want->v, tolerance);
  check_long(got->loop_area, want->loop_area, 4.0L * tolerance);
  check_long(got->dissipation, want->dissipation, 4.0L * tolerance);
  check_long(got->amplitude, want->amplitude, 2.0L * tolerance);
  check_long(got->first_harmonic_amplitude, want->first_harmonic_amplitude, 2.0L * tolerance);
  check_long(got->phase_lag, want->phase_lag, 10.0L * tolerance);
  check_long(got->mean_power, want->mean_power, 4.0L * tolerance);
  assert_int_equal(got->period, want->period);
  assert_int_equal(got->winding, want->winding);
}

static void test_orbit_measures(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_orbits); i++) {
    const pendres_reference_cycle *want = &golden_orbits[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude,
                                    (double)want->drive_frequency);
    pendres_reference_cycle c;
    check_ok(pendres_reference_orbit(&p, want->y + 1e-4L, want->v - 1e-4L, want->period,
                                     want->winding, &c));
    const long double unit = golden_epsilon() * sensitivity(want) * (long double)want->period;
    check_cycle(&c, want, 20.0L * unit);
    /* The slope follows the orbit's error by a second derivative over 1 - multiplier. */
    check_long(c.loop_area_slope, want->loop_area_slope,
               1e3L * unit * sensitivity(want) * (1.0L + fabsl(want->loop_area_slope)));
    /* Independent integrals: work is what is dissipated, and for one harmonic of the drive
       only the angle's own first harmonic does work. */
    const long double area = pi * fabsl(c.drive_amplitude) * c.first_harmonic_amplitude *
                             sinl(c.phase_lag);
    check_long(c.dissipation, c.loop_area, 30.0L * unit);
    check_long(area, c.loop_area, 30.0L * unit);
    check_long(c.energy_residual, 0.0L, 30.0L * unit);
    check_long(c.closure, 0.0L, 20.0L * unit);
    /* Two numbers with the trace and the determinant of the matrix, or a conjugate pair. */
    const long double trace = c.monodromy[0][0] + c.monodromy[1][1];
    const long double product = c.multiplier_re[0] * c.multiplier_re[1] -
                                c.multiplier_im[0] * c.multiplier_im[1];
    check_long(c.multiplier_re[0] + c.multiplier_re[1], trace, 100.0L * unit);
    check_long(product, expl(-c.damping * 2.0L * pi * (long double)c.period / c.drive_frequency),
               100.0L * unit);
    check_long(c.multiplier_im[0] + c.multiplier_im[1], 0.0L, 0.0L);
    check_long(c.liouville_residual * product, 0.0L, 100.0L * unit);
  }
}

/* SA and LA beside each other, as the issue of coexistence states them. */
static void test_coexistence(void **state)
{
  const pendres_pendulum p = make(0.12, 0.2, 0.78539816339744828);
  pendres_reference_cycle c[2];
  (void)state;
  for (int i = 0; i < 2; i++) {
    long double y = i == 0 ? 0.3L : -2.3L, v = 0.0L;
    check_ok(pendres_reference_advance(&p, &y, &v, NULL, 60));
    check_ok(pendres_reference_orbit(&p, y, v, 1, 0, &c[i]));
    assert_true(hypotl(c[i].multiplier_re[0], c[i].multiplier_im[0]) < 1.0L);
  }
  assert_true(c[0].phase_lag < pi / 3.0L && c[1].phase_lag > pi / 2.0L);
  assert_true(c[0].amplitude < 0.6L && c[1].amplitude > 1.9L);
}

static void test_slopes(void **state)
{
  (void)state;
  const double h = 0x1p-11;
  const long double weight[3] = { 45.0L, -9.0L, 1.0L };
  for (int which = 6; which < 8; which++) {
    const pendres_reference_cycle *c = &golden_orbits[which];
    long double area = 0.0L, y = 0.0L, v = 0.0L;
    for (int i = 1; i <= 3; i++) {
      for (int sign = -1; sign <= 1; sign += 2) {
        const pendres_pendulum p = make((double)c->damping, (double)c->drive_amplitude,
                                        (double)c->drive_frequency + sign * i * h);
        pendres_reference_cycle beside;
        check_ok(pendres_reference_orbit(&p, c->y, c->v, 1, 0, &beside));
        const long double factor = sign * weight[i - 1] / (60.0L * (long double)h);
        area += factor * beside.loop_area;
        y += factor * beside.y;
        v += factor * beside.v;
      }
    }
    /* h^6/140 = 1e-22 times a seventh derivative: the fold at a distance of 0.06 makes
       it up to 5000 (1/0.06)^7 ~ 1e12; rounding eps/h. */
    const long double tolerance = 1e-9L + 100.0L * epsilon() / (long double)h;
    check_long(area, c->loop_area_slope, tolerance);
    check_long(y, c->state_slope[0], tolerance);
    check_long(v, c->state_slope[1], tolerance);
  }
}

/* Extremes and harmonics where they are known in closed form. */
static void test_extremes(void **state)
{
  (void)state;
  const pendres_reference_model model = { 0.0L, 0.0L, 0.3L };
  pendres_reference_walk walk;
  pendres_reference_taylor_init(&walk, &model, 0.4L, 1.2L);
  walk.measures = 1;
  check_ok(pendres_reference_taylor_advance(&walk, 1));
  /* The turning points of the free pendulum of this energy. */
  const long double s = sinl(0.2L);
  const long double turning = 2.0L * asinl(sqrtl(0.36L + s * s));
  check_long(walk.highest, turning, 10.0L * epsilon());
  check_long(walk.lowest, -turning, 10.0L * epsilon());
}

/* ---- Resonances, folds, cusps --------------------------------------------------------------- */

static void test_resonances(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_resonances); i++) {
    const pendres_reference_cycle *want = &golden_resonances[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    pendres_reference_cycle c;
    check_ok(pendres_reference_resonance(&p, want->drive_frequency + 2e-4L, want->y, want->v, &c));
    const long double unit = golden_epsilon() * sensitivity(want);
    /* The zero of a slope is as good as the slope over its own slope, of order 1 to 100. */
    check_cycle(&c, want, 200.0L * unit * sensitivity(want));
    check_long(c.loop_area_slope, 0.0L, 1e3L * unit * sensitivity(want));
    /* It is a maximum. */
    for (int sign = -1; sign <= 1; sign += 2) {
      const pendres_pendulum beside = make(p.damping, p.drive_amplitude,
                                           (double)c.drive_frequency + sign * 1e-4);
      pendres_reference_cycle lower;
      check_ok(pendres_reference_orbit(&beside, c.y, c.v, 1, 0, &lower));
      assert_true(lower.loop_area < c.loop_area);
    }
  }
}

/* The two orbits at a distance from a fold; nonzero if there are two next to it. */
static int twins(const pendres_reference_cycle *fold, long double distance,
                 pendres_reference_cycle twin[2])
{
  const long double across = hypotl(fold->monodromy[0][1], fold->monodromy[0][0] - 1.0L);
  const pendres_pendulum p = make((double)fold->damping, (double)fold->drive_amplitude,
                                  (double)(fold->drive_frequency + distance));
  for (int i = 0; i < 2; i++) {
    const long double far = (i == 0 ? 0.02L : -0.02L) / across;
    if (pendres_reference_orbit(&p, fold->y - far * fold->monodromy[0][1],
                                fold->v + far * (fold->monodromy[0][0] - 1.0L), 1, 0, &twin[i]))
      return 0;
    if (hypotl(twin[i].y - fold->y, twin[i].v - fold->v) > 0.1L) return 0;
  }
  return 1;
}

static void test_folds(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_folds); i++) {
    const pendres_reference_cycle *want = &golden_folds[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    pendres_reference_cycle c, near[2], far[2];
    check_ok(pendres_reference_fold(&p, want->drive_frequency + 1e-6L, want->y + 1e-4L,
                                    want->v - 1e-4L, &c));
    /* The system is regular; its conditioning is that of the fold's curvature, up to 1e3. */
    const long double unit = golden_epsilon() * 1e3L;
    check_cycle(&c, want, 20.0L * unit);
    check_long(c.multiplier_re[0], 1.0L, 20.0L * unit);
    /* A fold: on one side two orbits, one stable, apart as the square root of the distance;
       on the other none. */
    const int below = twins(&c, -1e-6L, near);
    const long double side = below ? -1.0L : 1.0L;
    assert_true(below != twins(&c, 1e-6L, below ? far : near));
    assert_true(twins(&c, side * 4e-6L, far));
    const long double apart = hypotl(near[0].y - near[1].y, near[0].v - near[1].v);
    assert_true(apart > 1e-4L);
    assert_true((near[0].multiplier_re[0] < 1.0L) != (near[1].multiplier_re[0] < 1.0L));
    /* Corrections are of relative order distance/(curvature). */
    check_long(hypotl(far[0].y - far[1].y, far[0].v - far[1].v) / apart, 2.0L, 0.02L);
  }
}

/* Where the two branches of coexistence end, as read off a phase diagram. */
static void test_fold_places(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_folds); i++) {
    const pendres_reference_cycle *c = &golden_folds[i];
    if ((double)c->damping != 0.13) continue;
    if (c->phase_lag < pi / 3.0L) check_long(c->drive_frequency, 0.8475L, 0.0035L);
    else check_long(c->drive_frequency, 0.745L, 0.01L);
  }
}

static void test_symmetry_breakings(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_symmetry_breakings); i++) {
    const pendres_reference_cycle *want = &golden_symmetry_breakings[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    pendres_reference_cycle c;
    check_ok(pendres_reference_symmetry_breaking(&p, want->drive_frequency + 1e-4L, want->y,
                                                 want->v, &c));
    /* Conditioning as for folds. */
    check_cycle(&c, want, 20.0L * 1e3L * golden_epsilon());
    /* The symmetric orbit exists on both sides and loses stability below. */
    for (int sign = -1; sign <= 1; sign += 2) {
      const pendres_pendulum beside = make(p.damping, p.drive_amplitude,
                                           (double)c.drive_frequency + sign * 1e-4);
      pendres_reference_cycle orbit;
      check_ok(pendres_reference_orbit(&beside, c.y, c.v, 1, 0, &orbit));
      assert_true(sign * (1.0L - orbit.multiplier_re[0]) > 1e-3L);
    }
  }
}

static void test_cusps(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_cusps); i++) {
    const pendres_reference_cycle *want = &golden_cusps[i];
    const pendres_pendulum p = make(1.0, (double)want->drive_amplitude, 1.0);
    pendres_reference_cycle c;
    check_ok(pendres_reference_cusp(&p, want->drive_frequency - 1e-4L, want->damping + 1e-4L,
                                    want->y, want->v, &c));
    /* Third derivatives by differences: 1e-15, or rounding over a step of 2e-3, times the
       conditioning 1e3 of a cusp. */
    check_cycle(&c, want, 1e-14L + 1e6L * golden_epsilon());
    check_long(c.multiplier_re[0], 1.0L, 1e-14L + 1e6L * golden_epsilon());
    check_near((double)c.damping, i == 0 ? 0.099 : 0.164, 0.0005); /* as read off */
  }
  /* A fold just below the cusp, none above: the folds have met. */
  const pendres_reference_cycle *cusp = &golden_cusps[1];
  const pendres_pendulum below = make((double)cusp->damping - 1e-4, 0.2, 1.0);
  pendres_reference_cycle fold;
  check_ok(pendres_reference_fold(&below, cusp->drive_frequency, cusp->y + 0.03L,
                                  cusp->v + 0.03L, &fold));
  check_long(fold.multiplier_re[0], 1.0L, 1e-10L);
  check_long(fold.drive_frequency, cusp->drive_frequency, 1e-3L);
}

/* ---- Golden numbers, bad arguments ---------------------------------------------------------- */

static void test_golden_states(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_states); i++) {
    const golden_state *g = &golden_states[i];
    long double y = g->y, v = g->v;
    long turns = 0;
    check_ok(pendres_reference_advance(&g->pendulum, &y, &v, &turns, g->periods));
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
  pendres_reference_image image = { .y = 42.0L };
  pendres_reference_cycle c = { .y = 42.0L };
  const pendres_status invalid = PENDRES_INVALID_ARGUMENT;
  assert_int_equal(pendres_reference_advance(&bad, &y, &v, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(NULL, &y, &v, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, NULL, &v, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, &y, NULL, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, &y, &v, &turns, -1), invalid);
  long double nan = (long double)NAN, far = 1e10L, fast = 1e300L;
  assert_int_equal(pendres_reference_advance(&p, &nan, &v, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, &far, &v, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, &y, &nan, &turns, 1), invalid);
  assert_int_equal(pendres_reference_advance(&p, &y, &fast, &turns, 1),
                   PENDRES_INTEGRATION_FAILED);
  check_long(y, 1.0L, 0.0L);
  check_long(v, 2.0L, 0.0L);
  check_long(far, 1e10L, 0.0L);
  assert_int_equal(turns, 5);
  assert_int_equal(pendres_reference_map(&p, 1.0L, 0.0L, 1, NULL), invalid);
  assert_int_equal(pendres_reference_map(&bad, 1.0L, 0.0L, 1, &image), invalid);
  assert_int_equal(pendres_reference_orbit(&p, 1.0L, 0.0L, 0, 0, &c), invalid);
  assert_int_equal(pendres_reference_orbit(&bad, 1.0L, 0.0L, 1, 0, &c), invalid);
  assert_int_equal(pendres_reference_orbit(&p, 1.0L, nan, 1, 0, &c), invalid);
  assert_int_equal(pendres_reference_resonance(&p, -1.0L, 1.0L, 0.0L, &c), invalid);
  assert_int_equal(pendres_reference_resonance(NULL, 1.0L, 1.0L, 0.0L, &c), invalid);
  assert_int_equal(pendres_reference_fold(&p, nan, 1.0L, 0.0L, &c), invalid);
  assert_int_equal(pendres_reference_symmetry_breaking(&p, 0.0L, 1.0L, 0.0L, &c), invalid);
  assert_int_equal(pendres_reference_cusp(&p, 1.0L, -0.1L, 1.0L, 0.0L, &c), invalid);
  /* Nothing closes with a turn a period at so weak a drive; no branch, no fold. */
  assert_int_equal(pendres_reference_orbit(&p, 0.5L, 0.1L, 1, 1, &c), PENDRES_NOT_CONVERGED);
  /* Every state of a free undamped pendulum at rest in time: M - I is singular. */
  const pendres_pendulum still = make(0.0, 0.0, 1.0);
  assert_int_equal(pendres_reference_fold(&still, 1.0L, 0.5L, 0.0L, &c), PENDRES_NOT_CONVERGED);
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
    cmocka_unit_test(test_orbit_measures),
    cmocka_unit_test(test_coexistence),
    cmocka_unit_test(test_slopes),
    cmocka_unit_test(test_extremes),
    cmocka_unit_test(test_resonances),
    cmocka_unit_test(test_folds),
    cmocka_unit_test(test_fold_places),
    cmocka_unit_test(test_symmetry_breakings),
    cmocka_unit_test(test_cusps),
    cmocka_unit_test(test_golden_states),
    cmocka_unit_test(test_arguments),
  };
  return cmocka_run_group_tests_name("reference", tests, NULL, NULL);
}
