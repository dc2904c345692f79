/*
 * numbers.h -- numbers that were chosen for spectra and dimensions, each with its reason.
 */
#ifndef PENDRES_CHAOS_NUMBERS_H
#define PENDRES_CHAOS_NUMBERS_H

#include "settling/exponents/numbers.h"

/* ---- dimensions and spectra ---- */

enum {
  DIMENSION_APART = 32,   /* pairs that are closer than this in time are left out */
  DIMENSION_FEWEST = 500, /* least number of pairs that are closer than the shortest distance */
  DIMENSION_LEAST = 5     /* least number of distances from which a slope is taken */
};

/* The longest distance as a share of the points' extent: the edges have no effect up to there. */
static const double dimension_close_by = 1.0 / 32.0;

/* Rounding of a slope, and of an amplitude as a share of the largest one. */
static const double dimension_rounding = 1e-14, spectrum_rounding = 4e-15;

#endif
