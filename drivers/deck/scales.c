/*
 * scales.c -- the group &units: from what a laboratory knows of its oscillator to the scales of
 * time, length, mass or current, and the force's coefficients in these. See docs/units.md.
 *
 * All that is derived goes into the deck's own fields, and what it was derived from leaves them:
 * the resolved deck has natural_frequency, length and mass or critical_current alone, from which
 * the same conversions follow to the last bit.
 */
#include "deck/si/si.h"
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* m s-2, the standard of 1901. */
#define STANDARD_GRAVITY 9.80665

static int told(const deck_builder *b, const char *name)
{
  return deck_given_of(b, "units", name)->given;
}

/* Of a key of &units. */
static void complain(deck_builder *b, const char *name, const char *message)
{
  deck_complain(b, deck_given_of(b, "units", name), name, "'%s' %s", name, message);
}

/* ---- polynomials --------------------------------------------------------------------------- */

/* Coefficient k times length^(k - 1). */
static double stiffness_at(const deck_builder *b, int k, double length)
{
  double a = fabs(b->in_si[k - 1]);
  for (int i = 1; i < k; i++) a *= length;
  return a;
}

/* The length at which two coefficients make the same force: a's and that of power `higher` more. */
static double length_of(double a, double higher_a, int higher)
{
  const double ratio = a / fabs(higher_a);
  return higher == 2 ? sqrt(ratio) : pow(ratio, 1.0 / higher);
}

/* Lowest and highest coefficient in SI; 0: there is none. */
static void find_ends(const deck_builder *b, int *low, int *high)
{
  *low = *high = 0;
  for (int k = 1; k <= PENDRES_FORCE_POWERS; k++) {
    if (isnan(b->in_si[k - 1]) || b->in_si[k - 1] == 0.0) continue;
    if (*low == 0) *low = k;
    *high = k;
  }
}

/* Convert the coefficients; those that scales were derived from are 1 or -1 exactly. */
static void set_coefficients(deck_builder *b, const int *one)
{
  deck *d = b->d;
  const double rate = 2.0 * PENDRES_PI * d->units.natural_frequency;
  for (int k = 1; k <= PENDRES_FORCE_POWERS; k++) {
    if (isnan(b->in_si[k - 1])) continue;
    double a = k == 1 ? fabs(b->in_si[0]) : stiffness_at(b, k, d->units.length);
    a /= d->units.mass * rate * rate;
    d->pendulum.force_coefficients[k - 1] = copysign(one[k - 1] ? 1.0 : a, b->in_si[k - 1]);
  }
}

static void find_polynomial(deck_builder *b)
{
  deck *d = b->d;
  double *f0 = &d->units.natural_frequency, *mass = &d->units.mass, *length = &d->units.length;
  const int has_time = told(b, "natural_frequency"), has_mass = told(b, "mass");
  const int has_length = told(b, "length");
  int low, high, one[PENDRES_FORCE_POWERS] = { 0 };
  const deck_given *at = deck_given_of(b, "pendulum", "force_coefficients");
  find_ends(b, &low, &high);
  if (low == 0) return;
  if (has_time && has_mass && low == 1) {
    complain(b, "natural_frequency", "follows from 'mass' and the stiffness a1 in "
             "'force_coefficients' already: leave out one of the three");
    return;
  }
  if (!has_time && !has_mass) {
    deck_complain(b, at, "force_coefficients", "'force_coefficients' in SI need 'mass' or "
                  "'natural_frequency' in &units");
    return;
  }
  if (has_time && has_mass && !has_length && high > 1) {
    const double rate = 2.0 * PENDRES_PI * *f0;
    *length = length_of(*mass * rate * rate, b->in_si[high - 1], high - 1);
    one[high - 1] = 1;
  } else if (!has_length && low < high) {
    *length = length_of(fabs(b->in_si[low - 1]), b->in_si[high - 1], high - low);
    one[high - 1] = 1;
  }
  if (isnan(*length) && high > 1) {
    deck_complain(b, at, "force_coefficients", "one coefficient in SI gives no unit of length: "
                  "give 'length' in &units, the displacement that is to be 1");
    return;
  }
  if (!has_time || !has_mass) {
    const double stiffness = stiffness_at(b, low, *length);
    if (!has_time) *f0 = sqrt(stiffness / *mass) / (2.0 * PENDRES_PI);
    else *mass = stiffness / (2.0 * PENDRES_PI * *f0) / (2.0 * PENDRES_PI * *f0);
    one[low - 1] = 1;
  }
  set_coefficients(b, one);
}

/* ---- angles -------------------------------------------------------------------------------- */

static void find_junction(deck_builder *b)
{
  deck *d = b->d;
  double *f0 = &d->units.natural_frequency, *capacitance = &d->units.capacitance;
  const double current = d->units.critical_current;
  if (told(b, "capacitance") && told(b, "natural_frequency")) {
    complain(b, "natural_frequency", "follows from 'critical_current' and 'capacitance' already: "
             "leave out one of the three");
    return;
  }
  if (told(b, "capacitance"))
    *f0 = sqrt(current / (SI_FLUX * *capacitance)) / (2.0 * PENDRES_PI);
  const double rate = 2.0 * PENDRES_PI * *f0;
  if (told(b, "resistance") && isnan(rate)) {
    complain(b, "resistance", "gives a damping only with 'capacitance' or 'natural_frequency'");
    return;
  }
  /* 1/(R C rate), where C = current / (flux rate^2). */
  if (told(b, "resistance"))
    b->damping = SI_FLUX * rate / (current * d->units.resistance);
  if (!isnan(b->in_si[0])) d->pendulum.force_coefficients[0] = SI_FLUX / (b->in_si[0] * current);
  d->units.capacitance = d->units.resistance = NAN;
}

static void find_pendulum(deck_builder *b)
{
  deck *d = b->d;
  if (told(b, "gravity") && !told(b, "length")) complain(b, "gravity", "goes with 'length'");
  else if (told(b, "mass") && !told(b, "length"))
    complain(b, "mass", "goes with 'length', the distance from the axis to the centre of mass");
  else if (told(b, "natural_frequency") && told(b, "length") && !told(b, "mass"))
    complain(b, "length", "tells the natural frequency too, or with 'mass' the torques of a rigid "
             "pendulum: leave out 'natural_frequency' or give 'mass'");
  if (!told(b, "length")) return;
  if (!told(b, "gravity")) d->units.gravity = STANDARD_GRAVITY;
  if (!told(b, "natural_frequency"))
    d->units.natural_frequency =
      sqrt(d->units.gravity / d->units.length) / (2.0 * PENDRES_PI);
  if (!told(b, "mass")) d->units.length = d->units.gravity = NAN;
}

/* ---- all ----------------------------------------------------------------------------------- */

/* Which models a scale belongs to. */
enum { LENGTHS = 1, PENDULUMS = 2, JUNCTIONS = 4 };
static const struct { const char *name, *whose; int of; } scales[] = {
  { "mass", "an oscillator's or a pendulum's", LENGTHS | PENDULUMS },
  { "length", "an oscillator's or a pendulum's", LENGTHS | PENDULUMS },
  { "gravity", "a pendulum's", PENDULUMS },
  { "volts_per_length", "that of a force without angles", LENGTHS },
  { "critical_current", "a junction's, whose force is 'pendulum' or 'squid'", JUNCTIONS },
  { "resistance", "a junction's: it goes with 'critical_current'", JUNCTIONS },
  { "capacitance", "a junction's: it goes with 'critical_current'", JUNCTIONS },
};

/* Refuse scales of other models. */
static void check_model(deck_builder *b, int model)
{
  for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
    char message[100];
    if (!told(b, scales[i].name) || (scales[i].of & model) != 0) continue;
    snprintf(message, sizeof message, "is %s, and has no meaning for this deck", scales[i].whose);
    complain(b, scales[i].name, message);
  }
}

/* Scales and coefficients that follow have the range of those that are told. */
static void check_size(deck_builder *b)
{
  const deck *d = b->d;
  const double of[] = { d->units.natural_frequency, d->units.mass, d->units.length };
  int good = 1, range = 0;
  const deck_key *mass = &deck_table[deck_table_find("units", "mass", 0, &range)];
  for (size_t i = 0; i < sizeof of / sizeof *of; i++)
    good &= isnan(of[i]) || (of[i] > 0.0 && of[i] < mass->high);
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    good &= fabs(d->pendulum.force_coefficients[k]) <= mass->high;
  if (!good)
    deck_complain_of_group(b, deck_given_of(b, "units", "mass")->group,
                           "what follows from these scales must be below 1e100, as they are");
}

static int is_broken(const deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (b->given[i].broken && (strcmp(key->group, "units") == 0 ||
                               strcmp(key->name, "force") == 0 ||
                               strcmp(key->name, "force_coefficients") == 0))
      return 1;
  }
  return 0;
}

void deck_scales_find(deck_builder *b)
{
  deck *d = b->d;
  const size_t errors = b->errors->count;
  b->no_scales = is_broken(b);
  if (b->no_scales) return;
  const int angle = pendres_model_of(d->pendulum.force)->angle;
  const int junction = angle && told(b, "critical_current");
  check_model(b, !angle ? LENGTHS : junction ? JUNCTIONS : PENDULUMS);
  if (!angle) find_polynomial(b);
  else if (junction) find_junction(b);
  else find_pendulum(b);
  /* The inductance of a ring. */
  if (angle && !junction && !isnan(b->in_si[0]) && b->errors->count == errors)
    deck_complain(b, deck_given_of(b, "pendulum", "force_coefficients"), "force_coefficients",
                  "an inductance needs 'critical_current' in &units");
  if (b->errors->count == errors) check_size(b);
  b->no_scales = b->errors->count > errors;
}

void deck_scales_damping(deck_builder *b)
{
  const deck_given *sweep = deck_given_of(b, "sweep", "damping");
  const deck_given *fixed = deck_given_of(b, "pendulum", "damping");
  int range = 0;
  const size_t row = deck_table_find("pendulum", "damping", b->scene, &range);
  if (isnan(b->damping)) return;
  if (deck_is_there(fixed) || deck_is_there(sweep)) {
    complain(b, "resistance", "tells the damping, and so does 'damping': leave out one of the two");
    return;
  }
  if (row == deck_table_size) return;
  b->given[row].given = 1;
  const deck_key *key = &deck_table[row];
  if (key->type == DECK_REAL) {
    memcpy((char *)b->d + key->offset, &b->damping, sizeof b->damping);
    return;
  }
  deck_axis *axis = &b->d->axis[key->axis];
  axis->listed = malloc(sizeof *axis->listed);
  if (axis->listed == NULL) {
    b->out_of_memory = 1;
    return;
  }
  axis->listed[0] = b->damping;
  axis->listed_count = 1;
}
