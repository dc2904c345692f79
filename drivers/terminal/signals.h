/*
 * signals.h -- how a run is stopped from outside.
 *
 * Owns: the handlers of TERM, INT, HUP, USR1, USR2 and XCPU, which terminals and batch systems send
 * before they kill, and the flag that they set. A second signal, a fifth of a second or more after
 * the first, ends the program immediately, as if there were no handlers, except for XCPU, which is
 * repeated.
 * PIPE and XFSZ are ignored, so that a closed pipe
 * and a limit on file sizes become errors of writing, which are reported. The flag is, with that
 * of ending.h, the only state of the program that is not passed around: a handler has no arguments.
 */
#ifndef SIGNALS_H
#define SIGNALS_H

/* Install the handlers; what was ignored when the program started stays ignored. 0, or -1. */
int signals_install(void);

/* Nonzero once a signal has come; any thread may ask. arg is not used. */
int signals_stop(void *arg);

/* "SIGTERM" etc. of the first that came, or NULL. */
const char *signals_name(void);

#endif
