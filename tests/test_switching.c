/*
 * test_switching.c -- transitions by noise: against Kramers' rate, plain counting, and known fits.
 */
#include "switching_fixture.h"

#include "noise/cores.h"
#include "noise/noise_common.h"

#include <stdlib.h>
#include <string.h>

/* Both states of Fig. 7's pendulum are about equally hard to leave at this drive period. */
static pendres_pendulum balanced(double temperature)
{
  return (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                             .drive_frequency = 2.0 * PI / 7.7, .temperature = temperature };
}

static double bessel_i0(double x)
{
  double sum = 1.0, term = 1.0;
  for (int k = 1; k < 60; k++) {
    term *= 0.25 * x * x / ((double)k * k);
    sum += term;
  }
  return sum;
}

/*
 * Without drive: escapes from a well at strong friction. Smoluchowski's equation for the potential
 * -cos y diffuses with D = T / (gamma I0(1/T)^2) (Lifson and Jackson, J. Chem. Phys. 36 (1962)
 * 2410), hopping between neighbouring wells at the rate 2 D / (2 pi)^2. Inertia multiplies it by
 * gamma (sqrt(gamma^2/4 + 1) - gamma/2) (Kramers 1940).
 */
static void wells_are_left_as_kramers_says(void **state)
{
  enum { N = 384 };
  static const double temperatures[3] = { 0.33, 0.4, 0.5 };
  const double g = 5.0, inertia = g * (sqrt(0.25 * g * g + 1.0) - 0.5 * g);
  (void)state;
  for (int i = 0; i < 3; i++) {
    const double T = temperatures[i], i0 = bessel_i0(1.0 / T);
    const pendres_pendulum p = { .damping = g, .drive_frequency = 1.0, .temperature = T };
    const double smoluchowski = 2.0 * T / (g * i0 * i0) / (4.0 * PI * PI);
    pendres_attractors *set = attractors(p);
    assert_int_equal(pendres_attractors_count(set), 1);
    const pendres_switching_request q = { .pendulum = p, .set = set, .trajectories = N,
                                          .periods = 600, .first_id = 1000 };
    pendres_context *ctx = make(11, 40, 192);
    pendres_switching_tally tally;
    pendres_switching_rate rate;
    check_ok(pendres_switching_count(ctx, &q, &tally));
    check_ok(pendres_switching_rate_of(&tally, 0, PENDRES_SWITCHING_WELL, 0.95, &rate));
    /* All exits lead to a well. */
    assert_true(tally.events[0][0] == tally.events[0][PENDRES_SWITCHING_WELL]);
    check_near(rate.exposure, N * 600 * 2.0 * PI, 1e-6);
    assert_true(rate.events > 100.0);
    /* Between Kramers' correction and none lie 4 %: what finite barriers do to the correction is
     * of its own order. */
    check_near(rate.value, inertia * smoluchowski, sigmas * rate.error + 0.04 * smoluchowski);
    assert_true(rate.error < 0.1 * rate.value);
    /* Hops are independent: their dispersion scatters by sqrt(2/N) = 7 % around 1. */
    check_near(rate.dispersion, 1.0, sigmas * sqrt(2.0 / N));
    pendres_context_free(ctx);
    pendres_attractors_free(set);
  }
}

/* The same count by hand: period after period, trajectory after trajectory. */
static void counts_are_what_plain_counting_gives(void **state)
{
  enum { N = 24, PERIODS = 400 };
  const pendres_pendulum p = balanced(0.03);
  pendres_attractors *set = attractors(p);
  pendres_context *ctx = make(5, 24, 8);
  double events[2][2] = { { 0.0 } }, wells[2] = { 0.0 }, exposure[2] = { 0.0 };
  double passage[2][2] = { { 0.0 } }, absence2[2] = { 0.0 }, ends[2] = { 0.0 };
  double forward[2] = { 0.0 }, passed[2] = { 0.0 };
  pendres_cores cores;
  pendres_switching_tally tally;
  (void)state;
  assert_int_equal(pendres_attractors_count(set), 2);
  const pendres_attractor *la = pendres_attractors_get(set, 1);
  const pendres_switching_request q = { .pendulum = p, .set = set, .from = 1, .trajectories = N,
                                        .periods = PERIODS, .first_id = 40 };
  check_ok(pendres_switching_count(ctx, &q, &tally));
  check_ok(pendres_cores_make(ctx, set, p.temperature, 0.0, &cores));
  for (uint64_t i = 0; i < N; i++) {
    double x = la->orbit.x, v = la->orbit.v;
    const uint64_t id = 40 + i;
    int home = 1;
    long home_well = 0;
    double since = 0.0;
    pendres_settled end;
    for (long k = 0; k < PERIODS; k++) {
      long well;
      check_ok(pendres_langevin_advance(ctx, RUN(1, &p, &id, k, 1, NULL), &x, &v));
      exposure[home] += 1.0;
      since++;
      const pendres_core *core = pendres_cores_locate(&cores, x, v, &well);
      if (core == NULL) continue;
      const int at = core->attractor;
      if (at == home && well == home_well) {
        absence2[home] += since * since;
      } else {
        passage[home][at] += since;
        events[home][at] += 1.0;
        wells[home] += well != home_well;
        forward[home] += well > home_well;
        if (well != home_well) passed[home] += fabs((double)(well - home_well)) - 1.0;
      }
      home = at;
      home_well = well;
      since = 0.0;
    }
    check_ok(pendres_attractors_settle(ctx, set, 1, &x, &v, &end));
    ends[end.attractor] += 1.0;
  }
  for (int s = 0; s < 2; s++) {
    check_near(tally.exposure[s], exposure[s], 0.0);
    check_near(tally.events[s][PENDRES_SWITCHING_WELL], wells[s], 0.0);
    check_near(tally.absence2[s], absence2[s], 0.0);
    check_near(tally.forward[s], forward[s], 0.0);
    check_near(tally.passed[s], passed[s], 0.0);
    check_near(tally.ends[s], ends[s], 0.0);
    for (int t = 0; t < 2; t++) {
      check_near(tally.events[s][t], events[s][t], 0.0);
      check_near(tally.passage[s][t], passage[s][t], 0.0);
    }
  }
  assert_true(events[1][0] > 5.0 && events[0][1] > 5.0);
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

/* Chunks, in any order, make the whole; blocks do not matter. */
static void parts_add_up(void **state)
{
  const pendres_pendulum p = balanced(0.03);
  pendres_attractors *set = attractors(p);
  pendres_switching_request q = { .pendulum = p, .set = set, .trajectories = 100, .periods = 200,
                                  .first_id = 7 };
  pendres_switching_tally whole, part[2], sum = { 0 };
  pendres_context *one = make(3, 20, 192), *other = make(3, 20, 16);
  (void)state;
  check_ok(pendres_switching_count(one, &q, &whole));
  q.trajectories = 37;
  check_ok(pendres_switching_count(other, &q, &part[0]));
  q.first_id += 37;
  q.trajectories = 63;
  check_ok(pendres_switching_count(other, &q, &part[1]));
  pendres_switching_add(&sum, &part[1]);
  pendres_switching_add(&sum, &part[0]);
  assert_true(whole.events[0][1] > 0.0);
  assert_memory_equal(&sum, &whole, sizeof sum);
  pendres_context_free(one);
  pendres_context_free(other);
  pendres_attractors_free(set);
}

/* At temperature 0 nothing leaves; what is nonsense is refused in words. */
static void stillness_and_nonsense(void **state)
{
  const pendres_pendulum p = balanced(0.0);
  pendres_attractors *set = attractors(p);
  pendres_context *ctx = make(1, 60, 8);
  pendres_switching_request q = { .pendulum = p, .set = set, .trajectories = 8, .periods = 50 };
  pendres_switching_tally tally;
  pendres_switching_rate rate;
  (void)state;
  for (size_t from = 0; from < 2; from++) {
    q.from = from;
    check_ok(pendres_switching_count(ctx, &q, &tally));
    check_near(tally.exposure[from], 8 * 50, 0.0);
    for (size_t t = 0; t <= PENDRES_SWITCHING_STATES; t++)
      assert_true(tally.events[from][t] == 0.0);
    check_ok(pendres_switching_rate_of(&tally, from, 1 - from, 0.95, &rate));
    assert_true(rate.value == 0.0 && rate.lower == 0.0 && rate.error > 0.0);
    check_relative(rate.upper, -log(0.025) / (8 * 50 * 7.7), 1e-9); /* Poisson: exp(-mean) */
    check_ok(pendres_switching_rate_of(&tally, 1 - from, from, 0.95, &rate));
    assert_true(isnan(rate.value) && isnan(rate.error)); /* nobody was there */
  }
  static const double bad[] = { -1e-3, NAN, INFINITY };
  for (size_t i = 0; i < 3; i++) {
    q.pendulum.temperature = bad[i];
    assert_int_equal(pendres_switching_count(ctx, &q, &tally), PENDRES_INVALID_ARGUMENT);
    assert_true(strlen(pendres_context_message(ctx)) > 10);
  }
  q.pendulum = p;
  q.pendulum.damping = 0.13;
  assert_int_equal(pendres_switching_count(ctx, &q, &tally), PENDRES_INVALID_ARGUMENT);
  q.pendulum = p;
  q.from = 2;
  assert_int_equal(pendres_switching_count(ctx, &q, &tally), PENDRES_INVALID_ARGUMENT);
  q.from = 0;
  q.core = 2.5;
  assert_int_equal(pendres_switching_count(ctx, &q, &tally), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_switching_rate_of(&tally, 0, 1, 1.0, &rate), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

/* Places: points of the orbits, moved by whole turns, one in between, and one that is lost. */
static void states_are_located(void **state)
{
  pendres_attractors *set = attractors(balanced(0.0));
  pendres_context *ctx = make(1, 24, 8);
  pendres_cores cores;
  long well = 0;
  (void)state;
  for (int hot = 0; hot < 2; hot++) {
    check_ok(pendres_cores_make(ctx, set, 0.01 * hot, 0.0, &cores));
    assert_int_equal(cores.count, 2);
    for (int i = 0; i < 2; i++)
      for (long turn = -3; turn <= 3; turn++) {
        const pendres_orbit *o = &pendres_attractors_get(set, (size_t)i)->orbit;
        const pendres_core *at =
          pendres_cores_locate(&cores, o->x + 2.0 * PI * (double)turn, o->v, &well);
        assert_non_null(at);
        assert_int_equal(at->attractor, i);
        assert_int_equal(well, turn);
      }
    assert_null(pendres_cores_locate(&cores, -PI / 2.0, 0.0, &well)); /* a barrier's top */
    assert_null(pendres_cores_locate(&cores, 1e300, 0.0, &well));
    assert_null(pendres_cores_locate(&cores, NAN, 0.0, &well));
  }
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

/* Rates that are exactly exponential give their energy back, and the error that theory says. */
/* Rates by a law, so exactly known that errors come from what is not known of the prefactor. */
static void make_rates(int n, const double *temperature, double energy, double power,
                       double correction, double events, pendres_switching_rate *rates)
{
  for (int i = 0; i < n; i++) {
    const double t = temperature[i];
    const double value = 0.02 * pow(t, power) * (1.0 + correction * t / energy) * exp(-energy / t);
    rates[i] = (pendres_switching_rate){ .events = events, .value = value,
                                         .error = value / sqrt(events) };
  }
}

/* Whatever the prefactor does within what theories have, the energy is within its error. */
static void fits_allow_for_the_prefactor(void **state)
{
  enum { N = 6 };
  const double temperature[N] = { 0.0125, 0.015, 0.0175, 0.02, 0.025, 0.03 }, energy = 0.1;
  static const double powers[] = { -1.0, -0.5, 0.0, 0.5, 1.0 };
  pendres_switching_rate rates[N];
  pendres_switching_activation fit;
  (void)state;
  for (int k = 0; k < 5; k++)
    for (int sign = -1; sign <= 1; sign++) {
      make_rates(N, temperature, energy, powers[k], 0.5 * sign, 3000.0, rates);
      check_ok(pendres_switching_fit(N, temperature, rates, 0.0, &fit));
      /* Powers of +-1 are two standard deviations of what is assumed. */
      check_near(fit.energy, energy, 2.0 * fit.energy_error);
      check_near(fit.exponent, powers[k], 2.5 * fit.exponent_error);
      /* Of some T/2, not more: useful. */
      assert_true(fit.energy_error < 0.6 * fit.temperature);
      check_relative(fit.least_barrier, fit.energy / temperature[N - 1], 1e-12);
    }
}

/*
 * Two temperatures: the line goes through both, and the variance of its slope is that of the two
 * logarithms and, from the prefactor, that of b ln T + c1 T/E + c2 (T/E)^2 between them.
 */
static void fits_of_two_points_have_the_exact_error(void **state)
{
  const double t[2] = { 0.012, 0.015 }, energy = 0.07, events = 400.0;
  const double apart = 1.0 / t[0] - 1.0 / t[1], e = energy;
  pendres_switching_rate rates[2];
  pendres_switching_activation fit;
  (void)state;
  make_rates(2, t, energy, 0.0, 0.0, events, rates);
  check_ok(pendres_switching_fit(2, t, rates, 0.0, &fit));
  const double power = 0.5 * log(t[1] / t[0]), first = (t[1] - t[0]) / e;
  const double second = (t[1] * t[1] - t[0] * t[0]) / (e * e);
  const double variance = 2.0 / events + power * power + first * first + second * second;
  /* Rounding of a fit in five unknowns. */
  check_relative(fit.energy, energy, 1e-9);
  check_relative(fit.energy_error, sqrt(variance) / apart, 1e-9);
  check_near(fit.exponent, 0.0, 1e-9);
}

/*
 * Rates from the small-amplitude state at damping 0.13, drive amplitude 0.2, drive period 7.6, by
 * ./resonance. The activation energy there is the least action of a path out of its basin: 0.06853
 * by an independent minimisation. A straight line through them has 0.06475 +- 0.0006.
 */
static void fits_find_the_least_action(void **state)
{
  enum { N = 5 };
  static const double temperature[N] = { 0.012, 0.014, 0.016, 0.018, 0.02 };
  static const double value[N] = { 6.128e-05, 1.348e-4, 2.399e-4, 3.793e-4, 5.345e-4 };
  static const double error[N] = { 1.4e-6, 2.2e-6, 3e-6, 3.9e-6, 4.8e-6 };
  pendres_switching_rate rates[N];
  pendres_switching_activation fit;
  (void)state;
  for (int i = 0; i < N; i++)
    rates[i] = (pendres_switching_rate){ .events = 1000.0, .value = value[i], .error = error[i] };
  check_ok(pendres_switching_fit(N, temperature, rates, 0.0, &fit));
  check_near(fit.energy, 0.06853, fit.energy_error);
  assert_true(fit.energy_error < 0.01);
}

static void fits_refuse_what_says_nothing(void **state)
{
  enum { N = 4 };
  const double temperature[N] = { 0.01, 0.0125, 0.016, 0.02 }, same[2] = { 0.01, 0.01 };
  pendres_switching_rate rates[N];
  pendres_switching_activation fit, scattered;
  (void)state;
  make_rates(N, temperature, 0.09, 0.0, 0.0, 400.0, rates);
  check_ok(pendres_switching_fit(N, temperature, rates, 0.0, &fit));
  assert_int_equal(fit.points, N);
  check_near(fit.chi2, 0.0, 1e-18);

  /* A scatter that neither events nor a prefactor explain makes the error larger. */
  rates[1].value *= 2.0;
  rates[1].error *= 2.0;
  check_ok(pendres_switching_fit(N, temperature, rates, 0.0, &scattered));
  assert_true(scattered.chi2 > 10.0);
  assert_true(scattered.energy_error > 2.0 * fit.energy_error);

  /* Too few events, or one temperature twice: said, not guessed. */
  for (int i = 0; i < N - 1; i++) rates[i].events = 9.0;
  assert_int_equal(pendres_switching_fit(N, temperature, rates, 0.0, &fit), PENDRES_NOT_FOUND);
  assert_int_equal(fit.points, 1);
  assert_true(isnan(fit.energy) && isnan(fit.energy_error) && isnan(fit.least_barrier));
  check_ok(pendres_switching_fit(N, temperature, rates, 5.0, &fit));
  assert_int_equal(pendres_switching_fit(2, same, rates, 5.0, &fit), PENDRES_NOT_FOUND);

  /* No rate at all, or one without an error. */
  rates[3].error = 0.0;
  assert_int_equal(pendres_switching_fit(N, temperature, rates, 5.0, &fit),
                   PENDRES_INVALID_ARGUMENT);
  rates[3] = (pendres_switching_rate){ .events = 20.0, .value = NAN, .error = NAN };
  assert_int_equal(pendres_switching_fit(N, temperature, rates, 5.0, &fit),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_switching_fit(N, NULL, rates, 5.0, &fit), PENDRES_INVALID_ARGUMENT);
}

/* Events in bursts of four make intervals twice as wide. */
static void bursts_widen_intervals(void **state)
{
  enum { N = 100 };
  pendres_switching_tally t = { .states = 2, .period = 1.0, .trajectories = N };
  pendres_switching_rate rate;
  pendres_langevin_interval alone;
  (void)state;
  /* Half of the trajectories have none, the others eight in equal times: variance 16, mean 4. */
  for (int i = 0; i < N; i++) {
    const double events = i % 2 ? 8.0 : 0.0, time = 50.0;
    t.exposure[0] += time;
    t.exposure2[0] += time * time;
    t.events[0][1] += events;
    t.events2[0][1] += events * events;
    t.mixed[0][1] += events * time;
  }
  check_ok(pendres_switching_rate_of(&t, 0, 1, 0.9, &rate));
  const double d = 4.0 * N / (N - 1.0);
  check_relative(rate.dispersion, d, 1e-12);
  check_relative(rate.value, 4.0 / 50.0, 1e-12);
  check_relative(rate.error, sqrt(4.0 * N * d) / (50.0 * N), 1e-12);
  check_ok(pendres_langevin_rate(4.0 * N / d, 50.0 * N / d, 0.9, &alone));
  check_relative(rate.lower, alone.lower, 1e-12);
  check_relative(rate.upper, alone.upper, 1e-12);
}

/* Half as large and twice as large, both ways: a small core is found late, which is allowed for. */
static void rates_do_not_depend_on_the_core(void **state)
{
  static const double sizes[] = { 1.0, 0.5, 2.0 };
  const pendres_pendulum p = balanced(0.02);
  pendres_attractors *set = attractors(p);
  pendres_context *ctx = make(9, 32, 192);
  pendres_switching_rate rate[3];
  (void)state;
  for (size_t from = 0; from < 2; from++)
    for (int i = 0; i < 3; i++) {
      const pendres_switching_request q = { .pendulum = p, .set = set, .core = sizes[i],
                                            .from = from, .trajectories = 384, .periods = 2000,
                                            .first_id = 10000u * (unsigned)i };
      pendres_switching_tally tally;
      check_ok(pendres_switching_count(ctx, &q, &tally));
      check_ok(pendres_switching_rate_of(&tally, from, 1 - from, 0.95, &rate[i]));
      assert_true(rate[i].events > 200.0);
      check_near(rate[i].value, rate[0].value, sigmas * hypot(rate[i].error, rate[0].error));
    }
  pendres_context_free(ctx);
  pendres_attractors_free(set);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(states_are_located),
    cmocka_unit_test(counts_are_what_plain_counting_gives),
    cmocka_unit_test(parts_add_up),
    cmocka_unit_test(stillness_and_nonsense),
    cmocka_unit_test(bursts_widen_intervals),
    cmocka_unit_test(fits_allow_for_the_prefactor),
    cmocka_unit_test(fits_of_two_points_have_the_exact_error),
    cmocka_unit_test(fits_find_the_least_action),
    cmocka_unit_test(fits_refuse_what_says_nothing),
    cmocka_unit_test(rates_do_not_depend_on_the_core),
    cmocka_unit_test(wells_are_left_as_kramers_says),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
