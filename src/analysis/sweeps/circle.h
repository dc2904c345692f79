/*
 * circle.h -- the invariant circle of a rotation: the closed curve around the cylinder of states on
 * which the strobe points of a driven pendulum lie that turns over and over.
 *
 * Owns: the curve w = C(y), where w = dy/dtheta, and the map of a drive period on it,
 * y -> y + D(y), both as trigonometric polynomials; finding them, and their errors.
 *
 * Method. The points (y, C(y)) of a grid are run for one period, as one block of lanes, to (Y, W).
 * C is invariant if E = W - C(Y) is zero. To first order a correction c of C obeys
 * c(Y) = l c(y) + E with l = exp(-2 pi gamma/omega) / (dY/dy), since the map shrinks every area by
 * the same factor; no tangents need be integrated. This equation is a contraction, and Newton's
 * method with corrections from it converges quadratically.
 *
 * Source: Calleja, Celletti and de la Llave, Journal of Differential Equations 255 (2013) 978, for
 * the factor; here the circle is a graph, whether the motion on it is locked to the drive or not.
 */
#ifndef PENDRES_CIRCLE_H
#define PENDRES_CIRCLE_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

enum { PENDRES_CIRCLE_LEAST = 32, PENDRES_CIRCLE_MOST = 512 };

/* A trigonometric polynomial of an angle y, c[0] + sum of c[2k - 1] cos ky + c[2k] sin ky, that
   goes through n values at the angles 2 pi i/n. */
typedef struct pendres_trigonometric {
  size_t n; /* a power of two, PENDRES_CIRCLE_MOST at most; c[n - 1] is 0 */
  double c[PENDRES_CIRCLE_MOST];
} pendres_trigonometric;

/* Its value at an angle; *slope receives the derivative there. */
double pendres_trigonometric_at(const pendres_trigonometric *t, double y, double *slope);
/* Its values or derivatives, of order 1 or 2, at angles 2 pi i/cells; cells, a power of two, are n
   at least. */
void pendres_trigonometric_spread(const pendres_trigonometric *t, int order, size_t cells,
                                  double *out);
/* An upper bound on its modulus. */
double pendres_trigonometric_size(const pendres_trigonometric *t);
/* Reduce n as far as the coefficients that are left out are below the tolerance. */
void pendres_trigonometric_trim(pendres_trigonometric *t, double tolerance);

typedef struct pendres_circle {
  pendres_trigonometric w;    /* C: dy/dtheta as a function of the angle y of coordinates.h */
  pendres_trigonometric move; /* D: by how much a period moves the angle */
  double error; /* bound on the error of D, without that of the integration */
} pendres_circle;

/* How a circle is computed. */
typedef struct pendres_circle_way {
  pendres_pendulum pendulum;
  int steps;        /* a period */
  double tolerance; /* below which the last coefficients must be */
  double residual;  /* below which E must be */
} pendres_circle_way;

/*
 * The circle near a guess: with as many points as the guess at first, then with more until its
 * coefficients have fallen to the tolerance. *found is 0 if there is no circle that smooth: it is
 * about to break up, or is not a graph over y. Other failures are those of the integration.
 */
pendres_status pendres_circle_refine(pendres_context *ctx, const pendres_circle_way *way,
                                     const pendres_trigonometric *guess, pendres_circle *out,
                                     int *found);

/* A guess of the circle from the motion of a pendulum that is on it, at the state (x, v). */
pendres_status pendres_circle_guess(pendres_context *ctx, const pendres_circle_way *way, double x,
                                    double v, pendres_trigonometric *out, int *found);

#endif
