/**
 * @file parameter.h
 * @brief The parameters of a pendulum by number: names, words, units, values.
 *
 * Owns: the one list of parameters. Axes of decks and of sweeps, dimensions of files, what orbits
 * are followed in, units and derivatives follow from its rows.
 *
 * Thread safety: all functions are pure.
 */
#ifndef PENDRES_PARAMETER_H
#define PENDRES_PARAMETER_H

#include <pendres/pendulum.h>
#include <pendres/quantity.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/*
 * One row makes a parameter:
 *
 *   ITEM(code, number, name, field, over, positive, kind, words, brief)
 *
 *   code, number   PENDRES_code = number; the first PENDRES_PARAMETER_FOLLOWED have derivatives in
 *                  the sensitivity equations, in this order
 *   field          where it stands, in a pendulum or in the state that it starts from
 *   over           0 or, of a parameter that is no field itself: field = over / parameter
 *   positive       1: it stays above 0
 *   kind           PENDRES_KIND_kind: its dimension and unit
 *   words, brief   what it is, for axes, and for columns of tables
 *
 * Where several of them are dimensions of results they are so in the order of these rows.
 */

/** Those that a plain pendulum has. */
#define PENDRES_PARAMETERS_PLAIN(ITEM)                                                           \
  ITEM(DRIVE_AMPLITUDE, 2, "drive_amplitude", pendulum.drive_amplitude, 0, 0, FORCE,             \
       "drive amplitude F0", "drive amplitude")                                                  \
  ITEM(DAMPING, 1, "damping", pendulum.damping, 0, 1, RATE, "friction coefficient gamma",        \
       "friction coefficient")                                                                   \
  ITEM(DRIVE_FREQUENCY, 0, "drive_frequency", pendulum.drive_frequency, 0, 1, FREQUENCY,         \
       "angular frequency of the drive", "drive frequency")                                      \
  ITEM(DRIVE_PERIOD, 13, "drive_period", pendulum.drive_frequency, 2.0 * PENDRES_PI, 1, TIME,    \
       "period of the drive", "drive period")

/** Those of other models, which are zero in a plain pendulum. */
#define PENDRES_PARAMETERS_OTHER(ITEM)                                                           \
  ITEM(TORQUE, 3, "torque", pendulum.torque, 0, 0, FORCE, "constant torque I", "torque")         \
  ITEM(PARAMETRIC_AMPLITUDE, 4, "parametric_amplitude", pendulum.parametric_amplitude, 0, 0,     \
       NUMBER, "amplitude b of the parametric drive", "amplitude of the parametric drive")       \
  ITEM(A1, 5, "a1", pendulum.force_coefficients[0], 0, 0, A1,                                    \
       "coefficient a1 of the force", "coefficient a1 of the force")                             \
  ITEM(A2, 6, "a2", pendulum.force_coefficients[1], 0, 0, A2,                                    \
       "coefficient a2 of the force", "coefficient a2 of the force")                             \
  ITEM(A3, 7, "a3", pendulum.force_coefficients[2], 0, 0, A3,                                    \
       "coefficient a3 of the force", "coefficient a3 of the force")                             \
  ITEM(A4, 8, "a4", pendulum.force_coefficients[3], 0, 0, A4,                                    \
       "coefficient a4 of the force", "coefficient a4 of the force")                             \
  ITEM(A5, 9, "a5", pendulum.force_coefficients[4], 0, 0, A5,                                    \
       "coefficient a5 of the force", "coefficient a5 of the force")                             \
  ITEM(NONLINEAR_DAMPING, 10, "nonlinear_damping", pendulum.nonlinear_damping, 0, 0,             \
       NONLINEAR_DAMPING, "coefficient eta of the friction eta x^2 x'", "nonlinear damping")     \
  ITEM(QUADRATIC_DAMPING, 11, "quadratic_damping", pendulum.quadratic_damping, 0, 0,             \
       QUADRATIC_DAMPING, "coefficient c of the friction c x' |x'|", "quadratic damping")        \
  ITEM(CUBIC_DAMPING, 12, "cubic_damping", pendulum.cubic_damping, 0, 0, CUBIC_DAMPING,          \
       "coefficient d of the friction d x'^3", "cubic damping")

/** Noise, and the state at drive phase 0 that a pendulum starts from. */
#define PENDRES_PARAMETERS_REST(ITEM)                                                            \
  ITEM(TEMPERATURE, 14, "temperature", pendulum.temperature, 0, 0, TEMPERATURE,                  \
       "temperature k T / (m g l)", "temperature")                                               \
  ITEM(X, 15, "x", state.x, 0, 0, POSITION, "initial position", "initial position")              \
  ITEM(V, 16, "v", state.v, 0, 0, VELOCITY, "initial velocity", "initial velocity")

/** All of them. */
#define PENDRES_PARAMETER_LIST(ITEM) \
  PENDRES_PARAMETERS_PLAIN(ITEM) PENDRES_PARAMETERS_OTHER(ITEM) PENDRES_PARAMETERS_REST(ITEM)

/**
 * A parameter. Orbits are followed in PENDRES_DRIVE_FREQUENCY: omega; PENDRES_DAMPING: gamma;
 * PENDRES_DRIVE_AMPLITUDE: F0; PENDRES_TORQUE: I; PENDRES_PARAMETRIC_AMPLITUDE: b; and, of a force
 * that has coefficients (a pendulum's has none), PENDRES_A1: a1, PENDRES_A2: a2, PENDRES_A3: a3,
 * PENDRES_A4: a4, PENDRES_A5: a5; PENDRES_NONLINEAR_DAMPING: eta, where x has no period;
 * PENDRES_QUADRATIC_DAMPING: c; PENDRES_CUBIC_DAMPING: d. These are the first
 * PENDRES_PARAMETER_FOLLOWED. Further PENDRES_DRIVE_PERIOD: 2 pi / omega; PENDRES_TEMPERATURE: T;
 * and of the start PENDRES_X: position, PENDRES_V: velocity.
 * PENDRES_PARAMETER_COUNT: how many there are.
 */
typedef enum pendres_parameter {
#define PENDRES_PARAMETER_CODE(code, number, name, field, over, positive, kind, words, brief) \
  PENDRES_##code = number,
  PENDRES_PARAMETER_LIST(PENDRES_PARAMETER_CODE)
#undef PENDRES_PARAMETER_CODE
#define PENDRES_PARAMETER_ONE(code, number, name, field, over, positive, kind, words, brief) +1
  PENDRES_PARAMETER_COUNT = PENDRES_PARAMETER_LIST(PENDRES_PARAMETER_ONE) /**< how many there are;
                                                                               not a parameter */
#undef PENDRES_PARAMETER_ONE
} pendres_parameter;

/** How many of them have derivatives. */
enum {
  PENDRES_PARAMETER_FOLLOWED = 13 /**< the numbers below have derivatives */
};

/** What there is to say of a parameter. Constant data, owned by the library. */
typedef struct pendres_parameter_info {
  const char *name;  /**< in decks and files, and of fields: "drive_frequency", "a1" */
  const char *words; /**< what it is: "angular frequency of the drive" */
  const char *brief; /**< the same in short: "drive frequency" */
  pendres_kind kind; /**< its dimension and unit */
  int positive;      /**< 1: it stays above 0; 0: it may have any sign, but for temperatures */
  int plain;         /**< 1: a plain pendulum has it; 0: it is zero there, or not of a pendulum */
  int coefficient;   /**< k of a coefficient a_k of the force; 0: it is none */
} pendres_parameter_info;

/** What there is to say of a parameter; NULL if out of range. */
const pendres_parameter_info *pendres_parameter_of(pendres_parameter parameter);

/** A pendulum's value of a parameter; NaN if either does not exist, and for the start's. */
double pendres_parameter_get(pendres_parameter parameter, const pendres_pendulum *pendulum);

/** Set a pendulum's value of a parameter; nothing happens if either does not exist, or for the
    start's, and no value is refused here. */
void pendres_parameter_set(pendres_parameter parameter, double value, pendres_pendulum *pendulum);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
