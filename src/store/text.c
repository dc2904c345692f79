/*
 * text.c -- names, paths and text of a store.
 *
 * Owns: what counts as a name, and the way from any bytes to UTF-8. Readers in Python refuse
 * text that is not UTF-8, and a deck's comments or a host's name are not ours to choose; so
 * stray bytes are taken for Latin-1. Source: RFC 3629.
 */
#include "store/internal.h"

#include <stdlib.h>
#include <string.h>

int pendres_store_is_name(const char *name)
{
  /* By hand, since isalpha() depends on the locale. */
  const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const char others[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";

  return name && *name && strchr(letters, *name) && name[strspn(name, others)] == '\0';
}

char *pendres_store_copy(const char *text)
{
  char *copy = malloc(strlen(text) + 1);

  if (copy) strcpy(copy, text);
  return copy;
}

char *pendres_store_path(const char *group, const char *name)
{
  char *path;
  size_t length;

  if (!group) group = "";
  while (*group == '/') group++;
  path = malloc(strlen(group) + (name ? strlen(name) : 0) + 2);
  if (!path) return NULL;
  strcpy(path, group);
  length = strlen(path);
  while (length && path[length - 1] == '/') path[--length] = '\0';
  if (name) {
    if (length) strcat(path, "/");
    strcat(path, name);
  }
  return path;
}

/* Length of the well-formed UTF-8 character at s, 0 if there is none. */
static size_t utf8_length(const unsigned char *s)
{
  const size_t n = s[0] < 0x80 ? 1 : s[0] < 0xC2 ? 0 : s[0] < 0xE0 ? 2 : s[0] < 0xF0 ? 3
                   : s[0] < 0xF5 ? 4 : 0;

  for (size_t i = 1; i < n; i++)
    if ((s[i] & 0xC0) != 0x80) return 0; /* also at the end of the text */
  if (s[0] == 0xE0 && s[1] < 0xA0) return 0; /* longer than needed */
  if (s[0] == 0xED && s[1] > 0x9F) return 0; /* surrogates */
  if (s[0] == 0xF0 && s[1] < 0x90) return 0; /* longer than needed */
  if (s[0] == 0xF4 && s[1] > 0x8F) return 0; /* beyond the last character */
  return n;
}

char *pendres_store_utf8(const char *text)
{
  const unsigned char *from = (const unsigned char *)text;
  char *copy = malloc(2 * strlen(text) + 1);
  char *to = copy;

  while (copy && *from) {
    const size_t n = utf8_length(from);

    if (n) {
      memcpy(to, from, n);
      to += n;
      from += n;
    } else {
      *to++ = (char)(0xC0 | *from >> 6);
      *to++ = (char)(0x80 | (*from++ & 0x3F));
    }
  }
  if (copy) *to = '\0';
  return copy;
}

char **pendres_store_utf8_list(const char *const *texts, size_t n)
{
  char **list = calloc(n ? n : 1, sizeof *list);

  for (size_t i = 0; list && i < n; i++) {
    list[i] = pendres_store_utf8(texts[i] ? texts[i] : "");
    if (!list[i]) {
      pendres_store_utf8_free(list, n);
      list = NULL;
    }
  }
  return list;
}

void pendres_store_utf8_free(char **list, size_t n)
{
  for (size_t i = 0; list && i < n; i++) free(list[i]);
  free(list);
}
