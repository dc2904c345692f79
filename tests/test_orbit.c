/*
 * test_orbit.c -- periodic orbits against closed forms, exact identities, and the
 * extended-precision reference.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "engine/kernels/tables.h"
#include "golden.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

static pendres_context *context_with(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* All golden orbits refined from a start a little off; the caller frees. */
static pendres_orbit *golden_refined(pendres_context *ctx, size_t *count)
{
  const size_t n = sizeof golden_orbits / sizeof golden_orbits[0];
  pendres_orbit_guess *guess = calloc(n, sizeof *guess);
  pendres_orbit *orbit = calloc(n, sizeof *orbit);
  pendres_status *outcome = calloc(n, sizeof *outcome);
  assert_true(guess != NULL && orbit != NULL && outcome != NULL);
  for (size_t i = 0; i < n; i++) {
    const reference_cycle *g = &golden_orbits[i];
    guess[i] = (pendres_orbit_guess){
      .pendulum = {.damping = (double)g->damping, .drive_amplitude = (double)g->drive_amplitude,
                   .drive_frequency = (double)g->drive_frequency},
      .x = (double)g->y + half_pi + 1e-3, .v = (double)g->v - 1e-3,
      .period = (int)g->period, .winding = (int)g->winding};
  }
  check_ok(pendres_orbit_find(ctx, n, guess, PENDRES_ORBIT_FREQUENCY_SLOPE, orbit, outcome));
  for (size_t i = 0; i < n; i++) assert_int_not_equal(outcome[i], PENDRES_NOT_CONVERGED);
  free(guess);
  free(outcome);
  *count = n;
  return orbit;
}

/* Angles compare modulo whole turns. */
static double nearest_turn(double x, double to)
{
  return x - two_pi * rint((x - to) / two_pi);
}

/* Strobe point and loop area against the reference, within ten times what is claimed. */
static void check_point(const pendres_orbit *o, const reference_cycle *g)
{
  const double x = (double)g->y + half_pi;
  check_near(nearest_turn(o->x, x), x, 10.0 * o->x_error);
  check_near(o->v, (double)g->v, 10.0 * o->v_error);
  check_near(o->loop_area, (double)g->loop_area, 10.0 * o->loop_area_error);
}

/*
 * The promise of the error estimates: never smaller than a tenth of the true error; and what is
 * asked for is met.
 */
static void honest_against_reference(void **state)
{
  static const double tolerances[] = {1e-5, 1e-8, 1e-11};
  (void)state;
  for (size_t t = 0; t < 3; t++) {
    pendres_context *ctx = context_with(tolerances[t]);
    size_t n = 0;
    pendres_orbit *orbit = golden_refined(ctx, &n);
    for (size_t i = 0; i < n; i++) {
      const reference_cycle *g = &golden_orbits[i];
      const pendres_orbit *o = &orbit[i];
      check_point(o, g);
      check_near(o->dissipation, (double)g->dissipation, 10.0 * o->dissipation_error);
      check_near(o->amplitude, (double)g->amplitude, 10.0 * o->amplitude_error);
      check_near(o->first_harmonic_amplitude, (double)g->first_harmonic_amplitude,
                 10.0 * o->first_harmonic_amplitude_error);
      check_near(o->phase_lag, (double)g->phase_lag, 10.0 * o->phase_lag_error);
      check_near(o->mean_power, (double)g->mean_power, 10.0 * o->mean_power_error);
      assert_true(o->loop_area_error <= tolerances[t] && o->x_error <= tolerances[t]);
    }
    free(orbit);
    pendres_context_free(ctx);
  }
}

/*
 * The same away from the golden orbits, on a lattice, and for slopes and multipliers: no two
 * computations that the estimate compares may be wrong in the same way. Among the last are sets
 * at which the slope was once off by 240 times its estimate, x and amplitude by 14 and 11 times.
 */
static void honest_on_a_lattice(void **state)
{
  static const double found[][3] = {{0.09666, 0.1210, 0.89160}, {0.11237, 0.1073, 0.91148},
                                    {0.17259, 0.1205, 0.82623}, {0.41166, 0.2142, 0.84453},
                                    {0.14559, 0.1333, 0.90889}, {0.08184, 0.2360, 0.81925},
                                    {0.12498, 0.2021, 1.08861}, {0.72750, 0.2000, 0.92797}};
  static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10};
  enum { SIDE = 7, FOUND = sizeof found / sizeof found[0], ALL = SIDE * SIDE + FOUND };
  pendres_orbit_guess guess[ALL];
  reference_cycle exact[ALL];
  pendres_orbit orbit[ALL];
  pendres_status outcome[ALL];
  (void)state;
  for (int i = 0; i < ALL; i++) {
    pendres_pendulum p = {.damping = 0.08 * pow(1.6, i % SIDE),
                          .drive_amplitude = 0.15,
                          .drive_frequency = 0.55 + 0.1 * (i / SIDE)};
    if (i >= SIDE * SIDE)
      p = (pendres_pendulum){.damping = found[i - SIDE * SIDE][0],
                             .drive_amplitude = found[i - SIDE * SIDE][1],
                             .drive_frequency = found[i - SIDE * SIDE][2]};
    long double y = 0.0L, v = 0.0L;
    check_ok(reference_advance(&p, &y, &v, NULL, 100));
    check_ok(reference_orbit(&p, y, v, 1, 0, &exact[i]));
    guess[i] = (pendres_orbit_guess){.pendulum = p, .x = (double)exact[i].y + half_pi + 1e-3,
                                     .v = (double)exact[i].v, .period = 1};
  }
  for (size_t t = 0; t < sizeof tolerances / sizeof tolerances[0]; t++) {
    pendres_context *ctx = context_with(tolerances[t]);
    check_ok(pendres_orbit_find(ctx, ALL, guess, PENDRES_ORBIT_FREQUENCY_SLOPE, orbit, outcome));
    for (int i = 0; i < ALL; i++) {
      const reference_cycle *e = &exact[i];
      const pendres_orbit *o = &orbit[i];
      check_near(o->x, (double)e->y + half_pi, 10.0 * o->x_error);
      check_near(o->v, (double)e->v, 10.0 * o->v_error);
      check_near(o->loop_area, (double)e->loop_area, 10.0 * o->loop_area_error);
      check_near(o->amplitude, (double)e->amplitude, 10.0 * o->amplitude_error);
      check_near(o->loop_area_slope, (double)e->loop_area_slope, 10.0 * o->loop_area_slope_error);
      check_near(o->multiplier_re[0], (double)e->multiplier_re[0], 10.0 * o->multiplier_error);
    }
    pendres_context_free(ctx);
  }
}

/* The same for every table, down to where rounding rules: a table's own. */
static void honest_with_every_table(void **state)
{
  static const double tolerances[] = {1e-10, 1e-12, 1e-13};
  (void)state;
  for (int table = PENDRES_TABLE_TP8; table < PENDRES_TABLE_COUNT; table++)
    for (size_t t = pendres_tables_order((pendres_table)table) < 8 ? 2 : 0; t < 3; t++) {
      pendres_context *ctx = NULL;
      const int weak = pendres_tables_order((pendres_table)table) < 8;
      const double tolerance = weak ? 1e-9 : tolerances[t];
      check_ok(pendres_context_create(
        &(pendres_options){.tolerance = tolerance, .table = (pendres_table)table}, &ctx));
      size_t n = 0;
      pendres_orbit *orbit = golden_refined(ctx, &n);
      for (size_t i = 0; i < n; i++) check_point(&orbit[i], &golden_orbits[i]);
      free(orbit);
      pendres_context_free(ctx);
    }
}

/*
 * On a closed orbit what the drive gives is dissipated: within ten times the tolerance asked
 * for. The multipliers' product is exp(-damping q tau) (Liouville): to rounding, since the second
 * one is taken from it; the determinant of the monodromy matrix is independent of that.
 */
static void exact_identities(void **state)
{
  static const double tolerances[] = {1e-6, 1e-9};
  (void)state;
  for (size_t t = 0; t < 2; t++) {
    pendres_context *ctx = context_with(tolerances[t]);
    size_t n = 0;
    pendres_orbit *orbit = golden_refined(ctx, &n);
    for (size_t i = 0; i < n; i++) {
      const pendres_orbit *o = &orbit[i];
      const pendres_pendulum *p = &o->pendulum;
      const double shrink = exp(-p->damping * o->period * two_pi / p->drive_frequency);
      const double det = o->monodromy[0][0] * o->monodromy[1][1] -
                         o->monodromy[0][1] * o->monodromy[1][0];
      /* Entries of size ten and more cancel in the determinant. */
      const double size = 1.0 + fabs(o->monodromy[0][0] * o->monodromy[1][1]);
      check_near(o->loop_area, o->dissipation, 10.0 * tolerances[t]);
      check_near(det, shrink, 10.0 * tolerances[t] * size);
    }
    free(orbit);
    pendres_context_free(ctx);
  }
}

/*
 * Linear limit, F0 = 1e-6: amplitude, phase lag and loop area within 1e-9 relative of the closed
 * form; sin y differs from y by amplitude^2 / 8 relative, at most 1e-11 / 8 here.
 */
static void linear_limit(void **state)
{
  static const double sets[][2] = {{0.3, 0.9}, {0.5, 1.1}, {1.0, 0.7}, {0.4, 0.5}};
  pendres_context *ctx = context_with(1e-11);
  (void)state;
  for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
    const pendres_orbit_guess g = {
      .pendulum = {.damping = sets[i][0], .drive_amplitude = 1e-6, .drive_frequency = sets[i][1]},
      .x = half_pi, .period = 1};
    pendres_orbit o;
    pendres_harmonic h;
    pendres_status outcome;
    check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    check_ok(pendres_harmonic_find(&g.pendulum, &h));
    check_relative(o.amplitude, h.amplitude, 1e-9);
    check_relative(o.phase_lag, h.phase_lag, 1e-9);
    check_relative(o.loop_area, h.loop_area, 1e-9);
    assert_true(o.stable && o.symmetric);
  }
  pendres_context_free(ctx);
}

/* The slope of the loop area by frequency against a difference quotient: centred, so off by the
   third derivative (about 100) times step^2 / 6, and the areas' errors over the step. */
static void slopes(void **state)
{
  pendres_context *ctx = context_with(1e-11);
  const double step = 1e-5;
  pendres_orbit_guess g = {
    .pendulum = {.damping = 0.31, .drive_amplitude = 0.17, .drive_frequency = 0.83},
    .x = half_pi, .period = 1};
  pendres_orbit at, below, above;
  pendres_status outcome;
  (void)state;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_FREQUENCY_SLOPE, &at, &outcome));
  g.pendulum.drive_frequency = 0.83 - step;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &below, &outcome));
  g.pendulum.drive_frequency = 0.83 + step;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &above, &outcome));
  const double slack = 100.0 * step * step + (above.loop_area_error + below.loop_area_error) / step;
  check_near(at.loop_area_slope, (above.loop_area - below.loop_area) / (2.0 * step), slack);
  check_near(at.frequency_derivative[0], (above.x - below.x) / (2.0 * step),
             100.0 * step * step + (above.x_error + below.x_error) / step);
  check_near(at.frequency_derivative[1], (above.v - below.v) / (2.0 * step),
             100.0 * step * step + (above.v_error + below.v_error) / step);
  pendres_context_free(ctx);
}

enum { TOLERANCES = 4 };

/* The orbits next to a fold by each tolerance, guessed at g, against the exact one (NULL: gone). */
static void check_next_to_fold(pendres_context *const ctx[TOLERANCES],
                               const pendres_orbit_guess *g,
                               const reference_cycle *fold,
                               const reference_cycle *exact)
{
  for (int t = 0; t < TOLERANCES; t++) {
    pendres_orbit o;
    pendres_status outcome;
    check_ok(pendres_orbit_find(ctx[t], 1, g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    const double y = nearest_turn(o.x - half_pi, (double)fold->y);
    const int found = outcome != PENDRES_NOT_CONVERGED &&
                      hypot(y - (double)fold->y, o.v - (double)fold->v) < 0.3;
    if (exact == NULL) assert_false(found);
    else if (t == TOLERANCES - 1) assert_true(found);
    if (exact != NULL && found) /* or its twin, where the guess led there */
      assert_true(fabs((double)((long double)o.x - half_pi - exact->y)) < 10.0 * o.x_error ||
                  (o.multiplier_re[0] < 1.0) != (exact->multiplier_re[0] < 1.0L));
  }
}

/*
 * Beyond a fold nothing is found where the orbit was: another orbit (all are further away than
 * 0.3), or none. Before it stands a pair of orbits, half the distance to each other away from the
 * fold, found with an honest error or not at all, and at the tightest tolerance found. Folds are
 * known to all digits, so that 1e-12 from them is meant as it stands.
 */
static void no_ghosts(void **state)
{
  static const double tolerances[TOLERANCES] = {1e-6, 1e-8, 1e-10, 1e-13};
  pendres_context *ctx[TOLERANCES];
  (void)state;
  for (int t = 0; t < TOLERANCES; t++) ctx[t] = context_with(tolerances[t]);
  for (size_t k = 0; k < sizeof golden_folds / sizeof golden_folds[0]; k += 3) {
    const reference_cycle *fold = &golden_folds[k];
    for (double off = 1e-3; off > 0.5e-12; off *= 0.1)
      for (int side = -1; side <= 1; side += 2) {
        pendres_orbit_guess g = {.x = (double)fold->y + half_pi, .v = (double)fold->v, .period = 1,
                                 .pendulum = {.damping = (double)fold->damping,
                                              .drive_amplitude = (double)fold->drive_amplitude}};
        g.pendulum.drive_frequency = (double)(fold->drive_frequency + side * (long double)off);
        reference_cycle exact;
        int there = 0;
        for (int i = -4; i <= 4 && !there; i++)
          there = reference_orbit(&g.pendulum, fold->y + i * sqrtl(off), fold->v, 1, 0,
                                          &exact) == PENDRES_OK &&
                  hypotl(exact.y - fold->y, exact.v - fold->v) < 0.3L;
        if (there) g.x = (double)exact.y + half_pi + 0.1 * sqrt(off), g.v = (double)exact.v;
        check_next_to_fold(ctx, &g, fold, there ? &exact : NULL);
      }
  }
  for (int t = 0; t < TOLERANCES; t++) pendres_context_free(ctx[t]);
}

/*
 * Loose tolerances, at which samples are few and the method's order sets in late, and orbits next
 * to bifurcations: sets at which amplitude was once off by 274 times its error, dissipation by 22,
 * multipliers by 15 and 54. What is claimed holds.
 */
static void honest_with_few_steps(void **state)
{
  static const struct {
    pendres_orbit_guess guess;
    double tolerance;
    pendres_orbit_want want;
  } cases[] = {
    {{{0.6711816293356647, 1.2550122570249236, 1.3565588422321395, 0.0}, 0.880588737476872,
      0.8901813269976313, 1, 0}, 1e-6},
    {{{0.10916018862365255, 1.3368108390404172, 1.0562896314497776, 0.0}, -0.5502909181378275,
      0.3832263912518542, 1, 0}, 1e-2},
    {{{0.040708302111654285, 0.4007269722105567, 0.6117703965197987, 0.0}, 10.230660039567459,
      0.24500534675978197, 4, 0}, 1e-3},
    {{{0.35831845560312875, 0.10701117940739997, 0.30988483389971, 0.0}, 1.6876348651226218,
      0.0046317222048377696, 1, 0}, 1.5e-4},
    {{{2.2003953400251768, 1.2185993756667519, 1.08229071755255, 0.0}, 1.527564185432563,
      0.55116339809086856, 1, 0}, 2.5e-4},
    /* Errors grow 700-fold on the way, and fade again before the period ends. */
    {{{2.8173128501755933, 1.3429385952269313, 0.1031835275137483, 0.0}, -1.868351988432277,
      0.33668723350471952, 1, 0}, 6.0036794160532716e-11},
    /* A multiplier of -131801: Newton's last step is 1e-10, what it leaves is of the same size. */
    {{{0.36717280626144772, 1.250929277379889, 0.1570062604003174, 0.0}, -2.7311279229889096,
      2.4684126908307276, 5, -5}, 4.1074576827397002e-08},
    {{{0.36717280626144772, 1.250929277379889, 0.1570062604003174, 0.0}, -2.7311279229889096,
      2.4684126908307276, 5, -5}, 4.1074576827397002e-08, PENDRES_ORBIT_FREQUENCY_SLOPE},
    /* Ten and fourteen steps agree by chance, all along the orbit. */
    {{{0.079457250981890937, 0.27065976251055923, 0.81543839856463807, 0.0}, -0.23516248376414928,
      0.73935242549203839, 1, 0}, 2.5297305363878696e-05},
    /* Of twelve samples the eleventh harmonic passes for the first one. */
    {{{0.16192889299161228, 0.79768160754008333, 0.88413416847826809, 0.0}, -6.8081153352809425,
      0.73171877585657308, 1, 0}, 0.00032756433036015083, PENDRES_ORBIT_FREQUENCY_SLOPE},
    /* Nearly linear: twelve and eighteen steps agree by chance in the trace, in both its parts. */
    {{{0.039478388870170758, 0.012935301914741442, 0.38724059619651491, 0.0}, 1.5860087106,
      0.000106, 1, 0}, 5.4e-4},
  };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    pendres_context *ctx = context_with(cases[i].tolerance);
    const pendres_orbit_guess *g = &cases[i].guess;
    pendres_orbit o;
    pendres_status outcome;
    reference_cycle e;
    check_ok(pendres_orbit_find(ctx, 1, g, cases[i].want, &o, &outcome));
    check_ok(outcome);
    check_ok(reference_orbit(&g->pendulum, o.x - half_pi, o.v, g->period, g->winding, &e));
    check_near(nearest_turn(o.x, (double)e.y + half_pi), (double)e.y + half_pi, o.x_error);
    check_near(o.v, (double)e.v, o.v_error);
    check_near(o.loop_area, (double)e.loop_area, o.loop_area_error);
    check_near(o.dissipation, (double)e.dissipation, o.dissipation_error);
    check_near(o.amplitude, (double)e.amplitude, o.amplitude_error);
    check_near(remainder(o.phase_lag - (double)e.phase_lag, two_pi), 0.0, o.phase_lag_error);
    check_near(o.multiplier_re[0], (double)e.multiplier_re[0], o.multiplier_error);
    check_near(fabs(o.multiplier_im[0]), fabs((double)e.multiplier_im[0]), o.multiplier_error);
    if (cases[i].want == PENDRES_ORBIT_FREQUENCY_SLOPE)
      check_near(o.loop_area_slope, (double)e.loop_area_slope, o.loop_area_slope_error);
    pendres_context_free(ctx);
  }
}

/* Points along an orbit against the reference, which is asked at drive phase 0 alone: the point
   of an orbit of period 5 at which it is found, carried on to the others. */
static void samples_know_their_error(void **state)
{
  static const double tolerances[] = {1e-4, 1e-7, 1e-10};
  const pendres_orbit_guess g = {{0.040708302111654285, 0.4007269722105567, 0.6117703965197987,
                                  0.0}, 10.230660039567459, 0.24500534675978197, 4, 0};
  (void)state;
  for (size_t t = 0; t < 3; t++) {
    pendres_context *ctx = context_with(tolerances[t]);
    pendres_orbit o;
    pendres_status outcome;
    reference_cycle e;
    double x[4], v[4], error[2] = {NAN, NAN};
    check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    check_ok(reference_orbit(&g.pendulum, o.x - half_pi, o.v, 4, 0, &e));
    check_ok(pendres_orbit_sample(ctx, &o, 1, x, v, error));
    assert_true(error[0] <= tolerances[t] && error[1] <= tolerances[t]);
    for (int k = 0; k < 4; k++) {
      long double y = e.y, w = e.v;
      check_ok(reference_advance(&g.pendulum, &y, &w, NULL, k));
      check_near(nearest_turn(x[k], (double)y + half_pi), (double)y + half_pi, error[0]);
      check_near(v[k], (double)w, error[1]);
    }
    /* Without errors, and with a count of its own: as exact as the orbit. */
    double all[8];
    check_ok(pendres_orbit_sample(ctx, &o, 2, all, NULL, NULL));
    for (int k = 0; k < 4; k++) check_near(all[2 * k], x[k], 10.0 * o.x_error + error[0]);
    o.period = 0;
    assert_int_equal(pendres_orbit_sample(ctx, &o, 2, all, NULL, NULL), PENDRES_INVALID_ARGUMENT);
    pendres_context_free(ctx);
  }
}

/*
 * Samples are in the coordinate of the orbit's own model, which starts elsewhere than a pendulum's.
 * Here the orbit is its point, integrated on; and beside an orbit in one well of a double well
 * there is its mirror image, which is looked for from a sample.
 */
static void samples_of_other_models(void **state)
{
  const pendres_pendulum p[] = {
    {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.2,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}},
    {.damping = 0.2, .drive_amplitude = 0.1, .drive_frequency = 1.0,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}},
    {.damping = 0.5, .drive_amplitude = 0.3, .drive_frequency = 1.2, .force = PENDRES_FORCE_SQUID,
     .force_coefficients = {0.5}}};
  enum { COUNT = 4 };
  pendres_context *ctx = context_with(1e-9);
  (void)state;
  for (size_t m = 0; m < sizeof p / sizeof p[0]; m++) {
    const double from = 1.0, rest = 0.0;
    double x[COUNT], v[COUNT], x_is[COUNT + 1], v_is[COUNT + 1], dx[COUNT + 1], dv[COUNT + 1];
    pendres_attractors *set = NULL;
    check_ok(pendres_attractors_find(ctx, &p[m], 1, &from, &rest, &set));
    assert_int_equal(pendres_attractors_count(set), m == 1 ? 2 : 1);
    const pendres_orbit *o = &pendres_attractors_get(set, 0)->orbit;
    assert_int_equal(o->period, 1);
    check_ok(pendres_orbit_sample(ctx, o, COUNT, x, v, NULL));
    check_ok(pendres_strobe_record(ctx, &p[m], &(pendres_state){o->x, o->v}, 1, COUNT,
                                   &(pendres_record){x_is, v_is, dx, dv}));
    /* Within a period an error may grow tenfold, and no more: friction wins. */
    for (int k = 0; k < COUNT; k++) {
      check_near(x[k], x_is[k], dx[k] + 10.0 * (o->x_error + o->v_error));
      check_near(v[k], v_is[k], dv[k] + 10.0 * (o->x_error + o->v_error));
    }
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/* An orbit about the top has the mean pi by symmetry, and the same well at every tolerance: the
   one above the origin. */
static void about_the_top(void **state)
{
  const pendres_orbit_guess g = {{0.8, 1.5, 0.39, 0.0}, 3.4747, -0.0885, 1, 0};
  double first = NAN;
  (void)state;
  for (double tolerance = 1e-3; tolerance > 0.5e-12; tolerance *= 0.1) {
    pendres_context *ctx = context_with(tolerance);
    pendres_orbit o;
    pendres_status outcome;
    check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    check_ok(outcome);
    check_near(o.mean_angle, 0.5 * two_pi, 10.0 * tolerance);
    if (isnan(first)) first = o.x;
    check_near(o.x, first, 1e-2);
    pendres_context_free(ctx);
  }
}

static void refusals(void **state)
{
  pendres_context *ctx = context_with(1e-8);
  pendres_orbit o;
  pendres_status outcome;
  pendres_orbit_guess g = {.pendulum = {.damping = -1.0, .drive_frequency = 1.0}, .period = 1};
  (void)state;
  assert_int_equal(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome),
                   PENDRES_INVALID_ARGUMENT);
  g.pendulum.damping = 0.1;
  g.period = 0;
  assert_int_equal(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome),
                   PENDRES_INVALID_ARGUMENT);
  g.period = 1;
  g.x = NAN;
  assert_int_equal(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome),
                   PENDRES_INVALID_ARGUMENT);
  check_ok(pendres_orbit_find(ctx, 0, NULL, PENDRES_ORBIT_PLAIN, NULL, NULL));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(honest_with_every_table),  cmocka_unit_test(honest_on_a_lattice),
    cmocka_unit_test(honest_against_reference), cmocka_unit_test(exact_identities),
    cmocka_unit_test(linear_limit),             cmocka_unit_test(slopes),
    cmocka_unit_test(refusals),                 cmocka_unit_test(no_ghosts),
    cmocka_unit_test(honest_with_few_steps),    cmocka_unit_test(samples_know_their_error),
    cmocka_unit_test(about_the_top),            cmocka_unit_test(samples_of_other_models),
  };
  return cmocka_run_group_tests_name("orbit", tests, NULL, NULL);
}
