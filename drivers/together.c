/* together.c -- what the ranks of a run agree on; see run.h. */
#define _POSIX_C_SOURCE 200809L /* getpid */
#include "run.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "farm/ranks.h"

int together_agree(int code)
{
  ranks_broadcast(&code, sizeof code);
  return code;
}

int together_ready(int ready)
{
  return ranks_all(ready);
}

/* The text of rank 0, to be freed; NULL on all ranks: none, or one of them has no memory. */
static char *share_text(const char *text)
{
  uint64_t size = text != NULL ? strlen(text) + 1 : 0;
  ranks_broadcast(&size, sizeof size);
  char *copy = size > 0 ? calloc(1, (size_t)size) : NULL;
  if (!ranks_all(copy != NULL)) {
    free(copy);
    return NULL;
  }
  if (text != NULL) memcpy(copy, text, (size_t)size);
  ranks_broadcast(copy, (size_t)size);
  return copy;
}

int together_deck(deck *d)
{
  char *text = NULL;
  int good = 1;
  if (ranks_count() == 1) return 1;
  const int root = ranks_own() == 0;
  if (root && deck_resolved(d, &text) != PENDRES_OK) text = NULL;
  char *name = share_text(root ? d->name : NULL), *shared = share_text(text);
  if (!root) {
    namelist_errors errors = { 0 };
    good = name != NULL && shared != NULL &&
           deck_read_memory(name, shared, strlen(shared), d, &errors) == PENDRES_OK;
    namelist_errors_free(&errors);
  } else {
    good = name != NULL && shared != NULL;
  }
  free(text);
  free(name);
  free(shared);
  return ranks_all(good);
}

int together_helping(void)
{
  return ranks_own() > 0;
}

void together_output(char *path, size_t size)
{
  const char *folder = getenv("TMPDIR");
  snprintf(path, size, "%.1000s/resonance-%ld-%d.h5",
           folder != NULL && *folder != '\0' ? folder : "/tmp", (long)getpid(), ranks_own());
}

void together_silence(void)
{
  if (freopen("/dev/null", "w", stdout) == NULL || freopen("/dev/null", "w", stderr) == NULL)
    (void)fclose(stdout); /* then at least no tables stand among those of rank 0 */
}
