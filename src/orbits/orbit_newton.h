/*
 * orbit_newton.h -- Newton's method on the stroboscopic map, many guesses side by side.
 *
 * Owns: one integration of a group of candidates over their period with the
 * variational equation, sampled or not, and the iteration.
 */
#ifndef PENDRES_ORBIT_NEWTON_H
#define PENDRES_ORBIT_NEWTON_H

#include <pendres/orbit.h>

typedef enum pendres_newton_state {
  PENDRES_NEWTON_ACTIVE,
  PENDRES_NEWTON_CONVERGED,
  PENDRES_NEWTON_FAILED
} pendres_newton_state;

typedef struct pendres_newton_candidate {
  const pendres_orbit_guess *guess;
  size_t index;       /* in the caller's list */
  double y, w;        /* the point integrated from */
  int steps;
  pendres_newton_state state;
  int iterations;
  double last_step;   /* in y and v */
  /* What the latest pass found: */
  size_t lane;
  double residual[2]; /* map(z) - z - 2 pi p */
  double m[2][2];     /* derivative of the map by (y, w) */
  double by_omega[2]; /* derivative of the map by omega */
  double m_by[2][2][2]; /* derivatives of m by y and by w, from a pass that was asked for them */
} pendres_newton_candidate;

/* Samples 0 .. samples-1 of a pass, all lanes. */
typedef struct pendres_newton_samples {
  int bends; /* set by the caller: find m_by as well, from two more lanes a candidate */
  int none;  /* set by the caller: take no samples */
  size_t count, lanes, rows, size;
  double *data; /* [sample][lane][row] */
} pendres_newton_samples;

static inline const double *pendres_newton_sample(const pendres_newton_samples *t, size_t sample,
                                                  size_t lane)
{
  return t->data + (sample * t->lanes + lane) * t->rows;
}

/* NULL, or what is wrong with an orbit that a caller has passed: a static sentence. */
const char *pendres_orbit_refuses(const pendres_orbit *o);

void pendres_newton_samples_free(pendres_newton_samples *taken);

/*
 * Integrate the first *count of n candidates once over their period: up to the first one whose
 * steps or period differ, the end, or the block's capacity. `taken` may be NULL. The results of
 * candidates that have failed are not valid.
 */
pendres_status pendres_newton_pass(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                   pendres_orbit_want want, pendres_newton_samples *taken,
                                   size_t *count);

/* How many of n candidates each thread is to be given: all of them, unless they take long. */
size_t pendres_newton_each(const pendres_context *ctx, size_t n,
                           const pendres_newton_candidate *c);

/* Put candidates that may share a block side by side; those still active come first. */
void pendres_newton_order(size_t n, pendres_newton_candidate *c);

/* Iterate all active candidates; c is reordered. Each ends converged or failed. */
pendres_status pendres_newton_converge(pendres_context *ctx, size_t n,
                                       pendres_newton_candidate *c);

/* (I - M) z = r; 0 if singular. *stretch (may be NULL) bounds how much errors of r grow. */
int pendres_newton_solve(const double m[2][2], const double r[2], double z[2], double *stretch);

/* The length of (I - M)^-1 u, where u is of length 1 in the direction of M's larger column: that of
   errors that have grown most over the orbit. */
double pendres_newton_share(const double m[2][2]);

/*
 * The samples taken of a candidate, moved by the linearised flow to the orbit that closes:
 * by *shift at its start. y and w have as many places as there are samples. 0 if singular.
 */
int pendres_newton_closed(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                          double *y, double *w, double shift[2]);

/*
 * The effect of random rounding errors of the steps, of one unit each, on the closed orbit: on its
 * starting point, and along it as a root mean square. An error may grow a thousandfold on the way
 * and still have decayed at the end of a period: with strong friction a pendulum stays long near
 * the upright position, where errors grow, and is damped the more elsewhere.
 */
typedef struct pendres_newton_noise {
  double start, along;
  double swell; /* how much larger errors are along the orbit than where it starts; at least 1 */
} pendres_newton_noise;

/* The unit: the rounding error of one step for an angle of order one. It is smaller on periodic
   orbits than for arbitrary trajectories (strobe_noise.h). */
double pendres_newton_rounding(pendres_table table);

/* For a candidate whose samples were taken with their tangents; without samples that of errors that
   do not grow on the way. */
pendres_newton_noise pendres_newton_noise_of(const pendres_newton_candidate *c,
                                             const pendres_newton_samples *taken);

#endif
