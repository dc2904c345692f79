/*
 * test_branch_parts.c -- the parts of branches that attract end where orbits lose their stability,
 * wherever a branch starts: at the bifurcations themselves, too, beside which rounding decides
 * whether a point of it is stable. And errors of their points are not those of larger orbits.
 */
#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "context_fixture.h"

#include "continuation/sets.h"

static const double low = 0.74, high = 1.46;

static double value_of(const pendres_branch *b, size_t i)
{
  return pendres_branch_get(b, i)->orbit.pendulum.drive_amplitude;
}

/* Begin and end of each part are bifurcations, or the range's ends; in between the parameter goes
   one way, but for the errors of points: where orbits are born the branch turns back, and another
   part begins. */
static void check_parts(const pendres_branch *b)
{
  enum { MOST = 32 };
  pendres_branch_part part[MOST];
  const size_t n = pendres_branch_parts(b, MOST, part);
  assert_true(n <= MOST);
  for (size_t i = 0; i < n; i++) {
    const double first = value_of(b, part[i].first), last = value_of(b, part[i].last);
    const double way = last > first ? 1.0 : -1.0;
    assert_true(part[i].begins != PENDRES_REGULAR || first == low || first == high);
    assert_true(part[i].ends != PENDRES_REGULAR || last == low || last == high);
    for (size_t k = part[i].first; k < part[i].last; k++)
      assert_true(way * (value_of(b, k + 1) - value_of(b, k)) >=
                  -2.0 * (pendres_branch_get(b, k)->parameter_error +
                          pendres_branch_get(b, k + 1)->parameter_error));
  }
}

/*
 * Duffing's two wells, x'' + x'/4 - x + x^3 = F cos t: folds, doublings and losses of symmetry are
 * starts, the doublings of the orbits that are born there.
 */
static void starts_at_bifurcations(void **state)
{
  static const double tolerance[] = {1e-6, 1e-7, 1e-8, 1e-9};
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = low, .high = high};
  size_t parts = 0;
  (void)state;
  for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++)
    for (int k = 0; k < 3; k++) {
      pendres_context *ctx = context_with(&(pendres_options){.tolerance = tolerance[t]});
      const pendres_pendulum p = {.damping = 0.25, .drive_amplitude = 1.19 + 0.03 * k,
                                  .drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL,
                                  .force_coefficients = {-1.0, 0.0, 1.0}};
      pendres_attractors *set = NULL;
      check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
      for (size_t i = 0; i < pendres_attractors_count(set); i++) {
        const pendres_attractor *a = pendres_attractors_get(set, i);
        pendres_branch *b = NULL;
        if (a->orbit.period < 1) continue;
        check_ok(pendres_branch_follow(ctx, &a->orbit, &options, &b));
        check_parts(b);
        for (size_t m = 0; m < pendres_branch_bifurcation_count(b); m++) {
          pendres_branch *from = NULL;
          const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, m);
          pendres_orbit start = f->orbit;
          if (f->kind == PENDRES_PERIOD_DOUBLING) check_ok(pendres_branch_switch(ctx, f, &start));
          check_ok(pendres_branch_follow(ctx, &start, &options, &from));
          check_parts(from);
          parts += pendres_branch_parts(from, 0, NULL);
          pendres_branch_free(from);
        }
        pendres_branch_free(b);
      }
      pendres_attractors_free(set);
      pendres_context_free(ctx);
    }
  assert_true(parts > 12);
}

/*
 * Of an oscillator that swings by a thousandth, a hundred thousand times before it is at rest,
 * errors are those of numbers of that size. What is true is the reference's orbit.
 */
static void errors_of_small_orbits_are_small(void **state)
{
  pendres_context *ctx = context_with(NULL);
  const double damping = 1e-5;
  const pendres_pendulum p = {.damping = damping, .drive_amplitude = 1e-3 * damping,
                              .drive_frequency = 1.0 - 3.0 * damping,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {1.0, 0.0, 1.0}};
  const pendres_orbit_guess guess = {.pendulum = p, .x = 2e-4, .period = 1};
  const pendres_branch_options options = {.parameter = PENDRES_DRIVE_FREQUENCY,
                                          .low = 1.0 - 5.0 * damping, .high = 1.0 + 5.0 * damping};
  pendres_orbit start;
  pendres_status outcome;
  pendres_branch *b = NULL;
  (void)state;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
  assert_int_equal(outcome, PENDRES_OK);
  check_ok(pendres_branch_follow(ctx, &start, &options, &b));
  assert_true(pendres_branch_count(b) > 10);
  for (size_t i = 0; i < pendres_branch_count(b); i++) {
    const pendres_orbit *o = &pendres_branch_get(b, i)->orbit;
    reference_cycle c;
    check_ok(reference_orbit(&o->pendulum, o->x, o->v, 1, 0, &c));
    check_near(o->amplitude, (double)c.amplitude, o->amplitude_error);
    assert_true(o->amplitude_error < 1e-7 * o->amplitude);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(starts_at_bifurcations),
                                     cmocka_unit_test(errors_of_small_orbits_are_small)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
