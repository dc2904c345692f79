/* lyapunov.c -- largest Lyapunov exponents of many pendulums; see lyapunov.h. */
#include <pendres/lyapunov.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "engine/kernels/coordinates.h"
#include "model/equation.h"
#include "orbits/orbit_table.h"
#include "settling/exponents/carried.h"
#include "settling/exponents/unstable.h"
#include "settling/exponents/lyapunov_move.h"
#include "settling/exponents/lyapunov_verdict.h"
#include "settling/exponents/numbers.h"
#include "base/angles.h"
#include "base/sized.h"

/*
 * ---- verdicts that rounding cannot change ----
 *
 * A pendulum whose error was not small on the way to where it has gone starts again, as exactly as
 * can be. Where that leaves a doubt, copies of it start as far from it as errors are large; where
 * all of them do the same, the error decides nothing. Otherwise copies start as near as rounding,
 * and as exactly as can be. Where these differ from each other, how far is in the errors.
 */

enum {
  AT_A_TIME = 4096 /* pendulums with copies: they need memory */
};

typedef pendres_settled verdict;

static int in_doubt(const verdict *l)
{
  return l->label != PENDRES_LABEL_UNRESOLVED && !l->certain;
}

/* Whether errors have grown so large on the way to an orbit, even in a run as exact as can be, that
   copies part whatever distance they start at. In chaos errors grow in any case. */
static int hopeless(const pendres_lyapunov_job *job, size_t i)
{
  return job->out[i].label != PENDRES_LABEL_CHAOTIC && !(job->runner[i].doubt <= settle_lost);
}

static int near(double a, double a_error, double b, double b_error)
{
  return fabs(a - b) <= copies_agree * (a_error + b_error) || (isnan(a) && isnan(b));
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
  const double *each;   /* of the pendulums themselves: errors a period */
  pendres_orbit *orbit; /* that the pendulums are on: of copies they are known, else this is room */
} family;

/* Judge all of a family: out[n * copies]. The doubts of the pendulums themselves are theirs from
   then on. */
static pendres_status judge(pendres_context *ctx, const family *f, verdict *out)
{
  const size_t all = f->n * f->copies;
  pendres_room room = pendres_room_open(ctx, "copies of pendulums");
  pendres_pendulum *p = pendres_room_take(&room, all, sizeof *p);
  double *x = pendres_room_take(&room, 2 * all, sizeof *x);
  pendres_lyapunov_job j = *f->job;
  j.runner = pendres_room_take(&room, all, sizeof *j.runner);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t at = 0; at < all; at++) {
    const size_t i = f->which[at / f->copies], number = f->first + at % f->copies;
    const double angle = golden_angle * (double)number;
    const double off = number > 0 ? f->job->accuracy : 0.0;
    p[at] = f->job->pendulum[i];
    x[at] = f->job->x[i] + off * cos(angle);
    x[all + at] = f->job->v[i] + off * sin(angle);
  }
  if (f->first > 0 && j.longer > j.periods) j.longer = j.periods; /* they need less than it */
  j.n = all;
  j.few = 1;
  j.pendulum = p;
  j.x = x;
  j.v = x + all;
  j.out = out;
  j.each = f->each;
  j.orbit = f->first > 0 ? NULL : f->orbit;
  if (f->first > 0) {
    j.copies = f->copies;
    j.known = f->orbit;
  }
  pendres_status status = pendres_lyapunov_judge(ctx, &j);
  for (size_t i = 0; i < f->n && f->first == 0 && status == PENDRES_OK; i++)
    f->job->runner[f->which[i]].doubt = j.runner[i * f->copies].doubt;
  return pendres_room_close(&room, status);
}

/* Compare pendulums with copies of them; those whose copies all do the same are certain. What the
   copies do is in the errors of those that are not compared again. */
static pendres_status compare(pendres_context *ctx, const pendres_lyapunov_job *job, size_t n,
                              const size_t *those, int last)
{
  static const size_t begin[] = {1, 1 + COPIES_FEW, 1 + COPIES};
  size_t which[AT_A_TIME]; /* that agree so far */
  pendres_room room = pendres_room_open(ctx, "copies of pendulums");
  verdict *copy = pendres_room_take(&room, n * COPIES, sizeof *copy);
  pendres_orbit *orbit = pendres_room_take(&room, n, sizeof *orbit);
  pendres_status status = room.status;
  memcpy(which, those, n * sizeof *which);
  for (int part = 0; part < 2 && n > 0 && status == PENDRES_OK; part++) {
    const size_t copies = begin[part + 1] - begin[part];
    size_t left = 0;
    for (size_t i = 0; i < n; i++) orbit[i] = job->orbit[which[i]];
    const family f = {job, n, which, begin[part], copies, NULL, orbit};
    status = judge(ctx, &f, copy);
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
  return pendres_room_close(&room, status);
}

/* Start pendulums again, as exactly as their doubts ask for. What they do counts, unless it is not
   known. */
static pendres_status repeat(pendres_context *ctx, const pendres_lyapunov_job *job, size_t n,
                             const size_t *which)
{
  pendres_room room = pendres_room_open(ctx, "verdicts");
  verdict *again = pendres_room_take(&room, n, sizeof *again);
  pendres_orbit *orbit = pendres_room_take(&room, n, sizeof *orbit);
  double *each = pendres_room_take(&room, n, sizeof *each);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    const double doubt = settle_lost * job->runner[which[i]].doubt;
    orbit[i] = pendres_orbit_none(&job->pendulum[which[i]]);
    each[i] = fmax(pendres_settle_tighter(job->accuracy, doubt), PENDRES_ACCURACY_TIGHTEST);
  }
  const family f = {job, n, which, 0, 1, each, orbit};
  const pendres_status status = judge(ctx, &f, again);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (again[i].label == PENDRES_LABEL_UNRESOLVED) continue;
    job->out[which[i]] = again[i];
    job->orbit[which[i]] = orbit[i];
  }
  return pendres_room_close(&room, status);
}

/* Put those of n pendulums first that are in doubt, but for those that are left out, and the others
   behind them; returns how many come first. */
static size_t put_first(const pendres_lyapunov_job *job, size_t n, size_t *which,
                        int (*left_out)(const pendres_lyapunov_job *, size_t))
{
  size_t left = 0;
  for (size_t i = 0; i < n; i++) {
    const size_t at = which[i];
    if (!in_doubt(&job->out[at]) || (left_out != NULL && left_out(job, at))) continue;
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
  pendres_status status = repeat(ctx, job, n, which);
  if (status != PENDRES_OK) return status;
  n = put_first(job, n, which, NULL);
  status = compare(ctx, job, n, which, 0);
  if (status != PENDRES_OK) return status;
  n = put_first(job, n, which, hopeless);
  return compare(ctx, &exact, n, which, 1);
}

/* Go through verdicts that are not certain. The job's runners are where its judgement has left
   them; it has orbits. */
static pendres_status make_all_certain(pendres_context *ctx, const pendres_lyapunov_job *job)
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

/* ---- the calls ---- */

static const char *refuses(const pendres_pendulum *p, double x, double v)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK) return why;
  why = pendres_equation_undamped(p);
  return why != NULL ? why : pendres_coordinates_refuses(p, x, v);
}

pendres_status pendres_lyapunov_move(pendres_context *ctx, const pendres_lyapunov_motion *m,
                                     pendres_lyapunov_care care)
{
  static const struct { long periods; int rounds; } looks[] = {
    [PENDRES_CARE_FULL] = {EXPONENT_PERIODS, EXPONENT_ROUNDS},
    [PENDRES_CARE_LABEL] = {EXPONENT_PERIODS, EXPONENT_ROUNDS - 1},
    [PENDRES_CARE_ONCE] = {EXPONENT_PERIODS, 1},
    [PENDRES_CARE_CLOSE] = {EXPONENT_PERIODS / 2, EXPONENT_ROUNDS + 1}};
  const size_t n = m->n;
  const int close = care == PENDRES_CARE_CLOSE;
  const pendres_lyapunov_job j = {
    .n = n, .pendulum = m->pendulum, .x = m->x, .v = m->v, .out = m->out, .orbit = m->orbit,
    .accuracy = close ? pendres_accuracy_of_rough_means(ctx) : pendres_accuracy_to_average(ctx),
    .care = care, .points = m->points, .periods = looks[care].periods,
    .rounds = looks[care].rounds, .longer = care <= PENDRES_CARE_LABEL ? 3 * EXPONENT_PERIODS : 0,
    .runner = malloc((n + 1) * sizeof *j.runner)};
  if (j.runner == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  for (size_t i = 0; i < n; i++) m->orbit[i] = pendres_orbit_none(&m->pendulum[i]);
  const pendres_status status = pendres_lyapunov_judge(ctx, &j);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&j.runner[i].lane, &m->x[i], &m->v[i]);
  free(j.runner);
  return status;
}

static pendres_status lyapunov_find(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                    const double *x, const double *v,
                                    const pendres_lyapunov_options *options, pendres_settled *out)
{
  static const pendres_lyapunov_options defaults = {0};
  const pendres_lyapunov_options *o = options != NULL ? options : &defaults;
  if (n > 0 && (p == NULL || x == NULL || v == NULL || out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x, v and out");
  if (PENDRES_SIZED_REFUSES(o) != NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", PENDRES_SIZED_REFUSES(o));
  if (o->transient < 0 || o->periods < 0 || o->transient > LONG_MAX / 64 ||
      o->periods > LONG_MAX / 64)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "transient and periods are numbers of drive periods: they must not "
                                "be negative or too large");
  for (size_t i = 0; i < n; i++) {
    const char *why = refuses(&p[i], x[i], v[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  pendres_room room = pendres_room_open(ctx, "pendulums");
  const pendres_lyapunov_job j = {
    .n = n, .pendulum = p, .x = x, .v = v, .out = out,
    .accuracy = pendres_accuracy_to_average(ctx), .transient = o->transient,
    .periods = o->periods > 0 ? o->periods : EXPONENT_PERIODS, .asked = o->periods > 0,
    .rounds = EXPONENT_ROUNDS,
    .coarse = o->periods == 0 && ctx->options.steps_per_period == 0,
    .longer = o->periods > 0 ? 0 : 3 * EXPONENT_PERIODS,
    .care = PENDRES_CARE_FULL, .points = 1,
    .runner = pendres_room_take(&room, n, sizeof *j.runner),
    .orbit = pendres_room_take(&room, n, sizeof *j.orbit)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) j.orbit[i] = pendres_orbit_none(&p[i]);
  pendres_status status = pendres_lyapunov_judge(ctx, &j);
  if (status == PENDRES_OK) status = make_all_certain(ctx, &j);
  return pendres_room_close(&room, status);
}

pendres_status pendres_lyapunov_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, const double *x,
                                     const double *v, const pendres_lyapunov_options *options,
                                     pendres_settled *out)
{
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const pendres_pendulum *p = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    const double *x_in = pendres_door_in_run(&d, &pendres_dim_length, x);
    const double *v_in = pendres_door_in_run(&d, &pendres_dim_speed, v);
    pendres_settled *to = pendres_door_out_run(&d, &pendres_dim_settled, out);
    PENDRES_DOOR_CALL(&d, lyapunov_find(ctx, d.count, p, x_in, v_in, options, to));
  }
  return pendres_door_close(&d);
}
