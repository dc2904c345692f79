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
 * error[n], if not NULL, receives an estimate of the larger of the errors of x and v: twice what is
 * between the first run and better ones, which are taken to be off by up to half as much. Those are
 * a second run with more steps a period and, where errors have grown, a third with still more; or,
 * where the method's steps are adaptive, runs with a tenth and a hundredth of the tolerance (1e-6
 * at most). It covers discretisation and rounding, amplified along each trajectory as that
 * itself amplifies them; where that is by more than the tolerance allows, the estimate says so
 * (infinite: nothing is known), it is not an error of the function. It costs four to five times as
 * much as the first run.
 *
 * The steps a period of each pendulum depend on its own parameters, its initial speed
 * and the tolerance alone; so do the results, whatever the other pendulums.
 *
 * A damped pendulum without a drive is put to rest when both x - pi/2 and v / drive_frequency are
 * below 1e-290. Other states that take denormal numbers (drives below some 1e-300) are right, but
 * take up to a hundred times as long.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (message names the pendulum; nothing was changed), also where
 * double precision cannot say what is asked: positions beyond 1e15, where a tenth of a radian is
 * lost, parameters and speeds that lead there within a period, or a damping of more than 1e15 times
 * the drive frequency; PENDRES_INTEGRATION_FAILED, also where a state is no number at the end;
 * PENDRES_TOLERANCE_UNREACHABLE, PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED. On any of these x and
 * v are unchanged.
 */
pendres_status pendres_strobe_advance(pendres_context *ctx, size_t n,
                                      const pendres_pendulum *pendulums, double *x, double *v,
                                      long periods, double *error);

/**
 * Record one pendulum from position x0 and velocity v0 at drive phase 0 on: `samples` equally
 * spaced points a drive period over `periods` periods. Point k, at drive phase
 * 2 pi k / samples, goes to x[k] and v[k]; k = 0 is the start and k = periods * samples the end, so
 * the arrays hold periods * samples + 1 values. x is not wrapped.
 *
 * x_error and v_error, of the same length, receive estimates of the errors: a second run with
 * more steps is compared with the first, and rounding is carried along by the variational
 * equation. Where the runs have lost each other, and from there on, both are infinite. Both may be
 * NULL, and that run is then not made.
 *
 * The steps are fixed ones and end on each point, whatever the context's method: nothing is
 * interpolated. Their choice and the statuses returned are those of pendres_strobe_advance().
 * What was written before a failure is to be ignored.
 */
pendres_status pendres_strobe_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                     double x0, double v0, long periods, int samples, double *x,
                                     double *v, double *x_error, double *v_error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
