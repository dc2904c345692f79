/* resonance_search.c -- the frequencies that a search has looked at; see resonance_search.h. */
#include "questions/resonance_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "model/model.h"

enum {
  COARSE_POINTS = 19, /* over the range at first: 0.04 apart in the default range */
  BATCH = 32          /* frequencies evaluated side by side */
};

/* What is taken for a slope of a pendulum's equation and for a step of
   Newton's method: about seconds of one processor, but the same number on all. Periods would not
   do: labels that are in doubt are settled again in ten times as many steps. */
static const double work_of_slope = 2.5e-9, work_of_newton = 4e-4;
/* What a period takes at least, for a guess. */
static const double work_of_period = 2e-7;

pendres_status pendres_search_create(pendres_context *ctx, const pendres_pendulum *p,
                                     const pendres_ensemble *ensemble, double most_work,
                                     pendres_search *out)
{
  *out = (pendres_search){.ctx = ctx, .pendulum = *p, .ensemble = ensemble,
                          .most_work = most_work, .rate = pendres_model_units_of(p).rate};
  out->slopes = pendres_context_slopes(ctx);
  out->newton = ctx->cost.newton_steps;
  out->points = malloc(PENDRES_SEARCH_POINTS * sizeof *out->points);
  if (out->points == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a resonance");
  return PENDRES_OK;
}

void pendres_search_free(pendres_search *s)
{
  for (size_t i = 0; i < s->count; i++) free(s->points[i].where);
  free(s->points);
}

double pendres_scan_frequency(const pendres_scan_point *p)
{
  return p->response.pendulum.drive_frequency;
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
  const double slopes = pendres_context_slopes(s->ctx), newton = s->ctx->cost.newton_steps;
  /* Slow drives take more steps a period, each of Newton's steps some periods. */
  s->work += work_of_slope * (slopes - s->slopes) +
             fmax(1.0, s->rate / omega) * work_of_newton * (newton - s->newton);
  s->slopes = slopes;
  s->newton = newton;
  if (s->work > s->most_work) s->exhausted = 1;
}

int pendres_search_over(const pendres_search *s)
{
  return s->exhausted || s->crowded;
}

int pendres_search_ended(const pendres_search *s)
{
  return s->work > 1.5 * s->most_work;
}

static pendres_status add_batch(pendres_search *s, size_t n, const double *omega)
{
  const size_t members = s->ensemble->members;
  pendres_scan_point *new = s->points + s->count;
  signed char *where = malloc(n * members);
  if (where == NULL)
    return pendres_context_fail(s->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for members");
  pendres_status status =
    pendres_scan_evaluate(s->ctx, &s->pendulum, s->ensemble, n, omega, where, new);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    new[i].where = malloc(members);
    if (new[i].where == NULL) {
      status = pendres_context_fail(s->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for members");
      break;
    }
    memcpy(new[i].where, where + i * members, members);
    s->count++;
  }
  free(where);
  pendres_search_account(s, omega[n / 2]);
  return status;
}

/*
 * What an ensemble may cost, before any was computed: members that settle as small oscillations do,
 * and twenty times that for those that do not, or are integrated again.
 */
static double expected_work(const pendres_search *s, double omega)
{
  const double periods = 20.0 + 10.0 * omega / (pi * s->pendulum.damping);
  return 20.0 * work_of_period * periods * (double)s->ensemble->members *
         fmax(1.0, s->rate / omega);
}

pendres_status pendres_search_add(pendres_search *s, size_t n, const double *omega)
{
  pendres_status status = PENDRES_OK;
  size_t done = 0;
  double cost = n > 0 ? expected_work(s, omega[0]) : 0.0;
  while (done < n && status == PENDRES_OK && !pendres_search_over(s)) {
    const double affordable = (s->most_work - s->work) / cost, before = s->work;
    size_t batch = n - done < BATCH ? n - done : BATCH;
    if (affordable < (double)batch) batch = affordable < 1.0 ? 1 : (size_t)affordable;
    if (s->count + batch > PENDRES_SEARCH_POINTS) {
      s->crowded = 1;
      batch = PENDRES_SEARCH_POINTS - s->count;
    }
    if (batch == 0) break;
    status = add_batch(s, batch, omega + done);
    done += batch;
    cost = (s->work - before) / (double)batch;
  }
  qsort(s->points, s->count, sizeof *s->points, by_frequency);
  return status;
}

pendres_status pendres_search_insert(pendres_search *s, const pendres_scan_point *point,
                                     const pendres_scan_point *like)
{
  signed char *where = malloc(s->ensemble->members);
  if (where == NULL)
    return pendres_context_fail(s->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for members");
  memcpy(where, like->where, s->ensemble->members);
  s->points[s->count] = *point;
  s->points[s->count++].where = where;
  qsort(s->points, s->count, sizeof *s->points, by_frequency);
  return PENDRES_OK;
}

/* ---- the first scan ---- */

/*
 * A resonance of the free motion with harmonic n of the drive, near 1/n of the force's rate, is as
 * wide as damping over n. Where the drive can keep a pendulum turning over, for half a cycle each
 * way, it turns about F0 / (pi damping omega) times before the drive turns it back: with each turn
 * more or less a state may come and go.
 */
double pendres_search_width(const pendres_pendulum *p, double omega)
{
  const double resonance = p->damping * fmin(omega / pendres_model_units_of(p).rate, 1.0);
  const double drive = fabs(p->drive_amplitude);
  if (pendres_model_of(p->force)->period == 0.0 || !(drive > 4.0 / pi * p->damping))
    return resonance;
  return fmin(resonance, 0.5 * p->damping * omega * omega / drive);
}

enum { PARTS = 64 };

/* Widths of the response between two frequencies, summed up at PARTS points between them. */
static void count_widths(const pendres_pendulum *p, double lower, double upper,
                         double sum[PARTS + 1])
{
  sum[0] = 0.0;
  for (int k = 0; k < PARTS; k++) {
    const double middle = lower + (upper - lower) * (k + 0.5) / PARTS;
    sum[k + 1] = sum[k] + (upper - lower) / PARTS / pendres_search_width(p, middle);
  }
}

/* Cut a part of the range such that no piece is longer than a share of the width; how many cuts. */
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

pendres_status pendres_search_scan(pendres_search *s, double lowest, double highest)
{
  enum { MOST = PENDRES_SEARCH_POINTS / 2 };
  double omega[COARSE_POINTS], fine[MOST + COARSE_POINTS], level[MOST + COARSE_POINTS];
  double widths[PARTS + 1], share = 0.7, all = 0.0;
  size_t n = 0, stride = 1;
  for (int i = 0; i < COARSE_POINTS; i++)
    omega[i] = lowest + (highest - lowest) * i / (COARSE_POINTS - 1);
  pendres_status status = pendres_search_add(s, COARSE_POINTS, omega);
  if (status != PENDRES_OK) return status;
  if (s->count < COARSE_POINTS)
    return pendres_context_fail(s->ctx, PENDRES_NOT_CONVERGED,
                                "damping %g, drive amplitude %g: the budget of a resonance's "
                                "search is spent after %zu frequencies", s->pendulum.damping,
                                s->pendulum.drive_amplitude, s->count);
  for (int i = 0; i + 1 < COARSE_POINTS; i++) {
    count_widths(&s->pendulum, omega[i], omega[i + 1], widths);
    all += widths[PARTS];
  }
  /* Below a damping of some thousandths not all widths can be looked at. */
  s->coarse = all / share > MOST;
  if (s->coarse) share = all / MOST;
  for (int i = 0; i + 1 < COARSE_POINTS; i++)
    n += cut(&s->pendulum, omega[i], omega[i + 1], share, fine + n);
  while (stride < n) stride *= 2;
  /* Every so many at first: a budget that ends early leaves no part of the range out. */
  for (; stride > 0 && n > 0 && status == PENDRES_OK; stride /= 2) {
    size_t count = 0;
    for (size_t i = stride - 1; i < n; i += stride)
      if ((i + 1) / stride % 2 == 1) level[count++] = fine[i];
    status = pendres_search_add(s, count, level);
  }
  if (pendres_search_over(s)) s->coarse = 1;
  return status;
}
