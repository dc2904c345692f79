/*
 * catalogue.h -- the attractors of parameter sets, with their traps.
 *
 * Owns: finding attractors from scouts, numbering and labelling them, and telling which
 * trap a state lies in. Works on many parameter sets at a time, so that blocks stay full.
 */
#ifndef PENDRES_CATALOGUE_H
#define PENDRES_CATALOGUE_H

#include <pendres/attractor.h>

#include "strobe_run.h"
#include "trap.h"

typedef struct pendres_catalogue {
  pendres_pendulum pendulum;
  size_t count, capacity;
  pendres_attractor *attractors; /* in their physical order */
  size_t traps, trap_capacity;
  pendres_trap *trap;
  int *owner; /* attractor of each trap */
  pendres_trap_effort effort;
} pendres_catalogue;

/* A state of a parameter set to start from, or to look for an orbit near. */
typedef struct pendres_scout {
  size_t set;       /* index of its catalogue */
  double y, w;
  int period, winding; /* of the orbit it is thought to be near */
} pendres_scout;

void pendres_catalogue_clear(pendres_catalogue *c);

/* Integrate scouts (period and winding ignored) and add what they lead to. */
pendres_status pendres_catalogue_explore(pendres_context *ctx, size_t sets,
                                         pendres_catalogue *catalogues, size_t n,
                                         pendres_scout *scouts);

/* Refine guesses to orbits, and add the stable ones that are new, with their traps. */
pendres_status pendres_catalogue_add(pendres_context *ctx, size_t sets,
                                     pendres_catalogue *catalogues, size_t n,
                                     const pendres_scout *guesses);

/* The trap that a lane is in: its attractor and well; -1 if in none. */
int pendres_catalogue_locate(const pendres_catalogue *c, const pendres_strobe_lane *lane,
                             long *well);

#endif
