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
#include "scenes/numbers.h"
#include "scenes/orbit/orbit.h"

/* A part of the record, with its samples. */
typedef struct chunk {
  orbit_way way;
  double samples[];
} chunk;

static long periods_of(const orbit_work *w, size_t number)
{
  const long left = (long)w->d->orbit.periods - (long)number * w->chunk;
  return left < w->chunk ? left : w->chunk;
}

static pendres_record samples_in(const orbit_work *w, double *first)
{
  const size_t room = w->room;
  return (pendres_record){ first, first + room, first + 2 * room, first + 3 * room };
}

/* ---- what the pendulum settles on ---------------------------------------------------------- */

static const orbit_found nothing = {
  .of = {.label = PENDRES_LABEL_UNRESOLVED, .lyapunov = NAN, .lyapunov_error = NAN, .drift = NAN,
         .drift_error = NAN, .watched_periods = NAN, .escape_rate_bound = NAN},
  .settling_periods = -1};

static void keep_orbit(const pendres_attractor *a, orbit_found *out)
{
  out->of = *a;
  out->closed = a->orbit.period > 0;
}

static int is_named(const orbit_work *w)
{
  return w->d->orbit.start[0] != '\0';
}

/* A name that no attractor has is a mistake of the deck. */
static pendres_status find_named(const scene_some *some, orbit_found *out)
{
  const orbit_work *w = some->of->arg;
  pendres_attractor a;
  const pendres_status status = scene_along_named(some->ctx, &w->pendulum, w->d->orbit.start, &a,
                                                  some->message, SCENE_MESSAGE);
  if (status == PENDRES_OK) keep_orbit(&a, out);
  return status;
}

static pendres_status find_from_start(const scene_some *some, orbit_found *out)
{
  const orbit_work *w = some->of->arg;
  pendres_attractors *set = NULL;
  pendres_settled outcome = { .label = PENDRES_LABEL_UNRESOLVED, .settling_periods = -1 };
  /* Nothing attracts without friction. */
  if (!(pendres_pendulum_decay_rate(&w->pendulum) > 0.0)) return PENDRES_OK;
  const pendres_status status = pendres_settle(some->ctx, 1, &w->pendulum, &w->d->orbit.x,
                                               &w->d->orbit.v, &outcome, &set);
  if (status == PENDRES_OK && outcome.attractor >= 0) {
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
    if (a != NULL) keep_orbit(a, out);
    out->well = outcome.well;
    out->settling_periods = outcome.settling_periods;
  }
  out->uncertain = outcome.attractor != PENDRES_ATTRACTOR_UNKNOWN && !outcome.certain;
  if (status == PENDRES_OK && outcome.attractor < 0) out->of.label = outcome.label;
  pendres_attractors_free(set);
  return status;
}

/* A trajectory is recorded whatever it goes to. */
static int too_long(const scene_points *p, size_t point, char *words, size_t size)
{
  const orbit_work *w = p->arg;
  (void)point;
  return !w->transient && scene_settling_too_long(w->d, &w->pendulum, 1.0, words, size);
}

static pendres_status find(const scene_some *some)
{
  const orbit_work *w = some->of->arg;
  orbit_found *out = some->rows;
  char words[SCENE_TOLD];
  *out = nothing;
  if (scene_settling_too_long(w->d, &w->pendulum, 1.0, words, sizeof words)) return PENDRES_OK;
  return is_named(w) ? find_named(some, out) : find_from_start(some, out);
}

static int check_found(const scene_points *p, const void *row)
{
  const orbit_found *f = row;
  (void)p;
  return scene_check_attractor(&f->of) && scene_check_code(f->closed, 2) &&
         scene_check_code(f->uncertain, 2) && (!f->closed || f->of.orbit.period > 0);
}

/* ---- the trajectory ------------------------------------------------------------------------ */

/* From the deck's start or, on an attractor that does not close, from a point of that. */
static pendres_status begin_trajectory(const orbit_work *w, pendres_context *ctx, orbit_way *way)
{
  const pendres_orbit *o = &w->found.of.orbit;
  double x = is_named(w) ? o->x : w->d->orbit.x, v = is_named(w) ? o->v : w->d->orbit.v;
  double error = 0.0;
  pendres_status status = PENDRES_OK;
  if (!w->transient)
    status = pendres_strobe_advance(ctx, 1, &w->pendulum, &x, &v, ORBIT_SETTLING, &error);
  if (status == PENDRES_OK)
    status = pendres_recording_begin(ctx, &w->pendulum, &(pendres_state){x, v},
                                     (long)w->d->orbit.periods, (int)w->d->orbit.samples,
                                     &way->recording);
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
static pendres_status sample_escape(const orbit_work *w, pendres_context *ctx, size_t number,
                                    orbit_way *way, const pendres_record *out)
{
  const size_t count = (size_t)w->d->orbit.samples;
  const long periods = periods_of(w, number);
  pendres_status status = number == 0 ? begin_trajectory(w, ctx, way) : PENDRES_OK;
  const int begun = status == PENDRES_OK && !way->gone;
  size_t at = 0;
  for (long k = 0; k < periods && begun && status == PENDRES_OK; k++, at += count) {
    const pendres_record to = from(out, at);
    status = pendres_recording_advance(ctx, &way->recording, 1, &to);
    if (status != PENDRES_OK) break;
  }
  const pendres_record rest = from(out, at);
  no_samples((size_t)periods * count - at, &rest);
  if (status != PENDRES_INTEGRATION_FAILED) return status;
  if (begun) {
    *rest.x = way->recording.x;
    *rest.v = way->recording.v;
    *rest.x_error = way->recording.x_error;
    *rest.v_error = way->recording.v_error;
  }
  way->gone = 1;
  return PENDRES_OK;
}

static pendres_status sample_trajectory(const orbit_work *w, pendres_context *ctx, size_t number,
                                        orbit_way *way, const pendres_record *out)
{
  const pendres_status status = number == 0 ? begin_trajectory(w, ctx, way) : PENDRES_OK;
  if (status != PENDRES_OK) return status;
  return pendres_recording_advance(ctx, &way->recording, periods_of(w, number), out);
}

/* The record goes on from what was collected of the part before. */
static pendres_status sample(const scene_some *some)
{
  const orbit_work *w = some->of->arg;
  const orbit_found *f = &w->found;
  chunk *r = some->rows;
  const pendres_record out = samples_in(w, r->samples);
  const long periods = periods_of(w, some->first);
  const pendres_orbit_stretch stretch = { f->well, (long)some->first * w->chunk, periods,
                                          (int)w->d->orbit.samples };
  memcpy(&r->way, &w->way, sizeof r->way);
  if (w->transient && f->of.label == PENDRES_LABEL_ESCAPE)
    return sample_escape(w, some->ctx, some->first, &r->way, &out);
  if (w->transient || scene_orbit_open(f))
    return sample_trajectory(w, some->ctx, some->first, &r->way, &out);
  if (f->closed) return pendres_orbit_record(some->ctx, &f->of.orbit, &stretch, &out);
  no_samples((size_t)periods * (size_t)w->d->orbit.samples, &out);
  return PENDRES_OK;
}

/* The recording has to be that of the deck, or unused. */
static int check_chunk(const scene_points *p, const void *row)
{
  const orbit_work *w = p->arg;
  const orbit_way *way = &((const chunk *)row)->way;
  const pendres_recording *r = &way->recording;
  const int unused = r->samples == 0 && r->periods == 0 && r->stretch == 0;
  return scene_check_code(way->gone, 2) &&
         (unused || (r->samples == (int)w->d->orbit.samples && r->periods <= w->d->orbit.periods));
}

static pendres_status collect(const scene_points *p, size_t number, size_t n, const void *rows)
{
  orbit_work *w = p->arg;
  const chunk *r = rows;
  const long first = (long)number * w->chunk, periods = periods_of(w, number);
  (void)n;
  memcpy(&w->way, &r->way, sizeof w->way);
  scene_orbit_put_samples(w, first, periods, r->samples);
  scene_orbit_measure_add(w, first, periods, r->samples);
  return w->run->status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  const long whole = TASK_SAMPLES / (long)d->orbit.samples, all = (long)d->orbit.periods;
  orbit_work w = { .d = d, .run = run,
                   /* On a named attractor there is no transient. */
                   .transient = d->orbit.transient && d->orbit.start[0] == '\0',
                   .pendulum = deck_pendulum(d), .found = nothing,
                   .search = {.n = 1, .chunk = 1, .size = sizeof(orbit_found), .compute = find,
                              .too_long = too_long, .none = &nothing, .check = check_found,
                              .what = "what the pendulum settles on", .rows = &w.found, .arg = &w},
                   .parts = {.chunk = 1, .compute = sample, .check = check_chunk,
                             .collect = collect, .unmarked = 1, .arg = &w} };
  w.chunk = whole < 1 ? 1 : whole < all ? whole : all;
  w.parts.n = (size_t)((all + w.chunk - 1) / w.chunk);
  w.room = (size_t)w.chunk * (size_t)d->orbit.samples + 1;
  w.parts.size = sizeof(chunk) + 4 * w.room * sizeof(double);
  SCENE_COMPUTE(run, &w.search, "orbits", .cheap = 1);
  scene_orbit_put_found(&w);
  scene_orbit_measure_begin(&w);
  SCENE_COMPUTE(run, &w.parts, "parts of the record", .last = 1, .chained = w.parts.n > 1);
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
static scene_more more(const deck *d, const farm_trial *trial, double samples)
{
  (void)d;
  (void)trial;
  return (scene_more){.output = -21.0 * fmax(samples - 2000.0, 0.0)};
}

const scene_kind scene_orbit = {
  .kind = DECK_ORBIT,
  .figures = "Figs. 5 and 6",
  .budget = 1,
  .path = 1,
  .size = {.head = 45e3, .point = 36.0, .memory = 60.0, .stages = 1.0, .after = 1.0,
           .seconds = 1e-5, .points = samples_of, .more = more},
  .describe = describe,
  .run = run_scene,
};
