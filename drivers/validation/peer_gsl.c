/*
 * peer_gsl.c -- pendulums by GSL's gsl_odeiv2_step_rk8pd; see peer_gsl.h.
 *
 * The equation is that of the library's blocks, over drive phase, with libm's sine:
 * dw/dtheta = (F0 cos theta - sin y) / omega^2 - (gamma / omega) w, y = x - pi/2.
 */
#include "validation/peer_gsl.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

typedef struct problem {
  double stiffness, drive, friction;
  double evaluations;
} problem;

static int slope(double theta, const double s[], double out[], void *arg)
{
  problem *b = arg;
  b->evaluations += 1.0;
  out[0] = s[1];
  out[1] = b->drive * cos(theta) - b->stiffness * sin(s[0]) - b->friction * s[1];
  return GSL_SUCCESS;
}

pendres_status peer_gsl_advance(const pendres_pendulum *p, double *x, double *v, long periods,
                                double tolerance, pendres_cost *cost)
{
  const double omega = p->drive_frequency, end = two_pi * (double)periods;
  problem b = { .stiffness = 1.0 / (omega * omega), .drive = p->drive_amplitude / (omega * omega),
                .friction = p->damping / omega };
  const gsl_odeiv2_system system = { slope, NULL, 2, &b };
  gsl_odeiv2_driver *driver =
    gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-2, tolerance, tolerance);
  double theta = 0.0, s[2] = { *x - half_pi, *v / omega };

  if (driver == NULL) return PENDRES_OUT_OF_MEMORY;
  /* GSL's handler would end the program. Nobody else uses GSL's errors at this time. */
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const int code = gsl_odeiv2_driver_apply(driver, &theta, end, s);
  (void)gsl_set_error_handler(handler);
  cost->pendulum_periods += (double)periods;
  cost->rhs_evaluations += b.evaluations;
  cost->steps += (double)driver->n;
  gsl_odeiv2_driver_free(driver);
  if (code != GSL_SUCCESS) return PENDRES_INTEGRATION_FAILED;
  *x = s[0] + half_pi;
  *v = s[1] * omega;
  return PENDRES_OK;
}
