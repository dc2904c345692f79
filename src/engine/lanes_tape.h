/*
 * lanes_tape.h -- operations on vectors of a block that were put off.
 *
 * Owns: the list of what is yet to be done, and doing it. ARKODE asks for linear
 * combinations, copies and slopes; with fixed steps it never looks at a number,
 * and with adaptive steps once a step, at the norm. Until somebody looks, the
 * operations are only written down; then each strip of lanes runs through all of
 * them while its vectors stay in the nearest cache. Lanes never mix and each
 * strip does the operations in their order, so the bytes are the same as if
 * each had been done at once.
 *
 * A sum that is followed by the slope at it becomes one operation. What is overwritten
 * before anybody read it is not done at all: of the vectors that ARKODE keeps up for its
 * interpolation, nobody needs more than the last. Every period asks for the same sums again: a
 * sum is checked against those already known, and its terms are sorted out once.
 */
#ifndef PENDRES_LANES_TAPE_H
#define PENDRES_LANES_TAPE_H

#include <stddef.h>
#include <stdint.h>

#include <sundials/sundials_nvector.h>

#include "engine/lanes_replay.h"
#include "engine/lanes_shape.h"

typedef struct pendres_lanes_tape pendres_lanes_tape;

/* What an N_Vector of a block holds. */
typedef struct pendres_lanes_content {
  pendres_lanes_shape *shape;
  double *data; /* strip after strip; within one, row after row */
  void *memory; /* that data points into */
  uint64_t bit; /* its own in a set of vectors; 0 if there were none left */
} pendres_lanes_content;

static inline const pendres_lanes_content *pendres_lanes_of(N_Vector v)
{
  return (const pendres_lanes_content *)v->content;
}

/* NULL if out of memory. */
pendres_lanes_tape *pendres_lanes_tape_create(void);
void pendres_lanes_tape_free(pendres_lanes_tape *tape);

/* z = sum of c[i] x[i]; terms with c = 0 are left out. n up to PENDRES_KERNELS_TERMS. */
void pendres_lanes_tape_sum(pendres_lanes_shape *s, int n, const double *c,
                            const N_Vector *x, N_Vector z);
void pendres_lanes_tape_copy(pendres_lanes_shape *s, N_Vector from, N_Vector to);
void pendres_lanes_tape_slope(pendres_lanes_shape *s, N_Vector y, N_Vector slope,
                              double cos_theta);

/* The errors or tangents of the lanes over a step that has ended at y; second: over two steps, too.
   */
void pendres_lanes_tape_carry(pendres_lanes_shape *s, N_Vector y, double step, double cos_theta,
                              int second);

/* Do all that was put off: before anybody looks at a number or changes one. */
void pendres_lanes_tape_run(pendres_lanes_shape *s);

/* Add all that is done from now on to this record, which is not owned; NULL: to none. */
void pendres_lanes_tape_record(pendres_lanes_shape *s, pendres_lanes_replays *record);

/* Forget all sums that are known; to be called before a vector is freed. */
void pendres_lanes_tape_forget(pendres_lanes_shape *s);

#endif
