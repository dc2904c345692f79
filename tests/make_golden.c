/*
 * make_golden.c -- prints tests/golden.h: reference numbers for all other tests.
 *
 * Every number comes from the long double Taylor reference (pendres/reference.h), which
 * shares no code with what it is there to judge. Not part of the test run; to repeat it,
 * after `make`, on a machine whose long double has at least 64 bits (x86):
 *
 *     gcc -std=c11 -O2 -Iinclude tests/make_golden.c src/reference*.c \
 *         src/model/pendulum.c -lgsl -lgslcblas -lm -o make_golden && ./make_golden >
 *         tests/golden.h
 *
 * (some ten seconds). The output is the same on every run. Numbers are kept although
 * they could be computed again in a test, so that a mistake made later in reference.c shows.
 *
 * How many digits are right: the same code in 113 bit arithmetic gave, as largest differences,
 * relative, 1e-15 (states after 100 periods where growth is largest), 1e-18 (measures of orbits,
 * their points 2e-17), 1e-19 (frequencies of resonances and folds), 3e-19 (frequencies and
 * dampings of cusps and symmetry breakings; points and measures of cusps 2e-16), 3e-15 (slopes).
 */
#include "oracle/reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef reference_cycle cycle;

static void need(pendres_status status, const char *what)
{
  if (status == PENDRES_OK) return;
  fprintf(stderr, "make_golden: %s: %s\n", what, pendres_status_message(status));
  exit(1);
}

/* A double in as few digits as give it back. */
static void print_double(const char *name, double value)
{
  char text[40];
  for (int digits = 1; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, NULL) == value) break;
  }
  printf(".%s = %s", name, text);
}

static void print_long(const char *name, long double value, const char *after)
{
  if (isnan(value)) printf(".%s = NAN%s", name, after);
  else printf(".%s = %.21LgL%s", name, value, after);
}

static void print_parameter(const char *name, long double value, const char *after)
{
  if ((long double)(double)value == value) {
    print_double(name, (double)value);
    printf("%s", after);
  } else {
    print_long(name, value, after);
  }
}

static void print_cycle(const char *comment, const cycle *c)
{
  printf("  { /* %s */\n    ", comment);
  print_parameter("damping", c->damping, ", ");
  print_parameter("drive_amplitude", c->drive_amplitude, ",\n    ");
  print_parameter("drive_frequency", c->drive_frequency, ",\n    ");
  print_long("y", c->y, ", ");
  print_long("v", c->v, ",\n    ");
  printf(".period = %ld, .winding = %ld,\n    ", c->period, c->winding);
  printf(".multiplier_re = { %.21LgL, %.21LgL },\n    ", c->multiplier_re[0], c->multiplier_re[1]);
  printf(".multiplier_im = { %.21LgL, %.21LgL },\n    ", c->multiplier_im[0], c->multiplier_im[1]);
  printf(".monodromy = { { %.21LgL, %.21LgL },\n                   { %.21LgL, %.21LgL } },\n    ",
         c->monodromy[0][0], c->monodromy[0][1], c->monodromy[1][0], c->monodromy[1][1]);
  print_long("loop_area", c->loop_area, ", ");
  print_long("dissipation", c->dissipation, ",\n    ");
  print_long("amplitude", c->amplitude, ",\n    ");
  print_long("first_harmonic_amplitude", c->first_harmonic_amplitude, ",\n    ");
  print_long("phase_lag", c->phase_lag, ", ");
  print_long("mean_power", c->mean_power, ",\n    ");
  print_long("loop_area_slope", c->loop_area_slope, ",\n    ");
  if (isnan(c->state_slope[0])) printf(".state_slope = { NAN, NAN },\n    ");
  else printf(".state_slope = { %.21LgL, %.21LgL },\n    ", c->state_slope[0], c->state_slope[1]);
  printf(".closure = %.1Lg, .energy_residual = %.1Lg, .liouville_residual = %.1Lg },\n",
         c->closure, c->energy_residual, c->liouville_residual);
}

/* Strobe states. */

typedef struct start {
  double damping, drive_amplitude, drive_frequency, y, v;
  const char *comment;
} start;

static const start states[] = {
  { 0.12, 0.2, 0.78539816339744828, 0.5, 0.0, "to the small orbit" },
  { 0.12, 0.2, 0.78539816339744828, -2.5, 0.0, "to the large orbit" },
  { 0.24, 0.2, 0.94, 1.0, 0.5, "near resonance" },
  { 1.0, 0.2, 0.7, 3.0, -1.0, "strong damping" },
  { 3.0, 0.2, 0.3, 2.0, 0.0, "overdamped and slow" },
  { 0.06, 0.2, 0.85, 0.3, 0.0, "weak damping" },
  { 0.06, 0.1, 1.2, -1.0, 2.5, "over the barrier first" },
  { 0.3, -0.2, 0.9, 1.0, 0.0, "drive of the other sign" },
  { 0.1, 1e-6, 1.0, 0.0, 0.0, "linear" },
  { 0.0, 0.0, 1.0, 3.1, 0.0, "free, near the barrier top" },
  { 0.0, 0.0, 0.7, 0.0, 2.5, "free, rotating" },
  { 0.5, 0.9, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, period one" },
  { 0.5, 1.07, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, period two" },
  { 0.5, 1.35, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, running" },
};

static long double growth(const reference_image *image)
{
  long double largest = 0.0L;
  for (int i = 0; i < 4; i++)
    largest = fmaxl(largest, fabsl(image->monodromy[i / 2][i % 2]));
  return largest;
}

static void print_states(void)
{
  printf("/* From (y, v) at drive phase 0, `periods` drive periods on: angle end_y + 2 pi turns.\n"
         "   growth: largest entry of the monodromy matrix, by which errors of the start grow. */\n"
         "typedef struct golden_state {\n  pendres_pendulum pendulum;\n  double y, v;\n"
         "  long periods, turns;\n  long double end_y, end_v, growth;\n} golden_state;\n\n"
         "static const golden_state golden_states[] = {\n");
  for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
    const start *s = &states[i];
    const pendres_pendulum p = { s->damping, s->drive_amplitude, s->drive_frequency, 0.0 };
    for (long periods = 10; periods <= 100; periods *= 10) {
      reference_image image;
      need(reference_map(&p, s->y, s->v, periods, &image), s->comment);
      printf("  { /* %s */\n    { ", s->comment);
      print_double("damping", p.damping);
      printf(", ");
      print_double("drive_amplitude", p.drive_amplitude);
      printf(", ");
      print_double("drive_frequency", p.drive_frequency);
      printf(" },\n    ");
      print_double("y", s->y);
      printf(", ");
      print_double("v", s->v);
      printf(", .periods = %ld, .turns = %ld,\n    ", periods, image.turns);
      print_long("end_y", image.y, ", ");
      print_long("end_v", image.v, ",\n    ");
      printf(".growth = %.3LgL },\n", growth(&image));
    }
  }
  printf("};\n\n");
}

/* Orbits. */

typedef struct settled {
  start from;
  long period, winding;
} settled;

static const settled orbits[] = {
  { { 0.06, 0.2, 0.7, 0.3, 0.0, "SA" }, 1, 0 },
  { { 0.06, 0.2, 0.7, -2.0, 0.7, "LA" }, 1, 0 },
  { { 0.06, 0.2, 0.553, -2.52, 0.58, "LA, mirror symmetry broken" }, 1, 0 },
  { { 0.06, 0.2, 1.2, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.1, 0.2, 0.82, 0.7, 0.2, "SA" }, 1, 0 },
  { { 0.1, 0.2, 0.82, -1.2, 1.2, "LA" }, 1, 0 },
  { { 0.12, 0.2, 0.78539816339744828, 0.5, 0.1, "SA, tau = 8" }, 1, 0 },
  { { 0.12, 0.2, 0.78539816339744828, -0.7, 1.5, "LA, tau = 8" }, 1, 0 },
  { { 0.13, 0.2, 0.8, 0.6, 0.1, "SA" }, 1, 0 },
  { { 0.13, 0.2, 0.8, -0.3, 1.6, "LA" }, 1, 0 },
  { { 0.15, 0.2, 0.84, 0.7, 0.3, "SA" }, 1, 0 },
  { { 0.15, 0.2, 0.84, 0.3, 1.3, "LA" }, 1, 0 },
  { { 0.24, 0.2, 0.94, 0.1, 0.8, "single" }, 1, 0 },
  { { 0.38, 0.2, 0.96, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.5, 0.2, 1.2, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.8, 0.2, 0.5, 0.0, 0.0, "single" }, 1, 0 },
  { { 1.0, 0.2, 0.7, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.07, 0.1, 0.88, 0.0, 0.0, "SA" }, 1, 0 },
  { { 0.07, 0.1, 0.88, -0.5, 1.2, "LA" }, 1, 0 },
  { { 0.06, 0.1, 1.0, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.28, 0.1, 0.98, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.5, 0.1, 0.8, 0.0, 0.0, "single" }, 1, 0 },
  { { 1.0, 0.1, 1.1, 0.0, 0.0, "single" }, 1, 0 },
  { { 0.5, 0.9, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, mirror symmetric" }, 1, 0 },
  { { 0.5, 1.07, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, period two" }, 2, 0 },
  { { 0.5, 1.35, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, running" }, 1, 1 },
  { { 0.5, 1.47, 2.0 / 3.0, 0.2, 0.0, "Baker and Gollub, running, period four" }, 4, 4 },
};

/* Let it settle, then close. The winding's sign is the start's. */
static void settle(const settled *s, cycle *out)
{
  const start *f = &s->from;
  const pendres_pendulum p = { f->damping, f->drive_amplitude, f->drive_frequency, 0.0 };
  long double y = f->y, v = f->v;
  long turns = 0;
  need(reference_advance(&p, &y, &v, &turns, 500), f->comment);
  const long before = turns;
  const long double from = y;
  long double end_y = y, end_v = v;
  need(reference_advance(&p, &end_y, &end_v, &turns, s->period), f->comment);
  const long winding = turns - before + lroundl((end_y - from) / 6.28L);
  if (labs(winding) != s->winding) {
    fprintf(stderr, "make_golden: %s: winding %ld\n", f->comment, winding);
    exit(1);
  }
  need(reference_orbit(&p, y, v, s->period, winding, out), f->comment);
}

static void print_orbits(void)
{
  printf("/* Closed orbits and their measures. */\n"
         "static const reference_cycle golden_orbits[] = {\n");
  for (size_t i = 0; i < sizeof orbits / sizeof orbits[0]; i++) {
    cycle c;
    settle(&orbits[i], &c);
    print_cycle(orbits[i].from.comment, &c);
  }
  printf("};\n\n");
}

/* Resonances. */

static const settled peaks[] = {
  { { 0.24, 0.2, 0.94, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.32, 0.2, 0.96, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.38, 0.2, 0.96, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.5, 0.2, 0.96, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.8, 0.2, 0.92, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.9, 0.2, 0.90, 0.0, 0.5, "single" }, 1, 0 },
  { { 1.0, 0.2, 0.87, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.18, 0.2, 0.9, 0.0, 0.5, "single, just above the cusp" }, 1, 0 },
  { { 0.15, 0.2, 0.84, 0.3, 1.3, "of LA, beside SA" }, 1, 0 },
  { { 0.13, 0.2, 0.77, 0.0, 1.6, "of LA, beside SA" }, 1, 0 },
  { { 0.28, 0.1, 0.98, 0.0, 0.5, "single" }, 1, 0 },
  { { 0.14, 0.1, 0.96, 0.0, 0.5, "single" }, 1, 0 },
};

static void print_resonances(void)
{
  printf("/* Largest loop area over the drive frequency along a branch; not the edge where the\n"
         "   branch of an ensemble changes. */\n"
         "static const reference_cycle golden_resonances[] = {\n");
  for (size_t i = 0; i < sizeof peaks / sizeof peaks[0]; i++) {
    const start *f = &peaks[i].from;
    const pendres_pendulum p = { f->damping, f->drive_amplitude, f->drive_frequency, 0.0 };
    cycle c;
    settle(&peaks[i], &c);
    need(reference_find(REFERENCE_RESONANCE, &p,
                                &(reference_guess){c.drive_frequency, c.y, c.v, 0.0L},
                                &c), f->comment);
    print_cycle(f->comment, &c);
  }
  printf("};\n\n");
}

/* Ends of branches. */

/* Follow a stable branch in steps of the drive frequency to where it ends. */
static void follow(const settled *s, double step, cycle *at)
{
  settle(s, at);
  while (fabs(step) > 1e-6) {
    const pendres_pendulum p = { s->from.damping, s->from.drive_amplitude,
                                 (double)at->drive_frequency + step, 0.0 };
    cycle next;
    const pendres_status status =
        reference_orbit(&p, at->y + step * at->state_slope[0],
                                at->v + step * at->state_slope[1], 1, 0, &next);
    if (status != PENDRES_OK || hypotl(next.y - at->y, next.v - at->v) > 0.15L ||
        next.multiplier_re[0] > 1.0L)
      step /= 2.0;
    else
      *at = next;
  }
}

static const struct {
  settled from;
  double step;
  const char *comment;
} ends[] = {
  { { { 0.06, 0.2, 0.8, 0.3, 0.0, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.1, 0.2, 0.8, 0.6, 0.1, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.12, 0.2, 0.8, 0.6, 0.1, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.125, 0.2, 0.785, -0.5, 1.6, "LA" }, 1, 0 }, -0.01, "LA ends" },
  { { { 0.13, 0.2, 0.8, 0.6, 0.1, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.13, 0.2, 0.8, -0.3, 1.6, "LA" }, 1, 0 }, -0.01, "LA ends" },
  { { { 0.14, 0.2, 0.82, 0.7, 0.3, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.14, 0.2, 0.82, 0.0, 1.5, "LA" }, 1, 0 }, -0.01, "LA ends" },
  { { { 0.15, 0.2, 0.84, 0.7, 0.3, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.15, 0.2, 0.84, 0.3, 1.3, "LA" }, 1, 0 }, -0.01, "LA ends" },
  { { { 0.16, 0.2, 0.85, 0.7, 0.4, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.07, 0.1, 0.88, 0.0, 0.0, "SA" }, 1, 0 }, 0.01, "SA ends" },
  { { { 0.07, 0.1, 0.88, -0.5, 1.2, "LA" }, 1, 0 }, -0.01, "LA ends" },
};

static void print_folds(void)
{
  printf("/* Folds: the drive frequency at which a branch ends, Floquet multiplier +1. */\n"
         "static const reference_cycle golden_folds[] = {\n");
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    const start *f = &ends[i].from.from;
    const pendres_pendulum p = { f->damping, f->drive_amplitude, f->drive_frequency, 0.0 };
    cycle c;
    follow(&ends[i].from, ends[i].step, &c);
    need(reference_find(REFERENCE_FOLD, &p,
                                &(reference_guess){c.drive_frequency, c.y, c.v, 0.0L},
                                &c), ends[i].comment);
    print_cycle(ends[i].comment, &c);
  }
  printf("};\n\n");
}

static const settled symmetric[] = {
  { { 0.06, 0.2, 0.6, -2.4, 0.63, "LA" }, 1, 0 },
  { { 0.1, 0.2, 0.6, -1.5, 1.4, "LA" }, 1, 0 },
  { { 0.12, 0.2, 0.78539816339744828, -0.7, 1.5, "LA" }, 1, 0 },
};

static void print_symmetry_breakings(void)
{
  printf("/* Large-amplitude branches of small damping do not fold: below these drive frequencies\n"
         "   the symmetric orbit is unstable, and a stable pair of mirror images takes over. */\n"
         "static const reference_cycle golden_symmetry_breakings[] = {\n");
  for (size_t i = 0; i < sizeof symmetric / sizeof symmetric[0]; i++) {
    const start *f = &symmetric[i].from;
    const pendres_pendulum p = { f->damping, f->drive_amplitude, f->drive_frequency, 0.0 };
    cycle c;
    follow(&symmetric[i], -0.01, &c);
    need(reference_find(REFERENCE_SYMMETRY_BREAKING, &p,
                                &(reference_guess){c.drive_frequency, c.y, c.v, 0.0L},
                                &c), f->comment);
    print_cycle(f->comment, &c);
  }
  printf("};\n\n");
}

static void print_cusps(void)
{
  static const start near[] = {
    { 0.099, 0.1, 0.91, 0.6, 0.6, "both folds meet" },
    { 0.164, 0.2, 0.855, 0.7, 0.7, "both folds meet" },
  };
  printf("/* Cusps: damping and drive frequency at which both folds meet. */\n"
         "static const reference_cycle golden_cusps[] = {\n");
  for (size_t i = 0; i < sizeof near / sizeof near[0]; i++) {
    const start *f = &near[i];
    const pendres_pendulum p = { f->damping, f->drive_amplitude, f->drive_frequency, 0.0 };
    cycle c;
    need(reference_find(REFERENCE_CUSP, &p,
                                &(reference_guess){f->drive_frequency, f->y, f->v,
                                                           f->damping},
                                &c), f->comment);
    print_cycle(f->comment, &c);
  }
  printf("};\n\n");
}

/* Shares of the two orbits in the ensemble x = -pi/2 + 2 pi k/200 (doubles), v = 0. */

static void print_shares(void)
{
  static const double at[][3] = {
    { 0.06, 0.2, 0.7 }, { 0.12, 0.2, 0.78539816339744828 }, { 0.13, 0.2, 0.8 },
    { 0.15, 0.2, 0.84 }, { 0.07, 0.1, 0.88 },
  };
  printf("/* How many of the 200 members x = -pi/2 + 2 pi k/200, k = 1..200, v = 0 (x formed in\n"
         "   double as written) settle on the orbit of small or of large phase lag, and the mean\n"
         "   of their loop areas. */\n"
         "typedef struct golden_share {\n  pendres_pendulum pendulum;\n  int small, large;\n"
         "  long double mean_loop_area;\n} golden_share;\n\n"
         "static const golden_share golden_shares[] = {\n");
  for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
    const pendres_pendulum p = { at[i][0], at[i][1], at[i][2], 0.0 };
    int small = 0, large = 0;
    long double sum = 0.0L;
    for (int k = 1; k <= 200; k++) {
      const double half_pi = 1.57079632679489661923, two_pi = 6.28318530717958647693;
      const double x = -half_pi + two_pi * k / 200.0;
      long double y = x - 1.57079632679489661923132169163975144L, v = 0.0L;
      long turns = 0;
      cycle c;
      need(reference_advance(&p, &y, &v, &turns, 60), "share");
      need(reference_orbit(&p, y, v, 1, 0, &c), "share");
      if (hypotl(c.multiplier_re[0], c.multiplier_im[0]) > 1.0L ||
          hypotl(c.y - y, c.v - v) > 0.1L) {
        fprintf(stderr, "make_golden: member %d has not settled\n", k);
        exit(1);
      }
      if (c.phase_lag < 1.0471975511965977L) small++;
      else large++;
      sum += c.loop_area;
    }
    printf("  { { ");
    print_double("damping", p.damping);
    printf(", ");
    print_double("drive_amplitude", p.drive_amplitude);
    printf(", ");
    print_double("drive_frequency", p.drive_frequency);
    printf(" },\n    .small = %d, .large = %d, ", small, large);
    print_long("mean_loop_area", sum / 200.0L, " },\n");
  }
  printf("};\n\n");
}

int main(void)
{
  printf("/*\n"
         " * golden.h -- reference numbers, generated by tests/make_golden.c; do not edit.\n"
         " *\n"
         " * Angles y = x - pi/2; definitions: pendres/reference.h. Parameters written without L\n"
         " * are doubles, the others are results and are rounded when used as doubles. All digits\n"
         " * of a 64 bit significand are given; how many are right is said in make_golden.c.\n"
         " */\n"
         "#ifndef GOLDEN_H\n#define GOLDEN_H\n\n#include <math.h>\n\n"
         "#include "oracle/reference.h"\n\n");
  print_states();
  print_orbits();
  print_resonances();
  print_folds();
  print_symmetry_breakings();
  print_cusps();
  print_shares();
  printf("#endif\n");
  return fflush(stdout) == 0 && ferror(stdout) == 0 ? 0 : 1;
}
