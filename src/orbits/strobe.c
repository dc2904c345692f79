/* strobe.c -- the stroboscopic map of any list of pendulums; see strobe.h. */
#include <pendres/strobe.h>

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/passage.h"
#include "engine/steps.h"
#include "orbits/strobe_noise.h"
#include "engine/strobe_run.h"

static int after_all_periods(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  (void)index;
  return lane->period >= *(const long *)arg;
}

static pendres_status check(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                            const double *x, const double *v, long periods)
{
  const char *why = NULL;
  if (periods < 0)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%ld periods: not negative, please",
                                periods);
  for (size_t i = 0; i < n; i++) {
    if (pendres_pendulum_check(&p[i], &why) == PENDRES_OK)
      why = pendres_passage_refuses(&p[i], x[i], v[i]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  return PENDRES_OK;
}

/* Every state is a number, or a failure with a sentence. */
static pendres_status check_ends(pendres_context *ctx, size_t n, const pendres_strobe_lane *lanes)
{
  for (size_t i = 0; i < n; i++)
    if (!(isfinite(lanes[i].y) && isfinite(lanes[i].w)))
      return pendres_strobe_lost(ctx, lanes[i].pendulum, lanes[i].period);
  return PENDRES_OK;
}

/* Periods whose errors are still there at the end: they fade as exp(-gamma t / 2). */
static double periods_that_count(const pendres_pendulum *p, long periods)
{
  const double decay = -expm1(-0.5 * p->damping * two_pi / p->drive_frequency);
  return 1.0 / fmax(decay, 1.0 / fmax(1.0, (double)periods));
}

/* More steps (`refinement` times as many) where steps are fixed. */
static pendres_status load(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                           const double *x, const double *v, long periods, double refinement,
                           pendres_strobe_lane *lanes)
{
  for (size_t i = 0; i < n; i++) {
    pendres_strobe_lane *l = &lanes[i];
    *l = pendres_strobe_lane_at(&p[i], x[i], v[i]);
    if (!pendres_method_of(ctx)->fixed_steps) continue;
    const pendres_status status =
      pendres_steps_choose(ctx, &p[i], pendres_steps_speed(&p[i], x[i], v[i]),
                           pendres_accuracy_of_run(ctx, periods_that_count(&p[i], periods)),
                           &l->steps);
    if (status != PENDRES_OK) return status;
    if (refinement != 1.0) l->steps = pendres_steps_rung((int)ceil(l->steps * refinement));
  }
  return PENDRES_OK;
}

/*
 * A clock that runs on is rounded by each step, by up to half a unit of its last place, and what is
 * not forgotten adds up at random, some hundred steps a period. The state's own rounding is far
 * below. A block's clock starts anew each period.
 */
static double clock_noise(const pendres_context *ctx, const pendres_pendulum *p, long periods)
{
  if (!pendres_method_of(ctx)->running_clock) return 0.0;
  const double step = 1.1e-16 * two_pi * (double)periods;
  return step * sqrt(100.0 * periods_that_count(p, periods));
}

/*
 * The same pendulums once more, by a better method: more steps where they are fixed, else a smaller
 * tolerance. noise[n] receives the rounding errors.
 */
static pendres_status run_finer(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                const double *x, const double *v, long periods,
                                pendres_strobe_lane *finer, double *noise)
{
  pendres_status status = load(ctx, n, p, x, v, periods, 1.4, finer);
  if (status != PENDRES_OK) return status;
  const int fixed = pendres_method_of(ctx)->fixed_steps;
  const double rounding = pendres_strobe_noise_of_step(ctx->options.table);
  for (size_t i = 0; i < n && fixed; i++) finer[i].added = rounding * rounding;
  status = pendres_strobe_run_within(ctx, pendres_accuracy_second(ctx), n, finer,
                                     after_all_periods, &periods);
  for (size_t i = 0; i < n; i++)
    noise[i] = fixed ? pendres_strobe_noise_of(p[i].drive_frequency, &finer[i].off)
                     : clock_noise(ctx, &p[i], periods);
  return status;
}

/* |a - b| of two final states, in x and v. */
static double distance(const pendres_strobe_lane *a, const pendres_strobe_lane *b)
{
  const double dy = (a->y - b->y) + two_pi * (double)(a->turns - b->turns);
  const double dv = (a->w - b->w) * a->pendulum->drive_frequency;
  return fmax(fabs(dy), fabs(dv));
}

/*
 * From the distance of two runs and the standard error of rounding; what is lost in the last sums
 * comes on top.
 */
static double error_of(double apart, double noise, const pendres_strobe_lane *l)
{
  const double v = fabs(l->w) * l->pendulum->drive_frequency;
  return pendres_strobe_doubt(apart) + 2.0 * noise +
         2.2e-16 * fmax(8.0 + two_pi * fabs((double)l->turns), v);
}

/*
 * Along one expanding direction two errors of either sign may be equal by chance. Where
 * errors have grown, a third run with twice the steps is asked as well: apart[i] becomes the larger
 * distance. Adaptive steps follow their tolerance loosely (stability, not the tolerance, limits the
 * steps of stiff pendulums), so that a tenth of it may change next to nothing. With such methods
 * all pendulums are therefore run a third time, with a tolerance that is smaller again. noise[] as
 * in run_finer; lanes[n] is the first run, room[n] is scratch.
 */
static pendres_status ask_thirdly(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                  const double *x, const double *v, long periods,
                                  const pendres_strobe_lane *lanes, const double *noise,
                                  pendres_strobe_lane *room, double *apart)
{
  const double grown = 1e-13; /* rounding of some hundred steps, times a hundred */
  const int fixed = pendres_method_of(ctx)->fixed_steps;
  size_t some = 0;
  for (size_t i = 0; i < n; i++) {
    if (fixed && !(noise[i] > grown)) continue;
    const pendres_status status = load(ctx, 1, &p[i], &x[i], &v[i], periods, 2.0, &room[some]);
    if (status != PENDRES_OK) return status;
    some++;
  }
  const pendres_status status = pendres_strobe_run_within(ctx, pendres_accuracy_third(ctx), some,
                                                          room, after_all_periods, &periods);
  some = 0;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (!fixed || noise[i] > grown) apart[i] = fmax(apart[i], distance(&lanes[i], &room[some++]));
  return status;
}

/* error[n] of the first run lanes[n], whose starts x[n] and v[n] still hold. */
static pendres_status estimate(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                               const double *x, const double *v, long periods,
                               const pendres_strobe_lane *lanes, double *error)
{
  pendres_strobe_lane *finer = malloc(n * sizeof *finer);
  double *apart = malloc(n * sizeof *apart);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (finer == NULL || apart == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu pendulums", n);
    goto done;
  }
  status = run_finer(ctx, n, p, x, v, periods, finer, error);
  if (status != PENDRES_OK) goto done;
  for (size_t i = 0; i < n; i++) apart[i] = distance(&lanes[i], &finer[i]);
  status = ask_thirdly(ctx, n, p, x, v, periods, lanes, error, finer, apart);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    error[i] = error_of(apart[i], error[i], &lanes[i]);
done:
  free(finer);
  free(apart);
  return status;
}

static pendres_status strobe_advance(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, double *x, double *v,
                                     long periods, double *error)
{
  if (n > 0 && (pendulums == NULL || x == NULL || v == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x and v");
  pendres_status status = check(ctx, n, pendulums, x, v, periods);
  if (status != PENDRES_OK || n == 0) return status;
  if (periods == 0) {
    for (size_t i = 0; error != NULL && i < n; i++) error[i] = 0.0;
    return PENDRES_OK;
  }

  pendres_strobe_lane *lanes = malloc(n * sizeof *lanes);
  if (lanes == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  status = load(ctx, n, pendulums, x, v, periods, 1.0, lanes);
  if (status == PENDRES_OK)
    status = pendres_strobe_run(ctx, n, lanes, after_all_periods, &periods);
  if (status == PENDRES_OK) status = check_ends(ctx, n, lanes);
  if (status == PENDRES_OK && error != NULL)
    status = estimate(ctx, n, pendulums, x, v, periods, lanes, error);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&lanes[i], &x[i], &v[i]);
  free(lanes);
  return status;
}

pendres_status pendres_strobe_advance(pendres_context *ctx, size_t n,
                                      const pendres_pendulum *pendulums, double *x, double *v,
                                      long periods, double *error)
{
  return PENDRES_CONTEXT_CALL(ctx, strobe_advance(ctx, n, pendulums, x, v, periods, error));
}
