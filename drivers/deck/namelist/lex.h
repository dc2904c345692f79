/*
 * lex.h -- the characters of a namelist: position, character classes, looking ahead.
 * Internal to the reader of decks.
 */
#ifndef NAMELIST_LEX_H
#define NAMELIST_LEX_H

#include "deck/namelist/namelist.h"

#define LEX_END (-1)

typedef struct reader {
  namelist *nl;
  namelist_errors *errors;
  namelist_group *group; /* the open one */
  size_t at;
  int line, column;
  long total;            /* values so far, repeats multiplied out */
  int out_of_memory;
  int overfull;          /* a bound was exceeded and reported: stop */
  size_t group_capacity, assignment_capacity, value_capacity;
} reader;

/* parse.c: the groups of a deck; or a setting, `group.key=values`. */
void namelist_read_groups(reader *r);
void namelist_read_setting(reader *r, int whole);

/* ---- characters ---------------------------------------------------------------------------- */

static inline int lex_lower(int c)
{
  return c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c;
}

static inline int lex_is_letter(int c)
{
  c = lex_lower(c);
  return c >= 'a' && c <= 'z';
}

static inline int lex_is_digit(int c)
{
  return c >= '0' && c <= '9';
}

static inline int lex_is_name(int c)
{
  return lex_is_letter(c) || lex_is_digit(c) || c == '_';
}

static inline int lex_is_blank(int c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static inline int lex_is_quote(int c)
{
  return c == '\'' || c == '"';
}

/* Where the reader is, for a message. */
static inline namelist_place lex_place(const reader *r, int width)
{
  return (namelist_place){ r->line, r->column, width };
}

static inline int lex_at(const reader *r, size_t at)
{
  return at < r->nl->length ? (unsigned char)r->nl->text[at] : LEX_END;
}

static inline int lex_peek(const reader *r)
{
  return lex_at(r, r->at);
}

/* One byte on, keeping count of lines and columns (continuation bytes of UTF-8 do not count). */
void lex_advance(reader *r);
void lex_advance_to(reader *r, size_t at);
/* To the end of the line, not past it. */
void lex_skip_line(reader *r);
/* Past blanks, line ends and comments. */
void lex_skip_blanks(reader *r);
/* Where something that starts at `at` ends; the position of the reader stays. */
size_t lex_blanks_end(const reader *r, size_t at);
size_t lex_line_end(const reader *r, size_t at);
size_t lex_name_end(const reader *r, size_t at);
/* Does `name =`, `name(...) =` or `name%part =` start here? */
int lex_assignment_starts(const reader *r, size_t at);
/* Where the closing quote of the string that opens at `at` stands, or 0. */
size_t lex_string_close(const reader *r, size_t at);
/* Does this character end an undelimited value? */
int lex_is_value_end(int c);
/* Where an undelimited value ends; what stands in parentheses belongs to it. */
size_t lex_bare_end(const reader *r, size_t at);
/* `end` after & or $, in any case of letters. */
int lex_is_end_word(const reader *r, size_t at);
/*
 * The text is kept in the output and shown on terminals: no control bytes, nothing but UTF-8.
 * Reports the first offence; returns 0 where reading on makes no sense.
 */
int lex_check_bytes(reader *r);

#endif
