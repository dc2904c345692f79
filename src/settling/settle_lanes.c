/* settle_lanes.c -- running pendulums until they are inside a trapping ellipse; see
   settle_lanes.h. */
#include "settling/settle_lanes.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/charts.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "engine/threads.h"
#include "model/model.h"
#include "settling/exponents/undriven.h"
#include "settling/trapping/escape.h"
#include "settling/numbers.h"
#include "orbits/strobe_noise.h"

long pendres_settle_first_budget(const pendres_pendulum *p)
{
  const double some = settle_least + settle_times * pendres_model_settling(p);
  return (long)ceil(fmin(some, settle_first_most));
}

/*
 * Close to a fold a known attractor attracts slowly, and lanes get the time that this takes. They
 * also get the time to leave transient chaos: one of e^10 pendulums is still in it then.
 */
long pendres_settle_last_budget(const pendres_context *ctx, const pendres_attractor_set *c)
{
  if (ctx->options.period_budget > 0) return ctx->options.period_budget;
  double slowest = 0.0;
  for (size_t i = 0; i < c->count; i++) {
    const pendres_orbit *o = &c->attractors[i].orbit;
    const double rate = -log(hypot(o->multiplier_re[0], o->multiplier_im[0]));
    if (rate > 0.0) slowest = fmax(slowest, o->period / rate);
  }
  const double most = settle_last_some + settle_last_times * pendres_model_settling(&c->pendulum) +
                      settle_least * fmin(slowest, settle_slowest) +
                      settle_times * fmin(c->transient, settle_slowest);
  return (long)ceil(fmin(most, settle_last_times / settle_times * settle_first_most));
}

double pendres_settle_driven(const pendres_attractor_set *c)
{
  double fastest = 0.0;
  if (!pendres_escape_possible(&c->pendulum) || c->pendulum.parametric_amplitude == 0.0) return 0.0;
  for (size_t i = 0; i < c->count; i++) {
    const pendres_orbit *o = &c->attractors[i].orbit;
    fastest = fmax(fastest, pendres_steps_speed(&c->pendulum, o->x, o->v)); /* not NaN: chaos */
  }
  return settle_overshoot * fastest;
}

pendres_status pendres_settle_load(pendres_context *ctx, const pendres_attractor_set *c, double x,
                                   double v, double accuracy, pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = &c->pendulum;
  const double speed = fmax(pendres_settle_driven(c), pendres_steps_speed(p, x, v));
  *lane = pendres_strobe_lane_at(p, x, v);
  const pendres_status status = pendres_strobe_choose(ctx, speed, accuracy, lane);
  if (status == PENDRES_OK) lane->added = pendres_settle_added(ctx, accuracy, lane->steps);
  return status;
}

pendres_strobe_lane pendres_settle_load_like(const pendres_strobe_lane *neighbour, double x,
                                             double v)
{
  pendres_strobe_lane lane = pendres_strobe_lane_at(neighbour->pendulum, x, v);
  lane.steps = neighbour->steps;
  lane.added = neighbour->added;
  lane.way = neighbour->way;
  return lane;
}

static double angle_of(const pendres_strobe_lane *lane)
{
  return lane->y + two_pi * (double)lane->turns;
}

static void record(pendres_settle_history *h, const pendres_strobe_lane *lane)
{
  const long k = h->filled++ % PENDRES_SETTLE_HISTORY;
  h->y[k] = angle_of(lane);
  h->w[k] = lane->w;
}

/* A state, the largest variance of the error on the way to it, and its angle with whole turns. */
typedef struct pendres_settle_place {
  double y, w, worst, angle;
} pendres_settle_place;

/* A streak is one number: the number of successive strobes at which a lane has been in the cells of
   one chaotic attractor, plus this constant times the number of the attractor's cover. */
enum { STREAK_SCALE = 1 << 16 };

/* The streak after one more strobe. */
static int longer_streak(const pendres_attractor_set *c, const pendres_strobe_lane *lane,
                         int streak)
{
  const size_t last = (size_t)(streak / STREAK_SCALE);
  if (streak % STREAK_SCALE > 0 && pendres_cover_holds(c->cover[last], lane->y, lane->w))
    return streak % STREAK_SCALE < STREAK_SCALE - 1 ? streak + 1 : streak;
  for (size_t k = 0; k < c->covers; k++)
    if (pendres_cover_holds(c->cover[k], lane->y, lane->w)) return (int)k * STREAK_SCALE + 1;
  return 0;
}

static double error_ratio_in_ellipse(const pendres_trapping_ellipse *t,
                                     const pendres_strobe_lane *lane)
{
  const pendres_flow_error *e = &lane->off;
  const double variance =
    t->metric[0] * e->yy + 2.0 * t->metric[1] * e->yw + t->metric[2] * e->ww;
  const double here = surely * sqrt(variance) / t->room;
  const double before = pendres_settle_error_ratio(lane->worst);
  if (lane->period > 0 && lane->added == 0.0) return NAN; /* errors were not propagated */
  return isnan(before) || before > here ? before : here;
}

static void judge(const pendres_settle_labelling *l, size_t i, double error_ratio)
{
  l->outcome[i].certain = error_ratio <= 1.0; /* not if it is NaN */
  if (l->error_ratio != NULL) l->error_ratio[i] = error_ratio;
}

/*
 * A lane in the cells of a chaotic attractor for long enough is chaotic, but not before
 * transients are over.
 */
static int chaotic(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                   const pendres_strobe_lane *lane)
{
  const int streak = l->streak[i] = longer_streak(c, lane, l->streak[i]);
  if (streak % STREAK_SCALE <= 1) l->entry[i] = lane->worst;
  if (streak % STREAK_SCALE < SETTLE_CHAOTIC_STREAK) return 0;
  if (lane->period < pendres_settle_first_budget(&c->pendulum)) return 0;
  l->outcome[i] =
    (pendres_settled){.label = PENDRES_LABEL_CHAOTIC,
                      .attractor = c->cover[streak / STREAK_SCALE]->attractor,
                      .settling_periods = lane->period - streak % STREAK_SCALE + 1};
  judge(l, i, lane->added > 0.0 ? pendres_settle_error_ratio(l->entry[i]) : NAN);
  return 1;
}

static int trapped(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                   const pendres_strobe_lane *lane)
{
  pendres_settled *o = &l->outcome[i];
  const pendres_trapping_ellipse *in = pendres_attractor_set_ellipse(c, lane->y, lane->w);
  if (in == NULL) return 0;
  o->attractor = pendres_attractor_set_locate(c, in, lane, &o->well);
  o->label = c->attractors[o->attractor].label;
  o->settling_periods = lane->period;
  judge(l, i, error_ratio_in_ellipse(in, lane));
  return 1;
}

/* Whether a lane has come to a rotation without a drive since it was looked at last. */
static int turns_over(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                      const pendres_strobe_lane *lane)
{
  const double now = angle_of(lane), last = l->before != NULL ? l->before[i].angle : now;
  const double origin = pendres_model_origin(&c->pendulum); /* of angles */
  return c->turns && pendres_undriven_rotates(&c->pendulum, last + origin, now + origin,
                                              c->pendulum.drive_frequency * lane->w);
}

/* Whether a lane is on a rotation without a lock: one without a drive, or between the edges of
   another. */
static int rotates(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                   const pendres_strobe_lane *lane)
{
  if (turns_over(l, i, c, lane)) {
    l->outcome[i] = (pendres_settled){.label = c->attractors[c->turning].label,
                                      .attractor = c->turning,
                                      .settling_periods = lane->period};
    judge(l, i, lane->period > 0 && lane->added == 0.0 ? NAN
                                                       : pendres_settle_error_ratio(lane->worst));
    return 1;
  }
  const pendres_annulus *in = pendres_attractor_set_annulus(c, lane->y, lane->w);
  if (in == NULL) return 0;
  double slope;
  const double room = pendres_annulus_room(in, lane->y, lane->w, &slope);
  const double off = fabs(slope) * sqrt(lane->off.yy) + sqrt(lane->off.ww);
  const double before = pendres_settle_error_ratio(lane->worst);
  l->outcome[i] = (pendres_settled){.label = c->attractors[in->attractor].label,
                                    .attractor = in->attractor,
                                    .settling_periods = lane->period};
  judge(l, i, lane->period > 0 && lane->added == 0.0 ? NAN : fmax(before, surely * off / room));
  return 1;
}

/* ---- escapes ---- */

static pendres_settle_place place_of(const pendres_strobe_lane *lane)
{
  return (pendres_settle_place){lane->y, lane->w, lane->worst, angle_of(lane)};
}

static void note_escape(const pendres_settle_labelling *l, size_t i,
                        const pendres_strobe_lane *lane, double worst)
{
  l->outcome[i] = (pendres_settled){.label = PENDRES_LABEL_ESCAPE,
                                    .attractor = PENDRES_ATTRACTOR_ESCAPED,
                                    .settling_periods = lane->period};
  judge(l, i, lane->added > 0.0 ? pendres_settle_error_ratio(worst) : NAN);
}

/* Whether a lane has escaped, or is lost. The last period of a lost one is examined once more. */
static int escapes(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                   const pendres_strobe_lane *lane)
{
  if (isnan(lane->y) && pendres_model_bounded(lane->pendulum)) {
    note_escape(l, i, lane, l->before[i].worst); /* it got to where the force is not defined */
    return 1;
  }
  if (pendres_escape_lost(lane->y, lane->w)) return 1;
  l->before[i] = place_of(lane);
  if (!pendres_escape_certain(lane->pendulum, &c->beside, lane->y, lane->w)) return 0;
  note_escape(l, i, lane, lane->worst);
  return 1;
}

/* Note an escape if a lane was on its way to infinity for certain at a step of its last period. */
static pendres_status look_back(pendres_context *ctx, const pendres_settle_labelling *l,
                                size_t i, const pendres_strobe_lane *lane)
{
  const pendres_settle_place *from = &l->before[i];
  int away = 0;
  const pendres_status status = pendres_escape_within(ctx, lane, from->y, from->w, &away);
  if (away) note_escape(l, i, lane, from->worst);
  return status;
}

/* ---- lanes ---- */

static size_t set_of(const pendres_settle_labelling *l, size_t i)
{
  return l->set != NULL ? l->set[i] : 0;
}

static int spent(const pendres_settle_labelling *l, size_t set, const pendres_strobe_lane *lane)
{
  return lane->period >= l->budget[set] ||
         (lane->period >= WARM_UP &&
          (double)(lane->period - lane->charted) * lane->steps >= l->most_steps);
}

/* Whether a lane is lost. What grows on a chaotic attractor after it has been reached does not
   count: all of it has one label. */
static int lost(const pendres_settle_labelling *l, size_t i, const pendres_attractor_set *c,
                const pendres_strobe_lane *lane)
{
  const int on_chaos = c->covers > 0 && l->streak[i] > 0;
  const double worst = on_chaos ? l->entry[i] : lane->worst;
  if (pendres_settle_error_ratio(worst) <= settle_lost) return 0;
  l->error_ratio[i] = INFINITY;
  return 1;
}

/* What settle_look() does where a lane is in no ellipse. */
static int look_outside(const pendres_settle_labelling *l, size_t i,
                        const pendres_strobe_lane *lane)
{
  const size_t set = set_of(l, i);
  const pendres_attractor_set *c = &l->attractor_sets[set];
  if (l->before != NULL && escapes(l, i, c, lane)) return 1;
  if (l->histories != NULL) record(&l->histories[i], lane);
  if (c->covers > 0 && chaotic(l, i, c, lane)) return 1;
  if (l->drop_lost && lost(l, i, c, lane)) return 1;
  return spent(l, set, lane);
}

static int settle_look(void *arg, size_t i, const pendres_strobe_lane *lane)
{
  const pendres_settle_labelling *l = arg;
  const pendres_attractor_set *c = &l->attractor_sets[set_of(l, i)];
  return trapped(l, i, c, lane) || rotates(l, i, c, lane) || look_outside(l, i, lane);
}

/* ---- by charts ---- */

/* Periods that a lane may go at once, by the longest chart: within its budget, and one by one where
   its latest strobe points are recorded. */
static long leap(const pendres_settle_labelling *l, size_t i, const pendres_strobe_lane *lane)
{
  const long left = l->budget[set_of(l, i)] - lane->period;
  if (l->histories == NULL) return left;
  return left > PENDRES_SETTLE_HISTORY ? left - PENDRES_SETTLE_HISTORY : 1;
}

/* Advance a lane by charts until it is done, or comes to where there are none. Where a long chart
   leads into an ellipse, shorter ones tell when it came there. */
static pendres_status glide(pendres_context *ctx, pendres_charts *charts,
                            const pendres_settle_labelling *l, size_t i, pendres_strobe_lane *lane,
                            int *done)
{
  const pendres_attractor_set *c = &l->attractor_sets[set_of(l, i)];
  int most = pendres_charts_levels(charts) - 1, highest = most, level = 0;
  *done = 0;
  for (long taken = 1; !*done; taken++) {
    const pendres_strobe_lane from = *lane;
    const long may = leap(l, i, lane);
    while (highest > 0 && (highest > most || pendres_charts_periods(highest) > may)) highest--;
    pendres_status status = pendres_charts_advance(ctx, charts, highest, lane, &level);
    if (status == PENDRES_OK && taken % SETTLE_GLIDES == 0) status = pendres_context_poll(ctx);
    if (status != PENDRES_OK || level < 0) return status;
    lane->charted += pendres_charts_periods(level) - 1;
    if (level == 0) {
      *done = settle_look((void *)l, i, lane);
    } else if (pendres_attractor_set_ellipse(c, lane->y, lane->w) != NULL ||
               turns_over(l, i, c, lane)) {
      *lane = from;
      most = level - 1;
    } else {
      /* Histories are of successive strobes: they begin anew. */
      if (l->histories != NULL) l->histories[i].filled = 0;
      *done = look_outside(l, i, lane);
    }
    highest = level + 1;
  }
  return pendres_context_poll(ctx);
}

/* Whether lanes of a parameter set may be advanced by charts: not on chaos, which is watched strobe
   by strobe. */
static int may_glide(const pendres_context *ctx, const pendres_attractor_set *c)
{
  return c->covers == 0 && pendres_charts_worth(ctx, &c->pendulum);
}

/* Lanes that are integrated, each thread's one of so many, so that all take about as long. */
typedef struct running {
  pendres_strobe_lane *lanes;
  const size_t *which;
  pendres_strobe_visit *visit;
  void *arg;
} running;

static pendres_status run_some(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  const running *r = arg;
  return pendres_strobe_run_some(ctx, count, r->which + first, r->lanes, r->visit, r->arg);
}

/* Integrate n lanes with the numbers `which` until visit ends them. */
static pendres_status integrate(pendres_context *ctx, size_t n, const size_t *which,
                                pendres_strobe_lane *lanes, pendres_strobe_visit *visit, void *arg)
{
  const size_t share = pendres_threads_share(ctx, n);
  if (n <= share) return pendres_strobe_run_some(ctx, n, which, lanes, visit, arg);
  const size_t parts = (n + share - 1) / share;
  pendres_room room = pendres_room_open(ctx, "pendulums");
  size_t *dealt = pendres_room_take(&room, n, sizeof *dealt);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t part = 0, at = 0; part < parts; part++)
    for (size_t k = part; k < n; k += parts) dealt[at++] = which[k];
  running r = {.lanes = lanes, .which = dealt, .visit = visit, .arg = arg};
  return pendres_room_close(&room,
                            pendres_threads_run(ctx, n, (n + parts - 1) / parts, run_some, &r));
}

/* Runs of lanes that take turns between charts and the integrator. */
typedef struct turns {
  pendres_settle_labelling *job;
  long *until; /* of each lane: the period to which it is integrated */
  unsigned char *ended;
} turns;

static int look_until(void *arg, size_t i, const pendres_strobe_lane *lane)
{
  const turns *t = arg;
  t->ended[i] = (unsigned char)settle_look(t->job, i, lane);
  return t->ended[i] || lane->period >= t->until[i];
}

/* Advance those of the lanes that can be by charts; those that are left are integrated, for a
   while or, where there are no charts, to the end. */
static pendres_status glide_all(pendres_context *ctx, size_t n, const size_t *which,
                                pendres_strobe_lane *lanes, turns *t)
{
  double bottom[PENDRES_ATTRACTOR_SET_BOTTOMS];
  const pendres_attractor_set *before = NULL;
  pendres_charts *charts = NULL;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    const size_t i = which[k];
    const pendres_attractor_set *c = &t->job->attractor_sets[set_of(t->job, i)];
    int done = 0;
    if (c != before) {
      charts = NULL;
      if (may_glide(ctx, c))
        status = pendres_charts_of(ctx, &c->pendulum,
                                   pendres_attractor_set_bottoms(&c->pendulum, bottom), bottom,
                                   &charts);
      before = c;
    }
    if (charts != NULL) status = glide(ctx, charts, t->job, i, &lanes[i], &done);
    t->ended[i] = (unsigned char)done;
    t->until[i] = charts != NULL ? lanes[i].period + SETTLE_ASIDE : LONG_MAX;
  }
  return status;
}

static pendres_status run_lanes(pendres_context *ctx, size_t n, size_t *which,
                                pendres_strobe_lane *lanes, pendres_settle_labelling *l)
{
  size_t most = 0, left = n;
  int may = 0;
  for (size_t k = 0; k < n; k++) {
    may |= may_glide(ctx, &l->attractor_sets[set_of(l, which[k])]);
    most = which[k] >= most ? which[k] + 1 : most;
  }
  if (!may) return integrate(ctx, n, which, lanes, settle_look, l);
  pendres_room room = pendres_room_open(ctx, "pendulums");
  size_t *some = pendres_room_take(&room, n, sizeof *some);
  turns t = {.job = l, .until = pendres_room_take(&room, most, sizeof *t.until)};
  t.ended = pendres_room_take(&room, most, sizeof *t.ended);
  pendres_status status = room.status;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) some[k] = which[k];
  while (left > 0 && status == PENDRES_OK) {
    status = glide_all(ctx, left, some, lanes, &t);
    for (int twice = 0; twice < 2; twice++) {
      size_t count = 0;
      for (size_t k = 0; k < left; k++)
        if (!t.ended[some[k]]) some[count++] = some[k];
      left = count;
      if (twice == 0 && left > 0 && status == PENDRES_OK)
        status = integrate(ctx, left, some, lanes, look_until, &t);
    }
  }
  return pendres_room_close(&room, status);
}

/* List the lanes that are to run: those that are unresolved, in no ellipse, and within their
   budget.
   *covers, *open: whether any of them may be on chaos, or escape or come to rotate. */
static size_t list_unsettled(size_t n, const pendres_strobe_lane *lanes,
                             const pendres_settle_labelling *l, size_t *which, int *covers,
                             int *open)
{
  size_t left = 0;
  *covers = *open = 0;
  for (size_t k = 0; k < n; k++) {
    const size_t i = l->order != NULL ? l->order[k] : k, set = set_of(l, i);
    const pendres_attractor_set *c = &l->attractor_sets[set];
    if (pendres_settle_ended(&l->outcome[i])) continue;
    if (c->grows) {
      note_escape(l, i, &lanes[i], 0.0);
      judge(l, i, 0.0);
      continue;
    }
    if (trapped(l, i, c, &lanes[i]) || rotates(l, i, c, &lanes[i]) || spent(l, set, &lanes[i]))
      continue;
    *covers |= c->covers > 0;
    *open |= pendres_escape_possible(&c->pendulum) || c->turns;
    which[left++] = i;
  }
  return left;
}

pendres_status pendres_settle_lanes(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                    pendres_settle_labelling *l)
{
  int covers = 0, open = 0;
  pendres_room room = pendres_room_open(ctx, "pendulums");
  l->most_steps = ctx->options.period_budget > 0 ? INFINITY : settle_most_steps;
  size_t *which = pendres_room_take(&room, n, sizeof *which);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  const size_t left = list_unsettled(n, lanes, l, which, &covers, &open);
  if (covers) {
    l->streak = pendres_room_take(&room, n, sizeof *l->streak);
    l->entry = pendres_room_take(&room, n, sizeof *l->entry);
  }
  if (open) l->before = pendres_room_take(&room, n, sizeof *l->before);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t k = 0; k < left && open; k++) l->before[which[k]] = place_of(&lanes[which[k]]);
  pendres_status status = run_lanes(ctx, left, which, lanes, l);
  for (size_t k = 0; k < left && status == PENDRES_OK; k++) {
    const size_t i = which[k];
    pendres_settled *o = &l->outcome[i];
    if (pendres_settle_ended(o)) continue;
    *o = pendres_settle_unresolved;
    if (open && pendres_escape_lost(lanes[i].y, lanes[i].w))
      status = look_back(ctx, l, i, &lanes[i]);
  }
  l->streak = NULL;
  l->entry = NULL;
  l->before = NULL;
  return pendres_room_close(&room, status);
}
