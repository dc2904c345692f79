/**
 * @file hysteresis.h
 * @brief A pendulum whose parameter is moved so slowly that it always settles.
 *
 * Owns: following the state of a pendulum along any path of a parameter, as an experimenter does
 * who sweeps a frequency up and down; where the state ends, and which state the pendulum goes to
 * then.
 *
 * A stable periodic orbit is followed by continuation, so that the value at which it ends is that
 * of a bifurcation, located to the tolerance, and not that of the next step. At a period doubling
 * or a symmetry breaking at which a stable orbit is born, or a branch point at which another takes
 * over the stability, the pendulum goes over to that orbit without a jump. Everywhere else it
 * jumps. PENDRES_HYSTERESIS_TRIALS pendulums then start from the
 * orbit that ends, with the parameter beyond the bifurcation by a ten-thousandth or a
 * hundred-thousandth of its scale (0.3 for the drive frequency, 0.1 for others), and the pendulum
 * goes to the state that most of them reach. How long a pendulum stays near a fold depends on the
 * distance beyond it; the distances of the trials vary by enough for them to leave at every phase
 * of a period. Where they do not all reach the same state, the outcome depends on distances that no
 * experiment controls, and the jump is marked as uncertain.
 *
 * From a chaotic state the pendulum is settled anew at each value, starting from its present state.
 * If it has come to a periodic orbit, or has escaped, the interval is halved until the value at
 * which it first does so is found. If the orbit, or one that it is born from by doublings or a
 * loss of symmetry, is born there, in a window of the chaos, and most trials go to it just behind
 * its birth, from states of the chaos just before it, its birth is where the chaos ends. If its
 * period doubles again and again towards the chaos, that ends where the doublings accumulate
 * (cascade.h), and the pendulum goes through them backwards. If the orbit is there on both sides,
 * or if the pendulum escapes, the chaos ends in a crisis. Next to a crisis chaos lasts long before
 * it ends: the error includes how far beyond it chaos may have been taken to last, from the lives
 * of 32 pendulums at two distances. The orbit is then followed. If orbits and chaos have alternated
 * four times in one interval, the end of chaos is only known to lie in the rest of it. A pendulum
 * that has escaped to infinity does not return on the rest of the path. Chaos that becomes wider or
 * narrower without an end is no jump.
 *
 * An orbit whose computation stops, after so many points or in too short steps, is followed anew
 * from where that was, or, where this leads no further, settled at the next value. If that is
 * another orbit, the interval is halved as below.
 *
 * A value that cannot be computed is left out, and the path goes on as if it had never been there.
 * This happens where too many steps are needed, an iteration fails, or the value would take more
 * than 3e9 evaluations of the slope, some ten seconds to a minute, or the search for the end of
 * chaos before it would. Values that are far apart cost more than a path in smaller steps.
 *
 * Under a torque and a drive, or both drives, the pendulum may rotate without a lock to the drive.
 * States that are no periodic orbits are then identified by averages, as quasi-periodic or chaotic,
 * by the criteria of lyapunov.h. A trial in which averages cannot decide, since a rotation slips
 * only once in thousands of periods, say, or one of any pendulum that has not settled, is repeated
 * with the parameter ten times as far beyond the bifurcation, up to three times.
 *
 * Such a rotation lies on an invariant circle, a closed curve around the cylinder of states, which
 * persists where the rotation locks to the drive in narrow steps and unlocks again. Where the
 * circle can be followed nothing else is integrated: mean velocities, locks, and the ends of locks
 * follow from the map of a period on the circle. If the orbit of a fold lies on the circle, the
 * pendulum goes over to the rotation there without any trials. The error of a mean velocity
 * consists of the scatter among four orbits of the map, and of the error of the map with the factor
 * by which the motion amplifies it. Points so close to the end of a lock that the error of the map
 * hides it are unresolved. Where the circle is not smooth enough, as before it breaks up, averages
 * over the pendulum's own periods are used, as above.
 *
 * Without a drive, under a torque alone, a pendulum is at rest or rotates with a period of its own
 * (rotation.h). Such a rotation is PENDRES_LABEL_RUNNING, with a mean velocity and no period in
 * drive periods; at most values it is interpolated, by polynomials whose last coefficients are part
 * of the error. A pendulum comes to it from the fold at a torque of 1, beyond which there is no
 * equilibrium, or from a start that passes the upper equilibrium. It ends at the least torque, or
 * at the damping for which the pendulum's torque is the least one, by a homoclinic connection
 * or a fold.
 *
 * Sources: Calleja, Celletti and de la Llave, Journal of Differential Equations 255 (2013) 978;
 * Hirsch, Pugh and Shub, Invariant Manifolds (Springer, 1977), for circles. Kuznetsov, Elements of
 * Applied Bifurcation Theory, chapter 4; Thompson and Soliman, Proceedings of the Royal Society A
 * 432 (1991) 101, for jumps whose outcome is uncertain.
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
  PENDRES_HYSTERESIS_TRIALS = 16, /**< pendulums that tell where a jump leads */
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
                                    quasi-periodic rotations a bound; else it holds with a
                                    confidence of 99.9 % */
  int certain;                 /**< 1: no error of the integration can have chosen the state on
                                    which the path began (each jump on the way has a mark of its
                                    own); 0 also if unresolved */
  pendres_status outcome;      /**< PENDRES_OK; else why the path left the value out:
                                    PENDRES_TOLERANCE_UNREACHABLE, PENDRES_INTEGRATION_FAILED,
                                    PENDRES_NOT_CONVERGED, PENDRES_UNRESOLVED (the way there takes
                                    too much work); or did not reach it: PENDRES_INTERRUPTED */
} pendres_hysteresis_point;

/** One list makes the codes and their names: X(code, name). Codes stay: files have them. */
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
 * pair is born and takes the state's place: a rotation on a circle locks to the drive, chaos ends
 * in a window;
 * PENDRES_JUMP_FLIP: period doubling or, of chaos, the place where doublings accumulate;
 * PENDRES_JUMP_SYMMETRY: loss of mirror symmetry;
 * PENDRES_JUMP_OTHER: it ends within the error of the value, for a reason that is not known;
 * PENDRES_JUMP_BRANCH_POINT: the orbit meets another branch and exchanges its stability with that
 * (transcritical); PENDRES_JUMP_CRISIS: a chaotic attractor meets an unstable orbit, or its stable
 * manifold; PENDRES_JUMP_HOMOCLINIC: a rotation without a drive meets the upper equilibrium.
 * PENDRES_JUMP_COUNT: how many there are.
 *
 * All of these are ends of states: a state is never said to end because a computation did. Where
 * that could not go on, points are marked by their outcome, and there is no jump.
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
} pendres_jump;

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
pendres_status pendres_hysteresis_follow(pendres_context *ctx, const pendres_pendulum *p,
                                         const pendres_state *start,
                                         const pendres_hysteresis_path *path,
                                         pendres_hysteresis **out);
/** Free what was met; NULL is allowed. */
void pendres_hysteresis_free(pendres_hysteresis *h);

/** As many points as the path has values. */
size_t pendres_hysteresis_count(const pendres_hysteresis *h);
/** Point number i, owned by h; NULL out of range. */
const pendres_hysteresis_point *pendres_hysteresis_get(const pendres_hysteresis *h, size_t i);
/** How many jumps there are. */
size_t pendres_hysteresis_jumps(const pendres_hysteresis *h);
/** Jump number i in the order of the path, owned by h; NULL out of range. */
const pendres_jump *pendres_hysteresis_jump(const pendres_hysteresis *h, size_t i);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
