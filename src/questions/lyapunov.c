/* lyapunov.c -- largest Lyapunov exponents of many pendulums; see lyapunov.h. */
#include <pendres/lyapunov.h>

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/passage.h"
#include "engine/rank.h"
#include "engine/steps.h"
#include "engine/strobe_run.h"
#include "model/model.h"
#include "orbits/catalogue.h"
#include "questions/lyapunov_move.h"

enum {
  BATCHES = 16,
  TRANSIENT = 200,     /* drive periods, where damping is not weak */
  PERIODS = 512,
  WARM_UP = 16,        /* in which the tangent vector turns into the growing direction */
  LONGEST_ORBIT = 128, /* drive periods of an orbit that is looked for */
  ROUNDS = 4           /* of averages, each twice as long as the one before */
};

/* Strobe points that come back so closely are next to an orbit: at first, and once that orbit has
   turned out not to attract the pendulum. */
static const double close_by = 1e-4, very_close_by = 1e-7;
/* An orbit found further from the point that came back is another one. */
static const double same_orbit = 0.02;
/* Neighbours are so far away: what they lose by rounding, and what they differ by from the linear
   equation, is a 1e-8th of their distance. */
static const double apart = 1e-8;
/* Standard errors above zero that an exponent of chaos is, and its least growth a period. */
static const double significance = 5.0, least_growth = 1e-3;
/* Next to where a lock has ended a rotation is slow, and stretches a tangent vector by as much as
   it will shrink it again, up to this logarithm: chaos goes beyond. */
static const double passing = 30.0;
/* Quasi-periodic: averages over the halves agree to this, a period, and neighbours' distances grow
   and shrink by less. */
static const double same_mean = 1e-5;

/* Of smooth averages: all periods, and either half of them. */
enum { WHOLE, FIRST_HALF, SECOND_HALF, SPANS };

typedef enum state { MOVING, CAUGHT, DONE } state;

typedef struct runner {
  pendres_strobe_lane lane;
  state state;
  double u[2];           /* in which direction its neighbour is, of length one */
  /* Cycle detection: the strobe point that is compared with, and when the next takes its place. */
  double ref_y, ref_w, near;
  long ref_turns, ref_period, next;
  int period, winding;   /* of the orbit that it seems to be near */
  double growth[BATCHES], turned[BATCHES]; /* sums over the periods of each batch */
  /* Of rotations: sums with smooth weights, the logarithm of the tangent vector's length, and sums
     of that length and of its reciprocal. */
  double smooth_growth[SPANS], smooth_turned[SPANS], length, lengths, reciprocals;
} runner;

typedef struct job {
  size_t n;
  runner *runner;
  pendres_orbit *orbit; /* that runners are on; NULL where nobody asks */
  long transient, periods;
} job;

int pendres_lyapunov_may_rotate(const pendres_pendulum *p)
{
  const int driven = p->drive_amplitude != 0.0 || p->parametric_amplitude != 0.0;
  const int pushed = p->torque != 0.0 || p->drive_amplitude != 0.0;
  return pendres_model_kind(p) == PENDRES_MODEL_PENDULUM && driven && pushed;
}

/* ---- coming back --------------------------------------------------------------------------- */

static void look_from(runner *r, const pendres_strobe_lane *l)
{
  r->ref_y = l->y;
  r->ref_w = l->w;
  r->ref_turns = l->turns;
  r->ref_period = l->period;
}

/* Whether the latest strobe point is next to the one that it is compared with. */
static int comes_back(runner *r, const pendres_strobe_lane *l)
{
  const long lag = l->period - r->ref_period;
  double dy = l->y - r->ref_y;
  const double turn = pendres_model_turn(l->pendulum), across = rint(dy / turn);
  dy -= turn * across;
  /* The more periods, the more often points come back by chance. */
  if (lag > 0 && lag <= LONGEST_ORBIT && (double)lag * hypot(dy, l->w - r->ref_w) < r->near) {
    const double turns = (double)(l->turns - r->ref_turns) + across;
    r->period = (int)lag;
    r->winding = fabs(turns) < 1e6 ? (int)turns : 0;
    return 1;
  }
  if (l->period >= r->next) {
    look_from(r, l);
    r->next = 2 * l->period;
  }
  return 0;
}

/* Distances shrink as exp(-gamma t / 2) at best: forty times that fits into double precision. */
static long transient_of(const job *j, const pendres_pendulum *p)
{
  if (j->transient > 0) return j->transient;
  return (long)fmax(TRANSIENT, fmin(1e7, 80.0 * p->drive_frequency / (two_pi * p->damping)));
}

static int visit(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const job *j = arg;
  runner *r = &j->runner[index];
  if (comes_back(r, lane)) {
    r->state = CAUGHT;
    return 1;
  }
  return lane->period >= transient_of(j, lane->pendulum) ||
         !(isfinite(lane->y) && isfinite(lane->w));
}

/* ---- orbits -------------------------------------------------------------------------------- */

static void take_orbit(const pendres_orbit *o, pendres_lyapunov *out)
{
  const double modulus = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  const double time = two_pi * o->period / o->pendulum.drive_frequency;
  *out = (pendres_lyapunov){
    .label = o->winding != 0 ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_PERIODIC,
    .exponent = log(modulus) / time,
    .exponent_error = o->multiplier_error / (modulus * time),
    .rotation = (double)o->winding / o->period,
    .rotation_error = 2.2e-16 * fabs((double)o->winding / o->period),
    .period = o->period,
    .winding = o->winding};
}

static int is_near(const pendres_orbit *o, const pendres_strobe_lane *l)
{
  const double turn = pendres_model_turn(l->pendulum);
  double dx = o->x - (l->y + pendres_model_origin(l->pendulum));
  dx -= turn * rint(dx / turn);
  return hypot(dx, o->v / o->pendulum.drive_frequency - l->w) < same_orbit;
}

/* The orbits that runners were caught near: those that are not stable, or not near, let them go. */
static pendres_status settle_caught(pendres_context *ctx, job *j, pendres_lyapunov *out)
{
  size_t count = 0, k = 0;
  for (size_t i = 0; i < j->n; i++) count += j->runner[i].state == CAUGHT;
  if (count == 0) return PENDRES_OK;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_orbit_guess *guess = malloc(count * sizeof *guess);
  pendres_orbit *orbit = malloc(count * sizeof *orbit);
  pendres_status *outcome = malloc(count * sizeof *outcome);
  if (guess == NULL || orbit == NULL || outcome == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu orbits", count);
    goto done;
  }
  for (size_t i = 0; i < j->n; i++) {
    const runner *r = &j->runner[i];
    if (r->state != CAUGHT) continue;
    pendres_orbit_guess *g = &guess[k++];
    const pendres_place at = {.y = r->lane.y, .w = r->lane.w};
    *g = (pendres_orbit_guess){
      .pendulum = *r->lane.pendulum, .period = r->period, .winding = r->winding};
    pendres_passage_out(r->lane.pendulum, &at, &g->x, &g->v);
  }
  status = pendres_orbit_refine(ctx, count, guess, PENDRES_ORBIT_PLAIN, orbit, outcome);
  k = 0;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    runner *r = &j->runner[i];
    if (r->state != CAUGHT) continue;
    const pendres_orbit *o = &orbit[k];
    const int good = outcome[k++] != PENDRES_NOT_CONVERGED && o->stable && is_near(o, &r->lane);
    r->state = good ? DONE : MOVING;
    r->near = very_close_by;
    if (good) take_orbit(o, &out[i]);
    if (good && j->orbit != NULL) j->orbit[i] = *o;
  }
done:
  free(guess);
  free(orbit);
  free(outcome);
  return status;
}

/* ---- averages ------------------------------------------------------------------------------ */

/* Weights of period k of n. */
static void smooth_weights(long k, long n, double weight[SPANS])
{
  const double t = ((double)k + 0.5) / (double)n;
  const double at[SPANS] = {[WHOLE] = t, [FIRST_HALF] = 2.0 * t, [SECOND_HALF] = 2.0 * t - 1.0};
  for (int s = 0; s < SPANS; s++) {
    const double product = at[s] * (1.0 - at[s]);
    weight[s] = product > 0.0 ? exp(-1.0 / product) : 0.0;
  }
}

/* What the averages of rotations take from a period. */
static void add_smooth(runner *r, const double weight[SPANS], double growth, double turned)
{
  for (int s = 0; s < SPANS; s++) {
    r->smooth_growth[s] += weight[s] * growth;
    r->smooth_turned[s] += weight[s] * turned;
  }
  r->length += growth;
  r->lengths += exp(r->length);
  r->reciprocals += exp(-r->length);
}

static void arrive(const pendres_rows *rows, size_t lane, long step, long batch, runner *r)
{
  pendres_strobe_lane *l = &r->lane;
  const double before = l->y;
  l->y = pendres_rows_get(rows, PENDRES_ROW_Y, lane);
  l->w = pendres_rows_get(rows, PENDRES_ROW_W, lane);
  const double turned = (l->y - before) / pendres_model_turn(l->pendulum);
  const double u = (pendres_rows_get(rows, PENDRES_ROW_Y, lane + 1) - l->y) / apart;
  const double v = (pendres_rows_get(rows, PENDRES_ROW_W, lane + 1) - l->w) / apart;
  const double length = fmax(hypot(u, v), DBL_MIN);
  pendres_passage_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  l->period++;
  r->u[0] = u / length;
  r->u[1] = v / length;
  if (step >= 0) {
    r->growth[step / batch] += log(length);
    r->turned[step / batch] += turned;
    if (pendres_lyapunov_may_rotate(l->pendulum)) {
      double weight[SPANS];
      smooth_weights(step, batch * BATCHES, weight);
      add_smooth(r, weight, log(length), turned);
    }
  }
  if (r->state == MOVING && comes_back(r, l)) r->state = CAUGHT;
}

/* Some runners of equal steps, side by side with their neighbours, over WARM_UP periods and BATCHES
   batches. */
static pendres_status average_block(pendres_block *block, size_t n, const pendres_rank *rank,
                                    runner *runners, long batch)
{
  pendres_status status = PENDRES_OK;
  pendres_block_resize(block, 2 * n);
  for (size_t i = 0; i < n; i++) {
    runner *r = &runners[rank[i].index];
    for (int b = 0; b < BATCHES; b++) r->growth[b] = r->turned[b] = 0.0;
    for (int s = 0; s < SPANS; s++) r->smooth_growth[s] = r->smooth_turned[s] = 0.0;
    r->length = r->lengths = r->reciprocals = 0.0;
  }
  for (long k = -WARM_UP; k < batch * BATCHES && status == PENDRES_OK; k++) {
    for (size_t i = 0; i < n; i++) {
      const runner *r = &runners[rank[i].index];
      const pendres_strobe_lane *l = &r->lane;
      pendres_block_load(block, 2 * i, l->pendulum, l->y, l->w);
      pendres_block_load(block, 2 * i + 1, l->pendulum, l->y + apart * r->u[0],
                         l->w + apart * r->u[1]);
    }
    status = pendres_block_period(block);
    const pendres_rows rows = pendres_block_rows(block);
    for (size_t i = 0; i < n && status == PENDRES_OK; i++)
      arrive(&rows, 2 * i, k, batch, &runners[rank[i].index]);
  }
  return status;
}

static pendres_status average(pendres_context *ctx, job *j, long batch)
{
  size_t count = 0;
  pendres_status status = PENDRES_OK;
  pendres_rank *rank = malloc((j->n + 1) * sizeof *rank);
  if (rank == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", j->n);
  for (size_t i = 0; i < j->n; i++)
    if (j->runner[i].state == MOVING)
      rank[count++] = (pendres_rank){.steps = j->runner[i].lane.steps,
                                     .model = pendres_model_kind(j->runner[i].lane.pendulum),
                                     .index = i};
  pendres_rank_order(count, rank);
  for (size_t first = 0, last; first < count && status == PENDRES_OK; first = last) {
    pendres_block block;
    status = pendres_block_open(ctx, PENDRES_FLOW_STATE, rank[first].steps, &block);
    if (status != PENDRES_OK) break;
    const size_t most = first + pendres_block_capacity(&block) / 2;
    last = first;
    while (last < count && last < most && pendres_rank_equal(&rank[last], &rank[first])) last++;
    status = average_block(&block, last - first, rank + first, j->runner, batch);
  }
  free(rank);
  return status;
}

/* Mean of the sums of batches a period, and its standard error. */
static double mean_of(const double sum[BATCHES], long batch, double *error)
{
  double mean = 0.0, square = 0.0;
  for (int b = 0; b < BATCHES; b++) mean += sum[b] / (double)(batch * BATCHES);
  for (int b = 0; b < BATCHES; b++) {
    const double d = sum[b] / (double)batch - mean;
    square += d * d;
  }
  *error = sqrt(square / (BATCHES * (BATCHES - 1.0)));
  return mean;
}

/*
 * Whether a runner is on a rotation that is not locked to the drive, and then its mean. A period's
 * error moves y by as much, and by omega/gamma times as much what its velocity is wrong by, which
 * friction forgets. What that does to the mean velocity depends on where on the invariant curve it
 * happens: in the coordinate h in which the motion is even, it is h' times as much, and the tangent
 * vector's length is as 1/h'.
 */
static int quasi_periodic(const runner *r, long periods, double accuracy, pendres_lyapunov *out)
{
  const pendres_pendulum *p = r->lane.pendulum;
  double norm[SPANS] = {0.0}, growth[SPANS], turned[SPANS];
  if (!pendres_lyapunov_may_rotate(p)) return 0;
  for (long k = 0; k < periods; k++) {
    double weight[SPANS];
    smooth_weights(k, periods, weight);
    for (int s = 0; s < SPANS; s++) norm[s] += weight[s];
  }
  for (int s = 0; s < SPANS; s++) {
    growth[s] = r->smooth_growth[s] / norm[s];
    turned[s] = r->smooth_turned[s] / norm[s];
  }
  const double growth_apart = fabs(growth[FIRST_HALF] - growth[SECOND_HALF]);
  const double turned_apart = fabs(turned[FIRST_HALF] - turned[SECOND_HALF]);
  if (!(growth_apart < same_mean && turned_apart < same_mean && fabs(growth[WHOLE]) < same_mean))
    return 0;
  const double n = (double)periods, rate = p->drive_frequency / two_pi;
  const double uneven = r->lengths / n * (r->reciprocals / n);
  const double period_error = accuracy * (1.0 + p->drive_frequency / p->damping) / two_pi;
  *out = (pendres_lyapunov){
    .label = PENDRES_LABEL_QUASI_PERIODIC,
    .exponent_error = (fabs(growth[WHOLE]) + growth_apart) * rate,
    .rotation = turned[WHOLE], .rotation_error = turned_apart + uneven * period_error};
  return 1;
}

/* What averages say; chaos and rotations that are not locked are done with. */
static void judge(job *j, long batch, double accuracy, pendres_lyapunov *out)
{
  for (size_t i = 0; i < j->n; i++) {
    runner *r = &j->runner[i];
    double error = 0.0, turned_error = 0.0;
    if (r->state != MOVING) continue;
    const double rate = r->lane.pendulum->drive_frequency / two_pi;
    const double growth = mean_of(r->growth, batch, &error);
    const double turned = mean_of(r->turned, batch, &turned_error);
    double least = least_growth;
    if (pendres_lyapunov_may_rotate(r->lane.pendulum))
      least = fmax(least, passing / (double)(batch * BATCHES));
    const int chaotic = growth > significance * error && growth > least;
    out[i] = (pendres_lyapunov){
      .label = chaotic ? PENDRES_LABEL_CHAOTIC : PENDRES_LABEL_UNRESOLVED,
      .exponent = growth * rate, .exponent_error = error * rate,
      .rotation = turned, .rotation_error = turned_error};
    if (chaotic || quasi_periodic(r, batch * BATCHES, accuracy, &out[i])) r->state = DONE;
  }
}

/* ---- the call ------------------------------------------------------------------------------ */

/* Fast enough for what the drive can do, for the way over a barrier, and for a torque that friction
   balances. */
static double speed_of(const pendres_pendulum *p, double x, double v)
{
  const double driven = fabs(p->drive_amplitude) / hypot(p->drive_frequency, p->damping);
  return fmax(pendres_steps_speed(p, x, v), 2.0 + driven + fabs(p->torque) / p->damping);
}

static pendres_status start(pendres_context *ctx, const job *j, const pendres_pendulum *p,
                            const double *x, const double *v)
{
  const double accuracy = pendres_accuracy_to_average(ctx);
  for (size_t i = 0; i < j->n; i++) {
    runner *r = &j->runner[i];
    *r = (runner){.lane = pendres_strobe_lane_at(&p[i], x[i], v[i]), .u = {0.6, 0.8},
                  .near = close_by, .next = 8};
    const pendres_status status =
      pendres_steps_choose(ctx, &p[i], speed_of(&p[i], x[i], v[i]), accuracy, &r->lane.steps);
    if (status != PENDRES_OK) return status;
    look_from(r, &r->lane);
  }
  return PENDRES_OK;
}

/* All lanes until they come back or their transient is over. */
static pendres_status run_transient(pendres_context *ctx, job *j)
{
  pendres_strobe_lane *lanes = malloc((j->n + 1) * sizeof *lanes);
  if (lanes == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", j->n);
  for (size_t i = 0; i < j->n; i++) lanes[i] = j->runner[i].lane;
  const pendres_status status = pendres_strobe_run(ctx, j->n, lanes, visit, j);
  for (size_t i = 0; i < j->n; i++) j->runner[i].lane = lanes[i];
  free(lanes);
  return status;
}

static pendres_status find_all(pendres_context *ctx, job *j, const pendres_pendulum *p,
                               const double *x, const double *v, pendres_lyapunov *out)
{
  long batch = (j->periods + BATCHES - 1) / BATCHES;
  pendres_status status = start(ctx, j, p, x, v);
  if (status == PENDRES_OK) status = run_transient(ctx, j);
  if (status == PENDRES_OK) status = settle_caught(ctx, j, out);
  for (int round = 0; round < ROUNDS && status == PENDRES_OK; round++, batch *= 2) {
    status = average(ctx, j, batch);
    if (status == PENDRES_OK) status = settle_caught(ctx, j, out);
    /* Those that were let go have averages of this round, and no result yet. */
    if (status == PENDRES_OK) judge(j, batch, pendres_accuracy_to_average(ctx), out);
  }
  return status;
}

static const char *refuses(const pendres_pendulum *p, double x, double v)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK) return why;
  if (p->damping == 0.0) return "without damping nothing settles";
  return pendres_passage_refuses(p, x, v);
}

pendres_status pendres_lyapunov_move(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                     double *x, double *v, pendres_lyapunov *out,
                                     pendres_orbit *orbit)
{
  job j = {.n = n, .runner = malloc((n + 1) * sizeof *j.runner), .orbit = orbit,
           .periods = PERIODS};
  if (j.runner == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  for (size_t i = 0; i < n; i++) orbit[i] = pendres_orbit_none(&p[i]);
  const pendres_status status = find_all(ctx, &j, p, x, v, out);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&j.runner[i].lane, &x[i], &v[i]);
  free(j.runner);
  return status;
}

static pendres_status lyapunov_find(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                    const double *x, const double *v,
                                    const pendres_lyapunov_options *options, pendres_lyapunov *out)
{
  static const pendres_lyapunov_options defaults = {0};
  const pendres_lyapunov_options *o = options != NULL ? options : &defaults;
  if (n > 0 && (p == NULL || x == NULL || v == NULL || out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x, v and out");
  if (o->transient < 0 || o->periods < 0 || o->transient > LONG_MAX / 64 ||
      o->periods > LONG_MAX / 64)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "transient and periods: numbers of drive periods, please");
  for (size_t i = 0; i < n; i++) {
    const char *why = refuses(&p[i], x[i], v[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  job j = {.n = n, .runner = malloc((n + 1) * sizeof *j.runner),
           .transient = o->transient, .periods = o->periods > 0 ? o->periods : PERIODS};
  if (j.runner == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  const pendres_status status = find_all(ctx, &j, p, x, v, out);
  free(j.runner);
  return status;
}

pendres_status pendres_lyapunov_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, const double *x,
                                     const double *v, const pendres_lyapunov_options *options,
                                     pendres_lyapunov *out)
{
  return PENDRES_CONTEXT_CALL(ctx, lyapunov_find(ctx, n, pendulums, x, v, options, out));
}
