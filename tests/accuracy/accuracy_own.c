/*
 * accuracy_own.c -- a simulation that has nothing in common with the library's: the classical
 * method of Runge and Kutta, of order four, with kicks of noise before and after each step; see
 * accuracy.h.
 */
#include "accuracy.h"

#include <math.h>

static const double two_pi = 6.28318530717958647693;

/* Marsaglia's polar method. */
static double normal(accuracy_random *r)
{
  for (;;) {
    const double a = accuracy_uniform(r, -1.0, 1.0), b = accuracy_uniform(r, -1.0, 1.0);
    const double square = a * a + b * b;
    if (square > 0.0 && square < 1.0) return a * sqrt(-2.0 * log(square) / square);
  }
}

static double force(const pendres_pendulum *p, double x)
{
  const double y = x - pendres_model_of(p->force)->origin;
  double sum = 0.0;
  if (p->force == PENDRES_FORCE_PENDULUM) return sin(y);
  if (p->force == PENDRES_FORCE_SQUID) return sin(y) + p->force_coefficients[0] * y;
  for (int k = PENDRES_FORCE_POWERS; k-- > 0;) sum = (sum + p->force_coefficients[k]) * y;
  return sum;
}

static pendres_pendulum pendulum_at(const accuracy_own *w, double period)
{
  pendres_pendulum p = w->pendulum;
  if (w->rate != 0.0) pendres_parameter_set(w->parameter, w->from + w->rate * period, &p);
  return p;
}

/* By the drive's phase. */
static void slope(const accuracy_own *w, double period, const double s[2], double out[2])
{
  const pendres_pendulum p = pendulum_at(w, period);
  const double cosine = cos(two_pi * (period - floor(period)));
  out[0] = s[1] / p.drive_frequency;
  out[1] = (p.torque + p.drive_amplitude * cosine - p.damping * s[1] -
            force(&p, s[0]) * (1.0 + p.parametric_amplitude * cosine)) / p.drive_frequency;
}

static void step(const accuracy_own *w, double period, double h, double s[2])
{
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double k[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0};
  for (int stage = 0; stage < 4; stage++) {
    const double at[2] = {s[0] + part[stage] * h * k[0], s[1] + part[stage] * h * k[1]};
    slope(w, period + part[stage] * h / two_pi, at, k);
    for (int j = 0; j < 2; j++) sum[j] += weight[stage] * k[j];
  }
  for (int j = 0; j < 2; j++) s[j] += h / 6.0 * sum[j];
}

void accuracy_own_period(const accuracy_own *w, long number, accuracy_random *noise, double s[2],
                         double harmonic[2])
{
  const double h = two_pi / w->steps;
  harmonic[0] = -s[0] / w->steps; /* by the trapezoidal rule: half of the ends */
  harmonic[1] = 0.0;
  for (int i = 0; i < w->steps; i++) {
    const double period = (double)number + (double)i / w->steps;
    const pendres_pendulum p = pendulum_at(w, period);
    const double kick = sqrt(p.damping * p.temperature * h / p.drive_frequency);
    harmonic[0] += 2.0 / w->steps * s[0] * cos(i * h);
    harmonic[1] += 2.0 / w->steps * s[0] * sin(i * h);
    if (noise != NULL) s[1] += kick * normal(noise);
    step(w, period, h, s);
    if (noise != NULL) s[1] += kick * normal(noise);
  }
  harmonic[0] += s[0] / w->steps;
}
