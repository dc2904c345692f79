/*
 * orbit_series.h -- the Fourier series of a closed curve from samples of it and its derivatives.
 *
 * Owns: transforms, values and extremes of a series. The n values alone determine harmonics up to
 * n / 2, and higher ones are mistaken for lower ones (aliasing). A pendulum's slope and second
 * derivative are known at every step as well; the three together determine harmonics up to 3 n / 2.
 */
#ifndef PENDRES_ORBIT_SERIES_H
#define PENDRES_ORBIT_SERIES_H

#include <stddef.h>

#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>

#include <pendres/orbit.h>
#include <pendres/status.h>

/*
 * Sines and cosines for the transforms, which cost about as much as a transform itself, and of the
 * drive: kept for the next orbit with the same number of samples. Starts as {0} and is freed by its
 * owner.
 */
typedef struct pendres_orbit_tables {
  gsl_fft_real_wavetable *forward;
  gsl_fft_halfcomplex_wavetable *backward;
  gsl_fft_real_workspace *work, *dense_work;
  double *cosine; /* of n equal steps of so many turns */
  size_t cosines;
  int turns;
} pendres_orbit_tables;

void pendres_orbit_tables_free(pendres_orbit_tables *t);

/* cos(2 pi turns k / n), k < n; NULL without memory. */
const double *pendres_orbit_tables_cosine(pendres_orbit_tables *t, size_t n, int turns);

/* y(phase) = re[0] + sum over m >= 1 of 2 (re[m] cos m phase - im[m] sin m phase), m < modes. */
typedef struct pendres_orbit_series {
  size_t samples, modes;
  double *re, *im; /* in the caller's memory */
} pendres_orbit_series;

/* Doubles that a series of n samples and its extremes need, and which the caller owns. */
static inline size_t pendres_orbit_series_memory(size_t n)
{
  return 6 * n + 8;
}

/*
 * From n >= 1 equally spaced values, sample[0], slopes, [1], and second derivatives by phase, [2],
 * 0 to 2 pi; all three are overwritten. memory: pendres_orbit_series_memory(n).
 */
pendres_status pendres_orbit_series_build(pendres_orbit_tables *tables, size_t n,
                                          double *const sample[3], double *memory,
                                          pendres_orbit_series *out);

/* Value and first two derivatives at a phase. */
void pendres_orbit_series_at(const pendres_orbit_series *s, double phase, double out[3]);

/* The series, or its derivative by phase, at `points` >= 1 equally spaced phases from 0 on. */
pendres_status pendres_orbit_series_spread(pendres_orbit_tables *tables,
                                           const pendres_orbit_series *s, int derivative,
                                           size_t points, double *out);

/* Largest and smallest value. */
pendres_status pendres_orbit_series_extremes(pendres_orbit_tables *tables,
                                             const pendres_orbit_series *s, double *highest,
                                             double *lowest);

/* What harmonics beyond the last may add to a value: as much as the highest ones that are known. */
double pendres_orbit_series_tail(const pendres_orbit_series *s);

/*
 * Add the harmonics of the angle, averaged over the orbit's drive cycles and times share, to those
 * of a series. The orbit is integrated with the number of steps with which it was found. The mean
 * of the series stays as it is.
 */
pendres_status pendres_orbit_add_harmonics(pendres_context *ctx, const pendres_orbit *orbit,
                                           double share, pendres_orbit_series *sum);

#endif
