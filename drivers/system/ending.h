/*
 * ending.h -- an orderly end where a library ends the program in the middle of a run.
 *
 * Owns: what happens at exit() and at faults, and that GSL returns when it gets no memory. Without
 * memory HDF5 (1.10) calls exit(), dereferences null pointers, recurses until the stack overflows,
 * or faults while it is closed afterwards; SUNDIALS (6.4) dereferences null pointers (see also
 * pendres/status.h). An exit() in the middle of a run, and a fault in a library's code, become exit
 * code 1 with a message. A fault in the program's own code stays a fault, since it is an error of
 * this program, but leaves no part file, and is reported; a fault after the end of the run does not
 * change its exit code. A stack overflow on a thread other than that of ending_watch() ends the
 * program without a message. As in signals.h, the state is not passed around, since handlers have
 * no arguments.
 */
#ifndef ENDING_H
#define ENDING_H

#include <pendres/store.h>

/* Handle such ends from now on; *store, when it is not NULL, is being written. To be called before
   each deck, with the same address, on any thread; *store must exist until the end. 0, or -1 if the
   system refuses. */
int ending_watch(pendres_store *const *store);

/* The file of results is complete and in its place, which the message about such an end will say;
   valid until the next call of ending_watch(). */
void ending_whole(void);

/* The exit code is known, and all messages have been written. */
void ending_told(int code);

/* *store has been freed: exit() is called by main itself from now on. */
void ending_done(void);

/* To be called in a forked process, whose end does not concern the run: faults and exits are
   handled by the system again, and *store is not touched. */
void ending_forget(void);

#endif
