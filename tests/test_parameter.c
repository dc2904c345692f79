/*
 * test_parameter.c -- the table of parameters: each has a field of its own, words, and the unit
 * that the equation of motion gives it. Derivatives by them are compared with differences in
 * test_model.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

#include "model/parameter.h"
#include "model/units.h"

/* Each sets its field alone, and comes back; frequency and period are one quantity. */
static void each_has_its_field(void **state)
{
  (void)state;
  for (int k = 0; k < PENDRES_PARAMETER_COUNT; k++) {
    const pendres_parameter parameter = (pendres_parameter)k;
    const int of_start = parameter == PENDRES_X || parameter == PENDRES_V;
    pendres_pendulum p = {.drive_frequency = 1.0};
    pendres_parameter_set(parameter, 0.5, &p);
    for (int other = 0; other < PENDRES_PARAMETER_COUNT; other++) {
      const double now = pendres_parameter_get((pendres_parameter)other, &p);
      const pendres_pendulum before = {.drive_frequency = 1.0};
      if (other == k && !of_start) assert_true(now == 0.5);
      else if (pendres_parameter_place((pendres_parameter)other) !=
               pendres_parameter_place(parameter) && !isnan(now))
        assert_true(now == pendres_parameter_get((pendres_parameter)other, &before));
    }
    assert_int_equal(isnan(pendres_parameter_get(parameter, &p)) != 0, of_start);
  }
  assert_int_equal(pendres_parameter_place(PENDRES_DRIVE_PERIOD),
                   pendres_parameter_place(PENDRES_DRIVE_FREQUENCY));
}

static void each_has_words(void **state)
{
  (void)state;
  for (int k = 0; k < PENDRES_PARAMETER_COUNT; k++) {
    const pendres_parameter_info *info = pendres_parameter_of((pendres_parameter)k);
    assert_non_null(info);
    assert_true(info->words[0] != '\0' && info->brief[0] != '\0');
    assert_non_null(pendres_kind_of(info->kind));
    /* x, v and the temperature are results as well, with rows of their own. */
    assert_int_equal(pendres_quantity_of(info->name)->kind, info->kind);
    assert_string_equal(info->name, pendres_name_get(PENDRES_NAMES_PARAMETER, k));
    const int coefficient = k >= PENDRES_A1 && k <= PENDRES_A5 ? k - PENDRES_A1 + 1 : 0;
    assert_int_equal(info->coefficient, coefficient);
    for (int other = 0; other < k; other++)
      assert_true(strcmp(info->name, pendres_name_get(PENDRES_NAMES_PARAMETER, other)) != 0);
  }
  assert_null(pendres_parameter_of(PENDRES_PARAMETER_COUNT));
  assert_null(pendres_parameter_of((pendres_parameter)-1));
}

/* A name is one quantity; what only ends in its words is another one, or none. */
static void quantities_have_one_row(void **state)
{
  const pendres_quantity *q;
  size_t n = 0;
  (void)state;
  for (; (q = pendres_quantity_get(n)) != NULL; n++) {
    assert_ptr_equal(pendres_quantity_of(q->name), q);
    assert_true(q->words[0] != '\0' && pendres_kind_of(q->kind) != NULL);
  }
  assert_true(n > 50);
  assert_int_equal(pendres_quantity_of("mean_velocity")->kind, PENDRES_KIND_VELOCITY);
  assert_int_equal(pendres_quantity_of("start_velocity")->kind, PENDRES_KIND_VELOCITY);
  assert_null(pendres_quantity_of("velocity"));
  assert_null(pendres_quantity_of("terminal_velocity"));
  assert_null(pendres_quantity_of("loop_area_error"));
}

/*
 * The same oscillator with lengths in units of L and times in units of T: the terms of the equation
 * are accelerations, and energies are those of a unit mass. Powers of two lose no digit.
 */
static void units_are_those_of_the_equation(void **state)
{
  const double L = 0.25, T = 8.0, a = L / (T * T);
  const pendres_scales scales = {.unit = {L, T}, .first = 1.0, .second = 1.0};
  pendres_pendulum p = {.damping = 3.0 / T, .drive_amplitude = 3.0 * a, .drive_frequency = 3.0 / T,
                        .temperature = 3.0 * a * L, .nonlinear_damping = 3.0 / (L * L * T),
                        .quadratic_damping = 3.0 / L, .cubic_damping = 3.0 * T / (L * L),
                        .torque = 3.0 * a, .parametric_amplitude = 3.0,
                        .force = PENDRES_FORCE_POLYNOMIAL};
  (void)state;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    p.force_coefficients[k] = 3.0 * a / pow(L, k + 1);
  const pendres_pendulum before = p;
  pendres_units_in(&scales, &pendres_dim_pendulum, 1, &p);
  for (int k = 0; k < PENDRES_PARAMETER_COUNT; k++) {
    const pendres_parameter parameter = (pendres_parameter)k;
    const double now = pendres_parameter_get(parameter, &p);
    const double then = pendres_parameter_get(parameter, &before);
    if (isnan(now)) continue;
    check_near(now, parameter == PENDRES_DRIVE_PERIOD ? 2.0 * PENDRES_PI / 3.0 : 3.0, 1e-15);
    check_near(then / now, pendres_units_of_parameter(&scales.unit, parameter), 1e-15 * then / now);
  }
  assert_true(pendres_units_of_parameter(&scales.unit, PENDRES_X) == L);
  assert_true(pendres_units_of_parameter(&scales.unit, PENDRES_V) == L / T);
  assert_true(pendres_units_of_parameter(&scales.unit, PENDRES_PARAMETER_COUNT) == 1.0);
}

/* What orbits are followed in: what the model has, and derivatives are there by. */
static void who_is_followed(void **state)
{
  static const int coefficients[] = {
    [PENDRES_FORCE_PENDULUM] = 0, [PENDRES_FORCE_POLYNOMIAL] = 5, [PENDRES_FORCE_SQUID] = 1};
  (void)state;
  for (int force = 0; force < PENDRES_FORCE_COUNT; force++)
    for (int k = -1; k <= PENDRES_PARAMETER_COUNT; k++) {
      const int there = k >= 0 && k < PENDRES_PARAMETER_FOLLOWED &&
                        (k < PENDRES_A1 || k > PENDRES_A5 ||
                         k - PENDRES_A1 < coefficients[force]) &&
                        (k != PENDRES_NONLINEAR_DAMPING || force != PENDRES_FORCE_PENDULUM);
      const char *why = pendres_parameter_refuses((pendres_parameter)k, (pendres_force)force);
      assert_int_equal(why == NULL, there);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_has_its_field),
    cmocka_unit_test(each_has_words),
    cmocka_unit_test(quantities_have_one_row),
    cmocka_unit_test(units_are_those_of_the_equation),
    cmocka_unit_test(who_is_followed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
