/* parameter.c -- the table of parameters; see parameter.h and <pendres/parameter.h>. */
#include "model/parameter.h"

#include <math.h>
#include <string.h>

typedef struct row {
  pendres_parameter_info info;
  size_t place;
  double over;
} row;

/* k of a place among the coefficients, from 1 on; else 0. */
#define FIRST offsetof(pendres_parameter_record, pendulum.force_coefficients)
#define COEFFICIENT(place)                                                             \
  ((place) >= FIRST && (place) < FIRST + PENDRES_FORCE_COEFFICIENTS * sizeof(double)   \
     ? (int)(((place) - FIRST) / sizeof(double)) + 1                                   \
     : 0)
#define ROW(is_plain, code, number, name, field, over, positive, kind, words, brief)          \
  [PENDRES_##code] = {{name, words, brief, PENDRES_KIND_##kind, positive, is_plain,           \
                       COEFFICIENT(offsetof(pendres_parameter_record, field))},               \
                      offsetof(pendres_parameter_record, field), over},
#define PLAIN(...) ROW(1, __VA_ARGS__)
#define OTHER(...) ROW(0, __VA_ARGS__)
static const row rows[PENDRES_PARAMETER_COUNT] = {
  PENDRES_PARAMETERS_PLAIN(PLAIN) PENDRES_PARAMETERS_OTHER(OTHER) PENDRES_PARAMETERS_REST(OTHER)};

static const row *row_of(pendres_parameter parameter)
{
  return (unsigned)parameter < PENDRES_PARAMETER_COUNT ? &rows[parameter] : NULL;
}

const pendres_parameter_info *pendres_parameter_of(pendres_parameter parameter)
{
  const row *r = row_of(parameter);
  return r != NULL ? &r->info : NULL;
}

size_t pendres_parameter_place(pendres_parameter parameter)
{
  const row *r = row_of(parameter);
  return r != NULL ? r->place : sizeof(pendres_parameter_record);
}

static int is_of_pendulum(const row *r)
{
  return r != NULL && r->place < sizeof(pendres_pendulum);
}

double pendres_parameter_get(pendres_parameter parameter, const pendres_pendulum *p)
{
  const row *r = row_of(parameter);
  double field;
  if (p == NULL || !is_of_pendulum(r)) return NAN;
  memcpy(&field, (const char *)p + r->place, sizeof field);
  return r->over != 0.0 ? r->over / field : field;
}

static void put(const row *r, double value, void *record)
{
  const double field = r->over != 0.0 ? r->over / value : value;
  memcpy((char *)record + r->place, &field, sizeof field);
}

void pendres_parameter_set(pendres_parameter parameter, double value, pendres_pendulum *p)
{
  const row *r = row_of(parameter);
  if (p != NULL && is_of_pendulum(r)) put(r, value, p);
}

void pendres_parameter_put(pendres_parameter parameter, double value,
                           pendres_parameter_record *record)
{
  const row *r = row_of(parameter);
  if (r != NULL) put(r, value, record);
}

pendres_pendulum pendres_parameter_with(const pendres_pendulum *p, pendres_parameter parameter,
                                        double value)
{
  pendres_pendulum with = *p;
  pendres_parameter_set(parameter, value, &with);
  return with;
}

const char *pendres_parameter_refuses(pendres_parameter parameter, pendres_force force)
{
  const row *r = row_of(parameter);
  if (r == NULL) return "unknown parameter";
  if ((int)parameter >= PENDRES_PARAMETER_FOLLOWED)
    return "orbits cannot be followed in this parameter: there are no derivatives by it";
  const pendres_model *model = pendres_model_of(force);
  if (parameter == PENDRES_NONLINEAR_DAMPING && model != NULL && model->period > 0.0)
    return "nonlinear damping, eta x^2 x', needs a force whose x has no period";
  return model != NULL && r->info.coefficient > model->coefficients
           ? "this force has no such coefficient"
           : NULL;
}
