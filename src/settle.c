/* settle.c -- settling many pendulums of many parameter sets at once; see settle.h. */
#include "settle.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "context_internal.h"
#include "steps.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

enum {
  SCOUTS = 12,         /* members of a parameter set sent ahead */
  HISTORY = 65,        /* strobe points kept of a pendulum that does not settle */
  LONGEST_PERIOD = 32, /* of an orbit that is looked for: half the history */
  MOST_GUESSES = 8,    /* orbits looked for at a time in one parameter set */
  CHAOTIC_STREAK = 32  /* strobes in a row in a chaotic attractor's cells that make chaos */
};

/* A history that comes back closer than this may be near an orbit. */
static const double near_orbit = 0.3;

/* e-folding time of a small oscillation, in periods. */
static double settling_time(const pendres_pendulum *p)
{
  return 1.0 / (0.5 * p->damping * two_pi / p->drive_frequency);
}

/* Periods after which a pendulum that is in no trap is looked at closely. */
static long first_budget(const pendres_pendulum *p)
{
  return (long)ceil(fmin(20.0 + 10.0 * settling_time(p), 1e7));
}

/* Close to a fold an attractor that is known attracts slowly: it gets the time that it needs. */
static long last_budget(const pendres_context *ctx, const pendres_catalogue *c)
{
  if (ctx->options.period_budget > 0) return ctx->options.period_budget;
  double slowest = 0.0;
  for (size_t i = 0; i < c->count; i++) {
    const pendres_orbit *o = &c->attractors[i].orbit;
    const double rate = -log(hypot(o->multiplier_re[0], o->multiplier_im[0]));
    if (rate > 0.0) slowest = fmax(slowest, o->period / rate);
  }
  const double most = 2000.0 + 100.0 * settling_time(&c->pendulum) + 20.0 * fmin(slowest, 1e4);
  return (long)ceil(fmin(most, 1e8));
}

/* ---- labelling against catalogues ---- */

/* The latest strobe points of a lane, a ring buffer. */
typedef struct history {
  long filled;                   /* points ever recorded */
  double y[HISTORY], w[HISTORY]; /* unwrapped angle */
} history;

/* Arrays are by the caller's numbers of lanes; origin gives these for the lanes under way. */
typedef struct labelling {
  const pendres_catalogue *catalogues;
  const size_t *origin;
  const size_t *set;        /* NULL: all lanes belong to the first catalogue */
  const long *budget;       /* of each set, periods in all */
  pendres_outcome *outcome;
  int *streak;              /* strobes in a row in the cells of a chaotic attractor; NULL: none */
  history *histories;       /* NULL: not kept */
} labelling;

static void record(history *h, const pendres_strobe_lane *lane)
{
  const long k = h->filled++ % HISTORY;
  h->y[k] = lane->y + two_pi * (double)lane->turns;
  h->w[k] = lane->w;
}

/*
 * A lane in the cells of a chaotic attractor for long enough is chaotic, but not before
 * transients are over.
 */
static int chaotic(const labelling *l, size_t i, const pendres_catalogue *c,
                   const pendres_strobe_lane *lane)
{
  for (size_t k = 0; k < c->covers; k++) {
    if (!pendres_cover_holds(c->cover[k], lane->y, lane->w)) continue;
    if (++l->streak[i] < CHAOTIC_STREAK || lane->period < first_budget(&c->pendulum)) return 0;
    l->outcome[i] = (pendres_outcome){.label = PENDRES_LABEL_CHAOTIC,
                                      .attractor = c->cover[k]->attractor,
                                      .settling_periods = lane->period - l->streak[i] + 1};
    return 1;
  }
  l->streak[i] = 0;
  return 0;
}

static int trapped(const labelling *l, size_t i, const pendres_catalogue *c,
                   const pendres_strobe_lane *lane)
{
  pendres_outcome *o = &l->outcome[i];
  const int attractor = pendres_catalogue_locate(c, lane, &o->well);
  if (attractor < 0) return 0;
  o->attractor = attractor;
  o->label = c->attractors[attractor].label;
  o->settling_periods = lane->period;
  return 1;
}

static size_t set_of(const labelling *l, size_t i)
{
  return l->set != NULL ? l->set[i] : 0;
}

static int settle_look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const labelling *l = arg;
  const size_t i = l->origin[index], set = set_of(l, i);
  const pendres_catalogue *c = &l->catalogues[set];
  if (trapped(l, i, c, lane)) return 1;
  if (l->histories != NULL) record(&l->histories[i], lane);
  if (c->covers > 0 && chaotic(l, i, c, lane)) return 1;
  return lane->period >= l->budget[set];
}

static const pendres_outcome unresolved = {
  .label = PENDRES_LABEL_UNRESOLVED, .attractor = -1, .settling_periods = -1};

/* Run the lanes that are unresolved; those inside a trap are done before they begin. */
static pendres_status run_lanes(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                labelling *l)
{
  size_t left = 0;
  int covers = 0;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_strobe_lane *rest = malloc((n + 1) * sizeof *rest);
  size_t *origin = malloc((n + 1) * sizeof *origin);
  if (rest == NULL || origin == NULL) goto no_memory;
  for (size_t i = 0; i < n; i++) {
    const size_t set = set_of(l, i);
    const pendres_catalogue *c = &l->catalogues[set];
    if (l->outcome[i].attractor >= 0) continue;
    if (trapped(l, i, c, &lanes[i]) || lanes[i].period >= l->budget[set]) continue;
    covers |= c->covers > 0;
    origin[left] = i;
    rest[left++] = lanes[i];
  }
  if (covers) {
    l->streak = calloc(n, sizeof *l->streak);
    if (l->streak == NULL) goto no_memory;
  }
  l->origin = origin;
  status = pendres_strobe_run(ctx, left, rest, settle_look, l);
  for (size_t i = 0; i < left && status == PENDRES_OK; i++) {
    pendres_outcome *o = &l->outcome[origin[i]];
    lanes[origin[i]] = rest[i];
    if (o->attractor < 0) *o = unresolved;
  }
  goto done;
no_memory:
  (void)pendres_context_fail(ctx, status, "out of memory for %zu pendulums", n);
done:
  free(l->streak);
  l->streak = NULL;
  free(rest);
  free(origin);
  return status;
}

static pendres_status load_lane(pendres_context *ctx, const pendres_pendulum *p, double x, double v,
                                pendres_strobe_lane *lane)
{
  *lane = (pendres_strobe_lane){.pendulum = p, .y = x - half_pi, .w = v / p->drive_frequency};
  pendres_strobe_wrap(&lane->y, &lane->turns);
  /* An error of the size of the tolerance moves a basin's boundary by about as much. */
  return pendres_steps_choose(ctx, p, fabs(v), 10.0 * ctx->options.tolerance, &lane->steps);
}

/* ---- pendulums that do not settle: look for what they are near ---- */

/*
 * The shortest period that a history repeats itself with about as closely as with any; rounding
 * alone must not prefer a multiple. Returns 0 if it does not come near itself.
 */
static int recurrence(const history *h, pendres_scout *s)
{
  double distance[LONGEST_PERIOD + 1], closest = near_orbit;
  const long last = h->filled - 1;
  const double y = h->y[last % HISTORY], w = h->w[last % HISTORY];
  for (int q = 1; q <= LONGEST_PERIOD && q <= last; q++) {
    const long k = (last - q) % HISTORY;
    const double dy = y - h->y[k];
    distance[q] = hypot(dy - two_pi * rint(dy / two_pi), w - h->w[k]);
    closest = fmin(closest, distance[q]);
  }
  s->y = y;
  s->w = w;
  for (int q = 1; q <= LONGEST_PERIOD && q <= last; q++) {
    if (distance[q] > fmax(3.0 * closest, 1e-6)) continue;
    s->period = q;
    s->winding = (int)rint((y - h->y[(last - q) % HISTORY]) / two_pi);
    return closest < near_orbit;
  }
  return 0;
}

/* Everything about the pendulums that a batch has lost so far. */
typedef struct lost_lanes {
  size_t count;
  size_t *index; /* in the batch */
  size_t *set;
  pendres_strobe_lane *lanes;
  pendres_outcome *outcome;
  history *histories;
  pendres_scout *guesses;
  const pendres_strobe_lane **suspects;
  size_t *known; /* attractors of each set when the hunt began */
} lost_lanes;

static void free_lost(lost_lanes *l)
{
  free(l->index);
  free(l->set);
  free(l->lanes);
  free(l->outcome);
  free(l->histories);
  free(l->guesses);
  free(l->suspects);
  free(l->known);
}

static pendres_status allocate_lost(pendres_context *ctx, lost_lanes *l, size_t sets)
{
  const size_t n = l->count;
  l->index = malloc(n * sizeof *l->index);
  l->set = malloc(n * sizeof *l->set);
  l->lanes = malloc(n * sizeof *l->lanes);
  l->outcome = malloc(n * sizeof *l->outcome);
  l->histories = calloc(n, sizeof *l->histories);
  l->guesses = malloc(n * sizeof *l->guesses);
  l->suspects = malloc(n * sizeof *l->suspects);
  l->known = malloc(sets * sizeof *l->known);
  if (l->index == NULL || l->set == NULL || l->lanes == NULL || l->outcome == NULL ||
      l->histories == NULL || l->guesses == NULL || l->suspects == NULL || l->known == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", n);
  return PENDRES_OK;
}

/* Orbits that the lost lanes are near, a few in each set. */
static pendres_status add_recurrences(pendres_context *ctx, lost_lanes *l,
                                      pendres_catalogue *catalogues)
{
  size_t n = 0, in_set = 0;
  for (size_t i = 0; i < l->count; i++) {
    if (i == 0 || l->set[i] != l->set[i - 1]) in_set = 0;
    if (l->outcome[i].attractor >= 0 || l->histories[i].filled == 0) continue;
    l->guesses[n].set = l->set[i];
    if (in_set < MOST_GUESSES && recurrence(&l->histories[i], &l->guesses[n])) {
      n++;
      in_set++;
    }
  }
  return pendres_catalogue_add(ctx, catalogues, n, l->guesses);
}

/* Chaos among the lost lanes, set by set. */
static pendres_status add_chaos(pendres_context *ctx, lost_lanes *l, pendres_catalogue *catalogues)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0, last; first < l->count && status == PENDRES_OK; first = last) {
    size_t n = 0;
    pendres_catalogue *c = &catalogues[l->set[first]];
    for (last = first; last < l->count && l->set[last] == l->set[first]; last++) {
      long well;
      if (l->outcome[last].attractor < 0 &&
          pendres_catalogue_locate(c, &l->lanes[last], &well) < 0)
        l->suspects[n++] = &l->lanes[last];
    }
    int found = 0;
    status = pendres_chaos_find(ctx, c, n, l->suspects, &found);
  }
  return status;
}

/* Lanes that went to an attractor found late: again from the start, for their settling times. */
static pendres_status repeat(pendres_context *ctx, lost_lanes *l, const size_t *set,
                             const pendres_strobe_lane *starts, labelling *job)
{
  size_t n = 0;
  for (size_t i = 0; i < l->count; i++) {
    const int attractor = l->outcome[i].attractor;
    if (attractor < 0 || (size_t)attractor < l->known[l->set[i]]) continue;
    l->index[n] = l->index[i];
    l->set[n] = set[l->index[i]];
    l->outcome[n] = unresolved;
    l->lanes[n++] = starts[l->index[i]];
  }
  job->outcome = l->outcome;
  job->set = l->set;
  job->histories = NULL;
  const pendres_status status = run_lanes(ctx, n, l->lanes, job);
  l->count = status == PENDRES_OK ? n : 0;
  return status;
}

/* Budgets of the next round; 0 when all had been spent before. */
static int raise_budgets(const pendres_context *ctx, size_t sets,
                         const pendres_catalogue *catalogues, int round, long *budget)
{
  int longer = 0;
  for (size_t s = 0; s < sets; s++) {
    const long most = last_budget(ctx, &catalogues[s]);
    const long more = (first_budget(&catalogues[s].pendulum) + HISTORY) << round;
    if (budget[s] >= most) continue;
    longer = 1;
    budget[s] = budget[s] < most - more ? budget[s] + more : most;
  }
  return longer;
}

/*
 * Pendulums without a label after the first budget. Rounds, each twice as long as the one before:
 * go on, refine the orbits that they have come near, tell chaos, label again. What has found
 * nothing when the last budget is spent stays unresolved.
 */
static pendres_status hunt(pendres_context *ctx, size_t sets, pendres_catalogue *catalogues,
                           size_t n, const pendres_strobe_lane *starts,
                           const pendres_strobe_lane *lanes, const size_t *set, pendres_outcome *outcome, long *budget)
{
  lost_lanes l = {0};
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) l.count += outcome[i].attractor < 0;
  if (l.count == 0) return status;
  status = allocate_lost(ctx, &l, sets);
  if (status != PENDRES_OK) goto done;
  for (size_t i = 0, k = 0; i < n; i++) {
    if (outcome[i].attractor >= 0) continue;
    l.index[k] = i;
    l.set[k] = set[i];
    l.outcome[k] = unresolved;
    l.lanes[k++] = lanes[i];
  }
  for (size_t s = 0; s < sets; s++) l.known[s] = catalogues[s].count;

  labelling job = {.catalogues = catalogues, .set = l.set, .budget = budget,
                   .outcome = l.outcome, .histories = l.histories};
  for (int round = 0; status == PENDRES_OK; round++) {
    size_t left = 0;
    const int longer = raise_budgets(ctx, sets, catalogues, round, budget);
    status = run_lanes(ctx, l.count, l.lanes, &job);
    for (size_t i = 0; i < l.count; i++) left += l.outcome[i].attractor < 0;
    if (status != PENDRES_OK || left == 0 || !longer) break;
    status = add_recurrences(ctx, &l, catalogues);
    if (status == PENDRES_OK && round % 2 == 0) status = add_chaos(ctx, &l, catalogues);
  }
  if (status == PENDRES_OK)
    for (size_t i = 0; i < l.count; i++) outcome[l.index[i]] = l.outcome[i];
  if (status == PENDRES_OK) status = repeat(ctx, &l, set, starts, &job);
  if (status == PENDRES_OK)
    for (size_t i = 0; i < l.count; i++) outcome[l.index[i]] = l.outcome[i];
done:
  free_lost(&l);
  return status;
}

/* ---- batches ---- */

/* Members of a set are consecutive: every so many of them is sent ahead. */
static pendres_status send_scouts(pendres_context *ctx, size_t sets, pendres_catalogue *catalogues,
                                  size_t n, const size_t *set, const pendres_strobe_lane *lanes)
{
  size_t count = 0;
  pendres_scout *scouts = malloc((sets * SCOUTS + 1) * sizeof *scouts);
  if (scouts == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for scouts");
  for (size_t first = 0, last; first < n; first = last) {
    last = first;
    while (last < n && set[last] == set[first]) last++;
    const size_t members = last - first, wanted = members < SCOUTS ? members : SCOUTS;
    for (size_t k = 0; k < wanted; k++) {
      const pendres_strobe_lane *l = &lanes[first + k * members / wanted];
      scouts[count++] = (pendres_scout){.set = set[first], .y = l->y, .w = l->w};
    }
  }
  const pendres_status status = pendres_catalogue_explore(ctx, sets, catalogues, count, scouts);
  free(scouts);
  return status;
}

/* Attractors into their physical order, and outcomes after them. */
static pendres_status order_all(pendres_context *ctx, size_t sets, pendres_catalogue *catalogues,
                                size_t n, const size_t *set, pendres_outcome *outcome)
{
  pendres_status status = PENDRES_OK;
  size_t most = 0;
  for (size_t s = 0; s < sets; s++) most = catalogues[s].count > most ? catalogues[s].count : most;
  int *rank = malloc((most + 1) * sizeof *rank);
  if (rank == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  for (size_t s = 0, i = 0; s < sets && status == PENDRES_OK; s++) {
    const pendres_catalogue *c = &catalogues[s];
    status = pendres_catalogue_order(ctx, &catalogues[s], rank);
    for (; i < n && set[i] == s && status == PENDRES_OK; i++)
      if (outcome[i].attractor >= 0) {
        outcome[i].attractor = rank[outcome[i].attractor];
        outcome[i].label = c->attractors[outcome[i].attractor].label;
      }
  }
  free(rank);
  return status;
}

pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_catalogue *catalogues, int explore, size_t n,
                                    const size_t *set, const double *x, const double *v,
                                    pendres_outcome *outcome)
{
  pendres_status status = PENDRES_OK;
  pendres_strobe_lane *lanes = malloc((n + 1) * sizeof *lanes), *starts = NULL;
  long *budget = malloc((sets + 1) * sizeof *budget);
  if (explore) starts = malloc((n + 1) * sizeof *starts);
  if (lanes == NULL || budget == NULL || (explore && starts == NULL)) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
    goto done;
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    outcome[i] = unresolved;
    status = load_lane(ctx, &catalogues[set[i]].pendulum, x[i], v[i], &lanes[i]);
    if (explore) starts[i] = lanes[i];
  }
  for (size_t s = 0; s < sets; s++) {
    budget[s] = last_budget(ctx, &catalogues[s]);
    const long first = first_budget(&catalogues[s].pendulum);
    if (explore && first < budget[s]) budget[s] = first;
  }
  if (explore && status == PENDRES_OK)
    status = send_scouts(ctx, sets, catalogues, n, set, lanes);
  labelling l = {.catalogues = catalogues, .set = set, .budget = budget, .outcome = outcome};
  if (status == PENDRES_OK) status = run_lanes(ctx, n, lanes, &l);
  if (explore && status == PENDRES_OK)
    status = hunt(ctx, sets, catalogues, n, starts, lanes, set, outcome, budget);
  if (explore && status == PENDRES_OK)
    status = order_all(ctx, sets, catalogues, n, set, outcome);
  ctx->cost.settled_pendulums += (double)n;
done:
  free(lanes);
  free(starts);
  free(budget);
  return status;
}

/* ---- many pendulums of one parameter set ---- */

enum { SPEEDS = 4096 /* places of the table of steps, a power of 2 */ };

/* Steps by speed, remembered: grids have few speeds, again and again. */
typedef struct speed_table {
  double speed[SPEEDS];
  int steps[SPEEDS]; /* 0: empty */
} speed_table;

static pendres_status steps_of(pendres_context *ctx, const pendres_pendulum *p, double speed,
                               double accuracy, speed_table *t, int *steps)
{
  uint64_t bits;
  memcpy(&bits, &speed, sizeof bits);
  const size_t place = (size_t)((bits * UINT64_C(0x9e3779b97f4a7c15)) >> 52) % SPEEDS;
  pendres_status status = PENDRES_OK;
  if (t->steps[place] == 0 || t->speed[place] != speed) {
    status = pendres_steps_choose(ctx, p, speed, accuracy, &t->steps[place]);
    t->speed[place] = speed;
  }
  *steps = t->steps[place];
  return status;
}

/* Pendulums in the order of their steps, each class in its own order; steps[n] is read. */
static void order_by_steps(size_t n, const int *steps, size_t *order)
{
  size_t count = 0;
  for (int least = 0; count < n;) {
    int next = INT_MAX;
    for (size_t i = 0; i < n; i++)
      if (steps[i] > least && steps[i] < next) next = steps[i];
    for (size_t i = 0; i < n; i++)
      if (steps[i] == next) order[count++] = i;
    least = next;
  }
}

pendres_status pendres_settle_known(pendres_context *ctx, const pendres_catalogue *catalogue,
                                    size_t n, const double *x, const double *v, double accuracy,
                                    pendres_settle_budget budget, pendres_outcome *outcome)
{
  const pendres_pendulum *p = &catalogue->pendulum;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  speed_table *table = calloc(1, sizeof *table);
  int *steps = malloc((n + 1) * sizeof *steps);
  size_t *order = malloc((n + 1) * sizeof *order);
  pendres_strobe_lane *lanes = malloc((n + 1) * sizeof *lanes);
  pendres_outcome *found = malloc((n + 1) * sizeof *found);
  if (table == NULL || steps == NULL || order == NULL || lanes == NULL || found == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu pendulums", n);
    goto done;
  }
  status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = steps_of(ctx, p, fabs(v[i]), accuracy, table, &steps[i]);
  if (status != PENDRES_OK) goto done;
  order_by_steps(n, steps, order);
  for (size_t k = 0; k < n; k++) {
    const size_t i = order[k];
    found[k] = unresolved;
    lanes[k] = (pendres_strobe_lane){
      .pendulum = p, .y = x[i] - half_pi, .w = v[i] / p->drive_frequency, .steps = steps[i]};
    pendres_strobe_wrap(&lanes[k].y, &lanes[k].turns);
  }
  long most = last_budget(ctx, catalogue);
  if (budget == PENDRES_SETTLE_SHORT && first_budget(p) < most) most = first_budget(p);
  labelling l = {.catalogues = catalogue, .budget = &most, .outcome = found};
  status = run_lanes(ctx, n, lanes, &l);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) outcome[order[k]] = found[k];
  ctx->cost.settled_pendulums += (double)n;
done:
  free(table);
  free(steps);
  free(order);
  free(lanes);
  free(found);
  return status;
}
