/*
 * tables.h -- Butcher tables of the explicit Runge-Kutta methods offered.
 *
 * Owns: the coefficients and their sources. No SUNDIALS here.
 */
#ifndef PENDRES_TABLES_H
#define PENDRES_TABLES_H

#include <pendres/context.h>

enum { PENDRES_TABLES_MOST_STAGES = 16 };

/* a[i][j] at row i, column j, zero elsewhere. */
typedef struct pendres_tables_entry {
  signed char row, column;
  double value;
} pendres_tables_entry;

typedef struct pendres_tables_method {
  int stages, order, embedded_order;
  const pendres_tables_entry *a;
  int entries;
  const double *b; /* weights */
  const double *d; /* embedded weights */
  const double *c; /* nodes */
} pendres_tables_method;

/* The coefficients of a table; NULL for PENDRES_TABLE_DP5 (built into ARKODE) and out of range. */
const pendres_tables_method *pendres_tables_get(pendres_table table);

/* Order of the method of a table, 0 if out of range. */
int pendres_tables_order(pendres_table table);

#endif
