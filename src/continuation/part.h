/*
 * part.h -- the parts of a branch along which its orbits attract.
 *
 * Owns: how far such a part reaches from a point of the branch, and how it ends: one notion for
 * the parts that callers list (pendres_branch_parts()) and for those that sweeps are led along.
 */
#ifndef PENDRES_CONTINUATION_PART_H
#define PENDRES_CONTINUATION_PART_H

#include "continuation/branch.h"

/* How a part ends: the state ends in all but the first and the last. */
typedef enum pendres_part_end {
  PENDRES_PART_LIMIT,       /* goes on to the limit, or beyond it */
  PENDRES_PART_BIFURCATION, /* loses its stability at a bifurcation */
  PENDRES_PART_BIRTH,       /* shrinks into the orbit that it was born from, by doubling its period
                               or losing its symmetry */
  PENDRES_PART_UNLOCATED,   /* turns back or loses its stability between two points, between which
                               no bifurcation was found */
  PENDRES_PART_STOPPED      /* the computation ended, not the state: the branch may be continued */
} pendres_part_end;

/* From a place on a branch, where orbits attract or begin to, to where they cease to. */
typedef struct pendres_part {
  pendres_branch *branch;
  pendres_orbit at;       /* the place, ... */
  int born;               /* ... and whether it is a bifurcation */
  size_t points_each_way; /* of the branch, if it is followed for the sake of the part */
  size_t first;  /* number of the point of the branch at the place */
  int step;      /* from one point of the part to the next: 1 or -1 */
  int direction; /* in which the parameter goes: 1 or -1 */
  size_t points; /* that at the end included */
  pendres_part_end end;
  double end_value, end_error;     /* of the parameter; the limit's if that is reached */
  pendres_bifurcation bifurcation; /* where it ends at one */
  struct pendres_part_way {        /* how it was found: what finds it again */
    pendres_bifurcation birth;     /* if it is born at one */
    int extended;                  /* how often; -1: too often for that */
    double limit, to[16];          /* the limits, at first and of each extension */
  } way;
} pendres_part;

/* Point number k, counted from the first one on; NULL where the branch ends before. */
const pendres_branch_point *pendres_part_point(const pendres_part *part, size_t k);

/* The parameter there. */
double pendres_part_value(const pendres_part *part, size_t k);

/* How far a value is ahead of another in the direction of the part. */
double pendres_part_ahead(const pendres_part *part, double value, double of);

/* Values of the parameter that differ by less are those of one place. */
double pendres_part_same(const pendres_part *part);

/* By so much a branch is followed beyond where it is needed. */
double pendres_part_margin(pendres_parameter parameter);

/* How the branch ends in the direction of the part. */
pendres_branch_end pendres_part_branch_end(const pendres_part *part);

/* Distance of a point of a branch from an orbit, by state and parameter. */
double pendres_part_distance(const pendres_branch *branch, const pendres_branch_point *point,
                             const pendres_orbit *orbit);

/* Find which way along the branch the parameter goes in the direction of the part, from the first
   point to the next that is not at the same place: sets the step. Where both ways do, as from a
   birth, it is that on which the orbits stay closer together, where errors are smaller. Where
   neither way does, sets the end, and returns 0: where both ways lead back the place is right at
   the end of the state, else nothing could be followed. */
int pendres_part_choose_way(pendres_part *part);

/* Take points from the first one on as long as orbits attract and the parameter goes on, up to a
   limit: sets points and the end. Returns the number of the point that told the end. */
size_t pendres_part_take(pendres_part *part, double limit);

#endif
