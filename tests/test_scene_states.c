/*
 * test_scene_states.c -- the scenes orbit and basins, run in this process: published facts outside
 * of the paper's range, the same bytes whatever the threads, refined grids against whole ones.
 */
#include "scene_fixture.h"

#include <pendres/pendres.h>
#include "oracle/reference.h"

static const double pi = 3.14159265358979323846;

/*
 * Baker and Gollub, Chaotic Dynamics (1996), chapters 3 and 4: q = 2 (damping 1/2), drive frequency
 * 2/3. Orbits that are not their own mirror image come in pairs.
 */
static const struct fact {
  double drive;
  pendres_label label;
  int attractors, period, winding; /* |winding| */
} facts[] = {
  {0.90, PENDRES_LABEL_PERIODIC, 1, 1, 0}, {1.07, PENDRES_LABEL_PERIODIC, 2, 2, 0},
  {1.15, PENDRES_LABEL_CHAOTIC, 1, 0, 0},  {1.35, PENDRES_LABEL_RUNNING, 2, 1, 1},
  {1.45, PENDRES_LABEL_RUNNING, 2, 2, 2},  {1.47, PENDRES_LABEL_RUNNING, 2, 4, 4},
  {1.50, PENDRES_LABEL_CHAOTIC, 1, 0, 0},
};
enum { FACTS = sizeof facts / sizeof *facts };

static void run_fact(const struct fact *f, const char *kind, const char *rest, const char *name)
{
  char text[500];
  snprintf(text, sizeof text,
           "&scene kind = '%s' /\n"
           "&pendulum drive_amplitude = %g, damping = 0.5, drive_frequency = %.17g /\n%s",
           kind, f->drive, 2.0 / 3.0, rest);
  scene_run_deck(text, 2, name);
}

/* Against the long double reference, within ten times the errors claimed. */
static void check_closed_orbit(pendres_store *store, const struct fact *f)
{
  static const char *const names[] = {"loop_area", "amplitude", "mean_power", "lyapunov_exponent"};
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = f->drive, .drive_frequency = 2.0 / 3.0};
  reference_cycle c;
  size_t n = 0;
  double *x = scene_values(store, "x", &n), *v = scene_values(store, "v", &n);
  const int winding = (int)scene_scalar(store, "winding");
  assert_int_equal(scene_scalar(store, "period"), f->period);
  assert_int_equal(abs(winding), f->winding);
  check_ok(reference_orbit(&p, x[0] - 0.5 * pi, v[0], f->period, winding, &c));
  const double time = 2.0 * pi * f->period / p.drive_frequency;
  const double want[] = {
    (double)c.loop_area, (double)c.amplitude, (double)c.mean_power,
    log(hypot((double)c.multiplier_re[0], (double)c.multiplier_im[0])) / time};
  for (int i = 0; i < 4; i++) {
    char error[64];
    snprintf(error, sizeof error, "%s_error", names[i]);
    check_near(scene_scalar(store, names[i]), want[i], 10.0 * scene_scalar(store, error));
    assert_true(scene_scalar(store, error) < 1e-7);
  }
  free(x);
  free(v);
}

static void orbits_of_baker_and_gollub(void **state)
{
  (void)state;
  for (int i = 0; i < FACTS; i++) {
    run_fact(&facts[i], "orbit", "&orbit x = 1.8, v = 0.1, periods = 8, samples = 16 /\n", "orbit");
    pendres_store *store = scene_open("orbit");
    size_t n = 0;
    double *x = scene_values(store, "x", &n);
    assert_int_equal(n, 128);
    for (size_t k = 0; k < n; k++) assert_true(isfinite(x[k]));
    assert_int_equal(scene_scalar(store, "label"), facts[i].label);
    if (facts[i].label != PENDRES_LABEL_CHAOTIC) {
      check_closed_orbit(store, &facts[i]);
      assert_true(isnan(scene_scalar(store, "watched_periods")));
    } else {
      const double error = scene_scalar(store, "lyapunov_exponent_error");
      assert_true(error > 0.0 && scene_scalar(store, "lyapunov_exponent") > 5.0 * error);
      /* Means over time, and for how long: test_chaos.c compares them with other codes. */
      assert_true(scene_scalar(store, "loop_area") > 30.0 * scene_scalar(store, "loop_area_error"));
      assert_true(scene_scalar(store, "amplitude") > 30.0 * scene_scalar(store, "amplitude_error"));
      check_near(scene_scalar(store, "drift"), 0.0, scene_scalar(store, "drift_error"));
      assert_true(scene_scalar(store, "watched_periods") > 1e5);
      check_near(scene_scalar(store, "escape_rate_bound"), 2.5e-5, 1e-6);
      assert_true(isnan(scene_scalar(store, "period")) && isnan(scene_scalar(store, "phase_lag")));
    }
    free(x);
    pendres_store_free(store);
  }
}

static void basins_of_baker_and_gollub(void **state)
{
  (void)state;
  for (int i = 0; i < FACTS; i++) {
    run_fact(&facts[i], "basins", "&sweep x_range = -1.5, 4.7, 40, v_range = -3, 3, 40 /\n",
             "basins");
    pendres_store *store = scene_open("basins");
    size_t n = 0, states = 0;
    double *label = scene_values(store, "attractor_label", &n), sum = 0.0;
    double *share = scene_values(store, "basin_fraction", &n);
    double *lyapunov = scene_values(store, "attractor_lyapunov", &n);
    double *of_state = scene_values(store, "label", &states);
    double *watched = scene_values(store, "attractor_watched_periods", &n);
    double *escape = scene_values(store, "attractor_escape_rate_bound", &n);
    double *drift = scene_values(store, "attractor_drift", &n);
    assert_int_equal(n, facts[i].attractors);
    for (size_t k = 0; k < n; k++) {
      const int chaotic = facts[i].label == PENDRES_LABEL_CHAOTIC;
      assert_int_equal(isfinite(drift[k]) != 0, chaotic);
      assert_true(chaotic ? watched[k] > 1e5 && escape[k] < 3e-5 : isnan(watched[k] + escape[k]));
      assert_int_equal(label[k], facts[i].label);
      assert_int_equal(lyapunov[k] > 0.0, facts[i].label == PENDRES_LABEL_CHAOTIC);
      sum += share[k];
    }
    check_near(sum, 1.0, 1e-12);
    assert_int_equal(states, 1600);
    for (size_t k = 0; k < states; k++) assert_int_equal(of_state[k], facts[i].label);
    assert_int_equal(scene_scalar(store, "unresolved_states"), 0);
    free(label);
    free(share);
    free(lyapunov);
    free(watched);
    free(escape);
    free(drift);
    free(of_state);
    pendres_store_free(store);
  }
}

/* One attractor in many wells: they are counted in the file, beside plain counts of states, and
   have shares of the window where they are ends. */
static void wells_are_counted(void **state)
{
  (void)state;
  scene_run_deck("&scene kind = 'basins' /\n"
                 "&pendulum drive_amplitude = 1, damping = 0.1, drive_frequency = 1 /\n"
                 "&sweep x_range = -1.5, 4.7, 40, v_range = -4, 4, 40 /\n"
                 "&basins by = 'well', statistics = .false. /\n",
                 2, "wells");
  pendres_store *store = scene_open("wells");
  size_t n = 0, states = 0, entries = 0;
  double *number = scene_values(store, "basin_well_number", &n), sum = 0.0;
  double *count = scene_values(store, "basin_well_states", &n);
  double *well = scene_values(store, "well", &states);
  double *wells = scene_values(store, "basin_wells", &entries);
  double *share = scene_values(store, "basin_well_fraction", &entries), area = 0.0;
  double *all = scene_values(store, "basin_states", &entries);
  assert_int_equal(entries, 1);
  assert_int_equal(wells[0], n);
  assert_int_equal(all[0], 1600);
  assert_true(n > 10);
  for (size_t i = 0; i < n; i++) {
    size_t there = 0;
    for (size_t k = 0; k < states; k++) there += well[k] == number[i];
    assert_int_equal(count[i], there);
    sum += count[i];
    area += share[i];
    /* A share of the area: states at the ends count half, of which there are a tenth. */
    check_near(share[i], count[i] / 1600.0, 0.1);
  }
  check_near(area, 1.0, 1e-12);
  check_near(sum, 1600.0, 0.0);
  /* Wells are harder to tell than attractors: some are uncertain; the one attractor is not. Those
     that are counted are marked, one by one. */
  double *uncertain = scene_values(store, "uncertain", &states), marked = 0.0;
  for (size_t k = 0; k < states; k++) marked += uncertain[k];
  check_near(marked, scene_scalar(store, "uncertain_states"), 0.0);
  assert_true(marked > 0.0 && marked < 400.0);
  free(uncertain);
  check_near(scene_scalar(store, "basin_fraction_error"), 0.0, 1e-3);
  free(number);
  free(count);
  free(well);
  free(wells);
  free(share);
  free(all);
  pendres_store_free(store);
}

/* A ring whose spring pushes, x'' + 0.3 x' + sin x - 0.05 x, which beats the sine and the drive
   beyond 21: what starts at rest at 25 or 30 is gone. Each value in the file has its meaning. */
static void rings_escape(void **state)
{
  enum { NX = 13, NV = 3, ESCAPE = 6 };
  size_t n = 0, all = 0, gone = 0;
  char *meanings = NULL;
  (void)state;
  scene_run_deck("&scene kind = 'basins' /\n"
                 "&pendulum force = 'squid', force_coefficients = -0.05, damping = 0.3,\n"
                 "  drive_amplitude = 0.05, drive_frequency = 0.8 /\n"
                 "&sweep x_range = -30, 30, 13, v_range = -1, 1, 3 /\n", 1, "ring");
  pendres_store *store = scene_open("ring");
  check_ok(pendres_store_read_attribute_text(store, "", "label", "flag_meanings", &meanings));
  assert_string_equal(meanings, "sa la periodic running chaotic unresolved escape");
  double *label = scene_values(store, "label", &n);
  double *states = scene_values(store, "basin_states", &all);
  assert_int_equal(n, NX * NV);
  for (size_t i = 0; i < n; i++) gone += label[i] == ESCAPE;
  for (int i = 0; i < NX; i++)
    if (abs(5 * i - 30) > 21) assert_true(label[i * NV + 1] == ESCAPE);
  assert_true(label[NX / 2 * NV + 1] != ESCAPE);
  assert_true(scene_scalar(store, "escaped_states") == (double)gone);
  for (size_t i = 0; i < all; i++) gone += (size_t)states[i];
  assert_int_equal(gone, NX * NV);
  free(meanings);
  free(label);
  free(states);
  pendres_store_free(store);
}

/* Upright pendulums rest there where nothing but their length is driven, and `other` has a name for
   that. */
static void upright_rest_is_named(void **state)
{
  size_t n = 0;
  char *meanings = NULL;
  (void)state;
  scene_run_deck("&scene kind = 'phase_diagram' /\n"
                 "&pendulum drive_amplitude = 0, damping = 0.3 /\n"
                 "&sweep parametric_amplitude = 0, 0.4, drive_frequency = 1.6, 2 /\n"
                 "&ensemble members = 5, x_first = -1.5707963267948966,\n"
                 "  x_last = 4.71238898038469 /\n",
                 1, "upright");
  pendres_store *store = scene_open("upright");
  check_ok(pendres_store_read_attribute_text(store, "", "other", "flag_meanings", &meanings));
  assert_string_equal(meanings,
                      "none asymmetric periodic running chaotic unresolved escape unstable");
  double *other = scene_values(store, "other", &n);
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) assert_true(other[i] == PENDRES_OTHER_UNSTABLE);
  free(meanings);
  free(other);
  pendres_store_free(store);
}

/* A fractal boundary fills a grid; then the exponent is from random states, as in the library. */
static void exponent_of_a_fractal_boundary(void **state)
{
  (void)state;
  scene_run_deck("&scene kind = 'basins' /\n"
                 "&pendulum drive_amplitude = 1.66, damping = 0.2, drive_frequency = 1 /\n"
                 "&sweep x_range = -1.5, 4.7, 60, v_range = -4, 4, 60 /\n",
                 2, "wada");
  pendres_store *store = scene_open("wada");
  assert_true(scene_scalar(store, "uncertainty_random_states") > 0);
  /* 0.154 +- 0.007 by an independent computation: test_basin_fractal.c. */
  const double error = scene_scalar(store, "uncertainty_exponent_error");
  assert_true(error < 0.03);
  check_near(scene_scalar(store, "uncertainty_exponent"), 0.154, 3.0 * hypot(error, 0.007));
  pendres_store_free(store);
}

#define GRID "&sweep x_range = -1.5, 4.7, 150, v_range = -2.5, 2.5, 130 /\n"

static const char whole_deck[] =
  "&scene kind = 'basins' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n" GRID;
static const char refined_deck[] =
  "&scene kind = 'basins' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n" GRID
  "&basins refine = T /\n";

static void same_bytes_on_any_threads(void **state)
{
  (void)state;
  scene_run_deck(whole_deck, 1, "whole");
  scene_run_deck(whole_deck, 3, "whole-again");
  scene_check_same_bytes("whole", "whole-again");
  scene_run_deck(refined_deck, 1, "refined");
  scene_run_deck(refined_deck, 3, "refined-again");
  scene_check_same_bytes("refined", "refined-again");
}

static void refined_is_whole(void **state)
{
  static const char *const names[] = {"label", "attractor_index", "well", "basin_fraction"};
  pendres_store *whole = scene_open("whole"), *refined = scene_open("refined");
  (void)state;
  for (int i = 0; i < 4; i++) {
    size_t n = 0, m = 0;
    double *a = scene_values(whole, names[i], &n), *b = scene_values(refined, names[i], &m);
    assert_int_equal(n, m);
    for (size_t k = 0; k < n; k++) check_near(a[k], b[k], 0.0);
    free(a);
    free(b);
  }
  const double integrated = scene_scalar(refined, "integrated_states");
  /* What was verified stays filled in, if it was so rightly. */
  check_near(integrated + scene_scalar(refined, "filled_states"), 150 * 130, 0.0);
  assert_int_equal(scene_scalar(refined, "verified_states"), 10000);
  assert_int_equal(scene_scalar(refined, "verification_misses"), 0);
  /* On this grid the exponent is from the grid. */
  assert_int_equal(scene_scalar(whole, "uncertainty_random_states"), 0);
  pendres_store_free(whole);
  pendres_store_free(refined);
}

/*
 * Basins of which pieces fit between the points of the coarse lattice: a sample finds some, what is
 * around them is looked at, and again, until a fresh sample is clean. What may be left is said,
 * and fractions' errors contain it.
 */
static void refined_until_a_sample_is_clean(void **state)
{
#define PIECES                                                                                     \
  "&scene kind = 'basins' /\n"                                                                     \
  "&pendulum drive_amplitude = 1.1495102972657845, damping = 0.22350456150056097,\n"               \
  "          drive_frequency = 1.0932641592038927 /\n"                                             \
  "&sweep x_range = -1.5, 4.5, 256, v_range = -3, 3, 256 /\n"                                      \
  "&precision tolerance = 1e-6 /\n"
  (void)state;
  scene_run_deck(PIECES, 2, "pieces");
  scene_run_deck(PIECES "&basins refine = T /\n", 2, "pieces-refined");
  pendres_store *whole = scene_open("pieces"), *refined = scene_open("pieces-refined");
  size_t n = 0, m = 0, differ = 0;
  double *a = scene_values(whole, "attractor_index", &n);
  double *b = scene_values(refined, "attractor_index", &n);
  for (size_t k = 0; k < n; k++) differ += a[k] != b[k];
  const double suspected = scene_scalar(refined, "suspected_states");
  assert_true(scene_scalar(refined, "verification_misses") > 0);
  assert_true(differ <= suspected);
  assert_true(suspected < 1e-3 * (double)n); /* 3 in 10,000 of what was filled in */
  double *share = scene_values(whole, "basin_fraction", &n);
  double *other = scene_values(refined, "basin_fraction", &m);
  double *error = scene_values(whole, "basin_fraction_error", &n);
  double *other_error = scene_values(refined, "basin_fraction_error", &m);
  assert_int_equal(n, m);
  for (size_t k = 0; k < n; k++) {
    /* The same grid: what the errors of sampling it are does not separate the two. */
    check_near(other[k], share[k], suspected / (256.0 * 256.0));
    assert_true(other_error[k] >= suspected / (256.0 * 256.0) && error[k] > 0.0);
  }
  free(a);
  free(b);
  free(share);
  free(other);
  free(error);
  free(other_error);
  pendres_store_free(whole);
  pendres_store_free(refined);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(orbits_of_baker_and_gollub),
    cmocka_unit_test(basins_of_baker_and_gollub),
    cmocka_unit_test(wells_are_counted),
    cmocka_unit_test(rings_escape),
    cmocka_unit_test(upright_rest_is_named),
    cmocka_unit_test(exponent_of_a_fractal_boundary),
    cmocka_unit_test(same_bytes_on_any_threads),
    cmocka_unit_test(refined_until_a_sample_is_clean),
    cmocka_unit_test(refined_is_whole), /* of what the test before has written */
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
