/*
 * force_squid.h -- f = sin y + a1 y: a Josephson junction in a superconducting ring (rf SQUID).
 *
 * With y the junction's phase, the ring's screening parameter beta_L = 1/a1 and the external flux
 * phi_e (2 pi a flux quantum), y'' + gamma y' + sin y + (y - phi_e)/beta_L = 0: the constant part
 * of the flux is a torque I = phi_e/beta_L, an oscillating one is a drive. It is the example of a
 * user's own force: forces.h describes what each of these functions is for.
 *
 * Source: K. K. Likharev, Dynamics of Josephson Junctions and Circuits (1986), chapter 6.
 */
#ifndef PENDRES_FORCE_SQUID_H
#define PENDRES_FORCE_SQUID_H

#include <math.h>

#include "base/sine.h"

/* A spring that pushes, a1 < 0, is stronger than the junction's sine and `need` where |a1| z is
   larger than 1 + need. */
static inline double pendres_force_squid_outward(const double *a, double side, double need)
{
  (void)side;
  return a[0] < 0.0 ? (1.0 + fmax(need, 0.0)) / -a[0] : INFINITY;
}

/*
 * sin y is odd about all multiples of pi. The whole force is odd about the one of them at which the
 * spring balances the torque, if there is one: the flux is then a multiple of half a quantum. The
 * torque has the rounding errors of a1, of pi and of their product, and its own; the bound is twice
 * their sum.
 */
static inline double pendres_force_squid_centre(const double *a, double torque, double near)
{
  const double there = a[0] != 0.0 ? torque / a[0] : near;
  const double centre = rint(there / PENDRES_PI) * PENDRES_PI;
  return fabs(a[0] * centre - torque) <= 0x1p-50 * fabs(torque) ? centre + 0.0 : NAN;
}

/* The ring's spring pulls y back however often it has turned over: y has no period. */
static const pendres_model pendres_force_squid_model = {
  .name = "squid", .angle = 1, .coefficients = 1,
  .outward = pendres_force_squid_outward, .centre = pendres_force_squid_centre, .beside = 1.0};

PENDRES_FORCE_INLINE void pendres_force_squid(const double *a, double y, double *force,
                                              double *slope)
{
  double sine, cosine;
  pendres_kernels_sincos(y, &sine, &cosine);
  *force = __builtin_fma(a[0], y, sine);
  *slope = cosine + a[0];
}

PENDRES_FORCE_INLINE double pendres_force_squid_by(const double *a, double y, int k)
{
  (void)a;
  return k == 0 ? y : 0.0;
}

static inline double pendres_force_squid_potential(const double *a, double y)
{
  return 0.5 * a[0] * y * y - cos(y);
}

#endif
