/*
 * threads.h -- one call's work on as many threads as its context may use.
 *
 * Owns: the contexts of its threads, which compute as the caller's does and are kept with it, and
 * what they cost.
 */
#ifndef PENDRES_THREADS_H
#define PENDRES_THREADS_H

#include <stddef.h>

#include <pendres/context.h>

/*
 * Do work for items 0 .. n - 1, so many each time: work(ctx, first, count, arg), on several threads
 * at once if the context's option `threads` allows them, each with a context of its own. What it
 * writes must belong to these items alone, and not depend on how they are divided. The cost is the
 * context's, and its function for interrupts is asked, by one thread at a time. Returns the first
 * failure in the order of items.
 */
pendres_status pendres_threads_run(pendres_context *ctx, size_t n, size_t each,
                                   pendres_status (*work)(pendres_context *ctx, size_t first,
                                                          size_t count, void *arg),
                                   void *arg);

/* How many of n lanes of a block each thread is to be given: whole vectors, since one lane takes as
   long as a vector does. */
size_t pendres_threads_share(const pendres_context *ctx, size_t n);

#endif
