/*
 * response_members.h -- the response of an ensemble, and the state of each member.
 */
#ifndef PENDRES_RESPONSE_MEMBERS_H
#define PENDRES_RESPONSE_MEMBERS_H

#include <pendres/response.h>

#include "orbits/attractor_set.h"

/* Parameter sets that are computed side by side: enough to fill blocks with their members. */
enum { PENDRES_RESPONSE_BATCH = 32 };

/*
 * As pendres_response_find(). where[n * members], unless it is NULL, receives the state that
 * each member is on, as a number in its response's state[]; -1: none of those.
 */
pendres_status pendres_response_members(pendres_context *ctx, size_t n,
                                        const pendres_pendulum *pendulums,
                                        const pendres_ensemble *ensemble, signed char *where,
                                        pendres_response *out);

/* NULL if the pendulum and the ensemble's starts are valid, or what is wrong with them. */
const char *pendres_response_refuses(const pendres_pendulum *p, const pendres_ensemble *e);

/*
 * The response of n members, whose outcomes number the attractors of c: means over all members, and
 * a list of the attractors that most members are on. where[n], which may be NULL, receives the
 * listed attractor that each member is on; -1: none of these.
 */
pendres_status pendres_response_summarize(pendres_context *ctx, const pendres_attractor_set *c,
                                          size_t n, const pendres_outcome *outcome,
                                          signed char *where, pendres_response *r);

#endif
