/* strobe_run.c -- lanes from state to state, by the method that was asked for; see strobe_run.h. */
#include "engine/strobe_run.h"

#include <math.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/kernels/kernels_nystrom.h"
#include "engine/kernels/tables.h"
#include "engine/numbers.h"
#include "model/model.h"
#include "engine/steps.h"
#include "model/equation.h"

#define PLACE(value, name) [value] = &pendres_method_##name,
static const pendres_method_functions *const methods[PENDRES_METHOD_COUNT] = {
  PENDRES_METHODS(PLACE)};
#undef PLACE

const pendres_method_functions *pendres_method_of(const pendres_context *ctx)
{
  return methods[ctx->options.method];
}

pendres_flow_way pendres_strobe_way(const pendres_context *ctx, const pendres_pendulum *p)
{
  const pendres_options *o = &ctx->options;
  const int asked = o->method != PENDRES_BLOCK_FIXED || o->steps_per_period > 0 ||
                    pendres_tables_get(o->table) != pendres_tables_get(PENDRES_TABLE_DEFAULT);
  return asked || p->drive_amplitude == 0.0 || pendres_equation_drags(p) ? PENDRES_FLOW_TABLE
                                                                         : PENDRES_FLOW_NYSTROM;
}

pendres_status pendres_strobe_choose(pendres_context *ctx, double speed, double tolerance,
                                     pendres_strobe_lane *lane)
{
  lane->way = pendres_strobe_way(ctx, lane->pendulum);
  return pendres_steps_choose(ctx, lane->pendulum, speed, tolerance, &lane->steps);
}

double pendres_strobe_single_fastest(const pendres_pendulum *p)
{
  return single_farthest * p->drive_frequency / two_pi;
}

pendres_status pendres_strobe_choose_average(pendres_context *ctx, double speed, double tolerance,
                                             pendres_strobe_lane *lane)
{
  const int table = pendres_equation_drags(lane->pendulum);
  const double rough = table ? tolerance : fmax(tolerance, average_rough);
  const pendres_status status = pendres_strobe_choose(ctx, speed, rough, lane);
  if (table) return status;
  const double steps = average_steps * pow(rough / tolerance, 1.0 / PENDRES_NYSTROM_ORDER);
  if (status != PENDRES_OK) return status;
  /* Every model has tangents by a Nystrom method, without a drive, too. */
  lane->way = PENDRES_FLOW_NYSTROM;
  lane->steps = pendres_steps_rung((int)ceil(steps * lane->steps));
  if (tolerance >= average_single && speed <= pendres_strobe_single_fastest(lane->pendulum) &&
      pendres_nystrom_may_single(pendres_model_kind(lane->pendulum)))
    lane->way = PENDRES_FLOW_SINGLE;
  return status;
}

pendres_strobe_lane pendres_strobe_lane_at(const pendres_pendulum *p, double x, double v)
{
  const pendres_coordinates s = pendres_coordinates_in(p, x, v);
  return (pendres_strobe_lane){.pendulum = p, .y = s.y, .w = s.w, .turns = s.turns};
}

void pendres_strobe_lane_out(const pendres_strobe_lane *l, double *x, double *v)
{
  const pendres_coordinates s = {.y = l->y, .w = l->w, .turns = l->turns};
  pendres_coordinates_out(l->pendulum, &s, x, v);
}

double pendres_strobe_error(double distance)
{
  return distance < 0.1 ? 2.0 * distance : INFINITY;
}

pendres_status pendres_strobe_lost(pendres_context *ctx, const pendres_pendulum *p, long period)
{
  return pendres_context_fail(ctx, PENDRES_INTEGRATION_FAILED,
                              "damping %g, drive amplitude %g, drive frequency %g: within %ld "
                              "periods the state went beyond what double precision can say",
                              p->damping, p->drive_amplitude, p->drive_frequency, period);
}

pendres_status pendres_strobe_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                  pendres_strobe_visit *visit, void *arg)
{
  return pendres_strobe_run_some(ctx, n, NULL, lanes, visit, arg);
}

static int at_period(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  (void)index;
  return lane->period >= *(const long *)arg;
}

pendres_status pendres_strobe_run_until(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                        long period)
{
  return pendres_strobe_run(ctx, n, lanes, at_period, &period);
}

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  return job->n > 0 ? pendres_method_of(ctx)->run(ctx, job) : PENDRES_OK;
}

pendres_status pendres_strobe_run_some(pendres_context *ctx, size_t n, const size_t *which,
                                       pendres_strobe_lane *lanes, pendres_strobe_visit *visit,
                                       void *arg)
{
  return run(ctx, &(pendres_strobe_job){.n = n, .which = which, .lanes = lanes, .visit = visit,
                                        .arg = arg, .tolerance = ctx->options.tolerance});
}

pendres_status pendres_strobe_run_within(pendres_context *ctx, double tolerance, size_t n,
                                         pendres_strobe_lane *lanes, pendres_strobe_visit *visit,
                                         void *arg)
{
  return run(ctx, &(pendres_strobe_job){
    .n = n, .lanes = lanes, .visit = visit, .arg = arg, .tolerance = tolerance});
}
