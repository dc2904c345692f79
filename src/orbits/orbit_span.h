/*
 * orbit_span.h -- how far a motion reaches to both sides, by its states alone.
 *
 * Owns: where it turns back between two of them; the amplitudes of orbits that need be told apart
 * but not measured.
 */
#ifndef PENDRES_ORBIT_SPAN_H
#define PENDRES_ORBIT_SPAN_H

#include <pendres/orbit.h>

/*
 * The angle where a motion turns back between two states, `spacing` of drive phase apart, of
 * opposite velocities: that of the cubic which has both angles and both velocities.
 */
double pendres_turning_angle(double spacing, double y0, double w0, double y1, double w1);

/* Set the amplitudes of n orbits of which points are known: to a thousandth, at a tenth of the cost
   of measures. */
pendres_status pendres_orbits_span(pendres_context *ctx, size_t n, pendres_orbit *orbit);

#endif
