/* edge.c -- resonances at jumps: folds, and basins alone; see refine.h. */
#include "analysis/resonance/numbers.h"
#include "analysis/resonance/refine.h"

#include <math.h>

#include <pendres/continuation.h>

#include "engine/accuracy.h"
#include "engine/room.h"
#include "model/model.h"
#include "analysis/resonance/search.h"

/*
 * A state of `here` that has no counterpart in `there`: it ends in between. NULL if all go on (then
 * members change their basins).
 */
static const pendres_attractor *ending_state(const pendres_response *here,
                                             const pendres_response *there)
{
  for (size_t i = 0; i < here->states; i++) {
    int goes_on = 0;
    const pendres_orbit *o = &here->state[i].orbit;
    for (size_t j = 0; j < there->states; j++) {
      const pendres_orbit *p = &there->state[j].orbit;
      const double distance = pendres_model_distance(&o->pendulum, o->x - p->x, o->v - p->v);
      /* Gaps are narrow: an orbit moves by far less than its distance from another one, except
         close to its fold, where it moves as a square root. */
      goes_on |= o->period == p->period && o->winding == p->winding && distance < orbit_another;
    }
    if (!goes_on && o->period > 0) return &here->state[i];
  }
  return NULL;
}

/*
 * Whether the jump between a and b lies beyond m. Of several jumps the one next to the largest
 * value counts, or else the larger. A change that the states' own slopes explain is no jump. Where
 * a state comes or goes without a jump, as one of a mirror pair does, the lists of states decide.
 */
static int jump_is_right(const pendres_scan_point *a, const pendres_scan_point *m,
                         const pendres_scan_point *b)
{
  const double width = pendres_scan_frequency(b) - pendres_scan_frequency(a);
  const double at_a = a->response.mean_loop_area, at_b = b->response.mean_loop_area;
  const double at_m = m->response.mean_loop_area;
  const double left = fabs(at_m - at_a), right = fabs(at_b - at_m);
  const double drift = width * fmax(fabs(m->slope), fmax(fabs(a->slope), fabs(b->slope)));
  if (left <= drift && right <= drift) {
    pendres_gap before, behind;
    pendres_gap_look(a, m, 0, &before);
    pendres_gap_look(m, b, 0, &behind);
    if ((before.kind == PENDRES_GAP_JUMP) != (behind.kind == PENDRES_GAP_JUMP))
      return behind.kind == PENDRES_GAP_JUMP;
  }
  if (at_a >= fmax(at_m, at_b) && left > drift) return 0;
  if (at_b >= fmax(at_a, at_m) && right > drift) return 1;
  return right >= left;
}

/* A point between two others: the middle or, where no member settles there, as next to the end of a
   state that all are on, one nearer to either. *found: 0 if no member settles at any. */
static pendres_status point_between(pendres_context *ctx, const pendres_ensemble *ensemble,
                                    const pendres_scan_point *a, const pendres_scan_point *b,
                                    pendres_scan_point *m, int *found)
{
  static const double shares[] = {0.5, 0.75, 0.25};
  const double lower = pendres_scan_frequency(a);
  const double width = pendres_scan_frequency(b) - lower;
  *found = 0;
  for (size_t k = 0; k < sizeof shares / sizeof *shares && !*found; k++) {
    pendres_pendulum p = a->response.pendulum;
    p.drive_frequency = lower + shares[k] * width;
    const pendres_status status = pendres_scan_evaluate(ctx, 1, &p, ensemble, NULL, m);
    if (status != PENDRES_OK) return status;
    *found = !isnan(m->response.mean_loop_area);
  }
  return PENDRES_OK;
}

/* Halve the gap between two different points until it is narrower than `width`, or no member
   settles within. */
static pendres_status bisect(pendres_context *ctx, const pendres_ensemble *ensemble, double width,
                             pendres_scan_point *a, pendres_scan_point *b)
{
  for (;;) {
    const double lower = pendres_scan_frequency(a);
    const double upper = pendres_scan_frequency(b);
    const double middle = 0.5 * (lower + upper);
    pendres_scan_point m;
    int found = 0;
    if (upper - lower <= width || middle <= lower || middle >= upper) return PENDRES_OK;
    const pendres_status status = point_between(ctx, ensemble, a, b, &m, &found);
    if (status != PENDRES_OK || !found) return status;
    if (jump_is_right(a, &m, b))
      *a = m;
    else
      *b = m;
  }
}

/* Starts of members. */
typedef struct starts {
  size_t n;
  double *x, *v;
} starts;

/*
 * Keep those starts that settle on an orbit's state at a frequency, at most `most` of them.
 */
static pendres_status keep_those_on(pendres_context *ctx, const pendres_pendulum *p,
                                    double amplitude, size_t most, starts *s)
{
  const size_t n = s->n;
  const double length = pendres_model_units_of(p).length;
  pendres_room room = pendres_room_open(ctx, "members");
  pendres_pendulum *pendulums = pendres_room_take(&room, n, sizeof *pendulums);
  pendres_settled *outcome = pendres_room_take(&room, n, sizeof *outcome);
  pendres_attractors *set = NULL;
  s->n = 0;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) pendulums[i] = *p;
  pendres_status status = pendres_settle(ctx, n, pendulums, s->x, s->v, outcome, &set);
  if (status != PENDRES_OK) goto done;
  size_t on = 0;
  for (int pass = 0; pass < 2; pass++) {
    /* First count them, then take them evenly from all. */
    const size_t all = on;
    on = 0;
    for (size_t i = 0; i < n; i++) {
      const pendres_attractor *a =
        outcome[i].attractor < 0 ? NULL
                                 : pendres_attractors_get(set, (size_t)outcome[i].attractor);
      /* The state that ends has the amplitude of the fold, nearly: it changes as a square root. */
      if (a == NULL || !(fabs(a->orbit.amplitude - amplitude) < 0.15 * length)) continue;
      if (pass == 1 && s->n < most && on * most >= s->n * all) {
        s->x[s->n] = s->x[i];
        s->v[s->n++] = s->v[i];
      }
      on++;
    }
  }
done:
  pendres_attractors_free(set);
  return pendres_room_close(&room, status);
}

/*
 * Whether the fold makes the ensemble's mean jump, that is, whether the state that is born there
 * has members from the beginning. Members that are on it a thousandth from the fold are settled
 * again at a millionth: one that is still on it was inside its basin when that was born. Usually a
 * few members decide. If all of these have left, since the basin is fragmented, the others are
 * tried.
 */
static pendres_status fold_decides(pendres_context *ctx, const pendres_ensemble *e,
                                   const pendres_fold *fold, double side, int *decides)
{
  static const double off[2] = {1e-3, 1e-6};
  const size_t most[2] = {EDGE_DECIDERS, e->members};
  const double rate = pendres_model_units_of(&fold->orbit.pendulum).rate;
  pendres_room room = pendres_room_open(ctx, "members");
  starts s = {.x = pendres_room_take(&room, e->members, sizeof *s.x),
              .v = pendres_room_take(&room, e->members, sizeof *s.v)};
  pendres_status status = room.status;
  *decides = 0;
  for (int pass = 0; pass < 2 && !*decides && status == PENDRES_OK; pass++) {
    s.n = e->members;
    for (size_t k = 1; k <= s.n; k++) pendres_ensemble_start(e, k, &s.x[k - 1], &s.v[k - 1]);
    for (int near = 0; near < 2 && s.n > 0 && status == PENDRES_OK; near++) {
      pendres_pendulum p = fold->orbit.pendulum;
      p.drive_frequency = fold->value + side * off[near] * rate;
      status = keep_those_on(ctx, &p, fold->orbit.amplitude, most[pass], &s);
    }
    *decides = s.n > 0;
  }
  return pendres_room_close(&room, status);
}

/* A state that one of two points has, and the other does not. */
typedef struct ending {
  const pendres_attractor *state;
  const pendres_scan_point *without; /* the point that does not have it */
  double side;                       /* -1, 1: where the state exists */
} ending;

/* The fold between two points at which a state ends, and the response of the others there. */
static pendres_status fold_of(pendres_context *ctx, const pendres_ensemble *ensemble,
                              const ending *e, const double range[2], pendres_scan_point *at)
{
  pendres_fold fold;
  int decides = 0;
  pendres_status status = pendres_fold_find(ctx, &e->state->orbit, PENDRES_DRIVE_FREQUENCY, &fold);
  if (status == PENDRES_NOT_CONVERGED || status == PENDRES_NOT_FOUND) return PENDRES_OK;
  if (status != PENDRES_OK && status != PENDRES_TOLERANCE_UNREACHABLE) return status;
  if (!(fold.value > range[0] && fold.value < range[1])) return PENDRES_OK;
  status = fold_decides(ctx, ensemble, &fold, e->side, &decides);
  if (status != PENDRES_OK || !decides) return status;
  status = pendres_scan_follow(ctx, e->without, fold.value, NULL, at);
  if (status != PENDRES_OK) return status;
  at->at_fold = e->side < 0.0 ? -1 : 1;
  at->fold = fold.value;
  at->fold_error = fold.value_error;
  return status;
}

pendres_status pendres_resonance_find_fold(pendres_context *ctx, const pendres_ensemble *ensemble,
                                           const pendres_scan_point *a,
                                           const pendres_scan_point *b, pendres_scan_border *out)
{
  const double range[2] = {pendres_scan_frequency(a), pendres_scan_frequency(b)};
  const double rate = pendres_model_units_of(&a->response.pendulum).rate;
  /* Where all members change together, the state of either point may be the one that ends; in a
     wide gap states that continue may have moved so far that they are not recognised. */
  const ending ends[2] = {{ending_state(&a->response, &b->response), b, -1.0},
                          {ending_state(&b->response, &a->response), a, 1.0}};
  pendres_scan_point *at = out->at;
  pendres_status status = PENDRES_OK;
  out->points = 0;
  if (ends[0].state != NULL && ends[1].state != NULL && range[1] - range[0] > just_beyond * rate)
    return status;
  for (int k = 0; k < 2 && out->points == 0 && status == PENDRES_OK; k++) {
    at->at_fold = 0;
    if (ends[k].state == NULL || ends[k].without->response.states == 0) continue;
    status = fold_of(ctx, ensemble, &ends[k], range, at);
    if (status != PENDRES_OK || !at->at_fold) continue;
    out->beside = at->fold + ends[k].side * fmin(1e-3 * rate, 0.5 * fabs(at->fold - range[k]));
    out->points = 1;
  }
  return status;
}

/* The resonance at a point, with what follows from the error of its frequency; side: from where on
   the states are those of the point. */
static pendres_status conclude(pendres_context *ctx, const pendres_scan_point *at, int side,
                               pendres_resonance *out)
{
  const double step = side * 1e-6 * pendres_model_units_of(&at->response.pendulum).rate;
  pendres_scan_point beside;
  const pendres_status status =
    pendres_scan_follow(ctx, at, pendres_scan_frequency(at) + step, NULL, &beside);
  if (status != PENDRES_OK) return status;
  pendres_resonance_take(out, at);
  pendres_resonance_add_error(out, &beside);
  out->loop_area_error = out->response.mean_loop_area_error;
  return PENDRES_OK;
}

pendres_status pendres_resonance_at_fold(pendres_context *ctx, const pendres_scan_point *at,
                                         pendres_resonance *out)
{
  *out = (pendres_resonance){.peak = PENDRES_PEAK_EDGE,
                             .frequency_error = at->fold_error,
                             .fold_frequency = at->fold,
                             .fold_frequency_error =
                               isnan(at->fold) ? NAN : at->fold_error};
  return conclude(ctx, at, -at->at_fold, out);
}

pendres_status pendres_resonance_refine_edge(pendres_context *ctx, const pendres_ensemble *ensemble,
                                             const pendres_scan_point *a,
                                             const pendres_scan_point *b, pendres_resonance *out)
{
  pendres_scan_point lower = *a, upper = *b;
  const double width = pendres_accuracy_of_jump(ctx);
  const pendres_status status = bisect(ctx, ensemble, width, &lower, &upper);
  if (status != PENDRES_OK) return status;
  const int low = lower.response.mean_loop_area > upper.response.mean_loop_area;
  *out = (pendres_resonance){.peak = PENDRES_PEAK_EDGE,
                             .frequency_error = pendres_scan_frequency(&upper) -
                                                pendres_scan_frequency(&lower),
                             .fold_frequency = NAN,
                             .fold_frequency_error = NAN};
  return conclude(ctx, low ? &lower : &upper, low ? -1 : 1, out);
}
