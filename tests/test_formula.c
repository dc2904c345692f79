/*
 * test_formula.c -- forces that are given as text.
 *
 * References: libm in long double; differences; built-in forces; exact results; for random formulas
 * trajectories by the extrapolated midpoint rule in long double, whose forces are evaluated by a
 * tree of the test's own.
 */
#include <pendres/pendres.h>

#include "check.h"
#include "oracle.h"
#include "model/formula/formula.h"

#include "engine/kernels/kernels_formula.h"

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

static pendres_force defined(const char *text)
{
  pendres_formula_error error;
  pendres_force force = PENDRES_FORCE_PENDULUM;
  if (pendres_force_define(text, &force, &error) != PENDRES_OK)
    fail_msg("%s: at %d: %s", text, error.at, error.message);
  return force;
}

/* ---- functions ---- */

static double last_place(double x)
{
  return nextafter(fabs(x), INFINITY) - fabs(x);
}

/* As functions.h says, in units of the last place: at arguments over the whole range of results,
   and closer together where results are near 0 or 1. */
static void functions_are_exact(void **state)
{
  (void)state;
  for (int i = -20000; i <= 20000; i++) {
    const double x = i * 0.0351234567, near = x * 0.01, size = exp(fabs(x) * 0.1);
    const double e = pendres_formula_exp(x), l = pendres_formula_log(size * 1.0123);
    assert_true(fabsl(e - expl(x)) <= 1.0L * last_place((double)expl(x)) || e == exp(x));
    assert_true(fabsl(l - logl(size * 1.0123)) <= 1.0L * last_place(l));
    const double t = pendres_formula_tanh(near), a = pendres_formula_atan(near);
    assert_true(fabsl(t - tanhl(near)) <= 3.0L * last_place(t));
    assert_true(fabsl(a - atanl(near)) <= 2.0L * last_place(a));
  }
  assert_true(pendres_formula_exp(710.0) == INFINITY && pendres_formula_exp(-800.0) == 0.0);
  assert_true(pendres_formula_log(0.0) == -INFINITY && isnan(pendres_formula_log(-1.0)));
  assert_true(isnan(pendres_formula_exp(NAN)) && isnan(pendres_formula_atan(NAN)));
  assert_true(pendres_formula_atan(INFINITY) == 0.5 * PENDRES_PI &&
              pendres_formula_tanh(-INFINITY) == -1.0);
}

/* ---- texts ---- */

static void mistakes_are_told(void **state)
{
  static const struct {
    const char *text;
    int at, length;
    const char *words, *instead;
  } wrong[] = {
    {"", 0, 0, "ends where a value is wanted", ""},
    {"x + sn(x)", 4, 2, "'sn' is no name", "sin"},
    {"ln(1 + x^2)", 0, 2, "'ln' is no name", "log"},
    {"2x", 0, 2, "a '*' is missing before 'x'", ""},
    {"x + 3 (x)", 4, 3, "a '*' is missing before '('", ""},
    {"x x", 2, 1, "an operator is missing", ""},
    {"(x + 1", 6, 0, "a ')' is missing", ")"},
    {"x)", 1, 1, "no '(' to this ')'", ""},
    {"sin x", 4, 0, "'sin' is a function", "("},
    {"sin(x, 2)", 5, 1, "one argument", ""},
    {"x = 0", 2, 1, "without '='", ""},
    {"a6*x", 0, 2, "a1 to a5", ""},
    {"x*", 2, 0, "ends where a value is wanted", ""},
    {"x + $", 4, 1, "'$' stands where a value is wanted", ""},
    {"1e999*x", 0, 5, "too large", ""},
    {"x*v", 2, 1, "velocity", ""},
    {"cos(phase)*x", 4, 5, "phase", ""},
    {"a1 + 3", 0, 6, "does not depend on x", ""},
  };
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    pendres_formula_error e;
    pendres_force force = PENDRES_FORCE_PENDULUM;
    assert_int_equal(pendres_force_define(wrong[i].text, &force, &e), PENDRES_INVALID_ARGUMENT);
    if (e.at != wrong[i].at || e.length != wrong[i].length ||
        strstr(e.message, wrong[i].words) == NULL || strcmp(e.instead, wrong[i].instead) != 0)
      fail_msg("%s: at %d, %d: %s (%s)", wrong[i].text, e.at, e.length, e.message, e.instead);
  }
  char deep[FORMULA_LONGEST + 2];
  memset(deep, '(', sizeof deep - 1);
  deep[sizeof deep - 1] = '\0';
  pendres_force force;
  assert_int_equal(pendres_force_define(deep, &force, NULL), PENDRES_INVALID_ARGUMENT);
  deep[200] = '\0';
  assert_int_equal(pendres_force_define(deep, &force, NULL), PENDRES_INVALID_ARGUMENT);
}

/* One number a formula, whatever its blanks; values by the rules of arithmetic. */
static void texts_are_formulas(void **state)
{
  static const struct {
    const char *text;
    double at; /* x = 1/2, a1 = 3 */
  } right[] = {{"x+a1*x^3", 0.875}, {"-x^2 + 2^-1", 0.25},   {"2^3^x/4*x", 0.415249635685489},
               {"x - - +x", 1.0},   {"x/a1/2", 1.0 / 12.0},  {"(1 + x)*.5e1 - 2.5D0", 5.0},
               {"sqrt(x*8)", 2.0},  {"sign(-x)*abs(x)", -0.5}, {"x**2**0", 0.5}};
  const double a[PENDRES_FORCE_POWERS] = {3.0};
  (void)state;
  for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) {
    double out[FORMULA_OUTPUTS];
    pendres_formula_at(pendres_formula_of(defined(right[i].text)), FORMULA_FORCES, a, 0.5, out);
    check_near(out[0], right[i].at, 1e-14);
  }
  assert_int_equal(defined(" x +a1 *  x**3"), defined("x+a1*x^3"));
  assert_string_equal(pendres_force_text(defined("x +  x ** 3")), "x+x^3");
  assert_int_equal(defined(pendres_force_text(defined("sin( x)-x"))), defined("sin(x) - x"));
  assert_null(pendres_force_text(PENDRES_FORCE_SQUID));
  assert_null(pendres_force_text((pendres_force)(PENDRES_FORCE_FORMULA + 5)));
  assert_null(pendres_model_of((pendres_force)(PENDRES_FORCE_FORMULA + 5)));
  assert_true(pendres_model_of(defined("sin(x)+a1*sin(2*x+a2)"))->period > 6.0);
  assert_true(pendres_model_of(defined("cos(x)^2*tanh(sin(x + sin(x)))"))->period > 6.0);
  assert_true(pendres_model_of(defined("sin(x/2)"))->period == 0.0);
  assert_true(pendres_model_of(defined("sin(a1*x)"))->period == 0.0);
  assert_true(pendres_model_of(defined("sin(x)+a1*x"))->period == 0.0);
}

/* ---- derivatives ---- */

static const char *const some[] = {
  "x + x^3", "sin(x) + a1*sin(2*x + a2)", "(1 - exp(-a1*x))*exp(-x)", "x - a1/(2 - x)^2",
  "tanh(a1*x)*x + atan(x^2 - a2)", "sqrt(1 + x^2)*log(3 + a3*x)", "cos(x)/(1 + a2*sin(x)^2)",
  "x*abs(x) + sign(x - 9)", "(2 + x)^a1 - (2 + x)^-1.5", "tan(x/4) + a4*x^5 - a5*x^-0*x",
  "exp(-x^2/2)*(x^3 - 3*x)*a1", "x*(a1 + x*(a2 + x*(a3 + x*(a4 + x*a5))))",
};

/* Beside differences of step h, off by h^2 times a third derivative, and by rounding over h. */
static void derivatives_are_right(void **state)
{
  const double h = 1e-5;
  (void)state;
  for (size_t i = 0; i < sizeof some / sizeof some[0]; i++) {
    const pendres_formula *f = pendres_formula_of(defined(some[i]));
    for (double y = -0.9; y < 1.0; y += 0.31) {
      double a[PENDRES_FORCE_POWERS] = {0.7, 0.4, -0.3, 0.9, 0.2};
      double at[FORMULA_OUTPUTS], above[FORMULA_OUTPUTS], below[FORMULA_OUTPUTS];
      pendres_formula_at(f, FORMULA_CURVES, a, y, at);
      pendres_formula_at(f, FORMULA_SLOPES, a, y + h, above);
      pendres_formula_at(f, FORMULA_SLOPES, a, y - h, below);
      const double size = 1.0 + fabs(at[0]) + fabs(at[1]) + fabs(at[2]);
      check_near(at[1], (above[0] - below[0]) / (2.0 * h), 3e-9 * size);
      check_near(at[2], (above[1] - below[1]) / (2.0 * h), 3e-9 * size);
      pendres_formula_at(f, FORMULA_SENSITIVITIES, a, y, at);
      for (int k = 0; k < PENDRES_FORCE_POWERS; k++) {
        a[k] += h;
        pendres_formula_at(f, FORMULA_FORCES, a, y, above);
        a[k] -= 2.0 * h;
        pendres_formula_at(f, FORMULA_FORCES, a, y, below);
        a[k] += h;
        check_near(at[FORMULA_OUT_BY + k], (above[0] - below[0]) / (2.0 * h), 3e-9 * size);
      }
    }
  }
}

/* The same bytes at one point and on strips, of every instruction set that this processor has. */
static void strips_have_the_same_bytes(void **state)
{
  typedef void run(const formula_program *, size_t, const double *const *, double *);
  run *sets[] = {pendres_kernels_formula_run_base,
#if defined(__x86_64__)
                 pendres_instructions_here() >= PENDRES_INSTRUCTIONS_AVX2
                   ? pendres_kernels_formula_run_avx2 : pendres_kernels_formula_run_base,
                 pendres_instructions_here() >= PENDRES_INSTRUCTIONS_AVX512
                   ? pendres_kernels_formula_run_avx512 : pendres_kernels_formula_run_base,
#endif
  };
  static _Alignas(64) double y[FORMULA_LANES], a[PENDRES_FORCE_POWERS][FORMULA_LANES];
  static pendres_kernels_formula f;
  const double *power[PENDRES_FORCE_POWERS];
  (void)state;
  for (int i = 0; i < FORMULA_LANES; i++) y[i] = 0.0237 * (i - 40);
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) {
    for (int i = 0; i < FORMULA_LANES; i++) a[k][i] = 0.7 - 0.2 * k + 0.001 * i;
    power[k] = a[k];
  }
  for (size_t i = 0; i < sizeof some / sizeof some[0]; i++) {
    const pendres_formula *formula = pendres_formula_of(defined(some[i]));
    pendres_kernels_formula_open(&f, formula, FORMULA_SENSITIVITIES, power, 0);
    f.at[FORMULA_AT_X] = y;
    for (size_t set = 0; set < sizeof sets / sizeof sets[0]; set++) {
      sets[set](f.program, FORMULA_LANES, f.at, f.slots);
      for (int lane = 0; lane < FORMULA_LANES; lane++) {
        double own[PENDRES_FORCE_POWERS], out[FORMULA_OUTPUTS];
        for (int k = 0; k < PENDRES_FORCE_POWERS; k++) own[k] = a[k][lane];
        pendres_formula_at(formula, FORMULA_SENSITIVITIES, own, y[lane], out);
        for (int k = 0; k < FORMULA_OUTPUTS; k++)
          if (f.program->output[k] >= 0)
            assert_memory_equal(&out[k], &f.at[f.program->output[k]][lane], sizeof(double));
      }
    }
  }
}

/* ---- beside forces that are built in ---- */

static const struct {
  const char *text;
  pendres_pendulum p;
} twins[] = {
  {"a1*x + a2*x^2 + a3*x^3",
   {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 1.3, .torque = 0.1,
    .parametric_amplitude = 0.1, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {1.0, 0.1, 1.0}}},
  {"sin(x) + a1*x",
   {.damping = 0.2, .drive_amplitude = 0.7, .drive_frequency = 0.9, .torque = 0.3,
    .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.15}}},
  {"-cos(x)",
   {.damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.8, .torque = 0.05}},
};

/* Trajectories, attractors with all their measures, derivatives by parameters: within errors. */
static void twins_agree(void **state)
{
  enum { N = 12 };
  pendres_context *ctx = context(1e-10);
  (void)state;
  for (size_t k = 0; k < sizeof twins / sizeof twins[0]; k++) {
    pendres_pendulum p[2][N];
    double x[2][N], v[2][N], error[2][N];
    pendres_settled outcome[2][N];
    pendres_attractors *found[2] = {NULL, NULL};
    for (int twin = 0; twin < 2; twin++) {
      for (int i = 0; i < N; i++) {
        p[twin][i] = twins[k].p;
        if (twin) p[twin][i].force = defined(twins[k].text);
        x[twin][i] = 0.3 * (i - 6);
        v[twin][i] = 0.05 * i;
      }
      check_ok(pendres_settle(ctx, N, p[twin], x[twin], v[twin], outcome[twin], &found[twin]));
      check_ok(pendres_strobe_advance(ctx, N, p[twin], x[twin], v[twin], 5, error[twin]));
    }
    for (int i = 0; i < N; i++) {
      check_near(x[0][i], x[1][i], error[0][i] + error[1][i]);
      check_near(v[0][i], v[1][i], error[0][i] + error[1][i]);
    }
    const size_t count = pendres_attractors_count(found[0]);
    assert_true(count > 0 && count == pendres_attractors_count(found[1]));
    for (size_t i = 0; i < count; i++) {
      const pendres_orbit *a = &pendres_attractors_get(found[0], i)->orbit;
      const pendres_orbit *b = &pendres_attractors_get(found[1], i)->orbit;
      check_near(a->amplitude, b->amplitude, a->amplitude_error + b->amplitude_error);
      check_near(a->loop_area, b->loop_area, a->loop_area_error + b->loop_area_error);
      check_near(a->multiplier_re[0], b->multiplier_re[0], 1e-9);
      assert_int_equal(a->symmetric, b->symmetric);
    }
    for (int twin = 0; twin < 2; twin++) pendres_attractors_free(found[twin]);
  }
  pendres_context_free(ctx);
}

/* ---- exact ---- */

/* Morse's potential D (1 - e^(-a x))^2: swings of energy E have the frequency a sqrt(2 (D - E)). */
static void morse_is_exact(void **state)
{
  pendres_context *ctx = context(1e-10);
  const double depth = 1.5, a = 0.8;
  const pendres_pendulum p = {.drive_frequency = 1.0,
                              .force = defined("2*a1*a2*(1 - exp(-a2*x))*exp(-a2*x)"),
                              .force_coefficients = {depth, a}};
  (void)state;
  for (double share = 0.1; share < 0.95; share += 0.2) { /* of the well's depth */
    const double root = sqrt(share), low = -log(1.0 + root) / a, high = -log(1.0 - root) / a;
    const double amplitude = 0.5 * (high - low), exact = a * sqrt(2.0 * depth * (1.0 - share));
    pendres_free_oscillation free;
    pendres_status outcome;
    check_ok(pendres_free_oscillation_find(ctx, 1, &p, &amplitude, &free, &outcome));
    assert_int_equal(outcome, PENDRES_OK);
    check_near(free.frequency, exact, fmax(free.frequency_error, 4.0 * last_place(exact)));
    check_near(free.frequency, exact, 1e-13);
    check_near(free.low, low, 1e-13);
  }
  pendres_context_free(ctx);
}

/* A plate that is pulled by a1/(1 - x)^2: held up to a1 = 4/27, where x = 1/3 is a fold; beyond, it
   is pulled in, and so is one that starts beyond the barrier. */
static void plates_are_pulled_in(void **state)
{
  pendres_context *ctx = context(1e-10);
  pendres_pendulum p = {.damping = 0.5, .drive_frequency = 1.0, .force = defined("x-a1/(1-x)^2")};
  const double fold = 4.0 / 27.0, a1[] = {0.14, fold - 1e-5, fold + 1e-3, 0.2, 0.14};
  double x[5] = {0.0, 0.3, 0.0, 0.2, 0.8}, v[5] = {0.0};
  pendres_pendulum each[5];
  pendres_settled outcome[5];
  (void)state;
  for (int i = 0; i < 5; i++) {
    each[i] = p;
    each[i].force_coefficients[0] = a1[i];
  }
  check_ok(pendres_settle(ctx, 5, each, x, v, outcome, NULL));
  assert_true(outcome[0].attractor >= 0 && outcome[1].attractor >= 0);
  for (int i = 2; i < 5; i++) assert_int_equal(outcome[i].label, PENDRES_LABEL_ESCAPE);
  assert_true(pendres_pendulum_leaves(&each[0]));
  p.force = defined("1/x");
  assert_int_equal(pendres_pendulum_check(&p, NULL), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

/* ---- random formulas ---- */

enum { MOST_PARTS = 64 };

/* A formula as a tree of the test's own; `kind` is a row of `makes`. */
typedef struct part {
  int kind, left, right;
  double value;
} part;

typedef struct grown {
  part part[MOST_PARTS];
  int parts;
  double a1;
} grown;

/* What a part is made of: # and @ are its operands. */
static const char *const makes[] = {"x", "a1", "value", "(# + @)", "(# - @)", "# * @", "sin(#)",
                                    "cos(#)", "tanh(#)", "atan(#)", "exp(-(#)^2)",
                                    "sqrt(1 + (#)^2)", "log(2 + sin(#))", "#/(1.5 + cos(@))",
                                    "(#)^3", "(2 + sin(#))^1.3", "-(#)"};
enum { MAKES = sizeof makes / sizeof makes[0] };

static unsigned next_random(unsigned *seed)
{
  *seed = *seed * 1664525u + 1013904223u;
  return *seed >> 8;
}

static int grow(grown *g, int depth, unsigned *seed)
{
  const int i = g->parts++;
  const int kind = (int)(depth == 0 ? next_random(seed) % 3 : 3 + next_random(seed) % (MAKES - 3));
  g->part[i] = (part){.kind = kind, .value = 0.25 * (1 + next_random(seed) % 9)};
  if (kind > 2) g->part[i].left = grow(g, depth - 1, seed);
  if (kind > 2 && strchr(makes[kind], '@') != NULL) g->part[i].right = grow(g, depth - 1, seed);
  return i;
}

static void write_part(const grown *g, int i, char *text)
{
  const part *p = &g->part[i];
  for (const char *c = makes[p->kind]; *c != '\0'; c++) {
    if (p->kind == 2) {
      sprintf(text + strlen(text), "%.2f", p->value);
      return;
    }
    if (*c == '#') write_part(g, p->left, text);
    else if (*c == '@') write_part(g, p->right, text);
    else sprintf(text + strlen(text), "%c", *c);
  }
}

static long double value_of(const grown *g, int i, long double x)
{
  const part *p = &g->part[i];
  const long double a = p->kind > 2 ? value_of(g, p->left, x) : 0.0L;
  const long double b =
    p->kind > 2 && strchr(makes[p->kind], '@') != NULL ? value_of(g, p->right, x) : 0.0L;
  switch (p->kind) {
  case 0: return x;
  case 1: return g->a1;
  case 2: return p->value;
  case 3: return a + b;
  case 4: return a - b;
  case 5: return a * b;
  case 6: return sinl(a);
  case 7: return cosl(a);
  case 8: return tanhl(a);
  case 9: return atanl(a);
  case 10: return expl(-a * a);
  case 11: return sqrtl(1.0L + a * a);
  case 12: return logl(2.0L + sinl(a));
  case 13: return a / (1.5L + cosl(b));
  case 14: return a * a * a;
  case 15: return powl(2.0L + sinl(a), 1.3L);
  default: return -a;
  }
}

/* x + x^3/10 holds the pendulum, and half the sine of something moves it. */
static long double grown_force(const void *arg, long double x)
{
  return x + x * x * x / 10.0L + 0.5L * sinl(value_of(arg, 0, x));
}

/* Three periods, within the errors that come back. Formulas so rough that the reference itself is
   not known to 1e-14, by half as many steps, are left out: a fifth at most. */
static void random_formulas(void **state)
{
  enum { FORMULAS = 80, PERIODS = 3 };
  pendres_context *ctx = context(1e-10);
  unsigned seed = 20;
  int compared = 0;
  (void)state;
  for (int i = 0; i < FORMULAS; i++) {
    grown g = {.parts = 0, .a1 = 0.6};
    char text[2000] = "x + x^3/10 + 0.5*sin(";
    (void)grow(&g, 1 + i % 3, &seed);
    write_part(&g, 0, text);
    strcat(text, ")");
    if (strlen(text) > FORMULA_LONGEST) continue;
    const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.5, .drive_frequency = 1.1,
                                .force = defined(text), .force_coefficients = {g.a1}};
    pendres_pendulum with = p;
    if (pendres_model_of(p.force)->coefficients == 0) with.force_coefficients[0] = 0.0;
    oracle o = oracle_of(&with), twice = o;
    o.own = twice.own = grown_force;
    o.arg = twice.arg = &g;
    long double s[ORACLE_SIZE] = {0.4L, 0.0L}, fine[ORACLE_SIZE] = {0.4L, 0.0L};
    double x = 0.4, v = 0.0, error;
    twice.parts = 2 * ORACLE_PARTS;
    oracle_advance(&o, PERIODS, s);
    oracle_advance(&twice, PERIODS, fine);
    if (!(fabsl(fine[0] - s[0]) + fabsl(fine[1] - s[1]) < 1e-14L)) continue;
    check_ok(pendres_strobe_advance(ctx, 1, &with, &x, &v, PERIODS, &error));
    if (!(fabsl(x - s[0]) <= error && error < 1e-8))
      fail_msg("%s: x %.17g, %.17Lg, error %g", text, x, s[0], error);
    assert_true(fabsl(v - s[1]) <= error);
    compared++;
  }
  assert_true(compared >= 4 * FORMULAS / 5);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(functions_are_exact),
    cmocka_unit_test(mistakes_are_told),
    cmocka_unit_test(texts_are_formulas),
    cmocka_unit_test(derivatives_are_right),
    cmocka_unit_test(strips_have_the_same_bytes),
    cmocka_unit_test(twins_agree),
    cmocka_unit_test(morse_is_exact),
    cmocka_unit_test(plates_are_pulled_in),
    cmocka_unit_test(random_formulas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
