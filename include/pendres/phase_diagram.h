/*
 * phase_diagram.h -- which states of motion exist where, by an ensemble and by the curves.
 *
 * Owns: the regimes of the paper's Fig. 8, found in two ways: from what the members of an
 * ensemble settle on (the paper's way), and from the branches on which these orbits lie with the
 * folds and symmetry breakings that bound them (the exact way). The two differ where a
 * state exists but its basin misses all members. A branch that no member of a line reaches at all
 * is found from neighbouring lines, see pendres_phase_line_complete.
 *
 * SA and LA are named as everywhere (see pendres_label): of the orbits of period one without
 * winding that coexist, the one of smallest amplitude is SA, the others are LA, a pair of mirror
 * images counting as one. Where there is one alone, at a damping with a fold at which the small
 * orbit ends, it is LA beyond that frequency; below it, it is SA if its amplitude is less than the
 * fold's, else LA. Without such a fold it has no name. (A line by itself can miss that fold, if its
 * members are on LA alone and LA's branch does not lead to it.)
 */
#ifndef PENDRES_PHASE_DIAGRAM_H
#define PENDRES_PHASE_DIAGRAM_H

#include <pendres/continuation.h>
#include <pendres/response.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef enum pendres_regime {
  PENDRES_REGIME_SA = 0,
  PENDRES_REGIME_LA,
  PENDRES_REGIME_COEXISTENCE,
  PENDRES_REGIME_SINGLE, /**< one state, neither SA nor LA: damping above the cusp's */
  PENDRES_REGIME_OTHER,  /**< some member settles on something else, see pendres_other */
  PENDRES_REGIME_COUNT
} pendres_regime;

/** "sa", "la", "coexistence", "single", "other"; NULL if out of range. */
const char *pendres_regime_name(pendres_regime regime);

/** What else lives there: bits, 0 for nothing. */
typedef enum pendres_other {
  PENDRES_OTHER_ASYMMETRIC = 1, /**< period one, but not its own mirror image: SA or LA
                                       all the same */
  PENDRES_OTHER_PERIODIC = 2,   /**< closes after several drive periods */
  PENDRES_OTHER_RUNNING = 4,    /**< closes but for whole turns */
  PENDRES_OTHER_CHAOTIC = 8,
  PENDRES_OTHER_UNRESOLVED = 16 /**< some member did not settle within its budget */
} pendres_other;

/** One point of the diagram. Errors beside results; NaN where there is no such state. */
typedef struct pendres_phase_point {
  pendres_pendulum pendulum;
  pendres_regime regime;  /**< by the members that settled */
  pendres_regime exact;   /**< by the branches: which of SA and LA exist as attractors; never OTHER
                               unless neither does */
  int other;              /**< bits of pendres_other */
  size_t unresolved;      /**< members */
  double sa_fraction, sa_fraction_error; /**< shares of the members; NaN where regime is SINGLE; */
  double la_fraction, la_fraction_error; /**< errors: the share of unresolved and uncertain ones */
  double mean_loop_area, mean_loop_area_error;
  double mean_loop_amplitude, mean_loop_amplitude_error;
  double sa_amplitude, sa_amplitude_error; /**< of the orbits, whether members reach them or not; */
  double la_amplitude, la_amplitude_error; /**< NaN where regime is SINGLE or it does not exist */
  size_t uncertain;       /**< members that may belong to another state, as in pendres_response */
} pendres_phase_point;

/**
 * A line of the diagram: n pendulums of one damping and drive amplitude, drive frequencies
 * ascending. out[n] is written. *branches (may be NULL) receives all branches that the members'
 * orbits lie on, to be freed by pendres_branches_free; they reach beyond the line's frequencies.
 * spacing: of the branches' points, 0 for the default.
 */
pendres_status pendres_phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                  const pendres_ensemble *ensemble, double spacing,
                                  pendres_phase_point *out, pendres_branches **branches);

/**
 * Complete a line with what curves of bifurcations know of it, found at other dampings. Where such
 * a curve crosses the line's damping at a fold or a symmetry breaking of orbits that can be SA or
 * LA and the line's branches have none there, the branch through it is added and the points
 * are judged anew. So a branch born away from the others whose basin all members miss is known if
 * it joins, through other dampings, one that members reach: of this line, or of another that the
 * curves were started from. A branch that no such curve bounds stays unknown.
 *
 * points[n] and *branches: of pendres_phase_line(), with the same ensemble and spacing; both are
 * brought up to date. Members are computed once more only where the fold at which SA ends was
 * unknown. curves: in drive frequency and, second, damping, of the line's drive amplitude.
 * Errors: PENDRES_INVALID_ARGUMENT, and those of the integration; then points are not meaningful.
 */
pendres_status pendres_phase_line_complete(pendres_context *ctx, size_t n,
                                           const pendres_curves *curves,
                                           const pendres_ensemble *ensemble, double spacing,
                                           pendres_phase_point *points,
                                           pendres_branches *branches);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
