/*
 * functions.h -- exponential, logarithm, hyperbolic and inverse tangent that the compiler can
 * vectorise.
 *
 * Owns: what formulas have beside the sine of base/sine.h. As there, every operation is a single
 * IEEE operation and nothing branches, so that all instruction sets and vector widths give the same
 * bytes; libm's functions differ between processors with and without fused multiply-add.
 *
 * Errors: exponential and logarithm below 1 unit of the last place, arc tangent 2, hyperbolic
 * tangent 3 (tests/test_formula.c). Overflow gives infinity, arguments outside of a domain NaN.
 *
 * Sources: reduction of arguments by Cody and Waite (Software Manual for the Elementary Functions,
 * 1980); polynomials of logarithm and arc tangent: FreeBSD's msun, e_log.c and s_atan.c (Sun
 * Microsystems, 1993); that of the exponential is its Taylor series.
 */
#ifndef PENDRES_FORMULA_FUNCTIONS_H
#define PENDRES_FORMULA_FUNCTIONS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define PENDRES_FORMULA_INLINE static inline __attribute__((always_inline))

PENDRES_FORMULA_INLINE uint64_t pendres_formula_bits(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

PENDRES_FORMULA_INLINE double pendres_formula_double(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* 1.5 2^52: added to a small whole number, its lowest bits are that number. */
static const double pendres_formula_shift = 0x1.8p52;

/* 2^n of a whole n within -1022 and 1023. */
PENDRES_FORMULA_INLINE double pendres_formula_power_of_two(double n)
{
  return pendres_formula_double((pendres_formula_bits(n + pendres_formula_shift) + 1023) << 52);
}

/* exp(x) - 1 = 2^n (q + 1) - 1: q and n, where |x| is less than 1500. */
PENDRES_FORMULA_INLINE double pendres_formula_reduced_exp(double x, double *n)
{
  const double k = __builtin_fma(x, 0x1.71547652b82fep0, pendres_formula_shift) -
                   pendres_formula_shift;
  double r = __builtin_fma(-k, 0x1.62e42fefa39efp-1, x);
  r = __builtin_fma(-k, 0x1.abc9e3b39803fp-56, r);
  double p = 1.0 / 6227020800.0;
  p = __builtin_fma(p, r, 1.0 / 479001600.0);
  p = __builtin_fma(p, r, 1.0 / 39916800.0);
  p = __builtin_fma(p, r, 1.0 / 3628800.0);
  p = __builtin_fma(p, r, 1.0 / 362880.0);
  p = __builtin_fma(p, r, 1.0 / 40320.0);
  p = __builtin_fma(p, r, 1.0 / 5040.0);
  p = __builtin_fma(p, r, 1.0 / 720.0);
  p = __builtin_fma(p, r, 1.0 / 120.0);
  p = __builtin_fma(p, r, 1.0 / 24.0);
  p = __builtin_fma(p, r, 1.0 / 6.0);
  p = __builtin_fma(p, r, 0.5);
  *n = k;
  return __builtin_fma(r * r, p, r);
}

PENDRES_FORMULA_INLINE double pendres_formula_exp(double x)
{
  double n;
  x = x > 1400.0 ? 1400.0 : x < -1400.0 ? -1400.0 : x;
  const double q = pendres_formula_reduced_exp(x, &n);
  /* In three factors: 2^n may overflow where the product of all does not, and so may its half. */
  const double third = __builtin_fma(n, 1.0 / 3.0, pendres_formula_shift) - pendres_formula_shift;
  const double part = pendres_formula_power_of_two(third);
  const double rest = pendres_formula_power_of_two(n - 2.0 * third);
  return (1.0 + q) * rest * part * part;
}

PENDRES_FORMULA_INLINE double pendres_formula_tanh(double x)
{
  double n, size = fabs(x);
  size = size > 22.0 ? 22.0 : size; /* where it is 1 in doubles */
  const double q = pendres_formula_reduced_exp(-2.0 * size, &n);
  const double scale = pendres_formula_power_of_two(n);
  const double less = __builtin_fma(scale, q, scale - 1.0); /* exp(-2 |x|) - 1 */
  return copysign(less / (less + 2.0), x);
}

PENDRES_FORMULA_INLINE double pendres_formula_log(double x)
{
  const uint64_t half_root = 0x3fe6a09e667f3bcd; /* sqrt(1/2) */
  const int tiny = x < 0x1p-1022;
  const double y = tiny ? x * 0x1p54 : x;
  const uint64_t bits = pendres_formula_bits(y);
  const uint64_t e = (bits - half_root + ((uint64_t)1024 << 52)) >> 52;
  const double m = pendres_formula_double(bits - ((e - 1024) << 52));
  double k = pendres_formula_double(e | 0x4330000000000000) - (0x1p52 + 1024.0);
  k = tiny ? k - 54.0 : k;
  const double f = m - 1.0, s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
  double r = 1.479819860511658591e-01;
  r = __builtin_fma(r, z, 1.531383769920937332e-01);
  r = __builtin_fma(r, z, 1.818357216161805012e-01);
  r = __builtin_fma(r, z, 2.222219843214978396e-01);
  r = __builtin_fma(r, z, 2.857142874366239149e-01);
  r = __builtin_fma(r, z, 3.999999999940941908e-01);
  r = __builtin_fma(r, z, 6.666666666666735130e-01) * z;
  const double low = __builtin_fma(k, 1.90821492927058770002e-10, s * (half + r));
  const double value = __builtin_fma(k, 6.93147180369123816490e-01, f - (half - low));
  return x > 0.0 ? (x <= 0x1.fffffffffffffp1023 ? value : x) : x == 0.0 ? -INFINITY : NAN;
}

PENDRES_FORMULA_INLINE double pendres_formula_atan(double x)
{
  const double size = fabs(x);
  const int far = size > 2.414213562373095, middle = size > 0.41421356237309503;
  const double above = far ? -1.0 : middle ? size - 1.0 : size;
  const double below = far ? size : middle ? size + 1.0 : 1.0;
  const double t = above / below, z = t * t;
  double p = 1.62858201153657823623e-02;
  p = __builtin_fma(p, z, -3.65315727442169155270e-02);
  p = __builtin_fma(p, z, 4.97687799461593236017e-02);
  p = __builtin_fma(p, z, -5.83357013379057348645e-02);
  p = __builtin_fma(p, z, 6.66107313738753120669e-02);
  p = __builtin_fma(p, z, -7.69187620504482999495e-02);
  p = __builtin_fma(p, z, 9.09088713343650656196e-02);
  p = __builtin_fma(p, z, -1.11111104054623557880e-01);
  p = __builtin_fma(p, z, 1.42857142725034663711e-01);
  p = __builtin_fma(p, z, -1.99999999998764832476e-01);
  p = __builtin_fma(p, z, 3.33333333333329318027e-01) * z;
  const double high = far ? 0x1.921fb54442d18p0 : middle ? 0x1.921fb54442d18p-1 : 0.0;
  const double low = far ? 0x1.1a62633145c07p-54 : middle ? 0x1.1a62633145c07p-55 : 0.0;
  const double value = high + (__builtin_fma(-t, p, low) + t);
  return copysign(x == x ? value : NAN, x);
}

#endif
