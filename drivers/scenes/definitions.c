/*
 * definitions.c -- what the measures in a file are: the attribute `comment` of each, in one
 * place for all scenes. Units are those of the equation (docs/your_pendulum.md has a
 * laboratory's).
 */
#include "scenes/scene.h"

#include <string.h>

/* Names of results that mean the same in every file, beside the measures of orbits that the library
   defines; and what they are where x is no angle, if that is something else. */
static const struct { const char *name, *definition, *no_angle; } definitions[] = {
  { "x", "the particle's coordinate in the potential -sin x; the pendulum's angle from rest is "
         "x - pi/2",
    "the oscillator's coordinate, in the units of its equation" },
  { "v", "dx/dt, in units of omega0",
    "dx/dt" },
  { "temperature", "T = k T / (m g l); the potential's barrier is 2",
    "T, of the noise sqrt(2 damping T) xi(t)" },
  { "mean_loop_area", "mean over the members of the work of the drive a drive cycle, the closed "
                      "integral of F dx, in m g l",
    "mean over the members of the work of the drive a drive cycle, the closed integral of F "
    "dx" },
  { "mean_loop_amplitude", "half peak to peak of the loop averaged over the members, each shifted "
                           "to its own well, in rad. NaN where members rotate or escape",
    "half peak to peak of the loop averaged over the members" },
  { "mean_amplitude", "mean over the members of half peak to peak of the angle, in rad",
    "mean over the members of half peak to peak of x" },
  { "resonance_frequency", "drive frequency of the largest mean loop area, in omega0",
    "drive frequency of the largest mean loop area" },
  { "resonance_period", "2 pi over the frequency of the largest mean loop area, in 1/omega0",
    "2 pi over the frequency of the largest mean loop area" },
  { "sa_fraction", "share of members on SA: of the orbits of one drive period without winding that "
                   "coexist, that of smallest amplitude. NaN where nothing coexists", NULL },
  { "la_fraction", "share of members on LA: of the orbits of one drive period without winding that "
                   "coexist, those of larger amplitude. NaN where nothing coexists", NULL },
  { "regime", "sa, la: all members on that state; coexistence: some on either; single: all on one "
              "state that continues neither, as beyond the cusp; other: some elsewhere, which "
              "the variable `other` tells", NULL },
  { "regime_exact", "as regime, of all attractors that are known, whether members reach them or "
                    "not: those on branches that members reach anywhere on the line, that curves "
                    "of neighbouring lines bound or, but for the plain pendulum, that guesses "
                    "about resonances lead to", NULL },
  { "other", "sum of the flags that hold: each of flag_values is a bit", NULL },
  { "uncertain_members", "members whose state is not certain at the tolerance; errors allow for "
                         "any state of theirs", NULL },
  { "lyapunov_exponent", "rate at which neighbours part, in omega0",
    "rate at which neighbours part" },
  { "lyapunov", "rate at which neighbours part, in omega0; of closed orbits that of the larger "
                "multiplier",
    "rate at which neighbours part; of closed orbits that of the larger multiplier" },
  { "lyapunov_dimension",
    "1 + L / (L + damping) of the strobe points, L being the largest Lyapunov "
                          "exponent; the motion in time has one more. Its error is a standard "
                          "error", NULL },
  { "correlation_dimension", "slope of log correlation_sum against log distance, of the strobe "
                             "points; the motion in time has one more. Its error: two standard "
                             "errors, and what the slope differs by within the range", NULL },
  { "power_spectrum", "mean square of v that each unit of angular frequency holds, one-sided: the "
                      "integral over frequency is the mean square of v; by Welch's method, with "
                      "Hann windows. Its error is a standard error from the scatter of segments, "
                      "infinite where there is one alone", NULL },
  { "basin_entropy", "mean over boxes of 5 x 5 states of -sum p log p, p being shares of a box. "
                     "Its error is from the scatter of rows of boxes, and NaN where there are "
                     "fewer than four", NULL },
  { "boundary_basin_entropy", "the same over the boxes that hold more than one basin; above log 2 "
                              "the boundary is fractal. NaN where there is no such box", NULL },
  { "uncertain_fraction", "share of pairs of states this far apart that settle differently. Its "
                          "error is from the scatter between rows, and NaN where too few rows "
                          "are there for one", NULL },
  { "estimated_error", "largest over the members; infinite where the method says of one that "
                       "nothing is known of it, NaN where the method makes no estimate", NULL },
  { "seconds", "of the fastest of several runs. Its error is the distance to the next, and NaN "
               "where one run took so long that it was the only one", NULL },
  { "rotation", "mean whole turns of the angle a drive period", NULL },
  { "mean_velocity", "mean of dx/dt in the long run, in omega0; of an orbit that closes after q "
                     "drive periods but for p turns, p omega / q",
    "mean of dx/dt in the long run" },
};

/* Of a variable of the root; NULL: its name says it all. */
static const char *definition_of(const char *name, int angle)
{
  const pendres_orbit_quantity *q;
  for (size_t i = 0; i < sizeof definitions / sizeof *definitions; i++)
    if (strcmp(definitions[i].name, name) == 0)
      return angle || definitions[i].no_angle == NULL ? definitions[i].definition
                                                      : definitions[i].no_angle;
  for (size_t k = 0; (q = pendres_orbit_quantity_get(k)) != NULL; k++)
    if (strcmp(q->name, name) == 0)
      return angle || q->coordinate == NULL ? q->definition : q->coordinate;
  return NULL;
}

void scene_define(const scene_run *run, pendres_store_spec *spec, char words[SCENE_WORDS])
{
  static const char of_angle[] = "the angle";
  const int angle = pendres_model_of(deck_pendulum(run->deck).force)->angle;
  const char *definition = definition_of(spec->name, angle);
  if ((spec->group == NULL || spec->group[0] == '\0') && definition != NULL)
    spec->comment = definition;
  if (angle || spec->type != PENDRES_STORE_DOUBLE) return;
  /* A phase is an angle nevertheless. */
  if (spec->units != NULL && strcmp(spec->units, "rad") == 0 && strstr(spec->name, "phase") == NULL)
    spec->units = "1";
  const char *at = spec->long_name != NULL ? strstr(spec->long_name, of_angle) : NULL;
  if (at == NULL) return;
  snprintf(words, SCENE_WORDS, "%.*sx%s", (int)(at - spec->long_name), spec->long_name,
           at + sizeof of_angle - 1);
  spec->long_name = words;
}
