/* test_model.c -- torque, parametric drive and polynomial forces against exact results. */
#include "check.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_sf_elljac.h>

#include <pendres/pendres.h>

#include "engine/context_internal.h"
#include "engine/block.h"
#include "model/model.h"
#include "model/parameter.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double pi = 3.14159265358979323846, half_pi = 1.57079632679489661923;

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

static pendres_orbit orbit_near(pendres_context *ctx, const pendres_pendulum *p, double x, double v,
                                int winding)
{
  const pendres_orbit_guess g = {.pendulum = *p, .x = x, .v = v, .period = 1, .winding = winding};
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  return o;
}

/* ---- what is said of a model ---- */

static void facts(void **state)
{
  (void)state;
  assert_string_equal(pendres_model_of(PENDRES_FORCE_PENDULUM)->name, "pendulum");
  assert_int_equal(pendres_model_of(PENDRES_FORCE_POLYNOMIAL)->coefficients, 5);
  assert_null(pendres_model_of(PENDRES_FORCE_COUNT));
  pendres_pendulum p = {.drive_frequency = 1.0};
  assert_true(pendres_pendulum_symmetric(&p));
  p.torque = 0.1;
  assert_false(pendres_pendulum_symmetric(&p));
  p = (pendres_pendulum){
    .drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1, 0, 1}};
  assert_true(pendres_pendulum_symmetric(&p));
  p.force_coefficients[3] = 0.5;
  assert_false(pendres_pendulum_symmetric(&p));
  assert_false(pendres_pendulum_symmetric(NULL));
}

/* Acceleration, Jacobian and potential belong together: central differences, good to step^2. */
static void derivatives(void **state)
{
  static const pendres_pendulum cases[] = {
    {.drive_frequency = 1.0, .torque = 0.3},
    {.drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL, .torque = -0.2,
     .force_coefficients = {0.7, -0.3, 0.4, 0.2, -0.1}}};
  const double step = 1e-5, x = 0.8;
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_pendulum *p = &cases[i];
    double by_x, by_v;
    pendres_model_jacobian(p, x, 0.3, &by_x, &by_v);
    const double high = pendres_pendulum_acceleration(p, x + step, 0.0, 0.0);
    const double low = pendres_pendulum_acceleration(p, x - step, 0.0, 0.0);
    check_near((high - low) / (2.0 * step), by_x, 1e-9);
    const double fall =
      (pendres_pendulum_energy(p, x - step, 0.0) - pendres_pendulum_energy(p, x + step, 0.0)) /
      (2.0 * step);
    check_near(fall, 0.5 * (high + low), 1e-9);
  }
}

static void refusals(void **state)
{
  static const pendres_pendulum bad[] = {
    {.drive_frequency = 1.0, .torque = NAN},
    {.drive_frequency = 1.0, .parametric_amplitude = INFINITY},
    {.drive_frequency = 1.0, .force = PENDRES_FORCE_COUNT},
    {.drive_frequency = 1.0, .force_coefficients = {1.0}},
    {.drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL},
    {.drive_frequency = 1.0, .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {NAN}}};
  (void)state;
  for (size_t i = 0; i < COUNT(bad); i++) {
    const char *why = NULL;
    assert_int_equal(pendres_pendulum_check(&bad[i], &why), PENDRES_INVALID_ARGUMENT);
    assert_non_null(why);
  }
}

/* ---- kernels ---- */

enum { LANES = 24 };

/* States after a period of a block of lanes; the first `plain` of them without torque. */
static void run(pendres_context *ctx, pendres_flow_kind kind, const pendres_pendulum *p, size_t n,
                double (*end)[2])
{
  pendres_block *flow = NULL;
  check_ok(pendres_block_of(ctx, kind, &flow));
  pendres_block_clear(flow);
  check_ok(pendres_block_set_steps(flow, 40));
  pendres_block_resize(flow, n);
  for (size_t i = 0; i < n; i++) pendres_block_load(flow, i, &p[i], 0.1 * (double)i, 0.4);
  check_ok(pendres_block_period(flow));
  const pendres_rows rows = pendres_block_rows(flow);
  for (size_t i = 0; i < n; i++)
    for (int r = 0; r < 2; r++) end[i][r] = pendres_rows_get(&rows, r, i);
}

/* A plain pendulum has the same bytes beside others with torque; and rows of derivatives change no
   bit of the state they belong to. */
static void blocks(void **state)
{
  pendres_pendulum p[LANES];
  double alone[LANES][2], beside[LANES][2], with_rows[LANES][2];
  pendres_context *ctx = context(1e-8);
  (void)state;
  for (int model = 0; model < 2; model++) {
    for (int i = 0; i < LANES; i++) {
      p[i] = (pendres_pendulum){.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 0.8};
      if (model == 1) {
        p[i].force = PENDRES_FORCE_POLYNOMIAL;
        for (int k = 0; k < 5; k++) p[i].force_coefficients[k] = 1.0 / (1.0 + k + 0.1 * i);
      }
    }
    run(ctx, PENDRES_FLOW_STATE, p, LANES, alone);
    for (int i = LANES / 2; i < LANES; i++) {
      p[i].torque = 0.2;
      p[i].parametric_amplitude = 0.1 * i;
    }
    run(ctx, PENDRES_FLOW_STATE, p, LANES, beside);
    assert_memory_equal(alone, beside, LANES / 2 * sizeof *alone);
    assert_true(alone[LANES - 1][0] != beside[LANES - 1][0]);
    run(ctx, PENDRES_FLOW_VARIATIONAL, p, LANES, with_rows);
    assert_memory_equal(beside, with_rows, sizeof beside);
    static const pendres_flow_kind kinds[] = {PENDRES_FLOW_SENSITIVITY, PENDRES_FLOW_DRIVES,
                                              PENDRES_FLOW_FORCE, PENDRES_FLOW_ALL};
    for (size_t k = 0; k < COUNT(kinds) - 2 * (model == 0); k++) {
      run(ctx, kinds[k], p, LANES, with_rows);
      assert_memory_equal(beside, with_rows, sizeof beside);
    }
  }
  pendres_context_free(ctx);
}

/* Rows of derivatives are what neighbours do: central differences, good to 1e-9 with step 1e-4 and
   third derivatives of order ten. */
static void tangents(void **state)
{
  static const pendres_pendulum cases[] = {
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.1},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.1, .torque = 0.3,
     .parametric_amplitude = 0.6},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.1, .torque = 0.3,
     .parametric_amplitude = 0.6, .force = PENDRES_FORCE_POLYNOMIAL,
     .force_coefficients = {0.7, 0.3, 0.4, 0.1, 0.05}},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.1, .torque = 0.3,
     .parametric_amplitude = 0.6, .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.4}}};
  const double step = 1e-4;
  pendres_context *ctx = context(1e-8);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    pendres_block *flow = NULL;
    const int own = cases[i].force != PENDRES_FORCE_PENDULUM;
    int columns = 2;
    while (columns < 2 + PENDRES_PARAMETER_FOLLOWED &&
           pendres_parameter_refuses((pendres_parameter)(columns - 2), cases[i].force) == NULL)
      columns++;
    const int runs = 2 * columns;
    check_ok(pendres_block_of(ctx, own ? PENDRES_FLOW_ALL : PENDRES_FLOW_DRIVES, &flow));
    pendres_block_clear(flow);
    check_ok(pendres_block_set_steps(flow, 60));
    pendres_block_resize(flow, (size_t)runs + 1);
    for (int k = 0; k <= runs; k++) {
      pendres_pendulum p = cases[i];
      const double sign = k % 2 == 0 ? step : -step;
      const pendres_parameter by = (pendres_parameter)((k - 4) / 2);
      if (k >= 4 && k < runs)
        pendres_parameter_set(by, pendres_parameter_get(by, &p) + sign, &p);
      pendres_block_load(flow, (size_t)k, &p, 0.3 + (k < 2 ? sign : 0.0),
                         0.2 + (k == 2 || k == 3 ? sign : 0.0));
    }
    check_ok(pendres_block_period(flow));
    const pendres_rows rows = pendres_block_rows(flow);
    for (int column = 0; column < columns; column++)
      for (int r = 0; r < 2; r++) {
        const double high = pendres_rows_get(&rows, r, (size_t)(2 * column));
        const double low = pendres_rows_get(&rows, r, (size_t)(2 * column + 1));
        check_near(pendres_rows_get(&rows, PENDRES_ROW_BY_Y + 2 * column + r, (size_t)runs),
                   (high - low) / (2.0 * step), 3e-6);
      }
  }
  pendres_context_free(ctx);
}

/* ---- exact motions ---- */

/* x'' + a1 x + a3 x^3 = 0 from rest at X: X cn(w t | m) with w^2 = a1 + a3 X^2, m = a3 X^2 / (2
   w^2); with a1 < 0 within a well X dn(w t | m), w^2 = a3 X^2 / 2, m = 2 + 2 a1 / (a3 X^2). The
   estimate holds, and 1e-9 is reached at a tolerance of 1e-10 over three periods. */
static void free_duffing(void **state)
{
  static const struct {
    double a1, a3, x;
  } cases[] = {{1.0, 1.0, 1.5}, {0.2, 2.0, 0.7}, {-1.0, 1.0, 1.2}, {1.0, 0.0, 2.0},
               {0.0, 1.0, 1.0}};
  pendres_context *ctx = context(1e-10);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const double a1 = cases[i].a1, a3 = cases[i].a3, from = cases[i].x, omega = 0.7;
    const pendres_pendulum p = {.drive_frequency = omega, .force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {a1, 0.0, a3}};
    const long periods = 3;
    const double t = 2.0 * pi * (double)periods / omega, square = a3 * from * from;
    double x = from, v = 0.0, error = NAN, sn, cn, dn;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, periods, &error));
    const double rate = a1 >= 0.0 ? sqrt(a1 + square) : sqrt(0.5 * square);
    const double m = a1 >= 0.0 ? 0.5 * square / (a1 + square) : 2.0 + 2.0 * a1 / square;
    assert_int_equal(gsl_sf_elljac_e(rate * t, m, &sn, &cn, &dn), 0);
    const double exact_x = from * (a1 >= 0.0 ? cn : dn);
    const double exact_v = -from * rate * (a1 >= 0.0 ? sn * dn : m * sn * cn);
    const double off = fmax(fabs(x - exact_x), fabs(v - exact_v));
    /* GSL's own functions are good to 1e-14 or so. */
    assert_true(off <= error + 3e-14 && error < 1e-9);
  }
  pendres_context_free(ctx);
}

/* With a1 alone everything is known: amplitude and area of the linear response. */
static void linear_response(void **state)
{
  static const double omegas[] = {0.4, 1.5166, 3.0};
  pendres_context *ctx = context(1e-11);
  (void)state;
  for (size_t i = 0; i < COUNT(omegas); i++) {
    const double a1 = 2.3, w = omegas[i], torque = 0.4;
    const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.7, .drive_frequency = w,
                                .torque = torque, .force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {a1}};
    const double size = p.drive_amplitude / hypot(a1 - w * w, p.damping * w);
    const double lag = atan2(p.damping * w, a1 - w * w);
    const pendres_orbit o = orbit_near(ctx, &p, 0.0, 0.0, 0);
    check_near(o.amplitude, size, o.amplitude_error);
    check_near(o.loop_area, pi * p.drive_amplitude * size * sin(lag), o.loop_area_error);
    check_near(o.x, torque / a1 + size * cos(lag), o.x_error);
    check_near(o.mean_angle, torque / a1, o.x_error);
    check_near(o.phase_lag, lag, o.phase_lag_error);
    /* About where the torque holds it, it is its own mirror image. */
    assert_true(o.x_error < 1e-11 && o.symmetric && o.stable);
  }
  pendres_context_free(ctx);
}

/* ---- energy ---- */

/* What drive, torque and parametric drive give is lost to friction; each term has its share. */
static void balance(void **state)
{
  static const pendres_pendulum cases[] = {
    {.damping = 0.25, .drive_amplitude = 0.8, .drive_frequency = 1.2, .torque = 0.3},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.3, .torque = 0.2,
     .parametric_amplitude = 0.5},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.3, .parametric_amplitude = 0.5,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.2, 0.5}},
    {.damping = 0.2, .drive_amplitude = 0.4, .drive_frequency = 1.3, .parametric_amplitude = 0.5,
     .torque = 0.1, .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.2}}};
  const double guess[][2] = {{1.4, 1.6}, {1.7, 0.2}, {0.3, 0.1}, {0.3, 0.1}};
  pendres_context *ctx = context(1e-11);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const int winding = i == 0;
    const pendres_orbit o = orbit_near(ctx, &cases[i], guess[i][0], guess[i][1], winding);
    const double given = o.loop_area + o.torque_work + o.parametric_work;
    check_near(given, o.dissipation,
               o.loop_area_error + o.dissipation_error + o.parametric_work_error);
    check_near(o.torque_work, 2.0 * pi * cases[i].torque * winding, 1e-15);
    assert_true(o.loop_area_error < 1e-10 && o.dissipation_error < 1e-10);
    assert_true((o.parametric_work != 0.0) == (cases[i].parametric_amplitude != 0.0));
  }
  pendres_context_free(ctx);
}

/* ---- parametric drive: Floquet theory ---- */

/* Trace of the map of u'' + damping u' + s (1 + b cos(w t)) u = 0 over a period, by the midpoint's
   Taylor-free way: RK4 in long double, 4000 steps, off by 1e-13. */
static double floquet_trace(double s, const pendres_pendulum *p)
{
  enum { STEPS = 4000 };
  const long double w = p->drive_frequency, h = 6.283185307179586476925287L / w / STEPS;
  long double trace = 0.0L;
  for (int column = 0; column < 2; column++) {
    long double u = column == 0, v = column == 1;
    for (int i = 0; i < STEPS; i++) {
      long double ku[4], kv[4];
      for (int k = 0; k < 4; k++) {
        const long double part = k == 0 ? 0.0L : k == 3 ? 1.0L : 0.5L;
        const long double a = k == 0 ? u : u + part * h * ku[k - 1];
        const long double b = k == 0 ? v : v + part * h * kv[k - 1];
        const long double t = (i + part) * h;
        ku[k] = b;
        kv[k] = -p->damping * b - s * (1.0L + p->parametric_amplitude * cosl(w * t)) * a;
      }
      u += h / 6.0L * (ku[0] + 2.0L * ku[1] + 2.0L * ku[2] + ku[3]);
      v += h / 6.0L * (kv[0] + 2.0L * kv[1] + 2.0L * kv[2] + kv[3]);
    }
    trace += column == 0 ? u : v;
  }
  return (double)trace;
}

/* At the bottom of a well and at the top: multipliers are Mathieu's, and the top is stable where a
   fast drive makes it so (Kapitza: b^2 / (2 w^2) > 1 for small b / w^2). */
static void mathieu(void **state)
{
  pendres_context *ctx = context(1e-11);
  (void)state;
  for (int i = 0; i < 12; i++) {
    const int top = i % 2;
    const pendres_pendulum p = {.damping = 0.1, .drive_frequency = top ? 10.0 : 1.0 + 0.2 * i,
                                .parametric_amplitude = top ? 8.0 + 1.5 * i : 0.5};
    const pendres_orbit o = orbit_near(ctx, &p, half_pi + pi * top, 0.0, 0);
    const double trace = o.multiplier_re[0] + o.multiplier_re[1];
    const double expected = floquet_trace(top ? -1.0 : 1.0, &p);
    check_near(trace, expected, 2.0 * o.multiplier_error + 1e-12);
    if (top) assert_int_equal(o.stable, p.parametric_amplitude > 14.2);
  }
  pendres_context_free(ctx);
}

/* ---- attractors ---- */

/* A torque below one has its equilibrium at sin y = I, and none above. */
static void equilibrium(void **state)
{
  const pendres_pendulum p = {.damping = 0.8, .drive_frequency = 1.0, .torque = 0.6};
  pendres_attractors *found = NULL;
  pendres_context *ctx = context(1e-10);
  (void)state;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
  assert_true(pendres_attractors_count(found) == 1);
  const pendres_attractor *a = pendres_attractors_get(found, 0);
  check_near(a->orbit.x, half_pi + asin(0.6), a->orbit.x_error);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
}

/*
 * Locked to the drive a pendulum turns once a period, which a mean torque of about damping omega
 * keeps up; it is found, measured and named, and there is no mirror image of it. The potential of
 * two wells has an orbit in each, mirror images; tilted, they differ.
 */
static void running_and_wells(void **state)
{
  const pendres_pendulum locked = {.damping = 1.0, .drive_amplitude = 1.0, .drive_frequency = 1.0,
                                   .torque = 1.2};
  pendres_pendulum wells = {.damping = 0.4, .drive_amplitude = 0.05, .drive_frequency = 1.1,
                            .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {-1.0, 0.0, 1.0}};
  pendres_attractors *found = NULL;
  pendres_context *ctx = context(1e-9);
  int running = 0;
  (void)state;
  check_ok(pendres_attractors_find(ctx, &locked, 0, NULL, NULL, &found));
  for (size_t i = 0; i < pendres_attractors_count(found); i++) {
    const pendres_attractor *a = pendres_attractors_get(found, i);
    if (a->label != PENDRES_LABEL_RUNNING) continue;
    running++;
    assert_int_equal(a->orbit.winding, 1);
    check_near(a->orbit.torque_work, 2.0 * pi * 1.2, 1e-14);
  }
  assert_true(running == 1);
  pendres_attractors_free(found);

  double amplitude[2] = {NAN, NAN};
  for (int tilted = 0; tilted < 2; tilted++) {
    wells.torque = 0.02 * tilted;
    check_ok(pendres_attractors_find(ctx, &wells, 0, NULL, NULL, &found));
    assert_true(pendres_attractors_count(found) == 2);
    for (size_t i = 0; i < 2; i++) {
      const pendres_orbit *o = &pendres_attractors_get(found, i)->orbit;
      amplitude[i] = o->amplitude;
      check_near(fabs(o->mean_angle), 1.0, 0.1);
    }
    assert_true((fabs(amplitude[0] - amplitude[1]) > 1e-4) == (tilted == 1));
    pendres_attractors_free(found);
  }
  pendres_context_free(ctx);
}

/*
 * Starts that nobody gives follow the wells of a force: in Helmholtz's, z - z^2 with a barrier at
 * z = 1, most of those about 0 escape, and one state attracts a twentieth of a window. It is found
 * wherever the well is and however large.
 */
static void starts_follow_wells(void **state)
{
  static const double shift[] = {0.0, 2.0, -5.0}, size[] = {1.0, 3.0, 1e-3};
  pendres_context *ctx = context(1e-9);
  (void)state;
  for (size_t k = 0; k < COUNT(shift); k++) {
    const double c = shift[k], s = size[k];
    const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.1 * s,
                                .drive_frequency = 0.85, .torque = s * (c + c * c),
                                .force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {1.0 + 2.0 * c, -1.0 / s}};
    pendres_attractors *found = NULL;
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
    assert_int_equal(pendres_attractors_count(found), 1);
    const pendres_orbit *o = &pendres_attractors_get(found, 0)->orbit;
    check_near(o->amplitude, 0.613284122745 * s, 1e-9 * s);
    pendres_attractors_free(found);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(starts_follow_wells),
    cmocka_unit_test(facts),         cmocka_unit_test(derivatives),
    cmocka_unit_test(refusals),      cmocka_unit_test(blocks),
    cmocka_unit_test(tangents),      cmocka_unit_test(free_duffing),
    cmocka_unit_test(linear_response), cmocka_unit_test(balance),
    cmocka_unit_test(mathieu),       cmocka_unit_test(equilibrium),
    cmocka_unit_test(running_and_wells)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
