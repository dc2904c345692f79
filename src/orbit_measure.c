/* orbit_measure.c -- measures of a closed orbit from its samples; see orbit_measure.h. */
#include "orbit_measure.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_real.h>

static const double two_pi = 6.28318530717958647693;

/*
 * Discrete Fourier coefficients of n real values in GSL's half-complex order; the wavetable is
 * made anew each time: a few microseconds beside the milliseconds of an orbit.
 */
static pendres_status transform(const double *y, size_t n, double *c)
{
  gsl_fft_real_wavetable *table = gsl_fft_real_wavetable_alloc(n);
  gsl_fft_real_workspace *work = gsl_fft_real_workspace_alloc(n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (table != NULL && work != NULL) {
    memcpy(c, y, n * sizeof *c);
    status = gsl_fft_real_transform(c, 1, n, table, work) == GSL_SUCCESS ? PENDRES_OK
                                                                        : PENDRES_INTERNAL;
  }
  if (table != NULL) gsl_fft_real_wavetable_free(table);
  if (work != NULL) gsl_fft_real_workspace_free(work);
  return status;
}

/* Value and first two derivatives by phase of the series with half-complex coefficients c. */
static void evaluate(const double *c, size_t n, double phase, double out[3])
{
  const double turn_re = cos(phase), turn_im = sin(phase);
  double re = 1.0, im = 0.0;
  out[0] = c[0] / (double)n;
  out[1] = out[2] = 0.0;
  for (size_t m = 1; 2 * m <= n; m++) {
    const double next = re * turn_re - im * turn_im;
    im = re * turn_im + im * turn_re;
    re = next;
    const int nyquist = 2 * m == n;
    const double a = c[2 * m - 1], b = nyquist ? 0.0 : c[2 * m], k = (double)m;
    const double scale = (nyquist ? 1.0 : 2.0) / (double)n;
    out[0] += scale * (a * re - b * im);
    out[1] += scale * k * (-a * im - b * re);
    out[2] += scale * k * k * (-a * re + b * im);
  }
}

/* The extreme of the interpolant next to sample number k, by Newton on its slope. */
static double extreme_near(const double *c, size_t n, size_t k)
{
  const double spacing = two_pi / (double)n, start = spacing * (double)k;
  double phase = start, f[3];
  evaluate(c, n, phase, f);
  for (int i = 0; i < 8; i++) {
    if (f[2] == 0.0) break;
    const double next = phase - f[1] / f[2];
    /* A flat or inflected top: the sample itself is the best there is. */
    if (!(fabs(next - start) <= 1.5 * spacing)) {
      evaluate(c, n, start, f);
      break;
    }
    const double step = fabs(next - phase);
    phase = next;
    evaluate(c, n, phase, f);
    if (step < 1e-9) break; /* the value is flat there: settled to 1e-18 */
  }
  return f[0];
}

double pendres_orbit_series_half_range(const double cosine[PENDRES_ORBIT_HARMONICS],
                                       const double sine[PENDRES_ORBIT_HARMONICS])
{
  enum { POINTS = 2 * PENDRES_ORBIT_HARMONICS + 2 };
  double c[POINTS] = {0.0}, value[3];
  size_t top = 0, bottom = 0;
  double highest = -INFINITY, lowest = INFINITY;
  for (int m = 1; m <= PENDRES_ORBIT_HARMONICS; m++) {
    c[2 * m - 1] = 0.5 * POINTS * cosine[m - 1];
    c[2 * m] = -0.5 * POINTS * sine[m - 1];
  }
  for (size_t k = 0; k < POINTS; k++) {
    evaluate(c, POINTS, two_pi * (double)k / POINTS, value);
    if (value[0] > highest) highest = value[0], top = k;
    if (value[0] < lowest) lowest = value[0], bottom = k;
  }
  return 0.5 * (extreme_near(c, POINTS, top) - extreme_near(c, POINTS, bottom));
}

pendres_status pendres_orbit_half_range(const double *y, size_t n, double *work, double *out)
{
  size_t top = 0, bottom = 0;
  const pendres_status status = transform(y, n, work);
  if (status != PENDRES_OK) return status;
  for (size_t k = 1; k < n; k++) {
    if (y[k] > y[top]) top = k;
    if (y[k] < y[bottom]) bottom = k;
  }
  /* At rest rounding may put the top below the bottom. */
  *out = fmax(0.0, 0.5 * (extreme_near(work, n, top) - extreme_near(work, n, bottom)));
  return PENDRES_OK;
}

pendres_status pendres_orbit_interpolate(const double *y, size_t n, size_t points, double *work,
                                         double *out)
{
  const pendres_status status = transform(y, n, work);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < points; i++) {
    double f[3];
    evaluate(work, n, two_pi * (double)i / (double)points, f);
    out[i] = f[0];
  }
  return PENDRES_OK;
}

/*
 * Largest harmonic that a mirror-symmetric orbit does not have. Such an orbit is its own mirror
 * image about its mean k half drive periods later, k odd, and closes after k whole ones: with odd
 * q that is half of the whole orbit, y(theta + q pi) = -y(theta), which leaves odd harmonics of it.
 * What is given with an even q closes earlier, if it has the symmetry, and is read that often.
 */
static double symmetry_defect(const double *c, size_t n, int q)
{
  double largest = 0.0;
  size_t closures = 1;
  while ((size_t)q % (2 * closures) == 0) closures *= 2;
  for (size_t m = 1; 2 * m < n; m++) {
    const int odd = m % closures == 0 && (m / closures) % 2 == 1;
    const double size = 2.0 / (double)n * hypot(c[2 * m - 1], c[2 * m]);
    if (!odd && size > largest) largest = size;
  }
  return largest;
}

pendres_status pendres_orbit_measure(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     double *work, pendres_orbit_measures *out)
{
  const size_t n = s->n;
  const double spacing = two_pi * s->period / (double)n;
  double *periodic = work, *coefficients = work + n;
  double cos_w = 0.0, w_w = 0.0, mean = 0.0;

  for (size_t k = 0; k < n; k++) {
    const double theta = spacing * (double)k;
    periodic[k] = s->y[k] - s->winding * theta / s->period;
    mean += periodic[k];
    cos_w += cos(theta) * s->w[k];
    w_w += s->w[k] * s->w[k];
  }
  out->loop_area = p->drive_amplitude * two_pi * cos_w / (double)n;
  out->dissipation = p->damping * p->drive_frequency * two_pi * w_w / (double)n;
  out->mean_angle = mean / (double)n;
  const pendres_status status =
    pendres_orbit_half_range(periodic, n, coefficients, &out->amplitude);
  if (status != PENDRES_OK) return status;
  out->symmetry_defect = symmetry_defect(coefficients, n, s->period);
  for (int m = 1; m <= PENDRES_ORBIT_HARMONICS; m++) {
    /* Harmonic m of the drive is number m q of the whole orbit. */
    const size_t i = 2 * (size_t)m * (size_t)s->period;
    const int there = i < n;
    out->cosine[m - 1] = there ? 2.0 / (double)n * coefficients[i - 1] : 0.0;
    out->sine[m - 1] = there ? -2.0 / (double)n * coefficients[i] : 0.0;
  }
  return PENDRES_OK;
}

double pendres_orbit_phase_lag(double cosine, double sine, double drive_amplitude)
{
  if (hypot(cosine, sine) == 0.0 || drive_amplitude == 0.0) return NAN;
  /* The drive is F0 cos theta: with F0 < 0 it leads by half a turn. */
  return drive_amplitude > 0.0 ? atan2(sine, cosine) : atan2(-sine, -cosine);
}

void pendres_orbit_set_multipliers(double trace, double modulus, pendres_orbit *o)
{
  /* The product of the two, the square of modulus, may be too small for a double: do without. */
  const double half = 0.5 * trace;
  o->multiplier_re[0] = o->multiplier_re[1] = half;
  o->multiplier_im[0] = o->multiplier_im[1] = 0.0;
  if (fabs(half) < modulus) {
    const double share = half / modulus;
    o->multiplier_im[0] = modulus * sqrt((1.0 - share) * (1.0 + share));
    o->multiplier_im[1] = -o->multiplier_im[0];
  } else if (half != 0.0) {
    /* The larger root first, the other from the product: no cancellation. */
    const double share = modulus / half, larger = 1.0 + sqrt((1.0 - share) * (1.0 + share));
    o->multiplier_re[0] = half * larger;
    o->multiplier_re[1] = modulus * share / larger;
  }
  o->stable = hypot(o->multiplier_re[0], o->multiplier_im[0]) < 1.0;
}
