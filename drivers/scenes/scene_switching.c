/*
 * scene_switching.c -- how often noise carries a pendulum from the small-amplitude state to the
 * large-amplitude one and back, against temperature, and the activation energies.
 *
 * One task a state for the steps a period, then one a temperature and part of the trajectories
 * (switching.h). A temperature at which a part fails is marked and has no results; so are all where
 * the steps of a state cannot be chosen.
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"

static const double level = 0.95;

enum { SA, LA, STATES, WAYS = PENDRES_SWITCHING_WAYS };

typedef struct work {
  const deck *d;
  pendres_attractors *set;
  pendres_switching_survey survey;
  size_t temperatures, parts;
  int steps[STATES];                /* a drive period; 0 where there is no such state */
  pendres_switching_tally *sums;    /* [temperature] */
  pendres_switching_rates *rates;   /* [temperature] */
  pendres_switching_activation activation[WAYS];
  scene_failures choices;           /* [state] of the steps */
  scene_failures failed;            /* [temperature] */
  char name[STATES][24], state[STATES][40]; /* of the states: "sa", "the small-amplitude state" */
  char suffix[WAYS][56], words[WAYS][120];  /* of the ways */
} work;

/* What the ways of switching are called: by the names of the states, or by their numbers. */
static void name_ways(work *w)
{
  static const char *const sizes[STATES] = { "small", "large" };
  static const struct { int from, to; } between[] = { { SA, LA }, { LA, SA } };
  const long number[STATES] = { (long)w->d->switching.from, (long)w->d->switching.to };
  for (int s = 0; s < STATES; s++) {
    if (number[s] > 0) {
      snprintf(w->name[s], sizeof w->name[s], "%ld", number[s]);
      snprintf(w->state[s], sizeof w->state[s], "attractor %ld", number[s]);
    } else {
      snprintf(w->name[s], sizeof w->name[s], "%s", s == SA ? "sa" : "la");
      snprintf(w->state[s], sizeof w->state[s], "the %s-amplitude state", sizes[s]);
    }
  }
  for (int k = 0; k < STATES; k++) {
    const int from = between[k].from, to = between[k].to, well = k + PENDRES_SWITCHING_FIRST_WELL;
    snprintf(w->suffix[k], sizeof w->suffix[k], "%s_%s", w->name[from], w->name[to]);
    snprintf(w->suffix[well], sizeof w->suffix[well], "well_%s", w->name[from]);
    snprintf(w->words[well], sizeof w->words[well], "from %s to another well", w->state[from]);
    if (number[SA] > 0)
      snprintf(w->words[k], sizeof w->words[k], "from %s to %s", w->state[from], w->state[to]);
    else
      snprintf(w->words[k], sizeof w->words[k], "from the %s- to the %s-amplitude state",
               sizes[from], sizes[to]);
  }
}

static void plan(const deck *d, FILE *out)
{
  const deck_axis *t = &d->axis[DECK_AXIS_TEMPERATURE];
  fprintf(out,
          "switching at damping %g, drive period %g, drive amplitude %g, at %zu temperatures\n"
          "%g to %g: %lld trajectories of %lld periods each, %.3g pendulum-periods in all\n",
          d->pendulum.damping, d->pendulum.drive_period, d->pendulum.drive_amplitude, t->count,
          t->value[0], t->value[t->count - 1], (long long)d->noise.trajectories,
          (long long)d->noise.periods,
          (double)t->count * (double)d->noise.trajectories * (double)d->noise.periods);
}

/* ---- tasks --------------------------------------------------------------------------------- */

/* What the choice of a state's steps finds. */
typedef struct choice {
  int steps;
  scene_verdict verdict;
} choice;

/* What is counted of a part. */
typedef struct part {
  pendres_switching_tally tally;
  scene_verdict verdict;
} part;

static pendres_status choose(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  choice *c = out->data;
  const pendres_status status =
    pendres_switching_choose_steps(ctx, &w->survey, (int)task, &c->steps);
  return scene_verdict_note(&c->verdict, status, pendres_context_message(ctx));
}

static pendres_status collect_choice(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const choice *c = in->data;
  w->steps[task] = c->steps;
  scene_failures_take(&w->choices, task, &c->verdict);
  return PENDRES_OK;
}

static pendres_status count(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  part *p = out->data;
  const double temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[task / w->parts];
  if (w->survey.steps_per_period == 0) return PENDRES_OK; /* they could not be chosen */
  const pendres_status status =
    pendres_switching_follow(ctx, &w->survey, temperature, task % w->parts, &p->tally);
  return scene_verdict_note(&p->verdict, status, pendres_context_message(ctx));
}

/* A temperature of which a part fails has its first failure. */
static pendres_status collect_part(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const part *p = in->data;
  const size_t temperature = task / w->parts;
  pendres_switching_add(&w->sums[temperature], &p->tally);
  if (w->failed.reason[temperature] == SCENE_FAILURE_NONE)
    scene_failures_take(&w->failed, temperature, &p->verdict);
  return PENDRES_OK;
}

/* The states to switch between: those that the deck numbers in the order of amplitude, from 1 on,
   or SA and LA. */
static pendres_status find_states(scene_run *run, work *w)
{
  const deck *d = w->d;
  const long wanted[STATES] = { (long)d->switching.from, (long)d->switching.to };
  const pendres_pendulum p = { .damping = d->pendulum.damping,
                               .drive_amplitude = d->pendulum.drive_amplitude,
                               .drive_frequency = d->pendulum.drive_frequency };
  pendres_context *ctx = farm_context(run->farm);
  if (ctx == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory");
  const pendres_status status = pendres_attractors_find(ctx, &p, 0, NULL, NULL, &w->set);
  if (status != PENDRES_OK)
    return scene_fail(run, status, "attractors: %s", pendres_context_message(ctx));
  const long count = (long)pendres_attractors_count(w->set);
  w->survey = (pendres_switching_survey){ .set = w->set, .level = level,
                                          .trajectories = (size_t)d->noise.trajectories,
                                          .periods = (long)d->noise.periods };
  pendres_switching_states(w->set, w->survey.state);
  for (int s = 0; s < STATES && wanted[SA] > 0; s++) {
    if (wanted[s] > count)
      return scene_fail(run, PENDRES_NOT_FOUND,
                        "there is no attractor %ld at these parameters, but %ld", wanted[s], count);
    w->survey.state[s] = (int)wanted[s] - 1;
  }
  if (w->survey.state[SA] < 0 && w->survey.state[LA] < 0)
    return scene_fail(run, PENDRES_NOT_FOUND,
                      "neither a small- nor a large-amplitude state exists at these parameters: "
                      "'from' and 'to' in &switching take attractors by number");
  return PENDRES_OK;
}

/* Steps for both states, since trajectories visit both; 0 if those of either are not known. */
static int steps_of(const work *w)
{
  for (int s = 0; s < STATES; s++)
    if (w->choices.reason[s] != SCENE_FAILURE_NONE) return 0;
  return w->steps[SA] > w->steps[LA] ? w->steps[SA] : w->steps[LA];
}

/*
 * Rates at one temperature: none where a part of its work failed, of which temperatures have the
 * failure already, or the choice of steps, which is the failure of all. Where one state alone
 * exists there is nothing to switch to, and that is said.
 */
static pendres_status conclude(work *w, size_t i)
{
  const int *state = w->survey.state;
  for (int s = STATES - 1; s >= 0; s--)
    if (w->choices.reason[s] != SCENE_FAILURE_NONE)
      scene_failures_mark(&w->failed, i, (scene_failure)w->choices.reason[s],
                          w->choices.words[s]);
  const int broken = w->failed.reason[i] != SCENE_FAILURE_NONE;
  if (!broken && (state[SA] < 0 || state[LA] < 0))
    scene_failures_mark(&w->failed, i, SCENE_FAILURE_NOT_FOUND,
                        state[SA] < 0 ? "there is no small-amplitude state"
                                      : "there is no large-amplitude state");
  return pendres_switching_conclude(&w->survey, w->d->axis[DECK_AXIS_TEMPERATURE].value[i],
                                    broken ? NULL : &w->sums[i], &w->rates[i]);
}

static pendres_status compute(scene_run *run, work *w)
{
  w->parts = pendres_switching_parts(&w->survey);
  w->sums = calloc(w->temperatures, sizeof *w->sums);
  w->rates = calloc(w->temperatures, sizeof *w->rates);
  if (w->sums == NULL || w->rates == NULL ||
      scene_failures_create(STATES, &w->choices) != PENDRES_OK ||
      scene_failures_create(w->temperatures, &w->failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu temperatures",
                      w->temperatures);
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "choices of steps", .tasks = STATES, .task = choose,
                                      .cheap = 1,
                                      .record_size = sizeof(choice), .collect = collect_choice,
                                      .arg = w });
  w->survey.steps_per_period = steps_of(w);
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "chunks", .last = 1, .task = count,
                                               .tasks = w->temperatures * w->parts,
                                               .record_size = sizeof(part),
                                               .collect = collect_part, .arg = w });
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < w->temperatures && status == PENDRES_OK; i++) status = conclude(w, i);
  if (status == PENDRES_OK)
    status = pendres_switching_activate(&w->survey, w->temperatures, w->rates, w->activation);
  if (status != PENDRES_OK) return scene_fail(run, status, "rates cannot be computed");
  return status;
}

/* ---- results ------------------------------------------------------------------------------- */

#define RATE(name) offsetof(pendres_switching_rate, name)
#define FIT(name) offsetof(pendres_switching_activation, name)

/* Of a rate, against temperature; error 0: none is written. */
static const struct {
  const char *format, *words;
  size_t value, error;
} of_rates[] = {
  { "rate_%s", "transitions a unit time", RATE(value), RATE(error) },
  { "rate_%s_lower", "lower end of the rate's confidence interval,", RATE(lower), 0 },
  { "rate_%s_upper", "upper end of the rate's confidence interval,", RATE(upper), 0 },
  { "events_%s", "transitions counted", RATE(events), 0 },
  { "dispersion_%s", "variance of the trajectories' counts by that of independent events,",
    RATE(dispersion), 0 },
};

/* Of a fit, one number each. */
static const struct {
  const char *format, *words;
  size_t value, error;
} of_fits[] = {
  { "activation_energy_%s", "activation energy: rate = prefactor exp(-energy / temperature),",
    FIT(energy), FIT(energy_error) },
  { "log_prefactor_%s", "ln of the rate's prefactor at the temperature of the fit,",
    FIT(log_prefactor), FIT(log_prefactor_error) },
  { "prefactor_exponent_%s",
    "power of the temperature in the prefactor (0 +- 1/2 where the rates do not tell),",
    FIT(exponent), FIT(exponent_error) },
  { "fit_temperature_%s", "geometric mean of the fit's temperatures,", FIT(temperature), 0 },
  { "fit_chi2_%s", "chi squared of the fit,", FIT(chi2), 0 },
};

/* What the table says of a fit, after its energy if there is one. */
static const char *const verdicts[PENDRES_SWITCHING_VERDICTS] = {
  [PENDRES_SWITCHING_STRAIGHT] = "",
  [PENDRES_SWITCHING_BENT] = " (the rates scatter by more than their errors)",
  [PENDRES_SWITCHING_UNCHECKED] = " (from two temperatures: nothing checks the law)",
  [PENDRES_SWITCHING_TOO_FEW] = "too few events",
  [PENDRES_SWITCHING_NO_STATE] = "there is no such state",
  [PENDRES_SWITCHING_NO_BARRIER] =
    " (less than twice the temperature: no barrier to speak of)",
};

static double number_at(const void *record, size_t offset)
{
  double number;
  memcpy(&number, (const char *)record + offset, sizeof number);
  return number;
}

static pendres_status write_rates(scene_run *run, const work *w, int way, double *value,
                                  double *error)
{
  const size_t n = w->temperatures;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof of_rates / sizeof *of_rates && status == PENDRES_OK; k++) {
    char name[64], words[160];
    snprintf(name, sizeof name, of_rates[k].format, w->suffix[way]);
    snprintf(words, sizeof words, "%s %s", of_rates[k].words, w->words[way]);
    const pendres_store_spec spec = { .name = name, .dimensions = { "temperature" },
                                      .long_name = words };
    for (size_t i = 0; i < n; i++) {
      value[i] = number_at(&w->rates[i].way[way], of_rates[k].value);
      error[i] = number_at(&w->rates[i].way[way], of_rates[k].error);
    }
    status = of_rates[k].error > 0 ? pendres_store_put_result(run->store, &spec, value, error, n)
                                   : pendres_store_put(run->store, &spec, value, n);
  }
  return status;
}

static pendres_status write_verdict(scene_run *run, const work *w, int way)
{
  const char *meanings[PENDRES_SWITCHING_VERDICTS];
  const int8_t verdict = (int8_t)w->activation[way].verdict;
  const int32_t points = (int32_t)w->activation[way].points;
  char name[2][64], words[2][160];
  for (int k = 0; k < PENDRES_SWITCHING_VERDICTS; k++)
    meanings[k] = pendres_switching_verdict_name((pendres_switching_verdict)k);
  snprintf(name[0], sizeof name[0], "fit_%s", w->suffix[way]);
  snprintf(words[0], sizeof words[0], "%s %s",
           "what became of the fit of ln rate against 1/temperature,", w->words[way]);
  snprintf(name[1], sizeof name[1], "fit_points_%s", w->suffix[way]);
  snprintf(words[1], sizeof words[1], "%s %s", "temperatures with 10 events or more,",
           w->words[way]);
  const pendres_store_spec flag = { .name = name[0], .long_name = words[0],
                                    .type = PENDRES_STORE_INT8, .flag_meanings = meanings,
                                    .flag_count = PENDRES_SWITCHING_VERDICTS };
  const pendres_store_spec used = { .name = name[1], .long_name = words[1],
                                    .type = PENDRES_STORE_INT32 };
  const pendres_status status = pendres_store_put(run->store, &flag, &verdict, 1);
  return status == PENDRES_OK ? pendres_store_put(run->store, &used, &points, 1) : status;
}

static pendres_status write_fit(scene_run *run, const work *w, int way)
{
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof of_fits / sizeof *of_fits && status == PENDRES_OK; k++) {
    const double value = number_at(&w->activation[way], of_fits[k].value);
    const double error = number_at(&w->activation[way], of_fits[k].error);
    char name[64], words[160];
    snprintf(name, sizeof name, of_fits[k].format, w->suffix[way]);
    snprintf(words, sizeof words, "%s %s", of_fits[k].words, w->words[way]);
    const pendres_store_spec spec = { .name = name, .long_name = words };
    status = of_fits[k].error > 0 ? pendres_store_put_result(run->store, &spec, &value, &error, 1)
                                  : pendres_store_put(run->store, &spec, &value, 1);
  }
  return status == PENDRES_OK ? write_verdict(run, w, way) : status;
}

/* Exposures, steps, and the interval's level. */
static pendres_status write_circumstances(scene_run *run, const work *w, double *value)
{
  const pendres_store_spec confidence = { .name = "confidence_level",
                                          .long_name = "level of the confidence intervals" };
  const int32_t steps_per_period = w->steps[SA] > w->steps[LA] ? w->steps[SA] : w->steps[LA];
  const pendres_store_spec steps = { .name = "steps_per_period", .type = PENDRES_STORE_INT32,
                                     .long_name = "steps a drive period of the noisy integrator" };
  pendres_status status = pendres_store_put(run->store, &confidence, &level, 1);
  for (int s = 0; s < STATES && status == PENDRES_OK; s++) {
    char name[32], words[64];
    snprintf(name, sizeof name, "exposure_%s", w->name[s]);
    snprintf(words, sizeof words, "time spent on %s", w->state[s]);
    const pendres_store_spec spec = { .name = name, .dimensions = { "temperature" },
                                      .long_name = words };
    for (size_t i = 0; i < w->temperatures; i++) value[i] = w->rates[i].exposure[s];
    status = pendres_store_put(run->store, &spec, value, w->temperatures);
  }
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, &steps_per_period, 1);
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const deck_axis_id axes[] = { DECK_AXIS_TEMPERATURE };
  double *value = malloc(2 * w->temperatures * sizeof *value);
  if (value == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  for (int k = 0; k < WAYS && status == PENDRES_OK; k++)
    status = write_rates(run, w, k, value, value + w->temperatures);
  for (int k = 0; k < WAYS && status == PENDRES_OK; k++) status = write_fit(run, w, k);
  if (status == PENDRES_OK) status = write_circumstances(run, w, value);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
  free(value);
  if (status != PENDRES_OK) return status;
  return scene_failures_write(run, &w->failed, "failed", "switching", 1, axes);
}

/* A mean time and its error or, where nothing was seen, how long it is at least. */
static void print_time(FILE *out, const pendres_switching_rate *r)
{
  char text[32] = "-";
  if (r->events > 0.0) snprintf(text, sizeof text, "%.4g", r->mean_time);
  else if (r->upper > 0.0) snprintf(text, sizeof text, "> %.2g", 1.0 / r->upper);
  fprintf(out, "%-12s ", text);
  if (r->events > 0.0) fprintf(out, "%-9.2g ", r->mean_time_error);
  else fprintf(out, "%-9s ", "-");
}

static void print_table(FILE *out, const work *w)
{
  const int numbered = w->d->switching.from > 0;
  fprintf(out, "temperature  transition  rate         +-        mean time    +-        events\n");
  for (int k = 0; k < STATES; k++)
    for (size_t i = 0; i < w->temperatures; i++) {
      const pendres_switching_rate *r = &w->rates[i].way[k];
      char way[64];
      snprintf(way, sizeof way, "%s to %s", w->name[k], w->name[1 - k]);
      if (!numbered) snprintf(way, sizeof way, "%s", k == SA ? "SA to LA" : "LA to SA");
      fprintf(out, "%-12.5g %-11s %-12.4g %-9.2g ", w->rates[i].temperature, way, r->value,
              r->error);
      print_time(out, r);
      fprintf(out, "%.0f\n", r->events);
    }
  for (int k = 0; k < WAYS; k++) {
    const pendres_switching_activation *f = &w->activation[k];
    fprintf(out, "activation energy %s: ", w->words[k]);
    if (!isnan(f->energy)) fprintf(out, "%.5f +- %.5f", f->energy, f->energy_error);
    fprintf(out, "%s\n", verdicts[f->verdict]);
  }
}

static pendres_status run_scene(scene_run *run)
{
  work w = { .d = run->deck, .temperatures = run->deck->axis[DECK_AXIS_TEMPERATURE].count };
  name_ways(&w);
  pendres_status status = find_states(run, &w);
  if (status == PENDRES_OK) status = compute(run, &w);
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  pendres_attractors_free(w.set);
  scene_failures_free(&w.choices);
  scene_failures_free(&w.failed);
  free(w.sums);
  free(w.rates);
  return status;
}

const scene_kind scene_switching = {
  .kind = DECK_SWITCHING,
  .references = "S. A. Chin, Phys. Lett. A 226 (1997) 344; H. A. Forbert and S. A. Chin, Phys. "
                "Rev. E 63 (2000) 016703; J. K. Salmon et al., Parallel random numbers: as easy as "
                "1, 2, 3, SC11 (2011); H. A. Kramers, Physica 7 (1940) 284; M. I. Dykman and M. A. "
                "Krivoglaz, Sov. Phys. JETP 50 (1979) 30; N.-V. Buchete and G. Hummer, J. Phys. "
                "Chem. B 112 (2008) 6057; F. Garwood, Biometrika 28 (1936) 437",
  .plan = plan,
  .run = run_scene };
