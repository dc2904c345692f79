/*
 * settle.h -- settling many pendulums of many parameter sets at once.
 */
#ifndef PENDRES_SETTLE_H
#define PENDRES_SETTLE_H

#include "catalogue.h"

/*
 * Label n pendulums; set[i] is the catalogue of pendulum i, members of one set being consecutive.
 * With `explore` attractors are found on the way and added to the catalogues; without, the
 * catalogues are only read. outcome[i].attractor counts within its set.
 */
pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_catalogue *catalogues, int explore, size_t n,
                                    const size_t *set, const double *x, const double *v,
                                    pendres_outcome *outcome);

#endif
