/*
 * test_chaos.c -- chaos that lasts and chaos that ends: verdicts, exponents and means over time
 * beside a classical Runge-Kutta method that shares nothing with the library.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>

#include "settling/chaos.h"
#include "settling/recurrence.h"
#include "states_fixture.h"

enum { SIDE = 8, STATES = SIDE * SIDE };

/* A grid of starts, and what became of them. */
typedef struct grid {
  pendres_settled outcome[STATES];
  pendres_attractors *set;
  double pendulum_periods; /* that it took */
} grid;

static void settle_grid(const pendres_pendulum *p, double tolerance, grid *g)
{
  const pendres_options options = {.tolerance = tolerance};
  pendres_context *ctx = NULL;
  pendres_pendulum pendulums[STATES];
  double x[STATES], v[STATES];
  pendres_cost cost;
  for (int i = 0; i < STATES; i++) {
    pendulums[i] = *p;
    x[i] = -1.5 + 6.0 * (i / SIDE) / (SIDE - 1.0);
    v[i] = -2.0 + 4.0 * (i % SIDE) / (SIDE - 1.0);
  }
  check_ok(pendres_context_create(&options, &ctx));
  check_ok(pendres_settle(ctx, STATES, pendulums, x, v, g->outcome, &g->set));
  pendres_context_cost(ctx, &cost);
  g->pendulum_periods = cost.pendulum_periods;
  pendres_context_free(ctx);
}

static int members_of(const grid *g, int attractor)
{
  int n = 0;
  for (int i = 0; i < STATES; i++) n += g->outcome[i].attractor == attractor;
  return n;
}

/* ---- chaos that ends ---- */

/*
 * Two running orbits, which half of the states have reached after 450 periods, and all after 3200.
 * Their multipliers are known to six digits from two independent codes.
 */
static void transient_to_running(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.121, .drive_amplitude = 1.151, .drive_frequency = 0.6975};
  static const double tolerances[] = {1e-8, 1e-6};
  (void)state;
  for (int k = 0; k < 2; k++) {
    grid g;
    settle_grid(&p, tolerances[k], &g);
    assert_int_equal(pendres_attractors_count(g.set), 2);
    assert_int_equal(members_of(&g, -1), 0);
    for (size_t i = 0; i < 2; i++) {
      const pendres_attractor *a = pendres_attractors_get(g.set, i);
      assert_int_equal(a->label, PENDRES_LABEL_RUNNING);
      assert_int_equal(a->orbit.period, 2);
      assert_int_equal(abs(a->orbit.winding), 2);
      assert_true(members_of(&g, (int)i) > 10);
      check_near(a->orbit.multiplier_re[0], -0.829237, 5e-7 + 10.0 * a->orbit.multiplier_error);
      check_near(a->orbit.multiplier_re[1], -0.136324, 5e-7 + 10.0 * a->orbit.multiplier_error);
      assert_true(isnan(a->watched_periods) && isnan(a->escape_rate_bound) && isnan(a->drift));
    }
    pendres_attractors_free(g.set);
  }
}

/*
 * Of the states 30 are on an orbit of period 3 after 3000 periods: chaos lasts 4700 on average.
 * Those that have not left it in the time that they get are unresolved, never chaotic.
 */
static void transient_to_period_3(void **state)
{
  const pendres_pendulum p = {.damping = 0.051334531384257996,
                              .drive_amplitude = 1.2289475620574137,
                              .drive_frequency = 0.8539762601884484};
  grid g;
  (void)state;
  settle_grid(&p, 1e-6, &g);
  assert_int_equal(pendres_attractors_count(g.set), 1);
  const pendres_attractor *a = pendres_attractors_get(g.set, 0);
  assert_int_equal(a->label, PENDRES_LABEL_PERIODIC);
  assert_int_equal(a->orbit.period, 3);
  assert_true(members_of(&g, -1) <= 3);
  pendres_attractors_free(g.set);
}

/* ---- weak damping ---- */

/*
 * Orbits of many periods attract few members each, one of them an orbit of 35 periods: whoever
 * looks for 32 at most gives it 37000 periods for nothing. With the same starts a long integration
 * comes back to within 1e-9 after 35 periods, and after no fewer.
 */
static void long_period(void **state)
{
  const pendres_pendulum p = {.damping = 0.001, .drive_amplitude = 0.2, .drive_frequency = 1.1};
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_settled outcome;
  (void)state;
  pendres_attractors *set = settle_one(&p, member_x(&e, 163), 0.0, &outcome);
  const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
  assert_int_equal(a->orbit.period, 35);
  assert_true(outcome.settling_periods < 10000);
  pendres_attractors_free(set);
}

/* ---- chaos that lasts ---- */

typedef struct average {
  double exponent, exponent_error, area, area_error, amplitude; /* errors: one standard error */
} average;

enum { TRAJECTORIES = 32, STEPS = 200, WARM_UP = 300 };

/* y, v, and a tangent vector, by one step of the classical method; returns the drive's work. */
static double step(const pendres_pendulum *p, int k, double z[4])
{
  const double h = 2.0 * pi / p->drive_frequency / STEPS;
  static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double slope[4] = {0.0}, sum[4] = {0.0}, work = 0.0;
  for (int i = 0; i < 4; i++) {
    const double f = p->drive_amplitude * cos(2.0 * pi * (k + at[i]) / STEPS);
    double now[4];
    for (int m = 0; m < 4; m++) now[m] = z[m] + at[i] * h * slope[m];
    slope[0] = now[1];
    slope[1] = f - sin(now[0]) - p->damping * now[1];
    slope[2] = now[3];
    slope[3] = -cos(now[0]) * now[2] - p->damping * now[3];
    for (int m = 0; m < 4; m++) sum[m] += weight[i] / 6.0 * h * slope[m];
    work += weight[i] / 6.0 * h * f * slope[0];
  }
  for (int m = 0; m < 4; m++) z[m] += sum[m];
  return work;
}

/* Trajectories side by side from x, v on, each for so many periods after a warm-up. */
static average independent(const pendres_pendulum *p, double x, double v, int periods)
{
  double exponent[2] = {0.0}, area[2] = {0.0}, amplitude = 0.0;
  for (int i = 0; i < TRAJECTORIES; i++) {
    double z[4] = {x + 1e-3 * i - 0.5 * pi, v, 0.6, 0.8}, growth = 0.0, work = 0.0;
    for (int n = -WARM_UP; n < periods; n++) {
      double low = z[0], high = z[0];
      if (n == 0) growth = work = 0.0;
      for (int k = 0; k < STEPS; k++) {
        work += step(p, k, z);
        low = fmin(low, z[0]);
        high = fmax(high, z[0]);
      }
      const double length = hypot(z[2], z[3]);
      growth += log(length);
      z[2] /= length;
      z[3] /= length;
      if (n >= 0) amplitude += 0.5 * (high - low) / periods / TRAJECTORIES;
    }
    growth *= p->drive_frequency / (2.0 * pi * periods);
    work /= periods;
    exponent[0] += growth / TRAJECTORIES;
    exponent[1] += growth * growth / TRAJECTORIES;
    area[0] += work / TRAJECTORIES;
    area[1] += work * work / TRAJECTORIES;
  }
  return (average){
    .exponent = exponent[0],
    .exponent_error = sqrt((exponent[1] - exponent[0] * exponent[0]) / (TRAJECTORIES - 1.0)),
    .area = area[0],
    .area_error = sqrt((area[1] - area[0] * area[0]) / (TRAJECTORIES - 1.0)),
    .amplitude = amplitude};
}

/* What every chaotic attractor must say of itself. */
static void check_chaotic(const pendres_attractor *a)
{
  const pendres_orbit *o = &a->orbit;
  assert_int_equal(a->label, PENDRES_LABEL_CHAOTIC);
  assert_true(a->lyapunov > 5.0 * a->lyapunov_error && a->lyapunov_error > 0.0);
  assert_true(a->watched_periods > 1e5);
  /* No event in n trials: at a rate of 3.00 / n, 95 of 100 would have seen one. */
  check_near(a->escape_rate_bound * a->watched_periods, 2.9957, 1e-4);
  /* Friction takes what the drive gives; both errors hold with a confidence of 99.9 %. */
  check_near(o->dissipation, o->loop_area, o->dissipation_error + o->loop_area_error);
  check_near(o->mean_power, o->loop_area * o->pendulum.drive_frequency / (2.0 * pi),
             1e-14 * fabs(o->loop_area));
  assert_true(o->loop_area_error > 0.0 && o->loop_area_error < 0.01 * o->loop_area);
  assert_true(o->amplitude_error > 0.0 && o->amplitude_error < 0.01 * o->amplitude);
  assert_true(isnan(o->x) && isnan(o->phase_lag) && isnan(o->cosine[0]) && isnan(a->trap_radius));
}

/*
 * Weak chaos, on which a suspect on its way to the attractor was once followed without end: now
 * 1.8e5 periods of one pendulum. Exponents within four standard errors of both together; Runge and
 * Kutta's own error, from half and twice the steps, is below one of them.
 */
static void weak_chaos(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.119, .drive_amplitude = 1.158, .drive_frequency = 0.6912};
  grid g;
  (void)state;
  settle_grid(&p, 1e-8, &g);
  assert_true(g.pendulum_periods < 5e5);
  assert_int_equal(pendres_attractors_count(g.set), 1);
  assert_int_equal(members_of(&g, 0), STATES);
  const pendres_attractor *a = pendres_attractors_get(g.set, 0);
  const average known = independent(&p, 0.1, 0.0, 600);
  check_chaotic(a);
  check_near(a->lyapunov, known.exponent, 4.0 * hypot(known.exponent_error, a->lyapunov_error));
  check_near(a->orbit.loop_area, known.area, 4.0 * known.area_error + a->orbit.loop_area_error);
  check_near(a->drift, 0.0, a->drift_error);
  pendres_attractors_free(g.set);
}

/*
 * Chaos that turns over twice a drive period, to one side or to the other: two attractors, each
 * other's mirror image, whose replicas were averaged once. Every start is on one of them.
 */
static void running_chaos(void **state)
{
  const pendres_pendulum p = {.damping = 0.06953460432691326,
                              .drive_amplitude = 1.42267898419396,
                              .drive_frequency = 0.6796381997340475};
  grid g;
  (void)state;
  settle_grid(&p, 1e-4, &g);
  assert_true(g.pendulum_periods < 1e6);
  assert_int_equal(pendres_attractors_count(g.set), 2);
  const pendres_attractor *a = pendres_attractors_get(g.set, 0);
  const pendres_attractor *b = pendres_attractors_get(g.set, 1);
  check_chaotic(a);
  check_chaotic(b);
  assert_true(members_of(&g, 0) > 10 && members_of(&g, 1) > 10 && members_of(&g, -1) == 0);
  check_near(fabs(a->drift), 2.0, a->drift_error);
  check_near(b->drift, -a->drift, a->drift_error + b->drift_error);
  check_near(b->lyapunov, a->lyapunov, 4.0 * hypot(a->lyapunov_error, b->lyapunov_error));
  check_near(b->orbit.loop_area, a->orbit.loop_area,
             a->orbit.loop_area_error + b->orbit.loop_area_error);
  /* A single standard error, 3.5 times smaller, is left for what replicas are coherent in. */
  check_near(b->orbit.amplitude, a->orbit.amplitude,
             2.0 * (a->orbit.amplitude_error + b->orbit.amplitude_error));
  pendres_attractors_free(g.set);
}

/* ---- responses ---- */

static pendres_response respond(const pendres_pendulum *p)
{
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_context *ctx = NULL;
  pendres_response r;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, 1, p, &e, &r));
  pendres_context_free(ctx);
  return r;
}

/*
 * 138 members on an orbit of period 3, 62 in chaos: the mean over all 200, not over those that are
 * on an orbit.
 */
static void partly_chaotic(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.4185, .drive_amplitude = 0.9934, .drive_frequency = 0.6827};
  const pendres_response r = respond(&p);
  (void)state;
  assert_int_equal(r.states, 2);
  assert_int_equal(r.state_members[0], 138);
  assert_int_equal(r.state_members[1], 62);
  check_chaotic(&r.state[1]);
  const average known = independent(&p, 0.0, 0.0, 300);
  const double orbit = r.state[0].orbit.loop_area;
  check_near(r.mean_loop_area, (138.0 * orbit + 62.0 * known.area) / 200.0,
             r.mean_loop_area_error + 4.0 * 0.31 * known.area_error);
  check_near(r.mean_loop_area, 4.014, 5e-4 + r.mean_loop_area_error);
  assert_true(r.mean_loop_area_error < 0.005);
  check_near(r.mean_power, r.mean_loop_area * p.drive_frequency / (2.0 * pi),
             1e-14 * r.mean_loop_area);
  check_near(r.mean_amplitude,
             (138.0 * r.state[0].orbit.amplitude + 62.0 * r.state[1].orbit.amplitude) / 200.0,
             1e-12);
  /* The loop is that of the members which have one. */
  check_near(r.mean_loop_amplitude, 0.854, 1e-3);
}

/* All members in chaos: means over time; no loop to speak of. */
static void all_chaotic(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.15, .drive_frequency = 2.0 / 3.0};
  const pendres_response r = respond(&p);
  const average known = independent(&p, 0.5, 0.0, 300);
  (void)state;
  assert_int_equal(r.states, 1);
  assert_int_equal(r.unresolved, 0);
  check_chaotic(&r.state[0]);
  check_near(r.mean_loop_area, known.area, r.mean_loop_area_error + 4.0 * known.area_error);
  check_near(r.mean_loop_area, r.state[0].orbit.loop_area, 0.0);
  /* Its standard error is not known: that of the area, relative, is about as large. */
  check_near(r.mean_amplitude, known.amplitude,
             r.mean_amplitude_error + 4.0 * known.area_error / known.area * known.amplitude);
  assert_true(isnan(r.mean_loop_amplitude) && isnan(r.phase_lag) && r.mean_power > 0.0);
}

/*
 * Chaos in five narrow bands, whose basin ends close by, and whose mirror image's bands lie beside
 * its own: a lane on the one passes through most cells of the other. By the Runge-Kutta method with
 * 400 steps a period, six starts within 5e-9 of this one are in these bands after 200,000 periods.
 */
static void narrow_bands(void **state)
{
  const pendres_pendulum p = {.damping = 0.095, .drive_amplitude = 0.2, .drive_frequency = 0.606};
  pendres_settled outcome;
  (void)state;
  pendres_attractors *set = settle_one(&p, -0.59690260418206076, 0.0, &outcome);
  assert_int_equal(outcome.label, PENDRES_LABEL_CHAOTIC);
  check_chaotic(pendres_attractors_get(set, (size_t)outcome.attractor));
  pendres_attractors_free(set);
}

/* ---- parts ---- */

/* States that no cell number can be made of are in no cell. */
static void cells(void **state)
{
  static const double wild[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 6e19};
  static pendres_cover cover = {.w_most = 2.0};
  (void)state;
  memset(cover.cell, 1, sizeof cover.cell);
  assert_true(pendres_cover_holds(&cover, 0.0, 0.0) && pendres_cover_holds(&cover, pi, -2.0));
  assert_true(pendres_cover_holds(&cover, -1e-17 - pi, 1.99));
  for (size_t i = 0; i < sizeof wild / sizeof wild[0]; i++) {
    assert_false(pendres_cover_holds(&cover, 0.0, wild[i]));
    if (!isfinite(wild[i])) assert_false(pendres_cover_holds(&cover, wild[i], 0.0));
  }
  cover.w_most = 0.0;
  assert_false(pendres_cover_holds(&cover, 0.0, 0.0));
}

/* The shortest period that points repeat themselves with, and the turns that they take. */
static void recurrences(void **state)
{
  enum { N = PENDRES_RECURRENCE_POINTS };
  const double turn = 2.0 * pi;
  double y[N], w[N], later_y[N], later_w[N];
  const pendres_recurrence all = {N, N, y, w}, one = {1, N, y, w};
  const pendres_recurrence wrapped = {N + 40, N, later_y, later_w}; /* the same ones */
  pendres_initial_guess r;
  (void)state;
  for (int k = 0; k < PENDRES_RECURRENCE_POINTS; k++) {
    y[k] = 0.3 * (k % 3) - 2.0 * pi * k + pow(0.5, k);
    w[k] = 0.5 * (k % 3);
  }
  for (int k = 0; k < N; k++) {
    later_y[(k + 40) % N] = y[k];
    later_w[(k + 40) % N] = w[k];
  }
  for (int way = 0; way < 2; way++) {
    assert_true(pendres_recurrence_find(way == 0 ? &all : &wrapped, turn, &r));
    assert_int_equal(r.period, 3);
    assert_int_equal(r.winding, -3);
    assert_true(r.y == y[N - 1] && r.w == w[N - 1]);
  }
  assert_false(pendres_recurrence_find(&one, turn, &r));
  /* Of a long period only what comes back very closely: here by 1e-3, not by 0.1. */
  for (int k = 0; k < PENDRES_RECURRENCE_POINTS; k++) {
    y[k] = 0.0;
    w[k] = k % 50 + 2e-5 * k;
  }
  assert_true(pendres_recurrence_find(&all, turn, &r));
  assert_int_equal(r.period, 50);
  for (int k = 0; k < PENDRES_RECURRENCE_POINTS; k++) w[k] = k % 50 + 2e-3 * k;
  assert_false(pendres_recurrence_find(&all, turn, &r));
  for (int k = 0; k < PENDRES_RECURRENCE_POINTS; k++) w[k] = k;
  assert_false(pendres_recurrence_find(&all, turn, &r));
  w[PENDRES_RECURRENCE_POINTS - 1] = NAN;
  assert_false(pendres_recurrence_find(&all, turn, &r));
}

/*
 * A torque and a parametric drive do work, too: what friction takes of that is no error of the loop
 * area. 64 replicas' areas scatter by less than the bound here, in which the torque's work alone,
 * 0.076 of 8.8 a drive cycle, was contained before.
 */
static void chaos_with_other_work(void **state)
{
  const pendres_pendulum p[] = {
    {.damping = 0.5, .drive_amplitude = 1.5, .drive_frequency = 0.667, .torque = 0.05},
    {.damping = 0.5, .drive_amplitude = 1.5, .drive_frequency = 0.667, .parametric_amplitude =
  0.1}}; pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-6}, &ctx));
  for (size_t k = 0; k < sizeof p / sizeof p[0]; k++) {
    pendres_attractors *set = NULL;
    check_ok(pendres_attractors_find(ctx, &p[k], 0, NULL, NULL, &set));
    assert_int_equal(pendres_attractors_count(set), 1);
    const pendres_attractor *a = pendres_attractors_get(set, 0);
    const pendres_orbit *o = &a->orbit;
    assert_int_equal(a->label, PENDRES_LABEL_CHAOTIC);
    assert_true(o->loop_area_error < 0.003 * o->loop_area);
    assert_true(o->dissipation_error < 0.003 * o->dissipation);
    if (k == 0)
      check_near(o->dissipation, o->loop_area + 2.0 * pi * p[k].torque * a->drift,
                 o->dissipation_error + o->loop_area_error);
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/*
 * Exponents past a cascade of doublings, as wanted to a part of them: the reference is the mean
 * growth under derivatives of the map, integrated to eighth order, over 64 pendulums and 1920
 * periods at least. Within four standard errors of both together; shorter averages take less work.
 */
static void exponents_as_wanted(void **state)
{
  static const struct {
    double drive, exponent, error;
  } known[] = {
    {1.083, 0.00938361, 4.3e-05},   {1.08375, 0.0193086, 7.1e-05}, {1.08475, 0.018954, 1.2e-4},
    {1.0855, 0.0277456, 1.5e-4},    {1.08625, 0.0369859, 8.2e-05}, {1.087, 0.0390482, 9.0e-05},
    {1.088, 0.0372762, 1.3e-4},     {1.08875, 0.0401453, 1.7e-4},  {1.0895, 0.0456395, 1.1e-4},
    {1.09, 0.0467801, 1.1e-4}};
  static const double wanted[] = {0.0, 0.01};
  double cost[2];
  (void)state;
  for (int w = 0; w < 2; w++) {
    const pendres_options options = {.tolerance = 1e-6, .exponent_error = wanted[w]};
    pendres_context *ctx = NULL;
    pendres_cost spent;
    check_ok(pendres_context_create(&options, &ctx));
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
      const pendres_pendulum p = {.damping = 0.5, .drive_frequency = 2.0 / 3.0,
                                  .drive_amplitude = known[k].drive};
      pendres_attractors *set = NULL;
      int chaotic = 0;
      check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
      for (size_t i = 0; i < pendres_attractors_count(set); i++) {
        const pendres_attractor *a = pendres_attractors_get(set, i);
        if (a->label != PENDRES_LABEL_CHAOTIC) continue;
        chaotic++;
        check_near(a->lyapunov, known[k].exponent,
                   4.0 * hypot(known[k].error, a->lyapunov_error));
        /* Those that are longest have what error they have. */
        if (w == 1 && a->watched_periods < 1e5)
          assert_true(a->lyapunov_error <= wanted[w] * a->lyapunov);
      }
      assert_true(chaotic > 0);
      pendres_attractors_free(set);
    }
    pendres_context_cost(ctx, &spent);
    cost[w] = spent.pendulum_periods;
    pendres_context_free(ctx);
  }
  assert_true(cost[1] < 0.6 * cost[0]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(transient_to_running), cmocka_unit_test(transient_to_period_3),
    cmocka_unit_test(long_period),          cmocka_unit_test(weak_chaos),
    cmocka_unit_test(running_chaos),
    cmocka_unit_test(partly_chaotic),       cmocka_unit_test(all_chaotic),
    cmocka_unit_test(narrow_bands),         cmocka_unit_test(chaos_with_other_work),
    cmocka_unit_test(exponents_as_wanted),
    cmocka_unit_test(cells),                cmocka_unit_test(recurrences),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
