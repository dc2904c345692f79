/*
 * test_ending.c -- what is left of a run that a library ends by exit(): an exit code and a message,
 * but no FILE.part.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "check.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gsl/gsl_errno.h>

#include "system/apart.h"
#include "system/ending.h"

enum { RUNNING = -1 };

static char folder[] = "/tmp/ending-XXXXXX";

/* Run on, as a library that has no memory may. */
typedef void breaking(void);

static void leave(void)
{
  exit(255);
}

/* As while the results are read again, to be written as text. */
static void leave_later(void)
{
  ending_whole();
  exit(255);
}

static void fault(void)
{
  (void)raise(SIGSEGV);
}

static void give_up(void)
{
  abort();
}

/* As a library does that gives up. */
static void abort_in_library(void)
{
  gsl_set_error_handler(NULL);
  GSL_ERROR_VOID("no memory", GSL_ENOMEM);
}

/* A child that is broken in the middle (code RUNNING), or when its code is known; its wait status,
   and what it said in text. */
static int broken(breaking *how, int code, char *text, size_t size)
{
  int pipes[2], status = 0;
  static const struct rlimit no_core = { 0, 0 };
  assert_int_equal(pipe(pipes), 0);
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    static pendres_store *store;
    (void)setrlimit(RLIMIT_CORE, &no_core);
    (void)signal(SIGSEGV, SIG_DFL); /* not cmocka's */
    (void)signal(SIGABRT, SIG_DFL);
    if (dup2(pipes[1], STDERR_FILENO) < 0 || ending_watch(&store) != 0) _exit(42);
    if (pendres_store_create("run.h5", NULL, &store) != PENDRES_OK) _exit(43);
    if (access("run.h5.part", F_OK) != 0) _exit(44);
    if (code != RUNNING) ending_told(code);
    how();
    _exit(45);
  }
  (void)close(pipes[1]);
  size_t used = 0;
  for (ssize_t n = 1; n > 0 && used + 1 < size; used += (size_t)n) {
    n = read(pipes[0], text + used, size - 1 - used);
    if (n <= 0) break;
  }
  text[used] = '\0';
  (void)close(pipes[0]);
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_not_equal(access("run.h5.part", F_OK), 0);
  assert_int_not_equal(access("run.h5", F_OK), 0);
  return status;
}

static void an_exit_is_a_failure_that_is_told(void **state)
{
  char text[400];
  (void)state;
  const int status = broken(leave, RUNNING, text, sizeof text);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  assert_non_null(strstr(text, "a library has ended the program"));
  assert_non_null(strstr(text, "; nothing was written\n"));
  (void)broken(leave_later, RUNNING, text, sizeof text);
  assert_non_null(strstr(text, "; the results are whole in the HDF5 file\n"));
}

static void a_fault_stays_one_and_leaves_nothing(void **state)
{
  static breaking *const how[] = { fault, give_up };
  static const int numbers[] = { SIGSEGV, SIGABRT };
  char text[400];
  (void)state;
  for (int i = 0; i < 2; i++) {
    const int status = broken(how[i], RUNNING, text, sizeof text);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == numbers[i]);
    assert_non_null(strstr(text, "crashed"));
  }
}

/* One that a library gives up with is a failure, told as the library's. */
static void an_abort_of_a_library_is_its_own(void **state)
{
  char text[400];
  (void)state;
  const int status = broken(abort_in_library, RUNNING, text, sizeof text);
#ifdef __GLIBC__
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  assert_non_null(strstr(text, "one of the program's libraries has crashed"));
#else
  assert_true(WIFSIGNALED(status));
#endif
  assert_non_null(strstr(text, "; nothing was written\n"));
}

/* When the run is over, libraries that fail while they are closed change nothing. */
static void what_is_told_stays(void **state)
{
  static breaking *const how[] = { leave, fault, give_up };
  char text[400];
  (void)state;
  for (int i = 0; i < 3; i++)
    for (int code = 0; code < 4; code += 3) {
      const int status = broken(how[i], code, text, sizeof text);
      assert_true(WIFEXITED(status) && WEXITSTATUS(status) == code);
      assert_string_equal(text, "");
    }
}

/* And main's own exit is left alone. */
static void a_done_program_exits(void **state)
{
  int status = 0;
  (void)state;
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    static pendres_store *store;
    if (ending_watch(&store) != 0) _exit(42);
    ending_told(3);
    ending_done();
    exit(7);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 7);
}

static int call(const void *arg)
{
  breaking *const *how = arg;
  if (*how == NULL) return 7;
  (*how)();
  return 8;
}

/* What is done apart may end in any way: the run has the verdict, and its part file as before. */
static void what_is_done_apart_harms_nothing(void **state)
{
  static const struct { breaking *how; int code; } cases[] = {
    { NULL, 7 }, { leave, 255 }, { fault, APART_CRASHED }, { give_up, APART_CRASHED }
  };
  int status = 0;
  (void)state;
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) { /* whose handlers end with it */
    static pendres_store *store;
    if (ending_watch(&store) != 0) _exit(42);
    if (pendres_store_create("run.h5", NULL, &store) != PENDRES_OK) _exit(43);
    for (int i = 0; i < 4; i++) {
      if (apart(call, &cases[i].how, 0, -1) != cases[i].code) _exit(50 + i);
      if (access("run.h5.part", F_OK) != 0) _exit(60 + i);
    }
    pendres_store_free(store);
    _exit(0);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status));
  assert_int_equal(WEXITSTATUS(status), 0);
}

static int is_closed(const void *arg)
{
  return fcntl(*(const int *)arg, F_GETFD) < 0;
}

/* What is done apart may outlive a run that is killed, and must not keep its locks then. */
static void what_is_done_apart_holds_no_files(void **state)
{
  (void)state;
  const int file = open(".", O_RDONLY);
  assert_true(file > STDERR_FILENO);
  assert_int_equal(apart(is_closed, &file, 0, -1), 1);
  assert_int_equal(apart(is_closed, &file, 0, file), 0);
  assert_int_equal(close(file), 0);
}

static int enter(void **state)
{
  (void)state;
  return mkdtemp(folder) != NULL && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
  (void)state;
  return chdir("/") == 0 ? rmdir(folder) : -1;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_exit_is_a_failure_that_is_told),
    cmocka_unit_test(a_fault_stays_one_and_leaves_nothing),
    cmocka_unit_test(an_abort_of_a_library_is_its_own),
    cmocka_unit_test(what_is_told_stays),
    cmocka_unit_test(a_done_program_exits),
    cmocka_unit_test(what_is_done_apart_harms_nothing),
    cmocka_unit_test(what_is_done_apart_holds_no_files),
  };
  return cmocka_run_group_tests(tests, enter, leave_folder);
}
