/*
 * search.h -- one search for a resonance, step by step.
 *
 * Owns: the points of a search in ascending frequency, the first scan of the range, the gaps
 * between neighbouring points, which frequencies the search needs next, and its result; and the
 * budget of work, which bounds the cost of a search whatever its parameters. Between two steps the
 * caller evaluates the frequencies that the search asks for, so that several searches run side by
 * side, with a budget that they may share.
 */
#ifndef PENDRES_RESONANCE_SEARCH_H
#define PENDRES_RESONANCE_SEARCH_H

#include "analysis/resonance/numbers.h"
#include "analysis/resonance/refine.h"

/* The most frequencies that follow the first ones in the scan. */
enum { PENDRES_SEARCH_CUTS = PENDRES_SEARCH_POINTS / 2 + PENDRES_SEARCH_COARSE };

/* What searches may cost, and have cost so far, in units of about a second of one processor. */
typedef struct pendres_search_budget {
  pendres_context *ctx;
  double most;           /* nothing more is begun when this is spent */
  double work;           /* spent so far */
  double slopes, newton; /* the context's cost when work was last added up */
  int exhausted;         /* it is spent */
} pendres_search_budget;

typedef struct pendres_search {
  pendres_context *ctx;
  pendres_pendulum pendulum;
  const pendres_ensemble *ensemble;
  pendres_search_budget *budget; /* not owned */
  size_t count;
  pendres_scan_point *points;    /* ascending in omega */
  double lowest, highest;        /* the range */
  double rate;                   /* of the force: frequencies are measured by it */
  int crowded;                   /* no room for further frequencies */
  int coarse;                    /* the first scan is coarser than resonances may be narrow */
  int fine;                      /* a finer one has begun */
  enum { PENDRES_SCAN_COARSE, PENDRES_SCAN_LEVELS, PENDRES_SCAN_DONE } stage;
  size_t cuts, stride;           /* of the first scan's finer part: every stride-th at a time */
  double cut[PENDRES_SEARCH_CUTS];
  size_t requests;               /* frequencies to be evaluated next */
  double request[PENDRES_SEARCH_POINTS];
} pendres_search;

/* A budget of which nothing is spent. */
pendres_search_budget pendres_search_budget_of(pendres_context *ctx, double most);

/* Free it in any case; the range is set by the caller. */
pendres_status pendres_search_create(pendres_search_budget *budget, const pendres_pendulum *p,
                                     const pendres_ensemble *ensemble, pendres_search *out);
void pendres_search_free(pendres_search *s);

/*
 * Evaluate the frequencies that n searches with one budget and one ensemble need, and insert the
 * points in order, as far as room and budget allow: `crowded` or `exhausted` is set if they did not
 * suffice for all. Each search gets the same points as it would alone.
 */
pendres_status pendres_search_add(size_t n, pendres_search *const *s);

/* Insert a point whose members are on these states; room is not checked. */
pendres_status pendres_search_insert(pendres_search *s, const pendres_scan_point *point,
                                     const signed char *where);

/* Add what the context has spent since the last time to the work of the search. */
void pendres_search_account(pendres_search *s, double omega);

/* Whether no more frequencies are to be evaluated. */
int pendres_search_over(const pendres_search *s);

/* Whether the reserve of the budget, which is for refining the best point found, is spent as
   well. */
int pendres_search_ended(const pendres_search *s);

/* The width over which a response may change at a frequency, that of a resonance there. */
double pendres_search_width(const pendres_pendulum *p, double omega);

/* Request the next frequencies of the first scan, which is coarse at first and finally as fine as
   the damping requires. If it requests none, it is complete. */
pendres_status pendres_search_scan(pendres_search *s);

/*
 * Where basins alternate a member is on a state in windows that are narrower than any resonance. A
 * small ensemble is then scanned again, as often as costs what a scan of one costs whose members
 * lie close. Whether it is to be; 0: it was, or need not.
 */
int pendres_search_scan_finely(pendres_search *s);

/* Which states continue from one neighbour to the other, which of the `members` on each change
   their state, how large the mean area can be in between. */
void pendres_gap_look(const pendres_scan_point *a, const pendres_scan_point *b, size_t members,
                      pendres_gap *out);

/* The same between points i and i + 1 if members may also be on the states that they are on beside
   the gap or, if they alternate there, far from it: at least the gap's bound. */
double pendres_gap_around(const pendres_search *s, size_t i, int far);

/* Request the frequencies that a search needs next; if none, it is over, and *out its resonance. */
pendres_status pendres_search_next(pendres_search *s, pendres_resonance *out);

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
