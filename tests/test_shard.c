/*
 * test_shard.c -- runs in parts: the meaning of --shard, and that merged parts give the same bytes
 * as a whole run.
 */
#include "driver_run.h"
#include "kinds_fixture.h"
#include "same_results.h"

#include <stddef.h>

#include "farm/journal.h"
#include "shard.h"

static const char diagram[] =
  "&scene kind = 'phase_diagram' /\n&pendulum drive_amplitude = 0.2 /\n"
  "&sweep damping_range = 0.10, 0.16, 4, drive_frequency_range = 0.7, 0.9, 4 /\n"
  "&ensemble members = 8 /\n";

static void forget_array(void)
{
  static const char *const names[] = {
    "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP",
    "SLURM_ARRAY_TASK_COUNT", "SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "PBS_ARRAY_INDEX",
    "PBS_ARRAYID", "LSB_JOBINDEX" };
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) assert_int_equal(unsetenv(names[i]), 0);
}

static void check_parse(const char *text, size_t shard, size_t shards)
{
  char words[200];
  size_t i = 0, n = 0;
  if (shard == 0) {
    assert_false(shard_parse(text, &i, &n, words, sizeof words));
    assert_string_not_equal(words, "");
    return;
  }
  assert_true(shard_parse(text, &i, &n, words, sizeof words));
  assert_int_equal(i, shard);
  assert_int_equal(n, shards);
}

/* sbatch --array=1,3,7: three jobs, of which Slurm tells the first, the last and how many. Which
   part is the job number 3 cannot be known, and none of 7 parts would be whole. */
static void jobs_with_gaps(void)
{
  char words[300];
  size_t i, n;
  assert_int_equal(setenv("SLURM_ARRAY_TASK_ID", "3", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_MIN", "1", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_MAX", "7", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_STEP", "1", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_COUNT", "3", 1), 0);
  assert_false(shard_parse("auto", &i, &n, words, sizeof words));
  assert_non_null(strstr(words, "with gaps"));
  check_parse("auto/7", 3, 7); /* the parts of an earlier array again */
  forget_array();
}

static void what_is_meant(void **state)
{
  static const char *const bad[] = { "", "3", "0/4", "5/4", "1/0", "-1/4", " 1/4", "1/4x", "1//4",
                                     "1/99999999999999999999", "auto", "auto/4", "auto/0" };
  (void)state;
  forget_array();
  check_parse("1/1", 1, 1);
  check_parse("3/8", 3, 8);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) check_parse(bad[i], 0, 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_ID", "5", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_MIN", "3", 1), 0);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_MAX", "9", 1), 0);
  check_parse("auto", 3, 7);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_STEP", "2", 1), 0);
  check_parse("auto", 2, 4);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_COUNT", "4", 1), 0);
  check_parse("auto", 2, 4);
  assert_int_equal(setenv("SLURM_ARRAY_TASK_ID", "4", 1), 0); /* not one of them */
  check_parse("auto", 0, 0);
  forget_array();
  jobs_with_gaps();
  assert_int_equal(setenv("PBS_ARRAY_INDEX", "2", 1), 0);
  check_parse("auto", 0, 0);
  check_parse("auto/8", 2, 8);
  check_parse("auto/1", 0, 0);
  forget_array();
  assert_true(shard_is_journal("a.h5.1-of-3.journal", "a.h5"));
  assert_false(shard_is_journal("a.h5.1-of-3.journal~", "a.h5"));
  assert_false(shard_is_journal("a.h5.journal", "a.h5"));
  assert_false(shard_is_journal("b.h5.1-of-3.journal", "a.h5"));
  assert_false(shard_is_journal("a.h5.1-of-.journal", "a.h5"));
}

/* All decks with some arguments, in one run; its exit code. */
static int run_kinds(const char *one, const char *other)
{
  const char *arguments[MOST_ARGUMENTS + 1] = { "-t1", one, other };
  add_kinds(arguments, 3);
  return run_list(arguments);
}

static void compute_parts(int shards)
{
  for (int i = 1; i <= shards; i++) {
    char shard[40];
    snprintf(shard, sizeof shard, "--shard=%d/%d", i, shards);
    check_code(run_kinds("-f", shard), DONE);
    check_says(err, "is done");
  }
  assert_int_equal(count_names(".h5"), count_names(".journal"));
}

/* NAME.h5 and the name under which it is kept, of a deck. */
static void names_of(const char *deck, char now[PATH_ROOM], char whole[PATH_ROOM])
{
  const char *name = strrchr(deck, '/') + 1;
  const int length = (int)(strrchr(name, '.') - name);
  snprintf(now, PATH_ROOM, "%.*s.h5", length, name);
  snprintf(whole, PATH_ROOM, "%.*s.whole", length, name);
}

/* All kinds, in one, three and eight parts. One deck has points that fail: 3. */
static void same_bytes(void **state)
{
  static const int shards[] = { 1, 3, 8 };
  const char *decks[MOST_ARGUMENTS + 1];
  char now[PATH_ROOM], whole[PATH_ROOM];
  (void)state;
  add_kinds(decks, 0);
  check_code(run_kinds("-q", "-f"), 3);
  for (size_t i = 0; decks[i] != NULL; i++) {
    names_of(decks[i], now, whole);
    assert_int_equal(rename(now, whole), 0);
  }
  for (int k = 0; k < 3; k++) {
    compute_parts(shards[k]);
    check_code(run_kinds("-q", "--merge"), 3);
    for (size_t i = 0; decks[i] != NULL; i++) {
      names_of(decks[i], now, whole);
      check_same_results(whole, now);
      assert_int_equal(remove(now), 0);
    }
    assert_int_equal(count_names("journal") + count_names(".part"), 0);
  }
}

/* The journal of another build, of which the text at the head of a journal differs: the checksum of
   the sources is changed in it. */
static void write_others(const char *journal_of_this, const char *name)
{
  enum { BEFORE_TEXT = 24 };
  char bytes[TEXT_ROOM], words[JOURNAL_WORDS];
  journal *j = NULL;
  FILE *f = fopen(journal_of_this, "rb");
  assert_non_null(f);
  const size_t n = fread(bytes, 1, sizeof bytes - 1, f);
  assert_int_equal(fclose(f), 0);
  uint64_t length;
  memcpy(&length, bytes + 8, sizeof length);
  assert_true(n >= BEFORE_TEXT + length);
  bytes[BEFORE_TEXT + length] = '\0';
  char *sum = strstr(bytes + BEFORE_TEXT, ", sources ");
  assert_non_null(sum);
  sum[10] = sum[10] == '7' ? '8' : '7';
  check_ok(journal_open(name, bytes + BEFORE_TEXT, 0, &j, words));
  journal_stay(j);
  journal_close(j);
}

static void not_all_there(void **state)
{
  (void)state;
  write_text("deck.nml", diagram);
  check_code(RUN("-o", "parts.h5", "--merge", "deck.nml"), 2);
  check_says(err, "no journals of parts");
  check_code(RUN("-o", "parts.h5", "--shard=2/3", "deck.nml"), DONE);
  check_code(RUN("-o", "parts.h5", "--merge", "deck.nml"), 1);
  check_says(err, "some shard has not finished");
  check_says(err, "compute what is missing with --merge --resume");
  assert_true(exists("parts.h5.2-of-3.journal") && !exists("parts.h5"));
  /* Of another build. */
  write_others("parts.h5.2-of-3.journal", "parts.h5.1-of-3.journal");
  check_code(RUN("-o", "parts.h5", "--merge", "deck.nml"), 2);
  check_says(err, "1-of-3.journal");
  check_says(err, ", sources ");
  assert_int_equal(remove("parts.h5.1-of-3.journal"), 0);
  /* Of another deck. */
  check_code(RUN("-o", "parts.h5", "--merge", "deck.nml", "ensemble.members=9"), 2);
  check_says(err, "'members = 8'");
  assert_true(exists("parts.h5.2-of-3.journal"));
  check_code(RUN("-q", "-o", "parts.h5", "--merge", "--resume", "deck.nml"), DONE);
  check_code(RUN("-q", "-o", "whole.h5", "deck.nml"), DONE);
  check_same_results("whole.h5", "parts.h5");
  check_code(RUN("--merge", "--shard=1/2", "deck.nml"), 2);
  check_code(RUN("--no-journal", "--resume", "deck.nml"), 2);
}

/* The label of the first point of a map becomes 2^20, with checksums that fit. */
static void forge_label(const char *name)
{
  enum { AFTER_NUMBERS = 8 * sizeof(double), ROOM = 1 << 20 };
  static const int label = 1 << 20;
  static unsigned char bytes[ROOM];
  journal_entry e;
  uint64_t length;
  FILE *f = fopen(name, "r+b");
  assert_non_null(f);
  const size_t n = fread(bytes, 1, sizeof bytes, f);
  memcpy(&length, bytes + 8, sizeof length);
  unsigned char *head = bytes + JOURNAL_HEAD + length, *data = head + sizeof e;
  memcpy(&e, head, sizeof e);
  assert_true(e.stored > AFTER_NUMBERS + sizeof label && data + e.stored <= bytes + n);
  memcpy(data + AFTER_NUMBERS, &label, sizeof label);
  e.data_sum = journal_file_sum(data, e.stored);
  e.sum = journal_file_sum(&e, offsetof(journal_entry, sum));
  memcpy(head, &e, sizeof e);
  rewind(f);
  assert_int_equal(fwrite(bytes, 1, n, f), n);
  assert_int_equal(fclose(f), 0);
}

/* Shards in a shared folder are others' bytes: one that no run has written is named, and without it
   its points are computed. */
static void not_ours(void **state)
{
  char deck[PATH_ROOM + 40];
  (void)state;
  snprintf(deck, sizeof deck, "%s/tests/kinds/lyapunov.nml", top);
  check_code(RUN("-q", "-o", "whole.h5", deck), DONE);
  check_code(RUN("-o", "map.h5", "--shard=1/2", deck), DONE);
  check_code(RUN("-o", "map.h5", "--shard=2/2", deck), DONE);
  forge_label("map.h5.1-of-2.journal");
  check_code(RUN("-o", "map.h5", "--merge", deck), 1);
  check_says(err, "'map.h5.1-of-2.journal' is of another size, or numbers in it are out of range");
  assert_true(!exists("map.h5") && exists("map.h5.1-of-2.journal"));
  assert_int_equal(remove("map.h5.1-of-2.journal"), 0);
  check_code(RUN("-q", "-o", "map.h5", "--merge", "--resume", deck), DONE);
  check_same_results("whole.h5", "map.h5");
}

int main(void)
{
  const struct CMUnitTest tests[] = { TEST(what_is_meant), TEST(same_bytes), TEST(not_all_there),
                                      TEST(not_ours) };
  if (!find_program()) return 77;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
