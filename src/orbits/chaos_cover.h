/*
 * chaos_cover.h -- what a set of attractors holds for a chaotic attractor.
 *
 * Owns: the cells of the Poincaré plane that it visits, and its means over time as plain numbers.
 */
#ifndef PENDRES_CHAOS_COVER_H
#define PENDRES_CHAOS_COVER_H

enum { PENDRES_COVER_CELLS = 128 /* a side */ };

/* Cells of the Poincaré plane that a chaotic attractor visits, or that touch such a cell. */
typedef struct pendres_cover {
  int attractor;                 /* its number in the set of attractors */
  double w_most;                 /* cells span |w| <= w_most, and all angles */
  double span;                   /* width of the cells in y together, about 0; 0: a whole turn */
  double mean_y, mean_w;         /* over the attractor */
  unsigned char cell[PENDRES_COVER_CELLS][PENDRES_COVER_CELLS];
} pendres_cover;

int pendres_cover_holds(const pendres_cover *cover, double y, double w);

/* Add the cell of a state, and its neighbours. */
void pendres_cover_add(pendres_cover *cover, double y, double w);

/* A mean over time and its error. */
typedef struct pendres_chaos_mean {
  double value, error;
} pendres_chaos_mean;

/* What is known of a chaotic attractor: its means over a drive period. */
typedef struct pendres_chaos_measures {
  pendres_chaos_mean growth;                  /* its error is one standard error */
  pendres_chaos_mean work, loss, amplitude, turns; /* their errors: half of a 99.9 % interval */
  double watched_periods;                     /* drive periods, all replicas together */
  double escape_rate_bound;                   /* see attractor.h */
} pendres_chaos_measures;

#endif
