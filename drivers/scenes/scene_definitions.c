/*
 * scene_definitions.c -- what the measures in a file are: the attribute `comment` of each, in one
 * place for all scenes. Units are those of the equation (docs/your_pendulum.md has a
 * laboratory's).
 */
#include "scenes/scene.h"

/* Names of results that mean the same in every file. */
static const struct { const char *name, *definition; } definitions[] = {
  { "x", "the particle's coordinate in the potential -sin x; the pendulum's angle from rest is "
         "x - pi/2" },
  { "v", "dx/dt, in units of omega0" },
  { "temperature", "T = k T / (m g l); the potential's barrier is 2" },
  { "amplitude", "half peak to peak of the angle, in rad" },
  { "first_harmonic_amplitude", "a in the part a cos(omega t - phase_lag) of the angle, in rad" },
  { "phase_lag", "phi in 0 to pi, in rad: the angle's first harmonic is a cos(omega t - phi)" },
  { "loop_area", "work of the drive a drive cycle, the closed integral of F dx, in m g l" },
  { "dissipation", "gamma times the closed integral of v^2 dt a drive cycle, in m g l; on a "
                   "periodic orbit the same as loop_area" },
  { "mean_power", "loop area times omega / (2 pi), in m g l omega0" },
  { "mean_loop_area", "mean over the members of the work of the drive a drive cycle, the closed "
                      "integral of F dx, in m g l" },
  { "mean_loop_amplitude", "half peak to peak of the loop averaged over the members, each shifted "
                           "to its own well, in rad" },
  { "mean_amplitude", "mean over the members of half peak to peak of the angle, in rad" },
  { "resonance_frequency", "drive frequency of the largest mean loop area, in omega0" },
  { "resonance_period", "2 pi over the frequency of the largest mean loop area, in 1/omega0" },
  { "sa_fraction", "share of members on SA: of the orbits of one drive period without winding that "
                   "coexist, that of smallest amplitude. NaN where nothing coexists" },
  { "la_fraction", "share of members on LA: of the orbits of one drive period without winding that "
                   "coexist, those of larger amplitude. NaN where nothing coexists" },
  { "regime", "sa, la: all members on that state; coexistence: some on either; single: all on one "
              "state that continues neither, as beyond the cusp; other: some elsewhere, which "
              "the variable `other` tells" },
  { "regime_exact", "as regime, of all attractors that exist, whether members reach them or not" },
  { "other", "sum of the flags that hold: each of flag_values is a bit" },
  { "uncertain_members", "members whose state is not certain at the tolerance; errors allow for "
                         "any state of theirs" },
  { "lyapunov_exponent", "rate at which neighbours part, in omega0" },
  { "lyapunov", "rate at which neighbours part, in omega0; of closed orbits that of the larger "
                "multiplier" },
  { "lyapunov_dimension",
    "1 + L / (L + damping) of the strobe points, L being the largest Lyapunov "
                          "exponent; the motion in time has one more. Its error is a standard "
                          "error" },
  { "correlation_dimension", "slope of log correlation_sum against log distance, of the strobe "
                             "points; the motion in time has one more. Its error: two standard "
                             "errors, and what the slope differs by within the range" },
  { "power_spectrum", "mean square of v that each unit of angular frequency holds, one-sided: the "
                      "integral over frequency is the mean square of v; by Welch's method, with "
                      "Hann windows. Its error is a standard error" },
  { "rotation", "mean whole turns of the angle a drive period" },
  { "mean_velocity", "mean of dx/dt in the long run, in omega0; of an orbit that closes after q "
                     "drive periods but for p turns, p omega / q" },
};

pendres_status scene_define(scene_run *run)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < sizeof definitions / sizeof *definitions && status == PENDRES_OK; i++)
    if (pendres_store_has(run->store, "", definitions[i].name))
      status = pendres_store_attribute_text(run->store, "", definitions[i].name, "comment",
                                            definitions[i].definition);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}
