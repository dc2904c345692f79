/*
 * test_deck.c -- what decks mean: defaults and values of every kind of scene, axes, every mistake
 * with its position and words, the dump, and random damage. Values are compared to the bit.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "deck_fixture.h"

/* ---- good decks ---------------------------------------------------------------------------- */

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
  assert_true(damping->value[11] == 0.165 && damping->value[19] == 0.24 &&
              damping->value[27] == 0.32);
  for (size_t i = 1; i < damping->count; i++) assert_true(damping->value[i] > damping->value[i - 1]
                                                          + 1e-3);
  assert_true(d.search[0] == 0.5 && d.search[1] == 1.2);
  assert_int_equal(d.axis[DECK_AXIS_DRIVE_FREQUENCY].count, 0);
  assert_int_equal(d.ensemble.members, 200);
  assert_true(d.ensemble.x_first == -1.57079632679489661923 &&
              d.ensemble.x_last == 4.71238898038468985769);
  assert_true(d.ensemble.v == 0.0);
  assert_true(d.precision.tolerance == 1e-8);
  assert_string_equal(d.precision.method, "block_fixed");
  assert_string_equal(d.precision.table, "tp8");
  assert_int_equal(d.precision.steps_per_period + d.precision.block_lanes
                   + d.precision.period_budget, 0);
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
  assert_string_equal(d.precision.table, "vern9");
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
  assert_true(d.drive_period == 8 && d.by_period);
  assert_true(d.pendulum.drive_frequency == 6.28318530717958647693 / 8);
  deck_free(&d);

  d = read_good(good[6]);
  assert_string_equal(d.orbit.start, "");
  assert_true(d.orbit.x == 0.3 && d.orbit.v == -1 && d.orbit.transient == 1);
  assert_true(d.pendulum.drive_frequency == 0.7 && !d.by_period);
  assert_true(d.drive_period == 6.28318530717958647693 / 0.7);
  deck_free(&d);

  d = read_good(good[4]);
  assert_true(deck_has_noise(&d));
  assert_true(d.axis[DECK_AXIS_TEMPERATURE].count == 1 &&
              d.axis[DECK_AXIS_TEMPERATURE].value[0] == 1e-3);
  assert_true(d.noise.seed == INT64_MAX && d.noise.trajectories == 64 && d.noise.periods == 10);
  deck_free(&d);

  d = read_good(good[9]);
  assert_int_equal(d.axis[DECK_AXIS_TEMPERATURE].count, 2);
  assert_true(d.basins.strobes == 10 && d.noise.seed == 7 && d.basins.trajectories == 8);
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

/* One field may have several rows, with a default for each scene: what --explain says is taken. */
static void defaults_of_scenes(void **state)
{
  static const struct { const char *text; int64_t trajectories; } cases[] = {
    {"&scene kind='response' /\n&pendulum drive_amplitude=0.2 temperature=0.01 /\n"
     "&sweep damping=0.2 drive_period=8 /\n", 1920},
    {"&scene kind='hysteresis' /\n&pendulum drive_amplitude=0.2 damping=0.1 temperature=0.01 /\n"
     "&sweep drive_frequency=0.7,0.8 /\n&hysteresis start='sa' rate=0.01 /\n", 384}};
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    deck d = read_good(cases[i].text);
    assert_int_equal(d.noise.trajectories, cases[i].trajectories);
    deck_free(&d);
  }
}

/* Forces: the plain pendulum where nothing is said, coefficients in their order, the rest zero. */
static void forces(void **state)
{
  (void)state;
  deck d = read_good("&scene kind='orbit' / &pendulum drive_amplitude=0.2 damping=0.1 "
                     "drive_frequency=1 / &orbit start='sa' /");
  assert_string_equal(d.force, "pendulum");
  assert_true(d.pendulum.torque == 0.0 && d.pendulum.parametric_amplitude == 0.0);
  deck_free(&d);
  d = read_good("&scene kind='orbit' / &pendulum drive_amplitude=0.2 damping=0.1 drive_frequency=1 "
                "torque=-0.5 parametric_amplitude=0.3 force='polynomial' "
                "force_coefficients = 1, , -2.5 / &orbit start='sa' /");
  const double a[] = { 1.0, 0.0, -2.5, 0.0, 0.0 };
  assert_string_equal(d.force, "polynomial");
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
    { "x_range=0,1,3 resolution=2", 5, { 0, 0.25, 0.5, 0.75, 1 } },
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
    { "-", "resonance.h5" }, { "", "resonance.h5" }, { ".nml", ".nml.h5" },
      { "a/", "resonance.h5" },
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
                      "  torque = 0.0\n"
                      "  parametric_amplitude = 0.0\n"
                      "  nonlinear_damping = 0.0\n"
                      "  quadratic_damping = 0.0\n"
                      "  cubic_damping = 0.0\n"
                      "  force = 'pendulum'\n"
                      "  force_coefficients = 0.0, 0.0, 0.0, 0.0, 0.0\n"
                      "/\n"
                      "&sweep\n"
                      "  damping = 0.165, 0.24, 0.32\n"
                      "  damping_range = 0.06, 1.0, 95\n"
                      "  drive_frequency_range = 0.5, 1.2\n"
                      "  resolution = 1\n"
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
                      "  unresolved_share = 0.0\n"
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

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_kind_is_read),
    cmocka_unit_test(resonance_curve_values),
    cmocka_unit_test(other_values),
    cmocka_unit_test(defaults_of_scenes),
    cmocka_unit_test(forces),
    cmocka_unit_test(names_of_kinds_and_axes),
    cmocka_unit_test(axes),
    cmocka_unit_test(listed_values_absorb_rounding),
    cmocka_unit_test(output_names),
    cmocka_unit_test(dump_reads_back),
    cmocka_unit_test(dump_is_complete),
    cmocka_unit_test(dump_reports_a_full_disk),
  };
  return cmocka_run_group_tests_name("deck", tests, NULL, NULL);
}
