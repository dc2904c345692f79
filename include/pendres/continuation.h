/*
 * continuation.h -- branches of periodic orbits, and where they end.
 *
 * Owns: following orbits, stable and unstable, as a parameter changes; folds, period
 * doublings and symmetry breakings on the way; curves of these in two parameters; cusps.
 *
 * Method: Newton's method on the strobe map with its variational equations and parameter
 * sensitivities, pseudo-arclength steps. An orbit that is its own mirror image is a fixed point
 * of half a period followed by the reflection y -> -y: its folds are multipliers +1 of that
 * half map, its symmetry breakings multipliers -1, and it cannot double its period.
 *
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, chapters 4, 9 and 10; Swift and
 * Wiesenfeld, Physical Review Letters 52 (1984) 705.
 */
#ifndef PENDRES_CONTINUATION_H
#define PENDRES_CONTINUATION_H

#include <pendres/context.h>
#include <pendres/orbit.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** What changes along a branch. */
typedef enum pendres_parameter {
  PENDRES_DRIVE_FREQUENCY = 0,
  PENDRES_DAMPING,
  PENDRES_DRIVE_AMPLITUDE,
  PENDRES_PARAMETER_COUNT
} pendres_parameter;

/** Where a branch changes its character. */
typedef enum pendres_special {
  PENDRES_REGULAR = 0,
  PENDRES_FOLD,             /**< two orbits meet and vanish; multiplier +1 */
  PENDRES_PERIOD_DOUBLING,  /**< multiplier -1 */
  PENDRES_SYMMETRY_BREAKING /**< of an orbit that is its own mirror image; multiplier +1 */
} pendres_special;

/** A fold, period doubling or symmetry breaking. Plain data. */
typedef struct pendres_bifurcation {
  pendres_special kind;
  pendres_parameter parameter; /**< what was varied to find it */
  double value, value_error;   /**< of that parameter; all others are as given */
  /**
   * For a fold: second derivative of the parameter by arclength of the Poincaré point in
   * the (x, v) plane along the branch. Negative: the two orbits exist below `value`, positive:
   * above. 0 at a cusp. NaN for the other kinds.
   */
  double curvature, curvature_error;
  pendres_orbit orbit; /**< the orbit there, its pendulum with the value; slopes are NaN */
} pendres_bifurcation;

/** A fold in the drive frequency. */
typedef pendres_bifurcation pendres_fold;

/**
 * The fold in drive frequency at the end of the branch that `near` lies on: follows it, first in
 * the direction in which its leading multiplier approaches +1, then in the other.
 *
 * near may be stable or not; it is read only. value of *out is the drive frequency of the fold.
 * Errors: PENDRES_NOT_FOUND if the branch has no fold between a third of and three times the
 * drive frequency of near, PENDRES_NOT_CONVERGED if near is no orbit,
 * PENDRES_TOLERANCE_UNREACHABLE if value_error exceeds the tolerance (*out is complete), and those
 * of the integration.
 */
pendres_status pendres_fold_find(pendres_context *ctx, const pendres_orbit *near,
                                 pendres_fold *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
