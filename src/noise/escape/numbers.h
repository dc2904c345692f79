/*
 * numbers.h -- numbers that were chosen for paths of least action, each with its reason.
 */
#ifndef PENDRES_ESCAPE_NUMBERS_H
#define PENDRES_ESCAPE_NUMBERS_H

/* ---- saddles ---- */

enum {
  SADDLE_CUTS = 16,    /* parts into which a line is cut at a time, which share a block */
  SADDLE_ROUNDS = 6,   /* of cutting: to 2^-24 of its length, beyond which labels take long */
  SADDLE_CYCLES = 4,   /* the longest cycle of a saddle that is looked for, in drive periods */
  SADDLE_RAYS = 4,     /* lines along both axes, beside those to other attractors */
  SADDLE_AFTER = 10,   /* drive periods for which a boundary point is followed, at least, ... */
  SADDLE_MOST_AFTER = 20000 /* ... and at most; */
};
static const double saddle_fade = 24.0;   /* e-folds of decay for which it is, in between */
static const double saddle_leaves = 10.0; /* growth of the distance over a cycle since its least */
static const double saddle_beside = 1e-4; /* of the distance to the state: where both sides begin */
static const double saddle_near = 0.1;    /* of it: how far from the point that leads to it */
static const double saddle_far = 3.0;     /* scales of a force within which its barriers are */

/* ---- candidates ---- */

/* How far from the state a motion that comes to it may be at the window's end, relative to the
   saddle's distance. */
static const double way_off = 0.1;
/* How close to its ends, relative to their distance, a path is when it is cut off there: what is
   left out is of third order in it. */
static const double way_cut = 1e-4;
/* Steps of the grid on which candidates are minimised, and of the integration, in units of the
   shortest time of the equation; errors grow by no more than e^3 on a piece. */
static const double way_coarse = 0.15, way_fine = 0.2, way_folds = 3.0;
enum { WAY_MOST_POINTS = 4000000 };       /* of such a grid: a gigabyte */

enum { RELAX_ROUNDS = 200 };              /* of the minimisation */
static const double relax_done = 1e-7;    /* relative fall of the action after which none counts */
static const double relax_stiffest = 1e12; /* of the method's own spring: nothing moves any more */

/* ---- multiple shooting ---- */

enum { POLISH_NEWTON = 40 };              /* iterations, of which 4 to 8 are usual */
static const double polish_last = 1e-8;   /* a Newton step after which its square is left */
static const double polish_small = 1e-6;  /* one that nothing need improve: rounding is reached, */
static const double polish_rounding = 1e-12; /* as where pieces meet as closely */
static const double polish_least = 1e-3;  /* part of a step: where less does not help, none does */

/* ---- the least of all ---- */

enum {
  LEAST_SHARES = 4,   /* of a drive period, by which guesses are shifted */
  LEAST_STRIDES = 16, /* parts of it, by which paths are, ... */
  LEAST_TRIAL = 64    /* ... once to see where the action falls */
};
static const double least_finer = 1.4, least_longer = 1.0; /* steps, e-folds at ends: what counts */
static const double least_level = 1e-5; /* of the derivative by a shift, relative to its largest */
/* Actions that differ by less, relative to them, are those of one path; and what another phase may
   make of one is negligible, or little enough to stand in its error where no phase is found. */
static const double least_alike = 1e-7, least_negligible = 1e-8, least_little = 1e-5;
/* Error by rounding, relative to the action. */
static const double least_rounding = 0x1p-44;

/* ---- tables ---- */

enum {
  TABLE_ROWS = 4000,  /* of a path, but for one */
  TABLE_BETWEEN = 12  /* points a piece */
};

#endif
