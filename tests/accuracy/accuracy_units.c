/*
 * accuracy_units.c -- the same oscillators in units of a millionth to a million; see accuracy.h.
 *
 * The library is asked in units that are no powers of two, whatever those make of its numbers; the
 * reference gets its answer, and the rounded parameters, in the powers of two next to them. What is
 * compared is then the same problem to the last digit, at a scale where the reference is at home.
 */
#include "accuracy.h"

#include <math.h>

accuracy_units accuracy_draw_units(accuracy_random *r)
{
  accuracy_units u;
  u.length = accuracy_logarithmic(r, 1e-6, 1e6);
  u.time = accuracy_logarithmic(r, 1e-6, 1e6);
  return u;
}

pendres_pendulum accuracy_in_units(const pendres_pendulum *p, accuracy_units u)
{
  const double length = 1.0 / u.length, rate = u.time, force = length * rate * rate;
  pendres_pendulum out = *p;
  out.damping *= rate;
  out.drive_frequency *= rate;
  out.drive_amplitude *= force;
  out.torque *= force;
  out.temperature *= length * length * rate * rate;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) {
    out.force_coefficients[k] *= rate * rate;
    for (int j = 0; j < k; j++) out.force_coefficients[k] *= u.length;
  }
  return out;
}

accuracy_units accuracy_near_units(accuracy_units u)
{
  return (accuracy_units){exp2(rint(log2(u.length))), exp2(rint(log2(u.time)))};
}

pendres_orbit accuracy_out_of_units(const pendres_orbit *o, accuracy_units u)
{
  const double length = u.length, speed = length / u.time, energy = speed * speed;
  pendres_orbit out = *o;
  out.pendulum = accuracy_in_units(&o->pendulum, (accuracy_units){1.0 / length, 1.0 / u.time});
  out.x *= length;
  out.x_error *= length;
  out.v *= speed;
  out.v_error *= speed;
  out.loop_area *= energy;
  out.loop_area_error *= energy;
  out.dissipation *= energy;
  out.dissipation_error *= energy;
  out.mean_power *= energy / u.time;
  out.mean_power_error *= energy / u.time;
  out.amplitude *= length;
  out.amplitude_error *= length;
  out.first_harmonic_amplitude *= length;
  out.first_harmonic_amplitude_error *= length;
  out.loop_area_slope *= energy * u.time;
  out.loop_area_slope_error *= energy * u.time;
  return out;
}
