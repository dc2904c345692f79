/*
 * backbone.c -- where the response lags a quarter of a turn; see continuation.h.
 *
 * The orbits of pendulums that differ in the damping alone form a curve in drive frequency and
 * damping. Where the damping is strong enough they are small oscillations about a well, which are
 * known; from there the curve is followed to stronger and to weaker damping. Where it turns back
 * the drive puts in more than friction can take out, whatever the amplitude.
 */
#include <pendres/continuation.h>

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "continuation/curve/curve.h"
#include "continuation/numbers.h"
#include "continuation/units.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "model/model.h"
#include "orbits/orbit_table.h"
#include "orbits/free_force.h"
#include "orbits/numbers.h"

/* ---- small oscillations ---- */

/* The damping at which the drive meets friction in a harmonic oscillation of this amplitude; NaN
   where the force has no stiffness. */
static double damping_at(const pendres_pendulum *p, double well, double amplitude)
{
  return p->drive_amplitude / (amplitude * sqrt(pendres_free_stiffness(p, well, amplitude)));
}

/* Whether an oscillation loses less than all of its energy in a radian. */
static int swings(const pendres_pendulum *p, double well, double a)
{
  return damping_at(p, well, a) < sqrt(pendres_free_stiffness(p, well, a));
}

/* The amplitude to begin at, near where oscillations cease to be overdamped: it depends on the line
   alone, and so does the curve, whichever dampings are asked for. */
static double start_amplitude(const pendres_pendulum *p, double well)
{
  double a = backbone_first;
  while (pendres_free_stiffness(p, well, 2.0 * a) >= pendres_free_stiffness(p, well, a) &&
         !swings(p, well, 2.0 * a) && isfinite(2.0 * a))
    a *= 2.0;
  while (swings(p, well, a)) a *= 0.5;
  return a;
}

/* An oscillation y = well + amplitude sin(theta) as an orbit. */
static pendres_orbit oscillation(const pendres_pendulum *p, double well, double amplitude)
{
  pendres_orbit o = pendres_orbit_none(p);
  o.x = well + pendres_model_origin(p);
  o.v = amplitude * p->drive_frequency;
  o.period = 1;
  o.winding = 0;
  o.mean_angle = well;
  o.symmetric = pendres_pendulum_symmetric(p) &&
                fabs(pendres_model_centre(p, well) - well) < well_near;
  return o;
}

/* Begin the curve of a pendulum's orbits, towards weaker damping and towards stronger.
   PENDRES_NOT_FOUND: there is none. */
static pendres_status begin(pendres_context *ctx, const pendres_pendulum *of, pendres_follower w[2])
{
  static const pendres_parameter along[] = {PENDRES_DRIVE_FREQUENCY, PENDRES_DAMPING};
  pendres_pendulum p = *of;
  double well;
  if (!pendres_free_well(&p, &well)) return PENDRES_NOT_FOUND;
  double a = start_amplitude(&p, well);
  for (int i = 0; i < BACKBONE_STARTS && a > 0.0; i++, a *= 0.5) {
    pendres_u u;
    p.damping = damping_at(&p, well, a);
    if (!isfinite(p.damping)) continue;
    p.drive_frequency = p.drive_amplitude / (a * p.damping);
    const pendres_orbit o = oscillation(&p, well, a);
    const pendres_followed kind =
      pendres_followed_of(&o, PENDRES_CONDITION_LAG, along, pendres_search_spacing, u);
    pendres_status status = pendres_follow_begin(ctx, &kind, u, -1.0, &w[0]);
    if (status == PENDRES_OK) status = pendres_follow_begin(ctx, &kind, u, 1.0, &w[1]);
    if (status != PENDRES_OK && status != PENDRES_NOT_CONVERGED) return status;
    const double *at = w[0].here.u;
    if (status == PENDRES_OK && hypot(at[PENDRES_U_Y] - well, at[PENDRES_U_W] - a) < a)
      return status;
  }
  return PENDRES_NOT_FOUND;
}

/* ---- along the curve ---- */

/* Pendulums that differ in the damping alone, from the strongest down. */
typedef struct line {
  size_t n;
  const pendres_pendulum *first;
  size_t *index;            /* [n] of the caller's */
  double *damping;          /* [n] */
  pendres_curve_node *node; /* [n] */
  int *on;                  /* [n] whether the node lies on the curve */
  size_t found;             /* of the nodes, the first, once they are corrected */
} line;

/* Find the point of the curve with a damping between two nodes, which may turn back on the way: on
   the parabola with the first one's tangent through the second. 0: there is none. */
static int between(const pendres_system *s, const pendres_curve_node *a,
                   const pendres_curve_node *b, int forth, double damping,
                   pendres_curve_node *out)
{
  const int last = s->unknowns - 1;
  const double h = b->arclength - a->arclength, away = damping - a->u[PENDRES_U_GAMMA];
  double slope[PENDRES_UNKNOWNS], bend[PENDRES_UNKNOWNS];
  for (int k = 0; k < s->unknowns; k++) {
    const int i = s->unknown[k];
    slope[k] = a->tangent[k] * pendres_arc_scale(&s->map, i, a->u);
    bend[k] = (b->u[i] - a->u[i] - slope[k] * h) / (h * h);
  }
  const double square = slope[last] * slope[last] + 4.0 * bend[last] * away;
  double way = 2.0 * away / (slope[last] + forth * sqrt(square));
  if (forth * (b->u[PENDRES_U_GAMMA] - damping) >= 0.0) way = fmin(way, h); /* but for rounding */
  if (!(square >= 0.0 && way >= 0.0 && way <= h)) return 0;
  *out = *a;
  for (int k = 0; k < s->unknowns; k++)
    out->u[s->unknown[k]] += way * (slope[k] + way * bend[k]);
  out->u[PENDRES_U_GAMMA] = damping;
  memset(out->tangent, 0, sizeof out->tangent);
  out->tangent[last] = 1.0;
  out->held = last + 1;
  return 1;
}

/* Follow the curve as long as the damping grows (way: 1) or falls (-1), and take the points of the
   line on it, from number `next` on, one after another in that direction. */
static pendres_status follow(pendres_context *ctx, pendres_follower *w, int way, size_t next,
                             line *l)
{
  pendres_curve_node last = w->here;
  for (int i = 0; i < PENDRES_SEARCH_ADVANCES && !w->stuck &&
                  w->here.growth < pendres_curve_wildest; i++) {
    if (next >= l->n) return PENDRES_OK;
    const pendres_status status = pendres_follow_advance(ctx, 1, &w);
    if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
    for (int k = 0; k < w->found; k++, last = w->ahead[k - 1]) {
      const pendres_curve_node *to = &w->ahead[k];
      while (next < l->n && between(&w->kind.system, &last, to, way, l->damping[next],
                                    &l->node[next])) {
        l->on[next] = 1;
        next -= (size_t)way; /* below 0 is beyond n */
      }
      if (next >= l->n || !(way * (to->u[PENDRES_U_GAMMA] - last.u[PENDRES_U_GAMMA]) > 0.0))
        return PENDRES_OK;
    }
  }
  return PENDRES_OK;
}

/* Correct the nodes of a line at their dampings, and leave out those where that leads elsewhere. */
static pendres_status correct(pendres_context *ctx, const pendres_followed *kind, line *l)
{
  size_t kept = 0;
  for (size_t k = 0; k < l->n; k++) {
    if (!l->on[k]) continue;
    l->node[kept] = l->node[k];
    l->damping[kept] = l->damping[k];
    l->index[kept++] = l->index[k];
  }
  l->found = kept;
  kept = 0;
  pendres_room room = pendres_room_open(ctx, "points of a backbone");
  pendres_correction *c = pendres_room_take(&room, l->found, sizeof *c);
  pendres_status status = room.status;
  for (size_t k = 0; k < l->found && status == PENDRES_OK; k++) {
    c[k].kind = kind;
    memcpy(c[k].u, l->node[k].u, sizeof c[k].u);
    memcpy(c[k].tangent, l->node[k].tangent, sizeof c[k].tangent);
    status =
      pendres_map_steps(ctx, kind->system.map.force, c[k].u, kind->tolerance, &c[k].steps);
  }
  if (status == PENDRES_OK) status = pendres_follow_correct(ctx, l->found, c);
  for (size_t k = 0; k < l->found && status == PENDRES_OK; k++) {
    if (isnan(pendres_correction_rounding(&c[k])) ||
        !(pendres_arc_distance(&kind->system.map, c[k].u, l->node[k].u) < kind->spacing))
      continue;
    l->node[kept] = l->node[k];
    memcpy(l->node[kept].u, c[k].u, sizeof c[k].u);
    l->node[kept].u[PENDRES_U_GAMMA] = l->damping[k];
    l->index[kept++] = l->index[k];
  }
  l->found = kept;
  return pendres_room_close(&room, status);
}

/* Where the caller wants results. */
typedef struct results {
  pendres_orbit *orbit;
  double *error; /* may be NULL */
  pendres_status *outcome;
} results;

/* Make the nodes of a line as exact as is asked for, and measure their orbits. */
static pendres_status measure(pendres_context *ctx, const pendres_followed *kind, const line *l,
                              const results *out)
{
  const size_t n = l->found;
  pendres_curve c = {.kind = *kind, .nodes = n, .node = l->node};
  pendres_room room = pendres_room_open(ctx, "points of a backbone");
  c.pair = pendres_room_take(&room, n, sizeof *c.pair);
  c.orbit = pendres_room_take(&room, n, sizeof *c.orbit);
  c.error = pendres_room_take(&room, n, sizeof *c.error);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = pendres_curve_polish(ctx, &c, n, NULL);
  if (status == PENDRES_OK) status = pendres_solution_measure(ctx, n, c.pair, c.orbit);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const size_t i = l->index[k];
    out->orbit[i] = c.orbit[k];
    if (out->error != NULL) out->error[i] = c.error[k][0];
    out->outcome[i] =
      c.error[k][0] <= ctx->options.tolerance ? PENDRES_OK : PENDRES_TOLERANCE_UNREACHABLE;
  }
  return pendres_room_close(&room, status);
}

static pendres_status find_line(pendres_context *ctx, line *l, const results *out)
{
  pendres_follower w[2];
  pendres_status status = begin(ctx, l->first, w);
  if (status != PENDRES_OK) return status == PENDRES_NOT_FOUND ? PENDRES_OK : status;
  size_t weaker = 0;
  while (weaker < l->n && l->damping[weaker] > w[0].here.u[PENDRES_U_GAMMA]) weaker++;
  status = follow(ctx, &w[0], -1, weaker, l);
  if (status == PENDRES_OK) status = follow(ctx, &w[1], 1, weaker - 1, l);
  if (status == PENDRES_OK) status = correct(ctx, &w[0].kind, l);
  return status == PENDRES_OK ? measure(ctx, &w[0].kind, l, out) : status;
}

/* ---- several pendulums ---- */

static int same_line(const pendres_pendulum *a, pendres_pendulum b)
{
  b.damping = a->damping;
  b.drive_frequency = a->drive_frequency;
  return pendres_model_same(a, &b);
}

/* Take the pendulums of the first one's line that have no outcome yet, the strongest damping
   first. */
static void take_line(size_t n, const pendres_pendulum *p, size_t first,
                      const pendres_status *outcome, line *l)
{
  l->n = l->found = 0;
  l->first = &p[first];
  for (size_t i = first; i < n; i++) {
    if (outcome[i] != PENDRES_STATUS_COUNT || !same_line(l->first, p[i])) continue;
    size_t k = l->n++;
    for (; k > 0 && l->damping[k - 1] < p[i].damping; k--) {
      l->damping[k] = l->damping[k - 1];
      l->index[k] = l->index[k - 1];
    }
    l->damping[k] = p[i].damping;
    l->index[k] = i;
    l->on[l->n - 1] = 0;
  }
}

static const char *refuses(const pendres_pendulum *pendulum)
{
  pendres_pendulum p = *pendulum;
  const char *why = NULL;
  p.drive_frequency = 1.0;
  if (pendres_pendulum_check(&p, &why) != PENDRES_OK) return why;
  why = pendres_coordinates_refuses(&p, 0.0, 0.0);
  if (why != NULL) return why;
  return p.damping > 0.0 && p.drive_amplitude > 0.0 ? NULL : "a backbone needs damping and drive";
}

static pendres_status backbone_find(pendres_context *ctx, size_t n,
                                    const pendres_pendulum *pendulums, const results *out)
{
  if (n > 0 && (pendulums == NULL || out->orbit == NULL || out->outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, out and outcome");
  for (size_t i = 0; i < n; i++) {
    const char *why = refuses(&pendulums[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  pendres_room room = pendres_room_open(ctx, "orbits");
  line l = {.index = pendres_room_take(&room, n, sizeof *l.index),
            .damping = pendres_room_take(&room, n, sizeof *l.damping),
            .node = pendres_room_take(&room, n, sizeof *l.node),
            .on = pendres_room_take(&room, n, sizeof *l.on)};
  pendres_status status = room.status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    out->outcome[i] = PENDRES_STATUS_COUNT; /* none yet */
    out->orbit[i] = pendres_orbit_none(&pendulums[i]);
    if (out->error != NULL) out->error[i] = NAN;
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (out->outcome[i] != PENDRES_STATUS_COUNT) continue;
    take_line(n, pendulums, i, out->outcome, &l);
    for (size_t k = 0; k < l.n; k++) out->outcome[l.index[k]] = PENDRES_NOT_FOUND;
    status = find_line(ctx, &l, out);
  }
  return pendres_room_close(&room, status);
}

pendres_status pendres_backbone_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, pendres_orbit *out,
                                     double *frequency_error, pendres_status *outcome)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    const results inside = {
      .orbit = pendres_door_out_run(&d, &pendres_dim_orbit, out),
      .error = pendres_door_out_run(&d, &pendres_dim_frequency, frequency_error),
      .outcome = PENDRES_DOOR_AT(outcome, d.first)};
    PENDRES_DOOR_CALL(&d, backbone_find(ctx, d.count, p, &inside));
  }
  return pendres_door_close(&d);
}
