/* search.c -- the frequencies that a search has evaluated; see search.h. */
#include "analysis/resonance/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/resonance/numbers.h"
#include "analysis/resonance/response_parts.h"
#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "settling/settle.h"

pendres_search_budget pendres_search_budget_of(pendres_context *ctx, double most)
{
  return (pendres_search_budget){.ctx = ctx,
                                 .most = most,
                                 .slopes = pendres_context_slopes(ctx),
                                 .newton = ctx->cost.newton_steps};
}

pendres_status pendres_search_create(pendres_search_budget *budget, const pendres_pendulum *p,
                                     const pendres_ensemble *ensemble, pendres_search *out)
{
  memset(out, 0, sizeof *out);
  out->ctx = budget->ctx;
  out->pendulum = *p;
  out->ensemble = ensemble;
  out->budget = budget;
  out->rate = pendres_model_units_of(p).rate;
  out->points = malloc(PENDRES_SEARCH_POINTS * sizeof *out->points);
  if (out->points == NULL)
    return pendres_context_fail(out->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a resonance");
  return PENDRES_OK;
}

void pendres_search_free(pendres_search *s)
{
  for (size_t i = 0; i < s->count; i++) free(s->points[i].where);
  free(s->points);
}

/* Never 0 for two points that differ, so that their order is not that of their discovery. */
static int by_frequency(const void *a, const void *b)
{
  const pendres_scan_point *p = a, *q = b;
  const double v = pendres_scan_frequency(p), w = pendres_scan_frequency(q);
  if (v != w) return v < w ? -1 : 1;
  /* A fold's point lies on the side without the state that ends there. */
  if (p->at_fold != q->at_fold) return p->at_fold > q->at_fold ? -1 : 1;
  return 0;
}

void pendres_search_account(pendres_search *s, double omega)
{
  pendres_search_budget *b = s->budget;
  const double slopes = pendres_context_slopes(b->ctx), newton = b->ctx->cost.newton_steps;
  /* Slow drives take more steps a period, each of Newton's steps some periods. */
  b->work += work_of_slope * (slopes - b->slopes) +
             fmax(1.0, s->rate / omega) * work_of_newton * (newton - b->newton);
  b->slopes = slopes;
  b->newton = newton;
  if (b->work > b->most) b->exhausted = 1;
}

int pendres_search_over(const pendres_search *s)
{
  return s->budget->exhausted || s->crowded;
}

int pendres_search_ended(const pendres_search *s)
{
  return s->budget->work > 1.5 * s->budget->most;
}

/* What is to be evaluated, and for which search. */
typedef struct wanted {
  size_t n;
  pendres_pendulum *pendulum;
  pendres_search **by;
} wanted;

/*
 * Gather one request of each search, then the next of each, as far as they have room. Neighbours in
 * this order are similar, take the same number of steps a period, and so share blocks.
 */
static void gather(pendres_room *room, size_t n, pendres_search *const *s, wanted *out)
{
  size_t all = 0, most = 0;
  for (size_t i = 0; i < n; i++) {
    all += s[i]->requests;
    most = s[i]->requests > most ? s[i]->requests : most;
  }
  *out = (wanted){.pendulum = pendres_room_take(room, all, sizeof *out->pendulum),
                  .by = pendres_room_take(room, all, sizeof *out->by)};
  for (size_t k = 0; k < most && room->status == PENDRES_OK; k++)
    for (size_t i = 0; i < n; i++) {
      if (k >= s[i]->requests || s[i]->crowded) continue;
      if (s[i]->count + k >= PENDRES_SEARCH_POINTS) {
        s[i]->crowded = 1;
        continue;
      }
      out->pendulum[out->n] = s[i]->pendulum;
      out->pendulum[out->n].drive_frequency = s[i]->request[k];
      out->by[out->n++] = s[i];
    }
}

/* Append a point whose members are on these states. */
static pendres_status append(pendres_search *s, const pendres_scan_point *point,
                             const signed char *where)
{
  pendres_scan_point *to = &s->points[s->count];
  *to = *point;
  to->next = NULL;
  to->where = malloc(s->ensemble->members);
  if (to->where == NULL)
    return pendres_context_fail(s->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for members");
  memcpy(to->where, where, s->ensemble->members);
  s->count++;
  return PENDRES_OK;
}

/* Evaluate n of what is wanted, from number `first` on. */
static pendres_status add_batch(const wanted *w, size_t first, size_t n)
{
  pendres_search *const *by = w->by + first;
  const pendres_pendulum *p = w->pendulum + first;
  const pendres_ensemble *e = by[0]->ensemble;
  pendres_room room = pendres_room_open(by[0]->ctx, "members");
  signed char *where = pendres_room_take(&room, n * e->members, sizeof *where);
  pendres_scan_point *new = pendres_room_take(&room, n, sizeof *new);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = pendres_scan_evaluate(by[0]->ctx, n, p, e, where, new);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = append(by[i], &new[i], where + i * e->members);
  pendres_search_account(by[n / 2], p[n / 2].drive_frequency);
  return pendres_room_close(&room, status);
}

/*
 * An estimate of an ensemble's work before any was computed: that of members which settle as small
 * oscillations do, times twenty for those that do not, or are integrated again.
 */
static double expected_work(const pendres_search *s, double omega)
{
  pendres_pendulum p = s->pendulum;
  p.drive_frequency = omega;
  const double periods = (double)pendres_settle_first_budget(&p);
  return 20.0 * work_of_period * periods * (double)s->ensemble->members *
         fmax(1.0, s->rate / omega);
}

pendres_status pendres_search_add(size_t n, pendres_search *const *s)
{
  wanted w;
  pendres_room room = pendres_room_open(s[0]->ctx, "frequencies");
  gather(&room, n, s, &w);
  pendres_status status = room.status;
  const pendres_search_budget *b = s[0]->budget;
  double cost = status == PENDRES_OK && w.n > 0
                  ? expected_work(w.by[0], w.pendulum[0].drive_frequency) : 0.0;
  for (size_t done = 0, batch; done < w.n && status == PENDRES_OK && !b->exhausted; done += batch) {
    const double affordable = (b->most - b->work) / cost, before = b->work;
    batch = w.n - done < PENDRES_RESPONSE_BATCH ? w.n - done : PENDRES_RESPONSE_BATCH;
    if (affordable < (double)batch) batch = affordable < 1.0 ? 1 : (size_t)affordable;
    status = add_batch(&w, done, batch);
    cost = (b->work - before) / (double)batch;
  }
  for (size_t i = 0; i < n; i++) {
    qsort(s[i]->points, s[i]->count, sizeof *s[i]->points, by_frequency);
    s[i]->requests = 0;
  }
  return pendres_room_close(&room, status);
}

pendres_status pendres_search_insert(pendres_search *s, const pendres_scan_point *point,
                                     const signed char *where)
{
  const pendres_status status = append(s, point, where);
  qsort(s->points, s->count, sizeof *s->points, by_frequency);
  return status;
}

/* ---- the first scan ---- */

/*
 * A resonance of the free motion with harmonic n of the drive, near 1/n of the force's frequency,
 * has a width of damping over n. Where the drive can keep a pendulum turning over, for half a cycle
 * each way, it makes about F0 / (pi damping omega) turns before the drive reverses it: with each
 * turn more or less a state may come or go.
 */
double pendres_search_width(const pendres_pendulum *p, double omega)
{
  const double rate = pendres_pendulum_decay_rate(p);
  const double resonance = rate * fmin(omega / pendres_model_units_of(p).rate, 1.0);
  const double drive = fabs(p->drive_amplitude);
  if (pendres_model_of(p->force)->period == 0.0 || !(drive > 4.0 / pi * rate))
    return resonance;
  return fmin(resonance, 0.5 * rate * omega * omega / drive);
}

enum { PARTS = 64 };

/* Count the widths of the response between two frequencies, cumulatively at PARTS points. */
static void count_widths(const pendres_pendulum *p, double lower, double upper,
                         double sum[PARTS + 1])
{
  sum[0] = 0.0;
  for (int k = 0; k < PARTS; k++) {
    const double middle = lower + (upper - lower) * (k + 0.5) / PARTS;
    sum[k + 1] = sum[k] + (upper - lower) / PARTS / pendres_search_width(p, middle);
  }
}

/* Cut a part of the range so that no piece is longer than a share of the width; returns the number
   of cuts. */
static size_t cut(const pendres_pendulum *p, double lower, double upper, double share,
                  double *omega)
{
  double sum[PARTS + 1];
  count_widths(p, lower, upper, sum);
  const double pieces = ceil(sum[PARTS] / share);
  const size_t n = pieces > 1.0 ? (size_t)pieces - 1 : 0;
  int k = 0;
  for (size_t i = 1; i <= n; i++) {
    const double target = sum[PARTS] * (double)i / (double)(n + 1);
    while (k + 1 < PARTS && sum[k + 1] < target) k++;
    const double within = (target - sum[k]) / (sum[k + 1] - sum[k]);
    omega[i - 1] = lower + (upper - lower) * (k + within) / PARTS;
  }
  return n;
}

/* Find where the gaps between n frequencies are cut into pieces of such a share of the width, with
   as many cuts as there is room for at most; whether that is enough. */
static int find_cuts(pendres_search *s, size_t n, const double *omega, double share)
{
  enum { MOST = PENDRES_SEARCH_POINTS / 2 };
  double widths[PARTS + 1], all = 0.0;
  for (size_t i = 0; i + 1 < n; i++) {
    count_widths(&s->pendulum, omega[i], omega[i + 1], widths);
    all += widths[PARTS];
  }
  /* Below a damping of some thousandths not all widths can be looked at; of a range beyond all
     numbers none. */
  const int enough = all / share <= MOST;
  if (!enough) share = all / MOST;
  s->cuts = 0;
  for (size_t i = 0; i + 1 < n; i++)
    s->cuts += cut(&s->pendulum, omega[i], omega[i + 1], share, s->cut + s->cuts);
  s->stride = s->cuts > 0;
  while (s->stride < s->cuts) s->stride *= 2;
  return enough;
}

/* Whether members change their states more often than where one state follows another on the way up
   a resonance and down again: basins alternate. */
static int alternates(const pendres_search *s)
{
  int changes = 0;
  for (size_t i = 0; i + 1 < s->count; i++) changes += s->points[i].gap.changed;
  return changes > 2;
}

/* Request the next cuts: at first every stride-th, all over the range, so that a budget that ends
   early leaves no part of it out. */
static void next_level(pendres_search *s)
{
  for (; s->stride > 0 && s->requests == 0; s->stride /= 2)
    for (size_t i = s->stride - 1; i < s->cuts; i += s->stride)
      if ((i + 1) / s->stride % 2 == 1) s->request[s->requests++] = s->cut[i];
}

pendres_status pendres_search_scan(pendres_search *s)
{
  if (s->stage == PENDRES_SCAN_COARSE) {
    s->requests = PENDRES_SEARCH_COARSE;
    for (int i = 0; i < PENDRES_SEARCH_COARSE; i++)
      s->request[i] = s->lowest + (s->highest - s->lowest) * i / (PENDRES_SEARCH_COARSE - 1);
    s->coarse = !find_cuts(s, PENDRES_SEARCH_COARSE, s->request, scan_share);
    s->stage = PENDRES_SCAN_LEVELS;
    return PENDRES_OK;
  }
  if (s->stage == PENDRES_SCAN_DONE) return PENDRES_OK;
  if (s->count < PENDRES_SEARCH_COARSE)
    return pendres_context_fail(s->ctx, PENDRES_NOT_CONVERGED,
                                "damping %g, drive amplitude %g: the budget of a resonance's "
                                "search is spent after %zu frequencies", s->pendulum.damping,
                                s->pendulum.drive_amplitude, s->count);
  if (!pendres_search_over(s)) next_level(s);
  if (s->requests > 0) return PENDRES_OK;
  if (pendres_search_over(s) && !s->fine) s->coarse = 1;
  s->stage = PENDRES_SCAN_DONE;
  return PENDRES_OK;
}

int pendres_search_scan_finely(pendres_search *s)
{
  double omega[PENDRES_SEARCH_POINTS];
  const double few = (double)s->ensemble->members / GAP_FEW;
  if (s->fine || !(few < 1.0) || pendres_search_over(s) || !alternates(s)) return 0;
  s->fine = 1;
  for (size_t i = 0; i < s->count; i++) omega[i] = pendres_scan_frequency(&s->points[i]);
  (void)find_cuts(s, s->count, omega, few * scan_share);
  s->stage = PENDRES_SCAN_LEVELS;
  return s->cuts > 0;
}
