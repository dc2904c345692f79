/*
 * test_guard.c -- a handle in use is refused to every caller, and the message of a handle is about
 * its last use only.
 */
#define _XOPEN_SOURCE 700 /* pthread_create */
#include "check.h"

#include <pthread.h>
#include <string.h>

#include <pendres/pendres.h>

#include "langevin_fixture.h"

/* What a function that a handle calls tries to do with that handle. */
typedef struct intruder {
  pendres_context *ctx;
  int asked, in_thread;
  pendres_status answer;
  char said[256];
} intruder;

static void *intrude(void *arg)
{
  intruder *a = arg;
  const pendres_pendulum p = figure7(0.0);
  double x = 1.0, v = 0.0;
  a->answer = pendres_strobe_advance(a->ctx, 1, &p, &x, &v, 1, NULL);
  (void)snprintf(a->said, sizeof a->said, "%s", pendres_context_message(a->ctx));
  const pendres_status noisy =
    pendres_langevin_advance(a->ctx, RUN(1, &p, NULL, 0, 1, NULL), &x, &v);
  assert_int_equal(noisy, a->answer);
  pendres_context_set_interrupt(a->ctx, NULL, NULL);
  pendres_context_cost_reset(a->ctx);
  pendres_context_free(a->ctx);
  assert_true(x == 1.0 && v == 0.0);
  return NULL;
}

static int intrude_once(void *arg)
{
  intruder *a = arg;
  if (a->asked++ != 1) return 0;
  if (!a->in_thread) {
    (void)intrude(a);
  } else {
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, intrude, a), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
  }
  return 0;
}

static void check_refused(const intruder *a)
{
  assert_true(a->asked > 1);
  assert_int_equal(a->answer, PENDRES_BUSY);
  assert_string_equal(a->said, pendres_status_message(PENDRES_BUSY));
}

/* By every method, from the function that is asked or from another thread: the results are those
 * of a run that nobody disturbs, to the last bit. */
static void contexts_in_use_are_refused(void **state)
{
  const pendres_pendulum p = figure7(0.0);
  (void)state;
  for (int k = 0; k < 2 * PENDRES_METHOD_COUNT; k++) {
    const pendres_options o = {.method = (pendres_method)(k / 2)};
    pendres_context *ctx = NULL;
    double x[2] = {1.0, 1.0}, v[2] = {0.0, 0.0};
    pendres_cost cost;
    check_ok(pendres_context_create(&o, &ctx));
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x[0], &v[0], 5, NULL));
    pendres_context_cost_reset(ctx);
    intruder a = {.ctx = ctx, .in_thread = k % 2};
    pendres_context_set_interrupt(ctx, intrude_once, &a);
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x[1], &v[1], 5, NULL));
    check_refused(&a);
    assert_true(a.asked >= 5); /* the intruder did not take itself away */
    assert_true(x[0] == x[1] && v[0] == v[1]);
    pendres_context_cost(ctx, &cost);
    assert_true(cost.pendulum_periods == 5.0);
    assert_string_equal(pendres_context_message(ctx), "");
    pendres_context_free(ctx);
  }
}

/* Where the library makes a second context for itself, the first is in use nevertheless. */
static void second_contexts_ask_for_the_first(void **state)
{
  const pendres_options o = {.method = PENDRES_BLOCK_ADAPTIVE, .tolerance = 1e-6};
  pendres_context *ctx = NULL;
  double amplitude = 1.0, frequency, error;
  (void)state;
  for (int in_thread = 0; in_thread < 2; in_thread++) {
    int asked = 0;
    for (int when = 0; when < 1 || asked > 1; when++) {
      check_ok(pendres_context_create(&o, &ctx));
      intruder a = {.ctx = ctx, .in_thread = in_thread, .asked = 1 - when};
      pendres_context_set_interrupt(ctx, intrude_once, &a);
      check_ok(pendres_free_find(ctx, 1, &amplitude, &frequency, &error));
      asked = a.asked;
      if (asked > 1) check_refused(&a);
      pendres_context_free(ctx);
    }
  }
}

static pendres_langevin_answer intruding_observer(void *arg, const pendres_langevin_strobe *strobe)
{
  (void)strobe;
  (void)intrude_once(arg);
  return PENDRES_LANGEVIN_GO_ON;
}

static void intruding_leave(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  (void)strobe;
  (void)left;
  (void)intrude_once(arg);
}

static void noisy_contexts_in_use_are_refused(void **state)
{
  const pendres_pendulum p = figure7(1e-3);
  (void)state;
  for (int k = 0; k < 6; k++) {
    pendres_context *ctx = make(1, 16, 8);
    intruder a = {.ctx = ctx, .in_thread = k % 2};
    double x = 1.0, v = 0.0;
    const pendres_langevin_observer observer = {intruding_observer, &a, 0};
    const pendres_langevin_request request = {.pendulum = p, .x = 1.0, .trajectories = 2,
                                              .record = 5, .leave = intruding_leave, .arg = &a};
    pendres_langevin_cloud cloud;
    if (k < 2) {
      pendres_context_set_interrupt(ctx, intrude_once, &a);
      check_ok(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 0, 5, NULL), &x, &v));
    } else if (k < 4) {
      check_ok(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 0, 5, &observer), &x, &v));
    } else {
      check_ok(pendres_langevin_cloud_find(ctx, &request, &cloud, NULL, NULL));
    }
    check_refused(&a);
    assert_true(a.asked >= 5);
    assert_string_equal(pendres_context_message(ctx), "");
    pendres_context_free(ctx);
  }
}

/* ---- What a handle says ---- */

static void successes_say_nothing(void **state)
{
  const pendres_pendulum good = figure7(0.0), bad = {.damping = -1.0, .drive_frequency = 1.0};
  pendres_context *ctx = NULL;
  double x = 1.0, v = 0.0;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  assert_int_equal(pendres_strobe_advance(ctx, 1, &bad, &x, &v, 1, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "damping"));
  check_ok(pendres_strobe_advance(ctx, 1, &good, &x, &v, 1, NULL));
  assert_string_equal(pendres_context_message(ctx), "");
  assert_int_equal(pendres_strobe_advance(ctx, 1, &bad, &x, &v, 1, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_strobe_advance(ctx, 1, NULL, &x, &v, 1, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "NULL"));
  pendres_context_free(ctx);

  ctx = make(1, 16, 8);
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &bad, NULL, 0, 1, NULL), &x, &v),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "damping"));
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, NULL, NULL, 0, 1, NULL), &x, &v),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "NULL"));
  check_ok(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &x, &v));
  assert_string_equal(pendres_context_message(ctx), "");
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(contexts_in_use_are_refused),
    cmocka_unit_test(second_contexts_ask_for_the_first),
    cmocka_unit_test(noisy_contexts_in_use_are_refused),
    cmocka_unit_test(successes_say_nothing),
  };
  return cmocka_run_group_tests_name("guard", tests, NULL, NULL);
}
