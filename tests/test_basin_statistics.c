/*
 * test_basin_statistics.c -- errors of basins' statistics against what shifted grids and other
 * seeds show, plain counts, wells, and states that are uncertain.
 */
#include "basin_fixture.h"

#include <string.h>

#include "oracle/reference.h"

#include "analysis/basins/uncertainty.h"
#include "engine/context_internal.h"

/* ---- grids that are shifted by parts of a step ---- */

enum { FINE = 384, APART = 4, SHIFTS = APART * APART, COARSE = FINE / APART };

/* What is compared: shares of uncertain states, both entropies, a fraction. */
enum { UNCERTAIN = 4, ENTROPY = UNCERTAIN, BOUNDARY, FRACTION, FIGURES };

static const char *const figure_names[FIGURES] = {
  "uncertain[0]", "uncertain[1]", "uncertain[2]", "uncertain[3]", "entropy", "boundary entropy",
  "fraction[0]"};

/* The coarse grid that begins at row i and column j of the fine one. */
static void shifted(const portrait *p, size_t i, size_t j, double *value, double *error)
{
  double *x = spaced(COARSE, 0.0, 1.0), fraction[8], fraction_error[8];
  pendres_basin_state *row = malloc(COARSE * sizeof *row);
  const pendres_basin_grid grid = {.nx = COARSE, .nv = COARSE, .x = x, .v = x};
  const size_t attractors = pendres_attractors_count(p->set);
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  assert_true(row != NULL && attractors <= 8);
  check_ok(pendres_basin_sums_create(&grid, attractors, &sums));
  for (size_t k = 0; k < COARSE; k++) {
    for (size_t l = 0; l < COARSE; l++) row[l] = p->state[(i + k * APART) * FINE + j + l * APART];
    check_ok(pendres_basin_sums_add(sums, 1, row));
  }
  check_ok(pendres_basin_sums_result(sums, &s, fraction, fraction_error));
  memcpy(value, s.uncertain, UNCERTAIN * sizeof *value);
  memcpy(error, s.uncertain_error, UNCERTAIN * sizeof *error);
  value[ENTROPY] = s.entropy;
  error[ENTROPY] = s.entropy_error;
  value[BOUNDARY] = s.boundary_entropy;
  error[BOUNDARY] = s.boundary_entropy_error;
  /* Windows of shifted grids differ; all that is on the fine grid in this one is beside it. */
  value[FRACTION] = fraction[0];
  error[FRACTION] = fraction_error[0];
  for (size_t k = 0; k <= (COARSE - 1) * APART; k++)
    for (size_t l = 0; l <= (COARSE - 1) * APART; l++) {
      const double edge = (k % ((COARSE - 1) * APART) == 0 ? 0.5 : 1.0) *
                          (l % ((COARSE - 1) * APART) == 0 ? 0.5 : 1.0);
      value[FRACTION] -= edge * (p->state[(i + k) * FINE + j + l].attractor == 0) /
                         pow((COARSE - 1.0) * APART, 2.0);
    }
  pendres_basin_sums_free(sums);
  free(x);
  free(row);
}

/*
 * Errors against the scatter of sixteen grids, which is known to a fifth. They are standard errors,
 * of fractions two of them. Measured on grids of 128 to 1024: 0.8 to 2 times the scatter of shares,
 * 0.9 to 4 times that of entropies, 1.6 to 3.8 times that of fractions. Before, errors of entropies
 * from strips were 4 to 8 times too large, those of shares from a third to three times.
 */
static void shifted_grids(void **state)
{
  static const struct { pendres_pendulum p; double fastest; } cases[] = {
    {{.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962}, 2.5},
    {{.damping = 0.2, .drive_amplitude = 2.0, .drive_frequency = 1.0}, 4.0}};
  for (int c = 0; c < 2; c++) {
    double value[SHIFTS][FIGURES], error[SHIFTS][FIGURES];
    portrait p;
    compute(*state, &cases[c].p, FINE, FINE, cases[c].fastest, &p);
    for (size_t k = 0; k < SHIFTS; k++) shifted(&p, k / APART, k % APART, value[k], error[k]);
    for (int f = 0; f < FIGURES; f++) {
      double mean = 0.0, scatter = 0.0, claimed = 0.0;
      for (int k = 0; k < SHIFTS; k++) mean += value[k][f] / SHIFTS;
      for (int k = 0; k < SHIFTS; k++) {
        const double off = f == FRACTION ? value[k][f] : value[k][f] - mean;
        scatter += off * off / (f == FRACTION ? SHIFTS : SHIFTS - 1);
        claimed += error[k][f] * error[k][f] / SHIFTS;
      }
      const double ratio = sqrt(claimed / scatter);
      if (ratio < 0.7 || ratio > 5.0)
        print_error("case %d, %s: claimed / scatter = %.2f\n", c, figure_names[f], ratio);
      assert_true(ratio >= 0.7 && ratio <= 5.0);
    }
    release(&p);
  }
}

/*
 * The exponent from random states, over and over: its error is neither less than the scatter of
 * seeds nor padded beyond what makes it useful. Sixteen seeds know their scatter to a fifth.
 */
static void exponents_of_other_seeds(void **state)
{
  enum { SEEDS = 16, STATES = 4096 };
  static const double distance[] = {1e-5, 6e-5, 3.6e-4, 2.16e-3, 1.296e-2};
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 2.0, .drive_frequency = 1.0};
  const pendres_basin_window window = {
    .x_low = -0.5 * pi, .x_high = 1.5 * pi, .v_low = -4.0, .v_high = 4.0};
  pendres_attractors *set = NULL;
  double value[SEEDS], mean = 0.0, scatter = 0.0, claimed = 0.0;
  check_ok(pendres_attractors_find(*state, &p, 0, NULL, NULL, &set));
  for (int i = 0; i < SEEDS; i++) {
    pendres_basin_statistics s;
    const pendres_basin_sample sample = {STATES, (uint64_t)i, 5, distance};
    check_ok(pendres_basin_uncertainty(*state, set, &window, &sample, &s));
    value[i] = s.uncertainty_exponent;
    mean += value[i] / SEEDS;
    claimed += s.uncertainty_exponent_error / SEEDS;
  }
  for (int i = 0; i < SEEDS; i++) scatter += (value[i] - mean) * (value[i] - mean) / (SEEDS - 1.0);
  scatter = sqrt(scatter);
  if (!(claimed > 0.8 * scatter && claimed < 2.5 * scatter))
    print_error("claimed %.4f, scatter %.4f of %.4f\n", claimed, scatter, mean);
  assert_true(claimed > 0.8 * scatter && claimed < 2.5 * scatter);
  pendres_attractors_free(set);
}

static const pendres_pendulum wada = {
  .damping = 0.2, .drive_amplitude = 1.66, .drive_frequency = 1.0};
static const pendres_basin_window turn = {
  .x_low = -1.57, .x_high = 4.71, .v_low = -4.0, .v_high = 4.0};

static pendres_context *context_with_lanes(int lanes)
{
  const pendres_options options = {.block_lanes = lanes};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&options, &ctx));
  return ctx;
}

/*
 * Where work is bounded a sample ends early: with the first states of the whole one, as many
 * whatever the blocks and whatever the context has chosen steps for before. A thirtieth beyond the
 * bound is the scatter of what 256 states tell of the others.
 */
static void samples_within_bounds(void **state)
{
  enum { ASKED = 1 << 20 };
  static const double distance[] = {1e-5, 1e-4, 1e-3}, most = 1e8;
  pendres_basin_sample sample = {ASKED, 1, 3, distance};
  pendres_basin_statistics first, again, whole;
  pendres_attractors *set = NULL;
  pendres_context *fresh = context_with_lanes(0), *other = context_with_lanes(96);
  check_ok(pendres_attractors_find(*state, &wada, 0, NULL, NULL, &set));

  double before = pendres_context_slopes(fresh);
  check_ok(pendres_basin_uncertainty_within(fresh, most, set, &turn, &sample, &first));
  const double spent = pendres_context_slopes(fresh) - before;
  if (!(spent > 0.5 * most && spent < most * 31.0 / 30.0))
    print_error("%zu states took %.3g of %.3g\n", first.states, spent, most);
  assert_true(spent > 0.5 * most && spent < most * 31.0 / 30.0);
  assert_true(first.states > 256 && first.states < ASKED);

  check_ok(pendres_basin_uncertainty_within(other, most, set, &turn, &sample, &again));
  assert_int_equal(again.states, first.states);
  check_ok(pendres_basin_uncertainty_within(fresh, most, set, &turn, &sample, &again));
  assert_int_equal(again.states, first.states);

  sample.n = first.states;
  check_ok(pendres_basin_uncertainty(*state, set, &turn, &sample, &whole));
  assert_memory_equal(whole.uncertain, first.uncertain, 3 * sizeof *whole.uncertain);
  check_near(whole.uncertainty_exponent, first.uncertainty_exponent, 0.0); /* the same states */
  pendres_attractors_free(set);
  pendres_context_free(fresh);
  pendres_context_free(other);
}

/*
 * More than half of the states uncertain at all distances: the first of a million tell, at the
 * 16 drive periods or so that a state of this pendulum takes, its share of runs again among them.
 */
static void samples_that_are_of_no_use(void **state)
{
  enum { ASKED = 1000000, LOOKED_AT = 256, EACH = 7 * 16 };
  static const double distance[] = {0.1, 0.3, 1.0};
  const pendres_basin_sample sample = {ASKED, 1, 3, distance};
  pendres_attractors *set = NULL;
  pendres_basin_statistics s;
  pendres_cost cost;
  check_ok(pendres_attractors_find(*state, &wada, 0, NULL, NULL, &set));
  pendres_context_cost_reset(*state);
  assert_int_equal(pendres_basin_uncertainty(*state, set, &turn, &sample, &s),
                   PENDRES_NOT_FOUND);
  pendres_context_cost(*state, &cost);
  assert_int_equal(s.states, LOOKED_AT);
  assert_true(s.uncertain[0] > 0.5 && isnan(s.uncertainty_exponent));
  if (!(cost.pendulum_periods < 2.0 * EACH * LOOKED_AT))
    print_error("%.4g periods\n", cost.pendulum_periods);
  assert_true(cost.pendulum_periods < 2.0 * EACH * LOOKED_AT);
  pendres_attractors_free(set);
}

/* ---- counts ---- */

/* Plain counts beside shares of the area, which weight the ends by half: 131 of 200 starts. */
static void counts_beside_areas(void **state)
{
  enum { N = 200, FIRST = 131 };
  double *x = spaced(N, 0.0, 1.0), fraction[2], error[2];
  const double rest = 0.0;
  const pendres_basin_grid grid = {.nx = N, .nv = 1, .x = x, .v = &rest};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  size_t states[2], n = 0;
  const pendres_basin_well *wells = NULL;
  (void)state;
  check_ok(pendres_basin_sums_create(&grid, 2, &sums));
  assert_int_equal(pendres_basin_sums_counts(sums, states), PENDRES_INVALID_ARGUMENT);
  for (int i = 0; i < N; i++)
    check_ok(pendres_basin_sums_add(sums, 1, &(pendres_basin_state){
                                               .attractor = i >= 10 && i < 10 + FIRST ? 0 : 1,
                                               .well = i % 3 - 1}));
  check_ok(pendres_basin_sums_result(sums, &s, fraction, error));
  check_ok(pendres_basin_sums_counts(sums, states));
  assert_int_equal(states[0], FIRST);
  assert_int_equal(states[1], N - FIRST);
  check_near(fraction[0], FIRST / (N - 1.0), 1e-12); /* 200 shares added up */
  /* The two ends of the basin are known to a step each. */
  assert_true(error[0] > 0.5 / N && error[0] < 4.0 / N);
  check_ok(pendres_basin_sums_wells(sums, &n, &wells));
  assert_int_equal(n, 6);
  size_t sum = 0;
  for (size_t i = 0; i < n; i++) {
    assert_int_equal(wells[i].attractor, i / 3);
    assert_int_equal(wells[i].well, (long)(i % 3) - 1);
    sum += wells[i].states;
  }
  assert_int_equal(sum, N);
  pendres_basin_sums_free(sums);
  free(x);
}

/* One attractor modulo a turn, in many wells: damping 0.1, drive cos t. Every state is counted. */
static void wells_of_one_attractor(void **state)
{
  enum { N = 64 };
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 1.0, .drive_frequency = 1.0};
  portrait q;
  pendres_basin_sums *sums = NULL;
  const pendres_basin_well *wells = NULL;
  size_t n = 0, states = 0;
  compute(*state, &p, N, N, 4.0, &q);
  assert_int_equal(pendres_attractors_count(q.set), 1);
  check_ok(pendres_basin_sums_create(&q.grid, 1, &sums));
  check_ok(pendres_basin_sums_add(sums, N, q.state));
  check_ok(pendres_basin_sums_wells(sums, &n, &wells));
  assert_true(n > 10);
  for (size_t i = 0; i < n; i++) {
    size_t there = 0;
    for (size_t k = 0; k < N * N; k++) there += q.state[k].well == wells[i].well;
    assert_int_equal(wells[i].states, there);
    assert_true(i == 0 || wells[i].well > wells[i - 1].well);
    states += there;
  }
  assert_int_equal(states, N * N);
  pendres_basin_sums_free(sums);
  release(&q);
}

/* Statistics of 50 x 10 states: columns 0 .. 2 in well 0, the others and the first five rows in
   well 1; of one attractor, or, with names, of an attractor for each well. */
enum { STRIP_ROWS = 50, STRIP_COLUMNS = 10, STRIP_EDGE = 3 };

static pendres_basin_statistics strip(pendres_basin_end by, int names, double *fraction,
                                      double *error)
{
  double *x = spaced(STRIP_ROWS, 0.0, 1.0), *v = spaced(STRIP_COLUMNS, 0.0, 1.0);
  const pendres_basin_grid grid = {.nx = STRIP_ROWS, .nv = STRIP_COLUMNS, .x = x, .v = v, .by = by};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  const pendres_basin_well *wells = NULL;
  size_t n = 0;
  check_ok(pendres_basin_sums_create(&grid, names ? 2 : 1, &sums));
  for (int i = 0; i < STRIP_ROWS; i++) {
    pendres_basin_state row[STRIP_COLUMNS] = {{0}};
    for (int j = 0; j < STRIP_COLUMNS; j++) {
      const int well = j >= STRIP_EDGE || i < PENDRES_BASIN_BOX;
      if (names) row[j].attractor = (int16_t)well;
      else row[j].well = well;
    }
    check_ok(pendres_basin_sums_add(sums, 1, row));
  }
  check_ok(pendres_basin_sums_result(sums, &s, names ? fraction : NULL, names ? error : NULL));
  check_ok(pendres_basin_sums_wells(sums, &n, &wells));
  assert_int_equal(n, 2);
  assert_int_equal(wells[0].states, STRIP_EDGE * (STRIP_ROWS - PENDRES_BASIN_BOX));
  for (size_t i = 0; i < n && !names; i++)
    fraction[i] = wells[i].fraction, error[i] = wells[i].fraction_error;
  pendres_basin_sums_free(sums);
  free(x);
  free(v);
  return s;
}

/*
 * By hand: of 20 boxes of 5 x 5 states 9 have a boundary, 15 states to 10; of the inner 8 columns 2
 * are within a step of it, in 45 of 50 rows. Columns and rows at the ends have half the weight, so
 * that well 0 has 2.5 of 9 columns, 44.5 of 49 rows. Sums of at most 500 terms, each rounded. By
 * well all is as it is by attractor where the wells are attractors.
 */
static void by_well(void **state)
{
  const double entropy = -(0.6 * log(0.6) + 0.4 * log(0.4));
  double fraction[2], error[2], named_fraction[2], named_error[2];
  (void)state;
  const pendres_basin_statistics one = strip(PENDRES_BASIN_BY_ATTRACTOR, 0, fraction, error);
  const pendres_basin_statistics s = strip(PENDRES_BASIN_BY_WELL, 0, fraction, error);
  const pendres_basin_statistics named =
    strip(PENDRES_BASIN_BY_ATTRACTOR, 1, named_fraction, named_error);
  check_near(one.entropy, 0.0, 0.0);
  check_near(one.uncertain[0], 0.0, 0.0);
  assert_true(isnan(one.boundary_entropy));
  check_near(s.boundary_boxes, 9.0 / 20.0, 1e-13);
  check_near(s.entropy, 9.0 / 20.0 * entropy, 1e-13);
  check_near(s.boundary_entropy, entropy, 1e-13);
  check_near(s.uncertain[0], 0.9 * 2.0 / 8.0, 1e-13);
  check_near(fraction[0], 2.5 / 9.0 * 44.5 / 49.0, 1e-13);
  check_near(fraction[0] + fraction[1], 1.0, 1e-13);
  check_near(s.entropy_error, named.entropy_error, 0.0);
  check_near(s.uncertain_error[0], named.uncertain_error[0], 0.0);
  for (int k = 0; k < 2; k++) {
    check_near(fraction[k], named_fraction[k], 1e-13);
    check_near(error[k], named_error[k], 1e-13);
  }
}

/* One attractor has no boundary, and so no exponent; its wells have one, and a fractal one. */
static void exponent_by_well(void **state)
{
  static const double distance[] = {1e-7, 6e-7, 3.6e-6, 2.16e-5};
  const pendres_basin_sample sample = {600, 1, 4, distance};
  const pendres_options options = {.tolerance = 1e-10};
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 1.0, .drive_frequency = 1.0};
  pendres_basin_window window = turn;
  pendres_basin_statistics s;
  pendres_attractors *set = NULL;
  pendres_context *ctx = context_with(&options);
  (void)state;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  assert_int_equal(pendres_basin_uncertainty(ctx, set, &window, &sample, &s), PENDRES_NOT_FOUND);
  window.by = PENDRES_BASIN_BY_WELL;
  check_ok(pendres_basin_uncertainty(ctx, set, &window, &sample, &s));
  assert_true(s.uncertain[0] > 0.0 && s.uncertain[0] < s.uncertain[3]);
  assert_true(s.uncertainty_exponent > 0.0 && s.uncertainty_exponent < 1.0);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/*
 * Wells of random starts of that pendulum against the long double reference, which shares no code:
 * it is followed for 250 periods, by when errors have shrunk by exp(-0.05 2 pi 250). A twentieth of
 * the starts may go elsewhere at a double's rounding; those are uncertain, and are left out.
 */
static void wells_by_reference(void **state)
{
  enum { N = 60, PERIODS = 250 };
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 1.0, .drive_frequency = 1.0};
  pendres_pendulum all[N];
  pendres_attractors *set = NULL;
  pendres_settled outcome[N];
  double x[N], v[N];
  uint64_t seed = 12;
  int compared = 0;
  for (int i = 0; i < N; i++) {
    all[i] = p;
    x[i] = -0.5 * pi + 2.0 * pi * next_random(&seed);
    v[i] = -4.0 + 8.0 * next_random(&seed);
  }
  check_ok(pendres_settle(*state, N, all, x, v, outcome, &set));
  for (int i = 0; i < N; i++) {
    long double y = (long double)x[i] - 1.57079632679489661923132169163975144L, w = v[i];
    long turns = 0;
    if (!outcome[i].certain) continue;
    check_ok(reference_advance(&p, &y, &w, &turns, PERIODS));
    assert_int_equal(outcome[i].well, turns);
    compared++;
  }
  assert_true(compared > N * 3 / 4);
  pendres_attractors_free(set);
}

/* ---- states that may belong elsewhere ---- */

/* Sums over a grid of two halves, with some states uncertain, and some suspected. */
static pendres_basin_statistics halves(size_t uncertain, double suspect, double *error)
{
  enum { N = 100, EDGE = N / 2 + 2 /* amid a column of boxes */ };
  double *x = spaced(N, 0.0, 1.0), fraction[2];
  const pendres_basin_grid grid = {.nx = N, .nv = N, .x = x, .v = x};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  size_t marked = 0;
  check_ok(pendres_basin_sums_create(&grid, 2, &sums));
  for (int i = 0; i < N; i++) {
    pendres_basin_state row[N] = {{0}};
    for (int j = 0; j < N; j++) {
      row[j].attractor = j >= EDGE;
      if (j == EDGE && marked < uncertain) {
        row[j].how = PENDRES_BASIN_UNCERTAIN;
        marked++;
      }
    }
    check_ok(pendres_basin_sums_add(sums, 1, row));
  }
  check_ok(pendres_basin_sums_suspect(sums, suspect));
  check_ok(pendres_basin_sums_result(sums, &s, fraction, error));
  pendres_basin_sums_free(sums);
  free(x);
  return s;
}

static void doubt_counts(void **state)
{
  double sure[2], doubt[2], suspect[2];
  (void)state;
  const pendres_basin_statistics a = halves(0, 0.0, sure), b = halves(60, 0.0, doubt),
                                 c = halves(0, 5.0, suspect);
  assert_int_equal(a.uncertain_states, 0);
  assert_int_equal(b.uncertain_states, 60);
  /* Twice the root of sixty, and six, of 10,000 states; five of them. */
  check_near(doubt[0] - sure[0], (2.0 * sqrt(60.0) + 6.0) / 1e4, 1e-12);
  check_near(suspect[0] - sure[0], 5.0 / 1e4, 1e-12);
  assert_true(b.entropy_error > a.entropy_error && c.entropy_error > a.entropy_error);
  assert_true(b.boundary_entropy_error > a.boundary_entropy_error);
  assert_true(c.uncertain_error[0] > a.uncertain_error[0]);
  check_near(b.entropy, a.entropy, 0.0);
}

/* Too few rows to tell how they scatter: errors are unknown, and are not guessed. */
static void few_rows(void **state)
{
  enum { ROWS = 12, N = 64 };
  double *x = spaced(ROWS, 0.0, 1.0), *v = spaced(N, 0.0, 1.0), fraction[2], error[2];
  const pendres_basin_grid grid = {.nx = ROWS, .nv = N, .x = x, .v = v};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  (void)state;
  check_ok(pendres_basin_sums_create(&grid, 2, &sums));
  for (int i = 0; i < ROWS; i++) {
    pendres_basin_state row[N] = {{0}};
    for (int j = 0; j < N; j++) row[j].attractor = j > 20 + i;
    check_ok(pendres_basin_sums_add(sums, 1, row));
  }
  check_ok(pendres_basin_sums_result(sums, &s, fraction, error));
  assert_true(isfinite(s.entropy) && isnan(s.entropy_error));
  assert_true(isfinite(s.uncertain[0]) && isnan(s.uncertain_error[0]));
  assert_true(isfinite(error[0]) && error[0] > 0.0);
  pendres_basin_sums_free(sums);
  free(x);
  free(v);
}

/* A grid without a boundary: shares and entropy are zero, and known to one state and one box. */
static void no_boundary(void **state)
{
  enum { ROWS = 40, N = 50 };
  double *x = spaced(ROWS, 0.0, 1.0), *v = spaced(N, 0.0, 1.0);
  const pendres_basin_grid grid = {.nx = ROWS, .nv = N, .x = x, .v = v};
  const pendres_basin_state row[N] = {{0}};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  (void)state;
  check_ok(pendres_basin_sums_create(&grid, 1, &sums));
  for (int i = 0; i < ROWS; i++) check_ok(pendres_basin_sums_add(sums, 1, row));
  check_ok(pendres_basin_sums_result(sums, &s, NULL, NULL));
  assert_true(s.entropy == 0.0 && s.uncertain[0] == 0.0);
  /* One unlike state in one of 8 x 10 boxes of 25. */
  check_near(s.entropy_error, (log(25.0) - 24.0 / 25.0 * log(24.0)) / 80.0, 1e-9);
  /* One unlike state of those that have neighbours on both sides. */
  check_near(s.uncertain_error[0], 1.0 / (ROWS * (N - 2)), 1e-15);
  pendres_basin_sums_free(sums);
  free(x);
  free(v);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(shifted_grids, setup, teardown),
    cmocka_unit_test_setup_teardown(exponents_of_other_seeds, setup, teardown),
    cmocka_unit_test_setup_teardown(samples_within_bounds, setup, teardown),
    cmocka_unit_test_setup_teardown(samples_that_are_of_no_use, setup, teardown),
    cmocka_unit_test(counts_beside_areas),
    cmocka_unit_test_setup_teardown(wells_of_one_attractor, setup, teardown),
    cmocka_unit_test(by_well),
    cmocka_unit_test(exponent_by_well),
    cmocka_unit_test_setup_teardown(wells_by_reference, setup, teardown),
    cmocka_unit_test(doubt_counts),
    cmocka_unit_test(few_rows),
    cmocka_unit_test(no_boundary),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
