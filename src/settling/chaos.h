/*
 * chaos.h -- distinguishing chaos from slow settling.
 *
 * Owns: the largest Lyapunov exponent of a chaotic attractor, the test whether its motion ends, and
 * its means over time. How tangent vectors grow, and what that says, is in growth.h. The cells of
 * the Poincaré plane that it visits, its cover, are in attractor_set.h.
 *
 * Replicas are pendulums that started close together and have separated; they are followed side by
 * side. Chaos that ends is not an attractor: a replica has left it if it falls into a trapping
 * ellipse, or if its tangent vector shrinks while it returns to its own past. Each replica's
 * periods are divided into batches; replicas are followed until they differ by no more than the
 * scatter of their batches explains. Errors come from the scatter of replicas, or from that of
 * batches where it is larger.
 */
#ifndef PENDRES_CHAOS_H
#define PENDRES_CHAOS_H

#include "settling/attractor_set.h"

typedef enum pendres_chaos_verdict {
  PENDRES_CHAOS_NONE,      /* no chaos, or not distinguished from slow settling */
  PENDRES_CHAOS_TRANSIENT, /* chaos that ends; orbits that it ends on may have been added */
  PENDRES_CHAOS_KNOWN,     /* a known attractor, whose cover has been extended */
  PENDRES_CHAOS_NEW        /* an attractor has been added */
} pendres_chaos_verdict;

/* Whether the n lanes of attractor set c, which have not settled so far, are chaotic. */
pendres_status pendres_chaos_find(pendres_context *ctx, pendres_attractor_set *c, size_t n,
                                  const pendres_strobe_lane *const *lanes,
                                  pendres_chaos_verdict *verdict);

#endif
