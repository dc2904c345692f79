/**
 * @file cloud.h
 * @brief Clouds of strobe points around attractors under thermal noise, beside linear theory.
 *
 * Owns: the cloud around an attractor of a set, followed long enough after a start on the attractor
 * and with steps fine enough, its covariance beside that of linear noise theory, whether the two
 * agree, and the rate of escapes. pendres_cloud_find() does all of this; the functions after
 * it do its parts, so that a program may divide them among threads. The results are the same bytes
 * either way.
 *
 * A trajectory has escaped at the first strobe at which it has switched from the attractor, or left
 * well 0 (switching.h); what it does afterwards does not count.
 *
 * Where the temperature is zero, or the cloud so narrow that linear theory is exact to rounding
 * (variances of x up to 2e-16), nothing is followed: the cloud is made of the orbit's own points.
 *
 * Thread safety: that of the context (context.h); a set is only read.
 */
#ifndef PENDRES_CLOUD_H
#define PENDRES_CLOUD_H

#include <pendres/attractor.h>
#include <pendres/langevin.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** What to make a cloud of. */
typedef struct pendres_cloud_request {
  const pendres_attractors *set; /**< attractors of one parameter set; not owned */
  size_t attractor;              /**< the one on which all trajectories start, in well 0 */
  double temperature;            /**< T >= 0, in units of m g l */
  size_t trajectories;           /**< at least 2; a few hundred give reliable errors */
  long record;                   /**< strobes of each trajectory that count, at least 1 */
  int steps_per_period;          /**< steps per drive period, from 2 to 1000000; 0: the least number
                                      for which the bias of means and covariances is below 1 % of
                                      the widths */
} pendres_cloud_request;

/** How a cloud was made. */
typedef enum pendres_cloud_way {
  PENDRES_CLOUD_NONE = 0, /**< there is none: the attractor is chaotic or rotates */
  PENDRES_CLOUD_STILL,    /**< of the orbit's own points, without noise */
  PENDRES_CLOUD_NARROW,   /**< of the orbit's own points, with the covariance of linear theory */
  PENDRES_CLOUD_FOLLOWED, /**< by following trajectories */
  PENDRES_CLOUD_WAY_COUNT /**< how many there are */
} pendres_cloud_way;

/** Whether a cloud's covariance agrees with that of linear noise theory. */
typedef enum pendres_cloud_verdict {
  PENDRES_CLOUD_AGREES = 0,    /**< each element within 3 of its standard errors, bias included */
  PENDRES_CLOUD_TOO_HOT,       /**< one of them differs by more */
  PENDRES_CLOUD_NOT_COMPARED,  /**< there is no cloud, or the theory does not apply: an orbit of
                                    several periods has a cloud around several points */
  PENDRES_CLOUD_UNCERTAIN,     /**< an error above half the width, too large for a comparison */
  PENDRES_CLOUD_BELOW_ROUNDING, /**< so narrow that nothing is followed: the covariance is that
                                     of theory */
  PENDRES_CLOUD_VERDICTS       /**< how many there are */
} pendres_cloud_verdict;

/** A cloud around an attractor. Plain data; what does not exist is NaN. */
typedef struct pendres_cloud {
  pendres_cloud_way way;               /**< how it was made */
  pendres_langevin_cloud measured;     /**< statistics of its strobe points, and escapes */
  pendres_langevin_bias bias;          /**< of the measured statistics by finite steps; 0 steps
                                            where nothing was followed */
  pendres_langevin_covariance linear;  /**< the covariance by linear noise theory */
  double linear_error;                 /**< its error, as in pendres_langevin_linear */
  pendres_cloud_verdict verdict;       /**< whether the two agree */
  double escape_exposure;              /**< total time during which trajectories could escape, in
                                            units of 1/omega_0 */
  pendres_langevin_interval escape_rate; /**< escapes per unit time, with their 95 % interval */
} pendres_cloud;

/**
 * The cloud around an attractor. x and v, if not NULL, receive its trajectories x record strobe
 * points, those of one trajectory together; NaN after an escape.
 *
 * The seed is the context's. The ids of trajectories follow from the parameters and the attractor's
 * number, so that clouds at different temperatures are independent.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, and those of the integration.
 */
pendres_status pendres_cloud_find(pendres_context *ctx, const pendres_cloud_request *request,
                                  pendres_cloud *cloud, double *x, double *v);

/**
 * The first part of pendres_cloud_find: linear theory, the choice of steps, and their bias. A
 * cloud that is not to be followed is complete with that, x and v included.
 */
pendres_status pendres_cloud_prepare(pendres_context *ctx, const pendres_cloud_request *request,
                                     pendres_cloud *cloud, double *x, double *v);

/** How many parts the trajectories of a request are followed in; 0 without a request. */
size_t pendres_cloud_parts(const pendres_cloud_request *request);

/** The trajectories of a part, from 0 on: how many, and in *first the number of the first (both 0
 *  if there is no such part). first may be NULL. */
size_t pendres_cloud_part(const pendres_cloud_request *request, size_t part, size_t *first);

/**
 * Follow the trajectories of one part, by the request's steps: those of the bias that
 * pendres_cloud_prepare has found. x and v, if not NULL, receive the strobe points of this part
 * alone. A part that all have left before a strobe counted is not an error: its statistics are NaN.
 */
pendres_status pendres_cloud_follow(pendres_context *ctx, const pendres_cloud_request *request,
                                    size_t part, pendres_langevin_cloud *out, double *x,
                                    double *v);

/**
 * The last part of pendres_cloud_find: merge what the parts of a prepared cloud have measured,
 * in their order, compare with theory, and compute the rate of escapes.
 */
pendres_status pendres_cloud_conclude(const pendres_cloud_request *request, size_t parts,
                                      const pendres_langevin_cloud *part, pendres_cloud *cloud);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
