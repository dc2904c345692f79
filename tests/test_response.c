/*
 * test_response.c -- the mean response of an ensemble against members integrated one by one, by a
 * classical Runge-Kutta method that shares nothing with the library, and averaged sample by sample.
 */
#include "analysis/resonance/response_parts.h"
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "states_fixture.h"

enum {
  MEMBERS = 20,
  STEPS = 4000,  /* a period */
  SETTLING = 70, /* periods: exp(-0.06 * 8 * 70) = 3e-15 of the start is left */
};

/* Where two states coexist, and starts end up in several wells. */
static const pendres_pendulum two_states = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962};

static void step(const pendres_pendulum *p, int k, double *y, double *v)
{
  const double h = 2.0 * pi / p->drive_frequency / STEPS;
  double a[4], u[4];
  for (int i = 0; i < 4; i++) {
    const double c = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5;
    const double at = i == 0 ? *y : *y + c * h * u[i - 1];
    u[i] = i == 0 ? *v : *v + c * h * a[i - 1];
    a[i] = -sin(at) - p->damping * u[i] +
           p->drive_amplitude * cos(2.0 * pi * (k + c) / STEPS);
  }
  *y += h / 6.0 * (u[0] + 2.0 * u[1] + 2.0 * u[2] + u[3]);
  *v += h / 6.0 * (a[0] + 2.0 * a[1] + 2.0 * a[2] + a[3]);
}

/* A settled member's angle over one period, in its own well; returns the well. */
static long follow(const pendres_pendulum *p, double x, double v, double *loop)
{
  double y = x - 0.5 * pi, mean = 0.0;
  for (int n = 0; n < SETTLING * STEPS; n++) step(p, n % STEPS, &y, &v);
  for (int k = 0; k < STEPS; k++) {
    loop[k] = y;
    mean += y / STEPS;
    step(p, k, &y, &v);
  }
  const double well = rint(mean / (2.0 * pi));
  for (int k = 0; k < STEPS; k++) loop[k] -= 2.0 * pi * well;
  return (long)well;
}

/* Half peak to peak, peaks by a parabola through the highest three samples. */
static double half_range(const double *loop)
{
  double peak[2] = {-INFINITY, -INFINITY};
  for (int side = 0; side < 2; side++)
    for (int k = 0; k < STEPS; k++) {
      const double s = side == 0 ? 1.0 : -1.0;
      const double a = s * loop[(k + STEPS - 1) % STEPS], b = s * loop[k];
      const double c = s * loop[(k + 1) % STEPS];
      if (b < a || b < c) continue;
      peak[side] = fmax(peak[side], b + (a - c) * (a - c) / (8.0 * (2.0 * b - a - c)));
    }
  return 0.5 * (peak[0] + peak[1]);
}

static void harmonic(const double *loop, double *cosine, double *sine)
{
  *cosine = *sine = 0.0;
  for (int k = 0; k < STEPS; k++) {
    *cosine += 2.0 / STEPS * loop[k] * cos(2.0 * pi * k / STEPS);
    *sine += 2.0 / STEPS * loop[k] * sin(2.0 * pi * k / STEPS);
  }
}

typedef struct averages {
  double loop[STEPS];
  double amplitude, area; /* means of the members' own */
  int small, wells;       /* members with small amplitude; different wells */
} averages;

static void average(const pendres_pendulum *p, const pendres_ensemble *e, averages *out)
{
  double loop[STEPS];
  long well[MEMBERS];
  *out = (averages){.wells = 0};
  for (int m = 0; m < MEMBERS; m++) {
    double cosine, sine;
    int seen = 0;
    well[m] = follow(p, member_x(e, (size_t)m + 1), e->v, loop);
    for (int i = 0; i < m; i++) seen |= well[i] == well[m];
    out->wells += !seen;
    harmonic(loop, &cosine, &sine);
    for (int k = 0; k < STEPS; k++) out->loop[k] += loop[k] / MEMBERS;
    out->amplitude += half_range(loop) / MEMBERS;
    out->area += pi * p->drive_amplitude * sine / MEMBERS;
    out->small += half_range(loop) < 1.0;
  }
}

/*
 * What the test itself is off by: with twice the STEPS averages change by 8e-11, with half of them
 * by five times that. The rest is the promise, ten times the errors claimed.
 */
static void members_one_by_one(void **state)
{
  const pendres_ensemble e = {.members = MEMBERS, .x_first = -0.5 * pi, .x_last = 1.5 * pi,
                              .v = 1.7};
  averages want;
  pendres_context *ctx = NULL;
  pendres_response r;
  double cosine, sine;
  (void)state;
  average(&two_states, &e, &want);
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, 1, &two_states, &e, &r));
  pendres_context_free(ctx);

  /* Both states and several wells, else this says little. */
  assert_true(want.small > 2 && want.small < MEMBERS - 2 && want.wells > 1);
  assert_int_equal(r.unresolved, 0);
  check_near(r.sa_fraction, (double)want.small / MEMBERS, 1e-12);
  check_near(r.la_fraction, 1.0 - r.sa_fraction, 1e-12);
  check_near(r.mean_loop_amplitude, half_range(want.loop),
             2e-10 + 10.0 * r.mean_loop_amplitude_error);
  check_near(r.mean_amplitude, want.amplitude, 2e-10 + 10.0 * r.mean_amplitude_error);
  harmonic(want.loop, &cosine, &sine);
  check_near(r.phase_lag, atan2(sine, cosine), 2e-10 + 10.0 * r.phase_lag_error);
  check_near(r.mean_loop_area, want.area, 2e-10 + 10.0 * r.mean_loop_area_error);
  check_near(r.mean_power, want.area * two_states.drive_frequency / (2.0 * pi),
             2e-10 + 10.0 * r.mean_power_error);
  /* No estimate hides a disagreement. */
  assert_true(r.mean_loop_amplitude_error < 1e-8 && r.phase_lag_error < 1e-8);
  /* The two states are out of step: their mean loop is smaller than the mean of their loops. */
  assert_true(r.mean_loop_amplitude < 0.95 * r.mean_amplitude);
}

/* One state alone: averages are its own measures, as the long double reference has them. */
static void one_state(void **state)
{
  const pendres_pendulum p = {.damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.9};
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_context *ctx = NULL;
  pendres_response r;
  reference_cycle cycle;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, 1, &p, &e, &r));
  pendres_context_free(ctx);
  assert_int_equal(r.states, 1);
  assert_int_equal(r.state_members[0], e.members);
  const pendres_orbit *o = &r.state[0].orbit;
  check_ok(reference_orbit(&p, o->x - 0.5 * pi, o->v, 1, 0, &cycle));
  check_near(r.mean_loop_area, (double)cycle.loop_area, 10.0 * r.mean_loop_area_error);
  check_near(r.mean_loop_amplitude, (double)cycle.amplitude, 10.0 * r.mean_loop_amplitude_error);
  check_near(r.mean_amplitude, (double)cycle.amplitude, 10.0 * r.mean_amplitude_error);
  check_near(r.phase_lag, (double)cycle.phase_lag, 10.0 * r.phase_lag_error);
  check_near(r.mean_power, (double)cycle.mean_power, 10.0 * r.mean_power_error);
}

/*
 * A slow strong drive, whose loop has hundreds of harmonics: all members are on one state, and its
 * amplitude is that of the averaged loop, 70.697454443115 in extended precision.
 */
static void slow_drive(void **state)
{
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 2.0, .drive_frequency = 0.05};
  const pendres_ensemble e = {.members = 4, .x_first = -0.5 * pi, .x_last = 1.5 * pi};
  pendres_context *ctx = NULL;
  pendres_response r;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, 1, &p, &e, &r));
  pendres_context_free(ctx);
  assert_int_equal(r.states, 1);
  check_near(r.mean_loop_amplitude, 70.697454443115, r.mean_loop_amplitude_error + 1e-12);
  check_near(r.mean_loop_amplitude, r.mean_amplitude, 0.0);
  assert_true(r.mean_loop_amplitude_error < 1e-8);
}

/*
 * The average of two loops of many harmonics, of a fast and a slow orbit here so that there are
 * two, against samples of both: 0.03 apart in time, and a parabola errs by that to the fourth.
 * Without a context harmonics are cut, and the error says by how much.
 */
static void loops_of_many_harmonics(void **state)
{
  enum { COUNT = STEPS };
  pendres_orbit_guess g[] = {{{0.5, 2.0, 0.05, 0.0}, 0.5 * pi, 0.0, 1, 0},
                             {{0.08, 0.95, 0.2, 0.0}, 0.5 * pi, 0.0, 1, 0}};
  pendres_response r = {.states = 2, .state_members = {1, 3}};
  pendres_context *ctx = NULL;
  pendres_orbit o[2];
  pendres_status outcome[2];
  static double x[COUNT], loop[COUNT];
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int i = 0; i < 2; i++)
    check_ok(pendres_strobe_advance(ctx, 1, &g[i].pendulum, &g[i].x, &g[i].v, 40, NULL));
  check_ok(pendres_orbit_find(ctx, 2, g, PENDRES_ORBIT_PLAIN, o, outcome));
  for (int i = 0; i < 2; i++) {
    assert_int_not_equal(outcome[i], PENDRES_NOT_CONVERGED);
    r.state[i].label = PENDRES_LABEL_PERIODIC;
    r.state[i].orbit = o[i];
    check_ok(pendres_orbit_sample(ctx, &o[i], COUNT, x, NULL, NULL));
    for (int k = 0; k < COUNT; k++)
      loop[k] = i == 0 ? 0.25 * x[k] : loop[k] + 0.75 * x[k];
  }
  pendres_response_average(&r);
  const double cut = r.mean_loop_amplitude, cut_error = r.mean_loop_amplitude_error;
  check_ok(pendres_response_renew(ctx, &r));
  check_near(r.mean_loop_amplitude, half_range(loop), 1e-6);
  assert_true(r.mean_loop_amplitude_error < 1e-8);
  assert_true(fabs(cut - r.mean_loop_amplitude) > 1e-4);
  check_near(cut, r.mean_loop_amplitude, cut_error);
  pendres_context_free(ctx);
}

/* Parameter sets side by side do not influence each other. */
static void side_by_side(void **state)
{
  enum { SETS = 40 };
  const pendres_ensemble e = {.members = MEMBERS, .x_first = -0.5 * pi, .x_last = 1.5 * pi};
  pendres_pendulum p[SETS];
  pendres_response together[SETS], alone;
  pendres_context *ctx = NULL;
  (void)state;
  for (int i = 0; i < SETS; i++) {
    p[i] = two_states;
    p[i].damping = 0.1 + 0.005 * i;
  }
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, SETS, p, &e, together));
  for (int i = 0; i < SETS; i += 13) {
    check_ok(pendres_response_find(ctx, 1, &p[i], &e, &alone));
    check_near(together[i].mean_loop_area, alone.mean_loop_area, 0.0);
    check_near(together[i].mean_loop_amplitude, alone.mean_loop_amplitude, 0.0);
    check_near(together[i].phase_lag, alone.phase_lag, 0.0);
    check_near(together[i].sa_fraction, alone.sa_fraction, 0.0);
  }
  pendres_context_free(ctx);
}

/*
 * Members that may belong to another state are counted where they were found, and every error
 * allows for their moving: the loop area by the difference of the two states, shares by one.
 */
static void doubts_count(void **state)
{
  const pendres_ensemble e = {.members = MEMBERS, .x_first = -0.5 * pi, .x_last = 1.5 * pi,
                              .v = 1.7};
  pendres_context *ctx = NULL;
  pendres_response r, moved;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_find(ctx, 1, &two_states, &e, &r));
  pendres_context_free(ctx);
  assert_int_equal(r.uncertain, 0);
  assert_int_equal(r.states, 2);
  moved = r;
  moved.state_members[0] += 3;
  moved.state_members[1] -= 3;
  pendres_response_average(&moved);
  const pendres_response certain = r;
  r.uncertain = 3;
  pendres_response_average(&r);
  /* The same members, so the same means: to the last bit. */
  check_near(r.mean_loop_area, certain.mean_loop_area, 0.0);
  const double share = 3.0 / MEMBERS;
  /* Errors of the orbits stand beside the doubts: 1e-10 or less. */
  check_near(r.sa_fraction_error, share, 1e-12);
  check_near(r.mean_loop_area_error,
             share * fabs(r.state[1].orbit.loop_area - r.state[0].orbit.loop_area), 1e-9);
  /* What three members that move change lies within. */
  assert_true(fabs(moved.mean_loop_area - r.mean_loop_area) <= r.mean_loop_area_error);
  assert_true(fabs(moved.mean_power - r.mean_power) <= r.mean_power_error);
  assert_true(fabs(moved.mean_amplitude - r.mean_amplitude) <= r.mean_amplitude_error);
  assert_true(fabs(moved.mean_loop_amplitude - r.mean_loop_amplitude) <=
              r.mean_loop_amplitude_error);
  assert_true(fabs(moved.phase_lag - r.phase_lag) <= r.phase_lag_error);
}

/*
 * More attractors than are listed: all members count in the means, and none as unresolved. Areas
 * and members are small whole numbers, so that the mean is exact but for a few roundings.
 */
static void more_than_are_listed(void **state)
{
  enum { ATTRACTORS = 12, ALL = ATTRACTORS * (ATTRACTORS + 1) / 2 + 3 };
  static pendres_attractor attractors[ATTRACTORS];
  static pendres_settled outcome[ALL];
  static signed char where[ALL];
  pendres_context *ctx = NULL;
  pendres_response r;
  double area = 0.0, most = 0.0;
  size_t n = 0;
  (void)state;
  for (int a = 0; a < ATTRACTORS; a++) {
    attractors[a].label = a == 0 ? PENDRES_LABEL_SA : PENDRES_LABEL_PERIODIC;
    attractors[a].orbit = (pendres_orbit){.pendulum = two_states, .period = 1,
                                          .loop_area = 3.0 + a, .mean_power = 1.0, .amplitude = 2.0,
                                          .cosine = {2.0}};
    most = fmax(most, attractors[a].orbit.loop_area);
    for (int k = 0; k <= a; k++) {
      outcome[n++] = (pendres_settled){.attractor = a, .certain = 1};
      area += attractors[a].orbit.loop_area;
    }
  }
  const size_t settled = n;
  while (n < ALL) outcome[n++] = (pendres_settled){.attractor = -1};
  const pendres_attractor_set c = {.pendulum = two_states, .count = ATTRACTORS,
                               .attractors = attractors};
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_response_summarize(ctx, &c, n, outcome, where, &r));
  pendres_context_free(ctx);
  assert_int_equal(r.states, PENDRES_RESPONSE_STATES);
  assert_int_equal(r.unresolved, 3);
  assert_int_equal(r.unlisted, 1 + 2 + 3 + 4);
  /* Those with the most members, in their own order. */
  for (size_t i = 0; i < r.states; i++) assert_int_equal(r.state_members[i], 5 + i);
  assert_int_equal(where[0], -1);
  assert_int_equal(where[10], 0);
  assert_int_equal(where[settled - 1], PENDRES_RESPONSE_STATES - 1);
  assert_int_equal(where[settled], -1);
  check_near(r.mean_loop_area, area / (double)settled, 1e-13);
  check_near(r.mean_loop_area_error, 3.0 / ALL * most, 1e-13);
  check_near(r.sa_fraction, 1.0 / ALL, 1e-15);
  check_near(r.mean_amplitude, 2.0, 1e-14);
  /* From what is listed alone the others can be anywhere. */
  pendres_response_average(&r);
  check_near(r.mean_loop_area_error, (3.0 + 10.0) / ALL * most, 1e-13);
}

/* Under a torque a weak drive meets an oscillator of stiffness cos(asin I), y'' + gamma y' + k
   y. */
static void torque(void **state)
{
  enum { N = 3 };
  const double frequency = 0.7, drive = 1e-4, damping = 0.2;
  const pendres_ensemble e = {.members = 4, .x_first = 1.5, .x_last = 2.5};
  pendres_pendulum p[N];
  pendres_response r[N];
  pendres_context *ctx = NULL;
  (void)state;
  for (int i = 0; i < N; i++)
    p[i] = (pendres_pendulum){.damping = damping, .drive_amplitude = drive,
                              .drive_frequency = frequency, .torque = 0.3 * i};
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-11}, &ctx));
  check_ok(pendres_response_find(ctx, N, p, &e, r));
  check_ok(pendres_response_label(ctx, N, r));
  for (int i = 0; i < N; i++) {
    const double k = sqrt(1.0 - p[i].torque * p[i].torque);
    const double in = k - frequency * frequency, out = damping * frequency;
    /* What is left out is quadratic in the amplitude. */
    check_near(r[i].mean_loop_amplitude, drive / hypot(in, out), 1e-3 * drive);
    check_near(r[i].phase_lag, atan2(out, in), 1e-3);
    check_near(r[i].mean_loop_area, pi * drive * drive * out / (in * in + out * out),
               1e-3 * drive * drive);
    assert_true(i == 0 || isnan(r[i].sa_fraction));
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(members_one_by_one),
    cmocka_unit_test(one_state),            cmocka_unit_test(slow_drive),
    cmocka_unit_test(loops_of_many_harmonics),
    cmocka_unit_test(side_by_side),
    cmocka_unit_test(more_than_are_listed),
    cmocka_unit_test(doubts_count),         cmocka_unit_test(torque),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
