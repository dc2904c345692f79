/*
 * test_trapping.c -- trapping ellipses: every state inside goes to the orbit at the centre.
 *
 * The ellipses are shown by rings in double precision; here states inside are followed one by one,
 * a part of them with the extended-precision reference, which shares no code with the rings.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "settling/attractor_set.h"
#include "golden.h"
#include "settling/trapping/trapping_ring.h"

static int setup(void **state)
{
  pendres_context *ctx = NULL;
  if (pendres_context_create(NULL, &ctx) != PENDRES_OK) return -1;
  *state = ctx;
  return 0;
}

static int teardown(void **state)
{
  pendres_context_free(*state);
  return 0;
}

static pendres_orbit orbit_near(pendres_context *ctx, const pendres_pendulum *p, double x, double v,
                                int period, int winding)
{
  pendres_orbit o;
  pendres_status outcome;
  const pendres_orbit_guess g = {
    .pendulum = *p, .x = x, .v = v, .period = period, .winding = winding};
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  return o;
}

/* Numbers in [0, 1) that are the same everywhere. */
static double next_random(uint64_t *z)
{
  *z = *z * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*z >> 11) * 0x1p-53;
}

/* A state of the ellipse, evenly over its area up to the share `reach` of its radius. */
static void state_inside(const pendres_trapping_ellipse *t, double reach, uint64_t *z, double *y,
                         double *w)
{
  const double r = reach * t->radius * sqrt(next_random(z)), a = 2.0 * pi * next_random(z);
  const double l11 = sqrt(t->metric[0]), l21 = t->metric[1] / l11;
  const double l22 = sqrt(t->metric[2] - l21 * l21);
  const double dw = r * sin(a) / l22;
  *y = t->y + (r * cos(a) - l21 * dw) / l11;
  *w = t->w + dw;
}

static double distance_to(const pendres_orbit *o, double x, double v)
{
  double dx = x - o->x;
  dx -= 2.0 * pi * rint(dx / (2.0 * pi));
  return hypot(dx, v - o->v);
}

/* States inside end on the orbit, in double precision and with the reference. */
static void check_inside(pendres_context *ctx, const pendres_orbit *o,
                         const pendres_trapping_ellipse *t,
                         size_t n, size_t by_reference, long periods, double close)
{
  uint64_t z = 1;
  pendres_pendulum *p = malloc(n * sizeof *p);
  double *x = malloc(n * sizeof *x), *v = malloc(n * sizeof *v);
  assert_true(p != NULL && x != NULL && v != NULL);
  const double omega = o->pendulum.drive_frequency;
  for (size_t i = 0; i < n; i++) {
    double y, w;
    state_inside(t, 1.0, &z, &y, &w);
    p[i] = o->pendulum;
    x[i] = y + 0.5 * pi;
    v[i] = w * omega;
    if (i >= by_reference) continue;
    long double ry = y, rv = v[i];
    check_ok(reference_advance(p, &ry, &rv, NULL, periods * o->period));
    check_near(distance_to(o, (double)ry + 0.5 * pi, (double)rv), 0.0, close);
  }
  check_ok(pendres_strobe_advance(ctx, n, p, x, v, periods * o->period, NULL));
  for (size_t i = 0; i < n; i++) check_near(distance_to(o, x[i], v[i]), 0.0, close);
  free(p);
  free(x);
  free(v);
}

static const pendres_pendulum fig7 = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962};

static void both_states(void **state)
{
  pendres_context *ctx = *state;
  const pendres_orbit orbits[2] = {orbit_near(ctx, &fig7, 2.11, 0.11, 1, 0),
                                   orbit_near(ctx, &fig7, 0.89, 1.55, 1, 0)};
  pendres_trapping_ellipse few[2], many[2];
  check_ok(pendres_trapping_find(ctx, 2, orbits, PENDRES_TRAPPING_FEW, few));
  check_ok(pendres_trapping_find(ctx, 2, orbits, PENDRES_TRAPPING_MANY, many));
  for (int i = 0; i < 2; i++) {
    /* Known sizes: semi-axes 1.10 x 1.01 and 1.10 x 0.24. They are found to a few percent. */
    assert_true(many[i].radius > 1.0 && many[i].radius < 1.25);
    assert_true(few[i].radius > many[i].radius / 1.5 && few[i].radius < many[i].radius * 1.05);
    /* After 60 periods distances have shrunk by exp(-0.06 * 480) = 3e-13 of at most one turn. */
    check_inside(ctx, &orbits[i], &many[i], 2000, 40, 60, 1e-8);
  }
  const double *m = many[1].metric;
  const double mean = 0.5 * (m[0] + m[2]), spread = hypot(0.5 * (m[0] - m[2]), m[1]);
  /* The longest semi-axis of the unit ellipse is one by definition. */
  check_near(mean - spread, 1.0, 1e-12);
  check_near(1.0 / sqrt(mean + spread), 0.24 / 1.10, 0.05);
}

/* In the metric of an ellipse the linear map shrinks every vector. */
static void metric_contracts(void **state)
{
  pendres_context *ctx = *state;
  static const double frequencies[] = {0.6, 0.75, 0.82, 0.829, 0.82918};
  int seen = 0;
  for (size_t k = 0; k < 5; k++) {
    pendres_pendulum p = {
      .damping = 0.06, .drive_amplitude = 0.2, .drive_frequency = frequencies[k]};
    const reference_cycle *fold = &golden_folds[0];
    reference_cycle c;
    /* The reference's own branch leads to the orbit: its small state below the fold. */
    if (reference_orbit(&p, 0.5L * fold->y, 0.1L, 1, 0, &c) != PENDRES_OK &&
        reference_orbit(&p, 0.97L * fold->y, 0.17L, 1, 0, &c) != PENDRES_OK)
      continue;
    const pendres_orbit o =
      orbit_near(ctx, &p, (double)c.y + 0.5 * pi, (double)c.v, 1, 0);
    pendres_trapping_ellipse t;
    check_ok(pendres_trapping_find(ctx, 1, &o, PENDRES_TRAPPING_FEW, &t));
    if (!o.stable) {
      assert_true(t.radius == 0.0);
      continue;
    }
    seen++;
    const double omega = p.drive_frequency;
    const double m[2][2] = {{o.monodromy[0][0], o.monodromy[0][1] * omega},
                            {o.monodromy[1][0] / omega, o.monodromy[1][1]}};
    for (int i = 0; i < 360; i++) {
      const double a = cos(i * pi / 180.0), b = sin(i * pi / 180.0);
      pendres_trapping_ellipse at_zero = t;
      at_zero.y = at_zero.w = 0.0;
      assert_true(pendres_trapping_norm2(&at_zero, m[0][0] * a + m[0][1] * b,
                                         m[1][0] * a + m[1][1] * b) <
                  pendres_trapping_norm2(&at_zero, a, b));
    }
  }
  assert_true(seen >= 3);
}

/* Close to a fold ellipses shrink with the distance to the saddle, but they do not lie. */
static void near_a_fold(void **state)
{
  pendres_context *ctx = *state;
  const reference_cycle *fold = &golden_folds[0];
  double last = 10.0;
  int seen = 0;
  for (double before = 1e-2; before > 1e-7; before /= 10.0) {
    const pendres_pendulum p = {.damping = (double)fold->damping,
                                .drive_amplitude = (double)fold->drive_amplitude,
                                .drive_frequency = (double)fold->drive_frequency - before};
    /* On the stable side of the square root that a fold is. */
    const double y = (double)fold->y - 1.4 * sqrt(before), v = (double)fold->v - 0.5 * sqrt(before);
    const pendres_orbit o = orbit_near(ctx, &p, y + 0.5 * pi, v, 1, 0);
    pendres_trapping_ellipse t;
    check_ok(pendres_trapping_find(ctx, 1, &o, PENDRES_TRAPPING_FEW, &t));
    if (!o.stable) continue;
    seen++;
    assert_true(t.radius > 0.0 && t.radius < last);
    last = t.radius;
    const double rate = -log(hypot(o.multiplier_re[0], o.multiplier_im[0]));
    /* Long enough to shrink the ellipse a thousandfold. */
    const double size = 4.0 * t.radius;
    check_inside(ctx, &o, &t, 100, 2, 10 + (long)(7.0 / rate), 1e-3 * size + 1e-8);
  }
  assert_true(seen >= 4 && last < 0.05);
}

/*
 * The saddle behind a fold is on the edge of the basin, so no ellipse may reach it, however close;
 * nor need an ellipse be much smaller than that where the linear map is all that matters. Extended
 * precision tells where the saddle is.
 */
static void short_of_the_saddle(void **state)
{
  const reference_cycle *fold = &golden_folds[0];
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-13}, &ctx));
  for (double before = 1e-2; before > 0.5e-12; before /= 10.0) {
    const pendres_pendulum p = {
      .damping = (double)fold->damping,
      .drive_amplitude = (double)fold->drive_amplitude,
      .drive_frequency = (double)(fold->drive_frequency - (long double)before)};
    reference_cycle node = {0}, saddle = {0}, one;
    for (int i = -6; i <= 6; i++) {
      const long double y = fold->y + 0.7L * i * sqrtl(before);
      if (reference_orbit(&p, y, fold->v, 1, 0, &one) != PENDRES_OK ||
          fabsl(one.y - fold->y) > 0.5L)
        continue;
      if (one.multiplier_re[0] > 1.0L) saddle = one;
      else node = one;
    }
    assert_true(node.period == 1 && saddle.period == 1);
    const pendres_orbit_guess g = {
      .pendulum = p, .x = (double)node.y + 0.5 * pi, .v = (double)node.v, .period = 1};
    for (int effort = PENDRES_TRAPPING_FEW; effort <= PENDRES_TRAPPING_MANY; effort++) {
      pendres_orbit o;
      pendres_status outcome;
      pendres_trapping_ellipse t;
      check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
      assert_true(outcome != PENDRES_NOT_CONVERGED && o.stable);
      check_ok(pendres_trapping_find(ctx, 1, &o, (pendres_trapping_effort)effort, &t));
      const double reach =
        sqrt(pendres_trapping_norm2(&t, (double)saddle.y, (double)(saddle.v / p.drive_frequency)));
      assert_true(t.radius < reach);
      assert_true(t.radius > 0.1 * reach);
    }
  }
  pendres_context_free(ctx);
}

static void unstable_orbits_have_none(void **state)
{
  pendres_context *ctx = *state;
  /* The pendulum standing upright, without a drive: a saddle. */
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 0.0, .drive_frequency = 1.0};
  const pendres_orbit o = orbit_near(ctx, &p, 1.5 * pi, 0.0, 1, 0);
  pendres_trapping_ellipse t;
  assert_false(o.stable);
  check_ok(pendres_trapping_find(ctx, 1, &o, PENDRES_TRAPPING_MANY, &t));
  assert_true(t.radius == 0.0);
}

/* A period-two orbit: each of its points has its own ellipse, for the twice iterated map. */
static void period_two(void **state)
{
  pendres_context *ctx = *state;
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.07, .drive_frequency = 2.0 / 3.0};
  const pendres_orbit o = orbit_near(ctx, &p, -0.636898, 1.346102, 2, 0);
  pendres_trapping_ellipse t;
  assert_true(o.stable);
  check_ok(pendres_trapping_find(ctx, 1, &o, PENDRES_TRAPPING_MANY, &t));
  assert_true(t.radius > 0.05);
  /* exp(-0.04 * 2 * 9.42 * 40) = 8e-14. */
  check_inside(ctx, &o, &t, 500, 10, 40, 1e-8);
}

/* A state of the region about an ellipse, evenly over its area: out of the largest square in which
   it may lie, since no unit vector of the metric is longer than one. */
static void state_of_region(const pendres_trapping_ellipse *t, uint64_t *z, double *y, double *w)
{
  do {
    *y = t->y + t->reach * (2.0 * next_random(z) - 1.0);
    *w = t->w + t->reach * (2.0 * next_random(z) - 1.0);
  } while (!pendres_trapping_holds(t, *y, *w));
}

/*
 * Around weakly damped orbits regions reach tens of times farther than ellipses whose linear map
 * outweighs the nonlinearity. Their polynomial falls in every period, by the reference; and states
 * settle on the orbit: after 16/gamma times two they are exp(-16) of their distance away.
 */
static void weak_damping(void **state)
{
  pendres_context *ctx = *state;
  enum { N = 64, BY_REFERENCE = 12 };
  static const struct {
    pendres_pendulum p;
    double x, v, least;
  } cases[] = {
    {{.damping = 2e-3, .drive_amplitude = 0.05, .drive_frequency = 0.8}, 1.71061, 0.0005, 0.5},
    {{.damping = 2e-3, .drive_amplitude = 0.05, .drive_frequency = 0.8}, -0.298015, 0.0771961, 0.3},
    {{.damping = 2e-4, .drive_amplitude = 0.02, .drive_frequency = 0.9}, 0.249115, 0.0132122, 0.2},
    {{.damping = 2e-3, .drive_amplitude = 1e-3, .drive_frequency = 1.001,
      .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.3, 1.0}}, 0.0, 0.0, 0.05}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    const pendres_pendulum *p = &cases[k].p;
    const double origin = p->force == PENDRES_FORCE_POLYNOMIAL ? 0.0 : 0.5 * pi;
    const pendres_orbit o = orbit_near(ctx, p, cases[k].x, cases[k].v, 1, 0);
    pendres_trapping_ellipse t;
    check_ok(pendres_trapping_find(ctx, 1, &o, PENDRES_TRAPPING_FEW, &t));
    assert_true(o.stable && t.radius > cases[k].least && t.reach > t.radius);
    uint64_t z = 1;
    pendres_pendulum same[N];
    double x[N], v[N];
    for (int i = 0; i < N; i++) {
      double y, w;
      state_of_region(&t, &z, &y, &w);
      same[i] = *p;
      x[i] = y + origin;
      v[i] = w * p->drive_frequency;
      if (i >= BY_REFERENCE) continue;
      long double ry = y, rv = v[i];
      const double before = pendres_trapping_polynomial(&t, y, w);
      check_ok(reference_advance(p, &ry, &rv, NULL, 1));
      assert_true(pendres_trapping_polynomial(&t, (double)ry, (double)rv / p->drive_frequency) <
                  before);
    }
    const long periods = (long)(32.0 / p->damping * p->drive_frequency / (2.0 * pi));
    check_ok(pendres_strobe_advance(ctx, N, same, x, v, periods, NULL));
    for (int i = 0; i < N; i++)
      check_near(hypot(remainder(x[i] - o.x, 2.0 * pi), v[i] - o.v), 0.0, 1e-5);
  }
}

/* An ellipse across the upright position, where angles jump by a turn: wells are counted right. */
static void across_the_top(void **state)
{
  pendres_trapping_ellipse t = {.y = 3.0, .metric = {1.0, 0.0, 1.0}, .radius = 0.5, .period = 1,
                    .turn = 2.0 * pi};
  int owner = 0;
  pendres_attractor_set c = {.count = 1, .ellipses = 1, .ellipse = &t, .owner = &owner};
  pendres_strobe_lane lane = {.y = 2.8, .turns = 4};
  long well = 99;
  (void)state;
  assert_ptr_equal(pendres_attractor_set_ellipse(&c, lane.y, lane.w), &t);
  assert_int_equal(pendres_attractor_set_locate(&c, &t, &lane, &well), 0);
  assert_int_equal(well, 4);
  /* -3.1 + 2 pi is 3.18: the same well as 3.0, though a turn has been counted. */
  lane.y = -3.1;
  assert_ptr_equal(pendres_attractor_set_ellipse(&c, lane.y, lane.w), &t);
  assert_int_equal(pendres_attractor_set_locate(&c, &t, &lane, &well), 0);
  assert_int_equal(well, 3);
  lane.w = 0.5;
  assert_null(pendres_attractor_set_ellipse(&c, lane.y, lane.w));
}

/* What an ellipse is does not depend on the others that it is looked for with. */
static void independent_of_company(void **state)
{
  pendres_context *ctx = *state;
  enum { N = 5 };
  pendres_orbit orbits[N];
  pendres_trapping_ellipse together[N], alone;
  for (int i = 0; i < N; i++) {
    pendres_pendulum p = fig7;
    p.damping = 0.12 + 0.005 * i;
    orbits[i] = orbit_near(ctx, &p, 2.11, 0.11, 1, 0);
  }
  check_ok(pendres_trapping_find(ctx, N, orbits, PENDRES_TRAPPING_FEW, together));
  for (int i = 0; i < N; i++) {
    check_ok(pendres_trapping_find(ctx, 1, &orbits[i], PENDRES_TRAPPING_FEW, &alone));
    assert_memory_equal(&alone, &together[i], sizeof alone);
  }
}

/* What is no number proves nothing. */
static void no_numbers(void **state)
{
  pendres_trapping_ellipse ellipse;
  pendres_orbit o = orbit_near(*state, &(pendres_pendulum){.damping = 0.24, .drive_amplitude = 0.2,
                                                           .drive_frequency = 0.9},
                               0.5 * pi + 0.5, 0.5, 1, 0);
  check_ok(pendres_trapping_find(*state, 1, &o, PENDRES_TRAPPING_FEW, &ellipse));
  assert_true(ellipse.radius > 0.01);
  o.x = NAN;
  check_ok(pendres_trapping_find(*state, 1, &o, PENDRES_TRAPPING_FEW, &ellipse));
  check_near(ellipse.radius, 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(both_states, setup, teardown),
    cmocka_unit_test_setup_teardown(metric_contracts, setup, teardown),
    cmocka_unit_test_setup_teardown(near_a_fold, setup, teardown),
    cmocka_unit_test(short_of_the_saddle),
    cmocka_unit_test_setup_teardown(unstable_orbits_have_none, setup, teardown),
    cmocka_unit_test_setup_teardown(period_two, setup, teardown),
    cmocka_unit_test_setup_teardown(weak_damping, setup, teardown),
    cmocka_unit_test(across_the_top),
    cmocka_unit_test_setup_teardown(no_numbers, setup, teardown),
    cmocka_unit_test_setup_teardown(independent_of_company, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
