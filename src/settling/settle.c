/* settle.c -- settling many pendulums of many parameter sets at once; see settle.h. */
#include "settling/settle.h"

#include <limits.h>
#include <math.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "model/model.h"
#include "orbits/linear.h"
#include "settling/numbers.h"
#include "settling/settle_lanes.h"
#include "orbits/strobe_noise.h"

/* ---- batches ---- */

/* Integrate some pendulums of each set first, equally spaced among those of the set, and look at
   rest. */
static pendres_status send_guesses(pendres_context *ctx, size_t sets,
                                   pendres_attractor_set *attractor_sets,
                                   size_t n, const size_t *set, const pendres_strobe_lane *lanes)
{
  enum { BOTTOMS = PENDRES_ATTRACTOR_SET_BOTTOMS };
  double bottom[BOTTOMS];
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "guesses");
  pendres_initial_guess *guesses =
    pendres_room_take(&room, sets * (GUESS_ACROSS + BOTTOMS), sizeof *guesses);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t first = 0, last; first < n; first = last) {
    last = first;
    while (last < n && set[last] == set[first]) last++;
    if (attractor_sets[set[first]].grows) continue;
    const size_t members = last - first;
    const size_t wanted = members < GUESS_ACROSS ? members : GUESS_ACROSS;
    for (size_t k = 0; k < wanted; k++) {
      const pendres_strobe_lane *l = &lanes[first + k * members / wanted];
      guesses[count++] = (pendres_initial_guess){.set = set[first], .y = l->y, .w = l->w};
    }
    const size_t wells = pendres_attractor_set_bottoms(lanes[first].pendulum, bottom);
    for (size_t k = 0; k < wells; k++)
      guesses[count++] = (pendres_initial_guess){.set = set[first], .y = bottom[k]};
  }
  return pendres_room_close(
    &room, pendres_attractor_set_explore(ctx, sets, attractor_sets, count, guesses));
}

/* Mark the sets whose force is linear and lets all motions grow without bound, and tell from where
   on they do where it is nearly so. */
static pendres_status tell_growing(pendres_context *ctx, size_t sets,
                                   pendres_attractor_set *attractor_sets)
{
  pendres_room room = pendres_room_open(ctx, "parameter sets");
  pendres_pendulum *p = pendres_room_take(&room, sets, sizeof *p);
  pendres_linear *linear = pendres_room_take(&room, sets, sizeof *linear);
  for (size_t s = 0; s < sets && room.status == PENDRES_OK; s++) p[s] = attractor_sets[s].pendulum;
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = pendres_linear_find(ctx, sets, p, linear);
  for (size_t s = 0; s < sets && status == PENDRES_OK; s++)
    attractor_sets[s].grows = linear[s].fate == PENDRES_LINEAR_GROWS;
  for (size_t s = 0; s < sets && status == PENDRES_OK; s++)
    status = pendres_escape_beside_find(ctx, &p[s], &attractor_sets[s].beside);
  return pendres_room_close(&room, status);
}

static int is_plain(const pendres_pendulum *p)
{
  return pendres_model_kind(p) == PENDRES_MODEL_PLAIN;
}

/*
 * Put those pendulums at their starts that have not settled with a certain label. soon: for a run
 * of plain ones that need not be exact, over so few periods that nothing goes wrong in it which the
 * error that they carry does not tell. In longer ones a pendulum next to a fold may miss the orbit
 * that it should settle on, and one that comes close to the upright state be taken for chaotic.
 */
static pendres_status load_batch(pendres_context *ctx, const pendres_attractor_set *attractor_sets,
                                 const pendres_settle_starts *from, int soon,
                                 pendres_settled *outcome, pendres_strobe_lane *lanes)
{
  const double exact = pendres_accuracy_to_settle(ctx), rough = pendres_accuracy_to_settle_soon();
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < from->n && status == PENDRES_OK; i++) {
    const pendres_attractor_set *c = &attractor_sets[from->set[i]];
    const pendres_pendulum *p = &c->pendulum;
    const double x = from->x[i], v = from->v[i];
    if (pendres_settle_ended(&outcome[i]) && outcome[i].certain) continue;
    outcome[i] = pendres_settle_unresolved;
    const int roughly = soon && is_plain(p);
    status = pendres_settle_load(ctx, c, x, v, roughly ? rough : exact, &lanes[i]);
    if (roughly)
      pendres_strobe_noise_choose(pendres_steps_speed(p, x, v),
                                  pendres_strobe_noise_fastest(ctx, p), rough, &lanes[i]);
  }
  return status;
}

/* Set the budgets of the first run, or of the one before it. */
static void set_budgets(const pendres_context *ctx, size_t sets,
                        const pendres_attractor_set *attractor_sets, int soon, long *budget)
{
  for (size_t s = 0; s < sets; s++) {
    const pendres_pendulum *p = &attractor_sets[s].pendulum;
    const double some = settle_soon_least + settle_soon_times * pendres_model_settling(p);
    const long most = pendres_settle_last_budget(ctx, &attractor_sets[s]);
    long first = pendres_settle_first_budget(p);
    if (soon) first = is_plain(p) ? (long)fmin(some, settle_soon_most) : 0;
    budget[s] = first < most ? first : most;
  }
}

/* Put attractors into their physical order, and renumber outcomes accordingly. */
static pendres_status order_all(pendres_context *ctx, size_t sets,
                                pendres_attractor_set *attractor_sets,
                                size_t n, const size_t *set, pendres_settled *outcome)
{
  size_t most = 0;
  for (size_t s = 0; s < sets; s++)
    if (attractor_sets[s].count > most) most = attractor_sets[s].count;
  pendres_room room = pendres_room_open(ctx, "attractors");
  int *rank = pendres_room_take(&room, most, sizeof *rank);
  pendres_status status = room.status;
  for (size_t s = 0, i = 0; s < sets && status == PENDRES_OK; s++) {
    const pendres_attractor_set *c = &attractor_sets[s];
    status = pendres_attractor_set_order(ctx, &attractor_sets[s], rank);
    for (; i < n && set[i] == s && status == PENDRES_OK; i++)
      if (outcome[i].attractor >= 0) {
        outcome[i].attractor = rank[outcome[i].attractor];
        outcome[i].label = c->attractors[outcome[i].attractor].label;
      }
  }
  return pendres_room_close(&room, status);
}

/* Labels of pendulums that were integrated as slow as they started are not certain where attractors
   have turned out to be faster: they are integrated once more. */
static void doubt(const pendres_attractor_set *attractor_sets, const pendres_settle_starts *from,
                  pendres_settled *outcome, double *error_ratio)
{
  double driven = 0.0;
  for (size_t i = 0; i < from->n; i++) {
    const pendres_attractor_set *c = &attractor_sets[from->set[i]];
    if (i == 0 || from->set[i] != from->set[i - 1]) driven = pendres_settle_driven(c);
    if (outcome[i].attractor == PENDRES_ATTRACTOR_UNSTABLE) continue; /* it does not move */
    if (c->grows || !(pendres_steps_speed(&c->pendulum, from->x[i], from->v[i]) < driven)) continue;
    outcome[i].certain = 0;
    error_ratio[i] = NAN;
  }
}

pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_attractor_set *attractor_sets,
                                    const pendres_settle_starts *from, pendres_settled *outcome)
{
  const size_t n = from->n, *set = from->set;
  const double accuracy = pendres_accuracy_to_settle(ctx);
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_strobe_lane *lanes = pendres_room_take(&room, n, sizeof *lanes);
  double *error_ratio = pendres_room_take(&room, n, sizeof *error_ratio);
  long *budget = pendres_room_take(&room, sets, sizeof *budget);
  pendres_status status = room.status;
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0; i < n; i++) {
    outcome[i] = pendres_settle_unresolved;
    error_ratio[i] = NAN;
  }
  const int soon = from->wanted == PENDRES_SETTLE_LABELS && pendres_settle_carries(ctx) &&
                   pendres_accuracy_to_settle_soon() > accuracy;
  status = load_batch(ctx, attractor_sets, from, soon, outcome, lanes);
  if (status == PENDRES_OK) status = tell_growing(ctx, sets, attractor_sets);
  if (status == PENDRES_OK) status = send_guesses(ctx, sets, attractor_sets, n, set, lanes);
  pendres_settle_labelling l = {
    .attractor_sets =
      attractor_sets, .set = set, .budget = budget, .outcome = outcome, .error_ratio = error_ratio};
  set_budgets(ctx, sets, attractor_sets, soon, budget);
  if (soon && status == PENDRES_OK) status = pendres_settle_lanes(ctx, n, lanes, &l);
  if (soon && status == PENDRES_OK)
    status = load_batch(ctx, attractor_sets, from, 0, outcome, lanes);
  set_budgets(ctx, sets, attractor_sets, 0, budget);
  if (status == PENDRES_OK) status = pendres_settle_lanes(ctx, n, lanes, &l);
  if (status == PENDRES_OK)
    status = pendres_settle_search(ctx, sets, attractor_sets, from, &l, lanes);
  if (status == PENDRES_OK) doubt(attractor_sets, from, outcome, error_ratio);
  if (status == PENDRES_OK && from->wanted != PENDRES_SETTLE_NOTHING)
    status = pendres_settle_certain(ctx, &l, from, accuracy);
  if (status == PENDRES_OK) status = order_all(ctx, sets, attractor_sets, n, set, outcome);
  ctx->cost.settled_pendulums += (double)n;
  return pendres_room_close(&room, status);
}

/* ---- many pendulums of one parameter set ---- */

/* Put pendulums into the order of their numbers of steps, and of their own numbers. */
static void order_by_steps(size_t n, const pendres_strobe_lane *lanes, size_t *order)
{
  size_t count = 0;
  for (int least = 0; count < n;) {
    int next = INT_MAX;
    for (size_t i = 0; i < n; i++)
      if (lanes[i].steps > least && lanes[i].steps < next) next = lanes[i].steps;
    for (size_t i = 0; i < n; i++)
      if (lanes[i].steps == next) order[count++] = i;
    least = next;
  }
}

/* Settle those pendulums of one parameter set that are unresolved, from their starts. */
static pendres_status settle_some(pendres_context *ctx, const pendres_settle_labelling *l,
                                  const pendres_settle_starts *from, double accuracy, int soon,
                                  pendres_strobe_lane *lanes)
{
  const pendres_pendulum *p = &l->attractor_sets->pendulum;
  const double fastest = soon ? pendres_strobe_noise_fastest(ctx, p) : -1.0;
  size_t count = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < from->n && status == PENDRES_OK; i++) {
    if (pendres_settle_ended(&l->outcome[i])) continue;
    status = pendres_settle_load(ctx, l->attractor_sets, from->x[i], from->v[i], accuracy,
                                 &lanes[i]);
    pendres_strobe_noise_choose(pendres_steps_speed(p, from->x[i], from->v[i]), fastest, accuracy,
                                &lanes[i]);
    l->error_ratio[i] = NAN;
    count++;
  }
  if (count == 0 || status != PENDRES_OK) return status;
  order_by_steps(from->n, lanes, l->order);
  pendres_settle_labelling job = *l;
  status = pendres_settle_lanes(ctx, from->n, lanes, &job);
  if (status == PENDRES_OK)
    status = pendres_settle_unstable(ctx, from->n, lanes, l->outcome, NULL);
  ctx->cost.settled_pendulums += (double)count;
  return status == PENDRES_OK ? pendres_settle_certain(ctx, l, from, accuracy) : status;
}

pendres_status pendres_settle_known(pendres_context *ctx,
                                    const pendres_attractor_set *attractor_set,
                                    const pendres_settle_starts *starts, double accuracy,
                                    pendres_settle_budget budget, pendres_settled *outcome)
{
  const size_t n = starts->n;
  const double exact = pendres_accuracy_to_settle(ctx);
  const int soon = budget == PENDRES_SETTLE_SHORT;
  long most = pendres_settle_last_budget(ctx, attractor_set);
  const long first = pendres_settle_first_budget(&attractor_set->pendulum);
  if (soon && first < most) most = first;
  pendres_room room = pendres_room_open(ctx, "pendulums");
  pendres_strobe_lane *lanes = pendres_room_take(&room, n, sizeof *lanes);
  const pendres_settle_labelling l = {
    .attractor_sets = attractor_set, .order = pendres_room_take(&room, n, sizeof *l.order),
    .budget = &most, .outcome = outcome,
    .error_ratio = pendres_room_take(&room, n, sizeof *l.error_ratio)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) outcome[i] = pendres_settle_unresolved;
  pendres_status status = settle_some(ctx, &l, starts, accuracy, soon, lanes);
  /* Those that have settled nowhere are integrated as exactly as attractors are looked for. Where
     they become much faster than they start, the steps of a picture may be too long for what they
     settle on. */
  if (status == PENDRES_OK && !soon && accuracy > exact && pendres_settle_carries(ctx))
    status = settle_some(ctx, &l, starts, exact, soon, lanes);
  return pendres_room_close(&room, status);
}
