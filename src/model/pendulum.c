/* pendulum.c -- the model and its exact neighbours; see pendulum.h. */
#include <pendres/free.h>
#include <pendres/pendulum.h>

#include <float.h>
#include <math.h>
#include <stddef.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_ellint.h>

#include "base/angles.h"
#include "model/equation.h"
#include "model/model.h"

pendres_status pendres_pendulum_check(const pendres_pendulum *p, const char **why)
{
  const char *reason = NULL;
  if (p == NULL) reason = "no pendulum was given";
  else if (!(isfinite(p->damping) && p->damping >= 0.0))
    reason = "the damping must be finite and not negative";
  else if (!isfinite(p->drive_amplitude)) reason = "the drive amplitude must be finite";
  else if (!(isfinite(p->drive_frequency) && p->drive_frequency > 0.0))
    reason = "the drive frequency must be finite and positive";
  else if (!(isfinite(p->temperature) && p->temperature >= 0.0))
    reason = "the temperature must be finite and not negative";
  else reason = pendres_model_check(p);
  if (reason == NULL) return PENDRES_OK;
  if (why != NULL) *why = reason;
  return PENDRES_INVALID_ARGUMENT;
}

double pendres_pendulum_acceleration(const pendres_pendulum *p, double x, double v, double t)
{
  if (p == NULL || pendres_model_of(p->force) == NULL) return NAN;
  const double drive = cos(p->drive_frequency * t);
  if (pendres_model_kind(p) == PENDRES_MODEL_PLAIN)
    return cos(x) - pendres_equation_friction(p, 0.0, v) * v + p->drive_amplitude * drive;
  double force, slope;
  const double y = x - pendres_model_of(p->force)->origin;
  pendres_model_force(p, y, &force, &slope);
  return p->torque + p->drive_amplitude * drive - pendres_equation_friction(p, y, v) * v -
         force * (1.0 + p->parametric_amplitude * drive);
}

double pendres_model_slope(const pendres_pendulum *p, double y, double w, double cosine)
{
  const double omega = p->drive_frequency;
  double force, slope;
  pendres_model_force(p, y, &force, &slope);
  const double push =
    p->torque + p->drive_amplitude * cosine - force * (1.0 + p->parametric_amplitude * cosine);
  return push / (omega * omega) - pendres_equation_friction(p, y, w * omega) / omega * w;
}

void pendres_model_jacobian(const pendres_pendulum *p, double x, double v, double *dx, double *dv)
{
  if (dx != NULL && p != NULL && pendres_model_of(p->force) == NULL) {
    *dx = NAN;
  } else if (dx != NULL && p != NULL && p->force != PENDRES_FORCE_PENDULUM) {
    double force;
    pendres_model_force(p, x - pendres_model_of(p->force)->origin, &force, dx);
    *dx = -*dx - pendres_equation_drag_by_place(p, x - pendres_model_of(p->force)->origin, v);
  } else if (dx != NULL) {
    *dx = -sin(x);
  }
  if (dv != NULL)
    *dv = p != NULL ? -pendres_equation_drag(p, x - pendres_model_origin(p), v) : NAN;
}

double pendres_pendulum_energy(const pendres_pendulum *p, double x, double v)
{
  return 0.5 * v * v + pendres_model_potential(p, x);
}

pendres_status pendres_harmonic_find(const pendres_pendulum *p, pendres_harmonic *out)
{
  const pendres_status status = pendres_pendulum_check(p, NULL);
  if (status != PENDRES_OK || out == NULL) return PENDRES_INVALID_ARGUMENT;
  const double w = p->drive_frequency;
  const double stiffness = (1.0 - w) * (1.0 + w);
  const double friction = p->damping * w;
  const double response = hypot(stiffness, friction);
  /* Undamped at resonance the response is infinite: the result is inf, without a trap. */
  out->amplitude = fabs(p->drive_amplitude) / response;
  out->phase_lag = atan2(friction, stiffness);
  out->loop_area =
    two_pi / 2.0 * p->drive_amplitude * p->drive_amplitude * (friction / response) / response;
  return PENDRES_OK;
}

double pendres_free_frequency(double amplitude)
{
  if (!(amplitude >= 0.0 && amplitude < two_pi / 2.0)) return NAN;
  /* K by the arithmetic-geometric mean form of GSL's Carlson integral
     R_F(0, cos^2(a/2), 1): unlike K(sin(a/2)) it keeps its digits up to pi. */
  /* pi minus amplitude, with the digits of pi that a double cuts off. */
  const double c = sin(((two_pi / 2.0 - amplitude) + 1.2246467991473532e-16) / 2.0);
  gsl_sf_result k;
  if (gsl_sf_ellint_RF_e(0.0, c * c, 1.0, GSL_PREC_DOUBLE, &k) != GSL_SUCCESS) return NAN;
  return half_pi / k.val;
}

void pendres_free_get(double a, pendres_free *out)
{
  if (out == NULL) return;
  const double frequency = pendres_free_frequency(a), k = half_pi / frequency;
  const double s = 1.0 + sqrt(cos(a / 2.0));
  *out = (pendres_free){
    .frequency = frequency,
    .frequency_error =
      frequency * DBL_EPSILON * (4.0 + 1.0 / ((two_pi / 2.0 - a) * k)),
    .kittel = 1.0 - a * a / 16.0, .belendez = s * s / 4.0};
}
