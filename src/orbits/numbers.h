/*
 * numbers.h -- numbers that were chosen for orbits, what settles on them, and chaos, each with its
 * reason. Lengths are in canonical units, in which those of a motion are of order one.
 */
#ifndef PENDRES_ORBITS_NUMBERS_H
#define PENDRES_ORBITS_NUMBERS_H

#include "base/numbers.h"

/* ---- when two are the same ---- */

/* Poincaré points of one orbit agree to this and pendres_several_errors, and so do the harmonics of
   mirror images (orbit_same.h). So may the points of an orbit that has just doubled its period, but
   there the shorter one is not stable; stable orbits that differ are that close at most next to a
   bifurcation. */
static const double orbit_same_point = 1e-6;

/* Newton's method has come to one orbit from two guesses where it stops as close as this: within
   what its last steps leave, and far within what tells orbits apart. */
static const double orbit_repeated = 1e-8;

/* Harmonics below this are none. */
static const double orbit_no_harmonic = 1e-7;

/* The amplitudes of a state at adjacent parameters differ by less than this, and an orbit further
   from where it was looked for is another one. */
static const double orbit_another = 0.02;

/* Guesses closer than this lead to the same orbit, so one of them is enough. */
static const double guess_same = 0.05;

/* ---- where orbits are looked for ---- */

enum {
  /* Positions across the turn of a pendulum, or across a well, each at rest and moving either
     way. */
  GUESS_ACROSS = 12,
  /* The range in which wells are searched for, in units of length of a force, and its
     resolution. */
  GUESS_FAR = 8,
  GUESS_FINENESS = 64,
  /* Pendulums of a parameter set that are integrated before the others, to find what attracts. */
  GUESS_PENDULUMS = 12,
  /* Starts from which one is looked for that goes to a chaotic attractor. */
  GUESS_CHAOS = 256
};

/* The speeds of guesses: in a well, of that which leads over its lower barrier, and for a
   pendulum. */
static const double guess_speed = 0.7, guess_pendulum_speed = 1.3;

/* An initial guess that moves by less than this from strobe to strobe is near enough for Newton's
   method. Others are followed until transients have faded to a hundredth, but no longer. */
static const double guess_at_rest = 0.03, guess_longest = 60.0;

/* Points that come back closer than these may be near an orbit of a short or a long period, if
   their distance is less than a tenth of that after any short period. */
static const double recurrence_near = 0.3, recurrence_near_long = 0.02, recurrence_closer = 0.1;

/* A period is preferred to its multiples if points are this many times as far apart after it. */
static const double recurrence_as_close = 3.0;

enum { RECURRENCE_SHORT = 32 /* periods: with more, chance returns are likely */ };

/* ---- Newton's method ---- */

/* Far beyond what is found. */
enum { ORBIT_LONGEST_PERIOD = 1000000, ORBIT_MOST_TURNS = 1000000000 };

/* A step longer than this is cut to this length, so that it does not leave the guess's well. A
   linear force has one orbit alone, which the first step leads to however far it is. */
static const double newton_longest_step = 0.6;

/* Close to a fold rounding keeps steps from shrinking any further: after so many steps, one below
   this that is not half of the one before is the last. */
static const double newton_stalled = 1e-5;
enum { NEWTON_STALLED = 8 };

/* The neighbours of a candidate, from which second derivatives are found, start at this distance in
   y and in w. */
static const double newton_aside = 1e-6;

/* Candidates are divided among threads where they take more steps than this, some milliseconds: to
   start a thread takes a tenth of one. */
static const double newton_worth_threads = 1e5;

/* det (I - M) at an orbit is the same after one more step, and with more steps, up to this factor;
   at the ghost of an orbit it falls to less than half, or past zero. */
static const double newton_there = 1.4;

/* ---- errors of orbits ---- */

/* Rounding of a step that carries errors, of that of arbitrary trajectories (strobe_noise.h), and
   that of derivatives of the map in the former, as measured. It is larger since sums have more
   terms and twice as many roundings. */
static const double newton_rounding = 0.27, newton_matrix = 9.0;

/* The sum of the moduli of a table's weights at which rounding of a step was measured. */
static const double step_usual_weights = 7.2;

/* Where a linear step leaves terms of second order: these, and half as much again, since terms of
   third order follow. */
static const double orbit_left_over = 1.5;

/* What an eighth of the difference of the whole orbits could make is claimed with a value's own
   difference; and of the matrix a fifth of the length over which it changes. */
static const double orbit_whole_share = 0.12, orbit_beside_share = 0.2;

/* Along an unstable orbit the derivative by the frequency from a fixed start and that by the start
   grow, and cancel. Their rounding counts where less than this share of them is left. */
static const double orbit_cancels = 0.1;

/* At rest each step rounds the same pattern: it may be the worst one, four times the mean. */
static const double orbit_worst_rounding = 4.0;

/* A mean so near to the top is at the top, and belongs to the well on one side of it. */
static const double orbit_tie = 0.01;

/* Strobes at which runs of long trajectories are compared, at most, at a time. */
enum { STROBE_MOST_COMPARED = 64 };

/* ---- names ---- */

/* Up to this drive an orbit that is alone has a name by its phase lag: the drives of the paper, 0.1
   and 0.2, and somewhat beyond. */
static const double label_strongest_by_lag = 0.25;

/* ---- trapping ellipses, by rings ---- */

enum {
  TRAPPING_BASE_POINTS = 12, /* of a base ring, which shows whether the map is nearly linear */
  TRAPPING_BASE_LOOKS = 8,   /* iterates that the map may take to contract a base ring */
  TRAPPING_BASE_PASSES = 8,  /* base rings that are tried */
  TRAPPING_FEW_POINTS = 16,  /* of other rings, by effort: as many may be put into their arcs, */
  TRAPPING_MANY_POINTS = 48, /* or twice as many */
  TRAPPING_RINGS = 3         /* that are tried at the same time, at most */
};

/* Longest semi-axis of the outermost ring or disk: well inside one turn, so that angles stay
   unique. */
static const double trapping_widest = 1.6;

/* The radius is less by this share than that of the largest ring that came home, which leaves room
   for the error of a pendulum that is inside. */
static const double trapping_margin = 0.05;

/* The radius of the first base ring; the fraction of the contraction that nonlinearity may use. */
static const double trapping_base_first = 0.25, trapping_base_departure = 0.7;

/* Iterates are taken together until the linear map contracts to this. */
static const double trapping_base_contraction = 0.6;

/* Radii grow by this while rings hold; the largest that holds is found to these, by effort. */
static const double trapping_climb = 2.5, trapping_few_ratio = 1.3, trapping_many_ratio = 1.04;

/* A direction whose multiplier is at least this large is slow. */
static const double trapping_slow = 0.8;

/* A point is home where its radius is at most this share of that of the ellipse known already. */
static const double trapping_home = 0.9;

/* Neighbours on a ring may drift apart by this many radii. Further apart they do not tell what
   happens between them. They start at 0.39 radii (16 points) or 0.13 (48). Points are lost where
   they leave this many radii. */
static const double trapping_widest_gap = 1.0, trapping_lost = 4.0;

/* Tangents are taken from a second point, this share of an arc further on. */
static const double trapping_beside = 0.125;

/* ---- trapping regions, by a polynomial ---- */

enum {
  LEVEL_CIRCLES = 8, /* of the disk, equally far apart */
  LEVEL_RAYS = 32,   /* four a period of the fastest angular change of what is left of a fit */
  LEVEL_PASSES = 12  /* disks that are tried */
};

/* Damping is weak where a period leaves more than this of a distance: beyond, rings of a few
   iterates reach as far. */
static const double level_weak = 0.94;

/* Disks are wider or narrower than the one before by this factor. */
static const double level_pace = 1.5;

/* V falls by at least this share of what the linear map takes from it. */
static const double level_least_fall = 0.5;

/* Along a ray V grows with the distance to a power between the inverse of this and this; with the
   square where the linear map is all. */
static const double level_growth = 4.0;

/* The share of a fall by damping that a term of size one must change to be in V. Others, such as
   the square of V itself, are as good one way as another: they are left out. */
static const double level_indifferent = 1e-4;

/* V on the edge of a region, as a share of that on the closed line around it that was checked. With
   the square of the distance, that leaves trapping_margin of it. Where V grows with the fourth
   power it leaves half as much along a ray, and less across: a quarter is allowed for. */
static const double level_room_share = 0.25;

/* Outside of the region, as far as it reaches, V is at least this multiple of its level. */
static const double level_beyond = 1.2;

/* ---- settling ---- */

enum {
  SETTLE_CHAOTIC_STREAK = 32, /* strobes in a row in a chaotic attractor's cells: then chaotic */
  SETTLE_ASIDE = 32,          /* periods that a lane is integrated for where there is no chart */
  SETTLE_GLIDES = 4096,       /* charts, a millisecond, after which it is asked whether to go on */
  /* Periods in which replicas part, and that lanes of slow drives get in any case. */
  WARM_UP = 200
};

/* Steps after which a lane is given up, unless the caller has set a budget of periods: they take
   seconds if the lane is alone, and are ten times what settling takes at a damping of 1e-4. Slow
   drives take many steps per period: they get some periods in any case. */
static const double settle_most_steps = 5e6;

/* The first budget is so many periods and so many times of settling; the last one counts these a
   hundred times. The slowest orbit's time, up to a bound, and that of transient chaos, of which one
   of e^10 pendulums is still in it then, are added with the weights of the first. */
static const double settle_least = 20.0, settle_times = 10.0;
static const double settle_last_some = 2000.0, settle_last_times = 100.0;
static const double settle_slowest = 1e4;

/* Under a parametric drive pendulums become faster than the attractor that they settle on, by less
   than this on their way to it. */
static const double settle_overshoot = 2.0;

/*
 * Plain pendulums of ensembles are run less exactly at first, over so many periods and so many
 * times of settling, and no more than the last. Most of f08's members are then settled; twice or
 * half as long takes as much time. Next to a fold, where the distance between outcomes is less than
 * what settle_borne takes it for, so many strobes are far too few to go from one to another: with
 * distances of D the map moves a state by D^2 or so.
 */
static const double settle_soon_least = 6.0, settle_soon_times = 3.0, settle_soon_most = 50.0;

/* Budgets have these bounds, which only dampings below 1e-6 meet. */
static const double settle_first_most = 1e7, settle_last_most = 1e8;

/*
 * The ratio of the error to the largest one that cannot change the label decides whether that is
 * certain. Inside an ellipse trapping_margin of the radius is allowed. On the way there the error
 * must stay small against the distance to a basin boundary: both grow at the same rate, until the
 * distance is that between different outcomes, of order one; a thirtieth of that is allowed. Where
 * the error itself is several times that distance, it is no longer known what the pendulum does:
 * the lane is lost.
 */
static const double settle_borne = 0.03, settle_lost = 100.0;

/* The error a period of the most exact run: rounding in some hundred steps is as large. */
static const double settle_most_exact = 1e-14;

/* A further run is by this factor more exact than would just suffice, and by at least this factor
   more exact than the run before. It gets this multiple of the first budget. */
static const double settle_to_spare = 4.0, settle_at_least = 30.0;
enum { SETTLE_AGAIN = 8 };

/* Rounding in single precision was measured for pendulums that turn by so many radians a period. */
static const double settle_farthest_in_float = 50.0;

/* A force that grows faster than the distance leads to infinity within a period. The state at the
   period's end is then no number, or a meaningless one of either sign, beyond all lengths of the
   force. */
static const double escape_lost_beyond = 1e8;

/* Oscillations of a spring grow for certain where a multiplier is beyond 1 by more than errors of
   one period; and where they do, that multiple of what a bound says is allowed for errors of the
   bound itself: of a sum for an integral, a few percent, and of the steps. */
static const double escape_grows = 1e-6, escape_spare = 1.5;

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

/* ---- chaos: replicas that are followed ---- */

enum {
  SUSPECTS = 16,         /* lanes that are tested first ... */
  SUSPECT_PERIODS = 128, /* ... over this number of periods */
  REPLICAS = 64,         /* replicas that are followed, once they have separated */
  ATTEMPTS = 3,          /* to start them, while some leave the chaotic set immediately */
  BATCHES = 16,          /* into which periods of an average are divided: an even number */
  FEW_BATCHES = 4,       /* after which replicas on different attractors are distinguished */
  /* Periods of a batch, at first. Replicas may visit the bands of an attractor in turn, all in
     step: 120 periods are whole rounds of 2, 3, 4, 5, 6 or 8 bands. */
  BATCH = 120,
  LONGEST_BATCH = 4 * BATCH, /* periods; batches grow to this while replicas do not agree */
  KEPT = 8 * BATCH           /* latest strobe points of a replica that are kept */
};

/* The logarithm of a suspect's tangent vector must have grown by this. Without chaos the vector
   grows by a small factor at most. */
static const double chaos_suspicious = 2.0;

/* Replicas start this close to the suspect, and at each further attempt closer by this factor: the
   basin of a chaotic attractor in narrow bands may end nearby. */
static const double chaos_scatter = 1e-3, chaos_closer = 0.03;

/* Replicas agree when the variance of their means is less than this multiple of what is expected
   from their batches. For replicas on one attractor the ratio exceeds 2 in one case of 80000 with
   16 batches, and in one of 6000 with 4 (F distribution). */
static const double chaos_agreement = 2.0;

/* The confidence of a mean's error, and that of the bound on the escape rate. */
static const double chaos_confidence = 0.999, chaos_escape_confidence = 0.95;

/* ---- wells, and free oscillations in them ---- */

enum {
  WELL_ROLLS = 1000, /* steps downhill after which no well is expected any more */
  /* Parts of the way to free_near in which a well's rim is looked for, and beyond a part's share of
     the distance: a rim that is stepped over is a hill over so short a way that it stops next to no
     amplitude, whatever the largest one is that is asked for. */
  FREE_FINENESS = 256,
  /* Points for an oscillation's period: as few as a harmonic one needs, and as many as one needs
     that comes within rounding of the separatrix, where they grow as one over the root of the
     distance; and the points of a mean force, which is of a smooth function. */
  FREE_FEWEST = 16,
  FREE_MOST = 8192,
  FREE_ORDER = 128,
  /* Operations of a period beside those of the force, each with a rounding. */
  FREE_ROUNDINGS = 8
};

/* Steps downhill are this long at most, and the last one is rounding. */
static const double well_longest = 0.1, well_last_step = 1e-12;

/* So close to a place the force is linear to a few millionths. */
static const double well_near = 1e-3;

/* So far from a well its rims are looked for in equal parts, beyond in parts that grow. */
static const double free_near = 1.0;

/* ---- rotations without a lock ---- */

enum {
  ANNULUS_TURNS = 2,       /* of a pendulum that may be on one */
  ANNULUS_LONGEST = 2000,  /* periods in which pendulums come to the curve, at most */
  ANNULUS_STROBES = 8,     /* from then on, that are its points */
  ANNULUS_POINTS = 64,     /* at least */
  ANNULUS_RETURNS = 256,   /* periods in which an edge comes in, at most */
  ANNULUS_MEAN = 2048,     /* periods of the first mean, ... */
  ANNULUS_LONGEST_MEAN = 32768 /* ... and of the last */
};

/* Pendulums have come to the curve where what separated them has fallen by exp(-this). */
static const double annulus_faded = 25.0;

/* Angles between its points: less is not needed, more leaves it undetermined. */
static const double annulus_points_apart = 1e-3, annulus_widest_gap = 0.2;

/* The first annulus, relative to the largest velocity: that thin, all motions in it are on a curve;
   the last one is no wider than this. */
static const double annulus_thin = 1e-4, annulus_far = 8.0;

/* Images of neighbours on an edge are closer than this in angle; what an edge departs from its
   chords by leaves room within the annulus, and this share of its width on either side does. */
static const double annulus_step = 0.3, annulus_inside = 0.25, annulus_margin = 0.05;

/* Edges are moved by such factors. */
static const double annulus_first_factor = 8.0, annulus_least_factor = 1.05;

/* A mean that is known to this is taken; it rounds to that much, and is computed with so many times
   the steps to see what they do. */
static const double annulus_mean = 1e-7, annulus_rounding = 1e-13, annulus_finer = 1.4;

#endif
