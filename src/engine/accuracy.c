/* accuracy.c -- tolerances of parts from the caller's; see accuracy.h. */
#include "engine/accuracy.h"

#include <math.h>

#include "engine/context_internal.h"

/* The least with which CVODE works. */
static const double least_step_error = 1e-15;
/* So small that a pendulum next to a fold or at rest upright does not miss where it should go. */
static const double largest_settling_error = 1e-5;
/* So small that what is averaged, or corrected afterwards, is near enough. */
static const double rough = 1e-7;

double pendres_accuracy_first(const pendres_context *ctx)
{
  return 10.0 * ctx->options.tolerance;
}

double pendres_accuracy_of_run(const pendres_context *ctx, double that_count)
{
  return ctx->options.tolerance / that_count;
}

double pendres_accuracy_to_settle(const pendres_context *ctx)
{
  return fmin(pendres_accuracy_first(ctx), largest_settling_error);
}

double pendres_accuracy_to_settle_soon(void)
{
  return largest_settling_error;
}

double pendres_accuracy_to_picture(const pendres_context *ctx, double spacing)
{
  const double finest = pendres_accuracy_first(ctx);
  if (ctx->options.tolerance < PENDRES_ACCURACY_DEFAULT || !isfinite(spacing)) return finest;
  return fmax(finest, fmin(1e-3 * spacing, largest_settling_error));
}

double pendres_accuracy_to_sample(void)
{
  return rough;
}

double pendres_accuracy_to_average(const pendres_context *ctx)
{
  return fmax(rough, ctx->options.tolerance);
}

double pendres_accuracy_to_follow(const pendres_context *ctx)
{
  return fmax(1e-4, ctx->options.tolerance);
}

double pendres_accuracy_in_chaos(const pendres_context *ctx)
{
  return ctx->options.exponent_error < 1.0 ? PENDRES_ACCURACY_DEFAULT : 1e-6;
}

double pendres_accuracy_of_means(const pendres_context *ctx)
{
  return fmax(1e-11, ctx->options.tolerance);
}

double pendres_accuracy_of_rough_means(const pendres_context *ctx)
{
  return fmax(fmin(largest_settling_error, 1e3 * ctx->options.tolerance), ctx->options.tolerance);
}

double pendres_accuracy_with_noise(const pendres_context *ctx)
{
  return fmax(1e-6, ctx->options.tolerance);
}

double pendres_accuracy_of_arcs(void)
{
  return rough;
}

double pendres_accuracy_second(const pendres_context *ctx)
{
  return fmax(least_step_error, 0.1 * ctx->options.tolerance);
}

double pendres_accuracy_third(const pendres_context *ctx)
{
  return fmax(least_step_error, fmin(1e-6, 0.01 * ctx->options.tolerance));
}

double pendres_accuracy_far_better(const pendres_context *ctx)
{
  return fmax(PENDRES_ACCURACY_TIGHTEST, 1e-2 * ctx->options.tolerance);
}

double pendres_accuracy_of_jump(const pendres_context *ctx)
{
  return 0.25 * ctx->options.tolerance;
}

double pendres_accuracy_negligible(const pendres_context *ctx)
{
  return 0.1 * ctx->options.tolerance;
}
