/* lyapunov_verdict.c -- what each of many pendulums does; see lyapunov_verdict.h. */
#include "settling/exponents/lyapunov_verdict.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "engine/strobe_run.h"
#include "model/equation.h"
#include "model/model.h"
#include "settling/trapping/escape.h"
#include "orbits/linear.h"
#include "settling/exponents/carried.h"
#include "settling/exponents/undriven.h"
#include "settling/exponents/unstable.h"
#include "settling/exponents/lyapunov_caught.h"
#include "settling/exponents/numbers.h"

typedef pendres_lyapunov_job job;

static const pendres_settled unknown = {.label = PENDRES_LABEL_UNRESOLVED, .exponent = NAN,
                                         .exponent_error = NAN, .rotation = NAN,
                                         .rotation_error = NAN};

int pendres_lyapunov_may_rotate(const pendres_pendulum *p)
{
  return pendres_model_driven(p) && pendres_pendulum_rotates(p);
}

/* ---- coming back --------------------------------------------------------------------------- */

static double longest_transient(const pendres_strobe_lane *lane)
{
  return fmin(settle_first_most, exponent_most_steps / lane->steps);
}

/* exp(-40) of a distance is below double precision. */
static long transient_of(const job *j, const pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = lane->pendulum;
  if (j->transient > 0) return j->transient;
  /* Across the curve of a rotation distances shrink as areas do; to exp(-25), 1e-11, here. */
  const double forgets = 1.0 / pendres_equation_shrinking(p);
  if (j->care == PENDRES_CARE_CLOSE) return EXPONENT_TURNING + (long)(exponent_forgets * forgets);
  return (long)fmax(WARM_UP, fmin(longest_transient(lane), exponent_forgets_all * forgets));
}

/* Whether the start is forgotten before averages begin. Where damping is so weak that it is not,
   what looks like chaos may be a transient. */
static int forgets_start(const job *j, const pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = lane->pendulum;
  return j->transient > 0 ||
         exponent_forgets_all / pendres_equation_shrinking(p) <= longest_transient(lane);
}

static int visit(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const job *j = arg;
  pendres_runner *r = &j->runner[index];
  const int exactly = !r->adrift;
  if (exactly) pendres_runner_trust(r, lane, pendres_settle_error_ratio(lane->worst));
  if (r->followed && !(r->doubt <= 1.0)) pendres_runner_pass(r, lane);
  if (pendres_runner_leaves(r, lane)) return 1;
  if (pendres_runner_comes_back(r, lane)) {
    r->state = PENDRES_RUNNER_CAUGHT;
    return 1;
  }
  return lane->period >= r->until || (exactly && r->doubt > settle_lost) ||
         !(isfinite(lane->y) && isfinite(lane->w));
}

/* ---- escapes ---- */

/* Those that are on their way to infinity, and those of which nothing more can be known. */
static pendres_status tell_away(pendres_context *ctx, const job *j)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    pendres_runner *r = &j->runner[i];
    int away = r->state == PENDRES_RUNNER_AWAY;
    if (!away && r->state != PENDRES_RUNNER_LOST) continue;
    if (!away) status = pendres_escape_within(ctx, &r->lane, r->before_y, r->before_w, &away);
    r->state = PENDRES_RUNNER_DONE;
    j->out[i] = unknown;
    if (away) j->out[i].label = PENDRES_LABEL_ESCAPE;
    if (away) r->came = r->lane.period;
  }
  return status;
}

/* ---- linear forces ---- */

/* All motions of a linear oscillator grow, or decay to one orbit, as Floquet's theory says. */
static void take_linear(const pendres_linear *l, pendres_runner *r, pendres_settled *out)
{
  r->state = PENDRES_RUNNER_DONE;
  r->doubt = 0.0;
  if (l->fate == PENDRES_LINEAR_DECAYS) {
    r->lane = pendres_strobe_lane_at(r->lane.pendulum, l->orbit.x, l->orbit.v);
    pendres_lyapunov_take_orbit(&l->orbit, out);
    return;
  }
  *out = unknown;
  if (l->fate == PENDRES_LINEAR_GROWS) {
    out->label = PENDRES_LABEL_ESCAPE;
    r->came = 0;
  }
  out->exponent = l->exponent;
  out->exponent_error = l->error;
}

static pendres_status tell_linear(pendres_context *ctx, const job *j)
{
  pendres_linear *linear = malloc((j->n + 1) * sizeof *linear);
  if (linear == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu pendulums",
                                j->n);
  const pendres_status status = pendres_linear_find(ctx, j->n, j->pendulum, linear);
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    if (linear[i].fate == PENDRES_LINEAR_NOT) continue;
    take_linear(&linear[i], &j->runner[i], &j->out[i]);
    if (j->orbit != NULL && linear[i].fate == PENDRES_LINEAR_DECAYS)
      j->orbit[i] = linear[i].orbit;
  }
  free(linear);
  return status;
}

/* ---- unstable states ---- */

/* Those that rest in an unstable state: what would stretch distances there is no motion. */
static pendres_status tell_unstable(pendres_context *ctx, const job *j)
{
  int undriven = 0;
  for (size_t i = 0; i < j->n; i++) undriven |= j->pendulum[i].drive_amplitude == 0.0;
  if (!undriven) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "lanes");
  pendres_strobe_lane *lanes = pendres_room_take(&room, j->n, sizeof *lanes);
  pendres_settled *outcome = pendres_room_take(&room, j->n, sizeof *outcome);
  pendres_orbit *state = pendres_room_take(&room, j->n, sizeof *state);
  pendres_status status = room.status;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    lanes[i] = j->runner[i].lane;
    if (j->runner[i].state == PENDRES_RUNNER_MOVING) outcome[i] = pendres_settle_unresolved;
  }
  if (status == PENDRES_OK)
    status = pendres_settle_unstable(ctx, j->n, lanes, outcome, state);
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    if (outcome[i].label != PENDRES_LABEL_UNSTABLE) continue;
    pendres_lyapunov_take_orbit(&state[i], &j->out[i]);
    j->out[i].label = PENDRES_LABEL_UNSTABLE;
    j->runner[i].state = PENDRES_RUNNER_DONE;
    j->runner[i].doubt = 0.0;
  }
  return pendres_room_close(&room, status);
}

/* Those that have come to rotate without a drive: their exponent is 0, exactly. */
static void tell_undriven(const job *j)
{
  for (size_t i = 0; i < j->n; i++) {
    const pendres_pendulum *p = &j->pendulum[i];
    pendres_runner *r = &j->runner[i];
    pendres_rotation found;
    double x, v;
    if (r->state != PENDRES_RUNNER_MOVING || !pendres_undriven(p)) continue;
    pendres_strobe_lane_out(&r->lane, &x, &v);
    if (!pendres_undriven_rotates(p, j->x[i], x, v) ||
        pendres_rotation_find(p, &found, NULL) != PENDRES_OK)
      continue;
    j->out[i] = (pendres_settled){
      .label = PENDRES_LABEL_RUNNING, .rotation = found.mean_velocity / p->drive_frequency,
      .rotation_error = found.mean_velocity_error / p->drive_frequency};
    r->state = PENDRES_RUNNER_DONE;
  }
}

/* ---- averages ------------------------------------------------------------------------------ */

/* What the growth says, with an error of the steps of `off` in all. */
static pendres_growth_verdict tell_growth(const pendres_runner *r, double off)
{
  double all = 0.0, latter = 0.0;
  for (int b = 0; b < BATCHES; b++) {
    all += r->growth[0][b];
    if (b >= BATCHES / 2) latter += r->growth[0][b];
  }
  return pendres_growth_tell(all, latter, off);
}

/* A look at all that move: the number of the round, periods a batch, and how well means must be
   known. */
typedef struct round_of {
  int number;
  long batch;
  double enough;
} round_of;

/* Whether a runner's averages are taken roughly: means of rotations must be more exact. */
static int averages_roughly(const job *j, const pendres_runner *r, const round_of *now)
{
  return r->beside == PENDRES_BESIDE_TANGENTS && j->coarse && !(r->rotates && now->number > 0);
}

/* Judge runners by their averages; those on chaos or on rotations that are not locked are done. So
   are those that shrink, and still do not come back: their orbits have more periods than are
   looked for. First averages, whose steps are so rough that they may be beyond a fold, tell strong
   chaos alone. */
static void judge(const job *j, const round_of *now)
{
  const long batch = now->batch, periods = batch * BATCHES;
  for (size_t i = 0; i < j->n; i++) {
    pendres_runner *r = &j->runner[i];
    double error = 0.0, turned_error = 0.0;
    if (r->state != PENDRES_RUNNER_MOVING) continue;
    const double rate = r->lane.pendulum->drive_frequency / two_pi;
    const double off = pendres_runner_extrapolate(r, batch);
    const pendres_growth_verdict told = tell_growth(r, off * (double)periods);
    const double growth = pendres_batches_mean(r->growth[0], batch, &error);
    const double turned = pendres_batches_mean(r->turned, batch, &turned_error);
    const int chaotic = told == PENDRES_GROWTH_CHAOS && !pendres_batches_change(r->growth[0]) &&
                        forgets_start(j, &r->lane);
    const int exactly = !averages_roughly(j, r, now), roughly = !exactly && now->number == 0;
    const double weak = exponent_weak * fmax(1.0, 1.0 / r->lane.pendulum->drive_frequency);
    const int strong = chaotic && !(roughly && growth < weak);
    j->out[i] = (pendres_settled){
      .label = chaotic ? PENDRES_LABEL_CHAOTIC : PENDRES_LABEL_UNRESOLVED,
      .exponent = growth * rate, .exponent_error = hypot(error, off) * rate,
      .rotation = turned, .rotation_error = turned_error};
    if (r->beside == PENDRES_BESIDE_NOTHING) j->out[i].exponent = j->out[i].exponent_error = NAN;
    if (!chaotic && r->rotates && exactly)
      r->rough = pendres_means_tell(r, periods, now->enough, &j->out[i]);
    const int ordered = told == PENDRES_GROWTH_ORDER && !roughly;
    if (strong || r->rough || ordered ||
        (j->care == PENDRES_CARE_CLOSE && pendres_means_scatter(r, periods)))
      r->state = PENDRES_RUNNER_DONE;
  }
}

/* Runners whose averages would take too many steps go no further. */
static void give_up(const job *j, long batch, int first)
{
  for (size_t i = 0; i < j->n && !j->asked; i++) {
    pendres_runner *r = &j->runner[i];
    const double steps = (double)(batch * BATCHES) * r->lane.steps;
    if (r->state != PENDRES_RUNNER_MOVING || steps <= exponent_most_steps) continue;
    r->state = PENDRES_RUNNER_DONE;
    if (first) j->out[i] = unknown;
  }
}

/* ---- the call ------------------------------------------------------------------------------ */

/* The error a period that averages may have: that of the way there may be less. */
static double accuracy_of_averages(const pendres_context *ctx, const job *j)
{
  return fmax(pendres_accuracy_to_average(ctx), j->accuracy);
}

/* Put a runner at its start, and choose its steps: those on the way, and those of averages. */
static pendres_status load(pendres_context *ctx, const job *j, size_t i)
{
  const pendres_pendulum *p = &j->pendulum[i];
  pendres_runner *r = &j->runner[i];
  const pendres_strobe_lane lane = pendres_strobe_lane_at(p, j->x[i], j->v[i]);
  const double usual = accuracy_of_averages(ctx, j);
  const double wanted = j->each != NULL ? j->each[i] : j->accuracy;
  const double speed =
    fmax(pendres_steps_speed(p, j->x[i], j->v[i]), pendres_steps_turning_speed(p));
  *r = pendres_runner_at(&lane, caught_close_by);
  r->until = transient_of(j, &lane);
  r->rotates = pendres_lyapunov_may_rotate(p);
  r->beside = j->care == PENDRES_CARE_CLOSE ? PENDRES_BESIDE_NOTHING : PENDRES_BESIDE_TANGENTS;
  double accuracy = usual;
  pendres_status status = pendres_strobe_choose(ctx, speed, usual, &r->lane);
  r->steps = r->lane.steps;
  if (status == PENDRES_OK && wanted < usual) {
    status = pendres_steps_choose(ctx, p, speed, wanted, &r->lane.steps);
    if (status == PENDRES_OK) accuracy = wanted;
    if (status == PENDRES_TOLERANCE_UNREACHABLE) status = PENDRES_OK; /* it stays in doubt */
  }
  if (j->few) r->steps = pendres_steps_rung_of_few(r->steps);
  if (j->few) r->lane.steps = pendres_steps_rung_of_few(r->lane.steps);
  r->steps += r->steps % 2; /* for tangents by steps twice as long */
  r->lane.steps += r->lane.steps % 2;
  r->lane.added = pendres_settle_added(ctx, accuracy, r->lane.steps);
  if (!pendres_settle_carries(ctx)) r->doubt = r->sure_y = NAN;
  return status;
}

/* After a run by other steps: with its own again. */
static void go_on_exactly(const pendres_context *ctx, pendres_runner *r)
{
  r->adrift = 0;
  r->lane.steps = r->steps;
  r->lane.way = pendres_strobe_way(ctx, r->lane.pendulum);
}

/* Run all lanes that are moving until they come back, or their time is over, or their errors have
   become so large that it does not matter how exactly they go on. */
static pendres_status run_lanes(pendres_context *ctx, const job *j)
{
  size_t moving = 0;
  pendres_room room = pendres_room_open(ctx, "lanes");
  pendres_strobe_lane *lanes = pendres_room_take(&room, j->n, sizeof *lanes);
  size_t *which = pendres_room_take(&room, j->n, sizeof *which);
  for (size_t i = 0; i < j->n && room.status == PENDRES_OK; i++) {
    lanes[i] = j->runner[i].lane;
    const pendres_runner *r = &j->runner[i];
    if (r->adrift) lanes[i].added = 0.0; /* it carries no errors */
    if (r->state == PENDRES_RUNNER_MOVING && lanes[i].period < r->until) which[moving++] = i;
  }
  pendres_status status = room.status;
  if (status == PENDRES_OK)
    status = pendres_strobe_run_some(ctx, moving, which, lanes, visit, (void *)j);
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    lanes[i].added = j->runner[i].lane.added;
    j->runner[i].lane = lanes[i];
    go_on_exactly(ctx, &j->runner[i]);
  }
  return pendres_room_close(&room, status);
}

/* In averages errors are not carried along, but what they grow by is known. */
static void grow_errors(const job *j)
{
  for (size_t i = 0; i < j->n; i++) {
    pendres_runner *r = &j->runner[i];
    double growth = 0.0, most = 0.0;
    if (r->state == PENDRES_RUNNER_DONE) continue;
    for (int b = 0; b < BATCHES; b++) {
      growth += r->growth[0][b];
      most = fmax(most, growth);
    }
    r->doubt *= exp(most);
  }
}

/*
 * An error decides nothing if it has stayed small on the way, or, in chaos, where it grows in any
 * case, if the last state before it was large belongs to that chaos.
 */
static int is_certain(const pendres_runner *r, pendres_label label)
{
  if (label == PENDRES_LABEL_UNRESOLVED) return 0;
  return label == PENDRES_LABEL_CHAOTIC ? r->back < copies_returned : r->doubt <= 1.0;
}

/* The speed that steps are chosen for. */
static double speed_of(const pendres_strobe_lane *lane)
{
  double x, v;
  pendres_strobe_lane_out(lane, &x, &v);
  return fmax(pendres_steps_speed(lane->pendulum, x, v),
              pendres_steps_turning_speed(lane->pendulum));
}

/* Go on with steps that are right for averages, to this error a period. */
static pendres_status go_on_roughly(pendres_context *ctx, pendres_runner *r, double accuracy)
{
  r->adrift = 1;
  r->near = fmin(r->near, caught_closer * caught_close_by); /* points come back by chance */
  return pendres_strobe_choose_average(ctx, speed_of(&r->lane), accuracy, &r->lane);
}

/* Run all that move until their time is over; those whose errors are large already, and copies,
   roughly. Steps that the caller has chosen are kept. */
static pendres_status run_on(pendres_context *ctx, const job *j)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    pendres_runner *r = &j->runner[i];
    if (r->state != PENDRES_RUNNER_MOVING || ctx->options.steps_per_period > 0) continue;
    if (r->doubt > 1.0 || j->copies > 0)
      status = go_on_roughly(ctx, r, pendres_accuracy_to_follow(ctx));
    else
      r->lane.steps = pendres_steps_rung_of_few(r->lane.steps);
  }
  return status == PENDRES_OK ? run_lanes(ctx, j) : status;
}

/* Follow what may be chaos by its states alone, before it is averaged: chaos that ends comes to an
   orbit, or leaves. */
static pendres_status follow(pendres_context *ctx, const job *j)
{
  const double usual = accuracy_of_averages(ctx, j);
  for (size_t i = 0; i < j->n; i++) {
    pendres_runner *r = &j->runner[i];
    if (r->state != PENDRES_RUNNER_MOVING) continue;
    r->until = transient_of(j, &r->lane) + j->longer;
    r->followed = 1;
    r->lane.added = pendres_settle_added(ctx, usual, r->steps);
  }
  pendres_status status = run_on(ctx, j);
  if (status == PENDRES_OK) status = run_on(ctx, j); /* those whose errors have grown meanwhile */
  if (status == PENDRES_OK) status = tell_away(ctx, j);
  return status == PENDRES_OK ? pendres_lyapunov_settle_caught(ctx, j) : status;
}

/* First averages need be no more exact than what is followed: the scatter of strong chaos hides the
   errors. What they do not tell is averaged again, exactly; that is so little then that it should
   have equal steps. */
static pendres_status choose_steps(pendres_context *ctx, const job *j, const round_of *now)
{
  const double accuracy =
    now->number > 0 ? accuracy_of_averages(ctx, j) : pendres_accuracy_to_follow(ctx);
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    pendres_runner *r = &j->runner[i];
    if (r->state != PENDRES_RUNNER_MOVING) continue;
    if (averages_roughly(j, r, now)) status = go_on_roughly(ctx, r, accuracy);
    if (now->number > 0 && ctx->options.steps_per_period == 0)
      r->lane.steps = pendres_steps_rung_of_few(r->lane.steps);
  }
  return status;
}

/* Average all that move over `batch` periods a batch, and judge them. */
static pendres_status look(pendres_context *ctx, const job *j, const round_of *now)
{
  pendres_status status = choose_steps(ctx, j, now);
  if (status == PENDRES_OK) status = pendres_runners_average(ctx, j->n, j->runner, now->batch);
  for (size_t i = 0; i < j->n; i++) go_on_exactly(ctx, &j->runner[i]);
  grow_errors(j);
  if (status == PENDRES_OK) status = tell_away(ctx, j);
  if (status == PENDRES_OK) status = pendres_lyapunov_settle_caught(ctx, j);
  /* Runners whose orbit was not stable have averages of this round, and no result yet. */
  if (status == PENDRES_OK) judge(j, now);
  if (status == PENDRES_OK) status = pendres_lyapunov_settle_caught(ctx, j);
  if (status == PENDRES_OK && j->care != PENDRES_CARE_ONCE && j->care != PENDRES_CARE_LABEL)
    status = pendres_means_refine(ctx, j->n, j->runner, now->batch, j->out);
  return status;
}

/* Look at what may be rotations by their states alone; the others wait. */
static pendres_status look_at_rotations(pendres_context *ctx, const job *j, const round_of *now)
{
  for (size_t i = 0; i < j->n; i++) {
    pendres_runner *r = &j->runner[i];
    if (r->rotates) r->beside = PENDRES_BESIDE_NOTHING;
    else if (r->state == PENDRES_RUNNER_MOVING) r->state = PENDRES_RUNNER_WAITING;
  }
  const pendres_status status = look(ctx, j, now);
  for (size_t i = 0; i < j->n; i++) {
    j->runner[i].beside = PENDRES_BESIDE_TANGENTS;
    if (j->runner[i].state == PENDRES_RUNNER_WAITING) j->runner[i].state = PENDRES_RUNNER_MOVING;
  }
  return status;
}

pendres_status pendres_lyapunov_judge(pendres_context *ctx, const pendres_lyapunov_job *j)
{
  const double wanted =
    j->care == PENDRES_CARE_LABEL ? means_least : pendres_accuracy_of_means(ctx);
  round_of now = {.batch = (j->periods + BATCHES - 1) / BATCHES, .enough = wanted};
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) status = load(ctx, j, i);
  if (status == PENDRES_OK) status = tell_linear(ctx, j);
  if (status == PENDRES_OK) status = run_lanes(ctx, j);
  if (status == PENDRES_OK) status = run_on(ctx, j);
  if (status == PENDRES_OK) status = tell_away(ctx, j);
  if (status == PENDRES_OK) status = pendres_lyapunov_settle_caught(ctx, j);
  if (status == PENDRES_OK) status = tell_unstable(ctx, j);
  if (status == PENDRES_OK) tell_undriven(j);
  give_up(j, now.batch, 1);
  if (status == PENDRES_OK && j->care <= PENDRES_CARE_LABEL)
    status = look_at_rotations(ctx, j, &now);
  if (status == PENDRES_OK && j->longer > 0) status = follow(ctx, j);
  for (; now.number < j->rounds && status == PENDRES_OK; now.number++, now.batch *= 2) {
    if (now.number + 1 == j->rounds) now.enough = means_least;
    if (now.number > 0) give_up(j, now.batch, 0);
    status = look(ctx, j, &now);
  }
  for (size_t i = 0; i < j->n && status == PENDRES_OK; i++) {
    pendres_settled *out = &j->out[i];
    out->certain = is_certain(&j->runner[i], out->label);
    out->settling_periods = j->runner[i].came;
    out->attractor = out->label == PENDRES_LABEL_ESCAPE     ? PENDRES_ATTRACTOR_ESCAPED
                     : out->label == PENDRES_LABEL_UNSTABLE ? PENDRES_ATTRACTOR_UNSTABLE
                                                            : PENDRES_ATTRACTOR_UNKNOWN;
  }
  return status;
}
