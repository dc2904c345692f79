/* search.h -- the search for the best values from several starts, and its state, from which another
   process goes on. */
#ifndef PENDRES_FIT_SEARCH_H
#define PENDRES_FIT_SEARCH_H

#include "analysis/fit/call.h"
#include "engine/keep.h"

/* Where a search is. */
typedef struct fit_search_place {
  enum { FIT_ORDERING, FIT_STARTING, FIT_CONCLUDING } stage;
  int next;      /* start that comes next */
  int more;      /* starts that were tried beside one that fits */
  int own;       /* the best is of the caller's start */
  int again;     /* rounds of the conclusion, ... */
  double before; /* ... and chi-square at the last one's beginning */
  double chi[FIT_TRIED];
} fit_search_place;

typedef struct fit_search {
  const pendres_fit_call *call;
  fit_problem *p;
  int starts;
  size_t window;     /* stations that a start begins with */
  fit_values *start; /* [starts] in the caller's units */
  double *error, *work; /* [data] */
  fit_result best, now;
  fit_profile profile;
  fit_search_place at;
  pendres_keeping keep;
} fit_search;

/* Find the best values, with errors. PENDRES_OK and best.computed 0: no start has a model. */
pendres_status pendres_fit_search(fit_search *s);

#endif
