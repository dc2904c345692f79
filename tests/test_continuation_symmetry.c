/*
 * test_continuation_symmetry.c -- orbits of several drive periods that are their own mirror images,
 * branches born from others, and whether branches and their bifurcations agree.
 *
 * References: reference.h (Taylor series in long double, no shared code), and theory that the code
 * does not use: a symmetric orbit's multiplier goes straight through +1 where the symmetry breaks,
 * and the pair that is born there grows as a square root.
 */
#include <stdlib.h>

#include <pendres/attractor.h>
#include <pendres/continuation.h>
#include "oracle/reference.h"

#include "branch_fixture.h"
#include "continuation/branch.h"
#include "continuation/sets.h"

static const double half_pi = 1.57079632679489661923;

static pendres_orbit refined(pendres_context *ctx, pendres_orbit_guess guess)
{
  pendres_orbit orbit;
  pendres_status outcome;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  check_ok(outcome);
  return orbit;
}

static pendres_branch *followed(pendres_context *ctx, const pendres_orbit *start, double low,
                                double high)
{
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = low, .high = high};
  pendres_branch *b = NULL;
  check_ok(pendres_branch_follow(ctx, start, &options, &b));
  return b;
}

static size_t doubts_of(const pendres_branch *b)
{
  size_t doubts = 0;
  for (size_t i = 0; i < pendres_branch_count(b); i++)
    doubts += pendres_branch_get(b, i)->doubt != 0;
  return doubts;
}

/* The only bifurcation of a kind on a branch, which must have one. */
static const pendres_bifurcation *the(const pendres_branch *b, pendres_special kind)
{
  const pendres_bifurcation *found = only(b, kind);
  assert_non_null(found);
  return found;
}

/* Larger multiplier, less 1, of the period-3 orbit at a frequency, by the reference. */
static double excess(pendres_pendulum p, double frequency, double x, double v)
{
  reference_cycle c;
  p.drive_frequency = frequency;
  check_ok(reference_orbit(&p, x - half_pi, v, 3, 0, &c));
  return (double)(c.multiplier_re[0] - 1.0L);
}

/*
 * About the top of the barrier: y(t + 3 tau / 2) = 2 pi - y(t), so the mean is pi and all odd
 * harmonics of the whole length are there, not the multiples of three alone.
 */
static void period_three_loses_its_symmetry(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &ctx));
  const pendres_pendulum p = {.damping = 0.05, .drive_amplitude = 0.2, .drive_frequency = 0.537706};
  const pendres_orbit start = refined(
    ctx, (pendres_orbit_guess){.pendulum = p, .x = 7.032235, .v = 1.571260, .period = 3});
  assert_true(start.symmetric && start.stable);
  pendres_branch *b = followed(ctx, &start, 0.535, 0.55);
  const pendres_bifurcation *at = the(b, PENDRES_SYMMETRY_BREAKING);
  assert_int_equal(doubts_of(b), 0);
  assert_int_equal(the(b, PENDRES_FOLD)->orbit.period, 3);
  /* The symmetric orbit itself goes on beyond, unstable. The multiplier's zero is linear in the
     frequency but for its square, 1e-14 by 1e3 over its slope of 650. */
  const double h = 1e-7;
  const double before = excess(at->orbit.pendulum, at->value - h, at->orbit.x, at->orbit.v);
  const double behind = excess(at->orbit.pendulum, at->value + h, at->orbit.x, at->orbit.v);
  assert_true(before > 0.0 && behind < 0.0);
  check_near(h * (before + behind) / (before - behind), 0.0, at->value_error + 1e-12);

  /* The pair: asymmetric, with the symmetry breaking at its birth and no fold there. */
  pendres_orbit pair;
  check_ok(pendres_branch_switch(ctx, at, &pair));
  assert_true(!pair.symmetric && pair.period == 3);
  pendres_branch *born = followed(ctx, &pair, 0.5345, 0.55);
  const pendres_bifurcation *birth = the(born, PENDRES_SYMMETRY_BREAKING);
  check_near(birth->value, at->value, birth->value_error + at->value_error);
  for (size_t i = 0; i < pendres_branch_bifurcation_count(born); i++)
    assert_true(pendres_branch_bifurcation_get(born, i)->kind != PENDRES_FOLD);
  assert_int_equal(doubts_of(born), 0);
  pendres_branch_free(born);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* About the bottom of a well: its fold, known from quadruple precision to the digits given. */
static void period_three_has_its_fold(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &ctx));
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.35, .drive_frequency = 0.668508};
  const pendres_orbit start = refined(
    ctx, (pendres_orbit_guess){.pendulum = p, .x = 0.027643, .v = 1.321870, .period = 3});
  assert_true(start.symmetric);
  pendres_branch *b = followed(ctx, &start, 0.66, 0.68);
  const pendres_bifurcation *fold = the(b, PENDRES_FOLD);
  check_near(fold->value, 0.67054934211, fold->value_error + 5e-12);
  assert_true(fold->curvature < 0.0 && fold->orbit.period == 3);
  (void)the(b, PENDRES_SYMMETRY_BREAKING);
  assert_int_equal(doubts_of(b), 0);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Branches that come close to others: where they were born (the first, third and fourth), and next
 * to a sharp turn of their own (the second). Each stays on itself.
 */
static void branches_stay_on_themselves(void **state)
{
  (void)state;
  static const struct {
    double damping, drive, frequency, x, v;
    int period, winding;
    double low, high;
    size_t births;
  } cases[] = {{0.1, 0.3, 0.55, 8.206, 1.7068, 3, 0, 0.5485, 0.5525, 1},
               {0.0797, 0.4675, 0.70485, 6.738, 0.9427, 7, 0, 0.695, 0.712, 0},
               {0.123, 0.4815, 0.813715, 2.632600, -0.308360, 6, 2, 0.812, 0.815, 1},
               {0.1, 0.4, 0.750033, 0.397890, 1.053081, 8, 0, 0.7498, 0.7502, 1}};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &ctx));
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    size_t births = 0;
    const pendres_orbit start = refined(
      ctx, (pendres_orbit_guess){.pendulum = {.damping = cases[i].damping,
                                              .drive_amplitude = cases[i].drive,
                                              .drive_frequency = cases[i].frequency},
                                 .x = cases[i].x, .v = cases[i].v, .period = cases[i].period,
                                 .winding = cases[i].winding});
    pendres_branch *b = followed(ctx, &start, cases[i].low, cases[i].high);
    for (size_t k = 0; k < pendres_branch_count(b); k++)
      if (pendres_branch_get(b, k)->bifurcation < 0)
        assert_int_equal(pendres_branch_get(b, k)->orbit.symmetric, start.symmetric);
    for (size_t k = 0; k < pendres_branch_bifurcation_count(b); k++) {
      const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, k);
      births += f->orbit.period < start.period || (f->orbit.symmetric && !start.symmetric);
    }
    assert_int_equal(births, cases[i].births);
    assert_int_equal(doubts_of(b), 0);
    pendres_branch_free(b);
  }
  pendres_context_free(ctx);
}

/*
 * A point of a branch has the errors of the orbit at its own frequency: next to a fold that moves
 * with the root of what the frequency is off by, 8 times what the distance across the branch
 * claims. Estimates, so twice the claim is allowed.
 */
static void orbits_next_to_a_fold_know_their_errors(void **state)
{
  (void)state;
  static const double tolerances[] = {1e-4, 1e-8, 1e-11};
  for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
    pendres_context *ctx = NULL;
    size_t compared = 0;
    check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerances[i]}, &ctx));
    const pendres_pendulum p = {
      .damping = 0.1, .drive_amplitude = 0.35, .drive_frequency = 0.668508};
    const pendres_orbit start = refined(
      ctx, (pendres_orbit_guess){.pendulum = p, .x = 0.027643, .v = 1.321870, .period = 3});
    pendres_branch *b = followed(ctx, &start, 0.668, 0.68);
    for (size_t k = 0; k < pendres_branch_count(b); k++) {
      const pendres_orbit *o = &pendres_branch_get(b, k)->orbit;
      reference_cycle c;
      if (pendres_branch_get(b, k)->bifurcation >= 0) continue;
      if (reference_orbit(&o->pendulum, o->x - half_pi, o->v, 3, 0, &c) != PENDRES_OK ||
          fabs((double)c.y - (o->x - half_pi)) > 1e-3)
        continue; /* right at the fold the reference finds none, or the other */
      check_near(o->x - half_pi, (double)c.y, 2.0 * o->x_error);
      check_near(o->amplitude, (double)c.amplitude, 2.0 * o->amplitude_error);
      compared++;
    }
    assert_true(compared > 8);
    pendres_branch_free(b);
    pendres_context_free(ctx);
  }
}

/* A branch that lacks a bifurcation, or has one by another name, is doubted where that is. */
static void what_is_missing_is_doubted(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &ctx));
  const pendres_pendulum p = {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  const pendres_orbit sa = refined(
    ctx, (pendres_orbit_guess){.pendulum = p, .x = half_pi + 0.5, .v = 0.1, .period = 1});
  pendres_branch *b = followed(ctx, &sa, 0.7, 0.9);
  assert_int_equal(pendres_branch_bifurcation_count(b), 2);
  assert_int_equal(doubts_of(b), 0);
  size_t at = 0;
  while (b->curve.branch_point[at].bifurcation < 0) at++;
  const pendres_branch_point whole = b->curve.branch_point[at];
  const pendres_special kind = b->curve.bifurcation[whole.bifurcation].kind;

  b->curve.bifurcation[whole.bifurcation].kind = PENDRES_SYMMETRY_BREAKING;
  pendres_branch_check(&b->curve);
  assert_int_equal(b->curve.branch_point[at].doubt, PENDRES_DOUBT_BIFURCATION);
  b->curve.bifurcation[whole.bifurcation].kind = PENDRES_PERIOD_DOUBLING;
  pendres_branch_check(&b->curve);
  assert_int_equal(b->curve.branch_point[at - 1].doubt, PENDRES_DOUBT_SIGN);
  b->curve.bifurcation[whole.bifurcation].kind = kind;
  b->curve.branch_point[at].bifurcation = -1;
  pendres_branch_check(&b->curve);
  assert_int_equal(b->curve.branch_point[at].doubt, PENDRES_DOUBT_TURN);
  assert_int_equal(b->curve.branch_point[at - 1].doubt, PENDRES_DOUBT_SIGN);
  b->curve.branch_point[at] = whole;
  pendres_branch_check(&b->curve);
  assert_int_equal(doubts_of(b), 0);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * What errors of the steps make of an orbit and of its derivatives cancels by right in where it
 * bifurcates. LA loses its symmetry, and the pair that is born there doubles its period: the errors
 * bound what is true, and are no more than thirty times as large; they once were 55 to 200 times.
 * The first is known from the reference, the second from a tight tolerance, which docs/auto.md has
 * beside AUTO's.
 */
static void what_cancels_by_right(void **state)
{
  static const double tolerances[] = {1e-8, 1e-12};
  double value[2], error[2];
  (void)state;
  for (int k = 0; k < 2; k++) {
    pendres_context *ctx = NULL;
    check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerances[k]}, &ctx));
    const pendres_pendulum p = {
      .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78};
    const pendres_orbit la = refined(
      ctx, (pendres_orbit_guess){.pendulum = p, .x = 0.9008262, .v = 1.5702276, .period = 1});
    pendres_branch *b = followed(ctx, &la, 0.45, 0.79);
    const pendres_bifurcation *at = the(b, PENDRES_SYMMETRY_BREAKING);
    if (k == 0) {
      reference_cycle want;
      check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, &p,
                                      &(reference_guess){at->value, at->orbit.x - half_pi,
                                                                 at->orbit.v, 0.0L},
                                      &want));
      check_near(at->value, (double)want.drive_frequency, at->value_error);
      assert_true(at->value_error < 30.0 * fabs(at->value - (double)want.drive_frequency));
    }
    pendres_orbit born;
    check_ok(pendres_branch_switch(ctx, at, &born));
    pendres_branch *pair = followed(ctx, &born, 0.455, 0.47);
    const pendres_bifurcation *first = pendres_branch_bifurcation_get(pair, 0);
    assert_non_null(first);
    assert_int_equal(first->kind, PENDRES_PERIOD_DOUBLING);
    value[k] = first->value;
    error[k] = first->value_error;
    pendres_branch_free(pair);
    pendres_branch_free(b);
    pendres_context_free(ctx);
  }
  check_near(value[0], value[1], error[0] + error[1]);
  assert_true(error[0] < 30.0 * fabs(value[0] - value[1]));
}

/*
 * Outlines are the same branches: their bifurcations are those that whole branches have, and their
 * points, from Newton's method once more, are orbits of the same multipliers. Along a branch of
 * symmetric orbits, whose map goes half a period, through the loss of symmetry; and along one of
 * the pair, through a doubling. Points of such a branch are as exact as its steps, some 1e-5.
 */
static void branches_that_lead_on(void **state)
{
  static const double amplitude[] = {0.95, 1.05};
  static const size_t met[] = {1, 3}; /* the pair's branch has both of its orbits */
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &ctx));
  for (int k = 0; k < 2; k++) {
    const pendres_pendulum p = {
      .damping = 0.5, .drive_amplitude = amplitude[k], .drive_frequency = 2.0 / 3.0};
    const pendres_branch_options options = {
      .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 0.9, .high = 1.09};
    pendres_attractors *set = NULL;
    pendres_branch *whole = NULL, *coarse = NULL;
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
    const pendres_orbit *start = &pendres_attractors_get(set, 0)->orbit;
    assert_int_equal(start->symmetric, k == 0);
    check_ok(pendres_branch_follow(ctx, start, &options, &whole));
    const pendres_curve_bounds few = {{options.low}, {options.high}, 1e3, 4}, all = {
      {options.low}, {options.high}, 1e3, 2000};
    check_ok(pendres_branch_begin(ctx, start, options.parameter, 0.05, &coarse));
    check_ok(pendres_branch_extend(ctx, coarse, &few));
    assert_int_equal(pendres_branch_end_get(coarse, 0), PENDRES_END_POINTS);
    check_ok(pendres_branch_extend(ctx, coarse, &all));
    for (int which = 0; which < 2; which++)
      assert_int_equal(pendres_branch_end_get(coarse, which),
                       pendres_branch_end_get(whole, which));
    assert_int_equal(pendres_branch_bifurcation_count(whole), met[k]);
    assert_int_equal(pendres_branch_bifurcation_count(coarse), met[k]);
    for (size_t i = 0; i < pendres_branch_bifurcation_count(whole); i++) {
      const pendres_bifurcation *a = pendres_branch_bifurcation_get(whole, i);
      const pendres_bifurcation *b = pendres_branch_bifurcation_get(coarse, i);
      assert_int_equal(a->kind, b->kind);
      check_near(a->value, b->value, a->value_error + b->value_error);
    }
    assert_true(pendres_branch_count(coarse) > 5);
    for (size_t i = 0; i < pendres_branch_count(coarse); i++) {
      const pendres_branch_point *at = pendres_branch_get(coarse, i);
      if (at->bifurcation >= 0) continue;
      const pendres_orbit *o = &at->orbit, is = refined(ctx, (pendres_orbit_guess){
        o->pendulum, o->x, o->v, o->period, o->winding});
      check_near(o->x, is.x, 1e-5);
      check_near(o->v, is.v, 1e-5);
      check_near(o->multiplier_re[0], is.multiplier_re[0], 1e-4);
      assert_int_equal(o->stable, is.stable);
    }
    pendres_branch_free(whole);
    pendres_branch_free(coarse);
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(period_three_loses_its_symmetry),
    cmocka_unit_test(period_three_has_its_fold),
    cmocka_unit_test(branches_stay_on_themselves),
    cmocka_unit_test(orbits_next_to_a_fold_know_their_errors),
    cmocka_unit_test(what_is_missing_is_doubted),
    cmocka_unit_test(what_cancels_by_right),
    cmocka_unit_test(branches_that_lead_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
