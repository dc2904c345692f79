/**
 * @file hysteresis.h
 * @brief A pendulum whose parameter is moved so slowly that it always settles.
 *
 * Owns: following the state of a pendulum along any path of a parameter, as an experimenter does
 * who sweeps a frequency up and down; where the state ends, and which state the pendulum goes to
 * then.
 *
 * A stable periodic orbit is followed by continuation to the bifurcation that ends it, which is
 * located to the tolerance; PENDRES_HYSTERESIS_TRIALS pendulums just beyond it decide where a
 * pendulum jumps to. From chaos the pendulum is settled again at each value, and rotations that are
 * not locked to the drive are averaged side by side. docs/sweeps.md describes the method.
 *
 * A value that cannot be computed is left out, and the path continues as if it had not been given.
 * A pendulum that has escaped to infinity does not return on the rest of the path.
 *
 * A path keeps states (pendres_context_set_keep()): the points so far and what it needs to go on, a
 * kilobyte or two a point.
 *
 * Sources: Das, Saiki, Sander and Yorke, Nonlinearity 30 (2017) 4111, for averages. Kuznetsov,
 * Elements of Applied Bifurcation Theory, chapter 4; Thompson and Soliman, Proceedings of the Royal
 * Society A 432 (1991) 101, for jumps whose outcome is uncertain.
 */
#ifndef PENDRES_HYSTERESIS_H
#define PENDRES_HYSTERESIS_H

#include <pendres/attractor.h>
#include <pendres/continuation.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum {
  PENDRES_HYSTERESIS_TRIALS = 16, /**< pendulums that decide where a jump leads */
  PENDRES_HYSTERESIS_PERIOD = 64  /**< orbits of longer periods are not followed by continuation */
};

/** The state at one value of the path. */
typedef struct pendres_hysteresis_point {
  double value;                /**< of the parameter */
  pendres_attractor attractor; /**< its label is UNRESOLVED, and its numbers NaN, where it could not
                                    be found; its trapping ellipse is not determined (NaN) on
                                    stretches that were followed */
  double x;                    /**< position at drive phase 0: a state that the pendulum is in
                                    there, on its attractor as far as that is reached, ... */
  double v;                    /**< ... and the velocity */
  double mean_velocity;        /**< of x, in rad per unit time */
  double mean_velocity_error;  /**< its error: rounding of closed orbits, whose mean is exact; of
                                    quasi-periodic rotations a bound; otherwise it holds with a
                                    confidence of 99.9 % */
  int certain;                 /**< 1: no error of the integration can have chosen the state on
                                    which the path began (each jump on the way has a mark of its
                                    own); 0 also if unresolved */
  pendres_status outcome;      /**< PENDRES_OK; otherwise why the path left the value out:
                                    PENDRES_TOLERANCE_UNREACHABLE, PENDRES_INTEGRATION_FAILED,
                                    PENDRES_NOT_CONVERGED, PENDRES_UNRESOLVED (the way there takes
                                    too much work, or a state that has not ended can be followed no
                                    further, and does not settle there); or did not reach it:
                                    PENDRES_INTERRUPTED */
} pendres_hysteresis_point;

/** The codes and their names in one list: X(code, name). Codes must not change: files have them. */
#define PENDRES_JUMP_LIST(X)      \
  X(FOLD, "fold")                 \
  X(FLIP, "flip")                 \
  X(SYMMETRY, "symmetry")         \
  X(OTHER, "other")               \
  X(BRANCH_POINT, "branch_point") \
  X(CRISIS, "crisis")             \
  X(HOMOCLINIC, "homoclinic")

/**
 * How a state ends. PENDRES_JUMP_FOLD: the orbit meets an unstable one, and both vanish, or such a
 * pair is born and takes the state's place: a rotation locks to the drive, chaos ends
 * in a window;
 * PENDRES_JUMP_FLIP: period doubling or, of chaos, the place where doublings accumulate;
 * PENDRES_JUMP_SYMMETRY: loss of mirror symmetry;
 * PENDRES_JUMP_OTHER: it ends within the error of the value, for a reason that is not known;
 * PENDRES_JUMP_BRANCH_POINT: the orbit meets another branch and exchanges its stability with that
 * (transcritical); PENDRES_JUMP_CRISIS: a chaotic attractor meets an unstable orbit, or its stable
 * manifold, and ends or, if what follows is chaotic too, suddenly becomes larger or, the other way,
 * smaller; PENDRES_JUMP_HOMOCLINIC: a rotation without a drive meets the upper equilibrium.
 * PENDRES_JUMP_COUNT: how many there are.
 *
 * All of these are ends of states: a state is never reported to end because a computation stopped.
 * Where that could not continue, points are marked by their outcome, and there is no jump.
 */
typedef enum pendres_jump_kind {
#define PENDRES_JUMP_CODE(code, name) PENDRES_JUMP_##code,
  PENDRES_JUMP_LIST(PENDRES_JUMP_CODE)
#undef PENDRES_JUMP_CODE
  PENDRES_JUMP_COUNT /**< how many there are; not a kind */
} pendres_jump_kind;

/** The end of a state. */
typedef struct pendres_jump {
  size_t step;               /**< between point step - 1 and point step of the path */
  int direction;             /**< 1: the parameter grows, -1: it falls */
  pendres_jump_kind kind;    /**< how the state ends */
  double value;              /**< of the parameter. For OTHER, unless a bifurcation or the end of a
                                  rotation was found to be the end, it was halved down to, and the
                                  error is half of what is left: somewhere therein the pendulum
                                  leaves */
  double value_error;        /**< its error */
  pendres_label from;        /**< label of the state that ends */
  pendres_label to;          /**< label of the state that the pendulum goes to */
  int to_period;             /**< drive periods of the orbit that it goes to; 0: none that closes */
  int gradual;               /**< 1: goes over to the orbit born there, which grows from nothing. At
                                  a loss of symmetry two orbits that are mirror images are born;
                                  chance decides between them, and one is taken */
  double share;              /**< of the trials that went there; 1 if gradual; NaN if not tried */
  double share_error;        /**< its standard error */
  int certain;               /**< 1: all of them did, mirror images not being told apart */
  int to_winding;            /**< whole turns of the orbit that it goes to in to_period drive
                                  periods; 0 if none closes */
} pendres_jump;

/** The codes and their names in one list: X(code, name). Codes must not change: files have them. */
#define PENDRES_STEP_END_LIST(X) \
  X(LEFT, "left")                \
  X(SEEN, "seen")                \
  X(RANGE, "range")

/**
 * What is known of an end of a step. PENDRES_STEP_END_LEFT: the lock ends there, the pendulum
 * leaves it in a jump; PENDRES_STEP_END_SEEN: it was met no further, since the path came to it
 * there from elsewhere, or lost sight of it; the lock may go on; PENDRES_STEP_END_RANGE: the
 * path's values go no further. PENDRES_STEP_END_COUNT: how many there are.
 */
typedef enum pendres_step_end {
#define PENDRES_STEP_END_CODE(code, name) PENDRES_STEP_END_##code,
  PENDRES_STEP_END_LIST(PENDRES_STEP_END_CODE)
#undef PENDRES_STEP_END_CODE
  PENDRES_STEP_END_COUNT /**< how many there are; not an end */
} pendres_step_end;

/**
 * A step: an interval of the parameter throughout which a path has met rotations that are locked to
 * the drive with the same mean velocity, omega winding / period. Under a torque, the current of a
 * Josephson junction, these are Shapiro steps. Doublings of the period are not ends, nor is it one
 * that another orbit of the same mean velocity takes over.
 */
typedef struct pendres_step {
  int winding;                /**< whole turns ... */
  int period;                 /**< ... in so many drive periods, without a common factor */
  pendres_step_end lower_end; /**< what is known of the lower end, ... */
  pendres_step_end upper_end; /**< ... and of the upper one */
  double lower;               /**< the least value of the parameter at which it was met */
  double lower_error;         /**< its error, that of a jump; 0 of a value of the path */
  double upper;               /**< the largest */
  double upper_error;         /**< its error */
  double width;               /**< upper - lower, if both ends are LEFT; else NaN, the step being
                                   wider than that or as wide */
  double width_error;         /**< its error, the sum of both; NaN if there is no width */
} pendres_step;

/** Values of a parameter in the order in which they are reached: each is approached from the one
    before, slowly and monotonically. A sweep up and down is a list that ascends and then
    descends. */
typedef struct pendres_hysteresis_path {
  pendres_parameter parameter; /**< what moves */
  size_t n;                    /**< how many values */
  const double *value;         /**< [n], not kept */
} pendres_hysteresis_path;

/** Opaque: the states and jumps along a path. */
typedef struct pendres_hysteresis pendres_hysteresis;

/**
 * Follow the state that pendulum `p` settles on from a state at drive phase 0 along a path. p's own
 * value of the parameter is not read.
 *
 * Orbits of one drive period are named SA and LA where two of them are met at the same value of the
 * path, by amplitude, and keep their names along the whole stretch that is followed; elsewhere they
 * are named as pendres_label says.
 *
 * Points that were left out have an outcome that says why, and nothing else.
 *
 * p, start and path are read. *out is to be freed by pendres_hysteresis_free; NULL on failure, but
 * for PENDRES_INTERRUPTED on the way: then it has what was met until then, and the points that were
 * not reached are unresolved, with NaN for x and v.
 * Errors: PENDRES_INVALID_ARGUMENT (the message says which), PENDRES_OUT_OF_MEMORY,
 * PENDRES_INTERRUPTED, those of the integration. PENDRES_OK also where some points are unresolved.
 * Thread safety: as for the context.
 */
pendres_status pendres_hysteresis_find(pendres_context *ctx, const pendres_pendulum *p,
                                       const pendres_state *start,
                                       const pendres_hysteresis_path *path,
                                       pendres_hysteresis **out);
/**
 * The same for a picture: states at the values of the path alone, without jumps. Chaos is not asked
 * where it ends or grows, and of doublings only the first ones are followed: what the pendulum goes
 * to is met at the next value. Where several states attract it may there be another one than if
 * every end on the way were found. Steps have no ends that are known better than by these values.
 * Arguments, errors and thread safety: as of pendres_hysteresis_find.
 */
pendres_status pendres_hysteresis_states_find(pendres_context *ctx, const pendres_pendulum *p,
                                              const pendres_state *start,
                                              const pendres_hysteresis_path *path,
                                              pendres_hysteresis **out);
/** Free a path; NULL is allowed. */
void pendres_hysteresis_free(pendres_hysteresis *h);

/** As many points as the path has values. */
size_t pendres_hysteresis_count(const pendres_hysteresis *h);
/** Point number i, owned by h; NULL out of range. */
const pendres_hysteresis_point *pendres_hysteresis_get(const pendres_hysteresis *h, size_t i);
/** How many jumps there are. */
size_t pendres_hysteresis_jump_count(const pendres_hysteresis *h);
/** Jump number i in the order of the path, owned by h; NULL out of range. */
const pendres_jump *pendres_hysteresis_jump_get(const pendres_hysteresis *h, size_t i);
/** How many steps were met; none where the coordinate has no period (see pendres_model). */
size_t pendres_hysteresis_step_count(const pendres_hysteresis *h);
/** Step number i by mean velocity, then by value, owned by h; NULL out of range. */
const pendres_step *pendres_hysteresis_step_get(const pendres_hysteresis *h, size_t i);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
