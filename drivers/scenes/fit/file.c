/* file.c -- the file of a fit's data; see file.h. */
#include "scenes/fit/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scenes/numbers.h"
#include "system/bytes.h"
#include "system/file.h"

/* From the deck's folder, unless the path begins at the root. */
static int open_file(scene_run *run, fit_file *out)
{
  char why[FILE_WORDS];
  const char *name = run->deck->name, *file = run->deck->data.file, *slash = strrchr(name, '/');
  const int folder = file[0] != '/' && slash != NULL ? (int)(slash - name) + 1 : 0;
  const int length = snprintf(out->path, sizeof out->path, "%.*s%s", folder, name, file);
  if (length < 0 || (size_t)length >= sizeof out->path) {
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT, "data.file: the path is too long");
    return -1;
  }
  const int fd = file_open(out->path, FILE_READ, 0, why);
  if (fd < 0)
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT,
                     "%s: data.file is looked for from the deck's folder", why);
  return fd;
}

void fit_file_read(scene_run *run, fit_file *out)
{
  static const char results[4] = "\211HDF";
  const char *format = run->deck->data.format;
  char first[sizeof results];
  *out = (fit_file){.length = 0};
  const int fd = open_file(run, out);
  if (fd < 0) return;
  const int stored = bytes_read(fd, 0, first, sizeof first) &&
                     memcmp(first, results, sizeof first) == 0;
  const pendres_status status =
    stored ? fit_store_text(run, out->path, fd, &out->text, &out->length)
           : bytes_text(fd, FIT_MOST_BYTES, &out->text, &out->length);
  if (status == PENDRES_UNSUPPORTED)
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT,
                     "%s: more than %d MiB of data are not read: leave out what is no datum",
                     out->path, FIT_MOST_BYTES >> 20);
  else if (status != PENDRES_OK)
    (void)scene_fail(run, status, "%s: %s", out->path,
                     status == PENDRES_IO ? strerror(errno) : "out of memory for data");
  (void)close(fd);
  if (!scene_going(run) || stored) return;
  if (strcmp(format, "touchstone") == 0 ||
      (strcmp(format, "any") == 0 && fit_is_touchstone(out->path, out->text)))
    fit_touchstone(run, out);
}
