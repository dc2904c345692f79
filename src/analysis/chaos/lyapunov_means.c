/* lyapunov_means.c -- rotations without a lock, by their means; see lyapunov_means.h. */
#include "analysis/chaos/lyapunov_means.h"

#include <math.h>
#include <stdlib.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/steps.h"

enum {
  SLIPS = 3,   /* of a rotation by where a lock has ended, for its mean to be known */
  SHOWS = 1024 /* periods after which chaos shows in means */
};

/* Mean turns a period are known to this, and the mean square of the velocity to ten times this share
   of it: in chaos that would take 1e10 periods. */
static const double least = 1e-6;
/* A rotation that slips once in n periods is known to a few slips in n periods. */
static const double few_slips = 5.0;
/* With this factor more steps errors are seen; they fall by its fourth power at least. */
static const double more_steps = 1.4, order = 4.0;
/* The last digits of a mean are lost to rounding. */
static const double rounding = 2.2e-14;

double pendres_means_least(void)
{
  return least;
}

double pendres_means_wanted(const pendres_context *ctx)
{
  return 0.1 * pendres_accuracy_of_means(ctx);
}

int pendres_means_tell(const pendres_runner *r, long periods, double enough,
                       pendres_lyapunov *out)
{
  double off = 0.0, square_off = 0.0;
  const double turned = pendres_mean_take(&r->turns, &off);
  const double square = pendres_mean_take(&r->squares, &square_off);
  if (!(off < enough && square_off < 10.0 * least * square)) return 0;
  /* What has come back to where there is no stable orbit is slow there: what it does between slips
     is not its mean. */
  const double slips = fabs(turned * r->period - r->winding) * (double)periods;
  if (r->period > 0 && slips < SLIPS) return 0;
  *out = (pendres_lyapunov){.label = PENDRES_LABEL_QUASI_PERIODIC, .rotation = turned,
                            .rotation_error = off};
  return 1;
}

int pendres_means_scatter(const pendres_runner *r, long periods)
{
  double off = 0.0;
  (void)pendres_mean_take(&r->turns, &off);
  return periods >= SHOWS && off > few_slips / (double)periods;
}

static pendres_status finer_steps(pendres_context *ctx, const pendres_runner *r, int *steps)
{
  const pendres_pendulum *p = r->lane.pendulum;
  const int fewest = (int)ceil(more_steps * r->steps);
  pendres_status status = pendres_steps_choose(ctx, p, pendres_steps_turning_speed(p),
                                               pendres_accuracy_of_means(ctx), steps);
  if (status == PENDRES_TOLERANCE_UNREACHABLE) status = PENDRES_OK; /* the error says so */
  else if (*steps >= fewest) return status;
  *steps = fewest;
  return status;
}

static void compare(pendres_runner *r, const pendres_runner *finer, pendres_lyapunov *out)
{
  const double closer_by = pow((double)r->steps / finer->lane.steps, order);
  double off = 0.0;
  const double turned = pendres_mean_take(&finer->turns, &off);
  const double apart = fabs(turned - out->rotation) + out->rotation_error;
  r->lane = finer->lane;
  r->lane.steps = r->steps;
  out->rotation = turned;
  out->rotation_error = off + closer_by * apart + rounding * (1.0 + fabs(turned));
  if (off + apart < 10.0 * least) return;
  out->label = PENDRES_LABEL_UNRESOLVED;
  r->state = PENDRES_RUNNER_MOVING;
}

pendres_status pendres_means_refine(pendres_context *ctx, size_t n, pendres_runner *runners,
                                    long batch, pendres_lyapunov *out)
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
    status = finer_steps(ctx, &runners[i], &finer[k++].lane.steps);
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
