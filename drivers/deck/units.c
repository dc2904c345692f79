/*
 * units.c -- defaults and limits of a deck that are lengths, times or rates: they follow the
 * pendulum's own units (pendres_units_of), which of a polynomial may be of any size.
 */
#include "deck/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The value of an axis that is largest in size; `fixed` where nothing varies it. */
static double largest(const deck *d, deck_axis_id id, double fixed)
{
  const deck_axis *axis = &d->axis[id];
  double most = axis->count > 0 ? 0.0 : fixed;
  for (size_t i = 0; i < axis->count; i++)
    if (fabs(axis->value[i]) > fabs(most)) most = axis->value[i];
  return isnan(most) ? 0.0 : most;
}

pendres_units deck_pendulum_units(const deck *d)
{
  pendres_pendulum p = deck_pendulum(d);
  p.damping = largest(d, DECK_AXIS_DAMPING, p.damping);
  p.drive_amplitude = largest(d, DECK_AXIS_DRIVE_AMPLITUDE, p.drive_amplitude);
  p.torque = largest(d, DECK_AXIS_TORQUE, p.torque);
  return pendres_units_of(&p);
}

/* A key's row in this scene, and whether the deck gives it; NULL if the scene has no such key. */
static const deck_given *given(const deck_builder *b, const char *group, const char *name)
{
  int range = 0;
  const size_t row = deck_table_find(group, name, b->scene, &range);
  return row < deck_table_size ? &b->given[row] : NULL;
}

/* Bring a default into the deck's units; what was given is. */
static void bring(const deck_builder *b, const char *group, const char *name, double unit,
                  double *value)
{
  const deck_given *at = given(b, group, name);
  if (at != NULL && !at->given && !at->broken) *value *= unit;
}

void deck_check_units(deck_builder *b)
{
  deck *d = b->d;
  const pendres_units u = deck_pendulum_units(d);
  bring(b, "ensemble", "x_first", u.length, &d->ensemble.x_first);
  bring(b, "ensemble", "x_last", u.length, &d->ensemble.x_last);
  bring(b, "lyapunov_map", "x", u.length, &d->orbit.x);
  for (int i = 0; i < 2; i++) {
    bring(b, "sweep", d->kind == DECK_RESONANCE_CURVE ? "drive_frequency_range" : "resonance_range",
          1.0 / u.time, &d->search[i]);
  }
  bring(b, "precision", "tolerance", u.length, &d->precision.tolerance);
  const deck_given *at = given(b, "precision", "tolerance");
  const double tolerance = d->precision.tolerance / u.length;
  if (at == NULL || !at->given || (tolerance >= 1e-13 && tolerance <= 1e-2)) return;
  char message[240];
  snprintf(message, sizeof message,
           "'tolerance' must lie between %.3g and %.3g%s: less is beyond double precision",
           1e-13 * u.length, 1e-2 * u.length,
           u.length == 1.0 ? "" : ", 1e-13 and 0.01 of the pendulum's unit of length");
  namelist_error_at(at->nl != NULL ? at->nl : b->nl,
                    (namelist_place){at->line, at->column, (int)strlen("tolerance")}, b->errors,
                    "%s", message);
}
