/* cascade.c -- doublings of a period, one after another; see cascade.h. */
#include "analysis/sweeps/cascade.h"

#include <limits.h>
#include <math.h>

#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/keep.h"
#include "model/parameter.h"
#include "orbits/orbit_newton.h"
#include "analysis/sweeps/stable_part.h"

/* Feigenbaum's first constant. */
static const double feigenbaum = 4.66920160910299067;

enum { MOST_FORKS = PENDRES_CASCADE_DOUBLINGS + 4 };

/* The limit of the doublings, extrapolated from those up to this one. */
static double extrapolate(const pendres_cascade *c, int last)
{
  return c->value[last] + (c->value[last] - c->value[last - 1]) / (feigenbaum - 1.0);
}

static double ratio_at(const pendres_cascade *c, int last)
{
  return (c->value[last - 1] - c->value[last - 2]) / (c->value[last] - c->value[last - 1]);
}

/*
 * The limit and the ratio converge by Feigenbaum's factor or more from one doubling to the next.
 * The latest change is therefore larger than the error that is left; the errors of the doublings
 * are added.
 */
static void finish(pendres_cascade *c)
{
  const int last = c->doublings - 1;
  c->limit = c->limit_error = c->ratio = c->ratio_error = NAN;
  if (c->doublings < 3) return;
  double off = 0.0;
  for (int i = last - 2; i <= last; i++) off = fmax(off, c->value_error[i]);
  c->limit = extrapolate(c, last);
  c->limit_error = fabs(c->limit - extrapolate(c, last - 1)) + 2.0 * off;
  if (c->doublings < 4) return;
  c->ratio = ratio_at(c, last);
  c->ratio_error = fabs(c->ratio - ratio_at(c, last - 1)) +
                   4.0 * c->ratio * off / fabs(c->value[last] - c->value[last - 1]);
}

static void note(const pendres_bifurcation *b, pendres_cascade *c)
{
  c->period[c->doublings] = b->orbit.period;
  c->x[c->doublings] = b->orbit.x;
  c->v[c->doublings] = b->orbit.v;
  c->value[c->doublings] = b->value;
  c->value_error[c->doublings++] = b->value_error;
}

/* The orbit half way between the last two doublings, on the part between them. */
static pendres_status orbit_before(pendres_context *ctx, const pendres_part *s,
                                   const pendres_cascade *c, pendres_orbit *last)
{
  const int n = c->doublings;
  int found = 0;
  if (n < 2) return PENDRES_OK;
  const double middle = 0.5 * (c->value[n - 2] + c->value[n - 1]);
  const pendres_status status = pendres_part_orbits(ctx, s, 1, &middle, last, &found);
  if (!found) last->period = 0;
  return status;
}

/* Where a cascade is: at the fork from which it goes on. */
typedef struct place {
  int32_t fork, unused;
  pendres_bifurcation end;
} place;

/* As keep.h has it; what is asked for is an orbit's cascade towards a limit. */
static pendres_keeping keep_begin(pendres_context *ctx, const pendres_cascade_way *way)
{
  pendres_bytes question = {.reads = 0};
  double q[5 + PENDRES_PARAMETER_FOLLOWED] = {
    way->limit, way->longest, way->orbit->x, way->orbit->v, way->parameter};
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++)
    q[5 + k] = pendres_parameter_get((pendres_parameter)k, &way->orbit->pendulum);
  pendres_bytes_pass(&question, 1, sizeof q, q);
  return pendres_keeping_begin(ctx, "cascade", question);
}

/* Each doubling costs twice as much as the one before. */
static void keep_state(pendres_keeping *keep, pendres_cascade *c, place *at)
{
  if (!pendres_keeping_due(keep, ldexp(1.0, c->doublings - PENDRES_CASCADE_DOUBLINGS))) return;
  pendres_bytes *b = pendres_keeping_write(keep);
  pendres_bytes_pass(b, 1, sizeof *c, c);
  pendres_bytes_pass(b, 1, sizeof *at, at);
  pendres_keeping_put(keep);
}

/* From the fork of an earlier process on; at->fork 0: there is none. */
static void keep_read(pendres_keeping *keep, const pendres_cascade_way *way, pendres_cascade *c,
                      place *at)
{
  const pendres_cascade none = *c;
  *at = (place){.fork = 0};
  if (!pendres_keeping_found(keep)) return;
  pendres_bytes_pass(&keep->state, 1, sizeof *c, c);
  pendres_bytes_pass(&keep->state, 1, sizeof *at, at);
  const pendres_bifurcation *b = &at->end;
  if (pendres_bytes_end(&keep->state) && at->fork > 0 && at->fork < MOST_FORKS &&
      c->doublings >= 0 && c->doublings < PENDRES_CASCADE_DOUBLINGS &&
      b->parameter == way->parameter && (unsigned)b->kind < PENDRES_SPECIAL_COUNT &&
      pendres_orbit_refuses(&b->orbit) == NULL &&
      b->orbit.pendulum.force == way->orbit->pendulum.force) {
    pendres_keeping_taken(keep);
    return;
  }
  *c = none;
  *at = (place){.fork = 0};
}

pendres_status pendres_cascade_follow(pendres_context *ctx, const pendres_cascade_way *way,
                                      pendres_cascade *out, pendres_orbit *last)
{
  pendres_part s = pendres_part_none;
  pendres_keeping keep = keep_begin(ctx, way);
  place at;
  *out = (pendres_cascade){.doublings = 0};
  if (last != NULL) last->period = 0;
  keep_read(&keep, way, out, &at);
  pendres_status status =
    at.fork > 0 ? pendres_part_born(ctx, &at.end, way->limit, &s)
                : pendres_part_from(ctx, way->orbit, way->parameter, way->limit, &s);
  for (int fork = at.fork; fork < MOST_FORKS && status == PENDRES_OK; fork++) {
    const pendres_bifurcation end = s.bifurcation;
    const int doubles = end.kind == PENDRES_PERIOD_DOUBLING;
    if (s.end != PENDRES_PART_BIFURCATION || end.kind == PENDRES_FOLD) break;
    if (doubles) note(&end, out);
    if (out->doublings == PENDRES_CASCADE_DOUBLINGS ||
        (doubles && end.orbit.period > way->longest / 2)) {
      if (last != NULL) status = orbit_before(ctx, &s, out, last);
      break;
    }
    pendres_part_free(&s);
    at = (place){.fork = fork + 1, .end = end};
    keep_state(&keep, out, &at);
    status = pendres_part_born(ctx, &end, way->limit, &s);
  }
  pendres_keeping_end(&keep);
  pendres_part_free(&s);
  finish(out);
  return status == PENDRES_NOT_FOUND ? PENDRES_OK : status;
}

static pendres_status cascade_find(pendres_context *ctx, const pendres_orbit *orbit,
                                   pendres_parameter parameter, double limit, pendres_cascade *out)
{
  const char *why = NULL;
  if (orbit == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "orbit and out");
  *out = (pendres_cascade){.doublings = 0};
  finish(out);
  why = pendres_orbit_refuses(orbit);
  if (why == NULL) why = pendres_parameter_refuses(parameter, orbit->pendulum.force);
  if (why == NULL && !orbit->stable) why = "the orbit must be stable";
  if (why == NULL && !isfinite(limit)) why = "the limit must be finite";
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "cascade: %s", why);
  const pendres_cascade_way way = {orbit, parameter, limit, INT_MAX};
  const pendres_status status = pendres_cascade_follow(ctx, &way, out, NULL);
  if (status == PENDRES_OK && out->doublings == 0)
    return pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                                "the orbit does not double its period in the range");
  return status;
}

pendres_status pendres_cascade_find(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double limit,
                                    pendres_cascade *out)
{
  pendres_door d = pendres_door_open(ctx, orbit != NULL ? &orbit->pendulum : NULL);
  pendres_door_move(&d, parameter, parameter);
  PENDRES_DOOR_IN(&d, orbit, 1, orbit);
  PENDRES_DOOR_OUT(&d, cascade, 1, out);
  return PENDRES_DOOR_END(&d, cascade_find(ctx, orbit, parameter, limit / d.scales.first, out));
}
