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

#include "scenes/basins.h"

enum {
  STATES_A_TASK = 65536, /* whole rows of about so many states */
  SLICE = 4096,           /* states of a task in a refinement: several blocks */
  SMALL = 2048,           /* so few states are not worth a task */
  BAND_STATES = 1 << 24,  /* states that a plan holds at a time */
  LEAST_SAMPLE = 10000,   /* filled states that are verified, or one of SAMPLED states if more */
  SAMPLED = 256,
  LOST_A_TASK = 64,       /* unresolved states that a task remembers */
  MOST_EXTENSIONS = 4
};

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

/* ---- whole grids ---- */

/* What a task finds: this, then the states of its rows. */
typedef struct part {
  size_t lost, lost_index[LOST_A_TASK]; /* unresolved: how many, and some of them */
  size_t given_up, given_up_index[BASINS_NAMED]; /* ended by their budget */
} part;

typedef struct sweep {
  basins *b;
  size_t rows;         /* a task */
  size_t lost, *index; /* unresolved states that tasks remember */
} sweep;

static size_t rows_of(const sweep *s, size_t task)
{
  const size_t left = s->b->grid.nx - task * s->rows;
  return left < s->rows ? left : s->rows;
}

/* Finish the states of rows that had been deferred. */
static pendres_status finish_rows(pendres_context *ctx, const basins *b, size_t offset, size_t n,
                                  pendres_basin_state *state)
{
  size_t deferred = 0, k = 0;
  for (size_t i = 0; i < n; i++) deferred += state[i].how == PENDRES_BASIN_DEFERRED;
  if (deferred == 0) return PENDRES_OK;
  size_t *index = malloc(deferred * sizeof *index);
  pendres_basin_state *rest = malloc(deferred * sizeof *rest);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (index == NULL || rest == NULL) goto done;
  for (size_t i = 0; i < n; i++)
    if (state[i].how == PENDRES_BASIN_DEFERRED) index[k++] = offset + i;
  status = pendres_basin_states(ctx, b->set, &b->grid, k, index, rest);
  for (size_t i = 0; i < k && status == PENDRES_OK; i++) state[index[i] - offset] = rest[i];
done:
  free(index);
  free(rest);
  return status;
}

static void name_state(const basins *b, size_t index, char *text, size_t size)
{
  snprintf(text, size, "x %.10g, v %.10g", b->grid.x[index / b->grid.nv],
           b->grid.v[index % b->grid.nv]);
}

/* Begin n states, of which number `first` is the first. */
static void begin_states(const basins *b, size_t first, size_t n, farm_record *out)
{
  char name[80], more[40] = "";
  name_state(b, first, name, sizeof name);
  if (n > 1) snprintf(more, sizeof more, " and %zu more", n - 1);
  farm_point(out, n, "%s%s", name, more);
}

/* Integrate states by their numbers. Where the budget ends them, either half is tried, down to
   single states. */
static pendres_status find_states(const basins *b, size_t n, const size_t *index,
                                  pendres_context *ctx, farm_record *out,
                                  pendres_basin_state *state)
{
  const size_t half = n / 2;
  begin_states(b, index[0], n, out);
  pendres_status status = pendres_basin_states(ctx, b->set, &b->grid, n, index, state);
  if (!farm_gave_up(out, status)) return status;
  if (half == 0) {
    farm_lost(out, NULL, 0);
    *state = (pendres_basin_state){.settling_periods = BASINS_GIVEN_UP,
                                   .attractor = PENDRES_ATTRACTOR_UNKNOWN,
                                   .label = PENDRES_LABEL_UNRESOLVED};
    return PENDRES_OK;
  }
  status = find_states(b, half, index, ctx, out, state);
  if (status != PENDRES_OK) return status;
  return find_states(b, n - half, index + half, ctx, out, state + half);
}

/* Integrate n states from number `first` on, and leave out those that use up their budget. */
static pendres_status find_apart(const basins *b, size_t first, size_t n, pendres_context *ctx,
                                 farm_record *out, pendres_basin_state *state)
{
  size_t *index = malloc(n * sizeof *index);
  if (index == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) index[i] = first + i;
  const pendres_status status = find_states(b, n, index, ctx, out, state);
  free(index);
  return status;
}

/* Unresolved states are remembered, so that attractors are looked for where they go; but not those
   that take too long. */
static void note_lost(const pendres_basin_state *state, size_t index, part *p)
{
  if (state->attractor != PENDRES_ATTRACTOR_UNKNOWN) return;
  if (state->settling_periods == BASINS_GIVEN_UP) {
    if (p->given_up < BASINS_NAMED) p->given_up_index[p->given_up] = index;
    p->given_up++;
    return;
  }
  if (p->lost < LOST_A_TASK) p->lost_index[p->lost] = index;
  p->lost++;
}

static pendres_status compute_rows(const void *arg, size_t task, pendres_context *ctx,
                                   farm_record *out)
{
  const sweep *s = arg;
  const basins *b = s->b;
  const size_t first = task * s->rows, rows = rows_of(s, task), n = rows * b->grid.nv;
  part *p = farm_record_resize(out, sizeof *p + n * sizeof(pendres_basin_state));
  if (p == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_basin_state *state = (pendres_basin_state *)(p + 1);
  begin_states(b, first * b->grid.nv, n, out);
  pendres_status status =
    pendres_basin_rows(ctx, b->set, &b->grid, first, rows, state);
  if (status == PENDRES_OK) status = finish_rows(ctx, b, first * b->grid.nv, n, state);
  if (farm_gave_up(out, status))
    status = find_apart(b, first * b->grid.nv, n, ctx, out, state);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    note_lost(&state[i], first * b->grid.nv + i, p);
  return status;
}

/* Count states that their budget has ended, and keep the first of them to be told. */
static void take_given_up(basins *b, size_t n, const size_t *index)
{
  for (size_t k = 0; k < n && k < BASINS_NAMED && b->given_up + k < BASINS_NAMED; k++)
    b->given_up_index[b->given_up + k] = index[k];
  b->given_up += n;
  b->unresolved += n;
}

/* Numbers of states that a record names; it names at most so many. */
static int numbers_fit(const basins *b, size_t n, const size_t *index, size_t most)
{
  int good = 1;
  for (size_t k = 0; k < n && k < most && good; k++) good = index[k] < b->grid.nx * b->grid.nv;
  return good;
}

static int check_rows(const void *arg, size_t task, const farm_record *in)
{
  const sweep *s = arg;
  const part *p = in->data;
  const size_t n = rows_of(s, task) * s->b->grid.nv;
  return in->size == sizeof *p + n * sizeof(pendres_basin_state) && p->lost <= n &&
         p->given_up <= n && numbers_fit(s->b, p->lost, p->lost_index, LOST_A_TASK) &&
         numbers_fit(s->b, p->given_up, p->given_up_index, BASINS_NAMED) &&
         scene_check_basin_states(n, (const pendres_basin_state *)(p + 1),
                                  pendres_attractors_count(s->b->set));
}

static pendres_status collect_rows(void *arg, size_t task, const farm_record *in)
{
  sweep *s = arg;
  const part *p = in->data;
  const pendres_basin_state *state = (const pendres_basin_state *)(p + 1);
  const size_t rows = rows_of(s, task);
  pendres_status status = basins_write_rows(s->b, task * s->rows, rows, state);
  if (status == PENDRES_OK) status = pendres_basin_sums_add(s->b->sums, rows, state);
  s->b->unresolved += p->lost;
  take_given_up(s->b, p->given_up, p->given_up_index);
  for (size_t k = 0; k < p->lost && k < LOST_A_TASK; k++) s->index[s->lost++] = p->lost_index[k];
  return status;
}

/* New sums for a new pass over the grid. */
static pendres_status restart(basins *b)
{
  pendres_basin_sums_free(b->sums);
  b->sums = NULL;
  b->unresolved = b->given_up = 0;
  const pendres_status status =
    pendres_basin_sums_create(&b->grid, pendres_attractors_count(b->set), &b->sums);
  return status == PENDRES_OK ? status : scene_fail(b->run, status, "out of memory for statistics");
}

/* Look for attractors that only unresolved states lead to. */
static pendres_status extend(basins *b, size_t n, const size_t *index, size_t *grown)
{
  *grown = 0;
  if (n == 0) return PENDRES_OK;
  pendres_context *ctx = scene_context(b->run);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  return scene_asked(b->run, pendres_basin_extend(ctx, b->set, &b->grid, n, index, grown));
}

static pendres_status sweep_once(basins *b, size_t *grown, int last)
{
  sweep s = {.b = b, .rows = 1 + STATES_A_TASK / b->grid.nv};
  const size_t tasks = (b->grid.nx + s.rows - 1) / s.rows;
  pendres_status status = restart(b);
  *grown = 0;
  if (status != PENDRES_OK) return status;
  s.index = scene_array(b->run, tasks * LOST_A_TASK, sizeof *s.index);
  if (s.index == NULL) return PENDRES_OUT_OF_MEMORY;
  status = scene_compute(b->run, &(farm_stage){ .what = "groups of rows", .tasks = tasks,
                                                .element = sizeof(pendres_basin_state),
                                                .task = compute_rows, .check = check_rows,
                                                .collect = collect_rows,
                                                .arg = &s });
  if (status == PENDRES_OK && !last) status = extend(b, s.lost, s.index, grown);
  return status;
}

/* ---- refinement ---- */

typedef struct slices {
  const basins *b;
  size_t n;
  const size_t *index;
  pendres_basin_state *state;
} slices;

static size_t slice_of(const slices *s, size_t task)
{
  const size_t left = s->n - task * SLICE;
  return left < SLICE ? left : SLICE;
}

static pendres_status compute_slice(const void *arg, size_t task, pendres_context *ctx,
                                    farm_record *out)
{
  const slices *s = arg;
  const size_t n = slice_of(s, task);
  pendres_basin_state *state = farm_record_resize(out, n * sizeof *state);
  if (state == NULL) return PENDRES_OUT_OF_MEMORY;
  return find_states(s->b, n, s->index + task * SLICE, ctx, out, state);
}

static int check_slice(const void *arg, size_t task, const farm_record *in)
{
  const slices *s = arg;
  const size_t n = slice_of(s, task);
  return in->size == n * sizeof *s->state &&
         scene_check_basin_states(n, in->data, pendres_attractors_count(s->b->set));
}

static pendres_status collect_slice(void *arg, size_t task, const farm_record *in)
{
  const slices *s = arg;
  memcpy(s->state + task * SLICE, in->data, slice_of(s, task) * sizeof *s->state);
  return PENDRES_OK;
}

/* Integrate states by number, on all threads if they are many. */
static pendres_status integrate(basins *b, size_t n, const size_t *index,
                                pendres_basin_state **state)
{
  *state = calloc(n + 1, sizeof **state);
  if (*state == NULL)
    return scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu states", n);
  slices s = {.b = b, .n = n, .index = index, .state = *state};
  if (n > SMALL)
    return scene_compute(b->run, &(farm_stage){ .what = "slices", .tasks = (n + SLICE - 1) / SLICE,
                                                .task = compute_slice, .check = check_slice,
                                                .collect = collect_slice,
                                                .arg = &s });
  pendres_context *ctx = scene_context(b->run);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  return scene_asked(b->run, pendres_basin_states(ctx, b->set, &b->grid, n, index, *state));
}

static pendres_status follow_plan(basins *b, pendres_basin_plan *p)
{
  pendres_status status = PENDRES_OK;
  for (size_t n = 1; n > 0 && status == PENDRES_OK;) {
    const size_t *index = NULL;
    pendres_basin_state *state = NULL;
    status = pendres_basin_plan_next(p, &n, &index);
    if (status != PENDRES_OK || n == 0) break;
    status = integrate(b, n, index, &state);
    if (status == PENDRES_OK) status = pendres_basin_plan_accept(p, state);
    free(state);
  }
  return status;
}

/* Verify a sample of the states that were filled in; wrong ones are corrected, and so are their
   surroundings. */
static pendres_status verify_once(basins *b, pendres_basin_plan *p, size_t sample, uint64_t seed,
                                  size_t *drawn, size_t *missed)
{
  const size_t *index = NULL;
  pendres_basin_state *state = NULL;
  *drawn = *missed = 0;
  pendres_status status = pendres_basin_plan_sample(p, sample, seed, drawn, &index);
  if (status == PENDRES_OK) status = integrate(b, *drawn, index, &state);
  if (status == PENDRES_OK) status = pendres_basin_plan_verify(p, state, missed);
  free(state);
  b->verified += *drawn;
  b->missed += *missed;
  return status == PENDRES_OK ? follow_plan(b, p) : status;
}

/* Verify samples until one is clean. Each that is not makes the plan's lattice finer, so that this
   comes to an end. */
static pendres_status verify_plan(basins *b, pendres_basin_plan *p, size_t rows)
{
  const size_t all = b->grid.nx * b->grid.nv / SAMPLED;
  const double sample = (double)(all > LEAST_SAMPLE ? all : LEAST_SAMPLE);
  const size_t n = (size_t)ceil(sample * (double)rows / (double)b->grid.nx);
  size_t drawn = 0, missed = 1;
  pendres_status status = PENDRES_OK;
  for (uint64_t seed = 1; missed > 0 && status == PENDRES_OK; seed++)
    status = verify_once(b, p, n, seed, &drawn, &missed);
  b->clean += drawn;
  b->filled += pendres_basin_plan_filled(p);
  return status;
}

/* Compute rows first .. first + rows - 1 by a plan; index[0 .. *lost) are some unresolved
   states. */
static pendres_status refine_band(basins *b, size_t first, size_t rows, size_t *lost, size_t *index)
{
  pendres_basin_plan *p = NULL;
  const size_t n = rows * b->grid.nv;
  pendres_basin_state *state = NULL;
  pendres_status status = pendres_basin_plan_create(&b->grid, first, rows, 0, &p);
  if (status == PENDRES_OK) status = follow_plan(b, p);
  if (status == PENDRES_OK) status = verify_plan(b, p, rows);
  if (status != PENDRES_OK) goto done;
  b->integrated += pendres_basin_plan_integrated(p);
  state = malloc(n * sizeof *state);
  status = state != NULL ? pendres_basin_plan_states(p, state) : PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK) status = basins_write_rows(b, first, rows, state);
  if (status == PENDRES_OK) status = pendres_basin_sums_add(b->sums, rows, state);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const size_t number = first * b->grid.nv + i;
    if (state[i].attractor != PENDRES_ATTRACTOR_UNKNOWN) continue;
    if (state[i].settling_periods == BASINS_GIVEN_UP) {
      take_given_up(b, 1, &number);
      continue;
    }
    b->unresolved++;
    if (*lost < LOST_A_TASK) index[(*lost)++] = number;
  }
done:
  if (status != PENDRES_OK)
    (void)scene_fail(b->run, status, "refinement: %s", pendres_status_message(status));
  pendres_basin_plan_free(p);
  free(state);
  return status;
}

static pendres_status refine_once(basins *b, size_t *grown, int last)
{
  const size_t band = 1 + (BAND_STATES - 1) / b->grid.nv;
  size_t index[LOST_A_TASK], lost = 0;
  pendres_status status = restart(b);
  *grown = 0;
  b->integrated = b->verified = b->missed = b->filled = b->clean = 0;
  for (size_t i = 0; i < b->grid.nx && status == PENDRES_OK; i += band)
    status = refine_band(b, i, b->grid.nx - i < band ? b->grid.nx - i : band, &lost, index);
  if (status == PENDRES_OK)
    status = pendres_basin_sums_suspect(b->sums, pendres_basin_plan_suspected(b->filled, b->clean));
  if (status == PENDRES_OK && !last) status = extend(b, lost, index, grown);
  return status;
}

/* ---- the scene ---- */

/* The line v = 0. */
static pendres_status compute_cut(basins *b)
{
  static const double rest = 0.0;
  basins line = *b;
  size_t *index = scene_array(b->run, b->grid.nx, sizeof *index);
  line.grid.nv = 1;
  line.grid.v = &rest;
  if (index == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < b->grid.nx; i++) index[i] = i;
  const pendres_status status = integrate(&line, b->grid.nx, index, &b->cut);
  return status;
}

static pendres_status find_attractors(basins *b)
{
  char why[SCENE_TOLD];
  pendres_context *ctx = scene_context(b->run);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  if (scene_settling_too_long(b->d, &b->pendulum, 1.0, why, sizeof why))
    return scene_fail(b->run, PENDRES_NOT_CONVERGED, "%s", why);
  return scene_asked(b->run, pendres_basin_attractors(ctx, &b->pendulum, &b->grid, &b->set));
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
  size_t grown = 1;
  pendres_status status = find_attractors(&b);
  if (status == PENDRES_OK) status = basins_define(&b);
  for (int pass = 0; grown > 0 && status == PENDRES_OK; pass++) {
    const int last = pass == MOST_EXTENSIONS;
    status = d->basins.refine ? refine_once(&b, &grown, last) : sweep_once(&b, &grown, last);
  }
  if (status == PENDRES_OK) status = compute_cut(&b);
  if (status == PENDRES_OK) status = basins_write_results(&b);
  if (status == PENDRES_OK) basins_write_clouds(run, b.set);
  if (status == PENDRES_OK) status = run->status;
  run->failed_points += b.unresolved;
  if (b.unresolved > 0) tell_unresolved(&b);
  pendres_attractors_free(b.set);
  pendres_basin_sums_free(b.sums);
  free(b.cut);
  return status;
}

const scene_kind scene_basins = {
  .kind = DECK_BASINS,
  .references =
    "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
    "pendulum, Fig. 7. Basin entropy: Daza et al., Scientific Reports 6 (2016) 31416. "
    "Uncertainty exponent: McDonald, Grebogi, Ott, Yorke, Physica D 17 (1985) 125. With "
    "temperature: S. A. Chin, Phys. Lett. A 226 (1997) 344; H. A. Forbert and S. A. Chin, Phys. "
    "Rev. E 63 (2000) 016703; J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, "
    "SC11 (2011); linear theory: N. G. van Kampen, Stochastic Processes in Physics and Chemistry, "
    "chapter VIII.6.",
  .budget = 1,
  .size = {75e3, 0.12, 30.0, 1.0, 1.2, 4e-6},
  .describe = describe,
  .run = run_scene};
