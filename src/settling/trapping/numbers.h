/*
 * numbers.h -- numbers that were chosen for regions that nothing leaves, or that all leaves, each
 * with its reason. Lengths are in canonical units, in which those of a motion are of order one.
 */
#ifndef PENDRES_TRAPPING_NUMBERS_H
#define PENDRES_TRAPPING_NUMBERS_H

#include "orbits/numbers.h"

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

/* ---- escapes ---- */

/* A force that grows faster than the distance leads to infinity within a period. The state at the
   period's end is then no number, or a meaningless one of either sign, beyond all lengths of the
   force. */
static const double escape_lost_beyond = 1e8;

/* Oscillations of a spring grow for certain where a multiplier is beyond 1 by more than errors of
   one period; and where they do, that multiple of what a bound says is allowed for errors of the
   bound itself: of a sum for an integral, a few percent, and of the steps. */
static const double escape_grows = 1e-6, escape_spare = 1.5;

#endif
