/*
 * fit.c -- entries of &fit, such as 'damping 0.01 0.1' and 'a3 1e14 1e12 N/m^3', what makes SI of
 * the quantities of a fit, and whether all of it agrees. See deck.h.
 */
#include "deck/si/si.h"
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/fit.h>
#include <pendres/names.h>

static const char between[] = " \t,:=";

/* ---- units --------------------------------------------------------------------------------- */

static int is_of(const char *entry, const char *name)
{
  const char *at = entry + strspn(entry, between);
  const size_t n = strcspn(at, between);
  return strlen(name) == n && strncmp(at, name, n) == 0;
}

static int has_entry(const deck_names *entries, const char *name)
{
  for (size_t i = 0; i < entries->count; i++)
    if (is_of(entries->name[i], name)) return 1;
  return 0;
}

int deck_fit_has(const deck *d, const char *name)
{
  return has_entry(&d->fit.free, name) || has_entry(&d->fit.fixed, name);
}

int deck_fit_si(const deck *d, const char *name, deck_si *out)
{
  /* Readings are of lengths, unless velocities are measured. */
  const int turns = d->data.observables.count > 0 &&
                    strstr(d->data.observables.name[0], "velocity") != NULL;
  const char *of_readings = turns ? "mean_velocity" : "amplitude";
  const int line = d->fit.model[0] != '\0';
  const int reading =
    !line && (strcmp(name, "offset") == 0 || strncmp(name, "background_", 11) == 0);
  deck_si of;
  if (reading && deck_fit_has(d, "amplitude_scale")) return 0;
  if (reading) return deck_si_of(d, of_readings, out);
  if (strcmp(name, "drive_scale") == 0) return deck_si_of(d, "drive_amplitude", out);
  if (strcmp(name, "torque_scale") == 0) return deck_si_of(d, "torque", out);
  if (strcmp(name, "delay") == 0 && !isnan(d->units.natural_frequency)) {
    *out = (deck_si){ .factor = 1.0 / d->units.natural_frequency, .units = "s" };
    return 1;
  }
  if (strcmp(name, "frequency_scale") == 0 || strcmp(name, "phase_offset") == 0) return 0;
  if (strcmp(name, "amplitude_scale") != 0) return deck_si_of(d, name, out);
  if (!deck_si_of(d, of_readings, &of)) return 0;
  *out = (deck_si){ .factor = 1.0 / of.factor };
  snprintf(out->units, sizeof out->units, "%.20s-1", of.units);
  return 1;
}

/* ---- entries ------------------------------------------------------------------------------- */

/* A unit behind the numbers: what they are to be divided by. 0, with `why`: it does not fit. */
static int read_unit(const deck *d, const char *name, const char *text, double *factor,
                     char why[DECK_FIT_WHY])
{
  char bad[SI_SYMBOL];
  si_unit from, to;
  deck_si si;
  if (!si_parse(text, &from, bad)) {
    snprintf(why, DECK_FIT_WHY, "'%.20s' is no unit", bad);
    return 0;
  }
  if (!deck_fit_si(d, name, &si)) {
    snprintf(why, DECK_FIT_WHY, "&units do not tell what '%s' is in SI: leave '%.20s' out or "
             "complete &units", name, text);
    return 0;
  }
  if (!si_parse(si.units, &to, bad) || !si_fits(&from, &to)) {
    snprintf(why, DECK_FIT_WHY, "'%s' is in %s here: '%.20s' does not fit", name, si.units, text);
    return 0;
  }
  *factor = si_convert(1.0, &from, &to) / si.factor;
  return 1;
}

int deck_fit_entry(const deck *d, const char *text, const char *form, deck_fit_value *out,
                   char why[DECK_FIT_WHY])
{
  size_t count = 0;
  double factor = 1.0;
  char *end;
  for (const char *c = form; *c != '\0'; c++) count += *c == ' ';
  const char *at = text + strspn(text, between);
  size_t n = strcspn(at, between);
  *out = (deck_fit_value){ .number = { NAN, NAN } };
  snprintf(out->name, sizeof out->name, "%.*s", (int)n, at);
  snprintf(why, DECK_FIT_WHY, "'%s' is not of the form '%s', with numbers and perhaps their unit",
           text, form);
  at += n;
  for (size_t i = 0; i < count; i++) {
    at += strspn(at, between);
    out->number[i] = strtod(at, &end);
    if (end == at || !isfinite(out->number[i])) return 0;
    at = end;
  }
  at += strspn(at, between);
  if (*at != '\0' && !read_unit(d, out->name, at, &factor, why)) return 0;
  for (size_t i = 0; i < count; i++) out->number[i] *= factor;
  return 1;
}

/* ---- checks -------------------------------------------------------------------------------- */

static int is_quantity(const char *name)
{
  return pendres_name_find(PENDRES_NAMES_FIT_QUANTITY, name) > (int)PENDRES_DRIVE_FREQUENCY;
}

static void check_entries(deck_builder *b, const char *key, const deck_names *entries,
                          const char *form)
{
  const deck_given *at = deck_given_of(b, "fit", key);
  const deck *d = b->d;
  const int fixes = entries == &d->fit.fixed;
  for (size_t i = 0; i < entries->count; i++) {
    const char *text = entries->name[i];
    char why[DECK_FIT_WHY];
    deck_fit_value v;
    int before = 0;
    const int good = deck_fit_entry(d, text, form, &v, why);
    for (size_t k = 0; k < i; k++) before |= is_of(entries->name[k], v.name);
    if (!is_quantity(v.name))
      deck_complain(b, at, key, "'%s': '%s' begins with no quantity of a fit (docs/fit.md)", key,
                    text);
    else if (!good) deck_complain(b, at, key, "'%s': %s", key, why);
    else if (before) deck_complain(b, at, key, "'%s' has '%s' twice", key, v.name);
    else if (fixes && has_entry(&d->fit.free, v.name))
      deck_complain(b, at, key, "'%s' is in 'free' too: leave out one of the two", v.name);
    else if (!fixes && !has_entry(&d->fit.free, v.name))
      deck_complain(b, at, key, "'%s' is of what is free: name '%s' in 'free', or leave it out",
                    key, v.name);
    else if (strcmp(key, "bounds") == 0 && !(v.number[0] < v.number[1]))
      deck_complain(b, at, key, "'bounds': the lower one of '%s' must be below the upper", text);
    else if (strcmp(key, "prior") == 0 && !(v.number[1] > 0.0))
      deck_complain(b, at, key, "'prior': the standard error of '%s' must be above 0", text);
  }
}

static void refuse_scale(deck_builder *b, const char *name, const char *told)
{
  const char *key = has_entry(&b->d->fit.free, name) ? "free" : "fixed";
  if (deck_fit_has(b->d, name))
    deck_complain(b, deck_given_of(b, "fit", key), key,
                  "'%s' is what '%s' in &units tells: leave out one of the two", name, told);
}

void deck_check_fit(deck_builder *b)
{
  const deck *d = b->d;
  if (d->kind != DECK_FIT) return;
  deck_column_unit unit;
  for (size_t i = 0; i < d->data.units.count; i++)
    if (!deck_column_unit_read(d->data.units.name[i], NULL, &unit))
      deck_complain(b, deck_given_of(b, "data", "units"), "units", "'units': '%s' is no unit; '1' "
                    "is that of a number", d->data.units.name[i]);
  int lines = 0;
  for (size_t i = 0; i < d->data.observables.count; i++)
    lines |= strcmp(d->data.observables.name[i], "s_parameter") == 0;
  if (lines != (d->fit.model[0] != '\0') || (lines && d->data.observables.count > 1))
    deck_complain(b, deck_given_of(b, "fit", "model"), "model", "the observable 's_parameter', "
                  "alone, goes with a 'model' in &fit: 'transmission', 'notch' or 'reflection'");
  check_entries(b, "fixed", &d->fit.fixed, "NAME VALUE");
  check_entries(b, "bounds", &d->fit.bounds, "NAME LOW HIGH");
  check_entries(b, "prior", &d->fit.prior, "NAME MEAN ERROR");
  if (!isnan(d->units.natural_frequency)) refuse_scale(b, "frequency_scale", "natural_frequency");
  if (!isnan(d->units.critical_current)) refuse_scale(b, "torque_scale", "critical_current");
  if (!isnan(d->units.volts_per_length)) refuse_scale(b, "amplitude_scale", "volts_per_length");
}
