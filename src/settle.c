/* settle.c -- what pendulums settle on; see attractor.h. */
#include <pendres/attractor.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue.h"
#include "context_internal.h"
#include "settle.h"
#include "steps.h"
#include "strobe_run.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

enum {
  SCOUTS = 12,        /* members of a parameter set sent ahead */
  BATCH_SETS = 64,    /* parameter sets worked on at a time */
  HISTORY = 33,       /* strobe points kept of a pendulum that does not settle */
  LONGEST_PERIOD = 16 /* of an orbit that is looked for: half the history */
};

struct pendres_attractors {
  size_t sets;
  pendres_catalogue *catalogues;
  size_t count;
  const pendres_attractor **attractors; /* all of them, set after set */
};

/* Decades of decay from any start to the middle of a trap. */
static double settling_time(const pendres_pendulum *p)
{
  return 1.0 / (0.5 * p->damping * two_pi / p->drive_frequency);
}

/* Periods after which a pendulum that is in no trap is looked at closely. */
static long first_budget(const pendres_pendulum *p)
{
  return (long)ceil(fmin(20.0 + 10.0 * settling_time(p), 1e7));
}

static long last_budget(const pendres_context *ctx, const pendres_pendulum *p)
{
  if (ctx->options.period_budget > 0) return ctx->options.period_budget;
  return (long)ceil(fmin(2000.0 + 100.0 * settling_time(p), 1e8));
}

/* ---- labelling against catalogues ---- */

typedef struct labelling {
  const pendres_catalogue *catalogues;
  const size_t *set; /* of each lane */
  const long *budget; /* of each set */
  pendres_outcome *outcome;
} labelling;

static int settle_look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const labelling *l = arg;
  pendres_outcome *o = &l->outcome[index];
  const pendres_catalogue *c = &l->catalogues[l->set[index]];
  o->attractor = pendres_catalogue_locate(c, lane, &o->well);
  if (o->attractor < 0) return lane->period >= l->budget[l->set[index]];
  o->label = c->attractors[o->attractor].label;
  o->settling_periods = lane->period;
  return 1;
}

/* Lanes that start inside a trap are done before they begin; the others are run. */
static pendres_status run_lanes(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                labelling *l)
{
  size_t left = 0;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_strobe_lane *rest = malloc((n + 1) * sizeof *rest);
  size_t *set = malloc((n + 1) * sizeof *set), *origin = malloc((n + 1) * sizeof *origin);
  pendres_outcome *outcome = malloc((n + 1) * sizeof *outcome);
  if (rest == NULL || set == NULL || origin == NULL || outcome == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu pendulums", n);
    goto done;
  }
  const pendres_outcome none = {
    .label = PENDRES_LABEL_UNRESOLVED, .attractor = -1, .settling_periods = -1};
  for (size_t i = 0; i < n; i++) {
    l->outcome[i] = none;
    if (settle_look(l, i, &lanes[i])) continue;
    l->outcome[i] = none;
    outcome[left] = none;
    set[left] = l->set[i];
    origin[left] = i;
    rest[left++] = lanes[i];
  }
  labelling some = *l;
  some.set = set;
  some.outcome = outcome;
  status = pendres_strobe_run(ctx, left, rest, settle_look, &some);
  for (size_t i = 0; i < left && status == PENDRES_OK; i++) {
    l->outcome[origin[i]] = outcome[i];
    lanes[origin[i]] = rest[i];
  }
done:
  free(rest);
  free(set);
  free(origin);
  free(outcome);
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

typedef struct history {
  size_t filled;
  double y[HISTORY], w[HISTORY]; /* unwrapped angle, newest last */
} history;

static int record_look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  history *h = (history *)arg + index;
  h->y[h->filled] = lane->y + two_pi * (double)lane->turns;
  h->w[h->filled] = lane->w;
  return ++h->filled == HISTORY;
}

/* The period that a history repeats itself with most closely, the shortest if several do. */
static void recurrence(const history *h, pendres_scout *s)
{
  double best = INFINITY;
  const int last = HISTORY - 1;
  s->period = 1;
  s->winding = 0;
  for (int q = 1; q <= LONGEST_PERIOD; q++) {
    const double advance = h->y[last] - h->y[last - q];
    const double turns = rint(advance / two_pi);
    const double distance = hypot(advance - two_pi * turns, h->w[last] - h->w[last - q]);
    if (distance < 0.5 * best) {
      best = distance;
      s->period = q;
      s->winding = (int)turns;
    }
  }
}

/*
 * Pendulums without a label after the first budget: refine the orbits that they are near, add
 * those to the catalogues, and label again, with all the budget.
 */
static pendres_status hunt(pendres_context *ctx, size_t sets, pendres_catalogue *catalogues,
                           size_t n, pendres_strobe_lane *lanes, const size_t *set,
                           pendres_outcome *outcome, long *budget)
{
  size_t lost = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++) lost += outcome[i].attractor < 0;
  if (lost == 0) return status;

  size_t *index = malloc(lost * sizeof *index), *lost_set = malloc(lost * sizeof *lost_set);
  history *h = calloc(lost, sizeof *h);
  pendres_scout *guess = malloc(lost * sizeof *guess);
  pendres_strobe_lane *rest = malloc(lost * sizeof *rest);
  pendres_outcome *again = malloc(lost * sizeof *again);
  if (index == NULL || lost_set == NULL || h == NULL || guess == NULL || rest == NULL ||
      again == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", lost);
    goto done;
  }
  lost = 0;
  for (size_t i = 0; i < n; i++)
    if (outcome[i].attractor < 0) {
      index[lost] = i;
      lost_set[lost] = set[i];
      rest[lost++] = lanes[i];
    }
  status = pendres_strobe_run(ctx, lost, rest, record_look, h);
  for (size_t i = 0; i < lost && status == PENDRES_OK; i++) {
    guess[i] = (pendres_scout){.set = lost_set[i], .y = rest[i].y, .w = rest[i].w};
    recurrence(&h[i], &guess[i]);
  }
  if (status == PENDRES_OK) status = pendres_catalogue_add(ctx, sets, catalogues, lost, guess);
  for (size_t i = 0; i < sets; i++) budget[i] = last_budget(ctx, &catalogues[i].pendulum);
  labelling l = {
    .catalogues = catalogues, .set = lost_set, .budget = budget, .outcome = again};
  if (status == PENDRES_OK) status = run_lanes(ctx, lost, rest, &l);
  for (size_t i = 0; i < lost && status == PENDRES_OK; i++) {
    outcome[index[i]] = again[i];
    lanes[index[i]] = rest[i];
  }
done:
  free(index);
  free(lost_set);
  free(h);
  free(guess);
  free(rest);
  free(again);
  return status;
}

/* ---- batches ---- */

/* Numbers may have changed while attractors were added: look each final state up again. */
static void relabel(const pendres_catalogue *c, const size_t *set, size_t n,
                    const pendres_strobe_lane *lanes, pendres_outcome *outcome)
{
  for (size_t i = 0; i < n; i++) {
    if (outcome[i].attractor < 0) continue;
    outcome[i].attractor = pendres_catalogue_locate(&c[set[i]], &lanes[i], &outcome[i].well);
    if (outcome[i].attractor >= 0)
      outcome[i].label = c[set[i]].attractors[outcome[i].attractor].label;
  }
}

pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_catalogue *catalogues, int explore, size_t n,
                                    const size_t *set, const double *x, const double *v,
                                    pendres_outcome *outcome)
{
  pendres_status status = PENDRES_OK;
  pendres_strobe_lane *lanes = malloc((n + 1) * sizeof *lanes);
  long *budget = malloc((sets + 1) * sizeof *budget);
  pendres_scout *scouts = malloc((sets * SCOUTS + 1) * sizeof *scouts);
  if (lanes == NULL || budget == NULL || scouts == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
    goto done;
  }
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = load_lane(ctx, &catalogues[set[i]].pendulum, x[i], v[i], &lanes[i]);
  if (explore && status == PENDRES_OK) {
    /* Members of a set are consecutive: every so many of them is sent ahead. */
    size_t count = 0;
    for (size_t first = 0, last; first < n; first = last) {
      last = first;
      while (last < n && set[last] == set[first]) last++;
      const size_t members = last - first, wanted = members < SCOUTS ? members : SCOUTS;
      for (size_t k = 0; k < wanted; k++) {
        const pendres_strobe_lane *l = &lanes[first + k * members / wanted];
        scouts[count++] = (pendres_scout){.set = set[first], .y = l->y, .w = l->w};
      }
    }
    status = pendres_catalogue_explore(ctx, sets, catalogues, count, scouts);
  }
  for (size_t i = 0; i < sets; i++)
    budget[i] = explore ? first_budget(&catalogues[i].pendulum)
                        : last_budget(ctx, &catalogues[i].pendulum);
  labelling l = {.catalogues = catalogues, .set = set, .budget = budget, .outcome = outcome};
  if (status == PENDRES_OK) status = run_lanes(ctx, n, lanes, &l);
  if (explore && status == PENDRES_OK) {
    status = hunt(ctx, sets, catalogues, n, lanes, set, outcome, budget);
    if (status == PENDRES_OK) relabel(catalogues, set, n, lanes, outcome);
  }
  ctx->cost.settled_pendulums += (double)n;
done:
  free(lanes);
  free(budget);
  free(scouts);
  return status;
}

/* ---- public functions ---- */

static int same_parameters(const pendres_pendulum *a, const pendres_pendulum *b)
{
  return a->damping == b->damping && a->drive_amplitude == b->drive_amplitude &&
         a->drive_frequency == b->drive_frequency;
}

static pendres_status check_states(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                   size_t stride, const double *x, const double *v)
{
  for (size_t i = 0; i < n; i++) {
    const char *why = NULL;
    if (pendres_pendulum_check(&p[i * stride], &why) == PENDRES_OK &&
        !(isfinite(x[i]) && isfinite(v[i])))
      why = "position and velocity must be finite";
    if (why == NULL && p[i * stride].damping == 0.0)
      why = "without damping nothing settles";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  return PENDRES_OK;
}

void pendres_attractors_free(pendres_attractors *set)
{
  if (set == NULL) return;
  for (size_t i = 0; i < set->sets; i++) pendres_catalogue_clear(&set->catalogues[i]);
  free(set->catalogues);
  free(set->attractors);
  free(set);
}

size_t pendres_attractors_count(const pendres_attractors *set)
{
  return set != NULL ? set->count : 0;
}

const pendres_attractor *pendres_attractors_get(const pendres_attractors *set, size_t i)
{
  return set != NULL && i < set->count ? set->attractors[i] : NULL;
}

static pendres_attractors *create_sets(size_t sets)
{
  pendres_attractors *set = calloc(1, sizeof *set);
  if (set == NULL) return NULL;
  set->catalogues = calloc(sets + 1, sizeof *set->catalogues);
  if (set->catalogues == NULL) {
    free(set);
    return NULL;
  }
  set->sets = sets;
  return set;
}

/* The list of all attractors, after all have been found. */
static int index_sets(pendres_attractors *set)
{
  size_t count = 0;
  for (size_t i = 0; i < set->sets; i++) count += set->catalogues[i].count;
  set->attractors = malloc((count + 1) * sizeof *set->attractors);
  if (set->attractors == NULL) return -1;
  for (size_t i = 0; i < set->sets; i++)
    for (size_t j = 0; j < set->catalogues[i].count; j++)
      set->attractors[set->count++] = &set->catalogues[i].attractors[j];
  return 0;
}

/* Scouts that see the whole of a well, at rest and moving. */
static size_t default_scouts(double x[64], double v[64])
{
  size_t n = 0;
  for (int i = 0; i < 12; i++)
    for (int j = -1; j <= 1; j++) {
      x[n] = half_pi + two_pi * (i - 5.5) / 12.0;
      v[n++] = 1.3 * j;
    }
  return n;
}

pendres_status pendres_attractors_find(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                       const double *x, const double *v, pendres_attractors **out)
{
  double default_x[64], default_v[64];
  if (ctx == NULL || p == NULL || out == NULL || (n > 0 && (x == NULL || v == NULL)))
    return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  if (n == 0) {
    n = default_scouts(default_x, default_v);
    x = default_x;
    v = default_v;
  }
  pendres_status status = check_states(ctx, n, p, 0, x, v);
  if (status != PENDRES_OK) return status;

  pendres_attractors *set = create_sets(1);
  size_t *zero = calloc(n, sizeof *zero);
  pendres_outcome *outcome = malloc(n * sizeof *outcome);
  if (set == NULL || zero == NULL || outcome == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  set->catalogues[0].pendulum = *p;
  status = pendres_settle_batch(ctx, 1, set->catalogues, 1, n, zero, x, v, outcome);
  if (status == PENDRES_OK && index_sets(set) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (status == PENDRES_OK) {
    *out = set;
    set = NULL;
  }
done:
  pendres_attractors_free(set);
  free(zero);
  free(outcome);
  return status;
}

pendres_status pendres_attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                         size_t n, const double *x, const double *v,
                                         pendres_outcome *outcome)
{
  if (ctx == NULL || set == NULL || set->sets != 1 ||
      (n > 0 && (x == NULL || v == NULL || outcome == NULL)))
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = check_states(ctx, n, &set->catalogues[0].pendulum, 0, x, v);
  if (status != PENDRES_OK || n == 0) return status;
  size_t *zero = calloc(n, sizeof *zero);
  if (zero == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums", n);
  /* Nothing is explored, so the catalogue is only read. */
  status = pendres_settle_batch(ctx, 1, set->catalogues, 0, n, zero, x, v, outcome);
  free(zero);
  return status;
}

/* Number of runs of equal parameters. */
static size_t count_sets(size_t n, const pendres_pendulum *p)
{
  size_t sets = n > 0;
  for (size_t i = 1; i < n; i++) sets += !same_parameters(&p[i], &p[i - 1]);
  return sets;
}

pendres_status pendres_settle(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                              const double *x, const double *v, pendres_outcome *outcome,
                              pendres_attractors **found)
{
  if (found != NULL) *found = NULL;
  if (ctx == NULL ||
      (n > 0 && (pendulums == NULL || x == NULL || v == NULL || outcome == NULL)))
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = check_states(ctx, n, pendulums, 1, x, v);
  if (status != PENDRES_OK) return status;

  pendres_attractors *all = create_sets(count_sets(n, pendulums));
  size_t *set = malloc((n + 1) * sizeof *set);
  if (all == NULL || set == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  size_t offset = 0; /* attractors of earlier sets */
  for (size_t first = 0, last, next_set = 0; first < n && status == PENDRES_OK; first = last) {
    const size_t base = next_set;
    for (last = first; last < n; last++) {
      if (last == first || !same_parameters(&pendulums[last], &pendulums[last - 1])) {
        if (next_set - base == BATCH_SETS) break;
        all->catalogues[next_set++].pendulum = pendulums[last];
      }
      set[last] = next_set - 1 - base;
    }
    pendres_catalogue *c = all->catalogues + base;
    status = pendres_settle_batch(ctx, next_set - base, c, 1, last - first, set + first, x + first,
                                  v + first, outcome + first);
    /* Indices into the list of all attractors. */
    size_t starts[BATCH_SETS];
    for (size_t s = 0; s < next_set - base; s++) {
      starts[s] = offset;
      offset += c[s].count;
    }
    for (size_t i = first; i < last && status == PENDRES_OK; i++)
      if (outcome[i].attractor >= 0) outcome[i].attractor += (int)starts[set[i]];
  }
  if (status == PENDRES_OK && index_sets(all) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (status == PENDRES_OK && found != NULL) {
    *found = all;
    all = NULL;
  }
done:
  pendres_attractors_free(all);
  free(set);
  return status;
}
