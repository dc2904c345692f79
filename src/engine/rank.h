/*
 * rank.h -- lanes in the order of their steps, as they share blocks.
 */
#ifndef PENDRES_RANK_H
#define PENDRES_RANK_H

#include <stddef.h>

/* A lane's place in a list, and its steps. */
typedef struct pendres_rank {
  int steps;
  size_t index;
} pendres_rank;

/* Lanes in the order of their steps, those of equal steps in their own order. */
void pendres_rank_order(size_t n, pendres_rank *rank);

#endif
