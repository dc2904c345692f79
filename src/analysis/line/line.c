/* line.c -- scattering parameters of a motion; see line.h. */
#include "analysis/line/line.h"

#include <math.h>

#include "base/angles.h"

void pendres_line_measure(const pendres_line *l, const pendres_line_motion *m,
                          pendres_line_value *out)
{
  const double complex cable =
    cexp(I * (l->angle - two_pi * l->delay * m->from_middle)), b = l->amplitude * cable;
  const double complex moved = m->in_phase - I * m->quadrature;
  const int passes = l->kind == PENDRES_LINE_TRANSMISSION;
  const double times = l->kind == PENDRES_LINE_REFLECTION ? 2.0 : 1.0, slant = tan(l->phase);
  const double complex per_rate = passes ? 0.0 : -times * (1.0 + I * slant);
  const double complex gain = passes ? m->damping : l->coupling * per_rate;
  const double complex far = passes ? l->leak[0] + I * l->leak[1] : 1.0;
  const double complex velocity = I * m->omega * moved / m->drive; /* over the drive */
  const double complex s = far + gain * velocity;
  out->s = b * s;
  out->by_in_phase = b * gain * I * m->omega / m->drive;
  out->by_quadrature = -I * out->by_in_phase;
  out->by_drive = -b * gain * velocity / m->drive;
  out->by_omega = b * gain * I * moved / m->drive;
  out->by_damping = passes ? b * velocity : 0.0;
  out->by_coupling = b * per_rate * velocity;
  out->by_phase = passes ? 0.0 : -b * times * l->coupling * I * (1.0 + slant * slant) * velocity;
  out->by_delay = -two_pi * I * m->from_middle * out->s;
  out->by_from_middle = -two_pi * I * l->delay * out->s;
  out->by_amplitude = cable * s;
  out->by_angle = I * out->s;
  out->by_leak[0] = passes ? b : 0.0;
  out->by_leak[1] = passes ? I * b : 0.0;
}
