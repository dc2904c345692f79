/* hysteresis_jump.c -- where a pendulum goes when its state ends; see hysteresis_jump.h. */
#include "questions/hysteresis_jump.h"

#include <math.h>
#include <stdlib.h>

#include <pendres/strobe.h>

#include "continuation/continuation_parameter.h"
#include "engine/context_internal.h"
#include "model/model.h"
#include "orbits/catalogue.h"

enum {
  TRIALS = PENDRES_HYSTERESIS_TRIALS,
  ON_THE_WAY = 500 /* periods after which what does not close is taken to be on its attractor */
};

/* How far beyond a bifurcation trials are, by the parameter's scale: half of them, and the others.
   Within each half the last one is half as far again as the first: so the times that they take to
   pass the fold, as the root of one over the distance, differ by a fifth, which is many periods. */
static const double beyond[2] = {1e-4, 1e-5};
/* An orbit that has become unstable is left this far away, where its own growth is not slow. */
static const double away = 0.03;
/* Amplitudes of one state at parameters so close differ by less. */
static const double same_amplitude = 0.02;

int pendres_settled_closed(const pendres_attractor *a)
{
  return a->label != PENDRES_LABEL_CHAOTIC && a->label != PENDRES_LABEL_UNRESOLVED;
}

int pendres_settled_alike(const pendres_attractor *a, const pendres_attractor *b)
{
  if (!pendres_settled_closed(a) || !pendres_settled_closed(b)) return a->label == b->label;
  return a->orbit.period == b->orbit.period &&
         abs(a->orbit.winding) == abs(b->orbit.winding) &&
         fabs(a->orbit.amplitude - b->orbit.amplitude) < same_amplitude;
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

static pendres_status settle_all(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                 const double *x, const double *v, pendres_settled *out)
{
  pendres_outcome outcome[TRIALS];
  pendres_attractors *found = NULL;
  const pendres_status status = pendres_settle(ctx, n, p, x, v, outcome, &found);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const size_t which = outcome[i].attractor >= 0 ? (size_t)outcome[i].attractor : (size_t)-1;
    const pendres_attractor *a = pendres_attractors_get(found, which);
    out[i] = (pendres_settled){.pendulum = p[i], .x = x[i], .v = v[i]};
    out[i].attractor = a != NULL ? *a : pendres_settled_nothing(&p[i]);
  }
  pendres_attractors_free(found);
  return status;
}

/* Onto the attractor. */
static pendres_status arrive(pendres_context *ctx, pendres_settled *s)
{
  if (pendres_settled_closed(&s->attractor)) {
    s->x = s->attractor.orbit.x;
    s->v = s->attractor.orbit.v;
    return PENDRES_OK;
  }
  const pendres_status status =
    pendres_strobe_advance(ctx, 1, &s->pendulum, &s->x, &s->v, ON_THE_WAY, NULL);
  /* Whole turns are of no consequence, and chaos that drifts would go far. */
  s->x = fmod(s->x, pendres_model_turn(&s->pendulum));
  return status;
}

pendres_status pendres_settled_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_settled *out)
{
  const pendres_status status = settle_all(ctx, 1, p, &x, &v, out);
  return status == PENDRES_OK ? arrive(ctx, out) : status;
}

pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_settled *to, pendres_jump *jump)
{
  pendres_pendulum p[TRIALS];
  pendres_settled went[TRIALS];
  double x[TRIALS], v[TRIALS];
  const double scale = pendres_parameter_scale(at->parameter);
  for (int i = 0; i < TRIALS; i++) {
    const double part = (double)(i / 2) / (TRIALS / 2), angle = 2.39996322972865332 * i;
    p[i] = at->orbit.pendulum;
    const double distance = scale * beyond[i % 2] * (1.0 + 0.5 * part);
    pendres_parameter_set(at->parameter, at->value + direction * distance, &p[i]);
    const double off = at->kind == PENDRES_FOLD ? 0.0 : away * (1.0 + 0.5 * part);
    x[i] = at->orbit.x + off * cos(angle);
    v[i] = at->orbit.v + off * sin(angle);
  }
  const pendres_status status = settle_all(ctx, TRIALS, p, x, v, went);
  if (status != PENDRES_OK) return status;

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
  jump->to = to->attractor.label;
  jump->to_period = pendres_settled_closed(&to->attractor) ? to->attractor.orbit.period : 0;
  jump->share = (double)most / TRIALS;
  jump->certain = most == TRIALS && to->attractor.label != PENDRES_LABEL_UNRESOLVED;
  return arrive(ctx, to);
}
