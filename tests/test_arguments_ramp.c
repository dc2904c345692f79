/*
 * test_arguments_ramp.c -- invalid arguments of ramps, as in test_arguments.c.
 */
#include <string.h>

#include <pendres/pendres.h>

#include "refused_fixture.h"

/* A ramp that is none, in each of its parts. */
static void ramps(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  const pendres_pendulum p = {.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.7};
  const double value[] = {0.7, 0.75}, none[] = {0.7, NAN}, other[] = {0.71, 0.75};
  const double frictionless[] = {0.7, -0.1};
  const long period[] = {0, 9}, late[] = {1, 9}, back[] = {0, 0};
  double x[10], time[4];
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(ctx, &p, &(pendres_state){1.6, 0.0},
                                   &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, 2, value},
                                   &h));
  const pendres_jump jump = {.step = 2};
  const pendres_ramp good = {.pendulum = p, .parameter = PENDRES_DRIVE_FREQUENCY, .corners = 2,
                             .period = period, .value = value, .points = 2,
                             .point = pendres_hysteresis_get(h, 0)};
  pendres_ramp bad[13];
  for (size_t i = 0; i < COUNT(bad); i++) bad[i] = good;
  bad[0].parameter = PENDRES_PARAMETER_COUNT;
  bad[1].corners = 1;
  bad[2].period = late;
  bad[3].period = back;
  bad[4].value = none;
  bad[5].value = other;
  bad[6].points = 0;
  bad[7].jumps = 1; /* and nothing there */
  bad[8].jumps = 1;
  bad[8].jump = &jump;
  bad[9].period = NULL;
  bad[10].value = NULL;
  bad[11].point = NULL;
  bad[12].parameter = PENDRES_DAMPING;
  bad[12].value = frictionless;
  check_ok(pendres_ramp_find(ctx, &good, NULL, NULL));
  REFUSED(pendres_ramp_find(ctx, NULL, NULL, NULL));
  REFUSED(pendres_ramp_scatter(ctx, NULL, 1, 0, time, NULL));
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_ramp_find(ctx, &bad[i], NULL, NULL));
    REFUSED(pendres_ramp_scatter(ctx, &bad[i], 1, 0, time, NULL));
  }
  pendres_ramp_record record = {.every = 0, .x = x, .v = x, .x_error = x, .v_error = x};
  REFUSED(pendres_ramp_find(ctx, &good, &record, NULL));
  record = (pendres_ramp_record){.every = 1, .x = x, .v = x, .x_error = x};
  REFUSED(pendres_ramp_find(ctx, &good, &record, NULL));
  const pendres_jump inside = {.step = 1};
  pendres_ramp jumping = good;
  jumping.jumps = 1;
  jumping.jump = &inside;
  REFUSED(pendres_ramp_scatter(ctx, &jumping, 1, 0, NULL, NULL));
  check_ok(pendres_ramp_scatter(ctx, &jumping, 0, 0, NULL, NULL));
  assert_int_equal(pendres_ramp_find(NULL, &good, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_ramp_scatter(NULL, &good, 1, 0, time, NULL), PENDRES_INVALID_ARGUMENT);
  pendres_hysteresis_free(h);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ramps)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
