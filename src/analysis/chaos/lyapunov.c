/* lyapunov.c -- largest Lyapunov exponents of many pendulums; see lyapunov.h. */
#include <pendres/lyapunov.h>

#include <limits.h>
#include <stdlib.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/coordinates.h"
#include "orbits/attractor_set.h"
#include "analysis/chaos/lyapunov_certain.h"
#include "analysis/chaos/lyapunov_move.h"
#include "base/sized.h"

enum {
  PERIODS = 512,     /* of a first average, unless the caller says so */
  LONGER = 1536,     /* by which what may be chaos is followed before */
  ROUNDS = 6,        /* of averages, each twice as long as the one before: next to the end of a lock
                        a rotation slips once in thousands of periods */
  FEW_PERIODS = 256  /* of the first average of what is known to be close to a rotation */
};

static const char *refuses(const pendres_pendulum *p, double x, double v)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK) return why;
  if (p->damping == 0.0) return "without damping nothing settles";
  return pendres_coordinates_refuses(p, x, v);
}

pendres_status pendres_lyapunov_move(pendres_context *ctx, const pendres_lyapunov_motion *m,
                                     pendres_lyapunov_care care)
{
  static const struct { long periods; int rounds; } looks[] = {
    [PENDRES_CARE_FULL] = {PERIODS, ROUNDS}, [PENDRES_CARE_LABEL] = {PERIODS, ROUNDS},
    [PENDRES_CARE_ONCE] = {PERIODS, 1},
    [PENDRES_CARE_CLOSE] = {FEW_PERIODS, ROUNDS + 1}};
  const size_t n = m->n;
  const pendres_lyapunov_job j = {
    .n = n, .pendulum = m->pendulum, .x = m->x, .v = m->v, .out = m->out, .orbit = m->orbit,
    .accuracy = pendres_accuracy_to_average(ctx), .care = care, .periods = looks[care].periods,
    .rounds = looks[care].rounds, .longer = care <= PENDRES_CARE_LABEL ? LONGER : 0,
    .runner = malloc((n + 1) * sizeof *j.runner)};
  if (j.runner == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  for (size_t i = 0; i < n; i++) m->orbit[i] = pendres_orbit_none(&m->pendulum[i]);
  const pendres_status status = pendres_lyapunov_judge(ctx, &j);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&j.runner[i].lane, &m->x[i], &m->v[i]);
  free(j.runner);
  return status;
}

static pendres_status lyapunov_find(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                    const double *x, const double *v,
                                    const pendres_lyapunov_options *options, pendres_lyapunov *out)
{
  static const pendres_lyapunov_options defaults = {0};
  const pendres_lyapunov_options *o = options != NULL ? options : &defaults;
  if (n > 0 && (p == NULL || x == NULL || v == NULL || out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x, v and out");
  if (PENDRES_SIZED_REFUSES(o) != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", PENDRES_SIZED_REFUSES(o));
  if (o->transient < 0 || o->periods < 0 || o->transient > LONG_MAX / 64 ||
      o->periods > LONG_MAX / 64)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "transient and periods are numbers of drive periods: they must not "
                                "be negative or too large");
  for (size_t i = 0; i < n; i++) {
    const char *why = refuses(&p[i], x[i], v[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  const pendres_lyapunov_job j = {
    .n = n, .pendulum = p, .x = x, .v = v, .out = out,
    .accuracy = pendres_accuracy_to_average(ctx), .transient = o->transient,
    .periods = o->periods > 0 ? o->periods : PERIODS, .asked = o->periods > 0, .rounds = ROUNDS,
    .longer = o->periods > 0 ? 0 : LONGER,
    .care = PENDRES_CARE_FULL, .runner = malloc((n + 1) * sizeof *j.runner)};
  if (j.runner == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  pendres_status status = pendres_lyapunov_judge(ctx, &j);
  if (status == PENDRES_OK) status = pendres_lyapunov_make_certain(ctx, &j);
  free(j.runner);
  return status;
}

pendres_status pendres_lyapunov_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, const double *x,
                                     const double *v, const pendres_lyapunov_options *options,
                                     pendres_lyapunov *out)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    const double *x_in = pendres_door_in_run(&d, &pendres_dim_length, x);
    const double *v_in = pendres_door_in_run(&d, &pendres_dim_speed, v);
    pendres_lyapunov *to = pendres_door_out_run(&d, &pendres_dim_lyapunov, out);
    PENDRES_DOOR_CALL(&d, lyapunov_find(ctx, d.count, p, x_in, v_in, options, to));
  }
  return pendres_door_close(&d);
}
