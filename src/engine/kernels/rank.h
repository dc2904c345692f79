/*
 * rank.h -- lanes in the order in which they share blocks: of equal models and steps.
 */
#ifndef PENDRES_RANK_H
#define PENDRES_RANK_H

#include <stddef.h>

#include "engine/kernels/kernels.h"

/* Lanes that lie one after another in a list, their steps and the kernels that they need. */
typedef struct pendres_rank {
  int steps;
  pendres_model_terms model;
  pendres_flow_way way;
  int carries; /* errors */
  size_t index, count; /* the first, and how many there are */
} pendres_rank;

/* Sort by model, steps and way; those that may share a block keep their order. */
void pendres_rank_order(size_t n, pendres_rank *rank);

static inline int pendres_rank_equal(const pendres_rank *a, const pendres_rank *b)
{
  return a->steps == b->steps && a->model == b->model && a->way == b->way &&
         a->carries == b->carries;
}

#endif
