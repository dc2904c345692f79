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

enum { MOST_NAMES = 16 };

/* NAME(short, call): the name of an int. */
#define NAME(short, call) static const char *short(int value) { return call; }
NAME(basin_end, pendres_basin_end_name((pendres_basin_end)value))
NAME(basin_how, pendres_basin_how_name((pendres_basin_how)value))
NAME(branch_end, pendres_branch_end_name((pendres_branch_end)value))
NAME(cloud_verdict, pendres_cloud_verdict_name((pendres_cloud_verdict)value))
NAME(cloud_way, pendres_cloud_way_name((pendres_cloud_way)value))
NAME(doubt, pendres_doubt_name((pendres_doubt)value))
NAME(ensemble_shape, pendres_ensemble_shape_name((pendres_ensemble_shape)value))
NAME(jump_kind, pendres_jump_kind_name((pendres_jump_kind)value))
NAME(label, pendres_label_name((pendres_label)value))
NAME(langevin_answer, pendres_langevin_answer_name((pendres_langevin_answer)value))
NAME(langevin_statistic, pendres_langevin_statistic_name((pendres_langevin_statistic)value))
NAME(method, pendres_method_name((pendres_method)value))
NAME(other, pendres_other_name((pendres_other)value))
NAME(parameter, pendres_parameter_name((pendres_parameter)value))
NAME(peak, pendres_peak_name((pendres_peak)value))
NAME(regime, pendres_regime_name((pendres_regime)value))
NAME(special, pendres_special_name((pendres_special)value))
NAME(store_type, pendres_store_type_name((pendres_store_type)value))
NAME(switching_verdict, pendres_switching_verdict_name((pendres_switching_verdict)value))
NAME(switching_way, pendres_switching_way_name((pendres_switching_way)value))

static const struct {
  const char *what, *(*name)(int value);
  int count; /* of values; 0: they are bits */
  const char *names[MOST_NAMES];
} enums[] = {
  {"basin_end", basin_end, PENDRES_BASIN_END_COUNT, {"attractor", "well"}},
  {"basin_how", basin_how, PENDRES_BASIN_HOW_COUNT,
   {"integrated", "filled", "deferred", "uncertain"}},
  {"branch_end", branch_end, PENDRES_END_COUNT,
   {"range", "closed", "too_wild", "too_long", "stuck"}},
  {"cloud_verdict", cloud_verdict, PENDRES_CLOUD_VERDICTS,
   {"agrees", "too_hot", "not_compared", "uncertain", "below_rounding"}},
  {"cloud_way", cloud_way, PENDRES_CLOUD_WAY_COUNT, {"none", "still", "narrow", "followed"}},
  {"doubt", doubt, 0,
   {"unlisted_change", "turn_without_fold", "bifurcation_without_its_signs"}},
  {"ensemble_shape", ensemble_shape, PENDRES_ENSEMBLE_SHAPE_COUNT,
   {"line", "rectangle", "random"}},
  {"jump_kind", jump_kind, PENDRES_JUMP_COUNT,
   {"fold", "flip", "symmetry", "other", "branch_point", "crisis", "homoclinic"}},
  {"label", label, PENDRES_LABEL_COUNT,
   {"sa", "la", "periodic", "running", "chaotic", "unresolved", "escape",
    "quasi_periodic"}},
  {"langevin_answer", langevin_answer, PENDRES_LANGEVIN_ANSWER_COUNT, {"go_on", "enough", "stop"}},
  {"langevin_statistic", langevin_statistic, PENDRES_LANGEVIN_STATISTICS,
   {"mean_x", "mean_v", "cov_xx", "cov_xv", "cov_vv", "cosine", "sine", "loop_area"}},
  {"method", method, PENDRES_METHOD_COUNT,
   {"block_fixed", "block_adaptive", "single", "cvode_adams", "cvode_bdf", "naive"}},
  {"other", other, 0, {"asymmetric", "periodic", "running", "chaotic", "unresolved"}},
  {"parameter", parameter, PENDRES_PARAMETER_COUNT,
   {"drive_frequency", "damping", "drive_amplitude", "torque", "parametric_amplitude", "a1", "a2",
    "a3", "a4", "a5", "drive_period", "temperature", "x", "v"}},
  {"peak", peak, PENDRES_PEAK_COUNT, {"smooth", "edge", "ragged"}},
  {"regime", regime, PENDRES_REGIME_COUNT, {"sa", "la", "coexistence", "single", "other"}},
  {"special", special, PENDRES_SPECIAL_COUNT,
   {"regular", "fold", "period_doubling", "symmetry_breaking", "branch_point"}},
  {"store_type", store_type, PENDRES_STORE_TYPE_COUNT,
   {"double", "int8", "int32", "int64", "string"}},
  {"switching_verdict", switching_verdict, PENDRES_SWITCHING_VERDICTS,
   {"straight", "not_straight", "two_points", "too_few_events", "no_state", "no_barrier",
    "unbalanced"}},
  {"switching_way", switching_way, PENDRES_SWITCHING_WAYS,
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
  for (size_t k = 0; k < sizeof enums / sizeof *enums; k++) {
    int count = 0;
    for (; count < MOST_NAMES && enums[k].names[count] != NULL; count++) {
      const char *name = enums[k].name(enums[k].count > 0 ? count : 1 << count);
      if (name == NULL || strcmp(name, enums[k].names[count]) != 0 || !is_word(name))
        fail_msg("%s %d is called %s, not %s", enums[k].what, count, name != NULL ? name : "NULL",
                 enums[k].names[count]);
      for (int i = 0; i < count; i++) assert_string_not_equal(name, enums[k].names[i]);
    }
    if (enums[k].count > 0) assert_int_equal(count, enums[k].count);
    else assert_null(enums[k].name(1 << count));
  }
}

static void nothing_else_has_one(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof enums / sizeof *enums; k++) {
    const int none[] = {-1, INT_MIN, INT_MAX, enums[k].count};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
      if (enums[k].name(none[i]) != NULL)
        fail_msg("%s %d is no value and is called %s", enums[k].what, none[i],
                 enums[k].name(none[i]));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(values_have_names),
                                     cmocka_unit_test(nothing_else_has_one)};
  return cmocka_run_group_tests_name("arguments_names", tests, NULL, NULL);
}
