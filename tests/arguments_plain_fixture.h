/* arguments_plain_fixture.h -- what these tests of bad arguments share. */
#ifndef ARGUMENTS_PLAIN_FIXTURE_H
#define ARGUMENTS_PLAIN_FIXTURE_H

#include "check.h"

#include <float.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"
#include <pendres/store.h>

#include "langevin_fixture.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define INVALID(call) invalid((call), #call, &wrong)

static const pendres_pendulum good = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.8, .temperature = 1e-3 };
static const pendres_pendulum bad_pendulums[] = {
  { NAN, 0.2, 0.8, 0.0 }, { -0.1, 0.2, 0.8, 0.0 }, { 0.1, INFINITY, 0.8, 0.0 },
  { 0.1, 0.2, 0.0, 0.0 }, { 0.1, 0.2, NAN, 0.0 },  { 0.1, 0.2, 0.8, NAN }, { 0.1, 0.2, 0.8, -1.0 },
  { 0.1, 0.2, 0.8, .torque = NAN },
  { 0.1, 0.2, 0.8, .parametric_amplitude = INFINITY },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_COUNT },
  { 0.1, 0.2, 0.8, .force = (pendres_force)INT_MIN },
  { 0.1, 0.2, 0.8, .force = (pendres_force)INT_MAX },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_POLYNOMIAL },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = { NAN } },
};
static const double bad_numbers[] = { NAN, INFINITY, -INFINITY, DBL_MAX, -1e100 };

static inline void invalid(pendres_status status, const char *call, int *wrong)
{
  if (status == PENDRES_INVALID_ARGUMENT) return;
  print_error("%s: status %d\n", call, (int)status);
  ++*wrong;
}

#endif
