/* orbit_table.c -- the measures of orbits; see orbit_table.h. */
#include "orbits/orbit_table.h"

#include <math.h>

#include "base/angles.h"
#include "model/model.h"

static const double root_two = 1.41421356237309504880;

/* ---- their values -------------------------------------------------------------------------- */

static pendres_orbit_value amplitude(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     const pendres_orbit_measures *m)
{
  (void)p, (void)s;
  return (pendres_orbit_value){m->amplitude, 1.0, m->unresolved};
}

static pendres_orbit_value first_harmonic(const pendres_pendulum *p,
                                          const pendres_orbit_samples *s,
                                          const pendres_orbit_measures *m)
{
  (void)p, (void)s;
  return (pendres_orbit_value){hypot(m->cosine[0], m->sine[0]), 1.0, 0.0};
}

static pendres_orbit_value phase_lag(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     const pendres_orbit_measures *m)
{
  (void)s;
  return (pendres_orbit_value){
    pendres_orbit_phase_lag(m->cosine[0], m->sine[0], p->drive_amplitude),
    1.0 / hypot(m->cosine[0], m->sine[0]), 0.0};
}

static pendres_orbit_value loop_area(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                     const pendres_orbit_measures *m)
{
  (void)s;
  return (pendres_orbit_value){0.5 * two_pi * p->drive_amplitude * m->sine[0],
                               pi * fabs(p->drive_amplitude) * root_two, 0.0};
}

static pendres_orbit_value dissipation(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                       const pendres_orbit_measures *m)
{
  (void)s;
  return (pendres_orbit_value){
    p->damping * p->drive_frequency * two_pi * m->square_speed,
    2.0 * two_pi * p->damping * p->drive_frequency * sqrt(m->square_speed), 0.0};
}

static pendres_orbit_value torque_work(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                       const pendres_orbit_measures *m)
{
  (void)m;
  return (pendres_orbit_value){two_pi * p->torque * s->winding / s->period, 0.0, 0.0};
}

/* The parametric drive's force is -b cos theta f. */
static pendres_orbit_value parametric_work(const pendres_pendulum *p,
                                           const pendres_orbit_samples *s,
                                           const pendres_orbit_measures *m)
{
  double sum = 0.0, springs = 0.0, forces = 0.0;
  (void)m;
  if (p->parametric_amplitude == 0.0) return (pendres_orbit_value){0.0, 0.0, 0.0};
  for (size_t k = 0; k < s->n; k++) {
    double force, slope;
    pendres_model_force(p, s->y[k], &force, &slope);
    sum += cos(two_pi * s->period * (double)k / (double)s->n) * force * s->w[k];
    springs += slope * slope * s->w[k] * s->w[k];
    forces += force * force;
  }
  const double cycle = two_pi * fabs(p->parametric_amplitude), n = (double)s->n;
  return (pendres_orbit_value){-two_pi * p->parametric_amplitude * sum / n,
                               cycle * (sqrt(springs / n) + sqrt(forces / n)), 0.0};
}

/* ---- the table ----------------------------------------------------------------------------- */

#define EXACT(field) .name = #field, .value = offsetof(pendres_orbit, field), \
                     .error = PENDRES_ORBIT_EXACT
#define WITH_ERROR(field) .name = #field, .value = offsetof(pendres_orbit, field), \
                          .error = offsetof(pendres_orbit, field##_error)

static const pendres_orbit_row table[] = {
  {.measure = amplitude, .image = 1,
   .shown = {WITH_ERROR(amplitude), .principal = 1, .units = "rad",
             .long_name = "half peak to peak of the angle",
             .definition = "half peak to peak of the angle, in rad",
             .coordinate = "half peak to peak of x"}},
  {.measure = first_harmonic, .image = 1,
   .shown = {WITH_ERROR(first_harmonic_amplitude), .units = "rad",
             .long_name = "amplitude of the angle's first harmonic",
             .definition = "a in the part a cos(omega t - phase_lag) of the angle, in rad",
             .coordinate = "a in the part a cos(omega t - phase_lag) of x"}},
  {.measure = phase_lag, .image = 1, .angle = 1,
   .shown = {WITH_ERROR(phase_lag), .principal = 1, .units = "rad",
             .long_name = "lag of the first harmonic behind the drive",
             .definition = "phi in 0 to pi, in rad: the angle's first harmonic is "
                           "a cos(omega t - phi)",
             .coordinate = "phi in 0 to pi, in rad: the first harmonic of x is "
                           "a cos(omega t - phi)"}},
  {.measure = loop_area, .image = 1,
   .shown = {WITH_ERROR(loop_area), .principal = 1, .units = "1",
             .long_name = "area of the hysteresis loop, a drive cycle",
             .definition = "work of the drive a drive cycle, the closed integral of F dx, in m g l",
             .coordinate = "work of the drive a drive cycle, the closed integral of F dx"}},
  {.measure = dissipation, .image = 1,
   .shown = {WITH_ERROR(dissipation), .units = "1",
             .long_name = "energy dissipated a drive cycle",
             .definition = "gamma times the closed integral of v^2 dt a drive cycle, in m g l; on "
                           "a periodic orbit the same as loop_area",
             .coordinate = "gamma times the closed integral of v^2 dt a drive cycle"}},
  {.image = 1, /* loop area times a frequency */
   .shown = {WITH_ERROR(mean_power), .units = "1",
             .long_name = "mean power taken from the drive",
             .definition = "loop area times omega / (2 pi), in m g l omega0",
             .coordinate = "loop area times omega / (2 pi)"}},
  {.measure = torque_work,
   .shown = {EXACT(torque_work), .of_forces = 1, .units = "1",
             .long_name = "energy that the torque gives a drive cycle",
             .definition = "2 pi I p / q of the torque I and an orbit of p turns in q drive "
                           "periods, exactly"}},
  {.measure = parametric_work,
   .shown = {WITH_ERROR(parametric_work), .of_forces = 1, .units = "1",
             .long_name = "energy that the parametric drive gives a drive cycle",
             .definition = "-b times the closed integral of f(x) cos(omega t) dx, of the restoring "
                           "force f"}},
};
enum { ROWS = sizeof table / sizeof *table };
_Static_assert((int)ROWS <= (int)PENDRES_ORBIT_MEASURES,
               "orbit_measure.h has room for fewer measures");

pendres_status pendres_orbit_table_measure(const pendres_pendulum *p,
                                           const pendres_orbit_samples *s, double *work,
                                           pendres_orbit_measures *out)
{
  const pendres_status status = pendres_orbit_measure(p, s, work, out);
  for (size_t k = 0; k < ROWS && status == PENDRES_OK; k++)
    if (table[k].measure != NULL) out->of[k] = table[k].measure(p, s, out);
  return status;
}

const pendres_orbit_row *pendres_orbit_row_get(size_t number)
{
  return number < ROWS ? &table[number] : NULL;
}

const pendres_orbit_quantity *pendres_orbit_quantity_get(size_t number)
{
  return number < ROWS ? &table[number].shown : NULL;
}

double *pendres_orbit_row_value(const pendres_orbit_row *row, pendres_orbit *o)
{
  return (double *)(void *)((char *)o + row->shown.value);
}

double *pendres_orbit_row_error(const pendres_orbit_row *row, pendres_orbit *o)
{
  return row->shown.error == PENDRES_ORBIT_EXACT
           ? NULL : (double *)(void *)((char *)o + row->shown.error);
}

pendres_orbit pendres_orbit_none(const pendres_pendulum *p)
{
  pendres_orbit o = {.pendulum = *p};
  double *const numbers[] = {
    &o.x, &o.v, &o.x_error, &o.v_error, &o.multiplier_error, &o.mean_angle, &o.loop_area_slope,
    &o.loop_area_slope_error, &o.multiplier_re[0], &o.multiplier_re[1], &o.multiplier_im[0],
    &o.multiplier_im[1], &o.frequency_derivative[0], &o.frequency_derivative[1],
    &o.monodromy[0][0], &o.monodromy[0][1], &o.monodromy[1][0], &o.monodromy[1][1]};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) *numbers[i] = NAN;
  const pendres_orbit_row *row;
  for (size_t k = 0; (row = pendres_orbit_row_get(k)) != NULL; k++) {
    double *error = pendres_orbit_row_error(row, &o);
    *pendres_orbit_row_value(row, &o) = NAN;
    if (error != NULL) *error = NAN;
  }
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) o.cosine[m] = o.sine[m] = NAN;
  return o;
}
