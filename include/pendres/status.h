/**
 * @file status.h
 * @brief What every function of the library returns.
 *
 * Owns: the list of status codes and their messages. Zero is success; every
 * other code is a failure, and the context (context.h) holds a sentence that
 * says which pendulum failed, where and why. Thread safe: no state.
 *
 * Lack of memory. Where the library itself allocates memory, and where the default method makes
 * SUNDIALS (6.4) allocate vectors, PENDRES_OUT_OF_MEMORY is returned. The libraries below do not
 * always handle a lack of memory:
 *
 * - SUNDIALS crashes on a null pointer if it gets no memory for its logger or for its list of
 *   stages, and in the methods that serve for comparison (one problem a pendulum, CVODE);
 * - GSL (2.7) ends the program by its default error handler, which the library does not change.
 *   After gsl_set_error_handler_off() there is a status instead;
 * - HDF5 (1.10) calls exit(-1) if it gets no memory for one of its handles, crashes if it gets
 *   none for the copy of a name, in attaching a dimension scale, and in closing itself at exit
 *   after such a failure, and overflows the stack if it starts without memory; see
 *   pendres_store_drop_part().
 *
 * The program `resonance` ends with exit code 1 and a sentence in all of these cases.
 */
#ifndef PENDRES_STATUS_H
#define PENDRES_STATUS_H

#include <pendres/names.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** The codes with their messages: X(name, message). */
#define PENDRES_STATUS_LIST(X)                                                 \
  X(OK, "success")                                                             \
  X(INVALID_ARGUMENT, "an argument is out of its range")                       \
  X(OUT_OF_MEMORY, "out of memory")                                            \
  X(INTEGRATION_FAILED, "the integrator failed")                               \
  X(TOLERANCE_UNREACHABLE, "the tolerance cannot be reached in double precision") \
  X(NOT_CONVERGED, "an iteration did not converge within its budget")          \
  X(NOT_FOUND, "nothing with the properties asked for exists in the range")    \
  X(UNRESOLVED, "some pendulums did not settle within their budget")           \
  X(INTERRUPTED, "interrupted on request")                                     \
  X(IO, "reading or writing a file failed")                                    \
  X(UNSUPPORTED, "not supported by this build")                                \
  X(INTERNAL, "internal error")                                                \
  X(BUSY, "the handle is in use: by another thread, or by the call that asks this one")

/**
 * What every function that can fail returns.
 *
 * - PENDRES_OK: success
 * - PENDRES_INVALID_ARGUMENT: an argument is out of its range
 * - PENDRES_OUT_OF_MEMORY: the library could not allocate memory
 * - PENDRES_INTEGRATION_FAILED: the integrator failed
 * - PENDRES_TOLERANCE_UNREACHABLE: the tolerance cannot be reached in double precision
 * - PENDRES_NOT_CONVERGED: an iteration did not converge within its budget
 * - PENDRES_NOT_FOUND: nothing with the properties asked for exists in the range
 * - PENDRES_UNRESOLVED: some pendulums did not settle within their budget
 * - PENDRES_INTERRUPTED: the function of pendres_context_set_interrupt() asked to stop
 * - PENDRES_IO: reading or writing a file failed
 * - PENDRES_UNSUPPORTED: not supported by this build
 * - PENDRES_INTERNAL: an error of the library itself
 * - PENDRES_BUSY: the handle is in use by another thread, or by the call whose callback made this
 *   call; for a file: it cannot be locked, for instance because another process has it open for
 * writing
 * - PENDRES_STATUS_COUNT: how many there are; not a status
 */
typedef enum pendres_status {
#define PENDRES_STATUS_CODE(name, text) PENDRES_##name,
  PENDRES_STATUS_LIST(PENDRES_STATUS_CODE)
#undef PENDRES_STATUS_CODE
  PENDRES_STATUS_COUNT
} pendres_status;

/** A short English message for a status. The string is static; never NULL. */
const char *pendres_status_message(pendres_status status);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
