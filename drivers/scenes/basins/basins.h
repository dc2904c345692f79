/*
 * basins.h -- what the parts of scene `basins` share: computing in basins.c, writing in
 * write.c, wells in wells.c, the boundary as a curve in
 * boundary.c, clouds under noise in noise.c.
 */
#ifndef SCENE_BASINS_H
#define SCENE_BASINS_H

#include <pendres/basin.h>

#include "results/columns.h"
#include "results/failed.h"

enum {
  BASINS_VARIABLES = 6,      /* of every state */
  BASINS_GIVEN_UP = -3,      /* settling_periods of a state that its budget has ended */
  BASINS_NAMED = 4           /* how many of these are told by name */
};

typedef struct basins {
  scene_run *run;
  const deck *d;
  pendres_pendulum pendulum;
  pendres_basin_grid grid;
  pendres_attractors *set;
  pendres_basin_sums *sums;
  scene_column column[BASINS_VARIABLES]; /* of all states, */
  scene_variable variable[BASINS_VARIABLES]; /* and their variables in the store */
  size_t unresolved, uncertain;
  size_t given_up, given_up_index[BASINS_NAMED]; /* of the unresolved: by their budget */
  size_t random_states; /* that the uncertainty exponent comes from; 0: it comes from the grid */
  const char *curve; /* what was found of the boundary as a curve; NULL: it was not asked for */
  /* refinement alone: */
  size_t integrated, verified, missed;
  size_t filled, clean; /* states that stay filled in, and those that clean samples have verified */
  /* the line v = 0: */
  pendres_basin_state *cut;
} basins;

/* Define the variables of all states, in the group of the grid. */
void basins_define(basins *b);

/* Write whole rows of states, from row number `first` on. */
void basins_write_rows(basins *b, size_t first, size_t rows, const pendres_basin_state *state);

/* Everything that is not a state of the grid. */
void basins_write_results(basins *b);

/* Write how many of the states go to each of the wells; how many wells an attractor has. */
void basins_write_wells(basins *b);
size_t basins_wells_of(const basins *b, int attractor);

/* Print a line where attractors have more than one well. */
void basins_print_wells(const basins *b, FILE *out);

/* Find and write the stable manifold of the orbit between the first attractor and its neighbour,
   if any; b->curve says what was found. */
void basins_write_boundary(basins *b);

/*
 * Compute and write the clouds around all attractors of the set at the deck's temperatures, and
 * print a table of them. Nothing is done if the deck has no temperature axis. The root group has
 * the dimension `attractor` already, in the order of the set; the dimensions `temperature` and
 * `strobe` are made here.
 */
void basins_write_clouds(scene_run *run, const pendres_attractors *set);

#endif
