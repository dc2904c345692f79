/*
 * wells.h -- sums over the states that go to each well of each attractor.
 */
#ifndef PENDRES_BASIN_WELLS_H
#define PENDRES_BASIN_WELLS_H

#include <pendres/basin.h>

/* Sums over the rows of a grid, of an attractor or of one of its wells. */
typedef struct pendres_basin_member {
  double share;     /* of the area */
  double row_share; /* of the row that is being added */
  double crossings; /* along v, where its basin begins or ends */
  double last[2];   /* shares of the two rows before */
  double square;    /* of second differences between rows */
  size_t states;
  size_t uncertain; /* of a well: states found in it that may belong elsewhere */
} pendres_basin_member;

typedef struct pendres_basin_entry {
  pendres_basin_well well; /* states 0: free */
  pendres_basin_member sums; /* the states are counted in the well */
} pendres_basin_entry;

/* A table by attractor and well with open addressing; all zero: empty. */
typedef struct pendres_basin_tally {
  pendres_basin_entry *place;
  size_t places, used; /* places: a power of 2, or none */
} pendres_basin_tally;

/* Count more states of a well; returns its sums, valid until more are counted. NULL: out of
   memory, and the table is as it was. */
pendres_basin_member *pendres_basin_tally_add(pendres_basin_tally *t, int attractor, long well,
                                              size_t states);

/* All entries by attractor, then by well, t->used of them, to be freed; NULL: out of memory. */
pendres_basin_entry *pendres_basin_tally_list(const pendres_basin_tally *t);

void pendres_basin_tally_free(pendres_basin_tally *t);

#endif
