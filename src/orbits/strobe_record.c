/*
 * strobe_record.c -- a trajectory at equally spaced drive phases; see strobe.h.
 *
 * Errors: discretisation from a second run with twice the steps; rounding from the covariance of
 * the state's rounding errors, propagated by the variational equation of the second run.
 */
#include <pendres/strobe.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "orbits/strobe_noise.h"
#include "engine/strobe_run.h"
#include "orbits/numbers.h"

enum { MOST_SAMPLES = 1000000 };

/* Where the points of a period go, and in the second run their standard errors of rounding, too. */
typedef struct recorder {
  double *x, *v;             /* the period's first point */
  double *x_noise, *v_noise; /* NULL in the first run */
  double added;              /* variance of an angle by rounding in a step */
  const pendres_block *block;
  int stretch;               /* steps between two points */
  const pendres_pendulum *p;
  long turns;                /* of the period's start */
} recorder;

static void keep(void *arg, int step, const pendres_rows *rows)
{
  const recorder *r = arg;
  const int k = step / r->stretch;
  if (step % r->stretch != 0) return;
  const pendres_coordinates s = {.y = pendres_rows_get(rows, PENDRES_ROW_Y, 0),
                           .w = pendres_rows_get(rows, PENDRES_ROW_W, 0),
                           .turns = r->turns};
  pendres_coordinates_out(r->p, &s, &r->x[k], &r->v[k]);
  if (r->x_noise != NULL) {
    const pendres_flow_error off = pendres_block_get_error(r->block, 0);
    r->x_noise[k] = sqrt(off.yy);
    r->v_noise[k] = r->p->drive_frequency * sqrt(off.ww);
  }
}

/* A piece of a run: its first point, and the points of the periods after it. */
typedef struct piece {
  const pendres_recording *of;
  pendres_recording_place *at; /* where the run stands: moved on */
  long periods;
  int stretch;
  double *x, *v;
} piece;

/* Advance a piece's lane by one period from s on; errors are carried along in the second run. */
static pendres_status turn(pendres_block *b, const pendres_flow_error *off, recorder *r,
                           pendres_coordinates *s)
{
  r->turns = s->turns;
  pendres_block_load(b, 0, r->p, s->y, s->w);
  if (r->x_noise != NULL) pendres_block_set_error(b, 0, off, r->added);
  const pendres_status status = pendres_block_period_sampled(b, keep, r);
  const pendres_rows rows = pendres_block_rows(b);
  s->y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
  s->w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
  pendres_coordinates_arrive(r->p, &s->y, &s->w, &s->turns);
  return status;
}

/* Run a piece. *off, NULL in the first run, is the covariance carried along, and is advanced. */
static pendres_status run(pendres_context *ctx, const piece *what, pendres_flow_error *off,
                          double *x_noise, double *v_noise)
{
  pendres_block *b;
  const pendres_pendulum *p = &what->of->pendulum;
  const size_t samples = (size_t)what->of->samples;
  pendres_coordinates s = { .y = what->at->y, .w = what->at->w, .turns = what->at->turns };
  const double rounding = pendres_strobe_noise_of_step(ctx->options.table);
  recorder r = { .stretch = what->stretch, .p = p, .added = rounding * rounding };
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE,
                                             what->of->samples * what->stretch, &b);
  if (status == PENDRES_OK && off != NULL) status = pendres_block_carry(b, PENDRES_FLOW_ERRORS);
  if (status != PENDRES_OK) return status;
  r.block = b;
  pendres_block_resize(b, 1);
  for (long k = 0; k < what->periods && status == PENDRES_OK; k++) {
    const size_t first = (size_t)k * samples;
    r.x = what->x + first;
    r.v = what->v + first;
    r.x_noise = off != NULL ? x_noise + first : NULL;
    r.v_noise = off != NULL ? v_noise + first : NULL;
    status = turn(b, off, &r, &s);
    if (off != NULL) *off = pendres_block_get_error(b, 0);
    if (status == PENDRES_OK && !(isfinite(s.y) && isfinite(s.w)))
      status = pendres_strobe_lost(ctx, p, what->of->periods + k + 1);
  }
  if (off != NULL) (void)pendres_block_carry(b, PENDRES_FLOW_NOTHING);
  *what->at = (pendres_recording_place){ .y = s.y, .w = s.w, .turns = s.turns };
  return status;
}

/* Tell the errors of the points of a piece from the distance to the second run and twice the
   standard error of rounding, which is where they go. */
static void compare(pendres_recording *next, const piece *first, const piece *second,
                    double *x_error, double *v_error)
{
  const size_t n = (size_t)second->periods * (size_t)next->samples;
  for (size_t k = 1; k <= n; k++) {
    const double dx = fabs(first->x[k] - second->x[k]), dv = fabs(first->v[k] - second->v[k]);
    /* The larger of the two: either may be small by chance, where it changes its sign. */
    const double error = pendres_strobe_error(fmax(dx, dv));
    if (!(error + x_error[k] + v_error[k] < INFINITY)) next->lost = 1;
    x_error[k] = error + 2.0 * x_error[k] + last_place_of_one * fabs(first->x[k]);
    v_error[k] = error + 2.0 * v_error[k] + last_place_of_one * fabs(first->v[k]);
    if (next->lost) x_error[k] = v_error[k] = INFINITY;
  }
}

/*
 * Make the second run, as far as it tells errors. Where the error of x or that of v is infinite,
 * both are, from there on: the trajectory may have become another one, even if the two runs meet
 * again.
 */
static pendres_status estimate(pendres_context *ctx, pendres_recording *next, const piece *first,
                               double *x_error, double *v_error)
{
  const size_t samples = (size_t)next->samples, all = (size_t)first->periods * samples;
  const size_t room = samples * STROBE_MOST_COMPARED + 1;
  double *finer = malloc(2 * room * sizeof *finer);
  if (finer == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", room);
  pendres_recording so_far = *first->of;
  pendres_flow_error off = { next->noise[0], next->noise[1], next->noise[2] };
  pendres_status status = PENDRES_OK;
  size_t at = 0;
  for (long left = first->periods; left > 0 && !next->lost && status == PENDRES_OK;) {
    const piece here = { .x = first->x + at, .v = first->v + at };
    const piece second = { .of = &so_far, .at = &next->finer,
                           .periods = left < STROBE_MOST_COMPARED ? left : STROBE_MOST_COMPARED,
                           .stretch = 2 * next->stretch, .x = finer, .v = finer + room };
    status = run(ctx, &second, &off, x_error + at, v_error + at);
    if (status == PENDRES_OK) compare(next, &here, &second, x_error + at, v_error + at);
    at += (size_t)second.periods * samples;
    left -= second.periods;
    so_far.periods += second.periods;
  }
  next->noise[0] = off.yy;
  next->noise[1] = off.yw;
  next->noise[2] = off.ww;
  while (at++ < all) x_error[at] = v_error[at] = INFINITY;
  free(finer);
  return status;
}

/* ---- beginning and going on ---------------------------------------------------------------- */

static pendres_status check(pendres_context *ctx, const pendres_pendulum *p,
                            const pendres_state *start, long periods, int samples)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) == PENDRES_OK) {
    if (periods < 0) why = "the number of periods must not be negative";
    else if (samples < 1 || samples > MOST_SAMPLES)
      why = "the number of samples a period must lie between 1 and 1000000";
    else if (periods >= LONG_MAX / 64 / samples) why = "there are too many samples in all";
    else why = pendres_coordinates_refuses(p, start->x, start->v);
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
}

static pendres_status begin(pendres_context *ctx, const pendres_pendulum *p,
                            const pendres_state *start, long periods, int samples,
                            pendres_recording *out)
{
  int steps = 0;
  if (p == NULL || start == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, start and out");
  const double x0 = start->x, v0 = start->v;
  pendres_status status = check(ctx, p, start, periods, samples);
  if (status == PENDRES_OK)
    /* Errors of all periods may add up. */
    status = pendres_steps_choose(ctx, p, pendres_steps_speed(p, x0, v0),
                                  pendres_accuracy_of_run(ctx, fmax(1.0, (double)periods)), &steps);
  if (status != PENDRES_OK) return status;
  const pendres_coordinates s = pendres_coordinates_in(p, x0, v0);
  memset(out, 0, sizeof *out); /* bytes between the fields, too */
  out->pendulum = *p;
  out->samples = samples;
  out->stretch = (steps + samples - 1) / samples;
  out->x = x0;
  out->v = v0;
  out->x_error = last_place_of_one * fabs(x0);
  out->v_error = last_place_of_one * fabs(v0);
  out->place.y = out->finer.y = s.y;
  out->place.w = out->finer.w = s.w;
  out->place.turns = out->finer.turns = s.turns;
  return PENDRES_OK;
}

pendres_status pendres_recording_begin(pendres_context *ctx, const pendres_pendulum *pendulum,
                                       const pendres_state *start, long periods, int samples,
                                       pendres_recording *out)
{
  pendres_door d = pendres_door_open(ctx, pendulum);
  PENDRES_DOOR_IN(&d, pendulum, 1, pendulum);
  PENDRES_DOOR_IN(&d, state, 1, start);
  PENDRES_DOOR_OUT(&d, recording, 1, out);
  return PENDRES_DOOR_END(&d, begin(ctx, pendulum, start, periods, samples, out));
}

static int too_many(const pendres_recording *r, long periods)
{
  return r->samples < 1 || r->stretch < 1 || r->periods < 0 || periods < 0 ||
         periods >= LONG_MAX / 64 / r->samples - r->periods;
}

static pendres_status go_on(pendres_context *ctx, pendres_recording *r, long periods,
                            const pendres_record *to)
{
  if (r == NULL || to == NULL || to->x == NULL || to->v == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "recording, out, x and v");
  double *x = to->x, *v = to->v, *x_error = to->x_error, *v_error = to->v_error;
  if ((x_error == NULL) != (v_error == NULL))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "errors are of both x and v, or of neither");
  if (too_many(r, periods))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "the recording was not begun by pendres_recording_begin(), or the "
                                "number of periods is negative or too large");
  pendres_recording next = *r;
  const size_t last = (size_t)periods * (size_t)r->samples;
  const piece first = { .of = r, .at = &next.place, .periods = periods, .stretch = r->stretch,
                        .x = x, .v = v };
  x[0] = r->x;
  v[0] = r->v;
  pendres_status status = run(ctx, &first, NULL, NULL, NULL);
  if (x_error == NULL) next.lost = 1;
  for (size_t k = 0; k <= last && x_error != NULL && r->lost; k++)
    x_error[k] = v_error[k] = INFINITY;
  if (x_error != NULL && !r->lost) {
    x_error[0] = r->x_error;
    v_error[0] = r->v_error;
    if (status == PENDRES_OK) status = estimate(ctx, &next, &first, x_error, v_error);
  }
  if (status != PENDRES_OK) return status;
  next.x = x[last];
  next.v = v[last];
  next.x_error = x_error != NULL ? x_error[last] : INFINITY;
  next.v_error = v_error != NULL ? v_error[last] : INFINITY;
  next.periods += periods;
  *r = next;
  return status;
}

pendres_status pendres_recording_advance(pendres_context *ctx, pendres_recording *recording,
                                         long periods, const pendres_record *out)
{
  const int valid = recording != NULL && !too_many(recording, periods);
  const size_t points = valid ? (size_t)periods * (size_t)recording->samples + 1 : 0;
  pendres_door d = pendres_door_open(ctx, recording != NULL ? &recording->pendulum : NULL);
  PENDRES_DOOR_OUT(&d, recording, 1, recording);
  if (out != NULL) pendres_door_out_record(&d, points, out);
  return PENDRES_DOOR_END(&d, go_on(ctx, recording, periods, out));
}

static pendres_status whole_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                   const pendres_state *start, long periods, int samples,
                                   const pendres_record *out)
{
  pendres_recording r;
  const pendres_status status =
    pendres_recording_begin(ctx, pendulum, start, periods, samples, &r);
  return status == PENDRES_OK ? pendres_recording_advance(ctx, &r, periods, out) : status;
}

pendres_status pendres_strobe_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                     const pendres_state *start, long periods, int samples,
                                     const pendres_record *out)
{
  return PENDRES_CONTEXT_CALL(ctx, whole_record(ctx, pendulum, start, periods, samples, out));
}
