/**
 * @file rotation.h
 * @brief Rotations under a constant torque alone, and the least torque that sustains one.
 *
 * Without a drive, y'' + gamma y' + sin y = I (y = x - pi/2) is autonomous: its states are
 * equilibria and rotations with a period of their own, which the stroboscopic map of a drive does
 * not close. Here the angle takes the place of the time: along a rotation the velocity is a
 * function of the angle, v dv/dy = I - sin y - gamma v, and it closes where v has come back after a
 * turn. So the phase of the rotation is fixed by where the turn begins.
 *
 * One Floquet multiplier of a rotation is 1, the other exp(-gamma T) (Liouville): rotations are
 * stable and there is at most one each way. As the torque falls a rotation ends, in one of two
 * ways: at a torque below 1 in a homoclinic connection, on which the unstable manifold of the upper
 * equilibrium comes back to it after a turn; or, beyond a damping of 1.19, at a torque of exactly
 * 1, where the equilibria are born on it.
 *
 * Method: Taylor series of v in the angle, from the equilibrium on along its manifolds; for
 * rotations at a damping of 1 or more and a torque above 1 implicit collocation, since friction
 * leaves series no long steps there. Errors are twice the difference of two computations of
 * different order and step length, or panels, plus a bound for rounding: some units of the last
 * place, close to a homoclinic connection times the factor by which the slow passage is lengthened.
 *
 * Source: F. Tricomi, Annali della Scuola Normale Superiore di Pisa 2 (1933) 1; M. Urabe, Journal
 * of Science of the Hiroshima University A 18 (1955) 379; for small damping Melnikov's 4 gamma /
 * pi.
 */
#ifndef PENDRES_ROTATION_H
#define PENDRES_ROTATION_H

#include <pendres/pendulum.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** How rotations end as the torque falls. */
typedef enum pendres_rotation_end {
  PENDRES_ROTATION_HOMOCLINIC = 0, /**< in a connection of the upper equilibrium with itself */
  PENDRES_ROTATION_SADDLE_NODE,    /**< at a torque of 1: the equilibria are born on the rotation */
  PENDRES_ROTATION_END_COUNT       /**< how many there are; not an end */
} pendres_rotation_end;

/** The least torque with a rotation. Plain data. */
typedef struct pendres_rotation_onset {
  double torque;            /**< I, above 0: there is a rotation from there on, or beyond */
  double torque_error;      /**< its error; 0 at a saddle-node, where it is 1 exactly */
  pendres_rotation_end end; /**< what happens there */
} pendres_rotation_onset;

/** A rotation. Plain data. */
typedef struct pendres_rotation {
  double period;              /**< T, in which x grows or falls by 2 pi */
  double period_error;        /**< its error */
  double mean_velocity;       /**< of x, of the torque's sign: 2 pi / T */
  double mean_velocity_error; /**< its error */
  double v;                   /**< velocity at x = pi/2, the bottom of a well without torque */
  double v_error;             /**< its error */
  double multiplier;          /**< exp(-gamma T); the other one is 1 */
  double multiplier_error;    /**< its error */
} pendres_rotation;

/**
 * The least torque under which a pendulum rotates for ever, for a damping from 1e-9 to 100.
 * PENDRES_INVALID_ARGUMENT for other dampings or without out. Thread safe.
 */
pendres_status pendres_rotation_onset_find(double damping, pendres_rotation_onset *out);

/**
 * The rotation of p, which has the pendulum's force and neither drive nor parametric drive; its
 * drive frequency is not used, the damping lies between 1e-9 and 100.
 *
 * @param p   read
 * @param out written on PENDRES_OK
 * @param why may be NULL; on failure a static sentence, otherwise unchanged
 * @return PENDRES_NOT_FOUND if the torque is too small for one, PENDRES_INVALID_ARGUMENT. Thread
 * safe.
 */
pendres_status pendres_rotation_find(const pendres_pendulum *p, pendres_rotation *out,
                                     const char **why);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
