/*
 * peer_gsl.h -- GSL's Dormand-Prince 8(9), one problem a pendulum: somebody else's code to be
 * measured against.
 */
#ifndef PEER_GSL_H
#define PEER_GSL_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/pendulum.h>

/*
 * Advance a pendulum by `periods` drive periods, x and v in place, with the relative and absolute
 * tolerance of each step. What that took is added to *cost.
 * PENDRES_OUT_OF_MEMORY, PENDRES_INTEGRATION_FAILED.
 */
pendres_status peer_gsl_advance(const pendres_pendulum *p, double *x, double *v, long periods,
                                double tolerance, pendres_cost *cost);

#endif
