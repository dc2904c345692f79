/*
 * units_table.c -- the dimensions of all that public functions take and give; see units.h.
 *
 * A row a field, with its powers of length and time. Fields that are not here are pure numbers:
 * angles of the drive's phase, multipliers, shares, counts, and whatever is by drive period.
 */
#include <pendres/pendres.h>

#include "model/parameter.h"
#include "model/units.h"

#define FIELDS(type, field) (sizeof(((type *)0)->field) / sizeof(double))
#define ROW(type, field, l, t) {offsetof(type, field), FIELDS(type, field), l, t, NULL}
#define PART(type, field, kind) \
  {offsetof(type, field), sizeof(((type *)0)->field) / sizeof(kind##_type), 0, 0, \
   &pendres_dim_##kind}
#define TABLE(name, type, rows) \
  const pendres_dimensions pendres_dim_##name = {sizeof(type), sizeof rows / sizeof rows[0], rows}

/* ---- arrays ---- */

static const pendres_dimension length[] = {{0, 1, 1, 0, NULL}}, speed[] = {{0, 1, 1, -1, NULL}},
                               frequency[] = {{0, 1, 0, -1, NULL}},
                               energy[] = {{0, 1, 2, -2, NULL}},
                               first[] = {{0, 1, PENDRES_UNITS_OF_FIRST, 0, NULL}};
TABLE(length, double, length);
TABLE(speed, double, speed);
TABLE(frequency, double, frequency);
TABLE(energy, double, energy);
TABLE(first, double, first);

/* ---- pendulums and states ---- */

/* Of parameters that are fields of a pendulum themselves. */
#define P(code, number, name, field, over, positive, length, time, unit, words, brief)    \
  {offsetof(pendres_parameter_record, field),                                             \
   (over) == 0 && offsetof(pendres_parameter_record, field) < sizeof(pendres_pendulum),   \
   length, time, NULL},
static const pendres_dimension pendulum[] = {PENDRES_PARAMETER_LIST(P)};
TABLE(pendulum, pendres_pendulum, pendulum);
typedef pendres_pendulum pendulum_type;

static const pendres_dimension state[] = {ROW(pendres_state, x, 1, 0),
                                          ROW(pendres_state, v, 1, -1)};
TABLE(state, pendres_state, state);

#define S(field, l, t) ROW(pendres_recording, field, l, t)
static const pendres_dimension recording[] = {
  PART(pendres_recording, pendulum, pendulum), S(x, 1, 0), S(v, 1, -1), S(x_error, 1, 0),
  S(v_error, 1, -1), S(place.y, 1, 0), S(place.w, 1, 0), S(finer.y, 1, 0), S(finer.w, 1, 0),
  S(noise, 2, 0)};
TABLE(recording, pendres_recording, recording);

/* ---- orbits and attractors ---- */

#define O(field, l, t) ROW(pendres_orbit, field, l, t)
static const pendres_dimension orbit[] = {
  PART(pendres_orbit, pendulum, pendulum), O(x, 1, 0), O(v, 1, -1), O(x_error, 1, 0),
  O(v_error, 1, -1), O(monodromy[0][1], 0, 1), O(monodromy[1][0], 0, -1), O(loop_area, 2, -2),
  O(loop_area_error, 2, -2), O(dissipation, 2, -2), O(dissipation_error, 2, -2),
  O(mean_power, 2, -3), O(mean_power_error, 2, -3), O(amplitude, 1, 0), O(amplitude_error, 1, 0),
  O(first_harmonic_amplitude, 1, 0), O(first_harmonic_amplitude_error, 1, 0), O(mean_angle, 1, 0),
  O(cosine, 1, 0), O(sine, 1, 0), O(frequency_derivative[0], 1, 1),
  O(frequency_derivative[1], 1, 0), O(loop_area_slope, 2, -1), O(loop_area_slope_error, 2, -1),
  O(harmonics_rest, 1, 0), O(torque_work, 2, -2), O(parametric_work, 2, -2),
  O(parametric_work_error, 2, -2)};
TABLE(orbit, pendres_orbit, orbit);
typedef pendres_orbit orbit_type;

static const pendres_dimension guess[] = {PART(pendres_orbit_guess, pendulum, pendulum),
                                          ROW(pendres_orbit_guess, x, 1, 0),
                                          ROW(pendres_orbit_guess, v, 1, -1)};
TABLE(guess, pendres_orbit_guess, guess);

/* The metric is of y and w = dy/dtheta, both lengths. */
#define A(field, l, t) ROW(pendres_attractor, field, l, t)
static const pendres_dimension attractor[] = {PART(pendres_attractor, orbit, orbit),
                                              A(trap_radius, 1, 0), A(lyapunov, 0, -1),
                                              A(lyapunov_error, 0, -1)};
TABLE(attractor, pendres_attractor, attractor);
typedef pendres_attractor attractor_type;

static const pendres_dimension lyapunov[] = {ROW(pendres_lyapunov, exponent, 0, -1),
                                             ROW(pendres_lyapunov, exponent_error, 0, -1)};
TABLE(lyapunov, pendres_lyapunov, lyapunov);

/* ---- branches and curves: arclength is counted in canonical units ---- */

#define FIRST(type, field) ROW(type, field, PENDRES_UNITS_OF_FIRST, 0)
#define CURVATURE(type, field) ROW(type, field, PENDRES_UNITS_OF_FIRST, -2)
static const pendres_dimension bifurcation[] = {
  PART(pendres_bifurcation, orbit, orbit), FIRST(pendres_bifurcation, value),
  FIRST(pendres_bifurcation, value_error), CURVATURE(pendres_bifurcation, curvature),
  CURVATURE(pendres_bifurcation, curvature_error),
  {offsetof(pendres_bifurcation, crossing[0]), 1, 1, 0, NULL},
  {offsetof(pendres_bifurcation, crossing[1]), 1, 1, -1, NULL},
  {offsetof(pendres_bifurcation, crossing[2]), 1, PENDRES_UNITS_OF_FIRST, 0, NULL}};
TABLE(bifurcation, pendres_bifurcation, bifurcation);

static const pendres_dimension branch_options[] = {FIRST(pendres_branch_options, low),
                                                   FIRST(pendres_branch_options, high)};
TABLE(branch_options, pendres_branch_options, branch_options);

static const pendres_dimension branch_point[] = {PART(pendres_branch_point, orbit, orbit),
                                                 FIRST(pendres_branch_point, parameter_error)};
TABLE(branch_point, pendres_branch_point, branch_point);

#define PAIR(type, field)                                                               \
  {offsetof(type, field[0]), 1, PENDRES_UNITS_OF_FIRST, 0, NULL},                       \
  {offsetof(type, field[1]), 1, PENDRES_UNITS_OF_SECOND, 0, NULL}
static const pendres_dimension cusp[] = {PART(pendres_cusp, orbit, orbit),
                                         PAIR(pendres_cusp, value),
                                         PAIR(pendres_cusp, value_error)};
TABLE(cusp, pendres_cusp, cusp);

static const pendres_dimension curve_options[] = {PAIR(pendres_curve_options, low),
                                                  PAIR(pendres_curve_options, high)};
TABLE(curve_options, pendres_curve_options, curve_options);

static const pendres_dimension curve_point[] = {
  PART(pendres_curve_point, orbit, orbit), PAIR(pendres_curve_point, value),
  PAIR(pendres_curve_point, value_error), CURVATURE(pendres_curve_point, curvature)};
TABLE(curve_point, pendres_curve_point, curve_point);

static const pendres_dimension cascade[] = {
  FIRST(pendres_cascade, value), FIRST(pendres_cascade, value_error),
  ROW(pendres_cascade, x, 1, 0), ROW(pendres_cascade, v, 1, -1), FIRST(pendres_cascade, limit),
  FIRST(pendres_cascade, limit_error)};
TABLE(cascade, pendres_cascade, cascade);

/* ---- ensembles ---- */

#define E(field, l, t) ROW(pendres_ensemble, field, l, t)
static const pendres_dimension ensemble[] = {E(x_first, 1, 0), E(x_last, 1, 0), E(v, 1, -1),
                                             E(v_last, 1, -1)};
TABLE(ensemble, pendres_ensemble, ensemble);
typedef pendres_ensemble ensemble_type;

static const pendres_dimension phase_options[] = {PART(pendres_phase_options, ensemble, ensemble)};
TABLE(phase_options, pendres_phase_options, phase_options);

#define R(field, l, t) ROW(pendres_response, field, l, t)
static const pendres_dimension response[] = {
  PART(pendres_response, pendulum, pendulum), R(mean_loop_area, 2, -2),
  R(mean_loop_area_error, 2, -2), R(mean_loop_amplitude, 1, 0), R(mean_loop_amplitude_error, 1, 0),
  R(mean_amplitude, 1, 0), R(mean_amplitude_error, 1, 0), R(mean_power, 2, -3),
  R(mean_power_error, 2, -3), PART(pendres_response, state, attractor)};
TABLE(response, pendres_response, response);
typedef pendres_response response_type;

#define N(field, l, t) ROW(pendres_response_noise, field, l, t)
static const pendres_dimension response_noise[] = {N(temperature, 2, -2), N(loop_area, 2, -2),
                                                   N(amplitude, 1, 0), N(mean_power, 2, -3)};
TABLE(response_noise, pendres_response_noise, response_noise);

#define M(field, l, t) ROW(pendres_resonance, field, l, t)
static const pendres_dimension resonance[] = {
  M(frequency, 0, -1), M(frequency_error, 0, -1), M(loop_area, 2, -2), M(loop_area_error, 2, -2),
  PART(pendres_resonance, response, response), M(fold_frequency, 0, -1),
  M(fold_frequency_error, 0, -1)};
TABLE(resonance, pendres_resonance, resonance);
typedef pendres_resonance resonance_type;

static const pendres_dimension search[] = {PART(pendres_resonance_search, pendulum, pendulum),
                                           ROW(pendres_resonance_search, lowest, 0, -1),
                                           ROW(pendres_resonance_search, highest, 0, -1),
                                           PART(pendres_resonance_search, resonance, resonance)};
TABLE(search, pendres_resonance_search, search);

static const pendres_dimension turn[] = {
  ROW(pendres_resonance_turn, damping, 0, -1), ROW(pendres_resonance_turn, damping_error, 0, -1),
  ROW(pendres_resonance_turn, frequency, 0, -1),
  ROW(pendres_resonance_turn, frequency_error, 0, -1)};
TABLE(turn, pendres_resonance_turn, turn);

/* ---- sweeps ---- */

#define H(field, l, t) ROW(pendres_hysteresis_point, field, l, t)
static const pendres_dimension hysteresis_point[] = {
  FIRST(pendres_hysteresis_point, value), PART(pendres_hysteresis_point, attractor, attractor),
  H(x, 1, 0), H(v, 1, -1), H(mean_velocity, 1, -1), H(mean_velocity_error, 1, -1)};
TABLE(hysteresis_point, pendres_hysteresis_point, hysteresis_point);

static const pendres_dimension jump[] = {FIRST(pendres_jump, value),
                                         FIRST(pendres_jump, value_error)};
TABLE(jump, pendres_jump, jump);

#define STEP(field) FIRST(pendres_step, field), FIRST(pendres_step, field##_error)
static const pendres_dimension step[] = {STEP(lower), STEP(upper), STEP(width)};
TABLE(step, pendres_step, step);

static const pendres_dimension ramp_jump[] = {
  FIRST(pendres_ramp_jump, value), FIRST(pendres_ramp_jump, value_error),
  FIRST(pendres_ramp_jump, delay), FIRST(pendres_ramp_jump, delay_error)};
TABLE(ramp_jump, pendres_ramp_jump, ramp_jump);

#define FREE(field, l, t) ROW(pendres_free_oscillation, field, l, t)
static const pendres_dimension free_oscillation[] = {
  FREE(well, 1, 0), FREE(low, 1, 0), FREE(high, 1, 0), FREE(frequency, 0, -1),
  FREE(frequency_error, 0, -1), FREE(turn_error, 1, 0)};
TABLE(free_oscillation, pendres_free_oscillation, free_oscillation);

#define D(field, l, t) ROW(pendres_phase_point, field, l, t)
static const pendres_dimension phase_point[] = {
  PART(pendres_phase_point, pendulum, pendulum), D(mean_loop_area, 2, -2),
  D(mean_loop_area_error, 2, -2), D(mean_loop_amplitude, 1, 0), D(mean_loop_amplitude_error, 1, 0),
  D(sa_amplitude, 1, 0), D(sa_amplitude_error, 1, 0), D(la_amplitude, 1, 0),
  D(la_amplitude_error, 1, 0)};
TABLE(phase_point, pendres_phase_point, phase_point);

/* ---- basins ---- */

/* Distances in the plane are those of x and of v times the unit of time. */
#define B(field, l, t) ROW(pendres_boundary_options, field, l, t)
static const pendres_dimension boundary_options[] = {B(x_low, 1, 0), B(x_high, 1, 0),
                                                     B(v_low, 1, -1), B(v_high, 1, -1),
                                                     B(spacing, 1, 0), B(deviation, 1, 0)};
TABLE(boundary_options, pendres_boundary_options, boundary_options);

#define W(field, l, t) ROW(pendres_basin_window, field, l, t)
static const pendres_dimension window[] = {W(x_low, 1, 0), W(x_high, 1, 0), W(v_low, 1, -1),
                                           W(v_high, 1, -1)};
TABLE(window, pendres_basin_window, window);

static const pendres_dimension statistics[] = {ROW(pendres_basin_statistics, distance, 1, -1)};
TABLE(statistics, pendres_basin_statistics, statistics);

/* ---- noise ---- */

#define Q(field, l, t) ROW(pendres_langevin_request, field, l, t)
static const pendres_dimension langevin_request[] = {
  PART(pendres_langevin_request, pendulum, pendulum), Q(x, 1, 0), Q(v, 1, -1)};
TABLE(langevin_request, pendres_langevin_request, langevin_request);

/* By the names of pendres_langevin_statistic. */
#define STATISTIC(type, name, l, t)                                                         \
  {offsetof(type, statistics) + PENDRES_LANGEVIN_##name * sizeof(pendres_langevin_estimate), \
   sizeof(pendres_langevin_estimate) / sizeof(double), l, t, NULL}
#define STATISTICS(type)                                                                       \
  STATISTIC(type, MEAN_X, 1, 0), STATISTIC(type, MEAN_V, 1, -1), STATISTIC(type, COV_XX, 2, 0), \
    STATISTIC(type, COV_XV, 2, -1), STATISTIC(type, COV_VV, 2, -2),                             \
    STATISTIC(type, COSINE, 1, 0), STATISTIC(type, SINE, 1, 0), STATISTIC(type, LOOP_AREA, 2, -2)
static const pendres_dimension cloud[] = {STATISTICS(pendres_langevin_cloud)};
TABLE(cloud, pendres_langevin_cloud, cloud);
typedef pendres_langevin_cloud cloud_type;

#define SCALE(name, l, t)                                                                 \
  {offsetof(pendres_langevin_bias, scale) + PENDRES_LANGEVIN_##name * sizeof(double), 1, l, t, \
   NULL}
static const pendres_dimension bias[] = {
  STATISTICS(pendres_langevin_bias), SCALE(MEAN_X, 1, 0), SCALE(MEAN_V, 1, -1),
  SCALE(COV_XX, 2, 0), SCALE(COV_XV, 2, -1), SCALE(COV_VV, 2, -2), SCALE(COSINE, 1, 0),
  SCALE(SINE, 1, 0), SCALE(LOOP_AREA, 2, -2)};
TABLE(bias, pendres_langevin_bias, bias);
typedef pendres_langevin_bias bias_type;

#define C(field, l, t) ROW(pendres_langevin_covariance, field, l, t)
static const pendres_dimension covariance[] = {C(xx, 2, 0), C(xv, 2, -1), C(vv, 2, -2)};
TABLE(covariance, pendres_langevin_covariance, covariance);
typedef pendres_langevin_covariance covariance_type;

#define L(field, l, t) ROW(pendres_langevin_linear, field, l, t)
static const pendres_dimension linear[] = {
  PART(pendres_langevin_linear, covariance, covariance),
  PART(pendres_langevin_linear, injected, covariance), L(monodromy[1], 0, 1),
  L(monodromy[2], 0, -1), L(closure, 1, 0), L(error, 2, 0)};
TABLE(linear, pendres_langevin_linear, linear);

#define K(field, l, t) ROW(pendres_cloud, field, l, t)
static const pendres_dimension whole_cloud[] = {
  PART(pendres_cloud, measured, cloud), PART(pendres_cloud, bias, bias),
  PART(pendres_cloud, linear, covariance), K(linear_error, 2, 0), K(escape_exposure, 0, 1),
  K(escape_rate, 0, -1)};
TABLE(whole_cloud, pendres_cloud, whole_cloud);

#define V(field, l, t) ROW(pendres_switching_rate, field, l, t)
static const pendres_dimension rate[] = {V(exposure, 0, 1), V(value, 0, -1), V(error, 0, -1),
                                         V(lower, 0, -1), V(upper, 0, -1), V(mean_time, 0, 1),
                                         V(mean_time_error, 0, 1)};
TABLE(rate, pendres_switching_rate, rate);

/* But for the logarithm of a rate. */
#define G(field, l, t) ROW(pendres_switching_activation, field, l, t)
static const pendres_dimension activation[] = {G(energy, 2, -2), G(energy_error, 2, -2),
                                               G(temperature, 2, -2)};
TABLE(activation, pendres_switching_activation, activation);

static const pendres_dimension tally[] = {ROW(pendres_switching_tally, period, 0, 1)};
TABLE(tally, pendres_switching_tally, tally);
