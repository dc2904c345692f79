/* call.h -- the arguments of a fit, its results, and what makes these of the other. */
#ifndef PENDRES_FIT_CALL_H
#define PENDRES_FIT_CALL_H

#include "analysis/fit/solve.h"

struct pendres_fit {
  pendres_fit_summary summary;
  size_t unknowns, jumps;
  double *value, *covariance; /* of all unknowns of the call */
  pendres_fit_point *point;
  pendres_fit_jump *jump;
  char note[FIT_NOTES][FIT_NOTE];
};

/* The arguments of a call, and what the fit is made with. */
typedef struct pendres_fit_call {
  const pendres_fit_data *data;
  const pendres_fit_model *model;
  pendres_fit_options options;
  pendres_fit **out;
  int errors_known;
  int own; /* of the starts, the first one is the caller's: all guesses are given */
  fit_values start; /* in the caller's units; NaN: from the data */
} pendres_fit_call;

/* Whether arguments can be fitted; the context says why not. */
pendres_status pendres_fit_check(pendres_context *ctx, const pendres_fit_call *c);

/* Give the caller what was found; the problem is that at the best values. PENDRES_NOT_CONVERGED is
   what a fit that is none returns with its results. */
pendres_status pendres_fit_result(const pendres_fit_call *c, fit_problem *p,
                                  const fit_result *best);

/* Values to begin with, best first: quantities that are NaN in v come from the data. Returns how
   many there are; -1: out of memory. m->active is how many stations those of a decay are good
   for. */
int pendres_fit_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES]);
int pendres_fit_decay_guess(fit_model *m, const fit_values v, fit_values out[FIT_GUESSES]);

#endif
