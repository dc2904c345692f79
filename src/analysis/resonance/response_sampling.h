/*
 * response_sampling.h -- the sampling error of an ensemble that is a sample of an area.
 */
#ifndef PENDRES_RESPONSE_SAMPLING_H
#define PENDRES_RESPONSE_SAMPLING_H

#include <pendres/response.h>

/*
 * Set r->sampling of a response whose ensemble is a rectangle or random, and add it to all errors.
 * where[members] as in response_members.h.
 */
void pendres_response_sample(const pendres_ensemble *e, const signed char *where,
                             pendres_response *r);

/* The same with a share that is known, for a response that has none yet. */
void pendres_response_widen(pendres_response *r, double sampling);

/* Whether a motion rotates: it then has no amplitude and no loop. */
int pendres_response_running(const pendres_attractor *a);

#endif
