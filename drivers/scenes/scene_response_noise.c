/*
 * scene_response_noise.c -- loop area, phase lag and amplitude against temperature.
 *
 * Every member of the ensemble starts on the attractor that it settles on without noise, and is
 * then followed wherever noise takes it: so trajectories start on the attractors in the members'
 * proportions, and means over them are weighted with the members' shares. Shares of members that
 * are chaotic or unresolved are left out, as without noise. One task a temperature, damping and
 * drive period.
 */
#include "scenes/scene_response_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"
#include "scenes/scene_noise.h"

static const double two_pi = 6.28318530717958647693;

/* Of the loop area, and of the first harmonic's amplitude. */
static const double bias_wanted = 1e-4;

/* A mean with its standard error, and bias by finite steps with its own. */
typedef struct quantity {
  double value, error, bias, bias_error;
} quantity;

typedef struct point {
  quantity area, power, amplitude, lag;
  int32_t steps; /* the most of the states' */
} point;

typedef struct work {
  const deck *d;
  const scene_response_grid *grid;
  size_t temperatures;
  point *points;         /* [temperature][damping][drive] */
  scene_failures failed; /* the same; of what noise adds alone */
} work;

/* The first harmonic, cosine and sine, with covariance of errors, and biases. */
typedef struct harmonic {
  double c, s, cc, cs, ss;
  double bias_c, bias_s, bias_cc, bias_ss;
} harmonic;

/* ---- a point ------------------------------------------------------------------------------- */

/* Members that a mean counts; in it, those that stay in a well and so have a loop. */
static void count_members(const pendres_response *r, double *all, double *loops)
{
  *all = *loops = 0.0;
  for (size_t i = 0; i < r->states; i++) {
    const pendres_orbit *o = &r->state[i].orbit;
    if (!isfinite(o->x)) continue;
    *all += (double)r->state_members[i];
    if (o->winding == 0) *loops += (double)r->state_members[i];
  }
}

/* What a task finds. */
typedef struct record {
  point point;
  scene_verdict verdict;
} record;

/* As many as the state has members in proportion. */
static size_t trajectories_of(const work *w, const pendres_response *r, size_t state)
{
  double all, loops;
  count_members(r, &all, &loops);
  const double n =
    ceil((double)r->state_members[state] / all * (double)w->d->noise.trajectories);
  return n > 2.0 ? (size_t)n : 2;
}

/* Choose steps and make the cloud of trajectories that start on one state. */
static pendres_status measure_state(const work *w, pendres_context *ctx, const pendres_response *r,
                                    size_t state, double temperature, pendres_langevin_cloud *cloud,
                                    pendres_langevin_bias *bias)
{
  enum { TRAJECTORIES = 192, RECORD = 60 };
  const pendres_orbit *o = &r->state[state].orbit;
  pendres_langevin_request request = { .pendulum = r->pendulum, .x = o->x, .v = o->v,
                                       .trajectories = TRAJECTORIES, .record = RECORD,
                                       .settle = scene_noise_settle(o) };
  request.pendulum.temperature = temperature;
  request.first_id = scene_noise_first_id(&request.pendulum, state);
  pendres_status status =
    scene_noise_choose_steps(ctx, &request, PENDRES_LANGEVIN_RESPONSE, bias_wanted, bias);
  request.trajectories = trajectories_of(w, r, state);
  request.record = (long)w->d->noise.periods;
  request.steps_per_period = bias->steps_per_period;
  if (status == PENDRES_OK) status = pendres_langevin_measure(ctx, &request, cloud, NULL, NULL);
  return status;
}

static void add_area(quantity *q, double share, const pendres_langevin_cloud *cloud,
                     const pendres_langevin_bias *bias)
{
  const pendres_langevin_estimate a = cloud->statistics[PENDRES_LANGEVIN_LOOP_AREA];
  const pendres_langevin_estimate b = bias->statistics[PENDRES_LANGEVIN_LOOP_AREA];
  q->value += share * a.value;
  q->error = hypot(q->error, share * a.error);
  q->bias += share * b.value;
  q->bias_error = hypot(q->bias_error, share * b.error);
}

static void add_harmonic(harmonic *h, double share, const pendres_langevin_cloud *cloud,
                         const pendres_langevin_bias *bias)
{
  const pendres_langevin_estimate c = cloud->statistics[PENDRES_LANGEVIN_COSINE];
  const pendres_langevin_estimate s = cloud->statistics[PENDRES_LANGEVIN_SINE];
  const pendres_langevin_estimate bc = bias->statistics[PENDRES_LANGEVIN_COSINE];
  const pendres_langevin_estimate bs = bias->statistics[PENDRES_LANGEVIN_SINE];
  h->c += share * c.value;
  h->s += share * s.value;
  h->cc += share * share * c.error * c.error;
  h->ss += share * share * s.error * s.error;
  h->cs += share * share * scene_noise_harmonic_covariance(cloud);
  h->bias_c += share * bc.value;
  h->bias_s += share * bs.value;
  h->bias_cc += share * share * bc.error * bc.error;
  h->bias_ss += share * share * bs.error * bs.error;
}

/* Length and direction of the harmonic, errors along and across. */
static void polar(const harmonic *h, point *p)
{
  const double length = hypot(h->c, h->s), u = h->c / length, w = h->s / length;
  const double along = u * u * h->cc + 2.0 * u * w * h->cs + w * w * h->ss;
  const double across = w * w * h->cc - 2.0 * u * w * h->cs + u * u * h->ss;
  p->amplitude = (quantity){ length, sqrt(fmax(0.0, along)), u * h->bias_c + w * h->bias_s,
                             sqrt(u * u * h->bias_cc + w * w * h->bias_ss) };
  const double lag = atan2(h->s, h->c);
  p->lag = (quantity){ lag < 0.0 ? lag + two_pi : lag, sqrt(fmax(0.0, across)) / length,
                       (u * h->bias_s - w * h->bias_c) / length,
                       sqrt(w * w * h->bias_cc + u * u * h->bias_ss) / length };
}

/* The harmonic without noise, from the states' own. */
static harmonic still_harmonic(const pendres_response *r, double loops)
{
  harmonic h = { 0 };
  for (size_t i = 0; i < r->states; i++) {
    const pendres_orbit *o = &r->state[i].orbit;
    if (!isfinite(o->x) || o->winding != 0) continue;
    h.c += (double)r->state_members[i] / loops * o->cosine[0];
    h.s += (double)r->state_members[i] / loops * o->sine[0];
  }
  return h;
}

/* Temperature 0: what was found without noise, to the last digit. */
static void still_point(const pendres_response *r, point *p)
{
  double all, loops;
  count_members(r, &all, &loops);
  const harmonic h = still_harmonic(r, loops);
  p->area = (quantity){ r->mean_loop_area, r->mean_loop_area_error, 0.0, 0.0 };
  p->power = (quantity){ r->mean_power, r->mean_power_error, 0.0, 0.0 };
  p->lag = (quantity){ r->phase_lag, r->phase_lag_error, 0.0, 0.0 };
  p->amplitude = (quantity){ loops > 0.0 ? hypot(h.c, h.s) : NAN, r->mean_loop_amplitude_error,
                             0.0, 0.0 };
}

/* Nothing but the reason why. */
static pendres_status note_point(record *q, pendres_status status, const char *why)
{
  const quantity none = { NAN, NAN, NAN, NAN };
  q->point = (point){ .area = none, .power = none, .amplitude = none, .lag = none };
  return scene_verdict_note(&q->verdict, status, why);
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  const size_t plane = w->grid->dampings * w->grid->drives;
  const double temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[task / plane];
  const pendres_response *r = &w->grid->points[task % plane];
  record *q = out->data;
  point *p = &q->point;
  harmonic h = { 0 };
  double all, loops;
  count_members(r, &all, &loops);
  if (!(temperature > 0.0)) {
    still_point(r, p);
    return PENDRES_OK;
  }
  for (size_t i = 0; i < r->states; i++) {
    pendres_langevin_cloud cloud;
    pendres_langevin_bias bias;
    const double members = (double)r->state_members[i];
    if (!isfinite(r->state[i].orbit.x)) continue;
    const pendres_status status = measure_state(w, ctx, r, i, temperature, &cloud, &bias);
    if (status != PENDRES_OK) return note_point(q, status, pendres_context_message(ctx));
    add_area(&p->area, members / all, &cloud, &bias);
    if (r->state[i].orbit.winding == 0) add_harmonic(&h, members / loops, &cloud, &bias);
    if (bias.steps_per_period > p->steps) p->steps = bias.steps_per_period;
  }
  const quantity none = { NAN, NAN, NAN, NAN };
  if (all == 0.0) p->area = none;
  const double f = r->pendulum.drive_frequency / two_pi;
  p->power = (quantity){ f * p->area.value, f * p->area.error, f * p->area.bias,
                         f * p->area.bias_error };
  if (loops > 0.0) polar(&h, p);
  else p->lag = p->amplitude = none;
  return PENDRES_OK;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const record *r = in->data;
  w->points[task] = r->point;
  scene_failures_take(&w->failed, task, &r->verdict);
  return PENDRES_OK;
}

/* ---- results ------------------------------------------------------------------------------- */

static const struct {
  const char *name, *bias, *long_name, *units;
  size_t of; /* where it stands in a point */
} results[] = {
  { "mean_loop_area", "bias_loop_area", "mean loop area of the ensemble", "1",
    offsetof(point, area) },
  { "first_harmonic_amplitude", "bias_first_harmonic_amplitude",
    "amplitude of the mean loop's first harmonic", "rad", offsetof(point, amplitude) },
  { "phase_lag", "bias_phase_lag", "phase lag of the ensemble-averaged loop", "rad",
    offsetof(point, lag) },
  { "mean_power", "bias_mean_power", "mean power taken up from the drive", "1",
    offsetof(point, power) },
};

/* What is known without noise alone. */
#define STILL(name, text, unit) \
  { #name, text, unit, offsetof(pendres_response, name), offsetof(pendres_response, name##_error) }
static const struct {
  const char *name, *long_name, *units;
  size_t value, error;
} still[] = {
  STILL(mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  STILL(mean_amplitude, "mean of the members' amplitudes", "rad"),
  STILL(sa_fraction, "share of the members on the small-amplitude state", "1"),
  STILL(la_fraction, "share of the members on the large-amplitude state", "1"),
};

static pendres_status put(scene_run *run, const work *w, const char *name, const char *long_name,
                          const char *units, const char *comment, const double *value,
                          const double *error)
{
  const pendres_store_spec spec = {
    .name = name, .dimensions = { "temperature", w->grid->damping, w->grid->drive },
    .long_name = long_name, .units = units, .comment = comment };
  return pendres_store_put_result(run->store, &spec, value, error,
                                  w->temperatures * w->grid->dampings * w->grid->drives);
}

static pendres_status write_noisy(scene_run *run, const work *w, double *value, double *error)
{
  const size_t plane = w->grid->dampings * w->grid->drives, n = w->temperatures * plane;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < 2 * sizeof results / sizeof results[0] && status == PENDRES_OK; k++) {
    const size_t r = k / 2;
    const int bias = k % 2 == 1;
    char words[120];
    for (size_t i = 0; i < n; i++) {
      quantity q;
      memcpy(&q, (const char *)&w->points[i] + results[r].of, sizeof q);
      value[i] = bias ? q.bias : q.value;
      error[i] = bias ? q.bias_error : q.error;
    }
    snprintf(words, sizeof words, bias ? "bias by finite steps: %s" : "%s", results[r].long_name);
    status = put(run, w, bias ? results[r].bias : results[r].name, words, results[r].units, NULL,
                 value, error);
  }
  return status;
}

static double field(const pendres_response *r, size_t offset)
{
  double value;
  memcpy(&value, (const char *)r + offset, sizeof value);
  return value;
}

static pendres_status write_still(scene_run *run, const work *w, double *value, double *error)
{
  const size_t plane = w->grid->dampings * w->grid->drives, n = w->temperatures * plane;
  const double *temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof still / sizeof still[0] && status == PENDRES_OK; k++) {
    for (size_t i = 0; i < n; i++) {
      const int cold = !(temperature[i / plane] > 0.0);
      value[i] = cold ? field(&w->grid->points[i % plane], still[k].value) : NAN;
      error[i] = cold ? field(&w->grid->points[i % plane], still[k].error) : NAN;
    }
    status = put(run, w, still[k].name, still[k].long_name, still[k].units,
                 "at temperature 0 alone", value, error);
  }
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const size_t n = w->temperatures * w->grid->dampings * w->grid->drives;
  const pendres_store_spec steps = {
    .name = "noise_steps_per_period", .type = PENDRES_STORE_INT32,
    .dimensions = { "temperature", w->grid->damping, w->grid->drive },
    .long_name = "steps a drive period of the noisy integrator" };
  double *value = malloc(2 * n * sizeof *value);
  int32_t *steps_of = malloc(n * sizeof *steps_of);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || steps_of == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++) steps_of[i] = w->points[i].steps;
  status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = write_noisy(run, w, value, value + n);
  if (status == PENDRES_OK) status = write_still(run, w, value, value + n);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, steps_of, n);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(steps_of);
  return status;
}

/* Along the temperatures, at the first damping and the middle of the drive axis. */
static void print_table(FILE *out, const work *w)
{
  const size_t plane = w->grid->dampings * w->grid->drives, at = w->grid->drives / 2;
  const pendres_pendulum *p = &w->grid->points[at].pendulum;
  fprintf(out, "damping %g, drive period %g:\n", p->damping, two_pi / p->drive_frequency);
  fprintf(out, "temperature  loop area     +-        phase lag   +-        amplitude   +-\n");
  for (size_t i = 0; i < w->temperatures; i++) {
    const point *q = &w->points[i * plane + at];
    fprintf(out, "%-12g %-13.8f %-9.2g %-11.7f %-9.2g %-11.7f %.2g\n",
            w->d->axis[DECK_AXIS_TEMPERATURE].value[i], q->area.value, q->area.error, q->lag.value,
            q->lag.error, q->amplitude.value, q->amplitude.error);
  }
}

static pendres_status write_failed(scene_run *run, const work *w)
{
  const int by_period = w->d->axis[DECK_AXIS_DRIVE_PERIOD].count > 0;
  const deck_axis_id axes[] = { DECK_AXIS_TEMPERATURE, DECK_AXIS_DAMPING,
                                by_period ? DECK_AXIS_DRIVE_PERIOD : DECK_AXIS_DRIVE_FREQUENCY };
  return scene_failures_write(run, &w->failed, "noise_failed", "response with noise", 3, axes);
}

pendres_status scene_response_write_noise(scene_run *run, const scene_response_grid *grid)
{
  work w = { .d = run->deck, .grid = grid,
             .temperatures = run->deck->axis[DECK_AXIS_TEMPERATURE].count };
  const size_t n = w.temperatures * grid->dampings * grid->drives;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  w.points = calloc(n, sizeof *w.points);
  if (w.points == NULL || scene_failures_create(n, &w.failed) != PENDRES_OK) {
    free(w.points);
    return scene_fail(run, status, "out of memory for %zu points", n);
  }
  status = scene_compute(run, &(farm_stage){ .what = "points with noise", .tasks = n,
                                             .task = compute, .record_size = sizeof(record),
                                             .collect = collect, .arg = &w });
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK) status = write_failed(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  scene_failures_free(&w.failed);
  free(w.points);
  return status;
}
