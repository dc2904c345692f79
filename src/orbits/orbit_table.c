/* orbit_table.c -- the measures of orbits; see orbit_table.h. */
#include "orbits/orbit_table.h"

#include <math.h>

#include "base/angles.h"
#include "model/equation.h"
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

/* Of any friction, the mean of v h(v) over samples: three derivatives at |v| are steady. */
static pendres_orbit_value dissipation_by(const pendres_pendulum *p, const pendres_orbit_samples *s)
{
  const double omega = p->drive_frequency, cycle = two_pi * omega, n = (double)s->n;
  double sum = 0.0, squares = 0.0;
  for (size_t k = 0; k < s->n; k++) {
    const double y = s->y[k], w = s->w[k], v = omega * w;
    const double friction = pendres_equation_friction(p, y, v);
    const double by_w = (friction + pendres_equation_drag(p, y, v)) * w;
    const double by_y = pendres_equation_drag_by_place(p, y, w) * w;
    sum += friction * w * w;
    squares += by_w * by_w + by_y * by_y;
  }
  return (pendres_orbit_value){cycle * sum / n, cycle * sqrt(squares / n), 0.0};
}

static pendres_orbit_value dissipation(const pendres_pendulum *p, const pendres_orbit_samples *s,
                                       const pendres_orbit_measures *m)
{
  if (pendres_equation_drags(p)) return dissipation_by(p, s);
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

/* What they are stands in model/quantity_list.h. */
static const pendres_orbit_row table[] = {
  {.measure = amplitude, .image = 1, .shown = {WITH_ERROR(amplitude), .principal = 1}},
  {.measure = first_harmonic, .image = 1, .shown = {WITH_ERROR(first_harmonic_amplitude)}},
  {.measure = phase_lag, .image = 1, .angle = 1,
   .shown = {WITH_ERROR(phase_lag), .principal = 1}},
  {.measure = loop_area, .image = 1, .shown = {WITH_ERROR(loop_area), .principal = 1}},
  {.measure = dissipation, .image = 1, .shown = {WITH_ERROR(dissipation)}},
  {.image = 1, .shown = {WITH_ERROR(mean_power)}}, /* loop area times a frequency */
  {.measure = torque_work, .shown = {EXACT(torque_work), .of_forces = 1}},
  {.measure = parametric_work, .shown = {WITH_ERROR(parametric_work), .of_forces = 1}},
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
