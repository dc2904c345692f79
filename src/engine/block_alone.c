/* block_alone.c -- periods without ARKODE; see block_internal.h. */
#include "engine/block.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/grow.h"
#include "base/instructions.h"
#include "base/sine.h"
#include "engine/block_internal.h"
#include "model/model.h"

/* ---- a Nystrom method ---- */

int pendres_block_nystrom_prepare(pendres_nystrom_steps *s, int steps)
{
  enum { STAGES = PENDRES_NYSTROM_STAGES };
  if (s->steps == steps) return 0;
  s->steps = 0;
  if (!pendres_regrow(&s->cosine, (size_t)steps * STAGES, sizeof *s->cosine)) return -1;
  for (int k = 0; k < STAGES * steps; k++)
    s->cosine[k] = cos(two_pi * (k / STAGES + pendres_nystrom_node[k % STAGES] / 20.0) / steps);
  s->steps = steps;
  return 0;
}

int pendres_block_run_nystrom(pendres_block *b, int single)
{
  const pendres_lanes_shape *s = &b->shape;
  if (b->drive.steps < 1 || s->rows != PENDRES_ROWS_STATE || b->load == PENDRES_FLOW_TANGENTS ||
      (single && s->model != PENDRES_MODEL_PLAIN))
    return PENDRES_BLOCK_CANNOT;
  if (pendres_block_nystrom_prepare(&b->nystrom, b->drive.steps) != 0) return PENDRES_BLOCK_STARVED;
  const pendres_nystrom_lanes lanes = {.lanes = s->stride, .model = s->model, .y = b->rows,
                                       .w = b->rows + s->stride, .k = s->coefficients,
                                       .off = s->off};
  const pendres_kernels_nystrom *kernels = PENDRES_INSTRUCTIONS_BEST(pendres_kernels_nystrom);
  (single ? kernels->run_single : kernels->run)(&b->nystrom, &lanes);
  return b->drive.steps * PENDRES_NYSTROM_STAGES;
}

/* ---- splitting ---- */

int pendres_block_split_prepare(pendres_split_steps *s, int steps)
{
  if (s->steps == steps) return 0;
  s->steps = 0;
  const int kicks = PENDRES_SPLIT_KICKS * steps;
  const double at[PENDRES_SPLIT_KICKS] = {pendres_split_a, 0.5, 1.0 - pendres_split_a};
  if (!pendres_regrow(&s->cosine, (size_t)kicks, sizeof *s->cosine) ||
      !pendres_regrow(&s->sine, (size_t)kicks, sizeof *s->sine))
    return -1;
  for (int k = 0; k < kicks; k++)
    pendres_kernels_sincos(
      two_pi * (k / PENDRES_SPLIT_KICKS + at[k % PENDRES_SPLIT_KICKS]) / steps, &s->sine[k],
      &s->cosine[k]);
  s->steps = steps;
  return 0;
}

int pendres_block_run_split(pendres_block *b)
{
  const pendres_lanes_shape *s = &b->shape;
  const int tangents = b->load == PENDRES_FLOW_TANGENTS;
  if (b->drive.steps < 1 || s->rows != PENDRES_ROWS_STATE) return PENDRES_BLOCK_CANNOT;
  if (pendres_block_split_prepare(&b->split, b->drive.steps) != 0) return PENDRES_BLOCK_STARVED;
  const pendres_split_lanes lanes = {.lanes = s->stride, .model = s->model, .y = b->rows,
                                     .w = b->rows + s->stride, .k = s->coefficients,
                                     .tangent_y = tangents ? s->tangent.y[0] : NULL,
                                     .tangent_w = tangents ? s->tangent.w[0] : NULL};
  PENDRES_INSTRUCTIONS_BEST(pendres_kernels_split)->run(&b->split, &lanes);
  if (tangents) {
    memcpy(s->tangent.y[1], s->tangent.y[0], s->stride * sizeof(double));
    memcpy(s->tangent.w[1], s->tangent.w[0], s->stride * sizeof(double));
  }
  return b->drive.steps * PENDRES_SPLIT_KICKS;
}

void pendres_block_split_state(const pendres_pendulum *p, int steps, int back, double *y, double *w)
{
  double force, slope;
  const double omega = p->drive_frequency, step = two_pi / (steps * omega);
  const double shift = (back ? -1.0 : 1.0) * pendres_split_k * step * step;
  pendres_model_force(p, *y, &force, &slope);
  const double drive = 1.0 + p->parametric_amplitude, f = drive * force - p->torque;
  const double turned = drive * slope * *w + p->damping / omega * f;
  *y += shift * f;
  *w -= shift * turned;
}

void pendres_block_alone_free(pendres_block *b)
{
  free(b->nystrom.cosine);
  free(b->split.cosine);
  free(b->split.sine);
}
