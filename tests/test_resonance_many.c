/*
 * test_resonance_many.c -- resonances searched for side by side: each is bit by bit what it is
 * alone, whatever the others are and wherever the common budget ends.
 */
#include "context_fixture.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>

#include "analysis/resonance/search.h"

enum { MOST = 20 };

static const pendres_ensemble few = {.members = 9, .x_first = -1.5707963, .x_last = 4.7123890};

static double uniform(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return *state / 4294967296.0;
}

static pendres_resonance_search search_of(double damping, double drive, double lowest,
                                          double highest)
{
  pendres_resonance_search s;
  memset(&s, 0, sizeof s);
  s.pendulum.damping = damping;
  s.pendulum.drive_amplitude = drive;
  s.lowest = lowest;
  s.highest = highest;
  return s;
}

/* Smooth peaks, edges at folds, jumps of single members, peaks that the range cuts off, areas that
   are zero, and what is refused. */
static size_t cases(pendres_resonance_search *s)
{
  static const double folds[] = {0.12, 0.15, 0.1636};
  unsigned seed = 11;
  size_t n = 0;
  for (size_t i = 0; i < sizeof folds / sizeof *folds; i++)
    s[n++] = search_of(folds[i], 0.2, 0.75, 1.05);
  for (int i = 0; i < 4; i++) {
    const double damping = 0.08 + 0.5 * uniform(&seed), drive = 0.02 + 0.25 * uniform(&seed);
    s[n++] = search_of(damping, drive, 0.7 + 0.1 * uniform(&seed), 1.1);
  }
  s[n++] = search_of(0.0306, 0.0682, 0.6988, 0.7737);
  s[n++] = search_of(0.3, 0.2, 1.0, 1.2);
  s[n++] = search_of(0.3, 0.2, 0.5, 0.8);
  s[n++] = search_of(0.3, 0.0, 0.7, 1.1);
  s[n++] = search_of(0.3, 0.2, 1.1, 0.7);
  s[n++] = search_of(NAN, 0.2, 0.7, 1.1);
  s[n++] = search_of(0.0, 0.2, 0.7, 1.1);
  assert_true(n <= MOST);
  return n;
}

#define SAME(field) assert_memory_equal(&a->field, &b->field, sizeof a->field)

static void check_same(const pendres_resonance_search *s, const pendres_resonance_search *t)
{
  const pendres_resonance *a = &s->resonance, *b = &t->resonance;
  assert_int_equal(s->outcome, t->outcome);
  assert_string_equal(s->message, t->message);
  assert_int_equal(s->outcome == PENDRES_OK, s->message[0] == '\0');
  SAME(peak);
  SAME(frequency);
  SAME(frequency_error);
  SAME(loop_area);
  SAME(loop_area_error);
  SAME(fold_frequency);
  SAME(fold_frequency_error);
  SAME(complete);
  SAME(response.mean_loop_amplitude);
  SAME(response.mean_loop_amplitude_error);
  SAME(response.phase_lag);
  SAME(response.phase_lag_error);
  SAME(response.mean_power_error);
  SAME(response.sa_fraction);
  SAME(response.uncertain);
  SAME(response.states);
  for (size_t i = 0; i < a->response.states && s->outcome == PENDRES_OK; i++) {
    SAME(response.state_members[i]);
    SAME(response.state[i].label);
    SAME(response.state[i].orbit.x);
    SAME(response.state[i].orbit.v_error);
    SAME(response.state[i].orbit.loop_area_slope);
    SAME(response.state[i].orbit.multiplier_error);
  }
}

/* What each is alone, through the function for one. */
static size_t find_alone(pendres_resonance_search *s)
{
  const size_t n = cases(s);
  size_t found = 0;
  for (size_t i = 0; i < n; i++) {
    pendres_context *ctx = NULL;
    check_ok(pendres_context_create(NULL, &ctx));
    s[i].outcome = pendres_resonance_find_ensemble(ctx, &s[i].pendulum, s[i].lowest, s[i].highest,
                                                   &few, &s[i].resonance);
    snprintf(s[i].message, sizeof s[i].message, "%s", pendres_context_message(ctx));
    found += s[i].outcome == PENDRES_OK;
    pendres_context_free(ctx);
  }
  assert_int_equal(found, 8);
  return n;
}

/* All together; in the other order, with so little to spend together that some part on the way; a
   few, with nothing to spend. */
static void whoever_is_beside(void **state)
{
  pendres_resonance_search *alone = calloc(MOST, sizeof *alone), *s = calloc(MOST, sizeof *s);
  assert_true(alone != NULL && s != NULL);
  const size_t n = find_alone(alone);
  (void)cases(s);
  check_ok(pendres_resonance_find_together(*state, n, s, &few, 9.0));
  for (size_t i = 0; i < n; i++) check_same(&s[i], &alone[i]);
  for (size_t i = 0; i < n; i++) s[n - 1 - i] = alone[i];
  for (size_t i = 0; i < n; i++) memset(&s[i].resonance, 0, sizeof s[i].resonance);
  check_ok(pendres_resonance_find_together(*state, n, s, &few, 0.6));
  for (size_t i = 0; i < n; i++) check_same(&s[n - 1 - i], &alone[i]);
  (void)cases(s);
  check_ok(pendres_resonance_find_together(*state, 2, s + 2, &few, 0.0));
  for (size_t i = 2; i < 4; i++) check_same(&s[i], &alone[i]);
  free(alone);
  free(s);
}

/* Methods whose steps are chosen for a block as a whole go one by one. */
static void adaptive_methods(void **state)
{
  pendres_context *ctx = NULL;
  pendres_resonance_search s[2], alone = search_of(0.4, 0.1, 0.9, 1.05);
  (void)state;
  check_ok(pendres_context_create(
    &(pendres_options){.method = PENDRES_BLOCK_ADAPTIVE, .tolerance = 1e-6}, &ctx));
  s[0] = search_of(0.3, 0.1, 0.9, 1.05);
  s[1] = alone;
  check_ok(pendres_resonance_find_many(ctx, 2, s, &few));
  alone.outcome = pendres_resonance_find_ensemble(ctx, &alone.pendulum, alone.lowest,
                                                  alone.highest, &few, &alone.resonance);
  check_ok(alone.outcome);
  check_same(&s[1], &alone);
  pendres_context_free(ctx);
}

static int interrupt(void *arg)
{
  int *left = arg;
  return --*left < 0;
}

/* Whenever it is interrupted it says so, and goes on from the beginning the next time. */
static void interrupted(void **state)
{
  pendres_resonance_search s[3], t[3];
  for (int i = 0; i < 3; i++) s[i] = t[i] = search_of(0.2 + 0.1 * i, 0.2, 0.8, 1.1);
  pendres_status status = PENDRES_INTERRUPTED;
  int times = 0;
  for (int left = 0; status == PENDRES_INTERRUPTED; left = 3 * left + 1) {
    int polls = left;
    pendres_context_set_interrupt(*state, interrupt, &polls);
    status = pendres_resonance_find_many(*state, 3, s, &few);
    times += status == PENDRES_INTERRUPTED;
  }
  check_ok(status);
  assert_true(times > 5);
  pendres_context_set_interrupt(*state, NULL, NULL);
  check_ok(pendres_resonance_find_many(*state, 3, t, &few));
  for (int i = 0; i < 3; i++) check_same(&s[i], &t[i]);
  check_ok(pendres_resonance_find_many(*state, 0, NULL, &few));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(whoever_is_beside, setup, teardown),
    cmocka_unit_test(adaptive_methods),
    cmocka_unit_test_setup_teardown(interrupted, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
