/* boundary_distance.c -- how far the nodes of a boundary are from it; see boundary_distance.h. */
#include "analysis/basins/boundary_distance.h"

#include <math.h>
#include <stdlib.h>

#include "base/turns.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "model/model.h"

/* The order of nodes by their number of maps, and then along the curve. */
static int by_generation(const void *a, const void *b)
{
  const pendres_boundary_node *const *p = a, *const *q = b;
  if ((*p)->generation != (*q)->generation)
    return (*p)->generation < (*q)->generation ? -1 : 1;
  return *p < *q ? -1 : *p > *q;
}

/* What is asked of all nodes. */
typedef struct measuring {
  const pendres_boundary_seed *seed;
  pendres_pendulum forward;
  const pendres_boundary_node *nodes;
  size_t n;
  double *distance;
} measuring;

/*
 * The unit vector of y and v across the curve at a node, as one of y and w: perpendicular to the
 * chord between its neighbours. Where it has none any other vector will do: distances along a
 * vector that is not quite perpendicular are too large, never too small.
 */
static void across(const measuring *m, size_t i, double out[2])
{
  const pendres_boundary_node *own = &m->nodes[i], *before = own, *after = own;
  const double omega = m->forward.drive_frequency;
  if (i > 0 && own[-1].piece == own->piece) before = own - 1;
  if (i + 1 < m->n && own[1].piece == own->piece) after = own + 1;
  const double dy = after->y - before->y, dv = (after->w - before->w) * omega;
  const double length = hypot(dy, dv);
  out[0] = length > 0.0 ? -dv / length : 1.0;
  out[1] = length > 0.0 ? dy / length / omega : 0.0;
}

/* The distance along a vector across the curve, by the forward image of a node and of that. */
static double distance_of(const pendres_boundary_seed *seed, double y, double w,
                          const double vector[2])
{
  const double dy = pendres_less_turns(y - seed->y, pendres_model_turn(&seed->backward));
  const double dw = w + seed->w; /* forward w has its own sign */
  const double a = dy * seed->e[0] - dw * seed->e[1], c = dy * seed->f[0] - dw * seed->f[1];
  const double off = c - seed->bend * a * a;
  const double by_y = seed->f[0] - 2.0 * seed->bend * a * seed->e[0];
  const double by_w = -(seed->f[1] - 2.0 * seed->bend * a * seed->e[1]);
  return fabs(off) / fabs(by_y * vector[0] + by_w * vector[1]);
}

/* Of nodes of one generation, as many as a block holds at most. */
static pendres_status measure(pendres_block *b, const measuring *m, size_t count,
                              const pendres_boundary_node *const *order)
{
  pendres_status status = PENDRES_OK;
  pendres_block_resize(b, count);
  for (size_t i = 0; i < count; i++) {
    double vector[2];
    across(m, (size_t)(order[i] - m->nodes), vector);
    pendres_block_load(b, i, &m->forward, order[i]->y, order[i]->w);
    for (int k = 0; k < 2; k++) pendres_block_put_tangent(b, i, k, vector);
  }
  const long periods = (long)order[0]->generation * m->seed->iterates;
  for (long k = 0; k < periods && status == PENDRES_OK; k++) status = pendres_block_period(b);
  if (status != PENDRES_OK) return status;
  const pendres_rows rows = pendres_block_rows(b);
  for (size_t i = 0; i < count; i++) {
    double vector[2];
    pendres_block_get_tangent(b, i, 0, vector);
    m->distance[order[i] - m->nodes] =
      distance_of(m->seed, pendres_rows_get(&rows, PENDRES_ROW_Y, i),
                  pendres_rows_get(&rows, PENDRES_ROW_W, i), vector);
  }
  return status;
}

static pendres_status measure_all(pendres_context *ctx, const measuring *m,
                                  const pendres_boundary_node *const *order)
{
  pendres_block b;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, m->seed->steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t capacity = pendres_block_capacity(&b);
  status = pendres_block_carry_tangents(&b, 1);
  for (size_t first = 0, count; first < m->n && status == PENDRES_OK; first += count) {
    count = 1;
    while (count < capacity && first + count < m->n &&
           order[first + count]->generation == order[first]->generation)
      count++;
    status = measure(&b, m, count, order + first);
  }
  (void)pendres_block_carry_tangents(&b, 0);
  return status;
}

pendres_status pendres_boundary_distance(pendres_context *ctx, const pendres_boundary_seed *seed,
                                         size_t n, const pendres_boundary_node *nodes,
                                         double *distance)
{
  const pendres_boundary_node **order = malloc((n + 1) * sizeof *order);
  if (order == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a boundary");
  for (size_t i = 0; i < n; i++) order[i] = &nodes[i];
  qsort(order, n, sizeof *order, by_generation);
  measuring m = {.seed = seed, .forward = seed->backward, .nodes = nodes, .n = n,
                 .distance = distance};
  m.forward.damping = -m.forward.damping;
  const pendres_status status = measure_all(ctx, &m, order);
  free(order);
  return status;
}
