/*
 * free.c -- the free pendulum by integration; see free.h.
 *
 * With the clock c a turn of the phase takes the time 2 pi / c, so the quarter period is
 * 2 pi / c where y(2 pi) = 0, and the frequency is then c / 4. There y'' = 0 too, so that
 * Newton's method in the time of the passage converges to third order.
 */
#include <pendres/free.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "base/numbers.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/tables.h"
#include "engine/door.h"
#include "engine/strobe_run.h"
#include "orbits/numbers.h"

enum { FIRST_STEPS = 16 };

typedef struct swing {
  double amplitude;
  pendres_pendulum pendulum; /* its drive_frequency is the clock */
  int steps, iterations;
  int have_coarse;
  double coarse;             /* the clock found with fewer steps, */
  int coarse_steps;          /* and with how many */
  double error;              /* of the clock, relative; NaN until it is done */
} swing;

/* The frequency within a per cent or so: eq. 1.2 of the paper, and near pi the asymptotic form of
   the elliptic integral (Abramowitz and Stegun 17.3.26). */
static double guess(double amplitude)
{
  pendres_free f;
  pendres_free_get(amplitude, &f);
  if (amplitude < 2.8) return f.belendez;
  return 0.5 * pi / log(4.0 / sin(0.5 * (pi - amplitude)));
}

/* How much larger the relative error of the time is than that of the start: near pi the time of
   the fall is that of leaving the top. */
static double amplification(const swing *s)
{
  const double quarter = two_pi / s->pendulum.drive_frequency;
  return 1.0 + s->amplitude / ((pi - s->amplitude) * quarter);
}

/* The clock's relative error by rounding: half a unit in the last place of each step, at random. */
static double rounding(const swing *s)
{
  return 0.5 * last_place_of_one * sqrt((double)s->steps) * amplification(s) +
         DBL_TRUE_MIN / s->amplitude;
}

static int one_period(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  (void)arg, (void)index;
  return lane->period >= 1;
}

/* The clock has converged with the present steps: tell its error, or ask for more steps. */
static void judge(const pendres_context *ctx, swing *s)
{
  const double order = pendres_tables_order(ctx->options.table);
  const double floor = rounding(s), clock = s->pendulum.drive_frequency;
  double wanted = 2.0 * s->steps;
  if (!pendres_method_of(ctx)->fixed_steps) {
    s->error = floor; /* find_adaptively() adds what the method leaves */
    return;
  }
  if (s->have_coarse) {
    const double ratio = (double)s->steps / s->coarse_steps;
    const double difference = fabs(clock - s->coarse) / clock;
    /* The order says 1 / (ratio^order - 1); never less than a tenth is claimed. */
    const double part = fmax(0.1, 1.5 / (pow(ratio, order) - 1.0)) * difference;
    const int asked = ctx->options.steps_per_period > 0;
    if (part + floor <= ctx->options.tolerance || part <= floor || asked ||
        s->steps >= PENDRES_MOST_STEPS) {
      s->error = part + floor;
      return;
    }
    const double growth = pow(part / ctx->options.tolerance, 1.0 / order) * 1.1;
    wanted = s->steps * fmin(4.0, fmax(finer_steps, growth));
  }
  s->have_coarse = 1;
  s->coarse = clock;
  s->coarse_steps = s->steps;
  s->steps = (int)fmin(ceil(wanted), PENDRES_MOST_STEPS);
  s->iterations = 0;
}

/* One correction of the clock from the state after a turn; 0 if that leads nowhere. */
static int correct(const pendres_context *ctx, swing *s, const pendres_strobe_lane *lane)
{
  /* y + w 2 pi (time / turn) = 0 gives the clock's relative change. */
  double change = lane->y / (two_pi * lane->w);
  if (!isfinite(change) || s->iterations++ > NEWTON_STEPS) return 0;
  change = fmax(-0.3, fmin(0.3, change));
  s->pendulum.drive_frequency *= 1.0 + change;
  if (fabs(change) < fmax(newton_last_step, rounding(s))) judge(ctx, s);
  return 1;
}

/* All swings, and what turning them needs. */
typedef struct swings {
  size_t n, left;            /* how many are not done */
  swing *one;
  pendres_strobe_lane *lane; /* [n] */
  size_t *which;             /* [n]: the swing of each lane */
} swings;

/* Turn all swings that are not done by one turn of the phase. */
static pendres_status turn(pendres_context *ctx, double tolerance, swings *s)
{
  size_t active = 0;
  for (size_t i = 0; i < s->n; i++) {
    const swing *one = &s->one[i];
    if (!isnan(one->error)) continue;
    s->which[active] = i;
    s->lane[active++] = (pendres_strobe_lane){.pendulum = &one->pendulum, .y = one->amplitude,
                                              .steps = one->steps};
  }
  const pendres_status status =
    pendres_strobe_run_within(ctx, tolerance, active, s->lane, one_period, NULL);
  if (status != PENDRES_OK) return status;
  ctx->cost.newton_steps += (double)active;
  s->left = 0;
  for (size_t k = 0; k < active; k++) {
    swing *one = &s->one[s->which[k]];
    if (!correct(ctx, one, &s->lane[k]))
      return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED,
                                  "the period of the free pendulum at amplitude %.17g was not "
                                  "found within %d iterations", one->amplitude, NEWTON_STEPS);
    s->left += isnan(one->error);
  }
  return PENDRES_OK;
}

/* Find the clocks of all swings, from what they are now. */
static pendres_status settle_clocks(pendres_context *ctx, double tolerance, swings *s)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < s->n; i++) {
    s->one[i].error = NAN;
    s->one[i].iterations = 0;
  }
  for (s->left = s->n; s->left > 0 && status == PENDRES_OK;) status = turn(ctx, tolerance, s);
  return status;
}

/*
 * Methods that choose their own steps: a run with a far smaller tolerance is the result, and the
 * error is that of the run as asked for, which is larger.
 */
static pendres_status find_adaptively(pendres_context *ctx, swings *s)
{
  const double better = pendres_accuracy_far_better(ctx);
  pendres_status status = settle_clocks(ctx, ctx->options.tolerance, s);
  for (size_t i = 0; i < s->n; i++) s->one[i].coarse = s->one[i].pendulum.drive_frequency;
  if (status == PENDRES_OK) status = settle_clocks(ctx, better, s);
  for (size_t i = 0; i < s->n && status == PENDRES_OK; i++) {
    swing *one = &s->one[i];
    /* The tolerance is one of each step, relative to one radian; a quarter of a period is made
       of some tens of them. */
    one->error = fabs(one->pendulum.drive_frequency - one->coarse) / one->coarse +
                 (amplification(one) + 1.0 / one->amplitude) * 20.0 * better + rounding(one);
  }
  return status;
}

static pendres_status find_all(pendres_context *ctx, size_t n, const double *amplitude,
                               double *frequency, double *error)
{
  const int asked = (ctx->options.steps_per_period + 3) / 4;
  pendres_room room = pendres_room_open(ctx, "amplitudes");
  swings s = {.n = n, .one = pendres_room_take(&room, n, sizeof *s.one),
              .lane = pendres_room_take(&room, n, sizeof *s.lane),
              .which = pendres_room_take(&room, n, sizeof *s.which)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++)
    s.one[i] = (swing){ .amplitude = amplitude[i], .steps = asked > 0 ? asked : FIRST_STEPS,
                        .pendulum.drive_frequency = 4.0 * guess(amplitude[i]), .error = NAN };
  const pendres_status status = pendres_method_of(ctx)->fixed_steps
                                  ? settle_clocks(ctx, ctx->options.tolerance, &s)
                                  : find_adaptively(ctx, &s);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    frequency[i] = 0.25 * s.one[i].pendulum.drive_frequency;
    error[i] = s.one[i].error * frequency[i];
  }
  return pendres_room_close(&room, status);
}

static pendres_status free_frequency_integrate(pendres_context *ctx, size_t n,
                                               const double *amplitude, double *frequency,
                                               double *error)
{
  if (n > 0 && (amplitude == NULL || frequency == NULL || error == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "amplitude, frequency and error");
  for (size_t i = 0; i < n; i++)
    if (!(amplitude[i] > 0.0 && amplitude[i] < pi))
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                  "amplitude %zu is %g: it must lie between 0 and pi", i,
                                  amplitude[i]);
  if (n == 0) return PENDRES_OK;
  return find_all(ctx, n, amplitude, frequency, error);
}

pendres_status pendres_free_find(pendres_context *ctx, size_t n,
                                 const double *amplitude, double *frequency,
                                 double *error)
{
  pendres_door d = pendres_door_open(ctx, NULL);
  return PENDRES_DOOR_END(&d, free_frequency_integrate(ctx, n, amplitude, frequency, error));
}
