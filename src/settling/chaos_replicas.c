/* chaos_replicas.c -- pendulums with tangent vectors; see chaos_replicas.h. */
#include "settling/chaos_replicas.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "settling/attractor_set.h"
#include "settling/exponents/growth.h"
#include "orbits/orbit_span.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "engine/threads.h"
#include "model/equation.h"
#include "model/model.h"

pendres_replica pendres_replica_at(double y, double w)
{
  return (pendres_replica){
    .y = y, .w = w, .u = PENDRES_TANGENTS_BEGIN, .low = {y, y}, .high = {y, y}};
}

/* ---- samples within a period ---- */

/* What is watched of all replicas of a block, side by side; between periods each has its own. */
typedef struct watched_block {
  const pendres_pendulum *pendulum;
  size_t n;
  int steps;
  pendres_replica *a;
  double *work, *other, *loss; /* sums, as in the replicas */
  double *low, *high;          /* of the present half of the period */
  double *last_y, *last_w;     /* the latest sample */
} watched_block;

enum { WATCHED = 7 /* such arrays */ };

/*
 * At the end of each half period the latest two halves form a whole one, whose amplitude is added
 * with the weight 1/2. The mirror image of a motion, half a period later, thus has the same sum.
 */
static void end_half(watched_block *b, size_t i, double y)
{
  pendres_replica *a = &b->a[i];
  a->sum[PENDRES_REPLICA_AMPLITUDE] +=
    0.25 * (fmax(a->high[0], b->high[i]) - fmin(a->low[0], b->low[i]));
  a->low[0] = b->low[i];
  a->high[0] = b->high[i];
  b->low[i] = b->high[i] = y;
}

/* The force of the torque and the parametric drive, at a drive of that cosine. */
static double other_force(const pendres_pendulum *p, double y, double cosine)
{
  double force, slope;
  if (p->parametric_amplitude == 0.0) return p->torque;
  pendres_model_force(p, y, &force, &slope);
  return p->torque - p->parametric_amplitude * cosine * force;
}

static void add_other(const watched_block *b, double spacing, double cosine, const double *y,
                      const double *w)
{
  if (b->pendulum->torque == 0.0 && b->pendulum->parametric_amplitude == 0.0) return;
  for (size_t i = 0; i < b->n; i++)
    b->other[i] += spacing * w[i] * other_force(b->pendulum, y[i], cosine);
}

/*
 * Sums of samples, one after the other over many periods, are integrals by the trapezoidal rule:
 * their ends count once, whatever happens in between is integrated as a closed orbit is.
 */
static void add_sample(const watched_block *b, double spacing, double cosine,
                       const double *restrict y, const double *restrict w)
{
  const double by_drive = b->pendulum->drive_amplitude * spacing * cosine;
  const double omega = b->pendulum->drive_frequency;
  double *restrict work = b->work, *restrict loss = b->loss;
  double *restrict low = b->low, *restrict high = b->high;
  for (size_t i = 0; i < b->n; i++) {
    work[i] += by_drive * w[i];
    loss[i] += pendres_equation_friction(b->pendulum, y[i], omega * w[i]) * omega * spacing * w[i] *
               w[i];
    low[i] = y[i] < low[i] ? y[i] : low[i];
    high[i] = y[i] > high[i] ? y[i] : high[i];
  }
}

static void watch(void *arg, int step, const pendres_rows *rows)
{
  watched_block *b = arg;
  const double spacing = two_pi / b->steps, cosine = cos(two_pi * step / b->steps);
  const double *y = rows->at + PENDRES_ROW_Y * rows->stride;
  const double *w = rows->at + PENDRES_ROW_W * rows->stride;
  add_sample(b, spacing, cosine, y, w);
  add_other(b, spacing, cosine, y, w);
  for (size_t i = 0; i < b->n; i++) {
    if (!(b->last_w[i] * w[i] < 0.0)) continue;
    const double turned = pendres_turning_angle(spacing, b->last_y[i], b->last_w[i], y[i], w[i]);
    if (turned < b->low[i]) b->low[i] = turned;
    if (turned > b->high[i]) b->high[i] = turned;
  }
  for (size_t i = 0; i < b->n && (step == b->steps / 2 || step == b->steps); i++)
    end_half(b, i, y[i]);
  memcpy(b->last_y, y, b->n * sizeof *y);
  memcpy(b->last_w, w, b->n * sizeof *w);
}

/* ---- periods ---- */

static void turn(pendres_block *block, size_t lane, int last, pendres_replica *a)
{
  double growth[2];
  pendres_tangents_take(block, lane, last, a->u, growth);
  const double coarse = pendres_growth_correction(growth);
  a->sum[PENDRES_REPLICA_GROWTH] += growth[0] - coarse;
  a->sum[PENDRES_REPLICA_COARSE] += coarse;
}

/* Take over what the flow has made of a replica in one period. */
static void arrive(const pendres_attractor_set *c, size_t i, const pendres_rows *rows, int watched,
                   pendres_replica *a)
{
  const double y = pendres_rows_get(rows, PENDRES_ROW_Y, i);
  a->sum[PENDRES_REPLICA_TURNS] += (y - a->y) / two_pi;
  a->y = y;
  a->w = pendres_rows_get(rows, PENDRES_ROW_W, i);
  a->sum[PENDRES_REPLICA_SPEED] += a->w;
  pendres_coordinates_wrap(&c->pendulum, &a->y, &a->turns);
  for (int k = 0; k < 2; k++) {
    /* Of a period that was not watched its end is all that is known. */
    a->low[k] = watched ? a->low[k] + (a->y - y) : a->y;
    a->high[k] = watched ? a->high[k] + (a->y - y) : a->y;
  }
  a->periods++;
  /* A replica that escapes has left the chaos, too. */
  if (a->trapped == 0 &&
      (pendres_attractor_set_ellipse(c, a->y, a->w) != NULL || !isfinite(a->y) ||
       pendres_escape_certain(&c->pendulum, &c->beside, a->y, a->w)))
    a->trapped = a->periods;
}

static void load(pendres_block *block, const watched_block *b)
{
  pendres_block_resize(block, b->n);
  for (size_t i = 0; i < b->n; i++) {
    pendres_block_load(block, i, b->pendulum, b->a[i].y, b->a[i].w);
    pendres_tangents_put(block, i, b->a[i].u);
  }
}

/* Put what is watched side by side before a period, and give it back after. */
static void spread(const watched_block *b)
{
  for (size_t i = 0; i < b->n; i++) {
    const pendres_replica *a = &b->a[i];
    b->work[i] = a->sum[PENDRES_REPLICA_WORK];
    b->other[i] = a->sum[PENDRES_REPLICA_OTHER];
    b->loss[i] = a->sum[PENDRES_REPLICA_LOSS];
    b->low[i] = a->low[1];
    b->high[i] = a->high[1];
    b->last_y[i] = a->y;
    b->last_w[i] = a->w;
  }
}

static void gather(const watched_block *b)
{
  for (size_t i = 0; i < b->n; i++) {
    pendres_replica *a = &b->a[i];
    a->sum[PENDRES_REPLICA_WORK] = b->work[i];
    a->sum[PENDRES_REPLICA_OTHER] = b->other[i];
    a->sum[PENDRES_REPLICA_LOSS] = b->loss[i];
    a->low[1] = b->low[i];
    a->high[1] = b->high[i];
  }
}

static pendres_status advance_block(pendres_block *block, watched_block *b,
                                    const pendres_attractor_set *c, int watched, int last)
{
  if (watched) spread(b);
  const pendres_status status =
    watched ? pendres_block_period_sampled(block, watch, b) : pendres_block_period(block);
  if (status != PENDRES_OK) return status;
  if (watched) gather(b);
  const pendres_rows rows = pendres_block_rows(block);
  for (size_t i = 0; i < b->n; i++) {
    arrive(c, i, &rows, watched, &b->a[i]);
    turn(block, i, last, &b->a[i]);
    pendres_block_put_state(block, i, b->a[i].y, b->a[i].w);
  }
  return status;
}

static void record(pendres_replica_trace *t, long filled, size_t replica, const pendres_replica *a)
{
  const size_t at = replica * (size_t)t->length + (size_t)(filled % t->length);
  t->y[at] = a->y + two_pi * (double)a->turns;
  t->w[at] = a->w;
}

/* Replicas that are advanced by so many periods. */
typedef struct advance {
  const pendres_attractor_set *set;
  pendres_replica *replica;
  int steps;
  long periods;
  pendres_replica_trace *trace; /* NULL: none is kept */
} advance;

/* Some of them; no more than a block holds. */
static pendres_status advance_some(pendres_context *ctx, size_t first, size_t n, void *arg)
{
  const advance *of = arg;
  pendres_block *block;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, of->steps, &block);
  if (status != PENDRES_OK) return status;
  pendres_room room = pendres_room_open(ctx, "replicas");
  double *rows = pendres_room_take(&room, WATCHED * n, sizeof *rows);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  status = pendres_block_carry(block, PENDRES_FLOW_TANGENTS);
  watched_block b = {.pendulum = &of->set->pendulum, .steps = of->steps, .a = of->replica + first,
                     .n = n, .work = rows, .other = rows + n, .loss = rows + 2 * n,
                     .low = rows + 3 * n, .high = rows + 4 * n,
                     .last_y = rows + 5 * n, .last_w = rows + 6 * n};
  if (status == PENDRES_OK) load(block, &b);
  for (long k = 0; k < of->periods && status == PENDRES_OK; k++) {
    status = advance_block(block, &b, of->set, of->trace != NULL, k == of->periods - 1);
    for (size_t i = 0; i < n && of->trace != NULL && status == PENDRES_OK; i++)
      record(of->trace, of->trace->filled + k, first + i, &b.a[i]);
  }
  (void)pendres_block_carry(block, PENDRES_FLOW_NOTHING);
  return pendres_room_close(&room, status);
}

pendres_status pendres_replicas_advance(pendres_context *ctx, const pendres_attractor_set *c,
                                        size_t n,
                                        pendres_replica *a, long periods,
                                        pendres_replica_trace *trace)
{
  advance of = {.set = c, .replica = a, .periods = periods, .trace = trace};
  double fastest = 0.0;
  const double origin = pendres_model_origin(&c->pendulum), omega = c->pendulum.drive_frequency;
  for (size_t i = 0; i < n; i++)
    fastest = fmax(fastest, pendres_steps_speed(&c->pendulum, a[i].y + origin, a[i].w * omega));
  pendres_status status =
    pendres_steps_choose(ctx, &c->pendulum, fastest, pendres_accuracy_in_chaos(ctx), &of.steps);
  of.steps += of.steps % 2; /* for tangents with steps twice as long */
  const size_t share = pendres_threads_share(ctx, n), block = (size_t)ctx->options.block_lanes;
  if (status == PENDRES_OK)
    status = pendres_threads_run(ctx, n, share < block ? share : block, advance_some, &of);
  if (trace != NULL) trace->filled += periods;
  return status;
}
