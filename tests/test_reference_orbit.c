/*
 * test_reference_orbit.c -- orbits, resonances, folds and cusps of the reference.
 */
#include "reference_fixture.h"

/* ---- Orbits --------------------------------------------------------------------------------- */

/* How much an orbit's point moves when the map is off by one unit. */
static long double sensitivity(const reference_cycle *c)
{
  const long double away = hypotl(c->multiplier_re[0] - 1.0L, c->multiplier_im[0]) *
                           hypotl(c->multiplier_re[1] - 1.0L, c->multiplier_im[1]);
  long double largest = 1.0L;
  for (int i = 0; i < 4; i++) largest = fmaxl(largest, fabsl(c->monodromy[i / 2][i % 2]));
  return largest / away;
}

static void check_cycle(const reference_cycle *got, const reference_cycle *want,
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
    const reference_cycle *want = &golden_orbits[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude,
                                    (double)want->drive_frequency);
    reference_cycle c;
    check_ok(reference_orbit(&p, want->y + 1e-4L, want->v - 1e-4L, want->period,
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
  reference_cycle c[2];
  (void)state;
  for (int i = 0; i < 2; i++) {
    long double y = i == 0 ? 0.3L : -2.3L, v = 0.0L;
    check_ok(reference_advance(&p, &y, &v, NULL, 60));
    check_ok(reference_orbit(&p, y, v, 1, 0, &c[i]));
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
    const reference_cycle *c = &golden_orbits[which];
    long double area = 0.0L, y = 0.0L, v = 0.0L;
    for (int i = 1; i <= 3; i++) {
      for (int sign = -1; sign <= 1; sign += 2) {
        const pendres_pendulum p = make((double)c->damping, (double)c->drive_amplitude,
                                        (double)c->drive_frequency + sign * i * h);
        reference_cycle beside;
        check_ok(reference_orbit(&p, c->y, c->v, 1, 0, &beside));
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
  const reference_model model = { .drive_frequency = 0.3L, .sine = 1, .turns = 1 };
  reference_run run;
  reference_taylor_init(&run, &model, 0.4L, 1.2L);
  run.measures = 1;
  check_ok(reference_taylor_advance(&run, 1));
  /* The turning points of the free pendulum of this energy. */
  const long double s = sinl(0.2L);
  const long double turning = 2.0L * asinl(sqrtl(0.36L + s * s));
  check_long(run.highest, turning, 10.0L * epsilon());
  check_long(run.lowest, -turning, 10.0L * epsilon());
}

/* ---- Resonances, folds, cusps --------------------------------------------------------------- */

static void test_resonances(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_resonances); i++) {
    const reference_cycle *want = &golden_resonances[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    reference_cycle c;
    check_ok(reference_find(REFERENCE_RESONANCE, &p,
                                    &(reference_guess){want->drive_frequency + 2e-4L,
                                                               want->y, want->v, 0.0L},
                                    &c));
    const long double unit = golden_epsilon() * sensitivity(want);
    /* The zero of a slope is as good as the slope over its own slope, of order 1 to 100. */
    check_cycle(&c, want, 200.0L * unit * sensitivity(want));
    check_long(c.loop_area_slope, 0.0L, 1e3L * unit * sensitivity(want));
    /* It is a maximum. */
    for (int sign = -1; sign <= 1; sign += 2) {
      const pendres_pendulum beside = make(p.damping, p.drive_amplitude,
                                           (double)c.drive_frequency + sign * 1e-4);
      reference_cycle lower;
      check_ok(reference_orbit(&beside, c.y, c.v, 1, 0, &lower));
      assert_true(lower.loop_area < c.loop_area);
    }
  }
}

/* The two orbits at a distance from a fold; nonzero if there are two next to it. */
static int twins(const reference_cycle *fold, long double distance,
                 reference_cycle twin[2])
{
  const long double across = hypotl(fold->monodromy[0][1], fold->monodromy[0][0] - 1.0L);
  const pendres_pendulum p = make((double)fold->damping, (double)fold->drive_amplitude,
                                  (double)(fold->drive_frequency + distance));
  for (int i = 0; i < 2; i++) {
    const long double far = (i == 0 ? 0.02L : -0.02L) / across;
    if (reference_orbit(&p, fold->y - far * fold->monodromy[0][1],
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
    const reference_cycle *want = &golden_folds[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    reference_cycle c, near[2], far[2];
    check_ok(reference_find(REFERENCE_FOLD, &p,
                                    &(reference_guess){want->drive_frequency + 1e-6L,
                                                               want->y + 1e-4L, want->v - 1e-4L,
                                                               0.0L},
                                    &c));
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
    const reference_cycle *c = &golden_folds[i];
    if ((double)c->damping != 0.13) continue;
    if (c->phase_lag < pi / 3.0L) check_long(c->drive_frequency, 0.8475L, 0.0035L);
    else check_long(c->drive_frequency, 0.745L, 0.01L);
  }
}

static void test_symmetry_breakings(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_symmetry_breakings); i++) {
    const reference_cycle *want = &golden_symmetry_breakings[i];
    const pendres_pendulum p = make((double)want->damping, (double)want->drive_amplitude, 1.0);
    reference_cycle c;
    check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, &p,
                                    &(reference_guess){want->drive_frequency + 1e-4L,
                                                               want->y, want->v, 0.0L},
                                    &c));
    /* Conditioning as for folds. */
    check_cycle(&c, want, 20.0L * 1e3L * golden_epsilon());
    /* The symmetric orbit exists on both sides and loses stability below. */
    for (int sign = -1; sign <= 1; sign += 2) {
      const pendres_pendulum beside = make(p.damping, p.drive_amplitude,
                                           (double)c.drive_frequency + sign * 1e-4);
      reference_cycle orbit;
      check_ok(reference_orbit(&beside, c.y, c.v, 1, 0, &orbit));
      assert_true(sign * (1.0L - orbit.multiplier_re[0]) > 1e-3L);
    }
  }
}

static void test_cusps(void **state)
{
  (void)state;
  for (size_t i = 0; i < COUNT(golden_cusps); i++) {
    const reference_cycle *want = &golden_cusps[i];
    const pendres_pendulum p = make(1.0, (double)want->drive_amplitude, 1.0);
    reference_cycle c;
    check_ok(reference_find(REFERENCE_CUSP, &p,
                                    &(reference_guess){want->drive_frequency - 1e-4L,
                                                               want->y, want->v,
                                                               want->damping + 1e-4L},
                                    &c));
    /* Third derivatives by differences: 1e-15, or rounding over a step of 2e-3, times the
       conditioning 1e3 of a cusp. */
    check_cycle(&c, want, 1e-14L + 1e6L * golden_epsilon());
    check_long(c.multiplier_re[0], 1.0L, 1e-14L + 1e6L * golden_epsilon());
    check_near((double)c.damping, i == 0 ? 0.099 : 0.164, 0.0005); /* as read off */
  }
  /* A fold just below the cusp, none above: the folds have met. */
  const reference_cycle *cusp = &golden_cusps[1];
  const pendres_pendulum below = make((double)cusp->damping - 1e-4, 0.2, 1.0);
  reference_cycle fold;
  check_ok(reference_find(REFERENCE_FOLD, &below,
                                  &(reference_guess){cusp->drive_frequency, cusp->y + 0.03L,
                                                             cusp->v + 0.03L, 0.0L},
                                  &fold));
  check_long(fold.multiplier_re[0], 1.0L, 1e-10L);
  check_long(fold.drive_frequency, cusp->drive_frequency, 1e-3L);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_orbit_measures),
    cmocka_unit_test(test_coexistence),
    cmocka_unit_test(test_slopes),
    cmocka_unit_test(test_extremes),
    cmocka_unit_test(test_resonances),
    cmocka_unit_test(test_folds),
    cmocka_unit_test(test_fold_places),
    cmocka_unit_test(test_symmetry_breakings),
    cmocka_unit_test(test_cusps),
  };
  return cmocka_run_group_tests_name("reference_orbit", tests, NULL, NULL);
}
