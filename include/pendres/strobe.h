/**
 * @file strobe.h
 * @brief The stroboscopic map: pendulums seen once a drive period.
 *
 * Owns: advancing any number of pendulums by whole drive periods. The strobe
 * is at drive phase 0, where the drive is at its maximum.
 *
 * Source of the term: Baker and Gollub, Chaotic Dynamics (1996), chapter 3.
 */
#ifndef PENDRES_STROBE_H
#define PENDRES_STROBE_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/**
 * Advance n pendulums, whatever their parameters, by `periods` drive periods.
 *
 * pendulums[n] are read; x[n] and v[n] (position and velocity at drive phase 0) are
 * replaced in place. x keeps its whole turns: it is not wrapped.
 *
 * error[n], if not NULL, receives an estimate of the larger of the errors of x and v: twice the
 * distance between the first run and better ones, which may be off by half as much themselves. With
 * fixed steps there is one better run, with twice the steps a period. With adaptive steps there are
 * two, with a tenth and a hundredth of the tolerance (1e-6 at most), and, except for CVODE's
 * methods, at least 1.4 times and twice the steps. The estimate covers discretisation and rounding,
 * amplified as each trajectory amplifies them. Where the runs separate on the way, even if
 * they meet again, the estimate is infinite: the result is then unknown, which is not a failure of
 * the function. With fixed steps the call takes three times as long as without an estimate. Runs
 * with adaptive steps are compared at 64 strobes at most.
 *
 * The steps per period of each pendulum depend only on its own parameters, its initial speed
 * and the tolerance; so do the results, which do not depend on the other pendulums.
 *
 * A damped pendulum without a drive is put to rest when both x - pi/2 and v / drive_frequency are
 * below 1e-290. Other states with denormal numbers (drives below some 1e-300) are correct, but
 * take up to a hundred times as long.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (message names the pendulum; nothing was changed), also where
 * double precision is not sufficient: positions beyond 1e15, where a tenth of a radian is lost,
 * parameters and speeds that lead there within a period, or a damping of more than 1e15 times the
 * drive frequency; PENDRES_INTEGRATION_FAILED, also where a state is not a number at the end;
 * PENDRES_TOLERANCE_UNREACHABLE, PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED. On any of these x and
 * v are unchanged.
 */
pendres_status pendres_strobe_advance(pendres_context *ctx, size_t n,
                                      const pendres_pendulum *pendulums, double *x, double *v,
                                      long periods, double *error);

/** The caller's arrays in which a motion is recorded. */
typedef struct pendres_record {
  double *x;       /**< positions, in rad; not wrapped */
  double *v;       /**< velocities, in rad per unit time */
  double *x_error; /**< errors of x; NULL: not computed */
  double *v_error; /**< errors of v; NULL if x_error is NULL */
} pendres_record;

/**
 * Record one pendulum from a state at drive phase 0 on: `samples` equally spaced points a drive
 * period over `periods` periods. Point k, at drive phase 2 pi k / samples, goes to out->x[k] and
 * out->v[k]; k = 0 is the start and k = periods * samples the end, so the arrays hold
 * periods * samples + 1 values.
 *
 * Errors are estimates: a second run with twice the steps is compared with the first, and rounding
 * is propagated by the variational equation. Where the runs have separated, and from there on, both
 * are infinite. Without errors the second run is not made.
 *
 * The steps are fixed ones and end on each point, whatever the context's method: nothing is
 * interpolated. Their choice and the statuses returned are those of pendres_strobe_advance().
 * What was written before a failure is to be ignored.
 */
pendres_status pendres_strobe_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                     const pendres_state *start, long periods, int samples,
                                     const pendres_record *out);

/** The present state of one of the two runs of a recording. For use by the library only. */
typedef struct pendres_recording_place {
  double y;   /**< angle, within half a turn of zero */
  double w;   /**< its slope by drive phase */
  long turns; /**< whole turns taken out of y */
} pendres_recording_place;

/**
 * The state of a record that is made piece by piece, since it may be longer than memory. Plain
 * data, to be read and copied but not changed; a record continued from a copy has the same bytes.
 */
typedef struct pendres_recording {
  pendres_pendulum pendulum;     /**< the pendulum that is recorded */
  long periods;                  /**< drive periods recorded so far */
  int samples;                   /**< points a drive period */
  int stretch;                   /**< steps between two points */
  double x;                      /**< the latest point, ... */
  double v;                      /**< ... its velocity, ... */
  double x_error;                /**< ... and their errors; infinite if lost */
  double v_error;                /**< likewise */
  pendres_recording_place place; /**< of the run that is recorded */
  pendres_recording_place finer; /**< of the run that it is compared with */
  double noise[3];               /**< covariance of the rounding of the latter */
  int lost;                      /**< 1: the runs have separated, and errors are infinite from here
                                      on; the second run has ended */
} pendres_recording;

/**
 * Begin a record of a pendulum from a state at drive phase 0, which is to have `periods` drive
 * periods in all: steps are chosen such that errors may add up over all of them. *out is written on
 * PENDRES_OK. The other statuses are those of pendres_strobe_record(). Thread safety is that of the
 * context.
 */
pendres_status pendres_recording_begin(pendres_context *ctx, const pendres_pendulum *pendulum,
                                       const pendres_state *start, long periods, int samples,
                                       pendres_recording *out);

/**
 * Continue by some periods. Arrays are those of pendres_strobe_record(), of periods * samples + 1
 * values: the first is the last of the piece before. All pieces together are the same bytes as the
 * record in one piece. After a piece without errors those of later pieces are infinite.
 *
 * On a failure *recording is unchanged. Thread safety: as for the context.
 */
pendres_status pendres_recording_advance(pendres_context *ctx, pendres_recording *recording,
                                         long periods, const pendres_record *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
