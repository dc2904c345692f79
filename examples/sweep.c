/* sweep.c -- the drive frequency swept slowly up and then down again, as in a laboratory: the
 * amplitude depends on the direction, and jumps where a state ends. */
#include <stdio.h>

#include <pendres/pendres.h>

enum { POINTS = 41 };

int main(void)
{
  const pendres_pendulum p = {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.7};
  const pendres_state start = {.x = 1.6, .v = 0.0};
  double frequency[2 * POINTS]; /* up, and down again */
  const pendres_hysteresis_path path = {PENDRES_DRIVE_FREQUENCY, 2 * POINTS, frequency};
  pendres_context *ctx = NULL;
  pendres_hysteresis *sweep = NULL;
  int failed;

  for (int i = 0; i < POINTS; i++)
    frequency[i] = frequency[2 * POINTS - 1 - i] = 0.7 + 0.2 * i / (POINTS - 1);
  failed = pendres_context_create(NULL, &ctx) ||
           pendres_hysteresis_find(ctx, &p, &start, &path, &sweep);
  if (failed) fprintf(stderr, "%s\n", pendres_context_message(ctx));
  for (size_t i = 0; i < POINTS && !failed; i++) {
    const pendres_orbit *up = &pendres_hysteresis_get(sweep, i)->attractor.orbit,
                        *down = &pendres_hysteresis_get(sweep, 2 * POINTS - 1 - i)->attractor.orbit;

    printf("omega %.3f  amplitude going up %.6f, going down %.6f\n", frequency[i],
           up->amplitude, down->amplitude);
  }
  for (size_t i = 0; i < pendres_hysteresis_jump_count(sweep); i++) {
    const pendres_jump *jump = pendres_hysteresis_jump_get(sweep, i);

    printf("going %s it jumps from %s to %s at omega = %.10f +- %.0e\n",
           jump->direction > 0 ? "up" : "down", pendres_name_get(PENDRES_NAMES_LABEL, jump->from),
           pendres_name_get(PENDRES_NAMES_LABEL, jump->to), jump->value, jump->value_error);
  }
  pendres_hysteresis_free(sweep);
  pendres_context_free(ctx);
  return failed;
}
