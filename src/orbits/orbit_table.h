/*
 * orbit_table.h -- the measures of orbits, one row each.
 *
 * Owns: the table, which is read by everything that treats all measures of an orbit alike: error
 * estimates from two computations, motions that have no such measures, mirror images, and files.
 */
#ifndef PENDRES_ORBIT_TABLE_H
#define PENDRES_ORBIT_TABLE_H

#include "orbits/orbit_measure.h"

typedef struct pendres_orbit_row {
  pendres_orbit_quantity shown;
  /* The value from one computation; every field of *m except `of` is set already. NULL:
     orbit_error.c derives it from other measures. */
  pendres_orbit_value (*measure)(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                 const pendres_orbit_measures *m);
  int angle; /* 1: differences are taken modulo whole turns */
  int image; /* 1: a mirror image has the same value */
} pendres_orbit_row;

/* pendres_orbit_measure, and the values of all rows. */
pendres_status pendres_orbit_table_measure(const pendres_pendulum *p,
                                           const pendres_orbit_samples *s, double *work,
                                           pendres_orbit_measures *out);

/* NULL beyond the last. */
const pendres_orbit_row *pendres_orbit_row_get(size_t number);

/* The value of a row in an orbit, and its error; NULL if it is exact. */
double *pendres_orbit_row_value(const pendres_orbit_row *row, pendres_orbit *o);
double *pendres_orbit_row_error(const pendres_orbit_row *row, pendres_orbit *o);

/* An orbit of which nothing but the pendulum is known: all of its numbers are NaN. */
pendres_orbit pendres_orbit_none(const pendres_pendulum *p);

#endif
