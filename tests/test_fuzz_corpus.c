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
#define LLVMFuzzerTestOneInput fuzz_data
#include "fuzz/fuzz_data.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_collect
#include "fuzz/fuzz_collect.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_formula
#include "fuzz/fuzz_formula.c"
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

/* A number by chance, the same in every run. */
static uint32_t chance(uint32_t *number)
{
  *number = 1664525u * *number + 1013904223u;
  return *number >> 8;
}

/* Some bytes by chance: another, one less, or one more, of those that such files are made of. */
static size_t damage(uint8_t *bytes, size_t n, size_t room, uint32_t *number)
{
  static const char common[] = "0123456789.,;-+eE# \t\r\n\"nainfupdown!\0\377\200";
  for (uint32_t k = chance(number) % 4 + 1; k > 0 && n > 1; k--) {
    const size_t at = 1 + chance(number) % (n - 1);
    const uint8_t byte = (uint8_t)common[chance(number) % sizeof common];
    const uint32_t how = chance(number) % 4;
    if (how == 0 && n < room) memmove(bytes + at + 1, bytes + at, n++ - at);
    else if (how == 1) memmove(bytes + at, bytes + at + 1, --n - at);
    if (how != 1) bytes[at] = byte;
  }
  return n;
}

/* Text, each of the corpus damaged in many ways; results of HDF5, which take a process each, are
   damaged as files to verify. */
static void data_of_fits(void **state)
{
  enum { WAYS = 150 };
  static const char *const names[] = { "whole", "names", "semicolons", "windows", "decay", "jumps",
                                       "rotation", "tabs", "blanks", "old_mac" };
  (void)state;
  replay("data", fuzz_data);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char path[100];
    uint8_t bytes[2000], changed[2100];
    uint32_t number = (uint32_t)i;
    snprintf(path, sizeof path, "tests/fuzz/corpus/data/%s", names[i]);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    const size_t n = fread(bytes, 1, sizeof bytes, f);
    assert_int_equal(fclose(f), 0);
    for (int way = 0; way < WAYS; way++) {
      memcpy(changed, bytes, n);
      (void)fuzz_data(changed, damage(changed, n, sizeof changed, &number));
    }
  }
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
    for (size_t k = 0; k < sizeof bytes; k++) bytes[k] = (uint8_t)(chance(&number) >> 16);
    (void)fuzz_collect(bytes, 1 + 8 * (size_t)(1 + i % CHANGES));
  }
}

/* Words of formulas in any order, too. */
static void formulas(void **state)
{
  static const char *const word[] = {"x", "a1", "(", ")", "+", "-", "*", "/", "^", "sin(", "log(",
                                     "1", "2.5", "e", ".", " ", "sqrt(", "abs(", "pi", ","};
  enum { TEXTS = 3000, LONGEST = 24, WORDS = sizeof word / sizeof word[0] };
  uint32_t number = 42;
  (void)state;
  replay("formula", fuzz_formula);
  for (int i = 0; i < TEXTS; i++) {
    char text[LONGEST * 6] = "";
    for (int k = i % LONGEST; k >= 0; k--) strcat(text, word[(chance(&number) >> 16) % WORDS]);
    (void)fuzz_formula((const uint8_t *)text, strlen(text));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(namelists), cmocka_unit_test(decks), cmocka_unit_test(journals),
    cmocka_unit_test(files_of_results), cmocka_unit_test(data_of_fits),
    cmocka_unit_test(collectors), cmocka_unit_test(formulas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
