/*
 * units.h -- the units in which a pendulum is computed, and what of a record changes with them.
 *
 * Owns: a pendulum's canonical units (pendres_units_of), and the dimensions of all that public
 * functions take and give. Behind their door (engine/door.h) a pendulum is in its canonical units,
 * so that every threshold there is a pure number.
 */
#ifndef PENDRES_MODEL_UNITS_H
#define PENDRES_MODEL_UNITS_H

#include <stddef.h>

#include <pendres/parameter.h>

/* What the value of a parameter has in place of a power of length: its unit is that of the first or
   of the second parameter that is varied. */
enum { PENDRES_UNITS_OF_FIRST = 64, PENDRES_UNITS_OF_SECOND = 65 };

/* Some doubles of a record, one after another, in length^length time^time. Where `of` is not NULL,
   they are records of that kind. */
typedef struct pendres_dimension {
  size_t offset, count;
  signed char length, time;
  const struct pendres_dimensions *of;
} pendres_dimension;

/* The doubles of a record that have a dimension; all others are pure numbers. */
typedef struct pendres_dimensions {
  size_t size, rows;
  const pendres_dimension *row;
} pendres_dimensions;

/* Units, and those of the two parameters that are varied. */
typedef struct pendres_scales {
  pendres_units unit;
  double first, second;
} pendres_scales;

/* The unit of a quantity. */
double pendres_units_factor(const pendres_scales *scales, int length, int time);

/* The unit of a parameter; 1 if it does not exist. */
double pendres_units_of_parameter(const pendres_units *unit, pendres_parameter parameter);

/* Convert n records from the user's units to canonical ones, and back; nothing is done for NULL.
   Exact, since units are powers of two. */
void pendres_units_in(const pendres_scales *scales, const pendres_dimensions *d, size_t n,
                      void *records);
void pendres_units_out(const pendres_scales *scales, const pendres_dimensions *d, size_t n,
                       void *records);

/* Whether a pendulum's units are the user's. */
static inline int pendres_units_trivial(const pendres_units *u)
{
  return u->length == 1.0 && u->time == 1.0;
}

/* Arrays of doubles. */
extern const pendres_dimensions pendres_dim_length, pendres_dim_speed, pendres_dim_frequency,
  pendres_dim_energy, pendres_dim_first;

/* Records of the public interface. */
extern const pendres_dimensions pendres_dim_pendulum, pendres_dim_state, pendres_dim_orbit,
  pendres_dim_guess, pendres_dim_attractor, pendres_dim_recording, pendres_dim_bifurcation,
  pendres_dim_cusp, pendres_dim_branch_options, pendres_dim_branch_point,
  pendres_dim_curve_options, pendres_dim_curve_point, pendres_dim_cascade, pendres_dim_ensemble,
  pendres_dim_response, pendres_dim_response_noise, pendres_dim_resonance, pendres_dim_search,
  pendres_dim_turn, pendres_dim_hysteresis_point, pendres_dim_jump, pendres_dim_step,
  pendres_dim_settled, pendres_dim_ramp_jump, pendres_dim_phase_options, pendres_dim_phase_point,
  pendres_dim_boundary_options, pendres_dim_window, pendres_dim_statistics,
  pendres_dim_langevin_request, pendres_dim_cloud, pendres_dim_bias, pendres_dim_linear,
  pendres_dim_covariance, pendres_dim_whole_cloud, pendres_dim_tally, pendres_dim_rate,
  pendres_dim_activation, pendres_dim_escape, pendres_dim_free_oscillation;

#endif
