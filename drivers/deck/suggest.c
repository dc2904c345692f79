/*
 * suggest.c -- "did you mean": the nearest known word by optimal string alignment distance
 * (insertions, deletions, replacements and swaps of neighbours), and the symbols of the
 * literature for what decks spell out.
 */
#include "deck/namelist/lex.h"
#include "deck/table.h"

#include <string.h>

static size_t smaller(size_t a, size_t b)
{
  return a < b ? a : b;
}

/* Distance of two words shorter than DECK_NAME. */
static size_t distance(const char *a, size_t m, const char *b, size_t n)
{
  size_t row[3][DECK_NAME + 1];
  for (size_t j = 0; j <= n; j++) row[0][j] = j;
  for (size_t i = 1; i <= m; i++) {
    size_t *now = row[i % 3];
    const size_t *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
    now[0] = i;
    for (size_t j = 1; j <= n; j++) {
      const int same = lex_lower(a[i - 1]) == lex_lower(b[j - 1]);
      now[j] = smaller(smaller(last[j], now[j - 1]) + 1, last[j - 1] + !same);
      if (i > 1 && j > 1 && lex_lower(a[i - 1]) == lex_lower(b[j - 2]) &&
          lex_lower(a[i - 2]) == lex_lower(b[j - 1]))
        now[j] = smaller(now[j], before[j - 2] + 1);
    }
  }
  return row[m % 3][n];
}

void deck_suggest(deck_suggestion *s, const char *candidate)
{
  const size_t m = strlen(s->word), n = strlen(candidate);
  size_t d = 0;
  if (m == 0 || n == 0 || m >= DECK_NAME || n >= DECK_NAME) return;
  d = distance(s->word, m, candidate, n);
  /* A third of the letters may be wrong; a word that shares nothing is never near. */
  if (d > (m > n ? m : n) / 3 + (n < 3 ? 0 : (m > n ? m : n) < 6)) return;
  if (s->best != NULL && d >= s->distance) return;
  s->best = candidate;
  s->distance = d;
}

const char *deck_suggestion_text(const deck_suggestion *s, char *buffer, size_t size)
{
  buffer[0] = '\0';
  if (s->best != NULL) snprintf(buffer, size, " (did you mean '%s'?)", s->best);
  return buffer;
}

const char *deck_synonym(const char *word, size_t number)
{
  static const char *const pair[][2] = {
    { "gamma", "damping" },          { "friction", "damping" },
    { "omega", "drive_frequency" },  { "frequency", "drive_frequency" },
    { "omega_range", "drive_frequency_range" },
    { "gamma_range", "damping_range" },
    { "tau", "drive_period" },       { "period", "drive_period" },
    { "f0", "drive_amplitude" },     { "force", "drive_amplitude" },
    { "forcing", "drive_amplitude" }, { "drive", "drive_amplitude" },
    { "t", "temperature" },          { "kt", "temperature" },
    { "tol", "tolerance" },          { "rtol", "tolerance" },
    { "n", "members" },              { "lanes", "block_lanes" },
    { "steps", "steps_per_period" }, { "file", "output" },
    { "name", "title" },             { "scene", "kind" },
    { "methods", "method" },         { "tolerances", "tolerance" },
    { "f0", "natural_frequency" },   { "plasma_frequency", "natural_frequency" },
    { "stiffness", "force_coefficients" },
    { "k", "force_coefficients" },   { "k3", "force_coefficients" },
    { "q", "damping" },              { "quality_factor", "damping" },
    { "current", "torque" },         { "ic", "critical_current" },
    { "i_c", "critical_current" },   { "responsivity", "volts_per_length" },
    { "quality", "damping" },        { "amplitude", "drive_amplitude" },
    { "duffing", "polynomial" },     { "helmholtz", "polynomial" },
    { "junction", "pendulum" },      { "josephson", "pendulum" },
  };
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++)
    if (strcmp(word, pair[i][0]) == 0 && number-- == 0) return pair[i][1];
  return NULL;
}
