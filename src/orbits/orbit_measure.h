/*
 * orbit_measure.h -- what is measured on equally spaced samples of a closed orbit.
 *
 * Owns: the Fourier series of samples, and the properties of an orbit that follow from it. Nothing
 * is integrated here. The measures of the public interface are derived from it: orbit_table.h.
 */
#ifndef PENDRES_ORBIT_MEASURE_H
#define PENDRES_ORBIT_MEASURE_H

#include <stddef.h>

#include <pendres/orbit.h>
#include <pendres/status.h>

#include "orbits/orbit_series.h"

enum {
  PENDRES_ORBIT_SPECTRUM = 64, /* harmonics by which two computations are compared */
  PENDRES_ORBIT_MEASURES = 16  /* rows that the table of measures has room for */
};

/* Samples k = 0..n-1 at theta = 2 pi q k / n of a closed orbit: angle y, slope w = dy/dtheta. */
typedef struct pendres_orbit_samples {
  size_t n;
  int period, winding;
  const double *y, *w;
  pendres_orbit_tables *tables; /* the caller's */
} pendres_orbit_samples;

/* A measure in one computation. */
typedef struct pendres_orbit_value {
  double value;
  double sensitivity; /* its derivative by an error of y and w along the orbit, at most */
  double unresolved;  /* what harmonics too high for the samples may add to it */
} pendres_orbit_value;

/* What one computation of an orbit yields. */
typedef struct pendres_orbit_measures {
  pendres_orbit_value of[PENDRES_ORBIT_MEASURES]; /* by the rows of the table */
  double amplitude, mean_angle;
  double cosine[PENDRES_ORBIT_HARMONICS], sine[PENDRES_ORBIT_HARMONICS]; /* see orbit.h */
  double harmonics_rest;  /* bounds what harmonics beyond those add to the angle */
  double unresolved;      /* what harmonics too high for the samples may add to the angle */
  double square_speed;    /* mean square of w */
  pendres_orbit_value contraction; /* mean over time of the rate at which areas contract */
  double bends;           /* |v| bends slopes: the spacing of samples; 0: slopes are smooth */
  double symmetry_defect; /* largest harmonic of the angle that mirror symmetry forbids */
  double spectrum[2 * PENDRES_ORBIT_SPECTRUM]; /* re, im of coefficients m >= 0 */
} pendres_orbit_measures;

/* Doubles of workspace for n samples. */
static inline size_t pendres_orbit_measure_work(size_t n)
{
  return 3 * n + pendres_orbit_series_memory(n);
}

/* Computes everything except the measures of the table. */
pendres_status pendres_orbit_measure(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     double *work, pendres_orbit_measures *out);

/* The series of the angle, less the mean advance of a running orbit, by phase theta / period. */
pendres_status pendres_orbit_samples_series(const pendres_pendulum *p,
                                            const pendres_orbit_samples *s, double *work,
                                            pendres_orbit_series *out);

/*
 * The distance of two computations of an orbit over the whole of it: the root mean square of the
 * differences of angles and slopes. That the two agree at one phase, or in one measure, may be
 * chance.
 */
double pendres_orbit_measures_apart(const pendres_orbit_measures *a,
                                    const pendres_orbit_measures *b, int period);

/* Lag of a first harmonic behind a drive of that amplitude; NaN if either vanishes. */
double pendres_orbit_phase_lag(double cosine, double sine, double drive_amplitude);

/*
 * Multipliers from the trace of the monodromy matrix and their geometric mean modulus, which
 * follows by Liouville's formula from the contraction along the orbit; and whether both are inside
 * the unit circle.
 */
void pendres_orbit_set_multipliers(double trace, double modulus, pendres_orbit *o);

/* The rate at which the flow contracts areas along an orbit on average: exact where it is the same
   at all states, otherwise from the product of the multipliers; infinite where that is too small
   for a double. */
double pendres_orbit_contraction(const pendres_orbit *o);

/* Half the peak-to-peak of a Fourier series given by its harmonics 1, 2, ... */
double pendres_orbit_series_half_range(const double cosine[PENDRES_ORBIT_HARMONICS],
                                       const double sine[PENDRES_ORBIT_HARMONICS]);

#endif
