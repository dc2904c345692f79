/*
 * scene_basins_noise.c -- stroboscopic clouds around attractors under thermal noise, as in the
 * paper's Fig. 7, with their covariances beside those of linear noise theory, and escapes.
 *
 * There is one task for each temperature and attractor, which finds the theory's values and the
 * steps; then one for each temperature, attractor and part of the trajectories (cloud.h). A cloud
 * of which a part fails is marked and has no results.
 */
#include "scenes/scene_basins_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_basins_clouds.h"

/* What a task has made of a cloud, before the `strobes` positions and velocities that it has. */
typedef struct made {
  pendres_cloud cloud;         /* of the tasks that prepare */
  pendres_langevin_cloud part; /* of those that follow */
  size_t strobes;
  scene_verdict verdict;
} made;

/* A record with room for so many strobe points, all NULL if there is no memory. */
static made *make_room(farm_record *out, size_t strobes, double **x, double **v)
{
  made *m = farm_record_resize(out, sizeof *m + 2 * strobes * sizeof(double));
  if (m == NULL) return NULL;
  m->strobes = strobes;
  *x = (double *)(m + 1);
  *v = *x + strobes;
  return m;
}

static pendres_status prepare(const void *arg, size_t number, pendres_context *ctx,
                              farm_record *out)
{
  const cloud_work *w = arg;
  const pendres_cloud_request q = cloud_request(w, number);
  double *x, *v;
  made *m = make_room(out, q.trajectories * (size_t)q.record, &x, &v);
  if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status = pendres_cloud_prepare(ctx, &q, &m->cloud, x, v);
  if (status == PENDRES_OK && m->cloud.way == PENDRES_CLOUD_FOLLOWED) {
    m->strobes = 0; /* they come with the parts */
    m = farm_record_resize(out, sizeof *m);
    if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  }
  return scene_verdict_note(&m->verdict, status, pendres_context_message(ctx));
}

/* Strobe points of a cloud from number `begin` on, as many as are written. */
static void keep_strobes(cloud_work *w, size_t number, size_t begin, const made *m)
{
  const double *x = (const double *)(m + 1), *v = x + m->strobes;
  for (size_t k = 0; k < m->strobes && begin + k < w->strobes; k++) {
    w->x[number * w->strobes + begin + k] = x[k];
    w->v[number * w->strobes + begin + k] = v[k];
  }
}

static pendres_status collect_prepared(void *arg, size_t number, const farm_record *in)
{
  cloud_work *w = arg;
  const made *m = in->data;
  w->clouds[number] = m->cloud;
  scene_failures_take(&w->failed, number, &m->verdict);
  keep_strobes(w, number, 0, m);
  return PENDRES_OK;
}

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const cloud_work *w = arg;
  const size_t number = task / w->parts, part = task % w->parts;
  pendres_cloud_request q = cloud_request(w, number);
  double *x, *v;
  if (!is_followed(w, number)) return PENDRES_OK;
  q.steps_per_period = w->clouds[number].bias.steps_per_period;
  made *m = make_room(out, pendres_cloud_part(&q, part, NULL) * (size_t)q.record, &x, &v);
  if (m == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status = pendres_cloud_follow(ctx, &q, part, &m->part, x, v);
  return scene_verdict_note(&m->verdict, status, pendres_context_message(ctx));
}

/* A cloud of which parts fail is marked with the first failure. */
static pendres_status collect_part(void *arg, size_t task, const farm_record *in)
{
  cloud_work *w = arg;
  const size_t number = task / w->parts;
  const pendres_cloud_request q = cloud_request(w, number);
  const made *m = in->data;
  size_t first;
  if (in->size == 0) return PENDRES_OK;
  (void)pendres_cloud_part(&q, task % w->parts, &first);
  w->part[task] = m->part;
  keep_strobes(w, number, first * (size_t)q.record, m);
  if (w->parts_failed.reason[number] == SCENE_FAILURE_NONE)
    scene_failures_take(&w->parts_failed, number, &m->verdict);
  return PENDRES_OK;
}

/* Put all parts of a cloud together; of a cloud that failed nothing is kept but the reason. */
static pendres_status conclude(cloud_work *w, size_t number)
{
  const pendres_cloud_request q = cloud_request(w, number);
  if (w->parts_failed.reason[number] != SCENE_FAILURE_NONE)
    scene_failures_mark(&w->failed, number, (scene_failure)w->parts_failed.reason[number],
                        w->parts_failed.words[number]);
  if (!is_broken(w, number))
    return pendres_cloud_conclude(&q, w->parts, w->part + number * w->parts, &w->clouds[number]);
  for (size_t k = 0; k < w->strobes; k++)
    w->x[number * w->strobes + k] = w->v[number * w->strobes + k] = NAN;
  return PENDRES_OK;
}

static pendres_status compute(scene_run *run, cloud_work *w)
{
  const size_t n = w->temperatures * w->attractors;
  w->clouds = calloc(n, sizeof *w->clouds);
  w->part = calloc(n * w->parts, sizeof *w->part);
  w->x = malloc(n * w->strobes * sizeof *w->x);
  w->v = malloc(n * w->strobes * sizeof *w->v);
  if (w->clouds == NULL || w->part == NULL || w->x == NULL || w->v == NULL ||
      scene_failures_create(n, &w->failed) != PENDRES_OK ||
      scene_failures_create(n, &w->parts_failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu clouds", n);
  for (size_t i = 0; i < n * w->strobes; i++) w->x[i] = w->v[i] = NAN;
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "choices of steps", .tasks = n, .task = prepare,
                                      .cheap = 1,
                                      .record_size = sizeof(made), .collect = collect_prepared,
                                      .arg = w });
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "chunks of clouds", .tasks = n * w->parts,
                                               .task = follow, .collect = collect_part,
                                               .arg = w });
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) status = conclude(w, i);
  return status == PENDRES_OK ? status : scene_fail(run, status, "clouds cannot be put together");
}

pendres_status scene_basins_write_clouds(scene_run *run, const pendres_attractors *set)
{
  const deck *d = run->deck;
  cloud_work w = { .d = d, .set = set, .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count,
                   .attractors = pendres_attractors_count(set),
                   .strobes = (size_t)d->basins.strobes };
  pendres_status status = PENDRES_OK;
  if (w.temperatures == 0 || w.attractors == 0) return PENDRES_OK;
  const pendres_cloud_request q = cloud_request(&w, 0);
  w.parts = pendres_cloud_parts(&q);
  status = compute(run, &w);
  if (status == PENDRES_OK) status = scene_basins_clouds_write(run, &w);
  if (status == PENDRES_OK && run->table != NULL) scene_basins_clouds_print(run->table, &w);
  scene_failures_free(&w.failed);
  scene_failures_free(&w.parts_failed);
  free(w.clouds);
  free(w.part);
  free(w.x);
  free(w.v);
  return status;
}
