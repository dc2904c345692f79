/*
 * exact.h -- pi and half of it, for what is compared with pendulums in more than double precision.
 */
#ifndef VALIDATION_EXACT_H
#define VALIDATION_EXACT_H

#include <pendres/pendulum.h>

static const double pi = PENDRES_PI;
static const long double pi_exact = 3.14159265358979323846264338327950288L;
static const long double half_pi_exact = 1.57079632679489661923132169163975144L;

#endif
