/*
 * strobe_record.c -- a trajectory at equally spaced drive phases; see strobe.h.
 *
 * Errors: discretisation from a second run with more steps; rounding from the covariance of the
 * state's rounding errors, carried along by the variational equation of the second run.
 */
#include <pendres/strobe.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/passage.h"
#include "engine/steps.h"
#include "orbits/strobe_noise.h"
#include "engine/strobe_run.h"

enum { MOST_SAMPLES = 1000000 };

/* Where the points of a period go; in the second run also their standard errors of rounding. */
typedef struct recorder {
  double *x, *v;             /* the period's first point */
  double *x_noise, *v_noise; /* NULL in the first run */
  double noise[3];           /* C_yy, C_yw, C_ww at the period's start */
  int stretch;               /* steps between two points */
  const pendres_pendulum *p;
  long turns;                /* of the period's start */
  double rounding;           /* of a step */
} recorder;

static void keep(void *arg, int step, const pendres_rows *rows)
{
  const recorder *r = arg;
  const int k = step / r->stretch;
  if (step % r->stretch != 0) return;
  const pendres_place s = {.y = pendres_rows_get(rows, PENDRES_ROW_Y, 0),
                           .w = pendres_rows_get(rows, PENDRES_ROW_W, 0),
                           .turns = r->turns};
  pendres_passage_out(r->p, &s, &r->x[k], &r->v[k]);
  if (r->x_noise != NULL) {
    double noise[3];
    pendres_strobe_noise_carry(r->noise, r->rounding, step, rows, 0, noise);
    r->x_noise[k] = sqrt(noise[0]);
    r->v_noise[k] = r->p->drive_frequency * sqrt(noise[2]);
  }
}

/* What a run is of. */
typedef struct record {
  const pendres_pendulum *p;
  double x0, v0;
  long periods;
  int samples;
} record;

/* The whole trajectory with `stretch` steps from one point to the next. */
static pendres_status run(pendres_context *ctx, const record *what, int stretch, double *x,
                          double *v, double *x_noise, double *v_noise)
{
  pendres_block b;
  pendres_place s = pendres_passage_in(what->p, what->x0, what->v0);
  recorder r = { .stretch = stretch, .p = what->p,
                 .rounding = pendres_strobe_noise_of_step(ctx->options.table) };
  pendres_status status = pendres_block_open(
    ctx, x_noise != NULL ? PENDRES_FLOW_VARIATIONAL : PENDRES_FLOW_STATE, what->samples * stretch,
    &b);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(&b, 1);
  x[0] = what->x0;
  v[0] = what->v0;
  if (x_noise != NULL) x_noise[0] = v_noise[0] = 0.0;
  for (long k = 0; k < what->periods && status == PENDRES_OK; k++) {
    const size_t first = (size_t)k * (size_t)what->samples;
    r.x = x + first;
    r.v = v + first;
    r.x_noise = x_noise != NULL ? x_noise + first : NULL;
    r.v_noise = v_noise != NULL ? v_noise + first : NULL;
    r.turns = s.turns;
    pendres_block_load(&b, 0, what->p, s.y, s.w);
    status = pendres_block_period_sampled(&b, keep, &r);
    const pendres_rows rows = pendres_block_rows(&b);
    double noise[3] = { 0.0 };
    if (x_noise != NULL)
      pendres_strobe_noise_carry(r.noise, r.rounding, what->samples * stretch, &rows, 0, noise);
    for (int i = 0; i < 3; i++) r.noise[i] = noise[i];
    s.y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
    s.w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
    pendres_passage_arrive(what->p, &s.y, &s.w, &s.turns);
    if (status == PENDRES_OK && !(isfinite(s.y) && isfinite(s.w)))
      return pendres_strobe_lost(ctx, what->p, k + 1);
  }
  return status;
}

static pendres_status check(pendres_context *ctx, const record *what)
{
  const char *why = NULL;
  if (pendres_pendulum_check(what->p, &why) == PENDRES_OK) {
    if (what->periods < 0) why = "the number of periods must not be negative";
    else if (what->samples < 1 || what->samples > MOST_SAMPLES)
      why = "1 to 1000000 samples a period, please";
    else if (what->periods >= LONG_MAX / 64 / what->samples)
      why = "there are too many samples in all";
    else why = pendres_passage_refuses(what->p, what->x0, what->v0);
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
}

/*
 * The second run, and the errors: what the distance to it says, and twice the standard error of
 * rounding. The errors of a point's x and v belong together: where one is lost, so is the other,
 * and once lost a trajectory may be any other's; that the two runs meet again says nothing then.
 */
static pendres_status estimate(pendres_context *ctx, const record *what, int stretch,
                               const double *x, const double *v, double *x_error, double *v_error)
{
  const size_t n = (size_t)what->periods * (size_t)what->samples + 1;
  double *finer = malloc(2 * n * sizeof *finer);
  if (finer == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  const pendres_status status =
    run(ctx, what, (14 * stretch + 9) / 10, finer, finer + n, x_error, v_error);
  double lost = 0.0;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const double dx = fabs(x[k] - finer[k]), dv = fabs(v[k] - finer[n + k]);
    /* Not smaller where one of them happens to change its sign. */
    const double doubt = pendres_strobe_doubt(fmax(dx, dv));
    if (!(doubt + x_error[k] + v_error[k] < INFINITY)) lost = INFINITY;
    x_error[k] = lost + doubt + 2.0 * x_error[k] + 2.2e-16 * fabs(x[k]);
    v_error[k] = lost + doubt + 2.0 * v_error[k] + 2.2e-16 * fabs(v[k]);
  }
  free(finer);
  return status;
}

static pendres_status whole_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                           double x0, double v0, long periods, int samples,
                                           double *x, double *v, double *x_error, double *v_error)
{
  const record what = { .p = pendulum, .x0 = x0, .v0 = v0, .periods = periods, .samples = samples };
  int steps = 0;
  if (pendulum == NULL || x == NULL || v == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, x and v");
  if ((x_error == NULL) != (v_error == NULL))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "errors are of both x and v, or of neither");
  pendres_status status = check(ctx, &what);
  if (status == PENDRES_OK)
    /* Errors of all periods may add up. */
    status = pendres_steps_choose(ctx, pendulum, pendres_steps_speed(pendulum, x0, v0),
                                  ctx->options.tolerance / fmax(1.0, (double)periods), &steps);
  if (status != PENDRES_OK) return status;
  const int stretch = (steps + samples - 1) / samples;
  status = run(ctx, &what, stretch, x, v, NULL, NULL);
  if (status == PENDRES_OK && x_error != NULL)
    status = estimate(ctx, &what, stretch, x, v, x_error, v_error);
  return status;
}

pendres_status pendres_strobe_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                     double x0, double v0, long periods, int samples, double *x,
                                     double *v, double *x_error, double *v_error)
{
  return PENDRES_CONTEXT_CALL(ctx, whole_record(ctx, pendulum, x0, v0, periods, samples, x,
                                                        v, x_error, v_error));
}
