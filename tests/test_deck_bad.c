/*
 * test_deck_bad.c -- decks with mistakes, and decks that are damaged at random.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "deck_fixture.h"

/* ---- bad decks ----------------------------------------------------------------------------- */

#define CURVE "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0.2 /\n"
#define ORBIT "&scene kind='orbit' /\n" ONE
#define BASINS "&scene kind='basins' /\n" ONE
#define SWEPT "&scene kind='hysteresis' /\n" \
              "&pendulum damping=0.1 drive_amplitude=0.2 drive_frequency=1 "

static const bad_deck bad[] = {
  { "", { "1:1 no group &scene" } },
  { "&pendulum damping=1 /", { "1:1 no group &scene" } },
  { "&scene title='a' /", { "1:1 needs a 'kind'" } },
  { "&scene kind='orbt' /\n" ONE "&orbit start='sa' /", { "1:13 (did you mean 'orbit'?)" } },
  { "&scene kind='nonsense' /\n&pendulum dampng=1 /",
    { "1:13 knows no 'nonsense'; it takes 'free_oscillation'",
        "2:11 (did you mean 'damping'?)" } },
  { "&scene kind='orbit' /\n&pendulum force='Duffing' force_coefficients=1,0,1 quality=5\n"
    "  drive_amplitude=1 drive_period=8 /\n&orbit x=1 /",
    { "2:17 knows no 'Duffing' (did you mean 'polynomial'?)", "2:52 (did you mean 'damping'?)" } },
  { "&scene kind=orbit /\n&pendulum damping=-1 /",
    { "1:13 'kind' wants a string in quotes, not orbit" } },
  /* names */
  { "&scen kind='orbit' /\n" ONE "&orbit start='sa' /",
    { "1:1 &scen is not a group of decks (did you mean 'scene'?)" } },
  { ORBIT "&orbit start='sa' /\n&zzz a=1 /", { "4:1 &zzz is not a group of decks\n" } },
  { "&scene kind='orbit' /\n&pendulm drive_amplitude=0.2 damping=-1 drive_period=8 /\n&orbit "
    "start='sa' /",
    { "2:1 did you mean 'pendulum'?", "2:38 'damping' must not be negative" } },
  { "&scene kind='orbit' /\n&pendulum omega=1 gamma=0.1 f0=0.2 /\n&orbit start='sa' /",
    { "2:11 did you mean 'drive_frequency'?", "2:19 did you mean 'damping'?",
      "2:29 did you mean 'drive_amplitude'?" } },
  { CURVE "&sweep dampign=0.1 /",
    { "3:8 'dampign' is not a key of &sweep (did you mean 'damping'?)" } },
  { "&scene kind='free_oscillation' /\n&sweep apmlitdue=1 /", { "2:8 did you mean 'amplitude'?" } },
  { CURVE "&sweep damping_rnge=0.1,1,5 /", { "3:8 did you mean 'damping_range'?" } },
  { CURVE "&sweep damping=0.1 /\n&precision members=3 /",
    { "4:12 'members' is not a key of &precision (it belongs in &ensemble)" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble qwertz=3 /",
    { "4:11 'qwertz' is not a key of &ensemble; scene 'resonance_curve' takes members, shape, "
      "x_first, x_last, v, v_last, rows, seed; docs/limits.md says what cannot be asked\n" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble shape='rectangle' members=64 v_last=1 /",
    { "4:11 whole 'rows'" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble shape='random' v_last=-1 rows=2 /",
    { "4:26 must be above", "4:36 'rows' is not used: 'shape' is not 'rectangle'" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble v_last=1 /",
    { "4:11 'v_last' is not used: the starts" } },
  { CURVE "&sweep damping=0.1 /\n&precision method='blok_fixed' table='tp9' /",
    { "4:19 did you mean 'block_fixed'?", "4:38 did you mean 'tp8'?" } },
  { CURVE "&sweep damping=0.1 /\n&precision method='' /", { "4:19 knows no ''; it takes" } },
  /* what the scene does not use, what it needs */
  { CURVE "&sweep damping=0.1 amplitude=1 /\n&orbit x=1 /",
    { "3:20 'amplitude' in &sweep is not used by scene 'resonance_curve' (only by: "
      "free_oscillation)",
        "4:1 &orbit is not used by scene "
        "'resonance_curve' (only by: "
        "orbit)" } },
  { ORBIT "&orbit start='sa' /\n&ensemble members=3 /", { "4:1 &ensemble is not used" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 "
    "temperature=1 /\n&orbit start='sa' /",
    { "2:59 'temperature' in &pendulum is not used by scene 'orbit' (only by: response, basins, "
      "switching, hysteresis)" } },
  { "&scene kind='orbit' /", { "1:13 needs a group &pendulum with 'drive_amplitude', 'damping'",
        "1:13 'drive_frequency' or 'drive_period'", "1:13 'start'" } },
  { "&scene kind='orbit' /\n&pendulum damping=1 /\n&orbit v=1 /",
    { "2:1 needs 'drive_amplitude' in &pendulum", "2:1 'drive_frequency' or 'drive_period'",
      "3:1 'x'" } },
  { CURVE, { "1:13 needs a group &sweep with 'damping'" } },
  { CURVE "&sweep /", { "3:1 needs 'damping' or 'damping_range' in &sweep" } },
  { CURVE "&sweep damping= /", { "3:1 needs 'damping'" } },
  { "&scene kind='work_precision' /\n&sweep unit='ensemble' /",
    { "2:1 needs 'tolerance' in &sweep", "2:1 needs 'method' in &sweep" } },
  { "&scene kind='switching' /\n" ONE, { "1:13 needs a group &sweep with 'temperature'" } },
  { "&scene kind='branches' /\n&pendulum drive_amplitude=-1 /\n"
    "&sweep damping=1 drive_frequency=1 /",
    { "2:27 'drive_amplitude' must not be negative" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 /\n&sweep damping=1 /",
    { "3:1 'drive_frequency' or 'drive_period' in &sweep" } },
  /* what excludes each other */
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=1 damping=1 drive_period=8 drive_frequency=1 "
    "/\n&orbit start='sa' /",
    { "2:54 not both" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 drive_period=8 /\n&sweep damping=1 "
    "drive_frequency=1 /", { "3:18 not both" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=1 damping=1 /\n&sweep damping=1 "
    "drive_frequency=1 /", { "2:29 'damping' is given in &sweep too (line 3)" } },
  { ORBIT "&orbit start='sa' x=1 v=0 /",
    { "3:19 'x' is not used: an attractor is named", "3:23 'v' is not used" } },
  { BASINS "&sweep x=0 v=0 /\n&basins seed=1 /", { "4:9 'seed' is not used: it concerns noise" } },
  { BASINS "&sweep x=0 v=0 temperature=0 /\n&basins strobes=1 /", { "4:9 'strobes' is not used" } },
  { BASINS "&sweep x=1 v=0,1 /\n&basins boundary=.true. /", { "4:9 at least two values" } },
  /* types */
  { CURVE "&sweep damping='a' /", { "3:16 'damping' wants a number, not 'a'" } },
  { CURVE "&sweep damping=0.1, 0.2, x /", { "3:26 'damping' wants a number, not x" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=3.0 v=T /",
    { "4:19 'members' wants a whole number", "4:25 'v' wants a number" } },
  { "&scene kind='orbit' title=Fig /\n" ONE "&orbit start='sa' transient=1 /",
    { "1:27 'title' wants a string in quotes, not Fig",
      "3:29 'transient' wants .true. or .false., not 1" } },
  { "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0,2 /\n&sweep damping=1 /",
    { "2:29 takes one value (decimals have a point)" } },
  { "&scene kind='resonance_curve' /\n&pendulum drive_amplitude=0.2 damping=0.1, 0.2 /",
    { "2:44 takes one value; a list belongs in &sweep" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2\n damping 0.1\n drive_period=8 /\n&orbit "
    "start='sa' /", { "3:2 expected '=' after 'damping'" } },
  { CURVE "&sweep damping=1e400 /", { "3:16 'damping': 1e400 is too large" } },
  { CURVE "&sweep damping=1e-400 /", { "3:16 'damping': 1e-400 is too small" } },
  { CURVE "&sweep damping=0.1,,0.3 /", { "3:8 value 2 is missing" } },
  { CURVE "&sweep damping=3* 1.5 /", { "3:8 value 1 is missing" } },
  { "&scene kind='work_precision' /\n&sweep method='block_fixed','block_fixed' tolerance=1e-5 /",
    { "2:29 'method' names this one twice" } },
  /* ranges */
  { CURVE "&sweep damping=-0.1, nan, 0, inf /",
    { "3:16 must be positive", "3:22 must be a finite number", "3:27 must be positive",
      "3:30 must be a finite number" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=-1 damping=nan drive_frequency=0 /\n&orbit "
    "start='sa' /",
    { "2:27 must not be negative", "2:38 must be a finite number", "2:58 must be positive" } },
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=1 damping=1 drive_period=-8 /\n&orbit "
    "start='sa' /", { "2:52 'drive_period' must be positive" } },
  { BASINS "&sweep x=0 v=0 temperature=-1 /", { "3:28 'temperature' must not be negative" } },
  { BASINS "&sweep x=0 v=0 temperature=nan /", { "3:28 'temperature' must be a finite number" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=0 /",
    { "3:20 'temperature' must be positive" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=1 /\n&switching to=2 /",
    { "4:12 'to' needs 'from'" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=1 /\n&switching from=2, to=2 /",
    { "4:20 'from' and 'to' are the same attractor" } },
  { "&scene kind='free_oscillation' /\n&sweep amplitude=0, 3.1415926535897932, 3.2, 1 /",
    { "2:18 must be positive" } },
  { "&scene kind='free_oscillation' /\n&sweep amplitude=3.1415926535897932, 3.0 /",
    { "2:8 'amplitude' of a pendulum must lie between 0 and pi (both excluded)" } },
  { "&scene kind='free_oscillation' /\n&sweep amplitude_range=1, 3.2, 5 /",
    { "2:8 'amplitude_range' of a pendulum must lie between 0 and pi (both excluded)" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=0 /\n&precision tolerance=1e-15 "
        "steps_per_period=-1 /",
    { "4:19 'members' must be positive",
      "5:12 'tolerance' must lie between 1e-13 and 0.01: less is beyond double",
        "5:45 'steps_per_period' must not be negative" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble members=1000001 /\n&precision tolerance=0.02 "
   "block_lanes=12 /", { "4:19 must lie between 1 and 1000000", "5:12 'tolerance' must lie",
        "5:27 multiple of 8" } },
  { CURVE "&sweep damping=0.1 /\n&ensemble x_first=2 x_last=1 /",
    { "4:21 'x_first' must be below 'x_last'" } },
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
    { "2:11 'drive_amplitude' is given in &sweep too" } },
  { "&scene kind='switching' /\n" ONE "&sweep temperature=1 torque=0.1 /",
    { "3:22 'torque' in &sweep is not used by scene 'switching' (only by: resonance_curve, "
      "response, phase_diagram, branches, hysteresis, bifurcation_diagram, lyapunov_map, "
      "escape)" } },
  { "&scene kind='orbit' /\n&pendulum damping=0.1 drive_amplitude=0.2 drive_period=8\n"
    "force_coefficients=1 /\n&orbit x=1 /",
    { "3:1 a pendulum's force has no 'force_coefficients': give 'force'" } },
  { "&scene kind='orbit' /\n&pendulum damping=0.1 drive_amplitude=0.2 drive_period=8\n"
    "force='polynomial' /\n&orbit x=1 /",
    { "3:1 a polynomial needs 'force_coefficients'" } },
  { "&scene kind='switching' /\n&pendulum damping=0.1 drive_amplitude=0.2 drive_period=8\n"
    "force='squid' force_coefficients=1 /\n&sweep temperature=1 /\n&switching from=1 /",
    { "5:12 this force has no wells that are alike: 'from' needs 'to'" } },
  { "&scene kind='basins' /\n&pendulum damping=0.1 drive_amplitude=0.2 drive_period=8\n"
    "temperature=1 force='polynomial' force_coefficients=1,-1 /\n&sweep x=1,2 v=1,2 /",
    { "3:1 noise carries a pendulum to infinity" } },
  { CURVE "&sweep damping=1,2 torque=0.1,0.2 /",
    { "3:20 results have one axis, not 'torque', 'damping': give" } },
  { CURVE "&sweep damping=1 torque=0.1,0.2 parametric_amplitude=0.1 /",
    { "3:18 results have one axis, not 'torque', 'parametric_amplitude': give" } },
  { "&scene kind='resonance_curve' /\n&sweep damping=1,2 drive_amplitude=0.1,0.2 /",
    { "2:20 results have one axis, not 'drive_amplitude', 'damping': give" } },
  { "&scene kind='response' /\n&sweep damping=1 drive_amplitude=0.1,0.2 drive_period=7 "
    "resonance_range=0.6,0.9 /",
    { "2:57 'resonance_range' is not used: no resonance is looked for" } },
  { "&scene kind='branches' /\n&sweep damping=0.13 drive_frequency=0.8 /",
    { "1:13 needs a group &pendulum with 'drive_amplitude'" } },
  { "&scene kind='branches' /\n&pendulum drive_amplitude=0.2 /\n"
    "&sweep damping=0.13 drive_frequency=0.8 drive_amplitude=0.1 /",
    { "2:11 'drive_amplitude' is given in &sweep too" } },
  { "&scene kind='phase_diagram' /\n"
    "&sweep damping=0.1,0.2 drive_frequency=0.8,0.9 drive_amplitude=0.1,0.2 /",
    { "2:48 results have two axes, not 'drive_amplitude', 'damping', 'drive_frequency'" } },
  /* coefficients as axes */
  { SWEPT "force='polynomial' force_coefficients=1 /\n&sweep a3=1,2 torque=0.1,0.2 /\n"
    "&hysteresis x=0 /", { "3:15 one parameter is swept, not 'torque', 'a3'" } },
  { SWEPT "/\n&sweep a3=1,2 /\n&hysteresis x=0 /",
    { "3:8 force 'pendulum' has no coefficient 'a3'" } },
  { SWEPT "force='squid' /\n&sweep a2_range=1,2,3 /\n&hysteresis x=0 /",
    { "3:8 force 'squid' has no coefficient 'a2'" } },
  { SWEPT "force='polynomial' force_coefficients=1,0,1 /\n&sweep a3=1,2 /\n&hysteresis x=0 /",
    { "3:8 'a3' is given in 'force_coefficients' too: give 0 there" } },
  { SWEPT "force='polynomial' /\n&sweep a3=0,1 /\n&hysteresis x=0 /",
    { "2:61 a polynomial needs 'force_coefficients', one of them not zero" } },
  { "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 force='polynomial' "
    "force_coefficients=1 /\n&sweep damping=0.1,0.2 drive_frequency=0.8,0.9 a3=1,2 /",
    { "3:48 results have two axes, not 'a3', 'damping', 'drive_frequency'" } },
  { "&scene kind='response' /\n&pendulum drive_amplitude=0.2 temperature=1 force='polynomial' "
    "force_coefficients=1 /\n&sweep damping=0.1 drive_frequency=1 a3=1,-1 /",
    { "2:31 noise carries a pendulum to infinity" } },
  { CURVE "&sweep damping=1 drive_frequency=1 /",
    { "3:18 'drive_frequency' in &sweep is not used" } },
  { BASINS "&sweep x_range=0,1,100000 v_range=0,1,100000 /",
    { "1:13 multiply to 1e+10 pendulums; at most 2^32 are possible without refine" } },
  { CURVE "&sweep damping_range=0.1,1,1000000 /\n&ensemble members=1000000 /",
    { "1:13 the axes and members multiply to 1e+12" } },
  { CURVE "&sweep damping_range=0.1,1,1000 resolution=2000 /",
    { "3:33 'resolution' makes more than 1000000 values of a range" } },
  { ORBIT "&orbit start='sa' periods=1000000 samples=1000 /", { "3:19 must not exceed 1e8" } },
  { ORBIT "&orbit start='sa' spectrum=T periods=3 samples=1 /", { "3:30 'periods' of 4 or more" } },
  { ORBIT "&orbit start='sa' spectrum=T segment=1 samples=5 /", { "3:30 'segment' of 2 or more" } },
  /* output */
  { "&scene kind='hard_cases' output='' /", { "1:26 must not be empty" } },
  { "&scene kind='hard_cases' output='a/' /", { "1:26 not a folder" } },
  { "&scene kind='hard_cases' output='input/t.nml' /", { "1:26 would overwrite the deck" } },
  /* syntax and sense in one go; nothing is called missing that could not be read */
  { "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2; damping=-1\n drive_period=8\n&orbit "
    "start='xa' /",
    { "2:1 &pendulum is not closed", "2:30 ';'", "2:40 'damping' must not be negative",
      "4:14 knows no 'xa'; it takes 'sa', 'la'" } },
  { "&scene kind='orbit' title='Fig. 5 /\n" ONE "&orbit start='sa' peroids=3 /",
    { "1:27 not closed", "3:19 did you mean 'periods'?" } },
  { CURVE "&sweep damping=0.1 damping=0.2 /\n&sweep damping=0.3 /",
    { "3:20 'damping' is given twice (first on line 3)",
      "4:1 &sweep is given twice (first on line 3)" } },
  { CURVE "&sweep damping=0.1 / text\n", { "3:22 text outside of any group" } },
};

static void bad_decks(void **state)
{
  int wrong = 0;
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) wrong += !is_refused(&bad[i]);
  assert_int_equal(wrong, 0);
}

static void files(void **state)
{
  deck d = { 0 };
  namelist_errors errors = { 0 };
  (void)state;
  assert_int_equal(deck_read_set("no/such/deck.nml", NULL, 0, &d, &errors), PENDRES_IO);
  assert_int_equal(deck_read_set("/", NULL, 0, &d, &errors), PENDRES_IO);
  assert_int_equal(deck_read_set("/dev/zero", NULL, 0, &d, &errors), PENDRES_IO);
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
    "kind='orbit'", "damping=0.1", "temperature=1e-3", "x_range=0,1,3", "&sweep ", "&end",
      "method='single'",
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
    cmocka_unit_test(bad_decks),
    cmocka_unit_test(files),
    cmocka_unit_test(damaged_decks),
  };
  return cmocka_run_group_tests_name("deck_bad", tests, NULL, NULL);
}
