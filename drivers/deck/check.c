/*
 * check.c -- what concerns several keys of a deck at once: keys that are missing or exclude
 * each other, the size of it all; for axes and forces see check_axes.c.
 */
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- missing keys -------------------------------------------------------------------------- */

/* Whether a key was given, with a good value or a bad one, or the key that may replace it: an axis
   in &sweep and its value in &pendulum replace each other. */
static int was_tried(const deck_builder *b, size_t row)
{
  const deck_key *key = &deck_table[row];
  const int value = strcmp(key->group, "pendulum") == 0;
  if (b->given[row].given || b->given[row].broken) return 1;
  /* A resistance makes the damping, once what is wrong with it is mended. */
  if (strcmp(key->name, "damping") == 0 && deck_given_of(b, "units", "resistance")->broken)
    return 1;
  if (!value && key->type != DECK_SWEEP) return 0;
  const deck_given *other = deck_given_of(b, value ? "sweep" : "pendulum", key->name);
  return other->given || other->broken;
}

/* Report a group that is absent altogether by one message, which names all keys that are
   missing. */
static void report_missing_group(deck_builder *b, size_t row)
{
  const char *group = deck_table[row].group;
  char list[300] = "", message[500];
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, group) != 0 || (key->needed & b->scene) == 0 || was_tried(b, i))
      continue;
    if (i < row) return; /* reported before */
    snprintf(list + strlen(list), sizeof list - strlen(list), "%s'%s'", list[0] == '\0' ? "" : ", ",
             key->name);
  }
  snprintf(message, sizeof message, "scene '%s' needs a group &%s with %s",
           deck_kind_name(b->d->kind), group, list);
  deck_complain_of_group(b, NULL, message);
}

static void check_missing(deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    const namelist_group *group = b->given[i].group;
    if ((key->needed & b->scene) == 0 || was_tried(b, i)) continue;
    if (group == NULL) {
      report_missing_group(b, i);
    } else if (!group->broken) {
      char message[300];
      const int has_range = deck_table_has_range(key);
      snprintf(message, sizeof message,
               has_range ? "scene '%s' needs '%s' or '%s_range' in &%s"
                         : "scene '%s' needs '%s'%.0s in &%s",
               deck_kind_name(b->d->kind), key->name, key->name, key->group);
      deck_complain_of_group(b, group, message);
    }
  }
}

/* ---- keys that exclude or need each other -------------------------------------------------- */

/* Whether the axis is another one than drive and damping, so that the drive has its place in
   &pendulum. */
static int other_is_swept(const deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (deck_table[i].type == DECK_SWEEP && strcmp(deck_table[i].name, "damping") != 0 &&
        b->given[i].given && deck_in_scene(b, "pendulum", "drive_period"))
      return 1;
  return 0;
}

/* Exactly one of drive frequency and drive period, both in the same group. */
static void check_drive(deck_builder *b, const char *group)
{
  const deck_given *w = deck_given_of(b, group, "drive_frequency");
  const deck_given *t = deck_given_of(b, group, "drive_period");
  const deck_given *w2 = deck_given_of(b, "pendulum", "drive_frequency");
  const deck_given *t2 = deck_given_of(b, "pendulum", "drive_period");
  const deck_given *frequency = w->given || w->broken ? w : w2;
  const deck_given *period = t->given || t->broken ? t : t2;
  const namelist_group *place = w->group;
  const int have_frequency = frequency->given || frequency->broken;
  const int have_period = period->given || period->broken;
  if (deck_is_there(frequency) && deck_is_there(period)) {
    const namelist_place f = frequency->at, p = period->at;
    const int last = f.line > p.line || (f.line == p.line && f.column > p.column);
    const deck_given *later = last ? frequency : period;
    deck_complain(b, later, later == period ? "drive_period" : "drive_frequency",
                  "give either 'drive_frequency' or 'drive_period', not both");
  } else if (!have_frequency && !have_period && (place == NULL || !place->broken)) {
    char message[200];
    const int fixed = strcmp(group, "sweep") == 0 && other_is_swept(b);
    snprintf(message, sizeof message,
             "scene '%s' needs 'drive_frequency' or 'drive_period' in &%s%s",
             deck_kind_name(b->d->kind), fixed ? "pendulum or &" : "", group);
    deck_complain_of_group(b, place, message);
  }
}

static void resolve_drive(deck_builder *b)
{
  deck *d = b->d;
  if (deck_in_scene(b, "sweep", "drive_period")) {
    check_drive(b, "sweep");
    return;
  }
  if (!deck_in_scene(b, "pendulum", "drive_period")) return;
  check_drive(b, "pendulum");
  d->by_period = deck_given_of(b, "pendulum", "drive_period")->given;
  deck_derive_clock(d);
}

/* An axis has its values in &sweep, or its only value in &pendulum. */
static void check_axis_sources(deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, "pendulum") != 0 || (key->scenes & b->scene) == 0) continue;
    const deck_given *sweep = deck_given_of(b, "sweep", key->name);
    if (!deck_is_there(&b->given[i]) || !deck_is_there(sweep)) continue;
    namelist_error_at(b->given[i].nl, deck_place_of(&b->given[i], key->name),
                      b->errors, "'%s' is given in &sweep too (line %d): leave out one of the two",
                      key->name, sweep->at.line);
  }
}

/* The group that has a key in this scene; "" if there is none. */
static const char *group_of(const deck_builder *b, const char *name)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if ((deck_table[i].scenes & b->scene) != 0 && strcmp(deck_table[i].name, name) == 0)
      return deck_table[i].group;
  return "";
}

/* Check keys that have an effect only together with others. */
static void check_idle_keys(deck_builder *b)
{
  const char *name = b->d->kind == DECK_ESCAPE ? "from" : "start", *group = group_of(b, name);
  const deck_given *start = deck_given_of(b, group, name);
  const deck_given *x = deck_given_of(b, group, "x");
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    const char *why = deck_when_of(key->when)->why;
    if (!b->given[i].given || why == NULL) continue;
    if (key->when == DECK_WITH_NOISE && deck_given_of(b, "sweep", "temperature")->broken) continue;
    if (key->when == DECK_WITHOUT_START && start->broken) continue;
    if (deck_key_applies(key, b->d)) continue;
    namelist_error_at(b->given[i].nl, deck_place_of(&b->given[i], key->name),
                      b->errors, "'%s' is not used: %s", key->name, why);
  }
  if (deck_in_scene(b, group, name) && b->d->orbit.start[0] == '\0' && !start->broken &&
      !x->given && !x->broken && (x->group == NULL || !x->group->broken)) {
    char message[200];
    snprintf(message, sizeof message,
             "scene '%s' needs '%s' ('sa', 'la' or a number) or 'x' (and 'v') in &%s",
             deck_kind_name(b->d->kind), name, group);
    deck_complain_of_group(b, x->group, message);
  }
}

/* ---- sizes and the rest -------------------------------------------------------------------- */

static void check_size(deck_builder *b)
{
  const deck *d = b->d;
  const int with_members = deck_in_scene(b, "ensemble", "members");
  double points = with_members ? (double)d->ensemble.members : 1.0;
  for (int i = 0; i < DECK_AXIS_COUNT; i++)
    if (d->axis[i].count > 0) points *= (double)d->axis[i].count;
  if (points > 0x1p32 && !d->basins.refine)
    namelist_error_at(b->kind_nl, deck_place_of_kind(b), b->errors,
                      "the axes%s multiply to %.4g pendulums; at most 2^32 are possible%s",
                      with_members ? " and members" : "", points,
                      deck_in_scene(b, "basins", "refine") ? " without refine = .true." : "");
  if (deck_in_scene(b, "orbit", "samples") &&
      (double)d->orbit.periods * (double)d->orbit.samples > 1e8)
    deck_complain(b, deck_given_of(b, "orbit", "periods"), "periods",
                  "'periods' times 'samples' must not exceed 1e8: give fewer of one of them");
  if (d->switching.from == 0 && d->switching.to != 0)
    deck_complain(b, deck_given_of(b, "switching", "to"), "to",
                  "'to' needs 'from', the number of the attractor that is left");
  else if (d->switching.from != 0 && d->switching.from == d->switching.to)
    deck_complain(b, deck_given_of(b, "switching", "to"), "to",
                  "'from' and 'to' are the same attractor: give two different numbers");
  if (d->basins.boundary && (d->axis[DECK_AXIS_X].count == 1 || d->axis[DECK_AXIS_V].count == 1))
    deck_complain(b, deck_given_of(b, "basins", "boundary"), "boundary",
                  "'boundary' is looked for in a window: give x and v at least two values");
}

/* Segments of a spectrum have an even number of samples, 4 or more. */
static void check_spectrum(deck_builder *b)
{
  const deck *d = b->d;
  const int64_t least = deck_spectrum_least(d);
  const char *name = d->orbit.periods < least ? "periods" : "segment";
  const deck_given *at = deck_given_of(b, "orbit", name);
  const int there = deck_is_there(at);
  if (!deck_in_scene(b, "orbit", "spectrum") || !d->orbit.spectrum) return;
  if (d->orbit.periods >= least && (d->orbit.segment == 0 || d->orbit.segment >= least)) return;
  deck_complain(b, there ? at : deck_given_of(b, "orbit", "spectrum"), there ? name : "spectrum",
                "a spectrum takes 4 samples or more, an even number: with samples = %lld give '%s' "
                "of %lld or more", (long long)d->orbit.samples, name, (long long)least);
}

static void check_ensemble(deck_builder *b)
{
  const deck *d = b->d;
  const deck_given *shape = deck_given_of(b, "ensemble", "shape");
  if (!deck_in_scene(b, "ensemble", "members") || shape->broken) return;
  if (!(d->ensemble.x_first < d->ensemble.x_last)) {
    const deck_given *last = deck_given_of(b, "ensemble", "x_last");
    deck_complain(b, last->given ? last : deck_given_of(b, "ensemble", "x_first"), "x_last",
                  "'x_first' must be below 'x_last'");
  }
  if (strcmp(d->ensemble.shape, "line") == 0) return;
  const deck_given *v_last = deck_given_of(b, "ensemble", "v_last");
  if (!v_last->broken && !(d->ensemble.v < d->ensemble.v_last))
    deck_complain(b, v_last->given ? v_last : shape, "v_last",
                  "a rectangle of starts goes from 'v' up to 'v_last', which must be above it");
  const deck_given *rows = deck_given_of(b, "ensemble", "rows");
  if (strcmp(d->ensemble.shape, "rectangle") == 0 && !rows->broken &&
      (d->ensemble.rows < 1 || d->ensemble.members % d->ensemble.rows != 0))
    deck_complain(b, rows->given ? rows : shape, "rows",
                  "'members' must make whole 'rows' of a rectangle");
}

static void check_output(deck_builder *b)
{
  const char *output = b->d->output;
  const deck_given *at = deck_given_of(b, "scene", "output");
  if (!at->given) return;
  if (output[0] == '\0') deck_complain(b, at, "output", "'output' must not be empty");
  else if (output[strlen(output) - 1] == '/')
    deck_complain(b, at, "output", "'output' must be a file, not a folder");
  else if (strcmp(output, b->nl->name) == 0)
    deck_complain(b, at, "output", "'output' would overwrite the deck");
}

static void check_values(deck_builder *b)
{
  check_size(b);
  deck_check_axes(b);
  deck_check_tolerance(b);
  check_ensemble(b);
  check_spectrum(b);
  deck_check_fit(b);
  if (b->d->precision.block_lanes % 8 != 0)
    deck_complain(b, deck_given_of(b, "precision", "block_lanes"), "block_lanes",
                  "'block_lanes' must be a multiple of 8");
}

void deck_check(deck_builder *b)
{
  deck *d = b->d;
  if (b->scene == 0) return;
  deck_scales_damping(b);
  deck_outer_apply(b);
  check_missing(b);
  check_axis_sources(b);
  resolve_drive(b);
  deck_expand_axes(b);
  d->search_given = deck_in_scene(b, "sweep", "resonance_range") &&
                    deck_given_of(b, "sweep", "resonance_range")->given;
  check_idle_keys(b);
  deck_outer_check(b);
  check_output(b);
  deck_bring_defaults(b);
  check_values(b);
}

/* The first of a list's messages, as it is told behind the place of one value. */
static const char *first_of(const namelist_errors *errors, char text[300])
{
  const char *words = errors->count > 0 ? errors->item[0].text : "out of memory";
  const char *from = strstr(words, "error: ");
  snprintf(text, 300, "%s", from != NULL ? from + strlen("error: ") : words);
  text[strcspn(text, "\n")] = '\0';
  return text;
}

void deck_check_slices(deck_builder *b)
{
  const deck *d = b->d;
  for (size_t i = 0; i < deck_slices(d) && b->errors->count == 0 && !b->out_of_memory; i++) {
    deck one = deck_slice(d, i);
    char text[300], number[DECK_DECIMAL];
    namelist_errors errors = { 0 };
    deck_builder of_one = *b;
    of_one.d = &one;
    of_one.errors = &errors;
    check_values(&of_one);
    if (errors.out_of_memory || of_one.out_of_memory) b->out_of_memory = 1;
    else if (errors.count > 0)
      deck_complain(b, deck_given_of(b, "outer", "values"), "values", "with %s = %s: %s",
                    d->outer.key, deck_decimal(d->axis[DECK_AXIS_OUTER].value[i], number),
                    first_of(&errors, text));
    namelist_errors_free(&errors);
  }
}
