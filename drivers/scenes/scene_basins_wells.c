/* scene_basins_wells.c -- states by attractor and by well, shares by well; see scene_basins.h. */
#include "scenes/scene_basins.h"

#include <stdlib.h>

static pendres_status put(basins *b, const char *name, const char *dimension,
                          const char *long_name, pendres_store_type type, const void *values,
                          size_t n)
{
  const pendres_store_spec spec = {
    .name = name, .dimensions = {dimension}, .long_name = long_name, .type = type};
  return pendres_store_put(b->run->store, &spec, values, n);
}

/* Of each attractor: its states, and its wells. */
static pendres_status write_counts(basins *b, size_t attractors, size_t n,
                                   const pendres_basin_well *wells)
{
  size_t *states = calloc(attractors + 1, sizeof *states);
  int64_t *value = calloc(2 * attractors + 1, sizeof *value);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (states == NULL || value == NULL) goto done;
  status = pendres_basin_sums_counts(b->sums, states);
  for (size_t i = 0; i < attractors; i++) value[i] = (int64_t)states[i];
  for (size_t i = 0; i < n; i++) value[attractors + (size_t)wells[i].attractor]++;
  if (status == PENDRES_OK)
    status = put(b, "basin_states", "attractor", "states of the grid that go there",
                 PENDRES_STORE_INT64, value, attractors);
  if (status == PENDRES_OK)
    status = put(b, "basin_wells", "attractor", "wells that these states settle in",
                 PENDRES_STORE_INT64, value + attractors, attractors);
done:
  free(states);
  free(value);
  return status;
}

/* Of each attractor and well: the states that settle there. */
static pendres_status write_each(basins *b, size_t n, const pendres_basin_well *wells)
{
  int32_t *number = calloc(n + 1, sizeof *number);
  int64_t *states = calloc(n + 1, sizeof *states);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (number == NULL || states == NULL) goto done;
  status = pendres_store_dimension(b->run->store, "", "basin_well", n, NULL,
                                   "well of an attractor, by attractor, then by well", "1");
  for (size_t i = 0; i < n; i++) {
    number[i] = (int32_t)wells[i].attractor;
    states[i] = (int64_t)wells[i].states;
  }
  if (status == PENDRES_OK)
    status = put(b, "basin_well_attractor", "basin_well", "number of the attractor",
                 PENDRES_STORE_INT32, number, n);
  for (size_t i = 0; i < n; i++) number[i] = (int32_t)wells[i].well;
  if (status == PENDRES_OK)
    status = put(b, "basin_well_number", "basin_well",
                 "number of the well; 0 for running and chaotic attractors", PENDRES_STORE_INT32,
                 number, n);
  if (status == PENDRES_OK)
    status = put(b, "basin_well_states", "basin_well", "states of the grid that settle there",
                 PENDRES_STORE_INT64, states, n);
done:
  free(number);
  free(states);
  return status;
}

/* Of each attractor and well: its share of the window. */
static pendres_status write_shares(basins *b, size_t n)
{
  const pendres_store_spec spec = {.name = "basin_well_fraction", .dimensions = {"basin_well"},
                                   .long_name = "share of the window that settles there"};
  double *share = calloc(2 * n + 1, sizeof *share);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (share != NULL) status = pendres_basin_sums_well_shares(b->sums, share, share + n);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(b->run->store, &spec, share, share + n, n);
  free(share);
  return status;
}

pendres_status basins_write_wells(basins *b, size_t attractors)
{
  const pendres_basin_well *wells = NULL;
  size_t n = 0;
  pendres_status status = pendres_basin_sums_wells(b->sums, &n, &wells);
  if (status == PENDRES_OK) status = write_counts(b, attractors, n, wells);
  if (status == PENDRES_OK) status = write_each(b, n, wells);
  if (status == PENDRES_OK && b->grid.by == PENDRES_BASIN_BY_WELL) status = write_shares(b, n);
  return status;
}

void basins_print_wells(const basins *b, FILE *out)
{
  const pendres_basin_well *wells = NULL;
  size_t n = 0, least = 0, most = 0, several = 0;
  if (pendres_basin_sums_wells(b->sums, &n, &wells) != PENDRES_OK) return;
  for (size_t i = 0; i < n; i++) {
    if (wells[i].well < wells[least].well) least = i;
    if (wells[i].well > wells[most].well) most = i;
    several += i > 0 && wells[i].attractor == wells[i - 1].attractor;
  }
  if (several == 0) return;
  fprintf(out, "%zu attractor%s in %zu wells, %ld to %ld; boundaries here are between %s\n",
          n - several, n - several > 1 ? "s" : "", n, wells[least].well, wells[most].well,
          b->grid.by == PENDRES_BASIN_BY_WELL ? "wells" : "attractors");
}
