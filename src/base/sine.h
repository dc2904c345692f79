/*
 * sine.h -- sine and cosine that the compiler can vectorise.
 *
 * Owns: the one sine of all inner loops. Every operation is a single IEEE operation (each
 * fused multiply-add is written out) and nothing branches, so any instruction set and any
 * vector width gives the same bytes.
 *
 * Method: y = k pi + r with |r| <= pi/2, k rounded by adding 1.5 2^52 (its parity is then
 * the lowest bit); pi in two parts, the first subtracted exactly by a fused multiply-add
 * (Cody and Waite, Software Manual for the Elementary Functions, 1980); then minimax
 * polynomials in r^2. Their own errors: sine 2.8e-19 relative, cosine 5.8e-18 absolute.
 *
 * For |y| < 1e4 the sine is within 2 ulp or 2e-29 absolute, whichever is larger (the latter
 * counts only for |y - k pi| < 1e-13), and the cosine within 3e-16 absolute: close to its
 * zeros it is not accurate to relative precision. Beyond, the error of the sine grows as
 * |y| 1e-33 until |y| = 1e9; above 1e15 results are meaningless. NaN and infinity give NaN.
 */
#ifndef PENDRES_SINE_H
#define PENDRES_SINE_H

#include <stdint.h>
#include <string.h>

/* Constants in their order of use, for the loops that write the sine out by hand as well. */
enum {
  PENDRES_SINE_INVERSE_PI,
  PENDRES_SINE_SHIFT,
  PENDRES_SINE_PI_HIGH,
  PENDRES_SINE_PI_LOW,
  PENDRES_SINE_FIRST, /* the polynomial from its highest power on */
  PENDRES_SINE_COUNT = PENDRES_SINE_FIRST + 8
};
static const double pendres_kernels_sine[PENDRES_SINE_COUNT] = {
  0x1.45f306dc9c883p-2,   0x1.8p52,
  0x1.921fb54442d18p+1,   0x1.1a62633145c07p-53,
  0x1.8829a3d973be6p-49,  -0x1.ae431da11c3a1p-41,
  0x1.6123cb29245d9p-33,  -0x1.ae6454cb57cccp-26,
  0x1.71de3a5287c86p-19,  -0x1.a01a01a0148bdp-13,
  0x1.11111111110c1p-7,   -0x1.5555555555555p-3};

/* r with sine(y) = sine(r), |r| <= pi/2; *flip has its top bit set where cosine changes sign. */
static inline double pendres_kernels_reduce(double y, uint64_t *flip)
{
  const double *const c = pendres_kernels_sine;
  const double t = __builtin_fma(y, c[PENDRES_SINE_INVERSE_PI], c[PENDRES_SINE_SHIFT]);
  const double k = t - c[PENDRES_SINE_SHIFT];
  double r = __builtin_fma(-k, c[PENDRES_SINE_PI_HIGH], y); /* exact */
  uint64_t bits;

  memcpy(&bits, &t, sizeof bits);
  *flip = bits << 63;
  r = __builtin_fma(-k, c[PENDRES_SINE_PI_LOW], r);
  memcpy(&bits, &r, sizeof bits);
  bits ^= *flip;
  memcpy(&r, &bits, sizeof r);
  return r;
}

/* sin r for |r| <= pi/2, s = r^2. */
static inline double pendres_kernels_sin_reduced(double r, double s)
{
  double p = pendres_kernels_sine[PENDRES_SINE_FIRST];
#pragma GCC unroll 8
  for (int i = PENDRES_SINE_FIRST + 1; i < PENDRES_SINE_COUNT; i++)
    p = __builtin_fma(p, s, pendres_kernels_sine[i]);
  return __builtin_fma(r * s, p, r);
}

/* cos r for |r| <= pi/2, s = r^2. */
static inline double pendres_kernels_cos_reduced(double s)
{
  double p = 0x1.9fc8d3e63cfa7p-45;
  p = __builtin_fma(p, s, -0x1.93573fa344958p-37);
  p = __builtin_fma(p, s, 0x1.1eecfaec94940p-29);
  p = __builtin_fma(p, s, -0x1.27e4f9f33e4b9p-22);
  p = __builtin_fma(p, s, 0x1.a01a019ba740dp-16);
  p = __builtin_fma(p, s, -0x1.6c16c16c10218p-10);
  p = __builtin_fma(p, s, 0x1.55555555554ddp-5);
  return __builtin_fma(s * s, p, __builtin_fma(-0.5, s, 1.0));
}

/* cos y within 1e-4, at half the cost: where a growth within a few per cent is all that counts. */
static inline double pendres_kernels_cos_roughly(double y)
{
  const double shift = pendres_kernels_sine[PENDRES_SINE_SHIFT];
  const double turns = __builtin_fma(y, 0.15915494309189535, shift) - shift;
  const double r = __builtin_fma(-turns, 6.283185307179586, y), s = r * r;
  double p = 1.87708309275e-05;
  p = __builtin_fma(p, s, -0.00133885087532);
  p = __builtin_fma(p, s, 0.0414934583954);
  p = __builtin_fma(p, s, -0.499788065521);
  return __builtin_fma(p, s, 0.99995823162);
}

static inline double pendres_kernels_sin(double y)
{
  uint64_t flip;
  const double r = pendres_kernels_reduce(y, &flip);
  return pendres_kernels_sin_reduced(r, r * r);
}

static inline void pendres_kernels_sincos(double y, double *sine, double *cosine)
{
  uint64_t flip, bits;
  const double r = pendres_kernels_reduce(y, &flip);
  const double s = r * r;
  double c = pendres_kernels_cos_reduced(s);

  memcpy(&bits, &c, sizeof bits);
  bits ^= flip;
  memcpy(cosine, &bits, sizeof *cosine);
  *sine = pendres_kernels_sin_reduced(r, s);
}

#endif
