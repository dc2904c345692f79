/*
 * chaos_walkers.h -- walkers: pendulums that carry tangent vectors along.
 *
 * Owns: one drive period of such walkers, and sums over batches of periods.
 */
#ifndef PENDRES_CHAOS_WALKERS_H
#define PENDRES_CHAOS_WALKERS_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

struct pendres_catalogue;

/* What is summed over drive periods. */
typedef enum pendres_walker_measure {
  PENDRES_WALKER_GROWTH,    /* of the logarithm of the tangent vector's length */
  PENDRES_WALKER_COARSE,    /* what it has been corrected by: more than the error that is left */
  PENDRES_WALKER_WORK,      /* done by the drive: the loop area */
  PENDRES_WALKER_OTHER,     /* work done by the torque and the parametric drive */
  PENDRES_WALKER_LOSS,      /* of energy by friction */
  PENDRES_WALKER_AMPLITUDE, /* half peak to peak of the angle in a period, from phase 0 and pi on */
  PENDRES_WALKER_TURNS,     /* advance of the angle over 2 pi */
  PENDRES_WALKER_SPEED,     /* w at the period's end: mirror images differ in it */
  PENDRES_WALKER_MEASURES
} pendres_walker_measure;

typedef struct pendres_walker {
  double y, w;       /* the angle within half a turn of zero */
  double u[2][2];    /* tangent vectors of length one, by steps and by steps twice as long */
  long turns;        /* whole turns taken out of y */
  long periods;      /* so far */
  long trapped;      /* after so many periods it was first inside a trap, or escaped; 0: never */
  double sum[PENDRES_WALKER_MEASURES];
  double low[2], high[2]; /* angles in the latest two halves of periods, the later one last */
  double last_y, last_w;  /* the latest sample of the period under way */
} pendres_walker;

/* The latest strobe points of walkers, angles with whole turns: a ring buffer for each of them. */
typedef struct pendres_walker_trace {
  long length; /* of a ring buffer */
  long filled; /* points recorded of each walker */
  double *y, *w; /* [walker][length] */
} pendres_walker_trace;

pendres_walker pendres_walker_at(double y, double w);

/*
 * Go on for some periods. With a trace all sums are taken, and every strobe point is kept; without
 * one (NULL) those of growth, turns and speed alone are.
 */
pendres_status pendres_walkers_advance(pendres_context *ctx, const struct pendres_catalogue *c,
                                       size_t n, pendres_walker *a, long periods,
                                       pendres_walker_trace *trace);

#endif
