/*
 * numbers.h -- numbers that were chosen for sweeps, jumps, crises and ramps, each with its reason.
 * Distances of values are in the parameter's scale.
 */
#ifndef PENDRES_SWEEPS_NUMBERS_H
#define PENDRES_SWEEPS_NUMBERS_H

#include "continuation/numbers.h"

/* ---- work ---- */

/* Evaluations of the slope that one value may take. The most that was seen in sweeps of hundreds of
   values, at a state that ends in a cascade of doublings, is a fifth of it; a path of a few values
   on which all of a cascade and a crisis lie between two of them takes two thirds. */
static const double sweep_usual_slopes = 3e9;

enum {
  /* The longest orbits that are followed where no bifurcations are asked for: the last doublings of
     a cascade, which lie within a hundredth of its length, take most of its work. */
  SWEEP_STATES_PERIOD = 8,
  SWEEP_MOST_JUMPS = 256, /* between two values of the path */
  /* So many at once that the few lanes left at last, which slip past the end of a lock seldom, are
     those of all values of most paths. */
  SWEEP_ABREAST = 4096,
  SWEEP_HELD = 256,  /* orbits of a part that are computed together, within a second or so, after
                        which a path may keep its state */
  SWEEP_AT_LEAST = 8 /* one alone takes as long as so many, the lanes of the widest vectors */
};

/* A state is followed to values this close at once; the work for one further away is counted as its
   own. Values this close are averaged side by side, and what is found so close is what the pendulum
   comes to, whatever it is. */
static const double sweep_in_sight = 100.0, sweep_side_by_side = 20.0, sweep_close_by = 0.1;

/* ---- stable parts of branches ---- */

/* A branch is not followed where errors grow by more than this in a map: it has long been
   unstable. */
static const double stable_wildest = 3000.0;

/* Points each way. For pendulums whose rotations lock to the drive there are few at first, then
   four times as many until they are enough: a lock of q periods lies on a closed branch that passes
   all of its q points, and the part is one of many. */
enum { STABLE_FEW_POINTS = 48, STABLE_ENOUGH = 8 };

/* A branch is followed no further beyond the end of a part than so many points, enough for it to be
   told. */
enum { STABLE_BEYOND = STABLE_ENOUGH + 2 };

/* From an orbit a part goes one way: the branch is followed the other way by this share of the
   margin only, which shows that there is an orbit, too. */
static const double stable_little = 0.01;

/* How close to a bifurcation the branch that is born there has that, too. */
static const double stable_near_birth = 1e-5;

/* ---- jumps: trials beyond an end ---- */

enum { JUMP_ROUNDS = 3 /* of trials, each further beyond the end than the one before */ };

/* Half of the trials are just_beyond the bifurcation, the others so much nearer, and those of the
   next round so much further. Within each half they vary by a factor of 1.5. The time to pass a
   fold goes as one over the root of the distance, and so differs by a fifth, which is many
   periods. */
static const double jump_further = 10.0;

/* Trials start this far from an orbit that has become unstable, where deviations grow fast. */
static const double jump_away = 0.03;

/* ---- chaos that ends or grows: lives ---- */

enum {
  LIVES = 32,        /* pendulums whose lives in chaos are averaged ... */
  LIVES_APART = 8,   /* ... from states so many periods apart, after which it has lost its memory */
  ENDS_HALVINGS = 8, /* of the distance of two values between which chaos ends */
  ENDS_BIRTHS = 8,   /* of an orbit from another, one after the other */
  ENDS_SHORT = 16,   /* period of orbits of a cascade that pendulums settle on soon */
  LIVES_FURTHER = 4  /* lives are measured at two distances, this factor apart at least; from an end
                        the first is so many times what halving has left of the interval */
};

/* The distance of trials from the birth of a lock, to which a rotation goes the more slowly the
   closer it is. */
static const double ends_beside_lock = 1e-3;

/* Lives in chaos grow as a power of the distance from its end, of at least this (Grebogi, Ott and
   Yorke, Physical Review Letters 57 (1986) 1284). */
static const double ends_least_power = 0.5;

/* Chaos that was watched for this many lives without an end, or without leaving, has been seen to
   end, but for one case in twenty: e^-3. */
static const double lives_watched = 3.0;

/* ---- crises, at which chaos suddenly grows ---- */

enum {
  CRISIS_WARM_UP = 100, /* periods in which pendulums come to chaos at another value, ... */
  CRISIS_PERIODS = 256, /* ... and are watched */
  CRISIS_CELLS = 32,    /* of a region, a side. It reaches beyond what it was made of by one to two
                           of them, of 1.5 times its size together: 5 to 10 %, the least change
                           seen */
  CRISIS_HALVINGS = 12, /* of the interval: what changes gradually does so by its size within
                           1/4096 */
  CRISIS_FURTHER = 8    /* distances at which lives are measured are at most this factor apart */
};

/* Chaos that is larger is outside the region of the smaller for this share of its time. */
static const double crisis_least_share = 0.01;

/* Pendulums closer than this share of a cell's side are on one orbit: of 32 in chaos, whose
   dimension is above 1, two are so close in 5 of 100,000 samples at most. */
static const double crisis_same = 1e-6;

/* Lives become longer towards a crisis, as a power of the distance, mostly of 1/2 to 1. Each of two
   lives, the means of 32, has a standard error of 18 %, and the power one of 0.12 to 0.18. For
   the error it is taken to be 1 unless it is more: with a higher one lives are long for further. */
static const double crisis_least_power = 0.25, crisis_safe_power = 1.0;

/* The nearer distance is one at which lives are shorter than this share of all the periods for
   which the smaller chaos was watched, so that it would have left there several times. */
static const double crisis_short_life = 0.1;

/* ---- ramps ---- */

enum {
  RAMP_FEWEST_STEPS = 16, /* of a part of a drive period, and of a trajectory without a drive */
  RAMP_MOST_STEPS = 65536, /* no gate needs a drive period in more parts */
  RAMP_PROBES = 8
};

/* States whose x advances differently by more in the time of a window, in rad, are told apart by
   that: a rotation's window has a turn, but for those locked to many drive periods a turn. */
static const double ramp_advance_apart = 0.5;

/* States whose first harmonics, or positions of rest, differ by a smaller share are not told apart
   by these. */
static const double ramp_harmonic_apart = 1e-3;

/* So many of a state's own times a trajectory must have left it for: a turn that passes the saddle
   point closely takes longer than the turns before it. */
static const double ramp_own_times = 2.0;

#endif
