/*
 * label.h -- the labels of orbits: the only definition of SA and LA.
 *
 * Of the orbits of one drive period without winding that coexist at a pendulum's parameters, the
 * one of smallest amplitude is SA, those of larger amplitude are LA, whatever the drive; a pair of
 * mirror images counts as one. A single state has the name of the branch that it continues, which
 * follows from the fold at which SA ends (see pendres_label_border), and none where there is no
 * such fold. Where folds are not known, as for a single set of parameters, an equivalent rule for
 * the weak drives of the paper is used: SA has a phase lag of less than pi/3, LA of more.
 *
 * Owns: that definition, and how the fold, found once for a line of points in one parameter,
 * determines the label of a single state at a point. No integration here.
 */
#ifndef PENDRES_LABEL_H
#define PENDRES_LABEL_H

#include <pendres/attractor.h>
#include <pendres/continuation.h>

enum { PENDRES_LABEL_STATES = 16 };

/* The states that coexist: amplitudes of stable orbits that can have a name, each once. */
typedef struct pendres_label_states {
  size_t count;
  double amplitude[PENDRES_LABEL_STATES], error[PENDRES_LABEL_STATES];
} pendres_label_states;

/* The fold at which SA ends along a parameter, relative to one point of that line: a single orbit
   beyond the fold is LA; before it, it is SA if its amplitude is less than the fold's, else LA. */
typedef struct pendres_label_border {
  int distinct;     /* 0: there is no such fold, and no distinction */
  int beyond;       /* whether the point lies beyond the fold */
  double amplitude; /* of the orbit at the fold */
} pendres_label_border;

/* Whether an orbit can be SA or LA: one drive period, no winding. */
int pendres_label_named(const pendres_orbit *orbit);

/* Add an orbit to the states if it is stable and can be SA or LA, unless its amplitude is known. */
void pendres_label_note(pendres_label_states *states, const pendres_orbit *orbit);

/* Which state has the smallest amplitude (most = 0) or the largest; there must be one. */
size_t pendres_label_extreme(const pendres_label_states *states, int most);

/* The label of a closed orbit among the states. border: NULL where folds are not known. */
pendres_label pendres_label_of(const pendres_label_states *states,
                               const pendres_label_border *border, const pendres_orbit *orbit);

/* The fold at which SA ends along a line of points in one parameter. */
typedef struct pendres_small_end {
  int known;                   /* 0: there is no such fold, and no distinction */
  pendres_parameter parameter; /* that changes along the line */
  double value;                /* of the parameter, at the fold */
  double amplitude;            /* of the orbit there */
  int falling;                 /* nonzero: SA ends as the parameter decreases, not as it increases:
                                  with stiffening forces, whose resonance bends upwards */
} pendres_small_end;

/* The fold relative to an orbit with these parameters. */
pendres_label_border pendres_small_end_from(const pendres_small_end *end,
                                            const pendres_pendulum *pendulum);

#endif
