/* lyapunov_runner.c -- pendulums until they come back or are averaged; see lyapunov_runner.h. */
#include "settling/exponents/lyapunov_runner.h"

#include <math.h>
#include <stdlib.h>

#include "settling/exponents/numbers.h"
#include "engine/block.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/kernels/rank.h"
#include "model/model.h"
#include "settling/trapping/escape.h"

typedef pendres_runner runner;

/* One block's averages. */
typedef struct average_job {
  pendres_block *block;
  long batch; /* periods */
  pendres_runner_beside beside;
  pendres_flow_way way;
} average_job;

/* ---- coming back --------------------------------------------------------------------------- */

static void look_from(runner *r, const pendres_strobe_lane *l)
{
  r->ref_y = l->y;
  r->ref_w = l->w;
  r->ref_turns = l->turns;
  r->ref_period = l->period;
}

/* The distance of two strobe points, whole turns aside, which are *across; squared. */
static double apart_by(const pendres_strobe_lane *l, double y, double w, double *across)
{
  const double dy = l->y - y, dw = l->w - w, turn = pendres_model_turn(l->pendulum);
  *across = rint(dy / turn);
  return (dy - turn * *across) * (dy - turn * *across) + dw * dw;
}

void pendres_runner_trust(runner *r, const pendres_strobe_lane *l, double doubt)
{
  const int sure = r->doubt <= 1.0;
  r->doubt = doubt;
  if (!sure || !(doubt <= 1.0)) return;
  r->sure_y = l->y;
  r->sure_w = l->w;
}

void pendres_runner_pass(runner *r, const pendres_strobe_lane *l)
{
  double across;
  const double square = apart_by(l, r->sure_y, r->sure_w, &across);
  if (square < r->back * r->back) r->back = sqrt(square);
}

int pendres_runner_comes_back(pendres_runner *r, const pendres_strobe_lane *l)
{
  const long lag = l->period - r->ref_period;
  double across;
  const double square = apart_by(l, r->ref_y, r->ref_w, &across), lags = (double)lag;
  /* The more periods, the more often points come back by chance. */
  if (lag > 0 && lag <= PENDRES_RUNNER_LONGEST_ORBIT && lags * lags * square < r->near * r->near) {
    const double turns = (double)(l->turns - r->ref_turns) + across;
    r->period = (int)lag;
    r->winding = fabs(turns) < 1e6 ? (int)turns : 0;
    return 1;
  }
  if (l->period >= r->next) {
    const long share = l->period / LOOK_AGAIN, longest = 2 * PENDRES_RUNNER_LONGEST_ORBIT;
    look_from(r, l);
    r->next = l->period + (share < LOOK_SOON ? LOOK_SOON : share < longest ? share : longest);
  }
  return 0;
}

int pendres_runner_leaves(pendres_runner *r, const pendres_strobe_lane *l)
{
  if (!r->open) return 0;
  if (pendres_escape_lost(l->y, l->w)) {
    r->state = PENDRES_RUNNER_LOST;
    return 1;
  }
  r->before_y = l->y;
  r->before_w = l->w;
  if (!pendres_model_escapes(l->pendulum, l->y, l->w)) return 0;
  r->state = PENDRES_RUNNER_AWAY;
  return 1;
}

pendres_runner pendres_runner_at(const pendres_strobe_lane *lane, double near)
{
  runner r = {.lane = *lane, .u = PENDRES_TANGENTS_BEGIN, .near = near, .next = LOOK_SOON,
              .open = pendres_escape_possible(lane->pendulum),
              .before_y = lane->y, .before_w = lane->w, .came = -1,
              .sure_y = lane->y, .sure_w = lane->w, .back = INFINITY};
  look_from(&r, lane);
  return r;
}

/* ---- averages ------------------------------------------------------------------------------ */

static void load(const average_job *a, size_t lane, runner *r)
{
  for (int b = 0; b < BATCHES; b++)
    r->growth[0][b] = r->growth[1][b] = r->turned[b] = 0.0;
  r->turns = r->squares = (pendres_mean){.sum = {0.0}};
  pendres_block_load(a->block, lane, r->lane.pendulum, r->lane.y, r->lane.w);
  if (a->beside == PENDRES_BESIDE_TANGENTS) pendres_tangents_put(a->block, lane, r->u);
}

/* Add to a batch what tangent vectors have grown by. */
static void turn(const average_job *a, size_t lane, long step, runner *r)
{
  double grown[2];
  if (a->beside == PENDRES_BESIDE_NOTHING) return;
  pendres_tangents_take(a->block, lane, (step + 1) % a->batch == 0, r->u, grown);
  for (int i = 0; i < 2 && step >= 0; i++) r->growth[i][step / a->batch] += grown[i];
}

/* Take over the end of a period. step is its number in the batches; negative ones are the
   warm-up. */
static void arrive(const average_job *a, size_t lane, long step,
                   const pendres_mean_weights *weights, runner *r)
{
  const pendres_rows rows = pendres_block_rows(a->block);
  pendres_strobe_lane *l = &r->lane;
  const double before = l->y;
  turn(a, lane, step, r);
  l->y = pendres_rows_get(&rows, PENDRES_ROW_Y, lane);
  l->w = pendres_rows_get(&rows, PENDRES_ROW_W, lane);
  const double turned = (l->y - before) / pendres_model_turn(l->pendulum);
  if (step >= 0) r->turned[step / a->batch] += turned;
  if (step >= 0 && r->rotates) {
    pendres_mean_add(&r->turns, weights, turned);
    pendres_mean_add(&r->squares, weights, l->w * l->w);
  }
  pendres_coordinates_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  l->period++;
  pendres_block_put_state(a->block, lane, l->y, l->w);
  pendres_runner_pass(r, l);
  if (r->state == PENDRES_RUNNER_MOVING && pendres_runner_leaves(r, l)) return;
  if (r->state == PENDRES_RUNNER_MOVING && pendres_runner_comes_back(r, l))
    r->state = PENDRES_RUNNER_CAUGHT;
}

/* Some runners of equal steps, side by side, over TURNING periods and BATCHES batches. */
static pendres_status average_block(const average_job *a, size_t n, const pendres_rank *rank,
                                    runner *runners)
{
  pendres_status status = PENDRES_OK;
  pendres_block_resize(a->block, n);
  for (size_t i = 0; i < n; i++) load(a, i, &runners[rank[i].index]);
  for (long k = -EXPONENT_TURNING; k < a->batch * BATCHES && status == PENDRES_OK; k++) {
    const pendres_mean_weights weights = pendres_mean_weights_at(k, a->batch * BATCHES);
    status = pendres_block_period_by(a->block, a->way);
    for (size_t i = 0; i < n && status == PENDRES_OK; i++)
      arrive(a, i, k, &weights, &runners[rank[i].index]);
  }
  return status;
}

/* Runners of equal steps, as many as a block holds: those of rank[0 ... *n - 1] at most. */
static pendres_status average_class(pendres_context *ctx, runner *runners, long batch,
                                    const pendres_rank *rank, size_t *n)
{
  pendres_block *block;
  const pendres_runner_beside beside = runners[rank[0].index].beside;
  const int tangents = beside == PENDRES_BESIDE_TANGENTS;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, rank[0].steps, &block);
  if (status != PENDRES_OK) return status;
  const average_job a = {.block = block, .batch = batch, .beside = beside, .way = rank[0].way};
  const size_t most = pendres_block_capacity(block);
  if (*n > most) *n = most;
  if (tangents) status = pendres_block_carry(block, PENDRES_FLOW_TANGENTS);
  if (status == PENDRES_OK) status = average_block(&a, *n, rank, runners);
  if (tangents) (void)pendres_block_carry(block, PENDRES_FLOW_NOTHING);
  return status;
}

/* Where an exponent's error is told by steps twice as long, these are a table's. */
static pendres_flow_way way_of(const runner *r)
{
  const int told = !r->adrift && r->beside == PENDRES_BESIDE_TANGENTS;
  return told ? PENDRES_FLOW_TABLE : r->lane.way;
}

/* Those with one thing beside them. */
static pendres_status average(pendres_context *ctx, size_t n, runner *runners, long batch,
                              pendres_runner_beside beside)
{
  size_t count = 0;
  pendres_status status = PENDRES_OK;
  pendres_rank *rank = malloc((n + 1) * sizeof *rank);
  if (rank == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", n);
  for (size_t i = 0; i < n; i++)
    if (runners[i].state == PENDRES_RUNNER_MOVING && runners[i].beside == beside)
      rank[count++] = (pendres_rank){.count = 1, .steps = runners[i].lane.steps,
                                     .model = pendres_model_kind(runners[i].lane.pendulum),
                                     .way = way_of(&runners[i]),
                                     .index = i};
  pendres_rank_order(count, rank);
  for (size_t first = 0, some; first < count && status == PENDRES_OK; first += some) {
    some = 1;
    while (first + some < count && pendres_rank_equal(&rank[first + some], &rank[first])) some++;
    status = average_class(ctx, runners, batch, rank + first, &some);
  }
  free(rank);
  return status;
}

pendres_status pendres_runners_average(pendres_context *ctx, size_t n, pendres_runner *runners,
                                       long batch)
{
  pendres_status status = PENDRES_OK;
  for (int k = PENDRES_BESIDE_NOTHING; k <= PENDRES_BESIDE_TANGENTS && status == PENDRES_OK; k++)
    status = average(ctx, n, runners, batch, (pendres_runner_beside)k);
  return status;
}

double pendres_runner_extrapolate(pendres_runner *r, long batch)
{
  double taken = 0.0;
  for (int b = 0; b < BATCHES; b++) {
    const double off =
      pendres_growth_correction((double[2]){r->growth[0][b], r->growth[1][b]});
    r->growth[0][b] -= off;
    taken += off / (double)(batch * BATCHES);
  }
  return fabs(taken);
}
