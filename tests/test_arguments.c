/*
 * test_arguments.c -- every public function that computes with a context, with every argument NULL,
 * NaN, infinite, huge, negative or out of its enum: refused with a sentence of its own, and nothing
 * is computed. tests/symbols_check.sh sees to it that no public function is left out; those without
 * a context are in test_arguments_plain.c.
 */
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
};

static const double bad_numbers[] = { NAN, INFINITY, -INFINITY, DBL_MAX, -1e50 };

/* A context, an attractor and what can be made of it. */
typedef struct fixture {
  pendres_context *ctx;
  pendres_attractors *set;
  pendres_branches *branches;
  pendres_orbit orbit, bad_orbits[24];
  size_t bad, wrong;
  pendres_bifurcation fold;
} fixture;

#define REFUSED(call) refused(f, (call), #call)

/* All that are not refused are told, and the test then fails at its end. */
static void refused(fixture *f, pendres_status status, const char *call)
{
  const char *said = pendres_context_message(f->ctx);
  if (status == PENDRES_INVALID_ARGUMENT && strlen(said) >= 8 &&
      strcmp(said, pendres_status_message(status)) != 0)
    return;
  print_error("%s: status %d, \"%s\"\n", call, (int)status, said);
  f->wrong++;
}

static void add_bad(fixture *f, pendres_orbit o)
{
  assert_true(f->bad < COUNT(f->bad_orbits));
  f->bad_orbits[f->bad++] = o;
}

static int make(void **state)
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
  }
  *state = &f;
  return 0;
}

static int clear(void **state)
{
  fixture *f = *state;
  pendres_branches_free(f->branches);
  pendres_attractors_free(f->set);
  pendres_context_free(f->ctx);
  return 0;
}

static void strobes(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  double x = 1.0, v = 0.0, many[40];
  REFUSED(pendres_strobe_advance(f->ctx, 1, NULL, &x, &v, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, NULL, &v, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, NULL, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &v, -1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &v, LONG_MIN, NULL));
  REFUSED(pendres_strobe_record(f->ctx, NULL, x, v, 1, 2, many, many, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, 1, 2, NULL, many, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, 1, 2, many, NULL, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, 1, 2, many, many, many, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, -1, 2, many, many, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, LONG_MAX, 2, many, many, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, 1, 0, many, many, NULL, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, x, v, 1, INT_MAX, many, many, NULL, NULL));
  pendres_recording r = { .samples = 0 };
  REFUSED(pendres_recording_go_on(f->ctx, &r, 1, many, many, NULL, NULL));
  REFUSED(pendres_recording_begin(f->ctx, NULL, x, v, 1, 2, &r));
  REFUSED(pendres_recording_begin(f->ctx, &good, x, v, 1, 2, NULL));
  REFUSED(pendres_recording_begin(f->ctx, &good, x, NAN, 1, 2, &r));
  REFUSED(pendres_recording_begin(f->ctx, &good, x, v, 1, 0, &r));
  check_ok(pendres_recording_begin(f->ctx, &good, x, v, 1, 2, &r));
  REFUSED(pendres_recording_go_on(f->ctx, NULL, 1, many, many, NULL, NULL));
  REFUSED(pendres_recording_go_on(f->ctx, &r, -1, many, many, NULL, NULL));
  REFUSED(pendres_recording_go_on(f->ctx, &r, 1, NULL, many, NULL, NULL));
  REFUSED(pendres_recording_go_on(f->ctx, &r, 1, many, NULL, NULL, NULL));
  REFUSED(pendres_recording_go_on(f->ctx, &r, 1, many, many, many, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    REFUSED(pendres_strobe_advance(f->ctx, 1, &bad_pendulums[i], &x, &v, 1, NULL));
    REFUSED(pendres_strobe_record(f->ctx, &bad_pendulums[i], x, v, 1, 2, many, many, NULL, NULL));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    double b = bad_numbers[i];
    REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &b, &v, 1, NULL));
    REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &b, 1, NULL));
    REFUSED(pendres_strobe_record(f->ctx, &good, b, v, 1, 2, many, many, NULL, NULL));
    REFUSED(pendres_strobe_record(f->ctx, &good, x, b, 1, 2, many, many, NULL, NULL));
  }
  assert_true(x == 1.0 && v == 0.0);
  assert_int_equal(f->wrong, 0);
}

static void settling(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double x = 1.0, v = 0.0;
  pendres_outcome out;
  pendres_attractors *found = NULL;
  REFUSED(pendres_settle(f->ctx, 1, NULL, &x, &v, &out, NULL));
  REFUSED(pendres_settle(f->ctx, 1, &good, NULL, &v, &out, NULL));
  REFUSED(pendres_settle(f->ctx, 1, &good, &x, NULL, &out, NULL));
  REFUSED(pendres_settle(f->ctx, 1, &good, &x, &v, NULL, NULL));
  REFUSED(pendres_attractors_find(f->ctx, NULL, 1, &x, &v, &found));
  REFUSED(pendres_attractors_find(f->ctx, &good, 1, NULL, &v, &found));
  REFUSED(pendres_attractors_find(f->ctx, &good, 1, &x, NULL, &found));
  REFUSED(pendres_attractors_find(f->ctx, &good, 1, &x, &v, NULL));
  REFUSED(pendres_attractors_settle(f->ctx, NULL, 1, &x, &v, &out));
  REFUSED(pendres_attractors_settle(f->ctx, f->set, 1, NULL, &v, &out));
  REFUSED(pendres_attractors_settle(f->ctx, f->set, 1, &x, NULL, &out));
  REFUSED(pendres_attractors_settle(f->ctx, f->set, 1, &x, &v, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    REFUSED(pendres_settle(f->ctx, 1, &bad_pendulums[i], &x, &v, &out, &found));
    REFUSED(pendres_attractors_find(f->ctx, &bad_pendulums[i], 1, &x, &v, &found));
    REFUSED(pendres_attractors_find(f->ctx, &bad_pendulums[i], 0, NULL, NULL, &found));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    const double *b = &bad_numbers[i];
    REFUSED(pendres_settle(f->ctx, 1, &good, b, &v, &out, &found));
    REFUSED(pendres_settle(f->ctx, 1, &good, &x, b, &out, &found));
    REFUSED(pendres_attractors_find(f->ctx, &good, 1, b, &v, &found));
    REFUSED(pendres_attractors_settle(f->ctx, f->set, 1, b, &v, &out));
    REFUSED(pendres_attractors_settle(f->ctx, f->set, 1, &x, b, &out));
  }
  assert_null(found);
  assert_int_equal(f->wrong, 0);
}

static void orbits(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_orbit out;
  pendres_status how;
  double x[64], v[64];
  const pendres_orbit_guess guess = { .pendulum = good, .x = 1.0, .period = 1 };
  REFUSED(pendres_orbit_refine(f->ctx, 1, NULL, PENDRES_ORBIT_PLAIN, &out, &how));
  REFUSED(pendres_orbit_refine(f->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, NULL, &how));
  REFUSED(pendres_orbit_refine(f->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &out, NULL));
  REFUSED(pendres_orbit_refine(f->ctx, 1, &guess, (pendres_orbit_want)7, &out, &how));
  for (size_t i = 0; i < f->bad; i++) {
    const pendres_orbit *o = &f->bad_orbits[i];
    const pendres_orbit_guess g = { o->pendulum, o->x, o->v, o->period, o->winding };
    REFUSED(pendres_orbit_refine(f->ctx, 1, &g, PENDRES_ORBIT_PLAIN, &out, &how));
    REFUSED(pendres_orbit_sample(f->ctx, o, 8, x, v));
    REFUSED(pendres_orbit_sample_with_error(f->ctx, o, 8, x, v, x, v));
  }
  REFUSED(pendres_orbit_sample(f->ctx, NULL, 8, x, v));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, 0, x, v));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, -8, x, v));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, INT_MAX, x, v));
  const double amplitudes[] = { NAN, INFINITY, -1.0, 0.0, 3.2, DBL_MAX };
  double one = 1.0, error;
  for (size_t i = 0; i < COUNT(amplitudes); i++)
    REFUSED(pendres_free_frequency_integrate(f->ctx, 1, &amplitudes[i], &one, &error));
  REFUSED(pendres_free_frequency_integrate(f->ctx, 1, NULL, &one, &error));
  REFUSED(pendres_free_frequency_integrate(f->ctx, 1, &one, NULL, &error));
  REFUSED(pendres_free_frequency_integrate(f->ctx, 1, &one, &one, NULL));
  assert_int_equal(f->wrong, 0);
}

static void basins(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  double x[2] = { 0.0, 1.0 }, v[2] = { 0.0, 0.5 };
  pendres_basin_state s[4];
  pendres_attractors *out = NULL;
  pendres_basin_statistics statistics;
  size_t index = 1, huge = SIZE_MAX, grown;
  const pendres_basin_grid grid = { .nx = 2, .nv = 2, .x = x, .v = v };
  const double distance[1] = { 0.01 }, three[3] = { 0.01, 0.02, 0.04 };
  const pendres_basin_window window = { .x_high = 1.0, .v_high = 1.0 };
  pendres_basin_grid bad[] = {
    { .nx = 0, .nv = 2, .x = x, .v = v }, { .nx = 2, .nv = 0, .x = x, .v = v },
    { .nx = 2, .nv = 2, .v = v }, { .nx = 2, .nv = 2, .x = x }, { .nx = 1, .nv = 1 } };
  REFUSED(pendres_basin_attractors(f->ctx, NULL, &grid, &out));
  REFUSED(pendres_basin_attractors(f->ctx, &good, NULL, &out));
  REFUSED(pendres_basin_attractors(f->ctx, &good, &grid, NULL));
  REFUSED(pendres_basin_rows(f->ctx, NULL, &grid, 0, 1, s, &grown));
  REFUSED(pendres_basin_rows(f->ctx, f->set, NULL, 0, 1, s, &grown));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 0, 1, NULL, &grown));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 2, 1, s, &grown));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 1, SIZE_MAX, s, &grown));
  REFUSED(pendres_basin_states(f->ctx, NULL, &grid, 1, &index, s));
  REFUSED(pendres_basin_states(f->ctx, f->set, NULL, 1, &index, s));
  REFUSED(pendres_basin_states(f->ctx, f->set, &grid, 1, NULL, s));
  REFUSED(pendres_basin_states(f->ctx, f->set, &grid, 1, &index, NULL));
  REFUSED(pendres_basin_states(f->ctx, f->set, &grid, 1, &huge, s));
  REFUSED(pendres_basin_extend(f->ctx, NULL, &grid, 1, &index, &grown));
  REFUSED(pendres_basin_extend(f->ctx, f->set, NULL, 1, &index, &grown));
  REFUSED(pendres_basin_extend(f->ctx, f->set, &grid, 1, NULL, &grown));
  REFUSED(pendres_basin_extend(f->ctx, f->set, &grid, 1, &index, NULL));
  REFUSED(pendres_basin_extend(f->ctx, f->set, &grid, 1, &huge, &grown));
  REFUSED(pendres_basin_compute(f->ctx, NULL, &grid, s));
  REFUSED(pendres_basin_compute(f->ctx, f->set, NULL, s));
  REFUSED(pendres_basin_compute(f->ctx, f->set, &grid, NULL));
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_basin_attractors(f->ctx, &good, &bad[i], &out));
    REFUSED(pendres_basin_rows(f->ctx, f->set, &bad[i], 0, 1, s, &grown));
    REFUSED(pendres_basin_states(f->ctx, f->set, &bad[i], 1, &index, s));
    REFUSED(pendres_basin_extend(f->ctx, f->set, &bad[i], 1, &index, &grown));
    REFUSED(pendres_basin_compute(f->ctx, f->set, &bad[i], s));
  }
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    REFUSED(pendres_basin_attractors(f->ctx, &bad_pendulums[i], &grid, &out));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    x[1] = bad_numbers[i], v[1] = i % 2 ? bad_numbers[i] : 0.5;
    index = 3;
    REFUSED(pendres_basin_attractors(f->ctx, &good, &grid, &out));
    REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 0, 2, s, &grown));
    REFUSED(pendres_basin_states(f->ctx, f->set, &grid, 1, &index, s));
    REFUSED(pendres_basin_extend(f->ctx, f->set, &grid, 1, &index, &grown));
    REFUSED(pendres_basin_compute(f->ctx, f->set, &grid, s));
    pendres_basin_window w = window;
    w.x_high = bad_numbers[i];
    REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &w, 9, 1, distance, 1, &statistics));
    REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 9, 1, &bad_numbers[i], 1,
                                      &statistics));
  }
  pendres_basin_window no_end = window;
  no_end.by = (pendres_basin_end)7;
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &no_end, 16, 3, three, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, NULL, &window, 9, 1, distance, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, NULL, 9, 1, distance, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 0, 1, distance, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 9, 0, distance, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 9, 999, distance, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 9, 1, NULL, 1, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, 9, 1, distance, 1, NULL));
  assert_null(out);
  assert_int_equal(f->wrong, 0);
}

static void boundaries(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_orbit out;
  pendres_boundary *b = NULL;
  REFUSED(pendres_saddle_find(f->ctx, NULL, &out));
  REFUSED(pendres_saddle_find(f->ctx, &f->orbit, NULL));
  REFUSED(pendres_boundary_find(f->ctx, NULL, NULL, &b));
  REFUSED(pendres_boundary_find(f->ctx, &f->orbit, NULL, NULL));
  REFUSED(pendres_boundary_find(f->ctx, &f->orbit, NULL, &b)); /* it attracts */
  for (size_t i = 0; i < f->bad; i++) {
    REFUSED(pendres_saddle_find(f->ctx, &f->bad_orbits[i], &out));
    REFUSED(pendres_boundary_find(f->ctx, &f->bad_orbits[i], NULL, &b));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    const pendres_boundary_options o[] = {
      { .x_low = bad_numbers[i], .x_high = bad_numbers[i] }, { .v_high = bad_numbers[i] },
      { .spacing = -fabs(bad_numbers[i]) }, { .deviation = -fabs(bad_numbers[i]) } };
    for (size_t k = 0; k < COUNT(o); k++)
      REFUSED(pendres_boundary_find(f->ctx, &f->orbit, &o[k], &b));
  }
  assert_null(b);
  assert_int_equal(f->wrong, 0);
}

static void branches(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_fold fold;
  pendres_orbit out;
  pendres_branch *branch = NULL;
  pendres_branches *all = NULL;
  size_t found;
  pendres_status how;
  double error;
  const pendres_branch *known = pendres_branches_get(f->branches, 0);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.78, .high = 0.79 };
  pendres_branch_options bad[] = { options, options, options, options, options, options, options };
  assert_non_null(known);
  bad[0].parameter = PENDRES_PARAMETER_COUNT;
  bad[1].parameter = (pendres_parameter)-1;
  bad[2].low = NAN;
  bad[3].high = INFINITY;
  bad[4].low = 0.79, bad[4].high = 0.78;
  bad[5].spacing = NAN;
  bad[6].wildest = NAN;
  REFUSED(pendres_fold_find(f->ctx, NULL, &fold));
  REFUSED(pendres_fold_find(f->ctx, &f->orbit, NULL));
  REFUSED(pendres_fold_find_along(f->ctx, NULL, PENDRES_DAMPING, &fold));
  REFUSED(pendres_fold_find_along(f->ctx, &f->orbit, PENDRES_DAMPING, NULL));
  REFUSED(pendres_fold_find_along(f->ctx, &f->orbit, PENDRES_PARAMETER_COUNT, &fold));
  REFUSED(pendres_fold_find_along(f->ctx, &f->orbit, (pendres_parameter)-1, &fold));
  REFUSED(pendres_branch_follow(f->ctx, 1, NULL, &options, &branch));
  REFUSED(pendres_branch_follow(f->ctx, 1, &f->orbit, NULL, &branch));
  REFUSED(pendres_branch_follow(f->ctx, 1, &f->orbit, &options, NULL));
  REFUSED(pendres_branches_find(f->ctx, 1, NULL, &options, &all));
  REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, NULL, &all));
  REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, &options, NULL));
  REFUSED(pendres_branches_extend(f->ctx, 1, NULL, &options, f->branches));
  REFUSED(pendres_branches_extend(f->ctx, 1, &f->fold, NULL, f->branches));
  REFUSED(pendres_branches_extend(f->ctx, 1, &f->fold, &options, NULL));
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_branch_follow(f->ctx, 1, &f->orbit, &bad[i], &branch));
    REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, &bad[i], &all));
  }
  for (size_t i = 0; i < f->bad; i++) {
    REFUSED(pendres_fold_find(f->ctx, &f->bad_orbits[i], &fold));
    REFUSED(pendres_branch_follow(f->ctx, 1, &f->bad_orbits[i], &options, &branch));
    REFUSED(pendres_branches_find(f->ctx, 1, &f->bad_orbits[i], &options, &all));
  }
  REFUSED(pendres_branch_cross(f->ctx, NULL, 0.785, 1, &out, &found));
  REFUSED(pendres_branch_cross(f->ctx, known, 0.785, 1, NULL, &found));
  REFUSED(pendres_branch_cross(f->ctx, known, 0.785, 1, &out, NULL));
  REFUSED(pendres_branch_cross(f->ctx, known, NAN, 1, &out, &found));
  REFUSED(pendres_branch_switch(f->ctx, NULL, &out));
  REFUSED(pendres_branch_switch(f->ctx, &f->fold, &out)); /* nothing crosses at a fold */
  REFUSED(pendres_backbone_find(f->ctx, 1, NULL, &out, &error, &how));
  REFUSED(pendres_backbone_find(f->ctx, 1, &good, NULL, &error, &how));
  REFUSED(pendres_backbone_find(f->ctx, 1, &good, &out, &error, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    if (i < 5 || (i >= 9 && i < 13)) /* it finds the drive frequency itself */
      REFUSED(pendres_backbone_find(f->ctx, 1, &bad_pendulums[i], &out, &error, &how));
  assert_true(branch == NULL && all == NULL);
  assert_int_equal(f->wrong, 0);
}

static void hysteresis(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double value[] = { 0.7, 0.75 }, none[] = { 0.7, NAN };
  const pendres_parameter along = PENDRES_DRIVE_FREQUENCY;
  pendres_hysteresis *h = NULL;
  REFUSED(pendres_hysteresis_follow(f->ctx, NULL, along, 1.0, 0.0, 2, value, &h));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, along, 1.0, 0.0, 2, NULL, &h));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, along, 1.0, 0.0, 2, value, NULL));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, along, 1.0, 0.0, 2, none, &h));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, PENDRES_DAMPING, 1.0, 0.0, 2,
                                    (const double[]){ 0.1, 0.0 }, &h));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, (pendres_parameter)-1, 1.0, 0.0, 2, value, &h));
  REFUSED(pendres_hysteresis_follow(f->ctx, &good, PENDRES_PARAMETER_COUNT, 1.0, 0.0, 2, value,
                                    &h));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    REFUSED(pendres_hysteresis_follow(f->ctx, &good, along, bad_numbers[i], 0.0, 2, value, &h));
    REFUSED(pendres_hysteresis_follow(f->ctx, &good, along, 1.0, bad_numbers[i], 2, value, &h));
  }
  assert_null(h);
  assert_int_equal(f->wrong, 0);
}

static void cascades(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const pendres_parameter along = PENDRES_DRIVE_AMPLITUDE;
  pendres_cascade c;
  REFUSED(pendres_cascade_find(f->ctx, NULL, along, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, along, 0.3, NULL));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, (pendres_parameter)-1, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, PENDRES_PARAMETER_COUNT, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, along, NAN, &c));
  for (size_t i = 0; i < f->bad; i++)
    REFUSED(pendres_cascade_find(f->ctx, &f->bad_orbits[i], along, 0.3, &c));
  assert_int_equal(f->wrong, 0);
}

static void exponents(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double zero = 0.0;
  const pendres_lyapunov_options bad[] = { { .transient = -1 }, { .periods = -1 },
                                           { .transient = LONG_MAX }, { .periods = LONG_MAX } };
  pendres_pendulum undamped = good;
  pendres_lyapunov l;
  undamped.damping = 0.0;
  REFUSED(pendres_lyapunov_find(f->ctx, 1, NULL, &zero, &zero, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, NULL, &zero, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, NULL, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &zero, NULL, NULL));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &undamped, &zero, &zero, NULL, &l));
  for (size_t i = 0; i < COUNT(bad); i++)
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &zero, &bad[i], &l));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &bad_pendulums[i], &zero, &zero, NULL, &l));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &bad_numbers[i], &zero, NULL, &l));
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &bad_numbers[i], NULL, &l));
  }
  assert_int_equal(f->wrong, 0);
}

static void curves(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_curve *curve = NULL;
  pendres_curves *all = NULL;
  pendres_bifurcation out;
  pendres_cusp cusp;
  size_t found;
  const pendres_curve_options options = { .second = PENDRES_DAMPING, .low = { 0.7, 0.1 },
                                          .high = { 0.9, 0.2 } };
  pendres_curve_options bad[] = { options, options, options, options, options, options };
  pendres_bifurcation starts[] = { f->fold, f->fold, f->fold, f->fold };
  bad[0].second = PENDRES_PARAMETER_COUNT;
  bad[1].second = (pendres_parameter)-1;
  bad[2].low[0] = NAN;
  bad[3].high[1] = INFINITY;
  bad[4].low[1] = 0.3;
  bad[5].spacing = NAN;
  starts[0].kind = PENDRES_REGULAR;
  starts[1].kind = (pendres_special)9;
  starts[2].parameter = PENDRES_PARAMETER_COUNT;
  starts[3].parameter = (pendres_parameter)-1;
  for (size_t i = 0; i < COUNT(bad); i++)
    REFUSED(pendres_curve_follow(f->ctx, 1, &f->fold, &bad[i], &curve));
  for (size_t i = 0; i < COUNT(starts); i++) {
    REFUSED(pendres_curve_follow(f->ctx, 1, &starts[i], &options, &curve));
    REFUSED(pendres_cusp_find(f->ctx, &starts[i], PENDRES_DAMPING, &cusp));
    REFUSED(pendres_branch_switch(f->ctx, &starts[i], &f->orbit));
  }
  for (size_t i = 0; i < f->bad; i++) {
    pendres_bifurcation b = f->fold;
    b.orbit = f->bad_orbits[i];
    REFUSED(pendres_curve_follow(f->ctx, 1, &b, &options, &curve));
    REFUSED(pendres_cusp_find(f->ctx, &b, PENDRES_DAMPING, &cusp));
    b.kind = PENDRES_PERIOD_DOUBLING;
    REFUSED(pendres_branch_switch(f->ctx, &b, &f->orbit));
  }
  REFUSED(pendres_curve_follow(f->ctx, 1, NULL, &options, &curve));
  REFUSED(pendres_curve_follow(f->ctx, 1, &f->fold, NULL, &curve));
  REFUSED(pendres_curve_follow(f->ctx, 1, &f->fold, &options, NULL));
  REFUSED(pendres_curve_cross(f->ctx, NULL, 0.1, 1, &out, &found));
  REFUSED(pendres_curves_find(f->ctx, 1, NULL, &options, &all));
  REFUSED(pendres_curves_find(f->ctx, 1, &f->fold, NULL, &all));
  REFUSED(pendres_curves_find(f->ctx, 1, &f->fold, &options, NULL));
  REFUSED(pendres_curves_extend(f->ctx, 1, &f->fold, &options, NULL));
  REFUSED(pendres_curves_extend(f->ctx, 1, &f->fold, NULL, NULL));
  REFUSED(pendres_cusp_find(f->ctx, NULL, PENDRES_DAMPING, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_DAMPING, NULL));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_DRIVE_FREQUENCY, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_PARAMETER_COUNT, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, (pendres_parameter)-1, &cusp));
  assert_true(curve == NULL && all == NULL);
  assert_int_equal(f->wrong, 0);
}

static void ensembles(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const pendres_ensemble some = { .members = 4, .x_first = 0.0, .x_last = 1.0 };
  const pendres_ensemble area = { .members = 4, .x_first = 0.0, .x_last = 1.0, .v_last = 1.0,
                                  .shape = PENDRES_ENSEMBLE_RECTANGLE, .rows = 2 };
  pendres_ensemble bad[] = { some, some, some, some, some, some, some, area, area, area, area };
  pendres_response r;
  pendres_resonance peak;
  pendres_phase_point point;
  pendres_branches *all = NULL;
  pendres_phase_options line = {.ensemble = some};
  bad[0].members = 0;
  bad[1].x_first = NAN;
  bad[2].x_last = INFINITY;
  bad[3].v = NAN;
  bad[4].x_first = -1e50;
  bad[5].v = DBL_MAX;
  bad[6].shape = PENDRES_ENSEMBLE_SHAPE_COUNT;
  bad[7].rows = 0;
  bad[8].rows = 3;
  bad[9].v_last = NAN;
  bad[10].x_last = 0.0;
  REFUSED(pendres_response_compute(f->ctx, 1, NULL, &some, &r));
  REFUSED(pendres_response_compute(f->ctx, 1, &good, NULL, &r));
  REFUSED(pendres_response_compute(f->ctx, 1, &good, &some, NULL));
  REFUSED(pendres_response_name(f->ctx, 1, NULL));
  REFUSED(pendres_resonance_find(f->ctx, NULL, 0.7, 0.9, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, 0.7, 0.9, NULL));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, NULL, 0.7, 0.9, &some, &peak));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, NULL, &peak));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, &some, NULL));
  REFUSED(pendres_resonance_find(f->ctx, &good, 0.9, 0.7, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, -0.9, 0.7, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, NAN, 0.7, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, 0.7, INFINITY, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, 0.7, NAN, &peak));
  REFUSED(pendres_phase_line(f->ctx, 1, NULL, &line, &point, &all));
  REFUSED(pendres_phase_line(f->ctx, 1, &good, NULL, &point, &all));
  REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, NULL, &all));
  REFUSED(pendres_phase_line_complete(f->ctx, 1, NULL, NULL, &point, f->branches));
  REFUSED(pendres_phase_line_complete(f->ctx, 1, NULL, &line, NULL, f->branches));
  REFUSED(pendres_phase_line_complete(f->ctx, 1, NULL, &line, &point, NULL));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    line.spacing = bad_numbers[i];
    if (!(bad_numbers[i] > 0.0)) REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, &point, &all));
  }
  line.spacing = 0.0;
  for (int k = -1; k <= PENDRES_PARAMETER_COUNT; k++) {
    line.parameter = (pendres_parameter)k;
    if (k < 0 || k >= PENDRES_FORCE_COEFFICIENT_1)
      REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, &point, &all));
  }
  line.parameter = PENDRES_DRIVE_FREQUENCY;
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_response_compute(f->ctx, 1, &good, &bad[i], &r));
    REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, &bad[i], &peak));
    line.ensemble = bad[i];
    REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, &point, &all));
  }
  line.ensemble = some;
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    REFUSED(pendres_response_compute(f->ctx, 1, &bad_pendulums[i], &some, &r));
    REFUSED(pendres_phase_line(f->ctx, 1, &bad_pendulums[i], &line, &point, &all));
    if (i < 5 || (i >= 9 && i < 13)) /* the drive frequency is not read */
      REFUSED(pendres_resonance_find(f->ctx, &bad_pendulums[i], 0.7, 0.9, &peak));
  }
  assert_null(all);
  assert_int_equal(f->wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(strobes),  cmocka_unit_test(settling),   cmocka_unit_test(orbits),
    cmocka_unit_test(basins),   cmocka_unit_test(boundaries), cmocka_unit_test(branches),
    cmocka_unit_test(curves),   cmocka_unit_test(ensembles),  cmocka_unit_test(hysteresis),
    cmocka_unit_test(exponents), cmocka_unit_test(cascades),
  };
  return cmocka_run_group_tests_name("arguments", tests, make, clear);
}
