/*
 * path.h -- the path of least action out of a state, as a heteroclinic orbit.
 *
 * Noise of a small temperature T carries a pendulum along paths whose probability is exp(-S/T) with
 * S = (1/(4 gamma)) integral of (x'' + gamma x' + g(x, t))^2 dt, g = f (1 + b cos) - I - F0 cos.
 * The least of them solve Hamilton's equations of H = gamma q^2 + p v - q (gamma v + g):
 *
 *     x' = v    v' = -gamma v - g + 2 gamma q    p' = g_x q    q' = -p + gamma q    S' = gamma q^2
 *
 * (Wentzell and Freidlin). The path leaves the state's orbit, where p = q = 0, in the plane
 * (p, q) = Sigma^-1 (x - x0, v - v0), with Sigma the covariance of linear noise theory at T = 1,
 * and comes to a saddle orbit in a plane that M and what noise adds over a cycle give (ends.c).
 *
 * Owns: the flow of these equations with its derivative, both ends, the minimisation that finds
 * candidates, and the multiple shooting that makes them exact.
 */
#ifndef PENDRES_ESCAPE_PATH_H
#define PENDRES_ESCAPE_PATH_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/orbit.h>

/* What is integrated: positions, velocity, their momenta; then columns of the derivative. */
enum { PATH_X, PATH_V, PATH_P, PATH_Q, PATH_SIZE, PATH_COLUMNS = PATH_SIZE + 1 };

/* A period is divided into pieces, and these into steps. */
typedef struct pendres_way_grid {
  int pieces; /* a drive period */
  int steps;  /* a piece */
} pendres_way_grid;

/* The equations of a pendulum on a grid. */
typedef struct pendres_way_flow {
  pendres_pendulum p;
  pendres_way_grid grid;
  double step;
  double *cosine; /* [piece][step][stage] of the drive */
} pendres_way_flow;

/* The cosines are written into room for pieces x steps x PATH_STAGES. */
enum { PATH_STAGES = 16 };
void pendres_way_flow_make(const pendres_pendulum *p, pendres_way_grid grid, double *cosine,
                            pendres_way_flow *out);

/*
 * Carry z over one piece, whose number counts within a drive period. derivative (by z, row by row)
 * and action, to which the piece's is added, may be NULL.
 */
void pendres_way_piece(const pendres_way_flow *f, int piece, double z[PATH_SIZE],
                        double derivative[PATH_SIZE * PATH_SIZE], double *action);

/* The slope of the equations at a drive phase of that cosine. */
void pendres_way_slope(const pendres_pendulum *p, double cosine, const double z[PATH_SIZE],
                        double slope[PATH_SIZE]);

/* An end of the path: an orbit, its derivative over a cycle and what noise adds, at T = 1. */
typedef struct pendres_way_end {
  double x, v;
  double m[4];     /* row by row */
  double noise[3]; /* xx, xv, vv */
  int cycle;       /* drive periods */
  double grows;    /* of the state: e-folds a drive period in which paths leave it; of the saddle:
                      in which they come to it */
  double plane[3]; /* of the state: Sigma^-1, xx, xv, vv; of the saddle: the left eigenvector of the
                      multiplier outside the unit circle, and -l.(z - z0) for p = l */
} pendres_way_end;

/* The eigenvector of a matrix, row by row, that belongs to a multiplier, of length 1; and the real
   multiplier of larger modulus. */
void pendres_way_direction(const double m[4], double multiplier, double out[2]);
double pendres_way_outside(const double m[4]);

/* From a closed orbit; PENDRES_NOT_FOUND if it is not stable, or not a saddle. */
pendres_status pendres_way_state(const pendres_orbit *orbit, pendres_way_end *out);
pendres_status pendres_way_saddle(const pendres_orbit *orbit, pendres_way_end *out);

/* A path: nodes at the ends of pieces, from the state to the saddle. */
typedef struct pendres_way {
  const pendres_way_flow *flow;
  pendres_way_end from, to;
  int pinned;      /* shifts in time are solutions as well, or nearly so: the middle is kept */
  long periods;    /* of the drive, that it takes */
  double cut;      /* as planned */
  double *z;       /* [periods x pieces + 1][PATH_SIZE] */
  double action;   /* with what both ends leave out */
  double ends;     /* of it, what they do */
  size_t middle;   /* the node that is kept: where the noise is strongest */
  double shift;    /* in time, of where the middle is kept: 0, or a part of a period */
  double slack;    /* the jump of momenta in the middle of a pinned one: dS by a shift in time */
  double residual; /* how far pieces are from meeting, and the planes; NaN before the first step */
} pendres_way;

/* Newton's method: PENDRES_NOT_CONVERGED where it finds no path near z. */
pendres_status pendres_way_polish(pendres_context *ctx, pendres_way *path);

/* Weights of the points around one that give a first and a second derivative, to fourth order. */
enum { PATH_STENCIL = 5 };
void pendres_way_differences(double h, double first[PATH_STENCIL], double second[PATH_STENCIL]);

/*
 * Minimise the action of a path given by positions x[points], `each` a drive period, of which the
 * first and the last three are kept. *action is what is reached, of fourth order in the spacing.
 */
pendres_status pendres_way_relax(pendres_context *ctx, const pendres_pendulum *p, size_t points,
                                  int each, double *x, double *action);

/* How finely and how long. */
typedef struct pendres_way_plan_of {
  pendres_way_grid grid;
  int each;     /* points a drive period of the grid on which candidates are minimised */
  long periods;
  double cut;   /* how close to its ends, relative to their distance, it is cut off there */
} pendres_way_plan_of;

/* For motions up to a reach. PENDRES_TOLERANCE_UNREACHABLE: it takes too long. */
pendres_status pendres_way_plan(const pendres_way_end *from, const pendres_way_end *to,
                                const pendres_pendulum *p, double reach, pendres_way_plan_of *out);

/* Where a path may be near: side 0: between both orbits; +-1: motions from that side of the saddle,
   reversed. They are shifted by a share of a drive period. */
typedef struct pendres_way_guess {
  double side, share;
} pendres_way_guess;

/* Minimise from a guess and polish; *coarse is the minimum on the grid. PENDRES_NOT_FOUND: there
   are no motions from that side to the state. */
pendres_status pendres_way_try(pendres_context *ctx, const pendres_way_guess *guess, int each,
                                pendres_way *path, double *coarse);

/* A search for the least action over one saddle, at its place on the way. */
typedef struct pendres_way_search {
  pendres_context *ctx;
  const pendres_orbit *state;
  pendres_orbit saddle;
  pendres_status (*take)(void *arg, const pendres_way *path); /* sees the path that is found */
  void *arg;
  pendres_way_end from, to; /* of the search itself */
} pendres_way_search;

typedef struct pendres_way_found {
  double action, error;
  double phase;  /* of the error, what another phase of the drive may make */
  size_t middle, paths; /* different paths that were found */
} pendres_way_found;

/* PENDRES_NOT_FOUND: no path, or the state or the saddle is none. */
pendres_status pendres_way_least(pendres_way_search *search, pendres_way_found *out);

#endif
