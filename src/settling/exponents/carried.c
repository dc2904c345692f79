/* carried.c -- the error of the integration that a lane carries; see carried.h. */
#include "settling/exponents/carried.h"

#include <math.h>

#include "engine/context_internal.h"
#include "orbits/strobe_noise.h"
#include "settling/exponents/numbers.h"

int pendres_settle_carries(const pendres_context *ctx)
{
  return pendres_method_of(ctx)->fixed_steps && ctx->options.steps_per_period == 0;
}

double pendres_settle_added(const pendres_context *ctx, double accuracy, int steps)
{
  const double rounding = pendres_strobe_noise_of_step(ctx->options.table);
  if (!pendres_settle_carries(ctx)) return 0.0;
  return accuracy * accuracy / steps + rounding * rounding;
}

double pendres_settle_error_ratio(double worst)
{
  return surely * sqrt(worst) / settle_borne;
}

double pendres_settle_tighter(double accuracy, double error_ratio)
{
  if (isinf(error_ratio)) return settle_most_exact;
  const double wanted = accuracy / fmax(settle_at_least, settle_to_spare * error_ratio);
  if (!(wanted > settle_most_exact)) return settle_most_exact;
  return fmax(settle_most_exact, pow(10.0, floor(log10(wanted))));
}
