/*
 * trap_ellipse.h -- the ellipse around a Poincaré point that is a trap, and how far inside a state
 * is.
 *
 * Metric: P - M' P M = I with M the derivative of the q-th iterate of the map at the point, so
 * that the linear map contracts in it; or, close to a fold, the distance along M's eigenvectors.
 * Scaled so that the unit ellipse's longest semi-axis is 1.
 */
#ifndef PENDRES_TRAP_ELLIPSE_H
#define PENDRES_TRAP_ELLIPSE_H

#include <math.h>

typedef struct pendres_trap {
  double y, w;      /* centre: a Poincaré point of the orbit; y as in orbit.h, mean in well 0 */
  double metric[3]; /* P_yy, P_yw, P_ww */
  double radius;    /* 0: none could be shown */
  int period;       /* of the orbit */
  int winding;
  double turn;      /* of the coordinate: model.h */
} pendres_trap;

/* (z - centre)' P (z - centre), the angle taken modulo whole turns. */
static inline double pendres_trap_norm2(const pendres_trap *t, double y, double w)
{
  double dy = y - t->y;
  const double dw = w - t->w;
  dy -= t->turn * rint(dy / t->turn);
  return t->metric[0] * dy * dy + 2.0 * t->metric[1] * dy * dw + t->metric[2] * dw * dw;
}

/* The radius is that of the largest ring shown to lie in the basin, less this share of it: so much
   room is left for the error of a pendulum that is inside. */
static const double pendres_trap_margin = 0.05;

#endif
