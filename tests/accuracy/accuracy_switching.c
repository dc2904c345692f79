/*
 * accuracy_switching.c -- rates of switching beside the occupation that they imply, and both beside
 * what is true: Boltzmann's weights at rest, and where own noisy trajectories end.
 *
 * Errors of statistics are standard errors: four of them are the claim. At rest the ratio of rates
 * is known exactly; steps have a bias of their own, of up to 2 % of a rate.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TRAJECTORIES = 192, PERIODS = 400, OWN = 128, STEPS = 40, CALM = 60, HOW = 500 };

static const double sigmas = 4.0, bias = 0.02;

typedef struct item {
  pendres_pendulum pendulum;
  double temperature;
  int found, driven; /* two states and no other */
  pendres_status status;
  pendres_switching_rates rates;
  double boltzmann;  /* of the rates forth and back, at rest */
  double own;        /* the share of own trajectories that end on the first state, ... */
  int known;         /* ... of those that end on either */
} item;

/* ---- draws ---- */

/* A double well at rest under a torque, a driven one, or a pendulum's two orbits. */
static void draw(accuracy_random *r, item *t)
{
  const int which = accuracy_choice(r, 3);
  pendres_pendulum *p = &t->pendulum;
  t->driven = which > 0;
  *p = (pendres_pendulum){.damping = accuracy_logarithmic(r, 0.2, 2.0), .drive_frequency = 1.0};
  if (which < 2) {
    p->force = PENDRES_FORCE_POLYNOMIAL;
    p->force_coefficients[0] = -1.0;
    p->force_coefficients[2] = 1.0;
    p->torque = accuracy_uniform(r, -0.06, 0.06);
    if (t->driven) p->drive_amplitude = accuracy_uniform(r, 0.02, 0.08);
    t->temperature = accuracy_uniform(r, 0.05, 0.08);
  } else {
    p->damping = accuracy_uniform(r, 0.11, 0.14);
    p->drive_amplitude = 0.2;
    p->drive_frequency = 6.28318530717958648 / accuracy_uniform(r, 7.6, 7.8);
    t->temperature = accuracy_uniform(r, 0.015, 0.025);
  }
}

/* ---- what is true ---- */

/* The ratio of the rates from the first state to the second and back: that of the weights of the
   second's side of the barrier and the first's, by the trapezoidal rule. */
static double boltzmann_of(const item *t, const pendres_attractors *set)
{
  const pendres_pendulum *p = &t->pendulum;
  const double first = pendres_attractors_get(set, (size_t)0)->orbit.x, h = 1e-3;
  double weight[2] = {0.0, 0.0}, top = 0.0;
  for (int i = 0; i < 60; i++) top -= (p->torque + top - top * top * top) / (1.0 - 3.0 * top * top);
  for (double x = -4.0; x < 4.0; x += h) {
    const double potential = x * x * (0.25 * x * x - 0.5) - p->torque * x;
    weight[(x > top) == (first > top)] += exp(-potential / t->temperature);
  }
  return weight[0] / weight[1];
}

/* On which of two orbits a state ends without noise, by an own integration; -1 if on neither. */
static int basin_of(const item *t, const pendres_attractors *set, double s[2])
{
  const accuracy_own quiet = {.pendulum = t->pendulum, .steps = STEPS};
  const double period = pendres_model_of(t->pendulum.force)->period;
  double harmonic[2];
  int nearest = -1;
  double least = 0.05;
  for (int k = 0; k < CALM; k++) accuracy_own_period(&quiet, k, NULL, s, harmonic);
  for (int i = 0; i < 2; i++) {
    const pendres_orbit *o = &pendres_attractors_get(set, (size_t)i)->orbit;
    const double x = period > 0.0 ? remainder(s[0] - o->x, period) : s[0] - o->x;
    const double apart = hypot(x, s[1] - o->v);
    if (apart < least) {
      least = apart;
      nearest = i;
    }
  }
  return nearest;
}

/* Half of the own trajectories start on either state, as the library's do. */
static void follow_own(accuracy_random *r, const pendres_attractors *set, item *t)
{
  accuracy_own own = {.pendulum = t->pendulum, .steps = STEPS};
  int ended[2] = {0, 0};
  own.pendulum.temperature = t->temperature;
  for (int i = 0; i < OWN; i++) {
    const pendres_orbit *o = &pendres_attractors_get(set, (size_t)(i % 2))->orbit;
    double s[2] = {o->x, o->v}, harmonic[2];
    for (int k = 0; k < PERIODS; k++) accuracy_own_period(&own, k, r, s, harmonic);
    const int basin = basin_of(t, set, s);
    if (basin >= 0) ended[basin]++;
  }
  t->known = ended[0] + ended[1];
  t->own = (double)ended[0] / t->known;
}

/* ---- comparisons ---- */

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  pendres_attractors *set = NULL;
  pendres_switching_activation activation[PENDRES_SWITCHING_WAYS];
  draw(r, t);
  t->status = pendres_context_create(&(pendres_options){.seed = 1000 + (uint64_t)number}, &ctx);
  if (t->status == PENDRES_OK)
    t->status = pendres_attractors_find(ctx, &t->pendulum, 0, NULL, NULL, &set);
  t->found = t->status == PENDRES_OK && pendres_attractors_count(set) == 2 &&
             pendres_attractors_get(set, 0)->orbit.period == 1 &&
             pendres_attractors_get(set, 1)->orbit.period == 1;
  if (t->found) {
    const pendres_switching_survey survey = {
      .set = set, .state = {0, 1}, .trajectories = TRAJECTORIES, .periods = PERIODS};
    t->status =
      pendres_switching_find(ctx, &survey, 1, &t->temperature, &t->rates, activation);
    if (t->status == PENDRES_OK) t->status = t->rates.status;
    if (!t->driven) t->boltzmann = boltzmann_of(t, set);
    follow_own(r, set, t);
  }
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  const pendres_pendulum *p = &t->pendulum;
  const pendres_switching_rate *forth = &t->rates.way[PENDRES_SWITCHING_FORTH];
  const pendres_switching_rate *back = &t->rates.way[PENDRES_SWITCHING_BACK];
  const pendres_langevin_estimate *is = &t->rates.occupation[0], *implied = &t->rates.implied[0];
  char how[HOW];
  snprintf(how, sizeof how, "item %ld: %s, force %.17g %.17g %.17g, damping %.17g, F0 %.17g, "
           "omega %.17g, I %.17g, T %.17g; rates %.3g(%.1g), %.3g(%.1g)", number,
           pendres_model_of(p->force)->name, p->force_coefficients[0], p->force_coefficients[1],
           p->force_coefficients[2], p->damping, p->drive_amplitude, p->drive_frequency, p->torque,
           t->temperature, forth->value, forth->error, back->value, back->error);
  if (t->status != PENDRES_OK) accuracy_complain(a, "rates failed", how);
  if (t->status != PENDRES_OK || !t->found) return;
  ++*(long *)counts;
  accuracy_note(a, "occupation, implied", implied->value, sigmas * hypot(is->error, implied->error),
                is->value, how);
  if (t->known < OWN) accuracy_complain(a, "own trajectories end on no orbit", how);
  /* As many as there are decide how well a share is known, and at least one. */
  const double share = fmin(fmax(t->own, 1.0 / OWN), 1.0 - 1.0 / OWN);
  const double own_error = sqrt(share * (1.0 - share) / OWN);
  accuracy_note(a, "occupation, own", is->value, sigmas * hypot(is->error, own_error), t->own, how);
  accuracy_note(a, "implied, own", implied->value, sigmas * hypot(implied->error, own_error),
                t->own, how);
  if (t->driven || forth->events < 20.0 || back->events < 20.0) return;
  accuracy_note(a, "rates, Boltzmann", log(forth->value / back->value),
                bias + sigmas * hypot(forth->error / forth->value, back->error / back->value),
                log(t->boltzmann), how);
}

void accuracy_switching(accuracy *a)
{
  long pairs = 0;
  const accuracy_work work = {.items = (accuracy_get_options(a)->points + 7) / 8, .at_once = 4,
                              .size = sizeof(item), .compute = compute, .note = note,
                              .tally = &pairs};
  const long items = accuracy_each(a, &work);
  printf("\nswitching: %ld of %ld draws have two states\n", pairs, items);
}
