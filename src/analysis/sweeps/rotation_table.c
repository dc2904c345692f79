/* rotation_table.c -- rotations without a drive along a parameter; see rotation_table.h. */
#include "analysis/sweeps/rotation_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/strobe.h>

#include "analysis/sweeps/numbers.h"
#include "base/angles.h"
#include "engine/context_internal.h"
#include "model/equation.h"
#include "model/model.h"

enum {
  NODES = 25,     /* of an interpolation */
  LAST = 3       /* coefficients that tell what is missing */
};

struct pendres_rotation_table {
  pendres_pendulum pendulum; /* but for the parameter */
  pendres_parameter parameter;
  double tolerance; /* relative */
  size_t n;
  double *value;              /* ascending */
  pendres_rotation *rotation; /* at each; a period of 0: there is none */
};

static pendres_pendulum pendulum_at(const pendres_rotation_table *t, double value)
{
  pendres_pendulum p = t->pendulum;
  pendres_parameter_set(t->parameter, value, &p);
  return p;
}

/* A period of 0 where there is none. */
static pendres_rotation rotation_at(const pendres_rotation_table *t, double value)
{
  const pendres_pendulum p = pendulum_at(t, value);
  pendres_rotation r = {.period = 0.0};
  return pendres_rotation_find(&p, &r, NULL) == PENDRES_OK ? r : (pendres_rotation){.period = 0.0};
}

/* ---- polynomials --------------------------------------------------------------------------- */

/* Rotations at Chebyshev's points between two values. */
typedef struct patch {
  double at[NODES];
  pendres_rotation rotation[NODES];
  double velocity_missing, v_missing; /* of polynomials through them */
} patch;

/* The largest of the last Chebyshev coefficients of values at the nodes. */
static double missing(const double y[NODES])
{
  double largest = 0.0;
  for (int degree = NODES - LAST; degree < NODES; degree++) {
    double sum = 0.0;
    for (int k = 0; k < NODES; k++) {
      const double half = k == 0 || k == NODES - 1 ? 0.5 : 1.0;
      sum += half * cos(pi * k * degree / (NODES - 1)) * y[k];
    }
    largest = fmax(largest, 2.0 * fabs(sum) / (NODES - 1));
  }
  return largest;
}

/* The polynomial through values at the nodes, by the barycentric formula. */
static double between(const patch *a, const double y[NODES], double value)
{
  double above = 0.0, below = 0.0;
  for (int k = 0; k < NODES; k++) {
    if (value == a->at[k]) return y[k];
    const double half = k == 0 || k == NODES - 1 ? 0.5 : 1.0;
    const double weight = (k % 2 == 0 ? half : -half) / (value - a->at[k]);
    above += weight * y[k];
    below += weight;
  }
  return above / below;
}

/* Whether a polynomial serves from one value to another, at both of which there is a rotation. */
static int fit(const pendres_rotation_table *t, double low, double high, patch *out)
{
  double velocity[NODES], v[NODES], least = INFINITY;
  for (int k = 0; k < NODES; k++) {
    const double part = 0.5 - 0.5 * cos(pi * k / (NODES - 1));
    out->at[k] = k == NODES - 1 ? high : low + part * (high - low);
    out->rotation[k] = rotation_at(t, out->at[k]);
    if (!(out->rotation[k].period > 0.0)) return 0;
    velocity[k] = out->rotation[k].mean_velocity;
    v[k] = out->rotation[k].v;
    least = fmin(least, fabs(velocity[k]));
  }
  out->velocity_missing = missing(velocity);
  out->v_missing = missing(v);
  return out->velocity_missing < t->tolerance * least && out->v_missing < t->tolerance * least;
}

static void interpolate(pendres_rotation_table *t, const patch *a, size_t first, size_t last)
{
  double velocity[NODES], v[NODES], velocity_error = 0.0, v_error = 0.0;
  for (int k = 0; k < NODES; k++) {
    velocity[k] = a->rotation[k].mean_velocity;
    v[k] = a->rotation[k].v;
    velocity_error = fmax(velocity_error, a->rotation[k].mean_velocity_error);
    v_error = fmax(v_error, a->rotation[k].v_error);
  }
  for (size_t i = first; i < last; i++) {
    pendres_rotation *r = &t->rotation[i];
    r->mean_velocity = between(a, velocity, t->value[i]);
    r->v = between(a, v, t->value[i]);
    r->mean_velocity_error = velocity_error + a->velocity_missing;
    r->v_error = v_error + a->v_missing;
    r->period = two_pi / fabs(r->mean_velocity);
  }
}

/* Rotations at the values from number first up to, without it, last. */
static pendres_status fill(pendres_context *ctx, pendres_rotation_table *t, size_t first,
                           size_t last)
{
  pendres_status status = pendres_context_poll(ctx);
  if (status != PENDRES_OK) return status;
  if (last - first <= NODES) {
    for (size_t i = first; i < last; i++) t->rotation[i] = rotation_at(t, t->value[i]);
    return PENDRES_OK;
  }
  const double low = t->value[first], high = t->value[last - 1];
  const pendres_rotation lowest = rotation_at(t, low), highest = rotation_at(t, high);
  const double way = pendulum_at(t, low).torque * pendulum_at(t, high).torque;
  patch a;
  /* Rotations one way reach as far as one value: none at both ends are none between them. */
  if (way >= 0.0 && lowest.period == 0.0 && highest.period == 0.0) return PENDRES_OK;
  if (lowest.period > 0.0 && highest.period > 0.0 && way > 0.0 && fit(t, low, high, &a)) {
    interpolate(t, &a, first, last);
    return PENDRES_OK;
  }
  const size_t middle = first + (last - first) / 2;
  status = fill(ctx, t, first, middle);
  return status == PENDRES_OK ? fill(ctx, t, middle, last) : status;
}

/* ---- the table ----------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b)
{
  const double *p = a, *q = b;
  return (*p > *q) - (*p < *q);
}

pendres_status pendres_rotation_table_create(pendres_context *ctx, const pendres_pendulum *p,
                                             pendres_parameter parameter, size_t n,
                                             const double *value, pendres_rotation_table **out)
{
  pendres_rotation_table *t = calloc(1, sizeof *t);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  *out = NULL;
  if (t != NULL) t->value = malloc((n + 1) * sizeof *t->value);
  if (t != NULL) t->rotation = calloc(n + 1, sizeof *t->rotation);
  if (t == NULL || t->value == NULL || t->rotation == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu rotations", n);
  } else {
    t->pendulum = *p;
    t->parameter = parameter;
    t->tolerance = fmax(table_finest, table_of_tolerance * ctx->options.tolerance);
    memcpy(t->value, value, n * sizeof *value);
    qsort(t->value, n, sizeof *value, ascending);
    for (size_t i = 0; i < n; i++)
      if (t->n == 0 || t->value[i] != t->value[t->n - 1]) t->value[t->n++] = t->value[i];
    status = t->n > 0 ? fill(ctx, t, 0, t->n) : PENDRES_OK;
  }
  if (status == PENDRES_OK) *out = t;
  else pendres_rotation_table_free(t);
  return status;
}

void pendres_rotation_table_free(pendres_rotation_table *t)
{
  if (t == NULL) return;
  free(t->value);
  free(t->rotation);
  free(t);
}

void pendres_rotation_table_pass(pendres_bytes *b, pendres_rotation_table **table)
{
  pendres_rotation_table *t = *table;
  size_t n = t != NULL ? t->n + 1 : 0; /* a table may be empty */
  pendres_bytes_pass(b, 1, sizeof n, &n);
  if (b->status != PENDRES_OK || n == 0) return;
  if (b->reads) *table = t = calloc(1, sizeof *t);
  if (t == NULL) b->status = PENDRES_OUT_OF_MEMORY;
  if (t == NULL) return;
  t->n = n - 1;
  pendres_bytes_pass_array(b, t->n, sizeof *t->value, &t->value);
  pendres_bytes_pass_array(b, t->n, sizeof *t->rotation, &t->rotation);
}

const pendres_rotation *pendres_rotation_table_at(const pendres_rotation_table *t, double value)
{
  const double *at = bsearch(&value, t->value, t->n, sizeof *at, ascending);
  const pendres_rotation *r = at != NULL ? &t->rotation[at - t->value] : NULL;
  return r != NULL && r->period > 0.0 ? r : NULL;
}

/* ---- ends ---------------------------------------------------------------------------------- */

/* The damping at which the least torque is that of p, between one with a rotation and one
   without. */
static pendres_status limit_of_damping(const pendres_pendulum *p, double with, double without,
                                       pendres_rotation_limit *out)
{
  pendres_rotation_onset o = {.torque = NAN};
  double slope = NAN;
  for (int k = 0; k < ITERATIONS; k++) {
    const double middle = 0.5 * (with + without);
    if (middle == with || middle == without) break;
    const double before = o.torque, from = out->value;
    out->value = middle;
    if (pendres_rotation_onset_find(middle, &o) != PENDRES_OK) return PENDRES_NOT_FOUND;
    if (middle != from && o.torque != before) slope = (o.torque - before) / (middle - from);
    if (o.torque <= fabs(p->torque)) with = middle;
    else without = middle;
    if (fabs(o.torque - fabs(p->torque)) <= o.torque_error) break;
  }
  out->end = PENDRES_ROTATION_HOMOCLINIC;
  out->error = fabs(with - without) + 2.0 * o.torque_error / fabs(slope);
  return isfinite(out->error) ? PENDRES_OK : PENDRES_NOT_FOUND;
}

pendres_status pendres_rotation_limit_between(const pendres_pendulum *p,
                                              pendres_parameter parameter, double with,
                                              double without, pendres_rotation_limit *out)
{
  *out = (pendres_rotation_limit){.value = NAN, .error = NAN};
  if (parameter == PENDRES_DAMPING) return limit_of_damping(p, with, without, out);
  pendres_rotation_onset o;
  if (parameter != PENDRES_TORQUE) return PENDRES_NOT_FOUND;
  const pendres_status status = pendres_rotation_onset_find(p->damping, &o);
  if (status != PENDRES_OK) return status;
  *out = (pendres_rotation_limit){
    .value = copysign(o.torque, with), .error = o.torque_error, .end = o.end};
  return PENDRES_OK;
}

/* ---- which pendulums rotate ---------------------------------------------------------------- */

int pendres_rotation_may_be(const pendres_pendulum *p)
{
  return pendres_pendulum_rotates(p) && !pendres_model_driven(p);
}

/* How many upper equilibria lie behind a position, as the torque pushes. */
static double passed(const pendres_pendulum *p, double x)
{
  const double y = p->torque > 0.0 ? x - half_pi : half_pi - x;
  return floor((y - pi + asin(fabs(p->torque))) / two_pi);
}

pendres_status pendres_rotation_reached(pendres_context *ctx, const pendres_pendulum *p, double x,
                                        double v, pendres_rotation *out, int *reached)
{
  *reached = 0;
  if (!pendres_rotation_may_be(p) || pendres_rotation_find(p, out, NULL) != PENDRES_OK)
    return PENDRES_OK;
  *reached = fabs(p->torque) > 1.0;
  /* Without a drive any clock will do: this one ticks about once an oscillation. */
  pendres_pendulum q = *p;
  q.drive_frequency = 1.0;
  const long most = TABLE_WATCHED + (long)(TABLE_WATCHED / pendres_equation_shrinking(&q));
  for (long k = 0; k < most && !*reached; k++) {
    const double before = passed(p, x);
    const pendres_status status = pendres_strobe_advance(ctx, 1, &q, &x, &v, 1, NULL);
    if (status != PENDRES_OK) return status;
    *reached = passed(p, x) > before;
  }
  return PENDRES_OK;
}
