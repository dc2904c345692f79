/*
 * deck_table.c -- the keys of all decks, a line or two each.
 *
 * To add a key: a field in struct deck and a row here. To give a scene a key: its bit in .scenes.
 * One name may have several rows if they belong to different scenes. Rows of a group stand
 * together, in the order in which deck_dump writes them.
 */
#include "deck/deck_table.h"

#include <math.h>
#include <string.h>

#include <pendres/switching.h>

#include "validation/hard_cases.h"

#define BIT(kind) (1u << DECK_##kind)
#define FREE BIT(FREE_OSCILLATION)
#define CURVE BIT(RESONANCE_CURVE)
#define RESPONSE BIT(RESPONSE)
#define ORBIT BIT(ORBIT)
#define BASINS BIT(BASINS)
#define PHASE BIT(PHASE_DIAGRAM)
#define BRANCHES BIT(BRANCHES)
#define WORK BIT(WORK_PRECISION)
#define HARD BIT(HARD_CASES)
#define SWITCHING BIT(SWITCHING)

#define ALL ((1u << DECK_KIND_COUNT) - 1u)
#define DRIVEN (CURVE | RESPONSE | ORBIT | BASINS | PHASE | BRANCHES | SWITCHING)
#define POINT (ORBIT | BASINS | SWITCHING)         /* one set of parameters */
#define GRID (PHASE | BRANCHES)                    /* damping and drive frequency are axes */
#define SETTLING (CURVE | RESPONSE | ORBIT | BASINS | PHASE | BRANCHES)
#define MEMBERS (CURVE | RESPONSE | PHASE | BRANCHES)
#define RESULTS (FREE | DRIVEN)                    /* scenes with one tolerance */

#define FIELD(f) .offset = offsetof(deck, f), .size = sizeof(((deck *)0)->f)
#define REAL(g, n, f) .group = g, .name = n, .type = DECK_REAL, FIELD(f)
#define INTEGER(g, n, f) .group = g, .name = n, .type = DECK_INTEGER, FIELD(f)
#define LOGICAL(g, n, f) .group = g, .name = n, .type = DECK_LOGICAL, FIELD(f)
#define STRING(g, n, f) .group = g, .name = n, .type = DECK_STRING, FIELD(f)
#define CHOICE(g, n, f) .group = g, .name = n, .type = DECK_CHOICE, FIELD(f)
#define CHOICES(g, n, f) .group = g, .name = n, .type = DECK_CHOICES, FIELD(f)
#define BOUNDS(g, n, f) .group = g, .name = n, .type = DECK_BOUNDS, FIELD(f)
#define SWEEP(n, a) .group = "sweep", .name = n, .type = DECK_SWEEP, .axis = DECK_AXIS_##a
#define VALUE(n, a) .group = "pendulum", .name = n, .type = DECK_SWEEP_VALUE, .axis = DECK_AXIS_##a
#define IN(s) .scenes = (s)
#define NEEDED_IN(s) .scenes = (s), .needed = (s)
#define RANGE(l, h) .low = (l), .high = (h)
#define POSITIVE .low = 0.0, .high = BIG, .open = 1
#define NOT_NEGATIVE .low = 0.0, .high = BIG
#define FREQUENCY .low = 1e-6, .high = 1e6

#define BIG 1e6
#define PI 3.14159265358979323846

static const char *const kinds[] = {
#define KIND_NAME(code, name) name,
  DECK_KIND_LIST(KIND_NAME)
#undef KIND_NAME
  NULL
};
/* Names of pendres_method and pendres_table, see <pendres/context.h>. */
static const char *const methods[] = { "block_fixed", "block_adaptive", "single", "cvode_adams",
                                       "cvode_bdf", NULL };
static const char *const tables[] = { "tp8", "ev8", "vern8", "dop853", "tsit5", "vern9", "sh9",
                                      "dp5", NULL };
/* Ways that work_precision compares, peers outside of the library among them. */
static const char *const compared[] = {
  "block_fixed", "block_fixed_ev8", "block_fixed_vern8", "block_fixed_dop853", "block_fixed_tsit5",
  "block_fixed_vern9", "block_fixed_sh9", "block_fixed_dp5",
  "block_adaptive", "block_adaptive_ev8", "block_adaptive_vern8", "block_adaptive_dop853",
  "block_adaptive_tsit5", "block_adaptive_vern9", "block_adaptive_sh9", "block_adaptive_dp5",
  "single", "single_order8", "single_order5", "cvode_adams", "cvode_bdf", "gsl_rk8pd", "naive", NULL
};
static const char *const starts[] = { "", "sa", "la", "1", "2", "3", "4", "5", "6", "7", "8", NULL };
static const char *const cases[] = {
#define CASE_NAME(name) #name,
  HARD_CASE_LIST(CASE_NAME)
#undef CASE_NAME
  NULL
};
static const char *const units[] = { "ensemble", "sweep", NULL };

const deck_key deck_table[] = {
  /* clang-format off */
  { CHOICE("scene", "kind", kind), NEEDED_IN(ALL), .choices = kinds },
  { STRING("scene", "title", title), IN(ALL) },
  { STRING("scene", "output", output), IN(ALL) },

  { REAL("pendulum", "drive_amplitude", pendulum.drive_amplitude), NEEDED_IN(DRIVEN & ~BRANCHES), NOT_NEGATIVE, .number = NAN },
  { REAL("pendulum", "drive_amplitude", pendulum.drive_amplitude), NEEDED_IN(BRANCHES), POSITIVE, .number = NAN },
  { REAL("pendulum", "damping", pendulum.damping), NEEDED_IN(ORBIT), NOT_NEGATIVE, .number = NAN },
  { REAL("pendulum", "damping", pendulum.damping), NEEDED_IN(BASINS | SWITCHING), POSITIVE, .number = NAN },
  { VALUE("damping", DAMPING), IN(CURVE | RESPONSE | GRID), POSITIVE },
  { REAL("pendulum", "drive_frequency", pendulum.drive_frequency), IN(POINT), FREQUENCY, .number = NAN, .when = DECK_BY_FREQUENCY },
  { REAL("pendulum", "drive_period", pendulum.drive_period), IN(POINT), FREQUENCY, .number = NAN, .when = DECK_BY_PERIOD },
  { VALUE("drive_frequency", DRIVE_FREQUENCY), IN(RESPONSE | GRID), FREQUENCY },
  { VALUE("drive_period", DRIVE_PERIOD), IN(RESPONSE), FREQUENCY },
  { VALUE("temperature", TEMPERATURE), IN(RESPONSE | BASINS), NOT_NEGATIVE },
  { VALUE("temperature", TEMPERATURE), IN(SWITCHING), POSITIVE },

  { SWEEP("amplitude", AMPLITUDE), NEEDED_IN(FREE), RANGE(0.0, PI), .open = 1 },
  { SWEEP("damping", DAMPING), NEEDED_IN(CURVE | RESPONSE | GRID), POSITIVE },
  { BOUNDS("sweep", "drive_frequency_range", search), IN(CURVE), FREQUENCY, .number = 0.5, .number2 = 1.2 },
  { SWEEP("drive_frequency", DRIVE_FREQUENCY), IN(RESPONSE | GRID), .needed = GRID, FREQUENCY },
  { SWEEP("drive_period", DRIVE_PERIOD), IN(RESPONSE), FREQUENCY },
  { SWEEP("drive_amplitude", DRIVE_AMPLITUDE), IN(0), NOT_NEGATIVE },
  { SWEEP("x", X), NEEDED_IN(BASINS), RANGE(-BIG, BIG) },
  { SWEEP("v", V), NEEDED_IN(BASINS), RANGE(-BIG, BIG) },
  { SWEEP("temperature", TEMPERATURE), IN(RESPONSE | BASINS), NOT_NEGATIVE },
  { SWEEP("temperature", TEMPERATURE), NEEDED_IN(SWITCHING), POSITIVE },
  { SWEEP("tolerance", TOLERANCE), NEEDED_IN(WORK), RANGE(1e-14, 1e-2) },
  { CHOICES("sweep", "method", methods), NEEDED_IN(WORK), .choices = compared },
  { CHOICE("sweep", "unit", unit), IN(WORK), .choices = units, .text = "ensemble" },
  { CHOICES("sweep", "case", cases), IN(HARD), .choices = cases },

  { INTEGER("ensemble", "members", ensemble.members), IN(MEMBERS), RANGE(1, DECK_MAX_COUNT), .number = 200 },
  { REAL("ensemble", "x_first", ensemble.x_first), IN(MEMBERS), RANGE(-BIG, BIG), .number = -PI / 2 },
  { REAL("ensemble", "x_last", ensemble.x_last), IN(MEMBERS), RANGE(-BIG, BIG), .number = 3 * PI / 2 },
  { REAL("ensemble", "v", ensemble.v), IN(MEMBERS), RANGE(-BIG, BIG), .number = 0 },

  { CHOICE("orbit", "start", orbit.start), IN(ORBIT), .choices = starts },
  { REAL("orbit", "x", orbit.x), IN(ORBIT), RANGE(-BIG, BIG), .number = NAN, .when = DECK_WITHOUT_START },
  { REAL("orbit", "v", orbit.v), IN(ORBIT), RANGE(-BIG, BIG), .number = 0, .when = DECK_WITHOUT_START },
  { INTEGER("orbit", "periods", orbit.periods), IN(ORBIT), RANGE(1, DECK_MAX_COUNT), .number = 4 },
  { INTEGER("orbit", "samples", orbit.samples), IN(ORBIT), RANGE(1, 65536), .number = 256 },
  { LOGICAL("orbit", "transient", orbit.transient), IN(ORBIT), .number = 0 },

  { LOGICAL("basins", "refine", basins.refine), IN(BASINS), .number = 0 },
  { LOGICAL("basins", "boundary", basins.boundary), IN(BASINS), .number = 0 },
  { LOGICAL("basins", "statistics", basins.statistics), IN(BASINS), .number = 1 },
  { INTEGER("basins", "strobes", basins.strobes), IN(BASINS), RANGE(1, DECK_MAX_COUNT), .number = 1000, .when = DECK_WITH_NOISE },
  { INTEGER("basins", "seed", basins.seed), IN(BASINS), RANGE(0, 0x1p63), .number = 1, .when = DECK_WITH_NOISE },
  { INTEGER("basins", "trajectories", basins.trajectories), IN(BASINS), RANGE(2, DECK_MAX_COUNT), .number = 192, .when = DECK_WITH_NOISE },

  { INTEGER("switching", "from", switching.from), IN(SWITCHING), RANGE(0, PENDRES_SWITCHING_STATES), .number = 0 },
  { INTEGER("switching", "to", switching.to), IN(SWITCHING), RANGE(0, PENDRES_SWITCHING_STATES), .number = 0 },

  { INTEGER("noise", "seed", noise.seed), IN(RESPONSE | SWITCHING), RANGE(0, 0x1p63), .number = 1, .when = DECK_WITH_NOISE },
  { INTEGER("noise", "trajectories", noise.trajectories), IN(RESPONSE | SWITCHING), RANGE(1, DECK_MAX_COUNT), .number = 1920, .when = DECK_WITH_NOISE },
  { INTEGER("noise", "periods", noise.periods), IN(RESPONSE | SWITCHING), RANGE(1, 1e9), .number = 1000, .when = DECK_WITH_NOISE },

  { REAL("precision", "tolerance", precision.tolerance), IN(RESULTS), RANGE(1e-13, 1e-2), .why = "less is beyond double precision", .number = 1e-8 },
  { CHOICE("precision", "method", precision.method), IN(RESULTS), .choices = methods, .text = "block_fixed" },
  { CHOICE("precision", "table", precision.table), IN(RESULTS), .choices = tables, .text = "tp8" },
  { INTEGER("precision", "steps_per_period", precision.steps_per_period), IN(RESULTS), RANGE(0, DECK_MAX_COUNT), .number = 0 },
  { INTEGER("precision", "block_lanes", precision.block_lanes), IN(RESULTS | WORK), RANGE(0, 4096), .number = 0 },
  { INTEGER("precision", "period_budget", precision.period_budget), IN(SETTLING), RANGE(0, 1e9), .number = 0 },
  /* clang-format on */
};

const size_t deck_table_size = sizeof deck_table / sizeof *deck_table;

_Static_assert(sizeof deck_table / sizeof *deck_table <= DECK_MAX_KEYS, "raise DECK_MAX_KEYS");

/* 1: the key of that name, 2: the range of that axis, 0: neither. */
static int key_matches(const deck_key *key, const char *name)
{
  const size_t n = strlen(key->name);
  if (strncmp(key->name, name, n) != 0) return 0;
  if (name[n] == '\0') return 1;
  /* Tolerances are not spaced evenly by anyone. */
  if (key->type != DECK_SWEEP || key->axis == DECK_AXIS_TOLERANCE) return 0;
  return strcmp(name + n, "_range") == 0 ? 2 : 0;
}

size_t deck_table_find(const char *group, const char *name, unsigned scenes, int *range)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, group) != 0 || (scenes != 0 && (key->scenes & scenes) == 0)) continue;
    const int match = key_matches(key, name);
    if (match == 0) continue;
    *range = match == 2;
    return i;
  }
  return deck_table_size;
}

const char *deck_kind_name(deck_kind kind)
{
  return (unsigned)kind < DECK_KIND_COUNT ? kinds[kind] : NULL;
}

const char *deck_axis_name(deck_axis_id axis)
{
  static const char *const names[] = {
#define AXIS_NAME(code, name) name,
    DECK_AXIS_LIST(AXIS_NAME)
#undef AXIS_NAME
  };
  return (unsigned)axis < DECK_AXIS_COUNT ? names[axis] : NULL;
}
