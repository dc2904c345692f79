/*
 * scene_response.c -- amplitude and phase lag of the mean loop against the drive period.
 *
 * The paper's Figs. 3 and 4. One task a damping and handful of drive periods, and one a damping
 * for its resonance. With temperatures in the deck the results have one more dimension: see
 * scene_response_noise.c.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"
#include "scenes/scene_response_noise.h"

static const double two_pi = 6.28318530717958647693;

enum { CHUNK = 16 /* drive periods a task */ };

typedef struct grid {
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  size_t dampings, drives;    /* sizes of the axes */
  size_t chunks;              /* tasks a damping */
  pendres_response *points;   /* [damping][drive] */
  pendres_resonance *peaks;   /* [damping] */
  pendres_status *outcome;    /* of the peaks */
  scene_failures failed;      /* [damping][drive] */
  scene_failures peak_failed; /* [damping] */
} grid;

/* The scene's second axis: the drive period, or the frequency where the deck says so. */
static deck_axis_id drive_axis(const deck *d)
{
  return d->axis[DECK_AXIS_DRIVE_PERIOD].count > 0 ? DECK_AXIS_DRIVE_PERIOD
                                                   : DECK_AXIS_DRIVE_FREQUENCY;
}

static void plan(const deck *d, FILE *out)
{
  const deck_axis *drive = &d->axis[drive_axis(d)];
  fprintf(out,
          "mean response of %lld members at %zu dampings and %zu values of %s, %g to %g,\n"
          "drive amplitude %g; and the resonance of each damping\n",
          (long long)d->ensemble.members, d->axis[DECK_AXIS_DAMPING].count, drive->count,
          deck_axis_name(drive_axis(d)), drive->value[0], drive->value[drive->count - 1],
          d->pendulum.drive_amplitude);
}

static pendres_pendulum pendulum_at(const grid *g, size_t damping, size_t drive)
{
  return pendres_sweep_pendulum(&g->sweep, damping * g->drives + drive, NULL, NULL);
}

/* What a task finds: a handful of points, or, of the tasks after these, a resonance. */
typedef struct point_record {
  pendres_response point[CHUNK];
  scene_verdict verdict[CHUNK];
} point_record;

typedef struct peak_record {
  pendres_status outcome;
  pendres_resonance peak;
  scene_verdict verdict;
} peak_record;

static pendres_status compute_peak(const grid *g, size_t i, pendres_context *ctx, peak_record *r)
{
  enum { FREQUENCIES = 50 /* of a search, about */ };
  char words[120];
  pendres_pendulum p = pendulum_at(g, i, 0);
  p.drive_frequency = g->d->search[0];
  if (scene_failure_too_long(&p, FREQUENCIES, words, sizeof words)) {
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_TOO_LONG, words);
    r->outcome = PENDRES_NOT_CONVERGED;
    return PENDRES_OK;
  }
  r->outcome = pendres_resonance_find_ensemble(ctx, &p, g->d->search[0], g->d->search[1],
                                               &g->ensemble, &r->peak);
  if (r->outcome == PENDRES_OK && !r->peak.complete)
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_BUDGET, NULL);
  return scene_verdict_note(&r->verdict, r->outcome, pendres_context_message(ctx));
}

/* A point without a response: nothing is known of any member. */
static pendres_response no_response(const pendres_pendulum *p, size_t members)
{
  pendres_response r = { .pendulum = *p, .unresolved = members };
  pendres_response_average(&r);
  return r;
}

/* What cannot be had of several points at a time is had, or not, of each. */
static pendres_status compute_points(const grid *g, size_t n, const pendres_pendulum *pendulums,
                                     pendres_context *ctx, point_record *r)
{
  pendres_status status = PENDRES_OK;
  char words[120];
  int too_long = 0;
  for (size_t i = 0; i < n; i++)
    too_long |= scene_failure_too_long(&pendulums[i], 1.0, words, sizeof words);
  if (!too_long) {
    status = pendres_response_compute(ctx, n, pendulums, &g->ensemble, r->point);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  }
  status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (scene_failure_too_long(&pendulums[i], 1.0, words, sizeof words)) {
      r->point[i] = no_response(&pendulums[i], g->ensemble.members);
      scene_verdict_mark(&r->verdict[i], SCENE_FAILURE_TOO_LONG, words);
      continue;
    }
    status = pendres_response_compute(ctx, 1, &pendulums[i], &g->ensemble, &r->point[i]);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE) continue;
    r->point[i] = no_response(&pendulums[i], g->ensemble.members);
    status = scene_verdict_note(&r->verdict[i], status, pendres_context_message(ctx));
  }
  return status;
}

/* A point that was computed, but not wholly. */
static void judge_point(const grid *g, const pendres_response *p, scene_verdict *verdict)
{
  if (verdict->reason != SCENE_FAILURE_NONE) return;
  if (p->unresolved > 0) {
    char words[80];
    snprintf(words, sizeof words, "%zu of %zu members did not settle: a larger period_budget may "
             "do", p->unresolved, g->ensemble.members);
    scene_verdict_mark(verdict, SCENE_FAILURE_UNRESOLVED, words);
  } else if (isnan(p->mean_loop_area)) {
    scene_verdict_mark(verdict, SCENE_FAILURE_NO_MEAN, NULL);
  }
}

/* The points of a task: *n of them from the first on. */
static size_t first_of(const grid *g, size_t task, size_t *n)
{
  const size_t drive = task % g->chunks * CHUNK;
  *n = g->drives - drive < CHUNK ? g->drives - drive : CHUNK;
  return task / g->chunks * g->drives + drive;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const grid *g = arg;
  pendres_pendulum pendulums[CHUNK] = { 0 };
  size_t n;
  if (task >= g->dampings * g->chunks) {
    peak_record *peak = farm_record_resize(out, sizeof *peak);
    return peak == NULL ? PENDRES_OUT_OF_MEMORY
                        : compute_peak(g, task - g->dampings * g->chunks, ctx, peak);
  }
  point_record *r = farm_record_resize(out, sizeof *r);
  if (r == NULL) return PENDRES_OUT_OF_MEMORY;
  const size_t first = first_of(g, task, &n);
  for (size_t k = 0; k < n; k++)
    pendulums[k] = pendres_sweep_pendulum(&g->sweep, first + k, NULL, NULL);
  const pendres_status status = compute_points(g, n, pendulums, ctx, r);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++)
    judge_point(g, &r->point[k], &r->verdict[k]);
  return status;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  grid *g = arg;
  size_t n;
  if (task >= g->dampings * g->chunks) {
    const peak_record *r = in->data;
    const size_t i = task - g->dampings * g->chunks;
    g->outcome[i] = r->outcome;
    g->peaks[i] = r->peak;
    scene_failures_take(&g->peak_failed, i, &r->verdict);
    return PENDRES_OK;
  }
  const point_record *r = in->data;
  const size_t first = first_of(g, task, &n);
  memcpy(g->points + first, r->point, n * sizeof *r->point);
  for (size_t k = 0; k < n; k++) scene_failures_take(&g->failed, first + k, &r->verdict[k]);
  return PENDRES_OK;
}

/* States that are alone at a point have their names from the others of its damping: the record is
   the damping's points anew. */
static pendres_status name_states(const void *arg, size_t task, pendres_context *ctx,
                                  farm_record *out)
{
  const grid *g = arg;
  memcpy(out->data, g->points + task * g->drives, out->size);
  return pendres_response_name(ctx, g->drives, out->data);
}

static pendres_status collect_names(void *arg, size_t task, const farm_record *in)
{
  grid *g = arg;
  memcpy(g->points + task * g->drives, in->data, in->size);
  return PENDRES_OK;
}

#define FIELD(name, text, unit)                                                              \
  {#name, text, unit, offsetof(pendres_response, name), offsetof(pendres_response, name##_error)}

static const struct {
  const char *name, *long_name, *units;
  size_t value, error;
} fields[] = {
  FIELD(mean_loop_area, "mean loop area of the ensemble", "1"),
  FIELD(mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  FIELD(mean_amplitude, "mean of the members' amplitudes", "rad"),
  FIELD(phase_lag, "phase lag of the ensemble-averaged loop", "rad"),
  FIELD(mean_power, "mean power taken up from the drive", "1"),
  FIELD(sa_fraction, "share of the members on the small-amplitude state", "1"),
  FIELD(la_fraction, "share of the members on the large-amplitude state", "1"),
};

static double field(const pendres_response *r, size_t offset)
{
  double value;
  memcpy(&value, (const char *)r + offset, sizeof value);
  return value;
}

static pendres_status write_points(scene_run *run, const grid *g, double *value, double *error)
{
  const char *drive = deck_axis_name(drive_axis(g->d));
  const size_t n = g->dampings * g->drives;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof fields / sizeof fields[0] && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = fields[k].name, .dimensions = {"damping", drive},
                                     .long_name = fields[k].long_name, .units = fields[k].units};
    for (size_t i = 0; i < n; i++) {
      value[i] = field(&g->points[i], fields[k].value);
      error[i] = field(&g->points[i], fields[k].error);
    }
    status = pendres_store_put_result(run->store, &spec, value, error, n);
  }
  return status;
}

static pendres_status write_uncertain(scene_run *run, const grid *g)
{
  const deck_axis_id axes[] = {DECK_AXIS_DAMPING, drive_axis(g->d)};
  const size_t n = g->dampings * g->drives;
  int64_t *count = malloc(n * sizeof *count);
  if (count == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) count[i] = (int64_t)g->points[i].uncertain;
  const pendres_status status = scene_write_uncertain(run, 2, axes, count);
  free(count);
  return status;
}

static void peak_value(const pendres_resonance *r, int which, double *value, double *error)
{
  const pendres_response *a = &r->response;
  switch (which) {
  case 0:
    *value = two_pi / r->frequency;
    *error = *value * r->frequency_error / r->frequency;
    break;
  case 1: *value = r->loop_area, *error = r->loop_area_error; break;
  case 2: *value = a->mean_loop_amplitude, *error = a->mean_loop_amplitude_error; break;
  default: *value = a->phase_lag, *error = a->phase_lag_error; break;
  }
}

static pendres_status write_peaks(scene_run *run, const grid *g, double *value, double *error)
{
  static const struct {
    const char *name, *long_name, *units;
  } results[] = {
    {"resonance_period", "drive period of the largest mean loop area", "1"},
    {"resonance_loop_area", "mean loop area at resonance", "1"},
    {"resonance_amplitude", "amplitude of the ensemble-averaged loop at resonance", "rad"},
    {"resonance_phase_lag", "phase lag of the ensemble-averaged loop at resonance", "rad"},
  };
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < 4 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = results[k].name, .dimensions = {"damping"},
                                     .long_name = results[k].long_name, .units = results[k].units};
    for (size_t i = 0; i < g->dampings; i++) {
      value[i] = error[i] = NAN;
      if (g->outcome[i] == PENDRES_OK) peak_value(&g->peaks[i], k, &value[i], &error[i]);
    }
    status = pendres_store_put_result(run->store, &spec, value, error, g->dampings);
  }
  return status;
}

static pendres_status write_failures(scene_run *run, const grid *g)
{
  const deck_axis_id axes[] = { DECK_AXIS_DAMPING, drive_axis(g->d) };
  const pendres_status status =
    scene_failures_write(run, &g->failed, "failed", "response", 2, axes);
  return status != PENDRES_OK ? status
                              : scene_failures_write(run, &g->peak_failed, "resonance_failed",
                                                     "resonance", 1, axes);
}

static pendres_status write_results(scene_run *run, const grid *g)
{
  const deck_axis *damping = &g->d->axis[DECK_AXIS_DAMPING];
  const deck_axis_id axis = drive_axis(g->d);
  const size_t n = g->dampings * g->drives;
  double *value = malloc(n * sizeof *value), *error = malloc(n * sizeof *error);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || error == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  status = pendres_store_dimension(run->store, "", "damping", g->dampings, damping->value,
                                   "damping", "1");
  if (status == PENDRES_OK)
    status = pendres_store_dimension(run->store, "", deck_axis_name(axis), g->drives,
                                     g->d->axis[axis].value,
                                     axis == DECK_AXIS_DRIVE_PERIOD ? "drive period"
                                                                    : "drive frequency",
                                     "1");
  const scene_response_grid grid = {
    .dampings = g->dampings, .drives = g->drives, .damping = "damping",
    .drive = deck_axis_name(axis), .points = g->points};
  if (status == PENDRES_OK)
    status = g->d->axis[DECK_AXIS_TEMPERATURE].count > 0 ? scene_response_write_noise(run, &grid)
                                                         : write_points(run, g, value, error);
  if (status == PENDRES_OK) status = write_uncertain(run, g);
  if (status == PENDRES_OK) status = write_peaks(run, g, value, error);
  if (status == PENDRES_OK) status = write_failures(run, g);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(error);
  return status;
}

/* Resonant periods that the paper prints in the captions of Figs. 3 and 4, F0 = 0.2. */
static pendres_status write_paper(scene_run *run, const grid *g)
{
  static const struct {
    double damping, period;
    const char *name;
  } printed[] = {
    {0.24, 6.66, "resonance_period_damping_0_24"},
    {0.32, 6.542, "resonance_period_damping_0_32"},
    {0.80, 6.865, "resonance_period_damping_0_80"},
    {0.90, 7.02, "resonance_period_damping_0_90"},
  };
  scene_printed values[4];
  size_t n = 0;
  if (fabs(g->d->pendulum.drive_amplitude - 0.2) > 1e-12) return PENDRES_OK;
  for (size_t k = 0; k < 4; k++)
    for (size_t i = 0; i < g->dampings; i++) {
      const double damping = g->d->axis[DECK_AXIS_DAMPING].value[i];
      if (fabs(damping - printed[k].damping) > 1e-12 || g->outcome[i] != PENDRES_OK) continue;
      values[n] = (scene_printed){.name = printed[k].name, .printed = printed[k].period};
      peak_value(&g->peaks[i], 0, &values[n].computed, &values[n].error);
      n++;
    }
  return n > 0 ? scene_write_paper(run, n, values) : PENDRES_OK;
}

static void print_table(FILE *out, const grid *g)
{
  fprintf(out, "damping   resonant period  amplitude  phase lag  loop area\n");
  for (size_t i = 0; i < g->dampings; i++) {
    const pendres_resonance *r = &g->peaks[i];
    const double damping = g->d->axis[DECK_AXIS_DAMPING].value[i];
    if (g->outcome[i] == PENDRES_OK)
      fprintf(out, "%-9.4g %.9f      %.6f   %.6f   %.8f\n", damping, two_pi / r->frequency,
              r->response.mean_loop_amplitude, r->response.phase_lag, r->loop_area);
    else
      fprintf(out, "%-9.4g %s\n", damping,
              g->outcome[i] == PENDRES_NOT_FOUND ? "no peak in the range" : "failed");
  }
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  grid g = {.d = d,
            .sweep = scene_sweep(d),
            .ensemble = scene_ensemble(d),
            .dampings = d->axis[DECK_AXIS_DAMPING].count,
            .drives = d->axis[drive_axis(d)].count};
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  g.chunks = (g.drives + CHUNK - 1) / CHUNK;
  g.points = calloc(g.dampings * g.drives, sizeof *g.points);
  g.peaks = calloc(g.dampings, sizeof *g.peaks);
  g.outcome = calloc(g.dampings, sizeof *g.outcome);
  if (g.points == NULL || g.peaks == NULL || g.outcome == NULL ||
      scene_failures_create(g.dampings * g.drives, &g.failed) != PENDRES_OK ||
      scene_failures_create(g.dampings, &g.peak_failed) != PENDRES_OK) {
    (void)scene_fail(run, status, "out of memory for %zu points", g.dampings * g.drives);
    goto done;
  }
  status = scene_compute(run, &(farm_stage){ .what = "chunks", .task = compute,
                                             .tasks = g.dampings * (g.chunks + 1),
                                             .collect = collect, .arg = &g });
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "dampings", .tasks = g.dampings, .cheap = 1,
                                               .task = name_states, .collect = collect_names,
                                               .record_size = g.drives * sizeof *g.points,
                                               .arg = &g });
  if (status == PENDRES_OK) status = write_results(run, &g);
  if (status == PENDRES_OK) status = write_paper(run, &g);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &g);
done:
  free(g.points);
  free(g.peaks);
  free(g.outcome);
  scene_failures_free(&g.failed);
  scene_failures_free(&g.peak_failed);
  return status;
}

const scene_kind scene_response = {
  .kind = DECK_RESPONSE,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Figs. 3 and 4; with temperature: S. A. Chin, Phys. Lett. A 226 (1997) "
                "344; H. A. Forbert and S. A. Chin, Phys. Rev. E 63 (2000) 016703",
  .plan = plan,
  .run = run_scene};
