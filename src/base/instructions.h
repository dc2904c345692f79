/*
 * instructions.h -- which instructions this processor has.
 *
 * Owns: the choice between the variants of kernels, which are compiled once for each set.
 */
#ifndef PENDRES_INSTRUCTIONS_H
#define PENDRES_INSTRUCTIONS_H

/* The sets, by the names that the Makefile gives them (PENDRES_KERNELS). */
typedef enum pendres_instructions {
  PENDRES_INSTRUCTIONS_BASE,
  PENDRES_INSTRUCTIONS_AVX2,
  PENDRES_INSTRUCTIONS_AVX512
} pendres_instructions;

/* The best set that this processor has. */
static inline pendres_instructions pendres_instructions_here(void)
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return PENDRES_INSTRUCTIONS_AVX512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return PENDRES_INSTRUCTIONS_AVX2;
#endif
  return PENDRES_INSTRUCTIONS_BASE;
}

/* In a file that is compiled once for each set: NAME_avx2, say, and the set's name in quotes. */
#ifndef PENDRES_KERNELS
#define PENDRES_KERNELS base
#endif
#define PENDRES_INSTRUCTIONS_JOIN_(name, set) name##_##set
#define PENDRES_INSTRUCTIONS_JOIN(name, set) PENDRES_INSTRUCTIONS_JOIN_(name, set)
#define PENDRES_INSTRUCTIONS_OWN(name) PENDRES_INSTRUCTIONS_JOIN(name, PENDRES_KERNELS)
#define PENDRES_INSTRUCTIONS_QUOTE_(set) #set
#define PENDRES_INSTRUCTIONS_QUOTE(set) PENDRES_INSTRUCTIONS_QUOTE_(set)
#define PENDRES_INSTRUCTIONS_NAME PENDRES_INSTRUCTIONS_QUOTE(PENDRES_KERNELS)

/* A pointer to the best of NAME_base, NAME_avx2 and NAME_avx512. */
#if defined(__x86_64__)
#define PENDRES_INSTRUCTIONS_BEST(name)                                        \
  (pendres_instructions_here() == PENDRES_INSTRUCTIONS_AVX512 ? &name##_avx512 \
   : pendres_instructions_here() == PENDRES_INSTRUCTIONS_AVX2 ? &name##_avx2   \
                                                              : &name##_base)
#else
#define PENDRES_INSTRUCTIONS_BEST(name) (&name##_base)
#endif

#endif
