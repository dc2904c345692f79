/*
 * test_fit_junction.c -- currents and voltages of junctions: fits to mean velocities that another
 * integration made, classical Runge-Kutta steps of y'' + g y' + sin y = I.
 *
 * Tolerances: a value is within four and a half standard errors (one normal number in 150,000 is
 * not), a chi-square has a probability above 1e-5. Seeds are fixed.
 */
#include "fit_fixture.h"
#include "check.h"

#include <pendres/pendres.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

enum { SWEEP = 40, DATA = 2 * SWEEP, OPEN = 4 };

static const double critical_current = 13e-6, volts = 21e-6, shift = 3e-6; /* A, V, V */

typedef struct motion {
  double y, v;
} motion;

static void advance(double damping, double torque, double h, motion *m)
{
  const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double dy = 0.0, dv = 0.0;
  motion sum = {0.0, 0.0};
  for (int i = 0; i < 4; i++) {
    const double y = m->y + part[i] * h * dy, v = m->v + part[i] * h * dv;
    dy = v;
    dv = torque - sin(y) - damping * v;
    sum.y += weight[i] * dy;
    sum.v += weight[i] * dv;
  }
  m->y += h / 6.0 * sum.y;
  m->v += h / 6.0 * sum.v;
}

/* The torque goes slowly from one value to the next, as a jolt might free the junction early; after
   that deviations become smaller by exp(-25). Then over two turns; 0 where there are none for
   long. Crossings are placed by secants: their error is less than 1e-4 of a turn. */
static double mean_velocity(double damping, double before, double torque, motion *m)
{
  const double h = 0.02, way = 12.0 / damping + 60.0, wait = 25.0 / damping + 50.0;
  const double patience = 500.0, turn = torque < 0.0 ? -2.0 * lab_pi : 2.0 * lab_pi;
  double crossed[3];
  int turns = 0;
  for (double t = 0.0; t < way + wait; t += h) {
    const double part = fmin(1.0, t / way);
    advance(damping, before + (torque - before) * part * part * (3.0 - 2.0 * part), h, m);
  }
  m->y = remainder(m->y, 2.0 * lab_pi);
  for (double t = 0.0; t < patience && turns < 3; t += h) {
    const motion last = *m;
    advance(damping, torque, h, m);
    if (m->y / turn < 0.5) continue;
    crossed[turns++] = t + h * (0.5 * turn - last.y) / (m->y - last.y);
    m->y -= turn;
  }
  return turns < 3 ? 0.0 : 2.0 * turn / (crossed[2] - crossed[0]);
}

/* A junction swept up and down, from `low` critical currents to `high`. */
typedef struct set {
  double damping, low, high, noise;
} set;

static void measure(const set *s, uint64_t seed, pendres_fit_datum data[DATA])
{
  motion m = {0.0, 0.0};
  double largest = 0.0, before = 0.0;
  for (int k = 0; k < DATA; k++) {
    const int i = k < SWEEP ? k : DATA - 1 - k;
    const double torque = s->low + (s->high - s->low) * i / (SWEEP - 1);
    const double v = mean_velocity(s->damping, before, torque, &m);
    before = torque;
    data[k] = (pendres_fit_datum){.observable = PENDRES_FIT_MEAN_VELOCITY,
                                  .direction = k < SWEEP ? 1 : -1,
                                  .axis = critical_current * torque, .observed = volts * v + shift};
    largest = fmax(largest, volts * fabs(v));
  }
  for (int k = 0; k < DATA; k++) {
    data[k].error = s->noise * largest;
    data[k].observed += data[k].error * lab_normal(&seed);
  }
}

/* Without any guess: damping, critical current, gain and offset. */
static void junctions(void **state)
{
  (void)state;
  static const set sets[] = {{0.3, 0.0, 1.7, 0.005}, {0.08, 0.01, 1.4, 0.003},
                             {0.5, -1.5, 1.6, 0.01}};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (size_t k = 0; k < COUNT(sets); k++) {
    pendres_fit_datum data[DATA];
    pendres_fit *fit = NULL;
    measure(&sets[k], 20 + k, data);
    const double truth[OPEN] = {sets[k].damping, 1.0 / critical_current, volts, shift};
    const pendres_fit_unknown open[OPEN] = {
      {.quantity = PENDRES_DAMPING, .guess = NAN},
      {.quantity = PENDRES_FIT_TORQUE_SCALE, .guess = NAN},
      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = NAN},
      {.quantity = PENDRES_FIT_OFFSET, .guess = NAN}};
    const pendres_fit_model model = {.unknowns = OPEN, .unknown = open};
    const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_TORQUE,
                                  .other = PENDRES_PARAMETER_COUNT};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    const pendres_fit_summary s = pendres_fit_summary_get(fit);
    assert_true(s.converged && s.determined && s.probability > 1e-5);
    for (size_t i = 0; i < OPEN; i++) {
      const double error = sqrt(pendres_fit_covariance(fit, i, i));
      const double pull = (pendres_fit_value(fit, i) - truth[i]) / error;
      /* The second set tells the damping to a tenth by its profile, to 9.7 % by derivatives. */
      if (!(fabs(pull) < 4.5) || !(error < 0.11 * truth[i]))
        fail_msg("set %zu, unknown %zu: %g +- %g, not %g", k, i, pendres_fit_value(fit, i), error,
                 truth[i]);
    }
    /* Downwards it stops where rotations end, about 4 damping / pi, upwards at 1. */
    double ends[2] = {NAN, NAN};
    const pendres_fit_jump *j;
    for (size_t i = 0; (j = pendres_fit_jump_get(fit, i)) != NULL; i++)
      if (j->value > 0.0) ends[j->direction > 0] = j->value / critical_current;
    pendres_rotation_onset onset;
    check_ok(pendres_rotation_onset_find(truth[0], &onset));
    check_near(ends[1], 1.0, 0.05);           /* a gap of the widest sweep is 0.08 */
    check_near(ends[0], onset.torque, 0.05);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

/* Strong friction: no jumps, and the velocity is sqrt(I^2 - 1)/damping but for a share of about
   1/damping^2. */
static void no_jumps(void **state)
{
  (void)state;
  pendres_context *ctx = NULL;
  pendres_fit *fit = NULL;
  const double damping = 20.0;
  pendres_fit_datum data[SWEEP];
  check_ok(pendres_context_create(NULL, &ctx));
  for (int i = 0; i < SWEEP; i++) {
    const double torque = 3.0 * i / (SWEEP - 1);
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_MEAN_VELOCITY, .direction = 1,
                                  .axis = torque, .error = 1e-3,
                                  .observed = sqrt(fmax(0.0, torque * torque - 1.0)) / damping};
  }
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_FIT_TORQUE_SCALE, .guess = NAN}};
  const pendres_fit_model model = {.pendulum = {.damping = damping}, .unknowns = 1,
                                   .unknown = open};
  const pendres_fit_data all = {.n = SWEEP, .datum = data, .axis = PENDRES_TORQUE,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
  check_near(pendres_fit_value(fit, 0), 1.0, 1.0 / (damping * damping));
  assert_null(pendres_fit_jump_get(fit, 0));
  pendres_fit_free(fit);
  pendres_context_free(ctx);
}

/* Where nothing jumps, gain and damping may change together: both have no finite error, unless one
   of them has a prior. */
static void gain_or_damping(void **state)
{
  (void)state;
  static const set overdamped = {2.0, 0.0, 2.4, 0.003};
  pendres_context *ctx = NULL;
  pendres_fit_datum data[DATA];
  check_ok(pendres_context_create(NULL, &ctx));
  measure(&overdamped, 7, data);
  for (int held = 0; held < 2; held++) {
    pendres_fit *fit = NULL;
    const pendres_fit_unknown open[OPEN] = {
      {.quantity = PENDRES_DAMPING, .guess = NAN},
      {.quantity = PENDRES_FIT_TORQUE_SCALE, .guess = NAN},
      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = NAN, .prior = volts,
       .prior_error = held ? 0.01 * volts : 0.0},
      {.quantity = PENDRES_FIT_OFFSET, .guess = NAN}};
    const pendres_fit_model model = {.unknowns = OPEN, .unknown = open};
    const pendres_fit_data all = {.n = DATA, .datum = data, .axis = PENDRES_TORQUE,
                                  .other = PENDRES_PARAMETER_COUNT};
    check_ok(pendres_fit_find(ctx, &all, &model, NULL, &fit));
    const double error = sqrt(pendres_fit_covariance(fit, 0, 0));
    assert_int_equal(pendres_fit_summary_get(fit).determined, held);
    assert_int_equal(isfinite(error) != 0, held);
    if (held) check_near(pendres_fit_value(fit, 0), overdamped.damping, 4.5 * error);
    pendres_fit_free(fit);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(junctions), cmocka_unit_test(no_jumps),
                                     cmocka_unit_test(gain_or_damping)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
