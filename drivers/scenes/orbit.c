/*
 * orbit.c -- one pendulum's orbit: position, velocity and drive over some drive periods, and
 * all that is measured on the closed orbit. Figs. 5 and 6 of the paper.
 *
 * The orbit is a named attractor of the parameter set (start = 'sa', 'la', or
 * '1', '2', ... by amplitude), or what a start at
 * x, v settles on, in the well where it settles. With transient = .true. the trajectory is
 * recorded from the start itself, and the measures are still those of the orbit it goes to.
 *
 * A record may be longer than memory: each task makes a chunk of it, which is written as soon as it
 * is there, and begins where the one before has ended.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/along.h"
#include "scenes/orbit.h"

enum {
  WANDERING = 100, /* periods before a chaotic orbit is recorded */
  CHUNK = 65536    /* samples of a task, or one period */
};

/* What a task hands over, with the samples behind it: x, v and their errors, `room` of each. */
typedef struct record {
  orbit_found found;
  pendres_recording recording;
} record;

static size_t room_of(const orbit_work *w)
{
  return (size_t)w->chunk * (size_t)w->d->orbit.samples + 1;
}

static long periods_of(const orbit_work *w, size_t task)
{
  const long left = (long)w->d->orbit.periods - (long)task * w->chunk;
  return left < w->chunk ? left : w->chunk;
}

static pendres_record samples_in(const orbit_work *w, const record *r)
{
  const size_t room = room_of(w);
  double *first = (double *)(r + 1);
  return (pendres_record){ first, first + room, first + 2 * room, first + 3 * room };
}

/* ---- what the pendulum settles on ---------------------------------------------------------- */

static void keep_orbit(orbit_work *w, const pendres_attractor *a)
{
  w->found.label = a->label;
  w->found.closed = a->label != PENDRES_LABEL_CHAOTIC;
  w->found.orbit = a->orbit;
  w->found.lyapunov = a->lyapunov;
  w->found.lyapunov_error = a->lyapunov_error;
  w->found.drift = a->drift;
  w->found.drift_error = a->drift_error;
  w->found.watched_periods = a->watched_periods;
  w->found.escape_rate_bound = a->escape_rate_bound;
}

static pendres_status find_named(orbit_work *w, pendres_context *ctx, farm_record *out)
{
  pendres_attractor a;
  const pendres_status status = scene_along_named(ctx, &w->pendulum, w->d->orbit.start, &a,
                                                  out->message, sizeof out->message);
  if (status != PENDRES_OK) return status;
  keep_orbit(w, &a);
  w->start_x = a.orbit.x;
  w->start_v = a.orbit.v;
  return status;
}

static pendres_status find_from_start(orbit_work *w, pendres_context *ctx)
{
  pendres_attractors *set = NULL;
  pendres_outcome outcome = { .label = PENDRES_LABEL_UNRESOLVED, .settling_periods = -1 };
  w->found.label = PENDRES_LABEL_UNRESOLVED;
  if (w->pendulum.damping == 0.0) return PENDRES_OK; /* nothing attracts without friction */
  const pendres_status status = pendres_settle(ctx, 1, &w->pendulum, &w->d->orbit.x,
                                               &w->d->orbit.v, &outcome, &set);
  if (status == PENDRES_OK && outcome.attractor >= 0) {
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
    if (a != NULL) keep_orbit(w, a);
    w->found.well = outcome.well;
    w->found.settling_periods = outcome.settling_periods;
  }
  w->found.uncertain = outcome.attractor != PENDRES_ATTRACTOR_UNKNOWN && !outcome.certain;
  if (status == PENDRES_OK && outcome.label == PENDRES_LABEL_ESCAPE)
    w->found.label = outcome.label;
  pendres_attractors_free(set);
  return status;
}

/* ---- the trajectory ------------------------------------------------------------------------ */

static pendres_status begin_trajectory(orbit_work *w, pendres_context *ctx)
{
  double x = w->start_x, v = w->start_v, error = 0.0;
  pendres_status status = PENDRES_OK;
  if (!w->transient) /* on the chaotic attractor */
    status = pendres_strobe_advance(ctx, 1, &w->pendulum, &x, &v, WANDERING, &error);
  if (status == PENDRES_OK)
    status = pendres_recording_begin(ctx, &w->pendulum, &(pendres_state){x, v},
                                     (long)w->d->orbit.periods, (int)w->d->orbit.samples,
                                     &w->recording);
  return status;
}

/* What a record has from point `at` on. */
static pendres_record from(const pendres_record *r, size_t at)
{
  return (pendres_record){ r->x + at, r->v + at, r->x_error + at, r->v_error + at };
}

static void no_samples(size_t n, const pendres_record *out)
{
  for (size_t k = 0; k < n; k++)
    out->x[k] = out->v[k] = out->x_error[k] = out->v_error[k] = NAN;
}

/* A trajectory to infinity is recorded period by period, up to the last state that double precision
   can say. */
static pendres_status sample_escape(orbit_work *w, pendres_context *ctx, size_t task,
                                    const pendres_record *out)
{
  const size_t count = (size_t)w->d->orbit.samples;
  const long periods = periods_of(w, task);
  pendres_status status = task == 0 ? begin_trajectory(w, ctx) : PENDRES_OK;
  const int begun = status == PENDRES_OK && !w->found.gone;
  size_t at = 0;
  for (long k = 0; k < periods && begun && status == PENDRES_OK; k++, at += count) {
    const pendres_record to = from(out, at);
    status = pendres_recording_advance(ctx, &w->recording, 1, &to);
    if (status != PENDRES_OK) break;
  }
  const pendres_record rest = from(out, at);
  no_samples((size_t)periods * count - at, &rest);
  if (status != PENDRES_INTEGRATION_FAILED) return status;
  if (begun) {
    *rest.x = w->recording.x;
    *rest.v = w->recording.v;
    *rest.x_error = w->recording.x_error;
    *rest.v_error = w->recording.v_error;
  }
  w->found.gone = 1;
  return PENDRES_OK;
}

static pendres_status sample(orbit_work *w, pendres_context *ctx, size_t task,
                             const pendres_record *out)
{
  const long periods = periods_of(w, task);
  const pendres_orbit_stretch stretch = { w->found.well, (long)task * w->chunk, periods,
                                          (int)w->d->orbit.samples };
  if (w->transient && w->found.label == PENDRES_LABEL_ESCAPE)
    return sample_escape(w, ctx, task, out);
  if (w->transient || w->found.label == PENDRES_LABEL_CHAOTIC) {
    const pendres_status status = task == 0 ? begin_trajectory(w, ctx) : PENDRES_OK;
    return status == PENDRES_OK ? pendres_recording_advance(ctx, &w->recording, periods, out)
                                : status;
  }
  if (w->found.closed) return pendres_orbit_record(ctx, &w->found.orbit, &stretch, out);
  no_samples((size_t)periods * (size_t)w->d->orbit.samples, out);
  return PENDRES_OK;
}

/* Find what there is to record. The budget applies to this search; a record takes a known time.
   What cannot be found is marked; a name that no attractor has is a mistake of the deck. */
static pendres_status find(orbit_work *w, pendres_context *ctx, farm_record *out)
{
  const int named = w->d->orbit.start[0] != '\0';
  char words[SCENE_TOLD];
  pendres_status status = PENDRES_OK;
  w->found.label = PENDRES_LABEL_UNRESOLVED;
  farm_point(out, 1, "what the pendulum settles on");
  if (scene_settling_too_long(w->d, &w->pendulum, 1.0, words, sizeof words)) {
    if (!w->transient) scene_verdict_mark(&w->found.verdict, SCENE_FAILURE_TOO_LONG, words);
  } else {
    status = named ? find_named(w, ctx, out) : find_from_start(w, ctx);
    if (status != PENDRES_NOT_FOUND)
      status = scene_verdict_point(&w->found.verdict, status, pendres_context_message(ctx), out);
  }
  farm_point(out, 0, "the record of the orbit");
  return status;
}

/* The first task finds what there is to record; the others go on from what was collected. */
static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  orbit_work w = *(const orbit_work *)arg;
  record *r = out->data;
  const pendres_record samples = samples_in(&w, r);
  pendres_status status = task == 0 ? find(&w, ctx, out) : PENDRES_OK;
  if (status == PENDRES_OK) status = sample(&w, ctx, task, &samples);
  r->found = w.found;
  memcpy(&r->recording, &w.recording, sizeof r->recording);
  return status;
}

/* The recording goes on from where it stands, and has to be that of the deck. */
static int check(const void *arg, size_t task, const farm_record *in)
{
  const orbit_work *w = arg;
  const record *r = in->data;
  if (in->size != sizeof *r + 4 * room_of(w) * sizeof(double)) return 0;
  const pendres_attractor a = { .label = r->found.label, .orbit = r->found.orbit };
  const pendres_recording *p = &r->recording;
  const long periods = (long)task * w->chunk + periods_of(w, task);
  const int unused = p->samples == 0 && p->periods == 0 && p->stretch == 0;
  return scene_check_attractor(&a) && scene_check_verdict(&r->found.verdict) &&
         scene_check_code(r->found.closed, 2) && scene_check_code(r->found.gone, 2) &&
         (!r->found.closed || r->found.orbit.period > 0) &&
         (unused || (p->samples == (int)w->d->orbit.samples && p->periods <= periods));
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  orbit_work *w = arg;
  const record *r = in->data;
  const pendres_record samples = samples_in(w, r);
  const long first = (long)task * w->chunk, periods = periods_of(w, task);
  w->found = r->found;
  memcpy(&w->recording, &r->recording, sizeof w->recording);
  if (task == 0) scene_orbit_put_found(w);
  if (task == 0) scene_orbit_measure_begin(w);
  scene_orbit_put_samples(w, first, periods, &samples);
  scene_orbit_measure_add(w, first, periods, &samples);
  return w->run->status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  const long whole = CHUNK / (long)d->orbit.samples, all = (long)d->orbit.periods;
  orbit_work w = { .d = d, .run = run,
                   .found = { .settling_periods = -1, .lyapunov = NAN, .lyapunov_error = NAN,
                              .drift = NAN, .drift_error = NAN, .watched_periods = NAN,
                              .escape_rate_bound = NAN },
                   /* On a named attractor there is no transient. */
                   .transient = d->orbit.transient && d->orbit.start[0] == '\0',
                   .start_x = d->orbit.x, .start_v = d->orbit.v,
                   .pendulum = deck_pendulum(d) };
  w.chunk = whole < 1 ? 1 : whole < all ? whole : all;
  const size_t tasks = (size_t)((all + w.chunk - 1) / w.chunk);
  scene_compute(
    run, &(farm_stage){ .what = tasks > 1 ? "parts of the record" : "orbits", .last = 1,
                        .tasks = tasks, .chained = tasks > 1, .task = compute,
                        .record_size = sizeof(record) + 4 * room_of(&w) * sizeof(double),
                        .check = check, .collect = collect, .arg = &w });
  scene_orbit_measure_put(&w);
  if (scene_prints(run)) scene_orbit_tabulate(run->table, &w);
  scene_orbit_measure_free(&w);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "orbit at damping %g, drive amplitude %g, drive period %g\n", d->pendulum.damping,
          d->pendulum.drive_amplitude, d->drive_period);
  if (d->orbit.start[0] != '\0') fprintf(out, "of the attractor '%s'", d->orbit.start);
  else
    fprintf(out, "%s x = %g, v = %g", d->orbit.transient ? "recorded from" : "that is reached from",
            d->orbit.x, d->orbit.v);
  fprintf(out, ", %lld samples over %lld periods\n",
          (long long)(d->orbit.periods * d->orbit.samples), (long long)d->orbit.periods);
}

static double samples_of(const deck *d)
{
  return (double)d->orbit.periods * (double)d->orbit.samples;
}

/* Samples beyond the first ones are stored with little gain, in some bytes less. */
static double more_output(const deck *d, const farm_trial *trial, double samples)
{
  (void)d;
  (void)trial;
  return -21.0 * fmax(samples - 2000.0, 0.0);
}

const scene_kind scene_orbit = {
  .kind = DECK_ORBIT,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Figs. 5 and 6",
  .budget = 1,
  .size = {.head = 45e3, .point = 36.0, .memory = 60.0, .stages = 1.0, .after = 1.0,
           .seconds = 1e-5, .points = samples_of, .more_output = more_output},
  .describe = describe,
  .run = run_scene,
};
