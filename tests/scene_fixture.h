/*
 * scene_fixture.h -- running a scene inside a test, in a folder of its own, and reading what it
 * wrote. scene_enter() and scene_leave() are the group's set-up and tear-down.
 */
#ifndef SCENE_FIXTURE_H
#define SCENE_FIXTURE_H

#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* mkdtemp */
#endif

#include "check.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pendres/store.h>

#include "scenes/scene.h"

typedef pendres_status scene_runner(scene_run *run);

static char scene_folder[] = "/tmp/scene-XXXXXX";

static inline int scene_enter(void **state)
{
  (void)state;
  return mkdtemp(scene_folder) != NULL ? 0 : -1;
}

static inline int scene_leave(void **state)
{
  (void)state;
  DIR *d = opendir(scene_folder);
  if (d == NULL) return -1;
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d)) {
    char path[sizeof scene_folder + 1 + sizeof e->d_name];
    snprintf(path, sizeof path, "%s/%s", scene_folder, e->d_name);
    if (e->d_name[0] != '.') (void)remove(path);
  }
  closedir(d);
  return rmdir(scene_folder);
}

static inline void scene_path(const char *name, char path[100])
{
  snprintf(path, 100, "%s/%s.h5", scene_folder, name);
}

/* Run a deck's scene, or `runner` instead of it, into NAME.h5; how many points failed. The line on
   the first of them is left in scene_told. */
static char scene_told[SCENE_TOLD];
static inline size_t scene_run_marked(scene_runner *runner, const char *text, int threads,
                                      const char *name)
{
  char path[100];
  const char *why = NULL;
  deck d;
  namelist_errors errors = {0};
  farm_options options = {.threads = threads};
  scene_run run = {.deck = &d};
  assert_int_equal(deck_read_memory("test.nml", text, strlen(text), &d, &errors), PENDRES_OK);
  check_ok(scene_precision(&d, &options.library, &why));
  check_ok(farm_create(&options, &run.farm));
  scene_path(name, path);
  check_ok(pendres_store_create(path, NULL, &run.store));
  const pendres_status status = (runner != NULL ? runner : scene_find(d.kind)->run)(&run);
  if (status != PENDRES_OK) print_error("%s\n", run.message);
  check_ok(status);
  strcpy(scene_told, run.told_count > 0 ? run.told[0] : "");
  scene_room_end(&run.room);
  check_ok(pendres_store_close(run.store));
  pendres_store_free(run.store);
  farm_free(run.farm);
  deck_free(&d);
  namelist_errors_free(&errors);
  return run.failed_points;
}

static inline void scene_run_deck_by(scene_runner *runner, const char *text, int threads,
                                     const char *name)
{
  assert_int_equal(scene_run_marked(runner, text, threads, name), 0);
}

static inline void scene_run_deck(const char *text, int threads, const char *name)
{
  scene_run_deck_by(NULL, text, threads, name);
}

/* A deck that is wrong, and is told so by a message that contains these words. */
static inline void scene_check_refused(const char *text, const char *words)
{
  deck d;
  namelist_errors errors = {0};
  int told = 0;
  assert_int_equal(deck_read_memory("test.nml", text, strlen(text), &d, &errors),
                   PENDRES_INVALID_ARGUMENT);
  for (size_t k = 0; k < errors.count; k++)
    told |= strstr(errors.item[k].text, words) != NULL;
  if (!told) print_error("%s: %s\n", text, errors.item[0].text);
  assert_true(told);
  namelist_errors_free(&errors);
}

/* The whole file; its length. */
static inline size_t scene_bytes(const char *name, char **bytes)
{
  char path[100];
  scene_path(name, path);
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  assert_int_equal(fseek(f, 0, SEEK_END), 0);
  const size_t n = (size_t)ftell(f);
  rewind(f);
  *bytes = malloc(n);
  assert_non_null(*bytes);
  assert_int_equal(fread(*bytes, 1, n, f), n);
  fclose(f);
  return n;
}

static inline void scene_check_same_bytes(const char *one, const char *two)
{
  char *a = NULL, *b = NULL;
  const size_t n = scene_bytes(one, &a);
  assert_int_equal(n, scene_bytes(two, &b));
  assert_memory_equal(a, b, n);
  free(a);
  free(b);
}

static inline pendres_store *scene_open(const char *name)
{
  char path[100];
  pendres_store *store = NULL;
  scene_path(name, path);
  check_ok(pendres_store_open(path, &store));
  return store;
}

/* A variable of numbers as a list; its length in *n. */
static inline double *scene_values(pendres_store *store, const char *name, size_t *n)
{
  int rank = 0;
  uint64_t sizes[PENDRES_STORE_RANK];
  check_ok(pendres_store_shape(store, "", name, &rank, sizes));
  *n = 1;
  for (int i = 0; i < rank; i++) *n *= (size_t)sizes[i];
  double *v = malloc((*n + 1) * sizeof *v);
  assert_non_null(v);
  check_ok(pendres_store_read(store, "", name, PENDRES_STORE_DOUBLE, v, *n));
  return v;
}

static inline double scene_scalar(pendres_store *store, const char *name)
{
  size_t n = 0;
  double *v = scene_values(store, name, &n);
  assert_int_equal(n, 1);
  const double value = v[0];
  free(v);
  return value;
}

#endif
