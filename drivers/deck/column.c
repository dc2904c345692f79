/*
 * column.c -- units of columns of data, as instruments write them; see deck.h.
 */
#include "deck/si/si.h"
#include "deck/deck.h"

#include <string.h>

/* Other names of units, in capitals; and those that are logarithms, by what 0 dB are: of amplitudes
   in volts their root mean squares. A milliwatt is that at 50 ohm, 0.775 V that at 600. */
static const struct { const char *name, *unit; } synonyms[] = {
  { "DEGREES", "deg" }, { "DEGREE", "deg" }, { "DEG", "deg" }, { "\302\260", "deg" },
  { "RADIANS", "rad" }, { "RADIAN", "rad" }, { "RAD", "rad" }, { "HZ", "Hz" }, { "KHZ", "kHz" },
  { "GHZ", "GHz" }, { "VRMS", "V" }, { "VOLTS", "V" }, { "VOLT", "V" }, { "SECONDS", "s" },
};
static const struct { const char *name; double zero; const char *unit; } decibels[] = {
  { "DB", 1.0, "" }, { "DBM", 0.22360679774997896, "V" }, { "DBV", 1.0, "V" },
  { "DBMV", 1e-3, "V" }, { "DBUV", 1e-6, "V" }, { "DBU", 0.7745966692414834, "V" },
};

enum {
  SYNONYMS = sizeof synonyms / sizeof *synonyms,
  DECIBELS = sizeof decibels / sizeof *decibels
};

static void capitals(const char *text, char out[SI_TEXT])
{
  size_t n = 0;
  for (; text[n] != '\0' && n + 1 < SI_TEXT; n++)
    out[n] = 'a' <= text[n] && text[n] <= 'z' ? (char)(text[n] - 'a' + 'A') : text[n];
  out[n] = '\0';
}

/* SI of one of a unit: in `to` if that is given, or in its base units. 0: it is no unit, -1: it
   does not fit. A frequency counts turns and a rate does not. */
static int read_linear(const char *text, const char *to, double *factor)
{
  char bad[SI_SYMBOL];
  si_unit from, base;
  if (!si_parse(text, &from, bad)) return 0;
  base = (si_unit){ .factor = 1.0, .turns = from.turns };
  memcpy(base.power, from.power, sizeof base.power);
  if (to != NULL && !si_parse(to, &base, bad)) return -1;
  if (!si_fits(&from, &base)) return -1;
  if (base.turns != 0 && from.power[SI_RAD] == 0) return -1;
  *factor = si_convert(1.0, &from, &base);
  return 1;
}

int deck_column_unit_read(const char *text, const char *of, deck_column_unit *out)
{
  char name[SI_TEXT];
  double factor = 1.0;
  *out = (deck_column_unit){ .factor = 1.0 };
  if (strcmp(text, "1") == 0 || strlen(text) >= SI_TEXT) return strcmp(text, "1") == 0;
  if (strcmp(text, "%") == 0) out->factor = 0.01;
  if (strcmp(text, "%") == 0) return of == NULL || of[0] == '\0' ? 1 : -1;
  capitals(text, name);
  for (int k = 0; k < DECIBELS; k++) {
    if (strcmp(name, decibels[k].name) != 0) continue;
    out->decibel = 1;
    out->milliwatt = k == 1;
    out->factor = decibels[k].zero;
    /* Decibels alone are of a ratio, whatever that is of. */
    if (of == NULL || decibels[k].unit[0] == '\0')
      return of == NULL || (strcmp(of, "rad") != 0 && strcmp(of, "Hz") != 0 && strcmp(of, "s") != 0)
               ? 1 : -1;
    const int fits = read_linear(decibels[k].unit, of, &factor);
    out->factor *= factor;
    return fits;
  }
  for (int k = 0; k < SYNONYMS; k++)
    if (strcmp(name, synonyms[k].name) == 0) text = synonyms[k].unit;
  return read_linear(text, of, &out->factor);
}
