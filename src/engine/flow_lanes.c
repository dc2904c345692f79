/* flow_lanes.c -- the contents of the lanes of a block; see flow.h. */
#include "engine/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/flow_internal.h"

int pendres_flow_lanes_open(pendres_flow *flow)
{
  double *const *c = flow->coefficient;
  for (int i = 0; i < COEFFICIENTS; i++) {
    flow->coefficient[i] = pendres_lanes_allocate(flow->shape.capacity);
    if (flow->coefficient[i] == NULL) return -1;
  }
  flow->shape.coefficients = (pendres_coefficients){
    .stiffness = c[STIFFNESS], .drive = c[DRIVE], .friction = c[FRICTION],
    .inverse = c[INVERSE], .torque = c[TORQUE], .modulation = c[MODULATION]};
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++)
    flow->shape.coefficients.power[i] = c[POWERS + i];
  flow->rows = pendres_lanes_allocate(flow->shape.rows * flow->shape.capacity);
  return flow->rows != NULL ? 0 : -1;
}

void pendres_flow_lanes_close(pendres_flow *flow)
{
  free(flow->rows);
  for (int i = 0; i < COEFFICIENTS; i++) free(flow->coefficient[i]);
  for (int i = 0; i < CARRIED; i++) free(flow->off[i]);
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
  /* Lanes that only fill up a vector are at rest at the bottom, so that no special case is needed.
     */
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
  flow->off[ERROR_YY][lane] = error->yy;
  flow->off[ERROR_YW][lane] = error->yw;
  flow->off[ERROR_WW][lane] = error->ww;
  flow->off[ERROR_ADDED][lane] = added;
  /* The drag by the mean of both ends of a step, so that it contracts however large it is. */
  const double step = two_pi / flow->drive.steps;
  const double drag = 0.5 * step * flow->coefficient[FRICTION][lane];
  flow->off[ERROR_KEEP][lane] = (1.0 - drag) / (1.0 + drag);
  flow->off[ERROR_KICK][lane] = step * flow->coefficient[STIFFNESS][lane] / (1.0 + drag);
}

pendres_flow_error pendres_flow_get_error(const pendres_flow *flow, size_t lane)
{
  double *const *off = flow->off;
  return (pendres_flow_error){off[ERROR_YY][lane], off[ERROR_YW][lane], off[ERROR_WW][lane]};
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
