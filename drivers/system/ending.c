/* ending.c -- an orderly end where a library ends the program; see ending.h. */
#define _GNU_SOURCE /* siginfo_t, REG_RIP, dladdr */
#include "system/ending.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <ucontext.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <dlfcn.h>
#include <execinfo.h>
#endif

#include <gsl/gsl_errno.h>

enum { FAILED = 1, RUNNING = -1, SIGNAL_STACK = 1 << 16 };

/* A sanitizer looks at faults of libraries, too. Handlers that libraries bring along, as UCX does,
   which Debian 13's SUNDIALS loads with MPI, would end the program with a signal. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

static const int faults[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT };
static struct sigaction before[LENGTH(faults)];

static pendres_store *const *_Atomic watched;
static atomic_int result = RUNNING, done, whole;

/* Where faults are handled: of a stack that overflows nothing is left. */
static char signal_stack[SIGNAL_STACK];

/* The program's own code, by the linker's names. */
extern const char __executable_start[], etext[];

/* Only what a signal handler may do, here and below. */
static void say(const char *words)
{
  const ssize_t written = write(STDERR_FILENO, words, strlen(words));
  (void)written; /* a failure here cannot be reported */
}

static void say_what_stands(void)
{
  say(atomic_load(&whole) ? "; the results are whole in the HDF5 file\n"
                          : "; nothing was written\n");
}

static void drop_part(void)
{
  pendres_store *const *store = atomic_load(&watched);
  if (store != NULL) pendres_store_drop_part(*store);
}

static void at_exit(void)
{
  const int code = atomic_load(&result);
  if (atomic_load(&done)) return;
  if (code == RUNNING) {
    say("resonance: error: a library has ended the program, as HDF5 does when it gets no memory");
    say_what_stands();
  }
  drop_part();
  _exit(code == RUNNING ? FAILED : code);
}

static int in_program(uintptr_t at)
{
  return at >= (uintptr_t)__executable_start && at < (uintptr_t)etext;
}

/* Whether a library has called abort(), which was met at this place of the C library: what stands
   behind that on the stack, as far as the system tells. */
static int aborts_in_library(uintptr_t at)
{
#ifdef __GLIBC__
  enum { FRAMES = 32 };
  void *frame[FRAMES];
  Dl_info libc, caller;
  const int n = dladdr((void *)at, &libc) != 0 ? backtrace(frame, FRAMES) : 0;
  for (int i = 0, inside = 0; i < n; i++) {
    const int here = dladdr(frame[i], &caller) != 0 && caller.dli_fbase == libc.dli_fbase;
    if (inside && !here) return !in_program((uintptr_t)frame[i]);
    inside |= here;
  }
#else
  (void)at;
#endif
  return 0;
}

/* Whether a fault was met in the code of a library, as far as that is known. */
static int in_library(const siginfo_t *info, const void *context)
{
  uintptr_t at = (uintptr_t)__executable_start;
#if defined __linux__ && defined __x86_64__
  at = (uintptr_t)((const ucontext_t *)context)->uc_mcontext.gregs[REG_RIP];
#elif defined __linux__ && defined __aarch64__
  at = (uintptr_t)((const ucontext_t *)context)->uc_mcontext.pc;
#else
  (void)context;
#endif
  if (info->si_code > 0) return !in_program(at);
  return info->si_signo == SIGABRT && info->si_pid == getpid() && aborts_in_library(at);
}

/* Where the fault is not a library's, back to what was there, a debugger's or a sanitizer's say,
   which then meets the same fault. */
static void at_fault(int number, siginfo_t *info, void *context)
{
  const int code = atomic_load(&result), library = in_library(info, context);
  if (!atomic_load(&done)) drop_part();
  if (code != RUNNING) _exit(code);
  say(library ? "resonance: error: one of the program's libraries has crashed, as some do when "
                "they get no memory"
              : "resonance: error: the program has crashed");
  say_what_stands();
  for (size_t i = 0; i < LENGTH(faults); i++) {
    if (faults[i] != number) continue;
    if (library && (!SANITIZED || before[i].sa_handler == SIG_DFL)) _exit(FAILED);
    (void)sigaction(number, &before[i], NULL);
  }
  if (info->si_code <= 0) (void)raise(number); /* sent, not met: taken when this returns */
}

int ending_watch(pendres_store *const *store)
{
  struct sigaction action = { .sa_sigaction = at_fault, .sa_flags = SA_SIGINFO | SA_ONSTACK };
  const stack_t stack = { .ss_sp = signal_stack, .ss_size = sizeof signal_stack };
  stack_t present = { .ss_flags = 0 };
  int bad = sigemptyset(&action.sa_mask);
  atomic_store(&whole, 0);
  if (atomic_exchange(&watched, store) != NULL) return 0;
  /* A sanitizer has one of its own, which it frees. */
  bad |= sigaltstack(NULL, &present);
  if ((present.ss_flags & SS_DISABLE) != 0) bad |= sigaltstack(&stack, NULL);
#ifdef __GLIBC__
  void *unused;
  (void)backtrace(&unused, 1); /* which takes memory when it is first called */
#endif
  (void)gsl_set_error_handler_off(); /* which ends the program where GSL gets no memory */
  for (size_t i = 0; i < LENGTH(faults); i++) bad |= sigaction(faults[i], &action, &before[i]);
  bad |= atexit(at_exit);
  /* The last one is called first, and should be ours: HDF5 installs its own when first called. */
  pendres_store_hdf5_version(NULL, NULL, NULL);
  bad |= atexit(at_exit);
  return bad ? -1 : 0;
}

void ending_whole(void)
{
  atomic_store(&whole, 1);
}

void ending_told(int code)
{
  atomic_store(&result, code);
}

void ending_done(void)
{
  atomic_store(&done, 1);
}

void ending_forget(void)
{
  atomic_store(&watched, NULL);
  atomic_store(&done, 1);
  for (size_t i = 0; i < LENGTH(faults); i++) (void)signal(faults[i], SIG_DFL);
}
