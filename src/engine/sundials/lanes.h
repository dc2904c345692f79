/*
 * lanes.h -- the N_Vector that holds a block of pendulums side by side.
 *
 * Owns: memory and vector operations of a block. All clones of a vector share one shape
 * (lanes_shape.h); what ARKODE requests is deferred (lanes_tape.h).
 *
 * The norm is the largest over the lanes of each lane's own root mean square,
 * so that every lane meets the tolerance of an adaptive step on its own.
 */
#ifndef PENDRES_LANES_H
#define PENDRES_LANES_H

#include <stddef.h>

#include <sundials/sundials_nvector.h>

#include "engine/sundials/lanes_shape.h"

/* Memory for n doubles on a 64-byte boundary, all zero; NULL if there is none. Free with free(). */
double *pendres_lanes_allocate(size_t n);

/* Make a shape of `rows` rows and `lanes` lanes, all of them in use; nonzero without memory. */
int pendres_lanes_open(pendres_lanes_shape *shape, size_t rows, size_t lanes,
                       const pendres_kernels *kernels);
/* To be called when the shape's last vector has been freed. */
void pendres_lanes_close(pendres_lanes_shape *shape);

/* Use `lanes` lanes from now on, at most the capacity. Vectors lose their values. */
void pendres_lanes_resize(pendres_lanes_shape *shape, size_t lanes);

/*
 * A vector of the shape, all zero; NULL if out of memory. N_VDestroy frees it. SUNDIALS (6.4)
 * dereferences a null pointer where a vector cannot be cloned. So it always gets a clone: when
 * memory is exhausted it is given a spare vector of the shape, and the shape is marked as starved,
 * which the caller must check when SUNDIALS returns.
 */
N_Vector pendres_lanes_create(pendres_lanes_shape *shape, SUNContext sun);

/* All rows in and out, row after row, each `stride` doubles long. */
void pendres_lanes_write(N_Vector v, const double *rows);
void pendres_lanes_read(N_Vector v, double *rows);

#endif
