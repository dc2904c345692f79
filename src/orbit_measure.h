/*
 * orbit_measure.h -- what is measured on equally spaced samples of a closed orbit.
 *
 * Owns: sums, Fourier series and extremes. No integration here.
 */
#ifndef PENDRES_ORBIT_MEASURE_H
#define PENDRES_ORBIT_MEASURE_H

#include <stddef.h>

#include <pendres/orbit.h>
#include <pendres/status.h>

/* Samples k = 0..n-1 at theta = 2 pi q k / n of a closed orbit: angle y, slope w = dy/dtheta. */
typedef struct pendres_orbit_samples {
  size_t n;
  int period, winding;
  const double *y, *w;
} pendres_orbit_samples;

typedef struct pendres_orbit_measures {
  double loop_area, dissipation, amplitude, mean_angle;
  double cosine[PENDRES_ORBIT_HARMONICS], sine[PENDRES_ORBIT_HARMONICS]; /* see orbit.h */
  double symmetry_defect; /* largest harmonic of the angle that mirror symmetry forbids */
} pendres_orbit_measures;

/* work: 2 n doubles. */
pendres_status pendres_orbit_measure(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     double *work, pendres_orbit_measures *out);

/* Lag of a first harmonic behind a drive of that amplitude; NaN if either vanishes. */
double pendres_orbit_phase_lag(double cosine, double sine, double drive_amplitude);

/*
 * Multipliers from the trace of the monodromy matrix and their geometric mean modulus, which is
 * known exactly (Liouville): exp(-damping time / 2); and whether both are inside the unit circle.
 */
void pendres_orbit_set_multipliers(double trace, double modulus, pendres_orbit *o);

/* Half the peak-to-peak of a Fourier series given by its harmonics 1, 2, ... */
double pendres_orbit_series_half_range(const double cosine[PENDRES_ORBIT_HARMONICS],
                                       const double sine[PENDRES_ORBIT_HARMONICS]);

/* Half the peak-to-peak of the trigonometric interpolant of n equally spaced values; work: n. */
pendres_status pendres_orbit_half_range(const double *y, size_t n, double *work, double *out);

/* Value at samples*count equally spaced points of the interpolant of n values. work: n. */
pendres_status pendres_orbit_interpolate(const double *y, size_t n, size_t points, double *work,
                                         double *out);

#endif
