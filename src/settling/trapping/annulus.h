/*
 * annulus.h -- the ring of states around a rotation that closes after no drive period.
 *
 * A pendulum that rotates without a lock to its drive comes in the strobe map to a curve w = c(y)
 * that goes once around the cylinder of states. States between two curves on either side of it, an
 * annulus, settle on it: the map is a homeomorphism of the cylinder, so that the image of an
 * annulus is the annulus between the images of its edges, and where these lie in one that is known
 * already, all of it goes there. As with trapping ellipses (attractor.h) edges
 * are sampled, and what lies between two samples is estimated by second differences: checked, not
 * proved.
 *
 * Owns: curve and edges. They are found in annulus_find.c.
 */
#ifndef PENDRES_ANNULUS_H
#define PENDRES_ANNULUS_H

#include <stddef.h>

enum { PENDRES_ANNULUS_NODES = 256 };

typedef struct pendres_annulus {
  int attractor; /* its number in the set of attractors */
  /* At y = -pi + 2 pi k / NODES: the curve and its derivative, between them a cubic. */
  double centre[PENDRES_ANNULUS_NODES], slope[PENDRES_ANNULUS_NODES];
  double below, above; /* how far below and above it the edges are */
} pendres_annulus;

/* The curve at an angle, and its derivative. */
double pendres_annulus_centre(const pendres_annulus *a, double y, double *slope);

/* The distance in w of a state from the nearer edge; negative outside. *slope receives that of the
   curve there. */
double pendres_annulus_room(const pendres_annulus *a, double y, double w, double *slope);

#endif
