/* annulus_find.c -- looking for rotations, and for the states that settle on them; see
   annulus_find.h. */
#include "settling/annulus_find.h"

#include <gsl/gsl_spline.h>
#include <math.h>
#include <stdlib.h>

#include <pendres/strobe.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"
#include "settling/numbers.h"
#include "orbits/mean.h"
#include "settling/exponents/lyapunov_move.h"
#include "settling/exponents/undriven.h"
#include "settling/settle_lanes.h"

enum { NODES = PENDRES_ANNULUS_NODES };

/* ---- lanes ---- */

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
  const double contracts = pendres_equation_shrinking(&c->pendulum);
  return (long)fmin(ceil(exponent_forgets / contracts) + 1.0, settle_first_most);
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

/* Put points into order, and drop those that are closer to their neighbour than needed. */
static void thin_out(place *point, size_t *n)
{
  size_t kept = 0;
  qsort(point, *n, sizeof *point, by_angle);
  for (size_t i = 0; i < *n; i++)
    if (kept == 0 || point[i].y - point[kept - 1].y > annulus_points_apart)
      point[kept++] = point[i];
  while (kept > 1 && two_pi - (point[kept - 1].y - point[0].y) <= annulus_points_apart) kept--;
  *n = kept;
}

/* Whether points, in order, lie close enough all around. */
static int close_up(const place *point, size_t n)
{
  if (n < ANNULUS_POINTS) return 0;
  double widest = two_pi - (point[n - 1].y - point[0].y);
  for (size_t i = 1; i < n; i++) widest = fmax(widest, point[i].y - point[i - 1].y);
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
  const size_t most = NODES * NODES; /* points, many times those that are left when thinned out */
  /* A slow rotation is fast in one place: each pendulum must have passed there. */
  const long strobes = ANNULUS_STROBES + suspect->period / labs(suspect->turns);
  const int way = suspect->turns > 0 ? 1 : -1;
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "a rotation");
  pendres_strobe_lane *lanes = pendres_room_take(&room, NODES, sizeof *lanes);
  place *point = pendres_room_take(&room, most, sizeof *point);
  pendres_status status = room.status;
  *found = 0;
  for (int k = 0; k < NODES && status == PENDRES_OK; k++)
    status = load(ctx, c, node(k), suspect->w, &lanes[k]);
  for (long strobe = 0; strobe < strobes && status == PENDRES_OK; strobe++) {
    if (count + NODES > most) thin_out(point, &count);
    status = pendres_strobe_run_until(ctx, NODES, lanes, settled + strobe);
    for (int k = 0; k < NODES && status == PENDRES_OK; k++)
      if (way * lanes[k].turns > 0 &&
          pendres_attractor_set_ellipse(c, lanes[k].y, lanes[k].w) == NULL &&
          pendres_attractor_set_annulus(c, lanes[k].y, lanes[k].w) == NULL)
        point[count++] = (place){pendres_less_turns(lanes[k].y, two_pi), lanes[k].w};
  }
  if (status == PENDRES_OK) thin_out(point, &count);
  if (status == PENDRES_OK) *found = close_up(point, count);
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

/* Whether a part of an edge has come to an orbit that is known, and does not leave it. */
static int settled(const pendres_attractor_set *c, const pendres_strobe_lane *lane)
{
  for (int k = 0; k < NODES; k++)
    if (pendres_attractor_set_ellipse(c, lane[k].y, lane[k].w) != NULL) return 1;
  return 0;
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
    status = pendres_strobe_run_until(ctx, NODES, lanes, period);
    if (status == PENDRES_OK) *in = inside(a, lanes);
    if (!*in && settled(c, lanes)) break;
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

/* ---- means ---- */

/* The mean number of turns a drive period of a pendulum on the curve, and whether it is on such a
   rotation at all: a lock of many periods has a curve around the cylinder, too. Afterwards it is
   nearer to the curve than this was drawn: weakly damped, it would not come to it in an average. */
static pendres_status find_turns(pendres_context *ctx, const pendres_attractor_set *c,
                                 pendres_open_measures *m, int *found)
{
  pendres_settled told;
  pendres_orbit orbit;
  const pendres_lyapunov_motion motion = {.n = 1, .pendulum = &c->pendulum, .x = &m->x, .v = &m->v,
                                          .out = &told, .orbit = &orbit, .points = 1};
  const pendres_status status = pendres_lyapunov_move(ctx, &motion, PENDRES_CARE_FULL);
  *found = status == PENDRES_OK && told.period == 0 &&
           told.label == PENDRES_LABEL_QUASI_PERIODIC;
  if (!*found) return status;
  m->label = told.label;
  m->turns = (pendres_chaos_mean){told.rotation, told.rotation_error};
  pendres_coordinates at = pendres_coordinates_in(&c->pendulum, m->x, m->v);
  at.turns = 0;
  pendres_coordinates_out(&c->pendulum, &at, &m->x, &m->v);
  return status;
}

/* Means over samples of a motion, for a drive period each: the work of the drive, what friction
   takes, and errors of both. */
typedef struct sampled {
  pendres_mean work, loss;
  int steps; /* a period */
} sampled;

/* Add a piece of a record, number `piece` of so many. */
static void add_piece(const pendres_pendulum *p, int samples, long piece, long pieces,
                      const pendres_record *record, sampled *s)
{
  const long n = (long)samples * ANNULUS_STROBES;
  for (long k = 0; k < n; k++) {
    const pendres_mean_weights weights = pendres_mean_weights_at(piece * n + k, pieces * n);
    const double y = record->x[k] - pendres_model_origin(p);
    const double v = record->v[k], w = two_pi * v / p->drive_frequency;
    pendres_mean_add(&s->work, &weights,
                     p->drive_amplitude * w * cos(two_pi * (double)(k % samples) / samples));
    pendres_mean_add(&s->loss, &weights, pendres_equation_friction(p, y, v) * v * w);
  }
}

/* So many samples a period, each after one step or several. */
static pendres_status sample(pendres_context *ctx, const pendres_pendulum *p, int samples,
                             const pendres_open_measures *m, sampled *s)
{
  /* As long as a first average; so many turns, where these take longer. */
  const long pieces = (long)fmin(EXPONENT_PERIODS * fmax(1.0, 1.0 / fabs(m->turns.value)),
                                 settle_slowest) / ANNULUS_STROBES;
  const size_t n = (size_t)samples * ANNULUS_STROBES + 1;
  pendres_recording r;
  pendres_room room = pendres_room_open(ctx, "a rotation");
  const pendres_record record = {
    .x = pendres_room_take(&room, n, sizeof *record.x),
    .v = pendres_room_take(&room, n, sizeof *record.v)};
  pendres_status status = room.status;
  if (status == PENDRES_OK)
    status = pendres_recording_begin(ctx, p, &(pendres_state){m->x, m->v},
                                     pieces * ANNULUS_STROBES, samples, &r);
  for (long k = 0; k < pieces && status == PENDRES_OK; k++) {
    status = pendres_recording_advance(ctx, &r, ANNULUS_STROBES, &record);
    if (status == PENDRES_OK) add_piece(p, samples, k, pieces, &record, s);
  }
  if (status == PENDRES_OK) s->steps = r.stretch * samples;
  return pendres_room_close(&room, status);
}

/* The mean of the run with finer steps, with what is left of its error by steps. */
static pendres_chaos_mean compare(const pendres_mean *coarse, const pendres_mean *finer)
{
  pendres_chaos_mean m;
  double unused;
  m.value = pendres_mean_take(finer, &m.error);
  m.error += claimed_share * fabs(m.value - pendres_mean_take(coarse, &unused));
  m.error += means_rounding * (1.0 + fabs(m.value));
  return m;
}

/* Its work, and what friction takes. */
static pendres_status find_works(pendres_context *ctx, const pendres_pendulum *p,
                                 pendres_open_measures *m)
{
  sampled coarse = {0}, finer = {0};
  int samples = 1;
  m->work = m->loss = (pendres_chaos_mean){NAN, NAN};
  pendres_status status = pendres_steps_choose(ctx, p, pendres_steps_turning_speed(p),
                                               pendres_accuracy_of_means(ctx), &samples);
  if (status == PENDRES_OK) status = sample(ctx, p, samples, m, &coarse);
  if (status == PENDRES_OK)
    status = sample(ctx, p, (int)ceil(finer_steps * coarse.steps), m, &finer);
  if (status == PENDRES_TOLERANCE_UNREACHABLE) return PENDRES_OK; /* they stay unknown */
  if (status != PENDRES_OK) return status;
  m->work = compare(&coarse.work, &finer.work);
  m->loss = compare(&coarse.loss, &finer.loss);
  return status;
}

/* ---- all ---- */

static pendres_status look(pendres_context *ctx, pendres_attractor_set *c,
                           const pendres_strobe_lane *suspect, int *found)
{
  pendres_open_measures m = {.amplitude = {NAN, NAN}, .watched_periods = NAN,
                             .escape_rate_bound = NAN};
  pendres_annulus *a = calloc(1, sizeof *a);
  if (a == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a rotation");
  pendres_status status = find_curve(ctx, c, suspect, a, found);
  if (status == PENDRES_OK && *found) status = find_thin(ctx, c, a, found);
  const pendres_coordinates at = {.y = node(0), .w = a->centre[0]};
  pendres_coordinates_out(&c->pendulum, &at, &m.x, &m.v);
  if (status == PENDRES_OK && *found) status = find_turns(ctx, c, &m, found);
  if (status == PENDRES_OK && *found) status = find_works(ctx, &c->pendulum, &m);
  if (status == PENDRES_OK && *found) status = find_wide(ctx, c, a);
  if (status == PENDRES_OK && *found) return pendres_attractor_set_add_open(ctx, c, &m, NULL, a);
  free(a);
  return status;
}

/* Add the rotation without a drive if one of the lanes has come to it. */
static pendres_status find_undriven(pendres_context *ctx, pendres_attractor_set *c,
                                    const pendres_annulus_suspects *of, int *found)
{
  pendres_rotation r;
  double x, v;
  if (c->turns || of->n == 0 || pendres_rotation_find(&c->pendulum, &r, NULL) != PENDRES_OK)
    return PENDRES_OK;
  for (size_t i = 0; i < of->n && !*found; i++) {
    pendres_strobe_lane_out(of->lane[i], &x, &v);
    *found = pendres_undriven_rotates(&c->pendulum, of->x[i], x, v);
  }
  if (!*found) return PENDRES_OK;
  const pendres_open_measures m = pendres_open_turning(&c->pendulum, &r);
  return pendres_attractor_set_add_open(ctx, c, &m, NULL, NULL);
}

pendres_status pendres_annulus_find(pendres_context *ctx, pendres_attractor_set *c, long budget,
                                    const pendres_annulus_suspects *of, int *found)
{
  pendres_status status = PENDRES_OK;
  const pendres_pendulum *p = &c->pendulum;
  *found = 0;
  if (pendres_undriven(p)) return find_undriven(ctx, c, of, found);
  if (!pendres_pendulum_rotates(p) || fading(c) > budget) return status;
  for (int way = -1; way <= 1; way += 2) {
    const pendres_strobe_lane *suspect = NULL;
    int new = 0;
    if (c->annuli == PENDRES_MOST_ANNULI) return status;
    for (size_t i = 0; i < of->n && suspect == NULL; i++)
      if (way * of->lane[i]->turns >= ANNULUS_TURNS) suspect = of->lane[i];
    if (suspect != NULL) status = look(ctx, c, suspect, &new);
    if (status != PENDRES_OK) return status;
    *found |= new;
  }
  return status;
}
