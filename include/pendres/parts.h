/**
 * @file parts.h
 * @brief Large ensembles on several threads.
 *
 * A context belongs to one thread at a time, two contexts share nothing, and what is chosen for a
 * pendulum never depends on its neighbours. A program may therefore divide its pendulums among
 * threads of its own in any way; this function is for programs that have none. The results are the
 * same bytes for any number of threads and parts.
 *
 * @code
 *     static pendres_status advance(pendres_context *ctx, size_t first, size_t count, void *arg)
 *     {
 *       ensemble *e = arg;
 *       return pendres_strobe_advance(ctx, count, e->pendulums + first, e->x + first,
 *                                     e->v + first, 50, NULL);
 *     }
 *     ...
 *     const pendres_parts how = {.n = 1000000};
 *     status = pendres_parts_run(&how, advance, &mine, why, sizeof why);
 * @endcode
 */
#ifndef PENDRES_PARTS_H
#define PENDRES_PARTS_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** How work is divided. Zero in any field but n means the default. */
typedef struct pendres_parts {
  size_t n;                /**< number of items, for instance pendulums */
  size_t each;             /**< items per part, the last one may have fewer; default 4096, which
                                fills eight blocks of lanes. Small parts are divided more evenly,
                                large ones lose less time at their ends */
  int threads;             /**< largest number of threads; default one for each processor that the
                                process may use. The calling thread is one of them, and works alone
                                if no other can be started */
  pendres_options options; /**< of the contexts, one a thread */
} pendres_parts;

/**
 * How many threads pendres_parts_run() has unless told: one for each processor that the process may
 * use, at most 4096. At least 1. Thread safe.
 */
int pendres_parts_threads(void);

/**
 * Do work for items 0 .. n - 1, in parts on several threads, and return when all are done.
 *
 * work(ctx, first, count, arg) does items first .. first + count - 1 with a context that no other
 * thread uses until it returns. It is called from several threads at the same time, with the same
 * arg: it may write what belongs to its own items, and must not change what others read. Parts
 * begin in ascending order. If one fails no more are begun, those that run are ended, and the
 * status and the message are those of the first failed part, in the order of items: "part from
 * 8192 on: " and the message of its context.
 *
 * @param how     read
 * @param work    what to do with a part; a status other than PENDRES_OK ends the run
 * @param arg     passed to work; kept by the caller
 * @param message [size] receives why it failed, truncated to fit, "" after success; may be NULL
 *                if size is 0
 * @param size    bytes of message
 * @return PENDRES_OK; PENDRES_INVALID_ARGUMENT: how or work is NULL, threads negative or above
 *         4096, or invalid options; PENDRES_OUT_OF_MEMORY; else what work returned
 *
 * Thread safety: any number of calls at the same time. Signals are blocked in the threads that it
 * makes, so that those of the caller receive them. To end it early, let work return
 * PENDRES_INTERRUPTED, or set a function for its context (pendres_context_set_interrupt).
 */
pendres_status pendres_parts_run(const pendres_parts *how,
                                 pendres_status (*work)(pendres_context *ctx, size_t first,
                                                        size_t count, void *arg),
                                 void *arg, char *message, size_t size);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
