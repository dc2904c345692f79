/*
 * test_unstable.c -- pendulums that rest in an unstable state, which they never leave.
 */
#include "check.h"

#include <math.h>

#include <pendres/pendres.h>

#include "base/angles.h"

/* Rest at x = 0 of x'' + damping x' - x + x^3 = 0 is a saddle; its exponents are the zeros of
   s^2 + damping s - 1. */
static const pendres_pendulum saddle = {.force = PENDRES_FORCE_POLYNOMIAL,
                                        .force_coefficients = {-1.0, 0.0, 1.0},
                                        .damping = 0.3,
                                        .drive_frequency = 1.0};
/* In the first tongue of Mathieu's equation rest is unstable. */
static const pendres_pendulum tongue = {.force = PENDRES_FORCE_POLYNOMIAL,
                                        .force_coefficients = {1.0, 0.0, 1.0},
                                        .damping = 0.005,
                                        .parametric_amplitude = 0.03,
                                        .drive_frequency = 2.0};

static int setup(void **state)
{
  pendres_context *ctx = NULL;
  const pendres_status status = pendres_context_create(NULL, &ctx);
  *state = ctx;
  return status != PENDRES_OK;
}

static int teardown(void **state)
{
  pendres_context_free(*state);
  return 0;
}

/* At rest there it stays, whatever is known before; a trillionth aside it leaves, and settles. */
static void stays(void **state)
{
  enum { N = 4 };
  const double x[N] = {0.0, 1e-12, -1e-12, 0.5}, v[N] = {0.0};
  const pendres_pendulum *const cases[] = {&saddle, &tongue};
  for (size_t c = 0; c < 2; c++) {
    pendres_pendulum p[N];
    pendres_settled first[N], known[N];
    pendres_attractors *found = NULL;
    for (int i = 0; i < N; i++) p[i] = *cases[c];
    check_ok(pendres_settle(*state, N, p, x, v, first, &found));
    check_ok(pendres_attractors_settle(*state, found, N, x, v, known));
    for (int i = 0; i < N; i++) {
      const pendres_label label = i == 0 ? PENDRES_LABEL_UNSTABLE : PENDRES_LABEL_PERIODIC;
      assert_int_equal(first[i].label, label);
      assert_int_equal(known[i].label, label);
      assert_int_equal(first[i].attractor < 0, i == 0);
    }
    assert_int_equal(first[0].attractor, PENDRES_ATTRACTOR_UNSTABLE);
    assert_int_equal(known[0].attractor, PENDRES_ATTRACTOR_UNSTABLE);
    assert_true(first[0].certain && known[0].certain);
    pendres_attractors_free(found);
  }
}

/* What an upright pendulum does does not depend on who asks: a picture, whose first run is in
   single precision, or one that settles alone. Two roundings aside it falls. */
static void upright(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .drive_frequency = 1.0};
  const double x[3] = {1.5 * pi, 1.5 * pi - 2e-15, 1.0}, v[3] = {0.0};
  const pendres_basin_grid grid = {.nx = 3, .nv = 1, .x = x, .v = v};
  pendres_basin_state picture[3];
  pendres_settled outcome[3];
  pendres_attractors *found = NULL;
  check_ok(pendres_attractors_find(*state, &p, 3, x, v, &found));
  check_ok(pendres_attractors_settle(*state, found, 3, x, v, outcome));
  check_ok(pendres_basin_rows(*state, found, &grid, 0, 3, picture));
  for (int i = 0; i < 3; i++) {
    const pendres_label label = i == 0 ? PENDRES_LABEL_UNSTABLE : PENDRES_LABEL_SA;
    assert_int_equal(outcome[i].label, label);
    assert_int_equal(picture[i].label, label);
  }
  pendres_attractors_free(found);
}

/* A drive leaves nothing at rest. */
static void driven(void **state)
{
  pendres_pendulum p = saddle;
  const double x = 0.0, v = 0.0;
  pendres_settled outcome;
  p.drive_amplitude = 1e-9;
  check_ok(pendres_settle(*state, 1, &p, &x, &v, &outcome, NULL));
  assert_int_equal(outcome.label, PENDRES_LABEL_PERIODIC);
}

/* A member there has no part in means, and none of it is left open. */
static void in_no_mean(void **state)
{
  enum { MEMBERS = 8 };
  const pendres_ensemble e = {.members = MEMBERS, .x_first = -1.0, .x_last = 1.0};
  pendres_response r;
  check_ok(pendres_response_find(*state, 1, &saddle, &e, &r));
  assert_int_equal(r.unstable, 1);
  assert_int_equal(r.unresolved, 0);
  assert_int_equal(r.states, 2);
  assert_int_equal(r.state_members[0] + r.state_members[1], MEMBERS - 1);
  check_near(r.mean_loop_area, 0.0, r.mean_loop_area_error);
}

/* Nor is it chaos: distances from it grow as the saddle's exponent says, which is exact. */
static void by_averages(void **state)
{
  pendres_pendulum p[2] = {saddle, tongue};
  const double x[2] = {0.0}, v[2] = {0.0}, exact = -0.15 + sqrt(0.15 * 0.15 + 1.0);
  pendres_settled l[2];
  p[1].parametric_amplitude = 0.3;
  check_ok(pendres_lyapunov_find(*state, 2, p, x, v, NULL, l));
  for (int i = 0; i < 2; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_UNSTABLE);
    assert_true(l[i].certain && l[i].exponent > 0.0);
  }
  check_near(l[0].exponent, exact, l[0].exponent_error);
}

/* A sweep that begins there stays there. */
static void along_a_path(void **state)
{
  const double value[3] = {0.1, 0.2, 0.3};
  const pendres_state start = {0.0, 0.0};
  const pendres_hysteresis_path path = {.parameter = PENDRES_DAMPING, .n = 3, .value = value};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(*state, &saddle, &start, &path, &h));
  assert_int_equal(pendres_hysteresis_jump_count(h), 0);
  for (size_t i = 0; i < 3; i++) {
    const pendres_hysteresis_point *at = pendres_hysteresis_get(h, i);
    assert_int_equal(at->attractor.label, PENDRES_LABEL_UNSTABLE);
    check_near(at->x, 0.0, 0.0);
  }
  pendres_hysteresis_free(h);
}

/* x'' + 0.3 x' + a1 x + a2 x^2 + x^3 = 0, a1 through 0, where states of rest exchange stability
   (a2 = 0.3) or become one (a2 = 0). That is exactly at 0, whether or not 0 is a value of the path,
   and whether the pendulum comes from a stable state or has rested in the unstable one. */
static void through_a_bifurcation(void **state)
{
  enum { N = 9 };
  static const struct {
    double a2, x, first;
    pendres_label from, at_0;
    pendres_jump_kind kind;
  } cases[] = {
    {0.3, 0.5, -0.4, PENDRES_LABEL_PERIODIC, PENDRES_LABEL_PERIODIC, PENDRES_JUMP_BRANCH_POINT},
    {0.3, 0.5, -0.41, PENDRES_LABEL_PERIODIC, PENDRES_LABEL_PERIODIC, PENDRES_JUMP_BRANCH_POINT},
    {0.3, 0.0, -0.4, PENDRES_LABEL_UNSTABLE, PENDRES_LABEL_UNSTABLE, PENDRES_JUMP_BRANCH_POINT},
    {0.3, 0.0, -0.41, PENDRES_LABEL_UNSTABLE, PENDRES_LABEL_UNSTABLE, PENDRES_JUMP_BRANCH_POINT},
    {0.0, 0.5, -0.4, PENDRES_LABEL_PERIODIC, PENDRES_LABEL_PERIODIC, PENDRES_JUMP_SYMMETRY}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    const pendres_pendulum p = {.force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {0.0, cases[c].a2, 1.0},
                                .damping = 0.3,
                                .drive_frequency = 1.0};
    const pendres_state start = {cases[c].x, 0.0};
    double value[N];
    for (int i = 0; i < N; i++) value[i] = i == 4 ? 0.0 : cases[c].first + 0.1 * i;
    if (cases[c].first != -0.4) value[4] = 0.5 * value[3];
    const pendres_hysteresis_path path = {.parameter = PENDRES_A1, .n = N, .value = value};
    pendres_hysteresis *h = NULL;
    check_ok(pendres_hysteresis_find(*state, &p, &start, &path, &h));
    assert_int_equal(pendres_hysteresis_jump_count(h), 1);
    const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
    assert_int_equal(j->kind, cases[c].kind);
    assert_int_equal(j->from, cases[c].from);
    assert_int_equal(j->to, PENDRES_LABEL_PERIODIC);
    check_near(j->value, 0.0, j->value_error);
    assert_true(j->value_error < 1e-13);
    assert_int_equal(pendres_hysteresis_get(h, 4)->attractor.label, cases[c].at_0);
    for (size_t i = 5; i < N; i++)
      assert_int_equal(pendres_hysteresis_get(h, i)->attractor.label, PENDRES_LABEL_PERIODIC);
    pendres_hysteresis_free(h);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(stays, setup, teardown),
    cmocka_unit_test_setup_teardown(upright, setup, teardown),
    cmocka_unit_test_setup_teardown(driven, setup, teardown),
    cmocka_unit_test_setup_teardown(in_no_mean, setup, teardown),
    cmocka_unit_test_setup_teardown(by_averages, setup, teardown),
    cmocka_unit_test_setup_teardown(along_a_path, setup, teardown),
    cmocka_unit_test_setup_teardown(through_a_bifurcation, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
