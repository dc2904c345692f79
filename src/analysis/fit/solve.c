/* solve.c -- least squares from one start; see solve.h. */
#include "analysis/fit/solve.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_cdf.h>
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
                       q == PENDRES_FIT_TORQUE_SCALE || q == PENDRES_DRIVE_AMPLITUDE ||
                       q == PENDRES_FIT_INTERNAL_Q || q == PENDRES_FIT_COUPLING_Q ||
                       q == PENDRES_FIT_BACKGROUND_AMPLITUDE;
  f->form = positive && value > 0.0 ? FIT_LOGARITHM : FIT_PLAIN;
  f->unit = value != 0.0 ? fabs(value) : 1.0;
  f->about = f->narrow > 0.0 ? value : 1.0;
  if (f->narrow > 0.0 && f->form == FIT_LOGARITHM) return 1.0;
  return f->form == FIT_LOGARITHM ? log(value) : value / f->unit;
}

static double decode(const fit_free *f, double x, double *slope)
{
  switch (f->form) {
  case FIT_SINE:
    *slope = 0.5 * (f->high - f->low) * cos(x);
    return f->low + 0.5 * (f->high - f->low) * (1.0 + sin(x));
  case FIT_LOGARITHM: {
    if (!(f->narrow > 0.0)) return *slope = exp(fmin(x, 600.0));
    const double value = f->about * exp(fmin((x - 1.0) * f->narrow, 600.0));
    *slope = f->narrow * value;
    return value;
  }
  default: *slope = f->unit; return f->unit * x;
  }
}

double pendres_fit_moved(fit_free *f, double value, double by)
{
  double slope;
  const double x = encode(f, value) + by;
  return decode(f, f->form == FIT_SINE ? fmin(fmax(x, -0.5 * pi), 0.5 * pi) : x, &slope);
}

double pendres_fit_seen(fit_free *f, double value, double change, int open)
{
  double slope;
  (void)decode(f, encode(f, value), &slope);
  return fabs(change / slope) * (f->form == FIT_PLAIN ? 0.5 * open : 1.0);
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

/* Huber's loss of a row as the square of another residual, and how that grows with the row's. */
static double soften(const fit_problem *p, size_t row, double *slope)
{
  const double bend = p->terms.huber, r = p->rows.residual[row];
  *slope = 1.0;
  if (!(bend > 0.0 && fabs(r) > bend) || row >= pendres_fit_rows(p->m)) return r;
  const double soft = sqrt(bend * (2.0 * fabs(r) - bend));
  *slope = bend / soft;
  return copysign(soft, r);
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
  for (size_t i = 0; i < pendres_fit_all_rows(p); i++) p->lost |= !isfinite(p->rows.residual[i]);
  return !p->lost;
}

void pendres_fit_forget(fit_problem *p)
{
  for (size_t i = 0; i < p->m->curves; i++) p->m->curve[i].ready = 0;
  p->m->usual_steps = 0;
  p->known = 0;
}

double pendres_fit_sum_of_squares(const fit_problem *p)
{
  double sum = 0.0, slope;
  for (size_t i = 0; i < pendres_fit_all_rows(p); i++) sum += pow(soften(p, i, &slope), 2.0);
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
    gsl_vector_set(out, i, found ? soften(p, i, slope) : worst);
  return GSL_SUCCESS;
}

static int slopes(const gsl_vector *x, void *arg, gsl_matrix *out)
{
  fit_problem *p = arg;
  fit_values v;
  double slope[FIT_QUANTITIES], soft;
  values_of(p, x->data, v, slope);
  const int found = pendres_fit_evaluate(p, v);
  for (size_t i = 0; i < out->size1; i++) {
    (void)soften(p, i, &soft);
    for (size_t k = 0; k < out->size2; k++) {
      const double j = found ? p->rows.slope[i][p->free[k].quantity] * slope[k] * soft : 0.0;
      gsl_matrix_set(out, i, k, isfinite(j) ? j : 0.0);
    }
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
  int told = gsl_multifit_nlinear_init(&x.vector, &f, w);
  if (told == GSL_SUCCESS)
    told = gsl_multifit_nlinear_driver((size_t)iterations, fit_step_tolerance, fit_step_tolerance,
                                       0.0, NULL, NULL, &info, w);
  if (told == GSL_ENOMEM && p->status == PENDRES_OK)
    p->status = pendres_context_fail(p->m->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a fit");
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

/* What pulls at the values, and how stiffly: Huber's loss has a slope of its bend beyond it, and no
   curvature there, so that the data resist a change by the share of them that is within. */
static double pull_of(const fit_problem *p, size_t row)
{
  double slope;
  const double soft = soften(p, row, &slope);
  return soft * slope;
}

static double stiffness_of(const fit_problem *p)
{
  double within = 0.0, all = 0.0;
  if (!(p->terms.huber > 0.0)) return 1.0;
  for (size_t i = 0; i < pendres_fit_rows(p->m); i++) {
    if (p->rows.residual[i] == 0.0) continue; /* a row that is not used */
    all += 1.0;
    within += fabs(p->rows.residual[i]) <= p->terms.huber;
  }
  return all > 0.0 ? fmax(within, 1.0) / all : 1.0;
}

static double weight_of(const fit_problem *p, size_t row)
{
  return row < pendres_fit_rows(p->m) ? sqrt(p->stiffness) : 1.0;
}

/* The derivatives in a matrix, columns of length 1; those of quantities at a bound are 0. */
static void scale_columns(const fit_problem *p, gsl_matrix *j, double *length)
{
  for (size_t k = 0; k < p->unknowns; k++) {
    const int q = p->free[k].quantity;
    double sum = 0.0;
    for (size_t i = 0; i < j->size1; i++) {
      const double slope = p->rows.slope[i][q] * weight_of(p, i);
      gsl_matrix_set(j, i, k, slope);
      sum = hypot(sum, slope);
    }
    length[k] = sum;
    const int open = sum > 0.0 && !p->free[k].at_bound;
    for (size_t i = 0; i < j->size1; i++)
      gsl_matrix_set(j, i, k, open ? gsl_matrix_get(j, i, k) / sum : 0.0);
  }
}

/* Widen errors by a scatter of the data over the expected one, in squares; priors stay. */
static void scale_errors(const fit_problem *p, double scatter, fit_result *out)
{
  const size_t n = p->unknowns;
  double was[FIT_QUANTITIES * FIT_QUANTITIES], held;
  memcpy(was, out->covariance, n * n * sizeof *was);
  for (size_t a = 0; a < n; a++)
    for (size_t b = 0; b < n; b++) {
      out->covariance[a * n + b] *= scatter;
      for (size_t k = 0; k < n; k++) {
        held = p->free[k].prior_error > 0.0 ? pow(p->free[k].prior_error, -2.0) : 0.0;
        out->covariance[a * n + b] += (1.0 - scatter) * was[a * n + k] * held * was[k * n + b];
      }
    }
  out->scatter *= scatter;
}

double pendres_fit_probability(const fit_result *r)
{
  return r->freedom > 0.0 ? gsl_cdf_chisq_Q(fmax(r->chi_square, 0.0), r->freedom) : NAN;
}

/* Errors by how data scatter. With outliers they are the inverse of what resists, about what the
   data pull by chance (Huber and Ronchetti, Robust Statistics, section 7.6), and most of the data
   are none. Without, chi-square tells whether the errors of data are theirs. */
static void judge_scatter(const fit_problem *p, fit_result *out)
{
  double sum = 0.0, freedom = fmax(1.0, out->freedom);
  const int soft = p->terms.huber > 0.0;
  for (size_t i = 0; i < pendres_fit_rows(p->m); i++) sum += pow(pull_of(p, i), 2.0);
  out->scatter = 1.0;
  out->impossible = soft ? p->stiffness < fit_outliers
                         : p->errors_known && pendres_fit_probability(out) < fit_improbable;
  if (soft) scale_errors(p, sum / freedom / p->stiffness, out);
  else if (out->impossible) scale_errors(p, out->chi_square / freedom, out);
}

/* What the decomposition says: the covariance, and what may still be gained. */
static void read_decomposition(const fit_problem *p, const gsl_matrix *u, const gsl_matrix *v,
                               const gsl_vector *s, const double *length, fit_result *out)
{
  const size_t n = p->unknowns;
  const double least = fit_undetermined * gsl_vector_get(s, 0);
  memset(out->covariance, 0, n * n * sizeof *out->covariance);
  memset(out->spread, 0, n * sizeof *out->spread);
  out->remaining = 0.0;
  out->combinations = 0;
  out->determined = 1;
  for (size_t c = 0; c < n; c++) {
    const double size = gsl_vector_get(s, c);
    double part = 0.0, held = 0.0;
    for (size_t k = 0; k < n; k++)
      if (p->free[k].at_bound) held = fmax(held, fabs(gsl_matrix_get(v, k, c)));
    if (size <= least && held > 0.5) continue; /* the column of a quantity at its bound */
    fit_combination *to = &out->combination[out->combinations++];
    *to = (fit_combination){.open = size <= least};
    for (size_t i = 0; i < u->size1; i++)
      part += gsl_matrix_get(u, i, c) * pull_of(p, i) / weight_of(p, i);
    if (size > least) out->remaining += part * part;
    for (size_t a = 0; a < n; a++) {
      const double at = gsl_matrix_get(v, a, c);
      to->change[a] = length[a] > 0.0 ? at / length[a] : at;
      if (size > least) to->change[a] /= size;
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
  fit_combination *both = &out->combination[out->combinations++];
  *both = (fit_combination){.open = 1};
  both->change[damping] = out->v[PENDRES_DAMPING];
  both->change[gain] = out->v[PENDRES_FIT_AMPLITUDE_SCALE];
  out->spread[damping] = out->spread[gain] = INFINITY;
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
  p->stiffness = stiffness_of(p);
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
    judge_scatter(p, out);
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
