/* journal.c -- records of finished tasks on disk; see journal.h. */
#define _XOPEN_SOURCE 700 /* fdatasync */
#define _DEFAULT_SOURCE   /* flock */
#include "farm/journal.h"

#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "farm/numbers.h"
#include "system/clock.h"
#include "system/file.h"
#include "system/grow.h"

struct journal {
  char *path;
  char *head;
  struct opened {
    int fd;
    char *name;
  } *file;          /* the first is written to */
  size_t files, room;
  off_t end;        /* of the first */
  journal_index index;
  size_t own;       /* records in the first file */
  int locked;       /* the first, by this process */
  int broken;       /* nothing more is written to it */
  int named;        /* the user has named the folder: journals of others count */
  char others[FILE_WORDS]; /* that the first is another's */
  int stays;        /* even if it holds nothing */
  int dirty;        /* some of it may not be on disk yet */
  double synced;
  pthread_mutex_t lock; /* guards the file and, once threads append to it, the index */
};

uint64_t journal_stage(size_t ordinal, const char *name, size_t tasks, size_t record_size)
{
  char text[200];
  snprintf(text, sizeof text, "%zu %zu %.150s", tasks, record_size, name);
  return (uint64_t)journal_file_sum(text, strlen(text)) << 32 | (uint32_t)ordinal;
}

const char *journal_place(const journal *j, uint64_t stage, uint64_t task)
{
  const journal_slot *s = index_find(&j->index, stage, task);
  return s != NULL ? j->file[s->file].name : NULL;
}

int journal_has(journal *j, uint64_t stage, uint64_t task)
{
  if (j == NULL) return 0;
  pthread_mutex_lock(&j->lock);
  const int has = index_find(&j->index, stage, task) != NULL;
  pthread_mutex_unlock(&j->lock);
  return has;
}

size_t journal_count(const journal *j)
{
  return j->index.count;
}

size_t journal_own(const journal *j)
{
  return j->own;
}

size_t journal_states(const journal *j)
{
  return j->index.states;
}

const char *journal_path(const journal *j)
{
  return j->path;
}

int journal_alone(const journal *j)
{
  return j != NULL && j->locked;
}

/* ---- opening ------------------------------------------------------------------------------- */

static pendres_status complain(char *words, pendres_status status, const char *what,
                               const char *path, const char *why)
{
  snprintf(words, JOURNAL_WORDS, "%s '%s': %s", what, path, why);
  return status;
}

static off_t size_of(int fd)
{
  struct stat s;
  return fstat(fd, &s) == 0 ? s.st_size : 0;
}

/* All records of a file into the index; *end is where what is whole ends. */
static pendres_status load(journal *j, size_t file, off_t *end)
{
  journal_entry e;
  for (off_t at = *end; journal_file_next(j->file[file].fd, at, &e); at = *end) {
    if (!index_note(&j->index, file, &e, at)) return PENDRES_OUT_OF_MEMORY;
    *end = at + (off_t)(sizeof e + e.stored);
  }
  return PENDRES_OK;
}

/* One more file; its number is files - 1. */
static pendres_status take_file(journal *j, int fd, const char *name)
{
  char *copy = malloc(strlen(name) + 1);
  if (copy == NULL || !grow_to(&j->file, j->files + 1, &j->room, sizeof *j->file)) {
    free(copy);
    close(fd);
    return PENDRES_OUT_OF_MEMORY;
  }
  strcpy(copy, name);
  j->file[j->files++] = (struct opened){ fd, copy };
  return PENDRES_OK;
}

static void drop_own(journal *j)
{
  close(j->file[0].fd);
  free(j->file[0].name);
  j->files = 0;
}

/* Open the own file, locked; it may be empty, and is if it is to be `use` FILE_NEW. */
static pendres_status open_own(journal *j, file_use use, char *words)
{
  for (int attempt = 0; attempt < JOURNAL_ATTEMPTS; attempt++) {
    const int fd = file_open(j->path, use, j->named, j->others);
    if (fd < 0) {
      snprintf(words, JOURNAL_WORDS, "cannot write the journal: %.450s", j->others);
      return PENDRES_IO;
    }
    /* On a file system without locks the output's own lock has to suffice. */
    j->locked = flock(fd, LOCK_EX | LOCK_NB) == 0;
    if (!j->locked && errno == EWOULDBLOCK) {
      close(fd);
      return complain(words, PENDRES_BUSY, "the journal", j->path, "another run is writing it");
    }
    /* The run that had it may have removed it at its end, before it was locked. */
    if (file_is(fd, j->path)) return take_file(j, fd, j->path);
    close(fd);
  }
  return complain(words, PENDRES_BUSY, "the journal", j->path,
                  "it is replaced all the time by other runs");
}

/* Keep the own file under another name, for what it holds is not this run's to remove, and begin
   another. */
static pendres_status begin_anew(journal *j, const char *what, const char *more, char *words)
{
  int why = 0;
  char *name = file_keep(j->path, &why);
  if (name != NULL) why = file_remove(j->file[0].fd, j->path);
  drop_own(j);
  if (why != 0) {
    free(name);
    return complain(words, PENDRES_IO, "cannot set aside the journal", j->path, strerror(why));
  }
  const pendres_status status = open_own(j, FILE_NEW, words);
  if (status == PENDRES_OK)
    snprintf(words, JOURNAL_WORDS, "%s is kept as '%.300s'%s", what, name, more);
  free(name);
  return status;
}

/* Is the own file a journal without records, or the beginning of one? */
static int is_bare(const journal *j, journal_head found, off_t end)
{
  journal_entry e;
  const off_t size = size_of(j->file[0].fd);
  if (found == JOURNAL_TORN) return size <= (off_t)(JOURNAL_HEAD + strlen(j->head));
  return found != JOURNAL_NONE && size == end && !journal_file_next(j->file[0].fd, end, &e);
}

static pendres_status empty_own(const journal *j, char *words)
{
  if (ftruncate(j->file[0].fd, 0) == 0) return PENDRES_OK;
  return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
}

/* The own file of a run that does not go on from it is kept, unless it holds nothing. */
static pendres_status clear_own(journal *j, char *words)
{
  static const char *const what[] = {
    [JOURNAL_SAME] = "the journal of a stopped run of this deck, from which --resume goes on,",
    [JOURNAL_OTHER] = "the journal of another deck or build",
    [JOURNAL_NONE] = "what stood in the place of the journal",
    [JOURNAL_TORN] = "a journal with a damaged head",
  };
  off_t end = 0;
  const journal_head found = journal_file_head(j->file[0].fd, j->path, j->head, &end, words);
  words[0] = '\0';
  if (found == JOURNAL_NO_MEMORY) return PENDRES_OUT_OF_MEMORY;
  return is_bare(j, found, end) ? empty_own(j, words) : begin_anew(j, what[found], "", words);
}

/* The head of the own file: compared, or written where there is none or it is damaged. Sets
   j->end. */
static pendres_status settle_head(journal *j, char *words)
{
  pendres_status status = PENDRES_OK;
  switch (journal_file_head(j->file[0].fd, j->path, j->head, &j->end, words)) {
  case JOURNAL_SAME: return PENDRES_OK;
  case JOURNAL_OTHER:
  case JOURNAL_NONE: return PENDRES_INVALID_ARGUMENT;
  case JOURNAL_NO_MEMORY: return PENDRES_OUT_OF_MEMORY;
  case JOURNAL_TORN: break;
  }
  if (is_bare(j, JOURNAL_TORN, 0)) status = empty_own(j, words);
  else
    status = begin_anew(j, "the head of the journal is damaged: it", ", and all is computed again",
                        words);
  if (status != PENDRES_OK) return status;
  if (journal_file_begin(j->file[0].fd, j->head, &j->end)) return PENDRES_OK;
  return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
}

/* Records of the own file; its torn end is cut off. */
static pendres_status load_own(journal *j, char *words)
{
  const pendres_status status = load(j, 0, &j->end);
  const off_t dropped = size_of(j->file[0].fd) - j->end;
  j->own = j->index.count;
  if (status != PENDRES_OK || dropped <= 0) return status;
  if (ftruncate(j->file[0].fd, j->end) != 0)
    return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
  snprintf(words, JOURNAL_WORDS, "the journal '%s' is torn or damaged from byte %lld on: %lld "
           "bytes are dropped, and what they held is computed again", j->path, (long long)j->end,
           (long long)dropped);
  return PENDRES_OK;
}

/* What a run that was killed while it wrote its journal anew has left: PATH.new, to be freed. */
static char *new_name(const journal *j)
{
  const size_t size = strlen(j->path) + sizeof ".new";
  char *name = malloc(size);
  if (name != NULL) snprintf(name, size, "%s.new", j->path);
  return name;
}

static void drop_new(const journal *j)
{
  char words[FILE_WORDS], *name = j->locked ? new_name(j) : NULL;
  const int fd = name != NULL ? file_open(name, FILE_TRUSTED, 0, words) : -1;
  if (fd >= 0) (void)file_remove(fd, name);
  if (fd >= 0) close(fd);
  free(name);
}

static pendres_status build(journal *j, const char *path, const char *head, journal_from from,
                            char *words)
{
  const size_t length = strlen(path);
  j->path = malloc(length + 1);
  j->head = malloc(strlen(head) + 1);
  if (j->path == NULL || j->head == NULL) return PENDRES_OUT_OF_MEMORY;
  strcpy(j->path, path);
  strcpy(j->head, head);
  j->named = from == JOURNAL_NAMED;
  pendres_status status = open_own(j, FILE_OWN, words);
  /* Only now it is known that no other run uses it. */
  if (status == PENDRES_OK && from == JOURNAL_ANEW && size_of(j->file[0].fd) > 0)
    status = clear_own(j, words);
  if (status == PENDRES_OK) status = settle_head(j, words);
  if (status == PENDRES_OK) status = load_own(j, words);
  if (status == PENDRES_OK) drop_new(j);
  const size_t used = strlen(words);
  if (status == PENDRES_OK && j->others[0] != '\0')
    snprintf(words + used, JOURNAL_WORDS - used, "%s%s", used > 0 ? "; " : "", j->others);
  return status;
}

static void let_go(journal *j)
{
  for (size_t i = 0; i < j->files; i++) {
    close(j->file[i].fd);
    free(j->file[i].name);
  }
  index_free(&j->index);
  free(j->file);
  free(j->head);
  free(j->path);
  (void)pthread_mutex_destroy(&j->lock);
  free(j);
}

pendres_status journal_open(const char *path, const char *head, journal_from from, journal **out,
                            char words[JOURNAL_WORDS])
{
  journal *j = calloc(1, sizeof *j);
  *out = NULL;
  words[0] = '\0';
  if (j == NULL) return PENDRES_OUT_OF_MEMORY;
  if (pthread_mutex_init(&j->lock, NULL) != 0) {
    free(j);
    return PENDRES_OUT_OF_MEMORY;
  }
  j->synced = clock_wall();
  const pendres_status status = build(j, path, head, from, words);
  if (status == PENDRES_OK) {
    *out = j;
    return status;
  }
  if (status == PENDRES_OUT_OF_MEMORY)
    (void)complain(words, status, "the journal", path, pendres_status_message(status));
  let_go(j);
  return status;
}

pendres_status journal_add(journal *j, const char *path, char words[JOURNAL_WORDS])
{
  off_t end = 0;
  const int fd = file_open(path, FILE_TRUSTED, j->named, words);
  if (fd < 0)
    return errno == ENOENT ? PENDRES_NOT_FOUND
           : errno == EPERM ? PENDRES_INVALID_ARGUMENT : PENDRES_IO;
  pendres_status status = take_file(j, fd, path);
  if (status != PENDRES_OK) return status;
  switch (journal_file_head(fd, path, j->head, &end, words)) {
  case JOURNAL_SAME: return load(j, j->files - 1, &end);
  case JOURNAL_OTHER:
  case JOURNAL_NONE: return PENDRES_INVALID_ARGUMENT;
  case JOURNAL_NO_MEMORY: return PENDRES_OUT_OF_MEMORY;
  case JOURNAL_TORN: break; /* nothing is there yet */
  }
  return PENDRES_OK;
}

/* ---- records ------------------------------------------------------------------------------- */

static pendres_status read_record(const journal *j, uint64_t stage, uint64_t task,
                                  farm_record *record)
{
  journal_entry e;
  const journal_slot *s = index_find(&j->index, stage, task);
  if (s == NULL) return PENDRES_NOT_FOUND;
  const int fd = j->file[s->file].fd;
  if (!journal_file_entry(fd, s->at, &e) || e.size > SIZE_MAX / 2) return PENDRES_IO;
  *record = (farm_record){ 0 };
  if (farm_record_resize(record, (size_t)e.size) == NULL) return PENDRES_OUT_OF_MEMORY;
  record->cost = (pendres_cost){ e.cost[0], e.cost[1], e.cost[2], e.cost[3], e.cost[4] };
  if (journal_file_data(fd, s->at, &e, record->data)) return PENDRES_OK;
  free(record->data);
  record->data = NULL;
  return PENDRES_IO;
}

/* The file stays the same one until all is read: threads that append may replace it. */
pendres_status journal_read(journal *j, uint64_t stage, uint64_t task, farm_record *record)
{
  pthread_mutex_lock(&j->lock);
  const pendres_status status = read_record(j, stage, task, record);
  pthread_mutex_unlock(&j->lock);
  return status;
}

/* What counts of the first file, in its order, goes behind the head of another one; to < 0: that is
   done, and the index learns the places. 0 on failure. */
static int move_live(journal *j, int to, off_t *end)
{
  const int from = j->file[0].fd;
  journal_entry e;
  *end = JOURNAL_HEAD + (off_t)strlen(j->head);
  for (off_t at = *end, length; at < j->end; at += length) {
    if (!journal_file_entry(from, at, &e)) return 0;
    length = (off_t)(sizeof e + e.stored);
    journal_slot *s = index_find(&j->index, e.stage, e.task);
    if (s == NULL || s->file != 0 || s->at != at) continue;
    if (to < 0) s->at = *end;
    else if (!journal_file_copy(from, at, to, *end, length)) return 0;
    *end += length;
  }
  return 1;
}

/* The first file again without states that count no more, under its name: what is killed meanwhile
   leaves the one that was there. The lock keeps others from doing the same. */
static int replace_own(journal *j, const char *name)
{
  char words[FILE_WORDS];
  off_t end = 0;
  const int old = j->file[0].fd, fd = file_open(name, FILE_OWN, 0, words);
  if (fd < 0) return 0;
  file_like(fd, j->path);
  const int whole = ftruncate(fd, 0) == 0 && flock(fd, LOCK_EX | LOCK_NB) == 0 &&
                    journal_file_begin(fd, j->head, &end) && move_live(j, fd, &end) &&
                    fsync(fd) == 0 && file_is(old, j->path) && rename(name, j->path) == 0;
  if (!whole) {
    (void)file_remove(fd, name);
    close(fd);
    return 0;
  }
  (void)move_live(j, -1, &end);
  close(old);
  j->file[0].fd = fd;
  j->end = end;
  return 1;
}

/* States that count no more take at most as much as all that counts, and a little. Where they
   cannot be left out they stay, until there are as many again. */
static void compact(journal *j)
{
  const off_t counts = j->end - j->index.dead;
  char *name = j->locked && j->index.dead >= counts + JOURNAL_DEAD ? new_name(j) : NULL;
  if (name == NULL) return;
  (void)replace_own(j, name);
  free(name);
  j->index.dead = 0;
}

/* Under the lock. */
static pendres_status append(journal *j, uint64_t stage, uint64_t task, const farm_record *r,
                             char *words)
{
  const pendres_cost *c = &r->cost;
  journal_entry e = { .stage = stage, .task = task, .size = r->size,
                      .cost = { c->pendulum_periods, c->rhs_evaluations, c->steps, c->newton_steps,
                                c->settled_pendulums } };
  if (!journal_file_append(j->file[0].fd, j->end, &e, r->data)) {
    j->broken = 1;
    (void)complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
    const int cut = ftruncate(j->file[0].fd, j->end);
    (void)cut; /* where it stays, the torn end is dropped later */
    return PENDRES_IO;
  }
  const off_t at = j->end;
  j->end += (off_t)(sizeof e + e.stored);
  j->own += (task & JOURNAL_STATE) == 0;
  j->dirty = 1;
  if (clock_wall() - j->synced > journal_sync_after) {
    (void)fdatasync(j->file[0].fd);
    j->synced = clock_wall();
  }
  if (!index_note(&j->index, 0, &e, at)) return PENDRES_OUT_OF_MEMORY;
  compact(j);
  return PENDRES_OK;
}

pendres_status journal_append(journal *j, uint64_t stage, uint64_t task, const farm_record *record,
                              char words[JOURNAL_WORDS])
{
  pendres_status status = PENDRES_IO;
  words[0] = '\0';
  pthread_mutex_lock(&j->lock);
  if (!j->broken) status = append(j, stage, task, record, words);
  pthread_mutex_unlock(&j->lock);
  return status;
}

/* ---- the end ------------------------------------------------------------------------------- */

void journal_stay(journal *j)
{
  if (j != NULL) j->stays = 1;
}

void journal_close(journal *j)
{
  if (j == NULL) return;
  if (j->own + j->index.states == 0 && !j->stays) (void)file_remove(j->file[0].fd, j->path);
  else if (j->dirty) (void)fsync(j->file[0].fd);
  let_go(j);
}

void journal_remove(journal *j)
{
  if (j == NULL) return;
  /* One that another run is still writing is that run's. */
  for (size_t i = 0; i < j->files; i++)
    if (i == 0 || flock(j->file[i].fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
      (void)file_remove(j->file[i].fd, j->file[i].name);
  let_go(j);
}
