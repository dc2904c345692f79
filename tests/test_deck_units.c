/*
 * test_deck_units.c -- numbers with units in decks, and the scales of &units that they need.
 *
 * Tolerances: a conversion has at most eight roundings, each of 1.1e-16; what is 1 or a plain
 * decimal by definition is compared exactly.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "deck_fixture.h"
#include "deck/si/si.h"
#include "deck/table.h"

static const double rounding = 8 * 1.2e-16;

#define PI PENDRES_PI
/* CODATA 2018, exact by definition. */
static const double planck = 6.62607015e-34, charge = 1.602176634e-19, boltzmann = 1.380649e-23;

#define SCENE "&scene kind='hysteresis' /\n&hysteresis x='0 m' /\n"
#define OF_LENGTH "&scene kind='hysteresis' /\n&hysteresis x='2 nm' v='1 mm/s' /\n"
#define SWEEP "&sweep drive_frequency_range='1.199 MHz', '1206 kHz', 8 /\n"

/* What a deck says, dumps and reads again is the same in every bit, scales included. */
static deck read_twice(const char *text)
{
  deck d = read_good(text);
  char *first = dump(&d);
  deck again = read_good(first);
  assert_deck_equal(&d, &again);
  char *second = dump(&again);
  assert_string_equal(first, second);
  free(first);
  free(second);
  deck_free(&again);
  return d;
}

static double factor_of(const deck *d, const char *name, const char *units)
{
  deck_si si;
  if (!deck_si_of(d, name, &si)) fail_msg("%s has no unit", name);
  assert_string_equal(si.units, units);
  return si.factor;
}

/* The resonator of 1.2 MHz, 1e-12 kg, 1e14 N/m^3 and Q = 5000, told in four ways. */
static void resonator(void **state)
{
  static const char *const told[] = {
    OF_LENGTH SWEEP "&units natural_frequency='1.2 MHz' mass='1e-12 kg' /\n"
    "&pendulum force='polynomial' force_coefficients=1,0,'1e14 N/m^3' damping='Q 5000'\n"
    " drive_amplitude='694.8 pN' /\n",
    OF_LENGTH SWEEP "&units mass='1 ng' /\n&pendulum force='polynomial'\n"
    " force_coefficients='56.848921350274725 N/m', 0, '100 TN m-3' damping='1507.9644737231006 1/s'"
    " drive_amplitude='694.8e-12 N' /\n",
    OF_LENGTH SWEEP "&units natural_frequency=1.2d6 /\n&pendulum force='polynomial'\n"
    " force_coefficients='56.848921350274725 N/m', 0, '1e14 kg/m^2/s2' damping='240Hz'\n"
    " drive_amplitude='.6948nN' /\n",
    /* what stands in print: N/m with a superscript; the damping as a force at a velocity */
    OF_LENGTH SWEEP "&units natural_frequency=1.2d6 mass='1e-12 kg' /\n"
    "&pendulum force='polynomial' force_coefficients=1, 0, '1e14 N/m\302\263'\n"
    " damping='1.5079644737231006 nN s/m'\n"
    " drive_amplitude='694.8pN' /\n",
  };
  const double rate = 2 * PI * 1.2e6, k = 1e-12 * rate * rate, length = sqrt(k / 1e14);
  (void)state;
  for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
    deck d = read_twice(told[i]);
    assert_true(d.pendulum.force_coefficients[0] == 1.0);
    assert_true(d.pendulum.force_coefficients[1] == 0.0);
    assert_true(d.pendulum.force_coefficients[2] == 1.0);
    const deck_axis *drive = &d.axis[DECK_AXIS_DRIVE_AMPLITUDE];
    const deck_axis *frequency = &d.axis[DECK_AXIS_DRIVE_FREQUENCY];
    check_relative(d.axis[DECK_AXIS_DAMPING].value[0], 1.0 / 5000, 4 * rounding);
    check_relative(drive->value[0], 694.8e-12 / (k * length), 4 * rounding);
    check_relative(frequency->value[0], 1.199 / 1.2, rounding);
    check_relative(frequency->value[7], 1.206 / 1.2, rounding);
    check_relative(d.orbit.x, 2e-9 / length, rounding);
    check_relative(d.orbit.v, 1e-3 / (rate * length), rounding);
    check_relative(factor_of(&d, "drive_amplitude", "N"), k * length, 4 * rounding);
    check_relative(factor_of(&d, "parameter", "Hz"), 1.2e6, rounding);
    check_relative(factor_of(&d, "amplitude", "m"), length, rounding);
    check_relative(factor_of(&d, "loop_area", "J"), k * length * length, 4 * rounding);
    check_relative(factor_of(&d, "mean_power", "W"), k * length * length * rate, 4 * rounding);
    check_relative(factor_of(&d, "a3", "N m-3"), 1e14, 4 * rounding);
    check_relative(factor_of(&d, "lyapunov", "s-1"), rate, rounding);
    deck_si none;
    assert_false(deck_si_of(&d, "phase_lag", &none));
    assert_false(deck_si_of(&d, "parametric_amplitude", &none));
    assert_false(deck_si_of(&d, "jump_period", &none));
    /* What ends like a quantity is another one, or none. */
    assert_false(deck_si_of(&d, "terminal_velocity", &none));
    assert_false(deck_si_of(&d, "amplitude_error", &none));
    deck_free(&d);
  }
}

/* Without a stiffness at rest: two wells, a cubic force alone, and a linear one. */
static void other_forces(void **state)
{
  (void)state;
  deck d = read_twice(SCENE "&sweep drive_frequency_range='10 Hz','20 Hz',3 /\n"
                      "&units mass='2 g' /\n&pendulum force='polynomial'\n"
                      " force_coefficients='-8 N/m',0,'2 N/m^3'\n"
                      " damping='0.5 1/s' drive_amplitude='4 N' /\n");
  assert_true(d.pendulum.force_coefficients[0] == -1.0 && d.pendulum.force_coefficients[2] == 1.0);
  check_relative(factor_of(&d, "x", "m"), 2.0, rounding);
  check_relative(d.axis[DECK_AXIS_DRIVE_AMPLITUDE].value[0], 4.0 / 16.0, rounding);
  check_relative(d.axis[DECK_AXIS_DAMPING].value[0], 0.5 / sqrt(8 / 2e-3), rounding);
  deck_free(&d);
  /* k3 length^3 is the unit of force, sqrt(k3 length^2 / m) that of rates. */
  d = read_twice(OF_LENGTH "&sweep drive_frequency_range='1 Hz','2 Hz',3 /\n"
                 "&units mass=3 length='1 mm' /\n&pendulum force='polynomial'\n"
                 " force_coefficients=,,'12 MN/m^3' damping=0.1 drive_amplitude='24 mN' /\n");
  assert_true(d.pendulum.force_coefficients[2] == 1.0);
  check_relative(d.axis[DECK_AXIS_DRIVE_AMPLITUDE].value[0], 2.0, rounding);
  check_relative(factor_of(&d, "damping", "s-1"), sqrt(12e6 * 1e-6 / 3), rounding);
  deck_free(&d);
  /* A signal in volts: positions in either unit. */
  d = read_twice("&scene kind='orbit' /\n&orbit x='3 mV' v='2 nm/s' /\n"
                 "&units mass=1 length='1 nm' volts_per_length='2 mV/nm' /\n"
                 "&pendulum force='polynomial' drive_period='1 s'\n"
                 " force_coefficients='4 N/m' damping='Q 10' drive_amplitude='2 nN' /\n");
  check_relative(d.orbit.x, 1.5, rounding);
  check_relative(d.orbit.v, 1.0, rounding);
  check_relative(d.drive_period, 2.0, rounding);
  check_relative(d.pendulum.damping, 0.1, rounding);
  check_relative(d.pendulum.drive_amplitude, 0.5, rounding);
  check_relative(factor_of(&d, "first_harmonic_amplitude", "V"), 2e-3, rounding);
  check_relative(factor_of(&d, "v", "V s-1"), 4e-3, rounding);
  deck_free(&d);
}

/* beta_c = 2 e I_c R^2 C / hbar, damping 1/sqrt(beta_c); on the first Shapiro step of a drive of f
   the voltage is h f / (2 e). */
static void junction(void **state)
{
  const double hbar = planck / (2 * PI), current = 10e-6, r = 3, c = 1e-12, f = 30e9;
  const double beta_c = 2 * charge * current * r * r * c / hbar;
  (void)state;
  deck d = read_twice("&scene kind='hysteresis' /\n"
                      "&sweep torque_range='1 uA','11 \302\265A', 21 /\n"
                      "&units critical_current='10 uA' resistance='3 \316\251'\n"
                      " capacitance='1 pF' /\n"
                      "&pendulum drive_amplitude='5 uA' drive_frequency='30 GHz'\n"
                      " temperature='4.2 K' /\n&hysteresis x='90 deg' rate=1e-3 /\n");
  const double step = d.axis[DECK_AXIS_DRIVE_FREQUENCY].value[0];
  check_relative(d.axis[DECK_AXIS_DAMPING].value[0], 1 / sqrt(beta_c), rounding);
  check_relative(d.axis[DECK_AXIS_DRIVE_AMPLITUDE].value[0], 0.5, rounding);
  check_relative(d.axis[DECK_AXIS_TORQUE].value[20], 1.1, rounding);
  check_relative(d.axis[DECK_AXIS_TEMPERATURE].value[0],
                 boltzmann * 4.2 / (hbar * current / (2 * charge)), rounding);
  check_relative(d.orbit.x, PI / 2, rounding);
  check_relative(step * factor_of(&d, "mean_velocity", "V"), planck * f / (2 * charge),
                 2 * rounding);
  check_relative(factor_of(&d, "parameter", "A"), current, rounding);
  check_relative(factor_of(&d, "loop_area", "J"), hbar * current / (2 * charge), rounding);
  deck_free(&d);
  /* A ring: a1 = hbar / (2 e L I_c). */
  d = read_twice("&scene kind='orbit' /\n&orbit x=0 /\n&units critical_current='1 uA' /\n"
                 "&pendulum force_coefficients='100 pH' force='squid' damping=0.1\n"
                 " drive_frequency=1 drive_amplitude='0.1 uA' /\n");
  check_relative(d.pendulum.force_coefficients[0], hbar / (2 * charge) / (100e-12 * 1e-6),
                 rounding);
  deck_free(&d);
}

/* What a ramp does is in the unit of what is swept, wherever that stands. */
static void ramps(void **state)
{
  (void)state;
  deck d = read_twice("&scene kind='hysteresis' /\n&hysteresis x=1 rate='3 mHz' /\n"
                      "&units length='1 m' /\n&pendulum damping=0.1 drive_amplitude=0.2 /\n"
                      "&sweep drive_frequency_range='0.3 Hz','0.6 Hz',4 /\n");
  check_relative(d.ramp.rate, 3e-3 * 2 * PI / sqrt(9.80665), rounding);
  deck_free(&d);
  d = read_twice("&scene kind='hysteresis' /\n&units critical_current='2 uA' /\n"
                 "&hysteresis x=1 protocol=0,'1 uA',100,'2 uA',300,'3 uA' /\n"
                 "&pendulum damping=0.1 drive_amplitude=0.2 drive_frequency=1 /\n"
                 "&sweep torque='1 uA','3 uA' /\n");
  assert_true(d.ramp.protocol.number[3] == 1.0 && d.ramp.protocol.number[4] == 300.0);
  deck_free(&d);
}

static void pendulum(void **state)
{
  (void)state;
  deck d = read_twice("&scene kind='orbit' /\n&orbit x='90 deg' v='1 rad/s' /\n"
                      "&units length='25 cm' /\n"
                      "&pendulum damping='Q 9' drive_frequency='1 Hz' drive_amplitude=0.2 /\n");
  const double rate = sqrt(9.80665 / 0.25);
  check_relative(d.pendulum.drive_frequency, 2 * PI / rate, rounding);
  check_relative(d.pendulum.damping, 1.0 / 9, rounding);
  check_relative(d.orbit.v, 1 / rate, rounding);
  deck_si none;
  assert_false(deck_si_of(&d, "loop_area", &none));
  deck_free(&d);
  /* A rigid one: its frequency is its own. */
  d = read_twice("&scene kind='orbit' /\n&orbit x=1 /\n"
                 "&units natural_frequency='0.8 Hz' mass='200 g' length='25 cm' gravity=9.81 /\n"
                 "&pendulum damping='Q 9' drive_frequency='2 rad/s' drive_amplitude='0.1 N m' /\n");
  check_relative(d.pendulum.drive_frequency, 2 / (2 * PI * 0.8), rounding);
  check_relative(d.pendulum.drive_amplitude, 0.1 / (0.2 * 0.25 * 9.81), rounding);
  check_relative(factor_of(&d, "dissipation", "J"), 0.2 * 0.25 * 9.81, rounding);
  deck_free(&d);
  /* Numbers without units are what they are without scales, and need none. */
  d = read_twice("&scene kind='orbit' /\n&orbit x=1 /\n"
                 "&pendulum damping='Q = 8' drive_frequency=0.5 drive_amplitude=0.1 /\n");
  assert_true(d.pendulum.damping == 0.125 && !deck_has_units(&d));
  assert_false(deck_si_of(&d, "drive_frequency", &none));
  deck_free(&d);
}

#define POLYNOMIAL "&scene kind='hysteresis' /\n&pendulum force='polynomial' drive_amplitude="
#define REST " damping=0.1 /\n&sweep drive_frequency=1,2 /\n&hysteresis x=1 /\n"
#define ORBIT "&scene kind='orbit' /\n&orbit x=1 /\n&pendulum damping=0.1 drive_amplitude="

static const bad_deck bad[] = {
  /* units that are none, and that do not fit */
  { ORBIT "'1 pNm' drive_period=8 /", { "3:39 'pNm' is no unit" } },
  { ORBIT "0.1 drive_frequency='1.2 MHZ' /\n&units natural_frequency=1 /",
    { "3:59 'MHZ' is no unit (did you mean 'MHz'?)" } },
  { ORBIT "0.1 drive_frequency='1 khz' /\n&units natural_frequency=1 /",
    { "3:59 'khz' is no unit (did you mean 'kHz'?)" } },
  { ORBIT "0.1 drive_frequency='1.2 V' /\n&units natural_frequency=1 /",
    { "3:59 'drive_frequency' is in Hz or rad/s here: 'V' does not fit" } },
  { ORBIT "0.1 drive_frequency='1.2 1/s' /\n&units natural_frequency=1 /",
    { "3:59 is in Hz or rad/s here" } },
  { ORBIT "0.1 drive_period=8 force_coefficients='2 N/m' /",
    { "3:77 'force_coefficients' takes numbers without a unit here" } },
  { ORBIT "0.1 drive_period=8 /\n&units f0=1 stiffness=3 /",
    { "4:8 did you mean 'natural_frequency'?", "4:13 did you mean 'force_coefficients' in "
      "&pendulum?" } },
  { ORBIT "0.1 drive_period='1 s^' /\n&units natural_frequency=1 /", { "3:56 's^' is no unit" } },
  { ORBIT "0.1 drive_period='1 s99' /\n&units natural_frequency=1 /", { "3:56 is no unit" } },
  { ORBIT "0.1 drive_period='1' /", { "3:56 'drive_period' wants a number" } },
  { ORBIT "0.1 drive_period='s' /", { "3:56 'drive_period' wants a number" } },
  { ORBIT "0.1 drive_period='Q 8' /\n&units natural_frequency=1 /", { "3:56 'Q' is no unit" } },
  { ORBIT "0.1 drive_period=8 parametric_amplitude='1 Hz' /",
    { "3:79 'parametric_amplitude' takes numbers without a unit" } },
  { ORBIT "0.1 drive_period='-8 s' /\n&units natural_frequency=1 /", { "3:56 must be positive" } },
  { ORBIT "0.1 drive_period='1e400 s' /\n&units natural_frequency=1 /",
    { "3:56 is too large for a double" } },
  { "&scene kind='hysteresis' /\n&hysteresis x=1 rate='3 s' /\n&units natural_frequency=1 /\n"
    "&pendulum damping=0.1 drive_amplitude=0.2 /\n&sweep drive_frequency=1,2 /\n",
    { "2:22 'rate' is in Hz or rad/s here" } },
  { "&scene kind='orbit' /\n&orbit x=1 periods='3 s' /\n"
    "&pendulum damping=0.1 drive_amplitude=1 drive_period=8 /", { "2:20 a whole number" } },
  { ORBIT "1 drive_period=8 /\n&units mass='1 m' length='1 m' /", { "4:13 'mass' is in kg here" } },
  /* a resistance that is wrong is not called a missing damping, too */
  { "&scene kind='hysteresis' /\n&hysteresis x=1 /\n&pendulum drive_amplitude=0 /\n"
    "&sweep torque=0,1 /\n&units critical_current='1 uA' capacitance='1 pF' resistance='3 K' /",
    { "4:1 'drive_period' in &pendulum or &sweep", "5:62 'resistance' is in ohm here" } },
  { POLYNOMIAL "1 force_coefficients=1,0,'3 N/m^2'" REST, { "2:71 'a3' is in N m-3 here" } },
  { "&scene kind='orbit' /\n&orbit x=1 /\n&pendulum force='polynomial' damping='Q 5'"
    " drive_period=8 drive_amplitude=0 force_coefficients=-1,0,1 /",
    { "3:38 a quality factor needs a force that pulls back" } },
  { ORBIT "1 drive_period=8 /\n&units resistance=1 critical_current=1 capacitance=1 /",
    { "4:8 tells the damping, and so does 'damping'" } },
  /* scales that are not there */
  { ORBIT "'1 N m' drive_period=8 /", { "3:39 'drive_amplitude' in N m needs more of &units" } },
  { ORBIT "'1 A' drive_period=8 /", { "3:39 of a junction 'critical_current'" } },
  { ORBIT "0.1 drive_frequency='1.2 Hz' /", { "3:59 needs more of &units" } },
  { POLYNOMIAL "'1 pN' force_coefficients=1,0,1" REST "&units natural_frequency=1 length=1 /",
    { "2:46 for forces 'mass' in any case" } },
  { POLYNOMIAL "1 force_coefficients='1 N/m',0,1" REST,
    { "2:48 'force_coefficients' in SI need 'mass' or 'natural_frequency'" } },
  { POLYNOMIAL "1 force_coefficients=0,0,'1 N/m^3'" REST "&units mass=1 /",
    { "2:48 give 'length' in &units" } },
  { ORBIT "1 drive_period=8 force='squid' force_coefficients='1 nH' /",
    { "3:70 an inductance needs 'critical_current'" } },
  /* scales that contradict each other, or mean nothing */
  { POLYNOMIAL "'1 pN' force_coefficients='1 N/m',0,'1 N/m^3'" REST
    "&units natural_frequency=1 mass=1 /",
    { "5:8 'natural_frequency' follows from 'mass' and the stiffness" } },
  { ORBIT "1 drive_period=8 /\n&units natural_frequency=1 length=1 /",
    { "4:28 leave out 'natural_frequency' or give 'mass'" } },
  { ORBIT "1 drive_period=8 /\n&units natural_frequency=1 critical_current=1 capacitance=1 /",
    { "4:8 follows from 'critical_current' and 'capacitance' already" } },
  { ORBIT "1 drive_period=8 /\n&units critical_current=1 mass=1 capacitance=1 /",
    { "4:27 'mass' is an oscillator's or a pendulum's" } },
  { ORBIT "1 drive_period=8 /\n&units capacitance=1 gravity=1 /",
    { "4:8 it goes with 'critical_current'", "4:22 'gravity' goes with 'length'" } },
  { POLYNOMIAL "1 force_coefficients='1e300 N/m'" REST "&units mass=1d-90 /",
    { "5:1 must be below 1e100" } },
  { POLYNOMIAL "1 force_coefficients='1 N/m','1e-300 N/m^2'" REST "&units mass=1d-90 /",
    { "5:1 must be below 1e100" } },
  { ORBIT "1 drive_period=8 /\n&units mass=1 /", { "4:8 'mass' goes with 'length'" } },
  { ORBIT "1 drive_period=8 /\n&units mass=-1 lenght=1 /",
    { "4:13 'mass' must be positive", "4:16 did you mean 'length'?" } },
};

/* Every key whose numbers are in units of the model takes those of SI. */
static void keys(void **state)
{
  static const char *const ours[] = { "omega0", "1/omega0", "rad", "m g l", "m g l / k" };
  int wrong = 0;
  (void)state;
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *words = deck_table_words(&deck_table[i]);
    for (size_t k = 0; k < sizeof ours / sizeof *ours; k++) {
      if (deck_key_unit(words) == NULL || strcmp(deck_key_unit(words), ours[k]) != 0) continue;
      if (deck_unit_example(&deck_table[i]) != NULL) continue;
      print_error("%s takes no unit\n", deck_table[i].name);
      wrong++;
    }
  }
  assert_int_equal(wrong, 0);
}

/* The response of this resonator reaches F0 Q/k = 26.4 nm: starts are near, unless they are told,
   and not up to 4.7 units of length, 3.6 um. */
static void starts(void **state)
{
  (void)state;
  static const char text[] = "&scene kind='branches' /\n"
    "&units mass='1 ng' natural_frequency='1.2 MHz' /\n"
    "&pendulum force='polynomial' force_coefficients=1,0,'1e14 N/m^3' damping='Q 5000' /\n"
    "&sweep drive_amplitude='100 pN','300 pN' drive_frequency_range='1.199 MHz','1.206 MHz',9 /\n";
  char told[sizeof text + 60];
  deck d = read_twice(text);
  const double length = factor_of(&d, "x", "m");
  assert_true(d.ensemble.x_last * length > 26.4e-9 && d.ensemble.x_last * length < 60e-9);
  assert_true(d.ensemble.x_first == -d.ensemble.x_last);
  deck_free(&d);
  snprintf(told, sizeof told, "%s&ensemble x_first='-100 nm' /\n", text);
  d = read_twice(told);
  check_near(d.ensemble.x_first * length, -100e-9, 100e-9 * rounding);
  assert_true(d.ensemble.x_last * length < 60e-9);
  deck_free(&d);
}

static void bad_decks(void **state)
{
  int wrong = 0;
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) wrong += !is_refused(&bad[i]);
  assert_int_equal(wrong, 0);
}

/* Numbers of a unit in another: exact where only powers of ten differ. */
static void conversions(void **state)
{
  static const struct { const char *from, *to; double value, want, tolerance; } of[] = {
    { "MHz", "Hz", 1.2, 1.2e6, 0 },       { "pN", "N", 694.8, 694.8e-12, 2e-25 },
    { "N/m^3", "N m-3", 3, 3, 0 },        { "kg m-2 s-2", "N/m3", 3, 3, 0 },
    { "m/s^2", "mm s-2", 2, 2000, 0 },    { "g", "kg", 1, 1e-3, 0 },
    { "1/us", "s-1", 1, 1e6, 0 },         { "N*m", "J", 5, 5, 0 },
    { "cm.s-1", "m/s", 1, 0.01, 0 },      { "Hz", "rad/s", 1, 2 * PI, 1e-15 },
    { "deg", "rad", 180, PI, 1e-15 },     { "eV", "J", 1, 1.602176634e-19, 3e-35 },
    { "k\342\204\246", "ohm", 1, 1e3, 0 }, { "\316\274V", "V", 1, 1e-6, 0 },
    { "kOhm", "ohm", 1, 1e3, 0 },         { "N\302\267m\342\201\273\302\263", "N m-3", 3, 3, 0 },
    { "V/A", "ohm", 1, 1, 0 },            { "mS", "1/ohm", 1, 1e-3, 0 },
    { "Hz", "1/s", 1, 2 * PI, 1e-15 },
  };
  static const char *const none[] = { "Kg", "m^0", "N/", "2 m", "m s -1", "xHz", "mm^", "m^-" };
  si_unit from, to;
  char bad_part[SI_SYMBOL];
  (void)state;
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    assert_true(si_parse(of[i].from, &from, bad_part) && si_parse(of[i].to, &to, bad_part));
    if (!si_fits(&from, &to)) fail_msg("%s is no %s", of[i].from, of[i].to);
    check_near(si_convert(of[i].value, &from, &to), of[i].want, of[i].tolerance);
  }
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    if (si_parse(none[i], &from, bad_part)) fail_msg("'%s' is no unit", none[i]);
  double ten = 0;
  assert_string_equal(si_prefix_for(694.8e-12, &ten), "p");
  assert_string_equal(si_prefix_for(-1.2e6, &ten), "M");
  assert_true(ten == 1e6);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(conversions), cmocka_unit_test(resonator), cmocka_unit_test(other_forces),
    cmocka_unit_test(junction),    cmocka_unit_test(pendulum),  cmocka_unit_test(keys),
    cmocka_unit_test(ramps),       cmocka_unit_test(bad_decks),
    cmocka_unit_test(starts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
