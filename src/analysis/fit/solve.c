/* solve.c -- least squares from one start; see solve.h. */
#include "analysis/fit/solve.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit_nlinear.h>

#include "base/angles.h"
#include "model/rotation_slope.h"

/* ---- the numbers that the solver sees ---- */

static double inside(const fit_free *f, double value)
{
  /* A bit inside of the bounds, since on them the sine stands still. */
  const double part = (value - f->low) / (f->high - f->low);
  return fmin(fmax(part, fit_inside), 1.0 - fit_inside);
}

static double encode(fit_free *f, double value)
{
  if (f->low < f->high) {
    f->form = FIT_SINE;
    return asin(2.0 * inside(f, value) - 1.0);
  }
  const int q = f->quantity;
  const int positive = q == PENDRES_DAMPING || q == PENDRES_FIT_FREQUENCY_SCALE ||
                       q == PENDRES_FIT_AMPLITUDE_SCALE || q == PENDRES_FIT_DRIVE_SCALE ||
                       q == PENDRES_FIT_TORQUE_SCALE || q == PENDRES_DRIVE_AMPLITUDE;
  f->form = positive && value > 0.0 ? FIT_LOGARITHM : FIT_PLAIN;
  f->unit = value != 0.0 ? fabs(value) : 1.0;
  return f->form == FIT_LOGARITHM ? log(value) : value / f->unit;
}

static double decode(const fit_free *f, double x, double *slope)
{
  switch (f->form) {
  case FIT_SINE:
    *slope = 0.5 * (f->high - f->low) * cos(x);
    return f->low + 0.5 * (f->high - f->low) * (1.0 + sin(x));
  case FIT_LOGARITHM: *slope = exp(fmin(x, 600.0)); return *slope;
  default: *slope = f->unit; return f->unit * x;
  }
}

static void values_of(const fit_problem *p, const double *x, fit_values v, double *slope)
{
  memcpy(v, p->v, sizeof(fit_values));
  for (size_t k = 0; k < p->unknowns; k++)
    v[p->free[k].quantity] = decode(&p->free[k], x[k], &slope[k]);
}

/* ---- residuals ---- */

/* Failures that mean that there is no model at these values, and not that all must end. */
static int is_of_values(pendres_status status)
{
  return status == PENDRES_NOT_CONVERGED || status == PENDRES_INTEGRATION_FAILED ||
         status == PENDRES_TOLERANCE_UNREACHABLE || status == PENDRES_NOT_FOUND ||
         status == PENDRES_INVALID_ARGUMENT;
}

static void add_priors(fit_problem *p)
{
  const size_t first = pendres_fit_rows(p->m);
  for (size_t k = 0; k < p->unknowns; k++) {
    const fit_free *f = &p->free[k];
    memset(p->rows.slope[first + k], 0, sizeof p->rows.slope[first + k]);
    p->rows.residual[first + k] = 0.0;
    if (!(f->prior_error > 0.0)) continue;
    p->rows.residual[first + k] = (p->v[f->quantity] - f->prior) / f->prior_error;
    p->rows.slope[first + k][f->quantity] = 1.0 / f->prior_error;
  }
}

/* Huber's loss as the square of another residual. */
static void soften(fit_problem *p)
{
  const double bend = p->terms.huber;
  for (size_t i = 0; i < pendres_fit_rows(p->m) && bend > 0.0; i++) {
    const double r = p->rows.residual[i];
    if (!(fabs(r) > bend)) continue;
    const double soft = sqrt(bend * (2.0 * fabs(r) - bend));
    p->rows.residual[i] = copysign(soft, r);
    for (int q = 0; q < FIT_QUANTITIES; q++) p->rows.slope[i][q] *= bend / soft;
  }
}

int pendres_fit_evaluate(fit_problem *p, const fit_values v)
{
  if (p->known && memcmp(v, p->v, sizeof(fit_values)) == 0) return !p->lost;
  memcpy(p->v, v, sizeof p->v);
  p->evaluations++;
  p->known = 1;
  pendres_status status = p->m->decays ? PENDRES_OK : pendres_fit_curves(p->m, v);
  if (status == PENDRES_OK) status = pendres_fit_stages(p->m, v);
  p->lost = status != PENDRES_OK;
  if (p->lost && !is_of_values(status)) p->status = status;
  if (p->lost) return 0;
  pendres_fit_residuals(p->m, v, &p->terms, &p->rows);
  add_priors(p);
  soften(p);
  for (size_t i = 0; i < pendres_fit_all_rows(p); i++) p->lost |= !isfinite(p->rows.residual[i]);
  return !p->lost;
}

double pendres_fit_sum_of_squares(const fit_problem *p)
{
  double sum = 0.0;
  for (size_t i = 0; i < pendres_fit_all_rows(p); i++)
    sum += p->rows.residual[i] * p->rows.residual[i];
  return sum;
}

static int residuals(const gsl_vector *x, void *arg, gsl_vector *out)
{
  fit_problem *p = arg;
  fit_values v;
  double slope[FIT_QUANTITIES];
  values_of(p, x->data, v, slope);
  const int found = pendres_fit_evaluate(p, v);
  if (p->status != PENDRES_OK) return GSL_EFAILED;
  /* Where there is no model, all is worse than anywhere else. */
  const double worst = sqrt(10.0 * p->worst / (double)out->size);
  for (size_t i = 0; i < out->size; i++)
    gsl_vector_set(out, i, found ? p->rows.residual[i] : worst);
  return GSL_SUCCESS;
}

static int slopes(const gsl_vector *x, void *arg, gsl_matrix *out)
{
  fit_problem *p = arg;
  fit_values v;
  double slope[FIT_QUANTITIES];
  values_of(p, x->data, v, slope);
  const int found = pendres_fit_evaluate(p, v);
  for (size_t i = 0; i < out->size1; i++)
    for (size_t k = 0; k < out->size2; k++) {
      const double j = found ? p->rows.slope[i][p->free[k].quantity] * slope[k] : 0.0;
      gsl_matrix_set(out, i, k, isfinite(j) ? j : 0.0);
    }
  return p->status == PENDRES_OK ? GSL_SUCCESS : GSL_EFAILED;
}

/* One run of the solver from out->v on. */
static pendres_status run(fit_problem *p, int iterations, fit_result *out)
{
  int info = 0;
  gsl_multifit_nlinear_parameters rules = gsl_multifit_nlinear_default_parameters();
  rules.solver = gsl_multifit_nlinear_solver_svd;
  out->computed = 0;
  for (size_t k = 0; k < p->unknowns; k++)
    p->x[k] = encode(&p->free[k], out->v[p->free[k].quantity]);
  memcpy(p->v, out->v, sizeof p->v);
  fit_values v;
  double slope[FIT_QUANTITIES];
  p->known = 0;
  values_of(p, p->x, v, slope);
  if (!pendres_fit_evaluate(p, v)) return p->status;
  p->worst = pendres_fit_sum_of_squares(p) + 1.0;
  gsl_multifit_nlinear_fdf f = {.f = residuals, .df = slopes, .n = pendres_fit_all_rows(p),
                                .p = p->unknowns, .params = p};
  gsl_multifit_nlinear_workspace *w =
    gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &rules, f.n, f.p);
  gsl_vector_const_view x = gsl_vector_const_view_array(p->x, p->unknowns);
  if (w == NULL)
    return pendres_context_fail(p->m->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a fit");
  if (gsl_multifit_nlinear_init(&x.vector, &f, w) == GSL_SUCCESS)
    (void)gsl_multifit_nlinear_driver((size_t)iterations, fit_step_tolerance, fit_step_tolerance,
                                      0.0, NULL, NULL, &info, w);
  p->iterations += (int)gsl_multifit_nlinear_niter(w);
  values_of(p, gsl_multifit_nlinear_position(w)->data, out->v, slope);
  gsl_multifit_nlinear_free(w);
  if (p->status != PENDRES_OK) return p->status;
  return pendres_fit_conclude(p, out);
}

/* Whether a datum is at a jump of the model, or between that and its own. */
static int is_kinked(const fit_problem *p)
{
  for (size_t i = 0; i < p->m->stations; i++)
    if (p->m->station[i].beyond[p->m->station[i].stage] != 0) return 1;
  for (size_t i = 0; i < pendres_fit_rows(p->m) - p->m->data; i++)
    if (p->rows.used[i] == 1) return 1;
  return 0;
}

pendres_status pendres_fit_solve(fit_problem *p, int iterations, fit_result *out)
{
  pendres_status status = run(p, iterations, out);
  for (int again = 0; again < FIT_AGAIN && status == PENDRES_OK && out->computed; again++) {
    const double before = out->chi_square;
    if (out->converged) break;
    status = run(p, iterations, out);
    if (status == PENDRES_OK && before - out->chi_square < fit_converged) {
      out->converged |= p->m->left == 0 && out->remaining < fit_kinked && is_kinked(p);
      break;
    }
  }
  /* Where data come to be left out chi-square has steps, about which the solver goes to and fro. */
  if (status == PENDRES_OK && out->computed && p->m->left > 0)
    out->converged |= out->remaining < fit_stepped;
  return status;
}

/* ---- covariance ---- */

/* The derivatives in a matrix, columns of length 1; those of quantities at a bound are 0. */
static void scale_columns(const fit_problem *p, gsl_matrix *j, double *length)
{
  for (size_t k = 0; k < p->unknowns; k++) {
    const int q = p->free[k].quantity;
    double sum = 0.0;
    for (size_t i = 0; i < j->size1; i++) sum = hypot(sum, p->rows.slope[i][q]);
    length[k] = sum;
    const int open = sum > 0.0 && !p->free[k].at_bound;
    for (size_t i = 0; i < j->size1; i++)
      gsl_matrix_set(j, i, k, open ? p->rows.slope[i][q] / sum : 0.0);
  }
}

/* What the decomposition says: the covariance, and what may still be gained. */
static void read_decomposition(const fit_problem *p, const gsl_matrix *u, const gsl_matrix *v,
                               const gsl_vector *s, const double *length, fit_result *out)
{
  const size_t n = p->unknowns;
  const double least = fit_undetermined * gsl_vector_get(s, 0);
  memset(out->covariance, 0, n * n * sizeof *out->covariance);
  memset(out->open, 0, n * sizeof *out->open);
  out->remaining = 0.0;
  out->determined = 1;
  for (size_t c = 0; c < n; c++) {
    const double size = gsl_vector_get(s, c);
    double part = 0.0, held = 0.0;
    for (size_t k = 0; k < n; k++)
      if (p->free[k].at_bound) held = fmax(held, fabs(gsl_matrix_get(v, k, c)));
    if (size <= least && held > 0.5) continue; /* the column of a quantity at its bound */
    for (size_t i = 0; i < u->size1; i++) part += gsl_matrix_get(u, i, c) * p->rows.residual[i];
    if (size > least) out->remaining += part * part;
    for (size_t a = 0; a < n; a++) {
      const double at = gsl_matrix_get(v, a, c);
      if (size <= least) out->open[a] = length[a] > 0.0 ? at / length[a] : at;
      for (size_t b = 0; b < n && size > least; b++)
        out->covariance[a * n + b] +=
          at * gsl_matrix_get(v, b, c) / (size * size * length[a] * length[b]);
    }
    out->determined &= size > least;
  }
}

/* The number of a free quantity that no prior and no bound holds; -1: there is none. */
static int loose(const fit_problem *p, int quantity)
{
  for (size_t k = 0; k < p->unknowns; k++)
    if (p->free[k].quantity == quantity && p->free[k].prior_error <= 0.0 && !p->free[k].at_bound)
      return (int)k;
  return -1;
}

/*
 * Currents and voltages of a junction without a jump follow sqrt(I^2 - 1)/damping but for a share
 * that falls with the damping's fourth power: gain and damping may grow together by factors, while
 * derivatives next to the kink at the critical current seem to tell them apart. What the voltage's
 * return at a lower current tells is missing, so the two are not determined.
 */
static void doubt_without_jumps(const fit_problem *p, fit_result *out)
{
  double torque, by_damping;
  const int damping = p->m->rotates ? loose(p, PENDRES_DAMPING) : -1;
  const int gain = loose(p, PENDRES_FIT_AMPLITUDE_SCALE);
  if (damping < 0 || gain < 0 || !out->determined) return;
  if (!pendres_rotation_onset_slope(out->v[PENDRES_DAMPING], &torque, &by_damping)) return;
  if (torque < 1.0) return;
  out->open[damping] = out->v[PENDRES_DAMPING];
  out->open[gain] = out->v[PENDRES_FIT_AMPLITUDE_SCALE];
  out->determined = 0;
}

static double freedom_of(const fit_problem *p)
{
  double count = (double)(p->m->data - p->m->left) - (double)p->unknowns;
  for (size_t i = 0; i < pendres_fit_rows(p->m) - p->m->data; i++) count += p->rows.used[i] == 1;
  for (size_t k = 0; k < p->unknowns; k++)
    count += (p->free[k].prior_error > 0.0) + p->free[k].at_bound;
  return count;
}

pendres_status pendres_fit_conclude(fit_problem *p, fit_result *out)
{
  const size_t n = p->unknowns, rows = pendres_fit_all_rows(p);
  double length[FIT_QUANTITIES];
  if (!pendres_fit_evaluate(p, out->v)) return p->status;
  gsl_matrix *j = gsl_matrix_alloc(rows, n), *v = gsl_matrix_alloc(n, n);
  gsl_vector *s = gsl_vector_alloc(n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (j != NULL && v != NULL && s != NULL) {
    for (size_t k = 0; k < n; k++) {
      fit_free *f = &p->free[k];
      const double value = out->v[f->quantity], width = f->high - f->low;
      f->at_bound =
        width > 0.0 && fmin(value - f->low, f->high - value) < fit_at_bound * width;
      out->at_bound[k] = f->at_bound;
    }
    scale_columns(p, j, length);
    status = gsl_linalg_SV_decomp_jacobi(j, v, s) == GSL_SUCCESS ? PENDRES_OK
                                                                  : PENDRES_NOT_CONVERGED;
  }
  if (status == PENDRES_OK) {
    read_decomposition(p, j, v, s, length, out);
    doubt_without_jumps(p, out);
    out->chi_square = pendres_fit_sum_of_squares(p);
    out->freedom = freedom_of(p);
    out->computed = 1;
    const double one = fmax(1.0, out->chi_square / fmax(1.0, out->freedom));
    out->converged = out->remaining < fit_converged * one;
  }
  gsl_matrix_free(j);
  gsl_matrix_free(v);
  gsl_vector_free(s);
  return status == PENDRES_OUT_OF_MEMORY
           ? pendres_context_fail(p->m->ctx, status, "out of memory for a fit") : status;
}
