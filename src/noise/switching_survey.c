/* switching_survey.c -- switching between two states at several temperatures; see switching.h. */
#include <pendres/switching.h>

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/door.h"
#include "noise/cores.h"
#include "noise/noise_common.h"
#include "settling/attractor_internal.h"

enum {
  WAYS = PENDRES_SWITCHING_WAYS,
  WELL = -2,
  /* Trajectories of a part, at most: sums of counts do not depend on the division into parts. */
  PART = PENDRES_NOISE_LANES / 2
};

/* Where ways begin and end: the first state, the second, or another well. */
static const struct {
  int from, to;
} ways[WAYS] = {[PENDRES_SWITCHING_FORTH] = {0, 1}, [PENDRES_SWITCHING_BACK] = {1, 0},
                [PENDRES_SWITCHING_FIRST_WELL] = {0, WELL},
                [PENDRES_SWITCHING_SECOND_WELL] = {1, WELL}};

void pendres_switching_states(const pendres_attractors *set, int state[2])
{
  static const pendres_label labels[2] = {PENDRES_LABEL_SA, PENDRES_LABEL_LA};
  if (state == NULL) return;
  for (int s = 0; s < 2; s++) {
    state[s] = -1;
    for (size_t i = pendres_attractors_count(set); i-- > 0;)
      if (pendres_attractors_get(set, i)->label == labels[s]) state[s] = (int)i;
  }
}

/* NULL, or what is wrong with a survey. */
static const char *refuse(const pendres_switching_survey *q)
{
  const int count = (int)pendres_attractors_count(q->set);
  if (count > PENDRES_SWITCHING_STATES) return "there are too many attractors";
  if (q->state[0] < 0 && q->state[1] < 0) return "neither of the two states exists";
  for (int s = 0; s < 2; s++)
    if (q->state[s] < -1 || q->state[s] >= count) return "there is no such attractor";
  if (q->state[0] == q->state[1]) return "the two states are the same";
  if (q->periods < 0) return "the number of periods must not be negative";
  if (!(q->level >= 0.0 && q->level < 1.0)) return "the level must be between 0 and 1";
  return NULL;
}

/* ---- Following ----------------------------------------------------------------------------- */

/* Open the door to a survey; returns it as it is behind, in *inside. */
static const pendres_switching_survey *open_survey(pendres_door *d, pendres_context *ctx,
                                                   const pendres_switching_survey *survey,
                                                   pendres_switching_survey *inside)
{
  *d = pendres_attractors_open(ctx, survey != NULL ? survey->set : NULL);
  if (survey == NULL || !pendres_door_changes(d)) return survey;
  *inside = *survey;
  inside->set = pendres_attractors_inside(d, survey->set);
  return inside;
}

static pendres_status choose_steps(pendres_context *ctx, const pendres_switching_survey *q,
                                   int state, int *steps)
{
  if (q == NULL || steps == NULL) return PENDRES_CONTEXT_NULL(ctx, "survey and steps");
  const char *wrong = refuse(q);
  if (wrong == NULL && (state < 0 || state > 1)) wrong = "the states are 0 and 1";
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  *steps = 0;
  if (q->state[state] < 0) return PENDRES_OK;
  const size_t from = (size_t)q->state[state];
  const pendres_orbit *o = &pendres_attractors_get(q->set, from)->orbit;
  if ((double)pendres_noise_settle(o) > noise_by_theory) {
    const pendres_status status =
      pendres_noise_steps_by_orbit(ctx, o, pendres_noise_bias, steps);
    *steps *= 2;
    if (status != PENDRES_OK || *steps > 0) return status;
  }
  pendres_cores cores;
  pendres_langevin_request r = {.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                .trajectories = PENDRES_NOISE_LANES,
                                .record = PENDRES_NOISE_RECORD,
                                .settle = pendres_noise_settle(o),
                                .leave = pendres_cores_leave, .arg = &cores};
  r.pendulum.temperature = pendres_noise_coldest;
  r.first_id = pendres_noise_first_id(&r.pendulum, from);
  pendres_langevin_bias bias;
  pendres_status status =
    pendres_cores_make(ctx, q->set, pendres_noise_coldest, 0.0, &cores);
  cores.home = (int)from;
  if (status == PENDRES_OK)
    status = pendres_noise_choose_steps(ctx, &r, PENDRES_LANGEVIN_CLOUD, pendres_noise_bias, &bias);
  if (status == PENDRES_OK) *steps = 2 * bias.steps_per_period;
  return status;
}

pendres_status pendres_switching_choose_steps(pendres_context *ctx,
                                              const pendres_switching_survey *survey, int state,
                                              int *steps)
{
  pendres_door d;
  pendres_switching_survey inside;
  survey = open_survey(&d, ctx, survey, &inside);
  return PENDRES_DOOR_END(&d, choose_steps(ctx, survey, state, steps));
}

/* Trajectories that start on a state. */
static size_t share(const pendres_switching_survey *q, int state)
{
  const size_t all = q->trajectories;
  if (q->state[state] < 0) return 0;
  if (q->state[1 - state] < 0) return all;
  return state == 0 ? all - all / 2 : all / 2;
}

size_t pendres_switching_parts(const pendres_switching_survey *survey)
{
  if (survey == NULL) return 0;
  return pendres_noise_parts(share(survey, 0), PART) + pendres_noise_parts(share(survey, 1), PART);
}

static pendres_status follow(pendres_context *ctx, const pendres_switching_survey *q,
                             double temperature, size_t part, pendres_switching_tally *tally)
{
  if (q == NULL || tally == NULL) return PENDRES_CONTEXT_NULL(ctx, "survey and tally");
  const char *wrong = refuse(q);
  if (wrong == NULL && part >= pendres_switching_parts(q)) wrong = "there is no such part";
  if (wrong == NULL && q->steps_per_period == 0) wrong = "to follow trajectories asks for steps";
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  const size_t of_first = pendres_noise_parts(share(q, 0), PART);
  const int start = part >= of_first;
  size_t first;
  pendres_switching_request r = {.set = q->set, .from = (size_t)q->state[start],
                                 .periods = q->periods, .steps_per_period = q->steps_per_period};
  r.pendulum = pendres_attractors_get(q->set, r.from)->orbit.pendulum;
  r.pendulum.temperature = temperature;
  r.trajectories = pendres_noise_part(share(q, start), PART, start ? part - of_first : part,
                                      &first);
  r.first_id = pendres_noise_first_id(&r.pendulum, r.from) + first;
  return pendres_switching_count(ctx, &r, tally);
}

pendres_status pendres_switching_follow(pendres_context *ctx,
                                        const pendres_switching_survey *survey, double temperature,
                                        size_t part, pendres_switching_tally *tally)
{
  pendres_door d;
  pendres_switching_survey inside;
  survey = open_survey(&d, ctx, survey, &inside);
  const double warm = temperature / pendres_units_factor(&d.scales, 2, -2);
  PENDRES_DOOR_OUT(&d, tally, 1, tally);
  return PENDRES_DOOR_END(&d, follow(ctx, survey, warm, part, tally));
}

/* ---- Rates and energies -------------------------------------------------------------------- */

/* The share of trajectories on the second state after a time, by rates forth and back. */
static double share_on_second(double start, double forth, double back, double time)
{
  const double sum = forth + back, left = exp(-sum * time);
  return sum > 0.0 ? start * left + forth / sum * (1.0 - left) : start;
}

/* Where trajectories end, by their basins and by the rates. */
static void compare_ends(const pendres_switching_survey *q, const pendres_switching_tally *all,
                         pendres_switching_rates *r)
{
  const double n = all->trajectories, time = (double)q->periods * all->period;
  const pendres_switching_rate *a = &r->way[PENDRES_SWITCHING_FORTH];
  const pendres_switching_rate *b = &r->way[PENDRES_SWITCHING_BACK];
  if (!(n > 0.0)) return;
  for (int s = 0; s < 2; s++) {
    if (q->state[s] < 0) continue;
    const double p = all->ends[q->state[s]] / n;
    /* One uncertain state is one trajectory at least. */
    r->occupation[s] = (pendres_langevin_estimate){p, fmax(sqrt(p * (1.0 - p) / n), 1.0 / n)};
  }
  if (q->state[0] < 0 || q->state[1] < 0 || all->states != 2 ||
      pendres_pendulum_leaves(&pendres_attractors_get(q->set, 0)->orbit.pendulum))
    return;
  const double start = (double)share(q, 1) / n;
  const double p = share_on_second(start, a->value, b->value, time);
  const double error = hypot(share_on_second(start, a->value + a->error, b->value, time) - p,
                             share_on_second(start, a->value, b->value + b->error, time) - p);
  r->implied[0] = (pendres_langevin_estimate){1.0 - p, error};
  r->implied[1] = (pendres_langevin_estimate){p, error};
}

static int balanced(const pendres_switching_rates *r)
{
  for (int s = 0; s < 2; s++)
    if (fabs(r->occupation[s].value - r->implied[s].value) >
        surely * hypot(r->occupation[s].error, r->implied[s].error))
      return 0;
  return 1; /* also where nothing is known */
}

pendres_status pendres_switching_conclude(const pendres_switching_survey *survey,
                                          double temperature, const pendres_switching_tally *all,
                                          pendres_switching_rates *rates)
{
  const pendres_switching_rate none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  pendres_status status = PENDRES_OK;
  if (survey == NULL || rates == NULL || refuse(survey) != NULL) return PENDRES_INVALID_ARGUMENT;
  const double level = survey->level > 0.0 ? survey->level : pendres_noise_level;
  const int *state = survey->state;
  *rates = (pendres_switching_rates){.temperature = temperature, .exposure = {NAN, NAN}};
  for (int k = 0; k < WAYS; k++) rates->way[k] = none;
  for (int s = 0; s < 2; s++)
    rates->occupation[s] = rates->implied[s] = (pendres_langevin_estimate){NAN, NAN};
  if (state[0] < 0 || state[1] < 0) rates->status = PENDRES_NOT_FOUND;
  if (all == NULL) return PENDRES_OK;
  for (int s = 0; s < 2; s++)
    if (state[s] >= 0) rates->exposure[s] = all->exposure[state[s]] * all->period;
  for (int k = 0; k < WAYS && status == PENDRES_OK; k++) {
    const int from = state[ways[k].from];
    const int to = ways[k].to == WELL ? PENDRES_SWITCHING_WELL : state[ways[k].to];
    if (from >= 0 && to >= 0)
      status =
        pendres_switching_rate_of(all, (size_t)from, (size_t)to, level, &rates->way[k]);
  }
  if (status == PENDRES_OK) compare_ends(survey, all, rates);
  return status;
}

/* Temperatures and rates of one way, in the arrays that the fit takes. */
static pendres_status activate(const pendres_switching_survey *q, int way, size_t n,
                               const pendres_switching_rates *rates,
                               pendres_switching_activation *out)
{
  const int from = q->state[ways[way].from];
  const int to = ways[way].to == WELL ? 0 : q->state[ways[way].to];
  double *temperature = malloc((n + 1) * sizeof *temperature);
  pendres_switching_rate *rate = malloc((n + 1) * sizeof *rate);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (temperature == NULL || rate == NULL) goto done;
  for (size_t i = 0; i < n; i++) {
    temperature[i] = rates[i].temperature;
    rate[i] = rates[i].way[way];
  }
  const pendres_scales scales = {q->set->units[0], 1.0, 1.0};
  pendres_units_in(&scales, &pendres_dim_energy, n, temperature);
  pendres_units_in(&scales, &pendres_dim_rate, n, rate);
  status = pendres_switching_fit(n, temperature, rate, 0.0, out);
  if (status == PENDRES_NOT_FOUND) status = PENDRES_OK; /* too few events: the verdict says so */
  pendres_units_out(&scales, &pendres_dim_activation, 1, out);
  out->log_prefactor -= log(scales.unit.time);
  if (from < 0 || to < 0) out->verdict = PENDRES_SWITCHING_NO_STATE;
done:
  free(temperature);
  free(rate);
  return status;
}

/* Where there is no barrier one way there is no state to come to either; where transitions are
   missed, they are both ways. */
static void judge_both(size_t n, const pendres_switching_rates *rates,
                       pendres_switching_activation *activation)
{
  pendres_switching_verdict *forth = &activation[PENDRES_SWITCHING_FORTH].verdict;
  pendres_switching_verdict *back = &activation[PENDRES_SWITCHING_BACK].verdict;
  if (*forth == PENDRES_SWITCHING_NO_STATE) return;
  for (size_t i = 0; i < n; i++)
    if (!balanced(&rates[i])) *forth = *back = PENDRES_SWITCHING_UNBALANCED;
  if (*forth == PENDRES_SWITCHING_NO_BARRIER || *back == PENDRES_SWITCHING_NO_BARRIER)
    *forth = *back = PENDRES_SWITCHING_NO_BARRIER;
}

pendres_status pendres_switching_activate(const pendres_switching_survey *survey, size_t n,
                                          const pendres_switching_rates *rates,
                                          pendres_switching_activation *activation)
{
  pendres_status status = PENDRES_OK;
  if (survey == NULL || activation == NULL || (n > 0 && rates == NULL) || refuse(survey) != NULL)
    return PENDRES_INVALID_ARGUMENT;
  for (int k = 0; k < WAYS && status == PENDRES_OK; k++)
    status = activate(survey, k, n, rates, &activation[k]);
  if (status == PENDRES_OK) judge_both(n, rates, activation);
  return status;
}

/* ---- All of it ----------------------------------------------------------------------------- */

/* Failures that end the whole survey, not only one temperature. */
static int ends_all(pendres_status status)
{
  return status == PENDRES_OUT_OF_MEMORY || status == PENDRES_INTERRUPTED ||
         status == PENDRES_INTERNAL || status == PENDRES_BUSY;
}

/* All parts at one temperature. */
static pendres_status measure_at(pendres_context *ctx, const pendres_switching_survey *q,
                                 double temperature, pendres_switching_rates *rates)
{
  const size_t parts = pendres_switching_parts(q);
  pendres_switching_tally all = {0}, one;
  pendres_status status = PENDRES_OK;
  for (size_t part = 0; part < parts && status == PENDRES_OK; part++) {
    status = pendres_switching_follow(ctx, q, temperature, part, &one);
    if (status == PENDRES_OK) pendres_switching_add(&all, &one);
  }
  if (ends_all(status)) return status;
  const pendres_status concluded =
    pendres_switching_conclude(q, temperature, status == PENDRES_OK ? &all : NULL, rates);
  if (status != PENDRES_OK) rates->status = status;
  return concluded;
}

static pendres_status measure(pendres_context *ctx, const pendres_switching_survey *survey,
                              size_t n, const double *temperature, pendres_switching_rates *rates,
                              pendres_switching_activation *activation)
{
  if (survey == NULL || activation == NULL || (n > 0 && (temperature == NULL || rates == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "survey, temperature, rates and activation");
  pendres_switching_survey q = *survey;
  pendres_status status = PENDRES_OK;
  for (int s = 0; s < 2 && survey->steps_per_period == 0 && status == PENDRES_OK; s++) {
    int steps;
    status = pendres_switching_choose_steps(ctx, survey, s, &steps);
    if (status == PENDRES_OK && steps > q.steps_per_period) q.steps_per_period = steps;
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = measure_at(ctx, &q, temperature[i], &rates[i]);
  if (status != PENDRES_OK) return status;
  status = pendres_switching_activate(&q, n, rates, activation);
  if (status == PENDRES_OK) return status;
  return pendres_context_fail(ctx, status, "activation energies cannot be computed");
}

pendres_status pendres_switching_find(pendres_context *ctx,
                                      const pendres_switching_survey *survey, size_t n,
                                      const double *temperature, pendres_switching_rates *rates,
                                      pendres_switching_activation *activation)
{
  return PENDRES_CONTEXT_CALL(ctx, measure(ctx, survey, n, temperature, rates, activation));
}
