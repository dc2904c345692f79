/* boundary_saddle.c -- the unstable orbit behind the fold of a branch; see boundary.h. */
#include <pendres/boundary.h>

#include <math.h>
#include <string.h>

#include "engine/context_internal.h"
#include "engine/door.h"
#include "model/model.h"
#include "orbits/orbit_newton.h"
#include "continuation/arc.h"

enum { MOST_ADVANCES = 300 };
static const double widest_range = 3.0; /* of the drive frequency, as a ratio */
/* A branch is followed until errors grow by this in a map: it does not come back from there. */
static const double wildest = 1e3;

/* Go along it until the drive frequency is back where it was; *u is near the orbit there. */
static pendres_status follow_back(pendres_context *ctx, pendres_arc *w, double u[PENDRES_U_COUNT])
{
  const double start = w->here.u[PENDRES_U_OMEGA];
  pendres_arc_point last = w->here;
  for (int i = 0; i < MOST_ADVANCES; i++) {
    const pendres_status status = pendres_arc_advance(ctx, 1, w);
    if (status != PENDRES_OK) return status;
    if (w->stuck) return PENDRES_NOT_FOUND;
    for (int k = 0; k < w->found; k++) {
      const pendres_arc_point *p = &w->ahead[k];
      const double before = last.u[PENDRES_U_OMEGA] - start, now = p->u[PENDRES_U_OMEGA] - start;
      if (before * now < 0.0) {
        const double part = before / (before - now);
        for (int m = 0; m < PENDRES_U_COUNT; m++)
          u[m] = last.u[m] + part * (p->u[m] - last.u[m]);
        u[PENDRES_U_OMEGA] = start;
        return PENDRES_OK;
      }
      last = *p;
    }
    const double omega = w->here.u[PENDRES_U_OMEGA];
    if (omega > widest_range * start || omega * widest_range < start) break;
    if (w->here.growth > wildest) break;
  }
  return PENDRES_NOT_FOUND;
}

/* Refine the orbit that an arc has come back to. */
static pendres_status refine(pendres_context *ctx, const pendres_orbit *attractor,
                             const double u[PENDRES_U_COUNT], pendres_orbit *out)
{
  const pendres_orbit_guess guess = {.pendulum = attractor->pendulum,
                                     .x = u[PENDRES_U_Y] +
                                          pendres_model_origin(&attractor->pendulum),
                                     .v = u[PENDRES_U_W] * attractor->pendulum.drive_frequency,
                                     .period = attractor->period,
                                     .winding = attractor->winding};
  pendres_status outcome = PENDRES_OK;
  const pendres_status status =
    pendres_orbit_refine(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, out, &outcome);
  if (status != PENDRES_OK) return status;
  if (outcome == PENDRES_NOT_CONVERGED || out->stable) return PENDRES_NOT_FOUND;
  if (outcome != PENDRES_OK)
    return pendres_context_fail(ctx, outcome,
                                "the orbit between two attractors is known to %.1e only",
                                fmax(out->x_error, out->v_error));
  return PENDRES_OK;
}

static pendres_status saddle_find(pendres_context *ctx, const pendres_orbit *attractor,
                                  pendres_orbit *out)
{
  if (attractor == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "attractor and out");
  const char *no_orbit = pendres_orbit_refuses(attractor);
  if (no_orbit != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "saddle: %s", no_orbit);
  pendres_status status = PENDRES_NOT_FOUND;
  /* The spring softens: a small orbit has its fold at a higher frequency, a large one at a
     lower. */
  for (int i = 0; i < 2 && status == PENDRES_NOT_FOUND; i++) {
    const double up = attractor->phase_lag < 1.0 ? 1.0 : -1.0;
    double u[PENDRES_U_COUNT];
    const pendres_parameter along = PENDRES_DRIVE_FREQUENCY;
    pendres_arc arc = pendres_arc_of(attractor, PENDRES_CONDITION_NONE, &along, 0.1, u);
    status = pendres_arc_begin(ctx, &arc, u, i == 0 ? up : -up);
    if (status == PENDRES_OK) status = follow_back(ctx, &arc, u);
    if (status == PENDRES_OK) status = refine(ctx, attractor, u, out);
    if (status == PENDRES_NOT_CONVERGED)
      return pendres_context_fail(ctx, status, "no orbit to start from at drive frequency %g",
                                  attractor->pendulum.drive_frequency);
  }
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status,
                                "the branch of the orbit does not come back to drive frequency %g",
                                attractor->pendulum.drive_frequency);
  return status;
}

pendres_status pendres_saddle_find(pendres_context *ctx, const pendres_orbit *attractor,
                                   pendres_orbit *out)
{
  pendres_door d;
  pendres_door_open(&d, ctx, attractor != NULL ? &attractor->pendulum : NULL);
  const pendres_orbit *from = pendres_door_in(&d, &pendres_dim_orbit, 1, attractor);
  pendres_orbit *to = pendres_door_out(&d, &pendres_dim_orbit, 1, out);
  PENDRES_DOOR_CALL(&d, saddle_find(ctx, from, to));
  return pendres_door_close(&d);
}
