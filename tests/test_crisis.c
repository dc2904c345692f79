/*
 * test_crisis.c -- where chaos ends: in a crisis, where doublings accumulate, or where an orbit is
 * born.
 *
 * What is true of the crisis is told by pendulums that a plain Runge-Kutta integration of order
 * four follows, in code of its own: before it none of them leaves the chaos, beyond it all of them
 * do. The place where doublings accumulate is that of the same cascade, followed from its other
 * end; a fold is where the reference's orbits, in extended precision, end.
 */
#include <stdlib.h>

#include <pendres/cascade.h>
#include <pendres/hysteresis.h>
#include "oracle/reference.h"

#include "context_fixture.h"

enum { STEPS = 160, PENDULUMS = 16, PERIODS = 4000 };

/* x'' + damping x' + x - x^2 = drive cos(frequency t) */
typedef struct plain {
  double damping, drive, frequency;
} plain;

static double slope(const plain *p, double t, double x, double v)
{
  return p->drive * cos(p->frequency * t) - p->damping * v - x + x * x;
}

static void one_period(const plain *p, double *x, double *v)
{
  const double h = 2.0 * 3.14159265358979323846 / p->frequency / STEPS;
  for (int i = 0; i < STEPS && fabs(*x) < 100.0; i++) {
    const double t = i * h;
    const double a = *v, b = slope(p, t, *x, *v);
    const double c = *v + 0.5 * h * b, d = slope(p, t + 0.5 * h, *x + 0.5 * h * a, c);
    const double e = *v + 0.5 * h * d, f = slope(p, t + 0.5 * h, *x + 0.5 * h * c, e);
    const double g = *v + h * f, k = slope(p, t + h, *x + h * e, g);
    *x += h / 6.0 * (a + 2.0 * c + 2.0 * e + g);
    *v += h / 6.0 * (b + 2.0 * d + 2.0 * f + k);
  }
}

/* How many pendulums have left at some time: those farther than `far` away. They start from a
   trajectory at parameters at which chaos lasts. */
static int leave(const plain *chaos, const plain *p, double x, double v, double far)
{
  int left = 0;
  for (int i = 0; i < PENDULUMS; i++) {
    for (int k = 0; k < 37; k++) one_period(chaos, &x, &v);
    double y = x, w = v;
    int away = 0;
    for (int k = 0; k < PERIODS && !away; k++) {
      one_period(p, &y, &w);
      away = fabs(y) > far;
    }
    left += away;
  }
  return left;
}

/* Chaos in the well of x'' + 0.1 x' + x - x^2 = F cos 0.85 t, born in a cascade of doublings, ends
   before F = 0.1095: pendulums escape to infinity. */
static void chaos_ends_and_pendulums_escape(void **state)
{
  enum { N = 8 };
  const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 0.85,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {1.0, -1.0}};
  double value[N];
  pendres_hysteresis *h = NULL;
  for (int i = 0; i < N; i++) value[i] = i < 4 ? 0.06 + 0.0156 * i : 0.1069 + 0.0004 * i;
  check_ok(pendres_hysteresis_find(*state, &p, &(pendres_state){0.1, 0.0},
                                   &(pendres_hysteresis_path){PENDRES_DRIVE_AMPLITUDE, N, value},
                                   &h));
  assert_true(pendres_hysteresis_jump_count(h) > 0);
  const pendres_jump *j = pendres_hysteresis_jump_get(h, pendres_hysteresis_jump_count(h) - 1);
  assert_int_equal(j->kind, PENDRES_JUMP_CRISIS);
  assert_int_equal(j->from, PENDRES_LABEL_CHAOTIC);
  assert_int_equal(j->to, PENDRES_LABEL_ESCAPE);
  assert_true(j->value_error < 1e-5);
  /* The step of the path, and the end of it, are what the jump says. */
  for (size_t i = 0; i < N; i++) {
    const pendres_attractor *a = &pendres_hysteresis_get(h, i)->attractor;
    assert_int_equal(a->label == PENDRES_LABEL_ESCAPE, value[i] > j->value);
  }
  const plain chaos = {0.1, 0.1087, 0.85};
  plain before = chaos, beyond = chaos;
  double x = 0.0, v = 0.0;
  for (int i = 0; i < 2000; i++) {
    plain slow = chaos;
    slow.drive *= (double)i / 2000.0;
    one_period(&slow, &x, &v);
  }
  before.drive = j->value - j->value_error;
  beyond.drive = j->value + 2e-5; /* closer to the crisis lives become as long as PERIODS */
  assert_int_equal(leave(&chaos, &before, x, v, 3.0), 0);
  assert_int_equal(leave(&chaos, &beyond, x, v, 3.0), PENDULUMS);
  pendres_hysteresis_free(h);
}

static const pendres_pendulum rocking = {.damping = 0.088115518405680743,
                                         .drive_amplitude = 0.97236988314086892};

static pendres_hysteresis *from_to(pendres_context *ctx, double from, double to)
{
  const double value[] = {from, to};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(ctx, &rocking, &(pendres_state){-0.8, -0.2},
                                   &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, 2, value},
                                   &h));
  assert_int_equal(pendres_hysteresis_get(h, 0)->attractor.label, PENDRES_LABEL_CHAOTIC);
  return h;
}

/* Upwards chaos ends in a cascade, which is gone through backwards. */
static void chaos_ends_where_doublings_accumulate(void **state)
{
  pendres_cascade c;
  pendres_hysteresis *h = from_to(*state, 0.7875, 0.83);
  const pendres_orbit *o = &pendres_hysteresis_get(h, 1)->attractor.orbit;
  check_ok(pendres_cascade_find(*state, o, PENDRES_DRIVE_FREQUENCY, 0.7875, &c));
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  assert_true(j->kind == PENDRES_JUMP_FLIP && j->from == PENDRES_LABEL_CHAOTIC && j->certain);
  assert_true(j->to_period == 64 && j->value_error < 1e-8);
  check_near(j->value, c.limit, j->value_error + c.limit_error);
  /* From 64 periods to one. */
  assert_int_equal(pendres_hysteresis_jump_count(h), 7);
  for (size_t k = 1; k < 7; k++) {
    j = pendres_hysteresis_jump_get(h, k);
    assert_true(j->kind == PENDRES_JUMP_FLIP && j->gradual);
    assert_int_equal(j->to_period, 64 >> k);
    check_near(j->value, c.value[6 - k], j->value_error + c.value_error[6 - k]);
  }
  pendres_hysteresis_free(h);
}

/* Downwards it ends in a window, in which orbits of three periods have doubled when they are seen:
   the fold of these is the end, and the doubling comes after it. */
static void chaos_ends_in_a_window(void **state)
{
  reference_cycle cycle;
  pendres_hysteresis *h = from_to(*state, 0.643, 0.6423);
  const pendres_orbit *o = &pendres_hysteresis_get(h, 1)->attractor.orbit;
  assert_int_equal(pendres_hysteresis_jump_count(h), 2);
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  assert_true(j->kind == PENDRES_JUMP_FOLD && j->to_period == 3 && j->value_error < 1e-9);
  assert_int_equal(pendres_hysteresis_jump_get(h, 1)->kind, PENDRES_JUMP_FLIP);
  /* The reference's orbit is there until the fold, and not behind it. */
  pendres_pendulum p = o->pendulum;
  long double y = o->x - 1.57079632679489661923L, v = o->v;
  for (int k = 0; k <= 40; k++) {
    p.drive_frequency = j->value + (o->pendulum.drive_frequency - j->value) *
                                     (k < 40 ? pow(0.6, k) : 0.0) - 1e-9;
    check_ok(reference_orbit(&p, y, v, 3, o->winding * 3 / o->period, &cycle));
    y = cycle.y;
    v = cycle.v;
  }
  p.drive_frequency = j->value + 1e-9;
  const pendres_status beyond =
    reference_orbit(&p, y, v, 3, o->winding * 3 / o->period, &cycle);
  assert_true(beyond != PENDRES_OK || fabs((double)(cycle.y - y)) > 0.01);
  pendres_hysteresis_free(h);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(chaos_ends_and_pendulums_escape),
    cmocka_unit_test(chaos_ends_where_doublings_accumulate),
    cmocka_unit_test(chaos_ends_in_a_window),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
