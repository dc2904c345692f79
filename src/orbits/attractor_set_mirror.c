/*
 * attractor_set_mirror.c -- orbits that are each other's mirror image check each other's errors;
 * see attractor_set.h.
 */
#include "orbits/attractor_set.h"

#include <math.h>

#include "model/model.h"
#include "orbits/orbit_table.h"

/* Harmonics of mirror images agree to this, and those of two other orbits of a pendulum do not. */
static const double same_harmonics = 1e-6;
enum { HARMONICS = 5 /* that are compared */ };

/* y(t) -> 2 c - y(t + half a drive period) changes the sign of even harmonics, and moves the mean
   to the other side of the centre; of an angle there are centres everywhere. */
int pendres_attractor_set_are_images(const pendres_orbit *a, const pendres_orbit *b)
{
  if (a->period != b->period || a->winding != -b->winding) return 0;
  if (!(fabs(a->amplitude - b->amplitude) <= same_harmonics)) return 0;
  const double middle = 0.5 * (a->mean_angle + b->mean_angle);
  if (pendres_model_of(a->pendulum.force)->period == 0.0 &&
      !(fabs(middle - pendres_model_centre(&a->pendulum, middle)) <= same_harmonics))
    return 0;
  for (int m = 1; m <= HARMONICS; m++) {
    const double sign = m % 2 == 0 ? -1.0 : 1.0;
    if (!(hypot(a->cosine[m - 1] - sign * b->cosine[m - 1],
                a->sine[m - 1] - sign * b->sine[m - 1]) <= same_harmonics))
      return 0;
  }
  return 1;
}

static void raise_to(double difference, double *a, double *b)
{
  if (*a < difference) *a = difference;
  if (*b < difference) *b = difference;
}

/* Two values that are the same by symmetry. */
static void compare_values(double value, double other, double *error, double *other_error)
{
  const double difference = fabs(value - other);
  if (difference > *error + *other_error) raise_to(difference, error, other_error);
}

static void compare(pendres_attractor *a, pendres_attractor *b)
{
  pendres_orbit *o = &a->orbit, *p = &b->orbit;
  const pendres_orbit_row *row;
  double apart = 0.0;
  for (int k = 0; k < 2; k++)
    apart = fmax(apart, hypot(o->multiplier_re[k] - p->multiplier_re[k],
                              fabs(o->multiplier_im[k]) - fabs(p->multiplier_im[k])));
  compare_values(apart, 0.0, &o->multiplier_error, &p->multiplier_error);
  for (size_t k = 0; (row = pendres_orbit_row_get(k)) != NULL; k++)
    if (row->image && row->shown.error != PENDRES_ORBIT_EXACT)
      compare_values(*pendres_orbit_row_value(row, o), *pendres_orbit_row_value(row, p),
                     pendres_orbit_row_error(row, o), pendres_orbit_row_error(row, p));
  compare_values(a->lyapunov, b->lyapunov, &a->lyapunov_error, &b->lyapunov_error);
}

void pendres_attractor_set_compare_images(pendres_attractor_set *c)
{
  if (!pendres_pendulum_symmetric(&c->pendulum)) return;
  for (size_t i = 0; i < c->count; i++)
    for (size_t j = i + 1; j < c->count; j++) {
      pendres_attractor *a = &c->attractors[i], *b = &c->attractors[j];
      if (a->label == PENDRES_LABEL_CHAOTIC || b->label == PENDRES_LABEL_CHAOTIC) continue;
      if (pendres_attractor_set_are_images(&a->orbit, &b->orbit)) compare(a, b);
    }
}
