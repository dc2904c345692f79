/* work.c -- gaps that are cut, and the best of what they hold; see work.h. */
#include "analysis/resonance/work.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "analysis/resonance/response_parts.h"

enum { SECTIONS = 4 /* a gap is cut into */ };

/*
 * A gap with a jump is cut until it is this narrow, relative to the force's frequency; then its
 * fold is located, or the jump is found by halving. Where some members change to larger areas and
 * some to smaller ones, it is cut until they are apart, or down to the narrowest gap.
 */
static const double narrow = 2e-5, narrowest = 1e-7;

pendres_status pendres_resonance_work_create(pendres_search_budget *budget,
                                             const pendres_pendulum *p,
                                             const pendres_ensemble *ensemble,
                                             pendres_resonance_work *out)
{
  const pendres_status status = pendres_search_create(budget, p, ensemble, &out->s);
  out->gaps = 0;
  out->known = malloc(PENDRES_SEARCH_POINTS * sizeof *out->known);
  if (status != PENDRES_OK || out->known != NULL) return status;
  return pendres_context_fail(budget->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a resonance");
}

void pendres_resonance_work_free(pendres_resonance_work *w)
{
  pendres_search_free(&w->s);
  free(w->known);
}

/*
 * Examine all gaps. Most of them are known from before, since points have only been added. The loop
 * runs from the last gap down, so that known gaps are not overwritten before they are moved.
 */
static void look_at_gaps(pendres_resonance_work *w)
{
  size_t before = w->gaps;
  w->gaps = w->s.count > 0 ? w->s.count - 1 : 0;
  for (size_t i = w->gaps; i-- > 0;) {
    const pendres_scan_point *a = &w->s.points[i], *b = a + 1;
    pendres_known_gap next = {.from = a->where, .to = b->where, .jump = a->jump_to_next};
    const pendres_known_gap *old = before > 0 ? &w->known[before - 1] : NULL;
    const int met = old != NULL && old->from == next.from;
    if (met && old->to == next.to && old->jump == next.jump)
      next.gap = old->gap;
    else
      pendres_gap_look(a, b, w->s.ensemble->members, &next.gap);
    if (met) before--;
    w->known[i] = next;
  }
}

/* The least that a point's area can be: members that did not settle may be on any state. */
static double certain_area(const pendres_scan_point *p)
{
  return p->response.mean_loop_area - p->response.mean_loop_area_error;
}

/* The point whose area is certain to be largest. Where all members escape there is none. */
static const pendres_scan_point *best_point(const pendres_search *s)
{
  const pendres_scan_point *best = &s->points[0];
  for (size_t i = 1; i < s->count; i++)
    if (certain_area(&s->points[i]) > certain_area(best) || isnan(certain_area(best)))
      best = &s->points[i];
  return best;
}

/* A gap that cannot hold more than this is of no interest: it does not exceed the best value by
   more than that one's error. */
static double threshold_of(const pendres_search *s)
{
  const pendres_response *r = &best_point(s)->response;
  return r->mean_loop_area + r->mean_loop_area_error;
}

/* Whether a gap has to be examined further. */
static int open_gap(const pendres_resonance_work *w, size_t i, double threshold)
{
  const pendres_gap *g = &w->known[i].gap;
  const double width = g->width / w->s.rate;
  if (!(g->bound > threshold)) return 0;
  if (g->kind == PENDRES_GAP_JUMP) return width > (g->mixed ? narrowest : narrow);
  return g->loose || (g->kind == PENDRES_GAP_PLAIN && width > narrow);
}

/* The largest bound of all gaps that are open; minus infinity if none is. */
static double largest_bound(const pendres_resonance_work *w, double threshold)
{
  double largest = -INFINITY;
  for (size_t i = 0; i + 1 < w->s.count; i++)
    if (open_gap(w, i, threshold)) largest = fmax(largest, w->known[i].gap.bound);
  return largest;
}

/* Whether all states of two points go on to a kink between them, and their members meet there. */
static int meet(const pendres_scan_point *a, const pendres_scan_kink *kink,
                const pendres_scan_point *b)
{
  const pendres_response *p = &kink->at[0].response, *q = &kink->at[1].response;
  pendres_gap before, behind;
  pendres_gap_look(a, &kink->at[0], 0, &before);
  pendres_gap_look(&kink->at[1], b, 0, &behind);
  return before.kind != PENDRES_GAP_JUMP && behind.kind != PENDRES_GAP_JUMP &&
         fabs(p->mean_loop_area - q->mean_loop_area) <=
           p->mean_loop_area_error + q->mean_loop_area_error;
}

/*
 * A kink in a gap in which no fold was found becomes two points, one for either side. If there are
 * jumps in the gap as well, it is not yet known where the members are at the kink: it is searched
 * for again when the gap has been cut.
 */
static pendres_status add_kink(pendres_resonance_work *w, size_t gap, int *found)
{
  pendres_search *s = &w->s;
  const pendres_scan_point a = s->points[gap], b = s->points[gap + 1];
  pendres_scan_kink *kink = malloc(sizeof *kink);
  if (kink == NULL)
    return pendres_context_fail(s->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a resonance");
  pendres_status status = pendres_resonance_find_kink(s->ctx, &a, &b, kink);
  pendres_search_account(s, pendres_scan_frequency(&a));
  *found = status == PENDRES_OK && kink->found;
  if (*found && s->count + 2 > PENDRES_SEARCH_POINTS) {
    s->crowded = 1;
  } else if (*found && !meet(&a, kink, &b)) {
    *found = 0;
    if (w->known[gap].gap.width > narrow * s->rate) s->points[gap].fold_sought = 0;
  } else if (*found) {
    status = pendres_search_insert(s, &kink->at[0], &a);
    if (status == PENDRES_OK) status = pendres_search_insert(s, &kink->at[1], &b);
  }
  free(kink);
  return status;
}

/*
 * Look for a fold in the most promising gap that was not searched for one yet, however narrow. The
 * fold saves many frequencies close to it, where its ghost slows everything down. *sought: there
 * was such a gap; *found: a fold was added, and a frequency beside it is requested.
 */
static pendres_status add_fold(pendres_resonance_work *w, int *sought, int *found)
{
  pendres_search *s = &w->s;
  double largest = threshold_of(s);
  size_t gap = s->count;
  *found = 0;
  for (size_t i = 0; i + 1 < s->count; i++) {
    const pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
    const pendres_gap *g = &w->known[i].gap;
    if (g->kind != PENDRES_GAP_JUMP || a->fold_sought || a->at_fold || b->at_fold) continue;
    if (g->bound > largest) {
      largest = g->bound;
      gap = i;
    }
  }
  *sought = gap < s->count;
  if (!*sought) return PENDRES_OK;
  pendres_scan_point *a = &s->points[gap], *b = &s->points[gap + 1];
  pendres_scan_fold fold;
  a->fold_sought = 1;
  pendres_status status = pendres_resonance_find_fold(s->ctx, s->ensemble, a, b, &fold);
  pendres_search_account(s, pendres_scan_frequency(a));
  *found = status == PENDRES_OK && fold.found;
  if (status == PENDRES_OK && !*found) return add_kink(w, gap, found);
  if (!*found) return status;
  if (s->count + 2 > PENDRES_SEARCH_POINTS) {
    s->crowded = 1;
    return PENDRES_OK;
  }
  s->requests = 1;
  s->request[0] = fold.beside;
  return pendres_search_insert(s, &fold.at, fold.at.at_fold < 0 ? b : a);
}

/*
 * Request cuts of the gaps that may hold more than the best value known, the most promising first.
 * If there are no requests, none but narrow ones are left, or room or budget are spent.
 */
static pendres_status resolve_gaps(pendres_resonance_work *w)
{
  pendres_search *s = &w->s;
  for (;;) {
    int sought = 0, found = 0;
    look_at_gaps(w);
    if (pendres_search_over(s)) return PENDRES_OK;
    pendres_status status = add_fold(w, &sought, &found);
    if (status != PENDRES_OK || s->requests > 0) return status;
    if (found) continue;
    const double threshold = threshold_of(s), largest = largest_bound(w, threshold);
    if (largest == -INFINITY && sought) continue;
    if (largest == -INFINITY) return PENDRES_OK;
    for (size_t i = 0; i + 1 < s->count; i++) {
      const double first = pendres_scan_frequency(&s->points[i]), width = w->known[i].gap.width;
      /* Less promising gaps may be ruled out by what is found in the others. */
      if (!open_gap(w, i, threshold) || w->known[i].gap.bound < 0.5 * (threshold + largest))
        continue;
      for (int k = 1; k < SECTIONS && s->requests < PENDRES_SEARCH_POINTS; k++)
        s->request[s->requests++] = first + width * k / SECTIONS;
    }
    return PENDRES_OK;
  }
}

/*
 * Compare the resonance of one gap, or that at the fold before it, with *out; jumps: look at jumps
 * alone, or at all else. *again: a jump turned up in the gap.
 */
static pendres_status choose_from(pendres_resonance_work *w, size_t i, int jumps,
                                  pendres_resonance *out, int *again)
{
  pendres_search *s = &w->s;
  pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
  const pendres_gap *g = &w->known[i].gap;
  const double best = certain_area(best_point(s));
  pendres_resonance one;
  pendres_status status = PENDRES_OK;
  if (jumps != (g->kind == PENDRES_GAP_JUMP) && !a->at_fold) return status;
  if (jumps && a->at_fold && certain_area(a) >= best) {
    status = pendres_resonance_at_fold(s->ctx, a, &one);
    /* As large: the gap before it was cut down to the same fold, less exactly. */
    if (status == PENDRES_OK && !(one.loop_area < out->loop_area)) *out = one;
  }
  if (status != PENDRES_OK || g->kind == PENDRES_GAP_PLAIN) return status;
  if (jumps != (g->kind == PENDRES_GAP_JUMP)) return status;
  if (g->bound < best || g->bound < out->loop_area || pendres_search_ended(s)) return status;
  status = g->kind == PENDRES_GAP_PEAK
             ? pendres_resonance_refine_peak(s->ctx, s->ensemble, a, b, &one)
             : pendres_resonance_refine_edge(s->ctx, s->ensemble, a, b, &one);
  pendres_search_account(s, pendres_scan_frequency(a));
  if (status == PENDRES_NOT_FOUND) {
    /* The slope changes its sign without a zero: there is a jump in between after all. */
    a->jump_to_next = 1;
    *again = 1;
    return PENDRES_OK;
  }
  if (status == PENDRES_OK && !(one.loop_area - one.loop_area_error <= out->loop_area)) *out = one;
  return status;
}

/* ---- what is left open ---- */

/* Whether a gap was not resolved that may hold more than this area. scanned: it is that of a point
   of the scan, and halving has found one of several jumps in a gap, and less there. */
static int unresolved(const pendres_resonance_work *w, size_t i, double area, int scanned)
{
  const pendres_gap *g = &w->known[i].gap;
  if (!(g->bound > area)) return 0;
  if (open_gap(w, i, area) || g->mixed) return 1;
  return g->kind != PENDRES_GAP_PLAIN && (scanned || pendres_search_ended(&w->s));
}

/* The largest area that gaps which were not resolved may hold; minus infinity if there are none. */
static double left_open(const pendres_resonance_work *w, double area, int scanned)
{
  double largest = -INFINITY;
  for (size_t i = 0; i + 1 < w->s.count; i++)
    if (unresolved(w, i, area, scanned)) largest = fmax(largest, w->known[i].gap.bound);
  return largest;
}

/* Raise an error to the distance between two values. */
static void spread(double *error, double a, double b)
{
  const double off = fabs(a - b);
  if (off > *error) *error = off;
}

/*
 * A peak among gaps that were not resolved: the largest value lies in one of them, and is at most
 * `largest`. Errors are the differences of the points around these gaps.
 */
static void make_ragged(const pendres_resonance_work *w, double largest, pendres_resonance *out)
{
  pendres_response *r = &out->response;
  const int scanned = out->peak == PENDRES_PEAK_RAGGED;
  out->peak = PENDRES_PEAK_RAGGED;
  out->loop_area_error += largest - out->loop_area;
  for (size_t i = 0; i + 1 < w->s.count; i++) {
    if (!unresolved(w, i, out->loop_area, scanned)) continue;
    for (size_t k = i; k <= i + 1; k++) {
      const pendres_response *q = &w->s.points[k].response;
      spread(&out->frequency_error, q->pendulum.drive_frequency, out->frequency);
      spread(&r->mean_loop_amplitude_error, q->mean_loop_amplitude, r->mean_loop_amplitude);
      spread(&r->mean_amplitude_error, q->mean_amplitude, r->mean_amplitude);
      spread(&r->phase_lag_error, q->phase_lag, r->phase_lag);
      spread(&r->mean_power_error, q->mean_power, r->mean_power);
      spread(&r->sa_fraction_error, q->sa_fraction, r->sa_fraction);
      spread(&r->la_fraction_error, q->la_fraction, r->la_fraction);
    }
  }
  r->mean_loop_area_error = out->loop_area_error;
}

/* Take a point of the scan as it is, where nothing better is known. */
static pendres_resonance as_scanned(const pendres_scan_point *p)
{
  return (pendres_resonance){.peak = PENDRES_PEAK_RAGGED,
                             .frequency = pendres_scan_frequency(p),
                             .loop_area = p->response.mean_loop_area,
                             .loop_area_error = p->response.mean_loop_area_error,
                             .response = p->response,
                             .fold_frequency = NAN,
                             .fold_frequency_error = NAN};
}

static pendres_status at_the_end(const pendres_resonance_work *w, const pendres_scan_point *p)
{
  const int low = p == &w->s.points[0];
  return pendres_context_fail(
    w->s.ctx, PENDRES_NOT_FOUND,
    "damping %g, drive amplitude %g: the loop area is largest at the %s end of the range, "
    "drive frequency %g", w->s.pendulum.damping, w->s.pendulum.drive_amplitude,
    low ? "lower" : "upper", pendres_scan_frequency(p));
}

/* Choose the best of all smooth peaks and edges. *again: a jump turned up, to be resolved first. */
static pendres_status choose(pendres_resonance_work *w, pendres_resonance *out, int *again)
{
  const pendres_search *s = &w->s;
  pendres_status status = PENDRES_OK;
  *again = 0;
  out->loop_area = NAN;
  look_at_gaps(w);
  /* Smooth peaks first: they cost little, and leave fewer jumps to look into. */
  const int open = largest_bound(w, threshold_of(s)) > -INFINITY;
  for (int jumps = 0; jumps < 2 && !open; jumps++)
    for (size_t i = 0; i + 1 < s->count && status == PENDRES_OK && !*again; i++)
      status = choose_from(w, i, jumps, out, again);
  if (status != PENDRES_OK || *again) return status;
  const pendres_scan_point *best = best_point(s), *first = &s->points[0];
  const pendres_scan_point *last = &s->points[s->count - 1];
  if (!(out->loop_area >= best->response.mean_loop_area)) {
    if (best == first || best == last) return at_the_end(w, best);
    *out = as_scanned(best);
  }
  const double largest = left_open(w, out->loop_area + out->loop_area_error,
                                   out->peak == PENDRES_PEAK_RAGGED);
  if (out->peak == PENDRES_PEAK_RAGGED || largest > -INFINITY)
    make_ragged(w, fmax(largest, out->loop_area), out);
  out->complete = !s->coarse && (out->peak != PENDRES_PEAK_RAGGED || !pendres_search_over(s));
  return PENDRES_OK;
}

/* Name a state that is alone at the resonance, by the responses at the other frequencies. */
static pendres_status name_states(const pendres_search *s, pendres_response *r)
{
  const pendres_response *line[PENDRES_SEARCH_POINTS];
  pendres_small_end end;
  if (!pendres_response_nameless(r)) return PENDRES_OK;
  for (size_t i = 0; i < s->count; i++) line[i] = &s->points[i].response;
  const pendres_status status =
    pendres_response_small_end(s->ctx, s->count, line, PENDRES_DRIVE_FREQUENCY, &end);
  if (status == PENDRES_OK) pendres_response_name_by(&end, r);
  return status;
}

pendres_status pendres_resonance_no_area(pendres_context *ctx, const pendres_pendulum *p)
{
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                              "damping %g, drive amplitude %g: the loop area is zero at all drive "
                              "frequencies%s", p->damping, p->drive_amplitude,
                              p->parametric_amplitude == 0.0
                                ? "" : "; the work of a parametric drive does not count");
}

pendres_status pendres_resonance_work_next(pendres_resonance_work *w, pendres_resonance *out)
{
  pendres_search *s = &w->s;
  if (s->stage != PENDRES_SCAN_DONE) {
    const pendres_status status = pendres_search_scan(s);
    if (status != PENDRES_OK || s->requests > 0) return status;
    if (!(best_point(s)->response.mean_loop_area > 0.0))
      return pendres_resonance_no_area(s->ctx, &s->pendulum);
  }
  for (int again = 1; again;) {
    pendres_status status = resolve_gaps(w);
    if (status != PENDRES_OK || s->requests > 0) return status;
    status = choose(w, out, &again);
    if (status != PENDRES_OK) return status;
  }
  return name_states(s, &out->response);
}
