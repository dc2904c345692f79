/*
 * small_end.h -- the fold at which SA ends along a line of points in one parameter.
 *
 * Owns: how that fold, found once for the line, determines the label of a single state at a point.
 */
#ifndef PENDRES_SMALL_END_H
#define PENDRES_SMALL_END_H

#include <pendres/continuation.h>

#include "orbits/label.h"

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
