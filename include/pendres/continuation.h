/**
 * @file continuation.h
 * @brief Branches of periodic orbits, and where they end.
 *
 * Owns: following orbits, stable and unstable, as a parameter changes; folds, period
 * doublings, symmetry breakings and branch points on the way; curves of these in two parameters;
 * cusps.
 *
 * All pendulums are served, with torque, parametric drive or another force, as long as there is a
 * drive of either kind where orbits go round: without one a rotation has a period of its own, and
 * is no orbit of the strobe map (PENDRES_INVALID_ARGUMENT).
 *
 * Method: Newton's method on the strobe map with its variational equations and parameter
 * sensitivities, pseudo-arclength steps. An orbit that is its own mirror image is a fixed point
 * of half a period followed by the reflection y -> -y: its folds are multipliers +1 of that
 * half map, its symmetry breakings multipliers -1, and it cannot double its period. Branch points
 * are told from folds by the determinant of the equations bordered by the branch's tangent, and
 * from branches that only come close by what is left of the closing of the orbit (the source's
 * section 10.2; Moore, SIAM Journal on Numerical Analysis 17 (1980) 567). Two that come closer than
 * rounding tells are said to cross.
 *
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, chapters 4, 9 and 10; Swift and
 * Wiesenfeld, Physical Review Letters 52 (1984) 705.
 */
#ifndef PENDRES_CONTINUATION_H
#define PENDRES_CONTINUATION_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/orbit.h>
#include <pendres/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** One list makes the codes and their names: X(code, name). */
#define PENDRES_SPECIAL_LIST(X)      \
  X(REGULAR, "regular")              \
  X(FOLD, "fold")                    \
  X(PERIOD_DOUBLING, "period_doubling") \
  X(SYMMETRY_BREAKING, "symmetry_breaking") \
  X(BRANCH_POINT, "branch_point")

/**
 * Where a branch changes its character. PENDRES_REGULAR: nowhere there; PENDRES_FOLD: two orbits
 * meet and vanish, a multiplier is +1; PENDRES_PERIOD_DOUBLING: a multiplier is -1;
 * PENDRES_SYMMETRY_BREAKING: an orbit that is its own mirror image meets a pair that are each
 * other's, a multiplier is +1; PENDRES_BRANCH_POINT: two branches cross and exchange their
 * stability (transcritical), a multiplier is +1. PENDRES_SPECIAL_COUNT: how many there are.
 */
typedef enum pendres_special {
#define PENDRES_SPECIAL_CODE(code, name) PENDRES_##code,
  PENDRES_SPECIAL_LIST(PENDRES_SPECIAL_CODE)
#undef PENDRES_SPECIAL_CODE
  PENDRES_SPECIAL_COUNT /**< how many there are; not a character */
} pendres_special;

/** A fold, period doubling, symmetry breaking or branch point. Plain data. */
typedef struct pendres_bifurcation {
  pendres_special kind;        /**< which of these */
  pendres_parameter parameter; /**< what was varied to find it */
  double value;                /**< of that parameter; all others are as given */
  double value_error;          /**< its error */
  /**
   * For a fold: second derivative of the parameter by arclength of the Poincaré point in
   * the plane of x and v times the pendulum's unit of time (pendres_units_of), along the
   * branch. Negative: the two orbits exist below `value`, positive: above. 0 at a cusp. NaN for
   * the other kinds. A fold that cannot be told from a cusp has 0, and an error that says how
   * large it may be: the branch goes on through it and does not turn.
   */
  double curvature;
  double curvature_error;      /**< its error */
  pendres_orbit orbit; /**< the orbit there, its pendulum with the value; slopes are NaN; its
                            multipliers are those that make the bifurcation: one is +1 or -1, and
                            the product of both follows from the damping */
  double crossing[3];  /**< of a branch point: along the branch that crosses the one on which it was
                            found, (dx, dv, dparameter), either way and of no length in particular.
                            NaN for the other kinds, and where the branches are too much alike to
                            tell */
} pendres_bifurcation;

/** A bifurcation that is a fold. */
typedef pendres_bifurcation pendres_fold;

/**
 * The fold at the end of the branch that `near` lies on, as a parameter changes: followed first in
 * the direction in which its leading multiplier approaches +1, then in the other.
 *
 * @param ctx       belongs to one thread at a time
 * @param near      an orbit, stable or not; read
 * @param parameter what changes along the branch
 * @param out       written: value is the parameter's at the fold
 * @return PENDRES_NOT_FOUND if the branch has no fold between a third of and three times the
 *         parameter's value for near (of torque, parametric amplitude and coefficients: within
 *         twice its size and 1 of it), PENDRES_NOT_CONVERGED if near is no orbit,
 *         PENDRES_TOLERANCE_UNREACHABLE if value_error exceeds the tolerance (*out is complete),
 *         PENDRES_INVALID_ARGUMENT, and failures of the integration
 */
pendres_status pendres_fold_find(pendres_context *ctx, const pendres_orbit *near,
                                 pendres_parameter parameter, pendres_fold *out);

/* ---- Branches ---- */

/** Along which parameter, how far and how finely. Zero in a field of the last three: default. */
typedef struct pendres_branch_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  pendres_parameter parameter; /**< what changes along the branch */
  double low;           /**< lowest value of the parameter to which the branch is followed */
  double high;          /**< highest value */
  double spacing;       /**< of points in arclength, up to twice this in bends; default 0.05 */
  double wildest;       /**< growth of errors in one map at which a branch is given up; 1e3 */
  size_t most_points;   /**< each way from the start; default 2000, of which a stretch on which the
                             parameter does not turn counts as 200 at most, and 20000 in all */
} pendres_branch_options;

/** Why a branch ends where it does. */
typedef enum pendres_branch_end {
  PENDRES_END_RANGE = 0, /**< the parameter's range */
  PENDRES_END_CLOSED,    /**< it is back at its start: an isola */
  PENDRES_END_WILD,      /**< errors grow too much along the orbit to follow it */
  PENDRES_END_POINTS,    /**< most_points */
  PENDRES_END_STUCK,     /**< steps along the arc became too short */
  PENDRES_END_COUNT      /**< how many there are; not an end */
} pendres_branch_end;

/**
 * How the points of a branch disagree with its bifurcations: bits, 0 where all agree. Every branch
 * is checked when it has been followed; a doubt says that a bifurcation was missed or misnamed, or
 * that the branch consists of parts of two.
 */
typedef enum pendres_doubt {
  PENDRES_DOUBT_SIGN = 1, /**< between this point and the next at which it can be decided, a
                               multiplier passes +1 or -1 without a bifurcation, or there is a
                               bifurcation and none passes */
  PENDRES_DOUBT_TURN = 2, /**< the parameter turns here, and there is no fold */
  PENDRES_DOUBT_BIFURCATION = 4 /**< a fold at which the parameter does not turn, or turns against
                                     its curvature; or another bifurcation at which it does */
} pendres_doubt;

/** A point of a branch. */
typedef struct pendres_branch_point {
  pendres_special kind;   /**< what happens there; PENDRES_REGULAR: nothing */
  int bifurcation;        /**< its number in the branch's list, -1 for a regular point */
  double arclength;       /**< from the first point, in the pendulum's units (pendres_units_of):
                               y = x - pi/2 and v/omega count as they are, those of a force without
                               a period by their ratios where they are larger than 2, and at
                               dampings below 0.05 where they are smaller than 1; the drive
                               frequency in units of 0.3, other parameters of 0.1, but none in less
                               than a twentieth of its value */
  double parameter_error; /**< across the branch */
  pendres_orbit orbit;    /**< its pendulum has the parameter; slopes are NaN */
  int doubt;              /**< bits of pendres_doubt */
} pendres_branch_point;

/** Opaque: a branch in order, from its end at the lower parameter or a fold onwards. */
typedef struct pendres_branch pendres_branch;

/** How many points a branch has; 0 for NULL. */
size_t pendres_branch_count(const pendres_branch *branch);
/** Point number i, owned by the branch; NULL out of range. */
const pendres_branch_point *pendres_branch_get(const pendres_branch *branch, size_t i);
/** How many bifurcations lie on a branch; 0 for NULL. */
size_t pendres_branch_bifurcation_count(const pendres_branch *branch);
/** Bifurcation number i in the order of the branch, owned by it; NULL out of range. */
const pendres_bifurcation *pendres_branch_bifurcation_get(const pendres_branch *branch, size_t i);
/** How the branch ends at its first (which = 0) and its last point (1). */
pendres_branch_end pendres_branch_end_get(const pendres_branch *branch, int which);

/** A part of a branch along which its orbits attract. */
typedef struct pendres_branch_part {
  size_t first;               /**< number of the point at which it begins, in the branch's order */
  size_t last;                /**< number of the point at which it ends */
  pendres_special begins;     /**< the bifurcation at `first`; PENDRES_REGULAR: the branch begins
                                   there, or is not known before */
  pendres_special ends;       /**< the bifurcation at `last`; PENDRES_REGULAR: the branch ends
                                   there, or is not known beyond */
} pendres_branch_part;

/**
 * The parts of a branch that attract, in its order, from wherever orbits become stable to wherever
 * they cease to be, whatever the reason: folds, symmetry breakings, period doublings. Along a part
 * the parameter goes one way: where orbits were born by such a bifurcation the branch turns back,
 * and another part begins. A branch that closes (PENDRES_END_CLOSED) may have one part cut in two
 * at its first point.
 *
 * @param branch read; NULL has no parts
 * @param room   how many parts out has room for
 * @param out    [room], the first of them are written; may be NULL if room is 0
 * @return the number of parts, which may be more than room. Thread safe.
 */
size_t pendres_branch_parts(const pendres_branch *branch, size_t room, pendres_branch_part *out);

/**
 * All orbits of a branch at a value of its parameter, in the order of the branch; *found is their
 * number, and the first `room` of them are written to out. Next to a fold, within the errors, an
 * orbit may be missing.
 */
pendres_status pendres_branch_cross(pendres_context *ctx, const pendres_branch *branch,
                                    double value, size_t room, pendres_orbit *out, size_t *found);

/**
 * An orbit on the branch that crosses at a period doubling, a symmetry breaking or a branch point:
 * one of twice the period, or one of a pair that are each other's mirror image, or one on the other
 * branch, on the side on which that attracts, if it does on one. Its parameter differs from the
 * bifurcation's.
 */
pendres_status pendres_branch_switch(pendres_context *ctx, const pendres_bifurcation *at,
                                     pendres_orbit *out);

/** Opaque: several branches. */
typedef struct pendres_branches pendres_branches;

/**
 * The branches that n orbits lie on, each once: an orbit is passed over if it, or its mirror image,
 * lies on a branch that was found already. The orbits that an ensemble settles on thus lead to all
 * branches that it reaches, isolas included.
 * The orbits may differ only in the parameter. *out is to be freed by pendres_branches_free().
 * An orbit from which no branch can be followed (since it is about to vanish) is passed over and
 * counted as skipped.
 *
 * Each branch is followed both ways, stable and unstable parts, with its folds, period doublings
 * and symmetry breakings located to the tolerance. Errors: PENDRES_INVALID_ARGUMENT,
 * PENDRES_NOT_CONVERGED (an orbit is none), those of the integration. PENDRES_OK also where some
 * point's error exceeds the tolerance: the errors say so.
 */
pendres_status pendres_branches_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     const pendres_branch_options *options, pendres_branches **out);
/** NULL is allowed; frees the branches of the set too. */
void pendres_branches_free(pendres_branches *branches);
/** How many branches a set has; 0 for NULL. */
size_t pendres_branches_count(const pendres_branches *branches);
/** Branch number i, owned by the set; NULL out of range. */
const pendres_branch *pendres_branches_get(const pendres_branches *branches, size_t i);
/** How many orbits and bifurcations no branch could be followed from; 0 for NULL. */
size_t pendres_branches_skipped(const pendres_branches *branches);

/**
 * The backbone of a damped pendulum of any force: the drive frequency at which its orbit of period
 * one lags pi/2 behind the drive (in the first harmonic), where the drive works best against
 * friction. As the damping falls these orbits form a curve, from small oscillations about the well
 * into which the pendulum falls from y = 0 (of two wells with a barrier there, the upper one) to
 * where the curve turns back, since friction cannot take out more: that curve is meant.
 *
 * @param ctx             belongs to one thread at a time
 * @param n               how many pendulums
 * @param pendulums       [n], read but for their drive_frequency; damping and drive amplitude
 *                        above 0
 * @param out             [n], written: the orbits; NaN where there is none
 * @param frequency_error [n], written: that of out[i].pendulum.drive_frequency; may be NULL
 * @param outcome         [n], written: PENDRES_OK, PENDRES_TOLERANCE_UNREACHABLE (the error tells),
 *                        or PENDRES_NOT_FOUND: there is no well, or the damping is below that at
 *                        which the curve turns back
 * @return PENDRES_INVALID_ARGUMENT, or a failure of the integration; then out is not meaningful
 *
 * The undamped, undriven backbone is pendres_free_oscillation_find().
 */
pendres_status pendres_backbone_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, pendres_orbit *out,
                                     double *frequency_error, pendres_status *outcome);

/* ---- Curves in two parameters ---- */

/** Where two folds meet and vanish. Plain data. */
typedef struct pendres_cusp {
  pendres_parameter parameter[2]; /**< what was varied to find it */
  double value[2];                /**< of these parameters, in their order */
  double value_error[2];          /**< their errors */
  pendres_orbit orbit;            /**< the orbit there; slopes are NaN */
} pendres_cusp;

/** How far and how finely. Zero in one of the last three: default. */
typedef struct pendres_curve_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  pendres_parameter second;      /**< beside the one that the start was found in */
  double low[2];                 /**< lowest values of the start's parameter and of the second */
  double high[2];                /**< highest values: the curve is followed while both lie within */
  double spacing;                /**< of points in arclength, as for branches; default 0.05 */
  double wildest;                /**< growth of errors in a map at which a curve is given up; 300 */
  size_t most_points;            /**< each way from the start; default as for branches */
} pendres_curve_options;

/** A point of a curve. */
typedef struct pendres_curve_point {
  int cusp;                      /**< its number in the curve's list; -1: not a cusp */
  double arclength;              /**< from the first point, in the units of branches */
  double value[2];               /**< of both parameters */
  double value_error[2];         /**< their errors across the curve */
  double curvature;              /**< of folds, as in pendres_bifurcation; it changes its sign at a
                                      cusp; NaN on curves of other bifurcations */
  pendres_orbit orbit;           /**< the orbit there; slopes are NaN */
} pendres_curve_point;

/** Opaque: a curve of folds, period doublings, symmetry breakings or branch points, in order. */
typedef struct pendres_curve pendres_curve;

/** What happens all along a curve; PENDRES_REGULAR for NULL. */
pendres_special pendres_curve_kind_get(const pendres_curve *curve);
/** How many points a curve has; 0 for NULL. */
size_t pendres_curve_count(const pendres_curve *curve);
/** Point number i, owned by the curve; NULL out of range. */
const pendres_curve_point *pendres_curve_get(const pendres_curve *curve, size_t i);
/** How many cusps lie on a curve; 0 for NULL. */
size_t pendres_curve_cusp_count(const pendres_curve *curve);
/** Cusp number i in the order of the curve, owned by it; NULL out of range. */
const pendres_cusp *pendres_curve_cusp_get(const pendres_curve *curve, size_t i);

/**
 * All bifurcations of a curve at a value of its second parameter, in the order of the curve; each
 * is located to the tolerance. *found is their number, the first `room` are written. Next to where
 * the curve turns back in that parameter, within the errors, two may be missing.
 */
pendres_status pendres_curve_cross(pendres_context *ctx, const pendres_curve *curve, double value,
                                   size_t room, pendres_bifurcation *out, size_t *found);

/** Opaque: several curves. */
typedef struct pendres_curves pendres_curves;

/**
 * The curves that n bifurcations lie on, each once; those that hardly reach beyond the
 * bifurcation itself are left out. Each is followed both ways from where it starts. Errors as for
 * pendres_branches_find(). *out is to be freed by pendres_curves_free().
 */
pendres_status pendres_curves_find(pendres_context *ctx, size_t n,
                                   const pendres_bifurcation *bifurcations,
                                   const pendres_curve_options *options, pendres_curves **out);
/** NULL is allowed; frees the curves of the set too. */
void pendres_curves_free(pendres_curves *curves);
/** How many curves a set has; 0 for NULL. */
size_t pendres_curves_count(const pendres_curves *curves);
/** Curve number i, owned by the set; NULL out of range. */
const pendres_curve *pendres_curves_get(const pendres_curves *curves, size_t i);

/**
 * The cusp that the curve of folds through `near` leads to, as near's parameter and `second`
 * change: first in the direction in which its curvature falls, then in the other.
 * Errors: PENDRES_NOT_FOUND, PENDRES_TOLERANCE_UNREACHABLE (*out is complete), those of the
 * integration.
 */
pendres_status pendres_cusp_find(pendres_context *ctx, const pendres_fold *near,
                                 pendres_parameter second, pendres_cusp *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
