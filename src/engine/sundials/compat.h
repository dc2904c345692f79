/*
 * compat.h -- one interface to SUNDIALS 6.4 to 7.x.
 *
 * Owns: what changed between these releases and matters here. Code elsewhere in src/ is written
 * with the ERKStep names of 6.4; from 7.1 on these are deprecated in favour of ARKode names, and
 * the list below translates. SUNDIALS is made to print nothing: its return codes are sufficient,
 * and the library turns them into a status and a message.
 */
#ifndef PENDRES_COMPAT_H
#define PENDRES_COMPAT_H

#include <stdio.h> /* arkode_butcher.h of SUNDIALS 6.4 needs it */

#include <arkode/arkode.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_types.h>

/* Whether it is at least that release of SUNDIALS. */
#define PENDRES_COMPAT_SUNDIALS(major, minor)                                                     \
  (SUNDIALS_VERSION_MAJOR > (major) ||                                                            \
   (SUNDIALS_VERSION_MAJOR == (major) && SUNDIALS_VERSION_MINOR >= (minor)))

#if !PENDRES_COMPAT_SUNDIALS(6, 4)
#error "SUNDIALS 6.4 or later is needed"
#endif
#if !defined(SUNDIALS_DOUBLE_PRECISION)
#error "SUNDIALS must be built for double precision"
#endif

#if !PENDRES_COMPAT_SUNDIALS(7, 0)
static inline void pendres_compat_quiet(int code, const char *module, const char *function,
                                        char *message, void *arg)
{
  (void)code;
  (void)module;
  (void)function;
  (void)message;
  (void)arg;
}
#endif

/* A context that prints nothing. 0 on success; then SUNContext_Free it. */
static inline int pendres_compat_context_create(SUNContext *out)
{
  *out = NULL;
#if PENDRES_COMPAT_SUNDIALS(7, 0)
  if (SUNContext_Create(SUN_COMM_NULL, out) != 0) return -1;
  /* Errors go to the handlers, warnings straight to the logger: take both away. */
  if (SUNContext_ClearErrHandlers(*out) != 0 || SUNContext_SetLogger(*out, NULL) != 0) {
    (void)SUNContext_Free(out);
    *out = NULL;
    return -1;
  }
  return 0;
#else
  return SUNContext_Create(NULL, out);
#endif
}

/*
 * No messages of an integrator; call it right after its creation. Either memory may be NULL.
 * Before 7.0 handlers belong to the integrators, later to the context. 0 on success.
 */
__attribute__((warn_unused_result)) static inline int
pendres_compat_silence(SUNContext sun, void *arkode_mem, void *cvode_mem)
{
  int bad = 0;
  (void)sun;
#if PENDRES_COMPAT_SUNDIALS(7, 0)
  (void)arkode_mem;
  (void)cvode_mem;
#else
  if (arkode_mem != NULL)
    bad |= ERKStepSetErrHandlerFn(arkode_mem, pendres_compat_quiet, NULL) != 0;
  if (cvode_mem != NULL) bad |= CVodeSetErrHandlerFn(cvode_mem, pendres_compat_quiet, NULL) != 0;
#endif
  return bad;
}

/*
 * Choose the PID step controller of SUNDIALS 6.4, all its numbers given. Later releases count the
 * order differently, hence the adjustment. Controllers as objects, which 7.x prefers, are not owned
 * by the integrator and would need an owner. 0 on success.
 */
#if PENDRES_COMPAT_SUNDIALS(6, 7)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#endif
static inline int pendres_compat_set_pid(void *arkode_mem)
{
  sunrealtype k[3] = {0.58, 0.21, 0.1};
  int bad = ERKStepSetAdaptivityMethod(arkode_mem, ARK_ADAPT_PID, 0, 0, k);
#if PENDRES_COMPAT_SUNDIALS(6, 7)
  bad |= ERKStepSetAdaptivityAdjustment(arkode_mem, -1);
#endif
  return bad;
}
#if PENDRES_COMPAT_SUNDIALS(6, 7)
#pragma GCC diagnostic pop
#endif

#if PENDRES_COMPAT_SUNDIALS(7, 1)
#define ERKStepEvolve ARKodeEvolve
#define ERKStepFree ARKodeFree
#define ERKStepGetNumErrTestFails ARKodeGetNumErrTestFails
#define ERKStepGetNumSteps ARKodeGetNumSteps
#define ERKStepReset ARKodeReset
#define ERKStepSStolerances ARKodeSStolerances
#define ERKStepSetErrorBias ARKodeSetErrorBias
#define ERKStepSetFixedStep ARKodeSetFixedStep
#define ERKStepSetFixedStepBounds ARKodeSetFixedStepBounds
#define ERKStepSetInitStep ARKodeSetInitStep
#define ERKStepSetInterpolantDegree ARKodeSetInterpolantDegree
#define ERKStepSetInterpolantType ARKodeSetInterpolantType
#define ERKStepSetMaxErrTestFails ARKodeSetMaxErrTestFails
#define ERKStepSetMaxFirstGrowth ARKodeSetMaxFirstGrowth
#define ERKStepSetMaxGrowth ARKodeSetMaxGrowth
#define ERKStepSetMaxHnilWarns ARKodeSetMaxHnilWarns
#define ERKStepSetMaxNumSteps ARKodeSetMaxNumSteps
#define ERKStepSetMaxStep ARKodeSetMaxStep
#define ERKStepSetPostprocessStepFn ARKodeSetPostprocessStepFn
#define ERKStepSetSafetyFactor ARKodeSetSafetyFactor
#define ERKStepSetStopTime ARKodeSetStopTime
#define ERKStepSetUserData ARKodeSetUserData
#define ERKStepWFtolerances ARKodeWFtolerances
#endif

#endif
