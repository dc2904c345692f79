/* ramp.c -- a parameter that moves in real time; see ramp.h. */
#include <pendres/ramp.h>

#include <math.h>
#include <stdlib.h>

#include "analysis/sweeps/numbers.h"
#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/strobe_run.h"
#include "model/equation.h"
#include "model/parameter.h"
#include "noise/langevin_internal.h"
#include "settling/trapping/escape.h"
#include "analysis/sweeps/ramp_watch.h"

/* ---- ramps ---- */

long pendres_ramp_periods(const pendres_ramp *ramp)
{
  return ramp != NULL && ramp->corners > 0 && ramp->period != NULL
           ? ramp->period[ramp->corners - 1] : 0;
}

double pendres_ramp_value(const pendres_ramp *ramp, double time)
{
  if (ramp == NULL || ramp->corners < 2 || ramp->period == NULL || ramp->value == NULL) return NAN;
  size_t low = 0, high = ramp->corners - 1;
  if (!(time >= (double)ramp->period[low] && time <= (double)ramp->period[high])) return NAN;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (time < (double)ramp->period[middle]) high = middle;
    else low = middle;
  }
  const double begin = (double)ramp->period[low], end = (double)ramp->period[high];
  const double part = (time - begin) / (end - begin);
  return ramp->value[low] + part * (ramp->value[high] - ramp->value[low]);
}

/* What moves, at which temperature, and in how many parts drive periods are divided: one each is
   a period of a pendulum that has this many times the frequency of a drive that is none. */
typedef struct motion {
  const pendres_ramp *ramp;
  double temperature;
  long clock;
} motion;

static pendres_pendulum pendulum_with(const motion *m, double value)
{
  pendres_pendulum p = m->ramp->pendulum;
  p.temperature = m->temperature;
  pendres_parameter_set(m->ramp->parameter, value, &p);
  p.drive_frequency *= (double)m->clock;
  return p;
}

static pendres_pendulum pendulum_at(void *arg, double time)
{
  const motion *m = arg;
  return pendulum_with(m, pendres_ramp_value(m->ramp, time / (double)m->clock));
}

static const char *refuses(const pendres_ramp *r)
{
  const char *why = pendres_parameter_refuses(r->parameter, r->pendulum.force);
  if (why != NULL) return why;
  if (r->corners < 2) return "a ramp has two corners or more";
  if (r->period[0] != 0) return "a ramp starts at time 0";
  for (size_t i = 1; i < r->corners; i++)
    if (r->period[i] <= r->period[i - 1]) return "the times of a ramp's corners must ascend";
  if (r->period[r->corners - 1] > (long)UINT32_MAX) return "a ramp ends before period 2^32";
  if (r->points < 1) return "the path of an infinitely slow ramp is needed";
  if (r->point[0].value != r->value[0]) return "path and ramp must start at the same value";
  for (size_t k = 0; k < r->jumps; k++)
    if (r->jump[k].step < 1 || r->jump[k].step >= r->points ||
        (k > 0 && r->jump[k].step < r->jump[k - 1].step))
      return "the jumps are not of this path";
  return NULL;
}

static pendres_status check(pendres_context *ctx, const pendres_ramp *r)
{
  if (r == NULL) return PENDRES_CONTEXT_NULL(ctx, "ramp");
  if (r->period == NULL || r->value == NULL || r->point == NULL ||
      (r->jumps > 0 && r->jump == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "period, value, point and jump");
  const char *why = refuses(r);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  motion m = {.ramp = r, .temperature = r->pendulum.temperature, .clock = 1};
  const pendres_langevin_moving run = {.motion = pendulum_at, .arg = &m, .steps = RAMP_MOST_STEPS,
                                       .x = r->point[0].x, .v = r->point[0].v};
  for (size_t i = 0; i < r->corners; i++) {
    const pendres_status status = pendres_langevin_moving_accept(ctx, &run, (double)r->period[i]);
    if (status != PENDRES_OK) return status;
    const pendres_pendulum p = pendulum_at(&m, (double)r->period[i]);
    why = pendres_equation_undamped(&p);
    if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  }
  return PENDRES_OK;
}

/* ---- steps ---- */

static pendres_pendulum standing_still(void *arg, double time)
{
  const pendres_pendulum *p = arg;
  (void)time;
  return *p;
}

static pendres_langevin_answer take_end(void *arg, const pendres_langevin_strobe *s)
{
  double *end = arg;
  end[0] = s->x[0];
  end[1] = s->v[0];
  return PENDRES_LANGEVIN_GO_ON;
}

/* The error of a period of a state with this many steps, from a run with twice as many. Errors of
   later periods add to it until it has died away. */
static pendres_status probe(pendres_context *ctx, const motion *m,
                            const pendres_hysteresis_point *point, int steps, double *off)
{
  pendres_pendulum p = pendulum_with(m, point->value);
  p.temperature = 0.0;
  const double lost = -expm1(-pendres_equation_fading(&p));
  double end[2][2];
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    const pendres_langevin_observer observer = {.see = take_end, .arg = end[k]};
    const pendres_langevin_moving run = {
      .motion = standing_still, .arg = &p, .n = 1, .periods = 1,
      .steps = steps << k, .x = point->x, .v = point->v, .observer = &observer};
    status = pendres_langevin_move(ctx, &run);
  }
  if (status == PENDRES_OK)
    *off = fmax(fabs(end[1][0] - end[0][0]), fabs(end[1][1] - end[0][1])) / lost;
  return status;
}

/* Choose steps whose strobe points meet a tolerance in the states of the path; the error falls with
   order four. */
static pendres_status choose_steps(pendres_context *ctx, const motion *m, double tolerance,
                                   int *steps)
{
  const pendres_ramp *r = m->ramp;
  const int asked = ctx->options.steps_per_period;
  *steps = asked > 0 ? (int)fmax(2.0, ceil(asked / (double)m->clock)) : 0;
  if (*steps > 0) return PENDRES_OK;
  *steps = RAMP_FEWEST_STEPS;
  const size_t apart = (r->points + RAMP_PROBES - 1) / RAMP_PROBES;
  for (size_t i = 0; i < r->points; i += apart) {
    if (!(isfinite(r->point[i].x) && isfinite(r->point[i].v))) continue;
    if (r->point[i].attractor.label == PENDRES_LABEL_ESCAPE) continue; /* no state to stay in */
    for (;;) {
      double off = 0.0;
      const pendres_status status = probe(ctx, m, &r->point[i], *steps, &off);
      if (status != PENDRES_OK) return status;
      if (off <= tolerance || *steps >= RAMP_MOST_STEPS) break;
      *steps *= 2;
    }
  }
  return PENDRES_OK;
}

/* ---- without noise ---- */

/* Trajectories that are followed, and where points of the first go. */
typedef struct course {
  int steps;         /* a part of a drive period */
  size_t n;          /* trajectories, ... */
  uint64_t first_id; /* ... and the number of the first */
  long every;        /* drive periods from one point to the next */
  double *x, *v;     /* points; NULL: not wanted */
} course;

/* One run, watched. */
typedef struct run {
  pendres_ramp_watch watch;
  const course *course;
} run;

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *s)
{
  run *r = arg;
  pendres_ramp_watch_see(&r->watch, s);
  const course *c = r->course;
  const long every = c->every * r->watch.clock;
  if (c->x != NULL && s->period % every == 0) {
    c->x[s->period / every] = s->x[0];
    c->v[s->period / every] = s->v[0];
  }
  return PENDRES_LANGEVIN_GO_ON;
}

/* time[jumps][n] receives the jumps. */
static pendres_status follow(pendres_context *ctx, motion *m, const course *c, double *time)
{
  const pendres_ramp *ramp = m->ramp;
  run r = {.course = c};
  const pendres_langevin_observer observer = {.see = see, .arg = &r, .harmonics = 1};
  const pendres_langevin_moving moving = {
    .motion = pendulum_at, .arg = m, .n = c->n, .first_id = c->first_id,
    .periods = m->clock * pendres_ramp_periods(ramp), .steps = c->steps, .x = ramp->point[0].x,
    .v = ramp->point[0].v, .may_leave = pendres_escape_possible(&ramp->pendulum),
    .observer = &observer};
  if (c->x != NULL) {
    c->x[0] = moving.x;
    c->v[0] = moving.v;
  }
  pendres_status status = pendres_ramp_watch_open(ctx, ramp, c->n, time, &r.watch);
  if (status == PENDRES_OK) status = pendres_langevin_move(ctx, &moving);
  if (status == PENDRES_OK) pendres_ramp_watch_end(&r.watch);
  pendres_ramp_watch_close(&r.watch);
  return status;
}

/*
 * With half as many steps the error is four times as large where the parameter's motion counts, of
 * order two, and sixteen times as large elsewhere, of order four: the finer run is off by a
 * fifteenth to a third of the distance. The two kinds may cancel in part, and so all of it is
 * claimed.
 */
static double error_of(double distance)
{
  return pendres_strobe_error(distance) < INFINITY ? distance : INFINITY;
}

/* The largest share of an error that can be left after some periods. */
static double left_after(const pendres_ramp *r, double time, double periods)
{
  motion m = {.ramp = r, .clock = 1};
  const pendres_pendulum p = pendulum_at(&m, time);
  return exp(-pendres_equation_fading(&p) * periods);
}

/* The rounding errors of the steps that have not died away yet. */
static double rounding_of(const pendres_ramp *r, double steps)
{
  return 2.0 * last_place_of_one * sqrt(steps) / (1.0 - left_after(r, 0.0, 1.0));
}

/*
 * x_error and v_error hold the coarser run, and receive the errors. Errors oscillate while they die
 * away, and those of the two orders may cancel at a point: no error is claimed to be less than what
 * is left of the error at the point before.
 */
static void compare(const pendres_ramp *r, const pendres_ramp_record *record, size_t n,
                    double rounding)
{
  const double apart = (double)record->every;
  double lost = 0.0, off = 0.0;
  for (size_t k = 0; k < n; k++) {
    const double dx = fabs(record->x[k] - record->x_error[k]);
    const double dv = fabs(record->v[k] - record->v_error[k]);
    off = fmax(error_of(fmax(dx, dv)), off * left_after(r, apart * (double)k, apart));
    if (!(off < INFINITY)) lost = INFINITY;
    record->x_error[k] = lost + off + rounding + last_place_of_one * fabs(record->x[k]);
    record->v_error[k] = lost + off + rounding;
  }
  if (n > 0) record->x_error[0] = record->v_error[0] = 0.0;
}

/* Where one of both runs is on its way to infinity, beyond all lengths of the force, nothing is
   known from there on: the number of the first such point, n if there is none. x_error and v_error
   hold the coarser run. */
static size_t bounded(const pendres_ramp *r, const pendres_ramp_record *record, size_t n)
{
  size_t k = 0;
  if (!pendres_escape_possible(&r->pendulum)) return n;
  while (k < n && !pendres_escape_lost(record->x[k], record->v[k]) &&
         !pendres_escape_lost(record->x_error[k], record->v_error[k]))
    k++;
  return k;
}

static void forget(const pendres_ramp_record *record, size_t from, size_t n)
{
  for (size_t k = from; k < n; k++)
    record->x[k] = record->v[k] = record->x_error[k] = record->v_error[k] = NAN;
}

static void judge(const pendres_ramp *r, const double *coarse, const double *fine,
                  double rounding, pendres_ramp_jump *jump)
{
  for (size_t k = 0; k < r->jumps; k++) {
    const pendres_jump *j = &r->jump[k];
    pendres_ramp_jump *out = &jump[k];
    *out = (pendres_ramp_jump){.time = fine[k], .value = NAN, .value_error = NAN, .delay = NAN,
                               .delay_error = NAN};
    if (isnan(fine[k])) continue;
    const double off = fabs(fine[k] - coarse[k]), behind = fmin(fine[k] + 1.0,
      (double)pendres_ramp_periods(r));
    out->value = pendres_ramp_value(r, fine[k]);
    const double rate = fabs(pendres_ramp_value(r, behind) - out->value);
    /* Not less than rounding, of the state and of the parameter itself. */
    out->value_error = (isnan(off) ? INFINITY : rate * (off + 10.0 * rounding)) +
                       2.0 * last_place_of_one * fabs(out->value);
    out->delay = j->direction * (out->value - j->value);
    out->delay_error = out->value_error + j->value_error;
  }
}

static pendres_status ramp_follow(pendres_context *ctx, const pendres_ramp *ramp,
                                  const pendres_ramp_record *record, pendres_ramp_jump *jump)
{
  const pendres_ramp_record none = {.every = 1}, *to = record != NULL ? record : &none;
  pendres_status status = check(ctx, ramp);
  if (status != PENDRES_OK) return status;
  if (record != NULL && (to->x == NULL || to->v == NULL || to->x_error == NULL ||
                         to->v_error == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "the arrays of a record");
  if (to->every < 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "points of a record are at least a drive period apart");
  double *time = malloc((2 * ramp->jumps + 1) * sizeof *time);
  if (time == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for jumps");
  double *fine = time + ramp->jumps;
  motion m = {.ramp = ramp, .temperature = 0.0};
  int steps = 0;
  status = pendres_ramp_watch_clock(ctx, ramp, &m.clock);
  if (status == PENDRES_OK) status = choose_steps(ctx, &m, ctx->options.tolerance, &steps);
  const int half = (steps + 1) / 2;
  const course coarser = {
    .steps = half, .n = 1, .every = to->every, .x = to->x_error, .v = to->v_error};
  const course finer = {.steps = 2 * half, .n = 1, .every = to->every, .x = to->x, .v = to->v};
  if (status == PENDRES_OK) status = follow(ctx, &m, &coarser, time);
  if (status == PENDRES_OK) status = follow(ctx, &m, &finer, fine);
  const double rounding = rounding_of(ramp, 2 * half * (double)m.clock);
  if (status == PENDRES_OK && jump != NULL) judge(ramp, time, fine, rounding, jump);
  if (status == PENDRES_OK && record != NULL) {
    const size_t n = (size_t)(pendres_ramp_periods(ramp) / to->every) + 1;
    const size_t known = bounded(ramp, record, n);
    compare(ramp, record, known, rounding);
    forget(record, known, n);
  }
  free(time);
  return status;
}

/* Open the door to a ramp; returns it as it is behind, in *inside. One that is refused stays as it
   is. */
static const pendres_ramp *open_ramp(pendres_door *d, pendres_context *ctx,
                                     const pendres_ramp *ramp, pendres_ramp *inside)
{
  *inside = (pendres_ramp){.corners = 0};
  if (ramp != NULL) *inside = *ramp;
  *d = pendres_door_open_along(ctx, &inside->pendulum, inside->parameter, inside->corners,
                               inside->value);
  if (ramp == NULL || d->status != PENDRES_OK || !pendres_door_changes(d)) return ramp;
  pendres_units_in(&d->scales, &pendres_dim_pendulum, 1, &inside->pendulum);
  inside->value = pendres_door_in(d, &pendres_dim_first, ramp->corners, ramp->value);
  inside->point = pendres_door_in(d, &pendres_dim_hysteresis_point, ramp->points, ramp->point);
  inside->jump = pendres_door_in(d, &pendres_dim_jump, ramp->jumps, ramp->jump);
  return inside;
}

pendres_status pendres_ramp_find(pendres_context *ctx, const pendres_ramp *ramp,
                                 const pendres_ramp_record *record, pendres_ramp_jump *jump)
{
  pendres_door d;
  pendres_ramp inside;
  ramp = open_ramp(&d, ctx, ramp, &inside);
  if (ramp != NULL) jump = pendres_door_out(&d, &pendres_dim_ramp_jump, ramp->jumps, jump);
  if (ramp != NULL && record != NULL && record->every > 0) {
    const size_t n = (size_t)(pendres_ramp_periods(ramp) / record->every) + 1;
    pendres_door_out_record(&d, n, &(pendres_record){record->x, record->v, record->x_error,
                                                     record->v_error});
  }
  return PENDRES_DOOR_END(&d, ramp_follow(ctx, ramp, record, jump));
}

/* ---- with noise ---- */

static pendres_status ramp_scatter(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                   uint64_t first_id, double *time, double *value)
{
  pendres_status status = check(ctx, ramp);
  if (status != PENDRES_OK) return status;
  if (time == NULL && n > 0 && ramp->jumps > 0) return PENDRES_CONTEXT_NULL(ctx, "time");
  motion m = {.ramp = ramp, .temperature = ramp->pendulum.temperature};
  course c = {.n = n, .first_id = first_id};
  status = pendres_ramp_watch_clock(ctx, ramp, &m.clock);
  if (status == PENDRES_OK)
    status = choose_steps(ctx, &m, pendres_accuracy_with_noise(ctx), &c.steps);
  if (status == PENDRES_OK) status = follow(ctx, &m, &c, time);
  for (size_t i = 0; i < ramp->jumps * n && status == PENDRES_OK && value != NULL; i++)
    value[i] = pendres_ramp_value(ramp, time[i]);
  return status;
}

pendres_status pendres_ramp_scatter(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                    uint64_t first_id, double *time, double *value)
{
  pendres_door d;
  pendres_ramp inside;
  ramp = open_ramp(&d, ctx, ramp, &inside);
  if (ramp != NULL) value = pendres_door_out(&d, &pendres_dim_first, ramp->jumps * n, value);
  return PENDRES_DOOR_END(&d, ramp_scatter(ctx, ramp, n, first_id, time, value));
}

pendres_status pendres_ramp_summarize(size_t n, const double *value, pendres_ramp_summary *out)
{
  double sum = 0.0, two = 0.0, four = 0.0;
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = (pendres_ramp_summary){.mean = NAN, .mean_error = NAN, .deviation = NAN,
                                .deviation_error = NAN};
  if (n > 0 && value == NULL) return PENDRES_INVALID_ARGUMENT;
  for (size_t i = 0; i < n; i++)
    if (!isnan(value[i])) {
      out->count++;
      sum += value[i];
    }
  const double count = (double)out->count;
  if (out->count > 0) out->mean = sum / count;
  for (size_t i = 0; i < n; i++)
    if (!isnan(value[i])) {
      const double square = (value[i] - out->mean) * (value[i] - out->mean);
      two += square;
      four += square * square;
    }
  if (out->count < 2) return PENDRES_OK;
  out->deviation = sqrt(two / (count - 1.0));
  out->mean_error = out->deviation / sqrt(count);
  if (out->count < 4 || out->deviation == 0.0) return PENDRES_OK;
  /* The variance of a sample's variance, by its fourth moment. */
  const double variance = two / (count - 1.0);
  const double spread = four / count - variance * variance * (count - 3.0) / (count - 1.0);
  out->deviation_error = 0.5 * sqrt(fmax(0.0, spread) / count) / out->deviation;
  return PENDRES_OK;
}
