/*
 * trap_ring.h -- rings of pendulums on the edge of an ellipse, and what lies between their points.
 *
 * Owns: running a ring, whether its points come home side by side, and whether the arcs between
 * neighbours do. The image of an arc is taken for the cubic (Hermite) curve through the images of
 * its ends with the tangents there, which come from second points an eighth of an arc further on.
 * (The derivative that carries variances along is of second order, too coarse with the few steps of
 * rings.) A cubic departs from its chord by no more than a quarter of the larger of the differences
 * of its two tangents from the chord. A quarter of their sum is allowed for: where they are equal,
 * that leaves as much again for the departure of the image from the cubic. An arc is home where
 * chord and departure are inside the ellipse that is known already; one that is not gets a point in
 * its middle, and so on while the ring's share of points lasts.
 */
#ifndef PENDRES_TRAP_RING_H
#define PENDRES_TRAP_RING_H

#include "engine/strobe_run.h"
#include "orbits/trap_ellipse.h"

enum {
  PENDRES_TRAP_LOOKS = 24, /* a point is home after at most so many q-th iterates of the map */
  /* A point is followed for so many more: neighbours that come home one after the other are then
     seen there together, and so is the arc between them. */
  PENDRES_TRAP_AFTER = 1
};

typedef struct pendres_trap_ring {
  const pendres_trap *trap;
  const pendres_pendulum *pendulum;
  double radius;
  double home;   /* points are home within this radius; 0: a base ring, run for `looks` iterates */
  double room;   /* radius of the ellipse that is known already, which arcs must be inside of */
  double margin; /* errors must be small against this: what a base ring contracts by, or the
                    radius */
  int points, looks, steps;
  int more;      /* points put between the first ones so far */
  int failed;    /* a point has left: the others need not go on */
  size_t first;  /* its first point */
} pendres_trap_ring;

/* A point of a ring, where it has been at each look, and the derivatives of that by the angle. */
typedef struct pendres_trap_point {
  pendres_trap_ring *of;
  double angle;
  int looks, home; /* looks taken; the one at which it was home, 0: none yet */
  double y[PENDRES_TRAP_LOOKS + PENDRES_TRAP_AFTER + 1];
  double w[PENDRES_TRAP_LOOKS + PENDRES_TRAP_AFTER + 1];
  double ty[PENDRES_TRAP_LOOKS + PENDRES_TRAP_AFTER + 1];
  double tw[PENDRES_TRAP_LOOKS + PENDRES_TRAP_AFTER + 1];
} pendres_trap_point;

/* Run rings (all points lie in `points`, ring after ring; room for as many lanes). */
pendres_status pendres_trap_rings_run(pendres_context *ctx, size_t n, pendres_trap_ring **rings,
                                      pendres_trap_point *points, pendres_strobe_lane *lanes);

/* Whether all points came home, side by side; `points` are those of the ring. */
int pendres_trap_ring_holds(const pendres_trap_ring *r, const pendres_trap_point *points);

/* How far an arc may depart from its chord, in the metric of t (see above); both tangents times the
   arc's width. */
double pendres_trap_departure(const pendres_trap *t, const double chord[2], const double first[2],
                              const double last[2]);

/* An arc of a ring. */
typedef struct pendres_trap_arc {
  const pendres_trap_point *a, *b;
} pendres_trap_arc;

/* The arcs that are not home, at most as many as the ring has points; their number. */
size_t pendres_trap_ring_open(const pendres_trap_ring *r, const pendres_trap_point *points,
                              pendres_trap_arc *arcs);

/*
 * Put points where the arcs of rings that hold are not home, at most `most` to a ring. A ring whose
 * arcs are not all home then has failed.
 */
pendres_status pendres_trap_rings_close(pendres_context *ctx, size_t n, pendres_trap_ring **rings,
                                        pendres_trap_point *points, int most);

#endif
