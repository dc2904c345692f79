/*
 * test_journal.c -- records on disk: they come back as they were, whatever happens to the file. No
 * tolerances: bytes.
 */
#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* mkdtemp, setrlimit */
#endif
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE   /* syscall */
#endif
#include "check.h"

#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "farm/journal.h"

enum { RECORDS = 12, ROOM = 1 << 14 };

/* Where files are made thousands of times: in memory, if there is such a place. */
static char folder[40];
static const char path[] = "run.journal", head[] = "libpendres 1\n&pendulum\n  damping = 0.1\n/\n";

/* In the place of the C library's: the run that has the journal removes it at its end, between this
   one's opening and its lock. */
static int ends_before_lock;
int flock(int fd, int operation)
{
  if (ends_before_lock) assert_int_equal(unlink(path), 0);
  ends_before_lock = 0;
  return (int)syscall(SYS_flock, fd, operation);
}

static int enter(void **state)
{
  (void)state;
  const int fast = access("/dev/shm", W_OK | X_OK) == 0;
  snprintf(folder, sizeof folder, "%s/journal-XXXXXX", fast ? "/dev/shm" : "/tmp");
  return mkdtemp(folder) != NULL && chdir(folder) == 0 ? 0 : -1;
}

static int leave(void **state)
{
  (void)state;
  (void)unlink("run.journal");
  (void)unlink("run.journal.~1~");
  (void)unlink("other.journal");
  return chdir("/") == 0 ? rmdir(folder) : -1;
}

/* Record number i: its stage, task, and some bytes of which the last are zeros. */
static size_t stage_of(size_t i)
{
  return i % 3;
}

static farm_record make(size_t i)
{
  farm_record r = { .cost = { 1.0 + (double)i, 2.0, 3.0, 4.0, 5.0 } };
  unsigned char *data = farm_record_resize(&r, 17 * i);
  assert_non_null(data);
  for (size_t k = 0; k < 13 * i; k++) data[k] = (unsigned char)(k * k + 7 * i + 1);
  return r;
}

static void write_all(const char *name)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  (void)unlink(name);
  check_ok(journal_open(name, head, 0, &j, words));
  for (size_t i = 0; i < RECORDS; i++) {
    farm_record r = make(i);
    check_ok(journal_append(j, stage_of(i), i, &r, words));
    assert_true(journal_has(j, stage_of(i), i));
    free(r.data);
  }
  assert_int_equal(journal_count(j), RECORDS);
  journal_close(j);
}

/* Those that are there are as they were; their number. */
static size_t check_records(journal *j)
{
  size_t n = 0;
  for (size_t i = 0; i < RECORDS; i++) {
    farm_record r = { 0 };
    if (!journal_has(j, stage_of(i), i)) {
      assert_int_equal(journal_read(j, stage_of(i), i, &r), PENDRES_NOT_FOUND);
      continue;
    }
    farm_record want = make(i);
    check_ok(journal_read(j, stage_of(i), i, &r));
    assert_int_equal(r.size, want.size);
    if (r.size > 0) assert_memory_equal(r.data, want.data, r.size);
    assert_memory_equal(&r.cost, &want.cost, sizeof r.cost);
    free(r.data);
    free(want.data);
    n++;
  }
  assert_int_equal(journal_count(j), n);
  return n;
}

static size_t load(const char *name, unsigned char *bytes)
{
  FILE *f = fopen(name, "rb");
  assert_non_null(f);
  const size_t n = fread(bytes, 1, ROOM, f);
  assert_true(n < ROOM);
  fclose(f);
  return n;
}

static void save(const char *name, const unsigned char *bytes, size_t n)
{
  FILE *f = fopen(name, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, n, f), n);
  assert_int_equal(fclose(f), 0);
}

static void comes_back(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL, *again = NULL;
  (void)state;
  write_all(path);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_string_equal(words, "");
  assert_int_equal(check_records(j), RECORDS);
  assert_false(journal_has(j, 0, RECORDS) || journal_has(j, 77, 0) || journal_has(NULL, 0, 0));
  /* One process at a time. */
  assert_int_equal(journal_open(path, head, 1, &again, words), PENDRES_BUSY);
  assert_null(again);
  journal_close(j);
  /* Without resume it starts again, and the older one is kept, and told, whatever becomes of the
     new one; so is a user's file. One without records leaves nothing. */
  save("run.journal.~1~", (const unsigned char *)"my poems", 8);
  check_ok(journal_open(path, head, 0, &j, words));
  assert_non_null(strstr(words, "is kept as 'run.journal.~2~'"));
  assert_int_equal(journal_count(j), 0);
  journal_remove(j);
  assert_int_equal(access(path, F_OK), -1);
  assert_int_equal(unlink("run.journal.~1~"), 0);
  check_ok(journal_open("run.journal.~2~", head, 1, &j, words));
  assert_int_equal(check_records(j), RECORDS);
  journal_remove(j);
  assert_int_equal(access("run.journal.~2~", F_OK), -1);
  save(path, (const unsigned char *)"poem", 4); /* shorter than any journal */
  check_ok(journal_open(path, head, 0, &j, words));
  assert_non_null(strstr(words, "is kept as 'run.journal.~1~'"));
  journal_stay(j);
  journal_close(j);
  /* A head alone is worth nothing. */
  check_ok(journal_open(path, "another\n", 0, &j, words));
  assert_string_equal(words, "");
  journal_close(j);
  assert_int_equal(access(path, F_OK), -1);
  unsigned char bytes[ROOM];
  assert_int_equal(load("run.journal.~1~", bytes), 4);
  assert_int_equal(unlink("run.journal.~1~"), 0);
}

/* The name is somebody else's by now: it is neither removed nor taken for the own file. */
static void replaced_meanwhile(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  unsigned char bytes[ROOM];
  (void)state;
  (void)unlink(path);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_int_equal(unlink(path), 0);
  save(path, (const unsigned char *)"my poems", 8);
  journal_remove(j);
  assert_int_equal(load(path, bytes), 8);
  /* A journal that has gone before it was locked is nobody's: another is made. */
  assert_int_equal(unlink(path), 0);
  write_all(path);
  ends_before_lock = 1;
  check_ok(journal_open(path, head, 1, &j, words));
  assert_int_equal(journal_count(j), 0);
  journal_stay(j);
  assert_int_equal(access(path, F_OK), 0);
  journal_close(j);
  assert_int_equal(access(path, F_OK), 0);
  /* Journals that others are writing are theirs. */
  journal *others = NULL;
  write_all("other.journal");
  check_ok(journal_open("other.journal", head, 1, &others, words));
  assert_true(journal_alone(others) && !journal_alone(NULL));
  assert_int_equal(unlink(path), 0);
  check_ok(journal_open(path, head, 1, &j, words));
  check_ok(journal_add(j, "other.journal", words));
  journal_remove(j);
  assert_int_equal(access("other.journal", F_OK), 0);
  journal_close(others);
  assert_int_equal(mkdir("folder", 0700), 0);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_int_equal(journal_add(j, "folder", words), PENDRES_INVALID_ARGUMENT);
  journal_close(j);
  assert_int_equal(rmdir("folder"), 0);
}

static void another_head(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  (void)state;
  write_all(path);
  const char other[] = "libpendres 1\n&pendulum\n  damping = 0.2\n/\n";
  assert_int_equal(journal_open(path, other, 1, &j, words), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(words, "'damping = 0.1'"));
  assert_non_null(strstr(words, "'damping = 0.2'"));
  save(path, (const unsigned char *)"my poems", 8);
  assert_int_equal(journal_open(path, head, 1, &j, words), PENDRES_INVALID_ARGUMENT);
  unsigned char bytes[ROOM];
  assert_int_equal(load(path, bytes), 8); /* left alone */
}

/* Cut at every length: what was whole is there, and a run can go on. */
static void cut_anywhere(void **state)
{
  unsigned char bytes[ROOM];
  size_t before = 0;
  (void)state;
  write_all(path);
  const size_t size = load(path, bytes);
  for (size_t length = 0; length <= size; length++) {
    char words[JOURNAL_WORDS];
    journal *j = NULL;
    save(path, bytes, length);
    check_ok(journal_open(path, head, 1, &j, words));
    const size_t n = check_records(j);
    assert_true(n >= before && n <= before + 1);
    before = n;
    if (length % 64 != 0) { /* to write to the disk in earnest takes its time */
      journal_close(j);
      continue;
    }
    for (size_t i = n; i < RECORDS; i++) {
      farm_record r = make(i);
      check_ok(journal_append(j, stage_of(i), i, &r, words));
      free(r.data);
    }
    assert_int_equal(check_records(j), RECORDS);
    journal_close(j);
    check_ok(journal_open(path, head, 1, &j, words));
    assert_string_equal(words, "");
    assert_int_equal(check_records(j), RECORDS);
    journal_close(j);
  }
  assert_int_equal(before, RECORDS);
}

/* A flipped bit anywhere: nothing comes back that is not as it was. */
static void flipped_bits(void **state)
{
  unsigned char bytes[ROOM];
  (void)state;
  write_all(path);
  const size_t size = load(path, bytes);
  for (size_t at = 0; at < size; at++) {
    char words[JOURNAL_WORDS];
    journal *j = NULL;
    bytes[at] ^= (unsigned char)(1u << (at % 8));
    save(path, bytes, size);
    const pendres_status status = journal_open(path, head, 1, &j, words);
    bytes[at] ^= (unsigned char)(1u << (at % 8));
    assert_string_not_equal(words, ""); /* said in any case */
    if (at < 8) assert_int_equal(status, PENDRES_INVALID_ARGUMENT); /* no journal, it seems */
    else check_ok(status);
    if (status == PENDRES_OK) assert_true(check_records(j) < RECORDS);
    journal_close(j);
    /* A head that cannot be read is kept with all that stands behind it. */
    const int kept = strstr(words, "is kept as") != NULL;
    assert_true((unlink("run.journal.~1~") == 0) == (at >= 8 && kept));
  }
}

/* The first record of a journal with other numbers, and checksums that fit. */
static void forge(uint64_t task, uint64_t size)
{
  unsigned char bytes[ROOM];
  journal_entry e;
  write_all(path);
  const size_t n = load(path, bytes), at = JOURNAL_HEAD + strlen(head);
  memcpy(&e, bytes + at, sizeof e);
  e.task = task;
  e.size = size;
  e.sum = journal_file_sum(&e, offsetof(journal_entry, sum));
  memcpy(bytes + at, &e, sizeof e);
  save(path, bytes, n);
}

/* A journal takes memory by its own bytes, whatever its numbers say: no more than a megabyte of a
   record is not in the file, and an index has room for what is there. */
static void forged_numbers(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  farm_record r = { 0 };
  (void)state;
  forge(0, (uint64_t)1 << 32);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_non_null(strstr(words, "torn or damaged"));
  assert_int_equal(journal_count(j), 0);
  journal_close(j);
  forge((uint64_t)1 << 60, 7);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_string_equal(words, "");
  assert_int_equal(journal_count(j), RECORDS);
  assert_true(journal_has(j, stage_of(0), (size_t)1 << 60) && !journal_has(j, stage_of(0), 0));
  check_ok(journal_read(j, stage_of(0), (size_t)1 << 60, &r));
  assert_int_equal(r.size, 7);
  free(r.data);
  journal_remove(j);
  /* Stages are distinguished by what they are. */
  const uint64_t number = journal_stage(2, "lines", 8, 100);
  assert_true(number == journal_stage(2, "lines", 8, 100));
  assert_true(number != journal_stage(3, "lines", 8, 100));
  assert_true(number != journal_stage(2, "chunks", 8, 100));
  assert_true(number != journal_stage(2, "lines", 9, 100));
  assert_true(number != journal_stage(2, "lines", 8, 104));
}

/* Records of several journals, as of shards. */
static void several(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  farm_record r = make(3);
  (void)state;
  write_all("other.journal");
  (void)unlink(path);
  check_ok(journal_open(path, head, 1, &j, words));
  check_ok(journal_append(j, stage_of(3), 3, &r, words));
  free(r.data);
  assert_int_equal(journal_add(j, "none.journal", words), PENDRES_NOT_FOUND);
  check_ok(journal_add(j, "other.journal", words));
  assert_int_equal(check_records(j), RECORDS);
  journal_close(j);
  assert_int_equal(access("other.journal", F_OK), 0);
  check_ok(journal_open(path, "another\n", 0, &j, words));
  assert_int_equal(journal_add(j, "other.journal", words), PENDRES_INVALID_ARGUMENT);
  journal_close(j);
  /* Results that stand whole need none of them. */
  check_ok(journal_open(path, head, 1, &j, words));
  check_ok(journal_add(j, "other.journal", words));
  journal_remove(j);
  assert_int_equal(access("other.journal", F_OK), -1);
}

/* No room: what was whole stays whole, it is said once, and no more is written. */
static void no_room(void **state)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  struct rlimit before;
  farm_record r = make(RECORDS - 1);
  (void)state;
  write_all(path);
  check_ok(journal_open(path, head, 1, &j, words));
  struct stat s;
  assert_int_equal(stat(path, &s), 0);
  assert_true(signal(SIGXFSZ, SIG_IGN) != SIG_ERR);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit tight = { (rlim_t)s.st_size + 100, before.rlim_max };
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const pendres_status first = journal_append(j, 5, 0, &r, words);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(first, PENDRES_IO);
  assert_string_not_equal(words, "");
  assert_int_equal(journal_append(j, 5, 0, &r, words), PENDRES_IO);
  assert_string_equal(words, "");
  free(r.data);
  journal_close(j);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_string_equal(words, "");
  assert_int_equal(check_records(j), RECORDS);
  journal_close(j);
}

static off_t size_now(void)
{
  struct stat s;
  assert_int_equal(stat(path, &s), 0);
  return s.st_size;
}

static void put_state(journal *j, uint64_t task, size_t size, unsigned char fill)
{
  char words[JOURNAL_WORDS];
  farm_record r = { 0 };
  unsigned char *data = farm_record_resize(&r, size);
  assert_non_null(data);
  memset(data, fill, size);
  check_ok(journal_append(j, 7, task | JOURNAL_STATE, &r, words));
  assert_string_equal(words, "");
  free(r.data);
}

static void check_state(journal *j, uint64_t task, size_t size, unsigned char fill)
{
  farm_record r = { 0 };
  check_ok(journal_read(j, 7, task | JOURNAL_STATE, &r));
  assert_int_equal(r.size, size);
  for (size_t k = 0; k < size; k++) assert_int_equal(((const unsigned char *)r.data)[k], fill);
  free(r.data);
}

/* Forty states of a path, each larger than the one before, 8.2 MB together: those that are outdated
   take no more than what counts, and a megabyte. Whatever the file is when the run is killed, all
   that counts is in it; of a task that has come to its end no state is. */
static void states_that_are_outdated(void **state)
{
  enum { STATES = 40, EACH = 10000 };
  const int first = (int)(JOURNAL_HEAD + strlen(head)), entry = (int)sizeof(journal_entry);
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  off_t most = 0;
  (void)state;
  write_all(path);
  const off_t records = size_now() - first;
  save("run.journal.new", (const unsigned char *)"what a kill left", 16);
  check_ok(journal_open(path, head, 1, &j, words));
  assert_int_equal(access("run.journal.new", F_OK), -1);
  put_state(j, 1, 100, 7); /* of another task, which goes on */
  for (int i = 1; i <= STATES; i++) {
    put_state(j, 0, (size_t)i * EACH, (unsigned char)i);
    const off_t counts = first + records + 2 * entry + 100 + i * EACH, size = size_now();
    assert_true(size <= 2 * counts + (1 << 20));
    most = size > most ? size : most;
  }
  assert_true((double)most > 0.7 * (2.0 * STATES * EACH + (1 << 20)));
  assert_int_equal(journal_states(j), 2);
  for (int again = 0; again < 2; again++) {
    check_state(j, 0, (size_t)STATES * EACH, STATES);
    check_state(j, 1, 100, 7);
    assert_int_equal(check_records(j), RECORDS);
    assert_true(journal_alone(j));
    journal_close(j);
    check_ok(journal_open(path, head, 1, &j, words));
    assert_string_equal(words, "");
  }
  assert_int_equal(access("run.journal.new", F_OK), -1);
  farm_record r = make(3);
  check_ok(journal_append(j, 7, 0, &r, words));
  free(r.data);
  assert_int_equal(journal_states(j), 1);
  assert_int_equal(journal_read(j, 7, JOURNAL_STATE, &r), PENDRES_NOT_FOUND);
  journal_remove(j);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(comes_back), cmocka_unit_test(replaced_meanwhile),
    cmocka_unit_test(another_head), cmocka_unit_test(cut_anywhere),
    cmocka_unit_test(flipped_bits), cmocka_unit_test(forged_numbers), cmocka_unit_test(several),
    cmocka_unit_test(no_room), cmocka_unit_test(states_that_are_outdated),
  };
  return cmocka_run_group_tests(tests, enter, leave);
}
