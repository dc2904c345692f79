/*
 * hysteresis_crisis.c -- interior crises; see hysteresis_crisis.h.
 *
 * At such a crisis chaos meets an unstable orbit. Beyond it the motion leaves, in bursts, the
 * region where the chaos was before, the more seldom the closer to the crisis. Source: Grebogi,
 * Ott, Romeiras and Yorke, Physical Review A 36 (1987) 5365.
 */
#include "analysis/sweeps/hysteresis_crisis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/sweeps/hysteresis_chaos.h"
#include "analysis/sweeps/numbers.h"
#include "continuation/parameter.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/steps.h"
#include "engine/strobe_run.h"
#include "model/model.h"

enum {
  MOST_CELLS = 128, /* a side with those that only the larger chaos visits */
  MOST_LIVES = 64 * CRISIS_PERIODS /* periods that pendulums may take to leave a region */
};

/* Cells of the Poincare plane that chaos visits, or that touch such a cell. There are cells
   wherever the larger chaos goes: what grows gradually would seem to leave at a nearer edge. */
typedef struct region {
  double y, w, across, up; /* of a corner; the size of a cell */
  int rows, columns;       /* along the angle, and along its velocity */
  int round;               /* the angle comes round after all cells */
  unsigned char cell[MOST_CELLS][MOST_CELLS];
} region;

/* Strobe points of pendulums on one chaos, side by side. */
typedef struct sample {
  double y[LIVES * CRISIS_PERIODS], w[LIVES * CRISIS_PERIODS];
} sample;

/* States of these pendulums. */
typedef struct states {
  double x[LIVES], v[LIVES];
} states;

/* Chaos as it has been looked at: from which state of which pendulum on, and what was seen. */
typedef struct pendres_crisis_seen {
  pendres_pendulum pendulum;
  double x, v;
  states in;
  sample points;
} pendres_crisis_seen;

/* A search for a crisis between a value at which chaos is smaller and one at which it is larger. */
typedef struct search {
  pendres_context *ctx;
  pendres_parameter parameter;
  const pendres_arrival *smaller;
  double small, large; /* the last values known to be on either side */
  states in;     /* the smaller chaos, at the last value known to be on its side, ... */
  region where;  /* ... and where it has been */
  sample points; /* the latest */
} search;

/* ---- regions ---- */

static int cell_of(const region *r, double y, double w, int *row, int *column)
{
  const double a = floor((y - r->y) / r->across), b = floor((w - r->w) / r->up);
  if (!(a >= 0.0 && a < r->rows && b >= 0.0 && b < r->columns)) return 0;
  *row = (int)a;
  *column = (int)b;
  return 1;
}

static int holds(const region *r, double y, double w)
{
  int row, column;
  return cell_of(r, y, w, &row, &column) && r->cell[row][column];
}

static void add(region *r, double y, double w)
{
  int row, column;
  if (!cell_of(r, y, w, &row, &column)) return;
  for (int i = row - 1; i <= row + 1; i++)
    for (int k = column - 1; k <= column + 1; k++) {
      const int at = r->round ? (i + r->rows) % r->rows : i;
      if (at >= 0 && at < r->rows && k >= 0 && k < r->columns) r->cell[at][k] = 1;
    }
}

static void add_all(region *r, const sample *s)
{
  for (int i = 0; i < LIVES * CRISIS_PERIODS; i++) add(r, s->y[i], s->w[i]);
}

/* The corners of all that samples have visited. */
static void corners_of(const sample *s, double low[2], double high[2])
{
  low[0] = high[0] = s->y[0];
  low[1] = high[1] = s->w[0];
  for (int i = 1; i < LIVES * CRISIS_PERIODS; i++) {
    low[0] = fmin(low[0], s->y[i]);
    high[0] = fmax(high[0], s->y[i]);
    low[1] = fmin(low[1], s->w[i]);
    high[1] = fmax(high[1], s->w[i]);
  }
}

/* How many more cells are needed from one place to another; beyond most of them there is none. */
static int cells_to(double way, double size, int most)
{
  const double cells = ceil(fmax(0.0, way) / size);
  return cells < most ? (int)cells : most;
}

/* The region of a sample. Cells are as large as all of its points and half as much beside them ask
   for, and reach as far as those of another; where they go round, all the turn is divided. */
static void make_region(const pendres_pendulum *p, const sample *s, const sample *other, region *r)
{
  const double turn = pendres_model_turn(p);
  const int most = (MOST_CELLS - CRISIS_CELLS) / 2;
  double low[2], high[2], least[2], largest[2];
  memset(r, 0, sizeof *r);
  corners_of(s, low, high);
  corners_of(other, least, largest);
  r->across = 1.5 * (high[0] - low[0]) / CRISIS_CELLS;
  r->up = 1.5 * (high[1] - low[1]) / CRISIS_CELLS;
  r->y = 0.5 * (low[0] + high[0]) - 0.5 * CRISIS_CELLS * r->across;
  r->w = 0.5 * (low[1] + high[1]) - 0.5 * CRISIS_CELLS * r->up;
  r->rows = r->columns = CRISIS_CELLS;
  r->columns += cells_to(largest[1] - r->w - CRISIS_CELLS * r->up, r->up, most);
  const int left = cells_to(r->y - least[0], r->across, most);
  const int below = cells_to(r->w - least[1], r->up, most);
  r->rows += left + cells_to(largest[0] - r->y - CRISIS_CELLS * r->across, r->across, most);
  r->columns += below;
  r->y -= left * r->across;
  r->w -= below * r->up;
  r->round = r->rows * r->across >= turn;
  if (r->round) {
    r->rows = r->rows > CRISIS_CELLS ? (int)ceil(turn / r->across) : CRISIS_CELLS;
    r->across = turn / r->rows;
    r->y = -0.5 * turn;
  }
  add_all(r, s);
}

static double share_outside(const region *r, const sample *s)
{
  int outside = 0;
  for (int i = 0; i < LIVES * CRISIS_PERIODS; i++) outside += !holds(r, s->y[i], s->w[i]);
  return (double)outside / (LIVES * CRISIS_PERIODS);
}

/* ---- pendulums ---- */

/* What is done with each strobe point of a lane. */
typedef struct look {
  sample *points;      /* kept; NULL: none */
  const region *where; /* whether it is left; NULL: not asked */
  long left[LIVES];    /* the period in which it was; 0: it was not */
  double room;         /* periods of all lives together that are left to be looked at */
} look;

static int visit(void *arg, size_t index, const pendres_strobe_lane *l)
{
  look *k = arg;
  const long at = l->period - CRISIS_WARM_UP - 1;
  if (k->where != NULL) {
    if (!holds(k->where, l->y, l->w)) k->left[index] = l->period;
    return k->left[index] > 0 || l->period >= MOST_LIVES || --k->room < 0.0;
  }
  if (at >= 0) {
    k->points->y[index * CRISIS_PERIODS + (size_t)at] = l->y;
    k->points->w[index * CRISIS_PERIODS + (size_t)at] = l->w;
  }
  return at + 1 == CRISIS_PERIODS || !(isfinite(l->y) && isfinite(l->w));
}

/* Run pendulums from these states, which become those at the end. */
static pendres_status run(pendres_context *ctx, const pendres_pendulum *p, states *s, look *k)
{
  const double accuracy = pendres_accuracy_to_average(ctx);
  pendres_strobe_lane lane[LIVES];
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < LIVES && status == PENDRES_OK; i++) {
    const double speed =
      fmax(pendres_steps_speed(p, s->x[i], s->v[i]), pendres_steps_turning_speed(p));
    lane[i] = pendres_strobe_lane_at(p, s->x[i], s->v[i]);
    lane[i].turns = 0; /* chaos that drifts would go far */
    status = pendres_steps_choose(ctx, p, speed, accuracy, &lane[i].steps);
  }
  if (status == PENDRES_OK)
    status = pendres_strobe_run_within(ctx, accuracy, LIVES, lane, visit, k);
  for (int i = 0; i < LIVES && status == PENDRES_OK; i++)
    pendres_strobe_lane_out(&lane[i], &s->x[i], &s->v[i]);
  return status;
}

static pendres_status take_sample(pendres_context *ctx, const pendres_pendulum *p, states *s,
                                  sample *out)
{
  look k = {.points = out};
  for (int i = 0; i < LIVES * CRISIS_PERIODS; i++) out->y[i] = out->w[i] = NAN; /* if it is lost */
  return run(ctx, p, s, &k);
}

/* The mean number of periods in which pendulums leave the region of the smaller chaos; infinite
   where some do not, or where it is more than is asked about: the longest lives take most work. */
static pendres_status mean_life(const search *w, double value, double most, double *life)
{
  const pendres_pendulum p = pendres_parameter_with(&w->smaller->pendulum, w->parameter, value);
  look k = {.where = &w->where, .room = most * LIVES};
  states s = w->in;
  const pendres_status status = run(w->ctx, &p, &s, &k);
  *life = 0.0;
  for (int i = 0; i < LIVES && status == PENDRES_OK; i++)
    *life += k.left[i] > 0 ? (double)k.left[i] / LIVES : INFINITY;
  return status;
}

/* ---- the search ---- */

/* Whether some pendulums have come to one and the same motion: to an orbit, in a window. In chaos
   they stay apart. */
static int in_window(const search *w)
{
  const double y = crisis_same * w->where.across, v = crisis_same * w->where.up;
  const sample *s = &w->points;
  for (int i = CRISIS_PERIODS - 1; i < LIVES * CRISIS_PERIODS; i += CRISIS_PERIODS)
    for (int k = CRISIS_PERIODS - 1; k < i; k += CRISIS_PERIODS)
      if (fabs(s->y[i] - s->y[k]) < y && fabs(s->w[i] - s->w[k]) < v) return 1;
  return 0;
}

/* Whether chaos leaves the region of the smaller one at a value. Where it does not, that is
   extended by what it has visited: what grows gradually is followed. From a window nothing is taken
   over: as chaos, pendulums that have become alike would be one, whose life tells nothing. */
static pendres_status leaves(search *w, double value, int *left)
{
  const pendres_pendulum p = pendres_parameter_with(&w->smaller->pendulum, w->parameter, value);
  states s = w->in;
  const pendres_status status = take_sample(w->ctx, &p, &s, &w->points);
  *left = status != PENDRES_OK || share_outside(&w->where, &w->points) > 0.0;
  if (*left) return status;
  w->small = value;
  if (in_window(w)) return status;
  w->in = s;
  add_all(&w->where, &w->points);
  return status;
}

/* Halve the interval. What left a region that was still smaller may not leave it any more at the
   end, and the search goes on from there. */
static pendres_status halve(search *w)
{
  const double other = w->large;
  pendres_status status = PENDRES_OK;
  int left = 0;
  for (int round = 0; round < TRIES && !left && w->small != other && status == PENDRES_OK;
       round++) {
    w->large = other;
    for (int k = 0; k < CRISIS_HALVINGS && status == PENDRES_OK; k++) {
      const double middle = 0.5 * (w->small + w->large);
      status = leaves(w, middle, &left);
      if (left) w->large = middle;
    }
    if (status == PENDRES_OK) status = leaves(w, w->large, &left);
  }
  if (!left) w->small = w->large = other;
  return status;
}

/* How far beyond the crisis chaos may be that was watched without leaving, in units of the distance
   from there at which it has such a life. */
static double furthest(double power, double life)
{
  const double longer = (double)LIVES * CRISIS_PERIODS / (lives_watched * life);
  return 1.0 / (pow(longer, 1.0 / fmax(crisis_safe_power, power)) - 1.0);
}

/*
 * Whether the lives in the region of the smaller chaos become longer towards the crisis. Next to it
 * they are longer than chaos has been watched for, so that it may lie further on the side of the
 * smaller chaos: that is added to the error.
 */
static pendres_status by_lives(const search *w, double other, pendres_jump *jump, int *found)
{
  const double width = w->large - w->small, room = (other - w->small) / width;
  const double soon = crisis_short_life * LIVES * CRISIS_PERIODS;
  double near = INFINITY, far = INFINITY, at = 1.0;
  pendres_status status = PENDRES_OK;
  *found = 0;
  if (width == 0.0) return status;
  while (near > soon && status == PENDRES_OK) {
    at *= 2.0;
    if (LIVES_FURTHER * at > room) return status;
    status = mean_life(w, w->small + at * width, soon, &near);
  }
  const double further = fmin(CRISIS_FURTHER, room / at);
  if (status == PENDRES_OK) status = mean_life(w, w->small + further * at * width, near, &far);
  const double power = log(near / far) / log(further);
  if (status != PENDRES_OK || !(power > crisis_least_power)) return status;
  jump->value = 0.5 * (w->small + w->large);
  jump->value_error = fabs(width) * (0.5 + at * furthest(power, near));
  *found = 1;
  return status;
}

/* Whether a pendulum that starts from the smaller chaos is in chaos at a value. */
static pendres_status in_chaos(const search *w, double value, int *chaotic)
{
  const pendres_pendulum p = pendres_parameter_with(&w->smaller->pendulum, w->parameter, value);
  pendres_arrival s;
  const pendres_status status =
    pendres_arrival_name(w->ctx, &p, w->in.x[0], w->in.v[0], &s);
  *chaotic = status == PENDRES_OK && s.attractor.label == PENDRES_LABEL_CHAOTIC;
  return status;
}

/* Look at the chaos that a pendulum is in. */
static pendres_status look_at(pendres_context *ctx, const pendres_arrival *s,
                              pendres_crisis_seen *out)
{
  pendres_status status = pendres_chaos_spread(ctx, s, LIVES, out->in.x, out->in.v);
  if (status == PENDRES_OK) status = take_sample(ctx, &s->pendulum, &out->in, &out->points);
  out->pendulum = s->pendulum;
  out->x = status == PENDRES_OK ? s->x : NAN;
  out->v = s->v;
  return status;
}

/* Look at both chaotic motions: which of them is larger, if any; 1: the latter, -1: the former,
   which mostly was the latter of the last two. */
static pendres_status compare(search *w, pendres_crisis_seen **seen, const pendres_arrival *old,
                              const pendres_arrival *there, int *larger)
{
  region before, after;
  pendres_crisis_seen *first = *seen != NULL ? *seen : calloc(1, sizeof *first);
  pendres_crisis_seen *second = calloc(1, sizeof *second);
  pendres_status status = PENDRES_OK;
  *larger = 0;
  if (first == NULL || second == NULL)
    status = pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for strobe points");
  else if (!(pendres_model_same(&first->pendulum, &old->pendulum) && first->x == old->x &&
             first->v == old->v))
    status = look_at(w->ctx, old, first);
  if (status == PENDRES_OK) status = look_at(w->ctx, there, second);
  if (status == PENDRES_OK) {
    const sample *small = &first->points, *large = &second->points;
    make_region(&old->pendulum, small, large, &before);
    make_region(&there->pendulum, large, small, &after);
    if (share_outside(&before, large) > crisis_least_share) *larger = 1;
    else if (share_outside(&after, small) > crisis_least_share) *larger = -1;
    w->where = *larger < 0 ? after : before;
    w->in = *larger < 0 ? second->in : first->in;
  }
  free(first);
  *seen = second;
  return status;
}

void pendres_crisis_seen_pass(pendres_bytes *b, pendres_path *path)
{
  size_t n = path->seen != NULL;
  pendres_bytes_pass(b, 1, sizeof n, &n);
  if (pendres_bytes_fit(b, n < 2)) pendres_bytes_pass_array(b, n, sizeof *path->seen, &path->seen);
}

pendres_status pendres_crisis_find(pendres_path *path, const pendres_arrival *old,
                                   pendres_jump *jump)
{
  const pendres_arrival *there = &path->state;
  const double from = path->at, to = pendres_parameter_get(path->parameter, &there->pendulum);
  int larger = 0, found = 0, chaotic = 0;
  search *w = calloc(1, sizeof *w);
  if (w == NULL)
    return pendres_context_fail(path->ctx, PENDRES_OUT_OF_MEMORY,
                                "out of memory for strobe points");
  w->ctx = path->ctx;
  w->parameter = path->parameter;
  pendres_status status = compare(w, &path->seen, old, there, &larger);
  if (status != PENDRES_OK || larger == 0) goto done;
  w->smaller = larger > 0 ? old : there;
  w->small = larger > 0 ? from : to;
  w->large = larger > 0 ? to : from;
  const double begin = w->small, other = w->large;
  status = halve(w);
  /* Where chaos stays nowhere in between, its region may not have been all that there is of it. */
  if (status == PENDRES_OK && w->small != begin) status = by_lives(w, other, jump, &found);
  if (status == PENDRES_OK && found) status = in_chaos(w, w->small, &chaotic);
  if (!chaotic) goto done;
  jump->kind = PENDRES_JUMP_CRISIS;
  jump->from = jump->to = PENDRES_LABEL_CHAOTIC;
  jump->to_period = 0;
  jump->share = NAN;
  jump->certain = 0;
done:
  free(w);
  return status;
}
