/*
 * test_arguments_fit.c -- invalid arguments of fits, as in test_arguments.c.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

static void refusals(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  pendres_fit_datum data[] = {{PENDRES_FIT_AMPLITUDE, 1, 0.8, 0.0, 0.1, 0.0},
                              {PENDRES_FIT_AMPLITUDE, 1, 0.9, 0.0, 0.2, 0.0},
                              {PENDRES_FIT_AMPLITUDE, 1, 1.0, 0.0, 0.3, 0.0}};
  pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.1},
                                {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = 0.1}};
  pendres_fit_data all = {3, data, PENDRES_DRIVE_FREQUENCY, PENDRES_PARAMETER_COUNT};
  pendres_fit_model model = {.unknowns = 2, .unknown = open};
  pendres_fit *fit = NULL;
#define REFUSED(...)                                                                               \
  do {                                                                                             \
    assert_int_equal(pendres_fit_find(ctx, __VA_ARGS__, NULL, &fit), PENDRES_INVALID_ARGUMENT);    \
    assert_null(fit);                                                                              \
    assert_true(pendres_context_message(ctx)[0] != '\0');                                          \
  } while (0)
  REFUSED(NULL, &model);
  REFUSED(&all, NULL);
  all.n = 2;
  REFUSED(&all, &model); /* as many data as unknowns */
  all.n = 3;
  data[1].observed = NAN;
  REFUSED(&all, &model);
  data[1].observed = 0.2;
  data[1].direction = 0;
  REFUSED(&all, &model);
  data[1].direction = 1;
  data[1].error = 0.1; /* one of three */
  REFUSED(&all, &model);
  data[1].error = 0.0;
  data[0].axis = -1.0;
  REFUSED(&all, &model);
  data[0].axis = 0.8;
  open[1].quantity = PENDRES_DAMPING;
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_DRIVE_FREQUENCY;
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_A3; /* a pendulum has no such coefficient */
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_FIT_DRIVE_SCALE; /* there are no drives in the data */
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_FIT_QUANTITY_COUNT;
  REFUSED(&all, &model);
  open[1] = (pendres_fit_unknown){.quantity = PENDRES_DRIVE_AMPLITUDE, .fixed = 1, .guess = NAN};
  REFUSED(&all, &model);
  open[1].guess = 0.1;
  open[0].fixed = 1; /* nothing is free */
  REFUSED(&all, &model);
  /* Free decays: displacements forwards in time, and nothing of a drive. */
  open[0].fixed = 0;
  all.axis = PENDRES_PARAMETER_COUNT;
  REFUSED(&all, &model); /* amplitudes */
  for (int i = 0; i < 3; i++) data[i].observable = PENDRES_FIT_DISPLACEMENT;
  REFUSED(&all, &model); /* a drive */
  open[1].quantity = PENDRES_FIT_PHASE_OFFSET;
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_FIT_START_VELOCITY;
  data[1].direction = -1;
  REFUSED(&all, &model);
  data[1].direction = 1;
  all.other = PENDRES_DAMPING;
  REFUSED(&all, &model);
  all.other = PENDRES_PARAMETER_COUNT;
  all.axis = PENDRES_DRIVE_FREQUENCY;
  REFUSED(&all, &model); /* displacements over a frequency, which have no start either */
  /* Jumps have an error, and a place above 0 where the axis has. */
  data[1].observable = PENDRES_FIT_JUMP;
  open[1] = (pendres_fit_unknown){.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = 1.0};
  for (int i = 0; i < 3; i++) {
    if (i != 1) data[i].observable = PENDRES_FIT_AMPLITUDE;
  }
  REFUSED(&all, &model);
  for (int i = 0; i < 3; i++) data[i].error = 0.01;
  data[1].observed = -1.0;
  REFUSED(&all, &model);
  for (int i = 0; i < 3; i++) data[i].error = 0.0;
  data[1].observed = 0.2;
  /* Mean velocities: alone, over the torque of a pendulum, without a drive. */
  for (int i = 0; i < 3; i++) data[i].observable = PENDRES_FIT_MEAN_VELOCITY;
  open[1] = (pendres_fit_unknown){.quantity = PENDRES_FIT_TORQUE_SCALE, .guess = 1.0};
  REFUSED(&all, &model); /* over a frequency */
  all.axis = PENDRES_TORQUE;
  data[1].observable = PENDRES_FIT_AMPLITUDE;
  REFUSED(&all, &model);
  data[1].observable = PENDRES_FIT_MEAN_VELOCITY;
  model.pendulum.drive_amplitude = 0.1;
  REFUSED(&all, &model);
  model.pendulum.drive_amplitude = 0.0;
  open[1].quantity = PENDRES_FIT_PHASE_OFFSET;
  REFUSED(&all, &model);
  open[1].quantity = PENDRES_FIT_TORQUE_SCALE;
  all.axis = PENDRES_DAMPING; /* there are no torques in the data */
  REFUSED(&all, &model);
#undef REFUSED
  assert_int_equal(pendres_fit_find(ctx, &all, &model, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_fit_find(NULL, &all, &model, NULL, &fit), PENDRES_INVALID_ARGUMENT);
  pendres_fit_free(NULL);
  assert_true(isnan(pendres_fit_value(NULL, 0)) && isnan(pendres_fit_covariance(NULL, 0, 0)));
  assert_null(pendres_fit_point_get(NULL, 0));
  assert_null(pendres_fit_jump_get(NULL, 0));
  assert_null(pendres_fit_note_get(NULL, 0));
  assert_int_equal(pendres_fit_summary_get(NULL).data, 0);
  for (int q = 0; q < PENDRES_PARAMETER_FOLLOWED; q++)
    assert_string_equal(pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, q),
                        pendres_name_get(PENDRES_NAMES_PARAMETER, q));
  pendres_context_free(ctx);
}

/* Amplitudes that no error and no noise makes negative, and phases beyond a turn: which datum. */
static void values(void **state)
{
  (void)state;
  enum { N = 4 };
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  pendres_fit_datum data[N];
  pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.1},
                                {.quantity = PENDRES_FIT_OFFSET, .guess = 0.0}};
  pendres_fit_data all = {N, data, PENDRES_DRIVE_FREQUENCY, PENDRES_PARAMETER_COUNT};
  pendres_fit_model model = {.pendulum = {.damping = 0.1, .drive_amplitude = 0.01}, .unknowns = 1,
                             .unknown = open};
  size_t datum = 0;
  const char *why = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int i = 0; i < N; i++)
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_RMS, .direction = 1,
                                  .axis = 0.7 + 0.2 * i, .observed = 0.1};
#define AT(value, standard, refused)                                                               \
  do {                                                                                             \
    for (int i = 0; i < N; i++) data[i].error = (standard);                                        \
    data[2].observed = (value);                                                                    \
    const int is_refused = pendres_fit_data_check(&all, &model, &datum, &why) != PENDRES_OK;       \
    assert_int_equal(is_refused, (refused));                                                       \
    assert_int_equal(datum, (refused) ? 2 : N);                                                    \
    assert_int_equal(why != NULL, (refused));                                                      \
  } while (0)
  AT(-0.049, 0.0, 0); /* noise of a tenth, as far as it goes */
  AT(-0.051, 0.0, 1);
  AT(-0.049, 0.01, 0);
  AT(-0.051, 0.01, 1);
  assert_int_equal(pendres_fit_find(ctx, &all, &model, NULL, &fit), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "datum 2: "));
  model.unknowns = 2; /* an offset makes readings negative, not all of them, ... */
  AT(-0.09, 0.01, 0);
  AT(-0.11, 0.01, 1);
  for (int i = 0; i < N; i++) data[i].observable = PENDRES_FIT_LOOP_AREA; /* ... nor areas */
  AT(-0.09, 0.01, 1);
  for (int i = 0; i < N; i++) data[i].observable = PENDRES_FIT_PHASE_LAG;
  AT(-6.2, 0.0, 0);
  AT(6.3, 0.0, 1);
  AT(-6.3, 0.01, 0);
  for (int i = 0; i < N; i++) data[i].observable = PENDRES_FIT_QUADRATURE;
  AT(-60.0, 0.01, 0);
#undef AT
  assert_int_equal(pendres_fit_data_check(NULL, &model, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_fit_data_check(&all, NULL, &datum, &why), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(refusals), cmocka_unit_test(values)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
