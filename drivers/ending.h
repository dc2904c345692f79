/*
 * ending.h -- an orderly end where a library ends the program in the middle of a run.
 *
 * Owns: what happens at exit() and at faults, and that GSL returns where it gets no memory. HDF5
 * (1.10) calls exit() where it gets no memory for one of its handles, follows null pointers
 * elsewhere, and may fault while it is closed after such a failure. GSL and SUNDIALS: see
 * pendres/status.h. An exit() in the middle of a run becomes exit code 1, with a line that says
 * so, and so does a fault in a library's code: for want of memory HDF5 (1.10) follows null
 * pointers, or calls itself without end until the stack overflows, and SUNDIALS (6.4) follows null
 * pointers. A fault in the program's own code stays one, since it is an error of this program, but
 * leaves no part file and says so; a fault when the run is over changes nothing of its exit code.
 * A stack that overflows on another thread than that of ending_watch() ends the program as before,
 * without a word. Like signals.h, state that is not passed around: such functions have no
 * arguments.
 */
#ifndef ENDING_H
#define ENDING_H

#include <pendres/store.h>

/* From now on; *store, when it is not NULL, is being written. Before each deck, with the
   same place, on any thread; *store must live until the end. 0, or -1 if the system refuses. */
int ending_watch(pendres_store *const *store);

/* The file of results is whole, in its place, as will be said of such an end; until the next call
   of ending_watch(). */
void ending_whole(void);

/* The exit code is known, and all has been said. */
void ending_told(int code);

/* *store is gone: exit() is main's own. */
void ending_done(void);

/* In a process that was forked: what it does and how it ends is no matter of the run. Faults and
   exits are the system's again, and *store is left alone. */
void ending_forget(void);

#endif
