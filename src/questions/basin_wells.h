/*
 * basin_wells.h -- how many states go to each well of each attractor.
 */
#ifndef PENDRES_BASIN_WELLS_H
#define PENDRES_BASIN_WELLS_H

#include <pendres/basin.h>

/* A table by attractor and well with open addressing; all zero: empty. */
typedef struct pendres_basin_tally {
  pendres_basin_well *place; /* states 0: free */
  size_t places, used;       /* places: a power of 2, or none */
} pendres_basin_tally;

/* Count so many more states; PENDRES_OUT_OF_MEMORY leaves the table as it was. */
pendres_status pendres_basin_tally_add(pendres_basin_tally *t, int attractor, long well,
                                       size_t states);

/* All entries by attractor, then by well, in out[t->used]. */
void pendres_basin_tally_list(const pendres_basin_tally *t, pendres_basin_well *out);

void pendres_basin_tally_free(pendres_basin_tally *t);

#endif
