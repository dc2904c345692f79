/* states_fixture.h -- initial states of tests of members, and what becomes of one. */
#ifndef STATES_FIXTURE_H
#define STATES_FIXTURE_H

#include <pendres/pendres.h>

#include "check.h"

/* The position at which member k starts. */
static inline double member_x(const pendres_ensemble *e, size_t k)
{
  double x;
  pendres_ensemble_start(e, k, &x, NULL);
  return x;
}

/* Settle one pendulum from (x, v) in a context of its own: the attractors, of which it is on
   outcome->attractor. */
static inline pendres_attractors *settle_one(const pendres_pendulum *p, double x, double v,
                                             pendres_settled *outcome)
{
  pendres_context *ctx = NULL;
  pendres_attractors *set = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_settle(ctx, 1, p, &x, &v, outcome, &set));
  pendres_context_free(ctx);
  assert_true(outcome->attractor >= 0);
  return set;
}

#endif
