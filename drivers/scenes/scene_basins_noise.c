/*
 * scene_basins_noise.c -- stroboscopic clouds around attractors under thermal noise, as in the
 * paper's Fig. 7, with their covariances beside those of linear noise theory, and escapes.
 *
 * One task a temperature and attractor for the steps, then one a temperature, attractor and chunk
 * of trajectories. A trajectory that has escaped (switching.h) is counted, and left out from then
 * on. A cloud of which a part fails is marked and has no results.
 */
#include "scenes/scene_basins_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_basins_clouds.h"

/* What linear theory leaves out is smaller than a covariance by about its variance: below this
   one it is lost in rounding, and trajectories would only be a poorer way to the same. */
static const double least_variance = 2e-16;

/* The request of all trajectories of a cloud. */
static pendres_langevin_request request_of(const cloud_work *w, size_t number,
                                           pendres_switching_home *home)
{
  const pendres_attractor *a = attractor_of(w, number);
  pendres_langevin_request q = { .pendulum = a->orbit.pendulum, .x = a->orbit.x, .v = a->orbit.v,
                                 .trajectories = w->trajectories,
                                 .settle = scene_noise_settle(&a->orbit), .record = w->record,
                                 .leave = pendres_switching_leave, .arg = home };
  q.pendulum.temperature = temperature_of(w, number);
  q.first_id = scene_noise_first_id(&q.pendulum, number % w->attractors);
  *home = (pendres_switching_home){ .set = w->set, .attractor = number % w->attractors };
  return q;
}

/* ---- computing ----------------------------------------------------------------------------- */

/* Mean and covariance of the q points of an orbit that closes after q periods. */
static void still_statistics(const pendres_orbit *o, size_t q, const double *x, const double *v,
                             pendres_langevin_estimate *out)
{
  double mean_x = 0.0, mean_v = 0.0, xx = 0.0, xv = 0.0, vv = 0.0;
  for (size_t k = 0; k < q; k++) {
    mean_x += x[k] / (double)q;
    mean_v += v[k] / (double)q;
  }
  for (size_t k = 0; k < q; k++) {
    xx += (x[k] - mean_x) * (x[k] - mean_x) / (double)q;
    xv += (x[k] - mean_x) * (v[k] - mean_v) / (double)q;
    vv += (v[k] - mean_v) * (v[k] - mean_v) / (double)q;
  }
  out[PENDRES_LANGEVIN_MEAN_X] = (pendres_langevin_estimate){ mean_x, o->x_error };
  out[PENDRES_LANGEVIN_MEAN_V] = (pendres_langevin_estimate){ mean_v, o->v_error };
  out[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){ xx, 2.0 * sqrt(xx) * o->x_error };
  out[PENDRES_LANGEVIN_COV_XV] =
    (pendres_langevin_estimate){ xv, sqrt(xx) * o->v_error + sqrt(vv) * o->x_error };
  out[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){ vv, 2.0 * sqrt(vv) * o->v_error };
}

/* What the choice of a cloud's steps finds: this, and for a cloud that is not followed its strobe
   points after it, x and then v. */
typedef struct choice {
  cloud cloud;
  scene_verdict verdict;
  size_t strobes; /* that follow */
} choice;

/* What is measured of a chunk: this, then its strobe points, x and then v. */
typedef struct chunk {
  pendres_langevin_cloud part;
  scene_verdict verdict;
  size_t strobes;
} chunk;

/* Without noise, or with less than rounding: the orbit's own points. */
static pendres_status still_cloud(const cloud_work *w, size_t number, pendres_context *ctx,
                                  farm_record *out)
{
  const pendres_orbit *o = &attractor_of(w, number)->orbit;
  const size_t q = (size_t)o->period, n = w->strobes;
  choice *c = farm_record_resize(out, sizeof *c + 2 * n * sizeof(double));
  double *points = malloc(2 * q * sizeof *points);
  if (c == NULL || points == NULL) {
    free(points);
    return PENDRES_OUT_OF_MEMORY;
  }
  pendres_status status = pendres_orbit_sample(ctx, o, 1, points, points + q);
  double *x = (double *)(c + 1), *v = x + n;
  /* The Poincare point itself: to the last digit. */
  points[0] = o->x;
  points[q] = o->v;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    x[k] = points[k % q];
    v[k] = points[q + k % q];
  }
  if (status == PENDRES_OK) {
    c->strobes = n;
    still_statistics(o, q, points, points + q, c->cloud.measured.statistics);
  }
  free(points);
  return status;
}

/* What linear theory says of an orbit of one period. */
static void linear_cloud(cloud *c)
{
  pendres_langevin_estimate *s = c->measured.statistics;
  const pendres_langevin_covariance *l = &c->linear.covariance;
  s[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){ l->xx, c->linear.error };
  s[PENDRES_LANGEVIN_COV_XV] = (pendres_langevin_estimate){ l->xv, c->linear.error };
  s[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){ l->vv, c->linear.error };
}

/* Linear theory, and whether the cloud is too narrow for anything else. */
static void ask_theory(const pendres_langevin_request *request, const pendres_orbit *o, cloud *c)
{
  const pendres_status status = pendres_langevin_linear_theory(
    &request->pendulum, request->x, request->v, o->period, &c->linear);
  /* The cloud of an orbit of several periods lies around several points: theory knows one. */
  c->compared = o->period == 1 && status == PENDRES_OK;
  c->narrow = status == PENDRES_OK && !(c->linear.covariance.xx > least_variance);
}

/* A cloud that nothing is followed of. */
static pendres_status rest(const cloud_work *w, size_t number, pendres_context *ctx,
                           farm_record *out)
{
  const pendres_status status = still_cloud(w, number, ctx, out);
  choice *c = out->data;
  if (status == PENDRES_OK && c->cloud.narrow && c->cloud.compared) linear_cloud(&c->cloud);
  return scene_verdict_note(&c->verdict, status, pendres_context_message(ctx));
}

static pendres_status choose(const void *arg, size_t number, pendres_context *ctx,
                             farm_record *out)
{
  enum { TRAJECTORIES = 384, RECORD = 60 };
  const cloud_work *w = arg;
  choice *c = out->data;
  const pendres_attractor *a = attractor_of(w, number);
  pendres_switching_home home;
  if (!has_cloud(a)) return PENDRES_OK;
  if (!(temperature_of(w, number) > 0.0)) {
    c->cloud.compared = 1;
    return rest(w, number, ctx, out);
  }
  pendres_langevin_request request = request_of(w, number, &home);
  ask_theory(&request, &a->orbit, &c->cloud);
  if (c->cloud.narrow) return rest(w, number, ctx, out);
  request.trajectories = TRAJECTORIES;
  request.record = RECORD;
  const pendres_status status = scene_noise_choose_steps(ctx, &request, PENDRES_LANGEVIN_CLOUD,
                                                         CLOUD_BIAS_WANTED, &c->cloud.bias);
  return scene_verdict_note(&c->verdict, status, pendres_context_message(ctx));
}

static pendres_status collect_choice(void *arg, size_t number, const farm_record *in)
{
  cloud_work *w = arg;
  const choice *c = in->data;
  const double *x = (const double *)(c + 1);
  w->clouds[number] = c->cloud;
  if (c->strobes > 0) {
    memcpy(w->x + number * w->strobes, x, c->strobes * sizeof *x);
    memcpy(w->v + number * w->strobes, x + c->strobes, c->strobes * sizeof *x);
  }
  scene_failures_take(&w->failed, number, &c->verdict);
  return PENDRES_OK;
}

static pendres_status measure(const void *arg, size_t task, pendres_context *ctx,
                              farm_record *out)
{
  const cloud_work *w = arg;
  const size_t number = task / w->chunks;
  size_t first, count;
  pendres_switching_home home;
  if (!is_followed(w, number)) return PENDRES_OK;
  pendres_langevin_request request = request_of(w, number, &home);
  scene_noise_chunk(w->trajectories, task % w->chunks, &first, &count);
  request.first_id += first;
  request.trajectories = count;
  const size_t n = count * (size_t)w->record;
  chunk *c = farm_record_resize(out, sizeof *c + 2 * n * sizeof(double));
  if (c == NULL) return PENDRES_OUT_OF_MEMORY;
  double *x = (double *)(c + 1);
  request.steps_per_period = w->clouds[number].bias.steps_per_period;
  pendres_status status = pendres_langevin_measure(ctx, &request, &c->part, x, x + n);
  if (status == PENDRES_NOT_FOUND) status = PENDRES_OK; /* all have left: an empty part */
  if (status == PENDRES_OK) c->strobes = n;
  return scene_verdict_note(&c->verdict, status, pendres_context_message(ctx));
}

/* The strobes of a chunk have their place among those of the cloud, as many as are written; a cloud
   of which a part fails has its first failure. */
static pendres_status collect_chunk(void *arg, size_t task, const farm_record *in)
{
  cloud_work *w = arg;
  const chunk *c = in->data;
  const size_t number = task / w->chunks;
  size_t first, count;
  if (in->size == 0) return PENDRES_OK;
  scene_noise_chunk(w->trajectories, task % w->chunks, &first, &count);
  const double *x = (const double *)(c + 1), *v = x + c->strobes;
  const size_t begin = first * (size_t)w->record;
  w->parts[task] = c->part;
  for (size_t k = 0; k < c->strobes && begin + k < w->strobes; k++) {
    w->x[number * w->strobes + begin + k] = x[k];
    w->v[number * w->strobes + begin + k] = v[k];
  }
  if (w->parts_failed.reason[number] == SCENE_FAILURE_NONE)
    scene_failures_take(&w->parts_failed, number, &c->verdict);
  return PENDRES_OK;
}

/* Nothing is left of a cloud that is broken, but the reason why. */
static void empty_broken(cloud_work *w, size_t number)
{
  cloud *c = &w->clouds[number];
  const pendres_langevin_estimate none = { NAN, NAN };
  if (w->parts_failed.reason[number] != SCENE_FAILURE_NONE)
    scene_failures_mark(&w->failed, number, (scene_failure)w->parts_failed.reason[number],
                        w->parts_failed.words[number]);
  if (!is_broken(w, number)) return;
  c->compared = c->narrow = 0;
  c->bias.steps_per_period = 0;
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++)
    c->measured.statistics[s] = c->bias.statistics[s] = none;
  for (size_t k = 0; k < w->strobes; k++)
    w->x[number * w->strobes + k] = w->v[number * w->strobes + k] = NAN;
}

/* ---- the scene's part --------------------------------------------------------------------- */

static pendres_status compute(scene_run *run, cloud_work *w)
{
  const size_t n = w->temperatures * w->attractors;
  w->clouds = calloc(n, sizeof *w->clouds);
  w->parts = calloc(n * w->chunks, sizeof *w->parts);
  w->x = malloc(n * w->strobes * sizeof *w->x);
  w->v = malloc(n * w->strobes * sizeof *w->v);
  if (w->clouds == NULL || w->parts == NULL || w->x == NULL || w->v == NULL ||
      scene_failures_create(n, &w->failed) != PENDRES_OK ||
      scene_failures_create(n, &w->parts_failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu clouds", n);
  for (size_t i = 0; i < n * w->strobes; i++) w->x[i] = w->v[i] = NAN;
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "choices of steps", .tasks = n, .task = choose,
                                      .record_size = sizeof(choice), .collect = collect_choice,
                                      .arg = w });
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "chunks of clouds", .tasks = n * w->chunks,
                                               .task = measure, .collect = collect_chunk,
                                               .arg = w });
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < n; i++) empty_broken(w, i);
  for (size_t i = 0; i < n; i++)
    if (is_followed(w, i))
      status = pendres_langevin_merge(w->chunks, w->parts + i * w->chunks, &w->clouds[i].measured);
  return status;
}

pendres_status scene_basins_write_clouds(scene_run *run, const pendres_attractors *set)
{
  const deck *d = run->deck;
  cloud_work w = { .d = d, .set = set,
             .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count,
             .attractors = pendres_attractors_count(set), .strobes = (size_t)d->basins.strobes,
             .trajectories = (size_t)d->basins.trajectories };
  pendres_status status = PENDRES_OK;
  if (w.temperatures == 0 || w.attractors == 0) return PENDRES_OK;
  if (deck_has_noise(d) && w.trajectories < 2)
    return scene_fail(run, PENDRES_INVALID_ARGUMENT,
                      "clouds need at least two trajectories (basins.trajectories)");
  w.chunks = scene_noise_chunks(w.trajectories);
  w.record = (long)((w.strobes + w.trajectories - 1) / w.trajectories);
  status = compute(run, &w);
  if (status == PENDRES_OK) status = scene_basins_clouds_write(run, &w);
  if (status == PENDRES_OK && run->table != NULL) scene_basins_clouds_print(run->table, &w);
  scene_failures_free(&w.failed);
  scene_failures_free(&w.parts_failed);
  free(w.clouds);
  free(w.parts);
  free(w.x);
  free(w.v);
  return status;
}
