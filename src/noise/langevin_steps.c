/*
 * langevin_steps.c -- steps for a cloud whose relaxation is long, by linear theory; see
 * noise_common.h.
 *
 * The bias by finite steps is that of the integrator's own map. Without noise it has an orbit near
 * the true one, and around this a derivative M, from which linear theory makes the cloud that the
 * steps lead to: sigma = M sigma M' + C. At weak damping all of the bias is in M: a phase that is
 * off by a little each period is a detuning, which counts beside the width of the resonance. What
 * the steps make of C, the noise of one cycle, is as small as their error of one cycle, and is not
 * multiplied by the time of relaxation.
 */
#include "noise/noise_common.h"

#include <math.h>
#include <string.h>

#include "model/model.h"

enum {
  PROBES = 5,  /* the orbit's point, and one to each side in x and in v */
  NEWTON = 8   /* iterations */
};

/* One cycle of the integrator without noise from a point: where it leads, and its derivative, with
   points so far apart. */
typedef struct integrated_cycle {
  double apart[2], to[2], m[4];
} integrated_cycle;

static pendres_status cycle(pendres_context *ctx, const pendres_orbit *o, int steps,
                            const double z[2], integrated_cycle *out)
{
  const double *apart = out->apart;
  double *m = out->m;
  double x[PROBES], v[PROBES];
  pendres_pendulum p[PROBES];
  for (int i = 0; i < PROBES; i++) {
    p[i] = o->pendulum;
    p[i].temperature = 0.0;
    x[i] = z[0] + (i == 1 ? apart[0] : i == 2 ? -apart[0] : 0.0);
    v[i] = z[1] + (i == 3 ? apart[1] : i == 4 ? -apart[1] : 0.0);
  }
  const pendres_langevin_run run = {.n = PROBES, .pendulums = p, .periods = o->period,
                                    .steps_per_period = steps};
  const pendres_status status = pendres_langevin_advance(ctx, &run, x, v);
  out->to[0] = x[0];
  out->to[1] = v[0];
  m[0] = (x[1] - x[2]) / (2.0 * apart[0]);
  m[1] = (x[3] - x[4]) / (2.0 * apart[1]);
  m[2] = (v[1] - v[2]) / (2.0 * apart[0]);
  m[3] = (v[3] - v[4]) / (2.0 * apart[1]);
  return status;
}

/* The derivative around the orbit that the integrator has; *found is 0 if it has none there. */
static pendres_status own_orbit(pendres_context *ctx, const pendres_orbit *o, int steps,
                                double m[4], int *found)
{
  const double wide = o->amplitude > 0.0 ? o->amplitude : pendres_model_scale(&o->pendulum);
  integrated_cycle c = {.apart = {noise_apart * wide,
                                  noise_apart * wide * o->pendulum.drive_frequency}};
  const double turn = pendres_model_turn(&o->pendulum);
  double z[2] = {o->x, o->v};
  *found = 0;
  for (int k = 0; k < NEWTON && !*found; k++) {
    const pendres_status status = cycle(ctx, o, steps, z, &c);
    if (status != PENDRES_OK) return status;
    memcpy(m, c.m, sizeof c.m);
    const double r[2] = {remainder(c.to[0] - z[0], turn), c.to[1] - z[1]};
    const double a = 1.0 - m[0], d = 1.0 - m[3], determinant = a * d - m[1] * m[2];
    const double dx = (d * r[0] + m[1] * r[1]) / determinant;
    const double dv = (m[2] * r[0] + a * r[1]) / determinant;
    if (!isfinite(dx) || !isfinite(dv)) return status;
    *found = fabs(dx) <= c.apart[0] && fabs(dv) <= c.apart[1];
    z[0] += dx;
    z[1] += dv;
  }
  return PENDRES_OK;
}

/* How far the cloud that steps lead to is from the true one, relative to its widths; infinite if
   there is none. */
static pendres_status bias_of(pendres_context *ctx, const pendres_orbit *o, int steps,
                              const pendres_langevin_linear *exact, double *bias)
{
  pendres_langevin_covariance s = {0};
  const pendres_langevin_covariance *c = &exact->covariance;
  double m[4];
  int found;
  *bias = INFINITY;
  const pendres_status status = own_orbit(ctx, o, steps, m, &found);
  if (status != PENDRES_OK || !found ||
      pendres_langevin_lyapunov(m, &exact->injected, &s) != PENDRES_OK)
    return status;
  *bias = fmax(fabs(s.xv - c->xv) / sqrt(c->xx * c->vv),
               fmax(fabs(s.xx - c->xx) / c->xx, fabs(s.vv - c->vv) / c->vv));
  return status;
}

pendres_status pendres_noise_steps_by_orbit(pendres_context *ctx, const pendres_orbit *orbit,
                                            double tolerance, int *steps)
{
  pendres_orbit o = *orbit;
  pendres_langevin_linear exact;
  double bias = INFINITY;
  o.pendulum.temperature = 1.0; /* any: linear theory is in proportion to it */
  *steps = 0;
  if (pendres_langevin_linear_find(&o.pendulum, o.x, o.v, o.period, &exact) != PENDRES_OK)
    return PENDRES_OK;
  for (int n = pendres_noise_first_steps(&o.pendulum); n <= PENDRES_MOST_STEPS / 4;) {
    const pendres_status status = bias_of(ctx, &o, n, &exact, &bias);
    if (status != PENDRES_OK) return status;
    if (bias <= tolerance) {
      *steps = n;
      return status;
    }
    const double factor = pow(bias / (noise_aim * tolerance), 0.25); /* by order four */
    n = (int)ceil(n * fmin(noise_most_growth, fmax(noise_least_growth, factor)));
  }
  return PENDRES_OK;
}
