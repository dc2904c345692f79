/*
 * point.h -- the point that a task works on: what it is called, and its budget of time.
 *
 * Owns: the clock of a point, and when it is costly: beside the mean of the points that the stage
 * has finished. A point is what a user knows: the parameters of one result. Time is that of the
 * processor, of the thread that computes, so that a machine which others use too does not end
 * points. All the same the same budget may end a point on one machine and not on another: what is
 * computed with a budget is reproduced only where none was ended.
 */
#ifndef POINT_H
#define POINT_H

#include "farm/pool_internal.h"

/* Is the point under way to be given up? Asked now and then by the thread that computes it, `now`
   being its milliseconds; tells the user of a costly point, once. */
int point_over(farm_watch *w, long long now);

/* Nothing is under way any more; what was is part of the mean from now on. */
void point_end(farm_watch *w);

#endif
