/* flow.c -- a block of pendulums on one ARKODE problem; see flow.h. */
#include "engine/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>

#include "base/angles.h"
#include "engine/compat.h"
#include "engine/flow_drive.h"
#include "engine/flow_table.h"
#include "engine/lanes.h"
#include "engine/lanes_replay.h"
#include "engine/lanes_tape.h"
#include "engine/tables.h"

/* Of all lanes together, between two questions whether to go on: some hundredths of a second. */
static const double steps_between = 300000.0;

/* Arrays of coefficients, an entry a lane. */
enum {
  STIFFNESS,
  DRIVE,
  FRICTION,
  INVERSE,
  TORQUE,
  MODULATION,
  POWERS,
  COEFFICIENTS = POWERS + PENDRES_FORCE_COEFFICIENTS
};

/* Rows of what is carried: of errors, as in pendres_carried, or of tangents. */
enum { CARRIED = 6, TANGENT_Y = 0, TANGENT_W = 2, TANGENT_KEEP = 4 };

struct pendres_flow {
  pendres_lanes_shape shape;
  double tolerance;
  double end, half;         /* ARKODE's clock after a period and half of one */
  N_Vector state;
  double *rows;           /* the state for everybody else, row after row */
  double *coefficient[COEFFICIENTS];
  pendres_flow_load load; /* what is carried, */
  double *off[CARRIED];   /* in these; NULL until anything is */
  pendres_flow_drive drive;
  pendres_lanes_replays *replays; /* of periods with fixed steps */
  void *arkode;
  double evaluations, steps_taken;
  int (*stop)(void *arg); /* asked now and then within a period; NULL: nobody is */
  void *stop_arg;
  double next_asked;      /* once so many steps have been taken */
  int stopped;
  size_t lanes; /* in use */
  int failure;
};

static int right_hand_side(sunrealtype theta, N_Vector y, N_Vector slope, void *arg)
{
  pendres_flow *flow = arg;
  pendres_lanes_slope(y, slope, pendres_flow_drive_cosine(&flow->drive, theta));
  flow->evaluations += (double)flow->lanes;
  return 0;
}

/* Steps have been taken; nonzero: somebody wants the block to stop. */
static int count_steps(pendres_flow *flow, int steps)
{
  flow->steps_taken += (double)steps * (double)flow->lanes;
  if (flow->steps_taken < flow->next_asked) return 0;
  flow->next_asked = flow->steps_taken + steps_between;
  flow->stopped = flow->stop != NULL && flow->stop(flow->stop_arg) != 0;
  return flow->stopped ? -1 : 0;
}

/*
 * ERKStep before SUNDIALS 6.7 takes every table whose last node is 1 as
 * first-same-as-last and reuses a wrong stage. A step-postprocess function makes
 * it evaluate the slope anew.
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

/* With fixed steps nobody reads the weights: leave them at one. */
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
            ERKStepSetMaxNumSteps(flow->arkode, 100000000L) != 0 ||
            ERKStepSetMaxHnilWarns(flow->arkode, -1) != 0 ||
            ERKStepSetInterpolantType(flow->arkode, ARK_INTERP_LAGRANGE) != 0 ||
            ERKStepSetInterpolantDegree(flow->arkode, flow->tolerance == 0.0 ? 0 : 1) != 0;
  if (!bad && flow->tolerance == 0.0)
    bad = ERKStepWFtolerances(flow->arkode, unit_weights) != 0;
  else if (!bad)
    bad = ERKStepSStolerances(flow->arkode, flow->tolerance, flow->tolerance) != 0 ||
          pendres_flow_set_controller(flow->arkode) != 0;
  if (bad) status = PENDRES_OUT_OF_MEMORY; /* nothing else is wrong with what is set */
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
  flow->next_asked = steps_between;
  flow->tolerance = options->tolerance;
  for (int i = 0; i < COEFFICIENTS; i++) {
    flow->coefficient[i] = pendres_lanes_allocate(flow->shape.capacity);
    if (flow->coefficient[i] == NULL) goto fail;
  }
  flow->shape.coefficients =
    (pendres_coefficients){.stiffness = flow->coefficient[STIFFNESS],
                           .drive = flow->coefficient[DRIVE],
                           .friction = flow->coefficient[FRICTION],
                           .inverse = flow->coefficient[INVERSE],
                           .torque = flow->coefficient[TORQUE],
                           .modulation = flow->coefficient[MODULATION]};
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++)
    flow->shape.coefficients.power[i] = flow->coefficient[POWERS + i];
  flow->replays = pendres_lanes_replays_create();
  if (flow->replays == NULL) goto fail;
  flow->state = pendres_lanes_create(&flow->shape, sun);
  flow->rows = pendres_lanes_allocate(flow->shape.rows * flow->shape.capacity);
  if (flow->state == NULL || flow->rows == NULL) goto fail;
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
  free(flow->rows);
  for (int i = 0; i < COEFFICIENTS; i++) free(flow->coefficient[i]);
  for (int i = 0; i < CARRIED; i++) free(flow->off[i]);
  pendres_flow_drive_free(&flow->drive);
  free(flow);
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
  /* A stop at 2 pi itself would cut the last step, or add one, by what the clock is off. */
  flow->end = 0.0;
  for (int i = 0; i < steps; i++) {
    if (2 * i == steps) flow->half = flow->end;
    flow->end += h;
  }
  return PENDRES_OK;
}

void pendres_flow_clear(pendres_flow *flow)
{
  pendres_flow_resize(flow, 0);
  flow->shape.model = PENDRES_MODEL_PLAIN;
}

void pendres_flow_resize(pendres_flow *flow, size_t lanes)
{
  const size_t old = flow->shape.stride;
  double *data = flow->rows;
  pendres_lanes_resize(&flow->shape, lanes);
  const size_t stride = flow->shape.stride;

  /* Rows move towards lower addresses when shrinking, to higher ones when growing. */
  if (stride < old)
    for (size_t r = 1; r < flow->shape.rows; r++)
      memmove(data + r * stride, data + r * old, stride * sizeof *data);
  else if (stride > old)
    for (size_t r = flow->shape.rows; r-- > 0;) {
      memmove(data + r * stride, data + r * old, old * sizeof *data);
      memset(data + r * stride + old, 0, (stride - old) * sizeof *data);
    }
  flow->lanes = lanes;
  /* Lanes that only fill up a vector rest at the bottom, and cost no special case. */
  for (size_t i = lanes; i < stride; i++) {
    for (size_t r = 0; r < flow->shape.rows; r++) data[r * stride + i] = 0.0;
    for (int c = 0; c < COEFFICIENTS; c++) flow->coefficient[c][i] = 0.0;
    for (int c = 0; c < CARRIED; c++)
      if (flow->off[c] != NULL) flow->off[c][i] = 0.0;
  }
}

size_t pendres_flow_capacity(const pendres_flow *flow)
{
  return flow->shape.capacity;
}

void pendres_flow_set_lane(pendres_flow *flow, size_t lane, const pendres_pendulum *p, double y,
                           double w)
{
  const size_t stride = flow->shape.stride;
  const double omega = p->drive_frequency;
  double *data = flow->rows;

  flow->coefficient[STIFFNESS][lane] = 1.0 / (omega * omega);
  flow->coefficient[DRIVE][lane] = p->drive_amplitude / (omega * omega);
  flow->coefficient[FRICTION][lane] = p->damping / omega;
  flow->coefficient[INVERSE][lane] = 1.0 / omega;
  flow->coefficient[TORQUE][lane] = p->torque / (omega * omega);
  flow->coefficient[MODULATION][lane] = p->parametric_amplitude;
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++)
    flow->coefficient[POWERS + i][lane] = p->force_coefficients[i];
  const pendres_model_terms model = pendres_model_kind(p);
  if (model > flow->shape.model) flow->shape.model = model;
  for (size_t r = 0; r < flow->shape.rows; r++) data[r * stride + lane] = 0.0;
  pendres_flow_put_state(flow, lane, y, w);
  if (flow->shape.rows >= PENDRES_ROWS_VARIATIONAL) {
    data[PENDRES_ROW_BY_Y * stride + lane] = 1.0;
    data[(PENDRES_ROW_BY_W + 1) * stride + lane] = 1.0;
  }
}

void pendres_flow_move_lane(pendres_flow *flow, size_t from, size_t to)
{
  double *data = flow->rows;
  for (size_t r = 0; r < flow->shape.rows; r++)
    data[r * flow->shape.stride + to] = data[r * flow->shape.stride + from];
  for (int c = 0; c < COEFFICIENTS; c++) flow->coefficient[c][to] = flow->coefficient[c][from];
  for (int c = 0; c < CARRIED; c++)
    if (flow->off[c] != NULL) flow->off[c][to] = flow->off[c][from];
}

pendres_status pendres_flow_carry(pendres_flow *flow, pendres_flow_load load)
{
  double *const *off = flow->off;
  flow->shape.off = (pendres_carried){0};
  flow->shape.tangent = (pendres_tangents){0};
  flow->load = PENDRES_FLOW_NOTHING;
  if (load == PENDRES_FLOW_NOTHING) return PENDRES_OK;
  if (flow->shape.rows != PENDRES_ROWS_STATE || flow->tolerance != 0.0)
    return PENDRES_INVALID_ARGUMENT;
  for (int i = 0; i < CARRIED; i++) {
    if (flow->off[i] == NULL) flow->off[i] = pendres_lanes_allocate(flow->shape.capacity);
    if (flow->off[i] == NULL) return PENDRES_OUT_OF_MEMORY;
  }
  if (load == PENDRES_FLOW_ERRORS)
    flow->shape.off = (pendres_carried){off[0], off[1], off[2], off[3], off[4], off[5]};
  else
    flow->shape.tangent = (pendres_tangents){{off[TANGENT_Y], off[TANGENT_Y + 1]},
                                             {off[TANGENT_W], off[TANGENT_W + 1]},
                                             off[TANGENT_KEEP]};
  flow->load = load;
  return PENDRES_OK;
}

void pendres_flow_set_error(pendres_flow *flow, size_t lane, const pendres_flow_error *error,
                            double added)
{
  flow->off[0][lane] = error->yy;
  flow->off[1][lane] = error->yw;
  flow->off[2][lane] = error->ww;
  flow->off[3][lane] = added;
  /* The drag by the mean of both ends of a step, so that it contracts however large it is. */
  const double step = two_pi / flow->drive.steps;
  const double drag = 0.5 * step * flow->coefficient[FRICTION][lane];
  flow->off[4][lane] = (1.0 - drag) / (1.0 + drag);
  flow->off[5][lane] = step * flow->coefficient[STIFFNESS][lane] / (1.0 + drag);
}

pendres_flow_error pendres_flow_get_error(const pendres_flow *flow, size_t lane)
{
  return (pendres_flow_error){flow->off[0][lane], flow->off[1][lane], flow->off[2][lane]};
}

void pendres_flow_set_tangent(pendres_flow *flow, size_t lane, int which, const double tangent[2])
{
  const double drag = 0.5 * flow->coefficient[FRICTION][lane];
  flow->off[TANGENT_Y + which][lane] = tangent[0];
  flow->off[TANGENT_W + which][lane] = fma(drag, tangent[0], tangent[1]);
  flow->off[TANGENT_KEEP][lane] = exp(-drag * two_pi / flow->drive.steps);
}

void pendres_flow_get_tangent(const pendres_flow *flow, size_t lane, int which, double tangent[2])
{
  const double drag = 0.5 * flow->coefficient[FRICTION][lane];
  tangent[0] = flow->off[TANGENT_Y + which][lane];
  tangent[1] = fma(-drag, tangent[0], flow->off[TANGENT_W + which][lane]);
}

pendres_rows pendres_flow_rows(const pendres_flow *flow)
{
  return (pendres_rows){.at = flow->rows, .stride = flow->shape.stride};
}

void pendres_flow_put_state(pendres_flow *flow, size_t lane, double y, double w)
{
  flow->rows[PENDRES_ROW_Y * flow->shape.stride + lane] = y;
  flow->rows[PENDRES_ROW_W * flow->shape.stride + lane] = w;
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

/* What is known of such a period. In wide blocks nothing would be gained, and nobody be asked
   whether to stop. */
static const pendres_lanes_replay *known(pendres_flow *flow, int span)
{
  const int steps = flow->drive.steps;
  if (steps == 0 || (double)flow->lanes * steps > steps_between) return NULL;
  const pendres_lanes_replay_kind kind = kind_of(flow, span);
  const pendres_lanes_replay *p = pendres_lanes_replays_find(flow->replays, &kind);
  if (p != NULL) return p;
  pendres_lanes_replays_begin(flow->replays);
  pendres_lanes_tape_record(&flow->shape, flow->replays);
  return NULL;
}

/* The numbers as they are now, for everybody else: a part of the period is over. */
static void show(pendres_flow *flow)
{
  pendres_lanes_read(flow->state, flow->rows);
  pendres_lanes_replays_part(flow->replays);
}

/* The end of a period that ARKODE was asked for. */
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
