/*
 * charts.h -- the strobe map of weakly damped pendulums by charts, so that many periods cost as
 * little as one.
 *
 * Owns: the squares of the Poincaré plane on which the map over 1, 8, 64, ... periods is known by
 * polynomials (chart.h), what these miss, and when squares are worth having.
 *
 * A weakly damped pendulum winds round its attractor for thousands of periods before it settles,
 * and comes back next to where it has been many times. A square is charted when a pendulum first
 * comes to it: over one period by the integrator, over eight times as many by eight charts in a
 * row. Where polynomials of degree seven miss too much, a square is divided into four. Nothing of a
 * chart depends on who asked for it. What a chart misses is measured between its nodes. It is the
 * same each time, so that the errors of a time of settling may add up: the variance that a chart
 * adds allows for that.
 */
#ifndef PENDRES_CHARTS_H
#define PENDRES_CHARTS_H

#include "engine/strobe_run.h"

typedef struct pendres_charts pendres_charts;

enum { PENDRES_CHARTS_BOTTOMS = 4 };

/* Whether a pendulum is damped so weakly that charts repay what they cost, and is integrated by a
   method whose errors are carried. */
int pendres_charts_worth(const pendres_context *ctx, const pendres_pendulum *p);

/* The charts of a pendulum, which the context keeps for a while: valid until they are asked for
   again. Squares far from all of the n bottoms are larger. */
pendres_status pendres_charts_of(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                 const double *bottom, pendres_charts **out);

/* Charts come in levels, by how many periods they are over. */
int pendres_charts_levels(const pendres_charts *charts);
long pendres_charts_periods(int level);

/* Advance a lane, with the error that it carries, by the chart at its place of the highest level
   that there is, up to `highest`; *level: that one, -1: there is none. */
pendres_status pendres_charts_advance(pendres_context *ctx, pendres_charts *charts, int highest,
                                      pendres_strobe_lane *lane, int *level);

/* The charts of a context, of the pendulums that were asked for latest. */
typedef struct pendres_charts_memo pendres_charts_memo;
void pendres_charts_memo_free(pendres_charts_memo *memo);

#endif
