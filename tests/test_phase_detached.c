/*
 * test_phase_detached.c -- states that no member of a line reaches, on branches of their own.
 */
#include "check.h"

#include <math.h>

#include <pendres/pendres.h>

#include "analysis/phase_diagram/line.h"

typedef struct hidden {
  double damping, drive, a2, a3, parametric, frequency, amplitude;
} hidden;

/* Random points where 48 members on a line miss the larger of two states. Its amplitude is that of
   the attractor that starts on a grid of 40 x 40 over the plane find. */
static const hidden points[] = {
  {0.14264042481242425, 0.55080233885516461, -0.471003, 0.70715954930215863, 0.0,
   1.6418103303458955, 1.9558},
  {0.075376401598476445, 0.44035885497421173, 0.0, 0.72453326497391979, 0.0, 1.8343579464087316,
   2.1886},
  {0.11512428260471277, 0.6463447280141722, 0.0, 0.21016563661087651, 0.0, 1.5738791836511039,
   3.2057},
  {0.10771962805908555, 0.068763990552808671, 0.0, 0.67887843202406906, 0.49715499428049581,
   2.6201192006078156, 3.6185},
  {0.07946196325350309, 0.045729683450402771, 0.0, 0.47283703936086618, 0.43161686790065823,
   2.4456992267237943, 3.9149}};

static void found(void **state)
{
  enum { N = 3 };
  (void)state;
  for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
    const hidden *h = &points[k];
    const pendres_phase_options options = {
      .size = sizeof options,
      .parameter = PENDRES_DRIVE_FREQUENCY,
      .ensemble = {.members = 48, .x_first = -1.0, .x_last = 1.0}};
    pendres_context *ctx = NULL;
    pendres_pendulum p[N];
    pendres_phase_point point[N];
    for (int i = 0; i < N; i++)
      p[i] = (pendres_pendulum){.force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {1.0, h->a2, h->a3},
                                .damping = h->damping,
                                .drive_amplitude = h->drive,
                                .parametric_amplitude = h->parametric,
                                .drive_frequency = h->frequency * (1.0 + 0.04 * (i - 1))};
    check_ok(pendres_context_create(NULL, &ctx));
    check_ok(pendres_phase_line(ctx, N, p, &options, point, NULL));
    assert_int_equal(point[1].exact, PENDRES_REGIME_COEXISTENCE);
    assert_int_not_equal(point[1].regime, PENDRES_REGIME_COEXISTENCE); /* no member is there */
    check_near(point[1].la_amplitude, h->amplitude, 1e-4); /* of the last digit */
    pendres_context_free(ctx);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(found)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
