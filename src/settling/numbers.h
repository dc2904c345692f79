/*
 * numbers.h -- numbers that were chosen for what pendulums settle on, each with its reason.
 * Lengths are in canonical units, in which those of a motion are of order one.
 */
#ifndef PENDRES_SETTLING_NUMBERS_H
#define PENDRES_SETTLING_NUMBERS_H

#include "settling/exponents/numbers.h"

/* ---- where orbits are looked for ---- */

enum {
  /* Positions across the turn of a pendulum, or across a well, each at rest and moving either way;
     and as many of the pendulums of a parameter set, which are integrated before the others. */
  GUESS_ACROSS = 12,
  /* Places in a unit of length of a force at which wells are searched for. */
  GUESS_FINENESS = 64
};

/* Guesses closer than this lead to the same orbit, so one of them is enough. */
static const double guess_same = 0.05;

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

/* ---- settling ---- */

enum {
  SETTLE_CHAOTIC_STREAK = 32, /* strobes in a row in a chaotic attractor's cells: then chaotic */
  SETTLE_ASIDE = 32,          /* periods that a lane is integrated for where there is no chart */
  SETTLE_GLIDES = 4096        /* charts, a millisecond, after which it is asked whether to go on */
};

/* Steps after which a lane is given up, unless the caller has set a budget of periods: they take
   seconds if the lane is alone, and are ten times what settling takes at a damping of 1e-4. Slow
   drives take many steps per period: they get some periods in any case. */
static const double settle_most_steps = 5e6;

/* The first budget is so many periods and so many times of settling; the last one counts these a
   hundred times. The slowest orbit's time, up to settle_slowest, and that of transient chaos, of
   which one of e^10 pendulums is still in it then, are added with the weights of the first. */
static const double settle_least = 20.0, settle_times = 10.0;
static const double settle_last_some = 2000.0, settle_last_times = 100.0;

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

/* A further run gets this multiple of the first budget. */
enum { SETTLE_AGAIN = 8 };

/* ---- chaos: replicas that are followed ---- */

enum {
  SUSPECTS = 16,         /* lanes that are tested first ... */
  SUSPECT_PERIODS = 128, /* ... over this number of periods */
  REPLICAS = 64,         /* replicas that are followed, once they have separated */
  ATTEMPTS = 3,          /* to start them, while some leave the chaotic set immediately */
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

/* ---- rotations without a lock ---- */

enum {
  ANNULUS_TURNS = 2,       /* of a pendulum that may be on one */
  ANNULUS_STROBES = 8,     /* from then on, that are its points */
  ANNULUS_POINTS = 64,     /* at least */
  ANNULUS_RETURNS = 256    /* periods in which an edge comes in, at most */
};

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

/* ---- arrivals ---- */

enum {
  ARRIVAL_PERIODS = 500 /* after which a pendulum on no closed orbit is on its attractor */
};

/* The mean turns of chaos that was taken for a rotation are known no better than this. */
static const double arrival_scatter = 1e-3;

#endif
