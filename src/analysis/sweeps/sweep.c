/* sweep.c -- axes and index arithmetic; see sweep.h. */
#include "analysis/sweeps/sweep.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/mix.h"
#include "model/model.h"
#include "model/parameter.h"
#include "model/units.h"

/* The rounding error of the values of a range: three operations, and that of a decimal itself. */
static double rounding_of(const pendres_range *range)
{
  return 4.0 * DBL_EPSILON * fmax(fabs(range->first), fabs(range->last));
}

/*
 * The decimal that a value of a range stands for is the shortest within the rounding error, so that
 * 0.06 to 1 in steps of 0.01 holds 0.13 and not 0.12999999999999998. Where decimals are not much
 * farther apart than that error, one would be met by chance, and the value stays as it is.
 */
static double decimal_of(double value, double rounding)
{
  double power = 1.0; /* of ten: exact up to 1e22 */
  for (int places = 0; places <= 22 && rounding * power < 1e-3; places++, power *= 10.0) {
    const double whole = rint(value * power);
    if (fabs(whole) >= 0x1p53) break;
    /* Both are exact, so the quotient is the double next to the decimal. */
    if (fabs(whole / power - value) <= rounding) return whole / power;
  }
  return value;
}

double pendres_range_value(const pendres_range *range, size_t i)
{
  if (range == NULL || i >= range->count) return NAN;
  const double n = (double)(range->count - 1), k = (double)i;
  if (i == 0) return range->first + 0.0; /* no negative zeros */
  if (i + 1 == range->count) return range->last + 0.0;
  const double value = (range->first * (n - k) + range->last * k) / n;
  return decimal_of(value, rounding_of(range)) + 0.0;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static size_t sort_and_unique(double *value, size_t count)
{
  size_t kept = 0;
  if (count == 0) return 0;
  for (size_t i = 0; i < count; i++) value[i] += 0.0;
  qsort(value, count, sizeof *value, ascending);
  for (size_t i = 1; i < count; i++)
    if (value[i] > value[kept]) value[++kept] = value[i];
  return kept + 1;
}

static int sound(size_t listed, const double *list, const pendres_range *range)
{
  for (size_t i = 0; i < listed; i++)
    if (!isfinite(list[i])) return 0;
  if (range->count == 0) return 1;
  if (!(isfinite(range->first) && isfinite(range->last))) return 0;
  return range->count == 1 ? range->first == range->last : range->first < range->last;
}

pendres_status pendres_sweep_values(size_t listed, const double *list, const pendres_range *range,
                                    double *value, size_t *count)
{
  const pendres_range none = {0.0, 0.0, 0};
  if (range == NULL) range = &none;
  if (count == NULL || (listed > 0 && list == NULL) || (listed + range->count > 0 && value == NULL))
    return PENDRES_INVALID_ARGUMENT;
  if (!sound(listed, list, range)) return PENDRES_INVALID_ARGUMENT;

  /* The list at the end of the room: what is written never overtakes it. */
  double *rest = value;
  if (listed > 0) {
    rest = value + range->count;
    memmove(rest, list, listed * sizeof *value);
    listed = sort_and_unique(rest, listed);
  }
  const double margin = rounding_of(range);
  double latest = -INFINITY; /* of the list */
  size_t next = 0, n = 0;
  for (size_t i = 0; i < range->count; i++) {
    const double x = pendres_range_value(range, i);
    while (next < listed && rest[next] <= x) value[n++] = latest = rest[next++];
    if (x - latest <= margin) continue;
    if (next < listed && rest[next] - x <= margin) continue;
    if (n > 0 && x <= value[n - 1]) continue;
    value[n++] = x;
  }
  while (next < listed) value[n++] = rest[next++];
  *count = n;
  return PENDRES_OK;
}

/* Whether the sweep has an axis before number i of the same quantity. */
static int comes_twice(const pendres_sweep *sweep, size_t i)
{
  for (size_t k = 0; k < i; k++)
    if (pendres_parameter_place(sweep->axis[k].parameter) ==
        pendres_parameter_place(sweep->axis[i].parameter))
      return 1;
  return 0;
}

pendres_status pendres_sweep_count(const pendres_sweep *sweep, size_t *count)
{
  size_t n = 1;
  if (sweep == NULL || count == NULL || sweep->axes > PENDRES_PARAMETER_COUNT)
    return PENDRES_INVALID_ARGUMENT;
  for (size_t i = 0; i < sweep->axes; i++) {
    const pendres_axis *a = &sweep->axis[i];
    if (pendres_parameter_of(a->parameter) == NULL || a->count == 0 || a->value == NULL ||
        comes_twice(sweep, i) || n > (size_t)-1 / a->count)
      return PENDRES_INVALID_ARGUMENT;
    n *= a->count;
  }
  *count = n;
  return PENDRES_OK;
}

pendres_pendulum pendres_sweep_pendulum(const pendres_sweep *sweep, size_t index, double *x,
                                        double *v)
{
  size_t count = 0;
  pendres_parameter_record r = {.pendulum = {.damping = NAN, .drive_amplitude = NAN,
                                             .drive_frequency = NAN, .temperature = NAN},
                                .state = {NAN, NAN}};
  const int there = pendres_sweep_count(sweep, &count) == PENDRES_OK && index < count;
  if (there) r = (pendres_parameter_record){sweep->pendulum, {sweep->x, sweep->v}};
  for (size_t i = there ? sweep->axes : 0; i-- > 0;) {
    const pendres_axis *a = &sweep->axis[i];
    pendres_parameter_put(a->parameter, a->value[index % a->count], &r);
    index /= a->count;
  }
  if (x != NULL) *x = r.state.x;
  if (v != NULL) *v = r.state.v;
  return r.pendulum;
}

pendres_ensemble pendres_ensemble_default(void)
{
  return (pendres_ensemble){.members = 200, .x_first = -half_pi, .x_last = 3.0 * half_pi};
}

/* Twice what a drive reaches on average, so that both sides of a state are tried. */
pendres_ensemble pendres_ensemble_of(const pendres_pendulum *p)
{
  pendres_ensemble e = pendres_ensemble_default();
  const pendres_model *model = p != NULL ? pendres_model_of(p->force) : NULL;
  if (model == NULL || model->angle) return e;
  const pendres_scales scales = {pendres_units_of(p), 1.0, 1.0};
  pendres_pendulum own = *p;
  pendres_units_in(&scales, &pendres_dim_pendulum, 1, &own);
  const int pumped = own.parametric_amplitude != 0.0;
  const int moved = own.drive_amplitude != 0.0 || own.torque != 0.0;
  e.x_last = 2.0 * (pumped || !moved ? pendres_model_scale(&own)
                                     : pendres_model_units_of(&own).length);
  e.x_first = -e.x_last;
  pendres_units_out(&scales, &pendres_dim_ensemble, 1, &e);
  return e;
}

pendres_status pendres_ensemble_check(const pendres_ensemble *e, const char **why)
{
  const char *wrong = NULL;
  const int area = e != NULL && e->shape != PENDRES_ENSEMBLE_LINE;
  if (e == NULL) wrong = "there is no ensemble";
  else if (e->members < 1) wrong = "an ensemble needs members";
  else if (!isfinite(e->x_first) || !isfinite(e->x_last) || !isfinite(e->v))
    wrong = "an ensemble needs finite starts";
  else if ((unsigned)e->shape >= PENDRES_ENSEMBLE_SHAPE_COUNT)
    wrong = "an ensemble has one of the shapes line, rectangle and random";
  else if (area && !(isfinite(e->v_last) && e->x_last > e->x_first && e->v_last > e->v))
    wrong = "a rectangle of starts needs ascending, finite bounds of x and v";
  else if (e->shape == PENDRES_ENSEMBLE_RECTANGLE && (e->rows < 1 || e->members % e->rows != 0))
    wrong = "the members of a rectangle must make whole rows";
  if (why != NULL && wrong != NULL) *why = wrong;
  return wrong == NULL ? PENDRES_OK : PENDRES_INVALID_ARGUMENT;
}

/* The place of member k in a rectangle, as shares of its sides. */
static void share_of_sides(const pendres_ensemble *e, size_t k, double *along, double *up)
{
  if (e->shape == PENDRES_ENSEMBLE_RANDOM) {
    *along = pendres_mix_uniform(e->seed, 2 * (uint64_t)k);
    *up = pendres_mix_uniform(e->seed, 2 * (uint64_t)k + 1);
  } else {
    const size_t columns = e->members / e->rows;
    *along = ((double)((k - 1) % columns) + 0.5) / (double)columns;
    *up = ((double)((k - 1) / columns) + 0.5) / (double)e->rows;
  }
}

void pendres_ensemble_start(const pendres_ensemble *e, size_t k, double *x, double *v)
{
  double at_x = NAN, at_v = NAN, along = 0.0, up = 0.0;
  if (pendres_ensemble_check(e, NULL) == PENDRES_OK && k >= 1 && k <= e->members) {
    if (e->shape == PENDRES_ENSEMBLE_LINE) along = (double)k / (double)e->members;
    else share_of_sides(e, k, &along, &up);
    at_x = e->x_first + (e->x_last - e->x_first) * along;
    at_v = e->shape == PENDRES_ENSEMBLE_LINE ? e->v : e->v + (e->v_last - e->v) * up;
  }
  if (x != NULL) *x = at_x;
  if (v != NULL) *v = at_v;
}

