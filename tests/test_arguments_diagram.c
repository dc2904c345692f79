/*
 * test_arguments_diagram.c -- invalid arguments of phase diagrams, parameters, dimensions and
 * spectra, as in test_arguments.c.
 */
#include <string.h>

#include <pendres/pendres.h>

#include "refused_fixture.h"

static void without_context(pendres_phase_diagram *d)
{
  const char *words = "";
  pendres_phase_round round = {PENDRES_PHASE_LINES, 1};
  assert_int_equal(pendres_phase_diagram_take(NULL, 0, 5, "bytes"), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_take(d, 0, 5, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_take(d, 0, 5, "bytes"), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_take(d, 2, 5, "bytes"), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_next(NULL, &round), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(round.tasks, 0);
  assert_int_equal(pendres_phase_diagram_next(d, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_leave_out(NULL, 0), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_leave_out(d, 4), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_outcome_get(NULL, 0, &words), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_outcome_get(d, 4, NULL), PENDRES_INVALID_ARGUMENT);
  assert_true(words == NULL && pendres_phase_diagram_point_get(NULL, 0) == NULL);
  assert_null(pendres_phase_diagram_point_get(d, 4));
  assert_null(pendres_phase_diagram_branches_get(NULL, 0));
  assert_null(pendres_phase_diagram_branches_get(d, 2));
  assert_null(pendres_phase_diagram_get(NULL).curves);
  assert_null(pendres_phase_diagram_fold_get(NULL, 0, PENDRES_LABEL_SA));
  assert_null(pendres_phase_diagram_fold_get(d, 2, PENDRES_LABEL_SA));
  assert_int_equal(pendres_phase_diagram_ending_get(NULL, NULL, 0.0), PENDRES_LABEL_PERIODIC);
}

static void diagrams(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  const double value[] = {0.7, 0.8}, back[] = {0.8, 0.7}, nan[] = {0.7, NAN};
  const pendres_phase_grid some = {.pendulum = {.drive_amplitude = 0.2},
                                   .options = {.ensemble = {4, 0.0, 1.0, 0.0}},
                                   .values = 2, .value = value, .across = PENDRES_DAMPING,
                                   .lines = 2, .line_value = value};
  pendres_phase_grid bad[] = {some, some, some, some, some, some, some, some, some, some};
  pendres_phase_diagram *d = NULL, *none = NULL;
  size_t size = 1;
  void *bytes = NULL;
  pendres_phase_round round;
  bad[0].values = bad[1].lines = 0;
  bad[2].value = bad[3].line_value = NULL;
  bad[4].value = back;
  bad[5].line_value = nan;
  bad[6].across = PENDRES_DRIVE_FREQUENCY;
  bad[7].across = PENDRES_PARAMETER_COUNT;
  bad[8].options.parameter = PENDRES_DAMPING;
  bad[9].lines = (size_t)-1 / 2;
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_phase_diagram_find(ctx, &bad[i], &none));
    assert_int_equal(pendres_phase_diagram_create(&bad[i], &none), PENDRES_INVALID_ARGUMENT);
  }
  REFUSED(pendres_phase_diagram_find(ctx, NULL, &none));
  REFUSED(pendres_phase_diagram_find(ctx, &some, NULL));
  assert_int_equal(pendres_phase_diagram_create(NULL, &none), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_phase_diagram_create(&some, NULL), PENDRES_INVALID_ARGUMENT);
  assert_null(none);
  assert_int_equal(pendres_phase_diagram_create(&some, &d), PENDRES_OK);
  REFUSED(pendres_phase_diagram_work(ctx, d, 0, &size, &bytes)); /* no round has begun */
  assert_int_equal(pendres_phase_diagram_next(d, &round), PENDRES_OK);
  REFUSED(pendres_phase_diagram_work(ctx, NULL, 0, &size, &bytes));
  REFUSED(pendres_phase_diagram_work(ctx, d, 2, &size, &bytes));
  REFUSED(pendres_phase_diagram_work(ctx, d, 0, NULL, &bytes));
  REFUSED(pendres_phase_diagram_work(ctx, d, 0, &size, NULL));
  assert_true(bytes == NULL && size == 0);
  without_context(d);
  pendres_phase_diagram_free(d);
  pendres_phase_diagram_free(NULL);
  pendres_context_free(ctx);
}

static void parameters(void **state)
{
  const pendres_pendulum good = {.damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  pendres_pendulum p = good;
  (void)state;
  assert_null(pendres_name_get(PENDRES_NAMES_PARAMETER, PENDRES_PARAMETER_COUNT));
  assert_null(pendres_parameter_of(PENDRES_PARAMETER_COUNT));
  assert_null(pendres_kind_of(PENDRES_KIND_COUNT));
  assert_null(pendres_kind_of((pendres_kind)-1));
  assert_null(pendres_quantity_get((size_t)-1));
  assert_null(pendres_quantity_of(NULL));
  assert_null(pendres_quantity_of(""));
  assert_null(pendres_name_get(PENDRES_NAMES_SPECIAL, PENDRES_SPECIAL_COUNT));
  assert_true(isnan(pendres_parameter_get(PENDRES_DAMPING, NULL)));
  assert_true(isnan(pendres_parameter_get((pendres_parameter)-1, &p)));
  pendres_parameter_set(PENDRES_DAMPING, 1.0, NULL);
  pendres_parameter_set(PENDRES_PARAMETER_COUNT, 1.0, &p);
  assert_memory_equal(&p, &good, sizeof p);
}

static void dimensions(void **state)
{
  const double x[] = {0.1, 0.2, 0.4}, bad[] = {0.1, INFINITY, NAN};
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  pendres_correlation c;
  pendres_context *ctx = NULL;
  double error = 1.0;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  assert_int_equal(pendres_correlation_find(NULL, &(pendres_section){3, x, x, 0.0}, 0.0, &c),
                   PENDRES_INVALID_ARGUMENT);
  REFUSED(pendres_correlation_find(ctx, NULL, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, NULL, x, 0.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, NULL, 0.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, x, 0.0}, 0.0, NULL));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){1, x, x, 0.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, bad, x, 0.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, bad, 0.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, x, -1.0}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, x, INFINITY}, 0.0, &c));
  REFUSED(pendres_correlation_find(ctx, &(pendres_section){3, x, x, 0.0}, NAN, &c));
  assert_true(isnan(pendres_lyapunov_dimension(NULL, 0.1, 0.0, &error)) && isnan(error));
  for (int i = 1; i < 3; i++) assert_true(isnan(pendres_lyapunov_dimension(&p, bad[i], 0.0, NULL)));
  pendres_context_free(ctx);
}

static void spectra(void **state)
{
  const double value[] = {0.1, NAN}, intervals[] = {0.0, -1.0, NAN, INFINITY};
  const size_t lengths[] = {0, 2, 7, 2 + (size_t)PENDRES_SPECTRUM_LONGEST, (size_t)-2};
  pendres_spectrum *s = NULL;
  (void)state;
  for (size_t i = 0; i < COUNT(lengths); i++)
    assert_int_equal(pendres_spectrum_create(lengths[i], 1.0, &s), PENDRES_INVALID_ARGUMENT);
  for (size_t i = 0; i < COUNT(intervals); i++)
    assert_int_equal(pendres_spectrum_create(8, intervals[i], &s), PENDRES_INVALID_ARGUMENT);
  assert_null(s);
  assert_int_equal(pendres_spectrum_create(8, 1.0, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_spectrum_create(8, 1.0, &s), PENDRES_OK);
  assert_int_equal(pendres_spectrum_add(NULL, 1, value), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_spectrum_add(s, 1, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_spectrum_add(s, 2, value), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_spectrum_get(NULL, NULL, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_spectrum_get(s, NULL, NULL, NULL), PENDRES_OK);
  assert_int_equal(pendres_spectrum_count(NULL), 0);
  pendres_spectrum_free(s);
  pendres_spectrum_free(NULL);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(diagrams), cmocka_unit_test(parameters),
                                     cmocka_unit_test(dimensions), cmocka_unit_test(spectra)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
