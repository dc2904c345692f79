/* orbit_sample.c -- points along a closed orbit, with their errors; see orbit.h. */

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/kernels/coordinates.h"
#include "engine/room.h"
#include "model/model.h"
#include "orbits/orbit_error.h"
#include "orbits/orbit_newton.h"
#include "engine/steps.h"
#include "orbits/numbers.h"
#include "orbits/orbit_series.h"

/* The Fourier series of an orbit from some number of steps a period, and its memory. */
typedef struct curve {
  pendres_orbit_series series;
  double *memory;
  double rounding; /* of y and w */
} curve;

/* Integrate the orbit once, close it, and transform it. */
static pendres_status trace(pendres_context *ctx, const pendres_orbit *o, int steps, curve *out)
{
  const pendres_orbit_guess guess = {.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                     .period = o->period, .winding = o->winding};
  const pendres_coordinates s = pendres_coordinates_in_whole(&o->pendulum, o->x, o->v);
  pendres_newton_candidate c = {.guess = &guess, .y = s.y, .w = s.w, .steps = steps};
  pendres_newton_samples taken = {0};
  pendres_orbit_tables tables = {0};
  size_t count = 0;
  double shift[2];
  pendres_status status =
    pendres_newton_pass(ctx, 1, &c, PENDRES_ORBIT_PLAIN, &taken, &count);
  if (status != PENDRES_OK) goto done;
  const size_t n = taken.count;
  double *memory = malloc((2 * n + pendres_orbit_measure_work(n)) * sizeof *memory);
  if (memory == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
    goto done;
  }
  free(out->memory);
  out->memory = memory;
  if (!pendres_newton_closed(&c, &taken, memory, memory + n, shift)) {
    status = pendres_context_fail(ctx, PENDRES_NOT_CONVERGED, "an orbit at a fold has no samples");
    goto done;
  }
  const pendres_orbit_samples samples = {.n = n, .period = o->period, .winding = o->winding,
                                         .y = memory, .w = memory + n, .tables = &tables};
  status = pendres_orbit_samples_series(&o->pendulum, &samples, memory + 2 * n, &out->series);
  if (status != PENDRES_OK)
    status = pendres_context_fail(ctx, status, "the samples of an orbit could not be transformed");
  out->rounding = pendres_newton_rounding(ctx->options.table) *
                  fmax(o->amplitude, fabs(c.w)) * pendres_newton_noise_of(&c, &taken).along;
done:
  pendres_orbit_tables_free(&tables);
  pendres_newton_samples_free(&taken);
  return status;
}

pendres_status pendres_orbit_add_harmonics(pendres_context *ctx, const pendres_orbit *orbit,
                                           double share, pendres_orbit_series *sum)
{
  curve c = {.memory = NULL};
  const size_t q = (size_t)orbit->period;
  const pendres_status status = trace(ctx, orbit, orbit->steps, &c);
  for (size_t m = 1; m < sum->modes && status == PENDRES_OK && m * q < c.series.modes; m++) {
    sum->re[m] += share * c.series.re[m * q];
    sum->im[m] += share * c.series.im[m * q];
  }
  free(c.memory);
  return status;
}

/* Position and velocity after this share of the whole orbit. */
static void point_at(const pendres_orbit *o, const curve *c, double share, double out[2])
{
  double f[3];
  const double phase = two_pi * share;
  pendres_orbit_series_at(&c->series, phase, f);
  out[0] = f[0] + pendres_model_origin(&o->pendulum) + o->winding * phase;
  out[1] = o->pendulum.drive_frequency * (f[1] + o->winding) / o->period;
}

/* By how much two curves, and their derivatives by phase, differ at most. */
static pendres_status farthest(pendres_context *ctx, const curve *coarse, const curve *fine,
                               double apart[2])
{
  const size_t n = coarse->series.samples;
  pendres_orbit_tables tables = {0};
  pendres_room room = pendres_room_open(ctx, "samples");
  double *a = pendres_room_take(&room, n, sizeof *a), *b = pendres_room_take(&room, n, sizeof *b);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  pendres_status status = PENDRES_OK;
  for (int derivative = 0; derivative < 2 && status == PENDRES_OK; derivative++) {
    apart[derivative] = 0.0;
    status = pendres_orbit_series_spread(&tables, &coarse->series, derivative, n, a);
    if (status == PENDRES_OK)
      status = pendres_orbit_series_spread(&tables, &fine->series, derivative, n, b);
    for (size_t k = 0; k < n && status == PENDRES_OK; k++)
      apart[derivative] = fmax(apart[derivative], fabs(a[k] - b[k]));
  }
  if (status != PENDRES_OK)
    status = pendres_context_fail(ctx, status, "the samples of an orbit could not be compared");
  pendres_orbit_tables_free(&tables);
  return pendres_room_close(&room, status);
}

/* The largest errors of x and of v anywhere on the finer of two curves. */
static pendres_status errors_of(pendres_context *ctx, const pendres_orbit *o, const curve *coarse,
                                const curve *fine, double error[2])
{
  double apart[2];
  const pendres_status status = farthest(ctx, coarse, fine, apart);
  if (status != PENDRES_OK) return status;
  apart[1] *= o->pendulum.drive_frequency / o->period;
  const double omega = o->pendulum.drive_frequency;
  const double tail = pendres_orbit_series_tail(&fine->series);
  const double modes = (double)fine->series.modes / o->period;
  /* Where errors fall as the order of the method says, the finer curve is off by a fourteenth of
     the difference. Half of it leaves room for two curves that agree by chance, as those of one
     orbit in a thousand do. */
  error[0] = 0.5 * apart[0] + tail + 3.0 * fine->rounding +
             0.5 * DBL_EPSILON * (fabs(o->x) + two_pi * fabs((double)o->winding));
  error[1] = 0.5 * apart[1] + omega * tail * modes + 3.0 * fmax(1.0, omega) * fine->rounding;
  return PENDRES_OK;
}

/* Why such samples cannot be taken; NULL: they can. */
static const char *refuses_samples(const pendres_orbit *orbit, int count)
{
  enum { MOST_SAMPLES = 100000000 };
  const char *why = pendres_orbit_refuses(orbit);
  if (why == NULL && (orbit->steps < 1 || orbit->steps > PENDRES_MOST_STEPS))
    why = "its number of steps must lie between 1 and 1000000, as orbits that were found have it";
  if (why == NULL && (count < 1 || count > MOST_SAMPLES / orbit->period))
    why = "there must be one a period at least, and 100 million in all at most";
  return why;
}

static pendres_status sample(pendres_context *ctx, const pendres_orbit *orbit, int count,
                             double *x, double *v, double *error)
{
  curve coarse = {.memory = NULL}, fine = {.memory = NULL};
  if (orbit == NULL) return PENDRES_CONTEXT_NULL(ctx, "orbit");
  const char *why = refuses_samples(orbit, count);
  if (why != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "samples of an orbit: %s", why);
  int steps = orbit->steps;
  pendres_status status = trace(ctx, orbit, steps, &fine);
  if (error != NULL) {
    error[0] = error[1] = INFINITY;
    for (int attempt = 0; attempt < TRIES && status == PENDRES_OK; attempt++) {
      const curve older = coarse;
      coarse = fine;
      fine = older;
      steps = pendres_steps_finer(&orbit->pendulum, steps);
      status = trace(ctx, orbit, steps, &fine);
      if (status == PENDRES_OK) status = errors_of(ctx, orbit, &coarse, &fine, error);
      if (!(fmax(error[0], error[1]) > ctx->options.tolerance)) break;
    }
  }
  const size_t points = (size_t)orbit->period * (size_t)count;
  for (size_t k = 0; k < points && status == PENDRES_OK; k++) {
    double at[2];
    point_at(orbit, &fine, (double)k / (double)points, at);
    if (x != NULL) x[k] = at[0];
    if (v != NULL) v[k] = at[1];
  }
  free(coarse.memory);
  free(fine.memory);
  return status;
}

/* Why such a stretch cannot be recorded; NULL: it can. */
static const char *refuses(const pendres_orbit_stretch *s)
{
  if (s->first < 0 || s->periods < 0) return "periods are counted from 0 on";
  const double first = (double)s->first, periods = (double)s->periods, samples = s->samples;
  /* Doubles tell so many turns and samples apart. */
  if (first * samples > pendres_farthest || periods * samples > pendres_farthest)
    return "there may be 1e15 samples at most";
  if (fabs((double)s->well) > pendres_farthest) return "the well must lie within 1e15 of 0";
  return NULL;
}

static pendres_status record(pendres_context *ctx, const pendres_orbit *orbit,
                             const pendres_orbit_stretch *stretch, const pendres_record *out)
{
  if (orbit == NULL || stretch == NULL || out == NULL || out->x == NULL || out->v == NULL ||
      (out->x_error == NULL) != (out->v_error == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "orbit, stretch, and arrays of the record");
  const char *why = refuses_samples(orbit, stretch->samples);
  if (why == NULL) why = refuses(stretch);
  if (why != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "record of an orbit: %s", why);
  const size_t count = (size_t)stretch->samples, n = count * (size_t)orbit->period;
  double *memory = malloc(4 * n * sizeof *memory);
  if (memory == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  double *x = memory, *v = x + n, *finer_x = v + n, *finer_v = finer_x + n;
  pendres_orbit finer = *orbit;
  finer.steps = (7 * orbit->steps + 4) / 5;

  pendres_status status = sample(ctx, &finer, stretch->samples, finer_x, finer_v, NULL);
  if (status == PENDRES_OK && out->x_error != NULL)
    status = sample(ctx, orbit, stretch->samples, x, v, NULL);
  const double point = 2.0 * (orbit->x_error + orbit->v_error);
  for (size_t i = 0; i < (size_t)stretch->periods * count && status == PENDRES_OK; i++) {
    const size_t k = (size_t)stretch->first * count + i, at = k % n;
    out->x[i] = finer_x[at] +
                two_pi * ((double)stretch->well + (double)orbit->winding * (double)(k / n));
    out->v[i] = finer_v[at];
    if (out->x_error == NULL) continue;
    out->x_error[i] = fabs(x[at] - finer_x[at]) + point + DBL_EPSILON * fabs(out->x[i]);
    out->v_error[i] = fabs(v[at] - finer_v[at]) + point;
  }
  free(memory);
  return status;
}

pendres_status pendres_orbit_record(pendres_context *ctx, const pendres_orbit *orbit,
                                    const pendres_orbit_stretch *stretch,
                                    const pendres_record *out)
{
  pendres_door d = pendres_door_open(ctx, orbit != NULL ? &orbit->pendulum : NULL);
  PENDRES_DOOR_IN(&d, orbit, 1, orbit);
  if (orbit != NULL && stretch != NULL && out != NULL &&
      refuses_samples(orbit, stretch->samples) == NULL && refuses(stretch) == NULL)
    pendres_door_out_record(&d, (size_t)stretch->periods * (size_t)stretch->samples, out);
  return PENDRES_DOOR_END(&d, record(ctx, orbit, stretch, out));
}

pendres_status pendres_orbit_sample(pendres_context *ctx, const pendres_orbit *orbit, int count,
                                    double *x, double *v, double error[2])
{
  const size_t points = orbit != NULL && refuses_samples(orbit, count) == NULL
                          ? (size_t)orbit->period * (size_t)count : 0;
  pendres_door d = pendres_door_open(ctx, orbit != NULL ? &orbit->pendulum : NULL);
  PENDRES_DOOR_IN(&d, orbit, 1, orbit);
  PENDRES_DOOR_OUT(&d, length, points, x);
  PENDRES_DOOR_OUT(&d, speed, points, v);
  if (error != NULL) {
    (void)pendres_door_out(&d, &pendres_dim_length, 1, &error[0]);
    (void)pendres_door_out(&d, &pendres_dim_speed, 1, &error[1]);
  }
  return PENDRES_DOOR_END(&d, sample(ctx, orbit, count, x, v, error));
}
