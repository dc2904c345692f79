/* rank.c -- lanes in the order of their steps; see rank.h. */
#include "engine/kernels/rank.h"

#include <stdlib.h>

static int by_steps(const void *a, const void *b)
{
  const pendres_rank *p = a, *q = b;
  if (p->model != q->model) return p->model < q->model ? -1 : 1;
  if (p->steps != q->steps) return p->steps < q->steps ? -1 : 1;
  if (p->way != q->way) return p->way < q->way ? -1 : 1;
  if (p->carries != q->carries) return p->carries < q->carries ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

void pendres_rank_order(size_t n, pendres_rank *rank)
{
  size_t i = 1;
  while (i < n && by_steps(&rank[i - 1], &rank[i]) < 0) i++;
  if (i < n) qsort(rank, n, sizeof *rank, by_steps);
}
