/* work.c -- gaps that are cut, and the best of what they hold; see search.h. */
#include "analysis/resonance/numbers.h"
#include "analysis/resonance/search.h"

#include <math.h>

#include "engine/context_internal.h"
#include "analysis/resonance/response_parts.h"

/* Examine all gaps that are not known from before: points are only added. */
static void look_at_gaps(pendres_search *s)
{
  for (size_t i = 0; i + 1 < s->count; i++) {
    pendres_scan_point *a = &s->points[i], *b = a + 1;
    if (a->next == b->where) continue;
    pendres_gap_look(a, b, s->ensemble->members, &a->gap);
    a->next = b->where;
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
static int open_gap(const pendres_search *s, size_t i, double threshold)
{
  const pendres_gap *g = &s->points[i].gap;
  const double width = g->width / s->rate;
  if (!(g->around > threshold)) return 0;
  if (g->around > fmax(g->bound, threshold)) return width > gap_narrow;
  if (g->kind == PENDRES_GAP_JUMP) return width > (g->mixed ? gap_narrowest : gap_narrow);
  return g->loose || (g->kind == PENDRES_GAP_PLAIN && width > gap_narrow);
}

/* The largest bound of all gaps that are open; minus infinity if none is. */
static double largest_bound(const pendres_search *s, double threshold)
{
  double largest = -INFINITY;
  for (size_t i = 0; i + 1 < s->count; i++)
    if (open_gap(s, i, threshold)) largest = fmax(largest, s->points[i].gap.around);
  return largest;
}

/* Whether all states of two points go on to a kink between them, and their members meet there. */
static int meet(const pendres_scan_point *a, const pendres_scan_border *kink,
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
 * Find a fold in a gap, or else a kink. If there are jumps in the gap beside a kink, it is not yet
 * known where the members are at the kink: it is searched for again when the gap has been cut.
 */
static pendres_status find_border(pendres_search *s, pendres_scan_point *a,
                                  pendres_scan_border *out)
{
  const pendres_scan_point *b = a + 1;
  a->fold_sought = 1;
  pendres_status status = pendres_resonance_find_fold(s->ctx, s->ensemble, a, b, out);
  pendres_search_account(s, pendres_scan_frequency(a));
  if (status != PENDRES_OK || out->points > 0) return status;
  status = pendres_resonance_find_kink(s->ctx, a, b, out);
  pendres_search_account(s, pendres_scan_frequency(a));
  if (status != PENDRES_OK || out->points == 0 || s->count + 2 > PENDRES_SEARCH_POINTS ||
      meet(a, out, b))
    return status;
  out->points = 0;
  if (a->gap.width > gap_narrow * s->rate) a->fold_sought = 0;
  return status;
}

/* The most promising gap, however narrow, that was not searched for a fold yet; NULL: none. */
static pendres_scan_point *unsought(const pendres_search *s)
{
  double largest = threshold_of(s);
  pendres_scan_point *best = NULL;
  for (size_t i = 0; i + 1 < s->count; i++) {
    pendres_scan_point *a = &s->points[i];
    if (a->gap.kind != PENDRES_GAP_JUMP || a->fold_sought || a->at_fold || a[1].at_fold ||
        !(a->gap.bound > largest))
      continue;
    largest = a->gap.bound;
    best = a;
  }
  return best;
}

/*
 * Look for a fold or a kink in a gap. A fold saves many frequencies close to it, where its ghost
 * slows everything down; one beside it is requested. *found: its points were added, or there is no
 * room for them.
 */
static pendres_status add_border(pendres_search *s, pendres_scan_point *a, int *found)
{
  const signed char *const where[2] = {a->where, a[1].where};
  pendres_scan_border border;
  pendres_status status = find_border(s, a, &border);
  *found = status == PENDRES_OK && border.points > 0;
  if (!*found) return status;
  if (s->count + 2 > PENDRES_SEARCH_POINTS) {
    s->crowded = 1;
    return PENDRES_OK;
  }
  if (border.points == 1) {
    s->requests = 1;
    s->request[0] = border.beside;
  }
  for (size_t k = 0; k < border.points && status == PENDRES_OK; k++)
    status = pendres_search_insert(s, &border.at[k], where[border.at[k].at_fold < 0]);
  return status;
}

/*
 * Request cuts of the gaps that may hold more than the best value known, the most promising first.
 * If there are no requests, none but narrow ones are left, or room or budget are spent.
 */
static pendres_status resolve_gaps(pendres_search *s)
{
  for (;;) {
    int found = 0;
    look_at_gaps(s);
    if (pendres_search_over(s)) return PENDRES_OK;
    pendres_scan_point *sought = unsought(s);
    const pendres_status status = sought != NULL ? add_border(s, sought, &found) : PENDRES_OK;
    if (status != PENDRES_OK || s->requests > 0) return status;
    if (found) continue;
    const double threshold = threshold_of(s), largest = largest_bound(s, threshold);
    if (largest == -INFINITY && sought != NULL) continue;
    if (largest == -INFINITY) return PENDRES_OK;
    for (size_t i = 0; i + 1 < s->count; i++) {
      const double first = pendres_scan_frequency(&s->points[i]), width = s->points[i].gap.width;
      /* Less promising gaps may be ruled out by what is found in the others. */
      if (!open_gap(s, i, threshold) || s->points[i].gap.around < 0.5 * (threshold + largest))
        continue;
      for (int k = 1; k < SEARCH_SECTIONS && s->requests < PENDRES_SEARCH_POINTS; k++)
        s->request[s->requests++] = first + width * k / SEARCH_SECTIONS;
    }
    return PENDRES_OK;
  }
}

/*
 * Compare the resonance of one gap, or that at the fold before it, with *out; jumps: look at jumps
 * alone, or at all else. *again: a jump turned up in the gap.
 */
static pendres_status choose_from(pendres_search *s, size_t i, int jumps,
                                  pendres_resonance *out, int *again)
{
  pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
  const pendres_gap *g = &s->points[i].gap;
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
    a->next = NULL;
    *again = 1;
    return PENDRES_OK;
  }
  /* Where the larger side of a jump is not certain, a point that is known may be larger. */
  const double certain = one.loop_area - one.loop_area_error;
  if (status == PENDRES_OK && !(certain <= out->loop_area) &&
      (one.response.uncertain == 0 || certain >= best))
    *out = one;
  return status;
}

/* ---- what is left open ---- */

/* Whether a gap was not resolved that may hold more than this area. scanned: it is that of a point
   of the scan, and halving has found one of several jumps in a gap, and less there. */
static int unresolved(const pendres_search *s, size_t i, double area, int scanned)
{
  const pendres_gap *g = &s->points[i].gap;
  if (open_gap(s, i, area)) return 1;
  if (!(g->bound > area)) return 0;
  if (g->mixed) return 1;
  return g->kind != PENDRES_GAP_PLAIN && (scanned || pendres_search_ended(s));
}

/* The largest area that gaps which were not resolved may hold; minus infinity if there are none. */
static double left_open(const pendres_search *s, double area, int scanned)
{
  double largest = -INFINITY;
  for (size_t i = 0; i + 1 < s->count; i++)
    if (unresolved(s, i, area, scanned)) largest = fmax(largest, s->points[i].gap.around);
  return largest;
}

/* Let members be on the states that they are on beside gaps, where the mean may then exceed an
   area; whether that leaves gaps open. far: also on those further away, if they alternate. */
static int look_around(pendres_search *s, double area, int far)
{
  int open = 0;
  for (size_t i = 0; i + 1 < s->count; i++) {
    pendres_gap *g = &s->points[i].gap;
    if (!(g->width > gap_narrow * s->rate)) continue;
    const double most = pendres_gap_around(s, i, far);
    g->around = fmax(most > area ? most : g->bound, far ? g->around : g->bound);
    open |= g->around > g->bound;
  }
  return open;
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
static void make_ragged(const pendres_search *s, double largest, pendres_resonance *out)
{
  pendres_response *r = &out->response;
  const int scanned = out->peak == PENDRES_PEAK_RAGGED;
  out->peak = PENDRES_PEAK_RAGGED;
  out->loop_area_error += largest - out->loop_area;
  for (size_t i = 0; i + 1 < s->count; i++) {
    if (!unresolved(s, i, out->loop_area, scanned)) continue;
    for (size_t k = i; k <= i + 1; k++) {
      const pendres_response *q = &s->points[k].response;
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

static pendres_status at_the_end(const pendres_search *s, const pendres_scan_point *p)
{
  const int low = p == &s->points[0];
  return pendres_context_fail(
    s->ctx, PENDRES_NOT_FOUND,
    "damping %g, drive amplitude %g: the loop area is largest at the %s end of the range, "
    "drive frequency %g", s->pendulum.damping, s->pendulum.drive_amplitude,
    low ? "lower" : "upper", pendres_scan_frequency(p));
}

/* Choose the best of all smooth peaks and edges. *again: a jump turned up, or states beside gaps
   may be larger, which is to be resolved first. */
static pendres_status choose(pendres_search *s, pendres_resonance *out, int *again)
{
  pendres_status status = PENDRES_OK;
  *again = 0;
  out->loop_area = NAN;
  look_at_gaps(s);
  /* Smooth peaks first: they cost little, and leave fewer jumps to look into. */
  const int open = largest_bound(s, threshold_of(s)) > -INFINITY;
  for (int jumps = 0; jumps < 2 && !open; jumps++)
    for (size_t i = 0; i + 1 < s->count && status == PENDRES_OK && !*again; i++)
      status = choose_from(s, i, jumps, out, again);
  if (status != PENDRES_OK || *again) return status;
  const pendres_scan_point *best = best_point(s), *first = &s->points[0];
  const pendres_scan_point *last = &s->points[s->count - 1];
  const double most = fmax(out->loop_area + out->loop_area_error, threshold_of(s));
  *again = look_around(s, most, 0) && !pendres_search_over(s);
  if (*again) return status;
  if (!(out->loop_area >= best->response.mean_loop_area)) {
    if (best == first || best == last) return at_the_end(s, best);
    *out = as_scanned(best);
  }
  const double area = out->loop_area + out->loop_area_error;
  if (s->ensemble->members <= GAP_FEW) (void)look_around(s, area, 1);
  const double largest = left_open(s, area, out->peak == PENDRES_PEAK_RAGGED);
  if (out->peak == PENDRES_PEAK_RAGGED || largest > -INFINITY)
    make_ragged(s, fmax(largest, out->loop_area), out);
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

pendres_status pendres_search_next(pendres_search *s, pendres_resonance *out)
{
  pendres_status status = PENDRES_OK;
  do {
    if (s->stage != PENDRES_SCAN_DONE) {
      status = pendres_search_scan(s);
      if (status != PENDRES_OK || s->requests > 0) return status;
      if (!(best_point(s)->response.mean_loop_area > 0.0))
        return pendres_resonance_no_area(s->ctx, &s->pendulum);
    }
    for (int again = 1; again && status == PENDRES_OK;) {
      status = resolve_gaps(s);
      if (status != PENDRES_OK || s->requests > 0) return status;
      status = choose(s, out, &again);
      if (status != PENDRES_OK && status != PENDRES_NOT_FOUND) return status;
    }
  } while (pendres_search_scan_finely(s));
  return status == PENDRES_OK ? name_states(s, &out->response) : status;
}
