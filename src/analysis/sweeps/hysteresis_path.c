/* hysteresis_path.c -- a pendulum on its way along a path; see hysteresis_path.h. */
#include "analysis/sweeps/hysteresis_path.h"

#include <math.h>

#include "analysis/sweeps/numbers.h"
#include "base/grow.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"

pendres_pendulum pendres_path_pendulum(const pendres_path *w, double value)
{
  return pendres_parameter_with(&w->pendulum, w->parameter, value);
}

int pendres_path_direction(const pendres_path *w, size_t i)
{
  const double from = i > 0 ? w->value[i - 1] : w->at;
  return w->value[i] >= from ? 1 : -1;
}

int pendres_path_longest(const pendres_path *w)
{
  return w->states_only ? SWEEP_STATES_PERIOD : PENDRES_HYSTERESIS_PERIOD;
}

void pendres_path_put(pendres_path *w, size_t i, const pendres_attractor *a)
{
  pendres_hysteresis_point *p = &w->h->point[i];
  const double omega = pendres_path_pendulum(w, w->value[i]).drive_frequency;
  const int closed = pendres_attractor_closes(a);
  *p = (pendres_hysteresis_point){.value = w->value[i], .attractor = *a};
  p->x = closed ? a->orbit.x : w->state.x;
  p->v = closed ? a->orbit.v : w->state.v;
  p->certain = w->certain && a->label != PENDRES_LABEL_UNRESOLVED;
  w->h->part[i] = w->h->parts;
  if (closed) {
    const double turns = (double)a->orbit.winding / a->orbit.period;
    p->mean_velocity = omega * turns;
    p->mean_velocity_error = last_place_of_one * fabs(p->mean_velocity);
  } else {
    p->mean_velocity = omega * a->drift;
    p->mean_velocity_error = omega * a->drift_error;
  }
}

pendres_hysteresis_point pendres_path_nothing(const pendres_path *w, double value)
{
  const pendres_pendulum p = pendres_path_pendulum(w, value);
  return (pendres_hysteresis_point){
    .value = value, .attractor = pendres_arrival_nothing(&p), .x = NAN, .v = NAN,
    .mean_velocity = NAN, .mean_velocity_error = NAN};
}

void pendres_path_leave(pendres_path *w)
{
  pendres_part_free(&w->part);
  w->h->parts++;
}

pendres_status pendres_path_note(pendres_path *w, const pendres_jump *j)
{
  pendres_hysteresis *h = w->h;
  if (w->states_only) return PENDRES_OK;
  if (h->jumps == h->jump_room) {
    const size_t room = 2 * h->jump_room + 8;
    if (!pendres_regrow(&h->jump, room, sizeof *h->jump) ||
        !pendres_regrow(&h->jump_from, room, sizeof *h->jump_from) ||
        !pendres_regrow(&h->jump_to, room, sizeof *h->jump_to))
      return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for jumps");
    h->jump_room = room;
  }
  h->jump[h->jumps] = *j;
  h->jump[h->jumps].to_winding = j->to_period > 0 ? w->state.attractor.orbit.winding : 0;
  h->jump[h->jumps].share_error = sqrt(j->share * (1.0 - j->share) / PENDRES_HYSTERESIS_TRIALS);
  h->jump_from[h->jumps] = h->parts;
  h->jump_to[h->jumps++] = h->parts + 1;
  return PENDRES_OK;
}
