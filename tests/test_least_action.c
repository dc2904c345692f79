/*
 * test_least_action.c -- least actions beside barriers, beside the response to a weak drive, beside
 * a minimisation of the discretised action that has no code in common, and at a fold.
 */
#include <pendres/pendres.h>

#include <stdlib.h>
#include <string.h>

#include "check.h"

#define PI 3.14159265358979323846

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-10}, &ctx));
  return ctx;
}

static pendres_attractors *attractors(pendres_context *ctx, const pendres_pendulum *p)
{
  pendres_attractors *set = NULL;
  check_ok(pendres_attractors_find(ctx, p, 0, NULL, NULL, &set));
  return set;
}

static double random_from(uint64_t *seed, double low, double high)
{
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return low + (high - low) * (double)(*seed >> 11) * 0x1p-53;
}

/* ---- without a drive the action is the barrier, exactly ---- */

static void beside_barriers(pendres_context *ctx, const pendres_pendulum *p, size_t *ways_seen)
{
  pendres_attractors *set = attractors(ctx, p);
  for (size_t i = 0; i < pendres_attractors_count(set); i++) {
    const pendres_orbit *o = &pendres_attractors_get(set, i)->orbit;
    pendres_escapes *ways = NULL;
    if (o->period == 0 || o->winding != 0) continue;
    check_ok(pendres_escapes_find(ctx, set, i, &ways));
    const double home = pendres_pendulum_energy(p, o->x, 0.0);
    for (size_t k = 0; k < pendres_escapes_count(ways); k++, ++*ways_seen) {
      const pendres_escape *w = pendres_escapes_get(ways, k);
      const double barrier = pendres_pendulum_energy(p, w->saddle_x, 0.0) - home;
      check_relative(w->action, barrier, 2e-11);
      check_near(w->action, barrier, w->action_error + 1e-15);
      assert_true(w->action_error < 1e-8 * w->action);
      assert_true(k == 0 || w->action >= w[-1].action || w->action >= 0.0);
      /* Along the path the noise is twice the friction, and H is conserved at 0. */
      const size_t m = w->points / 2;
      check_near(w->noise[m], 2.0 * p->damping * w->v[m], 1e-6 * (1.0 + fabs(w->v[m])));
    }
    pendres_escapes_free(ways);
  }
  pendres_attractors_free(set);
}

static void barriers(void **state)
{
  pendres_context *ctx = context();
  uint64_t seed = 20250601u;
  size_t ways = 0;
  (void)state;
  for (int k = 0; k < (CHECK_SHORT ? 3 : 10); k++) {
    pendres_pendulum p = {.damping = exp(random_from(&seed, log(0.1), log(8.0))),
                          .drive_frequency = random_from(&seed, 0.7, 1.5)};
    if (k % 2 == 0) {
      p.torque = random_from(&seed, -0.95, 0.95);
    } else {
      p.force = PENDRES_FORCE_POLYNOMIAL;
      p.force_coefficients[0] = k % 4 == 1 ? -1.0 : 1.0;
      p.force_coefficients[1] = random_from(&seed, 0.1, 0.5);
      p.force_coefficients[2] = k % 4 == 1 ? random_from(&seed, 0.3, 2.0)
                                           : random_from(&seed, -0.5, -0.1);
    }
    beside_barriers(ctx, &p, &ways);
  }
  assert_true(ways >= (CHECK_SHORT ? 4 : 14));
  pendres_context_free(ctx);
}

/* ---- mirror images are left as easily ---- */

static void mirror_images(void **state)
{
  pendres_context *ctx = context();
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.1, .drive_frequency = 1.0,
                              .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.1}};
  pendres_attractors *set = attractors(ctx, &p);
  const pendres_escape *way[2];
  pendres_escapes *ways[2];
  (void)state;
  for (size_t i = 0; i < 2; i++) {
    check_ok(pendres_escapes_find(ctx, set, i, &ways[i]));
    way[i] = pendres_escapes_get(ways[i], 0);
  }
  check_near(way[0]->action, way[1]->action, way[0]->action_error + way[1]->action_error);
  assert_true(way[1]->action_error < 1e-9);
  for (int i = 0; i < 2; i++) pendres_escapes_free(ways[i]);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/* ---- a weak drive lowers it by the logarithmic susceptibility ---- */

/* |integral of x' exp(i omega t)| along the undriven path: motion down from the barrier. */
static double susceptibility(const pendres_pendulum *p, double top)
{
  const double h = 0.002, g = p->damping;
  const double stiff = 1.0 - p->torque * p->torque, rate =
    -0.5 * g + sqrt(0.25 * g * g + sqrt(stiff));
  double x = top - 1e-7, v = -1e-7 * rate, re = 0.0, im = 0.0;
  for (long k = 0; k < 60000; k++) {
    double kx[4], kv[4], ax = x, av = v;
    re += h * v * cos(p->drive_frequency * h * (double)k);
    im += h * v * sin(p->drive_frequency * h * (double)k);
    for (int s = 0; s < 4; s++) {
      kx[s] = av;
      kv[s] = p->torque + cos(ax) - g * av;
      ax = x + (s < 2 ? 0.5 : 1.0) * h * kx[s];
      av = v + (s < 2 ? 0.5 : 1.0) * h * kv[s];
    }
    x += h / 6.0 * (kx[0] + 2.0 * kx[1] + 2.0 * kx[2] + kx[3]);
    v += h / 6.0 * (kv[0] + 2.0 * kv[1] + 2.0 * kv[2] + kv[3]);
  }
  return hypot(re, im);
}

static void weak_drive(void **state)
{
  pendres_context *ctx = context();
  pendres_pendulum p = {.damping = 0.3, .drive_frequency = 1.1, .torque = 0.3};
  const double well = acos(-0.3), top = 2.0 * PI - well;
  const double barrier = pendres_pendulum_energy(&p, top, 0.0) -
                         pendres_pendulum_energy(&p, well, 0.0);
  const double chi = susceptibility(&p, top);
  double rest[2];
  (void)state;
  for (int k = 0; k < 2; k++) {
    p.drive_amplitude = k == 0 ? 1e-3 : 2e-3;
    pendres_attractors *set = attractors(ctx, &p);
    pendres_escapes *ways = NULL;
    check_ok(pendres_escapes_find(ctx, set, 0, &ways));
    rest[k] = pendres_escapes_get(ways, 0)->action - barrier + p.drive_amplitude * chi;
    pendres_escapes_free(ways);
    pendres_attractors_free(set);
  }
  /* What is left is of second order. */
  assert_true(fabs(rest[1]) < 0.02 * 2e-3 * chi);
  check_relative(rest[1], 4.0 * rest[0], 0.02);
  pendres_context_free(ctx);
}

/* ---- an own minimisation of the discretised action ---- */

enum { PERIODS = 70, WIDTH = 5 };

/* Positions on the grid of a motion without noise from a point on, and the action of positions. */
static void follow(const pendres_pendulum *p, int each, double x, double v, int n, double *out)
{
  enum { INNER = 8 };
  const double h = 2.0 * PI / p->drive_frequency / each / INNER;
  for (int k = 0; k < n; k++) {
    out[k] = x;
    for (int i = 0; i < INNER; i++) {
      const double t = h * ((k % each) * INNER + i);
      double kx[4], kv[4], ax = x, av = v;
      for (int s = 0; s < 4; s++) {
        const double at = t + (s == 0 ? 0.0 : s < 3 ? 0.5 * h : h);
        kx[s] = av;
        kv[s] = pendres_pendulum_acceleration(p, ax, av, at);
        ax = x + (s < 2 ? 0.5 : 1.0) * h * kx[s];
        av = v + (s < 2 ? 0.5 : 1.0) * h * kv[s];
      }
      x += h / 6.0 * (kx[0] + 2.0 * kx[1] + 2.0 * kx[2] + kx[3]);
      v += h / 6.0 * (kv[0] + 2.0 * kv[1] + 2.0 * kv[2] + kv[3]);
    }
  }
}

/* Gauss and Newton on x'' + gamma x' - cos x - F0 cos by central differences of second order; the
   normal matrix has two diagonals on either side. Only for the plain pendulum. */
static double minimise(const pendres_pendulum *p, int each, int n, double *x)
{
  const double h = 2.0 * PI / p->drive_frequency / each, g = p->damping;
  const double low = 1.0 / (h * h) - 0.5 * g / h, high = 1.0 / (h * h) + 0.5 * g / h;
  double *r = calloc((size_t)n, sizeof *r), *b = calloc((size_t)n, sizeof *b);
  double(*a)[3] = calloc((size_t)n, sizeof *a), action = INFINITY;
  assert_non_null(r);
  assert_non_null(a);
  assert_non_null(b);
  for (int round = 0; round < 60; round++) {
    double sum = 0.0;
    memset(a, 0, (size_t)n * sizeof *a);
    memset(b, 0, (size_t)n * sizeof *b);
    for (int k = 1; k < n - 1; k++) {
      r[k] = (x[k + 1] - 2.0 * x[k] + x[k - 1]) / (h * h) + 0.5 * g * (x[k + 1] - x[k - 1]) / h -
             cos(x[k]) - p->drive_amplitude * cos(p->drive_frequency * h * (k % each));
      sum += r[k] * r[k];
      const double d[3] = {low, -2.0 / (h * h) + sin(x[k]), high};
      for (int i = 0; i < 3; i++) {
        b[k + i - 1] -= d[i] * r[k];
        for (int j = 0; j <= i; j++) a[k + i - 1][i - j] += d[i] * d[j];
      }
    }
    const double now = sum * h / (4.0 * g);
    if (fabs(now - action) < 1e-12 * now) break;
    action = now;
    for (int i = 0; i < n; i++) a[i][0] *= 1.0 + (round < 20 ? 1e-4 : 1e-9);
    for (int i = 0; i < 2; i++)
      for (int end = 0; end < 2; end++) { /* the outer two stay */
        const int row = end == 0 ? i : n - 1 - i;
        b[row] = 0.0;
        for (int j = 0; j < 3; j++) {
          a[row][j] = 0.0;
          if (row + j < n) a[row + j][j] = 0.0;
        }
        a[row][0] = 1.0;
      }
    for (int i = 0; i < n; i++) { /* L D L': a[i][d] couples i and i - d */
      for (int d = i < 2 ? i : 2; d >= 0; d--) {
        for (int m = d + 1; m <= 2 && m <= i; m++)
          a[i][d] -= a[i][m] * a[i - d][m - d] * (d == 0 ? 1.0 / a[i - m][0] : 1.0 / a[i - m][0]);
      }
    }
    for (int i = 0; i < n; i++)
      for (int d = 1; d <= 2 && d <= i; d++) b[i] -= a[i][d] / a[i - d][0] * b[i - d];
    for (int i = n - 1; i >= 0; i--) {
      b[i] /= a[i][0];
      for (int d = 1; d <= 2 && i + d < n; d++) b[i] -= a[i + d][d] / a[i][0] * b[i + d];
    }
    for (int i = 0; i < n; i++) x[i] += b[i];
  }
  free(r);
  free(a);
  free(b);
  return action;
}

static double own_action(const pendres_pendulum *p, const pendres_orbit *from,
                         const pendres_orbit *to, int each)
{
  const int n = PERIODS * each + 1;
  double *x = malloc((size_t)n * sizeof *x), *a = malloc((size_t)n * sizeof *a);
  double *b = malloc((size_t)n * sizeof *b);
  assert_non_null(x);
  assert_non_null(a);
  assert_non_null(b);
  follow(p, each, from->x, from->v, each, a);
  follow(p, each, to->x, to->v, each, b);
  for (int k = 0; k < n; k++) {
    const double s = 1.0 / (1.0 + exp(-3.0 * ((double)k / each - 0.5 * PERIODS)));
    x[k] = (1.0 - s) * a[k % each] + s * b[k % each];
  }
  const double action = minimise(p, each, n, x);
  free(x);
  free(a);
  free(b);
  return action;
}

/* docs/noise.md has 0.06853 and 0.1028 for two of these. */
static void own_minimisation(void **state)
{
  static const double sets[3][2] = {{0.12, 7.7}, {0.13, 7.6}, {0.11, 7.8}};
  pendres_context *ctx = context();
  (void)state;
  for (int k = 0; k < (CHECK_SHORT ? 1 : 3); k++) {
    const pendres_pendulum p = {.damping = sets[k][0], .drive_amplitude = 0.2,
                                .drive_frequency = 2.0 * PI / sets[k][1]};
    pendres_attractors *set = attractors(ctx, &p);
    for (size_t i = 0; i < pendres_attractors_count(set); i++) {
      const pendres_orbit *o = &pendres_attractors_get(set, i)->orbit;
      pendres_escapes *ways = NULL;
      check_ok(pendres_escapes_find(ctx, set, i, &ways));
      const pendres_escape *w = pendres_escapes_get(ways, 0);
      assert_int_equal(w->attractor, 1 - (int)i);
      /* Of second order; from three grids two orders are taken away. */
      const double s[3] = {own_action(&p, o, &w->saddle, 50), own_action(&p, o, &w->saddle, 100),
                           own_action(&p, o, &w->saddle, 200)};
      const double first = (4.0 * s[1] - s[0]) / 3.0, second = (4.0 * s[2] - s[1]) / 3.0;
      const double best = (16.0 * second - first) / 15.0;
      check_near(w->action, best, fabs(best - second) + 1e-5 * best);
      pendres_escapes_free(ways);
    }
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/* ---- it vanishes at a fold as the power 3/2 ---- */

static void at_a_fold(void **state)
{
  pendres_context *ctx = context();
  double action[3];
  (void)state;
  for (int k = 0; k < 3; k++) { /* at I = 1 well and barrier meet: S = (4/3) sqrt(2) (1 - I)^1.5 */
    const double distance = 1e-3 * pow(0.25, k);
    const pendres_pendulum p = {.damping = 0.5, .drive_frequency = 0.3, .torque = 1.0 - distance};
    pendres_attractors *set = attractors(ctx, &p);
    pendres_escapes *ways = NULL;
    check_ok(pendres_escapes_find(ctx, set, 0, &ways));
    action[k] = pendres_escapes_get(ways, 0)->action;
    check_relative(action[k], 4.0 / 3.0 * sqrt(2.0) * pow(distance, 1.5), distance);
    pendres_escapes_free(ways);
    pendres_attractors_free(set);
  }
  check_near(log(action[1] / action[2]) / log(4.0), 1.5, 1e-4);
  pendres_context_free(ctx);
}

/* ---- what is refused ---- */

static void refusals(void **state)
{
  pendres_context *ctx = context();
  const pendres_pendulum p = {.damping = 0.5, .drive_frequency = 1.0, .torque = 1.2};
  pendres_attractors *set = attractors(ctx, &p);
  pendres_escapes *ways = NULL;
  (void)state;
  assert_int_equal(pendres_escapes_find(ctx, set, 0, &ways), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "no closed orbits"));
  assert_int_equal(pendres_escapes_find(ctx, set, 7, &ways), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "no such attractor"));
  assert_int_equal(pendres_escapes_find(ctx, NULL, 0, &ways), PENDRES_INVALID_ARGUMENT);
  assert_null(ways);
  assert_int_equal(pendres_escapes_count(NULL), 0);
  assert_null(pendres_escapes_get(NULL, 0));
  pendres_escapes_free(NULL);
  pendres_attractors_free(set);
  const pendres_pendulum alone = {.damping = 0.2, .drive_frequency = 1.0, .drive_amplitude = 0.1,
                                  .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
  set = attractors(ctx, &alone);
  assert_int_equal(pendres_escapes_find(ctx, set, 0, &ways), PENDRES_NOT_FOUND);
  assert_non_null(strstr(pendres_context_message(ctx), "no saddle"));
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(barriers),         cmocka_unit_test(mirror_images),
    cmocka_unit_test(weak_drive),
    cmocka_unit_test(own_minimisation), cmocka_unit_test(at_a_fold),
    cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
