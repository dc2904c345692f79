/*
 * test_signals.c -- the signal handlers: the first signal requests a stop, a second one ends the
 * program, and computations notice the first within a drive period.
 */
#define _XOPEN_SOURCE 700 /* fork, kill */
#include "check.h"

#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <pendres/pendres.h>

#include "terminal/signals.h"

static void pause_for(double seconds)
{
  const struct timespec t = { (time_t)seconds, (long)(1e9 * (seconds - floor(seconds))) };
  (void)nanosleep(&t, NULL);
}

/* A child that gets a signal, waits, and gets it again; its wait status. */
static int twice(int number, double apart)
{
  int how = 0;
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    if (signals_install() != 0 || signals_stop(NULL)) _exit(1);
    (void)raise(number);
    if (!signals_stop(NULL)) _exit(2);
    pause_for(apart);
    (void)raise(number);
    _exit(signals_stop(NULL) ? 42 : 3);
  }
  assert_int_equal(waitpid(child, &how, 0), child);
  return how;
}

static void second_signals_end(void **state)
{
  static const int numbers[] = { SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2 };
  (void)state;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    const int how = twice(numbers[i], 0.3);
    assert_true(WIFSIGNALED(how) && WTERMSIG(how) == numbers[i]);
  }
  /* One signal sent twice over, and the one that the system repeats. */
  int how = twice(SIGTERM, 0.0);
  assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 42);
  how = twice(SIGXCPU, 0.3);
  assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 42);
}

static int count_then_stop(void *arg)
{
  int *asked = arg;
  return ++*asked > 3;
}

/*
 * A single period of many steps, by every method: it ends when the fourth question is answered, far
 * before the period. Steps of friction's stability at damping 3e4 number some 1e5 or more.
 */
static void asked_within_a_period(void **state)
{
  static const pendres_method methods[] = { PENDRES_BLOCK_FIXED, PENDRES_BLOCK_ADAPTIVE,
                                            PENDRES_SINGLE, PENDRES_CVODE_ADAMS, PENDRES_NAIVE };
  enum { N = 64 };
  pendres_pendulum p[N];
  double x[N], v[N];
  (void)state;
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){ .damping = 3e4, .drive_amplitude = 0.2, .drive_frequency = 0.1 };
    x[i] = v[i] = 0.0;
  }
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    const int steps = methods[m] == PENDRES_BLOCK_FIXED ? 800000 : 0;
    const pendres_options o = { .method = methods[m], .steps_per_period = steps };
    pendres_context *ctx = NULL;
    pendres_cost cost;
    int asked = 0;
    check_ok(pendres_context_create(&o, &ctx));
    pendres_context_set_interrupt(ctx, count_then_stop, &asked);
    assert_int_equal(pendres_strobe_advance(ctx, N, p, x, v, 1, NULL), PENDRES_INTERRUPTED);
    assert_non_null(strstr(pendres_context_message(ctx), "interrupted"));
    assert_true(asked == 4 || asked == 5); /* the naive method asks once more on its way out */
    pendres_context_cost(ctx, &cost);
    assert_true(cost.steps < 2e6); /* 64 pendulums of a period each would be far more */
    assert_true(x[0] == 0.0 && v[0] == 0.0);
    pendres_context_free(ctx);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(second_signals_end),
    cmocka_unit_test(asked_within_a_period),
  };
  return cmocka_run_group_tests_name("signals", tests, NULL, NULL);
}
