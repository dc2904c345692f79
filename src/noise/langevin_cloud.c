/*
 * langevin_cloud.c -- clouds of strobe points, the bias of finite steps, and the choice of steps;
 * see langevin.h.
 *
 * Each trajectory has sums over its strobes that count. Means over all strobe points are ratios of
 * totals, and their errors come from what each trajectory contributes to the deviation (the
 * trajectories are independent; strobes of one trajectory are not). Totals are taken in the
 * order of trajectories, whatever blocks they ran in.
 */
#include "noise/langevin_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/student.h"
#include "engine/room.h"
#include "noise/noise_common.h"

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS, ORDER = 4 };

/* Sums over the strobes of one trajectory that count; x and v relative to the starting point. */
typedef struct sums {
  double strobes, x, v, xx, xv, vv, cosine, sine, work;
} sums;

/* A run of one request: its trajectories and their sums. */
typedef struct run {
  pendres_context *ctx;
  const pendres_langevin_request *request;
  size_t trajectories;
  uint64_t first_id;
  sums *all;                   /* [trajectories] */
  sums *coarse;                /* [trajectories] of the coarse partners, or NULL */
  unsigned char *left;         /* [trajectories] */
  double *strobe_x, *strobe_v; /* [trajectories][record] or NULL */
  double exposure;
} run;

static void add(sums *s, double x, double v, double cosine, double sine, double work)
{
  s->strobes += 1.0;
  s->x += x;
  s->v += v;
  s->xx += x * x;
  s->xv += x * v;
  s->vv += v * v;
  s->cosine += cosine;
  s->sine += sine;
  s->work += work;
}

/* The sums over all n trajectories. */
static sums total_of(const sums *all, size_t n)
{
  sums t = {0};
  for (size_t i = 0; i < n; i++) {
    t.strobes += all[i].strobes;
    t.x += all[i].x;
    t.v += all[i].v;
    t.xx += all[i].xx;
    t.xv += all[i].xv;
    t.vv += all[i].vv;
    t.cosine += all[i].cosine;
    t.sine += all[i].sine;
    t.work += all[i].work;
  }
  return t;
}

/* The statistics that follow from totals; means are relative to the starting point. */
static void statistics_of(const sums *t, double out[STATISTICS])
{
  const double x = t->x / t->strobes, v = t->v / t->strobes;
  out[PENDRES_LANGEVIN_MEAN_X] = x;
  out[PENDRES_LANGEVIN_MEAN_V] = v;
  out[PENDRES_LANGEVIN_COV_XX] = t->xx / t->strobes - x * x;
  out[PENDRES_LANGEVIN_COV_XV] = t->xv / t->strobes - x * v;
  out[PENDRES_LANGEVIN_COV_VV] = t->vv / t->strobes - v * v;
  out[PENDRES_LANGEVIN_COSINE] = t->cosine / t->strobes;
  out[PENDRES_LANGEVIN_SINE] = t->sine / t->strobes;
  out[PENDRES_LANGEVIN_LOOP_AREA] = t->work / t->strobes;
}

/*
 * What trajectory s contributes to the deviations of the statistics d. To first order the deviation
 * of a statistic is the sum of its row over trajectories, divided by the number of strobes.
 */
static void influence(const sums *s, const double d[STATISTICS], double out[STATISTICS])
{
  const double x = d[PENDRES_LANGEVIN_MEAN_X], v = d[PENDRES_LANGEVIN_MEAN_V], n = s->strobes;
  out[PENDRES_LANGEVIN_MEAN_X] = s->x - n * x;
  out[PENDRES_LANGEVIN_MEAN_V] = s->v - n * v;
  out[PENDRES_LANGEVIN_COV_XX] =
    s->xx - 2.0 * x * s->x + n * (x * x - d[PENDRES_LANGEVIN_COV_XX]);
  out[PENDRES_LANGEVIN_COV_XV] =
    s->xv - x * s->v - v * s->x + n * (x * v - d[PENDRES_LANGEVIN_COV_XV]);
  out[PENDRES_LANGEVIN_COV_VV] =
    s->vv - 2.0 * v * s->v + n * (v * v - d[PENDRES_LANGEVIN_COV_VV]);
  out[PENDRES_LANGEVIN_COSINE] = s->cosine - n * d[PENDRES_LANGEVIN_COSINE];
  out[PENDRES_LANGEVIN_SINE] = s->sine - n * d[PENDRES_LANGEVIN_SINE];
  out[PENDRES_LANGEVIN_LOOP_AREA] = s->work - n * d[PENDRES_LANGEVIN_LOOP_AREA];
}

/* Take what a run needs whose request, trajectories and first id are set. */
static void take_room(pendres_room *room, int pairs, run *r)
{
  r->all = pendres_room_take(room, r->trajectories, sizeof *r->all);
  r->left = pendres_room_take(room, r->trajectories, sizeof *r->left);
  if (pairs) r->coarse = pendres_room_take(room, r->trajectories, sizeof *r->coarse);
}

/* Check a request that is to run with `steps` steps a period. */
static pendres_status accept(pendres_context *ctx, const pendres_langevin_request *q, int steps)
{
  const pendres_status status = pendres_langevin_accept(ctx, &q->pendulum, q->x, q->v, steps, 0);
  if (status != PENDRES_OK) return status;
  if (q->trajectories < 2 || q->settle < 0 || q->record < 1)
    return pendres_context_fail(
      ctx, PENDRES_INVALID_ARGUMENT,
      "a cloud needs two trajectories, a strobe to record, and no negative time to settle");
  return pendres_langevin_accept_periods(ctx, q->settle, q->record);
}

/* Put trajectories from number `first` on at the starting point, as many as the block holds. */
static void load(pendres_langevin_block *b, const run *r, size_t first)
{
  const pendres_langevin_request *q = r->request;
  const size_t rest = r->trajectories - first;
  pendres_langevin_block_resize(b, rest < b->capacity ? rest : b->capacity);
  b->harmonics = 1;
  for (size_t i = 0; i < b->count; i++)
    pendres_langevin_block_load(b, i, &q->pendulum, r->first_id + first + i, q->x, q->v);
  pendres_langevin_block_finish(b);
}

/* Ask the request's leave() which trajectories of a block have left. */
static void ask(const run *r, const pendres_langevin_block *b, size_t first, long period)
{
  if (r->request->leave == NULL) return;
  const pendres_langevin_strobe strobe = {
    .first = first, .count = b->count, .period = period, .x = b->x, .v = b->v,
    .cosine = b->cosine, .sine = b->sine, .work = b->work};
  pendres_guard_ask(&r->ctx->guard, 1);
  r->request->leave(r->request->arg, &strobe, r->left + first);
  pendres_guard_ask(&r->ctx->guard, 0);
}

/* Sum up a strobe of a block, and return how many trajectories have not left. */
static size_t count(run *r, const pendres_langevin_block *b, sums *all, size_t first, long strobe)
{
  const pendres_langevin_request *q = r->request;
  size_t staying = 0;
  for (size_t i = 0; i < b->count; i++) {
    if (r->left[first + i]) continue;
    staying++;
    if (strobe < 0) continue;
    add(&all[first + i], b->x[i] - q->x, b->v[i] - q->v, b->cosine[i], b->sine[i], b->work[i]);
    if (r->strobe_x != NULL) {
      const size_t place = (first + i) * (size_t)q->record + (size_t)strobe;
      r->strobe_x[place] = b->x[i];
      r->strobe_v[place] = b->v[i];
    }
  }
  return staying;
}

/* All periods of the block, and of its coarse partner if there is one. */
static pendres_status follow_block(run *r, pendres_langevin_block *b,
                                   pendres_langevin_block *coarse, size_t first)
{
  const pendres_langevin_request *q = r->request;
  size_t staying = b->count;

  for (long k = 0; k < q->settle + q->record && staying > 0; k++) {
    pendres_status status = pendres_context_poll(r->ctx);
    if (status != PENDRES_OK) return status;
    r->exposure += (double)staying;
    pendres_langevin_count(r->ctx, b);
    if (coarse != NULL) pendres_langevin_count(r->ctx, coarse);
    status = coarse != NULL ? pendres_langevin_block_pair(b, coarse, (uint32_t)k)
                            : pendres_langevin_block_period(b, (uint32_t)k);
    if (status != PENDRES_OK) return status;
    if (coarse != NULL) ask(r, coarse, first, k + 1);
    ask(r, b, first, k + 1);
    staying = count(r, b, r->all, first, k - q->settle);
    if (coarse != NULL) (void)count(r, coarse, r->coarse, first, k - q->settle);
  }
  return PENDRES_OK;
}

/* Follow all trajectories of a run in block b, with their partners in block coarse if that is not
 * NULL. */
static pendres_status follow(run *r, pendres_langevin_block *b, pendres_langevin_block *coarse)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < r->trajectories && status == PENDRES_OK; first += b->count) {
    load(b, r, first);
    if (coarse != NULL) load(coarse, r, first);
    status = follow_block(r, b, coarse, first);
  }
  return status;
}

/* The error of a mean over trajectories, from the sum of squares of their contributions. */
static double standard_error(double square, size_t trajectories, double strobes)
{
  const double n = (double)trajectories;
  return pendres_student(PENDRES_ONE_SIGMA, n - 1.0) * sqrt(square * n / (n - 1.0)) / strobes;
}

/* The statistics of a run with their standard errors or, if it has coarse partners, their
 * differences from those of the partners. */
static pendres_status estimate(const run *r, pendres_langevin_estimate *out)
{
  double value[STATISTICS], other[STATISTICS] = {0}, square[STATISTICS] = {0};
  const sums total = total_of(r->all, r->trajectories);
  size_t counting = 0;
  for (size_t i = 0; i < r->trajectories; i++) counting += r->all[i].strobes > 0.0;
  if (counting < 2)
    return pendres_context_fail(r->ctx, PENDRES_NOT_FOUND,
                                "fewer than two trajectories stayed on the attractor");
  statistics_of(&total, value);
  if (r->coarse != NULL) {
    const sums partner = total_of(r->coarse, r->trajectories);
    statistics_of(&partner, other);
  }
  for (size_t i = 0; i < r->trajectories; i++) {
    double d[STATISTICS], e[STATISTICS] = {0};
    influence(&r->all[i], value, d);
    if (r->coarse != NULL) influence(&r->coarse[i], other, e);
    for (int s = 0; s < STATISTICS; s++) square[s] += (d[s] - e[s]) * (d[s] - e[s]);
  }
  for (int s = 0; s < STATISTICS; s++) {
    out[s].value = value[s] - other[s];
    out[s].error = standard_error(square[s], counting, total.strobes);
  }
  return PENDRES_OK;
}

/* The phase lag of the mean first harmonic. To first order its error is that of the harmonic's
 * component across its own direction, which is summed up over trajectories. */
static pendres_langevin_estimate phase_lag(const run *r, const double value[STATISTICS])
{
  const double c = value[PENDRES_LANGEVIN_COSINE], s = value[PENDRES_LANGEVIN_SINE];
  const double amplitude2 = c * c + s * s;
  double square = 0.0, strobes = 0.0;
  size_t counting = 0;
  for (size_t i = 0; i < r->trajectories; i++) {
    double d[STATISTICS];
    influence(&r->all[i], value, d);
    const double lag = (c * d[PENDRES_LANGEVIN_SINE] - s * d[PENDRES_LANGEVIN_COSINE]) / amplitude2;
    square += lag * lag;
    strobes += r->all[i].strobes;
    counting += r->all[i].strobes > 0.0;
  }
  double lag = atan2(s, c);
  if (lag < 0.0) lag += two_pi;
  return (pendres_langevin_estimate){lag, standard_error(square, counting, strobes)};
}

/* The cloud of a run that has been followed. */
static pendres_status conclude(const run *r, pendres_langevin_cloud *cloud)
{
  double value[STATISTICS];
  *cloud = (pendres_langevin_cloud){.exposure = r->exposure, .phase_lag = {NAN, NAN}};
  for (int s = 0; s < STATISTICS; s++)
    cloud->statistics[s] = (pendres_langevin_estimate){NAN, NAN};
  for (size_t i = 0; i < r->trajectories; i++) {
    cloud->left += r->left[i] != 0;
    cloud->strobes += r->all[i].strobes;
  }
  const pendres_status status = estimate(r, cloud->statistics);
  if (status != PENDRES_OK) return status;
  for (int s = 0; s < STATISTICS; s++) value[s] = cloud->statistics[s].value;
  cloud->phase_lag = phase_lag(r, value);
  cloud->statistics[PENDRES_LANGEVIN_MEAN_X].value += r->request->x;
  cloud->statistics[PENDRES_LANGEVIN_MEAN_V].value += r->request->v;
  return PENDRES_OK;
}

static pendres_status measure(pendres_context *ctx, const pendres_langevin_request *request,
                              pendres_langevin_cloud *cloud, double *strobe_x, double *strobe_v)
{
  if (request == NULL || cloud == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and cloud");
  run r = {.ctx = ctx, .request = request, .trajectories = request->trajectories,
           .first_id = request->first_id, .strobe_x = strobe_x, .strobe_v = strobe_v};
  pendres_langevin_block b = {0};
  const int steps = pendres_langevin_resolve_steps(ctx, request->steps_per_period);
  pendres_status status = accept(ctx, request, steps);
  if (status != PENDRES_OK) return status;
  if ((strobe_x == NULL) != (strobe_v == NULL))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "strobe points need room for both x and v");
  pendres_room room = pendres_room_open(ctx, "trajectories");
  take_room(&room, 0, &r);
  status = room.status;
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, r.trajectories, steps, &b);
  if (status == PENDRES_OK && strobe_x != NULL)
    for (size_t i = 0; i < r.trajectories * (size_t)request->record; i++)
      strobe_x[i] = strobe_v[i] = NAN;
  if (status == PENDRES_OK) status = follow(&r, &b, NULL);
  if (status == PENDRES_OK) status = conclude(&r, cloud);
  pendres_langevin_block_clear(&b);
  return pendres_room_close(&room, status);
}

pendres_status pendres_langevin_cloud_find(pendres_context *ctx,
                                           const pendres_langevin_request *request,
                                           pendres_langevin_cloud *cloud, double *strobe_x,
                                           double *strobe_v)
{
  pendres_noise_window window;
  pendres_langevin_request inside;
  pendres_door d = pendres_door_open(ctx, request != NULL ? &request->pendulum : NULL);
  request = pendres_noise_request(&d, request, &window, &inside);
  PENDRES_DOOR_OUT(&d, cloud, 1, cloud);
  if (request != NULL && d.status == PENDRES_OK && pendres_door_changes(&d) &&
      accept(ctx, request, 2) == PENDRES_OK) {
    const size_t n = request->trajectories * (size_t)request->record;
    (void)pendres_door_out(&d, &pendres_dim_length, n, strobe_x);
    (void)pendres_door_out(&d, &pendres_dim_speed, n, strobe_v);
  }
  return PENDRES_DOOR_END(&d, measure(ctx, request, cloud, strobe_x, strobe_v));
}

/* ---- the bias of finite steps ---- */

static void scales_of(const sums *total, double scale[STATISTICS])
{
  double d[STATISTICS];
  statistics_of(total, d);
  const double xx = d[PENDRES_LANGEVIN_COV_XX], vv = d[PENDRES_LANGEVIN_COV_VV];
  scale[PENDRES_LANGEVIN_MEAN_X] = sqrt(xx);
  scale[PENDRES_LANGEVIN_MEAN_V] = sqrt(vv);
  scale[PENDRES_LANGEVIN_COV_XX] = xx;
  scale[PENDRES_LANGEVIN_COV_XV] = sqrt(xx * vv);
  scale[PENDRES_LANGEVIN_COV_VV] = vv;
  /* A harmonic that vanishes, as under a torque alone, is compared with the width of the cloud. */
  scale[PENDRES_LANGEVIN_COSINE] = scale[PENDRES_LANGEVIN_SINE] =
    fmax(hypot(d[PENDRES_LANGEVIN_COSINE], d[PENDRES_LANGEVIN_SINE]), sqrt(xx));
  scale[PENDRES_LANGEVIN_LOOP_AREA] = fabs(d[PENDRES_LANGEVIN_LOOP_AREA]);
}

/* The bias of `steps` steps per period, from pairs of trajectories of the request. */
static pendres_status measure_bias(pendres_context *ctx, const pendres_langevin_request *request,
                                   int steps, size_t trajectories, pendres_langevin_bias *bias)
{
  /* With another top bit of their ids these are not the trajectories of the cloud itself. */
  run r = {.ctx = ctx, .request = request, .trajectories = trajectories,
           .first_id = request->first_id ^ (uint64_t)1 << 63};
  pendres_langevin_block fine = {0}, coarse = {0};
  pendres_langevin_estimate fine_minus_coarse[STATISTICS];
  const double richardson = 1.0 / (1.0 - pow(2.0, -ORDER));
  pendres_room room = pendres_room_open(ctx, "trajectories");
  take_room(&room, 1, &r);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, trajectories, 2 * steps, &fine);
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, trajectories, steps, &coarse);
  if (status == PENDRES_OK) status = follow(&r, &fine, &coarse);
  if (status == PENDRES_OK) status = estimate(&r, fine_minus_coarse);
  if (status == PENDRES_OK) {
    const sums total = total_of(r.all, trajectories);
    bias->steps_per_period = steps;
    for (int s = 0; s < STATISTICS; s++)
      bias->statistics[s] = (pendres_langevin_estimate){
        -richardson * fine_minus_coarse[s].value, richardson * fine_minus_coarse[s].error};
    scales_of(&total, bias->scale);
  }
  pendres_langevin_block_clear(&fine);
  pendres_langevin_block_clear(&coarse);
  return pendres_room_close(&room, status);
}

static pendres_status bias_of(pendres_context *ctx, const pendres_langevin_request *request,
                              pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and bias");
  const int steps = pendres_langevin_resolve_steps(ctx, request->steps_per_period);
  const pendres_status status = accept(ctx, request, steps);
  if (status != PENDRES_OK) return status;
  return measure_bias(ctx, request, steps, request->trajectories, bias);
}

pendres_status pendres_langevin_measure_bias(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             pendres_langevin_bias *bias)
{
  pendres_noise_window window;
  pendres_langevin_request inside;
  pendres_door d = pendres_door_open(ctx, request != NULL ? &request->pendulum : NULL);
  request = pendres_noise_request(&d, request, &window, &inside);
  PENDRES_DOOR_OUT(&d, bias, 1, bias);
  return PENDRES_DOOR_END(&d, bias_of(ctx, request, bias));
}

/* Raise *most to a number in units of its scale. NaN is kept: an unknown bias may be large. */
static void raise_to(double number, double scale, double *most)
{
  /* A number that is exactly zero, such as the work of no drive, needs no scale. */
  const double size = number == 0.0 ? 0.0 : fabs(number) / scale;
  if (!(size <= *most) && !isnan(*most)) *most = size;
}

/* The largest bias and its largest error among the statistics, in units of their scales. */
static void worst_of(const pendres_langevin_bias *bias, unsigned statistics, double *value,
                     double *error)
{
  *value = *error = 0.0;
  for (int s = 0; s < STATISTICS; s++) {
    if ((statistics >> s & 1u) == 0) continue;
    raise_to(bias->statistics[s].value, bias->scale[s], value);
    raise_to(bias->statistics[s].error, bias->scale[s], error);
  }
}

int pendres_noise_first_steps(const pendres_pendulum *p)
{
  const double period = two_pi / p->drive_frequency;
  return (int)ceil(fmin(PENDRES_MOST_STEPS / 2, fmax(4.0, period * fmax(1.0, p->damping))));
}

static pendres_status choose_steps(pendres_context *ctx, const pendres_langevin_request *request,
                                   unsigned statistics, double tolerance,
                                   pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and bias");
  size_t trajectories = request->trajectories;
  double value, error;
  if (!(tolerance > 0.0) || statistics == 0 || statistics >> STATISTICS != 0 ||
      !(request->pendulum.temperature > 0.0) || !(request->pendulum.damping > 0.0))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "choosing steps needs a positive tolerance, temperature and "
                                "damping, and a statistic");
  int steps = pendres_noise_first_steps(&request->pendulum);
  for (int trial = 0; trial < NOISE_TRIALS; trial++) {
    pendres_status status = accept(ctx, request, steps);
    if (status == PENDRES_OK) status = measure_bias(ctx, request, steps, trajectories, bias);
    if (status != PENDRES_OK) return status;
    worst_of(bias, statistics, &value, &error);
    if (value + 2.0 * error <= tolerance) return PENDRES_OK;
    /* More steps or more trajectories do not help where the bias is NaN. */
    if (isnan(value + error)) break;
    /* The bias goes down with more steps, and its error with these and with more trajectories. */
    if (error > 0.25 * tolerance && trajectories < NOISE_GROWTH * request->trajectories)
      trajectories *= 4;
    const double ratio = value / (noise_aim * tolerance);
    const double factor =
      fmin(noise_most_growth, fmax(noise_least_growth, pow(ratio, 1.0 / ORDER)));
    if (value > 0.5 * tolerance) steps = (int)fmin(PENDRES_MOST_STEPS / 2, ceil(steps * factor));
  }
  return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED,
                              "with %d steps a period the bias is %.2g of its scale, known to "
                              "%.2g; wanted %.2g", bias->steps_per_period, value, error,
                              tolerance);
}

pendres_status pendres_langevin_choose_steps(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             unsigned statistics, double tolerance,
                                             pendres_langevin_bias *bias)
{
  pendres_noise_window window;
  pendres_langevin_request inside;
  pendres_door d = pendres_door_open(ctx, request != NULL ? &request->pendulum : NULL);
  request = pendres_noise_request(&d, request, &window, &inside);
  PENDRES_DOOR_OUT(&d, bias, 1, bias);
  return PENDRES_DOOR_END(&d, choose_steps(ctx, request, statistics, tolerance, bias));
}
