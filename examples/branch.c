/* branch.c -- a branch of oscillations over the drive frequency, stable and unstable, with the
 * folds at which a slow sweep would jump. */
#include <stdio.h>

#include <pendres/pendres.h>

int main(void)
{
  const pendres_pendulum p = {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8};
  const pendres_branch_options options = {
      .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.5, .high = 1.2, .spacing = 0.2};
  pendres_context *ctx = NULL;
  pendres_attractors *found = NULL;
  pendres_branches *branches = NULL;
  int failed;

  failed = pendres_context_create(NULL, &ctx) ||
           pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found) ||
           pendres_branches_find(ctx, 1, &pendres_attractors_get(found, 0)->orbit, &options,
                                 &branches);
  if (failed) fprintf(stderr, "%s\n", pendres_context_message(ctx));
  const pendres_branch *branch = pendres_branches_get(branches, 0);
  for (size_t i = 0; i < pendres_branch_count(branch); i++) {
    const pendres_branch_point *point = pendres_branch_get(branch, i);

    printf("omega %.6f  amplitude %.6f  %s\n", point->orbit.pendulum.drive_frequency,
           point->orbit.amplitude, point->orbit.stable ? "stable" : "unstable");
  }
  for (size_t i = 0; i < pendres_branch_bifurcation_count(branch); i++) {
    const pendres_bifurcation *b = pendres_branch_bifurcation_get(branch, i);

    if (b->kind == PENDRES_FOLD)
      printf("fold at omega = %.10f +- %.0e, amplitude %.6f\n", b->value, b->value_error,
             b->orbit.amplitude);
  }
  pendres_branches_free(branches);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
  return failed;
}
