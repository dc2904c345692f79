/*
 * basins.c -- basins of attraction over a grid of initial states; the paper's Fig. 7.
 *
 * A task integrates all states of some rows or, with refine, a slice of the states that a plan
 * (basin.h) asks for. Rows are written as they are finished, so that memory stays bounded. From
 * states that stay unresolved, attractors are looked for that the initial guesses have missed; if
 * there are any, all rows are computed again with them, so that results do not depend on who found
 * what.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/basins/basins.h"
#include "scenes/numbers.h"
#include "scenes/points.h"

/* ---- what is computed ---- */

static void describe(const deck *d, FILE *out)
{
  const deck_axis *x = &d->axis[DECK_AXIS_X], *v = &d->axis[DECK_AXIS_V];
  fprintf(out,
          "basins of %zu x %zu = %.4g initial states, x %g to %g, v %g to %g,\n"
          "damping %g, drive amplitude %g, drive frequency %.6g%s\n",
          x->count, v->count, (double)x->count * (double)v->count, x->value[0],
          x->value[x->count - 1], v->value[0], v->value[v->count - 1], d->pendulum.damping,
          d->pendulum.drive_amplitude, d->pendulum.drive_frequency,
          d->basins.refine ? "; refined where neighbours differ" : "");
  if (strcmp(d->basins.by, "well") == 0)
    fprintf(out, "statistics tell wells of an attractor apart\n");
}

/* ---- states ---- */

/* Unresolved states that are remembered, TASK_LOST at most of each group of rows. */
typedef struct lost {
  size_t n, *index;
  size_t group, most; /* the number of the latest group, and of states with those of it */
} lost;

/* States that are integrated together: of whole rows of the grid, or those that are asked for. */
typedef struct states {
  basins *b;
  const size_t *index;     /* numbers of those that are asked for; NULL: the grid, in its order */
  scene_points points;     /* of pendres_basin_state */
  lost lost;               /* of the grid */
} states;

static size_t number_of(const states *s, size_t point)
{
  return s->index != NULL ? s->index[point] : point;
}

static void name_state(const basins *b, size_t index, char *text, size_t size)
{
  snprintf(text, size, "x %.10g, v %.10g", b->grid.x[index / b->grid.nv],
           b->grid.v[index % b->grid.nv]);
}

static void name_point(const scene_points *p, size_t point, char *text, size_t size)
{
  const states *s = p->arg;
  name_state(s->b, number_of(s, point), text, size);
}

/* A state that the budget has ended. */
static const pendres_basin_state given_up = {.settling_periods = BASINS_GIVEN_UP,
                                             .attractor = PENDRES_ATTRACTOR_UNKNOWN,
                                             .label = PENDRES_LABEL_UNRESOLVED};

static int check(const scene_points *p, const void *row)
{
  const states *s = p->arg;
  return scene_check_basin_state(row, pendres_attractors_count(s->b->set));
}

/* By their numbers. */
static pendres_status find_states(const scene_some *some)
{
  const states *s = some->of->arg;
  const basins *b = s->b;
  if (s->index != NULL)
    return pendres_basin_states(some->ctx, b->set, &b->grid, some->n, s->index + some->first,
                                some->rows);
  size_t *index = scene_room_take(some->room, some->n, sizeof *index);
  if (index == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < some->n; i++) index[i] = some->first + i;
  return pendres_basin_states(some->ctx, b->set, &b->grid, some->n, index, some->rows);
}

/* ---- whole grids ---- */

/* Finish those that had been deferred. */
static pendres_status finish_rows(const scene_some *some)
{
  const basins *b = ((const states *)some->of->arg)->b;
  pendres_basin_state *state = some->rows;
  size_t deferred = 0, k = 0;
  for (size_t i = 0; i < some->n; i++) deferred += state[i].how == PENDRES_BASIN_DEFERRED;
  if (deferred == 0) return PENDRES_OK;
  size_t *index = scene_room_take(some->room, deferred, sizeof *index);
  pendres_basin_state *rest = scene_room_take(some->room, deferred, sizeof *rest);
  if (index == NULL || rest == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < some->n; i++)
    if (state[i].how == PENDRES_BASIN_DEFERRED) index[k++] = some->first + i;
  const pendres_status status =
    pendres_basin_states(some->ctx, b->set, &b->grid, k, index, rest);
  for (size_t i = 0; i < k && status == PENDRES_OK; i++) state[index[i] - some->first] = rest[i];
  return status;
}

/* Whole rows or, where their budget has ended these, some states of them. */
static pendres_status find_rows(const scene_some *some)
{
  const basins *b = ((const states *)some->of->arg)->b;
  const size_t nv = b->grid.nv;
  if (some->first % nv != 0 || some->n % nv != 0) return find_states(some);
  const pendres_status status = pendres_basin_rows(some->ctx, b->set, &b->grid, some->first / nv,
                                                   some->n / nv, some->rows);
  return status == PENDRES_OK ? finish_rows(some) : status;
}

/* A state that the budget has ended; the first of them are kept to be told. */
static void take_given_up(basins *b, size_t number)
{
  if (b->given_up < BASINS_NAMED) b->given_up_index[b->given_up] = number;
  b->given_up++;
  b->unresolved++;
}

/* Unresolved states are counted and, up to a number of them, remembered, so that attractors are
   looked for where they go; but not those that take too long. */
static void take_unresolved(basins *b, size_t first, size_t n, const pendres_basin_state *state,
                            lost *to, size_t most)
{
  for (size_t i = 0; i < n; i++) {
    if (state[i].attractor != PENDRES_ATTRACTOR_UNKNOWN) continue;
    if (state[i].settling_periods == BASINS_GIVEN_UP) {
      take_given_up(b, first + i);
      continue;
    }
    b->unresolved++;
    if (to->n < most) to->index[to->n++] = first + i;
  }
}

/* Rows whose unresolved states are remembered together. */
static size_t rows_of_group(const basins *b)
{
  return 1 + TASK_STATES / b->grid.nv;
}

static pendres_status collect_rows(const scene_points *p, size_t first, size_t n, const void *rows)
{
  states *s = p->arg;
  lost *l = &s->lost;
  const size_t nv = s->b->grid.nv, group = rows_of_group(s->b) * nv;
  const pendres_basin_state *state = rows;
  basins_write_rows(s->b, first / nv, n / nv, rows);
  for (size_t at = 0, count; at < n; at += count) {
    const size_t number = (first + at) / group, end = (number + 1) * group - first;
    count = (end < n ? end : n) - at;
    if (l->most == 0 || number != l->group) l->most = l->n + TASK_LOST;
    l->group = number;
    take_unresolved(s->b, first + at, count, state + at, l, l->most);
  }
  const pendres_status status = pendres_basin_sums_add(s->b->sums, n / nv, rows);
  return scene_going(s->b->run) ? status : s->b->run->status;
}

/* New sums for a new pass over the grid. */
static void restart(basins *b)
{
  pendres_basin_sums_free(b->sums);
  b->sums = NULL;
  b->unresolved = b->given_up = 0;
  if (pendres_basin_sums_create(&b->grid, pendres_attractors_count(b->set), &b->sums) != PENDRES_OK)
    scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for statistics");
}

/* Look for attractors that only unresolved states lead to; how many there are. */
static size_t extend(basins *b, const lost *l)
{
  size_t grown = 0;
  pendres_context *ctx = l->n > 0 && scene_going(b->run) ? scene_context(b->run) : NULL;
  if (ctx != NULL)
    scene_asked(b->run, pendres_basin_extend(ctx, b->set, &b->grid, l->n, l->index, &grown));
  return grown;
}

static size_t sweep_once(basins *b, int last)
{
  const size_t nv = b->grid.nv, nx = b->grid.nx, group = rows_of_group(b);
  const size_t least = 1 + TASK_STATES_LEAST / nv, some = (nx + BASINS_TASKS - 1) / BASINS_TASKS;
  const size_t enough = some > least ? some : least, rows = enough < group ? enough : group;
  states s = {.b = b,
              .points = {.n = nx * nv, .chunk = rows * nv,
                         .size = sizeof(pendres_basin_state), .compute = find_rows,
                         .none = &given_up, .check = check, .collect = collect_rows,
                         .name = name_point, .unmarked = 1, .arg = &s}};
  restart(b);
  s.lost.index = scene_array(b->run, (nx + group - 1) / group * TASK_LOST,
                             sizeof *s.lost.index);
  SCENE_COMPUTE(b->run, &s.points, "groups of rows", .element = sizeof(pendres_basin_state));
  return last ? 0 : extend(b, &s.lost);
}

/* ---- refinement ---- */

/* Integrate states by number, on all threads if they are many; to be freed. */
static pendres_basin_state *integrate(basins *b, size_t n, const size_t *index)
{
  states s = {.b = b, .index = index,
              .points = {.n = n, .chunk = TASK_REFINED, .size = sizeof(pendres_basin_state),
                         .compute = find_states, .none = &given_up, .check = check,
                         .name = name_point, .unmarked = 1, .arg = &s}};
  pendres_basin_state *state = s.points.rows = calloc(n + 1, sizeof *state);
  if (state == NULL) scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu states", n);
  if (n > TASK_REFINED) {
    SCENE_COMPUTE(b->run, &s.points, "slices", .last = 0);
    return state;
  }
  pendres_context *ctx = scene_context(b->run);
  if (ctx != NULL)
    scene_asked(b->run, pendres_basin_states(ctx, b->set, &b->grid, n, index, state));
  return state;
}

/* Record the failure, if it is one, of a function of a plan; whether the run goes on. */
static int planned(basins *b, pendres_status status)
{
  if (status != PENDRES_OK)
    scene_fail(b->run, status, "refinement: %s", pendres_status_message(status));
  return scene_going(b->run);
}

static void follow_plan(basins *b, pendres_basin_plan *p)
{
  const size_t *index = NULL;
  size_t n;
  while (scene_going(b->run) && planned(b, pendres_basin_plan_next(p, &n, &index)) && n > 0) {
    pendres_basin_state *state = integrate(b, n, index);
    if (scene_going(b->run)) planned(b, pendres_basin_plan_accept(p, state));
    free(state);
  }
}

/* Verify a sample of n of the states that were filled in; wrong ones are corrected, and so are
   their surroundings. How many were wrong. */
static size_t verify_once(basins *b, pendres_basin_plan *p, size_t n, uint64_t seed, size_t *drawn)
{
  const size_t *index = NULL;
  size_t missed = 0;
  *drawn = 0;
  if (!planned(b, pendres_basin_plan_sample(p, n, seed, drawn, &index))) return 0;
  pendres_basin_state *state = integrate(b, *drawn, index);
  if (scene_going(b->run)) planned(b, pendres_basin_plan_verify(p, state, &missed));
  free(state);
  b->verified += *drawn;
  b->missed += missed;
  follow_plan(b, p);
  return missed;
}

/* Verify samples until one is clean. Each that is not makes the plan's lattice finer, so that this
   comes to an end. */
static void verify_plan(basins *b, pendres_basin_plan *p, size_t rows)
{
  const size_t all = b->grid.nx * b->grid.nv / BASINS_SAMPLED;
  const double sample = (double)(all > BASINS_LEAST_SAMPLE ? all : BASINS_LEAST_SAMPLE);
  const size_t n = (size_t)ceil(sample * (double)rows / (double)b->grid.nx);
  size_t drawn = 0, missed = 1;
  for (uint64_t seed = 1; missed > 0 && scene_going(b->run); seed++)
    missed = verify_once(b, p, n, seed, &drawn);
  b->clean += drawn;
  b->filled += pendres_basin_plan_filled(p);
}

/* Rows whose states have been refined. */
typedef struct band {
  basins *b;
  size_t first, rows;
  const pendres_basin_plan *plan;
  lost *to;
} band;

/* What is done with them, some at a time: the first thing is to write them, the second to add them
   up. */
static pendres_status use_band(pendres_context *ctx, size_t number, size_t count, void *arg)
{
  const band *s = arg;
  const size_t nv = s->b->grid.nv, most = s->rows < BASINS_ROWS ? s->rows : BASINS_ROWS;
  pendres_status status = PENDRES_OK;
  pendres_basin_state *state = malloc(most * nv * sizeof *state);
  (void)ctx;
  (void)count;
  if (state == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0, n; i < s->rows && status == PENDRES_OK; i += n) {
    n = s->rows - i < most ? s->rows - i : most;
    status = pendres_basin_plan_rows(s->plan, i, n, state);
    if (status == PENDRES_OK && number == 0) {
      basins_write_rows(s->b, s->first + i, n, state);
    } else if (status == PENDRES_OK) {
      status = pendres_basin_sums_add(s->b->sums, n, state);
      take_unresolved(s->b, (s->first + i) * nv, n * nv, state, s->to, TASK_LOST);
    }
  }
  free(state);
  return status;
}

/* Compute rows first .. first + rows - 1 by a plan. */
static void refine_band(basins *b, size_t first, size_t rows, lost *to)
{
  pendres_basin_plan *p = NULL;
  if (!scene_going(b->run) || !planned(b, pendres_basin_plan_create(&b->grid, first, rows, 0, &p)))
    return;
  follow_plan(b, p);
  verify_plan(b, p, rows);
  b->integrated += pendres_basin_plan_integrated(p);
  const pendres_parts both = {.n = 2, .each = 1, .threads = farm_threads(b->run->farm)};
  if (scene_going(b->run))
    planned(b, pendres_parts_run(&both, use_band, &(band){b, first, rows, p, to}, NULL, 0));
  pendres_basin_plan_free(p);
}

static size_t refine_once(basins *b, int last)
{
  const size_t band = 1 + (BASINS_BAND - 1) / b->grid.nv, nx = b->grid.nx;
  size_t index[TASK_LOST];
  lost some = {.index = index};
  restart(b);
  b->integrated = b->verified = b->missed = b->filled = b->clean = 0;
  for (size_t i = 0; i < nx; i += band)
    refine_band(b, i, nx - i < band ? nx - i : band, &some);
  if (scene_going(b->run))
    planned(b, pendres_basin_sums_suspect(b->sums,
                                          pendres_basin_plan_suspected(b->filled, b->clean)));
  return last ? 0 : extend(b, &some);
}

/* ---- the scene ---- */

/* The line v = 0. */
static void compute_cut(basins *b)
{
  static const double rest = 0.0;
  basins line = *b;
  size_t *index = scene_array(b->run, b->grid.nx, sizeof *index);
  line.grid.nv = 1;
  line.grid.v = &rest;
  if (index == NULL) return;
  for (size_t i = 0; i < b->grid.nx; i++) index[i] = i;
  b->cut = integrate(&line, b->grid.nx, index);
}

static void find_attractors(basins *b)
{
  char why[SCENE_TOLD];
  pendres_context *ctx = scene_context(b->run);
  if (ctx == NULL) return;
  if (scene_settling_too_long(b->d, &b->pendulum, 1.0, why, sizeof why))
    scene_fail(b->run, PENDRES_NOT_CONVERGED, "%s", why);
  else scene_asked(b->run, pendres_basin_attractors(ctx, &b->pendulum, &b->grid, &b->set));
}

/* Tell how many states stayed without an attractor, and what may help. */
static void tell_unresolved(const basins *b)
{
  char words[SCENE_TOLD];
  for (size_t i = 0; i < b->given_up && i < BASINS_NAMED; i++) {
    name_state(b, b->given_up_index[i], words, sizeof words);
    scene_failure_tell(b->run, SCENE_FAILURE_OUT_OF_TIME, NULL, "the state at %s", words);
  }
  const size_t rest = b->unresolved - b->given_up;
  if (rest == 0) return;
  scene_failure_unsettled(b->d, rest, b->grid.nx * b->grid.nv, "states",
                          pendres_attractors_weakest_multiplier(b->set), words);
  scene_failure_tell(b->run, SCENE_FAILURE_UNRESOLVED, words, "basins");
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  basins b = {.run = run, .d = d,
              .pendulum = deck_pendulum(d),
              .grid = {.nx = d->axis[DECK_AXIS_X].count, .nv = d->axis[DECK_AXIS_V].count,
                       .x = d->axis[DECK_AXIS_X].value, .v = d->axis[DECK_AXIS_V].value,
                       .by = strcmp(d->basins.by, "well") == 0 ? PENDRES_BASIN_BY_WELL
                                                               : PENDRES_BASIN_BY_ATTRACTOR}};
  find_attractors(&b);
  basins_define(&b);
  for (size_t pass = 0, grown = 1; grown > 0 && scene_going(run); pass++)
    grown = d->basins.refine ? refine_once(&b, pass == BASINS_EXTENSIONS)
                             : sweep_once(&b, pass == BASINS_EXTENSIONS);
  compute_cut(&b);
  basins_write_results(&b);
  basins_write_clouds(run, b.set);
  run->points += b.grid.nx * b.grid.nv;
  scene_failure_count(run, SCENE_FAILURE_UNRESOLVED, b.unresolved - b.given_up);
  scene_failure_count(run, SCENE_FAILURE_OUT_OF_TIME, b.given_up);
  if (b.unresolved > 0) tell_unresolved(&b);
  pendres_attractors_free(b.set);
  pendres_basin_sums_free(b.sums);
  free(b.cut);
  return run->status;
}

/* Strobe points of clouds: two numbers for each of two attractors. */
static double strobes_of(const deck *d)
{
  if (!deck_has_noise(d)) return 0.0;
  return 4.0 * (double)d->axis[DECK_AXIS_TEMPERATURE].count * (double)d->basins.strobes;
}

enum { STATE_MEMORY = 30 };

/* Bytes of states that differ from their neighbours in the compressed file, or, where that is not
   known or rows are not computed whole, by the resolution alone, which makes runs of equal states
   longer; and of a boundary, mostly. Rows are written as they come; records that wait for their
   turn have 64 MB (farm/numbers.h). */
static scene_more more(const deck *d, const farm_trial *trial, double states)
{
  const double boundary = d->basins.boundary ? 200e3 : 0.0;
  const int known = trial != NULL && trial->changes > 0.0 && !d->basins.refine;
  return (scene_more){
    .output = boundary + (known ? 1.3 * trial->changes : 150.0 * sqrt(states)),
    .memory = d->basins.refine ? 0.0 : fmin(64e6 - STATE_MEMORY * states, 0.0)};
}

const scene_kind scene_basins = {
  .kind = DECK_BASINS,
  .figures = "Fig. 7",
  .references = ". Basin entropy: Daza et al., Scientific Reports 6 (2016) 31416. Uncertainty "
                "exponent: McDonald, Grebogi, Ott, Yorke, Physica D 17 (1985) 125. With "
                "temperature: S. A. Chin, Phys. Lett. A 226 (1997) 344; H. A. Forbert and S. A. "
                "Chin, Phys. Rev. E 63 (2000) 016703; J. K. Salmon et al., Parallel random "
                "numbers: as easy as 1, 2, 3, SC11 (2011); linear theory: N. G. van Kampen, "
                "Stochastic Processes in Physics and Chemistry, chapter VIII.6.",
  .budget = 1,
  .size = {.head = 75e3, .point = 0.12, .memory = STATE_MEMORY, .stages = 1.0, .after = 1.2,
           .seconds = 4e-6, .values = strobes_of, .value = 7.0, .more = more},
  .describe = describe,
  .run = run_scene};
