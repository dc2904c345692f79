/*
 * noise_common.h -- what all questions about noise around an attractor have in common.
 *
 * Owns: who trajectories are, how long they settle, how many steps a period they take, and the
 * parts that they are followed in.
 */
#ifndef PENDRES_NOISE_COMMON_H
#define PENDRES_NOISE_COMMON_H

#include <pendres/langevin.h>
#include <pendres/orbit.h>

/* The first id of trajectories of a pendulum that start on attractor number `attractor` of its
 * set. Ids follow from parameters, so that results do not depend on what else is asked for. */
uint64_t pendres_noise_first_id(const pendres_pendulum *p, size_t attractor);

/* Why noise has no steady state around the attractors of a pendulum: its force lets go of it, so
   that noise carries it to infinity in the end. NULL if nothing is wrong. */
const char *pendres_noise_refuses(const pendres_pendulum *p);

/* Drive periods until a cloud around the orbit has forgotten where it started, up to 1e-5. */
long pendres_noise_settle(const pendres_orbit *orbit);

/*
 * The request's steps a period or, if these are 0, such that the bias of the statistics (a set of
 * bits) is below tolerance times their scale; they are chosen at the request's temperature or,
 * where that is hot, at a lower one. *bias is the one at the request's own temperature; its numbers
 * are NaN if nothing stays on the attractor there. Steps that do not reach the tolerance are taken
 * all the same: the bias tells.
 */
pendres_status pendres_noise_choose_steps(pendres_context *ctx,
                                          const pendres_langevin_request *request,
                                          unsigned statistics, double tolerance,
                                          pendres_langevin_bias *bias);

/* How many parts of `most` trajectories or less so many are followed in, and those of one part: the
 * number of the first, and how many. A part has two or more, if there are two or more in all and
 * `most` is 4 or more. */
size_t pendres_noise_parts(size_t trajectories, size_t most);
size_t pendres_noise_part(size_t trajectories, size_t most, size_t part, size_t *first);

#endif
