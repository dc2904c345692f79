/*
 * test_orbit_record.c -- records of closed orbits beside integrations at a far tighter tolerance,
 * and in pieces; samples of an orbit with many steps.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

static const double pi = PENDRES_PI;

enum { SAMPLES = 16, PERIODS = 7, N = SAMPLES * PERIODS };

typedef struct recorded {
  double x[N + 1], v[N + 1], x_error[N + 1], v_error[N + 1];
} recorded;

static pendres_record into(recorded *r, size_t at)
{
  return (pendres_record){r->x + at, r->v + at, r->x_error + at, r->v_error + at};
}

static pendres_context *context_of(double tolerance)
{
  const pendres_options options = {.tolerance = tolerance};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&options, &ctx));
  return ctx;
}

/* An orbit of one period, one that runs, and one of four periods. */
static const pendres_orbit_guess guesses[] = {
  {{0.12, 0.2, 0.78539816339744830962, 0.0}, 1.2, 0.0, 1, 0},
  {{0.5, 1.4, 2.0 / 3.0, 0.0}, 0.0, 0.0, 1, 0},
  {{0.040708302111654285, 0.4007269722105567, 0.6117703965197987, 0.0}, 10.230660039567459,
   0.24500534675978197, 4, 0}};
enum { ORBITS = sizeof guesses / sizeof *guesses };

/* What a pendulum of the guess's parameters settles on, or the guess itself if it has periods. */
static pendres_orbit orbit_of(pendres_context *ctx, const pendres_orbit_guess *g)
{
  pendres_orbit o;
  pendres_status outcome;
  pendres_attractors *set = NULL;
  if (g->period > 1) {
    check_ok(pendres_orbit_find(ctx, 1, g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    check_ok(outcome);
    return o;
  }
  check_ok(pendres_attractors_find(ctx, &g->pendulum, 1, &g->x, &g->v, &set));
  o = pendres_attractors_get(set, 0)->orbit;
  pendres_attractors_free(set);
  return o;
}

/*
 * Each point is off by less than its error from the same orbit found and integrated to 1e-12, whose
 * own error is asked for; and the errors of a record are not above a few hundred tolerances. (The
 * errors of points on the way are those of the orbit's own point and of the integration over one
 * period: both are asked to be within the tolerance, twice the former's two parts are added.)
 */
static void errors_hold(void **state)
{
  static recorded got, exact;
  (void)state;
  for (int i = 0; i < ORBITS; i++)
    for (double tolerance = 1e-5; tolerance > 1e-10; tolerance *= 1e-2) {
      pendres_context *ctx = context_of(tolerance), *fine = context_of(1e-12);
      const pendres_orbit o = orbit_of(ctx, &guesses[i]), truth = orbit_of(fine, &guesses[i]);
      const pendres_orbit_stretch all = {0, 0, PERIODS, SAMPLES};
      const pendres_record to = into(&got, 0), as = into(&exact, 0);
      assert_int_equal(i == 1, o.winding != 0);
      check_ok(pendres_orbit_record(ctx, &o, &all, &to));
      check_ok(pendres_strobe_record(fine, &o.pendulum, &(pendres_state){truth.x, truth.v},
                                     PERIODS, SAMPLES, &as));
      const double turns = 2.0 * pi * round((truth.x - o.x) / (2.0 * pi));
      for (int k = 0; k < N; k++) {
        check_near(got.x[k], exact.x[k] - turns, got.x_error[k] + exact.x_error[k]);
        check_near(got.v[k], exact.v[k], got.v_error[k] + exact.v_error[k]);
        assert_true(got.x_error[k] < 300.0 * tolerance && got.v_error[k] < 300.0 * tolerance);
      }
      pendres_context_free(ctx);
      pendres_context_free(fine);
    }
}

/* Pieces have the bytes of the whole; without errors the points are the same; a well is whole turns
   and no more. */
static void pieces(void **state)
{
  static recorded whole, part;
  pendres_context *ctx = context_of(1e-8);
  (void)state;
  for (int i = 0; i < ORBITS; i++) {
    const pendres_orbit o = orbit_of(ctx, &guesses[i]);
    const pendres_orbit_stretch all = {3, 2, PERIODS, SAMPLES}, first = {3, 2, 4, SAMPLES},
                                rest = {3, 6, PERIODS - 4, SAMPLES}, home = {0, 2, 1, SAMPLES};
    const pendres_record to = into(&whole, 0), one = into(&part, 0),
                         other = into(&part, 4 * SAMPLES), plain = {part.x, part.v, NULL, NULL};
    memset(&part, 0, sizeof part);
    memset(&whole, 0, sizeof whole);
    check_ok(pendres_orbit_record(ctx, &o, &all, &to));
    check_ok(pendres_orbit_record(ctx, &o, &first, &one));
    check_ok(pendres_orbit_record(ctx, &o, &rest, &other));
    assert_memory_equal(&part, &whole, sizeof part);
    check_ok(pendres_orbit_record(ctx, &o, &all, &plain));
    assert_memory_equal(part.x, whole.x, N * sizeof *part.x);
    check_ok(pendres_orbit_record(ctx, &o, &home, &one));
    for (int k = 0; k < SAMPLES; k++) /* two roundings of positions up to some 60 */
      check_near(whole.x[k] - part.x[k], 6.0 * pi, 2e-14);
  }
  pendres_context_free(ctx);
}

/* An orbit may have as many steps as it takes: two of its curves are compared at all of them. */
static void samples_of_many_steps(void **state)
{
  pendres_context *ctx = context_of(1e-8);
  pendres_orbit o = orbit_of(ctx, &guesses[0]);
  double x = NAN, v = NAN, error[2] = {NAN, NAN};
  (void)state;
  o.steps = 40000;
  check_ok(pendres_orbit_sample(ctx, &o, 1, &x, &v, error));
  assert_true(error[0] < 1e-9 && error[1] < 1e-9);
  check_near(x, o.x, o.x_error + error[0]);
  check_near(v, o.v, o.v_error + error[1]);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(errors_hold),
    cmocka_unit_test(pieces),
    cmocka_unit_test(samples_of_many_steps),
  };
  return cmocka_run_group_tests_name("orbit_record", tests, NULL, NULL);
}
