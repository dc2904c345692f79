/*
 * attractor_internal.h -- what a set of attractors is made of.
 */
#ifndef PENDRES_ATTRACTOR_INTERNAL_H
#define PENDRES_ATTRACTOR_INTERNAL_H

#include <math.h>

#include "orbits/catalogue.h"

struct pendres_attractors {
  size_t sets;
  pendres_catalogue *catalogues;
  size_t count;
  const pendres_attractor **attractors; /* all of them, set after set */
};

/* Modulus of the larger Floquet multiplier; NaN if the attractor is no closed orbit. */
static inline double pendres_attractor_multiplier(const pendres_attractor *a)
{
  const pendres_orbit *o = &a->orbit;
  return o->period > 0 ? hypot(o->multiplier_re[0], o->multiplier_im[0]) : NAN;
}

/* Look for more attractors of a set that has one parameter set. Their numbers change if some are
   found. */
pendres_status pendres_attractors_extend(pendres_context *ctx, pendres_attractors *set, size_t n,
                                         const double *x, const double *v);

#endif
