/*
 * test_scene_curves.c -- the scenes phase_diagram and branches, run in this process: what they
 * write, the same bytes whatever the threads, and figures that test_continuation.c has from
 * elsewhere.
 */
#include "scene_fixture.h"

#include <pendres/phase_diagram.h>
#include <pendres/resonance.h>
#include <pendres/rotation.h>

static const char branches_deck[] =
  "&scene kind = 'branches' /\n"
  "&pendulum drive_amplitude = 0.2 /\n"
  "&sweep damping = 0.13, 0.15, drive_frequency = 0.7, 0.8, 0.845, 0.9 /\n"
  "&ensemble members = 40 /\n";
static const char diagram_deck[] =
  "&scene kind = 'phase_diagram' /\n"
  "&pendulum drive_amplitude = 0.2 /\n"
  "&sweep damping = 0.08, 0.13, 0.17, drive_frequency = 0.536, 0.65, 0.8, 0.9 /\n"
  "&ensemble members = 200 /\n";

static void same_bytes_on_any_threads(void **state)
{
  (void)state;
  static const char *const decks[] = {branches_deck, diagram_deck};
  static const char *const names[] = {"branches", "diagram"};
  for (int i = 0; i < 2; i++) {
    char again[32];
    snprintf(again, sizeof again, "%s-again", names[i]);
    scene_run_deck(decks[i], 1, names[i]);
    scene_run_deck(decks[i], 2, again);
    scene_check_same_bytes(names[i], again);
  }
}

/* Every result has its error beside it, of the same shape. */
static void errors_stand_beside(void **state)
{
  (void)state;
  static const char *const branches[] = {
    "sa_amplitude", "la_amplitude", "mean_loop_amplitude", "sa_fraction", "branch_frequency",
    "branch_amplitude", "branch_phase_lag", "branch_loop_area", "branch_multiplier_re",
    "branch_multiplier_im", "fold_damping", "fold_frequency", "fold_amplitude", "cusp_damping",
    "cusp_frequency", "backbone_frequency", "backbone_amplitude", "bifurcation_frequency",
    "bifurcation_curvature", "bifurcation_multiplier", "branch_damping", "free_frequency"};
  static const char *const diagram[] = {
    "sa_fraction", "la_fraction", "mean_loop_area", "fold_damping", "fold_frequency",
    "fold_amplitude", "fold_multiplier", "fold_other_multiplier", "flip_frequency",
    "flip_multiplier", "cusp_damping", "cusp_frequency"};
  for (int which = 0; which < 2; which++) {
    const char *const *names = which == 0 ? branches : diagram;
    const size_t count =
      which == 0 ? sizeof branches / sizeof *branches : sizeof diagram / sizeof *diagram;
    pendres_store *store = scene_open(which == 0 ? "branches" : "diagram");
    for (size_t i = 0; i < count; i++) {
      char error_name[64];
      size_t n = 0, m = 0;
      snprintf(error_name, sizeof error_name, "%s_error", names[i]);
      double *v = scene_values(store, names[i], &n), *e = scene_values(store, error_name, &m);
      assert_int_equal(n, m);
      for (size_t k = 0; k < n; k++) {
        assert_int_equal(isnan(v[k]), isnan(e[k]));
        assert_true(isnan(e[k]) || e[k] >= 0.0);
      }
      free(v);
      free(e);
    }
    pendres_store_free(store);
  }
}

static void branches_hold_the_figures(void **state)
{
  (void)state;
  size_t n = 0, m = 0;
  pendres_store *store = scene_open("branches");
  check_near(scene_scalar(store, "cusp_damping"), 0.163656902031172567, 1e-8);
  check_near(scene_scalar(store, "cusp_frequency"), 0.862157913509009358, 1e-8);
  /* Basins of SA and LA are as wide as the well here: every member is on its side for certain. */
  double *uncertain = scene_values(store, "uncertain_members", &n);
  assert_int_equal(n, 8);
  for (size_t i = 0; i < n; i++) check_near(uncertain[i], 0.0, 0.0);
  free(uncertain);
  /* SA at 0.7 and 0.8 for both, LA from 0.8 for damping 0.13, from 0.845 for 0.15. */
  static const int sa_lives[8] = {1, 1, 0, 0, 1, 1, 1, 0}, la_lives[8] = {0, 1, 1, 1, 0, 0, 1, 1};
  double *sa = scene_values(store, "sa_amplitude", &n),
    *la = scene_values(store, "la_amplitude", &m);
  assert_int_equal(n, 8);
  assert_int_equal(m, 8);
  for (int i = 0; i < 8; i++) {
    assert_int_equal(!isnan(sa[i]), sa_lives[i]);
    assert_int_equal(!isnan(la[i]), la_lives[i]);
  }
  /* The unstable middle part lies between the folds of each damping. */
  double *damping = scene_values(store, "branch_damping", &n);
  double *frequency = scene_values(store, "branch_frequency", &m);
  double *stable = scene_values(store, "branch_stable", &m),
    *kind = scene_values(store, "branch_kind", &m);
  size_t unstable = 0, folds = 0;
  for (size_t i = 0; i < n; i++) {
    folds += kind[i] == PENDRES_FOLD;
    if (kind[i] != PENDRES_REGULAR || stable[i] == 1.0) continue;
    unstable++;
    if (damping[i] == 0.13) assert_true(frequency[i] > 0.7535 && frequency[i] < 0.84493);
    else assert_true(frequency[i] > 0.83836 && frequency[i] < 0.85345);
  }
  assert_int_equal(folds, 4);
  assert_true(unstable > 10);
  /* Fold points have the cusp's damping at most, and SA's and LA's sides both. */
  double *fold = scene_values(store, "fold_damping", &n),
    *which = scene_values(store, "fold_branch", &m);
  int sides[3] = {0, 0, 0};
  for (size_t i = 0; i < n; i++) {
    assert_true(fold[i] <= 0.1636569021);
    sides[(int)which[i]]++;
  }
  assert_true(sides[0] > 10 && sides[1] > 10 && sides[2] == 0);
  free(sa);
  free(la);
  free(damping);
  free(frequency);
  free(stable);
  free(kind);
  free(fold);
  free(which);
  pendres_store_free(store);
}

/* Of a line's two folds the one of smaller amplitude ends SA, also at drives where it is
   larger than the cusp's, as it is here. */
static void ends_of_strong_drives(void **state)
{
  (void)state;
  size_t n = 0;
  scene_run_deck("&scene kind = 'branches' /\n&ensemble members = 2 /\n"
                 "&pendulum force = 'polynomial', force_coefficients = 1, 0, 0.2, damping = 0.1 /\n"
                 "&sweep drive_amplitude = 0.1, 0.3, 1.0, drive_frequency_range = 0.7, 2.0, 5 /\n",
                 1, "ends");
  pendres_store *store = scene_open("ends");
  double *amplitude = scene_values(store, "bifurcation_amplitude", &n);
  double *drive = scene_values(store, "bifurcation_drive_amplitude", &n);
  double *branch = scene_values(store, "bifurcation_branch", &n);
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) {
    assert_true(amplitude[i] > scene_scalar(store, "cusp_amplitude"));
    for (size_t j = 0; j < n; j++)
      if (drive[i] == drive[j] && amplitude[i] < amplitude[j])
        assert_true(branch[i] == 0.0 && branch[j] == 1.0);
  }
  free(amplitude);
  free(drive);
  free(branch);
  pendres_store_free(store);
}

/* Lines along the drive amplitude, and lines of frequencies at several of them: the fold and the
   cusp that lines of frequencies have at 0.2 (the reference's) lie at 0.2. */
static void drives_are_axes(void **state)
{
  (void)state;
  size_t n = 0, folds = 0;
  scene_run_deck("&scene kind = 'branches' /\n"
                 "&pendulum damping = 0.13, drive_frequency = 0.84492519754233728 /\n"
                 "&sweep drive_amplitude = 0.15, 0.25 /\n"
                 "&ensemble members = 10 /\n", 1, "tower");
  pendres_store *store = scene_open("tower");
  double *regime = scene_values(store, "regime", &n);
  assert_int_equal(n, 2);
  assert_int_equal((int)regime[0], PENDRES_REGIME_SA);
  assert_int_equal((int)regime[1], PENDRES_REGIME_LA);
  free(regime);
  double *drive = scene_values(store, "bifurcation_drive_amplitude", &n);
  double *error = scene_values(store, "bifurcation_drive_amplitude_error", &n);
  double *curvature = scene_values(store, "bifurcation_curvature", &n);
  for (size_t i = 0; i < n; i++)
    if (curvature[i] < 0.0) {
      folds++;
      check_near(drive[i], 0.2, error[i] + 1e-15);
      assert_true(error[i] < 1e-8);
    }
  assert_int_equal(folds, 1);
  free(drive);
  free(error);
  free(curvature);
  pendres_store_free(store);

  scene_run_deck("&scene kind = 'phase_diagram' /\n"
                 "&pendulum damping = 0.16365690203117257 /\n"
                 "&sweep drive_amplitude = 0.18, 0.22, drive_frequency = 0.84, 0.862 /\n"
                 "&ensemble members = 10 /\n", 1, "tongue");
  store = scene_open("tongue");
  check_near(scene_scalar(store, "cusp_drive_amplitude"), 0.2,
             scene_scalar(store, "cusp_drive_amplitude_error") + 1e-15);
  check_near(scene_scalar(store, "cusp_frequency"), 0.862157913509009358,
             scene_scalar(store, "cusp_frequency_error") + 1e-15);
  regime = scene_values(store, "regime", &n);
  assert_int_equal(n, 4);
  assert_int_equal((int)regime[0], PENDRES_REGIME_SINGLE);
  assert_int_equal((int)regime[1], PENDRES_REGIME_SINGLE);
  assert_int_not_equal((int)regime[2], PENDRES_REGIME_SINGLE);
  free(regime);
  pendres_store_free(store);
}

/* A response over frequencies tells its resonance as a frequency; over drive amplitudes it has that
   of the same pendulum, bit by bit. */
static void responses_have_axes(void **state)
{
  (void)state;
  size_t n = 0, m = 0;
  scene_run_deck("&scene kind = 'response' /\n"
                 "&pendulum drive_amplitude = 0.2, damping = 0.24 /\n"
                 "&sweep drive_frequency = 0.8, 0.9 /\n"
                 "&ensemble members = 10 /\n", 1, "frequencies");
  scene_run_deck("&scene kind = 'response' /\n"
                 "&pendulum drive_frequency = 0.8, damping = 0.24 /\n"
                 "&sweep drive_amplitude = 0.2, 0.3 /\n"
                 "&ensemble members = 10 /\n", 1, "drives");
  pendres_store *one = scene_open("frequencies"), *other = scene_open("drives");
  double *frequency = scene_values(one, "resonance_frequency", &n);
  double *period = scene_values(one, "resonance_period", &m);
  assert_true(n == 1 && m == 1);
  check_near(frequency[0] * period[0], 6.283185307179586, 1e-14);
  double *a = scene_values(one, "mean_loop_area", &n),
    *b = scene_values(other, "mean_loop_area", &m);
  assert_true(n == 2 && m == 2);
  assert_memory_equal(&a[0], &b[0], sizeof a[0]);
  assert_true(b[1] > b[0]);
  free(frequency);
  free(period);
  free(a);
  free(b);
  pendres_store_free(one);
  pendres_store_free(other);
}

static void diagram_holds_the_regimes(void **state)
{
  (void)state;
  size_t n = 0;
  pendres_store *store = scene_open("diagram");
  double *regime = scene_values(store, "regime", &n);
  assert_int_equal(n, 12);
  double *exact = scene_values(store, "regime_exact", &n),
    *other = scene_values(store, "other", &n);
  /* At damping 0.08 and frequency 0.536 LA has lost its symmetry (at 0.537944): a pair of mirror
     images, one state by its name. */
  static const int want[12] = {
    PENDRES_REGIME_COEXISTENCE, PENDRES_REGIME_COEXISTENCE, PENDRES_REGIME_COEXISTENCE,
    PENDRES_REGIME_LA,
    PENDRES_REGIME_SA,     PENDRES_REGIME_SA,          PENDRES_REGIME_COEXISTENCE,
      PENDRES_REGIME_LA,
    PENDRES_REGIME_SINGLE, PENDRES_REGIME_SINGLE,      PENDRES_REGIME_SINGLE,
      PENDRES_REGIME_SINGLE};
  for (int i = 0; i < 12; i++) {
    assert_int_equal((int)regime[i], want[i]);
    assert_int_equal((int)other[i], i == 0 ? PENDRES_OTHER_ASYMMETRIC : 0);
    assert_int_equal((int)exact[i], want[i]);
  }
  double *fraction = scene_values(store, "sa_fraction", &n),
    *area = scene_values(store, "mean_loop_area", &n);
  for (int i = 0; i < 12; i++) {
    assert_int_equal(isnan(fraction[i]), want[i] == PENDRES_REGIME_SINGLE);
    assert_true(area[i] > 0.0);
  }
  /* The curve on which LA loses its symmetry passes this damping at that frequency. */
  double *kind = scene_values(store, "flip_kind", &n),
    *damping = scene_values(store, "flip_damping", &n);
  double *frequency = scene_values(store, "flip_frequency", &n);
  double nearest = INFINITY;
  for (size_t i = 0; i < n; i++)
    if (kind[i] == PENDRES_SYMMETRY_BREAKING)
      nearest = fmin(nearest, hypot(damping[i] - 0.08, frequency[i] - 0.537944036));
  assert_true(nearest < 0.02); /* half the spacing of its points */
  free(regime);
  free(exact);
  free(other);
  free(fraction);
  free(area);
  free(kind);
  free(damping);
  free(frequency);
  pendres_store_free(store);
}

/* What all members miss is told by the curves, in both scenes (test_phase_diagram.c has the
   figures): LA's second piece at damping 0.13, between 0.41063921 and 0.43198651. */
static void curves_tell_what_members_miss(void **state)
{
  (void)state;
  static const char rest[] = "&pendulum drive_amplitude = 0.2 /\n"
                             "&sweep damping = 0.13, 0.14, drive_frequency = 0.405, 0.42, 0.44 /\n"
                             "&ensemble members = 200 /\n";
  static const int want[6] = {PENDRES_REGIME_SA, PENDRES_REGIME_COEXISTENCE, PENDRES_REGIME_SA,
                              PENDRES_REGIME_SA, PENDRES_REGIME_SA,          PENDRES_REGIME_SA};
  static const char *const kinds[] = {"phase_diagram", "branches"};
  size_t n = 0, m = 0;
  for (int i = 0; i < 2; i++) {
    char deck[512], again[32];
    snprintf(deck, sizeof deck, "&scene kind = '%s' /\n%s", kinds[i], rest);
    snprintf(again, sizeof again, "%s-again", kinds[i]);
    scene_run_deck(deck, 1, kinds[i]);
    scene_run_deck(deck, 2, again);
    scene_check_same_bytes(kinds[i], again);
    pendres_store *store = scene_open(kinds[i]);
    double *regime = scene_values(store, "regime", &n);
    double *exact = scene_values(store, i == 0 ? "regime_exact" : "la_amplitude", &m);
    double *frequency = scene_values(store, "bifurcation_frequency", &m);
    assert_int_equal(n, 6);
    for (int k = 0; k < 6; k++) {
      assert_int_equal((int)regime[k], PENDRES_REGIME_SA);
      if (i == 0) assert_int_equal((int)exact[k], want[k]);
      else assert_int_equal(!isnan(exact[k]), want[k] == PENDRES_REGIME_COEXISTENCE);
    }
    int ends = 0;
    for (size_t k = 0; k < m; k++)
      ends += fabs(frequency[k] - 0.41063921) < 1e-8 || fabs(frequency[k] - 0.43198651) < 1e-8;
    assert_int_equal(ends, 2);
    /* The curve along which the piece loses its symmetry starts from there. */
    double *flip = scene_values(store, "flip_frequency", &m);
    assert_true(m > 10);
    free(flip);
    free(regime);
    free(exact);
    free(frequency);
    pendres_store_free(store);
  }
}

/* The resonance curve says of each point what it is, and of an edge which fold makes it. */
static void edges_name_their_fold(void **state)
{
  (void)state;
  size_t n = 0;
  scene_run_deck("&scene kind = 'resonance_curve' /\n"
                 "&pendulum drive_amplitude = 0.2 /\n"
                 "&sweep damping = 0.13, 0.154, 0.24 /\n",
                 1, "resonance");
  pendres_store *store = scene_open("resonance");
  double *peak = scene_values(store, "peak", &n), *fold = scene_values(store, "fold_frequency", &n);
  double *error = scene_values(store, "fold_frequency_error", &n);
  double *frequency = scene_values(store, "resonance_frequency", &n);
  assert_int_equal(n, 3);
  assert_int_equal((int)peak[0], PENDRES_PEAK_EDGE);
  /* The reference's fold, see test_continuation.c. */
  check_near(fold[0], 0.844925197542337284, error[0]);
  check_near(frequency[0], fold[0], error[0]);
  /* At 0.154, below the cusp, there are folds too, but the peak is beside them. */
  for (int i = 1; i < 3; i++) {
    assert_int_equal((int)peak[i], PENDRES_PEAK_SMOOTH);
    assert_true(isnan(fold[i]) && isnan(error[i]));
  }
  free(peak);
  free(fold);
  free(error);
  free(frequency);
  pendres_store_free(store);
}

/*
 * Branches along the torque: the folds at which the state that turns over once a period ends, a
 * Shapiro step's, and not the free pendulum's frequency, which this is not. test_follow.c has the
 * same bifurcations to 1e-10 by a computation of its own.
 */
static void branches_along_torque(void **state)
{
  (void)state;
  static const char deck_text[] =
    "&scene kind = 'branches' /\n&pendulum drive_amplitude = 1.0 /\n"
    "&sweep damping = 0.2, drive_frequency = 1.6, torque = 0.1, 0.4, 0.5 /\n"
    "&ensemble members = 6 /\n";
  static const double step[] = {0.158309370269157, 0.523738359082981};
  size_t n = 0;
  scene_run_deck(deck_text, 1, "one");
  pendres_store *store = scene_open("one");
  double *value = scene_values(store, "bifurcation_torque", &n);
  double *error = scene_values(store, "bifurcation_torque_error", &n);
  for (size_t k = 0; k < 2; k++) {
    int met = 0;
    for (size_t i = 0; i < n; i++) met += fabs(value[i] - step[k]) <= error[i] + 1e-14;
    assert_int_equal(met, 1);
  }
  assert_int_equal(pendres_store_has(store, "", "free_frequency"), 0);
  pendres_store_free(store);
  free(value), free(error);
}

/*
 * Without a drive equilibria are followed, to where they end at a torque of 1, exactly; and
 * rotations, which exist from Tricomi's torque on (0.1270088598053908 at this damping, which
 * test_rotation.c has from RK4), stand beside them. Members that rotate are marked, and why.
 */
static void branches_without_a_drive(void **state)
{
  (void)state;
  const char *deck_text =
    "&scene kind = 'branches' /\n"
    "&pendulum drive_amplitude = 0.0, damping = 0.1, drive_frequency = 1.0 /\n"
    "&sweep torque = 0.1, 0.2, 0.95 /\n"
    "&ensemble members = 3 /\n"
    "&precision period_budget = 60 /\n";
  static const double torque[] = {0.1, 0.2, 0.95};
  size_t n = 0, ends = 0;
  scene_run_deck(deck_text, 1, "free"); /* members that rotate without a drive have settled */
  pendres_store *store = scene_open("free");
  double *value = scene_values(store, "rotation_period", &n);
  double *error = scene_values(store, "rotation_period_error", &n);
  double *least = scene_values(store, "rotation_least_torque", &n);
  double *end = scene_values(store, "bifurcation_torque", &ends);
  assert_true(isnan(value[0]) && isnan(error[0]) && value[1] > value[2] && n == 3);
  for (int i = 0; i < 3; i++) {
    const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 1.0, .torque = torque[i]};
    pendres_rotation r;
    check_near(least[i], 0.1270088598053908, 1e-14);
    if (i == 0) continue;
    check_ok(pendres_rotation_find(&p, &r, NULL));
    check_near(value[i], r.period, r.period_error);
  }
  assert_true(ends > 0);
  for (size_t i = 0; i < ends; i++) check_near(end[i], 1.0, 1e-12);
  free(value), free(error), free(least), free(end);
  pendres_store_free(store);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(same_bytes_on_any_threads), cmocka_unit_test(errors_stand_beside),
    cmocka_unit_test(branches_hold_the_figures),
    cmocka_unit_test(branches_without_a_drive),
    cmocka_unit_test(branches_along_torque), cmocka_unit_test(diagram_holds_the_regimes),
    cmocka_unit_test(ends_of_strong_drives), cmocka_unit_test(drives_are_axes),
    cmocka_unit_test(responses_have_axes),
    cmocka_unit_test(curves_tell_what_members_miss), cmocka_unit_test(edges_name_their_fold),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
