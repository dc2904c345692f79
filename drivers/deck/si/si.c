/* si.c -- units as laboratories write them; see si.h. */
#include "deck/si/si.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deck/namelist/lex.h"

#define PI 3.14159265358979323846

static const struct {
  const char *name;
  si_unit unit;
} symbols[] = {
  /*                     kg  m  s  A  K rad */
  { "g",   { 1.0, -3, 0, { 1, 0, 0, 0, 0, 0 } } },
  { "m",   { 1.0, 0, 0, { 0, 1, 0, 0, 0, 0 } } },
  { "s",   { 1.0, 0, 0, { 0, 0, 1, 0, 0, 0 } } },
  { "A",   { 1.0, 0, 0, { 0, 0, 0, 1, 0, 0 } } },
  { "K",   { 1.0, 0, 0, { 0, 0, 0, 0, 1, 0 } } },
  { "rad", { 1.0, 0, 0, { 0, 0, 0, 0, 0, 1 } } },
  { "deg", { PI / 180.0, 0, 0, { 0, 0, 0, 0, 0, 1 } } },
  { "Hz",  { 1.0, 0, 1, { 0, 0, -1, 0, 0, 1 } } },
  { "N",   { 1.0, 0, 0, { 1, 1, -2, 0, 0, 0 } } },
  { "J",   { 1.0, 0, 0, { 1, 2, -2, 0, 0, 0 } } },
  { "eV",  { 1.602176634, -19, 0, { 1, 2, -2, 0, 0, 0 } } },
  { "W",   { 1.0, 0, 0, { 1, 2, -3, 0, 0, 0 } } },
  { "V",   { 1.0, 0, 0, { 1, 2, -3, -1, 0, 0 } } },
  { "ohm", { 1.0, 0, 0, { 1, 2, -3, -2, 0, 0 } } },
  { "Ohm", { 1.0, 0, 0, { 1, 2, -3, -2, 0, 0 } } },
  { "\316\251", { 1.0, 0, 0, { 1, 2, -3, -2, 0, 0 } } },     /* a Greek capital omega, ... */
  { "\342\204\246", { 1.0, 0, 0, { 1, 2, -3, -2, 0, 0 } } }, /* ... and the sign for the unit */
  { "S",   { 1.0, 0, 0, { -1, -2, 3, 2, 0, 0 } } },
  { "F",   { 1.0, 0, 0, { -1, -2, 4, 2, 0, 0 } } },
  { "H",   { 1.0, 0, 0, { 1, 2, -2, -2, 0, 0 } } },
};

static const struct {
  const char *name;
  int ten;
} prefixes[] = {
  { "z", -21 }, { "a", -18 }, { "f", -15 }, { "p", -12 }, { "n", -9 }, { "u", -6 }, { "m", -3 },
  { "", 0 }, { "k", 3 }, { "M", 6 }, { "G", 9 }, { "T", 12 },
  /* Not for printing: the two signs for micro, and centi. */
  { "\302\265", -6 }, { "\316\274", -6 }, { "c", -2 },
};

enum {
  SYMBOLS = sizeof symbols / sizeof *symbols,
  PREFIXES = sizeof prefixes / sizeof *prefixes,
  PRINTED = 12, /* prefixes that are printed */
  HIGHEST = 9   /* power of a symbol: more is a slip of the pen */
};

/* A symbol of n bytes, with or without a prefix. */
static int find(const char *text, size_t n, si_unit *out)
{
  for (int k = 0; k < SYMBOLS; k++)
    if (strlen(symbols[k].name) == n && memcmp(symbols[k].name, text, n) == 0) {
      *out = symbols[k].unit;
      return 1;
    }
  for (int p = 0; p < PREFIXES; p++) {
    const size_t m = strlen(prefixes[p].name);
    if (m == 0 || m >= n || memcmp(prefixes[p].name, text, m) != 0) continue;
    for (int k = 0; k < SYMBOLS; k++) {
      if (strlen(symbols[k].name) != n - m || memcmp(symbols[k].name, text + m, n - m) != 0)
        continue;
      *out = symbols[k].unit;
      out->ten += prefixes[p].ten;
      return 1;
    }
  }
  return 0;
}

static void multiply(si_unit *by, const si_unit *unit, int power)
{
  for (int i = 0; i < abs(power); i++) {
    if (power > 0) by->factor *= unit->factor;
    else by->factor /= unit->factor;
  }
  by->ten += power * unit->ten;
  by->turns += power * unit->turns;
  for (int k = 0; k < SI_BASES; k++) by->power[k] += power * unit->power[k];
}

static int is_letter(char c)
{
  return lex_is_letter((unsigned char)c) || ((unsigned char)c & 0x80) != 0;
}

/* "^-3", "-3", "3" or nothing, which is 1; 0: too high to be meant, or none behind a sign. */
static int read_power(const char **text)
{
  const char *t = *text;
  int sign = 1, power = 0;
  if (*t == '^') t++;
  if (*t == '-' || *t == '+') sign = *t++ == '-' ? -1 : 1;
  if (!lex_is_digit(*t)) return t == *text;
  for (; lex_is_digit(*t) && power <= HIGHEST; t++) power = 10 * power + (*t - '0');
  *text = t;
  return power <= HIGHEST ? sign * power : 0;
}

/* What has a place in print has one on the keyboard: superscripts and the dot between symbols. */
static void type(const char *text, char *out, size_t room)
{
  static const struct { const char *printed; char typed; } characters[] = {
    { "\302\271", '1' }, { "\302\262", '2' }, { "\302\263", '3' }, { "\342\201\264", '4' },
    { "\342\201\265", '5' }, { "\342\201\266", '6' }, { "\342\201\273", '-' },
    { "\302\267", '.' }, { "\342\213\205", '.' },
  };
  size_t n = 0;
  while (*text != '\0' && n + 1 < room) {
    size_t k = 0, length = 1;
    while (k < sizeof characters / sizeof *characters &&
           strncmp(text, characters[k].printed, strlen(characters[k].printed)) != 0)
      k++;
    const int known = k < sizeof characters / sizeof *characters;
    if (known) length = strlen(characters[k].printed);
    out[n++] = known ? characters[k].typed : *text;
    text += length;
  }
  out[n] = '\0';
}

int si_parse(const char *printed, si_unit *out, char bad[SI_SYMBOL])
{
  char typed[SI_TEXT];
  const char *text = typed;
  int divides = 0;
  *out = (si_unit){ .factor = 1.0 };
  type(printed, typed, sizeof typed);
  for (text += strspn(text, " "); *text != '\0'; text += strspn(text, " ")) {
    const char *start = text;
    si_unit unit = { .factor = 1.0 };
    size_t n = 0;
    if (*text == '*' || *text == '.' || *text == '/') {
      divides = *text++ == '/';
      continue;
    }
    while (is_letter(text[n])) n++;
    /* A one in front of a slash, as in 1/s. */
    const int one = n == 0 && *text == '1' && !lex_is_digit(text[1]);
    text += one ? 1 : n;
    const int known = one || (n > 0 && find(start, n, &unit));
    const int power = known ? read_power(&text) : 0;
    if (power == 0) {
      snprintf(bad, SI_SYMBOL, "%.*s", (int)(n > 0 && !known ? n : strcspn(start, " */")), start);
      return 0;
    }
    multiply(out, &unit, divides ? -power : power);
    divides = 0;
  }
  snprintf(bad, SI_SYMBOL, "%s", divides ? "/" : "");
  return !divides;
}

int si_fits(const si_unit *a, const si_unit *b)
{
  return memcmp(a->power, b->power, SI_RAD * sizeof *a->power) == 0;
}

/* Powers of ten are exact up to 10^22. */
static double times_ten(double x, int ten)
{
  double power = 1.0;
  for (int i = 0; i < abs(ten); i++) power *= 10.0;
  return ten < 0 ? x / power : x * power;
}

double si_convert(double value, const si_unit *from, const si_unit *to)
{
  double x = times_ten(value, from->ten - to->ten);
  if (from->factor != to->factor) x = x * from->factor / to->factor;
  for (int k = to->turns; k < from->turns; k++) x *= 2.0 * PI;
  for (int k = from->turns; k < to->turns; k++) x /= 2.0 * PI;
  return x;
}

int si_takes_prefix(const char *units)
{
  return strncmp(units, "rad", 3) != 0 && strpbrk(units, "0123456789") == NULL;
}

const char *si_prefix_for(double value, double *ten)
{
  int best = 0;
  for (int p = 1; p < PRINTED; p++)
    if (fabs(value) >= times_ten(1.0, prefixes[p].ten)) best = p;
  if (!(fabs(value) > 0.0) || !isfinite(value)) best = 7;
  *ten = times_ten(1.0, prefixes[best].ten);
  return prefixes[best].name;
}

void si_each(void (*call)(void *of, const char *symbol), void *of)
{
  char name[SI_SYMBOL];
  for (int k = 0; k < SYMBOLS; k++)
    for (int p = 0; p < PREFIXES; p++) {
      snprintf(name, sizeof name, "%s%s", prefixes[p].name, symbols[k].name);
      call(of, name);
    }
}
