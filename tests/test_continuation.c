/*
 * test_continuation.c -- branches, folds, symmetry breakings, cusps, isolas, backbones.
 *
 * References: reference.h (Taylor series in long double, no shared code), and consequences of the
 * theory that the code does not use: multipliers at located points, the power law by which two
 * folds approach their cusp, the mirror image of an orbit.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/attractor.h>
#include <pendres/continuation.h>
#include <pendres/reference.h>

#include "check.h"

static const double pi = 3.14159265358979323846;
static const double half_pi = 1.57079632679489661923;

/* Errors are estimates: half the true error happens where an error passes through 0 between two
   numbers of steps. What is promised is better than a tenth. */
static const double fair = 2.0;

static pendres_context *context_of(double tolerance, pendres_table table)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(
    &(pendres_options){.tolerance = tolerance, .table = table}, &ctx));
  return ctx;
}

/* The attractors of a pendulum; `which` by amplitude. */
static pendres_orbit orbit_of(pendres_context *ctx, double damping, double drive, double frequency,
                              size_t which)
{
  const pendres_pendulum p = {
    .damping = damping, .drive_amplitude = drive, .drive_frequency = frequency};
  pendres_attractors *found = NULL;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
  const pendres_attractor *a = pendres_attractors_get(found, which);
  assert_non_null(a);
  const pendres_orbit orbit = a->orbit;
  pendres_attractors_free(found);
  return orbit;
}

/* Also where the values of two numbers of steps agree by chance: this one was once off by 25 times
   its estimate, the difference between the two. */
static void a_fold_is_not_known_better_than_its_point(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-4, PENDRES_TABLE_DEFAULT);
  const pendres_orbit_guess guess = {
    .pendulum = {.damping = 0.118, .drive_amplitude = 0.2, .drive_frequency = 0.8},
    .x = half_pi + 0.7, .v = 0.1, .period = 1};
  pendres_orbit near;
  pendres_status outcome;
  pendres_fold fold;
  pendres_reference_cycle want;
  check_ok(pendres_orbit_refine(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &near, &outcome));
  check_ok(outcome);
  check_ok(pendres_fold_find(ctx, &near, &fold));
  check_ok(pendres_reference_fold(&near.pendulum, fold.value, fold.orbit.x - half_pi,
                                  fold.orbit.v, &want));
  check_near(fold.value, (double)want.drive_frequency, fair * fold.value_error);
  pendres_context_free(ctx);
}

/* Folds of SA and LA agree with the reference within their own errors, and these are not vain. */
static void folds_match_reference(void **state)
{
  (void)state;
  static const struct {
    double damping, drive, frequency;
    size_t which;
  } cases[] = {{0.13, 0.2, 0.80, 0}, {0.13, 0.2, 0.80, 1}, {0.15, 0.2, 0.845, 0},
               {0.06, 0.2, 0.75, 0}, {0.08, 0.1, 0.88, 0}, {0.16, 0.2, 0.83, 0}};
  pendres_context *ctx = context_of(1e-8, PENDRES_TABLE_DEFAULT);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const pendres_orbit near =
      orbit_of(ctx, cases[i].damping, cases[i].drive, cases[i].frequency, cases[i].which);
    pendres_fold fold;
    pendres_reference_cycle want;
    check_ok(pendres_fold_find(ctx, &near, &fold));
    assert_int_equal(fold.kind, PENDRES_FOLD);
    check_ok(pendres_reference_fold(&near.pendulum, fold.value, fold.orbit.x - half_pi,
                                    fold.orbit.v, &want));
    const pendres_orbit *o = &fold.orbit;
    check_near(fold.value, (double)want.drive_frequency, fair * fold.value_error);
    check_near(o->x - half_pi, (double)want.y, fair * o->x_error);
    check_near(o->v, (double)want.v, fair * o->v_error);
    check_near(o->amplitude, (double)want.amplitude, fair * o->amplitude_error);
    check_near(o->phase_lag, (double)want.phase_lag, fair * o->phase_lag_error);
    check_near(o->loop_area, (double)want.loop_area, fair * o->loop_area_error);
    /* The tolerance asked for is kept, with room: the method's order sets in. */
    assert_true(fold.value_error <= 1e-8);
    check_near(o->multiplier_re[0], 1.0, 1e-8);
    /* Liouville. */
    check_relative(o->multiplier_re[0] * o->multiplier_re[1],
                   exp(-2.0 * pi * cases[i].damping / fold.value), 1e-9);
    /* SA ends upwards, LA downwards. */
    assert_true(cases[i].which == 0 ? fold.curvature < 0.0 : fold.curvature > 0.0);
  }
  pendres_context_free(ctx);
}

/* The curvature predicts the orbits beside the fold: omega - fold = curvature s^2 / 2. */
static void curvature_predicts_orbits(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-11, PENDRES_TABLE_DEFAULT);
  const pendres_orbit near = orbit_of(ctx, 0.13, 0.2, 0.8, 0);
  pendres_fold fold;
  check_ok(pendres_fold_find(ctx, &near, &fold));
  double last = 0.0;
  for (int i = 0; i < 2; i++) {
    const double away = i == 0 ? 1e-5 : 1e-7;
    const pendres_orbit o = orbit_of(ctx, 0.13, 0.2, fold.value - away, 0);
    const double s = hypot(o.x - fold.orbit.x, o.v - fold.orbit.v);
    const double measured = -2.0 * away / (s * s);
    /* The next order is proportional to s: 10 times closer to the fold, 10 times smaller. */
    const double off = fabs(measured / fold.curvature - 1.0);
    assert_true(off < (i == 0 ? 0.1 : 0.2 * last));
    last = off;
  }
  pendres_context_free(ctx);
}

/* One point from two tolerances and two methods: the same within the stated errors. */
static void tolerances_and_methods_agree(void **state)
{
  (void)state;
  static const struct {
    double tolerance;
    pendres_table table;
  } ways[] = {{1e-5, PENDRES_TABLE_TP8},   {1e-7, PENDRES_TABLE_DOP853},
              {1e-8, PENDRES_TABLE_TSIT5}, {1e-9, PENDRES_TABLE_VERN9}};
  /* From the reference, 18 digits; see make_golden.c for how such numbers are made. */
  const double fold_want = 0.753512458983320393, frequency_want = 0.862157913509009358,
               damping_want = 0.163656902031172567;
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    pendres_context *ctx = context_of(ways[i].tolerance, ways[i].table);
    const pendres_orbit near = orbit_of(ctx, 0.13, 0.2, 0.8, 1);
    pendres_fold fold;
    pendres_cusp cusp;
    check_ok(pendres_fold_find(ctx, &near, &fold));
    check_near(fold.value, fold_want, fold.value_error);
    assert_true(fold.value_error <= ways[i].tolerance);
    check_ok(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp));
    check_near(cusp.value[0], frequency_want, fair * cusp.value_error[0]);
    check_near(cusp.value[1], damping_want, fair * cusp.value_error[1]);
    assert_true(cusp.value_error[1] <= ways[i].tolerance);
    pendres_context_free(ctx);
  }
}

/* Cusps for both drives of the paper: ten digits, and the reference's. */
static void cusps_match_reference(void **state)
{
  (void)state;
  static const struct {
    double drive, damping, frequency, paper;
  } cases[] = {{0.2, 0.13, 0.8, 0.164}, {0.1, 0.08, 0.88, 0.099}};
  pendres_context *ctx = context_of(1e-10, PENDRES_TABLE_DEFAULT);
  for (size_t i = 0; i < 2; i++) {
    const pendres_orbit near =
      orbit_of(ctx, cases[i].damping, cases[i].drive, cases[i].frequency, 0);
    pendres_fold fold;
    pendres_cusp cusp;
    pendres_reference_cycle want;
    check_ok(pendres_fold_find(ctx, &near, &fold));
    check_ok(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp));
    check_ok(pendres_reference_cusp(&near.pendulum, cusp.value[0], cusp.value[1],
                                    cusp.orbit.x - half_pi, cusp.orbit.v, &want));
    assert_true(cusp.value_error[0] <= 1e-10 && cusp.value_error[1] <= 1e-10);
    check_near(cusp.value[0], (double)want.drive_frequency, fair * cusp.value_error[0]);
    check_near(cusp.value[1], (double)want.damping, fair * cusp.value_error[1]);
    /* The paper's critical damping, to the digits that it prints. */
    check_near(cusp.value[1], cases[i].paper, 1e-3);
  }
  pendres_context_free(ctx);
}

/* A second route to the cusp that never solves for it: the distance between the two folds falls
   with the power 3/2 of the damping that is left, so its power 2/3 is smooth there. */
static void folds_approach_the_cusp(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-12, PENDRES_TABLE_DEFAULT);
  const double damping[4] = {0.1632, 0.1628, 0.1624, 0.1620};
  double power[4];
  for (int i = 0; i < 4; i++) {
    double value[2];
    /* From the one orbit of a higher damping's frequency both folds are near. */
    pendres_orbit o = orbit_of(ctx, damping[i], 0.2, 0.80, 0);
    pendres_fold sa, la;
    check_ok(pendres_fold_find(ctx, &o, &sa));
    o = orbit_of(ctx, damping[i], 0.2, 0.92, 0);
    check_ok(pendres_fold_find(ctx, &o, &la));
    value[0] = la.value;
    value[1] = sa.value;
    assert_true(value[1] > value[0]);
    power[i] = cbrt((value[1] - value[0]) * (value[1] - value[0]));
  }
  /* Where the cubic through the four vanishes: Neville's scheme for damping over the power. */
  double d[4];
  memcpy(d, damping, sizeof d);
  for (int k = 1; k < 4; k++)
    for (int i = 0; i + k < 4; i++)
      d[i] = (power[i + k] * d[i] - power[i] * d[i + 1]) / (power[i + k] - power[i]);
  /* The fourth-order term that is left, (0.0017)^4 times a coefficient of some thousand. */
  check_near(d[0], 0.163656902031172567, 2e-8);
  pendres_context_free(ctx);
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
  check_ok(pendres_branch_follow(ctx, 1, &start, &options, &b));
  assert_int_equal(pendres_branch_bifurcations(b), 2);
  assert_int_equal(pendres_branch_end_of(b, 0), PENDRES_END_RANGE);
  assert_int_equal(pendres_branch_end_of(b, 1), PENDRES_END_RANGE);
  check_near(pendres_branch_bifurcation(b, 0)->value, 0.844925197542337284, 1e-9);
  check_near(pendres_branch_bifurcation(b, 1)->value, 0.753512458983320393, 1e-9);
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
  check_ok(pendres_branch_follow(ctx, 1, &start, &options, &b));
  check_ok(pendres_branch_cross(ctx, b, 0.8, 4, there, &found));
  assert_int_equal(found, 3);
  for (size_t i = 0; i < 3; i++) {
    pendres_reference_cycle want;
    assert_int_equal(there[i].stable, i != 1);
    check_ok(pendres_reference_orbit(&there[i].pendulum, there[i].x - half_pi, there[i].v, 1, 0,
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

/* LA at small damping ends by losing its symmetry; the pair that is born doubles its period. */
static void symmetry_breaks_and_period_doubles(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit la = orbit_of(ctx, 0.12, 0.2, 0.78, 1);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.4, .high = 0.9};
  pendres_branch *b = NULL, *pair = NULL;
  check_ok(pendres_branch_follow(ctx, 1, &la, &options, &b));
  assert_int_equal(pendres_branch_bifurcations(b), 1);
  const pendres_bifurcation *at = pendres_branch_bifurcation(b, 0);
  assert_int_equal(at->kind, PENDRES_SYMMETRY_BREAKING);
  pendres_reference_cycle want;
  check_ok(pendres_reference_symmetry_breaking(&la.pendulum, at->value, at->orbit.x - half_pi,
                                               at->orbit.v, &want));
  check_near(at->value, (double)want.drive_frequency, fair * at->value_error);

  pendres_orbit lopsided;
  check_ok(pendres_branch_switch(ctx, at, &lopsided));
  assert_false(lopsided.symmetric);
  assert_int_equal(lopsided.period, 1);
  check_ok(pendres_branch_follow(ctx, 1, &lopsided, &options, &pair));
  /* Down to the doubling on one side, through the birth, and the mirror image on the other. */
  assert_int_equal(pendres_branch_bifurcations(pair), 3);
  const pendres_bifurcation *first = pendres_branch_bifurcation(pair, 0);
  const pendres_bifurcation *birth = pendres_branch_bifurcation(pair, 1);
  const pendres_bifurcation *last = pendres_branch_bifurcation(pair, 2);
  assert_int_equal(birth->kind, PENDRES_SYMMETRY_BREAKING);
  check_near(birth->value, at->value, birth->value_error + at->value_error);
  assert_int_equal(first->kind, PENDRES_PERIOD_DOUBLING);
  assert_int_equal(last->kind, PENDRES_PERIOD_DOUBLING);
  /* Mirror images double together. */
  check_near(first->value, last->value, first->value_error + last->value_error);
  pendres_pendulum p = la.pendulum;
  p.drive_frequency = first->value;
  check_ok(pendres_reference_orbit(&p, first->orbit.x - half_pi, first->orbit.v, 1, 0, &want));
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
static void check_packing(const pendres_branches *set)
{
  const size_t size = pendres_branches_packed_size(set);
  char *bytes = malloc(size + 1), *again = malloc(size);
  pendres_branches *copy = NULL;
  assert_true(bytes != NULL && again != NULL);
  bytes[size] = 0;
  pendres_branches_pack(set, bytes);
  check_ok(pendres_branches_unpack(size, bytes, &copy));
  assert_int_equal(pendres_branches_packed_size(copy), size);
  assert_int_equal(pendres_branches_count(copy), pendres_branches_count(set));
  pendres_branches_pack(copy, again);
  assert_memory_equal(bytes, again, size);
  pendres_branches_free(copy);
  for (size_t wrong = 0; wrong <= size + 1; wrong += wrong < size - 1 ? size / 7 + 1 : 1) {
    if (wrong == size) continue;
    assert_int_equal(pendres_branches_unpack(wrong, bytes, &copy), PENDRES_INVALID_ARGUMENT);
    assert_null(copy);
  }
  free(bytes);
  free(again);
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
  assert_int_equal(pendres_branch_end_of(b, 0), PENDRES_END_CLOSED);
  double low = INFINITY, high = 0.0;
  int folds = 0;
  for (size_t i = 0; i < pendres_branch_bifurcations(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation(b, i);
    if (f->kind != PENDRES_FOLD) continue;
    folds++;
    low = fmin(low, f->value);
    high = fmax(high, f->value);
    pendres_reference_image want;
    const long double y = f->orbit.x - half_pi, v = f->orbit.v;
    check_ok(pendres_reference_map(&f->orbit.pendulum, y, v, 1, &want));
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
  assert_int_equal(pendres_branch_bifurcations(away), 2);
  assert_int_equal(pendres_branch_bifurcation(away, 0)->kind, PENDRES_SYMMETRY_BREAKING);
  const pendres_bifurcation *f = pendres_branch_bifurcation(away, 1);
  assert_int_equal(f->kind, PENDRES_FOLD);
  pendres_reference_cycle want;
  check_ok(pendres_reference_fold(&f->orbit.pendulum, f->value, f->orbit.x - half_pi, f->orbit.v,
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
  pendres_reference_cycle want;
  size_t found = 0;
  check_ok(pendres_fold_find(ctx, &near, &fold));
  check_ok(pendres_curve_follow(ctx, 1, &fold, &wide, &c));
  check_ok(pendres_curve_cross(ctx, c, 0.13, 4, at, &found));
  assert_int_equal(found, 3);
  check_ok(pendres_branch_follow(ctx, 1, &at[0].orbit, &options, &b));
  assert_int_equal(pendres_branch_bifurcations(b), 2);
  const pendres_bifurcation *end = pendres_branch_bifurcation(b, 0);
  const pendres_bifurcation *again = pendres_branch_bifurcation(b, 1);
  assert_int_equal(end->kind, PENDRES_SYMMETRY_BREAKING);
  check_ok(pendres_reference_symmetry_breaking(&end->orbit.pendulum, end->value,
                                               end->orbit.x - half_pi, end->orbit.v, &want));
  check_near(end->value, (double)want.drive_frequency, fair * end->value_error);
  assert_int_equal(again->kind, PENDRES_FOLD);
  check_near(again->value, at[0].value, again->value_error + at[0].value_error);
  pendres_branch_free(b);
  pendres_curve_free(c);
  pendres_context_free(ctx);
}

/* The curve of folds from damping 0.06 over the cusp and down the other side. */
static void fold_curve_passes_the_cusp(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit near = orbit_of(ctx, 0.15, 0.2, 0.845, 0);
  const pendres_curve_options options = {
    .second = PENDRES_DAMPING, .low = {0.5, 0.06}, .high = {1.2, 1.0}};
  pendres_fold fold;
  pendres_curve *c = NULL;
  check_ok(pendres_fold_find(ctx, &near, &fold));
  check_ok(pendres_curve_follow(ctx, 1, &fold, &options, &c));
  assert_int_equal(pendres_curve_kind(c), PENDRES_FOLD);
  assert_int_equal(pendres_curve_cusps(c), 1);
  check_near(pendres_curve_cusp(c, 0)->value[1], 0.163656902031172567, 1e-9);
  for (size_t i = 0; i < pendres_curve_count(c); i++) {
    const pendres_curve_point *p = pendres_curve_get(c, i);
    assert_true(p->value_error[0] <= 1e-9 && p->value_error[1] <= 1e-9);
    check_near(p->orbit.multiplier_re[0], 1.0, 1e-6);
    assert_true(p->value[1] <= 0.1636569020312 + 1e-9);
  }
  /* Single points of it by the other function, and by the reference. */
  static const double dampings[] = {0.06, 0.13, 0.1636};
  static const size_t expected[] = {1, 2, 2};
  for (size_t i = 0; i < 3; i++) {
    pendres_bifurcation at[4];
    size_t found = 0;
    check_ok(pendres_curve_cross(ctx, c, dampings[i], 4, at, &found));
    assert_int_equal(found, expected[i]);
    for (size_t k = 0; k < found; k++) {
      pendres_reference_cycle want;
      check_ok(pendres_reference_fold(&at[k].orbit.pendulum, at[k].value,
                                      at[k].orbit.x - half_pi, at[k].orbit.v, &want));
      check_near(at[k].value, (double)want.drive_frequency, fair * at[k].value_error);
    }
  }
  pendres_curve_free(c);
  pendres_context_free(ctx);
}

/*
 * LA's curve of folds has a lowest damping, 0.12228752, where it turns back between two of its points.
 * Just above, both folds are there, however close; just below, neither. Their distance grows with the
 * square root of the damping: from 1.8e-9 above the turn, at 1.56e-4, and so on.
 */
static void a_turn_of_a_curve_has_both_sides(void **state)
{
  (void)state;
  static const double above[] = {0.12228752, 0.1222876, 0.12229, 0.1224};
  pendres_context *ctx = context_of(1e-11, PENDRES_TABLE_DEFAULT);
  const pendres_orbit near = orbit_of(ctx, 0.13, 0.2, 0.8, 1);
  const pendres_curve_options options = {
    .second = PENDRES_DAMPING, .low = {0.5, 0.06}, .high = {0.8, 1.0}};
  pendres_fold fold;
  pendres_curve *c = NULL;
  pendres_bifurcation at[4];
  size_t found = 0;
  check_ok(pendres_fold_find(ctx, &near, &fold));
  check_ok(pendres_curve_follow(ctx, 1, &fold, &options, &c));
  for (size_t i = 0; i < sizeof above / sizeof *above; i++) {
    check_ok(pendres_curve_cross(ctx, c, above[i], 4, at, &found));
    assert_int_equal(found, 2);
    /* Square of the distance: 13.68 a unit of damping, to the next order, some per mille here. */
    const double apart = at[1].value - at[0].value;
    check_relative(apart * apart, 13.68 * (above[i] - 0.12228751823), 0.02);
    for (int k = 0; k < 2; k++) {
      pendres_reference_cycle want;
      check_ok(pendres_reference_fold(&at[k].orbit.pendulum, at[k].value, at[k].orbit.x - half_pi,
                                      at[k].orbit.v, &want));
      check_near(at[k].value, (double)want.drive_frequency, fair * at[k].value_error);
    }
  }
  check_ok(pendres_curve_cross(ctx, c, 0.1222875, 4, at, &found));
  assert_int_equal(found, 0);
  pendres_curve_free(c);
  pendres_context_free(ctx);
}

/* The curve of symmetry breakings, in damping and drive amplitude too. */
static void symmetry_breakings_follow_parameters(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8, PENDRES_TABLE_DEFAULT);
  const pendres_orbit la = orbit_of(ctx, 0.12, 0.2, 0.6, 1);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.45, .high = 0.7};
  const pendres_curve_options both = {
    .second = PENDRES_DRIVE_AMPLITUDE, .low = {0.4, 0.18}, .high = {0.7, 0.22}};
  pendres_branch *b = NULL;
  pendres_curve *c = NULL;
  check_ok(pendres_branch_follow(ctx, 1, &la, &options, &b));
  assert_int_equal(pendres_branch_bifurcations(b), 1);
  check_ok(pendres_curve_follow(ctx, 1, pendres_branch_bifurcation(b, 0), &both, &c));
  assert_int_equal(pendres_curve_kind(c), PENDRES_SYMMETRY_BREAKING);
  const size_t n = pendres_curve_count(c);
  assert_true(n >= 3);
  for (size_t i = 0; i < n; i += n - 1) {
    const pendres_curve_point *p = pendres_curve_get(c, i);
    pendres_reference_cycle want;
    check_ok(pendres_reference_symmetry_breaking(&p->orbit.pendulum, p->value[0],
                                                 p->orbit.x - half_pi, p->orbit.v, &want));
    check_near(p->value[0], (double)want.drive_frequency, 2e-8);
  }
  pendres_curve_free(c);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* In damping and in the drive amplitude branches pass the same orbits as in the frequency. */
static void other_parameters_lead_to_the_same_orbits(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit from = orbit_of(ctx, 0.13, 0.2, 0.82, 0), to = orbit_of(ctx, 0.11, 0.2, 0.82, 0);
  const pendres_orbit weak = orbit_of(ctx, 0.13, 0.15, 0.82, 0);
  const pendres_branch_options damping = {.parameter = PENDRES_DAMPING, .low = 0.1, .high = 0.2};
  const pendres_branch_options drive = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 0.1, .high = 0.3};
  pendres_branch *b = NULL;
  pendres_orbit there[4];
  size_t found = 0;
  check_ok(pendres_branch_follow(ctx, 1, &from, &damping, &b));
  check_ok(pendres_branch_cross(ctx, b, 0.11, 4, there, &found));
  assert_true(found >= 1);
  check_near(there[0].amplitude, to.amplitude, there[0].amplitude_error + to.amplitude_error);
  pendres_branch_free(b);
  check_ok(pendres_branch_follow(ctx, 1, &from, &drive, &b));
  check_ok(pendres_branch_cross(ctx, b, 0.15, 4, there, &found));
  assert_true(found >= 1);
  check_near(there[0].amplitude, weak.amplitude, there[0].amplitude_error + weak.amplitude_error);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* What is found does not depend on who is followed beside it, nor on the size of blocks. */
static void branches_do_not_depend_on_neighbours(void **state)
{
  (void)state;
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.7, .high = 0.9};
  pendres_context *wide = NULL, *narrow = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &wide));
  check_ok(
    pendres_context_create(&(pendres_options){.tolerance = 1e-8, .block_lanes = 8}, &narrow));
  const pendres_orbit starts[2] = {orbit_of(wide, 0.13, 0.2, 0.8, 0),
                                   orbit_of(wide, 0.14, 0.2, 0.83, 1)};
  pendres_branch *alone = NULL, *together[2] = {NULL, NULL};
  check_ok(pendres_branch_follow(narrow, 1, &starts[1], &options, &alone));
  check_ok(pendres_branch_follow(wide, 2, starts, &options, together));
  assert_int_equal(pendres_branch_count(alone), pendres_branch_count(together[1]));
  for (size_t i = 0; i < pendres_branch_count(alone); i++) {
    const pendres_orbit *a = &pendres_branch_get(alone, i)->orbit;
    const pendres_orbit *b = &pendres_branch_get(together[1], i)->orbit;
    assert_memory_equal(&a->x, &b->x, sizeof a->x);
    assert_memory_equal(&a->pendulum, &b->pendulum, sizeof a->pendulum);
    assert_memory_equal(&a->loop_area_error, &b->loop_area_error, sizeof a->loop_area_error);
  }
  pendres_branch_free(alone);
  pendres_branch_free(together[0]);
  pendres_branch_free(together[1]);
  pendres_context_free(wide);
  pendres_context_free(narrow);
}

/* The backbone: a lag of pi/2 by the reference; the linear limit, where it is at frequency 1. */
static void backbone_lags_by_a_quarter(void **state)
{
  (void)state;
  const pendres_pendulum p[4] = {{.damping = 0.2, .drive_amplitude = 0.2},
                                 {.damping = 0.7, .drive_amplitude = 0.2},
                                 {.damping = 0.3, .drive_amplitude = 1e-5},
                                 {.damping = 0.05, .drive_amplitude = 0.2}};
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  pendres_orbit o[4];
  double error[4];
  pendres_status outcome[4];
  check_ok(pendres_backbone_find(ctx, 4, p, o, error, outcome));
  for (int i = 0; i < 3; i++) {
    pendres_reference_cycle want;
    assert_int_equal(outcome[i], PENDRES_OK);
    check_ok(pendres_reference_orbit(&o[i].pendulum, o[i].x - half_pi, o[i].v, 1, 0, &want));
    /* The lag falls off pi/2 by at most its slope, here below 20, times the frequency's error. */
    check_near((double)want.phase_lag, half_pi, 20.0 * error[i] + o[i].phase_lag_error);
  }
  check_near(o[2].pendulum.drive_frequency, 1.0, 1e-9);
  /* gamma omega R stays below F0 whatever the amplitude: the drive cannot be met. */
  assert_int_equal(outcome[3], PENDRES_NOT_FOUND);
  pendres_context_free(ctx);
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
  assert_int_equal(pendres_fold_find(ctx, &single, &fold), PENDRES_NOT_FOUND);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  assert_int_equal(pendres_fold_find(NULL, &single, &fold), PENDRES_INVALID_ARGUMENT);
  const pendres_branch_options empty = {.low = 0.9, .high = 0.8};
  assert_int_equal(pendres_branch_follow(ctx, 1, &single, &empty, &b), PENDRES_INVALID_ARGUMENT);
  assert_null(b);
  pendres_orbit nowhere = single;
  nowhere.x += 1.0;
  nowhere.v += 40.0;
  const pendres_branch_options range = {.low = 0.5, .high = 1.0};
  assert_int_equal(pendres_branch_follow(ctx, 1, &nowhere, &range, &b), PENDRES_NOT_CONVERGED);
  assert_null(b);
  fold = (pendres_fold){.kind = PENDRES_REGULAR, .orbit = single};
  const pendres_curve_options second = {
    .second = PENDRES_DAMPING, .low = {0.5, 0.1}, .high = {1.0, 0.5}};
  assert_int_equal(pendres_curve_follow(ctx, 1, &fold, &second, &c), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_branch_switch(ctx, &fold, &o), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(folds_match_reference),
    cmocka_unit_test(a_fold_is_not_known_better_than_its_point),
    cmocka_unit_test(curvature_predicts_orbits),
    cmocka_unit_test(tolerances_and_methods_agree),
    cmocka_unit_test(cusps_match_reference),
    cmocka_unit_test(folds_approach_the_cusp),
    cmocka_unit_test(branch_is_an_s),
    cmocka_unit_test(branch_crosses_at_three_orbits),
    cmocka_unit_test(symmetry_breaks_and_period_doubles),
    cmocka_unit_test(running_orbits_make_an_isola),
    cmocka_unit_test(ensemble_finds_the_branch_born_away),
    cmocka_unit_test(branches_start_at_folds),
    cmocka_unit_test(fold_curve_passes_the_cusp),
    cmocka_unit_test(a_turn_of_a_curve_has_both_sides),
    cmocka_unit_test(symmetry_breakings_follow_parameters),
    cmocka_unit_test(other_parameters_lead_to_the_same_orbits),
    cmocka_unit_test(branches_do_not_depend_on_neighbours),
    cmocka_unit_test(backbone_lags_by_a_quarter),
    cmocka_unit_test(mistakes_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
