/*
 * langevin_window.h -- how the caller's functions see trajectories that are behind the door.
 */
#ifndef PENDRES_LANGEVIN_WINDOW_H
#define PENDRES_LANGEVIN_WINDOW_H

#include <pendres/langevin.h>

#include "engine/door.h"

/* Between a function of the caller's and the trajectories of a stretch. */
typedef struct pendres_noise_window {
  pendres_door *door;
  const pendres_langevin_observer *observer;
  const pendres_langevin_request *request;
  pendres_langevin_observer through;
  double *memory; /* the door's */
  size_t room;
} pendres_noise_window;

/* The observer of a stretch, for one of all trajectories in the caller's units; NULL for NULL. */
const pendres_langevin_observer *pendres_noise_observer(pendres_door *d,
                                                        const pendres_langevin_observer *observer,
                                                        pendres_noise_window *window);

/* A request behind the door, in *inside, whose function `leave` is called in the caller's units. */
const pendres_langevin_request *pendres_noise_request(pendres_door *d,
                                                      const pendres_langevin_request *request,
                                                      pendres_noise_window *window,
                                                      pendres_langevin_request *inside);

#endif
