/*
 * numbers.h -- numbers that were chosen for curves of orbits and of bifurcations, each with its
 * reason. Lengths are in the scale of arclength (map.h).
 */
#ifndef PENDRES_CONTINUATION_NUMBERS_H
#define PENDRES_CONTINUATION_NUMBERS_H

#include "orbits/numbers.h"

/* ---- when two are the same ---- */

/* Special points of one kind whose unknowns are closer than this are one: their errors are less. */
static const double curve_same_place = 1e-8;

/* What is closer to a bifurcation, errors aside, or to a branch that crosses, cannot be told from
   it: on which side an orbit is, which way a tangent goes, whether an orbit closes by half. A point
   that is known no better is none. */
static const double curve_untold = 1e-6;

/* An orbit that lies on a branch has measures that differ by less than this from those interpolated
   along the branch's chord. Orbits of different branches at one parameter differ by more, unless
   the branches meet right there. */
static const double curve_alike = 5e-3;

/* A point this close to a bifurcation does not tell what there is before or behind that: it may be
   on either of two branches that meet there. Curves reach within this of their cusps and turning
   points, and what a motion does beyond a bifurcation is seen this far beyond. For orbits of period
   one; all of a late branch of a cascade may be as close. */
static const double just_beyond = 1e-4;

/* An orbit that misses closing by a half map by less than this is next to where the branch was born
   from such orbits: it may be so far away by the length of a step. */
static const double curve_near_birth = 1e-3;

/* By so much a branch is followed beyond where it is needed, in the parameter's scale. */
static const double part_margin = 0.003;

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

/* The largest spacing of points along curves that callers see, unless they choose another: eight
   points ahead are predicted at once, and over eight such steps most curves bend little. Where only
   what is found on the way matters, twice that leads there with half of the points. */
static const double pendres_curve_spacing = 0.05, pendres_search_spacing = 0.1;

/* Curves are given up where errors grow by more than this in one map, unless callers choose another
   number: such orbits have long been unstable, and their curves do not come back. Curves of
   bifurcations are given up earlier: their equations have derivatives of the map, whose errors grow
   as the square. */
static const double pendres_curve_wildest = 1e3, bifurcations_wildest = 300.0;

enum {
  /* Each way, unless callers choose: a length of 100. Of a stretch between two turns the first 200
     count, a length of ten, more than most have that turn. A curve over twenty decades has no more
     points than the last number. */
  PENDRES_CURVE_POINTS = 2000,
  CURVE_STRETCH = 200,
  CURVE_LONGEST = 20000,
  PENDRES_SEARCH_ADVANCES = 300, /* a search ends after 2400 points, more than a curve may have */
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

/* A branch's parameter is searched as far as this ratio. */
static const double search_widest_range = 3.0;

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

/* ---- branches that begin at bifurcations ---- */

/* How far from the bifurcation the other branch is looked for at first: further than rounding and
   the errors of the bifurcation reach, and nearer than most branches bend. A branch that crosses
   departs from its direction by no more than the second share of the way. */
static const double switch_away = 0.02, switch_straight = 0.05;

/* A neighbour on that way is followed at this distance: far above rounding, and so near that it
   obeys the linear equation. */
static const double switch_beside = 1e-6;

/* Of orbits of twice the period near their birth, two points that follow one another have the
   bifurcation in their middle, to this share of their distance from it: of forty births the worst
   was off by 0.36. Another branch that the plane met was off by 2.3. */
static const double switch_middle = 0.5;

enum { SWITCH_HALVINGS = 6 /* of the distance, until it does */ };

/* Where two curves cross: a third or fourth node is at least this share of the chord away from it,
   or the cubic would come from differences of rounding. A bifurcation is within two lengths of the
   chord of where the cubic has it, and this much besides, for chords that are short. Two guesses
   lead to one place if what they lead to is closer than this share of their own distance. */
static const double crossed_not_too_close = 0.2, crossed_besides = 1e-3, crossed_together = 0.1;

/* ---- parts of branches ---- */

/* At so many points from a birth both sides of it are compared. */
enum { PART_SPREAD = 8 };

/* ---- backbones ---- */

enum {
  BACKBONE_STARTS = 6 /* amplitudes that are tried, each half of the one before */
};

/* The curve is begun at this amplitude or below, where a single harmonic is an orbit to some per
   cent; or above, where the force stiffens: such oscillations stay close to a harmonic. */
static const double backbone_first = 0.1;

#endif
