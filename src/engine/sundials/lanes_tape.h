/*
 * lanes_tape.h -- operations on vectors of a block that are deferred, on a tape.
 *
 * Owns: the list of deferred operations, and carrying them out. ARKODE requests linear
 * combinations, copies and slopes. With fixed steps it never reads a number, with adaptive steps
 * only the norm, once a step. Until a number is read, operations are only written on the tape. Then
 * each strip of lanes goes through all of them while its vectors stay in the nearest cache. Lanes
 * do not interact, and each strip does the operations in their order, so that the bytes are the
 * same as if each operation had been carried out at once.
 *
 * A sum that is followed by the slope at it becomes one operation. An operation whose result is
 * overwritten before it is read is left out: ARKODE updates several vectors for its interpolation,
 * of which only the last values are needed. Every period requests the same sums again; a sum is
 * compared with the known ones, and its terms are sorted out once.
 */
#ifndef PENDRES_LANES_TAPE_H
#define PENDRES_LANES_TAPE_H

#include <stddef.h>
#include <stdint.h>

#include <sundials/sundials_nvector.h>

#include "engine/sundials/lanes_replay.h"
#include "engine/sundials/lanes_shape.h"

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
void pendres_lanes_tape_sum(int n, const double *c, const N_Vector *x, N_Vector z);
void pendres_lanes_tape_copy(N_Vector from, N_Vector to);
/* slope = the right-hand side at y, of the equation that belongs to the number of rows. */
void pendres_lanes_tape_slope(N_Vector y, N_Vector slope, double cos_theta);

/* The errors or tangents of the lanes over a step that has ended at y; second: over two steps, too.
   */
void pendres_lanes_tape_carry(N_Vector y, double step, double cos_theta, int second);

/* Carry out all deferred operations. To be called before a number is read or changed. */
void pendres_lanes_tape_run(pendres_lanes_shape *s);

/* Add all that is done from now on to this record, which is not owned; NULL: to none. */
void pendres_lanes_tape_record(pendres_lanes_shape *s, pendres_lanes_replays *record);

/* Forget all sums that are known; to be called before a vector is freed. */
void pendres_lanes_tape_forget(pendres_lanes_shape *s);

#endif
