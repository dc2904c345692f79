/*
 * numbers.h -- numbers that were chosen for responses of ensembles and for resonances, each with
 * its reason.
 */
#ifndef PENDRES_RESONANCE_NUMBERS_H
#define PENDRES_RESONANCE_NUMBERS_H

#include "continuation/numbers.h"

/* ---- budgets ---- */

/*
 * What one search may cost. Several that go side by side may cost as much together: it is not known
 * which of them has spent how much of the common budget, but none can have spent more than it would
 * have alone. When it is spent, those that have not ended start again, each with a budget of its
 * own.
 */
static const double search_most_work = 30.0;

/* The work of one evaluation of a pendulum's equation, and of one step of Newton's method: about
   seconds of one processor, but the same number on every machine. Periods would not do as a
   measure: pendulums whose labels are uncertain are integrated again with ten times as many steps.
   The last is the least work of a period, for estimates. */
static const double work_of_slope = 2.5e-9, work_of_newton = 4e-4, work_of_period = 2e-7;

enum {
  PENDRES_SEARCH_POINTS = 1500, /* most frequencies of one search */
  PENDRES_SEARCH_COARSE = 19,   /* over the range at first */
  SEARCH_TOGETHER = 8,          /* searches: more would not make blocks much fuller */
  SEARCH_SECTIONS = 4,          /* a gap is cut into */
  PENDRES_RESPONSE_BATCH = 32   /* parameter sets side by side: blocks are full of their members */
};

/* The share of a resonance's width that frequencies of a scan are apart. */
static const double scan_share = 0.7;

/* ---- gaps ---- */

/*
 * A gap with a jump is cut until it is this narrow, relative to the force's frequency; then its
 * fold is located, or the jump is found by halving. Where some members change to larger areas and
 * some to smaller ones, it is cut until they are apart, or down to the narrowest gap.
 */
static const double gap_narrow = 2e-5, gap_narrowest = 1e-7;

/*
 * A member may be on a state in a gap that it is on at a distance of so many widths of the gap:
 * where basins alternate with frequency they do so at all scales, and a state that a member is
 * never on within some widths is hardly in between. So many points are looked at on either side.
 * Finally what is left open is told from as far as the response changes, where states alternate. Of
 * more members than a few the members beside one show where its basin comes back, as in any gap.
 */
static const double gap_around = 3.0, gap_around_far = 1.0;
enum {
  GAP_BESIDE = 256,
  GAP_FEW = 24
};

/* Areas of mirror images at neighbouring frequencies differ by their slopes and this share. */
static const double gap_image = 0.01;

/* ---- folds that end a state ---- */

enum {
  EDGE_DECIDERS = 8, /* members that are followed up to a fold */
  EDGE_ORBITS = 3    /* whose branch is followed to its fold, to name a state */
};

/* ---- peaks ---- */

enum {
  PEAK_STEPS = 60, /* of a search between two frequencies, each of which is computed */
  TURN_TRIALS = 8  /* where a curve of resonances turns */
};

/* The share of a phase lag's possible error that is claimed, since few and more steps may agree by
   chance. */
static const double peak_chance = 0.1;

/* The spacing of dampings where a curve turns; around a small damping it is a tenth, then a
   fortieth of that. */
static const double turn_first_spacing = 4e-3, turn_last_spacing = 1e-3;

/* ---- ensembles ---- */

/* Standard errors that are claimed: as for the shares of basins. */
static const double sampling_claimed = 2.0;

/* The bias that steps are chosen for, of the loop area and of the first harmonic's amplitude. */
static const double response_bias = 1e-4;

#endif
