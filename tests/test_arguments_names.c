/*
 * test_arguments_names.c -- every value of an enum has a name, and other numbers have none.
 *
 * Names are a contract: they stand in decks and files. They are words without blanks, since
 * flag_meanings of a file separates them by blanks, and no two of an enum are the same.
 */
#include "check.h"

#include <ctype.h>
#include <limits.h>
#include <string.h>

#include <pendres/pendres.h>
#include <pendres/store.h>

enum { MOST_NAMES = 40 };

static const struct {
  const char *what;
  pendres_names list;
  int count; /* of values; 0: they are bits */
  const char *names[MOST_NAMES];
} enums[] = {
  {"basin_end", PENDRES_NAMES_BASIN_END, PENDRES_BASIN_END_COUNT,
   {"attractor", "well"}},
  {"basin_how", PENDRES_NAMES_BASIN_HOW, PENDRES_BASIN_HOW_COUNT,
   {"integrated", "filled", "deferred", "uncertain"}},
  {"branch_end", PENDRES_NAMES_BRANCH_END, PENDRES_END_COUNT,
   {"range", "closed", "too_wild", "too_long", "stuck"}},
  {"cloud_verdict", PENDRES_NAMES_CLOUD_VERDICT, PENDRES_CLOUD_VERDICTS,
   {"agrees", "too_hot", "not_compared", "uncertain", "below_rounding"}},
  {"cloud_way", PENDRES_NAMES_CLOUD_WAY, PENDRES_CLOUD_WAY_COUNT,
   {"none", "still", "narrow", "followed"}},
  {"doubt", PENDRES_NAMES_DOUBT, 0,
   {"unlisted_change", "turn_without_fold", "bifurcation_without_its_signs"}},
  {"ensemble_shape", PENDRES_NAMES_ENSEMBLE_SHAPE, PENDRES_ENSEMBLE_SHAPE_COUNT,
   {"line", "rectangle", "random"}},
  {"jump_kind", PENDRES_NAMES_JUMP, PENDRES_JUMP_COUNT,
   {"fold", "flip", "symmetry", "other", "branch_point", "crisis", "homoclinic"}},
  {"label", PENDRES_NAMES_LABEL, PENDRES_LABEL_COUNT,
   {"sa", "la", "periodic", "running", "chaotic", "unresolved", "escape",
    "quasi_periodic", "unstable"}},
  {"langevin_answer", PENDRES_NAMES_LANGEVIN_ANSWER, PENDRES_LANGEVIN_ANSWER_COUNT,
   {"go_on", "enough", "stop"}},
  {"langevin_statistic", PENDRES_NAMES_LANGEVIN_STATISTIC, PENDRES_LANGEVIN_STATISTICS,
   {"mean_x", "mean_v", "cov_xx", "cov_xv", "cov_vv", "cosine", "sine", "loop_area"}},
  {"method", PENDRES_NAMES_METHOD, PENDRES_METHOD_COUNT,
   {"block_fixed", "block_adaptive", "single", "cvode_adams", "cvode_bdf", "naive"}},
  {"other", PENDRES_NAMES_OTHER, 0,
   {"asymmetric", "periodic", "running", "chaotic", "unresolved", "escape", "unstable"}},
  {"parameter", PENDRES_NAMES_PARAMETER, PENDRES_PARAMETER_COUNT,
   {"drive_frequency", "damping", "drive_amplitude", "torque", "parametric_amplitude", "a1", "a2",
    "a3", "a4", "a5", "nonlinear_damping", "quadratic_damping", "cubic_damping",
    "drive_period", "temperature", "x", "v"}},
  {"peak", PENDRES_NAMES_PEAK, PENDRES_PEAK_COUNT,
   {"smooth", "edge", "ragged"}},
  {"regime", PENDRES_NAMES_REGIME, PENDRES_REGIME_COUNT,
   {"sa", "la", "coexistence", "single", "other"}},
  {"special", PENDRES_NAMES_SPECIAL, PENDRES_SPECIAL_COUNT,
   {"regular", "fold", "period_doubling", "symmetry_breaking", "branch_point"}},
  {"fit_observable", PENDRES_NAMES_FIT_OBSERVABLE, PENDRES_FIT_OBSERVABLE_COUNT,
   {"amplitude", "rms", "first_harmonic_amplitude", "phase_lag", "in_phase", "quadrature",
    "loop_area", "displacement", "mean_velocity", "jump", "resonance", "velocity_amplitude",
    "acceleration_amplitude", "transmission_real", "transmission_imaginary", "notch_real",
    "notch_imaginary", "reflection_real", "reflection_imaginary"}},
  {"fit_quantity", PENDRES_NAMES_FIT_QUANTITY, PENDRES_FIT_QUANTITY_COUNT,
   {"drive_frequency", "damping", "drive_amplitude", "torque", "parametric_amplitude", "a1", "a2",
    "a3", "a4", "a5", "nonlinear_damping", "quadratic_damping", "cubic_damping", "frequency_scale",
    "drive_scale", "amplitude_scale", "offset",
    "phase_offset", "background_in_phase", "background_quadrature", "start_displacement",
    "start_velocity", "torque_scale", "internal_q", "coupling_q", "coupling_phase", "delay",
    "background_amplitude", "background_phase"}},
  {"step_end", PENDRES_NAMES_STEP_END, PENDRES_STEP_END_COUNT, {"left", "seen", "range"}},
  {"store_type", PENDRES_NAMES_STORE_TYPE, PENDRES_STORE_TYPE_COUNT,
   {"double", "int8", "int32", "int64", "string"}},
  {"table", PENDRES_NAMES_TABLE, PENDRES_TABLE_COUNT,
   {"default", "tp8", "tsit5", "vern9", "dp5"}},
  {"switching_verdict", PENDRES_NAMES_SWITCHING_VERDICT, PENDRES_SWITCHING_VERDICTS,
   {"straight", "not_straight", "two_points", "too_few_events", "no_state", "no_barrier",
    "unbalanced"}},
  {"switching_way", PENDRES_NAMES_SWITCHING_WAY, PENDRES_SWITCHING_WAYS,
   {"forth", "back", "first_well", "second_well"}},
};

static int is_word(const char *name)
{
  for (; *name != '\0'; name++)
    if (!islower((unsigned char)*name) && !isdigit((unsigned char)*name) && *name != '_') return 0;
  return 1;
}

static void values_have_names(void **state)
{
  (void)state;
  assert_int_equal(sizeof enums / sizeof *enums, PENDRES_NAMES_COUNT);
  for (size_t k = 0; k < sizeof enums / sizeof *enums; k++) {
    int count = 0;
    for (; count < MOST_NAMES && enums[k].names[count] != NULL; count++) {
      const int value = enums[k].count > 0 ? count : 1 << count;
      const char *name = pendres_name_get(enums[k].list, value);
      if (name == NULL || strcmp(name, enums[k].names[count]) != 0 || !is_word(name))
        fail_msg("%s %d is called %s, not %s", enums[k].what, count, name != NULL ? name : "NULL",
                 enums[k].names[count]);
      assert_int_equal(pendres_name_find(enums[k].list, name), value);
      for (int i = 0; i < count; i++) assert_string_not_equal(name, enums[k].names[i]);
    }
    if (enums[k].count > 0) assert_int_equal(count, enums[k].count);
    else assert_null(pendres_name_get(enums[k].list, 1 << count));
  }
}

static void nothing_else_has_one(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof enums / sizeof *enums; k++) {
    const int none[] = {-1, INT_MIN, INT_MAX, enums[k].count};
    assert_int_equal(pendres_name_find(enums[k].list, ""), -1);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
      if (pendres_name_get(enums[k].list, none[i]) != NULL)
        fail_msg("%s %d is no value and is called %s", enums[k].what, none[i],
                 pendres_name_get(enums[k].list, none[i]));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(values_have_names),
                                     cmocka_unit_test(nothing_else_has_one)};
  return cmocka_run_group_tests_name("arguments_names", tests, NULL, NULL);
}
