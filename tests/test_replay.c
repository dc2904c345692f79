/*
 * test_replay.c -- periods that are repeated from a recording give the same bytes as ARKODE's own.
 *
 * A context that is made again for every period has no recording, so that ARKODE computes each of
 * them; in a context that is kept ARKODE computes two of each kind. All bytes must be the same.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

#include "engine/context_internal.h"
#include "engine/sundials/lanes_replay.h"
#include "engine/strobe_run.h"

enum { LANES = 11, PERIODS = 5 };

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  return ctx;
}

static int one_period(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  (void)index;
  return lane->period >= *(const long *)arg;
}

static void load(pendres_pendulum *p, pendres_strobe_lane *lanes, int steps, double added)
{
  for (size_t i = 0; i < LANES; i++) {
    p[i] = (pendres_pendulum){.damping = 0.1 + 0.05 * (double)i,
                              .drive_amplitude = 0.2 + 0.1 * (double)i,
                              .drive_frequency = 0.6 + 0.05 * (double)i};
    lanes[i] = (pendres_strobe_lane){.pendulum = &p[i], .y = -2.0 + 0.4 * (double)i,
                                     .w = 0.1 * (double)i, .steps = steps, .added = added};
  }
}

/* Periods in one context, or each in its own, of lanes with and without errors carried along. */
static void run(pendres_context *kept, int steps, double added, pendres_strobe_lane *lanes,
                pendres_cost *cost)
{
  static pendres_pendulum p[LANES];
  memset(cost, 0, sizeof *cost);
  load(p, lanes, steps, added);
  for (long k = 1; k <= PERIODS; k++) {
    pendres_context *ctx = kept != NULL ? kept : context();
    pendres_cost one;
    pendres_context_cost_reset(ctx);
    check_ok(pendres_strobe_run(ctx, LANES, lanes, one_period, &k));
    pendres_context_cost(ctx, &one);
    cost->rhs_evaluations += one.rhs_evaluations;
    cost->steps += one.steps;
    if (kept == NULL) pendres_context_free(ctx);
  }
}

static void test_periods(void **state)
{
  static const int steps[] = {12, 30, 12, 31, 2000};
  pendres_context *kept = context();
  (void)state;
  for (size_t s = 0; s < sizeof steps / sizeof *steps; s++)
    for (int carried = 0; carried < 2; carried++) {
      pendres_strobe_lane own[LANES], again[LANES];
      pendres_cost cost[2];
      run(NULL, steps[s], carried * 1e-20, own, &cost[0]);
      run(kept, steps[s], carried * 1e-20, again, &cost[1]);
      for (size_t i = 0; i < LANES; i++) {
        check_near(again[i].y, own[i].y, 0.0);
        check_near(again[i].w, own[i].w, 0.0);
        check_near(again[i].off.yy, own[i].off.yy, 0.0);
        check_near(again[i].off.ww, own[i].off.ww, 0.0);
        check_near(again[i].worst, own[i].worst, 0.0);
      }
      check_near(cost[1].rhs_evaluations, cost[0].rhs_evaluations, 0.0);
      check_near(cost[1].steps, cost[0].steps, 0.0);
    }
  pendres_context_free(kept);
}

/* Periods that are sampled on the way, by all equations; three orbits one after the other. */
static void test_orbits(void **state)
{
  pendres_context *kept = context();
  (void)state;
  for (int i = 0; i < 6; i++) {
    const pendres_orbit_want want =
      i % 2 == 0 ? PENDRES_ORBIT_PLAIN : PENDRES_ORBIT_FREQUENCY_SLOPE;
    const pendres_orbit_guess guess = {
      .pendulum = {.damping = 0.2 + 0.01 * i, .drive_amplitude = 0.2, .drive_frequency = 0.9},
      .x = 1.6, .v = 0.1, .period = 1};
    pendres_context *own = context();
    pendres_orbit orbit[2];
    pendres_status outcome[2];
    memset(orbit, 0, sizeof orbit); /* padding, too */
    check_ok(pendres_orbit_find(own, 1, &guess, want, &orbit[0], &outcome[0]));
    check_ok(pendres_orbit_find(kept, 1, &guess, want, &orbit[1], &outcome[1]));
    check_ok(outcome[0]);
    check_ok(outcome[1]);
    assert_true(memcmp(&orbit[0], &orbit[1], sizeof orbit[0]) == 0);
    pendres_context_free(own);
  }
  pendres_context_free(kept);
}

/* A period of one sum and the slope at it. */
static void record(pendres_lanes_replays *r, const pendres_lanes_replay_kind *kind, double *data,
                   double c, double cos_theta, int whole)
{
  const pendres_sum sum = {.terms = 1, .z = data, .term = {{.c = c, .x = data}}};
  const pendres_operation o[2] = {
    {0}, {.sum = &sum, .to = data, .slope = data, .cos_theta = cos_theta, .keep = 1}};
  pendres_lanes_replays_begin(r);
  pendres_lanes_replays_add(r, o, 2);
  pendres_lanes_replays_part(r);
  pendres_lanes_replays_end(r, kind, whole);
}

/* Only what two whole periods in a row have asked for alike is done again. */
static void test_records(void **state)
{
  double data[8] = {0.0};
  const pendres_lanes_replay_kind kind = {.steps = 1}, other = {.steps = 1, .carried = 1};
  pendres_lanes_replays *r = pendres_lanes_replays_create();
  (void)state;
  assert_true(r != NULL);
  record(r, &kind, data, 1.0, 0.5, 1);
  assert_true(pendres_lanes_replays_find(r, &kind) == NULL);
  record(r, &kind, data, 2.0, 0.5, 1); /* another sum */
  record(r, &kind, data, 2.0, 0.6, 1); /* another phase */
  record(r, &kind, data, 2.0, 0.6, 0); /* it failed */
  assert_true(pendres_lanes_replays_find(r, &kind) == NULL);
  record(r, &kind, data, 2.0, 0.6, 1);
  const pendres_lanes_replay *p = pendres_lanes_replays_find(r, &kind);
  assert_true(p != NULL && p->operations == 1 && p->slopes == 1 && p->parts == 1);
  assert_true(p != NULL && p->operation[0].sum->terms == 1);
  check_near(p->operation[0].sum->term[0].c, 2.0, 0.0);
  assert_true(pendres_lanes_replays_find(r, &other) == NULL);
  pendres_lanes_replays_free(r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_periods), cmocka_unit_test(test_orbits),
                                     cmocka_unit_test(test_records)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
