/* arguments_fixture.h -- what the tests of bad arguments share. */
#ifndef ARGUMENTS_FIXTURE_H
#define ARGUMENTS_FIXTURE_H

#include "check.h"

#include <float.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const pendres_pendulum good = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962 };

/* What no computation accepts. */
static const pendres_pendulum bad_pendulums[] = {
  { NAN, 0.2, 0.8, 0.0 },      { INFINITY, 0.2, 0.8, 0.0 }, { -0.1, 0.2, 0.8, 0.0 },
  { 0.1, NAN, 0.8, 0.0 },      { 0.1, -INFINITY, 0.8, 0.0 }, { 0.1, 0.2, NAN, 0.0 },
  { 0.1, 0.2, INFINITY, 0.0 }, { 0.1, 0.2, 0.0, 0.0 },      { 0.1, 0.2, -0.8, 0.0 },
  { 0.1, 0.2, 0.8, NAN },      { 0.1, 0.2, 0.8, -1.0 },     { DBL_MAX, 0.2, 0.8, 0.0 },
  { 0.1, DBL_MAX, 0.8, 0.0 },  { 0.1, 0.2, DBL_MIN, 0.0 },
  { 0.1, 0.2, 0.8, .torque = NAN },
  { 0.1, 0.2, 0.8, .parametric_amplitude = INFINITY },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_COUNT },
  { 0.1, 0.2, 0.8, .force = (pendres_force)INT_MIN },
  { 0.1, 0.2, 0.8, .force = (pendres_force)INT_MAX },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_POLYNOMIAL },
  { 0.1, 0.2, 0.8, .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = { NAN } },
};

static const double bad_numbers[] = { NAN, INFINITY, -INFINITY, DBL_MAX, -1e50 };

/* A context, an attractor and what can be made of it. */
typedef struct fixture {
  pendres_context *ctx;
  pendres_attractors *set;
  pendres_branches *branches;
  pendres_orbit orbit, bad_orbits[32];
  size_t bad, wrong;
  pendres_bifurcation fold;
} fixture;

#define REFUSED(call) refused(f, (call), #call)

/* All that are not refused are told, and the test then fails at its end. */
static inline void refused(fixture *f, pendres_status status, const char *call)
{
  const char *said = pendres_context_message(f->ctx);
  if (status == PENDRES_INVALID_ARGUMENT && strlen(said) >= 8 &&
      strcmp(said, pendres_status_message(status)) != 0)
    return;
  print_error("%s: status %d, \"%s\"\n", call, (int)status, said);
  f->wrong++;
}

static inline void add_bad(fixture *f, pendres_orbit o)
{
  assert_true(f->bad < COUNT(f->bad_orbits));
  f->bad_orbits[f->bad++] = o;
}

static inline int make(void **state)
{
  static fixture f;
  const double x = 1.5, v = 0.0;
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.78, .high = 0.79 };
  check_ok(pendres_context_create(NULL, &f.ctx));
  check_ok(pendres_attractors_find(f.ctx, &good, 1, &x, &v, &f.set));
  f.orbit = pendres_attractors_get(f.set, 0)->orbit;
  check_ok(pendres_branches_find(f.ctx, 1, &f.orbit, &options, &f.branches));
  f.fold = (pendres_bifurcation){ .kind = PENDRES_FOLD, .parameter = PENDRES_DRIVE_FREQUENCY,
                                  .value = 0.8, .orbit = f.orbit };
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    pendres_orbit o = f.orbit;
    o.pendulum = bad_pendulums[i];
    add_bad(&f, o);
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    pendres_orbit o = f.orbit;
    *(i % 2 ? &o.x : &o.v) = bad_numbers[i];
    add_bad(&f, o);
  }
  for (int period = -1; period < 1; period++) {
    pendres_orbit o = f.orbit;
    o.period = period;
    add_bad(&f, o);
    o = f.orbit;
    o.winding = period == 0 ? INT_MIN : INT_MAX;
    add_bad(&f, o);
  }
  *state = &f;
  return 0;
}

static inline int clear(void **state)
{
  fixture *f = *state;
  pendres_branches_free(f->branches);
  pendres_attractors_free(f->set);
  pendres_context_free(f->ctx);
  return 0;
}

#endif
