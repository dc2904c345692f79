/*
 * switching.c -- how often noise carries a pendulum from the small-amplitude state to the
 * large-amplitude one and back, against temperature, and the activation energies.
 *
 * There is one task for each state, which chooses the steps a period; then one for each temperature
 * and part of the trajectories (switching.h). A temperature at which a part fails is marked and has
 * no results; all are, if the steps of a state cannot be chosen.
 */
#include <math.h>

#include "results/columns.h"
#include "scenes/points.h"

static const double level = 0.95; /* of confidence intervals */

/* Of a basin so many temperatures deep the activation energy is 60 of them at least: no transition
   is seen in 1e26 relaxations. */
static const double never = 200.0;

enum { SA, LA, STATES, WAYS = PENDRES_SWITCHING_WAYS };

typedef struct work {
  const deck *d;
  pendres_attractors *set;
  pendres_switching_survey survey;
  size_t temperatures, parts;
  scene_points choices;             /* [state] of int: steps a drive period; 0: no such state */
  scene_points counts;              /* [temperature][part] of pendres_switching_tally, */
  pendres_switching_tally *sums;    /* [temperature] which are added up here */
  pendres_switching_rates *rates;   /* [temperature] */
  pendres_switching_activation activation[WAYS];
  double depth[STATES];             /* of the states' basins, in linear theory */
  pendres_switching_way way[WAYS];  /* those that exist: to wells if there are any */
  int ways, told;                   /* how many, and how many the table tells */
  int escapes;                      /* to infinity; there are no other wells then */
  scene_points results;             /* [temperature]: which failed */
  char name[STATES][24], state[STATES][40]; /* of the states: "sa", "the small-amplitude state" */
  char suffix[WAYS][56], words[WAYS][120];  /* of the ways */
} work;

/* Between both states, and from either to another well or to infinity; of one state alone the
   latter. */
static void choose_ways(work *w)
{
  const pendres_pendulum p = deck_pendulum(w->d);
  const int alone = w->d->switching.from > 0 && w->d->switching.to == 0;
  w->escapes = pendres_pendulum_leaves(&p);
  const int wells = w->escapes || pendres_model_of(p.force)->period > 0.0;
  for (int k = alone ? PENDRES_SWITCHING_FIRST_WELL : 0; k < (wells ? WAYS : STATES); k++)
    if (!alone || k == PENDRES_SWITCHING_FIRST_WELL)
      w->way[w->ways++] = (pendres_switching_way)k;
  w->told = alone || w->escapes ? w->ways : STATES;
}

/* What the ways of switching are called: by the names of the states, or by their numbers. */
static void name_ways(work *w)
{
  static const char *const sizes[STATES] = { "small", "large" };
  static const struct { int from, to; } between[] = { { SA, LA }, { LA, SA } };
  const long number[STATES] = { (long)w->d->switching.from, (long)w->d->switching.to };
  choose_ways(w);
  for (int s = 0; s < STATES; s++) {
    if (number[SA] > 0) {
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
    snprintf(w->suffix[well], sizeof w->suffix[well], "%s_%s", w->escapes ? "escape" : "well",
             w->name[from]);
    snprintf(w->words[well], sizeof w->words[well], "from %s to %s", w->state[from],
             w->escapes ? "infinity" : "another well");
    if (number[SA] > 0)
      snprintf(w->words[k], sizeof w->words[k], "from %s to %s", w->state[from], w->state[to]);
    else
      snprintf(w->words[k], sizeof w->words[k], "from the %s- to the %s-amplitude state",
               sizes[from], sizes[to]);
  }
}

static void describe(const deck *d, FILE *out)
{
  const deck_axis *t = &d->axis[DECK_AXIS_TEMPERATURE];
  fprintf(out,
          "switching at damping %g, drive period %g, drive amplitude %g, at %zu temperatures\n"
          "%g to %g: %lld trajectories of %lld periods each, %.3g pendulum-periods in all\n",
          d->pendulum.damping, d->drive_period, d->pendulum.drive_amplitude, t->count,
          t->value[0], t->value[t->count - 1], (long long)d->noise.trajectories,
          (long long)d->noise.periods,
          (double)t->count * (double)d->noise.trajectories * (double)d->noise.periods);
}

/* ---- tasks --------------------------------------------------------------------------------- */

static void name_choice(const scene_points *p, size_t state, char *text, size_t size)
{
  const work *w = p->arg;
  snprintf(text, size, "steps for %s", w->state[state]);
}

static pendres_status choose(const scene_some *some)
{
  const work *w = some->of->arg;
  return pendres_switching_choose_steps(some->ctx, &w->survey, (int)some->first, some->rows);
}

static int check_choice(const scene_points *p, const void *row)
{
  (void)p;
  return scene_check_code(*(const int *)row, DECK_MAX_COUNT + 1);
}

static double temperature_of(const work *w, size_t part)
{
  return w->d->axis[DECK_AXIS_TEMPERATURE].value[part / w->parts];
}

static void name_count(const scene_points *p, size_t point, char *text, size_t size)
{
  const work *w = p->arg;
  snprintf(text, size, "temperature %.10g, part %zu", temperature_of(w, point),
           point % w->parts + 1);
}

static pendres_status count(const scene_some *some)
{
  const work *w = some->of->arg;
  if (w->survey.steps_per_period == 0) return PENDRES_OK; /* they could not be chosen */
  return pendres_switching_follow(some->ctx, &w->survey, temperature_of(w, some->first),
                                  some->first % w->parts, some->rows);
}

static int check_count(const scene_points *p, const void *row)
{
  (void)p;
  return ((const pendres_switching_tally *)row)->states <= PENDRES_SWITCHING_STATES;
}

/* A temperature of which parts fail is marked with the first failure. */
static pendres_status collect_count(const scene_points *p, size_t first, size_t n, const void *rows)
{
  work *w = p->arg;
  const size_t temperature = first / w->parts;
  (void)n;
  pendres_switching_add(&w->sums[temperature], rows);
  if (w->results.failed[temperature].reason == SCENE_FAILURE_NONE)
    w->results.failed[temperature] = p->failed[first];
  return PENDRES_OK;
}

/* The states to switch between: those that the deck numbers in the order of amplitude, from 1 on,
   or SA and LA. */
static pendres_status find_states(scene_run *run, work *w)
{
  const deck *d = w->d;
  const long wanted[STATES] = { (long)d->switching.from, (long)d->switching.to };
  const pendres_pendulum p = deck_pendulum(d);
  pendres_context *ctx = scene_context(run);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_status status = pendres_attractors_find(ctx, &p, 0, NULL, NULL, &w->set);
  if (status != PENDRES_OK)
    return scene_fail(run, status, "attractors: %s", pendres_context_message(ctx));
  const long count = (long)pendres_attractors_count(w->set);
  w->survey = (pendres_switching_survey){ .set = w->set, .level = level,
                                          .trajectories = (size_t)d->noise.trajectories,
                                          .periods = (long)d->noise.periods };
  pendres_switching_states(w->set, w->survey.state);
  if (w->ways == 0)
    return scene_fail(run, PENDRES_INVALID_ARGUMENT,
                      "this force has no wells that are alike: 'from' needs 'to' in &switching");
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

static int more_steps(const work *w)
{
  const int *steps = w->choices.rows;
  return steps[SA] > steps[LA] ? steps[SA] : steps[LA];
}

/* Steps for both states, since trajectories visit both; 0 if those of either are not known. */
static int steps_of(const work *w)
{
  for (int s = 0; s < STATES; s++)
    if (w->choices.failed[s].reason != SCENE_FAILURE_NONE) return 0;
  return more_steps(w);
}

/*
 * Rates at one temperature. There are none where a part of its trajectories failed, which has
 * marked the temperature already, or where the choice of steps failed, which marks all
 * temperatures. Where only one of both states exists there is nothing to switch to, and that is
 * said.
 */
static pendres_status conclude(work *w, size_t i)
{
  const int *state = w->survey.state;
  for (int s = STATES - 1; s >= 0; s--)
    if (w->choices.failed[s].reason != SCENE_FAILURE_NONE)
      w->results.failed[i] = w->choices.failed[s];
  const int broken = w->results.failed[i].reason != SCENE_FAILURE_NONE;
  const int both = w->way[0] == PENDRES_SWITCHING_FORTH;
  if (!broken && both && (state[SA] < 0 || state[LA] < 0))
    w->results.failed[i] = (scene_failed){
      SCENE_FAILURE_NOT_FOUND, state[SA] < 0 ? "there is no small-amplitude state"
                                             : "there is no large-amplitude state"};
  return pendres_switching_conclude(&w->survey, w->d->axis[DECK_AXIS_TEMPERATURE].value[i],
                                    broken ? NULL : &w->sums[i], &w->rates[i]);
}

/* Whether a state was left at a temperature, by any way. */
static int was_left(const work *w, int s, size_t i)
{
  for (int k = 0; k < w->ways; k++) {
    const int from = w->way[k] == PENDRES_SWITCHING_BACK ||
                     w->way[k] == PENDRES_SWITCHING_SECOND_WELL;
    if (from == s && w->rates[i].way[w->way[k]].events > 0.0) return 1;
  }
  return 0;
}

/* How deep the basins are of states that were not left at some temperature; NaN where that is not
   known. */
static void find_depths(scene_run *run, work *w)
{
  for (int s = 0; s < STATES; s++) {
    const int state = w->survey.state[s];
    int stayed = 0;
    for (size_t i = 0; i < w->temperatures; i++) stayed |= !was_left(w, s, i);
    pendres_context *ctx = stayed && state >= 0 ? scene_context(run) : NULL;
    w->depth[s] = NAN;
    if (ctx != NULL && pendres_switching_depth(ctx, w->set, (size_t)state, &w->depth[s]))
      w->depth[s] = NAN;
  }
}

static void compute(scene_run *run, work *w)
{
  pendres_status status = PENDRES_OK;
  find_states(run, w);
  w->parts = scene_going(run) ? pendres_switching_parts(&w->survey) : 1;
  w->sums = scene_array(run, w->temperatures, sizeof *w->sums);
  w->rates = scene_array(run, w->temperatures, sizeof *w->rates);
  w->results.failed = scene_array(run, w->temperatures, sizeof *w->results.failed);
  SCENE_COMPUTE(run, &w->choices, "choices of steps", .cheap = 1);
  if (scene_going(run)) w->survey.steps_per_period = steps_of(w);
  w->counts.n = w->temperatures * w->parts;
  SCENE_COMPUTE(run, &w->counts, "chunks", .last = 1);
  if (!scene_going(run)) return;
  for (size_t i = 0; i < w->temperatures && status == PENDRES_OK; i++) status = conclude(w, i);
  if (status == PENDRES_OK)
    status = pendres_switching_activate(&w->survey, w->temperatures, w->rates, w->activation);
  if (status != PENDRES_OK) scene_fail(run, status, "rates cannot be computed");
  if (scene_going(run)) find_depths(run, w);
}

/* ---- results ------------------------------------------------------------------------------- */

/* Of a rate, against temperature, and of a fit; * is the way, whose words follow. */
static const scene_column of_rates[] = {
  {.name = "rate_*", .quantity = "rate",
   .value = offsetof(pendres_switching_rate, value),
   .error = offsetof(pendres_switching_rate, error)},
  {SCENE_TYPED(SCENE_PLAIN, "rate_*_lower", pendres_switching_rate, lower,
               "lower end of the rate's confidence interval,"), .quantity = "rate"},
  {SCENE_TYPED(SCENE_PLAIN, "rate_*_upper", pendres_switching_rate, upper,
               "upper end of the rate's confidence interval,"), .quantity = "rate"},
  {SCENE_TYPED(SCENE_PLAIN, "events_*", pendres_switching_rate, events, "transitions counted")},
  {SCENE_TYPED(SCENE_PLAIN, "dispersion_*", pendres_switching_rate, dispersion,
               "variance of the trajectories' counts by that of independent events,")},
  {.name = "missed_*",
   .long_name = "share of the transitions that was not seen, which the rate allows for; its error "
                "is in the rate's, whatever the statistics;",
   .value = offsetof(pendres_switching_rate, missed),
   .error = offsetof(pendres_switching_rate, missed_error)},
};

static const scene_column of_fits[] = {
  {SCENE_AS("activation_energy_*", pendres_switching_activation, energy,
            "activation energy: rate = prefactor exp(-energy / temperature),",
            "activation_energy")},
  {SCENE_AS("log_prefactor_*", pendres_switching_activation, log_prefactor,
            "ln of the rate's prefactor at the temperature of the fit,", NULL)},
  {SCENE_AS("prefactor_exponent_*", pendres_switching_activation, exponent,
            "power of the temperature in the prefactor (0 +- 1/2 where the rates do not tell),",
            NULL)},
  {SCENE_TYPED(SCENE_PLAIN, "fit_temperature_*", pendres_switching_activation, temperature,
               "geometric mean of the fit's temperatures,"), .quantity = "temperature"},
  {SCENE_TYPED(SCENE_PLAIN, "fit_chi2_*", pendres_switching_activation, chi2,
               "chi squared of the fit,")},
  {SCENE_TYPED(SCENE_FLAG, "fit_*", pendres_switching_activation, verdict,
               "what became of the fit of ln rate against 1/temperature,"),
   .names = scene_switching_names},
  {SCENE_TYPED(SCENE_COUNT32, "fit_points_*", pendres_switching_activation, points,
               "temperatures with 10 events or more,")},
};

/* What the table says of a fit, after its energy if there is one. */
static const char *const verdicts[PENDRES_SWITCHING_VERDICTS] = {
  [PENDRES_SWITCHING_STRAIGHT] = "",
  [PENDRES_SWITCHING_BENT] = " (the rates scatter by more than their errors)",
  [PENDRES_SWITCHING_UNCHECKED] = " (from two temperatures: nothing checks the law)",
  [PENDRES_SWITCHING_TOO_FEW] = "too few events",
  [PENDRES_SWITCHING_NO_STATE] = "there is no such state",
  [PENDRES_SWITCHING_NO_BARRIER] =
    " (less than twice the temperature, this one or the way back: no barrier to speak of)",
  [PENDRES_SWITCHING_UNBALANCED] = " (the rates do not imply where trajectories end)",
};

/* Where trajectories end, by their basins and by the rates. */
static void write_occupation(scene_run *run, const work *w, int state)
{
  static const scene_column columns[] = {
    {SCENE_ESTIMATE("occupation_*", pendres_switching_rates, occupation[0],
                    "share of the trajectories that end in the basin of", NULL)},
    {SCENE_ESTIMATE("implied_occupation_*", pendres_switching_rates, implied[0],
                    "the same as the rates imply it, from where trajectories started, for", NULL)},
  };
  const char *first = (const char *)w->rates;
  const scene_table table = {
    .dimensions = {"temperature"}, .star = w->name[state], .words = w->state[state],
    .n = w->temperatures, .stride = sizeof *w->rates,
    .rows = first + (size_t)state * sizeof(pendres_langevin_estimate)};
  SCENE_WRITE(run, &table, columns);
}

/* Exposures, steps, and the interval's level. */
static void write_circumstances(scene_run *run, const work *w)
{
  static const scene_column exposure = {.name = "exposure_*", .long_name = "time spent on",
                                        .quantity = "exposure", .type = SCENE_PLAIN};
  static const scene_column depth = {
    .name = "linear_depth_*", .quantity = "activation_energy", .type = SCENE_PLAIN,
    .long_name = "depth of the basin, the widest ellipse in it by linear theory; an activation "
                 "energy is a third of it or more; where nothing was counted at some temperature, "
                 "of"};
  typedef struct whole {
    double level;
    int steps;
  } whole;
  static const scene_column confidence = {SCENE_TYPED(SCENE_PLAIN, "confidence_level", whole,
      level, "level of the confidence intervals")};
  static const scene_column steps = {SCENE_TYPED(SCENE_NUMBER, "steps_per_period", whole, steps,
                                                 "steps a drive period of the noisy integrator")};
  const whole of = {level, more_steps(w)};
  const scene_table scalars = {SCENE_ROWS(&of, 1)};
  scene_columns_write(run, &scalars, 1, &confidence);
  const int states = w->way[0] == PENDRES_SWITCHING_FORTH ? STATES : 1;
  for (int s = 0; s < states; s++) {
    const scene_table table = {
      .dimensions = {"temperature"}, .star = w->name[s], .words = w->state[s],
      .n = w->temperatures, .stride = sizeof *w->rates, .rows = &w->rates[0].exposure[s]};
    const scene_table of_state = {.star = w->name[s], .words = w->state[s],
                                  SCENE_ROWS(&w->depth[s], 1)};
    scene_columns_write(run, &table, 1, &exposure);
    scene_columns_write(run, &of_state, 1, &depth);
    write_occupation(run, w, s);
  }
  scene_columns_write(run, &scalars, 1, &steps);
}

static void write_results(scene_run *run, const work *w)
{
  if (!scene_going(run)) return;
  scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  for (int i = 0; i < w->ways; i++) {
    const pendres_switching_way k = w->way[i];
    const scene_table table = {
      .dimensions = {"temperature"}, .star = w->suffix[k], .words = w->words[k],
      .n = w->temperatures, .stride = sizeof *w->rates, .rows = &w->rates[0].way[k]};
    SCENE_WRITE(run, &table, of_rates);
  }
  for (int i = 0; i < w->ways; i++) {
    const pendres_switching_way k = w->way[i];
    const scene_table table = {.star = w->suffix[k], .words = w->words[k], .n = 1,
                               .stride = sizeof *w->activation, .rows = &w->activation[k]};
    SCENE_WRITE(run, &table, of_fits);
  }
  write_circumstances(run, w);
  scene_points_write_failed(run, &w->results, "failed",
                            "why there is no whole result for the switching");
}

/* A line of the table: one way at one temperature. */
typedef struct line {
  pendres_switching_rate rate;
  double temperature;
  char way[64];
  char mean_time[32], mean_time_error[32]; /* or, where nothing was seen, how long it is at least */
} line;

static line line_of(const work *w, pendres_switching_way k, size_t i)
{
  const pendres_switching_rate *r = &w->rates[i].way[k];
  line out = {.rate = *r, .temperature = w->rates[i].temperature, .mean_time = "-",
              .mean_time_error = "-"};
  if (k >= PENDRES_SWITCHING_FIRST_WELL)
    snprintf(out.way, sizeof out.way, "%s to %s", w->name[k - PENDRES_SWITCHING_FIRST_WELL],
             w->escapes ? "infinity" : "a well");
  else if (w->d->switching.from > 0)
    snprintf(out.way, sizeof out.way, "%s to %s", w->name[k], w->name[1 - k]);
  else
    snprintf(out.way, sizeof out.way, "%s", k == PENDRES_SWITCHING_FORTH ? "SA to LA" : "LA to SA");
  if (r->events > 0.0) {
    snprintf(out.mean_time, sizeof out.mean_time, "%.4g", r->mean_time);
    snprintf(out.mean_time_error, sizeof out.mean_time_error, "%.2g", r->mean_time_error);
  } else if (r->upper > 0.0) {
    snprintf(out.mean_time, sizeof out.mean_time, "> %.2g", 1.0 / r->upper);
  }
  return out;
}

/* Where nothing was seen since nothing can be, that is said: by the highest such temperature. */
static void print_hopeless(scene_run *run, const work *w, int s)
{
  const double *t = w->d->axis[DECK_AXIS_TEMPERATURE].value;
  size_t i = w->temperatures;
  while (i > 0 && !(w->depth[s] > never * t[i - 1] && !was_left(w, s, i - 1))) i--;
  if (i == 0) return;
  fprintf(run->table,
          "%s is not left in any time at temperatures up to %.5g: the activation energy is of "
          "the order of %.2g of them (linear theory). Its rates are bounds by the time counted.\n",
          w->state[s], t[i - 1], w->depth[s] / t[i - 1]);
}

static void print_table(scene_run *run, const work *w)
{
  static const scene_cell cells[] = {
    SCENE_CELL(line, temperature, "temperature  ", "%-12.5g "),
    {.heading = "transition      ", .format = "%-15s ", .type = SCENE_TEXT,
     .value = offsetof(line, way)},
    SCENE_CELL(line, rate.value, "rate         ", "%-12.4g "),
    SCENE_CELL(line, rate.error, "+-        ", "%-9.2g "),
    {.heading = "mean time    ", .format = "%-12s ", .type = SCENE_TEXT,
     .value = offsetof(line, mean_time)},
    {.heading = "+-        ", .format = "%-9s ", .type = SCENE_TEXT,
     .value = offsetof(line, mean_time_error)},
    SCENE_CELL(line, rate.events, "events", "%.0f"),
  };
  const size_t n = (size_t)w->told * w->temperatures;
  line *rows = scene_array(run, n, sizeof *rows);
  const scene_table table = {SCENE_ROWS(rows, n)};
  if (rows == NULL) return;
  for (size_t i = 0; i < n; i++)
    rows[i] = line_of(w, w->way[i / w->temperatures], i % w->temperatures);
  SCENE_PRINT(run->table, &table, n, cells, NULL);
  for (int i = 0; i < w->ways; i++) {
    const pendres_switching_way k = w->way[i];
    const pendres_switching_activation *f = &w->activation[k];
    fprintf(run->table, "activation energy %s: ", w->words[k]);
    if (!isnan(f->energy)) fprintf(run->table, "%.5f +- %.5f", f->energy, f->energy_error);
    fprintf(run->table, "%s\n", verdicts[f->verdict]);
  }
  for (int s = 0; s < STATES; s++) print_hopeless(run, w, s);
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.d = run->deck, .temperatures = run->deck->axis[DECK_AXIS_TEMPERATURE].count,
            .choices = {.n = STATES, .chunk = 1, .size = sizeof(int), .compute = choose,
                        .name = name_choice, .check = check_choice, .arg = &w},
            .counts = {.chunk = 1, .size = sizeof(pendres_switching_tally), .compute = count,
                       .name = name_count, .check = check_count, .collect = collect_count,
                       .arg = &w},
            .results = {.what = "switching"}};
  scene_points_over(&w.results, run->deck, 1, &(deck_axis_id){DECK_AXIS_TEMPERATURE});
  name_ways(&w);
  compute(run, &w);
  write_results(run, &w);
  if (scene_prints(run)) print_table(run, &w);
  pendres_attractors_free(w.set);
  return run->status;
}

const scene_kind scene_switching = {
  .kind = DECK_SWITCHING,
  .references = "; S. A. Chin, Phys. Lett. A 226 (1997) 344; H. A. Forbert and S. A. Chin, "
                "Phys. Rev. E 63 (2000) 016703; J. K. Salmon et al., Parallel random numbers: "
                "as easy as 1, 2, 3, SC11 (2011); H. A. Kramers, Physica 7 (1940) 284; M. I. "
                "Dykman and M. A. Krivoglaz, Sov. Phys. JETP 50 (1979) 30; N.-V. Buchete and G. "
                "Hummer, J. Phys. Chem. B 112 (2008) 6057; F. Garwood, Biometrika 28 (1936) 437",
  .budget = 1,
  .size = {.head = 55e3, .point = 400.0, .memory = 1e3, .stages = 1.0, .after = 1.0,
           .seconds = 2.0},
  .describe = describe,
  .run = run_scene };
