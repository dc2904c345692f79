/*
 * test_continuation.c -- branches, folds, symmetry breakings, cusps, isolas, backbones.
 *
 * References: reference.h (Taylor series in long double, no shared code), and consequences of the
 * theory that the code does not use: multipliers at located points, the power law by which two
 * folds approach their cusp, the mirror image of an orbit.
 */
#include "continuation_fixture.h"

#include "continuation/sets.h"

/* One point from two tolerances and two methods: the same within the stated errors. */
static void tolerances_and_methods_agree(void **state)
{
  (void)state;
  static const struct {
    double tolerance;
    pendres_table table;
  } ways[] = {{1e-5, PENDRES_TABLE_TP8},   {1e-7, PENDRES_TABLE_DP5},
              {1e-8, PENDRES_TABLE_TSIT5}, {1e-9, PENDRES_TABLE_VERN9}};
  /* From the reference, 18 digits; see make_golden.c for how such numbers are made. */
  const double fold_want = 0.753512458983320393, frequency_want = 0.862157913509009358,
               damping_want = 0.163656902031172567;
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    pendres_context *ctx = context_of(ways[i].tolerance, ways[i].table);
    const pendres_orbit near = orbit_of(ctx, 0.13, 0.2, 0.8, 1);
    pendres_fold fold;
    pendres_cusp cusp;
    check_ok(pendres_fold_find(ctx, &near, PENDRES_DRIVE_FREQUENCY, &fold));
    check_near(fold.value, fold_want, fold.value_error);
    assert_true(fold.value_error <= ways[i].tolerance);
    check_ok(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp));
    check_near(cusp.value[0], frequency_want, fair * cusp.value_error[0]);
    check_near(cusp.value[1], damping_want, fair * cusp.value_error[1]);
    assert_true(cusp.value_error[1] <= ways[i].tolerance);
    pendres_context_free(ctx);
  }
}

/* The S of Fig. 9 at damping 0.13: order, stability, energy balance, folds, mirror symmetry. */
static void branch_is_an_s(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit start = orbit_of(ctx, 0.13, 0.2, 0.8, 1);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.5, .high = 1.1};
  pendres_branch *b = NULL;
  check_ok(pendres_branch_follow(ctx, &start, &options, &b));
  assert_int_equal(pendres_branch_bifurcation_count(b), 2);
  assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_RANGE);
  assert_int_equal(pendres_branch_end_get(b, 1), PENDRES_END_RANGE);
  check_near(pendres_branch_bifurcation_get(b, 0)->value, 0.844925197542337284, 1e-9);
  check_near(pendres_branch_bifurcation_get(b, 1)->value, 0.753512458983320393, 1e-9);
  int folds = 0;
  const size_t n = pendres_branch_count(b);
  /* The ends of the range, as exactly as points are. */
  check_near(pendres_branch_get(b, 0)->orbit.pendulum.drive_frequency, 0.5, 1e-9);
  check_near(pendres_branch_get(b, n - 1)->orbit.pendulum.drive_frequency, 1.1, 1e-9);
  for (size_t i = 0; i < n; i++) {
    const pendres_branch_point *p = pendres_branch_get(b, i);
    const pendres_orbit *o = &p->orbit;
    if (i > 0) {
      const double step = p->arclength - pendres_branch_get(b, i - 1)->arclength;
      /* Twice the spacing where the branch bends. */
      assert_true(step > 0.0 && step < 0.1);
    }
    folds += p->kind == PENDRES_FOLD;
    if (p->kind == PENDRES_REGULAR) assert_int_equal(o->stable, folds != 1);
    assert_true(o->symmetric);
    assert_true(p->parameter_error <= 1e-9 && o->x_error <= 1e-9);
    /* Energy balance and Liouville's product at every point. */
    check_near(o->loop_area, o->dissipation, o->loop_area_error + o->dissipation_error);
    check_relative(o->multiplier_re[0] * o->multiplier_re[1] -
                     o->multiplier_im[0] * o->multiplier_im[1],
                   exp(-2.0 * pi * 0.13 / o->pendulum.drive_frequency), 1e-9);
  }
  assert_int_equal(folds, 2);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* Orbits across the branch at one frequency: the three of them, as the reference has them. */
static void branch_crosses_at_three_orbits(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit start = orbit_of(ctx, 0.13, 0.2, 0.78, 0);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.5, .high = 1.1};
  pendres_branch *b = NULL;
  pendres_orbit there[4];
  size_t found = 0;
  check_ok(pendres_branch_follow(ctx, &start, &options, &b));
  check_ok(pendres_branch_cross(ctx, b, 0.8, 4, there, &found));
  assert_int_equal(found, 3);
  for (size_t i = 0; i < 3; i++) {
    reference_cycle want;
    assert_int_equal(there[i].stable, i != 1);
    check_ok(reference_orbit(&there[i].pendulum, there[i].x - half_pi, there[i].v, 1, 0,
                                     &want));
    check_near(there[i].amplitude, (double)want.amplitude, there[i].amplitude_error);
    check_near(there[i].multiplier_re[0], (double)want.multiplier_re[0],
               there[i].multiplier_error);
  }
  check_ok(pendres_branch_cross(ctx, b, 0.6, 4, there, &found));
  assert_int_equal(found, 1);
  check_ok(pendres_branch_cross(ctx, b, 2.0, 4, there, &found));
  assert_int_equal(found, 0);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Strong friction and a slow drive: on the way over the top an orbit multiplies the last place of
 * its point, and the rounding of its steps, ten thousandfold, and forgets both before the period is
 * over. Measures of points of a branch against the reference: each error is a bound, and once the
 * phase lag was off by 1.7 of it here.
 */
static void rounding_grows_within_a_period(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1.1e-11, PENDRES_TABLE_DEFAULT);
  const double middle = 0.099642125570905585;
  const pendres_orbit_guess guess = {
    .pendulum = {.damping = 1.6842668913306955, .drive_amplitude = 1.1905385066274963,
                 .drive_frequency = middle},
    .x = 3.1193249071541063, .v = 0.11475805953223731, .period = 1};
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = middle - 2e-4, .high = middle + 2e-4,
    .spacing = 1e-4};
  pendres_orbit start;
  pendres_status outcome;
  pendres_branch *b = NULL;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
  check_ok(pendres_branch_follow(ctx, &start, &options, &b));
  const size_t n = pendres_branch_count(b);
  assert_true(n >= 5);
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit *o = &pendres_branch_get(b, i)->orbit;
    reference_cycle want;
    check_ok(reference_orbit(&o->pendulum, o->x - half_pi, o->v, 1, 0, &want));
    check_near(o->phase_lag, (double)want.phase_lag, o->phase_lag_error);
    check_near(o->amplitude, (double)want.amplitude, o->amplitude_error);
    check_near(o->loop_area, (double)want.loop_area, o->loop_area_error);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Few steps, whose order has not set in yet, and two computations of a bifurcation that agree by
 * chance: once the fold was off by 6.7 times its error here. Each error bounds the distance to the
 * same bifurcation at a tight tolerance; and none is useless, more than a hundred times as large.
 */
static void few_steps_that_agree_by_chance(void **state)
{
  (void)state;
  const double tolerances[] = {2.5264438913264473e-4, 1e-11};
  const pendres_orbit_guess guess = {
    .pendulum = {.damping = 0.61003128691180475, .drive_amplitude = 1.3495322401759724,
                 .drive_frequency = 0.4778065046012655},
    .x = 2.6803212190358456, .v = 0.13311655939725342, .period = 2, .winding = -1};
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 1.348, .high = 1.352};
  static const pendres_special kinds[] = {PENDRES_PERIOD_DOUBLING, PENDRES_FOLD};
  double value[2][2], error[2][2];
  for (int k = 0; k < 2; k++) {
    pendres_context *ctx = context_of(tolerances[k], PENDRES_TABLE_DEFAULT);
    pendres_orbit start;
    pendres_status outcome;
    pendres_branch *b = NULL;
    check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
    check_ok(outcome);
    check_ok(pendres_branch_follow(ctx, &start, &options, &b));
    assert_int_equal(pendres_branch_bifurcation_count(b), 2);
    for (size_t i = 0; i < 2; i++) {
      const pendres_bifurcation *at = pendres_branch_bifurcation_get(b, i);
      assert_int_equal(at->kind, kinds[i]);
      value[k][i] = at->value;
      error[k][i] = at->value_error;
    }
    pendres_branch_free(b);
    pendres_context_free(ctx);
  }
  for (size_t i = 0; i < 2; i++) {
    check_near(value[0][i], value[1][i], error[0][i] + error[1][i]);
    assert_true(error[0][i] <= 100.0 * fabs(value[0][i] - value[1][i]));
  }
}

/* LA at small damping ends by losing its symmetry; the pair that is born doubles its period. */
static void symmetry_breaks_and_period_doubles(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit la = orbit_of(ctx, 0.12, 0.2, 0.78, 1);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.4, .high = 0.9};
  pendres_branch *b = NULL, *pair = NULL;
  check_ok(pendres_branch_follow(ctx, &la, &options, &b));
  assert_int_equal(pendres_branch_bifurcation_count(b), 1);
  const pendres_bifurcation *at = pendres_branch_bifurcation_get(b, 0);
  assert_int_equal(at->kind, PENDRES_SYMMETRY_BREAKING);
  reference_cycle want;
  check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, &la.pendulum,
                                  &(reference_guess){at->value, at->orbit.x - half_pi,
                                                             at->orbit.v, 0.0L},
                                  &want));
  check_near(at->value, (double)want.drive_frequency, fair * at->value_error);

  pendres_orbit lopsided;
  check_ok(pendres_branch_switch(ctx, at, &lopsided));
  assert_false(lopsided.symmetric);
  assert_int_equal(lopsided.period, 1);
  check_ok(pendres_branch_follow(ctx, &lopsided, &options, &pair));
  /* Down to the doubling on one side, through the birth, and the mirror image on the other. */
  assert_int_equal(pendres_branch_bifurcation_count(pair), 3);
  const pendres_bifurcation *first = pendres_branch_bifurcation_get(pair, 0);
  const pendres_bifurcation *birth = pendres_branch_bifurcation_get(pair, 1);
  const pendres_bifurcation *last = pendres_branch_bifurcation_get(pair, 2);
  assert_int_equal(birth->kind, PENDRES_SYMMETRY_BREAKING);
  check_near(birth->value, at->value, birth->value_error + at->value_error);
  assert_int_equal(first->kind, PENDRES_PERIOD_DOUBLING);
  assert_int_equal(last->kind, PENDRES_PERIOD_DOUBLING);
  /* What makes a doubling and a loss of symmetry, not what a map nearby has. */
  check_near(first->orbit.multiplier_re[0], -1.0, 0.0);
  check_near(birth->orbit.multiplier_re[0], 1.0, 0.0);
  /* Mirror images double together. */
  check_near(first->value, last->value, first->value_error + last->value_error);
  pendres_pendulum p = la.pendulum;
  p.drive_frequency = first->value;
  check_ok(reference_orbit(&p, first->orbit.x - half_pi, first->orbit.v, 1, 0, &want));
  /* d multiplier / d frequency is some hundreds here. */
  check_near((double)want.multiplier_re[0], -1.0, 1e-6);
  pendres_orbit doubled;
  check_ok(pendres_branch_switch(ctx, first, &doubled));
  assert_int_equal(doubled.period, 2);
  pendres_branch_free(pair);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* Packed and unpacked a set of branches is the same: packed again, the same bytes. Bytes of another
   length are refused. */
static void check_packing(pendres_branches *set)
{
  pendres_curves *from = pendres_branches_set(set), *copy = NULL;
  pendres_bytes first = {.bytes = NULL}, again = first;
  char more = 0;
  pendres_curves_pass(&first, 1, &from);
  const size_t size = first.size;
  pendres_bytes_pass(&first, 1, 1, &more);
  check_ok(first.status);
  pendres_bytes b = pendres_bytes_read(size, first.bytes);
  pendres_curves_pass(&b, 1, &copy);
  assert_true(pendres_bytes_end(&b));
  assert_int_equal(pendres_curves_count(copy), pendres_branches_count(set));
  pendres_curves_pass(&again, 1, &copy);
  check_ok(again.status);
  assert_int_equal(again.size, size);
  assert_memory_equal(first.bytes, again.bytes, size);
  pendres_curves_free(copy);
  for (size_t wrong = 0; wrong <= size + 1; wrong += wrong < size - 1 ? size / 7 + 1 : 1) {
    if (wrong == size) continue;
    b = pendres_bytes_read(wrong, first.bytes);
    pendres_curves_pass(&b, 1, &copy);
    assert_false(pendres_bytes_end(&b));
    assert_int_equal(b.status, PENDRES_INVALID_ARGUMENT);
    pendres_curves_free(copy);
  }
  free(first.bytes);
  free(again.bytes);
}

/* A running orbit exists between two folds and nowhere else: an isola, found to be closed. */
static void running_orbits_make_an_isola(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 1.8, .drive_frequency = 0.85};
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.1, .high = 3.0};
  pendres_attractors *found = NULL;
  pendres_branches *set = NULL;
  pendres_orbit orbits[16];
  size_t n = 0;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
  for (size_t i = 0; i < pendres_attractors_count(found) && n < 16; i++)
    if (pendres_attractors_get(found, i)->orbit.winding != 0)
      orbits[n++] = pendres_attractors_get(found, i)->orbit;
  assert_true(n >= 1);
  check_ok(pendres_branches_find(ctx, n, orbits, &options, &set));
  /* Running forwards and backwards are mirror images: one branch. */
  assert_int_equal(pendres_branches_count(set), 1);
  const pendres_branch *b = pendres_branches_get(set, 0);
  assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_CLOSED);
  double low = INFINITY, high = 0.0;
  int folds = 0;
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    if (f->kind != PENDRES_FOLD) continue;
    folds++;
    low = fmin(low, f->value);
    high = fmax(high, f->value);
    reference_image want;
    const long double y = f->orbit.x - half_pi, v = f->orbit.v;
    check_ok(reference_map(&f->orbit.pendulum, y, v, 1, &want));
    /* It closes, but for a turn, and det(M - I) = 0; both to the tolerance times the derivatives,
       which are below 100. */
    const double turn = fabs((double)(want.y - y)) / (2.0 * pi);
    check_near(turn, rint(turn), 1e-7);
    check_near((double)want.v, (double)v, 1e-7);
    check_near((double)((want.monodromy[0][0] - 1.0L) * (want.monodromy[1][1] - 1.0L) -
                        want.monodromy[0][1] * want.monodromy[1][0]),
               0.0, 1e-7);
  }
  assert_int_equal(folds, 2);
  for (size_t i = 0; i < pendres_branch_count(b); i++) {
    const double omega = pendres_branch_get(b, i)->orbit.pendulum.drive_frequency;
    assert_true(omega >= low - 1e-9 && omega <= high + 1e-9);
  }
  check_packing(set);
  pendres_branches_free(set);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
}

/* At damping 0.124 a large orbit lives at low frequencies on a branch that does not join SA's. */
static void ensemble_finds_the_branch_born_away(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8, PENDRES_TABLE_DEFAULT);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.4, .high = 1.0};
  pendres_branches *set = NULL;
  pendres_orbit orbits[8];
  double x[200], v[200] = {0.0};
  size_t n = 0;
  for (int k = 0; k < 200; k++) x[k] = half_pi * (-1.0 + 4.0 * (k + 1) / 200.0);
  for (int i = 0; i < 2; i++) {
    const pendres_pendulum p = {
      .damping = 0.124, .drive_amplitude = 0.2, .drive_frequency = i == 0 ? 0.8 : 0.5};
    pendres_attractors *found = NULL;
    check_ok(pendres_attractors_find(ctx, &p, 200, x, v, &found));
    assert_int_equal(pendres_attractors_count(found), 2);
    for (size_t k = 0; k < 2; k++) orbits[n++] = pendres_attractors_get(found, k)->orbit;
    pendres_attractors_free(found);
  }
  check_ok(pendres_branches_find(ctx, n, orbits, &options, &set));
  assert_int_equal(pendres_branches_count(set), 2);
  /* It ends upwards in a fold of its own, below which both are, and downwards by its symmetry. */
  const pendres_branch *away = pendres_branches_get(set, 1);
  assert_int_equal(pendres_branch_bifurcation_count(away), 2);
  assert_int_equal(pendres_branch_bifurcation_get(away, 0)->kind, PENDRES_SYMMETRY_BREAKING);
  const pendres_bifurcation *f = pendres_branch_bifurcation_get(away, 1);
  assert_int_equal(f->kind, PENDRES_FOLD);
  reference_cycle want;
  check_ok(reference_find(REFERENCE_FOLD, &f->orbit.pendulum,
                                  &(reference_guess){f->value, f->orbit.x - half_pi,
                                                             f->orbit.v, 0.0L},
                                  &want));
  check_near(f->value, (double)want.drive_frequency, fair * f->value_error);
  pendres_branches_free(set);
  pendres_context_free(ctx);
}

/* A fold itself is a start as good as any other: at damping 0.13 a large orbit, apart from the S,
   lives between its symmetry breaking and a fold. */
static void branches_start_at_folds(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit near = orbit_of(ctx, 0.13, 0.2, 0.8, 1);
  const pendres_curve_options wide = {
    .second = PENDRES_DAMPING, .low = {0.4, 0.12}, .high = {1.2, 1.0}};
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.38, .high = 0.5};
  pendres_fold fold;
  pendres_curve *c = NULL;
  pendres_branch *b = NULL;
  pendres_bifurcation at[4];
  reference_cycle want;
  size_t found = 0;
  check_ok(pendres_fold_find(ctx, &near, PENDRES_DRIVE_FREQUENCY, &fold));
  check_ok(pendres_curve_follow(ctx, &fold, &wide, &c));
  check_ok(pendres_curve_cross(ctx, c, 0.13, 4, at, &found));
  assert_int_equal(found, 3);
  check_ok(pendres_branch_follow(ctx, &at[0].orbit, &options, &b));
  assert_int_equal(pendres_branch_bifurcation_count(b), 2);
  const pendres_bifurcation *end = pendres_branch_bifurcation_get(b, 0);
  const pendres_bifurcation *again = pendres_branch_bifurcation_get(b, 1);
  assert_int_equal(end->kind, PENDRES_SYMMETRY_BREAKING);
  check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, &end->orbit.pendulum,
                                  &(reference_guess){end->value, end->orbit.x - half_pi,
                                                             end->orbit.v, 0.0L},
                                  &want));
  check_near(end->value, (double)want.drive_frequency, fair * end->value_error);
  assert_int_equal(again->kind, PENDRES_FOLD);
  check_near(again->value, at[0].value, again->value_error + at[0].value_error);
  pendres_branch_free(b);
  pendres_curve_free(c);
  pendres_context_free(ctx);
}

/* What is found does not depend on who is followed beside it, nor on the size of blocks. */
static void branches_do_not_depend_on_blocks(void **state)
{
  (void)state;
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.7, .high = 0.9};
  pendres_context *wide = NULL, *narrow = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &wide));
  check_ok(
    pendres_context_create(&(pendres_options){.tolerance = 1e-8, .block_lanes = 8}, &narrow));
  const pendres_orbit start = orbit_of(wide, 0.14, 0.2, 0.83, 1);
  pendres_branch *few = NULL, *many = NULL;
  check_ok(pendres_branch_follow(narrow, &start, &options, &few));
  check_ok(pendres_branch_follow(wide, &start, &options, &many));
  assert_int_equal(pendres_branch_count(few), pendres_branch_count(many));
  for (size_t i = 0; i < pendres_branch_count(few); i++) {
    const pendres_orbit *a = &pendres_branch_get(few, i)->orbit;
    const pendres_orbit *b = &pendres_branch_get(many, i)->orbit;
    assert_memory_equal(&a->x, &b->x, sizeof a->x);
    assert_memory_equal(&a->pendulum, &b->pendulum, sizeof a->pendulum);
    assert_memory_equal(&a->loop_area_error, &b->loop_area_error, sizeof a->loop_area_error);
  }
  pendres_branch_free(few);
  pendres_branch_free(many);
  pendres_context_free(wide);
  pendres_context_free(narrow);
}

static void mistakes_are_told(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8, PENDRES_TABLE_DEFAULT);
  const pendres_orbit single = orbit_of(ctx, 0.3, 0.2, 0.8, 0);
  pendres_fold fold;
  pendres_cusp cusp;
  pendres_branch *b = NULL;
  pendres_curve *c = NULL;
  pendres_orbit o;
  /* Above the cusp there is no fold. */
  assert_int_equal(pendres_fold_find(ctx, &single, PENDRES_DRIVE_FREQUENCY, &fold),
                   PENDRES_NOT_FOUND);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  assert_int_equal(pendres_fold_find(NULL, &single, PENDRES_DRIVE_FREQUENCY, &fold),
                   PENDRES_INVALID_ARGUMENT);
  const pendres_branch_options empty = {.low = 0.9, .high = 0.8};
  assert_int_equal(pendres_branch_follow(ctx, &single, &empty, &b), PENDRES_INVALID_ARGUMENT);
  assert_null(b);
  pendres_orbit nowhere = single;
  nowhere.x += 1.0;
  nowhere.v += 40.0;
  const pendres_branch_options range = {.low = 0.5, .high = 1.0};
  assert_int_equal(pendres_branch_follow(ctx, &nowhere, &range, &b), PENDRES_NOT_CONVERGED);
  assert_null(b);
  fold = (pendres_fold){.kind = PENDRES_REGULAR, .orbit = single};
  const pendres_curve_options second = {
    .second = PENDRES_DAMPING, .low = {0.5, 0.1}, .high = {1.0, 0.5}};
  assert_int_equal(pendres_curve_follow(ctx, &fold, &second, &c), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_branch_switch(ctx, &fold, &o), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(tolerances_and_methods_agree),
    cmocka_unit_test(branch_is_an_s),
    cmocka_unit_test(rounding_grows_within_a_period),
    cmocka_unit_test(few_steps_that_agree_by_chance),
    cmocka_unit_test(branch_crosses_at_three_orbits),
    cmocka_unit_test(symmetry_breaks_and_period_doubles),
    cmocka_unit_test(running_orbits_make_an_isola),
    cmocka_unit_test(ensemble_finds_the_branch_born_away),
    cmocka_unit_test(branches_start_at_folds),
    cmocka_unit_test(branches_do_not_depend_on_blocks),
    cmocka_unit_test(mistakes_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
