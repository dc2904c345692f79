/*
 * chaos.h -- telling chaos from slow settling.
 *
 * Owns: the largest Lyapunov exponent from the variational equation, the test that a chaotic
 * motion does not end, and the cover of a chaotic attractor by cells of the Poincaré plane.
 *
 * Method: Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9: a tangent vector is
 * carried along by the variational equation and brought back to length one every drive period;
 * the mean growth of its logarithm is the exponent. Its standard error comes from independent
 * walkers. Chaos that ends (a chaotic saddle: walkers fall into a trap) is no attractor.
 */
#ifndef PENDRES_CHAOS_H
#define PENDRES_CHAOS_H

#include "strobe_run.h"

struct pendres_catalogue;

enum { PENDRES_COVER_CELLS = 128 /* a side */ };

/* Cells of the Poincaré plane that a chaotic attractor visits, or that touch such a cell. */
typedef struct pendres_cover {
  int attractor;                 /* whose it is */
  double w_most;                 /* cells span |w| <= w_most, and all angles */
  double mean_y, mean_w;         /* over the attractor */
  unsigned char cell[PENDRES_COVER_CELLS][PENDRES_COVER_CELLS];
} pendres_cover;

int pendres_cover_holds(const pendres_cover *cover, double y, double w);

/*
 * Whether the n lanes of catalogue c, which have settled on nothing so far, are chaotic; if so the
 * attractor is added to c, or its cover is widened. *found: 1 if that was done.
 */
pendres_status pendres_chaos_find(pendres_context *ctx, struct pendres_catalogue *c, size_t n,
                                  const pendres_strobe_lane *const *lanes, int *found);

#endif
