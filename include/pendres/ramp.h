/**
 * @file ramp.h
 * @brief A pendulum one of whose parameters moves in real time, with noise or without.
 *
 * Owns: what a pendulum does while a parameter moves at a finite rate; how much later it leaves a
 * state than it would if the parameter moved infinitely slowly (hysteresis.h); and how this
 * scatters with thermal noise, as in measurements of switching currents.
 *
 * Time is counted in drive periods: it is the drive's phase over 2 pi, the integral of the drive's
 * frequency, and is continuous also when the frequency itself varies. Between two corners of a ramp
 * the parameter is a linear function of this time.
 *
 * The time at which a pendulum leaves a state is measured as with a lock-in amplifier, by the first
 * harmonic a + i b of its angle over each drive period, or as many as the two states need to close.
 * The pendulum has left when its harmonic is nearer to that of the new state than to that of the
 * old one, or farther from the old one than the new one is, and does not return within the time
 * 2/damping in which transients decay, in whole windows, the last one that begins in it included.
 * Both are taken at the parameter's present value; the old state, beyond its end, at its last
 * value, the new one, before its begin, at its first. If the states' x advance differently by half
 * a radian or more in that time, the mean velocity is used instead, over the time of a turn at
 * least. Between two windows the time is interpolated. Another definition would shift a delay by
 * some drive periods, while the delay of a slow ramp past a fold grows as rate^(-1/3).
 *
 * Without a drive the drive's frequency is a unit of time and nothing else. Windows are then the
 * time of a turn of states that rotate, and the time in which motions about them decay of states at
 * rest, which are distinguished by the position. A pendulum must not return within 2/damping and
 * two windows.
 *
 * Integrator and random numbers are those of langevin.h, of order four at temperature zero as well.
 * Parameters are held constant within a step, at their value in its middle.
 *
 * Source: Haberman, SIAM Journal on Applied Mathematics 37 (1979) 69, for delays past a fold;
 * Fulton and Dunkleberger, Physical Review B 9 (1974) 4760, for distributions of switching
 * currents.
 *
 * Thread safety: that of the context (context.h); functions without one are pure.
 */
#ifndef PENDRES_RAMP_H
#define PENDRES_RAMP_H

#include <pendres/hysteresis.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** A ramp. Everything that it points to is read, and not kept. */
typedef struct pendres_ramp {
  pendres_pendulum pendulum;   /**< the other parameters; its value of the varied one is not read */
  pendres_parameter parameter; /**< the parameter that varies */
  size_t corners;              /**< at least 2 */
  const long *period;          /**< [corners] times in drive periods: 0, then ascending */
  const double *value;         /**< [corners] of the parameter at these times */
  size_t points;               /**< of the path that a ramp which is infinitely slow would take */
  const pendres_hysteresis_point *point; /**< [points] the path, as pendres_hysteresis_get(h, 0)
                                    points to it: through the same values in the same order. The
                                    ramp starts at its first value, in the state of its first point;
                                    more points between two values make the old state better
                                    known */
  size_t jumps;                /**< on the path */
  const pendres_jump *jump;    /**< [jumps] as pendres_hysteresis_jump_get(h, 0) points to them */
} pendres_ramp;

/** When a pendulum leaves the state that jump k of the path ends. */
typedef struct pendres_ramp_jump {
  double time;        /**< in drive periods since the ramp's start; NaN where the pendulum is not in
                           that state, does not leave it before the parameter turns round, or the
                           path's jump is gradual or from or to chaos, so that the states cannot
                           be distinguished */
  double value;       /**< of the parameter then */
  double value_error; /**< its error, from two runs of different steps */
  double delay;       /**< how far beyond the path's jump this is, in the direction of the ramp */
  double delay_error; /**< its error, that of the path's jump included */
} pendres_ramp_jump;

/** Where to record a ramp. */
typedef struct pendres_ramp_record {
  long every;      /**< drive periods from one point to the next, at least 1. Point k is at time
                        k every, the first is the start */
  double *x;       /**< [period[corners - 1] / every + 1] position at drive phase 0, whole
                        turns included */
  double *v;       /**< velocity, likewise */
  double *x_error; /**< error of x, from two runs of different steps; infinite from where these
                        have separated */
  double *v_error; /**< error of v, likewise */
} pendres_ramp_record;

/** The parameter at a time in drive periods; NaN before the start, behind the end, and without a
    ramp. */
double pendres_ramp_value(const pendres_ramp *ramp, double time);

/**
 * Follow a ramp without noise. record may be NULL, jump[ramp->jumps] as well.
 *
 * Where a force lets pendulums escape to infinity, x, v and their errors are NaN from the first
 * point on at which one is beyond 1e8.
 *
 * The temperature is not read. Steps are chosen such that the errors of the strobe points meet
 * the context's tolerance while the pendulum is in the states of the path (or are the context's
 * steps_per_period); the run is repeated with half as many.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (the message says which), PENDRES_OUT_OF_MEMORY,
 * PENDRES_INTERRUPTED, PENDRES_INTEGRATION_FAILED. What was written is to be ignored then.
 */
pendres_status pendres_ramp_find(pendres_context *ctx, const pendres_ramp *ramp,
                                 const pendres_ramp_record *record, pendres_ramp_jump *jump);

/**
 * Follow n noisy trajectories through a ramp at the pendulum's temperature. All start from the
 * state of the path's first point, and need some times 1/damping to spread to a cloud around it.
 *
 * time[jumps][n] receives when trajectory first_id + i leaves the state that jump k ends, in drive
 * periods; NaN where it does not (see pendres_ramp_jump). value[jumps][n] receives the parameter
 * then; it may be NULL. Each trajectory is the same bytes whatever n is.
 *
 * Steps are the context's steps_per_period or, if these are not chosen, such that without noise the
 * strobe points meet the tolerance, or 1e-6 if that is more.
 *
 * Errors: as pendres_ramp_find.
 */
pendres_status pendres_ramp_scatter(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                    uint64_t first_id, double *time, double *value);

/** A distribution of jumps. */
typedef struct pendres_ramp_summary {
  size_t count;           /**< how many numbers there are; NaN are not counted */
  double mean;            /**< of these; NaN if there are none */
  double mean_error;      /**< its standard error; NaN if there are fewer than two */
  double deviation;       /**< standard deviation; NaN if there are fewer than two */
  double deviation_error; /**< its standard error, by the fourth moment; NaN if there are fewer than
                               four */
} pendres_ramp_summary;

/**
 * Mean and standard deviation of n jumps. Errors: PENDRES_INVALID_ARGUMENT if value (where n > 0)
 * or out is NULL.
 */
pendres_status pendres_ramp_summarize(size_t n, const double *value, pendres_ramp_summary *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
