/* escape.c -- pendulums on their way to infinity; see escape.h. */
#include "orbits/escape.h"

#include <math.h>

#include "engine/block.h"
#include "model/model.h"
#include "orbits/numbers.h"

int pendres_escape_possible(const pendres_pendulum *p)
{
  return !(pendres_model_of(p->force)->period > 0.0);
}

int pendres_escape_lost(double y, double w)
{
  return !(fabs(y) < escape_lost_beyond && fabs(w) < escape_lost_beyond);
}

typedef struct last_period {
  const pendres_pendulum *pendulum;
  int escapes, lost;
} last_period;

static void watch_escape(void *arg, int step, const pendres_rows *rows)
{
  last_period *p = arg;
  const double y = pendres_rows_get(rows, PENDRES_ROW_Y, 0);
  const double w = pendres_rows_get(rows, PENDRES_ROW_W, 0);
  (void)step;
  p->lost |= pendres_escape_lost(y, w);
  if (!p->lost) p->escapes |= pendres_model_escapes(p->pendulum, y, w);
}

pendres_status pendres_escape_within(pendres_context *ctx, const pendres_strobe_lane *lane,
                                     double y, double w, int *away)
{
  last_period p = {.pendulum = lane->pendulum};
  pendres_block *block;
  *away = 0;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, lane->steps, &block);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(block, 1);
  pendres_block_load(block, 0, lane->pendulum, y, w);
  status = pendres_block_period_sampled(block, watch_escape, &p);
  *away = status == PENDRES_OK && p.escapes;
  return status;
}
