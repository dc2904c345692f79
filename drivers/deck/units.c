/*
 * units.c -- defaults and limits of a deck that are lengths, times or rates: they follow the
 * pendulum's own units (pendres_units_of), which of a polynomial may be of any size.
 */
#include "deck/table.h"

/* Bring a default, of `count` numbers, into the deck's units; what was given is. An axis of this
   name has no default. */
static void bring(const deck_builder *b, const char *group, const char *name, double unit,
                  double *value, int count)
{
  int range = 0;
  const size_t row = deck_table_find(group, name, b->scene, &range);
  if (row == deck_table_size || range || b->given[row].given || b->given[row].broken) return;
  for (int i = 0; i < count; i++) value[i] *= unit;
}

/* Where starts lie is given, or follows the response. */
static void bring_starts(const deck_builder *b)
{
  const pendres_ensemble e = deck_starts(b->d);
  deck *d = b->d;
  if (!deck_in_scene(b, "ensemble", "members")) return;
  if (!deck_is_there(deck_given_of(b, "ensemble", "x_first"))) d->ensemble.x_first = e.x_first;
  if (!deck_is_there(deck_given_of(b, "ensemble", "x_last"))) d->ensemble.x_last = e.x_last;
}

void deck_bring_defaults(deck_builder *b)
{
  deck *d = b->d;
  const pendres_units u = deck_pendulum_units(d);
  bring_starts(b);
  bring(b, "lyapunov_map", "x", u.length, &d->orbit.x, 1);
  bring(b, "sweep", "drive_frequency_range", 1.0 / u.time, d->search, 2);
  bring(b, "sweep", "resonance_range", 1.0 / u.time, d->search, 2);
  bring(b, "precision", "tolerance", u.length, &d->precision.tolerance, 1);
}

void deck_check_tolerance(deck_builder *b)
{
  const double length = deck_pendulum_units(b->d).length;
  const double tolerance = b->d->precision.tolerance / length;
  const deck_given *at = deck_given_of(b, "precision", "tolerance");
  if (!deck_in_scene(b, "precision", "tolerance") || at->broken) return;
  if (tolerance >= 1e-13 && tolerance <= 1e-2) return;
  deck_complain(b, at, "tolerance",
                "'tolerance' must lie between %.3g and %.3g%s: less is beyond double precision",
                1e-13 * length, 1e-2 * length,
                length == 1.0 ? "" : ", 1e-13 and 0.01 of the pendulum's unit of length");
}
