/**
 * @file phase_diagram.h
 * @brief Which states of motion exist at which parameters, by an ensemble and by the branches.
 *
 * Owns: the regimes of the paper's Fig. 8, found in two ways: from what the members of an
 * ensemble settle on (the paper's way), and from the branches of these orbits, bounded by folds and
 * symmetry breakings (the exact way). The two differ where a state exists but no member starts in
 * its basin. A branch that no member of a line reaches at all is found by guesses, at up to eight
 * points of the line, that swing about as far as free oscillations of the drive's frequency, at 16
 * phases; of forces other than the plain pendulum's alone. Or it is found from neighbouring lines:
 * where a curve of bifurcations that was followed from another line crosses this one at a fold or a
 * symmetry breaking of orbits that can be SA or LA, and the line's branches have none there. A
 * branch that none of these guesses leads to, and none of the curves bounds, stays unknown. At 600
 * random points (pendulum and polynomials, with 48 members) 1600 starts over the plane found no
 * state that was missing.
 *
 * A diagram has two parameters. Its points lie on lines: along a line the drive frequency or the
 * drive amplitude changes, from line to line another parameter. pendres_phase_diagram_find()
 * computes all of it on one thread. A program that has threads of its own does the same in rounds:
 *
 *     pendres_phase_diagram_create(&grid, &diagram);
 *     while (pendres_phase_diagram_next(diagram, &round) == PENDRES_OK && round.tasks > 0)
 *       for each task below round.tasks, in any order, on any threads, each with its own context:
 *         pendres_phase_diagram_work(ctx, diagram, task, &size, &bytes);
 *         pendres_phase_diagram_take(diagram, task, size, bytes);   on one thread at a time
 *         free(bytes);
 *
 * SA and LA are named as everywhere: of the orbits of period one without winding that coexist, the
 * one of smallest amplitude is SA, the others are LA; a pair of mirror images counts as one state.
 * Where such an orbit is alone, its name follows from the fold of the line at which SA ends. Beyond
 * that fold it is LA; before it, it is SA if its amplitude is less than the fold's, else LA; on a
 * line without such a fold it has no name. With softening forces, such as the pendulum's, SA ends
 * at the upper end of its range, with stiffening ones at the lower end; the unstable orbit that it
 * meets there decides which. (A line by itself can miss that fold, if its members are on LA alone
 * and LA's branch does not lead to it.)
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
                                     it is SA or LA, too */
  PENDRES_OTHER_PERIODIC = 2,   /**< an orbit that closes after several drive periods */
  PENDRES_OTHER_RUNNING = 4,    /**< a rotation: an orbit that closes up to whole turns, with a
                                     winding that is not 0, or one without a lock to the drive */
  PENDRES_OTHER_CHAOTIC = 8,    /**< a chaotic attractor */
  PENDRES_OTHER_UNRESOLVED = 16, /**< some member did not settle within its budget */
  PENDRES_OTHER_ESCAPE = 32,    /**< some member escapes to infinity */
  PENDRES_OTHER_UNSTABLE = 64   /**< some member rests in an unstable state: only with a
                                     drive_amplitude of 0 */
} pendres_other;

/** One point of the diagram. Amplitudes are in rad, the loop area is the work of the drive in one
    of its periods, in m g l. Numbers of a state that does not exist are NaN. */
typedef struct pendres_phase_point {
  pendres_pendulum pendulum;  /**< the parameters there */
  pendres_regime regime;      /**< by the members that settled */
  pendres_regime exact;       /**< by the branches: which of SA and LA are known as attractors,
                                   PENDRES_REGIME_OTHER only where neither is. Known are states that
                                   members of the line reach, what is on branches through these and,
                                   but for the plain pendulum, on detached ones near free
                                   oscillations of the drive's frequency. Orbits of several drive
                                   periods are not looked for apart from members */
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
  size_t escaped;             /**< members that escape to infinity: their share is in no other */
} pendres_phase_point;

/** How the points of a line are computed. */
typedef struct pendres_phase_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  pendres_ensemble ensemble;   /**< whose members settle at every point */
  pendres_parameter parameter; /**< what changes along a line: PENDRES_DRIVE_FREQUENCY or
                                    PENDRES_DRIVE_AMPLITUDE */
  double spacing;              /**< distance in arclength between the points of a branch, as in
                                    pendres_branch_options; 0: the default */
} pendres_phase_options;

/* ---- Whole diagrams ---- */

/** The points of a diagram. A point has the number line * values + place on the line. */
typedef struct pendres_phase_grid {
  pendres_pendulum pendulum;    /**< the parameters that all points share */
  size_t values;                /**< points of a line */
  const double *value;          /**< [values] of the parameter along a line, ascending; not owned */
  pendres_parameter across;     /**< what changes from line to line: another parameter */
  size_t lines;                 /**< how many lines */
  const double *line_value;     /**< [lines] of the parameter across, ascending; not owned */
  pendres_phase_options options; /**< for all lines; its parameter changes along each. Last, since
                                      it may grow */
} pendres_phase_grid;

/** Opaque: the points of a grid, the branches of its lines, and the curves of bifurcations. */
typedef struct pendres_phase_diagram pendres_phase_diagram;

/**
 * A whole diagram on one thread. A point or line that cannot be computed is marked by its outcome;
 * the others are computed nevertheless.
 *
 * @param ctx  belongs to one thread at a time
 * @param grid read; copied but for the values, which must outlive the diagram
 * @param out  receives the diagram, to be freed by pendres_phase_diagram_free(); NULL on failure
 * @return PENDRES_INVALID_ARGUMENT if the grid is not valid, PENDRES_OUT_OF_MEMORY,
 *         PENDRES_INTERRUPTED
 */
pendres_status pendres_phase_diagram_find(pendres_context *ctx, const pendres_phase_grid *grid,
                                          pendres_phase_diagram **out);

/** Make a diagram of which nothing is computed yet. Arguments and errors are those of
    pendres_phase_diagram_find(); there is no context, and so no message. */
pendres_status pendres_phase_diagram_create(const pendres_phase_grid *grid,
                                            pendres_phase_diagram **out);
/** Free a diagram and all that it owns. NULL is allowed. */
void pendres_phase_diagram_free(pendres_phase_diagram *diagram);

/** Leave a point out: it is not computed, and its outcome is PENDRES_UNSUPPORTED. To be called
    before the point's line is computed. Returns PENDRES_INVALID_ARGUMENT if the diagram is NULL or
    has no such point. */
pendres_status pendres_phase_diagram_leave_out(pendres_phase_diagram *diagram, size_t point);

/** What the tasks of a round are. */
typedef enum pendres_phase_work {
  PENDRES_PHASE_DONE = 0,   /**< there are none: the diagram is complete */
  PENDRES_PHASE_LINES,      /**< a line each, by its members and their branches */
  PENDRES_PHASE_CURVES,     /**< a family of bifurcations each,
  the curves through which are followed;
                                 no curve through a bifurcation of one family leads to one of
                                 another. Families that take longer come first */
  PENDRES_PHASE_COMPLETION, /**< a line each, completed by the curves */
  PENDRES_PHASE_WORK_COUNT  /**< how many there are */
} pendres_phase_work;

/** A round: tasks that do not depend on each other. */
typedef struct pendres_phase_round {
  pendres_phase_work work; /**< what they are */
  size_t tasks;            /**< how many */
} pendres_phase_round;

/**
 * Begin the next round, when what the tasks of the last one have made is taken: the lines first,
 * then curves and the completion of lines in turns, until the lines show no bifurcation that was
 * not known, or all rounds are done. A line that was not taken stays as it was; families must all
 * be taken. No other thread may use the diagram meanwhile.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (also if a family was not taken), PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_phase_diagram_next(pendres_phase_diagram *diagram,
                                          pendres_phase_round *round);

/**
 * Do a task of the present round. The diagram is only read, so several threads may do different
 * tasks of it at once. What fails of a point, line or family alone is part of what is made: see
 * pendres_phase_diagram_outcome_get(). A line that cannot be completed stays as it was; if a curve
 * cannot be followed, the rest of its family is not followed either.
 *
 * @param ctx     belongs to one thread at a time
 * @param diagram read
 * @param task    number of the task
 * @param size    written: how many bytes
 * @param bytes   receives them, to be freed by free(), NULL on failure. They may be kept, and sent
 *                elsewhere; only the same build of the library can read them
 * @return what ends the whole computation: PENDRES_INVALID_ARGUMENT (no such task),
 *         PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED
 */
pendres_status pendres_phase_diagram_work(pendres_context *ctx,
                                          const pendres_phase_diagram *diagram, size_t task,
                                          size_t *size, void **bytes);

/** Take over what a task of the present round has made, in any order. No other thread may use the
    diagram meanwhile. Returns PENDRES_INVALID_ARGUMENT if there is no such task, a family was taken
    already, or the bytes are not those of such a task; PENDRES_OUT_OF_MEMORY. */
pendres_status pendres_phase_diagram_take(pendres_phase_diagram *diagram, size_t task, size_t size,
                                          const void *bytes);

/** A point, owned by the diagram; NULL if there is no such point. One without results has
    PENDRES_REGIME_OTHER as both regimes, and NaN as its numbers. */
const pendres_phase_point *pendres_phase_diagram_point_get(const pendres_phase_diagram *diagram,
                                                           size_t point);

/**
 * The outcome of a point: PENDRES_OK, or why it has no results, or has not been completed.
 * *message (may be NULL) receives a message, owned by the diagram; NULL where there is none.
 */
pendres_status pendres_phase_diagram_outcome_get(const pendres_phase_diagram *diagram, size_t point,
                                                 const char **message);

/** The branches of a line, owned by the diagram; NULL if there are none, or no such line. */
const pendres_branches *pendres_phase_diagram_branches_get(const pendres_phase_diagram *diagram,
                                                           size_t line);

/** What a diagram has found beside its points and branches; all of it is owned by the diagram, and
    holds until its next round begins. */
typedef struct pendres_phase_curves {
  const pendres_curves *curves; /**< through all bifurcations; NULL before any was followed */
  pendres_status outcome;       /**< of the curves, as for a point: where it is not PENDRES_OK there
                                     may be more curves than were found */
  const char *message;          /**< a sentence on that; NULL where there is none */
  size_t bifurcations;          /**< of the lines' branches: how many, ... */
  const pendres_bifurcation *bifurcation; /**< ... and which, line after line */
  const pendres_cusp *cusp;     /**< at which SA and LA become one: of several, the last on the way
                                     out of the region where both exist. NULL if none was found */
} pendres_phase_curves;

/** These results; all zero without a diagram. */
pendres_phase_curves pendres_phase_diagram_get(const pendres_phase_diagram *diagram);

/** Which state ends in a fold of the diagram, whose orbit and curvature are given (see
    pendres_bifurcation): PENDRES_LABEL_SA or PENDRES_LABEL_LA; PENDRES_LABEL_PERIODIC for orbits
    that can be neither. SA's lags less than the cusp's orbit where the resonance bends to lower
    values of the line's parameter, and more where it bends to higher ones; without a cusp the
    curvature decides. */
pendres_label pendres_phase_diagram_ending_get(const pendres_phase_diagram *diagram,
                                               const pendres_orbit *orbit, double curvature);

/** The fold of a line at which a state, PENDRES_LABEL_SA or PENDRES_LABEL_LA, ends: of several, the
    one with the largest value of the line's parameter, or with the smallest where the resonance
    bends to higher values. Owned by the diagram; NULL if there is none. */
const pendres_bifurcation *pendres_phase_diagram_fold_get(const pendres_phase_diagram *diagram,
                                                          size_t line, pendres_label state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
