/*
 * circle.h -- the invariant circle of a rotation: the closed curve around the cylinder of states
 * which the strobe points of a pendulum fill, or lie on, that is driven and turns over and over.
 *
 * Owns: the curve w = C(y), dy/dtheta over the angle, and what a drive period does on it, y -> y +
 * D(y), as trigonometric polynomials; finding them, and how exact they are.
 *
 * Method. The points (y, C(y)) of a grid are run for one period, as one block of lanes, to (Y, W).
 * C is invariant where W - C(Y) = E is zero. A correction c of C obeys, to first order, c(Y) = l
 * c(y) + E with l = exp(-2 pi gamma/omega) / (dY/dy), since the map shrinks every area by the same
 * factor: no tangents are integrated. Newton's method with corrections from this equation, which is
 * a contraction, converges quadratically.
 *
 * Source: Calleja, Celletti and de la Llave, Journal of Differential Equations 255 (2013) 978, for
 * the factor; here the circle is a graph, whether the motion on it is locked to the drive or not.
 */
#ifndef PENDRES_CIRCLE_H
#define PENDRES_CIRCLE_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

enum { PENDRES_CIRCLE_LEAST = 32, PENDRES_CIRCLE_MOST = 512 };

/* A trigonometric polynomial of an angle y: c[0] + sum of c[2k - 1] cos ky + c[2k] sin ky, and of n
   values at 2 pi i/n. */
typedef struct pendres_trigonometric {
  size_t n; /* a power of two, PENDRES_CIRCLE_MOST at most; c[n - 1] is 0 */
  double c[PENDRES_CIRCLE_MOST];
} pendres_trigonometric;

/* Through values at n angles 2 pi i/n. */
void pendres_trigonometric_fit(size_t n, const double *value, pendres_trigonometric *out);
/* At an angle; *slope becomes the derivative there. */
double pendres_trigonometric_at(const pendres_trigonometric *t, double y, double *slope);
/* No less than its largest value. */
double pendres_trigonometric_size(const pendres_trigonometric *t);
/* The largest of the last eighth of its coefficients: what is missing is about as large. */
double pendres_trigonometric_tail(const pendres_trigonometric *t);
/* As few coefficients as will do: those left out are below the tolerance. */
void pendres_trigonometric_trim(pendres_trigonometric *t, double tolerance);

typedef struct pendres_circle {
  pendres_trigonometric w;    /* C: dy/dtheta over the angle y of passage.h */
  pendres_trigonometric move; /* D: by how much a period moves the angle */
  double error; /* bound for that of D, but for what the integration is off by */
} pendres_circle;

/* How a circle is computed. */
typedef struct pendres_circle_way {
  pendres_pendulum pendulum;
  int steps;        /* a period */
  double tolerance; /* to which coefficients fall */
  double residual;  /* what E may be */
} pendres_circle_way;

/*
 * The circle next to a guess, with as many points as that at first, and more until its coefficients
 * have fallen to the tolerance. Found is 0 where there is no circle of that smoothness: it is about
 * to break up, or is no graph. A failure is one of the integration.
 */
pendres_status pendres_circle_refine(pendres_context *ctx, const pendres_circle_way *way,
                                     const pendres_trigonometric *guess, pendres_circle *out,
                                     int *found);

/* A guess from a pendulum's own motion, in which it is on the circle at a state (x, v). */
pendres_status pendres_circle_guess(pendres_context *ctx, const pendres_circle_way *way, double x,
                                    double v, pendres_trigonometric *out, int *found);

#endif
