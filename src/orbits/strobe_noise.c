/* strobe_noise.c -- rounding along trajectories; see strobe_noise.h. */
#include "orbits/strobe_noise.h"

#include <math.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/steps.h"
#include "engine/kernels/tables.h"
#include "orbits/numbers.h"

/*
 * A unit in the last place of angles up to pi, as measured with tp8. The moduli of its weights add
 * up to 7; where they add up to more, slopes cancel, but their rounding errors do not.
 */
double pendres_strobe_noise_of_step(pendres_table table)
{
  const pendres_tables_method *m = pendres_tables_get(table);
  double weights = 0.0;
  for (int i = 0; m != NULL && i < m->stages; i++) weights += fabs(m->b[i]);
  return 2.0 * last_place_of_one * fmax(1.0, weights / step_usual_weights);
}

/* Single precision has 29 bits less. */
double pendres_strobe_noise_of_single_step(void)
{
  return 0x1p29 * 2.0 * last_place_of_one;
}

double pendres_strobe_noise_fastest(const pendres_context *ctx, const pendres_pendulum *p)
{
  const double fastest = pendres_strobe_single_fastest(p);
  const int may = ctx->options.method == PENDRES_BLOCK_FIXED &&
                  ctx->options.steps_per_period == 0 &&
                  pendres_model_kind(p) == PENDRES_MODEL_PLAIN &&
                  pendres_steps_turning_speed(p) <= fastest;
  return may ? fastest : -1.0;
}

void pendres_strobe_noise_choose(double speed, double fastest, double accuracy,
                                 pendres_strobe_lane *lane)
{
  const double rounding = pendres_strobe_noise_of_single_step(), added = rounding * rounding;
  if (lane->way != PENDRES_FLOW_NYSTROM || !(speed <= fastest) ||
      !(accuracy * accuracy >= lane->steps * added))
    return;
  lane->way = PENDRES_FLOW_SINGLE;
  lane->added += added;
}

double pendres_strobe_noise_of(double drive_frequency, const pendres_flow_error *carried)
{
  if (!isfinite(carried->yy + carried->yw + carried->ww)) return INFINITY;
  return fmax(sqrt(carried->yy), drive_frequency * sqrt(carried->ww));
}
