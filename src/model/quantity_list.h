/*
 * quantity_list.h -- the table of quantities, one row each, for a file that includes it with
 *
 *   QUANTITY(name, kind, words, definition, coordinate)
 *
 * defined: see <pendres/quantity.h>. MEASURE is the same of a field of pendres_orbit with its error
 * beside it, and EXACT of one that has none; where they are not defined, they are quantities like
 * all others. Parameters have their rows in <pendres/parameter.h>; those that stand here as well
 * are results, too.
 */
#ifndef MEASURE
#define MEASURE QUANTITY
#endif
#ifndef EXACT
#define EXACT QUANTITY
#endif

/* clang-format off */

/* ---- measures of orbits ---- */

MEASURE(amplitude, POSITION, "half peak to peak of the angle",
  "half peak to peak of the angle, in rad",
  "half peak to peak of x")
MEASURE(first_harmonic_amplitude, POSITION, "amplitude of the angle's first harmonic",
  "a in the part a cos(omega t - phase_lag) of the angle, in rad",
  "a in the part a cos(omega t - phase_lag) of x")
MEASURE(phase_lag, PHASE, "lag of the first harmonic behind the drive",
  "phi in 0 to pi, in rad: the angle's first harmonic is a cos(omega t - phi)",
  "phi in 0 to pi, in rad: the first harmonic of x is a cos(omega t - phi)")
MEASURE(loop_area, ENERGY, "area of the hysteresis loop, a drive cycle",
  "work of the drive a drive cycle, the closed integral of F dx, in m g l",
  "work of the drive a drive cycle, the closed integral of F dx")
MEASURE(dissipation, ENERGY, "energy dissipated a drive cycle",
  "gamma times the closed integral of v^2 dt a drive cycle, in m g l; on a periodic orbit the "
  "same as loop_area",
  "gamma times the closed integral of v^2 dt a drive cycle")
MEASURE(mean_power, POWER, "mean power taken from the drive",
  "loop area times omega / (2 pi), in m g l omega0",
  "loop area times omega / (2 pi)")
EXACT(torque_work, ENERGY, "energy that the torque gives a drive cycle",
  "2 pi I p / q of the torque I and an orbit of p turns in q drive periods, exactly", NULL)
MEASURE(parametric_work, ENERGY, "energy that the parametric drive gives a drive cycle",
  "-b times the closed integral of f(x) cos(omega t) dx, of the restoring force f", NULL)

/* ---- states, and what they settle on ---- */

QUANTITY(x, POSITION, "position",
  "the particle's coordinate in the potential -sin x; the pendulum's angle from rest is x - pi/2",
  "the oscillator's coordinate, in the units of its equation")
QUANTITY(v, VELOCITY, "velocity", "dx/dt, in units of omega0", "dx/dt")
QUANTITY(action, ENERGY, "least action out of the state",
  "S of the rate of leaving, which is a prefactor times exp(-S/T) at small temperatures T",
  NULL)
QUANTITY(drive_phase, PHASE, "phase of the drive, omega t", NULL, NULL)
QUANTITY(drive, FORCE, "drive, F0 cos(omega t)", NULL, NULL)
QUANTITY(period, NUMBER, "drive periods until the orbit closes", NULL, NULL)
QUANTITY(winding, NUMBER, "whole turns until the orbit closes", NULL, NULL)
QUANTITY(rotation, NUMBER, "mean whole turns a drive period",
  "mean whole turns of the angle a drive period", NULL)
QUANTITY(mean_velocity, VELOCITY, "mean velocity of x",
  "mean of dx/dt in the long run, in omega0; of an orbit that closes after q drive periods but "
  "for p turns, p omega / q",
  "mean of dx/dt in the long run")
QUANTITY(lyapunov, RATE, "largest Lyapunov exponent per unit time",
  "rate at which neighbours part, in omega0; of closed orbits that of the larger multiplier",
  "rate at which neighbours part; of closed orbits that of the larger multiplier")
QUANTITY(lyapunov_exponent, RATE, "largest Lyapunov exponent per unit time",
  "rate at which neighbours part, in omega0",
  "rate at which neighbours part")
QUANTITY(lyapunov_dimension, NUMBER, "dimension of the section by Kaplan and Yorke",
  "1 + L / (L + damping) of the strobe points, L being the largest Lyapunov exponent; the motion "
  "in time has one more. Its error is a standard error", NULL)
QUANTITY(correlation_dimension, NUMBER, "correlation dimension of the section",
  "slope of log correlation_sum against log distance, of the strobe points; the motion in time "
  "has one more. Its error: two standard errors, and what the slope differs by within the range",
  NULL)
QUANTITY(power_spectrum, SPECTRUM, "power spectral density of the velocity",
  "mean square of v that each unit of angular frequency holds, one-sided: the integral over "
  "frequency is the mean square of v; by Welch's method, with Hann windows. Its error is a "
  "standard error from the scatter of segments, infinite where there is one alone", NULL)
QUANTITY(frequency, FREQUENCY, "frequency", NULL, NULL)
QUANTITY(free_frequency, FREQUENCY, "frequency without damping and drive", NULL, NULL)
QUANTITY(free_amplitude, POSITION, "amplitude without damping and drive", NULL, NULL)
QUANTITY(rotation_period, TIME, "period of the rotation, in which x grows or falls by 2 pi", NULL,
  NULL)
QUANTITY(start_displacement, POSITION, "displacement at the start", NULL, NULL)
QUANTITY(start_velocity, VELOCITY, "velocity at the start", NULL, NULL)
QUANTITY(parameter, SWEPT, "value of the parameter that moves", NULL, NULL)

/* ---- ensembles and basins ---- */

QUANTITY(mean_loop_area, ENERGY, "mean loop area of the ensemble",
  "mean over the members of the work of the drive a drive cycle, the closed integral of F dx, in "
  "m g l",
  "mean over the members of the work of the drive a drive cycle, the closed integral of F dx")
QUANTITY(mean_loop_amplitude, POSITION, "amplitude of the ensemble-averaged loop",
  "half peak to peak of the loop averaged over the members, each shifted to its own well, in "
  "rad. NaN where members rotate or escape",
  "half peak to peak of the loop averaged over the members")
QUANTITY(mean_amplitude, POSITION, "mean of the members' amplitudes",
  "mean over the members of half peak to peak of the angle, in rad",
  "mean over the members of half peak to peak of x")
QUANTITY(resonance_frequency, FREQUENCY, "drive frequency of the largest mean loop area",
  "drive frequency of the largest mean loop area, in omega0",
  "drive frequency of the largest mean loop area")
QUANTITY(resonance_period, TIME, "drive period of the largest mean loop area",
  "2 pi over the frequency of the largest mean loop area, in 1/omega0",
  "2 pi over the frequency of the largest mean loop area")
QUANTITY(sa_fraction, NUMBER, "share of the members on the small-amplitude state",
  "share of members on SA: of the orbits of one drive period without winding that coexist, that "
  "of smallest amplitude. NaN where nothing coexists", NULL)
QUANTITY(la_fraction, NUMBER, "share of the members on the large-amplitude state",
  "share of members on LA: of the orbits of one drive period without winding that coexist, those "
  "of larger amplitude. NaN where nothing coexists", NULL)
QUANTITY(regime, NUMBER, "states of motion that members settle on",
  "sa, la: all members on that state; coexistence: some on either; single: all on one state that "
  "continues neither, as beyond the cusp; other: some elsewhere, which the variable `other` tells",
  NULL)
QUANTITY(regime_exact, NUMBER, "states of motion that are known as attractors",
  "as regime, of all attractors that are known, whether members reach them or not: those on "
  "branches that members reach anywhere on the line, that curves of neighbouring lines bound or, "
  "but for the plain pendulum, that guesses about resonances lead to", NULL)
QUANTITY(other, NUMBER, "what else members settle on: sum of the flags",
  "sum of the flags that hold: each of flag_values is a bit", NULL)
QUANTITY(uncertain_members, NUMBER, "members that may belong to another state",
  "members whose state is not certain at the tolerance; errors allow for any state of theirs", NULL)
QUANTITY(basin_entropy, NUMBER, "basin entropy over boxes of 5 x 5 states",
  "mean over boxes of 5 x 5 states of -sum p log p, p being shares of a box. Its error is from "
  "the scatter of rows of boxes, and NaN where there are fewer than four", NULL)
QUANTITY(boundary_basin_entropy, NUMBER,
  "basin entropy over boxes with a boundary; above log 2 it is fractal",
  "the same over the boxes that hold more than one basin; above log 2 the boundary is fractal. "
  "NaN where there is no such box", NULL)
QUANTITY(uncertain_fraction, NUMBER, "share of states with an unlike one so far off",
  "share of pairs of states this far apart that settle differently. Its error is from the "
  "scatter between rows, and NaN where too few rows are there for one", NULL)

/* ---- noise ---- */

QUANTITY(temperature, TEMPERATURE, "temperature",
  "T = k T / (m g l); the potential's barrier is 2",
  "T, of the noise sqrt(2 damping T) xi(t)")
QUANTITY(cov_xx, VARIANCE_X, "variance of position", NULL, NULL)
QUANTITY(cov_xv, COVARIANCE, "covariance of position and velocity", NULL, NULL)
QUANTITY(cov_vv, VARIANCE_V, "variance of velocity", NULL, NULL)
QUANTITY(exposure, TIME, "time that trajectories were watched", NULL, NULL)
QUANTITY(rate, RATE, "transitions per unit time", NULL, NULL)
QUANTITY(activation_energy, ENERGY,
  "activation energy: rate = prefactor exp(-energy / temperature)", NULL, NULL)

/* clang-format on */
#undef QUANTITY
#undef MEASURE
#undef EXACT
