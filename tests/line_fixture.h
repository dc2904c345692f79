/*
 * line_fixture.h -- scattering parameters of a resonator on a line, by harmonic balance with two
 * harmonics, which has no code in common with the library: of x'' + g x' + x + c x^3 = F cos(w t)
 * with x = Re(A exp(i w t) + C exp(3 i w t)); see include/pendres/fit.h for what a line makes of A.
 * What is left out is of the fourth order in c A^2, which is some widths of the resonance.
 */
#ifndef LINE_FIXTURE_H
#define LINE_FIXTURE_H

#include <complex.h>
#include <math.h>
#include <stdint.h>

typedef struct lab_line {
  int kind; /* 0: transmission, 1: notch, 2: reflection */
  double f0, qi, qc, phase, delay, amplitude, angle, middle, leak[2], cubic, drive;
} lab_line;

static double line_damping(const lab_line *l)
{
  return 1.0 / l->qi + 1.0 / l->qc;
}

/* What is off where the first harmonic is A, over the drive. */
static double complex line_off(const lab_line *l, double w, double complex a)
{
  const double g = line_damping(l), u = creal(a * conj(a));
  const double complex c =
    -0.25 * l->cubic * a * a * a / (1.0 - 9.0 * w * w + 3.0 * I * w * g + 1.5 * l->cubic * u);
  const double complex pull = 0.75 * u * a + 0.75 * conj(a) * conj(a) * c +
                              1.5 * creal(c * conj(c)) * a;
  return (a * (1.0 - w * w + I * w * g) + l->cubic * pull) / l->drive - 1.0;
}

/* Newton's method; 0 where it leads away. */
static int line_polish(const lab_line *l, double w, double complex *a)
{
  const double size = cabs(*a);
  double complex at = *a;
  for (int i = 0; i < 20; i++) {
    const double h = 1e-6 * size;
    const double complex off = line_off(l, w, at);
    const double complex x = (line_off(l, w, at + h) - line_off(l, w, at - h)) / (2.0 * h);
    const double complex y = (line_off(l, w, at + I * h) - line_off(l, w, at - I * h)) / (2.0 * h);
    const double det = creal(x) * cimag(y) - cimag(x) * creal(y);
    const double dx = (creal(off) * cimag(y) - cimag(off) * creal(y)) / det;
    const double dy = (creal(x) * cimag(off) - cimag(x) * creal(off)) / det;
    at -= dx + I * dy;
    if (!(cabs(at - *a) < 0.2 * size)) return 0;
    if (hypot(dx, dy) < 1e-13 * size) break;
  }
  *a = at;
  return 1;
}

/* Squares of the amplitudes by the first harmonic alone, in order: one or three. */
static int line_sizes(const lab_line *l, double w, double u[3])
{
  const double g = line_damping(l), d = 1.0 - w * w, one = pow(l->drive / g, 2.0);
  const double k = 0.75 * l->cubic * one / g, p = d / g, q = p * p + w * w;
  u[0] = one / q;
  if (k == 0.0) return 1;
  /* (k t)^2 t + 2 p k t^2 + q t - 1 = 0 in t = u/one. */
  const double b = 2.0 * p / k, c = q / (k * k), e = -1.0 / (k * k);
  const double m = b / 3.0, r = c - b * b / 3.0, s = 2.0 * m * m * m - m * c + e;
  const double left = 0.25 * s * s + r * r * r / 27.0;
  if (left > 0.0) {
    u[0] = one * (cbrt(-0.5 * s + sqrt(left)) + cbrt(-0.5 * s - sqrt(left)) - m);
    return 1;
  }
  const double turn = acos(fmin(1.0, fmax(-1.0, -0.5 * s / sqrt(-r * r * r / 27.0)))) / 3.0;
  const double third = 2.0 * acos(-1.0) / 3.0, size = 2.0 * sqrt(-r / 3.0);
  u[0] = one * (size * cos(turn + third) - m);
  u[1] = one * (size * cos(turn - third) - m);
  u[2] = one * (size * cos(turn) - m);
  return 3;
}

static double complex line_start(const lab_line *l, double w, double u)
{
  return l->drive / (1.0 - w * w + 0.75 * l->cubic * u + I * w * line_damping(l));
}

/* S at a frequency, on the state next to *before, the amplitude's last square; 0: at rest. */
static inline double complex line_at(const lab_line *l, double f, double *before)
{
  const double w = f / l->f0, g = line_damping(l);
  double u[3];
  const int n = line_sizes(l, w, u);
  int at = 0;
  if (n == 3 && fabs(log(u[2] / (*before + 1e-300))) < fabs(log(u[0] / (*before + 1e-300)))) at = 2;
  double complex a = line_start(l, w, u[at]);
  if (!line_polish(l, w, &a)) {
    a = line_start(l, w, u[n - 1 - at]);
    (void)line_polish(l, w, &a);
  }
  *before = creal(a * conj(a));
  const double complex r = I * w * g * a / l->drive, slant = 1.0 + I * tan(l->phase);
  const double complex s = l->kind == 0 ? l->leak[0] + I * l->leak[1] + r
                                        : 1.0 - l->kind / (l->qc * g) * slant * r;
  return l->amplitude * cexp(I * (l->angle - 2.0 * acos(-1.0) * l->delay * (f - l->middle))) * s;
}

/* A sweep over n frequencies of one width after the other, real and imaginary parts. */
static inline void line_sweep(const lab_line *l, int n, const double *f, double *re, double *im)
{
  double before = 0.0;
  for (int i = 0; i < n; i++) {
    const double complex s = line_at(l, f[i], &before);
    re[i] = creal(s);
    im[i] = cimag(s);
  }
}

#endif
