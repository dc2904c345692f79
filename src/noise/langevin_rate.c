/* langevin_rate.c -- rates of rare events with their exact intervals; see langevin.h. */
#include <pendres/langevin.h>

#include <math.h>

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "base/student.h"
#include "noise/noise_common.h"
#include "noise/numbers.h"

/*
 * A point of the gamma distribution of unit scale: beyond it, or up to it, lies a share `tail`.
 * GSL's own inverses fail for shapes below a tenth, give wrong values above a thousand (GSL 2.7),
 * and end the program when they notice.
 */
typedef struct gamma_tail {
  double shape, tail;
  int upper;
} gamma_tail;

static double beyond(double log_x, void *arg)
{
  const gamma_tail *g = arg;
  const double x = exp(log_x);
  return g->upper ? g->tail - gsl_cdf_gamma_Q(x, g->shape, 1.0)
                  : gsl_cdf_gamma_P(x, g->shape, 1.0) - g->tail;
}

/* By Wilson and Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684; langevin.h tells its error. */
static double gamma_point_of_many(const gamma_tail *g)
{
  const double z = gsl_cdf_ugaussian_Pinv(g->tail) * (g->upper ? -1.0 : 1.0);
  const double root = 1.0 - 1.0 / (9.0 * g->shape) + z / (3.0 * sqrt(g->shape));
  return g->shape * root * root * root;
}

static pendres_status gamma_point(gamma_tail g, double *x)
{
  const double tiniest = -740.0, largest = log(g.shape + 40.0 * sqrt(g.shape) + 800.0);
  *x = 0.0;
  if (g.shape >= noise_many_events) {
    *x = gamma_point_of_many(&g);
    return PENDRES_OK;
  }
  if (!(beyond(tiniest, &g) < 0.0)) return PENDRES_OK; /* the point is below all doubles */
  if (!(beyond(largest, &g) > 0.0)) return PENDRES_INVALID_ARGUMENT; /* a tail of 1e-300 */
  gsl_function f = {.function = beyond, .params = &g};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (solver == NULL) return PENDRES_OUT_OF_MEMORY;
  int gsl = gsl_root_fsolver_set(solver, &f, tiniest, largest);
  for (int i = 0; i < ITERATIONS && gsl == GSL_SUCCESS; i++) {
    gsl = gsl_root_fsolver_iterate(solver);
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver), gsl_root_fsolver_x_upper(solver),
                               1e-14, 0.0) == GSL_SUCCESS)
      break;
  }
  *x = exp(gsl_root_fsolver_root(solver));
  gsl_root_fsolver_free(solver);
  return gsl == GSL_SUCCESS ? PENDRES_OK : PENDRES_NOT_CONVERGED;
}

/* The confidence interval of the given level around a number of events in unit exposure. */
static pendres_status interval(double events, double level, double *lower, double *upper)
{
  const double tail = 0.5 * (1.0 - level);
  pendres_status status = PENDRES_OK;
  *lower = 0.0;
  if (events > 0.0) status = gamma_point((gamma_tail){events, tail, 0}, lower);
  if (status == PENDRES_OK) status = gamma_point((gamma_tail){events + 1.0, tail, 1}, upper);
  return status;
}

pendres_status pendres_langevin_rate(double events, double exposure, double level,
                                     pendres_langevin_interval *rate)
{
  double low, high, lowest, one_sigma = 0.0;
  if (rate == NULL) return PENDRES_INVALID_ARGUMENT;
  *rate = (pendres_langevin_interval){NAN, NAN, NAN, NAN};
  if (!(events >= 0.0 && isfinite(events) && exposure > 0.0 && isfinite(exposure) &&
        level > 0.0 && level < 1.0))
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = interval(events, level, &low, &high);
  /* Without any event, a rate of 0 +- 0 would be wrong. */
  if (status == PENDRES_OK && events == 0.0)
    status = interval(0.0, PENDRES_ONE_SIGMA, &lowest, &one_sigma);
  if (status != PENDRES_OK) return status;
  *rate = (pendres_langevin_interval){
    .value = events / exposure, .lower = low / exposure, .upper = high / exposure,
    .error = (events > 0.0 ? sqrt(events) : one_sigma) / exposure};
  return PENDRES_OK;
}
