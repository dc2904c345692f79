/*
 * profile.c -- chi-square followed along what derivatives do not determine; see solve.h.
 *
 * A product of unknowns, as of a start and a scale, may be all that data tell. Where these change
 * by factors the others change with them, along a curve: derivatives at one of its points tell the
 * others' errors there, and not how far they move. So wherever chi-square is no parabola within two
 * errors one of the unknowns is given value after value, the others are fitted, and an error is no
 * less than what a value moves by until chi-square has grown by 1. Source: Venzon and Moolgavkar,
 * Applied Statistics 37 (1988) 87.
 */
#include "analysis/fit/solve.h"

#include <math.h>
#include <string.h>

typedef fit_profile_place place;

typedef struct profile {
  fit_problem *whole, rest; /* rest: without the unknown that is given */
  fit_free free[FIT_QUANTITIES], *given;
  fit_result *best, *work;
  fit_profile *s;
} profile;

/* Begin with each value going on as before, by factors where it keeps its sign. */
static void predict(const fit_profile *s, const fit_problem *rest, place *next)
{
  const place *last = &s->at[s->count - 1], *before = s->count > 1 ? last - 1 : last;
  const double part = last != before ? s->step / fabs(last->along - before->along) : 0.0;
  *next = *last;
  for (size_t i = 0; i < rest->unknowns; i++) {
    const int q = rest->free[i].quantity;
    const double a = before->v[q], b = last->v[q];
    next->v[q] = a * b > 0.0 ? b * pow(b / a, part) : b + part * (b - a);
  }
}

/* Where a state can be kept: what was counted so far belongs to the whole problem. */
static void tell(profile *f)
{
  fit_problem *p = f->whole;
  p->evaluations = f->rest.evaluations;
  p->iterations = f->rest.iterations;
  p->between(p->search);
}

/* Fit the rest, if there is any; 0 where that is not possible, or the status ends all. */
static int fit_rest(profile *f, place *to, pendres_status *status)
{
  const fit_free *k = f->given;
  const double value = to->v[k->quantity], mean = k->prior, error = k->prior_error;
  if (f->rest.unknowns > 0) {
    memcpy(f->work->v, to->v, sizeof to->v);
    *status = pendres_fit_solve(&f->rest, FIT_PROFILE_ITERATIONS, f->work);
    if (*status != PENDRES_OK || !f->work->computed || !f->work->converged) return 0;
    memcpy(to->v, f->work->v, sizeof to->v);
  } else if (!pendres_fit_evaluate(&f->rest, to->v)) {
    *status = f->rest.status;
    return 0;
  }
  const double sum = f->rest.unknowns > 0 ? f->work->chi_square
                                          : pendres_fit_sum_of_squares(&f->rest);
  const double prior = error > 0.0 ? pow((value - mean) / error, 2.0) : 0.0;
  to->rise = (sum + prior - f->best->chi_square) / f->best->scatter;
  if (to->rise < f->s->lowest.rise - fit_converged) f->s->lowest = *to;
  return 1;
}

/* How a way ends. */
typedef enum { LOST, OPEN, CLOSED } ending;

/* Follow one way, until chi-square has grown or a bound is come to, or no further. */
static ending follow(profile *f, size_t k, pendres_status *status)
{
  fit_profile *s = f->s;
  if (s->count == 0) {
    s->step = fmin(0.5 * s->far[k], fit_profile_first);
    s->longest = fit_profile_long;
    s->at[s->count++] = (place){.along = 0.0};
    memcpy(s->at[0].v, f->best->v, sizeof s->at[0].v);
  }
  while (s->count < FIT_PROFILE_PLACES && fabs(s->at[s->count - 1].along) < fit_profile_end) {
    const place *last = &s->at[s->count - 1];
    const int q = f->given->quantity;
    place next;
    if (f->whole->m->decays) tell(f);
    predict(s, &f->rest, &next);
    next.along = last->along + s->way * s->step;
    next.v[q] = pendres_fit_moved(f->given, f->best->v[q], next.along);
    if (next.v[q] == last->v[q]) return CLOSED;
    const int found = fit_rest(f, &next, status);
    if (*status != PENDRES_OK) return LOST;
    if (!found || next.rise > last->rise + fit_profile_grows) {
      s->longest = s->step *= 0.5;
      if (s->step > fit_profile_short * fmin(1.0, s->far[k])) continue;
      return last->rise >= 1.0 ? CLOSED : LOST;
    }
    s->at[s->count++] = next;
    if (next.rise > fit_profile_rise) return CLOSED;
    s->step = fmin(2.0 * s->step, s->longest);
  }
  return OPEN;
}

/* Widen errors by how far values have moved, beyond what the covariance says of that; of what still
   moves, where the way has no end, nothing is known. */
static void widen(profile *f, size_t k, ending how)
{
  const place *at = f->s->at, *last = &at[f->s->count - 1], *half = last;
  const size_t n = f->whole->unknowns;
  const double *covariance = f->best->covariance;
  const int open = f->best->combination[f->s->by[k]].open;
  while (half > at && fabs(half->along) > 0.5 * fabs(last->along)) half--;
  for (size_t a = 0; a < n; a++) {
    const int q = f->whole->free[a].quantity;
    const double from = f->best->v[q], variance = covariance[a * n + a];
    double most = 0.0;
    for (size_t i = 0; i < f->s->count; i++)
      most = fmax(most, fabs(at[i].v[q] - from) / sqrt(fmax(1.0, at[i].rise)));
    const double moved = fabs(last->v[q] - from);
    const int goes_on = moved > fit_profile_ends * fabs(half->v[q] - from);
    if (how != CLOSED && goes_on && moved * moved > variance) most = INFINITY;
    most *= most;
    if (!open) most -= pow(covariance[a * n + k], 2.0) / covariance[k * n + k];
    f->best->spread[a] = fmax(f->best->spread[a], sqrt(fmax(0.0, most)));
  }
}

/* Follow all that is to be followed, both ways. */
static pendres_status follow_all(fit_problem *p, profile *f)
{
  fit_profile *s = f->s;
  pendres_status status = PENDRES_OK;
  for (; s->next < p->unknowns && status == PENDRES_OK; s->next++, s->way = -1) {
    const size_t k = s->next;
    if (!(s->far[k] > 0.0)) continue;
    for (; s->way <= 1 && status == PENDRES_OK; s->way += 2) {
      f->rest = *p;
      f->rest.free = f->free;
      f->rest.unknowns = 0;
      for (size_t i = 0; i < p->unknowns; i++)
        if (i != k) f->free[f->rest.unknowns++] = p->free[i];
      f->given = &p->free[k];
      if (!p->m->decays) tell(f);
      pendres_fit_forget(&f->rest);
      const ending how = follow(f, k, &status);
      if (status == PENDRES_OK) widen(f, k, how);
      s->whole &= how != LOST;
      s->count = 0;
      p->evaluations = f->rest.evaluations;
      p->iterations = f->rest.iterations;
      p->known = 0;
    }
  }
  return status;
}

/* ---- what is followed ---- */

/* Whether chi-square is no parabola along a combination, two errors away either way. */
static int is_bent(fit_problem *p, const fit_result *best, const fit_combination *c)
{
  const double errors = 2.0 * sqrt(best->scatter);
  for (int way = -1; way <= 1; way += 2) {
    fit_values v;
    memcpy(v, best->v, sizeof v);
    for (size_t k = 0; k < p->unknowns; k++) {
      const fit_free *f = &p->free[k];
      v[f->quantity] += way * errors * c->change[k];
      if (f->form == FIT_LOGARITHM && !(v[f->quantity] > 0.0)) return 1;
      if (f->form == FIT_SINE && !(v[f->quantity] > f->low && v[f->quantity] < f->high)) return 1;
    }
    if (!pendres_fit_evaluate(p, v)) return 1;
    const double rise = pendres_fit_sum_of_squares(p) - best->chi_square;
    if (fabs(rise / (errors * errors) - 1.0) > fit_bent) return 1;
  }
  return 0;
}

/* The unknowns that are to be given: of each combination the one that changes most, as the solver
   sees it. Returns whether there are any. */
static int choose(fit_problem *p, profile *f)
{
  int any = 0;
  memset(f->s->far, 0, sizeof f->s->far);
  for (size_t c = 0; c < f->best->combinations; c++) {
    const fit_combination *of = &f->best->combination[c];
    size_t most = p->unknowns;
    double largest = 0.0;
    for (size_t k = 0; k < p->unknowns; k++) {
      const double seen = pendres_fit_seen(&p->free[k], f->best->v[p->free[k].quantity],
                                           of->change[k], of->open);
      if (p->free[k].at_bound || !(seen > largest)) continue;
      most = k;
      largest = seen;
    }
    const int followed = of->open || (largest > fit_far && is_bent(p, f->best, of));
    if (most == p->unknowns || !followed) continue;
    f->s->far[most] = fmax(f->s->far[most], of->open ? INFINITY : largest);
    f->s->by[most] = c;
    any = 1;
  }
  return any;
}

pendres_status pendres_fit_profile(fit_problem *p, int iterations, fit_profile *s,
                                   fit_result *best, fit_result *work)
{
  profile f = {.whole = p, .best = best, .work = work, .s = s};
  pendres_status status = PENDRES_OK;
  int followed = 1;
  if (!s->begun) s->again = 0;
  for (; s->again < FIT_AGAIN && status == PENDRES_OK; s->again++) {
    if (!s->begun) {
      *s = (fit_profile){.again = s->again, .whole = 1, .way = -1};
      followed = choose(p, &f);
      status = p->status;
    }
    if (!followed || status != PENDRES_OK) break;
    s->begun = 1;
    status = follow_all(p, &f);
    if (status != PENDRES_OK || s->lowest.along == 0.0) break;
    s->begun = 0;
    memcpy(best->v, s->lowest.v, sizeof best->v);
    status = pendres_fit_solve(p, iterations, best);
  }
  s->begun = 0;
  if (s->again == FIT_AGAIN) { /* better values each time: of the last ones nothing is known */
    best->converged = best->determined = 0;
    for (size_t k = 0; k < p->unknowns; k++) best->spread[k] = INFINITY;
    return status;
  }
  /* Where a solver stalls in a long valley this tells that it is at the lowest place. */
  best->converged |= followed && s->whole && s->lowest.along == 0.0;
  best->determined = 1;
  for (size_t k = 0; k < p->unknowns; k++) {
    best->determined &= isfinite(best->spread[k]) != 0;
    if (s->far[k] > 0.0) best->combination[s->by[k]].open = !isfinite(best->spread[k]);
  }
  return status;
}
