/*
 * test_driver.c -- the program from outside: exit codes, what it leaves on the disk, signals.
 *
 * RESONANCE names the program; without one the tests are skipped (exit code 77). Each test works in
 * a folder of its own; decks are written there or come from input/.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp, realpath, setrlimit */
#include "check.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <hdf5.h>

enum { PATH_ROOM = 4096, TEXT_ROOM = 65536, MOST_ARGUMENTS = 12, DONE = 0 };

static char program[PATH_ROOM], top[PATH_ROOM];
static char out[TEXT_ROOM], err[TEXT_ROOM]; /* of the last run */

/* ---- helpers ------------------------------------------------------------------------------- */

static void write_text(const char *path, const char *text)
{
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  assert_true(fputs(text, f) >= 0);
  assert_int_equal(fclose(f), 0);
}

static size_t read_text(const char *path, char *text, size_t size)
{
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  const size_t n = fread(text, 1, size - 1, f);
  text[n] = '\0';
  assert_int_equal(fclose(f), 0);
  return n;
}

static int exists(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0;
}

/* Names in the working directory that contain `part`. */
static int count_names(const char *part)
{
  DIR *d = opendir(".");
  int n = 0;
  assert_non_null(d);
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d))
    n += strstr(e->d_name, part) != NULL;
  closedir(d);
  return n;
}

/* Start the program; stdout goes to stdout_path. file_limit bytes may be written, if not 0. */
static pid_t start(const char *stdout_path, rlim_t file_limit, const char *const *arguments)
{
  const char *argv[MOST_ARGUMENTS + 2] = { "resonance" };
  for (int i = 0; arguments[i] != NULL; i++) {
    assert_true(i < MOST_ARGUMENTS);
    argv[i + 1] = arguments[i];
  }
  fflush(NULL);
  const pid_t pid = fork();
  assert_true(pid >= 0);
  if (pid > 0) return pid;
  const int o = open(stdout_path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int e = open("stderr.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (o < 0 || e < 0 || dup2(o, 1) < 0 || dup2(e, 2) < 0) _exit(120);
  if (file_limit > 0) {
    const struct rlimit limit = { file_limit, file_limit };
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(121);
  }
  execv(program, (char *const *)argv);
  _exit(122);
}

/* Its exit code; 1000 + the number of the signal that killed it. */
static int finish(pid_t pid)
{
  int status = 0;
  assert_int_equal(waitpid(pid, &status, 0), pid);
  if (exists("stdout.txt")) read_text("stdout.txt", out, sizeof out);
  read_text("stderr.txt", err, sizeof err);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

static int run_list(const char *const *arguments)
{
  return finish(start("stdout.txt", 0, arguments));
}

#define RUN(...) run_list((const char *const[]){ __VA_ARGS__, NULL })

/* The code wanted, or the program's own words. */
#define check_code(got, wanted) check_code_at((got), (wanted), __FILE__, __LINE__)
static void check_code_at(int got, int wanted, const char *file, int line)
{
  if (got == wanted) return;
  print_error("%s:%d: exit code %d, wanted %d\nstdout: %s\nstderr: %s\n", file, line, got, wanted,
              out, err);
  fail();
}

#define check_says(text, words) check_says_at((text), (words), __FILE__, __LINE__)
static void check_says_at(const char *text, const char *words, const char *file, int line)
{
  if (strstr(text, words) != NULL) return;
  print_error("%s:%d: wanted '%s' in: %s\n", file, line, words, text);
  fail();
}

static const char small_deck[] = "&scene kind = 'free_oscillation' /\n"
                                 "&sweep amplitude_range = 0.1, 3.0, 500 /\n";
static const char orbit_deck[] =
  "&scene kind = 'orbit' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
  "&orbit start = 'la' /\n";
/* Minutes of work, the results of which nobody waits for. */
static const char long_deck[] =
  "&scene kind = 'orbit' /\n"
  "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
  "&orbit x = 1, v = 0, transient = .true., periods = 1000000, samples = 90 /\n";

/* A folder for each test, removed afterwards. */
static int enter(void **state)
{
  static char folder[PATH_ROOM];
  const char *place = getenv("TMPDIR");
  snprintf(folder, sizeof folder, "%s/resonance-XXXXXX", place != NULL ? place : "/tmp");
  if (mkdtemp(folder) == NULL || chdir(folder) != 0) return -1;
  *state = folder;
  write_text("small.nml", small_deck);
  write_text("orbit.nml", orbit_deck);
  write_text("long.nml", long_deck);
  return 0;
}

static int leave(void **state)
{
  DIR *d = opendir(".");
  if (d == NULL) return -1;
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d))
    if (remove(e->d_name) != 0 && strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0)
      print_error("%s stays in %s\n", e->d_name, (const char *)*state);
  closedir(d);
  return chdir(top) != 0 || rmdir(*state) != 0 ? -1 : 0;
}

/* ---- usage --------------------------------------------------------------------------------- */

static void test_usage(void **state)
{
  (void)state;
  check_code(RUN("--help"), DONE);
  check_says(out, "Usage:");
  assert_string_equal(err, "");
  check_code(RUN("--version"), DONE);
  check_says(out, "resonance ");
  check_code(RUN("--nonsense"), 2);
  check_says(err, "--nonsense");
  check_code(run_list((const char *const[]){ NULL }), 2);
  check_says(err, "no deck");
  check_code(RUN("small.nml", "orbit.nml"), 2);
  static const char *const bad_threads[] = { "0", "-1", "two", "1.5", "", "99999999999999999999" };
  for (size_t i = 0; i < sizeof bad_threads / sizeof *bad_threads; i++) {
    check_code(RUN("--threads", bad_threads[i], "small.nml"), 2);
    check_says(err, "--threads");
  }
  check_code(RUN("--output", "", "small.nml"), 2);
  check_code(RUN("--output", "small.nml/", "small.nml"), 1);
  check_code(RUN("--output", "./small.nml", "small.nml"), 2);
  check_says(err, "overwrite");
  assert_int_equal(count_names(".h5"), 0);
}

static void test_bad_decks(void **state)
{
  static const struct { const char *text, *says; } decks[] = {
    { "", "bad.nml:1:1: error:" },
    { "&scene kind = 'orbitt' /", "did you mean 'orbit'" },
    { "&scene kind = 'orbit' /\n&pendulum drive_amplitude = 0.2\n damping = -0.1, drive_period=8/\n"
      "&orbit start='sa' /", "bad.nml:3:12: error:" },
    { "&scene kind = 'orbit' /\n&pendulum drive_amplitude = 0.2\n damping = NaN, drive_period=8/\n"
      "&orbit start='sa' /", "bad.nml:3:12: error:" },
    { "&scene kind = 'orbit' /\n&pendulum drive_amplitude = 0.2\n damping = 0.1, drive_period=0/\n"
      "&orbit start='sa' /", "must be positive" },
    { "&scene kind = 'free_oscillation' /\n&sweep amplitude_range = 0.1, 3, 99999999999 /\n",
      "count" },
    { "&scene kind = 'free_oscillation' /\n&sweep amplitude = 1 /\n&precision tolerance=1e-14 /",
      "beyond double precision" },
  };
  (void)state;
  write_text("bad.h5", "precious");
  for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
    char kept[20];
    write_text("bad.nml", decks[i].text);
    check_code(RUN("bad.nml"), 2);
    check_says(err, decks[i].says);
    assert_string_equal(out, "");
    check_code(RUN("--dump-namelist", "bad.nml"), 2);
    assert_string_equal(out, "");
    check_code(RUN("--dry-run", "bad.nml"), 2);
    read_text("bad.h5", kept, sizeof kept);
    assert_string_equal(kept, "precious");
    assert_int_equal(count_names(".h5"), 1);
  }
  check_code(RUN("absent.nml"), 2);
  check_says(err, "absent.nml");
}

/* Both leave no trace, and the dump is a deck that gives itself. */
static void test_dry(void **state)
{
  static const char *const decks[] = { "small.nml", "orbit.nml" };
  char first[TEXT_ROOM];
  (void)state;
  for (size_t i = 0; i < 2; i++) {
    check_code(RUN("--dry-run", decks[i]), DONE);
    check_says(out, "scene");
    assert_string_equal(err, "");
    check_code(RUN("--dump-namelist", decks[i]), DONE);
    strcpy(first, out);
    write_text("dump.nml", first);
    check_code(RUN("--dump-namelist", "dump.nml"), DONE);
    assert_string_equal(first, out);
  }
  check_code(RUN("--dump-namelist", "-o", "elsewhere.h5", "small.nml"), DONE);
  check_says(out, "elsewhere.h5");
  check_code(RUN("--dry-run", "-o", "absent/x.h5", "small.nml"), 1);
  check_says(err, "absent");
  assert_int_equal(count_names(".h5"), 0);
}

/* ---- results ------------------------------------------------------------------------------- */

typedef struct comparison {
  hid_t other;
  int datasets;
} comparison;

/* The bytes of a dataset of numbers; to be freed. */
static void *bytes_of(hid_t file, const char *name, size_t *size)
{
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  const hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  *size = H5Tget_size(type) * (size_t)H5Sget_simple_extent_npoints(space);
  void *bytes = H5Tis_variable_str(type) > 0 || *size == 0 ? NULL : malloc(*size);
  if (bytes != NULL) assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(set);
  return bytes;
}

static herr_t compare(hid_t file, const char *name, const H5O_info_t *info, void *arg)
{
  comparison *c = arg;
  size_t size = 0, other_size = 0;
  if (info->type != H5O_TYPE_DATASET || strncmp(name, "provenance", 10) == 0) return 0;
  void *bytes = bytes_of(file, name, &size), *other = bytes_of(c->other, name, &other_size);
  assert_int_equal(size, other_size);
  if (bytes != NULL) assert_memory_equal(bytes, other, size);
  free(bytes);
  free(other);
  c->datasets++;
  return 0;
}

/* All datasets outside of the provenance hold the same bytes. */
static void check_same_results(const char *a, const char *b)
{
  const hid_t file = H5Fopen(a, H5F_ACC_RDONLY, H5P_DEFAULT);
  comparison c = { .other = H5Fopen(b, H5F_ACC_RDONLY, H5P_DEFAULT) };
  assert_true(file >= 0 && c.other >= 0);
#if H5_VERSION_GE(1, 12, 0)
  assert_true(H5Ovisit1(file, H5_INDEX_NAME, H5_ITER_INC, (H5O_iterate1_t)compare, &c) >= 0);
#else
  assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, compare, &c) >= 0);
#endif
  assert_true(c.datasets > 3);
  H5Fclose(file);
  H5Fclose(c.other);
}

static void test_run(void **state)
{
  static const char *const decks[] = { "small.nml", "orbit.nml" };
  char table[TEXT_ROOM];
  (void)state;
  for (size_t i = 0; i < 2; i++) {
    check_code(RUN("--quiet", "--threads=1", "-o", "one.h5", decks[i]), DONE);
    assert_string_equal(err, "");
    assert_true(strlen(out) > 100);
    strcpy(table, out);
    check_code(RUN("-t", "2", "-o", "two.h5", "--log", "log.txt", decks[i]), DONE);
    check_says(err, "two.h5 written");
    assert_string_equal(out, table);
    check_same_results("one.h5", "two.h5");
    check_code(RUN("-q", decks[i]), DONE);
  }
  assert_true(exists("small.h5") && exists("orbit.h5"));
  assert_int_equal(count_names(".part"), 0);
  read_text("log.txt", table, sizeof table);
  check_says(table, "two.h5 written");
}

/* The decks of the repository that take no time. */
static void test_input(void **state)
{
  static const char *const names[] = { "f01", "f05", "f06" };
  (void)state;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char deck[PATH_ROOM + 20], result[20];
    snprintf(deck, sizeof deck, "%s/input/%s.nml", top, names[i]);
    snprintf(result, sizeof result, "%s.h5", names[i]);
    check_code(RUN("-q", deck), DONE);
    assert_true(exists(result));
  }
}

/* A point without a result: the file is there, and says so. */
static void test_failed_points(void **state)
{
  (void)state;
  write_text("free.nml", "&scene kind = 'orbit' /\n"
                         "&pendulum drive_amplitude = 0, damping = 0, drive_frequency = 1 /\n"
                         "&orbit x = 1 /\n");
  check_code(RUN("free.nml"), 3);
  check_says(err, "1 point");
  assert_true(exists("free.h5"));
}

/* ---- what disks and pipes do --------------------------------------------------------------- */

static void test_output_refused(void **state)
{
  char kept[20];
  (void)state;
  write_text("kept.h5", "precious");
  /* Before anything is computed: this deck takes minutes. */
  const time_t before = time(NULL);
  check_code(RUN("-o", "absent/long.h5", "long.nml"), 1);
  check_says(err, "absent");
  assert_true(time(NULL) - before < 20);
  check_code(RUN("-o", ".", "long.nml"), 1);
  check_code(RUN("--log", "absent/log.txt", "long.nml"), 1);
  /* A limit on file sizes, as a full disk. */
  const char *const arguments[] = { "-o", "kept.h5", "orbit.nml", NULL };
  check_code(finish(start("stdout.txt", 2048, arguments)), 1);
  assert_string_equal(out, "");
  read_text("kept.h5", kept, sizeof kept);
  assert_string_equal(kept, "precious");
  assert_int_equal(count_names(".h5"), 1);
}

/* The results are whole though nobody can read the table. */
static void test_table_refused(void **state)
{
  const char *const arguments[] = { "orbit.nml", NULL };
  (void)state;
  if (access("/dev/full", W_OK) != 0) skip();
  check_code(finish(start("/dev/full", 0, arguments)), 1);
  check_says(err, "standard output");
  assert_true(exists("orbit.h5"));
  assert_int_equal(count_names(".part"), 0);
}

/* ---- signals ------------------------------------------------------------------------------- */

static void nap(long milliseconds)
{
  const struct timespec t = { milliseconds / 1000, milliseconds % 1000 * 1000000L };
  nanosleep(&t, NULL);
}

static void test_signals(void **state)
{
  static const int signals[] = { SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU };
  const char *const arguments[] = { "-o", "kept.h5", "long.nml", NULL };
  char kept[20];
  (void)state;
  write_text("kept.h5", "precious");
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
    const pid_t pid = start("stdout.txt", 0, arguments);
    for (int k = 0; k < 500 && !exists("kept.h5.part"); k++) nap(20); /* it has begun */
    nap(50);
    assert_int_equal(kill(pid, signals[i]), 0);
    check_code(finish(pid), 75);
    check_says(err, "SIG");
    assert_string_equal(out, "");
    read_text("kept.h5", kept, sizeof kept);
    assert_string_equal(kept, "precious");
    assert_int_equal(count_names(".part"), 0);
  }
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, enter, leave)
  const struct CMUnitTest tests[] = {
    TEST(test_usage),         TEST(test_bad_decks),      TEST(test_dry),
    TEST(test_run),           TEST(test_input),          TEST(test_failed_points),
    TEST(test_output_refused), TEST(test_table_refused), TEST(test_signals),
  };
  const char *named = getenv("RESONANCE");
  if (realpath(named != NULL && *named != '\0' ? named : "resonance", program) == NULL ||
      access(program, X_OK) != 0 || getcwd(top, sizeof top) == NULL) {
    print_message("there is no program to try\n");
    return 77;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
