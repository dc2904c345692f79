/*
 * model.h -- the properties of a pendulum that follow from its force.
 *
 * y = x - origin is the angle that the engine works with: from the bottom of the well of a plain
 * pendulum, x itself of a polynomial.
 */
#ifndef PENDRES_MODEL_H
#define PENDRES_MODEL_H

#include <pendres/pendulum.h>

/* Which terms a pendulum has, and so which kernels it needs. */
typedef enum pendres_model_terms {
  PENDRES_MODEL_PLAIN,     /* the pendulum without torque or parametric drive */
  PENDRES_MODEL_PENDULUM,  /* with one of them */
  PENDRES_MODEL_POLYNOMIAL, /* a polynomial force, with or without */
#define PENDRES_MODEL_CODE(code, name) PENDRES_MODEL_##code, /* another force, likewise */
  PENDRES_FORCE_LIST(PENDRES_MODEL_CODE)
#undef PENDRES_MODEL_CODE
  PENDRES_MODEL_COUNT,
  PENDRES_MODEL_FORMULA = PENDRES_FORCE_FORMULA /* from here on: formulas, by their number */
} pendres_model_terms;

/* The place of kernels in a list of them: all formulas have the same, the last. */
static inline int pendres_model_kernel(pendres_model_terms terms)
{
  return terms >= PENDRES_MODEL_FORMULA ? (int)PENDRES_MODEL_COUNT : (int)terms;
}

/* The force of terms beyond PENDRES_MODEL_POLYNOMIAL: both follow the same list. */
#define PENDRES_MODEL_FORCE(terms) \
  ((pendres_force)((int)(terms) - (int)PENDRES_MODEL_POLYNOMIAL + (int)PENDRES_FORCE_POLYNOMIAL))

pendres_model_terms pendres_model_kind(const pendres_pendulum *p);

/* NULL, or what is wrong with the parameters that only some pendulums have: a static sentence. */
const char *pendres_model_check(const pendres_pendulum *p);

/* f at y, without parametric drive, and its derivative. */
void pendres_model_force(const pendres_pendulum *p, double y, double *force, double *slope);

/* f's second derivative, of another force but pendulum and polynomial by differences: to 1e-8. */
double pendres_model_bend(const pendres_pendulum *p, double y);

/*
 * The period of the coordinate: y and y + turn are the same. Where it has none this is so large
 * that y - turn rint(y / turn) is always y.
 */
double pendres_model_turn(const pendres_pendulum *p);

/*
 * The centre c of the mirror symmetry y -> 2 c - y with a shift of half a drive period; if there
 * are several, the one nearest to `near`; if `near` is NaN, nearest to 0. For the pendulum the
 * bottom is a centre, and so are the points whole and half turns away. NaN if p has no such
 * symmetry.
 */
double pendres_model_centre(const pendres_pendulum *p, double near);

/* The origin of y. */
double pendres_model_origin(const pendres_pendulum *p);

/* The time, in drive periods, in which a small oscillation decays to 1/e. */
double pendres_model_settling(const pendres_pendulum *p);

/* Upper bounds by which steps are chosen: of the energy needed to come from y = 0 to `reach` on
   either side, and of the spring's stiffness on the way. */
double pendres_model_climb(const pendres_pendulum *p, double reach);
double pendres_model_stiffest(const pendres_pendulum *p, double reach);

/* The length scale of the force: half the distance between the barriers, divided by pi; for a
   polynomial the largest length at which two of its terms are equal, 1 if it has only one term; for
   other forces 1. */
double pendres_model_scale(const pendres_pendulum *p);

/*
 * Scales for lengths and frequencies of motions under this drive, in canonical units like
 * everything else: the length is the distance that the drive can move the pendulum or, if that is
 * less, the force's own length scale, and much less than 1 for a weak drive; the frequency is an
 * upper bound of that of free oscillations of this amplitude. Both are 1 for pendulums, whose
 * frequency only falls with amplitude. The damping must not be 0.
 */
typedef struct pendres_model_units {
  double length, rate;
} pendres_model_units;

pendres_model_units pendres_model_units_of(const pendres_pendulum *p);

/* The distance of two states with these differences, in units of p. */
double pendres_model_distance(const pendres_pendulum *p, double x, double v);

/* Whether a pendulum in a state is certainly on its way to infinity; see pendres_settled. */
int pendres_model_escapes(const pendres_pendulum *p, double y, double w);

/* Whether the force is defined within bounds alone: beyond them it is NaN, and so are states. */
int pendres_model_bounded(const pendres_pendulum *p);

/* Most of the way to the nearest pole: what comes closer escapes, or is found to need more steps
   than are chosen for motions within. Infinite if there is none. */
double pendres_model_edge(const pendres_pendulum *p);

/* Whether the equation depends on the drive's phase; otherwise its frequency is but a clock. */
int pendres_model_driven(const pendres_pendulum *p);

/* Whether force and friction are linear, so that all motions have the same Floquet multipliers. */
int pendres_model_is_linear(const pendres_pendulum *p);

/* Whether two pendulums have the same parameters, but for the temperature. */
int pendres_model_same(const pendres_pendulum *a, const pendres_pendulum *b);

/* dw/dtheta at y and w = v/omega, at a drive phase theta of that cosine. */
double pendres_model_slope(const pendres_pendulum *p, double y, double w, double cosine);

/* Derivatives of the acceleration by x and v: *dx = -f'(x), *dv = -h'(v). The parametric drive,
    which multiplies *dx by 1 + parametric_amplitude cos(drive_frequency t), is left out. dx and dv
    may be NULL. If p is NULL, *dx is that of the plain pendulum and *dv is NaN. */
void pendres_model_jacobian(const pendres_pendulum *p, double x, double v,
                            double *dx, double *dv);

/* Potential of p without its periodic drives, the integral of f - torque: -sin x - torque x, or
    a1 x^2/2 + ... + a5 x^6/6 - torque x, or that of another force. NaN if p is NULL. */
double pendres_model_potential(const pendres_pendulum *p, double x);

#endif
