/* strobe_fixture.h -- what the tests of strobe maps share. */
#ifndef STROBE_FIXTURE_H
#define STROBE_FIXTURE_H

#include "check.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "golden.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double pi = 3.14159265358979323846;
static const long double half_pi = 1.570796326794896619231321691639751442L;
static const long double two_pi = 6.283185307179586476925286766559005768L;

static inline pendres_context *context(const pendres_options *options)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(options, &ctx));
  return ctx;
}

/* Numbers in (0, 1), the same ones every time (Marsaglia, xorshift). */
static inline double any(uint64_t *seed)
{
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return ((double)(*seed >> 11) + 0.5) * 0x1p-53;
}

/* Pendulums of all kinds: undamped to overdamped, slow and fast drives, fast starts. */
static inline pendres_pendulum any_pendulum(uint64_t *seed, double *x, double *v)
{
  pendres_pendulum p = { .damping = any(seed) < 0.1 ? 0.0 : exp(log(1e-3) + any(seed) * 8.0) };
  p.drive_amplitude = 2.0 * any(seed) * any(seed);
  p.drive_frequency = exp(log(0.2) + any(seed) * 3.0);
  *x = pi * (2.0 * any(seed) - 1.0);
  *v = 6.0 * any(seed) - 3.0;
  return p;
}

#endif
