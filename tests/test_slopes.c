/* test_slopes.c -- the right-hand sides of the inner loops, and their sine, against long double. */
#include "kernels_fixture.h"

/* ---- The sine -------------------------------------------------------------------------------- */

/* sin of n angles by the slope of a pendulum with stiffness -1, no drive and no friction. */
static void sines(const pendres_kernels *k, const double *y, double *sine, size_t n)
{
  enum { LANES = 64 };
  double *x = pendres_lanes_allocate(2 * LANES), *slope = pendres_lanes_allocate(2 * LANES);
  double *minus = pendres_lanes_allocate(LANES), *zero = pendres_lanes_allocate(LANES);
  assert_true(x && slope && minus && zero);
  for (int i = 0; i < LANES; i++) minus[i] = -1.0;
  const pendres_strip s = {.lanes = LANES, .k = {minus, zero, zero, zero}};
  const pendres_operation o = {.from = x, .slope = slope, .cos_theta = 0.0};
  for (size_t done = 0; done < n; done += LANES) {
    const size_t now = n - done < LANES ? n - done : LANES;
    memcpy(x, y + done, now * sizeof *x);
    k->run(PENDRES_ROWS_STATE, &s, &o, 1);
    memcpy(sine + done, slope + LANES, now * sizeof *sine);
  }
  free(x);
  free(slope);
  free(minus);
  free(zero);
}

/*
 * Two units in the last place or 2e-29, as sine.h promises below 1e4. The reference is the
 * C library's long double sine, right to a unit of its own 64 bits: 1/2048 of a unit here; near
 * the zeros of the sine it is right to relative precision, too.
 */
static void check_sines(const double *y, size_t n)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  double *sine = malloc(n * sizeof *sine);
  assert_non_null(sine);
  for (size_t k = 0; k < count; k++) {
    sines(list[k], y, sine, n);
    for (size_t i = 0; i < n; i++) {
      const long double want = sinl((long double)y[i]);
      int exponent = 0;
      (void)frexp((double)want, &exponent);
      const double ulp = ldexp(1.0, exponent - 53 < -1074 ? -1074 : exponent - 53);
      check_near((double)(sine[i] - want), 0.0, fmax(2.0 * ulp, 2e-29));
    }
  }
  free(sine);
}

static void test_sine(void **state)
{
  enum { N = 100000 };
  double *y = malloc(N * sizeof *y);
  (void)state;
  assert_non_null(y);
  random_state = 1;
  for (int i = 0; i < N; i++) y[i] = uniform(-10.0, 10.0);
  check_sines(y, N);
  for (int i = 0; i < N; i++) y[i] = uniform(-1e4, 1e4);
  check_sines(y, N);
  /* Small ones down to denormals, where the sine is the angle. */
  for (int i = 0; i < N; i++) y[i] = ldexp(uniform(-1.0, 1.0), -(i % 1080));
  check_sines(y, N);
  free(y);
}

/* The doubles next to multiples of pi/2: all digits of the argument's reduction show here. */
static void test_sine_next_to_its_zeros(void **state)
{
  enum { N = 6366 }; /* times pi/2: up to 1e4 */
  double *y = malloc(6 * (size_t)N * sizeof *y);
  size_t n = 0;
  (void)state;
  assert_non_null(y);
  for (int k = 0; k < N; k++) {
    const double at = (double)(1.57079632679489661923132169163975L * k);
    const double four[] = {at, -at, nextafter(at, 1e9), nextafter(at, 0.0), at * (1.0 + 1e-9),
                           at * (1.0 - 1e-6)};
    memcpy(y + n, four, sizeof four);
    n += 6;
  }
  check_sines(y, n);
  free(y);
}

static void test_sine_of_nothing(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  const double y[4] = {NAN, INFINITY, -INFINITY, 0.0};
  (void)state;
  for (size_t k = 0; k < count; k++) {
    double sine[4];
    sines(list[k], y, sine, 4);
    assert_true(isnan(sine[0]) && isnan(sine[1]) && isnan(sine[2]));
    assert_true(sine[3] == 0.0);
  }
}

/* ---- The right-hand sides -------------------------------------------------------------------- */

/* A lane's equation in long double, from the physical parameters. */
typedef struct physics {
  long double omega, damping, amplitude, torque, modulation, power[PENDRES_FORCE_POWERS];
  long double eta, quadratic, cubic, cosine;
  pendres_model_terms model;
} physics;

/* f (derivative = 0) or f' (1), times what the parametric drive makes of it. */
static long double force_of(const physics *p, long double y, int derivative)
{
  long double f = derivative ? cosl(y) : sinl(y);
  if (p->model == PENDRES_MODEL_SQUID) f += p->power[0] * (derivative ? 1.0L : y);
  if (p->model == PENDRES_MODEL_POLYNOMIAL) f = 0.0L;
  for (int k = 0; p->model == PENDRES_MODEL_POLYNOMIAL && k < PENDRES_FORCE_POWERS; k++)
    f += p->power[k] * (derivative ? (k + 1) * powl(y, k) : powl(y, k + 1));
  return f * (1.0L + p->modulation * p->cosine);
}

static long double slope_of_w(const physics *p, long double y, long double w)
{
  const long double push = p->amplitude * p->cosine + p->torque - force_of(p, y, 0);
  const long double v = p->omega * w;
  const long double friction = p->damping + p->eta * y * y + p->quadratic * fabsl(v) +
                               p->cubic * v * v;
  return push / (p->omega * p->omega) - friction / p->omega * w;
}

/* d(slope of w)/d(parameter number k) at fixed y and w, by central differences: off by h^2 times a
   third derivative, below 1e-11 here, and by rounding, 1e-19/h. */
static long double by_parameter(physics p, int k, long double y, long double w)
{
  const long double h = 1e-6L;
  long double *const parameter[] = {&p.omega, &p.damping, &p.amplitude, &p.torque,
                                    &p.modulation, &p.power[0], &p.power[1], &p.power[2],
                                    &p.power[3], &p.power[4], &p.eta, &p.quadratic, &p.cubic};
  const long double middle = *parameter[k];
  *parameter[k] = middle + h;
  const long double above = slope_of_w(&p, y, w);
  *parameter[k] = middle - h;
  const long double below = slope_of_w(&p, y, w);
  return (above - below) / (2.0L * h);
}

static physics physics_of(const bench *b, equation e, size_t i, double cos_theta)
{
  const long double omega = 1.0L / b->inverse[i], square = omega * omega;
  physics p = {.omega = omega, .damping = b->friction[i] * omega,
               .amplitude = b->drive[i] * square, .cosine = cos_theta, .model = e.model};
  if (e.model == PENDRES_MODEL_PLAIN) return p;
  p.torque = b->torque[i] * square;
  p.modulation = b->modulation[i];
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) p.power[k] = b->power[k][i];
  if (!e.drags) return p;
  p.eta = b->nonlinear[i] * omega;
  p.quadratic = b->quadratic[i];
  p.cubic = b->cubic[i] / omega;
  return p;
}

static void check_lane(const bench *b, equation e, size_t lanes, size_t i, double cos_theta)
{
  const double *x = b->vector[0] + i, *got = b->vector[1] + i;
  const physics p = physics_of(b, e, i, cos_theta);
  const long double y = x[0], w = x[lanes], square = p.omega * p.omega;
  const long double to_y = -force_of(&p, y, 1) / square - 2.0L * p.eta * y * w / p.omega;
  const long double to_w = -(p.damping + p.eta * y * y) / p.omega -
    2.0L * p.quadratic * fabsl(w) - 3.0L * p.cubic * p.omega * w * w;
  /* At |y| <= 4 the force of the others is below 5, and its slope below 2. */
  const long double force = e.model >= PENDRES_MODEL_POLYNOMIAL ? 6.0L : 2.0L;
  const long double push = force * (1.0L + fabsl(p.modulation)) + p.amplitude + fabsl(p.torque);
  const double size = (double)(push / square + 4.0L * p.damping + e.drags * 16.0L);

  assert_true(got[0] == x[lanes]);
  /* Coefficients rounded to doubles, and a handful of operations on them: 8 half units. */
  check_near(got[lanes], (double)slope_of_w(&p, y, w), 8.0 * 0x1p-53 * size);
  for (size_t r = 2; r < e.rows; r += 2) {
    const long double u = x[r * lanes], v = x[(r + 1) * lanes];
    long double want = to_y * u + to_w * v;
    double tolerance = 16.0 * 0x1p-53 * 4.0 * size;
    if (r >= PENDRES_ROWS_VARIATIONAL) {
      want += by_parameter(p, (int)(r - PENDRES_ROWS_VARIATIONAL) / 2, y, w);
      tolerance = 1e-9 * size; /* the differences; 24 amplitude h^2/omega^5 at the least omega */
    }
    assert_true(got[r * lanes] == x[(r + 1) * lanes]);
    check_near(got[(r + 1) * lanes], (double)want, tolerance);
  }
}

static void test_right_hand_sides(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = MOST_LANES;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++)
      for (uint64_t seed = 0; seed < 10; seed++) {
        bench b;
        open_bench(&b, seed);
        const double cos_theta = uniform(-1.0, 1.0);
        const pendres_operation o = {
          .from = b.vector[0], .slope = b.vector[1], .cos_theta = cos_theta};
        const pendres_strip s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, &o, 1);
        for (size_t i = 0; i < lanes; i++) check_lane(&b, equations[e], lanes, i, cos_theta);
        close_bench(&b);
      }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sine),
    cmocka_unit_test(test_sine_next_to_its_zeros),
    cmocka_unit_test(test_sine_of_nothing),
    cmocka_unit_test(test_right_hand_sides),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
