/*
 * test_store_failure.c -- what disks, folders, other processes and kills do to a store: an
 * existing file is never damaged, a failure is told in words, and HDF5 stays usable.
 */
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE /* seteuid */
#endif

#include "store_files.h"

#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "store/internal.h"

/* ---- Files that cannot be written, and files that must not be ------------------------------- */

static void check_no_create(const char *path, const char *words)
{
  pendres_store *store = NULL;
  const pendres_status status = pendres_store_create(path, NULL, &store);

  check_refused_at(status, PENDRES_IO, store, words, path, __FILE__, __LINE__);
  assert_int_equal(pendres_store_group(store, "a"), PENDRES_IO);
  assert_int_equal(pendres_store_close(store), PENDRES_IO);
  assert_non_null(strstr(pendres_store_message(store), words));
  pendres_store_free(store);
}

static void bad_folders_are_told_at_once(void **state)
{
  char path[PATH_ROOM], inside[PATH_ROOM];
  pendres_store *store = NULL;

  (void)state;
  check_no_create(in_folder(path, "missing/run.h5"), strerror(ENOENT));
  write_file(in_folder(path, "plain"), "text");
  check_no_create(in_folder(path, "plain/run.h5"), strerror(ENOTDIR));
  check_contents(in_folder(path, "plain"), "text");
  check_no_create(folder, "not a regular file");

  /* A link as part file would be renamed instead of what it points to. */
  assert_int_equal(symlink("plain", in_folder(path, "link.h5.part")), 0);
  check_no_create(in_folder(path, "link.h5"), "is a symbolic link");
  check_contents(in_folder(path, "plain"), "text");
  assert_int_equal(unlink(in_folder(path, "link.h5.part")), 0);

  /* Root may write everywhere, so it becomes somebody else. */
  in_folder(path, "locked");
  assert_int_equal(mkdir(path, 0555), 0);
  in_folder(inside, "locked/run.h5");
  if (!geteuid()) {
    assert_int_equal(chmod(folder, 0755), 0);
    assert_int_equal(seteuid(65534), 0);
    check_no_create(inside, strerror(EACCES));
    assert_int_equal(seteuid(0), 0);
  } else {
    check_no_create(inside, strerror(EACCES));
  }
  assert_int_equal(rmdir(path), 0);

  assert_int_equal(pendres_store_open(in_folder(path, "missing.h5"), &store), PENDRES_IO);
  assert_non_null(strstr(pendres_store_message(store), "missing.h5"));
  pendres_store_free(store);
  assert_int_equal(pendres_store_open(in_folder(path, "plain"), &store), PENDRES_IO);
  pendres_store_free(store);
}

/* What a killed run has left is taken only from oneself, and under its only name. */
static void check_others(const char *path, const char *part)
{
  char other[PATH_ROOM];

  assert_int_equal(link(part, in_folder(other, "precious")), 0);
  check_no_create(path, "hard link");
  assert_int_equal(unlink(other), 0);
  if (geteuid()) return;
  assert_int_equal(chown(part, 65534, 65534), 0);
  check_no_create(path, "belongs to another user");
  assert_int_equal(chown(part, 0, 0), 0);
}

static void check_conventions(pendres_store *store, const char *words)
{
  char *text = NULL;

  OK(pendres_store_read_attribute_text(store, "", NULL, "Conventions", &text));
  assert_string_equal(text, words);
  free(text);
}

static void abandoned_run_leaves_the_old_file(void **state)
{
  char path[PATH_ROOM], part[PATH_ROOM];
  const double value = 3;
  double read = 0;
  const pendres_store_spec spec = { .name = "y", .long_name = "y" };
  pendres_store *store = NULL;

  (void)state;
  write_file(in_folder(path, "old.h5"), "old");
  in_folder(part, "old.h5.part");
  write_file(part, "poems, not left by a run that was killed");
  assert_int_equal(pendres_store_create(path, NULL, &store), PENDRES_IO);
  assert_non_null(strstr(pendres_store_message(store), "was not left by a run"));
  pendres_store_free(store);
  check_contents(part, "poems, not left by a run that was killed");
  write_file(part, "\211HDF\r\n\032\nany file of HDF5");
  check_no_create(path, "was not left by a run");
  assert_int_equal(truncate(part, 0) | truncate(part, 100), 0); /* zeros */
  check_no_create(path, "was not left by a run");
  write_file(part, "\211HDF\r\n\032\nleft by a run that was killed: (part)");
  check_others(path, part);

  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_put(store, &spec, &value, NULL, 1));
  assert_true(exists(part));
  check_contents(path, "old");
  OK(pendres_store_abandon(store, 0));
  REFUSED(pendres_store_group(store, "a"), "closed");
  pendres_store_free(store);
  assert_false(exists(part));
  check_contents(path, "old");

  OK(pendres_store_create(path, NULL, &store));
  pendres_store_free(store); /* without a word */
  assert_false(exists(part));
  check_contents(path, "old");

  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_put(store, &spec, &value, NULL, 1));
  OK(pendres_store_abandon(store, 1));
  pendres_store_free(store);
  check_contents(path, "old");
  OK(pendres_store_open(part, &store));
  OK(pendres_store_read(store, "", "y", PENDRES_STORE_DOUBLE, &read, 1));
  assert_true(read == 3);
  check_conventions(store, "(part)");
  pendres_store_free(store);

  /* And a finished one replaces it. */
  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_close(store));
  pendres_store_free(store);
  assert_false(exists(part));
  OK(pendres_store_open(path, &store));
  assert_int_equal(pendres_store_has(store, "", "y"), 0);
  check_conventions(store, "CF-1.8");
  pendres_store_free(store);
}

/* The target became a folder meanwhile: the whole results stay under the name of the part. */
static void failed_rename_keeps_the_results(void **state)
{
  char path[PATH_ROOM], part[PATH_ROOM];
  const double value = 3;
  double read = 0;
  pendres_store *store = NULL;

  (void)state;
  in_folder(path, "taken.h5");
  in_folder(part, "taken.h5.part");
  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "y", .long_name = "y" }, &value, NULL,
                       1));
  assert_int_equal(mkdir(path, 0777), 0);
  assert_int_equal(pendres_store_close(store), PENDRES_IO);
  assert_non_null(strstr(pendres_store_message(store), "whole"));
  pendres_store_free(store);
  assert_int_equal(rmdir(path), 0);
  OK(pendres_store_open(part, &store));
  OK(pendres_store_read(store, "", "y", PENDRES_STORE_DOUBLE, &read, 1));
  assert_true(read == 3);
  pendres_store_free(store);
  check_no_create(path, "was not left by a run"); /* they are not lost to the next one */
  assert_int_equal(unlink(part), 0);
}

/* Somebody moved our part away and put a file of theirs in its place. */
static void foreign_part_is_left_alone(void **state)
{
  char path[PATH_ROOM], part[PATH_ROOM], moved[PATH_ROOM];
  pendres_store *store = NULL;

  (void)state;
  in_folder(path, "foreign.h5");
  in_folder(part, "foreign.h5.part");
  OK(pendres_store_create(path, NULL, &store));
  assert_int_equal(rename(part, in_folder(moved, "moved")), 0);
  write_file(part, "theirs");
  assert_int_equal(pendres_store_close(store), PENDRES_IO);
  assert_non_null(strstr(pendres_store_message(store), "replaced"));
  pendres_store_free(store);
  check_contents(part, "theirs");
  assert_false(exists(path));
}

static void two_writers_do_not_mix(void **state)
{
  char path[PATH_ROOM];
  pendres_store *store = NULL;

  (void)state;
  OK(pendres_store_create(in_folder(path, "shared.h5"), NULL, &store));
  OK(pendres_store_group(store, "first"));
  check_no_create(path, "another process");
  assert_int_equal(setenv("HDF5_USE_FILE_LOCKING", "BEST_EFFORT", 1), 0);
  check_no_create(path, "another process");
  OK(pendres_store_close(store));
  pendres_store_free(store);
  OK(pendres_store_open(path, &store));
  assert_int_equal(pendres_store_has(store, "first", NULL), 1);
  pendres_store_free(store);

  /* Nor without locks: then it cannot be told from what a killed run has left, which is kept. */
  assert_int_equal(setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1), 0);
  OK(pendres_store_create(path, NULL, &store));
  check_no_create(path, "Remove it");
  assert_int_equal(unsetenv("HDF5_USE_FILE_LOCKING"), 0);
  check_no_create(path, "another process");
  OK(pendres_store_group(store, "second"));
  OK(pendres_store_close(store));
  pendres_store_free(store);
  OK(pendres_store_open(path, &store));
  assert_int_equal(pendres_store_has(store, "second", NULL), 1);
  pendres_store_free(store);
}

/* A link's target is what was meant; devices are refused, and what is read-only is kept. */
static void targets(void **state)
{
  char path[PATH_ROOM], target[PATH_ROOM], part[PATH_ROOM];
  struct stat info;
  pendres_store *store = NULL;

  (void)state;
  write_file(in_folder(target, "meant.h5"), "old");
  in_folder(part, "meant.h5.part");
  in_folder(path, "link.h5");
  assert_int_equal(symlink("second.h5", path), 0);
  assert_int_equal(symlink("meant.h5", in_folder(path, "second.h5")), 0);
  for (int there = 1; there >= 0; there--) { /* a target that does not exist yet is made */
    OK(pendres_store_create(in_folder(path, "link.h5"), NULL, &store));
    assert_true(exists(part));
    OK(pendres_store_close(store));
    pendres_store_free(store);
    assert_int_equal(lstat(path, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    OK(pendres_store_open(target, &store));
    pendres_store_free(store);
    if (there) assert_int_equal(unlink(target), 0);
  }
  assert_int_equal(symlink("round.h5", in_folder(path, "round.h5")), 0);
  check_no_create(path, strerror(ELOOP));
  assert_int_equal(unlink(path), 0);

  check_no_create("/dev/null", "device");
  check_no_create("/dev/stdout", "device");
  assert_int_equal(symlink("/dev/stdout", in_folder(path, "stream.h5")), 0);
  check_no_create(path, "device");
  assert_int_equal(unlink(path), 0);

  write_file(in_folder(path, "kept.h5"), "precious");
  assert_int_equal(chmod(path, 0444), 0);
  check_no_create(path, "read-only");
  check_contents(path, "precious");
  assert_false(exists(in_folder(part, "kept.h5.part")));
}

/* ---- A full disk ----------------------------------------------------------------------------- */

/* How far a run came. The first failure is what counts; then everything must fail the same way. */
static pendres_status run_until_full(const char *path, int *step)
{
  enum { ROWS = 40, ROW = 4096 };
  pendres_store *store = NULL;
  double row[ROW];
  unsigned random = 1;
  int id = -1;
  pendres_status status = pendres_store_create(path, NULL, &store);

  *step = 0;
  if (!status) ++*step, status = pendres_store_dimension(
    store, &(pendres_store_spec){.name = "r", .long_name = "r"}, ROWS, NULL);
  if (!status) status = pendres_store_dimension(
    store, &(pendres_store_spec){.name = "c", .long_name = "c"}, ROW, NULL);
  if (!status)
    status = pendres_store_variable(store, &(pendres_store_spec){ .name = "y", .long_name = "y",
               .dimensions = { "r", "c" } }, &id, NULL);
  for (uint64_t r = 0; r < ROWS && !status; r++) {
    /* Numbers that do not compress. */
    for (int i = 0; i < ROW; i++) row[i] = (random = random * 1664525u + 1013904223u) / 3.0;
    status = pendres_store_write_rows(store, id, r, 1, row, ROW);
    if (!status && r % 3 == 2) status = pendres_store_flush(store);
    if (!status) ++*step;
  }
  if (!status)
    status = pendres_store_provenance(store, &(pendres_store_entry){ .key = "k", .number = 1 }, 1);
  if (!status) status = pendres_store_close(store);
  if (status) {
    assert_non_null(strstr(pendres_store_message(store), strerror(EFBIG)));
    assert_int_equal(pendres_store_group(store, "more"), status);
    assert_int_equal(pendres_store_flush(store), status);
    assert_int_equal(pendres_store_close(store), status);
    assert_non_null(strstr(pendres_store_message(store), strerror(EFBIG)));
  }
  pendres_store_free(store);
  return status;
}

static void full_disk_is_an_error_and_no_more(void **state)
{
  enum { LIMITS = 40 };
  char path[PATH_ROOM], part[PATH_ROOM];
  struct rlimit before, limit;
  struct stat whole;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  int step = 0, steps = 0, last = -1;

  (void)state;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  in_folder(path, "full.h5");
  in_folder(part, "full.h5.part");
  assert_int_equal(run_until_full(path, &step), PENDRES_OK);
  assert_int_equal(stat(path, &whole), 0);
  write_file(path, "old");

  /* From no room at all to a byte too little: failures in create, writes, flushes and close. */
  for (int k = 0; k <= LIMITS; k++) {
    const double share = (double)k / LIMITS;
    pendres_status status;

    limit = before;
    limit.rlim_cur = (rlim_t)((double)(whole.st_size - 1) * share * share);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    status = run_until_full(path, &step);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, PENDRES_IO);
    assert_false(exists(part));
    check_contents(path, "old");
    if (step != last) steps++;
    last = step;
  }
  assert_true(steps > 10); /* the failures came in many places */
  assert_int_equal(run_until_full(path, &step), PENDRES_OK);
  signal(SIGXFSZ, handler);
}

/* What the disk refused can be read back, the newest over the older over what is on the disk. */
static void refused_bytes_are_kept(void **state)
{
  char path[PATH_ROOM], read[16] = "";
  struct rlimit before, limit;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  pendres_store_file file;

  (void)state;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(pendres_store_file_create(&file, in_folder(path, "refused"), 0), PENDRES_OK);
  limit = before;
  limit.rlim_cur = 6;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
  assert_int_equal(pendres_store_file_write(&file, 0, 4, "abcd"), 0);
  assert_int_equal(file.error, 0);
  assert_int_equal(pendres_store_file_write(&file, 4, 4, "efgh"), 0); /* half of it fits */
  assert_int_equal(file.error, EFBIG);
  assert_int_equal(pendres_store_file_write(&file, 1, 2, "BC"), 0); /* would fit, but is late */
  assert_int_equal(pendres_store_file_write(&file, 7, 3, "HIJ"), 0);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(pendres_store_file_read(&file, 0, 12, read), 0);
  assert_memory_equal(read, "aBCdefgHIJ\0\0", 12);
  assert_int_equal(pendres_store_file_read(&file, 6, 2, read), 0);
  assert_memory_equal(read, "gH", 2);
  pendres_store_file_abandon(&file, 0);
  pendres_store_file_destroy(&file);
  signal(SIGXFSZ, handler);
}

/* ---- A killed run ---------------------------------------------------------------------------- */

static void flushed_rows_survive_a_kill(void **state)
{
  enum { ROWS = 50, ROW = 1000, FLUSHED = 30 };
  char path[PATH_ROOM], part[PATH_ROOM];
  double row[ROW];
  int code = 0;
  pid_t child;
  pendres_store *store = NULL;

  (void)state;
  in_folder(path, "killed.h5");
  in_folder(part, "killed.h5.part");
  child = fork();
  assert_true(child >= 0);
  if (!child) {
    int id = -1, bad = pendres_store_create(path, NULL, &store) ||
      pendres_store_dimension(store, &(pendres_store_spec){.name = "r", .long_name = "r"}, ROWS,
                              NULL) ||
      pendres_store_dimension(store, &(pendres_store_spec){.name = "c", .long_name = "c"}, ROW,
                              NULL) ||
      pendres_store_variable(store, &(pendres_store_spec){ .name = "y", .long_name = "y",
        .dimensions = { "r", "c" } }, &id, NULL);

    for (uint64_t r = 0; r < FLUSHED + 5 && !bad; r++) {
      for (int i = 0; i < ROW; i++) row[i] = (double)r + 1e-3 * i;
      bad = pendres_store_write_rows(store, id, r, 1, row, ROW) ||
            (r < FLUSHED && pendres_store_flush(store));
    }
    if (bad) _exit(1);
    kill(getpid(), SIGKILL);
  }
  assert_int_equal(waitpid(child, &code, 0), child);
  assert_true(WIFSIGNALED(code));
  assert_false(exists(path));
  OK(pendres_store_open(part, &store));
  for (uint64_t r = 0; r < FLUSHED; r++) {
    OK(pendres_store_read_rows(store, &(pendres_store_spec){.name = "y"}, r, 1, row, ROW));
    for (int i = 0; i < ROW; i++) assert_true(row[i] == (double)r + 1e-3 * i);
  }
  /* What never was written is not a number. */
  OK(pendres_store_read_rows(store, &(pendres_store_spec){.name = "y"}, ROWS - 1, 1, row, ROW));
  for (int i = 0; i < ROW; i++) assert_true(isnan(row[i]));
  pendres_store_free(store);
}

/* ---- Manners --------------------------------------------------------------------------------- */

static herr_t count_calls(hid_t stack, void *count)
{
  (void)stack;
  ++*(int *)count;
  return 0;
}

static void callers_error_handler_is_left_alone(void **state)
{
  char path[PATH_ROOM];
  H5E_auto2_t before = NULL, after = NULL;
  void *before_data = NULL, *after_data = NULL;
  int calls = 0;
  pendres_store *store = NULL;

  (void)state;
  assert_true(H5Eget_auto2(H5E_DEFAULT, &before, &before_data) >= 0);
  assert_true(H5Eset_auto2(H5E_DEFAULT, count_calls, &calls) >= 0);
  assert_int_equal(pendres_store_open(in_folder(path, "none.h5"), &store), PENDRES_IO);
  /* HDF5's own innermost words: that the file cannot be opened. */
  assert_non_null(strstr(pendres_store_message(store), "open"));
  pendres_store_free(store);
  check_no_create(in_folder(path, "none/run.h5"), "none");
  assert_int_equal(pendres_store_create(in_folder(path, "fine.h5"), NULL, &store), PENDRES_OK);
  assert_int_equal(pendres_store_read(store, "", "none", PENDRES_STORE_INT8, NULL, 0),
                   PENDRES_NOT_FOUND);
  pendres_store_free(store);
  assert_int_equal(calls, 0);
  assert_true(H5Eget_auto2(H5E_DEFAULT, &after, &after_data) >= 0);
  assert_true(after == count_calls && after_data == &calls);
#ifndef H5_NO_DEPRECATED_SYMBOLS
  {
    H5E_auto1_t old = NULL;

    assert_true(H5Eset_auto1(NULL, &calls) >= 0);
    assert_int_equal(pendres_store_open("/dev/null", &store), PENDRES_IO);
    pendres_store_free(store);
    assert_true(H5Eget_auto1(&old, &after_data) >= 0);
    assert_true(!old && after_data == &calls);
  }
#endif
  assert_true(H5Eset_auto2(H5E_DEFAULT, before, before_data) >= 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(bad_folders_are_told_at_once),
    TEST(abandoned_run_leaves_the_old_file),
    TEST(failed_rename_keeps_the_results),
    TEST(foreign_part_is_left_alone),
    TEST(targets),
    TEST(two_writers_do_not_mix),
    TEST(full_disk_is_an_error_and_no_more),
    TEST(refused_bytes_are_kept),
    TEST(flushed_rows_survive_a_kill),
    TEST(callers_error_handler_is_left_alone),
  };

  return cmocka_run_group_tests_name("store_failure", tests, make_folder, remove_folder);
}
