/*
 * test_scene_noise.c -- scenes with noise, run in this process: results that do not depend on
 * threads, against linear noise theory and the deterministic limit, and decks that are wrong.
 */
#include "scene_fixture.h"

#include <pendres/pendres.h>

#include "scenes/basins/basins.h"
#include "results/failed.h"

/* Clouds alone, as scenes/basins.c asks for them. */
static pendres_status run_clouds(scene_run *run)
{
  const pendres_pendulum p = { .damping = run->deck->pendulum.damping,
                               .drive_amplitude = run->deck->pendulum.drive_amplitude,
                               .drive_frequency = run->deck->pendulum.drive_frequency };
  pendres_attractors *set = NULL;
  check_ok(pendres_attractors_find(farm_context(run->farm), &p, 0, NULL, NULL, &set));
  check_ok(pendres_store_dimension(
    run->store, &(pendres_store_spec){.name = "attractor", .long_name = "number of the attractor"},
    pendres_attractors_count(set), NULL));
  basins_write_clouds(run, set);
  pendres_attractors_free(set);
  return run->status;
}

static void run_deck(const char *text, int threads, const char *name)
{
  const int clouds = strstr(text, "'basins'") != NULL;
  scene_run_deck_by(clouds ? run_clouds : NULL, text, threads, name);
}

/* n numbers of a variable. */
static void get(const char *file, const char *name, double *values, size_t n)
{
  pendres_store *store = scene_open(file);
  const pendres_status status =
    pendres_store_read(store, "", name, PENDRES_STORE_DOUBLE, values, n);
  if (status != PENDRES_OK) print_error("%s: %s\n", name, pendres_store_message(store));
  check_ok(status);
  pendres_store_free(store);
}

/* 600 trajectories make four chunks. */
static const char switching_deck[] =
  "&scene kind = 'switching' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 7.7 /\n"
  "&sweep temperature = 0.02, 0.03 /\n&noise seed = 5, trajectories = 600, periods = 300 /\n";

/* Beyond the paper's drives there are both states as well; by number they are the same. */
static void switching_goes_by_name_or_number(void **state)
{
  static const char *const names[2][3] = { { "rate_sa_la", "rate_la_sa", "exposure_la" },
                                           { "rate_1_2", "rate_2_1", "exposure_2" } };
  static const char deck[] =
    "&scene kind = 'switching' /\n"
    "&pendulum drive_amplitude = 0.35, damping = 0.1111, drive_frequency = 0.735 /\n"
    "&sweep temperature = 0.02 /\n&noise trajectories = 64, periods = 100 /\n";
  char numbered[400];
  (void)state;
  snprintf(numbered, sizeof numbered, "%s&switching from = 1, to = 2 /\n", deck);
  run_deck(deck, 1, "named");
  run_deck(numbered, 1, "numbered");
  for (int i = 0; i < 3; i++) {
    double value[2];
    get("named", names[0][i], &value[0], 1);
    get("numbered", names[1][i], &value[1], 1);
    assert_true(value[0] > 0.0);
    check_near(value[1], value[0], 0.0);
  }
}

/*
 * Other models: between the wells of a Duffing oscillator at rest and in a weak drive, and from a
 * junction's state of no voltage to other wells, as the library counts them
 * (test_switching_models); what there is not, is not in the file: wells of a polynomial, another
 * state of the junction. A junction that may rotate is refused. Helmholtz' oscillator escapes.
 */
static void switching_of_other_models(void **state)
{
  static const char *const decks[] = {
    "&pendulum drive_amplitude = 0.02, damping = 0.5, drive_frequency = 1.0,\n"
    "  force = 'polynomial', force_coefficients = -1, 0, 1 /\n"
    "&sweep temperature = 0.0625 /\n&switching from = 1, to = 2 /\n",
    "&pendulum drive_amplitude = 0, damping = 2, drive_frequency = 1.0, torque = 0.2 /\n"
    "&sweep temperature = 0.4, 0.5 /\n&switching from = 1 /\n",
    "&pendulum drive_amplitude = 0, damping = 0.3, drive_frequency = 1.0, torque = 0.5 /\n"
    "&sweep temperature = 0.4 /\n&switching from = 1 /\n",
    "&pendulum drive_amplitude = 0.03, damping = 0.5, drive_frequency = 0.9,\n"
    "  force = 'polynomial', force_coefficients = 1, -1 /\n"
    "&sweep temperature = 0.05 /\n&switching from = 1 /\n"};
  static const char *const files[] = {"duffing", "junction", "rotating", "helmholtz"};
  char text[400];
  (void)state;
  for (int i = 0; i < 4; i++) {
    snprintf(text, sizeof text, "&scene kind = 'switching' /\n%s&noise trajectories = 192, "
             "periods = 200 /\n", decks[i]);
    assert_int_equal(scene_run_marked(NULL, text, 1, files[i]), i == 2);
    if (i == 2) assert_non_null(strstr(scene_told, "rotate"));
  }
  double forth, back, slips[2], failed[2];
  get("duffing", "rate_1_2", &forth, 1);
  get("duffing", "rate_2_1", &back, 1);
  /* Undriven it is 0.00296; the drive's period is far from resonance, and its force a twentieth of
     what tips the wells over. */
  assert_true(forth > 0.002 && forth < 0.006 && back > 0.002 && back < 0.006);
  get("junction", "failed", failed, 2);
  assert_int_equal((int)failed[0], SCENE_FAILURE_NONE);
  pendres_store *store = scene_open("duffing");
  assert_false(pendres_store_has(store, "", "rate_well_1"));
  pendres_store_free(store);
  store = scene_open("junction");
  assert_false(pendres_store_has(store, "", "exposure_la"));
  pendres_store_free(store);
  get("helmholtz", "rate_escape_1", slips, 1);
  assert_true(slips[0] > 0.002 && slips[0] < 0.006); /* 0.0024 at a temperature of 1/24 */
  get("junction", "rate_well_1", slips, 2);
  assert_true(slips[0] > 0.0 && slips[1] > slips[0]);
}

static void switching_counts_both_ways(void **state)
{
  static const char *const names[2] = { "sa_la", "la_sa" };
  double rate[2], error[2], lower[2], upper[2], events[2], energy, energy_error, sa[2], la[2];
  (void)state;
  run_deck(switching_deck, 1, "one");
  run_deck(switching_deck, 2, "two");
  scene_check_same_bytes("one", "two");
  get("one", "exposure_sa", sa, 2);
  get("one", "exposure_la", la, 2);
  for (int i = 0; i < 2; i++) /* every trajectory is somewhere at all times */
    check_relative(sa[i] + la[i], 600 * 300 * 7.7, 1e-12);
  for (int k = 0; k < 2; k++) {
    char name[40];
    snprintf(name, sizeof name, "rate_%s", names[k]);
    get("one", name, rate, 2);
    snprintf(name, sizeof name, "rate_%s_error", names[k]);
    get("one", name, error, 2);
    snprintf(name, sizeof name, "rate_%s_lower", names[k]);
    get("one", name, lower, 2);
    snprintf(name, sizeof name, "rate_%s_upper", names[k]);
    get("one", name, upper, 2);
    snprintf(name, sizeof name, "events_%s", names[k]);
    get("one", name, events, 2);
    for (int i = 0; i < 2; i++) {
      assert_true(events[i] >= 10.0);
      /* What is not seen on the other state in time is added. */
      const double seen = events[i] / (k == 0 ? sa : la)[i];
      assert_true(rate[i] >= seen && rate[i] < 1.3 * seen);
      assert_true(lower[i] < rate[i] && rate[i] < upper[i]);
      /* 1.96 standard errors on either side, but for the skewness of few events. */
      check_relative(upper[i] - lower[i], 2.0 * 1.96 * error[i], 0.15);
    }
    snprintf(name, sizeof name, "activation_energy_%s", names[k]);
    get("one", name, &energy, 1);
    snprintf(name, sizeof name, "activation_energy_%s_error", names[k]);
    get("one", name, &energy_error, 1);
    /* Two temperatures: the slope between them. */
    check_relative(energy, log(rate[1] / rate[0]) / (1.0 / 0.02 - 1.0 / 0.03), 1e-9);
    /* What is not known of the prefactor, a power of 1/2, and half of that again for the rest. */
    const double unknown = 0.5 * log(1.5) / (1.0 / 0.02 - 1.0 / 0.03);
    assert_true(energy_error > unknown && energy_error < 1.5 * unknown);
  }
}

/* Verdicts on linear theory, in the order of their flags. */
enum { AGREES, TOO_HOT, NOT_COMPARED, UNCERTAIN, BELOW_ROUNDING };

/* Fig. 7's parameters; at T = 0.02 the clouds fill their wells. */
static const char basins_deck[] =
  "&scene kind = 'basins' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
  "&sweep x = 0, v = 0, temperature = 0, 0.0001, 0.02 /\n"
  "&basins strobes = 12000, trajectories = 400, seed = 3 /\n";

static void clouds_agree_with_linear_theory(void **state)
{
  enum { T = 3, A = 2, S = 12000 };
  static const char *const parts[3] = { "xx", "xv", "vv" };
  static double x[T * A * S], v[T * A * S];
  double verdict[T * A], value[T * A], error[T * A], linear[T * A], bias[T * A], escapes[T * A];
  (void)state;
  run_deck(basins_deck, 1, "one");
  run_deck(basins_deck, 2, "two");
  scene_check_same_bytes("one", "two");
  get("one", "strobe_x", x, T * A * S);
  get("one", "strobe_v", v, T * A * S);
  get("one", "linear_theory", verdict, T * A);
  get("one", "escapes", escapes, T * A);
  for (int k = 0; k < 3; k++) {
    char name[40];
    snprintf(name, sizeof name, "strobe_cov_%s", parts[k]);
    get("one", name, value, T * A);
    snprintf(name, sizeof name, "strobe_cov_%s_error", parts[k]);
    get("one", name, error, T * A);
    snprintf(name, sizeof name, "linear_cov_%s", parts[k]);
    get("one", name, linear, T * A);
    snprintf(name, sizeof name, "bias_cov_%s", parts[k]);
    get("one", name, bias, T * A);
    for (int a = 0; a < A; a++) {
      assert_true(value[a] == 0.0 && error[a] == 0.0 && linear[a] == 0.0);
      check_near(value[A + a], linear[A + a], 4.0 * error[A + a] + fabs(bias[A + a]));
      assert_true(error[A + a] > 0.0);
    }
    /* The file's points have the file's covariance: 400 x 30 points, all of them written. */
    double mx = 0.0, mv = 0.0, sum = 0.0;
    for (int i = 0; i < S; i++) mx += x[A * S + i] / S, mv += v[A * S + i] / S;
    for (int i = 0; i < S; i++) {
      const double dx = x[A * S + i] - mx, dv = v[A * S + i] - mv;
      sum += (k == 0 ? dx * dx : k == 1 ? dx * dv : dv * dv) / S;
    }
    check_near(sum, value[A], 1e-12);
  }
  for (int i = 0; i < 4; i++) assert_true(verdict[i] == AGREES);
  assert_true(verdict[4] == TOO_HOT || verdict[5] == TOO_HOT);
  assert_true(escapes[0] == 0.0 && escapes[1] == 0.0 && escapes[2] == 0.0 && escapes[3] == 0.0);
  assert_true(escapes[5] > 10.0); /* LA is left once in 120 periods */
}

/* So cold that theory is exact: nothing is followed, and its numbers are the cloud's. */
static void coldest_clouds_are_those_of_theory(void **state)
{
  enum { T = 3, A = 2, S = 16 };
  static const char *const parts[3] = { "xx", "xv", "vv" };
  double verdict[T * A], value[T * A], linear[T * A], steps[T * A], x[T * A * S], mean[T * A];
  (void)state;
  run_deck("&scene kind = 'basins' /\n"
           "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
           "&sweep x = 0, v = 0, temperature = 1e-300, 1e-30, 1e-18 /\n"
           "&basins strobes = 16, trajectories = 4, seed = 3 /\n", 1, "cold");
  get("cold", "linear_theory", verdict, T * A);
  get("cold", "noise_steps_per_period", steps, T * A);
  get("cold", "strobe_x", x, T * A * S);
  get("cold", "strobe_mean_x", mean, T * A);
  for (int i = 0; i < T * A; i++) {
    assert_true(verdict[i] == BELOW_ROUNDING && steps[i] == 0.0);
    for (int k = 0; k < S; k++) check_near(x[i * S + k], mean[i], 0.0);
  }
  for (int k = 0; k < 3; k++) {
    char name[40];
    snprintf(name, sizeof name, "strobe_cov_%s", parts[k]);
    get("cold", name, value, T * A);
    snprintf(name, sizeof name, "linear_cov_%s", parts[k]);
    get("cold", name, linear, T * A);
    for (int i = 0; i < T * A; i++) {
      check_near(value[i], linear[i], 0.0);
      /* Theory is linear in the temperature; sums in another order round by some 1e-14. */
      check_relative(value[i], value[i % A] * 1e300 * (i < A ? 1e-300 : i < 2 * A ? 1e-30 : 1e-18),
                     1e-12);
    }
  }
}

/* Two trajectories of a few strobes know a variance to a factor: that is no agreement. */
static void few_strobes_are_no_agreement(void **state)
{
  double verdict[2], error[2], linear[2];
  (void)state;
  run_deck("&scene kind = 'basins' /\n"
           "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
           "&sweep x = 0, v = 0, temperature = 0.0001 /\n"
           "&basins strobes = 6, trajectories = 2, seed = 3 /\n", 1, "few");
  get("few", "linear_theory", verdict, 2);
  get("few", "strobe_cov_xx_error", error, 2);
  get("few", "linear_cov_xx", linear, 2);
  int uncertain = 0;
  for (int i = 0; i < 2; i++) {
    if (error[i] > 0.5 * linear[i]) assert_true(verdict[i] != AGREES);
    uncertain += verdict[i] == UNCERTAIN;
  }
  assert_true(uncertain > 0);
}

#define RESPONSE_DECK                                                                              \
  "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"                                \
  "&sweep damping = 0.24, 0.8, drive_period = 6.5, 7.5"
#define NOISE_GROUP "/\n&noise trajectories = 240, periods = 60, seed = 2 /\n"

static void response_begins_at_the_deterministic_one(void **state)
{
  enum { T = 3, PLANE = 4 };
  static const char *const names[] = { "mean_loop_area", "phase_lag", "first_harmonic_amplitude" };
  static const char *const biases[] = { "bias_loop_area", "bias_phase_lag",
                                        "bias_first_harmonic_amplitude" };
  static const char *const still[] = { "mean_loop_area", "phase_lag", "mean_power",
                                       "mean_loop_amplitude", "la_fraction" };
  double value[T * PLANE], error[T * PLANE], bias[T * PLANE], plain[PLANE];
  (void)state;
  run_deck(RESPONSE_DECK ", temperature = 0, 1e-5, 0.01" NOISE_GROUP, 1, "one");
  run_deck(RESPONSE_DECK ", temperature = 0, 1e-5, 0.01" NOISE_GROUP, 2, "two");
  scene_check_same_bytes("one", "two");
  run_deck(RESPONSE_DECK "/\n", 2, "two");
  for (size_t k = 0; k < sizeof still / sizeof *still; k++) {
    get("one", still[k], value, T * PLANE);
    get("two", still[k], plain, PLANE);
    assert_memory_equal(value, plain, sizeof plain); /* to the last digit */
  }
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    char name[60];
    snprintf(name, sizeof name, "%s_error", names[k]);
    get("one", names[k], value, T * PLANE);
    get("one", name, error, T * PLANE);
    get("one", biases[k], bias, T * PLANE);
    for (int i = 0; i < PLANE; i++) {
      /* Noise shifts means by something of the order of T; errors go with its square root. */
      check_near(value[PLANE + i], value[i],
                 4.5 * error[PLANE + i] + fabs(bias[PLANE + i]) + 10.0 * 1e-5);
      assert_true(error[PLANE + i] > 0.0 && error[PLANE + i] < 1e-4);
      assert_true(error[2 * PLANE + i] > 10.0 * error[PLANE + i]);
    }
  }
}

/* No deck may ask for such a temperature, but there are others that a scene cannot know of. */
static pendres_status run_too_hot(scene_run *run)
{
  run->deck->axis[DECK_AXIS_TEMPERATURE].value[1] = 1e20;
  if (run->deck->kind == DECK_BASINS) return run_clouds(run);
  return scene_find(run->deck->kind)->run(run);
}

/*
 * A temperature beyond what can be followed is marked, told and without results, and the others are
 * what they are without it.
 */
static void too_hot_points_are_marked(void **state)
{
  static const struct {
    const char *format, *failed, *value, *told;
    size_t points; /* a temperature */
  } cases[] = {
    { "&scene kind = 'switching' /\n"
      "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 7.7 /\n"
      "&sweep temperature = 0.02%s /\n&noise trajectories = 64, periods = 20 /\n",
      "failed", "exposure_sa", "switching at temperature 1e+20: ", 1 },
    { "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
      "&sweep damping = 0.24, drive_period = 7, 8, temperature = 0.001%s /\n"
      "&ensemble members = 10 /\n&noise trajectories = 16, periods = 10 /\n",
      "noise_failed", "mean_loop_area", "response with noise at temperature 1e+20, damping 0.24, "
      "drive_period 7: ", 2 },
    { "&scene kind = 'basins' /\n"
      "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
      "&sweep x = 0, v = 0, temperature = 0.0001%s /\n&basins strobes = 50, trajectories = 10 /\n",
      "noise_failed", "escapes", "noisy cloud at temperature 1e+20, attractor 0: ", 2 } };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const size_t n = cases[i].points;
    const char *hole = strstr(cases[i].format, "%s");
    char text[2][500];
    double failed[4], value[4], alone[2];
    for (int k = 0; k < 2; k++)
      snprintf(text[k], sizeof text[k], "%.*s%s%s", (int)(hole - cases[i].format), cases[i].format,
               k == 0 ? "" : ", 1000", hole + 2);
    run_deck(text[0], 1, "alone");
    assert_int_equal(scene_run_marked(run_too_hot, text[1], 1, "hot"), n);
    assert_non_null(strstr(scene_told, cases[i].told));
    assert_non_null(strstr(scene_told, "so hot a pendulum"));
    assert_int_equal(scene_run_marked(run_too_hot, text[1], 2, "again"), n);
    scene_check_same_bytes("hot", "again");
    get("hot", cases[i].failed, failed, 2 * n);
    get("hot", cases[i].value, value, 2 * n);
    get("alone", cases[i].value, alone, n);
    assert_memory_equal(value, alone, n * sizeof *value);
    for (size_t k = 0; k < n; k++) {
      assert_int_equal((int)failed[k], SCENE_FAILURE_NONE);
      assert_int_equal((int)failed[n + k], SCENE_FAILURE_REFUSED);
      assert_true(isfinite(value[k]) && isnan(value[n + k]));
    }
  }
}

/* Temperatures that are none are mistakes of the deck. */
static void bad_temperatures_are_deck_errors(void **state)
{
  static const char *const bad[] = { "-0.001", "NaN", "-Inf", "Inf", "0.001, -1" };
  static const char *const scenes[] = {
    "&scene kind = 'switching' /\n&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8"
    " /\n&sweep temperature = %s /\n",
    "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n&sweep damping = 0.24, "
    "drive_period = 7, temperature = %s /\n",
    "&scene kind = 'basins' /\n&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8"
    " /\n&sweep x = 0, v = 0, temperature = %s /\n" };
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
      char text[400];
      deck d;
      namelist_errors errors = { 0 };
      /* The format comes from the list above. */
      const char *hole = strstr(scenes[k], "%s");
      snprintf(text, sizeof text, "%.*s%s%s", (int)(hole - scenes[k]), scenes[k], bad[i], hole + 2);
      assert_int_equal(deck_read_memory("bad.nml", text, strlen(text), &d, &errors),
                       PENDRES_INVALID_ARGUMENT);
      assert_true(errors.count > 0);
      deck_free(&d);
      namelist_errors_free(&errors);
    }
}

/* ---- One call of the library does what a scene does, to the last bit ---- */

static pendres_context *seeded(uint64_t seed)
{
  const pendres_options options = { .seed = seed, .block_lanes = 64 };
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&options, &ctx));
  return ctx;
}

static void one_call_switches(void **state)
{
  static const char *const ways[PENDRES_SWITCHING_WAYS] = { "sa_la", "la_sa", "well_sa",
                                                            "well_la" };
  static const double temperature[2] = { 0.02, 0.03 };
  const pendres_pendulum p = { .damping = 0.12, .drive_amplitude = 0.2,
                               .drive_frequency = 6.28318530717958647693 / 7.7 };
  pendres_context *ctx = seeded(5);
  pendres_attractors *set = NULL;
  pendres_switching_rates rates[2];
  pendres_switching_activation activation[PENDRES_SWITCHING_WAYS];
  (void)state;
  run_deck(switching_deck, 2, "scene");
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  pendres_switching_survey survey = { .set = set, .trajectories = 600, .periods = 300 };
  pendres_switching_states(set, survey.state);
  check_ok(pendres_switching_find(ctx, &survey, 2, temperature, rates, activation));
  for (int k = 0; k < PENDRES_SWITCHING_WAYS; k++) {
    char name[40];
    double value[2], energy;
    snprintf(name, sizeof name, "rate_%s", ways[k]);
    get("scene", name, value, 2);
    snprintf(name, sizeof name, "activation_energy_%s", ways[k]);
    get("scene", name, &energy, 1);
    for (int i = 0; i < 2; i++) {
      const pendres_switching_rate *r = &rates[i].way[k];
      check_near(r->value, value[i], 0.0);
      if (r->events > 0.0) {
        check_relative(r->mean_time, 1.0 / r->value, 1e-15);
        check_relative(r->mean_time_error / r->mean_time, r->error / r->value, 1e-14);
      }
    }
    if (isnan(energy)) assert_true(isnan(activation[k].energy));
    else check_near(activation[k].energy, energy, 0.0);
  }
  assert_int_equal(rates[0].status, PENDRES_OK);
  check_near(rates[0].exposure[0] + rates[0].exposure[1], 600 * 300 * 7.7, 1e-8);
  assert_int_equal(activation[0].verdict, PENDRES_SWITCHING_UNCHECKED);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

static void one_call_makes_a_cloud(void **state)
{
  enum { S = 12000 }; /* of the large-amplitude state at the third temperature */
  static double x[S], v[S], scene_x[6 * S];
  const pendres_pendulum p = { .damping = 0.12, .drive_amplitude = 0.2,
                               .drive_frequency = 6.28318530717958647693 / 8.0 };
  double value[6], rate[6];
  pendres_context *ctx = seeded(3);
  pendres_attractors *set = NULL;
  pendres_cloud cloud;
  (void)state;
  run_deck(basins_deck, 2, "scene");
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  const pendres_cloud_request q = { .set = set, .attractor = 1, .temperature = 0.02,
                                    .trajectories = 400, .record = 30 };
  check_ok(pendres_cloud_find(ctx, &q, &cloud, x, v));
  get("scene", "strobe_cov_xv", value, 6);
  get("scene", "escape_rate_upper", rate, 6);
  get("scene", "strobe_x", scene_x, 6 * S);
  check_near(cloud.measured.statistics[PENDRES_LANGEVIN_COV_XV].value, value[5], 0.0);
  check_near(cloud.escape_rate.upper, rate[5], 0.0);
  assert_memory_equal(x, scene_x + 5 * S, sizeof x); /* NaN where trajectories have left, too */
  assert_int_equal(cloud.way, PENDRES_CLOUD_FOLLOWED);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bad_temperatures_are_deck_errors),
    cmocka_unit_test(too_hot_points_are_marked),
    cmocka_unit_test(switching_counts_both_ways),
    cmocka_unit_test(switching_goes_by_name_or_number),
    cmocka_unit_test(switching_of_other_models),
    cmocka_unit_test(clouds_agree_with_linear_theory),
    cmocka_unit_test(coldest_clouds_are_those_of_theory),
    cmocka_unit_test(few_strobes_are_no_agreement),
    cmocka_unit_test(response_begins_at_the_deterministic_one),
    cmocka_unit_test(one_call_switches),
    cmocka_unit_test(one_call_makes_a_cloud),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
