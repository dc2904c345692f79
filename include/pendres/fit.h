/**
 * @file fit.h
 * @brief Parameters of an oscillator from measured responses.
 *
 * Owns: the fit of a model's responses to data that were taken while one parameter was swept, up,
 * down, or both, at one or several values of another parameter: values of damping, drive, force and
 * of the scales of an instrument, with their covariance.
 *
 * The model is the orbit of one drive period that the oscillator is on: the curve of orbits is
 * followed along the axis, through its folds, and at a fold the state jumps to the next stable part
 * of the curve. Of a free decay it is the motion itself, from a state that is found as well.
 * Derivatives by the unknowns come from the equations of sensitivity along the curve or the motion;
 * no differences are taken. Where the model jumps, and where the data do, is compared as well:
 * docs/fit.md describes how a datum between the two counts.
 *
 * Method: least squares by Levenberg and Marquardt (GSL's gsl_multifit_nlinear), from several
 * starts. Source: Nocedal and Wright, Numerical Optimization, chapter 10; Moré, Lecture Notes in
 * Mathematics 630 (1978) 105; for the guesses the balance of the first harmonic: Nayfeh and Mook,
 * Nonlinear Oscillations, chapter 4.
 */
#ifndef PENDRES_FIT_H
#define PENDRES_FIT_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/orbit.h>
#include <pendres/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** What may be measured: X(code, name). Lengths are in the instrument's unit, times the scale. */
#define PENDRES_FIT_OBSERVABLE_LIST(X)                     \
  X(AMPLITUDE, "amplitude")                                \
  X(RMS, "rms")                                            \
  X(FIRST_HARMONIC, "first_harmonic_amplitude")            \
  X(PHASE_LAG, "phase_lag")                                \
  X(IN_PHASE, "in_phase")                                  \
  X(QUADRATURE, "quadrature")                              \
  X(LOOP_AREA, "loop_area")                                \
  X(DISPLACEMENT, "displacement")                          \
  X(MEAN_VELOCITY, "mean_velocity")                        \
  X(JUMP, "jump")                                          \
  X(RESONANCE, "resonance")                                \
  X(VELOCITY, "velocity_amplitude")                        \
  X(ACCELERATION, "acceleration_amplitude")                \
  X(TRANSMISSION_REAL, "transmission_real")                \
  X(TRANSMISSION_IMAGINARY, "transmission_imaginary")      \
  X(NOTCH_REAL, "notch_real")                              \
  X(NOTCH_IMAGINARY, "notch_imaginary")                    \
  X(REFLECTION_REAL, "reflection_real")                    \
  X(REFLECTION_IMAGINARY, "reflection_imaginary")

/**
 * An observable. AMPLITUDE: half the peak-to-peak; RMS: the root mean square of the distance from
 * the mean; FIRST_HARMONIC: its amplitude; PHASE_LAG: by which the first harmonic lags behind the
 * drive, in rad; IN_PHASE and QUADRATURE: R cos(lag) and R sin(lag) of it; LOOP_AREA: work of the
 * drive a cycle; of free decays DISPLACEMENT: from the bottom of the well, at a time; of junctions,
 * which are pendulums without a drive, over the torque, MEAN_VELOCITY: 0 at rest, and of rotations
 * 2 pi over their period, with their sign; JUMP: the value of the axis itself, in its unit, at
 * which the oscillator jumps while the axis goes that way; RESONANCE: the value of the axis at
 * which the first harmonic lags behind the drive by a quarter turn, whatever the direction;
 * VELOCITY and ACCELERATION: amplitudes of the first harmonics of these.
 *
 * Scattering parameters of an oscillator on a line, real and imaginary parts, with exp(i w t): r
 * being i w damping/F times the complex amplitude of the displacement, which is
 * 1/(1 + 2i Q (w - w0)/w0) next to a linear resonance, they are
 *   b (background_in_phase + i background_quadrature + r)   TRANSMISSION,
 *   b (1 - k (Q/Qc) (1 + i tan(coupling_phase)) r)          NOTCH, k = 1, and REFLECTION, k = 2,
 *   b = background_amplitude exp(i background_phase - 2 pi i delay (f - f_middle)),
 * where 1/Q = 1/Qi + 1/Qc, f are frequencies as in the data, and f_middle is half way between the
 * lowest and the highest of these. 1/Qc is the real part of a complex one: Khalil et al., Journal
 * of Applied Physics 111 (2012) 054510.
 * PENDRES_FIT_OBSERVABLE_COUNT: how many there are.
 */
typedef enum pendres_fit_observable {
#define PENDRES_FIT_OBSERVABLE_CODE(code, name) PENDRES_FIT_##code,
  PENDRES_FIT_OBSERVABLE_LIST(PENDRES_FIT_OBSERVABLE_CODE)
#undef PENDRES_FIT_OBSERVABLE_CODE
  PENDRES_FIT_OBSERVABLE_COUNT /**< how many there are; not an observable */
} pendres_fit_observable;

/** Scales of an instrument by name: X(code, name, neutral value). */
#define PENDRES_FIT_SCALE_LIST(X)                           \
  X(FREQUENCY_SCALE, "frequency_scale", 1.0)                \
  X(DRIVE_SCALE, "drive_scale", 1.0)                        \
  X(AMPLITUDE_SCALE, "amplitude_scale", 1.0)                \
  X(OFFSET, "offset", 0.0)                                  \
  X(PHASE_OFFSET, "phase_offset", 0.0)                      \
  X(BACKGROUND_IN_PHASE, "background_in_phase", 0.0)        \
  X(BACKGROUND_QUADRATURE, "background_quadrature", 0.0)    \
  X(START_DISPLACEMENT, "start_displacement", 0.0)          \
  X(START_VELOCITY, "start_velocity", 0.0)                  \
  X(TORQUE_SCALE, "torque_scale", 1.0)                      \
  X(INTERNAL_Q, "internal_q", INFINITY)                     \
  X(COUPLING_Q, "coupling_q", INFINITY)                     \
  X(COUPLING_PHASE, "coupling_phase", 0.0)                  \
  X(DELAY, "delay", 0.0)                                    \
  X(BACKGROUND_AMPLITUDE, "background_amplitude", 1.0)      \
  X(BACKGROUND_PHASE, "background_phase", 0.0)

/**
 * What a fit may find: the parameters by their numbers, pendres_parameter below
 * PENDRES_PARAMETER_FOLLOWED, and from there on the scales. FREQUENCY_SCALE: a frequency of the
 * data over that of the model, as the frequency in Hz of small oscillations where the model's is 1;
 * DRIVE_SCALE: the model's drive amplitude over the data's; AMPLITUDE_SCALE: the instrument's
 * reading over the model's length (amplitude, rms, first harmonic, quadratures); OFFSET: added to
 * amplitudes and rms; PHASE_OFFSET: added to lags, also of quadratures; BACKGROUND_...: added to
 * the quadratures; START_...: of a free decay the model's state at the first datum, displacements
 * being measured from the bottom of the well. For data over time FREQUENCY_SCALE, where it is an
 * unknown, makes seconds: the model's time is 2 pi FREQUENCY_SCALE times the data's.
 * TORQUE_SCALE: the model's torque over the data's, of a junction one over its critical current;
 * the AMPLITUDE_SCALE of mean velocities is a reading over the model's velocity. INTERNAL_Q,
 * COUPLING_Q: the damping of an oscillator on a line is its frequency of small oscillations over
 * each of these; infinite where they are neither unknown nor fixed. DELAY: of a cable, in turns
 * over the unit of the data's frequencies, as seconds for Hz.
 * PENDRES_FIT_QUANTITY_COUNT: how many there are.
 */
typedef enum pendres_fit_quantity {
  PENDRES_FIT_PARAMETER_LAST = PENDRES_PARAMETER_FOLLOWED - 1, /**< the last parameter */
#define PENDRES_FIT_SCALE_CODE(code, name, neutral) PENDRES_FIT_##code,
  PENDRES_FIT_SCALE_LIST(PENDRES_FIT_SCALE_CODE)
#undef PENDRES_FIT_SCALE_CODE
  PENDRES_FIT_QUANTITY_COUNT /**< how many there are; not a quantity */
} pendres_fit_quantity;

/** A quantity whose value is sought, or one that has a value other than the pendulum's. */
typedef struct pendres_fit_unknown {
  int quantity;       /**< which one; see pendres_fit_quantity */
  int fixed;          /**< nonzero: `guess` is its value */
  double guess;       /**< where to begin; NaN: from the data (amplitudes, rms, quadratures or loop
                           areas tell damping, drive, a1, a3 and scales; of others it is 0) */
  double low;         /**< the lower bound, ... */
  double high;        /**< ... and the upper one; both 0: none */
  double prior;       /**< a Gaussian prior: its mean, ... */
  double prior_error; /**< ... and standard deviation; 0: none */
} pendres_fit_unknown;

/** A number that was measured. */
typedef struct pendres_fit_datum {
  pendres_fit_observable observable; /**< what it is of */
  int direction;      /**< 1: while the axis grew, -1: fell */
  double axis;        /**< value of the swept parameter, in the data's unit; of a JUMP or a
                           RESONANCE it is `observed` that is read */
  double other;       /**< value of the other parameter; not read if there is none */
  double observed;    /**< the number */
  double error;       /**< its standard error; 0 in all data: not known, and found from the fit,
                           where either all data are places on the axis or none is */
} pendres_fit_datum;

/** All of them. */
typedef struct pendres_fit_data {
  size_t n;                       /**< how many */
  const pendres_fit_datum *datum; /**< [n], in any order; not kept */
  pendres_parameter axis;         /**< the parameter that was swept, below
                                       PENDRES_PARAMETER_FOLLOWED; PENDRES_PARAMETER_COUNT: time,
                                       along a free decay, without drive */
  pendres_parameter other;        /**< one that differs between sweeps; PENDRES_PARAMETER_COUNT:
                                       none */
} pendres_fit_data;

/** What is fitted. */
typedef struct pendres_fit_model {
  pendres_pendulum pendulum; /**< its force, and the parameters that are neither unknowns nor vary
                                  with the data; the others are not read */
  size_t unknowns;           /**< how many, free and fixed */
  const pendres_fit_unknown *unknown; /**< [unknowns], each quantity once, at least one of them
                                           free; not kept */
} pendres_fit_model;

/** How to fit. Zero in a field: default. */
typedef struct pendres_fit_options {
  size_t size;       /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  double huber;      /**< standard errors beyond which a residual counts linearly; 0: none does;
                          errors then follow from how the data pull, outliers included */
  double jump_error; /**< standard error of the axis at a jump beside the spacing of the data, as
                          noise makes states jump early; in the data's unit */
  int starts;        /**< most starts that are tried; 20, which is all that there are */
  int iterations;    /**< most steps from each of them; 60 */
} pendres_fit_options;

/** What a fit says of a datum. */
typedef struct pendres_fit_point {
  double modelled;       /**< the model's value, in the data's unit */
  double modelled_error; /**< its standard error, from the covariance */
  double residual;       /**< observed less modelled (of lags the nearest) */
  double error;          /**< standard error of the datum that was used */
  int part;              /**< number of jumps that the oscillator has made before */
  int beyond;            /**< 1: the model's state ends before the datum, and the value is that at
                              its end */
  pendres_orbit_guess orbit; /**< where the orbit of the model is */
} pendres_fit_point;

/** A jump of the model. */
typedef struct pendres_fit_jump {
  double value;          /**< of the axis at which the model's state ends, in the data's unit */
  double value_error;    /**< its standard error */
  double measured[2];    /**< the data jump between these; NaN: beyond the data */
  int direction;         /**< 1: the axis grows, -1: it falls */
  double other;          /**< value of the other parameter; NaN: there is none */
} pendres_fit_jump;

/** The numbers of a fit. */
typedef struct pendres_fit_summary {
  size_t unknowns;       /**< free ones */
  size_t data;           /**< how many data there are */
  double chi_square;     /**< of data, jumps between data, and priors */
  double degrees_of_freedom; /**< their number less that of the unknowns */
  double probability;    /**< of a larger chi_square by chance; NaN where errors are not known */
  double remaining;      /**< by how much chi_square may still fall, by the last derivatives */
  int converged;         /**< 1: by less than a thousandth; 2: so, but chance gives no such
                              chi_square, or most data are outliers: errors are those by which
                              data scatter, and the call returns PENDRES_NOT_CONVERGED */
  int determined;        /**< 0: the data leave a combination of the unknowns open */
  int iterations;        /**< steps, of all starts together */
  int evaluations;       /**< sets of parameters at which the model was computed */
} pendres_fit_summary;

/** Opaque: a fit. */
typedef struct pendres_fit pendres_fit;

/**
 * Whether data can be what they are said to be: amplitudes below 0 beyond their errors and phases
 * beyond a turn, as of data in dB and degrees, are refused, as pendres_fit_find() does.
 *
 * @param data   read, not kept
 * @param model  read, not kept: an offset among its unknowns may make readings negative
 * @param datum  unless NULL: the number of the datum that cannot, data->n where it is not one
 * @param why    unless NULL: a static sentence that says what is wrong, or NULL
 * @return PENDRES_OK or PENDRES_INVALID_ARGUMENT. Thread safety: pure.
 */
pendres_status pendres_fit_data_check(const pendres_fit_data *data, const pendres_fit_model *model,
                                      size_t *datum, const char **why);

/**
 * Fit a model to data.
 *
 * @param ctx      belongs to one thread at a time
 * @param data     read, not kept
 * @param model    read, not kept
 * @param options  NULL: defaults
 * @param out      to be freed by pendres_fit_free(); NULL on failure, except for
 *                 PENDRES_NOT_CONVERGED, with which it has the best values so far
 * @return PENDRES_INVALID_ARGUMENT with a message (fewer data than unknowns, a value that is no
 *         number, an unknown that the data cannot have), PENDRES_NOT_CONVERGED, or failures of the
 *         integration. Thread safety: as for the context. It keeps states between starts
 *         and along what the data leave open (pendres_context_set_keep()).
 */
pendres_status pendres_fit_find(pendres_context *ctx, const pendres_fit_data *data,
                                const pendres_fit_model *model,
                                const pendres_fit_options *options, pendres_fit **out);
/** Free a fit; NULL is allowed. */
void pendres_fit_free(pendres_fit *fit);

/** The numbers; all 0 for NULL. */
pendres_fit_summary pendres_fit_summary_get(const pendres_fit *fit);
/** Value of an unknown by its number among all unknowns of the call; NaN out of range. */
double pendres_fit_value(const pendres_fit *fit, size_t unknown);
/** Covariance of two of them; the square of an error where both are one; 0 of fixed ones. Where an
    error is no small change it is widened by how far the value moves until chi-square has grown by
    1, and INFINITY where the data do not determine it. NaN out of range. */
double pendres_fit_covariance(const pendres_fit *fit, size_t first, size_t second);
/** Datum number i in the order of the call, owned by the fit; NULL out of range. */
const pendres_fit_point *pendres_fit_point_get(const pendres_fit *fit, size_t i);
/** Jump number i, owned by the fit; NULL beyond the last. */
const pendres_fit_jump *pendres_fit_jump_get(const pendres_fit *fit, size_t i);
/** Sentences about what the numbers do not show, as what the data leave open: number i, owned by
    the fit; NULL beyond the last. */
const char *pendres_fit_note_get(const pendres_fit *fit, size_t i);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
