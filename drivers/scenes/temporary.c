/* temporary.c -- see temporary.h. */
#define _POSIX_C_SOURCE 200809L /* mkstemp */
#include "scenes/temporary.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "system/bytes.h"

/* A file without a name, in TMPDIR or, without that, beside the output. */
static pendres_status open_file(scene_run *run, scene_temporary *s)
{
  char path[DECK_PATH + 32];
  const char *folder = getenv("TMPDIR"), *output = run->deck->output;
  const char *slash = strrchr(output, '/');
  if (folder != NULL && *folder != '\0')
    snprintf(path, sizeof path, "%.1000s/resonance-XXXXXX", folder);
  else
    snprintf(path, sizeof path, "%.*s.resonance-XXXXXX",
             slash != NULL ? (int)(slash - output) + 1 : 0, output);
  s->file = mkstemp(path);
  if (s->file >= 0 && unlink(path) == 0) return PENDRES_OK;
  return scene_fail(run, PENDRES_IO, "a temporary file, %s: %s", path, strerror(errno));
}

pendres_status scene_temporary_create(scene_run *run, size_t n, size_t element, size_t memory,
                                      scene_temporary *out)
{
  if (!scene_going(run)) return run->status;
  *out = (scene_temporary){.element = element, .file = -1};
  if (n > memory / element) return open_file(run, out);
  out->memory = calloc(n + 1, element);
  return out->memory != NULL ? PENDRES_OK
                             : scene_fail(run, PENDRES_OUT_OF_MEMORY,
                                          "out of memory for %zu points", n);
}

void scene_temporary_free(scene_temporary *s)
{
  if (s->element == 0) return;
  free(s->memory);
  if (s->file >= 0) (void)close(s->file);
  *s = (scene_temporary){.element = 0};
}

static const char failure[] = "the temporary file of results: %s";

pendres_status scene_temporary_put(scene_run *run, const scene_temporary *s, size_t first, size_t n,
                                   const void *data)
{
  const size_t at = first * s->element, bytes = n * s->element;
  if (!scene_going(run)) return run->status;
  if (s->memory != NULL) memcpy(s->memory + at, data, bytes);
  else if (!bytes_write(s->file, (off_t)at, data, bytes))
    (void)scene_fail(run, PENDRES_IO, failure, strerror(errno));
  return run->status;
}

pendres_status scene_temporary_get(const scene_temporary *s, size_t first, size_t n, void *data,
                                   char *why, size_t size)
{
  const size_t at = first * s->element, bytes = n * s->element;
  if (s->memory != NULL) memcpy(data, s->memory + at, bytes);
  else if (!bytes_read(s->file, (off_t)at, data, bytes)) {
    snprintf(why, size, failure, strerror(errno));
    return PENDRES_IO;
  }
  return PENDRES_OK;
}

pendres_status scene_temporary_read(scene_run *run, const scene_temporary *s, size_t first,
                                    size_t n, void *data)
{
  char why[200];
  if (!scene_going(run)) return run->status;
  const pendres_status status = scene_temporary_get(s, first, n, data, why, sizeof why);
  return status == PENDRES_OK ? run->status : scene_fail(run, status, "%s", why);
}
