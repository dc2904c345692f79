/* measure.c -- a measure of one's own on an orbit: the mean kinetic energy, from equally spaced
 * samples. Samples of a smooth closed curve give its means to all digits, with no weights. */
#include <stdio.h>

#include <pendres/pendres.h>

enum { SAMPLES = 128 };

static double mean_kinetic_energy(const double *v, int count)
{
  double sum = 0.0;

  for (int k = 0; k < count; k++) sum += 0.5 * v[k] * v[k];
  return sum / count;
}

int main(void)
{
  const pendres_orbit_guess guess = {
      .pendulum = {.damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.9},
      .x = 1.9, .v = 0.7, .period = 1};
  pendres_context *ctx = NULL;
  pendres_orbit orbit;
  pendres_status outcome = PENDRES_OK;
  double x[SAMPLES], v[SAMPLES], error[2];
  int failed;

  failed = pendres_context_create(NULL, &ctx) ||
           pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome) || outcome ||
           pendres_orbit_sample(ctx, &orbit, SAMPLES, x, v, error);
  if (failed) {
    fprintf(stderr, "%s\n", pendres_context_message(ctx));
  } else {
    const double energy = mean_kinetic_energy(v, SAMPLES);
    const double period = 2.0 * 3.14159265358979324 / guess.pendulum.drive_frequency;

    printf("mean kinetic energy %.12f, velocities to %.0e\n", energy, error[1]);
    /* The dissipation of a cycle is twice that, times the damping and the period. */
    printf("dissipation from it %.12f, the library's %.12f +- %.0e\n",
           2.0 * guess.pendulum.damping * energy * period, orbit.dissipation,
           orbit.dissipation_error);
  }
  pendres_context_free(ctx);
  return failed;
}
