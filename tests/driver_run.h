/*
 * driver_run.h -- running the program from a test: in a folder of its own, with its exit code and
 * what it said.
 *
 * RESONANCE names the program; without one the tests are skipped (exit code 77).
 */
#ifndef DRIVER_RUN_H
#define DRIVER_RUN_H

#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* mkdtemp, realpath, setrlimit */
#endif

#include "check.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_ROOM = 4096, TEXT_ROOM = 65536, MOST_ARGUMENTS = 48, DONE = 0 };

static char program[PATH_ROOM], top[PATH_ROOM];
static char out[TEXT_ROOM], err[TEXT_ROOM]; /* of the last run */

static inline void write_text(const char *path, const char *text)
{
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  assert_true(fputs(text, f) >= 0);
  assert_int_equal(fclose(f), 0);
}

static inline size_t read_text(const char *path, char *text, size_t size)
{
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  const size_t n = fread(text, 1, size - 1, f);
  text[n] = '\0';
  assert_int_equal(fclose(f), 0);
  return n;
}

static inline int exists(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0;
}

/* Names in the working directory that contain `part`. */
static inline int count_names(const char *part)
{
  DIR *d = opendir(".");
  int n = 0;
  assert_non_null(d);
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d))
    n += strstr(e->d_name, part) != NULL;
  closedir(d);
  return n;
}

/* Start the program; stdout goes to stdout_path, NULL: all streams closed. file_limit bytes may be
   written, if not 0. */
static inline pid_t start(const char *stdout_path, rlim_t file_limit, const char *const *arguments)
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
  const int o = open(stdout_path != NULL ? stdout_path : "stdout.txt", O_WRONLY | O_CREAT | O_TRUNC,
                     0600);
  const int e = open("stderr.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (o < 0 || e < 0 || dup2(o, 1) < 0 || dup2(e, 2) < 0) _exit(120);
  if (file_limit > 0) {
    const struct rlimit limit = { file_limit, file_limit };
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(121);
  }
  for (int fd = 0; fd <= 2 && stdout_path == NULL; fd++) close(fd);
  execv(program, (char *const *)argv);
  _exit(122);
}

/* Its exit code; 1000 + the number of the signal that killed it. */
static inline int finish(pid_t pid)
{
  int status = 0;
  assert_int_equal(waitpid(pid, &status, 0), pid);
  if (exists("stdout.txt")) read_text("stdout.txt", out, sizeof out);
  read_text("stderr.txt", err, sizeof err);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

static inline int run_list(const char *const *arguments)
{
  return finish(start("stdout.txt", 0, arguments));
}

#define RUN(...) run_list((const char *const[]){ __VA_ARGS__, NULL })

/* The code wanted, or the program's own words. */
#define check_code(got, wanted) check_code_at((got), (wanted), __FILE__, __LINE__)
static inline void check_code_at(int got, int wanted, const char *file, int line)
{
  if (got == wanted) return;
  print_error("%s:%d: exit code %d, wanted %d\nstdout: %s\nstderr: %s\n", file, line, got, wanted,
              out, err);
  fail();
}

#define check_says(text, words) check_says_at((text), (words), __FILE__, __LINE__)
static inline void check_says_at(const char *text, const char *words, const char *file, int line)
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
  "&scene kind = 'basins' /\n"
  "&pendulum damping = 1e-3, drive_amplitude = 0.2, drive_frequency = 0.8 /\n"
  "&sweep x_range = -1, 1, 2000, v_range = -1, 1, 2000 /\n";

/* A folder for each test, removed afterwards. */
static inline int enter(void **state)
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

static inline int leave(void **state)
{
  DIR *d = opendir(".");
  if (d == NULL) return -1;
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d))
    if (remove(e->d_name) != 0 && strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0)
      print_error("%s stays in %s\n", e->d_name, (const char *)*state);
  closedir(d);
  return chdir(top) != 0 || rmdir(*state) != 0 ? -1 : 0;
}

/* Find the program; 0 if there is none to try. */
static inline int find_program(void)
{
  const char *named = getenv("RESONANCE");
  if (realpath(named != NULL && *named != '\0' ? named : "resonance", program) != NULL &&
      access(program, X_OK) == 0 && getcwd(top, sizeof top) != NULL)
    return 1;
  print_message("there is no program to try\n");
  return 0;
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, enter, leave)

#endif
