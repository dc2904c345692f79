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
  };
  return cmocka_run_group_tests_name("switching_small", tests, NULL, NULL);
}
