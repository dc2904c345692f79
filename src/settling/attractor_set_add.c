/* attractor_set_add.c -- orbits that are added to sets of attractors; see attractor_set.h. */
#include "settling/attractor_set.h"

#include <pendres/strobe.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "orbits/orbit_measure.h"
#include "model/model.h"
#include "settling/numbers.h"
#include "orbits/orbit_pair.h"
#include "orbits/orbit_prime.h"
#include "orbits/orbit_same.h"

/* ---- what is in a set of attractors ---- */

/* Whether an orbit, or another point of the same orbit, is in the set of attractors, with its own
   period or, as it closes after several of these too, with a shorter one. */
static int known(const pendres_attractor_set *c, const pendres_orbit *o)
{
  for (size_t t = 0; t < c->ellipses; t++) {
    const pendres_trapping_ellipse *at = &c->ellipse[t];
    const pendres_coordinates place = {.y = at->y, .w = at->w};
    const int times = o->period / at->period;
    double x, v;
    pendres_coordinates_out(&o->pendulum, &place, &x, &v);
    if (at->period * times == o->period && at->winding * times == o->winding &&
        pendres_orbit_is_at(o, x, v, at->error))
      return 1;
  }
  return 0;
}

/*
 * The Lyapunov exponent is the logarithm of the larger multiplier's modulus over the orbit's
 * period, and its error follows from the interval that the modulus lies in. The modulus is at least
 * exp(-contraction time / 2), since the product of the two multipliers is its square, and equal
 * to it if they are complex conjugates for certain. A modulus below DBL_MIN, which strong damping
 * leads to, has no digits.
 */
static void set_lyapunov(pendres_attractor *a, const pendres_orbit *o)
{
  const double time = two_pi * o->period / o->pendulum.drive_frequency;
  const double least = -0.5 * pendres_orbit_contraction(o);
  const double off = fmax(DBL_MIN, o->multiplier_error);
  const double size = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  a->lyapunov = fmax(least, log(size) / time);
  a->lyapunov_error = DBL_EPSILON * (4.0 * fabs(a->lyapunov) + 1.0 / time);
  if (isnan(size + o->multiplier_error)) { /* fmax would take the other one */
    a->lyapunov = isnan(size) ? NAN : a->lyapunov;
    a->lyapunov_error = NAN;
    return;
  }
  if (fabs(o->multiplier_im[0]) > off && !isnan(least)) return;
  const double high = log(size + off) / time;
  const double low = fmax(least, log(fmax(0.0, size - off)) / time);
  a->lyapunov_error += fmax(0.0, fmax(high - a->lyapunov, a->lyapunov - low));
}

/* The point with the largest x represents the orbit. */
static pendres_status append(pendres_context *ctx, pendres_attractor_set *c,
                             const pendres_orbit *points, const pendres_trapping_ellipse *ellipses)
{
  const int q = points[0].period;
  int representative = 0;
  for (int j = 1; j < q; j++)
    if (points[j].x > points[representative].x) representative = j;
  if (pendres_attractor_set_reserve(c, (size_t)q) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  pendres_attractor *a = &c->attractors[c->count];
  *a = (pendres_attractor){.orbit = points[representative],
                           .trap_radius = ellipses[representative].radius,
                           .drift = NAN,
                           .drift_error = NAN,
                           .watched_periods = NAN,
                           .escape_rate_bound = NAN};
  /* All points of an orbit have the same multipliers: those computed at them differ by errors. */
  for (int j = 0; j < q; j++)
    a->orbit.multiplier_error =
      fmax(a->orbit.multiplier_error,
           hypot(points[j].multiplier_re[0] - a->orbit.multiplier_re[0],
                 fabs(points[j].multiplier_im[0]) - fabs(a->orbit.multiplier_im[0])));
  set_lyapunov(a, &a->orbit);
  memcpy(a->trap_metric, ellipses[representative].metric, sizeof a->trap_metric);
  for (int j = 0; j < q; j++) {
    c->ellipse[c->ellipses] = ellipses[j];
    c->owner[c->ellipses++] = (int)c->count;
  }
  c->count++;
  return PENDRES_OK;
}

/* ---- the points of long orbits ---- */

/* Orbits whose Poincaré points are looked for side by side. The points of an orbit lie one after
   another. */
typedef struct long_orbits {
  size_t count, points;
  const pendres_orbit **orbit;
  size_t *first;        /* point of each */
  char *complete;       /* of each orbit: whether all of its points have been found */
  pendres_room room;    /* of the points and ellipses, anew for each round of orbits */
  pendres_orbit *point; /* the first of each is the one that was given */
  pendres_trapping_ellipse *ellipse; /* of each point */
} long_orbits;

/* Guess where the orbits are at their other strobes, by integration. */
static pendres_status guess_points(pendres_context *ctx, const long_orbits *l,
                                   pendres_orbit_guess *guess)
{
  size_t left = l->count;
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_pendulum *p = pendres_room_take(&room, left, sizeof *p);
  double *x = pendres_room_take(&room, left, sizeof *x);
  double *v = pendres_room_take(&room, left, sizeof *v);
  size_t *who = pendres_room_take(&room, left, sizeof *who);
  pendres_status status = room.status;
  for (size_t i = 0; i < l->count && status == PENDRES_OK; i++) {
    p[i] = l->orbit[i]->pendulum;
    x[i] = l->orbit[i]->x;
    v[i] = l->orbit[i]->v;
    who[i] = i;
  }
  for (int j = 1; left > 0 && status == PENDRES_OK; j++) {
    size_t still = 0;
    for (size_t k = 0; k < left; k++) {
      if (l->orbit[who[k]]->period <= j) continue;
      who[still] = who[k];
      p[still] = p[k];
      x[still] = x[k];
      v[still++] = v[k];
    }
    left = still;
    if (left > 0) status = pendres_strobe_advance(ctx, left, p, x, v, 1, NULL);
    for (size_t k = 0; k < left && status == PENDRES_OK; k++) {
      const pendres_orbit *o = l->orbit[who[k]];
      guess[l->first[who[k]] + (size_t)j] = (pendres_orbit_guess){
        .pendulum = p[k], .x = x[k], .v = v[k], .period = o->period, .winding = o->winding};
    }
  }
  return pendres_room_close(&room, status);
}

/* Refine each point at its own place. */
static pendres_status find_points(pendres_context *ctx, long_orbits *l)
{
  size_t n = 0;
  pendres_room room = pendres_room_open(ctx, "points of orbits");
  pendres_orbit_guess *guess = pendres_room_take(&room, l->points, sizeof *guess);
  pendres_status *outcome = pendres_room_take(&room, l->points, sizeof *outcome);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = guess_points(ctx, l, guess);
  /* The first point of each orbit is known already: close the gaps that it leaves among guesses. */
  for (size_t i = 0; i < l->count && status == PENDRES_OK; i++) {
    const pendres_orbit_guess *from = guess + l->first[i];
    const size_t others = (size_t)l->orbit[i]->period - 1;
    memmove(guess + n, from + 1, others * sizeof *guess);
    n += others;
  }
  if (status == PENDRES_OK)
    status = pendres_orbit_find(ctx, n, guess, PENDRES_ORBIT_PLAIN, l->point, outcome);
  for (size_t i = l->count; i-- > 0 && status == PENDRES_OK;) {
    const int q = l->orbit[i]->period;
    pendres_orbit *point = l->point + l->first[i];
    n -= (size_t)q - 1;
    memmove(point + 1, l->point + n, (size_t)(q - 1) * sizeof *point);
    point[0] = *l->orbit[i];
    l->complete[i] = 1;
    for (int j = 1; j < q; j++)
      if (outcome[n + (size_t)j - 1] == PENDRES_NOT_CONVERGED || !point[j].stable)
        l->complete[i] = 0;
  }
  return pendres_room_close(&room, status);
}

/* Drop the points of orbits that are not complete, and find the trapping ellipses of the others. */
static pendres_status find_ellipses(pendres_context *ctx, long_orbits *l,
                                    pendres_trapping_effort effort)
{
  size_t kept = 0;
  for (size_t i = 0; i < l->count; i++) {
    const size_t q = (size_t)l->orbit[i]->period;
    if (!l->complete[i]) continue;
    memmove(l->point + kept, l->point + l->first[i], q * sizeof *l->point);
    l->first[i] = kept;
    kept += q;
  }
  return pendres_trapping_find(ctx, kept, l->point, effort, l->ellipse);
}

/* Find the points and the ellipses of the orbits in the list. */
static pendres_status complete_long(pendres_context *ctx, long_orbits *l,
                                    pendres_trapping_effort effort)
{
  l->points = 0;
  for (size_t i = 0; i < l->count; i++) {
    l->first[i] = l->points;
    l->points += (size_t)l->orbit[i]->period;
  }
  (void)pendres_room_close(&l->room, PENDRES_OK);
  l->point = pendres_room_take(&l->room, l->points, sizeof *l->point);
  l->ellipse = pendres_room_take(&l->room, l->points, sizeof *l->ellipse);
  if (l->room.status != PENDRES_OK) return l->room.status;
  const pendres_status status = find_points(ctx, l);
  return status == PENDRES_OK ? find_ellipses(ctx, l, effort) : status;
}

/* ---- adding orbits ---- */

/* Stable orbits, of which those of a set lie one after another, with their outcomes. */
typedef struct candidates {
  size_t count;
  const pendres_orbit *orbit;
  const size_t *set;
  const pendres_trapping_ellipse *ellipse; /* of orbits of one period */
  char *done, *added;
} candidates;

/*
 * Add the orbits of the set that orbit number `first` belongs to, up to the first new one that
 * takes several periods to close. *next is its number, or the number after the set's last. Once a
 * long orbit has been added, its other points among the candidates are found to be known.
 */
static pendres_status add_up_to_long(pendres_context *ctx, pendres_attractor_set *c,
                                     const candidates *k, size_t first, size_t *next)
{
  pendres_status status = PENDRES_OK;
  size_t i = first;
  for (; i < k->count && k->set[i] == k->set[first] && status == PENDRES_OK; i++) {
    if (k->done[i]) continue;
    const int new = !known(c, &k->orbit[i]);
    if (new && k->orbit[i].period > 1) break;
    k->done[i] = 1;
    if (new) status = append(ctx, c, &k->orbit[i], &k->ellipse[i]);
    k->added[i] = (char)new;
  }
  *next = i;
  return status;
}

/* Add all candidates. The next long orbit of each set is completed side by side with those of the
   other sets. */
static pendres_status add_orbits(pendres_context *ctx, pendres_attractor_set *attractor_sets,
                                 const candidates *k)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  long_orbits l = {.orbit = pendres_room_take(&room, k->count, sizeof *l.orbit),
                   .first = pendres_room_take(&room, k->count, sizeof *l.first),
                   .complete = pendres_room_take(&room, k->count, sizeof *l.complete),
                   .room = pendres_room_open(ctx, "points of orbits")};
  pendres_status status = room.status;
  for (int more = 1; more && status == PENDRES_OK;) {
    l.count = 0;
    for (size_t first = 0, next; first < k->count && status == PENDRES_OK; first = next) {
      status = add_up_to_long(ctx, &attractor_sets[k->set[first]], k, first, &next);
      if (next < k->count && k->set[next] == k->set[first]) l.orbit[l.count++] = &k->orbit[next];
      while (next < k->count && k->set[next] == k->set[first]) next++;
    }
    more = l.count > 0;
    if (more && status == PENDRES_OK) status = complete_long(ctx, &l, attractor_sets[0].effort);
    for (size_t i = 0; i < l.count && status == PENDRES_OK; i++) {
      const size_t number = (size_t)(l.orbit[i] - k->orbit), at = l.first[i];
      k->done[number] = 1;
      k->added[number] = l.complete[i];
      if (l.complete[i])
        status = append(ctx, &attractor_sets[k->set[number]], l.point + at, l.ellipse + at);
    }
  }
  (void)pendres_room_close(&l.room, status);
  return pendres_room_close(&room, status);
}

/* ---- from guesses to orbits ---- */

/* Turn initial guesses into guesses, and leave out those near an earlier guess of their set. */
static size_t distinct_guesses(size_t n, const pendres_initial_guess *s,
                               const pendres_attractor_set *c,
                               pendres_orbit_guess *g, size_t *set)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum *p = &c[s[i].set].pendulum;
    int new = pendres_coordinates_refuses(p, s[i].y, s[i].w * p->drive_frequency) == NULL;
    for (size_t j = count; j-- > 0 && set[j] == s[i].set && new;) {
      const double dx =
        pendres_less_turns(g[j].x - pendres_model_origin(p) - s[i].y, pendres_model_turn(p));
      new = g[j].period != s[i].period || g[j].winding != s[i].winding ||
            hypot(dx, g[j].v - s[i].w * p->drive_frequency) > guess_same;
    }
    if (!new) continue;
    set[count] = s[i].set;
    const pendres_coordinates at = {.y = s[i].y, .w = s[i].w};
    g[count] = (pendres_orbit_guess){
      .pendulum = *p, .period = s[i].period, .winding = s[i].winding};
    pendres_coordinates_out(p, &at, &g[count].x, &g[count].v);
    count++;
  }
  return count;
}

/* Keep the stable orbits that are not in the sets of attractors, drop repetitions within a set. */
static size_t distinct_orbits(size_t n, pendres_orbit *o, size_t *set,
                              const pendres_status *outcome,
                              const pendres_attractor_set *attractor_sets)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (outcome[i] == PENDRES_NOT_CONVERGED || !o[i].stable) continue;
    int new = !known(&attractor_sets[set[i]], &o[i]);
    for (size_t j = count; j-- > 0 && set[j] == set[i] && new;)
      new = !pendres_orbit_same(&o[j], &o[i]);
    if (!new) continue;
    set[count] = set[i];
    o[count++] = o[i];
  }
  return count;
}

/* Drop orbits that close after a shorter period, with which they are found: a hundred points of an
   orbit of period 1 would take ten thousand periods. */
static pendres_status drop_multiples(pendres_context *ctx, size_t *n, pendres_orbit *o,
                                     size_t *set)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  int *period = pendres_room_take(&room, *n, sizeof *period);
  pendres_status status = room.status;
  for (size_t i = 0; i < *n && status == PENDRES_OK; i++) period[i] = o[i].period;
  if (status == PENDRES_OK) status = pendres_orbits_to_prime(ctx, *n, o);
  size_t count = 0;
  for (size_t i = 0; i < *n && status == PENDRES_OK; i++) {
    if (o[i].period < period[i]) continue;
    set[count] = set[i];
    o[count++] = o[i];
  }
  *n = count;
  return pendres_room_close(&room, status);
}

/* Where the mirror image of an orbit crosses drive phase 0: half a period later, reflected. */
static pendres_status mirror_guess(pendres_context *ctx, size_t set, const pendres_orbit *o,
                                   pendres_initial_guess *out)
{
  double *x = malloc(4 * (size_t)o->period * sizeof *x);
  if (x == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for an orbit");
  double *v = x + 2 * o->period;
  const pendres_status status = pendres_orbit_sample(ctx, o, 2, x, v, NULL);
  if (status == PENDRES_OK)
    *out = (pendres_initial_guess){.set = set,
                           .y = 2.0 * pendres_model_centre(&o->pendulum, 0.0) -
                                (x[1] - pendres_model_origin(&o->pendulum)),
                           .w = -v[1] / o->pendulum.drive_frequency,
                           .period = o->period,
                           .winding = -o->winding};
  free(x);
  return status;
}

/* Find the ellipses of orbits of one period. Orbits of more have one at each of their points, which
   are found later. */
static pendres_status find_short(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                 pendres_trapping_effort effort, pendres_trapping_ellipse *ellipses)
{
  size_t count = 0;
  pendres_orbit *alone = malloc((n + 1) * sizeof *alone);
  if (alone == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", n);
  for (size_t i = 0; i < n; i++)
    if (orbits[i].period == 1) alone[count++] = orbits[i];
  const pendres_status status = pendres_trapping_find(ctx, count, alone, effort, ellipses);
  for (size_t i = n; i-- > 0 && status == PENDRES_OK;)
    if (orbits[i].period == 1) ellipses[i] = ellipses[--count];
  free(alone);
  return status;
}

/* Add what guesses lead to; mirrors[0 .. *more) are guesses for the mirror images of new orbits. */
static pendres_status add_guesses(pendres_context *ctx, pendres_attractor_set *attractor_sets,
                                  size_t n, const pendres_initial_guess *guesses,
                                  pendres_initial_guess *mirrors, size_t *more)
{
  pendres_room room = pendres_room_open(ctx, "guesses");
  pendres_orbit_guess *g = pendres_room_take(&room, n, sizeof *g);
  pendres_orbit *orbits = pendres_room_take(&room, n, sizeof *orbits);
  pendres_status *outcome = pendres_room_take(&room, n, sizeof *outcome);
  pendres_trapping_ellipse *ellipses = pendres_room_take(&room, n, sizeof *ellipses);
  size_t *set = pendres_room_take(&room, n, sizeof *set);
  char *marks = pendres_room_take(&room, 2 * n, sizeof *marks);
  *more = 0;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  size_t count = distinct_guesses(n, guesses, attractor_sets, g, set);
  pendres_status status = pendres_orbit_find_once(ctx, count, g, orbits, outcome);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  count = distinct_orbits(count, orbits, set, outcome, attractor_sets);
  status = drop_multiples(ctx, &count, orbits, set);
  if (status == PENDRES_OK)
    status = find_short(ctx, count, orbits, attractor_sets[0].effort, ellipses);
  const candidates k = {.count = count, .orbit = orbits, .set = set, .ellipse = ellipses,
                        .done = marks, .added = marks + n};
  if (status == PENDRES_OK) status = add_orbits(ctx, attractor_sets, &k);
  for (size_t i = 0; i < count && status == PENDRES_OK; i++)
    if (k.added[i] && !orbits[i].symmetric && pendres_pendulum_symmetric(&orbits[i].pendulum))
      status = mirror_guess(ctx, set[i], &orbits[i], &mirrors[(*more)++]);
  return pendres_room_close(&room, status);
}

pendres_status pendres_attractor_set_add(pendres_context *ctx,
                                         pendres_attractor_set *attractor_sets, size_t n,
                                         const pendres_initial_guess *guesses)
{
  size_t more = 0, last = 0;
  if (n == 0) return PENDRES_OK;
  pendres_initial_guess *mirrors = malloc(2 * n * sizeof *mirrors);
  if (mirrors == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu guesses", n);
  pendres_status status = add_guesses(ctx, attractor_sets, n, guesses, mirrors, &more);
  if (status == PENDRES_OK && more > 0)
    status = add_guesses(ctx, attractor_sets, more, mirrors, mirrors + n, &last);
  free(mirrors);
  return status;
}
