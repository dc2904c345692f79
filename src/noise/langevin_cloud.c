/* langevin_cloud.c -- clouds of strobe points; see langevin.h and langevin_cloud.h. */
#include "noise/langevin_cloud.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "base/student.h"

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS };

static void add(pendres_sums *s, double x, double v, double cosine, double sine,
                double work)
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

pendres_sums pendres_sums_total(const pendres_sums *all, size_t n)
{
  pendres_sums t = {0};
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

void pendres_sums_statistics(const pendres_sums *t,
                             double out[PENDRES_LANGEVIN_STATISTICS])
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
static void influence(const pendres_sums *s, const double d[STATISTICS],
                      double out[STATISTICS])
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

pendres_status pendres_sums_run_make(pendres_sums_run *r, int pairs)
{
  r->all = calloc(r->trajectories, sizeof *r->all);
  r->left = calloc(r->trajectories, 1);
  if (pairs) r->coarse = calloc(r->trajectories, sizeof *r->coarse);
  if (r->all == NULL || r->left == NULL || (pairs && r->coarse == NULL))
    return pendres_context_fail(r->ctx, PENDRES_OUT_OF_MEMORY, "no memory for %zu trajectories",
                                r->trajectories);
  return PENDRES_OK;
}

void pendres_sums_run_clear(pendres_sums_run *r)
{
  free(r->all);
  free(r->coarse);
  free(r->left);
}

pendres_status pendres_sums_accept(pendres_context *ctx, const pendres_langevin_request *q,
                                   int steps)
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
static void load(pendres_langevin_block *b, const pendres_sums_run *r, size_t first)
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
static void ask(const pendres_sums_run *r, const pendres_langevin_block *b, size_t first,
                long period)
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
static size_t count(pendres_sums_run *r, const pendres_langevin_block *b,
                    pendres_sums *all, size_t first, long strobe)
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
static pendres_status follow_block(pendres_sums_run *r, pendres_langevin_block *b,
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

pendres_status pendres_sums_follow(pendres_sums_run *r, pendres_langevin_block *b,
                                   pendres_langevin_block *coarse)
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

pendres_status pendres_sums_estimate(const pendres_sums_run *r, pendres_langevin_estimate *out)
{
  double value[STATISTICS], other[STATISTICS] = {0}, square[STATISTICS] = {0};
  const pendres_sums total = pendres_sums_total(r->all, r->trajectories);
  size_t counting = 0;
  for (size_t i = 0; i < r->trajectories; i++) counting += r->all[i].strobes > 0.0;
  if (counting < 2)
    return pendres_context_fail(r->ctx, PENDRES_NOT_FOUND,
                                "fewer than two trajectories stayed on the attractor");
  pendres_sums_statistics(&total, value);
  if (r->coarse != NULL) {
    const pendres_sums partner = pendres_sums_total(r->coarse, r->trajectories);
    pendres_sums_statistics(&partner, other);
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
static pendres_langevin_estimate phase_lag(const pendres_sums_run *r,
                                           const double value[STATISTICS])
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
static pendres_status conclude(const pendres_sums_run *r, pendres_langevin_cloud *cloud)
{
  double value[STATISTICS];
  *cloud = (pendres_langevin_cloud){.exposure = r->exposure, .phase_lag = {NAN, NAN}};
  for (int s = 0; s < STATISTICS; s++)
    cloud->statistics[s] = (pendres_langevin_estimate){NAN, NAN};
  for (size_t i = 0; i < r->trajectories; i++) {
    cloud->left += r->left[i] != 0;
    cloud->strobes += r->all[i].strobes;
  }
  const pendres_status status = pendres_sums_estimate(r, cloud->statistics);
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
  pendres_sums_run r = {.ctx = ctx, .request = request, .trajectories = request->trajectories,
                         .first_id = request->first_id, .strobe_x = strobe_x,
                         .strobe_v = strobe_v};
  pendres_langevin_block b = {0};
  const int steps = pendres_langevin_resolve_steps(ctx, request->steps_per_period);
  pendres_status status = pendres_sums_accept(ctx, request, steps);
  if (status != PENDRES_OK) return status;
  if ((strobe_x == NULL) != (strobe_v == NULL))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "strobe points need room for both x and v");
  status = pendres_sums_run_make(&r, 0);
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, r.trajectories, steps, &b);
  if (status == PENDRES_OK && strobe_x != NULL)
    for (size_t i = 0; i < r.trajectories * (size_t)request->record; i++)
      strobe_x[i] = strobe_v[i] = NAN;
  if (status == PENDRES_OK) status = pendres_sums_follow(&r, &b, NULL);
  if (status == PENDRES_OK) status = conclude(&r, cloud);
  pendres_langevin_block_clear(&b);
  pendres_sums_run_clear(&r);
  return status;
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
      pendres_sums_accept(ctx, request, 2) == PENDRES_OK) {
    const size_t n = request->trajectories * (size_t)request->record;
    (void)pendres_door_out(&d, &pendres_dim_length, n, strobe_x);
    (void)pendres_door_out(&d, &pendres_dim_speed, n, strobe_v);
  }
  return PENDRES_DOOR_END(&d, measure(ctx, request, cloud, strobe_x, strobe_v));
}
