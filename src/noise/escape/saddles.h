/*
 * saddles.h -- the saddle orbits on the boundary of a state's basin.
 *
 * Owns: where lines from the state cross the boundary, and the orbits that boundary points come to.
 */
#ifndef PENDRES_ESCAPE_SADDLES_H
#define PENDRES_ESCAPE_SADDLES_H

#include <pendres/attractor.h>

enum { PENDRES_SADDLES_MOST = 8 };

typedef struct pendres_saddle {
  pendres_orbit orbit;
  double x;             /* its Poincare point's place on the boundary, turns included */
  pendres_settled leads; /* what motions on its other side settle on */
} pendres_saddle;

/* In the order in which lines find them. The set is in canonical units. */
pendres_status pendres_saddles_find(pendres_context *ctx, const pendres_attractors *set,
                                    size_t from, pendres_saddle out[PENDRES_SADDLES_MOST],
                                    size_t *count);

#endif
