/* dispatch.c -- which variant of the kernels this processor runs; see kernels.h. */
#include "engine/kernels.h"

const pendres_kernels *pendres_kernels_select(void)
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return &pendres_kernels_avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return &pendres_kernels_avx2;
#endif
  return &pendres_kernels_base;
}
