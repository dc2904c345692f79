/*
 * chaos.h -- telling chaos from slow settling.
 *
 * Owns: the largest Lyapunov exponent from the variational equation, the test whether a chaotic
 * motion ends, and means over time on a chaotic attractor. The cells of the Poincaré plane that it
 * visits, its cover, are in chaos_cover.h.
 *
 * Method: Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9: a tangent vector is
 * carried along by the variational equation and brought back to length one every drive period;
 * the mean growth of its logarithm is the exponent. Walkers that have lost each other are watched
 * side by side. Chaos that ends is no attractor: a walker that falls into a trap, or whose own
 * tangent vector shrinks while it comes back to where it was, has left. Each walker's periods are
 * parted into batches; walkers go on until they differ by no more than the scatter of their batches
 * explains. Errors come from the scatter of walkers, or from that of batches where it is larger.
 */
#ifndef PENDRES_CHAOS_H
#define PENDRES_CHAOS_H

#include "orbits/catalogue.h"

typedef enum pendres_chaos_verdict {
  PENDRES_CHAOS_NONE,      /* no suspect, or not told from slow settling */
  PENDRES_CHAOS_TRANSIENT, /* chaos that ends; orbits that it ends on may have been added */
  PENDRES_CHAOS_KNOWN,     /* an attractor that is known: its cover has been widened */
  PENDRES_CHAOS_NEW        /* an attractor has been added */
} pendres_chaos_verdict;

/* Whether the n lanes of catalogue c, which have settled on nothing so far, are chaotic. */
pendres_status pendres_chaos_find(pendres_context *ctx, pendres_catalogue *c, size_t n,
                                  const pendres_strobe_lane *const *lanes,
                                  pendres_chaos_verdict *verdict);

#endif
