/*
 * accuracy.h -- `make accuracy`: results at random parameters beside what is true.
 *
 * Owns: the random draws, the tables, and the list of sections. A section draws parameters and
 * tolerances, asks the library, asks something independent for what is true, and notes for each
 * kind of result the true error over the claimed one. To add a section: a file
 * accuracy_NAME.c with a function accuracy_NAME, declared below and listed in accuracy.c.
 *
 * Draws depend on the seed, the section and the number of the item alone, so that one item can
 * be repeated and items may be computed by many threads. Notes are taken one after another.
 */
#ifndef ACCURACY_H
#define ACCURACY_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

/* What was asked for on the command line. */
typedef struct accuracy_options {
  uint64_t seed;
  long orbits;         /* items of sections about single pendulums and orbits */
  long points;         /* items of sections about scenes: ensembles, curves, grids */
  const char *section; /* NULL: all */
  int show;            /* of what falls short, how many of a kind are printed */
  long item;           /* -1: all; else this one alone, with all its results */
} accuracy_options;

typedef struct accuracy accuracy;

const accuracy_options *accuracy_get_options(const accuracy *a);

/* ---- draws ---- */

typedef struct accuracy_random {
  uint64_t state;
} accuracy_random;

/* The numbers of one item of the section that runs. */
accuracy_random accuracy_item(const accuracy *a, long item);
double accuracy_uniform(accuracy_random *r, double from, double to);
double accuracy_logarithmic(accuracy_random *r, double from, double to);
/* 0 to n - 1. */
int accuracy_choice(accuracy_random *r, int n);
/* Drive 0.01 to 1.5, damping 0.03 to 3, drive frequency 0.1 to 2: half of each by its logarithm. */
pendres_pendulum accuracy_pendulum(accuracy_random *r);
/* 1e-12 to 1e-3, by its logarithm. */
double accuracy_tolerance(accuracy_random *r);

/*
 * The items of a section: how many, how many of them side by side by threads, the size of one, and
 * what is done with each. compute() draws and computes into an item that is zero, alone; note() is
 * called one after another, in order.
 */
typedef struct accuracy_work {
  long items, at_once;
  size_t size;
  void (*compute)(accuracy_random *r, void *item, long number);
  void (*note)(accuracy *a, const void *item, long number, void *tally);
  void *tally; /* of note(), or NULL */
} accuracy_work;

/* Compute and note all items, or the one that was asked for; how many they are. */
long accuracy_each(accuracy *a, const accuracy_work *work);

/* ---- notes ---- */

/*
 * One result of a kind: what was had, what it claims its error to be, what is true. `how` repeats
 * it: parameters with %.17g, or a deck; copied. A claim that is infinite or NaN counts as marked,
 * not as an answer; a result that is NaN under a finite claim falls short without bounds.
 */
void accuracy_note(accuracy *a, const char *kind, double got, double claimed, long double wanted,
                   const char *how);
/* The same where the error was measured in another way. */
void accuracy_note_error(accuracy *a, const char *kind, double error, double claimed,
                         const char *how);
/* Something that must not happen at all. */
void accuracy_complain(accuracy *a, const char *what, const char *how);

/* ---- orbits ---- */

/* A point, with period and winding, of what a random start of the guess's pendulum settles on: 1 if
   that closes within eight drive periods. */
int accuracy_settled_guess(pendres_context *ctx, accuracy_random *r, pendres_orbit_guess *g);
/* What an orbit has beside what is true of it: all but x, which is counted from elsewhere, and the
   multipliers. */
void accuracy_note_orbit(accuracy *a, const pendres_orbit *o, const reference_cycle *e,
                         const char *how);
/* What is true of the orbit of a linear oscillator. */
void accuracy_linear_exact(const pendres_pendulum *p, reference_cycle *e);
/* Of the two pairs of multipliers, the farther: as they are ordered, or the other way round. */
double accuracy_multipliers_apart(const pendres_orbit *o, const reference_cycle *e);

/* ---- units ---- */

/* How long a user's unit of length is in that of a draw, and a unit of time. */
typedef struct accuracy_units {
  double length, time;
} accuracy_units;

/* Millionths to millions of both, no powers of two. */
accuracy_units accuracy_draw_units(accuracy_random *r);
/* The same oscillator in units so long: what has a dimension is divided by it. */
pendres_pendulum accuracy_in_units(const pendres_pendulum *p, accuracy_units u);
/* The powers of two next to units: what is converted by them keeps all digits. */
accuracy_units accuracy_near_units(accuracy_units u);
/* An orbit that was found in units so long, in those of the draw. */
pendres_orbit accuracy_out_of_units(const pendres_orbit *o, accuracy_units u);

/* ---- an own simulation ---- */

/* A pendulum, whose parameter may move by `rate` each drive period from a value on. */
typedef struct accuracy_own {
  pendres_pendulum pendulum;
  pendres_parameter parameter;
  double from, rate;
  int steps; /* a drive period, of order four */
} accuracy_own;

/* Drive period `number` from the state x, v on, with noise unless that is NULL; and the first
   harmonic of x during it. */
void accuracy_own_period(const accuracy_own *own, long number, accuracy_random *noise, double s[2],
                         double harmonic[2]);

/* Long trajectories beside the value of a jump from chaos to chaos: one before it, and what becomes
   of it beyond. */
typedef struct accuracy_crisis {
  int compared;      /* both are chaotic */
  int differs;       /* the larger chaos is there on one side only */
  double outside[2]; /* how much of each is outside the region of the other, ... */
  double aside;      /* ... and how far from the value they are */
} accuracy_crisis;

/* `from` is a state x, v of the chaos before the jump. */
accuracy_crisis accuracy_crisis_beside(const pendres_pendulum *p, pendres_parameter parameter,
                                       const pendres_jump *j, const double from[2]);
/* Let a pendulum come from the state s to what there is at a value: to such a `from`. */
void accuracy_crisis_come(const pendres_pendulum *p, pendres_parameter parameter, double value,
                          double s[2]);

/* ---- sections ---- */

void accuracy_orbits(accuracy *a);
void accuracy_branches(accuracy *a);
void accuracy_models(accuracy *a);
void accuracy_scales(accuracy *a);
void accuracy_weak(accuracy *a);
void accuracy_linear_curves(accuracy *a);
void accuracy_strong_curves(accuracy *a);
void accuracy_linear(accuracy *a);
void accuracy_advance(accuracy *a);
void accuracy_resonance(accuracy *a);
void accuracy_search(accuracy *a);
void accuracy_ensembles(accuracy *a);
void accuracy_sweeps(accuracy *a);
void accuracy_ramps(accuracy *a);
void accuracy_switching(accuracy *a);
void accuracy_fits(accuracy *a);
void accuracy_fit_errors(accuracy *a); /* of that section */
void accuracy_lines(accuracy *a);

/* ---- for main ---- */

accuracy *accuracy_create(const accuracy_options *options);
void accuracy_free(accuracy *a);
void accuracy_begin_section(accuracy *a, const char *name);
/* Print the section's table and what falls short; 1 if the goals are met. */
int accuracy_end_section(accuracy *a);

#endif
