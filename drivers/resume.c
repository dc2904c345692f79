/* resume.c -- a run that goes on where an earlier one was stopped; see resume.h. */
#include "resume.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/store.h>

enum { FAILED = 1, BAD_USAGE = 2 };

/* Beside the file that the output goes to, or in a folder; to be freed. NULL: no memory. */
static char *place_of(const deck *d, const options *o)
{
  char *target = NULL;
  if (pendres_store_target(d->output, &target, NULL, 0) != PENDRES_OK) return NULL;
  const char *slash = strrchr(target, '/'), *folder = o->journal;
  const char *name = folder == NULL || slash == NULL ? target : slash + 1;
  const size_t size = strlen(name) + (folder != NULL ? strlen(folder) : 0) + sizeof "/.journal";
  char *path = malloc(size);
  if (path != NULL)
    snprintf(path, size, "%s%s%s.journal", folder != NULL ? folder : "", folder != NULL ? "/" : "",
             name);
  free(target);
  return path;
}

/* What records depend on, a line each; to be freed. NULL: no memory. Titles and the names of
   outputs change nothing. */
static char *head_of(const deck *d)
{
  deck same = *d;
  char *text = NULL, *head = NULL;
  same.output[0] = same.title[0] = '\0';
  if (deck_resolved(&same, &text) != PENDRES_OK) return NULL;
  const char *version = pendres_version(), *build = pendres_build_info();
  const size_t size = strlen(version) + strlen(build) + strlen(text) + 32;
  head = malloc(size);
  if (head != NULL) snprintf(head, size, "libpendres %s\n%s\n%s", version, build, text);
  free(text);
  return head;
}

static int open_at(const char *path, const char *head, const options *o, progress *p,
                   journal **out)
{
  char words[JOURNAL_WORDS];
  const pendres_status status = journal_open(path, head, o->resume, out, words);
  if (status != PENDRES_OK) {
    progress_error(p, "%s%s", words, status != PENDRES_INVALID_ARGUMENT ? "" :
                   " (without --resume all is computed, and that journal set aside)");
    return status == PENDRES_INVALID_ARGUMENT ? BAD_USAGE : FAILED;
  }
  if (words[0] != '\0') progress_error(p, "%s", words);
  if (journal_count(*out) > 0)
    progress_note(p, "going on from %zu finished tasks in %s", journal_count(*out), path);
  return 0;
}

int resume_open(const deck *d, const options *o, progress *p, journal **out)
{
  *out = NULL;
  /* What is timed is not the same twice. */
  if (o->no_journal || d->kind == DECK_WORK_PRECISION) return 0;
  char *path = place_of(d, o), *head = head_of(d);
  int code = FAILED;
  if (path != NULL && head != NULL) code = open_at(path, head, o, p, out);
  else progress_error(p, "out of memory for the journal");
  free(path);
  free(head);
  return code;
}

const char *resume_advice(const journal *j, char *text, size_t size)
{
  text[0] = '\0';
  if (j != NULL && journal_count(j) > 0)
    snprintf(text, size, "%zu finished tasks are kept in %s, and the same command with --resume "
             "goes on from there", journal_count(j), journal_path(j));
  return text;
}
