/* hysteresis_jump.c -- where a pendulum goes when its state ends; see hysteresis_jump.h. */
#include "analysis/sweeps/hysteresis_jump.h"

#include <math.h>
#include <stdlib.h>

#include <pendres/strobe.h>

#include "analysis/sweeps/numbers.h"
#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "engine/threads.h"
#include "model/model.h"
#include "orbits/orbit_table.h"
#include "orbits/orbit_span.h"
#include "analysis/sweeps/rotation_table.h"

enum {
  TRIALS = PENDRES_HYSTERESIS_TRIALS
};

/* Student's t for sixteen batches, at 99.9 %. */
static const double batches_sure = 4.073;

int pendres_settled_closed(const pendres_attractor *a)
{
  return a->label != PENDRES_LABEL_CHAOTIC && a->label != PENDRES_LABEL_UNRESOLVED &&
         a->label != PENDRES_LABEL_ESCAPE && a->label != PENDRES_LABEL_QUASI_PERIODIC &&
         a->label != PENDRES_LABEL_UNSTABLE && a->orbit.period > 0;
}

int pendres_settled_alike(const pendres_attractor *a, const pendres_attractor *b)
{
  if (!pendres_settled_closed(a) || !pendres_settled_closed(b)) return a->label == b->label;
  return a->orbit.period == b->orbit.period &&
         abs(a->orbit.winding) == abs(b->orbit.winding) &&
         fabs(a->orbit.amplitude - b->orbit.amplitude) < orbit_another;
}

pendres_attractor pendres_settled_nothing(const pendres_pendulum *p)
{
  pendres_attractor a = {.label = PENDRES_LABEL_UNRESOLVED};
  a.orbit = pendres_orbit_none(p);
  a.trap_metric[0] = a.trap_metric[1] = a.trap_metric[2] = a.trap_radius = NAN;
  a.lyapunov = a.lyapunov_error = a.drift = a.drift_error = NAN;
  a.watched_periods = a.escape_rate_bound = NAN;
  return a;
}

pendres_settled pendres_settled_nothing_at(const pendres_pendulum *p, double x, double v)
{
  return (pendres_settled){
    .pendulum = *p, .attractor = pendres_settled_nothing(p), .x = x, .v = v};
}

pendres_attractor pendres_settled_orbit(const pendres_orbit *o)
{
  pendres_attractor a = pendres_settled_nothing(&o->pendulum);
  const double modulus = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  const double time = two_pi * o->period / o->pendulum.drive_frequency;
  a.orbit = *o;
  a.label = o->winding != 0 ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_PERIODIC;
  a.lyapunov = log(modulus) / time;
  a.lyapunov_error = o->multiplier_error / (modulus * time);
  return a;
}

void pendres_settled_rotate(const pendres_pendulum *p, const pendres_rotation *r,
                            pendres_settled *out)
{
  *out = pendres_settled_nothing_at(p, half_pi, r->v);
  out->certain = 1;
  out->attractor.label = PENDRES_LABEL_RUNNING;
  out->attractor.lyapunov = out->attractor.lyapunov_error = 0.0;
  out->attractor.drift = r->mean_velocity / p->drive_frequency;
  out->attractor.drift_error = r->mean_velocity_error / p->drive_frequency;
}

/* The attractor of a pendulum whose averages are known. */
static void take_verdict(const pendres_lyapunov *l, const pendres_orbit *orbit, pendres_settled *s)
{
  if (orbit->period > 0) {
    s->attractor = pendres_settled_orbit(orbit);
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

/* Pendulums that are averaged side by side. */
typedef struct averaged {
  pendres_pendulum *pendulum;
  double *x, *v;
  pendres_lyapunov *told;
  pendres_orbit *orbit;
} averaged;

static void free_averaged(averaged *a)
{
  free(a->pendulum);
  free(a->x);
  free(a->told);
  free(a->orbit);
}

static pendres_status make_averaged(pendres_context *ctx, size_t n, averaged *a)
{
  *a = (averaged){.pendulum = malloc((n + 1) * sizeof *a->pendulum),
                  .x = malloc((2 * n + 1) * sizeof *a->x),
                  .told = malloc((n + 1) * sizeof *a->told),
                  .orbit = malloc((n + 1) * sizeof *a->orbit)};
  if (a->pendulum == NULL || a->x == NULL || a->told == NULL || a->orbit == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  a->v = a->x + n;
  return PENDRES_OK;
}

/* Which of s are averaged, those with the numbers `which`, or the first n where it is NULL; and
   how. points: of orbits nothing else is found. */
typedef struct averages {
  size_t n;
  const size_t *which;
  pendres_lyapunov_care care;
  int points;
  pendres_settled *s;
  size_t parts; /* each has one of so many pendulums, so that all take about as long */
} averages;

static pendres_settled *number(const averages *of, size_t k)
{
  return &of->s[of->which != NULL ? of->which[k] : k];
}

static pendres_status average_part(pendres_context *ctx, size_t part, size_t count, void *arg)
{
  const averages *of = arg;
  const size_t n = (of->n - part + of->parts - 1) / of->parts;
  averaged a;
  (void)count;
  pendres_status status = make_averaged(ctx, n, &a);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const pendres_settled *from = number(of, part + k * of->parts);
    a.pendulum[k] = from->pendulum;
    a.x[k] = from->x;
    a.v[k] = from->v;
  }
  const pendres_lyapunov_motion motion = {.n = n, .pendulum = a.pendulum, .x = a.x, .v = a.v,
                                          .out = a.told, .orbit = a.orbit,
                                          .points = of->points};
  if (status == PENDRES_OK) status = pendres_lyapunov_move(ctx, &motion, of->care);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    pendres_settled *to = number(of, part + k * of->parts);
    to->x = a.x[k];
    to->v = a.v[k];
    to->certain = a.told[k].certain;
    to->slips = of->care == PENDRES_CARE_CLOSE && a.told[k].label == PENDRES_LABEL_UNRESOLVED &&
                a.told[k].rotation_error < jump_scatter;
    take_verdict(&a.told[k], &a.orbit[k], to);
  }
  free_averaged(&a);
  return status;
}

static pendres_status settle_by_averages(pendres_context *ctx, averages *of)
{
  if (of->n == 0) return PENDRES_OK;
  const size_t share = pendres_threads_share(ctx, of->n);
  of->parts = (of->n + share - 1) / share;
  return pendres_threads_run(ctx, of->parts, 1, average_part, of);
}

static pendres_status settle_by_trapping(pendres_context *ctx, size_t n, const size_t *which,
                                         pendres_settled *s)
{
  pendres_pendulum p[TRIALS] = {{0}};
  pendres_outcome outcome[TRIALS];
  double x[TRIALS] = {0.0}, v[TRIALS] = {0.0};
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

/* The amplitudes of the orbits that some of s have come to, of which the points are known. */
static pendres_status tell_apart(pendres_context *ctx, size_t n, const size_t *which,
                                 pendres_settled *s)
{
  pendres_orbit orbit[TRIALS];
  size_t count = 0;
  for (size_t k = 0; k < n; k++)
    if (pendres_settled_closed(&s[which[k]].attractor))
      orbit[count++] = s[which[k]].attractor.orbit;
  const pendres_status status = pendres_orbits_span(ctx, count, orbit);
  count = 0;
  for (size_t k = 0; k < n; k++)
    if (pendres_settled_closed(&s[which[k]].attractor))
      s[which[k]].attractor.orbit = orbit[count++];
  return status;
}

/* Measure the orbit that a pendulum has come to if only its point is known: averages told it. Those
   that were settled on are measured and named. */
static pendres_status measure(pendres_context *ctx, pendres_settled *s)
{
  pendres_orbit *o = &s->attractor.orbit, found;
  pendres_status outcome = PENDRES_OK;
  if (!pendres_settled_closed(&s->attractor) || !pendres_lyapunov_may_rotate(&o->pendulum))
    return PENDRES_OK;
  const pendres_orbit_guess guess = {.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                     .period = o->period, .winding = o->winding};
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &found, &outcome);
  if (status != PENDRES_OK || outcome == PENDRES_NOT_CONVERGED || !found.stable) return status;
  s->attractor = pendres_settled_orbit(&found);
  s->x = found.x;
  s->v = found.v;
  return status;
}

/* Settle n pendulums, at most TRIALS, from their states. Where they are several of which some may
   be told by averages, of the orbits that these come to points and rough amplitudes are known. */
static pendres_status settle_all(pendres_context *ctx, size_t n, pendres_lyapunov_care care,
                                 pendres_settled *s)
{
  size_t averaged[TRIALS], trapped[TRIALS], a = 0, t = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    pendres_rotation r;
    int rotates = 0;
    if (pendres_lyapunov_may_rotate(&s[i].pendulum)) {
      averaged[a++] = i;
      continue;
    }
    status = pendres_rotation_reached(ctx, &s[i].pendulum, s[i].x, s[i].v, &r, &rotates);
    if (rotates) pendres_settled_rotate(&s[i].pendulum, &r, &s[i]);
    else trapped[t++] = i;
  }
  averages of = {.n = a, .which = averaged, .care = care, .points = n > 1, .s = s};
  if (a > 0 && status == PENDRES_OK) status = settle_by_averages(ctx, &of);
  if (a > 0 && n > 1 && status == PENDRES_OK) status = tell_apart(ctx, a, averaged, s);
  if (t > 0 && status == PENDRES_OK) status = settle_by_trapping(ctx, t, trapped, s);
  return status;
}

/* The same of trials, of which labels alone are asked: chaos need not be known better than that it
   lasts. */
static pendres_status settle_trials(pendres_context *ctx, size_t n, pendres_lyapunov_care care,
                                    pendres_settled *s)
{
  const double exponent_error = ctx->options.exponent_error;
  ctx->options.exponent_error = 1.0;
  const pendres_status status = settle_all(ctx, n, care, s);
  ctx->options.exponent_error = exponent_error;
  return status;
}

pendres_status pendres_settled_rotations(pendres_context *ctx, size_t n, pendres_settled *s)
{
  averages of = {.n = n, .care = PENDRES_CARE_CLOSE, .points = n > 1, .s = s};
  pendres_status status = settle_by_averages(ctx, &of);
  if (status == PENDRES_OK && n > 1) status = measure(ctx, &s[0]);
  return status;
}

/* Advance a pendulum until it is on its attractor. */
static pendres_status arrive(pendres_context *ctx, pendres_settled *s)
{
  if (pendres_settled_closed(&s->attractor)) {
    s->x = s->attractor.orbit.x;
    s->v = s->attractor.orbit.v;
    return PENDRES_OK;
  }
  if (s->attractor.label == PENDRES_LABEL_ESCAPE) return PENDRES_OK; /* there is none */
  if (s->attractor.label == PENDRES_LABEL_RUNNING) return PENDRES_OK; /* it is there */
  if (pendres_lyapunov_may_rotate(&s->pendulum)) return PENDRES_OK; /* its averages were there */
  const pendres_status status =
    pendres_strobe_advance(ctx, 1, &s->pendulum, &s->x, &s->v, JUMP_ON_THE_WAY, NULL);
  /* Whole turns are taken off, since chaos that drifts would go far. */
  s->x = fmod(s->x, pendres_model_turn(&s->pendulum));
  return status;
}

pendres_status pendres_settled_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_lyapunov_care care, pendres_settled *out)
{
  *out = pendres_settled_nothing_at(p, x, v);
  const pendres_status status = settle_all(ctx, 1, care, out);
  return status == PENDRES_OK ? arrive(ctx, out) : status;
}

pendres_status pendres_settled_name(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_settled *out)
{
  *out = pendres_settled_nothing_at(p, x, v);
  const pendres_status status = settle_trials(ctx, 1, PENDRES_CARE_LABEL, out);
  return status == PENDRES_OK ? arrive(ctx, out) : status;
}

/* The pendulum at a distance beyond the end of its state. */
static pendres_pendulum beyond_by(const pendres_bifurcation *at, double distance)
{
  return pendres_parameter_with(&at->orbit.pendulum, at->parameter,
                                pendres_parameter_beyond(at->parameter, at->value, distance));
}

/* The trials of a jump, each at its distance beyond the end of the state. */
static void begin(const pendres_bifurcation *at, int direction, double distance[TRIALS],
                  pendres_settled went[TRIALS])
{
  const double scale = pendres_parameter_scale_at(at->parameter, at->value);
  for (int i = 0; i < TRIALS; i++) {
    const double part = (double)(i / 2) / (TRIALS / 2), angle = golden_angle * i;
    const double beyond = i % 2 == 0 ? just_beyond : just_beyond / jump_further;
    distance[i] = scale * beyond * (1.0 + 0.5 * part);
    const pendres_pendulum p = beyond_by(at, direction * distance[i]);
    const double off = at->kind == PENDRES_FOLD ? 0.0 : jump_away * (1.0 + 0.5 * part);
    went[i] = pendres_settled_nothing_at(&p, at->orbit.x + off * cos(angle),
                                         at->orbit.v + off * sin(angle));
  }
}

/*
 * Near the end of a lock a rotation slips only once in many periods, too rarely for averages, and
 * next to a fold some stay for longer than a pendulum is settled. They are repeated further beyond
 * the end, ten times as far in each round.
 */
static pendres_status go_on(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                            double distance[TRIALS], pendres_settled went[TRIALS])
{
  pendres_settled some[TRIALS];
  int which[TRIALS];
  pendres_status status = PENDRES_OK;
  for (int round = 0; round < JUMP_ROUNDS && status == PENDRES_OK; round++) {
    size_t n = 0;
    for (int i = 0; i < TRIALS; i++) {
      pendres_settled *s = &went[i];
      if (s->attractor.label != PENDRES_LABEL_UNRESOLVED) continue;
      distance[i] *= jump_further;
      s->pendulum = beyond_by(at, direction * distance[i]);
      some[n] = pendres_settled_nothing_at(&s->pendulum, s->x, s->v);
      which[n++] = i;
    }
    if (n == 0) break;
    const int last = round + 1 == JUMP_ROUNDS;
    status = settle_trials(ctx, n, last ? PENDRES_CARE_LABEL : PENDRES_CARE_ONCE, some);
    for (size_t k = 0; k < n; k++) went[which[k]] = some[k];
  }
  return status;
}

/* Trials stand for what an experiment does not control, errors of the integration included: how
   many of them agree tells how certain the jump is, whether each by itself is or not. */
static pendres_status count(pendres_context *ctx, const pendres_settled went[TRIALS],
                            pendres_settled *to, pendres_jump *jump)
{
  int best = 0, most = 0;
  for (int i = 0; i < TRIALS; i++) {
    int alike = 0;
    for (int k = 0; k < TRIALS; k++)
      alike += pendres_settled_alike(&went[i].attractor, &went[k].attractor);
    if (alike <= most) continue;
    most = alike;
    best = i;
  }
  *to = went[best];
  const pendres_status status = measure(ctx, to);
  if (status != PENDRES_OK) return status;
  jump->to = to->attractor.label;
  jump->to_period = pendres_settled_closed(&to->attractor) ? to->attractor.orbit.period : 0;
  jump->share = (double)most / TRIALS;
  jump->certain = most == TRIALS && to->attractor.label != PENDRES_LABEL_UNRESOLVED;
  return arrive(ctx, to);
}

pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_settled *to, pendres_jump *jump)
{
  pendres_settled went[TRIALS];
  double distance[TRIALS];
  begin(at, direction, distance, went);
  pendres_status status = settle_trials(ctx, TRIALS, PENDRES_CARE_ONCE, went);
  if (status == PENDRES_OK) status = go_on(ctx, at, direction, distance, went);
  return status == PENDRES_OK ? count(ctx, went, to, jump) : status;
}

pendres_status pendres_jump_try_from(pendres_context *ctx, const pendres_pendulum *p,
                                     const double *x, const double *v, pendres_settled *to,
                                     pendres_jump *jump)
{
  pendres_settled went[TRIALS];
  for (int i = 0; i < TRIALS; i++) went[i] = pendres_settled_nothing_at(p, x[i], v[i]);
  const int rotates = jump->from == PENDRES_LABEL_QUASI_PERIODIC;
  const pendres_status status =
    settle_trials(ctx, TRIALS, rotates ? PENDRES_CARE_CLOSE : PENDRES_CARE_LABEL, went);
  return status == PENDRES_OK ? count(ctx, went, to, jump) : status;
}
