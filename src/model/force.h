/* force.h -- what headers of forces need; forces.h tells how to write one. */
#ifndef PENDRES_FORCE_H
#define PENDRES_FORCE_H

#include <pendres/pendulum.h>

/* Part of the kernels' loops, at every width of a vector. */
#define PENDRES_FORCE_INLINE static inline __attribute__((always_inline))

#endif
