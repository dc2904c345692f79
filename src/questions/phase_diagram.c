/* phase_diagram.c -- regimes by ensemble and by branches; see phase_diagram.h. */
#include <pendres/phase_diagram.h>

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "orbits/label.h"
#include "engine/passage.h"

enum { MOST_CROSSINGS = 16 };

const char *pendres_regime_name(pendres_regime regime)
{
  static const char *const names[PENDRES_REGIME_COUNT] = {"sa", "la", "coexistence", "single",
                                                          "other"};
  return (unsigned)regime < PENDRES_REGIME_COUNT ? names[regime] : NULL;
}

/* ---- what tells SA from LA at one damping ---- */

/* Orbits on the sheets that fold over each other, whatever their stability. */
static int on_sheets(const pendres_orbit *o)
{
  return pendres_label_named(o) && o->symmetric;
}

/* Among the folds below whose frequency two orbits exist, the one of the smallest amplitude. */
static pendres_label_border find_border(const pendres_branches *branches)
{
  pendres_label_border b = {.distinct = 0};
  for (size_t i = 0; i < pendres_branches_count(branches); i++) {
    const pendres_branch *branch = pendres_branches_get(branches, i);
    for (size_t k = 0; k < pendres_branch_bifurcations(branch); k++) {
      const pendres_bifurcation *f = pendres_branch_bifurcation(branch, k);
      if (f->kind != PENDRES_FOLD || !on_sheets(&f->orbit) || !(f->curvature < 0.0)) continue;
      if (b.distinct && f->orbit.amplitude >= b.amplitude) continue;
      b = (pendres_label_border){
        .distinct = 1, .frequency = f->value, .amplitude = f->orbit.amplitude};
    }
  }
  return b;
}

/* Whether the names mean something where these states are. */
static int distinct(const pendres_label_border *b, const pendres_label_states *s)
{
  return b->distinct || s->count > 1;
}

/* ---- by the ensemble ---- */

static int other_of(const pendres_attractor *a)
{
  if (a->label == PENDRES_LABEL_CHAOTIC) return PENDRES_OTHER_CHAOTIC;
  if (a->orbit.winding != 0) return PENDRES_OTHER_RUNNING;
  if (a->orbit.period > 1) return PENDRES_OTHER_PERIODIC;
  return a->orbit.symmetric ? 0 : PENDRES_OTHER_ASYMMETRIC;
}

static void judge_ensemble(const pendres_label_border *b, const pendres_label_states *known,
                           const pendres_ensemble *e, const pendres_response *r,
                           pendres_phase_point *p)
{
  size_t sa = 0, la = 0, others = r->unlisted;
  const double all = (double)e->members;
  const int names = distinct(b, known);
  const size_t states = r->states < PENDRES_RESPONSE_STATES ? r->states : PENDRES_RESPONSE_STATES;
  for (size_t i = 0; i < states; i++) {
    const pendres_attractor *a = &r->state[i];
    p->other |= other_of(a);
    if (a->label == PENDRES_LABEL_CHAOTIC || !pendres_label_named(&a->orbit))
      others += r->state_members[i];
    else if (pendres_label_of(known, b, &a->orbit) == PENDRES_LABEL_SA)
      sa += r->state_members[i];
    else
      la += r->state_members[i];
  }
  if (r->unresolved > 0) p->other |= PENDRES_OTHER_UNRESOLVED;
  p->unresolved = r->unresolved;
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
    names ? (double)(r->unresolved + r->uncertain + r->unlisted) / all : NAN;
  p->mean_loop_area = r->mean_loop_area;
  p->mean_loop_area_error = r->mean_loop_area_error;
  p->mean_loop_amplitude = r->mean_loop_amplitude;
  p->mean_loop_amplitude_error = r->mean_loop_amplitude_error;
}

/* ---- by the branches ---- */

/* Amplitudes of SA and LA at a point, from the states that are known there. */
static void judge_amplitudes(const pendres_label_border *b, const pendres_label_states *s,
                             pendres_phase_point *p)
{
  p->sa_amplitude = p->sa_amplitude_error = p->la_amplitude = p->la_amplitude_error = NAN;
  p->exact = s->count > 0 ? PENDRES_REGIME_SINGLE : PENDRES_REGIME_OTHER;
  if (s->count == 0 || !distinct(b, s)) return;
  const size_t least = pendres_label_extreme(s, 0), most = pendres_label_extreme(s, 1);
  const pendres_orbit orbit = {
    .pendulum = p->pendulum, .period = 1, .amplitude = s->amplitude[least]};
  const int sa = pendres_label_of(s, b, &orbit) == PENDRES_LABEL_SA;
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

/* Whether all that can be SA or LA is known of a point: both, the one beyond the fold at which SA
   ends, or the only one. */
static int enough(const pendres_label_border *b, const pendres_label_states *s,
                  const pendres_phase_point *p)
{
  if (!b->distinct) return s->count > 0;
  return s->count > 1 || (s->count > 0 && p->pendulum.drive_frequency > b->frequency);
}

/* What is not known yet of a point is looked up on the branches from number `first` on. */
static pendres_status look_up(pendres_context *ctx, const pendres_label_border *b,
                              const pendres_branches *branches, size_t first,
                              pendres_label_states *s, pendres_orbit *there,
                              pendres_phase_point *p)
{
  pendres_status status = PENDRES_OK;
  const int known = enough(b, s, p);
  for (size_t i = first; i < pendres_branches_count(branches) && !known; i++) {
    size_t found = 0;
    status = pendres_branch_cross(ctx, pendres_branches_get(branches, i),
                                  p->pendulum.drive_frequency, MOST_CROSSINGS, there, &found);
    if (status != PENDRES_OK) return status;
    for (size_t k = 0; k < found && k < MOST_CROSSINGS; k++) pendres_label_note(s, &there[k]);
  }
  judge_amplitudes(b, s, p);
  return status;
}

/* All orbits at one point: those that members reach, and those of the branches. */
static pendres_status judge_branches(pendres_context *ctx, const pendres_label_border *b,
                                     const pendres_branches *branches, const pendres_response *r,
                                     pendres_label_states *s, pendres_orbit *there,
                                     pendres_phase_point *p)
{
  *s = (pendres_label_states){.count = 0};
  for (size_t i = 0; i < r->states && i < PENDRES_RESPONSE_STATES; i++)
    if (r->state[i].label != PENDRES_LABEL_CHAOTIC) pendres_label_note(s, &r->state[i].orbit);
  return look_up(ctx, b, branches, 0, s, there, p);
}

/* ---- lines ---- */

static pendres_status check_line(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                 const pendres_ensemble *e)
{
  const char *why = e->members == 0 ? "an ensemble needs members" : NULL;
  for (size_t i = 0; i < n && why == NULL; i++) {
    if (pendres_pendulum_check(&p[i], &why) != PENDRES_OK) break;
    why = pendres_passage_refuses(&p[i], fmax(fabs(e->x_first), fabs(e->x_last)), e->v);
    if (why != NULL) break;
    if (p[i].damping != p[0].damping || p[i].drive_amplitude != p[0].drive_amplitude)
      why = "a line has one damping and one drive amplitude";
    else if (i > 0 && !(p[i].drive_frequency > p[i - 1].drive_frequency))
      why = "the drive frequencies of a line must ascend";
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "phase diagram: %s", why);
}

static pendres_branch_options options_of(const pendres_pendulum *first,
                                         const pendres_pendulum *last, double spacing)
{
  /* The fold that makes the distinction lies below the small oscillations' frequency, 1. */
  return (pendres_branch_options){.parameter = PENDRES_DRIVE_FREQUENCY,
                                  .low = fmin(0.8 * first->drive_frequency, 0.7),
                                  .high = fmax(1.1 * last->drive_frequency, 1.1),
                                  .spacing = spacing};
}

/* The orbits of all responses, those of the largest number of members first at each point. */
static pendres_status find_branches(pendres_context *ctx, size_t n, const pendres_response *r,
                                    double spacing, pendres_branches **out)
{
  size_t count = 0;
  pendres_status status = PENDRES_OK;
  const pendres_branch_options options =
    options_of(&r[0].pendulum, &r[n - 1].pendulum, spacing);
  pendres_orbit *orbits = malloc((n * PENDRES_RESPONSE_STATES + 1) * sizeof *orbits);
  if (orbits == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for orbits");
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < r[i].states && k < PENDRES_RESPONSE_STATES; k++)
      if (r[i].state[k].label != PENDRES_LABEL_CHAOTIC) orbits[count++] = r[i].state[k].orbit;
  status = pendres_branches_find(ctx, count, orbits, &options, out);
  free(orbits);
  return status;
}

/* All points of a line whose branches are known, from its responses. */
static pendres_status judge_line(pendres_context *ctx, size_t n, const pendres_ensemble *ensemble,
                                 const pendres_response *r, const pendres_branches *branches,
                                 pendres_orbit *there, pendres_phase_point *out)
{
  pendres_status status = PENDRES_OK;
  const pendres_label_border b = find_border(branches);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    out[i] = (pendres_phase_point){.pendulum = r[i].pendulum};
    pendres_label_states known;
    status = judge_branches(ctx, &b, branches, &r[i], &known, there, &out[i]);
    if (status == PENDRES_OK) judge_ensemble(&b, &known, ensemble, &r[i], &out[i]);
  }
  return status;
}

/* Compute the members of a line and judge its points by them and by its branches; those
   are looked for if *branches is NULL. */
static pendres_status compute_line(pendres_context *ctx, size_t n,
                                   const pendres_pendulum *pendulums,
                                   const pendres_ensemble *ensemble, double spacing,
                                   pendres_phase_point *out, pendres_branches **branches)
{
  pendres_status status;
  pendres_response *r = malloc(n * sizeof *r);
  pendres_orbit *there = malloc(MOST_CROSSINGS * sizeof *there);
  if (r == NULL || there == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu points", n);
    goto done;
  }
  status = pendres_response_compute(ctx, n, pendulums, ensemble, r);
  if (status == PENDRES_OK && *branches == NULL)
    status = find_branches(ctx, n, r, spacing, branches);
  if (status == PENDRES_OK) status = judge_line(ctx, n, ensemble, r, *branches, there, out);
done:
  free(r);
  free(there);
  return status;
}

static pendres_status phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                 const pendres_ensemble *ensemble, double spacing,
                                 pendres_phase_point *out, pendres_branches **branches)
{
  if (ensemble == NULL || (n > 0 && (pendulums == NULL || out == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, ensemble and points");
  if (!(spacing >= 0.0))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "phase diagram: the spacing must not be negative");
  pendres_status status = check_line(ctx, n, pendulums, ensemble);
  if (status != PENDRES_OK || n == 0) return status;
  pendres_branches *found = NULL;
  status = compute_line(ctx, n, pendulums, ensemble, spacing, out, &found);
  if (status == PENDRES_OK && branches != NULL) {
    *branches = found;
    found = NULL;
  }
  pendres_branches_free(found);
  return status;
}

pendres_status pendres_phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                  const pendres_ensemble *ensemble, double spacing,
                                  pendres_phase_point *out, pendres_branches **branches)
{
  if (branches != NULL) *branches = NULL;
  return PENDRES_CONTEXT_CALL(ctx, phase_line(ctx, n, pendulums, ensemble, spacing, out, branches));
}

/* ---- what neighbouring lines know ---- */

/* Curves of what bounds the orbits that can be SA or LA. */
static int bounds_named(const pendres_curve *c)
{
  const pendres_special kind = pendres_curve_kind(c);
  return (kind == PENDRES_FOLD || kind == PENDRES_SYMMETRY_BREAKING) &&
         pendres_curve_count(c) > 0 && on_sheets(&pendres_curve_get(c, 0)->orbit);
}

/* Beyond all cusps no small orbit ends, whatever folds there are. */
static int above_cusps(const pendres_curves *curves, double damping)
{
  size_t cusps = 0;
  for (size_t i = 0; i < pendres_curves_count(curves); i++) {
    const pendres_curve *c = pendres_curves_get(curves, i);
    for (size_t k = 0; bounds_named(c) && k < pendres_curve_cusps(c); k++, cusps++)
      if (damping < pendres_curve_cusp(c, k)->value[1]) return 0;
  }
  return cusps > 0;
}

/* The branches through all points at which a curve crosses the line. */
static pendres_status add_crossed(pendres_context *ctx, const pendres_curve *curve,
                                  const pendres_pendulum *line,
                                  const pendres_branch_options *options,
                                  pendres_branches *branches)
{
  size_t found = 0;
  pendres_bifurcation *at = malloc(MOST_CROSSINGS * sizeof *at);
  if (at == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for bifurcations");
  pendres_status status =
    pendres_curve_cross(ctx, curve, line->damping, MOST_CROSSINGS, at, &found);
  if (found > MOST_CROSSINGS) found = MOST_CROSSINGS;
  for (size_t i = 0; i < found && status == PENDRES_OK; i++) {
    const pendres_pendulum *p = &at[i].orbit.pendulum;
    if (at[i].parameter != PENDRES_DRIVE_FREQUENCY || p->damping != line->damping ||
        p->drive_amplitude != line->drive_amplitude)
      status = pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                    "phase diagram: the curves are not of drive frequency and "
                                    "damping at the line's drive amplitude");
  }
  if (status == PENDRES_OK) status = pendres_branches_extend(ctx, found, at, options, branches);
  free(at);
  return status;
}

/* The states that a point has been found to have, but for one without a name. */
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

/* All points again, now that there are branches from number `first` on. */
static pendres_status judge_again(pendres_context *ctx, size_t n, const pendres_label_border *b,
                                  const pendres_branches *branches, size_t first,
                                  pendres_phase_point *points)
{
  pendres_status status = PENDRES_OK;
  pendres_orbit *there = malloc(MOST_CROSSINGS * sizeof *there);
  if (there == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for orbits");
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    pendres_label_states known = states_of(&points[i]);
    /* Where there is one state without a name, nothing is missing. */
    if (points[i].exact != PENDRES_REGIME_SINGLE)
      status = look_up(ctx, b, branches, first, &known, there, &points[i]);
  }
  free(there);
  return status;
}

/* The fold at which SA ends has become known: members count anew. */
static pendres_status compute_again(pendres_context *ctx, size_t n,
                                    const pendres_ensemble *ensemble, double spacing,
                                    pendres_phase_point *points, pendres_branches *branches)
{
  pendres_pendulum *p = malloc(n * sizeof *p);
  if (p == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu points", n);
  for (size_t i = 0; i < n; i++) p[i] = points[i].pendulum;
  const pendres_status status = compute_line(ctx, n, p, ensemble, spacing, points, &branches);
  free(p);
  return status;
}

static pendres_status phase_line_complete(pendres_context *ctx, size_t n,
                                          const pendres_curves *curves,
                                          const pendres_ensemble *ensemble, double spacing,
                                          pendres_phase_point *points, pendres_branches *branches)
{
  if (ensemble == NULL || (n > 0 && (points == NULL || branches == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "ensemble, points and branches");
  if (n == 0) return PENDRES_OK;
  pendres_status status = PENDRES_OK;
  const size_t first = pendres_branches_count(branches);
  /* What the points were judged by: without that fold, those with one state have no names. */
  pendres_label_border before = find_border(branches);
  for (size_t i = 0; i < n; i++)
    if (isnan(points[i].sa_fraction)) before = (pendres_label_border){.distinct = 0};
  const pendres_branch_options options =
    options_of(&points[0].pendulum, &points[n - 1].pendulum, spacing);
  for (size_t i = 0; i < pendres_curves_count(curves) && status == PENDRES_OK; i++) {
    const pendres_curve *c = pendres_curves_get(curves, i);
    if (bounds_named(c)) status = add_crossed(ctx, c, &points[0].pendulum, &options, branches);
  }
  if (status != PENDRES_OK || pendres_branches_count(branches) == first) return status;
  const pendres_label_border b =
    above_cusps(curves, points[0].pendulum.damping) ? before : find_border(branches);
  if (b.distinct != before.distinct || b.frequency != before.frequency)
    return compute_again(ctx, n, ensemble, spacing, points, branches);
  return judge_again(ctx, n, &b, branches, first, points);
}

pendres_status pendres_phase_line_complete(pendres_context *ctx, size_t n,
                                           const pendres_curves *curves,
                                           const pendres_ensemble *ensemble, double spacing,
                                           pendres_phase_point *points,
                                           pendres_branches *branches)
{
  return PENDRES_CONTEXT_CALL(ctx, phase_line_complete(ctx, n, curves, ensemble, spacing, points,
                                                       branches));
}
