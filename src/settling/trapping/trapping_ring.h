/*
 * trapping_ring.h -- rings of pendulums on the edge of an ellipse, and what lies between their
 * points.
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
#ifndef PENDRES_TRAPPING_RING_H
#define PENDRES_TRAPPING_RING_H

#include "engine/strobe_run.h"
#include "settling/trapping/trapping_ellipse.h"

enum {
  PENDRES_TRAPPING_LOOKS = 24, /* q-th iterates of the map after which a point must be home */
  /* Further iterates for which a point is followed: neighbours that come home one after the other
     are then inside at the same time, and so is the arc between them. */
  PENDRES_TRAPPING_AFTER = 1
};

typedef struct pendres_trapping_ring {
  const pendres_trapping_ellipse *ellipse;
  double factor[3]; /* of the ellipse's metric */
  double radius;
  double home;   /* points are home within this radius; 0: a base ring, run for `looks` iterates */
  double room;   /* radius of the ellipse that is known already, which arcs must be inside of */
  double margin; /* errors must be small against this: what a base ring contracts by, or the
                    radius */
  pendres_strobe_lane lane; /* that its points start with, at their own places */
  int points, looks;
  int more;      /* points put between the first ones so far */
  int failed;    /* a point has left, and the others need not go on; or neighbours have parted, or
                    an arc is not home */
  struct pendres_trapping_point *point; /* [points] */
} pendres_trapping_ring;

/* A point of a ring, and where it has been at each look. */
typedef struct pendres_trapping_point {
  pendres_trapping_ring *of;
  double angle;
  int looks, home; /* looks taken; the one at which it was home, 0: none yet */
  const struct pendres_trapping_point *further; /* from which its tangents are taken */
  double y[PENDRES_TRAPPING_LOOKS + PENDRES_TRAPPING_AFTER + 1];
  double w[PENDRES_TRAPPING_LOOKS + PENDRES_TRAPPING_AFTER + 1];
} pendres_trapping_point;

/* The tolerance of a period: small against a margin, and one of few, so that blocks stay full. */
double pendres_trapping_tolerance(double margin);

/* Run rings (all points lie in `points`, ring after ring; room for as many lanes), and mark those
   that do not hold. */
pendres_status pendres_trapping_rings_run(pendres_context *ctx, size_t n,
                                          pendres_trapping_ring **rings,
                                          pendres_trapping_point *points,
                                          pendres_strobe_lane *lanes);

/* Whether all points came home, side by side. */
int pendres_trapping_ring_holds(const pendres_trapping_ring *r);

/* How far an arc may depart from its chord, in the metric of t (see above); both tangents times the
   arc's width. */
double pendres_trapping_departure(const pendres_trapping_ellipse *t, const double chord[2],
                                  const double first[2], const double last[2]);

/* An arc of a ring. */
typedef struct pendres_trapping_arc {
  const pendres_trapping_point *a, *b;
} pendres_trapping_arc;

/* The arcs that are not home, at most as many as the ring has points; their number. */
size_t pendres_trapping_ring_open(const pendres_trapping_ring *r, pendres_trapping_arc *arcs);

/*
 * Put points where the arcs of rings that hold are not home, at most `most` to a ring. A ring whose
 * arcs are not all home then has failed. points, lanes: room for the rings' points and 2 `most` for
 * each ring.
 */
pendres_status pendres_trapping_rings_close(pendres_context *ctx, size_t n,
                                            pendres_trapping_ring **rings, int most,
                                            pendres_trapping_point *points,
                                            pendres_strobe_lane *lanes);

#endif
