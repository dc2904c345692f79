/*
 * line.h -- scattering parameters of a resonance on a line: what they are of a motion, and where a
 * fit of them begins.
 *
 * Time goes as exp(i w t). With the first harmonic Re(A exp(i w t)) of the displacement under a
 * drive F the velocity over what the damping makes of it is r = i w damping A/F, which is 1 on a
 * linear resonance and 1/(1 + 2i Q (w - w0)/w0) next to it. Seen through a cable
 *
 *   S = amplitude exp(i angle - 2 pi i delay (f - f_middle)) s,
 *   transmission s = leak + r,
 *   notch        s = 1 - coupling/damping (1 + i tan(phase)) r,
 *   reflection   s = 1 - 2 coupling/damping (1 + i tan(phase)) r,
 *
 * with coupling and damping as rates, w0/Qc and w0/Qi + w0/Qc. Source: Khalil et al., Journal of
 * Applied Physics 111 (2012) 054510; Probst et al., Review of Scientific Instruments 86 (2015)
 * 024706.
 */
#ifndef PENDRES_LINE_H
#define PENDRES_LINE_H

#include <complex.h>
#include <stddef.h>

typedef enum pendres_line_kind {
  PENDRES_LINE_TRANSMISSION,
  PENDRES_LINE_NOTCH,
  PENDRES_LINE_REFLECTION
} pendres_line_kind;

typedef struct pendres_line {
  pendres_line_kind kind;
  double coupling, phase, delay, amplitude, angle, leak[2];
} pendres_line;

/* A motion: R cos(lag), R sin(lag) of its first harmonic, and under what; from_middle: of the
   data's frequencies, in their unit. */
typedef struct pendres_line_motion {
  double in_phase, quadrature, drive, omega, damping, from_middle;
} pendres_line_motion;

/* What S is, and its derivatives by what it depends on beside other things; by_omega: without that
   by the frequency of the data. */
typedef struct pendres_line_value {
  double complex s, by_in_phase, by_quadrature, by_drive, by_omega, by_damping, by_coupling,
    by_phase, by_delay, by_amplitude, by_angle, by_from_middle, by_leak[2];
} pendres_line_value;

void pendres_line_measure(const pendres_line *l, const pendres_line_motion *m,
                          pendres_line_value *out);

/* A resonance found in data alone: S = exp(-2 pi i delay f) (far + residue/(f - place - bend p)), p
   being |residue/(...)|^2 times the square of the drive. place is complex: half of the width is its
   imaginary part. f is from the middle of the data. */
typedef struct pendres_line_guess {
  double complex far, residue, place;
  double bend, delay;
  double left; /* mean square of what it leaves of the data */
} pendres_line_guess;

/* Data in the order of the sweeps: frequencies from their middle, S, drives over the largest. */
typedef struct pendres_line_data {
  size_t n;
  const double *f, *drive;
  const double complex *s;
  double complex *work; /* [n] */
} pendres_line_data;

/* Guesses, the better first, one of them bent: with the delay, unless that is known and not NaN,
   from the slope of the phase; far is 0 where there is no leak. Returns how many there are, -1
   without memory. */
int pendres_line_find(const pendres_line_data *d, pendres_line_kind kind, int leaks, double delay,
                      pendres_line_guess out[2]);

#endif
