/* signals.c -- see signals.h. */
#define _XOPEN_SOURCE 700 /* sigaction, SIGXCPU */
#include "terminal/signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <time.h>

/* Lock-free on every platform that has threads: safe in a handler and read by all threads. */
static atomic_int came;

static const struct { int number; const char *name; } stopping[] = {
  { SIGTERM, "SIGTERM" }, { SIGINT, "SIGINT" },   { SIGHUP, "SIGHUP" },
  { SIGUSR1, "SIGUSR1" }, { SIGUSR2, "SIGUSR2" }, { SIGXCPU, "SIGXCPU" },
};
static const int ignored[] = { SIGPIPE, SIGXFSZ };

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

/* When it came, in nanoseconds. */
static atomic_llong arrived;

static long long nanoseconds(void)
{
  struct timespec now = { 0 };
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000000000LL + now.tv_nsec;
}

/*
 * The first signal asks for an end, a second one is that end. Not one that comes with the first, as
 * where a process and its group are told alike, and not SIGXCPU, which comes again every second.
 */
static void handle(int number)
{
  const long long apart = 200000000LL;
  int none = 0;
  if (atomic_compare_exchange_strong(&came, &none, number)) {
    atomic_store(&arrived, nanoseconds());
    return;
  }
  const long long first = atomic_load(&arrived);
  if (number == SIGXCPU || first == 0 || nanoseconds() - first < apart) return;
  (void)signal(number, SIG_DFL);
  (void)raise(number); /* taken as soon as this function returns */
}

int signals_install(void)
{
  struct sigaction action = { .sa_handler = handle, .sa_flags = SA_RESTART };
  struct sigaction before;
  int bad = sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < LENGTH(stopping); i++) {
    bad |= sigaction(stopping[i].number, NULL, &before);
    if (before.sa_handler != SIG_IGN) bad |= sigaction(stopping[i].number, &action, NULL);
  }
  action.sa_handler = SIG_IGN;
  for (size_t i = 0; i < LENGTH(ignored); i++) bad |= sigaction(ignored[i], &action, NULL);
  return bad ? -1 : 0;
}

int signals_stop(void *arg)
{
  (void)arg;
  return atomic_load_explicit(&came, memory_order_relaxed) != 0;
}

const char *signals_name(void)
{
  const int number = atomic_load(&came);
  for (size_t i = 0; i < LENGTH(stopping); i++)
    if (stopping[i].number == number) return stopping[i].name;
  return NULL;
}
