/*
 * test_certain.c -- labels that say whether they are certain, and how means take this into account.
 *
 * True labels come from the long double reference, which shares no code with the library: a
 * pendulum is followed until it is close to an attractor's Poincaré point.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "engine/context_internal.h"
#include "engine/steps.h"
#include "engine/strobe_run.h"
#include "states_fixture.h"

static const double pi = 3.14159265358979323846;
static const long double half_pi = 1.57079632679489661923132169163975144L;

enum { MEMBERS = 200 };

/* A fractal boundary between two states: errors grow up to 1e21 times before members settle. */
static const pendres_pendulum fractal = {.drive_amplitude = 0.3629997361386908,
                                         .damping = 0.09617570635672344,
                                         .drive_frequency = 0.681074968553923};

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* The attractor that a pendulum goes to; -1: none within 300 periods. Orbits of period one. */
static int true_attractor(const pendres_pendulum *p, double x, double v,
                          const pendres_attractors *set)
{
  long double y = (long double)x - half_pi, w = v;
  long turns = 0;
  for (int k = 0; k < 300; k++) {
    check_ok(reference_advance(p, &y, &w, &turns, 1));
    for (size_t i = 0; i < pendres_attractors_count(set); i++) {
      const pendres_orbit *o = &pendres_attractors_get(set, i)->orbit;
      const double dy = (double)(y + half_pi) - o->x;
      if (hypot(dy - 2.0 * pi * rint(dy / (2.0 * pi)), (double)w - o->v) < 1e-3) return (int)i;
    }
  }
  return -1;
}

/*
 * Errors of all directions alike grow as the variational equation has it, but for half a step that
 * is missing at the start and too much at the end, and the error of steps of second order: within a
 * half, however many periods. The size is all that labels ask for.
 */
typedef struct watched {
  long periods;
} watched;

static int enough(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const watched *w = arg;
  (void)index;
  return lane->period >= w->periods;
}

static void growth(void **state)
{
  static const double start[][2] = {{1.6, 0.0}, {0.3, 0.4}, {-1.5, 0.1}, {-1.55, 0.0}, {4.6, 0.3}};
  enum { STARTS = sizeof start / sizeof *start };
  pendres_context *ctx = context(1e-8);
  (void)state;
  for (long periods = 1; periods <= 3; periods++)
    for (size_t i = 0; i < STARTS; i++) {
      pendres_strobe_lane lane = {.pendulum = &fractal, .y = start[i][0] - 0.5 * pi,
                                  .w = start[i][1] / fractal.drive_frequency,
                                  .added = 1e-300, .off = {.yy = 1.0, .ww = 1.0}};
      reference_image image;
      check_ok(pendres_steps_choose(ctx, &fractal, 1.0, 1e-7, &lane.steps));
      check_ok(pendres_strobe_run(ctx, 1, &lane, enough, &(watched){periods}));
      check_ok(reference_map(&fractal, (long double)start[i][0] - half_pi, start[i][1],
                                     periods, &image));
      const double omega = fractal.drive_frequency;
      double grown = 0.0;
      for (int k = 0; k < 2; k++) {
        const double from = k == 0 ? 1.0 : omega; /* of w to v */
        const double y = from * (double)image.monodromy[0][k];
        const double w = from * (double)image.monodromy[1][k] / omega;
        grown += y * y + w * w;
      }
      check_relative(sqrt(lane.off.yy + lane.off.ww), sqrt(grown), 0.5);
    }
  pendres_context_free(ctx);
}

/* Labels called certain are the true ones (every third is looked at); nearly all are certain. */
static void true_labels(void **state)
{
  static const double tolerance[] = {1e-5, 1e-8};
  const pendres_ensemble e = pendres_ensemble_default();
  (void)state;
  for (int t = 0; t < 2; t++) {
    pendres_context *ctx = context(tolerance[t]);
    pendres_pendulum p[MEMBERS];
    double x[MEMBERS], v[MEMBERS];
    pendres_settled outcome[MEMBERS];
    pendres_attractors *set = NULL;
    int certain = 0;
    for (size_t k = 0; k < MEMBERS; k++) {
      p[k] = fractal;
      x[k] = member_x(&e, k + 1);
      v[k] = e.v;
    }
    check_ok(pendres_settle(ctx, MEMBERS, p, x, v, outcome, &set));
    for (size_t k = 0; k < MEMBERS; k++) {
      certain += outcome[k].certain;
      if (!outcome[k].certain || k % 3 != (size_t)t) continue;
      assert_int_equal(outcome[k].attractor, true_attractor(&fractal, x[k], v[k], set));
    }
    /* 17 amplify errors more than 1e12 times: with 16 digits nobody can tell where they go. */
    assert_in_range(certain, MEMBERS - 25, MEMBERS - 5);
    pendres_attractors_free(set);
    pendres_context_free(ctx);
  }
}

/*
 * The mean over the ensemble is within its error of the true one, at every tolerance: without
 * certainty it was off by 0.04 at a claim of 3e-12. True: by long double.
 */
static void mean_of_fractal(void **state)
{
  static const double tolerance[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
  const double truth = 0.29761702;
  const pendres_ensemble e = pendres_ensemble_default();
  (void)state;
  for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++) {
    pendres_context *ctx = context(tolerance[t]);
    pendres_response r;
    check_ok(pendres_response_find(ctx, 1, &fractal, &e, &r));
    pendres_context_free(ctx);
    check_near(r.mean_loop_area, truth, r.mean_loop_area_error + 1e-8);
    assert_in_range(r.uncertain, 1, 25);
    /* The claim is still worth something: the two states' areas differ by 1.4. */
    assert_true(r.mean_loop_area_error < 0.2);
  }
}

/*
 * One start each, whatever the parameters: what is settled at two tolerances has the same area
 * within its errors, or one of the labels is uncertain. Twenty times the errors are let pass for
 * what orbits promise, a tenth of the true error at least, of either.
 */
static void two_tolerances(void **state)
{
  enum { DRAWS = 100 };
  static pendres_pendulum p[DRAWS];
  static double x[DRAWS], v[DRAWS];
  static pendres_settled outcome[2][DRAWS];
  pendres_attractors *set[2];
  uint64_t s = 20;
  (void)state;
  for (int i = 0; i < DRAWS; i++) {
    double u[4];
    for (int k = 0; k < 4; k++) {
      s = s * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
      u[k] = (double)(s >> 11) * 0x1p-53;
    }
    p[i] = (pendres_pendulum){.damping = 0.05 + 0.1 * u[0], .drive_amplitude = 0.2 + 0.4 * u[1],
                              .drive_frequency = 0.6 + 0.25 * u[2]};
    x[i] = -0.5 * pi + 2.0 * pi * u[3];
    v[i] = 0.0;
  }
  for (int t = 0; t < 2; t++) {
    pendres_context *ctx = context(t == 0 ? 1e-8 : 1e-10);
    check_ok(pendres_settle(ctx, DRAWS, p, x, v, outcome[t], &set[t]));
    pendres_context_free(ctx);
  }
  int compared = 0;
  for (int i = 0; i < DRAWS; i++) {
    if (!outcome[0][i].certain || !outcome[1][i].certain) continue;
    const pendres_attractor *a = pendres_attractors_get(set[0], (size_t)outcome[0][i].attractor);
    const pendres_attractor *b = pendres_attractors_get(set[1], (size_t)outcome[1][i].attractor);
    if (a->label == PENDRES_LABEL_CHAOTIC && b->label == PENDRES_LABEL_CHAOTIC) continue;
    check_near(a->orbit.loop_area, b->orbit.loop_area,
               20.0 * (a->orbit.loop_area_error + b->orbit.loop_area_error));
    compared++;
  }
  assert_true(compared > DRAWS * 2 / 3);
  pendres_attractors_free(set[0]);
  pendres_attractors_free(set[1]);
}

/* Where steps are adaptive, or as many as were asked for, labels are certain by comparison. */
static void other_steps(void **state)
{
  static const pendres_options options[] = {
    {.tolerance = 1e-6, .method = PENDRES_BLOCK_ADAPTIVE},
    {.tolerance = 1e-8, .steps_per_period = 16},
  };
  const pendres_ensemble e = pendres_ensemble_default();
  (void)state;
  for (int t = 0; t < 2; t++) {
    pendres_context *ctx = NULL;
    pendres_pendulum p[MEMBERS];
    double x[MEMBERS], v[MEMBERS];
    pendres_settled outcome[MEMBERS];
    pendres_attractors *set = NULL;
    int certain = 0;
    check_ok(pendres_context_create(&options[t], &ctx));
    for (size_t k = 0; k < MEMBERS; k++) {
      p[k] = fractal;
      x[k] = member_x(&e, k + 1);
      v[k] = e.v;
    }
    check_ok(pendres_settle(ctx, MEMBERS, p, x, v, outcome, &set));
    for (size_t k = 0; k < MEMBERS; k++) {
      certain += outcome[k].certain;
      if (k % 4 == 0 && outcome[k].certain)
        assert_int_equal(outcome[k].attractor, true_attractor(&fractal, x[k], v[k], set));
    }
    assert_in_range(certain, MEMBERS / 2, MEMBERS - 5);
    pendres_attractors_free(set);
    pendres_context_free(ctx);
  }
}

/* A start inside a trapping ellipse is certain; what nobody knows is not. */
static void ends(void **state)
{
  const pendres_pendulum p = {.damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.9};
  const double x[] = {0.5 * pi, 1.0}, v[] = {0.0, 0.0};
  pendres_context *ctx = NULL;
  pendres_settled outcome[2];
  pendres_attractors *set = NULL;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8, .period_budget = 1}, &ctx));
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  check_ok(pendres_attractors_settle(ctx, set, 2, x, v, outcome));
  for (int i = 0; i < 2; i++) assert_int_equal(outcome[i].certain, outcome[i].attractor >= 0);
  const pendres_orbit *o = &pendres_attractors_get(set, 0)->orbit;
  check_ok(pendres_attractors_settle(ctx, set, 1, &o->x, &o->v, outcome));
  assert_int_equal(outcome[0].settling_periods, 0);
  assert_int_equal(outcome[0].certain, 1);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/*
 * At a weak damping errors grow beyond all bounds on the way, long before pendulums settle. Nothing
 * makes such labels certain, and runs that try end where the pendulum is lost: all of it takes
 * 5.1e7 right-hand sides here, and 2.6e8 where such runs are followed until they settle. Costs are
 * deterministic; half of the way between the two is allowed.
 */
static void lost_early(void **state)
{
  enum { N = 64 };
  static pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled outcome[N];
  pendres_attractors *set = NULL;
  pendres_cost cost;
  int certain = 0;
  pendres_context *ctx = context(1e-8);
  (void)state;
  for (int k = 0; k < N; k++) {
    p[k] = (pendres_pendulum){.damping = 1e-3, .drive_amplitude = 0.2, .drive_frequency = 0.8};
    x[k] = -1.5 + 6.0 * (k % 8) / 7.0;
    v[k] = -2.0 + 4.0 * (k / 8) / 7.0;
  }
  check_ok(pendres_settle(ctx, N, p, x, v, outcome, &set));
  pendres_context_cost(ctx, &cost);
  for (int k = 0; k < N; k++) {
    assert_true(outcome[k].attractor >= 0);
    certain += outcome[k].certain;
  }
  assert_in_range(certain, 1, N / 2);
  assert_true(cost.rhs_evaluations < 1.5e8);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(growth),          cmocka_unit_test(true_labels),
    cmocka_unit_test(mean_of_fractal),
    cmocka_unit_test(two_tolerances), cmocka_unit_test(other_steps), cmocka_unit_test(ends),
    cmocka_unit_test(lost_early),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
