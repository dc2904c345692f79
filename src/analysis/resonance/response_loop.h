/*
 * response_loop.h -- the loop averaged over an ensemble where its harmonics are many.
 *
 * Owns: averages of loops that are computed again. Orbits keep 24 harmonics, but with a slow drive
 * hundreds of them are significant.
 */
#ifndef PENDRES_RESPONSE_LOOP_H
#define PENDRES_RESPONSE_LOOP_H

#include <pendres/response.h>

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

#endif
