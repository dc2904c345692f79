/**
 * @file attractor.h
 * @brief The attractors on which pendulums settle, and checks that they do.
 *
 * Owns: the set of attractors of one parameter set, their trapping ellipses, and the labels of
 * pendulums.
 *
 * A pendulum has settled when it is inside an attractor's trapping ellipse: every state in
 * there goes to that attractor. The stroboscopic map is a homeomorphism of the plane, so
 * when the ellipse's edge lies in the basin, all of its inside does (Jordan curve theorem);
 * rings of pendulums on the edge are integrated to check that. This is a check, not a proof. The 16
 * to 48 points of a ring must all come into a smaller ellipse that is known already, and stay less
 * than a radius apart on the way. Between two of them the image of the edge may depart from its
 * chord by a quarter of the sum of the departures of its tangents at both ends (difference
 * quotients). The known ellipse must hold that, too; otherwise points are added in between, or the
 * ring is given up. If the image were the cubic through both ends with these tangents this would be
 * a bound, about twice the departure of the cubic. On the smallest ring, where the map is nearly
 * linear, 12 points show the departure from the linear map, which is bounded between them in the
 * same way. What the check cannot see is a tongue of another basin that enters and leaves the ring
 * between two points and is too narrow to show in the tangents there, and errors of the integration
 * above the margin of a twentieth of the radius.
 * A rotation that closes after no drive period has an annulus around the cylinder of states in an
 * ellipse's place; the images of its edges are checked likewise.
 * What has not settled within its budget of periods is unresolved, never guessed.
 *
 * The error of the integration is propagated with each pendulum. Only if it is small against the
 * ellipse, and was small on the way, is the label certain (pendres_settled.certain); pendulums for
 * which it is not are integrated again, more and more exactly, down to rounding.
 *
 * Attractors are numbered by amplitude, then by their Poincaré point, never by the order in which
 * they were found; chaos follows closed orbits, and rotations that do not close are last.
 */
#ifndef PENDRES_ATTRACTOR_H
#define PENDRES_ATTRACTOR_H

#include <pendres/context.h>
#include <pendres/orbit.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/**
 * Labels. Of the orbits of one drive period without winding that coexist at a pendulum's
 * parameters, the one of smallest amplitude is SA, those of larger amplitude are LA, whatever the
 * drive; a pair of mirror images counts as one, where there is mirror symmetry. A single orbit
 * continues one of the two if both coexist at other parameters, which cannot be decided from one
 * set of parameters. With the weak drives of the paper (|F0| <= 0.25) it is SA if its phase lag is
 * less than pi/3 (or it is at rest), otherwise LA, which is equivalent; with stronger ones it is
 * PERIODIC until pendres_response_label() or a phase diagram has compared it with its neighbours.
 */
typedef enum pendres_label {
  PENDRES_LABEL_SA = 0,         /**< small amplitude */
  PENDRES_LABEL_LA = 1,         /**< large amplitude */
  PENDRES_LABEL_PERIODIC = 2,   /**< any other closed orbit, or one without a name */
  PENDRES_LABEL_RUNNING = 3,    /**< closes up to whole turns: winding not 0; without a drive
                                     also in a period of its own, with orbit.period 0 */
  PENDRES_LABEL_CHAOTIC = 4,    /**< positive largest Lyapunov exponent */
  PENDRES_LABEL_UNRESOLVED = 5, /**< did not settle within its budget of drive periods */
  PENDRES_LABEL_ESCAPE = 6,     /**< on its way to infinity and too far out to return, or growing
                                     without bound under a linear force: not an attractor */
  PENDRES_LABEL_QUASI_PERIODIC = 7, /**< a rotation that is not locked to the drive within 128
                                         periods */
  PENDRES_LABEL_UNSTABLE = 8,   /**< at rest in an unstable state, without a drive: it began there,
                                     or on its stable side, and never leaves. With a drive rounding
                                     leads away from every unstable orbit */
  PENDRES_LABEL_COUNT           /**< how many there are; not a label */
} pendres_label;

/** An attractor of one parameter set. */
typedef struct pendres_attractor {
  pendres_label label;      /**< its label */
  pendres_orbit orbit;      /**< for a chaotic attractor its pendulum and means over a drive cycle:
                                 loop_area, dissipation, mean_power, and amplitude (half peak to
                                 peak within a cycle, cycles from drive phases 0 and pi on), with
                                 errors that hold with a confidence of 99.9 %; the rest is NaN.
                                 For a rotation that does not close loop_area, dissipation and
                                 mean_power likewise, and x, v, one of its states at drive phase
                                 0; the rest is NaN. Both have period 0 */
  double trap_metric[3];    /**< P_yy, P_yw, P_ww of the trapping ellipse at the Poincaré point, in
                                 y = x and w = v/omega; largest semi-axis of P = 1 is one */
  double trap_radius;       /**< (z - z0)' P (z - z0) <= trap_radius^2 settles here */
  double lyapunov;          /**< largest Lyapunov exponent per unit time */
  double lyapunov_error;    /**< a standard error if chaotic; of closed orbits the multiplier's; 0
                                 of rotations that do not close, whose exponent is 0 */
  double drift;             /**< mean whole turns a drive period of what does not close; NaN of
                                 closed orbits */
  double drift_error;       /**< its error, of chaos with a confidence of 99.9 % */
  double watched_periods;   /**< drive periods, summed over replicas, for which a chaotic attractor
                                 was followed with none of them leaving it; NaN of others */
  double escape_rate_bound; /**< a chaotic motion that ended at a larger rate, a drive period, would
                                 have been seen to end with a probability of 95 %; smaller rates
                                 are not excluded; NaN of others */
} pendres_attractor;

/** Opaque: attractors of one or more parameter sets. */
typedef struct pendres_attractors pendres_attractors;

/** Free a set; NULL is allowed. */
void pendres_attractors_free(pendres_attractors *set);
/** How many attractors a set has; 0 for NULL. */
size_t pendres_attractors_count(const pendres_attractors *set);
/** How many of them parameter set number i has; 0 out of range. */
size_t pendres_attractors_count_of(const pendres_attractors *set, size_t i);
/** Attractor number i; owned by the set. NULL out of range. */
const pendres_attractor *pendres_attractors_get(const pendres_attractors *set, size_t i);

/** Instead of the number of an attractor. */
enum {
  PENDRES_ATTRACTOR_UNKNOWN = -1, /**< unresolved */
  PENDRES_ATTRACTOR_ESCAPED = -2, /**< on the way to infinity, not on an attractor */
  PENDRES_ATTRACTOR_UNSTABLE = -3 /**< at rest in an unstable state, not on an attractor */
};

/**
 * What a pendulum settles on: the one answer of pendres_settle(), pendres_attractors_settle() and
 * pendres_lyapunov_find(). Plain data.
 *
 * It has escaped where the force drives it outwards for ever, whatever the drive does: for |b| < 1
 * to the right, with phi(x) = -f(x), beyond an X such that for all x >= X phi(x) > 0 and
 * phi(x) (1 - |b|) + I - |F0| > 0, and v >= 0; to the left likewise. There v cannot fall below 0
 * again, since at v = 0 the acceleration is positive, and x goes to infinity. X comes from the
 * force's model (pendres_model, `outward`): for a polynomial it is Fujiwara's bound of the zeros of
 * both expressions, for a force with a header of its own the value that this gives; without it
 * there are no escapes. Under a linear force, a polynomial with a1 only, all motions have the same
 * Floquet multipliers. If one of these is larger than 1 by more than its error, as in a tongue of
 * parametric resonance, all pendulums have escaped before their first period, including those
 * exactly on the unstable orbit, which are not distinguished.
 */
typedef struct pendres_settled {
  pendres_label label;   /**< that of its attractor; ESCAPE, UNSTABLE or UNRESOLVED if there is
                              none */
  int attractor;         /**< index in the set, or PENDRES_ATTRACTOR_UNKNOWN (also where there is no
                              set), PENDRES_ATTRACTOR_ESCAPED or PENDRES_ATTRACTOR_UNSTABLE */
  long well;             /**< well that it settled in; 0 for running and chaotic ones, and without a
                              set */
  long settling_periods; /**< drive periods until it was inside the ellipse or, with weak
                              damping, a larger region about it, or had escaped; without a set until
                              its strobe points repeated; -1: unresolved, unstable, or not known */
  int certain;           /**< 1: no error of the integration could have led it elsewhere; 0 also if
                              unresolved */
  int period;            /**< q, drive periods until the orbit closes; 0 of others */
  int winding;           /**< p, whole turns in them; 0 of others */
  double exponent;       /**< largest Lyapunov exponent per unit time; NaN where there is none */
  double exponent_error; /**< of orbits their multiplier's, else one standard error; of rotations
                              that do not close, whose exponent is exactly 0, this is 0, too */
  double rotation;       /**< mean whole turns a drive period; NaN where there are none */
  double rotation_error; /**< its error; of quasi-periodic rotations a bound, of a chaotic attractor
                              with a confidence of 99.9 % */
} pendres_settled;

/**
 * Find the attractors of one parameter set from n initial guesses x[n], v[n] at drive phase 0 (n =
 * 0: a built-in set of 36 over a turn, and 36 in each well of another force that has a barrier; an
 * attractor with a small basin may be missed). *out is to be freed by pendres_attractors_free.
 * PENDRES_OK also if an initial guess stayed unresolved.
 */
pendres_status pendres_attractors_find(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                       const double *x, const double *v,
                                       pendres_attractors **out);

/**
 * Label n pendulums of the parameter set that `set` was found for. Only attractors in the set
 * are known: pendulums that go elsewhere are unresolved. outcome[n] is written.
 */
pendres_status pendres_attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                         size_t n, const double *x, const double *v,
                                         pendres_settled *outcome);

/**
 * A point at drive phase 0 on attractor number i of a set of one parameter set: that of a closed
 * orbit, one of a rotation, or of a chaotic attractor a state of one of the pendulums that have
 * told it. *out is written on PENDRES_OK.
 *
 * Errors: PENDRES_INVALID_ARGUMENT. Thread safety: as for the context.
 */
pendres_status pendres_attractors_point_find(pendres_context *ctx, const pendres_attractors *set,
                                             size_t i, pendres_state *out);

/**
 * Largest modulus of a Floquet multiplier of any closed orbit in a set: that of the attractor which
 * pendulums approach most slowly. NaN if there is none.
 */
double pendres_attractors_weakest_multiplier(const pendres_attractors *set);

/**
 * What each of n pendulums settles on, whatever their parameters. Equal consecutive parameters
 * make one parameter set; attractors are found from the pendulums themselves. outcome[n] is
 * written. *found (may be NULL) receives all attractors, set after set in the order of
 * the pendulums; to be freed by pendres_attractors_free.
 * With x, v and outcome NULL each pendulum starts from all states of the built-in set of
 * pendres_attractors_find(), and what they settle on is found: for many parameter sets at once,
 * which share blocks. Averages of chaos then end as soon as it is known to last, whatever
 * exponent_error asks for.
 * PENDRES_OK also when some are unresolved: their outcome says so.
 */
pendres_status pendres_settle(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                              const double *x, const double *v, pendres_settled *outcome,
                              pendres_attractors **found);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
