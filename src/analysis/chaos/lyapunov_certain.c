/* lyapunov_certain.c -- verdicts that rounding cannot change; see lyapunov_certain.h. */
#include "analysis/chaos/lyapunov_certain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "orbits/settle_lanes.h"

enum {
  FEW = 4,        /* copies that are tried first: most of those that differ are seen by them */
  COPIES = 16,    /* what one copy in five does is missed by all of them once in thirty times */
  AT_A_TIME = 1024 /* pendulums with copies: they need memory */
};

/* An error this many times as large as one that may decide has parted motions for good. */
static const double parted = 100.0;
/* Verdicts of copies agree within this many times their errors. */
static const double agreement = 5.0;

typedef pendres_lyapunov verdict;

static int in_doubt(const verdict *l)
{
  return l->label != PENDRES_LABEL_UNRESOLVED && !l->certain;
}

/* Whether errors have grown so large on the way to an orbit, even in a run as exact as can be, that
   copies part whatever distance they start at. In chaos errors grow in any case. */
static int hopeless(const pendres_lyapunov_job *job, size_t i)
{
  return job->out[i].label != PENDRES_LABEL_CHAOTIC && !(job->runner[i].doubt <= parted);
}

static int near(double a, double a_error, double b, double b_error)
{
  return fabs(a - b) <= agreement * (a_error + b_error) || (isnan(a) && isnan(b));
}

static int alike(const verdict *a, const verdict *b)
{
  return a->label == b->label && a->period == b->period && a->winding == b->winding &&
         near(a->exponent, a->exponent_error, b->exponent, b->exponent_error) &&
         near(a->rotation, a->rotation_error, b->rotation, b->rotation_error);
}

/* Errors that hold what another one does: none where that has no such number. */
static void widen(verdict *l, const verdict *other)
{
  const double exponent = fabs(other->exponent - l->exponent);
  const double rotation = fabs(other->rotation - l->rotation);
  l->exponent_error = isnan(exponent) ? NAN : fmax(l->exponent_error, exponent);
  l->rotation_error = isnan(rotation) ? NAN : fmax(l->rotation_error, rotation);
}

/* Pendulums of a job, those with the numbers `which`, and copies of each, number `first` on: number
   0 is the pendulum itself, others start beside it. */
typedef struct family {
  const pendres_lyapunov_job *job;
  size_t n;
  const size_t *which;
  size_t first, copies;
} family;

/* Judge all of a family: out[n * copies]. The doubts of the pendulums themselves are theirs from
   then on. */
static pendres_status judge(pendres_context *ctx, const family *f, verdict *out)
{
  const size_t all = f->n * f->copies;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_pendulum *p = malloc((all + 1) * sizeof *p);
  double *x = malloc((2 * all + 1) * sizeof *x);
  pendres_lyapunov_job j = *f->job;
  j.runner = malloc((all + 1) * sizeof *j.runner);
  if (p == NULL || x == NULL || j.runner == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for copies of %zu pendulums", f->n);
    goto done;
  }
  for (size_t at = 0; at < all; at++) {
    /* Spread by an irrational angle: no two of them start at the same place. */
    const size_t i = f->which[at / f->copies], number = f->first + at % f->copies;
    const double angle = 2.39996322972865332 * (double)number;
    const double off = number > 0 ? f->job->accuracy : 0.0;
    p[at] = f->job->pendulum[i];
    x[at] = f->job->x[i] + off * cos(angle);
    x[all + at] = f->job->v[i] + off * sin(angle);
  }
  if (f->first > 0 && j.longer > j.periods) j.longer = j.periods; /* they need less than it */
  j.n = all;
  j.pendulum = p;
  j.x = x;
  j.v = x + all;
  j.orbit = NULL;
  j.out = out;
  status = pendres_lyapunov_judge(ctx, &j);
  for (size_t i = 0; i < f->n && f->first == 0 && status == PENDRES_OK; i++)
    f->job->runner[f->which[i]].doubt = j.runner[i * f->copies].doubt;
done:
  free(j.runner);
  free(p);
  free(x);
  return status;
}

/* Compare pendulums with copies of them; those whose copies all do the same are certain. What the
   copies do is in the errors of those that are not compared again. */
static pendres_status compare(pendres_context *ctx, const pendres_lyapunov_job *job, size_t n,
                              const size_t *those, int last)
{
  static const size_t begin[] = {1, 1 + FEW, 1 + COPIES};
  size_t which[AT_A_TIME]; /* that agree so far */
  verdict *copy = malloc((n * COPIES + 1) * sizeof *copy);
  pendres_status status = PENDRES_OK;
  if (copy == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for copies");
  memcpy(which, those, n * sizeof *which);
  for (int part = 0; part < 2 && n > 0 && status == PENDRES_OK; part++) {
    const size_t copies = begin[part + 1] - begin[part];
    size_t left = 0;
    status = judge(ctx, &(family){job, n, which, begin[part], copies}, copy);
    for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
      verdict *l = &job->out[which[i]];
      const verdict before = *l;
      int same = 1;
      for (size_t k = 0; k < copies; k++) {
        if (alike(&before, &copy[i * copies + k])) continue;
        same = 0;
        if (last || hopeless(job, which[i])) widen(l, &copy[i * copies + k]);
      }
      l->certain = same && part == 1;
      if (same) which[left++] = which[i];
    }
    n = left;
  }
  free(copy);
  return status;
}

/* Start pendulums again, with the job's accuracy. What they do counts, unless it is not known. */
static pendres_status repeat(pendres_context *ctx, const pendres_lyapunov_job *job, size_t n,
                             const size_t *which)
{
  verdict *again = malloc((n + 1) * sizeof *again);
  if (again == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu verdicts", n);
  const pendres_status status = judge(ctx, &(family){job, n, which, 0, 1}, again);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (again[i].label != PENDRES_LABEL_UNRESOLVED) job->out[which[i]] = again[i];
  free(again);
  return status;
}

/* Put those of n pendulums first that are in doubt, of them only those with hope if it is asked
   for, and the others behind them; returns how many come first. */
static size_t put_first(const pendres_lyapunov_job *job, size_t n, size_t *which, int with_hope)
{
  size_t left = 0;
  for (size_t i = 0; i < n; i++) {
    const size_t at = which[i];
    if (!in_doubt(&job->out[at]) || (with_hope && hopeless(job, at))) continue;
    which[i] = which[left];
    which[left++] = at;
  }
  return left;
}

/* An exact run costs less than copies, and leaves few in doubt. */
static pendres_status make_certain(pendres_context *ctx, const pendres_lyapunov_job *job, size_t n,
                                   size_t *which)
{
  pendres_lyapunov_job exact = *job;
  exact.accuracy = PENDRES_ACCURACY_TIGHTEST;
  pendres_status status = repeat(ctx, &exact, n, which);
  if (status != PENDRES_OK) return status;
  n = put_first(job, n, which, 0);
  status = compare(ctx, job, n, which, 0);
  if (status != PENDRES_OK) return status;
  n = put_first(job, n, which, 1);
  return compare(ctx, &exact, n, which, 1);
}

pendres_status pendres_lyapunov_make_certain(pendres_context *ctx, const pendres_lyapunov_job *job)
{
  pendres_status status = PENDRES_OK;
  if (!pendres_settle_carries(ctx)) return status;
  for (size_t from = 0; from < job->n && status == PENDRES_OK;) {
    size_t which[AT_A_TIME], n = 0;
    for (; from < job->n && n < AT_A_TIME; from++)
      if (in_doubt(&job->out[from])) which[n++] = from;
    if (n > 0) status = make_certain(ctx, job, n, which);
  }
  return status;
}
