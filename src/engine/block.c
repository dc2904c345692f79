/* block.c -- a block of pendulums on one ARKODE problem; see block.h. */
#include "base/numbers.h"
#include "engine/block.h"

#include <math.h>
#include <stdlib.h>

#include <stdio.h> /* arkode_butcher.h of SUNDIALS 6.4 needs it */

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>

#include "base/angles.h"
#include "base/grow.h"
#include "base/instructions.h"
#include "engine/sundials/compat.h"
#include "engine/block_internal.h"
#include "engine/sundials/flow_table.h"
#include "engine/sundials/lanes_tape.h"
#include "engine/kernels/tables.h"

static int right_hand_side(sunrealtype theta, N_Vector y, N_Vector slope, void *arg)
{
  pendres_block *b = arg;
  pendres_lanes_tape_slope(y, slope, pendres_block_drive_cosine(&b->drive, theta));
  b->evaluations += (double)b->lanes;
  return 0;
}

/* Count steps that have been taken, and ask now and then whether to go on; nonzero: the block is to
   stop. */
static int count_steps(pendres_block *b, int steps)
{
  b->steps_taken += (double)steps * (double)b->lanes;
  if (b->steps_taken < b->next_asked) return 0;
  b->next_asked = b->steps_taken + (double)PENDRES_STEPS_BETWEEN_CHECKS;
  b->stopped = pendres_context_stops(b->ctx);
  return b->stopped ? -1 : 0;
}

/*
 * ERKStep before SUNDIALS 6.7 takes every table whose last node is 1 as
 * first-same-as-last and reuses a wrong stage. A step-postprocess function makes
 * it evaluate the slope again.
 */
static int after_step(sunrealtype theta, N_Vector y, void *arg)
{
  pendres_block *b = arg;
  if (b->load != PENDRES_FLOW_NOTHING) {
    const int driven = b->shape.model != PENDRES_MODEL_PLAIN;
    const double phase = pendres_block_drive_phase(&b->drive, theta);
    const double step = two_pi / b->drive.steps;
    const int second = b->load == PENDRES_FLOW_TANGENTS && lrint(phase / step) % 2 == 0;
    pendres_lanes_tape_carry(y, step, driven ? cos(phase) : 1.0, second);
  }
  return count_steps(b, 1);
}

/* With fixed steps ARKODE does not read the weights: they stay at one. */
static int unit_weights(N_Vector y, N_Vector weights, void *arg)
{
  (void)y;
  (void)weights;
  (void)arg;
  return 0;
}

static pendres_status arkode_setup(pendres_block *b)
{
  SUNContext sun = b->ctx->sun;
  ARKodeButcherTable butcher = NULL;
  pendres_status status = PENDRES_OK;

  b->arkode = ERKStepCreate(right_hand_side, 0.0, b->state, sun);
  if (b->arkode == NULL) return PENDRES_OUT_OF_MEMORY;
  if (pendres_compat_silence(sun, b->arkode, NULL) != 0) return PENDRES_INTEGRATION_FAILED;
  butcher = pendres_flow_table(b->ctx->options.table, b->tolerance == 0.0, &b->drive.stages);
  if (butcher == NULL) return PENDRES_OUT_OF_MEMORY;
  if (b->drive.stages > PENDRES_TABLES_MOST_STAGES) {
    ARKodeButcherTable_Free(butcher);
    return PENDRES_INTERNAL;
  }
  for (int i = 0; i < b->drive.stages; i++) b->drive.node[i] = butcher->c[i];

  int bad = ERKStepSetTable(b->arkode, butcher) != 0 ||
            ERKStepSetUserData(b->arkode, b) != 0 ||
            ERKStepSetPostprocessStepFn(b->arkode, after_step) != 0 ||
            ERKStepSetMaxNumSteps(b->arkode, (long)PENDRES_MOST_SOLVER_STEPS) != 0 ||
            ERKStepSetMaxHnilWarns(b->arkode, -1) != 0 ||
            ERKStepSetInterpolantType(b->arkode, ARK_INTERP_LAGRANGE) != 0 ||
            ERKStepSetInterpolantDegree(b->arkode, b->tolerance == 0.0 ? 0 : 1) != 0;
  if (!bad && b->tolerance == 0.0)
    bad = ERKStepWFtolerances(b->arkode, unit_weights) != 0;
  else if (!bad)
    bad = ERKStepSStolerances(b->arkode, b->tolerance, b->tolerance) != 0 ||
          pendres_flow_set_controller(b->arkode) != 0;
  if (bad) status = PENDRES_OUT_OF_MEMORY; /* nothing else can be wrong with these settings */
  ARKodeButcherTable_Free(butcher);
  return status;
}

/* All that can be done of a block but the integrator. */
static pendres_status open_lanes(pendres_block *b, size_t rows)
{
  if (pendres_lanes_open(&b->shape, rows, b->lanes, pendres_kernels_select()) != 0 ||
      pendres_block_lanes_open(b) != 0)
    return PENDRES_OUT_OF_MEMORY;
  b->shape.norm_unused = b->tolerance == 0.0;
  b->replays = pendres_lanes_replays_create();
  b->state = b->replays != NULL ? pendres_lanes_create(&b->shape, b->ctx->sun) : NULL;
  return b->state != NULL ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

pendres_status pendres_block_create(pendres_context *ctx, size_t rows, double tolerance,
                                    pendres_block **out)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_block *b = *out = calloc(1, sizeof *b);
  if (b != NULL) {
    b->ctx = ctx;
    b->lanes = (size_t)ctx->options.block_lanes;
    b->next_asked = (double)PENDRES_STEPS_BETWEEN_CHECKS;
    b->tolerance = tolerance;
    status = open_lanes(b, rows);
    if (status == PENDRES_OK) status = arkode_setup(b);
    if (status == PENDRES_OK && b->shape.starved) status = PENDRES_OUT_OF_MEMORY;
  }
  if (status == PENDRES_OK) return status;
  pendres_block_free(b);
  *out = NULL;
  return pendres_context_fail(ctx, status, "no block of pendulums could be set up: %s",
                              pendres_status_message(status));
}

void pendres_block_free(pendres_block *b)
{
  if (b == NULL) return;
  if (b->arkode != NULL) ERKStepFree(&b->arkode);
  if (b->state != NULL) N_VDestroy(b->state);
  pendres_lanes_close(&b->shape);
  pendres_lanes_replays_free(b->replays);
  pendres_block_lanes_close(b);
  pendres_block_drive_free(&b->drive);
  pendres_block_alone_free(b);
  free(b);
}

/* Say how a block has failed. */
static pendres_status tell(const pendres_block *b, pendres_status status)
{
  if (status == PENDRES_OK) return status;
  if (status == PENDRES_INTERRUPTED)
    return pendres_context_fail(b->ctx, status, "interrupted on request");
  if (status == PENDRES_OUT_OF_MEMORY)
    return pendres_context_fail(b->ctx, status, "out of memory for the steps of a period");
  return pendres_context_fail(b->ctx, status, "ARKODE gave up within a drive period (code %d)",
                              b->failure);
}

pendres_status pendres_block_set_longest_step(pendres_block *b, double longest)
{
  if (!(longest >= 0.0) || b->tolerance == 0.0) return tell(b, PENDRES_INVALID_ARGUMENT);
  return tell(b, ERKStepSetMaxStep(b->arkode, longest) == 0 ? PENDRES_OK : PENDRES_INTERNAL);
}

pendres_status pendres_block_set_steps(pendres_block *b, int steps)
{
  if (steps < 1 || b->tolerance != 0.0) return tell(b, PENDRES_INVALID_ARGUMENT);
  if (steps == b->drive.steps) return PENDRES_OK;
  if (pendres_block_drive_resize(&b->drive, steps) != 0) return tell(b, PENDRES_OUT_OF_MEMORY);
  const double h = two_pi / steps;
  b->failure = ERKStepSetFixedStep(b->arkode, h);
  if (b->failure != 0) return tell(b, PENDRES_INTEGRATION_FAILED);
  b->drive.steps = steps;
  /* A stop at 2 pi itself would shorten the last step, or add a tiny one, since the clock is off by
     rounding. */
  b->end = 0.0;
  for (int i = 0; i < steps; i++) {
    if (2 * i == steps) b->half = b->end;
    b->end += h;
  }
  return PENDRES_OK;
}

size_t pendres_flow_kind_rows(pendres_flow_kind kind)
{
  static const size_t rows[PENDRES_FLOW_KINDS] = {
    [PENDRES_FLOW_STATE] = PENDRES_ROWS_STATE,
    [PENDRES_FLOW_VARIATIONAL] = PENDRES_ROWS_VARIATIONAL,
    [PENDRES_FLOW_SENSITIVITY] = PENDRES_ROWS_SENSITIVITY,
    [PENDRES_FLOW_DRIVES] = PENDRES_ROWS_DRIVES,
    [PENDRES_FLOW_FORCE] = PENDRES_ROWS_FORCE,
    [PENDRES_FLOW_ALL] = PENDRES_ROWS_ALL};
  return rows[kind];
}

pendres_status pendres_block_of(pendres_context *ctx, pendres_flow_kind kind, pendres_block **out)
{
  pendres_block **own = &ctx->blocks[kind];
  pendres_status status = PENDRES_OK;
  /* ARKODE (6.4) crashes when it is called again after an allocation has failed. */
  if (*own != NULL && (*own)->failure == ARK_MEM_FAIL) {
    pendres_block_free(*own);
    *own = NULL;
  }
  if (*own == NULL) status = pendres_block_create(ctx, pendres_flow_kind_rows(kind), 0.0, own);
  *out = *own;
  return status;
}

pendres_status pendres_block_open(pendres_context *ctx, pendres_flow_kind kind, int steps,
                                  pendres_block **out)
{
  const pendres_status status = pendres_block_of(ctx, kind, out);
  if (status != PENDRES_OK) return status;
  pendres_block_clear(*out);
  return pendres_block_set_steps(*out, steps);
}

/* Put the clock back to phase 0, with the block's present state. */
static pendres_status start_period(pendres_block *b, double end)
{
  pendres_block_drive_rewind(&b->drive);
  b->stopped = 0;
  pendres_lanes_write(b->state, b->rows);
  b->failure = ERKStepReset(b->arkode, 0.0, b->state);
  if (b->failure == 0) b->failure = ERKStepSetStopTime(b->arkode, end);
  return b->failure == 0 ? PENDRES_OK : PENDRES_INTEGRATION_FAILED;
}

/* What a block is asked for: a period, half of one, or a period step by step. */
enum { SPAN_PERIOD, SPAN_HALF, SPAN_SAMPLED };

static pendres_lanes_replay_kind kind_of(const pendres_block *b, int span)
{
  return (pendres_lanes_replay_kind){
    .steps = b->drive.steps, .span = span, .carried = (int)b->load,
    .driven = b->load != PENDRES_FLOW_NOTHING && b->shape.model != PENDRES_MODEL_PLAIN};
}

/* The record of such a period; NULL: there is none. Wide blocks have none: they would gain nothing,
   and stop() would be called too seldom. */
static const pendres_lanes_replay *known(pendres_block *b, int span)
{
  const int steps = b->drive.steps;
  if (steps == 0 || (double)b->lanes * steps > (double)PENDRES_STEPS_BETWEEN_CHECKS) return NULL;
  const pendres_lanes_replay_kind kind = kind_of(b, span);
  const pendres_lanes_replay *p = pendres_lanes_replays_find(b->replays, &kind);
  if (p != NULL) return p;
  pendres_lanes_replays_begin(b->replays);
  pendres_lanes_tape_record(&b->shape, b->replays);
  return NULL;
}

/* A part of the period is over: copy the state to the rows that the rest of the engine reads. */
static void show(pendres_block *b)
{
  pendres_lanes_read(b->state, b->rows);
  pendres_lanes_replays_part(b->replays);
}

/* ARKODE has come to the end of a period: its record is complete. */
static void learn(pendres_block *b, int span)
{
  const pendres_lanes_replay_kind kind = kind_of(b, span);
  pendres_lanes_tape_record(&b->shape, NULL);
  pendres_lanes_replays_end(b->replays, &kind, b->failure >= 0);
}

/* A period without ARKODE; sample may be NULL. */
static pendres_status replay(pendres_block *b, const pendres_lanes_replay *p, int steps,
                             pendres_block_sample *sample, void *arg)
{
  size_t done = 0;
  b->stopped = 0;
  pendres_lanes_write(b->state, b->rows);
  for (size_t k = 0; k < p->parts; k++) {
    pendres_lanes_shape_run(&b->shape, p->operation + done, p->end[k] - done);
    done = p->end[k];
    pendres_lanes_read(b->state, b->rows);
    const pendres_rows rows = pendres_block_rows(b);
    if (sample != NULL) sample(arg, (int)k + 1, &rows);
  }
  b->evaluations += (double)p->slopes * (double)b->lanes;
  return count_steps(b, steps) == 0 ? PENDRES_OK : PENDRES_INTERRUPTED;
}

/* How a call of ARKODE has ended. */
static pendres_status ended(const pendres_block *b)
{
  if (b->shape.starved) return PENDRES_OUT_OF_MEMORY;
  if (b->failure >= 0) return PENDRES_OK;
  if (b->failure == ARK_MEM_FAIL) return PENDRES_OUT_OF_MEMORY;
  return b->stopped ? PENDRES_INTERRUPTED : PENDRES_INTEGRATION_FAILED;
}

static pendres_status advance_to(pendres_block *b, int span, double end)
{
  sunrealtype reached = 0.0;
  const pendres_lanes_replay *p = known(b, span);
  if (p != NULL)
    return replay(b, p, b->drive.steps / (span == SPAN_HALF ? 2 : 1), NULL, NULL);
  const pendres_status status = start_period(b, end);
  if (status == PENDRES_OK)
    b->failure = ERKStepEvolve(b->arkode, end, b->state, &reached, ARK_NORMAL);
  if (status == PENDRES_OK) show(b);
  learn(b, span);
  return status != PENDRES_OK ? status : ended(b);
}

/* A period that ARKODE has no part in. */
static pendres_status advance_alone(pendres_block *b, pendres_flow_way way)
{
  const int steps = b->drive.steps;
  const int slopes = pendres_block_run_nystrom(b, way == PENDRES_FLOW_SINGLE);
  if (slopes < 0) return slopes == PENDRES_BLOCK_STARVED ? PENDRES_OUT_OF_MEMORY
                                                         : PENDRES_INVALID_ARGUMENT;
  b->stopped = 0;
  b->evaluations += (double)slopes * (double)b->lanes;
  return count_steps(b, steps) == 0 ? PENDRES_OK : PENDRES_INTERRUPTED;
}

static pendres_status advance_sampled(pendres_block *b, pendres_block_sample *sample, void *arg)
{
  sunrealtype reached = 0.0;
  if (b->drive.steps < 1) return PENDRES_INVALID_ARGUMENT;
  const pendres_lanes_replay *p = known(b, SPAN_SAMPLED);
  if (p != NULL) return replay(b, p, b->drive.steps, sample, arg);
  pendres_status status = start_period(b, b->end);
  for (int step = 1; step <= b->drive.steps && status == PENDRES_OK; step++) {
    b->failure = ERKStepEvolve(b->arkode, b->end, b->state, &reached, ARK_ONE_STEP);
    status = ended(b);
    if (status != PENDRES_OK) break;
    show(b);
    const pendres_rows rows = pendres_block_rows(b);
    sample(arg, step, &rows);
  }
  learn(b, SPAN_SAMPLED);
  return status;
}

/* After that many periods: count what they cost, or say how they failed. */
static pendres_status ran(pendres_block *b, double periods, pendres_status status)
{
  if (status == PENDRES_OK) b->ctx->cost.pendulum_periods += (double)b->lanes * periods;
  return tell(b, status);
}

pendres_status pendres_block_period_by(pendres_block *b, pendres_flow_way way)
{
  pendres_status status = pendres_context_poll(b->ctx);
  if (status != PENDRES_OK) return status;
  status = way == PENDRES_FLOW_TABLE
             ? advance_to(b, SPAN_PERIOD, b->drive.steps > 0 ? b->end : two_pi)
             : advance_alone(b, way);
  return ran(b, 1.0, status);
}

pendres_status pendres_block_period(pendres_block *b)
{
  return pendres_block_period_by(b, PENDRES_FLOW_TABLE);
}

pendres_status pendres_block_half_period(pendres_block *b)
{
  const pendres_status status = pendres_context_poll(b->ctx);
  if (status != PENDRES_OK) return status;
  if (b->drive.steps < 1 || b->drive.steps % 2 != 0) return tell(b, PENDRES_INVALID_ARGUMENT);
  return ran(b, 0.5, advance_to(b, SPAN_HALF, b->half));
}

pendres_status pendres_block_period_sampled(pendres_block *b, pendres_block_sample *sample,
                                            void *arg)
{
  const pendres_status status = pendres_context_poll(b->ctx);
  return status == PENDRES_OK ? ran(b, 1.0, advance_sampled(b, sample, arg)) : status;
}

double pendres_block_evaluations(const pendres_block *b)
{
  return b->evaluations;
}

double pendres_block_steps(const pendres_block *b)
{
  return b->steps_taken;
}

/* ---- The drive ------------------------------------------------------------------------------ */

/*
 * ARKODE adds up its clock step by step and always rounds in the same direction: after 3e5 steps
 * its error is 1e-10. The exact phase is a whole number of steps plus the node of a stage.
 */
double pendres_block_drive_phase(const pendres_block_drive *d, double theta)
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

double pendres_block_drive_cosine(pendres_block_drive *d, double theta)
{
  if (d->next >= d->size) return cos(theta); /* adaptive steps, or an unforeseen call */
  const size_t i = d->next++;
  if (d->theta[i] != theta) {
    d->theta[i] = theta;
    d->cosine[i] = cos(pendres_block_drive_phase(d, theta));
  }
  return d->cosine[i];
}

void pendres_block_drive_rewind(pendres_block_drive *d)
{
  d->next = 0;
}

int pendres_block_drive_resize(pendres_block_drive *d, int steps)
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

void pendres_block_drive_free(pendres_block_drive *d)
{
  free(d->theta);
  free(d->cosine);
}

/* ---- Kernels --------------------------------------------------------------------------------- */

const pendres_kernels *pendres_kernels_select(void)
{
  return PENDRES_INSTRUCTIONS_BEST(pendres_kernels);
}
