/* orbit_span.c -- how far motions reach; see orbit_span.h. */
#include "orbits/orbit_span.h"

#include <math.h>

#include "base/angles.h"
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "engine/kernels/rank.h"
#include "engine/room.h"

double pendres_turning_angle(double spacing, double y0, double w0, double y1, double w1)
{
  const double mean = (y1 - y0) / spacing;
  const double a = 3.0 * (w0 + w1 - 2.0 * mean), b = 2.0 * (3.0 * mean - 2.0 * w0 - w1);
  /* Its velocity is w0 + b t + a t^2, t from 0 to 1: of opposite signs at the ends. */
  const double root = sqrt(fmax(0.0, b * b - 4.0 * a * w0));
  const double q = -0.5 * (b + copysign(root, b));
  const double first = q != 0.0 ? w0 / q : -1.0, second = a != 0.0 ? q / a : -1.0;
  const double t = first >= 0.0 && first <= 1.0 ? first : fmin(fmax(second, 0.0), 1.0);
  return y0 + spacing * t * (w0 + t * (0.5 * b + t * a / 3.0));
}

/* The periodic part of an orbit: its latest state, and what it has reached. */
typedef struct span {
  double low, high, y, w;
} span;

/* Orbits side by side in a block. */
typedef struct spans {
  size_t n;
  const pendres_rank *rank;
  const pendres_orbit *orbit;
  span *of;
  int steps;
  int period; /* the present one */
} spans;

static void look(void *arg, int step, const pendres_rows *rows)
{
  const spans *s = arg;
  const double spacing = two_pi / s->steps, phase = two_pi * s->period + spacing * step;
  for (size_t i = 0; i < s->n; i++) {
    const pendres_orbit *o = &s->orbit[s->rank[i].index];
    span *a = &s->of[i];
    if (s->period >= o->period) continue;
    const double turning = (double)o->winding / o->period;
    const double y = pendres_rows_get(rows, PENDRES_ROW_Y, i) - turning * phase;
    const double w = pendres_rows_get(rows, PENDRES_ROW_W, i) - turning;
    const double top = a->w * w < 0.0 ? pendres_turning_angle(spacing, a->y, a->w, y, w) : y;
    *a = (span){fmin(a->low, fmin(y, top)), fmax(a->high, fmax(y, top)), y, w};
  }
}

/* Those that share a block. */
static pendres_status run(pendres_context *ctx, spans *s, pendres_orbit *orbit)
{
  pendres_block *block;
  int longest = 0;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, s->steps, &block);
  if (status != PENDRES_OK) return status;
  if (s->n > pendres_block_capacity(block)) s->n = pendres_block_capacity(block);
  pendres_block_resize(block, s->n);
  for (size_t i = 0; i < s->n; i++) {
    const pendres_orbit *o = &orbit[s->rank[i].index];
    const pendres_coordinates at = pendres_coordinates_in(&o->pendulum, o->x, o->v);
    pendres_block_load(block, i, &o->pendulum, at.y, at.w);
    s->of[i] = (span){at.y, at.y, at.y, at.w - (double)o->winding / o->period};
    if (o->period > longest) longest = o->period;
  }
  for (s->period = 0; s->period < longest && status == PENDRES_OK; s->period++)
    status = pendres_block_period_sampled(block, look, s);
  for (size_t i = 0; i < s->n && status == PENDRES_OK; i++)
    orbit[s->rank[i].index].amplitude = 0.5 * (s->of[i].high - s->of[i].low);
  return status;
}

pendres_status pendres_orbits_span(pendres_context *ctx, size_t n, pendres_orbit *orbit)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_rank *rank = pendres_room_take(&room, n, sizeof *rank);
  span *of = pendres_room_take(&room, n, sizeof *of);
  pendres_status status = room.status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    rank[i] = (pendres_rank){
      .steps = orbit[i].steps, .model = pendres_model_kind(&orbit[i].pendulum), .index = i};
  if (status == PENDRES_OK) pendres_rank_order(n, rank);
  for (size_t first = 0, same; first < n && status == PENDRES_OK; first += same) {
    same = 1;
    while (first + same < n && pendres_rank_equal(&rank[first + same], &rank[first])) same++;
    spans s = {.n = same, .rank = rank + first, .orbit = orbit, .of = of,
               .steps = rank[first].steps};
    status = run(ctx, &s, orbit);
    same = s.n;
  }
  return pendres_room_close(&room, status);
}
