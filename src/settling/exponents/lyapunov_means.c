/* lyapunov_means.c -- rotations without a lock, by their means; see lyapunov_runner.h. */
#include "settling/exponents/lyapunov_runner.h"
#include "settling/exponents/numbers.h"

#include <math.h>
#include <stdlib.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/steps.h"

/* The fraction p/q nearest to a mean, relative to its denominator of `most` at most: one of its
   continued fraction's convergents. Returns by how much q times the mean misses p. */
static double nearest(double mean, int most, int *q, int *p)
{
  double x = mean, q0 = 0.0, q1 = 1.0, p0 = 1.0, p1 = floor(x), misses = INFINITY;
  while (q1 <= most) {
    if (fabs(mean * q1 - p1) < misses) {
      misses = fabs(mean * q1 - p1);
      *q = (int)q1;
      *p = (int)p1;
    }
    x = 1.0 / (x - floor(x));
    const double q2 = floor(x) * q1 + q0, p2 = floor(x) * p1 + p0;
    q0 = q1;
    p0 = p1;
    q1 = q2;
    p1 = p2;
  }
  return misses;
}

int pendres_means_tell(pendres_runner *r, long periods, double enough, pendres_settled *out)
{
  double off = 0.0, square_off = 0.0;
  int q = 0, p = 0;
  const double turned = pendres_mean_take(&r->turns, &off);
  const double square = pendres_mean_take(&r->squares, &square_off);
  if (!(off < enough && square_off < 10.0 * means_least * square)) return 0;
  /* What has come back to where there is no stable orbit is slow there: what it does between slips
     is not its mean. Elsewhere it may be a little slower in one place than in another. */
  const double slips = fabs(turned * r->period - r->winding) * (double)periods;
  if (r->period > 0 && slips < MEANS_SLIPS) return 0;
  const double passed = nearest(turned, MEANS_SHORT_ORBIT, &q, &p) * (double)periods;
  if (passed < MEANS_SLIPS)
    off = fmax(off, pendres_mean_halves(&r->turns) * MEANS_SLIPS / fmin(1.0, passed));
  if (passed > means_rounding * q * (double)periods &&
      (passed < means_half_slip || !(off < enough)))
    return 0;
  if (nearest(turned, PENDRES_RUNNER_LONGEST_ORBIT, &q, &p) <
      q * (pendres_several_errors * off + means_rounding)) {
    r->period = q;
    r->winding = p;
    r->state = PENDRES_RUNNER_CAUGHT;
    return 0;
  }
  *out = (pendres_settled){.label = PENDRES_LABEL_QUASI_PERIODIC, .rotation = turned,
                            .rotation_error = off};
  return 1;
}

int pendres_means_scatter(const pendres_runner *r, long periods)
{
  double off = 0.0;
  (void)pendres_mean_take(&r->turns, &off);
  return periods >= MEANS_SHOW && off > means_few_slips / (double)periods;
}

static pendres_status steps_of_finer(pendres_context *ctx, const pendres_runner *r, int *steps)
{
  const pendres_pendulum *p = r->lane.pendulum;
  const int fewest = (int)ceil(finer_steps * r->steps);
  pendres_status status = pendres_steps_choose(ctx, p, pendres_steps_turning_speed(p),
                                               pendres_accuracy_of_means(ctx), steps);
  if (status == PENDRES_TOLERANCE_UNREACHABLE) status = PENDRES_OK; /* the error says so */
  else if (*steps >= fewest) return status;
  *steps = fewest;
  return status;
}

static void compare(pendres_runner *r, const pendres_runner *finer, pendres_settled *out)
{
  const double closer_by = pow((double)r->steps / finer->lane.steps, 4);
  double off = 0.0;
  const double turned = pendres_mean_take(&finer->turns, &off);
  const double apart = fabs(turned - out->rotation) + out->rotation_error;
  r->lane = finer->lane;
  r->lane.steps = r->steps;
  out->rotation = turned;
  out->rotation_error = off + closer_by * apart + means_rounding * (1.0 + fabs(turned));
  if (off + apart < 10.0 * means_least) return;
  out->label = PENDRES_LABEL_UNRESOLVED;
  r->state = PENDRES_RUNNER_MOVING;
}

pendres_status pendres_means_refine(pendres_context *ctx, size_t n, pendres_runner *runners,
                                    long batch, pendres_settled *out)
{
  size_t count = 0, k = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) count += runners[i].rough != 0;
  if (count == 0) return status;
  pendres_runner *finer = malloc(count * sizeof *finer);
  if (finer == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", count);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (!runners[i].rough) continue;
    finer[k] = runners[i];
    finer[k].state = PENDRES_RUNNER_MOVING;
    finer[k].beside = PENDRES_BESIDE_NOTHING;
    finer[k].near = 0.0; /* not to be caught */
    status = steps_of_finer(ctx, &runners[i], &finer[k++].lane.steps);
  }
  if (status == PENDRES_OK) status = pendres_runners_average(ctx, count, finer, batch);
  k = 0;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (!runners[i].rough) continue;
    runners[i].rough = 0;
    compare(&runners[i], &finer[k++], &out[i]);
  }
  free(finer);
  return status;
}
