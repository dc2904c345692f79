/* dispatch.c -- which variant of the kernels this processor runs; see kernels.h. */
#include "engine/kernels.h"

#include "base/instructions.h"

const pendres_kernels *pendres_kernels_select(void)
{
  return PENDRES_INSTRUCTIONS_BEST(pendres_kernels);
}
