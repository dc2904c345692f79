/* basin.c -- which starts end on the small and which on the large oscillation, as a picture of
 * letters, and their shares of the area. */
#include <stdio.h>

#include <pendres/pendres.h>

enum { NX = 32, NV = 64 };

int main(void)
{
  const pendres_pendulum p = {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  static double x[NX], v[NV], share[16], share_error[16];
  static pendres_basin_state state[NX * NV];
  pendres_basin_grid grid = {.nx = NX, .nv = NV, .x = x, .v = v};
  pendres_context *ctx = NULL;
  pendres_attractors *set = NULL;
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics statistics;
  int failed;

  for (int i = 0; i < NX; i++) x[i] = -1.5 + 6.2 * i / (NX - 1);
  for (int j = 0; j < NV; j++) v[j] = -2.0 + 4.0 * j / (NV - 1);
  failed = pendres_context_create(NULL, &ctx) || pendres_basin_attractors(ctx, &p, &grid, &set) ||
           pendres_basin_find(ctx, set, &grid, state) || pendres_attractors_count(set) > 16 ||
           pendres_basin_sums_create(&grid, pendres_attractors_count(set), &sums) ||
           pendres_basin_sums_add(sums, NX, state) ||
           pendres_basin_sums_result(sums, &statistics, share, share_error);
  if (failed) {
    fprintf(stderr, "%s\n", pendres_context_message(ctx));
  } else {
    for (int i = 0; i < NX; i++) {
      for (int j = 0; j < NV; j++) putchar("sLprc?"[state[i * NV + j].label]);
      putchar('\n');
    }
    for (size_t k = 0; k < pendres_attractors_count(set); k++)
      printf("%s: amplitude %.6f, share %.3f +- %.3f\n",
             pendres_name_get(PENDRES_NAMES_LABEL, pendres_attractors_get(set, k)->label),
             pendres_attractors_get(set, k)->orbit.amplitude, share[k], share_error[k]);
  }
  pendres_basin_sums_free(sums);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  return failed;
}
