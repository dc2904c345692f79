/*
 * trapping_ellipse.h -- an ellipse around a Poincaré point, inside which all states settle on the
 * orbit, and how far inside it a state is.
 *
 * Metric: P - M' P M = I with M the derivative of the q-th iterate of the map at the point, so
 * that the linear map contracts in it. Close to a fold it is that of components along the unit
 * eigenvectors of M instead. Scaled so that the unit ellipse's longest semi-axis is 1.
 */
#ifndef PENDRES_TRAPPING_ELLIPSE_H
#define PENDRES_TRAPPING_ELLIPSE_H

#include "base/angles.h"

typedef struct pendres_trapping_ellipse {
  double y, w;      /* centre: a Poincaré point of the orbit; y as in orbit.h, mean in well 0 */
  double metric[3]; /* P_yy, P_yw, P_ww */
  double radius;    /* 0: no ellipse was found */
  int period;       /* of the orbit */
  int winding;
  double turn;      /* of the coordinate: model.h */
} pendres_trapping_ellipse;

/* (z - centre)' P (z - centre), the angle taken modulo whole turns. */
static inline double pendres_trapping_norm2(const pendres_trapping_ellipse *t, double y, double w)
{
  const double dy = pendres_less_turns(y - t->y, t->turn), dw = w - t->w;
  return t->metric[0] * dy * dy + 2.0 * t->metric[1] * dy * dw + t->metric[2] * dw * dw;
}

/* The radius is less by this share than that of the largest ring that came home, which leaves room
   for the error of a pendulum that is inside. */
static const double pendres_trapping_margin = 0.05;

#endif
