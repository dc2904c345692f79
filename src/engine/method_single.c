/* method_single.c -- one adaptive ARKODE problem a pendulum; see method_one.h. */
#include <arkode/arkode_erkstep.h>

#include "base/numbers.h"
#include "engine/sundials/compat.h"
#include "engine/sundials/flow_table.h"
#include "engine/method_one.h"

/* See block.c on ERKStep before SUNDIALS 6.7. */
static int after_step(sunrealtype theta, N_Vector state, void *arg)
{
  (void)theta, (void)state, (void)arg;
  return 0;
}

static int open(pendres_one *b)
{
  int stages = 0, bad = -1;
  ARKodeButcherTable table = pendres_flow_table(b->ctx->options.table, 0, &stages);
  b->memory = ERKStepCreate(pendres_one_slope, 0.0, b->state, b->ctx->sun);
  if (b->memory != NULL && table != NULL) {
    bad = pendres_compat_silence(b->ctx->sun, b->memory, NULL) != 0 ||
          ERKStepSetTable(b->memory, table) != 0 || ERKStepSetUserData(b->memory, b) != 0 ||
          ERKStepSetPostprocessStepFn(b->memory, after_step) != 0 ||
          ERKStepWFtolerances(b->memory, pendres_one_weights) != 0 ||
          ERKStepSetMaxNumSteps(b->memory, (long)PENDRES_MOST_SOLVER_STEPS) != 0 ||
          ERKStepSetMaxStep(b->memory, b->longest) != 0 ||
          pendres_flow_set_controller(b->memory) != 0;
  }
  ARKodeButcherTable_Free(table);
  return bad;
}

/* Stopped at the strobe: ARKODE's interpolant is not as accurate as its steps. */
static int advance(pendres_one *b, double theta)
{
  sunrealtype reached = 0.0;
  const int code = ERKStepSetStopTime(b->memory, theta);
  return code != 0 ? code : ERKStepEvolve(b->memory, theta, b->state, &reached, ARK_NORMAL);
}

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open, advance, pendres_one_read, pendres_one_erk_steps,
                                            pendres_one_erk_close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_single = {
  .running_clock = 1, .run = run};
