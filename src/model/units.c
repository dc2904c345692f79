/* units.c -- a pendulum's canonical units, and records in them; see units.h. */
#include "model/units.h"

#include <math.h>

#include "model/numbers.h"

/* A positive number as m 2^e with 1 <= m < 2. */
typedef struct binary {
  double m;
  int e;
} binary;

static binary binary_of(double x)
{
  binary b = {1.0, 0};
  if (!(isfinite(x) && x != 0.0)) return b;
  b.m = 2.0 * frexp(fabs(x), &b.e);
  b.e--;
  return b;
}

/* Quotients are rounded alike whatever the power of two, so that units follow those of the user
   exactly. */
static binary over(binary a, binary b)
{
  binary q = {a.m / b.m, a.e - b.e};
  if (q.m < 1.0) {
    q.m *= 2.0;
    q.e--;
  }
  return q;
}

static binary square(binary a)
{
  binary s = {a.m * a.m, 2 * a.e};
  if (s.m >= 2.0) {
    s.m *= 0.5;
    s.e++;
  }
  return s;
}

/* floor(e / d), within bounds. */
static int share(int e, int d)
{
  const int floored = e >= 0 ? e / d : -((-e + d - 1) / d);
  if (floored < -UNITS_FARTHEST) return -UNITS_FARTHEST;
  return floored > UNITS_FARTHEST ? UNITS_FARTHEST : floored;
}

/*
 * The power of two below the length at which the highest power equals the lowest. A single one has
 * none: it gets the length at which it equals drive or torque or, without either, that at which
 * small oscillations would be as fast as they are damped.
 */
static int length_of(const pendres_pendulum *p, int lowest, int highest)
{
  const double *a = p->force_coefficients;
  const binary high = binary_of(a[highest - 1]);
  if (highest > lowest) return share(over(binary_of(a[lowest - 1]), high).e, highest - lowest);
  const double pushed = fmax(fabs(p->drive_amplitude), fabs(p->torque));
  if (pushed > 0.0) return share(over(binary_of(pushed), high).e, highest);
  if (highest == 1 || !(p->damping > 0.0)) return 0;
  return share(over(square(binary_of(p->damping)), high).e, highest - 1);
}

/* The exponent of a power at a length, within a factor of two. */
static int size_of(const pendres_pendulum *p, int k, int length)
{
  return binary_of(p->force_coefficients[k - 1]).e + (k - 1) * length;
}

/*
 * The lowest power that counts. One that is negligible at the length that the others give is no
 * scale: the others, the drive or the torque hold the pendulum there, or the damping. The highest
 * one is a scale however small it is: it counts for a pendulum that is far out.
 */
static int lowest_that_counts(const pendres_pendulum *p, int lowest, int highest)
{
  const double *a = p->force_coefficients;
  const int held = p->drive_amplitude != 0.0 || p->torque != 0.0 || p->damping > 0.0;
  while (lowest < highest) {
    int next = lowest + 1, counts = 1;
    while (a[next - 1] == 0.0) next++;
    if (next == highest && !held) break;
    const int length = length_of(p, next, highest), size = size_of(p, lowest, length);
    for (int k = next; k <= highest; k++)
      if (a[k - 1] != 0.0 && size_of(p, k, length) > size + UNITS_NEGLIGIBLE) counts = 0;
    if (counts) break;
    lowest = next;
  }
  return lowest;
}

pendres_units pendres_units_of(const pendres_pendulum *p)
{
  pendres_units u = {1.0, 1.0};
  if (p == NULL || p->force != PENDRES_FORCE_POLYNOMIAL) return u;
  const double *a = p->force_coefficients;
  int lowest = 0, highest = 0, rate = 0;
  for (int k = PENDRES_FORCE_POWERS; k > 0; k--) {
    if (!isfinite(a[k - 1])) return u;
    if (a[k - 1] == 0.0) continue;
    lowest = k;
    if (highest == 0) highest = k;
  }
  if (highest == 0) return u;
  const int length = length_of(p, lowest_that_counts(p, lowest, highest), highest);
  for (int k = 1, any = 0; k <= PENDRES_FORCE_POWERS; k++) {
    if (a[k - 1] == 0.0) continue;
    const int e = size_of(p, k, length);
    if (!any || e > rate) rate = e;
    any = 1;
  }
  u.length = ldexp(1.0, length);
  u.time = ldexp(1.0, -share(rate, 2));
  return u;
}

/* ---- records ---- */

static double power(double x, int n)
{
  double product = 1.0;
  for (int i = 0; i < n; i++) product *= x;
  for (int i = n; i < 0; i++) product /= x;
  return product;
}

double pendres_units_factor(const pendres_scales *s, int length, int time)
{
  if (length == PENDRES_UNITS_OF_FIRST) return s->first * power(s->unit.length, time);
  if (length == PENDRES_UNITS_OF_SECOND) return s->second;
  return power(s->unit.length, length) * power(s->unit.time, time);
}

double pendres_units_of_parameter(const pendres_units *unit, pendres_parameter parameter)
{
  const pendres_parameter_info *info = pendres_parameter_of(parameter);
  const pendres_scales s = {.unit = *unit, .first = 1.0, .second = 1.0};
  if (info == NULL) return 1.0;
  const pendres_kind_info *kind = pendres_kind_of(info->kind);
  return pendres_units_factor(&s, kind->length, kind->time);
}

static void convert(const pendres_scales *s, const pendres_dimensions *d, size_t n, void *records,
                    int in)
{
  if (records == NULL) return;
  for (size_t r = 0; r < d->rows; r++) {
    const pendres_dimension *row = &d->row[r];
    double f = row->of != NULL ? 1.0 : pendres_units_factor(s, row->length, row->time);
    if (in) f = 1.0 / f;
    for (size_t i = 0; i < n; i++) {
      void *at = (char *)records + i * d->size + row->offset;
      if (row->of != NULL) {
        convert(s, row->of, row->count, at, in);
        continue;
      }
      double *value = at;
      for (size_t k = 0; k < row->count; k++) value[k] *= f;
    }
  }
}

void pendres_units_in(const pendres_scales *s, const pendres_dimensions *d, size_t n,
                      void *records)
{
  convert(s, d, n, records, 1);
}

void pendres_units_out(const pendres_scales *s, const pendres_dimensions *d, size_t n,
                       void *records)
{
  convert(s, d, n, records, 0);
}
