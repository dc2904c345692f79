/*
 * stack.h -- results of scenes that are computed one after another for an outer axis' values.
 *
 * Owns: what is kept of each scene meanwhile, and how the results of all become variables with one
 * more dimension. A dimension that is the same for all values stays what it is; one that differs,
 * as the number of attractors, is as long as the longest, NAME_length tells how long it is at each
 * value, NAME_values what its values are, and what lies beyond is NaN, -1 or an empty text.
 */
#ifndef RESULTS_STACK_H
#define RESULTS_STACK_H

#include "results/results.h"

/* For the results of `slices` scenes; NULL: why is on record. */
typedef struct results_stack results_stack;
results_stack *results_stack_create(scene_run *run, size_t slices);
void results_stack_free(results_stack *s);

/* What is written while it is the run's is of this slice; what that has written is forgotten. */
void results_stack_begin(results_stack *s, size_t slice);
void results_stack_forget(results_stack *s, size_t slice);

/* Write it all into the run's store; axis(run, group) makes the outer dimension, of that name, in
   each of the groups. */
void results_stack_write(scene_run *run, results_stack *s, const char *name,
                         void (*axis)(scene_run *run, const char *group));

#endif
