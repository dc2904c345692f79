/*
 * test_lyapunov.c -- exponents of many pendulums at once: against what is exact, against orbits
 * found otherwise, and against an integration of the variational equation written here.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/lyapunov.h>
#include <pendres/orbit.h>

#include "context_fixture.h"

static const double two_pi = 6.28318530717958647693;

/* Multipliers of orbits of small amplitude are complex, and their modulus is Liouville's. */
static void weak_drives(void **state)
{
  enum { N = 40 };
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){
      .damping = 0.01 + 0.03 * i, .drive_amplitude = 0.001 * i, .drive_frequency = 0.5 + 0.02 * i};
    x[i] = 1.6;
    v[i] = 0.1;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_PERIODIC);
    assert_true(l[i].period == 1 && l[i].winding == 0 && l[i].rotation == 0.0);
    check_near(l[i].exponent, -0.5 * p[i].damping, l[i].exponent_error + 1e-12);
    assert_true(l[i].exponent_error < 1e-6);
  }
}

/* At rest under a torque, and where a polynomial force has its minimum, the exponent is
   -gamma/2. */
static void other_forces(void **state)
{
  enum { N = 3 };
  const pendres_pendulum p[N] = {
    {.damping = 0.3, .drive_frequency = 1.0, .torque = 0.6},
    {.damping = 0.3, .drive_frequency = 1.0, .torque = -0.6, .parametric_amplitude = 1e-4},
    {.damping = 0.2, .drive_frequency = 0.8, .drive_amplitude = 0.01,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}}};
  /* The last one starts a whole turn of the pendulum away from its left well: no turn is taken
     off. */
  const double x[N] = {1.6, 1.6, -1.0 + two_pi}, v[N] = {0.0};
  pendres_settled l[N];
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_PERIODIC);
    check_near(l[i].exponent, -0.5 * p[i].damping, l[i].exponent_error + 1e-12);
    assert_true(l[i].exponent_error < 1e-6);
  }
}

/* Chaos of the plain pendulum beside that of one with a torque: averages are those of each alone.
   */
static void models_side_by_side(void **state)
{
  enum { N = 2 };
  const pendres_pendulum plain = {.damping = 0.5, .drive_amplitude = 1.2,
                                  .drive_frequency = 2.0 / 3.0};
  pendres_pendulum p[N] = {plain, plain};
  const double x[N] = {1.6, 1.6}, v[N] = {0.0};
  const pendres_lyapunov_options options = {.transient = 40, .periods = 64};
  pendres_settled together[N], alone;
  p[1].torque = 0.05;
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, &options, together));
  for (int i = 0; i < N; i++) {
    check_ok(pendres_lyapunov_find(*state, 1, &p[i], &x[i], &v[i], &options, &alone));
    assert_true(together[i].exponent == alone.exponent);
    assert_int_equal(together[i].label, alone.label);
  }
  assert_true(together[0].exponent != together[1].exponent);
}

/* Periodic, doubled and running orbits, as settling finds them. */
static void orbits(void **state)
{
  static const double drive[] = {0.9, 1.07, 1.081, 1.35, 1.45, 1.47};
  enum { N = sizeof drive / sizeof *drive };
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){
      .damping = 0.5, .drive_amplitude = drive[i], .drive_frequency = 2.0 / 3.0};
    x[i] = 1.8;
    v[i] = 0.1;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    pendres_attractors *set = NULL;
    pendres_settled outcome;
    check_ok(pendres_settle(*state, 1, &p[i], &x[i], &v[i], &outcome, &set));
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
    assert_non_null(a);
    assert_int_equal(l[i].label, a->label);
    assert_int_equal(l[i].period, a->orbit.period);
    assert_int_equal(l[i].winding, a->orbit.winding);
    check_near(l[i].exponent, a->lyapunov, l[i].exponent_error + a->lyapunov_error);
    assert_true(l[i].rotation == (double)a->orbit.winding / a->orbit.period);
    pendres_attractors_free(set);
  }
}

/* y'' and the derivative of a tangent vector, in time: s = (y, v, dy, dv). */
static void slope(const pendres_pendulum *p, double t, const double s[4], double out[4])
{
  out[0] = s[1];
  out[1] = p->drive_amplitude * cos(p->drive_frequency * t) + p->torque - sin(s[0]) -
           p->damping * s[1];
  out[2] = s[3];
  out[3] = -cos(s[0]) * s[2] - p->damping * s[3];
}

/* Through a drive period from its start, by the classical Runge-Kutta method of fourth order; whole
   turns are taken out. */
enum { STEPS = 300 };

static void period_by_hand(const pendres_pendulum *p, double s[4])
{
  const double h = two_pi / p->drive_frequency / STEPS;
  for (int i = 0; i < STEPS; i++) {
    double a[4], b[4], c[4], d[4], u[4];
    slope(p, i * h, s, a);
    for (int m = 0; m < 4; m++) u[m] = s[m] + 0.5 * h * a[m];
    slope(p, (i + 0.5) * h, u, b);
    for (int m = 0; m < 4; m++) u[m] = s[m] + 0.5 * h * b[m];
    slope(p, (i + 0.5) * h, u, c);
    for (int m = 0; m < 4; m++) u[m] = s[m] + h * c[m];
    slope(p, (i + 1) * h, u, d);
    for (int m = 0; m < 4; m++) s[m] += h / 6.0 * (a[m] + 2.0 * (b[m] + c[m]) + d[m]);
  }
  s[0] = remainder(s[0], two_pi);
}

/* The exponent over so many periods, and its standard error from batches of them. */
static double by_hand(const pendres_pendulum *p, int batches, int length, double *error)
{
  const double time = two_pi / p->drive_frequency * length;
  double s[4] = {0.7, 0.3, 1.0, 0.0}, mean = 0.0, square = 0.0, growth = 0.0;
  for (int k = -200; k < batches * length; k++) {
    period_by_hand(p, s);
    const double size = hypot(s[2], s[3]);
    s[2] /= size;
    s[3] /= size;
    if (k < 0) continue;
    growth += log(size) / time;
    if ((k + 1) % length != 0) continue;
    mean += growth / batches;
    square += growth * growth;
    growth = 0.0;
  }
  *error = sqrt((square / batches - mean * mean) / (batches - 1));
  return mean;
}

/*
 * A pendulum that comes to its orbit along a multiplier near -1, or one whose power is, is next to
 * where it was several periods ago before it has closed the orbit. Its period is the shortest after
 * which strobe points by hand come back: after 1000 periods they do to 1e-6 and much less, the
 * method's own error being the same every period, and other points of these orbits are a hundredth
 * away or more.
 */
static void shortest_period(void **state)
{
  static const struct { double damping, drive, torque, frequency; } of[] = {
    {0.5, 1.2, 0.0, 0.5846153846153846},    {0.5, 1.6, 0.0, 0.6923076923076923},
    {0.5, 1.8461538461538463, 0.0, 0.7076923076923077}, {0.96, 0.188, 1.007, 0.651},
    {0.5, 1.07, 0.0, 0.6666666666666666}};
  enum { N = sizeof of / sizeof *of };
  static const int period[N] = {1, 5, 3, 1, 2}; /* the first three were called twice that */
  pendres_pendulum p[N];
  pendres_settled l[N];
  double x[N], v[N] = {0.0};
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){.damping = of[i].damping, .drive_amplitude = of[i].drive,
                              .torque = of[i].torque, .drive_frequency = of[i].frequency};
    x[i] = 1.6;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    double s[4] = {x[i] - 0.25 * two_pi, 0.0, 1.0, 0.0}, from[2];
    int back = 0;
    for (int k = 0; k < 1000; k++) period_by_hand(&p[i], s);
    memcpy(from, s, sizeof from);
    for (int k = 1; k <= 16 && back == 0; k++) {
      period_by_hand(&p[i], s);
      if (hypot(remainder(s[0] - from[0], two_pi), s[1] - from[1]) < 1e-6) back = k;
    }
    assert_int_equal(back, period[i]);
    assert_int_equal(l[i].period, period[i]);
    assert_true(l[i].rotation == (double)l[i].winding / l[i].period);
  }
}

/* Within four combined standard errors, which sets that are fixed either are or are not: by chance
   one of 16000 is not. */
static void chaos(void **state)
{
  static const pendres_pendulum p[] = {
    {.damping = 0.5, .drive_amplitude = 1.15, .drive_frequency = 2.0 / 3.0},
    {.damping = 0.5, .drive_amplitude = 1.5, .drive_frequency = 2.0 / 3.0},
    {.damping = 0.25, .drive_amplitude = 1.2, .drive_frequency = 0.6},
  };
  enum { N = sizeof p / sizeof *p };
  static const double x[N] = {1.8, 1.8, 1.8}, v[N] = {0.1, 0.1, 0.1};
  pendres_settled l[N];
  const pendres_lyapunov_options options = {.transient = 300, .periods = 1600};
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, &options, l));
  for (int i = 0; i < N; i++) {
    double error = 0.0;
    const double want = by_hand(&p[i], 20, 80, &error);
    assert_int_equal(l[i].label, PENDRES_LABEL_CHAOTIC);
    assert_true(l[i].period == 0 && l[i].winding == 0);
    check_near(l[i].exponent, want, 4.0 * hypot(error, l[i].exponent_error));
    assert_true(l[i].exponent_error < 0.1 * l[i].exponent);
  }
}

/* With ten times the transient and ten times the average each of n pendulums that start at x = 1.6,
   at rest, is in the same motion: an orbit's exponent is the same within its errors, and that of
   chaos within four and a half combined standard errors, which one in 10^5 exceeds. Where the
   start chooses between mirror images their rotations are within the errors. Returns how many are
   chaotic. */
static unsigned same_for_longer(pendres_context *ctx, size_t n, const pendres_pendulum *p)
{
  double x[64], v[64];
  pendres_settled once[64], more[64];
  const pendres_lyapunov_options options = {.transient = 2000, .periods = 5120};
  unsigned chaotic = 0;
  assert_true(n <= 64);
  for (size_t i = 0; i < n; i++) {
    x[i] = 1.6;
    v[i] = 0.0;
  }
  check_ok(pendres_lyapunov_find(ctx, n, p, x, v, NULL, once));
  check_ok(pendres_lyapunov_find(ctx, n, p, x, v, &options, more));
  for (size_t i = 0; i < n; i++) {
    const double claim = once[i].label == PENDRES_LABEL_CHAOTIC
                           ? 4.5 * hypot(once[i].exponent_error, more[i].exponent_error)
                           : once[i].exponent_error + more[i].exponent_error;
    assert_int_equal(once[i].label, more[i].label);
    check_near(once[i].rotation, more[i].rotation,
               4.5 * (once[i].rotation_error + more[i].rotation_error));
    if (once[i].certain)
      assert_true(once[i].period == more[i].period && once[i].winding == more[i].winding);
    check_near(once[i].exponent, more[i].exponent, claim + 1e-15);
    chaotic += once[i].label == PENDRES_LABEL_CHAOTIC;
  }
  return chaotic;
}

/* At random points of input/lyapunov.nml nothing is silently wrong. */
static void longer(void **state)
{
  enum { N = 64 };
  pendres_pendulum p[N];
  for (int i = 0; i < N; i++)
    /* The two-dimensional golden ratio: evenly spread, and on no line of a grid. */
    p[i] = (pendres_pendulum){.damping = 0.5,
                              .drive_amplitude = 0.8 + 1.2 * fmod(0.5 + 0.7548776662 * i, 1.0),
                              .drive_frequency = 0.4 + 0.6 * fmod(0.5 + 0.5698402910 * i, 1.0)};
  const unsigned chaotic = same_for_longer(*state, N, p);
  assert_true(chaotic > N / 8 && chaotic < N / 2);
}

/* Nor where chaos goes over, while it is averaged, into an orbit or into chaos in narrow bands. */
static void late(void **state)
{
  const pendres_pendulum p[] = {
    {.damping = 0.5, .drive_amplitude = 1.8488188976377953, .drive_frequency = 0.5133858267716536},
    {.damping = 0.5, .drive_amplitude = 1.8960629921259844, .drive_frequency = 0.4614173228346457},
    {.damping = 0.5, .drive_amplitude = 1.8545454545, .drive_frequency = 0.4310850440}};
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-6}, &ctx));
  (void)state;
  assert_int_equal(same_for_longer(ctx, 3, p), 1);
  pendres_context_free(ctx);
}

/*
 * A pendulum that starts on an unstable orbit inside of chaos comes back after one period, and
 * Newton's method finds the orbit: it is not what the pendulum settles on. The orbit of period 1 is
 * where the one of a weaker drive is continued to.
 */
static void unstable_orbit(void **state)
{
  const pendres_lyapunov_options options = {.transient = 100, .periods = 256};
  pendres_orbit_guess guess = {.pendulum = {.damping = 0.5, .drive_frequency = 2.0 / 3.0},
                               .x = 1.6, .period = 1};
  pendres_orbit orbit;
  pendres_status outcome;
  pendres_settled l;
  for (int i = 1; i <= 23; i++) {
    guess.pendulum.drive_amplitude = 0.05 * i;
    check_ok(pendres_orbit_find(*state, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
    check_ok(outcome);
    guess.x = orbit.x;
    guess.v = orbit.v;
  }
  assert_true(!orbit.stable && fabs(orbit.multiplier_re[0]) > 1.5);
  check_ok(pendres_lyapunov_find(*state, 1, &orbit.pendulum, &orbit.x, &orbit.v, &options, &l));
  assert_int_equal(l.label, PENDRES_LABEL_CHAOTIC);
  assert_true(l.period == 0 && l.exponent > 5.0 * l.exponent_error);
}

/* A result is its own pendulum's alone, whoever is beside it. */
static void neighbours(void **state)
{
  enum { N = 60 };
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled all[N], one;
  const pendres_lyapunov_options options = {.periods = 64};
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){.damping = 0.5, .drive_amplitude = 0.9 + 0.01 * i,
                              .drive_frequency = 0.5 + 0.007 * (i % 7)};
    x[i] = 1.0;
    v[i] = 0.0;
  }
  memset(all, 0, sizeof all);
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, &options, all));
  for (int i = 0; i < N; i += 7) {
    memset(&one, 0, sizeof one);
    check_ok(pendres_lyapunov_find(*state, 1, &p[i], &x[i], &v[i], &options, &one));
    assert_int_equal(one.label, all[i].label);
    assert_true(one.exponent == all[i].exponent && one.exponent_error == all[i].exponent_error);
    assert_true(one.rotation == all[i].rotation && one.period == all[i].period);
  }
}

/* A pendulum that is caught near orbits again and again, none of which holds it, has a result too:
   what stood in its place before says nothing. */
static void caught_and_let_go(void **state)
{
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 1.8566037735849057,
                              .drive_frequency = 0.7018867924528301};
  const pendres_options options = {.tolerance = 1e-6};
  const double x = 1.6, v = 0.0;
  pendres_settled one = {.label = PENDRES_LABEL_SA}, two = {.label = PENDRES_LABEL_LA};
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(&options, &ctx));
  check_ok(pendres_lyapunov_find(ctx, 1, &p, &x, &v, NULL, &one));
  check_ok(pendres_lyapunov_find(ctx, 1, &p, &x, &v, NULL, &two));
  assert_int_equal(one.label, two.label);
  assert_true(one.label != PENDRES_LABEL_SA && one.exponent == two.exponent);
  pendres_context_free(ctx);
}

/* x'' + 0.3 x' + x - x^2 = F cos(0.8 t) lets go of every pendulum at F = 0.5, where the well's
   barrier is 1/6 high, and of none at 0.05; with -x^3 instead the last period leads to infinity. */
static void escapes(void **state)
{
  enum { N = 4 };
  const pendres_pendulum well = {.damping = 0.3, .drive_frequency = 0.8, .drive_amplitude = 0.05,
                                 .force = PENDRES_FORCE_POLYNOMIAL,
                                 .force_coefficients = {1.0, -1.0}};
  pendres_pendulum p[N] = {well, well, well, well};
  const double x[N] = {0.1, 0.1, 0.1, 3.0}, v[N] = {0.0};
  pendres_settled l[N];
  p[1].drive_amplitude = 0.5;
  p[2].force_coefficients[1] = p[3].force_coefficients[1] = 0.0;
  p[2].force_coefficients[2] = p[3].force_coefficients[2] = -1.0;
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    const int away = i % 2;
    assert_int_equal(l[i].label, away ? PENDRES_LABEL_ESCAPE : PENDRES_LABEL_PERIODIC);
    assert_int_equal(l[i].period, 1 - away);
    assert_true(isnan(l[i].exponent) == away && isnan(l[i].rotation_error) == away);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(caught_and_let_go),
    cmocka_unit_test_setup_teardown(weak_drives, setup, teardown),
    cmocka_unit_test_setup_teardown(other_forces, setup, teardown),
    cmocka_unit_test_setup_teardown(models_side_by_side, setup, teardown),
    cmocka_unit_test_setup_teardown(orbits, setup, teardown),
    cmocka_unit_test_setup_teardown(shortest_period, setup, teardown),
    cmocka_unit_test_setup_teardown(chaos, setup, teardown),
    cmocka_unit_test_setup_teardown(longer, setup, teardown),
    cmocka_unit_test(late),
    cmocka_unit_test_setup_teardown(unstable_orbit, setup, teardown),
    cmocka_unit_test_setup_teardown(neighbours, setup, teardown),
    cmocka_unit_test_setup_teardown(escapes, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
