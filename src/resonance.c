/* resonance.c -- the search for the largest mean loop area; see resonance.h. */
#include <pendres/resonance.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "context_internal.h"
#include "resonance_refine.h"
#include "response_name.h"
#include "strobe_run.h"

enum {
  SCAN_POINTS = 19,   /* over the range at first: 0.04 apart in the default range */
  MOST_POINTS = 400,  /* of one search; a range that needs more is not resolved */
  SECTIONS = 4        /* an interval with a jump is cut into */
};

/* An interval with a jump is cut until it is this narrow; then its fold is located. */
static const double narrow = 2e-5;

/* What happens between two neighbouring points of the scan. */
typedef enum gap_kind { GAP_PLAIN, GAP_PEAK, GAP_JUMP } gap_kind;

typedef struct search {
  pendres_context *ctx;
  pendres_pendulum pendulum;
  const pendres_ensemble *ensemble;
  size_t count;
  pendres_scan_point *points; /* ascending in omega */
} search;

static int by_frequency(const void *a, const void *b)
{
  const pendres_scan_point *p = a, *q = b;
  return p->response.pendulum.drive_frequency < q->response.pendulum.drive_frequency ? -1 : 1;
}

static pendres_status check_room(const search *s, size_t n)
{
  if (s->count + n <= MOST_POINTS) return PENDRES_OK;
  return pendres_context_fail(s->ctx, PENDRES_NOT_CONVERGED,
                              "damping %g: the resonance needs more than %d frequencies",
                              s->pendulum.damping, MOST_POINTS);
}

/* Evaluate n more frequencies and sort them in. */
static pendres_status add_points(search *s, size_t n, const double *omega)
{
  pendres_status status = check_room(s, n);
  if (status != PENDRES_OK) return status;
  status = pendres_scan_evaluate(s->ctx, &s->pendulum, s->ensemble, n, omega, s->points + s->count);
  if (status != PENDRES_OK) return status;
  s->count += n;
  qsort(s->points, s->count, sizeof *s->points, by_frequency);
  return PENDRES_OK;
}

static double frequency_of(const pendres_scan_point *p)
{
  return p->response.pendulum.drive_frequency;
}

/*
 * Whether an orbit goes on from one frequency to the next: its Poincaré point moves as the
 * slopes at both ends say. On a branch that bends sharply it does not, and the gap is looked into.
 */
static int goes_on(const pendres_orbit *a, const pendres_orbit *b)
{
  const double step = b->pendulum.drive_frequency - a->pendulum.drive_frequency;
  const double dx = 0.5 * step * (a->frequency_derivative[0] + b->frequency_derivative[0]);
  const double dv = 0.5 * step * (a->frequency_derivative[1] + b->frequency_derivative[1]);
  const double off = hypot(b->x - a->x - dx, b->v - a->v - dv);
  return a->period == b->period && a->winding == b->winding && off <= 0.05 + 0.25 * hypot(dx, dv);
}

/* The members are on the same states at both points: nothing jumped in between. */
static int same_states(const pendres_response *a, const pendres_response *b)
{
  if (a->states != b->states || a->unresolved != b->unresolved || a->unlisted != b->unlisted)
    return 0;
  for (size_t i = 0; i < a->states; i++)
    if (a->state_members[i] != b->state_members[i] ||
        !goes_on(&a->state[i].orbit, &b->state[i].orbit))
      return 0;
  return 1;
}

static gap_kind kind_of(const pendres_scan_point *a, const pendres_scan_point *b)
{
  if (a->jump_to_next || !same_states(&a->response, &b->response)) return GAP_JUMP;
  return a->slope > 0.0 && b->slope < 0.0 ? GAP_PEAK : GAP_PLAIN;
}

/*
 * A state's area, as large as it can become over `width`: by its slope, which may be steep next
 * to a fold, but not by more than a quarter.
 */
static double grown_area(const pendres_orbit *o, double width)
{
  if (!isfinite(o->loop_area)) return 0.0;
  const double slope = isfinite(o->loop_area_slope) ? fabs(o->loop_area_slope) : INFINITY;
  return o->loop_area + fmin(width * slope, 0.25 * o->loop_area);
}

static double largest_area(const pendres_response *r, double width)
{
  double largest = 0.0;
  for (size_t i = 0; i < r->states; i++)
    largest = fmax(largest, grown_area(&r->state[i].orbit, width));
  return largest;
}

/*
 * Share of the members that are, or for all that is known may be, on states with an area of at
 * least `cut`; *below is raised to the largest area of the other states.
 */
static double share_above(const pendres_response *r, double width, double cut, double *below)
{
  size_t members = r->unresolved + r->unlisted, above = members;
  for (size_t i = 0; i < r->states; i++) {
    const double area = grown_area(&r->state[i].orbit, width);
    members += r->state_members[i];
    if (area >= cut)
      above += r->state_members[i];
    else
      *below = fmax(*below, area);
  }
  return members > 0 ? (double)above / (double)members : 1.0;
}

/*
 * No mean area between two points exceeds this: states change their areas by their slopes, and
 * the share of those with a large area is at most that at either end, plus a tenth of the
 * members (a fiftieth in narrow gaps) for those that come and go in between.
 */
static double bound_of(const pendres_scan_point *a, const pendres_scan_point *b)
{
  const double width = frequency_of(b) - frequency_of(a);
  if (kind_of(a, b) != GAP_JUMP)
    return fmax(a->response.mean_loop_area, b->response.mean_loop_area) +
           0.5 * width * fmax(fabs(a->slope), fabs(b->slope));
  const double largest =
    fmax(largest_area(&a->response, width), largest_area(&b->response, width));
  double other = 0.0;
  double left = share_above(&a->response, width, 0.7 * largest, &other);
  double right = share_above(&b->response, width, 0.7 * largest, &other);
  /* A fold's own point is on the far side of the jump: inside the gap its shares do not hold. */
  if (a->at_fold > 0) left = right;
  if (b->at_fold < 0) right = left;
  const double share = fmin(1.0, fmax(left, right) + (width > 0.01 ? 0.1 : 0.02));
  return share * largest + (1.0 - share) * other;
}

/* What is certain of a point's area: members that did not settle may be on any state. */
static double certain_area(const pendres_scan_point *p)
{
  return p->response.mean_loop_area - p->response.mean_loop_area_error;
}

static double best_area(const search *s)
{
  double best = -INFINITY;
  for (size_t i = 0; i < s->count; i++) best = fmax(best, certain_area(&s->points[i]));
  return best;
}

/* Whether a gap jumps and may hold more than the best value known. */
static int promising(const search *s, size_t i, double best)
{
  const pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
  return kind_of(a, b) == GAP_JUMP && bound_of(a, b) > best;
}

/* Whether a gap has to be looked into further. */
static int open_gap(const search *s, size_t i, double best)
{
  const double width = frequency_of(&s->points[i + 1]) - frequency_of(&s->points[i]);
  return width > narrow && promising(s, i, best);
}

/* The largest bound of all gaps that are still open; minus infinity if none is. */
static double largest_bound(const search *s, double best)
{
  double largest = -INFINITY;
  for (size_t i = 0; i + 1 < s->count; i++)
    if (open_gap(s, i, best)) largest = fmax(largest, bound_of(&s->points[i], &s->points[i + 1]));
  return largest;
}

/*
 * Look for a fold in the most promising gap that was not searched yet, however narrow: it takes
 * the place of the many frequencies close to it, where a ghost slows everything down. *sought:
 * there was such a gap; *found: one was added.
 */
static pendres_status add_fold(search *s, int *sought, int *found)
{
  const double best = best_area(s);
  size_t gap = s->count;
  double largest = -INFINITY;
  *found = 0;
  for (size_t i = 0; i + 1 < s->count; i++) {
    const pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
    if (!promising(s, i, best) || a->fold_sought || a->at_fold || b->at_fold) continue;
    if (bound_of(a, b) > largest) {
      largest = bound_of(a, b);
      gap = i;
    }
  }
  *sought = gap < s->count;
  if (!*sought) return PENDRES_OK;
  pendres_scan_point in[2];
  s->points[gap].fold_sought = 1;
  pendres_status status = pendres_resonance_find_fold(s->ctx, s->ensemble, &s->points[gap],
                                                      &s->points[gap + 1], in, found);
  if (status == PENDRES_OK && *found) status = check_room(s, 2);
  if (status != PENDRES_OK || !*found) return status;
  s->points[s->count++] = in[0];
  s->points[s->count++] = in[1];
  qsort(s->points, s->count, sizeof *s->points, by_frequency);
  return PENDRES_OK;
}

/*
 * Look into every gap that jumps and may hold more than the best value known, the most promising
 * first, until none is left but narrow ones.
 */
static pendres_status resolve_jumps(search *s)
{
  for (;;) {
    double omega[MOST_POINTS];
    size_t n = 0;
    int sought = 0, found = 0;
    pendres_status status = add_fold(s, &sought, &found);
    if (status != PENDRES_OK) return status;
    if (found) continue;
    const double best = best_area(s), largest = largest_bound(s, best);
    if (largest == -INFINITY && sought) continue;
    if (largest == -INFINITY) return PENDRES_OK;
    for (size_t i = 0; i + 1 < s->count; i++) {
      const pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
      const double width = frequency_of(b) - frequency_of(a);
      /* Those that promise little may be ruled out by what the others turn up. */
      if (!open_gap(s, i, best) || bound_of(a, b) < 0.5 * (best + largest)) continue;
      for (int k = 1; k < SECTIONS && n < MOST_POINTS; k++)
        omega[n++] = frequency_of(a) + width * k / SECTIONS;
    }
    status = add_points(s, n, omega);
    if (status != PENDRES_OK) return status;
  }
}

/* The best of all smooth peaks and edges. *again: a jump turned up, to be resolved first. */
static pendres_status choose(search *s, pendres_resonance *out, int *again)
{
  pendres_status status = PENDRES_OK;
  int found = 0;

  *again = 0;
  out->loop_area = -INFINITY;
  for (size_t i = 0; i + 1 < s->count && status == PENDRES_OK; i++) {
    pendres_scan_point *a = &s->points[i], *b = &s->points[i + 1];
    const gap_kind kind = kind_of(a, b);
    pendres_resonance one;
    if (a->at_fold && certain_area(a) >= best_area(s)) {
      status = pendres_resonance_at_fold(s->ctx, a, &one);
      /* As large: the gap before it was cut down to the same fold, less exactly. */
      if (status == PENDRES_OK && one.loop_area >= out->loop_area) {
        *out = one;
        found = 1;
      }
    }
    if (status != PENDRES_OK || kind == GAP_PLAIN) continue;
    if (bound_of(a, b) < fmax(best_area(s), out->loop_area)) continue;
    status = kind == GAP_PEAK
               ? pendres_resonance_refine_peak(s->ctx, s->ensemble, a, b, &one)
               : pendres_resonance_refine_edge(s->ctx, s->ensemble, a, b, &one);
    if (status == PENDRES_NOT_FOUND) {
      /* The slope changes its sign without a zero: there is a jump in between after all. */
      a->jump_to_next = 1;
      *again = 1;
      return PENDRES_OK;
    }
    if (status == PENDRES_OK && one.loop_area - one.loop_area_error > out->loop_area) {
      *out = one;
      found = 1;
    }
  }
  if (status != PENDRES_OK) return status;
  const pendres_scan_point *first = &s->points[0], *last = &s->points[s->count - 1];
  const double ends =
    fmax(first->response.mean_loop_area, last->response.mean_loop_area);
  if (!found || ends > out->loop_area) {
    const int low = first->response.mean_loop_area >= last->response.mean_loop_area;
    return pendres_context_fail(
      s->ctx, PENDRES_NOT_FOUND,
      "damping %g, drive amplitude %g: the loop area is largest at the %s end of the range, "
      "drive frequency %g", s->pendulum.damping, s->pendulum.drive_amplitude,
      low ? "lower" : "upper", frequency_of(low ? first : last));
  }
  return PENDRES_OK;
}

/* A state that is alone at the resonance has its name from the other frequencies. */
static pendres_status name_states(const search *s, pendres_response *r)
{
  const pendres_response *line[MOST_POINTS];
  pendres_label_border border;
  if (!pendres_response_nameless(r)) return PENDRES_OK;
  for (size_t i = 0; i < s->count; i++) line[i] = &s->points[i].response;
  const pendres_status status = pendres_response_border(s->ctx, s->count, line, &border);
  if (status == PENDRES_OK) pendres_response_name_by(&border, r);
  return status;
}

static pendres_status resonance_find_ensemble(pendres_context *ctx, const pendres_pendulum *p,
                                              double lowest, double highest,
                                              const pendres_ensemble *ensemble,
                                              pendres_resonance *out)
{
  if (p == NULL || ensemble == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, ensemble and out");
  if (!(lowest > 0.0 && highest > lowest && isfinite(highest)))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "the range of frequencies must be positive and ascending");
  const char *why = NULL;
  for (int i = 0; i < 2 && why == NULL; i++) {
    pendres_pendulum at = *p;
    at.drive_frequency = i == 0 ? lowest : highest;
    if (pendres_pendulum_check(&at, &why) == PENDRES_OK)
      why = pendres_strobe_refuses(&at, fmax(fabs(ensemble->x_first), fabs(ensemble->x_last)),
                                   ensemble->v);
  }
  if (ensemble->members < 1) why = "an ensemble needs members";
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  search s = {.ctx = ctx, .pendulum = *p, .ensemble = ensemble};
  s.points = malloc(MOST_POINTS * sizeof *s.points);
  if (s.points == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a resonance");

  double omega[SCAN_POINTS];
  for (int i = 0; i < SCAN_POINTS; i++)
    omega[i] = lowest + (highest - lowest) * i / (SCAN_POINTS - 1);
  memset(out, 0, sizeof *out);
  pendres_status status = add_points(&s, SCAN_POINTS, omega);
  for (int again = 1; again && status == PENDRES_OK;) {
    status = resolve_jumps(&s);
    if (status == PENDRES_OK) status = choose(&s, out, &again);
  }
  if (status == PENDRES_OK) status = name_states(&s, &out->response);
  free(s.points);
  return status;
}

pendres_status pendres_resonance_find_ensemble(pendres_context *ctx, const pendres_pendulum *p,
                                               double lowest, double highest,
                                               const pendres_ensemble *ensemble,
                                               pendres_resonance *out)
{
  return PENDRES_CONTEXT_CALL(ctx, resonance_find_ensemble(ctx, p, lowest, highest, ensemble, out));
}

static pendres_status resonance_find(pendres_context *ctx, const pendres_pendulum *p, double lowest,
                                     double highest, pendres_resonance *out)
{
  const pendres_ensemble e = pendres_ensemble_default();
  return pendres_resonance_find_ensemble(ctx, p, lowest, highest, &e, out);
}

pendres_status pendres_resonance_find(pendres_context *ctx, const pendres_pendulum *p,
                                      double lowest, double highest, pendres_resonance *out)
{
  return PENDRES_CONTEXT_CALL(ctx, resonance_find(ctx, p, lowest, highest, out));
}
