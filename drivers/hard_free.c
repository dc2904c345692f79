/* hard_free.c -- pendulums without drive and damping, of which everything is known exactly. */
#include "hard_cases.h"

#include <math.h>

/*
 * separatrix: the frequency at amplitudes pi - d against elliptic integrals.
 *
 * Near pi the quarter period is K = log(8 / d), and dK/dd = -1/d: an error e of the angle at the
 * start changes the frequency by e / (d K) of itself. Each step rounds the angle to u = 2.2e-16
 * (half a unit in the last place between 2 and 4) a few times; an error made at time t after the
 * start is as good as one of u exp(-t) at the start. Over all steps that is u / (1 - exp(-h)).
 */
pendres_status hard_separatrix(hard_sheet *sheet)
{
  const double pi = 3.14159265358979323846, tolerance = 1e-12;
  const char *quantity = "relative error of the frequency at pi less this amplitude";
  const pendres_options options = { .tolerance = tolerance };
  pendres_context *ctx = NULL, *naive = NULL;
  pendres_status status = hard_context(sheet, &options, &ctx);
  if (status == PENDRES_OK) status = hard_naive_context(sheet, tolerance, &naive);
  for (int k = 3; k <= 12 && status == PENDRES_OK; k++) {
    const double d = pow(10.0, -k), a = pi - d;
    double ours, error, theirs, theirs_error;
    status = pendres_free_frequency_integrate(ctx, 1, &a, &ours, &error);
    if (status != PENDRES_OK) {
      (void)hard_failed(sheet, status, ctx);
      break;
    }
    status = pendres_free_frequency_integrate(naive, 1, &a, &theirs, &theirs_error);
    if (status != PENDRES_OK) {
      (void)hard_failed(sheet, status, naive);
      break;
    }
    const double exact = pendres_free_frequency(a);
    status = hard_sheet_add_at(sheet, "separatrix", d, quantity, fabs(ours / exact - 1.0),
                               tolerance + 1e-15 / (d * log(8.0 / d)),
                               fabs(theirs / exact - 1.0));
  }
  pendres_context_free(naive);
  pendres_context_free(ctx);
  return status;
}
