/*
 * table.c -- the keys of all decks: one row a key holds what the reader checks and what
 * --explain, --init and docs/decks.md say.
 *
 * To add a key: a field in struct deck and a row here with IS(kind, meaning), or SAYS(unit,
 * meaning) where it has a unit of its own, or none. To give a scene a key: its bit in .scenes. One
 * name may have several rows if they belong to different scenes; the first of them has the words.
 * EXAMPLE makes --init write the key with that value instead of its default in a comment: needed
 * keys have one. Rows of a group stand together, in the order in which deck_dump writes them.
 * `make decks-reference` renews docs/decks.md.
 *
 * Units: omega0 = sqrt(g/l) is the angular frequency of small oscillations without drive.
 */
#include "deck/table.h"

#include <math.h>
#include <string.h>

#include <pendres/fit.h>
#include <pendres/switching.h>

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
#define HYSTERESIS BIT(HYSTERESIS)
#define DIAGRAM BIT(BIFURCATION_DIAGRAM)
#define MAP BIT(LYAPUNOV_MAP)
#define ESCAPE BIT(ESCAPE)
#define FIT BIT(FIT)

#define ALL ((1u << DECK_KIND_COUNT) - 1u)
#define DRIVEN (CURVE | RESPONSE | ORBIT | BASINS | PHASE | BRANCHES | SWITCHING)
#define MODELS (POINT | CURVE | RESPONSE | ALONG | GRID | FIT) /* torque, forces, ... */
#define POINT (ORBIT | BASINS | SWITCHING)         /* one set of parameters */
#define GRID (PHASE | BRANCHES)                    /* damping and drive frequency are axes */
#define PATH (HYSTERESIS | DIAGRAM)                 /* one of the parameters is an axis */
#define ALONG (PATH | MAP | ESCAPE)                /* two of the parameters are axes, at most */
#define SETTLING (ALONG | CURVE | RESPONSE | ORBIT | BASINS | PHASE | BRANCHES)
#define MEMBERS (CURVE | RESPONSE | PHASE | BRANCHES)
#define RESULTS (FREE | DRIVEN | ALONG | FIT)      /* scenes with one tolerance */

#define FIELD(f) .offset = offsetof(deck, f), .size = sizeof(((deck *)0)->f)
#define REAL(g, n, f) .group = g, .name = n, .type = DECK_REAL, FIELD(f)
#define INTEGER(g, n, f) .group = g, .name = n, .type = DECK_INTEGER, FIELD(f)
#define LOGICAL(g, n, f) .group = g, .name = n, .type = DECK_LOGICAL, FIELD(f)
#define STRING(g, n, f) .group = g, .name = n, .type = DECK_STRING, FIELD(f)
#define CHOICE(g, n, f) .group = g, .name = n, .type = DECK_CHOICE, FIELD(f)
#define CHOICES(g, n, f) .group = g, .name = n, .type = DECK_CHOICES, FIELD(f)
#define BOUNDS(g, n, f) .group = g, .name = n, .type = DECK_BOUNDS, FIELD(f)
/* The first `most` of an array. */
#define NUMBERS(g, n, f, most) .group = g, .name = n, .type = DECK_NUMBERS, \
                               .offset = offsetof(deck, f), .size = (most) * sizeof(double)
#define LIST(g, n, f) .group = g, .name = n, .type = DECK_LIST, FIELD(f)
#define SWEEP(n, a) .group = "sweep", .name = n, .type = DECK_SWEEP, .axis = DECK_AXIS_##a
#define VALUE(n, a) .group = "pendulum", .name = n, .type = DECK_SWEEP_VALUE, .axis = DECK_AXIS_##a
#define SCALE(f) REAL("units", #f, units.f), IN(FREE | DRIVEN | ALONG | FIT), \
                 RANGE(0, BIG), .open = 1, .number = NAN
#define IN(s) .scenes = (s)
#define NEEDED_IN(s) .scenes = (s), .needed = (s)
#define RANGE(l, h) .low = (l), .high = (h)
#define POSITIVE .low = 0.0, .high = BIG, .open = 1
#define NOT_NEGATIVE .low = 0.0, .high = BIG
#define FREQUENCY .low = 1e-100, .high = BIG
#define RATIO .low = -1e6, .high = 1e6
#define UNLESS(a) .when = DECK_UNLESS_AXIS, .axis = DECK_AXIS_##a
#define SAYS(u, words) .unit = u, .meaning = words
#define IS(k, words) .kind = PENDRES_KIND_##k, .meaning = words
#define EXAMPLE(values) .example = values

/* Lengths and times may be of any size (units.c). */
#define BIG 1e100

/* The axis of a parameter that a plain pendulum has not. */
#define SWEEP_OTHER(code, number, name, field, over, positive, kind, words, brief)  \
  { SWEEP(name, code), IN(CURVE | RESPONSE | ALONG | GRID),                         \
    RANGE((positive) ? 0.0 : PENDRES_KIND_##kind == PENDRES_KIND_NUMBER ? -1e6 : -BIG, \
          PENDRES_KIND_##kind == PENDRES_KIND_NUMBER ? 1e6 : BIG), .open = positive, \
    IS(kind, words "; one value may stand in &pendulum instead") },

static const char *const kinds[] = {
#define KIND_NAME(code, name, ...) name,
  DECK_KIND_LIST(KIND_NAME)
#undef KIND_NAME
  NULL
};
/* Names of pendres_method and pendres_table, see <pendres/context.h>. */
static const char *const methods[] = { "block_fixed", "block_adaptive", "single", "cvode_adams",
                                       "cvode_bdf", NULL };
static const char *const tables[] = { "tp8", "tsit5", "vern9", "dp5", NULL };
/* Ways that work_precision compares, peers outside of the library among them. */
static const char *const compared[] = {
  "block_fixed", "block_fixed_tsit5", "block_fixed_vern9", "block_fixed_dp5",
  "block_adaptive", "block_adaptive_tsit5", "block_adaptive_vern9", "block_adaptive_dp5",
  "single", "single_order8", "single_order5", "cvode_adams", "cvode_bdf", "gsl_rk8pd", "naive", NULL
};
static const char *const starts[] = { "", "sa", "la", "1", "2", "3", "4", "5", "6", "7", "8",
                                      NULL };
static const char *const cases[] = {
#define CASE_NAME(name) #name,
  DECK_CASE_LIST(CASE_NAME)
#undef CASE_NAME
  NULL
};
static const char *const shapes[] = { "line", "rectangle", "random", NULL }; /* as in sweep.h */
static const char *const forces[] = { /* as in pendulum.h */
  "pendulum", "polynomial",
#define FORCE_NAME(code, name) #name,
  PENDRES_FORCE_LIST(FORCE_NAME)
#undef FORCE_NAME
  "formula", NULL
};
static const char *const ends[] = { "attractor", "well", NULL }; /* as pendres_basin_end */
static const char *const units[] = { "ensemble", "sweep", NULL };
/* What fits know, see <pendres/fit.h>. */
static const char *const observables[] = {
#define OBSERVABLE_NAME(code, name) name,
  PENDRES_FIT_OBSERVABLE_LIST(OBSERVABLE_NAME)
#undef OBSERVABLE_NAME
  "s_parameter",
  NULL
};
static const char *const line_models[] = { "", "transmission", "notch", "reflection", NULL };
static const char *const formats[] = { "any", "text", "labone", "nanonis", "analyser", "touchstone",
                                       NULL };
static const char *const decimals[] = { "point", "comma", NULL };
#define FOLLOWED "damping", "drive_amplitude", "torque", "parametric_amplitude", "a1", "a2", "a3", \
                 "a4", "a5", "nonlinear_damping", "quadratic_damping", "cubic_damping"
static const char *const swept[] = { "drive_frequency", FOLLOWED, "time", NULL };
static const char *const quantities[] = {
  FOLLOWED,
#define SCALE_NAME(code, name, neutral) name,
  PENDRES_FIT_SCALE_LIST(SCALE_NAME)
#undef SCALE_NAME
  NULL
};
static const char *const directions[] = { "file", "up", "down", NULL };

const deck_key deck_table[] = {
  /* clang-format off */
  { CHOICE("scene", "kind", kind), NEEDED_IN(ALL), .choices = kinds,
    SAYS(NULL, "kind of scene: what is computed") },
  { STRING("scene", "title", title), IN(ALL),
    SAYS(NULL, "title of the file of results and of pictures") },
  { STRING("scene", "output", output), IN(ALL),
    SAYS(NULL, "file of results; without it the deck's name with .h5, in the working directory") },

  { REAL("pendulum", "drive_amplitude", pendulum.drive_amplitude),
    NEEDED_IN(DRIVEN & ~(CURVE | RESPONSE | GRID)), NOT_NEGATIVE, .number = NAN,
    EXAMPLE("0.2"),
    IS(FORCE, "amplitude F0 of the torque that drives the pendulum") },
  { REAL("pendulum", "drive_amplitude", pendulum.drive_amplitude),
    NEEDED_IN(CURVE | RESPONSE | GRID), NOT_NEGATIVE, .number = NAN, EXAMPLE("0.2"),
    UNLESS(DRIVE_AMPLITUDE) },
  { REAL("pendulum", "damping", pendulum.damping), NEEDED_IN(ORBIT), NOT_NEGATIVE,
    .number = NAN, EXAMPLE("0.12"),
    IS(RATE, "friction coefficient gamma; a pendulum's quality factor Q is 1/gamma") },
  { REAL("pendulum", "damping", pendulum.damping), NEEDED_IN(BASINS | SWITCHING), POSITIVE,
    .number = NAN, EXAMPLE("0.12") },
  { REAL("pendulum", "drive_amplitude", pendulum.drive_amplitude), IN(FIT), RANGE(-BIG, BIG),
    .number = NAN },
  { REAL("pendulum", "damping", pendulum.damping), IN(FIT), POSITIVE, .number = NAN },
  { REAL("pendulum", "drive_frequency", pendulum.drive_frequency), IN(FIT), FREQUENCY,
    .number = NAN },
  { VALUE("drive_amplitude", DRIVE_AMPLITUDE), NEEDED_IN(PATH), NOT_NEGATIVE,
    EXAMPLE("0.2") },
  { VALUE("drive_amplitude", DRIVE_AMPLITUDE), NEEDED_IN(MAP | ESCAPE), NOT_NEGATIVE },
  { VALUE("damping", DAMPING), IN(CURVE | RESPONSE | GRID), POSITIVE },
  { VALUE("damping", DAMPING), NEEDED_IN(ALONG), POSITIVE, EXAMPLE("0.12") },
  { REAL("pendulum", "drive_frequency", pendulum.drive_frequency), IN(POINT), FREQUENCY,
    .number = NAN, .when = DECK_BY_FREQUENCY,
    IS(FREQUENCY, "angular frequency of the drive; instead of 'drive_period'") },
  { REAL("pendulum", "drive_period", drive_period), IN(POINT), FREQUENCY,
    .number = NAN, .when = DECK_BY_PERIOD, EXAMPLE("8.0"),
    IS(TIME, "period of the drive, 2 pi / drive_frequency; instead of 'drive_frequency'") },
  { VALUE("drive_frequency", DRIVE_FREQUENCY), IN(RESPONSE | GRID | ALONG), FREQUENCY },
  { VALUE("drive_period", DRIVE_PERIOD), IN(RESPONSE | ALONG), FREQUENCY },
  { REAL("pendulum", "torque", pendulum.torque), IN((MODELS & ~ALONG) | FREE), RANGE(-BIG, BIG),
    UNLESS(TORQUE),
    IS(FORCE,
         "constant torque I on the side of the drive; a Josephson junction's bias current") },
  { REAL("pendulum", "parametric_amplitude", pendulum.parametric_amplitude), IN(MODELS & ~ALONG),
    RATIO, UNLESS(PARAMETRIC_AMPLITUDE),
    IS(NUMBER, "b: the force is multiplied by 1 + b cos(drive_frequency t)") },
  { REAL("pendulum", "nonlinear_damping", pendulum.nonlinear_damping), IN(MODELS & ~ALONG),
    NOT_NEGATIVE, UNLESS(NONLINEAR_DAMPING),
    IS(NONLINEAR_DAMPING, "eta of the friction eta x^2 x', where x has no period") },
  { REAL("pendulum", "quadratic_damping", pendulum.quadratic_damping), IN(MODELS & ~ALONG),
    NOT_NEGATIVE, UNLESS(QUADRATIC_DAMPING),
    IS(QUADRATIC_DAMPING, "c of the friction c x' |x'|, as of air or water") },
  { REAL("pendulum", "cubic_damping", pendulum.cubic_damping), IN(MODELS & ~ALONG),
    NOT_NEGATIVE, UNLESS(CUBIC_DAMPING), IS(CUBIC_DAMPING, "d of the friction d x'^3") },
  { VALUE("torque", TORQUE), IN(ALONG), RANGE(-BIG, BIG) },
  { VALUE("parametric_amplitude", PARAMETRIC_AMPLITUDE), IN(ALONG), RATIO },
  { VALUE("nonlinear_damping", NONLINEAR_DAMPING), IN(ALONG), NOT_NEGATIVE },
  { VALUE("quadratic_damping", QUADRATIC_DAMPING), IN(ALONG), NOT_NEGATIVE },
  { VALUE("cubic_damping", CUBIC_DAMPING), IN(ALONG), NOT_NEGATIVE },
  { CHOICE("pendulum", "force", force), IN(MODELS | FREE), .choices = forces,
    .text = "pendulum",
    SAYS(NULL, "f of x'' + damping x' + f = ...: -cos x, a polynomial of force_coefficients, a "
         "'formula', or another one (docs/models.md)") },
  { STRING("pendulum", "formula", formula), IN(MODELS | FREE), .when = DECK_WITH_FORMULA,
    SAYS(NULL, "f as a text: 'x + a1*x^3', with x, a1 to a5 and pi, + - * / ^, and sin cos tan exp "
         "log tanh sqrt abs sign atan (docs/models.md)") },
  { NUMBERS("pendulum", "force_coefficients", pendulum.force_coefficients, PENDRES_FORCE_POWERS),
    IN(MODELS | FREE), RANGE(-BIG, BIG),
    SAYS(NULL, "a1, a2, ... a5 of the polynomial force f = a1 x + a2 x^2 + ... + a5 x^5; of "
         "'squid' a1; of a formula what it has") },
  { VALUE("temperature", TEMPERATURE), IN(RESPONSE | BASINS | HYSTERESIS), NOT_NEGATIVE,
    IS(TEMPERATURE, "temperature of the noise; the potential is 2 m g l deep; 0: no noise") },
  { VALUE("temperature", TEMPERATURE), IN(SWITCHING), POSITIVE },

  { SWEEP("amplitude", AMPLITUDE), NEEDED_IN(FREE), POSITIVE, EXAMPLE("0.1, 3.1, 31"),
    IS(POSITION, "amplitude, half peak to peak; of a pendulum without a torque below pi") },
  { SWEEP("damping", DAMPING), NEEDED_IN(CURVE | RESPONSE | GRID), POSITIVE,
    EXAMPLE("0.1, 0.4, 4"),
    IS(RATE, "friction coefficient gamma; one value may stand in &pendulum instead") },
  { SWEEP("damping", DAMPING), IN(ALONG), POSITIVE },
  { BOUNDS("sweep", "drive_frequency_range", search), IN(CURVE), FREQUENCY, .number = 0.5,
    .number2 = 1.2, IS(FREQUENCY, "lowest and highest drive frequency where the resonance is "
                         "looked for") },
  { BOUNDS("sweep", "resonance_range", search), IN(RESPONSE), FREQUENCY, .number = 0.5,
    .number2 = 1.2, .when = DECK_WITH_SEARCH,
    IS(FREQUENCY, "lowest and highest drive frequency where the resonance of each line is looked "
         "for; scene 'resonance_curve' has 'drive_frequency_range' for that. With a torque, a "
         "parametric drive or another force none is looked for without this key") },
  { SWEEP("drive_frequency", DRIVE_FREQUENCY), IN(RESPONSE), FREQUENCY,
    IS(FREQUENCY, "angular frequency of the drive; instead of 'drive_period' where both are "
         "possible") },
  { SWEEP("drive_frequency", DRIVE_FREQUENCY), NEEDED_IN(GRID), FREQUENCY,
    EXAMPLE("0.7, 0.9, 21") },
  { SWEEP("drive_frequency", DRIVE_FREQUENCY), IN(ALONG), FREQUENCY, EXAMPLE("0.7, 0.9, 21") },
  { SWEEP("drive_period", DRIVE_PERIOD), IN(ALONG), FREQUENCY },
  { SWEEP("drive_period", DRIVE_PERIOD), IN(RESPONSE), FREQUENCY, EXAMPLE("5.0, 12.0, 29"),
    IS(TIME, "period of the drive; instead of 'drive_frequency'") },
  { SWEEP("drive_amplitude", DRIVE_AMPLITUDE), IN(PATH), NOT_NEGATIVE,
    IS(FORCE, "amplitude F0 of the drive; where results have two axes it is one of them "
         "instead of the value in &pendulum, and the damping or the drive has one value") },
  { SWEEP("drive_amplitude", DRIVE_AMPLITUDE), IN(MAP | ESCAPE), NOT_NEGATIVE,
    EXAMPLE("0.5, 1.5, 21") },
  { SWEEP("drive_amplitude", DRIVE_AMPLITUDE), IN(CURVE | RESPONSE | GRID), POSITIVE },
  PENDRES_PARAMETERS_OTHER(SWEEP_OTHER)
  { SWEEP("x", X), NEEDED_IN(BASINS), RANGE(-BIG, BIG),
    EXAMPLE("-1.5707963267948966, 4.71238898038469, 64"),
    IS(POSITION, "initial position of the particle; the pendulum's angle is x - pi/2") },
  { SWEEP("v", V), NEEDED_IN(BASINS), RANGE(-BIG, BIG), EXAMPLE("-2.5, 2.5, 64"),
    IS(VELOCITY, "initial velocity") },
  { SWEEP("temperature", TEMPERATURE), IN(RESPONSE | BASINS | HYSTERESIS), NOT_NEGATIVE },
  { SWEEP("temperature", TEMPERATURE), NEEDED_IN(SWITCHING), POSITIVE,
    EXAMPLE("0.0125, 0.02, 3") },
  { INTEGER("sweep", "resolution", resolution), IN(ALL & ~(HARD | WORK)), RANGE(1, DECK_MAX_COUNT),
    .number = 1,
    SAYS(NULL, "parts into which each step of the ranges of axes is divided: one key for a finer "
         "grid over all of them") },
  { SWEEP("tolerance", TOLERANCE), NEEDED_IN(WORK), RANGE(1e-14, 1e-2),
    EXAMPLE("1e-4, 1e-6, 1e-8"), IS(NUMBER, "tolerances that each method is asked for") },
  { CHOICES("sweep", "method", methods), NEEDED_IN(WORK), .choices = compared,
    EXAMPLE("'block_fixed', 'block_adaptive'"),
    SAYS(NULL, "methods compared; a Butcher table may follow a method of blocks; 'single_...' is "
         "one ARKODE problem a pendulum, 'naive' ARKODE with all but its tolerance as it comes") },
  { CHOICE("sweep", "unit", unit), IN(WORK), .choices = units, .text = "ensemble",
    SAYS(NULL, "pendulums compared on: 200 starts of one, or 1000 different ones") },
  { CHOICES("sweep", "case", cases), IN(HARD), .choices = cases, EXAMPLE("'separatrix'"),
    SAYS(NULL, "cases to run; without it all") },

  { STRING("outer", "key", outer.key), IN(DRIVEN | ALONG | FREE), .when = DECK_WITH_OUTER,
    SAYS(NULL, "a number for each value of which all of the scene is computed, so that its results "
         "have one more axis: a parameter of &pendulum, a1 to a5, or GROUP.KEY (docs/axes.md)") },
  { .group = "outer", .name = "values", .type = DECK_SWEEP, .axis = DECK_AXIS_OUTER,
    IN(DRIVEN | ALONG | FREE), RANGE(-BIG, BIG), .when = DECK_WITH_OUTER,
    SAYS("unit of 'key'", "its values, within the range of that key") },

  { INTEGER("ensemble", "members", ensemble.members), IN(MEMBERS), RANGE(1, DECK_MAX_COUNT),
    .number = 200, SAYS(NULL, "pendulums with different starts at each set of parameters; "
    "for 'branches', which are followed from what these find, a few are enough") },
  { CHOICE("ensemble", "shape", ensemble.shape), IN(MEMBERS), .choices = shapes, .text = "line",
    SAYS(NULL, "how the starts lie: on a line of one velocity, on a grid that fills a rectangle of "
         "x and v, or at random in such a rectangle; of the latter two, errors of shares and means "
         "contain the sampling") },
  { REAL("ensemble", "x_first", ensemble.x_first), IN(MEMBERS), RANGE(-BIG, BIG),
    .number = -PENDRES_PI / 2,
    IS(POSITION, "initial positions lie above this one, which a line leaves out; the default is "
         "that of angles: under other forces starts lie up to twice as far from rest as the drive "
         "can carry them") },
  { REAL("ensemble", "x_last", ensemble.x_last), IN(MEMBERS), RANGE(-BIG, BIG),
    .number = 3 * PENDRES_PI / 2,
    IS(POSITION, "initial positions go up to this one, equally spaced") },
  { REAL("ensemble", "v", ensemble.v), IN(MEMBERS), RANGE(-BIG, BIG), .number = 0,
    IS(VELOCITY, "initial velocity, of a rectangle the lowest") },
  { REAL("ensemble", "v_last", ensemble.v_last), IN(MEMBERS), RANGE(-BIG, BIG), .number = 0,
    .when = DECK_OFF_LINE, IS(VELOCITY, "highest initial velocity") },
  { INTEGER("ensemble", "rows", ensemble.rows), IN(MEMBERS), RANGE(1, DECK_MAX_COUNT),
    .number = 10, .when = DECK_IN_RECTANGLE,
    SAYS(NULL, "velocities of the grid, a divisor of 'members'") },
  { INTEGER("ensemble", "seed", ensemble.seed), IN(MEMBERS), RANGE(0, 0x1p63), .number = 1,
    .when = DECK_AT_RANDOM, SAYS(NULL, "seed of the random starts") },

  { CHOICE("orbit", "start", orbit.start), IN(ORBIT), .choices = starts, EXAMPLE("'sa'"),
    SAYS(NULL, "attractor recorded: SA, LA, or its number in the order of amplitude; without it "
         "the one reached from 'x', 'v'") },
  { REAL("orbit", "x", orbit.x), IN(ORBIT), RANGE(-BIG, BIG), .number = NAN,
    .when = DECK_WITHOUT_START, IS(POSITION, "initial position, at the drive's maximum") },
  { REAL("orbit", "v", orbit.v), IN(ORBIT), RANGE(-BIG, BIG), .number = 0,
    .when = DECK_WITHOUT_START, IS(VELOCITY, "initial velocity") },
  { INTEGER("orbit", "periods", orbit.periods), IN(ORBIT), RANGE(1, DECK_MAX_COUNT),
    .number = 4, SAYS(NULL, "drive periods recorded") },
  { INTEGER("orbit", "samples", orbit.samples), IN(ORBIT), RANGE(1, 65536), .number = 256,
    SAYS(NULL, "samples a drive period") },
  { LOGICAL("orbit", "transient", orbit.transient), IN(ORBIT), .number = 0,
    SAYS(NULL, "record from the start on instead of after settling") },
  { LOGICAL("orbit", "dimension", orbit.dimension), IN(ORBIT), .number = 0,
    SAYS(NULL, "measure the correlation and Lyapunov dimension of the record's strobe points") },
  { LOGICAL("orbit", "spectrum", orbit.spectrum), IN(ORBIT), .number = 0,
    SAYS(NULL, "measure the power spectrum of the record's velocity") },
  { INTEGER("orbit", "segment", orbit.segment), IN(ORBIT), RANGE(0, DECK_MAX_COUNT), .number = 0,
    SAYS(NULL,
         "drive periods of a segment of the spectrum, which make its resolution; 0: a power of "
         "two, at most a sixteenth of the record") },

  { CHOICE("hysteresis", "start", orbit.start), IN(HYSTERESIS), .choices = starts,
    EXAMPLE("'sa'"),
    SAYS(NULL, "attractor at the first value that the pendulum is on: SA, LA, or its number in the "
         "order of amplitude; without it the one reached from 'x', 'v'") },
  { REAL("hysteresis", "x", orbit.x), IN(HYSTERESIS), RANGE(-BIG, BIG), .number = NAN,
    .when = DECK_WITHOUT_START, IS(POSITION, "initial position, at the drive's maximum") },
  { REAL("hysteresis", "v", orbit.v), IN(HYSTERESIS), RANGE(-BIG, BIG), .number = 0,
    .when = DECK_WITHOUT_START, IS(VELOCITY, "initial velocity") },

  { CHOICE("escape", "from", orbit.start), IN(ESCAPE), .choices = starts, EXAMPLE("'sa'"),
    SAYS(NULL, "state that is left: SA, LA, or its number in the order of amplitude; without it "
         "the one reached from 'x', 'v'") },
  { REAL("escape", "x", orbit.x), IN(ESCAPE), RANGE(-BIG, BIG), .number = NAN,
    .when = DECK_WITHOUT_START, IS(POSITION, "position from which the state is reached") },
  { REAL("escape", "v", orbit.v), IN(ESCAPE), RANGE(-BIG, BIG), .number = 0,
    .when = DECK_WITHOUT_START, IS(VELOCITY, "velocity there") },

  { REAL("hysteresis", "rate", ramp.rate), IN(HYSTERESIS), POSITIVE, .number = NAN,
    IS(SWEPT,
         "what the swept parameter moves by in a drive period: beside the sweep without end it "
         "is also moved in real time, up and then down") },
  { LIST("hysteresis", "protocol", ramp.protocol), IN(HYSTERESIS), RANGE(-BIG, 0x1p31),
    IS(SWEPT, "instead of 'rate': time, value, time, value, ... of the way up, straight lines "
         "between; times are whole drive periods from 0 on, values go from the first of the sweep "
         "to its last. The way down is the same backwards") },
  { INTEGER("hysteresis", "points", ramp.points), IN(HYSTERESIS), RANGE(1, DECK_MAX_COUNT),
    .number = 1000, .when = DECK_WITH_RAMP,
    SAYS(NULL, "points recorded each way, at most") },

  { CHOICE("bifurcation_diagram", "start", orbit.start), IN(DIAGRAM), .choices = starts,
    EXAMPLE("'1'") },
  { REAL("bifurcation_diagram", "x", orbit.x), IN(DIAGRAM), RANGE(-BIG, BIG), .number = NAN,
    .when = DECK_WITHOUT_START },
  { REAL("bifurcation_diagram", "v", orbit.v), IN(DIAGRAM), RANGE(-BIG, BIG), .number = 0,
    .when = DECK_WITHOUT_START },
  { INTEGER("bifurcation_diagram", "strobes", diagram.strobes), IN(DIAGRAM),
    RANGE(1, DECK_MAX_COUNT), .number = 200, SAYS(NULL, "strobe points at each value") },
  { LOGICAL("bifurcation_diagram", "attractors", diagram.attractors), IN(DIAGRAM), .number = 1,
    SAYS(NULL, "count the attractors that are found at each value, a lower bound") },
  { LOGICAL("bifurcation_diagram", "bifurcations", diagram.bifurcations), IN(DIAGRAM), .number = 1,
    SAYS(NULL, "write the bifurcations on the way, and find the cascade of doublings; without "
               "them states are found at the values alone, in less time") },
  { LOGICAL("bifurcation_diagram", "exponents", diagram.exponents), IN(DIAGRAM), .number = 1,
    SAYS(NULL, "write Lyapunov exponents; without them chaos is only told, in less time") },

  { REAL("lyapunov_map", "x", orbit.x), IN(MAP), RANGE(-BIG, BIG), .number = PENDRES_PI / 2,
    IS(POSITION, "initial position of each pendulum, at the drive's maximum") },
  { REAL("lyapunov_map", "v", orbit.v), IN(MAP), RANGE(-BIG, BIG), .number = 0,
    IS(VELOCITY, "initial velocity") },
  { INTEGER("lyapunov_map", "transient", lyapunov.transient), IN(MAP), RANGE(0, 1e9), .number = 0,
    SAYS(NULL, "drive periods before averages are taken; 0: 200, or more where damping is weak") },
  { INTEGER("lyapunov_map", "periods", lyapunov.periods), IN(MAP), RANGE(0, 1e9), .number = 0,
    SAYS(NULL, "drive periods of an average; 0: 512. What is not decided then is followed for "
         "longer") },

#include "deck/table_fit.h"

  { LOGICAL("basins", "refine", basins.refine), IN(BASINS), .number = 0,
    SAYS(NULL, "integrate only starts near a boundary of basins, fill the others in, and check a "
         "random sample of these") },
  { LOGICAL("basins", "boundary", basins.boundary), IN(BASINS), .number = 0,
    SAYS(NULL, "compute the boundary of the basins as a curve") },
  { LOGICAL("basins", "statistics", basins.statistics), IN(BASINS), .number = 1,
    SAYS(NULL, "estimate shares, entropy and uncertainty exponent of the basins") },
  { CHOICE("basins", "by", basins.by), IN(BASINS), .choices = ends, .text = "attractor",
    SAYS(NULL, "what statistics and picture tell apart: attractors, or their wells, too") },
  { INTEGER("basins", "strobes", basins.strobes), IN(BASINS), RANGE(1, DECK_MAX_COUNT),
    .number = 1000, .when = DECK_WITH_NOISE, SAYS(NULL, "strobe points recorded of each cloud") },
  { INTEGER("basins", "seed", noise.seed), IN(BASINS), RANGE(0, 0x1p63), .number = 1,
    .when = DECK_WITH_NOISE, SAYS(NULL, "seed of the random numbers") },
  { INTEGER("basins", "trajectories", basins.trajectories), IN(BASINS),
    RANGE(2, DECK_MAX_COUNT), .number = 192, .when = DECK_WITH_NOISE,
    SAYS(NULL, "independent noisy trajectories of each cloud") },

  { INTEGER("switching", "from", switching.from), IN(SWITCHING),
    RANGE(0, PENDRES_SWITCHING_STATES), .number = 0,
    SAYS(NULL, "number of one state, in the order of amplitude from 1 on; 0: SA and LA. Without "
         "'to': only how often it is left for another well, or for infinity where the force leads "
         "there") },
  { INTEGER("switching", "to", switching.to), IN(SWITCHING),
    RANGE(0, PENDRES_SWITCHING_STATES), .number = 0,
    SAYS(NULL, "number of the other state; with 'from'") },

  { INTEGER("noise", "seed", noise.seed), IN(RESPONSE | SWITCHING | HYSTERESIS), RANGE(0, 0x1p63),
    .number = 1, .when = DECK_WITH_NOISE, SAYS(NULL, "seed of the random numbers") },
  { INTEGER("noise", "trajectories", noise.trajectories), IN(RESPONSE | SWITCHING),
    RANGE(1, DECK_MAX_COUNT), .number = 1920, .when = DECK_WITH_NOISE,
    SAYS(NULL, "independent noisy trajectories at each temperature") },
  { INTEGER("noise", "trajectories", noise.trajectories), IN(HYSTERESIS),
    RANGE(1, DECK_MAX_COUNT), .number = 384, .when = DECK_WITH_NOISE },
  { INTEGER("noise", "periods", noise.periods), IN(RESPONSE | SWITCHING), RANGE(1, 1e9),
    .number = 1000, .when = DECK_WITH_NOISE,
    SAYS(NULL, "drive periods over which each trajectory is followed") },

  { SCALE(natural_frequency),
    SAYS("Hz",
         "frequency of small free oscillations, omega0 / (2 pi), which makes the unit of time; of "
         "a junction its plasma frequency. Results then have units of SI, too (docs/units.md)") },
  { SCALE(mass),
    SAYS("kg", "mass of the oscillator, or of a pendulum; with coefficients of the force in SI, "
         "such as '50 N/m', it tells the natural frequency") },
  { SCALE(length),
    SAYS("m", "displacement that is 1 in ours, which else follows from two coefficients in SI; of "
         "a pendulum the distance from the axis to the centre of mass") },
  { SCALE(gravity), SAYS("m s-2", "acceleration at a pendulum; without it 9.80665") },
  { SCALE(volts_per_length),
    SAYS("V m-1", "signal of a displacement, in which displacements then are told") },
  { SCALE(critical_current), SAYS("A", "critical current of a Josephson junction, the unit of "
                                  "'torque' and 'drive_amplitude'; velocities are voltages") },
  { SCALE(resistance), SAYS("ohm", "of the junction: it makes the damping") },
  { SCALE(capacitance),
    SAYS("F", "of the junction: with the critical current it makes the plasma frequency") },

  { REAL("precision", "tolerance", precision.tolerance), IN(RESULTS), POSITIVE, .number = 1e-8,
    .kind = PENDRES_KIND_POSITION,
    SAYS("1", "wanted error of the results: absolute, of lengths as x is and of what follows from "
         "them; 1e-13 to 1e-2 of the pendulum's unit of length, which is 1 but for polynomials "
         "(docs/models.md). Without it 1e-8 of that unit") },
  { CHOICE("precision", "method", precision.method), IN(RESULTS), .choices = methods,
    .text = "block_fixed",
    SAYS(NULL, "way to integrate; orbits and their measures are by 'block_fixed' throughout") },
  { CHOICE("precision", "table", precision.table), IN(RESULTS), .choices = tables, .text = "tp8",
    SAYS(NULL, "Butcher table of the Runge-Kutta methods") },
  { INTEGER("precision", "steps_per_period", precision.steps_per_period), IN(RESULTS),
    RANGE(0, DECK_MAX_COUNT), .number = 0,
    SAYS(NULL, "steps a drive period; 0: as many as the tolerance needs") },
  { INTEGER("precision", "block_lanes", precision.block_lanes), IN(RESULTS | WORK),
    RANGE(0, 4096), .number = 0,
    SAYS(NULL, "pendulums integrated side by side, a multiple of 8; 0: as many as are fast; "
         "results do not depend on it") },
  { INTEGER("precision", "period_budget", precision.period_budget), IN(SETTLING),
    RANGE(0, 1e9), .number = 0, SAYS(NULL, "drive periods after which a pendulum that has not "
         "settled is called unresolved; 0: from damping and tolerance") },
  { REAL("precision", "unresolved_share", precision.unresolved_share), IN(SETTLING),
    RANGE(0, 1), .number = 0.0, IS(NUMBER, "share of the points, or of the states of a grid, that "
         "may stay unresolved before the program ends with 3; they are marked all the same") },
  { REAL("precision", "exponent_error", precision.exponent_error), IN(DIAGRAM),
    RANGE(1e-6, 1), .number = 0.01,
    IS(NUMBER, "wanted standard error of the exponents of chaos, as "
         "a part of them; the longest averages have what error they have") },
  /* clang-format on */
};

const size_t deck_table_size = sizeof deck_table / sizeof *deck_table;

_Static_assert(sizeof deck_table / sizeof *deck_table <= DECK_MAX_KEYS, "raise DECK_MAX_KEYS");
