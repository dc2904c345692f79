/*
 * quantity.c -- what one of the model's units of a kind of quantities is in SI, and numbers with
 * units in decks. See deck.h (deck_si_of) and table.h.
 *
 * All follows from the scales that a deck has in &units (scales.c), which are at most those of
 * time, length, mass or current. A model's unit of time is 1/(2 pi natural_frequency).
 */
#include "deck/namelist/lex.h"
#include "deck/si/si.h"
#include "deck/table.h"

#include <math.h>
#include <string.h>

/* ---- what one of the model's units is ------------------------------------------------------ */

/* NaN: the deck does not tell. `told`: positions and velocities as the deck wants to see them;
   otherwise as lengths or angles. */
typedef struct scales {
  double rate, position, velocity, force, energy;
  const char *x, *v, *f;
} scales;

static scales scales_of_angle(const deck *d, int told)
{
  const double f0 = d->units.natural_frequency, current = d->units.critical_current;
  const double weight = d->units.mass * d->units.gravity * d->units.length;
  scales s = { .rate = 2.0 * PENDRES_PI * f0, .position = 1.0, .velocity = 2.0 * PENDRES_PI * f0,
               .force = weight, .energy = weight, .x = "rad", .v = "rad s-1", .f = "N m" };
  if (isnan(current)) return s;
  s.force = current;
  s.energy = SI_FLUX * current;
  s.f = "A";
  if (!told) return s;
  s.velocity = SI_FLUX * s.rate;
  s.v = "V";
  return s;
}

static scales scales_of(const deck *d, int told)
{
  if (pendres_model_of(d->pendulum.force)->angle) return scales_of_angle(d, told);
  const double rate = 2.0 * PENDRES_PI * d->units.natural_frequency, length = d->units.length;
  scales s = { .rate = rate, .position = length, .velocity = length * rate,
               .force = d->units.mass * rate * rate * length, .x = "m", .v = "m s-1", .f = "N" };
  s.energy = s.force * length;
  if (isnan(d->units.volts_per_length) || !told) return s;
  s.position *= d->units.volts_per_length;
  s.velocity *= d->units.volts_per_length;
  s.x = "V";
  s.v = "V s-1";
  return s;
}

static deck_si si(double factor, const char *units, const char *more)
{
  deck_si out = { .factor = factor };
  snprintf(out.units, sizeof out.units, "%s%s%s", units, more[0] != '\0' ? " " : "", more);
  return out;
}

/* Of coefficient k of a polynomial; those of other forces are numbers. */
static deck_si si_of_coefficient(const deck *d, int k)
{
  const scales s = scales_of(d, 0);
  char per[16];
  if (d->pendulum.force != PENDRES_FORCE_POLYNOMIAL) return si(NAN, "", "");
  double factor = s.force;
  for (int i = 0; i < k; i++) factor /= s.position;
  snprintf(per, sizeof per, "m-%d", k);
  return si(factor, s.f, per);
}

/* Of a kind other than that of what is swept. */
static deck_si si_of_own(const deck *d, pendres_kind kind, int told)
{
  const scales s = scales_of(d, told);
  char square[32];
  if (kind >= PENDRES_KIND_A1 && kind <= PENDRES_KIND_A5)
    return si_of_coefficient(d, (int)(kind - PENDRES_KIND_A1) + 1);
  switch (kind) {
  case PENDRES_KIND_POSITION: return si(s.position, s.x, "");
  case PENDRES_KIND_VELOCITY: return si(s.velocity, s.v, "");
  case PENDRES_KIND_RATE: return si(s.rate, "s-1", "");
  case PENDRES_KIND_FREQUENCY: return si(d->units.natural_frequency, "Hz", "");
  case PENDRES_KIND_TIME: return si(1.0 / s.rate, "s", "");
  case PENDRES_KIND_FORCE: return si(s.force, s.f, "");
  case PENDRES_KIND_ENERGY: return si(s.energy, "J", "");
  case PENDRES_KIND_POWER: return si(s.energy * s.rate, "W", "");
  case PENDRES_KIND_TEMPERATURE: return si(s.energy / SI_BOLTZMANN, "K", "");
  case PENDRES_KIND_VARIANCE_X: return si(s.position * s.position, s.x, s.x);
  case PENDRES_KIND_COVARIANCE: return si(s.position * s.velocity, s.x, s.v);
  case PENDRES_KIND_VARIANCE_V: return si(s.velocity * s.velocity, s.v, s.v);
  case PENDRES_KIND_NONLINEAR_DAMPING:
    snprintf(square, sizeof square, "%s-2", s.x);
    return si(s.rate / (s.position * s.position), "s-1", square);
  case PENDRES_KIND_QUADRATIC_DAMPING:
    snprintf(square, sizeof square, "%s-1", s.x);
    return si(1.0 / s.position, square, "");
  case PENDRES_KIND_CUBIC_DAMPING:
    snprintf(square, sizeof square, "%s-2", s.x);
    return si(1.0 / (s.position * s.position * s.rate), "s", square);
  case PENDRES_KIND_SPECTRUM:
    snprintf(square, sizeof square, "%s Hz-1", s.v);
    return si(s.velocity * s.velocity / d->units.natural_frequency, s.v, square);
  default: return si(NAN, "", "");
  }
}

/* A damping by the force that it makes at a velocity: kg/s, N m s, and of a junction 1/ohm; others
   by that at powers of velocity and displacement: kg/m, kg/(m^2 s). */
static deck_si si_of_drag(const deck *d, pendres_kind kind)
{
  const scales s = scales_of(d, !isnan(d->units.critical_current));
  const int speeds = kind == PENDRES_KIND_QUADRATIC_DAMPING ? 2
                     : kind == PENDRES_KIND_CUBIC_DAMPING   ? 3
                                                            : 1;
  const int lengths = kind == PENDRES_KIND_NONLINEAR_DAMPING ? 2 : 0;
  char per[32];
  double factor = s.force;
  for (int i = 0; i < speeds; i++) factor /= s.velocity;
  for (int i = 0; i < lengths; i++) factor /= s.position;
  if (strcmp(s.v, "V") == 0) snprintf(per, sizeof per, "V-%d", speeds);
  else snprintf(per, sizeof per, "s%d %s-%d", speeds, s.x, speeds + lengths);
  return si(factor, s.f, per);
}

static int is_drag(pendres_kind kind)
{
  return kind == PENDRES_KIND_RATE || kind == PENDRES_KIND_NONLINEAR_DAMPING ||
         kind == PENDRES_KIND_QUADRATIC_DAMPING || kind == PENDRES_KIND_CUBIC_DAMPING;
}

/* What a deck sweeps, also while it is read and its axes have no values yet. */
static deck_axis_id swept_of(const deck *d)
{
  deck_axis_id axis[DECK_AXES];
  if (deck_axes(d, axis) > 0) return axis[0];
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    if (d->axis[i].listed_count + d->axis[i].range_count > 1) return (deck_axis_id)i;
  return DECK_AXIS_COUNT;
}

static deck_si si_of_kind(const deck *d, pendres_kind kind, int told)
{
  if (kind == PENDRES_KIND_SWEPT) kind = deck_axis_kind(swept_of(d));
  return si_of_own(d, kind, told);
}

const char *deck_unit_example(const deck_key *key)
{
  static const char *const example[PENDRES_KIND_COUNT] = {
    [PENDRES_KIND_POSITION] = "'2 nm'", [PENDRES_KIND_VELOCITY] = "'3 mm/s'",
    [PENDRES_KIND_RATE] = "'Q 5000'", [PENDRES_KIND_FREQUENCY] = "'1.2 MHz'",
    [PENDRES_KIND_TIME] = "'5 us'", [PENDRES_KIND_FORCE] = "'3 pN'",
    [PENDRES_KIND_TEMPERATURE] = "'300 K'", [PENDRES_KIND_SWEPT] = "'3 Hz'",
    [PENDRES_KIND_A1] = "'3 N/m^3'", [PENDRES_KIND_A2] = "'3 N/m^3'",
    [PENDRES_KIND_NONLINEAR_DAMPING] = "'3 kg/m^2/s'",
    [PENDRES_KIND_QUADRATIC_DAMPING] = "'3 kg/m'", [PENDRES_KIND_CUBIC_DAMPING] = "'3 kg s/m^2'",
    [PENDRES_KIND_A3] = "'3 N/m^3'", [PENDRES_KIND_A4] = "'3 N/m^3'",
    [PENDRES_KIND_A5] = "'3 N/m^3'",
  };
  return key->type == DECK_NUMBERS ? "'50 N/m'" : example[deck_table_words(key)->kind];
}

int deck_has_units(const deck *d)
{
  return !isnan(d->units.natural_frequency) || !isnan(d->units.length) ||
         !isnan(d->units.critical_current);
}

int deck_si_of_kind(const deck *d, pendres_kind kind, deck_si *out)
{
  if (!deck_has_units(d)) return 0;
  *out = si_of_kind(d, kind, 1);
  return isfinite(out->factor);
}

int deck_si_of(const deck *d, const char *name, deck_si *out)
{
  const pendres_quantity *q = pendres_quantity_of(name);
  return q != NULL && deck_si_of_kind(d, q->kind, out);
}

deck_si deck_si_prefixed(const deck_si *si, double value)
{
  deck_si out = *si;
  double ten = 1.0;
  const int slow = strcmp(si->units, "Hz") == 0 && 0.1 <= fabs(value) && fabs(value) < 1.0;
  if (!si_takes_prefix(si->units) || slow) return out; /* 0.8 Hz, as of a pendulum, and not mHz */
  snprintf(out.units, sizeof out.units, "%s%.30s", si_prefix_for(value, &ten), si->units);
  out.factor /= ten;
  return out;
}

/* ---- numbers with units in decks ----------------------------------------------------------- */

enum { TEXT = SI_TEXT };

/* Bytes of a number at the start of a text. */
static size_t number_length(const char *t)
{
  size_t n = *t == '+' || *t == '-', digits = 0;
  for (; lex_is_digit(t[n]) || t[n] == '.'; n++) digits += t[n] != '.';
  if (digits == 0) return 0;
  const int letter = lex_lower(t[n]);
  if (letter != 'e' && letter != 'd') return n;
  const size_t sign = t[n + 1] == '+' || t[n + 1] == '-';
  if (!lex_is_digit(t[n + 1 + sign])) return n;
  for (n += 1 + sign; lex_is_digit(t[n]);) n++;
  return n;
}

/* A value in its parts: 'Q 5000' and '1.2 MHz'. */
typedef struct parts {
  char text[TEXT];
  size_t number, length; /* where the number stands in it */
  const char *unit;      /* behind it; "Q" */
} parts;

static int take_apart(const namelist *nl, const namelist_value *v, parts *out)
{
  namelist_errors unused = { 0 };
  const int bare = v->form == NAMELIST_BARE && nl->order > 0;
  if (v->length >= TEXT || (v->form != NAMELIST_STRING && !bare)) return 0;
  const int good = namelist_value_string(nl, v, "", out->text, TEXT, &unused);
  namelist_errors_free(&unused);
  if (!good) return 0;
  size_t at = strspn(out->text, " ");
  const int quality = out->text[at] == 'Q';
  if (quality) at += 1 + strspn(out->text + at + 1, " =");
  out->number = at;
  out->length = number_length(out->text + at);
  out->unit = out->text + at + out->length;
  out->unit += strspn(out->unit, " ");
  if (quality && *out->unit == '\0') out->unit = "Q";
  else if (quality) return 0;
  return out->length > 0 && *out->unit != '\0';
}

int deck_value_has_unit(const namelist *nl, const namelist_value *v)
{
  parts p;
  return take_apart(nl, v, &p);
}

/* The number, by the reader of numbers. */
static int read_number(deck_builder *b, const namelist_value *v, const char *name, const parts *p,
                       double *out)
{
  namelist_value number = *v;
  number.form = NAMELIST_BARE;
  number.begin += p->number + (v->form == NAMELIST_STRING);
  number.length = p->length;
  return namelist_value_real(b->nl, &number, name, out, b->errors);
}

typedef struct nearest {
  deck_suggestion s;
  char best[SI_SYMBOL];
  int same; /* nonzero: only symbols with the same first letter, since M and m are two prefixes */
} nearest;

static void offer(void *of, const char *symbol)
{
  nearest *n = of;
  if (n->same && symbol[0] != n->s.word[0]) return;
  deck_suggest(&n->s, symbol);
  if (n->s.best != symbol) return;
  snprintf(n->best, sizeof n->best, "%s", symbol);
  n->s.best = n->best;
}

static int parse_unit(deck_builder *b, const namelist_value *v, const char *name,
                      const char *text, si_unit *out)
{
  char bad[SI_SYMBOL], hint[100];
  if (si_parse(text, out, bad)) return 1;
  nearest near = { .s = { .word = bad }, .same = 1 };
  si_each(offer, &near);
  near.same = 0;
  if (near.s.best == NULL) si_each(offer, &near);
  namelist_error_at(b->nl, v->at, b->errors, "'%s': '%s' is no unit%s", name, bad,
                    deck_suggestion_text(&near.s, hint, sizeof hint));
  return 0;
}

static int refuse_unit(deck_builder *b, const namelist_value *v, const char *name,
                       const char *units, const char *text)
{
  namelist_error_at(b->nl, v->at, b->errors, "'%s' is in %s here: '%s' does not fit", name, units,
                    text);
  return 0;
}

static int refuse_any(deck_builder *b, const namelist_value *v, const char *name)
{
  namelist_error_at(b->nl, v->at, b->errors, "'%s' takes numbers without a unit here", name);
  return 0;
}

/* What &units must have for it. */
static int refuse_scale(deck_builder *b, const namelist_value *v, const char *name,
                        const char *text)
{
  const int angle = pendres_model_of(b->d->pendulum.force)->angle;
  namelist_error_at(b->nl, v->at, b->errors, "'%s' in %s needs more of &units: %s", name, text,
                    angle ? "'natural_frequency' or 'length', for torques 'mass' and 'length'; of "
                            "a junction 'critical_current' and 'capacitance'"
                          : "'mass' or 'natural_frequency', with 'force_coefficients' in SI or a "
                            "'length'; for forces 'mass' in any case");
  return 0;
}

/* 'Q 5000': the damping at which small oscillations have that quality factor. */
static int read_quality(deck_builder *b, const namelist_value *v, const char *name, double q,
                        double *out)
{
  const pendres_pendulum *p = &b->d->pendulum;
  const double stiffness = p->force == PENDRES_FORCE_PENDULUM      ? 1.0
                           : p->force == PENDRES_FORCE_POLYNOMIAL ? p->force_coefficients[0]
                                                                  : NAN;
  *out = sqrt(stiffness) / q;
  if (stiffness > 0.0 && q > 0.0) return 1;
  namelist_error_at(b->nl, v->at, b->errors, q > 0.0
                    ? "'%s': a quality factor needs a force that pulls back to x = 0, with the "
                      "coefficient a1 in 'force_coefficients'; give the damping in 1/s"
                    : "'%s': a quality factor is positive", name);
  return 0;
}

/* The unit that a key of &units has itself. */
static int read_scale(deck_builder *b, const namelist_value *v, const deck_key *key,
                      const parts *p, double *out)
{
  si_unit from, to;
  char bad[SI_SYMBOL];
  if (!parse_unit(b, v, key->name, p->unit, &from)) return 0;
  if (!si_parse(key->unit, &to, bad) || !si_fits(&from, &to))
    return refuse_unit(b, v, key->name, key->unit, p->unit);
  *out = si_convert(*out, &from, &to);
  return 1;
}

int deck_quantity_read(deck_builder *b, const deck_key *key, const namelist_value *v,
                       const char *name, double *out)
{
  parts p;
  si_unit from, to;
  char bad[SI_SYMBOL];
  const pendres_kind kind = deck_table_words(key)->kind;
  if (!take_apart(b->nl, v, &p) || !read_number(b, v, name, &p, out)) return 0;
  if (strcmp(key->group, "units") == 0) return read_scale(b, v, key, &p, out);
  if (b->no_scales) return 0;
  if (strcmp(p.unit, "Q") == 0 && kind == PENDRES_KIND_RATE)
    return read_quality(b, v, name, *out, out);
  if (!parse_unit(b, v, name, p.unit, &from)) return 0;
  const deck_si seen = si_of_kind(b->d, kind, 1);
  const deck_si plain = is_drag(kind) ? si_of_drag(b->d, kind) : si_of_kind(b->d, kind, 0);
  const deck_si *in = &seen;
  const int of_clock = strstr(seen.units, "Hz") != NULL;
  if (seen.units[0] == '\0') return refuse_any(b, v, name);
  if (!si_parse(seen.units, &to, bad)) return 0;
  if (!si_fits(&from, &to)) {
    in = &plain;
    if (!si_parse(plain.units, &to, bad)) return 0;
  }
  /* The force of an angle is a torque or a current, as the scales tell. */
  const int open =
    kind == PENDRES_KIND_FORCE && strcmp(in->units, "N m") == 0 && isnan(in->factor);
  if ((!si_fits(&from, &to) && !open) || (of_clock && from.power[SI_RAD] == 0))
    return refuse_unit(b, v, name, of_clock ? "Hz or rad/s" : seen.units, p.unit);
  if (isnan(in->factor)) return refuse_scale(b, v, name, p.unit);
  *out = si_convert(*out, &from, &to) / in->factor;
  return 1;
}

int deck_coefficient_read(deck_builder *b, const deck_key *key, const namelist_value *v, int k)
{
  parts p;
  si_unit from, to;
  char bad[SI_SYMBOL], units[16];
  double x = 0.0;
  const int ring = b->d->pendulum.force == PENDRES_FORCE_SQUID;
  if (!take_apart(b->nl, v, &p) || !read_number(b, v, key->name, &p, &x)) return 0;
  if (!parse_unit(b, v, key->name, p.unit, &from)) return 0;
  if (!ring && b->d->pendulum.force != PENDRES_FORCE_POLYNOMIAL) return refuse_any(b, v, key->name);
  snprintf(units, sizeof units, "N m-%d", k);
  if (!si_parse(ring ? "H" : units, &to, bad) || !si_fits(&from, &to)) {
    snprintf(bad, sizeof bad, "a%d", k);
    return refuse_unit(b, v, bad, ring ? "H" : units, p.unit);
  }
  b->in_si[k - 1] = si_convert(x, &from, &to);
  return 1;
}
