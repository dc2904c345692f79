/* block_lanes.c -- the contents of the lanes of a block; see block.h. */
#include "engine/block.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/block_internal.h"
#include "model/equation.h"
#include "model/formula/formula.h"

int pendres_block_lanes_open(pendres_block *b)
{
  double *const *c = b->coefficient;
  for (int i = 0; i < COEFFICIENTS; i++) {
    b->coefficient[i] = pendres_lanes_allocate(b->shape.capacity);
    if (b->coefficient[i] == NULL) return -1;
  }
#define ARRAY(name, value) .name = c[PLACE_##name],
  b->shape.coefficients = (pendres_coefficients){
    PENDRES_COEFFICIENTS_PLAIN(ARRAY) PENDRES_COEFFICIENTS_OTHER(ARRAY)};
#undef ARRAY
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++)
    b->shape.coefficients.power[i] = c[POWERS + i];
  b->rows = pendres_lanes_allocate(b->shape.rows * b->shape.capacity);
  return b->rows != NULL ? 0 : -1;
}

void pendres_block_lanes_close(pendres_block *b)
{
  free(b->rows);
  for (int i = 0; i < COEFFICIENTS; i++) free(b->coefficient[i]);
  for (int i = 0; i < CARRIED; i++) free(b->off[i]);
}

void pendres_block_clear(pendres_block *b)
{
  pendres_block_resize(b, 0);
  b->shape.model = PENDRES_MODEL_PLAIN;
  b->shape.coefficients.formula = NULL;
  b->shape.drags = 0;
}

void pendres_block_resize(pendres_block *b, size_t lanes)
{
  const size_t old = b->shape.stride;
  double *data = b->rows;
  pendres_lanes_resize(&b->shape, lanes);
  const size_t stride = b->shape.stride;

  /* Rows move towards lower addresses when shrinking, to higher ones when growing. */
  if (stride < old)
    for (size_t r = 1; r < b->shape.rows; r++)
      memmove(data + r * stride, data + r * old, stride * sizeof *data);
  else if (stride > old)
    for (size_t r = b->shape.rows; r-- > 0;) {
      memmove(data + r * stride, data + r * old, old * sizeof *data);
      memset(data + r * stride + old, 0, (stride - old) * sizeof *data);
    }
  b->lanes = lanes;
  /* Lanes that only fill up a vector are at rest at the bottom, so that no special case is needed.
     */
  for (size_t i = lanes; i < stride; i++) {
    for (size_t r = 0; r < b->shape.rows; r++) data[r * stride + i] = 0.0;
    for (int c = 0; c < COEFFICIENTS; c++) b->coefficient[c][i] = 0.0;
    for (int c = 0; c < CARRIED; c++)
      if (b->off[c] != NULL) b->off[c][i] = 0.0;
  }
}

size_t pendres_block_capacity(const pendres_block *b)
{
  return b->shape.capacity;
}

void pendres_block_load(pendres_block *b, size_t lane, const pendres_pendulum *p, double y,
                        double w)
{
  const size_t stride = b->shape.stride;
  double *data = b->rows;

#define LOAD(name, value) b->coefficient[PLACE_##name][lane] = value;
  PENDRES_COEFFICIENTS_PLAIN(LOAD)
  PENDRES_COEFFICIENTS_OTHER(LOAD)
#undef LOAD
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++)
    b->coefficient[POWERS + i][lane] = p->force_coefficients[i];
  const pendres_model_terms model = pendres_model_kind(p);
  if (model > b->shape.model) b->shape.model = model;
  if (model >= PENDRES_MODEL_FORMULA)
    b->shape.coefficients.formula = pendres_formula_of(p->force);
  b->shape.drags |= pendres_equation_drags(p);
  for (size_t r = 0; r < b->shape.rows; r++) data[r * stride + lane] = 0.0;
  pendres_block_put_state(b, lane, y, w);
  if (b->shape.rows >= PENDRES_ROWS_VARIATIONAL) {
    data[PENDRES_ROW_BY_Y * stride + lane] = 1.0;
    data[(PENDRES_ROW_BY_W + 1) * stride + lane] = 1.0;
  }
}

void pendres_block_move_lane(pendres_block *b, size_t from, size_t to)
{
  double *data = b->rows;
  for (size_t r = 0; r < b->shape.rows; r++)
    data[r * b->shape.stride + to] = data[r * b->shape.stride + from];
  for (int c = 0; c < COEFFICIENTS; c++) b->coefficient[c][to] = b->coefficient[c][from];
  for (int c = 0; c < CARRIED; c++)
    if (b->off[c] != NULL) b->off[c][to] = b->off[c][from];
}

pendres_status pendres_block_carry(pendres_block *b, pendres_flow_load load)
{
  double *const *off = b->off;
  b->shape.off = (pendres_carried){0};
  b->shape.tangent = (pendres_tangents){0};
  b->load = PENDRES_FLOW_NOTHING;
  if (load == PENDRES_FLOW_NOTHING) return PENDRES_OK;
  if (b->shape.rows != PENDRES_ROWS_STATE || b->tolerance != 0.0)
    return pendres_context_fail(b->ctx, PENDRES_INVALID_ARGUMENT,
                                "a block of states with fixed steps alone carries more");
  for (int i = 0; i < CARRIED; i++) {
    if (b->off[i] == NULL) b->off[i] = pendres_lanes_allocate(b->shape.capacity);
    if (b->off[i] == NULL)
      return pendres_context_fail(b->ctx, PENDRES_OUT_OF_MEMORY,
                                  "out of memory for what %zu lanes carry along",
                                  b->shape.capacity);
  }
  if (load == PENDRES_FLOW_ERRORS)
    b->shape.off = (pendres_carried){off[0], off[1], off[2], off[3], off[4], off[5]};
  else
    b->shape.tangent = (pendres_tangents){{off[TANGENT_Y], off[TANGENT_Y + 1]},
                                          {off[TANGENT_W], off[TANGENT_W + 1]},
                                          off[TANGENT_KEEP]};
  b->load = load;
  return PENDRES_OK;
}

void pendres_block_set_error(pendres_block *b, size_t lane, const pendres_flow_error *error,
                             double added)
{
  b->off[ERROR_YY][lane] = error->yy;
  b->off[ERROR_YW][lane] = error->yw;
  b->off[ERROR_WW][lane] = error->ww;
  b->off[ERROR_ADDED][lane] = added;
  /* The drag by the mean of both ends of a step, so that it contracts however large it is. */
  const double step = two_pi / b->drive.steps;
  const double drag = 0.5 * step * b->coefficient[PLACE_friction][lane];
  b->off[ERROR_KEEP][lane] = (1.0 - drag) / (1.0 + drag);
  b->off[ERROR_KICK][lane] = step * b->coefficient[PLACE_stiffness][lane] / (1.0 + drag);
}

pendres_flow_error pendres_block_get_error(const pendres_block *b, size_t lane)
{
  double *const *off = b->off;
  return (pendres_flow_error){off[ERROR_YY][lane], off[ERROR_YW][lane], off[ERROR_WW][lane]};
}

/* Half of what friction takes of a lane's w. */
static double half_drag(const pendres_block *b, size_t lane)
{
  double *const *c = b->coefficient;
  const double y = b->rows[lane], speed = fabs(b->rows[b->shape.stride + lane]);
  const double friction = c[PLACE_friction][lane];
  if (!b->shape.drags) return 0.5 * friction;
  return 0.5 * (friction + c[PLACE_nonlinear][lane] * y * y +
                speed * (2.0 * c[PLACE_quadratic][lane] + 3.0 * speed * c[PLACE_cubic][lane]));
}

void pendres_block_put_tangent(pendres_block *b, size_t lane, int which, const double tangent[2])
{
  const double drag = half_drag(b, lane);
  b->off[TANGENT_Y + which][lane] = tangent[0];
  b->off[TANGENT_W + which][lane] = fma(drag, tangent[0], tangent[1]);
  b->off[TANGENT_KEEP][lane] = exp(-drag * two_pi / b->drive.steps);
}

void pendres_block_get_tangent(const pendres_block *b, size_t lane, int which, double tangent[2])
{
  const double drag = half_drag(b, lane);
  tangent[0] = b->off[TANGENT_Y + which][lane];
  tangent[1] = fma(-drag, tangent[0], b->off[TANGENT_W + which][lane]);
}

pendres_rows pendres_block_rows(const pendres_block *b)
{
  return (pendres_rows){.at = b->rows, .stride = b->shape.stride};
}

void pendres_block_put_state(pendres_block *b, size_t lane, double y, double w)
{
  b->rows[PENDRES_ROW_Y * b->shape.stride + lane] = y;
  b->rows[PENDRES_ROW_W * b->shape.stride + lane] = w;
}
