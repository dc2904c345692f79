/*
 * kink.c -- frequencies at which a state loses its mirror symmetry; see
 * refine.h.
 *
 * The mean area is continuous there, but its slope jumps, and settling slows down without bound:
 * halving would be slowest, and least exact, close to the kink. The bifurcation itself is therefore
 * located.
 */
#include "analysis/resonance/refine.h"

#include <math.h>

#include <pendres/continuation.h>

#include "model/model.h"
#include "orbits/orbit_same.h"
#include "analysis/resonance/response_parts.h"
#include "continuation/sets.h"

/* Whether orbit b may branch off from a by a loss of symmetry. */
static int branches_off(const pendres_orbit *a, const pendres_orbit *b)
{
  return isfinite(a->x) && isfinite(b->x) && a->symmetric && !b->symmetric &&
         b->period == a->period && b->winding == a->winding;
}

/* The first such bifurcation of an orbit's branch within a range, as seen from the orbit. *found: 0
   if there is none. */
static pendres_status locate(pendres_context *ctx, const pendres_orbit *o, const double range[2],
                             pendres_bifurcation *out, int *found)
{
  const pendres_branch_options along = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = range[0], .high = range[1]};
  pendres_branch *branch = NULL;
  *found = 0;
  const pendres_status status = pendres_branch_follow(ctx, o, &along, &branch);
  for (size_t i = 0; i < pendres_branch_bifurcation_count(branch); i++) {
    const pendres_bifurcation *b = pendres_branch_bifurcation_get(branch, i);
    const double from = o->pendulum.drive_frequency;
    if (b->kind != PENDRES_SYMMETRY_BREAKING || !(b->value > range[0] && b->value < range[1]))
      continue;
    if (*found && !(fabs(b->value - from) < fabs(out->value - from))) continue;
    *out = *b;
    *found = 1;
  }
  pendres_branch_free(branch);
  /* A branch that cannot be followed gives no information. */
  return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
}

/* How far a state's Poincaré point is from the bifurcation's. */
static double distance(const pendres_orbit *o, const pendres_bifurcation *b)
{
  return pendres_model_distance(&o->pendulum, o->x - b->orbit.x, o->v - b->orbit.v);
}

/*
 * A point's states at the bifurcation. state: the one that bifurcates, or one of those that branch
 * off; its mirror image serves equally.
 */
static pendres_status move_to(pendres_context *ctx, const pendres_scan_point *from,
                              const pendres_orbit *state, const pendres_bifurcation *b,
                              pendres_scan_point *to)
{
  const pendres_status status = pendres_scan_follow(ctx, from, b->value, NULL, to);
  if (status != PENDRES_OK) return status;
  for (size_t j = 0; j < to->response.states; j++) {
    const pendres_orbit *o = &from->response.state[j].orbit;
    if (o == state || pendres_orbit_are_images(o, state))
      to->response.state[j].orbit = b->orbit;
  }
  to->fold = NAN;
  to->fold_error = b->value_error;
  return pendres_response_renew(ctx, &to->response);
}

/* Look for a state of one point that bifurcates towards one of the other. */
static pendres_status find_from(pendres_context *ctx, const pendres_scan_point *const end[2],
                                int regular, pendres_scan_border *out)
{
  const pendres_response *here = &end[regular]->response, *there = &end[1 - regular]->response;
  const double range[2] = {pendres_scan_frequency(end[0]),
                           pendres_scan_frequency(end[1])};
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < here->states && out->points == 0 && status == PENDRES_OK; i++) {
    const pendres_orbit *o = &here->state[i].orbit, *off = NULL, *of[2];
    pendres_bifurcation b = {.value = NAN};
    int bifurcates = 0;
    for (size_t j = 0; j < there->states; j++)
      bifurcates |= branches_off(o, &there->state[j].orbit);
    if (!bifurcates) continue;
    status = locate(ctx, o, range, &b, &bifurcates);
    if (status != PENDRES_OK || !bifurcates) continue;
    for (size_t j = 0; j < there->states; j++) {
      const pendres_orbit *p = &there->state[j].orbit;
      if (branches_off(o, p) && (off == NULL || distance(p, &b) < distance(off, &b))) off = p;
    }
    of[regular] = o;
    of[1 - regular] = off;
    for (int e = 0; e < 2 && status == PENDRES_OK; e++) {
      status = move_to(ctx, end[e], of[e], &b, &out->at[e]);
      out->at[e].at_fold = e == 0 ? 1 : -1;
    }
    out->points = status == PENDRES_OK ? 2 : 0;
  }
  return status;
}

pendres_status pendres_resonance_find_kink(pendres_context *ctx, const pendres_scan_point *a,
                                           const pendres_scan_point *b, pendres_scan_border *out)
{
  const pendres_scan_point *const end[2] = {a, b};
  out->points = 0;
  const pendres_status status = find_from(ctx, end, 0, out);
  return status != PENDRES_OK || out->points > 0 ? status : find_from(ctx, end, 1, out);
}
