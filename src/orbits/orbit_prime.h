/*
 * orbit_prime.h -- the prime period of orbits: the shortest after which they close.
 *
 * An orbit of period q closes after 2q periods, too, and Newton's method finds it with either. A
 * motion that approaches an orbit with a multiplier near -1 comes close to where it was two periods
 * ago well before it comes close to where it was one period ago.
 */
#ifndef PENDRES_ORBIT_PRIME_H
#define PENDRES_ORBIT_PRIME_H

#include <pendres/orbit.h>

/* Replace each of n stable orbits by the same orbit with its shortest period. */
pendres_status pendres_orbits_to_prime(pendres_context *ctx, size_t n, pendres_orbit *orbit);

#endif
