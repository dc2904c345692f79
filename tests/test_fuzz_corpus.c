/*
 * test_fuzz_corpus.c -- the harnesses of tests/fuzz over the bytes that are kept in
 * tests/fuzz/corpus: whole files, torn and damaged ones, and whatever a fuzzer once broke something
 * with. No tolerances: a harness ends the program where something does not hold.
 */
#include "fuzz/fuzz.h"

#include "check.h"

#include <dirent.h>

#define LLVMFuzzerTestOneInput fuzz_namelist
#include "fuzz/fuzz_namelist.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_deck
#include "fuzz/fuzz_deck.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_journal
#include "fuzz/fuzz_journal.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_verify
#include "fuzz/fuzz_verify.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_collect
#include "fuzz/fuzz_collect.c"
#undef LLVMFuzzerTestOneInput

typedef int harness(const uint8_t *data, size_t size);

static void replay_file(const char *path, harness *run)
{
  uint8_t bytes[1 << 14];
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  const size_t n = fread(bytes, 1, sizeof bytes, f);
  assert_true(n < sizeof bytes);
  assert_int_equal(fclose(f), 0);
  print_message("%s\n", path); /* the last one told is the one that ended the program */
  (void)run(bytes, n);
}

static void replay(const char *name, harness *run)
{
  char path[400];
  int files = 0;
  snprintf(path, sizeof path, "tests/fuzz/corpus/%s", name);
  DIR *d = opendir(path);
  assert_non_null(d);
  for (const struct dirent *e = readdir(d); e != NULL; e = readdir(d)) {
    if (e->d_name[0] == '.') continue;
    snprintf(path, sizeof path, "tests/fuzz/corpus/%s/%s", name, e->d_name);
    replay_file(path, run);
    files++;
  }
  closedir(d);
  assert_true(files > 0);
  (void)run(NULL, 0);
}

static void namelists(void **state)
{
  (void)state;
  replay("namelist", fuzz_namelist);
}

static void decks(void **state)
{
  (void)state;
  replay("deck", fuzz_deck);
}

static void journals(void **state)
{
  (void)state;
  replay("journal", fuzz_journal);
}

static void files_of_results(void **state)
{
  (void)state;
  replay("verify", fuzz_verify);
}

/* And changes by chance, the same in every run: some of each deck. */
static void collectors(void **state)
{
  enum { INPUTS = 200, CHANGES = 3 };
  uint8_t bytes[1 + 8 * CHANGES];
  uint32_t number = 20;
  (void)state;
  replay("collect", fuzz_collect);
  for (int i = 0; i < INPUTS; i++) {
    for (size_t k = 0; k < sizeof bytes; k++) {
      number = 1664525u * number + 1013904223u;
      bytes[k] = (uint8_t)(number >> 24);
    }
    (void)fuzz_collect(bytes, 1 + 8 * (size_t)(1 + i % CHANGES));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(namelists), cmocka_unit_test(decks), cmocka_unit_test(journals),
    cmocka_unit_test(files_of_results), cmocka_unit_test(collectors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
