/*
 * attractor_internal.h -- what a set of attractors is made of.
 */
#ifndef PENDRES_ATTRACTOR_INTERNAL_H
#define PENDRES_ATTRACTOR_INTERNAL_H

#include "catalogue.h"

struct pendres_attractors {
  size_t sets;
  pendres_catalogue *catalogues;
  size_t count;
  const pendres_attractor **attractors; /* all of them, set after set */
};

#endif
