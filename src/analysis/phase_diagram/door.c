/* door.c -- lines of a phase diagram behind the door; see door.h. */
#include "analysis/phase_diagram/door.h"

pendres_door pendres_phase_open(pendres_context *ctx, const pendres_phase_options *o, size_t n,
                                const pendres_pendulum *first, const pendres_pendulum *last)
{
  if (n == 0 || o == NULL || first == NULL || (unsigned)o->parameter >= PENDRES_PARAMETER_FOLLOWED)
    return pendres_door_open(ctx, NULL);
  const double ends[2] = {pendres_parameter_get(o->parameter, first),
                          pendres_parameter_get(o->parameter, last)};
  return pendres_door_open_along(ctx, first, o->parameter, 2, ends);
}

const pendres_phase_options *pendres_phase_options_inside(const pendres_door *d,
                                                          const pendres_phase_options *options,
                                                          pendres_phase_options *inside)
{
  if (options == NULL || !pendres_door_changes(d)) return options;
  *inside = *options;
  pendres_units_in(&d->scales, &pendres_dim_ensemble, 1, &inside->ensemble);
  return inside;
}
