/*
 * stable_part.h -- the stable part of a branch from a place on, for as far as a sweep needs it.
 *
 * Owns: following the branch until it tells how the part ends, and the orbits at values of the
 * parameter within it.
 */
#ifndef PENDRES_STABLE_PART_H
#define PENDRES_STABLE_PART_H

#include "continuation/part.h"

/* Nothing to free. */
static const pendres_part pendres_part_none = {.branch = NULL};

/* Free the branch of a part. */
void pendres_part_free(pendres_part *s);

/* The part from a stable orbit on, the parameter going towards the limit. */
pendres_status pendres_part_from(pendres_context *ctx, const pendres_orbit *orbit,
                                 pendres_parameter parameter, double limit, pendres_part *out);

/*
 * The part of the orbits that are born at a period doubling or a loss of symmetry, likewise.
 * PENDRES_NOT_FOUND if none that is stable is born on that side.
 */
pendres_status pendres_part_born(pendres_context *ctx, const pendres_bifurcation *at, double limit,
                                 pendres_part *out);

/* Go on with a part that stopped. PENDRES_NOT_FOUND if it gets no further. */
pendres_status pendres_part_extend(pendres_context *ctx, pendres_part *s, double limit);

/* Find a part again of which only the place and the way are there, without counting the work. */
pendres_status pendres_part_again(pendres_context *ctx, pendres_parameter parameter,
                                  pendres_part *s);

/* The drive periods after which its orbits close. */
int pendres_part_period(const pendres_part *s);

/* The last regular point of it: a state, period, winding and stability, without measures. */
const pendres_branch_point *pendres_part_last(const pendres_part *s);

/* Its orbit with measures; without, if Newton's method does not lead there. */
pendres_status pendres_part_arrive(pendres_context *ctx, const pendres_part *s, pendres_orbit *out);

/* Whether a value of the parameter comes before the part ends. */
int pendres_part_holds(const pendres_part *s, double value);

/*
 * The orbits at n values, which the part holds, in its direction. found[i]: 0 where Newton's method
 * did not lead to a stable orbit of the branch.
 */
pendres_status pendres_part_orbits(pendres_context *ctx, const pendres_part *s, size_t n,
                                   const double *value, pendres_orbit *out, int *found);

#endif
