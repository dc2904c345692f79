/* journal.c -- records of finished tasks on disk; see journal.h. */
#define _POSIX_C_SOURCE 200809L /* fdatasync */
#define _DEFAULT_SOURCE         /* flock */
#include "farm/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/clock.h"
#include "system/grow.h"

/* At most the records of so many seconds are lost when the machine fails. */
static const double sync_after = 10.0;

/* Where a record stands. */
typedef struct slot {
  int file;   /* 1 + the number of the file that holds the record; 0: there is none */
  off_t at;   /* of its head */
} slot;

typedef struct stage {
  slot *task;
  size_t count;
} stage;

struct journal {
  char *path, *aside;
  char *head;
  int *file;        /* the first is written to */
  char **added;     /* names of the files */
  size_t files, file_room, added_room;
  off_t end;        /* of the first */
  stage *stage;
  size_t stages, count;
  size_t own;       /* records in the first file */
  int broken;       /* it takes no more */
  int stays;        /* even if it holds nothing */
  int dirty;        /* some of it may not be on disk yet */
  double synced;
  pthread_mutex_t lock; /* guards the file and, once threads append to it, the index */
};

/* ---- the index ----------------------------------------------------------------------------- */

/* A record may be there twice: both have the same bytes. */
static pendres_status note(journal *j, size_t file, const journal_entry *e, off_t at)
{
  if (e->stage >= SIZE_MAX || e->task >= SIZE_MAX ||
      !grow_to(&j->stage, (size_t)e->stage + 1, &j->stages, sizeof *j->stage))
    return PENDRES_OUT_OF_MEMORY;
  stage *s = &j->stage[e->stage];
  if (!grow_to(&s->task, (size_t)e->task + 1, &s->count, sizeof *s->task))
    return PENDRES_OUT_OF_MEMORY;
  j->count += s->task[e->task].file == 0;
  s->task[e->task] = (slot){ (int)file + 1, at };
  return PENDRES_OK;
}

static const slot *find(const journal *j, size_t number, size_t task)
{
  if (j == NULL || number >= j->stages || task >= j->stage[number].count) return NULL;
  const slot *s = &j->stage[number].task[task];
  return s->file > 0 ? s : NULL;
}

int journal_has(const journal *j, size_t number, size_t task)
{
  return find(j, number, task) != NULL;
}

size_t journal_count(const journal *j)
{
  return j->count;
}

size_t journal_own(const journal *j)
{
  return j->own;
}

const char *journal_path(const journal *j)
{
  return j->path;
}

/* ---- opening ------------------------------------------------------------------------------- */

static pendres_status complain(char *words, pendres_status status, const char *what,
                               const char *path, const char *why)
{
  snprintf(words, JOURNAL_WORDS, "%s '%s': %s", what, path, why);
  return status;
}

/* All records of a file into the index; *end is where what is whole ends. */
static pendres_status load(journal *j, size_t file, off_t *end)
{
  journal_entry e;
  for (off_t at = *end; journal_file_next(j->file[file], at, &e); at = *end) {
    const pendres_status status = note(j, file, &e, at);
    if (status != PENDRES_OK) return status;
    *end = at + (off_t)(sizeof e + e.stored);
  }
  return PENDRES_OK;
}

/* One more file; its number is files - 1. */
static pendres_status take_file(journal *j, int fd, const char *name)
{
  char *copy = malloc(strlen(name) + 1);
  if (copy == NULL || !grow_to(&j->file, j->files + 1, &j->file_room, sizeof *j->file) ||
      !grow_to(&j->added, j->files + 1, &j->added_room, sizeof *j->added)) {
    free(copy);
    close(fd);
    return PENDRES_OUT_OF_MEMORY;
  }
  strcpy(copy, name);
  j->added[j->files] = copy;
  j->file[j->files++] = fd;
  return PENDRES_OK;
}

static void drop_own(journal *j)
{
  close(j->file[0]);
  free(j->added[0]);
  j->files = 0;
}

/* Refuse a journal that the run cannot go on from. */
static pendres_status set_aside(const journal *j, char *words)
{
  if (rename(j->path, j->aside) == 0 || errno == ENOENT) return PENDRES_OK;
  return complain(words, PENDRES_IO, "cannot set aside the journal", j->path, strerror(errno));
}

/* Open the own file, locked; it may be empty. */
static pendres_status open_own(journal *j, char *words)
{
  const int fd = open(j->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  struct stat status;
  if (fd < 0)
    return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
  if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(fd);
    return complain(words, PENDRES_IO, "cannot write the journal", j->path, "not a regular file");
  }
  /* Where a file system knows no locks the output's own lock has to do. */
  if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(fd);
    return complain(words, PENDRES_BUSY, "the journal", j->path, "another run is writing it");
  }
  return take_file(j, fd, j->path);
}

/* Set the own file aside and begin another. */
static pendres_status begin_anew(journal *j, char *words)
{
  drop_own(j);
  const pendres_status status = set_aside(j, words);
  return status == PENDRES_OK ? open_own(j, words) : status;
}

static off_t size_of(int fd)
{
  struct stat s;
  return fstat(fd, &s) == 0 ? s.st_size : 0;
}

/* The head of the own file: compared, or written where there is none or it is damaged. Sets
   j->end. */
static pendres_status settle_head(journal *j, char *words)
{
  pendres_status status = PENDRES_OK;
  switch (journal_file_head(j->file[0], j->head, &j->end, words)) {
  case JOURNAL_SAME: return PENDRES_OK;
  case JOURNAL_OTHER: return PENDRES_INVALID_ARGUMENT;
  case JOURNAL_NO_MEMORY: return PENDRES_OUT_OF_MEMORY;
  case JOURNAL_TORN: break;
  }
  if (size_of(j->file[0]) > 0) {
    status = begin_anew(j, words);
    if (status != PENDRES_OK) return status;
    snprintf(words, JOURNAL_WORDS, "the head of the journal '%s' is damaged: it is set aside, and "
             "all is computed again", j->path);
  }
  if (journal_file_begin(j->file[0], j->head, &j->end)) return PENDRES_OK;
  return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
}

/* Records of the own file; its torn end is cut off. */
static pendres_status load_own(journal *j, char *words)
{
  const pendres_status status = load(j, 0, &j->end);
  const off_t dropped = size_of(j->file[0]) - j->end;
  j->own = j->count;
  if (status != PENDRES_OK || dropped <= 0) return status;
  if (ftruncate(j->file[0], j->end) != 0)
    return complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
  snprintf(words, JOURNAL_WORDS, "the journal '%s' is torn or damaged from byte %lld on: %lld "
           "bytes are dropped, and what they held is computed again", j->path, (long long)j->end,
           (long long)dropped);
  return PENDRES_OK;
}

static pendres_status build(journal *j, const char *path, const char *head, int resume,
                            char *words)
{
  const size_t length = strlen(path);
  j->path = malloc(length + 1);
  j->aside = malloc(length + 2);
  j->head = malloc(strlen(head) + 1);
  if (j->path == NULL || j->aside == NULL || j->head == NULL) return PENDRES_OUT_OF_MEMORY;
  strcpy(j->path, path);
  snprintf(j->aside, length + 2, "%s~", path);
  strcpy(j->head, head);
  pendres_status status = open_own(j, words);
  /* Only now it is known that no other run uses it. */
  if (status == PENDRES_OK && !resume && size_of(j->file[0]) > 0) status = begin_anew(j, words);
  if (status == PENDRES_OK) status = settle_head(j, words);
  if (status == PENDRES_OK) status = load_own(j, words);
  return status;
}

static void let_go(journal *j)
{
  for (size_t i = 0; i < j->files; i++) {
    close(j->file[i]);
    free(j->added[i]);
  }
  free(j->added);
  for (size_t i = 0; i < j->stages; i++) free(j->stage[i].task);
  free(j->stage);
  free(j->file);
  free(j->head);
  free(j->path);
  free(j->aside);
  (void)pthread_mutex_destroy(&j->lock);
  free(j);
}

pendres_status journal_open(const char *path, const char *head, int resume, journal **out,
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
  const pendres_status status = build(j, path, head, resume, words);
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
  words[0] = '\0';
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return complain(words, errno == ENOENT ? PENDRES_NOT_FOUND : PENDRES_IO,
                    "cannot read the journal", path, strerror(errno));
  pendres_status status = take_file(j, fd, path);
  if (status != PENDRES_OK) return status;
  switch (journal_file_head(fd, j->head, &end, words)) {
  case JOURNAL_SAME: return load(j, j->files - 1, &end);
  case JOURNAL_OTHER: return PENDRES_INVALID_ARGUMENT;
  case JOURNAL_NO_MEMORY: return PENDRES_OUT_OF_MEMORY;
  case JOURNAL_TORN: break; /* nothing is there yet */
  }
  return PENDRES_OK;
}

/* ---- records ------------------------------------------------------------------------------- */

pendres_status journal_read(journal *j, size_t number, size_t task, farm_record *record)
{
  journal_entry e;
  pthread_mutex_lock(&j->lock);
  const slot *found = find(j, number, task), s = found != NULL ? *found : (slot){ 0 };
  pthread_mutex_unlock(&j->lock);
  if (s.file == 0) return PENDRES_NOT_FOUND;
  const int fd = j->file[s.file - 1];
  if (!journal_file_entry(fd, s.at, &e) || e.size > SIZE_MAX / 2) return PENDRES_IO;
  *record = (farm_record){ 0 };
  if (farm_record_resize(record, (size_t)e.size) == NULL) return PENDRES_OUT_OF_MEMORY;
  record->cost = (pendres_cost){ e.cost[0], e.cost[1], e.cost[2], e.cost[3], e.cost[4] };
  if (journal_file_data(fd, s.at, &e, record->data)) return PENDRES_OK;
  free(record->data);
  record->data = NULL;
  return PENDRES_IO;
}

/* Under the lock. */
static pendres_status append(journal *j, size_t number, size_t task, const farm_record *r,
                             char *words)
{
  const pendres_cost *c = &r->cost;
  journal_entry e = { .stage = number, .task = task, .size = r->size,
                      .cost = { c->pendulum_periods, c->rhs_evaluations, c->steps, c->newton_steps,
                                c->settled_pendulums } };
  if (!journal_file_append(j->file[0], j->end, &e, r->data)) {
    j->broken = 1;
    (void)complain(words, PENDRES_IO, "cannot write the journal", j->path, strerror(errno));
    if (ftruncate(j->file[0], j->end) != 0) return PENDRES_IO; /* the torn end is dropped later */
    return PENDRES_IO;
  }
  const off_t at = j->end;
  j->end += (off_t)(sizeof e + e.stored);
  j->own++;
  j->dirty = 1;
  if (clock_wall() - j->synced > sync_after) {
    (void)fdatasync(j->file[0]);
    j->synced = clock_wall();
  }
  return note(j, 0, &e, at);
}

pendres_status journal_append(journal *j, size_t number, size_t task, const farm_record *record,
                              char words[JOURNAL_WORDS])
{
  pendres_status status = PENDRES_IO;
  words[0] = '\0';
  pthread_mutex_lock(&j->lock);
  if (!j->broken) status = append(j, number, task, record, words);
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
  if (j->own == 0 && !j->stays) (void)unlink(j->path);
  else if (j->dirty) (void)fsync(j->file[0]);
  let_go(j);
}

void journal_remove(journal *j)
{
  if (j == NULL) return;
  for (size_t i = 0; i < j->files; i++) (void)unlink(j->added[i]);
  (void)unlink(j->aside);
  let_go(j);
}
