/*
 * test_basin.c -- basins over grids: labels against far tighter runs and the reference, the
 * refinement against the whole grid, and the statistics on sets whose numbers are known.
 */
#include "basin_fixture.h"

#include "oracle/reference.h"

#include "analysis/basins/uncertainty.h"

static int alike(const pendres_basin_state *a, const pendres_basin_state *b)
{
  return a->attractor == b->attractor && a->label == b->label && a->well == b->well;
}

/* ---- labels ---- */

/* However the rows are cut, and whatever the blocks: the same states. */
static void cutting(void **state)
{
  portrait p;
  compute(*state, &fig7, 60, 50, 2.5, &p);
  pendres_basin_state *again = malloc(60 * 50 * sizeof *again);
  size_t *index = malloc(60 * 50 * sizeof *index);
  assert_true(again != NULL && index != NULL);
  pendres_context *small = context_with(&(pendres_options){.block_lanes = 16});
  for (size_t first = 0; first < 60; first += 7) {
    const size_t rows = 60 - first < 7 ? 60 - first : 7;
    check_ok(pendres_basin_rows(small, p.set, &p.grid, first, rows, again + first * 50));
  }
  for (size_t k = 0; k < 60 * 50; k++) {
    assert_true(alike(&again[k], &p.state[k]) && again[k].how != PENDRES_BASIN_DEFERRED);
    assert_int_equal(again[k].settling_periods, p.state[k].settling_periods);
    index[k] = 60 * 50 - 1 - k;
  }
  check_ok(pendres_basin_states(small, p.set, &p.grid, 60 * 50, index, again));
  for (size_t k = 0; k < 60 * 50; k++) assert_true(alike(&again[k], &p.state[index[k]]));
  pendres_context_free(small);
  free(again);
  free(index);
  release(&p);
}

/* How far a state is from one that goes elsewhere: within a factor 2, above 1e-9. */
static double distance_from_boundary(pendres_context *ctx, const pendres_attractors *set, double x,
                                     double v, const pendres_settled *own)
{
  enum { AROUND = 16 };
  double px[AROUND], pv[AROUND];
  pendres_settled outcome[AROUND];
  for (double r = 1e-9; r < 1.0; r *= 2.0) {
    for (int i = 0; i < AROUND; i++) {
      px[i] = x + r * cos(2.0 * pi * i / AROUND);
      pv[i] = v + r * sin(2.0 * pi * i / AROUND);
    }
    check_ok(pendres_attractors_settle(ctx, set, AROUND, px, pv, outcome));
    for (int i = 0; i < AROUND; i++)
      if (outcome[i].attractor != own->attractor || outcome[i].well != own->well) return r;
  }
  return INFINITY;
}

/* N x N states at a tolerance against 1e-12, where attractors are found again: at most so many may
   differ, all of them so near to a boundary. */
static void check_labels(double tolerance, size_t most, double near)
{
  enum { N = 256 };
  pendres_context *loose = context_with(&(pendres_options){.tolerance = tolerance});
  pendres_context *tight = context_with(&(pendres_options){.tolerance = 1e-12});
  pendres_attractors *set = NULL;
  portrait p;
  compute(loose, &fig7, N, N, 2.5, &p);
  double *x = malloc(N * N * sizeof *x), *v = malloc(N * N * sizeof *v);
  pendres_settled *outcome = malloc(N * N * sizeof *outcome);
  assert_true(x != NULL && v != NULL && outcome != NULL);
  for (size_t k = 0; k < N * N; k++) {
    x[k] = p.x[k / N];
    v[k] = p.v[k % N];
  }
  check_ok(pendres_basin_attractors(tight, &fig7, &p.grid, &set));
  assert_int_equal(pendres_attractors_count(set), pendres_attractors_count(p.set));
  check_ok(pendres_attractors_settle(tight, set, N * N, x, v, outcome));
  size_t differ = 0;
  for (size_t k = 0; k < N * N; k++) {
    if (outcome[k].attractor == p.state[k].attractor && outcome[k].well == p.state[k].well)
      continue;
    differ++;
    assert_true(distance_from_boundary(tight, set, x[k], v[k], &outcome[k]) <= near);
  }
  assert_true(differ <= most);
  pendres_attractors_free(set);
  pendres_context_free(loose);
  pendres_context_free(tight);
  free(x);
  free(v);
  free(outcome);
  release(&p);
}

/*
 * Labels against a far tighter run. At the default tolerance none of 2048 x 2048 states differed,
 * so none of a 64th of them may. At 1e-3 there were 67 of 1024 x 1024, within 7e-5 of a boundary: a
 * sixteenth of that and four standard deviations more, and twice the distance, which is found
 * within a factor 2.
 */
static void tighter(void **state)
{
  (void)state;
  check_labels(1e-8, 0, 0.0);
  check_labels(1e-3, 12, 1.4e-4);
}

/*
 * The mirror image of the grid under the drive turned round: the same labels and settling times,
 * wells with the other sign. The mirrored grid is rounded: 1e-16, far below what decides a label.
 */
static void mirror_image(void **state)
{
  enum { NX = 120, NV = 100 };
  pendres_pendulum q = fig7;
  portrait p, m;
  q.drive_amplitude = -q.drive_amplitude;
  compute(*state, &fig7, NX, NV, 2.5, &p);
  compute(*state, &q, NX, NV, 2.5, &m); /* the window is its own mirror image */
  assert_int_equal(pendres_attractors_count(p.set), pendres_attractors_count(m.set));
  for (size_t i = 0; i < pendres_attractors_count(p.set); i++) {
    const pendres_orbit *a = &pendres_attractors_get(p.set, i)->orbit;
    const pendres_orbit *b = &pendres_attractors_get(m.set, i)->orbit;
    double x = b->x, v = b->v;
    x = PENDRES_PI - x, v = -v;
    check_near(x, a->x, a->x_error + b->x_error);
    check_near(v, a->v, a->v_error + b->v_error);
    check_near(b->amplitude, a->amplitude, a->amplitude_error + b->amplitude_error);
    check_near(b->phase_lag, a->phase_lag, a->phase_lag_error + b->phase_lag_error);
    check_near(b->loop_area, a->loop_area, a->loop_area_error + b->loop_area_error);
    check_near(b->multiplier_re[0], a->multiplier_re[0], a->multiplier_error + b->multiplier_error);
  }
  for (size_t i = 0; i < NX; i++)
    for (size_t j = 0; j < NV; j++) {
      const pendres_basin_state *a = &p.state[i * NV + j];
      const pendres_basin_state *b = &m.state[(NX - 1 - i) * NV + NV - 1 - j];
      assert_int_equal(a->label, b->label);
      assert_int_equal(a->well, -b->well);
      assert_int_equal(a->settling_periods, b->settling_periods);
    }
  release(&p);
  release(&m);
}

/* Random states of the grid against the extended-precision reference, which shares no code. */
static void against_the_reference(void **state)
{
  enum { N = 100, SAMPLE = 150 };
  portrait p;
  uint64_t z = 11;
  compute(*state, &fig7, N, N, 2.5, &p);
  for (int i = 0; i < SAMPLE; i++) {
    const size_t k = (size_t)(next_random(&z) * N * N);
    long double y = (long double)p.x[k / N] - (long double)(0.5 * pi), v = p.v[k % N];
    long turns = 0;
    check_ok(reference_advance(&fig7, &y, &v, &turns, 100));
    /* exp(-0.06 * 800) = 1e-21: what is left is the error of the orbit itself. */
    const pendres_orbit *o = &pendres_attractors_get(p.set, (size_t)p.state[k].attractor)->orbit;
    double dx = (double)y + 0.5 * pi - o->x;
    const double whole = rint(dx / (2.0 * pi));
    dx -= 2.0 * pi * whole;
    check_near(hypot(dx, (double)v - o->v), 0.0, 1e-8);
    assert_int_equal(turns + (long)whole, p.state[k].well);
  }
  release(&p);
}

/* A thousandth of the spacing, within limits. */
static void accuracy(void **state)
{
  const double coarse[3] = {0.0, 0.5, 1.0}, fine[3] = {0.0, 0.001, 0.5}, finest[2] = {0.0, 1e-6};
  const pendres_basin_grid a = {.nx = 3, .nv = 3, .x = coarse, .v = coarse};
  const pendres_basin_grid b = {.nx = 3, .nv = 3, .x = fine, .v = coarse};
  const pendres_basin_grid c = {.nx = 3, .nv = 2, .x = coarse, .v = finest};
  const pendres_basin_grid one = {.nx = 1, .nv = 1, .x = coarse, .v = coarse};
  check_relative(pendres_basin_accuracy(*state, &a), 1e-5, 1e-12);
  check_relative(pendres_basin_accuracy(*state, &b), 1e-6, 1e-12);
  /* Ten times the tolerance, which is 1e-8 by default. */
  check_relative(pendres_basin_accuracy(*state, &c), 1e-7, 1e-12);
  check_relative(pendres_basin_accuracy(*state, &one), 1e-7, 1e-12);
  /* A tolerance tighter than the default is kept, whatever the grid. */
  pendres_context *tight = context_with(&(pendres_options){.tolerance = 1e-10});
  check_relative(pendres_basin_accuracy(tight, &a), 1e-9, 1e-12);
  check_relative(pendres_basin_accuracy(tight, &c), 1e-9, 1e-12);
  pendres_context_free(tight);
}

/*
 * Long transients, after which labels were those of the accuracy: of a grid at the default
 * tolerance six in ten were not those of an exact integration. Labels that are certain do not
 * depend on the tolerance. At 1e-12 and at the default 48 of 144 are: down to rounding transients
 * of hundreds of periods leave no more.
 */
static void certain_after_long_transients(void **state)
{
  enum { N = 12 };
  const pendres_pendulum p = {.damping = 0.03900408562322141,
                              .drive_amplitude = 0.7471100769387439,
                              .drive_frequency = 0.7827231855620003};
  pendres_context *tight = context_with(&(pendres_options){.tolerance = 1e-12});
  portrait q, r;
  size_t uncertain = 0, differ = 0;
  compute(*state, &p, N, N, 2.0, &q);
  compute(tight, &p, N, N, 2.0, &r);
  assert_int_equal(pendres_attractors_count(q.set), pendres_attractors_count(r.set));
  for (size_t k = 0; k < N * N; k++) {
    const int sure =
      q.state[k].how == PENDRES_BASIN_INTEGRATED && r.state[k].how == PENDRES_BASIN_INTEGRATED;
    uncertain += !sure;
    differ += sure && !alike(&q.state[k], &r.state[k]);
  }
  assert_int_equal(differ, 0);
  assert_true(uncertain < 3 * N * N / 4);
  pendres_context_free(tight);
  release(&q);
  release(&r);
}

/* ---- refinement ---- */

static void follow(pendres_context *ctx, const pendres_attractors *set,
                   const pendres_basin_grid *grid, pendres_basin_plan *plan)
{
  for (;;) {
    size_t n = 0;
    const size_t *index = NULL;
    check_ok(pendres_basin_plan_next(plan, &n, &index));
    if (n == 0) return;
    pendres_basin_state *state = malloc(n * sizeof *state);
    assert_non_null(state);
    check_ok(pendres_basin_states(ctx, set, grid, n, index, state));
    check_ok(pendres_basin_plan_accept(plan, state));
    free(state);
  }
}

/* A refined grid is the whole grid, for a fraction of the work. */
static void refined(void **state)
{
  enum { N = 400, SAMPLE = 10000 };
  pendres_context *ctx = *state;
  portrait p;
  pendres_basin_plan *plan = NULL;
  pendres_basin_state *filled = malloc(N * N * sizeof *filled);
  pendres_basin_state *sample = malloc(SAMPLE * sizeof *sample);
  const size_t *index = NULL;
  size_t drawn = 0, missed = 1, wrong = 0, integrated = 0;
  assert_true(filled != NULL && sample != NULL);
  compute(ctx, &fig7, N, N, 2.5, &p);
  check_ok(pendres_basin_plan_create(&p.grid, 0, N, 0, &plan));
  follow(ctx, p.set, &p.grid, plan);
  check_ok(pendres_basin_plan_states(plan, filled));
  for (size_t k = 0; k < N * N; k++) {
    wrong += !alike(&filled[k], &p.state[k]);
    if (filled[k].how == PENDRES_BASIN_INTEGRATED) {
      integrated++;
      assert_int_equal(filled[k].settling_periods, p.state[k].settling_periods);
    } else {
      assert_int_equal(filled[k].settling_periods, -2);
    }
  }
  assert_int_equal(wrong, 0);
  assert_int_equal(integrated, pendres_basin_plan_integrated(plan));
  /* Some rows at a time: the same, and none beyond the plan's. */
  check_ok(pendres_basin_plan_rows(plan, N - 2, 2, sample));
  assert_memory_equal(sample, filled + (N - 2) * N, 2 * N * sizeof *sample);
  assert_int_equal(pendres_basin_plan_rows(plan, N - 2, 3, sample), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_plan_rows(plan, N + 1, 0, sample), PENDRES_INVALID_ARGUMENT);
  /* About 2.3 states along each of 35 / 0.0125 steps of boundary, and the coarse lattice. */
  assert_true(integrated < N * N / 4);

  check_ok(pendres_basin_plan_sample(plan, SAMPLE, 3, &drawn, &index));
  assert_int_equal(drawn, SAMPLE);
  for (size_t k = 0; k < drawn; k++) assert_int_equal(filled[index[k]].how, PENDRES_BASIN_FILLED);
  check_ok(pendres_basin_states(ctx, p.set, &p.grid, drawn, index, sample));
  check_ok(pendres_basin_plan_verify(plan, sample, &missed));
  assert_int_equal(missed, 0);
  pendres_basin_plan_free(plan);
  free(filled);
  free(sample);
  release(&p);
}

/* Wells that 32 bits number are those of pendres_settled; beyond them nothing is told. */
static void distant_wells(void **state)
{
  pendres_context *ctx = *state;
  enum { N = 4 };
  const double x[N] = {-3e10, -1e10, 1e10, 3e10}, v[1] = {0.0}, still[N] = {0.0};
  const size_t index[N] = {0, 1, 2, 3};
  const pendres_basin_grid grid = {.nx = N, .nv = 1, .x = x, .v = v};
  pendres_attractors *set = NULL;
  pendres_settled outcome[N];
  pendres_basin_state s[N];
  check_ok(pendres_attractors_find(ctx, &fig7, 0, NULL, NULL, &set));
  check_ok(pendres_attractors_settle(ctx, set, N, x, still, outcome));
  check_ok(pendres_basin_states(ctx, set, &grid, N, index, s));
  for (size_t i = 0; i < N; i++) {
    assert_true(outcome[i].attractor >= 0);
    const int near = fabs(x[i]) < 2e10;
    assert_int_equal(s[i].attractor, near ? outcome[i].attractor : PENDRES_ATTRACTOR_UNKNOWN);
    assert_int_equal(s[i].label, near ? outcome[i].label : PENDRES_LABEL_UNRESOLVED);
    assert_true(near ? s[i].well == outcome[i].well : s[i].settling_periods == -1);
  }
  pendres_attractors_free(set);
}

/* ---- mistakes ---- */

static void mistakes(void **state)
{
  pendres_context *ctx = *state;
  const double one[1] = {0.0};
  const pendres_basin_grid grid = {.nx = 1, .nv = 1, .x = one, .v = one};
  const pendres_basin_grid empty = {.nx = 0, .nv = 1, .x = one, .v = one};
  pendres_attractors *set = NULL;
  pendres_basin_state s;
  pendres_basin_plan *plan = NULL;
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics statistics;
  size_t n = 0;
  const size_t beyond = 1, *index = NULL;
  assert_int_equal(pendres_basin_attractors(ctx, &fig7, &empty, &set), PENDRES_INVALID_ARGUMENT);
  check_ok(pendres_basin_attractors(ctx, &fig7, &grid, &set));
  assert_int_equal(pendres_basin_rows(ctx, set, &grid, 1, 1, &s), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_states(ctx, set, &grid, 1, &beyond, &s),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_plan_create(&grid, 0, 1, 3, &plan), PENDRES_INVALID_ARGUMENT);
  assert_null(plan);
  check_ok(pendres_basin_plan_create(&grid, 0, 1, 0, &plan));
  assert_int_equal(pendres_basin_plan_accept(plan, &s), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_plan_states(plan, &s), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_plan_sample(plan, 1, 0, &n, &index), PENDRES_INVALID_ARGUMENT);
  pendres_basin_plan_free(plan);
  pendres_basin_plan_free(NULL);
  check_ok(pendres_basin_sums_create(&grid, 1, &sums));
  assert_int_equal(pendres_basin_sums_result(sums, &statistics, NULL, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_basin_sums_add(sums, 2, &s), PENDRES_INVALID_ARGUMENT);
  pendres_basin_sums_free(sums);
  pendres_basin_sums_free(NULL);
  pendres_attractors_free(set);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(cutting, setup, teardown),
    cmocka_unit_test(tighter),
    cmocka_unit_test_setup_teardown(mirror_image, setup, teardown),
    cmocka_unit_test_setup_teardown(against_the_reference, setup, teardown),
    cmocka_unit_test_setup_teardown(accuracy, setup, teardown),
    cmocka_unit_test_setup_teardown(certain_after_long_transients, setup, teardown),
    cmocka_unit_test_setup_teardown(refined, setup, teardown),
    cmocka_unit_test_setup_teardown(distant_wells, setup, teardown),
    cmocka_unit_test_setup_teardown(mistakes, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
