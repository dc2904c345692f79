/**
 * @file phase_diagram.h
 * @brief Which states of motion exist where, by an ensemble and by the branches.
 *
 * Owns: the regimes of the paper's Fig. 8, found in two ways: from what the members of an
 * ensemble settle on (the paper's way), and from the branches on which these orbits lie with the
 * folds and symmetry breakings that bound them (the exact way). The two differ where a
 * state exists but its basin misses all members. A branch that no member of a line reaches at all
 * is found from neighbouring lines, see pendres_phase_line_complete().
 *
 * A diagram has two parameters. Its points lie on lines: along a line the drive frequency or the
 * drive amplitude changes, from line to line another parameter. pendres_phase_diagram_compute()
 * computes all of it on one thread. The same in pieces, for threads of the caller's own:
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
 * one of smallest amplitude is SA, the others are LA, a pair of mirror images counting as one.
 * Where there is one alone, on a line with a fold at which the small orbit ends, it is LA beyond
 * that fold; before it, it is SA if its amplitude is less than the fold's, else LA. The small orbit
 * ends at the upper end of its range in softening forces, as the pendulum's is, at the lower end in
 * stiffening ones, told by the unstable orbit that it meets there. Without such a
 * fold it has no name. (A line by itself can miss that fold, if its members are on LA alone and
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

/** One list makes the codes and their names: X(code, name). */
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
 * PENDRES_REGIME_COUNT: how many there are.
 */
typedef enum pendres_regime {
#define PENDRES_REGIME_CODE(code, name) PENDRES_REGIME_##code,
  PENDRES_REGIME_LIST(PENDRES_REGIME_CODE)
#undef PENDRES_REGIME_CODE
  PENDRES_REGIME_COUNT /**< how many there are; not a regime */
} pendres_regime;

/** "sa", "la", "coexistence", "single", "other"; NULL if out of range. The string is static.
    Thread safe. */
const char *pendres_regime_name(pendres_regime regime);

/** What members settle on beside SA and LA: bits, 0 for nothing. */
typedef enum pendres_other {
  PENDRES_OTHER_ASYMMETRIC = 1, /**< an orbit of one drive period that is not its own mirror image:
                                     SA or LA all the same */
  PENDRES_OTHER_PERIODIC = 2,   /**< an orbit that closes after several drive periods */
  PENDRES_OTHER_RUNNING = 4,    /**< an orbit that closes but for whole turns */
  PENDRES_OTHER_CHAOTIC = 8,    /**< a chaotic attractor */
  PENDRES_OTHER_UNRESOLVED = 16 /**< some member did not settle within its budget */
} pendres_other;

/** "asymmetric", "periodic", "running", "chaotic", "unresolved"; NULL if it is none of the bits.
    The string is static. Thread safe. */
const char *pendres_other_name(pendres_other bit);

/** One point of the diagram. Amplitudes are in radians, the loop area A is the work of the drive in
    one of its periods, in m g l. NaN where there is no such state. */
typedef struct pendres_phase_point {
  pendres_pendulum pendulum;  /**< the parameters there */
  pendres_regime regime;      /**< by the members that settled */
  pendres_regime exact;       /**< by the branches: which of SA and LA exist as attractors; OTHER
                                   only where neither does */
  int other;                  /**< bits of pendres_other */
  size_t unresolved;          /**< members that did not settle within their budget */
  double sa_fraction;         /**< share of the members on SA, 0 to 1; NaN where regime is SINGLE */
  double sa_fraction_error;   /**< the share of the members that are unresolved or uncertain */
  double la_fraction;         /**< share of the members on LA, 0 to 1; NaN where regime is SINGLE */
  double la_fraction_error;   /**< as sa_fraction_error */
  double mean_loop_area;      /**< mean of the members' loop areas, see response.h */
  double mean_loop_area_error; /**< its error */
  double mean_loop_amplitude; /**< amplitude of the loop averaged over members, see response.h */
  double mean_loop_amplitude_error; /**< its error */
  double sa_amplitude;        /**< half peak to peak of SA's orbit, whether members reach it or not;
                                   NaN where it does not exist, or exact is SINGLE */
  double sa_amplitude_error;  /**< its error */
  double la_amplitude;        /**< the same of LA; of several, of the largest */
  double la_amplitude_error;  /**< its error */
  size_t uncertain;           /**< members that may belong to another state, see response.h */
  double weakest_multiplier;  /**< largest modulus of a Floquet multiplier among the closed orbits
                                   that members settled on: near 1, the members draw near it slowly,
                                   and those that are unresolved ask for a larger period_budget; NaN
                                   if none did */
} pendres_phase_point;

/** How the points of a line are computed. */
typedef struct pendres_phase_options {
  pendres_ensemble ensemble;   /**< whose members settle at every point */
  pendres_parameter parameter; /**< what changes along a line: PENDRES_DRIVE_FREQUENCY or
                                    PENDRES_DRIVE_AMPLITUDE */
  double spacing;              /**< of the points of branches in arclength, as in
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
 * Complete a line by what curves of bifurcations show that were followed from other lines. Where
 * such a curve crosses the line at a fold or a symmetry breaking of orbits that can be SA or LA and
 * the line's branches have none there, the branch through it is added and the points are judged
 * anew. So a branch born away from the others whose basin all members miss is known if it joins,
 * through other lines, one that members reach: of this line, or of another that the curves were
 * started from. A branch that no such curve bounds stays unknown. Members are computed once more
 * only where the fold at which SA ends was unknown.
 *
 * @param ctx      belongs to one thread at a time
 * @param n        how many points
 * @param curves   of bifurcations in the line's parameter and, second, another one, of pendulums
 *                 like the line's otherwise; read; NULL stands for none
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
  pendres_pendulum pendulum;    /**< what neither parameter changes */
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
 * @return PENDRES_INVALID_ARGUMENT for a grid that is none, PENDRES_OUT_OF_MEMORY,
 *         PENDRES_INTERRUPTED
 */
pendres_status pendres_phase_diagram_compute(pendres_context *ctx, const pendres_phase_grid *grid,
                                             pendres_phase_diagram **out);

/** A diagram of which nothing is computed yet: step 1 of the computation in pieces. Arguments and
    errors as for pendres_phase_diagram_compute(), without a context, and so without a message. */
pendres_status pendres_phase_diagram_create(const pendres_phase_grid *grid,
                                            pendres_phase_diagram **out);
/** NULL is allowed. */
void pendres_phase_diagram_free(pendres_phase_diagram *diagram);

/** Do not compute a point: its outcome is PENDRES_UNSUPPORTED. Before its line is computed. Returns
    PENDRES_INVALID_ARGUMENT without a diagram or such a point. */
pendres_status pendres_phase_diagram_leave_out(pendres_phase_diagram *diagram, size_t point);

/** Opaque: what was computed of a line, plain bytes. */
typedef struct pendres_phase_record pendres_phase_record;

/** How many bytes a record has; 0 for NULL. They have the layout of this build of the library. */
size_t pendres_phase_record_size(const pendres_phase_record *record);
/** The bytes, owned by the record; NULL for NULL. They may be copied, kept, and sent elsewhere. */
const void *pendres_phase_record_bytes(const pendres_phase_record *record);
/** NULL is allowed. */
void pendres_phase_record_free(pendres_phase_record *record);

/**
 * Compute a line: step 2. The diagram is read alone, so threads may compute different lines of it
 * at a time.
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

/** Take over what was computed of a line: the bytes of its record. Not while another thread uses
    the diagram. PENDRES_INVALID_ARGUMENT: no such line, or no such bytes; PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_phase_diagram_take_line(pendres_phase_diagram *diagram, size_t line,
                                               size_t size, const void *bytes);

/**
 * Gather the bifurcations of all lines: step 3. *families: how many families of them there are,
 * such that no bifurcation lies on a curve of another family, as those of different periods do
 * not; 0: the lines show no bifurcations that were not known, or all rounds are done, and the
 * diagram is whole. Families that take longer to follow come first. Not while another thread uses
 * the diagram.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_phase_diagram_find_families(pendres_phase_diagram *diagram,
                                                   size_t *families);

/**
 * Follow the curves through the bifurcations of a family, as far as they are not known: step 4.
 * The diagram is read alone, so threads may follow different families of it at a time. *out is to
 * be freed by pendres_phase_record_free(), NULL on failure; ctx belongs to one thread at a time. A
 * curve that cannot be followed for reasons of its own ends its family, which
 * pendres_phase_diagram_curves_outcome() tells.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (no such family), PENDRES_INTERRUPTED, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_phase_diagram_follow_family(pendres_context *ctx,
                                                   const pendres_phase_diagram *diagram,
                                                   size_t family, pendres_phase_record **out);

/** Take over what was followed of a family, in any order; when all are taken the diagram has the
    curves. Not while another thread uses the diagram. PENDRES_INVALID_ARGUMENT: no such family, or
    it was taken already, or no such bytes; PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_phase_diagram_take_family(pendres_phase_diagram *diagram, size_t family,
                                                 size_t size, const void *bytes);

/** Complete a line by the curves: step 5, as pendres_phase_diagram_compute_line(). A line that
    cannot be completed stays as it was, and the outcome of its points says why. */
pendres_status pendres_phase_diagram_complete_line(pendres_context *ctx,
                                                   const pendres_phase_diagram *diagram,
                                                   size_t line, pendres_phase_record **out);

/** A point, owned by the diagram; one that has no results has the regimes OTHER and NaN. NULL out
    of range. */
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

/** The cusp at which SA and LA become one, the last one of several on the way out of the region
    where both exist; owned by the diagram; NULL if none was found. */
const pendres_cusp *pendres_phase_diagram_cusp(const pendres_phase_diagram *diagram);

/** The state that ends in a fold of the diagram: PENDRES_LABEL_SA or _LA, told by the amplitude at
    the cusp or, without a cusp, by the fold's curvature and which way the resonance bends;
    PENDRES_LABEL_PERIODIC for folds of other orbits. */
pendres_label pendres_phase_diagram_ending(const pendres_phase_diagram *diagram,
                                           const pendres_orbit *orbit, double curvature);

/** The fold of a line at which a state ends, PENDRES_LABEL_SA or _LA: of several, that with the
    largest value of the line's parameter, or the smallest where the resonance bends to higher ones.
    Owned by the diagram; NULL if there is none. */
const pendres_bifurcation *pendres_phase_diagram_fold(const pendres_phase_diagram *diagram,
                                                      size_t line, pendres_label state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
