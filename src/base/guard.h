/*
 * guard.h -- how the use of a handle of the library begins and ends.
 *
 * Owns: which thread computes with a handle at present, and the message about its last use. Every
 * public function that computes goes through pendres_guard_enter() and pendres_guard_leave(), so
 * that a handle in use is refused, a failure never shows the message of another one, and a success
 * shows none.
 */
#ifndef PENDRES_GUARD_H
#define PENDRES_GUARD_H

#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>

#include <pendres/status.h>

enum { PENDRES_MESSAGE_LENGTH = 512 };

typedef struct pendres_guard {
  _Atomic uintptr_t owner; /* the thread that computes; 0: none does */
  int depth;               /* nested calls of public functions */
  int asking;              /* whether one of the caller's functions is being called */
  pendres_status said;     /* what the message is about */
  char message[PENDRES_MESSAGE_LENGTH];
} pendres_guard;

/* All fields at rest. */
void pendres_guard_init(pendres_guard *g);

/*
 * Begin to use a handle. It is refused, with 0, if g is NULL, if another thread uses the handle, or
 * if the caller is a function which the handle itself has called. Functions of the library may call
 * one another.
 */
int pendres_guard_enter(pendres_guard *g);

/* What a refusal is to return. */
pendres_status pendres_guard_refusal(const pendres_guard *g);

/* End the use. After a success the handle has no message, after a failure that of the failure or,
   if none was given, that of its status. */
pendres_status pendres_guard_leave(pendres_guard *g, pendres_status status);

/* To be called before and after every call of a function that the caller has passed. */
void pendres_guard_ask(pendres_guard *g, int asking);

/* Whether another thread, or the call that asks this very function, uses the handle. */
int pendres_guard_busy(const pendres_guard *g);

/* Whether another thread uses the handle. */
int pendres_guard_used_elsewhere(const pendres_guard *g);

/* Store a message, return the status. */
pendres_status pendres_guard_fail(pendres_guard *g, pendres_status status, const char *format,
                                  va_list args);

/* The message of the last failure, or why none can be shown. */
const char *pendres_guard_message(const pendres_guard *g);

/* The body of a public function: `call` is evaluated if the handle may be entered. */
#define PENDRES_GUARD_CALL(guard, call)                                                       \
  (pendres_guard_enter(guard) ? pendres_guard_leave(guard, call) : pendres_guard_refusal(guard))

#endif
