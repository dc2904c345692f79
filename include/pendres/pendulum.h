/**
 * @file pendulum.h
 * @brief The models: a damped, driven pendulum, its relatives, and exact neighbours.
 *
 * Owns: the equation of motion, its Jacobian, energy, wells and mirror
 * symmetry, and two limits with closed forms: the driven harmonic oscillator
 * and the free pendulum (elliptic integrals).
 *
 * Equation (Kharkongor and Mahato, eq. 2.1, with thermal noise added):
 *
 *     x'' + damping x' - cos x = drive_amplitude cos(drive_frequency t)
 *                                + sqrt(2 damping temperature) xi(t)
 *
 * and, with other friction, a constant torque, a parametric drive, and any force f,
 *
 *     x'' + damping x' + nonlinear_damping x^2 x' + quadratic_damping x' |x'| + cubic_damping x'^3
 *       + f(x) (1 + parametric_amplitude cos(drive_frequency t))
 *       = torque + drive_amplitude cos(drive_frequency t)
 *
 * where f is -cos x, a polynomial a1 x + a2 x^2 + ... + a5 x^5, or one of PENDRES_FORCE_LIST.
 * Terms whose fields are zero are left out. A function that does not accept every model says so;
 * docs/models.md lists the equations of the literature that are among them.
 *
 * All quantities are dimensionless: times are in units of 1/omega_0, where omega_0 is the angular
 * frequency of small oscillations, energies and torques in units of m g l (mass, gravity, length).
 * With a polynomial they are in the caller's units, of any size (pendres_units_of).
 * The potential is V(x) = -sin x. Wells lie at x = pi/2 + 2 pi n (n is the well number), the
 * barrier tops, 2 above them, at x = -pi/2 + 2 pi n. The pendulum's angle is y = x - pi/2.
 * The mirror symmetry is y -> -y together with half a drive period's delay; that of other forces
 * may have another centre (pendres_model).
 *
 * Thread safety: all functions are pure. Only pendres_pendulum_check() tells whether parameters are
 * valid; the others give NaN or 0 where there is no such force.
 */
#ifndef PENDRES_PENDULUM_H
#define PENDRES_PENDULUM_H

#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** Forces that have a header of their own: X(code, name). src/model/forces.h describes how to add
    another one. */
#define PENDRES_FORCE_LIST(X) \
  X(SQUID, squid)

/**
 * The force of a pendulum, -f(x) without drive. PENDRES_FORCE_SQUID: f = sin x + a1 x, a Josephson
 * junction in a superconducting ring.
 */
typedef enum pendres_force {
  PENDRES_FORCE_PENDULUM = 0,   /**< f = -cos x, with the period 2 pi */
  PENDRES_FORCE_POLYNOMIAL = 1, /**< f = a1 x + ... + a5 x^5, a_k = force_coefficients[k - 1] */
#define PENDRES_FORCE_CODE(code, name) PENDRES_FORCE_##code,
  PENDRES_FORCE_LIST(PENDRES_FORCE_CODE)
#undef PENDRES_FORCE_CODE
  PENDRES_FORCE_COUNT,          /**< how many there are; not a force */
  PENDRES_FORCE_FORMULA = 1 << 30 /**< from here on: formulas, by number (formula.h) */
} pendres_force;

/** Half a turn in radians; C has no name of its own for it. */
#define PENDRES_PI 3.14159265358979323846

enum {
  PENDRES_FORCE_COEFFICIENTS = 8, /**< most coefficients that a force may have */
  PENDRES_FORCE_POWERS = 5        /**< those that forces of this version use: a1 to a5 */
};

/**
 * Where a force drives a pendulum to infinity: a distance z0 from y = 0, to the right (side = 1) or
 * to the left (side = -1), such that the outward force -side f(side z) exceeds both `need` and 0 at
 * all distances z > z0. INFINITY where there is none.
 */
typedef double pendres_force_outward(const double *coefficients, double side, double need);

/**
 * Where a force less a torque is odd: the c of y = c + z for which f(c + z) - torque changes its
 * sign with z; if there are several, the one nearest to `near`. NaN if there is none. The test
 * allows for the rounding of the coefficients to doubles.
 */
typedef double pendres_force_centre(const double *coefficients, double torque, double near);

/** What all pendulums with the same force have in common. Constant data, owned by the library. */
typedef struct pendres_model {
  const char *name;  /**< in decks and messages: "pendulum", "polynomial", ... */
  double period;     /**< period of the coordinate x, 2 pi for the pendulum; 0: x has none */
  double origin;     /**< the origin of y = x - origin: pi/2 for the pendulum, 0 for a polynomial */
  int angle;         /**< 1: x is an angle, in rad; 0: a length in units of its own */
  int coefficients;  /**< how many coefficients it has, a1, ..., 0 to PENDRES_FORCE_POWERS */
  pendres_force_outward *outward; /**< gives the distance beyond which pendulums escape to infinity;
                                       NULL: none escape, or the distance is not known */
  pendres_force_centre *centre;   /**< gives the point about which it is odd; NULL: none */
  double beside;     /**< the force is the spring a1 y and a rest of at most this; 0: it is not */
} pendres_model;

/** The parameters of one pendulum. Where all fields after temperature are zero it is the plain
    pendulum. */
typedef struct pendres_pendulum {
  double damping;         /**< gamma >= 0, friction coefficient, in units of omega_0 */
  double drive_amplitude; /**< F0, any finite value, in m g l */
  double drive_frequency; /**< omega > 0, rad per unit time; also the clock of
                               the stroboscopic map when drive_amplitude is 0 */
  double temperature;     /**< T >= 0, k T in m g l; read only by functions that add noise */
  double torque;          /**< I, any finite value, in m g l: constant, added to the drive */
  double parametric_amplitude; /**< b, any finite value: f is multiplied by 1 + b cos(omega t) */
  pendres_force force;    /**< which force f it has */
  int unused;             /**< 0; instead of padding, so that equal pendulums have equal bytes */
  double force_coefficients[PENDRES_FORCE_COEFFICIENTS]; /**< a1, a2, ...: as many as the force has;
                                                              the others are zero */
  double nonlinear_damping; /**< eta >= 0: friction eta x^2 x'; not where x has a period */
  double quadratic_damping; /**< c >= 0: friction c x' |x'|, the drag of a fast flow */
  double cubic_damping;     /**< d >= 0: friction d x'^3 */
  double spare[3];          /**< 0 */
} pendres_pendulum;

/** A state of a pendulum at drive phase 0. */
typedef struct pendres_state {
  double x; /**< position, in rad */
  double v; /**< velocity, in rad per unit time */
} pendres_state;

/** What one canonical unit is in the units of a pendulum's parameters: both are powers of two. */
typedef struct pendres_units {
  double length; /**< of x */
  double time;   /**< of 1 / drive_frequency */
} pendres_units;

/**
 * The canonical units, in which a pendulum is computed whatever the units of its parameters are.
 * For a pendulum and a force with a sine both are 1. For a polynomial the length is the power of
 * two below the length at which its lowest term equals its highest, and the time the power of two
 * nearest to 1/sqrt(f'(x)) at that length. A lowest term is ignored if it is less than 2^-40 of
 * another at the length that follows from the others: it may be what rounding leaves of a
 * coefficient that passes through 0. For a single power, which has no such length, it is the length
 * at which it equals the larger of drive and torque or, without these, at which its rate equals the
 * damping; for a linear force without them it is 1. {1, 1} if p is NULL or has no valid force.
 *
 * Where this library speaks of lengths of order one, they are in this unit: context.h describes how
 * tolerances depend on it. Multiplying a problem's units by powers of two multiplies all of its
 * results by powers of two, and does not change their digits.
 */
pendres_units pendres_units_of(const pendres_pendulum *p);

/** What all pendulums with this force have in common; NULL if force is out of range. */
const pendres_model *pendres_model_of(pendres_force force);

/** 1 if p has the mirror symmetry, y -> 2 c - y half a drive period later: no parametric drive, and
    a force which minus the torque is odd about c. For the pendulum without a torque c = 0; for a
    polynomial it may be anywhere: a Duffing oscillator keeps its symmetry if its coordinate is
    shifted. 0 if p does not have it, or is NULL. */
int pendres_pendulum_symmetric(const pendres_pendulum *p);

/** 1 if the force of p drives it to infinity beyond some position, whatever the drives do: noise
    eventually carries such a pendulum there. 0 if p is NULL, if there is no such position, and if
    none is known: where |parametric_amplitude| >= 1 reverses the force, or a force in a header of
    its own has no `outward`. */
int pendres_pendulum_leaves(const pendres_pendulum *p);

/** 1 if p may rotate for ever without closing after whole drive periods: an angle under the
    pendulum's force, with a torque or both drives. A drive alone keeps up only rotations that are
    locked to it. 0 otherwise, and if p is NULL. */
int pendres_pendulum_rotates(const pendres_pendulum *p);

/** About the rate at which free motions of p lose their energy, which is the width of a resonance:
    the damping. Where it is 0 nothing settles; where it is small work takes long. A guess, by which
    to plan. NaN if p is NULL. */
double pendres_pendulum_decay_rate(const pendres_pendulum *p);

/**
 * Check parameters. On failure *why (if not NULL) becomes a static sentence that says what is wrong
 * with them. Returns PENDRES_OK or PENDRES_INVALID_ARGUMENT.
 */
pendres_status pendres_pendulum_check(const pendres_pendulum *p, const char **why);

/** Acceleration x'' at position x, velocity v, time t, without noise. NaN if p is NULL. */
double pendres_pendulum_acceleration(const pendres_pendulum *p, double x, double v, double t);

/**
 * Energy of p without its periodic drives: v^2/2 and the potential, the integral of f - torque:
 * -sin x - torque x, or a1 x^2/2 + ... + a5 x^6/6 - torque x, or that of another force. NaN if p is
 * NULL. The plain pendulum's barrier top has energy 1, a well's bottom -1.
 */
double pendres_pendulum_energy(const pendres_pendulum *p, double x, double v);

/** Closed form of the driven harmonic oscillator y'' + gamma y' + y = F0 cos(omega t). */
typedef struct pendres_harmonic {
  double amplitude; /**< of y, in rad */
  double phase_lag; /**< behind the force, 0 <= phase_lag <= pi: y has the sign of F0 times
                         amplitude cos(omega t - phase_lag) */
  double loop_area; /**< pi |F0| amplitude sin(phase_lag), a drive cycle, in m g l */
} pendres_harmonic;

/** Response of the harmonic oscillator with the damping, drive amplitude and drive frequency of p,
    whose other fields are only checked. Undamped at resonance the amplitude is infinite, the loop
    area NaN. Returns PENDRES_OK, or PENDRES_INVALID_ARGUMENT if p is not valid or out is NULL.
    Source: Landau and Lifshitz, Mechanics, section 26. */
pendres_status pendres_harmonic_find(const pendres_pendulum *p, pendres_harmonic *out);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
