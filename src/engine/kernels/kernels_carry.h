/*
 * kernels_carry.h -- what lanes carry beside their states: errors, or tangents.
 *
 * Owns: a step of them. A part of kernels.c, which includes it behind kernels.h.
 */
#ifndef PENDRES_KERNELS_CARRY_H
#define PENDRES_KERNELS_CARRY_H

#include "engine/kernels/kernels_drag.h"
#include "engine/kernels/kernels_force.h"

/*
 * Errors over the step from half a step before a state to half a step after it: half a step's
 * drift, the action of spring and drag at the state, and the other half.
 */
PENDRES_VECTOR_INLINE void carry(pendres_model_terms model, int drags, const pendres_strip *s,
                                 const pendres_operation *o)
{
  const double *restrict y = o->from + s->at, *restrict added = s->off.added;
  const double *restrict keep = s->off.keep, *restrict kick = s->off.kick;
  const pendres_coefficients k = s->k;
  double *restrict yy = s->off.yy, *restrict yw = s->off.yw, *restrict ww = s->off.ww;
  const double half = 0.5 * o->carry, cos_theta = o->cos_theta;
#pragma omp simd
  for (size_t i = 0; i < s->lanes; i++) {
    double by_y;
    if (model >= PENDRES_MODEL_POLYNOMIAL) {
      double unused;
      pendres_kernels_force(model, pendres_kernels_source(model, &k), i, y[i], &unused, &by_y);
    } else {
      by_y = pendres_kernels_cos_roughly(y[i]);
    }
    if (model != PENDRES_MODEL_PLAIN) by_y *= FMA(k.modulation[i], cos_theta, 1.0);
    double pull = kick[i] * by_y, left = keep[i];
    if (drags) {
      const resistance r = resistance_of(&k, i, y[i], y[s->lanes + i]);
      const double drag = half * (k.friction[i] - r.by_w);
      left = (1.0 - drag) / (1.0 + drag);
      pull = o->carry * (k.stiffness[i] * by_y - r.by_y) / (1.0 + drag);
    }
    double b = FMA(half, ww[i], yw[i]);
    double a = FMA(half, yw[i] + b, yy[i]);
    const double mixed = FMA(left, b, -(pull * a));
    const double c = FMA(left, FMA(left, ww[i], -(pull * b)), -(pull * mixed));
    b = FMA(half, c, mixed);
    a = FMA(half, mixed + b, a);
    yy[i] = a + added[i];
    yw[i] = b;
    ww[i] = FMA(k.stiffness[i], added[i], c);
  }
}

/*
 * A lane's tangent over the step from half a step before a state to half a step after it: half a
 * step's drift, the kick of the spring at the state, and the other half. The kick is weaker by a
 * twelfth of itself and the step, which makes means over time exact to fourth order (Takahashi and
 * Imada, Journal of the Physical Society of Japan 53 (1984) 3765).
 */
PENDRES_VECTOR_INLINE void kick(double step, double spring, double keep, double *y, double *w)
{
  const double half = 0.5 * step, pull = step * spring;
  const double weaker = FMA(pull * pull, step * (-1.0 / 12.0), pull);
  const double a = FMA(half, *w, *y), b = FMA(-weaker, a, *w);
  *y = keep * FMA(half, b, a);
  *w = keep * b;
}

/* Whatever the friction, a tangent u exp(-integral of drag / 2) has u'' = -(spring - drag^2 / 4 -
   drag' / 2) u, where drag and spring are what its slope has of w and y. */
PENDRES_VECTOR_INLINE void turn(pendres_model_terms model, int second, int drags,
                                const pendres_strip *s, const pendres_operation *o)
{
  const double *restrict y = o->from + s->at, *restrict keep = s->tangent.keep;
  const pendres_coefficients k = s->k;
  double *restrict y1 = s->tangent.y[0], *restrict w1 = s->tangent.w[0];
  double *restrict y2 = s->tangent.y[1], *restrict w2 = s->tangent.w[1];
  const double step = o->carry, cos_theta = o->cos_theta;
#pragma omp simd
  for (size_t i = 0; i < s->lanes; i++) {
    double force, by_y, modulation = 1.0;
    pendres_kernels_force(model, pendres_kernels_source(model, &k), i, y[i], &force, &by_y);
    if (model != PENDRES_MODEL_PLAIN) {
      modulation = FMA(k.modulation[i], cos_theta, 1.0);
      by_y *= modulation;
    }
    double drag = 0.5 * k.friction[i], left = keep[i], more = 0.0;
    if (drags) {
      const double w = y[s->lanes + i], sign = w < 0.0 ? -1.0 : 1.0;
      const resistance r = resistance_of(&k, i, y[i], w);
      const double slope = FMA(-k.stiffness[i], force * modulation,
                               FMA(k.drive[i], cos_theta, k.torque[i])) -
                           (k.friction[i] + r.sum) * w;
      drag -= 0.5 * r.by_w;
      /* dh/dy less drag'/2; the factor of a step to fifth order. */
      more = -0.5 * r.by_y - FMA(sign, k.quadratic[i], 3.0 * k.cubic[i] * w) * slope;
      const double z = drag * step, even = FMA(z, z * (1.0 / 12.0), 1.0);
      left = (even - 0.5 * z) / (even + 0.5 * z);
    }
    const double spring = FMA(k.stiffness[i], by_y, -(drag * drag)) + more;
    kick(step, spring, left, &y1[i], &w1[i]);
    if (second) kick(2.0 * step, spring, left * left, &y2[i], &w2[i]);
  }
}

/* Errors or tangents of pendulums some of which have other friction. */
PENDRES_VECTOR_INLINE void carry_dragged(pendres_model_terms model, const pendres_strip *s,
                                         const pendres_operation *o)
{
  if (s->off.yy != NULL) carry(model, 1, s, o);
  else turn(model, o->second, 1, s, o);
}

#endif
