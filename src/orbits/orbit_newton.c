/* orbit_newton.c -- Newton's method on the stroboscopic map; see orbit_newton.h. */
#include "orbits/orbit_newton.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/chain.h"
#include "engine/context_internal.h"
#include "engine/threads.h"
#include "engine/room.h"
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "model/model.h"
#include "orbits/numbers.h"
#include "orbits/strobe_noise.h"

const char *pendres_orbit_refuses(const pendres_orbit *o)
{
  const char *why = NULL;
  if (pendres_pendulum_check(&o->pendulum, &why) != PENDRES_OK) return why;
  if (o->period < 1 || o->period > ORBIT_LONGEST_PERIOD)
    return "an orbit has a period of 1 to 1000000";
  if (o->winding < -ORBIT_MOST_TURNS || o->winding > ORBIT_MOST_TURNS)
    return "an orbit turns over 1000000000 times at most";
  return pendres_coordinates_refuses(&o->pendulum, o->x, o->v);
}

void pendres_newton_samples_free(pendres_newton_samples *taken)
{
  free(taken->data);
  *taken = (pendres_newton_samples){0};
}

static int prepare_samples(pendres_newton_samples *t, size_t samples, size_t lanes, size_t rows)
{
  const size_t wanted = samples * lanes * rows;
  if (wanted > t->size) {
    if (!pendres_regrow(&t->data, wanted, sizeof *t->data)) return -1;
    t->size = wanted;
  }
  t->count = samples;
  t->lanes = lanes;
  t->rows = rows;
  return 0;
}

typedef struct recorder {
  pendres_newton_samples *taken;
  size_t offset;
} recorder;

static void record(void *arg, int step, const pendres_rows *rows)
{
  const recorder *r = arg;
  const size_t sample = r->offset + (size_t)step;
  if (sample >= r->taken->count) return; /* the end of the orbit is its beginning */
  double *to = r->taken->data + sample * r->taken->lanes * r->taken->rows;
  for (size_t lane = 0; lane < r->taken->lanes; lane++)
    for (size_t row = 0; row < r->taken->rows; row++)
      *to++ = pendres_rows_get(rows, (int)row, lane);
}

/* Where lane k starts: those of the candidates come first, then those a little aside in y, and in
   w. */
static pendres_chain_start start_of(const pendres_newton_candidate *c, size_t lanes, size_t k)
{
  const pendres_newton_candidate *of = &c[k % lanes];
  return (pendres_chain_start){of->guess->pendulum,
                               k / lanes == 1 ? of->y + newton_aside : of->y,
                               k / lanes == 2 ? of->w + newton_aside : of->w};
}

/* How the derivative of the map changes with the point: difference quotients, good to 1e-6. */
static void read_companions(const pendres_rows *rows, size_t lanes, pendres_newton_candidate *c)
{
  for (size_t k = 0; k < 2; k++) {
    double m[2][2];
    pendres_rows_tangent(rows, (k + 1) * lanes + c->lane, m);
    for (size_t row = 0; row < 2; row++)
      for (size_t column = 0; column < 2; column++)
        c->m_by[k][row][column] = (m[row][column] - c->m[row][column]) / newton_aside;
  }
}

static void read_lane(const pendres_rows *rows, int sensitive, pendres_newton_candidate *c)
{
  c->residual[0] =
    pendres_rows_get(rows, PENDRES_ROW_Y, c->lane) - c->y - two_pi * c->guess->winding;
  c->residual[1] = pendres_rows_get(rows, PENDRES_ROW_W, c->lane) - c->w;
  pendres_rows_tangent(rows, c->lane, c->m);
  if (sensitive) pendres_rows_pair(rows, PENDRES_ROW_BY_OMEGA, c->lane, c->by_omega);
}

static void read_lanes(const pendres_rows *rows, size_t lanes, pendres_flow_kind kind,
                       int companions, pendres_newton_candidate *c)
{
  for (size_t i = 0; i < lanes; i++) {
    read_lane(rows, kind == PENDRES_FLOW_SENSITIVITY, &c[i]);
    if (companions) read_companions(rows, lanes, &c[i]);
  }
}

/* The end of all their periods, where no samples of them are taken. */
static pendres_status run_chain(pendres_context *ctx, pendres_flow_kind kind, size_t lanes,
                                int companions, pendres_newton_candidate *c)
{
  const size_t all = lanes * (size_t)(1 + companions);
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_chain_start *from = pendres_room_take(&room, all, sizeof *from);
  double *at = pendres_room_take(&room, pendres_flow_kind_rows(kind) * all, sizeof *at);
  const pendres_chain chain = {.kind = kind, .steps = c[0].steps, .periods = c[0].guess->period,
                               .n = all, .from = from, .rows = at};
  pendres_status status = room.status;
  for (size_t k = 0; k < all && status == PENDRES_OK; k++) from[k] = start_of(c, lanes, k);
  if (status == PENDRES_OK) status = pendres_chain_run(ctx, &chain);
  const pendres_rows rows = {.at = at, .stride = all};
  if (status == PENDRES_OK) read_lanes(&rows, lanes, kind, companions, c);
  return pendres_room_close(&room, status);
}

pendres_status pendres_newton_pass(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                   pendres_orbit_want want, pendres_newton_samples *taken,
                                   size_t *count)
{
  pendres_block *b;
  const int sensitive = want == PENDRES_ORBIT_FREQUENCY_SLOPE;
  const int steps = c[0].steps, q = c[0].guess->period;
  const pendres_flow_kind kind = sensitive ? PENDRES_FLOW_SENSITIVITY : PENDRES_FLOW_VARIATIONAL;
  pendres_status status = pendres_block_open(ctx, kind, steps, &b);
  if (status != PENDRES_OK) return status;

  const pendres_model_terms model = pendres_model_kind(&c[0].guess->pendulum);
  const int companions = taken != NULL && taken->bends ? 2 : 0;
  const int sampled = taken != NULL && !taken->none;
  const size_t most = pendres_block_capacity(b) / (size_t)(1 + companions);
  size_t lanes = 0;
  while (lanes < n && lanes < most && c[lanes].steps == steps && c[lanes].guess->period == q &&
         pendres_model_kind(&c[lanes].guess->pendulum) == model)
    lanes++;
  *count = lanes;
  for (size_t i = 0; i < lanes; i++) c[i].lane = i;
  if (!sampled && pendres_chain_worth(q)) {
    status = run_chain(ctx, kind, lanes, companions, c);
    if (status == PENDRES_OK) ctx->cost.newton_steps += (double)lanes;
    return status;
  }

  const size_t kept = pendres_flow_kind_rows(kind);
  if (sampled && prepare_samples(taken, (size_t)steps * (size_t)q, lanes, kept) != 0)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for orbit samples");
  const size_t all = lanes * (size_t)(1 + companions);
  pendres_block_resize(b, all);
  for (size_t k = 0; k < all; k++) {
    const pendres_chain_start from = start_of(c, lanes, k);
    pendres_block_load(b, k, &from.pendulum, from.y, from.w);
  }
  recorder r = {.taken = taken};
  const pendres_rows rows = pendres_block_rows(b);
  if (sampled) record(&r, 0, &rows);
  for (int k = 0; k < q && status == PENDRES_OK; k++) {
    r.offset = (size_t)k * (size_t)steps;
    status = sampled ? pendres_block_period_sampled(b, record, &r) : pendres_block_period(b);
  }
  if (status != PENDRES_OK) return status;
  ctx->cost.newton_steps += (double)lanes;
  read_lanes(&rows, lanes, kind, companions, c);
  return PENDRES_OK;
}

int pendres_newton_solve(const double m[2][2], const double r[2], double z[2], double *stretch)
{
  const double a = 1.0 - m[0][0], b = -m[0][1], c = -m[1][0], d = 1.0 - m[1][1];
  const double det = a * d - b * c;
  if (!(fabs(det) > 1e-300)) return 0;
  z[0] = (d * r[0] - b * r[1]) / det;
  z[1] = (a * r[1] - c * r[0]) / det;
  if (stretch != NULL)
    *stretch = fmax(fabs(d) + fabs(b), fabs(a) + fabs(c)) / fabs(det);
  return 1;
}

int pendres_newton_closed(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                          double *y, double *w, double shift[2])
{
  if (!pendres_newton_solve(c->m, c->residual, shift, NULL)) return 0;
  for (size_t k = 0; k < taken->count; k++) {
    const double *row = pendres_newton_sample(taken, k, c->lane);
    y[k] = row[0] + row[2] * shift[0] + row[4] * shift[1];
    w[k] = row[1] + row[3] * shift[0] + row[5] * shift[1];
  }
  return 1;
}

/* The square of the size of the tangent at a sample. */
static double tangent_at(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                         size_t sample)
{
  const double *row = pendres_newton_sample(taken, sample, c->lane);
  return row[2] * row[2] + row[3] * row[3] + row[4] * row[4] + row[5] * row[5];
}

/*
 * An error that step j adds has grown by g_k / g_j at step k, where the g are sizes of the
 * tangents: errors that grow much all point in one direction. An error added after step k comes
 * there once around the closed orbit. Sums over all steps of the squares of this growth: *to_end up
 * to the end of the orbit, *to_any up to a step k, averaged over k.
 */
static void growth(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                   double *to_end, double *to_any)
{
  const size_t n = taken->count;
  const double first_row = hypot(c->m[0][0], c->m[0][1]);
  const double last_row = hypot(c->m[1][0], c->m[1][1]);
  const double last = first_row * first_row + last_row * last_row;
  const double around = last / tangent_at(c, taken, 0);
  double before = 0.0, after = 0.0, sum = 0.0, back = 1.0 / last;
  for (size_t k = 1; k < n; k++) {
    const double here = tangent_at(c, taken, k);
    before += 1.0 / here;
    sum += here * before;
  }
  for (size_t k = n; k-- > 0;) {
    const double here = tangent_at(c, taken, k);
    after += back;
    back = 1.0 / here;
    sum += here * around * after;
  }
  *to_end = 1.0 + last * before;
  *to_any = sum / (double)n;
}

double pendres_newton_share(const double m[2][2])
{
  const int larger = hypot(m[0][1], m[1][1]) > hypot(m[0][0], m[1][0]);
  const double ahead[2] = {m[0][larger], m[1][larger]}, size = hypot(ahead[0], ahead[1]);
  double back[2] = {0.0, 0.0};
  /* Where all errors have faded at the end of a period, none comes back. */
  if (!(size > 0.0) || !pendres_newton_solve(m, ahead, back, NULL)) return 1.0;
  return hypot(back[0], back[1]) / size;
}

double pendres_newton_rounding(pendres_table table)
{
  return newton_rounding * pendres_strobe_noise_of_step(table);
}

pendres_newton_noise pendres_newton_noise_of(const pendres_newton_candidate *c,
                                             const pendres_newton_samples *taken)
{
  const double unit[2] = {1.0, 1.0};
  double z[2], stretch = 1.0, to_end, to_any;

  (void)pendres_newton_solve(c->m, unit, z, &stretch);
  const double plain = sqrt(c->steps * (double)c->guess->period) * fmax(1.0, stretch);
  if (taken->none) return (pendres_newton_noise){.start = plain, .along = plain, .swell = 1.0};
  growth(c, taken, &to_end, &to_any);
  const double share = pendres_newton_share(c->m);
  const double start = share * sqrt(to_end), along = share * sqrt(to_any);
  const double swell = sqrt(to_any / to_end);
  /* A tangent too small for a double tells nothing. */
  return (pendres_newton_noise){.start = isfinite(start) ? fmax(plain, start) : plain,
                                .along = isfinite(along) ? fmax(plain, along) : plain,
                                .swell = isfinite(swell) ? fmax(1.0, swell) : 1.0};
}

/* One Newton step from what the latest pass found. */
static void improve(pendres_newton_candidate *c)
{
  double by[2] = {NAN, NAN};
  const pendres_newton_candidate *at = c;
  (void)pendres_newton_solve(at->m, at->residual, by, NULL);
  const double omega = c->guess->pendulum.drive_frequency;
  const double step = hypot(by[0], omega * by[1]);
  const int linear = pendres_model_is_linear(&c->guess->pendulum);

  c->iterations++;
  if (!(step < (linear ? INFINITY : 1e6)) ||
      (c->iterations > NEWTON_STEPS && step >= newton_last_step)) {
    c->state = PENDRES_NEWTON_FAILED;
    return;
  }
  if (step > newton_longest_step && !linear) {
    by[0] *= newton_longest_step / step;
    by[1] *= newton_longest_step / step;
  }
  c->y += by[0];
  c->w += by[1];
  const int stalled = c->iterations > NEWTON_STALLED && step < newton_stalled &&
                      step >= 0.5 * c->last_step;
  c->last_step = step;
  /* The orbit of a tiny drive is tiny itself: go on until the step is small against it. */
  const double size = c->guess->pendulum.drive_amplitude != 0.0 ? hypot(c->y, omega * c->w) : 1.0;
  const double enough = linear ? newton_last_step * fmax(1.0, size) : newton_last_step;
  if (step < fmin(enough, size) || stalled) c->state = PENDRES_NEWTON_CONVERGED;
}

/* Active candidates first, in the order of steps, period and index. */
static int in_order(const void *a, const void *b)
{
  const pendres_newton_candidate *p = a, *q = b;
  const int pa = p->state == PENDRES_NEWTON_ACTIVE, qa = q->state == PENDRES_NEWTON_ACTIVE;
  if (pa != qa) return pa ? -1 : 1;
  const pendres_model_terms pm = pendres_model_kind(&p->guess->pendulum);
  const pendres_model_terms qm = pendres_model_kind(&q->guess->pendulum);
  if (pm != qm) return pm < qm ? -1 : 1;
  if (p->steps != q->steps) return p->steps < q->steps ? -1 : 1;
  if (p->guess->period != q->guess->period)
    return p->guess->period < q->guess->period ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

void pendres_newton_order(size_t n, pendres_newton_candidate *c)
{
  qsort(c, n, sizeof *c, in_order);
}

size_t pendres_newton_each(const pendres_context *ctx, size_t n, const pendres_newton_candidate *c)
{
  double steps = 0.0;
  for (size_t i = 0; i < n; i++) steps += (double)c[i].steps * c[i].guess->period;
  return steps > newton_worth_threads ? pendres_threads_share(ctx, n) : n;
}

/* One step of Newton's method for some candidates, in the order in which they share blocks. */
static pendres_status improve_some(pendres_context *ctx, size_t begin, size_t n, void *arg)
{
  pendres_newton_candidate *c = (pendres_newton_candidate *)arg + begin;
  for (size_t first = 0, count; first < n; first += count) {
    const pendres_status status =
      pendres_newton_pass(ctx, n - first, c + first, PENDRES_ORBIT_PLAIN, NULL, &count);
    if (status != PENDRES_OK) return status;
    for (size_t i = first; i < first + count; i++) improve(&c[i]);
  }
  return PENDRES_OK;
}

/* Put the active ones of n candidates first, in the order in which they are; returns how many. */
static size_t bring_forward(size_t n, pendres_newton_candidate *c)
{
  size_t active = 0;
  for (size_t i = 0; i < n; i++) {
    if (c[i].state != PENDRES_NEWTON_ACTIVE) continue;
    if (i > active) {
      const pendres_newton_candidate swap = c[active];
      c[active] = c[i];
      c[i] = swap;
    }
    active++;
  }
  return active;
}

pendres_status pendres_newton_converge(pendres_context *ctx, size_t n, pendres_newton_candidate *c)
{
  size_t active = n;
  for (size_t i = 0; i < n; i++) {
    c[i].state = PENDRES_NEWTON_ACTIVE;
    c[i].iterations = 0;
    c[i].last_step = INFINITY;
  }
  pendres_newton_order(n, c);
  while (active > 0) {
    const pendres_status status =
      pendres_threads_run(ctx, active, pendres_newton_each(ctx, active, c), improve_some, c);
    if (status != PENDRES_OK) return status;
    active = bring_forward(active, c);
  }
  return PENDRES_OK;
}
