/* lex.c -- see lex.h. */
#include "deck/namelist/lex.h"

#include <string.h>

#include "terminal/safe_text.h"

void lex_advance(reader *r)
{
  const int c = lex_peek(r);
  if (c == LEX_END) return;
  r->at++;
  if (c == '\n') {
    r->line++;
    r->column = 1;
  } else if ((lex_at(r, r->at) & 0xC0) != 0x80 || lex_at(r, r->at) == LEX_END) {
    r->column++; /* continuation bytes of UTF-8 do not count */
  }
}

void lex_advance_to(reader *r, size_t at)
{
  while (r->at < at) lex_advance(r);
}

void lex_skip_line(reader *r)
{
  while (lex_peek(r) != LEX_END && lex_peek(r) != '\n') lex_advance(r);
}

void lex_skip_blanks(reader *r)
{
  while (lex_is_blank(lex_peek(r)) || lex_peek(r) == '!') {
    if (lex_peek(r) == '!') lex_skip_line(r);
    else lex_advance(r);
  }
}

size_t lex_blanks_end(const reader *r, size_t at)
{
  while (lex_is_blank(lex_at(r, at))) at++;
  return at;
}

size_t lex_line_end(const reader *r, size_t at)
{
  while (lex_at(r, at) != LEX_END && lex_at(r, at) != '\n') at++;
  return at;
}

/* Where a name that starts at `at` ends; `at` itself if there is none. */
size_t lex_name_end(const reader *r, size_t at)
{
  if (!lex_is_letter(lex_at(r, at))) return at;
  while (lex_is_name(lex_at(r, at))) at++;
  return at;
}

/* Does `name =`, `name(...) =` or `name%part =` start here? */
int lex_assignment_starts(const reader *r, size_t at)
{
  size_t end = lex_name_end(r, at);
  if (end == at) return 0;
  while (lex_is_name(lex_at(r, end)) || lex_at(r, end) == '%') end++;
  end = lex_blanks_end(r, end);
  if (lex_at(r, end) == '(') {
    const size_t open = end;
    while (lex_at(r, end) != ')') {
      if (lex_at(r, end) == LEX_END || lex_at(r, end) == '\n' || end - open > 60) return 0;
      end++;
    }
    end = lex_blanks_end(r, end + 1);
  }
  return lex_at(r, end) == '=';
}

/*
 * A string may run on over the end of a line (the break vanishes). Where the next line looks like
 * a group, a closing slash or an assignment, its quote has been forgotten instead.
 */
static int line_cannot_continue_string(const reader *r, size_t at)
{
  while (lex_at(r, at) == ' ' || lex_at(r, at) == '\t') at++;
  const int c = lex_at(r, at);
  return c == '&' || c == '$' || c == '/' || lex_assignment_starts(r, at);
}

/* Where the closing quote of the string that opens at `at` stands, or 0. */
size_t lex_string_close(const reader *r, size_t at)
{
  const int quote = lex_at(r, at);
  for (at++; lex_at(r, at) != LEX_END; at++) {
    const int c = lex_at(r, at);
    if (c == quote && lex_at(r, at + 1) == quote) at++;
    else if (c == quote) return at;
    else if (c == '\n' && line_cannot_continue_string(r, at + 1)) return 0;
  }
  return 0;
}

int lex_is_value_end(int c)
{
  return lex_is_blank(c) || c == LEX_END || c == ',' || c == '/' || c == ';' || c == '!' ||
         c == '=';
}

/* Where an undelimited value ends; what stands in parentheses belongs to it. */
size_t lex_bare_end(const reader *r, size_t at)
{
  int look = 1; /* parentheses that stay open are looked for once: a line may hold many */
  while (!lex_is_value_end(lex_at(r, at)) && !lex_is_quote(lex_at(r, at))) {
    if (look && lex_at(r, at) == '(') {
      size_t close = at;
      while (lex_at(r, close) != ')' && lex_at(r, close) != LEX_END && lex_at(r, close) != '\n')
        close++;
      look = lex_at(r, close) == ')';
      if (look) at = close;
    }
    at++;
  }
  return at;
}

/* `end` after & or $, in any case of letters. */
int lex_is_end_word(const reader *r, size_t at)
{
  return lex_lower(lex_at(r, at)) == 'e' && lex_lower(lex_at(r, at + 1)) == 'n' &&
         lex_lower(lex_at(r, at + 2)) == 'd' && lex_name_end(r, at) == at + 3;
}

/*
 * The text is kept in the output and shown on terminals: no control bytes, nothing but UTF-8.
 * Returns 0 where reading on makes no sense.
 */
int lex_check_bytes(reader *r)
{
  const reader start = *r;
  int readable = 1;
  while (lex_peek(r) != LEX_END) {
    const int c = lex_peek(r);
    const char *text = r->nl->text + r->at;
    const size_t size = safe_text_utf8(text, r->nl->length - r->at);
    int safe = 0;
    (void)safe_text_character(text, r->nl->length - r->at, &safe);
    readable = (c >= 0x20 || lex_is_blank(c)) && c != 0x7f;
    if (!readable)
      namelist_error_at(r->nl, lex_place(r, 1), r->errors,
                        "control byte 0x%02X: is this a deck?", c);
    else if (size > 1 && !safe)
      namelist_error_at(r->nl, lex_place(r, 1), r->errors,
                        "a control character of %zu bytes, 0x%02X 0x%02X ...: terminals may take "
                        "it for a command", size, c, (unsigned char)text[1]);
    else if (size == 0)
      namelist_error_at(r->nl, lex_place(r, 1), r->errors,
                        "byte 0x%02X is not UTF-8; save the deck as UTF-8", c);
    if (!readable || size == 0) break;
    lex_advance_to(r, r->at + size);
  }
  *r = start;
  return readable;
}

