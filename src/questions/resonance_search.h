/*
 * resonance_search.h -- the frequencies that a search for a resonance has looked at.
 *
 * Owns: the points of a search in ascending frequency, the first scan of the range, and the budget
 * of work: what a point may cost is bounded, whatever its parameters.
 */
#ifndef PENDRES_RESONANCE_SEARCH_H
#define PENDRES_RESONANCE_SEARCH_H

#include "questions/resonance_refine.h"

/* pendres_resonance_find_ensemble with a budget of work of the caller's: about seconds of one
   processor. */
pendres_status pendres_resonance_find_within(pendres_context *ctx, const pendres_pendulum *p,
                                             double lowest, double highest,
                                             const pendres_ensemble *ensemble, double most_work,
                                             pendres_resonance *out);

enum { PENDRES_SEARCH_POINTS = 1500 /* most frequencies of one search */ };

typedef struct pendres_search {
  pendres_context *ctx;
  pendres_pendulum pendulum;
  const pendres_ensemble *ensemble;
  size_t count;
  pendres_scan_point *points; /* ascending in omega */
  double most_work;           /* the budget: no more is begun when it is spent */
  double work;                /* spent so far, about seconds of a processor */
  double rate;                /* of the force: frequencies are measured by it */
  double slopes, newton;      /* the context's cost when work was last added up */
  int exhausted;              /* the budget of work is spent */
  int crowded;                /* no room for further frequencies */
  int coarse;                 /* the first scan is coarser than resonances may be narrow */
} pendres_search;

/* Free it in any case. */
pendres_status pendres_search_create(pendres_context *ctx, const pendres_pendulum *p,
                                     const pendres_ensemble *ensemble, double most_work,
                                     pendres_search *out);
void pendres_search_free(pendres_search *s);

double pendres_scan_frequency(const pendres_scan_point *p);

/*
 * Evaluate n more frequencies and sort them in, as far as room and budget go: `crowded` or
 * `exhausted` is set if that was not all the way.
 */
pendres_status pendres_search_add(pendres_search *s, size_t n, const double *omega);

/* Sort a point in whose members are where those of `like` are; room is not checked. */
pendres_status pendres_search_insert(pendres_search *s, const pendres_scan_point *point,
                                     const pendres_scan_point *like);

/* Add what the context has spent since the last time to the work of the search. */
void pendres_search_account(pendres_search *s, double omega);

/* Whether no more frequencies are to be looked at. */
int pendres_search_over(const pendres_search *s);

/* Whether what was found is not to be refined either: there is a reserve for that. */
int pendres_search_ended(const pendres_search *s);

/* Width over which a response may change at a frequency: that of the resonances there. */
double pendres_search_width(const pendres_pendulum *p, double omega);

/* Evaluate the range as finely as damping demands, coarse frequencies first. */
pendres_status pendres_search_scan(pendres_search *s, double lowest, double highest);

#endif
