/* small_end.c -- the fold at which SA ends along a line; see small_end.h. */
#include "questions/small_end.h"

pendres_label_border pendres_small_end_from(const pendres_small_end *end,
                                            const pendres_pendulum *pendulum)
{
  return (pendres_label_border){
    .distinct = end->known,
    .beyond = pendres_parameter_get(end->parameter, pendulum) > end->value,
    .amplitude = end->amplitude};
}
