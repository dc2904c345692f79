/*
 * chaos.h -- telling chaos from slow settling.
 *
 * Owns: the largest Lyapunov exponent from the variational equation, the test that a chaotic
 * motion does not end, means over time on a chaotic attractor, and its cover by cells of the
 * Poincaré plane.
 *
 * Method: Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9: a tangent vector is
 * carried along by the variational equation and brought back to length one every drive period;
 * the mean growth of its logarithm is the exponent. Walkers that have lost each other are watched
 * side by side. Chaos that ends is no attractor: a walker that falls into a trap, or whose own
 * tangent vector shrinks while it comes back to where it was, has left. Each walker's periods are
 * parted into batches; walkers go on until they differ by no more than batches do. Errors
 * are from the scatter of walkers, or of batches where that is larger.
 */
#ifndef PENDRES_CHAOS_H
#define PENDRES_CHAOS_H

#include "engine/strobe_run.h"

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

/* A mean over time, and how far off it may be. */
typedef struct pendres_chaos_mean {
  double value, error;
} pendres_chaos_mean;

/* What is known of a chaotic attractor; means a drive period. */
typedef struct pendres_chaos_measures {
  pendres_chaos_mean growth;                  /* error: one standard error */
  pendres_chaos_mean work, loss, amplitude, turns; /* error: half of a 99.9 % interval */
  double watched_periods;                     /* drive periods, all walkers together */
  double escape_rate_bound;                   /* see attractor.h */
} pendres_chaos_measures;

typedef enum pendres_chaos_verdict {
  PENDRES_CHAOS_NONE,      /* no suspect, or not told from slow settling */
  PENDRES_CHAOS_TRANSIENT, /* chaos that ends; orbits that it ends on may have been added */
  PENDRES_CHAOS_KNOWN,     /* an attractor that is known: its cover has been widened */
  PENDRES_CHAOS_NEW        /* an attractor has been added */
} pendres_chaos_verdict;

/* Whether the n lanes of catalogue c, which have settled on nothing so far, are chaotic. */
pendres_status pendres_chaos_find(pendres_context *ctx, struct pendres_catalogue *c, size_t n,
                                  const pendres_strobe_lane *const *lanes,
                                  pendres_chaos_verdict *verdict);

#endif
