/*
 * numbers.h -- numbers that were chosen for what single pendulums do, each with its reason.
 */
#ifndef PENDRES_EXPONENTS_NUMBERS_H
#define PENDRES_EXPONENTS_NUMBERS_H

#include "orbits/numbers.h"

/* ---- lengths of time, in drive periods ---- */

enum {
  /* In which replicas part, and that lanes of slow drives get in any case. */
  WARM_UP = 200,
  /* Into which periods of an average are divided: an even number. */
  BATCHES = 16
};

/* A first budget has this bound, and a last one as many times that as it is longer: only dampings
   below 1e-6 meet it. */
static const double settle_first_most = 1e7;

/* What takes longer is not waited for: the slowest orbit, or rest that is hardly unstable. */
static const double settle_slowest = 1e4;

/* ---- whether an error decides ---- */

/*
 * The ratio of the error to the largest one that cannot change the label decides whether that is
 * certain. Inside an ellipse trapping_margin of the radius is allowed. On the way there the error
 * must stay small against the distance to a basin boundary: both grow at the same rate, until the
 * distance is that between different outcomes, of order one; a thirtieth of that is allowed.
 */
static const double settle_borne = 0.03;

/* An error this many times as large as one that may decide is several times the distance between
   different outcomes: motions have parted for good, and what the pendulum does is not known. */
static const double settle_lost = 100.0;

/* The error a period of the most exact run: rounding in some hundred steps is as large. */
static const double settle_most_exact = 1e-14;

/* A further run is by this factor more exact than would just suffice, and by at least this factor
   more exact than the run before. */
static const double settle_to_spare = 4.0, settle_at_least = 30.0;

/* ---- chaos: whether distances grow ---- */

/* Student's t of 14 degrees of freedom is beyond this once in 13,000 times: of thirteen places in
   which batches can be parted, once in a thousand at most. */
static const double growth_by_chance = 5.5;

/*
 * The logarithm grows by this in chaos, and shrinks by it on orbits. Order may stretch a vector for
 * a while: a rotation next to where a lock has ended is slow in one place, and stretches it as much
 * there as it will shrink it again; motions stay near an upright state, or the ghost of an orbit.
 * What rounding, 1e-13, can be parted by until it is seen is e^30.
 */
static const double growth_passing = 30.0;

/* ---- exponents: how long pendulums are followed ---- */

enum {
  EXPONENT_PERIODS = 512, /* of a first average, unless the caller says so: half of them for what
                             is known to be close to a rotation, and three times as many by which
                             what may be chaos is followed before */
  EXPONENT_ROUNDS = 6,    /* of averages, each twice as long as the one before: next to the end of a
                             lock a rotation slips once in thousands of periods */
  EXPONENT_TURNING = 16   /* periods in which tangent vectors turn into the growing direction */
};

/* Steps of a pendulum that a transient or an average is worth, unless the caller asks for more:
   half a minute's where it is alone. */
static const double exponent_most_steps = 5e7;

/* Times in which a deviation falls to 1/e that pendulums are followed for before an average, next
   to an orbit or a rotation and elsewhere. */
static const double exponent_forgets = 25.0, exponent_forgets_all = 80.0;

/* Chaos that stretches by less than this in a drive period, or in one of small oscillations if that
   is shorter, is in bands, or next to a window: the errors of a first look may make it of an orbit.
   One hump of a map stretches by up to ln 2, in two bands by half of that. */
static const double exponent_weak = 0.35;

/* ---- exponents: what is next to an orbit ---- */

enum {
  LOOK_SOON = 8, /* periods for which strobe points are compared with an earlier one, and ... */
  LOOK_AGAIN = 4 /* ... a quarter of all so far if that is more: no longer is waited in vain */
};

/* A pendulum whose strobe point comes back this closely is taken to be next to an orbit, at first.
   Each time that an orbit has turned out not to attract it, as the unstable one beside a fold does
   not, it must come closer, by the second factor. */
static const double caught_close_by = 1e-4, caught_closer = 0.1;

/* Copies of a pendulum that are caught this close to each other are next to the same orbit. */
static const double caught_same_place = 1e-3;

/* ---- exponents: copies, which tell whether a verdict depends on rounding ---- */

enum {
  COPIES_FEW = 4, /* that are tried first: most of those that differ are seen by them */
  COPIES = 16     /* what one copy in five does is missed by all of them once in thirty times */
};

/* Verdicts of copies agree within this many times their errors. */
static const double copies_agree = 5.0;

/* A chaos that comes back this close to the last state that the pendulum was in for certain is the
   one that its start leads to. The errors there are a hundredth at most. */
static const double copies_returned = 0.1;

/* ---- means of rotations ---- */

enum {
  MEANS_SLIPS = 3,        /* of a rotation by where a lock has ended, for its mean to be known */
  MEANS_SHOW = 1024,      /* periods after which chaos shows in means */
  MEANS_SHORT_ORBIT = 16  /* drive periods of one beside which a rotation may be slow */
};

/* A rotation that slips once in n periods is known to a few slips in n periods. In less than half a
   slip nothing is seen of how it becomes slower and faster. */
static const double means_few_slips = 5.0, means_half_slip = 0.5;

/* Mean turns a period are known to this at least, and the mean square of the velocity to ten times
   this share of it: in chaos that would take 1e10 periods. */
static const double means_least = 1e-6;

/* The last digits of a mean are lost to rounding. */
static const double means_rounding = 2.2e-14;

#endif
