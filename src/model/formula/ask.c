/* ask.c -- what follows from a formula, by its values at points; see formula.h. */
#include "model/formula/formula.h"

#include <math.h>

/* How densely, and how far out, a formula is asked: points an octave, and octaves of x. */
enum { PER_OCTAVE = 4, FIRST_OCTAVE = -6, MIRROR_OCTAVE = 6, LAST_OCTAVE = 40 };

static double force_at(const pendres_formula *f, const double *a, double y)
{
  double out[FORMULA_OUTPUTS];
  pendres_formula_at(f, FORMULA_FORCES, a, y, out);
  return out[FORMULA_OUT_FORCE];
}

/* Points lie between simple fractions of pi and powers of two. */
static double point(int k)
{
  return 1.0371 * exp2((double)k / PER_OCTAVE);
}

double pendres_formula_centre(const pendres_formula *f, const double *a, double torque)
{
  if (torque != 0.0 || (f->by & (FORMULA_BY_V | FORMULA_BY_PHASE)) != 0) return NAN;
  for (int k = FIRST_OCTAVE * PER_OCTAVE; k <= MIRROR_OCTAVE * PER_OCTAVE; k++) {
    const double right = force_at(f, a, point(k)), left = force_at(f, a, -point(k));
    if (isnan(right) && isnan(left)) continue;
    if (!(fabs(right + left) <= formula_rounding * (fabs(right) + fabs(left)))) return NAN;
  }
  return 0.0;
}

int pendres_formula_leads_out(const pendres_formula *f, const double *a, double y, double need)
{
  if (f->model.period > 0.0) return 0;
  const double most = exp2(LAST_OCTAVE), side = y < 0.0 ? -1.0 : 1.0;
  for (double z = fmax(fabs(y), 1.0); z < most; z *= exp2(1.0 / PER_OCTAVE))
    if (!(-side * force_at(f, a, side * z) > fmax(need, 0.0))) return 0;
  return 1;
}

double pendres_formula_edge(const pendres_formula *f, const double *a, double side)
{
  double low = 0.0, high = exp2(FIRST_OCTAVE);
  while (high < exp2(LAST_OCTAVE) && isfinite(force_at(f, a, side * high))) {
    low = high;
    high *= exp2(1.0 / PER_OCTAVE);
  }
  for (int k = 0; k < 8; k++) {
    const double middle = 0.5 * (low + high);
    if (isfinite(force_at(f, a, side * middle))) low = middle;
    else high = middle;
  }
  return low;
}

double pendres_formula_potential(const pendres_formula *f, const double *a, double y)
{
  /* Gauss's rule with five points, of panels of an eighth. */
  static const double at[5] = {0.0, 0.53846931010568309104, -0.53846931010568309104,
                               0.90617984593866399280, -0.90617984593866399280};
  static const double weight[5] = {0.56888888888888888889, 0.47862867049936646804,
                                   0.47862867049936646804, 0.23692688505618908751,
                                   0.23692688505618908751};
  const double panels = fmin(ceil(8.0 * fabs(y)), 1e5), half = 0.5 * y / panels;
  double sum = 0.0;
  for (double k = 0.0; k < panels; k++)
    for (int i = 0; i < 5; i++)
      sum += weight[i] * half * force_at(f, a, half * (2.0 * k + 1.0 + at[i]));
  return sum;
}
