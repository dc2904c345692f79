/*
 * numbers.h -- numbers that several files of continuation choose by, each with its reason. Lengths
 * are in the scale of arclength (map.h).
 */
#ifndef PENDRES_CONTINUATION_NUMBERS_H
#define PENDRES_CONTINUATION_NUMBERS_H

/* The largest spacing of points along curves that callers see, unless they choose another: eight
   points ahead are predicted at once, and over eight such steps most curves bend little. Where only
   what is found on the way matters, twice that leads there with half of the points. */
static const double pendres_curve_spacing = 0.05, pendres_search_spacing = 0.1;

/* Curves are given up where errors grow by more than this in one map, unless callers choose another
   number: such orbits have long been unstable, and their curves do not come back. */
static const double pendres_curve_wildest = 1e3;

enum {
  PENDRES_CURVE_POINTS = 2000, /* each way, unless callers choose: a curve of length 100 */
  PENDRES_SEARCH_ADVANCES = 300 /* a search ends after 2400 points, more than a curve may have */
};

/* Rounding of one step of an integration, taken three times as large as it usually is, since errors
   claim to be bounds. */
static const double pendres_step_rounding = 4e-16;

/* An error that is claimed may be too small, though hardly ever by this factor: what lies further
   apart than so many errors is not the same. */
static const double pendres_several_errors = 10.0;

/* The step of central differences of the map's derivatives: its square, the truncation, and
   1e-15 over it, the rounding, are both small enough to steer by or to be claimed as errors. */
static const double pendres_central_step = 1e-4;

/* Orbits whose amplitudes differ by less, errors aside, may be one. */
static const double pendres_same_orbit = 1e-5;

#endif
