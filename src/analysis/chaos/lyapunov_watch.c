/* lyapunov_watch.c -- whether chaos stays as it is; see lyapunov_watch.h. */
#include "analysis/chaos/lyapunov_watch.h"

#include <math.h>
#include <stdlib.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/steps.h"
#include "model/model.h"

enum { BATCHES = PENDRES_RUNNER_BATCHES };

/* Student's t of 14 degrees of freedom is beyond this once in 13,000 times: of thirteen places in
   which batches can be parted, once in a thousand at most. */
static const double apart_by_chance = 5.5;

/* What is seen of a runner while it is watched, in batches. */
typedef struct look {
  pendres_runner *runner;
  long from, batch; /* periods */
  double at;        /* turns, unwrapped */
  double turned[BATCHES], square[BATCHES];
} look;

/* ---- batches ------------------------------------------------------------------------------- */

double pendres_batches_mean(const double sum[BATCHES], long batch, double *error)
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

int pendres_batches_change(const double sum[BATCHES])
{
  double all = 0.0, first = 0.0, square = 0.0, between = 0.0;
  for (int b = 0; b < BATCHES; b++) all += sum[b];
  const double mean = all / BATCHES;
  for (int b = 0; b < BATCHES; b++) square += (sum[b] - mean) * (sum[b] - mean);
  for (int k = 1; k < BATCHES - 1; k++) {
    first += sum[k - 1] - mean;
    if (k > 1) between = fmax(between, first * first * BATCHES / (k * (BATCHES - k)));
  }
  return between * (BATCHES - 2) > apart_by_chance * apart_by_chance * (square - between);
}

/* Whether later batches differ from those before, or among each other. */
static int differ(const double before[BATCHES], long batch, const double later[BATCHES],
                  long later_batch)
{
  double error, later_error;
  const double mean = pendres_batches_mean(before, batch, &error);
  const double later_mean = pendres_batches_mean(later, later_batch, &later_error);
  return fabs(later_mean - mean) > apart_by_chance * hypot(error, later_error) ||
         pendres_batches_change(later);
}

/* ---- the watch ----------------------------------------------------------------------------- */

static double turns_of(const pendres_strobe_lane *l)
{
  return (double)l->turns + l->y / pendres_model_turn(l->pendulum);
}

static int visit(void *arg, size_t index, const pendres_strobe_lane *l)
{
  look *k = (look *)arg + index;
  pendres_runner *r = k->runner;
  const long in = (l->period - k->from - 1) / k->batch;
  const double at = turns_of(l);
  k->turned[in] += at - k->at;
  k->square[in] += l->w * l->w;
  k->at = at;
  pendres_runner_pass(r, l);
  if (pendres_runner_leaves(r, l)) return 1;
  if (pendres_runner_comes_back(r, l)) {
    r->state = PENDRES_RUNNER_CAUGHT;
    return 1;
  }
  return l->period >= k->from + BATCHES * k->batch || !(isfinite(l->y) && isfinite(l->w));
}

/* Begin to watch a runner, with the steps of averages: with an error of 1e-4 a period
   chaos was seen to miss its end in six of nineteen pendulums that leave it late. */
static pendres_status begin(pendres_context *ctx, double accuracy, pendres_runner *r, long batch,
                            look *k, pendres_strobe_lane *lane)
{
  double x, v;
  r->state = PENDRES_RUNNER_MOVING;
  *lane = r->lane;
  *k = (look){.runner = r, .from = lane->period, .batch = batch, .at = turns_of(lane)};
  pendres_strobe_lane_out(lane, &x, &v);
  lane->added = 0.0;
  const double speed = fmax(pendres_steps_speed(lane->pendulum, x, v),
                            pendres_steps_turning_speed(lane->pendulum));
  return pendres_steps_choose(ctx, lane->pendulum, speed, accuracy, &lane->steps);
}

static void end(const look *k, const pendres_strobe_lane *lane, long batch)
{
  pendres_runner *r = k->runner;
  const int steps = r->lane.steps;
  r->lane = *lane;
  r->lane.steps = steps;
  if (r->state == PENDRES_RUNNER_MOVING && lane->period == k->from + BATCHES * k->batch &&
      !differ(r->turned, batch, k->turned, k->batch) &&
      !differ(r->square, batch, k->square, k->batch))
    r->state = PENDRES_RUNNER_DONE;
}

pendres_status pendres_runners_watch(pendres_context *ctx, size_t n, const size_t *which,
                                     pendres_runner *runners, long batch, long longer)
{
  const double accuracy = pendres_accuracy_to_average(ctx);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  look *looks = malloc((n + 1) * sizeof *looks);
  pendres_strobe_lane *lanes = malloc((n + 1) * sizeof *lanes);
  if (looks == NULL || lanes == NULL)
    (void)pendres_context_fail(ctx, status, "out of memory for %zu lanes", n);
  else
    status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = begin(ctx, accuracy, &runners[which[i]], longer * batch, &looks[i], &lanes[i]);
  if (status == PENDRES_OK)
    status = pendres_strobe_run_within(ctx, accuracy, n, lanes, visit, looks);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) end(&looks[i], &lanes[i], batch);
  free(looks);
  free(lanes);
  return status;
}
