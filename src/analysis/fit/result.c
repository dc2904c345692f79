/* result.c -- what a fit says; see call.h. */
#include "analysis/fit/call.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/names.h>

#include "base/angles.h"

void pendres_fit_free(pendres_fit *fit)
{
  if (fit == NULL) return;
  free(fit->value);
  free(fit->covariance);
  free(fit->point);
  free(fit->jump);
  free(fit);
}

static void note(pendres_fit *fit, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void note(pendres_fit *fit, const char *format, ...)
{
  va_list args;
  int at = 0;
  while (at < FIT_NOTES && fit->note[at][0] != '\0') at++;
  if (at == FIT_NOTES) return;
  va_start(args, format);
  (void)vsnprintf(fit->note[at], FIT_NOTE, format, args);
  va_end(args);
}

static void note_open(const fit_problem *p, const fit_result *best, const fit_combination *c,
                      pendres_fit *fit)
{
  char words[FIT_NOTE / 2] = "";
  double part[FIT_QUANTITIES], largest = 0.0;
  for (size_t k = 0; k < p->unknowns; k++) {
    const double v = fabs(best->v[p->free[k].quantity]);
    part[k] = c->change[k] / (v > 0.0 ? v : 1.0);
    largest = fmax(largest, fabs(part[k]));
  }
  for (size_t k = 0; k < p->unknowns; k++) {
    const size_t at = strlen(words);
    if (fabs(part[k]) > 1e-3 * largest)
      snprintf(words + at, sizeof words - at, "%s%s by %+.3g", at > 0 ? ", " : "",
               pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, p->free[k].quantity),
               part[k] / largest);
  }
  note(fit, "the data do not determine all unknowns: they stay as well fitted where these change "
       "together, as shares of their values: %s; fix one of them, or give it a prior", words);
}

/* Other values that fit about as well. */
static void note_twin(const fit_problem *p, pendres_fit *fit)
{
  char words[FIT_NOTE / 2] = "";
  for (size_t k = 0; k < p->unknowns; k++) {
    const int q = p->free[k].quantity;
    const size_t at = strlen(words);
    snprintf(words + at, sizeof words - at, "%s%s %.6g", at > 0 ? ", " : "",
             pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, q), p->twin[q] * p->m->unit[q]);
  }
  note(fit, "other values fit about as well (chi-square %+.2g): %s; a bound, a guess of all "
       "unknowns, or more data decide between them", p->twin_above, words);
}

/* Whether residuals of neighbours have the same sign more often than by chance. */
static double correlation_of(const fit_problem *p)
{
  double sum = 0.0, squares = 0.0;
  for (size_t k = 0; k < p->m->tracks; k++) {
    double last = NAN;
    for (size_t i = p->m->track[k].first; i < p->m->track[k].first + p->m->track[k].count; i++) {
      const double r = p->rows.residual[p->m->order[p->m->station[i].first]];
      if (!isnan(last)) {
        sum += r * last;
        squares += r * r * last * last;
      }
      last = r;
    }
  }
  return squares > 0.0 ? sum / sqrt(squares) : 0.0;
}

static void take_notes(const pendres_fit_call *c, const fit_problem *p, const fit_result *best,
                       pendres_fit *fit)
{
  const pendres_fit_summary *s = &fit->summary;
  for (size_t i = 0; i < best->combinations && !best->determined; i++)
    if (best->combination[i].open) note_open(p, best, &best->combination[i], fit);
  for (size_t k = 0; k < p->unknowns; k++)
    if (best->at_bound[k])
      note(fit, "%s is at its bound: its error is that of a value held there",
           pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, p->free[k].quantity));
  if (p->has_twin) note_twin(p, fit);
  if (!s->converged)
    note(fit, "the fit has not converged: chi-square may still fall by %.2g; begin nearer by, or "
         "fix some unknowns", s->remaining);
  if (c->errors_known && s->probability < fit_improbable)
    note(fit, "chi-square is %.4g with %g degrees of freedom, which chance gives with a "
         "probability of %.1g: the model, the errors of the data or the minimum are wrong%s",
         s->chi_square, s->degrees_of_freedom, s->probability,
         s->converged == 2 && !(c->options.huber > 0.0)
           ? "; errors are those by which it would be what is expected" : "");
  if (s->converged == 2 && c->options.huber > 0.0)
    note(fit, "more than half of the data are outliers: it is the fit that is off");
  if (p->excess > 1.0 + fit_excess / sqrt((double)p->m->stations))
    note(fit, "data scatter about the fit %.3g times as much as neighbours about each other: the "
         "model does not follow the data, or the fit is in a wrong minimum", p->excess);
  const double correlated = correlation_of(p);
  if (correlated > fit_correlated)
    note(fit, "residuals of neighbours are correlated (%.1f standard deviations): the model does "
         "not follow the data, or the fit is in a wrong minimum", correlated);
  size_t beyond = 0, unstable = 0;
  for (size_t i = 0; i < p->m->stations; i++) {
    const fit_station *t = &p->m->station[i];
    beyond += t->beyond[t->stage] != 0;
    unstable += !p->m->lane[t->lane[t->stage]].stable && !t->beyond[t->stage];
  }
  if (beyond > 0)
    note(fit, "%zu values of the axis lie where the model's state has ended already, or not yet "
         "begun: between the jumps of data and model", beyond);
  if (unstable > 0)
    note(fit, "%zu values of the axis lie where the model's orbit of one drive period does not "
         "attract: the oscillator is on another one there, which the fit does not know", unstable);
}

/* The number of an unknown among the free ones; -1: it is fixed. */
static long free_number(const pendres_fit_call *c, size_t unknown)
{
  long k = 0;
  if (c->model->unknown[unknown].fixed) return -1;
  for (size_t i = 0; i < unknown; i++) k += !c->model->unknown[i].fixed;
  return k;
}

static void take_covariance(const pendres_fit_call *c, const fit_problem *p, const fit_result *best,
                            pendres_fit *fit)
{
  for (size_t a = 0; a < c->model->unknowns; a++) {
    const int q = c->model->unknown[a].quantity;
    const long i = free_number(c, a);
    fit->value[a] = i < 0 ? c->model->unknown[a].guess : best->v[q] * p->m->unit[q];
    for (size_t b = 0; b < c->model->unknowns; b++) {
      const long k = free_number(c, b);
      double *to = &fit->covariance[a * c->model->unknowns + b];
      *to = i < 0 || k < 0 ? 0.0
                           : best->covariance[(size_t)i * p->unknowns + (size_t)k] * p->m->unit[q] *
                               p->m->unit[c->model->unknown[b].quantity];
      if (i >= 0 && a == b) *to += pow(best->spread[i] * p->m->unit[q], 2.0);
    }
  }
}

/* The standard error of what has these derivatives. */
static double error_of(const fit_problem *p, const fit_result *best, const fit_values slope)
{
  double sum = 0.0;
  for (size_t a = 0; a < p->unknowns; a++)
    for (size_t b = 0; b < p->unknowns; b++)
      sum += slope[p->free[a].quantity] * slope[p->free[b].quantity] *
             best->covariance[a * p->unknowns + b];
  return sqrt(fmax(0.0, sum));
}

static pendres_orbit_guess orbit_at(const fit_model *m, const pendres_u u)
{
  const pendres_pendulum at = pendres_map_pendulum(m->base.force, u);
  return (pendres_orbit_guess){.pendulum = at,
                               .x = u[PENDRES_U_Y] + pendres_model_of(at.force)->origin,
                               .v = u[PENDRES_U_W] * at.drive_frequency, .period = 1};
}

static void take_points(const fit_problem *p, const fit_result *best, pendres_fit *fit)
{
  const fit_model *m = p->m;
  for (size_t i = 0; i < m->stations; i++) {
    const fit_station *s = &m->station[i];
    const fit_lane *l = &m->lane[s->lane[s->stage]];
    for (size_t k = s->first; k < s->first + s->count; k++) {
      const size_t datum = m->order[k];
      const pendres_fit_datum *d = &m->datum[datum];
      fit_values slope;
      pendres_fit_point *to = &fit->point[datum];
      const double value =
        pendres_fit_observe(m, best->v, l, d->observable, l->border[2] == 1.0, slope);
      *to = (pendres_fit_point){.modelled = value, .residual = d->observed - value,
                                .modelled_error = error_of(p, best, slope),
                                .error = p->terms.error[datum], .part = s->stage,
                                .beyond = s->beyond[s->stage] != 0};
      if (d->observable == PENDRES_FIT_PHASE_LAG)
        to->residual = remainder(to->residual, 2.0 * PENDRES_PI);
      to->orbit = orbit_at(m, l->u);
    }
  }
}

/* Places that are data. The orbit of a jump is one on the state that ends there. */
static void take_marks(const fit_problem *p, const fit_result *best, pendres_fit *fit)
{
  const fit_model *m = p->m;
  for (size_t i = 0; i < m->marks; i++) {
    const fit_mark *mark = &m->mark[i];
    const fit_track *t = &m->track[mark->track];
    const fit_curve *c = &m->curve[t->curve];
    const fit_lane *l = &m->lane[mark->lane];
    const int stage = mark->stage < 0 ? 0 : mark->stage;
    const fit_piece *piece = &c->piece[t->piece[stage]];
    fit_values slope;
    pendres_fit_point *to = &fit->point[mark->datum];
    const double value = pendres_fit_place_at(m, best->v, l, slope);
    *to = (pendres_fit_point){
      .modelled = value, .modelled_error = error_of(p, best, slope),
      .residual = m->datum[mark->datum].observed - value, .error = p->terms.error[mark->datum],
      .part = stage,
      .orbit = orbit_at(m, mark->stage < 0 ? l->u : c->node[(piece->first + piece->last) / 2].u)};
  }
}

static void take_jumps(const fit_problem *p, const fit_result *best, pendres_fit *fit)
{
  const fit_model *m = p->m;
  for (size_t k = 0; k < m->tracks; k++) {
    const fit_track *t = &m->track[k];
    for (int j = 0; j + 1 < t->stages; j++) {
      const fit_curve *c = &m->curve[t->curve];
      const fit_piece *piece = &c->piece[t->piece[j]];
      const int fold = piece->fold[(piece->way > 0) == (t->direction > 0)];
      const fit_lane *l = &m->lane[c->fold[fold].lane];
      fit_values slope;
      if (l->gradual) continue;
      pendres_fit_jump *to = &fit->jump[fit->jumps++];
      to->value = pendres_fit_place_at(m, best->v, l, slope);
      to->value_error = error_of(p, best, slope);
      to->direction = t->direction;
      to->other = m->other != PENDRES_PARAMETER_COUNT ? c->other : NAN;
      size_t i = 0;
      while (i < t->count && m->station[t->first + i].stage <= j) i++;
      to->measured[0] = i > 0 ? m->station[t->first + i - 1].axis : NAN;
      to->measured[1] = i < t->count ? m->station[t->first + i].axis : NAN;
    }
  }
}

pendres_status pendres_fit_result(const pendres_fit_call *c, fit_problem *p, const fit_result *best)
{
  pendres_fit *fit = calloc(1, sizeof *fit);
  if (fit != NULL) {
    fit->unknowns = c->model->unknowns;
    fit->value = calloc(c->model->unknowns, sizeof *fit->value);
    fit->covariance = calloc(c->model->unknowns * c->model->unknowns, sizeof *fit->covariance);
    fit->point = calloc(p->m->data, sizeof *fit->point);
    fit->jump = calloc(p->m->tracks * FIT_STAGES, sizeof *fit->jump);
  }
  if (fit == NULL || fit->value == NULL || fit->covariance == NULL || fit->point == NULL ||
      fit->jump == NULL) {
    pendres_fit_free(fit);
    return pendres_context_fail(p->m->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a fit");
  }
  fit->summary = (pendres_fit_summary){
    .unknowns = p->unknowns, .data = p->m->data, .chi_square = best->chi_square,
    .degrees_of_freedom = best->freedom,
    .probability = c->errors_known ? pendres_fit_probability(best) : NAN,
    .remaining = best->remaining,
    .converged = best->converged, .determined = best->determined, .iterations = p->iterations,
    .evaluations = p->evaluations};
  take_covariance(c, p, best, fit);
  take_points(p, best, fit);
  take_marks(p, best, fit);
  take_jumps(p, best, fit);
  take_notes(c, p, best, fit);
  *c->out = fit;
  return best->converged == 1 ? PENDRES_OK : PENDRES_NOT_CONVERGED;
}

/* ---- reading ---- */

pendres_fit_summary pendres_fit_summary_get(const pendres_fit *fit)
{
  return fit != NULL ? fit->summary : (pendres_fit_summary){0};
}

double pendres_fit_value(const pendres_fit *fit, size_t unknown)
{
  return fit != NULL && unknown < fit->unknowns ? fit->value[unknown] : NAN;
}

double pendres_fit_covariance(const pendres_fit *fit, size_t a, size_t b)
{
  if (fit == NULL || a >= fit->unknowns || b >= fit->unknowns) return NAN;
  return fit->covariance[a * fit->unknowns + b];
}

const pendres_fit_point *pendres_fit_point_get(const pendres_fit *fit, size_t i)
{
  return fit != NULL && i < fit->summary.data ? &fit->point[i] : NULL;
}

const pendres_fit_jump *pendres_fit_jump_get(const pendres_fit *fit, size_t i)
{
  return fit != NULL && i < fit->jumps ? &fit->jump[i] : NULL;
}

const char *pendres_fit_note_get(const pendres_fit *fit, size_t i)
{
  return fit != NULL && i < FIT_NOTES && fit->note[i][0] != '\0' ? fit->note[i] : NULL;
}
