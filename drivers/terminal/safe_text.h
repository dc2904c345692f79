/*
 * safe_text.h -- text from decks and command lines on its way to a terminal or a log.
 *
 * Owns: what a character is (UTF-8, RFC 3629), and which ones a terminal may take for commands: the
 * control characters of ASCII and of Latin-1 (U+0080 to U+009F: U+009B begins a sequence as
 * ESC [ does), and those that turn the direction of writing. Each of them, and each byte that is no
 * UTF-8, becomes a question mark. No state.
 */
#ifndef SAFE_TEXT_H
#define SAFE_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* Bytes of the well-formed UTF-8 character at text, 0 if it is malformed. left: 1 or more. */
size_t safe_text_utf8(const char *text, size_t left);

/* Bytes of what is shown as one character, at least 1; *safe: it may be shown as it is. */
size_t safe_text_character(const char *text, size_t left, int *safe);

void safe_text_write(FILE *out, const char *text);

/* The same in place: no character grows. */
void safe_text_clean(char *text);

#endif
