/*
 * search.c -- the search for the best values; see search.h. Its state is kept where what follows
 * begins with curves that are followed anew.
 */
#include "analysis/fit/search.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"

/* ---- errors that are not known ---- */

static int ascending(const void *a, const void *b)
{
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* The scatter of an observable: the median of second differences of neighbours, which a smooth
   response hardly has, and jumps do not change. */
static double scatter_of(const fit_model *m, pendres_fit_observable o, double *work, int *known)
{
  size_t n = 0;
  double largest = 0.0;
  for (size_t k = 0; k < m->tracks; k++) {
    double last[2] = {NAN, NAN};
    for (size_t i = m->track[k].first; i < m->track[k].first + m->track[k].count; i++)
      for (size_t j = m->station[i].first; j < m->station[i].first + m->station[i].count; j++) {
        const pendres_fit_datum *d = &m->datum[m->order[j]];
        if (d->observable != o) continue;
        const double second = d->observed - 2.0 * last[1] + last[0];
        if (!isnan(second)) work[n++] = fabs(second);
        last[0] = last[1];
        last[1] = d->observed;
        largest = fmax(largest, fabs(d->observed));
      }
  }
  for (size_t i = 0; i < m->marks; i++)
    largest = fmax(largest, fabs(m->datum[m->mark[i].datum].observed));
  const double least = 1e-6 * largest + 1e-300; /* exact data, or digits that stand still */
  *known = 0;
  if (m->decays || m->stations == 0) return fit_decay_scatter * largest + 1e-300;
  qsort(work, n, sizeof *work, ascending);
  const double median = n > 0 ? work[n / 2] / (0.6745 * sqrt(6.0)) : 0.0;
  *known = median > least;
  return fmax(median, least);
}

static void set_errors(const pendres_fit_call *c, fit_problem *p, double *error, double *work)
{
  const fit_model *m = p->m;
  double scatter[FIT_BASES] = {0.0};
  p->excess = !c->errors_known;
  for (int o = 0; o < FIT_BASES && !c->errors_known; o++) {
    int known = 1;
    if (m->measured[o]) scatter[o] = scatter_of(m, (pendres_fit_observable)o, work, &known);
    p->excess *= known;
  }
  for (size_t i = 0; i < m->data; i++)
    error[i] = c->errors_known ? m->datum[i].error : scatter[m->datum[i].observable];
}

/* ---- the state ---- */

static void pass_result(pendres_bytes *b, size_t n, fit_result *r)
{
  double *const number[] = {&r->chi_square, &r->freedom, &r->remaining, &r->scatter};
  int *const flag[] = {&r->computed, &r->converged, &r->determined, &r->impossible};
  pendres_bytes_pass(b, 1, sizeof r->v, r->v);
  for (int i = 0; i < 4; i++) {
    pendres_bytes_pass(b, 1, sizeof(double), number[i]);
    pendres_bytes_pass(b, 1, sizeof(int), flag[i]);
  }
  pendres_bytes_pass(b, n * n, sizeof *r->covariance, r->covariance);
  pendres_bytes_pass(b, 1, sizeof r->combinations, &r->combinations);
  pendres_bytes_pass(b, n + 1, sizeof *r->combination, r->combination);
  pendres_bytes_pass(b, n, sizeof *r->at_bound, r->at_bound);
  pendres_bytes_pass(b, n, sizeof *r->spread, r->spread);
  pendres_bytes_fit(b, r->combinations <= n + 1);
}

static void pass_state(pendres_bytes *b, fit_search *s)
{
  fit_problem *p = s->p;
  pendres_bytes_pass(b, 1, sizeof s->at, &s->at);
  pendres_bytes_pass(b, (size_t)s->starts, sizeof *s->start, s->start);
  pendres_bytes_pass(b, p->m->data, sizeof *s->error, s->error);
  pass_result(b, p->unknowns, &s->best);
  pendres_bytes_pass(b, 1, sizeof s->profile, &s->profile);
  pendres_bytes_pass(b, 1, sizeof p->twin, p->twin);
  pendres_bytes_pass(b, 1, sizeof p->twin_above, &p->twin_above);
  pendres_bytes_pass(b, 1, sizeof p->excess, &p->excess);
  int *const count[] = {&p->has_twin, &p->iterations, &p->evaluations, &p->m->usual_steps};
  for (int i = 0; i < 4; i++) pendres_bytes_pass(b, 1, sizeof(int), count[i]);
  pendres_bytes_pass(b, 1, sizeof p->m->active, &p->m->active);
  pendres_bytes_fit(b, (unsigned)s->at.stage <= FIT_CONCLUDING && s->at.next >= 0 &&
                       s->at.next <= s->starts && p->m->active <= p->m->stations &&
                       p->m->usual_steps >= 0 && p->m->usual_steps <= INT_MAX / FIT_MORE_STEPS &&
                       s->profile.next <= p->unknowns && s->profile.way >= -1 &&
                       s->profile.way <= 1 &&
                       s->profile.count < FIT_PROFILE_PLACES);
  for (size_t k = 0; k < p->unknowns; k++)
    pendres_bytes_fit(b, s->profile.by[k] <= p->unknowns);
}

/* Put the state, before something that does not depend on what curves and orbits are known. */
static void keep_state(fit_search *s)
{
  const int past = s->at.stage == FIT_ORDERING ? 0 : s->starts;
  const int done = past + (s->at.stage == FIT_CONCLUDING ? s->starts : s->at.next);
  if (done == 0 || !pendres_keeping_due(&s->keep, done / (2.0 * s->starts + 1.0))) return;
  pass_state(pendres_keeping_write(&s->keep), s);
  pendres_keeping_put(&s->keep);
}

static void keep_between(void *search)
{
  keep_state(search);
}

/* What is asked for, without the gaps of structs. */
static pendres_bytes question_of(const fit_search *s)
{
  const pendres_fit_call *c = s->call;
  pendres_bytes b = {.reads = 0};
  double number[FIT_QUANTITIES] = {
    c->data->axis, c->data->other, (double)c->data->n, c->model->pendulum.force,
    (double)c->model->unknowns, c->options.huber, c->options.jump_error, c->options.starts,
    c->options.iterations};
  pendres_bytes_pass(&b, FIT_QUANTITIES, sizeof *number, number);
  pendres_bytes_pass(&b, 1, sizeof c->start, (void *)(uintptr_t)c->start);
  for (size_t i = 0; i < c->data->n; i++) {
    const pendres_fit_datum *d = &c->data->datum[i];
    double one[] = {d->observable, d->direction, d->axis, d->other, d->observed, d->error};
    pendres_bytes_pass(&b, 1, sizeof one, one);
  }
  for (size_t i = 0; i < c->model->unknowns; i++) {
    const pendres_fit_unknown *u = &c->model->unknown[i];
    double one[] = {u->quantity, u->fixed, u->guess, u->low, u->high, u->prior, u->prior_error};
    pendres_bytes_pass(&b, 1, sizeof one, one);
  }
  return b;
}

/* ---- the search ---- */

static void scale_values(const fit_model *m, const fit_values v, fit_values out)
{
  for (int q = 0; q < FIT_QUANTITIES; q++) out[q] = v[q] / m->unit[q];
}

/* Whether a fit is better than the best so far by more than this in chi-square. */
static int is_better(const fit_result *a, const fit_result *b, double least)
{
  if (!b->computed || !a->computed) return a->computed;
  return a->chi_square < b->chi_square - least;
}

/* What chi-square is expected of a datum: 1, or where errors are not known what the scatter about
   the fit says. */
static double expected(const pendres_fit_call *c, const fit_result *r)
{
  return c->errors_known ? 1.0 : fmax(r->chi_square, 1e-300) / fmax(r->freedom, 1.0);
}

/* Remember the worse of two fits if their values are different ones, and about as good. */
static void compare(const pendres_fit_call *c, fit_problem *p, const fit_result *best,
                    const fit_result *other)
{
  const double above = (other->chi_square - best->chi_square) / expected(c, best);
  double apart = 0.0;
  if (!best->computed || !other->computed || !best->converged || !other->converged) return;
  for (size_t k = 0; k < p->unknowns && best->determined; k++) {
    const int q = p->free[k].quantity;
    const double error = sqrt(best->covariance[k * p->unknowns + k]);
    if (!best->at_bound[k]) apart = fmax(apart, fabs(other->v[q] - best->v[q]) / error);
  }
  if (!(apart > fit_apart && above < fit_twin)) return;
  p->has_twin = 1;
  p->twin_above = above;
  memcpy(p->twin, other->v, sizeof p->twin);
}

/* Put the starts, behind the caller's own, into the order of their chi-square: guesses know nothing
   of jumps. Those without a model come last. */
static pendres_status order_starts(fit_search *s)
{
  fit_problem *p = s->p;
  const int own = s->call->own;
  for (; s->at.next < s->starts; s->at.next++) {
    const int k = s->at.next;
    fit_values v, at;
    keep_state(s);
    memcpy(at, s->start[k], sizeof at);
    scale_values(p->m, at, v);
    pendres_fit_forget(p);
    const double sum = pendres_fit_evaluate(p, v) ? pendres_fit_sum_of_squares(p) : INFINITY;
    if (p->status != PENDRES_OK) return p->status;
    int to = k;
    for (; to > own && s->at.chi[to - 1] > sum; to--) {
      s->at.chi[to] = s->at.chi[to - 1];
      memcpy(s->start[to], s->start[to - 1], sizeof(fit_values));
    }
    s->at.chi[to] = sum;
    memcpy(s->start[to], at, sizeof at);
  }
  return PENDRES_OK;
}

/* More data of a free decay: a guess of the frequency is good for a few cycles, and a fit to these
   for some more. Where the data so far tell no damping its logarithm may have gone anywhere; it
   comes back to where the data that follow see it. */
static void widen(fit_problem *p, fit_values v)
{
  fit_model *m = p->m;
  const double span = m->station[m->active - 1].axis - m->station[0].axis;
  const double least = fit_decay_seen / (two_pi * v[PENDRES_FIT_FREQUENCY_SCALE] * span);
  m->active += m->active / 2;
  if (m->active > m->stations) m->active = m->stations;
  for (size_t k = 0; k < p->unknowns; k++)
    if (p->free[k].quantity == PENDRES_DAMPING && !(p->free[k].low < p->free[k].high))
      v[PENDRES_DAMPING] = fmax(v[PENDRES_DAMPING], least);
}

/* Whether a fit is as good as chance makes one, and this kind of data has no second answer: without
   a frequency axis a spring that stiffens, driven above its frequency, is like one that softens,
   driven below it. Without errors of the data nothing but worse fits tells that. */
static int is_good(const pendres_fit_call *c, const fit_model *m, const fit_result *best)
{
  return best->computed && best->converged && c->errors_known &&
         pendres_fit_probability(best) > fit_good_enough &&
         (m->decays || m->rotates || m->axis == PENDRES_DRIVE_FREQUENCY);
}

/* Take the fit from a start if it is better than the best so far: of values that fit as well those
   next to the caller's guesses. */
static void take(fit_search *s)
{
  const pendres_fit_call *c = s->call;
  fit_problem *p = s->p;
  fit_result *best = &s->best, *now = &s->now;
  const double least = s->at.own && best->converged ? fit_twin * expected(c, best) : 0.0;
  if (is_better(now, best, least)) {
    const fit_result other = *best;
    p->has_twin &= best->computed &&
                   now->chi_square > best->chi_square - fit_twin * expected(c, now);
    *best = *now;
    *now = other;
    s->at.own = s->at.next < c->own;
  }
  compare(c, p, best, now);
}

/* All starts, or some more behind one that fits: a wrong minimum may fit by chance as well. */
static pendres_status try_starts(fit_search *s)
{
  const pendres_fit_call *c = s->call;
  fit_problem *p = s->p;
  fit_result *now = &s->now;
  const int most = c->options.starts > 0 ? c->options.starts : FIT_TRIED;
  for (; s->at.next < s->starts && s->at.next < most && s->at.more < FIT_COMPARED; s->at.next++) {
    keep_state(s);
    const int good = is_good(c, p->m, &s->best);
    const int iterations = good ? FIT_COMPARED_ITERATIONS : c->options.iterations;
    scale_values(p->m, s->start[s->at.next], now->v);
    pendres_fit_forget(p);
    p->m->active = s->window;
    pendres_status status = pendres_fit_solve(p, iterations, now);
    while (status == PENDRES_OK && now->computed && p->m->decays &&
           p->m->active < p->m->stations) {
      widen(p, now->v);
      status = pendres_fit_solve(p, iterations, now);
    }
    if (status != PENDRES_OK) return status;
    take(s);
    s->at.more += good;
  }
  return PENDRES_OK;
}

/* The change of the values that moves a jump of the model, whose row this is, by the gap that the
   data leave it, and chi-square least. */
static void set_hop(const fit_problem *p, const fit_result *best, size_t row, int way,
                    fit_values v)
{
  const double *slope = p->rows.slope[row];
  double move[FIT_QUANTITIES], all = 0.0;
  for (size_t a = 0; a < p->unknowns; a++) {
    move[a] = 0.0;
    for (size_t b = 0; b < p->unknowns; b++)
      move[a] += best->covariance[a * p->unknowns + b] * slope[p->free[b].quantity];
    all += move[a] * slope[p->free[a].quantity];
  }
  memcpy(v, best->v, sizeof(fit_values));
  for (size_t a = 0; a < p->unknowns; a++)
    v[p->free[a].quantity] += way * sqrt(12.0) / all * move[a]; /* of an even spread over a gap */
}

/* Where a jump of the model passes a datum chi-square has a kink, and there may be a lower minimum
   on the other side: fits begin anew from there. */
static pendres_status hop(fit_search *s)
{
  fit_problem *p = s->p;
  fit_result *best = &s->best, *now = &s->now;
  const size_t first = p->m->data, rows = pendres_fit_rows(p->m);
  int better = best->computed && p->m->lines;
  for (int round = 0; round < FIT_AGAIN && better; round++) {
    better = 0;
    for (size_t row = first; row < rows; row++)
      for (int way = -1; way <= 1; way += 2) {
        pendres_fit_forget(p);
        if (!pendres_fit_evaluate(p, best->v)) return p->status;
        if (p->rows.used[row - first] != 1) continue;
        set_hop(p, best, row, way, now->v);
        const pendres_status status = pendres_fit_solve(p, FIT_COMPARED_ITERATIONS, now);
        if (status != PENDRES_OK) return status;
        if (!is_better(now, best, fit_converged)) continue;
        const fit_result other = *best;
        *best = *now;
        *now = other;
        better = 1;
      }
  }
  return PENDRES_OK;
}

/* Errors that make chi-square what is expected, and the fit with these: jumps and data then have
   their weights. */
static pendres_status find_errors(fit_search *s)
{
  fit_problem *p = s->p;
  fit_result *best = &s->best;
  pendres_status status = PENDRES_OK;
  for (int round = 0; round < 2 && status == PENDRES_OK && best->computed; round++) {
    const double factor = sqrt(fmax(best->chi_square, 1e-300) / fmax(best->freedom, 1.0));
    for (size_t i = 0; i < p->m->data; i++) s->error[i] *= factor;
    p->excess *= factor;
    p->known = 0;
    status = pendres_fit_solve(p, s->call->options.iterations, best);
  }
  return status;
}

static pendres_status begin_round(fit_search *s)
{
  fit_result *best = &s->best;
  pendres_status status = PENDRES_OK;
  pendres_fit_forget(s->p);
  if (!s->call->errors_known) status = find_errors(s);
  if (status != PENDRES_OK || !best->computed) return status;
  pendres_fit_forget(s->p);
  const int converged = best->converged; /* also where derivatives do not tell */
  s->at.before = best->chi_square;
  status = pendres_fit_conclude(s->p, best);
  best->converged |= converged;
  return status;
}

/* The errors of the values. Where following finds better ones, those of data are found anew. */
static pendres_status conclude(fit_search *s)
{
  const fit_result *best = &s->best;
  const int most = s->call->errors_known ? 1 : FIT_AGAIN;
  pendres_status status = PENDRES_OK;
  for (; s->at.again < most && status == PENDRES_OK && best->computed &&
         (s->profile.begun || best->chi_square < s->at.before - fit_twin); s->at.again++) {
    if (!s->profile.begun) status = begin_round(s);
    if (status == PENDRES_OK && best->computed)
      status = pendres_fit_profile(s->p, s->call->options.iterations, &s->profile, &s->best,
                                   &s->now);
  }
  return status;
}

/* ---- all ---- */

static void begin(fit_search *s)
{
  fit_problem *p = s->p;
  s->at = (fit_search_place){.stage = s->starts > 1 ? FIT_ORDERING : FIT_STARTING,
                             .before = INFINITY};
  if (s->at.stage == FIT_ORDERING) s->at.next = s->call->own;
  s->profile = (fit_profile){.begun = 0};
  s->best.computed = s->now.computed = 0;
  p->has_twin = p->iterations = p->evaluations = 0;
  set_errors(s->call, p, s->error, s->work);
}

/* Go on from the state of an earlier process; where there is none of use all begins anew. */
static void take_up(fit_search *s)
{
  s->keep = pendres_keeping_begin(s->p->m->ctx, "fit", question_of(s));
  if (!pendres_keeping_found(&s->keep)) return;
  fit_values start[FIT_TRIED];
  memcpy(start, s->start, (size_t)s->starts * sizeof *start);
  pass_state(&s->keep.state, s);
  if (pendres_bytes_end(&s->keep.state)) {
    pendres_keeping_taken(&s->keep);
    for (size_t k = 0; k < s->p->unknowns; k++) s->p->free[k].at_bound = s->best.at_bound[k];
    return;
  }
  memcpy(s->start, start, (size_t)s->starts * sizeof *start);
  s->p->m->active = s->window;
  begin(s);
}

pendres_status pendres_fit_search(fit_search *s)
{
  pendres_status status = PENDRES_OK;
  s->window = s->p->m->active;
  s->p->between = keep_between;
  s->p->search = s;
  begin(s);
  take_up(s);
  if (s->at.stage == FIT_ORDERING) {
    status = order_starts(s);
    s->at.stage = FIT_STARTING;
    s->at.next = 0;
  }
  if (status == PENDRES_OK && s->at.stage == FIT_STARTING) {
    status = try_starts(s);
    if (status == PENDRES_OK) status = hop(s);
    s->at.stage = FIT_CONCLUDING;
  }
  if (status == PENDRES_OK) status = conclude(s);
  pendres_keeping_end(&s->keep);
  return status;
}
