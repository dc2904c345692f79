/* settle_search.c -- what attracts pendulums that are in no known trapping ellipse; see
   settle_lanes.h. */
#include "settling/settle_lanes.h"

#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "settling/annulus_find.h"
#include "settling/chaos.h"
#include "settling/exponents/undriven.h"

/* The pendulums of a batch that have not settled so far: they are called lost here. */
typedef struct lost_lanes {
  size_t count;
  size_t *index; /* in the batch */
  size_t *set;
  pendres_strobe_lane *lanes;
  pendres_settled *outcome;
  pendres_settle_history *histories;
  pendres_initial_guess *guesses;
  const pendres_strobe_lane **suspects;
  double *x; /* where the suspects started from */
  size_t *known;   /* attractors of each set when the search began */
  size_t *watched; /* covers of each set when the latest round began */
  unsigned char *found; /* of each set: whether chaos was found after the latest round */
  unsigned char *over;  /* of each set: its budget had been spent before the latest round */
} lost_lanes;

static void take_room(pendres_room *room, size_t sets, lost_lanes *l)
{
  const size_t n = l->count;
  l->index = pendres_room_take(room, n, sizeof *l->index);
  l->set = pendres_room_take(room, n, sizeof *l->set);
  l->lanes = pendres_room_take(room, n, sizeof *l->lanes);
  l->outcome = pendres_room_take(room, n, sizeof *l->outcome);
  l->histories = pendres_room_take(room, n, sizeof *l->histories);
  l->guesses = pendres_room_take(room, n, sizeof *l->guesses);
  l->suspects = pendres_room_take(room, n, sizeof *l->suspects);
  l->x = pendres_room_take(room, n, sizeof *l->x);
  l->known = pendres_room_take(room, sets, sizeof *l->known);
  l->watched = pendres_room_take(room, sets, sizeof *l->watched);
  l->found = pendres_room_take(room, sets, sizeof *l->found);
  l->over = pendres_room_take(room, sets, sizeof *l->over);
}

/* Whether a lane is lost while the budget of its set is not yet spent. */
static int searched(const lost_lanes *l, size_t i)
{
  return !pendres_settle_ended(&l->outcome[i]) && !l->over[l->set[i]];
}

/* Look for orbits near the lost lanes, a few in each set. */
static pendres_status add_recurrences(pendres_context *ctx, lost_lanes *l,
                                      pendres_attractor_set *attractor_sets)
{
  size_t n = 0, in_set = 0;
  for (size_t i = 0; i < l->count; i++) {
    if (i == 0 || l->set[i] != l->set[i - 1]) in_set = 0;
    if (!searched(l, i) || l->histories[i].filled == 0) continue;
    const pendres_settle_history *h = &l->histories[i];
    const pendres_recurrence r = {h->filled, PENDRES_SETTLE_HISTORY, h->y, h->w};
    const double turn = pendres_model_turn(&attractor_sets[l->set[i]].pendulum);
    if (in_set < PENDRES_MOST_GUESSES && pendres_recurrence_find(&r, turn, &l->guesses[n])) {
      l->guesses[n++].set = l->set[i];
      in_set++;
    }
  }
  return pendres_attractor_set_add(ctx, attractor_sets, n, l->guesses);
}

/*
 * Whether a lost lane is on none of the known attractors. The cells of chaotic attractors that were
 * known before the latest round do not count: the lane has left them repeatedly, or it would not be
 * lost. It only passes through them, as chaos does whose bands lie next to those of its mirror
 * image.
 */
static int nowhere(const pendres_attractor_set *c, size_t watched, const pendres_strobe_lane *lane)
{
  for (size_t k = watched; k < c->covers; k++)
    if (pendres_cover_holds(c->cover[k], lane->y, lane->w)) return 0;
  return pendres_attractor_set_ellipse(c, lane->y, lane->w) == NULL &&
         pendres_attractor_set_annulus(c, lane->y, lane->w) == NULL;
}

/* Look for rotations among the lost lanes, set by set. */
static pendres_status add_rotations(pendres_context *ctx, lost_lanes *l,
                                    pendres_attractor_set *attractor_sets,
                                    const pendres_settle_starts *from, const long *budget)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0, last; first < l->count && status == PENDRES_OK; first = last) {
    pendres_attractor_set *c = &attractor_sets[l->set[first]];
    pendres_annulus_suspects some = {.lane = l->suspects, .x = l->x};
    int found = 0;
    for (last = first; last < l->count && l->set[last] == l->set[first]; last++)
      if (searched(l, last) && nowhere(c, l->watched[l->set[last]], &l->lanes[last])) {
        l->x[some.n] = from->x[l->index[last]];
        l->suspects[some.n++] = &l->lanes[last];
      }
    status = pendres_annulus_find(ctx, c, budget[l->set[first]], &some, &found);
    l->found[l->set[first]] |= (unsigned char)found;
  }
  return status;
}

/*
 * Look for chaos among the lost lanes, set by set, one attractor after the other. Lanes that are on
 * their way to what has been found, or that have left transient chaos, will settle in the next
 * round.
 */
static pendres_status add_chaos(pendres_context *ctx, lost_lanes *l,
                                pendres_attractor_set *attractor_sets)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0, last; first < l->count && status == PENDRES_OK; first = last) {
    pendres_attractor_set *c = &attractor_sets[l->set[first]];
    pendres_chaos_verdict verdict = PENDRES_CHAOS_NEW;
    for (last = first; last < l->count && l->set[last] == l->set[first];) last++;
    if (l->over[l->set[first]] || pendres_undriven(&c->pendulum)) continue; /* rest or rotations */
    while (verdict == PENDRES_CHAOS_NEW && status == PENDRES_OK) {
      size_t n = 0;
      for (size_t i = first; i < last; i++)
        if (searched(l, i) && nowhere(c, l->watched[l->set[i]], &l->lanes[i]))
          l->suspects[n++] = &l->lanes[i];
      status = pendres_chaos_find(ctx, c, n, l->suspects, &verdict);
      l->found[l->set[first]] |= verdict == PENDRES_CHAOS_NEW || verdict == PENDRES_CHAOS_KNOWN;
    }
  }
  return status;
}

/* Run lanes that have settled on an attractor found by the search once more from the start, to find
   the time in which they settle. */
static pendres_status repeat(pendres_context *ctx, lost_lanes *l, const pendres_settle_starts *from,
                             const pendres_strobe_lane *lanes, pendres_settle_labelling *job)
{
  size_t n = 0;
  for (size_t i = 0; i < l->count; i++) {
    const int attractor = l->outcome[i].attractor;
    if (attractor < 0 || (size_t)attractor < l->known[l->set[i]]) continue;
    const size_t k = l->index[n] = l->index[i];
    l->set[n] = from->set[k];
    l->outcome[n] = pendres_settle_unresolved;
    l->lanes[n++] = pendres_settle_load_like(&lanes[k], from->x[k], from->v[k]);
  }
  job->outcome = l->outcome;
  job->set = l->set;
  job->histories = NULL;
  const pendres_status status = pendres_settle_lanes(ctx, n, l->lanes, job);
  l->count = status == PENDRES_OK ? n : 0;
  return status;
}

/*
 * Set the budgets of the next round, set by set: they do not depend on the other sets. Where all
 * has been spent the search is over, but if chaos was found in the last round, there is one more
 * round, in which lanes may be found to be on it.
 */
static void raise_budgets(const pendres_context *ctx, size_t sets,
                          const pendres_settle_labelling *job, int round, lost_lanes *l)
{
  for (size_t s = 0; s < sets; s++) {
    const pendres_attractor_set *c = &job->attractor_sets[s];
    long *budget = &job->budget[s];
    const long most = pendres_settle_last_budget(ctx, c);
    /* Half of the points of a history are there after the first round. */
    const long first =
      pendres_settle_first_budget(&c->pendulum) + (PENDRES_RECURRENCE_POINTS + 1) / 2;
    const long more = first << round;
    if (l->over[s]) continue;
    l->over[s] = *budget >= most;
    if (l->over[s] && l->found[s]) *budget += first;
    if (!l->over[s]) *budget = *budget < most - more ? *budget + more : most;
    l->found[s] = 0;
    l->watched[s] = c->covers;
  }
}

pendres_status pendres_settle_search(pendres_context *ctx, size_t sets,
                                     pendres_attractor_set *attractor_sets,
                                     const pendres_settle_starts *from,
                                     const pendres_settle_labelling *job,
                                     const pendres_strobe_lane *lanes)
{
  lost_lanes l = {0};
  for (size_t i = 0; i < from->n; i++) l.count += !pendres_settle_ended(&job->outcome[i]);
  if (l.count == 0) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "lanes");
  take_room(&room, sets, &l);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0, k = 0; i < from->n; i++) {
    if (pendres_settle_ended(&job->outcome[i])) continue;
    l.index[k] = i;
    l.set[k] = from->set[i];
    l.outcome[k] = pendres_settle_unresolved;
    l.lanes[k++] = lanes[i];
  }
  for (size_t s = 0; s < sets; s++) l.known[s] = attractor_sets[s].count;
  pendres_status status =
    pendres_settle_unstable(ctx, l.count, l.lanes, l.outcome, NULL);

  pendres_settle_labelling again = {.attractor_sets = attractor_sets, .set = l.set,
                                    .budget = job->budget, .outcome = l.outcome,
                                    .histories = l.histories};
  for (int round = 0; status == PENDRES_OK; round++) {
    size_t left = 0;
    raise_budgets(ctx, sets, &again, round, &l);
    status = pendres_settle_lanes(ctx, l.count, l.lanes, &again);
    for (size_t i = 0; i < l.count; i++) left += (size_t)searched(&l, i);
    if (status != PENDRES_OK || left == 0) break;
    status = add_recurrences(ctx, &l, attractor_sets);
    if (status == PENDRES_OK && round % 2 == 0)
      status = add_rotations(ctx, &l, attractor_sets, from, again.budget);
    if (status == PENDRES_OK && round % 2 == 0) status = add_chaos(ctx, &l, attractor_sets);
  }
  const int again_timed = from->wanted != PENDRES_SETTLE_NOTHING;
  for (int timed = 0; timed <= again_timed && status == PENDRES_OK; timed++) {
    if (timed) status = repeat(ctx, &l, from, lanes, &again);
    for (size_t i = 0; i < l.count && status == PENDRES_OK; i++)
      job->outcome[l.index[i]] = l.outcome[i];
  }
  return pendres_room_close(&room, status);
}
