/*
 * linear.h -- oscillators with a linear force, whose motions all decay to one orbit or all grow.
 *
 * Owns: whether they grow without bound, as in the tongues of parametric resonance, how fast, and
 * the orbit that they decay to where they do not.
 */
#ifndef PENDRES_LINEAR_H
#define PENDRES_LINEAR_H

#include <pendres/context.h>
#include <pendres/orbit.h>

typedef struct pendres_linear {
  enum {
    PENDRES_LINEAR_NOT,     /* the force is not linear, or the fate is not known */
    PENDRES_LINEAR_GROWS,   /* for certain, except for motions exactly on the unstable orbit */
    PENDRES_LINEAR_DECAYS,  /* for certain */
    PENDRES_LINEAR_BETWEEN  /* the exponent is zero within its error */
  } fate;
  double exponent, error;   /* the largest Floquet exponent, per unit time */
  pendres_orbit orbit;      /* that motions decay to */
} pendres_linear;

/* Of n pendulums, side by side. */
pendres_status pendres_linear_find(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                   pendres_linear *out);

#endif
