/* boundary_saddle.c -- the unstable orbit behind the fold of a branch; see boundary.h. */
#include <pendres/boundary.h>

#include <math.h>

#include "engine/context_internal.h"
#include "engine/door.h"
#include "model/model.h"
#include "orbits/orbit_newton.h"
#include "continuation/curve/follow.h"
#include "continuation/numbers.h"

static double frequency_of(const pendres_curve_node *node)
{
  return node->u[PENDRES_U_OMEGA];
}

/* What the branch of an attractor is followed for. */
typedef struct way_back {
  const pendres_orbit *attractor;
  pendres_orbit *out;
} way_back;

/* Refine the orbit of a branch that has come back to the attractor's drive frequency. */
static pendres_status refine(pendres_context *ctx, const pendres_followed *kind,
                             const pendres_curve_node nodes[2], const pendres_u u, void *arg)
{
  const way_back *back = arg;
  const pendres_orbit *attractor = back->attractor;
  pendres_orbit *out = back->out;
  (void)kind;
  (void)nodes;
  const pendres_orbit_guess guess = {.pendulum = attractor->pendulum,
                                     .x = u[PENDRES_U_Y] +
                                          pendres_model_origin(&attractor->pendulum),
                                     .v = u[PENDRES_U_W] * attractor->pendulum.drive_frequency,
                                     .period = attractor->period,
                                     .winding = attractor->winding};
  pendres_status outcome = PENDRES_OK;
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, out, &outcome);
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
  /* The spring softens: a small orbit has its fold at a higher frequency, a large one at a
     lower. */
  const double up = attractor->phase_lag < 1.0 ? 1.0 : -1.0;
  static const pendres_goal goal = {
    .start = "orbit", .value = frequency_of, .comes_back = 1, .locate = refine};
  const pendres_parameter along = PENDRES_DRIVE_FREQUENCY;
  way_back back = {.attractor = attractor, .out = out};
  pendres_u u;
  const pendres_followed kind =
    pendres_followed_of(attractor, PENDRES_CONDITION_NONE, &along, pendres_search_spacing, u);
  const pendres_status status = pendres_follow_search(ctx, &kind, u, &goal, up, &back);
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status,
                                "the branch of the orbit does not come back to drive frequency %g",
                                attractor->pendulum.drive_frequency);
  return status;
}

pendres_status pendres_saddle_find(pendres_context *ctx, const pendres_orbit *attractor,
                                   pendres_orbit *out)
{
  pendres_door d = pendres_door_open(ctx, attractor != NULL ? &attractor->pendulum : NULL);
  PENDRES_DOOR_IN(&d, orbit, 1, attractor);
  PENDRES_DOOR_OUT(&d, orbit, 1, out);
  return PENDRES_DOOR_END(&d, saddle_find(ctx, attractor, out));
}
