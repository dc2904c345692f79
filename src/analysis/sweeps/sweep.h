/*
 * sweep.h -- values of a range by number, for axes and tests.
 */
#ifndef PENDRES_ANALYSIS_SWEEP_H
#define PENDRES_ANALYSIS_SWEEP_H

#include <pendres/sweep.h>

/* Value number i < count; NaN beyond, or without a range. */
double pendres_range_value(const pendres_range *range, size_t i);

#endif
