/*
 * test_switching_small.c -- transitions where trapping ellipses are far smaller than noise: beside
 * an independent simulation, and beside where trajectories end.
 */
#include "switching_fixture.h"

#include <stdlib.h>
#include <string.h>

/* A Duffing resonance of a quality of a hundred: its trapping ellipses are a tenth of the noise. */
static pendres_pendulum resonator(double temperature)
{
  return (pendres_pendulum){.damping = 0.01, .drive_amplitude = 0.0028656,
                            .drive_frequency = 1.021, .temperature = temperature,
                            .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {1.0, 0.0, 1.0}};
}

static void slope(const pendres_pendulum *p, double phase, const double s[2], double out[2])
{
  out[0] = s[1];
  out[1] = p->drive_amplitude * cos(phase) - s[0] - s[0] * s[0] * s[0] - p->damping * s[1];
}

/* A step of the classical Runge-Kutta method between halves of the step's noise. Order two in what
   noise does, but not in the frequency, which must be right to a share of the damping. */
static void advance(const pendres_pendulum *p, double phase, double h, double s[2], uint64_t *seed)
{
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  const double kick = sqrt(p->damping * p->temperature * h);
  double k[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0};
  s[1] += kick * normal(seed);
  for (int stage = 0; stage < 4; stage++) {
    const double at[2] = {s[0] + part[stage] * h * k[0], s[1] + part[stage] * h * k[1]};
    slope(p, phase + part[stage] * h * p->drive_frequency, at, k);
    for (int j = 0; j < 2; j++) sum[j] += weight[stage] * k[j];
  }
  for (int j = 0; j < 2; j++) s[j] += h / 6.0 * sum[j];
  s[1] += kick * normal(seed);
}

/* Transitions of own trajectories that start on either state, between discs of one standard
   deviation, sqrt(T), around the two strobe points; rates and their relative errors. */
static void simulate(const pendres_pendulum *p, const pendres_attractors *set, double rate[2],
                     double error[2])
{
  enum { RUNS = 64, PERIODS = 6000, STEPS = 32 };
  const double h = 2.0 * PI / p->drive_frequency / STEPS;
  double time[2] = {0.0}, events[2] = {0.0};
  uint64_t seed = 88172645463325252u;
  for (int i = 0; i < RUNS; i++) {
    int at = i % 2;
    const pendres_orbit *start = &pendres_attractors_get(set, (size_t)at)->orbit;
    double s[2] = {start->x, start->v};
    for (int k = 0; k < PERIODS; k++) {
      for (int step = 0; step < STEPS; step++)
        advance(p, 2.0 * PI * step / STEPS, h, s, &seed);
      const pendres_orbit *other = &pendres_attractors_get(set, (size_t)(1 - at))->orbit;
      time[at] += STEPS * h;
      if (hypot(s[0] - other->x, s[1] - other->v) > sqrt(p->temperature)) continue;
      events[at] += 1.0;
      at = 1 - at;
    }
  }
  for (int s = 0; s < 2; s++) {
    rate[s] = events[s] / time[s];
    error[s] = 1.0 / sqrt(events[s]);
  }
}

/* Discs are found late as well, by some tenth of the time on the state that is left sooner. */
static void rates_are_those_of_a_simulation(void **state)
{
  const pendres_pendulum p = resonator(1.3e-3);
  pendres_attractors *set = attractors(p);
  pendres_context *ctx = make(1, 24, 192);
  pendres_switching_tally tally;
  double own[2], share[2];
  (void)state;
  assert_int_equal(pendres_attractors_count(set), 2);
  simulate(&p, set, own, share);
  const pendres_switching_request q = {.pendulum = p, .set = set, .trajectories = 192,
                                       .periods = 10000};
  check_ok(pendres_switching_count(ctx, &q, &tally));
  for (size_t s = 0; s < 2; s++) {
    pendres_switching_rate r;
    check_ok(pendres_switching_rate_of(&tally, s, 1 - s, 0.95, &r));
    assert_true(r.events > 100.0 && r.error < 0.2 * r.value);
    check_near(r.value, own[s], sigmas * hypot(r.error, share[s] * own[s]) + 0.1 * own[s]);
  }
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

/* The averaged equations of a weakly damped Duffing oscillator, x = Re(a exp(i omega t)). */
static void drift(const pendres_pendulum *p, const double a[2], double out[2])
{
  const double w = p->drive_frequency;
  const double turn = (1.0 - w * w + 0.75 * (a[0] * a[0] + a[1] * a[1])) / (2.0 * w);
  out[0] = -0.5 * p->damping * a[0] - turn * a[1];
  out[1] = -0.5 * p->damping * a[1] + turn * a[0] - p->drive_amplitude / (2.0 * w);
}

/* How often the state at `from` is left for the one at `to`, each time from its point again; Heun's
   method, of which 50 steps are a relaxation. Terms that are left out are a 1e-4 of the damping. */
static double averaged_rate(const pendres_pendulum *p, const double from[2], const double to[2],
                            double time, double *events)
{
  const double h = 0.02 / (0.5 * p->damping), apart = hypot(from[0] - to[0], from[1] - to[1]);
  const double kick = sqrt(p->damping * p->temperature * h) / p->drive_frequency;
  double a[2] = {from[0], from[1]};
  uint64_t seed = 1234567u;
  *events = 0.0;
  for (double t = 0.0; t < time; t += h) {
    double d[2], e[2], b[2], noise[2];
    drift(p, a, d);
    for (int i = 0; i < 2; i++) {
      noise[i] = kick * normal(&seed);
      b[i] = a[i] + h * d[i] + noise[i];
    }
    drift(p, b, e);
    for (int i = 0; i < 2; i++) a[i] += 0.5 * h * (d[i] + e[i]) + noise[i];
    if (hypot(a[0] - to[0], a[1] - to[1]) > 0.25 * apart) continue;
    ++*events;
    a[0] = from[0];
    a[1] = from[1];
  }
  return *events / time;
}

/*
 * A quality of 5000: steps are chosen at once, by linear theory, and the rate of leaving LA is that
 * of the averaged equations. At a temperature that is 1e5 times lower both basins are too deep. The
 * strobe points are those of the averaged equations but for a 1e-3 of the amplitude.
 */
static void quality_of_5000(void **state)
{
  const pendres_pendulum p = {.damping = 2e-4, .drive_amplitude = 7e-6, .temperature = 1e-5,
                              .drive_frequency = 1.000375, .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {1.0, 0.0, 1.0}};
  pendres_attractors *set = attractors(p);
  pendres_context *ctx = make(1, 0, 192);
  pendres_switching_survey q = {.set = set, .state = {0, 1}, .trajectories = 2, .periods = 1};
  pendres_switching_tally tally;
  pendres_switching_rate r;
  double point[2][2], events, depth;
  int steps;
  (void)state;
  assert_int_equal(pendres_attractors_count(set), 2);
  check_ok(pendres_switching_choose_steps(ctx, &q, 1, &steps));
  assert_true(steps >= 20 && steps <= 60);
  for (size_t s = 0; s < 2; s++) {
    const pendres_orbit *o = &pendres_attractors_get(set, s)->orbit;
    point[s][0] = o->x;
    point[s][1] = -o->v / p.drive_frequency;
    check_ok(pendres_switching_depth(ctx, set, s, &depth));
    /* LA: three times the energy of 1.95(54)e-5 that rates at four temperatures gave. */
    assert_true(s == 0 ? depth > 1e-4 : depth > 2e-5 && depth < 8e-5);
  }
  const pendres_switching_request counted = {.pendulum = p, .set = set, .from = 1,
                                             .trajectories = 192, .periods = 30000,
                                             .steps_per_period = steps};
  check_ok(pendres_switching_count(ctx, &counted, &tally));
  check_ok(pendres_switching_rate_of(&tally, 1, 0, 0.95, &r));
  const double own = averaged_rate(&p, point[1], point[0], 3e8, &events);
  assert_true(r.events > 20.0 && events > 200.0);
  check_near(r.value, own, sigmas * hypot(r.error, own / sqrt(events)));
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

/*
 * The barrier of the large-amplitude state is below two temperatures: neither way has an activation
 * energy, and both say so. Rates imply in which basins trajectories end; where they do not, as when
 * half of those counted on one state are on the other, both ways say that.
 */
static void both_ways_are_judged(void **state)
{
  enum { TEMPERATURES = 2 };
  static const double t[TEMPERATURES] = {1e-3, 1.3e-3};
  pendres_switching_rates rates[TEMPERATURES];
  pendres_switching_activation energy[PENDRES_SWITCHING_WAYS];
  pendres_context *ctx = make(3, 24, 192);
  pendres_attractors *set = attractors(resonator(0.0));
  pendres_switching_survey q = {.set = set, .state = {0, 1}, .trajectories = 192,
                                .periods = 4000, .steps_per_period = 24};
  (void)state;
  check_ok(pendres_switching_find(ctx, &q, TEMPERATURES, t, rates, energy));
  for (int i = 0; i < TEMPERATURES; i++)
    for (int s = 0; s < 2; s++) {
      const pendres_langevin_estimate a = rates[i].occupation[s], b = rates[i].implied[s];
      check_near(a.value, b.value, sigmas * hypot(a.error, b.error));
      assert_true(a.error < 0.05 && b.error < 0.1);
    }
  assert_int_equal(energy[PENDRES_SWITCHING_FORTH].verdict, PENDRES_SWITCHING_NO_BARRIER);
  assert_int_equal(energy[PENDRES_SWITCHING_BACK].verdict, PENDRES_SWITCHING_NO_BARRIER);

  /* Seven in eight stay below a barrier that is high, at all temperatures. */
  for (int i = 0; i < TEMPERATURES; i++)
    for (int k = 0; k < 2; k++) {
      const double value = exp(-0.02 / t[i]);
      rates[i].way[k] = (pendres_switching_rate){.events = 400.0, .value = value,
                                                 .error = 0.05 * value};
      rates[i].implied[k] = (pendres_langevin_estimate){0.5, 0.01};
      rates[i].occupation[k] = (pendres_langevin_estimate){k == 0 ? 0.125 : 0.875, 0.02};
    }
  for (int even = 0; even < 2; even++) {
    check_ok(pendres_switching_activate(&q, TEMPERATURES, rates, energy));
    for (int k = 0; k < 2; k++)
      assert_int_equal(energy[k].verdict,
                       even ? PENDRES_SWITCHING_UNCHECKED : PENDRES_SWITCHING_UNBALANCED);
    for (int k = 0; k < 2; k++)
      rates[0].occupation[k] = rates[1].occupation[k] = rates[0].implied[k];
  }
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rates_are_those_of_a_simulation), cmocka_unit_test(both_ways_are_judged),
    cmocka_unit_test(quality_of_5000),
  };
  return cmocka_run_group_tests_name("switching_small", tests, NULL, NULL);
}
