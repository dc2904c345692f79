/*
 * test_basin_fractal.c -- fractal boundaries of basins: published facts, and the uncertainty
 * exponent against computations that share nothing with the library; and one that is not fractal.
 */
#include "basin_fixture.h"

#include <string.h>

#include "oracle/reference.h"

/*
 * The pendulum of Daza, Wagemakers, Sanjuán and Yorke, Scientific Reports 5 (2015) 16579: damping
 * 0.2, drive 1.66 cos t, three basins with the Wada property. Its boundary basin entropy is above
 * log 2, which two basins with a smooth boundary cannot reach.
 */
static const pendres_pendulum wada = {
  .damping = 0.2, .drive_amplitude = 1.66, .drive_frequency = 1.0};

static void wada_basins(void **state)
{
  enum { N = 200 };
  portrait p;
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics s;
  double fraction[3], error[3];
  compute(*state, &wada, N, N, 4.0, &p);
  assert_int_equal(pendres_attractors_count(p.set), 3);
  check_ok(pendres_basin_sums_create(&p.grid, 3, &sums));
  check_ok(pendres_basin_sums_add(sums, N, p.state));
  check_ok(pendres_basin_sums_result(sums, &s, fraction, error));
  assert_int_equal(s.unresolved, 0);
  assert_true(s.boundary_entropy > log(2.0) + 5.0 * s.boundary_entropy_error);
  check_near(fraction[0] + fraction[1] + fraction[2], 1.0, 1e-12);

  /* Wada: between two unlike neighbours a finer line finds the third basin. */
  enum { FINE = 2000 };
  size_t pairs = 0, all_three = 0;
  for (size_t k = 0; k + 1 < N * N && pairs < 40; k += 371) {
    if (k % N == N - 1 || p.state[k].attractor == p.state[k + 1].attractor) continue;
    double x[FINE], v[FINE];
    pendres_settled outcome[FINE];
    int seen[3] = {0};
    for (int i = 0; i < FINE; i++) {
      x[i] = p.x[k / N];
      v[i] = p.v[k % N] + (p.v[k % N + 1] - p.v[k % N]) * i / (FINE - 1.0);
    }
    check_ok(pendres_attractors_settle(*state, p.set, FINE, x, v, outcome));
    for (int i = 0; i < FINE; i++)
      if (outcome[i].attractor >= 0) seen[outcome[i].attractor] = 1;
    pairs++;
    all_three += seen[0] && seen[1] && seen[2];
  }
  assert_true(pairs >= 30);
  assert_int_equal(all_three, pairs);
  pendres_basin_sums_free(sums);
  release(&p);
}

/* Where a state goes by the reference alone: by its turns in the end, or by staying. */
static int fate_by_reference(double x, double v)
{
  long double y = (long double)x - (long double)(0.5 * pi), w = v;
  long turns = 0, before = 0;
  check_ok(reference_advance(&wada, &y, &w, &turns, 120));
  before = turns;
  check_ok(reference_advance(&wada, &y, &w, &turns, 20));
  return turns - before > 10 ? 1 : turns - before < -10 ? -1 : 0;
}

/*
 * The uncertainty exponent, and a share that it is made of once more by another way: random states
 * integrated by the reference for 140 periods and distinguished by their turns, with nothing of
 * trapping ellipses or orbits.
 */
static void uncertainty_exponent(void **state)
{
  static const double distance[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  const pendres_basin_window window = {
    .x_low = -0.5 * pi, .x_high = 1.5 * pi, .v_low = -4.0, .v_high = 4.0};
  pendres_attractors *set = NULL;
  pendres_basin_statistics s;
  check_ok(pendres_attractors_find(*state, &wada, 0, NULL, NULL, &set));
  check_ok(pendres_basin_uncertainty(*state, set, &window,
                                     &(pendres_basin_sample){4000, 1, 5, distance}, &s));
  assert_int_equal(s.unresolved, 0);
  /* A straight line over four decades: a fractal boundary of dimension 2 - 0.15. */
  assert_true(s.uncertainty_exponent_error < 0.05);
  check_near(s.uncertainty_exponent, 0.15, 0.02 + s.uncertainty_exponent_error);

  /* The reference's share of uncertain states, at one distance, by its own random states. */
  enum { SAMPLE = 80 };
  uint64_t z = 77;
  int uncertain = 0;
  for (int i = 0; i < SAMPLE; i++) {
    const double x = 2.0 * pi * (next_random(&z) - 0.25), v = 8.0 * (next_random(&z) - 0.5);
    const int fate = fate_by_reference(x, v);
    uncertain += fate_by_reference(x, v + 1e-2) != fate || fate_by_reference(x, v - 1e-2) != fate;
  }
  const double share = (double)uncertain / SAMPLE;
  const double spread = sqrt(s.uncertain[4] * (1.0 - s.uncertain[4]) / SAMPLE);
  check_near(share, s.uncertain[4], 4.0 * hypot(spread, s.uncertain_error[4]));
  pendres_attractors_free(set);
}

/* States of the pendulum above, one by one. */
static void fractal_labels(void **state)
{
  enum { SAMPLE = 100 };
  pendres_attractors *set = NULL;
  double x[SAMPLE], v[SAMPLE];
  pendres_settled outcome[SAMPLE];
  uint64_t z = 99;
  int differ = 0;
  check_ok(pendres_attractors_find(*state, &wada, 0, NULL, NULL, &set));
  for (int i = 0; i < SAMPLE; i++) {
    x[i] = 2.0 * pi * (next_random(&z) - 0.25);
    v[i] = 8.0 * (next_random(&z) - 0.5);
  }
  check_ok(pendres_attractors_settle(*state, set, SAMPLE, x, v, outcome));
  for (int i = 0; i < SAMPLE; i++) {
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome[i].attractor);
    const int turns = a->orbit.winding;
    differ += (turns > 0) - (turns < 0) != fate_by_reference(x[i], v[i]);
  }
  /* An error of 1e-7 or so moves 0.126 (1e-7 / 1e-6)^0.15 = 9 % of the states across the boundary:
     about half of these, two thirds of them to another basin; four standard deviations. */
  assert_true(differ <= 14);
  pendres_attractors_free(set);
}

/* ---- the exponent by another way ---- */

/* A pendulum of the test's own: angle and velocity, and the angle one and two periods ago. */
typedef struct plain {
  double y, v, back[2];
} plain;

enum { STEPS = 64, PATIENCE = 300 };

/* One drive period by the classical Runge-Kutta method; some 1e-6 are lost. */
static void swing(const pendres_pendulum *p, const double *drive, plain *s)
{
  const double h = 2.0 * pi / p->drive_frequency / STEPS, g = p->damping;
  s->back[1] = s->back[0];
  s->back[0] = s->y;
  for (int k = 0; k < STEPS; k++) {
    const double *f = drive + 2 * k, y = s->y, v = s->v;
    const double a1 = f[0] - g * v - sin(y);
    const double v2 = v + 0.5 * h * a1, a2 = f[1] - g * v2 - sin(y + 0.5 * h * v);
    const double v3 = v + 0.5 * h * a2, a3 = f[1] - g * v3 - sin(y + 0.5 * h * v2);
    const double v4 = v + h * a3, a4 = f[2] - g * v4 - sin(y + h * v3);
    s->y += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    s->v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
}

/* Turns in two periods, once these are whole for six periods in succession; 99: never. */
static int plain_fate(const pendres_pendulum *p, const double *drive, double y, double v)
{
  plain s = {.y = y, .v = v, .back = {INFINITY, INFINITY}};
  for (int n = 0, quiet = 0; n < PATIENCE; n++) {
    swing(p, drive, &s);
    const double turns = (s.y - s.back[1]) / (2.0 * pi);
    quiet = fabs(turns - rint(turns)) < 1e-4 ? quiet + 1 : 0;
    if (quiet == 6) return (int)rint(turns);
  }
  return 99;
}

/*
 * The exponent from random states at two distances. Its error: counts scatter like those of tosses,
 * as if those at one distance knew nothing of the other; they do, which makes it smaller.
 */
static double plain_exponent(const pendres_pendulum *p, int states, const double distance[2],
                             double *error)
{
  double drive[2 * STEPS + 1];
  int uncertain[2] = {0};
  uint64_t z = 2024;
  for (int k = 0; k <= 2 * STEPS; k++) drive[k] = p->drive_amplitude * cos(pi * k / STEPS);
  for (int i = 0; i < states; i++) {
    const double y = 2.0 * pi * (next_random(&z) - 0.5), v = 8.0 * (next_random(&z) - 0.5);
    const int fate = plain_fate(p, drive, y, v);
    assert_true(fate != 99);
    for (int k = 0; k < 2; k++)
      uncertain[k] += plain_fate(p, drive, y, v + distance[k]) != fate ||
                      plain_fate(p, drive, y, v - distance[k]) != fate;
  }
  double share[2], variance = 0.0;
  for (int k = 0; k < 2; k++) {
    share[k] = (double)uncertain[k] / states;
    variance += (1.0 - share[k]) / uncertain[k];
  }
  const double range = log(distance[1] / distance[0]);
  *error = sqrt(variance) / range;
  return log(share[1] / share[0]) / range;
}

/*
 * The exponents of two forced pendulums, damping 0.2, drive 1.66 cos t and 2 cos t, against
 * another integrator, another way to tell where a state has gone, and other random states.
 */
static void exponent_by_another_way(void **state)
{
  static const double distance[] = {1e-5, 1e-4, 1e-3, 1e-2}, ends[2] = {1e-5, 1e-2};
  static const struct { double drive; size_t attractors; } cases[] = {{1.66, 3}, {2.0, 2}};
  const pendres_basin_window window = {
    .x_low = -0.5 * pi, .x_high = 1.5 * pi, .v_low = -4.0, .v_high = 4.0};
  for (int i = 0; i < 2; i++) {
    const pendres_pendulum p = {
      .damping = 0.2, .drive_amplitude = cases[i].drive, .drive_frequency = 1.0};
    pendres_attractors *set = NULL;
    pendres_basin_statistics s;
    double error = 0.0;
    check_ok(pendres_attractors_find(*state, &p, 0, NULL, NULL, &set));
    assert_int_equal(pendres_attractors_count(set), cases[i].attractors);
    check_ok(pendres_basin_uncertainty(*state, set, &window,
                                       &(pendres_basin_sample){16000, 1, 4, distance}, &s));
    const double want = plain_exponent(&p, 3000, ends, &error);
    /* Measured: 0.145(8) and 0.154(7), 0.293(24) and 0.290(20). */
    assert_true(error < 0.03 && s.uncertainty_exponent_error < 0.03);
    check_near(s.uncertainty_exponent, want, 3.0 * hypot(error, s.uncertainty_exponent_error));
    pendres_attractors_free(set);
  }
}

/*
 * A grid whose boundary is at every distance that it has, of the first pendulum above, gets the
 * exponent of random states, which is 0.145(8) there; a grid without a boundary keeps what it has.
 */
static void exponent_in_place_of_a_grid(void **state)
{
  static const double ends[2][2] = {{-0.5 * PENDRES_PI, 1.5 * PENDRES_PI}, {-4.0, 4.0}};
  const pendres_basin_grid grid = {.nx = 2, .nv = 2, .x = ends[0], .v = ends[1]};
  pendres_basin_statistics s = {.states = 4, .uncertainty_exponent = 7.0, .scales = 3};
  const pendres_basin_statistics before = s;
  pendres_attractors *set = NULL;
  size_t states = 99;
  check_ok(pendres_attractors_find(*state, &wada, 0, NULL, NULL, &set));
  check_ok(pendres_basin_statistics_refine(*state, set, &grid, &s, &states));
  assert_int_equal(states, 0);
  assert_memory_equal(&s, &before, sizeof s);
  s.boundary_boxes = 1.0;
  s.uncertainty_exponent = s.uncertainty_exponent_error = NAN;
  check_ok(pendres_basin_statistics_refine(*state, set, &grid, &s, &states));
  assert_true(states > 1000 && s.scales > 3 && s.states == 4);
  assert_true(s.uncertainty_exponent_error < 0.03);
  check_near(s.uncertainty_exponent, 0.145, 3.0 * hypot(0.008, s.uncertainty_exponent_error));
  pendres_attractors_free(set);
}

/*
 * The exponent of random states, 0.30(1) by the slopes down to distances of 1e-8, is the same
 * whatever the tolerance, which once chose their distances: a finer one was worse. States that have
 * no time to settle are in the error, which then holds what they change.
 */
static void exponents_of_other_tolerances(void **state)
{
  static const double ends[2][2] = {{-0.5 * PENDRES_PI, 1.5 * PENDRES_PI}, {-4.0, 4.0}};
  static const struct { double tolerance; int budget; } with[] = {
    {1e-8, 0}, {1e-5, 0}, {1e-11, 0}, {1e-8, 20}};
  enum { N = sizeof with / sizeof *with };
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 2.0, .drive_frequency = 1.0};
  const pendres_basin_grid grid = {.nx = 2, .nv = 2, .x = ends[0], .v = ends[1]};
  double first = NAN;
  (void)state;
  for (int i = 0; i < N; i++) {
    const pendres_options options = {.tolerance = with[i].tolerance};
    pendres_basin_statistics s = {.states = 4, .boundary_boxes = 1.0, .uncertainty_exponent = NAN,
                                  .uncertainty_exponent_error = NAN};
    pendres_attractors *set = NULL;
    pendres_context *ctx = NULL, *hasty = NULL;
    size_t states = 0;
    check_ok(pendres_context_create(&options, &ctx));
    check_ok(pendres_context_create(&(pendres_options){.period_budget = with[i].budget}, &hasty));
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
    check_ok(pendres_basin_statistics_refine(with[i].budget > 0 ? hasty : ctx, set, &grid, &s,
                                             &states));
    const double error = s.uncertainty_exponent_error;
    if (i == 0) first = s.uncertainty_exponent;
    assert_int_equal(states, 16384);
    check_near(s.distance[0], 1e-5, 1e-20);
    check_near(s.uncertainty_exponent, 0.30, 3.0 * hypot(0.01, error));
    check_near(s.uncertainty_exponent, first, with[i].budget > 0 ? error : 0.1 * error);
    assert_true(with[i].budget > 0 ? error > 0.03 : error < 0.012);
    pendres_attractors_free(set);
    pendres_context_free(ctx);
    pendres_context_free(hasty);
  }
}

/* ---- strands that accumulate ---- */

enum { PARTS = 16, MOST_CROSSINGS = 400 };

/* Crossings of the boundary near those known, at a resolution PARTS times finer: where each begins.
   Looked for in the known interval and both beside it. */
static size_t refine_crossings(pendres_context *ctx, const pendres_attractors *set, double x,
                               double width, size_t known, double *at)
{
  double px[3 * PARTS + 1], v[3 * PARTS + 1], found[MOST_CROSSINGS];
  pendres_settled outcome[3 * PARTS + 1];
  const double step = width / PARTS;
  size_t n = 0;
  for (size_t i = 0; i < known; i++) {
    for (int k = 0; k <= 3 * PARTS; k++) {
      px[k] = x;
      v[k] = at[i] - width + step * k;
    }
    check_ok(pendres_attractors_settle(ctx, set, 3 * PARTS + 1, px, v, outcome));
    for (int k = 0; k < 3 * PARTS; k++) {
      if (outcome[k].attractor == outcome[k + 1].attractor) continue;
      if (n > 0 && v[k] <= found[n - 1] + 0.5 * step) continue; /* seen from its neighbour */
      assert_true(n < MOST_CROSSINGS);
      found[n++] = v[k];
    }
  }
  memcpy(at, found, n * sizeof *at);
  return n;
}

/*
 * The boundary of Fig. 7 is not fractal: its strands accumulate, shrinking by a constant factor, so
 * as many are added by each refinement. If their number grew as the power that shares of uncertain
 * states suggest (0.11), the last three refinements would add 2.6 times what the first three do;
 * measured: 12.75 a line by either.
 */
static void strands_of_fig7(void **state)
{
  enum { LINES = 8, LEVELS = 6, START = 8192 };
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-13});
  pendres_attractors *set = NULL;
  double *x = malloc(START * sizeof *x), *v = malloc(START * sizeof *v), at[MOST_CROSSINGS];
  pendres_settled *outcome = malloc(START * sizeof *outcome);
  double seen[LEVELS + 1] = {0.0};
  (void)state;
  assert_true(x != NULL && v != NULL && outcome != NULL);
  check_ok(pendres_attractors_find(ctx, &fig7, 0, NULL, NULL, &set));
  for (int line = 0; line < LINES; line++) {
    double width = 5.0 / (START - 1);
    size_t n = 0;
    for (int j = 0; j < START; j++) {
      x[j] = 2.0 * pi * ((line + 0.5) / LINES - 0.25);
      v[j] = -2.5 + width * j;
    }
    check_ok(pendres_attractors_settle(ctx, set, START, x, v, outcome));
    for (int j = 0; j + 1 < START; j++)
      if (outcome[j].attractor != outcome[j + 1].attractor && n < MOST_CROSSINGS) at[n++] = v[j];
    seen[0] += (double)n / LINES;
    for (int level = 1; level <= LEVELS; level++, width /= PARTS) {
      n = refine_crossings(ctx, set, x[0], width, n, at);
      seen[level] += (double)n / LINES;
    }
  }
  const double first = seen[3] - seen[0], last = seen[6] - seen[3];
  assert_true(first > 6.0 && last > 6.0); /* they go on */
  assert_true(last < 1.5 * first);        /* but not as a power */
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  free(x);
  free(v);
  free(outcome);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(wada_basins, setup, teardown),
    cmocka_unit_test_setup_teardown(uncertainty_exponent, setup, teardown),
    cmocka_unit_test_setup_teardown(fractal_labels, setup, teardown),
    cmocka_unit_test_setup_teardown(exponent_by_another_way, setup, teardown),
    cmocka_unit_test(exponents_of_other_tolerances),
    cmocka_unit_test_setup_teardown(exponent_in_place_of_a_grid, setup, teardown),
    cmocka_unit_test(strands_of_fig7),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
