/*
 * test_trapping_ring.c -- rings on the edge of ellipses: arcs between their points, and their
 * precision.
 */
#include "check.h"

#include <pendres/pendres.h>

#include "golden.h"
#include "settling/trapping/trapping_ring.h"

/*
 * Rings of ensembles are run in single precision, which rounds by 1e-6 a period, a hundredth of
 * what their steps may be off by. They find what rings in double precision do: radii are told apart
 * by factors of 1.2, from a first one that follows the departure of the map to some 1e-5. A torque
 * too small for any digit has rings run by kernels that have no single precision.
 */
static void rings_in_single_precision(void **state)
{
  enum { N = 8 };
  pendres_context *ctx = NULL;
  pendres_orbit_guess guess[N];
  pendres_status outcome[N];
  pendres_orbit plain[N], other[N];
  pendres_trapping_ellipse narrow[N], wide[N];
  pendres_cost cost[2];
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int i = 0; i < N; i++) {
    const pendres_pendulum p = {
      .damping = 0.12 + 0.01 * i, .drive_amplitude = 0.2, .drive_frequency = 0.25 * pi};
    guess[i] = (pendres_orbit_guess){.pendulum = p, .x = 2.11, .v = 0.11, .period = 1};
  }
  check_ok(pendres_orbit_find(ctx, N, guess, PENDRES_ORBIT_PLAIN, plain, outcome));
  for (int i = 0; i < N; i++) {
    check_ok(outcome[i]);
    other[i] = plain[i];
    other[i].pendulum.torque = 1e-300;
  }
  for (int k = 0; k < 2; k++) {
    pendres_context_cost_reset(ctx);
    check_ok(pendres_trapping_find(ctx, N, k == 0 ? plain : other, PENDRES_TRAPPING_FEW,
                                   k == 0 ? narrow : wide));
    pendres_context_cost(ctx, &cost[k]);
  }
  for (int i = 0; i < N; i++) {
    assert_true(wide[i].radius > 0.1);
    assert_true(fabs(narrow[i].radius / wide[i].radius - 1.0) < 1e-3);
  }
  assert_true(cost[0].pendulum_periods == cost[1].pendulum_periods);
  pendres_context_free(ctx);
}

/*
 * The image of a ring of radius one after one look, known everywhere: a circle of half the radius
 * with a tongue of a given height and width on it, at a given angle.
 */
typedef struct tongue {
  double height, width, at;
} tongue;

static void tongue_at(const tongue *g, double s, double z[2], double d[2])
{
  const double u = (s - g->at) / g->width, more = g->height * exp(-u * u);
  const double r = 0.5 + more, slope = -2.0 * u / g->width * more;
  z[0] = r * cos(s);
  z[1] = r * sin(s);
  d[0] = slope * cos(s) - r * sin(s);
  d[1] = slope * sin(s) + r * cos(s);
}

enum { TONGUE_MOST = 48 };

/* The second points, from which tangents are taken, are a tenth of a radian further on. */
static void tongue_ring(const tongue *g, pendres_trapping_ring *r, pendres_trapping_point *points)
{
  static pendres_trapping_point further[TONGUE_MOST];
  for (int i = 0; i < r->points; i++) {
    double z[2], d[2];
    points[i] = (pendres_trapping_point){
      .of = r, .angle = 2.0 * pi * i / r->points, .looks = 1, .home = 1, .further = &further[i]};
    tongue_at(g, points[i].angle, z, d);
    points[i].y[1] = z[0];
    points[i].w[1] = z[1];
    further[i] = (pendres_trapping_point){.of = r, .angle = points[i].angle + 0.1, .looks = 1};
    further[i].y[1] = z[0] + 0.1 * d[0];
    further[i].w[1] = z[1] + 0.1 * d[1];
    assert_true(hypot(z[0], z[1]) <= r->home);
  }
}

/* A tongue between two points leaves the ellipse that is known: the points alone do not see it. */
static void tongues_between_points(void **state)
{
  static const pendres_trapping_ellipse unit = {
    .metric = {1.0, 0.0, 1.0}, .period = 1, .turn = 6.28318530717958647693};
  static pendres_trapping_point points[TONGUE_MOST];
  pendres_trapping_arc open[TONGUE_MOST];
  (void)state;
  for (int n = 16; n <= 48; n += 16) {
    pendres_trapping_ring r = {
      .ellipse = &unit, .radius = 1.0, .home = 0.9, .room = 1.0, .points = n, .looks = 1,
      .point = points};
    /* Half an arc from the points on either side; the tip is at 1.05. */
    const tongue out = {.height = 0.55, .width = 3.2 / n, .at = pi / n};
    tongue_ring(&out, &r, points);
    assert_true(pendres_trapping_ring_holds(&r));
    assert_true(pendres_trapping_ring_open(&r, open) >= 1);
    assert_true(open[0].a == &points[0] && open[0].b == &points[1]);
    /* One that stays well inside, and a plain circle, need nothing more. */
    const tongue in = {.height = 0.2, .width = 6.4 / n, .at = pi / n}, none = {.width = 1.0};
    tongue_ring(&in, &r, points);
    assert_int_equal(pendres_trapping_ring_open(&r, open), 0);
    tongue_ring(&none, &r, points);
    assert_int_equal(pendres_trapping_ring_open(&r, open), 0);
    /* A tangent that is not known, as the second point was not followed, shows nothing for the arcs
       on either side. */
    const pendres_trapping_point lost = {.of = &r, .angle = points[3].angle + 0.1};
    points[3].further = &lost;
    assert_int_equal(pendres_trapping_ring_open(&r, open), 2);
  }
}

/* Arcs depart from their chords by less than the bound, and by no less than a tenth of it. */
static void departures_are_bounded(void **state)
{
  static const pendres_trapping_ellipse unit = {
    .metric = {1.0, 0.0, 1.0}, .period = 1, .turn = 6.28318530717958647693};
  static const tongue kinds[] = {{.width = 1.0}, {.height = 0.5, .width = 0.7, .at = 1.0}};
  (void)state;
  for (int kind = 0; kind < 2; kind++)
    for (double from = 0.0; from < 2.0; from += 0.05) {
      const double h = 2.0 * pi / 16.0;
      double a[2], b[2], ta[2], tb[2], z[2], d[2], worst = 0.0;
      tongue_at(&kinds[kind], from, a, ta);
      tongue_at(&kinds[kind], from + h, b, tb);
      const double chord[2] = {b[0] - a[0], b[1] - a[1]};
      for (int i = 1; i < 64; i++) {
        tongue_at(&kinds[kind], from + h * i / 64, z, d);
        const double share = i / 64.0;
        worst = fmax(worst, hypot(z[0] - a[0] - share * chord[0], z[1] - a[1] - share * chord[1]));
      }
      const double bound = pendres_trapping_departure(
        &unit, chord, (double[2]){h * ta[0], h * ta[1]}, (double[2]){h * tb[0], h * tb[1]});
      assert_true(worst < bound && worst > 0.1 * bound);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rings_in_single_precision),
    cmocka_unit_test(tongues_between_points),
    cmocka_unit_test(departures_are_bounded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
