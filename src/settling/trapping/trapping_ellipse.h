/*
 * trapping_ellipse.h -- trapping ellipses around Poincaré points of attracting orbits, inside which
 * all states settle on the orbit.
 *
 * Owns: the metric of an orbit, the largest ellipse found to lie in its basin (trapping.c), and how
 * far inside it a state is. It is checked by rings of pendulums on its edge, and not proved (see
 * attractor.h for the argument).
 *
 * Metric: P - M' P M = I with M the derivative of the q-th iterate of the map at the point, so
 * that the linear map contracts in it. Close to a fold it is that of components along the unit
 * eigenvectors of M instead. Scaled so that the unit ellipse's longest semi-axis is 1.
 *
 * Around an orbit of weak damping a larger region is known as well, bounded by a level line of a
 * polynomial (trapping_level.c); the ellipse lies inside it.
 */
#ifndef PENDRES_TRAPPING_ELLIPSE_H
#define PENDRES_TRAPPING_ELLIPSE_H

#include <math.h>

#include <pendres/context.h>
#include <pendres/orbit.h>

#include "base/angles.h"

/* Terms of the third to the sixth degree in two coordinates. */
enum { PENDRES_TRAPPING_DEGREE = 6, PENDRES_TRAPPING_TERMS = 22 };

typedef struct pendres_trapping_ellipse {
  double y, w;      /* centre: a Poincaré point of the orbit; y as in orbit.h, mean in well 0 */
  double metric[3]; /* P_yy, P_yw, P_ww */
  double radius;    /* 0: no ellipse was found */
  double reach;     /* distance in the metric within which the larger region lies; 0: none */
  double turn;      /* of the coordinate: model.h */
  double room;      /* for the error of what is inside, in the metric */
  double unit;      /* of length, of the polynomial in the metric */
  double level;     /* its value on the region's edge */
  double term[PENDRES_TRAPPING_TERMS];
  double error;     /* of the place of the Poincaré point, in x and v */
  int period;       /* of the orbit */
  int winding;
} pendres_trapping_ellipse;

/* (z - centre)' P (z - centre), the angle taken modulo whole turns. */
static inline double pendres_trapping_norm2(const pendres_trapping_ellipse *t, double y, double w)
{
  const double dy = pendres_less_turns(y - t->y, t->turn), dw = w - t->w;
  return t->metric[0] * dy * dy + 2.0 * t->metric[1] * dy * dw + t->metric[2] * dw * dw;
}

/* The Cholesky factor L of the metric, P = L L': L_yy, L_wy, L_ww. */
static inline void pendres_trapping_factor(const pendres_trapping_ellipse *t, double l[3])
{
  l[0] = sqrt(t->metric[0]);
  l[1] = t->metric[1] / l[0];
  l[2] = sqrt(t->metric[2] - l[1] * l[1]);
}

/* The coordinates L' (z - centre) of a state, in which the metric is that of Euclid. */
static inline void pendres_trapping_coordinates(const pendres_trapping_ellipse *t, double y,
                                                double w, double out[2])
{
  double l[3];
  pendres_trapping_factor(t, l);
  const double dy = pendres_less_turns(y - t->y, t->turn), dw = w - t->w;
  out[0] = l[0] * dy + l[1] * dw;
  out[1] = l[2] * dw;
}

/* The state that has such coordinates; l: the factor. */
static inline void pendres_trapping_state(const pendres_trapping_ellipse *t, const double l[3],
                                          double p, double q, double *y, double *w)
{
  const double dw = q / l[2];
  *y = t->y + (p - l[1] * dw) / l[0];
  *w = t->w + dw;
}

/* The polynomial of the larger region. */
double pendres_trapping_polynomial(const pendres_trapping_ellipse *t, double y, double w);

/* Whether a state is in the ellipse, or in the larger region about it. */
static inline int pendres_trapping_holds(const pendres_trapping_ellipse *t, double y, double w)
{
  const double norm2 = pendres_trapping_norm2(t, y, w);
  if (norm2 <= t->radius * t->radius) return 1;
  return norm2 < t->reach * t->reach && pendres_trapping_polynomial(t, y, w) <= t->level;
}

/* Whether a stable orbit attracts slowly and from all directions alike: its metric is the one that
   the map shrinks evenly. */
int pendres_trapping_is_weak(const pendres_orbit *o);

/* How hard to look for large ellipses. */
typedef enum pendres_trapping_effort {
  PENDRES_TRAPPING_FEW = 0, /* for ensembles of hundreds: the radius within a factor of 1.4 */
  PENDRES_TRAPPING_MANY = 1 /* for grids of millions: within a tenth */
} pendres_trapping_effort;

/*
 * Find the ellipses of n orbits, one at each Poincaré point: an orbit of period q comes as q
 * entries, each refined at its own point.
 */
pendres_status pendres_trapping_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     pendres_trapping_effort effort,
                                     pendres_trapping_ellipse *ellipses);

/* Give regions to those of n orbits that are weakly damped and whose ellipse has been found, where
   the region is larger than that. Metric, radius and room are then those of the largest ellipse
   inside the region. */
pendres_status pendres_trapping_levels_find(pendres_context *ctx, size_t n,
                                            const pendres_orbit *orbits,
                                            pendres_trapping_ellipse *ellipses);

#endif
