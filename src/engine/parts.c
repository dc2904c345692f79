/*
 * parts.c -- work on several threads, each with a context of its own; see <pendres/parts.h>.
 *
 * A call on several threads (engine/threads.h) with a context that lasts as long as the work does.
 */
#define _GNU_SOURCE /* sched_getaffinity */
#include <pendres/parts.h>

#include <sched.h>
#include <stdio.h>

#include "engine/context_internal.h"
#include "engine/numbers.h"
#include "engine/threads.h"

enum { PARTS_EACH = 4096 };

int pendres_parts_threads(void)
{
  enum { MOST_PROCESSORS = 1 << 20 };
  /* A set of the usual size has room for 1024. The system tells that a set is too small for it. */
  for (size_t room = CPU_SETSIZE; room <= MOST_PROCESSORS; room *= 2) {
    cpu_set_t *set = CPU_ALLOC(room);
    if (set == NULL) break;
    const size_t size = CPU_ALLOC_SIZE(room);
    const int told = sched_getaffinity(0, size, set) == 0;
    const int count = told ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (told) return count < PARTS_MOST_THREADS ? count : PARTS_MOST_THREADS;
  }
  return 1;
}

static void say(char *message, size_t size, const char *text)
{
  if (size > 0) (void)snprintf(message, size, "%s", text);
}

typedef struct job {
  pendres_status (*work)(pendres_context *ctx, size_t first, size_t count, void *arg);
  void *arg;
} job;

/* One part; a message of its failure tells which. */
static pendres_status part(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  const job *j = arg;
  char why[PENDRES_MESSAGE_LENGTH];
  const pendres_status status = j->work(ctx, first, count, j->arg);
  if (status == PENDRES_OK) return status;
  const char *said = ctx->guard.said == status ? pendres_context_message(ctx) : "";
  say(why, sizeof why, said[0] != '\0' ? said : pendres_status_message(status));
  return pendres_context_fail(ctx, status, "part from %zu on: %s", first, why);
}

static const char *what_is_wrong(const pendres_parts *how, int nothing)
{
  return nothing ? "nothing to do"
         : how->threads < 0 || how->threads > PARTS_MOST_THREADS
           ? "the number of threads must be from 0 to 4096"
           : pendres_options_check(&how->options);
}

pendres_status pendres_parts_run(const pendres_parts *how,
                                 pendres_status (*work)(pendres_context *ctx, size_t first,
                                                        size_t count, void *arg),
                                 void *arg, char *message, size_t size)
{
  pendres_context *ctx = NULL;
  job j = {work, arg};
  if (message == NULL && size > 0) return PENDRES_INVALID_ARGUMENT;
  const char *why = what_is_wrong(how, how == NULL || work == NULL);
  say(message, size, why != NULL ? why : "");
  if (why != NULL) return PENDRES_INVALID_ARGUMENT;
  pendres_options options = how->options;
  options.threads = how->threads > 0 ? how->threads : pendres_parts_threads();
  pendres_status status = pendres_context_create(&options, &ctx);
  if (status != PENDRES_OK) {
    say(message, size, pendres_status_message(status));
    return status;
  }
  status = pendres_threads_run(ctx, how->n, how->each > 0 ? how->each : PARTS_EACH, part, &j);
  if (status != PENDRES_OK) say(message, size, pendres_context_message(ctx));
  pendres_context_free(ctx);
  return status;
}
