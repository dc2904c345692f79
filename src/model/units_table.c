/*
 * units_table.c -- the dimensions of all that public functions take and give; see units.h.
 *
 * A row a field, with its kind (pendres/quantity.h); a few derivatives have powers of length and
 * time of their own. Fields that are not here are pure numbers: angles of the drive's phase,
 * multipliers, shares, counts, and whatever is by drive period.
 */
#include <pendres/pendres.h>

#include "model/parameter.h"
#include "model/units.h"

/* The powers of a kind, and of the quantities of the list. */
enum {
#define KIND(code, length, time, unit) L_##code = (length), T_##code = (time),
  PENDRES_KIND_LIST(KIND)
#define QUANTITY(name, kind, ...) LENGTH_##name = L_##kind, TIME_##name = T_##kind,
#include "model/quantity_list.h"
};

#define FIELDS(type, field) (sizeof(((type *)0)->field) / sizeof(double))
#define RAW(type, field, l, t) {offsetof(type, field), FIELDS(type, field), l, t, NULL}
/* A field of a kind, also with its error behind; and fields with the name of their quantity. */
#define ROW(type, field, kind) RAW(type, field, L_##kind, T_##kind)
#define ROWS(type, field, kind) ROW(type, field, kind), ROW(type, field##_error, kind)
#define OWN(type, field) RAW(type, field, LENGTH_##field, TIME_##field)
#define OWNS(type, field) OWN(type, field), RAW(type, field##_error, LENGTH_##field, TIME_##field)
#define PART(type, field, kind) \
  {offsetof(type, field), sizeof(((type *)0)->field) / sizeof(kind##_type), 0, 0, \
   &pendres_dim_##kind}
#define TABLE(name, type, rows) \
  const pendres_dimensions pendres_dim_##name = {sizeof(type), sizeof rows / sizeof rows[0], rows}
/* A record of doubles and other records alone. */
#define RECORD(name, type, ...)                              \
  static const pendres_dimension name[] = {__VA_ARGS__};     \
  TABLE(name, type, name)

/* ---- arrays ---- */

#define ARRAY(name, l, t) RECORD(name, double, {0, 1, l, t, NULL})
ARRAY(length, L_POSITION, T_POSITION);
ARRAY(speed, L_VELOCITY, T_VELOCITY);
ARRAY(frequency, L_FREQUENCY, T_FREQUENCY);
ARRAY(energy, L_ENERGY, T_ENERGY);
ARRAY(first, PENDRES_UNITS_OF_FIRST, 0);

/* ---- pendulums and states ---- */

/* Of parameters that are fields of a pendulum themselves. */
#define P(code, number, name, field, over, positive, kind, words, brief)                  \
  {offsetof(pendres_parameter_record, field),                                             \
   (over) == 0 && offsetof(pendres_parameter_record, field) < sizeof(pendres_pendulum),   \
   L_##kind, T_##kind, NULL},
RECORD(pendulum, pendres_pendulum, PENDRES_PARAMETER_LIST(P));
typedef pendres_pendulum pendulum_type;

RECORD(state, pendres_state, OWN(pendres_state, x), OWN(pendres_state, v));

#define S(field, kind) ROW(pendres_recording, field, kind)
RECORD(recording, pendres_recording, PART(pendres_recording, pendulum, pendulum),
       OWNS(pendres_recording, x), OWNS(pendres_recording, v), S(place.y, POSITION),
       S(place.w, POSITION), S(finer.y, POSITION), S(finer.w, POSITION), S(noise, VARIANCE_X));

/* ---- orbits and attractors ---- */

#define O(field, kind) ROW(pendres_orbit, field, kind)
static const pendres_dimension orbit[] = {
#define QUANTITY(...)
#define MEASURE(name, ...) OWNS(pendres_orbit, name),
#define EXACT(name, ...) OWN(pendres_orbit, name),
#include "model/quantity_list.h"
  PART(pendres_orbit, pendulum, pendulum), OWNS(pendres_orbit, x), OWNS(pendres_orbit, v),
  O(monodromy[0][1], TIME), O(monodromy[1][0], RATE), O(mean_angle, POSITION),
  O(cosine, POSITION), O(sine, POSITION), RAW(pendres_orbit, frequency_derivative[0], 1, 1),
  O(frequency_derivative[1], POSITION), RAW(pendres_orbit, loop_area_slope, 2, -1),
  RAW(pendres_orbit, loop_area_slope_error, 2, -1), O(harmonics_rest, POSITION)};
TABLE(orbit, pendres_orbit, orbit);
typedef pendres_orbit orbit_type;

RECORD(guess, pendres_orbit_guess, PART(pendres_orbit_guess, pendulum, pendulum),
       OWN(pendres_orbit_guess, x), OWN(pendres_orbit_guess, v));

/* The metric is of y and w = dy/dtheta, both lengths. */
RECORD(attractor, pendres_attractor, PART(pendres_attractor, orbit, orbit),
       ROW(pendres_attractor, trap_radius, POSITION), OWNS(pendres_attractor, lyapunov));
typedef pendres_attractor attractor_type;

RECORD(settled, pendres_settled, ROWS(pendres_settled, exponent, RATE));

/* ---- branches and curves: arclength is counted in canonical units ---- */

#define FIRST(type, field) RAW(type, field, PENDRES_UNITS_OF_FIRST, 0)
#define FIRSTS(type, field) FIRST(type, field), FIRST(type, field##_error)
#define CURVATURE(type, field) RAW(type, field, PENDRES_UNITS_OF_FIRST, -2)
RECORD(bifurcation, pendres_bifurcation, PART(pendres_bifurcation, orbit, orbit),
       FIRSTS(pendres_bifurcation, value), CURVATURE(pendres_bifurcation, curvature),
       CURVATURE(pendres_bifurcation, curvature_error),
       ROW(pendres_bifurcation, crossing[0], POSITION),
       ROW(pendres_bifurcation, crossing[1], VELOCITY), FIRST(pendres_bifurcation, crossing[2]));

RECORD(branch_options, pendres_branch_options, FIRST(pendres_branch_options, low),
       FIRST(pendres_branch_options, high));

RECORD(branch_point, pendres_branch_point, PART(pendres_branch_point, orbit, orbit),
       FIRST(pendres_branch_point, parameter_error));

#define PAIR(type, field)                          \
  FIRST(type, field[0]), RAW(type, field[1], PENDRES_UNITS_OF_SECOND, 0)
RECORD(cusp, pendres_cusp, PART(pendres_cusp, orbit, orbit), PAIR(pendres_cusp, value),
       PAIR(pendres_cusp, value_error));

RECORD(curve_options, pendres_curve_options, PAIR(pendres_curve_options, low),
       PAIR(pendres_curve_options, high));

RECORD(curve_point, pendres_curve_point, PART(pendres_curve_point, orbit, orbit),
       PAIR(pendres_curve_point, value), PAIR(pendres_curve_point, value_error),
       CURVATURE(pendres_curve_point, curvature));

RECORD(cascade, pendres_cascade, FIRSTS(pendres_cascade, value), OWN(pendres_cascade, x),
       OWN(pendres_cascade, v), FIRSTS(pendres_cascade, limit));

/* ---- ensembles ---- */

#define E(field, kind) ROW(pendres_ensemble, field, kind)
RECORD(ensemble, pendres_ensemble, E(x_first, POSITION), E(x_last, POSITION), E(v, VELOCITY),
       E(v_last, VELOCITY));
typedef pendres_ensemble ensemble_type;

RECORD(phase_options, pendres_phase_options, PART(pendres_phase_options, ensemble, ensemble));

#define R(field) OWNS(pendres_response, field)
RECORD(response, pendres_response, PART(pendres_response, pendulum, pendulum), R(mean_loop_area),
       R(mean_loop_amplitude), R(mean_amplitude), R(mean_power),
       PART(pendres_response, state, attractor));
typedef pendres_response response_type;

#define N(field) OWN(pendres_response_noise, field)
RECORD(response_noise, pendres_response_noise, N(temperature), N(loop_area), N(amplitude),
       N(mean_power));

#define M(field, kind) ROWS(pendres_resonance, field, kind)
RECORD(resonance, pendres_resonance, M(frequency, FREQUENCY), M(loop_area, ENERGY),
       PART(pendres_resonance, response, response), M(fold_frequency, FREQUENCY));
typedef pendres_resonance resonance_type;

RECORD(search, pendres_resonance_search, PART(pendres_resonance_search, pendulum, pendulum),
       ROW(pendres_resonance_search, lowest, FREQUENCY),
       ROW(pendres_resonance_search, highest, FREQUENCY),
       PART(pendres_resonance_search, resonance, resonance));

RECORD(turn, pendres_resonance_turn, ROWS(pendres_resonance_turn, damping, RATE),
       OWNS(pendres_resonance_turn, frequency));

/* ---- sweeps ---- */

#define H(field) OWN(pendres_hysteresis_point, field)
RECORD(hysteresis_point, pendres_hysteresis_point, FIRST(pendres_hysteresis_point, value),
       PART(pendres_hysteresis_point, attractor, attractor), H(x), H(v),
       OWNS(pendres_hysteresis_point, mean_velocity));

RECORD(jump, pendres_jump, FIRSTS(pendres_jump, value));

RECORD(step, pendres_step, FIRSTS(pendres_step, lower), FIRSTS(pendres_step, upper),
       FIRSTS(pendres_step, width));

RECORD(ramp_jump, pendres_ramp_jump, FIRSTS(pendres_ramp_jump, value),
       FIRSTS(pendres_ramp_jump, delay));

#define FREE(field) ROW(pendres_free_oscillation, field, POSITION)
RECORD(free_oscillation, pendres_free_oscillation, FREE(well), FREE(low), FREE(high),
       OWNS(pendres_free_oscillation, frequency), FREE(turn_error));

#define D(field) OWNS(pendres_phase_point, field)
RECORD(phase_point, pendres_phase_point, PART(pendres_phase_point, pendulum, pendulum),
       D(mean_loop_area), D(mean_loop_amplitude), ROWS(pendres_phase_point, sa_amplitude, POSITION),
       ROWS(pendres_phase_point, la_amplitude, POSITION));

/* ---- basins ---- */

/* Distances in the plane are those of x and of v times the unit of time. */
#define B(field, kind) ROW(pendres_boundary_options, field, kind)
RECORD(boundary_options, pendres_boundary_options, B(x_low, POSITION), B(x_high, POSITION),
       B(v_low, VELOCITY), B(v_high, VELOCITY), B(spacing, POSITION), B(deviation, POSITION));

#define W(field, kind) ROW(pendres_basin_window, field, kind)
RECORD(window, pendres_basin_window, W(x_low, POSITION), W(x_high, POSITION), W(v_low, VELOCITY),
       W(v_high, VELOCITY));

RECORD(statistics, pendres_basin_statistics, ROW(pendres_basin_statistics, distance, VELOCITY));

/* ---- noise ---- */

RECORD(langevin_request, pendres_langevin_request,
       PART(pendres_langevin_request, pendulum, pendulum), OWN(pendres_langevin_request, x),
       OWN(pendres_langevin_request, v));

/* By the names of pendres_langevin_statistic. */
#define STATISTIC_LIST(ITEM, type)                                                              \
  ITEM(type, MEAN_X, POSITION), ITEM(type, MEAN_V, VELOCITY), ITEM(type, COV_XX, VARIANCE_X),   \
    ITEM(type, COV_XV, COVARIANCE), ITEM(type, COV_VV, VARIANCE_V), ITEM(type, COSINE, POSITION), \
    ITEM(type, SINE, POSITION), ITEM(type, LOOP_AREA, ENERGY)
#define STATISTIC(type, name, kind) ROW(type, statistics[PENDRES_LANGEVIN_##name], kind)
#define SCALE(type, name, kind) ROW(type, scale[PENDRES_LANGEVIN_##name], kind)
RECORD(cloud, pendres_langevin_cloud, STATISTIC_LIST(STATISTIC, pendres_langevin_cloud));
typedef pendres_langevin_cloud cloud_type;

RECORD(bias, pendres_langevin_bias, STATISTIC_LIST(STATISTIC, pendres_langevin_bias),
       STATISTIC_LIST(SCALE, pendres_langevin_bias));
typedef pendres_langevin_bias bias_type;

#define C(field, kind) ROW(pendres_langevin_covariance, field, kind)
RECORD(covariance, pendres_langevin_covariance, C(xx, VARIANCE_X), C(xv, COVARIANCE),
       C(vv, VARIANCE_V));
typedef pendres_langevin_covariance covariance_type;

#define L(field, kind) ROW(pendres_langevin_linear, field, kind)
RECORD(linear, pendres_langevin_linear, PART(pendres_langevin_linear, covariance, covariance),
       PART(pendres_langevin_linear, injected, covariance), L(monodromy[1], TIME),
       L(monodromy[2], RATE), L(closure, POSITION), L(error, VARIANCE_X));

#define K(field, kind) ROW(pendres_cloud, field, kind)
RECORD(whole_cloud, pendres_cloud, PART(pendres_cloud, measured, cloud),
       PART(pendres_cloud, bias, bias), PART(pendres_cloud, linear, covariance),
       K(linear_error, VARIANCE_X), K(escape_exposure, TIME), K(escape_rate, RATE));

#define V(field, kind) ROW(pendres_switching_rate, field, kind)
RECORD(rate, pendres_switching_rate, V(exposure, TIME), V(value, RATE), V(error, RATE),
       V(lower, RATE), V(upper, RATE), V(mean_time, TIME), V(mean_time_error, TIME));

RECORD(escape, pendres_escape, PART(pendres_escape, saddle, orbit),
       ROW(pendres_escape, saddle_x, POSITION), ROWS(pendres_escape, action, ENERGY));
/* But for the logarithm of a rate. */
RECORD(activation, pendres_switching_activation,
       ROWS(pendres_switching_activation, energy, ENERGY),
       OWN(pendres_switching_activation, temperature));

RECORD(tally, pendres_switching_tally, ROW(pendres_switching_tally, period, TIME));
