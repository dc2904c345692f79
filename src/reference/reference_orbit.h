/*
 * reference_orbit.h -- what the solvers of reference.h share: closing an orbit, measuring it.
 */
#ifndef PENDRES_REFERENCE_ORBIT_H
#define PENDRES_REFERENCE_ORBIT_H

#include <pendres/reference.h>

#include "reference/reference_taylor.h"

/* An orbit looked for. */
typedef struct pendres_reference_target {
  pendres_reference_model model;
  long double y, v;     /* guess, then solution */
  long period, winding;
  int mirror;           /* nonzero: an orbit that is its own mirror image, by half a period */
} pendres_reference_target;

/* End minus start over the period, or the sum of both over half a period for a mirror orbit
   (whose own centre may be any well), and the run with `columns` columns that gave it. */
pendres_status pendres_reference_orbit_defect(const pendres_reference_target *target,
                                              int columns, pendres_reference_run *run,
                                              long double defect[2]);

/* Measures of the orbit at the target, which must be closed already. */
pendres_status pendres_reference_orbit_measure(const pendres_reference_target *target,
                                               pendres_reference_cycle *out);

/* Solve a x = b by elimination with pivoting, in place (x in b); n <= 4. Nonzero: singular. */
int pendres_reference_orbit_solve(int n, long double a[][4], long double b[]);

#endif
