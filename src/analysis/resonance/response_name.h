/*
 * response_name.h -- names of states that are alone, from their neighbours along a parameter.
 */
#ifndef PENDRES_RESPONSE_NAME_H
#define PENDRES_RESPONSE_NAME_H

#include <pendres/response.h>

#include "orbits/label.h"

/* Whether a response has a state that could have a name and has none. */
int pendres_response_nameless(const pendres_response *response);

/* The fold at which SA ends, from the n responses of a line at which it coexists with LA; not
   known if they show none. */
pendres_status pendres_response_small_end(pendres_context *ctx, size_t n,
                                          const pendres_response *const *line,
                                          pendres_parameter parameter, pendres_small_end *end);

/* Name the state that is alone, and bring shares up to date. */
void pendres_response_name_by(const pendres_small_end *end, pendres_response *response);

#endif
