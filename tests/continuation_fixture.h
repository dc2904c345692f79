/* continuation_fixture.h -- what the tests of continuation share. */
#ifndef CONTINUATION_FIXTURE_H
#define CONTINUATION_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include <pendres/attractor.h>
#include <pendres/continuation.h>
#include "oracle/reference.h"

#include "check.h"

static const double pi = 3.14159265358979323846;
static const double half_pi = 1.57079632679489661923;

/* Errors are estimates: half the true error happens where an error passes through 0 between two
   numbers of steps. What is promised is better than a tenth. */
static const double fair = 2.0;

static inline pendres_context *context_of(double tolerance, pendres_table table)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(
    &(pendres_options){.tolerance = tolerance, .table = table}, &ctx));
  return ctx;
}

/* The attractors of a pendulum; `which` by amplitude. */
static inline pendres_orbit orbit_of(pendres_context *ctx, double damping, double drive,
                                     double frequency,
                                     size_t which)
{
  const pendres_pendulum p = {
    .damping = damping, .drive_amplitude = drive, .drive_frequency = frequency};
  pendres_attractors *found = NULL;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
  const pendres_attractor *a = pendres_attractors_get(found, which);
  assert_non_null(a);
  const pendres_orbit orbit = a->orbit;
  pendres_attractors_free(found);
  return orbit;
}

#endif
