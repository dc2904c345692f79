/* safe_text.c -- text on its way to a terminal; see safe_text.h. */
#include "terminal/safe_text.h"

#include <string.h>

size_t safe_text_utf8(const char *text, size_t left)
{
  const unsigned char *t = (const unsigned char *)text;
  const size_t size = t[0] < 0x80 ? 1 : t[0] >= 0xC2 && t[0] <= 0xDF ? 2 :
                      (t[0] & 0xF0) == 0xE0 ? 3 : t[0] >= 0xF0 && t[0] <= 0xF4 ? 4 : 0;
  if (size == 0 || size > left) return 0;
  for (size_t i = 1; i < size; i++)
    if ((t[i] & 0xC0) != 0x80) return 0;
  if (t[0] == 0xE0 && t[1] < 0xA0) return 0;
  if (t[0] == 0xED && t[1] > 0x9F) return 0;
  if (t[0] == 0xF0 && t[1] < 0x90) return 0;
  if (t[0] == 0xF4 && t[1] > 0x8F) return 0;
  return size;
}

/* U+202A to U+202E and U+2066 to U+2069 turn the direction, U+2028 and U+2029 end lines. */
static int turns(const unsigned char *t)
{
  if (t[0] != 0xE2) return 0;
  return (t[1] == 0x80 && t[2] >= 0xA8 && t[2] <= 0xAE) ||
         (t[1] == 0x81 && t[2] >= 0xA6 && t[2] <= 0xA9);
}

size_t safe_text_character(const char *text, size_t left, int *safe)
{
  const unsigned char *t = (const unsigned char *)text;
  const size_t size = safe_text_utf8(text, left);
  *safe = size == 1   ? t[0] >= 0x20 && t[0] != 0x7f
          : size == 2 ? t[0] != 0xC2 || t[1] >= 0xA0
          : size == 3 ? !turns(t)
                      : size > 0;
  return size > 0 ? size : 1;
}

void safe_text_write(FILE *out, const char *text)
{
  for (size_t left = strlen(text); left > 0;) {
    int safe;
    const size_t size = safe_text_character(text, left, &safe);
    if (safe) fwrite(text, 1, size, out);
    else fputc('?', out);
    text += size;
    left -= size;
  }
}

void safe_text_clean(char *text)
{
  char *to = text;
  for (size_t left = strlen(text); left > 0;) {
    int safe;
    const size_t size = safe_text_character(text, left, &safe);
    if (safe) memmove(to, text, size);
    else *to = '?';
    to += safe ? size : 1;
    text += size;
    left -= size;
  }
  *to = '\0';
}
