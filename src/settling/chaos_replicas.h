/*
 * chaos_replicas.h -- replicas: pendulums with tangent vectors that start close together.
 *
 * Owns: one drive period of such replicas, and sums over batches of periods.
 */
#ifndef PENDRES_CHAOS_REPLICAS_H
#define PENDRES_CHAOS_REPLICAS_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

struct pendres_attractor_set;

/* What is summed over drive periods. */
typedef enum pendres_replica_measure {
  PENDRES_REPLICA_GROWTH,    /* of the logarithm of the tangent vector's length */
  PENDRES_REPLICA_COARSE,    /* its correction, which is larger than the error that is left */
  PENDRES_REPLICA_WORK,      /* done by the drive: the loop area */
  PENDRES_REPLICA_OTHER,     /* work done by the torque and the parametric drive */
  PENDRES_REPLICA_LOSS,      /* of energy by friction */
  PENDRES_REPLICA_AMPLITUDE, /* half peak to peak of the angle, periods from phase 0 and pi on */
  PENDRES_REPLICA_TURNS,     /* advance of the angle over 2 pi */
  PENDRES_REPLICA_SPEED,     /* w at the period's end: mirror images differ in it */
  PENDRES_REPLICA_MEASURES
} pendres_replica_measure;

typedef struct pendres_replica {
  double y, w;       /* the angle within half a turn of zero */
  double u[2][2];    /* tangent vectors of length one, with steps and with steps twice as long */
  long turns;        /* whole turns taken out of y */
  long periods;      /* so far */
  long trapped;      /* the period after which it was first inside a trapping ellipse, or escaped;
                        0: never */
  double sum[PENDRES_REPLICA_MEASURES];
  double low[2], high[2]; /* angles in the latest two halves of periods, the later one last */
} pendres_replica;

/* The latest strobe points of replicas, angles with whole turns: a ring buffer for each of them. */
typedef struct pendres_replica_trace {
  long length; /* of a ring buffer */
  long filled; /* points recorded of each replica */
  double *y, *w; /* [replica][length] */
} pendres_replica_trace;

pendres_replica pendres_replica_at(double y, double w);

/*
 * Advance by some periods. With a trace all sums are taken, and every strobe point is kept; without
 * one (NULL) only those of growth, turns and speed.
 */
pendres_status pendres_replicas_advance(pendres_context *ctx, const struct pendres_attractor_set *c,
                                        size_t n, pendres_replica *a, long periods,
                                        pendres_replica_trace *trace);

#endif
