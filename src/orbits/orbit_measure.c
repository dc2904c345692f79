/* orbit_measure.c -- measures of a closed orbit from its samples; see orbit_measure.h. */
#include "orbits/orbit_measure.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "model/equation.h"
#include "model/model.h"

pendres_status pendres_orbit_samples_series(const pendres_pendulum *p,
                                            const pendres_orbit_samples *s, double *work,
                                            pendres_orbit_series *out)
{
  const size_t n = s->n;
  const double spacing = two_pi * s->period / (double)n, q = s->period;
  double *const sample[3] = {work, work + n, work + 2 * n};
  const double *cosine = pendres_orbit_tables_cosine(s->tables, n, s->period);
  if (cosine == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t k = 0; k < n; k++) {
    const double theta = spacing * (double)k;
    sample[0][k] = s->y[k] - s->winding * theta / q;
    sample[1][k] = q * s->w[k] - s->winding;
    sample[2][k] = q * q * pendres_model_slope(p, s->y[k], s->w[k], cosine[k]);
  }
  return pendres_orbit_series_build(s->tables, n, sample, work + 3 * n, out);
}

/*
 * The largest harmonic that a mirror-symmetric orbit does not have. Such an orbit is its own mirror
 * image k half drive periods later, k odd, and closes after k whole ones: y(theta + k pi) =
 * -y(theta), which leaves odd harmonics of the k periods. An orbit that is given with an even q
 * closes after k = q / 2, q / 4, ... periods already, if it has the symmetry, and is passed through
 * several times.
 */
static double symmetry_defect(const pendres_orbit_series *s, int q)
{
  double largest = 0.0;
  size_t closures = 1;
  while ((size_t)q % (2 * closures) == 0) closures *= 2;
  for (size_t m = 1; m < s->modes; m++) {
    const int odd = m % (2 * closures) == closures;
    const double square = s->re[m] * s->re[m] + s->im[m] * s->im[m];
    if (!odd && square > largest) largest = square;
  }
  return 2.0 * sqrt(largest);
}

/* Keep the harmonics of the drive frequency, which are numbers q, 2 q, ... of the whole orbit. */
static void keep_harmonics(const pendres_orbit_series *s, int q, pendres_orbit_measures *out)
{
  double rest = 0.0;
  for (size_t m = 1; m < s->modes && m < PENDRES_ORBIT_SPECTRUM; m++) {
    out->spectrum[2 * m] = s->re[m];
    out->spectrum[2 * m + 1] = s->im[m];
  }
  for (size_t m = (size_t)q, harmonic = 1; m < s->modes; m += (size_t)q, harmonic++) {
    if (harmonic > PENDRES_ORBIT_HARMONICS) {
      rest += 2.0 * hypot(s->re[m], s->im[m]);
      continue;
    }
    out->cosine[harmonic - 1] = 2.0 * s->re[m];
    out->sine[harmonic - 1] = -2.0 * s->im[m];
  }
  out->spectrum[0] = s->re[0];
  out->harmonics_rest = rest;
}

/*
 * The mean of dh/dv over samples of a closed orbit, which has no ends: equal weights are right to
 * all orders but where |v| bends. There w = a (theta - c), with c at the share t of a step h, adds
 * h^2 |a| (t^2 - t + 1/6) to the integral of |w| (Euler and Maclaurin).
 */
static pendres_orbit_value contraction_of(const pendres_pendulum *p, const pendres_orbit_samples *s)
{
  const double omega = p->drive_frequency, n = (double)s->n;
  double sum = 0.0, squares = 0.0;
  if (!pendres_equation_drags(p))
    return (pendres_orbit_value){pendres_equation_contraction(p), 0.0, 0.0};
  for (size_t k = 0; k < s->n; k++) {
    const double w = s->w[k], next = s->w[k + 1 < s->n ? k + 1 : 0];
    const double by_v = 2.0 * (p->quadratic_damping + 3.0 * p->cubic_damping * fabs(omega * w));
    const double by_w = omega * by_v, by_y = 2.0 * p->nonlinear_damping * s->y[k];
    sum += pendres_equation_drag(p, s->y[k], omega * w);
    squares += by_w * by_w + by_y * by_y;
    if ((w < 0.0) == (next < 0.0)) continue;
    const double t = w / (w - next);
    sum += 2.0 * p->quadratic_damping * omega * fabs(next - w) * (t * t - t + 1.0 / 6.0);
  }
  return (pendres_orbit_value){sum / n, sqrt(squares / n), 0.0};
}

pendres_status pendres_orbit_measure(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     double *work, pendres_orbit_measures *out)
{
  const double q = s->period;
  pendres_orbit_series series;
  double highest = 0.0, lowest = 0.0, square = (s->winding / q) * (s->winding / q);

  memset(out, 0, sizeof *out);
  pendres_status status = pendres_orbit_samples_series(p, s, work, &series);
  if (status == PENDRES_OK)
    status = pendres_orbit_series_extremes(s->tables, &series, &highest, &lowest);
  if (status != PENDRES_OK) return status;
  for (size_t m = 1; m < series.modes; m++) {
    const double by_phase = (double)m / q;
    square += 2.0 * by_phase * by_phase *
              (series.re[m] * series.re[m] + series.im[m] * series.im[m]);
  }
  keep_harmonics(&series, s->period, out);
  out->mean_angle = series.re[0];
  /* At rest rounding may put the top below the bottom. */
  out->amplitude = fmax(0.0, 0.5 * (highest - lowest));
  out->unresolved = pendres_orbit_series_tail(&series);
  out->square_speed = square;
  out->contraction = contraction_of(p, s);
  out->bends = p->quadratic_damping != 0.0 ? two_pi * q / (double)s->n : 0.0;
  out->symmetry_defect = symmetry_defect(&series, s->period);
  return PENDRES_OK;
}

double pendres_orbit_measures_apart(const pendres_orbit_measures *a,
                                    const pendres_orbit_measures *b, int period)
{
  double sum = (a->spectrum[0] - b->spectrum[0]) * (a->spectrum[0] - b->spectrum[0]);
  for (int m = 1; m < PENDRES_ORBIT_SPECTRUM; m++) {
    const double re = a->spectrum[2 * m] - b->spectrum[2 * m];
    const double im = a->spectrum[2 * m + 1] - b->spectrum[2 * m + 1];
    const double by_phase = (double)m / period;
    sum += 2.0 * fmax(1.0, by_phase * by_phase) * (re * re + im * im);
  }
  return sqrt(sum);
}

double pendres_orbit_series_half_range(const double cosine[PENDRES_ORBIT_HARMONICS],
                                       const double sine[PENDRES_ORBIT_HARMONICS])
{
  enum { MODES = PENDRES_ORBIT_HARMONICS + 1, SAMPLES = 2 * MODES / 3 + 1 };
  double memory[2 * MODES + 3 * SAMPLES] = {0.0}, highest = NAN, lowest = NAN;
  const pendres_orbit_series s = {
    .samples = SAMPLES, .modes = MODES, .re = memory, .im = memory + MODES};
  for (int m = 1; m < MODES; m++) {
    s.re[m] = 0.5 * cosine[m - 1];
    s.im[m] = -0.5 * sine[m - 1];
  }
  pendres_orbit_tables tables = {0};
  const pendres_status status = pendres_orbit_series_extremes(&tables, &s, &highest, &lowest);
  pendres_orbit_tables_free(&tables);
  return status == PENDRES_OK ? 0.5 * (highest - lowest) : NAN;
}

double pendres_orbit_phase_lag(double cosine, double sine, double drive_amplitude)
{
  if (hypot(cosine, sine) == 0.0 || drive_amplitude == 0.0) return NAN;
  /* The drive is F0 cos theta: with F0 < 0 it leads by half a turn. */
  return drive_amplitude > 0.0 ? atan2(sine, cosine) : atan2(-sine, -cosine);
}

void pendres_orbit_set_multipliers(double trace, double modulus, pendres_orbit *o)
{
  /* The product of the two, modulus^2, may be too small for a double, and is not formed. */
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

double pendres_orbit_contraction(const pendres_orbit *o)
{
  const double rate = pendres_equation_contraction(&o->pendulum);
  const double *re = o->multiplier_re, im = o->multiplier_im[0];
  if (!isnan(rate)) return rate;
  return -log(re[0] * re[1] + im * im) * o->pendulum.drive_frequency / (two_pi * o->period);
}
