/*
 * test_units_mixed.c -- pendulums of different units in one call: each result is what the pendulum
 * has alone, bit for bit, whatever its neighbours' units are.
 */
#include "units_fixture.h"

enum { N = 6, PERIODS = 3 };

/* Neighbours alike, others not, a plain pendulum among them. */
static const units of[N] = {{1.0, 1.0},   {0x1p-9, 1.0}, {0x1p-9, 1.0},
                            {1e6, 100.0}, {1.0, 1.0},    {0x1p-20, 0x1p-22}};

typedef struct many {
  pendres_context *ctx;
  pendres_pendulum p[N];
  double x[N], v[N];
} many;

static many make(void)
{
  many m = {.ctx = NULL};
  check_ok(pendres_context_create(NULL, &m.ctx));
  for (int i = 0; i < N; i++) {
    m.p[i] = in_units(duffing, of[i]);
    m.x[i] = 0.2 * of[i].length;
  }
  m.p[4] = (pendres_pendulum){.damping = 0.2, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  return m;
}

static void motions(void **state)
{
  many m = make();
  double x[N], v[N], error[N], alone;
  (void)state;
  memcpy(x, m.x, sizeof x);
  memcpy(v, m.v, sizeof v);
  check_ok(pendres_strobe_advance(m.ctx, N, m.p, x, v, PERIODS, error));
  for (int i = 0; i < N; i++) {
    double y = m.x[i], w = m.v[i];
    check_ok(pendres_strobe_advance(m.ctx, 1, &m.p[i], &y, &w, PERIODS, &alone));
    assert_true(y == x[i] && w == v[i] && alone == error[i]);
  }
  pendres_context_free(m.ctx);
}

static void attractors(void **state)
{
  many m = make();
  pendres_settled outcome[N], alone;
  pendres_attractors *found = NULL, *one = NULL;
  pendres_orbit_guess guess[N];
  pendres_orbit orbit[N], refined;
  pendres_status status[N];
  pendres_settled exponent[N], own;
  (void)state;
  check_ok(pendres_settle(m.ctx, N, m.p, m.x, m.v, outcome, &found));
  check_ok(pendres_lyapunov_find(m.ctx, N, m.p, m.x, m.v, NULL, exponent));
  for (int i = 0; i < N; i++) {
    check_ok(pendres_settle(m.ctx, 1, &m.p[i], &m.x[i], &m.v[i], &alone, &one));
    const pendres_attractor *a = pendres_attractors_get(found, (size_t)outcome[i].attractor);
    const pendres_attractor *b = pendres_attractors_get(one, (size_t)alone.attractor);
    assert_non_null(a);
    assert_memory_equal(a, b, sizeof *a);
    assert_int_equal(outcome[i].settling_periods, alone.settling_periods);
    assert_true(outcome[i].exponent == alone.exponent && outcome[i].exponent == a->lyapunov);
    guess[i] = (pendres_orbit_guess){m.p[i], a->orbit.x, a->orbit.v, a->orbit.period, 0};
    pendres_attractors_free(one);
    check_ok(pendres_lyapunov_find(m.ctx, 1, &m.p[i], &m.x[i], &m.v[i], NULL, &own));
    assert_true(exponent[i].exponent == own.exponent && exponent[i].label == own.label);
  }
  pendres_attractors_free(found);
  check_ok(pendres_orbit_find(m.ctx, N, guess, PENDRES_ORBIT_PLAIN, orbit, status));
  for (int i = 0; i < N; i++) {
    pendres_status own_status;
    check_ok(pendres_orbit_find(m.ctx, 1, &guess[i], PENDRES_ORBIT_PLAIN, &refined, &own_status));
    assert_int_equal(own_status, status[i]);
    assert_true(refined.x == orbit[i].x && refined.loop_area == orbit[i].loop_area &&
                refined.loop_area_error == orbit[i].loop_area_error);
  }
  pendres_context_free(m.ctx);
}

/* From the built-in starts, many parameter sets together: those of each alone, but for the size of
   their ellipses, which is found more exactly where many pendulums may follow. */
static void attractors_from_all_sides(void **state)
{
  many m = make();
  pendres_attractors *found = NULL, *one = NULL;
  size_t first = 0, set = 0;
  (void)state;
  check_ok(pendres_settle(m.ctx, N, m.p, NULL, NULL, NULL, &found));
  for (size_t i = 0; i < N; i++) {
    if (i > 0 && memcmp(&m.p[i], &m.p[i - 1], sizeof *m.p) == 0) continue; /* one set */
    check_ok(pendres_attractors_find(m.ctx, &m.p[i], 0, NULL, NULL, &one));
    const size_t count = pendres_attractors_count_of(found, set++);
    assert_true(count > 0);
    assert_int_equal(count, pendres_attractors_count(one));
    for (size_t k = 0; k < count; k++) {
      const pendres_attractor *a = pendres_attractors_get(found, first + k);
      const pendres_attractor *b = pendres_attractors_get(one, k);
      assert_int_equal(a->label, b->label);
      assert_memory_equal(&a->orbit, &b->orbit, sizeof a->orbit);
    }
    first += count;
    pendres_attractors_free(one);
  }
  assert_int_equal(first, pendres_attractors_count(found));
  assert_int_equal(pendres_attractors_count_of(found, set), 0);
  pendres_attractors_free(found);
  pendres_context_free(m.ctx);
}

/* What an observer was shown of each trajectory at the last strobe. */
static pendres_langevin_answer watch(void *arg, const pendres_langevin_strobe *s)
{
  double *seen = arg;
  for (size_t i = 0; i < s->count; i++) seen[s->first + i] = s->x[i];
  return PENDRES_LANGEVIN_GO_ON;
}

static void noise(void **state)
{
  many m = make();
  double x[N], v[N], seen[N];
  const pendres_langevin_observer observer = {watch, seen, 1};
  (void)state;
  for (int i = 0; i < N; i++) m.p[i].temperature = 0.001 * (i == 4 ? 1.0 : factor(of[i], 2, -2));
  memcpy(x, m.x, sizeof x);
  memcpy(v, m.v, sizeof v);
  const pendres_langevin_run run = {
    .n = N, .pendulums = m.p, .periods = PERIODS, .observer = &observer};
  check_ok(pendres_langevin_advance(m.ctx, &run, x, v));
  for (int i = 0; i < N; i++) {
    const uint64_t id = (uint64_t)i;
    const pendres_langevin_run one = {
      .n = 1, .pendulums = &m.p[i], .ids = &id, .periods = PERIODS};
    double y = m.x[i], w = m.v[i];
    check_ok(pendres_langevin_advance(m.ctx, &one, &y, &w));
    assert_true(y == x[i] && w == v[i] && seen[i] == x[i]);
  }
  pendres_context_free(m.ctx);
}

static void ensembles(void **state)
{
  many m = make();
  pendres_response all[N], one;
  const pendres_ensemble e = {.members = 4, .x_first = -1.0, .x_last = 1.5};
  (void)state;
  /* The same starts in the caller's units: in range for those of order one alone. */
  const int some[] = {0, 4, 0};
  pendres_pendulum p[3];
  for (int i = 0; i < 3; i++) p[i] = m.p[some[i]];
  p[2].force_coefficients[2] = 0.0625;
  check_ok(pendres_response_find(m.ctx, 3, p, &e, all));
  for (int i = 0; i < 3; i++) {
    check_ok(pendres_response_find(m.ctx, 1, &p[i], &e, &one));
    assert_true(one.mean_loop_area == all[i].mean_loop_area &&
                one.mean_loop_area_error == all[i].mean_loop_area_error &&
                one.mean_amplitude == all[i].mean_amplitude);
  }
  pendres_context_free(m.ctx);
}

/* A tolerance that one of the pendulums cannot have is refused with its unit. */
static void tolerances(void **state)
{
  many m = make();
  double x = m.x[3], v = 0.0;
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-12}, &ctx));
  assert_int_equal(pendres_strobe_advance(ctx, 1, &m.p[3], &x, &v, 1, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "unit of length, 5.24e+05"));
  x = m.x[0];
  check_ok(pendres_strobe_advance(ctx, 1, &m.p[0], &x, &v, 1, NULL));
  pendres_context_free(ctx);
  pendres_context_free(m.ctx);
}

/*
 * A coefficient that is lost beside the others is no scale: units are those without it. Other units
 * follow a power of two exactly, and a pendulum in its own units has 1 and 1.
 */
static void negligible(void **state)
{
  static const double lost[] = {6e-19, -6e-19, 1e-15, 1e-3};
  static const double rest[][3] = {{0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.7, -0.4, 0.0},
                                   {0.0, 3.0, 0.2}};
  static const double drive[] = {0.3, 0.0};
  (void)state;
  for (int i = 0; i < 4 * 4 * 2; i++) {
    const double *a = rest[i / 4 % 4];
    pendres_pendulum p = {.damping = 0.25, .drive_amplitude = drive[i / 16],
                          .drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL,
                          .force_coefficients = {lost[i % 4], a[0], a[1], a[2]}};
    const pendres_units u = pendres_units_of(&p);
    for (int k = -30; k <= 30; k += 15) {
      const units other = {ldexp(1.0, k), ldexp(1.0, 20 - k / 2)};
      const pendres_pendulum q = in_units(p, other);
      const pendres_units scaled = pendres_units_of(&q);
      assert_true(scaled.length == u.length * other.length && scaled.time == u.time * other.time);
    }
    const pendres_pendulum own = in_units(p, (units){1.0 / u.length, 1.0 / u.time});
    assert_true(pendres_units_of(&own).length == 1.0 && pendres_units_of(&own).time == 1.0);
    p.force_coefficients[0] = 0.0;
    const pendres_units without = pendres_units_of(&p);
    assert_int_equal(without.length == u.length && without.time == u.time, i % 4 < 3);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(motions), cmocka_unit_test(attractors),
                                     cmocka_unit_test(attractors_from_all_sides),
                                     cmocka_unit_test(noise), cmocka_unit_test(ensembles),
                                     cmocka_unit_test(tolerances),
                                     cmocka_unit_test(negligible)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
