/*
 * coordinates.h -- the one way for a pendulum into lanes, and out of them again.
 *
 * Owns: the representation of a state inside the engine; the removal of whole turns and their
 * restoration, always in the same order.
 *
 * Outside, a state is (x, v) as in pendulum.h. Inside it is (y, w): y = x - pi/2 is the angle, kept
 * within half a turn of zero while whole turns are counted apart (y = x where the coordinate has no
 * period), and w = dy/dtheta = v/omega.
 */
#ifndef PENDRES_COORDINATES_H
#define PENDRES_COORDINATES_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

typedef struct pendres_coordinates {
  double y, w;
  long turns;
} pendres_coordinates;

/* Why double precision cannot follow a pendulum from a state, a static sentence; NULL if it can. */
const char *pendres_coordinates_refuses(const pendres_pendulum *p, double x, double v);

/* In, with whole turns taken out: -pi <= y <= pi. y is NaN beyond 1e15, where an angle is not
   known to a tenth of a radian. */
pendres_coordinates pendres_coordinates_in(const pendres_pendulum *p, double x, double v);

/* In, with all turns left in y: for orbits, which stay together as one curve. */
pendres_coordinates pendres_coordinates_in_whole(const pendres_pendulum *p, double x, double v);

/* Out; v may be NULL. */
void pendres_coordinates_out(const pendres_pendulum *p, const pendres_coordinates *s, double *x,
                             double *v);

/* Take whole turns out of an angle: -pi <= y <= pi afterwards, or NaN where it is beyond 1e15. A
   coordinate without a period has none. */
void pendres_coordinates_wrap(const pendres_pendulum *p, double *y, long *turns);

/*
 * A state at the end of a period: whole turns are taken out. The motion of a damped pendulum
 * without a drive decays to denormal numbers and stays there, with steps that take forty times as
 * long: below 1e-290 it is set to zero.
 */
void pendres_coordinates_arrive(const pendres_pendulum *p, double *y, double *w, long *turns);

#endif
