/* linear.c -- oscillators under a linear force; see linear.h. */
#include "orbits/linear.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"

/*
 * Two motions under a linear force differ by a solution of the equation without torque and drive,
 * whose multipliers are therefore those of every motion. They are taken from its state of rest.
 */
static pendres_orbit_guess at_rest(const pendres_pendulum *p)
{
  pendres_orbit_guess guess = {.pendulum = *p, .period = 1};
  guess.pendulum.torque = guess.pendulum.drive_amplitude = 0.0;
  return guess;
}

static void tell_fate(const pendres_orbit *o, pendres_linear *out)
{
  const double modulus = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  const double rate = o->pendulum.drive_frequency / two_pi;
  out->exponent = log(modulus) * rate;
  out->error = o->multiplier_error / modulus * rate;
  if (!isfinite(out->exponent) || !isfinite(out->error)) return;
  out->fate = out->exponent > out->error    ? PENDRES_LINEAR_GROWS
              : out->exponent < -out->error ? PENDRES_LINEAR_DECAYS
                                            : PENDRES_LINEAR_BETWEEN;
}

/* Take over what Newton's method has found: multipliers first, then orbits. */
static void take_over(const pendres_orbit *o, int multipliers, pendres_linear *out)
{
  if (multipliers) tell_fate(o, out);
  else out->orbit = *o;
}

/* Refine the rest states of all linear oscillators, or the orbits of those that decay. */
static pendres_status refine(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                             int multipliers, pendres_linear *out)
{
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_orbit_guess *guess = pendres_room_take(&room, n, sizeof *guess);
  pendres_orbit *orbit = pendres_room_take(&room, n, sizeof *orbit);
  pendres_status *outcome = pendres_room_take(&room, n, sizeof *outcome);
  pendres_linear **of = pendres_room_take(&room, n, sizeof *of);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    if (multipliers ? !pendres_model_is_linear(&p[i]) : out[i].fate != PENDRES_LINEAR_DECAYS)
      continue;
    of[count] = &out[i];
    guess[count] = multipliers ? at_rest(&p[i])
                               : (pendres_orbit_guess){.pendulum = p[i], .period = 1};
    count++;
  }
  const pendres_status status =
    pendres_orbit_find(ctx, count, guess, PENDRES_ORBIT_PLAIN, orbit, outcome);
  for (size_t k = 0; k < count && status == PENDRES_OK; k++)
    if (outcome[k] != PENDRES_NOT_CONVERGED) take_over(&orbit[k], multipliers, of[k]);
    else of[k]->fate = PENDRES_LINEAR_NOT;
  return pendres_room_close(&room, status);
}

pendres_status pendres_linear_find(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                   pendres_linear *out)
{
  int any = 0;
  for (size_t i = 0; i < n; i++) {
    out[i] = (pendres_linear){.fate = PENDRES_LINEAR_NOT, .exponent = NAN, .error = NAN};
    any |= pendres_model_is_linear(&p[i]);
  }
  if (!any) return PENDRES_OK;
  const pendres_status status = refine(ctx, n, p, 1, out);
  return status == PENDRES_OK ? refine(ctx, n, p, 0, out) : status;
}
