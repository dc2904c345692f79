/*
 * test_resonance_kink.c -- resonances where a state loses its mirror symmetry: the mean area goes
 * on there, and its slope jumps.
 *
 * Reference: reference_, Taylor series in extended precision with no shared code.
 */
#include "check.h"

#include <pendres/pendres.h>

#include "context_fixture.h"
#include "oracle/reference.h"

enum { MEMBERS = 40 };

static pendres_ensemble few(void)
{
  pendres_ensemble e = pendres_ensemble_default();
  e.members = MEMBERS;
  return e;
}

/* The area rises with the frequency along a pair of mirror images, which end in a symmetric orbit
   along which it falls. The members on either image do not count. */
static void loss_of_symmetry(void **state)
{
  static const double dampings[] = {0.131, 0.15};
  const pendres_ensemble e = few();
  pendres_context *ctx = *state;
  for (int k = 0; k < 2; k++) {
    const pendres_pendulum p = {.damping = dampings[k], .drive_amplitude = 0.5};
    pendres_resonance r;
    reference_cycle exact;
    check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.65, 0.72, &e, &r));
    assert_int_equal(r.peak, PENDRES_PEAK_EDGE);
    assert_true(r.complete);
    assert_true(isnan(r.fold_frequency) && isnan(r.fold_frequency_error));
    const pendres_orbit *o = &r.response.state[0].orbit;
    check_ok(reference_find(REFERENCE_SYMMETRY_BREAKING, &p,
                                    &(reference_guess){r.frequency, o->x - 0.5 * PENDRES_PI,
                                                               o->v / r.frequency, 0.0L},
                                    &exact));
    check_near(r.frequency, (double)exact.drive_frequency, r.frequency_error);
    check_near(r.loop_area, (double)exact.loop_area, r.loop_area_error);
    assert_true(r.frequency_error < 1e-8 && r.loop_area_error < 1e-7);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(loss_of_symmetry, setup, teardown)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
