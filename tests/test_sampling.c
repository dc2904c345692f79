/*
 * test_sampling.c -- ensembles that stand for an area: where their starts lie, and whether errors
 * of shares and means contain that they are a sample. Exact shares are those of disks, whose area
 * is known; those of basins come from a grid of sixteen times as many starts.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

#include "analysis/resonance/response_parts.h"

static pendres_ensemble area_of(pendres_ensemble_shape shape, size_t members, size_t rows)
{
  return (pendres_ensemble){ .members = members, .x_first = -1.0, .x_last = 3.0, .v = -0.5,
                             .v_last = 0.5, .shape = shape, .rows = rows, .seed = 7 };
}

/* A rectangle by its definition; random starts by their first two moments and by their seed. */
static void starts_fill_the_area(void **state)
{
  pendres_ensemble e = area_of(PENDRES_ENSEMBLE_RECTANGLE, 8, 2);
  double x = 0.0, v = 0.0, sum[4] = { 0.0 }, other = 0.0;
  (void)state;
  for (size_t k = 1; k <= 8; k++) {
    pendres_ensemble_start(&e, k, &x, &v);
    assert_true(x == -0.5 + (double)((k - 1) % 4) && v == (k <= 4 ? -0.25 : 0.25));
  }
  pendres_ensemble_start(&e, 9, &x, &v);
  assert_true(isnan(x) && isnan(v));
  e = area_of(PENDRES_ENSEMBLE_RANDOM, 40000, 0);
  for (size_t k = 1; k <= e.members; k++) {
    pendres_ensemble_start(&e, k, &x, &v);
    assert_true(x >= -1.0 && x <= 3.0 && v >= -0.5 && v <= 0.5);
    sum[0] += x / 40000.0;
    sum[1] += v / 40000.0;
    sum[2] += (x - 1.0) * (x - 1.0) / 40000.0;
    sum[3] += (x - 1.0) * v / 40000.0;
  }
  /* Five standard errors of each mean: sides / sqrt(12), and what follows from them. */
  check_near(sum[0], 1.0, 5.0 * 4.0 / sqrt(12.0 * 40000.0));
  check_near(sum[1], 0.0, 5.0 * 1.0 / sqrt(12.0 * 40000.0));
  check_near(sum[2], 16.0 / 12.0, 5.0 * 16.0 / sqrt(180.0 * 40000.0));
  check_near(sum[3], 0.0, 5.0 * 4.0 / 12.0 / sqrt(40000.0));
  pendres_ensemble_start(&e, 40000, &x, NULL);
  e.seed = 8;
  pendres_ensemble_start(&e, 40000, &other, NULL);
  assert_true(x != other);
}

/* The response of an ensemble whose members within a disk are on the second of two states. */
static pendres_response disk(const pendres_ensemble *e, double radius, signed char *where)
{
  pendres_response r = { .states = 2, .pendulum = { .drive_frequency = 2.0 * pi } };
  r.state[1].orbit = (pendres_orbit){ .loop_area = 3.0, .mean_power = 3.0, .amplitude = 2.0,
                                      .cosine = { 1.0 } };
  r.state[0].orbit = (pendres_orbit){ .loop_area = 1.0, .mean_power = 1.0, .amplitude = 1.0,
                                      .cosine = { 1.0 } };
  r.state[0].label = PENDRES_LABEL_SA;
  r.state[1].label = PENDRES_LABEL_LA;
  for (size_t k = 1; k <= e->members; k++) {
    double x = 0.0, v = 0.0;
    pendres_ensemble_start(e, k, &x, &v);
    where[k - 1] = hypot((x - 1.1) / 4.0, v - 0.04) < radius;
    r.state_members[where[k - 1]]++;
  }
  pendres_response_average(&r);
  pendres_response_sample(e, where, &r);
  return r;
}

/*
 * Two standard errors: a twentieth of the cases may lie outside, of 200 random ones 10 with a
 * scatter of 3, and 2.5 mean errors are claimed. Rows of a rectangle are taken for independent,
 * though their errors cancel in part where a boundary is smooth: measured, eight mean errors.
 */
static void errors_contain_the_sampling(void **state)
{
  static signed char where[4096];
  (void)state;
  for (int shape = PENDRES_ENSEMBLE_RECTANGLE; shape <= PENDRES_ENSEMBLE_RANDOM; shape++) {
    int outside = 0;
    double off = 0.0, claimed = 0.0;
    for (int i = 0; i < 200; i++) {
      pendres_ensemble e = area_of((pendres_ensemble_shape)shape, 1024, 32);
      const double radius = 0.1 + 0.0017 * i, share = pi * radius * radius;
      e.seed = (uint64_t)i;
      const pendres_response r = disk(&e, radius, where);
      outside += fabs(r.la_fraction - share) > r.la_fraction_error;
      assert_int_equal(fabs(r.la_fraction - share) > r.la_fraction_error,
                       fabs(r.mean_loop_area - 1.0 - 2.0 * share) > r.mean_loop_area_error);
      assert_true(r.sa_fraction_error == r.la_fraction_error && r.mean_power_error > 0.0);
      off += fabs(r.la_fraction - share);
      claimed += r.la_fraction_error;
    }
    print_message("%s: %d of 200 outside, error %.2g of %.2g claimed\n",
                  shape == PENDRES_ENSEMBLE_RANDOM ? "random" : "rectangle", outside, off / 200.0,
                  claimed / 200.0);
    assert_true(outside <= 20);
    assert_true(claimed < (shape == PENDRES_ENSEMBLE_RANDOM ? 3.0 : 12.0) * off);
  }
}

/* What no start has met may be there all the same: about one in so many. */
static void a_share_of_zero_has_an_error(void **state)
{
  static signed char where[4096];
  const pendres_ensemble random = area_of(PENDRES_ENSEMBLE_RANDOM, 100, 0);
  const pendres_ensemble rectangle = area_of(PENDRES_ENSEMBLE_RECTANGLE, 100, 10);
  (void)state;
  pendres_response r = disk(&random, 0.0, where);
  assert_true(r.la_fraction == 0.0 && r.la_fraction_error > 0.01 && r.la_fraction_error < 0.04);
  r = disk(&rectangle, 0.0, where);
  assert_true(r.la_fraction == 0.0 && r.la_fraction_error > 0.001 && r.la_fraction_error < 0.01);
}

/* Fig. 7's pendulum: shares of its basins from 16384 starts, 1024, and 1024 at random. */
static void shares_of_basins(void **state)
{
  const pendres_pendulum p = { .damping = 0.12, .drive_amplitude = 0.2,
                               .drive_frequency = 2.0 * pi / 8.0 };
  pendres_context *ctx = NULL;
  pendres_response fine, some, random;
  pendres_ensemble e = { .members = 16384, .x_first = -pi / 2.0, .x_last = 1.5 * pi, .v = -2.0,
                         .v_last = 2.0, .shape = PENDRES_ENSEMBLE_RECTANGLE, .rows = 128 };
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){ .tolerance = 1e-6 }, &ctx));
  check_ok(pendres_response_find(ctx, 1, &p, &e, &fine));
  e.members = 1024;
  e.rows = 32;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &some));
  e.shape = PENDRES_ENSEMBLE_RANDOM;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &random));
  print_message("share of LA %.4f +- %.4f, %.4f +- %.4f, at random %.4f +- %.4f\n",
                fine.la_fraction, fine.la_fraction_error, some.la_fraction,
                some.la_fraction_error, random.la_fraction, random.la_fraction_error);
  assert_true(fine.la_fraction_error < some.la_fraction_error &&
              some.la_fraction_error < random.la_fraction_error);
  check_near(some.la_fraction, fine.la_fraction, some.la_fraction_error + fine.la_fraction_error);
  check_near(random.la_fraction, fine.la_fraction,
             random.la_fraction_error + fine.la_fraction_error);
  check_near(random.mean_loop_area, fine.mean_loop_area,
             random.mean_loop_area_error + fine.mean_loop_area_error);
  pendres_context_free(ctx);
}

/* A resonance of random starts, its shares and area with the sampling, its frequency without. */
static void a_resonance_of_random_starts(void **state)
{
  const pendres_pendulum p = { .damping = 0.3, .drive_amplitude = 0.2 };
  pendres_context *ctx = NULL;
  pendres_resonance line, random;
  const pendres_ensemble e = { .members = 64, .x_first = -pi / 2.0, .x_last = 1.5 * pi,
                               .v = -0.5, .v_last = 0.5, .shape = PENDRES_ENSEMBLE_RANDOM };
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_resonance_find(ctx, &p, 0.6, 1.2, &line));
  check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.6, 1.2, &e, &random));
  /* One state: whatever the starts, the same resonance. */
  check_near(random.frequency, line.frequency, random.frequency_error + line.frequency_error);
  check_near(random.loop_area, line.loop_area, random.loop_area_error + line.loop_area_error);
  assert_true(random.response.sampling > 0.0 && line.response.sampling == 0.0);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(starts_fill_the_area),
    cmocka_unit_test(errors_contain_the_sampling),
    cmocka_unit_test(a_share_of_zero_has_an_error),
    cmocka_unit_test(shares_of_basins),
    cmocka_unit_test(a_resonance_of_random_starts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
