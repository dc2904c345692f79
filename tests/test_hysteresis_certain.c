/*
 * test_hysteresis_certain.c -- what a sweep says of states that errors may have chosen.
 *
 * Starts whose fate is known from elsewhere: by the long double reference in test_certain.c, and by
 * starts 1e-14 beside them in test_lyapunov_certain.c.
 */
#include <math.h>

#include <pendres/response.h>

#include "context_fixture.h"
#include "analysis/sweeps/hysteresis_jump.h"
#include "states_fixture.h"

/* A fractal boundary between two states: of the ensemble's members some are uncertain. */
static const pendres_pendulum fractal = {.drive_amplitude = 0.3629997361386908,
                                         .damping = 0.09617570635672344,
                                         .drive_frequency = 0.681074968553923};

enum { VALUES = 3 };

/* Follow a short path from a start; how many of its points are certain. */
static int certain_points(pendres_context *ctx, const pendres_pendulum *p, double x, double v)
{
  double value[VALUES];
  int certain = 0;
  pendres_hysteresis *h = NULL;
  for (int i = 0; i < VALUES; i++) value[i] = p->drive_amplitude + 1e-6 * i;
  check_ok(pendres_hysteresis_find(
    ctx, p, &(pendres_state){x, v},
    &(pendres_hysteresis_path){PENDRES_DRIVE_AMPLITUDE, VALUES, value}, &h));
  for (size_t i = 0; i < VALUES; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, i);
    assert_true(point->attractor.label != PENDRES_LABEL_UNRESOLVED);
    certain += point->certain;
  }
  pendres_hysteresis_free(h);
  return certain;
}

/* A path is as certain as the state that its start settles on: members 1 and 22 of the ensemble. */
static void start_that_is_trapped(void **state)
{
  const pendres_ensemble e = pendres_ensemble_default();
  assert_int_equal(certain_points(*state, &fractal, member_x(&e, 1), 0.0), VALUES);
  assert_int_equal(certain_points(*state, &fractal, member_x(&e, 22), 0.0), 0);
}

/* Under both drives averages decide: of neighbours of this start some turn one way, some the other.
   A start near the rest state of a pendulum that is driven weakly is certain. */
static void start_that_is_averaged(void **state)
{
  const pendres_pendulum p = {.damping = 0.05023358555773262,
                              .drive_amplitude = 1.4276803210172417,
                              .drive_frequency = 2.140092220495635,
                              .parametric_amplitude = -1.1244206502883256};
  const pendres_pendulum weak = {.damping = 0.2, .drive_amplitude = 0.05, .drive_frequency = 0.5,
                                 .parametric_amplitude = 0.05};
  const pendres_pendulum chaotic = {.damping = 0.5, .drive_amplitude = 1.15,
                                    .drive_frequency = 2.0 / 3.0};
  assert_int_equal(certain_points(*state, &p, 1.731637374106456, 0.3141185235724825), 0);
  assert_int_equal(certain_points(*state, &weak, 1.6, 0.0), VALUES);
  assert_int_equal(certain_points(*state, &chaotic, 0.3, 0.0), VALUES);
}

/* Trials from several states: the share is that of those that settle on the same state. */
static void share_of_trials(void **state)
{
  enum { N = PENDRES_HYSTERESIS_TRIALS };
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_pendulum p[N];
  pendres_settled outcome[N];
  double x[N], v[N] = {0.0};
  int first = 0;
  for (size_t i = 0; i < N; i++) {
    p[i] = fractal;
    x[i] = member_x(&e, 1 + 12 * i);
  }
  check_ok(pendres_settle(*state, N, p, x, v, outcome, NULL));
  for (int i = 0; i < N; i++) {
    assert_in_range(outcome[i].attractor, 0, 1);
    first += outcome[i].attractor == 0;
  }
  assert_true(first > 0 && first < N);
  pendres_arrival to;
  pendres_jump jump = {.share = NAN};
  check_ok(pendres_jump_try_from(*state, &fractal, x, v, &to, &jump));
  assert_true(jump.share == (double)(first > N / 2 ? first : N - first) / N);
  assert_int_equal(jump.certain, 0);
  for (int i = 0; i < N; i++) { /* all next to the orbit */
    x[i] = to.x + 1e-6 * i;
    v[i] = to.v;
  }
  check_ok(pendres_jump_try_from(*state, &fractal, x, v, &to, &jump));
  assert_true(jump.share == 1.0 && jump.certain);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(start_that_is_trapped),
    cmocka_unit_test(start_that_is_averaged),
    cmocka_unit_test(share_of_trials),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
