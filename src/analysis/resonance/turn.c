/* turn.c -- the damping of the largest resonance frequency; see resonance.h. */
#include <pendres/resonance.h>

#include <math.h>

#include "analysis/resonance/numbers.h"
#include "engine/context_internal.h"
#include "engine/door.h"

/* What is asked for. */
typedef struct request {
  const pendres_pendulum *near;
  double lowest, highest;
  const pendres_ensemble *ensemble;
} request;

/* Three resonances, evenly spaced. */
typedef struct triple {
  double damping[3], frequency[3], error[3];
} triple;

/* A parabola's vertex, and its second divided difference: half the second derivative. */
typedef struct parabola {
  double at, top, bend;
} parabola;

/* Find the parabola through three points; returns 0 if it does not open downwards. */
static int through(const double x[3], const double y[3], parabola *p)
{
  const double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
  p->bend = (right - left) / (x[2] - x[0]);
  if (!(p->bend < 0.0)) return 0;
  p->at = 0.5 * (x[0] + x[1]) - left / (2.0 * p->bend);
  p->top = y[1] + (p->at - x[1]) * (left + p->bend * (p->at - x[0]));
  return 1;
}

static pendres_status no_turn(pendres_context *ctx, double damping)
{
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                              "near damping %g the resonance frequency has no largest value that "
                              "is smooth", damping);
}

static pendres_status compute(pendres_context *ctx, const request *q, double middle,
                              double spacing, triple *t)
{
  for (int k = 0; k < 3; k++) {
    pendres_resonance r;
    pendres_pendulum p = *q->near;
    p.damping = t->damping[k] = middle + (k - 1) * spacing;
    const pendres_status status =
      pendres_resonance_find_ensemble(ctx, &p, q->lowest, q->highest, q->ensemble, &r);
    if (status != PENDRES_OK) return status;
    if (r.peak != PENDRES_PEAK_SMOOTH) return no_turn(ctx, p.damping);
    t->frequency[k] = r.frequency;
    t->error[k] = r.frequency_error;
  }
  return PENDRES_OK;
}

/* How far the errors of the resonances may move the vertex. */
static double moved(const triple *t, const parabola *p)
{
  double sum = 0.0;
  for (int k = 0; k < 3; k++) {
    double y[3] = {t->frequency[0], t->frequency[1], t->frequency[2]};
    parabola other;
    y[k] += t->error[k];
    sum += through(t->damping, y, &other) ? fabs(other.at - p->at) : INFINITY;
  }
  return sum;
}

/*
 * An upper estimate of the cubic term that parabolas lack, a sixth of the third derivative: the
 * third divided difference of the fine triple and the farther end of the coarse one.
 */
static double cubic_term(const triple *coarse, const triple *fine)
{
  const int end = fabs(coarse->damping[0] - fine->damping[1]) >
                      fabs(coarse->damping[2] - fine->damping[1]) ? 0 : 2;
  double x[4] = {coarse->damping[end]}, y[4] = {coarse->frequency[end]};
  double error[4] = {coarse->error[end]}, sum = 0.0, noise = 0.0;
  for (int k = 0; k < 3; k++) {
    x[k + 1] = fine->damping[k];
    y[k + 1] = fine->frequency[k];
    error[k + 1] = fine->error[k];
  }
  for (int i = 0; i < 4; i++) {
    double product = 1.0;
    for (int k = 0; k < 4; k++)
      if (k != i) product *= x[i] - x[k];
    sum += (y[i] - y[1]) / product;
    noise += error[i] / fabs(product);
  }
  return fabs(sum) + noise;
}

/*
 * With a cubic term c beside the bend b, a parabola through points at -h, 0 and h has its vertex at
 * d where the true one is off by c (3 d^2 - h^2) / 2b, and its value by c d (d^2 - h^2).
 */
static void conclude(const triple *coarse, const triple *fine, const parabola *p,
                     pendres_resonance_turn *out)
{
  const double c = cubic_term(coarse, fine), d = fabs(p->at - fine->damping[1]);
  const double h = fine->damping[2] - fine->damping[1];
  out->damping = p->at;
  out->damping_error = c * (3.0 * d * d + h * h) / fabs(2.0 * p->bend) + moved(fine, p);
  out->frequency = p->top;
  out->frequency_error =
    c * d * (d * d + h * h) + fmax(fine->error[0], fmax(fine->error[1], fine->error[2]));
}

static pendres_status find(pendres_context *ctx, const request *q, pendres_resonance_turn *out)
{
  double middle = q->near->damping, spacing = NAN;
  triple coarse, fine;
  parabola p = {.at = NAN};
  for (int trial = 0; !(fabs(p.at - middle) <= spacing); trial++) {
    if (trial > 0) middle = p.at;
    if (trial == TURN_TRIALS || !(middle > 0.0)) return no_turn(ctx, q->near->damping);
    spacing = fmin(turn_first_spacing, 0.1 * middle);
    const pendres_status status = compute(ctx, q, middle, spacing, &coarse);
    if (status != PENDRES_OK) return status;
    if (!through(coarse.damping, coarse.frequency, &p)) return no_turn(ctx, middle);
  }
  const double at = p.at;
  const pendres_status status = compute(ctx, q, at, fmin(turn_last_spacing, 0.025 * at), &fine);
  if (status != PENDRES_OK) return status;
  if (!through(fine.damping, fine.frequency, &p)) return no_turn(ctx, at);
  conclude(&coarse, &fine, &p, out);
  return PENDRES_OK;
}

static pendres_status turn_find(pendres_context *ctx, const request *q,
                                pendres_resonance_turn *out)
{
  if (q->near == NULL || q->ensemble == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "near, ensemble and out");
  *out = (pendres_resonance_turn){NAN, NAN, NAN, NAN};
  if (!(q->near->damping > 0.0 && isfinite(q->near->damping)))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the damping must be positive");
  const pendres_status status = find(ctx, q, out);
  if (status != PENDRES_OK) *out = (pendres_resonance_turn){NAN, NAN, NAN, NAN};
  return status;
}

pendres_status pendres_resonance_turn_find(pendres_context *ctx, const pendres_pendulum *near,
                                           double lowest, double highest,
                                           const pendres_ensemble *ensemble,
                                           pendres_resonance_turn *out)
{
  pendres_door d = pendres_door_open(ctx, near);
  const double unit = pendres_units_factor(&d.scales, 0, -1);
  const request q = {.near = pendres_door_in(&d, &pendres_dim_pendulum, 1, near),
                     .lowest = lowest / unit, .highest = highest / unit,
                     .ensemble = pendres_door_in(&d, &pendres_dim_ensemble, 1, ensemble)};
  PENDRES_DOOR_OUT(&d, turn, 1, out);
  return PENDRES_DOOR_END(&d, turn_find(ctx, &q, out));
}
