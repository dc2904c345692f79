/* label.c -- what orbits are called; see label.h. */
#include "orbits/label.h"

#include <math.h>

#include "base/angles.h"
#include "model/model.h"
#include "orbits/numbers.h"
#include "orbits/orbit_same.h"

int pendres_label_named(const pendres_orbit *o)
{
  return o->period == 1 && o->winding == 0;
}

void pendres_label_note(pendres_label_states *s, const pendres_orbit *o)
{
  if (!o->stable || !pendres_label_named(o)) return;
  for (size_t i = 0; i < s->count; i++)
    if (fabs(s->amplitude[i] - o->amplitude) <=
        pendres_orbit_slack(s->error[i] + o->amplitude_error))
      return;
  if (s->count == PENDRES_LABEL_STATES) return;
  s->amplitude[s->count] = o->amplitude;
  s->error[s->count++] = o->amplitude_error;
}

size_t pendres_label_extreme(const pendres_label_states *s, int most)
{
  size_t best = 0;
  for (size_t i = 1; i < s->count; i++)
    if (most ? s->amplitude[i] > s->amplitude[best] : s->amplitude[i] < s->amplitude[best])
      best = i;
  return best;
}

/* The label of a state that is alone. */
static pendres_label lone(const pendres_label_border *b, const pendres_orbit *o)
{
  if (b == NULL) {
    if (pendres_model_kind(&o->pendulum) != PENDRES_MODEL_PLAIN) return PENDRES_LABEL_PERIODIC;
    if (!(fabs(o->pendulum.drive_amplitude) <= label_strongest_by_lag))
      return PENDRES_LABEL_PERIODIC;
    /* At rest there is no phase lag, and no amplitude. */
    return o->phase_lag >= pi / 3.0 ? PENDRES_LABEL_LA : PENDRES_LABEL_SA;
  }
  if (!b->distinct) return PENDRES_LABEL_PERIODIC;
  return !b->beyond && o->amplitude < b->amplitude ? PENDRES_LABEL_SA : PENDRES_LABEL_LA;
}

pendres_label pendres_label_of(const pendres_label_states *s, const pendres_label_border *border,
                               const pendres_orbit *o)
{
  if (o->winding != 0) return PENDRES_LABEL_RUNNING;
  if (!pendres_label_named(o)) return PENDRES_LABEL_PERIODIC;
  if (s->count < 2) return lone(border, o);
  const size_t least = pendres_label_extreme(s, 0);
  return o->amplitude <=
             s->amplitude[least] + pendres_orbit_slack(s->error[least] + o->amplitude_error)
           ? PENDRES_LABEL_SA
           : PENDRES_LABEL_LA;
}

pendres_label_border pendres_small_end_from(const pendres_small_end *end,
                                            const pendres_pendulum *pendulum)
{
  const double past = pendres_parameter_get(end->parameter, pendulum) - end->value;
  return (pendres_label_border){.distinct = end->known,
                                .beyond = (end->falling ? -past : past) > 0.0,
                                .amplitude = end->amplitude};
}
