/*
 * accuracy_sweeps.c -- sweeps up and down along any parameter of any model, of polynomials in units
 * of a millionth to a million: each state that ends does end, none ends without a jump, and each
 * jump leads to another state.
 *
 * What is true is told by a continuation of its own: from each point of a path that is a closed
 * orbit the extended-precision reference's Newton's method leads on to the next value, in steps
 * that are halved where it fails. Where it arrives and the orbit has been stable all the way, there
 * must be no jump, and the next point must be that orbit; where it does not, there must be a jump
 * at that place. Interior crises are put beside a simulation (accuracy_crises.c).
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
  VALUES = 12,
  POINTS = 2 * VALUES,
  FAULTS = 4,  /* of a sweep, that are told */
  JUMPS = 200, /* of a sweep; it has fewer */
  HOW = 700,
  WORDS = 60
};

/* The shortest step of a continuation, in that of the path: how well it knows an end. */
static const double shortest = 1e-7;
/* A step leads on along a branch if it ends this close to where it was expected to. */
static const double expected = 0.02;
/* A state has ended so far beyond its jump, in the step of the path. */
static const double beyond = 1e-3;
/* Measures of one orbit agree to this. */
static const double same = 1e-6;
/* Longer orbits are not followed: a step takes as many periods. */
static const long longest = 8;

typedef struct fault {
  char what[WORDS];
  double from, to, value;
} fault;

/* A sweep. The library is asked in units of its own; what it finds stands here in the powers of two
   next to these, as does the pendulum. */
typedef struct item {
  pendres_pendulum pendulum;
  pendres_parameter parameter;
  double low, high, x, v;
  accuracy_units units;
  pendres_status status;
  long steps, checked, marked;
  int faults, jumps, crises;
  fault fault[FAULTS];
  pendres_status why; /* the latest of values left out */
  pendres_jump jump[JUMPS];
  pendres_hysteresis_point point[POINTS];
} item;

/* ---- draws ---- */

static pendres_pendulum model(accuracy_random *r)
{
  pendres_pendulum p = {.damping = accuracy_logarithmic(r, 0.05, 1.0),
                        .drive_amplitude = accuracy_logarithmic(r, 0.02, 1.5),
                        .drive_frequency = accuracy_uniform(r, 0.3, 2.0)};
  const int which = accuracy_choice(r, 10);
  if (accuracy_choice(r, 3) == 0) p.torque = accuracy_uniform(r, -0.6, 0.6);
  if (accuracy_choice(r, 3) == 0) p.parametric_amplitude = accuracy_uniform(r, -0.8, 0.8);
  if (which < 4) return p;
  p.force = which < 8 ? PENDRES_FORCE_POLYNOMIAL : PENDRES_FORCE_SQUID;
  if (which >= 8) {
    p.force_coefficients[0] = accuracy_logarithmic(r, 0.03, 1.0);
    return p;
  }
  if (which < 7) p.force_coefficients[0] = which == 5 ? -1.0 : 1.0;
  if (which == 6) p.force_coefficients[1] = accuracy_uniform(r, -1.0, 1.0);
  p.force_coefficients[2] = accuracy_choice(r, 6) == 0 && which == 4
                              ? 0.0 : accuracy_uniform(r, 0.2, 1.0);
  return p;
}

static void draw(accuracy_random *r, item *t)
{
  static const double range[][2] = {{0.2, 4.0}, {0.05, 2.0}, {0.0, 3.0}, {-2.0, 2.0}, {-2.0, 2.0}};
  t->pendulum = model(r);
  t->parameter = (pendres_parameter)accuracy_choice(r, PENDRES_PARAMETRIC_AMPLITUDE + 1);
  const double from = range[t->parameter][0], to = range[t->parameter][1];
  const double a = accuracy_uniform(r, from, to), b = accuracy_uniform(r, from, to);
  t->low = fmin(a, b);
  t->high = fmax(a, b) + 0.05;
  /* One in four goes far. */
  if (accuracy_choice(r, 4) == 0) t->high = t->low + 20.0 * (t->high - t->low);
  t->x = accuracy_uniform(r, -1.0, 2.0);
  t->v = accuracy_uniform(r, -0.5, 0.5);
  /* An angle has its own unit, and its force fixes that of time. */
  t->units = accuracy_draw_units(r);
  if (t->pendulum.force != PENDRES_FORCE_POLYNOMIAL) t->units = (accuracy_units){1.0, 1.0};
}

/* A value of the parameter in units so long, of one in those of the draw. */
static double value_in(const item *t, double value, accuracy_units u)
{
  pendres_pendulum p = t->pendulum;
  pendres_parameter_set(t->parameter, value, &p);
  p = accuracy_in_units(&p, u);
  return pendres_parameter_get(t->parameter, &p);
}

/* ---- a continuation of its own ---- */

typedef struct place {
  double value;
  reference_cycle cycle;
} place;

static double turn_of(const pendres_pendulum *p)
{
  const double period = pendres_model_of(p->force)->period;
  return period > 0.0 ? period : 1e300;
}

static int stable(const reference_cycle *c)
{
  return hypotl(c->multiplier_re[0], c->multiplier_im[0]) < 1.0L &&
         hypotl(c->multiplier_re[1], c->multiplier_im[1]) < 1.0L;
}

/* The orbit at a value, expected on the line through two places before it; 1: it is there, and
   stable. */
static int next_place(const item *t, const place *before, const place *here, double value,
                      place *out)
{
  const reference_cycle *a = &before->cycle, *b = &here->cycle;
  pendres_pendulum p = t->pendulum;
  const long double way = here->value - before->value;
  const long double part = way != 0.0L ? (value - here->value) / way : 0.0L;
  const long double turn = turn_of(&p);
  const long double y = b->y + part * remainderl(b->y - a->y, turn);
  const long double v = b->v + part * (b->v - a->v);
  pendres_parameter_set(t->parameter, value, &p);
  out->value = value;
  return reference_orbit(&p, y, v, b->period, b->winding, &out->cycle) == PENDRES_OK &&
         hypotl(remainderl(out->cycle.y - y, turn), out->cycle.v - v) < expected &&
         stable(&out->cycle);
}

/* Lead an orbit on to a value: 1 if it arrives; *end is the last place that was reached. */
static int lead(const item *t, const pendres_orbit *from, double to, place *end)
{
  const double start = pendres_parameter_get(t->parameter, &from->pendulum);
  const double least = shortest * fabs(to - start);
  double step = (to - start) / 8.0;
  place before = {.value = start,
                  .cycle = {.y = from->x - pendres_model_of(from->pendulum.force)->origin,
                            .v = from->v, .period = from->period, .winding = from->winding}};
  place here, next;
  *end = before;
  if (!next_place(t, &before, &before, start, &here)) return 0;
  for (before = here; here.value != to;) {
    const int last = fabs(to - here.value) <= fabs(step) * 1.001;
    if (next_place(t, &before, &here, last ? to : here.value + step, &next)) {
      before = here;
      here = next;
      step *= 1.5;
    } else {
      step *= 0.5;
    }
    *end = here;
    if (fabs(step) < least) return 0;
  }
  return 1;
}

/* ---- a path ---- */

static void complain(item *t, const char *what, double from, double to, double value)
{
  if (t->faults < FAULTS) {
    fault *f = &t->fault[t->faults];
    snprintf(f->what, sizeof f->what, "%s", what);
    f->from = from;
    f->to = to;
    f->value = value;
  }
  t->faults++;
}

/* The jump on the way to point i that is nearest to a value, the first one for NaN; NULL: none. */
static const pendres_jump *jump_near(const item *t, size_t i, double value)
{
  const pendres_jump *found = NULL;
  for (int k = 0; k < t->jumps; k++) {
    const pendres_jump *j = &t->jump[k];
    if (j->step == i && (found == NULL || fabs(j->value - value) < fabs(found->value - value)))
      found = j;
  }
  return found;
}

/* A value right beyond a jump, before that at which the way to it ends. */
static double beside(const pendres_jump *j, double way, double last)
{
  const double value = j->value + j->direction * (j->value_error + beyond * way);
  return (value - last) * j->direction < 0.0 ? value : last;
}

/* The way from point i to the next. Where an orbit grows into the one that it was born from, the
   continuation goes on along that, and comes to later jumps. */
static void check_step(item *t, size_t i)
{
  const pendres_jump *j = jump_near(t, i + 1, NAN);
  const pendres_hysteresis_point *a = &t->point[i], *b = a + 1;
  const pendres_orbit *o = &a->attractor.orbit, *q = &b->attractor.orbit;
  place end, near;
  if (a->value == b->value) return;
  t->steps++;
  if (o->period < 1 || o->period > longest) return;
  t->checked++;
  const double way = fabs(b->value - a->value);
  int arrives = lead(t, o, b->value, &end);
  /* An orbit that is unstable for a part of the way may be stepped over where it is. */
  if (j != NULL && !lead(t, o, beside(j, way, b->value), &near)) {
    arrives = 0;
    end = near;
  }
  if (j != NULL && arrives && !j->gradual)
    complain(t, "a jump from a state that goes on", a->value, b->value, j->value);
  if (j != NULL && !arrives) j = jump_near(t, i + 1, end.value);
  if (j != NULL && !arrives && fabs(end.value - j->value) > j->value_error + beyond * way)
    complain(t, "a jump elsewhere", a->value, b->value, end.value);
  if (j == NULL && !arrives)
    complain(t, "a state that ends without a jump", a->value, b->value, end.value);
  const double off = fabs((double)end.cycle.amplitude - q->amplitude);
  if (j == NULL && arrives && (q->period < 1 || off > same + q->amplitude_error))
    complain(t, "another state without a jump", a->value, b->value, q->amplitude);
}

/* Whether two attractors are the same state at parameters not far apart, mirror images included. */
static int alike(const pendres_attractor *a, const pendres_attractor *b)
{
  const pendres_orbit *o = &a->orbit, *q = &b->orbit;
  if (a->label == PENDRES_LABEL_UNRESOLVED || b->label == PENDRES_LABEL_UNRESOLVED) return 0;
  if (o->period < 1 || q->period < 1) return a->label == b->label;
  return o->period == q->period && labs(o->winding) == labs(q->winding) &&
         fabs(o->amplitude - q->amplitude) <= same + o->amplitude_error + q->amplitude_error;
}

/* A jump that is the only one between two values leads from the one's state to the other's. */
static void check_jump(item *t, const pendres_jump *j)
{
  const pendres_hysteresis_point *b = &t->point[j->step], *a = b - 1;
  int others = 0;
  while (a > t->point && a->outcome != PENDRES_OK) a--; /* left out: as if it were not there */
  for (int k = 0; k < t->jumps; k++) others += t->jump[k].step == j->step;
  if (!(j->value_error >= 0.0 && isfinite(j->value_error)))
    complain(t, "a jump without an error", a->value, b->value, j->value);
  const int crisis = j->kind == PENDRES_JUMP_CRISIS && j->to == PENDRES_LABEL_CHAOTIC;
  if (j->to_period < 1 && j->from == j->to && j->to != PENDRES_LABEL_RUNNING && !crisis)
    complain(t, "a jump to a state of the same name", a->value, b->value, j->value);
  if (others == 1 && !j->gradual && !crisis && alike(&a->attractor, &b->attractor))
    complain(t, "a jump to the state it came from", a->value, b->value, j->value);
  if ((j->value - a->value) * j->direction < -j->value_error ||
      (b->value - j->value) * j->direction < -j->value_error)
    complain(t, "a jump beside its step", a->value, b->value, j->value);
}

/* Chaos that goes on in larger or smaller chaos, beside an own simulation on the same way, where no
   other jump lies between the same values. */
static void check_crises(item *t)
{
  const pendres_hysteresis_point *at = t->point;
  double s[2] = {t->x, t->v};
  for (int k = 0; k < t->jumps; k++) {
    const pendres_jump *j = &t->jump[k];
    int others = 0;
    for (int i = 0; i < t->jumps; i++) others += t->jump[i].step == j->step;
    if (j->kind != PENDRES_JUMP_CRISIS || j->to != PENDRES_LABEL_CHAOTIC) continue;
    for (; at < t->point + j->step; at++)
      if (at->outcome == PENDRES_OK) accuracy_crisis_come(&t->pendulum, t->parameter, at->value, s);
    if (others > 1) continue;
    const accuracy_crisis c = accuracy_crisis_beside(&t->pendulum, t->parameter, j, s);
    t->crises += c.compared;
    if (c.compared && !c.differs)
      complain(t, "a crisis beside which chaos is the same", at[-1].value, at->value, j->value);
  }
}

static void check(item *t)
{
  for (int k = 0; k < t->jumps; k++) check_jump(t, &t->jump[k]);
  for (size_t i = 0; i + 1 < POINTS; i++) {
    const pendres_hysteresis_point *a = &t->point[i];
    if (a->outcome == PENDRES_OK && a[1].outcome == PENDRES_OK) check_step(t, i);
    else t->marked++;
    if (a->outcome != PENDRES_OK) t->why = a->outcome;
  }
  check_crises(t);
}

/* Take over what was found, in the powers of two next to the units. */
static void take(item *t, const pendres_hysteresis *h, const pendres_pendulum *asked)
{
  const accuracy_units near = accuracy_near_units(t->units);
  const size_t jumps = pendres_hysteresis_jump_count(h);
  const double unit = value_in(t, 1.0, near), length = near.length / t->units.length;
  t->x *= length;
  t->v *= length * t->units.time / near.time;
  t->pendulum = accuracy_in_units(asked, (accuracy_units){1.0 / near.length, 1.0 / near.time});
  for (size_t i = 0; i < POINTS; i++) {
    t->point[i] = *pendres_hysteresis_get(h, i);
    t->point[i].value /= unit;
    t->point[i].attractor.orbit = accuracy_out_of_units(&t->point[i].attractor.orbit, near);
  }
  if (jumps > JUMPS) complain(t, "too many jumps", t->low, t->high, (double)jumps);
  for (t->jumps = 0; t->jumps < JUMPS && (size_t)t->jumps < jumps; t->jumps++) {
    pendres_jump *j = &t->jump[t->jumps];
    *j = *pendres_hysteresis_jump_get(h, (size_t)t->jumps);
    j->value /= unit;
    j->value_error /= unit;
  }
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  pendres_hysteresis *h = NULL;
  double value[POINTS];
  (void)number;
  draw(r, t);
  for (int i = 0; i < VALUES; i++)
    value[i] = value[POINTS - 1 - i] =
      value_in(t, t->low + (t->high - t->low) * i / (VALUES - 1.0), t->units);
  const pendres_hysteresis_path path = {t->parameter, POINTS, value};
  const pendres_pendulum asked = accuracy_in_units(&t->pendulum, t->units);
  const pendres_state start = {t->x / t->units.length, t->v * t->units.time / t->units.length};
  t->status = pendres_context_create(NULL, &ctx);
  if (t->status == PENDRES_OK)
    t->status = pendres_hysteresis_find(ctx, &asked, &start, &path, &h);
  if (t->status == PENDRES_OK) {
    take(t, h, &asked);
    check(t);
  }
  pendres_hysteresis_free(h);
  pendres_context_free(ctx);
}

/* ---- notes ---- */

typedef struct tally {
  long sweeps, steps, checked, marked, uncertain, crises, jumps[PENDRES_JUMP_COUNT];
} tally;

static void show(const item *t, const char *how)
{
  printf("%s\n", how);
  if (t->marked > 0) printf("  left out: %s\n", pendres_status_message(t->why));
  for (int k = 0; k < t->jumps; k++) {
    const pendres_jump *j = &t->jump[k];
    printf("  %-4s %-12s %.14g +- %.1g %s to %s, period %d%s%s\n", j->direction > 0 ? "up" : "down",
           pendres_name_get(PENDRES_NAMES_JUMP, j->kind), j->value, j->value_error,
           pendres_name_get(PENDRES_NAMES_LABEL, j->from),
           pendres_name_get(PENDRES_NAMES_LABEL, j->to), j->to_period,
           j->gradual ? ", gradual" : "",
           j->certain ? "" : ", uncertain");
  }
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  const pendres_pendulum *p = &t->pendulum;
  tally *c = counts;
  char how[HOW];
  int others = 0;
  c->sweeps++;
  c->steps += t->steps;
  c->checked += t->checked;
  c->marked += t->marked;
  c->crises += t->crises;
  for (int k = 0; k < t->jumps; k++) {
    c->jumps[t->jump[k].kind]++;
    c->uncertain += !t->jump[k].certain;
    others += t->jump[k].kind == PENDRES_JUMP_OTHER;
  }
  const int length = snprintf(
    how, sizeof how, "item %ld: %s, force %.17g %.17g %.17g, damping %.17g, F0 %.17g, omega %.17g, "
    "I %.17g, b %.17g, x %.17g, v %.17g, units %.3g %.3g; %s %.17g to %.17g", number,
    pendres_model_of(p->force)->name, p->force_coefficients[0], p->force_coefficients[1],
    p->force_coefficients[2], p->damping, p->drive_amplitude, p->drive_frequency, p->torque,
    p->parametric_amplitude, t->x, t->v, t->units.length, t->units.time,
    pendres_name_get(PENDRES_NAMES_PARAMETER, t->parameter), t->low, t->high);
  if (t->status != PENDRES_OK) accuracy_complain(a, "a sweep failed", how);
  if (others > 0 || accuracy_get_options(a)->item >= 0) show(t, how);
  for (int k = 0; k < t->faults && k < FAULTS; k++) {
    snprintf(how + length, sizeof how - (size_t)length, ": %.10g to %.10g, at %.10g",
             t->fault[k].from, t->fault[k].to, t->fault[k].value);
    accuracy_complain(a, t->fault[k].what, how);
  }
}

void accuracy_sweeps(accuracy *a)
{
  tally c = {0};
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->points / 2, .at_once = 4,
                                    .size = sizeof(item), .compute = compute, .note = note,
                                    .tally = &c});
  printf("\nsweeps: %ld of %ld values; %ld steps, %ld of them beside a continuation, %ld next to "
         "values left out; %ld crises beside a simulation; jumps, %ld of them uncertain:",
         c.sweeps, (long)POINTS, c.steps, c.checked, c.marked, c.crises, c.uncertain);
  for (int k = 0; k < PENDRES_JUMP_COUNT; k++)
    printf(" %ld %s%s", c.jumps[k], pendres_name_get(PENDRES_NAMES_JUMP, k),
           k + 1 < PENDRES_JUMP_COUNT ? "," : "\n");
}
