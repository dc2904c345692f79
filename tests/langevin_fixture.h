/* langevin_fixture.h -- what the tests of thermal noise share. */
#ifndef LANGEVIN_FIXTURE_H
#define LANGEVIN_FIXTURE_H

#include "check.h"

#include <pendres/langevin.h>

#define PI 3.14159265358979323846

/*
 * Statistical bounds are 4.5 standard errors, which one in 150 000 honest results would break,
 * over some two hundred comparisons. The seeds are fixed: a test always sees the same numbers.
 */
static const double sigmas = 4.5;

/* A context with a seed, whose noisy trajectories have so many steps a period. */
static inline pendres_context *make(uint64_t seed, int steps, int lanes)
{
  const pendres_options options = {
    .seed = seed, .steps_per_period = steps, .block_lanes = lanes};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&options, &ctx));
  return ctx;
}

/* Trajectories to advance, with the context's steps. */
#define RUN(count, who, names, first, number, observed)                           \
  &(const pendres_langevin_run){.n = (count), .pendulums = (who), .ids = (names), \
                                .first_period = (first), .periods = (number),     \
                                .observer = (observed)}

/* The parameters of the paper's Fig. 7. */
static inline pendres_pendulum figure7(double temperature)
{
  return (pendres_pendulum){.damping = 0.12, .drive_amplitude = 0.2,
                            .drive_frequency = 2.0 * PI / 8.0, .temperature = temperature};
}

/* Strobe point of Fig. 7's SA (large = 0) or LA, by waiting: a period leaves exp(-0.48) of a
 * distance, so the 60 precise ones leave 3e-13 of what the coarse ones are wrong by. */
static inline void orbit(int large, double *x, double *v)
{
  const pendres_pendulum p = figure7(0.0);
  pendres_context *coarse = make(0, 40, 8), *fine = make(0, 2000, 8);
  *x = large ? -0.1 * PI : 0.5 * PI;
  *v = 0.0;
  check_ok(pendres_langevin_advance(coarse, RUN(1, &p, NULL, 0, 100, NULL), x, v));
  check_ok(pendres_langevin_advance(fine, RUN(1, &p, NULL, 100, 60, NULL), x, v));
  pendres_context_free(coarse);
  pendres_context_free(fine);
}

#endif
