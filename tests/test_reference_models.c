/*
 * test_reference_models.c -- the Taylor series of models other than the plain pendulum: against the
 * extrapolated midpoint rule of oracle.h, which shares neither code nor method and is good to some
 * 1e-16, and the balance of energy.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "context_fixture.h"
#include "oracle.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const struct {
  pendres_pendulum p;
  double y, v;
} cases[] = {
  {{.damping = 0.3, .drive_amplitude = 0.6, .drive_frequency = 0.9, .torque = 0.4}, 0.2, 0.1},
  {{.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.1, .torque = 0.9,
    .parametric_amplitude = -0.4}, 0.5, 1.5},
  {{.damping = 0.1, .drive_frequency = 1.9, .parametric_amplitude = 0.7}, 0.3, -0.2},
  {{.damping = 0.2, .drive_amplitude = 0.5, .drive_frequency = 1.2,
    .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}}, 1.3, 0.3},
  {{.damping = 0.1, .drive_amplitude = 0.05, .drive_frequency = 0.8,
    .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, -1.0}}, 0.1, 0.0},
  {{.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.3, .torque = -0.2,
    .parametric_amplitude = 0.3, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {0.7, -0.3, 0.4, 0.2, 0.3}}, 0.6, -0.5},
  {{.damping = 0.3, .drive_amplitude = 0.8, .drive_frequency = 1.1, .torque = 0.2,
    .parametric_amplitude = 0.2, .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.1}},
   7.0, 0.4},
};

/* The end of two periods. */
static void oracle_end(const pendres_pendulum *p, double y, double v, long double *s)
{
  const oracle o = oracle_of(p);
  memcpy(s, (const long double[ORACLE_SIZE]){y, v, 1.0L, 0.0L, 0.0L, 1.0L},
         ORACLE_SIZE * sizeof *s);
  oracle_advance(&o, 2, s);
}

/* Derivatives by a parameter are compared with differences over 2e-6, whose own errors are of the
   order 1e-12 times third derivatives of up to some 1e5. */
static void maps(void **state)
{
  const long double two_pi = 2.0L * ORACLE_PI, exact = 1e-14L;
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_pendulum *p = &cases[i].p;
    long double s[ORACLE_SIZE], end[2][ORACLE_SIZE];
    reference_image image;
    oracle_end(p, cases[i].y, cases[i].v, s);
    check_ok(reference_map(p, cases[i].y, cases[i].v, 2, &image));
    const int turns = p->force == PENDRES_FORCE_PENDULUM;
    assert_true(turns || image.turns == 0);
    const double size = (double)fmaxl(1.0L, fmaxl(fabsl(s[2]), fabsl(s[4])));
    check_near((double)(image.y + two_pi * image.turns - s[0]), 0.0, (double)exact * size);
    check_near((double)(image.v - s[1]), 0.0, (double)exact * size);
    for (int k = 0; k < 2; k++)
      for (int column = 0; column < 2; column++)
        check_near((double)(image.monodromy[k][column] - s[2 + 2 * column + k]), 0.0,
                   (double)exact * size * size);
    for (int which = 0; which < 3; which++) {
      const double h = 1e-6;
      const long double *by = which == 0 ? image.by_frequency
                              : which == 1 ? image.by_damping : image.by_amplitude;
      for (int side = 0; side < 2; side++) {
        pendres_pendulum q = *p;
        double *moved = which == 0 ? &q.drive_frequency
                        : which == 1 ? &q.damping : &q.drive_amplitude;
        *moved += side == 0 ? -h : h;
        oracle_end(&q, cases[i].y, cases[i].v, end[side]);
      }
      for (int k = 0; k < 2; k++)
        check_near((double)by[k], (double)(end[1][k] - end[0][k]) / (2.0 * h),
                   1e-8 * size * size);
    }
  }
}

/* Orbits of the library, closed again: what the drives and the torque give, friction takes. */
static void orbits(void **state)
{
  pendres_context *ctx = context_with(NULL);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const double origin = pendres_model_of(cases[i].p.force)->origin;
    pendres_attractors *set = NULL;
    reference_cycle c;
    check_ok(pendres_attractors_find(ctx, &cases[i].p, 0, NULL, NULL, &set));
    for (size_t k = 0; k < pendres_attractors_count(set); k++) {
      const pendres_orbit *o = &pendres_attractors_get(set, k)->orbit;
      if (o->period == 0 || o->amplitude < 1e-3) continue; /* no orbit, or hardly one */
      check_ok(reference_orbit(&cases[i].p, o->x - origin, o->v, o->period, o->winding,
                                       &c));
      const double size = fmax(1.0, fabs((double)c.dissipation));
      assert_true(c.energy_residual < 1e-15L * size && c.closure < 1e-16L * size);
      check_near(o->loop_area, (double)c.loop_area, o->loop_area_error);
      check_near(o->dissipation, (double)c.dissipation, 10.0 * o->loop_area_error + 1e-8 * size);
      check_near(o->amplitude, (double)c.amplitude, o->amplitude_error);
    }
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/* A fold of the Duffing oscillator, by Newton's method on both determinants. */
static void folds(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 1.26,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {1.0, 0.0, 1.0}};
  pendres_context *ctx = context_with(NULL);
  pendres_attractors *set = NULL;
  pendres_fold fold;
  reference_cycle c;
  (void)state;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  check_ok(pendres_fold_find(ctx, &pendres_attractors_get(set, 0)->orbit, PENDRES_DRIVE_FREQUENCY,
                             &fold));
  check_ok(reference_find(REFERENCE_FOLD, &p,
                                  &(reference_guess){fold.value, fold.orbit.x, fold.orbit.v,
                                                             0.0L},
                                  &c));
  check_near(fold.value, (double)c.drive_frequency, fold.value_error + 1e-15);
  oracle o = oracle_of(&p);
  double left;
  o.omega = c.drive_frequency;
  check_near((double)c.drive_frequency,
             oracle_bifurcation(&o, &o.omega, 1, 0, 1, (double)c.y, (double)c.v, &left), 1e-14);
  /* A coordinate without a period has no winding, and no image of a tilted pendulum. */
  assert_int_equal(reference_orbit(&p, 0.1L, 0.0L, 1, 1, &c), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(reference_find(REFERENCE_SYMMETRY_BREAKING, &cases[0].p,
                                          &(reference_guess){1.0L, 0.1L, 0.0L, 0.0L}, &c),
                   PENDRES_INVALID_ARGUMENT);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(maps), cmocka_unit_test(orbits), cmocka_unit_test(folds),
  };
  return cmocka_run_group_tests_name("reference_models", tests, NULL, NULL);
}
