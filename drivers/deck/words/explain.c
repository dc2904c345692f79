/* explain.c -- the table of keys in words, for readers; see deck.h. */
#include "deck/deck.h"
#include "deck/table.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

enum { COLUMNS = 96, SENTENCE = 1200 };

/* ---- one key in words ---------------------------------------------------------------------- */

/* Append to a text of SENTENCE bytes. */
__attribute__((format(printf, 2, 3))) static void add(char *text, const char *format, ...)
{
  const size_t n = strlen(text);
  va_list args;
  va_start(args, format);
  (void)vsnprintf(text + n, SENTENCE - n, format, args);
  va_end(args);
}

static void add_number(char *text, double x)
{
  char number[DECK_DECIMAL];
  if (x == floor(x)) add(text, fabs(x) < 1e6 ? "%.0f" : "%.3g", x);
  else add(text, "%s", deck_decimal(x, number));
}

static int is_number(const deck_key *key)
{
  return key->type == DECK_REAL || key->type == DECK_INTEGER || key->type == DECK_BOUNDS ||
         key->type == DECK_NUMBERS || key->type == DECK_LIST || key->type == DECK_SWEEP ||
         key->type == DECK_SWEEP_VALUE;
}

/* "'sa', 'la'", without the empty choice, which stands for none. */
static void add_choices(char *text, const deck_key *key)
{
  const char *comma = "";
  for (size_t i = 0; key->choices[i] != NULL; i++) {
    if (key->choices[i][0] == '\0') continue;
    add(text, "%s'%s'", comma, key->choices[i]);
    comma = ", ";
  }
}

/* A limit of this size is that of what is computed with, and not told. */
#define UNBOUNDED 1e100

/* What may stand behind the equals sign: "a number from 0 to 1e+06". */
static void add_form(char *text, const deck_key *key)
{
  static const char *const form[] = {
    [DECK_REAL] = "a number", [DECK_INTEGER] = "a whole number",
    [DECK_LOGICAL] = ".true. or .false.", [DECK_STRING] = "a string", [DECK_CHOICE] = "one of ",
    [DECK_CHOICES] = "some of ", [DECK_BOUNDS] = "two ascending numbers",
    [DECK_NUMBERS] = "some numbers", [DECK_LIST] = "numbers", [DECK_SWEEP] = "numbers",
    [DECK_SWEEP_VALUE] = "a number",
  };
  add(text, "%s", key->type == DECK_CHOICES && key->choices == NULL ? "strings" : form[key->type]);
  if (key->choices != NULL) add_choices(text, key);
  if (!is_number(key)) return;
  const int above = key->low > -UNBOUNDED, below = key->high < UNBOUNDED;
  const int several = key->type == DECK_NUMBERS || key->type == DECK_LIST;
  if ((above || below) && several) add(text, ", each");
  if (above) {
    add(text, key->open ? " above " : " from ");
    add_number(text, key->low);
  }
  if (above && !below && !key->open) add(text, " on");
  if (below) {
    add(text, "%s", key->open ? (above ? " and below " : " below ") : above ? " to " : " up to ");
    add_number(text, key->high);
  }
}

static void add_unit(char *text, const deck_key *words)
{
  const char *example = deck_unit_example(words), *unit = deck_key_unit(words);
  if (unit != NULL && strcmp(unit, "1") != 0) add(text, ", in %s", unit);
  if (example != NULL) add(text, ", or as %s", example);
}

static int is_by_drive(const deck_key *key)
{
  return key->when == DECK_BY_FREQUENCY || key->when == DECK_BY_PERIOD;
}

/* Add its default as decks write it; returns 0 if there is none. */
static int add_default(char *text, const deck_key *key)
{
  if (key->type == DECK_LOGICAL) {
    add(text, "%s", key->number != 0.0 ? ".true." : ".false.");
  } else if (key->type == DECK_CHOICE && key->text != NULL) {
    add(text, "'%s'", key->text);
  } else if (key->type == DECK_BOUNDS) {
    add_number(text, key->number);
    add(text, ", ");
    add_number(text, key->number2);
  } else if ((key->type == DECK_REAL || key->type == DECK_INTEGER) && !isnan(key->number)) {
    add_number(text, key->number);
  } else {
    return 0;
  }
  return 1;
}

/* For a parameter of &pendulum that may be an axis of &sweep, or the reverse: the other group, if
   all these scenes take it there; else NULL. */
static const char *other_group(const deck_key *key, unsigned scenes)
{
  const char *other = strcmp(key->group, "pendulum") == 0 ? "sweep"
                      : strcmp(key->group, "sweep") == 0  ? "pendulum"
                                                          : NULL;
  unsigned taken = 0;
  for (size_t i = 0; i < deck_table_size && other != NULL; i++)
    if (strcmp(deck_table[i].group, other) == 0 && strcmp(deck_table[i].name, key->name) == 0)
      taken |= deck_table[i].scenes;
  return (taken & scenes) == scenes ? other : NULL;
}

/* Say that it must be given in that scene (0: in all scenes that take it), or else its default. */
static void add_need(char *text, const deck_key *key, unsigned scene)
{
  const unsigned scenes = scene != 0 ? scene : key->scenes;
  if ((key->needed & scenes) == scenes) {
    const char *other = other_group(key, scenes);
    add(text, "needed");
    if (other != NULL) add(text, ", in &%s or here", other);
  }
  else if (is_by_drive(key)) add(text, "one of the two is needed");
  else if (!add_default(text, key)) add(text, "none");
}

/* The condition under which a key has an effect, in words; NULL: none that needs any. */
static const char *condition(const deck_key *key)
{
  return deck_when_of(key->when)->condition;
}

/* "drive_amplitude" or, for an axis that may be a range too, "damping, damping_range". */
static void add_names(char *text, const deck_key *key, const char *quote)
{
  add(text, "%s%s%s", quote, key->name, quote);
  if (deck_table_has_range(key)) add(text, ", %s%s_range%s", quote, key->name, quote);
}

static void add_scenes(char *text, unsigned scenes)
{
  const char *comma = "";
  const unsigned others = ~scenes & ((1u << DECK_KIND_COUNT) - 1u);
  const int most = __builtin_popcount(scenes) > DECK_KIND_COUNT / 2;
  const unsigned listed = most ? others : scenes;
  if (most) add(text, others == 0 ? "all" : "all but ");
  for (int k = 0; k < DECK_KIND_COUNT; k++) {
    if ((listed & (1u << k)) == 0) continue;
    add(text, "%s%s", comma, deck_kind_name((deck_kind)k));
    comma = ", ";
  }
}

/* ---- paragraphs ---------------------------------------------------------------------------- */

void deck_write_wrapped(FILE *out, const char *margin, const char *words)
{
  size_t column = 0;
  while (*words != '\0') {
    const size_t n = strcspn(words, " ");
    if (column == 0 || column + 1 + n > COLUMNS) {
      fprintf(out, "%s%s%.*s", column == 0 ? "" : "\n", margin, (int)n, words);
      column = strlen(margin) + n;
    } else {
      fprintf(out, " %.*s", (int)n, words);
      column += 1 + n;
    }
    words += n + strspn(words + n, " ");
  }
  fprintf(out, "\n");
}

/* " damping = a number ..., in omega0; needed" and, indented, what it means. scene 0: all
   scenes. */
static void explain_key(FILE *out, const char *margin, const deck_key *key, unsigned scene)
{
  const deck_key *words = deck_table_words(key);
  char text[SENTENCE] = "", inner[32];
  snprintf(inner, sizeof inner, "%s    ", margin);
  add_names(text, key, "");
  add(text, " = ");
  add_form(text, key);
  add_unit(text, words);
  add(text, "; ");
  if ((key->needed & (scene != 0 ? scene : key->scenes)) == 0 && !is_by_drive(key))
    add(text, "default ");
  add_need(text, key, scene);
  deck_write_wrapped(out, margin, text);
  deck_write_wrapped(out, inner, words->meaning);
  if (condition(key) != NULL) deck_write_wrapped(out, inner, condition(key));
  if (scene != 0) return;
  snprintf(text, sizeof text, "scenes: ");
  add_scenes(text, key->scenes);
  deck_write_wrapped(out, inner, text);
}

/* ---- kinds, groups, keys ------------------------------------------------------------------- */

void deck_list(FILE *out)
{
  for (int k = 0; k < DECK_KIND_COUNT; k++)
    fprintf(out, "%-19s %s\n", deck_kind_name((deck_kind)k), deck_kind_of((deck_kind)k)->words);
}

static int find_kind(const char *word)
{
  for (int k = 0; k < DECK_KIND_COUNT; k++)
    if (strcmp(word, deck_kind_name((deck_kind)k)) == 0) return k;
  return -1;
}

static void explain_kind(FILE *out, int kind)
{
  const unsigned scene = 1u << kind;
  const char *group = NULL;
  fprintf(out, "%s: %s\n", deck_kind_name((deck_kind)kind), deck_kind_of((deck_kind)kind)->words);
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if ((key->scenes & scene) == 0) continue;
    if (group == NULL || strcmp(group, key->group) != 0) fprintf(out, "\n&%s\n", key->group);
    group = key->group;
    explain_key(out, "  ", key, scene);
  }
}

/* Explain the rows of a group and a name, either of which may be NULL for any; returns how many. */
static size_t explain_rows(FILE *out, const char *group, const char *name)
{
  const char *shown = NULL;
  size_t found = 0;
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    int range = 0;
    if (key->scenes == 0 || (group != NULL && strcmp(group, key->group) != 0)) continue;
    if (name != NULL && !deck_table_matches(key, name, &range)) continue;
    if (shown == NULL || strcmp(shown, key->group) != 0)
      fprintf(out, "%s&%s\n", found > 0 ? "\n" : "", key->group);
    shown = key->group;
    explain_key(out, "  ", key, 0);
    found++;
  }
  return found;
}

/* Report an unknown word, with the nearest known one. */
static pendres_status unknown_word(const char *word, int only_kinds, char *why, size_t size)
{
  deck_suggestion s = { .word = word };
  char hint[2 * DECK_NAME];
  for (int k = 0; k < DECK_KIND_COUNT; k++) deck_suggest(&s, deck_kind_name((deck_kind)k));
  for (size_t i = 0; i < deck_table_size && !only_kinds; i++)
    if (deck_table[i].scenes != 0) deck_suggest(&s, deck_table[i].name);
  for (size_t k = 0; only_kinds && deck_starter_get(k) != NULL; k++)
    deck_suggest(&s, deck_starter_get(k)->name);
  if (s.best == NULL && !only_kinds) s.best = deck_synonym(word, 0);
  snprintf(why, size, "'%.60s' is no kind of scene%s%s; --list names the kinds", word,
           only_kinds ? "" : ", group, key, result or subject of a page",
           deck_suggestion_text(&s, hint, sizeof hint));
  return PENDRES_INVALID_ARGUMENT;
}

pendres_status deck_explain(const char *word, FILE *out, char *why, size_t size)
{
  const int kind = find_kind(word);
  const char *dot = strchr(word, '.');
  char group[DECK_NAME];
  if (kind >= 0) {
    explain_kind(out, kind);
    return PENDRES_OK;
  }
  if (dot != NULL) {
    snprintf(group, sizeof group, "%.*s", (int)(dot - word), word);
    if (explain_rows(out, group, dot + 1) > 0) return PENDRES_OK;
  } else if (explain_rows(out, word, NULL) > 0 || explain_rows(out, NULL, word) > 0) {
    return PENDRES_OK;
  }
  return unknown_word(word, 0, why, size);
}

/* ---- a deck to start from ------------------------------------------------------------------ */

/* "  ! meaning: what it takes, in its unit; when". */
static void init_comment(FILE *out, const deck_key *key)
{
  const deck_key *words = deck_table_words(key);
  char text[SENTENCE] = "";
  add(text, "%s: ", words->meaning);
  if (deck_table_has_range(key))
    add(text, "%s", key->example != NULL ? "first, last, count of " : "list of ");
  add_form(text, key);
  add_unit(text, words);
  if (condition(key) != NULL) add(text, "; %s", condition(key));
  fprintf(out, "\n");
  deck_write_wrapped(out, "  ! ", text);
}

static void init_key(FILE *out, const deck_key *key, int kind)
{
  const char *range = key->example != NULL && deck_table_has_range(key) ? "_range" : "";
  char value[SENTENCE] = "";
  init_comment(out, key);
  if (key->offset == offsetof(deck, kind) && key->type == DECK_CHOICE)
    fprintf(out, "  %s = '%s'\n", key->name, deck_kind_name((deck_kind)kind));
  else if (key->example != NULL)
    fprintf(out, "  %s%s = %s\n", key->name, range, key->example);
  else
    fprintf(out, "  ! %s = %s\n", key->name, add_default(value, key) ? value : "...");
}

pendres_status deck_init(const char *word, FILE *out, char *why, size_t size)
{
  const int kind = find_kind(word);
  const deck_starter *starter = deck_starter_find(word);
  const char *group = NULL;
  if (starter != NULL) {
    fprintf(out, "! %s: resonance DECK\n%s", starter->words, starter->text);
    return PENDRES_OK;
  }
  if (kind < 0) return unknown_word(word, 1, why, size);
  fprintf(out, "! %s: %s.\n! Keys that are comments have the values that stand there by default.\n",
          deck_kind_name((deck_kind)kind), deck_kind_of((deck_kind)kind)->words);
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if ((key->scenes & 1u << kind) == 0) continue;
    /* A key of &pendulum that holds one value of an axis is left out, unless it has an example. */
    if (key->type == DECK_SWEEP_VALUE && key->example == NULL) continue;
    if (group == NULL || strcmp(group, key->group) != 0)
      fprintf(out, "%s\n&%s", group != NULL ? "/\n" : "", key->group);
    group = key->group;
    init_key(out, key, kind);
  }
  fprintf(out, "/\n");
  return PENDRES_OK;
}

/* ---- the page of the reference ------------------------------------------------------------- */

static const char page_head[] =
  "# Decks: kinds and keys\n"
  "\n"
  "<!-- Written by `make decks-reference` from the table that the reader checks decks by: change\n"
  "     drivers/deck/table.c instead. -->\n"
  "\n"
  "A deck is a Fortran namelist: groups `&name ... /` of keys, `name = value`. Comments start\n"
  "with `!`. `resonance --list` names the kinds of scenes, `resonance --explain=damping` tells\n"
  "what stands here of a kind, group or key, and `resonance --init=response` prints a deck to\n"
  "start from.\n"
  "\n"
  "The pendulum obeys x'' + gamma x' - cos x = F0 cos(omega t) + noise. Times are in units of\n"
  "1/omega0, where omega0 = sqrt(g/l) is the angular frequency of small oscillations without\n"
  "drive; torques and energies are in units of m g l.\n"
  "\n"
  "An axis NAME of `&sweep` takes values, `NAME = v1, v2, ...`, a range, `NAME_range = first,\n"
  "last, count`, or both, which are united. Values of a range are decimals, as a list would have\n"
  "them; between ends that are multiplied by a power of two some may differ from its multiples in\n"
  "the last place.\n"
  "\n"
  "Numbers may have units, `'1.2 MHz'`, where the column of units shows one: [units](units.md)\n"
  "tells which scales a deck then has in `&units`. Numbers without a unit are in ours.\n"
  "\n"
  "Where a kind takes a group, `&units`, the tables of keys tell which of its keys.\n";

/* In a cell of a table a bar would end the cell. Empties the text. */
static void write_cell(FILE *out, char *text)
{
  fputc(' ', out);
  for (const char *c = text; *c != '\0'; c++) {
    if (*c == '|') fputc('\\', out);
    fputc(*c, out);
  }
  fputs(" |", out);
  text[0] = '\0';
}

/* Keys of these have their names in the list of a kind, those of other groups stand for it. */
static int is_listed(const char *group)
{
  return strcmp(group, "pendulum") == 0 || strcmp(group, "sweep") == 0;
}

/* k of the axis of a force's coefficient k; 0: it is another axis, or none. */
static int coefficient_of(const deck_key *key)
{
  const pendres_parameter_info *of = pendres_parameter_of(deck_axis_parameter(key->axis));
  return key->type == DECK_SWEEP && of != NULL ? of->coefficient : 0;
}

static void reference_kind(FILE *out, deck_kind kind)
{
  const unsigned scene = 1u << kind;
  char needed[SENTENCE] = "", others[SENTENCE] = "";
  const char *group = "";
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if ((key->scenes & scene) == 0 || strcmp(key->group, "scene") == 0) continue;
    if (coefficient_of(key) > 1) continue; /* as the first one */
    char *list = (key->needed & scene) != 0 ? needed : others;
    const char *other = list == needed ? other_group(key, scene) : NULL;
    const char *comma = list[0] == '\0' ? "" : ", ";
    const int named = list == needed || is_listed(key->group);
    if (named) add(list, "%s`%s.%s`", comma, key->group, key->name);
    else if (strcmp(key->group, group) != 0) add(list, "%s`&%s`", comma, group = key->group);
    if (coefficient_of(key) == 1) add(list, " and further ones");
    if (other != NULL) add(list, " (or in `&%s`)", other);
  }
  fprintf(out, "\n### %s\n\nComputes: %s.\n\n", deck_kind_name(kind), deck_kind_of(kind)->words);
  if (needed[0] != '\0') fprintf(out, "Needs %s.\n\n", needed);
  fprintf(out, "Takes %s.\n", others);
}

/* Whether all keys of a group are for the same scenes, which its heading tells then. */
static int is_for_the_same(const deck_key *one)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, one->group) == 0 && deck_table[i].scenes != 0 &&
        deck_table[i].scenes != one->scenes)
      return 0;
  return 1;
}

static void reference_group(FILE *out, const deck_key *first)
{
  char cell[SENTENCE] = "";
  fprintf(out, "\n### &%s\n\n", first->group);
  if (is_for_the_same(first)) {
    add_scenes(cell, first->scenes);
    fprintf(out, "Scenes: %s.\n\n", cell);
  }
  fprintf(out, "| key | meaning | unit | takes | default |%s\n|---|---|---|---|---|%s\n",
          is_for_the_same(first) ? "" : " scenes |", is_for_the_same(first) ? "" : "---|");
}

static void reference_key(FILE *out, const deck_key *key)
{
  const deck_key *words = deck_table_words(key);
  char cell[SENTENCE] = "";
  fputs("|", out);
  add_names(cell, key, "`");
  write_cell(out, cell);
  add(cell, "%s", words->meaning);
  if (condition(key) != NULL) add(cell, "; %s", condition(key));
  write_cell(out, cell);
  const char *example = deck_unit_example(words), *unit = deck_key_unit(words);
  add(cell, "%s", unit != NULL ? unit : "");
  if (example != NULL) add(cell, "%s%s", cell[0] != '\0' ? ", " : "", example);
  write_cell(out, cell);
  add_form(cell, key);
  write_cell(out, cell);
  add_need(cell, key, 0);
  write_cell(out, cell);
  if (!is_for_the_same(key)) {
    add_scenes(cell, key->scenes);
    write_cell(out, cell);
  }
  fputs("\n", out);
}

void deck_reference(FILE *out)
{
  const char *group = NULL;
  fputs(page_head, out);
  fputs("\n## Kinds\n", out);
  for (int k = 0; k < DECK_KIND_COUNT; k++) reference_kind(out, (deck_kind)k);
  fputs("\n## Keys\n", out);
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (key->scenes == 0) continue;
    if (group == NULL || strcmp(group, key->group) != 0) reference_group(out, key);
    group = key->group;
    reference_key(out, key);
  }
}
