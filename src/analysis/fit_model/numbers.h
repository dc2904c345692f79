/*
 * numbers.h -- numbers that were chosen for fits, each with its reason. Lengths, times and what
 * follows from them are in canonical units.
 */
#ifndef PENDRES_FIT_NUMBERS_H
#define PENDRES_FIT_NUMBERS_H

#include "base/numbers.h"

enum {
  /* States that an oscillator is on in one sweep, one after another: a resonance has two, and an
     overtone one more. */
  FIT_STAGES = 3,
  /* Folds of a curve, of which two make a resonance hysteretic. */
  FIT_FOLDS = 16,
  /* Nodes of a curve: some hundred are usual. */
  FIT_NODES = 1500,
  FIT_REST_ROUNDS = 8, /* of Newton's method, for where a pendulum rests under its torque */
  FIT_FOLD_ROUNDS = 4, /* secants for a fold: each gives as many digits as the two before */
  /* Steps a period, at most this many and so many times as many as where a start began: values that
     need more have gone astray. Slow drives take some hundred. */
  FIT_MOST_STEPS = 1000,
  FIT_MORE_STEPS = 4,
  FIT_PASSES = 8,      /* of Newton's method at the data, from points of the curve between nodes */
  FIT_AGAIN = 3, /* times that the solver begins anew where it has stalled */
  FIT_ITERATIONS = 60,
  FIT_COMPARED = 1, /* starts beside one that fits, which one in twenty wrong ones does, ... */
  FIT_COMPARED_ITERATIONS = 4, /* ... and steps before the solver begins anew there */
  FIT_GUESS_DATA = 120, /* data that the guess looks at, evenly chosen */
  FIT_GUESS_PLACES = 121, /* of the small resonance that are tried */
  FIT_GUESS_SIZES = 17,   /* and largest amplitudes, four a decade from 3 down */
  FIT_GUESS_STARTS = 10,  /* that are improved */
  FIT_GUESS_AROUND = 3, /* dampings beside that of a guess */
  FIT_GUESS_RAW = 6, /* that are tried as they are as well */
  FIT_GUESS_DAMPINGS = 10, /* of junctions, from fit_guess_damping on */
  /* Data of a free decay that a guess looks at: at first, and until there are a few cycles. The
     latter takes a tenth of a second. */
  FIT_DECAY_FIRST = 32,
  FIT_DECAY_WINDOW = 1024,
  FIT_PROFILE_PLACES = 64, /* at which chi-square is followed one way; a dozen is usual */
  FIT_PROFILE_ITERATIONS = 20, /* to one of them, from values that went on as before */
  FIT_DECAY_WAY = 64, /* places from rest to a guess of the start, between which a barrier may be */
  FIT_NOTES = 12,
  FIT_NOTE = 400
};

/* So close to its bottom a well is linear. */
static const double linear_near = 1e-4;

/* Curves have this many nodes from rest to the largest amplitude, however weak it is, and steps
   along the axis are as short as a resonance is wide or as the data are apart: a step longer than
   both might go over the resonance. */
static const double fit_nodes_high = 14.0, fit_steps_across = 150.0;

/* A curve goes beyond the data by this share of their range, so that it begins and ends outside of
   the range in which states coexist; and folds may lie further out by so many ranges. */
static const double fit_margin = 0.3, fit_outside = 3.0;

/* So many of its widths beside a resonance states do not coexist because of it. */
static const double fit_resonance_widths = 3.0;

/* What stays above 0, as a frequency, begins at this share of its lowest value in the data, and
   is not followed below the second: slow drives take many steps. */
static const double fit_lowest = 0.8, fit_least = 0.05;

/* What Newton's method corrects last, as a share of an orbit's size, leaves its square. */
static const double fit_last_step = 3e-5;

/* Nodes of a curve moved to other parameters lie further apart by no more than this. */
static const double fit_torn = 4.0;

/* Orbits at data are computed to this, or to ten times the tolerance if that is less: far below the
   errors of any instrument. */
static const double fit_accuracy = 1e-7;

/* The tolerance on a line is at least this share of the model's unit of length, with which orbits
   are as exact as said above. */
static const double fit_finest = 1e-8;

/* An orbit this close to a fold, as a share of the piece of the curve, may be lost to it. */
static const double fit_lost_near_fold = 0.05;

/* Chi-square that may still be gained where a fit has converged: values are then off by a thirtieth
   of their errors. A fit goes on to far less. */
static const double fit_converged = 1e-3, fit_step_tolerance = 1e-9;

/* Where a datum is right at the model's jump chi-square has a kink, whose derivatives do not tell
   what may be gained: a stalled fit then counts as converged if they say less than this. */
static const double fit_kinked = 1.0;

/* Where data come to be left out as values change chi-square has steps: values are then off by at
   most a third of their errors. */
static const double fit_stepped = 0.1;

/* Of two sets of values whose chi-squares differ by less than this, three standard deviations of
   one value, neither is excluded; they are two if they are more than so many standard errors
   apart. */
static const double fit_twin = 9.0, fit_apart = 6.0;

/* A value this close to a bound, as a share of the range, is at it: fits begin further inside. */
static const double fit_at_bound = 1e-5, fit_inside = 1e-3;

/* Below this ratio of singular values of the scaled derivatives a combination is not determined:
   they are known to six digits or so. */
static const double fit_undetermined = 1e-5;

/* An error as large as this share of a positive number, or of the angle that a bounded one is seen
   as, may be no small change, if chi-square then differs by more than the second share from a
   parabola two errors away: what is three errors away by the one is up to 3.3 by the other. Of
   what goes with the square of such a number it does. */
static const double fit_far = 0.02, fit_bent = 0.1;

/* Steps along it, in what the solver sees, as a logarithm: the first, the longest, and the
   shortest, at which it ends; chi-square is followed up to this rise, three standard deviations,
   and grows by no more than this from step to step; and so far, a factor of 160,000. What still
   moves there has no end. */
static const double fit_profile_first = 0.1, fit_profile_long = 2.0, fit_profile_short = 0.01,
                    fit_profile_rise = 9.0, fit_profile_grows = 4.0, fit_profile_end = 12.0;

/* Of what has an end at least two thirds of the way come in the first half of the steps. */
static const double fit_profile_ends = 1.5;

/* A fit whose chi-square is so improbable says that it is on a wrong minimum, or the model or the
   errors are wrong. A start whose probability is above the second number ends the search: one in
   twenty of the right ones goes on in vain, and few of the wrong ones end it. */
static const double fit_improbable = 1e-6, fit_good_enough = 0.05;

/* Outliers are few: where more than this share of the data are, it is the fit that is off. */
static const double fit_outliers = 0.5;

/* Residuals of neighbours are correlated beyond chance where the sum of their products is further
   from 0 than this many standard deviations. */
static const double fit_correlated = 5.0;

/* Where errors are not known, data scatter about a right fit more than neighbours do about each
   other by chance alone: by less than this over the root of their number. */
static const double fit_excess = 5.0;

/* Amplitudes below 0 by more than so many errors, or, where none are known, by more than this share
   of the largest one, which is noise that fits are not tested with, are none. */
static const double fit_beyond_errors = 5.0, fit_beyond_noise = 0.5;

/* Data below this share of the largest are left out of a guess: noise would count most there. */
static const double fit_guess_least = 0.3;

/* What dampings are tried beside that of a guess, over it. */
static const double fit_guess_around[FIT_GUESS_AROUND] = {0.8, 1.25, 0.65};

/* A junction shows a voltage from this share of the largest on. */
static const double fit_guess_voltage = 0.1;

/* About the velocity of a rotation next to its end over that of the two before it. At a damping of
   0.1 and gaps of 0.03 it is 0.53 a tenth of a gap from the end. */
static const double fit_last_voltage = 0.5;

/* The first damping that is tried of a junction, and the factor to the next: what bends the curve
   above the critical current and moves its lower end changes by as much. */
static const double fit_guess_damping = 0.02, fit_guess_dampings = 2.0;

/* Cycles that tell the frequency of a free decay to some per cent. */
static const double fit_decay_cycles = 3.0;

/* A motion of more cycles in the time of the data has gone astray: data tell at most half as many
   as they are. */
static const double fit_decay_periods = 1e6;

/* The error of a period of a decay, below which rounding counts. */
static const double fit_decay_least = 1e-12;

/* A damping that takes away this part of a motion, or half of it, over the time of the data is seen
   by a fit in which they grow in number. */
static const double fit_decay_seen = 0.1;

/* What errors of data over time are taken for where none are known, as a share of the largest
   datum; the fit then tells them, and the first guess weighs nothing. */
static const double fit_decay_scatter = 0.01;

/* Of a line the share of the coupling in all losses that a guess begins with is at least this, and
   as far from 1; and where nothing bends a resonance its drive bends it by this share of its
   width. */
static const double fit_line_share = 1e-3, fit_line_straight = 1e-2;

#endif
