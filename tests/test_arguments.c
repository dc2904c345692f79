/*
 * test_arguments.c -- every public function that computes with a context, with every argument NULL,
 * NaN, infinite, huge, negative or out of its enum: refused with a sentence of its own, and nothing
 * is computed. tests/symbols_check.sh sees to it that no public function is left out; those without
 * a context are in test_arguments_plain.c.
 */
#include "arguments_fixture.h"

#include "analysis/phase_diagram/line.h"

static void strobes(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  double x = 1.0, v = 0.0, many[40];
  const pendres_state start = { x, v };
  const pendres_record to = { .x = many, .v = many };
  REFUSED(pendres_strobe_advance(f->ctx, 1, NULL, &x, &v, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, NULL, &v, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, NULL, 1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &v, -1, NULL));
  REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &v, LONG_MIN, NULL));
  REFUSED(pendres_strobe_record(f->ctx, NULL, &start, 1, 2, &to));
  REFUSED(pendres_strobe_record(f->ctx, &good, NULL, 1, 2, &to));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, 2, NULL));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, 2,
                                &(pendres_record){.x = NULL, .v = many}));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, 2,
                                &(pendres_record){.x = many, .v = NULL}));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, 2,
                                &(pendres_record){many, many, many, NULL}));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, -1, 2, &to));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, LONG_MAX, 2, &to));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, 0, &to));
  REFUSED(pendres_strobe_record(f->ctx, &good, &start, 1, INT_MAX, &to));
  pendres_recording r = { .samples = 0 };
  REFUSED(pendres_recording_advance(f->ctx, &r, 1, &to));
  REFUSED(pendres_recording_begin(f->ctx, NULL, &start, 1, 2, &r));
  REFUSED(pendres_recording_begin(f->ctx, &good, NULL, 1, 2, &r));
  REFUSED(pendres_recording_begin(f->ctx, &good, &start, 1, 2, NULL));
  REFUSED(pendres_recording_begin(f->ctx, &good, &(pendres_state){x, NAN}, 1, 2, &r));
  REFUSED(pendres_recording_begin(f->ctx, &good, &start, 1, 0, &r));
  check_ok(pendres_recording_begin(f->ctx, &good, &start, 1, 2, &r));
  REFUSED(pendres_recording_advance(f->ctx, NULL, 1, &to));
  REFUSED(pendres_recording_advance(f->ctx, &r, -1, &to));
  REFUSED(pendres_recording_advance(f->ctx, &r, 1, NULL));
  REFUSED(pendres_recording_advance(f->ctx, &r, 1, &(pendres_record){.x = NULL, .v = many}));
  REFUSED(pendres_recording_advance(f->ctx, &r, 1, &(pendres_record){.x = many, .v = NULL}));
  REFUSED(pendres_recording_advance(f->ctx, &r, 1, &(pendres_record){many, many, many, NULL}));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    REFUSED(pendres_strobe_advance(f->ctx, 1, &bad_pendulums[i], &x, &v, 1, NULL));
    REFUSED(pendres_strobe_record(f->ctx, &bad_pendulums[i], &start, 1, 2, &to));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    double b = bad_numbers[i];
    REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &b, &v, 1, NULL));
    REFUSED(pendres_strobe_advance(f->ctx, 1, &good, &x, &b, 1, NULL));
    REFUSED(pendres_strobe_record(f->ctx, &good, &(pendres_state){b, v}, 1, 2, &to));
    REFUSED(pendres_strobe_record(f->ctx, &good, &(pendres_state){x, b}, 1, 2, &to));
  }
  assert_true(x == 1.0 && v == 0.0);
  assert_int_equal(f->wrong, 0);
}

static void settling(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double x = 1.0, v = 0.0;
  pendres_settled out;
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
  pendres_state point;
  REFUSED(pendres_attractors_point_find(f->ctx, NULL, 0, &point));
  REFUSED(pendres_attractors_point_find(f->ctx, f->set, 0, NULL));
  REFUSED(pendres_attractors_point_find(f->ctx, f->set, SIZE_MAX, &point));
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
  REFUSED(pendres_orbit_find(f->ctx, 1, NULL, PENDRES_ORBIT_PLAIN, &out, &how));
  REFUSED(pendres_orbit_find(f->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, NULL, &how));
  REFUSED(pendres_orbit_find(f->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &out, NULL));
  REFUSED(pendres_orbit_find(f->ctx, 1, &guess, (pendres_orbit_want)7, &out, &how));
  for (size_t i = 0; i < f->bad; i++) {
    const pendres_orbit *o = &f->bad_orbits[i];
    const pendres_orbit_guess g = { o->pendulum, o->x, o->v, o->period, o->winding };
    REFUSED(pendres_orbit_find(f->ctx, 1, &g, PENDRES_ORBIT_PLAIN, &out, &how));
    REFUSED(pendres_orbit_sample(f->ctx, o, 8, x, v, NULL));
    REFUSED(pendres_orbit_sample(f->ctx, o, 8, x, v, x));
  }
  REFUSED(pendres_orbit_sample(f->ctx, NULL, 8, x, v, NULL));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, 0, x, v, NULL));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, -8, x, v, NULL));
  REFUSED(pendres_orbit_sample(f->ctx, &f->orbit, INT_MAX, x, v, NULL));
  const pendres_orbit_stretch whole = {0, 0, 1, 8};
  const pendres_orbit_stretch bad_stretches[] = {{0, -1, 1, 8}, {0, 0, -1, 8}, {0, 0, 1, 0},
                                                 {0, 0, 1, INT_MAX}, {0, LONG_MAX, 1, 8},
                                                 {0, 0, LONG_MAX, 8}, {LONG_MIN, 0, 1, 8}};
  const pendres_record plain = {x, v, NULL, NULL}, none = {NULL, v, NULL, NULL},
                       half = {x, v, x, NULL};
  for (size_t i = 0; i < COUNT(bad_stretches); i++)
    REFUSED(pendres_orbit_record(f->ctx, &f->orbit, &bad_stretches[i], &plain));
  for (size_t i = 0; i < f->bad; i++)
    REFUSED(pendres_orbit_record(f->ctx, &f->bad_orbits[i], &whole, &plain));
  REFUSED(pendres_orbit_record(f->ctx, NULL, &whole, &plain));
  REFUSED(pendres_orbit_record(f->ctx, &f->orbit, NULL, &plain));
  REFUSED(pendres_orbit_record(f->ctx, &f->orbit, &whole, NULL));
  REFUSED(pendres_orbit_record(f->ctx, &f->orbit, &whole, &none));
  REFUSED(pendres_orbit_record(f->ctx, &f->orbit, &whole, &half));
  const double amplitudes[] = { NAN, INFINITY, -1.0, 0.0, 3.2, DBL_MAX };
  double one = 1.0, error;
  for (size_t i = 0; i < COUNT(amplitudes); i++)
    REFUSED(pendres_free_find(f->ctx, 1, &amplitudes[i], &one, &error));
  REFUSED(pendres_free_find(f->ctx, 1, NULL, &one, &error));
  REFUSED(pendres_free_find(f->ctx, 1, &one, NULL, &error));
  REFUSED(pendres_free_find(f->ctx, 1, &one, &one, NULL));
  pendres_free_oscillation swing;
  pendres_status outcome;
  const pendres_pendulum any = {.damping = 0.0};
  REFUSED(pendres_free_oscillation_find(f->ctx, 1, NULL, &one, &swing, &outcome));
  REFUSED(pendres_free_oscillation_find(f->ctx, 1, &any, NULL, &swing, &outcome));
  REFUSED(pendres_free_oscillation_find(f->ctx, 1, &any, &one, NULL, &outcome));
  REFUSED(pendres_free_oscillation_find(f->ctx, 1, &any, &one, &swing, NULL));
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
  const pendres_basin_sample sample = { 9, 1, 1, distance };
  pendres_basin_grid bad[] = {
    { .nx = 0, .nv = 2, .x = x, .v = v }, { .nx = 2, .nv = 0, .x = x, .v = v },
    { .nx = 2, .nv = 2, .v = v }, { .nx = 2, .nv = 2, .x = x }, { .nx = 1, .nv = 1 } };
  REFUSED(pendres_basin_attractors(f->ctx, NULL, &grid, &out));
  REFUSED(pendres_basin_attractors(f->ctx, &good, NULL, &out));
  REFUSED(pendres_basin_attractors(f->ctx, &good, &grid, NULL));
  REFUSED(pendres_basin_rows(f->ctx, NULL, &grid, 0, 1, s));
  REFUSED(pendres_basin_rows(f->ctx, f->set, NULL, 0, 1, s));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 0, 1, NULL));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 2, 1, s));
  REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 1, SIZE_MAX, s));
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
  REFUSED(pendres_basin_find(f->ctx, NULL, &grid, s));
  REFUSED(pendres_basin_find(f->ctx, f->set, NULL, s));
  REFUSED(pendres_basin_find(f->ctx, f->set, &grid, NULL));
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_basin_attractors(f->ctx, &good, &bad[i], &out));
    REFUSED(pendres_basin_rows(f->ctx, f->set, &bad[i], 0, 1, s));
    REFUSED(pendres_basin_states(f->ctx, f->set, &bad[i], 1, &index, s));
    REFUSED(pendres_basin_extend(f->ctx, f->set, &bad[i], 1, &index, &grown));
    REFUSED(pendres_basin_find(f->ctx, f->set, &bad[i], s));
  }
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    REFUSED(pendres_basin_attractors(f->ctx, &bad_pendulums[i], &grid, &out));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    x[1] = bad_numbers[i], v[1] = i % 2 ? bad_numbers[i] : 0.5;
    index = 3;
    REFUSED(pendres_basin_attractors(f->ctx, &good, &grid, &out));
    REFUSED(pendres_basin_rows(f->ctx, f->set, &grid, 0, 2, s));
    REFUSED(pendres_basin_states(f->ctx, f->set, &grid, 1, &index, s));
    REFUSED(pendres_basin_extend(f->ctx, f->set, &grid, 1, &index, &grown));
    REFUSED(pendres_basin_find(f->ctx, f->set, &grid, s));
    pendres_basin_window w = window;
    w.x_high = bad_numbers[i];
    REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &w, &sample, &statistics));
    REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window,
                                      &(pendres_basin_sample){9, 1, 1, &bad_numbers[i]},
                                      &statistics));
  }
  pendres_basin_window no_end = window;
  no_end.by = (pendres_basin_end)7;
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &no_end,
                                    &(pendres_basin_sample){16, 1, 3, three}, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, NULL, &window, &sample, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, NULL, &sample, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window,
                                    &(pendres_basin_sample){0, 1, 1, distance}, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window,
                                    &(pendres_basin_sample){9, 1, 0, distance}, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window,
                                    &(pendres_basin_sample){9, 1, 999, distance}, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, &(pendres_basin_sample){9, 1, 1, NULL},
                                    &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, NULL, &statistics));
  REFUSED(pendres_basin_uncertainty(f->ctx, f->set, &window, &sample, NULL));
  REFUSED(pendres_basin_statistics_refine(f->ctx, NULL, &grid, &statistics, &index));
  REFUSED(pendres_basin_statistics_refine(f->ctx, f->set, NULL, &statistics, &index));
  REFUSED(pendres_basin_statistics_refine(f->ctx, f->set, &grid, NULL, &index));
  REFUSED(pendres_basin_statistics_refine(f->ctx, f->set, &grid, &statistics, NULL));
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
  pendres_resonance_turn turn;
  pendres_resonance_search search = {.pendulum = good, .lowest = 0.7, .highest = 0.9};
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
  REFUSED(pendres_response_find(f->ctx, 1, NULL, &some, &r));
  REFUSED(pendres_response_find(f->ctx, 1, &good, NULL, &r));
  REFUSED(pendres_response_find(f->ctx, 1, &good, &some, NULL));
  REFUSED(pendres_response_label(f->ctx, 1, NULL));
  REFUSED(pendres_resonance_find(f->ctx, NULL, 0.7, 0.9, &peak));
  REFUSED(pendres_resonance_find(f->ctx, &good, 0.7, 0.9, NULL));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, NULL, 0.7, 0.9, &some, &peak));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, NULL, &peak));
  REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, &some, NULL));
  REFUSED(pendres_resonance_find_many(f->ctx, 1, NULL, &some));
  REFUSED(pendres_resonance_find_many(f->ctx, 1, &search, NULL));
  REFUSED(pendres_resonance_turn_find(f->ctx, NULL, 0.7, 0.9, &some, &turn));
  REFUSED(pendres_resonance_turn_find(f->ctx, &good, 0.7, 0.9, NULL, &turn));
  REFUSED(pendres_resonance_turn_find(f->ctx, &good, 0.7, 0.9, &some, NULL));
  REFUSED(pendres_resonance_turn_find(f->ctx, &good, 0.7, NAN, &some, &turn));
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
    if (k < 0 || (k >= PENDRES_A1 && k != PENDRES_QUADRATIC_DAMPING && k != PENDRES_CUBIC_DAMPING))
      REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, &point, &all));
  }
  line.parameter = PENDRES_DRIVE_FREQUENCY;
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_response_find(f->ctx, 1, &good, &bad[i], &r));
    REFUSED(pendres_resonance_find_ensemble(f->ctx, &good, 0.7, 0.9, &bad[i], &peak));
    line.ensemble = bad[i];
    REFUSED(pendres_phase_line(f->ctx, 1, &good, &line, &point, &all));
  }
  line.ensemble = some;
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    REFUSED(pendres_response_find(f->ctx, 1, &bad_pendulums[i], &some, &r));
    REFUSED(pendres_phase_line(f->ctx, 1, &bad_pendulums[i], &line, &point, &all));
    if (i < 5 || (i >= 9 && i != 13)) /* the drive frequency is not read */
    {
      REFUSED(pendres_resonance_find(f->ctx, &bad_pendulums[i], 0.7, 0.9, &peak));
      REFUSED(pendres_resonance_turn_find(f->ctx, &bad_pendulums[i], 0.7, 0.9, &some, &turn));
    }
    r = (pendres_response){ .pendulum = bad_pendulums[i] };
    point = (pendres_phase_point){ .pendulum = bad_pendulums[i] };
    if (pendres_pendulum_check(&bad_pendulums[i], NULL) == PENDRES_OK) continue; /* but huge */
    REFUSED(pendres_response_label(f->ctx, 1, &r));
    r = (pendres_response){ .pendulum = good, .states = SIZE_MAX };
    REFUSED(pendres_response_label(f->ctx, 1, &r));
    REFUSED(pendres_phase_line_complete(f->ctx, 1, NULL, &line, &point, f->branches));
  }
  assert_null(all);
  assert_int_equal(f->wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(strobes),
    cmocka_unit_test(settling),
    cmocka_unit_test(orbits),
    cmocka_unit_test(basins),
    cmocka_unit_test(boundaries),
    cmocka_unit_test(ensembles),
  };
  return cmocka_run_group_tests_name("arguments", tests, make, clear);
}
