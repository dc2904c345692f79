/* test_charts.c -- charts of the strobe map: lanes that they advance are where the integrator leads
   them, within the error that they carry; whatever was charted before; the labels that follow. */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

#include "base/instructions.h"
#include "engine/chart.h"
#include "engine/charts.h"
#include "engine/steps.h"
#include "model/model.h"
#include "basin_fixture.h"

enum { DRAWS = 40, STARTS = 4 };

static uint64_t seed;

static double between(double from, double to)
{
  return from + (to - from) * next_random(&seed);
}

/* A pendulum or a resonator with a cubic force that settles in some 300 to 11,000 periods, driven
   up to where its answer bends over. */
static pendres_pendulum drawn(int i)
{
  pendres_pendulum p = {.damping = 7e-4 * exp(-between(0.0, 3.0)),
                        .drive_frequency = between(0.7, 1.2)};
  p.drive_amplitude = p.damping * between(0.1, 3.0);
  if (i % 2 == 1) {
    p.force = PENDRES_FORCE_POLYNOMIAL;
    p.force_coefficients[0] = 1.0;
    p.force_coefficients[2] = 1.0;
  }
  return p;
}

static int reached(void *arg, size_t i, const pendres_strobe_lane *lane)
{
  (void)i;
  return lane->period >= *(const long *)arg;
}

/* Advance a lane by charts, over a time of settling or for as long as there are any. */
static void advance(pendres_context *ctx, pendres_charts *charts, pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = lane->pendulum;
  const double settling = p->drive_frequency / (pi * p->damping);
  int level = 0;
  while (level >= 0 && (double)lane->period < settling)
    check_ok(pendres_charts_advance(ctx, charts, pendres_charts_levels(charts) - 1, lane, &level));
}

static pendres_strobe_lane start_of(const pendres_pendulum *p)
{
  const double x = between(-1.0, 1.0), w = between(-1.0, 1.0);
  return pendres_strobe_lane_at(p, x, w * p->drive_frequency);
}

/*
 * Where charts lead to in a time of settling, beside the integrator, whose error there, 1e-13 a
 * period, is a thousandth of what charts may miss. The variance that a lane carries is that of
 * misses which add up for the whole of that time; they do not quite. It is 3e-6 of the distance
 * from rest, here of order one, and grows as orbits of different amplitudes run apart: a
 * thousandfold allows for that.
 */
static void test_errors_are_carried(void **state)
{
  pendres_context *ctx = *state;
  const double bottom = 0.0;
  int charted = 0;
  seed = 11;
  for (int i = 0; i < DRAWS; i++) {
    const pendres_pendulum p = drawn(i);
    pendres_charts *charts;
    assert_true(pendres_charts_worth(ctx, &p));
    check_ok(pendres_charts_of(ctx, &p, 1, &bottom, &charts));
    for (int k = 0; k < STARTS; k++) {
      pendres_strobe_lane lane = start_of(&p), exact = lane;
      advance(ctx, charts, &lane);
      if (lane.period == 0) continue;
      check_ok(pendres_steps_choose(ctx, &p, pendres_steps_speed(&p, 1.5, 1.0), 1e-13,
                                    &exact.steps));
      check_ok(pendres_strobe_run(ctx, 1, &exact, reached, &lane.period));
      const double carried = sqrt(lane.off.yy + lane.off.ww);
      check_near(hypot(lane.y - exact.y, lane.w - exact.w), 0.0, carried);
assert_true(carried < 3e-3);
      charted++;
    }
  }
  assert_true(charted > DRAWS);
}

/* What a chart is does not depend on where lanes came from that asked for it: other starts before,
   or none, give the same bytes. */
static void test_charts_do_not_depend_on_who_asks(void **state)
{
  pendres_context *fresh = context_with(NULL);
  const double bottom = 0.0;
  int moved = 0;
  seed = 5;
  for (int i = 0; i < 6; i++) {
    const pendres_pendulum p = drawn(i);
    pendres_strobe_lane lane[2 * STARTS];
    pendres_charts *charts;
    for (int k = 0; k < 2 * STARTS; k++) lane[k] = start_of(&p);
    check_ok(pendres_charts_of(*state, &p, 1, &bottom, &charts));
    pendres_strobe_lane *last = &lane[2 * STARTS - 1], again = *last;
    for (int k = 0; k < 2 * STARTS; k++) advance(*state, charts, &lane[k]);
    check_ok(pendres_charts_of(fresh, &p, 1, &bottom, &charts));
    advance(fresh, charts, &again);
    check_near(again.y, last->y, 0.0);
    check_near(again.w, last->w, 0.0);
    check_near(again.off.yy, last->off.yy, 0.0);
    assert_int_equal(again.period, last->period);
    moved += again.period > 0;
  }
  assert_true(moved > 0);
  pendres_context_free(fresh);
}

/* Each instruction set gives the same image and slopes of a place. */
static void test_same_bytes_on_every_instruction_set(void **state)
{
  const pendres_kernels_chart *list[3] = {&pendres_kernels_chart_base};
  const pendres_instructions here = pendres_instructions_here();
  size_t count = 1;
  (void)state;
  (void)here;
#if defined(__x86_64__)
  if (here >= PENDRES_INSTRUCTIONS_AVX2) list[count++] = &pendres_kernels_chart_avx2;
  if (here >= PENDRES_INSTRUCTIONS_AVX512) list[count++] = &pendres_kernels_chart_avx512;
#endif
  seed = 3;
  for (int i = 0; i < 100; i++) {
    pendres_chart map;
    for (int j = 0; j < PENDRES_CHART_TERMS; j++)
      for (int c = 0; c < 2; c++)
        for (int k = 0; k < PENDRES_CHART_TERMS; k++) map.term[j][c][k] = between(-1.0, 1.0);
    const double a = between(-1.0, 1.0), b = between(-1.0, 1.0);
    double first[2], slope[2][2];
    list[0]->at(&map, a, b, first, slope);
    for (size_t n = 1; n < count; n++) {
      double image[2], by[2][2];
      list[n]->at(&map, a, b, image, by);
      assert_memory_equal(image, first, sizeof first);
      assert_memory_equal(by, slope, sizeof slope);
    }
  }
}

/* Labels that are certain are those of pendulums which are integrated throughout: charts are not
   made where the caller sets the steps. 64 of tp8 err by less than 1e-9 a period at such speeds. */
static void test_labels_are_those_of_the_integrator(void **state)
{
  static const double damping[3] = { 7e-4, 4e-4, 2e-4 };
  pendres_options by_steps = *pendres_context_options(*state);
  by_steps.steps_per_period = 64;
  pendres_context *other = context_with(&by_steps);
  for (int i = 0; i < 3; i++) {
    const pendres_pendulum p = {.damping = damping[i], .drive_amplitude = 6.0 * damping[i],
                                .drive_frequency = 0.93};
    assert_true(pendres_charts_worth(*state, &p));
    assert_false(pendres_charts_worth(other, &p));
    portrait a, b;
    size_t both = 0, states[2] = { 0, 0 };
    compute(*state, &p, 12, 12, 1.5, &a);
    compute(other, &p, 12, 12, 1.5, &b);
    for (size_t k = 0; k < 144; k++) {
      if (a.state[k].how != PENDRES_BASIN_INTEGRATED) continue;
      if (b.state[k].how != PENDRES_BASIN_INTEGRATED) continue;
      assert_int_equal(a.state[k].label, b.state[k].label);
      both++;
      if (a.state[k].label == PENDRES_LABEL_SA || a.state[k].label == PENDRES_LABEL_LA)
        states[a.state[k].label == PENDRES_LABEL_LA]++;
    }
    assert_true(both > 50 && states[0] > 10 && states[1] > 10);
    release(&a);
    release(&b);
  }
  pendres_context_free(other);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(test_errors_are_carried, setup, teardown),
    cmocka_unit_test_setup_teardown(test_charts_do_not_depend_on_who_asks, setup, teardown),
    cmocka_unit_test(test_same_bytes_on_every_instruction_set),
    cmocka_unit_test_setup_teardown(test_labels_are_those_of_the_integrator, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
