/*
 * response_parts.h -- what the parts of the response of an ensemble share: the state of each member
 * (response.c), averages of loops with many harmonics (response_loop.c), sampling errors
 * (response_sampling.c), and names of states that are alone (response_name.c).
 */
#ifndef PENDRES_RESPONSE_PARTS_H
#define PENDRES_RESPONSE_PARTS_H

#include <pendres/response.h>

#include "analysis/resonance/numbers.h"
#include "settling/attractor_set.h"
#include "orbits/label.h"

/* In place of a member's state: it has none, as an answer. It escapes, or rests in an unstable
   state, and means are those of the others. */
enum { PENDRES_RESPONSE_GONE = -2 };

/*
 * As pendres_response_find(). where[n * members], unless it is NULL, receives the state that
 * each member is on, as a number in its response's state[], or PENDRES_RESPONSE_GONE; -1: it is not
 * known, or not listed.
 */
pendres_status pendres_response_members(pendres_context *ctx, size_t n,
                                        const pendres_pendulum *pendulums,
                                        const pendres_ensemble *ensemble, signed char *where,
                                        pendres_response *out);

/* NULL if the pendulum and the ensemble's starts are valid, or what is wrong with them. */
const char *pendres_response_refuses(const pendres_pendulum *p, const pendres_ensemble *e);

/*
 * The response of n members, whose outcomes number the attractors of c: means over all members, and
 * a list of the attractors that most members are on; where[n] as above.
 */
pendres_status pendres_response_summarize(pendres_context *ctx, const pendres_attractor_set *c,
                                          size_t n, const pendres_settled *outcome,
                                          signed char *where, pendres_response *r);

/* ---- averaged loops: orbits keep 24 harmonics, but a slow drive has hundreds ---- */

/*
 * To be called after an average over n attractors with members[n] each, whose error
 * r->mean_loop_amplitude_error includes the harmonics that orbits do not keep. If these contribute
 * more than a tenth of the tolerance, average and error are computed again from all harmonics.
 */
pendres_status pendres_response_refine_loop(pendres_context *ctx, size_t n,
                                            const pendres_attractor *attractor,
                                            const size_t *members, pendres_response *r);

/* pendres_response_average, and the same of the attractors that are listed. */
pendres_status pendres_response_renew(pendres_context *ctx, pendres_response *r);

/* Whether an attractor has a loop that belongs into the average. */
int pendres_response_has_loop(const pendres_attractor *a);

/* ---- the sampling error of an ensemble that is a sample of an area ---- */

/*
 * Set r->sampling of a response whose ensemble is a rectangle or random, and add it to all errors.
 * where[members] as above.
 */
void pendres_response_sample(const pendres_ensemble *e, const signed char *where,
                             pendres_response *r);

/* The same with a share that is known, for a response that has none yet. */
void pendres_response_widen(pendres_response *r, double sampling);

/* Whether a motion rotates: it then has no amplitude and no loop. */
int pendres_response_running(const pendres_attractor *a);

/* ---- names of states that are alone, from their neighbours along a parameter ---- */

/* Whether a response has a state that could have a name and has none. */
int pendres_response_nameless(const pendres_response *response);

/* The fold at which SA ends, from the n responses of a line at which it coexists with LA; not
   known if they show none. */
pendres_status pendres_response_small_end(pendres_context *ctx, size_t n,
                                          const pendres_response *const *line,
                                          pendres_parameter parameter, pendres_small_end *end);

/* Name the state that is alone, and bring shares up to date. */
void pendres_response_name_by(const pendres_small_end *end, pendres_response *response);

#endif
