/*
 * profile.c -- chi-square followed along what derivatives do not determine; see solve.h.
 *
 * A product of unknowns, as of a start and a scale, may be all that data tell. Where these change
 * by factors the others change with them, along a curve: derivatives at one of its points tell the
 * others' errors there, and not how far they move. So one of the unknowns is given value after
 * value, the others are fitted, and an error is no less than what a value moves by until chi-square
 * has grown by 1. Source: Venzon and Moolgavkar, Applied Statistics 37 (1988) 87.
 */
#include "analysis/fit/solve.h"

#include <math.h>
#include <string.h>

typedef struct place {
  double along; /* the logarithm of the unknown that is given, from the best values on */
  double rise;  /* of chi-square, in units of what one error makes */
  fit_values v;
} place;

typedef struct profile {
  fit_problem *whole, rest; /* rest: without the unknown that is given */
  fit_free free[FIT_QUANTITIES], *given;
  fit_result *best, *work;
  double first;  /* step */
  place lowest;  /* where chi-square is lower than at the best values, if it is anywhere */
  size_t count;
  place at[FIT_PROFILE_PLACES];
} profile;

/* Begin with each value going on as before, by factors where it keeps its sign. */
static void predict(const profile *f, double step, place *next)
{
  const place *last = &f->at[f->count - 1], *before = f->count > 1 ? last - 1 : last;
  const double part = last != before ? step / fabs(last->along - before->along) : 0.0;
  *next = *last;
  for (size_t i = 0; i < f->rest.unknowns; i++) {
    const int q = f->rest.free[i].quantity;
    const double a = before->v[q], b = last->v[q];
    next->v[q] = a * b > 0.0 ? b * pow(b / a, part) : b + part * (b - a);
  }
}

/* Fit the rest; 0 where that is not possible, or the status ends all. */
static int fit_rest(profile *f, place *to, pendres_status *status)
{
  const fit_free *k = f->given;
  const double value = to->v[k->quantity], mean = k->prior, error = k->prior_error;
  memcpy(f->work->v, to->v, sizeof to->v);
  *status = pendres_fit_solve(&f->rest, FIT_PROFILE_ITERATIONS, f->work);
  if (*status != PENDRES_OK || !f->work->computed || !f->work->converged) return 0;
  memcpy(to->v, f->work->v, sizeof to->v);
  const double prior = error > 0.0 ? pow((value - mean) / error, 2.0) : 0.0;
  to->rise = (f->work->chi_square + prior - f->best->chi_square) / f->best->scatter;
  if (to->rise < f->lowest.rise - fit_converged) f->lowest = *to;
  return 1;
}

/* How a way ends. */
typedef enum { LOST, OPEN, CLOSED } ending;

/* Follow one way, until chi-square has grown or a bound is come to, or no further. */
static ending follow(profile *f, int way, pendres_status *status)
{
  double step = f->first, longest = fit_profile_long;
  f->count = 1;
  f->at[0] = (place){.along = 0.0};
  memcpy(f->at[0].v, f->best->v, sizeof f->at[0].v);
  while (f->count < FIT_PROFILE_PLACES && fabs(f->at[f->count - 1].along) < fit_profile_end) {
    const place *last = &f->at[f->count - 1];
    const int q = f->given->quantity;
    place next;
    predict(f, step, &next);
    next.along = last->along + way * step;
    next.v[q] = pendres_fit_moved(f->given, last->v[q], way * step);
    if (next.v[q] == last->v[q]) return CLOSED;
    const int found = fit_rest(f, &next, status);
    if (*status != PENDRES_OK) return LOST;
    if (!found || next.rise > last->rise + fit_profile_grows) {
      longest = step *= 0.5;
      if (step > fit_profile_short) continue;
      return last->rise >= 1.0 ? CLOSED : LOST;
    }
    f->at[f->count++] = next;
    if (next.rise > fit_profile_rise) return CLOSED;
    step = fmin(2.0 * step, longest);
  }
  return OPEN;
}

/* Widen errors by how far values have moved; of what still moves, where the way has no end, nothing
   is known. */
static void widen(profile *f, ending how)
{
  const place *last = &f->at[f->count - 1], *half = last;
  const size_t n = f->whole->unknowns;
  while (half > f->at && fabs(half->along) > 0.5 * fabs(last->along)) half--;
  for (size_t a = 0; a < n; a++) {
    const int q = f->whole->free[a].quantity;
    const double from = f->best->v[q], variance = f->best->covariance[a * n + a];
    double most = 0.0;
    for (size_t i = 0; i < f->count; i++)
      most = fmax(most, fabs(f->at[i].v[q] - from) / sqrt(fmax(1.0, f->at[i].rise)));
    const double moved = fabs(last->v[q] - from);
    const int goes_on = moved > fit_profile_ends * fabs(half->v[q] - from);
    if (how != CLOSED && goes_on && moved * moved > variance) most = INFINITY;
    most = most * most - f->best->weak[a];
    f->best->spread[a] = fmax(f->best->spread[a], sqrt(fmax(0.0, most)));
  }
}

/* Follow all that is far, both ways; *whole: none was lost. */
static pendres_status follow_all(fit_problem *p, profile *f, int *whole)
{
  pendres_status status = PENDRES_OK;
  f->lowest = (place){.along = 0.0};
  *whole = 1;
  for (size_t k = 0; k < p->unknowns && status == PENDRES_OK; k++) {
    if (!(f->best->far[k] > 0.0)) continue;
    f->rest = *p;
    f->rest.free = f->free;
    f->rest.unknowns = 0;
    for (size_t i = 0; i < p->unknowns; i++)
      if (i != k) f->free[f->rest.unknowns++] = p->free[i];
    f->given = &p->free[k];
    f->first = fmin(0.5 * f->best->far[k], fit_profile_first);
    for (int way = -1; way <= 1 && status == PENDRES_OK; way += 2) {
      const ending how = follow(f, way, &status);
      if (status == PENDRES_OK) widen(f, how);
      *whole &= how != LOST;
    }
    p->evaluations = f->rest.evaluations;
    p->iterations = f->rest.iterations;
    p->known = 0;
  }
  return status;
}

pendres_status pendres_fit_profile(fit_problem *p, int iterations, fit_result *best,
                                   fit_result *work)
{
  pendres_status status = PENDRES_OK;
  profile f = {.whole = p, .best = best, .work = work};
  int whole = 0, followed = 0;
  if (p->unknowns == 1 && !best->determined) best->spread[0] = INFINITY;
  for (size_t k = 0; k < p->unknowns; k++) followed |= p->unknowns > 1 && best->far[k] > 0.0;
  for (int again = 0; followed && again < FIT_AGAIN && status == PENDRES_OK; again++) {
    status = follow_all(p, &f, &whole);
    if (status != PENDRES_OK || f.lowest.along == 0.0) break;
    memcpy(best->v, f.lowest.v, sizeof best->v);
    status = pendres_fit_solve(p, iterations, best);
  }
  /* Where a solver stalls in a long valley this tells that it is at the lowest place. */
  best->converged |= followed && whole && f.lowest.along == 0.0;
  best->determined = 1;
  for (size_t k = 0; k < p->unknowns; k++) best->determined &= isfinite(best->spread[k]) != 0;
  return status;
}
