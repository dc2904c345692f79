/*
 * scene_switching.c -- how often noise carries a pendulum from the small-amplitude state to the
 * large-amplitude one and back, against temperature, and the activation energies.
 *
 * One task a state for the steps a period, then one a temperature, state and chunk of
 * trajectories. Half of all trajectories start on either state and go wherever noise
 * carries them; each stay counts for the state where it is. A temperature at which a chunk fails is
 * marked and has no results; so are all where the steps of a state cannot be chosen.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"
#include "scenes/scene_noise.h"

/* Steps are chosen on the states' small clouds, at one temperature. A bias of the cloud acts as
   a wrong temperature, and rates feel that E/T times stronger: so steps are doubled after the
   choice, and order four leaves a sixteenth of this. */
static const double bias_of_choice = 0.01, temperature_of_choice = 1e-4;
static const double level = 0.95;

enum { SA, LA, STARTS, WELLS = 2, KINDS = 4 };

typedef struct work {
  const deck *d;
  pendres_pendulum pendulum;
  pendres_attractors *set;
  int index[STARTS];      /* of the states in the set, those that the deck numbers or SA and LA;
                             -1: there is none */
  size_t temperatures, chunks;
  int steps[STARTS];      /* a drive period; 0 where there is no such state */
  pendres_switching_tally *sums;    /* [temperature] */
  pendres_switching_rate *rates;    /* [kind][temperature] */
  pendres_switching_activation fit[KINDS];
  scene_failures choices; /* [start] of the steps */
  scene_failures failed;  /* [temperature] */
  char name[STARTS][24], state[STARTS][40];   /* of the states: "sa", "the small-amplitude state" */
  char suffix[KINDS][56], words[KINDS][120];  /* of the kinds of transitions */
} work;

static const struct {
  int from, to; /* to: WELLS for another well */
} kinds[KINDS] = {{ SA, LA }, { LA, SA }, { SA, WELLS }, { LA, WELLS }};

/* What the kinds of transitions are called: by the names of the states, or by their numbers. */
static void name_kinds(work *w)
{
  static const char *const sizes[STARTS] = { "small", "large" };
  const deck *d = w->d;
  const long number[STARTS] = { (long)d->switching.from, (long)d->switching.to };
  for (int s = 0; s < STARTS; s++) {
    if (number[s] > 0) {
      snprintf(w->name[s], sizeof w->name[s], "%ld", number[s]);
      snprintf(w->state[s], sizeof w->state[s], "attractor %ld", number[s]);
    } else {
      snprintf(w->name[s], sizeof w->name[s], "%s", s == SA ? "sa" : "la");
      snprintf(w->state[s], sizeof w->state[s], "the %s-amplitude state", sizes[s]);
    }
  }
  for (int k = 0; k < KINDS; k++) {
    const int from = kinds[k].from, to = kinds[k].to;
    if (to == WELLS) {
      snprintf(w->suffix[k], sizeof w->suffix[k], "well_%s", w->name[from]);
      snprintf(w->words[k], sizeof w->words[k], "from %s to another well", w->state[from]);
    } else {
      snprintf(w->suffix[k], sizeof w->suffix[k], "%s_%s", w->name[from], w->name[to]);
      if (number[SA] > 0)
        snprintf(w->words[k], sizeof w->words[k], "from %s to %s", w->state[from], w->state[to]);
      else
        snprintf(w->words[k], sizeof w->words[k], "from the %s- to the %s-amplitude state",
                 sizes[from], sizes[to]);
    }
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

/* ---- computing ----------------------------------------------------------------------------- */

static pendres_pendulum pendulum_at(const work *w, size_t temperature)
{
  pendres_pendulum p = w->pendulum;
  p.temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[temperature];
  return p;
}

/* What the choice of a state's steps finds. */
typedef struct choice {
  int steps;
  scene_verdict verdict;
} choice;

/* What is counted of a chunk. */
typedef struct chunk {
  pendres_switching_tally tally;
  scene_verdict verdict;
} chunk;

static pendres_status choose(const void *arg, size_t task, pendres_context *ctx,
                             farm_record *out)
{
  enum { TRAJECTORIES = 192, RECORD = 60 };
  const work *w = arg;
  choice *c = out->data;
  if (w->index[task] < 0) return PENDRES_OK;
  const pendres_attractor *a = pendres_attractors_get(w->set, (size_t)w->index[task]);
  pendres_pendulum p = w->pendulum;
  pendres_switching_home home = { w->set, (size_t)w->index[task], 0.0 };
  pendres_langevin_bias bias;
  p.temperature = temperature_of_choice;
  const pendres_langevin_request request = {
    .pendulum = p, .x = a->orbit.x, .v = a->orbit.v, .trajectories = TRAJECTORIES,
    .settle = scene_noise_settle(&a->orbit), .record = RECORD,
    .first_id = scene_noise_first_id(&p, home.attractor),
    .leave = pendres_switching_leave, .arg = &home };
  const pendres_status status =
    scene_noise_choose_steps(ctx, &request, PENDRES_LANGEVIN_CLOUD, bias_of_choice, &bias);
  if (status == PENDRES_OK) c->steps = 2 * bias.steps_per_period;
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

/* The larger of the states' steps: trajectories visit both. */
static int steps_of(const work *w)
{
  return w->steps[SA] > w->steps[LA] ? w->steps[SA] : w->steps[LA];
}

/* Trajectories that start on a state. */
static size_t share(const work *w, int start)
{
  const size_t all = (size_t)w->d->noise.trajectories;
  if (w->index[start] < 0) return 0;
  if (w->index[1 - start] < 0) return all;
  return start == SA ? all - all / 2 : all / 2;
}

static pendres_status count(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  chunk *c = out->data;
  const size_t number = task % w->chunks, temperature = task / w->chunks / STARTS;
  const int start = (int)(task / w->chunks % STARTS);
  const size_t all = share(w, start);
  size_t first, n;
  if (number >= scene_noise_chunks(all)) return PENDRES_OK;
  for (int s = 0; s < STARTS; s++)
    if (w->choices.reason[s] != SCENE_FAILURE_NONE) return PENDRES_OK;
  scene_noise_chunk(all, number, &first, &n);
  const pendres_pendulum p = pendulum_at(w, temperature);
  const size_t from = (size_t)w->index[start];
  const pendres_switching_request request = {
    .pendulum = p, .set = w->set, .from = from, .trajectories = n,
    .periods = (long)w->d->noise.periods, .steps_per_period = steps_of(w),
    .first_id = scene_noise_first_id(&p, from) + first };
  const pendres_status status = pendres_switching_count(ctx, &request, &c->tally);
  return scene_verdict_note(&c->verdict, status, pendres_context_message(ctx));
}

/* A temperature of which a chunk fails has its first failure. */
static pendres_status collect_chunk(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const chunk *c = in->data;
  const size_t temperature = task / w->chunks / STARTS;
  if (c->tally.states > 0) pendres_switching_add(&w->sums[temperature], &c->tally);
  if (w->failed.reason[temperature] == SCENE_FAILURE_NONE)
    scene_failures_take(&w->failed, temperature, &c->verdict);
  return PENDRES_OK;
}

/* The states that the deck asks for by number: in the order of amplitude, from 1 on. */
static pendres_status find_numbered(scene_run *run, work *w)
{
  const long wanted[STARTS] = { (long)w->d->switching.from, (long)w->d->switching.to };
  const long count = (long)pendres_attractors_count(w->set);
  for (int s = 0; s < STARTS; s++) {
    if (wanted[s] > count)
      return scene_fail(run, PENDRES_NOT_FOUND,
                        "there is no attractor %ld at these parameters, but %ld", wanted[s], count);
    w->index[s] = (int)wanted[s] - 1;
  }
  return PENDRES_OK;
}

static pendres_status find_states(scene_run *run, work *w)
{
  pendres_context *ctx = farm_context(run->farm);
  if (ctx == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory");
  const pendres_status status =
    pendres_attractors_find(ctx, &w->pendulum, 0, NULL, NULL, &w->set);
  if (status != PENDRES_OK)
    return scene_fail(run, status, "attractors: %s", pendres_context_message(ctx));
  w->index[SA] = w->index[LA] = -1;
  if (w->d->switching.from > 0) return find_numbered(run, w);
  for (size_t i = 0; i < pendres_attractors_count(w->set); i++) {
    const pendres_label label = pendres_attractors_get(w->set, i)->label;
    if (label == PENDRES_LABEL_SA && w->index[SA] < 0) w->index[SA] = (int)i;
    if (label == PENDRES_LABEL_LA && w->index[LA] < 0) w->index[LA] = (int)i;
  }
  if (w->index[SA] < 0 && w->index[LA] < 0)
    return scene_fail(run, PENDRES_NOT_FOUND,
                      "neither a small- nor a large-amplitude state exists at these parameters: "
                      "'from' and 'to' in &switching take attractors by number");
  return PENDRES_OK;
}

/*
 * Temperatures have the failures of their chunks already. Where one state alone exists there is
 * nothing to switch to, and that is said; a choice of steps that failed is the failure of all.
 */
static void mark_failed(work *w)
{
  const int start = w->choices.reason[SA] != SCENE_FAILURE_NONE ? SA : LA;
  for (size_t i = 0; i < w->temperatures; i++) {
    if (w->failed.reason[i] == SCENE_FAILURE_NONE && (w->index[SA] < 0 || w->index[LA] < 0))
      scene_failures_mark(&w->failed, i, SCENE_FAILURE_NOT_FOUND,
                          w->index[SA] < 0 ? "there is no small-amplitude state"
                                           : "there is no large-amplitude state");
    if (w->choices.reason[start] != SCENE_FAILURE_NONE)
      scene_failures_mark(&w->failed, i, (scene_failure)w->choices.reason[start],
                          w->choices.words[start]);
  }
}

/* Did a part of its work fail? One whose other state does not exist still has rates. */
static int is_broken(const work *w, size_t temperature)
{
  const int no_state = w->index[SA] < 0 || w->index[LA] < 0;
  return w->failed.reason[temperature] != (no_state ? SCENE_FAILURE_NOT_FOUND : SCENE_FAILURE_NONE);
}

static pendres_status sum_up(work *w)
{
  const deck_axis *t = &w->d->axis[DECK_AXIS_TEMPERATURE];
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < KINDS; k++) {
    const int from = w->index[kinds[k].from];
    const int to = kinds[k].to == WELLS ? PENDRES_SWITCHING_WELL : w->index[kinds[k].to];
    pendres_switching_rate *r = w->rates + (size_t)k * w->temperatures;
    for (size_t i = 0; i < w->temperatures && status == PENDRES_OK; i++) {
      r[i] = (pendres_switching_rate){ NAN, NAN, NAN, NAN, NAN, NAN, NAN };
      if (from >= 0 && to >= 0 && !is_broken(w, i))
        status = pendres_switching_rate_of(&w->sums[i], (size_t)from, (size_t)to, level, &r[i]);
    }
    if (status == PENDRES_OK)
      status = pendres_switching_fit(w->temperatures, t->value, r, 0.0, &w->fit[k]);
    if (status == PENDRES_NOT_FOUND) status = PENDRES_OK; /* too few events: the file says so */
  }
  return status;
}

/* ---- results ------------------------------------------------------------------------------- */

enum { RATE, LOWER, UPPER, EVENTS, DISPERSION, PARTS };

static const struct {
  const char *format, *words;
} parts[PARTS] = {
  [RATE] = { "rate_%s", "transitions a unit time" },
  [LOWER] = { "rate_%s_lower", "lower end of the rate's confidence interval," },
  [UPPER] = { "rate_%s_upper", "upper end of the rate's confidence interval," },
  [EVENTS] = { "events_%s", "transitions counted" },
  [DISPERSION] = { "dispersion_%s",
                   "variance of the trajectories' counts by that of independent events," },
};

static double part_of(const pendres_switching_rate *r, int part)
{
  const double values[PARTS] = { [RATE] = r->value, [LOWER] = r->lower, [UPPER] = r->upper,
                                 [EVENTS] = r->events, [DISPERSION] = r->dispersion };
  return values[part];
}

static pendres_status write_rates(scene_run *run, const work *w, int kind, double *value,
                                  double *error)
{
  const pendres_switching_rate *r = w->rates + (size_t)kind * w->temperatures;
  pendres_status status = PENDRES_OK;
  for (int part = 0; part < PARTS && status == PENDRES_OK; part++) {
    char name[64], words[160];
    snprintf(name, sizeof name, parts[part].format, w->suffix[kind]);
    snprintf(words, sizeof words, "%s %s", parts[part].words, w->words[kind]);
    const pendres_store_spec spec = { .name = name, .dimensions = { "temperature" },
                                      .long_name = words };
    for (size_t i = 0; i < w->temperatures; i++) {
      value[i] = part_of(&r[i], part);
      error[i] = r[i].error;
    }
    status = part == RATE
               ? pendres_store_put_result(run->store, &spec, value, error, w->temperatures)
               : pendres_store_put(run->store, &spec, value, w->temperatures);
  }
  return status;
}

/* What became of a fit. */
enum {
  FIT_STRAIGHT,
  FIT_BENT,
  FIT_UNCHECKED,
  FIT_TOO_FEW,
  FIT_NO_STATE,
  FIT_NO_BARRIER,
  FIT_OUTCOMES
};

static const struct {
  const char *name, *words;
} outcomes[FIT_OUTCOMES] = {
  [FIT_STRAIGHT] = { "straight", "" },
  [FIT_BENT] = { "not_straight", " (the rates scatter by more than their errors)" },
  [FIT_UNCHECKED] = { "two_points", " (from two temperatures: nothing checks the law)" },
  [FIT_TOO_FEW] = { "too_few_events", "too few events" },
  [FIT_NO_STATE] = { "no_state", "there is no such state" },
  [FIT_NO_BARRIER] = { "no_barrier",
                       " (less than twice the temperature: no barrier to speak of)" },
};

/* A barrier of less than so many temperatures is no activation energy. */
static const double least_barrier = 2.0;

static int8_t fit_outcome(const work *w, int kind)
{
  const pendres_switching_activation *f = &w->fit[kind];
  const int to = kinds[kind].to;
  if (w->index[kinds[kind].from] < 0 || (to != WELLS && w->index[to] < 0)) return FIT_NO_STATE;
  if (isnan(f->energy)) return FIT_TOO_FEW;
  if (!(f->least_barrier >= least_barrier)) return FIT_NO_BARRIER;
  if (f->points < 3) return FIT_UNCHECKED;
  /* Three standard deviations of chi squared above its mean. */
  const double freedom = (double)f->points - 2.0;
  return f->chi2 > freedom + 3.0 * sqrt(2.0 * freedom) ? FIT_BENT : FIT_STRAIGHT;
}

static pendres_status write_fit(scene_run *run, const work *w, int kind)
{
  const char *meanings[FIT_OUTCOMES];
  const pendres_switching_activation *f = &w->fit[kind];
  const int8_t outcome = fit_outcome(w, kind);
  const int32_t points = (int32_t)f->points;
  enum { ENERGY, PREFACTOR, FLAG, CHI2, USED, EXPONENT, MIDDLE, NAMES };
  char name[NAMES][64], words[NAMES][160];
  static const char *const names[NAMES] = {
    "activation_energy_%s", "log_prefactor_%s", "fit_%s", "fit_chi2_%s", "fit_points_%s",
    "prefactor_exponent_%s", "fit_temperature_%s" };
  static const char *const about[NAMES] = {
    "activation energy: rate = prefactor exp(-energy / temperature),",
    "ln of the rate's prefactor at the temperature of the fit,",
    "what became of the fit of ln rate against 1/temperature,", "chi squared of the fit,",
    "temperatures with 10 events or more,",
    "power of the temperature in the prefactor (0 +- 1/2 where the rates do not tell),",
    "geometric mean of the fit's temperatures," };
  for (int k = 0; k < FIT_OUTCOMES; k++) meanings[k] = outcomes[k].name;
  for (int i = 0; i < NAMES; i++) {
    snprintf(name[i], sizeof name[i], names[i], w->suffix[kind]);
    snprintf(words[i], sizeof words[i], "%s %s", about[i], w->words[kind]);
  }
  const pendres_store_spec energy = { .name = name[ENERGY], .long_name = words[ENERGY] };
  const pendres_store_spec prefactor = { .name = name[PREFACTOR],
                                         .long_name = words[PREFACTOR] };
  const pendres_store_spec exponent = { .name = name[EXPONENT], .long_name = words[EXPONENT] };
  const pendres_store_spec middle = { .name = name[MIDDLE], .long_name = words[MIDDLE] };
  const pendres_store_spec flag = { .name = name[FLAG], .long_name = words[FLAG],
                                    .type = PENDRES_STORE_INT8, .flag_count = FIT_OUTCOMES,
                                    .flag_meanings = meanings };
  const pendres_store_spec chi2 = { .name = name[CHI2], .long_name = words[CHI2] };
  const pendres_store_spec used = { .name = name[USED], .long_name = words[USED],
                                    .type = PENDRES_STORE_INT32 };
  pendres_status status =
    pendres_store_put_result(run->store, &energy, &f->energy, &f->energy_error, 1);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(run->store, &prefactor, &f->log_prefactor,
                                      &f->log_prefactor_error, 1);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(run->store, &exponent, &f->exponent, &f->exponent_error, 1);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &middle, &f->temperature, 1);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &flag, &outcome, 1);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &chi2, &f->chi2, 1);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &used, &points, 1);
  return status;
}

/* Exposures, steps, and the interval's level. */
static pendres_status write_circumstances(scene_run *run, const work *w, double *value)
{
  const pendres_store_spec confidence = { .name = "confidence_level",
                                          .long_name = "level of the confidence intervals" };
  const int32_t steps_per_period = steps_of(w);
  const pendres_store_spec steps = { .name = "steps_per_period", .type = PENDRES_STORE_INT32,
                                     .long_name = "steps a drive period of the noisy integrator" };
  pendres_status status = pendres_store_put(run->store, &confidence, &level, 1);
  for (int s = 0; s < STARTS && status == PENDRES_OK; s++) {
    char name[32], words[64];
    snprintf(name, sizeof name, "exposure_%s", w->name[s]);
    snprintf(words, sizeof words, "time spent on %s", w->state[s]);
    const pendres_store_spec spec = { .name = name, .dimensions = { "temperature" },
                                      .long_name = words };
    for (size_t i = 0; i < w->temperatures; i++)
      value[i] = w->index[s] >= 0 && !is_broken(w, i)
                   ? w->sums[i].exposure[w->index[s]] * w->sums[i].period
                   : NAN;
    status = pendres_store_put(run->store, &spec, value, w->temperatures);
  }
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, &steps_per_period, 1);
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  double *value = malloc(2 * w->temperatures * sizeof *value);
  if (value == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  for (int k = 0; k < KINDS && status == PENDRES_OK; k++)
    status = write_rates(run, w, k, value, value + w->temperatures);
  for (int k = 0; k < KINDS && status == PENDRES_OK; k++) status = write_fit(run, w, k);
  if (status == PENDRES_OK) status = write_circumstances(run, w, value);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
  free(value);
  const deck_axis_id axes[] = { DECK_AXIS_TEMPERATURE };
  return status != PENDRES_OK
           ? status
           : scene_failures_write(run, &w->failed, "failed", "switching", 1, axes);
}

static void print_table(FILE *out, const work *w)
{
  const pendres_switching_rate *sa = w->rates, *la = w->rates + w->temperatures;
  char ways[STARTS][56] = { "SA to LA", "LA to SA" };
  for (int k = 0; k < STARTS && w->d->switching.from > 0; k++)
    snprintf(ways[k], sizeof ways[k], "%s to %s", w->name[k], w->name[1 - k]);
  fprintf(out, "temperature  %-13s +-        events   %-13s +-        events\n", ways[0], ways[1]);
  for (size_t i = 0; i < w->temperatures; i++)
    fprintf(out, "%-12.5g %-13.4g %-9.2g %-8.0f %-13.4g %-9.2g %.0f\n",
            w->d->axis[DECK_AXIS_TEMPERATURE].value[i], sa[i].value, sa[i].error, sa[i].events,
            la[i].value, la[i].error, la[i].events);
  for (int k = 0; k < KINDS; k++) {
    const pendres_switching_activation *f = &w->fit[k];
    fprintf(out, "activation energy %s: ", w->words[k]);
    if (!isnan(f->energy)) fprintf(out, "%.5f +- %.5f", f->energy, f->energy_error);
    fprintf(out, "%s\n", outcomes[fit_outcome(w, k)].words);
  }
}

static pendres_status compute(scene_run *run, work *w)
{
  const size_t n = w->temperatures * STARTS;
  const size_t sa = scene_noise_chunks(share(w, SA)), la = scene_noise_chunks(share(w, LA));
  w->chunks = sa > la ? sa : la;
  w->sums = calloc(w->temperatures, sizeof *w->sums);
  w->rates = calloc(KINDS * w->temperatures, sizeof *w->rates);
  if (w->sums == NULL || w->rates == NULL ||
      scene_failures_create(STARTS, &w->choices) != PENDRES_OK ||
      scene_failures_create(w->temperatures, &w->failed) != PENDRES_OK)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu tasks", n * w->chunks);
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "choices of steps", .tasks = STARTS, .task = choose,
                                      .record_size = sizeof(choice), .collect = collect_choice,
                                      .arg = w });
  if (status == PENDRES_OK)
    status = scene_compute(run, &(farm_stage){ .what = "chunks", .tasks = n * w->chunks,
                                               .task = count, .record_size = sizeof(chunk),
                                               .collect = collect_chunk, .arg = w });
  if (status != PENDRES_OK) return status;
  mark_failed(w);
  status = sum_up(w);
  if (status != PENDRES_OK) return scene_fail(run, status, "rates cannot be computed");
  return status;
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  work w = { .d = d,
             .pendulum = { .damping = d->pendulum.damping,
                           .drive_amplitude = d->pendulum.drive_amplitude,
                           .drive_frequency = d->pendulum.drive_frequency },
             .temperatures = d->axis[DECK_AXIS_TEMPERATURE].count };
  name_kinds(&w);
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
