/*
 * kinds_fixture.h -- small decks of all kinds, in tests/kinds: for what must hold whatever is
 * computed. Each has several tasks where its kind can have them. Include it after driver_run.h.
 */
#ifndef KINDS_FIXTURE_H
#define KINDS_FIXTURE_H

#include <glob.h>

enum { MOST_KINDS = 40 };

/* The arguments, with the decks in alphabetical order behind the first `count`, and NULL. */
static inline void add_kinds(const char *arguments[MOST_ARGUMENTS + 1], size_t count)
{
  static glob_t found;
  char pattern[PATH_ROOM + 32];
  snprintf(pattern, sizeof pattern, "%s/tests/kinds/*.nml", top);
  if (found.gl_pathc == 0) assert_int_equal(glob(pattern, 0, NULL, &found), 0);
  assert_true(found.gl_pathc <= MOST_KINDS && count + found.gl_pathc <= MOST_ARGUMENTS);
  for (size_t i = 0; i < found.gl_pathc; i++) arguments[count + i] = found.gl_pathv[i];
  arguments[count + found.gl_pathc] = NULL;
}

#endif
