/*
 * test_fit_data.c -- data of fits as instruments write them: units of columns, what stands around a
 * table, and how numbers are written. Values follow from the definitions of the units.
 */
#include "scene_fixture.h"

#include <math.h>

#include "scenes/fit/data.h"

enum { MOST = 12 };

/* What a file of data holds: axis, observed, error and other parameter of its data. */
typedef struct told {
  size_t n;
  double axis[MOST], observed[MOST], error[MOST], other[MOST];
  int direction[MOST];
} told;

/* Read a file with this text by a deck with these keys of &data, and groups; or NULL, and `words`
   are in what the failure says. */
static void read_data(const char *name, const char *text, const char *keys, const char *words,
                      told *out)
{
  char path[100], lines[1200];
  deck d;
  namelist_errors errors = {0};
  scene_run run = {.deck = &d};
  fit_data data;
  snprintf(path, sizeof path, "%s/%s", scene_folder, name);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  assert_true(fputs(text, f) >= 0);
  assert_int_equal(fclose(f), 0);
  snprintf(lines, sizeof lines, "&scene kind = 'fit' /\n&fit free = 'damping' %s /\n"
           "&pendulum drive_amplitude = 0.1 /\n&data file = '%s' %s /\n",
           strstr(keys, "s_parameter") != NULL ? ", model = 'notch'" : "", path, keys);
  if (deck_read_memory("test.nml", lines, strlen(lines), &d, &errors) != PENDRES_OK)
    fail_msg("%s: %s", keys, errors.count > 0 ? errors.item[0].text : "");
  fit_data_read(&run, &data);
  if (words != NULL) {
    if (strstr(run.message, words) == NULL) fail_msg("'%s' has no '%s'", run.message, words);
  } else {
    if (run.status != PENDRES_OK) fail_msg("%s", run.message);
    assert_true(data.of.n <= MOST);
    *out = (told){.n = data.of.n};
    for (size_t i = 0; i < data.of.n; i++) {
      out->axis[i] = data.datum[i].axis;
      out->observed[i] = data.datum[i].observed;
      out->error[i] = data.datum[i].error;
      out->other[i] = data.datum[i].other;
      out->direction[i] = data.datum[i].direction;
    }
  }
  scene_room_end(&run.room);
  deck_free(&d);
  namelist_errors_free(&errors);
}

static void check_exact(double value, double right)
{
  check_near(value, right, 4e-15 * fabs(right));
}

/* GHz, dB with their errors, dBm behind a loss, degrees of many turns: told by the deck, by names,
   by a line of units, and by the comment in front of the data. */
static void units(void **state)
{
  (void)state;
  static const char *const texts[] = {
    "f a e p\n4.5 -20 0.1 -30\n4.6 -14 0.1 -30\n",
    "f (GHz), a [dB], e, p_dBm\n4.5, -20, 0.1, -30\n4.6, -14, 0.1, -30\n",
    "f;a;e;p\n(GHz);(dB);(dB);dBm\n4.5;-20;0.1;-30\n4.6;-14;0.1;-30\n",
    "% made today\n% f (GHz)\ta (DB)\te\tp/dBm\n4.5\t-20\t0.1\t-30\n4.6\t-14\t0.1\t-30\n"};
  static const char columns[] = "columns = 'f', 'a', 'e', 'drive_amplitude=4', loss = 40";
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    char keys[200];
    told t;
    snprintf(keys, sizeof keys, "%s%s", columns,
             k == 0 ? ", units = 'GHz', 'dB', 'dB', 'dBm'" : "");
    read_data("units.txt", texts[k], keys, NULL, &t);
    assert_int_equal(t.n, 2);
    check_exact(t.axis[0], 4.5e9);
    check_exact(t.observed[0], 0.1);
    check_exact(t.observed[1], pow(10.0, -0.7));
    check_exact(t.error[0], 0.1 * 0.1 * log(10.0) / 20.0);
    check_exact(t.other[0], sqrt(50.0 * 1e-3 * 1e-7)); /* volts of 1e-10 W at 50 ohm */
  }
}

static void angles(void **state)
{
  (void)state;
  static const double right[] = {0.5 * PENDRES_PI, -0.5 * PENDRES_PI, 0.1 * PENDRES_PI};
  told t;
  read_data("angles.txt", "f (rad/s), \"phase (deg)\", e (mrad)\n1, 90, 2\n2, 270, 2\n3, -702, 2\n",
            "columns = '1', '2', '3', observable = 'phase_lag'", NULL, &t);
  for (int i = 0; i < 3; i++) {
    check_near(t.observed[i], right[i], 4e-15);
    check_exact(t.error[i], 2e-3);
    check_exact(t.axis[i], (i + 1) / (2.0 * PENDRES_PI));
  }
}

/* Decimal commas, exponents by D, thousands in quotes, other letters of up and down, numbers that
   are none, and tables within marks. */
static void numbers(void **state)
{
  (void)state;
  static const char named[] = "columns = 'f', 'a', 'direction=way'";
  static const struct { const char *text, *keys; } same[] = {
    {"f;a;way\n1200,5;0,25;Up\n1300;2,5D-1;DOWN\n", "decimal = 'comma'"},
    {"f,a,way\n\"1,200.5\",0.25,1\n\"1,300\",2.5d-1,-1\n", ""},
    {"Date\tnever\nf\t9\n\n[DATA]\nf\ta\tway\n1200.5\t0.25\tup\n1250\tNaN\tup\n1300\t.25\tdown\n",
     ""},
    {"!CSV A.01.01\n!kept\nBEGIN CH1_DATA\nf(Hz),a,way\n1200.5,0.25,up\n1300,0.25,down\nEND\n"
     "more\n", ""},
    {"%, x\nf a way\n1200.5 .25 up\n1250 nan up\n1300 .25 down\n", "format = 'labone'"}};
  for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
    char keys[200];
    told t;
    snprintf(keys, sizeof keys, "%s %s", named, same[k].keys);
    read_data("numbers.txt", same[k].text, keys, NULL, &t);
    assert_int_equal(t.n, 2);
    for (int i = 0; i < 2; i++) {
      check_exact(t.axis[i], i == 0 ? 1200.5 : 1300.0);
      check_exact(t.observed[i], 0.25);
      assert_int_equal(t.direction[i], i == 0 ? 1 : -1);
    }
  }
}

/* An S-parameter by its parts, or as magnitude and phase in any unit, and times that run the other
   way. */
static void parameters(void **state)
{
  (void)state;
  static const double right[] = {0.3, -0.4};
  static const struct { const char *text, *keys; } same[] = {
    {"5, 0.3, -0.4\n", ""}, {"5, 0.3, 0.4\n", ", time_sign = -1"},
    {"f, m, p\n5, 0.5, -0.9272952180016122\n", ", units = '1', '1', 'rad'"},
    {"f, m (dB), p (deg)\n5, -6.020599913279624, 1386.869897645844\n", ""}};
  for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
    char keys[200];
    told t;
    snprintf(keys, sizeof keys,
             "observable = 's_parameter', columns = '1', '2', '3', error = 0.1%s", same[k].keys);
    read_data("s.csv", same[k].text, keys, NULL, &t);
    assert_int_equal(t.n, 2);
    for (int i = 0; i < 2; i++) check_near(t.observed[i], right[i], 1e-13);
    assert_true(t.error[0] == t.error[1]);
  }
  told t;
  read_data("q.csv", "5 0.3 -0.4\n", "observable = 'in_phase', 'quadrature', time_sign = 1", NULL,
            &t);
  assert_true(t.observed[0] == 0.3 && t.observed[1] == 0.4);
}

/* What the specifications of Touchstone 1.1 and 2.1 allow and readers get wrong. */
static void touchstone(void **state)
{
  (void)state;
  static const char two[] = "\n1 1 2 3 4 5 6 7 8\n2 1 2 3 4 5 6 7 8\n";
  static const char v2[] = "[Version] 2.0\n# GHz S RI R 50\n[Number of Ports] ";
  static const struct {
    const char *name, *head, *data, *column;
    double frequency, real, imaginary;
  } valid[] = {
    {"a.s2p", "! a\n# GHz S RI R 50 ! b", two, "S21", 1e9, 3, 4},
    {"a.s2p", "# RI R 50 S mhz", two, "S12", 1e6, 5, 6},
    {"a.s2p", "# R 50 RI", two, "S22", 1e9, 7, 8},
    {"a.S2P", "#", "\n1 1 90 2 180 5 6 7 8\n2 1 2 3 4 5 6 7 8\n", "S11", 1e9, 0, 1},
    {"a.s2p", "# hz db", "\n1 0 0 20 90 0 0 0 0\n2 1 2 3 4 5 6 7 8\n", "s21", 1, 0, 10},
    {"a.s2p", "# Hz S RI\n# GHz Z MA", two, "S21", 1, 3, 4},
    {"a.s2p", "# Hz S RI", "\n1 1 2 3 4 5 6 7 8\n2 1 2 3 4 5 6 7 8\n1 2 3 4 5\n", "S21", 1, 3, 4},
    {"a.s2p", "# Hz Z RI R 10", two, "Z21", 1, 30, 40},
    {"a.s2p", "# Hz Y RI R 10", two, "Y21", 1, 0.3, 0.4},
    {"a.s2p", "# Hz H RI R 10", two, "H11", 1, 10, 20},
    {"a.s2p", "# Hz H RI R 10", two, "H22", 1, 0.7, 0.8},
    {"a.s2p", "# Hz H RI R 10", two, "H21", 1, 3, 4},
    {"a.s2p", "# Hz G RI R 10", two, "G11", 1, 0.1, 0.2},
    {"a.s2p", "# Hz G RI R 10", two, "G22", 1, 70, 80},
    {"a.txt", "! by content\n# Hz S RI R 50", two, "S21", 1, 3, 4},
    {"a.s3p", "# Hz S RI", "\n1 1 0 2 0 3 0\n 4 0 5 0 6 0\n 7 0 8 0 9 0\n2 1 0 2 0 3 0\n"
     "4 0 5 0 6 0\n7 0 8 0 9 0\n", "S21", 1, 4, 0},
    {"a.ts", v2, "2\n[Two-Port Data Order] 12_21\n[Network Data]\n1 1 2 3 4 5 6 7 8\n"
     "2 1 2 3 4 5 6 7 8\n[End]\nmore\n", "S21", 1e9, 5, 6},
    {"a.ts", v2, "2\n[Two-Port Data Order] 21_12\n[Number of Frequencies] 2\n[Reference] 50\n 75\n"
     "[Network Data]\n1 1 2 3 4 5 6 7 8\n2 1 2 3 4 5 6 7 8\n[Noise Data]\n1 2 3 4 5\n[End]\n",
     "S21", 1e9, 3, 4},
    {"a.ts", v2, "3\n[Matrix Format] Lower\n[Begin Information]\n[Anything] x\n"
     "[End Information]\n[Network Data]\n1 1 0\n 2 0 3 0\n 4 0 5 0 6 0\n"
     "2 1 0 2 0 3 0 4 0 5 0 6 0\n", "S23", 1e9, 5, 0},
    {"a.ts", v2, "3\n[Matrix Format] Upper\n[Network Data]\n1 1 0 2 0 3 0\n 4 0 5 0\n 6 0\n"
     "2 1 0 2 0 3 0 4 0 5 0 6 0\n", "S31", 1e9, 3, 0},
    {"a.ts", "[Version] 2.0\n# Hz Y RI R 10\n[Number of Ports] 1\n[Network Data]",
     "\n1 3 4\n2 3 4\n", "Y11", 1, 3, 4}};
  for (size_t k = 0; k < sizeof valid / sizeof *valid; k++) {
    char text[500], keys[100];
    told t;
    snprintf(text, sizeof text, "%s%s", valid[k].head, valid[k].data);
    snprintf(keys, sizeof keys, "observable = 's_parameter', columns = '%s'", valid[k].column);
    read_data(valid[k].name, text, keys, NULL, &t);
    assert_int_equal(t.n, 4);
    check_exact(t.axis[0], valid[k].frequency);
    check_near(t.observed[0], valid[k].real, 1e-14 * fabs(valid[k].real) + 1e-15);
    check_near(t.observed[1], valid[k].imaginary, 1e-14 * fabs(valid[k].imaginary) + 1e-15);
  }
  static const struct { const char *name, *text, *words; } bad[] = {
    {"a.s2p", "# Hz S RI X\n", "a.s2p:1: the option line has no such word as 'X'"},
    {"a.s2p", "# Hz S RI\n1 2 3 4 5 6 7 8 9 1\n", "a.s2p:2: the line has more numbers"},
    {"a.s2p", "# Hz S RI\n1 2 3 4 x\n", "a.s2p:2: this is no number: 'x'"},
    {"a.s2p", "# Hz S RI\n1 2 3\n", "is not complete"},
    {"a.s2p", "# Hz S RI\n1 2 3 4\n", "a.s2p:2: one of a pair"},
    {"a.s2p", "# Hz S RI\n1 1 1\n2 1 1\n3 1 1\n", "a.s2p:3: pairs of the matrix before this line"},
    {"a.s1p", "# Hz S RI\n2 1 1\n1 1 1\n", "a.s1p:3: frequencies ascend"},
    {"a.ts", "[Version] 2.0\n[Mixed-Mode Order] D2,3\n", "mixed modes"},
    {"a.s9p", "# Hz S RI\n1 1 1\n", "more than 5 ports"},
    {"a.s1p", "# Hz S RI\n1 1 1\n", "there is no column 'S21'"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    read_data(bad[k].name, bad[k].text, "observable = 's_parameter', columns = 'S21'", bad[k].words,
              NULL);
}

/* All that can be measured has a name in files of results. */
static void named(void **state)
{
  (void)state;
  static const char deck_text[] =
    "&scene kind = 'fit' /\n&pendulum force = 'polynomial', force_coefficients = 1 /\n"
    "&data file = '%s', observable = 's_parameter', error = 0.01, columns = 'f', 're', 'im' /\n"
    "&fit model = 'reflection', free = 'internal_q', 'coupling_q' /\n";
  char path[100], lines[700], *names = NULL;
  scene_path("named", path);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "f,re,im\n");
  for (int i = -5; i <= 5; i++) /* Q 20, half of it by the line: S is 0 on resonance */
    fprintf(f, "%.17g,%.17g,%.17g\n", 1.0 + 0.02 * i, 0.64 * i * i / (1.0 + 0.64 * i * i),
            0.8 * i / (1.0 + 0.64 * i * i));
  assert_int_equal(fclose(f), 0);
  snprintf(lines, sizeof lines, deck_text, path);
  (void)scene_run_marked(NULL, lines, 1, "names");
  pendres_store *s = scene_open("names");
  check_ok(pendres_store_read_attribute_text(s, NULL, "datum_observable", "flag_meanings", &names));
  assert_non_null(strstr(names, "reflection_imaginary"));
  free(names);
  pendres_store_free(s);
}

static void refused(void **state)
{
  (void)state;
  static const char two[] = "columns = '1', '2'",
                    phase[] = "columns = '1', '2', observable = 'phase_lag'",
                    parts[] = "columns = '1', '2', '3', observable = 's_parameter'";
  static const struct { const char *text, *keys, *words; } bad[] = {
    {"f (V), a\n1, 2\n", two, "is in 'V', and is to be the drive_frequency, in Hz"},
    {"f (1/s), a\n1, 2\n", two, "in Hz"},
    {"f, a (dB)\n1, 2\n", phase, "is in 'dB', and is to be the phase_lag, in rad"},
    {"f, a\n1, 2\n", "columns = '1', '2', observable = 'loop_area', units = 'Hz', 'dB'",
     "10^(dB/10)"},
    {"f, a, e (dB)\n1, 2, 3\n", "columns = '1', '2', '3'", "tell both"},
    {"f, a\n1, 2\n", "columns = '1', '2', units = 'Hz', 'V', 'V'", "3 units for 2 columns"},
    {"f, a\n", "", "there are no data"},
    {"1,2\n", "format = 'nanonis'", "has a line [DATA]"},
    {"BEGIN A\n1,2\nBEGIN B\n1,2\n", "", "there are several tables"},
    {"1;0.2\n1;0,2\n", "", "tell data.decimal"},
    {"1;0.2\n1;\"1,234\"\n", "", "tell data.decimal"},
    {"1, 0.2, 0.1\n", "columns = '1', '2', 'direction=3'", "not 0.1 as in column 3"},
    {"f, p (deg), m\n1, 2, 3\n", parts, "column 2 is an angle"},
    {"f, m, phase\n1, 2, 3\n", parts, "column 3 is a phase without a unit"},
    {"f, m\n1, 2\n", "observable = 's_parameter', columns = '1', '2'", "'s_parameter' is known"},
    {"1,2\n3,\"1,23\"\n", "", "data.txt:2: '1,23' in column 2 is no number"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    read_data("data.txt", bad[k].text, bad[k].keys, bad[k].words, NULL);
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a', units = 'HzV' /\n"
                      "&fit free = 'damping' /\n", "'HzV' is no unit");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(units), cmocka_unit_test(angles), cmocka_unit_test(numbers),
    cmocka_unit_test(parameters), cmocka_unit_test(touchstone), cmocka_unit_test(named),
    cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
