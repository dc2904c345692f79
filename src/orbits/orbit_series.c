/* orbit_series.c -- Fourier series of closed curves; see orbit_series.h. */
#include "orbits/orbit_series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "base/angles.h"
#include "base/grow.h"

void pendres_orbit_tables_free(pendres_orbit_tables *t)
{
  if (t->forward != NULL) gsl_fft_real_wavetable_free(t->forward);
  if (t->backward != NULL) gsl_fft_halfcomplex_wavetable_free(t->backward);
  if (t->work != NULL) gsl_fft_real_workspace_free(t->work);
  if (t->dense_work != NULL) gsl_fft_real_workspace_free(t->dense_work);
  free(t->cosine);
  *t = (pendres_orbit_tables){0};
}

const double *pendres_orbit_tables_cosine(pendres_orbit_tables *t, size_t n, int turns)
{
  if (t->cosines == n && t->turns == turns) return t->cosine;
  t->cosines = 0;
  if (!pendres_regrow(&t->cosine, n, sizeof *t->cosine)) return NULL;
  const double spacing = two_pi * turns / (double)n;
  for (size_t k = 0; k < n; k++) t->cosine[k] = cos(spacing * (double)k);
  t->cosines = n;
  t->turns = turns;
  return t->cosine;
}

/* Make the tables that n samples are transformed with, unless they are there already. */
static pendres_status provide_forward(pendres_orbit_tables *t, size_t n)
{
  if (t->forward != NULL && t->forward->n == n) return PENDRES_OK;
  if (t->forward != NULL) gsl_fft_real_wavetable_free(t->forward);
  if (t->work != NULL) gsl_fft_real_workspace_free(t->work);
  t->work = NULL;
  t->forward = gsl_fft_real_wavetable_alloc(n);
  if (t->forward != NULL) t->work = gsl_fft_real_workspace_alloc(n);
  if (t->work != NULL) return PENDRES_OK;
  pendres_orbit_tables_free(t);
  return PENDRES_OUT_OF_MEMORY;
}

/* The same for the inverse transform, to a number of points. */
static pendres_status provide_backward(pendres_orbit_tables *t, size_t points)
{
  if (t->backward != NULL && t->backward->n == points) return PENDRES_OK;
  if (t->backward != NULL) gsl_fft_halfcomplex_wavetable_free(t->backward);
  if (t->dense_work != NULL) gsl_fft_real_workspace_free(t->dense_work);
  t->dense_work = NULL;
  t->backward = gsl_fft_halfcomplex_wavetable_alloc(points);
  if (t->backward != NULL) t->dense_work = gsl_fft_real_workspace_alloc(points);
  if (t->dense_work != NULL) return PENDRES_OK;
  pendres_orbit_tables_free(t);
  return PENDRES_OUT_OF_MEMORY;
}

/* Transform three arrays in place, into coefficients in GSL's half-complex order. */
static pendres_status transform(pendres_orbit_tables *t, size_t n, double *const values[3])
{
  pendres_status status = provide_forward(t, n);
  for (int i = 0; i < 3 && status == PENDRES_OK; i++)
    if (gsl_fft_real_transform(values[i], 1, n, t->forward, t->work) != GSL_SUCCESS)
      status = PENDRES_INTERNAL;
  return status;
}

typedef struct complex_number {
  double re, im;
} complex_number;

/* Coefficient k <= n / 2 of a transform, a mean over the samples. */
static complex_number coefficient(const double *c, size_t n, size_t k)
{
  if (k == 0) return (complex_number){c[0] / (double)n, 0.0};
  if (2 * k == n) return (complex_number){c[2 * k - 1] / (double)n, 0.0};
  return (complex_number){c[2 * k - 1] / (double)n, c[2 * k] / (double)n};
}

/*
 * Samples cannot tell harmonic k from k - n and k + n, but slopes weigh them by i k, i (k - n),
 * i (k + n) and second derivatives by the squares: three equations for three harmonics. They are
 * solved by Lagrange's polynomials; no quotient is larger than two.
 */
static void unfold(size_t n, size_t k, double *const sample[3], pendres_orbit_series *out)
{
  const complex_number a = coefficient(sample[0], n, k), b = coefficient(sample[1], n, k);
  const complex_number c = coefficient(sample[2], n, k);
  const double N = (double)n, u = (double)k;
  /* Sums of a_m, of m a_m and of m^2 a_m over the three m. */
  const double s0[2] = {a.re, a.im}, s1[2] = {b.im, -b.re}, s2[2] = {-c.re, -c.im};
  double below[2], here[2], above[2];
  for (int i = 0; i < 2; i++) {
    here[i] = s0[i] - (s2[i] - 2.0 * u * s1[i] + u * u * s0[i]) / (N * N);
    above[i] = 0.5 * (s2[i] - (2.0 * u - N) * s1[i] + u * (u - N) * s0[i]) / (N * N);
    below[i] = 0.5 * (s2[i] - (2.0 * u + N) * s1[i] + u * (u + N) * s0[i]) / (N * N);
  }
  out->re[k] = here[0];
  out->im[k] = k == 0 ? 0.0 : here[1];
  out->re[n + k] = above[0];
  out->im[n + k] = above[1];
  if (k == 0) return; /* -n is the conjugate of n */
  out->re[n - k] = below[0];
  out->im[n - k] = -below[1];
}

/* With an even number of samples, in the middle: harmonics n/2 and -n/2, which are conjugate. Those
   of 3n/2 are left out. */
static void unfold_middle(size_t n, double *const sample[3], pendres_orbit_series *out)
{
  const size_t k = n / 2;
  out->re[k] = 0.5 * coefficient(sample[0], n, k).re;
  out->im[k] = -0.5 * coefficient(sample[1], n, k).re / (double)k;
}

pendres_status pendres_orbit_series_build(pendres_orbit_tables *tables, size_t n,
                                          double *const sample[3], double *memory,
                                          pendres_orbit_series *out)
{
  const pendres_status status = transform(tables, n, sample);
  if (status != PENDRES_OK) return status;
  const size_t last = (n - 1) / 2;
  *out = (pendres_orbit_series){
    .samples = n, .modes = n + last + 1, .re = memory, .im = memory + n + last + 1};
  for (size_t k = 0; k <= last; k++) unfold(n, k, sample, out);
  if (n % 2 == 0) unfold_middle(n, sample, out);
  return PENDRES_OK;
}

void pendres_orbit_series_at(const pendres_orbit_series *s, double phase, double out[3])
{
  const double turn_re = cos(phase), turn_im = sin(phase);
  double re = 1.0, im = 0.0;
  out[0] = s->re[0];
  out[1] = out[2] = 0.0;
  for (size_t m = 1; m < s->modes; m++) {
    const double next = re * turn_re - im * turn_im, k = (double)m;
    im = re * turn_im + im * turn_re;
    re = next;
    const double a = 2.0 * s->re[m], b = 2.0 * s->im[m];
    out[0] += a * re - b * im;
    out[1] += k * (-a * im - b * re);
    out[2] += k * k * (-a * re + b * im);
  }
}

pendres_status pendres_orbit_series_spread(pendres_orbit_tables *t, const pendres_orbit_series *s,
                                           int derivative, size_t points, double *out)
{
  const pendres_status status = provide_backward(t, points);
  if (status != PENDRES_OK) return status;
  memset(out, 0, points * sizeof *out);
  if (!derivative) out[0] = s->re[0];
  for (size_t m = 1; m < s->modes; m++) {
    const double re = derivative ? -(double)m * s->im[m] : s->re[m];
    const double im = derivative ? (double)m * s->re[m] : s->im[m];
    /* Harmonics that points cannot tell apart have the same values there. */
    const size_t rest = m < points ? m : m % points;
    const size_t k = 2 * rest > points ? points - rest : rest;
    if (k == 0 || 2 * k == points) {
      out[k > 0 ? points - 1 : 0] += 2.0 * re;
      continue;
    }
    out[2 * k - 1] += re;
    out[2 * k] += k == rest ? im : -im;
  }
  return gsl_fft_halfcomplex_backward(out, 1, points, t->backward, t->dense_work) == GSL_SUCCESS
           ? PENDRES_OK
           : PENDRES_INTERNAL;
}

/* Two numbers side by side: each operation waits for the one before, and takes as long for both. */
typedef double pair __attribute__((vector_size(2 * sizeof(double))));

/* Values and first two derivatives at two phases, as pendres_orbit_series_at(). */
static void at_both(const pendres_orbit_series *s, const double phase[2], double out[2][3])
{
  const pair turn_re = {cos(phase[0]), cos(phase[1])}, turn_im = {sin(phase[0]), sin(phase[1])};
  pair re = {1.0, 1.0}, im = {0.0, 0.0}, f[3] = {{s->re[0], s->re[0]}, {0.0, 0.0}, {0.0, 0.0}};
  for (size_t m = 1; m < s->modes; m++) {
    const pair next = re * turn_re - im * turn_im;
    const double k = (double)m, a = 2.0 * s->re[m], b = 2.0 * s->im[m];
    im = re * turn_im + im * turn_re;
    re = next;
    f[0] += a * re - b * im;
    f[1] += k * (-a * im - b * re);
    f[2] += k * k * (-a * re + b * im);
  }
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) out[i][k] = f[k][i];
}

/* The values of the extremes next to two of n points, by Newton's method on the slope. */
static void extremes_near(const pendres_orbit_series *s, size_t n, const size_t point[2],
                          double value[2])
{
  const double spacing = two_pi / (double)n;
  const double start[2] = {spacing * (double)point[0], spacing * (double)point[1]};
  double phase[2] = {start[0], start[1]}, f[2][3];
  int going[2] = {1, 1};
  at_both(s, phase, f);
  for (int i = 0; i < 8 && (going[0] || going[1]); i++) {
    for (int k = 0; k < 2; k++) {
      if (!going[k]) continue;
      const double next = f[k][2] != 0.0 ? phase[k] - f[k][1] / f[k][2] : phase[k];
      /* Newton's method leaves a top that is flat or inflected: the point itself is taken. */
      const int leaves = !(fabs(next - start[k]) <= 1.5 * spacing);
      /* Where a step is as short as that, the value is flat, and off by 1e-18 at most. */
      going[k] = !leaves && fabs(next - phase[k]) >= 1e-9;
      phase[k] = leaves ? start[k] : next;
    }
    at_both(s, phase, f);
  }
  for (int k = 0; k < 2; k++) value[k] = f[k][0];
}

/*
 * The largest of sign times the series, from its values at n points, the largest of them and that
 * next to it. Between other points a higher top may lie. It rises above its highest point by no
 * more than that point is above its neighbours.
 */
static double largest(const pendres_orbit_series *s, size_t n, const double *y, double sign,
                      size_t top, double best)
{
  double before = sign * y[n - 1], here = sign * y[0];
  for (size_t k = 0; k < n; k++) {
    const double after = sign * (k + 1 < n ? y[k + 1] : y[0]);
    if (k != top && before <= here && after <= here &&
        here + fmax(here - before, here - after) > best) {
      double value[2];
      extremes_near(s, n, (const size_t[]){k, k}, value);
      best = fmax(best, sign * value[0]);
    }
    before = here;
    here = after;
  }
  return best;
}

pendres_status pendres_orbit_series_extremes(pendres_orbit_tables *tables,
                                             const pendres_orbit_series *s, double *highest,
                                             double *lowest)
{
  const size_t points = 3 * s->samples;
  double *dense = s->im + s->modes, value[2];
  size_t end[2] = {0, 0};
  const pendres_status status = pendres_orbit_series_spread(tables, s, 0, points, dense);
  if (status != PENDRES_OK) return status;
  for (size_t k = 1; k < points; k++) {
    if (dense[k] > dense[end[0]]) end[0] = k;
    if (dense[k] < dense[end[1]]) end[1] = k;
  }
  extremes_near(s, points, end, value);
  *highest = largest(s, points, dense, 1.0, end[0], value[0]);
  *lowest = -largest(s, points, dense, -1.0, end[1], -value[1]);
  return PENDRES_OK;
}

double pendres_orbit_series_tail(const pendres_orbit_series *s)
{
  double sum = 0.0;
  for (size_t m = s->modes - 1 - s->modes / 6; m < s->modes; m++)
    sum += s->re[m] * s->re[m] + s->im[m] * s->im[m];
  return 2.0 * sqrt(sum);
}
