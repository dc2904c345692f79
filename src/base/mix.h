/*
 * mix.h -- pseudorandom numbers from counters.
 */
#ifndef PENDRES_MIX_H
#define PENDRES_MIX_H

#include <stdint.h>

/* The output function of SplitMix64: Steele, Lea and Flood, OOPSLA 2014. */
static inline uint64_t pendres_mix(uint64_t z)
{
  z += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

/* Random number `counter` of a seed, in [0, 1). */
static inline double pendres_mix_uniform(uint64_t seed, uint64_t counter)
{
  const uint64_t z = seed * UINT64_C(0xd1342543de82ef95) + counter * UINT64_C(0x9e3779b97f4a7c15);
  return (double)(pendres_mix(z) >> 11) * 0x1p-53;
}

#endif
