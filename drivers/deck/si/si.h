/*
 * si.h -- units as laboratories write them: 'MHz', 'N/m^3', 'pN', 'm s-2'.
 *
 * Owns: the table of symbols and prefixes, and what one unit is in another. Which quantity a key
 * or a result is, and what one of the model's own units is in SI, is the business of quantity.c.
 * Thread safe: no state outside the arguments.
 */
#ifndef DECK_SI_H
#define DECK_SI_H

#include <stddef.h>

/* A radian is a base here, so that an angular frequency and a rate are told apart where that
   matters; comparisons leave it out. */
enum { SI_KG, SI_M, SI_S, SI_A, SI_K, SI_RAD, SI_BASES };

/* One of a unit is factor 10^ten (2 pi)^turns of the base units to these powers. Powers of ten and
   of 2 pi stand apart, so that a number of MHz becomes one of Hz with one rounding, or none. */
typedef struct si_unit {
  double factor;
  int ten, turns;
  int power[SI_BASES];
} si_unit;

enum { SI_SYMBOL = 24, SI_TEXT = 64 };

/*
 * Read products and quotients of symbols with prefixes and powers, less than SI_TEXT bytes: blanks,
 * '*' or '.' multiply, '/' divides by the next symbol; powers as in m^3, m3 and m³. Returns 1, or 0
 * with the part that is no unit in `bad`.
 */
int si_parse(const char *text, si_unit *out, char bad[SI_SYMBOL]);

/* Whether they measure the same quantity; radians are numbers. */
int si_fits(const si_unit *a, const si_unit *b);

/* That many of a unit, in another one that fits. */
double si_convert(double value, const si_unit *from, const si_unit *to);

/* Whether readers expect a prefix: of MHz and pN m, but not of 1/s and rad. */
int si_takes_prefix(const char *units);

/* The prefix with which a number is easiest to read, "M" of 1.2e6, and its power of ten, which the
   number is to be divided by. */
const char *si_prefix_for(double value, double *ten);

/* Call for every symbol, with and without prefixes: for suggestions. */
void si_each(void (*call)(void *of, const char *symbol), void *of);

/* Constants of the SI of 2019, which are exact: Boltzmann's, and the flux quantum over 2 pi. */
#define SI_BOLTZMANN 1.380649e-23
#define SI_FLUX (6.62607015e-34 / (2.0 * 3.14159265358979323846) / (2.0 * 1.602176634e-19))

#endif
