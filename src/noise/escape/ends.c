/* ends.c -- the planes in which a path leaves a state and comes to a saddle; see path.h. */
#include <math.h>

#include "noise/escape/path.h"
#include "noise/noise_common.h"

/* What both ends need: the orbit's derivative over a cycle, and what noise adds, at T = 1. */
static pendres_status look(const pendres_orbit *orbit, pendres_langevin_linear *l,
                           pendres_way_end *out)
{
  pendres_pendulum p = orbit->pendulum;
  p.temperature = 1.0;
  const pendres_status status = pendres_noise_cycle(&p, orbit->x, orbit->v, orbit->period, l);
  *out = (pendres_way_end){.x = orbit->x, .v = orbit->v, .cycle = orbit->period,
                            .noise = {l->injected.xx, l->injected.xv, l->injected.vv}};
  for (int i = 0; i < 4; i++) out->m[i] = l->monodromy[i];
  return status;
}

/* e-folds a drive period by a multiplier. */
static double folds(const pendres_orbit *orbit, double multiplier)
{
  return fabs(log(multiplier)) / orbit->period;
}

pendres_status pendres_way_state(const pendres_orbit *orbit, pendres_way_end *out)
{
  pendres_langevin_linear l;
  const pendres_status status = look(orbit, &l, out);
  if (status != PENDRES_OK) return status;
  const pendres_status cloud = pendres_langevin_lyapunov(l.monodromy, &l.injected, &l.covariance);
  if (cloud != PENDRES_OK) return cloud;
  const pendres_langevin_covariance *s = &l.covariance;
  const double d = s->xx * s->vv - s->xv * s->xv;
  out->plane[0] = s->vv / d;
  out->plane[1] = -s->xv / d;
  out->plane[2] = s->xx / d;
  out->grows = folds(orbit, hypot(orbit->multiplier_re[0], orbit->multiplier_im[0]));
  return d > 0.0 && out->grows > 0.0 ? PENDRES_OK : PENDRES_NOT_FOUND;
}

void pendres_way_direction(const double m[4], double multiplier, double out[2])
{
  /* (M - u) e = 0: its rows are multiples of each other, and the larger is orthogonal to e. */
  out[0] = m[1];
  out[1] = multiplier - m[0];
  if (fabs(multiplier - m[3]) + fabs(m[2]) > fabs(out[0]) + fabs(out[1])) {
    out[0] = multiplier - m[3];
    out[1] = m[2];
  }
  const double size = hypot(out[0], out[1]);
  out[0] /= size;
  out[1] /= size;
}

double pendres_way_outside(const double m[4])
{
  const double half = 0.5 * (m[0] + m[3]), part = 0.5 * (m[0] - m[3]);
  return half + copysign(sqrt(part * part + m[1] * m[2]), half);
}

/*
 * Along l, the left eigenvector of the multiplier u outside the unit circle, deviations d grow by u
 * a cycle and momenta p = c l decay by 1/u. What they do to d keeps it small for one value alone:
 * from d = -k c on the noise, C p after the cycle, takes it to -k c/u, where k = l.C l/(u^2 - 1).
 */
pendres_status pendres_way_saddle(const pendres_orbit *orbit, pendres_way_end *out)
{
  pendres_langevin_linear l;
  const pendres_status status = look(orbit, &l, out);
  if (status != PENDRES_OK) return status;
  const double *m = l.monodromy, u = pendres_way_outside(m), inside = m[0] + m[3] - u;
  if (!(fabs(u) > 1.0) || !(fabs(inside) < 1.0)) return PENDRES_NOT_FOUND;
  pendres_way_direction((double[4]){m[0], m[2], m[1], m[3]}, u, out->plane);
  const double *e = out->plane, *c = out->noise;
  out->plane[2] = (e[0] * e[0] * c[0] + 2.0 * e[0] * e[1] * c[1] + e[1] * e[1] * c[2]) /
                  (u * u - 1.0);
  /* Momenta decay by 1/u; along the stable direction the path comes as fast as motions do. */
  out->grows = fmin(folds(orbit, fabs(u)), folds(orbit, fmax(fabs(inside), 0x1p-1000)));
  return PENDRES_OK;
}
