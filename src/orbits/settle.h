/*
 * settle.h -- settling many pendulums of many parameter sets at once.
 */
#ifndef PENDRES_SETTLE_H
#define PENDRES_SETTLE_H

#include "orbits/catalogue.h"

/*
 * Label n pendulums; set[i] is the catalogue of pendulum i, members of one set being consecutive.
 * With `explore` attractors are found on the way and added to the catalogues; without, the
 * catalogues are only read. outcome[i].attractor counts within its set.
 */
pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_catalogue *catalogues, int explore, size_t n,
                                    const size_t *set, const double *x, const double *v,
                                    pendres_outcome *outcome);

/* For how many periods pendulums are followed that may only settle on known attractors. */
typedef enum pendres_settle_budget {
  PENDRES_SETTLE_SHORT, /* enough for almost all; what takes longer stays unresolved */
  PENDRES_SETTLE_FULL
} pendres_settle_budget;

/* Label n pendulums of one parameter set, integrated with this error a period. The catalogue is
   only read. */
pendres_status pendres_settle_known(pendres_context *ctx, const pendres_catalogue *catalogue,
                                    size_t n, const double *x, const double *v, double accuracy,
                                    pendres_settle_budget budget, pendres_outcome *outcome);

#endif
