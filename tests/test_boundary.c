/*
 * test_boundary.c -- the orbit between two attractors, and its stable manifold as a curve.
 *
 * References: reference.h for the saddle; and what a boundary is: states on either side of it go
 * to different attractors, as close to it as its error bound says.
 */
#include <stdlib.h>

#include <pendres/attractor.h>
#include <pendres/boundary.h>
#include "oracle/reference.h"

#include "analysis/basins/boundary_grow.h"
#include "check.h"

static const double half_pi = 1.57079632679489661923;

typedef struct fixture {
  pendres_context *ctx;
  pendres_attractors *found;
  pendres_orbit saddle;
} fixture;

/* Fig. 7's parameters. */
static int setup(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.25 * 3.14159265358979323846};
  fixture *f = calloc(1, sizeof *f);
  if (f == NULL) return -1;
  *state = f;
  if (pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &f->ctx) != PENDRES_OK ||
      pendres_attractors_find(f->ctx, &p, 0, NULL, NULL, &f->found) != PENDRES_OK)
    return -1;
  return pendres_saddle_find(f->ctx, &pendres_attractors_get(f->found, 0)->orbit, &f->saddle);
}

static int teardown(void **state)
{
  fixture *f = *state;
  pendres_attractors_free(f->found);
  pendres_context_free(f->ctx);
  free(f);
  return 0;
}

static void saddle_matches_reference(void **state)
{
  fixture *f = *state;
  const pendres_orbit *s = &f->saddle;
  reference_cycle want;
  assert_int_equal(pendres_attractors_count(f->found), 2);
  check_ok(reference_orbit(&s->pendulum, s->x - half_pi, s->v, 1, 0, &want));
  check_near(s->x - half_pi, (double)want.y, 2.0 * s->x_error);
  check_near(s->v, (double)want.v, 2.0 * s->v_error);
  check_near(s->multiplier_re[0], (double)want.multiplier_re[0], 2.0 * s->multiplier_error);
  assert_false(s->stable);
  assert_true(s->multiplier_re[0] > 1.0 && s->multiplier_re[1] < 1.0);
  /* Between the two attractors in amplitude as well. */
  assert_true(s->amplitude > pendres_attractors_get(f->found, 0)->orbit.amplitude);
  assert_true(s->amplitude < pendres_attractors_get(f->found, 1)->orbit.amplitude);
}

/* Points lie in the window, in order; the saddle is on the curve. */
static void curve_is_a_curve(void **state)
{
  fixture *f = *state;
  const pendres_boundary_options window = {.x_low = -1.0, .x_high = 5.0, .v_low = -1.5,
                                           .v_high = 1.5, .spacing = 0.1, .deviation = 1e-4};
  pendres_boundary *b = NULL;
  check_ok(pendres_boundary_find(f->ctx, &f->saddle, &window, &b));
  const size_t n = b->count;
  const double *x = b->x, *v = b->v;
  const int *piece = b->piece;
  double nearest = INFINITY;
  assert_true(n > 50);
  assert_int_equal(piece[0], 0);
  for (size_t i = 0; i < n; i++) {
    assert_true(x[i] >= -1.0 && x[i] <= 5.0 && v[i] >= -1.5 && v[i] <= 1.5);
    nearest = fmin(nearest, hypot(x[i] - f->saddle.x, v[i] - f->saddle.v));
    if (i == 0) continue;
    assert_true(piece[i] == piece[i - 1] || piece[i] == piece[i - 1] + 1);
    if (piece[i] == piece[i - 1])
      assert_true(fabs(x[i] - x[i - 1]) <= 0.1 && fabs(v[i] - v[i - 1]) <= 0.1);
  }
  /* As close as the saddle itself is known. */
  check_near(nearest, 0.0, 1e-9);
  pendres_boundary_free(b);
}

/* Step to both sides of every fifth point of the curve by a few times its error: at least so many
   states. */
static void check_sides(const fixture *f, const pendres_boundary_options *window, size_t least)
{
  pendres_boundary *b = NULL;
  check_ok(pendres_boundary_find(f->ctx, &f->saddle, window, &b));
  const size_t n = b->count;
  const double *x = b->x, *v = b->v;
  const double *error = b->error;
  const int *piece = b->piece;
  /* Twice the deviation asked for: the estimate of the bend carries a margin of 1.5. */
  assert_true(b->bound <= 2.0 * window->deviation);
  assert_true(b->bound > 0.0);

  double *px = malloc(2 * n * sizeof *px), *pv = malloc(2 * n * sizeof *pv);
  pendres_settled *outcome = malloc(2 * n * sizeof *outcome);
  assert_true(px != NULL && pv != NULL && outcome != NULL);
  size_t m = 0;
  for (size_t i = 1; i + 1 < n; i += 5) {
    if (piece[i - 1] != piece[i] || piece[i + 1] != piece[i]) continue;
    const double tx = x[i + 1] - x[i - 1], tv = v[i + 1] - v[i - 1], length = hypot(tx, tv);
    if (!(length > 0.0)) continue;
    /* 1e-8: settling itself moves a basin's boundary by about its tolerance. */
    const double away = 3.0 * error[i] + 1e-8;
    for (int side = -1; side <= 1; side += 2, m++) {
      px[m] = x[i] - side * away * tv / length;
      pv[m] = v[i] + side * away * tx / length;
    }
  }
  check_ok(pendres_attractors_settle(f->ctx, f->found, m, px, pv, outcome));
  size_t same = 0;
  for (size_t i = 0; i < m; i += 2) {
    assert_true(outcome[i].attractor >= 0 && outcome[i + 1].attractor >= 0);
    same += outcome[i].attractor == outcome[i + 1].attractor &&
      outcome[i].well == outcome[i + 1].well;
  }
  /* Two strands of the boundary may be so close that both are stepped over: a few in a thousand. */
  assert_true(m > least);
  assert_true(same <= m / 500);
  free(px);
  free(pv);
  free(outcome);
  pendres_boundary_free(b);
}

static void sides_go_to_different_attractors(void **state)
{
  const pendres_boundary_options window = {.v_low = -1.2, .v_high = 1.2, .deviation = 1e-6};
  check_sides(*state, &window, 400);
}

/* ---- other models ---- */

/* A torque moves the wells' bottoms, a parametric drive tilts them twice a period, and Duffing's
   oscillator has no wells side by side: their boundaries part attractors too. */
static void boundaries_of_other_models(void **state)
{
  (void)state;
  static const struct {
    pendres_pendulum p;
    size_t least;
  } cases[] = {
    {{.damping = 0.14, .drive_amplitude = 0.2, .drive_frequency = 0.82, .torque = 0.02,
      .parametric_amplitude = 0.05}, 200},
    {{.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.35,
      .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}}, 100}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const pendres_boundary_options window = {.x_low = -1.5, .x_high = 1.5, .v_low = -1.2,
                                             .v_high = 1.2, .deviation = 1e-6};
    fixture f = {NULL, NULL, {.period = 0}};
    check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-9}, &f.ctx));
    check_ok(pendres_attractors_find(f.ctx, &cases[i].p, 0, NULL, NULL, &f.found));
    check_ok(pendres_saddle_find(f.ctx, &pendres_attractors_get(f.found, 0)->orbit, &f.saddle));
    check_sides(&f, &window, cases[i].least);
    pendres_attractors_free(f.found);
    pendres_context_free(f.ctx);
  }
}

/*
 * x'' + gamma x' - x = F0 cos omega t has one orbit, a saddle, and its stable manifold is the
 * straight line through it along which errors shrink as exp(-lambda t), lambda (lambda - gamma) =
 * 1: within the errors that are claimed, and rounding. A line does not bend, so that with a loose
 * tolerance the errors of integration are left, 2e-11, of which the bound may be fifty times.
 */
static void check_linear_saddle(double tolerance, double bound)
{
  const double gamma = 0.3, drive = 0.5, omega = 1.1, square = 1.0 + omega * omega;
  const double lambda = 0.5 * (gamma + sqrt(gamma * gamma + 4.0));
  const double of_cosine = -drive * square / (square * square + gamma * gamma * omega * omega);
  const double of_sine = -of_cosine * gamma * omega / square;
  const pendres_orbit_guess guess = {
    .pendulum = {.damping = gamma, .drive_amplitude = drive, .drive_frequency = omega,
                 .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0}},
    .x = of_cosine, .v = omega * of_sine, .period = 1};
  const pendres_boundary_options window = {.x_low = -3.0, .x_high = 3.0, .v_low = -3.0,
                                           .v_high = 3.0};
  pendres_context *ctx = NULL;
  pendres_boundary *b = NULL;
  pendres_orbit saddle;
  pendres_status outcome = PENDRES_INTERNAL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &saddle, &outcome));
  check_near(saddle.x, of_cosine, saddle.x_error);
  check_ok(pendres_boundary_find(ctx, &saddle, &window, &b));
  double low = 0.0, high = 0.0;
  for (size_t i = 0; i < b->count; i++) {
    const double x = b->x[i], v = b->v[i];
    const double off = v - omega * of_sine + lambda * (x - of_cosine);
    check_near(off / hypot(1.0, lambda), 0.0, b->error[i]);
    low = fmin(low, v);
    high = fmax(high, v);
  }
  assert_true(low < -2.9 && high > 2.9 && b->bound < bound);
  /* With a polynomial force what is outside may come back, for all that is known. */
  assert_int_equal(b->complete, 0);
  pendres_boundary_free(b);
  pendres_context_free(ctx);
}

static void a_linear_saddle(void **state)
{
  (void)state;
  check_linear_saddle(1e-9, 1e-7);
  check_linear_saddle(1e-4, 1e-9);
}

/* A coarser curve lies on the finer one, to the sum of their bounds. */
static void coarse_and_fine_agree(void **state)
{
  fixture *f = *state;
  pendres_boundary *coarse = NULL, *fine = NULL;
  const pendres_boundary_options rough = {.x_low = 0.0, .x_high = 3.0, .v_low = 0.2,
                                          .v_high = 1.5, .deviation = 1e-3};
  pendres_boundary_options smooth = rough;
  smooth.deviation = 1e-6;
  check_ok(pendres_boundary_find(f->ctx, &f->saddle, &rough, &coarse));
  check_ok(pendres_boundary_find(f->ctx, &f->saddle, &smooth, &fine));
  const double *cx = coarse->x, *cv = coarse->v;
  const double *fx = fine->x, *fv = fine->v;
  const int *piece = fine->piece;
  assert_true(fine->count > 2 * coarse->count);
  for (size_t i = 0; i < coarse->count; i++) {
    double nearest = INFINITY;
    for (size_t k = 0; k + 1 < fine->count; k++) {
      if (piece[k] != piece[k + 1]) continue;
      const double dx = fx[k + 1] - fx[k], dv = fv[k + 1] - fv[k];
      const double t = ((cx[i] - fx[k]) * dx + (cv[i] - fv[k]) * dv) / (dx * dx + dv * dv);
      const double s = fmin(1.0, fmax(0.0, t));
      nearest = fmin(nearest, hypot(cx[i] - fx[k] - s * dx, cv[i] - fv[k] - s * dv));
    }
    /* Points of the coarse curve are exact but for the integration; chords of the fine one bend by
       1e-6. At the window's edge the last chord may be cut off: by less than its length. */
    const int at_edge = cx[i] < 0.02 || cx[i] > 2.98 || cv[i] < 0.22 || cv[i] > 1.48;
    check_near(nearest, 0.0, at_edge ? 0.05 : 2e-6);
  }
  pendres_boundary_free(coarse);
  pendres_boundary_free(fine);
}

static void mistakes_are_told(void **state)
{
  fixture *f = *state;
  pendres_boundary *b = NULL;
  const pendres_boundary_options empty = {.x_low = 2.0, .x_high = 1.0};
  assert_int_equal(pendres_boundary_find(f->ctx, &f->saddle, &empty, &b), PENDRES_INVALID_ARGUMENT);
  assert_null(b);
  /* An attractor has no stable manifold of one dimension. */
  const pendres_orbit *sa = &pendres_attractors_get(f->found, 0)->orbit;
  assert_int_equal(pendres_boundary_find(f->ctx, sa, NULL, &b), PENDRES_INVALID_ARGUMENT);
  assert_null(b);
  /* Too few points allowed: what there is, and it says so. */
  const pendres_boundary_options few = {.most_points = 300};
  check_ok(pendres_boundary_find(f->ctx, &f->saddle, &few, &b));
  assert_int_equal(b->complete, 0);
  assert_true(b->count <= 600);
  pendres_boundary_free(b);
  /* LA's branch does not come back here: it joins SA's at higher damping only. */
  pendres_orbit none;
  assert_int_equal(
    pendres_saddle_find(f->ctx, &pendres_attractors_get(f->found, 1)->orbit, &none),
    PENDRES_NOT_FOUND);
  pendres_boundary_free(NULL);
}

/* How many nodes a curve gets that may have so many. */
static size_t nodes_of(pendres_context *ctx, const pendres_orbit *saddle, size_t most)
{
  const pendres_boundary_options o = {.x_low = -1.5, .x_high = 4.5, .v_low = -2.5, .v_high = 2.5,
                                      .spacing = 0.05, .deviation = 1e-5, .most_points = most};
  pendres_boundary_seed seed;
  pendres_boundary_curve curve = {.complete = 1};
  check_ok(pendres_boundary_grow_seed(ctx, saddle, saddle->steps, &seed));
  check_ok(pendres_boundary_grow(ctx, &seed, &o, &curve));
  const size_t count = curve.count;
  pendres_boundary_grow_free(&curve);
  return count;
}

/* Both sides grow on two threads, and the curve is that of one thread, byte for byte, also where
   the second side is short of what the first has left of the points allowed. */
static void threads_agree(void **state)
{
  const fixture *f = *state;
  pendres_context *one = NULL, *two = NULL;
  check_ok(pendres_context_create(&(pendres_options){.threads = 1}, &one));
  check_ok(pendres_context_create(&(pendres_options){.threads = 2}, &two));
  pendres_boundary *all = NULL;
  check_ok(pendres_boundary_find(one, &f->saddle, NULL, &all));
  int cut = 0;
  for (size_t part = 1; part <= 12; part++) {
    const pendres_boundary_options o = {.most_points = part * all->count / 3};
    pendres_boundary *a = NULL, *b = NULL;
    check_ok(pendres_boundary_find(one, &f->saddle, &o, &a));
    check_ok(pendres_boundary_find(two, &f->saddle, &o, &b));
    assert_true(nodes_of(two, &f->saddle, o.most_points) <= o.most_points);
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->complete, b->complete);
    assert_memory_equal(a->x, b->x, a->count * sizeof *a->x);
    assert_memory_equal(a->v, b->v, a->count * sizeof *a->v);
    assert_memory_equal(a->error, b->error, a->count * sizeof *a->error);
    assert_memory_equal(a->piece, b->piece, a->count * sizeof *a->piece);
    cut += a->count < all->count;
    pendres_boundary_free(a);
    pendres_boundary_free(b);
  }
  assert_true(cut > 0 && cut < 12);
  pendres_boundary_free(all);
  pendres_context_free(one);
  pendres_context_free(two);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(saddle_matches_reference),      cmocka_unit_test(curve_is_a_curve),
    cmocka_unit_test(sides_go_to_different_attractors), cmocka_unit_test(coarse_and_fine_agree),
    cmocka_unit_test(mistakes_are_told), cmocka_unit_test(boundaries_of_other_models),
    cmocka_unit_test(a_linear_saddle), cmocka_unit_test(threads_agree),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
