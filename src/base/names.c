/* names.c -- names of values, and messages of status codes; see pendres/names.h. */
#include <stddef.h>
#include <string.h>

#include <pendres/pendres.h>

enum { MOST_NAMES = 40 };

#define SECOND(code, name) name,
#define SECOND_OF_THREE(code, name, ...) name,
#define NUMBERED(code, number, name, ...) [number] = name,

/* [value]; of bits [which bit]. */
static const struct {
  int bits;
  const char *name[MOST_NAMES];
} lists[PENDRES_NAMES_COUNT] = {
  [PENDRES_NAMES_METHOD] =
    {.name = {"block_fixed", "block_adaptive", "single", "cvode_adams", "cvode_bdf", "naive"}},
  [PENDRES_NAMES_TABLE] =
    {.name = {"default", "tp8", "tsit5", "vern9", "dp5"}},
  [PENDRES_NAMES_PARAMETER] = {.name = {PENDRES_PARAMETER_LIST(NUMBERED)}},
  [PENDRES_NAMES_ENSEMBLE_SHAPE] = {.name = {"line", "rectangle", "random"}},
  [PENDRES_NAMES_LABEL] =
    {.name = {"sa", "la", "periodic", "running", "chaotic", "unresolved", "escape",
              "quasi_periodic", "unstable"}},
  [PENDRES_NAMES_SPECIAL] = {.name = {PENDRES_SPECIAL_LIST(SECOND)}},
  [PENDRES_NAMES_BRANCH_END] = {.name = {"range", "closed", "too_wild", "too_long", "stuck"}},
  [PENDRES_NAMES_DOUBT] =
    {.bits = 1,
     .name = {"unlisted_change", "turn_without_fold", "bifurcation_without_its_signs"}},
  [PENDRES_NAMES_JUMP] = {.name = {PENDRES_JUMP_LIST(SECOND)}},
  [PENDRES_NAMES_PEAK] = {.name = {"smooth", "edge", "ragged"}},
  [PENDRES_NAMES_REGIME] = {.name = {PENDRES_REGIME_LIST(SECOND)}},
  [PENDRES_NAMES_OTHER] =
    {.bits = 1,
     .name = {"asymmetric", "periodic", "running", "chaotic", "unresolved", "escape", "unstable"}},
  [PENDRES_NAMES_BASIN_END] = {.name = {"attractor", "well"}},
  [PENDRES_NAMES_BASIN_HOW] = {.name = {"integrated", "filled", "deferred", "uncertain"}},
  [PENDRES_NAMES_LANGEVIN_ANSWER] = {.name = {"go_on", "enough", "stop"}},
  [PENDRES_NAMES_LANGEVIN_STATISTIC] =
    {.name = {"mean_x", "mean_v", "cov_xx", "cov_xv", "cov_vv", "cosine", "sine", "loop_area"}},
  [PENDRES_NAMES_CLOUD_WAY] = {.name = {"none", "still", "narrow", "followed"}},
  [PENDRES_NAMES_CLOUD_VERDICT] =
    {.name = {"agrees", "too_hot", "not_compared", "uncertain", "below_rounding"}},
  [PENDRES_NAMES_SWITCHING_WAY] = {.name = {"forth", "back", "first_well", "second_well"}},
  [PENDRES_NAMES_SWITCHING_VERDICT] =
    {.name = {"straight", "not_straight", "two_points", "too_few_events", "no_state", "no_barrier",
              "unbalanced"}},
  [PENDRES_NAMES_STORE_TYPE] = {.name = {"double", "int8", "int32", "int64", "string"}},
  [PENDRES_NAMES_STEP_END] = {.name = {PENDRES_STEP_END_LIST(SECOND)}},
  [PENDRES_NAMES_FIT_OBSERVABLE] = {.name = {PENDRES_FIT_OBSERVABLE_LIST(SECOND)}},
  /* The parameters that are followed, by their numbers, and scales. */
  [PENDRES_NAMES_FIT_QUANTITY] =
    {.name = {"drive_frequency", "damping", "drive_amplitude", "torque", "parametric_amplitude",
              "a1", "a2", "a3", "a4", "a5", "nonlinear_damping", "quadratic_damping",
              "cubic_damping", PENDRES_FIT_SCALE_LIST(SECOND_OF_THREE)}},
};

static int value_of(pendres_names list, int place)
{
  return lists[list].bits ? 1 << place : place;
}

const char *pendres_name_get(pendres_names list, int value)
{
  if ((unsigned)list >= PENDRES_NAMES_COUNT) return NULL;
  for (int i = 0; i < MOST_NAMES && lists[list].name[i] != NULL; i++)
    if (value_of(list, i) == value) return lists[list].name[i];
  return NULL;
}

int pendres_name_find(pendres_names list, const char *name)
{
  if ((unsigned)list >= PENDRES_NAMES_COUNT || name == NULL) return -1;
  for (int i = 0; i < MOST_NAMES && lists[list].name[i] != NULL; i++)
    if (strcmp(name, lists[list].name[i]) == 0) return value_of(list, i);
  return -1;
}

const char *pendres_status_message(pendres_status status)
{
  static const char *const message[] = {
#define STATUS_TEXT(name, text) text,
    PENDRES_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
  };
  if ((unsigned)status >= PENDRES_STATUS_COUNT) return "unknown status";
  return message[status];
}
