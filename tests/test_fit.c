/*
 * test_fit.c -- fits to data that another integration made (fit_fixture.h): values within their
 * errors, and what data leave open.
 *
 * Tolerances: a value is within four and a half standard errors (one normal number in 150,000 is
 * not), a chi-square has a probability above 1e-5. Seeds are fixed.
 */
#include "fit_fixture.h"
#include "check.h"

#include <stdio.h>
#include <string.h>

#include <pendres/pendres.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const double farthest_pull = 4.5, least_probability = 1e-5;

enum { SWEEP = 60, DATA = 2 * SWEEP, OPEN = 4, FIRST = 2 /* starts, of which one converges */ };

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  return ctx;
}

/* One set: up and down over a resonance whose backbone bends by `bent` widths. */
typedef struct set {
  int sine, soft;
  double quality, noise, bent;
  pendres_fit_observable observable;
  double low, high; /* of the frequency; 0: some widths about the resonance */
} set;

static lab lab_of(const set *s)
{
  const double a3 = fmin(s->soft ? 0.25 : 0.5, 4.0 * s->bent / 3.0 / s->quality);
  lab l = {.sine = s->sine, .a1 = 1.0, .a3 = s->soft ? -a3 : a3, .damping = 1.0 / s->quality};
  const double a = s->sine ? fmin(1.8, sqrt(8.0 * s->bent / s->quality)) : 1.0;
  const double top = s->sine ? 1.0 - a * a / 16.0 : sqrt(1.0 + 0.75 * l.a3);
  l.drive = a / s->quality * top;
  l.frequency = top;
  return l;
}

static double observed(const lab_motion *m, pendres_fit_observable o)
{
  return o == PENDRES_FIT_AMPLITUDE ? m->amplitude
         : o == PENDRES_FIT_RMS     ? m->rms
                                    : hypot(m->cosine, m->sine);
}

/* Measure; frequencies and lengths are in a laboratory's units. */
static void measure(const set *s, double hertz, double volts, uint64_t seed,
                    pendres_fit_datum data[DATA])
{
  const lab l = lab_of(s);
  const double shift = l.frequency - 1.0;
  const double wide = 6.0 / s->quality + 0.3 * fabs(shift);
  const double low = s->low > 0.0 ? s->low : fmin(1.0, l.frequency) - wide;
  const double high = s->high > 0.0 ? s->high : fmax(1.0, l.frequency) + wide;
  double frequency[SWEEP], largest = 0.0;
  lab_motion m[SWEEP];
  for (int way = 0; way < 2; way++) {
    for (int i = 0; i < SWEEP; i++)
      frequency[i] =
        fmax(low, 0.35) + (high - fmax(low, 0.35)) * (way ? SWEEP - 1 - i : i) / (SWEEP - 1);
    assert_int_equal(lab_sweep(l, SWEEP, frequency, m), SWEEP);
    for (int i = 0; i < SWEEP; i++) {
      data[way * SWEEP + i] = (pendres_fit_datum){
        .observable = s->observable, .direction = way ? -1 : 1, .axis = hertz * frequency[i],
        .observed = volts * observed(&m[i], s->observable)};
      largest = fmax(largest, data[way * SWEEP + i].observed);
    }
  }
  for (int i = 0; i < DATA; i++) {
    data[i].error = s->noise * largest;
    data[i].observed += data[i].error * lab_normal(&seed);
  }
}

static void check_value(const pendres_fit *fit, size_t i, double truth)
{
  const double error = sqrt(pendres_fit_covariance(fit, i, i));
  const double pull = (pendres_fit_value(fit, i) - truth) / error;
  if (!(fabs(pull) < farthest_pull))
    fail_msg("unknown %zu is %.10g +- %.2g, not %.10g", i, pendres_fit_value(fit, i), error, truth);
}

/* Without any guess. */
static void sets_of_data(void **state)
{
  (void)state;
  static const set sets[] = {
    {.quality = 20.0, .noise = 0.01, .bent = 4.0, .observable = PENDRES_FIT_FIRST_HARMONIC},
    {.soft = 1, .quality = 40.0, .noise = 0.02, .bent = 4.0, .observable = PENDRES_FIT_RMS},
    {.sine = 1, .quality = 30.0, .noise = 0.01, .bent = 4.0, .observable = PENDRES_FIT_AMPLITUDE},
    {.quality = 5000.0, .noise = 0.003, .bent = 8.0, .observable = PENDRES_FIT_AMPLITUDE},
    {.soft = 1, .quality = 1000.0, .noise = 0.03, .bent = 6.0, .observable = PENDRES_FIT_RMS},
    {.sine = 1, .quality = 2000.0, .noise = 0.002, .bent = 3.0,
     .observable = PENDRES_FIT_FIRST_HARMONIC},
    {.quality = 6.0, .noise = 0.02, .bent = 0.5, .observable = PENDRES_FIT_FIRST_HARMONIC}};
  pendres_context *ctx = context();
  for (size_t k = 0; k < COUNT(sets); k++) {
    pendres_fit_datum data[DATA];
    pendres_fit *fit = NULL;
    const lab l = lab_of(&sets[k]);
    const double hertz = l.sine ? 2500.0 : 1.0, volts = l.sine ? 0.03 : 1.0;
    measure(&sets[k], hertz, volts, 77 + k, data);
    pendres_fit_unknown open[OPEN] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                      {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = NAN},
                                      {.quantity = PENDRES_A1, .guess = NAN},
                                      {.quantity = PENDRES_A3, .guess = NAN}};
    pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = OPEN,
                               .unknown = open};
    if (l.sine) {
      model.pendulum.force = PENDRES_FORCE_PENDULUM;
      open[2].quantity = PENDRES_FIT_FREQUENCY_SCALE;
      open[3].quantity = PENDRES_FIT_AMPLITUDE_SCALE;
    }
    const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                  .other = PENDRES_PARAMETER_COUNT};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    const pendres_fit_summary s = pendres_fit_summary_get(fit);
    assert_true(s.converged && s.determined && s.probability > least_probability);
    check_value(fit, 0, l.damping);
    check_value(fit, 1, l.drive);
    check_value(fit, 2, l.sine ? hertz : l.a1);
    check_value(fit, 3, l.sine ? volts : l.a3);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* Two of the unknowns are one where the response is linear: a reading is drive times scale. */
static void open_combination(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  pendres_fit_datum data[SWEEP];
  pendres_fit *fit = NULL;
  for (int i = 0; i < SWEEP; i++) {
    const double w = 0.5 + 1.0 * i / (SWEEP - 1), d = 1.0 - w * w;
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_AMPLITUDE, .direction = 1, .axis = w,
                                  .observed = 0.3 / sqrt(d * d + 0.04 * w * w), .error = 0.01};
  }
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.15},
                                      {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = 0.2},
                                      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = 2.0}};
  pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}},
    .unknowns = 3, .unknown = open};
  const pendres_fit_data all = {.n = SWEEP, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  assert_int_equal(pendres_fit_summary_get(fit).determined, 0);
  assert_non_null(strstr(pendres_fit_note_get(fit, 0), "drive_amplitude"));
  assert_non_null(strstr(pendres_fit_note_get(fit, 0), "amplitude_scale"));
  check_near(pendres_fit_value(fit, 0), 0.2, 1e-5); /* exact data: the model's own error */
  assert_true(isinf(pendres_fit_covariance(fit, 1, 1)));
  pendres_fit_free(fit);
  /* Without one of them the other is known, and a prior does as well. */
  pendres_fit_unknown told[] = {open[0], open[1], open[2]};
  told[2].prior = 1.0;
  told[2].prior_error = 0.01;
  model.unknown = told;
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  assert_int_equal(pendres_fit_summary_get(fit).determined, 1);
  check_near(pendres_fit_value(fit, 1), 0.3, 1e-4);
  check_near(sqrt(pendres_fit_covariance(fit, 2, 2)), 0.01, 1e-4);
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

/* The linear response about frequency 1 with damping 0.2 and drive 0.3, 1 % errors. */
static void linear_response(pendres_fit_datum data[SWEEP], pendres_fit_observable o)
{
  for (int i = 0; i < SWEEP; i++) {
    const double w = 0.5 + 1.0 * i / (SWEEP - 1), d = 1.0 - w * w, e = 0.2 * w;
    const double part = o == PENDRES_FIT_AMPLITUDE  ? 1.0
                        : o == PENDRES_FIT_IN_PHASE ? d / hypot(d, e)
                                                    : e / hypot(d, e);
    data[i] = (pendres_fit_datum){.observable = o, .direction = 1, .axis = w, .error = 0.01,
                                  .observed = part * 0.3 / hypot(d, e)};
  }
}

static const pendres_fit_model linear_model = {
  .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}}};

/* A lag that the instrument adds turns both quadratures: cos and sin of lag + 0.4. */
static void turned_phase(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  pendres_fit_datum data[2 * SWEEP];
  pendres_fit *fit = NULL;
  linear_response(data, PENDRES_FIT_IN_PHASE);
  linear_response(data + SWEEP, PENDRES_FIT_QUADRATURE);
  for (int i = 0; i < SWEEP; i++) {
    const double x = data[i].observed, y = data[SWEEP + i].observed;
    data[i].observed = x * cos(0.4) - y * sin(0.4);
    data[SWEEP + i].observed = x * sin(0.4) + y * cos(0.4);
  }
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.25},
                                      {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = 0.25},
                                      {.quantity = PENDRES_FIT_PHASE_OFFSET, .guess = 0.0}};
  pendres_fit_model model = linear_model;
  model.unknowns = 3;
  model.unknown = open;
  const pendres_fit_data all = {.n = 2 * SWEEP, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  check_near(pendres_fit_value(fit, 0), 0.2, 1e-5); /* exact data: the model's own error */
  check_near(pendres_fit_value(fit, 1), 0.3, 1e-5);
  check_near(pendres_fit_value(fit, 2), 0.4, 1e-5);
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

/* Six data are 40 errors too high. Their squares move the fit by many errors; by Huber's loss each
   pulls like a datum two errors away. Chi-square is the sum of that loss. */
static void outliers(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  pendres_fit_datum data[SWEEP];
  double away[2];
  linear_response(data, PENDRES_FIT_AMPLITUDE);
  for (int i = 22; i < 40; i += 3) data[i].observed += 0.4;
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.2},
                                      {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = 0.3}};
  pendres_fit_model model = linear_model;
  model.unknowns = 2;
  model.unknown = open;
  const pendres_fit_data all = {.n = SWEEP, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  for (int soft = 0; soft < 2; soft++) {
    const double bend = 2.0;
    pendres_fit *fit = NULL;
    const pendres_fit_options options = {.huber = soft ? bend : 0.0};
    const pendres_status status = pendres_fit_find(ctx, &all, &model, &options, &fit);
    assert_int_equal(status, soft ? PENDRES_OK : PENDRES_NOT_CONVERGED); /* no such chi-square */
    double sum = 0.0;
    for (size_t i = 0; i < SWEEP; i++) {
      const double r = fabs(pendres_fit_point_get(fit, i)->residual) / 0.01;
      sum += soft && r > bend ? bend * (2.0 * r - bend) : r * r;
    }
    check_near(pendres_fit_summary_get(fit).chi_square, sum, 1e-9 * sum);
    /* By the errors of the data, not by their scatter. */
    const double scatter = soft ? 1.0 : sqrt(sum / (SWEEP - 2));
    away[soft] = scatter * fabs(pendres_fit_value(fit, 1) - 0.3) /
                 sqrt(pendres_fit_covariance(fit, 1, 1));
    pendres_fit_free(fit);
  }
  if (!(away[0] > 5.0 && away[1] < 1.0)) fail_msg("%g and %g errors", away[0], away[1]);
  pendres_context_free(ctx);
}

/* Chi-square is that of the data and of the jumps, each from the middle of its gap in units of the
   gap over the root of 12 and the error of jumps together. */
static void jumps_count(void **state)
{
  (void)state;
  static const set swept = {.quality = 20.0, .noise = 0.01, .bent = 4.0,
                            .observable = PENDRES_FIT_FIRST_HARMONIC};
  pendres_context *ctx = context();
  pendres_fit_datum data[DATA];
  measure(&swept, 1.0, 1.0, 77, data);
  const lab l = lab_of(&swept);
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = l.damping},
                                      {.quantity = PENDRES_A3, .guess = l.a3}};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0},
                 .drive_amplitude = l.drive}, .unknowns = 2, .unknown = open};
  const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  for (int k = 0; k < 2; k++) {
    pendres_fit *fit = NULL;
    const pendres_fit_options options = {.jump_error = 0.02 * k};
    double sum = 0.0;
    size_t jumps = 0;
    check_ok(pendres_fit_find(ctx, &all, &model, &options, &fit));
    for (size_t i = 0; i < DATA; i++)
      sum += pow(pendres_fit_point_get(fit, i)->residual / data[i].error, 2.0);
    for (const pendres_fit_jump *j; (j = pendres_fit_jump_get(fit, jumps)) != NULL; jumps++) {
      const double middle = 0.5 * (j->measured[0] + j->measured[1]);
      const double scale =
        hypot((j->measured[1] - j->measured[0]) / sqrt(12.0), options.jump_error);
      sum += pow((j->value - middle) / scale, 2.0);
    }
    assert_int_equal(jumps, 2);
    check_near(pendres_fit_summary_get(fit).chi_square, sum, 1e-9 * sum);
    assert_true(pendres_fit_summary_get(fit).degrees_of_freedom == DATA + 2 - 2);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* Amplitudes over the drive alone do not tell a spring that stiffens, driven above its frequency,
   from one that softens, driven below: both are found, and the caller's guess decides. */
static void twins(void **state)
{
  (void)state;
  pendres_context *ctx = context();
  lab l = {.a1 = 1.0, .a3 = 1.0, .damping = 0.05, .frequency = 1.25};
  double drive[SWEEP];
  lab_motion m[SWEEP];
  pendres_fit_datum data[SWEEP];
  uint64_t seed = 7;
  for (int i = 0; i < SWEEP; i++) drive[i] = 0.25 * (i + 1) / SWEEP;
  assert_int_equal(lab_sweep_of(&l, &l.drive, SWEEP, drive, m), SWEEP);
  for (int i = 0; i < SWEEP; i++)
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_RMS, .direction = 1, .axis = drive[i],
                                  .observed = m[i].rms + 0.01 * lab_normal(&seed), .error = 0.01};
  const pendres_fit_data all = {.n = SWEEP, .datum = data, .axis = PENDRES_DRIVE_AMPLITUDE,
                                .other = PENDRES_PARAMETER_COUNT};
  for (int guessed = CHECK_SHORT; guessed < 2; guessed++) {
    pendres_fit *fit = NULL;
    const pendres_fit_unknown open[] = {
      {.quantity = PENDRES_DAMPING, .guess = guessed ? 1.1 * l.damping : NAN},
      {.quantity = PENDRES_A1, .guess = guessed ? 1.1 : NAN},
      {.quantity = PENDRES_A3, .guess = guessed ? 1.1 : NAN}};
    const pendres_fit_model model = {
      .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .drive_frequency = l.frequency},
      .unknowns = 3, .unknown = open};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    assert_non_null(pendres_fit_note_get(fit, 0));
    assert_non_null(strstr(pendres_fit_note_get(fit, 0), "other values fit about as well"));
    for (size_t i = 0; i < 3 && guessed; i++)
      check_value(fit, i, (double[]){l.damping, l.a1, l.a3}[i]);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* The first start that converges comes to a resonance that bends less, with 40 times the
   chi-square, where data scatter about the fit six times as much as neighbours do, which a note
   tells. So all starts are followed, whether the errors of data are known or not. */
static void first_is_wrong(void **state)
{
  (void)state;
  static const set swept = {.quality = 1405.1612335939737, .noise = 0.026593115608134026,
                            .bent = 10.939409375563947, .observable = PENDRES_FIT_RMS,
                            .low = 0.99386266451956717, .high = 1.0089211935273812};
  pendres_context *ctx = context();
  pendres_fit_datum data[DATA];
  measure(&swept, 1.0, 1.0, 7681369315912567875u, data);
  const lab l = lab_of(&swept);
  const double truth[OPEN] = {l.damping, l.drive, l.a1, l.a3}, error = data[0].error;
  const pendres_fit_unknown open[OPEN] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                          {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = NAN},
                                          {.quantity = PENDRES_A1, .guess = NAN},
                                          {.quantity = PENDRES_A3, .guess = NAN}};
  const pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = OPEN,
                                   .unknown = open};
  const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  static const struct { int known, starts; } how[] = {{1, 0}, {0, 0}, {0, FIRST}};
  for (size_t k = CHECK_SHORT ? 2 : 0; k < COUNT(how); k++) {
    pendres_fit *fit = NULL;
    const pendres_fit_options options = {.starts = how[k].starts};
    double sum = 0.0;
    for (int i = 0; i < DATA; i++) data[i].error = how[k].known ? error : 0.0;
    check_ok(pendres_fit_find(ctx, &all, &model, &options, &fit));
    for (size_t i = 0; i < DATA; i++)
      sum += pow(pendres_fit_point_get(fit, i)->residual / error, 2.0) / DATA;
    const char *said = pendres_fit_note_get(fit, 0);
    const int few = how[k].starts > 0;
    assert_int_equal(said != NULL && strstr(said, "as much as neighbours") != NULL, few);
    assert_true(few == (sum > 10.0));
    for (size_t i = 0; i < OPEN && !few; i++) check_value(fit, i, truth[i]);
    if (!few) check_near(sum, 1.0, 0.5); /* of 120, four standard deviations */
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(sets_of_data),
                                     cmocka_unit_test(first_is_wrong),
                                     cmocka_unit_test(open_combination),
                                     cmocka_unit_test(turned_phase), cmocka_unit_test(outliers),
                                     cmocka_unit_test(jumps_count), cmocka_unit_test(twins)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
