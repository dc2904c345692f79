/* detached.c -- orbits that members may not come near; see line.h. */
#include "analysis/phase_diagram/line.h"

#include <math.h>

#include "analysis/phase_diagram/numbers.h"
#include "base/angles.h"
#include "engine/room.h"
#include "model/model.h"
#include "orbits/free_force.h"
#include "orbits/numbers.h"
#include "orbits/orbit_pair.h"

enum { GUESSES = DETACHED_POINTS * DETACHED_RESONANCES * DETACHED_PHASES };

/* The amplitudes at which free oscillations about the well have the drive's frequency; their
   number. */
static int resonances(const pendres_pendulum *p, double well, double amplitude[DETACHED_RESONANCES])
{
  const double square = p->drive_frequency * p->drive_frequency;
  double before = pendres_free_stiffness(p, well, well_near) - square;
  int n = 0;
  for (double a = well_near * detached_pace; a < WELL_FAR && n < DETACHED_RESONANCES;
       a *= detached_pace) {
    const double off = pendres_free_stiffness(p, well, a) - square;
    if (off * before <= 0.0 && off != before)
      amplitude[n++] = a * pow(detached_pace, -off / (off - before));
    before = off;
  }
  return n;
}

static size_t guess_at(const pendres_pendulum *p, pendres_orbit_guess *guess)
{
  double amplitude[DETACHED_RESONANCES], well;
  size_t n = 0;
  if (pendres_model_kind(p) == PENDRES_MODEL_PLAIN || !pendres_free_well(p, &well)) return 0;
  const int found = resonances(p, well, amplitude);
  for (int i = 0; i < found * DETACHED_PHASES; i++) {
    const double a = amplitude[i / DETACHED_PHASES];
    const double phase = two_pi * (i % DETACHED_PHASES) / DETACHED_PHASES;
    guess[n++] =
      (pendres_orbit_guess){.pendulum = *p, .period = 1,
                            .x = pendres_model_origin(p) + well + a * cos(phase),
                            .v = -a * p->drive_frequency * sin(phase)};
  }
  return n;
}

pendres_status pendres_phase_detached(pendres_context *ctx, size_t n, const pendres_response *r,
                                      pendres_room *room, pendres_orbit **out, size_t *count)
{
  const size_t points = n < DETACHED_POINTS ? n : DETACHED_POINTS;
  pendres_orbit_guess *guess = pendres_room_take(room, GUESSES, sizeof *guess);
  pendres_orbit *orbit = *out = pendres_room_take(room, GUESSES, sizeof *orbit);
  pendres_status *outcome = pendres_room_take(room, GUESSES, sizeof *outcome);
  size_t guesses = 0;
  *count = 0;
  if (room->status != PENDRES_OK) return room->status;
  for (size_t k = 0; k < points; k++)
    guesses += guess_at(&r[(2 * k + 1) * n / (2 * points)].pendulum, guess + guesses);
  const pendres_status status = pendres_orbit_find_once(ctx, guesses, guess, orbit, outcome);
  for (size_t i = 0; i < guesses && status == PENDRES_OK; i++)
    if (outcome[i] != PENDRES_NOT_CONVERGED && orbit[i].stable) orbit[(*count)++] = orbit[i];
  return status;
}
