/*
 * cores.h -- the cores of attractors: a noisy trajectory has arrived when it is inside one.
 *
 * Owns: the ellipses around strobe points by which the states of trajectories are distinguished. A
 * trajectory inside one no longer depends on where it came from: the ellipse is as wide as the
 * cloud of linear noise theory or, where the basin of attraction does not hold twice that, half as
 * wide as the basin allows.
 */
#ifndef PENDRES_CORES_H
#define PENDRES_CORES_H

#include <limits.h>

#include <pendres/attractor.h>
#include <pendres/switching.h>

/* A running trajectory has no well. */
#define PENDRES_NO_WELL LONG_MIN

/* The core of an attractor. */
typedef struct pendres_core {
  int attractor;
  int running;
  double x, v;
  double turn;       /* the period of the coordinate, which leads to the next well */
  double xx, xv, vv; /* P: inside, (z - z0)' P (z - z0) <= 1 with z = (x, v) */
} pendres_core;

/* The cores of a set; an attractor that has none, such as a chaotic one, is left out. `home` is the
   attractor from which pendres_cores_leave() counts departures. */
typedef struct pendres_cores {
  size_t count;
  pendres_core core[PENDRES_SWITCHING_STATES];
  int home;
} pendres_cores;

/*
 * Make the cores of a set at a temperature. `size` is their size relative to the one that follows
 * from noise and basins, up to 2; 0 stands for 1. Without noise, or where there is no linear
 * theory, they are the trapping ellipses reduced to half their size.
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
