/* settle_certain.c -- making labels certain; see settle_lanes.h. */
#include "engine/steps.h"
#include "settling/settle_lanes.h"

#include <math.h>
#include <string.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "settling/numbers.h"

/* The pendulums with uncertain labels that are to be run again. */
typedef struct uncertain_labels {
  size_t count;
  size_t *index; /* in the batch */
  size_t *set;
  pendres_strobe_lane *lanes;
  pendres_settled *outcome;
  double *error_ratio, *accuracy; /* of the latest run */
} uncertain_labels;

static int is_uncertain(const pendres_settled *o)
{
  return pendres_settle_ended(o) && !o->certain;
}

static const pendres_attractor_set *attractor_set_of(const pendres_settle_labelling *job, size_t i)
{
  return &job->attractor_sets[job->set != NULL ? job->set[i] : 0];
}

/* Where there is only one attractor, and the well does not matter, an error changes nothing. */
static void excuse(const pendres_settle_labelling *job, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    const pendres_attractor_set *c = attractor_set_of(job, i);
    if (c->count == 1 && c->any_well && job->outcome[i].attractor == 0)
      job->outcome[i].certain = 1;
  }
}

static pendres_status gather(const pendres_settle_labelling *job, size_t all, double accuracy,
                             pendres_room *room, uncertain_labels *d)
{
  size_t n = 0;
  excuse(job, all);
  for (size_t i = 0; i < all; i++) n += is_uncertain(&job->outcome[i]);
  if (n == 0) return PENDRES_OK;
  d->index = pendres_room_take(room, n, sizeof *d->index);
  d->set = pendres_room_take(room, n, sizeof *d->set);
  d->lanes = pendres_room_take(room, n, sizeof *d->lanes);
  d->outcome = pendres_room_take(room, n, sizeof *d->outcome);
  d->error_ratio = pendres_room_take(room, n, sizeof *d->error_ratio);
  d->accuracy = pendres_room_take(room, n, sizeof *d->accuracy);
  if (room->status != PENDRES_OK) return room->status;
  for (size_t i = 0; i < all; i++) {
    if (!is_uncertain(&job->outcome[i])) continue;
    d->index[d->count] = i;
    d->set[d->count] = job->set != NULL ? job->set[i] : 0;
    d->error_ratio[d->count] = job->error_ratio[i];
    d->accuracy[d->count++] = accuracy;
  }
  return PENDRES_OK;
}

/* Load what is to be run, with errors a period of d->accuracy, and drop what needs too many
   steps. */
static pendres_status load(pendres_context *ctx, const pendres_settle_labelling *job,
                           const pendres_settle_starts *from, uncertain_labels *d)
{
  size_t n = 0;
  for (size_t k = 0; k < d->count; k++) {
    const size_t i = d->index[k];
    const pendres_status status = pendres_settle_load(ctx, &job->attractor_sets[d->set[k]],
                                                      from->x[i], from->v[i], d->accuracy[k],
                                                      &d->lanes[n]);
    if (status == PENDRES_TOLERANCE_UNREACHABLE) continue; /* it stays uncertain: no failure */
    if (status != PENDRES_OK) return status;
    d->lanes[n].steps = pendres_steps_rung_of_few(d->lanes[n].steps);
    d->index[n] = i;
    d->set[n] = d->set[k];
    d->accuracy[n] = d->accuracy[k];
    d->error_ratio[n] = NAN;
    d->outcome[n++] = pendres_settle_unresolved;
  }
  d->count = n;
  return PENDRES_OK;
}

/* Run all that are left once more, for more periods than most of them need. */
static pendres_status run(pendres_context *ctx, const pendres_settle_labelling *first,
                          const pendres_settle_starts *from, uncertain_labels *d)
{
  size_t sets = 0;
  pendres_status status = load(ctx, first, from, d);
  for (size_t k = 0; k < d->count; k++) sets = d->set[k] >= sets ? d->set[k] + 1 : sets;
  pendres_room room = pendres_room_open(ctx, "sets");
  long *budget = pendres_room_take(&room, sets, sizeof *budget);
  for (size_t s = 0; s < sets && room.status == PENDRES_OK; s++) {
    const pendres_attractor_set *c = &first->attractor_sets[s];
    const long most = pendres_settle_last_budget(ctx, c);
    const long some = SETTLE_AGAIN * pendres_settle_first_budget(&c->pendulum);
    budget[s] = some < most ? some : most;
  }
  pendres_settle_labelling job = {.attractor_sets = first->attractor_sets, .set = d->set,
                                  .budget = budget, .outcome = d->outcome,
                                  .error_ratio = d->error_ratio,
                                  .drop_lost = 1};
  if (status == PENDRES_OK) status = room.status;
  if (status == PENDRES_OK) status = pendres_settle_lanes(ctx, d->count, d->lanes, &job);
  if (status == PENDRES_OK)
    status = pendres_settle_unstable(ctx, d->count, d->lanes, d->outcome, NULL);
  return pendres_room_close(&room, status);
}

/*
 * The outcome of the run counts, unless the pendulum was lost or has not settled in it. Pendulums
 * that are still uncertain, and can be run more exactly, stay in the list.
 */
static void take_over(const pendres_settle_labelling *job, uncertain_labels *d)
{
  size_t left = 0;
  for (size_t k = 0; k < d->count; k++) {
    const size_t i = d->index[k];
    const int ended = pendres_settle_ended(&d->outcome[k]);
    if (!ended && !isinf(d->error_ratio[k])) continue;
    if (ended) {
      job->outcome[i] = d->outcome[k];
      job->error_ratio[i] = d->error_ratio[k];
    }
    if (d->outcome[k].certain || d->accuracy[k] <= settle_most_exact) continue;
    d->index[left] = i;
    d->set[left] = d->set[k];
    d->error_ratio[left] = d->error_ratio[k];
    d->accuracy[left++] = d->accuracy[k];
  }
  d->count = left;
}

/* For methods whose errors are not propagated: labels stay, and are certain where those of fixed
   steps are certain and agree. */
static pendres_status compare(pendres_context *ctx, const pendres_settle_labelling *job,
                              const pendres_settle_starts *from, uncertain_labels *d)
{
  pendres_settle_labelling other = *job;
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_settled *own = other.outcome = pendres_room_take(&room, from->n, sizeof *own);
  pendres_status status = room.status;
  if (status == PENDRES_OK && from->n > 0) memcpy(own, job->outcome, from->n * sizeof *own);
  while (d->count > 0 && status == PENDRES_OK) {
    status = run(ctx, &other, from, d);
    if (status == PENDRES_OK) take_over(&other, d);
    for (size_t k = 0; k < d->count; k++)
      d->accuracy[k] = pendres_settle_tighter(d->accuracy[k], d->error_ratio[k]);
  }
  for (size_t i = 0; i < from->n && status == PENDRES_OK; i++) {
    pendres_settled *o = &job->outcome[i];
    o->certain = pendres_settle_ended(o) && own[i].certain && own[i].attractor == o->attractor &&
                 own[i].well == o->well;
  }
  return pendres_room_close(&room, status);
}

pendres_status pendres_settle_certain(pendres_context *ctx, const pendres_settle_labelling *job,
                                      const pendres_settle_starts *from, double accuracy)
{
  uncertain_labels d = {0};
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_status status = gather(job, from->n, accuracy, &room, &d);
  if (!pendres_settle_carries(ctx) && status == PENDRES_OK && d.count > 0) {
    const pendres_options asked = ctx->options;
    ctx->options.method = PENDRES_BLOCK_FIXED;
    ctx->options.steps_per_period = 0;
    status = compare(ctx, job, from, &d);
    ctx->options = asked;
  }
  while (pendres_settle_carries(ctx) && d.count > 0 && status == PENDRES_OK) {
    for (size_t k = 0; k < d.count; k++)
      d.accuracy[k] = pendres_settle_tighter(d.accuracy[k], d.error_ratio[k]);
    status = run(ctx, job, from, &d);
    if (status == PENDRES_OK) take_over(job, &d);
  }
  return pendres_room_close(&room, status);
}
