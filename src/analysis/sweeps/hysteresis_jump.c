/* hysteresis_jump.c -- where a pendulum goes when its state ends; see hysteresis_jump.h. */
#include "analysis/sweeps/hysteresis_jump.h"

#include <math.h>

#include "analysis/sweeps/numbers.h"
#include "base/angles.h"
#include "continuation/parameter.h"

enum {
  TRIALS = PENDRES_HYSTERESIS_TRIALS
};
_Static_assert((int)TRIALS <= (int)PENDRES_ARRIVALS, "the trials of a jump are looked for at once");

/* The pendulum at a distance beyond the end of its state. */
static pendres_pendulum beyond_by(const pendres_bifurcation *at, double distance)
{
  return pendres_parameter_with(&at->orbit.pendulum, at->parameter,
                                pendres_parameter_beyond(at->parameter, at->value, distance));
}

/* The trials of a jump, each at its distance beyond the end of the state. */
static void begin(const pendres_bifurcation *at, int direction, double distance[TRIALS],
                  pendres_arrival went[TRIALS])
{
  const double scale = pendres_parameter_scale_at(at->parameter, at->value);
  for (int i = 0; i < TRIALS; i++) {
    const double part = (double)(i / 2) / (TRIALS / 2), angle = golden_angle * i;
    const double beyond = i % 2 == 0 ? just_beyond : just_beyond / jump_further;
    distance[i] = scale * beyond * (1.0 + 0.5 * part);
    const pendres_pendulum p = beyond_by(at, direction * distance[i]);
    const double off = at->kind == PENDRES_FOLD ? 0.0 : jump_away * (1.0 + 0.5 * part);
    went[i] = pendres_arrival_at(&p, at->orbit.x + off * cos(angle),
                                 at->orbit.v + off * sin(angle));
  }
}

/*
 * Near the end of a lock a rotation slips only once in many periods, too rarely for averages, and
 * next to a fold some stay for longer than a pendulum is settled. They are repeated further beyond
 * the end, ten times as far in each round.
 */
static pendres_status go_on(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                            double distance[TRIALS], pendres_arrival went[TRIALS])
{
  pendres_arrival some[TRIALS];
  int which[TRIALS];
  pendres_status status = PENDRES_OK;
  for (int round = 0; round < JUMP_ROUNDS && status == PENDRES_OK; round++) {
    size_t n = 0;
    for (int i = 0; i < TRIALS; i++) {
      pendres_arrival *s = &went[i];
      if (s->attractor.label != PENDRES_LABEL_UNRESOLVED) continue;
      distance[i] *= jump_further;
      s->pendulum = beyond_by(at, direction * distance[i]);
      some[n] = pendres_arrival_at(&s->pendulum, s->x, s->v);
      which[n++] = i;
    }
    if (n == 0) break;
    const int last = round + 1 == JUMP_ROUNDS;
    status = pendres_arrivals_name(ctx, n, last ? PENDRES_CARE_LABEL : PENDRES_CARE_ONCE, some);
    for (size_t k = 0; k < n; k++) went[which[k]] = some[k];
  }
  return status;
}

/* Trials stand for what an experiment does not control, errors of the integration included: how
   many of them agree tells how certain the jump is, whether each by itself is or not. */
static pendres_status count(pendres_context *ctx, const pendres_arrival went[TRIALS],
                            pendres_arrival *to, pendres_jump *jump)
{
  int best = 0, most = 0;
  for (int i = 0; i < TRIALS; i++) {
    int alike = 0;
    for (int k = 0; k < TRIALS; k++)
      alike += pendres_arrival_alike(&went[i].attractor, &went[k].attractor);
    if (alike <= most) continue;
    most = alike;
    best = i;
  }
  *to = went[best];
  const pendres_status status = pendres_arrival_end(ctx, to);
  if (status != PENDRES_OK) return status;
  jump->to = to->attractor.label;
  jump->to_period = pendres_attractor_closes(&to->attractor) ? to->attractor.orbit.period : 0;
  jump->share = (double)most / TRIALS;
  jump->certain = most == TRIALS && to->attractor.label != PENDRES_LABEL_UNRESOLVED;
  return PENDRES_OK;
}

pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_arrival *to, pendres_jump *jump)
{
  pendres_arrival went[TRIALS];
  double distance[TRIALS];
  begin(at, direction, distance, went);
  pendres_status status = pendres_arrivals_name(ctx, TRIALS, PENDRES_CARE_ONCE, went);
  if (status == PENDRES_OK) status = go_on(ctx, at, direction, distance, went);
  return status == PENDRES_OK ? count(ctx, went, to, jump) : status;
}

pendres_status pendres_jump_try_from(pendres_context *ctx, const pendres_pendulum *p,
                                     const double *x, const double *v, pendres_arrival *to,
                                     pendres_jump *jump)
{
  pendres_arrival went[TRIALS];
  for (int i = 0; i < TRIALS; i++) went[i] = pendres_arrival_at(p, x[i], v[i]);
  const int rotates = jump->from == PENDRES_LABEL_QUASI_PERIODIC;
  const pendres_status status =
    pendres_arrivals_name(ctx, TRIALS, rotates ? PENDRES_CARE_CLOSE : PENDRES_CARE_LABEL, went);
  return status == PENDRES_OK ? count(ctx, went, to, jump) : status;
}
