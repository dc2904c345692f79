/* strobe_noise.c -- rounding along trajectories; see strobe_noise.h. */
#include "orbits/strobe_noise.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/passage.h"
#include "engine/rank.h"
#include "engine/tables.h"

/*
 * A unit in the last place of angles up to pi, as measured with tp8, whose weights add up to 7 in
 * size. Those of vern8 add up to 96: slopes cancel, and what they are rounded by does not.
 */
double pendres_strobe_noise_of_step(pendres_table table)
{
  static const double step_rounding = 4.4e-16, usual_weights = 7.2;
  const pendres_tables_method *m = pendres_tables_get(table);
  double weights = 0.0;
  for (int i = 0; m != NULL && i < m->stages; i++) weights += fabs(m->b[i]);
  return step_rounding * fmax(1.0, weights / usual_weights);
}

void pendres_strobe_noise_carry(const double noise[3], double rounding, int step,
                                const pendres_rows *rows, size_t lane, double out[3])
{
  double m[2][2];
  pendres_rows_tangent(rows, lane, m);
  const double a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
  const double w = fmax(1.0, fabs(pendres_rows_get(rows, PENDRES_ROW_W, lane)));
  /* What is added on the way grows on the way: half of it counts as there from the start. */
  const double added = 0.5 * rounding * rounding * step;
  const double yy = noise[0] + added, yw = noise[1], ww = noise[2] + added * w * w;
  out[0] = a * a * yy + 2.0 * a * b * yw + b * b * ww + added;
  out[1] = a * c * yy + (a * d + b * c) * yw + b * d * ww;
  out[2] = c * c * yy + 2.0 * c * d * yw + d * d * ww + added * w * w;
}

typedef struct covariance {
  double c[3];
} covariance;

/* One period of a block of n lanes of equal steps. */
static pendres_status turn(pendres_block *b, const pendres_rank *rank,
                           pendres_strobe_lane *lanes, covariance *noise)
{
  for (size_t i = 0; i < b->lanes; i++) {
    const pendres_strobe_lane *l = &lanes[rank[i].index];
    pendres_block_load(b, i, l->pendulum, l->y, l->w);
  }
  const pendres_status status = pendres_block_period(b);
  if (status != PENDRES_OK) return status;
  const pendres_rows rows = pendres_block_rows(b);
  const double rounding = pendres_strobe_noise_of_step(b->ctx->options.table);
  for (size_t i = 0; i < b->lanes; i++) {
    pendres_strobe_lane *l = &lanes[rank[i].index];
    covariance *old = &noise[rank[i].index], next;
    pendres_strobe_noise_carry(old->c, rounding, l->steps, &rows, i, next.c);
    *old = next;
    l->y = pendres_rows_get(&rows, PENDRES_ROW_Y, i);
    l->w = pendres_rows_get(&rows, PENDRES_ROW_W, i);
    l->period++;
    pendres_passage_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  }
  return PENDRES_OK;
}

pendres_status pendres_strobe_noise_run(pendres_context *ctx, size_t n,
                                        pendres_strobe_lane *lanes, long periods, double *noise)
{
  pendres_status status = PENDRES_OK;
  pendres_rank *rank = malloc((n + 1) * sizeof *rank);
  covariance *sum = calloc(n + 1, sizeof *sum);
  if (rank == NULL || sum == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++)
    rank[i] = (pendres_rank){.steps = lanes[i].steps,
                             .model = pendres_model_kind(lanes[i].pendulum),
                             .index = i};
  pendres_rank_order(n, rank);
  for (size_t first = 0, last; first < n && status == PENDRES_OK; first = last) {
    pendres_block b;
    last = first + 1;
    status = pendres_block_open(ctx, PENDRES_FLOW_VARIATIONAL, rank[first].steps, &b);
    if (status != PENDRES_OK) break;
    const size_t capacity = pendres_block_capacity(&b);
    while (last < n && last - first < capacity && pendres_rank_equal(&rank[last], &rank[first]))
      last++;
    pendres_block_resize(&b, last - first);
    for (long k = 0; k < periods && status == PENDRES_OK; k++)
      status = turn(&b, rank + first, lanes, sum);
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const double omega = lanes[i].pendulum->drive_frequency;
    noise[i] = INFINITY;
    if (isfinite(sum[i].c[0] + sum[i].c[1] + sum[i].c[2]))
      noise[i] = fmax(sqrt(sum[i].c[0]), omega * sqrt(sum[i].c[2]));
  }
done:
  free(rank);
  free(sum);
  return status;
}
