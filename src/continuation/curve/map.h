/*
 * map.h -- the map whose fixed points are followed.
 *
 * Owns: evaluating, side by side in lanes, the stroboscopic map with its derivatives by state and
 * parameters, and which other maps its fixed points may be fixed points of.
 *
 * An unknown point is u = (y, w, omega, gamma, F0, I, b, a1, ..., a5), y = x - pi/2 (with a
 * polynomial force x) and w = v/omega at drive phase 0. The map G is
 *
 *   the q-th iterate of the strobe map, less 2 pi p (winding p), or
 *   for an orbit that is its own mirror image, which has an odd q, q half periods followed by the
 *   reflection (y, w) -> (2 c + 2 pi p - y, -w), whose second iterate is the former: c is the
 *   centre of the symmetry.
 *
 * With a parametric drive alone the mirror image of a trajectory is one at the same phase. Orbits
 * that are their own are rest (q = 1), and those of even q that are so q/2 periods later, as of
 * q = 2 with y(t + tau) = 2 pi p - y(t): fixed points of q/2 strobe periods, of rest of one,
 * followed by the reflection. Of rest that map's flip is where pairs of orbits of period 1 are
 * born, and its fold where the strobe map itself has a flip, where orbits of period 2 are born: the
 * boundaries of the tongues of parametric resonance.
 *
 * N = DG has a determinant that is known by Liouville's formula. A fold has det(N - I) = 0, a flip
 * det(N + I) = 0: of the first map a flip is a period doubling, of the second the loss of mirror
 * symmetry. So a symmetric orbit's folds and symmetry breakings, both a Floquet multiplier +1, are
 * told apart by different equations. A cusp is a fold at which det(N - I) is stationary along
 * the null vector of N - I.
 *
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, sections 9.2, 10.1, 10.2;
 * Swift and Wiesenfeld, Physical Review Letters 52 (1984) 705, for the half map.
 */
#ifndef PENDRES_CONTINUATION_MAP_H
#define PENDRES_CONTINUATION_MAP_H

#include <pendres/context.h>
#include <pendres/orbit.h>
#include <pendres/parameter.h>

/* Places in a point: the state, and the parameters that orbits are followed in, by number. */
enum {
  PENDRES_U_Y,
  PENDRES_U_W,
  PENDRES_U_OMEGA, /* number 0 */
  PENDRES_U_GAMMA = PENDRES_U_OMEGA + (int)PENDRES_DAMPING,
  PENDRES_U_DRIVE = PENDRES_U_OMEGA + (int)PENDRES_DRIVE_AMPLITUDE,
  PENDRES_U_TORQUE = PENDRES_U_OMEGA + (int)PENDRES_TORQUE,
  PENDRES_U_MODULATION = PENDRES_U_OMEGA + (int)PENDRES_PARAMETRIC_AMPLITUDE,
  PENDRES_U_POWERS = PENDRES_U_OMEGA + (int)PENDRES_A1, /* and so on */
  PENDRES_U_COUNT = PENDRES_U_OMEGA + PENDRES_PARAMETER_FOLLOWED
};

/* Such a point. */
typedef double pendres_u[PENDRES_U_COUNT];

typedef struct pendres_map {
  pendres_force force;
  int symmetric; /* all pendulums on the way have the mirror symmetry */
  int reflects;  /* or have that of a parametric drive alone, at the same phase */
  enum {
    PENDRES_MIRROR_NONE,
    PENDRES_MIRROR_HALF, /* q half periods and the reflection; q is odd */
    PENDRES_MIRROR_WHOLE /* q/2 periods, of rest one, and the reflection; q is even or 1 */
  } mirror;
  int period;    /* q */
  int winding;   /* p */
  double centre; /* c, where there is a mirror symmetry of either kind; otherwise 0 */
  double middle; /* about which orbits are small: c, or the mean of the one that was begun with */
} pendres_map;

/* What one evaluation of the map finds. */
typedef struct pendres_image {
  double f[2];                  /* G(z) - z */
  double j[2][PENDRES_U_COUNT]; /* its derivatives by u; NaN by those that were not asked for */
  double n[2][2];               /* DG */
  double trace, determinant;    /* of DG; the latter from Liouville's formula */
  double in_phase; /* the first harmonic's part with the drive, for PENDRES_CONDITION_LAG alone */
} pendres_image;

/* An equation beside G(z) = z. */
typedef enum pendres_condition {
  PENDRES_CONDITION_NONE,
  PENDRES_CONDITION_FOLD, /* det(N - I) = 0 */
  PENDRES_CONDITION_FLIP, /* det(N + I) = 0 */
  PENDRES_CONDITION_CUSP, /* fold, and its quadratic term is 0 */
  PENDRES_CONDITION_CROSSING, /* two branches cross (crossing.h) */
  PENDRES_CONDITION_LAG, /* the first harmonic of an orbit of period 1 lags behind the drive by a
                            quarter of a turn: it has no part in phase */
  PENDRES_CONDITION_COUNT
} pendres_condition;

enum { PENDRES_UNKNOWNS = 4 /* at most */ };

/* Equations on a map, and what is unknown in them: the first two of `unknown[unknowns]` are y and
   w, the others parameters. */
typedef struct pendres_system {
  pendres_map map;
  int steps; /* a period */
  pendres_condition condition;
  int unknowns, unknown[PENDRES_UNKNOWNS];
  double length; /* that counts as one in the state of what a follower follows; 0: by its ratio
                    (pendres_arc_scale) */
} pendres_system;

pendres_pendulum pendres_map_pendulum(pendres_force force, const pendres_u u);

/* The map that an orbit is a fixed point of, and the point. The first two of `unknown[unknowns]`
   are y and w, the others change along the way: where one of them breaks the mirror symmetry, the
   map of the whole period is meant. */
pendres_map pendres_map_of(const pendres_orbit *orbit, int unknowns, const int *unknown,
                           pendres_u u);

/* Choose the steps a period at a point for an error of about `tolerance` a period; the number is
   even. */
pendres_status pendres_map_steps(pendres_context *ctx, pendres_force force,
                                 const pendres_u u, double tolerance, int *steps);

/* The map at n points of any parameters, all of the given kind, period and steps, with the
   derivatives by the system's unknowns, and by others that cost nothing more. */
pendres_status pendres_map_images(pendres_context *ctx, const pendres_system *system, size_t n,
                                  const pendres_u *u, pendres_image *out);

/* The same without the derivatives by parameters, which become NaN. */
pendres_status pendres_map_states(pendres_context *ctx, const pendres_map *map, int steps, size_t n,
                                  const pendres_u *u, pendres_image *out);

/*
 * The half map: one whose second iterate is `map`, so that its fixed points are those of `map` as
 * well, as where orbits of the latter are born from those of the former. For an odd period it has a
 * reflection; for an even period it is the map of half the period, with a reflection or without.
 * There may be two (which = 0, 1), of which the one that orbits are more often born from comes
 * first. 0 if there is none.
 */
enum { PENDRES_MAP_HALVES = 2 };
int pendres_map_half(const pendres_map *map, int which, pendres_map *half);

/* The map over all of an orbit's period: the one whose flip is a period doubling. */
void pendres_map_unfold(pendres_map *map);

/* By what vector (y, w) a point misses being a fixed point of such a half map, whichever place that
   reflects about, the bottom of a well or the top of a barrier; the winding tells the place. */
typedef struct pendres_map_miss {
  double off[2];
  int winding;
} pendres_map_miss;
pendres_status pendres_map_closes(pendres_context *ctx, const pendres_map *half, int steps,
                                  size_t n, const pendres_u *u, pendres_map_miss *miss);

/* det(N -+ I). */
double pendres_map_fold(const pendres_image *image);
double pendres_map_flip(const pendres_image *image);

/* The length that counts as one in arclength, of entry `i` of u where u is. Of parameters it is a
   constant at first, but never less than a twentieth of the value: beyond twenty of the constant
   they count by their logarithms, and a curve over decades is not a long one. Of the state it is 1,
   at dampings below 0.05 the distance from the middle of the orbits, or the drive if that is more:
   the narrow folds of weak resonances about it are then as long as others. */
double pendres_arc_scale(const pendres_map *map, int i, const pendres_u u);

/* What of it is due to a place far out, from 1 up: a state more than two lengths from the middle
   counts by its ratio to its distance less one. An angle does not, since its force has a period. */
double pendres_arc_large(const pendres_map *map, const pendres_u u);

/* The rate at which motions at u lose their energy, in units in which less than 1 is weak: both
   multipliers of an orbit are then close to 1. */
double pendres_arc_damped(pendres_force force, const pendres_u u);

/* The same half way from a to b. */
double pendres_arc_scale_between(const pendres_map *map, int i, const pendres_u a,
                                 const pendres_u b);

/* The constant. */
double pendres_arc_least_scale(int i);

/* Distance in the scale of arclength. What is the same in both points does not count. */
double pendres_arc_distance(const pendres_map *map, const pendres_u a, const pendres_u b);

/* Norm of DG: by how much the map may enlarge an error of the state. */
double pendres_map_growth(const pendres_image *image);

/* The null vector of N - I at a fold, of unit length; its sign is arbitrary. */
void pendres_map_null(const pendres_image *image, double v[2]);

#endif
