/* part.c -- the parts of a branch along which its orbits attract; see part.h. */
#include "continuation/part.h"

#include <math.h>

#include "base/angles.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "model/model.h"

static pendres_parameter parameter_of(const pendres_part *s)
{
  return pendres_curve_parameter(&s->branch->curve, 0);
}

const pendres_branch_point *pendres_part_point(const pendres_part *s, size_t k)
{
  const pendres_curve *c = &s->branch->curve;
  if (k >= c->count) return NULL;
  if (pendres_curve_closed(c))
    return &c->branch_point[(s->first + (s->step > 0 ? k : c->count - k)) % c->count];
  if (s->step < 0) return k <= s->first ? &c->branch_point[s->first - k] : NULL;
  return s->first + k < c->count ? &c->branch_point[s->first + k] : NULL;
}

double pendres_part_value(const pendres_part *s, size_t k)
{
  return pendres_parameter_get(parameter_of(s), &pendres_part_point(s, k)->orbit.pendulum);
}

double pendres_part_ahead(const pendres_part *s, double value, double of)
{
  return (double)s->direction * (value - of);
}

double pendres_part_same(const pendres_part *s)
{
  return curve_same_place * pendres_parameter_scale(parameter_of(s));
}

double pendres_part_margin(pendres_parameter parameter)
{
  return part_margin * pendres_parameter_scale(parameter);
}

pendres_branch_end pendres_part_branch_end(const pendres_part *s)
{
  return pendres_branch_end_get(s->branch, s->step > 0);
}

/* ---- close to bifurcations ---- */

double pendres_part_distance(const pendres_branch *branch, const pendres_branch_point *p,
                             const pendres_orbit *o)
{
  const pendres_parameter parameter = pendres_curve_parameter(&branch->curve, 0);
  const double x = pendres_less_turns(o->x - p->orbit.x, pendres_model_turn(&o->pendulum));
  const double dp = (pendres_parameter_get(parameter, &p->orbit.pendulum) -
                     pendres_parameter_get(parameter, &o->pendulum)) /
                    pendres_parameter_scale(parameter);
  return hypot(hypot(x, p->orbit.v - o->v), dp);
}

static int is_regular(const pendres_branch_point *p)
{
  return p->bifurcation < 0;
}

static const pendres_bifurcation *bifurcation_at(const pendres_part *s,
                                                 const pendres_branch_point *p)
{
  return &s->branch->curve.bifurcation[p->bifurcation];
}

/* Whether a point is so close to a bifurcation that its stability is a matter of rounding. */
static int is_beside(const pendres_part *s, const pendres_branch_point *p,
                     const pendres_bifurcation *at)
{
  return pendres_part_distance(s->branch, p, &at->orbit) < just_beyond / p->orbit.period;
}

/* Whether a real multiplier is so close to 1 or -1 that the errors of a point that only leads on
   decide. Of a complex pair damping decides. */
static int is_untold(const pendres_branch_point *p)
{
  const pendres_orbit *o = &p->orbit;
  return o->multiplier_im[0] == 0.0 && fabs(fabs(o->multiplier_re[0]) - 1.0) < curve_untold;
}

/* Whether point number k has such a bifurcation before it, with nothing in between but points as
   close. */
static int is_before_bifurcation(const pendres_part *s, size_t k)
{
  const pendres_branch_point *p = pendres_part_point(s, k), *q;
  while ((q = pendres_part_point(s, ++k)) != NULL && is_regular(q))
    if (pendres_part_distance(s->branch, q, &p->orbit) >= just_beyond / p->orbit.period) return 0;
  return q != NULL && is_beside(s, p, bifurcation_at(s, q));
}

/* ---- one way from a point ---- */

/* How far a part that ends before point number k may reach beyond its last point: as far as the
   points before and behind that. */
static double unlocated(const pendres_part *s, size_t k)
{
  const size_t last = s->points - 1;
  const double here = pendres_part_value(s, last), behind = fabs(pendres_part_value(s, k) - here);
  return last > 0 ? fmax(behind, fabs(here - pendres_part_value(s, last - 1))) : behind;
}

/* The square of the distance from the orbit that they are born from, for each unit of the
   parameter: near a birth that is a constant. */
static double spread(pendres_part *s, int step)
{
  const pendres_orbit *from = &pendres_part_point(s, 0)->orbit;
  const pendres_branch_point *p = NULL;
  s->step = step;
  for (size_t k = PART_SPREAD; k > 0 && p == NULL; k--) p = pendres_part_point(s, k);
  if (p == NULL) return INFINITY;
  const double x = pendres_less_turns(p->orbit.x - from->x, pendres_model_turn(&from->pendulum));
  const double v = p->orbit.v - from->v;
  const double ahead =
    pendres_part_ahead(s, pendres_parameter_get(parameter_of(s), &p->orbit.pendulum),
                       pendres_part_value(s, 0));
  return ahead > pendres_part_same(s) ? (x * x + v * v) / ahead : INFINITY;
}

int pendres_part_choose_way(pendres_part *s)
{
  const double same = pendres_part_same(s), from = pendres_part_value(s, 0);
  /* On both sides of a birth are the same orbits, at other points of theirs. */
  const int first = s->born && spread(s, -1) < spread(s, 1) ? -1 : 1;
  int back = 0;
  for (int way = 0; way < 2; way++) {
    s->step = way == 0 ? first : -first;
    for (size_t k = 1; pendres_part_point(s, k) != NULL; k++) {
      const double beyond = pendres_part_ahead(s, pendres_part_value(s, k), from);
      if (fabs(beyond) <= same) continue;
      if (beyond > 0.0) return 1;
      back++;
      break;
    }
  }
  s->points = 1;
  s->end = back == 2 ? PENDRES_PART_UNLOCATED : PENDRES_PART_STOPPED;
  s->end_value = from;
  s->end_error = pendres_part_margin(parameter_of(s));
  return 0;
}

/* Set the end of a part that neither has a point at its limit or beyond nor met a bifurcation: at
   its last point, or the limit where the branch is known as far. told: the number of the point
   behind the last, which is beyond the branch if that ends. */
static void end_at_last(pendres_part *s, size_t told, double limit)
{
  const int in_branch = pendres_part_point(s, told) != NULL;
  s->end_value = pendres_part_value(s, s->points - 1);
  s->end_error = in_branch ? unlocated(s, told) : pendres_part_margin(parameter_of(s));
  s->end = in_branch                                          ? PENDRES_PART_UNLOCATED
           : pendres_part_branch_end(s) == PENDRES_END_RANGE ? PENDRES_PART_LIMIT
                                                              : PENDRES_PART_STOPPED;
  if (s->end == PENDRES_PART_LIMIT) s->end_value = limit;
}

size_t pendres_part_take(pendres_part *s, double limit)
{
  const pendres_branch_point *p = NULL;
  const pendres_bifurcation *met = NULL; /* the latest, where it is not known yet what follows */
  const double same = pendres_part_same(s);
  size_t met_at = 0, k = 1;
  int turned = 0;
  s->points = 1;
  for (; (p = pendres_part_point(s, k)) != NULL; k++) {
    if (!is_regular(p)) {
      if (bifurcation_at(s, p)->curvature == 0.0) continue; /* a cusp */
      met = bifurcation_at(s, p);
      met_at = k;
      if (met->kind == PENDRES_FOLD) break;
      continue;
    }
    /* Next to a bifurcation, at the beginning or on the way, stability is a matter of rounding. */
    const double here = pendres_part_value(s, k);
    const double before = met != NULL ? met->value : pendres_part_value(s, s->points - 1);
    if ((s->points == 1 || met != NULL) && fabs(here - before) <= same) continue;
    if ((met != NULL && is_beside(s, p, met)) || is_before_bifurcation(s, k)) continue;
    turned = pendres_part_ahead(s, here, before) < -same;
    if (!turned && is_untold(p)) continue;
    if (!p->orbit.stable || turned) break;
    met = NULL;
    s->points = k + 1;
    if (pendres_part_ahead(s, here, limit) >= 0.0) {
      s->end = PENDRES_PART_LIMIT;
      s->end_value = limit;
      s->end_error = 0.0;
      return k;
    }
  }
  end_at_last(s, k, limit);
  /* What happens at a bifurcation right before the computation stopped is told by what follows. */
  if (met == NULL || (p == NULL && pendres_part_branch_end(s) == PENDRES_END_POINTS)) return k;
  s->end = turned ? PENDRES_PART_BIRTH : PENDRES_PART_BIFURCATION;
  s->bifurcation = *met;
  s->end_value = met->value;
  s->end_error = met->value_error;
  s->points = met_at + 1;
  return k;
}

/* ---- all parts ---- */

/* The parameter's direction on the way from the first point of a part. */
static int direction_of(const pendres_part *s)
{
  const double same = pendres_part_same(s), from = pendres_part_value(s, 0);
  for (size_t k = 1; pendres_part_point(s, k) != NULL; k++) {
    const double beyond = pendres_part_value(s, k) - from;
    if (fabs(beyond) > same) return beyond > 0.0 ? 1 : -1;
  }
  return 1;
}

/* Number of the point at which the part ends one way from a point within it. */
static size_t end_of(pendres_branch *b, size_t i, int step)
{
  pendres_part s = {.branch = b, .first = i, .step = step};
  s.direction = direction_of(&s);
  (void)pendres_part_take(&s, s.direction * INFINITY);
  return step > 0 ? i + s.points - 1 : i - (s.points - 1);
}

/* Whether a point attracts, and is not so close to a bifurcation that rounding decides it. */
static int attracts(pendres_branch *b, size_t i)
{
  const pendres_part back = {.branch = b, .first = i, .step = -1};
  const pendres_part forth = {.branch = b, .first = i, .step = 1};
  const pendres_branch_point *p = &b->curve.branch_point[i];
  return is_regular(p) && p->orbit.stable && !is_before_bifurcation(&back, 0) &&
         !is_before_bifurcation(&forth, 0);
}

size_t pendres_branch_parts(const pendres_branch *branch, size_t room, pendres_branch_part *out)
{
  size_t n = 0;
  if (branch == NULL) return 0;
  /* The list of points, cut where a branch that closes begins. */
  pendres_branch list = *branch;
  list.curve.end[0] = list.curve.end[1] = PENDRES_END_RANGE;
  for (size_t i = 0; i < list.curve.count; i++) {
    if (!attracts(&list, i)) continue;
    pendres_branch_part part = {.first = end_of(&list, i, -1), .last = end_of(&list, i, 1)};
    part.begins = list.curve.branch_point[part.first].kind;
    part.ends = list.curve.branch_point[part.last].kind;
    if (n < room && out != NULL) out[n] = part;
    n++;
    i = part.last;
  }
  return n;
}
