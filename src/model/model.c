/* model.c -- what follows from a pendulum's force; see model.h and pendulum.h. */
#include "model/model.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "model/equation.h"
#include "model/formula/formula.h"
#include "model/forces.h"
#include "model/numbers.h"
#include "model/parameter.h"

/* All bottoms and tops are centres: y is an angle, and the bottom represents all of them. */
static double pendulum_centre(const double *a, double torque, double near)
{
  (void)a;
  (void)near;
  return torque == 0.0 ? 0.0 : NAN;
}

static const pendres_model pendulum = {.name = "pendulum",
                                       .period = 2.0 * PENDRES_PI,
                                       .origin = 0.5 * PENDRES_PI,
                                       .angle = 1,
                                       .centre = pendulum_centre};

/*
 * With z the distance, c_k the coefficients of -side f(side z) - need and n its degree, all zeros
 * are within 2 max |c_k / c_n|^(1/(n - k)) (M. Fujiwara, Tohoku Mathematical Journal 10 (1916)
 * 167). Those of -side f, which lacks c_0, are so too.
 */
static double polynomial_outward(const double *a, double side, double need)
{
  int n = PENDRES_FORCE_POWERS;
  while (n > 0 && a[n - 1] == 0.0) n--;
  if (n == 0) return INFINITY;
  /* -side f(side z): odd powers change their sign once, even ones with the side. */
  const double lead = n % 2 == 1 ? -a[n - 1] : -side * a[n - 1];
  if (!(lead > 0.0)) return INFINITY;
  double most = pow(fabs(need) / lead, 1.0 / n);
  for (int k = 1; k < n; k++) most = fmax(most, pow(fabs(a[k - 1]) / lead, 1.0 / (n - k)));
  return 2.0 * most;
}

/*
 * In z = y - c the powers n and n - 1 of a polynomial of degree n have the coefficients a_n and
 * a_(n-1) + n a_n c: the latter is 0 at one c alone, where all other even powers must be 0, too,
 * but for roundings of the sum of their sizes.
 */
static double polynomial_centre(const double *a, double torque, double near)
{
  const double rounding = model_roundings * 0x1p-53;
  double taylor[PENDRES_FORCE_POWERS + 1] = {-torque};
  int n = PENDRES_FORCE_POWERS;
  (void)near;
  for (int j = 1; j <= n; j++) taylor[j] = a[j - 1];
  while (n > 0 && taylor[n] == 0.0) n--;
  if (n % 2 == 0) return NAN;
  const double c = -taylor[n - 1] / (n * taylor[n]);
  for (int k = 0; k < n; k += 2) {
    double sum = 0.0, size = 0.0, term = 1.0; /* c^(j - k), times the binomial coefficient */
    for (int j = k; j <= n; term *= c * (j + 1) / (j + 1 - k), j++) {
      sum += taylor[j] * term;
      size += fabs(taylor[j] * term);
    }
    if (!(fabs(sum) <= rounding * size)) return NAN;
  }
  return c + 0.0;
}

static const pendres_model polynomial = {.name = "polynomial",
                                         .coefficients = PENDRES_FORCE_POWERS,
                                         .outward = polynomial_outward,
                                         .centre = polynomial_centre};

static const pendres_model *const models[PENDRES_FORCE_COUNT] = {
  [PENDRES_FORCE_PENDULUM] = &pendulum, [PENDRES_FORCE_POLYNOMIAL] = &polynomial,
#define MODEL_OF(code, name) [PENDRES_FORCE_##code] = &pendres_force_##name##_model,
  PENDRES_FORCE_LIST(MODEL_OF)
#undef MODEL_OF
};

const pendres_model *pendres_model_of(pendres_force force)
{
  const pendres_formula *f = pendres_formula_of(force);
  if (f != NULL) return &f->model;
  return (unsigned)force < PENDRES_FORCE_COUNT ? models[force] : NULL;
}

pendres_model_terms pendres_model_kind(const pendres_pendulum *p)
{
  if (p->force >= PENDRES_FORCE_FORMULA) return (pendres_model_terms)p->force;
  if (p->force != PENDRES_FORCE_PENDULUM)
    return (pendres_model_terms)((int)p->force - (int)PENDRES_FORCE_POLYNOMIAL +
                                 (int)PENDRES_MODEL_POLYNOMIAL);
  return p->torque != 0.0 || p->parametric_amplitude != 0.0 || pendres_equation_drags(p)
           ? PENDRES_MODEL_PENDULUM : PENDRES_MODEL_PLAIN;
}

const char *pendres_model_check(const pendres_pendulum *p)
{
  const double friction[] = {p->nonlinear_damping, p->quadratic_damping, p->cubic_damping};
  if (!isfinite(p->torque)) return "the torque must be finite";
  if (!isfinite(p->parametric_amplitude)) return "the parametric amplitude must be finite";
  const pendres_model *model = pendres_model_of(p->force);
  if (model == NULL) return "the force is of no kind that there is";
  for (size_t i = 0; i < sizeof friction / sizeof *friction; i++)
    if (!(isfinite(friction[i]) && friction[i] >= 0.0))
      return "nonlinear, quadratic and cubic damping must be finite and not negative";
  for (size_t i = 0; i < sizeof p->spare / sizeof *p->spare; i++)
    if (p->spare[i] != 0.0) return "the spare numbers of a pendulum are zero";
  if (p->nonlinear_damping != 0.0 && model->period > 0.0)
    return "nonlinear damping, eta x^2 x', needs a force whose x has no period";
  const int used = model->coefficients;
  int any = 0;
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++) {
    const double a = p->force_coefficients[i];
    if (!isfinite(a)) return "coefficients of the force must be finite";
    if (i >= used && a != 0.0) return "this force has no such coefficients: leave them at zero";
    any |= a != 0.0;
  }
  if (p->force == PENDRES_FORCE_POLYNOMIAL && !any)
    return "a polynomial force needs a coefficient that is not zero";
  double force, slope;
  pendres_model_force(p, 0.0, &force, &slope);
  if (!(isfinite(force) && isfinite(slope)))
    return "a formula and its derivative must be finite at x = 0, with these coefficients";
  return NULL;
}

double pendres_model_centre(const pendres_pendulum *p, double near)
{
  const pendres_formula *f = pendres_formula_of(p->force);
  if (p->parametric_amplitude != 0.0) return NAN;
  if (f == NULL && models[p->force]->centre == NULL) return NAN;
  const double c = f != NULL
                     ? pendres_formula_centre(f, p->force_coefficients, p->torque)
                     : models[p->force]->centre(p->force_coefficients, p->torque,
                                                isfinite(near) ? near : 0.0);
  return p->nonlinear_damping == 0.0 || c == 0.0 ? c : NAN;
}

int pendres_pendulum_symmetric(const pendres_pendulum *p)
{
  return p != NULL && pendres_model_of(p->force) != NULL &&
         isfinite(pendres_model_centre(p, 0.0));
}

void pendres_model_force(const pendres_pendulum *p, double y, double *force, double *slope)
{
  if (p->force == PENDRES_FORCE_PENDULUM) {
    *force = sin(y);
    *slope = cos(y);
    return;
  }
  const pendres_formula *f = pendres_formula_of(p->force);
  if (f != NULL) {
    double out[FORMULA_OUTPUTS];
    pendres_formula_at(f, FORMULA_SLOPES, p->force_coefficients, y, out);
    *force = out[FORMULA_OUT_FORCE];
    *slope = out[FORMULA_OUT_SLOPE];
    return;
  }
  if (p->force != PENDRES_FORCE_POLYNOMIAL) {
    pendres_forces_at(p->force, p->force_coefficients, y, force, slope);
    return;
  }
  const double *a = p->force_coefficients;
  double sum = a[PENDRES_FORCE_POWERS - 1], by = 0.0;
  for (int i = PENDRES_FORCE_POWERS - 2; i >= 0; i--) {
    by = fma(by, y, sum);
    sum = fma(sum, y, a[i]);
  }
  *force = sum * y;
  *slope = fma(by, y, sum);
}

double pendres_model_bend(const pendres_pendulum *p, double y)
{
  const double *a = p->force_coefficients, h = 0x1p-13 * (1.0 + fabs(y));
  double sum = 0.0, force, right, left;
  if (p->force == PENDRES_FORCE_PENDULUM) return -sin(y);
  if (p->force == PENDRES_FORCE_POLYNOMIAL) {
    for (int i = PENDRES_FORCE_POWERS - 1; i >= 1; i--) sum = fma(sum, y, i * (i + 1) * a[i]);
    return sum;
  }
  pendres_model_force(p, y + h, &force, &right);
  pendres_model_force(p, y - h, &force, &left);
  return 0.5 * (right - left) / h;
}

/* Powers of a force with a coefficient. */
static int powers(const pendres_pendulum *p)
{
  int n = 0;
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++) n += p->force_coefficients[i] != 0.0;
  return n;
}

static double polynomial_potential(const double *a, double x)
{
  double sum = 0.0;
  for (int i = PENDRES_FORCE_POWERS - 1; i >= 0; i--) sum = fma(sum, x, a[i] / (i + 2));
  return sum;
}

double pendres_model_potential(const pendres_pendulum *p, double x)
{
  const pendres_formula *f = p != NULL ? pendres_formula_of(p->force) : NULL;
  if (p == NULL) return NAN;
  if (f != NULL)
    return pendres_formula_potential(f, p->force_coefficients, x) - p->torque * x;
  switch (p->force) {
  case PENDRES_FORCE_PENDULUM: return -sin(x) - p->torque * x;
  case PENDRES_FORCE_POLYNOMIAL:
    return x * fma(polynomial_potential(p->force_coefficients, x), x, -p->torque);
#define POTENTIAL_OF(code, name)                                                           \
  case PENDRES_FORCE_##code:                                                               \
    return pendres_force_##name##_potential(p->force_coefficients,                         \
                                            x - pendres_force_##name##_model.origin) -     \
           p->torque * x;
    PENDRES_FORCE_LIST(POTENTIAL_OF)
#undef POTENTIAL_OF
  default: return NAN;
  }
}

double pendres_model_turn(const pendres_pendulum *p)
{
  const double period = pendres_model_of(p->force)->period;
  return period > 0.0 ? period : 0x1p1000;
}

double pendres_model_origin(const pendres_pendulum *p)
{
  return pendres_model_of(p->force)->origin;
}

double pendres_model_settling(const pendres_pendulum *p)
{
  return 1.0 / pendres_equation_fading(p);
}

/* ---- the scale of a force ---- */

/* For a polynomial as if all its terms had the same sign; for other forces the larger of both
   sides, by Simpson's rule. */
double pendres_model_climb(const pendres_pendulum *p, double reach)
{
  double sum = 0.0, side[2] = {0.0, 0.0};
  if (p->force == PENDRES_FORCE_POLYNOMIAL) {
    for (int i = PENDRES_FORCE_POWERS - 1; i >= 0; i--)
      sum = fma(sum, fabs(reach), fabs(p->force_coefficients[i]) / (i + 2));
    return sum * reach * reach;
  }
  const double h = fabs(reach) / MODEL_SAMPLES;
  for (int i = 0; i <= MODEL_SAMPLES; i++)
    for (int k = 0; k < 2; k++) {
      double force, slope;
      pendres_model_force(p, k == 0 ? i * h : -i * h, &force, &slope);
      if (isnan(force)) return INFINITY; /* nothing comes from there */
      const double weight = i == 0 || i == MODEL_SAMPLES ? 1.0 : i % 2 != 0 ? 4.0 : 2.0;
      side[k] += weight * h / 3.0 * fabs(force);
    }
  return fmax(side[0], side[1]);
}

double pendres_model_stiffest(const pendres_pendulum *p, double reach)
{
  double most = 0.0;
  if (p->force == PENDRES_FORCE_POLYNOMIAL) {
    for (int i = PENDRES_FORCE_POWERS - 1; i >= 0; i--)
      most = fma(most, reach, (i + 1) * fabs(p->force_coefficients[i]));
    return most;
  }
  for (int i = -MODEL_SAMPLES; i <= MODEL_SAMPLES; i++) {
    double force, slope;
    pendres_model_force(p, reach * i / MODEL_SAMPLES, &force, &slope);
    most = fmax(most, fabs(slope));
  }
  return most;
}

double pendres_model_scale(const pendres_pendulum *p)
{
  double scale = 0.0;
  if (p->force != PENDRES_FORCE_POLYNOMIAL) return 1.0;
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++)
    for (int j = i + 1; j < PENDRES_FORCE_POWERS; j++) {
      const double low = fabs(p->force_coefficients[i]), high = fabs(p->force_coefficients[j]);
      if (low > 0.0 && high > 0.0) scale = fmax(scale, pow(low / high, 1.0 / (j - i)));
    }
  return scale > 0.0 ? scale : 1.0;
}

/* Whether drive and torque can move a pendulum as far as `reach`: on average a drive balances
   friction up to some speed, and at rest both together hold it. */
static int reached(const pendres_pendulum *p, double reach)
{
  const double speed = pendres_equation_speed(p, p->drive_amplitude);
  const double climb = pendres_model_climb(p, reach);
  return climb <= 0.5 * speed * speed ||
         climb <= (fabs(p->drive_amplitude) + fabs(p->torque)) * reach;
}

pendres_model_units pendres_model_units_of(const pendres_pendulum *p)
{
  const double stiffer = sqrt(1.0 + fabs(p->parametric_amplitude));
  pendres_model_units u = {1.0, stiffer};
  if (p->force == PENDRES_FORCE_PENDULUM) return u;
  /* A single power has no length of its own. */
  const double own = pendres_model_scale(p);
  double reach = ldexp(own, -UNITS_NEGLIGIBLE);
  for (int k = 0; k < ITERATIONS && reached(p, 2.0 * reach); k++) reach *= 2.0;
  double step = reach;
  for (int k = 0; k < MODEL_HALVINGS; k++) {
    step *= 0.5;
    if (reached(p, reach + step)) reach += step;
  }
  const double rate = stiffer * sqrt(2.0 * pendres_model_climb(p, reach)) / reach;
  if (!(rate > 0.0 && isfinite(rate))) return u;
  u.rate = rate;
  u.length = p->force != PENDRES_FORCE_POLYNOMIAL || powers(p) > 1 ? fmin(own, reach) : reach;
  return u;
}

double pendres_model_distance(const pendres_pendulum *p, double x, double v)
{
  const pendres_model_units unit = pendres_model_units_of(p);
  return hypot(x, v / unit.rate) / unit.length;
}

/*
 * A length beyond which, on one side, force and drives together push outwards for ever, whatever
 * the phase: the force exceeds what drive and torque can balance. Infinite if there is none.
 */
static double far_out(const pendres_pendulum *p, double side, double need)
{
  return models[p->force]->outward(p->force_coefficients, side, need) * (1.0 + 1e-9);
}

int pendres_pendulum_rotates(const pendres_pendulum *p)
{
  return p != NULL && p->force == PENDRES_FORCE_PENDULUM &&
         (p->torque != 0.0 || (p->drive_amplitude != 0.0 && p->parametric_amplitude != 0.0));
}

int pendres_pendulum_leaves(const pendres_pendulum *p)
{
  if (p == NULL || pendres_model_of(p->force) == NULL) return 0;
  pendres_force_outward *outward = pendres_model_of(p->force)->outward;
  const pendres_formula *f = pendres_formula_of(p->force);
  const double *a = p->force_coefficients;
  if (f != NULL)
    return f->bounded || pendres_formula_leads_out(f, a, formula_far, 0.0) ||
           pendres_formula_leads_out(f, a, -formula_far, 0.0);
  return outward != NULL && fabs(p->parametric_amplitude) < 1.0 &&
         (isfinite(outward(a, 1.0, 0.0)) || isfinite(outward(a, -1.0, 0.0)));
}

int pendres_model_escapes(const pendres_pendulum *p, double y, double w)
{
  const double side = y < 0.0 ? -1.0 : 1.0;
  double force, slope;
  const double rest = 1.0 - fabs(p->parametric_amplitude);
  const double need = (fabs(p->drive_amplitude) - side * p->torque) / rest;
  const pendres_formula *f = pendres_formula_of(p->force);
  if (pendres_model_of(p->force)->outward == NULL || !(rest > 0.0) || !(side * w >= 0.0)) return 0;
  pendres_model_force(p, y, &force, &slope);
  /* This decides for most states. */
  if (!(-side * force > 0.0)) return 0;
  if (f != NULL) return pendres_formula_leads_out(f, p->force_coefficients, y, need);
  return side * y > far_out(p, side, need);
}

int pendres_model_bounded(const pendres_pendulum *p)
{
  const pendres_formula *f = pendres_formula_of(p->force);
  return f != NULL && f->bounded;
}

double pendres_model_edge(const pendres_pendulum *p)
{
  const pendres_formula *f = pendres_formula_of(p->force);
  if (f == NULL || !f->bounded) return INFINITY;
  return model_inside * fmin(pendres_formula_edge(f, p->force_coefficients, 1.0),
                             pendres_formula_edge(f, p->force_coefficients, -1.0));
}

int pendres_model_driven(const pendres_pendulum *p)
{
  return p->drive_amplitude != 0.0 || p->parametric_amplitude != 0.0;
}

int pendres_model_is_linear(const pendres_pendulum *p)
{
  return p->force == PENDRES_FORCE_POLYNOMIAL && p->force_coefficients[0] != 0.0 &&
         powers(p) == 1 && !pendres_equation_drags(p);
}

int pendres_model_same(const pendres_pendulum *a, const pendres_pendulum *b)
{
  /* Mostly they are the same bytes, which is told at once. */
  if (memcmp(a, b, sizeof *a) == 0) return 1;
  int same = a->force == b->force;
  for (int k = 0; k < PENDRES_PARAMETER_COUNT && same; k++) {
    const pendres_parameter parameter = (pendres_parameter)k;
    const int of_state = pendres_parameter_place(parameter) >= sizeof *a;
    same = parameter == PENDRES_TEMPERATURE || of_state ||
           pendres_parameter_get(parameter, a) == pendres_parameter_get(parameter, b);
  }
  return same;
}
