/*
 * test_deck.c -- what decks mean: defaults and values of every kind of scene, axes, every mistake
 * with its position and words, the dump, and random damage. Values are compared to the bit.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"

/* ---- what tests share ---------------------------------------------------------------------- */

/* Read a deck that must be good. The caller frees it. */
static deck read_good(const char *text)
{
  deck d = { 0 };
  namelist_errors errors = { 0 };
  const pendres_status status = deck_read_memory("input/t.nml", text, strlen(text), &d, &errors);
  if (status != PENDRES_OK) {
    print_error("in \"%s\"\n", text);
    namelist_errors_print(&errors, stderr);
  }
  assert_int_equal(status, PENDRES_OK);
  assert_int_equal(errors.count, 0);
  namelist_errors_free(&errors);
  return d;
}

static char *dump(const deck *d)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  assert_int_equal(deck_dump(d, out), PENDRES_OK);
  fclose(out);
  return text;
}

static void assert_axis_equal(const deck_axis *a, const deck_axis *b)
{
  assert_int_equal(a->count, b->count);
  if (a->count > 0) assert_memory_equal(a->value, b->value, a->count * sizeof *a->value);
}

static void assert_names_equal(const deck_names *a, const deck_names *b)
{
  assert_int_equal(a->count, b->count);
  for (size_t i = 0; i < a->count; i++) assert_string_equal(a->name[i], b->name[i]);
}

/* All that a deck means; memory_equal so that NaN equals NaN. */
static void assert_deck_equal(const deck *a, const deck *b)
{
  assert_int_equal(a->kind, b->kind);
  assert_string_equal(a->title, b->title);
  assert_string_equal(a->output, b->output);
  assert_memory_equal(&a->pendulum.drive_amplitude, &b->pendulum.drive_amplitude, 4 * sizeof(double));
  assert_int_equal(a->pendulum.by_period, b->pendulum.by_period);
  for (int i = 0; i < DECK_AXIS_COUNT; i++) assert_axis_equal(&a->axis[i], &b->axis[i]);
  assert_memory_equal(a->search, b->search, sizeof a->search);
  assert_memory_equal(&a->ensemble, &b->ensemble, sizeof a->ensemble);
  assert_memory_equal(&a->precision.tolerance, &b->precision.tolerance, sizeof(double));
  assert_string_equal(a->precision.method, b->precision.method);
  assert_string_equal(a->precision.table, b->precision.table);
  assert_int_equal(a->precision.steps_per_period, b->precision.steps_per_period);
  assert_int_equal(a->precision.block_lanes, b->precision.block_lanes);
  assert_int_equal(a->precision.period_budget, b->precision.period_budget);
  assert_string_equal(a->orbit.start, b->orbit.start);
  assert_memory_equal(&a->orbit.x, &b->orbit.x, 2 * sizeof(double));
  assert_int_equal(a->orbit.periods, b->orbit.periods);
  assert_int_equal(a->orbit.samples, b->orbit.samples);
  assert_int_equal(a->orbit.transient, b->orbit.transient);
  assert_memory_equal(&a->noise, &b->noise, sizeof a->noise);
  assert_int_equal(a->diagram.strobes, b->diagram.strobes);
  assert_memory_equal(&a->lyapunov, &b->lyapunov, sizeof a->lyapunov);
  assert_int_equal(a->basins.refine, b->basins.refine);
  assert_int_equal(a->basins.boundary, b->basins.boundary);
  assert_int_equal(a->basins.statistics, b->basins.statistics);
  assert_int_equal(a->basins.strobes, b->basins.strobes);
  assert_int_equal(a->basins.seed, b->basins.seed);
  assert_int_equal(a->basins.trajectories, b->basins.trajectories);
  assert_string_equal(a->basins.by, b->basins.by);
  assert_true(a->ramp.rate == b->ramp.rate || (isnan(a->ramp.rate) && isnan(b->ramp.rate)));
  assert_int_equal(a->ramp.points, b->ramp.points);
  assert_int_equal(a->ramp.protocol.count, b->ramp.protocol.count);
  for (size_t i = 0; i < a->ramp.protocol.count; i++)
    assert_true(a->ramp.protocol.number[i] == b->ramp.protocol.number[i]);
  assert_names_equal(&a->methods, &b->methods);
  assert_string_equal(a->unit, b->unit);
  assert_names_equal(&a->cases, &b->cases);
}

/* ---- good decks ---------------------------------------------------------------------------- */

#define ONE "&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 /\n"

static const char *const good[] = {
  "&scene kind='free_oscillation' /\n&sweep amplitude=0.1 amplitude_range=0.5,3.1,60 /\n",
  "&scene kind='resonance_curve', title='Fig. 2' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.165,0.24,0.32 damping_range=0.06,1.0,95 drive_frequency_range=0.5,1.2 /\n"
  "&precision tolerance=1e-8 /\n",
  "&scene kind='resonance_curve' output='a''b.h5' /\n&pendulum drive_amplitude=0.1 damping=0.3 /\n"
  "&ensemble members=64 x_first=-1 x_last=1 v=0.25 /\n"
  "&precision tolerance=1d-10 method='block_adaptive' table='dop853' steps_per_period=40\n"
  " block_lanes=64 period_budget=1000 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.24,0.32 drive_period_range=5,10,101 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 temperature=1e-3 damping=0.5 /\n"
  "&sweep drive_frequency=0.9 /\n&noise seed=9223372036854775807 trajectories=64 periods=10 /\n",
  "&scene kind='orbit' /\n" ONE "&orbit start='LA ' periods=3 samples=512 /\n",
  "&scene kind='orbit' /\n&pendulum drive_amplitude=0 damping=0 drive_frequency=0.7 /\n"
  "&orbit x=0.3 v=-1 transient=.true. /\n",
  "&scene kind='basins' /\n" ONE "&sweep x_range=-1.5,4.7,1024 v=0 /\n",
  "&scene kind='basins' /\n" ONE "&sweep x_range=-1.5,4.7,100000 v_range=-2,2,100000 /\n"
  "&basins refine=T boundary=T statistics=F /\n",
  "&scene kind='basins' /\n" ONE "&sweep x=0,1 v=0 temperature=1e-4,1e-3 /\n"
  "&basins strobes=10 seed=7 trajectories=8 /\n",
  "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping_range=0.06,0.2,200 drive_frequency_range=0.7,0.9,200 /\n",
  "&scene kind='branches' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.13,0.14,0.15 drive_frequency_range=0.7,0.9,200 /\n",
  "&scene kind='work_precision' /\n&sweep method='block_fixed','gsl_rk8pd' tolerance=1e-4,1e-13 unit='sweep' /\n",
  "&scene kind='hard_cases' /",
  "&scene kind='hard_cases' /\n&sweep case='separatrix', 'tolerance' /",
  "&scene kind='switching' /\n" ONE "&sweep temperature_range=1e-3,1e-2,5 /\n",
  "&scene kind='switching' /\n" ONE "&sweep temperature=0.01 /\n&switching from=1, to=3 /\n",
  "&scene kind='orbit' /\n" ONE "&orbit start='2' /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_amplitude=0.2 damping=0.12 /\n"
  "&sweep drive_frequency_range=0.6,0.9,31 /\n&hysteresis start='sa' /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_period=8 damping=0.12 /\n"
  "&sweep drive_amplitude=0.1,0.3 /\n&hysteresis x=1 v=0.5 /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_period=8 damping=0.12 temperature=0.01 /\n"
  "&sweep drive_amplitude=0.1,0.3 /\n"
  "&hysteresis x=1 protocol=0,0.1,50,0.1,2000,0.3 points=7 /\n&noise seed=3 /\n",
  "&scene kind='bifurcation_diagram' /\n&pendulum drive_frequency=0.66 damping=0.5 /\n"
  "&sweep drive_amplitude_range=1.0,1.1,9 /\n&bifurcation_diagram x=1 v=0.1 strobes=50 /\n",
  "&scene kind='lyapunov_map' /\n&pendulum drive_frequency=0.66 /\n"
  "&sweep drive_amplitude_range=0.5,1.5,9 damping=0.2,0.5 /\n"
  "&lyapunov_map x=1 v=0.1 transient=50 periods=64 /\n",
  "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.1 drive_frequency_range=0.7,0.9,200 /\n"
  "&ensemble shape='rectangle' members=64 rows=8 v=-1 v_last=1 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 damping=0.1 /\n"
  "&sweep drive_period=8 /\n"
  "&ensemble shape='random' v=-1 v_last=1 seed=3 /\n",
};

enum { GOOD = sizeof good / sizeof *good };

static void every_kind_is_read(void **state)
{
  unsigned seen = 0;
  (void)state;
  for (size_t i = 0; i < GOOD; i++) {
    deck d = read_good(good[i]);
    seen |= 1u << d.kind;
    assert_string_equal(d.name, "input/t.nml");
    assert_int_equal(d.text_length, strlen(good[i]));
    assert_memory_equal(d.text, good[i], d.text_length);
    deck_free(&d);
    deck_free(&d);
  }
  assert_int_equal(seen, (1u << DECK_KIND_COUNT) - 1u);
}

static void resonance_curve_values(void **state)
{
  deck d = read_good(good[1]);
  const deck_axis *damping = &d.axis[DECK_AXIS_DAMPING];
  (void)state;
  assert_int_equal(d.kind, DECK_RESONANCE_CURVE);
  assert_string_equal(d.title, "Fig. 2");
  assert_string_equal(d.output, "t.h5");
  assert_true(d.pendulum.drive_amplitude == 0.2);
  assert_true(isnan(d.pendulum.damping));
  /* 95 of the range in steps of 0.01, of which 0.24 and 0.32 are listed too; 0.165 is new. */
  assert_int_equal(damping->count, 96);
  assert_true(damping->value[0] == 0.06 && damping->value[95] == 1.0);
  assert_true(damping->value[11] == 0.165 && damping->value[19] == 0.24 && damping->value[27] == 0.32);
  for (size_t i = 1; i < damping->count; i++) assert_true(damping->value[i] > damping->value[i - 1] + 1e-3);
  assert_true(d.search[0] == 0.5 && d.search[1] == 1.2);
  assert_int_equal(d.axis[DECK_AXIS_DRIVE_FREQUENCY].count, 0);
  assert_int_equal(d.ensemble.members, 200);
  assert_true(d.ensemble.x_first == -1.57079632679489661923 && d.ensemble.x_last == 4.71238898038468985769);
  assert_true(d.ensemble.v == 0.0);
  assert_true(d.precision.tolerance == 1e-8);
  assert_string_equal(d.precision.method, "block_fixed");
  assert_string_equal(d.precision.table, "tp8");
  assert_int_equal(d.precision.steps_per_period + d.precision.block_lanes + d.precision.period_budget, 0);
  deck_free(&d);

  d = read_good(good[2]);
  assert_string_equal(d.output, "a'b.h5");
  assert_int_equal(d.axis[DECK_AXIS_DAMPING].count, 1);
  assert_true(d.axis[DECK_AXIS_DAMPING].value[0] == 0.3);
  assert_true(d.search[0] == 0.5 && d.search[1] == 1.2);
  assert_int_equal(d.ensemble.members, 64);
  assert_true(d.ensemble.x_first == -1 && d.ensemble.x_last == 1 && d.ensemble.v == 0.25);
  assert_true(d.precision.tolerance == 1e-10);
  assert_string_equal(d.precision.method, "block_adaptive");
  assert_string_equal(d.precision.table, "dop853");
  assert_int_equal(d.precision.steps_per_period, 40);
  assert_int_equal(d.precision.block_lanes, 64);
  assert_int_equal(d.precision.period_budget, 1000);
  deck_free(&d);
}

static void other_values(void **state)
{
  deck d = read_good(good[5]);
  (void)state;
  assert_string_equal(d.orbit.start, "la");
  assert_int_equal(d.orbit.periods, 3);
  assert_int_equal(d.orbit.samples, 512);
  assert_int_equal(d.orbit.transient, 0);
  assert_true(d.pendulum.drive_period == 8 && d.pendulum.by_period);
  assert_true(d.pendulum.drive_frequency == 6.28318530717958647693 / 8);
  deck_free(&d);

  d = read_good(good[6]);
  assert_string_equal(d.orbit.start, "");
  assert_true(d.orbit.x == 0.3 && d.orbit.v == -1 && d.orbit.transient == 1);
  assert_true(d.pendulum.drive_frequency == 0.7 && !d.pendulum.by_period);
  assert_true(d.pendulum.drive_period == 6.28318530717958647693 / 0.7);
  deck_free(&d);

  d = read_good(good[4]);
  assert_true(deck_has_noise(&d));
  assert_true(d.axis[DECK_AXIS_TEMPERATURE].count == 1 && d.axis[DECK_AXIS_TEMPERATURE].value[0] == 1e-3);
  assert_true(d.noise.seed == INT64_MAX && d.noise.trajectories == 64 && d.noise.periods == 10);
  deck_free(&d);

  d = read_good(good[9]);
  assert_int_equal(d.axis[DECK_AXIS_TEMPERATURE].count, 2);
  assert_true(d.basins.strobes == 10 && d.basins.seed == 7 && d.basins.trajectories == 8);
  deck_free(&d);

  d = read_good(good[12]);
  assert_int_equal(d.methods.count, 2);
  assert_string_equal(d.methods.name[1], "gsl_rk8pd");
  assert_string_equal(d.unit, "sweep");
  assert_int_equal(d.axis[DECK_AXIS_TOLERANCE].count, 2);
  assert_true(d.axis[DECK_AXIS_TOLERANCE].value[0] == 1e-13); /* ascending like every axis */
  deck_free(&d);

  d = read_good(good[14]);
  assert_int_equal(d.cases.count, 2);
  assert_string_equal(d.cases.name[0], "separatrix");
  deck_free(&d);
}

/* Forces: the plain pendulum where nothing is said, coefficients in their order, the rest zero. */
static void forces(void **state)
{
  (void)state;
  deck d = read_good("&scene kind='orbit' / &pendulum drive_amplitude=0.2 damping=0.1 "
                     "drive_frequency=1 / &orbit start='sa' /");
  assert_string_equal(d.pendulum.force, "pendulum");
  assert_true(d.pendulum.torque == 0.0 && d.pendulum.parametric_amplitude == 0.0);
  deck_free(&d);
  d = read_good("&scene kind='orbit' / &pendulum drive_amplitude=0.2 damping=0.1 drive_frequency=1 "
                "torque=-0.5 parametric_amplitude=0.3 force='polynomial' "
                "force_coefficients = 1, , -2.5 / &orbit start='sa' /");
  const double a[] = { 1.0, 0.0, -2.5, 0.0, 0.0 };
  assert_string_equal(d.pendulum.force, "polynomial");
  assert_memory_equal(d.pendulum.force_coefficients, a, sizeof a);
  assert_true(d.pendulum.torque == -0.5 && d.pendulum.parametric_amplitude == 0.3);
  deck_free(&d);
}

static void names_of_kinds_and_axes(void **state)
{
  (void)state;
  assert_string_equal(deck_kind_name(DECK_FREE_OSCILLATION), "free_oscillation");
  assert_string_equal(deck_kind_name(DECK_SWITCHING), "switching");
  assert_null(deck_kind_name(DECK_KIND_COUNT));
  assert_string_equal(deck_axis_name(DECK_AXIS_X), "x");
  assert_string_equal(deck_axis_name(DECK_AXIS_TOLERANCE), "tolerance");
  assert_null(deck_axis_name(DECK_AXIS_COUNT));
}

/* Lists and ranges of x of a basin, and the values that come out. */
static void axes(void **state)
{
  static const struct { const char *sweep; size_t count; double value[6]; } cases[] = {
    { "x=3,1,2", 3, { 1, 2, 3 } },
    { "x=1,1,1", 1, { 1 } },
    { "x=-0.0,0", 1, { 0 } },
    { "x(2)=1 x(1)=2", 2, { 1, 2 } },
    { "x=3*1, 2,", 2, { 1, 2 } },
    { "x_range=0,1,5", 5, { 0, 0.25, 0.5, 0.75, 1 } },
    { "x_range=0.1,0.7,2", 2, { 0.1, 0.7 } },
    { "x_range=2,2,1", 1, { 2 } },
    { "x=0.5,3 x_range=0,1,3", 4, { 0, 0.5, 1, 3 } },
    { "x=-1,0.6 x_range=0,1,3", 5, { -1, 0, 0.5, 0.6, 1 } },
  };
  char text[300];
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    snprintf(text, sizeof text, "&scene kind='basins' /\n" ONE "&sweep v=0 %s /\n", cases[i].sweep);
    deck d = read_good(text);
    const deck_axis *x = &d.axis[DECK_AXIS_X];
    assert_int_equal(x->count, cases[i].count);
    /* Ends and listed values are exact; the inside of a range is rounded three times. */
    for (size_t k = 0; k < x->count; k++) check_near(x->value[k], cases[i].value[k], 4e-16);
    assert_true(x->value[0] == cases[i].value[0]);
    assert_true(x->value[x->count - 1] == cases[i].value[x->count - 1]);
    assert_false(signbit(x->value[0]) && x->value[0] == 0.0);
    deck_free(&d);
  }
}

/* A range alone holds the decimals that would have been listed. A listed value stands for one of
   the range that is an ulp away, and is kept as it was written. */
static void listed_values_absorb_rounding(void **state)
{
  deck d = read_good("&scene kind='basins' /\n" ONE "&sweep v=0 x_range=0.06,0.2,15 /\n");
  const deck_axis *x = &d.axis[DECK_AXIS_X];
  (void)state;
  assert_int_equal(x->count, 15);
  assert_true(x->value[1] == 0.07 && x->value[6] == 0.12 && x->value[8] == 0.14);
  deck_free(&d);
  d = read_good("&scene kind='basins' /\n"
                ONE "&sweep v=0 x=0.06999999999999999,0.14000000000000004 x_range=0.06,0.2,15 /\n");
  x = &d.axis[DECK_AXIS_X];
  assert_int_equal(x->count, 15);
  assert_true(x->value[1] == nextafter(0.07, 0.0) && x->value[8] == nextafter(0.14, 1.0));
  deck_free(&d);
}

static void output_names(void **state)
{
  static const struct { const char *name, *output; } cases[] = {
    { "input/f02.nml", "f02.h5" }, { "f02", "f02.h5" }, { "/a.b/f.x.nml", "f.x.h5" },
    { "-", "resonance.h5" }, { "", "resonance.h5" }, { ".nml", ".nml.h5" }, { "a/", "resonance.h5" },
  };
  const char *text = good[0];
  char name[3000];
  deck d = { 0 };
  namelist_errors errors = { 0 };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    assert_int_equal(deck_read_memory(cases[i].name, text, strlen(text), &d, &errors), PENDRES_OK);
    assert_string_equal(d.output, cases[i].output);
    deck_free(&d);
  }
  memset(name, 'a', sizeof name);
  name[sizeof name - 1] = '\0';
  assert_int_equal(deck_read_memory(name, text, strlen(text), &d, &errors), PENDRES_OK);
  assert_true(strlen(d.output) < DECK_PATH);
  assert_string_equal(d.output + strlen(d.output) - 3, ".h5");
  deck_free(&d);
}

static void dump_reads_back(void **state)
{
  (void)state;
  for (size_t i = 0; i < GOOD; i++) {
    deck first = read_good(good[i]);
    char *text = dump(&first);
    deck second = read_good(text);
    char *again = dump(&second);
    assert_deck_equal(&first, &second);
    assert_string_equal(text, again);
    assert_int_equal(text[strlen(text) - 1], '\n');
    for (const char *line = text; *line != '\0'; line = strchr(line, '\n') + 1)
      assert_true(strchr(line, '\n') - line <= 100);
    free(text);
    free(again);
    deck_free(&first);
    deck_free(&second);
  }
}

/* Every key in use stands in the dump, keys that do not count do not. */
static void dump_is_complete(void **state)
{
  deck d = read_good(good[1]);
  char *text = dump(&d);
  (void)state;
  assert_string_equal(text,
                      "&scene\n"
                      "  kind = 'resonance_curve'\n"
                      "  title = 'Fig. 2'\n"
                      "  output = 't.h5'\n"
                      "/\n"
                      "&pendulum\n"
                      "  drive_amplitude = 0.2\n"
                      "/\n"
                      "&sweep\n"
                      "  damping = 0.165, 0.24, 0.32\n"
                      "  damping_range = 0.06, 1.0, 95\n"
                      "  drive_frequency_range = 0.5, 1.2\n"
                      "/\n"
                      "&ensemble\n"
                      "  members = 200\n"
                      "  shape = 'line'\n"
                      "  x_first = -1.5707963267948966\n"
                      "  x_last = 4.71238898038469\n"
                      "  v = 0.0\n"
                      "/\n"
                      "&precision\n"
                      "  tolerance = 1e-08\n"
                      "  method = 'block_fixed'\n"
                      "  table = 'tp8'\n"
                      "  steps_per_period = 0\n"
                      "  block_lanes = 0\n"
                      "  period_budget = 0\n"
                      "/\n");
  free(text);
  deck_free(&d);
  d = read_good(good[5]);
  text = dump(&d);
  assert_non_null(strstr(text, "drive_period"));
  assert_null(strstr(text, "drive_frequency"));
  assert_null(strstr(text, "  x ="));
  free(text);
  deck_free(&d);
}

static void dump_reports_a_full_disk(void **state)
{
  deck d = read_good(good[1]);
  FILE *full = fopen("/dev/full", "w");
  (void)state;
  if (full == NULL) {
    deck_free(&d);
    skip();
  }
  setvbuf(full, NULL, _IONBF, 0);
  assert_int_equal(deck_dump(&d, full), PENDRES_IO);
  fclose(full);
  deck_free(&d);
}

/* ---- bad decks ----------------------------------------------------------------------------- */

#define CURVE "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0.2 /\n"
#define ORBIT "&scene kind='orbit' /\n" ONE
#define BASINS "&scene kind='basins' /\n" ONE

/* Every error of a deck in order: its position, and words of the message after a blank. */
static const struct { const char *text; const char *error[8]; } bad[] = {
  { "", { "1:1 no group &scene" } },
  { "&pendulum damping=1 /", { "1:1 no group &scene" } },
  { "&scene title='a' /", { "1:1 needs a 'kind'" } },
  { "&scene kind='orbt' /\n" ONE "&orbit start='sa' /", { "1:13 (did you mean 'orbit'?)" } },
  { "&scene kind='nonsense' /\n&pendulum dampng=1 /", { "1:13 knows no 'nonsense'; it takes 'free_oscillation'",
                                                        "2:11 (did you mean 'damping'?)" } },
  { "&scene kind=orbit /\n&pendulum damping=-1 /", { "1:13 'kind' wants a string in quotes, not orbit" } },
  /* names */
  { "&scen kind='orbit' /\n" ONE "&orbit start='sa' /", { "1:1 &scen is not a group of decks (did you mean 'scene'?)" } },
  { ORBIT "&orbit start='sa' /\n&zzz a=1 /", { "4:1 &zzz is not a group of decks\n" } },
  { "&scene kind='orbit' /\n&pendulm drive_amplitude=0.2 damping=-1 drive_period=8 /\n&orbit start='sa' /",
    { "2:1 did you mean 'pendulum'?", "2:38 'damping' must not be negative" } },
  { "&scene kind='orbit' /\n&pendulum omega=1 gamma=0.1 f0=0.2 /\n&orbit start='sa' /",
    { "2:11 did you mean 'drive_frequency'?", "2:19 did you mean 'damping'?", "2:29 did you mean 'drive_amplitude'?" } },
  { CURVE "&sweep dampign=0.1 /", { "3:8 'dampign' is not a key of &sweep (did you mean 'damping'?)" } },
  { "&scene kind='free_oscillation' /\n&sweep apmlitdue=1 /", { "2:8 did you mean 'amplitude'?" } },
  { CURVE "&sweep damping_rnge=0.1,1,5 /", { "3:8 did you mean 'damping_range'?" } },
  { CURVE "&sweep damping=0.1 /\n&precision members=3 /", { "4:12 'members' is not a key of &precision (it belongs in &ensemble)" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble qwertz=3 /", { "4:11 'qwertz' is not a key of &ensemble; scene 'resonance_curve' takes members, shape, x_first, x_last, v, v_last, rows, seed\n" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble shape='rectangle' members=64 v_last=1 /",
    { "4:11 whole 'rows'" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble shape='random' v_last=-1 rows=2 /",
    { "4:26 must be above", "4:36 'rows' is not used: 'shape' is not 'rectangle'" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble v_last=1 /", { "4:11 'v_last' is not used: the starts" } },
  { CURVE "&sweep damping=0.1 /\n&precision method='blok_fixed' table='tp9' /",
    { "4:19 did you mean 'block_fixed'?", "4:38 did you mean 'tp8'?" } },
  { CURVE "&sweep damping=0.1 /\n&precision method='' /", { "4:19 knows no ''; it takes" } },
  /* what the scene does not use, what it needs */
  { CURVE "&sweep damping=0.1 amplitude=1 /\n&orbit x=1 /", { "3:20 'amplitude' in &sweep is not used by scene 'resonance_curve' (only by: free_oscillation)",
                                                            "4:1 &orbit is not used by scene 'resonance_curve' (only by: orbit)" } },
  { ORBIT "&orbit start='sa' /\n&ensemble members=3 /", { "4:1 &ensemble is not used" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 temperature=1 /\n&orbit start='sa' /",
    { "2:59 'temperature' in &pendulum is not used by scene 'orbit' (only by: response, basins, switching, hysteresis)" } },
  { "&scene kind='orbit' /", { "1:13 needs a group &pendulum with 'drive_amplitude', 'damping'",
                               "1:13 'drive_frequency' or 'drive_period'", "1:13 'start'" } },
  { "&scene kind='orbit' /\n&pendulum damping=1 /\n&orbit v=1 /",
    { "2:1 needs 'drive_amplitude' in &pendulum", "2:1 'drive_frequency' or 'drive_period'", "3:1 'x'" } },
  { CURVE, { "1:13 needs a group &sweep with 'damping'" } },
  { CURVE "&sweep /", { "3:1 needs 'damping' or 'damping_range' in &sweep" } },
  { CURVE "&sweep damping= /", { "3:1 needs 'damping'" } },
  { "&scene kind='work_precision' /\n&sweep unit='ensemble' /", { "2:1 needs 'tolerance' in &sweep", "2:1 needs 'method' in &sweep" } },
  { "&scene kind='switching' /\n" ONE, { "1:13 needs a group &sweep with 'temperature'" } },
  { "&scene kind='branches' /\n&pendulum drive_amplitude=0 /\n&sweep damping=1 drive_frequency=1 /",
    { "2:27 'drive_amplitude' must be positive" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 /\n&sweep damping=1 /", { "3:1 'drive_frequency' or 'drive_period' in &sweep" } },
  /* what excludes each other */
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=1 damping=1 drive_period=8 drive_frequency=1 /\n&orbit start='sa' /",
    { "2:54 not both" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 drive_period=8 /\n&sweep damping=1 drive_frequency=1 /", { "3:18 not both" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 damping=1 /\n&sweep damping=1 drive_frequency=1 /", { "2:29 'damping' is given in &sweep too (line 3)" } },
  { ORBIT "&orbit start='sa' x=1 v=0 /", { "3:19 'x' is not used: 'start' names", "3:23 'v' is not used" } },
  { BASINS "&sweep x=0 v=0 /\n&basins seed=1 /", { "4:9 'seed' is not used: it concerns noise" } },
  { BASINS "&sweep x=0 v=0 temperature=0 /\n&basins strobes=1 /", { "4:9 'strobes' is not used" } },
  { BASINS "&sweep x=1 v=0,1 /\n&basins boundary=.true. /", { "4:9 at least two values" } },
  /* types */
  { CURVE "&sweep damping='a' /", { "3:16 'damping' wants a number, not 'a'" } },
  { CURVE "&sweep damping=0.1, 0.2, x /", { "3:26 'damping' wants a number, not x" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=3.0 v=T /", { "4:19 'members' wants a whole number", "4:25 'v' wants a number" } },
  { "&scene kind='orbit' title=Fig /\n" ONE "&orbit start='sa' transient=1 /", { "1:27 'title' wants a string in quotes, not Fig", "3:29 'transient' wants .true. or .false., not 1" } },
  { "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0,2 /\n&sweep damping=1 /", { "2:29 takes one value (decimals have a point)" } },
  { "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0.2 damping=0.1, 0.2 /", { "2:44 takes one value; a list belongs in &sweep" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2\n damping 0.1\n drive_period=8 /\n&orbit start='sa' /", { "3:2 expected '=' after 'damping'" } },
  { CURVE "&sweep damping=1e400 /", { "3:16 'damping': 1e400 is too large" } },
  { CURVE "&sweep damping=1e-400 /", { "3:16 'damping': 1e-400 is too small" } },
  { CURVE "&sweep damping=0.1,,0.3 /", { "3:8 value 2 is missing" } },
  { CURVE "&sweep damping=3* 1.5 /", { "3:8 value 1 is missing" } },
  { "&scene kind='work_precision' /\n&sweep method='block_fixed','block_fixed' tolerance=1e-5 /", { "2:29 'method' names this one twice" } },
  /* ranges */
  { CURVE "&sweep damping=-0.1, nan, 0, inf /", { "3:16 must be positive", "3:22 must be a finite number", "3:27 must be positive", "3:30 must be a finite number" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=-1 damping=nan drive_frequency=0 /\n&orbit start='sa' /",
    { "2:27 must not be negative", "2:38 must be a finite number", "2:58 must be positive" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=1 damping=1 drive_period=-8 /\n&orbit start='sa' /", { "2:52 'drive_period' must be positive" } },
  { BASINS "&sweep x=0 v=0 temperature=-1 /", { "3:28 'temperature' must not be negative" } },
  { BASINS "&sweep x=0 v=0 temperature=nan /", { "3:28 'temperature' must be a finite number" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=0 /", { "3:20 'temperature' must be positive" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=1 /\n&switching to=2 /",
    { "4:12 'from' and 'to' belong together" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=1 /\n&switching from=2, to=2 /",
    { "4:20 'from' and 'to' are the same attractor" } },
  { "&scene kind='free_oscillation' /\n&sweep amplitude=0, 3.1415926535897932, 3.2, 1 /",
    { "2:18 must be positive", "2:21 must lie between 0 and 3.141593 (both excluded)", "2:41 must lie between" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=0 /\n&precision tolerance=1e-15 steps_per_period=-1 /",
    { "4:19 'members' must be positive", "5:22 'tolerance' must lie between 1e-13 and 0.01: less is beyond double", "5:45 'steps_per_period' must not be negative" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=1000001 /\n&precision tolerance=0.02 block_lanes=12 /", { "4:19 must lie between 1 and 1000000", "5:22 'tolerance' must lie", "5:27 multiple of 8" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble x_first=2 x_last=1 /", { "4:21 'x_first' must be below 'x_last'" } },
  { CURVE "&sweep damping_range=1,0.1,5 /", { "3:22 'damping_range' must ascend" } },
  { CURVE "&sweep damping_range=0.1,1 /", { "3:26 takes three values: first, last, count" } },
  { CURVE "&sweep damping_range=0.1,1,2,3 /", { "3:30 takes three values" } },
  { CURVE "&sweep damping_range=0.1,1,0 /", { "3:28 count between 1 and 1000000" } },
  { CURVE "&sweep damping_range=0.1,1,1000001 /", { "3:28 count between 1 and 1000000" } },
  { CURVE "&sweep damping_range=0.1,1,1 /", { "3:28 one value only where first and last agree" } },
  { CURVE "&sweep damping_range=0.1,0.1,2 /", { "3:30 several values only where" } },
  { CURVE "&sweep damping_range=0.1,1,10.0 /", { "3:28 wants a whole number" } },
  { CURVE "&sweep damping=1 drive_frequency_range=0.5,1.2,10 /", { "3:48 takes two values here" } },
  { CURVE "&sweep damping=1 drive_frequency_range=1.2,0.5 /", { "3:44 must ascend" } },
  { CURVE "&sweep damping=1 drive_amplitude=0.1 /",
    { "3:18 'drive_amplitude' in &sweep is not used by scene 'resonance_curve' (only by: response, "
      "phase_diagram, branches, hysteresis, bifurcation_diagram, lyapunov_map)" } },
  { "&scene kind='branches' /\n&sweep damping=0.13 drive_frequency=0.8 /",
    { "1:13 needs a group &pendulum with 'drive_amplitude'" } },
  { "&scene kind='branches' /\n&pendulum drive_amplitude=0.2 /\n"
    "&sweep damping=0.13 drive_frequency=0.8 drive_amplitude=0.1 /",
    { "2:11 'drive_amplitude' is given in &sweep too" } },
  { "&scene kind='phase_diagram' /\n"
    "&sweep damping=0.1,0.2 drive_frequency=0.8,0.9 drive_amplitude=0.1,0.2 /",
    { "2:48 results have two axes" } },
  { CURVE "&sweep damping=1 drive_frequency=1 /", { "3:18 'drive_frequency' in &sweep is not used" } },
  { BASINS "&sweep x_range=0,1,100000 v_range=0,1,100000 /", { "1:13 multiply to 1e+10 pendulums; at most 2^32 are possible without refine" } },
  { CURVE "&sweep damping_range=0.1,1,1000000 /\n&ensemble members=1000000 /", { "1:13 the axes and members multiply to 1e+12" } },
  { ORBIT "&orbit start='sa' periods=1000000 samples=1000 /", { "3:19 must not exceed 1e8" } },
  /* output */
  { "&scene kind='hard_cases' output='' /", { "1:26 must not be empty" } },
  { "&scene kind='hard_cases' output='a/' /", { "1:26 not a folder" } },
  { "&scene kind='hard_cases' output='input/t.nml' /", { "1:26 would overwrite the deck" } },
  /* syntax and sense in one go; nothing is called missing that could not be read */
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2; damping=-1\n drive_period=8\n&orbit start='xa' /",
    { "2:1 &pendulum is not closed", "2:30 ';'", "2:40 'damping' must not be negative", "4:14 knows no 'xa'; it takes 'sa', 'la'" } },
  { "&scene kind='orbit' title='Fig. 5 /\n" ONE "&orbit start='sa' peroids=3 /", { "1:27 not closed", "3:19 did you mean 'periods'?" } },
  { CURVE "&sweep damping=0.1 damping=0.2 /\n&sweep damping=0.3 /", { "3:20 'damping' is given twice (first on line 3)", "4:1 &sweep is given twice (first on line 3)" } },
  { CURVE "&sweep damping=0.1 / text\n", { "3:22 text outside of any group" } },
};

static int check_bad(size_t i)
{
  deck d;
  namelist_errors errors = { 0 };
  size_t wanted = 0;
  memset(&d, 0x55, sizeof d);
  const pendres_status status = deck_read_memory("input/t.nml", bad[i].text, strlen(bad[i].text), &d, &errors);
  const deck zero = { 0 };
  while (wanted < 8 && bad[i].error[wanted] != NULL) wanted++;
  int good_errors = errors.count == wanted;
  for (size_t k = 0; k < wanted && k < errors.count; k++) {
    char position[60];
    const char *words = strchr(bad[i].error[k], ' ');
    snprintf(position, sizeof position, "input/t.nml:%.*s: error: ", (int)(words - bad[i].error[k]), bad[i].error[k]);
    if (strncmp(errors.item[k].text, position, strlen(position)) != 0) good_errors = 0;
    if (strstr(errors.item[k].text, words + 1) == NULL) good_errors = 0;
    if (strchr(errors.item[k].text, '^') == NULL) good_errors = 0;
  }
  if (!good_errors) {
    print_error("case %zu:\n%s\n", i, bad[i].text);
    namelist_errors_print(&errors, stderr);
  }
  namelist_errors_free(&errors);
  assert_int_equal(status, PENDRES_INVALID_ARGUMENT);
  assert_memory_equal(&d, &zero, sizeof d); /* nothing is applied */
  return good_errors;
}

static void bad_decks(void **state)
{
  int wrong = 0;
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) wrong += !check_bad(i);
  assert_int_equal(wrong, 0);
}

static void files(void **state)
{
  deck d = { 0 };
  namelist_errors errors = { 0 };
  (void)state;
  assert_int_equal(deck_read("no/such/deck.nml", &d, &errors), PENDRES_IO);
  assert_int_equal(deck_read("/", &d, &errors), PENDRES_IO);
  assert_int_equal(deck_read("/dev/zero", &d, &errors), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(errors.count, 3);
  assert_null(d.text);
  namelist_errors_free(&errors);
}

/* ---- random damage ------------------------------------------------------------------------- */

static uint32_t draw(uint64_t *seed)
{
  *seed = *seed * 6364136223846793005u + 1442695040888963407u; /* Knuth, MMIX */
  return (uint32_t)(*seed >> 33);
}

/* A deck is either good, and then its dump means the same, or bad, and then it says why. */
static void damaged_decks(void **state)
{
  static const char *const pieces[] = {
    "&", "/", "'", ",", "=", "!", " ", "\n", "*", "3*", "(2)", "-", "nan", "inf", "1e400", "0", "T",
    "kind='orbit'", "damping=0.1", "temperature=1e-3", "x_range=0,1,3", "&sweep ", "&end", "method='single'",
    "drive_period=7", "v=0", "start='sa'", "1", "1000000", "_range", ";", "\x80", "a%b", "''", "\"",
  };
  uint64_t seed = 2;
  int good_ones = 0;
  (void)state;
  for (int round = 0; round < 30000; round++) {
    char text[1000];
    deck d = { 0 };
    namelist_errors errors = { 0 };
    size_t length = strlen(good[draw(&seed) % GOOD]);
    /* The same draw twice: length and text belong together. */
    const char *from = good[(uint32_t)(seed >> 33) % GOOD];
    assert_int_equal(length, strlen(from));
    memcpy(text, from, length + 1);
    for (uint32_t k = 1 + draw(&seed) % 3; k > 0 && length > 0; k--) {
      const size_t at = draw(&seed) % length;
      const char *piece = pieces[draw(&seed) % (sizeof pieces / sizeof *pieces)];
      const size_t n = strlen(piece), cut = draw(&seed) % 8 < length - at ? draw(&seed) % 4 : 0;
      const size_t gone = cut < length - at ? cut : length - at;
      memmove(text + at + n, text + at + gone, length - at - gone + 1);
      memcpy(text + at, piece, n);
      length += n - gone;
    }
    const pendres_status status = deck_read_memory("t.nml", text, length, &d, &errors);
    assert_int_equal(status == PENDRES_OK, errors.count == 0);
    if (status == PENDRES_OK) {
      char *dumped = dump(&d);
      deck again = read_good(dumped);
      assert_deck_equal(&d, &again);
      deck_free(&again);
      free(dumped);
      good_ones++;
    }
    deck_free(&d);
    namelist_errors_free(&errors);
  }
  /* Otherwise the damage is so great, or so small, that nothing is tested. */
  assert_in_range(good_ones, 200, 15000);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_kind_is_read),
    cmocka_unit_test(resonance_curve_values),
    cmocka_unit_test(other_values),
    cmocka_unit_test(forces),
    cmocka_unit_test(names_of_kinds_and_axes),
    cmocka_unit_test(axes),
    cmocka_unit_test(listed_values_absorb_rounding),
    cmocka_unit_test(output_names),
    cmocka_unit_test(dump_reads_back),
    cmocka_unit_test(dump_is_complete),
    cmocka_unit_test(dump_reports_a_full_disk),
    cmocka_unit_test(bad_decks),
    cmocka_unit_test(files),
    cmocka_unit_test(damaged_decks),
  };
  return cmocka_run_group_tests_name("deck", tests, NULL, NULL);
}
