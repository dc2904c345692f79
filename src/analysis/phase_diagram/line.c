/* line.c -- regimes along a line, by ensemble and by branches; see phase_diagram.h. */
#include "analysis/phase_diagram/line.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "continuation/units.h"
#include "engine/door.h"
#include "model/model.h"
#include "analysis/resonance/response_parts.h"
#include "base/sized.h"
#include "continuation/parameter.h"
#include "continuation/sets.h"
#include "orbits/label.h"

enum { MOST_CROSSINGS = 16 };

/* ---- by the ensemble ---- */

/* Whether SA and LA are distinguished at a point with these states. */
static int distinct(const pendres_small_end *end, const pendres_label_states *s)
{
  return end->known || s->count > 1;
}

static int other_of(const pendres_attractor *a)
{
  if (a->label == PENDRES_LABEL_CHAOTIC) return PENDRES_OTHER_CHAOTIC;
  if (a->orbit.winding != 0 || !pendres_attractor_closes(a)) return PENDRES_OTHER_RUNNING;
  if (a->orbit.period > 1) return PENDRES_OTHER_PERIODIC;
  return pendres_phase_on_sheets(&a->orbit) ? 0 : PENDRES_OTHER_ASYMMETRIC;
}

static void judge_ensemble(const pendres_small_end *end, const pendres_label_states *known,
                           const pendres_ensemble *e, const pendres_response *r,
                           pendres_phase_point *p)
{
  size_t sa = 0, la = 0, others = r->unlisted;
  const double all = (double)e->members;
  const int names = distinct(end, known);
  const pendres_label_border border = pendres_small_end_from(end, &p->pendulum);
  p->weakest_multiplier = pendres_response_weakest_multiplier(r);
  const size_t states = r->states < PENDRES_RESPONSE_STATES ? r->states : PENDRES_RESPONSE_STATES;
  for (size_t i = 0; i < states; i++) {
    const pendres_attractor *a = &r->state[i];
    p->other |= other_of(a);
    if (!pendres_attractor_closes(a) || !pendres_label_named(&a->orbit))
      others += r->state_members[i];
    else if (pendres_label_of(known, &border, &a->orbit) == PENDRES_LABEL_SA)
      sa += r->state_members[i];
    else
      la += r->state_members[i];
  }
  if (r->unresolved > 0) p->other |= PENDRES_OTHER_UNRESOLVED;
  if (r->escaped > 0) p->other |= PENDRES_OTHER_ESCAPE;
  if (r->unstable > 0) p->other |= PENDRES_OTHER_UNSTABLE;
  p->unresolved = r->unresolved;
  p->escaped = r->escaped;
  p->uncertain = r->uncertain;
  if (others > 0 || sa + la == 0)
    p->regime = PENDRES_REGIME_OTHER;
  else if (!names)
    p->regime = PENDRES_REGIME_SINGLE;
  else
    p->regime = sa > 0 && la > 0 ? PENDRES_REGIME_COEXISTENCE
                : sa > 0         ? PENDRES_REGIME_SA
                                 : PENDRES_REGIME_LA;
  p->sa_fraction = names ? (double)sa / all : NAN;
  p->la_fraction = names ? (double)la / all : NAN;
  p->sa_fraction_error = p->la_fraction_error =
    names ? (double)(r->unresolved + r->uncertain + r->unlisted) / all + r->sampling : NAN;
  p->mean_loop_area = r->mean_loop_area;
  p->mean_loop_area_error = r->mean_loop_area_error;
  p->mean_loop_amplitude = r->mean_loop_amplitude;
  p->mean_loop_amplitude_error = r->mean_loop_amplitude_error;
}

/* ---- by the branches ---- */

/* A line whose points are judged. */
typedef struct line {
  pendres_context *ctx;
  const pendres_phase_options *options;
  const pendres_branches *branches;
  pendres_small_end end;
  size_t count; /* points, */
  pendres_phase_point *points;
  pendres_label_states *known; /* the states that are known at each, */
  char *asked;                 /* and whether there may be others */
} line;

/* Amplitudes of SA and LA at a point, from the states that are known there. */
static void judge_amplitudes(const pendres_small_end *end, const pendres_label_states *s,
                             pendres_phase_point *p)
{
  const pendres_label_border border = pendres_small_end_from(end, &p->pendulum);
  p->sa_amplitude = p->sa_amplitude_error = p->la_amplitude = p->la_amplitude_error = NAN;
  p->exact = s->count > 0 ? PENDRES_REGIME_SINGLE : PENDRES_REGIME_OTHER;
  if (s->count == 0 || !distinct(end, s)) return;
  const size_t least = pendres_label_extreme(s, 0), most = pendres_label_extreme(s, 1);
  const pendres_orbit orbit = {
    .pendulum = p->pendulum, .period = 1, .amplitude = s->amplitude[least]};
  const int sa = pendres_label_of(s, &border, &orbit) == PENDRES_LABEL_SA;
  if (sa) {
    p->sa_amplitude = s->amplitude[least];
    p->sa_amplitude_error = s->error[least];
  }
  if (!sa || s->count > 1) {
    p->la_amplitude = s->amplitude[most];
    p->la_amplitude_error = s->error[most];
  }
  p->exact = s->count > 1 ? PENDRES_REGIME_COEXISTENCE
             : sa         ? PENDRES_REGIME_SA
                          : PENDRES_REGIME_LA;
}

/* Whether all states that can be SA or LA are known at a point: both of them, or the one that
   exists beyond the fold at which SA ends. */
static int enough(const pendres_small_end *end, const pendres_label_states *s,
                  const pendres_phase_point *p)
{
  return s->count > 1 || (s->count > 0 && end->known &&
                          pendres_small_end_from(end, &p->pendulum).beyond);
}

/* The points of a line at which states are looked for, and the values of its parameter there. */
typedef struct sought {
  line *of;
  size_t count, *point;
  double *value;
} sought;

static void note(void *arg, size_t k, const pendres_orbit *orbit)
{
  const sought *s = arg;
  pendres_label_note(&s->of->known[s->point[k]], orbit);
}

/* Find the states that are not known yet on the branches from number `first` on, at all points
   that ask for them, side by side. */
static pendres_status look_up(line *l, size_t first)
{
  pendres_room room = pendres_room_open(l->ctx, "points");
  sought s = {.of = l, .point = pendres_room_take(&room, l->count, sizeof *s.point),
              .value = pendres_room_take(&room, l->count, sizeof *s.value)};
  pendres_status status = room.status;
  for (size_t i = 0; i < l->count && status == PENDRES_OK; i++) {
    const pendres_phase_point *p = &l->points[i];
    if (!l->asked[i] || enough(&l->end, &l->known[i], p)) continue;
    s.point[s.count] = i;
    s.value[s.count++] = pendres_parameter_get(l->options->parameter, &p->pendulum);
  }
  for (size_t b = first; b < pendres_branches_count(l->branches) && status == PENDRES_OK; b++)
    status = pendres_branch_cross_each(l->ctx, pendres_branches_get(l->branches, b), s.count,
                                       s.value, note, &s);
  for (size_t i = 0; i < l->count && status == PENDRES_OK; i++)
    if (l->asked[i]) judge_amplitudes(&l->end, &l->known[i], &l->points[i]);
  return pendres_room_close(&room, status);
}

static pendres_status take_states(line *l, pendres_room *room)
{
  *room = pendres_room_open(l->ctx, "points");
  l->known = pendres_room_take(room, l->count, sizeof *l->known);
  l->asked = pendres_room_take(room, l->count, sizeof *l->asked);
  return room->status;
}

/* ---- lines ---- */

/* Whether two pendulums differ in nothing but the parameter of their line. */
static int on_one_line(pendres_parameter parameter, const pendres_pendulum *p, pendres_pendulum q)
{
  pendres_parameter_set(parameter, pendres_parameter_get(parameter, p), &q);
  return pendres_model_same(p, &q);
}

static const char *refused(size_t n, const pendres_pendulum *p, const pendres_phase_options *o)
{
  const pendres_ensemble *e = &o->ensemble;
  const char *why = NULL;
  if (PENDRES_SIZED_REFUSES(o) != NULL) return PENDRES_SIZED_REFUSES(o);
  if (!(o->spacing >= 0.0)) return "the spacing must not be negative";
  if ((unsigned)o->parameter >= PENDRES_PARAMETER_FOLLOWED) return "unknown parameter";
  if (pendres_ensemble_check(e, &why) != PENDRES_OK) return why;
  for (size_t i = 0; i < n; i++) {
    if (pendres_pendulum_check(&p[i], &why) != PENDRES_OK) return why;
    why = pendres_parameter_refuses(o->parameter, p[i].force);
    if (why == NULL) why = pendres_response_refuses(&p[i], e);
    if (why != NULL) return why;
    if (!on_one_line(o->parameter, &p[0], p[i]))
      return "the pendulums of a line differ in its parameter alone";
    if (i > 0 && !(pendres_parameter_get(o->parameter, &p[i]) >
                   pendres_parameter_get(o->parameter, &p[i - 1])))
      return "the parameter of a line must ascend";
  }
  return NULL;
}

static pendres_branch_options options_of(const pendres_pendulum *first,
                                         const pendres_pendulum *last,
                                         const pendres_phase_options *o)
{
  pendres_branch_options options = {.parameter = o->parameter, .spacing = o->spacing};
  const int plain =
    pendres_phase_plain(first, o->parameter) && pendres_phase_plain(last, o->parameter);
  pendres_phase_reach(o->parameter, plain, pendres_parameter_get(o->parameter, first),
                      pendres_parameter_get(o->parameter, last), &options.low, &options.high);
  return options;
}

/* Find the branches through the orbits of all responses, and then those that may be detached from
   these; at each point, orbits with more members come first. */
static pendres_status find_branches(pendres_context *ctx, size_t n, const pendres_response *r,
                                    const pendres_phase_options *o, pendres_branches **out)
{
  size_t count = 0;
  const pendres_branch_options options = options_of(&r[0].pendulum, &r[n - 1].pendulum, o);
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_orbit *more = NULL;
  size_t others = 0;
  pendres_status status = pendres_phase_detached(ctx, n, r, &room, &more, &others);
  pendres_orbit *orbits =
    pendres_room_take(&room, n * PENDRES_RESPONSE_STATES + others, sizeof *orbits);
  if (status == PENDRES_OK) status = room.status;
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < r[i].states && k < PENDRES_RESPONSE_STATES; k++)
      if (pendres_attractor_closes(&r[i].state[k])) orbits[count++] = r[i].state[k].orbit;
  for (size_t i = 0; i < others; i++) orbits[count++] = more[i];
  status = pendres_branches_find(ctx, count, orbits, &options, out);
  return pendres_room_close(&room, status);
}

/* Judge all points of a line whose branches are known, from its responses: by all orbits, those
   that members reach, and those of the branches. */
static pendres_status judge_line(line *l, const pendres_response *r)
{
  pendres_room room;
  if (take_states(l, &room) != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < l->count; i++) {
    l->asked[i] = 1;
    l->points[i] = (pendres_phase_point){.pendulum = r[i].pendulum};
    for (size_t k = 0; k < r[i].states && k < PENDRES_RESPONSE_STATES; k++)
      if (pendres_attractor_closes(&r[i].state[k]))
        pendres_label_note(&l->known[i], &r[i].state[k].orbit);
  }
  const pendres_status status = look_up(l, 0);
  for (size_t i = 0; i < l->count && status == PENDRES_OK; i++)
    judge_ensemble(&l->end, &l->known[i], &l->options->ensemble, &r[i], &l->points[i]);
  return pendres_room_close(&room, status);
}

/* Compute the members of a line and judge its points by them and by its branches; those
   are looked for if *branches is NULL. */
static pendres_status compute_line(pendres_context *ctx, size_t n,
                                   const pendres_pendulum *pendulums,
                                   const pendres_phase_options *options, pendres_phase_point *out,
                                   pendres_branches **branches)
{
  pendres_room room = pendres_room_open(ctx, "points");
  pendres_response *r = pendres_room_take(&room, n, sizeof *r);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  pendres_status status = pendres_response_find(ctx, n, pendulums, &options->ensemble, r);
  if (status == PENDRES_OK && *branches == NULL)
    status = find_branches(ctx, n, r, options, branches);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  line l = {.ctx = ctx, .options = options, .branches = *branches,
            .end = pendres_phase_small_end(*branches), .count = n, .points = out};
  return pendres_room_close(&room, judge_line(&l, r));
}

static pendres_status phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                 const pendres_phase_options *options, pendres_phase_point *out,
                                 pendres_branches **branches)
{
  if (options == NULL || (n > 0 && (pendulums == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, options and points");
  const char *why = refused(n, pendulums, options);
  if (why != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "phase diagram: %s", why);
  if (n == 0) return PENDRES_OK;
  pendres_branches *found = NULL;
  const pendres_status status = compute_line(ctx, n, pendulums, options, out, &found);
  if (status == PENDRES_OK && branches != NULL) {
    *branches = found;
    found = NULL;
  }
  pendres_branches_free(found);
  return status;
}

/* Open the door to a line of n records that begin with their pendulums, `stride` bytes apart. */
static pendres_door open_line(pendres_context *ctx, const pendres_phase_options *o, size_t n,
                              const void *records, size_t stride)
{
  if (n == 0 || o == NULL || records == NULL ||
      (unsigned)o->parameter >= PENDRES_PARAMETER_FOLLOWED)
    return pendres_door_open(ctx, NULL);
  const pendres_pendulum *first = records;
  const pendres_pendulum *last = (const void *)((const char *)records + (n - 1) * stride);
  const double ends[2] = {pendres_parameter_get(o->parameter, first),
                          pendres_parameter_get(o->parameter, last)};
  return pendres_door_open_along(ctx, first, o->parameter, 2, ends);
}

pendres_status pendres_phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                  const pendres_phase_options *options, pendres_phase_point *out,
                                  pendres_branches **branches)
{
  if (branches != NULL) *branches = NULL;
  pendres_door d = open_line(ctx, options, n, pendulums, sizeof *pendulums);
  PENDRES_DOOR_IN(&d, pendulum, n, pendulums);
  PENDRES_DOOR_IN(&d, phase_options, 1, options);
  PENDRES_DOOR_OUT(&d, phase_point, n, out);
  PENDRES_DOOR_CALL(&d, phase_line(ctx, n, pendulums, options, out, branches));
  if (branches != NULL) pendres_curves_leave(&d, pendres_branches_set(*branches));
  return pendres_door_close(&d);
}

/* ---- what neighbouring lines know ---- */

/* Curves of folds and symmetry breakings at which orbits that can be SA or LA end or lose their
   stability. */
static int bounds_named(const pendres_curve *c)
{
  const pendres_special kind = pendres_curve_kind_get(c);
  return (kind == PENDRES_FOLD || kind == PENDRES_SYMMETRY_BREAKING) &&
         pendres_curve_count(c) > 0 && pendres_phase_on_sheets(&pendres_curve_get(c, 0)->orbit);
}

/* Beyond all cusps no small orbit ends, whatever folds there are. */
static int beyond_cusps(const pendres_curves *curves, const pendres_pendulum *p)
{
  size_t cusps = 0;
  for (size_t i = 0; i < pendres_curves_count(curves); i++) {
    const pendres_curve *c = pendres_curves_get(curves, i);
    for (size_t k = 0; bounds_named(c) && k < pendres_curve_cusp_count(c); k++, cusps++) {
      const pendres_cusp *cusp = pendres_curve_cusp_get(c, k);
      const pendres_parameter across = cusp->parameter[1];
      if (!pendres_phase_beyond(across, pendres_parameter_get(across, p), cusp->value[1])) return 0;
    }
  }
  return cusps > 0;
}

/* Add the branches through all places at which a curve crosses the line. */
static pendres_status add_crossed(pendres_context *ctx, const pendres_curve *curve,
                                  const pendres_pendulum *of_line,
                                  const pendres_branch_options *options,
                                  pendres_branches *branches)
{
  size_t found = 0;
  const pendres_parameter across = pendres_curve_parameter(curve, 1);
  pendres_bifurcation *at = malloc(MOST_CROSSINGS * sizeof *at);
  if (at == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for bifurcations");
  pendres_status status = pendres_curve_cross(ctx, curve, pendres_parameter_get(across, of_line),
                                              MOST_CROSSINGS, at, &found);
  if (found > MOST_CROSSINGS) found = MOST_CROSSINGS;
  for (size_t i = 0; i < found && status == PENDRES_OK; i++)
    if (at[i].parameter != options->parameter ||
        !on_one_line(options->parameter, of_line, at[i].orbit.pendulum))
      status = pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                    "phase diagram: the curves are not of the line's parameter, or "
                                    "not of its pendulums");
  if (status == PENDRES_OK) status = pendres_branches_extend(ctx, found, at, options, branches);
  free(at);
  return status;
}

/* The named states that have been found at a point. */
static pendres_label_states states_of(const pendres_phase_point *p)
{
  pendres_label_states s = {.count = 0};
  pendres_orbit orbit = {.stable = 1, .period = 1};
  const double amplitude[2] = {p->sa_amplitude, p->la_amplitude};
  const double error[2] = {p->sa_amplitude_error, p->la_amplitude_error};
  for (int i = 0; i < 2; i++) {
    orbit.amplitude = amplitude[i];
    orbit.amplitude_error = error[i];
    if (!isnan(amplitude[i])) pendres_label_note(&s, &orbit);
  }
  return s;
}

/* Judge all points again, now that there are branches from number `first` on. */
static pendres_status judge_again(line *l, size_t first)
{
  pendres_room room;
  if (take_states(l, &room) != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < l->count; i++) {
    l->known[i] = states_of(&l->points[i]);
    /* Where there is one state without a name, nothing is missing. */
    l->asked[i] = l->points[i].exact != PENDRES_REGIME_SINGLE;
  }
  return pendres_room_close(&room, look_up(l, first));
}

/* Judge all points again, since the fold at which SA ends has become known. */
static pendres_status compute_again(const line *l, pendres_branches *branches)
{
  pendres_room room = pendres_room_open(l->ctx, "points");
  pendres_pendulum *p = pendres_room_take(&room, l->count, sizeof *p);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < l->count; i++) p[i] = l->points[i].pendulum;
  return pendres_room_close(
    &room, compute_line(l->ctx, l->count, p, l->options, l->points, &branches));
}

static pendres_status judge_by_curves(line *l, const pendres_curves *curves,
                                      pendres_branches *branches)
{
  const size_t n = l->count;
  const pendres_phase_point *points = l->points;
  const size_t first = pendres_branches_count(branches);
  /* What the points were judged by: without that fold, those with one state have no names. */
  pendres_small_end before = pendres_phase_small_end(branches);
  for (size_t i = 0; i < n; i++)
    if (isnan(points[i].sa_fraction)) before = (pendres_small_end){.known = 0};
  const pendres_branch_options options =
    options_of(&points[0].pendulum, &points[n - 1].pendulum, l->options);
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < pendres_curves_count(curves) && status == PENDRES_OK; i++) {
    const pendres_curve *c = pendres_curves_get(curves, i);
    if (bounds_named(c)) status = add_crossed(l->ctx, c, &points[0].pendulum, &options, branches);
  }
  if (status != PENDRES_OK || pendres_branches_count(branches) == first) return status;
  l->end = beyond_cusps(curves, &points[0].pendulum) ? before : pendres_phase_small_end(branches);
  if (l->end.known != before.known || l->end.value != before.value)
    return compute_again(l, branches);
  return judge_again(l, first);
}

static pendres_status phase_line_complete(pendres_context *ctx, size_t n,
                                          const pendres_curves *curves,
                                          const pendres_phase_options *options,
                                          pendres_phase_point *points, pendres_branches *branches)
{
  if (options == NULL || (n > 0 && (points == NULL || branches == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "options, points and branches");
  if (n == 0) return PENDRES_OK;
  for (size_t i = 0; i < n; i++) {
    const char *why = refused(1, &points[i].pendulum, options);
    if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  }
  line l = {.ctx = ctx, .options = options, .branches = branches, .count = n, .points = points};
  return judge_by_curves(&l, curves, branches);
}

pendres_status pendres_phase_line_complete(pendres_context *ctx, size_t n,
                                           const pendres_curves *curves,
                                           const pendres_phase_options *options,
                                           pendres_phase_point *points,
                                           pendres_branches *branches)
{
  pendres_door d = open_line(ctx, options, n, points, sizeof *points);
  curves = pendres_curves_inside(&d, curves);
  PENDRES_DOOR_IN(&d, phase_options, 1, options);
  PENDRES_DOOR_OUT(&d, phase_point, n, points);
  if (d.status == PENDRES_OK) {
    pendres_curves_enter(&d, pendres_branches_set(branches));
    PENDRES_DOOR_CALL(&d, phase_line_complete(ctx, n, curves, options, points, branches));
    pendres_curves_leave(&d, pendres_branches_set(branches));
  }
  return pendres_door_close(&d);
}
