/* wells.c -- states by attractor and by well, shares by well; see basins.h. */
#include "scenes/basins/basins.h"

#include <string.h>

/* Of each attractor and well: the states that settle there, and their share of the window. */
typedef struct well {
  int attractor, number;
  size_t states;
  double fraction, fraction_error;
} well;

static int ends_are_wells(const deck *d)
{
  return strcmp(d->basins.by, "well") == 0;
}

static const scene_column of_wells[] = {
  {SCENE_TYPED(SCENE_NUMBER, "attractor", well, attractor, "number of the attractor")},
  {SCENE_TYPED(SCENE_NUMBER, "number", well, number,
               "number of the well; 0 for running and chaotic attractors")},
  {SCENE_TYPED(SCENE_COUNT, "states", well, states, "states of the grid that settle there")},
  /* Where boundaries are those between wells. */
  {SCENE_AS("fraction", well, fraction, "share of the window that settles there", NULL),
   .when = ends_are_wells},
};

static void write_each(basins *b, size_t n, const pendres_basin_well *wells)
{
  well *rows = scene_array(b->run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"basin_well"}, .prefix = "basin_well",
                             SCENE_ROWS(rows, n)};
  if (rows == NULL) return;
  for (size_t i = 0; i < n; i++)
    rows[i] = (well){wells[i].attractor, (int)wells[i].well, wells[i].states, wells[i].fraction,
                     wells[i].fraction_error};
  scene_numbering(b->run, "basin_well", n, "well of an attractor, by attractor, then by well");
  SCENE_WRITE(b->run, &table, of_wells);
}

/* None where something has failed. */
static const pendres_basin_well *wells_of(const basins *b, size_t *n)
{
  const pendres_basin_well *wells = NULL;
  *n = 0;
  if (scene_going(b->run)) scene_asked(b->run, pendres_basin_sums_wells(b->sums, n, &wells));
  return wells;
}

void basins_write_wells(basins *b)
{
  size_t n;
  const pendres_basin_well *wells = wells_of(b, &n);
  write_each(b, n, wells);
}

size_t basins_wells_of(const basins *b, int attractor)
{
  size_t n, count = 0;
  const pendres_basin_well *wells = wells_of(b, &n);
  for (size_t i = 0; i < n; i++) count += wells[i].attractor == attractor;
  return count;
}

void basins_print_wells(const basins *b, FILE *out)
{
  size_t n, least = 0, most = 0, several = 0;
  const pendres_basin_well *wells = wells_of(b, &n);
  for (size_t i = 0; i < n; i++) {
    if (wells[i].well < wells[least].well) least = i;
    if (wells[i].well > wells[most].well) most = i;
    several += i > 0 && wells[i].attractor == wells[i - 1].attractor;
  }
  if (several == 0) return;
  fprintf(out, "%zu attractor%s in %zu wells, %ld to %ld; boundaries here are between %s%s\n",
          n - several, n - several > 1 ? "s" : "", n, wells[least].well, wells[most].well,
          b->grid.by == PENDRES_BASIN_BY_WELL ? "wells" : "attractors",
          b->grid.by == PENDRES_BASIN_BY_WELL ? "" : " (with basins.by = 'well' between wells)");
}
