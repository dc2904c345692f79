/* run.c -- a run that goes on until something fails, and its arrays; see run.h. */
#define _POSIX_C_SOURCE 200809L /* mkstemp, posix_fallocate */
#include "results/run.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* ---- failures ------------------------------------------------------------------------------ */

int scene_going(const scene_run *run)
{
  return run->status == PENDRES_OK;
}

int scene_prints(const scene_run *run)
{
  return run->table != NULL && scene_going(run);
}

pendres_status scene_fail(scene_run *run, pendres_status status, const char *format, ...)
{
  va_list args;
  if (!scene_going(run)) return run->status;
  run->status = status;
  va_start(args, format);
  (void)vsnprintf(run->message, sizeof run->message, format, args);
  va_end(args);
  return status;
}

pendres_status scene_stored(scene_run *run, pendres_status status)
{
  if (status != PENDRES_OK) (void)scene_fail(run, status, "%s", pendres_store_message(run->store));
  return run->status;
}

pendres_context *scene_context(scene_run *run)
{
  pendres_context *ctx = scene_going(run) ? farm_context(run->farm) : NULL;
  if (ctx == NULL) (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for a context");
  return ctx;
}

pendres_status scene_asked(scene_run *run, pendres_status status)
{
  if (status != PENDRES_OK)
    (void)scene_fail(run, status, "%s", pendres_context_message(farm_context(run->farm)));
  return run->status;
}

void scene_compute(scene_run *run, const farm_stage *stage)
{
  if (!scene_going(run)) return;
  const pendres_status status = farm_run(run->farm, stage);
  if (status != PENDRES_OK) scene_fail(run, status, "%s", farm_message(run->farm));
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* Before the elements of an array, which are aligned as those of malloc are. */
typedef struct scene_held {
  struct scene_held *next;
  size_t mapped; /* bytes of the file that holds it; 0: it is in memory */
  max_align_t elements[];
} scene_held;

int scene_unnamed(scene_run *run, size_t bytes)
{
  char path[DECK_PATH + 32];
  const char *folder = getenv("TMPDIR"), *output = run->deck->output;
  const char *slash = strrchr(output, '/');
  if (folder != NULL && *folder != '\0')
    snprintf(path, sizeof path, "%.1000s/resonance-XXXXXX", folder);
  else
    snprintf(path, sizeof path, "%.*s.resonance-XXXXXX",
             slash != NULL ? (int)(slash - output) + 1 : 0, output);
  const int file = mkstemp(path);
  int why = file < 0 || unlink(path) != 0 ? errno : 0;
  /* A signal that asks a run to stop is heeded between tasks, not here. */
  if (why == 0 && bytes > 0) do why = posix_fallocate(file, 0, (off_t)bytes); while (why == EINTR);
  if (why == 0) return file;
  (void)scene_fail(run, PENDRES_IO, "a temporary file, %s: %s", path, strerror(why));
  if (file >= 0) (void)close(file);
  return -1;
}

static scene_held *map_file(scene_run *run, size_t bytes)
{
  const int file = scene_unnamed(run, bytes);
  if (file < 0) return NULL;
  scene_held *held = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  (void)close(file);
  if (held == MAP_FAILED) return NULL;
  held->mapped = bytes;
  return held;
}

static void *hold(scene_room *room, scene_held *held)
{
  if (held == NULL) return NULL;
  held->next = room->held;
  room->held = held;
  return held->elements;
}

/* Bytes of n elements, with one more, so that none is an array, too; 0: there cannot be as many. */
static size_t bytes_of(size_t n, size_t size)
{
  const size_t head = sizeof(scene_held);
  return size > 0 && n >= (SIZE_MAX - head) / size - 1 ? 0 : head + (n + 1) * size;
}

void *scene_room_take(scene_room *room, size_t n, size_t size)
{
  const size_t bytes = bytes_of(n, size);
  return hold(room, bytes > 0 ? calloc(1, bytes) : NULL);
}

void scene_room_end(scene_room *room)
{
  while (room->held != NULL) {
    scene_held *held = room->held;
    room->held = held->next;
    if (held->mapped > 0) (void)munmap(held, held->mapped);
    else free(held);
  }
}

/* Of a run; NULL: why is on record. */
static void *of_run(scene_run *run, void *elements, size_t n)
{
  if (elements == NULL)
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", n);
  return elements;
}

void *scene_array(scene_run *run, size_t n, size_t size)
{
  return scene_going(run) ? of_run(run, scene_room_take(&run->room, n, size), n) : NULL;
}

void *scene_room_large(scene_run *run, scene_room *room, size_t n, size_t size, size_t most)
{
  const size_t bytes = bytes_of(n, size);
  if (!scene_going(run)) return NULL;
  return of_run(run, bytes <= most ? scene_room_take(room, n, size)
                                   : hold(room, map_file(run, bytes)), n);
}

void *scene_large(scene_run *run, size_t n, size_t size)
{
  return scene_room_large(run, &run->room, n, size, SCENE_MEMORY);
}
