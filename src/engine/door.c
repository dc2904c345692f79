/* door.c -- how public functions go into canonical units; see door.h. */
#include "engine/door.h"

#include <math.h>
#include <string.h>

#include "engine/accuracy.h"
#include "model/parameter.h"

static const pendres_units none = {1.0, 1.0};

void pendres_door_move(pendres_door *d, pendres_parameter first, pendres_parameter second)
{
  d->scales.first = pendres_units_of_parameter(&d->scales.unit, first);
  d->scales.second = pendres_units_of_parameter(&d->scales.unit, second);
}

/* Enter the context; nonzero if that is refused. */
static int enter(pendres_door *d, pendres_context *ctx)
{
  *d = (pendres_door){.ctx = ctx, .scales = {none, 1.0, 1.0},
                      .room = pendres_room_open(ctx, "set of arguments")};
  pendres_guard *guard = ctx != NULL ? &ctx->guard : NULL;
  d->entered = pendres_guard_enter(guard);
  if (!d->entered) {
    d->status = pendres_guard_refusal(guard);
    return 1;
  }
  d->outermost = !ctx->canonical;
  d->tolerance = ctx->options.tolerance;
  return 0;
}

/* Begin to compute in these units. */
static void begin(pendres_door *d, pendres_units u)
{
  pendres_context *ctx = d->ctx;
  if (!d->outermost) return;
  d->scales = (pendres_scales){u, 1.0, 1.0};
  ctx->canonical = 1;
  if (ctx->tolerance_given) ctx->options.tolerance = d->tolerance / u.length;
  /* A result may be more exact than requested, but not less. */
  const double t = fmin(ctx->options.tolerance, PENDRES_ACCURACY_LOOSEST);
  ctx->options.tolerance = t;
  if (!(t >= PENDRES_ACCURACY_TIGHTEST))
    d->status = pendres_context_fail(
      ctx, PENDRES_INVALID_ARGUMENT,
      "the tolerance is %.3g of this pendulum's unit of length, %.3g: it must be at least 1e-13 of "
      "it", t, u.length);
}

/* End that: what was announced is converted back, what was copied is freed. */
static void end(pendres_door *d)
{
  for (int i = 0; i < d->outs; i++)
    pendres_units_out(&d->scales, d->out[i].kind, d->out[i].n, d->out[i].records);
  (void)pendres_room_close(&d->room, d->status);
  d->outs = 0;
  if (!d->outermost) return;
  d->ctx->options.tolerance = d->tolerance;
  d->ctx->canonical = 0;
}

pendres_door pendres_door_open_in(pendres_context *ctx, pendres_units u)
{
  pendres_door d;
  if (enter(&d, ctx) == 0) begin(&d, u);
  return d;
}

pendres_door pendres_door_open(pendres_context *ctx, const pendres_pendulum *p)
{
  return pendres_door_open_in(ctx, pendres_units_of(p));
}

/* A pendulum with the value of a parameter that decides. */
static pendres_pendulum moved_to(const pendres_pendulum *p, pendres_parameter moved, double largest)
{
  pendres_pendulum q = {.damping = 0.0};
  if (p != NULL) q = *p;
  return pendres_parameter_with(&q, moved, largest);
}

static double largest_of(size_t n, const double *value)
{
  double largest = 0.0;
  for (size_t i = 0; value != NULL && i < n; i++)
    if (fabs(value[i]) > fabs(largest) && isfinite(value[i])) largest = value[i];
  return largest;
}

pendres_door pendres_door_open_along(pendres_context *ctx, const pendres_pendulum *p,
                                     pendres_parameter moved, size_t n, const double *value)
{
  const pendres_pendulum q = moved_to(p, moved, largest_of(n, value));
  pendres_door d = pendres_door_open(ctx, &q);
  pendres_door_move(&d, moved, moved);
  return d;
}

pendres_door pendres_door_open_many(pendres_context *ctx, size_t n, const void *pendulums,
                                    size_t stride)
{
  pendres_door d;
  if (enter(&d, ctx) != 0) return d;
  d.pendulums = pendulums;
  d.n = n;
  d.stride = stride;
  return d;
}

void pendres_door_range(pendres_door *d, pendres_parameter moved, double low, double high)
{
  const double ends[2] = {low, high};
  d->ranges = 1;
  d->moved = moved;
  d->largest = largest_of(2, ends);
}

static pendres_units units_at(const pendres_door *d, size_t i)
{
  const pendres_pendulum *p =
    (const pendres_pendulum *)(const void *)(d->pendulums + i * d->stride);
  if (!d->ranges) return pendres_units_of(p);
  const pendres_pendulum q = moved_to(p, d->moved, d->largest);
  return pendres_units_of(&q);
}

int pendres_door_next(pendres_door *d)
{
  if (!d->entered || d->status != PENDRES_OK) return 0;
  if (d->begun) {
    end(d);
    d->first += d->count;
    if (d->first >= d->n) return 0;
  }
  d->begun = 1;
  d->count = d->n - d->first;
  if (!d->outermost || d->pendulums == NULL || d->count == 0) {
    begin(d, none);
  } else {
    const pendres_units u = units_at(d, d->first);
    for (d->count = 1; d->first + d->count < d->n; d->count++) {
      const pendres_units other = units_at(d, d->first + d->count);
      if (other.length != u.length || other.time != u.time) break;
    }
    begin(d, u);
  }
  return d->status == PENDRES_OK;
}

int pendres_door_changes(const pendres_door *d)
{
  return !pendres_units_trivial(&d->scales.unit);
}

void *pendres_door_memory(pendres_door *d, size_t size)
{
  if (d->status != PENDRES_OK) return NULL;
  void *memory = pendres_room_take(&d->room, 1, size);
  d->status = d->room.status;
  return memory;
}

void *pendres_door_copy(pendres_door *d, const void *bytes, size_t size)
{
  if (bytes == NULL) return NULL;
  void *copy = pendres_door_memory(d, size);
  return copy != NULL ? memcpy(copy, bytes, size) : NULL;
}

const void *pendres_door_in(pendres_door *d, const pendres_dimensions *kind, size_t n,
                            const void *records)
{
  if (records == NULL || n == 0 || d->status != PENDRES_OK || !pendres_door_changes(d))
    return records;
  void *copy = pendres_door_copy(d, records, n * kind->size);
  if (copy != NULL) pendres_units_in(&d->scales, kind, n, copy);
  return copy;
}

void *pendres_door_out(pendres_door *d, const pendres_dimensions *kind, size_t n, void *records)
{
  if (records == NULL || n == 0 || d->status != PENDRES_OK || !pendres_door_changes(d))
    return records;
  if (d->outs == PENDRES_DOOR_RESULTS) {
    d->status = pendres_context_fail(d->ctx, PENDRES_INTERNAL, "too many results for a door");
    return records;
  }
  pendres_units_in(&d->scales, kind, n, records);
  d->out[d->outs].kind = kind;
  d->out[d->outs].n = n;
  d->out[d->outs++].records = records;
  return records;
}

const void *pendres_door_in_run(pendres_door *d, const pendres_dimensions *kind,
                                const void *records)
{
  const char *all = records;
  return pendres_door_in(d, kind, d->count, PENDRES_DOOR_AT(all, d->first * kind->size));
}

void *pendres_door_out_run(pendres_door *d, const pendres_dimensions *kind, void *records)
{
  char *all = records;
  return pendres_door_out(d, kind, d->count, PENDRES_DOOR_AT(all, d->first * kind->size));
}

void pendres_door_out_record(pendres_door *d, size_t n, const pendres_record *record)
{
  (void)pendres_door_out(d, &pendres_dim_length, n, record->x);
  (void)pendres_door_out(d, &pendres_dim_speed, n, record->v);
  (void)pendres_door_out(d, &pendres_dim_length, n, record->x_error);
  (void)pendres_door_out(d, &pendres_dim_speed, n, record->v_error);
}

pendres_status pendres_door_close(pendres_door *d)
{
  if (!d->entered) return d->status;
  /* Numbers in a message are in canonical units. */
  if (d->status != PENDRES_OK && pendres_door_changes(d)) {
    char words[PENDRES_MESSAGE_LENGTH];
    memcpy(words, d->ctx->guard.message, sizeof words);
    if (d->ctx->guard.said == d->status)
      (void)pendres_context_fail(d->ctx, d->status, "%.400s (in units of length %g, of time %g)",
                                 words, d->scales.unit.length, d->scales.unit.time);
  }
  end(d);
  return pendres_guard_leave(&d->ctx->guard, d->status);
}
