/*
 * basin_fixture.h -- what tests of basins share: Fig. 7's pendulum, grids, contexts.
 */
#ifndef BASIN_FIXTURE_H
#define BASIN_FIXTURE_H

#include "context_fixture.h"

#include <stdlib.h>

#include <pendres/basin.h>
#include <pendres/pendres.h>

static const double pi = 3.14159265358979323846;

static const pendres_pendulum fig7 = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962};

static inline double next_random(uint64_t *z)
{
  *z = *z * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*z >> 11) * 0x1p-53;
}

/* Evenly spaced, points in the middle of their cells. */
static inline double *spaced(size_t n, double first, double last)
{
  double *values = malloc(n * sizeof *values);
  assert_non_null(values);
  for (size_t i = 0; i < n; i++) values[i] = first + (last - first) * ((double)i + 0.5) / (double)n;
  return values;
}

typedef struct portrait {
  pendres_basin_grid grid;
  double *x, *v;
  pendres_attractors *set;
  pendres_basin_state *state;
} portrait;

static inline void compute(pendres_context *ctx, const pendres_pendulum *p, size_t nx, size_t nv,
                           double fastest, portrait *out)
{
  out->x = spaced(nx, -0.5 * pi, 1.5 * pi);
  out->v = spaced(nv, -fastest, fastest);
  out->grid = (pendres_basin_grid){.nx = nx, .nv = nv, .x = out->x, .v = out->v};
  out->state = malloc(nx * nv * sizeof *out->state);
  assert_non_null(out->state);
  check_ok(pendres_basin_attractors(ctx, p, &out->grid, &out->set));
  check_ok(pendres_basin_find(ctx, out->set, &out->grid, out->state));
}

static inline void release(portrait *p)
{
  free(p->x);
  free(p->v);
  free(p->state);
  pendres_attractors_free(p->set);
}

#endif
