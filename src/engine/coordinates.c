/* coordinates.c -- states on their way into lanes and out of them; see coordinates.h. */
#include "engine/coordinates.h"

#include <math.h>

#include "engine/flow.h"
#include "base/angles.h"
#include "base/limits.h"
#include "model/model.h"

/* What two_pi lacks, so that taking out many turns costs no digits. */
static const double two_pi_low = 2.4492935982947064e-16;

/* ---- states ---- */

const char *pendres_coordinates_refuses(const pendres_pendulum *p, double x, double v)
{
  const double w = p->drive_frequency, slowest = fmax(w, p->damping);
  if (!(isfinite(x) && isfinite(v))) return "position and velocity must be finite";
  if (!(fabs(x) <= pendres_farthest))
    return "beyond 1e15 double precision knows a position to a tenth of a radian at best";
  if (!(fabs(v) / slowest <= pendres_farthest && isfinite(v / w)))
    return "so fast a pendulum is beyond 1e15 within a period, where its angle is not known";
  if (!(fabs(p->drive_amplitude) / w / slowest <= pendres_farthest))
    return "so strong a drive shakes the pendulum farther than 1e15, where its angle is not known";
  if (!(fabs(p->torque) / w / slowest <= pendres_farthest))
    return "so strong a torque turns the pendulum farther than 1e15, where its angle is not known";
  if (!(p->damping / w <= pendres_farthest))
    return "so strong a damping acts within less of a period than double precision can tell";
  if (!(isfinite(1.0 / (w * w)) && isfinite(p->drive_amplitude / (w * w)) &&
        isfinite(p->torque / (w * w))))
    return "so low a drive frequency has a square that is zero in double precision";
  return NULL;
}

void pendres_coordinates_wrap(const pendres_pendulum *p, double *y, long *turns)
{
  if (fabs(*y) <= PENDRES_PI || pendres_model_of(p->force)->period == 0.0) return;
  const double k = rint(*y / two_pi);
  if (!(fabs(k + (double)*turns) * two_pi <= pendres_farthest)) {
    *y = NAN;
    return;
  }
  *y = fma(-k, two_pi_low, fma(-k, two_pi, *y));
  *turns += (long)k;
}

pendres_coordinates pendres_coordinates_in(const pendres_pendulum *p, double x, double v)
{
  pendres_coordinates s = {.y = NAN, .w = v / p->drive_frequency};
  if (!(fabs(x) <= pendres_farthest)) return s;
  const double origin = pendres_model_origin(p);
  /* Whole turns first: the difference would lose digits of a large x. */
  const double k = rint((x - origin) / pendres_model_turn(p));
  s.turns = (long)k;
  s.y = fma(-k, two_pi_low, fma(-k, two_pi, x)) - origin;
  pendres_coordinates_wrap(p, &s.y, &s.turns);
  return s;
}

pendres_coordinates pendres_coordinates_in_whole(const pendres_pendulum *p, double x, double v)
{
  return (pendres_coordinates){.y = x - pendres_model_origin(p), .w = v / p->drive_frequency};
}

void pendres_coordinates_out(const pendres_pendulum *p, const pendres_coordinates *s, double *x,
                             double *v)
{
  const double turns = (double)s->turns;
  *x = fma(two_pi, turns, fma(two_pi_low, turns, s->y + pendres_model_origin(p)));
  if (v != NULL) *v = s->w * p->drive_frequency;
}

void pendres_coordinates_arrive(const pendres_pendulum *p, double *y, double *w, long *turns)
{
  static const double nothing = 1e-290;
  pendres_coordinates_wrap(p, y, turns);
  if (p->drive_amplitude == 0.0 && p->torque == 0.0 && p->damping > 0.0 && fabs(*y) < nothing &&
      fabs(*w) < nothing)
    *y = *w = 0.0;
}

/* ---- blocks ---- */

pendres_status pendres_block_open(pendres_context *ctx, pendres_flow_kind kind, int steps,
                                  pendres_block *out)
{
  *out = (pendres_block){.ctx = ctx};
  pendres_status status = pendres_context_flow(ctx, kind, &out->flow);
  if (status != PENDRES_OK) return status;
  pendres_flow_clear(out->flow);
  status = pendres_flow_set_steps(out->flow, steps);
  return status == PENDRES_OK ? status : pendres_context_flow_failed(ctx, out->flow, status);
}

size_t pendres_block_capacity(const pendres_block *b)
{
  return pendres_flow_capacity(b->flow);
}

void pendres_block_resize(pendres_block *b, size_t lanes)
{
  b->lanes = lanes;
  pendres_flow_resize(b->flow, lanes);
}

void pendres_block_load(pendres_block *b, size_t lane, const pendres_pendulum *p, double y,
                        double w)
{
  pendres_flow_set_lane(b->flow, lane, p, y, w);
}

static pendres_status carry(pendres_block *b, pendres_flow_load load)
{
  const pendres_status status = pendres_flow_carry(b->flow, load);
  if (status == PENDRES_OK) return status;
  return pendres_context_fail(b->ctx, status, "out of memory for what %zu lanes carry along",
                              pendres_flow_capacity(b->flow));
}

pendres_status pendres_block_carry(pendres_block *b, int on)
{
  return carry(b, on ? PENDRES_FLOW_ERRORS : PENDRES_FLOW_NOTHING);
}

void pendres_block_set_error(pendres_block *b, size_t lane, const pendres_flow_error *error,
                             double added)
{
  pendres_flow_set_error(b->flow, lane, error, added);
}

pendres_flow_error pendres_block_get_error(const pendres_block *b, size_t lane)
{
  return pendres_flow_get_error(b->flow, lane);
}

void pendres_block_put_state(pendres_block *b, size_t lane, double y, double w)
{
  pendres_flow_put_state(b->flow, lane, y, w);
}

pendres_status pendres_block_carry_tangents(pendres_block *b, int on)
{
  return carry(b, on ? PENDRES_FLOW_TANGENTS : PENDRES_FLOW_NOTHING);
}

void pendres_block_put_tangent(pendres_block *b, size_t lane, int which, const double tangent[2])
{
  pendres_flow_set_tangent(b->flow, lane, which, tangent);
}

void pendres_block_get_tangent(const pendres_block *b, size_t lane, int which, double tangent[2])
{
  pendres_flow_get_tangent(b->flow, lane, which, tangent);
}

/* After a run of `periods` periods: count its cost, or report how it failed. */
static pendres_status ran(pendres_block *b, double periods, pendres_status status)
{
  if (status != PENDRES_OK) return pendres_context_flow_failed(b->ctx, b->flow, status);
  b->ctx->cost.pendulum_periods += (double)b->lanes * periods;
  return status;
}

pendres_status pendres_block_period(pendres_block *b)
{
  const pendres_status status = pendres_context_poll(b->ctx);
  return status == PENDRES_OK ? ran(b, 1.0, pendres_flow_period(b->flow)) : status;
}

pendres_status pendres_block_half_period(pendres_block *b)
{
  const pendres_status status = pendres_context_poll(b->ctx);
  return status == PENDRES_OK ? ran(b, 0.5, pendres_flow_half_period(b->flow)) : status;
}

pendres_status pendres_block_period_sampled(pendres_block *b, pendres_block_sample *sample,
                                            void *arg)
{
  const pendres_status status = pendres_context_poll(b->ctx);
  if (status != PENDRES_OK) return status;
  return ran(b, 1.0, pendres_flow_period_sampled(b->flow, sample, arg));
}

pendres_rows pendres_block_rows(const pendres_block *b)
{
  return pendres_flow_rows(b->flow);
}
