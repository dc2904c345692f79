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

/* By so much, in y and in w, companions of a candidate start beside it, to find m_by. */
extern const double pendres_newton_aside;

/* Samples 0 .. samples-1 of a pass, all lanes. */
typedef struct pendres_newton_samples {
  int bends; /* set by the caller: find m_by as well, from two more lanes a candidate */
  size_t count, lanes, rows, size;
  double *data; /* [sample][lane][row] */
} pendres_newton_samples;

static inline const double *pendres_newton_sample(const pendres_newton_samples *t, size_t sample,
                                                  size_t lane)
{
  return t->data + (sample * t->lanes + lane) * t->rows;
}

/* NULL, or why a caller's orbit is none that could be followed: a static sentence. */
const char *pendres_orbit_refuses(const pendres_orbit *o);

void pendres_newton_samples_free(pendres_newton_samples *taken);

/*
 * Integrate c[first ..) once over their period, up to the first candidate whose steps or period
 * differ, the end, or the block's capacity; *last is the one after. `taken` may be NULL.
 * Candidates that have failed are carried along and not to be read.
 */
pendres_status pendres_newton_pass(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                   size_t first, pendres_orbit_want want,
                                   pendres_newton_samples *taken, size_t *last);

/* Put candidates that may share a block side by side; those still active come first. */
void pendres_newton_order(size_t n, pendres_newton_candidate *c);

/* Iterate all active candidates; c is reordered. Each ends converged or failed. */
pendres_status pendres_newton_converge(pendres_context *ctx, size_t n,
                                       pendres_newton_candidate *c);

/* (I - M) z = r; 0 if singular. *stretch (may be NULL) bounds how much errors of r grow. */
int pendres_newton_solve(const double m[2][2], const double r[2], double z[2], double *stretch);

/* (I - M)^-1 of what has been multiplied most, of length 1: the direction of M's larger column. */
double pendres_newton_share(const double m[2][2]);

/*
 * The samples taken of a candidate, moved by the linearised flow to the orbit that closes:
 * by *shift at its start. y and w have as many places as there are samples. 0 if singular.
 */
int pendres_newton_closed(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                          double *y, double *w, double shift[2]);

/*
 * What rounding errors of the steps, one unit each and at random, make of the orbit that closes:
 * where it starts, and all along it, root mean square. An orbit may lose what it is off by over a
 * period, and have multiplied it a thousandfold on the way: strong friction keeps a pendulum for
 * long beside the top, where errors grow, and damps the more elsewhere.
 */
typedef struct pendres_newton_noise {
  double start, along;
  double swell; /* how much larger errors are along the orbit than where it starts; at least 1 */
} pendres_newton_noise;

/* The unit: what rounding in one step leaves of an angle of order one. Periodic orbits keep below
   what the worst of pendulums round. */
double pendres_newton_rounding(pendres_table table);
/* So many of these units it leaves, relatively, of a derivative of the map, as measured: sums of
   more terms, and twice as many roundings. */
extern const double pendres_newton_matrix;

/* Of a candidate whose samples were taken with their tangents. */
pendres_newton_noise pendres_newton_noise_of(const pendres_newton_candidate *c,
                                             const pendres_newton_samples *taken);

#endif
