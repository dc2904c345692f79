/*
 * fuzz_verify.c -- any bytes in the place of a file of results: --verify says in one line that it
 * is whole or what is wrong, and goes on. HDF5 may crash on them, in the process that reads, where
 * no fuzzer sees which way it went: mutations are blind.
 */
#include "fuzz/fuzz_limit.h"

#include <fcntl.h>

#include "run.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* What verify_files() writes to standard output, as a text in `said`. */
static int verify(char *path, char *said, size_t room)
{
  char out[64];
  fuzz_path(out, sizeof out, "out");
  const int to = open(out, O_RDWR | O_CREAT | O_TRUNC, 0600), before = dup(STDOUT_FILENO);
  REQUIRE(to >= 0 && before >= 0 && fflush(stdout) == 0 && dup2(to, STDOUT_FILENO) >= 0);
  const int code = verify_files(&path, 1);
  REQUIRE(fflush(stdout) == 0 && dup2(before, STDOUT_FILENO) >= 0);
  const ssize_t n = pread(to, said, room - 1, 0);
  REQUIRE(n >= 0);
  said[n] = '\0';
  REQUIRE(close(to) == 0 && close(before) == 0 && unlink(out) == 0);
  return code;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char path[64], said[4096];
  fuzz_path(path, sizeof path, "fuzz.h5");
  fuzz_save(path, data, size);
  const int code = verify(path, said, sizeof said);
  REQUIRE(unlink(path) == 0);
  REQUIRE(code == 0 || code == 1);
  REQUIRE((code == 0) == (strstr(said, "fuzz.h5: whole: ") != NULL));
  /* One line; none where a sanitizer has ended the process that reads. */
  const char *end = strchr(said, '\n');
  REQUIRE(end == NULL ? said[0] == '\0' : end[1] == '\0');
  return 0;
}
