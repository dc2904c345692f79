/*
 * numbers.h -- numbers that were chosen for branches, backbones and their sets, each with its
 * reason. Lengths are in the scale of arclength (curve/map.h).
 */
#ifndef PENDRES_CONTINUATION_NUMBERS_H
#define PENDRES_CONTINUATION_NUMBERS_H

#include "continuation/curve/numbers.h"

/* ---- when two are the same ---- */

/* An orbit that lies on a branch has measures that differ by less than this from those interpolated
   along the branch's chord. Orbits of different branches at one parameter differ by more, unless
   the branches meet right there. */
static const double curve_alike = 5e-3;

/* A point this close to a bifurcation does not tell what there is before or behind that: it may be
   on either of two branches that meet there. Curves reach within this of their cusps and turning
   points, and what a motion does beyond a bifurcation is seen this far beyond. For orbits of period
   one; all of a late branch of a cascade may be as close. */
static const double just_beyond = 1e-4;

/* By so much a branch is followed beyond where it is needed, in the parameter's scale. */
static const double part_margin = 0.003;

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

/* A search ends after 2400 points, more than a curve may have. */
enum { PENDRES_SEARCH_ADVANCES = 300 };

/* A branch's parameter is searched as far as this ratio. */
static const double search_widest_range = 3.0;

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
