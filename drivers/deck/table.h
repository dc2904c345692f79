/*
 * table.h -- the form of the table of keys, and what the parts of the deck reader share.
 * Internal to deck*.c.
 */
#ifndef DECK_TABLE_H
#define DECK_TABLE_H

#include "deck/deck.h"

typedef enum deck_type {
  DECK_REAL,
  DECK_INTEGER,
  DECK_LOGICAL,
  DECK_STRING,
  DECK_CHOICE,     /* a string out of a list */
  DECK_CHOICES,    /* several of them or, without a list, any strings */
  DECK_BOUNDS,     /* two ascending numbers */
  DECK_NUMBERS,    /* as many numbers as the field holds, zero where none is given */
  DECK_LIST,       /* any number of numbers */
  DECK_SWEEP,      /* an axis: NAME = values, NAME_range = first, last, count */
  DECK_SWEEP_VALUE /* one value of an axis, given in &pendulum */
} deck_type;

/* The condition, beside the kind of scene, under which a key has an effect: in words for --explain,
   and why one that is given has none. */
#define DECK_WHEN_LIST(X)                                                                          \
  X(ALWAYS, NULL, NULL)                                                                            \
  X(WITH_NOISE, "only with a temperature above 0",                                                 \
    "it concerns noise, and there is no 'temperature' above 0")                                    \
  X(WITH_RAMP, "only with 'rate' or 'protocol'",                                                   \
    "it concerns ramps, and there is no 'rate' or 'protocol'")                                     \
  X(WITHOUT_START, "only where no attractor is named", "an attractor is named")                    \
  X(OFF_LINE, "only with shape = 'rectangle' or 'random'",                                         \
    "the starts are on a line, see 'shape'")                                                       \
  X(IN_RECTANGLE, "only with shape = 'rectangle'", "'shape' is not 'rectangle'")                   \
  X(AT_RANDOM, "only with shape = 'random'", "'shape' is not 'random'")                            \
  X(WITH_SEARCH, "only where a resonance is looked for",                                           \
    "no resonance is looked for: that takes lines along the drive's frequency or period")          \
  X(WITH_OUTER, NULL, NULL)   /* with an outer axis */                                             \
  X(WITH_FORMULA, NULL, NULL) /* with a formula */                                                 \
  /* Those that another key may give instead: */                                                   \
  X(UNLESS_AXIS, NULL, NULL)  /* unless the key's axis has values in &sweep */                     \
  X(BY_FREQUENCY, NULL, NULL) /* unless the drive is given by its period */                        \
  X(BY_PERIOD, NULL, NULL)    /* the reverse */

typedef enum deck_when {
#define DECK_WHEN_CODE(code, ...) DECK_##code,
  DECK_WHEN_LIST(DECK_WHEN_CODE)
#undef DECK_WHEN_CODE
} deck_when;

typedef struct deck_when_words {
  const char *condition, *why;
} deck_when_words;
const deck_when_words *deck_when_of(deck_when when); /* key.c */

typedef struct deck_key {
  const char *group;
  const char *name;
  deck_type type;
  size_t offset, size;         /* of the field in struct deck; size of a string's buffer */
  deck_axis_id axis;           /* of DECK_SWEEP and DECK_SWEEP_VALUE */
  unsigned scenes;             /* scenes that use it: bits 1u << deck_kind */
  unsigned needed;             /* scenes that need it */
  double low, high;            /* numbers must lie between these */
  int open;                    /* nonzero: low and high themselves are excluded */
  const char *why;             /* for messages: where the range comes from; may be NULL */
  double number;               /* default of a number or logical */
  double number2;              /* second default of DECK_BOUNDS */
  const char *text;            /* default of a string; NULL: "" */
  const char *const *choices;  /* NULL-terminated */
  int repeats;                 /* nonzero: a name may stand more than once */
  deck_when when;
  pendres_kind kind;           /* of its numbers */
  const char *unit;            /* where it does not follow from the kind, see deck_key_unit */
  const char *meaning;         /* NULL: that of a row of the same name, see deck_table_words */
  const char *example;         /* what --init writes for it, three values meaning NAME_range;
                                  NULL: its default, as a comment */
} deck_key;

enum { DECK_MAX_KEYS = 192 };

extern const deck_key deck_table[];
extern const size_t deck_table_size;

/*
 * The row of a key in a scene (a set of bits; 0: in any), or deck_table_size. NAME_range finds the
 * axis NAME and sets *range.
 */
size_t deck_table_find(const char *group, const char *name, unsigned scenes, int *range);

/* Is that a name of the key: its own, or NAME_range where it has one? *range is set for the latter.
   */
int deck_table_matches(const deck_key *key, const char *name, int *range);
int deck_table_has_range(const deck_key *key);

/* What one key means and of which kind it is, also where its row leaves that to another row of the
   same name, in the same group or, failing that, in any. Never NULL for a key of the table. */
const deck_key *deck_table_words(const deck_key *key);

/* The unit in words of a key that has such words; NULL: a number of things, a name, a choice. */
const char *deck_key_unit(const deck_key *words);

/* Where and how a key was given. */
typedef struct deck_given {
  int given;  /* nonzero: with a value */
  int broken; /* nonzero: with errors, which were reported */
  const namelist *nl; /* the text that gives it: the deck or a setting */
  namelist_place at;
  const namelist_group *group; /* the group of the key, if the deck has it */
} deck_given;

/* A deck while it is read. */
typedef struct deck_builder {
  const namelist *nl;        /* the text being read: the deck, or for a while a setting */
  const namelist *settings;  /* keys set outside of the deck, one each */
  size_t setting_count;
  namelist_errors *errors;
  deck *d;
  unsigned scene;            /* the bit of its kind; 0 if that is unknown */
  const namelist *kind_nl;   /* for what concerns the whole deck: where its kind is given */
  namelist_place kind_at;
  deck_given given[DECK_MAX_KEYS];
  double in_si[PENDRES_FORCE_POWERS]; /* coefficients that were given in SI, or NaN */
  double damping;            /* that a resistance makes, or NaN */
  pendres_force formula;     /* the force that 'formula' describes */
  int no_scales;             /* nonzero: &units has errors, which were reported */
  int out_of_memory;
} deck_builder;

/* setting.c: */
/* Parse all settings into an array, which is in any case to be freed by deck_settings_free.
   Returns as namelist_parse does. */
pendres_status deck_settings_parse(const char *const *text, size_t count, namelist **settings,
                                   namelist_errors *errors);
void deck_settings_free(namelist *settings, size_t count);
/* Is what that row gives set outside of the deck? */
int deck_is_set(const deck_builder *b, size_t row);
/* Is the setting the second one of its key? Reports it. */
int deck_is_set_before(deck_builder *b, size_t index);

/* unknown.c: messages about names that do not exist, or have no effect in the scene. */
const char *deck_resolve_group(deck_builder *b, const namelist_group *g);
int deck_group_has_scene(const char *group, unsigned scene);
void deck_report_idle_group(deck_builder *b, const namelist_group *g, const char *group);
void deck_report_idle_key(deck_builder *b, const namelist_assignment *a, const char *group);
void deck_report_unknown_key(deck_builder *b, const namelist_assignment *a, const char *group);

/* key.c: take the values of one key over into the deck; range: it came as NAME_range. */
void deck_key_apply(deck_builder *b, size_t row, const namelist_array *array, int range);
/* Set the defaults of all keys or, as soon as the scene is known, of those that it has: rows of one
   field may differ in them. */
void deck_key_defaults(deck_builder *b);
/* Does the key have an effect in this deck? */
int deck_key_applies(const deck_key *key, const deck *d);

/* quantity.c: */
/* Is a value a text of a number with a unit? */
int deck_value_has_unit(const namelist *nl, const namelist_value *v);
/* Read such a value, in the model's own units. 1, or 0 with the error reported. */
int deck_quantity_read(deck_builder *b, const deck_key *key, const namelist_value *v,
                       const char *name, double *out);
/* The same of coefficient k of the force, into in_si: the scales may follow from it. */
int deck_coefficient_read(deck_builder *b, const deck_key *key, const namelist_value *v, int k);
/* What such a value of the key looks like; NULL: it takes none. */
const char *deck_unit_example(const deck_key *key);

/* scales.c: */
/* What &units and coefficients in SI make of the scales; before any other key with a unit. */
void deck_scales_find(deck_builder *b);
/* The damping that follows from a resistance, once all keys are read. */
void deck_scales_damping(deck_builder *b);

/* formula.c: */
/* Read a formula, in its standard form. 1, or 0 with the error reported. */
int deck_formula_read(deck_builder *b, const namelist_value *v, char *formula, size_t size);
/* Whether the force is a formula, and then which. */
void deck_formula_find(deck_builder *b);

/* fit.c: what concerns several keys of a fit. */
void deck_check_fit(deck_builder *b);

/* decimal.c: the shortest decimal that reads back as x, in the C locale, with a point or an
   exponent so that it is a real to the eye. */
enum { DECK_DECIMAL = 40 };
const char *deck_decimal(double x, char text[DECK_DECIMAL]);

/* given.c: */
/* Complain of a key or, of a group as a whole, at its head; without one, at the kind. */
void deck_complain(deck_builder *b, const deck_given *at, const char *name, const char *format,
                   ...) __attribute__((format(printf, 4, 5)));
void deck_complain_of_group(deck_builder *b, const namelist_group *g, const char *message);
/* The state of a key in this scene; never NULL, so that callers need not ask. */
const deck_given *deck_given_of(const deck_builder *b, const char *group, const char *name);
/* Whether the scene has the key. */
int deck_in_scene(const deck_builder *b, const char *group, const char *name);
/* Whether a key is in the deck under its own name, with a good value or a bad one. */
int deck_is_there(const deck_given *at);
/* Where a key was given, or another one in its place, whose name is underlined; and of the whole
   deck: where its kind is. */
namelist_place deck_place_of(const deck_given *given, const char *name);
namelist_place deck_place_of_kind(const deck_builder *b);

/* check.c: everything that concerns several keys; and, when all is good, of the decks of an outer
   axis' values what depends on these. */
void deck_check(deck_builder *b);
void deck_check_slices(deck_builder *b);

/* check_axes.c: takes the values of all axes together, and checks what they vary. */
void deck_expand_axes(deck_builder *b);
void deck_expand_axis(deck_builder *b, deck_axis_id axis);
void deck_check_axes(deck_builder *b);

/* axes.c: the value of the largest size; 0 of an axis without values. */
double deck_axis_largest(const deck_axis *a);
/* Of the drive's frequency and period, set the one that was not given. */
void deck_derive_clock(deck *d);

/* outer.c: */
/* Find the number that &outer names, once the kind of scene is known. */
void deck_outer_find(deck_builder *b);
/* The key of its values, with the range and the unit of that number. */
deck_key deck_outer_values(const deck *d, const deck_key *values);
/* Is a key that number, whose place in the deck is &outer? */
int deck_outer_is(const deck *d, const deck_key *key);
/* Give the number one of the values, before all else is checked; then whether it can be an outer
   axis. */
void deck_outer_apply(deck_builder *b);
void deck_outer_check(deck_builder *b);

/* units.c: brings defaults into the pendulum's units; checks the tolerance in these. */
void deck_bring_defaults(deck_builder *b);
void deck_check_tolerance(deck_builder *b);

/* Decks that a laboratory begins with; NULL: no more, or none of that name. */
typedef struct deck_starter {
  const char *name, *words, *text;
} deck_starter;
const deck_starter *deck_starter_get(size_t k);
const deck_starter *deck_starter_find(const char *name);

/* suggest.c: the candidate nearest to a misspelt word, or NULL if none is near. */
typedef struct deck_suggestion {
  const char *word;
  const char *best;
  size_t distance;
} deck_suggestion;
void deck_suggest(deck_suggestion *s, const char *candidate);
/* " (did you mean 'BEST'?)" or "", into a buffer. */
const char *deck_suggestion_text(const deck_suggestion *s, char *buffer, size_t size);
/* Names from the literature for what decks call otherwise (gamma, tau), from number 0 on; NULL if
   there are no more. */
const char *deck_synonym(const char *word, size_t number);

#endif
