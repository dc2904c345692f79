/*
 * continuation_parameter.h -- a parameter of a pendulum by its number, and the length that counts as
 * one in it.
 */
#ifndef PENDRES_CONTINUATION_PARAMETER_H
#define PENDRES_CONTINUATION_PARAMETER_H

#include <pendres/continuation.h>

/* The value of a parameter; NULL beyond the list. */
double *pendres_parameter_of(pendres_pendulum *p, pendres_parameter parameter);
double pendres_parameter_value(const pendres_pendulum *p, pendres_parameter parameter);

/* Lengths that count as one in arclength. */
double pendres_parameter_scale(pendres_parameter parameter);

#endif
