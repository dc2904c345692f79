/*
 * parameter.h -- internal functions for parameters, beside <pendres/parameter.h>.
 */
#ifndef PENDRES_MODEL_PARAMETER_H
#define PENDRES_MODEL_PARAMETER_H

#include <pendres/parameter.h>

#include <stddef.h>

/* What parameters are fields of: a pendulum and its start. */
typedef struct pendres_parameter_record {
  pendres_pendulum pendulum;
  pendres_state state;
} pendres_parameter_record;

/* Set a parameter, the start's included; nothing happens if it does not exist. */
void pendres_parameter_put(pendres_parameter parameter, double value,
                           pendres_parameter_record *record);

/* The position of a parameter in that record: two with the same position are one quantity. */
size_t pendres_parameter_place(pendres_parameter parameter);

/* The pendulum with another value of a parameter. */
pendres_pendulum pendres_parameter_with(const pendres_pendulum *p, pendres_parameter parameter,
                                        double value);

/* Why orbits under this force cannot be followed in a parameter, a static sentence; NULL if they
   can. */
const char *pendres_parameter_refuses(pendres_parameter parameter, pendres_force force);

#endif
