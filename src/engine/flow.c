/* flow.c -- a block of pendulums on one ARKODE problem; see flow.h. */
#include "base/limits.h"
#include "engine/flow.h"

#include <math.h>
#include <stdlib.h>

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>

#include "base/angles.h"
#include "base/grow.h"
#include "base/instructions.h"
#include "engine/compat.h"
#include "engine/flow_internal.h"
#include "engine/flow_table.h"
#include "engine/kernels_float.h"
#include "engine/lanes_tape.h"
#include "engine/tables.h"

static int right_hand_side(sunrealtype theta, N_Vector y, N_Vector slope, void *arg)
{
  pendres_flow *flow = arg;
  pendres_lanes_slope(y, slope, pendres_flow_drive_cosine(&flow->drive, theta));
  flow->evaluations += (double)flow->lanes;
  return 0;
}

/* Count steps that have been taken, and ask now and then whether to go on; nonzero: the block is to
   stop. */
static int count_steps(pendres_flow *flow, int steps)
{
  flow->steps_taken += (double)steps * (double)flow->lanes;
  if (flow->steps_taken < flow->next_asked) return 0;
  flow->next_asked = flow->steps_taken + (double)PENDRES_STEPS_BETWEEN_CHECKS;
  flow->stopped = flow->stop != NULL && flow->stop(flow->stop_arg) != 0;
  return flow->stopped ? -1 : 0;
}

/*
 * ERKStep before SUNDIALS 6.7 takes every table whose last node is 1 as
 * first-same-as-last and reuses a wrong stage. A step-postprocess function makes
 * it evaluate the slope again.
 */
static int after_step(sunrealtype theta, N_Vector y, void *arg)
{
  pendres_flow *flow = arg;
  if (flow->load != PENDRES_FLOW_NOTHING) {
    const int driven = flow->shape.model != PENDRES_MODEL_PLAIN;
    const double phase = pendres_flow_drive_phase(&flow->drive, theta);
    const double step = two_pi / flow->drive.steps;
    const int second = flow->load == PENDRES_FLOW_TANGENTS && lrint(phase / step) % 2 == 0;
    pendres_lanes_carry(y, step, driven ? cos(phase) : 1.0, second);
  }
  return count_steps(flow, 1);
}

/* With fixed steps ARKODE does not read the weights: they stay at one. */
static int unit_weights(N_Vector y, N_Vector weights, void *arg)
{
  (void)y;
  (void)weights;
  (void)arg;
  return 0;
}

static pendres_status arkode_setup(pendres_flow *flow, pendres_table table, SUNContext sun)
{
  ARKodeButcherTable butcher = NULL;
  pendres_status status = PENDRES_OK;

  flow->arkode = ERKStepCreate(right_hand_side, 0.0, flow->state, sun);
  if (flow->arkode == NULL) return PENDRES_OUT_OF_MEMORY;
  if (pendres_compat_silence(sun, flow->arkode, NULL) != 0) return PENDRES_INTEGRATION_FAILED;
  butcher = pendres_flow_table(table, flow->tolerance == 0.0, &flow->drive.stages);
  if (butcher == NULL) return PENDRES_OUT_OF_MEMORY;
  if (flow->drive.stages > PENDRES_TABLES_MOST_STAGES) {
    ARKodeButcherTable_Free(butcher);
    return PENDRES_INTERNAL;
  }
  for (int i = 0; i < flow->drive.stages; i++) flow->drive.node[i] = butcher->c[i];

  int bad = ERKStepSetTable(flow->arkode, butcher) != 0 ||
            ERKStepSetUserData(flow->arkode, flow) != 0 ||
            ERKStepSetPostprocessStepFn(flow->arkode, after_step) != 0 ||
            ERKStepSetMaxNumSteps(flow->arkode, (long)PENDRES_MOST_SOLVER_STEPS) != 0 ||
            ERKStepSetMaxHnilWarns(flow->arkode, -1) != 0 ||
            ERKStepSetInterpolantType(flow->arkode, ARK_INTERP_LAGRANGE) != 0 ||
            ERKStepSetInterpolantDegree(flow->arkode, flow->tolerance == 0.0 ? 0 : 1) != 0;
  if (!bad && flow->tolerance == 0.0)
    bad = ERKStepWFtolerances(flow->arkode, unit_weights) != 0;
  else if (!bad)
    bad = ERKStepSStolerances(flow->arkode, flow->tolerance, flow->tolerance) != 0 ||
          pendres_flow_set_controller(flow->arkode) != 0;
  if (bad) status = PENDRES_OUT_OF_MEMORY; /* nothing else can be wrong with these settings */
  ARKodeButcherTable_Free(butcher);
  return status;
}

pendres_status pendres_flow_create(const pendres_flow_options *options, SUNContext sun,
                                   pendres_flow **out)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_flow *flow = calloc(1, sizeof *flow);
  *out = NULL;
  if (flow == NULL) return status;

  if (options->rows != PENDRES_ROWS_STATE && options->rows != PENDRES_ROWS_VARIATIONAL &&
      options->rows != PENDRES_ROWS_SENSITIVITY && options->rows != PENDRES_ROWS_DRIVES &&
      options->rows != PENDRES_ROWS_ALL) {
    status = PENDRES_INVALID_ARGUMENT;
    goto fail;
  }
  if (pendres_lanes_open(&flow->shape, options->rows, options->lanes,
                         pendres_kernels_select()) != 0)
    goto fail;
  flow->shape.norm_unused = options->tolerance == 0.0;
  flow->lanes = options->lanes;
  flow->stop = options->stop;
  flow->stop_arg = options->stop_arg;
  flow->next_asked = (double)PENDRES_STEPS_BETWEEN_CHECKS;
  flow->tolerance = options->tolerance;
  if (pendres_flow_lanes_open(flow) != 0) goto fail;
  flow->replays = pendres_lanes_replays_create();
  if (flow->replays == NULL) goto fail;
  flow->state = pendres_lanes_create(&flow->shape, sun);
  if (flow->state == NULL) goto fail;
  status = arkode_setup(flow, options->table, sun);
  if (flow->shape.starved) status = PENDRES_OUT_OF_MEMORY;
  if (status != PENDRES_OK) goto fail;
  *out = flow;
  return PENDRES_OK;
fail:
  pendres_flow_free(flow);
  return status;
}

void pendres_flow_free(pendres_flow *flow)
{
  if (flow == NULL) return;
  if (flow->arkode != NULL) ERKStepFree(&flow->arkode);
  if (flow->state != NULL) N_VDestroy(flow->state);
  pendres_lanes_close(&flow->shape);
  pendres_lanes_replays_free(flow->replays);
  pendres_flow_lanes_close(flow);
  pendres_flow_drive_free(&flow->drive);
  free(flow->in_float.cosine);
  free(flow);
}

pendres_status pendres_flow_set_longest_step(pendres_flow *flow, double longest)
{
  if (!(longest >= 0.0) || flow->tolerance == 0.0) return PENDRES_INVALID_ARGUMENT;
  return ERKStepSetMaxStep(flow->arkode, longest) == 0 ? PENDRES_OK : PENDRES_INTERNAL;
}

pendres_status pendres_flow_set_steps(pendres_flow *flow, int steps)
{
  if (steps < 1 || flow->tolerance != 0.0) return PENDRES_INVALID_ARGUMENT;
  if (steps == flow->drive.steps) return PENDRES_OK;
  if (pendres_flow_drive_resize(&flow->drive, steps) != 0) return PENDRES_OUT_OF_MEMORY;
  const double h = two_pi / steps;
  flow->failure = ERKStepSetFixedStep(flow->arkode, h);
  if (flow->failure != 0) return PENDRES_INTEGRATION_FAILED;
  flow->drive.steps = steps;
  /* A stop at 2 pi itself would shorten the last step, or add a tiny one, since the clock is off by
     rounding. */
  flow->end = 0.0;
  for (int i = 0; i < steps; i++) {
    if (2 * i == steps) flow->half = flow->end;
    flow->end += h;
  }
  return PENDRES_OK;
}

/* Put the clock back to phase 0, with the block's present state. */
static pendres_status start_period(pendres_flow *flow, double end)
{
  pendres_flow_drive_rewind(&flow->drive);
  flow->stopped = 0;
  pendres_lanes_write(flow->state, flow->rows);
  flow->failure = ERKStepReset(flow->arkode, 0.0, flow->state);
  if (flow->failure == 0) flow->failure = ERKStepSetStopTime(flow->arkode, end);
  return flow->failure == 0 ? PENDRES_OK : PENDRES_INTEGRATION_FAILED;
}

static pendres_status failed(const pendres_flow *flow)
{
  if (flow->failure == ARK_MEM_FAIL) return PENDRES_OUT_OF_MEMORY;
  return flow->stopped ? PENDRES_INTERRUPTED : PENDRES_INTEGRATION_FAILED;
}

/* What a block is asked for: a period, half of one, or a period step by step. */
enum { SPAN_PERIOD, SPAN_HALF, SPAN_SAMPLED };

static pendres_lanes_replay_kind kind_of(const pendres_flow *flow, int span)
{
  return (pendres_lanes_replay_kind){
    .steps = flow->drive.steps, .span = span, .carried = (int)flow->load,
    .driven = flow->load != PENDRES_FLOW_NOTHING && flow->shape.model != PENDRES_MODEL_PLAIN};
}

/* The record of such a period; NULL: there is none. Wide blocks have none: they would gain nothing,
   and stop() would be called too seldom. */
static const pendres_lanes_replay *known(pendres_flow *flow, int span)
{
  const int steps = flow->drive.steps;
  if (steps == 0 || (double)flow->lanes * steps > (double)PENDRES_STEPS_BETWEEN_CHECKS) return NULL;
  const pendres_lanes_replay_kind kind = kind_of(flow, span);
  const pendres_lanes_replay *p = pendres_lanes_replays_find(flow->replays, &kind);
  if (p != NULL) return p;
  pendres_lanes_replays_begin(flow->replays);
  pendres_lanes_tape_record(&flow->shape, flow->replays);
  return NULL;
}

/* A part of the period is over: copy the state to the rows that the rest of the engine reads. */
static void show(pendres_flow *flow)
{
  pendres_lanes_read(flow->state, flow->rows);
  pendres_lanes_replays_part(flow->replays);
}

/* ARKODE has come to the end of a period: its record is complete. */
static void learn(pendres_flow *flow, int span)
{
  const pendres_lanes_replay_kind kind = kind_of(flow, span);
  pendres_lanes_tape_record(&flow->shape, NULL);
  pendres_lanes_replays_end(flow->replays, &kind, flow->failure >= 0);
}

/* A period without ARKODE; sample may be NULL. */
static pendres_status replay(pendres_flow *flow, const pendres_lanes_replay *p, int steps,
                             pendres_flow_sample *sample, void *arg)
{
  size_t done = 0;
  flow->stopped = 0;
  pendres_lanes_write(flow->state, flow->rows);
  for (size_t k = 0; k < p->parts; k++) {
    pendres_lanes_shape_run(&flow->shape, p->operation + done, p->end[k] - done);
    done = p->end[k];
    pendres_lanes_read(flow->state, flow->rows);
    const pendres_rows rows = pendres_flow_rows(flow);
    if (sample != NULL) sample(arg, (int)k + 1, &rows);
  }
  flow->evaluations += (double)p->slopes * (double)flow->lanes;
  return count_steps(flow, steps) == 0 ? PENDRES_OK : PENDRES_INTERRUPTED;
}

/* How a call of ARKODE has ended. */
static pendres_status ended(const pendres_flow *flow)
{
  if (flow->shape.starved) return PENDRES_OUT_OF_MEMORY;
  return flow->failure < 0 ? failed(flow) : PENDRES_OK;
}

static pendres_status advance_to(pendres_flow *flow, int span, double end)
{
  sunrealtype reached = 0.0;
  const pendres_lanes_replay *p = known(flow, span);
  if (p != NULL)
    return replay(flow, p, flow->drive.steps / (span == SPAN_HALF ? 2 : 1), NULL, NULL);
  const pendres_status status = start_period(flow, end);
  if (status == PENDRES_OK)
    flow->failure = ERKStepEvolve(flow->arkode, end, flow->state, &reached, ARK_NORMAL);
  if (status == PENDRES_OK) show(flow);
  learn(flow, span);
  return status != PENDRES_OK ? status : ended(flow);
}

pendres_status pendres_flow_period(pendres_flow *flow)
{
  return advance_to(flow, SPAN_PERIOD, flow->drive.steps > 0 ? flow->end : two_pi);
}

pendres_status pendres_flow_period_float(pendres_flow *flow)
{
  const pendres_lanes_shape *s = &flow->shape;
  const int steps = flow->drive.steps;
  if (steps < 1 || flow->load != PENDRES_FLOW_ERRORS || s->model != PENDRES_MODEL_PLAIN)
    return PENDRES_INVALID_ARGUMENT;
  if (pendres_flow_float_prepare(&flow->in_float, steps) != 0) return PENDRES_OUT_OF_MEMORY;
  const pendres_float_lanes block = {.lanes = s->stride, .y = flow->rows,
                                     .w = flow->rows + s->stride, .k = s->coefficients,
                                     .off = s->off};
  flow->stopped = 0;
  PENDRES_INSTRUCTIONS_BEST(pendres_kernels_float)->run(&flow->in_float, &block);
  flow->evaluations += (double)steps * flow->in_float.stages * (double)flow->lanes;
  return count_steps(flow, steps) == 0 ? PENDRES_OK : PENDRES_INTERRUPTED;
}

pendres_status pendres_flow_half_period(pendres_flow *flow)
{
  if (flow->drive.steps < 1 || flow->drive.steps % 2 != 0) return PENDRES_INVALID_ARGUMENT;
  return advance_to(flow, SPAN_HALF, flow->half);
}

pendres_status pendres_flow_period_sampled(pendres_flow *flow, pendres_flow_sample *sample,
                                           void *arg)
{
  sunrealtype reached = 0.0;
  if (flow->drive.steps < 1) return PENDRES_INVALID_ARGUMENT;
  const pendres_lanes_replay *p = known(flow, SPAN_SAMPLED);
  if (p != NULL) return replay(flow, p, flow->drive.steps, sample, arg);
  pendres_status status = start_period(flow, flow->end);
  for (int step = 1; step <= flow->drive.steps && status == PENDRES_OK; step++) {
    flow->failure = ERKStepEvolve(flow->arkode, flow->end, flow->state, &reached, ARK_ONE_STEP);
    status = ended(flow);
    if (status != PENDRES_OK) break;
    show(flow);
    const pendres_rows rows = pendres_flow_rows(flow);
    sample(arg, step, &rows);
  }
  learn(flow, SPAN_SAMPLED);
  return status;
}

double pendres_flow_evaluations(const pendres_flow *flow)
{
  return flow->evaluations;
}

double pendres_flow_steps(const pendres_flow *flow)
{
  return flow->steps_taken;
}

int pendres_flow_failure(const pendres_flow *flow)
{
  return flow->failure;
}

/* ---- The drive ------------------------------------------------------------------------------ */

/*
 * ARKODE adds up its clock step by step and always rounds in the same direction: after 3e5 steps
 * its error is 1e-10. The exact phase is a whole number of steps plus the node of a stage.
 */
double pendres_flow_drive_phase(const pendres_flow_drive *d, double theta)
{
  if (d->steps == 0) return theta;
  const double steps = theta * d->steps / two_pi;
  double meant = rint(steps);
  for (int i = 0; i < d->stages; i++) {
    const double here = rint(steps - d->node[i]) + d->node[i];
    if (fabs(here - steps) < fabs(meant - steps)) meant = here;
  }
  return fabs(meant - steps) < 1e-3 ? two_pi * meant / d->steps : theta;
}

double pendres_flow_drive_cosine(pendres_flow_drive *d, double theta)
{
  if (d->next >= d->size) return cos(theta); /* adaptive steps, or an unforeseen call */
  const size_t i = d->next++;
  if (d->theta[i] != theta) {
    d->theta[i] = theta;
    d->cosine[i] = cos(pendres_flow_drive_phase(d, theta));
  }
  return d->cosine[i];
}

void pendres_flow_drive_rewind(pendres_flow_drive *d)
{
  d->next = 0;
}

int pendres_flow_drive_resize(pendres_flow_drive *d, int steps)
{
  const size_t wanted = (size_t)(d->stages + 1) * (size_t)(steps + 2);
  d->next = 0;
  if (wanted > d->size) {
    if (!pendres_regrow(&d->theta, wanted, sizeof *d->theta) ||
        !pendres_regrow(&d->cosine, wanted, sizeof *d->cosine))
      return -1;
    for (size_t i = d->size; i < wanted; i++) {
      d->theta[i] = 0.0;
      d->cosine[i] = 1.0;
    }
    d->size = wanted;
  }
  return 0;
}

void pendres_flow_drive_free(pendres_flow_drive *d)
{
  free(d->theta);
  free(d->cosine);
}

/* ---- Kernels --------------------------------------------------------------------------------- */

const pendres_kernels *pendres_kernels_select(void)
{
  return PENDRES_INSTRUCTIONS_BEST(pendres_kernels);
}
