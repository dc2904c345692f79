/*
 * attractor_internal.h -- what a set of attractors is made of.
 */
#ifndef PENDRES_ATTRACTOR_INTERNAL_H
#define PENDRES_ATTRACTOR_INTERNAL_H

#include "orbits/catalogue.h"

struct pendres_attractors {
  size_t sets;
  pendres_catalogue *catalogues;
  size_t count;
  const pendres_attractor **attractors; /* all of them, set after set */
};

/* Look for more attractors of a set that has one parameter set. Their numbers change if some are
   found. */
pendres_status pendres_attractors_extend(pendres_context *ctx, pendres_attractors *set, size_t n,
                                         const double *x, const double *v);

#endif
