/*
 * orbit_prime.h -- the prime period of orbits: the shortest after which they close.
 *
 * An orbit of period q closes after 2q periods, too, and Newton's method finds it under either. A
 * motion that comes in along a multiplier near -1 is next to where it was two periods ago well
 * before it is next to where it was one period ago.
 */
#ifndef PENDRES_ORBIT_PRIME_H
#define PENDRES_ORBIT_PRIME_H

#include <pendres/orbit.h>

/* From an orbit's Poincaré point to another one, whole turns not being told apart. */
double pendres_orbit_apart(const pendres_orbit *o, double x, double v);

/* Put n stable orbits that close earlier than their periods say into the shortest of these. */
pendres_status pendres_orbits_to_prime(pendres_context *ctx, size_t n, pendres_orbit *orbit);

#endif
