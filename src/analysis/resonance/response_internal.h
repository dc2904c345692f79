/*
 * response_internal.h -- from the outcomes of an ensemble's members to its means.
 */
#ifndef PENDRES_RESPONSE_INTERNAL_H
#define PENDRES_RESPONSE_INTERNAL_H

#include <pendres/response.h>

#include "orbits/attractor_set.h"

/*
 * The response of n members, whose outcomes number the attractors of c: means over all members, and
 * a list of the attractors that most members are on. where[n], which may be NULL, receives the
 * listed attractor that each member is on; -1: none of these.
 */
pendres_status pendres_response_summarize(pendres_context *ctx, const pendres_attractor_set *c,
                                          size_t n, const pendres_outcome *outcome,
                                          signed char *where, pendres_response *r);

#endif
