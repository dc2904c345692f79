/*
 * settle_lanes.h -- the parts of settling: running pendulums until they are inside a trapping
 * ellipse, looking for what attracts the others, and making labels certain.
 *
 * Owns: the decision about a lane after each period, the budgets of periods, and the latest strobe
 * points of lanes that do not settle.
 */
#ifndef PENDRES_SETTLE_LANES_H
#define PENDRES_SETTLE_LANES_H

#include "settling/attractor_set.h"
#include "settling/exponents/carried.h"
#include "settling/exponents/unstable.h"
#include "settling/recurrence.h"

/* Strobe points kept of a pendulum that does not settle. */
enum { PENDRES_SETTLE_HISTORY = PENDRES_RECURRENCE_POINTS };

/* The latest strobe points of a lane, a ring buffer. */
typedef struct pendres_settle_history {
  long filled; /* points ever recorded */
  double y[PENDRES_SETTLE_HISTORY], w[PENDRES_SETTLE_HISTORY]; /* unwrapped angle */
} pendres_settle_history;

/* What is asked of pendulums beside what there is to settle on. */
typedef enum pendres_settle_wanted {
  PENDRES_SETTLE_TIMES,  /* labels, and the time in which each settles */
  PENDRES_SETTLE_LABELS, /* times may be off by some periods */
  PENDRES_SETTLE_NOTHING /* labels may be uncertain, and times too long */
} pendres_settle_wanted;

/* Pendulums to be labelled, by the states that they start from. */
typedef struct pendres_settle_starts {
  size_t n;
  const size_t *set; /* number of each one's parameter set, those of one set being consecutive; not
                        read by pendres_settle_known() */
  const double *x, *v;
  pendres_settle_wanted wanted; /* not read by pendres_settle_known() */
} pendres_settle_starts;

/* Arrays are by the numbers of lanes. */
typedef struct pendres_settle_labelling {
  const pendres_attractor_set *attractor_sets;
  size_t *order;            /* numbers of the lanes in the order in which they run; NULL: as they
                               are numbered */
  const size_t *set;        /* of each lane; NULL: all belong to the first set of attractors */
  long *budget;             /* of each set, periods in all */
  pendres_settled *outcome;
  pendres_settle_history *histories; /* NULL: not kept */
  double *error_ratio;      /* of each lane that settles: the ratio of the error that it carries to
                               the largest one that cannot change its label, which is certain up to
                               1. Infinite where the run ended with the lane lost. NULL: not
                               kept */
  int drop_lost;            /* whether a lane ends, without an outcome, where it is lost: its error
                               is so large that no label of this run can be certain */
  /* Of the run itself: */
  double most_steps;        /* of a lane */
  int *streak;              /* how long a lane has been in the cells of a chaotic attractor */
  double *entry;            /* largest variance of its error before that */
  struct pendres_settle_place *before; /* a period ago, of lanes that may escape or come to rotate
                                          without a drive; NULL: none may */
} pendres_settle_labelling;

/* Periods after which attractors are searched for near a pendulum that is in no ellipse. */
long pendres_settle_first_budget(const pendres_pendulum *p);

/* Periods after which it is given up. */
long pendres_settle_last_budget(const pendres_context *ctx, const pendres_attractor_set *c);

/* How fast pendulums become on their way to the attractors, as pendres_steps_speed() says of a
   start: a parametric drive may make them much faster than they start. 0 where there is none, or
   pendulums turn over. */
double pendres_settle_driven(const pendres_attractor_set *c);

/* Put a pendulum at its start, and choose its steps for this error per period, which is propagated
   where that is possible. */
pendres_status pendres_settle_load(pendres_context *ctx, const pendres_attractor_set *c, double x,
                                   double v, double accuracy, pendres_strobe_lane *lane);

/* The same for a pendulum with the parameters and the velocity of a neighbour whose steps are
   known. */
pendres_strobe_lane pendres_settle_load_like(const pendres_strobe_lane *neighbour, double x,
                                             double v);

/* Run the lanes that are unresolved; those inside an ellipse are done before they begin. */
pendres_status pendres_settle_lanes(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                    pendres_settle_labelling *l);

/* ---- settle_certain.c: labels that no error of the integration can change -------------------- */

/*
 * Make labels certain that are not: of pendulums whose propagated error is not small against what
 * separates one outcome from another. They are integrated again from their starts, more and more
 * exactly, down to rounding. Of the runs in which the error stayed below what separates outcomes,
 * the most exact one decides about the label. Pendulums that are still uncertain after the most
 * exact run, and those that reach no trapping ellipse in a further run, keep their latest label,
 * which is not certain. A further run of a pendulum ends where its error has grown so large that no
 * label can be certain.
 *
 * Where errors are not propagated, as with adaptive steps, labels are not changed but compared with
 * those of fixed steps: those that agree with a certain one are certain.
 *
 * job: what labelled them at first, with error_ratio; that and outcomes may change. accuracy: the
 * error a period that they were run with.
 */
pendres_status pendres_settle_certain(pendres_context *ctx, const pendres_settle_labelling *job,
                                      const pendres_settle_starts *from, double accuracy);

/* ---- settle_search.c: what attracts pendulums that are in no known ellipse ------------------- */

/*
 * Each round is twice as long as the one before: pendulums are integrated further, orbits that they
 * have come close to are refined, in every other round chaos is searched for, and pendulums are
 * labelled again. Those that have not settled when the last budget is spent stay unresolved.
 *
 * job: what has run the lanes up to their budgets, which are all spent, and raised; the sets, from
 * the first one of which on its numbers count, may grow.
 */
pendres_status pendres_settle_search(pendres_context *ctx, size_t sets,
                                     pendres_attractor_set *attractor_sets,
                                     const pendres_settle_starts *from,
                                     const pendres_settle_labelling *job,
                                     const pendres_strobe_lane *lanes);

#endif
