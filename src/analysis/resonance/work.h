/*
 * work.h -- one search for a resonance, step by step.
 *
 * Owns: which frequencies a search needs next, given those that it has, and its result. Between two
 * steps the caller evaluates the frequencies that the search asks for (pendres_search_add), so that
 * several searches run side by side.
 */
#ifndef PENDRES_RESONANCE_WORK_H
#define PENDRES_RESONANCE_WORK_H

#include "analysis/resonance/search.h"

/* A gap that was examined, with its points, which are identified by their members. */
typedef struct pendres_known_gap {
  pendres_gap gap;
  const signed char *from, *to;
  int jump; /* the first point's jump_to_next */
} pendres_known_gap;

/* A search with its gaps. */
typedef struct pendres_resonance_work {
  pendres_search s;
  size_t gaps;              /* that were examined last */
  pendres_known_gap *known; /* known[i] lies between points i and i + 1 */
} pendres_resonance_work;

/* Free it in any case; the range in `s` is set by the caller. */
pendres_status pendres_resonance_work_create(pendres_search_budget *budget,
                                             const pendres_pendulum *p,
                                             const pendres_ensemble *ensemble,
                                             pendres_resonance_work *out);
void pendres_resonance_work_free(pendres_resonance_work *w);

/* The frequencies that it needs next; if none, the search is over, and *out is its resonance. */
pendres_status pendres_resonance_work_next(pendres_resonance_work *w, pendres_resonance *out);

/* pendres_resonance_find_ensemble() with a budget of work, which is about seconds of one
   processor. */
pendres_status pendres_resonance_find_within(pendres_context *ctx, const pendres_pendulum *p,
                                             const double range[2],
                                             const pendres_ensemble *ensemble, double most_work,
                                             pendres_resonance *out);

/* pendres_resonance_find_many; what searches side by side may cost together before they are begun
   again one by one. */
pendres_status pendres_resonance_find_together(pendres_context *ctx, size_t n,
                                               pendres_resonance_search *searches,
                                               const pendres_ensemble *ensemble,
                                               double most_together);

/* PENDRES_NOT_FOUND, and why: there is no area to be largest. */
pendres_status pendres_resonance_no_area(pendres_context *ctx, const pendres_pendulum *p);

#endif
