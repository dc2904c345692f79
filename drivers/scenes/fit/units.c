/*
 * units.c -- a laboratory's units in fits: with &units data are in SI, and go into the model's
 * own units when they have been read; see data.h.
 *
 * What is in an instrument's unit stays in it: drives beside a drive_scale that is sought or told,
 * torques beside a torque_scale, and readings beside an amplitude_scale.
 */
#include <math.h>
#include <string.h>

#include "scenes/fit/data.h"

/* ---- which unit ---------------------------------------------------------------------------- */

int fit_units_of_data(const deck *d, pendres_parameter p, deck_si *out)
{
  if (p == PENDRES_PARAMETER_COUNT)
    return fit_is_decay(d) && deck_si_of_kind(d, PENDRES_KIND_TIME, out);
  if (p == PENDRES_DRIVE_AMPLITUDE && deck_fit_has(d, "drive_scale")) return 0;
  if (p == PENDRES_TORQUE && deck_fit_has(d, "torque_scale")) return 0;
  return deck_si_of_kind(d, pendres_parameter_of(p)->kind, out);
}

int fit_units_of_observable(const deck *d, pendres_fit_observable o, deck_si *out)
{
  if (fit_is_place(o)) return fit_units_of_data(d, fit_axis(d), out);
  const int is_reading = o != PENDRES_FIT_PHASE_LAG && o != PENDRES_FIT_LOOP_AREA &&
                         !fit_is_line(d);
  if (o == PENDRES_FIT_VELOCITY || o == PENDRES_FIT_ACCELERATION)
    return o == PENDRES_FIT_VELOCITY && !deck_fit_has(d, "amplitude_scale") &&
           deck_si_of(d, "mean_velocity", out);
  return is_reading ? deck_fit_si(d, "offset", out)
                    : deck_si_of(d, pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)o), out);
}

/* ---- data ---------------------------------------------------------------------------------- */

static double factor_of(int known, const deck_si *si)
{
  return known ? si->factor : 1.0;
}

void fit_units_take(fit_work *w)
{
  deck_si si;
  const double axis = factor_of(fit_units_of_data(w->d, w->data.of.axis, &si), &si);
  const int two = w->data.of.other != PENDRES_PARAMETER_COUNT;
  const double other = factor_of(two && fit_units_of_data(w->d, w->data.of.other, &si), &si);
  for (size_t i = 0; i < w->data.of.n; i++) {
    pendres_fit_datum *d = &w->data.datum[i];
    const double unit = factor_of(fit_units_of_observable(w->d, d->observable, &si), &si);
    d->axis /= axis;
    d->other /= other;
    d->observed /= unit;
    d->error /= unit;
  }
}

/* ---- results ------------------------------------------------------------------------------- */

void fit_units_mark(const fit_work *w)
{
  static const char *const of_axis[] = { "datum_axis", "branch_axis", "branch_axis_error",
                                         "jump_parameter", "jump_parameter_error",
                                         "jump_measured_from", "jump_measured_to", NULL };
  static const char *const of_other[] = { "datum_other", "branch_other", "jump_other", NULL };
  static const char *const of_data[] = { "observed", "observed_error", "modelled",
                                         "modelled_error", "residual", "residual_error", NULL };
  const char *const *const names[] = { of_axis, of_other, of_data };
  deck_si si[3], next;
  int known[3] = { fit_units_of_data(w->d, w->data.of.axis, &si[0]),
                   w->data.of.other != PENDRES_PARAMETER_COUNT &&
                     fit_units_of_data(w->d, w->data.of.other, &si[1]),
                   fit_units_of_observable(w->d, w->data.datum[0].observable, &si[2]) };
  /* Several observables stand in one variable, which has a unit only if all have the same. */
  for (size_t i = 1; i < w->data.of.n && known[2]; i++)
    known[2] = fit_units_of_observable(w->d, w->data.datum[i].observable, &next) &&
               strcmp(next.units, si[2].units) == 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; known[k] && names[k][i] != NULL; i++)
      scene_mark_si(w->run, "", names[k][i], &si[k]);
}
