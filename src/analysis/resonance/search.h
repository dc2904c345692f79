/*
 * search.h -- the frequencies that a search for a resonance has evaluated.
 *
 * Owns: the points of a search in ascending frequency, the first scan of the range, the gaps
 * between neighbouring points, and the budget of work, which bounds the cost of a search whatever
 * its parameters. Searches may share a budget; the frequencies that they need are then evaluated
 * side by side.
 */
#ifndef PENDRES_RESONANCE_SEARCH_H
#define PENDRES_RESONANCE_SEARCH_H

#include "analysis/resonance/refine.h"

enum {
  PENDRES_SEARCH_POINTS = 1500,                        /* most frequencies of one search */
  PENDRES_SEARCH_COARSE = 19,                          /* over the range at first */
  PENDRES_SEARCH_CUTS = PENDRES_SEARCH_POINTS / 2 + 19 /* most of those that follow in the scan */
};

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
  enum { PENDRES_SCAN_COARSE, PENDRES_SCAN_LEVELS, PENDRES_SCAN_DONE } stage;
  size_t cuts, stride;           /* of the first scan's finer part: every stride-th at a time */
  double cut[PENDRES_SEARCH_CUTS];
  size_t requests;               /* frequencies to be evaluated next */
  double request[PENDRES_SEARCH_POINTS];
} pendres_search;

/* A budget of which nothing is spent. */
pendres_search_budget pendres_search_budget_of(pendres_context *ctx, double most);

/* Free it in any case. */
pendres_status pendres_search_create(pendres_search_budget *budget, const pendres_pendulum *p,
                                     const pendres_ensemble *ensemble, pendres_search *out);
void pendres_search_free(pendres_search *s);

double pendres_scan_frequency(const pendres_scan_point *p);

/*
 * Evaluate the frequencies that n searches with one budget and one ensemble need, and insert the
 * points in order, as far as room and budget allow: `crowded` or `exhausted` is set if they did not
 * suffice for all. Each search gets the same points as it would alone.
 */
pendres_status pendres_search_add(size_t n, pendres_search *const *s);

/* Insert a point whose members are on the same states as those of `like`; room is not checked. */
pendres_status pendres_search_insert(pendres_search *s, const pendres_scan_point *point,
                                     const pendres_scan_point *like);

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

/* ---- gap.c: what may happen between two neighbouring points: which states continue from one to
   the other, which members change their state, how large the mean area can be in between ---- */

typedef enum pendres_gap_kind {
  PENDRES_GAP_PLAIN, /* the members keep their states, and the mean rises or falls */
  PENDRES_GAP_PEAK,  /* they keep them, and it first rises and then falls */
  PENDRES_GAP_JUMP   /* a state appears or ends, or a member changes its state */
} pendres_gap_kind;

typedef struct pendres_gap {
  pendres_gap_kind kind;
  double width;
  double bound;  /* no mean area within exceeds this */
  int loose;     /* the bound allows for members near a basin boundary that appear to keep their
                    states */
  int mixed;     /* members change to larger areas and to smaller ones */
} pendres_gap;

/* The gap between two neighbours, `members` on each. */
void pendres_gap_look(const pendres_scan_point *a, const pendres_scan_point *b, size_t members,
                      pendres_gap *out);

#endif
