/**
 * @file phase_diagram.h
 * @brief Which states of motion exist at which parameters, by an ensemble and by the branches.
 *
 * Owns: the regimes of the paper's Fig. 8, found in two ways: from what the members of an
 * ensemble settle on (the paper's way), and from the branches of these orbits, bounded by folds and
 * symmetry breakings (the exact way). The two differ where a state exists but no member starts in
 * its basin. A branch that no member of a line reaches at all is found from neighbouring lines, see
 * pendres_phase_line_complete().
 *
 * A diagram has two parameters. Its points lie on lines: along a line the drive frequency or the
 * drive amplitude changes, from line to line another parameter. pendres_phase_diagram_compute()
 * computes all of it on one thread. A program that has threads of its own does the same in steps:
 *
 *   1. pendres_phase_diagram_create()
 *   2. pendres_phase_diagram_compute_line() for every line, in any order, on any threads, each with
 *      a context of its own; it makes a record, which pendres_phase_diagram_take_line() takes
 *   3. pendres_phase_diagram_find_families(), on one thread; if there are any families:
 *   4. pendres_phase_diagram_follow_family() for every family, as lines in step 2; it makes a
 *      record, which pendres_phase_diagram_take_family() takes
 *   5. pendres_phase_diagram_complete_line() for every line, as in step 2; then step 3 again
 *
 * SA and LA are named as everywhere: of the orbits of period one without winding that coexist, the
 * one of smallest amplitude is SA, the others are LA; a pair of mirror images counts as one state.
 * Where such an orbit is alone, its name follows from the fold of the line at which SA ends. Beyond
 * that fold it is LA; before it, it is SA if its amplitude is less than the fold's, else LA; on a
 * line without such a fold it has no name. With softening forces, such as the pendulum's, SA ends
 * at the upper end of its range, with stiffening ones at the lower end; the unstable orbit that it
 * meets there tells which. (A line by itself can miss that fold, if its members are on LA alone and
 * LA's branch does not lead to it.)
 */
#ifndef PENDRES_PHASE_DIAGRAM_H
#define PENDRES_PHASE_DIAGRAM_H

#include <pendres/continuation.h>
#include <pendres/response.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** The regimes with their names: X(code, name). */
#define PENDRES_REGIME_LIST(X) \
  X(SA, "sa")                  \
  X(LA, "la")                  \
  X(COEXISTENCE, "coexistence") \
  X(SINGLE, "single")          \
  X(OTHER, "other")

/**
 * What the members of an ensemble settle on: PENDRES_REGIME_SA or PENDRES_REGIME_LA, all on that
 * state; PENDRES_REGIME_COEXISTENCE, some on either; PENDRES_REGIME_SINGLE, all on one state that
 * is neither, as beyond the cusp; PENDRES_REGIME_OTHER, some on something else, see pendres_other.
 */
typedef enum pendres_regime {
#define PENDRES_REGIME_CODE(code, name) PENDRES_REGIME_##code,
  PENDRES_REGIME_LIST(PENDRES_REGIME_CODE)
#undef PENDRES_REGIME_CODE
  PENDRES_REGIME_COUNT /**< how many there are; not a regime */
} pendres_regime;

/** What members settle on beside SA and LA: bits, 0 for nothing. */
typedef enum pendres_other {
  PENDRES_OTHER_ASYMMETRIC = 1, /**< an orbit of one drive period that is not its own mirror image:
                                     SA or LA all the same */
  PENDRES_OTHER_PERIODIC = 2,   /**< an orbit that closes after several drive periods */
  PENDRES_OTHER_RUNNING = 4,    /**< an orbit that closes up to whole turns: its winding is not 0 */
  PENDRES_OTHER_CHAOTIC = 8,    /**< a chaotic attractor */
  PENDRES_OTHER_UNRESOLVED = 16 /**< some member did not settle within its budget */
} pendres_other;

/** One point of the diagram. Amplitudes are in rad, the loop area is the work of the drive in one
    of its periods, in m g l. Numbers of a state that does not exist are NaN. */
typedef struct pendres_phase_point {
  pendres_pendulum pendulum;  /**< the parameters there */
  pendres_regime regime;      /**< by the members that settled */
  pendres_regime exact;       /**< by the branches: which of SA and LA exist as attractors;
                                   PENDRES_REGIME_OTHER only where neither does */
  int other;                  /**< bits of pendres_other */
  size_t unresolved;          /**< members that did not settle within their budget */
  double sa_fraction;         /**< share of the members on SA, 0 to 1; NaN where regime is
                                   PENDRES_REGIME_SINGLE */
  double sa_fraction_error;   /**< the share of the members that are unresolved or uncertain */
  double la_fraction;         /**< share of the members on LA, likewise */
  double la_fraction_error;   /**< as sa_fraction_error */
  double mean_loop_area;      /**< mean of the members' loop areas, see response.h */
  double mean_loop_area_error; /**< its error */
  double mean_loop_amplitude; /**< amplitude of the loop averaged over members, see response.h */
  double mean_loop_amplitude_error; /**< its error */
  double sa_amplitude;        /**< half peak to peak of SA's orbit, whether members reach it or not;
                                   NaN where it does not exist, or exact is PENDRES_REGIME_SINGLE */
  double sa_amplitude_error;  /**< its error */
  double la_amplitude;        /**< the same for LA, of which the largest orbit counts */
  double la_amplitude_error;  /**< its error */
  size_t uncertain;           /**< members that may belong to another state, see response.h */
  double weakest_multiplier;  /**< largest modulus of a Floquet multiplier of all closed orbits that
                                   members settled on; NaN if they settled on none. Close to 1,
                                   members approach that orbit slowly, and unresolved ones may need
                                   a larger period_budget */
} pendres_phase_point;

/** How the points of a line are computed. */
typedef struct pendres_phase_options {
  pendres_ensemble ensemble;   /**< whose members settle at every point */
  pendres_parameter parameter; /**< what changes along a line: PENDRES_DRIVE_FREQUENCY or
                                    PENDRES_DRIVE_AMPLITUDE */
  double spacing;              /**< distance in arclength between the points of a branch, as in
                                    pendres_branch_options; 0: the default */
} pendres_phase_options;

/**
 * A line of the diagram: n pendulums that differ in options->parameter alone, whose values ascend.
 *
 * @param ctx       belongs to one thread at a time
 * @param n         how many pendulums; none is allowed
 * @param pendulums [n], read
 * @param options   read
 * @param out       [n], written
 * @param branches  may be NULL; receives all branches that the members' orbits lie on, which reach
 *                  beyond the line's values; to be freed by pendres_branches_free(); NULL on
 *                  failure
 * @return PENDRES_INVALID_ARGUMENT, or a failure of the integration; then out is not meaningful
 */
pendres_status pendres_phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                  const pendres_phase_options *options, pendres_phase_point *out,
                                  pendres_branches **branches);

/**
 * Complete a line by curves of bifurcations that were followed from other lines. Where such a
 * curve crosses the line at a fold or a symmetry breaking of orbits that can be SA or LA, and the
 * line's branches have no such bifurcation there, the branch through it is added and the points are
 * judged anew. A branch that no member of this line reaches is found in this way if one of the
 * curves bounds it, and stays unknown otherwise. Members are computed once more only where the fold
 * at which SA ends was unknown.
 *
 * @param ctx      belongs to one thread at a time
 * @param n        how many points
 * @param curves   of bifurcations, whose first parameter is the line's and whose second is another
 *                 one; all other parameters must be the line's; read; NULL: there are none
 * @param options  those that the line was computed with
 * @param points   [n], of pendres_phase_line(), brought up to date
 * @param branches of pendres_phase_line(), brought up to date
 * @return PENDRES_INVALID_ARGUMENT, or a failure of the integration; then points are not meaningful
 */
pendres_status pendres_phase_line_complete(pendres_context *ctx, size_t n,
                                           const pendres_curves *curves,
                                           const pendres_phase_options *options,
                                           pendres_phase_point *points,
                                           pendres_branches *branches);

/* ---- Whole diagrams ---- */

/** The points of a diagram. A point has the number line * values + place on the line. */
typedef struct pendres_phase_grid {
  pendres_pendulum pendulum;    /**< the parameters that all points share */
  pendres_phase_options options; /**< for all lines; its parameter changes along each */
  size_t values;                /**< points of a line */
  const double *value;          /**< [values] of the parameter along a line, ascending; not owned */
  pendres_parameter across;     /**< what changes from line to line: another parameter */
  size_t lines;                 /**< how many lines */
  const double *line_value;     /**< [lines] of the parameter across, ascending; not owned */
} pendres_phase_grid;

/** Opaque: the points of a grid, the branches of its lines, and the curves of bifurcations. */
typedef struct pendres_phase_diagram pendres_phase_diagram;

/**
 * A whole diagram on one thread. A point or line that cannot be computed is marked by its outcome;
 * the others are computed all the same.
 *
 * @param ctx  belongs to one thread at a time
 * @param grid read; copied but for the values, which must outlive the diagram
 * @param out  receives the diagram, to be freed by pendres_phase_diagram_free(); NULL on failure
 * @return PENDRES_INVALID_ARGUMENT if the grid is not valid, PENDRES_OUT_OF_MEMORY,
 *         PENDRES_INTERRUPTED
 */
pendres_status pendres_phase_diagram_compute(pendres_context *ctx, const pendres_phase_grid *grid,
                                             pendres_phase_diagram **out);

/** Make a diagram of which nothing is computed yet: step 1. Arguments and errors are those of
    pendres_phase_diagram_compute(); there is no context, and so no message. */
pendres_status pendres_phase_diagram_create(const pendres_phase_grid *grid,
                                            pendres_phase_diagram **out);
/** Free a diagram and all that it owns. NULL is allowed. */
void pendres_phase_diagram_free(pendres_phase_diagram *diagram);

/** Leave a point out: it is not computed, and its outcome is PENDRES_UNSUPPORTED. To be called
    before the point's line is computed. Returns PENDRES_INVALID_ARGUMENT if the diagram is NULL or
    has no such point. */
pendres_status pendres_phase_diagram_leave_out(pendres_phase_diagram *diagram, size_t point);

/** Opaque: what was computed of a line, or of a family of bifurcations, as plain bytes. */
typedef struct pendres_phase_record pendres_phase_record;

/** How many bytes a record has; 0 for NULL. Only the same build of the library can read them. */
size_t pendres_phase_record_size(const pendres_phase_record *record);
/** The bytes, owned by the record; NULL for NULL. They may be copied, kept, and sent elsewhere. */
const void *pendres_phase_record_bytes(const pendres_phase_record *record);
/** Free a record. NULL is allowed. */
void pendres_phase_record_free(pendres_phase_record *record);

/**
 * Compute a line: step 2. The diagram is only read, so several threads may compute different lines
 * of it at once.
 *
 * @param ctx     belongs to one thread at a time
 * @param diagram read
 * @param line    number of the line
 * @param out     receives the record, to be freed by pendres_phase_record_free(); NULL on failure
 * @return what ends the whole computation: PENDRES_INVALID_ARGUMENT (no such line),
 *         PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED
 */
pendres_status pendres_phase_diagram_compute_line(pendres_context *ctx,
                                                  const pendres_phase_diagram *diagram, size_t line,
                                                  pendres_phase_record **out);

/** Take over what was computed of a line: the bytes of its record. No other thread may use the
    diagram meanwhile. Returns PENDRES_INVALID_ARGUMENT if there is no such line or the bytes are
    not those of such a record, PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_phase_diagram_take_line(pendres_phase_diagram *diagram, size_t line,
                                               size_t size, const void *bytes);

/**
 * Gather the bifurcations of all lines: step 3. *families receives how many families they form,
 * where no curve through a bifurcation of one family leads to one of another (bifurcations of
 * orbits of different periods, say). If it is 0 the diagram is complete: the lines show no
 * bifurcation that was not known, or all rounds are done. Families that take longer to follow come
 * first. No other thread may use the diagram meanwhile.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_phase_diagram_find_families(pendres_phase_diagram *diagram,
                                                   size_t *families);

/**
 * Follow the curves through the bifurcations of a family, as far as they are not known: step 4.
 * The diagram is only read, so several threads may follow different families of it at once. *out is
 * to be freed by pendres_phase_record_free(), NULL on failure; ctx belongs to one thread at a time.
 * If a curve cannot be followed, the rest of its family is not followed either, and
 * pendres_phase_diagram_curves_outcome() says why.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (no such family), PENDRES_INTERRUPTED, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_phase_diagram_follow_family(pendres_context *ctx,
                                                   const pendres_phase_diagram *diagram,
                                                   size_t family, pendres_phase_record **out);

/** Take over what was followed of a family, in any order of the families; when all are taken the
    diagram has the curves. No other thread may use the diagram meanwhile. Returns
    PENDRES_INVALID_ARGUMENT if there is no such family, it was taken already, or the bytes are not
    those of such a record; PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_phase_diagram_take_family(pendres_phase_diagram *diagram, size_t family,
                                                 size_t size, const void *bytes);

/** Complete a line by the curves (pendres_phase_line_complete()): step 5. Arguments and errors are
    those of pendres_phase_diagram_compute_line(). A line that cannot be completed stays as it was,
    and the outcome of its points says why. */
pendres_status pendres_phase_diagram_complete_line(pendres_context *ctx,
                                                   const pendres_phase_diagram *diagram,
                                                   size_t line, pendres_phase_record **out);

/** A point, owned by the diagram; NULL if there is no such point. One without results has
    PENDRES_REGIME_OTHER as both regimes, and NaN as its numbers. */
const pendres_phase_point *pendres_phase_diagram_point(const pendres_phase_diagram *diagram,
                                                       size_t point);

/**
 * What became of a point: PENDRES_OK, or why it has no results, or has not been completed.
 * *message (may be NULL) receives a sentence on it, owned by the diagram; NULL where there is none.
 */
pendres_status pendres_phase_diagram_outcome(const pendres_phase_diagram *diagram, size_t point,
                                             const char **message);

/** The branches of a line, owned by the diagram; NULL if there are none, or no such line. */
const pendres_branches *pendres_phase_diagram_branches(const pendres_phase_diagram *diagram,
                                                       size_t line);

/** The curves through all bifurcations, owned by the diagram; NULL before any was followed. */
const pendres_curves *pendres_phase_diagram_curves(const pendres_phase_diagram *diagram);

/** What became of the curves, as for a point: where it is not PENDRES_OK there may be more curves
    than were found. */
pendres_status pendres_phase_diagram_curves_outcome(const pendres_phase_diagram *diagram,
                                                    const char **message);

/** All bifurcations of the lines, line after line; *n of them, owned by the diagram, until curves
    are followed again. */
const pendres_bifurcation *pendres_phase_diagram_bifurcations(const pendres_phase_diagram *diagram,
                                                              size_t *n);

/** The cusp at which SA and LA become one: of several, the last on the way out of the region where
    both exist. Owned by the diagram; NULL if none was found. */
const pendres_cusp *pendres_phase_diagram_cusp(const pendres_phase_diagram *diagram);

/** Which state ends in a fold of the diagram, whose orbit and curvature are given (see
    pendres_bifurcation): PENDRES_LABEL_SA or PENDRES_LABEL_LA; PENDRES_LABEL_PERIODIC for orbits
    that can be neither. With a cusp the amplitude there decides; without one, the curvature and the
    side to which the resonance bends. */
pendres_label pendres_phase_diagram_ending(const pendres_phase_diagram *diagram,
                                           const pendres_orbit *orbit, double curvature);

/** The fold of a line at which a state, PENDRES_LABEL_SA or PENDRES_LABEL_LA, ends: of several, the
    one with the largest value of the line's parameter, or with the smallest where the resonance
    bends to higher values. Owned by the diagram; NULL if there is none. */
const pendres_bifurcation *pendres_phase_diagram_fold(const pendres_phase_diagram *diagram,
                                                      size_t line, pendres_label state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
