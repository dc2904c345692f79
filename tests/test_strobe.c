/*
 * test_strobe.c -- the stroboscopic map: nobody's neighbours matter, errors are what they are said
 * to be, energy stays.
 */
#include "strobe_fixture.h"

/* ---- independence -------------------------------------------------------------------------- */

enum { MANY = 200, PERIODS = 4 };

typedef struct crowd {
  pendres_pendulum p[MANY];
  double x[MANY], v[MANY], error[MANY];
} crowd;

static crowd *crowd_make(void)
{
  uint64_t seed = 88172645463325252u;
  crowd *c = malloc(sizeof *c);
  assert_non_null(c);
  for (size_t i = 0; i < MANY; i++) c->p[i] = any_pendulum(&seed, &c->x[i], &c->v[i]);
  return c;
}

/* Bitwise: whatever the block, the order, the neighbours, and what the context did before. */
static void test_independence(void **state)
{
  static const int lanes[] = { 8, 64, 192 };
  crowd *start = crowd_make(), *want = crowd_make(), *got = crowd_make();
  (void)state;
  for (size_t b = 0; b < COUNT(lanes); b++) {
    pendres_context *ctx = context(&(pendres_options){ .block_lanes = lanes[b] });
    crowd *c = b == 0 ? want : got;
    memcpy(c, start, sizeof *c);
    check_ok(pendres_strobe_advance(ctx, MANY, c->p, c->x, c->v, PERIODS, c->error));
    assert_memory_equal(c, want, sizeof *c);
    /* Backwards, on a context that has been used. */
    for (size_t i = 0; i < MANY; i++) {
      got->p[i] = start->p[MANY - 1 - i];
      got->x[i] = start->x[MANY - 1 - i];
      got->v[i] = start->v[MANY - 1 - i];
    }
    check_ok(pendres_strobe_advance(ctx, MANY, got->p, got->x, got->v, PERIODS, got->error));
    for (size_t i = 0; i < MANY; i++) {
      assert_memory_equal(&got->x[i], &want->x[MANY - 1 - i], sizeof(double));
      assert_memory_equal(&got->v[i], &want->v[MANY - 1 - i], sizeof(double));
      assert_memory_equal(&got->error[i], &want->error[MANY - 1 - i], sizeof(double));
    }
    /* Alone. */
    for (size_t i = 0; i < MANY; i += 23) {
      double x = start->x[i], v = start->v[i];
      check_ok(pendres_strobe_advance(ctx, 1, &start->p[i], &x, &v, PERIODS, NULL));
      assert_memory_equal(&x, &want->x[i], sizeof x);
      assert_memory_equal(&v, &want->v[i], sizeof v);
    }
    pendres_context_free(ctx);
  }
  free(start);
  free(want);
  free(got);
}

/* Bitwise again: adaptive steps do not go on from what the context did before. */
static void test_adaptive_steps_begin_anew(void **state)
{
  const pendres_pendulum p = { .damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 0.9 };
  double first[2] = { 0.0, 0.0 }, estimate[2];
  (void)state;
  for (int m = PENDRES_BLOCK_ADAPTIVE; m <= PENDRES_NAIVE; m++) {
    pendres_context *ctx = context(&(pendres_options){ .method = (pendres_method)m });
    for (int k = 0; k < 3; k++) {
      double x = 1.0, v = 0.5, error;
      check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, k == 1 ? NULL : &error));
      if (k != 1) estimate[k / 2] = error;
      if (k == 0) first[0] = x, first[1] = v;
      assert_memory_equal(&x, &first[0], sizeof x);
      assert_memory_equal(&v, &first[1], sizeof v);
    }
    assert_memory_equal(&estimate[0], &estimate[1], sizeof *estimate);
    pendres_context_free(ctx);
  }
}

/*
 * Seven periods at once or in two calls: between calls the angle y goes through x = y + pi/2 and
 * loses up to 2.2e-16 twice; these pendulums do not amplify that more than a hundredfold.
 */
static void test_calls(void **state)
{
  pendres_context *ctx = context(&(pendres_options){ .steps_per_period = 40 });
  (void)state;
  for (int i = 0; i < 20; i++) {
    const pendres_pendulum p = { .damping = 0.3 + 0.1 * i, .drive_amplitude = 0.3,
                                 .drive_frequency = 0.9 };
    double x = 0.1 * i, v = 0.3, y = x, w = v;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 7, NULL));
    check_ok(pendres_strobe_advance(ctx, 1, &p, &y, &w, 3, NULL));
    check_ok(pendres_strobe_advance(ctx, 1, &p, &y, &w, 0, NULL));
    check_ok(pendres_strobe_advance(ctx, 1, &p, &y, &w, 4, NULL));
    check_near(y, x, 5e-14);
    check_near(w, v, 5e-14);
  }
  pendres_context_free(ctx);
}

/* ---- errors -------------------------------------------------------------------------------- */

static double true_error(const pendres_pendulum *p, double x0, double v0, long periods, double x,
                         double v)
{
  long double y = x0 - half_pi, w = v0;
  long turns = 0;
  check_ok(reference_advance(p, &y, &w, &turns, periods));
  const long double angle = y + two_pi * (long double)turns;
  return (double)fmaxl(fabsl((long double)x - half_pi - angle), fabsl((long double)v - w));
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/*
 * Estimates on parameters that no deck names, against extended precision: none below the true error
 * (where the difference of two runs was claimed as it stood, half of them were), and not so large
 * as to say nothing. Where steps are what is wrong the estimate is twice the error, as the better
 * run is taken to be off by up to half as much; towards 1e-13 rounding is claimed with two standard
 * errors, and errors at random mostly cancel.
 */
static void test_errors_are_honest(void **state)
{
  static const double tolerance[] = { 1e-5, 1e-8, 1e-11, 1e-13 };
  static const double most[] = { 2.5, 2.5, 10.0, 33.0 };
  enum { N = 60 };
  uint64_t seed = 362436069u;
  (void)state;
  for (size_t t = 0; t < COUNT(tolerance); t++) {
    pendres_context *ctx = context(&(pendres_options){ .tolerance = tolerance[t] });
    double ratio[N], least = INFINITY;
    for (int i = 0; i < N; i++) {
      double x0, v0, error = NAN;
      const pendres_pendulum p = any_pendulum(&seed, &x0, &v0);
      const long periods = 1 + (long)(25.0 * any(&seed) * any(&seed));
      double x = x0, v = v0;
      check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, periods, &error));
      const double off = true_error(&p, x0, v0, periods, x, v);
      if (!(error >= off))
        print_error("damping %g, drive %g at %g, from %g, %g: off by %g, estimated %g\n", p.damping,
                    p.drive_amplitude, p.drive_frequency, x0, v0, off, error);
      assert_true(error >= off);
      ratio[i] = error / fmax(off, 1e-17);
      least = fmin(least, ratio[i]);
    }
    qsort(ratio, N, sizeof *ratio, ascending);
    print_message("tolerance %g: estimate / error is %.2f at least, %.2f in the middle\n",
                  tolerance[t], least, ratio[N / 2]);
    assert_true(ratio[N / 2] > 1.4 && ratio[N / 2] < most[t]);
    pendres_context_free(ctx);
  }
}

/*
 * Two runs that end side by side by chance. In the first four steps are few, and a run with 1.4
 * times as many is off by as much (claims 0.31, 0.76, 0.88 and 0.87 of the error); in the others
 * the runs separate in a chaotic transient and meet again on one attractor, while the
 * pendulum is on another or turns behind: claims of 1e-6 where the error is one of radians. In the
 * last three friction limits adaptive steps, and a smaller tolerance does not shorten them: claims
 * of 0.71, 0.67 and 0.53 of the error.
 */
static void test_agreement_by_chance(void **state)
{
  static const struct {
    pendres_pendulum p;
    double x, v, tolerance;
    long periods;
    int lost;
    pendres_method method;
  } a[] = {
    {{.drive_amplitude = 1.375554400497076, .damping = 2.573595688177405,
      .drive_frequency = 1.2952198883203425},
     -1.0391451251077772, -0.183654870820964, 0.00010488361493591705, 29, 0},
    {{.drive_amplitude = 0.1958446539818797, .damping = 2.0989872687438558,
      .drive_frequency = 0.97486974509525626},
     -0.14630802408455335, 1.1276587204420716, 3.2174407684160594e-05, 27, 0},
    {{.drive_amplitude = 0.69661825504554531, .damping = 0.33111327834483861,
      .drive_frequency = 0.68883772613057703},
     1.9975896563977553, 1.4815560088623956, 4.0460094701877709e-10, 4, 0},
    {{.drive_amplitude = 0.1073075736927398, .damping = 2.518304585363813,
      .drive_frequency = 1.2443772443069738},
     1.4941827161806227, 0.4024857947593352, 0.0005169103934301294, 1, 0},
    {{.drive_amplitude = 1.2356854602055289, .damping = 0.37879754159501433,
      .drive_frequency = 0.57221076989863684},
     0.71162729856432794, 1.2863402149873036, 0.00019569615944930145, 26, 1},
    {{.drive_amplitude = 0.80022506087664658, .damping = 0.34499937191661834,
      .drive_frequency = 0.43662966022203609},
     2.3242156207726534, 1.9511761071820128, 0.0064460605683426047, 21, 1},
    {{.drive_amplitude = 1.0433684180211427, .damping = 0.31501306426243314,
      .drive_frequency = 0.31189945984771245},
     -1.5102205149847898, -0.24935303460795932, 0.0006363332430307973, 32, 1},
    {{.drive_amplitude = 0.011050358535141682, .damping = 2.0779081834064739,
      .drive_frequency = 0.3279473296293598},
     1.8926850945099396, -0.88794425914104069, 1.5540370162176183e-05, 1, 0, PENDRES_SINGLE},
    {{.drive_amplitude = 0.45090835235404886, .damping = 2.4791340175879975,
      .drive_frequency = 0.83618737578532909},
     2.8355598173216539, -1.4232472007798402, 3.6798464890638391e-05, 1, 0, PENDRES_SINGLE},
    {{.drive_amplitude = 0.45090835235404886, .damping = 2.4791340175879975,
      .drive_frequency = 0.83618737578532909},
     2.8355598173216539, -1.4232472007798402, 3.6798464890638391e-05, 1, 0,
     PENDRES_BLOCK_ADAPTIVE},
  };
  (void)state;
  for (size_t i = 0; i < COUNT(a); i++) {
    pendres_context *ctx = context(&(pendres_options){.tolerance = a[i].tolerance,
                                                   .method = a[i].method});
    double x = a[i].x, v = a[i].v, error = NAN;
    check_ok(pendres_strobe_advance(ctx, 1, &a[i].p, &x, &v, a[i].periods, &error));
    const double off = true_error(&a[i].p, a[i].x, a[i].v, a[i].periods, x, v);
    assert_true(error >= off);
    /* Twice the distance to a run that is far better. */
    assert_true(a[i].lost ? isinf(error) : error < 2.5 * off);
    pendres_context_free(ctx);
  }
}

/*
 * Strong friction and a slow drive: rounding grows 700-fold on the way over the top and is
 * forgotten again within the same period. The derivative of the map over a whole one tells nothing
 * of that, and where it was all that was asked one start in seven was beyond its claim, by up to
 * 31 times. Two standard errors are claimed, of roundings as large as in the worst of pendulums
 * (strobe_noise.c): of 500 starts here none was off by more than 0.8 of that, half by a sixth; a
 * thirtieth is what every claim in the library is held to.
 */
static void test_rounding_within_a_period(void **state)
{
  static const double tolerance[] = { 1e-9, 1e-12 };
  enum { N = 40 };
  double ratio[N];
  (void)state;
  for (size_t t = 0; t < COUNT(tolerance); t++) {
    pendres_context *ctx = context(&(pendres_options){ .tolerance = tolerance[t] });
    for (int i = 0; i < N; i++) {
      const pendres_pendulum p = { .damping = 2.8173128501755933,
                                   .drive_amplitude = 1.3429385952269313,
                                   .drive_frequency = 0.1031835275137483 };
      const double x0 = -1.868351988432277 + 2.5e-3 * (i - N / 2), v0 = 0.33668723350471952;
      double x = x0, v = v0, error, points[2][5], errors[2][5];
      check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, &error));
      const double off = true_error(&p, x0, v0, 1, x, v);
      assert_true(error >= off);
      check_ok(pendres_strobe_record(
        ctx, &p, &(pendres_state){x0, v0}, 1, 4,
        &(pendres_record){points[0], points[1], errors[0], errors[1]}));
      assert_true(fmax(errors[0][4], errors[1][4]) >=
                  true_error(&p, x0, v0, 1, points[0][4], points[1][4]));
      ratio[i] = off / error;
    }
    qsort(ratio, N, sizeof *ratio, ascending);
    assert_true(ratio[N / 2] > 1.0 / 30.0);
    pendres_context_free(ctx);
  }
}

/*
 * Hundreds of free oscillations in a slow drive: coefficients and steps are rounded once for the
 * whole run, so that the phase is wrong by units in the last place of all that has gone by, in any
 * run alike. With the steps' rounding alone some of these were off by nine of their claims.
 */
static void test_rounding_of_coefficients(void **state)
{
  enum { N = 20, LONG = 120 };
  uint64_t seed = 521288629u;
  pendres_context *ctx = context(&(pendres_options){ .tolerance = 1e-13 });
  (void)state;
  for (int i = 0; i < N; i++) {
    const double a1 = 0.3 + any(&seed);
    const pendres_pendulum p = { .force = PENDRES_FORCE_POLYNOMIAL,
                                 .force_coefficients = { a1 },
                                 .damping = 1e-5,
                                 .drive_amplitude = 1e-3,
                                 .drive_frequency = 0.1 + 0.1 * any(&seed) };
    const double x0 = 2.0 * any(&seed) - 1.0;
    double x = x0, v = 0.0, error;
    long double y = x0, w = 0.0L;
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, LONG, &error));
    check_ok(reference_advance(&p, &y, &w, NULL, LONG));
    const double off = fmax(fabs((double)(x - y)), fabs((double)(v - w)));
    assert_true(error >= off);
  }
  pendres_context_free(ctx);
}

/*
 * The same of methods with adaptive steps, from damping 0.1 to 100, where stability limits their
 * steps and a tenth of the tolerance may change next to nothing: two runs alone were 80 times too
 * sure of one pendulum in a hundred.
 */
static void test_adaptive_errors_are_honest(void **state)
{
  static const pendres_method methods[] = { PENDRES_BLOCK_ADAPTIVE, PENDRES_SINGLE,
                                            PENDRES_CVODE_ADAMS, PENDRES_CVODE_BDF,
                                            PENDRES_NAIVE };
  static const double tolerance[] = { 1e-6, 1e-8, 1e-10, 1e-12 };
  enum { N = 24, TURNS = 2 };
  uint64_t seed = 362436069u;
  pendres_pendulum p[N];
  double x0[N], v0[N];
  (void)state;
  for (int i = 0; i < N; i++) {
    p[i] = any_pendulum(&seed, &x0[i], &v0[i]);
    p[i].damping = 0.1 * pow(1000.0, (double)i / (N - 1));
    p[i].drive_frequency = 0.5 + 0.5 * any(&seed);
  }
  for (size_t k = 0; k < COUNT(methods) * COUNT(tolerance); k++) {
    const pendres_options o = { .method = methods[k / COUNT(tolerance)],
                                .tolerance = tolerance[k % COUNT(tolerance)] };
    pendres_context *ctx = context(&o);
    double x[N], v[N], error[N];
    memcpy(x, x0, sizeof x);
    memcpy(v, v0, sizeof v);
    check_ok(pendres_strobe_advance(ctx, N, p, x, v, TURNS, error));
    for (int i = 0; i < N; i++) {
      const double off = true_error(&p[i], x0[i], v0[i], TURNS, x[i], v[i]);
      if (!(error[i] >= off))
        print_error("%s, tolerance %g, damping %g: off by %g, estimated %g\n",
                    pendres_name_get(PENDRES_NAMES_METHOD, o.method), o.tolerance, p[i].damping,
                    off, error[i]);
      assert_true(error[i] >= off);
    }
    pendres_context_free(ctx);
  }
}

/*
 * And in the long run at the least tolerance, where what is left of the error is the rounding of a
 * clock that runs on: runs compared alone were 11 times too sure of one of these starts.
 */
static void test_running_clocks_are_honest(void **state)
{
  static const pendres_method methods[] = { PENDRES_SINGLE, PENDRES_CVODE_ADAMS };
  enum { N = 20, TURNS = 100 };
  pendres_pendulum p[N];
  (void)state;
  for (int i = 0; i < N; i++)
    p[i] = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                               .drive_frequency = 0.25 * pi };
  for (size_t k = 0; k < COUNT(methods); k++) {
    pendres_context *ctx = context(&(pendres_options){ .method = methods[k], .tolerance = 1e-13 });
    double x[N], v[N] = { 0.0 }, start[N], error[N];
    for (int i = 0; i < N; i++) x[i] = start[i] = -0.5 * pi + 2.0 * pi * (10 * i + 6) / 200.0;
    check_ok(pendres_strobe_advance(ctx, N, p, x, v, TURNS, error));
    for (int i = 0; i < N; i++) {
      const double off = true_error(&p[i], start[i], 0.0, TURNS, x[i], v[i]);
      if (!(error[i] >= off))
        print_error("%s from %g: off by %g, estimated %g\n",
                    pendres_name_get(PENDRES_NAMES_METHOD, methods[k]),
                    start[i], off, error[i]);
      assert_true(error[i] >= off);
    }
    pendres_context_free(ctx);
  }
}

/*
 * And at the loosest tolerances, where steps of order 5 carry pendulums into the other basin, at a
 * tenth and a hundredth of the tolerance too: estimates were 700 times too small. The truth is
 * fixed steps', good for ten digits.
 */
static void test_lost_pendulums_are_said(void **state)
{
  static const double tolerance[] = { 1e-2, 1e-3 };
  static double want[MANY], x[MANY], v[MANY], error[MANY];
  static pendres_pendulum p[MANY];
  size_t lost = 0;
  (void)state;
  for (int i = 0; i < MANY; i++) {
    p[i] = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                               .drive_frequency = 0.25 * pi };
    want[i] = 2.0 * pi * (i + 1) / MANY - 0.5 * pi;
    v[i] = 0.0;
  }
  pendres_context *ctx = context(&(pendres_options){ .tolerance = 1e-10 });
  check_ok(pendres_strobe_advance(ctx, MANY, p, want, v, 100, NULL));
  pendres_context_free(ctx);
  for (size_t k = 0; k < COUNT(tolerance); k++) {
    ctx = context(&(pendres_options){ .method = PENDRES_BLOCK_ADAPTIVE, .block_lanes = MANY,
                                      .table = PENDRES_TABLE_TSIT5, .tolerance = tolerance[k] });
    for (int i = 0; i < MANY; i++) x[i] = 2.0 * pi * (i + 1) / MANY - 0.5 * pi, v[i] = 0.0;
    check_ok(pendres_strobe_advance(ctx, MANY, p, x, v, 100, error));
    pendres_context_free(ctx);
    for (int i = 0; i < MANY; i++) {
      lost += fabs(x[i] - want[i]) > 1.0;
      assert_true(error[i] >= 0.1 * fabs(x[i] - want[i]));
    }
  }
  assert_true(lost > 0); /* or this test tests nothing */
}

/*
 * The tolerance is met: golden end states, whose starts' errors grow or fade as they say. Steps are
 * chosen for errors that add up, so a trajectory that amplifies them is off by that factor more.
 * Rounding: two units in the last place of a step's angle, grown likewise.
 */
static void test_tolerance_is_met(void **state)
{
  static const double tolerance[] = { 1e-4, 1e-6, 1e-8, 1e-10, 1e-12 };
  (void)state;
  for (size_t t = 0; t < COUNT(tolerance); t++) {
    pendres_context *ctx = context(&(pendres_options){ .tolerance = tolerance[t] });
    for (size_t i = 0; i < COUNT(golden_states); i++) {
      const golden_state *g = &golden_states[i];
      const double growth = fmax(1.0, (double)g->growth);
      if (growth > 1e3) continue; /* chaos: see test_errors_are_honest */
      double x = (double)(g->y + half_pi), v = g->v;
      check_ok(pendres_strobe_advance(ctx, 1, &g->pendulum, &x, &v, g->periods, NULL));
      const double bound = growth * (tolerance[t] + 1e-13);
      check_near(x, (double)(g->end_y + half_pi + two_pi * (long double)g->turns), bound);
      check_near(v, (double)g->end_v, bound);
    }
    pendres_context_free(ctx);
  }
}

/*
 * Energy of undamped, undriven pendulums after 10,000 periods: an error d of x and v changes
 * v^2/2 - sin x by at most (|v| + 1) d < 4 d. Swings of all sizes and a rotation.
 */
static void test_energy(void **state)
{
  static const double y[] = { 0.01, 0.5, 1.5, 2.5, 3.0, 0.0 }, w[] = { 0, 0, 0, 0, 0, 2.5 };
  enum { N = COUNT(y) };
  const double tolerance = 1e-7;
  pendres_context *ctx = context(&(pendres_options){ .tolerance = tolerance });
  pendres_pendulum p[N];
  double x[N], v[N], before[N];
  (void)state;
  for (size_t i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){ .drive_frequency = 1.0 };
    x[i] = (double)(y[i] + half_pi), v[i] = w[i];
    before[i] = pendres_pendulum_energy(&p[i], x[i], v[i]);
  }
  check_ok(pendres_strobe_advance(ctx, N, p, x, v, 10000, NULL));
  for (size_t i = 0; i < N; i++)
    check_near(pendres_pendulum_energy(&p[i], x[i], v[i]), before[i], 4.0 * tolerance);
  /* The rotation has gone round and round: 62832 time units at a speed between 1.5 and 2.5. */
  assert_true(x[N - 1] > 62832.0 * 1.5 && x[N - 1] < 62832.0 * 2.5);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_independence),
    cmocka_unit_test(test_calls),
    cmocka_unit_test(test_errors_are_honest),
    cmocka_unit_test(test_agreement_by_chance),
    cmocka_unit_test(test_rounding_within_a_period),
    cmocka_unit_test(test_rounding_of_coefficients),
    cmocka_unit_test(test_tolerance_is_met),
    cmocka_unit_test(test_energy),
    cmocka_unit_test(test_adaptive_errors_are_honest),
    cmocka_unit_test(test_running_clocks_are_honest),
    cmocka_unit_test(test_adaptive_steps_begin_anew),
    cmocka_unit_test(test_lost_pendulums_are_said),
  };
  return cmocka_run_group_tests_name("strobe", tests, NULL, NULL);
}
