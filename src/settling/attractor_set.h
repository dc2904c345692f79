/*
 * attractor_set.h -- the attractors of parameter sets, with their trapping ellipses.
 *
 * Owns: finding attractors from initial guesses, numbering and labelling them, and telling which
 * ellipse a state lies in. Attractors keep the order of their discovery until
 * pendres_attractor_set_order() puts them into their physical order. Works on many parameter sets
 * at a time, so that blocks stay full.
 */
#ifndef PENDRES_ATTRACTOR_SET_H
#define PENDRES_ATTRACTOR_SET_H

#include <pendres/attractor.h>
#include <pendres/rotation.h>

#include "engine/strobe_run.h"
#include "settling/trapping/annulus.h"
#include "settling/trapping/escape.h"
#include "settling/trapping/trapping_ellipse.h"

enum {
  PENDRES_MOST_COVERS = 4,   /* chaotic attractors of a parameter set */
  PENDRES_MOST_ANNULI = 2,   /* rotations without a lock: one each way */
  PENDRES_COVER_CELLS = 128, /* a side */
  PENDRES_MOST_GUESSES = 8   /* orbits that are searched for at a time in a parameter set */
};

/* Cells of the Poincaré plane that a chaotic attractor visits, or that touch such a cell. */
typedef struct pendres_cover {
  int attractor;                 /* its number in the set of attractors */
  double w_most;                 /* cells span |w| <= w_most, and all angles */
  double span;                   /* width of the cells in y together, about 0; 0: a whole turn */
  double mean_y, mean_w;         /* over the attractor */
  double y, w;                   /* one of its states */
  unsigned char cell[PENDRES_COVER_CELLS][PENDRES_COVER_CELLS];
} pendres_cover;

int pendres_cover_holds(const pendres_cover *cover, double y, double w);

/* Add the cell of a state, and its neighbours. */
void pendres_cover_add(pendres_cover *cover, double y, double w);

/* A mean over time and its error. */
typedef struct pendres_chaos_mean {
  double value, error;
} pendres_chaos_mean;

/* What is known of an attractor that does not close: its means over a drive period. */
typedef struct pendres_open_measures {
  pendres_label label;
  pendres_chaos_mean growth;                  /* its error is one standard error */
  pendres_chaos_mean work, loss, amplitude, turns; /* their errors: half of a 99.9 % interval */
  double watched_periods;                     /* drive periods, all replicas together */
  double escape_rate_bound;                   /* see attractor.h */
  double x, v;                                /* one of its states; NaN: none is known */
} pendres_open_measures;

/* Those of a rotation without a drive. */
pendres_open_measures pendres_open_turning(const pendres_pendulum *p, const pendres_rotation *r);

/* The attractor that has them. */
pendres_attractor pendres_attractor_open(const pendres_pendulum *p, const pendres_open_measures *m);

typedef struct pendres_attractor_set {
  pendres_pendulum pendulum;
  pendres_trapping_effort effort;
  int any_well; /* 1: the well that a pendulum settles in does not matter */
  size_t count, capacity;
  pendres_attractor *attractors;
  size_t ellipses, ellipse_capacity;
  pendres_trapping_ellipse *ellipse;
  int *owner; /* attractor of each ellipse */
  size_t covers;
  pendres_cover *cover[PENDRES_MOST_COVERS]; /* of chaotic attractors; owned */
  size_t annuli;
  pendres_annulus *annulus[PENDRES_MOST_ANNULI]; /* of rotations without a lock; owned */
  int turns;        /* whether one is a rotation without a drive, ... */
  int turning;      /* ... and its number */
  int grows;        /* the force is linear, and all motions grow without bound */
  pendres_escape_beside beside; /* from where on they do beside a spring */
  double transient; /* mean lifetime of transient chaos, in drive periods; 0: none was found */
} pendres_attractor_set;

/* A state of a parameter set from which to start, or near which to look for an orbit. */
typedef struct pendres_initial_guess {
  size_t set;       /* index of its set of attractors */
  double y, w;
  int period, winding; /* of the orbit it is thought to be near */
} pendres_initial_guess;

/* Whether an attractor is a closed orbit: neither chaos nor a rotation without a lock. */
static inline int pendres_attractor_closes(const pendres_attractor *a)
{
  return a->orbit.period > 0;
}

void pendres_attractor_set_clear(pendres_attractor_set *c);

/*
 * The default initial guesses for a pendulum in canonical units: spread over a turn, or about as
 * far with other forces; for these also across each of up to four wells that have a barrier.
 * Returns their number. An attractor whose basin contains none of these states may still be missed.
 */
enum { PENDRES_ATTRACTOR_SET_STARTS = 180 };
size_t pendres_attractor_set_starts(const pendres_pendulum *p,
                                    double x[PENDRES_ATTRACTOR_SET_STARTS],
                                    double v[PENDRES_ATTRACTOR_SET_STARTS]);

/*
 * The bottoms of the wells of a pendulum whose transients last longer than initial guesses are
 * followed; of another, none. The small orbit that may be there is reached by none of those,
 * however close to it the pendulum is in the end. Returns their number.
 */
enum { PENDRES_ATTRACTOR_SET_BOTTOMS = 4 };
size_t pendres_attractor_set_bottoms(const pendres_pendulum *p,
                                     double y[PENDRES_ATTRACTOR_SET_BOTTOMS]);

/* Integrate initial guesses (their period and winding are not read, but overwritten), and add the
   orbits that they lead to. */
pendres_status pendres_attractor_set_explore(pendres_context *ctx, size_t sets,
                                             pendres_attractor_set *attractor_sets, size_t n,
                                             pendres_initial_guess *guesses);

/* Refine guesses to orbits, and add the stable ones that are new, with their ellipses. Where there
   is mirror symmetry, the image of an orbit that is not its own image is added, too. */
pendres_status pendres_attractor_set_add(pendres_context *ctx,
                                         pendres_attractor_set *attractor_sets, size_t n,
                                         const pendres_initial_guess *guesses);

/* Make room for one more attractor with `more_ellipses` ellipses; nonzero if out of memory. */
int pendres_attractor_set_reserve(pendres_attractor_set *c, size_t more_ellipses);

/* Add an attractor that does not close, with its cover, or with its annulus if it is a rotation
   that is driven: the others are NULL. The set takes ownership of it. */
pendres_status pendres_attractor_set_add_open(pendres_context *ctx, pendres_attractor_set *c,
                                              const pendres_open_measures *m,
                                              pendres_cover *cover, pendres_annulus *annulus);

/*
 * The physical order of attractors: order[place] = number. Orbits come first, in the order of their
 * amplitudes and then of their Poincaré points; chaotic attractors follow in the order of their
 * means, then rotations that do not close, in that of their drifts. A difference that rounding
 * alone can make does not decide: attractors whose amplitudes are that close are compared by the
 * next number. The order thus does not depend on that of discovery. Nonzero if out of memory.
 */
int pendres_attractor_set_sort(const pendres_attractor_set *c, int *order);

/* Put attractors into their physical order, and label them. rank[old number] = new number is
   written for all of them; rank may be NULL. */
pendres_status pendres_attractor_set_order(pendres_context *ctx, pendres_attractor_set *c,
                                           int *rank);

/*
 * Measures and multipliers of an orbit and of its mirror image are exactly the same. Where those
 * of two differ by more than their errors, at least one of the errors is too small, and both are
 * raised to the difference. Without the mirror symmetry nothing is compared.
 */
void pendres_attractor_set_compare_images(pendres_attractor_set *c);

/* The ellipse that a state is in; NULL if in none. */
const pendres_trapping_ellipse *pendres_attractor_set_ellipse(const pendres_attractor_set *c,
                                                              double y, double w);

/* The annulus that a state is in; NULL if in none. */
const pendres_annulus *pendres_attractor_set_annulus(const pendres_attractor_set *c, double y,
                                                     double w);

/* The number of the attractor, and the well, that a lane in one of the set's ellipses is on. */
int pendres_attractor_set_locate(const pendres_attractor_set *c, const pendres_trapping_ellipse *t,
                                 const pendres_strobe_lane *lane, long *well);

#endif
