/* hysteresis_chaos.c -- from chaos to something else; see hysteresis_chaos.h. */
#include "analysis/sweeps/hysteresis_chaos.h"

#include <math.h>

#include <pendres/strobe.h>

#include "continuation/parameter.h"
#include "analysis/sweeps/cascade.h"
#include "analysis/sweeps/numbers.h"
#include "analysis/sweeps/stable_part.h"

int pendres_chaos_ends(const pendres_attractor *old, const pendres_attractor *there)
{
  if (there->label == PENDRES_LABEL_ESCAPE) return 1;
  if (pendres_attractor_closes(there)) return !pendres_arrival_alike(there, old);
  return pendres_attractor_closes(old) && old->orbit.period <= PENDRES_HYSTERESIS_PERIOD &&
         there->label != PENDRES_LABEL_UNRESOLVED;
}

/* A search for the end of a state between two values of a parameter. */
typedef struct search {
  pendres_context *ctx;
  pendres_parameter parameter;
  const pendres_arrival *old;
  double from;            /* the last value at which the state is known to last, ... */
  pendres_arrival before; /* ... and the state there */
  pendres_arrival *state; /* the first one known to be another, at a value beyond the end */
} search;

static pendres_pendulum pendulum_at(const search *s, double value)
{
  return pendres_parameter_with(&s->state->pendulum, s->parameter, value);
}

static double value_of(const search *s)
{
  return pendres_parameter_get(s->parameter, &s->state->pendulum);
}

static pendres_jump_kind kind_of(pendres_special kind)
{
  switch (kind) {
  case PENDRES_FOLD: return PENDRES_JUMP_FOLD;
  case PENDRES_PERIOD_DOUBLING: return PENDRES_JUMP_FLIP;
  case PENDRES_SYMMETRY_BREAKING: return PENDRES_JUMP_SYMMETRY;
  case PENDRES_BRANCH_POINT: return PENDRES_JUMP_BRANCH_POINT;
  default: return PENDRES_JUMP_OTHER;
  }
}

pendres_status pendres_chaos_spread(pendres_context *ctx, const pendres_arrival *from, int n,
                                    double *x, double *v)
{
  double xs[LIVES * LIVES_APART + 1], vs[LIVES * LIVES_APART + 1];
  const pendres_status status =
    pendres_strobe_record(ctx, &from->pendulum, &(pendres_state){from->x, from->v},
                          (long)n * LIVES_APART, 1, &(pendres_record){.x = xs, .v = vs});
  for (int i = 0; i < n && status == PENDRES_OK; i++) {
    x[i] = xs[i * LIVES_APART];
    v[i] = vs[i * LIVES_APART];
  }
  return status;
}

/* Where a state may end in another that is born there. */
typedef struct place {
  pendres_jump_kind kind;
  double value, error;
  double before, behind; /* just before it, and where the orbit is just behind it, ... */
  int period;            /* ... with its period */
  int earlier;           /* the orbit that the pendulum was seen on has bifurcated since */
  pendres_orbit late;    /* of an accumulation: one after many doublings; else of no period */
} place;

/* A pendulum on an orbit. */
static pendres_arrival settled_on(const pendres_orbit *o)
{
  return (pendres_arrival){.pendulum = o->pendulum, .attractor = pendres_arrival_orbit(o),
                           .x = o->x, .v = o->v};
}

/* Whether the old state is a rotation that is not locked to the drive. */
static int rotates(const search *w)
{
  return w->old->attractor.label == PENDRES_LABEL_QUASI_PERIODIC;
}

/* Whether the pendulum stays in the old state just before an orbit's birth, and most trials from
   there go to that orbit just behind it. Sets the jump, and w->state, if it is born there. */
static pendres_status try_beside(search *w, const place *at, pendres_jump *jump, int *born)
{
  const pendres_pendulum p = pendulum_at(w, at->before), q = pendulum_at(w, at->behind);
  pendres_arrival before = *w->old, behind;
  pendres_jump there = {.from = w->old->attractor.label, .share = NAN};
  double x[PENDRES_HYSTERESIS_TRIALS], v[PENDRES_HYSTERESIS_TRIALS];
  pendres_status status = PENDRES_OK;
  /* A rotation lasts up to a lock that is born on it. */
  if (!rotates(w))
    status = pendres_arrival_name(w->ctx, &p, w->old->x, w->old->v, &before);
  *born = 0;
  if (status != PENDRES_OK || pendres_attractor_closes(&before.attractor) ||
      before.attractor.label == PENDRES_LABEL_ESCAPE)
    return status;
  status = pendres_chaos_spread(w->ctx, &before, PENDRES_HYSTERESIS_TRIALS, x, v);
  if (status == PENDRES_OK) status = pendres_jump_try_from(w->ctx, &q, x, v, &behind, &there);
  if (status != PENDRES_OK) return status;
  *born = pendres_attractor_closes(&behind.attractor) &&
          behind.attractor.orbit.period == at->period;
  if (!*born) return status;
  jump->kind = at->kind;
  jump->value = at->value;
  jump->value_error = at->error;
  jump->share = there.share;
  jump->certain = there.certain;
  if (at->earlier) *w->state = at->late.period > 0 ? settled_on(&at->late) : behind;
  return status;
}

/* The distance at which a value between those of the search is looked at from both sides; 0: it is
   not between them. */
static double room(const search *w, double value)
{
  const double near = rotates(w) ? ends_beside_lock : just_beyond;
  const double to = value_of(w), small = near * pendres_parameter_scale(w->parameter);
  if (!((value - w->from) * (to - value) > 0.0)) return 0.0;
  return fmin(small, 0.5 * fmin(fabs(value - w->from), fabs(to - value)));
}

/*
 * Chaos may end where doublings accumulate, which the pendulum then goes through backwards. Beyond
 * their limit it comes to orbits of ever shorter periods; the first that sweeps follow is taken.
 * Trials tell whether it comes there, on an orbit on which they settle soon.
 */
static pendres_status accumulation(const search *w, const pendres_orbit *orbit, place *out,
                                   int *found)
{
  const pendres_cascade_way way = {orbit, w->parameter, w->from, PENDRES_HYSTERESIS_PERIOD};
  pendres_cascade c;
  pendres_orbit last;
  int k = 0;
  const pendres_status status = pendres_cascade_follow(w->ctx, &way, &c, &last);
  *found = status == PENDRES_OK && last.period > 0 && room(w, c.limit) > c.limit_error;
  if (!*found) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  while (k + 2 < c.doublings && 4 * c.period[k] <= ENDS_SHORT) k++;
  *out = (place){.kind = PENDRES_JUMP_FLIP, .value = c.limit, .error = c.limit_error,
                 .before = c.limit - (value_of(w) > w->from ? 1 : -1) * room(w, c.limit),
                 .behind = 0.5 * (c.value[k] + c.value[k + 1]), .period = 2 * c.period[k],
                 .earlier = 1, .late = last};
  return status;
}

/* Where an orbit begins that was born between the values, by a fold or as one of a cascade. */
static pendres_status beginning(const search *w, const pendres_part *s, int earlier, place *out,
                                int *found)
{
  const pendres_special kind = s->bifurcation.kind;
  const double off = (value_of(w) > w->from ? 1 : -1) * room(w, s->end_value);
  *found = 0;
  if (s->end != PENDRES_PART_BIFURCATION) return PENDRES_OK;
  if (kind == PENDRES_PERIOD_DOUBLING || kind == PENDRES_SYMMETRY_BREAKING)
    return accumulation(w, &pendres_part_last(s)->orbit, out, found);
  *found = off != 0.0;
  *out = (place){.kind = kind_of(kind), .value = s->end_value, .error = s->end_error,
                 .before = s->end_value - off, .behind = s->end_value + off,
                 .period = pendres_part_last(s)->orbit.period, .earlier = earlier};
  return PENDRES_OK;
}

/* What there is to know of an orbit between two values: nothing, that it is born there and ends the
   old state, or that it is there at both. */
typedef enum birth { BIRTH_NONE, BIRTH_FOUND, BIRTH_EARLIER } birth;

/* The part of the orbit that the pendulum has gone to, back to the old state; where that was
   born of another by doubling or a loss of symmetry, of the other, and so on. */
static pendres_status go_back(const search *w, pendres_part *s, int *births)
{
  *births = 0;
  pendres_status status =
    pendres_part_from(w->ctx, &w->state->attractor.orbit, w->parameter, w->from, s);
  while (status == PENDRES_OK && s->end == PENDRES_PART_BIRTH && *births < ENDS_BIRTHS) {
    const pendres_orbit parent = s->bifurcation.orbit;
    ++*births;
    pendres_part_free(s);
    status = pendres_part_from(w->ctx, &parent, w->parameter, w->from, s);
  }
  return status;
}

/*
 * Whether the orbit that the pendulum has gone to, or one that it is born from, is born between the
 * values, and the pendulum goes to that there.
 */
static pendres_status try_birth(search *w, pendres_jump *jump, birth *found)
{
  pendres_part s = pendres_part_none;
  place at;
  int there = 0, births = 0, born = 0;
  *found = BIRTH_NONE;
  if (!pendres_attractor_closes(&w->state->attractor) ||
      w->state->attractor.orbit.period > PENDRES_HYSTERESIS_PERIOD)
    return PENDRES_OK;
  pendres_status status = go_back(w, &s, &births);
  if (status == PENDRES_OK && s.end == PENDRES_PART_LIMIT) *found = BIRTH_EARLIER;
  if (status == PENDRES_OK) status = beginning(w, &s, births > 0, &at, &there);
  pendres_part_free(&s);
  if (status == PENDRES_OK && there) status = try_beside(w, &at, jump, &born);
  if (status == PENDRES_OK && born) *found = BIRTH_FOUND;
  return status;
}

/* Halve the interval from the last value known to be before the end to the first known to be after
   it. Where a pendulum has neither left nor is known to stay, the end is on either side. */
static pendres_status halve(search *w, pendres_jump *jump)
{
  double from = w->from, to = value_of(w);
  pendres_arrival last = w->before;
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < ENDS_HALVINGS && status == PENDRES_OK; k++) {
    const double middle = 0.5 * (from + to);
    const pendres_pendulum p = pendulum_at(w, middle);
    pendres_arrival there;
    status = pendres_arrival_name(w->ctx, &p, last.x, last.v, &there);
    if (status != PENDRES_OK) break;
    if (pendres_chaos_ends(&w->old->attractor, &there.attractor)) {
      to = middle;
      *w->state = there;
      continue;
    }
    from = middle;
    last = there;
    if (there.attractor.label == PENDRES_LABEL_UNRESOLVED) continue;
    w->from = middle;
    w->before = there;
  }
  jump->value = 0.5 * (w->from + to);
  jump->value_error = 0.5 * fabs(to - w->from);
  return status;
}

/* The mean numbers of periods that pendulums from starts on a chaotic attractor take to leave it at
   two values at which it has ended, side by side; infinite where some do not within their
   budget. */
static pendres_status mean_lives(const search *w, const double value[2], const double *x,
                                 const double *v, double life[2])
{
  pendres_pendulum p[2 * LIVES];
  pendres_settled outcome[2 * LIVES];
  double from_x[2 * LIVES], from_v[2 * LIVES];
  for (int i = 0; i < 2 * LIVES; i++) {
    p[i] = pendulum_at(w, value[i / LIVES]);
    from_x[i] = x[i % LIVES];
    from_v[i] = v[i % LIVES];
  }
  const pendres_status status =
    pendres_settle(w->ctx, 2 * LIVES, p, from_x, from_v, outcome, NULL);
  life[0] = life[1] = 0.0;
  for (int i = 0; i < 2 * LIVES && status == PENDRES_OK; i++)
    life[i / LIVES] +=
      outcome[i].settling_periods > 0 && outcome[i].label != PENDRES_LABEL_CHAOTIC
        ? (double)outcome[i].settling_periods / LIVES
        : INFINITY;
  return status;
}

/*
 * Chaos that ends in a crisis lasts the longer the closer to that, so that it seems to last a
 * little beyond. How far beyond follows from lives at two distances, as a power law tells, and for
 * how long the chaos was watched that was thought to last. It is added to the error; where that is
 * not known, as of chaos that averages have told, the last step of the halving is.
 */
static pendres_status leave_open(const search *w, pendres_jump *jump)
{
  const int direction = value_of(w) > w->from ? 1 : -1;
  const double step = 2.0 * jump->value_error, first = LIVES_FURTHER * step;
  const double watched = w->before.attractor.watched_periods;
  const double at[2] = {jump->value + direction * first,
                        jump->value + LIVES_FURTHER * direction * first};
  double x[LIVES], v[LIVES], life[2];
  if (isnan(watched)) jump->value_error += step;
  if (isnan(watched)) return PENDRES_OK;
  pendres_status status = pendres_chaos_spread(w->ctx, &w->before, LIVES, x, v);
  if (status == PENDRES_OK) status = mean_lives(w, at, x, v, life);
  if (status != PENDRES_OK) return status;
  const double power = fmax(ends_least_power, log(life[0] / life[1]) / log(LIVES_FURTHER));
  const double open = first * pow(lives_watched * life[0] / watched, 1.0 / power);
  jump->value_error += open < step ? open : step; /* the step where that is not known */
  return status;
}

pendres_status pendres_chaos_end(pendres_context *ctx, pendres_parameter parameter,
                                 const pendres_arrival *old, double from, pendres_arrival *state,
                                 pendres_jump *jump)
{
  search w = {.ctx = ctx, .parameter = parameter, .old = old, .from = from, .before = *old,
              .state = state};
  birth found = BIRTH_NONE;
  jump->share = NAN;
  jump->certain = 0;
  pendres_status status = try_birth(&w, jump, &found);
  if (status == PENDRES_OK && found != BIRTH_FOUND) status = halve(&w, jump);
  jump->from = w.before.attractor.label;
  if (status == PENDRES_OK && found != BIRTH_FOUND && jump->from == PENDRES_LABEL_CHAOTIC) {
    status = try_birth(&w, jump, &found);
    /* What is there all the while coexists with the chaos, which ends by itself. */
    if (status == PENDRES_OK &&
        (found == BIRTH_EARLIER || !pendres_attractor_closes(&state->attractor))) {
      jump->kind = PENDRES_JUMP_CRISIS;
      status = leave_open(&w, jump);
    }
  }
  jump->to = state->attractor.label;
  jump->to_period = pendres_attractor_closes(&state->attractor) ? state->attractor.orbit.period : 0;
  return status;
}
