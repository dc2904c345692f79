/*
 * langevin_cloud.c -- clouds of strobe points, and the bias of finite steps; see langevin.h.
 *
 * Each trajectory sums up what counts of it; then means over all strobe points are ratios of
 * totals, and their errors come from what each trajectory adds to the difference (the
 * trajectories are independent; strobes of one trajectory are not). Sums are taken in the
 * order of trajectories, whatever blocks they ran in.
 */
#include "noise/langevin_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_cdf.h>

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS, GROWTH = 64, TRIALS = 12, ORDER = 4 };

/* What one trajectory sums up over strobes that count; x and v from the starting point. */
typedef struct sums {
  double strobes, x, v, xx, xv, vv, cosine, sine, work;
} sums;

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

/* The statistics that the totals stand for; means from the starting point. */
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
 * What trajectory s adds to the sums of deviations: d holds the values of statistics_of. To
 * first order a statistic is off by the total of its row divided by the strobes.
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

/* A run of one request: trajectories and what they have summed up. */
typedef struct run {
  pendres_langevin *lv;
  const pendres_langevin_request *request;
  size_t trajectories;
  uint64_t first_id;
  sums *all;         /* one a trajectory */
  sums *coarse;      /* of the coarse partners, or NULL */
  unsigned char *left;
  double *strobe_x, *strobe_v; /* or NULL */
  double exposure;
} run;

static pendres_status make_run(run *r, int pairs)
{
  r->all = calloc(r->trajectories, sizeof *r->all);
  r->left = calloc(r->trajectories, 1);
  if (pairs) r->coarse = calloc(r->trajectories, sizeof *r->coarse);
  if (r->all == NULL || r->left == NULL || (pairs && r->coarse == NULL))
    return pendres_langevin_fail(r->lv, PENDRES_OUT_OF_MEMORY, "no memory for %zu trajectories",
                                 r->trajectories);
  return PENDRES_OK;
}

static void clear_run(run *r)
{
  free(r->all);
  free(r->coarse);
  free(r->left);
}

static pendres_status accept(pendres_langevin *lv, const pendres_langevin_request *q)
{
  pendres_status status = pendres_langevin_accept(lv, &q->pendulum, q->x, q->v, 0);
  if (status != PENDRES_OK) return status;
  if (q->trajectories < 2 || q->settle < 0 || q->record < 1)
    return pendres_langevin_fail(
      lv, PENDRES_INVALID_ARGUMENT,
      "a cloud needs two trajectories, a strobe to record, and no negative time to settle");
  status = pendres_langevin_accept_periods(lv, q->settle, q->record);
  return status;
}

/* Every trajectory of a block at the starting point. */
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

/* Let the request say which of a block have left. */
static void ask(const run *r, const pendres_langevin_block *b, size_t first, long period)
{
  if (r->request->leave == NULL) return;
  const pendres_langevin_strobe strobe = {
    .first = first, .count = b->count, .period = period, .x = b->x, .v = b->v,
    .cosine = b->cosine, .sine = b->sine, .work = b->work};
  pendres_guard_ask(&r->lv->guard, 1);
  r->request->leave(r->request->arg, &strobe, r->left + first);
  pendres_guard_ask(&r->lv->guard, 0);
}

/* Count a strobe of a block; 0 if nobody is there any more. */
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
static pendres_status follow(run *r, pendres_langevin_block *b, pendres_langevin_block *coarse,
                             size_t first)
{
  const pendres_langevin_request *q = r->request;
  size_t staying = b->count;

  for (long k = 0; k < q->settle + q->record && staying > 0; k++) {
    pendres_status status = pendres_langevin_poll(r->lv);
    if (status != PENDRES_OK) return status;
    r->exposure += (double)staying;
    r->lv->spent += (double)b->count * (coarse != NULL ? 3.0 : 1.0);
    pendres_langevin_count(r->lv, b);
    if (coarse != NULL) pendres_langevin_count(r->lv, coarse);
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

/*
 * A standard error from the scatter of few trajectories is itself uncertain: by Student's t the
 * true value is within what is returned, in units of the naive one, as often as within one standard
 * deviation of a Gaussian. Two trajectories: 1.84; ten: 1.06.
 */
static double student(size_t trajectories)
{
  static const double one_sigma = 0.84134474606854293; /* share below +1 standard deviation */
  return gsl_cdf_tdist_Pinv(one_sigma, (double)trajectories - 1.0);
}

/* The error of a mean over trajectories from the sum of squares of what each adds to it. */
static double standard_error(double square, size_t trajectories, double strobes)
{
  const double n = (double)trajectories;
  return student(trajectories) * sqrt(square * n / (n - 1.0)) / strobes;
}

/* Standard errors of the statistics of `all`, or of their difference from those of `coarse`. */
static pendres_status estimate(const run *r, const sums *all, const sums *coarse,
                               pendres_langevin_estimate *out)
{
  double value[STATISTICS], other[STATISTICS] = {0}, square[STATISTICS] = {0};
  const sums total = total_of(all, r->trajectories);
  size_t counting = 0;
  for (size_t i = 0; i < r->trajectories; i++) counting += all[i].strobes > 0.0;
  if (counting < 2)
    return pendres_langevin_fail(r->lv, PENDRES_NOT_FOUND,
                                 "fewer than two trajectories stayed on the attractor");
  statistics_of(&total, value);
  if (coarse != NULL) {
    const sums partner = total_of(coarse, r->trajectories);
    statistics_of(&partner, other);
  }
  for (size_t i = 0; i < r->trajectories; i++) {
    double d[STATISTICS], e[STATISTICS] = {0};
    influence(&all[i], value, d);
    if (coarse != NULL) influence(&coarse[i], other, e);
    for (int s = 0; s < STATISTICS; s++) square[s] += (d[s] - e[s]) * (d[s] - e[s]);
  }
  for (int s = 0; s < STATISTICS; s++) {
    out[s].value = value[s] - other[s];
    out[s].error = standard_error(square[s], counting, total.strobes);
  }
  return PENDRES_OK;
}

/* Phase lag of a mean first harmonic, with the error that those of its parts carry over. The
 * parts' errors are taken as independent along and across the lag: only the latter counts. */
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
  if (lag < 0.0) lag += 6.28318530717958647693;
  return (pendres_langevin_estimate){lag, standard_error(square, counting, strobes)};
}

static pendres_status measure(pendres_langevin *lv, const pendres_langevin_request *request,
                              pendres_langevin_cloud *cloud, double *strobe_x, double *strobe_v)
{
  if (request == NULL || cloud == NULL) return PENDRES_LANGEVIN_NULL(lv, "request and cloud");
  run r = {.lv = lv, .request = request, .trajectories = request->trajectories,
           .first_id = request->first_id, .strobe_x = strobe_x, .strobe_v = strobe_v};
  pendres_langevin_block *b = &lv->block;
  pendres_status status = accept(lv, request);
  if (status != PENDRES_OK) return status;
  if ((strobe_x == NULL) != (strobe_v == NULL))
    return pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT,
                                 "strobe points need room for both x and v");
  status = make_run(&r, 0);
  if (status != PENDRES_OK) goto done;
  for (size_t i = 0; strobe_x != NULL && i < r.trajectories * (size_t)request->record; i++)
    strobe_x[i] = strobe_v[i] = NAN;
  for (size_t first = 0; first < r.trajectories; first += b->count) {
    load(b, &r, first);
    status = follow(&r, b, NULL, first);
    if (status != PENDRES_OK) goto done;
  }
  *cloud = (pendres_langevin_cloud){.exposure = r.exposure, .phase_lag = {NAN, NAN}};
  for (int s = 0; s < STATISTICS; s++)
    cloud->statistics[s] = (pendres_langevin_estimate){NAN, NAN};
  for (size_t i = 0; i < r.trajectories; i++) {
    cloud->left += r.left[i] != 0;
    cloud->strobes += r.all[i].strobes;
  }
  status = estimate(&r, r.all, NULL, cloud->statistics);
  if (status != PENDRES_OK) goto done;
  double value[STATISTICS];
  for (int s = 0; s < STATISTICS; s++) value[s] = cloud->statistics[s].value;
  cloud->phase_lag = phase_lag(&r, value);
  cloud->statistics[PENDRES_LANGEVIN_MEAN_X].value += request->x;
  cloud->statistics[PENDRES_LANGEVIN_MEAN_V].value += request->v;
done:
  clear_run(&r);
  return status;
}

pendres_status pendres_langevin_measure(pendres_langevin *lv,
                                        const pendres_langevin_request *request,
                                        pendres_langevin_cloud *cloud, double *strobe_x,
                                        double *strobe_v)
{
  return PENDRES_LANGEVIN_CALL(lv, measure(lv, request, cloud, strobe_x, strobe_v));
}

/* ---- Bias -------------------------------------------------------------------------------- */

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
  scale[PENDRES_LANGEVIN_COSINE] = scale[PENDRES_LANGEVIN_SINE] =
    hypot(d[PENDRES_LANGEVIN_COSINE], d[PENDRES_LANGEVIN_SINE]);
  scale[PENDRES_LANGEVIN_LOOP_AREA] = fabs(d[PENDRES_LANGEVIN_LOOP_AREA]);
}

/* The handle's two blocks as a pair with steps and 2 steps. */
static pendres_status make_pair(pendres_langevin *lv)
{
  pendres_status status = PENDRES_OK;
  const int steps = lv->options.steps_per_period;
  if (lv->partner.memory == NULL)
    status = pendres_langevin_block_make(&lv->partner, lv->block.capacity, lv->options.seed);
  if (status == PENDRES_OK) status = pendres_langevin_block_set_steps(&lv->partner, steps);
  if (status == PENDRES_OK) status = pendres_langevin_block_set_steps(&lv->block, 2 * steps);
  if (status != PENDRES_OK) return pendres_langevin_fail(lv, status, "out of memory for pairs");
  return status;
}

/* Bias from `trajectories` pairs of the request. */
static pendres_status measure_bias(pendres_langevin *lv, const pendres_langevin_request *request,
                                   size_t trajectories, pendres_langevin_bias *bias)
{
  /* Other trajectories than those measured: the top bit of the id. */
  run r = {.lv = lv, .request = request, .trajectories = trajectories,
           .first_id = request->first_id ^ (uint64_t)1 << 63};
  pendres_langevin_estimate fine_minus_coarse[STATISTICS];
  const double richardson = 1.0 / (1.0 - pow(2.0, -ORDER));
  pendres_status status = make_run(&r, 1);
  if (status == PENDRES_OK) status = make_pair(lv);
  for (size_t first = 0; first < trajectories && status == PENDRES_OK;
       first += lv->block.count) {
    load(&lv->block, &r, first);
    load(&lv->partner, &r, first);
    status = follow(&r, &lv->block, &lv->partner, first);
  }
  if (status == PENDRES_OK) status = estimate(&r, r.all, r.coarse, fine_minus_coarse);
  if (status == PENDRES_OK) {
    const sums total = total_of(r.all, trajectories);
    bias->steps_per_period = lv->options.steps_per_period;
    for (int s = 0; s < STATISTICS; s++)
      bias->statistics[s] = (pendres_langevin_estimate){
        -richardson * fine_minus_coarse[s].value, richardson * fine_minus_coarse[s].error};
    scales_of(&total, bias->scale);
  }
  clear_run(&r);
  /* Whatever happened, the handle's own steps are back in force. */
  const pendres_status back =
    pendres_langevin_block_set_steps(&lv->block, lv->options.steps_per_period);
  if (back != PENDRES_OK) return pendres_langevin_fail(lv, back, "out of memory for steps");
  return status;
}

static pendres_status bias_of(pendres_langevin *lv, const pendres_langevin_request *request,
                              pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_LANGEVIN_NULL(lv, "request and bias");
  const pendres_status status = accept(lv, request);
  if (status != PENDRES_OK) return status;
  return measure_bias(lv, request, request->trajectories, bias);
}

pendres_status pendres_langevin_measure_bias(pendres_langevin *lv,
                                             const pendres_langevin_request *request,
                                             pendres_langevin_bias *bias)
{
  return PENDRES_LANGEVIN_CALL(lv, bias_of(lv, request, bias));
}

/* Raise *most to what a number is in units of its scale. NaN stays: it is no small bias. */
static void raise_to(double number, double scale, double *most)
{
  /* Exactly nothing, as the work of no drive, is nothing in any unit. */
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

/* Where the search begins: two steps a unit of time would do for the well, and friction. */
static int first_steps(const pendres_pendulum *p)
{
  const double period = 6.28318530717958647693 / p->drive_frequency;
  return (int)ceil(fmin(5e5, fmax(4.0, period * fmax(1.0, p->damping))));
}

static pendres_status choose_steps(pendres_langevin *lv, const pendres_langevin_request *request,
                                   unsigned statistics, double tolerance,
                                   pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_LANGEVIN_NULL(lv, "request and bias");
  const int before = lv->options.steps_per_period;
  size_t trajectories = request->trajectories;
  double value, error;
  pendres_status status = PENDRES_OK;

  if (!(tolerance > 0.0) || statistics == 0 || statistics >> STATISTICS != 0 ||
      !(request->pendulum.temperature > 0.0) || !(request->pendulum.damping > 0.0))
    return pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT,
                                 "choosing steps needs a positive tolerance, temperature and "
                                 "damping, and a statistic");
  int steps = first_steps(&request->pendulum);
  for (int trial = 0; trial < TRIALS; trial++) {
    status = pendres_langevin_set_steps(lv, steps);
    if (status == PENDRES_OK) status = accept(lv, request);
    if (status == PENDRES_OK) status = measure_bias(lv, request, trajectories, bias);
    if (status != PENDRES_OK) goto failed;
    worst_of(bias, statistics, &value, &error);
    if (value + 2.0 * error <= tolerance) return PENDRES_OK;
    /* More steps or trajectories do not make a number of what is none. */
    if (isnan(value + error)) break;
    /* Both go down with the steps; what noise leaves over goes down with trajectories. */
    if (error > 0.25 * tolerance && trajectories < GROWTH * request->trajectories)
      trajectories *= 4;
    const double ratio = value / (0.7 * tolerance);
    const double factor = fmin(4.0, fmax(1.1, pow(ratio, 1.0 / ORDER)));
    if (value > 0.5 * tolerance) steps = (int)fmin(5e5, ceil(steps * factor));
  }
  status = pendres_langevin_fail(lv, PENDRES_NOT_CONVERGED,
                                 "with %d steps a period the bias is %.2g of its scale, known to "
                                 "%.2g; wanted %.2g", steps, value, error, tolerance);
failed:
  (void)pendres_langevin_block_set_steps(&lv->block, before);
  lv->options.steps_per_period = lv->block.steps;
  return status;
}

pendres_status pendres_langevin_choose_steps(pendres_langevin *lv,
                                             const pendres_langevin_request *request,
                                             unsigned statistics, double tolerance,
                                             pendres_langevin_bias *bias)
{
  return PENDRES_LANGEVIN_CALL(lv, choose_steps(lv, request, statistics, tolerance, bias));
}
