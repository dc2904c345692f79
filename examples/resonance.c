/* resonance.c -- the drive frequency at which a pendulum takes most energy a cycle, and its
 * error. */
#include <stdio.h>

#include <pendres/pendres.h>

int main(void)
{
  pendres_context *ctx = NULL;
  pendres_resonance r;
  const pendres_pendulum p = {.damping = 0.24, .drive_amplitude = 0.2};
  int failed = 1;

  if (pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &ctx) ||
      pendres_resonance_find(ctx, &p, 0.5, 1.2, &r))
    fprintf(stderr, "%s\n", pendres_context_message(ctx));
  else
    failed = printf("omega = %.10f +- %.0e, loop area %.10f +- %.0e\n", r.frequency,
                    r.frequency_error, r.loop_area, r.loop_area_error) < 0;
  pendres_context_free(ctx);
  return failed;
}
