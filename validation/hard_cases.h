/*
 * hard_cases.h -- cases that break pendulum programs, each with a bound that must hold.
 *
 * Owns: the cases, and the sheet on which a case puts its rows. What a case computes and
 * where its bounds come from is said above its function, in hard_*.c. The scene hard_cases and
 * tests/test_hard.c run the same functions.
 *
 * To add a case: a line in the list of deck/deck.h, and a function hard_NAME(hard_sheet *). Its
 * rows are the same bytes in every run: a case makes its own contexts and depends on nothing
 * but sheet->scale.
 */
#ifndef HARD_CASES_H
#define HARD_CASES_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "deck/deck.h"

/* What must hold is figure <= bound. */
typedef struct hard_row {
  char name[32];      /* different for each row, e.g. separatrix_1e-9 */
  char quantity[160]; /* what the figure is */
  double figure, bound;
  double naive;       /* the same figure by plain adaptive ARKODE; NaN where that gives none */
} hard_row;

typedef struct hard_sheet {
  double scale;       /* of what a case repeats: 1, or less for a shorter run (as 0.01) */
  int (*stop)(void *arg); /* given to every context of hard_context; may be NULL */
  void *stop_arg;
  hard_row *row;
  size_t count, capacity;
  char message[512];  /* why a case gave up */
} hard_sheet;

typedef struct hard_case {
  const char *name;
  pendres_status (*run)(hard_sheet *sheet);
} hard_case;

#define HARD_CASE_FUNCTION(name) pendres_status hard_##name(hard_sheet *sheet);
DECK_CASE_LIST(HARD_CASE_FUNCTION)
#undef HARD_CASE_FUNCTION

/* The case of a name; NULL if there is none. */
const hard_case *hard_case_find(const char *name);
/* All of them, in order; NULL beyond the last. */
const hard_case *hard_case_at(size_t index);

/* Put a row on the sheet. Figures that are NaN do not hold. Fails without memory alone. */
pendres_status hard_sheet_add(hard_sheet *sheet, const char *name, const char *quantity,
                              double figure, double bound, double naive);
/* A name made of the case's and a number: hard_at("fold", 1e-9).text is "fold_1e-9". */
typedef struct hard_name {
  char text[32];
} hard_name;
hard_name hard_at(const char *name, double number);
int hard_row_holds(const hard_row *row);
/* The larger of two figures, NaN if either is: fmax would lose a NaN, and the row would hold. */
double hard_larger(double a, double b);
/* An error over the claimed one. A claim must be of use: a number from 0 to `most`; one that is
   NaN, infinite or larger gives NaN, and the row does not hold. most INFINITY: any number will do,
   as for the naive way. */
double hard_over_claim(double error, double claim, double most);
/* Four standard errors over a value that must be positive: infinite if it is not. */
double hard_above_zero(double value, double error);
/* Is a place further from where it is claimed to be than ten times the claimed error, or is the
   claim of no use, as above? */
int hard_misplaced(double distance, double claim, double most);
/* Let go of the rows; scale and stop remain. */
void hard_sheet_clear(hard_sheet *sheet);

/* A context that the sheet can stop. options NULL: defaults. Freed by the case. */
pendres_status hard_context(hard_sheet *sheet, const pendres_options *options,
                            pendres_context **out);
/* What comes without further thought: plain adaptive ARKODE, all but the tolerance as it comes. */
pendres_status hard_naive_context(hard_sheet *sheet, double tolerance, pendres_context **out);

/* A context of each kind, for a case that goes both ways. To be closed even where this fails. */
typedef struct hard_ways {
  pendres_context *ours, *naive;
} hard_ways;
pendres_status hard_ways_open(hard_sheet *sheet, const pendres_options *options,
                              double naive_tolerance, hard_ways *out);
void hard_ways_close(hard_ways *ways);

/* The orbit of period 1 that Newton's method gets to from (x, v): it fails where there is none. */
pendres_status hard_orbit(hard_sheet *sheet, pendres_context *ctx, const pendres_pendulum *p,
                          double x, double v, pendres_orbit *out);

/* Keep the words of a context (NULL: out of memory) on a failure; returns the status. */
pendres_status hard_failed(hard_sheet *sheet, pendres_status status, const pendres_context *ctx);

#endif
