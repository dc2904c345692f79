/* solve.h -- least squares for the free quantities from one start, and their covariance. */
#ifndef PENDRES_FIT_SOLVE_H
#define PENDRES_FIT_SOLVE_H

#include "analysis/fit_model/internal.h"

/* A quantity that is free, and the number that the solver sees instead. */
typedef struct fit_free {
  const pendres_fit_unknown *of;
  int quantity;
  enum { FIT_PLAIN, FIT_LOGARITHM, FIT_SINE } form;
  double unit, low, high, prior, prior_error; /* in canonical units */
  double narrow, about; /* a logarithm in shares of this, from there on; 0: in whole ones */
  int at_bound;
} fit_free;

typedef struct fit_problem {
  fit_model *m;
  fit_terms terms;
  int errors_known; /* of the data */
  double excess;    /* where not: scatter about the fit over that about neighbours; 0: not known */
  fit_rows rows; /* of the latest values */
  size_t unknowns;
  fit_free *free;
  fit_values v;   /* the latest, with the fixed ones */
  double *x;      /* [unknowns] what they were made from */
  int known;      /* whether rows are those of x */
  int lost;       /* the model could not be computed there */
  pendres_status status; /* what ends the fit */
  int evaluations, iterations;
  double stiffness; /* share of the data that resist a change at the values concluded last */
  double worst; /* sum of squares of the first values that could be computed */
  int has_twin; /* other values fit about as well: */
  fit_values twin;
  double twin_above; /* by so much more chi-square, in units of what is expected a datum */
  void (*between)(void *search); /* called where a state of the search can be kept */
  void *search;
} fit_problem;

/* A combination of unknowns that is independent of the others: by how much one error along it
   changes them; open: the data do not determine it, and only how they change together is known. */
typedef struct fit_combination {
  int open;
  double change[FIT_QUANTITIES];
} fit_combination;

/* What comes of a start. */
typedef struct fit_result {
  fit_values v;
  double chi_square, freedom, remaining;
  double scatter; /* what chi-square rises by at one error, by how data scatter: 1 of normal ones */
  int computed, converged, determined;
  int impossible; /* chance gives no such chi-square */
  double *covariance; /* [unknowns][unknowns], of the quantities in canonical units */
  size_t combinations;
  fit_combination *combination; /* [unknowns + 1] */
  int *at_bound;      /* [unknowns] */
  double *spread;     /* [unknowns] what following says beyond the covariance; INFINITY: no end */
} fit_result;

/* Rows with those of priors. */
static inline size_t pendres_fit_all_rows(const fit_problem *p)
{
  return pendres_fit_rows(p->m) + p->unknowns;
}

/* Compute the residuals at values, unless that was just done; 0: the model cannot be. */
int pendres_fit_evaluate(fit_problem *p, const fit_values v);

/* Chi-square of the rows that were computed last. */
double pendres_fit_sum_of_squares(const fit_problem *p);

/* Least squares from values on, which are replaced. */
pendres_status pendres_fit_solve(fit_problem *p, int iterations, fit_result *out);

/* Chi-square and covariance at values. */
pendres_status pendres_fit_conclude(fit_problem *p, fit_result *out);

/* The probability of a larger chi-square. */
double pendres_fit_probability(const fit_result *r);

/* A value moved by this in what the solver sees, but not beyond its bounds; and how much a change
   of it is there: of numbers that are seen as they are half of their share where they are open, so
   that scales come before what they scale, and otherwise nothing. */
double pendres_fit_moved(fit_free *f, double value, double by);
double pendres_fit_seen(fit_free *f, double value, double change, int open);

/* What comes next is computed from the beginnings of the curves on. */
void pendres_fit_forget(fit_problem *p);

/* ---- profile.c ---- */

/* Values along what is followed. */
typedef struct fit_profile_place {
  double along; /* the unknown that is given as the solver sees it, from the best values on */
  double rise;  /* of chi-square, in units of what one error makes */
  fit_values v;
} fit_profile_place;

/* How far following has come. */
typedef struct fit_profile {
  int begun, again, whole, way; /* whole: no way was lost */
  size_t next;                  /* the unknown that is given next, that way */
  double far[FIT_QUANTITIES];   /* of those to be given: an error as the solver sees it */
  size_t by[FIT_QUANTITIES];    /* the combination for which an unknown is given */
  fit_profile_place lowest;     /* where chi-square is lower than at the best values, if it is */
  double step, longest;         /* of the way, and the places that it has come to; 0: none yet */
  size_t count;
  fit_profile_place at[FIT_PROFILE_PLACES];
} fit_profile;

/* Follow chi-square from a fit's values along what derivatives do not determine, and widen errors
   by what moves; `work` is overwritten. It goes on from where *s is; before each way, and along
   decays, which know no curves, before each place, p->between is called. */
pendres_status pendres_fit_profile(fit_problem *p, int iterations, fit_profile *s,
                                   fit_result *best, fit_result *work);

#endif
