/* resume.c -- a run that goes on where an earlier one was stopped; see run.h. */
#define _POSIX_C_SOURCE 200809L /* opendir */
#include "run.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <pendres/store.h>

#include "shard.h"

/* Where journals stand: the folder, and what their names begin with. Free both. */
typedef struct place {
  char *folder, *base;
} place;

static void place_free(place *p)
{
  free(p->folder);
  free(p->base);
}

static char *copy_of(const char *text, size_t length)
{
  char *copy = malloc(length + 1);
  if (copy == NULL) return NULL;
  memcpy(copy, text, length);
  copy[length] = '\0';
  return copy;
}

/* Beside the file that the output goes to, or in a folder of the user's. 0: no memory. */
static int place_of(const deck *d, const options *o, place *p)
{
  char *target = NULL;
  *p = (place){ 0 };
  if (pendres_store_target(d->output, &target, NULL, 0) != PENDRES_OK) return 0;
  const char *slash = strrchr(target, '/');
  const char *name = slash != NULL ? slash + 1 : target;
  p->base = copy_of(name, strlen(name));
  if (o->journal != NULL) p->folder = copy_of(o->journal, strlen(o->journal));
  else if (slash == NULL) p->folder = copy_of(".", 1);
  else p->folder = copy_of(target, slash == target ? 1 : (size_t)(slash - target));
  free(target);
  return p->folder != NULL && p->base != NULL;
}

/* FOLDER/NAME.ENDING, to be freed; a folder that is the working one is not named. */
static char *path_in(const char *folder, const char *name, const char *ending)
{
  const int here = strcmp(folder, ".") == 0;
  const size_t size = strlen(folder) + strlen(name) + strlen(ending) + 2;
  char *path = malloc(size);
  if (path != NULL)
    snprintf(path, size, "%s%s%s%s", here ? "" : folder, here ? "" : "/", name, ending);
  return path;
}

static char *own_path(const place *p, const options *o)
{
  char ending[SHARD_NAME + 16] = "";
  if (o->shards > 0) shard_suffix(o->shard, o->shards, ending);
  strcat(ending, ".journal");
  return path_in(p->folder, p->base, ending);
}

/* A checksum of what the C library's functions give: their last digits differ from one library to
   another, and in glibc with processors, whether these have FMA. One argument in a thousand shows
   it. */
static uLong roundings(void)
{
  uLong sum = crc32(0L, Z_NULL, 0);
  for (int k = 1; k <= 16384; k++) {
    const double x = 0.00137 * k, y = x / 23.0;
    const double found[] = {sin(x), cos(x), tan(x), asin(y), acos(y), atan2(x, 1.7), exp(-x),
                            exp2(x), expm1(-y), log(x), log10(x), pow(x, 1.1), hypot(x, 1.3)};
    sum = crc32(sum, (const Bytef *)found, (uInt)sizeof found);
  }
  return sum;
}

/* What records depend on, a line each; to be freed. NULL: no memory. Titles and the names of
   outputs change nothing. */
static char *head_of(const deck *d)
{
  deck same = *d;
  char *text = NULL, *head = NULL;
  same.output[0] = same.title[0] = '\0';
  same.precision.unresolved_share = 0.0; /* as does what is tolerated */
  if (deck_resolved(&same, &text) != PENDRES_OK) return NULL;
  const char *version = pendres_version(), *build = pendres_build_info();
  static const char sources[] = SOURCES_SUM; /* the Makefile's checksum of all that is compiled */
  const size_t size = strlen(version) + sizeof sources + strlen(build) + strlen(text) + 96;
  head = malloc(size);
  if (head != NULL)
    snprintf(head, size, "libpendres %s, sources %s\n%s\nroundings of the C library %08lx\n%s",
             version, sources, build, roundings(), text);
  free(text);
  return head;
}

static int complain(progress *p, pendres_status status, const char *words, const char *advice)
{
  progress_error(p, "%s%s", progress_words(words, status),
                 status == PENDRES_INVALID_ARGUMENT ? advice : "");
  return status == PENDRES_INVALID_ARGUMENT ? BAD_USAGE : FAILED;
}

/* The journals of the parts, of which *count there are. A part goes on without what it cannot read
   of others, as those of an earlier deck. */
static int add_parts(const place *at, const options *o, const char *own, progress *p, journal *j,
                     size_t *count)
{
  char words[JOURNAL_WORDS];
  DIR *folder = opendir(at->folder);
  int code = 0;
  *count = 0;
  if (folder == NULL) return 0; /* without it the own journal could not be there */
  for (const struct dirent *e = readdir(folder); e != NULL && code == 0; e = readdir(folder)) {
    if (!shard_is_journal(e->d_name, at->base)) continue;
    char *path = path_in(at->folder, e->d_name, "");
    if (path == NULL) {
      progress_error(p, "out of memory for the journals of parts");
      code = FAILED;
    } else if (strcmp(path, own) != 0) {
      const pendres_status status = journal_add(j, path, words);
      *count += status == PENDRES_OK;
      if (status == PENDRES_OK && words[0] != '\0') progress_note(p, "%s", words);
      if (status != PENDRES_OK && o->merge) {
        progress_error(p, "%s", words[0] != '\0' ? words
                                                 : "out of memory for the journals of parts");
        code = status == PENDRES_INVALID_ARGUMENT ? BAD_USAGE : FAILED;
      }
    }
    free(path);
  }
  (void)closedir(folder);
  return code;
}

static const char *unfinished(const journal *j)
{
  return journal_states(j) > 0 ? " and the states of unfinished ones" : "";
}

static int open_at(const place *at, const char *path, const char *head, const options *o,
                   progress *p, journal **out)
{
  char words[JOURNAL_WORDS];
  size_t parts = 0;
  int code = 0;
  const journal_from from = !o->resume && !o->merge ? JOURNAL_ANEW
                            : o->journal != NULL    ? JOURNAL_NAMED
                                                    : JOURNAL_RESUMED;
  const pendres_status status = journal_open(path, head, from, out, words);
  if (status != PENDRES_OK)
    return complain(p, status, words, " (without --resume all is computed, and that journal "
                    "kept under another name)");
  if (words[0] != '\0') progress_warning(p, "%s", words);
  const size_t own = journal_count(*out);
  if (own + journal_states(*out) > 0)
    progress_note(p, "going on from %zu finished task%s%s in %s", own, own == 1 ? "" : "s",
                  unfinished(*out), path);
  if (o->shards > 0 || o->merge) code = add_parts(at, o, path, p, *out, &parts);
  if (code == 0 && o->merge && parts == 0) {
    progress_error(p, "there are no journals of parts, %s.I-of-N.journal, in the folder '%s'",
                   at->base, at->folder);
    code = BAD_USAGE;
  }
  if (code == 0 && parts > 0)
    progress_note(p, "%zu finished tasks in the journals of %zu%s part%s",
                  journal_count(*out) - own, parts, o->merge ? "" : " other",
                  parts == 1 ? "" : "s");
  return code;
}

int resume_open(const deck *d, const options *o, progress *p, journal **out)
{
  place at = { 0 };
  char *path = NULL, *head = NULL;
  int code = FAILED;
  *out = NULL;
  if (scene_find(d->kind)->timed) { /* what is timed is not the same twice */
    if (o->shards == 0 && !o->merge) return 0;
    progress_error(p, "methods are timed beside each other, not in parts");
    return BAD_USAGE;
  }
  if (o->no_journal) return 0;
  if (place_of(d, o, &at)) {
    path = own_path(&at, o);
    head = head_of(d);
  }
  if (path != NULL && head != NULL) code = open_at(&at, path, head, o, p, out);
  else progress_error(p, "out of memory for the journal");
  place_free(&at);
  free(path);
  free(head);
  return code;
}

const char *resume_advice(const journal *j, char *text, size_t size)
{
  text[0] = '\0';
  if (j != NULL && journal_own(j) + journal_states(j) > 0)
    snprintf(text, size, "%zu finished tasks%s are kept in %s, and the same command with --resume "
             "goes on from there", journal_own(j), unfinished(j), journal_path(j));
  return text;
}

void resume_leave(journal *j, size_t lost, progress *p)
{
  char kept[JOURNAL_WORDS] = " them";
  if (lost == 0) {
    journal_remove(j);
    return;
  }
  if (j != NULL && journal_count(j) > 0)
    snprintf(kept, sizeof kept, " these alone, since all else is kept in %.300s",
             journal_own(j) > 0 ? journal_path(j) : "the journals of the parts");
  progress_note(p, "%zu point%s ended by --budget; the same command with --resume and a larger "
                "budget, or none, computes%s", lost, lost == 1 ? " was" : "s were", kept);
  journal_close(j);
}
