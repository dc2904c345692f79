/*
 * numbers.h -- numbers that were chosen for following curves of solutions, each with its reason.
 * Lengths are in the scale of arclength (map.h).
 */
#ifndef PENDRES_CONTINUATION_CURVE_NUMBERS_H
#define PENDRES_CONTINUATION_CURVE_NUMBERS_H

#include "orbits/numbers.h"

/* ---- when two are the same ---- */

/* Special points of one kind whose unknowns are closer than this are one: their errors are less. */
static const double curve_same_place = 1e-8;

/* What is closer to a bifurcation, errors aside, or to a branch that crosses, cannot be told from
   it: on which side an orbit is, which way a tangent goes, whether an orbit closes by half. A point
   that is known no better is none. */
static const double curve_untold = 1e-6;

/* An orbit that misses closing by a half map by less than this is next to where the branch was born
   from such orbits: it may be so far away by the length of a step. */
static const double curve_near_birth = 1e-3;

/* ---- rounding, and differences ---- */

/* Rounding of one step of an integration, taken three times as large as it usually is, since errors
   claim to be bounds. */
static const double pendres_step_rounding = 4e-16;

/* Of a step, with an ample margin: what keeps branches apart and is not larger than this, no double
   can tell. */
static const double crossing_rounding = 6e-15;

/* The step of central differences of the map's derivatives: its square, the truncation, and 1e-15
   over it, the rounding, are both small enough to steer by or to be claimed as errors. */
static const double pendres_central_step = 1e-4;

/* The step of one-sided differences of a determinant by the unknowns. They only steer Newton's
   method, where a relative error of 1e-5 costs nothing. The step is so short since second
   derivatives grow to 1e9 where orbits pass close to the top of the barrier; the determinant's own
   rounding, 1e-15, does no harm. */
static const double determinant_step = 2e-9;

/* At weak damping the step is longer, but not beyond 2e-5, over which maps hardly bend. */
static const double determinant_weakest = 1e-4;

/* The derivative along the null vector enters the solution itself: central differences of order
   six, whose truncation step^6 and rounding epsilon/step are both about 1e-13. */
static const double null_vector_step = 8e-3;

/* Values of a parameter above this times its least scale are taken by their ratios. */
static const double scale_logarithmic = 20.0;

/* The state counts by its ratio to the size of an orbit, but no further than to so many times the
   damping, or to the last number: narrower than that no resonance is. From a damping of one over
   this on, where folds are of order one, lengths are counted. */
static const double scale_weak = 20.0, scale_least = 1e-5;

/* Steps may change the way of a large orbit in a period by this share of what damping does. */
static const double map_undamped = 0.01;

/* ---- curves ---- */

enum {
  /* Each way, unless callers choose: a length of 100. Of a stretch between two turns the first 200
     count, a length of ten, more than most have that turn. A curve over twenty decades has no more
     points than the last number. */
  PENDRES_CURVE_POINTS = 2000,
  CURVE_STRETCH = 200,
  CURVE_LONGEST = 20000,
  FOLLOW_ITERATIONS = 6,         /* of Newton's method from a point that was predicted */
  FOLLOW_WIDEST_GAP = 3          /* steps that lie between one point and the next, at most */
};

/* A follower begins with this share of the largest spacing, and from eight points ahead that all
   converged goes on with steps longer by this factor. It ends where steps must be shorter than the
   last number. */
static const double follow_first_share = 0.1, follow_faster = 1.6, follow_shortest = 1e-6;

/* A Newton step below this leaves an error of its square: what is located on a curve begins from
   its points. */
static const double follow_last_step = 1e-8;

/* Points ahead may not turn by more than this cosine from one to the next, nor lie further from
   their prediction than this share of the way. */
static const double follow_sharpest_turn = 0.92, follow_farthest_miss = 0.25;

/* The chord from one point to the next goes along the mean of their tangents, to this share of its
   length: exactly so where the curve bends steadily. Of forty thousand chords one in a hundred is
   off by more than 0.01, none by more than 0.06; those that lead from one branch to another where
   they come close, as next to a sharp fold, are off by 0.1 and more; less of it is trusted where
   points were stepped over. */
static const double follow_farthest_off = 0.08;

/* Steps to the nearest orbit before each of Newton's for a bifurcation at weak damping. */
enum { NEWTON_APPROACH = 4 };

/* With steps shorter than this many of the shortest no crossing is looked into: branches that come
   closer are told by the doubts of their points. */
static const double follow_to_crossing = 32.0;

/* A node on a bound has its parameter to this: the plane that it is corrected in is that value. */
static const double curve_on_bound = 1e-12;

/* A curve is back at its start where it passes that in its own direction, to this cosine, and after
   more than this many of its steps. */
static const double curve_back_along = 0.9, curve_another_pass = 4.0;

/* ---- special points between nodes ---- */

/* A minimum above the first share of its neighbours' values is no zero that the points missed. One
   below the second may be a zero that is touched and not crossed: where branches cross, points are
   hard to correct, and the search ends early. */
static const double zero_suspicious = 0.3, zero_touching = 0.05;

/* A search ends at this length of arc. A vertex this close to the least point, as a share of what
   is searched, tells nothing new. */
static const double zero_narrowest = 1e-9, zero_known = 0.02;

/* A zero that Newton's method does not find from the chord is closed in to this share of it. */
static const double zero_closed_in = 1e-5;

enum {
  ZERO_TRIALS = 24,
  ZERO_HALVE_EVERY = 4 /* trials, in case parabolas close in from one side */
};

/* ---- solutions of the equations, and their errors ---- */

/* Newton's steps are cut at this length, and earlier where they begin at the solution by fewer
   steps of the integration. Steps longer than the last number are far outside of all scales. */
static const double locate_longest = 0.1, locate_longest_again = 0.01, newton_lost = 1e3;

/* Newton's method ends where steps are rounding, or are short (newton_stalled) and no longer fall:
   determinants' derivatives are differences, so the next step is a hundredth of the last or less,
   unless it is rounding. */
static const double newton_always_rounding = 1e-13;

/* Parts of an error that cancel to less than this share may do so by chance. A determinant is off
   by at least this share of what the entries of its matrix are. */
static const double locate_by_chance = 1.0 / 32.0, locate_own_share = 0.125;

/* The values of a parameter by few and by more steps may agree by chance: it is not known better
   than to this share of what the points differ by. Errors of the steps act like a change of
   coordinates for the most part, which moves the orbit but not the parameter at which it
   bifurcates. They do change a lag: with a quarter none of 1700 claims on backbones was too small,
   without it one in fifty. */
static const double polish_agree = 0.005, polish_agree_in_lag = 0.25;

/* Next to a fold a branch goes along its parameter by at least this share of its length: nearer by,
   the orbit moves as the root of what the parameter is off by, and rounding hides the rest. */
static const double polish_flattest = 1e-3;

/* The coarser point of a pair is moved along the branch if that is less than this share of the way
   to the next fold, as far as the tangent tells. */
static const double polish_before_fold = 0.05;

#endif
