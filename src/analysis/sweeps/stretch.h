/*
 * stretch.h -- the stable part of a branch, from a place on it to where stability is lost.
 *
 * Owns: finding that part, its end, and the orbits at values of the parameter within it.
 */
#ifndef PENDRES_STRETCH_H
#define PENDRES_STRETCH_H

#include <pendres/continuation.h>

/* How a stretch ends: the state ends in all but the first and the last. */
typedef enum pendres_stretch_end {
  PENDRES_STRETCH_LIMIT,       /* goes on to the limit, or beyond it */
  PENDRES_STRETCH_BIFURCATION, /* loses its stability at a bifurcation */
  PENDRES_STRETCH_BIRTH,       /* shrinks into the orbit that it was born from, by doubling its
                                  period or losing its symmetry */
  PENDRES_STRETCH_UNLOCATED,   /* turns back or loses its stability between two points, between
                                  which no bifurcation was found */
  PENDRES_STRETCH_STOPPED      /* the computation ended, not the state: it is to be resumed from the
                                  last point, see pendres_stretch_extend() */
} pendres_stretch_end;

typedef struct pendres_stretch {
  pendres_branch *branch;
  pendres_orbit start; /* that the branch was followed from */
  size_t points_each_way;
  pendres_parameter parameter;
  pendres_orbit at; /* where the stretch begins, ... */
  double from;      /* ... the parameter's value there, ... */
  int born;         /* ... and whether that is a bifurcation */
  size_t first, points; /* of the branch, from the place on, that at the end included */
  int step;             /* from one of them to the next: 1 or -1 */
  int period, winding;  /* of its orbits */
  int direction;        /* in which the parameter goes: 1 or -1 */
  double end_value, end_error; /* of the parameter; the limit's if that is reached */
  pendres_stretch_end end;
  pendres_bifurcation bifurcation; /* where it ends at one */
} pendres_stretch;

/* Nothing to free. */
static const pendres_stretch pendres_stretch_none = {.branch = NULL};

void pendres_stretch_free(pendres_stretch *s);

/* The stretch from a stable orbit on, the parameter going towards the limit. */
pendres_status pendres_stretch_from(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double limit,
                                    pendres_stretch *out);

/*
 * The stretch of the orbits that are born at a period doubling or a loss of symmetry, likewise.
 * PENDRES_NOT_FOUND if none that is stable is born on that side.
 */
pendres_status pendres_stretch_born(pendres_context *ctx, const pendres_bifurcation *at,
                                    double limit, pendres_stretch *out);

/* Go on with a stretch that stopped. PENDRES_NOT_FOUND if it gets no further. */
pendres_status pendres_stretch_extend(pendres_context *ctx, pendres_stretch *s, double limit);

/* The last regular point of it: a state, period, winding and stability, without measures. */
const pendres_branch_point *pendres_stretch_last(const pendres_stretch *s);

/* Its orbit with measures; without, if Newton's method does not lead there. */
pendres_status pendres_stretch_arrive(pendres_context *ctx, const pendres_stretch *s,
                                      pendres_orbit *out);

/* Whether a value of the parameter comes before the stretch ends. */
int pendres_stretch_holds(const pendres_stretch *s, double value);

/*
 * The orbits at n values, which the stretch holds, in its direction. found[i]: 0 where Newton's
 * method did not lead to a stable orbit of the branch.
 */
pendres_status pendres_stretch_orbits(pendres_context *ctx, const pendres_stretch *s, size_t n,
                                      const double *value, pendres_orbit *out, int *found);

#endif
