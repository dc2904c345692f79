/*
 * scene_noise.h -- what scenes with noise share.
 *
 * Owns: steps a period, settling times, the ids of trajectories, and which of them make a task.
 */
#ifndef SCENE_NOISE_H
#define SCENE_NOISE_H

#include "scenes/scene.h"

enum {
  SCENE_NOISE_CHUNK = 192,  /* trajectories a task */
  SCENE_NOISE_IDS = 1 << 20 /* ids between those of one pendulum and attractor and others */
};

/* The first id of trajectories of a pendulum that start on attractor number `attractor`. Ids follow
   from parameters, so that results do not depend on what else a deck asks for. */
uint64_t scene_noise_first_id(const pendres_pendulum *p, size_t attractor);

/* Drive periods until a cloud around the orbit has forgotten where it started, up to 1e-5. */
long scene_noise_settle(const pendres_orbit *orbit);

/*
 * Steps a period such that the bias of the statistics (a set of bits) is below tolerance times
 * their scale; chosen at the request's temperature or, where that is hot, at a lower one. *bias is
 * the one at the request's own temperature; NaN if nothing stays on the attractor there.
 */
pendres_status scene_noise_choose_steps(pendres_context *ctx,
                                        const pendres_langevin_request *request,
                                        unsigned statistics, double tolerance,
                                        pendres_langevin_bias *bias);

/* How many tasks so many trajectories make, and those of one of them: first and count. Each has
   two trajectories or more if there are two or more. */
size_t scene_noise_chunks(size_t trajectories);
void scene_noise_chunk(size_t trajectories, size_t chunk, size_t *first, size_t *count);

/* Covariance of the errors of two statistics of a cloud's first harmonic: cosine and sine. */
double scene_noise_harmonic_covariance(const pendres_langevin_cloud *cloud);

#endif
