/* scene_basins_write.c -- the file and the table of scene `basins`; see scene_basins.h. */
#include "scenes/scene_basins.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { QUICK = 1 /* compression of what there is most of: higher levels gain little */ };

static const char *const label_names[] = {"sa",      "la",      "periodic",
                                          "running", "chaotic", "unresolved"};

/* ---- states -------------------------------------------------------------------------------- */

/* The variable number k of every state, in a group with the given dimensions. */
static pendres_store_spec state_spec(int k, const char *group, const char *second)
{
  pendres_store_spec s = {.group = group, .dimensions = {"x", second}, .deflate = QUICK};
  switch (k) {
  case BASINS_LABEL:
    s.name = "label";
    s.long_name = "what the pendulum settles on";
    s.type = PENDRES_STORE_INT8;
    s.flag_count = PENDRES_LABEL_COUNT;
    s.flag_meanings = label_names;
    break;
  case BASINS_ATTRACTOR:
    s.name = "attractor_index";
    s.long_name = "number of the attractor that the pendulum settles on";
    s.comment = "-1: unresolved";
    s.type = PENDRES_STORE_INT32;
    break;
  case BASINS_WELL:
    s.name = "well";
    s.long_name = "number of the well that the pendulum settles in";
    s.comment = "0 for running and chaotic pendulums";
    s.type = PENDRES_STORE_INT32;
    break;
  case BASINS_FAILED:
    s.name = "failed";
    s.long_name = "why there is no label for the state";
    scene_failure_flags(&s);
    break;
  default:
    s.name = "settling_periods";
    s.long_name = "drive periods until the pendulum is inside its attractor's trapping region";
    s.comment = "-1: unresolved; -2: filled in by refinement, not integrated";
    s.type = PENDRES_STORE_INT32;
    break;
  }
  return s;
}

pendres_status basins_define(basins *b)
{
  pendres_status status = scene_dimension(b->run, "", DECK_AXIS_X);
  if (status == PENDRES_OK) status = scene_dimension(b->run, "", DECK_AXIS_V);
  if (status != PENDRES_OK) return status;
  for (int k = 0; k < BASINS_VARIABLES && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = state_spec(k, "", "v");
    status = pendres_store_variable(b->run->store, &spec, &b->variable[k]);
  }
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

static int32_t state_value(const pendres_basin_state *s, int k)
{
  return k == BASINS_ATTRACTOR ? s->attractor : k == BASINS_WELL ? s->well : s->settling_periods;
}

/* One variable of n states as an array for the store; int8 for what has flags, else int32. */
static const void *pack(size_t n, const pendres_basin_state *state, int k, int32_t *values)
{
  int8_t *labels = (int8_t *)values;
  for (size_t i = 0; i < n; i++) {
    if (k == BASINS_LABEL) labels[i] = state[i].label;
    else if (k == BASINS_FAILED)
      labels[i] = state[i].attractor < 0 ? SCENE_FAILURE_UNRESOLVED : SCENE_FAILURE_NONE;
    else values[i] = state_value(&state[i], k);
  }
  return values;
}

pendres_status basins_write_rows(basins *b, size_t first, size_t rows,
                                 const pendres_basin_state *state)
{
  enum { ROWS = 256 };
  const size_t nv = b->grid.nv;
  pendres_status status = PENDRES_OK;
  int32_t *values = malloc((rows < ROWS ? rows : ROWS) * nv * sizeof *values);
  if (values == NULL) return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for rows");
  for (size_t i = 0; i < rows && status == PENDRES_OK; i += ROWS) {
    const size_t some = rows - i < ROWS ? rows - i : ROWS;
    for (int k = 0; k < BASINS_VARIABLES && status == PENDRES_OK; k++)
      status =
        pendres_store_write_rows(b->run->store, b->variable[k], first + i, some,
                                 pack(some * nv, state + i * nv, k, values), some * nv);
  }
  free(values);
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

static pendres_status write_cut(basins *b)
{
  const size_t n = b->grid.nx;
  pendres_status status = scene_dimension(b->run, "cut", DECK_AXIS_X);
  if (status != PENDRES_OK) return status;
  int32_t *values = malloc(n * sizeof *values);
  if (values == NULL) return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for a line");
  for (int k = 0; k < BASINS_VARIABLES && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = state_spec(k, "cut", NULL);
    status = pendres_store_put(b->run->store, &spec, pack(n, b->cut, k, values), n);
  }
  if (status == PENDRES_OK)
    status = pendres_store_attribute_text(b->run->store, "cut", NULL, "description",
                                          "the line v = 0");
  free(values);
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

/* ---- attractors ---------------------------------------------------------------------------- */

/* Results of an attractor: a value and its error by their offsets in pendres_attractor. */
#define ORBIT(name, text, unit)                                                                 \
  {"attractor_" #name, text, unit, offsetof(pendres_attractor, orbit.name),                     \
   offsetof(pendres_attractor, orbit.name##_error)}

static const struct {
  const char *name, *long_name, *units;
  size_t value, error;
} fields[] = {
  ORBIT(x, "position at drive phase 0, in well 0", "rad"),
  ORBIT(v, "velocity at drive phase 0", "1"),
  ORBIT(amplitude, "amplitude of the angle", "rad"),
  ORBIT(phase_lag, "phase lag of the angle's first harmonic", "rad"),
  ORBIT(loop_area, "loop area a drive cycle", "1"),
  {"attractor_lyapunov", "largest Lyapunov exponent a unit time", "1",
   offsetof(pendres_attractor, lyapunov), offsetof(pendres_attractor, lyapunov_error)},
  {"attractor_drift", "mean whole turns a drive period, of chaos", "1",
   offsetof(pendres_attractor, drift), offsetof(pendres_attractor, drift_error)},
};

/* What is said of a verdict itself, without an error. */
static const struct {
  const char *name, *long_name;
  size_t value;
} verdicts[] = {
  {"attractor_watched_periods",
   "drive periods that chaos was watched for without ending, all walkers together",
   offsetof(pendres_attractor, watched_periods)},
  {"attractor_escape_rate_bound",
   "largest rate of ending of chaos, a drive period, that is not excluded at 95 %",
   offsetof(pendres_attractor, escape_rate_bound)},
};

static double field(const pendres_attractor *a, size_t offset)
{
  double value;
  memcpy(&value, (const char *)a + offset, sizeof value);
  return value;
}

static pendres_status write_fields(const basins *b, size_t n, double *value, double *error)
{
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof fields / sizeof fields[0] && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = fields[k].name, .dimensions = {"attractor"},
                                     .long_name = fields[k].long_name, .units = fields[k].units};
    for (size_t i = 0; i < n; i++) {
      const pendres_attractor *a = pendres_attractors_get(b->set, i);
      value[i] = field(a, fields[k].value);
      error[i] = field(a, fields[k].error);
    }
    status = pendres_store_put_result(b->run->store, &spec, value, error, n);
  }
  for (size_t k = 0; k < sizeof verdicts / sizeof verdicts[0] && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = verdicts[k].name, .dimensions = {"attractor"},
                                     .long_name = verdicts[k].long_name, .units = "1"};
    for (size_t i = 0; i < n; i++)
      value[i] = field(pendres_attractors_get(b->set, i), verdicts[k].value);
    status = pendres_store_put(b->run->store, &spec, value, n);
  }
  return status;
}

static pendres_status write_integers(const basins *b, size_t n, int32_t *value)
{
  static const struct { const char *name, *long_name; } names[] = {
    {"attractor_period", "drive periods until the orbit closes; 0: it does not"},
    {"attractor_winding", "whole turns in that time"}};
  int8_t *label = (int8_t *)value;
  for (size_t i = 0; i < n; i++) label[i] = (int8_t)pendres_attractors_get(b->set, i)->label;
  const pendres_store_spec labels = {.name = "attractor_label", .dimensions = {"attractor"},
                                     .long_name = "kind of attractor", .type = PENDRES_STORE_INT8,
                                     .flag_count = PENDRES_LABEL_COUNT,
                                     .flag_meanings = label_names};
  pendres_status status = pendres_store_put(b->run->store, &labels, label, n);
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = names[k].name, .dimensions = {"attractor"},
                                     .long_name = names[k].long_name, .type = PENDRES_STORE_INT32};
    for (size_t i = 0; i < n; i++) {
      const pendres_orbit *o = &pendres_attractors_get(b->set, i)->orbit;
      value[i] = k == 0 ? o->period : o->winding;
    }
    status = pendres_store_put(b->run->store, &spec, value, n);
  }
  return status;
}

static pendres_status write_attractors(basins *b, const double *fraction, const double *error)
{
  const size_t n = pendres_attractors_count(b->set);
  double *value = malloc((2 * n + 1) * sizeof *value);
  pendres_status status = PENDRES_OK;
  if (value == NULL)
    return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  status = pendres_store_dimension(b->run->store, "", "attractor", n, NULL,
                                   "attractor, by amplitude, then by position", "1");
  if (status == PENDRES_OK) status = write_integers(b, n, (int32_t *)value);
  if (status == PENDRES_OK) status = write_fields(b, n, value, value + n);
  const pendres_store_spec spec = {.name = "basin_fraction", .dimensions = {"attractor"},
                                   .long_name = "share of the window's area", .units = "1",
                                   .comment = "each state stands for what is nearest to it: ends "
                                              "of a range count half; plain counts are "
                                              "basin_states"};
  if (status == PENDRES_OK)
    status = pendres_store_put_result(b->run->store, &spec, fraction, error, n);
  if (status == PENDRES_OK) status = basins_write_wells(b, n);
  free(value);
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

/* ---- statistics ---------------------------------------------------------------------------- */

static pendres_status put_scalar(pendres_store *store, const char *name, const char *long_name,
                                 double value, double error)
{
  const pendres_store_spec spec = {.name = name, .long_name = long_name};
  return pendres_store_put_result(store, &spec, &value, &error, 1);
}

static pendres_status put_count(pendres_store *store, const char *name, const char *long_name,
                                size_t count)
{
  const int64_t value = (int64_t)count;
  const pendres_store_spec spec = {.name = name, .long_name = long_name,
                                   .type = PENDRES_STORE_INT64};
  return pendres_store_put(store, &spec, &value, 1);
}

/* Random states, and distances, which depend on the tolerance alone. */
enum { RANDOM_STATES = 16384, RANDOM_SCALES = 5 };

static double random_distance(const basins *b, int k)
{
  static const double apart = 6.0;
  return fmin(1e3 * b->d->precision.tolerance, 1e-4) * pow(apart, k);
}

/*
 * Whether random states tell more of the exponent, which is a limit of small distances, than the
 * grid does. A fractal boundary fills a grid at every distance that the grid has, or is not yet
 * the power that it becomes; but random states meet it at distances far below the grid's step.
 * A smooth one they meet too rarely there. A grid whose v is not evenly spaced has no exponent.
 */
static int random_states_tell_more(const basins *b, const pendres_basin_statistics *s)
{
  enum { MET = 50 /* twice what makes a share worth fitting */ };
  if (!(s->boundary_boxes > 0.0)) return 0;
  /* States that are uncertain have a boundary as near as rounding: shares are no power above. */
  if (3 * s->uncertain_states > s->states) return 0;
  if (!isfinite(s->uncertainty_exponent_error)) return 1;
  const double nearer = random_distance(b, 0) / s->distance[0];
  return nearer < 1.0 &&
         RANDOM_STATES * s->uncertain[0] * pow(nearer, s->uncertainty_exponent) > MET;
}

static pendres_status sample_boundary(basins *b, pendres_basin_statistics *s)
{
  enum { SEED = 1 };
  const pendres_basin_grid *g = &b->grid;
  const pendres_basin_window window = {.x_low = g->x[0], .x_high = g->x[g->nx - 1],
                                       .v_low = g->v[0], .v_high = g->v[g->nv - 1],
                                       .by = g->by};
  double distance[RANDOM_SCALES];
  pendres_basin_statistics random;
  for (int k = 0; k < RANDOM_SCALES; k++) distance[k] = random_distance(b, k);
  pendres_context *ctx = farm_context(b->run->farm);
  if (ctx == NULL) return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory");
  const pendres_status status =
    pendres_basin_uncertainty(ctx, b->set, &window, RANDOM_STATES, RANDOM_SCALES, distance, SEED,
                              &random);
  if (status == PENDRES_NOT_FOUND) return PENDRES_OK; /* none this way: the grid's, if any */
  if (status != PENDRES_OK) return scene_fail(b->run, status, "%s", pendres_context_message(ctx));
  b->random_states = random.states;
  s->uncertainty_exponent = random.uncertainty_exponent;
  s->uncertainty_exponent_error = random.uncertainty_exponent_error;
  s->scales = random.scales;
  memcpy(s->distance, random.distance, sizeof s->distance);
  memcpy(s->uncertain, random.uncertain, sizeof s->uncertain);
  memcpy(s->uncertain_error, random.uncertain_error, sizeof s->uncertain_error);
  return PENDRES_OK;
}

static pendres_status write_statistics(basins *b, const pendres_basin_statistics *s)
{
  pendres_store *store = b->run->store;
  pendres_status status =
    put_scalar(store, "basin_entropy", "basin entropy over boxes of 5 x 5 states", s->entropy,
               s->entropy_error);
  if (status == PENDRES_OK)
    status = put_scalar(store, "boundary_basin_entropy",
                        "basin entropy over boxes with a boundary; above log 2 it is fractal",
                        s->boundary_entropy, s->boundary_entropy_error);
  if (status == PENDRES_OK)
    status = put_scalar(store, "uncertainty_exponent",
                        "exponent of the share of uncertain states over distance",
                        s->uncertainty_exponent, s->uncertainty_exponent_error);
  if (status == PENDRES_OK)
    status = put_count(store, "uncertainty_random_states",
                       "random states that the exponent is from; 0: the states of the grid",
                       b->random_states);
  if (status == PENDRES_OK && s->scales > 0) {
    const pendres_store_spec spec = {.name = "uncertain_fraction", .dimensions = {"distance"},
                                     .long_name = "share of states with an unlike one so far off"};
    status = pendres_store_dimension(store, "", "distance", (uint64_t)s->scales, s->distance,
                                     "distance in initial velocity", "1");
    if (status == PENDRES_OK)
      status = pendres_store_put_result(store, &spec, s->uncertain, s->uncertain_error,
                                        (size_t)s->scales);
  }
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

static pendres_status write_counts(basins *b)
{
  pendres_store *store = b->run->store;
  const size_t states = b->grid.nx * b->grid.nv;
  pendres_status status = put_count(store, "unresolved_states", "states without an attractor",
                                    b->unresolved);
  if (status == PENDRES_OK)
    status = put_count(store, "uncertain_states",
                       "integrated states that may go to another attractor, or well",
                       b->uncertain);
  if (status == PENDRES_OK && b->d->basins.refine) {
    status = put_count(store, "integrated_states", "states that were integrated", b->integrated);
    if (status == PENDRES_OK)
      status = put_count(store, "filled_states", "states that were filled in",
                         states - b->integrated);
    if (status == PENDRES_OK)
      status = put_count(store, "verified_states", "filled states that were integrated as a check",
                         b->verified);
    if (status == PENDRES_OK)
      status = put_count(store, "verification_misses",
                         "verified states that had been filled in wrongly, and were put right with "
                         "their surroundings until a fresh sample was clean", b->missed);
    if (status == PENDRES_OK)
      status = put_count(store, "suspected_states",
                         "filled states that may be wrong at most, with a confidence of 95 %",
                         (size_t)ceil(pendres_basin_plan_suspected(b->filled, b->clean)));
  }
  return status == PENDRES_OK ? status : scene_store_failed(b->run, status);
}

/* ---- what the paper says ------------------------------------------------------------------- */

/* Share of the starts at rest between two positions that settle on `label` in well 0. */
static double share_between(const basins *b, double low, double high, pendres_label label)
{
  size_t all = 0, there = 0;
  for (size_t i = 0; i < b->grid.nx; i++) {
    if (b->grid.x[i] < low || b->grid.x[i] > high) continue;
    all++;
    there += b->cut[i].label == (int8_t)label && (label != PENDRES_LABEL_SA || b->cut[i].well == 0);
  }
  return all > 0 ? (double)there / (double)all : NAN;
}

static pendres_status write_paper(basins *b)
{
  const pendres_pendulum *p = &b->pendulum;
  if (fabs(p->damping - 0.12) > 1e-12 || fabs(p->drive_amplitude - 0.2) > 1e-12 ||
      fabs(p->drive_frequency - 0.25 * PENDRES_PI) > 1e-12)
    return PENDRES_OK;
  const scene_printed values[] = {
    {.name = "attractors", .printed = 2.0, .computed = (double)pendres_attractors_count(b->set)},
    {.name = "share_sa_x_0.2pi_to_1.1pi", .printed = 1.0,
     .computed = share_between(b, 0.2 * PENDRES_PI, 1.1 * PENDRES_PI, PENDRES_LABEL_SA)},
    {.name = "share_la_x_-0.3pi_to_0", .printed = 1.0,
     .computed = share_between(b, -0.3 * PENDRES_PI, 0.0, PENDRES_LABEL_LA)}};
  return scene_write_paper(b->run, 3, values);
}

/* ---- the table ----------------------------------------------------------------------------- */

/* What a closed orbit has and a chaotic attractor has not. */
static void print_orbit(FILE *out, const pendres_orbit *o)
{
  if (o->period > 0)
    fprintf(out, "%4d %6d   %.8f   %.8f", o->period, o->winding, o->amplitude, o->phase_lag);
  else
    fprintf(out, "%4s %6s   %-10s   %-10s", "-", "-", "-", "-");
}

static void print_statistics(FILE *out, const pendres_basin_statistics *s, pendres_basin_end by)
{
  if (!(s->boundary_boxes > 0.0)) {
    if (isnan(s->boundary_boxes)) fprintf(out, "too few states for statistics of the boundary\n");
    else
      fprintf(out, "no boundary between basins of different %s\n",
              by == PENDRES_BASIN_BY_WELL ? "wells" : "attractors");
    return;
  }
  fprintf(out, "boundary basin entropy %.4f +- %.4f, uncertainty exponent ", s->boundary_entropy,
          s->boundary_entropy_error);
  if (isnan(s->uncertainty_exponent))
    fprintf(out, "unknown: boundary met too rarely, or nearly everywhere\n");
  else fprintf(out, "%.3f +- %.3f\n", s->uncertainty_exponent, s->uncertainty_exponent_error);
}

static void print_table(const basins *b, const pendres_basin_statistics *s, const double *fraction,
                        const double *error)
{
  FILE *out = b->run->table;
  if (out == NULL) return;
  fprintf(out, "attractor   period winding amplitude    phase lag    Lyapunov exponent     "
               "share of the area\n");
  for (size_t i = 0; i < pendres_attractors_count(b->set); i++) {
    const pendres_attractor *a = pendres_attractors_get(b->set, i);
    fprintf(out, "%2zu %-10s", i, pendres_label_name(a->label));
    print_orbit(out, &a->orbit);
    fprintf(out, "   %9.6f +- %.0e   %.6f +- %.0e\n", a->lyapunov, a->lyapunov_error, fraction[i],
            error[i]);
    if (a->label == PENDRES_LABEL_CHAOTIC)
      fprintf(out, "   watched for %.3g drive periods: chaos that ends at a rate above %.1e would "
                   "have been seen to\n", a->watched_periods, a->escape_rate_bound);
  }
  fprintf(out, "%zu states, %zu unresolved, %zu uncertain\n", s->states, b->unresolved,
          s->uncertain_states);
  if (b->d->basins.refine)
    fprintf(out,
            "integrated %zu (%.2f %%), filled in and verified %zu of them: %zu wrong%s,\n"
            "of %zu that are filled in at most %.0f are wrong with a confidence of 95 %%\n",
            b->integrated, 100.0 * (double)b->integrated / (double)s->states, b->verified,
            b->missed, b->missed > 0 ? " and put right" : "", b->filled,
            ceil(pendres_basin_plan_suspected(b->filled, b->clean)));
  basins_print_wells(b, out);
  if (b->d->basins.statistics) print_statistics(out, s, b->grid.by);
  if (b->curve != NULL) fprintf(out, "boundary as a curve: %s\n", b->curve);
}

pendres_status basins_write_results(basins *b)
{
  const size_t n = pendres_attractors_count(b->set);
  pendres_basin_statistics s;
  double *fraction = malloc((2 * n + 1) * sizeof *fraction);
  if (fraction == NULL)
    return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  pendres_status status = pendres_basin_sums_result(b->sums, &s, fraction, fraction + n);
  if (status != PENDRES_OK) (void)scene_fail(b->run, status, "there are no states");
  b->uncertain = status == PENDRES_OK ? s.uncertain_states : 0;
  if (status == PENDRES_OK && b->d->basins.statistics && random_states_tell_more(b, &s))
    status = sample_boundary(b, &s);
  if (status == PENDRES_OK) status = write_attractors(b, fraction, fraction + n);
  if (status == PENDRES_OK) status = write_cut(b);
  if (status == PENDRES_OK) status = write_counts(b);
  if (status == PENDRES_OK && b->d->basins.statistics) status = write_statistics(b, &s);
  if (status == PENDRES_OK && b->d->basins.boundary) status = basins_write_boundary(b);
  if (status == PENDRES_OK) status = write_paper(b);
  if (status == PENDRES_OK) print_table(b, &s, fraction, fraction + n);
  free(fraction);
  return status;
}
