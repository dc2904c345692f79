/* small_end.c -- the fold at which SA ends along a line; see small_end.h. */
#include "orbits/small_end.h"

pendres_label_border pendres_small_end_from(const pendres_small_end *end,
                                            const pendres_pendulum *pendulum)
{
  const double past = pendres_parameter_get(end->parameter, pendulum) - end->value;
  return (pendres_label_border){.distinct = end->known,
                                .beyond = (end->falling ? -past : past) > 0.0,
                                .amplitude = end->amplitude};
}
