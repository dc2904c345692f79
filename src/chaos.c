/* chaos.c -- telling chaos from slow settling; see chaos.h. */
#include "chaos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue.h"
#include "context_internal.h"
#include "steps.h"

static const double two_pi = 6.28318530717958647693;

enum {
  SUSPECTS = 16,        /* lanes that are looked at first ... */
  SUSPECT_PERIODS = 128, /* ... for so long */
  WALKERS = 64,         /* that then measure the exponent, after having lost each other */
  WARM_UP = 200,
  PERIODS = 400
};

/* Standard errors that an exponent must be above zero. */
static const double significance = 5.0;
/* Least growth of the logarithm a period: slower is not told from slow settling. */
static const double least_growth = 0.01;
/* A suspect's tangent vector must have grown by e to this: without chaos it grows by a few. */
static const double suspicious = 2.0;
/* Walkers start this close to the suspect. */
static const double scatter = 1e-3;

/* A pendulum with a tangent vector. */
typedef struct walker {
  double y, w, u[2], sum;
  int trapped;
} walker;

static int cell_of(const pendres_cover *cover, double y, double w, int *row, int *column)
{
  const double a = y / two_pi + 0.5, b = 0.5 * (w / cover->w_most + 1.0);
  /* Neither NaN nor what no int holds. */
  if (!(isfinite(a) && b >= 0.0 && b < 1.0)) return 0;
  *row = (int)floor((a - floor(a)) * PENDRES_COVER_CELLS);
  *column = (int)floor(b * PENDRES_COVER_CELLS);
  if (*row == PENDRES_COVER_CELLS) *row = 0;
  return 1;
}

int pendres_cover_holds(const pendres_cover *cover, double y, double w)
{
  int row, column;
  return cell_of(cover, y, w, &row, &column) && cover->cell[row][column];
}

/* A visited cell and its neighbours. */
static void cover_add(pendres_cover *cover, double y, double w)
{
  int row, column;
  if (!cell_of(cover, y, w, &row, &column)) return;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++) {
      const int r = (row + i + PENDRES_COVER_CELLS) % PENDRES_COVER_CELLS, s = column + j;
      if (s >= 0 && s < PENDRES_COVER_CELLS) cover->cell[r][s] = 1;
    }
}

static int in_trap(const pendres_catalogue *c, const walker *a)
{
  for (size_t i = 0; i < c->traps; i++)
    if (pendres_trap_norm2(&c->trap[i], a->y, a->w) <= c->trap[i].radius * c->trap[i].radius)
      return 1;
  return 0;
}

/* One period of the walkers of a block; their tangent vectors grow by the period's derivative. */
static pendres_status step_block(pendres_context *ctx, pendres_flow *flow,
                                 const pendres_catalogue *c, size_t n, walker *a)
{
  for (size_t i = 0; i < n; i++)
    pendres_flow_set_lane(flow, i, &c->pendulum, a[i].y, a[i].w);
  pendres_status status = pendres_context_poll(ctx);
  if (status == PENDRES_OK) {
    status = pendres_flow_period(flow);
    if (status != PENDRES_OK) return pendres_context_flow_failed(ctx, flow, status);
  }
  if (status != PENDRES_OK) return status;
  ctx->cost.pendulum_periods += (double)n;

  const double *state = pendres_flow_state(flow);
  const size_t stride = pendres_flow_stride(flow);
  for (size_t i = 0; i < n; i++) {
    const double m[6] = {state[i],              state[stride + i],     state[2 * stride + i],
                         state[3 * stride + i], state[4 * stride + i], state[5 * stride + i]};
    const double u = m[2] * a[i].u[0] + m[4] * a[i].u[1];
    const double v = m[3] * a[i].u[0] + m[5] * a[i].u[1];
    const double length = hypot(u, v);
    long turns = 0;
    a[i].y = m[0];
    a[i].w = m[1];
    pendres_strobe_wrap(&a[i].y, &turns);
    a[i].u[0] = u / length;
    a[i].u[1] = v / length;
    a[i].sum += log(length);
    if (in_trap(c, &a[i])) a[i].trapped = 1;
  }
  return PENDRES_OK;
}

/* Where walkers came by. */
typedef struct trace {
  size_t count;
  double y[WALKERS * PERIODS], w[WALKERS * PERIODS];
} trace;

/* Walk for some periods; visited may be NULL. */
static pendres_status walk(pendres_context *ctx, const pendres_catalogue *c, size_t n, walker *a,
                           int periods, trace *visited)
{
  pendres_flow *flow = NULL;
  int steps = 0;
  double fastest = 0.0;
  for (size_t i = 0; i < n; i++) fastest = fmax(fastest, fabs(a[i].w));
  /* Chaos forgets single errors: what matters is that the flow is the right one. */
  pendres_status status =
    pendres_steps_choose(ctx, &c->pendulum, fastest * c->pendulum.drive_frequency,
                         fmax(1e-7, 10.0 * ctx->options.tolerance), &steps);
  if (status == PENDRES_OK) status = pendres_context_flow(ctx, PENDRES_FLOW_VARIATIONAL, &flow);
  if (status != PENDRES_OK) return status;
  status = pendres_flow_set_steps(flow, steps);
  if (status != PENDRES_OK) return pendres_context_flow_failed(ctx, flow, status);

  const size_t capacity = pendres_flow_capacity(flow);
  for (size_t first = 0; first < n && status == PENDRES_OK; first += capacity) {
    const size_t lanes = n - first < capacity ? n - first : capacity;
    pendres_flow_resize(flow, lanes);
    for (int k = 0; k < periods && status == PENDRES_OK; k++) {
      status = step_block(ctx, flow, c, lanes, a + first);
      for (size_t i = first; i < first + lanes && visited != NULL && status == PENDRES_OK; i++) {
        visited->y[visited->count] = a[i].y;
        visited->w[visited->count++] = a[i].w;
      }
    }
  }
  return status;
}

static walker start_walker(double y, double w)
{
  return (walker){.y = y, .w = w, .u = {0.6, 0.8}};
}

/* A lane whose nearby motions part from each other, among the first few; *any: 0 if none is. */
static pendres_status find_suspect(pendres_context *ctx, const pendres_catalogue *c, size_t n,
                                   const pendres_strobe_lane *const *lanes, walker *suspect,
                                   int *any)
{
  walker a[SUSPECTS];
  const size_t asked = n < SUSPECTS ? n : SUSPECTS;
  for (size_t i = 0; i < asked; i++) {
    const pendres_strobe_lane *l = lanes[i * n / asked];
    a[i] = start_walker(l->y, l->w);
  }
  const pendres_status status = walk(ctx, c, asked, a, SUSPECT_PERIODS, NULL);
  *any = 0;
  for (size_t i = 0; i < asked && !*any && status == PENDRES_OK; i++)
    if (!a[i].trapped && a[i].sum > suspicious) {
      *suspect = a[i];
      *any = 1;
    }
  return status;
}

/* Growth a period, its standard error; 0 if any walker fell into a trap. */
static int growth(size_t n, const walker *a, double *mean, double *error)
{
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < n; i++) {
    if (a[i].trapped) return 0;
    sum += a[i].sum / PERIODS;
  }
  *mean = sum / (double)n;
  for (size_t i = 0; i < n; i++) {
    const double d = a[i].sum / PERIODS - *mean;
    squares += d * d;
  }
  *error = sqrt(squares / ((double)n * (double)(n - 1)));
  return 1;
}

static double share_within(const pendres_cover *cover, const trace *t)
{
  size_t inside = 0;
  for (size_t i = 0; i < t->count; i++)
    inside += (size_t)pendres_cover_holds(cover, t->y[i], t->w[i]);
  return (double)inside / (double)t->count;
}

static pendres_cover *create_cover(const trace *t)
{
  pendres_cover *cover = calloc(1, sizeof *cover);
  if (cover == NULL) return NULL;
  for (size_t i = 0; i < t->count; i++) {
    cover->w_most = fmax(cover->w_most, 1.1 * fabs(t->w[i]));
    cover->mean_y += t->y[i] / (double)t->count;
    cover->mean_w += t->w[i] / (double)t->count;
  }
  return cover;
}

/* Walkers that start around the suspect and lose each other. */
static pendres_status measure(pendres_context *ctx, const pendres_catalogue *c,
                              const walker *suspect, walker *a, trace *visited)
{
  for (size_t i = 0; i < WALKERS; i++) {
    /* Spread by an irrational angle: no two walkers start at the same place. */
    const double angle = 2.39996322972865332 * (double)i;
    a[i] = start_walker(suspect->y + scatter * cos(angle), suspect->w + scatter * sin(angle));
  }
  const pendres_status status = walk(ctx, c, WALKERS, a, WARM_UP, NULL);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < WALKERS; i++) a[i].sum = 0.0;
  return walk(ctx, c, WALKERS, a, PERIODS, visited);
}

pendres_status pendres_chaos_find(pendres_context *ctx, pendres_catalogue *c, size_t n,
                                  const pendres_strobe_lane *const *lanes, int *found)
{
  walker suspect, a[WALKERS];
  int any = 0;
  double mean = 0.0, error = 0.0;
  *found = 0;
  if (n == 0 || c->covers == PENDRES_MOST_COVERS) return PENDRES_OK;
  pendres_status status = find_suspect(ctx, c, n, lanes, &suspect, &any);
  if (status != PENDRES_OK || !any) return status;

  trace *visited = calloc(1, sizeof *visited);
  if (visited == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaotic motion");
  status = measure(ctx, c, &suspect, a, visited);
  if (status != PENDRES_OK || !growth(WALKERS, a, &mean, &error)) goto done;
  if (!(mean > significance * error && mean > least_growth)) goto done;

  pendres_cover *cover = NULL;
  for (size_t i = 0; i < c->covers; i++)
    if (share_within(c->cover[i], visited) > 0.5) cover = c->cover[i];
  if (cover == NULL) {
    const double tau = two_pi / c->pendulum.drive_frequency;
    cover = create_cover(visited);
    status = cover != NULL
               ? pendres_catalogue_add_chaos(ctx, c, mean / tau, error / tau, cover)
               : pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaos");
  }
  for (size_t i = 0; i < visited->count && status == PENDRES_OK; i++)
    cover_add(cover, visited->y[i], visited->w[i]);
  *found = status == PENDRES_OK;
done:
  free(visited);
  return status;
}
