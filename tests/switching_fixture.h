/* switching_fixture.h -- what tests of switching share: the attractors without noise, and numbers
 * for simulations of their own.
 */
#ifndef PENDRES_TESTS_SWITCHING_FIXTURE_H
#define PENDRES_TESTS_SWITCHING_FIXTURE_H

#include "langevin_fixture.h"

#include <pendres/switching.h>

/* Of a pendulum, whatever its temperature; the caller frees. */
static pendres_attractors *attractors(pendres_pendulum p)
{
  pendres_context *ctx = NULL;
  pendres_attractors *set = NULL;
  p.temperature = 0.0;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  pendres_context_free(ctx);
  return set;
}

/* A number with the normal distribution, by a generator and a way of the test's own (xorshift,
   Marsaglia's polar method). */
static inline double normal(uint64_t *s)
{
  double u, w, q;
  do {
    double z[2];
    for (int i = 0; i < 2; i++) {
      *s ^= *s << 13, *s ^= *s >> 7, *s ^= *s << 17;
      z[i] = 2.0 * (double)(*s >> 11) * 0x1p-53 - 1.0;
    }
    u = z[0], w = z[1];
    q = u * u + w * w;
  } while (q >= 1.0 || q == 0.0);
  return u * sqrt(-2.0 * log(q) / q);
}

#endif
