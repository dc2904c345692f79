/* states_fixture.h -- initial states of tests of members. */
#ifndef STATES_FIXTURE_H
#define STATES_FIXTURE_H

#include <pendres/sweep.h>

/* The position at which member k starts. */
static inline double member_x(const pendres_ensemble *e, size_t k)
{
  double x;
  pendres_ensemble_start(e, k, &x, NULL);
  return x;
}

#endif
