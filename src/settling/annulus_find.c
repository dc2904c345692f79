/* annulus_find.c -- looking for rotations, and for the states that settle on them; see
   annulus_find.h. */
#include "settling/annulus_find.h"

#include <gsl/gsl_spline.h>
#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"
#include "orbits/mean.h"
#include "orbits/orbit_table.h"
#include "settling/numbers.h"
#include "settling/settle_lanes.h"

#include <pendres/rotation.h>

enum { NODES = PENDRES_ANNULUS_NODES };

/* ---- lanes ---- */

static int stop(void *arg, size_t i, const pendres_strobe_lane *lane)
{
  const long *until = arg;
  (void)i;
  return lane->period >= *until;
}

/* Advance n lanes to the end of that period. */
static pendres_status advance(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                              long period)
{
  return pendres_strobe_run(ctx, n, lanes, stop, &period);
}

static pendres_status load(pendres_context *ctx, const pendres_attractor_set *c, double y, double w,
                           pendres_strobe_lane *lane)
{
  const pendres_coordinates at = {.y = y, .w = w};
  double x, v;
  pendres_coordinates_out(&c->pendulum, &at, &x, &v);
  return pendres_settle_load(ctx, c, x, v, pendres_accuracy_to_settle(ctx), lane);
}

static double node(int k)
{
  return two_pi * ((double)k / NODES - 0.5);
}

/* Periods in which what lies beside the curve fades. */
static long fading(const pendres_attractor_set *c)
{
  const double contracts = 2.0 * pendres_equation_fading(&c->pendulum);
  return (long)fmin(ceil(annulus_faded / contracts) + 1.0, ANNULUS_LONGEST);
}

/* ---- the curve ---- */

typedef struct place {
  double y, w;
} place;

static int by_angle(const void *a, const void *b)
{
  const place *p = a, *q = b;
  return (p->y > q->y) - (p->y < q->y);
}

/* Whether points, put into order, lie close enough all around; those that are closer to their
   neighbour than needed are dropped. */
static int thin_out(place *point, size_t *n)
{
  size_t kept = 0;
  qsort(point, *n, sizeof *point, by_angle);
  for (size_t i = 0; i < *n; i++)
    if (kept == 0 || point[i].y - point[kept - 1].y > annulus_points_apart)
      point[kept++] = point[i];
  while (kept > 1 && two_pi - (point[kept - 1].y - point[0].y) <= annulus_points_apart) kept--;
  *n = kept;
  if (kept < ANNULUS_POINTS) return 0;
  double widest = two_pi - (point[kept - 1].y - point[0].y);
  for (size_t i = 1; i < kept; i++) widest = fmax(widest, point[i].y - point[i - 1].y);
  return widest < annulus_widest_gap;
}

/* A periodic spline through the points. */
static pendres_status draw(pendres_context *ctx, size_t n, const place *point, pendres_annulus *a)
{
  pendres_room room = pendres_room_open(ctx, "a rotation");
  double *y = pendres_room_take(&room, n + 1, sizeof *y);
  double *w = pendres_room_take(&room, n + 1, sizeof *w);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    y[i] = point[i].y;
    w[i] = point[i].w;
  }
  y[n] = y[0] + two_pi;
  w[n] = w[0];
  gsl_spline *s = gsl_spline_alloc(gsl_interp_cspline_periodic, n + 1);
  pendres_status status = PENDRES_OK;
  if (s == NULL || gsl_spline_init(s, y, w, n + 1) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a rotation");
  for (int k = 0; k < NODES && status == PENDRES_OK; k++) {
    const double at = node(k) < y[0] ? node(k) + two_pi : node(k);
    a->centre[k] = gsl_spline_eval(s, at, NULL);
    a->slope[k] = gsl_spline_eval_deriv(s, at, NULL);
  }
  if (s != NULL) gsl_spline_free(s);
  return pendres_room_close(&room, status);
}

/* Find the curve that pendulums at all angles with the suspect's velocity come to. Those that come
   to rest instead, or to a rotation that is known, do not count. */
static pendres_status find_curve(pendres_context *ctx, const pendres_attractor_set *c,
                                 const pendres_strobe_lane *suspect, pendres_annulus *a,
                                 int *found)
{
  const long settled = fading(c);
  const int way = suspect->turns > 0 ? 1 : -1;
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "a rotation");
  pendres_strobe_lane *lanes = pendres_room_take(&room, NODES, sizeof *lanes);
  place *point = pendres_room_take(&room, (size_t)NODES * ANNULUS_STROBES, sizeof *point);
  pendres_status status = room.status;
  *found = 0;
  for (int k = 0; k < NODES && status == PENDRES_OK; k++)
    status = load(ctx, c, node(k), suspect->w, &lanes[k]);
  for (int strobe = 0; strobe < ANNULUS_STROBES && status == PENDRES_OK; strobe++) {
    status = advance(ctx, NODES, lanes, settled + strobe);
    for (int k = 0; k < NODES && status == PENDRES_OK; k++)
      if (way * lanes[k].turns > 0 &&
          pendres_attractor_set_ellipse(c, lanes[k].y, lanes[k].w) == NULL &&
          pendres_attractor_set_annulus(c, lanes[k].y, lanes[k].w) == NULL)
        point[count++] = (place){pendres_less_turns(lanes[k].y, two_pi), lanes[k].w};
  }
  if (status == PENDRES_OK) *found = thin_out(point, &count);
  if (*found) status = draw(ctx, count, point, a);
  return pendres_room_close(&room, status);
}

/* ---- edges ---- */

/* Whether the images of an edge, its lanes in the order of their starts, lie in an annulus. Between
   two of them the edge departs from its chord by less than the second differences there. */
static int inside(const pendres_annulus *a, const pendres_strobe_lane *lane)
{
  double off[NODES], slope;
  for (int k = 0; k < NODES; k++) {
    if (!(isfinite(lane[k].y) && isfinite(lane[k].w))) return 0;
    off[k] = lane[k].w - pendres_annulus_centre(a, lane[k].y, &slope);
  }
  for (int k = 0; k < NODES; k++) {
    const int last = (k + NODES - 1) % NODES, next = (k + 1) % NODES;
    const double step = lane[next].y - lane[k].y +
                        two_pi * (double)(lane[next].turns - lane[k].turns + (next == 0));
    const double departs = fabs(off[last] - 2.0 * off[k] + off[next]);
    const double room = pendres_annulus_room(a, lane[k].y, lane[k].w, &slope);
    if (!(fabs(step) < annulus_step)) return 0;
    if (!(departs < annulus_inside * (a->below + a->above) && room > departs)) return 0;
    if (!(room > annulus_margin * (off[k] < 0.0 ? a->below : a->above))) return 0;
  }
  return 1;
}

/* Whether the curve so far above that of an annulus comes into it, all of it at one time. */
static pendres_status comes_in(pendres_context *ctx, const pendres_attractor_set *c,
                               const pendres_annulus *a, double off, int *in)
{
  pendres_room room = pendres_room_open(ctx, "a rotation");
  pendres_strobe_lane *lanes = pendres_room_take(&room, NODES, sizeof *lanes);
  pendres_status status = room.status;
  *in = 0;
  for (int k = 0; k < NODES && status == PENDRES_OK; k++)
    status = load(ctx, c, node(k), a->centre[k] + off, &lanes[k]);
  const long most = 2 * fading(c) < ANNULUS_RETURNS ? 2 * fading(c) : ANNULUS_RETURNS;
  for (long period = 1; period <= most && !*in && status == PENDRES_OK; period *= 2) {
    status = advance(ctx, NODES, lanes, period);
    if (status == PENDRES_OK) *in = inside(a, lanes);
  }
  return pendres_room_close(&room, status);
}

/* One edge of an annulus, which is moved away from the curve by a factor as long as what is added
   comes back into the annulus. */
static pendres_status widen(pendres_context *ctx, const pendres_attractor_set *c,
                            pendres_annulus *a, double *edge, double sign, double most)
{
  double factor = annulus_first_factor;
  pendres_status status = PENDRES_OK;
  while (factor > annulus_least_factor && status == PENDRES_OK) {
    int in = 0;
    if (factor * *edge < most) status = comes_in(ctx, c, a, sign * factor * *edge, &in);
    if (in) *edge *= factor;
    else factor = sqrt(factor);
  }
  return status;
}

static double fastest_of(const pendres_annulus *a)
{
  double fastest = 0.0;
  for (int k = 0; k < NODES; k++) fastest = fmax(fastest, fabs(a->centre[k]));
  return fastest;
}

static pendres_status find_thin(pendres_context *ctx, const pendres_attractor_set *c,
                                pendres_annulus *a, int *found)
{
  int in[2] = {0, 0};
  a->below = a->above = annulus_thin * fastest_of(a);
  pendres_status status = comes_in(ctx, c, a, -a->below, &in[0]);
  if (status == PENDRES_OK) status = comes_in(ctx, c, a, a->above, &in[1]);
  *found = in[0] && in[1];
  return status;
}

static pendres_status find_wide(pendres_context *ctx, const pendres_attractor_set *c,
                                pendres_annulus *a)
{
  const double far = annulus_far * fastest_of(a);
  const pendres_status status = widen(ctx, c, a, &a->above, 1.0, far);
  return status == PENDRES_OK ? widen(ctx, c, a, &a->below, -1.0, far) : status;
}

/* ---- the mean ---- */

enum { RUNS = 2 }; /* the second with finer steps */

typedef struct turning {
  long periods;
  pendres_mean mean[RUNS];
  double before[RUNS]; /* the angle a period ago */
} turning;

static double turned(const pendres_strobe_lane *lane)
{
  return lane->y / two_pi + (double)lane->turns;
}

static int count_turns(void *arg, size_t i, const pendres_strobe_lane *lane)
{
  turning *t = arg;
  const double now = turned(lane);
  const pendres_mean_weights weights = pendres_mean_weights_at(lane->period - 1, t->periods);
  pendres_mean_add(&t->mean[i], &weights, now - t->before[i]);
  t->before[i] = now;
  return lane->period >= t->periods;
}

/* Whether a mean may be that of an orbit which closes after some periods. */
static int may_lock(double turns, double error)
{
  for (int q = 1; q < PENDRES_RECURRENCE_POINTS; q++)
    if (fabs(q * turns - rint(q * turns)) < q * (surely * error + annulus_rounding)) return 1;
  return 0;
}

/* The mean over so many periods from a state on the curve on. Its error is what the mean leaves,
   and what steps do, by which two runs differ. */
static pendres_status average(pendres_context *ctx, const pendres_attractor_set *c,
                              const pendres_annulus *a, long periods, pendres_attractor *out)
{
  pendres_strobe_lane lane[RUNS];
  turning t = {.periods = periods};
  double mean[RUNS], error[RUNS];
  const double speed = pendres_steps_turning_speed(&c->pendulum);
  pendres_status status = load(ctx, c, node(0), a->centre[0], &lane[0]);
  if (status == PENDRES_OK)
    status = pendres_steps_choose(ctx, &c->pendulum, speed, pendres_accuracy_of_means(ctx),
                                  &lane[0].steps);
  if (status == PENDRES_TOLERANCE_UNREACHABLE) status = PENDRES_OK; /* the error says so */
  if (status != PENDRES_OK) return status;
  lane[1] = lane[0];
  lane[1].steps = (int)ceil(annulus_finer * lane[0].steps);
  for (int k = 0; k < RUNS; k++) t.before[k] = turned(&lane[k]);
  status = pendres_strobe_run(ctx, RUNS, lane, count_turns, &t);
  if (status != PENDRES_OK) return status;
  for (int k = 0; k < RUNS; k++) mean[k] = pendres_mean_take(&t.mean[k], &error[k]);
  out->drift = mean[1];
  /* Of order eight, and four where that is not reached yet. */
  const double left = pow((double)lane[0].steps / lane[1].steps, 4) * fabs(mean[1] - mean[0]);
  out->drift_error = error[1] + left + annulus_rounding * (1.0 + fabs(mean[1]));
  return status;
}

/* The mean number of turns a drive period: without a drive that of the rotation, which is known by
   other means. */
static pendres_status find_mean(pendres_context *ctx, const pendres_attractor_set *c,
                                const pendres_annulus *a, pendres_attractor *out, int *found)
{
  const pendres_pendulum *p = &c->pendulum;
  const int driven = p->drive_amplitude != 0.0 || p->parametric_amplitude != 0.0;
  pendres_rotation r;
  pendres_status status = PENDRES_OK;
  *found = !driven && p->force == PENDRES_FORCE_PENDULUM &&
           pendres_rotation_find(p, &r, NULL) == PENDRES_OK;
  if (*found) {
    out->drift = r.mean_velocity / p->drive_frequency;
    out->drift_error = r.mean_velocity_error / p->drive_frequency;
  }
  for (long n = ANNULUS_MEAN; n <= ANNULUS_LONGEST_MEAN && !*found && status == PENDRES_OK;
       n *= 4) {
    status = average(ctx, c, a, n, out);
    *found = status == PENDRES_OK && out->drift_error < annulus_mean &&
             !(driven && may_lock(out->drift, out->drift_error));
  }
  out->label = driven ? PENDRES_LABEL_QUASI_PERIODIC : PENDRES_LABEL_RUNNING;
  return status;
}

/* ---- all ---- */

static pendres_status append(pendres_context *ctx, pendres_attractor_set *c, pendres_attractor *of,
                             pendres_annulus *a)
{
  if (pendres_attractor_set_reserve(c, 0) != 0) {
    free(a);
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  }
  of->orbit = pendres_orbit_none(&c->pendulum);
  const pendres_coordinates at = {.y = node(0), .w = a->centre[0]};
  pendres_coordinates_out(&c->pendulum, &at, &of->orbit.x, &of->orbit.v);
  of->trap_metric[0] = of->trap_metric[1] = of->trap_metric[2] = of->trap_radius = NAN;
  of->watched_periods = of->escape_rate_bound = NAN;
  c->attractors[c->count] = *of;
  a->attractor = (int)c->count++;
  c->annulus[c->annuli++] = a;
  return PENDRES_OK;
}

static pendres_status look(pendres_context *ctx, pendres_attractor_set *c,
                           const pendres_strobe_lane *suspect, int *found)
{
  pendres_attractor of = {.drift = NAN};
  pendres_annulus *a = calloc(1, sizeof *a);
  if (a == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a rotation");
  pendres_status status = find_curve(ctx, c, suspect, a, found);
  if (status == PENDRES_OK && *found) status = find_thin(ctx, c, a, found);
  if (status == PENDRES_OK && *found) status = find_mean(ctx, c, a, &of, found);
  if (status == PENDRES_OK && *found) status = find_wide(ctx, c, a);
  if (status == PENDRES_OK && *found) return append(ctx, c, &of, a);
  free(a);
  return status;
}

pendres_status pendres_annulus_find(pendres_context *ctx, pendres_attractor_set *c, size_t n,
                                    const pendres_strobe_lane *const *lanes, int *found)
{
  pendres_status status = PENDRES_OK;
  const pendres_pendulum *p = &c->pendulum;
  *found = 0;
  if (!c->rotations || !pendres_pendulum_rotates(p)) return status;
  for (int way = -1; way <= 1; way += 2) {
    const pendres_strobe_lane *suspect = NULL;
    int new = 0;
    if (c->annuli == PENDRES_MOST_ANNULI) return status;
    for (size_t i = 0; i < n && suspect == NULL; i++)
      if (way * lanes[i]->turns >= ANNULUS_TURNS) suspect = lanes[i];
    if (suspect != NULL) status = look(ctx, c, suspect, &new);
    if (status != PENDRES_OK) return status;
    *found |= new;
  }
  return status;
}
