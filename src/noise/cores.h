/*
 * cores.h -- what counts as having arrived at an attractor, for a noisy trajectory.
 *
 * Owns: the ellipses around strobe points by which trajectories are told apart. Inside one, noise
 * has let go of where a trajectory came from: it is as wide as the cloud of linear noise theory,
 * and where the basin of attraction does not hold twice that, half as wide as the basin allows.
 */
#ifndef PENDRES_CORES_H
#define PENDRES_CORES_H

#include <limits.h>

#include <pendres/attractor.h>
#include <pendres/switching.h>

/* A running trajectory has no well. */
#define PENDRES_NO_WELL LONG_MIN

/* Positions beyond this are in no core: double precision does not know where in a turn. */
#define PENDRES_CORES_FARTHEST 1e15

/* The core of an attractor. */
typedef struct pendres_core {
  int attractor;
  int running;
  double x, v;
  double turn;       /* the period of the coordinate, which leads to the next well */
  double xx, xv, vv; /* P: inside, (z - z0)' P (z - z0) <= 1 with z = (x, v) */
} pendres_core;

/* Those of a set; an attractor that has none, as a chaotic one, is left out. `home` is whose
   trajectories pendres_cores_leave() looks at. */
typedef struct pendres_cores {
  size_t count;
  pendres_core core[PENDRES_SWITCHING_STATES];
  int home;
} pendres_cores;

/*
 * Make the cores of a set at a temperature. `size` is theirs in units of what follows from noise
 * and basins, up to 2; 0 is 1. Without noise, or where there is no linear theory, they are half
 * of the trapping ellipses.
 */
pendres_status pendres_cores_make(pendres_context *ctx, const pendres_attractors *set,
                                  double temperature, double size, pendres_cores *out);

/* The core that holds a state, and the well that it is in; NULL if no core does. */
const pendres_core *pendres_cores_locate(const pendres_cores *c, double x, double v, long *well);

/* The function `leave` of a pendres_langevin_request whose `arg` is a pendres_cores: it marks
   trajectories that have come into the core of another attractor than `home`, or of another well
   than number 0. */
void pendres_cores_leave(void *cores, const pendres_langevin_strobe *strobe, unsigned char *left);

#endif
