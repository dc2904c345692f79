/*
 * test_langevin_order.c -- the integrator of noisy pendulums converges as stated.
 */
#include "langevin_fixture.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_integration.h>

#include "noise/langevin_block.h"

/* Classical Runge-Kutta, many steps: an independent answer at temperature zero. */
static void reference(const pendres_pendulum *p, int periods, double *x, double *v)
{
  enum { STEPS = 4096 };
  const double h = 2.0 * PI / p->drive_frequency / STEPS;
  for (int k = 0; k < periods * STEPS; k++) {
    const double t = k % STEPS * h;
    const double a1 = pendres_pendulum_acceleration(p, *x, *v, t);
    const double v2 = *v + 0.5 * h * a1;
    const double a2 = pendres_pendulum_acceleration(p, *x + 0.5 * h * *v, v2, t + 0.5 * h);
    const double v3 = *v + 0.5 * h * a2;
    const double a3 = pendres_pendulum_acceleration(p, *x + 0.5 * h * v2, v3, t + 0.5 * h);
    const double v4 = *v + h * a3;
    const double a4 = pendres_pendulum_acceleration(p, *x + h * v3, v4, t + h);
    *x += h / 6.0 * (*v + 2.0 * (v2 + v3) + v4);
    *v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
  }
}

static void no_temperature_is_deterministic(void **state)
{
  (void)state;
  /* Soft and hard, friction strong, weak and none, slow and fast drive; other forces. */
  static const pendres_pendulum cases[] = {
    {.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.785},
    {.drive_amplitude = 0.3, .drive_frequency = 0.6},
    {.damping = 5.0, .drive_amplitude = 1.0, .drive_frequency = 1.3},
    {.damping = 0.3, .drive_frequency = 1.0},
    {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.1, .torque = 0.6,
     .parametric_amplitude = 0.8},
    {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.1, .torque = 0.2,
     .parametric_amplitude = 0.5, .force = PENDRES_FORCE_POLYNOMIAL,
     .force_coefficients = {0.5, 0.2, 0.3, -0.1, 0.05}}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    double x0 = 0.4, v0 = 1.2, error[3];
    reference(&cases[c], 3, &x0, &v0);
    for (int j = 0; j < 3; j++) {
      double x = 0.4, v = 1.2;
      pendres_context *ctx = make(1, j == 2 ? 3000 : 64 << j, 8);
      check_ok(pendres_langevin_advance(ctx, RUN(1, &cases[c], NULL, 0, 3, NULL), &x, &v));
      error[j] = hypot(x - x0, v - v0);
      pendres_context_free(ctx);
    }
    /* Order four: 64 to 128 steps gain 16, less what the next order still adds (h < 0.1). */
    check_near(log2(error[0] / error[1]), 4.0, 0.25);
    /* Order four from 128 to 3000 steps, times 2 for the same reason; 1e-11 is what the
     * reference itself is good for (h = 0.0025, h^4 / 120 a unit of time, amplified). */
    check_near(error[2], 0.0, 2.0 * error[1] * pow(128.0 / 3000.0, 4.0) + 1e-11);
  }
}

/*
 * Expected values without sampling: each kick's Gaussian number takes the points of
 * Gauss-Hermite quadrature, one lane for each combination of all kicks of a period.
 */
static double points[16], weights[16];
static int point_count;
static uint32_t this_call;

static void count_call(size_t stride, const uint64_t *id, uint32_t period, uint32_t call,
                       const uint32_t key[2], uint64_t *words)
{
  (void)stride, (void)id, (void)period, (void)key, (void)words;
  this_call = call;
}

static void quadrature_points(size_t stride, const uint64_t *words, double *gauss)
{
  (void)words;
  for (size_t row = 0; row < 4; row++)
    for (size_t i = 0; i < stride; i++) {
      size_t digit = i;
      for (size_t k = 0; k < 4 * this_call + row; k++) digit /= (size_t)point_count;
      gauss[row * stride + i] = points[digit % (size_t)point_count];
    }
}

/* Ends of one period in n steps from one point, with `count` points a kick, and their weights. */
typedef struct ends {
  pendres_langevin_block block;
  double *weight;
} ends;

static void reach_ends(const pendres_pendulum *p, int n, int count, ends *e)
{
  pendres_kernels_langevin kernels = *pendres_kernels_langevin_select();
  gsl_integration_fixed_workspace *rule =
    gsl_integration_fixed_alloc(gsl_integration_fixed_hermite, (size_t)count, 0.0, 0.5, 0.0, 0.0);
  pendres_langevin_block *b = &e->block;
  size_t lanes = 1;

  assert_non_null(rule);
  point_count = count;
  memcpy(points, gsl_integration_fixed_nodes(rule), (size_t)count * sizeof *points);
  memcpy(weights, gsl_integration_fixed_weights(rule), (size_t)count * sizeof *weights);
  gsl_integration_fixed_free(rule);
  for (int k = 0; k < 2 * n; k++) lanes *= (size_t)count;
  *e = (ends){.weight = malloc(lanes * sizeof *e->weight)};
  assert_non_null(e->weight);
  check_ok(pendres_langevin_block_make(b, (lanes + 7) / 8 * 8, 0));
  kernels.words = count_call;
  kernels.gauss = quadrature_points;
  b->kernels = &kernels;
  check_ok(pendres_langevin_block_set_steps(b, n));
  pendres_langevin_block_resize(b, lanes);
  for (size_t i = 0; i < lanes; i++) {
    size_t digits = i;
    pendres_langevin_block_load(b, i, p, i, 0.9, 0.7);
    e->weight[i] = 1.0;
    for (int k = 0; k < 2 * n; k++) {
      e->weight[i] *= weights[digits % (size_t)count] / sqrt(2.0 * PI);
      digits /= (size_t)count;
    }
  }
  pendres_langevin_block_finish(b);
  pendres_langevin_block_period(b, 0);
  b->kernels = NULL;
}

static void clear_ends(ends *e)
{
  pendres_langevin_block_clear(&e->block);
  free(e->weight);
}

/* E of v^2, sin x and x v. */
static void expect(const pendres_pendulum *p, int n, int count, double out[3])
{
  ends e;
  reach_ends(p, n, count, &e);
  out[0] = out[1] = out[2] = 0.0;
  for (size_t i = 0; i < e.block.count; i++) {
    const double x = e.block.x[i], v = e.block.v[i];
    out[0] += e.weight[i] * v * v;
    out[1] += e.weight[i] * sin(x);
    out[2] += e.weight[i] * x * v;
  }
  clear_ends(&e);
}

static void weak_order_is_four(void **state)
{
  (void)state;
  /* Duration 0.4 in 1, 2, 4 steps, no drive, strong noise. Gauss-Hermite with 4 points a kick
   * is exact to degree 7: it is wrong by the eighth derivative times (gamma T h)^4/1680, less
   * than 1e-7 relative to what one kick adds. */
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 0.0,
                              .drive_frequency = 2.0 * PI / 0.4, .temperature = 1.0};
  double one[3], two[3], four[3];
  expect(&p, 1, 16, one);
  expect(&p, 2, 16, two);
  expect(&p, 4, 4, four);
  for (int i = 0; i < 3; i++) {
    /* The next orders still add some h^2 = 0.04 of the difference. */
    const double order = log2(fabs(one[i] - two[i]) / fabs(two[i] - four[i]));
    print_message("weak order: %.2f (bias of one step %.1e)\n", order, one[i] - four[i]);
    check_near(order, 4.0, 0.15);
  }
}

/* Errors of the covariance, to first order in T, that a driven period in n steps adds up. */
static void covariance_errors(const pendres_pendulum *p, int n, double error[3])
{
  pendres_langevin_linear lin;
  ends e;
  double x = 0.0, v = 0.0;
  check_ok(pendres_langevin_linear_find(p, 0.9, 0.7, 1, &lin));
  /* With two points a kick, +-1, only the fourth cumulant is wrong: T relative. */
  reach_ends(p, n, 2, &e);
  for (size_t i = 0; i < e.block.count; i++) {
    x += e.weight[i] * e.block.x[i];
    v += e.weight[i] * e.block.v[i];
  }
  error[0] = -lin.injected.xx, error[1] = -lin.injected.xv, error[2] = -lin.injected.vv;
  for (size_t i = 0; i < e.block.count; i++) {
    const double dx = e.block.x[i] - x, dv = e.block.v[i] - v;
    error[0] += e.weight[i] * dx * dx;
    error[1] += e.weight[i] * dx * dv;
    error[2] += e.weight[i] * dv * dv;
  }
  clear_ends(&e);
}

/* The same with drive, for which a period is a period; and with other forces. */
static void weak_order_is_four_driven(void **state)
{
  const pendres_pendulum cases[] = {
    {.damping = 1.0, .drive_amplitude = 1.5, .drive_frequency = 2.0 * PI / 1.6,
     .temperature = 1e-8},
    {.damping = 1.0, .drive_amplitude = 1.5, .drive_frequency = 2.0 * PI / 1.6,
     .temperature = 1e-8, .torque = 0.7, .parametric_amplitude = 0.3},
    {.damping = 1.0, .drive_amplitude = 1.5, .drive_frequency = 2.0 * PI / 1.6,
     .temperature = 1e-8, .torque = -0.2, .parametric_amplitude = 0.2,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {0.8, 0.1, 0.2, 0.0, 0.03}}};
  (void)state;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    double error[2][3];
    for (int j = 0; j < 2; j++) covariance_errors(&cases[c], 4 << j, error[j]);
    for (int i = 0; i < 3; i++) {
      const double order = log2(fabs(error[0][i]) / fabs(error[1][i]));
      print_message("weak order, driven: %.2f (relative bias of 8 steps %.1e)\n", order,
                    error[1][i] / cases[c].temperature);
      /* From 4 to 8 steps; the next orders add some (h = 0.4)^2 of the difference, and some
       * (pi/4)^2 where the force itself goes with the drive's phase. */
      check_near(order, 4.0, cases[c].parametric_amplitude == 0.0 ? 0.2 : 0.6);
    }
  }
}

/* A ring whose inductance changes: coefficient a1 falls from 0.6 to 0.5 in a period. */
static pendres_pendulum opening_ring(void *arg, double time)
{
  (void)arg;
  return (pendres_pendulum){ .damping = 0.3, .drive_amplitude = 0.4, .drive_frequency = 0.7,
                             .force = PENDRES_FORCE_SQUID,
                             .force_coefficients = { 0.6 - 0.1 * time } };
}

/* Without noise lanes that start alike do alike, whichever coefficients of their force move. */
static void lanes_move_alike(void **state)
{
  enum { ALIKE = 16 };
  const pendres_pendulum p = opening_ring(NULL, 0.0);
  pendres_langevin_block b = { 0 };
  (void)state;
  check_ok(pendres_langevin_block_make(&b, ALIKE, 0));
  check_ok(pendres_langevin_block_set_steps(&b, 40));
  pendres_langevin_block_resize(&b, ALIKE);
  for (size_t i = 0; i < ALIKE; i++) pendres_langevin_block_load(&b, i, &p, i, 0.8, 0.1);
  pendres_langevin_block_finish(&b);
  check_ok(pendres_langevin_block_moving(&b, 0, opening_ring, NULL));
  for (size_t i = 1; i < ALIKE; i++) {
    assert_true(b.x[i] == b.x[0]);
    assert_true(b.v[i] == b.v[0]);
  }
  pendres_langevin_block_clear(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_temperature_is_deterministic),
    cmocka_unit_test(lanes_move_alike),
    cmocka_unit_test(weak_order_is_four),
    cmocka_unit_test(weak_order_is_four_driven),
  };
  return cmocka_run_group_tests_name("langevin_order", tests, NULL, NULL);
}
