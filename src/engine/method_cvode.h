/*
 * method_cvode.h -- what the CVODE methods share: all but how the corrector's equations are solved.
 */
#ifndef PENDRES_METHOD_CVODE_H
#define PENDRES_METHOD_CVODE_H

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>

#include "engine/method_one.h"

/* What b->memory points to. */
typedef struct pendres_cvode {
  void *cvode;
  SUNNonlinearSolver fixed_point;
  SUNMatrix matrix;
  SUNLinearSolver linear;
} pendres_cvode;

/* CVODE by a linear multistep method, CV_ADAMS or CV_BDF; NULL on failure. */
pendres_cvode *pendres_cvode_open(pendres_one *b, int multistep);

/* The rest of a solver's functions. */
int pendres_cvode_advance(pendres_one *b, double theta);
int pendres_cvode_steps(const pendres_one *b, long *steps);
void pendres_cvode_close(pendres_one *b);

#endif
