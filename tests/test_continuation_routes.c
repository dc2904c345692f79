/*
 * test_continuation_routes.c -- the same folds and backbones by routes that share no step.
 *
 * A fold is solved for again on the strobe map of other integrators (adaptive blocks, one ARKODE
 * problem a pendulum, CVODE's Adams method), with derivatives by differences instead of variational
 * equations. A damped backbone must come down to the exact frequency of the free pendulum.
 */
#include <string.h>

#include <pendres/attractor.h>
#include <pendres/continuation.h>
#include <pendres/free.h>
#include <pendres/strobe.h>

#include "check.h"

static pendres_context *context_of(double tolerance, pendres_method method)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(
    &(pendres_options){.tolerance = tolerance, .method = method}, &ctx));
  return ctx;
}

static double determinant(const double a[3][3])
{
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/* u = (x, v, drive frequency): what a fold makes 0. *error: of the map. */
static void residual(pendres_context *ctx, double damping, const double u[3], double r[3],
                     double *error)
{
  /* Differences: their error, h^2, moves the point along the branch, and so the fold's frequency
     by its square. */
  static const double h = 1e-4;
  static const double off[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  pendres_pendulum p[5];
  double x[5], v[5], errors[5];
  for (int i = 0; i < 5; i++) {
    p[i] =
      (pendres_pendulum){.damping = damping, .drive_amplitude = 0.2, .drive_frequency = u[2]};
    x[i] = u[0] + h * off[i][0];
    v[i] = u[1] + h * off[i][1];
  }
  check_ok(pendres_strobe_advance(ctx, 5, p, x, v, 1, error != NULL ? errors : NULL));
  if (error != NULL) *error = errors[0];
  const double xx = (x[1] - x[2]) / (2 * h), xv = (x[3] - x[4]) / (2 * h);
  const double vx = (v[1] - v[2]) / (2 * h), vv = (v[3] - v[4]) / (2 * h);
  r[0] = x[0] - u[0];
  r[1] = v[0] - u[1];
  r[2] = (xx - 1) * (vv - 1) - xv * vx;
}

/* Newton's method from a place nearby; what the error of the map does to the frequency. */
static double solve_fold(pendres_context *ctx, double damping, double u[3])
{
  double r[3], map_error = 0.0, sensitivity = 0.0;
  for (int iteration = 0; iteration < 8; iteration++) {
    double a[3][3], moved[3];
    residual(ctx, damping, u, r, iteration == 7 ? &map_error : NULL);
    for (int k = 0; k < 3; k++) {
      double there[3] = {u[0], u[1], u[2]};
      there[k] += 1e-5;
      residual(ctx, damping, there, moved, NULL);
      for (int i = 0; i < 3; i++) a[i][k] = (moved[i] - r[i]) / 1e-5;
    }
    const double whole = determinant((const double(*)[3])a);
    double step[3];
    for (int k = 0; k < 3; k++) {
      double b[3][3];
      memcpy(b, a, sizeof b);
      for (int i = 0; i < 3; i++) b[i][k] = r[i];
      step[k] = determinant((const double(*)[3])b) / whole;
    }
    for (int k = 0; k < 3; k++) u[k] -= step[k];
    /* d frequency / d r[0] and r[1]: cofactors. */
    sensitivity = (fabs(a[1][0] * a[2][1] - a[1][1] * a[2][0]) +
                   fabs(a[0][0] * a[2][1] - a[0][1] * a[2][0])) / fabs(whole);
  }
  return sensitivity * map_error;
}

static void folds_by_other_integrators(void **state)
{
  (void)state;
  static const struct {
    double damping, frequency;
    size_t which;
  } cases[] = {{0.13, 0.8, 0}, {0.13, 0.8, 1}, {0.06, 0.75, 0}};
  static const pendres_method methods[] = {PENDRES_BLOCK_ADAPTIVE, PENDRES_SINGLE,
                                           PENDRES_CVODE_ADAMS};
  pendres_context *ctx = context_of(1e-9, PENDRES_BLOCK_FIXED);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const pendres_pendulum p = {.damping = cases[i].damping,
                                .drive_amplitude = 0.2,
                                .drive_frequency = cases[i].frequency};
    pendres_attractors *found = NULL;
    pendres_fold fold;
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
    check_ok(
      pendres_fold_find(ctx, &pendres_attractors_get(found, cases[i].which)->orbit,
                        PENDRES_DRIVE_FREQUENCY, &fold));
    pendres_attractors_free(found);
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
      pendres_context *other = context_of(1e-12, methods[m]);
      double u[3] = {fold.orbit.x + 1e-3, fold.orbit.v - 1e-3, fold.value + 1e-4};
      const double error = solve_fold(other, cases[i].damping, u);
      check_near(u[2], fold.value, error + fold.value_error);
      pendres_context_free(other);
    }
  }
  pendres_context_free(ctx);
}

/*
 * Where the lag is pi/2 the drive meets friction, and what is left is the free pendulum: with
 * damping and drive in proportion the amplitude stays and the frequency tends to the elliptic
 * integral's, by the square of the damping; with a fold ever closer at the larger amplitudes.
 */
static void backbone_tends_to_the_free_pendulum(void **state)
{
  (void)state;
  static const double ratio[] = {0.3, 0.5, 1.0, 1.4, 1.6};
  pendres_context *ctx = context_of(1e-11, PENDRES_BLOCK_FIXED);
  for (size_t k = 0; k < sizeof ratio / sizeof *ratio; k++) {
    pendres_pendulum p[3];
    pendres_orbit o[3];
    double error[3], away[3];
    pendres_status outcome[3];
    for (int i = 0; i < 3; i++)
      p[i] = (pendres_pendulum){.damping = 0.1 * pow(0.5, i),
                                .drive_amplitude = 0.1 * ratio[k] * pow(0.5, i)};
    check_ok(pendres_backbone_find(ctx, 3, p, o, error, outcome));
    for (int i = 0; i < 3; i++) {
      check_ok(outcome[i]);
      away[i] = o[i].pendulum.drive_frequency - pendres_free_frequency(o[i].amplitude);
      /* What is left are third harmonics, of the damping squared. */
      assert_true(error[i] <= 1e-11);
      check_near(away[i], 0.0, 1e-2 * p[i].damping * p[i].damping);
      /* The next order is a hundredth of that at the larger damping. */
      if (i > 0) check_relative(away[i - 1], 4.0 * away[i], 0.01);
    }
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(folds_by_other_integrators),
    cmocka_unit_test(backbone_tends_to_the_free_pendulum),
  };
  return cmocka_run_group_tests_name("continuation_routes", tests, NULL, NULL);
}
