/*
 * test_phase_curves.c -- what curves through other dampings tell of a phase diagram, and whole
 * diagrams.
 */
#include "phase_diagram_fixture.h"

#include "oracle.h"
#include "analysis/phase_diagram/line.h"
#include "continuation/sets.h"

/* ---- what curves through other dampings know ---- */

static line line_of(pendres_context *ctx, double drive, double damping, double from, double step)
{
  pendres_pendulum p[DRIVES];
  line l;
  for (int i = 0; i < DRIVES; i++)
    p[i] = (pendres_pendulum){
      .damping = damping, .drive_amplitude = drive, .drive_frequency = from + step * i};
  memset(&l, 0, sizeof l);
  check_ok(pendres_phase_line(ctx, DRIVES, p, with(members()), l.points, &l.branches));
  return l;
}

/* The curves of a line's bifurcations. */
static pendres_curves *curves_of(pendres_context *ctx, const line *l)
{
  const pendres_curve_options options = {
    .second = PENDRES_DAMPING, .low = {0.28, 0.06}, .high = {1.1, 1.0}};
  pendres_curves *curves = NULL;
  pendres_bifurcation all[32];
  size_t n = 0;
  for (size_t i = 0; i < pendres_branches_count(l->branches); i++) {
    const pendres_branch *b = pendres_branches_get(l->branches, i);
    for (size_t k = 0; k < pendres_branch_bifurcation_count(b); k++) {
      assert_true(n < sizeof all / sizeof *all);
      all[n++] = *pendres_branch_bifurcation_get(b, k);
    }
  }
  check_ok(pendres_curves_find(ctx, n, all, &options, &curves));
  return curves;
}

static void complete(pendres_context *ctx, const pendres_curves *curves, line *l)
{
  check_ok(
    pendres_phase_line_complete(ctx, DRIVES, curves, with(members()), l->points, l->branches));
}

/*
 * At damping 0.13 there is a second piece of LA that does not join SA's branch; it attracts from
 * where it has its mirror symmetry, 0.41063921, to a fold at 0.43198651. None of 200 members comes
 * to it. The curve of folds goes from the line's own folds through lower dampings back to it.
 */
static void curves_tell_what_members_miss(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-9);
  line l = line_of(ctx, 0.2, 0.13, 0.40, 0.01);
  const line before = l;
  for (int i = 0; i < DRIVES; i++) assert_int_equal(l.points[i].exact, PENDRES_REGIME_SA);
  assert_int_equal(pendres_branches_count(l.branches), 1);
  pendres_curves *curves = curves_of(ctx, &l);
  complete(ctx, curves, &l);
  assert_int_equal(pendres_branches_count(l.branches), 2);
  for (int i = 0; i < DRIVES; i++) {
    const pendres_phase_point *p = &l.points[i], *q = &before.points[i];
    if (i == 2 || i == 3) { /* 0.42 and 0.43 */
      assert_int_equal(p->exact, PENDRES_REGIME_COEXISTENCE);
      assert_int_equal(p->regime, PENDRES_REGIME_SA);
      check_near(p->sa_amplitude, q->sa_amplitude, 0.0);
      assert_true(p->la_amplitude > 2.9 && p->la_amplitude_error <= 1e-9);
    } else {
      assert_memory_equal(p, q, sizeof *p);
    }
  }

  /* Both ends by the reference, which is good to 15 digits. */
  const pendres_branch *b = pendres_branches_get(l.branches, 1);
  assert_int_equal(pendres_branch_bifurcation_count(b), 2);
  for (int i = 0; i < 2; i++) {
    const pendres_bifurcation *at = pendres_branch_bifurcation_get(b, (size_t)i);
    const pendres_pendulum *p = &at->orbit.pendulum;
    const long double y = at->orbit.x - 1.57079632679489661923L, v = at->orbit.v;
    reference_cycle want;
    assert_int_equal(at->kind, i == 0 ? PENDRES_SYMMETRY_BREAKING : PENDRES_FOLD);
    check_near(at->value, i == 0 ? 0.41063921 : 0.43198651, 5e-9);
    if (i == 0) check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, p,
                                                &(reference_guess){at->value, y, v, 0.0L},
                                                &want));
    else check_ok(reference_find(REFERENCE_FOLD, p,
                                         &(reference_guess){at->value, y, v, 0.0L}, &want));
    check_near(at->value, (double)want.drive_frequency, 10.0 * at->value_error);
    assert_true(at->value_error <= 1e-9);
  }

  /* Of 5000 members a few find it: the same orbit. */
  pendres_ensemble dense = *members();
  pendres_phase_point seen;
  dense.members = 5000;
  check_ok(pendres_phase_line(ctx, 1, &l.points[2].pendulum, with(&dense), &seen, NULL));
  assert_int_equal(seen.regime, PENDRES_REGIME_COEXISTENCE);
  assert_true(seen.la_fraction > 0.0 && seen.la_fraction < 0.005);
  check_near(seen.la_amplitude, l.points[2].la_amplitude,
             seen.la_amplitude_error + l.points[2].la_amplitude_error);

  /* Nothing is added twice. */
  complete(ctx, curves, &l);
  assert_int_equal(pendres_branches_count(l.branches), 2);
  pendres_curves_free(curves);
  pendres_branches_free(l.branches);
  pendres_context_free(ctx);
}

/* Neighbours of it: what members reach, or what does not exist, stays as it was. */
static void curves_change_nothing_else(void **state)
{
  (void)state;
  static const double damping[] = {0.12, 0.125, 0.14};
  pendres_context *ctx = context_of(1e-8);
  line source = line_of(ctx, 0.2, 0.13, 0.40, 0.01);
  pendres_curves *curves = curves_of(ctx, &source);
  for (int k = 0; k < 3; k++) {
    line l = line_of(ctx, 0.2, damping[k], 0.40, 0.01);
    const line before = l;
    complete(ctx, curves, &l);
    for (int i = 0; i < DRIVES; i++)
      assert_memory_equal(&l.points[i], &before.points[i], sizeof l.points[i]);
    pendres_branches_free(l.branches);
  }
  pendres_branches_free(source.branches);
  pendres_curves_free(curves);
  pendres_context_free(ctx);
}

/* Where LA goes on below SA's fold, its branch alone does not show that there are two states: at
   high frequencies its members are LA nevertheless. */
static void curves_tell_where_sa_ends(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  line source = line_of(ctx, 0.2, 0.13, 0.90, 0.02), weak = line_of(ctx, 0.2, 0.1, 0.90, 0.02);
  pendres_curves *curves = curves_of(ctx, &source);
  for (int i = 0; i < DRIVES; i++) assert_int_equal(weak.points[i].exact, PENDRES_REGIME_SINGLE);
  complete(ctx, curves, &weak);
  for (int i = 0; i < DRIVES; i++) {
    assert_int_equal(weak.points[i].exact, PENDRES_REGIME_LA);
    assert_int_equal(weak.points[i].regime, PENDRES_REGIME_LA);
    check_near(weak.points[i].la_fraction, 1.0, 0.0);
  }
  /* Curves of other pendulums are refused. */
  for (int i = 0; i < DRIVES; i++) weak.points[i].pendulum.drive_amplitude = 0.19;
  assert_int_equal(pendres_phase_line_complete(ctx, DRIVES, curves, with(members()), weak.points,
                                               weak.branches),
                   PENDRES_INVALID_ARGUMENT);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  assert_int_equal(
    pendres_phase_line_complete(ctx, DRIVES, curves, with(members()), weak.points, NULL),
    PENDRES_INVALID_ARGUMENT);
  pendres_curves_free(curves);
  pendres_branches_free(source.branches);
  pendres_branches_free(weak.branches);
  pendres_context_free(ctx);
}

/* For stronger drives the second piece reaches beyond the cusp (for 0.45 to damping 0.315, the cusp
   is at 0.310): its fold is none at which a small orbit ends, and states have no names there. */
static void above_the_cusp_there_is_no_distinction(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-7);
  line source = line_of(ctx, 0.45, 0.29, 0.36, 0.09), above = line_of(ctx, 0.45, 0.312, 0.36, 0.09);
  const line before = above;
  const size_t count = pendres_branches_count(above.branches);
  pendres_curves *curves = curves_of(ctx, &source);
  complete(ctx, curves, &above);
  assert_true(pendres_branches_count(above.branches) > count);
  for (int i = 0; i < DRIVES; i++) {
    assert_int_equal(before.points[i].exact, PENDRES_REGIME_SINGLE);
    assert_memory_equal(&above.points[i], &before.points[i], sizeof before.points[i]);
  }
  pendres_curves_free(curves);
  pendres_branches_free(source.branches);
  pendres_branches_free(above.branches);
  pendres_context_free(ctx);
}

/* All tasks of a round, from the last to the first. What one has made is refused if a byte of it is
   missing; if `torn`, at other places too. */
static void do_round(pendres_context *ctx, pendres_phase_diagram *d, size_t tasks, int torn)
{
  for (size_t i = tasks; i-- > 0;) {
    size_t size;
    void *bytes;
    check_ok(pendres_phase_diagram_work(ctx, d, i, &size, &bytes));
    for (size_t part = torn ? 0 : size - 1; part < size; part += 1 + size / 50)
      assert_int_equal(pendres_phase_diagram_take(d, i, part, bytes), PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_phase_diagram_take(d, i, size - 1, bytes), PENDRES_INVALID_ARGUMENT);
    check_ok(pendres_phase_diagram_take(d, i, size, bytes));
    free(bytes);
  }
}

/* One call, and its pieces with another context, give the same bytes; the folds and the cusp are
   those of the reference. */
static void whole_diagrams(void **state)
{
  (void)state;
  enum { LINES = 2, VALUES = 2 };
  const double damping[LINES] = {0.13, 0.17}, frequency[VALUES] = {0.8, 0.86};
  pendres_phase_grid grid = {.pendulum = {.drive_amplitude = 0.2},
                             .options = *with(members()),
                             .values = VALUES, .value = frequency,
                             .across = PENDRES_DAMPING,
                             .lines = LINES, .line_value = damping};
  grid.options.ensemble.members = 20;
  pendres_context *ctx = context_of(1e-8), *other = context_of(1e-8);
  pendres_phase_diagram *whole = NULL, *parts = NULL;
  pendres_phase_round round;
  int rounds = 0;
  check_ok(pendres_phase_diagram_find(ctx, &grid, &whole));
  check_ok(pendres_phase_diagram_create(&grid, &parts));
  for (;; rounds++) {
    check_ok(pendres_phase_diagram_next(parts, &round));
    if (round.tasks == 0) break;
    do_round(other, parts, round.tasks, 1);
  }
  assert_int_equal(round.work, PENDRES_PHASE_DONE);
  assert_true(rounds >= 3);
  for (size_t i = 0; i < LINES * VALUES; i++) {
    const pendres_phase_point *p = pendres_phase_diagram_point_get(whole, i);
    assert_memory_equal(p, pendres_phase_diagram_point_get(parts, i), sizeof *p);
    assert_int_equal(pendres_phase_diagram_outcome_get(whole, i, NULL), PENDRES_OK);
    assert_int_equal(p->regime, i == 0   ? PENDRES_REGIME_COEXISTENCE
                                : i == 1 ? PENDRES_REGIME_LA
                                         : PENDRES_REGIME_SINGLE);
  }
  const pendres_cusp *cusp = pendres_phase_diagram_get(whole).cusp;
  check_near(cusp->value[1], cusp_damping, cusp->value_error[1] + 1e-15);
  check_near(cusp->value[0], cusp_frequency, cusp->value_error[0] + 1e-15);
  const pendres_bifurcation *sa = pendres_phase_diagram_fold_get(whole, 0, PENDRES_LABEL_SA);
  const pendres_bifurcation *la = pendres_phase_diagram_fold_get(whole, 0, PENDRES_LABEL_LA);
  check_near(sa->value, sa_fold, sa->value_error + 1e-15);
  check_near(la->value, la_fold, la->value_error + 1e-15);
  assert_null(pendres_phase_diagram_fold_get(whole, 1, PENDRES_LABEL_SA));
  pendres_phase_diagram_free(whole);
  pendres_phase_diagram_free(parts);
  pendres_context_free(ctx);
  pendres_context_free(other);
}

/* Families know nothing of each other, and are taken from the last to the first; together they have
   the curves that are found one after another, in the same order and to the same bytes. */
static void families_make_the_same_curves(void **state)
{
  (void)state;
  const double damping[] = {0.0768, 0.0782919}, frequency[] = {0.616, 0.6482, 0.7};
  pendres_phase_grid grid = {.pendulum = {.drive_amplitude = 0.2}, .options = *with(members()),
                             .values = 3, .value = frequency,
                             .across = PENDRES_DAMPING, .lines = 2, .line_value = damping};
  pendres_curve_options options = {.second = PENDRES_DAMPING};
  pendres_context *ctx = context_of(1e-8);
  pendres_phase_diagram *d = NULL;
  pendres_curves *want = NULL;
  pendres_phase_round round;
  size_t size;
  void *bytes;
  check_ok(pendres_phase_diagram_create(&grid, &d));
  check_ok(pendres_phase_diagram_next(d, &round));
  assert_true(round.work == PENDRES_PHASE_LINES && round.tasks == 2);
  do_round(ctx, d, round.tasks, 0);
  check_ok(pendres_phase_diagram_next(d, &round));
  assert_int_equal(round.work, PENDRES_PHASE_CURVES);
  const size_t families = round.tasks;
  /* None may be taken twice, and the next round waits for all. */
  check_ok(pendres_phase_diagram_work(ctx, d, 0, &size, &bytes));
  check_ok(pendres_phase_diagram_take(d, 0, size, bytes));
  assert_int_equal(pendres_phase_diagram_take(d, 0, size, bytes), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_next(d, &round), PENDRES_INVALID_ARGUMENT);
  free(bytes);
  for (size_t i = families; i-- > 1;) {
    check_ok(pendres_phase_diagram_work(ctx, d, i, &size, &bytes));
    for (size_t torn = 0; torn < size; torn += 1 + size / 50)
      assert_int_equal(pendres_phase_diagram_take(d, i, torn, bytes), PENDRES_INVALID_ARGUMENT);
    check_ok(pendres_phase_diagram_take(d, i, size, bytes));
    free(bytes);
  }
  pendres_phase_reach(PENDRES_DRIVE_FREQUENCY, 1, frequency[0], frequency[2],
                      &options.low[0], &options.high[0]);
  pendres_phase_reach(PENDRES_DAMPING, 1, damping[0], damping[1],
                      &options.low[1], &options.high[1]);
  const pendres_phase_curves of = pendres_phase_diagram_get(d);
  const pendres_curves *found = of.curves;
  check_ok(pendres_curves_find(ctx, of.bifurcations, of.bifurcation, &options, &want));
  assert_int_equal(pendres_curves_count(found), pendres_curves_count(want));
  assert_true(pendres_curves_count(found) > families && families > 3);
  for (size_t i = 0; i < pendres_curves_count(want); i++) {
    const pendres_curve *a = pendres_curves_get(found, i), *b = pendres_curves_get(want, i);
    assert_int_equal(pendres_curve_count(a), pendres_curve_count(b));
    assert_int_equal(pendres_curve_kind_get(a), pendres_curve_kind_get(b));
    for (size_t k = 0; k < pendres_curve_count(a); k++) {
      const pendres_curve_point *p = pendres_curve_get(a, k), *q = pendres_curve_get(b, k);
      assert_int_equal(p->cusp, q->cusp);
      /* Between that and what follows there are bytes that belong to no member. */
      assert_memory_equal(&p->arclength, &q->arclength,
                          sizeof *p - offsetof(pendres_curve_point, arclength));
    }
  }
  pendres_curves_free(want);
  pendres_phase_diagram_free(d);
  pendres_context_free(ctx);
}

/*
 * A stiffening oscillator's resonance bends to higher frequencies: SA ends at the lower fold, and
 * beyond the upper one it is alone. Folds beside the oracle of tests/oracle.h, which is good to
 * 1e-14; beyond the cusp, at a damping of 0.2793, one state is left and has no name.
 */
static void stiffening_oscillator(void **state)
{
  (void)state;
  enum { FREQUENCIES = 4, DAMPINGS = 2 };
  const double damping[DAMPINGS] = {0.2, 0.3}, frequency[FREQUENCIES] = {1.0, 1.35, 1.6, 2.0};
  const pendres_regime want[FREQUENCIES] = {PENDRES_REGIME_LA, PENDRES_REGIME_COEXISTENCE,
                                            PENDRES_REGIME_SA, PENDRES_REGIME_SA};
  const pendres_phase_grid grid = {
    .pendulum = {.drive_amplitude = 0.3, .force = PENDRES_FORCE_POLYNOMIAL,
                 .force_coefficients = {1.0, 0.0, 1.0}},
    .options = {.ensemble = {.members = 20, .x_first = -2.0, .x_last = 2.0}},
    .values = FREQUENCIES, .value = frequency,
    .across = PENDRES_DAMPING, .lines = DAMPINGS, .line_value = damping};
  pendres_context *ctx = context_of(1e-9);
  pendres_phase_diagram *d = NULL;
  check_ok(pendres_phase_diagram_find(ctx, &grid, &d));
  for (size_t i = 0; i < FREQUENCIES; i++) {
    assert_int_equal(pendres_phase_diagram_point_get(d, i)->exact, want[i]);
    assert_int_equal(pendres_phase_diagram_point_get(d, i)->regime, want[i]);
    assert_int_equal(pendres_phase_diagram_point_get(d, FREQUENCIES + i)->exact,
                     PENDRES_REGIME_SINGLE);
  }
  for (int k = 0; k < 2; k++) {
    const pendres_label label = k == 0 ? PENDRES_LABEL_SA : PENDRES_LABEL_LA;
    const pendres_bifurcation *f = pendres_phase_diagram_fold_get(d, 0, label);
    oracle o = oracle_of(&f->orbit.pendulum);
    double left = NAN;
    const double value =
      oracle_bifurcation(&o, &o.omega, 1, 0, 1, f->orbit.x, f->orbit.v, &left);
    check_near(f->value, k == 0 ? 1.30304597 : 1.38385653, 1e-8);
    check_near(f->value, value, f->value_error + 1e-14);
    assert_true(left < 1e-14 && f->value_error < 1e-9);
    assert_int_equal(pendres_phase_diagram_ending_get(d, &f->orbit, f->curvature), label);
  }
  pendres_phase_diagram_free(d);
  pendres_context_free(ctx);
}

/* Of a resonance that is narrow beside its bend the largest amplitude is next to the upper fold,
   between points of the branch: LA ends there nevertheless, at the larger orbit of the two. */
static void narrow_tip(void **state)
{
  (void)state;
  enum { FREQUENCIES = 141 };
  const double damping = 2e-4;
  double frequency[FREQUENCIES];
  const pendres_phase_grid grid = {
    .pendulum = {.drive_amplitude = 1.621e-5, .force = PENDRES_FORCE_POLYNOMIAL,
                 .force_coefficients = {1.0, 0.0, 1.0}},
    .options = {.ensemble = {.members = 4, .x_first = -0.13, .x_last = 0.13}},
    .values = FREQUENCIES, .value = frequency,
    .across = PENDRES_DAMPING, .lines = 1, .line_value = &damping};
  for (int i = 0; i < FREQUENCIES; i++)
    frequency[i] = (1.199 + 0.007 * i / (FREQUENCIES - 1)) / 1.2;
  pendres_context *ctx = context_of(1e-8);
  pendres_phase_diagram *d = NULL;
  check_ok(pendres_phase_diagram_find(ctx, &grid, &d));
  const pendres_bifurcation *small = pendres_phase_diagram_fold_get(d, 0, PENDRES_LABEL_SA);
  const pendres_bifurcation *large = pendres_phase_diagram_fold_get(d, 0, PENDRES_LABEL_LA);
  assert_non_null(small);
  assert_non_null(large);
  assert_true(small->orbit.amplitude < 0.3 * large->orbit.amplitude && small->value < large->value);
  assert_int_equal(pendres_phase_diagram_ending_get(d, &small->orbit, small->curvature),
                   PENDRES_LABEL_SA);
  assert_int_equal(pendres_phase_diagram_ending_get(d, &large->orbit, large->curvature),
                   PENDRES_LABEL_LA);
  pendres_phase_diagram_free(d);
  pendres_context_free(ctx);
}

/* A point that is left out, or that cannot be computed, is marked, and the others are there. */
static void points_fail_alone(void **state)
{
  (void)state;
  const double damping[1] = {0.13}, frequency[3] = {2.3e-308, 0.7, 0.8};
  pendres_phase_grid grid = {.pendulum = {.drive_amplitude = 0.2},
                             .options = *with(members()),
                             .values = 3, .value = frequency,
                             .across = PENDRES_DAMPING,
                             .lines = 1, .line_value = damping};
  grid.options.ensemble.members = 4;
  pendres_context *ctx = context_of(1e-8);
  pendres_phase_diagram *d = NULL;
  pendres_phase_round round;
  const char *words = NULL;
  check_ok(pendres_phase_diagram_create(&grid, &d));
  check_ok(pendres_phase_diagram_leave_out(d, 1));
  check_ok(pendres_phase_diagram_next(d, &round));
  do_round(ctx, d, round.tasks, 0);
  assert_int_equal(pendres_phase_diagram_outcome_get(d, 0, &words), PENDRES_INVALID_ARGUMENT);
  assert_true(words != NULL && strlen(words) > 0);
  assert_int_equal(pendres_phase_diagram_outcome_get(d, 1, &words), PENDRES_UNSUPPORTED);
  assert_null(words);
  assert_int_equal(pendres_phase_diagram_outcome_get(d, 2, &words), PENDRES_OK);
  assert_true(isnan(pendres_phase_diagram_point_get(d, 0)->mean_loop_area));
  assert_true(isnan(pendres_phase_diagram_point_get(d, 1)->mean_loop_area));
  assert_true(pendres_phase_diagram_point_get(d, 2)->mean_loop_area > 0.0);
  pendres_phase_diagram_free(d);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(curves_tell_what_members_miss),
    cmocka_unit_test(curves_change_nothing_else),
    cmocka_unit_test(curves_tell_where_sa_ends),
    cmocka_unit_test(above_the_cusp_there_is_no_distinction),
    cmocka_unit_test(whole_diagrams),
    cmocka_unit_test(families_make_the_same_curves),
    cmocka_unit_test(stiffening_oscillator),
    cmocka_unit_test(narrow_tip),
    cmocka_unit_test(points_fail_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
