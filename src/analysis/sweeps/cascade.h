/* cascade.h -- doublings of a period up to orbits of a longest period; see pendres/cascade.h. */
#ifndef PENDRES_SWEEPS_CASCADE_H
#define PENDRES_SWEEPS_CASCADE_H

#include <pendres/cascade.h>

/* A cascade to follow, from a stable orbit while the parameter moves towards a limit. */
typedef struct pendres_cascade_way {
  const pendres_orbit *orbit;
  pendres_parameter parameter;
  double limit;
  int longest; /* period of the orbits that are followed */
} pendres_cascade_way;

/* *last, which may be NULL: a stable orbit half way between the last two doublings; its period is 0
   where orbits do not become as long, or it is not found. No doublings are no failure. */
pendres_status pendres_cascade_follow(pendres_context *ctx, const pendres_cascade_way *way,
                                      pendres_cascade *out, pendres_orbit *last);

#endif
