/* gap.c -- what may happen between two frequencies of a search; see search.h. */
#include "analysis/resonance/numbers.h"
#include "analysis/resonance/response_parts.h"
#include "analysis/resonance/search.h"

#include <math.h>
#include <string.h>

#include "model/model.h"
#include "orbits/orbit_same.h"
#include "settling/attractor_set.h"

enum { MOST_FAMILIES = 2 * PENDRES_RESPONSE_STATES };

/* A state at one or both ends of a gap. */
typedef struct family {
  double area[2], slope[2];
  double residual; /* how far its area may be from what the values and slopes at the ends say */
  double middle;   /* its area in between, to compare it with others */
} family;

/* The states of a gap, and where those of its ends are among them. */
typedef struct families {
  size_t count;
  family of[MOST_FAMILIES];
  int at[2][PENDRES_RESPONSE_STATES];
} families;

/*
 * Whether an orbit continues from one frequency to the next: its Poincaré point has moved according
 * to the slopes at both ends. On a branch that bends sharply it has not, and the gap is divided. At
 * a bifurcation there is no slope: states that branch off there move as the root of the distance,
 * twice as far as follows from the slope at the other end.
 */
static int goes_on(const pendres_orbit *a, const pendres_orbit *b)
{
  const double step = b->pendulum.drive_frequency - a->pendulum.drive_frequency;
  double by[2];
  for (int k = 0; k < 2; k++) {
    const double p = a->frequency_derivative[k], q = b->frequency_derivative[k];
    by[k] = isnan(p) ? 2.0 * q : isnan(q) ? 2.0 * p : 0.5 * (p + q);
  }
  const double dx = step * by[0], dv = step * by[1];
  const pendres_pendulum *p = &a->pendulum;
  const double off = pendres_model_distance(p, b->x - a->x - dx, b->v - a->v - dv);
  return a->period == b->period && a->winding == b->winding &&
         off <= 0.05 + 0.25 * pendres_model_distance(p, dx, dv);
}

/* Chaos at both ends is taken for one attractor when its areas agree within their errors, and so
   are rotations without a lock that turn the same way. */
static int open_goes_on(const pendres_attractor *a, const pendres_attractor *b)
{
  if (pendres_attractor_closes(a) || a->label != b->label) return 0;
  if (a->label != PENDRES_LABEL_CHAOTIC) return a->drift * b->drift > 0.0;
  return fabs(a->orbit.loop_area - b->orbit.loop_area) <=
           surely * (a->orbit.loop_area_error + b->orbit.loop_area_error);
}

static family both_ends(const pendres_attractor *a, const pendres_attractor *b, double width)
{
  const pendres_orbit *p = &a->orbit, *q = &b->orbit;
  family f = {.area = {p->loop_area, q->loop_area},
              .slope = {p->loop_area_slope, q->loop_area_slope}};
  if (!pendres_attractor_closes(a)) f.slope[0] = f.slope[1] = 0.0;
  /* A slope that is not known is that of a parabola. */
  for (int e = 0; e < 2; e++)
    if (isnan(f.slope[e])) f.slope[e] = 2.0 * (f.area[1] - f.area[0]) / width - f.slope[1 - e];
  f.residual = fabs(f.area[1] - f.area[0] - 0.5 * width * (f.slope[0] + f.slope[1]));
  if (a->label == PENDRES_LABEL_CHAOTIC)
    f.residual = surely * (p->loop_area_error + q->loop_area_error);
  f.middle = 0.5 * (f.area[0] + f.area[1]);
  return f;
}

/*
 * A state that is known at one end only. Its area is taken to grow with its slope, and never to
 * shrink; but by no more than a quarter, as the slope may be steep close to a fold.
 */
static family one_end(const pendres_orbit *o, int end, double width)
{
  family f = {.area = {o->loop_area, o->loop_area}};
  const double most = 0.25 * fabs(o->loop_area);
  double grown = most;
  if (isfinite(o->loop_area_slope)) {
    grown = fmin(fmax((end == 0 ? width : -width) * o->loop_area_slope, 0.0), most);
    f.residual = fmin(0.25 * width * fabs(o->loop_area_slope), most);
  }
  f.area[1 - end] += grown;
  f.slope[0] = f.slope[1] = (f.area[1] - f.area[0]) / width;
  f.middle = 0.5 * (f.area[0] + f.area[1]);
  return f;
}

/* A state whose mirror image comes before it in the list is that image: areas are the same. */
static int image_of(const pendres_response *r, size_t i)
{
  if (!pendres_pendulum_symmetric(&r->pendulum)) return -1;
  for (size_t k = 0; k < i; k++)
    if (pendres_orbit_are_images(&r->state[k].orbit, &r->state[i].orbit)) return (int)k;
  return -1;
}

/* Let mirror images count as one state. */
static void merge_images(const pendres_response *const of[2], families *all)
{
  for (int e = 0; e < 2; e++)
    for (size_t i = 0; i < of[e]->states; i++) {
      const int image = image_of(of[e], i);
      if (image >= 0) all->at[e][i] = all->at[e][image];
    }
}

/* The states of both ends; 1 if one with members is at one end only. */
static int find_families(const pendres_response *a, const pendres_response *b, double width,
                         families *all)
{
  int taken[PENDRES_RESPONSE_STATES] = {0}, alone = 0;
  all->count = 0;
  for (size_t i = 0; i < a->states; i++) {
    int match = -1;
    for (size_t j = 0; j < b->states && match < 0; j++)
      if (!taken[j] && (goes_on(&a->state[i].orbit, &b->state[j].orbit) ||
                        open_goes_on(&a->state[i], &b->state[j])))
        match = (int)j;
    if (match >= 0) {
      taken[match] = 1;
      all->at[1][match] = (int)all->count;
      all->of[all->count] = both_ends(&a->state[i], &b->state[match], width);
    } else {
      alone = 1;
      all->of[all->count] = one_end(&a->state[i].orbit, 0, width);
    }
    all->at[0][i] = (int)all->count++;
  }
  for (size_t j = 0; j < b->states; j++) {
    if (taken[j]) continue;
    alone = 1;
    all->at[1][j] = (int)all->count;
    all->of[all->count++] = one_end(&b->state[j].orbit, 1, width);
  }
  merge_images((const pendres_response *const[2]){a, b}, all);
  for (size_t i = 0; i < all->count; i++)
    if (!isfinite(all->of[i].middle)) all->of[i] = (family){.middle = -INFINITY};
  return alone;
}

/* In place of a family: not known; that of a member without an area; none was asked for. */
enum { UNKNOWN = -1, GONE = PENDRES_RESPONSE_GONE, NONE = -3 };

static int state_of(const pendres_scan_point *p, size_t k)
{
  return p->where != NULL ? p->where[k] : UNKNOWN;
}

/* The family that member k is on at an end. */
static int family_at(const families *all, const pendres_scan_point *p, int end, size_t k)
{
  const int state = state_of(p, k), f = state < 0 ? state : all->at[end][state];
  return f >= 0 && !isfinite(all->of[f].middle) ? UNKNOWN : f;
}

/* The one of two families with the larger area; one that is not known may be larger than any. */
static int larger_of(const families *all, int f, int g)
{
  if (f == UNKNOWN || g == UNKNOWN) return UNKNOWN;
  if (f < 0 || g < 0) return f > g ? f : g;
  return all->of[g].middle > all->of[f].middle ? g : f;
}

/* What a member adds to the mean at an end: without an area it does not move that. */
static double worth(const families *all, int f, const pendres_scan_point *end)
{
  return f >= 0 ? all->of[f].middle : f == GONE ? end->response.mean_loop_area : NAN;
}

/* A mean area at both ends with its slopes. */
typedef struct curve {
  double area[2], slope[2], residual;
} curve;

/* The largest value between the ends of a curve. */
static double largest_between(const curve *c, double width)
{
  const double ends = fmax(c->area[0], c->area[1]), rise = c->area[1] - c->area[0];
  const double a = c->slope[0], b = c->slope[1];
  if (a > 0.0 && b < 0.0) {
    const double t = (rise - b * width) / (a - b);
    return t > 0.0 && t < width ? fmax(ends, c->area[0] + a * t) + c->residual
                                : ends + c->residual;
  }
  /* Slopes of one sign, and none too steep for a cubic through both ends to be monotone: Fritsch
     and Carlson, SIAM J. Numer. Anal. 17 (1980) 238. */
  if (a * rise >= 0.0 && b * rise >= 0.0 && fabs(a * width) <= 3.0 * fabs(rise) &&
      fabs(b * width) <= 3.0 * fabs(rise))
    return ends;
  if (a <= 0.0 && b >= 0.0 && c->residual <= 0.2 * width * (b - a)) return ends;
  return ends + c->residual;
}

/* On whose states a member may be: its own; those of the members beside it, too, if these change
   theirs; or in any case. */
typedef enum reach { OWN, MOVED, BESIDE } reach;

/* What the members do in a gap. */
typedef struct census {
  size_t on[MOST_FAMILIES];   /* each on the largest state that it may be on */
  size_t free[MOST_FAMILIES]; /* those of them that may have no area, too */
  size_t unknown;
  int up, down, loose;
} census;

/*
 * Each member is on one of the two states that it is on at the ends. In a wide gap it may also be
 * on a state of the members beside it, since a basin's boundary may have come by and gone back; in
 * one that is not so wide, only where the boundary has moved. The members at a fold's own point,
 * which lies on the far side of the jump, are not used for the gap.
 */
static void count_members(const families *all, const pendres_scan_point *const end[2], reach far,
                          const int asked[2], size_t members, census *c)
{
  const int wide = far != OWN;
  *c = (census){.up = 0};
  for (size_t k = 0; k < members; k++) {
    int largest = NONE, stays = NONE, own[2], gone = 0;
    for (int e = 0; e < 2; e++) {
      own[e] = family_at(all, end[e], e, k);
      if (!asked[e]) continue;
      stays = larger_of(all, stays, own[e]);
      for (size_t j = wide && k > 0 ? k - 1 : k; j <= k + (size_t)wide && j < members; j++) {
        const int f = family_at(all, end[e], e, j);
        if (far == MOVED && j != k && f == family_at(all, end[1 - e], 1 - e, j)) continue;
        largest = larger_of(all, largest, f);
        gone |= f == GONE;
        c->loose |= f == GONE && own[0] != GONE && own[1] != GONE;
      }
    }
    if (own[0] != own[1]) {
      const double first = worth(all, own[0], end[1]), last = worth(all, own[1], end[0]);
      c->up |= !(last <= first);
      c->down |= !(last > first);
    }
    c->loose |= largest != stays;
    if (largest == UNKNOWN)
      c->unknown++;
    else if (largest >= 0)
      (gone ? c->free : c->on)[largest]++;
  }
}

/* The family with the largest area of those with members that are still left; their number if none
   is. */
static size_t largest_left(const families *all, const size_t *left)
{
  size_t best = all->count;
  for (size_t i = 0; i < all->count; i++)
    if (left[i] > 0 && (best == all->count || all->of[i].middle > all->of[best].middle)) best = i;
  return best;
}

/*
 * How many members on each family make the mean largest; their sum. Members whose state is not
 * known may be on the largest one. Those that may have no area have one where it is above the mean.
 */
static size_t fill(const families *all, const census *c, size_t on[MOST_FAMILIES])
{
  size_t left[MOST_FAMILIES], counted = 0, top = 0;
  double sum = 0.0;
  memcpy(on, c->on, sizeof c->on);
  memcpy(left, c->free, sizeof left);
  for (size_t i = 1; i < all->count; i++)
    if (all->of[i].middle > all->of[top].middle) top = i;
  if (all->count > 0) on[top] += c->unknown;
  for (size_t i = 0; i < all->count; i++) {
    counted += on[i];
    if (on[i] > 0) sum += (double)on[i] * all->of[i].middle;
  }
  for (size_t i; (i = largest_left(all, left)) < all->count; left[i] = 0) {
    if (counted > 0 && !(all->of[i].middle * (double)counted > sum)) break;
    on[i] += left[i];
    counted += left[i];
    sum += (double)left[i] * all->of[i].middle;
  }
  return counted;
}

static double bound_of(const families *all, const census *c, double width, size_t *counted)
{
  curve mean = {.residual = 0.0};
  size_t on[MOST_FAMILIES];
  *counted = fill(all, c, on);
  if (*counted == 0) return -INFINITY;
  for (size_t i = 0; i < all->count; i++) {
    const family *f = &all->of[i];
    const double share = (double)on[i] / (double)*counted;
    if (on[i] == 0) continue;
    for (int e = 0; e < 2; e++) {
      mean.area[e] += share * f->area[e];
      mean.slope[e] += share * f->slope[e];
    }
    mean.residual += share * f->residual;
  }
  return largest_between(&mean, width);
}

void pendres_gap_look(const pendres_scan_point *a, const pendres_scan_point *b, size_t members,
                      pendres_gap *out)
{
  const pendres_scan_point *const end[2] = {a, b};
  const double omega = pendres_scan_frequency(a), width = pendres_scan_frequency(b) - omega;
  /* Over a fiftieth of the width over which the response changes boundaries move by the distance of
     members; over a fifth they may turn back. */
  const double change = pendres_search_width(&a->response.pendulum, omega);
  const double narrow = 0.02 * change, wide = 0.2 * change;
  const int at_fold = a->at_fold > 0 || b->at_fold < 0;
  const int asked[2] = {a->at_fold <= 0, b->at_fold >= 0};
  families all;
  census c;
  *out = (pendres_gap){.width = width};
  if (!(width > 0.0)) {
    out->around = out->bound = fmax(a->response.mean_loop_area, b->response.mean_loop_area);
    return;
  }
  const int alone = find_families(&a->response, &b->response, width, &all);
  count_members(&all, end, width > wide || at_fold ? BESIDE : width > narrow ? MOVED : OWN,
                asked, members, &c);
  out->around = out->bound = bound_of(&all, &c, width, &out->counted);
  out->loose = c.loose && width > narrow;
  out->changed = c.up || c.down;
  out->mixed = c.up && c.down;
  if (a->jump_to_next || alone || out->changed)
    out->kind = PENDRES_GAP_JUMP;
  else
    out->kind = a->slope > 0.0 && b->slope < 0.0 ? PENDRES_GAP_PEAK : PENDRES_GAP_PLAIN;
}

/* ---- states around a gap ---- */

/* The states of a point beside a gap, and how large the area of each may be in the gap. */
typedef struct beside {
  const pendres_scan_point *of;
  int family[PENDRES_RESPONSE_STATES]; /* which it is of the gap's; -1: none */
  double most[PENDRES_RESPONSE_STATES];
  double bound; /* of the gap, at the first point */
} beside;

/* Whether a state is another frequency's state, or its mirror image, whose area is the same, or
   what both become where they lose their symmetry, which bends the area. */
static int belongs(const pendres_attractor *state, const pendres_attractor *other)
{
  const pendres_orbit *o = &state->orbit, *e = &other->orbit;
  const double step = e->pendulum.drive_frequency - o->pendulum.drive_frequency;
  const double slope = fmax(fabs(o->loop_area_slope), fabs(e->loop_area_slope));
  if ((step > 0.0 ? goes_on(o, e) : goes_on(e, o)) || open_goes_on(state, other)) return 1;
  return pendres_pendulum_symmetric(&o->pendulum) && o->period == e->period &&
         fabs(e->loop_area - o->loop_area) <= gap_image * e->loop_area + fabs(step) * slope;
}

/* Put point number n beside a gap into out[], by the states of those nearer to it, of which the
   first is the gap's end. */
static void add_beside(const pendres_scan_point *p, int end, double reach, const families *all,
                       beside out[], size_t n)
{
  out[n].of = p;
  for (size_t i = 0; i < p->response.states; i++) {
    const pendres_attractor *state = &p->response.state[i];
    int known = 0;
    out[n].family[i] = -1;
    for (size_t k = n; k-- > 0 && !known;)
      for (size_t j = 0; j < out[k].of->response.states && !known; j++) {
        known = belongs(state, &out[k].of->response.state[j]);
        if (known) out[n].family[i] = out[k].family[j];
      }
    const int in_gap = out[n].family[i];
    const family f = in_gap < 0 ? one_end(&state->orbit, end, reach) : all->of[in_gap];
    out[n].most[i] = fmax(f.area[0], f.area[1]) + f.residual;
  }
}

/* The points on one side of a gap, from its end outwards, within a reach and up to a fold, which
   ends states. */
static size_t points_beside(const pendres_search *s, size_t i, int side, double reach,
                            const families *all, beside out[])
{
  const pendres_scan_point *near = &s->points[i + (size_t)side], *p = near;
  const pendres_scan_point *last = side ? &s->points[s->count - 1] : s->points;
  const double width = s->points[i].gap.width;
  size_t n = 1;
  out[0].of = near;
  out[0].bound = s->points[i].gap.bound;
  memcpy(out[0].family, all->at[side], sizeof out[0].family);
  for (; n < GAP_BESIDE && !p->at_fold && p != last; n++) {
    p += side ? 1 : -1;
    const double off = fabs(pendres_scan_frequency(p) - pendres_scan_frequency(near));
    if (p->at_fold || off > reach) break;
    add_beside(p, side, off + width, all, out, n);
  }
  return n;
}

/*
 * How much larger than `least` the states are that a member is on at n points on one side of a gap,
 * the first its end, other than own[]; without an area it leaves the mean. Where it changes its
 * state once there is a boundary of basins, and in a large ensemble the members beside it show
 * whether that comes back; where it changes `often`, basins alternate.
 */
static double larger_beside(const beside *near, size_t n, size_t member, const int own[2],
                            int often, double least)
{
  int changes = 0, before = 0;
  double most = 0.0;
  for (size_t j = 1; j < n; j++) {
    const int state = state_of(near[j].of, member);
    if (state == UNKNOWN) continue;
    const int family = state == GONE ? GONE : near[j].family[state];
    const int other = family == UNKNOWN || (family != own[0] && family != own[1]);
    changes += other != before;
    before = other;
    if (other) most = fmax(most, (state == GONE ? near->bound : near[j].most[state]) - least);
  }
  return changes >= often ? most : 0.0;
}

double pendres_gap_around(const pendres_search *s, size_t i, int far)
{
  const pendres_scan_point *const end[2] = {&s->points[i], &s->points[i + 1]};
  const pendres_gap *g = &end[0]->gap;
  const size_t members = s->ensemble->members;
  const int often = far || members > GAP_FEW ? 2 : 1;
  const double change = pendres_search_width(&s->pendulum, pendres_scan_frequency(end[0]));
  /* Where the search had to end, as far as if this gap were as wide as the response changes. */
  const double beyond = pendres_search_over(s) ? gap_around : gap_around_far;
  const double reach = fmax(gap_around * g->width, far ? beyond * change : 0.0);
  beside near[2][GAP_BESIDE];
  size_t n[2];
  families all;
  double more = 0.0, most[2] = {0.0};
  (void)find_families(&end[0]->response, &end[1]->response, g->width, &all);
  for (int e = 0; e < 2; e++) n[e] = points_beside(s, i, e, reach, &all, near[e]);
  for (size_t k = 0; k < members; k++) {
    const int own[2] = {family_at(&all, end[0], 0, k), family_at(&all, end[1], 1, k)};
    const int largest = larger_of(&all, own[0], own[1]);
    if (largest == UNKNOWN) continue; /* it may be on any state as it is */
    double least =
      largest < 0 ? g->bound : fmin(all.of[largest].area[0], all.of[largest].area[1]);
    if (own[0] == GONE || own[1] == GONE) least = fmax(least, g->bound);
    const double gain = fmax(larger_beside(near[0], n[0], k, own, often, least),
                             larger_beside(near[1], n[1], k, own, often, least));
    more += gain;
    most[1] = fmax(most[1], fmin(most[0], gain));
    most[0] = fmax(most[0], gain);
  }
  /* The largest area known is one of many. Another hardly has more than two members more on larger
     states, at once, than where the members are seen. */
  if (far) more = most[0] + most[1];
  return g->counted > 0 ? g->bound + more / (double)g->counted : g->bound;
}
