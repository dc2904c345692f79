/* fuzz_limit.h -- less patience with readers of damaged files than the program has. */
#ifndef FUZZ_LIMIT_H
#define FUZZ_LIMIT_H

#include "fuzz/fuzz.h"

#include <sys/resource.h>
#include <sys/syscall.h>

/* On some bytes HDF5 runs in circles, and is given a minute. A second is enough for files as small
   as these: this stands in the place of the C library's function. Sanitizers call it before they
   are ready to watch anything. */
__attribute__((no_sanitize_address, no_sanitize_thread))
int setrlimit(int resource, const struct rlimit *limit)
{
  const struct rlimit second = { 1, 1 };
  return (int)syscall(SYS_prlimit64, 0, resource, resource == RLIMIT_CPU ? &second : limit, NULL);
}

#endif
