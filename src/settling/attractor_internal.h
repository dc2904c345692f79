/*
 * attractor_internal.h -- what a set of attractors is made of.
 */
#ifndef PENDRES_ATTRACTOR_INTERNAL_H
#define PENDRES_ATTRACTOR_INTERNAL_H

#include <math.h>

#include "engine/door.h"
#include "settling/attractor_set.h"

struct pendres_attractors {
  size_t sets;
  pendres_attractor_set *attractor_sets; /* in canonical units */
  pendres_units *units;          /* [sets] the canonical units, in the caller's */
  size_t count;
  const pendres_attractor **attractors; /* all of them, set after set, as the caller sees them: */
  pendres_attractor *shown; /* these or, where it is NULL, those of the sets of attractors */
};

/* Open a door with the units of a set of one parameter set. */
pendres_door pendres_attractors_open(pendres_context *ctx, const pendres_attractors *set);

/* The same set behind its door: all of it in canonical units, until the door is closed. */
const pendres_attractors *pendres_attractors_inside(pendres_door *d, const pendres_attractors *set);

/* Modulus of the larger Floquet multiplier; NaN if the attractor is not a closed orbit. */
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
