/*
 * test_phase_diagram.c -- regimes by scan and by curves, close to folds and to the cusp above all.
 *
 * Folds and cusp are those of the reference (test_continuation.c); what must hold beside them follows
 * from what a fold is: on one side both states, on the other one.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/phase_diagram.h>
#include <pendres/reference.h>

#include "check.h"

/* Damping 0.13, drive amplitude 0.2. */
static const double sa_fold = 0.844925197542337284, la_fold = 0.753512458983320393;
static const double cusp_damping = 0.163656902031172567, cusp_frequency = 0.862157913509009358;

static pendres_context *context_of(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* Lines along the drive frequency, with these members. */
static const pendres_phase_options *with(const pendres_ensemble *e)
{
  static pendres_phase_options o;
  o = (pendres_phase_options){.ensemble = *e};
  return &o;
}

static pendres_phase_point point_at(pendres_context *ctx, double damping, double frequency,
                                    size_t members)
{
  const pendres_pendulum p = {
    .damping = damping, .drive_amplitude = 0.2, .drive_frequency = frequency};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point point;
  e.members = members;
  check_ok(pendres_phase_line(ctx, 1, &p, with(&e), &point, NULL));
  return point;
}

static void names_are_the_files(void **state)
{
  (void)state;
  static const char *const names[] = {"sa", "la", "coexistence", "single", "other"};
  for (int i = 0; i < PENDRES_REGIME_COUNT; i++)
    assert_string_equal(pendres_regime_name((pendres_regime)i), names[i]);
  assert_null(pendres_regime_name(PENDRES_REGIME_COUNT));
}

/* The paper's Fig. 8 at damping 0.13, and above the cusp. */
static void regimes_of_the_paper(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  const pendres_pendulum line[5] = {{.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.6},
                                    {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.74},
                                    {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.80},
                                    {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.85},
                                    {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 1.0}};
  static const pendres_regime want[5] = {PENDRES_REGIME_SA, PENDRES_REGIME_SA,
                                         PENDRES_REGIME_COEXISTENCE, PENDRES_REGIME_LA,
                                         PENDRES_REGIME_LA};
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point points[5];
  pendres_branches *branches = NULL;
  check_ok(pendres_phase_line(ctx, 5, line, with(&e), points, &branches));
  assert_int_equal(pendres_branches_count(branches), 1);
  for (int i = 0; i < 5; i++) {
    const pendres_phase_point *p = &points[i];
    assert_int_equal(p->regime, want[i]);
    assert_int_equal(p->exact, want[i]);
    assert_int_equal(p->other, 0);
    assert_int_equal(p->unresolved, 0);
    check_near(p->sa_fraction + p->la_fraction, 1.0, 1e-15);
    assert_int_equal(isnan(p->sa_amplitude), want[i] == PENDRES_REGIME_LA);
    assert_int_equal(isnan(p->la_amplitude), want[i] == PENDRES_REGIME_SA);
    assert_true(p->mean_loop_area_error <= 1e-8);
  }
  /* The branch attracts up to SA's fold, and from LA's on. */
  pendres_branch_part part[3];
  const pendres_branch *b = pendres_branches_get(branches, 0);
  assert_int_equal(pendres_branch_parts(b, 3, part), 2);
  assert_int_equal(pendres_branch_parts(b, 0, NULL), 2);
  assert_true(part[0].begins == PENDRES_REGULAR && part[1].ends == PENDRES_REGULAR);
  assert_true(part[0].ends == PENDRES_FOLD && part[1].begins == PENDRES_FOLD);
  const double end = pendres_branch_get(b, part[0].last)->orbit.pendulum.drive_frequency;
  const double begin = pendres_branch_get(b, part[1].first)->orbit.pendulum.drive_frequency;
  check_near(end, sa_fold, 1e-8);
  check_near(begin, la_fold, 1e-8);
  /* An orbit with the phase lag of LA by the rule of pi/3, but on SA's side of its fold, is SA. */
  assert_int_equal(point_at(ctx, 0.163, 0.86, 50).regime, PENDRES_REGIME_SA);
  const pendres_phase_point above = point_at(ctx, 0.17, 0.86, 50);
  assert_int_equal(above.regime, PENDRES_REGIME_SINGLE);
  assert_int_equal(above.exact, PENDRES_REGIME_SINGLE);
  assert_true(isnan(above.sa_fraction) && isnan(above.la_amplitude));
  pendres_branches_free(branches);
  pendres_context_free(ctx);
}

/* LA at damping 0.08 ceases to attract at frequency 0.537944036 by losing its symmetry, not in a
   fold; the pair that is born there goes on below. */
static void branches_end_otherwise(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  const pendres_pendulum p = {.damping = 0.08, .drive_amplitude = 0.2, .drive_frequency = 0.65};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point point;
  pendres_branches *branches = NULL;
  e.members = 100;
  check_ok(pendres_phase_line(ctx, 1, &p, with(&e), &point, &branches));
  int seen = 0;
  for (size_t k = 0; k < pendres_branches_count(branches); k++) {
    const pendres_branch *b = pendres_branches_get(branches, k);
    pendres_branch_part part[8];
    const size_t n = pendres_branch_parts(b, 8, part);
    for (size_t i = 0; i < n && i < 8; i++)
      for (int side = 0; side < 2; side++) {
        const size_t at = side ? part[i].last : part[i].first;
        const double value = pendres_branch_get(b, at)->orbit.pendulum.drive_frequency;
        if ((side ? part[i].ends : part[i].begins) == PENDRES_SYMMETRY_BREAKING)
          seen += fabs(value - 0.537944036) < 1e-8;
      }
  }
  assert_true(seen > 0);
  pendres_branches_free(branches);
  pendres_context_free(ctx);
}

/* Close to a fold nothing is mislabelled: the ghost of a vanished orbit is not an attractor, and who
   lingers there is unresolved at worst. */
static void ghosts_are_not_attractors(void **state)
{
  (void)state;
  static const double away[] = {1e-6, 1e-9};
  pendres_context *ctx = context_of(1e-9);
  for (int i = 0; i < 2; i++) {
    const size_t members = i == 0 ? 100 : 25;
    const pendres_phase_point both = point_at(ctx, 0.13, sa_fold - away[i], members);
    const pendres_phase_point la = point_at(ctx, 0.13, sa_fold + away[i], members);
    assert_int_equal(both.exact, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(both.regime, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(la.exact, PENDRES_REGIME_LA);
    assert_int_equal(la.regime, PENDRES_REGIME_LA);
    assert_true(la.sa_fraction == 0.0 && isnan(la.sa_amplitude));
    /* All that went to SA before now go to LA, or are still on their way past the ghost. */
    check_near(la.la_fraction + la.la_fraction_error, 1.0, 1e-15);
    if (i == 0) assert_int_equal(la.unresolved, 0);

    const pendres_phase_point also = point_at(ctx, 0.13, la_fold + away[i], members);
    const pendres_phase_point sa = point_at(ctx, 0.13, la_fold - away[i], members);
    assert_int_equal(also.exact, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(sa.exact, PENDRES_REGIME_SA);
    assert_int_equal(sa.regime, PENDRES_REGIME_SA);
    assert_true(sa.la_fraction == 0.0 && isnan(sa.la_amplitude));
    check_near(sa.sa_fraction + sa.sa_fraction_error, 1.0, 1e-15);
  }
  pendres_context_free(ctx);
}

/* On both sides of the cusp, 1e-6 and 1e-9 away in damping. */
static void cusp_parts_the_regimes(void **state)
{
  (void)state;
  static const double away[] = {1e-6, 1e-9};
  pendres_context *ctx = context_of(1e-10);
  for (int i = 0; i < 2; i++) {
    const double below = cusp_damping - away[i], above = cusp_damping + away[i];
    assert_int_equal(point_at(ctx, below, cusp_frequency - 0.01, 20).regime, PENDRES_REGIME_SA);
    assert_int_equal(point_at(ctx, below, cusp_frequency + 0.01, 20).regime, PENDRES_REGIME_LA);
    assert_int_equal(point_at(ctx, above, cusp_frequency - 0.01, 20).regime, PENDRES_REGIME_SINGLE);
    assert_int_equal(point_at(ctx, above, cusp_frequency + 0.01, 20).regime, PENDRES_REGIME_SINGLE);
  }
  pendres_context_free(ctx);
}

/* A basin can exist and miss the line v = 0: LA at damping 0.124 a little below its highest
   frequency on the branch born away, where 200 members at rest all go to SA. */
static void basins_can_miss_the_members(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[12];
  pendres_phase_point points[12];
  const pendres_ensemble e = pendres_ensemble_default();
  for (int i = 0; i < 12; i++)
    line[i] = (pendres_pendulum){
      .damping = 0.124, .drive_amplitude = 0.2, .drive_frequency = 0.49 + 0.004 * i};
  check_ok(pendres_phase_line(ctx, 12, line, with(&e), points, NULL));
  int missed = 0;
  for (int i = 0; i < 12; i++) {
    /* Members never see more than exists. */
    if (points[i].regime == PENDRES_REGIME_COEXISTENCE)
      assert_int_equal(points[i].exact, PENDRES_REGIME_COEXISTENCE);
    const int miss =
      points[i].exact == PENDRES_REGIME_COEXISTENCE && points[i].regime == PENDRES_REGIME_SA;
    if (miss) assert_true(points[i].la_amplitude > 2.5 && points[i].la_fraction == 0.0);
    missed += miss;
  }
  assert_true(missed > 0);
  pendres_context_free(ctx);
}

/* What else lives there is told: LA's lopsided pair below its symmetry breaking. */
static void others_are_told(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[4];
  pendres_phase_point points[4];
  const pendres_ensemble e = pendres_ensemble_default();
  /* At damping 0.08 it breaks at 0.537944 and the pair doubles its period at 0.527712. */
  for (int i = 0; i < 4; i++)
    line[i] = (pendres_pendulum){
      .damping = 0.08, .drive_amplitude = 0.2, .drive_frequency = 0.530 + 0.003 * i};
  check_ok(pendres_phase_line(ctx, 4, line, with(&e), points, NULL));
  int told = 0;
  for (int i = 0; i < 4; i++) {
    /* The pair is one state, LA, beside SA. */
    const int pair = (points[i].other & PENDRES_OTHER_ASYMMETRIC) != 0;
    told += pair;
    if (pair) assert_true(points[i].exact == PENDRES_REGIME_COEXISTENCE);
    if (pair) assert_true(points[i].la_amplitude > 2.0 && points[i].la_fraction > 0.0);
    if (points[i].regime == PENDRES_REGIME_OTHER)
      assert_true((points[i].other & ~PENDRES_OTHER_ASYMMETRIC) != 0);
  }
  assert_true(told > 0);
  pendres_context_free(ctx);
}

/* ---- what curves through other dampings know ---- */

enum { DRIVES = 7 };

typedef struct line {
  pendres_phase_point points[DRIVES];
  pendres_branches *branches;
} line;

static const pendres_ensemble *members(void)
{
  static pendres_ensemble e;
  e = pendres_ensemble_default();
  return &e;
}

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
  check_ok(pendres_curves_find(ctx, 0, NULL, &options, &curves));
  for (size_t i = 0; i < pendres_branches_count(l->branches); i++) {
    const pendres_branch *b = pendres_branches_get(l->branches, i);
    if (pendres_branch_bifurcations(b) > 0)
      check_ok(pendres_curves_extend(ctx, pendres_branch_bifurcations(b),
                                     pendres_branch_bifurcation(b, 0), &options, curves));
  }
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
  assert_int_equal(pendres_branch_bifurcations(b), 2);
  for (int i = 0; i < 2; i++) {
    const pendres_bifurcation *at = pendres_branch_bifurcation(b, (size_t)i);
    const pendres_pendulum *p = &at->orbit.pendulum;
    const long double y = at->orbit.x - 1.57079632679489661923L, v = at->orbit.v;
    pendres_reference_cycle want;
    assert_int_equal(at->kind, i == 0 ? PENDRES_SYMMETRY_BREAKING : PENDRES_FOLD);
    check_near(at->value, i == 0 ? 0.41063921 : 0.43198651, 5e-9);
    if (i == 0) check_ok(pendres_reference_symmetry_breaking(p, at->value, y, v, &want));
    else check_ok(pendres_reference_fold(p, at->value, y, v, &want));
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
   high frequencies its members are LA all the same. */
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
  int more = 1, rounds = 0;
  check_ok(pendres_phase_diagram_compute(ctx, &grid, &whole));
  check_ok(pendres_phase_diagram_create(&grid, &parts));
  for (size_t i = LINES; i-- > 0;) {
    pendres_phase_record *r = NULL;
    check_ok(pendres_phase_diagram_compute_line(other, parts, i, &r));
    check_ok(pendres_phase_diagram_take_line(parts, i, pendres_phase_record_size(r),
                                             pendres_phase_record_bytes(r)));
    assert_int_equal(pendres_phase_diagram_take_line(parts, i, pendres_phase_record_size(r) - 1,
                                                     pendres_phase_record_bytes(r)),
                     PENDRES_INVALID_ARGUMENT);
    pendres_phase_record_free(r);
  }
  while (pendres_phase_diagram_follow_curves(other, parts, &more) == PENDRES_OK && more) {
    for (size_t i = 0; i < LINES; i++) {
      pendres_phase_record *r = NULL;
      check_ok(pendres_phase_diagram_complete_line(other, parts, i, &r));
      check_ok(pendres_phase_diagram_take_line(parts, i, pendres_phase_record_size(r),
                                               pendres_phase_record_bytes(r)));
      pendres_phase_record_free(r);
    }
    rounds++;
  }
  assert_true(rounds > 0);
  for (size_t i = 0; i < LINES * VALUES; i++) {
    const pendres_phase_point *p = pendres_phase_diagram_point(whole, i);
    assert_memory_equal(p, pendres_phase_diagram_point(parts, i), sizeof *p);
    assert_int_equal(pendres_phase_diagram_outcome(whole, i, NULL), PENDRES_OK);
    assert_int_equal(p->regime, i == 0   ? PENDRES_REGIME_COEXISTENCE
                                : i == 1 ? PENDRES_REGIME_LA
                                         : PENDRES_REGIME_SINGLE);
  }
  const pendres_cusp *cusp = pendres_phase_diagram_cusp(whole);
  check_near(cusp->value[1], cusp_damping, cusp->value_error[1] + 1e-15);
  check_near(cusp->value[0], cusp_frequency, cusp->value_error[0] + 1e-15);
  const pendres_bifurcation *sa = pendres_phase_diagram_fold(whole, 0, PENDRES_LABEL_SA);
  const pendres_bifurcation *la = pendres_phase_diagram_fold(whole, 0, PENDRES_LABEL_LA);
  check_near(sa->value, sa_fold, sa->value_error + 1e-15);
  check_near(la->value, la_fold, la->value_error + 1e-15);
  assert_null(pendres_phase_diagram_fold(whole, 1, PENDRES_LABEL_SA));
  pendres_phase_diagram_free(whole);
  pendres_phase_diagram_free(parts);
  pendres_context_free(ctx);
  pendres_context_free(other);
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
  pendres_phase_record *r = NULL;
  const char *words = NULL;
  check_ok(pendres_phase_diagram_create(&grid, &d));
  check_ok(pendres_phase_diagram_leave_out(d, 1));
  check_ok(pendres_phase_diagram_compute_line(ctx, d, 0, &r));
  check_ok(pendres_phase_diagram_take_line(d, 0, pendres_phase_record_size(r),
                                           pendres_phase_record_bytes(r)));
  assert_int_equal(pendres_phase_diagram_outcome(d, 0, &words), PENDRES_INVALID_ARGUMENT);
  assert_true(words != NULL && strlen(words) > 0);
  assert_int_equal(pendres_phase_diagram_outcome(d, 1, &words), PENDRES_UNSUPPORTED);
  assert_null(words);
  assert_int_equal(pendres_phase_diagram_outcome(d, 2, &words), PENDRES_OK);
  assert_true(isnan(pendres_phase_diagram_point(d, 0)->mean_loop_area));
  assert_true(isnan(pendres_phase_diagram_point(d, 1)->mean_loop_area));
  assert_true(pendres_phase_diagram_point(d, 2)->mean_loop_area > 0.0);
  pendres_phase_record_free(r);
  pendres_phase_diagram_free(d);
  pendres_context_free(ctx);
}

static void mistakes_are_told(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[2] = {{.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8},
                              {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.7}};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point points[2];
  assert_int_equal(pendres_phase_line(ctx, 2, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  line[1] = (pendres_pendulum){.damping = 0.14, .drive_amplitude = 0.2, .drive_frequency = 0.9};
  assert_int_equal(pendres_phase_line(ctx, 2, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  e.members = 0;
  assert_int_equal(pendres_phase_line(ctx, 1, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  e.members = 1;
  check_ok(pendres_phase_line(ctx, 0, NULL, with(&e), NULL, NULL));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(names_are_the_files),    cmocka_unit_test(regimes_of_the_paper),
    cmocka_unit_test(ghosts_are_not_attractors), cmocka_unit_test(cusp_parts_the_regimes),
    cmocka_unit_test(basins_can_miss_the_members), cmocka_unit_test(others_are_told),
    cmocka_unit_test(curves_tell_what_members_miss), cmocka_unit_test(curves_change_nothing_else),
    cmocka_unit_test(curves_tell_where_sa_ends),
    cmocka_unit_test(above_the_cusp_there_is_no_distinction), cmocka_unit_test(mistakes_are_told),
    cmocka_unit_test(branches_end_otherwise), cmocka_unit_test(whole_diagrams), cmocka_unit_test(points_fail_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
