/* guard.c -- the use of a handle, and the message of its last use; see guard.h. */
#include "base/guard.h"

#include <errno.h>
#include <stddef.h>
#include <stdio.h>

/* Each thread has its own errno, whose address identifies the thread; it is never 0. */
static uintptr_t this_thread(void)
{
  return (uintptr_t)&errno;
}

static uintptr_t owner_of(const pendres_guard *g)
{
  return atomic_load_explicit(&((pendres_guard *)g)->owner, memory_order_acquire);
}

void pendres_guard_init(pendres_guard *g)
{
  atomic_init(&g->owner, 0);
  g->depth = g->asking = 0;
  g->said = PENDRES_OK;
  g->message[0] = '\0';
}

int pendres_guard_busy(const pendres_guard *g)
{
  return pendres_guard_used_elsewhere(g) || (owner_of(g) != 0 && g->asking);
}

int pendres_guard_used_elsewhere(const pendres_guard *g)
{
  const uintptr_t owner = owner_of(g);
  return owner != 0 && owner != this_thread();
}

int pendres_guard_enter(pendres_guard *g)
{
  uintptr_t nobody = 0;
  if (g == NULL) return 0;
  if (!atomic_compare_exchange_strong(&g->owner, &nobody, this_thread()) &&
      (nobody != this_thread() || g->asking))
    return 0;
  g->depth++;
  g->said = PENDRES_OK;
  g->message[0] = '\0';
  return 1;
}

pendres_status pendres_guard_refusal(const pendres_guard *g)
{
  return g == NULL ? PENDRES_INVALID_ARGUMENT : PENDRES_BUSY;
}

pendres_status pendres_guard_leave(pendres_guard *g, pendres_status status)
{
  if (status == PENDRES_OK) g->message[0] = '\0';
  else if (g->said != status)
    (void)snprintf(g->message, sizeof g->message, "%s", pendres_status_message(status));
  g->said = status;
  if (--g->depth == 0) atomic_store_explicit(&g->owner, 0, memory_order_release);
  return status;
}

void pendres_guard_ask(pendres_guard *g, int asking)
{
  g->asking = asking;
}

pendres_status pendres_guard_fail(pendres_guard *g, pendres_status status, const char *format,
                                  va_list args)
{
  (void)vsnprintf(g->message, sizeof g->message, format, args);
  g->said = status;
  return status;
}

const char *pendres_guard_message(const pendres_guard *g)
{
  return pendres_guard_busy(g) ? pendres_status_message(PENDRES_BUSY) : g->message;
}
