/* lanes_shape.c -- the strips of a block, and operations on them; see lanes_shape.h. */
#include "engine/sundials/lanes_shape.h"

#include "engine/sundials/numbers.h"

static size_t most_lanes(size_t rows)
{
  if (rows <= PENDRES_ROWS_STATE) return LANES_OF_STATES;
  return rows <= PENDRES_ROWS_VARIATIONAL ? LANES_OF_TANGENTS : LANES_OF_MORE;
}

void pendres_lanes_shape_cut(pendres_lanes_shape *s, size_t lanes)
{
  const size_t most = most_lanes(s->rows), unit = PENDRES_LANES_MULTIPLE;
  s->stride = (lanes + unit - 1) / unit * unit;
  /* As few strips as can be, and as equal. */
  const size_t strips = s->stride > 0 ? (s->stride + most - 1) / most : 1;
  s->strip = s->stride / unit / strips * unit;
  s->wider = s->stride / unit % strips * (s->strip + unit);
}

#define FROM_LANE(name, value) .name = k->name + lane,
#define SET_FROM_LANE(name, value) strip.k.name = k->name + lane;

void pendres_lanes_shape_run(const pendres_lanes_shape *s, const pendres_operation *operations,
                             size_t n)
{
  for (size_t lane = 0, lanes; lane < s->stride; lane += lanes) {
    const pendres_coefficients *k = &s->coefficients;
    lanes = pendres_lanes_strip(s, lane);
    const pendres_carried *off = &s->off;
    const pendres_tangents *tangent = &s->tangent;
    pendres_strip strip = {
      .lanes = lanes,
      .model = s->model,
      .drags = s->drags,
      .at = s->rows * lane,
      .k = {PENDRES_COEFFICIENTS_PLAIN(FROM_LANE)}};
    /* Kernels of the plain pendulum have no rows of derivatives by what it lacks. */
    if (s->model != PENDRES_MODEL_PLAIN || s->rows > PENDRES_ROWS_SENSITIVITY) {
      PENDRES_COEFFICIENTS_OTHER(SET_FROM_LANE)
      for (int i = 0; i < PENDRES_FORCE_POWERS; i++) strip.k.power[i] = k->power[i] + lane;
      strip.k.formula = k->formula;
    }
    if (off->yy != NULL)
      strip.off = (pendres_carried){off->yy + lane,    off->yw + lane,   off->ww + lane,
                                    off->added + lane, off->keep + lane, off->kick + lane};
    if (tangent->keep != NULL)
      strip.tangent = (pendres_tangents){{tangent->y[0] + lane, tangent->y[1] + lane},
                                         {tangent->w[0] + lane, tangent->w[1] + lane},
                                         tangent->keep + lane};
    s->kernels->run(s->rows, &strip, operations, n);
  }
}
