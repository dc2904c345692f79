/* escape.c -- pendulums on their way to infinity; see escape.h. */
#include "settling/trapping/escape.h"

#include <math.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/block.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"
#include "settling/trapping/numbers.h"

int pendres_escape_possible(const pendres_pendulum *p)
{
  return !(pendres_model_of(p->force)->period > 0.0);
}

int pendres_escape_lost(double y, double w)
{
  return !(fabs(y) < escape_lost_beyond && fabs(w) < escape_lost_beyond);
}

/* ---- springs that a parametric drive makes grow ---------------------------------------------- */

/*
 * z' = A(theta) z + (0, g), where A is the spring's and |g| has a bound G, takes a strobe point z
 * to M z + r. With l M = mu l, u = l z becomes mu u + l r, and |l r| <= R = G times the integral of
 * |h_w|, where h obeys the adjoint equation and is l at the period's end. Where
 * |u| (|mu| - 1) > R, |u| grows from strobe to strobe, geometrically in the end. There is such a mu
 * only if both multipliers are real: their product is below 1.
 */
typedef struct spring_period {
  size_t steps;
  double *m; /* the derivative by the start after each step: of y by y and by w */
  double end[2][2];
} spring_period;

static void take_step(void *arg, int step, const pendres_rows *rows)
{
  spring_period *s = arg;
  double *m = &s->m[2 * (size_t)(step - 1)];
  pendres_rows_tangent(rows, 0, s->end);
  m[0] = s->end[0][0];
  m[1] = s->end[0][1];
}

/* The bound on what drives, torque and the rest of the force do, in units of w a radian. */
static double most_beside(const pendres_pendulum *p)
{
  const double turned = 1.0 + fabs(p->parametric_amplitude);
  return (turned * pendres_model_of(p->force)->beside + fabs(p->torque) +
          fabs(p->drive_amplitude)) / (p->drive_frequency * p->drive_frequency);
}

static pendres_escape_beside beside_of(const pendres_pendulum *p, const spring_period *s)
{
  const double (*m)[2] = s->end, spacing = two_pi / (double)s->steps;
  const double loss = pendres_equation_contraction(p) / p->drive_frequency;
  const double half = 0.5 * (m[0][0] + m[1][1]);
  const double root = half * half - exp(-two_pi * loss);
  const double mu = half + copysign(sqrt(fmax(0.0, root)), half);
  if (!(root > 0.0 && fabs(mu) - 1.0 > escape_grows)) return (pendres_escape_beside){0.0, 0.0};
  /* l (M - mu) = 0: the larger of both rows of the other matrix that M - mu gives. */
  const double a = m[0][0] - mu, b = m[0][1], c = m[1][0], d = m[1][1] - mu;
  const int first = hypot(c, a) > hypot(d, b);
  const double l[2] = {first ? -c : -d, first ? a : b};
  double most = fabs(mu * l[1]); /* at the beginning */
  for (size_t k = 0; k < s->steps; k++) {
    const double *by = &s->m[2 * k], determinant = exp(-loss * spacing * (double)(k + 1));
    most += fabs(mu * (l[1] * by[0] - l[0] * by[1])) / determinant;
  }
  const double beyond = escape_spare * most_beside(p) * spacing * most / (fabs(mu) - 1.0);
  if (!(beyond > 0.0 && isfinite(beyond))) return (pendres_escape_beside){0.0, 0.0};
  return (pendres_escape_beside){l[0] / beyond, l[1] / beyond};
}

pendres_status pendres_escape_beside_find(pendres_context *ctx, const pendres_pendulum *p,
                                          pendres_escape_beside *out)
{
  pendres_pendulum spring = *p;
  pendres_block *block;
  int steps = 0;
  *out = (pendres_escape_beside){0.0, 0.0};
  if (!(pendres_model_of(p->force)->beside > 0.0) || p->parametric_amplitude == 0.0 ||
      pendres_equation_drags(p))
    return PENDRES_OK;
  spring.force = PENDRES_FORCE_POLYNOMIAL;
  spring.torque = spring.drive_amplitude = 0.0;
  pendres_status status = pendres_steps_choose(ctx, &spring, 1.0, pendres_accuracy_to_follow(ctx),
                                               &steps);
  if (status == PENDRES_OK)
    status = pendres_block_open(ctx, PENDRES_FLOW_VARIATIONAL, steps, &block);
  if (status != PENDRES_OK) return status;
  pendres_room room = pendres_room_open(ctx, "steps");
  spring_period s = {.steps = (size_t)steps,
                     .m = pendres_room_take(&room, 2 * (size_t)steps, sizeof *s.m)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  pendres_block_resize(block, 1);
  pendres_block_load(block, 0, &spring, 0.0, 0.0);
  status = pendres_block_period_sampled(block, take_step, &s);
  if (status == PENDRES_OK) *out = beside_of(p, &s);
  return pendres_room_close(&room, status);
}

int pendres_escape_certain(const pendres_pendulum *p, const pendres_escape_beside *beside, double y,
                           double w)
{
  return pendres_model_escapes(p, y, w) || fabs(beside->by_y * y + beside->by_w * w) > 1.0;
}

/* ---- within a period ------------------------------------------------------------------------- */

typedef struct last_period {
  const pendres_pendulum *pendulum;
  int escapes, lost;
} last_period;

static void watch_escape(void *arg, int step, const pendres_rows *rows)
{
  last_period *p = arg;
  const double y = pendres_rows_get(rows, PENDRES_ROW_Y, 0);
  const double w = pendres_rows_get(rows, PENDRES_ROW_W, 0);
  (void)step;
  p->lost |= pendres_escape_lost(y, w);
  p->escapes |= isnan(y) && pendres_model_bounded(p->pendulum);
  if (!p->lost) p->escapes |= pendres_model_escapes(p->pendulum, y, w);
}

pendres_status pendres_escape_within(pendres_context *ctx, const pendres_strobe_lane *lane,
                                     double y, double w, int *away)
{
  last_period p = {.pendulum = lane->pendulum};
  pendres_block *block;
  *away = 0;
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, lane->steps, &block);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(block, 1);
  pendres_block_load(block, 0, lane->pendulum, y, w);
  status = pendres_block_period_sampled(block, watch_escape, &p);
  *away = status == PENDRES_OK && p.escapes;
  return status;
}
