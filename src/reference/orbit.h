/*
 * orbit.h -- what the solvers of reference.h share: closing an orbit, measuring it.
 */
#ifndef PENDRES_REFERENCE_ORBIT_H
#define PENDRES_REFERENCE_ORBIT_H

#include <pendres/reference.h>

#include "reference/taylor.h"

/* An orbit to be found. */
typedef struct pendres_reference_target {
  pendres_reference_model model;
  long double y, v;     /* guess, then solution */
  long period, winding;
  int mirror;           /* nonzero: one that is its own mirror image half a period later, */
  long double centre;   /* about this y */
} pendres_reference_target;

/* The defect of an orbit: its end minus its start over the period or, for a mirror orbit (whose
   centre may be any well), end plus start over half a period. *run is the run with `columns`
   columns that gave it. */
pendres_status pendres_reference_orbit_defect(const pendres_reference_target *target,
                                              int columns, pendres_reference_run *run,
                                              long double defect[2]);

/* Measures of the orbit at the target, which must be closed already. */
pendres_status pendres_reference_orbit_measure(const pendres_reference_target *target,
                                               pendres_reference_cycle *out);

/* The maximum of the loop area along the branch that the target's orbit is on. */
pendres_status pendres_reference_orbit_resonance(pendres_reference_target *target,
                                                 pendres_reference_cycle *out);

/* Solve a x = b by elimination with pivoting, in place (x in b); n <= 4. Nonzero: singular. */
int pendres_reference_orbit_solve(int n, long double a[][4], long double b[]);

#endif
