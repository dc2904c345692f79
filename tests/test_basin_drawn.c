/*
 * test_basin_drawn.c -- refinement and statistics of basins that are drawn instead of integrated,
 * so that the results are known.
 */
#include "basin_fixture.h"

#include "oracle/reference.h"

/* ---- refinement ---- */

/* Answers from a picture instead of a pendulum. */
typedef int picture(size_t row, size_t column);

/* States that are wrong in the end; *missed: how many samples have met, if not NULL. */
static size_t draw(picture *f, size_t rows, size_t columns, int stride, uint64_t seed,
                   size_t sample, size_t *missed)
{
  const double zero[1] = {0.0};
  const pendres_basin_grid grid = {.nx = rows, .nv = columns, .x = zero, .v = zero};
  pendres_basin_plan *plan = NULL;
  size_t n = 1, wrong = 0, met = 1;
  const size_t *index = NULL;
  pendres_basin_state *state = calloc(rows * columns, sizeof *state);
  assert_non_null(state);
  check_ok(pendres_basin_plan_create(&grid, 0, rows, stride, &plan));
  if (missed != NULL) *missed = 0;
  while (met > 0) {
    for (;;) {
      check_ok(pendres_basin_plan_next(plan, &n, &index));
      if (n == 0) break;
      for (size_t k = 0; k < n; k++)
        state[k].attractor = (int16_t)f(index[k] / columns, index[k] % columns);
      check_ok(pendres_basin_plan_accept(plan, state));
    }
    if (missed == NULL) break;
    check_ok(pendres_basin_plan_sample(plan, sample, seed++, &n, &index));
    for (size_t k = 0; k < n; k++)
      state[k].attractor = (int16_t)f(index[k] / columns, index[k] % columns);
    check_ok(pendres_basin_plan_verify(plan, state, &met));
    *missed += met;
  }
  check_ok(pendres_basin_plan_states(plan, state));
  for (size_t k = 0; k < rows * columns; k++)
    wrong += state[k].attractor != f(k / columns, k % columns);
  pendres_basin_plan_free(plan);
  free(state);
  return wrong;
}

static int diagonal(size_t row, size_t column)
{
  return 3 * row > 2 * column + 17;
}

/* A line one state wide, which meets the coarse lattice in a single point, (32, 0). */
static int thread(size_t row, size_t column)
{
  return row == 32 + column / 3;
}

/* A dot that no point of the coarse lattice meets. */
static int dot(size_t row, size_t column)
{
  return row >= 21 && row < 25 && column >= 35 && column < 39;
}

/* Nine of them. */
static int dots(size_t row, size_t column)
{
  return row % 16 >= 5 && row % 16 < 9 && column % 16 >= 4 && column % 16 < 8 && row < 48 &&
         column < 48;
}

static void pictures(void **state)
{
  size_t missed = 0;
  (void)state;
  assert_int_equal(draw(diagonal, 101, 77, 16, 0, 2048, NULL), 0);
  assert_int_equal(draw(diagonal, 101, 77, 4, 0, 2048, NULL), 0);
  assert_int_equal(draw(diagonal, 64, 64, 1, 0, 2048, NULL), 0);
  assert_int_equal(draw(diagonal, 1, 300, 16, 0, 2048, NULL), 0);
  assert_int_equal(draw(diagonal, 300, 1, 16, 0, 2048, NULL), 0);
  assert_int_equal(draw(diagonal, 1, 1, 16, 0, 2048, NULL), 0);
  /* Met by the lattice somewhere, and followed from there. */
  assert_int_equal(draw(thread, 128, 128, 16, 0, 2048, NULL), 0);
  /* Nine dots, most of which no sample of sixty meets: one that is met makes the lattice finer, and
     so the others are found. */
  assert_int_equal(draw(dots, 64, 64, 16, 0, 60, &missed), 0);
  assert_true(missed > 0);
  /* Missed, found by the sample, and then put right. */
  assert_int_equal(draw(dot, 64, 64, 16, 0, 2048, NULL), 16);
  assert_int_equal(draw(dot, 64, 64, 16, 7, 2048, &missed), 0);
  assert_true(missed > 0 && missed <= 16);
}

/* ---- statistics ---- */

static pendres_basin_statistics describe(picture *f, size_t rows, size_t columns, int attractors,
                                         double *fraction, double *error)
{
  double *x = spaced(rows, 0.0, 1.0), *v = spaced(columns, 0.0, 1.0);
  const pendres_basin_grid grid = {.nx = rows, .nv = columns, .x = x, .v = v};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  pendres_basin_state *row = calloc(columns, sizeof *row);
  assert_non_null(row);
  check_ok(pendres_basin_sums_create(&grid, (size_t)attractors, &sums));
  for (size_t i = 0; i < rows; i++) {
    for (size_t j = 0; j < columns; j++) row[j].attractor = (int16_t)f(i, j);
    check_ok(pendres_basin_sums_add(sums, 1, row));
  }
  check_ok(pendres_basin_sums_result(sums, &s, fraction, error));
  pendres_basin_sums_free(sums);
  free(x);
  free(v);
  free(row);
  return s;
}

static int slanted(size_t row, size_t column)
{
  return 1000 * column > 300 * 1000 + 137 * row;
}

/* A straight boundary: an exponent of 1, and an area that is known. */
static void straight_boundary(void **state)
{
  enum { N = 1000 };
  double fraction[2], error[2];
  (void)state;
  const pendres_basin_statistics s = describe(slanted, N, N, 2, fraction, error);
  assert_int_equal(s.states, N * N);
  assert_int_equal(s.unresolved, 0);
  /* In steps: half the way from column 300 to 301 is 300.5, and 0.137 more each row; the window
     begins and ends at the outermost states. */
  const double exact = (N - 1 - (300.5 - 0.5 + 0.137 * 499.5)) / (N - 1);
  check_near(fraction[1], exact, 3.0 * error[1] + 0.5 / N * 0.5);
  check_near(fraction[0] + fraction[1], 1.0, 1e-9); /* a million shares added up */
  assert_true(error[0] > 0.0 && error[0] < 1e-3);
  /* Each row has two uncertain states at distance 1, four at 2, ...: exactly proportional, but for
     the states left out at both ends, a relative 2 * 16 / N at the largest distance used. */
  check_near(s.uncertainty_exponent, 1.0, 0.02);
  check_near(s.uncertainty_exponent, 1.0, 3.0 * s.uncertainty_exponent_error);
  check_near(s.uncertain[0], 2.0 / (N - 2.0), 1e-12);
  check_near(s.distance[3] / s.distance[0], 8.0, 1e-12);
  /* A line that crosses a box anywhere and hardly slants shares it as 1/5, ... 4/5. */
  double mean = 0.0;
  for (int k = 1; k < 5; k++) {
    const double share = k / 5.0;
    mean -= 0.25 * (share * log(share) + (1.0 - share) * log(1.0 - share));
  }
  check_near(s.boundary_entropy, mean, 0.05);
  assert_true(s.boundary_entropy < log(2.0));
  check_near(s.entropy, s.boundary_entropy * s.boundary_boxes, 1e-12);
}

/* Distances on a grid that is not evenly spaced mean nothing: no exponent is made of them. */
static void uneven(void **state)
{
  enum { N = 64 };
  double x[N], v[N], fraction[2];
  pendres_basin_state row[N] = {{0}};
  const pendres_basin_grid grid = {.nx = N, .nv = N, .x = x, .v = v};
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  (void)state;
  for (int i = 0; i < N; i++) x[i] = v[i] = (double)i * i;
  for (int j = N / 2; j < N; j++) row[j].attractor = 1;
  check_ok(pendres_basin_sums_create(&grid, 2, &sums));
  for (int i = 0; i < N; i++) check_ok(pendres_basin_sums_add(sums, 1, row));
  check_ok(pendres_basin_sums_result(sums, &s, fraction, NULL));
  assert_true(isnan(s.uncertainty_exponent) && isnan(s.uncertainty_exponent_error));
  assert_int_equal(s.scales, 0);
  /* Half the way between 31^2 and 32^2. */
  check_near(fraction[0], 0.5 * (31.0 * 31.0 + 32.0 * 32.0) / (63.0 * 63.0), 1e-12);
  pendres_basin_sums_free(sums);
}

/* Everything at random: every box is a boundary box, with the entropy of 25 tosses of a coin. */
static int coin(size_t row, size_t column)
{
  uint64_t z = (row * 65536 + column + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (int)(z >> 63);
}

static void tossed(void **state)
{
  double expected = 0.0;
  (void)state;
  for (int k = 1; k < 25; k++) {
    const double p = k / 25.0, ways = exp(lgamma(26.0) - lgamma(k + 1.0) - lgamma(26.0 - k));
    expected -= ways * 0x1p-25 * (p * log(p) + (1.0 - p) * log(1.0 - p));
  }
  const pendres_basin_statistics s = describe(coin, 500, 500, 2, NULL, NULL);
  check_near(s.boundary_boxes, 1.0, 1e-12);
  check_near(s.boundary_entropy, expected, 4.0 * s.boundary_entropy_error);
  assert_true(s.boundary_entropy_error < 1e-3);
  /* Neighbours at any distance are as unlike as any: nothing to fit, or a slope of nought. */
  assert_true(isnan(s.uncertainty_exponent) || fabs(s.uncertainty_exponent) < 0.05);
}

/* One basin alone has no boundary. */
static int nothing(size_t row, size_t column)
{
  (void)row;
  (void)column;
  return 0;
}

static void no_boundary(void **state)
{
  double fraction[1], error[1];
  (void)state;
  const pendres_basin_statistics s = describe(nothing, 50, 50, 1, fraction, error);
  assert_true(isnan(s.boundary_entropy) && isnan(s.uncertainty_exponent));
  check_near(fraction[0], 1.0, 1e-12);
  check_near(s.entropy, 0.0, 0.0);
}

/* The middle thirds that are taken away belong to basin 0, 1, 0, ... by their size: their boundary
   is Cantor's set in v, of dimension log 2 / log 3. */
static int cantor(size_t row, size_t column)
{
  (void)row;
  size_t part = 6561;
  for (int level = 0; part > 1; level++) {
    part /= 3;
    const size_t third = column / part;
    if (third == 1) return level % 2;
    column -= third * part;
  }
  return 0;
}

static void cantor_set(void **state)
{
  (void)state;
  const pendres_basin_statistics s = describe(cantor, 32, 6561, 2, NULL, NULL);
  const double exact = 1.0 - log(2.0) / log(3.0);
  check_near(s.uncertainty_exponent, exact, 2.0 * s.uncertainty_exponent_error);
  /* The set looks alike on scales 3 apart, distances are 2 apart: slopes between them scatter. */
  assert_true(s.uncertainty_exponent_error < 0.5);
  check_near(s.uncertainty_exponent, exact, 0.05);
}

/* States at rest on top of a barrier, as the middle column here, are an answer, and no error. */
static void rest_is_an_answer(void **state)
{
  enum { ROWS = 40, N = 50, TOP = 25 };
  double *x = spaced(ROWS, 0.0, 1.0), *v = spaced(N, 0.0, 1.0), error[2][2];
  const pendres_basin_grid grid = {.nx = ROWS, .nv = N, .x = x, .v = v};
  (void)state;
  for (int rest = 0; rest < 2; rest++) {
    pendres_basin_state row[N] = {{0}};
    pendres_basin_sums *sums = NULL;
    pendres_basin_statistics s;
    for (int j = 0; j < N; j++) row[j].attractor = j > TOP;
    row[TOP].attractor = rest ? PENDRES_ATTRACTOR_UNSTABLE : PENDRES_ATTRACTOR_UNKNOWN;
    check_ok(pendres_basin_sums_create(&grid, 2, &sums));
    for (int i = 0; i < ROWS; i++) check_ok(pendres_basin_sums_add(sums, 1, row));
    check_ok(pendres_basin_sums_result(sums, &s, NULL, error[rest]));
    assert_int_equal(s.unresolved, rest ? 0 : ROWS);
    pendres_basin_sums_free(sums);
  }
  check_near(error[0][0] - error[1][0], 1.0 / (N - 1), 1e-12); /* the column's share of the area */
  free(x);
  free(v);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rest_is_an_answer),
    cmocka_unit_test(pictures),
    cmocka_unit_test(straight_boundary),
    cmocka_unit_test(tossed),
    cmocka_unit_test(no_boundary),
    cmocka_unit_test(uneven),
    cmocka_unit_test(cantor_set),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
