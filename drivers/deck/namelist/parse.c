/*
 * parse.c -- text to tree: groups, assignments, values. See namelist.h.
 *
 * A recursive-descent reader without look-behind; text.c hands it the text. What may
 * follow a value is decided by looking ahead: `name =`, also with a subscript, starts the next
 * assignment; everything else that is not a separator is one more value. After an error the reader
 * goes on where the next name, group or line plausibly starts, and marks what it skipped as broken,
 * so that what could not be read is not also reported as missing.
 */
#include "deck/namelist/lex.h"
#include "system/grow.h"

#include <stdlib.h>
#include <string.h>

static void complain(reader *r, namelist_place at, const char *message)
{
  namelist_error_at(r->nl, at, r->errors, "%s", message);
  if (r->group != NULL) r->group->broken = 1;
}

/* Exceeding a bound ends the reading. */
static void overflow(reader *r, const char *message)
{
  complain(r, lex_place(r, 1), message);
  r->overfull = 1;
}

static int stopped(const reader *r)
{
  return r->out_of_memory || r->overfull;
}

/* ---- growing arrays ------------------------------------------------------------------------ */

static int grow(reader *r, void *array, size_t count, size_t *capacity, size_t size)
{
  if (grow_to(array, count + 1, capacity, size)) return 1;
  r->out_of_memory = 1;
  return 0;
}

static void add_value(reader *r, namelist_assignment *a, namelist_value v)
{
  namelist *nl = r->nl;
  r->total += v.repeat;
  if (r->total > NAMELIST_MAX_VALUES) {
    overflow(r, "more than a million values in one deck");
    return;
  }
  if (!grow(r, &nl->value, nl->values, &r->value_capacity, sizeof *nl->value)) return;
  v.at.width = v.length > NAMELIST_CLIP ? NAMELIST_CLIP : (int)v.length;
  nl->value[nl->values++] = v;
  a->count++;
}

static namelist_assignment *add_assignment(reader *r, const namelist_assignment *a)
{
  namelist *nl = r->nl;
  if (nl->assignments >= NAMELIST_MAX_ASSIGNMENTS) {
    overflow(r, "more than a thousand names in one deck");
    return NULL;
  }
  if (!grow(r, &nl->assignment, nl->assignments, &r->assignment_capacity,
            sizeof *nl->assignment))
    return NULL;
  nl->assignment[nl->assignments] = *a;
  r->group->count++;
  return &nl->assignment[nl->assignments++];
}

static int add_group(reader *r, const namelist_group *g)
{
  namelist *nl = r->nl;
  if (nl->groups >= NAMELIST_MAX_GROUPS) {
    overflow(r, "more than a hundred groups in one deck");
    return 0;
  }
  if (!grow(r, &nl->group, nl->groups, &r->group_capacity, sizeof *nl->group)) return 0;
  nl->group[nl->groups] = *g;
  r->group = &nl->group[nl->groups++];
  return 1;
}

/* ---- names --------------------------------------------------------------------------------- */

/* Read a name in lower case into name[NAMELIST_NAME]; the caller knows that one starts here. */
static void read_name(reader *r, char *name)
{
  const namelist_place at = lex_place(r, 10);
  const size_t end = lex_name_end(r, r->at);
  const size_t length = end - r->at;
  if (length >= NAMELIST_NAME) complain(r, at, "a name has at most 63 characters");
  for (size_t i = 0; i < length && i < NAMELIST_NAME - 1; i++)
    name[i] = (char)lex_lower(lex_at(r, r->at + i));
  name[length < NAMELIST_NAME ? length : NAMELIST_NAME - 1] = '\0';
  lex_advance_to(r, end);
}

/* One integer of a subscript; 0 if it is out of bounds (missing stays as is). Only a step is ever
   `negative`. */
static int read_bound(reader *r, int negative, long *out)
{
  long n = 0;
  const int sign = lex_peek(r), minus = sign == '-' && negative;
  if ((minus || sign == '+') && lex_is_digit(lex_at(r, r->at + 1))) lex_advance(r);
  const size_t begin = r->at;
  while (lex_is_digit(lex_peek(r))) {
    n = 10 * n + (lex_peek(r) - '0');
    if (n > NAMELIST_MAX_VALUES) return 0;
    lex_advance(r);
  }
  if (r->at > begin) {
    if (n < 1) return 0;
    *out = minus ? -n : n;
  }
  while (lex_peek(r) == ' ' || lex_peek(r) == '\t') lex_advance(r);
  return 1;
}

/* `(i)`, `(i:j)`, `(i:j:k)`, each part of a triplet optional. With a negative step j must be given:
   left out, it is the array's end, and nothing would be selected. */
static int read_subscript(reader *r, namelist_assignment *a)
{
  const namelist_place at = lex_place(r, 1);
  int parts = 1;
  size_t begin = 0;
  a->subscripted = 1;
  lex_advance(r);
  while (lex_peek(r) == ' ' || lex_peek(r) == '\t') lex_advance(r);
  begin = r->at;
  if (!read_bound(r, 0, &a->first)) goto bad;
  if (lex_peek(r) != ':' && r->at == begin) goto bad;
  if (lex_peek(r) == ':') {
    for (parts = 2; parts <= 3 && lex_peek(r) == ':'; parts++) {
      lex_advance(r);
      while (lex_peek(r) == ' ' || lex_peek(r) == '\t') lex_advance(r);
      if (!read_bound(r, parts == 3, parts == 2 ? &a->last : &a->step)) goto bad;
    }
    if (a->step < 0 ? a->last == 0 || a->last > a->first : a->last != 0 && a->last < a->first)
      goto bad;
  } else {
    a->last = a->first;
  }
  if (lex_peek(r) != ')') goto bad;
  lex_advance(r);
  return 1;
bad:
  complain(r, at,
           "bad subscript: (i), (i:j) or (i:j:k) with whole numbers from 1 to 1000000 is wanted");
  while (lex_peek(r) != ')' && lex_peek(r) != '=' && lex_peek(r) != '\n' && lex_peek(r) != LEX_END)
    lex_advance(r);
  if (lex_peek(r) == ')') lex_advance(r);
  return 0;
}

/* ---- values -------------------------------------------------------------------------------- */

/*
 * The rest of a line that makes no sense is skipped, but not the slash at its end, which most
 * likely closes the group.
 */
static void skip_bad_line(reader *r)
{
  const size_t end = lex_line_end(r, r->at);
  size_t last = end;
  while (last > r->at && lex_is_blank(lex_at(r, last - 1))) last--;
  if (last > r->at && lex_at(r, last - 1) == '/') lex_advance_to(r, last - 1);
  else lex_advance_to(r, end);
}

static void read_string(reader *r, namelist_assignment *a, namelist_value v)
{
  const size_t close = lex_string_close(r, r->at);
  if (close == 0) {
    complain(r, lex_place(r, 1), "this string is not closed (missing quote)");
    a->broken = 1;
    skip_bad_line(r);
    return;
  }
  v.form = NAMELIST_STRING;
  v.begin = r->at;
  v.length = close + 1 - r->at;
  lex_advance_to(r, close + 1);
  if (!lex_is_value_end(lex_peek(r))) {
    complain(r, lex_place(r, 1),
             "a separator is missing after the string (a quote inside a string is written twice)");
    a->broken = 1;
    skip_bad_line(r);
    return;
  }
  add_value(r, a, v);
}

/* `r*` in front of a value: 1 if read or absent, 0 after an error. */
static int read_repeat(reader *r, namelist_assignment *a, namelist_value *v)
{
  size_t at = r->at;
  long n = 0;
  while (lex_is_digit(lex_at(r, at))) {
    if (n <= NAMELIST_MAX_VALUES) n = 10 * n + (lex_at(r, at) - '0');
    at++;
  }
  if (at == r->at || lex_at(r, at) != '*') return 1;
  if (n < 1 || n > NAMELIST_MAX_VALUES) {
    complain(r, lex_place(r, (int)(at - r->at)),
             "a repeat count must lie between 1 and 1000000");
    a->broken = 1;
    lex_advance_to(r, lex_bare_end(r, r->at));
    return 0;
  }
  v->repeat = (int)n;
  lex_advance_to(r, at + 1);
  return 1;
}

static void read_bare(reader *r, namelist_assignment *a, namelist_value v)
{
  const size_t end = lex_bare_end(r, r->at);
  const char *problem = NULL;
  const int first = lex_peek(r);
  if (first == '#') problem = "'#' starts no comment in a namelist; '!' does";
  else if (first == '*') problem = "no blank may stand before the '*' of a repeat count";
  else if (lex_is_quote(lex_at(r, end))) problem = "a separator is missing before the string";
  else if (first >= 0x80)
    problem = "unexpected character (typographic quotes, dashes and blanks do not work)";
  if (problem != NULL) {
    complain(r, lex_place(r, 1), problem);
    a->broken = 1;
    if (first == '#') lex_skip_line(r);
    else skip_bad_line(r);
    return;
  }
  v.form = NAMELIST_BARE;
  v.begin = r->at;
  v.length = end - r->at;
  lex_advance_to(r, end);
  add_value(r, a, v);
}

static void read_value(reader *r, namelist_assignment *a)
{
  namelist_value v = { NAMELIST_NULL, 1, lex_place(r, 0), r->at, 0 };
  if (!read_repeat(r, a, &v)) return;
  if (v.repeat > 1 || r->at > v.begin) {
    v.begin = r->at;
    if (lex_is_value_end(lex_peek(r))) {
      add_value(r, a, v); /* r*: nulls */
      return;
    }
  }
  if (lex_is_quote(lex_peek(r))) read_string(r, a, v);
  else read_bare(r, a, v);
}

/* Everything between the equals sign and the next name or the end of the group. */
static void read_values(reader *r, namelist_assignment *a)
{
  int after_comma = 1; /* a comma now stands for a null value before it */
  while (!stopped(r)) {
    lex_skip_blanks(r);
    const int c = lex_peek(r);
    if (c == LEX_END || c == '/' || c == '&' || c == '$' || lex_assignment_starts(r, r->at)) return;
    if (c == ',') {
      const namelist_value null = { NAMELIST_NULL, 1, lex_place(r, 0), r->at, 0 };
      if (after_comma) add_value(r, a, null);
      after_comma = 1;
      lex_advance(r);
    } else if (c == ';' || c == '=') {
      complain(r, lex_place(r, 1),
               c == ';' ? "';' separates nothing here; use a comma or a blank"
                        : "unexpected '='");
      a->broken = 1;
      lex_advance(r);
      after_comma = 1;
    } else {
      read_value(r, a);
      after_comma = 0;
    }
  }
}

/* ---- assignments and groups ---------------------------------------------------------------- */

static void skip_part(reader *r)
{
  while (lex_is_name(lex_peek(r)) || lex_peek(r) == '%') lex_advance(r);
}

/* A name that came before in the group, without subscripts at either place: one of them is lost. */
static void check_repeated(reader *r, namelist_assignment *a)
{
  for (size_t i = 0; !a->subscripted && i < r->group->count; i++) {
    const namelist_assignment *other = &r->nl->assignment[r->group->begin + i];
    if (other->subscripted || strcmp(other->name, a->name) != 0) continue;
    namelist_error_at(r->nl, a->at, r->errors, "'%s' is given twice (first on line %d)", a->name,
                      other->at.line);
    a->broken = 1;
    return;
  }
}

/* `name`, optional subscript, `=`; lex_assignment_starts() has said yes. NULL: out of room. */
static namelist_assignment *read_target(reader *r)
{
  namelist_assignment a = { .at = lex_place(r, 0), .first = 1, .step = 1 };
  read_name(r, a.name);
  a.at.width = (int)strlen(a.name);
  if (lex_peek(r) == '%') {
    complain(r, lex_place(r, 1), "components of derived types do not occur in decks");
    a.broken = 1;
    skip_part(r);
  }
  if (lex_is_blank(lex_peek(r)) && lex_at(r, lex_blanks_end(r, r->at)) == '(') {
    lex_skip_blanks(r);
    complain(r, lex_place(r, 1), "no blank may stand between a name and its subscript");
    a.broken = 1;
  }
  if (lex_peek(r) == '(' && !read_subscript(r, &a)) a.broken = 1;
  lex_skip_blanks(r);
  if (lex_peek(r) == '=') lex_advance(r);
  a.begin = r->nl->values;
  check_repeated(r, &a);
  return add_assignment(r, &a);
}

static void read_assignment(reader *r)
{
  namelist_assignment *a = read_target(r);
  if (a != NULL) read_values(r, a);
}

/* No assignment starts where one should: report it and go to where the next thing starts. */
static void skip_non_assignment(reader *r)
{
  const size_t end = lex_name_end(r, r->at);
  if (end > r->at) {
    namelist_error_at(r->nl, lex_place(r, (int)(end - r->at)), r->errors,
                      "expected '=' after '%.*s'", end - r->at > 40 ? 40 : (int)(end - r->at),
                      r->nl->text + r->at);
    r->group->broken = 1;
  } else {
    complain(r, lex_place(r, 1),
             lex_peek(r) == '#' ? "'#' starts no comment in a namelist; '!' does"
                                : "expected a name");
  }
  if (lex_peek(r) == '#') lex_skip_line(r);
  else lex_advance(r);
  while (lex_peek(r) != LEX_END) {
    const int c = lex_peek(r);
    if (c == '!') lex_skip_line(r);
    if (c == '/' || c == '&' || c == '$') return;
    const int before = lex_at(r, r->at - 1);
    if (!lex_is_name(before) && before != '%' && lex_assignment_starts(r, r->at)) return;
    if (lex_is_quote(c)) {
      const size_t close = lex_string_close(r, r->at);
      if (close != 0) lex_advance_to(r, close);
    }
    lex_advance(r);
  }
}

static void report_open_group(reader *r)
{
  const namelist_group *g = r->group;
  namelist_error_at(r->nl, g->at, r->errors, "&%s is not closed: its '/' is missing", g->name);
  r->group->broken = 1;
}

/* The inside of a group up to its end. */
static void read_group_body(reader *r)
{
  while (!stopped(r)) {
    lex_skip_blanks(r);
    const int c = lex_peek(r);
    if (c == LEX_END) {
      report_open_group(r);
      return;
    }
    if (c == '/') {
      lex_advance(r);
      return;
    }
    if (c == '&' || c == '$') {
      if (lex_is_end_word(r, r->at + 1)) {
        lex_advance_to(r, r->at + 4);
        return;
      }
      if (lex_is_letter(lex_at(r, r->at + 1))) {
        report_open_group(r);
        return;
      }
      complain(r, lex_place(r, 1), "unexpected character");
      lex_advance(r);
    } else if (lex_assignment_starts(r, r->at)) {
      read_assignment(r);
    } else {
      skip_non_assignment(r);
    }
  }
}

static void read_group(reader *r)
{
  namelist_group g = { .at = lex_place(r, 0), .begin = r->nl->assignments };
  lex_advance(r);
  read_name(r, g.name);
  g.at.width = (int)strlen(g.name) + 1;
  for (size_t i = 0; i < r->nl->groups; i++) {
    if (strcmp(r->nl->group[i].name, g.name) != 0) continue;
    namelist_error_at(r->nl, g.at, r->errors, "&%s is given twice (first on line %d)", g.name,
                      r->nl->group[i].at.line);
    g.repeated = 1;
    break;
  }
  if (!add_group(r, &g)) return;
  const int c = lex_peek(r);
  if (!lex_is_blank(c) && c != '/' && c != '!' && c != LEX_END)
    complain(r, lex_place(r, 1), "a blank must follow the name of a group");
  if (!lex_is_blank(c) && c != '/' && c != '!' && c != LEX_END) lex_advance(r);
  read_group_body(r);
  r->group = NULL;
}

/* Anything but comments between groups is a mistake; one message up to the next group. */
static void skip_outside_text(reader *r, const char *message)
{
  complain(r, lex_place(r, 1), message);
  /* Most likely a slash inside a value ended the group too early. */
  if (r->nl->groups > 0 && r->at > 0) r->nl->group[r->nl->groups - 1].broken = 1;
  lex_advance(r);
  while (lex_peek(r) != LEX_END) {
    const int c = lex_peek(r);
    if ((c == '&' || c == '$') && lex_is_letter(lex_at(r, r->at + 1)) &&
        !lex_is_end_word(r, r->at + 1))
      return;
    if (c == '!') lex_skip_line(r);
    else lex_advance(r);
  }
}

void namelist_read_groups(reader *r)
{
  for (;;) {
    lex_skip_blanks(r);
    const int c = lex_peek(r);
    const int sigil = c == '&' || c == '$';
    if (stopped(r) || c == LEX_END) return;
    if (sigil && lex_is_end_word(r, r->at + 1))
      skip_outside_text(r, "this ends a group, but none is open");
    else if (sigil && lex_is_letter(lex_at(r, r->at + 1)))
      read_group(r);
    else if (sigil)
      skip_outside_text(r, "the name of the group must follow at once, without a blank");
    else
      skip_outside_text(r, "text outside of any group (groups are '&name ... /', "
                           "comments start with '!')");
  }
}

/* ---- a key set outside of a deck ----------------------------------------------------------- */

/* The rest of the text as it is: a string whose quotes a shell has taken away. */
static void read_rest(reader *r, namelist_assignment *a)
{
  const namelist_value v = { NAMELIST_BARE, 1, lex_place(r, 0), r->at, r->nl->length - r->at };
  lex_advance_to(r, r->nl->length);
  add_value(r, a, v);
}

void namelist_read_setting(reader *r, int whole)
{
  namelist_group g = { .at = lex_place(r, 0) };
  namelist_assignment *a = NULL;
  read_name(r, g.name);
  g.at.width = (int)strlen(g.name) + 1;
  lex_advance(r); /* the point */
  if (add_group(r, &g)) a = read_target(r);
  if (a == NULL) return;
  lex_skip_blanks(r);
  if (whole && !lex_is_quote(lex_peek(r)) && lex_peek(r) != LEX_END) read_rest(r, a);
  else read_values(r, a);
  if (lex_peek(r) != LEX_END)
    complain(r, lex_place(r, 1), "an argument sets one key; what stands here is too much");
}
