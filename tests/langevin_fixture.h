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

static inline pendres_langevin *make(uint64_t seed, int steps, int lanes)
{
  const pendres_langevin_options options = {
    .seed = seed, .steps_per_period = steps, .block_lanes = lanes};
  pendres_langevin *lv = NULL;
  check_ok(pendres_langevin_create(&options, &lv));
  return lv;
}

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
  pendres_langevin *lv = make(0, 40, 8);
  *x = large ? -0.1 * PI : 0.5 * PI;
  *v = 0.0;
  check_ok(pendres_langevin_advance(lv, 1, &p, NULL, 0, 100, x, v, NULL));
  check_ok(pendres_langevin_set_steps(lv, 2000));
  check_ok(pendres_langevin_advance(lv, 1, &p, NULL, 100, 60, x, v, NULL));
  pendres_langevin_free(lv);
}

#endif
