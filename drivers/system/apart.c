/* apart.c -- see apart.h. */
#define _XOPEN_SOURCE 700 /* fork, setrlimit */
#include "system/apart.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "system/ending.h"

/* Reading may cost so much processor time, and a second more a megabyte: one that goes on has lost
   its way in a damaged file. */
enum { SECONDS = 60 };
/* More files than a run ever has open. */
enum { FILES = 1024 };

static _Noreturn void read_apart(int (*read)(const void *arg), const void *arg, off_t bytes,
                                 int keep)
{
  const rlim_t seconds = SECONDS + (rlim_t)(bytes / 1000000);
  const struct rlimit no_core = { 0, 0 }, time_limit = { seconds, seconds };
  ending_forget();
  /* Of the run's own files it needs none. One that is locked would stay so if the run were killed
     now, and the next one, at once, be told that it is being written. */
  for (int file = STDERR_FILENO + 1; file < FILES; file++)
    if (file != keep) (void)close(file);
  (void)setrlimit(RLIMIT_CORE, &no_core);
  (void)setrlimit(RLIMIT_CPU, &time_limit);
  (void)signal(SIGXCPU, SIG_DFL); /* a run takes it for a wish to stop */
  /* The last words of a crash are no use to anybody: the caller has a verdict. */
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) (void)dup2(nowhere, STDERR_FILENO);
  if (nowhere > STDERR_FILENO) (void)close(nowhere);
  _exit(read(arg));
}

int apart(int (*read)(const void *arg), const void *arg, off_t bytes, int keep)
{
  int end = 0;
  const pid_t reader = fork();
  if (reader < 0) return APART_FAILED;
  if (reader == 0) read_apart(read, arg, bytes, keep);
  while (waitpid(reader, &end, 0) < 0)
    if (errno != EINTR) return APART_FAILED;
  if (WIFEXITED(end)) return WEXITSTATUS(end);
  return WTERMSIG(end) == SIGXCPU || WTERMSIG(end) == SIGKILL ? APART_ENDLESS : APART_CRASHED;
}
