/**
 * @file parts.h
 * @brief Large ensembles on several threads.
 *
 * A context belongs to one thread at a time, two contexts share nothing, and what is chosen for a
 * pendulum never depends on its neighbours. So a program may share its pendulums among threads of
 * its own in any way; this function is for those that have none. Whatever the threads and the
 * parts, the results are the same bytes as those of one thread.
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

/** How work is cut and shared. Zero in any field but n means the default. */
typedef struct pendres_parts {
  size_t n;                /**< things to be done, pendulums say */
  size_t each;             /**< things a part, the last one may have fewer; default 4096, which
                                fills eight blocks of lanes. Small parts share evenly, large ones
                                waste less at their ends */
  int threads;             /**< at most so many; default one for each processor that the process
                                may use. The calling thread is one of them, and works on alone
                                where the system gives no more */
  pendres_options options; /**< of the contexts, one a thread */
} pendres_parts;

/**
 * Do work for things 0 .. n - 1, in parts on several threads, and return when all is done.
 *
 * work(ctx, first, count, arg) does things first .. first + count - 1 with a context that is its
 * thread's alone until it returns. It is called from several threads at once, with the same arg: it
 * may write what belongs to its own things, and must not change what others read. Parts begin in
 * ascending order. Where one fails no more are begun, those that run are ended, and the status and
 * the message are those of the first failed part, in the order of things: "part from 8192 on: " and
 * what its context says.
 *
 * @param how     read
 * @param work    what to do with a part; a status other than PENDRES_OK ends the run
 * @param arg     handed on to work; kept by the caller
 * @param message [size] receives why it failed, cut to fit, "" after success; may be NULL if size
 *                is 0
 * @param size    bytes of message
 * @return PENDRES_OK; PENDRES_INVALID_ARGUMENT: how or work is NULL, threads negative or above
 *         4096, or invalid options; PENDRES_OUT_OF_MEMORY; else what work returned
 *
 * Thread safety: any number of calls at once. Signals are blocked in the threads that it makes, so
 * that those of the caller get them. To end it early: let work return PENDRES_INTERRUPTED, or give
 * its context a function to ask (pendres_context_set_interrupt).
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
