/* switching_fixture.h -- what tests of switching start from: the attractors without noise. */
#ifndef PENDRES_TESTS_SWITCHING_FIXTURE_H
#define PENDRES_TESTS_SWITCHING_FIXTURE_H

#include "langevin_fixture.h"

#include <pendres/switching.h>

/* Of a pendulum, whatever its temperature; the caller frees. */
static pendres_attractors *attractors(pendres_pendulum p)
{
  pendres_context *ctx = NULL;
  pendres_attractors *set = NULL;
  p.temperature = 0.0;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  pendres_context_free(ctx);
  return set;
}

#endif
