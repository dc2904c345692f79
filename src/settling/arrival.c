/* arrival.c -- what single pendulums come to; see arrival.h. */
#include "settling/arrival.h"

#include <math.h>
#include <stdlib.h>

#include <pendres/strobe.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/threads.h"
#include "model/model.h"
#include "orbits/orbit_span.h"
#include "orbits/orbit_table.h"
#include "settling/exponents/lyapunov_caught.h"
#include "settling/numbers.h"

/* Student's t for sixteen batches, at 99.9 %. */
static const double batches_sure = 4.073;

int pendres_arrival_alike(const pendres_attractor *a, const pendres_attractor *b)
{
  if (!pendres_attractor_closes(a) || !pendres_attractor_closes(b)) return a->label == b->label;
  return a->orbit.period == b->orbit.period &&
         abs(a->orbit.winding) == abs(b->orbit.winding) &&
         fabs(a->orbit.amplitude - b->orbit.amplitude) < orbit_another;
}

pendres_attractor pendres_arrival_nothing(const pendres_pendulum *p)
{
  return (pendres_attractor){
    .label = PENDRES_LABEL_UNRESOLVED, .orbit = pendres_orbit_none(p), .lyapunov = NAN,
    .lyapunov_error = NAN, .trap_metric = {NAN, NAN, NAN}, .trap_radius = NAN, .drift = NAN,
    .drift_error = NAN, .watched_periods = NAN, .escape_rate_bound = NAN};
}

pendres_arrival pendres_arrival_at(const pendres_pendulum *p, double x, double v)
{
  return (pendres_arrival){
    .pendulum = *p, .attractor = pendres_arrival_nothing(p), .x = x, .v = v};
}

pendres_attractor pendres_arrival_orbit(const pendres_orbit *o)
{
  pendres_attractor a = pendres_arrival_nothing(&o->pendulum);
  pendres_settled l;
  pendres_lyapunov_take_orbit(o, &l);
  a.orbit = *o;
  a.label = l.label;
  a.lyapunov = l.exponent;
  a.lyapunov_error = l.exponent_error;
  return a;
}

pendres_arrival pendres_arrival_turning(const pendres_pendulum *p, const pendres_rotation *r)
{
  const pendres_open_measures m = pendres_open_turning(p, r);
  return (pendres_arrival){
    .pendulum = *p, .attractor = pendres_attractor_open(p, &m), .x = m.x, .v = m.v, .certain = 1};
}

/* ---- by averages --------------------------------------------------------------------------- */

/* What averages have told. */
static void take_verdict(const pendres_settled *l, const pendres_orbit *orbit, pendres_arrival *s)
{
  if (orbit->period > 0) {
    s->attractor = pendres_arrival_orbit(orbit);
    s->x = orbit->x;
    s->v = orbit->v;
  }
  if (l->label != PENDRES_LABEL_QUASI_PERIODIC && l->label != PENDRES_LABEL_CHAOTIC) return;
  s->attractor.label = l->label;
  s->attractor.lyapunov = l->exponent;
  s->attractor.lyapunov_error = l->exponent_error;
  s->attractor.drift = l->rotation;
  s->attractor.drift_error =
    l->label == PENDRES_LABEL_CHAOTIC ? batches_sure * l->rotation_error : l->rotation_error;
}

/* Which of s are averaged, those with the numbers `which`, or the first n where it is NULL; and
   how. points: of orbits nothing else is found. */
typedef struct averages {
  size_t n;
  const size_t *which;
  pendres_lyapunov_care care;
  int points;
  pendres_arrival *s;
  size_t parts; /* each has one of so many pendulums, so that all take about as long */
} averages;

static pendres_arrival *number(const averages *of, size_t k)
{
  return &of->s[of->which != NULL ? of->which[k] : k];
}

static pendres_status average_part(pendres_context *ctx, size_t part, size_t count, void *arg)
{
  const averages *of = arg;
  const size_t n = (of->n - part + of->parts - 1) / of->parts;
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_pendulum *p = pendres_room_take(&room, n, sizeof *p);
  const pendres_lyapunov_motion m = {
    .n = n, .pendulum = p, .x = pendres_room_take(&room, n, sizeof *m.x),
    .v = pendres_room_take(&room, n, sizeof *m.v),
    .out = pendres_room_take(&room, n, sizeof *m.out),
    .orbit = pendres_room_take(&room, n, sizeof *m.orbit), .points = of->points};
  pendres_status status = room.status;
  (void)count;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const pendres_arrival *from = number(of, part + k * of->parts);
    p[k] = from->pendulum;
    m.x[k] = from->x;
    m.v[k] = from->v;
  }
  if (status == PENDRES_OK) status = pendres_lyapunov_move(ctx, &m, of->care);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    pendres_arrival *to = number(of, part + k * of->parts);
    to->x = m.x[k];
    to->v = m.v[k];
    to->certain = m.out[k].certain;
    to->slips = of->care == PENDRES_CARE_CLOSE && m.out[k].label == PENDRES_LABEL_UNRESOLVED &&
                m.out[k].rotation_error < arrival_scatter;
    take_verdict(&m.out[k], &m.orbit[k], to);
  }
  return pendres_room_close(&room, status);
}

static pendres_status settle_by_averages(pendres_context *ctx, averages *of)
{
  if (of->n == 0) return PENDRES_OK;
  const size_t share = pendres_threads_share(ctx, of->n);
  of->parts = (of->n + share - 1) / share;
  return pendres_threads_run(ctx, of->parts, 1, average_part, of);
}

/* The amplitudes of the orbits that some of s have come to, of which the points are known. */
static pendres_status tell_apart(pendres_context *ctx, size_t n, const size_t *which,
                                 pendres_arrival *s)
{
  pendres_orbit orbit[PENDRES_ARRIVALS];
  size_t count = 0;
  for (size_t k = 0; k < n; k++)
    if (pendres_attractor_closes(&s[which[k]].attractor))
      orbit[count++] = s[which[k]].attractor.orbit;
  const pendres_status status = pendres_orbits_span(ctx, count, orbit);
  count = 0;
  for (size_t k = 0; k < n; k++)
    if (pendres_attractor_closes(&s[which[k]].attractor))
      s[which[k]].attractor.orbit = orbit[count++];
  return status;
}

/* Measure the orbit that a pendulum has come to if only its point is known: averages told it. Those
   that were settled on are measured and named. */
static pendres_status measure(pendres_context *ctx, pendres_arrival *s)
{
  pendres_orbit *o = &s->attractor.orbit, found;
  pendres_status outcome = PENDRES_OK;
  if (!pendres_attractor_closes(&s->attractor) || !pendres_lyapunov_may_rotate(&o->pendulum))
    return PENDRES_OK;
  const pendres_orbit_guess guess = {.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                     .period = o->period, .winding = o->winding};
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &found, &outcome);
  if (status != PENDRES_OK || outcome == PENDRES_NOT_CONVERGED || !found.stable) return status;
  s->attractor = pendres_arrival_orbit(&found);
  s->x = found.x;
  s->v = found.v;
  return status;
}

pendres_status pendres_arrivals_turning(pendres_context *ctx, size_t n, pendres_arrival *s)
{
  averages of = {.n = n, .care = PENDRES_CARE_CLOSE, .points = n > 1, .s = s};
  pendres_status status = settle_by_averages(ctx, &of);
  if (status == PENDRES_OK && n > 1) status = measure(ctx, &s[0]);
  return status;
}

/* ---- by trapping --------------------------------------------------------------------------- */

static pendres_status settle_by_trapping(pendres_context *ctx, size_t n, const size_t *which,
                                         pendres_arrival *s)
{
  pendres_pendulum p[PENDRES_ARRIVALS] = {{0}};
  pendres_settled outcome[PENDRES_ARRIVALS];
  double x[PENDRES_ARRIVALS] = {0.0}, v[PENDRES_ARRIVALS] = {0.0};
  pendres_attractors *found = NULL;
  for (size_t k = 0; k < n; k++) {
    p[k] = s[which[k]].pendulum;
    x[k] = s[which[k]].x;
    v[k] = s[which[k]].v;
  }
  const pendres_status status = pendres_settle(ctx, n, p, x, v, outcome, &found);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const size_t number = outcome[k].attractor >= 0 ? (size_t)outcome[k].attractor : (size_t)-1;
    const pendres_attractor *a = pendres_attractors_get(found, number);
    if (a != NULL) s[which[k]].attractor = *a;
    if (a == NULL) s[which[k]].attractor.label = outcome[k].label;
    s[which[k]].certain = outcome[k].certain;
  }
  pendres_attractors_free(found);
  return status;
}

/* ---- by either ----------------------------------------------------------------------------- */

static pendres_status settle_all(pendres_context *ctx, size_t n, pendres_lyapunov_care care,
                                 pendres_arrival *s)
{
  size_t averaged[PENDRES_ARRIVALS], trapped[PENDRES_ARRIVALS], a = 0, t = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++)
    if (pendres_lyapunov_may_rotate(&s[i].pendulum)) averaged[a++] = i;
    else trapped[t++] = i;
  averages of = {.n = a, .which = averaged, .care = care, .points = n > 1, .s = s};
  if (a > 0) status = settle_by_averages(ctx, &of);
  if (a > 0 && n > 1 && status == PENDRES_OK) status = tell_apart(ctx, a, averaged, s);
  if (t > 0 && status == PENDRES_OK) status = settle_by_trapping(ctx, t, trapped, s);
  return status;
}

/* Where labels alone are asked chaos need not be known better than that it lasts. */
pendres_status pendres_arrivals_name(pendres_context *ctx, size_t n, pendres_lyapunov_care care,
                                     pendres_arrival *s)
{
  const double exponent_error = ctx->options.exponent_error;
  ctx->options.exponent_error = 1.0;
  const pendres_status status = settle_all(ctx, n, care, s);
  ctx->options.exponent_error = exponent_error;
  return status;
}

/* Advance a pendulum until it is on its attractor. */
static pendres_status arrive(pendres_context *ctx, pendres_arrival *s)
{
  const pendres_attractor *a = &s->attractor;
  if (pendres_attractor_closes(a) || a->label == PENDRES_LABEL_RUNNING) {
    s->x = a->orbit.x;
    s->v = a->orbit.v;
    return PENDRES_OK;
  }
  if (a->label == PENDRES_LABEL_ESCAPE) return PENDRES_OK; /* there is none */
  if (pendres_lyapunov_may_rotate(&s->pendulum)) return PENDRES_OK; /* its averages were there */
  const pendres_status status =
    pendres_strobe_advance(ctx, 1, &s->pendulum, &s->x, &s->v, ARRIVAL_PERIODS, NULL);
  /* Whole turns are taken off, since chaos that drifts would go far. */
  s->x = fmod(s->x, pendres_model_turn(&s->pendulum));
  return status;
}

pendres_status pendres_arrival_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_lyapunov_care care, pendres_arrival *out)
{
  *out = pendres_arrival_at(p, x, v);
  const pendres_status status = settle_all(ctx, 1, care, out);
  return status == PENDRES_OK ? arrive(ctx, out) : status;
}

pendres_status pendres_arrival_name(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_arrival *out)
{
  *out = pendres_arrival_at(p, x, v);
  const pendres_status status = pendres_arrivals_name(ctx, 1, PENDRES_CARE_LABEL, out);
  return status == PENDRES_OK ? arrive(ctx, out) : status;
}

pendres_status pendres_arrival_end(pendres_context *ctx, pendres_arrival *s)
{
  const pendres_status status = measure(ctx, s);
  return status == PENDRES_OK ? arrive(ctx, s) : status;
}
